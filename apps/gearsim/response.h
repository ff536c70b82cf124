/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Response p(t) of the linear mesh to the noise of the load, to rounding:
 *
 *     p'' + 2 zeta w0 p' + w0^2 p = gain * noise(t),    p(0) = p'(0) = 0.
 *
 * The noise changes much faster than anything else in a run; a solver that has to follow it takes several
 * steps from each noise value to the next. It is a cubic between its values, though, so that p is a quick
 * power series there. The model takes it off x and leaves the solver the rest, x - p, which moves at
 * the pace of the teeth. Nothing is neglected: what p assumes of the mesh is put back into the equation
 * of motion, so that w0 and zeta decide on the effort alone.
 */
#ifndef GEARSIM_RESPONSE_H
#define GEARSIM_RESPONSE_H

#include "load.h"

typedef struct response response;

typedef struct response_value {
    double offset; /* p (m) */
    double rate;   /* p' (m/s) */
} response_value;

/* Gain in m/s2 per N m, frequency w0 in rad/s, 0 < damping ratio < 1. NULL: out of memory. */
response *response_create(const load_signal *load, double gain, double frequency,
                          double damping_ratio);
void response_free(response *linear);

/* Whether it is worth it: there is noise, and its values are not denser than the steps of a solver that follows it. */
int response_is_useful(const load_signal *load, double frequency);

/* Cheap forward in time, and some hundred noise values back from the latest time asked for; farther back
 * it starts again from zero. Not for several threads at once. */
response_value response_at(response *linear, double time);

/*
 * What the noise has given x' up to some times (m/s), the integral of gain * noise, with p', and p if it is wanted. What
 * spring and damper of the linear mesh have carried, the integral of 2 zeta w0 p' + w0^2 p, is that less p'.
 */
typedef struct response_sum {
    double given;
    response_value value;
} response_sum;

void response_given(response *linear, int count, const double times[], int with_offset,
                    response_sum sums[]);

#endif
