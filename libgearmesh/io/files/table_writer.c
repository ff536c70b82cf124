/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Writes tidy CSV. */

#include "table_writer.h"

#include <errno.h>

#include "io_error.h"

/* Nonzero if it failed. */
static int print_header(const gmi_written *table, FILE *stream) {
    int failed = 0;

    for (int i = 0; i < table->column_count && !failed; ++i) {
        failed = fprintf(stream, "%s%s", i > 0 ? "," : "", table->columns[i]) < 0;
    }
    return failed || fprintf(stream, "\n") < 0;
}

int gmi_table_print(const gmi_written *table, FILE *stream, gm_io_error *error) {
    int failed = print_header(table, stream) != 0 || table->print_rows(stream, table->data) != 0;

    /* What is left in the buffer; and the stream remembers what failed before. */
    if (!failed) {
        errno = 0;
        failed = fflush(stream) != 0 || ferror(stream) != 0;
    }
    return failed ? gmi_error_file(error, 0, "written", errno) : GM_IO_OK;
}

int gmi_table_write(const gmi_written *table, const char *path, gm_io_error *error) {
    errno = 0;
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        return gmi_error_file(error, 0, "opened for writing", errno);
    }
    const int status = gmi_table_print(table, file, error);

    /* What went wrong before comes first. */
    errno = 0;
    if (fclose(file) != 0 && status == GM_IO_OK) {
        return gmi_error_file(error, 0, "written", errno);
    }
    return status;
}
