/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Any bytes as a pitch file: it is read and can be written and read again, or there is an error with a text. */
#include "fuzz.h"
#include "fuzz_file.h"

#include <gearmesh/gearmesh_io.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static fuzz_file input, output;
    gm_pitch read, again;
    gm_io_error error;
    const int teeth = 7;
    const char *path = fuzz_file_with(&input, data, size);
    const char *copy = fuzz_file_path(&output);

    const int status = gm_pitch_read(&read, path, teeth, &error);
    if (status != GM_IO_OK) {
        FUZZ_CLAIM(status < 0 && error.text[0] != '\0' && error.line >= 0);
        return 0;
    }
    FUZZ_CLAIM(gm_pitch_write(&read, copy, &error) == GM_IO_OK);
    FUZZ_CLAIM(gm_pitch_read(&again, copy, teeth, &error) == GM_IO_OK);
    for (int tooth = 0; tooth < teeth; ++tooth) {
        FUZZ_CLAIM(again.drive[tooth] == read.drive[tooth] &&
                   again.coast[tooth] == read.coast[tooth]);
    }
    gm_pitch_free(&again);
    gm_pitch_free(&read);
    return 0;
}
