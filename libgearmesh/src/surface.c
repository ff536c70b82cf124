/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Deviations at points of lines of contact. All points of a side go through each step together, so that a compiler does
 * two at once; only the nodes of a table are fetched one by one.
 */
#include "surface.h"

#include "internal.h"

/* v1 = face_from + per_place place across the face of a table, v2 = profile_from + per_roll rho_p along its profile. */
typedef struct surface_map {
    double face_from, per_place, profile_from, per_roll;
} surface_map;

static surface_map map_of(const gmi_surface_points *at, const gmi_surface_gear *gear) {
    const gmi_grid *grid = gear->grid;
    const surface_map map = {grid->face_base + grid->face_rate * at->t1_from,
                             grid->face_rate * at->per_place, gear->roll_from * grid->per_rho,
                             gear->per_roll * grid->per_rho};
    return map;
}

APART void find_nodes(int count, const surface_map *map, const gmi_grid *grid,
                      const double *restrict place, const double *restrict roll,
                      double *restrict node, double *restrict face, double *restrict profile) {
    const double face_from = map->face_from, per_place = map->per_place;
    const double profile_from = map->profile_from, per_roll = map->per_roll;
    const double last_face = (double)grid->last_face, last_profile = (double)grid->last_profile;
    const double row = (double)grid->row;
    for (int k = 0; k < count; ++k) {
        const double v1 = face_from + per_place * place[k];
        const double v2 = profile_from + per_roll * roll[k];
        const double face_cell = gmi_cell_of(v1, last_face);
        const double profile_cell = gmi_cell_of(v2, last_profile);
        face[k] = v1 - face_cell;
        profile[k] = v2 - profile_cell;
        node[k] = face_cell * row + profile_cell * (double)GMI_NODE_DOUBLES;
    }
}

void gmi_surface_find(const gmi_surface_points *at, const gmi_surface_gear *gear,
                      const gmi_surface_cells *cells) {
    const surface_map map = map_of(at, gear);
    find_nodes(at->count, &map, gear->grid, at->place, at->roll, cells->node, cells->face,
               cells->profile);
}

APART void gather(int count, const double *table, ptrdiff_t row, const double *restrict node,
                  double *restrict near, double *restrict near_next, double *restrict far,
                  double *restrict far_next) {
    for (int k = 0; k < count; ++k) {
        const double *at = table + (ptrdiff_t)node[k];
        near[k] = at[0];
        near_next[k] = at[GMI_NODE_DOUBLES];
        far[k] = at[row];
        far_next[k] = at[row + GMI_NODE_DOUBLES];
    }
}

void gmi_surface_gather(const gmi_surface_cells *cells, const gmi_surface_gear *gear,
                        const double *table, int from, int to) {
    if (table != NULL) {
        gather(to - from, table, gear->grid->row, cells->node + from, cells->near + from,
               cells->near_next + from, cells->far + from, cells->far_next + from);
        return;
    }
    for (int k = from; k < to; ++k) {
        cells->near[k] = cells->near_next[k] = cells->far[k] = cells->far_next[k] = 0.0;
    }
}

/* Within a cell: corner + along_face p + (along_profile + mixed p) q. */
APART void add_cells(int count, double per_place, double per_roll, const double *restrict face,
                     const double *restrict profile, const double *restrict near,
                     const double *restrict near_next, const double *restrict far,
                     const double *restrict far_next, double *restrict value,
                     double *restrict by_place, double *restrict by_roll) {
    for (int k = 0; k < count; ++k) {
        const double along_profile = near_next[k] - near[k];
        const double along_face = far[k] - near[k];
        const double mixed = far_next[k] - far[k] - along_profile;
        const double slope = along_profile + mixed * face[k];
        value[k] += near[k] + along_face * face[k] + slope * profile[k];
        by_place[k] += (along_face + mixed * profile[k]) * per_place;
        by_roll[k] += slope * per_roll;
    }
}

void gmi_surface_add_cells(const gmi_surface_points *at, const gmi_surface_gear *gear,
                           const gmi_surface_cells *cells) {
    const surface_map map = map_of(at, gear);
    add_cells(at->count, map.per_place, map.per_roll, cells->face, cells->profile, cells->near,
              cells->near_next, cells->far, cells->far_next, at->value, at->by_place, at->by_roll);
}

/* Each takes off what it exceeds zero by. */
void gmi_surface_add_ramps(const gmi_surface_points *at, const gmi_surface_gear *gear) {
    const gmi_grid *grid = gear->grid;
    for (int r = 0; r < gear->tables->ramp_count; ++r) {
        const gm_flank_ramp *ramp = &gear->tables->ramps[r];

        /* Its height is straight in t1 and roll length, so that it is in the place between stations and in the roll. */
        const double per_t1 = ramp->per_t1 * grid->face_scale;
        const double per_own_roll = ramp->per_t2 / grid->profile_cells * grid->per_rho;
        const double from = ramp->offset + ramp->per_t1 * grid->face_origin + per_t1 * at->t1_from +
                            per_own_roll * gear->roll_from;
        const double per_place = per_t1 * at->per_place, per_roll = per_own_roll * gear->per_roll;

        for (int k = 0; k < at->count; ++k) {
            const double height = from + per_place * at->place[k] + per_roll * at->roll[k];
            if (height > 0.0) {
                at->value[k] -= height;
                at->by_place[k] -= per_place;
                at->by_roll[k] -= per_roll;
            }
        }
    }
}

/* A parabola along the line, on which rho_p grows with t1. */
void gmi_surface_add_tilt(const gmi_surface_points *at, const gmi_line_flanks *line, int from,
                          int to) {
    const double *shift = line->tilted.shift, *by_origin = line->tilted.by_origin;
    for (int k = from; k < to; ++k) {
        const double t1 = at->t1_from + at->per_place * at->place[k];
        const double by_roll = by_origin[0] + by_origin[1] * t1;
        at->value[k] += shift[0] + (shift[1] + shift[2] * t1) * t1;
        at->by_roll[k] += by_roll;
        at->by_place[k] +=
            at->per_place * (shift[1] + 2.0 * shift[2] * t1 - line->advance * by_roll);
    }
}

/* One point at a time is no work for vectors. */
#ifndef GMI_IN_WIDE
double gmi_line_flanks_at(const gmi_line_flanks *line, int side, double t1, double roll,
                          double reach, double *by_roll) {
    /* Pitch counts everywhere; t1 itself is the place. */
    double value = line->pinion.pitch + line->wheel.pitch, by_t1 = 0.0, by_origin = 0.0;
    const gmi_surface_points at = {1, 0.0, 1.0, &t1, &roll, &value, &by_t1, by_roll};
    *by_roll = 0.0;

    /* The table of each gear: its cell, its four nodes, and what they come to at the point. */
    double nodes[7];
    const gmi_surface_cells cells = {&nodes[0], &nodes[1], &nodes[2], &nodes[3],
                                     &nodes[4], &nodes[5], &nodes[6]};
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const gmi_surface_gear gear = gmi_surface_gear_of(line->mesh, side, role, reach);
        if (gear.tables != NULL) {
            gmi_surface_find(&at, &gear, &cells);
            gmi_surface_gather(&cells, &gear,
                               role == GM_PINION ? line->pinion.values : line->wheel.values, 0, 1);
            gmi_surface_add_cells(&at, &gear, &cells);
            gmi_surface_add_ramps(&at, &gear);
        }
    }

    /* A tilt shifts the whole line, whatever the roll length. */
    if (line->mesh->engagement.is_tilted) {
        const gmi_surface_points tilted = {1, 0.0, 1.0, &t1, &roll, &value, &by_t1, &by_origin};
        gmi_surface_add_tilt(&tilted, line, 0, 1);
    }
    return value;
}
#endif
