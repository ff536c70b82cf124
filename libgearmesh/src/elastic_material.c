/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Material of the flanks at the points of elastic teeth: tables, linear reliefs, pitch, and what tilted axes make of it.
 */
#include "contact.h"
#include "elastic.h"
#include "elastic_mesh.h"
#include "internal.h"
#include "mesh.h"
#include "meshing.h"
#include "penetration.h"
#include "surface.h"
#include "wide.h"

#include <string.h>

/* Whether there is anything at all beside the drawing. */
static int is_drawn(const gm_mesh *mesh, int side) {
    const gmi_side *prepared = &mesh->side[side];
    return prepared->pinion == NULL && prepared->wheel == NULL && !prepared->is_tilted;
}

/* Where each point finds the table of its tooth. */
APART void set_points(int count, double pitch, double pinion, double wheel,
                      double *restrict deviation, double *restrict pinion_table,
                      double *restrict wheel_table) {
    for (int k = 0; k < count; ++k) {
        deviation[k] = pitch;
        pinion_table[k] = pinion;
        wheel_table[k] = wheel;
    }
}

/* Adds the tables of a gear; a tooth without one has what the drawing says. */
static void add_tables(const gmi_surface_points *points, const gmi_surface_gear *gear,
                       const gmi_surface_tables *in, int has_all, gmi_elastic_work *work) {
    if (has_all) {
        gmi_surface_add_tables(points, gear, in, 0, points->count);
        return;
    }
    memset(in->mixed, 0, sizeof(double) * (size_t)points->count);
    for (int k = 0; k < 2 * work->count; ++k) {
        const gmi_elastic_line *line = &work->line[k / 2];
        const int from = line->slot + k % 2 * work->slots;
        if (in->table[from] >= 0.0) {
            gmi_surface_add_tables(points, gear, in, from, from + line->slots);
        }
    }
}

/* Beyond the path the flanks end: on from there as the slope says, for a while. */
static void hold_flanks(const gmi_surface_points *points, const gmi_surface_gear gear[2],
                        const gmi_surface_tables in[2], gmi_elastic_work *work) {
    for (int which = 0; which < 2; ++which) {
        for (int k = 0; k < work->outer_count[which]; ++k) {
            const int p = work->outer[which][k];
            const gmi_elastic_hold hold = gmi_elastic_hold_at(&work->at, work->beyond[p]);
            for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
                if (gear[role].tables != NULL) {
                    work->deviation_by_z[p] +=
                        hold.moved * gmi_surface_twist(points, &gear[role], in[role].mixed[p]);
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
    memset(work->deviation_by_roll, 0, bytes);
    memset(work->deviation_by_z, 0, bytes);
    if (is_drawn(mesh, side)) {
        memset(work->deviation, 0, bytes);
        return;
    }

    /* Line by line the teeth that meet on it, for both points of each part. */
    const gmi_surface_gear gear[2] = {
        gmi_surface_gear_of(mesh, side, GM_PINION, at->line_of_action),
        gmi_surface_gear_of(mesh, side, GM_WHEEL, at->line_of_action)};
    double *first = work->table[0], *second = work->table[1];
    const gmi_surface_tables in[2] = {{first, work->table[2]}, {second, work->table[3]}};
    int has_all[2] = {1, 1};
    for (int row = 0; row < work->count; ++row) {
        const gmi_elastic_line *line = &work->line[row];
        const gmi_line_flanks flanks = gmi_line_flanks_of(mesh, side, lines, teeth, line->index);
        const double pitch = flanks.pinion.pitch + flanks.wheel.pitch;
        const double pinion = gmi_surface_table(&gear[GM_PINION], &flanks.pinion);
        const double wheel = gmi_surface_table(&gear[GM_WHEEL], &flanks.wheel);
        has_all[GM_PINION] = has_all[GM_PINION] && pinion >= 0.0;
        has_all[GM_WHEEL] = has_all[GM_WHEEL] && wheel >= 0.0;
        for (int half = 0; half < 2; ++half) {
            const int p = line->slot + half * work->slots;
            set_points(line->slots, pitch, pinion, wheel, work->deviation + p, first + p,
                       second + p);
        }
    }

    /* What all of them have there. */
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        if (gear[role].tables != NULL) {
            add_tables(&points, &gear[role], &in[role], has_all[role], work);
            if (gear[role].is_held) {
                gmi_surface_hold_tables(&points, &gear[role], &in[role], 0, points.count);
            }
            gmi_surface_add_ramps(&points, &gear[role]);
        }
    }
    if (work->at.goes_on) {
        hold_flanks(&points, gear, in, work);
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
