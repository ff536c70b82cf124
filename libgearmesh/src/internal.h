/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What all sources of the core share and users never see: limits, what compilers need to be told, small arithmetic. Each
 * other header declares what the source of its name gives to others, and includes those that it builds upon, one way:
 * gear, meshing, position -> contact, flank -> grid -> line -> ramp, tilt -> penetration, side_tangent -> law, friction,
 * wrench, corner -> mesh -> equilibrium, cache, elastic_mesh.
 */
#ifndef GEARMESH_INTERNAL_H
#define GEARMESH_INTERNAL_H

#include "arithmetic.h"
#include "gearmesh/gearmesh.h"
#include "shared.h"

#include <math.h>
#include <stdint.h>

/* 2 pi = GMI_TWO_PI + GMI_TWO_PI_REMAINDER to 32 digits. */
#define GMI_TWO_PI           6.28318530717958647693
#define GMI_TWO_PI_REMAINDER 2.44929359829470635e-16

/* Angles beyond this are refused: at 1e9 rad one rounding already moves the flank by nanometres. */
#define GMI_LARGEST_ANGLE 1e9

/*
 * Numbers beyond these are refused where they come in. No gear has them, and within them no product in an evaluation
 * overflows, so that evaluations need no checks of their own.
 */
#define GMI_LARGEST_SPEED      1e9   /* of a gear (rad/s), and of approach (m/s) */
#define GMI_LARGEST_OFFSET     1e18  /* of the simple model, which takes any other x (m) */
#define GMI_SMALLEST_LENGTH    1e-6  /* of a pair (m) */
#define GMI_LARGEST_LENGTH     1e9   /* (m) */
#define GMI_LARGEST_DEVIATION  1.0   /* of a flank (m) */
#define GMI_LARGEST_RAMP       1e30  /* its parts (m): they are large where it is short */
#define GMI_SMALLEST_STIFFNESS 1e-30 /* (N/m) */
#define GMI_LARGEST_STIFFNESS  1e30  /* (N/m), and of damping (N s/m) */

/* Compiled once for each combination of its constant arguments. */
#if defined(__GNUC__)
#define SPECIALIZED static inline __attribute__((always_inline))
#else
#define SPECIALIZED static inline
#endif

/* Not inlined: what it has on the stack is not there when its caller calls others. */
#if defined(__GNUC__)
#define OWN_STACK __attribute__((noinline))
#else
#define OWN_STACK
#endif

/* Loops over arrays that do not overlap, as arguments: inlined, gcc forgets that and does one number at a time. */
#if defined(__GNUC__)
#define APART static __attribute__((noinline))
#else
#define APART static
#endif

static inline double gmi_nan(void) {
    return (double)NAN;
}

static inline int gmi_is_finite(double value) {
    return isfinite(value);
}

/* One instruction each, where fmin() and fmax() are calls; b if one of both is no number. */
static inline double gmi_smaller(double a, double b) {
    return a < b ? a : b;
}

static inline double gmi_larger(double a, double b) {
    return a > b ? a : b;
}

/*
 * Cell of a table that holds v, from 0 to last, as a number: adding 2^52 rounds to a whole one as a conversion would, but
 * two at once. Between two cells it is either.
 */
static inline double gmi_cell_of(double v, double last) {
    const double middle = v - 0.5;
    const double above = middle > 0.0 ? middle : 0.0;
    const double within = above < last ? above : last;
    return (within + 0x1p52) - 0x1p52;
}

/* Whether an object may begin at this address. */
static inline int gmi_is_aligned(const void *memory) {
    return (uintptr_t)memory % sizeof(double) == 0;
}

/* a * b = *product + return value, exactly (Dekker; no fused multiply-add needed). */
double gmi_product_remainder(double a, double b, double product);

#endif
