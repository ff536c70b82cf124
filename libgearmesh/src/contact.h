/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Of contact.c what evaluations inline: the lines of a side, and their sum between ideal flanks. */
#ifndef GEARMESH_CONTACT_H
#define GEARMESH_CONTACT_H

#include "internal.h"

/* Largest whole number <= value; |value| is bounded by the total contact ratio. */
static inline int gmi_floor(double value) {
    const int truncated = (int)value;
    return truncated - (value < (double)truncated);
}

/* Limits of rho_p: those of the pinion, and those of the wheel seen from the pinion. */
SPECIALIZED void gmi_find_limits(const gmi_engagement *at, gmi_lines *lines) {
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

SPECIALIZED void gmi_find_lines(const gm_pair *pair, const gmi_engagement *at, int side,
                                const gm_position *position, gmi_lines *lines) {
    const double direction = gmi_side_sign(side);
    lines->origin = at->phase_origin[side] + direction * position->phase;
    lines->advance = direction * pair->face_advance;
    lines->delta = gmi_ideal_penetration(at, side, position->offset);
    gmi_find_limits(at, lines);

    /* Line k covers origin + k p_bt + [fall, rise] of the line of action: those that meet [lower, upper]. */
    const int climbs = lines->advance > 0.0;
    lines->fall = lines->advance * (climbs ? at->face_from : at->face_to);
    lines->rise = lines->advance * (climbs ? at->face_to : at->face_from);
    const double below = lines->lower - lines->origin;
    const double above = lines->upper - lines->origin;
    const double per_pitch = 1.0 / pair->transverse_base_pitch;
    lines->first = -gmi_floor((lines->rise - below) * per_pitch);
    lines->last = gmi_floor((above - lines->fall) * per_pitch);
}

/* First moments between ideal flanks: of 1 over t1 and rho_p; delta times them for the sum. */
void gmi_add_ideal_moments(const gm_pair *pair, const gmi_engagement *at, const gmi_lines *lines,
                           gmi_side_sum *total);

/*
 * Between ideal flanks the integrand is delta on all lines, so only their length within the limits counts. Line k covers
 * the line of action from start + k p_bt on over the length that a line advances by. The parts below the lower limit grow
 * by p_bt from line to line, and so do those above the upper limit: both are arithmetic series, which are subtracted from
 * the whole.
 */
SPECIALIZED void gmi_sum_ideal(const gm_pair *pair, const gmi_engagement *at, int side,
                               const gm_position *position, int wanted, gmi_side_sum *total) {
    gmi_lines lines;
    gmi_find_lines(pair, at, side, position, &lines);
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
    double contact = (double)count * face;
    double per_advance = 0.0, lower_ends = 0.0, upper_ends = 0.0;
    if (cover > 0.0) {
        /* How many lines are cut at each limit, and by how much on average. */
        const double pitch = pair->transverse_base_pitch;
        const double per_pitch = 1.0 / pitch;
        const int cut_below = -gmi_floor(-below * per_pitch) - lines.first;
        const int cut_above = lines.last - gmi_floor((above - cover) * per_pitch);
        lower_ends = (double)cut_below;
        upper_ends = (double)cut_above;
        const double mean_below = below - pitch * ((double)lines.first + 0.5 * (lower_ends - 1.0));
        const double mean_above =
            cover - above + pitch * ((double)lines.last - 0.5 * (upper_ends - 1.0));

        /* Rounding may take more than there is where the lines hardly climb. */
        per_advance = 1.0 / fabs(lines.advance);
        const double cut = (lower_ends * mean_below + upper_ends * mean_above) * per_advance;
        contact = gmi_larger(contact - gmi_larger(cut, 0.0), 0.0);
    }
    total->pairs = count;
    total->contact = contact;
    total->sum = lines.delta * contact;

    /* An end moves with the line's origin, and with delta where the wheel sets the limit. */
    const double by_origin = per_advance * (lower_ends - upper_ends);
    const double by_delta =
        per_advance * (upper_ends * lines.upper_by_delta - lower_ends * lines.lower_by_delta);
    if (wanted & GMI_DERIVATIVES) {
        total->by_origin = lines.delta * by_origin;
        total->by_delta = lines.delta * by_delta + contact;
    }
    if (wanted & GMI_CONTACT_DERIVATIVES) {
        total->contact_by_origin = by_origin;
        total->contact_by_delta = by_delta;
    }
    if (wanted & GMI_MOMENTS) {
        gmi_add_ideal_moments(pair, at, &lines, total);
    }
}

#endif
