/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* A line of contact over flanks with ramps: linear reliefs along face and profile. */
#ifndef GEARMESH_RAMP_H
#define GEARMESH_RAMP_H

#include "flank.h"
#include "internal.h"
#include "line.h"

/* gmi_line_integrate() with the ramps of both flanks, NULL = none, taken off. */
void gmi_ramps_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                         const gmi_tables *pinion_tables, const gmi_tables *wheel_tables,
                         int wanted, gmi_line_sum *result);
void gmi_ramps_integrate_tangent(const gmi_line *line, const gmi_grid *pinion,
                                 const gmi_grid *wheel, const gmi_tables *pinion_tables,
                                 const gmi_tables *wheel_tables, gmi_line_sum *result);

/*
 * The same of a line that leaves a table: beyond its ends a flank has the deviation of the end. Also without ramps. A tangent
 * is apart, as it takes more stack.
 */
void gmi_ramps_integrate_beyond(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                                const gmi_tables *pinion_tables, const gmi_tables *wheel_tables,
                                int wanted, gmi_line_sum *result);
void gmi_ramps_integrate_tangent_beyond(const gmi_line *line, const gmi_grid *pinion,
                                        const gmi_grid *wheel, const gmi_tables *pinion_tables,
                                        const gmi_tables *wheel_tables, gmi_line_sum *result);

/* Rounding of where a line ends (cells): what is this little beyond a table counts as within it. */
#define GMI_TABLE_END_ROUNDING 1e-9

/* Where a line is in a table at t1 (cells of v2). */
static inline double gmi_profile_at(const gmi_grid *grid, double profile, double t1) {
    return profile + grid->direction * grid->climb * t1;
}

static inline int gmi_is_beyond_table(const gmi_grid *grid, double place, double rounding) {
    return grid->face_rate > 0.0 &&
           !(place >= -rounding && place <= grid->profile_cells + rounding);
}

/* Whether a line leaves a table of a gear: lines are straight, so that their ends tell. */
static inline int gmi_line_leaves_table(const gmi_grid *grid, double profile,
                                        const gmi_line *line) {
    const double from = gmi_profile_at(grid, profile, line->from);
    const double to = gmi_profile_at(grid, profile, line->to);
    return gmi_is_beyond_table(grid, from, GMI_TABLE_END_ROUNDING) ||
           gmi_is_beyond_table(grid, to, GMI_TABLE_END_ROUNDING);
}

#endif
