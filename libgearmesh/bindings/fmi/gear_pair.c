/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * GearPair: a gearbox of two bodies. States are the pinion's angle and speed, and x = r_bp phi_p - r_bw phi_w with dx/dt in
 * place of the wheel's, since micrometres matter. With the torques T of the mesh,
 *     I_p phi_p'' = M_p - T_p,   I_w phi_w'' = T_w - M_w,   x'' = r_bp phi_p'' - r_bw phi_w''.
 */
#include "model.h"

#include <math.h>

enum { ANGLE, SPEED, OFFSET, OFFSET_RATE, STATES };
enum { DRIVE_TORQUE, LOAD_TORQUE, INPUTS };
enum {
    WHEEL_ANGLE,
    WHEEL_SPEED,
    TRANSMISSION_ERROR,
    FORCE,
    APEX_SHIFT,
    LOSS,
    STORED_ENERGY,
    OUTPUTS
};

static const fmu_variable variables[] = {
    {"time", "s", "simulation time", KIND_REAL, ROLE_TIME, offsetof(fmu_values, time), 0.0, 0},
    {"drive_torque", "N.m", "on the pinion, > 0 accelerates it in the driven direction", KIND_REAL,
     ROLE_INPUT, offsetof(fmu_values, input[DRIVE_TORQUE]), 0.0, 0},
    {"load_torque", "N.m", "on the wheel, > 0 resists the driven direction", KIND_REAL, ROLE_INPUT,
     offsetof(fmu_values, input[LOAD_TORQUE]), 0.0, 0},
    {"pinion_angle", "rad", "phi_p", KIND_REAL, ROLE_STATE_OUTPUT,
     offsetof(fmu_values, state[ANGLE]), 0.1, 0},
    {"pinion_speed", "rad/s", "d phi_p / dt", KIND_REAL, ROLE_STATE_OUTPUT,
     offsetof(fmu_values, state[SPEED]), 1.0, 0},
    {"offset", "m", "x = r_bp phi_p - r_bw phi_w", KIND_REAL, ROLE_STATE,
     offsetof(fmu_values, state[OFFSET]), 1e-5, 0},
    {"offset_rate", "m/s", "dx/dt", KIND_REAL, ROLE_STATE, offsetof(fmu_values, state[OFFSET_RATE]),
     1e-2, 0},
    {"der(pinion_angle)", "rad/s", "", KIND_REAL, ROLE_DERIVATIVE,
     offsetof(fmu_values, derivative[ANGLE]), 0.0, ANGLE},
    {"der(pinion_speed)", "rad/s2", "", KIND_REAL, ROLE_DERIVATIVE,
     offsetof(fmu_values, derivative[SPEED]), 0.0, SPEED},
    {"der(offset)", "m/s", "", KIND_REAL, ROLE_DERIVATIVE, offsetof(fmu_values, derivative[OFFSET]),
     0.0, OFFSET},
    {"der(offset_rate)", "m/s2", "", KIND_REAL, ROLE_DERIVATIVE,
     offsetof(fmu_values, derivative[OFFSET_RATE]), 0.0, OFFSET_RATE},
    {"wheel_angle", "rad", "phi_w", KIND_REAL, ROLE_OUTPUT,
     offsetof(fmu_values, output[WHEEL_ANGLE]), 0.0, 0},
    {"wheel_speed", "rad/s", "d phi_w / dt", KIND_REAL, ROLE_OUTPUT,
     offsetof(fmu_values, output[WHEEL_SPEED]), 0.0, 0},
    {"transmission_error", "m", "-x, along the line of action", KIND_REAL, ROLE_OUTPUT,
     offsetof(fmu_values, output[TRANSMISSION_ERROR]), 0.0, 0},
    {"force", "N", "along the transverse line of action, > 0 drives the wheel forward", KIND_REAL,
     ROLE_OUTPUT, offsetof(fmu_values, output[FORCE]), 0.0, 0},
    {"apex_shift", "m", "how far a double-helical pinion has floated along +z", KIND_REAL,
     ROLE_OUTPUT, offsetof(fmu_values, output[APEX_SHIFT]), 0.0, 0},
    {"loss", "W", "power that friction takes, >= 0", KIND_REAL, ROLE_OUTPUT,
     offsetof(fmu_values, output[LOSS]), 0.0, 0},
    {"stored_energy", "J", "in what is pressed together", KIND_REAL, ROLE_OUTPUT,
     offsetof(fmu_values, output[STORED_ENERGY]), 0.0, 0},
#include "common_variables.inc"
    {"pinion_inertia", "kg.m2", "I_p, > 0", KIND_REAL, ROLE_PARAMETER,
     offsetof(fmu_values, pinion_inertia), 0.0, 0},
    {"wheel_inertia", "kg.m2", "I_w, > 0", KIND_REAL, ROLE_PARAMETER,
     offsetof(fmu_values, wheel_inertia), 0.0, 0},
    {"relative_tolerance", "", "of the integration in co-simulation, 1e-14 .. 0.1", KIND_REAL,
     ROLE_PARAMETER, offsetof(fmu_values, tolerance), 0.0, 0},
};

/* The partial derivatives, from those of the torques by both angles and speeds. */
static void differentiate(const fmu_values *values, const gm_pair *pair,
                          const gm_mesh_result *result, const gm_gradient *float_by,
                          fmu_jacobian *jacobian) {
    const double r_bp = pair->pinion.base_radius;
    const double r_bw = pair->wheel.base_radius;
    double(*by)[MAX_STATES + MAX_INPUTS] = jacobian->by;

    /* At a given x the wheel turns with the pinion, r_bp / r_bw; at a given pinion angle dphi_w = -dx / r_bw. */
    const gm_gradient *gradients[] = {&result->pinion_torque_by, &result->wheel_torque_by,
                                      &result->force_by, float_by};
    double quantity_by[4][STATES];
    for (int k = 0; k < 4; ++k) {
        const gm_gradient *given = gradients[k];
        quantity_by[k][ANGLE] = given->pinion_angle + given->wheel_angle * r_bp / r_bw;
        quantity_by[k][SPEED] = given->pinion_speed + given->wheel_speed * r_bp / r_bw;
        quantity_by[k][OFFSET] = -given->wheel_angle / r_bw;
        quantity_by[k][OFFSET_RATE] = -given->wheel_speed / r_bw;
    }

    /* The equations of motion, line by line. */
    by[ANGLE][SPEED] = 1.0;
    by[OFFSET][OFFSET_RATE] = 1.0;
    for (int k = 0; k < STATES; ++k) {
        const double pinion_by = -quantity_by[0][k] / values->pinion_inertia;
        const double wheel_by = quantity_by[1][k] / values->wheel_inertia;
        by[SPEED][k] = pinion_by;
        by[OFFSET_RATE][k] = r_bp * pinion_by - r_bw * wheel_by;
        by[STATES + FORCE][k] = quantity_by[2][k];
        by[STATES + APEX_SHIFT][k] = quantity_by[3][k];
    }
    by[SPEED][STATES + DRIVE_TORQUE] = 1.0 / values->pinion_inertia;
    by[OFFSET_RATE][STATES + DRIVE_TORQUE] = r_bp / values->pinion_inertia;
    by[OFFSET_RATE][STATES + LOAD_TORQUE] = r_bw / values->wheel_inertia;

    /* The wheel, and the error. */
    by[STATES + WHEEL_ANGLE][ANGLE] = r_bp / r_bw;
    by[STATES + WHEEL_ANGLE][OFFSET] = -1.0 / r_bw;
    by[STATES + WHEEL_SPEED][SPEED] = r_bp / r_bw;
    by[STATES + WHEEL_SPEED][OFFSET_RATE] = -1.0 / r_bw;
    by[STATES + TRANSMISSION_ERROR][OFFSET] = -1.0;

    /* What no one integrates is left to differences. */
    for (int k = 0; k < STATES; ++k) {
        by[STATES + LOSS][k] = NAN;
        by[STATES + STORED_ENERGY][k] = NAN;
    }
}

static int evaluate(fmu_values *values, const file_mesh *made, int with_outputs,
                    fmu_jacobian *jacobian) {
    const gm_pair *pair = file_mesh_pair(made);
    const double r_bp = pair->pinion.base_radius;
    const double r_bw = pair->wheel.base_radius;
    const double *state = values->state;

    /* The mesh, whose friction needs to know how fast the gears turn. */
    gm_position position;
    gm_mesh_result result;
    file_mesh_float floated;
    int status = gm_position_from_pinion_angle(pair, state[ANGLE], state[OFFSET],
                                               state[OFFSET_RATE], &position);
    if (status == GM_OK) {
        position.pinion_speed = state[SPEED];
        const int wanted = (jacobian != NULL ? GM_WANT_DERIVATIVES : GM_WANT_FORCE) |
                           (with_outputs ? GM_WANT_ENERGY : 0);
        status = file_mesh_evaluate(made, &position, wanted, &floated, &result);
    }
    if (status != GM_OK) {
        return status;
    }

    /* The equations of motion. */
    const double pinion_acceleration =
        (values->input[DRIVE_TORQUE] - result.pinion_torque) / values->pinion_inertia;
    const double wheel_acceleration =
        (result.wheel_torque - values->input[LOAD_TORQUE]) / values->wheel_inertia;
    values->derivative[ANGLE] = state[SPEED];
    values->derivative[SPEED] = pinion_acceleration;
    values->derivative[OFFSET] = state[OFFSET_RATE];
    values->derivative[OFFSET_RATE] = r_bp * pinion_acceleration - r_bw * wheel_acceleration;

    values->output[WHEEL_ANGLE] = (r_bp * state[ANGLE] - state[OFFSET]) / r_bw;
    values->output[WHEEL_SPEED] = (r_bp * state[SPEED] - state[OFFSET_RATE]) / r_bw;
    values->output[TRANSMISSION_ERROR] = -state[OFFSET];
    values->output[FORCE] = result.force;
    values->output[APEX_SHIFT] = floated.shift;
    values->output[LOSS] = result.loss;
    values->output[STORED_ENERGY] = result.energy;

    values->indicator[GM_DRIVE] = state[OFFSET] - file_mesh_clearance(made, GM_DRIVE);
    values->indicator[GM_COAST] = -state[OFFSET] - file_mesh_clearance(made, GM_COAST);
    if (jacobian != NULL) {
        differentiate(values, pair, &result, &floated.by, jacobian);
    }
    return GM_OK;
}

const fmu_model model = {
    .name = "GearPair",
    .description = "A gearbox of two bodies with real helical gears: torques in, motion out",
    .variables = variables,
    .variable_count = (int)(sizeof variables / sizeof variables[0]),
    .states = STATES,
    .angle_state = ANGLE,
    .inputs = INPUTS,
    .outputs = OUTPUTS,
    .evaluate = evaluate,
};
