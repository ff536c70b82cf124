/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Deviations at points of the lines of contact of a side: of both flanks that meet there, with what tilted axes make of
 * it. Where an integral along the line is wanted, line.c has it.
 */
#ifndef GEARMESH_SURFACE_H
#define GEARMESH_SURFACE_H

#include "contact.h"
#include "flank.h"
#include "internal.h"
#include "line.h"
#include "mesh.h"
#include "penetration.h"
#include "tilt.h"

/*
 * Points on lines of one side, t1 = t1_from + per_place place on the common face, and what is found at them: material
 * added, its slope along the place at fixed rho_p, and along rho_p at a fixed place.
 */
typedef struct gmi_surface_points {
    int count;
    double t1_from, per_place;
    const double *place;
    const double *roll; /* rho_p (m) */
    double *value;      /* (m) */
    double *by_place;
    double *by_roll; /* (1) */
} gmi_surface_points;

/*
 * For the points of a gear: where the table of the tooth begins among its tables, as a number, < 0 = none; and, found there,
 * how the slope along the profile grows across a cell of the face.
 */
typedef struct gmi_surface_tables {
    const double *table;
    double *mixed;
} gmi_surface_tables;

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

/* Tables and ramps of one gear as the points see them. The gear's own roll length is from + per_roll rho_p. */
typedef struct gmi_surface_gear {
    const gmi_tables *tables;
    const gmi_grid *grid;
    double roll_from, per_roll;
    int is_held; /* points may be beyond the ends of the table, see ramp.c: the flank has the deviation of the end */
} gmi_surface_gear;

/* reach: rho_p + rho_w of the points (m). tables NULL: an ideal flank. */
static inline gmi_surface_gear gmi_surface_gear_of(const gm_mesh *mesh, int side, int role,
                                                   double reach) {
    const gmi_side *prepared = &mesh->side[side];
    const int is_held = prepared->starts_deeper || (prepared->is_tilted && mesh->elastic == NULL);
    const gmi_surface_gear pinion = {prepared->pinion, &prepared->pinion_grid,
                                     -mesh->pair->pinion.start_roll_length, 1.0, is_held};
    const gmi_surface_gear wheel = {prepared->wheel, &prepared->wheel_grid,
                                    reach - mesh->engagement.wheel_profile_start, -1.0, is_held};
    return role == GM_PINION ? pinion : wheel;
}

/* Height of a ramp of a gear where it is above 0: straight in the place along the face and in rho_p. */
typedef struct gmi_surface_plane {
    double from, per_place, per_roll;
} gmi_surface_plane;

static inline gmi_surface_plane gmi_surface_plane_of(const gmi_surface_gear *gear,
                                                     const gm_flank_ramp *ramp, double t1_from,
                                                     double per_place) {
    const gmi_grid *grid = gear->grid;
    const double per_t1 = ramp->per_t1 * grid->face_scale;
    const double per_own_roll = ramp->per_t2 / grid->profile_cells * grid->per_rho;
    const gmi_surface_plane plane = {ramp->offset + ramp->per_t1 * grid->face_origin +
                                         per_t1 * t1_from + per_own_roll * gear->roll_from,
                                     per_t1 * per_place, per_own_roll * gear->per_roll};
    return plane;
}

/* Where the table of a tooth begins, see gmi_surface_tables. */
static inline double gmi_surface_table(const gmi_surface_gear *gear, const gmi_flank *flank) {
    return flank->values == NULL ? -1.0 : (double)(flank->values - gear->tables->values);
}

/* Adds the tables of a gear at points from .. to - 1, all of which have one. */
void gmi_surface_add_tables(const gmi_surface_points *at, const gmi_surface_gear *gear,
                            const gmi_surface_tables *in, int from, int to);

/* Takes off what that has read beyond the ends of the tables. */
void gmi_surface_hold_tables(const gmi_surface_points *at, const gmi_surface_gear *gear,
                             const gmi_surface_tables *in, int from, int to);

/* How the slope along rho_p of a table changes along the place, in the cell of a point (1 per place). */
static inline double gmi_surface_twist(const gmi_surface_points *at, const gmi_surface_gear *gear,
                                       double mixed) {
    return mixed * (gear->grid->face_rate * at->per_place) * (gear->per_roll * gear->grid->per_rho);
}

/* Takes off the ramps of a gear. */
void gmi_surface_add_ramps(const gmi_surface_points *at, const gmi_surface_gear *gear);

/* Adds what tilted axes make of points from .. to - 1, on one line. */
void gmi_surface_add_tilt(const gmi_surface_points *at, const gmi_line_flanks *line, int from,
                          int to);

/*
 * Material of both flanks, pitch included, at one point: t1 of the common face, rho_p, and reach = rho_p + rho_w (m); and
 * its slope along rho_p, without what tilted axes add.
 */
double gmi_line_flanks_at(const gmi_line_flanks *line, int side, double t1, double roll,
                          double reach, double *by_roll);

#endif
