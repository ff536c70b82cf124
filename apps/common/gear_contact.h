/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What analyses ask of two gears in mesh, whether they are one mesh or, with double-helical teeth, two halves whose pinion
 * floats between them. For one thread.
 */
#ifndef APPS_GEAR_CONTACT_H
#define APPS_GEAR_CONTACT_H

#include "gear_mesh.h"

/* As gm_mesh_evaluate_at(), gm_rolling_equilibrium() and gm_mesh_line_loads(), the latter where one of the others has just
 * found the float. Return a library status. */
int gear_contact_evaluate(const gear_mesh *mesh, const gm_position *position, int wanted,
                          gm_mesh_result *result);
/* As gm_mesh_pairs_at(), both sides together; of a pair of one half. */
int gear_contact_pairs(const gear_mesh *mesh, const gm_position *position, int *pairs);
int gear_contact_equilibrium(const gear_mesh *mesh, double pinion_angle, double pinion_speed,
                             double wheel_torque, double guess, double *offset,
                             gm_mesh_result *result);
int gear_contact_line_loads(const gear_mesh *mesh, const gm_position *position,
                            gm_line_load_point *points, int capacity, gm_line_loads *load);

/* As gm_rolling_equilibria() with forces and contact; not of a double-helical pair. */
int gear_contact_equilibria(const gear_mesh *mesh, double pinion_angle, double pinion_speed,
                            const double *wheel_torque, int count, double *offset,
                            gm_mesh_result *result);

/* Warns of a load that no material bears; the largest of a run is to be told once. */
void gear_contact_warn(const config *conf, const gm_line_loads *load);
int gear_contact_line_load_points(const gear_mesh *mesh);

/* Of both halves together: stiffness and damping over all pairs that touch on average, and of what touches in a result. */
double gear_contact_mean_stiffness(const gear_mesh *mesh); /* N/m, NaN without a law */
double gear_contact_mean_damping(const gear_mesh *mesh);   /* N s/m */
double gear_contact_touching_stiffness(const gear_mesh *mesh, const gm_mesh_result *result);

/* How far the pinion of a double-helical pair had floated along +z when it was last asked for (m). */
double gear_contact_apex(const gear_mesh *mesh);

/* Penetration of flanks that are springs and dampers with nothing else (not elastic teeth), from their force and the rate of
 * the penetration: the force law, the other way round (m). */
double gear_contact_penetration(const gear_mesh *mesh, double force, double rate);

/* Most material that the flanks of both gears add, and how steeply they rise along the roll length: what has to be bridged
 * before flanks of a side touch. Halves meet when both do, with the mean of both. */
double gear_contact_peak(const gear_mesh *mesh, int side);  /* m */
double gear_contact_slope(const gear_mesh *mesh, int side); /* 1 */
int gear_contact_is_ideal(const gear_mesh *mesh);

#endif
