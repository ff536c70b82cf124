/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * GearMesh: the mesh as an element between two shafts of another model. Angles, speeds and the pose of the wheel with its
 * rate in, torques and wrenches out; no states.
 */
#include "model.h"

#include <math.h>
#include <string.h>

enum {
    PINION_ANGLE,
    WHEEL_ANGLE,
    PINION_SPEED,
    WHEEL_SPEED,
    POSE,
    POSE_RATE = POSE + 5,
    INPUTS = POSE_RATE + 5
};
enum {
    PINION_TORQUE,
    WHEEL_TORQUE,
    FORCE,
    TRANSMISSION_ERROR,
    APEX_SHIFT,
    LOSS,
    STORED_ENERGY,
    WRENCH,
    OUTPUTS = WRENCH + 12
};

#define INPUT(name, unit, description, place)                                                      \
    { name, unit, description, KIND_REAL, ROLE_INPUT, offsetof(fmu_values, input[place]), 0.0, 0 }
#define OUTPUT(name, unit, description, place)                                                     \
    { name, unit, description, KIND_REAL, ROLE_OUTPUT, offsetof(fmu_values, output[place]), 0.0, 0 }

static const fmu_variable variables[] = {
    {"time", "s", "simulation time", KIND_REAL, ROLE_TIME, offsetof(fmu_values, time), 0.0, 0},
    INPUT("pinion_angle", "rad", "phi_p", PINION_ANGLE),
    INPUT("wheel_angle", "rad", "phi_w", WHEEL_ANGLE),
    INPUT("pinion_speed", "rad/s", "d phi_p / dt", PINION_SPEED),
    INPUT("wheel_speed", "rad/s", "d phi_w / dt", WHEEL_SPEED),
    INPUT("motion.center_distance_change", "m", "of the wheel beside its pose, along +x", POSE),
    INPUT("motion.offset", "m", "along +y", POSE + 1),
    INPUT("motion.axial_shift", "m", "along +z", POSE + 2),
    INPUT("motion.skew", "rad", "about +x", POSE + 3),
    INPUT("motion.inclination", "rad", "about +y", POSE + 4),
    INPUT("motion_rate.center_distance_change", "m/s", "rate of the motion", POSE_RATE),
    INPUT("motion_rate.offset", "m/s", "likewise", POSE_RATE + 1),
    INPUT("motion_rate.axial_shift", "m/s", "likewise", POSE_RATE + 2),
    INPUT("motion_rate.skew", "rad/s", "likewise", POSE_RATE + 3),
    INPUT("motion_rate.inclination", "rad/s", "likewise", POSE_RATE + 4),
    OUTPUT("pinion_torque", "N.m", "that the mesh takes from the pinion", PINION_TORQUE),
    OUTPUT("wheel_torque", "N.m", "that the mesh gives to the wheel", WHEEL_TORQUE),
    OUTPUT("force", "N", "along the transverse line of action, > 0 drives the wheel forward",
           FORCE),
    OUTPUT("transmission_error", "m", "-x, along the line of action", TRANSMISSION_ERROR),
    OUTPUT("apex_shift", "m", "how far a double-helical pinion has floated along +z", APEX_SHIFT),
    OUTPUT("loss", "W", "power that friction takes, >= 0", LOSS),
    OUTPUT("stored_energy", "J", "in what is pressed together", STORED_ENERGY),
    OUTPUT("pinion_force.x", "N", "on the pinion", WRENCH),
    OUTPUT("pinion_force.y", "N", "likewise", WRENCH + 1),
    OUTPUT("pinion_force.z", "N", "likewise", WRENCH + 2),
    OUTPUT("pinion_moment.x", "N.m", "on the pinion about its axis at z = 0", WRENCH + 3),
    OUTPUT("pinion_moment.y", "N.m", "likewise", WRENCH + 4),
    OUTPUT("pinion_moment.z", "N.m", "likewise", WRENCH + 5),
    OUTPUT("wheel_force.x", "N", "on the wheel", WRENCH + 6),
    OUTPUT("wheel_force.y", "N", "likewise", WRENCH + 7),
    OUTPUT("wheel_force.z", "N", "likewise", WRENCH + 8),
    OUTPUT("wheel_moment.x", "N.m", "on the wheel about its axis, not yet tilted, at z = 0",
           WRENCH + 9),
    OUTPUT("wheel_moment.y", "N.m", "likewise", WRENCH + 10),
    OUTPUT("wheel_moment.z", "N.m", "likewise", WRENCH + 11),
#include "common_variables.inc"
};

/* A pose from five inputs. */
static gm_pose pose_of(const double *input) {
    const gm_pose pose = {.center_distance_change = input[0],
                          .offset = input[1],
                          .axial_shift = input[2],
                          .skew = input[3],
                          .inclination = input[4]};
    return pose;
}

/* A row of the Jacobian: known by angles and speeds. */
static void set_row(double *row, const gm_gradient *gradient) {
    row[PINION_ANGLE] = gradient->pinion_angle;
    row[WHEEL_ANGLE] = gradient->wheel_angle;
    row[PINION_SPEED] = gradient->pinion_speed;
    row[WHEEL_SPEED] = gradient->wheel_speed;
}

/* Force and wrench by all coordinates and their rates, exactly, where the law has its tangent; the pinion of a
 * double-helical pair would stand still in it. */
static void set_tangent(const file_mesh *made, const gm_motion *motion, fmu_jacobian *jacobian) {
    gm_tangent tangent;
    if (made->halves == 2 || gm_mesh_tangent(made->mesh[0], motion, &tangent) != GM_OK) {
        return;
    }
    for (int coordinate = 0; coordinate < GM_COORDINATES; ++coordinate) {
        const int is_angle = coordinate <= GM_WHEEL_ANGLE;
        const int pose = coordinate - GM_CENTER_DISTANCE_CHANGE;
        const int column = is_angle ? PINION_ANGLE + coordinate : POSE + pose;
        const int rate_column = is_angle ? PINION_SPEED + coordinate : POSE_RATE + pose;
        jacobian->by[FORCE][column] = tangent.force_by[coordinate];
        jacobian->by[FORCE][rate_column] = tangent.force_by_rate[coordinate];

        /* A wrench is its twelve numbers, in the order of the outputs. */
        double parts[12];
        double rate_parts[12];
        memcpy(parts, &tangent.wrench_by[coordinate], sizeof parts);
        memcpy(rate_parts, &tangent.wrench_by_rate[coordinate], sizeof rate_parts);
        for (int part = 0; part < 12; ++part) {
            jacobian->by[WRENCH + part][column] = parts[part];
            jacobian->by[WRENCH + part][rate_column] = rate_parts[part];
        }
    }
}

/* The error is that of the angles; what is not known exactly is left to differences. */
static void differentiate(const file_mesh *made, const gm_motion *motion,
                          const gm_mesh_result *result, const gm_gradient *float_by,
                          fmu_jacobian *jacobian) {
    for (int row = 0; row < OUTPUTS; ++row) {
        for (int column = 0; column < INPUTS; ++column) {
            jacobian->by[row][column] = row == TRANSMISSION_ERROR ? 0.0 : NAN;
        }
    }
    set_tangent(made, motion, jacobian);
    set_row(jacobian->by[PINION_TORQUE], &result->pinion_torque_by);
    set_row(jacobian->by[WHEEL_TORQUE], &result->wheel_torque_by);
    set_row(jacobian->by[FORCE], &result->force_by);
    set_row(jacobian->by[APEX_SHIFT], float_by);
    const gm_pair *pair = file_mesh_pair(made);
    jacobian->by[TRANSMISSION_ERROR][PINION_ANGLE] = -pair->pinion.base_radius;
    jacobian->by[TRANSMISSION_ERROR][WHEEL_ANGLE] = pair->wheel.base_radius;
}

/* There are no states, so that all calls are for outputs. */
static int evaluate(fmu_values *values, const file_mesh *made, int with_outputs,
                    fmu_jacobian *jacobian) {
    (void)with_outputs;
    const gm_pair *pair = file_mesh_pair(made);
    const gm_state state = {.pinion_angle = values->input[PINION_ANGLE],
                            .wheel_angle = values->input[WHEEL_ANGLE],
                            .pinion_speed = values->input[PINION_SPEED],
                            .wheel_speed = values->input[WHEEL_SPEED]};
    gm_motion motion = {.pose = pose_of(&values->input[POSE]),
                        .pose_rate = pose_of(&values->input[POSE_RATE])};
    gm_mesh_result result;
    file_mesh_float floated;
    int status = gm_position_from_state(pair, &state, &motion.position);
    if (status == GM_OK) {
        const int wanted =
            GM_WANT_WRENCH | GM_WANT_ENERGY | (jacobian != NULL ? GM_WANT_DERIVATIVES : 0);
        status = file_mesh_evaluate_posed(made, &motion, wanted, &floated, &result);
    }
    if (status != GM_OK) {
        return status;
    }

    values->output[PINION_TORQUE] = result.pinion_torque;
    values->output[WHEEL_TORQUE] = result.wheel_torque;
    values->output[FORCE] = result.force;
    values->output[TRANSMISSION_ERROR] = -motion.position.offset;
    values->output[APEX_SHIFT] = floated.shift;
    values->output[LOSS] = result.loss;
    values->output[STORED_ENERGY] = result.energy;
    const double *parts[] = {result.wrench.pinion_force, result.wrench.pinion_moment,
                             result.wrench.wheel_force, result.wrench.wheel_moment};
    for (int part = 0; part < 4; ++part) {
        memcpy(&values->output[WRENCH + 3 * part], parts[part], 3 * sizeof(double));
    }

    values->indicator[GM_DRIVE] = motion.position.offset - file_mesh_clearance(made, GM_DRIVE);
    values->indicator[GM_COAST] = -motion.position.offset - file_mesh_clearance(made, GM_COAST);
    if (jacobian != NULL) {
        differentiate(made, &motion, &result, &floated.by, jacobian);
    }
    return GM_OK;
}

const fmu_model model = {
    .name = "GearMesh",
    .description = "The mesh of two real helical gears between two shafts: angles, speeds and "
                   "motion in, torques and wrenches out",
    .variables = variables,
    .variable_count = (int)(sizeof variables / sizeof variables[0]),
    .states = 0,
    .angle_state = -1,
    .inputs = INPUTS,
    .outputs = OUTPUTS,
    .evaluate = evaluate,
};
