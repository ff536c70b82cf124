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

#include <math.h>

/* Of one side: derivatives of its coordinates and of the rates of three of them. */
typedef struct side_jacobian {
    double sign, tau;
    double e[2], t[2];
    double by[GMI_COORDINATES][GM_COORDINATES];
    double rate_by[3][GM_COORDINATES]; /* of delta, along, across by the rates of the seven */
} side_jacobian;

static void find_jacobian(const gm_mesh *mesh, int side, side_jacobian *jacobian) {
    const gm_pair *pair = mesh->pair;
    const gmi_engagement *at = &mesh->engagement;
    const side_jacobian none = {.sign = gmi_side_sign(side)};
    *jacobian = none;
    const double sign = jacobian->sign;
    const double tau = sign * pair->face_advance / pair->face_width;
    const gmi_plane plane = gmi_plane_of(at, sign);
    const double *e = plane.e, *t = plane.t;
    const double r_bp = pair->pinion.base_radius;
    const double length = at->line_of_action;
    jacobian->tau = tau;

    double(*by)[GM_COORDINATES] = jacobian->by;
    by[GMI_BY_ORIGIN][GM_PINION_ANGLE] = sign * r_bp;
    by[GMI_BY_DELTA][GM_PINION_ANGLE] = sign * r_bp;
    by[GMI_BY_DELTA][GM_WHEEL_ANGLE] = -sign * pair->wheel.base_radius;
    by[GMI_BY_DELTA][GM_AXIAL_SHIFT] = tau;
    by[GMI_BY_AXIAL][GM_AXIAL_SHIFT] = 1.0;
    for (int k = 0; k < 2; ++k) {
        const int moved = GM_CENTER_DISTANCE_CHANGE + k, tilted = GM_SKEW + k;
        jacobian->e[k] = e[k];
        jacobian->t[k] = t[k];
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

    for (int k = 0; k < GM_COORDINATES; ++k) {
        jacobian->rate_by[0][k] = by[GMI_BY_DELTA][k];
        jacobian->rate_by[1][k] = k < GM_SKEW ? 0.0 : by[GMI_BY_ALONG][k];
        jacobian->rate_by[2][k] = k < GM_SKEW ? 0.0 : by[GMI_BY_ACROSS][k];
    }
}

/* Derivatives of a side's force and of its moments: by the seven and by their rates. */
typedef struct side_gradient {
    double by[GM_COORDINATES][GMI_WEIGHTS];
    double by_rate[GM_COORDINATES][GMI_WEIGHTS];
} side_gradient;

static void find_gradient(const gmi_law *law, const gmi_engagement *at,
                          const side_jacobian *jacobian, const gm_pose *pose_rate,
                          const gmi_side_tangent *side, side_gradient *gradient) {
    /* By the rates of delta, along and across. */
    const double of_along = -jacobian->tau * at->wheel_base_radius;
    double by_rate[3][GMI_WEIGHTS];
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        by_rate[0][weight] = law->damping * side->contact[weight];
        by_rate[1][weight] = law->damping * of_along * side->contact[weight];
        by_rate[2][weight] = -law->damping * side->arm[weight];
    }

    /* A turn of e by 1 / T changes these rates, those of the pose being what they are. */
    const double moving =
        jacobian->t[0] * pose_rate->center_distance_change + jacobian->t[1] * pose_rate->offset;
    const double turned[3] = {-moving, side->rates.across, -side->rates.along};
    for (int k = 0; k < GM_COORDINATES; ++k) {
        const int axis = k - GM_CENTER_DISTANCE_CHANGE;
        const double turn = axis == 0 || axis == 1 ? jacobian->t[axis] / at->line_of_action : 0.0;
        for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
            double by = 0.0, rate = 0.0;
            for (int of = 0; of < GMI_COORDINATES; ++of) {
                by += jacobian->by[of][k] * (law->stiffness * side->sum_by[of][weight] +
                                             law->damping * side->flow_by[of][weight]);
            }
            for (int of = 0; of < 3; ++of) {
                by += turn * turned[of] * by_rate[of][weight];
                rate += jacobian->rate_by[of][k] * by_rate[of][weight];
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

/* Adds one side to the derivatives of the wrench, all but that of the turn, in the frame of the posed axes. */
static void add_wrenches(const gm_pair *pair, const gmi_engagement *at, int side,
                         const side_gradient *gradient, const gmi_side_force *force,
                         gm_tangent *tangent) {
    /* The x axis of the posed axes; alpha_wt and the distance change along it. */
    const double *x = at->axis;
    const double angle_by = at->cos_pressure_angle / (at->sin_pressure_angle * at->center_distance);
    for (int k = 0; k < GM_COORDINATES; ++k) {
        const gmi_side_force by = force_of(gradient->by[k]);
        const gmi_side_force by_rate = force_of(gradient->by_rate[k]);
        gmi_wrench_add_side(pair, at, &by, side, &tangent->wrench_by[k]);
        gmi_wrench_add_side(pair, at, &by_rate, side, &tangent->wrench_by_rate[k]);
        const int axis = k - GM_CENTER_DISTANCE_CHANGE;
        if (axis == 0 || axis == 1) {
            gmi_wrench_add_by_direction(pair, at, force, side, angle_by * x[axis], x[axis],
                                        &tangent->wrench_by[k]);
        }
    }
}

static void set_tangent(gm_tangent *tangent, double value) {
    for (int k = 0; k < GM_COORDINATES; ++k) {
        tangent->force_by[k] = tangent->force_by_rate[k] = value;
        gmi_wrench_set(&tangent->wrench_by[k], value);
        gmi_wrench_set(&tangent->wrench_by_rate[k], value);
    }
}

/* Adds a side of which sums and force are known. */
static OWN_STACK void add_pressed(const gm_mesh *moved, const gm_pose *pose_rate, int side,
                                  const gmi_side_tangent *sums, const gmi_side_force *force,
                                  gm_tangent *tangent) {
    const gm_pair *pair = moved->pair;
    const gmi_engagement *at = &moved->engagement;
    side_jacobian jacobian;
    side_gradient gradient;
    find_jacobian(moved, side, &jacobian);
    find_gradient(&moved->law, at, &jacobian, pose_rate, sums, &gradient);
    for (int k = 0; k < GM_COORDINATES; ++k) {
        tangent->force_by[k] += jacobian.sign * gradient.by[k][GMI_WHOLE];
        tangent->force_by_rate[k] += jacobian.sign * gradient.by_rate[k][GMI_WHOLE];
    }
    add_wrenches(pair, at, side, &gradient, force, tangent);
}

/* Adds a side, if it presses. */
static void add_side(const gm_mesh *moved, const gm_position *position, const gm_pose *pose_rate,
                     const gmi_rates *rates, int side, gm_tangent *tangent, gm_wrench *wrench) {
    gmi_side_tangent sums;
    gmi_side_sum sum;
    gmi_side_force force;
    sums.rates = *rates;
    gmi_side_sum_tangent(moved, side, position, &sum, &sums);
    gmi_law_force_of_flow(&moved->law, &sum, &sums, &force);
    if (force.force > 0.0) {
        add_pressed(moved, pose_rate, side, &sums, &force, tangent);
        gmi_wrench_add_side(moved->pair, &moved->engagement, &force, side, wrench);
    }
}

int gm_mesh_tangent(const gm_mesh *mesh, const gm_motion *motion, gm_tangent *tangent) {
    if (tangent == NULL) {
        return GM_ERR_NULL;
    }
    set_tangent(tangent, gmi_nan());
    if (mesh == NULL || motion == NULL) {
        return GM_ERR_NULL;
    }
    if (mesh->elastic != NULL || mesh->friction.is_on || mesh->has_corners) {
        return GM_ERR_PARAMETER;
    }

    gm_mesh moved;
    gm_position position;
    gmi_rates rates[2];
    const int status = gmi_mesh_follow(mesh, motion, &moved, &position, rates);
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
