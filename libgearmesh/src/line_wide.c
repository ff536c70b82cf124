/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The walks along lines of contact once more, but for those of tangents and of many depths, for processors with vectors of
 * four doubles; wide.h says when and how. A walk does one number at a time: it is the instructions of three operands that it
 * has there.
 */
#define GMI_IN_WIDE
#include "wide.h"

#include "gearmesh/gearmesh.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if GMI_HAS_WIDE

/* By these a line is entered. */
#define gmi_line_integrate         gmi_wide_line_integrate
#define gmi_line_integrate_squares gmi_wide_line_integrate_squares
#define gmi_line_value             gmi_wide_line_value

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#pragma GCC optimize("no-tree-slp-vectorize")
#endif

/* From here on all is for AVX2, what headers define as well: or it is not inlined. */
#include "internal.h"

#include "line.c"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#endif
