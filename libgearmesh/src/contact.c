/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Which lines of contact exist on a plane of action, and where [Paper, sections 4.2-4.4, Eqs. 18-20].
 *
 * Drive side: rho_p of pair i at face position t1 is r_bp (alpha_wt + psi_bp + phi_p) + i p_bt + advance t1
 * (Eq. 18 with the working angle and the base half thickness), and on the wheel rho_w = T0 + delta - rho_p
 * with the same delta = x - backlash / 2 for every pair and t1 (Eqs. 20-23). Coast side: the mirror image,
 * phi_p and advance change their signs, so pair i becomes line -i, and delta = -x - backlash / 2.
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
    while (tooth < 0) {
        tooth += teeth;
    }
    while (tooth >= teeth) {
        tooth -= teeth;
    }
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
    if (lines->advance == 0.0) { /* spur: a line is inside as a whole, or not at all */
        lines->per_advance = lines->enter = lines->spacing = 0.0;
        lines->leave = 1.0;
        lines->enter_by_delta = lines->leave_by_delta = 0.0;
        lines->first = -floor_to_int(-below * per_pitch);
        lines->last = floor_to_int(above * per_pitch);
        return;
    }
    lines->per_advance = 1.0 / lines->advance;
    lines->spacing = pair->transverse_base_pitch * lines->per_advance;
    const int climbs = lines->advance > 0.0;
    lines->enter = (climbs ? below : above) * lines->per_advance;
    lines->leave = (climbs ? above : below) * lines->per_advance;
    lines->enter_by_delta = climbs ? range->lower_by_delta : range->upper_by_delta;
    lines->leave_by_delta = climbs ? range->upper_by_delta : range->lower_by_delta;
    const double rise = climbs ? lines->advance : 0.0;
    const double fall = climbs ? 0.0 : lines->advance;
    lines->first = -floor_to_int((rise - below) * per_pitch);
    lines->last = floor_to_int((above - fall) * per_pitch);
}

void gmi_lines_find(const gm_pair *pair, int side, const gm_position *position, gmi_lines *lines) {
    const double direction = side == GM_DRIVE ? 1.0 : -1.0;
    lines->origin = pair->phase_origin[side] + direction * position->phase;
    lines->advance = direction * pair->face_advance;
    lines->delta = gmi_ideal_penetration(pair, side, position->offset);
    const limits range = find_limits(pair, lines->delta);
    find_ends(pair, &range, lines);
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

/* First moments between ideal flanks: of 1 over t1 and rho_p; delta times them for the sum. */
static void add_ideal_moments(const gm_pair *pair, int side, const gm_position *position,
                              gmi_side_sum *total) {
    gmi_lines lines;
    gmi_lines_find(pair, side, position, &lines);
    for (int k = lines.first; k <= lines.last; ++k) {
        const gmi_interval part = gmi_line_clip(&lines, k);
        const double length = part.to - part.from;
        if (!(length > 0.0)) {
            continue;
        }
        const double middle = 0.5 * (part.from + part.to);
        const double origin = lines.origin + (double)k * pair->transverse_base_pitch;
        total->contact_t1 += length * middle;
        total->contact_rho += length * (origin + lines.advance * middle);
    }
    total->sum_t1 = lines.delta * total->contact_t1;
    total->sum_rho = lines.delta * total->contact_rho;
}

/*
 * Between ideal flanks the integrand is delta on all lines, so only their length counts. Line k covers the line of action
 * from start + k p_bt on over the advance, and what of that lies beyond the limits is cut off: sums of arithmetic series.
 * An end within the face moves with the line's origin, and with delta if it is the wheel's.
 */
void gmi_side_sum_ideal(const gm_pair *pair, int side, const gm_position *position, int wanted,
                        gmi_side_sum *total) {
    const double direction = side == GM_DRIVE ? 1.0 : -1.0;
    const double delta = gmi_ideal_penetration(pair, side, position->offset);
    const limits range = find_limits(pair, delta);
    const double advance = direction * pair->face_advance;
    const double start =
        pair->phase_origin[side] + direction * position->phase + (advance < 0.0 ? advance : 0.0);
    const double cover = fabs(advance);
    const double below = range.lower - start;
    const double above = range.upper - start;
    const double pitch = pair->transverse_base_pitch;
    const double per_pitch = 1.0 / pitch;

    const int first = -floor_to_int((cover - below) * per_pitch);
    const int last = floor_to_int(above * per_pitch);
    const int lines = last - first + 1;
    if (lines <= 0 || !(below < above)) {
        return;
    }
    total->pairs = lines;
    total->contact = (double)lines;
    if (cover > 0.0) {
        const double per_cover = 1.0 / cover;
        const int cut_below = -floor_to_int(-below * per_pitch) - first; /* lines cut there */
        const int cut_above = last - floor_to_int((above - cover) * per_pitch);
        const double lower_ends = (double)cut_below, upper_ends = (double)cut_above;
        const double mean_below = below - pitch * ((double)first + 0.5 * (lower_ends - 1.0));
        const double mean_above = cover - above + pitch * ((double)last - 0.5 * (upper_ends - 1.0));
        const double cut = (lower_ends * mean_below + upper_ends * mean_above) * per_cover;
        const double contact = (double)lines - (cut > 0.0 ? cut : 0.0);
        total->contact = contact > 0.0 ? contact : 0.0; /* rounding: next to no helix */

        const double flow = delta * per_cover; /* through one end */
        total->by_origin = flow * (lower_ends - upper_ends);
        total->by_delta =
            flow * (upper_ends * range.upper_by_delta - lower_ends * range.lower_by_delta);
    }
    total->by_delta += total->contact;
    total->sum = delta * total->contact;
    if (wanted & GMI_MOMENTS) {
        add_ideal_moments(pair, side, position, total);
    }
}
