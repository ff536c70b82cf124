/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* What both halves of a double-helical pair come to: sums of forces, wrenches, and derivatives with the float that follows. */
#include "double_helical.h"
#include "internal.h"
#include "mesh.h"

/*
 * The middle of the wheel's half lies at -h on the axis of the whole wheel. Turned by the rotation vector theta about the
 * middle of the whole, it moves by theta x (0, 0, -h) sin(theta)/theta and comes nearer by h (1 - cos(theta)).
 */
gm_pose gmi_pose_of_half(const gm_pair *half, double gap, const gm_pose *whole, int k) {
    const double h = 0.5 * (half->wheel.face_width + gap);
    const double turn = hypot(whole->skew, whole->inclination);
    const double arm = turn > 0.0 ? h * sin(turn) / turn : h;
    const double sign = k == 0 ? 1.0 : -1.0;
    gm_pose pose;
    pose.skew = sign * whole->skew;
    pose.inclination = sign * whole->inclination;
    pose.center_distance_change = whole->center_distance_change - arm * pose.inclination;
    pose.offset = whole->offset + arm * pose.skew;
    pose.axial_shift =
        2.0 * h * sin(0.5 * turn) * sin(0.5 * turn); /* the pinion floats to where the wheel is */
    return pose;
}

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
    const double slope = gmi_slope_of_halves(pair, each);
    const double by_shift = gmi_by_offset(pair, first) - gmi_by_offset(pair, second);
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

static void add_wrenches(const gm_double_helical *gears, const gm_pose *whole,
                         const gm_mesh_result each[2], gm_wrench *sum) {
    const gm_pair *pair = gears->half[0]->pair;
    const gm_pose first = gmi_pose_of_half(pair, gears->gap, whole, 0);
    const gm_pose second = gmi_pose_of_half(pair, gears->gap, whole, 1);
    const double width = 2.0 * gears->half[0]->pair->pinion.face_width + gears->gap;
    const gm_wrench none = {{0.0}, {0.0}, {0.0}, {0.0}};
    *sum = none;
    for (int k = 0; k < 2; ++k) {
        const double sign = k == 0 ? 1.0 : -1.0;
        const double z = k == 0 ? 0.0 : width;

        /* The axes of tilted halves stand apart, the whole's is in the middle. */
        const double at_pinion[3] = {0.0, 0.0, z};
        const double at_wheel[3] = {
            0.5 * sign * (first.center_distance_change - second.center_distance_change),
            0.5 * sign * (first.offset - second.offset), z};
        const gm_wrench *half = &each[k].wrench;
        add_load(half->pinion_force, half->pinion_moment, at_pinion, sign, sum->pinion_force,
                 sum->pinion_moment);
        add_load(half->wheel_force, half->wheel_moment, at_wheel, sign, sum->wheel_force,
                 sum->wheel_moment);
    }
}

void gmi_double_helical_add(const gm_double_helical *gears, const gm_pose *whole,
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
        add_wrenches(gears, whole, each, &sum->wrench);
    }
}
