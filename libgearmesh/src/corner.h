/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Corner contact: before and after the ideal path of contact the tip edge of one gear touches the flank of its mate, off
 * the line of action. All in the transverse section and in the signs of ISO 21771, so that rings are the same.
 */
#ifndef GEARMESH_CORNER_H
#define GEARMESH_CORNER_H

#include "internal.h"

/* The tip corner of one gear, as it comes to the mate's flank or goes off it. */
typedef struct gmi_corner {
    double tip_base;       /* r_b of the gear whose tip it is (m) */
    double mate_base;      /* of the gear whose flank it touches (m) */
    double line_of_action; /* T (m) */
    double tip_roll;       /* rho_a (m) */
    double mate_roll;      /* of the flank touched, at the end of the path: T - rho_a (m) */
    double along, across;  /* of the centre distance times r_a: the parts of its way (m2) */
    double reach;          /* roll beyond the path after which it is off the mate's flank (m) */
} gmi_corner;

/* Where the corner is after some roll beyond the end of the path. */
typedef struct gmi_corner_place {
    double gap;           /* between corner and flank: what the overlap falls by (m) */
    double by_roll;       /* its first derivative by the roll (1) */
    double by_roll_twice; /* and the second (1/m) */
    double by_length;     /* its derivative by T (1) */
    double mate_roll;     /* roll length of the flank touched, its radius of curvature there (m) */
    double turn;          /* of the normal from the line of action, with the axes held (rad) */
    double
        tip_arm; /* of that normal about the axis of the tip: d overlap / d angle (m); about the other: mate_base */
} gmi_corner_place;

/*
 * role: enum gm_role of the gear whose tip it is: the wheel's where a pair enters, the pinion's where it leaves. Returns 0
 * if the tip reaches beyond the mate's base tangent point, or closer than a hundredth of the base pitch: there is no flank
 * to touch.
 */
int gmi_corner_init(const gm_pair *pair, const gmi_engagement *at, int role, gmi_corner *corner);

/* roll: of the gear whose tip it is, beyond the end of the path, 0 .. reach (m). Basic arithmetic and roots alone. */
void gmi_corner_at(const gmi_corner *corner, double roll, gmi_corner_place *place);

#endif
