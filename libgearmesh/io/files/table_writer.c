/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Writes tidy CSV. */

#include "table_writer.h"

#include <errno.h>

#include "io_error.h"

int gmi_writer_open(FILE **file, const char *path, gm_io_error *error) {
    errno = 0;
    *file = fopen(path, "wb");
    return *file != NULL ? GM_IO_OK : gmi_error_file(error, 0, "opened for writing", errno);
}

void gmi_writer_head(FILE *file, const char *const *columns, int column_count) {
    for (int i = 0; i < column_count; ++i) {
        fprintf(file, "%s%s", i > 0 ? "," : "", columns[i]);
    }
    fprintf(file, "\n");
}

int gmi_writer_flush(FILE *file, gm_io_error *error) {
    errno = 0;
    const int flush_failed = fflush(file) != 0;
    if (flush_failed || ferror(file) != 0) {
        return gmi_error_file(error, 0, "written", errno);
    }
    return GM_IO_OK;
}

int gmi_writer_close(FILE *file, int status, gm_io_error *error) {
    errno = 0;
    if (fclose(file) != 0 && status == GM_IO_OK) {
        return gmi_error_file(error, 0, "written", errno);
    }
    return status;
}
