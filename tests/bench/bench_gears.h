/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file bench_gears.h
 * Gear pairs to measure with: the reference pair and its relatives with other numbers of teeth, helix angles and
 * tables. All teeth of both gears have different tables, made as those of data/paper/ are; or linear reliefs, the same on
 * all teeth: at the tip (10 um over 0.3 of the profile) and at its corners (15 um over 4 mm and the same share).
 */
#ifndef BENCH_GEARS_H
#define BENCH_GEARS_H

#include "gearmesh/gearmesh.h"

#define BENCH_STIFFNESS 1.05e8 /**< K of one tooth pair (N/m) */
#define BENCH_DAMPING   844.361
#define BENCH_TORQUE    20.0 /**< wheel torque of the states (N m) */

/** Number of states that every measurement goes through again and again. */
enum { BENCH_STATES = 256 };

/** What the flanks have; the reliefs exactly, or in one table for all teeth that is as true as tables can be. */
enum bench_reliefs { BENCH_NO_RELIEFS, BENCH_RAMPS, BENCH_RELIEF_TABLE };

/** What can be varied; bench_params_default() is the reference pair. */
typedef struct bench_params {
    int pinion_teeth, wheel_teeth;
    double helix_angle_deg;
    int face_nodes, profile_nodes; /**< of the tables of all teeth; 0 = none */
    int reliefs;        /**< enum bench_reliefs; BENCH_RELIEF_TABLE without other tables only */
    double first_angle; /**< pinion angle from which on the states lie (rad) */
} bench_params;

/** A pair, its flanks, and states in quasi-static equilibrium all over the hunting period. */
typedef struct bench_gears {
    gm_pair pair;
    gm_flanks *flanks[2];                /**< pinion, wheel; NULL = ideal */
    gm_mesh *mesh;                       /**< of pair and flanks, 3D model */
    gm_state states[BENCH_STATES];       /**< as angles */
    gm_position positions[BENCH_STATES]; /**< the same, reduced */
    double mean_sum;                     /**< mean penetration of the states (m) */
    double mean_pieces, mean_lines;      /**< smooth pieces and lines of contact per evaluation */
} bench_gears;

bench_params bench_params_default(void);

/** Ends the program with a message if anything fails. */
void bench_gears_make(bench_gears *gears, const bench_params *params);
void bench_gears_free(bench_gears *gears);

/** Ends the program unless the status is GM_OK. */
void bench_check(int status, const char *what);

#endif /* BENCH_GEARS_H */
