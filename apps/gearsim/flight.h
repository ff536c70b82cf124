/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * How long the teeth stay apart.
 *
 * Between two contacts x follows a parabola and the solver's error estimate is zero: its steps grow without
 * bound, and a short touch between two of them is lost. The motion up to the next touch is known, though,
 * and so is what the flanks can do meanwhile. A time is clear of contact if, with the flanks moved together
 * by all that they can approach in it, nothing touches at its beginning and at its end.
 */
#ifndef GEARSIM_FLIGHT_H
#define GEARSIM_FLIGHT_H

#include "model.h"

typedef struct flight_options {
    double longest;         /* time to look ahead (s) */
    double speed_tolerance; /* error of x' that a missed touch may make (m/s), > 0 */
} flight_options;

/*
 * Whether the noise of the load changes x' within the longest step by so much more than the tolerance that the solver
 * has to take short steps in flight as well. It does so where the noise is taken off the state too: what is left
 * follows the noise's response.
 */
int flight_noise_guides(const gear_model *model, const flight_options *options);

/*
 * Time from here on in which no flank touches, for a state in which none does (s).
 *
 * At most `longest`. At least the time in which a touch changes x' by less than the tolerance: shorter
 * touches may be missed, and a contact that is about to begin is reached in a last step of that length.
 * Adds the evaluations of the mesh to *evaluations: none for ideal flanks and the simple model, whose gap
 * depends on x alone, and none while the highest points of both flanks are too far apart to meet.
 */
double flight_clear_time(const gear_model *model, double time, const double state[],
                         const flight_options *options, long *evaluations);

/*
 * Longest step of a light contact (s). The solver's error estimate sees what a step ends in, but not that more teeth
 * touch for a moment within it, or that the teeth part and meet again. Such a touch begins at a point and widens with
 * its depth, over a time T to the whole line: in the time h it changes x' by w0^2 v h^3 / (2 T), where one of the
 * whole line changes it by w0^2 v h^2 / 2. With the shortest touch h_0 of flight_clear_time(), h^3 = T h_0^2. T of a
 * few vibrations was found by trying: with it the errors of bouncing teeth follow the tolerance.
 */
double flight_light_step(const gear_model *model, double time, const double state[],
                         const flight_options *options);

#endif
