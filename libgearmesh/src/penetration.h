/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The sum of a side by what its flanks are, and what both sides together are for the user: inlined where the library
 * evaluates. Apart from internal.h, as it calls contact.c and penetration.c, which need that.
 */
#ifndef GEARMESH_PENETRATION_H
#define GEARMESH_PENETRATION_H

#include "internal.h"

/* Nothing reaches across the gap: the usual state of one of both sides. */
static inline int gmi_side_is_clear(const gmi_engagement *at, const gmi_side *prepared, int side,
                                    double offset) {
    return gmi_ideal_penetration(at, side, offset) + prepared->peak <= 0.0;
}

/* Whether one walk tells of many depths: flanks of tables between parallel axes, with teeth of a constant stiffness. */
static inline int gmi_side_has_depths(const gm_mesh *mesh, int side) {
    const gmi_side *prepared = &mesh->side[side];
    return mesh->model != GM_MODEL_SIMPLE && mesh->elastic == NULL && !mesh->has_corners &&
           mesh->pair->face_advance != 0.0 && prepared->ramps == 0 && !prepared->is_tilted &&
           (prepared->pinion != NULL || prepared->wheel != NULL);
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
    } else {
        gmi_line_integrate(line, pinion_grid, wheel_grid, wanted, sum);
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
