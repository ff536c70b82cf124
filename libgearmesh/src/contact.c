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
typedef struct limits {
    double lower, upper;
    double lower_by_delta, upper_by_delta;
} limits;

static limits find_limits(const gm_pair *pair, double delta) {
    const double reach = pair->line_of_action + delta; /* rho_p + rho_w */
    const double wheel_tip = reach - pair->wheel.tip_roll_length;
    const double wheel_start = reach - pair->wheel.start_roll_length;
    limits found = {pair->pinion.start_roll_length, pair->pinion.tip_roll_length, 0.0, 0.0};
    if (wheel_tip > found.lower) {
        found.lower = wheel_tip;
        found.lower_by_delta = 1.0;
    }
    if (wheel_start < found.upper) {
        found.upper = wheel_start;
        found.upper_by_delta = 1.0;
    }
    return found;
}

/* Where line 0 enters and leaves the flanks as t1 grows, and which lines do so within the face. */
static void find_ends(const gm_pair *pair, const limits *range, gmi_lines *lines) {
    const double below = range->lower - lines->origin;
    const double above = range->upper - lines->origin;
    const double per_pitch = 1.0 / pair->transverse_base_pitch;
    if (lines->twist == 0.0) { /* spur: a line is inside as a whole, or not at all */
        lines->per_twist = lines->enter = lines->spacing = 0.0;
        lines->leave = 1.0;
        lines->enter_by_delta = lines->leave_by_delta = 0.0;
        lines->first = -floor_to_int(-below * per_pitch);
        lines->last = floor_to_int(above * per_pitch);
        return;
    }
    lines->per_twist = 1.0 / lines->twist;
    lines->spacing = pair->transverse_base_pitch * lines->per_twist;
    const int climbs = lines->twist > 0.0;
    lines->enter = (climbs ? below : above) * lines->per_twist;
    lines->leave = (climbs ? above : below) * lines->per_twist;
    lines->enter_by_delta = climbs ? range->lower_by_delta : range->upper_by_delta;
    lines->leave_by_delta = climbs ? range->upper_by_delta : range->lower_by_delta;
    const double rise = climbs ? lines->twist : 0.0;
    const double fall = climbs ? 0.0 : lines->twist;
    lines->first = -floor_to_int((rise - below) * per_pitch);
    lines->last = floor_to_int((above - fall) * per_pitch);
}

static inline void find_lines(const gm_pair *pair, int side, const gm_position *position,
                              gmi_lines *lines) {
    const double direction = side == GM_DRIVE ? 1.0 : -1.0;
    lines->origin = pair->phase_origin + direction * position->phase;
    lines->twist = direction * pair->twist;
    lines->delta = gmi_ideal_penetration(pair, side, position->offset);
    const limits range = find_limits(pair, lines->delta);
    find_ends(pair, &range, lines);
}

void gmi_lines_find(const gm_pair *pair, int side, const gm_position *position, gmi_lines *lines) {
    find_lines(pair, side, position, lines);
}

gmi_teeth gmi_lines_teeth(const gm_pair *pair, int side, const gm_position *position,
                          const gmi_lines *lines) {
    gmi_teeth teeth = {position->pinion_tooth, position->wheel_tooth, 1};
    if (side == GM_COAST) {
        teeth.wheel -= 1; /* the coast flank of pinion tooth i meets wheel tooth i - 1 */
        teeth.step = -1;
    }
    teeth.pinion = wrap_tooth(teeth.pinion + teeth.step * lines->first, pair->pinion.teeth);
    teeth.wheel = wrap_tooth(teeth.wheel + teeth.step * lines->first, pair->wheel.teeth);
    return teeth;
}

/*
 * Between ideal flanks the integrand is delta on all lines, so only their lengths count. An end that a limit of the flanks
 * sets moves with the line's origin and with delta, see add_end_derivatives() of penetration.c.
 */
void gmi_side_sum_ideal(const gm_pair *pair, int side, const gm_position *position, int wanted,
                        gmi_side_sum *total) {
    gmi_lines lines;
    int moving_from = 0, moving_to = 0; /* lines that begin or end within the face */
    double contact = 0.0, contact_t1 = 0.0, contact_rho = 0.0;
    int pairs = 0;

    find_lines(pair, side, position, &lines);
    for (int k = lines.first; k <= lines.last; ++k) {
        const gmi_interval part = gmi_line_clip(&lines, k);
        const double length = part.to - part.from;
        if (!(length > 0.0))
            continue;
        contact += length;
        pairs += 1;
        moving_from += part.from > 0.0;
        moving_to += part.to < 1.0;
        if (wanted & GMI_MOMENTS) {
            const double middle = 0.5 * (part.from + part.to);
            contact_t1 += length * middle;
            contact_rho += length * (lines.origin + (double)k * pair->transverse_base_pitch +
                                     lines.twist * middle);
        }
    }
    total->contact = contact;
    total->contact_t1 = contact_t1;
    total->contact_rho = contact_rho;
    total->sum = lines.delta * contact;
    total->sum_t1 = lines.delta * contact_t1;
    total->sum_rho = lines.delta * contact_rho;
    total->pairs = pairs;

    const double flow = lines.delta * lines.per_twist; /* through one end */
    total->by_origin = flow * (double)(moving_from - moving_to);
    total->by_delta = contact + flow * ((double)moving_to * lines.leave_by_delta -
                                        (double)moving_from * lines.enter_by_delta);
}
