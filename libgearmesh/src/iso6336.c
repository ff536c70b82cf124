/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Stiffness of teeth from the gear data: ISO 6336-1, method B. A fit to measured and computed steel gears; what it knows
 * of a gear is its number of teeth, profile shift, basic rack, helix angle and blank.
 */
#include "internal.h"

#include <math.h>

/* From a tooth of theory to one of a real gear. */
static const double correction_factor = 0.8; /* C_M */

/* The gear with fewer teeth is 1 in the standard's formulae; of equal ones that with the larger profile shift. */
static int pinion_is_first(const gm_pair *pair) {
    const gm_gear *pinion = &pair->pinion, *wheel = &pair->wheel;
    return pinion->teeth < wheel->teeth ||
           (pinion->teeth == wheel->teeth && pinion->profile_shift >= wheel->profile_shift);
}

/* q', the flexibility of a pair of teeth per face width (mm um / N). */
static double flexibility(const gm_pair *pair) {
    const gm_gear *first = pinion_is_first(pair) ? &pair->pinion : &pair->wheel;
    const gm_gear *second = first == &pair->pinion ? &pair->wheel : &pair->pinion;
    const double x1 = first->profile_shift, x2 = second->profile_shift;

    /* Teeth of the spur gears that the normal section shows: z_n = z / (cos^2(beta_b) cos(beta)). */
    const double cos_base = cos(pair->base_helix_angle);
    const double normal_teeth = 1.0 / (cos_base * cos_base * cos(pair->helix_angle));
    const double z1 = first->teeth * normal_teeth;
    const double z2 = second->sign < 0.0 ? HUGE_VAL /* as the standard wants a ring */
                                         : second->teeth * normal_teeth;

    return 0.04723 + 0.15551 / z1 + 0.25791 / z2 - (0.00635 + 0.11654 / z1) * x1 -
           (0.00193 + 0.24188 / z2) * x2 + 0.00529 * x1 * x1 + 0.00182 * x2 * x2;
}

/* C_B: mean of what the basic racks of both gears give. */
static double rack_factor(const gm_pair *pair) {
    const double dedendum = 0.5 * (pair->pinion.rack_dedendum + pair->wheel.rack_dedendum);
    const double degrees = pair->normal_pressure_angle * (360.0 / GMI_TWO_PI);

    return (1.0 + 0.5 * (1.2 - dedendum)) * (1.0 - 0.02 * (20.0 - degrees));
}

double gm_iso6336_single_stiffness(const gm_pair *pair, double blank_factor) {
    if (pair == NULL || !(blank_factor > 0.0)) {
        return gmi_nan();
    }

    /* Far beyond the gears of the fit there may be nothing left of it. */
    const double q = flexibility(pair), rack = rack_factor(pair);
    if (!(q > 0.0) || !(rack > 0.0)) {
        return gmi_nan();
    }
    const double to_si = 1e9; /* from N/(mm um) to N/m2 */
    return to_si / q * correction_factor * blank_factor * rack * cos(pair->helix_angle);
}

double gm_iso6336_mesh_stiffness(const gm_pair *pair, double blank_factor) {
    const double single = gm_iso6336_single_stiffness(pair, blank_factor);
    return isnan(single) ? single : single * (0.75 * pair->transverse_contact_ratio + 0.25);
}

int gm_iso6336_warnings(const gm_pair *pair) {
    if (pair == NULL) {
        return 0;
    }
    const double x_p = pair->pinion.profile_shift, x_w = pair->wheel.profile_shift;
    const double x1 = pinion_is_first(pair) ? x_p : x_w, x2 = pinion_is_first(pair) ? x_w : x_p;
    const double largest_helix = 45.0 * (GMI_TWO_PI / 360.0);

    int warnings = 0;
    if (x1 < x2) {
        warnings |= GM_WARN_ISO6336_SHIFT_ORDER;
    }
    if (!(x1 + x2 >= -0.5 && x1 + x2 <= 2.0)) {
        warnings |= GM_WARN_ISO6336_SHIFT_SUM;
    }
    if (fabs(pair->helix_angle) > largest_helix) {
        warnings |= GM_WARN_ISO6336_HELIX;
    }
    return warnings;
}
