/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Stretches of a line along which the flanks touch: line.c finds where they begin and end, stretch.c integrates over them.
 */
#ifndef GEARMESH_STRETCH_H
#define GEARMESH_STRETCH_H

#include "internal.h"
#include "line.h"

/* Index of the cell that holds v, clamped into the table against rounding at its rim. */
static inline int gmi_cell_index(double v, int last) {
    const int cell = v > 0.0 ? (int)v : 0;
    return cell < last ? cell : last;
}

#define GMI_NOWHERE (-1e300) /* place where flanks touch since, while they do not */

/*
 * What is found along a line. Places are counted in cells of the table that leads. Where a piece ends the flanks touch if f is
 * above 0 there, so that pieces along which f has one sign change nothing.
 */
typedef struct gmi_stretches {
    const gmi_line *line;
    const gmi_grid *pinion, *wheel;
    double t1_zero, per_place; /* t1 = t1_zero + per_place times the place */
    double since;              /* where the flanks touch since, or GMI_NOWHERE */
    double since_moves;        /* d place / d f there if that is a root of f, else 0 */

    /* Integrals over the stretches so far. */
    double sum, sum_t1; /* of f, and times t1 */
    double contact[4];  /* of 1, t1, t1^2, t1^3 */
    double
        slopes[3]
              [2]; /* of the pinion's table by v2, the wheel's, the wheel's by v1; times 1 and t1 */
    gmi_line_tangent *tangent;
} gmi_stretches;

/* Adds the stretch from `since` to a place; d place / d f there if that is a root of f, else 0. */
void gmi_stretches_add(gmi_stretches *found, double to_place, double to_moves);

/* All stretches of a line or of a part of it are known: adds what they give to its tangent. */
void gmi_stretches_finish(gmi_stretches *found);

/* f of a line at t1. */
double gmi_stretches_value(const gmi_stretches *found, double t1);

static inline void gmi_stretches_begin(gmi_stretches *found, double place, double moves) {
    found->since = place;
    found->since_moves = moves;
}

static inline void gmi_stretches_end(gmi_stretches *found, double place, double moves) {
    if (found->since > GMI_NOWHERE) {
        gmi_stretches_add(found, place, moves);
        found->since = GMI_NOWHERE;
    }
}

#endif
