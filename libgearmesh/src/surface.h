/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Deviations at single points: of one flank, and of both flanks that meet on a line of contact, with what tilted axes make
 * of it. Where an integral along the line is wanted, line.c has it.
 */
#ifndef GEARMESH_SURFACE_H
#define GEARMESH_SURFACE_H

#include "internal.h"

typedef struct gmi_surface {
    double value;   /* material added (m) */
    double by_t1;   /* its slope along t1 of the common face (m) */
    double by_roll; /* along the gear's own roll length (1) */
} gmi_surface;

/* Cell that holds v, clamped into the table. */
static inline int gmi_surface_cell(double v, int last) {
    const int cell = v > 0.0 ? (int)v : 0;
    return cell < last ? cell : last;
}

/*
 * Table (NULL = none) and ramps of one flank, bilinear as along a line; pitch apart. t1 of the common face; roll: own roll
 * length beyond the start of the flank (m).
 */
static inline gmi_surface gmi_surface_at(const gmi_tables *tables, const gmi_grid *grid,
                                         const double *values, double t1, double roll) {
    gmi_surface result = {0.0, 0.0, 0.0};
    const double v1 = grid->face_base + grid->face_rate * t1;
    const double v2 = roll * grid->per_rho;

    /* Within the cell: corner + along_face p + (along_profile + mixed p) q. */
    if (values != NULL) {
        const int face = gmi_surface_cell(v1, grid->last_face);
        const int profile = gmi_surface_cell(v2, grid->last_profile);
        const double p = v1 - (double)face;
        const double q = v2 - (double)profile;
        const double *near = values + face * grid->row + (ptrdiff_t)profile * GMI_NODE_DOUBLES;
        const double *far = near + grid->row;
        const double along_profile = near[GMI_NODE_DOUBLES] - near[0];
        const double along_face = far[0] - near[0];
        const double mixed = far[GMI_NODE_DOUBLES] - far[0] - along_profile;
        result.value = near[0] + along_face * p + (along_profile + mixed * p) * q;
        result.by_t1 = (along_face + mixed * q) * grid->face_rate;
        result.by_roll = (along_profile + mixed * p) * grid->per_rho;
    }

    /* Each ramp takes off what it exceeds zero by. */
    for (int k = 0; k < tables->ramp_count; ++k) {
        const gm_flank_ramp *ramp = &tables->ramps[k];
        const double per_profile = ramp->per_t2 / grid->profile_cells;
        const double height = ramp->offset +
                              ramp->per_t1 * (grid->face_origin + grid->face_scale * t1) +
                              per_profile * v2;
        if (height > 0.0) {
            result.value -= height;
            result.by_t1 -= ramp->per_t1 * grid->face_scale;
            result.by_roll -= per_profile * grid->per_rho;
        }
    }
    return result;
}

/* The flanks that meet on one line of a side. */
typedef struct gmi_line_flanks {
    const gm_mesh *mesh;
    const gmi_side *prepared;
    int pinion_tooth, wheel_tooth;
    double advance; /* of the line, over the common face (m) */
    gmi_flank pinion, wheel;
    gmi_tilted_line tilted; /* of tilted axes */
} gmi_line_flanks;

/* Tooth `steps` further on. */
static inline int gmi_surface_tooth(int tooth, int steps, int teeth) {
    const int moved = (tooth + steps) % teeth;
    return moved < 0 ? moved + teeth : moved;
}

/* Of line `index`; teeth: those of line lines->first. */
static inline gmi_line_flanks gmi_line_flanks_of(const gm_mesh *mesh, int side,
                                                 const gmi_lines *lines, const gmi_teeth *teeth,
                                                 int index) {
    const gm_pair *pair = mesh->pair;
    const gmi_side *prepared = &mesh->side[side];
    const int steps = teeth->step * (index - lines->first);
    gmi_line_flanks line = {
        .mesh = mesh,
        .prepared = prepared,
        .pinion_tooth = gmi_surface_tooth(teeth->pinion, steps, pair->pinion.teeth),
        .wheel_tooth = gmi_surface_tooth(teeth->wheel, steps, pair->wheel.teeth),
        .advance = lines->advance,
    };
    line.pinion = gmi_flank_of(prepared->pinion, line.pinion_tooth);
    line.wheel = gmi_flank_of(prepared->wheel, line.wheel_tooth);
    if (mesh->engagement.is_tilted) {
        const double origin = lines->origin + (double)index * pair->transverse_base_pitch;
        gmi_tilt_line(pair, &mesh->engagement, side, origin, &line.tilted);
    }
    return line;
}

/*
 * Material of both flanks, pitch included, at a point: t1 of the common face, rho_p, and reach = rho_p + rho_w. The slopes
 * are by t1 at fixed rho_p, and by rho_p at fixed t1.
 */
static inline gmi_surface gmi_line_flanks_at(const gmi_line_flanks *line, double t1, double roll,
                                             double reach) {
    const gmi_engagement *at = &line->mesh->engagement;
    const gmi_side *prepared = line->prepared;
    gmi_surface sum = {line->pinion.pitch + line->wheel.pitch, 0.0, 0.0};

    /* Each flank at its own roll length; the wheel's falls as the pinion's grows. */
    if (prepared->pinion != NULL) {
        const gmi_surface flank =
            gmi_surface_at(prepared->pinion, &prepared->pinion_grid, line->pinion.values, t1,
                           roll - line->mesh->pair->pinion.start_roll_length);
        sum.value += flank.value;
        sum.by_t1 += flank.by_t1;
        sum.by_roll += flank.by_roll;
    }
    if (prepared->wheel != NULL) {
        const gmi_surface flank =
            gmi_surface_at(prepared->wheel, &prepared->wheel_grid, line->wheel.values, t1,
                           reach - roll - at->wheel_profile_start);
        sum.value += flank.value;
        sum.by_t1 += flank.by_t1;
        sum.by_roll -= flank.by_roll;
    }

    /* Tilted axes: a parabola along the line, on which rho_p grows with t1. */
    if (at->is_tilted) {
        const double *shift = line->tilted.shift;
        const double by_roll = line->tilted.by_origin[0] + line->tilted.by_origin[1] * t1;
        sum.value += shift[0] + (shift[1] + shift[2] * t1) * t1;
        sum.by_roll += by_roll;
        sum.by_t1 += shift[1] + 2.0 * shift[2] * t1 - line->advance * by_roll;
    }
    return sum;
}

#endif
