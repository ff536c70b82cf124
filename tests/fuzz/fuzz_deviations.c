/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Any bytes as a deviation file: it is read and can be written and read again, or there is an error with a text. */
#include "fuzz.h"
#include "fuzz_file.h"

#include <gearmesh/gearmesh_io.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static fuzz_file input, output;
    gm_deviations read, again;
    gm_io_error error;
    const int teeth = 7;
    const char *path = fuzz_file_with(&input, data, size);
    const char *copy = fuzz_file_path(&output);

    const int status = gm_deviations_read(&read, path, teeth, &error);
    if (status != GM_IO_OK) {
        FUZZ_CLAIM(status < 0 && error.text[0] != '\0' && error.line >= 0);
        return 0;
    }
    FUZZ_CLAIM(gm_deviations_write(&read, copy, &error) == GM_IO_OK);
    FUZZ_CLAIM(gm_deviations_read(&again, copy, teeth, &error) == GM_IO_OK);
    FUZZ_CLAIM(again.set_count == read.set_count && again.face_nodes == read.face_nodes);
    FUZZ_CLAIM(gm_deviations_ideal_teeth(&again, GM_DRIVE) ==
               gm_deviations_ideal_teeth(&read, GM_DRIVE));

    /* What was read makes flanks, or is out of range. */
    gm_flanks *flanks;
    if (gm_flanks_build(&flanks, teeth, &read, NULL, NULL, NULL, &error) == GM_IO_OK) {
        gm_flanks_free(flanks);
    }
    gm_deviations_free(&again);
    gm_deviations_free(&read);
    return 0;
}
