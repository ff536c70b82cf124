/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The readers take a path: the fuzzer's bytes become a file in the working folder. */
#ifndef GEARMESH_FUZZ_FILE_H
#define GEARMESH_FUZZ_FILE_H

#include "fuzz.h"

#include <stdio.h>

static inline void fuzz_write_file(const char *path, const uint8_t *data, size_t size) {
    FILE *file = fopen(path, "wb");
    FUZZ_CLAIM(file != NULL);
    FUZZ_CLAIM(fwrite(data, 1, size, file) == size);
    FUZZ_CLAIM(fclose(file) == 0);
}

#endif
