/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Material of the flanks at the points of elastic teeth: tables, linear reliefs, pitch, and what tilted axes make of it.
 */
#include "elastic_mesh.h"

#include "internal.h"
#include "surface.h"

#include <string.h>

/* Whether there is anything at all beside the drawing. */
static int is_drawn(const gm_mesh *mesh, int side) {
    const gmi_side *prepared = &mesh->side[side];
    return prepared->pinion == NULL && prepared->wheel == NULL && !prepared->is_tilted;
}

/* Arrays for the tables of a gear, in what is free before the balance is sought: matrices and forces of the points. */
static gmi_surface_cells cells_in(const gmi_elastic_work *work, int role) {
    const int count = 2 * work->slots;
    double *free = work->table[2 * role];
    const gmi_surface_cells cells = {free,
                                     free + count,
                                     role == GM_PINION ? work->force : work->stiffness,
                                     work->table[2 * role + 1],
                                     work->table[2 * role + 1] + count,
                                     role == GM_PINION ? work->load : work->slope,
                                     role == GM_PINION ? work->approach_at : work->deflection};
    return cells;
}

/* Beyond the path the flanks end: on from there as the slope says, for a while. */
static void hold_flanks(const gmi_surface_points *points, const gmi_surface_gear gear[2],
                        const gmi_surface_cells cells[2], gmi_elastic_work *work) {
    for (int p = 0; p < 2 * work->slots; ++p) {
        if (work->beyond[p] != 0.0) {
            const gmi_elastic_hold hold = gmi_elastic_hold_at(&work->at, work->beyond[p]);
            for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
                if (gear[role].tables != NULL) {
                    work->deviation_by_z[p] +=
                        hold.moved * gmi_surface_twist_at(points, &gear[role], &cells[role], p);
                }
            }
            work->deviation[p] += hold.moved * work->deviation_by_roll[p];
            work->deviation_by_roll[p] *= hold.by_roll;
        }
    }
}

void gmi_elastic_set_material(const gm_mesh *mesh, int side, const gmi_lines *lines,
                              const gmi_teeth *teeth, gmi_elastic_work *work) {
    GMI_CALL_WIDE(&mesh->elastic->law, gmi_wide_set_material(mesh, side, lines, teeth, work))
    const gmi_engagement *at = &mesh->engagement;
    const gmi_surface_points points = {.count = 2 * work->slots,
                                       .t1_from = at->face_from,
                                       .per_place = 1.0 / mesh->pair->face_width,
                                       .place = work->z,
                                       .roll = work->roll,
                                       .value = work->deviation,
                                       .by_place = work->deviation_by_z,
                                       .by_roll = work->deviation_by_roll};
    const size_t bytes = sizeof(double) * (size_t)points.count;
    memset(work->deviation, 0, bytes);
    memset(work->deviation_by_roll, 0, bytes);
    memset(work->deviation_by_z, 0, bytes);
    if (is_drawn(mesh, side)) {
        return;
    }

    /* Where all points are in the tables of both gears. */
    const gmi_surface_gear gear[2] = {
        gmi_surface_gear_of(mesh, side, GM_PINION, at->line_of_action),
        gmi_surface_gear_of(mesh, side, GM_WHEEL, at->line_of_action)};
    gmi_surface_cells cells[2];
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        cells[role] = cells_in(work, role);
        if (gear[role].tables != NULL) {
            gmi_surface_find(&points, &gear[role], &cells[role]);
        }
    }

    /* Line by line, each with the teeth that meet on it; both points of each part. */
    for (int row = 0; row < work->count; ++row) {
        const gmi_elastic_line *line = &work->line[row];
        const gmi_line_flanks flanks = gmi_line_flanks_of(mesh, side, lines, teeth, line->index);
        const double pitch = flanks.pinion.pitch + flanks.wheel.pitch;
        for (int half = 0; half < 2; ++half) {
            const int from = line->slot + half * work->slots, to = from + line->slots;
            for (int p = from; p < to && pitch != 0.0; ++p) {
                work->deviation[p] = pitch;
            }
            if (gear[GM_PINION].tables != NULL) {
                gmi_surface_gather(&cells[GM_PINION], &gear[GM_PINION], flanks.pinion.values, from,
                                   to);
            }
            if (gear[GM_WHEEL].tables != NULL) {
                gmi_surface_gather(&cells[GM_WHEEL], &gear[GM_WHEEL], flanks.wheel.values, from,
                                   to);
            }
        }
    }

    /* What all of them have there. */
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        if (gear[role].tables != NULL) {
            gmi_surface_add_cells(&points, &gear[role], &cells[role]);
            gmi_surface_add_ramps(&points, &gear[role]);
        }
    }
    if (work->at.goes_on) {
        hold_flanks(&points, gear, cells, work);
    }

    /* And what the tilt of the axes makes of it, which goes on with the lines. */
    for (int row = 0; row < work->count && at->is_tilted; ++row) {
        const gmi_elastic_line *line = &work->line[row];
        const gmi_line_flanks flanks = gmi_line_flanks_of(mesh, side, lines, teeth, line->index);
        for (int half = 0; half < 2; ++half) {
            const int from = line->slot + half * work->slots;
            gmi_surface_add_tilt(&points, &flanks, from, from + line->slots);
        }
    }
}
