/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file elastic_model.h
 * Elastic teeth a second time, by another method and in long double: the loads are the unknowns, the teeth a full matrix of
 * compliance between all points of contact, and an active set says which of them touch. The gap of a tip edge is found by
 * turning gears in the plane until they touch. Shares no code with the core but the compliance of a tooth, whose tests are
 * its own.
 */
#ifndef ELASTIC_MODEL_H
#define ELASTIC_MODEL_H

#include "elastic.h"
#include "elastic_gear.h"

typedef struct elastic_answer {
    long double force; /**< dU/dx */
    long double energy;
    long double line_force[GMI_ELASTIC_LINES_MAX]; /**< in ascending order of the lines */
    int index[GMI_ELASTIC_LINES_MAX];
    int lines, points;
} elastic_answer;

/**
 * softness: of the teeth of line k, [2][3], by k mod 3; NULL = whole. tip_rounding: of edges that touch beyond the path, in
 * modules; 0 = lines end with the path, else they are cut where it ends and by `cut` beyond (at the wheel's tip, the
 * pinion's; m). Returns 0 if it does not converge.
 */
int elastic_model_solve(const elastic_gear *g, const elastic_deviation *d,
                        const double softness[2][3], double tip_rounding, const double cut[2],
                        double o, double x, elastic_answer *answer);

#endif /* ELASTIC_MODEL_H */
