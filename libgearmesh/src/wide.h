/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Vectors of four doubles where the processor has them. A library for any x86-64 processor has vectors of two (SSE2), and
 * most processors today have those of four and instructions of three operands (AVX2). So elastic_wide.c compiles the sources
 * of one evaluation of elastic teeth once more, and line_wide.c the walks along lines of contact, for AVX2 and under other
 * names. gmi_elastic_init() and gm_mesh_init() ask the processor once and keep the answer, and each of the few functions by
 * which such an evaluation is entered begins with a line that hands over to the wide copy. Both copies do the same
 * operations in the same order, and none fuses a product with a sum: the bits are the same.
 *
 * Nothing of this is there for other compilers and processors, on Windows (where gcc does not align the stack for it),
 * where all is compiled for AVX2 anyway or for size, and with GEARMESH_WITHOUT_AVX2 (CMake: -DGEARMESH_AVX2=OFF).
 */
#ifndef GEARMESH_WIDE_H
#define GEARMESH_WIDE_H

#if defined(__GNUC__) && defined(__x86_64__) && !defined(_WIN32) && !defined(__AVX2__) &&          \
    !defined(__OPTIMIZE_SIZE__) && !defined(GEARMESH_WITHOUT_AVX2)
#define GMI_HAS_WIDE 1
#else
#define GMI_HAS_WIDE 0
#endif

/* What an evaluation is entered by begins with one of these: for a function with a result, and for one without. */
#if GMI_HAS_WIDE && !defined(GMI_IN_WIDE)
#define GMI_RETURN_WIDE(known_by, call)                                                            \
    if ((known_by)->is_wide) {                                                                     \
        return call;                                                                               \
    }
#define GMI_CALL_WIDE(known_by, call)                                                              \
    if ((known_by)->is_wide) {                                                                     \
        call;                                                                                      \
        return;                                                                                    \
    }
#else
#define GMI_RETURN_WIDE(known_by, call)
#define GMI_CALL_WIDE(known_by, call)
#endif

#if GMI_HAS_WIDE && defined(GMI_IN_WIDE)
#include <immintrin.h>

/* Two columns of four rows of a table, from column k on. Faster than a gather, which fetches number by number. */
#define GMI_TWO_OF_FOUR(row, k, first, second)                                                     \
    const __m256d first##_even = _mm256_insertf128_pd(                                             \
        _mm256_castpd128_pd256(_mm_loadu_pd((row)[0] + (k))), _mm_loadu_pd((row)[2] + (k)), 1);    \
    const __m256d first##_odd = _mm256_insertf128_pd(                                              \
        _mm256_castpd128_pd256(_mm_loadu_pd((row)[1] + (k))), _mm_loadu_pd((row)[3] + (k)), 1);    \
    const __m256d first = _mm256_unpacklo_pd(first##_even, first##_odd);                           \
    const __m256d second = _mm256_unpackhi_pd(first##_even, first##_odd)

/* Four whole numbers below 2^51, times `size`: above 2^52 the last bits of a double are its last digits. */
#define GMI_PLACES_OF_FOUR(number, size, place)                                                    \
    int64_t place[4];                                                                              \
    _mm256_storeu_si256((__m256i *)(void *)(place),                                                \
                        _mm256_sub_epi64(_mm256_castpd_si256(_mm256_add_pd(                        \
                                             _mm256_mul_pd(number, _mm256_set1_pd(size)),          \
                                             _mm256_set1_pd(0x1p52))),                             \
                                         _mm256_castpd_si256(_mm256_set1_pd(0x1p52))))

/* gmi_cell_of() of four numbers. */
#define GMI_CELLS_OF_FOUR(v, last, cell)                                                           \
    const __m256d cell##_middle = _mm256_sub_pd(v, _mm256_set1_pd(0.5));                           \
    const __m256d cell##_within =                                                                  \
        _mm256_min_pd(_mm256_max_pd(cell##_middle, _mm256_setzero_pd()), _mm256_set1_pd(last));    \
    const __m256d cell = _mm256_sub_pd(_mm256_add_pd(cell##_within, _mm256_set1_pd(0x1p52)),       \
                                       _mm256_set1_pd(0x1p52))
#endif

/* Whether processor and system have AVX2: bits of CPUID, and that the system keeps the registers of each process. */
#if GMI_HAS_WIDE
#include <cpuid.h>

static inline int gmi_processor_is_wide(void) {
    unsigned a, b, c, d, kept, upper;
    if (__get_cpuid_max(0, 0) < 7) {
        return 0;
    }
    __cpuid(1, a, b, c, d);
    if ((c & bit_OSXSAVE) == 0 || (c & bit_AVX) == 0) {
        return 0;
    }
    __asm__ volatile("xgetbv" : "=a"(kept), "=d"(upper) : "c"(0));
    __cpuid_count(7, 0, a, b, c, d);
    return (kept & 6) == 6 && (b & bit_AVX2) != 0;
}
#else
static inline int gmi_processor_is_wide(void) {
    return 0;
}
#endif

#endif
