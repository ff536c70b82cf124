/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Which lines of contact exist on a plane of action, and where [Paper, sections 4.2-4.4, Eqs. 18-20].
 *
 * Drive side: rho_p of pair i at face position t1 is r_bp (alpha_wt + psi_bp + phi_p) + i p_bt + twist t1
 * (Eq. 18 with the working angle and the base half thickness), and on the wheel rho_w = T0 + delta - rho_p
 * with the same delta = x - backlash / 2 for every pair and t1 (Eqs. 20-23). Coast side: the mirror image,
 * phi_p and twist change their signs, so pair i becomes line -i, and delta = -x - backlash / 2.
 *
 * A line exists where both flanks do: rho_p and rho_w between start and tip of their gears.
 */
#include "internal.h"

#include <math.h>

/* Largest whole number <= value; |value| is bounded by the total contact ratio. */
static int floor_to_int(double value) {
    const int truncated = (int)value;
    return truncated - (value < (double)truncated);
}

static int wrap_tooth(int tooth, int teeth) {
    while (tooth < 0)
        tooth += teeth;
    while (tooth >= teeth)
        tooth -= teeth;
    return tooth;
}

/* Limits of rho_p: those of the pinion, and those of the wheel seen from the pinion. */
static void find_limits(const gm_pair *pair, gmi_lines *lines) {
    const double reach = pair->line_of_action + lines->delta; /* rho_p + rho_w */
    const double wheel_tip = reach - pair->wheel.tip_roll_length;
    const double wheel_start = reach - pair->wheel.start_roll_length;
    lines->lower_by_delta = wheel_tip > pair->pinion.start_roll_length ? 1.0 : 0.0;
    lines->lower =
        wheel_tip > pair->pinion.start_roll_length ? wheel_tip : pair->pinion.start_roll_length;
    lines->upper_by_delta = wheel_start < pair->pinion.tip_roll_length ? 1.0 : 0.0;
    lines->upper =
        wheel_start < pair->pinion.tip_roll_length ? wheel_start : pair->pinion.tip_roll_length;
}

double gmi_ideal_penetration(const gm_pair *pair, int side, double offset) {
    return (side == GM_DRIVE ? offset : -offset) - 0.5 * pair->backlash;
}

void gmi_lines_find(const gm_pair *pair, int side, const gm_position *position, gmi_lines *lines) {
    int wheel_tooth = position->wheel_tooth;
    if (side == GM_DRIVE) {
        lines->origin = pair->phase_origin + position->phase;
        lines->twist = pair->twist;
        lines->tooth_step = 1;
    } else {
        lines->origin = pair->phase_origin - position->phase;
        lines->twist = -pair->twist;
        lines->tooth_step = -1;
        wheel_tooth -= 1; /* the coast flank of pinion tooth i meets wheel tooth i - 1 */
    }
    lines->per_twist = 1.0 / lines->twist;
    lines->delta = gmi_ideal_penetration(pair, side, position->offset);
    find_limits(pair, lines);

    /* Lines whose rho_p reaches into [lower, upper] for some t1 in [0, 1]. */
    const double per_pitch = 1.0 / pair->transverse_base_pitch;
    const double highest = lines->twist > 0.0 ? lines->origin + lines->twist : lines->origin;
    const double lowest = lines->twist < 0.0 ? lines->origin + lines->twist : lines->origin;
    lines->first = -floor_to_int((highest - lines->lower) * per_pitch);
    lines->last = floor_to_int((lines->upper - lowest) * per_pitch);
    lines->pinion_tooth =
        wrap_tooth(position->pinion_tooth + lines->tooth_step * lines->first, pair->pinion.teeth);
    lines->wheel_tooth =
        wrap_tooth(wheel_tooth + lines->tooth_step * lines->first, pair->wheel.teeth);
}
