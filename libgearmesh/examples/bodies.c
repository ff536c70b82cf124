/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Two gears as bodies of a multibody code with an implicit integrator: how the loads on both change with where the bodies
 * are, 12 times 12 numbers, from the exact tangent of the mesh. The contact, with its kinks, is never differenced, only the
 * way from bodies to the mesh frame, which is smooth: 24 calls of gm_motion_of_bodies(), some hundred instructions each.
 *
 * It prints how stiff the mesh is along the normal of the flanks, and compares the matrix with differences of the loads.
 */
#include <gearmesh/gearmesh.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Of each body: along x, y, z of the common frame, and about them; so are loads, force before moment. */
enum { COORDINATES = 12 };

static const double pi = 3.14159265358979323846;

static gm_mesh *mesh_of_example(void) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 45;
    params.wheel_teeth = 41;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 16.0 * pi / 180.0;
    params.helix_angle = 33.0 * pi / 180.0;
    params.center_distance = 0.085;
    params.pinion_face_width = 0.020;
    params.wheel_face_width = 0.0175;
    params.backlash = 100e-6;

    gm_pair pair;
    gm_mesh_params law;
    gm_mesh *mesh = NULL;
    gm_mesh_params_default(&law);
    law.stiffness = 1.05e8;
    if (gm_pair_init(&pair, &params) == GM_OK) {
        const size_t size = gm_mesh_size(&law, &pair);
        (void)gm_mesh_init(&mesh, &law, &pair, NULL, NULL, malloc(size), size);
    }
    return mesh;
}

/* ---------------------------------------------------------------------------------------------
 * Bodies that move a little
 * ------------------------------------------------------------------------------------------- */

/* The plane of two axes of the common frame, turned about the third one. */
static void turn(double *a, double *b, double angle) {
    const double turned = cos(angle) * *a - sin(angle) * *b;
    *b = sin(angle) * *a + cos(angle) * *b;
    *a = turned;
}

static void turn_body(gm_body *body, int axis, double angle) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    for (int column = 0; column < 3; ++column) {
        turn(&body->rotation[3 * next + column], &body->rotation[3 * last + column], angle);
    }
}

static void move(gm_body bodies[2], int coordinate, double step) {
    gm_body *body = &bodies[coordinate / 6];
    const int of_body = coordinate % 6;
    if (of_body < 3) {
        body->position[of_body] += step;
    } else {
        turn_body(body, of_body - 3, step);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Their loads, from the wrench in the mesh frame
 * ------------------------------------------------------------------------------------------- */

/* Force and moment about the middle of the face, which is at `arm` from the point that the moment was about. */
static void turn_load(const double frame[9], const double force[3], const double moment[3],
                      const double arm[3], double load[6]) {
    const double about[3] = {moment[0] - (arm[1] * force[2] - arm[2] * force[1]),
                             moment[1] - (arm[2] * force[0] - arm[0] * force[2]),
                             moment[2] - (arm[0] * force[1] - arm[1] * force[0])};
    for (int row = 0; row < 3; ++row) {
        load[row] = load[3 + row] = 0.0;
        for (int column = 0; column < 3; ++column) {
            load[row] += frame[3 * row + column] * force[column];
            load[3 + row] += frame[3 * row + column] * about[column];
        }
    }
}

/* A mesh that is prepared as drawn has the wheel's axis at the wheel's point. */
static void loads_of(const gm_pair *pair, const gm_motion *motion, const double frame[9],
                     const gm_wrench *wrench, double loads[COORDINATES]) {
    const double middle_p = 0.5 * pair->pinion.face_width;
    const double middle_w =
        pair->wheel.face_start + 0.5 * pair->wheel.face_width + motion->pose.axial_shift;
    const double to_pinion[3] = {0.0, 0.0, middle_p}, to_wheel[3] = {0.0, 0.0, middle_w};
    turn_load(frame, wrench->pinion_force, wrench->pinion_moment, to_pinion, loads);
    turn_load(frame, wrench->wheel_force, wrench->wheel_moment, to_wheel, loads + 6);
}

/* How far the seven coordinates of the mesh have moved; teeth may have changed between. */
static void difference_of(const gm_pair *pair, const gm_motion *to, const gm_motion *from,
                          double moved[GM_COORDINATES]) {
    const double pitch = pair->transverse_base_pitch;
    const double x = to->position.offset - from->position.offset;
    double phase = to->position.phase - from->position.phase;
    phase -= pitch * floor(phase / pitch + 0.5);
    moved[GM_PINION_ANGLE] = phase / pair->pinion.base_radius;
    moved[GM_WHEEL_ANGLE] = (phase - x) / pair->wheel.base_radius;
    moved[GM_CENTER_DISTANCE_CHANGE] =
        to->pose.center_distance_change - from->pose.center_distance_change;
    moved[GM_OFFSET] = to->pose.offset - from->pose.offset;
    moved[GM_AXIAL_SHIFT] = to->pose.axial_shift - from->pose.axial_shift;
    moved[GM_SKEW] = to->pose.skew - from->pose.skew;
    moved[GM_INCLINATION] = to->pose.inclination - from->pose.inclination;
}

static void add_wrench(gm_wrench *sum, const gm_wrench *by, double amount) {
    for (int i = 0; i < 3; ++i) {
        sum->pinion_force[i] += amount * by->pinion_force[i];
        sum->pinion_moment[i] += amount * by->pinion_moment[i];
        sum->wheel_force[i] += amount * by->wheel_force[i];
        sum->wheel_moment[i] += amount * by->wheel_moment[i];
    }
}

/*
 * by[k][i]: how load i changes with coordinate k, at fixed velocities. With speeds it is the same with
 * tangent.wrench_by_rate and the rates of the motion.
 */
static int matrix_of(const gm_mesh *mesh, const gm_body bodies[2], const gm_wrench *wrench,
                     double by[COORDINATES][COORDINATES]) {
    const gm_pair *pair = gm_mesh_pair(mesh);
    const double step = 1e-6; /* m, rad: second order of the geometry is 1e-12 of it */
    gm_motion here;
    gm_tangent tangent;
    int status = gm_motion_of_bodies(mesh, &bodies[0], &bodies[1], &here, NULL);
    if (status == GM_OK) {
        status = gm_mesh_tangent(mesh, &here, &tangent);
    }

    for (int k = 0; k < COORDINATES && status == GM_OK; ++k) {
        double loads[2][COORDINATES];
        for (int side = 0; side < 2 && status == GM_OK; ++side) {
            gm_body moved[2] = {bodies[0], bodies[1]};
            gm_motion there;
            double frame[9], moved_by[GM_COORDINATES];
            move(moved, k, side == 0 ? -step : step);
            status = gm_motion_of_bodies(mesh, &moved[0], &moved[1], &there, frame);

            /* The wrench there, by the tangent, then as loads in the frame there. */
            gm_wrench then = *wrench;
            difference_of(pair, &there, &here, moved_by);
            for (int c = 0; c < GM_COORDINATES; ++c) {
                add_wrench(&then, &tangent.wrench_by[c], moved_by[c]);
            }
            loads_of(pair, &there, frame, &then, loads[side]);
        }
        for (int i = 0; i < COORDINATES; ++i) {
            by[k][i] = (loads[1][i] - loads[0][i]) / (2.0 * step);
        }
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * A place, and what is known of it
 * ------------------------------------------------------------------------------------------- */

/* The loads themselves, differenced: largest distance from the matrix, by the largest entry of its kind. */
static double distance_from_differences(const gm_mesh *mesh, const gm_body bodies[2],
                                        double by[COORDINATES][COORDINATES]) {
    const double step = 1e-9;
    double off[2][2] = {{0.0}}, largest[2][2] = {{0.0}}, worst = 0.0;
    for (int k = 0; k < COORDINATES; ++k) {
        /* The loads on both bodies, with one of them a step behind and ahead along a coordinate. */
        gm_load on[2][2];
        gm_mesh_result result;
        for (int side = 0; side < 2; ++side) {
            gm_body moved[2] = {bodies[0], bodies[1]};
            move(moved, k, side == 0 ? -step : step);
            if (gm_mesh_evaluate_bodies(mesh, &moved[0], &moved[1], GM_WANT_FORCE, NULL, &result,
                                        &on[side][0], &on[side][1]) != GM_OK) {
                return HUGE_VAL;
            }
        }

        /* Against the column of the matrix; forces and moments, shifts and turns each for themselves. */
        for (int i = 0; i < COORDINATES; ++i) {
            const int turns = k % 6 > 2, is_moment = i % 6 > 2;
            const gm_load *ahead = &on[1][i / 6], *behind = &on[0][i / 6];
            const double change = is_moment ? ahead->moment[i % 3] - behind->moment[i % 3]
                                            : ahead->force[i % 3] - behind->force[i % 3];
            double *far = &off[turns][is_moment], *most = &largest[turns][is_moment];
            *far = fmax(*far, fabs(change / (2.0 * step) - by[k][i]));
            *most = fmax(*most, fabs(by[k][i]));
        }
    }

    for (int kind = 0; kind < 4; ++kind) {
        worst = fmax(worst, off[kind / 2][kind % 2] / largest[kind / 2][kind % 2]);
    }
    return worst;
}

int main(void) {
    gm_mesh *mesh = mesh_of_example();
    if (mesh == NULL) {
        fprintf(stderr, "the gears are refused\n");
        return 1;
    }

    /* As drawn, the pinion turned into the wheel by 60 um; all of it turned somehow in the common frame. */
    const gm_pair *pair = gm_mesh_pair(mesh);
    gm_body bodies[2] = {
        {.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}},
        {.position = {pair->center_distance, 0, 0}, .rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}}};
    turn_body(&bodies[0], 2, 60e-6 / pair->pinion.base_radius);
    for (int axis = 0; axis < 3; ++axis) {
        const double angle = 0.4 + axis;
        turn(&bodies[1].position[(axis + 1) % 3], &bodies[1].position[(axis + 2) % 3], angle);
        turn_body(&bodies[0], axis, angle);
        turn_body(&bodies[1], axis, angle);
    }

    gm_mesh_result result;
    gm_load on_pinion, on_wheel;
    double by[COORDINATES][COORDINATES];
    int status = gm_mesh_evaluate_bodies(mesh, &bodies[0], &bodies[1], GM_WANT_FORCE, NULL, &result,
                                         &on_pinion, &on_wheel);
    if (status == GM_OK) {
        status = matrix_of(mesh, bodies, &result.wrench, by);
    }
    if (status != GM_OK) {
        fprintf(stderr, "%s\n", gm_status_text(status));
        return 1;
    }

    /* Pressed into each other along the normal of the flanks, which is the direction of the force, they are springs of
       stiffness K for what touches, and 1 / cos(beta_b) counts twice: for the way and for the force. */
    const double *force = on_wheel.force;
    const double size = sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
    double along = 0.0;
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 3; ++i) {
            along -= force[k] * by[6 + k][6 + i] * force[i] / (size * size);
        }
    }
    const double known = gm_mesh_touching_stiffness(mesh, &result) * pair->normal_to_transverse *
                         pair->normal_to_transverse;
    printf("along the normal %.2f N/um, by what touches %.2f N/um; %.1e from differences\n",
           1e-6 * along, 1e-6 * known, distance_from_differences(mesh, bodies, by));
    free(mesh);
    return 0;
}
