/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Writes tidy CSV. */

#include "table_writer.h"

#include <errno.h>

#include "io_error.h"

int gmi_table_print(const gmi_written *table, FILE *stream, gm_io_error *error) {
    for (int i = 0; i < table->column_count; ++i) {
        fprintf(stream, "%s%s", i > 0 ? "," : "", table->columns[i]);
    }
    fprintf(stream, "\n");
    table->print_rows(stream, table->data);

    /* Not every call above was looked at: the stream remembers whether one failed. */
    errno = 0;
    const int flush_failed = fflush(stream) != 0;
    if (flush_failed || ferror(stream) != 0) {
        return gmi_error_file(error, 0, "written", errno);
    }
    return GM_IO_OK;
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
