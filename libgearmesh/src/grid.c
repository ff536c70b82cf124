/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * How the lines of contact of one side run through the tables of one gear.
 */
#include "grid.h"

#include "flank.h"
#include "internal.h"

#include <math.h>

/* Spur gears: the line climbs by nothing that could be seen, and yet u follows from the crossing ahead. */
#define LEAST_RATE 1e-30

/* In place of a table that is not there. */
static const gmi_grid ideal_grid = {0};

void gmi_grid_set_rates(gmi_grid *grid, double face_ratio) {
    grid->face_ratio = face_ratio;
    grid->rate = gmi_larger(grid->climb * face_ratio / grid->face_rate, LEAST_RATE);
    grid->profile_spacing = 1.0 / grid->rate;
    grid->face_kick = 0.5 * face_ratio;
    grid->profile_kick = 0.5 * grid->rate;
    grid->bend = grid->rate * face_ratio;
}

void gmi_grid_init(gmi_grid *grid, const gmi_tables *tables, double climb, double length,
                   double face_origin, double face_scale) {
    if (tables == NULL || tables->profile_nodes == 0) {
        *grid = ideal_grid;
        return;
    }
    grid->is_wide = 0;

    /* Cells and strides, counted the way the line climbs. */
    const int upwards = climb > 0.0;
    const double profile_cells = (double)(tables->profile_nodes - 1);
    grid->last_face = tables->face_nodes - 2;
    grid->last_profile = tables->profile_nodes - 2;
    grid->row = (ptrdiff_t)tables->profile_nodes * GMI_NODE_DOUBLES;
    grid->step = upwards ? GMI_NODE_DOUBLES : -GMI_NODE_DOUBLES;
    grid->corner = upwards ? 0 : grid->row - GMI_NODE_DOUBLES;
    grid->direction = upwards ? 1.0 : -1.0;
    grid->base = upwards ? 0.0 : profile_cells;
    grid->profile_cells = profile_cells;
    grid->face_origin = face_origin;
    grid->face_scale = face_scale;

    /* Grid lines per t1, and per length along the line of action. */
    grid->face_rate = (double)(tables->face_nodes - 1) * face_scale;
    grid->face_base = (double)(tables->face_nodes - 1) * face_origin;
    grid->per_rho = profile_cells / length;
    grid->climb = fabs(climb) * grid->per_rho;
    gmi_grid_set_rates(grid, 1.0);
}

void gmi_grid_move(gmi_grid *grid, double face_origin) {
    if (grid->face_rate > 0.0) {
        grid->face_base = (double)(grid->last_face + 1) * face_origin;
        grid->face_origin = face_origin;
    }
}

void gmi_grid_hold(gmi_grid *grid) {
    if (grid->face_rate > 0.0) {
        grid->climb = 0.0;
        gmi_grid_set_rates(grid, grid->face_ratio);
    }
}
