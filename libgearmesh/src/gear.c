/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Geometry of one gear alone, in its transverse section. A point of the involute is named by its roll
 * length rho = r_b chi, the length of the tangent from the point to the base circle, which is also its
 * distance along the line of action from the base tangent point [Paper, Eqs. 13-17, 21-22].
 */
#include "gear.h"

#include "internal.h"

#include <math.h>

double gmi_involute(double angle) {
    return tan(angle) - angle; /* [Paper, Eq. 16] with chi = tan(angle) */
}

void gmi_gear_init(gm_gear *gear, int teeth, double transverse_module,
                   double transverse_pressure_angle) {
    gear->sign = teeth < 0 ? -1.0 : 1.0;
    gear->teeth = teeth < 0 ? -teeth : teeth;
    const double number = (double)gear->teeth;
    gear->reference_radius = 0.5 * number * transverse_module;
    gear->base_radius =
        gear->reference_radius * cos(transverse_pressure_angle); /* [Paper, Eqs. 7-8] */

    /* 2 pi / z to twice the precision: the remainder of the division and that of 2 pi itself. */
    const double pitch = GMI_TWO_PI / number;
    const double product = pitch * number;
    const double remainder = (GMI_TWO_PI - product) - gmi_product_remainder(pitch, number, product);
    gear->pitch_angle = pitch;
    gear->pitch_angle_remainder = (remainder + GMI_TWO_PI_REMAINDER) / number;
}

/* Root circle of the basic rack, by the shift as printed [ISO21771]; that of a ring lies outside. */
void gmi_gear_set_root(gm_gear *gear, double normal_module) {
    const double depth = normal_module * (gear->rack_dedendum - gear->profile_shift);
    gear->root_radius = gear->reference_radius - gear->sign * depth;
}

/* r_a = r + m_n (h_aP + x + k) [ISO21771]; a radius that is given tells k. */
void gmi_gear_set_tip(gm_gear *gear, double given_radius, double tip_alteration,
                      double normal_module) {
    const double sign = gear->sign;
    const double height = gear->rack_addendum + gear->profile_shift;
    if (isnan(given_radius)) {
        gear->tip_alteration = tip_alteration;
        gear->tip_radius =
            gear->reference_radius + sign * normal_module * (height + tip_alteration);
    } else {
        gear->tip_radius = given_radius;
        gear->tip_alteration =
            sign * (given_radius - gear->reference_radius) / normal_module - height;
    }
    gear->tip_roll_length = gmi_roll_length(gear->tip_radius, gear->base_radius);
}

void gmi_gear_set_start(gm_gear *gear, double start_radius) {
    gear->start_radius = fmax(start_radius, gear->base_radius);
    gear->start_roll_length = gmi_roll_length(start_radius, gear->base_radius);
}

void gmi_gear_set_start_roll_length(gm_gear *gear, double start_roll_length) {
    gear->start_roll_length = fmax(start_roll_length, 0.0);
    gear->start_radius = hypot(gear->base_radius, gear->start_roll_length);
}

/* psi_b = s_t / (2 r) + inv(alpha_t), - for a ring [ISO21771, tooth thickness on the base circle]. */
void gmi_gear_set_thickness(gm_gear *gear, double normal_thickness, double helix_angle,
                            double transverse_pressure_angle) {
    const double transverse_thickness = normal_thickness / cos(helix_angle);
    gear->normal_thickness = normal_thickness;
    gear->base_half_thickness = 0.5 * transverse_thickness / gear->reference_radius +
                                gear->sign * gmi_involute(transverse_pressure_angle);
}

/*
 * s_ta = 2 r_a (psi_b - inv(alpha_a)), + for a ring, with tan(alpha_a) = rho_a / r_b; s_na = s_ta cos(beta_a) with
 * tan(beta_a) = tan(beta) r_a / r, as the lead is the same on every cylinder [ISO21771].
 */
void gmi_gear_set_tip_thickness(gm_gear *gear, double helix_angle) {
    const double tip_pressure_angle = atan2(gear->tip_roll_length, gear->base_radius);
    const double tip_helix = atan(tan(helix_angle) * gear->tip_radius / gear->reference_radius);
    const double half_angle =
        gear->base_half_thickness - gear->sign * gmi_involute(tip_pressure_angle);
    gear->tip_thickness = 2.0 * gear->tip_radius * half_angle;
    gear->normal_tip_thickness = gear->tip_thickness * cos(tip_helix);
}
