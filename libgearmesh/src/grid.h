/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* How the lines of contact of one side run through the tables of one gear. */
#ifndef GEARMESH_GRID_H
#define GEARMESH_GRID_H

#include "flank.h"
#include "internal.h"

#include <stddef.h>

/*
 * How the lines of one side run through the tables of one gear: the same for all its teeth and all lines. Lines are
 * followed in grid units: v1 = face_rate t1 across the face, s = v1 of the table whose face lines lead, and along
 * the profile u = v2 counted in the direction in which the lines climb. All zero for ideal flanks; a flank with ramps
 * and no tables is one cell, so that v2 = t2.
 */
typedef struct gmi_grid {
    int is_wide;      /* whether the processor has vectors of four doubles, see wide.h */
    int shares_faces; /* of the wheel's: the face lines of both gears' tables are the same */
    int last_face, last_profile;    /* indices of the last cell */
    ptrdiff_t row;                  /* doubles from one face line to the next */
    ptrdiff_t step;                 /* doubles from one profile line to the next, signed */
    ptrdiff_t corner;               /* doubles from node 0 of a face line to that with u = 0 */
    double base, direction;         /* u = base + direction v2, direction +1 or -1 */
    double profile_cells;           /* largest u */
    double face_base, face_rate;    /* v1 = face_base + face_rate t1, t1 of the common face */
    double face_origin, face_scale; /* t1 of this gear = face_origin + face_scale t1 */
    double climb;                   /* d u / d t1 >= 0 */
    double per_rho;                 /* d v2 / d rho (1/m) */
    double face_ratio;              /* d v1 / d s: 1 for the table that leads */
    double rate;                    /* d u / d s > 0 */
    double profile_spacing;         /* its inverse */
    /* Half slope and curvature of f change by these times the second difference of the nodes. */
    double face_kick, profile_kick, bend;
} gmi_grid;

/* climb: d rho / d t1 of this gear along a line, signed (m); length: rho from start to tip (m); own t1 of the gear. */
void gmi_grid_init(gmi_grid *grid, const gmi_tables *tables, double climb, double length,
                   double face_origin, double face_scale);

/* face_ratio: d v1 / d s, where another table leads. */
void gmi_grid_set_rates(gmi_grid *grid, double face_ratio);

/* The table of this gear now begins at another place along the common face. */
void gmi_grid_move(gmi_grid *grid, double face_origin);

/* Lines stay where they are along the profile of this table. */
void gmi_grid_hold(gmi_grid *grid);

#endif
