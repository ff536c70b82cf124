/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file random.h
 * Random numbers, and a sine, that are the same bits on every machine: integers and + - * / only, as those of the
 * C libraries differ. A stream is its state, from gmi_random_bits() of shared.h.
 */
#ifndef GEARMESH_RANDOM_H
#define GEARMESH_RANDOM_H

#include <stdint.h>

/** Uniform in [low, high). */
double gmi_random_uniform(uint64_t *state, double low, double high);

/** Normal: the sum of 12 uniform numbers, which never is farther from the mean than 6 standard deviations. */
double gmi_random_normal(uint64_t *state, double mean, double deviation);

/** sin(2 pi turns), to 1e-15. */
double gmi_sine_of_turns(double turns);

/** To 1e-10 m: plain numbers in a file, and no trace of the last bit of a libm. */
double gmi_rounded(double value);

#endif /* GEARMESH_RANDOM_H */
