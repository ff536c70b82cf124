/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Links both libraries: a file that is not there is an error with a text. */
#include <gearmesh/gearmesh_io.h>
#include <stdio.h>

int main(void) {
    gm_deviations deviations;
    gm_io_error error;
    const int status = gm_deviations_read(&deviations, "no-such-file.csv", 45, &error);
    printf("gearmesh_io %s: status %d, %s: %s\n", gm_version(), status, error.file, error.text);
    return status != GM_IO_ERR_FILE || error.text[0] == '\0';
}
