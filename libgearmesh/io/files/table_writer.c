/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Writes tidy CSV. */

#include "table_writer.h"

#include <errno.h>

#include "io_error.h"

int gmi_writer_open(FILE **file, const char *path, const char *const *columns, int column_count,
                    gm_io_error *error) {
    errno = 0;
    *file = fopen(path, "wb");
    if (*file == NULL) {
        return gmi_error_file(error, 0, "opened for writing", errno);
    }
    for (int i = 0; i < column_count; i++) {
        fprintf(*file, "%s%s", i > 0 ? "," : "", columns[i]);
    }
    fprintf(*file, "\n");
    return GM_IO_OK;
}

int gmi_writer_close(FILE *file, gm_io_error *error) {
    errno = 0;
    const int flush_failed = fflush(file) != 0;
    const int failed = ferror(file) != 0 || flush_failed;
    const int flush_errno = errno;
    const int close_failed = fclose(file) != 0;
    if (failed || close_failed) {
        return gmi_error_file(error, 0, "written", failed ? flush_errno : errno);
    }
    return GM_IO_OK;
}
