/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Which lines of contact exist on one side, and where; and their sum between ideal flanks, inlined where the library
 * evaluates.
 */
#ifndef GEARMESH_CONTACT_H
#define GEARMESH_CONTACT_H

#include "internal.h"
#include "meshing.h"

/* What an evaluation accumulates beside sum, contact and pairs: a mask. */
enum gmi_wanted {
    GMI_SUM = 0,
    GMI_DERIVATIVES = 1,         /* of the sum, by the origin of the lines and by delta */
    GMI_MOMENTS = 2,             /* first moments over t1 and rho_p */
    GMI_ROLL = 8,                /* what a common roll of all lines does to the energy */
    GMI_CONTACT_DERIVATIVES = 4, /* of the touching part; only together with GMI_DERIVATIVES */
    GMI_TANGENT = 16,            /* all of gmi_side_tangent; only together with GMI_MOMENTS */
    GMI_DEPTHS = 32,    /* gmi_depths in place of the sums; only together with GMI_DERIVATIVES */
    GMI_SQUARES = 64,   /* the sum is that of the overlap squared (m2), and nothing else is there */
    GMI_STRETCHES = 128 /* where the flanks touch along a line, in place of the sums */
};

/* The sums over all lines of one side. */
typedef struct gmi_side_sum {
    double sum;     /* sum of the integrals of max(0, delta) dt1 (m) */
    double contact; /* touching part of the face width, summed (1) */
    int pairs;      /* lines that touch; -1: not counted */

    /* Partial derivatives by the origin of the lines and by delta: */
    double by_origin, by_delta; /* of the sum (GMI_DERIVATIVES) (1) */
    double contact_by_origin,
        contact_by_delta; /* of the touching part (GMI_CONTACT_DERIVATIVES) (1/m) */

    /* GMI_MOMENTS: integrals over the touching part. */
    double sum_t1;      /* of max(0, delta) t1 (m) */
    double sum_rho;     /* of max(0, delta) rho_p (m2) */
    double contact_t1;  /* of t1 (1) */
    double contact_rho; /* of rho_p (m) */

    /* GMI_ROLL: energy by a common roll of all lines, over the stiffness; 0 with constant stiffness (m) */
    double roll;
} gmi_side_sum;

static inline gmi_side_sum gmi_no_contact(void) {
    const gmi_side_sum none = {0.0, 0.0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    return none;
}

/* +1 for drive flanks, -1 for coast flanks: the coast side is the drive side seen in a mirror. */
static inline double gmi_side_sign(int side) {
    return side == GM_DRIVE ? 1.0 : -1.0;
}

/*
 * The lines of contact of one side (drive or coast) on its plane of action. Line k follows
 *     rho_p(t1) = origin + k p_bt + advance t1,
 * the distance from the pinion's base tangent point, and exists where lower <= rho_p <= upper.
 */
typedef struct gmi_lines {
    double delta;        /* ideal penetration, the same on every line (m) */
    double origin;       /* (m) */
    double advance;      /* (m) */
    double lower, upper; /* limits of rho_p (m) */

    /* 1 where the wheel sets the limit, so that it moves with delta; else 0 */
    double lower_by_delta;

    double upper_by_delta;
    double fall, rise; /* a line covers origin + [fall, rise] of the line of action (m) */
    int first, last;   /* lines that can exist, none if first > last */
} gmi_lines;

/* Where the lines enter and leave the flanks as t1 grows: line k at enter - k spacing and leave - k spacing. */
typedef struct gmi_line_ends {
    /* 1 / advance; 0 for spur gears, whose lines have no ends within the face (1/m) */
    double per_advance;

    double enter, leave, spacing;
    double enter_by_delta, leave_by_delta; /* 1 where the end moves with delta, else 0 */
    double face_from, face_to;             /* where the face begins and ends */
} gmi_line_ends;

/* The teeth of line `first`, and how they go on: step = +1 or -1 from line k to line k + 1. */
typedef struct gmi_teeth {
    int pinion, wheel;
    int step;
} gmi_teeth;

/* The tooth after this one, or before it. */
static inline int gmi_next_tooth(int tooth, int step, int teeth) {
    const int next = tooth + step;
    return next < 0 ? teeth - 1 : next == teeth ? 0 : next;
}

/* Ideal penetration of one side at x: x - backlash / 2, or -x - backlash / 2 [Paper, Eqs. 10, 20]. */
static inline double gmi_ideal_penetration(const gmi_engagement *at, int side, double offset) {
    return (side == GM_DRIVE ? offset : -offset) - 0.5 * at->backlash;
}

void gmi_lines_find(const gm_pair *pair, const gmi_engagement *at, int side,
                    const gm_position *position, gmi_lines *lines);

/* The same lines with other limits: also those that meet these. */
void gmi_lines_widen(const gm_pair *pair, double lower, double upper, gmi_lines *lines);

/* The same lines at another delta, which moves their limits. */
void gmi_lines_limit(const gmi_engagement *at, double delta, gmi_lines *lines);
gmi_line_ends gmi_line_ends_find(const gm_pair *pair, const gmi_engagement *at,
                                 const gmi_lines *lines);
gmi_teeth gmi_lines_teeth(const gm_pair *pair, int side, const gm_position *position,
                          const gmi_lines *lines);
void gmi_side_sum_ideal(const gm_pair *pair, const gmi_engagement *at, int side,
                        const gm_position *position, int wanted, gmi_side_sum *total);

/* Part of t1 in which line k exists; empty if from >= to. */
typedef struct gmi_interval {
    double from, to;
} gmi_interval;

static inline gmi_interval gmi_line_clip(const gmi_line_ends *ends, int k) {
    const double shift = (double)k * ends->spacing;
    const double enter = ends->enter - shift;
    const double leave = ends->leave - shift;
    const gmi_interval part = {enter > ends->face_from ? enter : ends->face_from,
                               leave < ends->face_to ? leave : ends->face_to};
    return part;
}

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
