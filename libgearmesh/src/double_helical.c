/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Double-helical pairs. The second half is the first one seen in a mirror across the axis, half-way along the face: angles
 * about the axis stay what they are, z and the tilts change sign. So both halves are meshes of one and the same pair, and
 * where the pinion floats along its axis, by s, their lines of contact move as if they turned against each other: the
 * first meshes at x - s tan(beta_b), the second at x + s tan(beta_b). The pinion floats to where both carry the same force.
 */
#include "double_helical.h"
#include "internal.h"
#include "mesh.h"

#include <math.h>

#define STEPS       100   /* at most; Newton's method needs some four */
#define RESOLUTION  1e-12 /* of the shift between the halves, in base pitches */
#define FIRST_STEP  1e-3  /* where there is no slope, in base pitches; then doubled */
#define CORRECTIONS 30    /* of the load by friction, which takes or adds some per cent */

/* ---------------------------------------------------------------------------------------------
 * One half of a drawing
 * ------------------------------------------------------------------------------------------- */

int gm_double_helical_half(const gm_pair_params *whole, double gap, gm_pair_params *half) {
    if (half == NULL) {
        return GM_ERR_NULL;
    }
    gm_pair_params_default(half);
    if (whole == NULL) {
        return GM_ERR_NULL;
    }
    if (!(gap >= 0.0 && gmi_is_finite(gap))) {
        return GM_ERR_PARAMETER;
    }

    /* Both gears have the gap; what is left of the narrower one is to be more than nothing. */
    const double pinion =
        isnan(whole->pinion_face_width) ? whole->face_width : whole->pinion_face_width;
    const double wheel =
        isnan(whole->wheel_face_width) ? whole->face_width : whole->wheel_face_width;
    if (!(fmin(pinion, wheel) > gap) || whole->helix_angle == 0.0 || whole->axial_offset != 0.0) {
        return GM_ERR_GEOMETRY;
    }

    /* The halves of both gears end together at the gap. */
    *half = *whole;
    half->face_width = gmi_nan();
    half->pinion_face_width = 0.5 * (pinion - gap);
    half->wheel_face_width = 0.5 * (wheel - gap);
    half->axial_offset = 0.25 * (pinion - wheel);
    return GM_OK;
}

int gm_double_helical_pose(const gm_pair *half, double gap, const gm_pose *whole, gm_pose pose[2]) {
    if (half == NULL || whole == NULL || pose == NULL) {
        return GM_ERR_NULL;
    }
    for (int k = 0; k < 2; ++k) {
        pose[k] = gmi_pose_of_half(half, gap, whole, k);
    }
    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * A wheel that moves
 * ------------------------------------------------------------------------------------------- */

/* Both halves of gears that stand, or move, somewhere. */
typedef struct halves {
    const gm_position *position;
    const gm_motion *motion; /* of the wheel; NULL: it stands in the pose as prepared */
    gm_pose whole;           /* the pose that the wheel is in by then */
} halves;

/* The pose in which the whole was prepared, from those of its halves; without the axial shift, which the pinion follows. */
static gm_pose pose_of_whole(const gm_pose *first, const gm_pose *second) {
    const gm_pose whole = {
        .center_distance_change =
            0.5 * (first->center_distance_change + second->center_distance_change),
        .offset = 0.5 * (first->offset + second->offset),
        .skew = first->skew,
        .inclination = first->inclination,
    };
    return whole;
}

static gm_pose sum_of_poses(const gm_pose *a, double factor, const gm_pose *b) {
    const gm_pose sum = {
        .center_distance_change = a->center_distance_change + factor * b->center_distance_change,
        .offset = a->offset + factor * b->offset,
        .axial_shift = a->axial_shift + factor * b->axial_shift,
        .skew = a->skew + factor * b->skew,
        .inclination = a->inclination + factor * b->inclination,
    };
    return sum;
}

/*
 * The rate of gm_double_helical_pose() for half k, in first order as damping feels a changing tilt: that the arm changes, and
 * comes nearer, are products of tilt and rate.
 */
static gm_pose rate_of_half(const gm_double_helical *gears, int k, const gm_pose *rate) {
    const double arm = 0.5 * (gears->half[k]->pair->wheel.face_width + gears->gap);
    const double sign = k == 0 ? 1.0 : -1.0;
    const gm_pose by_half = {
        .center_distance_change = rate->center_distance_change - arm * sign * rate->inclination,
        .offset = rate->offset + arm * sign * rate->skew,
        .skew = sign * rate->skew,
        .inclination = sign * rate->inclination,
    };
    return by_half;
}

/* Where the gears are. A wheel without motion stands, to the bit. */
static void place(const gm_double_helical *gears, const gm_position *position,
                  const gm_motion *motion, halves *both) {
    const int stands =
        motion == NULL || (gmi_is_at_rest(&motion->pose) && gmi_is_at_rest(&motion->pose_rate));
    both->position = position;
    both->motion = stands ? NULL : motion;
    both->whole = pose_of_whole(&gears->half[0]->pose, &gears->half[1]->pose);
    if (!stands) {
        both->whole = sum_of_poses(&both->whole, 1.0, &motion->pose);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Both halves together
 * ------------------------------------------------------------------------------------------- */

static int check(const gm_double_helical *gears) {
    if (gears == NULL || gears->half[0] == NULL || gears->half[1] == NULL) {
        return GM_ERR_NULL;
    }
    const gm_pair *first = gears->half[0]->pair, *second = gears->half[1]->pair;
    const int is_same = first->pinion.teeth == second->pinion.teeth &&
                        first->wheel.teeth == second->wheel.teeth &&
                        first->wheel.sign == second->wheel.sign &&
                        first->transverse_base_pitch == second->transverse_base_pitch &&
                        first->base_helix_angle == second->base_helix_angle &&
                        first->face_width == second->face_width;

    return is_same && first->face_advance != 0.0 && gears->gap >= 0.0 ? GM_OK : GM_ERR_GEOMETRY;
}

static double tan_base_helix(const gm_pair *pair) {
    return pair->face_advance / pair->face_width;
}

static int evaluate_standing(const gm_double_helical *gears, int k, const gm_position *position,
                             double shift, int wanted, gm_mesh_result *result) {
    gm_position at = *position;
    at.offset += k == 0 ? shift : -shift;
    return gm_mesh_evaluate_at(gears->half[k], &at, wanted, gears->workspace[k], result);
}

/* The motion of a half is the difference of its poses. */
static int evaluate_half(const gm_double_helical *gears, int k, const halves *both, double shift,
                         int wanted, gm_mesh_result *result) {
    const gm_mesh *half = gears->half[k];
    if (both->motion == NULL) {
        return evaluate_standing(gears, k, both->position, shift, wanted, result);
    }
    gm_motion motion = {.position = *both->position};
    motion.position.offset += k == 0 ? shift : -shift;
    motion.pose = gmi_pose_of_half(half->pair, gears->gap, &both->whole, k);
    motion.pose = sum_of_poses(&motion.pose, -1.0, &half->pose);
    motion.pose_rate = rate_of_half(gears, k, &both->motion->pose_rate);
    return gm_mesh_evaluate_posed(half, &motion, wanted, gears->workspace[k], result);
}

/*
 * The shift at which both halves carry the same force: their difference grows with it. Newton's method, within what is
 * known to enclose it. Where neither touches, any shift will do.
 */
static int balance(const gm_double_helical *gears, const halves *both, int wanted, double *shift,
                   gm_mesh_result each[2]) {
    const gm_pair *pair = gears->half[0]->pair;
    const double pitch = pair->transverse_base_pitch;
    const double limit = 0.5 * pitch * (1.0 - 1e-9) - fabs(both->position->offset);
    double lower = -limit, upper = limit, reach = FIRST_STEP * pitch, step = pitch;
    if (!(fabs(*shift) < limit)) {
        *shift = 0.0;
    }

    for (int k = 0; k < STEPS; ++k) {
        for (int half = 0; half < 2; ++half) {
            const int status =
                evaluate_half(gears, half, both, *shift, wanted | GM_WANT_DERIVATIVES, &each[half]);
            if (status != GM_OK) {
                return status;
            }
        }

        /* The last step was so small that the next one would be a rounding. */
        const double difference = each[0].force - each[1].force;
        if (difference == 0.0 || fabs(step) <= RESOLUTION * pitch) {
            return GM_OK;
        }
        *(difference > 0.0 ? &upper : &lower) = *shift;

        /* Damping that would pull leaves no slope. */
        const double slope = gmi_slope_of_halves(pair, each);
        if (slope > 0.0) {
            step = -difference / slope;
        } else {
            step = difference > 0.0 ? -reach : reach;
            reach *= 2.0;
        }
        if (!(*shift + step > lower && *shift + step < upper)) {
            step = 0.5 * (lower + upper) - *shift;
        }
        *shift += step;
    }
    return GM_NO_EQUILIBRIUM;
}

static void set_nan(gm_mesh_result each[2], gm_mesh_result *result) {
    gmi_mesh_result_set_nan(&each[0]);
    gmi_mesh_result_set_nan(&each[1]);
    gmi_mesh_result_set_nan(result);
}

static int evaluate(const gm_double_helical *gears, const gm_position *position,
                    const gm_motion *motion, int wanted, double *apex, gm_mesh_result each[2],
                    gm_mesh_result *result) {
    if (each == NULL || result == NULL) {
        return GM_ERR_NULL;
    }
    halves both;
    int status = apex == NULL || position == NULL ? GM_ERR_NULL : check(gears);
    if (status == GM_OK) {
        place(gears, position, motion, &both);
        const double helix = tan_base_helix(gears->half[0]->pair);
        double shift = -*apex * helix;
        status = balance(gears, &both, wanted, &shift, each);
        *apex = status == GM_OK ? -shift / helix : *apex;
    }

    if (status != GM_OK) {
        set_nan(each, result);
    } else {
        gmi_double_helical_add(gears, &both.whole, each, wanted, result);
    }
    return status;
}

int gm_double_helical_evaluate_at(const gm_double_helical *gears, const gm_position *position,
                                  int wanted, double *apex, gm_mesh_result each[2],
                                  gm_mesh_result *result) {
    return evaluate(gears, position, NULL, wanted, apex, each, result);
}

int gm_double_helical_evaluate_posed(const gm_double_helical *gears, const gm_motion *motion,
                                     int wanted, double *apex, gm_mesh_result each[2],
                                     gm_mesh_result *result) {
    return evaluate(gears, motion != NULL ? &motion->position : NULL, motion, wanted, apex, each,
                    result);
}

/* ---------------------------------------------------------------------------------------------
 * Equilibrium
 * ------------------------------------------------------------------------------------------- */

/* Without friction each half is in equilibrium under half of the torque, by itself: x of both. */
static int find_halves(const gm_double_helical *gears, double pinion_angle, double half_torque,
                       double offset[2]) {
    int status = GM_OK;
    for (int k = 0; k < 2 && status == GM_OK; ++k) {
        status = gm_static_equilibrium(gears->half[k], pinion_angle, half_torque, offset[k],
                                       gears->workspace[k], &offset[k], NULL);
    }
    return status;
}

/* Friction takes from both torques a share that hardly depends on the load: corrected until they carry it. */
static int find(const gm_double_helical *gears, double pinion_angle, double pinion_speed,
                double wheel_torque, double offset[2], gm_mesh_result each[2],
                gm_mesh_result *result) {
    double half_torque = 0.5 * wheel_torque;
    for (int k = 0; k < CORRECTIONS; ++k) {
        gm_position position;
        int status = find_halves(gears, pinion_angle, half_torque, offset);
        if (status != GM_OK) {
            return status;
        }

        /* What both come to there, while they roll. */
        const double shift = 0.5 * (offset[0] - offset[1]);
        status = gm_position_from_pinion_angle(gears->half[0]->pair, pinion_angle,
                                               0.5 * (offset[0] + offset[1]), 0.0, &position);
        position.pinion_speed = pinion_speed;
        for (int half = 0; half < 2 && status == GM_OK; ++half) {
            status =
                evaluate_standing(gears, half, &position, shift, GM_WANT_DERIVATIVES, &each[half]);
        }
        if (status != GM_OK) {
            return status;
        }
        gmi_double_helical_add(gears, NULL, each, GM_WANT_DERIVATIVES,
                               result); /* without the wrench */
        const double missing = wheel_torque / result->wheel_torque;
        if (!gears->half[0]->friction.is_on || !(fabs(missing - 1.0) > 1e-13) || !(missing > 0.0)) {
            return GM_OK;
        }
        half_torque *= missing;
    }
    return GM_OK;
}

int gm_double_helical_equilibrium(const gm_double_helical *gears, double pinion_angle,
                                  double pinion_speed, double wheel_torque, double guess,
                                  double *offset, double *apex, gm_mesh_result each[2],
                                  gm_mesh_result *result) {
    if (offset == NULL || apex == NULL || each == NULL || result == NULL) {
        return GM_ERR_NULL;
    }
    *offset = gmi_nan();
    int status = check(gears);

    /* Each half carries half the torque; between them they say where pinion and apex are. */
    if (status == GM_OK) {
        const double helix = tan_base_helix(gears->half[0]->pair);
        double offsets[2] = {guess - *apex * helix, guess + *apex * helix};
        status = find(gears, pinion_angle, pinion_speed, wheel_torque, offsets, each, result);
        if (status == GM_OK) {
            *offset = 0.5 * (offsets[0] + offsets[1]);
            *apex = -0.5 * (offsets[0] - offsets[1]) / helix;
        }
    }
    if (status != GM_OK) {
        set_nan(each, result);
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * Line loads
 * ------------------------------------------------------------------------------------------- */

int gm_double_helical_line_loads(const gm_double_helical *gears, const gm_position *position,
                                 double apex, gm_line_load_point *points, int capacity,
                                 gm_line_loads *load) {
    if (load == NULL) {
        return GM_ERR_NULL;
    }
    const gm_line_loads none = {gmi_nan(), gmi_nan(), gmi_nan(), gmi_nan(), 0, 0};
    *load = none;
    int status = position == NULL ? GM_ERR_NULL : check(gears);
    if (status != GM_OK) {
        return status;
    }
    const gm_pair *pair = gears->half[0]->pair;
    const double shift = -apex * tan_base_helix(pair);
    const double width = 2.0 * pair->pinion.face_width + gears->gap;

    /* One after the other, the second back from its mirror. */
    gm_line_loads both = {0.0, 0.0, 0.0, 0.0, 0, 0};
    double per_mean = 0.0; /* of the mean line loads, which both carry the same force */
    for (int k = 0; k < 2; ++k) {
        gm_position at = *position;
        at.offset += k == 0 ? shift : -shift;
        gm_line_load_point *of_half = points != NULL ? points + both.points : NULL;
        gm_line_loads half;
        status = gm_mesh_line_loads(gears->half[k], &at, gears->workspace[k], of_half,
                                    capacity - both.points, &half);
        if (status != GM_OK) {
            return status;
        }
        for (int i = 0; k == 1 && of_half != NULL && i < half.points; ++i) {
            of_half[i].z = width - of_half[i].z;
        }
        both.points += half.points;
        both.touching_width += half.touching_width;
        both.warnings |= half.warnings;
        if (half.largest_line_load > 0.0) {
            both.largest_line_load = fmax(both.largest_line_load, half.largest_line_load);
            both.largest_pressure = fmax(both.largest_pressure, half.largest_pressure);
            per_mean += 0.5 * half.face_load_factor / half.largest_line_load;
        }
    }

    if (both.largest_line_load > 0.0) {
        *load = both;
        load->face_load_factor = both.largest_line_load * per_mean;
    }
    load->touching_width = both.touching_width;
    load->points = both.points;
    return GM_OK;
}
