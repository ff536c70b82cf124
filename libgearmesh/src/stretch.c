/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Integrals along a stretch of a line on which the flanks touch all along: each table is followed for itself, from its own
 * crossing to its own crossing, and what its kinks add to the rest of the stretch is summed.
 *
 * In grid units w of a table is quadratic along the line within a cell. At a profile line its slope has a step J, at a face
 * line another one, and at both the curvature has a step K. At the distance x from the end of the stretch they add
 * J x^2 / 2 + K x^3 / 6 to the integral of w, and so does its beginning.
 */
#include "stretch.h"

#include "flank.h"
#include "internal.h"
#include "line.h"

/* A point of a line in one table: its cell, the place in it, w, and its slopes by u along the profile and by v1 across. */
typedef struct table_point {
    const double *node;
    int face, cell;
    double p, q;
    double value, along, across;
    double mixed; /* what both slopes change by within the cell */
} table_point;

SPECIALIZED table_point point_at(const gmi_grid *grid, const double *table, double profile,
                                 double t1) {
    const double v1 = t1 * grid->face_rate + grid->face_base;
    const double u = grid->base + (grid->direction * profile + t1 * grid->climb);
    const ptrdiff_t row = grid->row, step = grid->step;
    table_point at;
    at.face = gmi_cell_index(v1, grid->last_face);
    at.cell = gmi_cell_index(u, grid->last_profile);
    at.node = table + (at.face * row + at.cell * step + grid->corner);
    at.p = v1 - (double)at.face;
    at.q = u - (double)at.cell;
    const double across = at.node[row] - at.node[0];
    at.mixed = (at.node[row + step] - at.node[step]) - across;
    at.along = (at.node[step] - at.node[0]) + at.mixed * at.p;
    at.across = across + at.mixed * at.q;
    at.value = at.node[0] + across * at.p + at.along * at.q;
    return at;
}

/* Integrals over v1 of what is straight between its kinks; times the distance from the end of the stretch, and its square. */
typedef struct straight_sums {
    double whole, by_distance, by_square;
} straight_sums;

/*
 * Follows one table from a point on, and its slopes by u along the profile and by v1 across the face. In a cell w is
 * bilinear: along the line both slopes are straight. At a profile line the one along has a step, at a face line the one
 * across, and at both the rate at which they change, what is mixed, has another one. A step J and a step K of the rate at
 * the distance x from the end add J x + K x^2 / 2 to the integral, J x^2 / 2 + K x^3 / 6 to that times the distance, and
 * J x^3 / 3 + K x^4 / 12 to that times its square: so does the beginning. Of the second differences beside the nodes.
 */
SPECIALIZED void follow_slopes(const gmi_grid *grid, const table_point *at, double length,
                               straight_sums *along, straight_sums *across) {
    const ptrdiff_t row = grid->row, step = grid->step;
    const double rate = grid->rate, spacing = grid->profile_spacing;
    int faces = grid->last_face - at->face, profiles = grid->last_profile - at->cell;

    /* Sums of J x, J x^2 and J x^3 of both slopes, and of K x^2, K x^3 and K x^4, which they share. */
    double along_1 = at->along * length, along_2 = along_1 * length, along_3 = along_2 * length;
    double across_1 = at->across * length, across_2 = across_1 * length;
    double across_3 = across_2 * length;
    double rates_2 = at->mixed * (length * length), rates_3 = rates_2 * length;
    double rates_4 = rates_3 * length;

    /* From face line to face line, and between them from profile line to profile line: how far each is from the end. */
    const double *ahead = at->node + step;
    double face_line = length - (1.0 - at->p);
    double x = length - (1.0 - at->q) * spacing;
    for (;;) {
        const int is_last = !(face_line > 0.0) || faces <= 0;
        const double stop = is_last ? 0.0 : face_line;
        for (; x > stop && profiles > 0; --profiles) {
            const double beyond = ahead[row + GMI_NODE_PROFILE];
            const double change = beyond - ahead[GMI_NODE_PROFILE];
            const double kink_x = (beyond - change * (x - face_line)) * x;
            const double kink_x2 = kink_x * x;
            const double change_x2 = change * x * x;
            const double change_x3 = change_x2 * x;
            along_1 += kink_x;
            along_2 += kink_x2;
            along_3 += kink_x2 * x;
            rates_2 += change_x2;
            rates_3 += change_x3;
            rates_4 += change_x3 * x;
            ahead += step;
            x -= spacing;
        }
        if (is_last) {
            break;
        }

        /* Across the face line, interpolated between the profile lines behind and ahead. */
        ahead += row;
        const double on_line = ahead[GMI_NODE_FACE];
        const double back = ahead[GMI_NODE_FACE - step] - on_line;
        const double kink_x = (on_line + (face_line - x) * rate * back) * face_line;
        const double kink_x2 = kink_x * face_line;
        const double back_x2 = back * face_line * face_line;
        const double back_x3 = back_x2 * face_line;
        rates_2 -= back_x2;
        rates_3 -= back_x3;
        rates_4 -= back_x3 * face_line;
        across_1 += kink_x;
        across_2 += kink_x2;
        across_3 += kink_x2 * face_line;
        face_line -= 1.0;
        faces -= 1;
    }
    along->whole = along_1 + 0.5 * rates_2;
    along->by_distance = 0.5 * along_2 + (1.0 / 6.0) * rates_3;
    along->by_square = (1.0 / 3.0) * along_3 + (1.0 / 12.0) * rates_4;
    across->whole = across_1 + rate * (0.5 * rates_2);
    across->by_distance = 0.5 * across_2 + rate * ((1.0 / 6.0) * rates_3);
    across->by_square = (1.0 / 3.0) * across_3 + rate * ((1.0 / 12.0) * rates_4);
}

/* A slope's integral over t1, and the first moment about t1 = 0, times a factor; to: t1 of the end. */
static void add_over_t1(const gmi_grid *grid, double factor, double to, const straight_sums *sums,
                        double integral[2]) {
    const double per_rate = 1.0 / grid->face_rate;
    const double whole = factor * per_rate * sums->whole;
    integral[0] += whole;
    integral[1] += to * whole - factor * per_rate * per_rate * sums->by_distance;
}

/* One table along a stretch. */
typedef struct stretch_ends {
    double from, to, length; /* t1 */
    int is_root;             /* the end is one of f */
} stretch_ends;

/*
 * Its own integrals follow from those of its slope along the line, rate along + across: that times the distance from the
 * end is what w gains up to there, times half its square what the integral of that gains. at_from, at_to: slopes by v2 and
 * by v1 there.
 */
SPECIALIZED void add_table_between(const gmi_grid *grid, const double *table, double profile,
                                   const stretch_ends *ends, double by_profile[2],
                                   double by_face[2], double at_from[2], double at_to[2],
                                   gmi_stretches *found) {
    const table_point at = point_at(grid, table, profile, ends->from);
    const double length = ends->length * grid->face_rate, per_rate = 1.0 / grid->face_rate;
    straight_sums along, across;
    follow_slopes(grid, &at, length, &along, &across);
    add_over_t1(grid, grid->direction, ends->to, &along, by_profile);
    if (by_face != NULL) {
        add_over_t1(grid, 1.0, ends->to, &across, by_face);
    }

    const double sum = length * at.value + (grid->rate * along.by_distance + across.by_distance);
    const double by_distance =
        0.5 * (length * length * at.value + (grid->rate * along.by_square + across.by_square));
    found->sum += per_rate * sum;
    found->sum_t1 += per_rate * (ends->to * sum - per_rate * by_distance);

    at_from[0] = grid->direction * at.along;
    at_from[1] = at.across;
    if (ends->is_root) {
        const table_point end = point_at(grid, table, profile, ends->to);
        at_to[0] = grid->direction * end.along;
        at_to[1] = end.across;
    }
}

/* The polynomials with these in place of the powers of t1: only three of them are of second order. */
static inline void sum_powers(const gmi_line_tangent *tangent, const double powers[3],
                              double by[GMI_COORDINATES]) {
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        by[k] = tangent->by[k][0] * powers[0] + tangent->by[k][1] * powers[1];
    }
    by[GMI_BY_LENGTH] += tangent->by[GMI_BY_LENGTH][2] * powers[2];
    by[GMI_BY_ALONG] += tangent->by[GMI_BY_ALONG][2] * powers[2];
    by[GMI_BY_ACROSS] += tangent->by[GMI_BY_ACROSS][2] * powers[2];
}

/* Where f passes zero the touching part moves by d f / |d f / d t1|; moves: d t1 / d f, 0 where there is no root. */
static void add_moving_root(double t1, double moves, double by_pinion, const double by_wheel[2],
                            gmi_line_tangent *tangent) {
    if (!(moves > 0.0)) {
        return;
    }
    double by[GMI_COORDINATES];
    const double powers_of_t1[3] = {1.0, t1, t1 * t1};
    sum_powers(tangent, powers_of_t1, by);
    gmi_line_add_slopes(tangent, by_pinion, by_wheel[0], by_wheel[1], by);
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        const double moved = moves * by[k];
        tangent->contact_by[k][0] += moved;
        tangent->contact_by[k][1] += moved * t1;
        tangent->contact_by[k][2] += moved * powers_of_t1[2];
    }
}

/* The slopes of both tables and their integrals, and how the roots at the ends move. */
SPECIALIZED void add_tables(const stretch_ends *ends, double to_moves, gmi_stretches *found) {
    const gmi_line *line = found->line;
    double at_from[2][2] = {{0.0, 0.0}, {0.0, 0.0}}, at_to[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
    if (line->pinion != NULL) {
        add_table_between(found->pinion, line->pinion, line->pinion_profile, ends, found->slopes[0],
                          NULL, at_from[0], at_to[0], found);
    }
    if (line->wheel != NULL) {
        add_table_between(found->wheel, line->wheel, line->wheel_profile, ends, found->slopes[1],
                          found->slopes[2], at_from[1], at_to[1], found);
    }
    add_moving_root(ends->from, found->per_place * found->since_moves, at_from[0][0], at_from[1],
                    found->tangent);
    add_moving_root(ends->to, found->per_place * to_moves, at_to[0][0], at_to[1], found->tangent);
}

/* ---------------------------------------------------------------------------------------------
 * A stretch
 * ------------------------------------------------------------------------------------------- */

void gmi_stretches_add(gmi_stretches *found, double to_place, double to_moves) {
    const gmi_line *line = found->line;
    const double from = found->t1_zero + found->since * found->per_place;
    const double length = (to_place - found->since) * found->per_place;

    /* About the middle of the stretch, seen from t1 = 0 or from where the line begins: the parabola of the line. */
    const double middle = found->t1_zero + 0.5 * (found->since + to_place) * found->per_place;
    const double spread = length * length * (1.0 / 12.0);
    const double gone = middle - line->from;
    const double slope = line->half_slope + gone * line->curvature;
    const double parabola =
        length * (line->overlap + gone * (line->half_slope + slope) + spread * line->curvature);
    found->sum += parabola;
    found->contact[0] += length;

    /* Moments up to the third, and the tables with their slopes. */
    found->sum_t1 += middle * parabola + length * spread * (2.0 * slope);
    found->contact[1] += length * middle;
    found->contact[2] += length * (middle * middle + spread);
    found->contact[3] += length * middle * (middle * middle + 3.0 * spread);
    const stretch_ends ends = {from, found->t1_zero + to_place * found->per_place, length,
                               to_moves > 0.0};
    add_tables(&ends, to_moves, found);
}

void gmi_stretches_finish(gmi_stretches *found) {
    /* Of 1 and of t1: what the polynomials give over the touching part, and the slopes of the flanks. */
    gmi_line_tangent *tangent = found->tangent;
    for (int weight = 0; weight < 2; ++weight) {
        double by[GMI_COORDINATES];
        sum_powers(tangent, &found->contact[weight], by);
        gmi_line_add_slopes(tangent, found->slopes[0][weight], found->slopes[1][weight],
                            found->slopes[2][weight], by);
        for (int k = 0; k < GMI_COORDINATES; ++k) {
            tangent->sum_by[k][weight] += by[k];
        }
    }
    for (int power = 0; power < 4; ++power) {
        tangent->contact[power] += found->contact[power];
    }
}

double gmi_line_value(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                      double t1) {
    double value = line->overlap;
    if (line->pinion != NULL) {
        value += point_at(pinion, line->pinion, line->pinion_profile, t1).value;
    }
    if (line->wheel != NULL) {
        value += point_at(wheel, line->wheel, line->wheel_profile, t1).value;
    }
    return value;
}

double gmi_stretches_value(const gmi_stretches *found, double t1) {
    const gmi_line *line = found->line;
    const double gone = t1 - line->from;
    return gmi_line_value(line, found->pinion, found->wheel, t1) +
           gone * (2.0 * line->half_slope + gone * line->curvature);
}
