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
