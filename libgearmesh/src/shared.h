/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What the core and gearmesh_io share and users never see: constants, limits, short geometry, random bits. All of it
 * is inline, so that gearmesh_io calls nothing of the core that its public header does not declare.
 */
#ifndef GEARMESH_SHARED_H
#define GEARMESH_SHARED_H

#include <math.h>
#include <stdint.h>

#include "arithmetic.h"
#include "gearmesh/gearmesh.h"

#define GMI_PI 3.14159265358979323846

/* Teeth of a gear, and grid lines of a flank table along each direction. */
#define GMI_SMALLEST_TEETH 3
#define GMI_LARGEST_TEETH  100000
#define GMI_SMALLEST_NODES 2
#define GMI_LARGEST_NODES  10000

/* Of one designed or scattered deviation of a flank (m); what is more is a slip of the unit. */
#define GMI_LARGEST_AMOUNT 0.01

/* One gear of a pair: the pinion for 0, else the wheel. */
static inline const gm_gear *gmi_gear_of(const gm_pair *pair, int wheel) {
    return wheel ? &pair->wheel : &pair->pinion;
}

/*
 * Roll length rho at a radius, 0 within the base circle [Paper, Eqs. 14-15, times r_b]. Factored, so that nothing
 * cancels next to the base circle: r^2 - r_b^2 would lose all digits there.
 */
static inline double gmi_roll_length(double radius, double base_radius) {
    return radius > base_radius ? sqrt((radius - base_radius) * (radius + base_radius)) : 0.0;
}

/* The next 64 random bits: splitmix64 (Steele, Lea, Flood 2014). */
static inline uint64_t gmi_random_bits(uint64_t *state) {
    *state += UINT64_C(0x9E3779B97F4A7C15);
    uint64_t bits = *state;
    bits = (bits ^ (bits >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    bits = (bits ^ (bits >> 27)) * UINT64_C(0x94D049BB133111EB);
    return bits ^ (bits >> 31);
}

/* The next random number, uniform in [0, 1). */
static inline double gmi_random_unit(uint64_t *state) {
    return (double)(gmi_random_bits(state) >> 11) * (1.0 / 9007199254740992.0);
}

#endif
