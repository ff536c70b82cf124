/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The integral of max(0, f) along one line of contact, f = gap + deviation of both flanks, exactly.
 *
 * In grid units the line runs through a flank's table as v1 = (face_nodes - 1) t1, v2 = profile + rate t1, and
 * within a cell the bilinear surface is quadratic in t1 there. At a grid line only slope and curvature change,
 * by the second difference of the nodes across that grid line, interpolated along it (flank.c keeps it beside
 * each node). So value, slope and curvature of f are carried along the line and corrected at each crossing: two
 * node reads and no division per crossing. Each piece between crossings is integrated in closed form, split at its
 * roots where f changes its sign.
 *
 * Crossings come in order from two to four arithmetic sequences: face lines (constant t1; one sequence for both
 * tables if their grids agree) and profile lines (constant t2) of each table.
 */
#include "internal.h"

#include <math.h>

#define NO_CROSSING 2.0 /* later than any: t1 ends at 1 */

/* Read in place of a table that is not there. */
static const double ideal_nodes[2 * GMI_NODE_DOUBLES] = {0.0};

/* The path through one flank's table. */
typedef struct trace {
    const double *cell; /* corner node of the current cell with the lowest indices */
    size_t row;         /* doubles from one face line to the next */
    ptrdiff_t step;     /* doubles from one cell to the next across a profile line, signed */
    ptrdiff_t ahead;    /* doubles from the corner to the profile line ahead */
    double step_number; /* +1 or -1, 0 without a table */
    double profile;     /* index of the corner across the profile */
    double face;        /* along the face */
    double face_rate;   /* d v1 / d t1 */
    double
        face_spacing; /* its inverse, rounded up so that the last face line is not before t1 = 1 */
    double origin, rate;                   /* v2 = origin + rate t1 */
    double profile_spacing, profile_shift; /* next_profile = profile * spacing + shift */
    double next_face, next_profile;        /* t1 of the next crossings */

    double profile_slope; /* d deviation / d v2 at the current t1 (m) */
    double slope_rate;    /* its d / d t1 within the cell (m) */
} trace;

/* f around the current t1: value, slope, half the second derivative. */
typedef struct quadratic {
    double value, slope, curvature;
} quadratic;

static inline double smaller(double a, double b) {
    return a < b ? a : b;
}

static inline double larger(double a, double b) {
    return a > b ? a : b;
}

/* Index of the cell that holds v, clamped into the table against rounding at its rim. */
static inline int cell_of(double v, int last) {
    const int cell = v > 0.0 ? (int)v : 0;
    return cell < last ? cell : last;
}

static inline double next_profile_crossing(const trace *path) {
    return path->profile * path->profile_spacing + path->profile_shift;
}

/* A flank without a table: never crossed, zeros wherever one looks. */
static inline void begin_ideal(trace *path, double face_rate, double face_spacing, double face) {
    path->cell = ideal_nodes;
    path->row = 0;
    path->step = path->ahead = 0;
    path->step_number = path->profile = path->origin = path->rate = 0.0;
    path->face = face;
    path->face_rate = face_rate;
    path->face_spacing = face_spacing;
    path->next_face = NO_CROSSING;
    path->profile_spacing = 0.0;
    path->profile_shift = path->next_profile = NO_CROSSING;
    path->profile_slope = path->slope_rate = 0.0;
}

/* Enters the table at t1 = from and adds its deviation to f. Returns the t1 at which the table ends. */
static inline double begin(trace *path, const double *table, const gmi_grid *grid, double origin,
                           double from, quadratic *f) {
    const int last_face = grid->face_nodes - 2;
    const int last_profile = grid->profile_nodes - 2;
    const double v1 = from * (double)(grid->face_nodes - 1);
    const double v2 = origin + from * grid->rate;
    const int face = cell_of(v1, last_face);
    const int profile = cell_of(v2, last_profile);
    path->row = (size_t)grid->profile_nodes * GMI_NODE_DOUBLES;
    path->cell = table + (size_t)face * path->row + (size_t)profile * GMI_NODE_DOUBLES;
    path->face = (double)face;
    path->profile = (double)profile;
    path->origin = origin;
    path->rate = grid->rate;

    /* w = corner + along_face p + along_profile q + mixed p q with p, q in [0, 1] */
    const double p = v1 - path->face;
    const double q = v2 - path->profile;
    const double corner = path->cell[0];
    const double along_face = path->cell[path->row] - corner;
    const double along_profile = path->cell[GMI_NODE_DOUBLES] - corner;
    const double mixed =
        (path->cell[path->row + GMI_NODE_DOUBLES] - path->cell[path->row]) - along_profile;
    path->face_rate = (double)(grid->face_nodes - 1);
    path->profile_slope = along_profile + mixed * p;
    path->slope_rate = mixed * path->face_rate;
    f->value += corner + along_face * p + path->profile_slope * q;
    f->slope += path->face_rate * (along_face + mixed * q) + grid->rate * path->profile_slope;
    f->curvature += grid->rate * path->slope_rate;

    path->face_spacing = (1.0 + 4e-16) / path->face_rate;
    path->next_face = (path->face + 1.0) * path->face_spacing;
    const int upwards = grid->rate > 0.0;
    path->step = upwards ? GMI_NODE_DOUBLES : -GMI_NODE_DOUBLES;
    path->ahead = upwards ? GMI_NODE_DOUBLES : 0;
    path->step_number = upwards ? 1.0 : -1.0;
    if (grid->rate == 0.0) { /* spur: along a profile line, never across one */
        path->profile_spacing = 0.0;
        path->profile_shift = path->next_profile = NO_CROSSING;
        return 1.0;
    }
    path->profile_spacing = grid->per_rate;
    path->profile_shift = ((upwards ? 1.0 : 0.0) - origin) * grid->per_rate;
    path->next_profile = next_profile_crossing(path);
    const double last_cell = upwards ? (double)last_profile : 0.0;
    return last_cell * path->profile_spacing + path->profile_shift;
}

/* Across the face line (constant t1) ahead. */
static inline void cross_face(trace *path, double t1, int wanted, quadratic *f) {
    path->cell += path->row;
    path->face += 1.0;
    path->next_face = (path->face + 1.0) * path->face_spacing;
    const double q = path->origin + t1 * path->rate - path->profile;
    const double near = path->cell[GMI_NODE_FACE];
    const double change = path->cell[GMI_NODE_DOUBLES + GMI_NODE_FACE] - near;
    const double rate_change = path->face_rate * change;
    f->slope += path->face_rate * (near + q * change);
    f->curvature += path->rate * rate_change;
    if (wanted & GMI_DERIVATIVES)
        path->slope_rate += rate_change;
}

/* Across the profile line (constant t2) ahead, upwards or downwards. `face` = v1 index of the cell. */
static inline void cross_profile(trace *path, double face, double t1, int wanted, quadratic *f) {
    const double *line = path->cell + path->ahead;
    const double p = t1 * path->face_rate - face;
    const double near = line[GMI_NODE_PROFILE];
    const double change = line[path->row + GMI_NODE_PROFILE] - near;
    const double slope_change = path->step_number * (near + p * change);
    const double rate_change = path->step_number * path->face_rate * change;
    f->slope += path->rate * slope_change;
    f->curvature += path->rate * rate_change;
    if (wanted & GMI_DERIVATIVES) {
        path->profile_slope += slope_change;
        path->slope_rate += rate_change;
    }
    path->cell += path->step;
    path->profile += path->step_number;
    path->next_profile = next_profile_crossing(path);
}

/* What one piece is made of: copied for the rare slow case, so that the walk itself stays in registers. */
typedef struct piece {
    double t1, length;
    quadratic f;
    double pinion_slope, pinion_rate;
    double wheel_slope, wheel_rate;
} piece;

/* Adds the part [begin, end] (from the start of the piece) in which f > 0. */
static inline void add_touching(const piece *part, double begin, double end, int wanted,
                                gmi_line_sum *total) {
    const quadratic f = part->f;
    const double length = end - begin;
    const double middle = 0.5 * (begin + end);
    /* Integral of the quadratic about the middle: no differences of cubes. */
    const double at_middle = f.value + middle * (f.slope + middle * f.curvature);
    const double second = length * length * (1.0 / 12.0);
    const double integral = length * (at_middle + f.curvature * second);
    total->sum += integral;
    total->contact += length;
    if (wanted & GMI_DERIVATIVES) {
        total->pinion += length * (part->pinion_slope + middle * part->pinion_rate);
        total->wheel += length * (part->wheel_slope + middle * part->wheel_rate);
    }
    if (wanted & GMI_MOMENTS) {
        const double t1 = part->t1 + middle;
        const double slope_at_middle = f.slope + 2.0 * middle * f.curvature;
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
    const double discriminant = f.slope * f.slope - 4.0 * f.curvature * f.value;
    if (discriminant > 0.0) {
        /* Without cancellation; an infinite root (curvature 0) is clamped away. */
        const double q = -0.5 * (f.slope + copysign(sqrt(discriminant), f.slope));
        const double root_1 = smaller(larger(q / f.curvature, 0.0), part->length);
        const double root_2 = smaller(larger(f.value / q, 0.0), part->length);
        cuts[1] = smaller(root_1, root_2);
        cuts[2] = larger(root_1, root_2);
    }
    for (int k = 0; k < 3; ++k) {
        const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
        if (cuts[k + 1] > cuts[k] && f.value + middle * (f.slope + middle * f.curvature) > 0.0)
            add_touching(part, cuts[k], cuts[k + 1], wanted, total);
    }
}

/*
 * Walks the line piece by piece. same_faces: both tables have the same face lines, so the pinion's sequence
 * serves both. `wanted` and `same_faces` are constants at each call: the compiler makes a walk for each.
 */
static inline void walk(trace pinion, trace wheel, quadratic f, double from, double to, int wanted,
                        int same_faces, gmi_line_sum *result) {
    double t1 = from;
    double three_sums = 0.0; /* three times the sum over the whole pieces */
    double contact = 0.0;
    double pinion_sum = 0.0, wheel_sum = 0.0;
    gmi_line_sum split = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (;;) {
        double end = smaller(smaller(pinion.next_profile, wheel.next_profile), pinion.next_face);
        if (!same_faces)
            end = smaller(end, wheel.next_face);
        end = smaller(end, to);

        /* A quadratic stays within the hull of its three Bezier points, and their mean is its own. */
        const double length = end - t1;
        const double bend = length * f.curvature;
        const double control = f.value + 0.5 * length * f.slope;
        const double end_value = f.value + length * (f.slope + bend);
        const double lowest = smaller(smaller(f.value, control), end_value);
        const double highest = larger(larger(f.value, control), end_value);
        if ((wanted & GMI_MOMENTS) == 0 && lowest >= 0.0) {
            three_sums += length * (f.value + control + end_value);
            contact += highest > 0.0 ? length : 0.0;
            if (wanted & GMI_DERIVATIVES) {
                pinion_sum += length * (pinion.profile_slope + 0.5 * length * pinion.slope_rate);
                wheel_sum += length * (wheel.profile_slope + 0.5 * length * wheel.slope_rate);
            }
        } else if (highest > 0.0) {
            const piece part = {t1,
                                length,
                                f,
                                pinion.profile_slope,
                                pinion.slope_rate,
                                wheel.profile_slope,
                                wheel.slope_rate};
            add_split(&part, wanted, &split);
        }
        f.value = end_value;
        if (end >= to)
            break;
        f.slope += 2.0 * bend;
        if (wanted & GMI_DERIVATIVES) {
            pinion.profile_slope += length * pinion.slope_rate;
            wheel.profile_slope += length * wheel.slope_rate;
        }
        t1 = end;

        const double wheel_face = same_faces ? pinion.face : wheel.face;
        if (pinion.next_profile == end)
            cross_profile(&pinion, pinion.face, end, wanted, &f);
        else if (wheel.next_profile == end)
            cross_profile(&wheel, wheel_face, end, wanted, &f);
        else if (!same_faces && wheel.next_face == end)
            cross_face(&wheel, end, wanted, &f);
        else {
            cross_face(&pinion, end, wanted, &f);
            if (same_faces)
                cross_face(&wheel, end, wanted, &f);
        }
    }
    result->sum = split.sum + three_sums * (1.0 / 3.0);
    result->contact = split.contact + contact;
    result->pinion = split.pinion + pinion_sum;
    result->wheel = split.wheel + wheel_sum;
    result->sum_t1 = split.sum_t1;
    result->contact_t1 = split.contact_t1;
    result->at_to = f.value;
}

void gmi_line_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                        int wanted, gmi_line_sum *result) {
    quadratic f = {line->gap, 0.0, 0.0};
    trace on_pinion, on_wheel;
    double to = line->to;
    if (line->pinion != NULL)
        to = smaller(to,
                     begin(&on_pinion, line->pinion, pinion, line->pinion_profile, line->from, &f));
    if (line->wheel != NULL)
        to = smaller(to, begin(&on_wheel, line->wheel, wheel, line->wheel_profile, line->from, &f));

    /* A flank without a table follows the face lines of the other. */
    if (line->pinion == NULL && line->wheel == NULL)
        begin_ideal(&on_pinion, 1.0, NO_CROSSING, 0.0);
    else if (line->pinion == NULL) {
        begin_ideal(&on_pinion, on_wheel.face_rate, on_wheel.face_spacing, on_wheel.face);
        on_pinion.next_face = on_wheel.next_face;
    }
    if (line->wheel == NULL)
        begin_ideal(&on_wheel, on_pinion.face_rate, on_pinion.face_spacing, on_pinion.face);

    result->at_from = f.value;
    const int same_faces = on_pinion.face_rate == on_wheel.face_rate;
    if (wanted == GMI_SUM && same_faces)
        walk(on_pinion, on_wheel, f, line->from, to, GMI_SUM, 1, result);
    else if (wanted == GMI_DERIVATIVES && same_faces)
        walk(on_pinion, on_wheel, f, line->from, to, GMI_DERIVATIVES, 1, result);
    else if (wanted == GMI_MOMENTS)
        walk(on_pinion, on_wheel, f, line->from, to, GMI_MOMENTS, same_faces, result);
    else
        walk(on_pinion, on_wheel, f, line->from, to, wanted, 0, result);
}
