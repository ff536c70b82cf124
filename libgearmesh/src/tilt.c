/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Axes that are tilted against each other: what the overlap of a pair of flanks is along one line of contact, and where
 * the line ends.
 *
 * In the frame of the line of action e, the direction t across it and the axis k, the wheel's axis is at
 * -rho_w e - r_bw t from a point P of the line. So the wheel's rotation vector enters by its parts along e and across it,
 * and by two straight lines along t1, zeta = z of P from the middle O of the wheel's face and u = zeta - tau rho_w, with
 * tau = tan(beta_b). The signs of a and g make both sides of the teeth alike: a = -+theta.e, g = -+theta.t. To second
 * order, libgearmesh/docs/equations.md derives it,
 *
 *     overlap = (1 + tau g) (delta - g u - tau a r_bw)
 *             + (g^2 (rho_w + tau zeta) - a g r_bw - a^2 u (tau + u / T)) / 2.
 *
 * A line ends where either gear's own flank does: by the roll lengths of the points that touch, which exceed those of
 * P, and by their place along each gear's own face, which the tilt moves on the wheel:
 *
 *     pinion's roll length  rho_p - a r_bp u / T,     wheel's  rho_w + delta - a r_bw (u / T + 2 tau) + tau g rho_w,
 *     wheel's own z         zeta - g rho_w + a r_bw.
 *
 * All of them are straight along t1, so that each sets one end of the line at most.
 */
#include "tilt.h"

#include "contact.h"
#include "internal.h"
#include "line.h"
#include "meshing.h"

#include <math.h>

/* at_zero + per_t1 t1 */
typedef struct straight {
    double at_zero, per_t1;
} straight;

static inline double value_at(straight line, double t1) {
    return line.at_zero + line.per_t1 * t1;
}

/* a + factor b + constant */
static inline straight combined(straight a, double factor, straight b, double constant) {
    const straight result = {a.at_zero + factor * b.at_zero + constant,
                             a.per_t1 + factor * b.per_t1};
    return result;
}

/* One line in these terms. */
typedef struct tilted {
    double a, g, tau;
    double length, r_bp, r_bw;
    straight rho_p, rho_w, zeta, u;
} tilted;

SPECIALIZED tilted tilted_of(const gm_pair *pair, const gmi_engagement *at, int side,
                             double rho_origin) {
    const double advance = gmi_side_sign(side) * pair->face_advance;
    tilted line;
    line.a = at->along[side];
    line.g = at->across[side];
    line.tau = advance / pair->face_width;
    line.length = at->line_of_action;
    line.r_bp = pair->pinion.base_radius;
    line.r_bw = at->wheel_base_radius;
    line.rho_p = (straight){rho_origin, advance};
    line.rho_w = (straight){line.length - rho_origin, -advance};
    line.zeta = (straight){pair->face_start - at->face_center, pair->face_width};
    line.u = combined(line.zeta, -line.tau, line.rho_w, 0.0);
    return line;
}

/* ---------------------------------------------------------------------------------------------
 * The ends of a line
 * ------------------------------------------------------------------------------------------- */

/* In place of how much a place climbs that stays the same along the line: then it is far off on one side or the other. */
#define SMALLEST_CLIMB 1e-200

/* A roll length of a ring that no pinion reaches (m). */
#define BEYOND_ANY_ROOT 1e30

/* What ends a line: a place on either gear, between two limits. Tables are read where parallel axes would touch. */
enum { ROLL_PINION, ROLL_WHEEL, FACE_PINION, FACE_WHEEL, TABLE_PINION, TABLE_WHEEL };

SPECIALIZED straight place_of(const gm_pair *pair, const tilted *line, double delta, int place) {
    const double a = line->a, g = line->g, tau = line->tau;
    const straight rho_w = {line->rho_w.at_zero + delta, line->rho_w.per_t1};
    switch (place) {
    case ROLL_PINION:
        return combined(line->rho_p, -a * line->r_bp / line->length, line->u, 0.0);
    case ROLL_WHEEL:
        return combined(combined(rho_w, tau * g, line->rho_w, -2.0 * tau * a * line->r_bw),
                        -a * line->r_bw / line->length, line->u, 0.0);
    case FACE_PINION:
        return (straight){pair->face_start, pair->face_width};
    case FACE_WHEEL:
        return combined(line->zeta, -g, line->rho_w, a * line->r_bw);
    case TABLE_PINION:
        return line->rho_p;
    default:
        return rho_w;
    }
}

/*
 * Where a gear's own flank starts. A start that the drawing does not give is where the mate's tip touches, which between
 * tilted axes is elsewhere at each z: there the tip ends the line by itself, and the flank starts at the base circle, that
 * of a ring at its root.
 */
SPECIALIZED double start_of(const gm_gear *gear, const gmi_engagement *at, int role) {
    if (!at->is_tilted || gear->start_is_given) {
        return at->start_roll_length[role];
    }
    return gear->sign < 0.0 ? -BEYOND_ANY_ROOT : 0.0;
}

/*
 * Where lines end at the start of a table. Where the path of parallel axes begins deeper, they go on to the mate's tip, which
 * the tilt moves by some micrometres: the limit is twice as deep as that path, which leaves it this room, so that nothing
 * jumps as a pose begins to take lines deeper.
 */
SPECIALIZED double table_start_of(double drawn, const gmi_engagement *at, int role) {
    return at->starts_deeper[role] ? 2.0 * at->start_roll_length[role] - drawn : drawn;
}

SPECIALIZED gmi_interval limits_of(const gm_pair *pair, const gmi_engagement *at, int place) {
    const gm_gear *pinion = &pair->pinion, *wheel = &pair->wheel;
    switch (place) {
    case ROLL_PINION:
        return (gmi_interval){start_of(pinion, at, GM_PINION), at->tip_roll_length[GM_PINION]};
    case ROLL_WHEEL:
        return (gmi_interval){start_of(wheel, at, GM_WHEEL), at->tip_roll_length[GM_WHEEL]};
    case FACE_PINION:
        return (gmi_interval){0.0, pinion->face_width};
    case FACE_WHEEL:
        return (gmi_interval){-0.5 * wheel->face_width, 0.5 * wheel->face_width};
    case TABLE_PINION:
        return (gmi_interval){table_start_of(pinion->start_roll_length, at, GM_PINION),
                              at->tip_roll_length[GM_PINION]};
    default:
        return (gmi_interval){table_start_of(at->wheel_profile_start, at, GM_WHEEL),
                              at->tip_roll_length[GM_WHEEL]};
    }
}

/* Partial derivatives of a place at fixed t1, by what moves a side. */
static void place_gradient(const tilted *line, double t1, int place, double by[GMI_COORDINATES]) {
    const double a = line->a, g = line->g, tau = line->tau;
    const double u = value_at(line->u, t1);
    const double rho_w = value_at(line->rho_w, t1);
    const double p = line->r_bp / line->length, q = line->r_bw / line->length;

    /* Each place moves with some of the coordinates. */
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        by[k] = 0.0;
    }
    switch (place) {
    case ROLL_PINION:
        by[GMI_BY_ORIGIN] = 1.0 - p * a * tau;
        by[GMI_BY_LENGTH] = p * a * (tau + u / line->length);
        by[GMI_BY_ALONG] = -p * u;
        by[GMI_BY_AXIAL] = p * a;
        break;

    case ROLL_WHEEL:
        by[GMI_BY_ORIGIN] = -1.0 - tau * g - q * a * tau;
        by[GMI_BY_DELTA] = 1.0;
        by[GMI_BY_LENGTH] = 1.0 + tau * g + q * a * (tau + u / line->length);
        by[GMI_BY_ALONG] = -2.0 * tau * line->r_bw - q * u;
        by[GMI_BY_ACROSS] = tau * rho_w;
        by[GMI_BY_AXIAL] = q * a;
        break;

    case FACE_WHEEL:
        by[GMI_BY_ORIGIN] = g;
        by[GMI_BY_LENGTH] = -g;
        by[GMI_BY_ALONG] = line->r_bw;
        by[GMI_BY_ACROSS] = -rho_w;
        by[GMI_BY_AXIAL] = -1.0;
        break;

    case TABLE_PINION:
        by[GMI_BY_ORIGIN] = 1.0;
        break;

    case TABLE_WHEEL:
        by[GMI_BY_ORIGIN] = -1.0;
        by[GMI_BY_DELTA] = by[GMI_BY_LENGTH] = 1.0;
        break;

    default:
        break;
    }
}

/* The t1 at which a place meets its limit: d t1 = (d limit - d place) / (d place / d t1). */
static void set_end(const gm_pair *pair, const gmi_engagement *at, const tilted *line, double delta,
                    double t1, int place, int is_beginning, double by[GMI_COORDINATES]) {
    const double per_t1 = place_of(pair, line, delta, place).per_t1;
    const int is_lower = is_beginning == (per_t1 > 0.0);
    place_gradient(line, t1, place, by);
    if (is_lower && !at->is_tilted && (place == ROLL_PINION || place == ROLL_WHEEL)) {
        by[GMI_BY_LENGTH] -= at->start_follows[place == ROLL_PINION ? GM_PINION : GM_WHEEL];
    }
    if (is_lower && (place == TABLE_PINION || place == TABLE_WHEEL)) {
        const int role = place == TABLE_PINION ? GM_PINION : GM_WHEEL;
        by[GMI_BY_LENGTH] -= 2.0 * (at->starts_deeper[role] && at->start_follows[role]);
    }
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        by[k] /= -per_t1;
    }
}

/* Where a place enters its limits on the line with rho_p = 0 at t1 = 0, where it leaves them, and how both move. */
static void set_cut(const gm_pair *pair, const gmi_engagement *at, const tilted *line, double delta,
                    int place, double by_origin, gmi_tilt_cuts *cuts) {
    const straight own = place_of(pair, line, delta, place);
    const gmi_interval limits = limits_of(pair, at, place);

    /* A place that climbs enters at its lower limit, one that falls at the upper one; one that stays, always or never. */
    const double per_place = 1.0 / (own.per_t1 != 0.0 ? own.per_t1 : SMALLEST_CLIMB);
    const double at_lower = (limits.from - own.at_zero) * per_place;
    const double at_upper = (limits.to - own.at_zero) * per_place;
    gmi_tilt_cut *cut = &cuts->cut[cuts->count];
    cuts->place[cuts->count] = (unsigned char)place;
    cut->enter = gmi_smaller(at_lower, at_upper);
    cut->leave = gmi_larger(at_lower, at_upper);
    cut->by_origin = by_origin * per_place;
    ++cuts->count;
}

OWN_STACK void gmi_tilt_cuts_find(const gm_pair *pair, const gmi_engagement *at, int side,
                                  double delta, int ends, gmi_tilt_cuts *cuts) {
    const tilted line = tilted_of(pair, at, side, 0.0);
    const double a_tau = line.a * line.tau / line.length;
    cuts->count = 0;

    /* The pinion's face does not tilt: its ends are those of all lines. */
    cuts->face = limits_of(pair, at, FACE_PINION);
    cuts->face.from = (cuts->face.from - pair->face_start) / pair->face_width;
    cuts->face.to = (cuts->face.to - pair->face_start) / pair->face_width;

    /* Tips and starts, by the roll lengths at the touching point, which the tilt moves along the flanks. */
    if (!(ends & GMI_FACES_ALONE)) {
        const double with_wheel = line.tau * line.g + a_tau * line.r_bw;
        set_cut(pair, at, &line, delta, ROLL_PINION, 1.0 - a_tau * line.r_bp, cuts);
        set_cut(pair, at, &line, delta, ROLL_WHEEL, -1.0 - with_wheel, cuts);
    }
    set_cut(pair, at, &line, delta, FACE_WHEEL, line.g, cuts);

    /* Tables, which are read where parallel axes would have the flanks touch. */
    if (ends & GMI_ENDS_WITH_PINION_TABLE) {
        set_cut(pair, at, &line, delta, TABLE_PINION, 1.0, cuts);
    }
    if (ends & GMI_ENDS_WITH_WHEEL_TABLE) {
        set_cut(pair, at, &line, delta, TABLE_WHEEL, -1.0, cuts);
    }
}

int gmi_tilt_cut_line(const gmi_tilt_cuts *cuts, double rho_origin, gmi_line_part *part) {
    part->from = cuts->face.from;
    part->to = cuts->face.to;
    part->from_place = part->to_place = FACE_PINION;

    /* The last to begin and the first to end cut the line. */
    for (int k = 0; k < cuts->count; ++k) {
        const gmi_tilt_cut *cut = &cuts->cut[k];
        const double moved = cut->by_origin * rho_origin;
        const double enter = cut->enter - moved;
        const double leave = cut->leave - moved;

        if (enter > part->from) {
            part->from = enter;
            part->from_place = cuts->place[k];
        }
        if (leave < part->to) {
            part->to = leave;
            part->to_place = cuts->place[k];
        }
    }
    return part->from < part->to;
}

OWN_STACK void gmi_tilt_move_ends(const gm_pair *pair, const gmi_engagement *at, int side,
                                  double rho_origin, double delta, gmi_line_part *part) {
    const tilted line = tilted_of(pair, at, side, rho_origin);
    set_end(pair, at, &line, delta, part->from, part->from_place, 1, part->from_by);
    set_end(pair, at, &line, delta, part->to, part->to_place, 0, part->to_by);
}

OWN_STACK int gmi_tilt_move_end(const gm_pair *pair, const gmi_engagement *at, int side,
                                double rho_origin, double delta, const gmi_line_part *part,
                                int is_beginning, double by[GMI_COORDINATES]) {
    const int place = is_beginning ? part->from_place : part->to_place;
    if (place == FACE_PINION) {
        return 0;
    }
    const tilted line = tilted_of(pair, at, side, rho_origin);
    set_end(pair, at, &line, delta, is_beginning ? part->from : part->to, place, is_beginning, by);
    return 1;
}

void gmi_tilt_beyond(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                     double delta, int role, gmi_beyond *beyond) {
    const tilted line = tilted_of(pair, at, side, rho_origin);
    const int place = role == GM_PINION ? ROLL_PINION : ROLL_WHEEL;
    const straight roll = place_of(pair, &line, delta, place);
    double by[GMI_COORDINATES];
    place_gradient(&line, 0.0, place, by);
    beyond->at_zero = roll.at_zero - at->tip_roll_length[role];
    beyond->per_t1 = roll.per_t1;
    beyond->by_origin = by[GMI_BY_ORIGIN];
    beyond->by_delta = by[GMI_BY_DELTA];
}

void gmi_tilt_beyond_by(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                        int role, double by[GMI_COORDINATES][2]) {
    const tilted line = tilted_of(pair, at, side, rho_origin);
    const int place = role == GM_PINION ? ROLL_PINION : ROLL_WHEEL;
    double at_zero[GMI_COORDINATES], at_one[GMI_COORDINATES];
    place_gradient(&line, 0.0, place, at_zero);
    place_gradient(&line, 1.0, place, at_one);
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        by[k][0] = at_zero[k];
        by[k][1] = at_one[k] - at_zero[k];
    }
}

/* ---------------------------------------------------------------------------------------------
 * The overlap along a line
 * ------------------------------------------------------------------------------------------- */

double gmi_tilt_gain(const gm_pair *pair, const gmi_engagement *at, int side) {
    return 1.0 + gmi_side_sign(side) * (pair->face_advance / pair->face_width) * at->across[side];
}

void gmi_tilt_find(const gm_pair *pair, const gmi_engagement *at, int side, gmi_tilt *result) {
    const tilted line = tilted_of(pair, at, side, 0.0);
    const double a = line.a, g = line.g, tau = line.tau;
    const double gain = 1.0 + tau * g;
    const straight u = line.u;
    const straight second = combined(line.rho_w, tau, line.zeta, 0.0);

    /* As a polynomial in t1 on the line with rho_p = 0 at t1 = 0. */
    const double square = -0.5 * a * a / line.length; /* of u */
    const double linear = -gain * g - 0.5 * a * a * tau;
    result->gain = gain;
    result->shift[0] = -gain * tau * a * line.r_bw - 0.5 * a * g * line.r_bw +
                       u.at_zero * (linear + square * u.at_zero) + 0.5 * g * g * second.at_zero;
    result->shift[1] = u.per_t1 * (linear + 2.0 * square * u.at_zero) + 0.5 * g * g * second.per_t1;
    result->shift[2] = square * u.per_t1 * u.per_t1;

    /* With the line's origin rho_w falls, and u grows by tau. */
    result->by_rho[0] = tau * (linear + 2.0 * square * u.at_zero) - 0.5 * g * g;
    result->by_rho[1] = tau * 2.0 * square * u.per_t1;
    result->by_rho_squared = tau * tau * square;
}

void gmi_tilt_line(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                   gmi_tilted_line *line) {
    gmi_tilt tilt;
    gmi_tilt_find(pair, at, side, &tilt);
    *line = gmi_tilt_of_line(&tilt, rho_origin);
}

void gmi_tilt_motion_find(const gm_pair *pair, const gmi_engagement *at, int side, double delta,
                          const gmi_rates *rates, gmi_tilt_motion *motion) {
    const tilted line = tilted_of(pair, at, side, 0.0);
    const double a = line.a, g = line.g, tau = line.tau, r_bw = line.r_bw;
    const straight second = combined(line.rho_w, tau, line.zeta, 0.0);

    /* The place u at the origin of a line, and the polynomial of the overlap in it. */
    motion->tau = tau;
    motion->u = line.u.at_zero;
    motion->u_per_t1 = line.u.per_t1;
    motion->per_length = 1.0 / line.length;
    motion->gain = 1.0 + tau * g;
    motion->linear = -motion->gain * g - 0.5 * a * a * tau;
    motion->square = -0.5 * a * a * motion->per_length;

    /* The tilts, and what the overlap changes by with each at the origin of a line. */
    motion->along = a;
    motion->across = g;
    motion->by_along = -motion->gain * tau * r_bw - 0.5 * g * r_bw;
    motion->by_across = tau * delta - tau * tau * a * r_bw + g * second.at_zero - 0.5 * a * r_bw;
    motion->by_across_per_t1 = g * second.per_t1;

    /* How fast the flanks approach each other, and what a wheel that tips adds with the arm u. */
    motion->speed = rates->delta - tau * r_bw * rates->along;
    motion->speed_by_arm = -rates->across;
}

void gmi_tilt_tangent(const gmi_tilt_motion *motion, double rho_origin, gmi_line_tangent *tangent) {
    const double a = motion->along, g = motion->across, tau = motion->tau;
    const double u = motion->u + tau * rho_origin, u1 = motion->u_per_t1;
    const double squares[3] = {u * u, 2.0 * u * u1, u1 * u1};

    /* Of the overlap: by u, which the origin raises by tau, the length and the wheel's face lower by tau and by 1. */
    const double by_u[2] = {motion->linear + 2.0 * motion->square * u, 2.0 * motion->square * u1};
    const double half_square = 0.5 * g * g;
    double(*by)[3] = tangent->by;
    by[GMI_BY_ORIGIN][0] = tau * by_u[0] - half_square;
    by[GMI_BY_ORIGIN][1] = tau * by_u[1];
    by[GMI_BY_DELTA][0] = motion->gain;
    by[GMI_BY_DELTA][1] = 0.0;
    by[GMI_BY_AXIAL][0] = -by_u[0] - half_square * tau;
    by[GMI_BY_AXIAL][1] = -by_u[1];

    /* By the length of the line of action. */
    const double curved = motion->square * motion->per_length;
    by[GMI_BY_LENGTH][0] = half_square - tau * by_u[0] - curved * squares[0];
    by[GMI_BY_LENGTH][1] = -tau * by_u[1] - curved * squares[1];
    by[GMI_BY_LENGTH][2] = -curved * squares[2];

    /* By the tilts. */
    const double turned = a * motion->per_length;
    by[GMI_BY_ALONG][0] = motion->by_along - a * tau * u - turned * squares[0];
    by[GMI_BY_ALONG][1] = -a * tau * u1 - turned * squares[1];
    by[GMI_BY_ALONG][2] = -turned * squares[2];

    const double by_arm = -tau * g - motion->gain;
    by[GMI_BY_ACROSS][0] = motion->by_across + by_arm * u - g * rho_origin;
    by[GMI_BY_ACROSS][1] = motion->by_across_per_t1 + by_arm * u1;
    by[GMI_BY_ACROSS][2] = 0.0;

    /* The arm of the second tilt is u. */
    tangent->arm[0] = u;
    tangent->arm[1] = u1;
    tangent->speed[0] = motion->speed + motion->speed_by_arm * u;
    tangent->speed[1] = motion->speed_by_arm * u1;
}

/* Of each term of the shift its largest on flanks and face, but for the term that is the same everywhere. */
double gmi_tilt_bound(const gm_pair *pair, const gmi_engagement *at, int side, double *reach) {
    const tilted line = tilted_of(pair, at, side, 0.0);
    const double a = fabs(line.a), g = fabs(line.g), tau = fabs(line.tau);
    const double length = fabs(line.length), r_bw = fabs(line.r_bw);
    const double gain = 1.0 + line.tau * line.g;

    /* rho_w runs from 0 to the wheel's tip, or a little beyond; on a ring from the tip to the start. */
    const double tip_or_start =
        gmi_larger(fabs(at->tip_roll_length[GM_WHEEL]), fabs(at->start_roll_length[GM_WHEEL]));
    const double rho_w = gmi_larger(tip_or_start, length);
    const double zeta =
        gmi_larger(fabs(line.zeta.at_zero), fabs(line.zeta.at_zero + line.zeta.per_t1));
    const double u = zeta + tau * rho_w;

    /* The terms of both orders in the tilts. */
    const double first_order = fabs(gain) * g * u - gain * line.tau * line.a * line.r_bw;
    const double second_order =
        0.5 * (g * g * (rho_w + tau * zeta) + a * g * r_bw + a * a * u * (tau + u / length));

    /* By what roll lengths move, and by what the wheel's face does along the line. */
    *reach = a * u * (fabs(line.r_bp) + r_bw) / length + tau * (3.0 * a * r_bw + 2.0 * g * rho_w);

    /* The gain acts on any delta. */
    return first_order + second_order + fabs(gain - 1.0) * pair->transverse_base_pitch;
}

double gmi_tilt_bound_by_roll(const gm_pair *pair, const gmi_engagement *at, int side) {
    const tilted line = tilted_of(pair, at, side, 0.0);
    const double a = fabs(line.a), g = fabs(line.g), tau = fabs(line.tau);
    const double zeta =
        gmi_larger(fabs(line.zeta.at_zero), fabs(line.zeta.at_zero + line.zeta.per_t1));
    const double rho_w =
        gmi_larger(fabs(at->tip_roll_length[GM_WHEEL]), fabs(at->start_roll_length[GM_WHEEL])) +
        fabs(line.length);
    const double u = zeta + tau * rho_w;
    return fabs(1.0 + line.tau * line.g) * g * tau +
           0.5 * (g * g + a * a * tau * (tau + 2.0 * u / fabs(line.length)));
}

double gmi_rates_mean_approach(const gmi_rates *rates, const gm_pair *pair,
                               const gmi_engagement *at, int side, const gmi_side_sum *sum) {
    if (!(sum->contact > 0.0)) {
        return rates->delta;
    }

    /* u = zeta - tau (T - rho_p), on average. */
    const tilted line = tilted_of(pair, at, side, 0.0);
    const double t1 = sum->contact_t1 / sum->contact;
    const double rho = sum->contact_rho / sum->contact;
    const double u = value_at(line.zeta, t1) - line.tau * (line.length - rho);
    return rates->delta - rates->across * u - line.tau * line.r_bw * rates->along;
}
