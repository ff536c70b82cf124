/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* GearMesh: the mesh as an element between two shafts of another model. Angles and speeds in, torques out; no states. */
#include "model.h"

enum { PINION_ANGLE, WHEEL_ANGLE, PINION_SPEED, WHEEL_SPEED, INPUTS };
enum { PINION_TORQUE, WHEEL_TORQUE, FORCE, TRANSMISSION_ERROR, OUTPUTS };

static const fmu_variable variables[] = {
    {"time", "s", "simulation time", KIND_REAL, ROLE_TIME, offsetof(fmu_values, time), 0.0, 0},
    {"pinion_angle", "rad", "phi_p", KIND_REAL, ROLE_INPUT,
     offsetof(fmu_values, input[PINION_ANGLE]), 0.0, 0},
    {"wheel_angle", "rad", "phi_w", KIND_REAL, ROLE_INPUT, offsetof(fmu_values, input[WHEEL_ANGLE]),
     0.0, 0},
    {"pinion_speed", "rad/s", "d phi_p / dt", KIND_REAL, ROLE_INPUT,
     offsetof(fmu_values, input[PINION_SPEED]), 0.0, 0},
    {"wheel_speed", "rad/s", "d phi_w / dt", KIND_REAL, ROLE_INPUT,
     offsetof(fmu_values, input[WHEEL_SPEED]), 0.0, 0},
    {"pinion_torque", "N.m", "that the mesh takes from the pinion", KIND_REAL, ROLE_OUTPUT,
     offsetof(fmu_values, output[PINION_TORQUE]), 0.0, 0},
    {"wheel_torque", "N.m", "that the mesh gives to the wheel", KIND_REAL, ROLE_OUTPUT,
     offsetof(fmu_values, output[WHEEL_TORQUE]), 0.0, 0},
    {"force", "N", "along the transverse line of action, > 0 drives the wheel forward", KIND_REAL,
     ROLE_OUTPUT, offsetof(fmu_values, output[FORCE]), 0.0, 0},
    {"transmission_error", "m", "-x, along the line of action", KIND_REAL, ROLE_OUTPUT,
     offsetof(fmu_values, output[TRANSMISSION_ERROR]), 0.0, 0},
#include "common_variables.inc"
};

/* A row of the Jacobian from a gradient. */
static void set_row(double *row, const gm_gradient *gradient) {
    row[PINION_ANGLE] = gradient->pinion_angle;
    row[WHEEL_ANGLE] = gradient->wheel_angle;
    row[PINION_SPEED] = gradient->pinion_speed;
    row[WHEEL_SPEED] = gradient->wheel_speed;
}

static int evaluate(fmu_values *values, const gm_mesh *mesh, gm_workspace *workspace,
                    fmu_jacobian *jacobian) {
    const gm_pair *pair = gm_mesh_pair(mesh);
    const gm_state state = {.pinion_angle = values->input[PINION_ANGLE],
                            .wheel_angle = values->input[WHEEL_ANGLE],
                            .pinion_speed = values->input[PINION_SPEED],
                            .wheel_speed = values->input[WHEEL_SPEED]};
    gm_position position;
    gm_mesh_result result;
    int status = gm_position_from_state(pair, &state, &position);
    if (status == GM_OK) {
        status = gm_mesh_evaluate_at(mesh, &position,
                                     jacobian != NULL ? GM_WANT_DERIVATIVES : GM_WANT_FORCE,
                                     workspace, &result);
    }
    if (status != GM_OK) {
        return status;
    }

    values->output[PINION_TORQUE] = result.pinion_torque;
    values->output[WHEEL_TORQUE] = result.wheel_torque;
    values->output[FORCE] = result.force;
    values->output[TRANSMISSION_ERROR] = -position.offset;
    values->indicator[GM_DRIVE] = position.offset - gm_mesh_clearance(mesh, GM_DRIVE);
    values->indicator[GM_COAST] = -position.offset - gm_mesh_clearance(mesh, GM_COAST);
    if (jacobian != NULL) {
        set_row(jacobian->by[PINION_TORQUE], &result.pinion_torque_by);
        set_row(jacobian->by[WHEEL_TORQUE], &result.wheel_torque_by);
        set_row(jacobian->by[FORCE], &result.force_by);
        jacobian->by[TRANSMISSION_ERROR][PINION_ANGLE] = -pair->pinion.base_radius;
        jacobian->by[TRANSMISSION_ERROR][WHEEL_ANGLE] = pair->wheel.base_radius;
    }
    return GM_OK;
}

const fmu_model model = {
    .name = "GearMesh",
    .description =
        "The mesh of two real helical gears between two shafts: angles and speeds in, torques out",
    .variables = variables,
    .variable_count = (int)(sizeof variables / sizeof variables[0]),
    .states = 0,
    .angle_state = -1,
    .inputs = INPUTS,
    .outputs = OUTPUTS,
    .evaluate = evaluate,
};
