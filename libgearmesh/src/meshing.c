/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Two gears at a centre distance [Paper, Eq. 23; ISO21771]: working pressure angle, line of action, backlash, path of
 * contact. The gears stay as they are drawn, so that the same function serves the drawing and axes that have moved.
 */
#include "meshing.h"

#include "contact.h"
#include "gear.h"
#include "internal.h"

#include <math.h>
#include <string.h>

/*
 * Everything is found from the small difference to the reference position, so that inv(alpha_wt) - inv(alpha_t) keeps
 * its digits when both nearly agree.
 */
void gmi_meshing_find_angles(const gm_pair *pair, double center_distance, gmi_meshing *meshing) {
    const double base_sum = fabs(gmi_base_sum(pair));

    /* The right triangle of centre distance, base radii and line of action [Paper, Eq. 23]. */
    meshing->center_distance = center_distance;
    meshing->line_of_action = sqrt((center_distance - base_sum) * (center_distance + base_sum));

    /* Sine and cosine of the pressure angle on the reference circles, and on the working ones. */
    const double reference = pair->reference_center_distance;
    const double sin_t = sqrt((reference - base_sum) * (reference + base_sum)) / reference;
    const double cos_t = base_sum / reference;
    const double sin_w = meshing->line_of_action / center_distance;
    const double cos_w = base_sum / center_distance;

    /* From lengths, which are the same with every C library, where alpha_t may differ in the last bit. */
    meshing->working_pressure_angle = asin(sin_w);

    /*
     * Their difference, without one of numbers that are nearly the same:
     *     sin(alpha_wt - alpha_t) = (cos^2(alpha_t) - cos^2(alpha_wt)) / sin(alpha_wt + alpha_t).
     */
    const double cos_difference = cos_t * ((center_distance - reference) / center_distance);
    const double sin_difference =
        cos_difference * (cos_t + cos_w) / (sin_w * cos_t + cos_w * sin_t);
    const double difference = asin(sin_difference);
    meshing->involute_difference = sin_difference / (cos_w * cos_t) - difference;
}

double gmi_start_roll_length(const gm_gear *gear, const gm_gear *mate, double line_of_action) {
    if (gear->start_is_given) {
        return gear->start_roll_length;
    }
    const double of_mate = mate->sign * mate->tip_roll_length;
    return gmi_larger(gear->sign * (line_of_action - of_mate), 0.0);
}

int gmi_meshing_find(const gm_pair *pair, double center_distance, gmi_meshing *meshing) {
    const gm_gear *pinion = &pair->pinion;
    const gm_gear *wheel = &pair->wheel;
    const double base_sum = gmi_base_sum(pair);
    if (!(center_distance > fabs(base_sum))) {
        return 0;
    }
    gmi_meshing_find_angles(pair, center_distance, meshing);

    /* Below 0 with a ring. */
    const double sign = wheel->sign;
    const double length = sign * meshing->line_of_action;
    const double wheel_axis = sign * center_distance;

    /* Spreading the axes opens the backlash of the drawing. */
    meshing->backlash = pair->backlash +
                        2.0 * base_sum * (meshing->involute_difference - pair->involute_difference);

    /* Path of contact: where both active profiles are. */
    const double pinion_start = gmi_start_roll_length(pinion, wheel, length);
    const double wheel_start = gmi_start_roll_length(wheel, pinion, length);
    meshing->start_roll_length[GM_PINION] = pinion_start;
    meshing->start_roll_length[GM_WHEEL] = wheel_start;
    meshing->path_start = gmi_larger(pinion_start, length - sign * wheel->tip_roll_length);
    meshing->path_end = gmi_smaller(pinion->tip_roll_length, length - sign * wheel_start);
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
    const double spread = wheel_axis / base_sum; /* 1 / cos(alpha_wt) */
    meshing->working_pitch_radius[GM_PINION] = pinion->base_radius * spread;
    meshing->working_pitch_radius[GM_WHEEL] = wheel->base_radius * spread;
    meshing->tip_clearance[GM_PINION] = wheel_axis - pinion->tip_radius - sign * wheel->root_radius;
    meshing->tip_clearance[GM_WHEEL] = wheel_axis - sign * wheel->tip_radius - pinion->root_radius;
    return meshing->path_end > meshing->path_start;
}

/* ---------------------------------------------------------------------------------------------
 * What is in the way of a ring's pair
 * ------------------------------------------------------------------------------------------- */

/*
 * The tip corners of two flanks that touch, or of two that touch each other's mirror image, by their polar angles about
 * their own axes from the centre line: theta_p and theta_w. Involutes that touch in the pitch point at angles A and B
 * have A r_bp = B r_bw, and from there to the tip the flank turns by inv(alpha_wt) - inv(alpha_a).
 */
typedef struct tip_corners {
    double pinion_turn, wheel_turn; /* inv(alpha_wt) - inv(alpha_a) (rad) */
    double ratio;                   /* r_bp / r_bw */
    double gap; /* how far the ring's flank is turned away from the pinion's (rad) */
} tip_corners;

static double turn_to_tip(const gm_gear *gear, double working_involute) {
    return working_involute - gmi_involute(atan2(gear->tip_roll_length, gear->base_radius));
}

/* Polar angle of the ring's corner when the pinion's is at theta_p. */
static double corner_of_ring(const tip_corners *corners, double theta_p) {
    return (theta_p - corners->pinion_turn) * corners->ratio + corners->wheel_turn + corners->gap;
}

/* Flanks in contact: the pinion's corner passes the ring's tip circle before or behind the ring's corner. */
static int tips_meet_beside_path(const gm_pair *pair, const gmi_meshing *meshing,
                                 const tip_corners *corners) {
    const double a = meshing->center_distance;
    const double r_p = pair->pinion.tip_radius, r_w = pair->wheel.tip_radius;
    const double cos_p = (r_w * r_w - r_p * r_p - a * a) / (2.0 * a * r_p);
    const double cos_w = (a * a + r_w * r_w - r_p * r_p) / (2.0 * a * r_w);
    if (!(fabs(cos_p) <= 1.0 && fabs(cos_w) <= 1.0)) {
        return 1; /* the tip circles do not cross: the pinion fills the ring */
    }
    return corner_of_ring(corners, acos(cos_p)) < acos(cos_w);
}

/*
 * Pinion moved in along the centre line, backlash on both sides alike: the corners must not stand higher than those of
 * the ring. The way left, r_aw sin(theta_w) - r_ap sin(theta_p), is least as the gears turn where both heights are the
 * same y with y^2 (1 - ratio^2) = r_ap^2 - ratio^2 r_aw^2.
 */
static int tips_meet_on_way_in(const gm_pair *pair, const tip_corners *corners) {
    const double r_p = pair->pinion.tip_radius, r_w = pair->wheel.tip_radius;
    const double k = corners->ratio;
    const double height_squared = (r_p * r_p - k * k * r_w * r_w) / (1.0 - k * k);
    if (!(height_squared > 0.0 && height_squared < r_p * r_p)) {
        return 0;
    }
    const double height = sqrt(height_squared);
    return corner_of_ring(corners, asin(height / r_p)) < asin(height / r_w);
}

enum gmi_interference gmi_meshing_interference(const gm_pair *pair, const gmi_meshing *meshing) {
    if (pair->wheel.sign > 0.0) {
        return GMI_CLEAR;
    }
    if (!(pair->wheel.tip_roll_length > meshing->line_of_action)) {
        return GMI_INVOLUTE_INTERFERENCE;
    }

    const double working_involute = gmi_involute(meshing->working_pressure_angle);
    tip_corners corners = {
        turn_to_tip(&pair->pinion, working_involute),
        turn_to_tip(&pair->wheel, working_involute),
        pair->pinion.base_radius / pair->wheel.base_radius,
        0.0,
    };
    if (tips_meet_beside_path(pair, meshing, &corners)) {
        return GMI_TROCHOID_INTERFERENCE;
    }
    corners.gap = 0.5 * meshing->backlash / pair->wheel.base_radius;
    return tips_meet_on_way_in(pair, &corners) ? GMI_TRIMMING : GMI_CLEAR;
}

/* ---------------------------------------------------------------------------------------------
 * The pair as it is posed
 * ------------------------------------------------------------------------------------------- */

/* The pair as drawn: field by field, which costs half as much as a copy. */
static void set_drawn(const gm_pair *pair, gmi_engagement *at) {
    const gm_gear *gears[2] = {&pair->pinion, &pair->wheel};
    memset(at, 0, sizeof *at);

    /* The axes, with the wheel's on +x, and what follows from their distance. */
    at->center_distance = pair->center_distance;
    at->working_pressure_angle = pair->working_pressure_angle;
    at->axis[0] = 1.0;
    at->line_of_action = pair->line_of_action;
    at->wheel_base_radius = pair->wheel.base_radius;
    at->backlash = pair->backlash;

    /* What each gear has, and how the common face lies on its own. */
    for (int k = 0; k < 2; ++k) {
        const gm_gear *gear = gears[k];
        at->phase_origin[k] = pair->phase_origin[k];
        at->start_roll_length[k] = gear->start_roll_length;
        at->start_follows[k] = !gear->start_is_given && gear->start_roll_length > 0.0;
        at->starts_deeper[k] = 0;
        at->tip_roll_length[k] = gear->tip_roll_length;
        at->face_origin[k] = (pair->face_start - gear->face_start) / gear->face_width;
        at->face_scale[k] = pair->face_width / gear->face_width;
    }
    at->wheel_profile_start = pair->wheel.start_roll_length;
    at->face_to = 1.0;
    at->face_center = pair->wheel.face_start + 0.5 * pair->wheel.face_width;
}

static void set_drawn_angles(gmi_engagement *at) {
    at->sin_pressure_angle = sin(at->working_pressure_angle);
    at->cos_pressure_angle = cos(at->working_pressure_angle);
}

/* The one place where a ring's lengths get their sign. */
static void give_signs(const gm_pair *pair, gmi_engagement *at) {
    const double sign = pair->wheel.sign;
    at->center_distance *= sign;
    at->line_of_action *= sign;
    at->wheel_base_radius *= sign;
    at->start_roll_length[GM_WHEEL] *= sign;
    at->tip_roll_length[GM_WHEEL] *= sign;
    at->wheel_profile_start *= sign;
}

/* Axes at another distance and in another direction: exact, as it is another drawing of the same gears. */
static int move_axes(const gm_pair *pair, double along_x, double along_y, gmi_engagement *at) {
    /* Of the wheel's axis from the pinion's; a ring's is on the other side, where distances are below 0. */
    const double sign = pair->wheel.sign;
    const double apart = pair->center_distance + sign * along_x;
    const double distance = sqrt(apart * apart + along_y * along_y);

    /* Gears that no longer reach each other, or whose teeth are in each other's way. */
    gmi_meshing moved;
    if (!gmi_meshing_find(pair, distance, &moved)) {
        return GM_POSE_OUT_OF_MESH;
    }
    const enum gmi_interference found = gmi_meshing_interference(pair, &moved);
    if (found == GMI_INVOLUTE_INTERFERENCE || found == GMI_TROCHOID_INTERFERENCE) {
        return GM_POSE_OUT_OF_MESH;
    }

    /* Tips that the drawing keeps clear of the mate's root must stay so. */
    const double clearance[2] = {pair->pinion_tip_clearance, pair->wheel_tip_clearance};
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        if (clearance[role] > 0.0 && !(moved.tip_clearance[role] > 0.0)) {
            return GM_POSE_OUT_OF_MESH;
        }
    }

    /* What follows from the distance: angles, line of action, backlash, and where active flanks start. */
    at->center_distance = distance;
    at->working_pressure_angle = moved.working_pressure_angle;
    at->sin_pressure_angle = moved.line_of_action / distance;
    at->cos_pressure_angle = fabs(gmi_base_sum(pair)) / distance;
    at->line_of_action = moved.line_of_action;
    at->backlash = moved.backlash;
    const gm_gear *gears[2] = {&pair->pinion, &pair->wheel};
    for (int k = 0; k < 2; ++k) {
        at->phase_origin[k] = moved.phase_origin[k];
        at->start_roll_length[k] = moved.start_roll_length[k];
        at->start_follows[k] = !gears[k]->start_is_given && moved.start_roll_length[k] > 0.0;
    }

    /*
     * Both gears have turned back by the direction of the axes: phi_p - psi, and phi_w + psi, or - psi with a ring. It is
     * small, and then half the work.
     */
    at->axis[0] = apart / distance;
    at->axis[1] = sign * along_y / distance;
    const double psi = at->axis[0] > 0.5 ? asin(at->axis[1]) : atan2(at->axis[1], at->axis[0]);
    at->axis_direction = psi;
    at->phase_shift = -pair->pinion.base_radius * psi;
    at->offset_shift = -gmi_base_sum(pair) * psi;
    return GM_OK;
}

/*
 * The wheel moved along its axis: its flanks at a z are those that were at z - shift, which the helix turns into a
 * movement along the line of action; and both faces end elsewhere against each other.
 */
static int move_face(const gm_pair *pair, double shift, gmi_engagement *at) {
    const double wheel_start = pair->wheel.face_start + shift;
    const double from = gmi_larger(wheel_start, 0.0);
    const double to = gmi_smaller(wheel_start + pair->wheel.face_width, pair->pinion.face_width);
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
    const double tilt = sqrt(pose->skew * pose->skew + pose->inclination * pose->inclination);
    if (!(tilt * pair->face_width <= largest)) {
        return GM_POSE_OUT_OF_MESH;
    }

    /* In the frame in which the wheel's axis is on the x axis. */
    const double cosine = at->axis[0];
    const double sine = at->axis[1];
    const double about_x = cosine * pose->skew + sine * pose->inclination;
    const double about_y = cosine * pose->inclination - sine * pose->skew;

    /* e = (sin(alpha), +-cos(alpha)), t = (cos(alpha), -+sin(alpha)). */
    const double sin_alpha = at->sin_pressure_angle;
    const double cos_alpha = at->cos_pressure_angle;
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const double sign = gmi_side_sign(side);
        at->along[side] = -sign * (about_x * sin_alpha + sign * about_y * cos_alpha);
        at->across[side] = -sign * (about_x * cos_alpha - sign * about_y * sin_alpha);
    }
    at->is_tilted = 1;
    return GM_OK;
}

int gmi_engagement_find(const gm_pair *pair, const gm_pose *pose, gmi_engagement *engagement) {
    set_drawn(pair, engagement);
    if (pose == NULL) {
        set_drawn_angles(engagement);
        give_signs(pair, engagement);
        return GM_OK;
    }

    /* Poses of finite numbers alone. */
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
    } else {
        set_drawn_angles(engagement);
    }
    if (status == GM_OK && along_z != 0.0) {
        status = move_face(pair, along_z, engagement);
    }
    if (status == GM_OK && (pose->skew != 0.0 || pose->inclination != 0.0)) {
        status = tilt_axis(pair, pose, engagement);
    }
    give_signs(pair, engagement);

    /* A start that follows the mate's tip may leave the flank's table behind, whose t2 = 0 does not move. */
    const double *start = engagement->start_roll_length;
    engagement->starts_deeper[GM_PINION] = start[GM_PINION] < pair->pinion.start_roll_length;
    engagement->starts_deeper[GM_WHEEL] = start[GM_WHEEL] < engagement->wheel_profile_start;
    return status;
}

/*
 * Points of the wheel's flank move by -n.v towards the pinion's, n = e - tau k: with its axis by v, and with its tilt by
 * what tilt.c derives in first order.
 */
void gmi_rates_find(const gm_pair *pair, const gmi_engagement *at, double offset_rate,
                    const gm_pose *pose_rate, gmi_rates rates[2]) {
    if (gmi_is_at_rest(pose_rate)) {
        for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
            const gmi_rates still = {.delta = gmi_side_sign(side) * offset_rate};
            rates[side] = still;
        }
        return;
    }

    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const double sign = gmi_side_sign(side);
        const double tau = sign * pair->face_advance / pair->face_width;
        const gmi_plane plane = gmi_plane_of(at, sign);
        const double *e = plane.e, *t = plane.t;
        rates[side].delta = sign * offset_rate - e[0] * pose_rate->center_distance_change -
                            e[1] * pose_rate->offset + tau * pose_rate->axial_shift;
        rates[side].along = -sign * (e[0] * pose_rate->skew + e[1] * pose_rate->inclination);
        rates[side].across = -sign * (t[0] * pose_rate->skew + t[1] * pose_rate->inclination);

        /* Of a point of the wheel's body at z, across the line of action: v + theta' x (z - z_O) k along -+t. */
        const double turning = t[0] * pose_rate->inclination - t[1] * pose_rate->skew;
        const double moving = t[0] * pose_rate->center_distance_change + t[1] * pose_rate->offset;
        rates[side].sideways[0] = -sign * (moving + turning * (pair->face_start - at->face_center));
        rates[side].sideways[1] = -sign * turning * pair->face_width;

        /* And along it, towards +e on either side's own way round: across is -sign t, turned on it is -sign e. */
        const double swinging = e[0] * pose_rate->inclination - e[1] * pose_rate->skew;
        const double advancing =
            e[0] * pose_rate->center_distance_change + e[1] * pose_rate->offset;
        rates[side].forward[0] =
            sign * (advancing + swinging * (pair->face_start - at->face_center));
        rates[side].forward[1] = sign * swinging * pair->face_width;
    }
}
