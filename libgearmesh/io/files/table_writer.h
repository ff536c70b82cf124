/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file table_writer.h
 * Opens and closes a tidy CSV table for writing, so that no loss goes unnoticed.
 */
#ifndef GEARMESH_TABLE_WRITER_H
#define GEARMESH_TABLE_WRITER_H

#include <stdio.h>

#include "gearmesh/gearmesh_io.h"

/** Opens a file. On an error there is nothing to close. */
int gmi_writer_open(FILE **file, const char *path, gm_io_error *error);

/** Writes the names of the columns. */
void gmi_writer_head(FILE *file, const char *const *columns, int column_count);

/** Flushes the file and tells whether all of it was written so far. */
int gmi_writer_flush(FILE *file, gm_io_error *error);

/** Closes the file and tells whether all of it was written; a full disk often shows only here. The status of what was
 *  written before comes first if it is an error. */
int gmi_writer_close(FILE *file, int status, gm_io_error *error);

#endif /* GEARMESH_TABLE_WRITER_H */
