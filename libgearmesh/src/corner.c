/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The gap between a tip corner and the flank of the mate, in closed form.
 *
 * From the mate's base tangent point N_m, in the directions n (away from the mate's axis) and e (line of action), the end
 * of the path is at (0, rho_A), rho_A = T - rho_a. A roll u of the other gear, whose tip it is, turns the corner back
 * about that gear's axis by v = u / r_g, to
 *
 *     n_C = r_g (1 - cos(v)) + rho_a sin(v),     e_C = rho_a (1 - cos(v)) - r_g sin(v)     beside (0, rho_A).
 *
 * The involute of the mate through it has there the roll length rho_C, and its normal is the tangent to the base circle,
 * turned by Delta:
 *
 *     rho_C^2 = rho_A^2 + 2 (C (1 - cos(v)) + S sin(v)),     C = r_m r_g + r_g^2 + T rho_a,  S = (r_m + r_g) rho_a - T r_g
 *     sin(Delta) = (rho_C (r_m + n_C) - r_m (rho_A + e_C)) / (r_m^2 + rho_C^2)
 *
 * The mate has to roll by r_m psi = rho - r_m Delta to get there, hence
 *
 *     gap = (rho_C - rho_A) + u - r_m Delta,     gap' = ((r_m + r_g) (1 - cos(Delta)) + T sin(Delta)) / r_g.
 *
 * Sine and arc tangent are series of the small angles: the same bits on every machine.
 */
#include "corner.h"

#include "internal.h"
#include "meshing.h"
#include "wide.h"

#include <math.h>

/* Angles at most 0.5: sine to 2e-17. */
static inline double sine_of_small(double x) {
    const double y = x * x;
    const double series =
        -1.0 / 6.0 +
        y * (1.0 / 120.0 +
             y * (-1.0 / 5040.0 +
                  y * (1.0 / 362880.0 + y * (-1.0 / 39916800.0 + y * (1.0 / 6227020800.0)))));
    return x + x * y * series;
}

/* Arc tangent to 2e-17 up to 0.26. */
static inline double arc_of_small(double x) {
    const double y = x * x;
    double series = 1.0 / 23.0 - y * (1.0 / 25.0);
    series = 1.0 / 17.0 - y * (1.0 / 19.0 - y * (1.0 / 21.0 - y * series));
    series = 1.0 / 11.0 - y * (1.0 / 13.0 - y * (1.0 / 15.0 - y * series));
    series = 1.0 / 5.0 - y * (1.0 / 7.0 - y * (1.0 / 9.0 - y * series));
    series = 1.0 / 3.0 - y * series;
    return x - x * y * series;
}

/* The angle with this sine and cosine, both halves of a quarter turn: four times the arc of its quarter. */
static inline double angle_of(double sine, double cosine) {
    const double half = sine / (1.0 + cosine);
    return 4.0 * arc_of_small(half / (1.0 + sqrt(1.0 + half * half)));
}

/* 1 - cos and sin of the turn of the tip. */
typedef struct turned {
    double versine, sine;
} turned;

static inline turned turn_of(const gmi_corner *corner, double roll) {
    const double half = sine_of_small(0.5 * roll / corner->tip_base);
    const turned result = {2.0 * half * half, 2.0 * half * sqrt(1.0 - half * half)};
    return result;
}

/* Where the corner is after a roll, the turn of the normal there, and the gap. */
typedef struct way {
    turned by;                          /* of the tip */
    double rho, longer;                 /* roll length there, and by how much it is longer */
    double n, e;                        /* n_C, e_C - rho_A */
    double sine, cosine, versine, turn; /* of the normal */
    double rho_by_roll, turn_by_roll;
    double gap, by_roll, by_roll_twice;
} way;

static inline way way_of(const gmi_corner *corner, double roll) {
    const double r_g = corner->tip_base, r_m = corner->mate_base;
    const double start = corner->mate_roll, direction = start < 0.0 ? -1.0 : 1.0;
    const turned by = turn_of(corner, roll);

    /* The roll length there, which has the sign of that at the end of the path. */
    const double change = 2.0 * (corner->along * by.versine + corner->across * by.sine);
    const double whole = start * start + change;
    const double squared = 0.5 * (whole + fabs(whole)); /* 0 if that is below: without a branch */
    const double rho = direction * sqrt(squared);
    const double longer = change / (rho + start);

    /* And the turn of the normal. */
    const double n_way = r_g * by.versine + corner->tip_roll * by.sine;
    const double e_way = corner->tip_roll * by.versine - r_g * by.sine;
    const double per_square = 1.0 / (r_m * r_m + squared);
    const double sine = (r_m * (longer - e_way) + rho * n_way) * per_square;
    const double cosine = (r_m * (r_m + n_way) + rho * (start + e_way)) * per_square;
    const double versine = sine * sine / (1.0 + cosine);
    const double turn = angle_of(sine, cosine);

    /* The gap by the roll, and gap'' from how the normal turns. */
    const double per_base = 1.0 / r_g;
    const double base_sum = r_m + r_g;
    const double by_roll = (base_sum * versine + corner->line_of_action * sine) * per_base;
    const double rho_by_roll =
        (corner->along * by.sine + corner->across * (1.0 - by.versine)) * per_base / rho;
    const double turn_by_roll = (rho_by_roll + 1.0 - by_roll) / r_m;
    const double by_roll_twice =
        (base_sum * sine + corner->line_of_action * cosine) * turn_by_roll * per_base;
    const way found = {by,      rho,          longer,       n_way,
                       e_way,   sine,         cosine,       versine,
                       turn,    rho_by_roll,  turn_by_roll, (longer + roll) - r_m * turn,
                       by_roll, by_roll_twice};
    return found;
}

APART void find_gaps(int count, const gmi_corner *of, const double *restrict roll,
                     double *restrict gap, double *restrict by_roll,
                     double *restrict by_roll_twice) {
    const gmi_corner corner = *of;
    for (int k = 0; k < count; ++k) {
        const way found = way_of(&corner, roll[k]);
        gap[k] = found.gap;
        by_roll[k] = found.by_roll;
        by_roll_twice[k] = found.by_roll_twice;
    }
}

void gmi_corner_gaps(const gmi_corner *corner, int count, const double *roll, double *gap,
                     double *by_roll, double *by_roll_twice) {
    find_gaps(count, corner, roll, gap, by_roll, by_roll_twice);
}

/* One corner at a time is no work for vectors. */
#ifndef GMI_IN_WIDE
/*
 * The roll at which rho_C^2 has changed by `change`, at most that of a radian: with z = tan(v / 2) it is
 * (4 C - change) z^2 + 4 S z - change = 0.
 */
static double roll_to(const gmi_corner *corner, double change) {
    const double direction = corner->tip_base < 0.0 ? -1.0 : 1.0;
    const double a = 4.0 * corner->along - change;
    const double half_b = 2.0 * direction * corner->across;
    const double discriminant = half_b * half_b + a * change;
    const double largest = fabs(corner->tip_base);
    if (!(discriminant >= 0.0)) {
        return largest;
    }

    /* Both roots without cancellation; the smaller one above 0. */
    const double q = -(half_b + (half_b < 0.0 ? -1.0 : 1.0) * sqrt(discriminant));
    const double roots[2] = {q / a, -change / q};
    double roll = largest;
    for (int k = 0; k < 2; ++k) {
        if (roots[k] > 0.0) {
            roll = fmin(roll, 2.0 * largest * atan(roots[k]));
        }
    }
    return roll;
}

int gmi_corner_init(const gm_pair *pair, const gmi_engagement *at, int role, gmi_corner *corner) {
    const double base[2] = {pair->pinion.base_radius, at->wheel_base_radius};
    const int mate = role == GM_PINION ? GM_WHEEL : GM_PINION;
    const double r_g = base[role], r_m = base[mate];
    const double length = at->line_of_action;
    const double tip = at->tip_roll_length[role];
    corner->tip_base = r_g;
    corner->mate_base = r_m;
    corner->line_of_action = length;
    corner->tip_roll = tip;
    corner->mate_roll = length - tip;
    corner->along = r_g * (r_m + r_g) + length * tip;
    corner->across = (r_m + r_g) * tip - length * r_g;

    /* Parabolas follow the gap closely enough that are short beside the way to where rho_C would be 0. */
    const double per_roll = corner->across / r_g;
    corner->coarse = corner->fine = pair->transverse_base_pitch / 64.0;
    const double singular = 0.5 * (length - tip) * (length - tip) / per_roll;
    for (int k = 0; k < 12 && singular > 0.0 && 4.0 * corner->fine > singular; ++k) {
        corner->fine *= 0.5;
    }

    /* It is off the flank at the mate's tip, or where there is no involute. */
    const double start = corner->mate_roll;
    const double end = at->tip_roll_length[mate];
    corner->reach =
        fmin(roll_to(corner, (end - start) * (end + start)), roll_to(corner, -start * start));
    return (r_m < 0.0 ? -start : start) > 0.01 * pair->transverse_base_pitch;
}

void gmi_corner_at(const gmi_corner *corner, double roll, gmi_corner_place *place) {
    const double r_g = corner->tip_base;
    const way found = way_of(corner, roll);
    const turned by = found.by;
    place->mate_roll = found.rho;
    place->across = found.n;
    place->along = found.e + roll;
    place->across_by_roll = by.sine + corner->tip_roll / r_g * (1.0 - by.versine);
    place->along_by_roll = by.versine + corner->tip_roll / r_g * by.sine;
    place->versine = found.versine;
    place->turn = found.turn;
    place->gain = found.longer + roll;

    /* The gap: by the roll, and by T, which moves the corner along e and the end of the path with it. */
    place->gap = found.gap;
    place->by_roll = found.by_roll;
    place->by_roll_twice = found.by_roll_twice;
    place->by_length = -found.versine;
    place->tip_arm = r_g * (1.0 - place->by_roll);
    place->versine_by_roll = found.sine * found.turn_by_roll;
    place->gain_by_roll = found.rho_by_roll + 1.0;
    place->gain_by_length = (corner->mate_roll + found.e) / found.rho - 1.0;

    /* By T the turn follows from gap' by both: that of by_length by the roll. */
    place->versine_by_length =
        -found.sine * (r_g * place->versine_by_roll + found.sine) /
        (corner->line_of_action * found.cosine + (corner->mate_base + r_g) * found.sine);
}

OWN_STACK void gmi_corner_joint_at(const gmi_corner *corner, double roll, gmi_corner_joint *found) {
    gmi_corner_place place;
    gmi_corner_at(corner, roll, &place);
    found->gap = place.gap;
    found->slope = place.by_roll;
    found->versine = place.versine;
    found->across = place.across;
    found->along = place.along;
    found->gain = place.gain;
    found->versine_by_roll = place.versine_by_roll;
    found->versine_by_length = place.versine_by_length;
    found->gain_by_roll = place.gain_by_roll;
    found->gain_by_length = place.gain_by_length;
    found->across_by_roll = place.across_by_roll;
    found->along_by_roll = place.along_by_roll;
}

/* The gap is convex: from beyond, Newton's method comes closer from the same side. */
double gmi_corner_touch(const gmi_corner *corner, double overlap) {
    gmi_corner_place place;
    gmi_corner_at(corner, 0.0, &place);
    double roll =
        overlap > 0.0 ? fmin(sqrt(2.0 * overlap / place.by_roll_twice), corner->reach) : 0.0;
    for (int k = 0; k < 12 && roll > 0.0; ++k) {
        gmi_corner_at(corner, roll, &place);
        roll = fmin(roll - (place.gap - overlap) / place.by_roll, corner->reach);
    }
    return roll;
}

/* There rho_C^2 stays what it is: by T it grows by 2 (rho_A + e_C), by the roll by 2 rho_C rho_C'. */
double gmi_corner_reach_by_length(const gmi_corner *corner) {
    gmi_corner_place place;
    gmi_corner_at(corner, corner->reach, &place);
    const double half_by_roll = place.mate_roll * (place.gain_by_roll - 1.0);
    const double half_by_length = corner->mate_roll + place.along - corner->reach;
    return half_by_roll != 0.0 ? -half_by_length / half_by_roll : 0.0;
}

int gmi_corners_init(const gm_pair *pair, const gmi_engagement *at, gmi_corner corners[2]) {
    const int pinion = gmi_corner_init(pair, at, GM_PINION, &corners[GM_PINION]);
    const int wheel = gmi_corner_init(pair, at, GM_WHEEL, &corners[GM_WHEEL]);
    return pinion && wheel;
}
#endif
