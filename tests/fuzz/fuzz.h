/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* What the harnesses share: claims that end the run, and numbers taken from the fuzzer's bytes. */
#ifndef GEARMESH_FUZZ_H
#define GEARMESH_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Not assert: the claim holds in every build type. abort() makes libFuzzer keep the input. */
#define FUZZ_CLAIM(claim)                                                                          \
    do {                                                                                           \
        if (!(claim))                                                                              \
            abort();                                                                               \
    } while (0)

typedef struct fuzz_bytes {
    const uint8_t *data;
    size_t left;
} fuzz_bytes;

/* Zeros once the bytes are used up. */
static inline void fuzz_take(fuzz_bytes *bytes, void *to, size_t size) {
    const size_t taken = size < bytes->left ? size : bytes->left;
    memset(to, 0, size);
    memcpy(to, bytes->data, taken);
    bytes->data += taken;
    bytes->left -= taken;
}

static inline uint8_t fuzz_byte(fuzz_bytes *bytes) {
    uint8_t value;
    fuzz_take(bytes, &value, sizeof value);
    return value;
}

/* Any double there is, NaN, infinities and denormals among them. */
static inline double fuzz_any(fuzz_bytes *bytes) {
    double value;
    fuzz_take(bytes, &value, sizeof value);
    return value;
}

/* Uniform in [low, high]. */
static inline double fuzz_between(fuzz_bytes *bytes, double low, double high) {
    uint32_t value;
    fuzz_take(bytes, &value, sizeof value);
    return low + (high - low) * ((double)value / (double)UINT32_MAX);
}

#endif
