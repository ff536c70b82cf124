/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The mesh between two bodies of any multibody code.
 *
 * The mesh frame M has its z axis along the pinion's axis and its x axis towards the wheel, or away from the axis of a
 * ring, so that the wheel moves along x and z alone. It turns with the pinion's axis and with the direction of the wheel, which is taken off both angles and
 * speeds. So nothing depends on the common frame, nor on how it moves.
 *
 * The wheel's rotation in M is exp(theta) Rz(turn), theta without a z component: the tilt of its axis, and a turn about
 * the tilted axis [swing and twist of a rotation].
 */
#include "internal.h"
#include "mesh.h"
#include "position.h"

#include <math.h>
#include <string.h>

/* A rotation matrix is refused if its columns are off by more. */
static const double largest_distortion = 1e-3;

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double result[3]) {
    result[0] = a[1] * b[2] - a[2] * b[1];
    result[1] = a[2] * b[0] - a[0] * b[2];
    result[2] = a[0] * b[1] - a[1] * b[0];
}

/* a + factor b */
static void add(const double a[3], double factor, const double b[3], double result[3]) {
    for (int k = 0; k < 3; ++k) {
        result[k] = a[k] + factor * b[k];
    }
}

/* Column of a rotation matrix: an axis of the body in the common frame. */
static void axis_of(const double rotation[9], int column, double axis[3]) {
    for (int k = 0; k < 3; ++k) {
        axis[k] = rotation[3 * k + column];
    }
}

/* The axes of M in the common frame, row by row. */
typedef struct mesh_frame {
    double axis[3][3];
} mesh_frame;

static void into_frame(const mesh_frame *frame, const double common[3], double inside[3]) {
    for (int k = 0; k < 3; ++k) {
        inside[k] = dot(frame->axis[k], common);
    }
}

static void out_of_frame(const mesh_frame *frame, const double inside[3], double common[3]) {
    for (int k = 0; k < 3; ++k) {
        common[k] = frame->axis[0][k] * inside[0] + frame->axis[1][k] * inside[1] +
                    frame->axis[2][k] * inside[2];
    }
}

/* Finite, and the rotation is one. */
static int check_body(const gm_body *body) {
    double all = 0.0;
    for (int k = 0; k < 3; ++k) {
        all += body->position[k] + body->velocity[k] + body->angular_velocity[k];
    }
    for (int k = 0; k < 9; ++k) {
        all += body->rotation[k];
    }
    if (!gmi_is_finite(all)) {
        return GM_STATE_NOT_FINITE;
    }

    double axes[3][3], third[3];
    for (int k = 0; k < 3; ++k) {
        axis_of(body->rotation, k, axes[k]);
    }
    cross(axes[0], axes[1], third);
    const int is_rotation = fabs(dot(axes[0], axes[0]) - 1.0) <= largest_distortion &&
                            fabs(dot(axes[1], axes[1]) - 1.0) <= largest_distortion &&
                            fabs(dot(axes[0], axes[1])) <= largest_distortion &&
                            fabs(dot(third, axes[2]) - 1.0) <= largest_distortion;
    return is_rotation ? GM_OK : GM_STATE_OUT_OF_RANGE;
}

/* Where the wheel's reference point is in M, and how fast it moves there. */
typedef struct wheel_place {
    double distance, along;           /* along x, below 0 for a ring, and along z (m) */
    double distance_rate, along_rate; /* (m/s) */
    double frame_velocity[3];         /* angular velocity of M in the common frame (rad/s) */
} wheel_place;

/* False where the wheel's point is on the pinion's axis. */
static int find_frame(const gm_body *pinion, const gm_body *wheel, double sign, mesh_frame *frame,
                      wheel_place *place) {
    double *x = frame->axis[0], *y = frame->axis[1], *z = frame->axis[2];
    double arm[3], velocity[3];
    axis_of(pinion->rotation, 2, z);
    add(wheel->position, -1.0, pinion->position, arm);
    add(wheel->velocity, -1.0, pinion->velocity, velocity);

    /* The way to the wheel, across the axis and along it. */
    place->along = dot(arm, z);
    add(arm, -place->along, z, x);
    place->distance = sign * sqrt(dot(x, x));
    if (place->distance == 0.0) {
        return 0;
    }
    for (int k = 0; k < 3; ++k) {
        x[k] /= place->distance;
    }
    cross(z, x, y);

    /* M turns with the pinion's axis, and about it as the wheel goes round. */
    const double spin = dot(pinion->angular_velocity, z);
    double swept[3];
    add(pinion->angular_velocity, -spin, z, place->frame_velocity);
    cross(place->frame_velocity, arm, swept);
    add(velocity, -1.0, swept, velocity);
    add(place->frame_velocity, dot(velocity, y) / place->distance, z, place->frame_velocity);
    place->distance_rate = dot(velocity, x);
    place->along_rate = dot(velocity, z);
    return 1;
}

/* A gear's rotation in M: its tilt, its turn about its own axis, and their rates. */
typedef struct turned {
    double tilt[2], tilt_rate[2]; /* about x and y (rad, rad/s) */
    double turn, turn_rate;       /* (rad, rad/s) */
} turned;

/* False where the axis points the other way. */
static int find_turned(const gm_body *body, const mesh_frame *frame, const double frame_velocity[3],
                       turned *result) {
    double axes[3][3], axis[3], omega[3];
    for (int k = 0; k < 3; ++k) {
        axis_of(body->rotation, k, axis);
        into_frame(frame, axis, axes[k]);
    }
    add(body->angular_velocity, -1.0, frame_velocity, axis);
    into_frame(frame, axis, omega);
    const double x = axes[2][0], y = axes[2][1], z = axes[2][2]; /* the gear's own axis */
    if (!(z > 0.0)) {
        return 0;
    }

    /* The trace and the skew part of both in-plane axes hold the turn times 1 + z. */
    result->turn = atan2(axes[0][1] - axes[1][0], axes[0][0] + axes[1][1]);
    result->turn_rate = (omega[2] + omega[0] * x + omega[1] * y + omega[2] * z) / (1.0 + z);

    /* theta is along k x axis; angle over sine and its derivative by the sine's square, which is lost at 0. */
    const double square = x * x + y * y;
    const double sine = sqrt(square);
    const double ratio = sine > 0.0 ? atan2(sine, z) / sine : 1.0;
    const double by_square = square > 1e-6 ? 0.5 * (1.0 / z - ratio) / square : 1.0 / 6.0;
    const double x_rate = omega[1] * z - omega[2] * y;
    const double y_rate = omega[2] * x - omega[0] * z;
    const double ratio_rate = by_square * 2.0 * (x * x_rate + y * y_rate);
    result->tilt[0] = -ratio * y;
    result->tilt[1] = ratio * x;
    result->tilt_rate[0] = -ratio * y_rate - ratio_rate * y;
    result->tilt_rate[1] = ratio * x_rate + ratio_rate * x;
    return 1;
}

/* Middle of the wheel's face less that of the pinion's, as drawn (m). */
static double drawn_offset(const gm_pair *pair) {
    return pair->wheel.face_start + 0.5 * pair->wheel.face_width - 0.5 * pair->pinion.face_width;
}

static int find_motion(const gm_mesh *mesh, const gm_body *pinion, const gm_body *wheel,
                       gm_motion *motion, mesh_frame *frame, wheel_place *place) {
    const gm_pair *pair = mesh->pair;
    int status = check_body(pinion);
    if (status == GM_OK) {
        status = check_body(wheel);
    }
    turned of_pinion, of_wheel;
    if (status == GM_OK && (!find_frame(pinion, wheel, pair->wheel.sign, frame, place) ||
                            !find_turned(pinion, frame, place->frame_velocity, &of_pinion) ||
                            !find_turned(wheel, frame, place->frame_velocity, &of_wheel))) {
        status = GM_POSE_OUT_OF_MESH;
    }
    if (status != GM_OK) {
        return status;
    }

    /* The wheel's angle counts clockwise, but that of a ring. */
    const double sign = pair->wheel.sign;
    const gm_state state = {of_pinion.turn, -sign * of_wheel.turn, of_pinion.turn_rate,
                            -sign * of_wheel.turn_rate};
    const double shift = place->along - drawn_offset(pair);
    const gm_pose pose = {place->distance - sign * pair->center_distance, 0.0, shift,
                          of_wheel.tilt[0], of_wheel.tilt[1]};
    const gm_pose rate = {place->distance_rate, 0.0, place->along_rate, of_wheel.tilt_rate[0],
                          of_wheel.tilt_rate[1]};
    motion->pose = pose;
    motion->pose_rate = rate;
    return gmi_position_nearest(pair, &state, shift * (pair->face_advance / pair->face_width),
                                &motion->position);
}

static void set_motion_nan(gm_motion *motion) {
    const double nan = gmi_nan();
    const gm_pose none = {nan, nan, nan, nan, nan};
    const gm_motion all = {{0, 0, nan, nan, nan, nan}, none, none};
    *motion = all;
}

int gm_motion_of_bodies(const gm_mesh *mesh, const gm_body *pinion, const gm_body *wheel,
                        gm_motion *motion, double frame[9]) {
    if (motion == NULL) {
        return GM_ERR_NULL;
    }
    set_motion_nan(motion);
    for (int k = 0; frame != NULL && k < 9; ++k) {
        frame[k] = gmi_nan();
    }
    if (mesh == NULL || pinion == NULL || wheel == NULL) {
        return GM_ERR_NULL;
    }

    mesh_frame found;
    wheel_place place;
    const int status = find_motion(mesh, pinion, wheel, motion, &found, &place);
    if (status != GM_OK) {
        set_motion_nan(motion);
        return status;
    }
    for (int k = 0; frame != NULL && k < 9; ++k) {
        frame[k] = found.axis[k % 3][k / 3];
    }
    return GM_OK;
}

/* A load in M about one point, in the common frame about another one, which is at `arm` from it. */
static void set_load(const mesh_frame *frame, const double force[3], const double moment[3],
                     const double arm[3], gm_load *load) {
    double turning[3], about[3];
    cross(arm, force, turning);
    add(moment, -1.0, turning, about);
    out_of_frame(frame, force, load->force);
    out_of_frame(frame, about, load->moment);
}

int gm_mesh_evaluate_bodies(const gm_mesh *mesh, const gm_body *pinion, const gm_body *wheel,
                            int wanted, gm_workspace *workspace, gm_mesh_result *result,
                            gm_load *on_pinion, gm_load *on_wheel) {
    if (result == NULL || on_pinion == NULL || on_wheel == NULL) {
        return GM_ERR_NULL;
    }
    const double nan = gmi_nan();
    const gm_load none = {{nan, nan, nan}, {nan, nan, nan}};
    *on_pinion = *on_wheel = none;
    gmi_mesh_result_set_nan(result);
    if (mesh == NULL || pinion == NULL || wheel == NULL) {
        return GM_ERR_NULL;
    }

    gm_motion motion;
    mesh_frame frame;
    wheel_place place;
    int status = find_motion(mesh, pinion, wheel, &motion, &frame, &place);
    if (status == GM_OK) {
        status = gm_mesh_evaluate_posed(mesh, &motion, wanted | GM_WANT_WRENCH, workspace, result);
    }
    if (status != GM_OK) {
        return status;
    }

    /* From z = 0 of both axes, posed errors of the mesh included, to the reference points. */
    const gm_pair *pair = mesh->pair;
    const double middle = 0.5 * pair->pinion.face_width;
    const double to_pinion[3] = {0.0, 0.0, middle};
    const double to_wheel[3] = {-mesh->pose.center_distance_change, -mesh->pose.offset,
                                middle + place.along};
    set_load(&frame, result->wrench.pinion_force, result->wrench.pinion_moment, to_pinion,
             on_pinion);
    set_load(&frame, result->wrench.wheel_force, result->wrench.wheel_moment, to_wheel, on_wheel);
    return GM_OK;
}
