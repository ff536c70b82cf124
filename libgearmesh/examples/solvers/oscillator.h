/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The motion that every solver of this folder integrates: a gear pair without damping, whose pinion turns at constant
 * speed while a torque loads the wheel. States: x = r_bp phi_p - r_bw phi_w and dx/dt. With I_w phi_w'' = T - M_w, where T
 * is the torque of the mesh on the wheel, x'' = (M_w - T) r_bw / I_w. Nothing is lost, so that an error of a step stays.
 */
#ifndef OSCILLATOR_H
#define OSCILLATOR_H

#include <gearmesh/gearmesh.h>
#include <math.h>
#include <stdio.h>

static const double inertia = 2.1e-3, load = 20; /* of the wheel (kg m2, N m) */
static const double speed = 139.62634;           /* of the pinion: 2 pi 1000 / 45 (rad/s) */
static const double end_time = 5e-3;             /* five mesh cycles, some eight oscillations (s) */
static const double start[2] = {52e-6, 0.0}; /* in contact, a micrometre or two from equilibrium */

/* The paper's gears with ideal flanks, prepared in memory of the program; NULL, and a message, if that fails. */
static inline const gm_mesh *oscillator_mesh(void) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 45;
    params.wheel_teeth = 41;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 0.279252680;
    params.helix_angle = 0.575958653;
    params.center_distance = 0.085;
    params.face_width = 0.0175;
    params.backlash = 100e-6;
    gm_pair pair;
    int status = gm_pair_init(&pair, &params);

    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = 1.05e8;
    static double memory[512];
    gm_mesh *mesh = NULL;
    if (status == GM_OK) {
        status = gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, sizeof memory);
    }
    if (status != GM_OK) {
        fprintf(stderr, "%s\n", gm_status_text(status));
    }
    return mesh;
}

/* The mesh at a time and state. Status of the library: 0 done, > 0 try a smaller step, < 0 give up. */
static inline int oscillator_evaluate(const gm_mesh *mesh, double time, const double state[2],
                                      int wanted, gm_mesh_result *result) {
    gm_position position;
    const int status = gm_position_from_pinion_angle(gm_mesh_pair(mesh), speed * time, state[0],
                                                     state[1], &position);
    return status == GM_OK ? gm_mesh_evaluate_at(mesh, &position, wanted, NULL, result) : status;
}

/* Derivatives of the state by time. */
static inline int oscillator_motion(const gm_mesh *mesh, double time, const double state[2],
                                    double derivative[2]) {
    gm_mesh_result result;
    const int status = oscillator_evaluate(mesh, time, state, GM_WANT_FORCE, &result);
    if (status != GM_OK) {
        derivative[0] = NAN;
        derivative[1] = NAN;
        return status;
    }
    derivative[0] = state[1];
    derivative[1] = (load - result.wheel_torque) * gm_mesh_pair(mesh)->wheel.base_radius / inertia;
    return GM_OK;
}

/* Their exact derivatives by the state, row by row: at a given pinion angle dx = -r_bw dphi_w. */
static inline int oscillator_jacobian(const gm_mesh *mesh, double time, const double state[2],
                                      double rows[4]) {
    gm_mesh_result result;
    const int status = oscillator_evaluate(mesh, time, state, GM_WANT_DERIVATIVES, &result);
    if (status != GM_OK) {
        rows[0] = rows[1] = rows[2] = rows[3] = NAN;
        return status;
    }
    rows[0] = 0.0;
    rows[1] = 1.0;
    rows[2] = result.wheel_torque_by.wheel_angle / inertia;
    rows[3] = result.wheel_torque_by.wheel_speed / inertia;
    return GM_OK;
}

static inline void oscillator_print(const double state[2]) {
    printf("x %.9f um, dx/dt %.6f mm/s\n", 1e6 * state[0], 1e3 * state[1]);
}

#endif
