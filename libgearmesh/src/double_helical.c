/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Double-helical pairs. The second half is the first one seen in a mirror across the axis, half-way along the face: angles
 * about the axis stay what they are, z and the tilts change sign. So both halves are meshes of one and the same pair, and
 * where the pinion floats along its axis, by s, their lines of contact move as if they turned against each other: the
 * first meshes at x - s tan(beta_b), the second at x + s tan(beta_b). The pinion floats to where both carry the same force.
 */
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

/*
 * The middle of the wheel's half lies at -h on the axis of the whole wheel. Turned by the rotation vector theta about the
 * middle of the whole, it moves by theta x (0, 0, -h) sin(theta)/theta and comes nearer by h (1 - cos(theta)).
 */
int gm_double_helical_pose(const gm_pair *half, double gap, const gm_pose *whole, gm_pose pose[2]) {
    if (half == NULL || whole == NULL || pose == NULL) {
        return GM_ERR_NULL;
    }
    const double h = 0.5 * (half->wheel.face_width + gap);
    const double turn = hypot(whole->skew, whole->inclination);
    const double arm = turn > 0.0 ? h * sin(turn) / turn : h;
    const double nearer = 2.0 * h * sin(0.5 * turn) * sin(0.5 * turn);

    for (int k = 0; k < 2; ++k) {
        const double sign = k == 0 ? 1.0 : -1.0;
        pose[k].skew = sign * whole->skew;
        pose[k].inclination = sign * whole->inclination;
        pose[k].center_distance_change = whole->center_distance_change - arm * pose[k].inclination;
        pose[k].offset = whole->offset + arm * pose[k].skew;
        pose[k].axial_shift = nearer; /* the pinion floats to where the wheel is */
    }
    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * A wheel that moves
 * ------------------------------------------------------------------------------------------- */

/* Both halves at one position: the angles of the whole gears, and what each half does beside its pose. */
typedef struct halves {
    gm_position position;
    gm_motion motion[2]; /* position: with the shift */
    gm_pose place[2];    /* the pose that each half is in by then */
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
 * The rate of gm_double_helical_pose() in first order, as damping feels a changing tilt: that the arm changes, and comes nearer,
 * are products of tilt and rate.
 */
static void rate_of_halves(const gm_pair *half, double gap, const gm_pose *whole,
                           const gm_pose *rate, gm_pose by_half[2]) {
    const double h = 0.5 * (half->wheel.face_width + gap);
    const double turn = hypot(whole->skew, whole->inclination);
    const double arm = turn > 0.0 ? h * sin(turn) / turn : h;

    for (int k = 0; k < 2; ++k) {
        const double sign = k == 0 ? 1.0 : -1.0;
        gm_pose *to = &by_half[k];
        to->skew = sign * rate->skew;
        to->inclination = sign * rate->inclination;
        to->center_distance_change = rate->center_distance_change - arm * to->inclination;
        to->offset = rate->offset + arm * to->skew;
        to->axial_shift = 0.0;
    }
}

/* What the halves do where the wheel moves by this; nothing beside their poses where it stands, to the bit. */
static int place_halves(const gm_double_helical *gears, const gm_motion *motion, halves *both) {
    const gm_pair *pair = gears->half[0]->pair;
    const gm_pose *first = &gears->half[0]->pose, *second = &gears->half[1]->pose;
    const gm_pose none = {0.0, 0.0, 0.0, 0.0, 0.0};
    both->position = motion->position;
    both->place[0] = *first;
    both->place[1] = *second;
    for (int k = 0; k < 2; ++k) {
        both->motion[k].position = motion->position;
        both->motion[k].pose = both->motion[k].pose_rate = none;
    }
    if (gmi_is_at_rest(&motion->pose) && gmi_is_at_rest(&motion->pose_rate)) {
        return GM_OK;
    }

    /* Where the whole is by then, and each half with it; beside where it was prepared. */
    const gm_pose prepared = pose_of_whole(first, second);
    const gm_pose whole = sum_of_poses(&prepared, 1.0, &motion->pose);
    const int status = gm_double_helical_pose(pair, gears->gap, &whole, both->place);
    gm_pose rates[2];
    rate_of_halves(pair, gears->gap, &whole, &motion->pose_rate, rates);
    for (int k = 0; k < 2; ++k) {
        both->motion[k].pose = sum_of_poses(&both->place[k], -1.0, &gears->half[k]->pose);
        both->motion[k].pose_rate = rates[k];
    }
    return status;
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

static int evaluate_half(const gm_double_helical *gears, int k, halves *both, double shift,
                         int wanted, gm_mesh_result *result) {
    gm_motion *motion = &both->motion[k];
    motion->position.offset = both->position.offset + (k == 0 ? shift : -shift);
    return gm_mesh_evaluate_posed(gears->half[k], motion, wanted, gears->workspace[k], result);
}

/* At fixed phi_p a change of x is one of -phi_w. */
static double by_offset(const gm_pair *pair, const gm_gradient *by) {
    return -by->wheel_angle / pair->wheel.base_radius;
}

/* How the force of the first half less that of the second changes with the shift (N/m). */
static double slope_of(const gm_pair *pair, const gm_mesh_result each[2]) {
    return by_offset(pair, &each[0].force_by) + by_offset(pair, &each[1].force_by);
}

/*
 * The shift at which both halves carry the same force: their difference grows with it. Newton's method, within what is
 * known to enclose it. Where neither touches, any shift will do.
 */
static int balance(const gm_double_helical *gears, halves *both, int wanted, double *shift,
                   gm_mesh_result each[2]) {
    const gm_pair *pair = gears->half[0]->pair;
    const double pitch = pair->transverse_base_pitch;
    const double limit = 0.5 * pitch * (1.0 - 1e-9) - fabs(both->position.offset);
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
        const double slope = slope_of(pair, each);
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

/* ---------------------------------------------------------------------------------------------
 * What both halves come to
 * ------------------------------------------------------------------------------------------- */

static double of_gradient(const gm_gradient *gradient, int k) {
    const double parts[4] = {gradient->pinion_angle, gradient->wheel_angle, gradient->pinion_speed,
                             gradient->wheel_speed};
    return parts[k];
}

/*
 * A quantity that is the sum of both halves, by angles and speeds: the shift follows, so that the forces stay equal,
 * F1_v dv + F1_x ds = F2_v dv - F2_x ds.
 */
static gm_gradient sum_of_gradients(const gm_pair *pair, const gm_mesh_result each[2],
                                    const gm_gradient *first, const gm_gradient *second) {
    const double slope = slope_of(pair, each);
    const double by_shift = by_offset(pair, first) - by_offset(pair, second);
    double by[4];
    for (int k = 0; k < 4; ++k) {
        const double difference =
            of_gradient(&each[1].force_by, k) - of_gradient(&each[0].force_by, k);
        const double follows = slope > 0.0 ? by_shift * difference / slope : 0.0;
        by[k] = of_gradient(first, k) + of_gradient(second, k) + follows;
    }

    const gm_gradient sum = {by[0], by[1], by[2], by[3]};
    return sum;
}

/* Overlap and touching part as those of one mesh with the stiffness of both halves: their means. */
static gm_penetration mean_of_contacts(const gm_pair *pair, const gm_mesh_result each[2]) {
    const gm_penetration *a = &each[0].contact, *b = &each[1].contact;
    const gm_gradient first = {a->d_pinion_angle, a->d_wheel_angle, 0.0, 0.0};
    const gm_gradient second = {b->d_pinion_angle, b->d_wheel_angle, 0.0, 0.0};
    const gm_gradient by = sum_of_gradients(pair, each, &first, &second);

    /* Pairs are counted in both. */
    const gm_penetration mean = {
        .penetration = 0.5 * (a->penetration + b->penetration),
        .rate = 0.5 * (a->rate + b->rate),
        .drive = 0.5 * (a->drive + b->drive),
        .coast = 0.5 * (a->coast + b->coast),
        .drive_rate = 0.5 * (a->drive_rate + b->drive_rate),
        .coast_rate = 0.5 * (a->coast_rate + b->coast_rate),
        .drive_contact = 0.5 * (a->drive_contact + b->drive_contact),
        .coast_contact = 0.5 * (a->coast_contact + b->coast_contact),
        .d_pinion_angle = 0.5 * by.pinion_angle,
        .d_wheel_angle = 0.5 * by.wheel_angle,
        .drive_pairs = a->drive_pairs + b->drive_pairs,
        .coast_pairs = a->coast_pairs + b->coast_pairs,
    };
    return mean;
}

/* Adds force and moment of a half about its axis at z = 0 there, which is at `place` in the frame of the whole; in a
 * mirror across z a force changes its z, a moment its x and y. */
static void add_load(const double force[3], const double moment[3], const double place[3],
                     double mirror, double to_force[3], double to_moment[3]) {
    const double f[3] = {force[0], force[1], mirror * force[2]};
    const double m[3] = {mirror * moment[0], mirror * moment[1], moment[2]};

    to_moment[0] += m[0] + place[1] * f[2] - place[2] * f[1];
    to_moment[1] += m[1] + place[2] * f[0] - place[0] * f[2];
    to_moment[2] += m[2] + place[0] * f[1] - place[1] * f[0];
    for (int k = 0; k < 3; ++k) {
        to_force[k] += f[k];
    }
}

static void add_wrenches(const gm_double_helical *gears, const gm_pose place[2],
                         const gm_mesh_result each[2], gm_wrench *sum) {
    const gm_pose *first = &place[0], *second = &place[1];
    const double width = 2.0 * gears->half[0]->pair->pinion.face_width + gears->gap;
    const gm_wrench none = {{0.0}, {0.0}, {0.0}, {0.0}};
    *sum = none;
    for (int k = 0; k < 2; ++k) {
        const double sign = k == 0 ? 1.0 : -1.0;
        const double z = k == 0 ? 0.0 : width;

        /* The axes of tilted halves stand apart, the whole's is in the middle. */
        const double at_pinion[3] = {0.0, 0.0, z};
        const double at_wheel[3] = {
            0.5 * sign * (first->center_distance_change - second->center_distance_change),
            0.5 * sign * (first->offset - second->offset), z};
        const gm_wrench *half = &each[k].wrench;
        add_load(half->pinion_force, half->pinion_moment, at_pinion, sign, sum->pinion_force,
                 sum->pinion_moment);
        add_load(half->wheel_force, half->wheel_moment, at_wheel, sign, sum->wheel_force,
                 sum->wheel_moment);
    }
}

static void add_halves(const gm_double_helical *gears, const gm_pose place[2],
                       const gm_mesh_result each[2], int wanted, gm_mesh_result *sum) {
    const gm_pair *pair = gears->half[0]->pair;
    gmi_mesh_result_set_nan(sum);
    sum->force = each[0].force + each[1].force;
    sum->drive_force = each[0].drive_force + each[1].drive_force;
    sum->coast_force = each[0].coast_force + each[1].coast_force;
    sum->pinion_torque = each[0].pinion_torque + each[1].pinion_torque;
    sum->wheel_torque = each[0].wheel_torque + each[1].wheel_torque;
    sum->loss = each[0].loss + each[1].loss;
    sum->energy = each[0].energy + each[1].energy;
    sum->contact = mean_of_contacts(pair, each);

    if (wanted & GM_WANT_DERIVATIVES) {
        sum->force_by = sum_of_gradients(pair, each, &each[0].force_by, &each[1].force_by);
        sum->pinion_torque_by =
            sum_of_gradients(pair, each, &each[0].pinion_torque_by, &each[1].pinion_torque_by);
        sum->wheel_torque_by =
            sum_of_gradients(pair, each, &each[0].wheel_torque_by, &each[1].wheel_torque_by);
    } else {
        sum->contact.d_pinion_angle = sum->contact.d_wheel_angle = gmi_nan();
    }
    if (wanted & GM_WANT_WRENCH) {
        add_wrenches(gears, place, each, &sum->wrench);
    }
}

static void set_nan(gm_mesh_result each[2], gm_mesh_result *result) {
    gmi_mesh_result_set_nan(&each[0]);
    gmi_mesh_result_set_nan(&each[1]);
    gmi_mesh_result_set_nan(result);
}

int gm_double_helical_evaluate_posed(const gm_double_helical *gears, const gm_motion *motion,
                                     int wanted, double *apex, gm_mesh_result each[2],
                                     gm_mesh_result *result) {
    if (each == NULL || result == NULL) {
        return GM_ERR_NULL;
    }
    halves both;
    int status = apex == NULL || motion == NULL ? GM_ERR_NULL : check(gears);
    if (status == GM_OK) {
        status = place_halves(gears, motion, &both);
    }
    if (status == GM_OK) {
        const double helix = tan_base_helix(gears->half[0]->pair);
        double shift = -*apex * helix;
        status = balance(gears, &both, wanted, &shift, each);
        *apex = status == GM_OK ? -shift / helix : *apex;
    }

    if (status != GM_OK) {
        set_nan(each, result);
    } else {
        add_halves(gears, both.place, each, wanted, result);
    }
    return status;
}

int gm_double_helical_evaluate_at(const gm_double_helical *gears, const gm_position *position,
                                  int wanted, double *apex, gm_mesh_result each[2],
                                  gm_mesh_result *result) {
    const gm_pose none = {0.0, 0.0, 0.0, 0.0, 0.0};
    gm_motion motion = {.pose = none, .pose_rate = none};
    if (position != NULL) {
        motion.position = *position;
    }
    return gm_double_helical_evaluate_posed(gears, position != NULL ? &motion : NULL, wanted, apex,
                                            each, result);
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
        gm_motion motion = {.pose = {0.0}};
        halves both;
        int status = find_halves(gears, pinion_angle, half_torque, offset);
        if (status != GM_OK) {
            return status;
        }

        /* What both come to there, while they roll. */
        const double shift = 0.5 * (offset[0] - offset[1]);
        status =
            gm_position_from_pinion_angle(gears->half[0]->pair, pinion_angle,
                                          0.5 * (offset[0] + offset[1]), 0.0, &motion.position);
        motion.position.pinion_speed = pinion_speed;
        if (status == GM_OK) {
            status = place_halves(gears, &motion, &both);
        }
        for (int half = 0; half < 2 && status == GM_OK; ++half) {
            status = evaluate_half(gears, half, &both, shift, GM_WANT_DERIVATIVES, &each[half]);
        }
        if (status != GM_OK) {
            return status;
        }
        add_halves(gears, both.place, each, GM_WANT_DERIVATIVES, result);
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
