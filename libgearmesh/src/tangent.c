/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The exact tangent: derivatives of force and wrench by the seven coordinates and their rates.
 *
 * penetration.c knows how the sums of a side move with the side's own coordinates, law.c what force that is. Here these
 * coordinates follow from the seven. With e the line of action and t across it, turned as the axes are, a movement dO of
 * the wheel's axis changes
 *
 *     delta by -dO.e,   T by dO.e + dO.t (r_bp + r_bw) / T,   the origin by dO.t r_bp / T,
 *     and turns e by dO.t / T, so that the tilt along it grows by its part across times that, and the one across falls.
 */
#include "internal.h"
#include "penetration.h"

#include <math.h>
#include <string.h>

/* Of one side: derivatives of all that its force depends on, by the seven and by their rates. */
typedef struct side_jacobian {
    double by[GMI_VARIABLES][GM_COORDINATES];
    double speed_by_rate[GMI_VARIABLES - GMI_COORDINATES][GM_COORDINATES]; /* of what are speeds */
} side_jacobian;

/* The row of a speed there. */
#define SPEED(name) (GMI_BY_##name - GMI_COORDINATES)

/* The coordinates of the side. */
static void add_coordinates(const gm_mesh *mesh, int side, const gmi_plane *plane, double tau,
                            double by[GMI_VARIABLES][GM_COORDINATES]) {
    const gm_pair *pair = mesh->pair;
    const gmi_engagement *at = &mesh->engagement;
    const double sign = gmi_side_sign(side);
    const double *e = plane->e, *t = plane->t;
    const double r_bp = pair->pinion.base_radius;
    const double length = at->line_of_action;
    by[GMI_BY_ORIGIN][GM_PINION_ANGLE] = sign * r_bp;
    by[GMI_BY_DELTA][GM_PINION_ANGLE] = sign * r_bp;
    by[GMI_BY_DELTA][GM_WHEEL_ANGLE] = -sign * pair->wheel.base_radius;
    by[GMI_BY_DELTA][GM_AXIAL_SHIFT] = tau;
    by[GMI_BY_AXIAL][GM_AXIAL_SHIFT] = 1.0;
    for (int k = 0; k < 2; ++k) {
        const int moved = GM_CENTER_DISTANCE_CHANGE + k, tilted = GM_SKEW + k;
        by[GMI_BY_ORIGIN][moved] = r_bp / length * t[k];
        by[GMI_BY_DELTA][moved] = -e[k];
        by[GMI_BY_LENGTH][moved] = e[k] + (r_bp + at->wheel_base_radius) / length * t[k];
        by[GMI_BY_ALONG][moved] = at->across[side] / length * t[k];
        by[GMI_BY_ACROSS][moved] = -at->along[side] / length * t[k];
        if (mesh->model != GM_MODEL_SIMPLE) { /* which knows no tilts */
            by[GMI_BY_ALONG][tilted] = -sign * e[k];
            by[GMI_BY_ACROSS][tilted] = -sign * t[k];
        }
    }
}

/* Speeds: e turns by 1 / T as the axis moves across it, and with it what the rates of the pose are along it and across. */
static void add_speeds(const gm_mesh *mesh, int side, const gmi_rates *rates,
                       const gm_pose *pose_rate, const gmi_plane *plane, side_jacobian *jacobian) {
    const gm_pair *pair = mesh->pair;
    const gmi_engagement *at = &mesh->engagement;
    const double sign = gmi_side_sign(side);
    const double *t = plane->t;
    const double moving = t[0] * pose_rate->center_distance_change + t[1] * pose_rate->offset;
    double(*by)[GM_COORDINATES] = jacobian->by;
    double(*by_rate)[GM_COORDINATES] = jacobian->speed_by_rate;
    for (int k = 0; k < 2; ++k) {
        const int moved = GM_CENTER_DISTANCE_CHANGE + k;
        const double turn = t[k] / at->line_of_action;
        by[GMI_BY_DELTA_RATE][moved] = -turn * moving;
        by[GMI_BY_ALONG_RATE][moved] = turn * rates->across;
        by[GMI_BY_ACROSS_RATE][moved] = -turn * rates->along;
        by[GMI_BY_SIDEWAYS][moved] = turn * rates->forward[0];
        by[GMI_BY_SIDEWAYS_T1][moved] = turn * rates->forward[1];
        by_rate[SPEED(SIDEWAYS)][moved] = -sign * t[k];
    }
    by[GMI_BY_SIDEWAYS][GM_AXIAL_SHIFT] = -rates->sideways[1] / pair->face_width;

    /* The rates move as their coordinates do; tilts turn what is away from the middle of the wheel's face sideways too. */
    for (int k = 0; k < GM_COORDINATES; ++k) {
        by_rate[SPEED(DELTA_RATE)][k] = by[GMI_BY_DELTA][k];
        by_rate[SPEED(ALONG_RATE)][k] = k < GM_SKEW ? 0.0 : by[GMI_BY_ALONG][k];
        by_rate[SPEED(ACROSS_RATE)][k] = k < GM_SKEW ? 0.0 : by[GMI_BY_ACROSS][k];
    }
    const double turning[2] = {sign * t[1], -sign * t[0]};
    for (int k = 0; k < 2; ++k) {
        by_rate[SPEED(SIDEWAYS)][GM_SKEW + k] = turning[k] * (pair->face_start - at->face_center);
        by_rate[SPEED(SIDEWAYS_T1)][GM_SKEW + k] = turning[k] * pair->face_width;
    }
    by_rate[SPEED(PINION_SPEED)][GM_PINION_ANGLE] = 1.0;
    by_rate[SPEED(WHEEL_SPEED)][GM_WHEEL_ANGLE] = pair->wheel.sign;
}

static OWN_STACK void find_jacobian(const gm_mesh *mesh, int side, const gmi_rates *rates,
                                    const gm_pose *pose_rate, side_jacobian *jacobian) {
    const double sign = gmi_side_sign(side);
    const double tau = sign * mesh->pair->face_advance / mesh->pair->face_width;
    const gmi_plane plane = gmi_plane_of(&mesh->engagement, sign);
    memset(jacobian, 0, sizeof *jacobian);
    add_coordinates(mesh, side, &plane, tau, jacobian->by);
    add_speeds(mesh, side, rates, pose_rate, &plane, jacobian);
}

/* Derivatives of a force and of its moments: by the seven and by their rates. */
typedef struct side_gradient {
    double by[GM_COORDINATES][GMI_WEIGHTS];
    double by_rate[GM_COORDINATES][GMI_WEIGHTS];
} side_gradient;

/* count: of the variables that the force depends on. */
static OWN_STACK void find_gradient(const side_jacobian *jacobian, int count,
                                    const double force_by[][GMI_WEIGHTS], side_gradient *gradient) {
    for (int k = 0; k < GM_COORDINATES; ++k) {
        for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
            double by = 0.0, rate = 0.0;
            for (int of = 0; of < count; ++of) {
                by += jacobian->by[of][k] * force_by[of][weight];
            }
            for (int of = GMI_COORDINATES; of < count; ++of) {
                rate += jacobian->speed_by_rate[of - GMI_COORDINATES][k] * force_by[of][weight];
            }
            gradient->by[k][weight] = by;
            gradient->by_rate[k][weight] = rate;
        }
    }
}

static gmi_side_force force_of(const double weighted[GMI_WEIGHTS]) {
    const gmi_side_force force = {.force = weighted[GMI_WHOLE],
                                  .force_t1 = weighted[GMI_BY_T1],
                                  .force_rho = weighted[GMI_BY_RHO]};
    return force;
}

/* alpha_wt by the distance of the axes. */
static double angle_by_distance(const gmi_engagement *at) {
    return at->cos_pressure_angle / (at->sin_pressure_angle * at->center_distance);
}

/* Adds one side to the derivatives of the wrench, all but that of the turn, in the frame of the posed axes. */
static void add_wrenches(const gm_pair *pair, const gmi_engagement *at, int side,
                         const side_gradient *gradient, const gmi_side_force *force,
                         gm_tangent *tangent) {
    for (int k = 0; k < GM_COORDINATES; ++k) {
        const gmi_side_force by = force_of(gradient->by[k]);
        const gmi_side_force by_rate = force_of(gradient->by_rate[k]);
        gmi_wrench_add_side(pair, at, &by, side, &tangent->wrench_by[k]);
        gmi_wrench_add_side(pair, at, &by_rate, side, &tangent->wrench_by_rate[k]);
        const int axis = k - GM_CENTER_DISTANCE_CHANGE;
        if (axis == 0 ||
            axis == 1) { /* the distance of the axes changes along the x axis of the posed ones */
            const double by_distance = at->axis[axis];
            gmi_wrench_add_by_direction(pair, at, force, side, angle_by_distance(at) * by_distance,
                                        by_distance, &tangent->wrench_by[k]);
        }
    }
}

/* And its friction. */
static OWN_STACK void add_rubbing(const gm_pair *pair, const gmi_engagement *at, int side,
                                  const side_jacobian *jacobian, const gmi_rubbing *rubbing,
                                  const gmi_rubbing_by *rubbing_by, gm_tangent *tangent) {
    static const double none[GMI_WEIGHTS] = {0.0, 0.0, 0.0};
    side_gradient gradient;
    find_gradient(jacobian, GMI_VARIABLES, rubbing_by->force, &gradient);
    for (int k = 0; k < GM_COORDINATES; ++k) {
        const int axis = k - GM_CENTER_DISTANCE_CHANGE;
        const double by_distance = axis == 0 || axis == 1 ? at->axis[axis] : 0.0;
        gmi_wrench_add_friction_by(pair, at, gradient.by[k], rubbing->force, side,
                                   angle_by_distance(at) * by_distance,
                                   jacobian->by[GMI_BY_LENGTH][k], &tangent->wrench_by[k]);
        gmi_wrench_add_friction_by(pair, at, gradient.by_rate[k], none, side, 0.0, 0.0,
                                   &tangent->wrench_by_rate[k]);
    }
}

static void set_tangent(gm_tangent *tangent, double value) {
    for (int k = 0; k < GM_COORDINATES; ++k) {
        tangent->force_by[k] = tangent->force_by_rate[k] = value;
        gmi_wrench_set(&tangent->wrench_by[k], value);
        gmi_wrench_set(&tangent->wrench_by_rate[k], value);
    }
}

/* All that is known of a side: its sums, force and friction, and how they move. */
typedef struct followed_side {
    gmi_side_tangent tangent;
    gmi_side_force force;
    gmi_rubbing rubbing;
    gmi_rubbing_by rubbing_by;
} followed_side;

/* Adds a side that presses. */
static OWN_STACK void add_pressed(const gm_mesh *moved, const gm_pose *pose_rate, int side,
                                  const followed_side *followed, gm_tangent *tangent) {
    const gm_pair *pair = moved->pair;
    const gmi_engagement *at = &moved->engagement;
    const double sign = gmi_side_sign(side);
    side_jacobian jacobian;
    side_gradient gradient;
    find_jacobian(moved, side, &followed->tangent.rates, pose_rate, &jacobian);
    find_gradient(&jacobian, GMI_LOAD_VARIABLES, followed->tangent.by.force, &gradient);
    for (int k = 0; k < GM_COORDINATES; ++k) {
        tangent->force_by[k] += sign * gradient.by[k][GMI_WHOLE];
        tangent->force_by_rate[k] += sign * gradient.by_rate[k][GMI_WHOLE];
    }
    add_wrenches(pair, at, side, &gradient, &followed->force, tangent);
    if (moved->friction.is_on) {
        add_rubbing(pair, at, side, &jacobian, &followed->rubbing, &followed->rubbing_by, tangent);
    }
}

/* Follows the lines of a side. */
static OWN_STACK void follow(const gm_mesh *moved, const gm_position *position,
                             const gmi_rates *rates, int side, followed_side *followed) {
    gmi_sliding sliding;
    gmi_side_sum sum;
    followed->tangent.rates = *rates;
    if (moved->friction.is_on) {
        gmi_sliding_find(&moved->friction, moved->pair, &moved->engagement, position, rates,
                         &sliding);
    }
    gmi_side_sum_tangent(moved, side, position, moved->friction.is_on ? &sliding : NULL, &sum,
                         &followed->tangent, &followed->rubbing, &followed->rubbing_by);
    gmi_law_force_of_tangent(&followed->tangent, &followed->force);
}

/* Adds a side, if it presses. */
static OWN_STACK void add_side(const gm_mesh *moved, const gm_position *position,
                               const gm_pose *pose_rate, const gmi_rates *rates, int side,
                               gm_tangent *tangent, gm_wrench *wrench) {
    const gm_pair *pair = moved->pair;
    const gmi_engagement *at = &moved->engagement;
    if (gmi_side_is_clear(at, &moved->side[side], side, position->offset)) {
        return;
    }
    followed_side followed;
    follow(moved, position, rates, side, &followed);
    if (followed.force.force > 0.0) {
        add_pressed(moved, pose_rate, side, &followed, tangent);
        gmi_wrench_add_side(pair, at, &followed.force, side, wrench);
        if (moved->friction.is_on) {
            gmi_friction_sum friction;
            gmi_friction_sum_of(pair, side, &followed.rubbing, NULL, &friction);
            gmi_wrench_add_friction(pair, at, &friction, side, wrench);
        }
    }
}

static int find_tangent(const gm_mesh *mesh, const gm_motion *motion, gm_tangent *tangent) {
    if (mesh == NULL || motion == NULL) {
        return GM_ERR_NULL;
    }
    if (mesh->elastic != NULL || mesh->has_corners) {
        return GM_ERR_PARAMETER;
    }

    gm_mesh moved;
    gm_position position;
    gmi_rates rates[2];
    int status = gmi_mesh_follow(mesh, motion, &moved, &position, rates);
    if (status == GM_OK && moved.friction.is_on) {
        status = gmi_check_speed(position.pinion_speed);
    }
    if (status != GM_OK) {
        return status;
    }

    gm_wrench wrench;
    gmi_wrench_set(&wrench, 0.0);
    set_tangent(tangent, 0.0);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        add_side(&moved, &position, &motion->pose_rate, &rates[side], side, tangent, &wrench);
    }

    /* From the frame of the posed axes to that of the drawing, with the direction of the axes by y. */
    const double *axis = moved.engagement.axis;
    const double by_y = 1.0 / moved.engagement.center_distance;
    gmi_wrench_add_by_turn(&wrench, -axis[1] * by_y,
                           &tangent->wrench_by[GM_CENTER_DISTANCE_CHANGE]);
    gmi_wrench_add_by_turn(&wrench, axis[0] * by_y, &tangent->wrench_by[GM_OFFSET]);
    for (int k = 0; k < GM_COORDINATES; ++k) {
        gmi_wrench_turn(&tangent->wrench_by[k], axis);
        gmi_wrench_turn(&tangent->wrench_by_rate[k], axis);
    }
    return GM_OK;
}

int gm_mesh_tangent(const gm_mesh *mesh, const gm_motion *motion, gm_tangent *tangent) {
    const int status = tangent == NULL ? GM_ERR_NULL : find_tangent(mesh, motion, tangent);
    if (status != GM_OK && tangent != NULL) {
        set_tangent(tangent, gmi_nan());
    }
    return status;
}
