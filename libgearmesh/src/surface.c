/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Deviations at points of lines of contact, all points of a side one after the other, or four at once.
 */
#include "surface.h"

#include "flank.h"
#include "internal.h"
#include "line.h"
#include "mesh.h"
#include "wide.h"

#include <stdint.h>

/*
 * What the points need to know of the tables of a gear: v1 = face_from + per_place place across the face, v2 = profile_from +
 * per_roll rho_p along the profile; last cells, and numbers in a row of nodes along the profile.
 */
typedef struct surface_map {
    double face_from, per_place, profile_from, per_roll;
    double last_face, last_profile, row;
    const double *values;
    ptrdiff_t next_face;
} surface_map;

static surface_map map_of(const gmi_surface_points *at, const gmi_surface_gear *gear) {
    const gmi_grid *grid = gear->grid;
    const surface_map map = {grid->face_base + grid->face_rate * at->t1_from,
                             grid->face_rate * at->per_place,
                             gear->roll_from * grid->per_rho,
                             gear->per_roll * grid->per_rho,
                             (double)grid->last_face,
                             (double)grid->last_profile,
                             (double)grid->row,
                             gear->tables->values,
                             grid->row};
    return map;
}

/* Points that go through each step together, so that a compiler does two at once; only nodes are fetched one by one. */
enum { BLOCK = 16 };

/* Where they are: first node of the cell, and place within it. */
APART void find_nodes(int count, const surface_map *map, const double *restrict place,
                      const double *restrict roll, const double *restrict table,
                      double *restrict node, double *restrict face, double *restrict profile) {
    const double face_from = map->face_from, per_place = map->per_place;
    const double profile_from = map->profile_from, per_roll = map->per_roll;
    const double last_face = map->last_face, last_profile = map->last_profile, row = map->row;
    for (int k = 0; k < count; ++k) {
        const double v1 = face_from + per_place * place[k];
        const double v2 = profile_from + per_roll * roll[k];
        const double face_cell = gmi_cell_of(v1, last_face);
        const double profile_cell = gmi_cell_of(v2, last_profile);
        face[k] = v1 - face_cell;
        profile[k] = v2 - profile_cell;
        node[k] = table[k] + (face_cell * row + profile_cell * (double)GMI_NODE_DOUBLES);
    }
}

/* The four nodes around each. */
APART void gather(int count, const surface_map *map, const double *restrict node,
                  double *restrict near, double *restrict near_next, double *restrict far,
                  double *restrict far_next) {
    const ptrdiff_t row = map->next_face;
    for (int k = 0; k < count; ++k) {
        const double *at = map->values + (ptrdiff_t)node[k];
        near[k] = at[0];
        near_next[k] = at[GMI_NODE_DOUBLES];
        far[k] = at[row];
        far_next[k] = at[row + GMI_NODE_DOUBLES];
    }
}

/* Within a cell: corner + along_face p + (along_profile + mixed p) q. */
APART void add_cells(int count, const surface_map *map, const double *restrict face,
                     const double *restrict profile, const double *restrict near,
                     const double *restrict near_next, const double *restrict far,
                     const double *restrict far_next, double *restrict value,
                     double *restrict by_place, double *restrict by_roll, double *restrict mixed) {
    const double per_place = map->per_place, per_roll = map->per_roll;
    for (int k = 0; k < count; ++k) {
        const double along_profile = near_next[k] - near[k];
        const double along_face = far[k] - near[k];
        const double twist = far_next[k] - far[k] - along_profile;
        const double slope = along_profile + twist * face[k];
        value[k] += near[k] + along_face * face[k] + slope * profile[k];
        by_place[k] += (along_face + twist * profile[k]) * per_place;
        by_roll[k] += slope * per_roll;
        mixed[k] = twist;
    }
}

static void add_block(int count, const surface_map *map, const gmi_surface_points *at,
                      const gmi_surface_tables *in, int k) {
    double node[BLOCK], face[BLOCK], profile[BLOCK];
    double near[BLOCK], near_next[BLOCK], far[BLOCK], far_next[BLOCK];
    find_nodes(count, map, at->place + k, at->roll + k, in->table + k, node, face, profile);
    gather(count, map, node, near, near_next, far, far_next);
    add_cells(count, map, face, profile, near, near_next, far, far_next, at->value + k,
              at->by_place + k, at->by_roll + k, in->mixed + k);
}

#ifdef GMI_IN_WIDE
/* The same numbers of four nodes. */
static inline __m256d of_nodes(const double *const node[4], ptrdiff_t at) {
    return _mm256_set_pd(node[3][at], node[2][at], node[1][at], node[0][at]);
}

static inline void add_to_four(double *values, __m256d more) {
    _mm256_storeu_pd(values, _mm256_add_pd(_mm256_loadu_pd(values), more));
}

/* Four points from k on: the same operations. */
static inline void add_four(const surface_map *map, const gmi_surface_points *at,
                            const gmi_surface_tables *in, int k) {
    const __m256d per_place = _mm256_set1_pd(map->per_place);
    const __m256d per_roll = _mm256_set1_pd(map->per_roll);
    const __m256d v1 = _mm256_add_pd(_mm256_set1_pd(map->face_from),
                                     _mm256_mul_pd(per_place, _mm256_loadu_pd(at->place + k)));
    const __m256d v2 = _mm256_add_pd(_mm256_set1_pd(map->profile_from),
                                     _mm256_mul_pd(per_roll, _mm256_loadu_pd(at->roll + k)));
    GMI_CELLS_OF_FOUR(v1, map->last_face, face_cell);
    GMI_CELLS_OF_FOUR(v2, map->last_profile, profile_cell);
    const __m256d face = _mm256_sub_pd(v1, face_cell), profile = _mm256_sub_pd(v2, profile_cell);
    const __m256d first =
        _mm256_add_pd(_mm256_mul_pd(face_cell, _mm256_set1_pd(map->row)),
                      _mm256_mul_pd(profile_cell, _mm256_set1_pd((double)GMI_NODE_DOUBLES)));

    GMI_PLACES_OF_FOUR(_mm256_add_pd(_mm256_loadu_pd(in->table + k), first), 1.0, place);
    const double *const node[4] = {map->values + place[0], map->values + place[1],
                                   map->values + place[2], map->values + place[3]};

    /* The nodes around them. */
    const __m256d near = of_nodes(node, 0), near_next = of_nodes(node, GMI_NODE_DOUBLES);
    const __m256d far = of_nodes(node, map->next_face);
    const __m256d far_next = of_nodes(node, map->next_face + GMI_NODE_DOUBLES);
    const __m256d along_profile = _mm256_sub_pd(near_next, near);
    const __m256d along_face = _mm256_sub_pd(far, near);
    const __m256d mixed = _mm256_sub_pd(_mm256_sub_pd(far_next, far), along_profile);
    const __m256d slope = _mm256_add_pd(along_profile, _mm256_mul_pd(mixed, face));
    add_to_four(at->value + k, _mm256_add_pd(_mm256_add_pd(near, _mm256_mul_pd(along_face, face)),
                                             _mm256_mul_pd(slope, profile)));
    add_to_four(at->by_place + k,
                _mm256_mul_pd(_mm256_add_pd(along_face, _mm256_mul_pd(mixed, profile)), per_place));
    add_to_four(at->by_roll + k, _mm256_mul_pd(slope, per_roll));
    _mm256_storeu_pd(in->mixed + k, mixed);
}
#endif

void gmi_surface_add_tables(const gmi_surface_points *at, const gmi_surface_gear *gear,
                            const gmi_surface_tables *in, int from, int to) {
    const surface_map map = map_of(at, gear);
    int k = from;
#ifdef GMI_IN_WIDE
    for (; k + 4 <= to; k += 4) {
        add_four(&map, at, in, k);
    }
#endif
    for (; k < to; k += BLOCK) {
        add_block(to - k < BLOCK ? to - k : BLOCK, &map, at, in, k);
    }
}

/* By how much a place along the profile is beyond the ends of a table, < 0 towards the root (cells). */
static double beyond_of(double v2, double cells) {
    return v2 < 0.0 ? v2 : gmi_larger(v2 - cells, 0.0);
}

/* The cells at the ends have been read on as they are straight along the profile: their slope tells by how much too far. */
void gmi_surface_hold_tables(const gmi_surface_points *at, const gmi_surface_gear *gear,
                             const gmi_surface_tables *in, int from, int to) {
    const surface_map map = map_of(at, gear);
    for (int k = from; k < to; ++k) {
        const double v2 = map.profile_from + map.per_roll * at->roll[k];
        const double beyond = beyond_of(v2, gear->grid->profile_cells);
        if (beyond == 0.0 || in->table[k] < 0.0) {
            continue;
        }

        /* The cell that was read on. */
        const double v1 = map.face_from + map.per_place * at->place[k];
        const int face_cell = (int)gmi_cell_of(v1, map.last_face);
        const int profile_cell = (int)gmi_cell_of(v2, map.last_profile);
        const double *near = map.values + (ptrdiff_t)in->table[k] + face_cell * map.next_face +
                             profile_cell * GMI_NODE_DOUBLES;
        const double *far = near + map.next_face;

        /* Its slope along the profile there, times how far it is beyond, is taken back. */
        const double along_profile = near[GMI_NODE_DOUBLES] - near[0];
        const double twist = far[GMI_NODE_DOUBLES] - far[0] - along_profile;
        const double slope = along_profile + twist * (v1 - (double)face_cell);
        at->value[k] -= slope * beyond;
        at->by_place[k] -= twist * beyond * map.per_place;
        at->by_roll[k] -= slope * map.per_roll;
        in->mixed[k] = 0.0;
    }
}

/* Of a ramp whose height is read no further than the ends of the table. */
static void add_held_ramp(const gmi_surface_points *at, const gmi_surface_gear *gear, double from,
                          double per_place, double per_roll) {
    const gmi_grid *grid = gear->grid;
    for (int k = 0; k < at->count; ++k) {
        const double v2 = (gear->roll_from + gear->per_roll * at->roll[k]) * grid->per_rho;
        const double beyond =
            beyond_of(v2, grid->profile_cells) / (gear->per_roll * grid->per_rho); /* of rho_p */
        const double height = from + per_place * at->place[k] + per_roll * (at->roll[k] - beyond);
        if (height > 0.0) {
            at->value[k] -= height;
            at->by_place[k] -= per_place;
            at->by_roll[k] -= beyond == 0.0 ? per_roll : 0.0;
        }
    }
}

/* Each takes off what it exceeds zero by. */
void gmi_surface_add_ramps(const gmi_surface_points *at, const gmi_surface_gear *gear) {
    for (int r = 0; r < gear->tables->ramp_count; ++r) {
        const gmi_surface_plane plane =
            gmi_surface_plane_of(gear, &gear->tables->ramps[r], at->t1_from, at->per_place);
        const double from = plane.from, per_place = plane.per_place, per_roll = plane.per_roll;
        if (gear->is_held) {
            add_held_ramp(at, gear, from, per_place, per_roll);
            continue;
        }

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

    /* The table of each gear, if the tooth has one. */
    double table = 0.0, mixed;
    const gmi_surface_tables in = {&table, &mixed};
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const gmi_surface_gear gear = gmi_surface_gear_of(line->mesh, side, role, reach);
        if (gear.tables != NULL) {
            table = gmi_surface_table(&gear, role == GM_PINION ? &line->pinion : &line->wheel);
            if (table >= 0.0) {
                gmi_surface_add_tables(&at, &gear, &in, 0, 1);
            }
            if (gear.is_held) {
                gmi_surface_hold_tables(&at, &gear, &in, 0, 1);
            }
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
