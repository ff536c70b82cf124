/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The readers and writers take paths. Each name is a file in memory that lives as long as the fuzzer: a disk would be most
 * of the work.
 */
#ifndef GEARMESH_FUZZ_FILE_H
#define GEARMESH_FUZZ_FILE_H

#include "fuzz.h"

#include <stdio.h>
#include <sys/mman.h>
#include <unistd.h>

typedef struct fuzz_file {
    int descriptor; /* 0 = not made yet */
    char path[32];
} fuzz_file;

/* The path of the file, which is made at the first call. */
static inline const char *fuzz_file_path(fuzz_file *file) {
    if (file->descriptor == 0) {
        file->descriptor = memfd_create("fuzz", 0);
        FUZZ_CLAIM(file->descriptor > 0);
        snprintf(file->path, sizeof file->path, "/proc/self/fd/%d", file->descriptor);
    }
    return file->path;
}

/* The same, with the fuzzer's bytes as its contents. */
static inline const char *fuzz_file_with(fuzz_file *file, const uint8_t *data, size_t size) {
    const char *path = fuzz_file_path(file);
    FUZZ_CLAIM(ftruncate(file->descriptor, 0) == 0);
    FUZZ_CLAIM(pwrite(file->descriptor, data, size, 0) == (ssize_t)size);
    return path;
}

#endif
