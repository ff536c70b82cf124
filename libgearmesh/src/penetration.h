/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The sums over all lines of one side, by what its flanks are, and what both sides together are for the user: inlined where
 * the library evaluates.
 */
#ifndef GEARMESH_PENETRATION_H
#define GEARMESH_PENETRATION_H

#include "contact.h"
#include "flank.h"
#include "internal.h"
#include "line.h"
#include "meshing.h"
#include "ramp.h"
#include "tilt.h"

/* One side of a mesh: what all its evaluations have in common. */
typedef struct gmi_side {
    const gmi_tables *pinion; /* NULL = ideal */
    const gmi_tables *wheel;
    gmi_grid pinion_grid; /* not set where both flanks are ideal */
    gmi_grid wheel_grid;
    int ramps;         /* of both flanks */
    int is_tilted;     /* the axes are */
    int starts_deeper; /* than a table begins: the flank then goes on as ramp.c says */
    int leaves_tables; /* lines may be beyond ends of tables, see there */
    double tilt_bound; /* what tilted axes add to the overlap at most (m) */
    double tilt_reach; /* by what they move the ends of lines at most (m) */
    double flank_peak; /* most material of both flanks (m) */
    double peak;       /* both: nothing touches at a delta <= -peak (m) */
} gmi_side;

/* Which tables end lines between tilted axes, as gmi_tilt_cuts_find() has it: none of spur gears, along which lines run. */
static inline int gmi_side_table_ends(const gm_pair *pair, const gmi_side *prepared) {
    if (!prepared->is_tilted || pair->face_advance == 0.0) {
        return 0;
    }
    const int has_pinion = prepared->pinion != NULL && prepared->pinion_grid.face_rate > 0.0;
    const int has_wheel = prepared->wheel != NULL && prepared->wheel_grid.face_rate > 0.0;
    return (has_pinion ? GMI_ENDS_WITH_PINION_TABLE : 0) +
           (has_wheel ? GMI_ENDS_WITH_WHEEL_TABLE : 0);
}

void gmi_side_init(gmi_side *prepared, const gm_pair *pair, const gmi_engagement *at,
                   const gm_flanks *pinion_flanks, const gm_flanks *wheel_flanks, int side);

/* The same side in another pose. */
void gmi_side_move(gmi_side *prepared, const gm_pair *pair, const gmi_engagement *at, int side);

/*
 * A side of flanks without ramps between parallel axes at all depths from one walk: `part` has the sums in the end.
 */
void gmi_side_sum_depths(const gm_pair *pair, const gmi_engagement *at, const gmi_side *prepared,
                         int side, const gm_position *position, gmi_depths *depths);

void gmi_side_sum_tables(const gm_pair *pair, const gmi_engagement *at, const gmi_side *prepared,
                         int side, const gm_position *position, int wanted, gmi_side_sum *total);

/* gmi_side_sum.pairs of such a side alone. */
int gmi_side_count_pairs(const gm_pair *pair, const gmi_engagement *at, const gmi_side *prepared,
                         int side, const gm_position *position);

void gmi_side_sum_simple(const gm_pair *pair, const gmi_engagement *at, int side, double offset,
                         gmi_side_sum *total);

/* All of it NaN. */
gm_penetration gmi_penetration_nan(void);

/* Nothing reaches across the gap: the usual state of one of both sides. */
static inline int gmi_side_is_clear(const gmi_engagement *at, const gmi_side *prepared, int side,
                                    double offset) {
    return gmi_ideal_penetration(at, side, offset) + prepared->peak <= 0.0;
}

/* The integral along a line or a part of it, with the grids that it runs through. */
static inline void gmi_flanks_integrate(const gmi_side *prepared, const gmi_grid *pinion_grid,
                                        const gmi_grid *wheel_grid, const gmi_line *line,
                                        int wanted, gmi_line_sum *sum) {
    if (wanted & GMI_TANGENT) {
        if (prepared->ramps > 0) {
            gmi_ramps_integrate_tangent(line, pinion_grid, wheel_grid, prepared->pinion,
                                        prepared->wheel, sum);
        } else {
            gmi_line_integrate_tangent(line, pinion_grid, wheel_grid, sum);
        }
    } else if (prepared->ramps > 0) {
        gmi_ramps_integrate(line, pinion_grid, wheel_grid, prepared->pinion, prepared->wheel,
                            wanted, sum);
    } else if (wanted & GMI_SQUARES) {
        gmi_line_integrate_squares(line, pinion_grid, wheel_grid, sum);
    } else if (wanted == GMI_SUM) {
        gmi_line_integrate_sum(line, pinion_grid, wheel_grid, sum);
    } else {
        gmi_line_integrate(line, pinion_grid, wheel_grid, wanted, sum);
    }
}

/* The integral along any line of a side; wanted: a constant. */
SPECIALIZED void gmi_flanks_integrate_line(const gmi_side *prepared, const gmi_line *line,
                                           int wanted, gmi_line_sum *sum) {
    const gmi_grid *pinion = &prepared->pinion_grid, *wheel = &prepared->wheel_grid;
    if (!prepared->leaves_tables || !(gmi_line_leaves_table(pinion, line->pinion_profile, line) ||
                                      gmi_line_leaves_table(wheel, line->wheel_profile, line))) {
        gmi_flanks_integrate(prepared, pinion, wheel, line, wanted, sum);
    } else if (wanted & GMI_TANGENT) {
        gmi_ramps_integrate_tangent_beyond(line, pinion, wheel, prepared->pinion, prepared->wheel,
                                           sum);
    } else {
        gmi_ramps_integrate_beyond(line, pinion, wheel, prepared->pinion, prepared->wheel, wanted,
                                   sum);
    }
}

/* The sum of a side that is not clear; wanted: mask of enum gmi_wanted. */
static inline void gmi_side_sum_3d(const gm_pair *pair, const gmi_engagement *at,
                                   const gmi_side *prepared, int side, const gm_position *position,
                                   int wanted, gmi_side_sum *total) {
    *total = gmi_no_contact();
    if (prepared->pinion == NULL && prepared->wheel == NULL && !at->is_tilted) {
        gmi_side_sum_ideal(pair, at, side, position, wanted, total);
    } else {
        gmi_side_sum_tables(pair, at, prepared, side, position, wanted, total);
    }
}

/*
 * What both sides together are for the user; approach: speed at which the flanks of each side approach each other;
 * derivatives NaN where they were not wanted. These go from line origin and
 * delta to angles. Drive: origin grows with r_bp phi_p, delta with x; coast: both with the opposite sign, and it counts
 * negatively in the net sum, so that the signs are the same again.
 */
static inline void gmi_penetration_set(const gm_pair *pair, const gmi_side_sum *drive,
                                       const gmi_side_sum *coast, const double approach[2],
                                       int wanted, gm_penetration *result) {
    result->drive = drive->sum;
    result->coast = coast->sum;
    result->penetration = drive->sum - coast->sum;

    result->drive_contact = drive->contact;
    result->coast_contact = coast->contact;
    result->drive_pairs = drive->pairs;
    result->coast_pairs = coast->pairs;

    result->drive_rate = approach[GM_DRIVE] * drive->contact;
    result->coast_rate = approach[GM_COAST] * coast->contact;
    result->rate = result->drive_rate - result->coast_rate;

    result->d_pinion_angle = result->d_wheel_angle = gmi_nan();
    if (wanted & GMI_DERIVATIVES) {
        const double by_offset = drive->by_delta + coast->by_delta;
        const double by_origin = drive->by_origin + coast->by_origin;
        result->d_pinion_angle = pair->pinion.base_radius * (by_offset + by_origin);
        result->d_wheel_angle = -pair->wheel.base_radius * by_offset;
    }
}

#endif
