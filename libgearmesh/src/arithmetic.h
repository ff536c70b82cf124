/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What both libraries need of the compiler: IEEE 754 double arithmetic, each operation rounded once, with NaN and
 * infinity. Other settings are refused when they are compiled, as nothing would show them afterwards.
 */
#ifndef GEARMESH_ARITHMETIC_H
#define GEARMESH_ARITHMETIC_H

#include <float.h>

/* NaN marks a missing parameter and a failed result; without it no bad input is found. */
#if defined(__FAST_MATH__) || defined(_M_FP_FAST) ||                                               \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ + 0)
#error "gearmesh needs NaN and infinity: compile it without -ffast-math, -Ofast, /fp:fast"
#endif

/* Products and angles are split in two parts, which is exact only if no operation is rearranged. */
#if defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error "gearmesh needs operations in the order written: without -funsafe-math-optimizations"
#endif

/* 2: intermediate results have 80 bits and are rounded twice; negative: unknown, or it changes. */
#if defined(FLT_EVAL_METHOD) && (FLT_EVAL_METHOD == 2 || FLT_EVAL_METHOD < 0)
#error "gearmesh needs double intermediate results, not those of x87: -msse2 -mfpmath=sse"
#endif

/* 53 bits: double is IEEE 754 binary64. */
#if FLT_RADIX != 2 || DBL_MANT_DIG != 53 || DBL_MAX_EXP != 1024
#error "gearmesh needs double to be IEEE 754 binary64"
#endif

#endif /* GEARMESH_ARITHMETIC_H */
