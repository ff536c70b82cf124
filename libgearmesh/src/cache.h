/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The cache as cache.c keeps it and mesh.c asks it. */
#ifndef GEARMESH_CACHE_H
#define GEARMESH_CACHE_H

#include "contact.h"
#include "internal.h"

/* The first node of a column: where contact begins. */
typedef struct gmi_cache_start {
    double delta; /* (m); NaN = not filled yet, infinite = no contact */
    double ahead; /* what the first cell is shorter by than a step, in steps: 0 .. 1 */
} gmi_cache_start;

struct gm_cache {
    const gm_mesh *mesh;
    const gm_pair *pair;      /* of the mesh */
    int side;                 /* GM_DRIVE or GM_COAST */
    int pinion_period;        /* 1 if all teeth of the pinion have the same flank, else z_p */
    int wheel_period;         /* likewise */
    int common;               /* greatest common divisor of both */
    int passes;               /* tooth passes: least common multiple of both periods */
    int columns;              /* phases per tooth pass before p_bt */
    int has_weak_kinks;       /* which have no columns of their own */
    int has_corners;          /* of a constant stiffness: torques need arms too */
    int nodes;                /* places in delta per phase */
    double depth;             /* as in the parameters (m) */
    double step;              /* of delta (m) */
    double per_step;          /* its inverse (1/m) */
    double lowest;            /* nothing touches at or below this delta (m) */
    double columns_per_phase; /* on average (1/m) */
    double *phases;           /* [columns + 1] 0 .. p_bt (m) */

    gmi_cache_start *starts; /* [passes][columns] */
    float *values;           /* [passes][columns][nodes][4] */
    float *
        arms; /* [passes][columns][nodes][enum gm_role] with corners: integral of f gap' at that tip (m) */
};

/* That of one tip (m): by how much shorter its gear's arm is, over its r_b, times the sum; and how it changes (1). */
typedef struct gmi_cache_arm {
    double value, by_origin, by_delta;
} gmi_cache_arm;

/*
 * The sum of the side that the cache holds, by a mask of enum gmi_wanted, and with corners their arms, else unset. 0 where the exact
 * evaluation has to answer.
 */
int gmi_cache_look_up(gm_cache *cache, const gm_position *position, int wanted,
                      gm_workspace *workspace, gmi_side_sum *sum, gmi_cache_arm arms[2]);

#endif
