/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file table_writer.h
 * Writes tidy CSV tables, so that no loss goes unnoticed.
 */
#ifndef GEARMESH_TABLE_WRITER_H
#define GEARMESH_TABLE_WRITER_H

#include <stdio.h>

#include "gearmesh/gearmesh_io.h"

/** What a table holds. */
typedef struct gmi_written {
    const char *const *columns; /**< [column_count] names in the header */
    int column_count;
    int (*print_rows)(FILE *stream,
                      const void *data); /**< stops with errno and nonzero where a write fails */
    const void *data;                    /**< what print_rows() needs */
} gmi_written;

/** Writes header and rows and flushes, to tell whether all of it was written. */
int gmi_table_print(const gmi_written *table, FILE *stream, gm_io_error *error);

/** The same into a file, which is replaced. A full disk often shows only when it is closed: that is told too. */
int gmi_table_write(const gmi_written *table, const char *path, gm_io_error *error);

#endif /* GEARMESH_TABLE_WRITER_H */
