/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file io_error.h
 * How the loaders and writers say what went wrong: one plain sentence with the place and the value.
 *
 * Formats use %s, %d and %ld only, numbers come from gmi_number_text(): no message depends on a locale.
 */
#ifndef GEARMESH_IO_ERROR_H
#define GEARMESH_IO_ERROR_H

#include "gearmesh/gearmesh_io.h"
#include "shared.h"

/** Room for a quoted piece of a file, see gmi_quote(). */
#define GMI_QUOTE_SIZE 64

#if defined(__GNUC__)
#define GMI_PRINTF_LIKE(text, first) __attribute__((format(printf, text, first)))
#else
#define GMI_PRINTF_LIKE(text, first)
#endif

/** Empties the error of a call and notes the path (NULL = no file). The error may be NULL. */
void gmi_error_begin(gm_io_error *error, const char *path);

/** Fills line and text and returns the status, for `return gmi_error_set(...)`. The error may be NULL. */
int gmi_error_set(gm_io_error *error, int status, long line, const char *format, ...)
    GMI_PRINTF_LIKE(4, 5);

/** Says that a required pointer is NULL, for `return gmi_error_null(...)`. The error may be NULL. */
int gmi_error_null(gm_io_error *error);

/** Says that memory is out, for `return gmi_error_memory(...)`. The error may be NULL. */
int gmi_error_memory(gm_io_error *error);

/** Names the field of the options that decides about the error: a string that stays. The error may be NULL. */
void gmi_error_option(gm_io_error *error, const char *option);

/** Says why a file cannot be opened, read or written, from the errno of the failed call. */
int gmi_error_file(gm_io_error *error, long line, const char *action, int error_number);

/** Quotes a piece of a file for a message: short, printable, in single quotes. Returns quoted. */
const char *gmi_quote(char quoted[GMI_QUOTE_SIZE], const char *text);

#endif /* GEARMESH_IO_ERROR_H */
