/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The integral of max(0, f) along one line of contact, f = gap + deviation of both flanks, exactly.
 *
 * In grid units the line runs through a flank's table as v1 = face_rate t1, v2 = profile + rate t1, and within a
 * cell the bilinear surface is quadratic in t1 there. At a grid line only slope and curvature change, by the
 * second difference of the nodes across that grid line, interpolated along it (flank.c keeps it beside each
 * node). So value, slope and curvature of f are carried along the line and corrected at each crossing: two node
 * reads and no division per crossing. Each piece between crossings is integrated in closed form, split at its
 * roots where f changes its sign.
 *
 * Crossings come in order from two to four arithmetic sequences: face lines (constant t1; one sequence for both
 * tables if their grids agree) and profile lines (constant t2) of each table.
 */
#include "internal.h"

#include <math.h>

#define NO_CROSSING 2.0 /* later than any: t1 ends at 1 */

/* The walk is compiled once for each combination of its constant arguments. */
#if defined(__GNUC__)
#define SPECIALIZED static inline __attribute__((always_inline))
#else
#define SPECIALIZED static inline
#endif

/* In place of a table that is not there: zeros wherever one looks. */
static const double ideal_nodes[GMI_NODE_DOUBLES + GMI_NODE_DOUBLES] = {0.0};
static const gmi_grid ideal_grid = {0};

/* Where the line is in one flank's table. */
typedef struct trace {
    const double *cell;   /* corner node of the current cell with the lowest indices */
    double face, profile; /* indices of that node */
    double origin;        /* v2 at t1 = 0 */
    double profile_shift; /* next_profile = profile * spacing + shift */
    double next_face;     /* t1 of the next crossings */
    double next_profile;
    double profile_slope; /* d deviation / d v2 here (m) */
    double slope_rate;    /* its d / d t1 within the cell (m) */
} trace;

/* f around the current t1: value, half the slope, half the second derivative. */
typedef struct quadratic {
    double value, half_slope, curvature;
} quadratic;

static inline double smaller(double a, double b) {
    return a < b ? a : b;
}

static inline double larger(double a, double b) {
    return a > b ? a : b;
}

void gmi_grid_init(gmi_grid *grid, const gm_flank_tables *tables, double climb, double length) {
    if (tables == NULL || tables->profile_nodes == 0) {
        *grid = ideal_grid;
        return;
    }
    const int upwards = climb > 0.0;
    grid->last_face = tables->face_nodes - 2;
    grid->last_profile = tables->profile_nodes - 2;
    grid->row = (ptrdiff_t)tables->profile_nodes * GMI_NODE_DOUBLES;
    grid->step = upwards ? GMI_NODE_DOUBLES : -GMI_NODE_DOUBLES;
    grid->ahead = upwards ? GMI_NODE_DOUBLES : 0;
    grid->direction = upwards ? 1.0 : -1.0;
    grid->ahead_number = upwards ? 1.0 : 0.0;
    grid->face_rate = (double)(tables->face_nodes - 1);
    grid->face_spacing = (1.0 + 4e-16) / grid->face_rate;
    grid->per_rho = (double)(tables->profile_nodes - 1) / length;
    grid->rate = climb * grid->per_rho;
    grid->profile_spacing = 1.0 / grid->rate; /* infinite for spur gears, and then not used */
    grid->face_kick = 0.5 * grid->face_rate;
    grid->face_bend = grid->rate * grid->face_rate;
    grid->profile_kick = 0.5 * fabs(grid->rate);
    grid->profile_bend = fabs(grid->rate) * grid->face_rate;
}

/* Index of the cell that holds v, clamped into the table against rounding at its rim. */
static inline int cell_of(double v, int last) {
    const int cell = v > 0.0 ? (int)v : 0;
    return cell < last ? cell : last;
}

static void begin_ideal(trace *path) {
    const trace ideal = {ideal_nodes, 0.0, 0.0, 0.0, 0.0, NO_CROSSING, NO_CROSSING, 0.0, 0.0};
    *path = ideal;
}

/* Enters the table at t1 = from and adds its deviation to f. Returns the t1 at which the table ends. */
static double begin(trace *path, const gmi_grid *grid, const double *table, double origin,
                    double from, quadratic *f) {
    const double v1 = from * grid->face_rate;
    const double v2 = origin + from * grid->rate;
    const int face = cell_of(v1, grid->last_face);
    const int profile = cell_of(v2, grid->last_profile);
    const double *cell = table + face * grid->row + profile * GMI_NODE_DOUBLES;
    path->cell = cell;
    path->face = (double)face;
    path->profile = (double)profile;
    path->origin = origin;

    /* w = corner + along_face p + along_profile q + mixed p q with p, q in [0, 1] */
    const double p = v1 - path->face;
    const double q = v2 - path->profile;
    const double corner = cell[0];
    const double along_face = cell[grid->row] - corner;
    const double along_profile = cell[GMI_NODE_DOUBLES] - corner;
    const double mixed = (cell[grid->row + GMI_NODE_DOUBLES] - cell[grid->row]) - along_profile;
    path->profile_slope = along_profile + mixed * p;
    path->slope_rate = mixed * grid->face_rate;
    f->value += corner + along_face * p + path->profile_slope * q;
    f->half_slope +=
        grid->face_kick * (along_face + mixed * q) + 0.5 * grid->rate * path->profile_slope;
    f->curvature += grid->face_bend * mixed;

    path->next_face = (path->face + 1.0) * grid->face_spacing;
    if (grid->rate == 0.0) { /* spur: along a profile line, never across one */
        path->profile_shift = path->next_profile = NO_CROSSING;
        return 1.0;
    }
    path->profile_shift = (grid->ahead_number - origin) * grid->profile_spacing;
    path->next_profile = path->profile * grid->profile_spacing + path->profile_shift;
    const double last_cell = grid->rate > 0.0 ? (double)grid->last_profile : 0.0;
    return last_cell * grid->profile_spacing + path->profile_shift;
}

/* Across the face line (constant t1) ahead. */
SPECIALIZED void cross_face(trace *path, const gmi_grid *grid, double t1, int wanted,
                            quadratic *f) {
    path->cell += grid->row;
    const double q = t1 * grid->rate + (path->origin - path->profile);
    const double near = path->cell[GMI_NODE_FACE];
    const double change = path->cell[GMI_NODE_DOUBLES + GMI_NODE_FACE] - near;
    f->half_slope += grid->face_kick * (near + q * change);
    f->curvature += grid->face_bend * change;
    if (wanted & GMI_DERIVATIVES)
        path->slope_rate += grid->face_rate * change;
}

SPECIALIZED void count_face(trace *path, const gmi_grid *grid) {
    path->face += 1.0;
    path->next_face = (path->face + 1.0) * grid->face_spacing;
}

/* Across the profile line (constant t2) ahead, upwards or downwards. `face` = v1 index of the cell. */
SPECIALIZED void cross_profile(trace *path, const gmi_grid *grid, double face, double t1,
                               int wanted, quadratic *f) {
    const double *line = path->cell + grid->ahead;
    const double p = t1 * grid->face_rate - face;
    const double near = line[GMI_NODE_PROFILE];
    const double change = line[grid->row + GMI_NODE_PROFILE] - near;
    const double kink = near + p * change;
    f->half_slope += grid->profile_kick * kink;
    f->curvature += grid->profile_bend * change;
    if (wanted & GMI_DERIVATIVES) {
        path->profile_slope += grid->direction * kink;
        path->slope_rate += grid->direction * (grid->face_rate * change);
    }
    path->cell += grid->step;
    path->profile += grid->direction;
    path->next_profile = path->profile * grid->profile_spacing + path->profile_shift;
}

/* What a piece is made of: copied for the slow case, so that the walk itself stays in registers. */
typedef struct piece {
    double t1, length;
    quadratic f;
    double first_slope, first_rate; /* d deviation / d v2 of both flanks, and its rate */
    double second_slope, second_rate;
} piece;

/* Adds the part [begin, end] (from the start of the piece) in which f > 0. */
static inline void add_touching(const piece *part, double begin, double end, int wanted,
                                gmi_line_sum *total) {
    const quadratic f = part->f;
    const double length = end - begin;
    const double middle = 0.5 * (begin + end);
    /* Integral of the quadratic about the middle: no differences of cubes. */
    const double at_middle = f.value + middle * (2.0 * f.half_slope + middle * f.curvature);
    const double second = length * length * (1.0 / 12.0);
    const double integral = length * (at_middle + f.curvature * second);
    total->sum += integral;
    total->contact += length;
    if (wanted & GMI_DERIVATIVES) {
        total->pinion += length * (part->first_slope + middle * part->first_rate);
        total->wheel += length * (part->second_slope + middle * part->second_rate);
    }
    if (wanted & GMI_MOMENTS) {
        const double t1 = part->t1 + middle;
        const double slope_at_middle = 2.0 * (f.half_slope + middle * f.curvature);
        total->sum_t1 += t1 * integral + length * second * slope_at_middle;
        total->contact_t1 += t1 * length;
    }
}

/* A piece in which f may change its sign: split at the roots of the quadratic. */
static void add_split(const piece *part, int wanted, gmi_line_sum *total) {
    const quadratic f = part->f;
    if (!(part->length > 0.0)) /* two crossings at the same t1, up to rounding */
        return;
    double cuts[4] = {0.0, 0.0, 0.0, part->length};
    const double discriminant = f.half_slope * f.half_slope - f.curvature * f.value;
    if (discriminant > 0.0) {
        /* Without cancellation; an infinite root (curvature 0) is clamped away. */
        const double q = -(f.half_slope + copysign(sqrt(discriminant), f.half_slope));
        const double root_1 = smaller(larger(q / f.curvature, 0.0), part->length);
        const double root_2 = smaller(larger(f.value / q, 0.0), part->length);
        cuts[1] = smaller(root_1, root_2);
        cuts[2] = larger(root_1, root_2);
    }
    for (int k = 0; k < 3; ++k) {
        const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
        const double at_middle = f.value + middle * (2.0 * f.half_slope + middle * f.curvature);
        if (cuts[k + 1] > cuts[k] && at_middle > 0.0)
            add_touching(part, cuts[k], cuts[k + 1], wanted, total);
    }
}

/* A walk along a line: where it is, f there, and the sums over whole pieces so far. */
typedef struct walk_state {
    double t1;
    quadratic f;
    trace first, second; /* through the tables of both flanks */
    double three_sums;   /* three times the sum */
    double contact;
    double first_sum, second_sum; /* of d deviation / d v2 of both flanks */
} walk_state;

/* Integrates the piece up to `end` and goes there. */
SPECIALIZED void advance(walk_state *at, double end, int wanted, gmi_line_sum *split) {
    /* A quadratic stays within the hull of its three Bezier points, and their mean is its own. */
    const double length = end - at->t1;
    const double value = at->f.value;
    const double control = value + length * at->f.half_slope;
    const double end_half_slope = at->f.half_slope + length * at->f.curvature;
    const double end_value = control + length * end_half_slope;
    if (!(wanted & GMI_MOMENTS) && smaller(smaller(value, control), end_value) > 0.0) {
        at->three_sums += length * (value + control + end_value);
        at->contact += length;
        if (wanted & GMI_DERIVATIVES) {
            at->first_sum +=
                length * (at->first.profile_slope + 0.5 * length * at->first.slope_rate);
            at->second_sum +=
                length * (at->second.profile_slope + 0.5 * length * at->second.slope_rate);
        }
    } else if (larger(larger(value, control), end_value) > 0.0) {
        const piece part = {at->t1,
                            length,
                            at->f,
                            at->first.profile_slope,
                            at->first.slope_rate,
                            at->second.profile_slope,
                            at->second.slope_rate};
        add_split(&part, wanted, split);
    }
    at->t1 = end;
    at->f.value = end_value;
    at->f.half_slope = end_half_slope;
    if (wanted & GMI_DERIVATIVES) {
        at->first.profile_slope += length * at->first.slope_rate;
        at->second.profile_slope += length * at->second.slope_rate;
    }
}

/*
 * Walks a line piece by piece through the tables of two flanks, from face line to face line. same_faces: the first
 * table's face lines serve both. `wanted` and `same_faces` are constants at each call. In the result "pinion" is
 * the first flank.
 */
SPECIALIZED void walk(walk_state at, const gmi_grid *first, const gmi_grid *second, double to,
                      int wanted, int same_faces, gmi_line_sum *result) {
    for (;;) {
        double face_line = at.first.next_face;
        if (!same_faces)
            face_line = smaller(face_line, at.second.next_face);
        face_line = smaller(face_line, to);
        for (;;) {
            if (at.first.next_profile < at.second.next_profile) {
                if (!(at.first.next_profile < face_line))
                    break;
                advance(&at, at.first.next_profile, wanted, result);
                cross_profile(&at.first, first, at.first.face, at.t1, wanted, &at.f);
            } else {
                if (!(at.second.next_profile < face_line))
                    break;
                advance(&at, at.second.next_profile, wanted, result);
                cross_profile(&at.second, second, same_faces ? at.first.face : at.second.face,
                              at.t1, wanted, &at.f);
            }
        }
        advance(&at, face_line, wanted, result);
        if (face_line >= to)
            break;
        if (same_faces || at.first.next_face == face_line) {
            cross_face(&at.first, first, face_line, wanted, &at.f);
            count_face(&at.first, first);
            if (same_faces)
                cross_face(&at.second, second, face_line, wanted, &at.f);
        } else {
            cross_face(&at.second, second, face_line, wanted, &at.f);
            count_face(&at.second, second);
        }
    }
    result->sum += at.three_sums * (1.0 / 3.0);
    result->contact += at.contact;
    result->pinion += at.first_sum;
    result->wheel += at.second_sum;
    result->at_to = at.f.value;
}

/* No table on either flank: f is the same all along. */
static void integrate_ideal(const gmi_line *line, gmi_line_sum *result) {
    const double length = line->to - line->from;
    result->at_from = result->at_to = line->gap;
    if (line->gap > 0.0) {
        result->sum = line->gap * length;
        result->contact = length;
        result->contact_t1 = 0.5 * length * (line->from + line->to);
        result->sum_t1 = line->gap * result->contact_t1;
    }
}

/* `first` has a table, `second` may have one. */
static void integrate_tables(const gmi_line *line, const gmi_grid *first, const double *first_table,
                             double first_profile, const gmi_grid *second,
                             const double *second_table, double second_profile, int wanted,
                             gmi_line_sum *result) {
    walk_state at; /* every field is set below; zeroing all first costs as much as ten pieces */
    at.t1 = line->from;
    at.f = (quadratic){line->gap, 0.0, 0.0};
    at.three_sums = at.contact = at.first_sum = at.second_sum = 0.0;
    double to =
        smaller(line->to, begin(&at.first, first, first_table, first_profile, line->from, &at.f));
    int same_faces = 1;
    if (second_table == NULL) {
        begin_ideal(&at.second);
        second = &ideal_grid;
    } else {
        to =
            smaller(to, begin(&at.second, second, second_table, second_profile, line->from, &at.f));
        same_faces = first->last_face == second->last_face;
    }
    result->at_from = at.f.value;
    if (wanted & GMI_MOMENTS)
        walk(at, first, second, to, GMI_MOMENTS, 0, result);
    else if (!same_faces)
        walk(at, first, second, to, GMI_DERIVATIVES, 0, result);
    else if (wanted & GMI_DERIVATIVES)
        walk(at, first, second, to, GMI_DERIVATIVES, 1, result);
    else
        walk(at, first, second, to, GMI_SUM, 1, result);
}

void gmi_line_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                        int wanted, gmi_line_sum *result) {
    const gmi_line_sum none = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    *result = none;
    if (line->pinion != NULL) {
        integrate_tables(line, pinion, line->pinion, line->pinion_profile, wheel, line->wheel,
                         line->wheel_profile, wanted, result);
    } else if (line->wheel != NULL) {
        integrate_tables(line, wheel, line->wheel, line->wheel_profile, &ideal_grid, NULL, 0.0,
                         wanted, result);
        result->wheel = result->pinion;
        result->pinion = 0.0;
    } else {
        integrate_ideal(line, result);
    }
}
