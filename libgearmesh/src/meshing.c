/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Two gears at a centre distance [Paper, Eq. 23; ISO21771]: working pressure angle, line of action, backlash, path of
 * contact. The gears stay as they are drawn, so that the same function serves the drawing and axes that have moved.
 */
#include "internal.h"

#include <math.h>

/*
 * Everything is found from the small difference to the reference position, so that inv(alpha_wt) - inv(alpha_t) keeps
 * its digits when both nearly agree.
 */
void gmi_meshing_find_angles(const gm_pair *pair, double center_distance, gmi_meshing *meshing) {
    const double base_sum = pair->pinion.base_radius + pair->wheel.base_radius;
    const double alpha_t = pair->transverse_pressure_angle;

    /* The right triangle of centre distance, base radii and line of action [Paper, Eq. 23]. */
    meshing->center_distance = center_distance;
    meshing->line_of_action = sqrt((center_distance - base_sum) * (center_distance + base_sum));
    const double alpha_w = atan2(meshing->line_of_action, base_sum);
    meshing->working_pressure_angle = alpha_w;

    /* cos(alpha_t) - cos(alpha_wt) = 2 sin((alpha_wt + alpha_t) / 2) sin((alpha_wt - alpha_t) / 2) */
    const double cos_difference =
        cos(alpha_t) * ((center_distance - pair->reference_center_distance) / center_distance);
    const double difference = 2.0 * asin(cos_difference / (2.0 * sin(0.5 * (alpha_w + alpha_t))));
    meshing->involute_difference = sin(difference) / (cos(alpha_w) * cos(alpha_t)) - difference;
}

/* A start radius that is given stays; else the profile starts where it meets the mate's tip. */
static double start_roll_length(const gm_gear *gear, const gm_gear *mate, double line_of_action) {
    return gear->start_is_given ? gear->start_roll_length
                                : fmax(line_of_action - mate->tip_roll_length, 0.0);
}

int gmi_meshing_find(const gm_pair *pair, double center_distance, gmi_meshing *meshing) {
    const gm_gear *pinion = &pair->pinion;
    const gm_gear *wheel = &pair->wheel;
    const double base_sum = pinion->base_radius + wheel->base_radius;
    if (!(center_distance > base_sum)) {
        return 0;
    }
    gmi_meshing_find_angles(pair, center_distance, meshing);
    const double length = meshing->line_of_action;

    /* Spreading the axes opens the backlash of the drawing. */
    meshing->backlash = pair->backlash +
                        2.0 * base_sum * (meshing->involute_difference - pair->involute_difference);

    /* Path of contact: where both active profiles are. */
    const double pinion_start = start_roll_length(pinion, wheel, length);
    const double wheel_start = start_roll_length(wheel, pinion, length);
    meshing->start_roll_length[GM_PINION] = pinion_start;
    meshing->start_roll_length[GM_WHEEL] = wheel_start;
    meshing->path_start = fmax(pinion_start, length - wheel->tip_roll_length);
    meshing->path_end = fmin(pinion->tip_roll_length, length - wheel_start);
    meshing->transverse_contact_ratio =
        (meshing->path_end - meshing->path_start) / pair->transverse_base_pitch;

    /* Zero angles refer to z = 0; the lines of contact begin where the common face does. On the coast side, the mirror
     * image, they advance the other way. */
    const double at_zero =
        pinion->base_radius * (meshing->working_pressure_angle + pinion->base_half_thickness);
    const double advance = pair->face_start * (pair->face_advance / pair->face_width);
    meshing->phase_origin[GM_DRIVE] = at_zero + advance;
    meshing->phase_origin[GM_COAST] = at_zero - advance;

    /* On the centre line. */
    const double spread = center_distance / base_sum; /* 1 / cos(alpha_wt) */
    meshing->working_pitch_radius[GM_PINION] = pinion->base_radius * spread;
    meshing->working_pitch_radius[GM_WHEEL] = wheel->base_radius * spread;
    meshing->tip_clearance[GM_PINION] = center_distance - pinion->tip_radius - wheel->root_radius;
    meshing->tip_clearance[GM_WHEEL] = center_distance - wheel->tip_radius - pinion->root_radius;
    return meshing->path_end > meshing->path_start;
}

/* ---------------------------------------------------------------------------------------------
 * The pair as it is posed
 * ------------------------------------------------------------------------------------------- */

/* The pair as drawn. */
static gmi_engagement drawn(const gm_pair *pair) {
    const gm_gear *pinion = &pair->pinion;
    const gm_gear *wheel = &pair->wheel;
    const gmi_engagement at = {
        .center_distance = pair->center_distance,
        .working_pressure_angle = pair->working_pressure_angle,
        .line_of_action = pair->line_of_action,
        .backlash = pair->backlash,
        .phase_origin = {pair->phase_origin[GM_DRIVE], pair->phase_origin[GM_COAST]},
        .start_roll_length = {pinion->start_roll_length, wheel->start_roll_length},
        .start_follows = {!pinion->start_is_given && pinion->start_roll_length > 0.0,
                          !wheel->start_is_given && wheel->start_roll_length > 0.0},
        .face_from = 0.0,
        .face_to = 1.0,
        .face_origin = {(pair->face_start - pinion->face_start) / pinion->face_width,
                        (pair->face_start - wheel->face_start) / wheel->face_width},
        .face_scale = {pair->face_width / pinion->face_width, pair->face_width / wheel->face_width},
        .face_center = wheel->face_start + 0.5 * wheel->face_width,
    };
    return at;
}

/* Axes at another distance and in another direction: exact, as it is another drawing of the same gears. */
static int move_axes(const gm_pair *pair, double along_x, double along_y, gmi_engagement *at) {
    const double distance = hypot(pair->center_distance + along_x, along_y);
    gmi_meshing moved;
    if (!gmi_meshing_find(pair, distance, &moved)) {
        return GM_POSE_OUT_OF_MESH;
    }

    /* Tips that the drawing keeps clear of the mate's root must stay so. */
    const double clearance[2] = {pair->pinion_tip_clearance, pair->wheel_tip_clearance};
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        if (clearance[role] > 0.0 && !(moved.tip_clearance[role] > 0.0)) {
            return GM_POSE_OUT_OF_MESH;
        }
    }

    at->center_distance = distance;
    at->working_pressure_angle = moved.working_pressure_angle;
    at->line_of_action = moved.line_of_action;
    at->backlash = moved.backlash;
    const gm_gear *gears[2] = {&pair->pinion, &pair->wheel};
    for (int k = 0; k < 2; ++k) {
        at->phase_origin[k] = moved.phase_origin[k];
        at->start_roll_length[k] = moved.start_roll_length[k];
        at->start_follows[k] = !gears[k]->start_is_given && moved.start_roll_length[k] > 0.0;
    }

    /* Both gears have turned back by the direction of the axes: phi_p - psi, phi_w + psi. */
    const double psi = atan2(along_y, pair->center_distance + along_x);
    const double r_bp = pair->pinion.base_radius;
    at->axis_direction = psi;
    at->phase_shift = -r_bp * psi;
    at->offset_shift = -(r_bp + pair->wheel.base_radius) * psi;
    return GM_OK;
}

/*
 * The wheel moved along its axis: its flanks at a z are those that were at z - shift, which the helix turns into a
 * movement along the line of action; and both faces end elsewhere against each other.
 */
static int move_face(const gm_pair *pair, double shift, gmi_engagement *at) {
    const double wheel_start = pair->wheel.face_start + shift;
    const double from = fmax(0.0, wheel_start);
    const double to = fmin(pair->pinion.face_width, wheel_start + pair->wheel.face_width);
    if (!(from < to)) {
        return GM_POSE_OUT_OF_MESH;
    }

    at->face_from = (from - pair->face_start) / pair->face_width;
    at->face_to = (to - pair->face_start) / pair->face_width;
    at->face_origin[GM_WHEEL] = (pair->face_start - wheel_start) / pair->wheel.face_width;
    at->face_center += shift;
    at->offset_shift += shift * (pair->face_advance / pair->face_width);
    return GM_OK;
}

/* The rotation vector, turned with the axes; about the middle of the wheel's own face, where that is now. */
static int tilt_axis(const gm_pair *pair, const gm_pose *pose, gmi_engagement *at) {
    const double largest = pair->transverse_base_pitch / 8.0;
    if (!(hypot(pose->skew, pose->inclination) * pair->face_width <= largest)) {
        return GM_POSE_OUT_OF_MESH;
    }

    /* In the frame in which the wheel's axis is on the x axis. */
    const double cosine = cos(at->axis_direction);
    const double sine = sin(at->axis_direction);
    const double about_x = cosine * pose->skew + sine * pose->inclination;
    const double about_y = cosine * pose->inclination - sine * pose->skew;

    /* e = (sin(alpha), +-cos(alpha)), t = (cos(alpha), -+sin(alpha)). */
    const double sin_alpha = sin(at->working_pressure_angle);
    const double cos_alpha = cos(at->working_pressure_angle);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const double sign = gmi_side_sign(side);
        at->along[side] = -sign * (about_x * sin_alpha + sign * about_y * cos_alpha);
        at->across[side] = -sign * (about_x * cos_alpha - sign * about_y * sin_alpha);
    }
    at->is_tilted = 1;
    return GM_OK;
}

int gmi_engagement_find(const gm_pair *pair, const gm_pose *pose, gmi_engagement *engagement) {
    *engagement = drawn(pair);
    if (pose == NULL) {
        return GM_OK;
    }
    const double along_x = pose->center_distance_change;
    const double along_y = pose->offset;
    const double along_z = pose->axial_shift;
    if (!gmi_is_finite(along_x) || !gmi_is_finite(along_y) || !gmi_is_finite(along_z) ||
        !gmi_is_finite(pose->skew) || !gmi_is_finite(pose->inclination)) {
        return GM_STATE_NOT_FINITE;
    }

    /* What does not move stays as drawn, to the last bit. */
    int status = GM_OK;
    if (along_x != 0.0 || along_y != 0.0) {
        status = move_axes(pair, along_x, along_y, engagement);
    }
    if (status == GM_OK && along_z != 0.0) {
        status = move_face(pair, along_z, engagement);
    }
    if (status == GM_OK && (pose->skew != 0.0 || pose->inclination != 0.0)) {
        status = tilt_axis(pair, pose, engagement);
    }
    return status;
}
