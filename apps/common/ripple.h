/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Ripple of a speed or a torque: harmonics of the pinion's turn,
 *
 *     sum of amplitude sin(order angle + phase).
 */
#ifndef APPS_RIPPLE_H
#define APPS_RIPPLE_H

#include <stddef.h>

enum { RIPPLE_HARMONICS = 32 };

typedef struct harmonic {
    double order;     /* per turn, > 0 */
    double amplitude; /* in the unit of what ripples */
    double phase;     /* rad */
} harmonic;

typedef struct ripple {
    int count; /* 0 = none */
    harmonic harmonics[RIPPLE_HARMONICS];
} ripple;

/* Reads "ORDER:AMPLITUDE:PHASE_DEG" with commas between harmonics. Returns 0, or -1 and what would be right. */
int ripple_parse(ripple *made, const char *text, char *fault, size_t fault_size);

/* The same with all amplitudes multiplied. */
ripple ripple_scaled(const ripple *given, double factor);

/* Sum of the harmonics at an angle in rad, and its derivative by the angle. */
double ripple_value(const ripple *made, double angle);
double ripple_slope(const ripple *made, double angle);

/* Most that a derivative of the sum, 0 or a higher one, can reach at any angle. */
double ripple_largest(const ripple *made, int derivative);

/* 0 without any. */
double ripple_highest_order(const ripple *made);

#endif
