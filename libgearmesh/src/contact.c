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
#include "contact.h"

#include "internal.h"
#include "meshing.h"

#include <math.h>

static int wrap_tooth(int tooth, int teeth) {
    while (tooth < 0) {
        tooth += teeth;
    }
    while (tooth >= teeth) {
        tooth -= teeth;
    }
    return tooth;
}

void gmi_lines_limit(const gmi_engagement *at, double delta, gmi_lines *lines) {
    lines->delta = delta;
    gmi_find_limits(at, lines);
}

void gmi_lines_find(const gm_pair *pair, const gmi_engagement *at, int side,
                    const gm_position *position, gmi_lines *lines) {
    gmi_find_lines(pair, at, side, position, lines);
}

void gmi_lines_widen(const gm_pair *pair, double lower, double upper, gmi_lines *lines) {
    const double per_pitch = 1.0 / pair->transverse_base_pitch;
    lines->lower = lower;
    lines->upper = upper;
    lines->lower_by_delta = lines->upper_by_delta = 0.0;
    lines->first = -gmi_floor((lines->rise - (lower - lines->origin)) * per_pitch);
    lines->last = gmi_floor((upper - lines->origin - lines->fall) * per_pitch);
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

void gmi_add_ideal_moments(const gm_pair *pair, const gmi_engagement *at, const gmi_lines *lines,
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

void gmi_side_sum_ideal(const gm_pair *pair, const gmi_engagement *at, int side,
                        const gm_position *position, int wanted, gmi_side_sum *total) {
    gmi_sum_ideal(pair, at, side, position, wanted, total);
}
