/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The load torque on the wheel: a mean or a table, seeded noise, ripple over the pinion's angle, and what follows the
 * wheel's speed.
 *
 * Noise value k, at the time k * interval, is a pure function of seed and k: no state, any order of
 * calls, the same on every machine. Between the values runs a cubic (Catmull-Rom), which is C1, so that
 * a solver need not be restarted at every value; it overshoots the values by up to a quarter.
 */
#ifndef GEARSIM_LOAD_H
#define GEARSIM_LOAD_H

#include "time_table.h"

typedef struct load_signal {
    double mean;              /* N m */
    const time_table *table;  /* in place of the mean, NULL = none */
    ripple ripple;            /* over the pinion's angle (N m) */
    double amplitude;         /* noise values are uniform in +- amplitude, N m */
    double interval;          /* between noise values, s */
    double per_interval;      /* 1/s */
    uint64_t stream;          /* what the seed has been mixed to */
    double per_speed;         /* c of what follows the wheel's speed w: c w + c2 w |w| (N m s) */
    double per_speed_squared; /* c2 (N m s2) */
} load_signal;

load_signal load_create(double mean, double amplitude, double interval, uint64_t seed);

/* Coefficients of the noise between the values k and k + 1: powers of (time / interval - k), N m. */
void load_noise_cubic(const load_signal *load, int64_t k, double coefficients[4]);

/* The four values that such a cubic is made of, from the value k - 1 on. */
typedef struct noise_values {
    int is_known;
    int64_t k;
    double value[4]; /* shares of the amplitude */
} noise_values;

/* The same, where most of the values are known from the cubic before: the four of this one are kept. */
void load_noise_next(const load_signal *load, int64_t k, noise_values *kept,
                     double coefficients[4]);

/* Mean or table at a time, without the noise (N m). */
double load_steady(const load_signal *load, double time);

/* With the noise, constant cost at any t (N m). */
double load_torque(const load_signal *load, double time);

/* A torque with the noise added. */
double load_with_noise(const load_signal *load, double torque, double time);

/* What follows the speed of the wheel in rad/s (N m), and its derivative by that speed (N m s). */
double load_at_speed(const load_signal *load, double wheel_speed);
double load_by_speed(const load_signal *load, double wheel_speed);

/* A piece of the noise that is kept from one integral to the next, as most of them lie in the same piece or the one after. */
typedef struct noise_piece {
    noise_values values;
    double coefficients[4];
    double integral[4]; /* of the cubic from the piece's beginning on: powers 1 to 4 */
} noise_piece;

/*
 * Integral of the noise from one time to a later one, weighted by a straight line between the weights at both, exact:
 * the sum of the closed forms of its cubic pieces (weight times N m s). No noise before t = 0, where the gears rest.
 */
double load_noise_integral(const load_signal *load, double from, double to, double first_weight,
                           double last_weight, noise_piece *kept);

/* Noise value k as a share of the amplitude, uniform in (-1, 1). */
double load_noise_value(const load_signal *load, int64_t k);

#endif
