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
 * A line exists where both flanks do: rho_p and rho_w between start and tip of their gears. gmi_lines_find() finds the
 * lines of ideal and of measured flanks alike.
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
static void find_limits(const gmi_engagement *at, gmi_lines *lines) {
    const double reach = at->line_of_action + lines->delta; /* rho_p + rho_w */
    const double wheel_tip = reach - at->tip_roll_length[GM_WHEEL];
    const double wheel_start = reach - at->start_roll_length[GM_WHEEL];

    lines->lower = at->start_roll_length[GM_PINION];
    lines->upper = at->tip_roll_length[GM_PINION];
    lines->lower_by_delta = lines->upper_by_delta = 0.0;
    if (wheel_tip > lines->lower) {
        lines->lower = wheel_tip;
        lines->lower_by_delta = 1.0;
    }
    if (wheel_start < lines->upper) {
        lines->upper = wheel_start;
        lines->upper_by_delta = 1.0;
    }
}

void gmi_lines_limit(const gmi_engagement *at, double delta, gmi_lines *lines) {
    lines->delta = delta;
    find_limits(at, lines);
}

void gmi_lines_find(const gm_pair *pair, const gmi_engagement *at, int side,
                    const gm_position *position, gmi_lines *lines) {
    const double direction = gmi_side_sign(side);
    lines->origin = at->phase_origin[side] + direction * position->phase;
    lines->advance = direction * pair->face_advance;
    lines->delta = gmi_ideal_penetration(at, side, position->offset);
    find_limits(at, lines);

    /* Line k covers origin + k p_bt + [fall, rise] of the line of action: those that meet [lower, upper]. */
    const int climbs = lines->advance > 0.0;
    lines->fall = lines->advance * (climbs ? at->face_from : at->face_to);
    lines->rise = lines->advance * (climbs ? at->face_to : at->face_from);
    const double below = lines->lower - lines->origin;
    const double above = lines->upper - lines->origin;
    const double per_pitch = 1.0 / pair->transverse_base_pitch;
    lines->first = -floor_to_int((lines->rise - below) * per_pitch);
    lines->last = floor_to_int((above - lines->fall) * per_pitch);
}

void gmi_lines_widen(const gm_pair *pair, double lower, double upper, gmi_lines *lines) {
    const double per_pitch = 1.0 / pair->transverse_base_pitch;
    lines->lower = lower;
    lines->upper = upper;
    lines->lower_by_delta = lines->upper_by_delta = 0.0;
    lines->first = -floor_to_int((lines->rise - (lower - lines->origin)) * per_pitch);
    lines->last = floor_to_int((upper - lines->origin - lines->fall) * per_pitch);
}

gmi_line_ends gmi_line_ends_find(const gm_pair *pair, const gmi_engagement *at,
                                 const gmi_lines *lines) {
    /* Spur gears: a line is inside as a whole, or not at all. */
    gmi_line_ends ends = {0.0, at->face_from, at->face_to,   0.0,
                          0.0, 0.0,           at->face_from, at->face_to};
    if (lines->advance == 0.0) {
        return ends;
    }

    /* A line that climbs enters at the lower limit, one that falls at the upper one. */
    const double below = lines->lower - lines->origin;
    const double above = lines->upper - lines->origin;
    const int climbs = lines->advance > 0.0;
    ends.per_advance = 1.0 / lines->advance;
    ends.spacing = pair->transverse_base_pitch * ends.per_advance;
    ends.enter = (climbs ? below : above) * ends.per_advance;
    ends.leave = (climbs ? above : below) * ends.per_advance;
    ends.enter_by_delta = climbs ? lines->lower_by_delta : lines->upper_by_delta;
    ends.leave_by_delta = climbs ? lines->upper_by_delta : lines->lower_by_delta;
    return ends;
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
static void add_ideal_moments(const gm_pair *pair, const gmi_engagement *at, const gmi_lines *lines,
                              gmi_side_sum *total) {
    const gmi_line_ends ends = gmi_line_ends_find(pair, at, lines);
    for (int k = lines->first; k <= lines->last; ++k) {
        const gmi_interval part = gmi_line_clip(&ends, k);
        const double length = part.to - part.from;
        if (!(length > 0.0)) {
            continue;
        }
        const double middle = 0.5 * (part.from + part.to);
        const double origin = lines->origin + (double)k * pair->transverse_base_pitch;
        total->contact_t1 += length * middle;
        total->contact_rho += length * (origin + lines->advance * middle);
    }
    total->sum_t1 = lines->delta * total->contact_t1;
    total->sum_rho = lines->delta * total->contact_rho;
}

/*
 * Between ideal flanks the integrand is delta on all lines, so only their length within the limits counts. Line k covers
 * the line of action from start + k p_bt on over the length that a line advances by. The parts below the lower limit grow by p_bt from
 * line to line, and so do those above the upper limit: both are arithmetic series, which are subtracted from the whole.
 */
void gmi_side_sum_ideal(const gm_pair *pair, const gmi_engagement *at, int side,
                        const gm_position *position, int wanted, gmi_side_sum *total) {
    gmi_lines lines;
    gmi_lines_find(pair, at, side, position, &lines);
    const double start = lines.origin + lines.fall;
    const double cover = lines.rise - lines.fall;
    const double face = at->face_to - at->face_from; /* of one line that is not cut */
    const double below = lines.lower - start;
    const double above = lines.upper - start;

    const int count = lines.last - lines.first + 1;
    if (count <= 0 || !(below < above)) {
        return;
    }

    /* Whole lines; what is cut off helical ones is taken away below. */
    total->pairs = count;
    total->contact = (double)count * face;

    if (cover > 0.0) {
        /* How many lines are cut at each limit, and by how much on average. */
        const double pitch = pair->transverse_base_pitch;
        const double per_pitch = 1.0 / pitch;
        const int cut_below = -floor_to_int(-below * per_pitch) - lines.first;
        const int cut_above = lines.last - floor_to_int((above - cover) * per_pitch);
        const double lower_ends = (double)cut_below, upper_ends = (double)cut_above;
        const double mean_below = below - pitch * ((double)lines.first + 0.5 * (lower_ends - 1.0));
        const double mean_above =
            cover - above + pitch * ((double)lines.last - 0.5 * (upper_ends - 1.0));

        /* Rounding may take more than there is where the lines hardly climb. */
        const double per_advance = 1.0 / fabs(lines.advance);
        const double cut = (lower_ends * mean_below + upper_ends * mean_above) * per_advance;
        const double contact = (double)count * face - (cut > 0.0 ? cut : 0.0);
        total->contact = contact > 0.0 ? contact : 0.0;

        /* An end moves with the line's origin, and with delta where the wheel sets the limit. */
        const double flow = lines.delta * per_advance;
        total->by_origin = flow * (lower_ends - upper_ends);
        total->by_delta =
            flow * (upper_ends * lines.upper_by_delta - lower_ends * lines.lower_by_delta);
        if (wanted & GMI_CONTACT_DERIVATIVES) {
            total->contact_by_origin = per_advance * (lower_ends - upper_ends);
            total->contact_by_delta = per_advance * (upper_ends * lines.upper_by_delta -
                                                     lower_ends * lines.lower_by_delta);
        }
    }
    total->by_delta += total->contact;
    total->sum = lines.delta * total->contact;
    if (wanted & GMI_MOMENTS) {
        add_ideal_moments(pair, at, &lines, total);
    }
}
