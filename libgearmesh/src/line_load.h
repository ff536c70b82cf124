/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The lines of a side as those see them who look at single places on them: line_load.c, other_flanks.c. */
#ifndef GEARMESH_LINE_LOAD_H
#define GEARMESH_LINE_LOAD_H

#include "contact.h"
#include "elastic.h"
#include "elastic_mesh.h"
#include "internal.h"
#include "mesh.h"
#include "tilt.h"

/* One side, whose lines have been found. */
typedef struct gmi_side_lines {
    int side;
    gmi_lines lines;
    gmi_teeth teeth;
    double delta;           /* ideal penetration (m) */
    double speeds[2];       /* [enum gm_role] of both gears, in the signs of ISO 21771 (rad/s) */
    double reach;           /* rho_p + rho_w (m) */
    gmi_elastic_work *work; /* solved; NULL with constant stiffness */
    gmi_elastic_tips tips;  /* of lines that go on beyond the path, of elastic teeth */
    int has_tips;
    gmi_lines
        path; /* the lines as far as the path goes, where corners of constant stiffness touch beyond it */
} gmi_side_lines;

/* Which part of the lines of a side is on both flanks: that of parallel axes, or of tilted ones with constant stiffness. */
typedef struct gmi_side_ends {
    gmi_line_ends path;
    int first, last; /* lines between parallel axes */
    int is_tilted;
    gmi_tilt_cuts cuts;
} gmi_side_ends;

/* Of found->lines, to which tilted axes may add one at both ends. */
void gmi_side_ends_find(const gm_mesh *mesh, gmi_side_lines *found, gmi_side_ends *ends);

/* That of line `index`; empty if from >= to. listed: between parallel axes. */
gmi_interval gmi_side_line_part(const gmi_side_ends *ends, const gm_mesh *mesh,
                                const gmi_side_lines *found, int index, gmi_interval listed);

/* Where the overlap along a line bends next behind t1, or `to`: up to there it is a parabola, but for corners. */
double gmi_line_next_bend(const gm_mesh *mesh, const gmi_side_lines *found, double origin,
                          double t1, double to);

/*
 * other_flanks.c: adds to force_by[count] the derivatives of the net force by what is added to the flanks of one side, with
 * constant stiffness: as gm_mesh_force_by_flanks(), of a position that has been checked and posed.
 */
void gmi_side_by_flanks(const gm_mesh *mesh, int side, const gm_position *position,
                        const gm_flanks **pinion_changes, const gm_flanks **wheel_changes,
                        int count, double *force_by);

#endif
