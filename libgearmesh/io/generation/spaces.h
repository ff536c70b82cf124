/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file spaces.h
 * Pitch deviations as a tool leaves them: each tooth space is moved as a whole, and both of its flanks follow.
 *
 * A space is moved radially by y and, in the positive direction of rotation, by x. y is a pure first order of the
 * rotation, which alone makes the run-out; x is a first order too, a quarter of a turn apart and with another amplitude,
 * and errors of single spaces. All are given as arcs at the reference circle.
 */
#ifndef GEARMESH_SPACES_H
#define GEARMESH_SPACES_H

#include "gearmesh/gearmesh_io.h"

typedef struct gmi_spaces {
    int teeth;
    double *cosine;    /**< [teeth] of the first order */
    double *sine;      /**< [teeth] */
    double *error;     /**< [teeth] errors of single spaces */
    double radial;     /**< amplitude of what y is to each flank */
    double tangential; /**< amplitude of x */
    double factor;     /**< multiplies the errors */
} gmi_spaces;

/** Spaces with their arrays in work[3 * teeth], the first order begins at `phase` turns; the rest is left to fill. */
gmi_spaces gmi_spaces_begin(int teeth, double *work, double phase);

/** Place of a flank without the errors; side = 1 or -1, as y moves it ahead or back. */
double gmi_spaces_first_order(const gmi_spaces *of, int space, double side);

/** Writes them as material on all flanks, to 1e-10 m. */
void gmi_spaces_to_pitch(const gmi_spaces *of, gm_pitch *pitch, const gm_gear *gear, int wheel);

#endif /* GEARMESH_SPACES_H */
