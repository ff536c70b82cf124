/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* From the forces of a side to forces and moments on both gears. */
#ifndef GEARMESH_WRENCH_H
#define GEARMESH_WRENCH_H

#include "friction.h"
#include "internal.h"
#include "law.h"
#include "meshing.h"
#include "side_tangent.h"

/* Adds the forces of one side. */
void gmi_wrench_add_side(const gm_pair *pair, const gmi_engagement *at, const gmi_side_force *force,
                         int side, gm_wrench *wrench);

/* Adds the friction of one side. */
void gmi_wrench_add_friction(const gm_pair *pair, const gmi_engagement *at,
                             const gmi_friction_sum *friction, int side_of_teeth,
                             gm_wrench *wrench);

/* The wrench of a force of one side in the frame of the drawing, by its weights. */
typedef struct gmi_wrench_map {
    double force[3];            /* on the wheel by the force (1) */
    double by_t1[2], by_rho[3]; /* moments by the two others, about both axes (m, 1) */
    double pinion[3], wheel[3]; /* moments by the force, about either axis (m) */
} gmi_wrench_map;

/* Of the normal force, and of friction; by: how it changes as the wheel's axis moves along x and y. */
void gmi_wrench_map_force(const gm_pair *pair, const gmi_engagement *at, int side,
                          gmi_wrench_map *map, gmi_wrench_map by[2]);
void gmi_wrench_map_friction(const gm_pair *pair, const gmi_engagement *at, int side,
                             gmi_wrench_map *map, gmi_wrench_map by[2]);
static inline void gmi_wrench_map_add(const gmi_wrench_map *map, const double force[GMI_WEIGHTS],
                                      gm_wrench *wrench) {
    const double whole = force[GMI_WHOLE], by_t1 = force[GMI_BY_T1], by_rho = force[GMI_BY_RHO];
    const double moved[3] = {map->by_t1[0] * by_t1 + map->by_rho[0] * by_rho,
                             map->by_t1[1] * by_t1 + map->by_rho[1] * by_rho,
                             map->by_rho[2] * by_rho};
    for (int k = 0; k < 3; ++k) {
        const double on_wheel = map->force[k] * whole;
        wrench->wheel_force[k] += on_wheel;
        wrench->wheel_moment[k] += map->wheel[k] * whole + moved[k];
        wrench->pinion_force[k] -= on_wheel;
        wrench->pinion_moment[k] -= map->pinion[k] * whole + moved[k];
    }
}

/* From the frame in which the posed wheel's axis is on +x to that of the drawing: where that axis is there. */
void gmi_wrench_turn(gm_wrench *wrench, const double axis[2]);

static inline void gmi_wrench_set(gm_wrench *wrench, double value) {
    for (int k = 0; k < 3; ++k) {
        wrench->pinion_force[k] = wrench->pinion_moment[k] = value;
        wrench->wheel_force[k] = wrench->wheel_moment[k] = value;
    }
}

#endif
