/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The integral of max(0, f) along one line of contact, f a parabola and the tables of both flanks, exactly.
 *
 * In grid units the line climbs straight through a flank's table, and within a cell the bilinear surface is quadratic
 * along it. At a grid line only slope and curvature change, by the second difference of the nodes across that grid
 * line, interpolated along it (flank.c keeps it beside each node). So value, slope and curvature of f are carried
 * along the line and corrected at each crossing: two node reads and no division per crossing. Each piece between
 * crossings is integrated in closed form, split at its roots where f changes its sign.
 *
 * The place on the line is s, in cells of the leading table from the face line behind: it begins again with each face
 * line, so it is also the place between two nodes of a profile line. Along the profile u counts cells in the
 * direction in which the line climbs.
 *
 * Crossings come in order from two to four arithmetic sequences: face lines (constant t1; one sequence for both
 * tables if their grids agree) and profile lines (constant t2) of each table. Rounding may place a crossing just
 * behind the end of the table instead of on it: that one step beyond reads zeros or the neighbouring row.
 */
#include "internal.h"

#include <math.h>

#define NO_CROSSING 1e300    /* farther ahead than any place on a line */
#define NOWHERE     (-1e300) /* place where flanks touch since, while they do not */

/* Spur gears: the line climbs by nothing that could be seen, and yet u follows from the crossing ahead. */
#define LEAST_RATE     1e-30
#define LEAST_DISTANCE 1e-20 /* to the profile line ahead (cells) */

/* In place of a table that is not there: zeros wherever one looks. */
static const double ideal_nodes[GMI_NODE_DOUBLES] = {0.0};
static const gmi_grid ideal_grid = {0};

/* Where the line is in one flank's table. */
typedef struct trace {
    const double *ahead; /* node of the profile line ahead on the face line behind */
    double next_profile; /* s of the profile line ahead */
    double next_face;    /* s of the face line ahead, where the other table leads */
    int faces;           /* face lines still to cross */
    double slope;        /* d deviation / d u here (m) */
    double slope_rate;   /* its d / d s within the cell (m) */
} trace;

/* f around the current s: value, half the slope, half the second derivative. */
typedef struct quadratic {
    double value, half_slope, curvature;
} quadratic;

/* face_ratio: d v1 / d s. */
static void set_rates(gmi_grid *grid, double face_ratio) {
    grid->face_ratio = face_ratio;
    grid->rate = gmi_larger(grid->climb * face_ratio / grid->face_rate, LEAST_RATE);
    grid->profile_spacing = 1.0 / grid->rate;
    grid->face_kick = 0.5 * face_ratio;
    grid->profile_kick = 0.5 * grid->rate;
    grid->bend = grid->rate * face_ratio;
}

void gmi_grid_init(gmi_grid *grid, const gmi_tables *tables, double climb, double length,
                   double face_origin, double face_scale) {
    if (tables == NULL || tables->profile_nodes == 0) {
        *grid = ideal_grid;
        return;
    }

    /* Cells and strides, counted the way the line climbs. */
    const int upwards = climb > 0.0;
    const double profile_cells = (double)(tables->profile_nodes - 1);
    grid->last_face = tables->face_nodes - 2;
    grid->last_profile = tables->profile_nodes - 2;
    grid->row = (ptrdiff_t)tables->profile_nodes * GMI_NODE_DOUBLES;
    grid->step = upwards ? GMI_NODE_DOUBLES : -GMI_NODE_DOUBLES;
    grid->corner = upwards ? 0 : grid->row - GMI_NODE_DOUBLES;
    grid->direction = upwards ? 1.0 : -1.0;
    grid->base = upwards ? 0.0 : profile_cells;
    grid->profile_cells = profile_cells;
    grid->face_origin = face_origin;
    grid->face_scale = face_scale;

    /* Grid lines per t1, and per length along the line of action. */
    grid->face_rate = (double)(tables->face_nodes - 1) * face_scale;
    grid->face_base = (double)(tables->face_nodes - 1) * face_origin;
    grid->per_rho = profile_cells / length;
    grid->climb = fabs(climb) * grid->per_rho;
    set_rates(grid, 1.0);
}

void gmi_grid_move(gmi_grid *grid, double face_origin) {
    if (grid->face_rate > 0.0) {
        grid->face_base = (double)(grid->last_face + 1) * face_origin;
        grid->face_origin = face_origin;
    }
}

void gmi_grid_hold(gmi_grid *grid) {
    if (grid->face_rate > 0.0) {
        grid->climb = 0.0;
        set_rates(grid, grid->face_ratio);
    }
}

/* Index of the cell that holds v, clamped into the table against rounding at its rim. */
static inline int cell_of(double v, int last) {
    const int cell = v > 0.0 ? (int)v : 0;
    return cell < last ? cell : last;
}

static void begin_ideal(trace *path) {
    const trace ideal = {ideal_nodes, NO_CROSSING, NO_CROSSING, 0, 0.0, 0.0};
    *path = ideal;
}

/*
 * Enters the table in its cell number `face`, at the place p between the face lines of that cell and at `s` of the
 * table that leads, and adds its deviation to f. Returns the s at which the table ends.
 */
SPECIALIZED double begin(trace *path, const gmi_grid *grid, const double *table, double profile,
                         double t1, int face, double p, double s, quadratic *f) {
    const double u = grid->base + (grid->direction * profile + t1 * grid->climb);
    const int cell = cell_of(u, grid->last_profile);
    const double *behind = table + (face * grid->row + cell * grid->step + grid->corner);
    const double *ahead = behind + grid->step;

    /* w = corner + along_face p + along_profile q + mixed p q with p, q in [0, 1] */
    const double q = u - (double)cell;
    const double corner = behind[0];
    const double along_face = behind[grid->row] - corner;
    const double along_profile = ahead[0] - corner;
    const double mixed = (ahead[grid->row] - behind[grid->row]) - along_profile;
    path->ahead = ahead;
    path->slope = along_profile + mixed * p;
    path->slope_rate = mixed * grid->face_ratio;
    f->value += corner + along_face * p + path->slope * q;
    f->half_slope += grid->face_kick * (along_face + mixed * q) + grid->profile_kick * path->slope;
    f->curvature += grid->bend * mixed;

    /* The profile line ahead, and the place where the table ends. */
    path->next_profile = s + gmi_larger(1.0 - q, LEAST_DISTANCE) * grid->profile_spacing;
    return s + gmi_larger(grid->profile_cells - u, LEAST_DISTANCE) * grid->profile_spacing;
}

/* Across the face line ahead, at `s`; `ahead` is already that of the new cell. */
SPECIALIZED void cross_face(trace *path, const gmi_grid *grid, double s, int wanted, quadratic *f) {
    path->ahead += grid->row;
    const double ahead = path->ahead[GMI_NODE_FACE];
    const double back = path->ahead[GMI_NODE_FACE - grid->step] - ahead;

    /* Interpolated to where the line is between two profile lines. */
    const double distance = (path->next_profile - s) * grid->rate;
    f->half_slope += grid->face_kick * (ahead + distance * back);
    f->curvature -= grid->bend * back;
    if (wanted & GMI_DERIVATIVES) {
        path->slope_rate -= grid->face_ratio * back;
    }
}

/* Across the profile line ahead, at the place p between its nodes on the face lines behind and ahead. */
SPECIALIZED void cross_profile(trace *path, const gmi_grid *grid, double p, int wanted,
                               quadratic *f) {
    const double behind = path->ahead[GMI_NODE_PROFILE];
    const double change = path->ahead[grid->row + GMI_NODE_PROFILE] - behind;
    const double kink = behind + p * change;
    f->half_slope += grid->profile_kick * kink;
    f->curvature += grid->bend * change;
    if (wanted & GMI_DERIVATIVES) {
        path->slope += kink;
        path->slope_rate += grid->face_ratio * change;
    }
    path->ahead += grid->step;
    path->next_profile += grid->profile_spacing;
}

/* What a piece is made of: copied for the slow case, so that the walk itself stays in registers. */
typedef struct piece {
    double s, length; /* s from the first face line on (GMI_MOMENTS) */
    quadratic f;
    double first_slope, first_rate; /* d deviation / d u of both flanks, and its rate */
    double second_slope, second_rate;
} piece;

/* Integral of the quadratic about the middle of [begin, end]: no differences of cubes. */
static inline double integral_of(const quadratic *f, double length, double middle) {
    const double at_middle = f->value + middle * (2.0 * f->half_slope + middle * f->curvature);
    return length * (at_middle + f->curvature * (length * length * (1.0 / 12.0)));
}

/*
 * Integral of the square of a quadratic over a length, from its Bezier points: no terms of either sign where it is above 0.
 */
static inline double square_integral_of(double value, double control, double end_value,
                                        double length) {
    return length * (1.0 / 15.0) *
           (3.0 * (value * value + end_value * end_value) + 3.0 * control * (value + end_value) +
            2.0 * control * control + value * end_value);
}

/* First moments of the part [begin, end] (from the start of the piece), in which f > 0. */
static inline void add_moments(const piece *part, double begin, double end, gmi_line_sum *total) {
    const double length = end - begin;
    const double middle = 0.5 * (begin + end);
    const double s = part->s + middle;
    const double slope_at_middle = 2.0 * (part->f.half_slope + middle * part->f.curvature);

    /* About the middle: mean times place, and what the slope adds. */
    total->sum_t1 += s * integral_of(&part->f, length, middle) +
                     length * (length * length * (1.0 / 12.0)) * slope_at_middle;
    total->contact_t1 += s * length;
}

/* ---------------------------------------------------------------------------------------------
 * The tangent of a line: a walk finds stretches along which the flanks touch, and each table is followed along them
 * ------------------------------------------------------------------------------------------- */

/*
 * What is found along a line with its tangent; places are counted from the first face line of the table that leads. Where a
 * piece ends the flanks touch if f is above 0 there, so that pieces along which f has one sign change nothing.
 */
typedef struct tangent_walk {
    double touching_from; /* where the flanks touch since, or NOWHERE */
    double from_moves;    /* d place / d f there if that is a root of f, else 0 */
} tangent_walk;

/* Integrals over v1 of what is straight between its kinks; and times the distance from the end of the stretch. */
typedef struct straight_sums {
    double whole, by_distance;
} straight_sums;

/* Its integral over t1, and the first moment about t1 = 0, times a factor; to: t1 of the end. */
static void add_over_t1(const gmi_grid *grid, double factor, double to, const straight_sums *sums,
                        double integral[2]) {
    const double per_rate = 1.0 / grid->face_rate;
    const double whole = factor * per_rate * sums->whole;
    integral[0] += whole;
    integral[1] += to * whole - factor * per_rate * per_rate * sums->by_distance;
}

/* A point of a line in one table: its cell, the place in it, and the slopes there by u along the profile and by v1 across. */
typedef struct table_point {
    const double *node;
    int face, cell;
    double p, q;
    double along, across, mixed; /* the last one: what both change by within the cell */
} table_point;

SPECIALIZED table_point point_at(const gmi_grid *grid, const double *table, double profile,
                                 double t1) {
    const double v1 = t1 * grid->face_rate + grid->face_base;
    const double u = grid->base + (grid->direction * profile + t1 * grid->climb);
    const ptrdiff_t row = grid->row, step = grid->step;
    table_point at;
    at.face = cell_of(v1, grid->last_face);
    at.cell = cell_of(u, grid->last_profile);
    at.node = table + (at.face * row + at.cell * step + grid->corner);
    at.p = v1 - (double)at.face;
    at.q = u - (double)at.cell;
    const double across = at.node[row] - at.node[0];
    at.mixed = (at.node[row + step] - at.node[step]) - across;
    at.along = (at.node[step] - at.node[0]) + at.mixed * at.p;
    at.across = across + at.mixed * at.q;
    return at;
}

/*
 * Follows one table from t1 to t1, and its slopes by u along the profile and by v1 across the face. In a cell w is bilinear:
 * along the line both slopes are straight. At a profile line the one along has a step, at a face line the one across, and
 * at both the rate at which they change, what is mixed, has another one. A step J and a step K of the rate at the distance x
 * from the end add J x + K x^2 / 2 to the integral, and J x^2 / 2 + K x^3 / 6 to that times the distance: so does the
 * beginning. Of the second differences beside the nodes. has_face: a constant at each call.
 */
SPECIALIZED void follow_slopes(const gmi_grid *grid, const table_point *at, double length,
                               int has_face, straight_sums *along, straight_sums *across) {
    const ptrdiff_t row = grid->row, step = grid->step;
    const double rate = grid->rate, spacing = grid->profile_spacing;
    int faces = grid->last_face - at->face, profiles = grid->last_profile - at->cell;

    /* Sums of J x and J x^2 of both slopes, and of K x^2 and K x^3, which they share. */
    double along_1 = at->along * length, along_2 = along_1 * length;
    double across_1 = at->across * length, across_2 = across_1 * length;
    double rates_2 = at->mixed * (length * length), rates_3 = rates_2 * length;

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
            const double change_x2 = change * x * x;
            along_1 += kink_x;
            along_2 += kink_x * x;
            rates_2 += change_x2;
            rates_3 += change_x2 * x;
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
        const double back_x2 = back * face_line * face_line;
        rates_2 -= back_x2;
        rates_3 -= back_x2 * face_line;
        if (has_face) {
            const double kink_x = (on_line + (face_line - x) * rate * back) * face_line;
            across_1 += kink_x;
            across_2 += kink_x * face_line;
        }
        face_line -= 1.0;
        faces -= 1;
    }
    along->whole = along_1 + 0.5 * rates_2;
    along->by_distance = 0.5 * along_2 + (1.0 / 6.0) * rates_3;
    across->whole = across_1 + rate * (0.5 * rates_2);
    across->by_distance = 0.5 * across_2 + rate * ((1.0 / 6.0) * rates_3);
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

/* Where f passes zero the touching part moves by d f / |d f / d t1|; moves: d place / d f, 0 where there is no root. */
static void add_tangent_root(double t1, double moves, const double slopes[3],
                             gmi_line_tangent *tangent) {
    if (!(moves > 0.0)) {
        return;
    }
    moves *= tangent->per_place;
    double by[GMI_COORDINATES];
    const double powers_of_t1[3] = {1.0, t1, t1 * t1};
    sum_powers(tangent, powers_of_t1, by);
    gmi_line_add_slopes(tangent, slopes[0], slopes[1], slopes[2], by);
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        const double moved = moves * by[k];
        tangent->contact_by[k][0] += moved;
        tangent->contact_by[k][1] += moved * t1;
        tangent->contact_by[k][2] += moved * powers_of_t1[2];
    }
}

/* A stretch of the line, from place to place, along which the flanks touch; d place / d f at roots of f, else 0. */
static OWN_STACK void add_stretch(double from_place, double to_place, double from_moves,
                                  double to_moves, gmi_line_tangent *tangent) {
    const double from = tangent->t1_zero + from_place * tangent->per_place;
    const double to = tangent->t1_zero + to_place * tangent->per_place;

    /* Moments up to the third. */
    const double length = (to_place - from_place) * tangent->per_place;
    const double middle = tangent->t1_zero + 0.5 * (from_place + to_place) * tangent->per_place;
    const double spread = length * length * (1.0 / 12.0);
    tangent->part_contact[0] += length;
    tangent->part_contact[1] += length * middle;
    tangent->part_contact[2] += length * (middle * middle + spread);
    tangent->part_contact[3] += length * middle * (middle * middle + 3.0 * spread);

    /* The slopes of both tables, and what they are at roots. */
    const gmi_line *line = tangent->line;
    double at_from[3] = {0.0, 0.0, 0.0}, at_to[3] = {0.0, 0.0, 0.0};
    straight_sums along, across;
    if (line->pinion != NULL) {
        const gmi_grid *grid = tangent->pinion;
        const table_point at = point_at(grid, line->pinion, line->pinion_profile, from);
        follow_slopes(grid, &at, length * grid->face_rate, 0, &along, &across);
        add_over_t1(grid, grid->direction, to, &along, tangent->part_slopes[0]);
        at_from[0] = grid->direction * at.along;
        if (to_moves > 0.0) {
            const table_point end = point_at(grid, line->pinion, line->pinion_profile, to);
            at_to[0] = grid->direction * end.along;
        }
    }
    if (line->wheel != NULL) {
        const gmi_grid *grid = tangent->wheel;
        const table_point at = point_at(grid, line->wheel, line->wheel_profile, from);
        follow_slopes(grid, &at, length * grid->face_rate, 1, &along, &across);
        add_over_t1(grid, grid->direction, to, &along, tangent->part_slopes[1]);
        add_over_t1(grid, 1.0, to, &across, tangent->part_slopes[2]);
        at_from[1] = grid->direction * at.along;
        at_from[2] = at.across;
        if (to_moves > 0.0) {
            const table_point end = point_at(grid, line->wheel, line->wheel_profile, to);
            at_to[1] = grid->direction * end.along;
            at_to[2] = end.across;
        }
    }
    add_tangent_root(from, from_moves, at_from, tangent);
    add_tangent_root(to, to_moves, at_to, tangent);
}

static void begin_stretch(tangent_walk *walked, double place, double moves) {
    walked->touching_from = place;
    walked->from_moves = moves;
}

static void end_stretch(tangent_walk *walked, double place, double moves,
                        gmi_line_tangent *tangent) {
    if (walked->touching_from > NOWHERE) {
        add_stretch(walked->touching_from, place, walked->from_moves, moves, tangent);
        walked->touching_from = NOWHERE;
    }
}

/* A part of a piece in which f > 0: it goes on with a stretch, or begins one, and may end it. */
static void go_on_touching(const piece *part, double begin, double end, double moves,
                           tangent_walk *walked, gmi_line_tangent *tangent) {
    if (begin > 0.0) {
        end_stretch(walked, part->s, 0.0, tangent);
        begin_stretch(walked, part->s + begin, moves);
    } else if (walked->touching_from == NOWHERE) {
        begin_stretch(walked, part->s, 0.0);
    }
    if (end < part->length) {
        end_stretch(walked, part->s + end, moves, tangent);
    }
}

/* The integrals of a part become those of d f / d coordinate. */
static void finish_tangent(gmi_line_tangent *tangent) {
    /* Of 1 and of t1: what the polynomials give over the touching part, and the slopes of the flanks. */
    for (int weight = 0; weight < 2; ++weight) {
        const double *contact = &tangent->part_contact[weight];
        double by[GMI_COORDINATES];
        sum_powers(tangent, contact, by);
        gmi_line_add_slopes(tangent, tangent->part_slopes[0][weight],
                            tangent->part_slopes[1][weight], tangent->part_slopes[2][weight], by);
        for (int k = 0; k < GMI_COORDINATES; ++k) {
            tangent->sum_by[k][weight] += by[k];
        }
    }

    /* The next part begins anew. */
    for (int power = 0; power < 4; ++power) {
        tangent->contact[power] += tangent->part_contact[power];
        tangent->part_contact[power] = 0.0;
    }
    for (int k = 0; k < 3; ++k) {
        tangent->part_slopes[k][0] = tangent->part_slopes[k][1] = 0.0;
    }
}

/* Adds the part [begin, end] (from the start of the piece), in which f > 0. */
static inline void add_touching(const piece *part, double begin, double end, int wanted,
                                gmi_line_sum *total) {
    const double length = end - begin;
    const double middle = 0.5 * (begin + end);
    const double integral = integral_of(&part->f, length, middle);

    total->sum += gmi_larger(integral, 0.0); /* below 0 by rounding where f is next to nothing */
    total->contact += length;
    if (wanted & GMI_DERIVATIVES) {
        total->pinion += length * (part->first_slope + middle * part->first_rate);
        total->wheel += length * (part->second_slope + middle * part->second_rate);
    }
    if (wanted & GMI_MOMENTS) {
        add_moments(part, begin, end, total);
    }
}

/* The same with the square of f. */
static inline void add_touching_square(const piece *part, double begin, double end,
                                       gmi_line_sum *total) {
    const quadratic *f = &part->f;
    const double length = end - begin;
    const double half_slope = f->half_slope + begin * f->curvature;
    const double value = f->value + begin * (f->half_slope + half_slope);
    const double control = value + length * half_slope;
    const double end_value = control + length * (half_slope + length * f->curvature);
    total->sum += square_integral_of(value, control, end_value, length);
    total->contact += length;
}

/*
 * A root of f within the piece ends a touching part. When f grows by df everywhere, it moves by df / |df/ds| and the
 * touching part grows by that, whichever way f crosses zero.
 */
static inline void add_root(const piece *part, double root, double per_slope, gmi_line_sum *total) {
    if (root > 0.0 && root < part->length) {
        total->roots += per_slope;
        total->roots_pinion += per_slope * (part->first_slope + root * part->first_rate);
        total->roots_wheel += per_slope * (part->second_slope + root * part->second_rate);
    }
}

/* A piece in which f may change its sign: split at the roots of the quadratic. is_square: a constant at each call. */
SPECIALIZED void split_piece(const piece *part, int wanted, int is_square, tangent_walk *walked,
                             gmi_line_sum *total) {
    const quadratic f = part->f;
    if (!(part->length > 0.0)) { /* two crossings at the same t1, up to rounding */
        return;
    }

    /* Roots within the piece divide it into three parts at most. */
    double cuts[4] = {0.0, 0.0, 0.0, part->length};
    double per_slope = 0.0;
    const double discriminant = f.half_slope * f.half_slope - f.curvature * f.value;
    if (discriminant > 0.0) {
        /* Without cancellation; an infinite root (curvature 0) is clamped away. */
        const double half_slope_at_root =
            sqrt(discriminant); /* the same at both, but for its sign */
        const double q = -(f.half_slope + copysign(half_slope_at_root, f.half_slope));
        const double root_1 = gmi_smaller(gmi_larger(q / f.curvature, 0.0), part->length);
        const double root_2 = gmi_smaller(gmi_larger(f.value / q, 0.0), part->length);
        cuts[1] = gmi_smaller(root_1, root_2);
        cuts[2] = gmi_larger(root_1, root_2);
        if (wanted & GMI_CONTACT_DERIVATIVES || walked != NULL) {
            per_slope = 0.5 / half_slope_at_root;
        }
        if (wanted & GMI_CONTACT_DERIVATIVES) {
            add_root(part, cuts[1], per_slope, total);
            add_root(part, cuts[2], per_slope, total);
        }
    }

    /* In each part f has one sign, which it shows in the middle. */
    for (int k = 0; k < 3; ++k) {
        const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
        const double at_middle = f.value + middle * (2.0 * f.half_slope + middle * f.curvature);
        if (cuts[k + 1] > cuts[k] && at_middle > 0.0) {
            if (is_square) {
                add_touching_square(part, cuts[k], cuts[k + 1], total);
                continue;
            }
            add_touching(part, cuts[k], cuts[k + 1], wanted, total);
            if (walked != NULL) {
                go_on_touching(part, cuts[k], cuts[k + 1], per_slope, walked, total->tangent);
            }
        }
    }
}

static void add_split(const piece *part, int wanted, gmi_line_sum *total) {
    split_piece(part, wanted, 0, NULL, total);
}

static void add_split_squares(const piece *part, gmi_line_sum *total) {
    split_piece(part, GMI_SUM, 1, NULL, total);
}

/* The same with the stretches of a tangent; end_value: f at the end, where rounding may have put a root on either side. */
static void add_split_tangent(const piece *part, double end_value, int wanted, tangent_walk *walked,
                              gmi_line_sum *total) {
    split_piece(part, wanted, 0, walked, total);
    const double end = part->s + part->length;
    if (!(end_value > 0.0)) {
        end_stretch(walked, end, 0.0, total->tangent);
    } else if (walked->touching_from == NOWHERE) {
        begin_stretch(walked, end, 0.0);
    }
}

/* A walk along a line: where it is, f there, and the sums over whole pieces so far. */
typedef struct walk_state {
    double s;
    quadratic f;
    trace first, second; /* through the tables of both flanks; the first one's face lines lead */
    double faces;        /* face lines behind that one (GMI_MOMENTS without GMI_TANGENT) */
    double three_sums;   /* three times the sum; of squares once */
    double contact;
    double two_first, two_second; /* twice the sums of d deviation / d u of both flanks */

    /* Sums over pieces of three_sums times both ends, and of the square of the length times the change of f (GMI_TANGENT). */
    double six_moments, twelve_moments;
    double two_faces; /* twice the face lines behind (GMI_TANGENT) */
} walk_state;

/* Where it is, counted from the first face line on. */
SPECIALIZED double place_of(const walk_state *at, int wanted) {
    return (wanted & GMI_TANGENT ? 0.5 * at->two_faces : at->faces) + at->s;
}

SPECIALIZED piece piece_ahead(const walk_state *at, double length, int wanted) {
    const piece part = {wanted & GMI_MOMENTS ? place_of(at, wanted) : 0.0,
                        length,
                        at->f,
                        at->first.slope,
                        at->first.slope_rate,
                        at->second.slope,
                        at->second.slope_rate};
    return part;
}

/* What f is at three points that hold the piece in their hull, and how it grows with the shift. */
typedef struct hull {
    double value[3], grows[3];
} hull;

SPECIALIZED double lowest_of(const hull *points, double shift) {
    return gmi_smaller(gmi_smaller(points->value[0] + shift * points->grows[0],
                                   points->value[1] + shift * points->grows[1]),
                       points->value[2] + shift * points->grows[2]);
}

SPECIALIZED double highest_of(const hull *points, double shift) {
    return gmi_larger(gmi_larger(points->value[0] + shift * points->grows[0],
                                 points->value[1] + shift * points->grows[1]),
                      points->value[2] + shift * points->grows[2]);
}

/* The least shift at which the piece touches: at an end, or at the top of a hump. */
static OWN_STACK double touch_of(const piece *part, const hull *points) {
    const quadratic *f = &part->f;
    const double touch =
        gmi_smaller(-points->value[0] / points->grows[0], -points->value[2] / points->grows[2]);
    const double top = -f->half_slope / f->curvature;
    if (!(f->curvature < 0.0 && top > 0.0 && top < part->length)) {
        return touch;
    }
    const double share = top / part->length;
    const double grows = points->grows[0] + share * (points->grows[2] - points->grows[0]);
    return gmi_smaller(touch, -(f->value + top * f->half_slope) / grows);
}

/* A part of the piece touches at depth n. */
static void add_part_depth(const piece *part, const hull *points, int n, gmi_depths *depths) {
    const double shift = depths->shift[n];
    const double grows_rate = (points->grows[2] - points->grows[0]) / part->length;
    piece moved = *part;
    gmi_line_sum sum = {.sum = 0.0};
    moved.f.value += shift * points->grows[0];
    moved.f.half_slope += 0.5 * shift * grows_rate;
    add_split(&moved, GMI_DERIVATIVES | GMI_CONTACT_DERIVATIVES, &sum);

    const double per_place = depths->per_place;
    const double first = depths->shift_first, second = depths->shift_second;
    gmi_depth_sum *at = &depths->part[n];
    at->sum += per_place * sum.sum;
    at->by_delta += per_place * (sum.contact + first * sum.pinion + second * sum.wheel);
    at->by_origin +=
        per_place * (depths->origin_first * sum.pinion + depths->origin_second * sum.wheel);
    at->bend += per_place * (0.5 * sum.roots + first * sum.roots_pinion + second * sum.roots_wheel);
}

/* The first depth whose shift is larger: from where it would be if they were even. */
static inline int depth_behind(double shift, const gmi_depths *depths) {
    const double place = (shift - depths->shift[0]) * depths->per_shift;
    const int last = depths->count - 1;
    int n = place > 0.0 ? (place < (double)last ? (int)place : last) : 0;
    while (n > 0 && depths->shift[n - 1] > shift) {
        --n;
    }
    while (n <= last && !(depths->shift[n] > shift)) {
        ++n;
    }
    return n;
}

/* The depths at which a part of the piece touches, one by one. Returns the first one at which all of it does. */
static OWN_STACK int add_part_depths(const piece *part, const hull *points, gmi_depths *depths) {
    double some = HUGE_VAL, all = -HUGE_VAL;
    for (int k = 0; k < 3; ++k) {
        const double touch = -points->value[k] / points->grows[k];
        some = gmi_smaller(some, touch);
        all = gmi_larger(all, touch);
    }

    const int whole = depth_behind(all, depths);
    for (int n = depth_behind(some, depths); n < whole; ++n) {
        add_part_depth(part, points, n, depths);
    }
    return whole;
}

/* A piece at all depths: at the small ones none of it touches, then a part, then all of it. */
SPECIALIZED void add_depths(const piece *part, const hull *points, gmi_depths *depths) {
    const double length = part->length;
    if (!(length > 0.0)) {
        return;
    }
    if (highest_of(points, depths->touch) > 0.0) {
        depths->touch = gmi_smaller(depths->touch, touch_of(part, points));
    }
    if (!(highest_of(points, depths->largest) > 0.0)) {
        return;
    }
    const int whole =
        lowest_of(points, depths->shift[0]) > 0.0 ? 0 : add_part_depths(part, points, depths);

    /* From there on all of it does: linear in the shift. */
    if (whole < depths->count) {
        const double weight = depths->per_place * length;
        const double first = part->first_slope + 0.5 * length * part->first_rate;
        const double second = part->second_slope + 0.5 * length * part->second_rate;
        gmi_depth_sum *at = &depths->whole[whole];
        at->sum += weight * (points->value[0] + points->value[1] + points->value[2]) * (1.0 / 3.0);
        at->by_delta += weight * points->grows[1];
        at->by_origin += weight * (depths->origin_first * first + depths->origin_second * second);
    }
}

/* How f grows with the shift where the walk is. */
SPECIALIZED double growth_at(const walk_state *at, const gmi_depths *depths) {
    return 1.0 + depths->shift_first * at->first.slope + depths->shift_second * at->second.slope;
}

/*
 * The wheel's table moves along the line by per_shift times the shift (in cells), and with it the place of a kink: between
 * its old place and the new one f is off by a triangle, whichever way it moves. before: the trace there before the kink.
 */
SPECIALIZED void add_kink(const walk_state *at, const trace *path, const trace *before,
                          double per_shift, double rate, gmi_depths *depths) {
    const double grows = growth_at(at, depths);
    if (per_shift == 0.0 || !(at->f.value + depths->largest * grows > 0.0)) {
        return;
    }
    const int whole = at->f.value + depths->shift[0] * grows > 0.0
                          ? 0
                          : depth_behind(-at->f.value / grows, depths);
    if (whole < depths->count) {
        const double moved = per_shift / rate;
        const double area = 0.5 * depths->per_place * per_shift * moved;
        depths->whole[whole].bend += area * (path->slope - before->slope);
        depths->cube[whole] -= area * moved * (1.0 / 3.0) * (path->slope_rate - before->slope_rate);
    }
}

/* f at an end of a line, as seen from there. */
SPECIALIZED gmi_depth_end end_at(const walk_state *at, const gmi_grid *first,
                                 const gmi_depths *depths) {
    const double rate = first->face_rate; /* from t1 to s */
    const gmi_depth_end end = {2.0 * at->f.half_slope * rate, at->f.curvature * (rate * rate),
                               growth_at(at, depths),
                               rate * (depths->shift_first * at->first.slope_rate +
                                       depths->shift_second * at->second.slope_rate)};
    return end;
}

/* Integrates the piece up to `end` and goes there. walked: of a tangent. */
SPECIALIZED void advance(walk_state *at, double end, int wanted, tangent_walk *walked,
                         gmi_line_sum *split) {
    /* A quadratic stays within the hull of its three Bezier points, and their mean is its own. */
    const double length = end - at->s;
    const double value = at->f.value;
    const double control = value + length * at->f.half_slope;
    const double end_half_slope = at->f.half_slope + length * at->f.curvature;
    const double end_value = control + length * end_half_slope;

    /* The slopes of both tables at the end. */
    const double first_slope = at->first.slope + length * at->first.slope_rate;
    const double second_slope = at->second.slope + length * at->second.slope_rate;

    /* Touching all along, which is two pieces of three; or in part; or not at all. */
    if (wanted & GMI_DEPTHS) {
        const piece part = piece_ahead(at, length, wanted);
        const double first = split->depths->shift_first, second = split->depths->shift_second;
        const double grows = 1.0 + first * at->first.slope + second * at->second.slope;
        const double grows_at_end = 1.0 + first * first_slope + second * second_slope;
        const hull points = {{value, control, end_value},
                             {grows, 0.5 * (grows + grows_at_end), grows_at_end}};
        add_depths(&part, &points, split->depths);
    } else if (gmi_smaller(gmi_smaller(value, control), end_value) > 0.0) {
        const double three = wanted & GMI_SQUARES
                                 ? square_integral_of(value, control, end_value, length)
                                 : length * (value + control + end_value);
        at->three_sums += three;
        if (!(wanted & GMI_TANGENT)) { /* whose stretches tell */
            at->contact += length;
        }
        if (wanted & GMI_DERIVATIVES) {
            at->two_first += length * (at->first.slope + first_slope);
            at->two_second += length * (at->second.slope + second_slope);
        }
        if (wanted & GMI_TANGENT) { /* about the middle of the piece */
            at->six_moments += three * (at->s + end + at->two_faces);
            at->twelve_moments += length * length * (end_value - value);
        } else if (wanted & GMI_MOMENTS) {
            const piece part = piece_ahead(at, length, wanted);
            add_moments(&part, 0.0, length, split);
        }
    } else if (gmi_larger(gmi_larger(value, control), end_value) > 0.0) {
        const piece part = piece_ahead(at, length, wanted);
        if (wanted & GMI_TANGENT) {
            add_split_tangent(&part, end_value, wanted, walked, split);
        } else if (wanted & GMI_SQUARES) {
            add_split_squares(&part, split);
        } else {
            add_split(&part, wanted, split);
        }
    }

    /* Go there. */
    at->s = end;
    at->f.value = end_value;
    at->f.half_slope = end_half_slope;
    if (wanted & GMI_DERIVATIVES) {
        at->first.slope = first_slope;
        at->second.slope = second_slope;
    }
}

/*
 * Walks on through the tables of two flanks until s = end, behind any face line. same_faces: the first table's
 * face lines serve both. `wanted` and `same_faces` are constants at each call.
 */
SPECIALIZED void walk_cell(walk_state *at, const gmi_grid *first, const gmi_grid *second,
                           double end, int wanted, int same_faces, tangent_walk *walked,
                           gmi_line_sum *split) {
    for (;;) {
        const double face_line =
            same_faces || at->second.faces <= 0 ? end : gmi_smaller(end, at->second.next_face);

        /* Profile lines of both tables in their order, up to the face line. */
        for (;;) {
            if (at->first.next_profile < at->second.next_profile) {
                if (!(at->first.next_profile < face_line)) {
                    break;
                }
                advance(at, at->first.next_profile, wanted, walked, split);
                const trace before = at->first;
                cross_profile(&at->first, first, at->s, wanted, &at->f);
                if (wanted & GMI_DEPTHS) {
                    add_kink(at, &at->first, &before, split->depths->shift_first, first->rate,
                             split->depths);
                }
            } else {
                if (!(at->second.next_profile < face_line)) {
                    break;
                }
                advance(at, at->second.next_profile, wanted, walked, split);
                const double p =
                    same_faces ? at->s : 1.0 - (at->second.next_face - at->s) * second->face_ratio;
                const trace before = at->second;
                cross_profile(&at->second, second, p, wanted, &at->f);
                if (wanted & GMI_DEPTHS) {
                    add_kink(at, &at->second, &before, split->depths->shift_second, second->rate,
                             split->depths);
                }
            }
        }

        /* On to the face line of the second table, or to the end. */
        advance(at, face_line, wanted, walked, split);
        if (same_faces || !(face_line < end)) {
            return;
        }
        cross_face(&at->second, second, face_line, wanted, &at->f);
        at->second.faces -= 1;
        at->second.next_face += 1.0 / second->face_ratio;
    }
}

/* Across the face line of the leading table, where s begins again. */
SPECIALIZED void enter_next_cell(walk_state *at, const gmi_grid *first, const gmi_grid *second,
                                 int wanted, int same_faces) {
    at->s = 0.0;
    if (wanted & GMI_TANGENT) {
        at->two_faces += 2.0;
    } else if (wanted & GMI_MOMENTS) {
        at->faces += 1.0;
    }

    /* All places on the line are counted from the new face line on. */
    at->first.faces -= 1;
    at->first.next_profile -= 1.0;
    at->second.next_profile -= 1.0;
    if (!same_faces) {
        at->second.next_face -= 1.0;
    }

    cross_face(&at->first, first, 0.0, wanted, &at->f);
    if (same_faces) {
        cross_face(&at->second, second, 0.0, wanted, &at->f);
    }
}

/*
 * Walks a line piece by piece to `end`, which is counted from the face line behind its beginning. In the result
 * "pinion" is the first flank.
 */
SPECIALIZED void walk(walk_state at, const gmi_grid *first, const gmi_grid *second, double end,
                      int wanted, int same_faces, tangent_walk *walked, gmi_line_sum *result) {
    if (wanted & GMI_TANGENT) {
        at.six_moments = at.twelve_moments = 0.0;
        at.two_faces = 2.0 * at.faces;
        if (at.f.value > 0.0) {
            begin_stretch(walked, place_of(&at, wanted), 0.0);
        }
    }
    const double end_in_last = end - (double)at.first.faces;
    for (;;) {
        const int is_last = at.first.faces <= 0;
        walk_cell(&at, first, second, is_last ? end_in_last : 1.0, wanted, same_faces, walked,
                  result);
        if (is_last) {
            break;
        }
        enter_next_cell(&at, first, second, wanted, same_faces);
    }

    if (wanted & GMI_TANGENT) {
        end_stretch(walked, place_of(&at, wanted), 0.0, result->tangent);
        result->sum_t1 += (2.0 * at.six_moments + at.twelve_moments) * (1.0 / 12.0);
    }
    const double per_rate = 1.0 / first->face_rate; /* from s to t1 */
    const double share = wanted & GMI_SQUARES ? 1.0 : 1.0 / 3.0;
    result->sum = per_rate * (result->sum + at.three_sums * share);
    result->contact = per_rate * (result->contact + at.contact);
    if (wanted & GMI_MOMENTS) { /* from v1 = face_base + face_rate t1 */
        const double base = first->face_base * per_rate;
        result->sum_t1 = result->sum_t1 * (per_rate * per_rate) - base * result->sum;
        result->contact_t1 = result->contact_t1 * (per_rate * per_rate) - base * result->contact;
    }
    if (wanted & GMI_DERIVATIVES) {
        result->pinion = per_rate * first->direction * (result->pinion + 0.5 * at.two_first);
        result->wheel = per_rate * second->direction * (result->wheel + 0.5 * at.two_second);
    }
    if (wanted & GMI_CONTACT_DERIVATIVES) { /* from 1 / |df/ds| to 1 / |df/dt1| */
        result->roots *= per_rate;
        result->roots_pinion *= per_rate * first->direction;
        result->roots_wheel *= per_rate * second->direction;
    }
    if (wanted & GMI_DEPTHS) {
        result->depths->to = end_at(&at, first, result->depths);
    }
    result->at_to = at.f.value;
}

/* No table on either flank: f is the same all along, or straight where there are ramps. */
static void integrate_ideal(const gmi_line *line, int wanted, gmi_line_sum *result) {
    const double length = line->to - line->from;
    result->at_from = line->overlap;
    result->at_to = line->overlap + length * (2.0 * line->half_slope + length * line->curvature);

    /* A parabola is one piece, split at its roots; a constant touches as a whole, or not at all. */
    if (line->half_slope != 0.0 || line->curvature != 0.0) {
        const quadratic f = {line->overlap, line->half_slope, line->curvature};
        const piece part = {line->from, length, f, 0.0, 0.0, 0.0, 0.0};
        if (wanted & GMI_TANGENT) {
            tangent_walk walked = {NOWHERE, 0.0};
            add_split_tangent(&part, result->at_to, wanted, &walked, result);
            end_stretch(&walked, line->to, 0.0, result->tangent);
        } else {
            add_split(&part, wanted, result);
        }
    } else if (line->overlap > 0.0) {
        result->sum = line->overlap * length;
        result->contact = length;
        result->contact_t1 = 0.5 * length * (line->from + line->to);
        result->sum_t1 = line->overlap * result->contact_t1;
        if (wanted & GMI_TANGENT) {
            add_stretch(line->from, line->to, 0.0, 0.0, result->tangent);
        }
    }
}

/* Face lines of both tables for themselves: as of two gears that have moved against each other. */
static OWN_STACK void walk_apart(walk_state at, const gmi_grid *first, const gmi_grid *second,
                                 double end, int wanted, gmi_line_sum *result) {
    if (wanted == GMI_SUM) {
        walk(at, first, second, end, GMI_SUM, 0, NULL, result);
    } else {
        walk(at, first, second, end, wanted & ~(GMI_TANGENT | GMI_DEPTHS | GMI_SQUARES), 0, NULL,
             result);
    }
}

/* The walk of a tangent, apart from the others, which gcc then compiles as if it were not there. */
static OWN_STACK void walk_tangent(const walk_state *at, const gmi_grid *first,
                                   const gmi_grid *second, double end, int same_faces,
                                   gmi_line_sum *result) {
    enum { TANGENT = GMI_TANGENT | GMI_MOMENTS };
    gmi_line_tangent *tangent = result->tangent;
    tangent_walk walked = {NOWHERE, 0.0};
    tangent->per_place = 1.0 / first->face_rate;
    tangent->t1_zero = -first->face_base * tangent->per_place;
    if (same_faces) {
        walk(*at, first, second, end, TANGENT, 1, &walked, result);
    } else {
        walk(*at, first, second, end, TANGENT, 0, &walked, result);
    }
    result->contact = tangent->part_contact[0];
    result->contact_t1 = tangent->part_contact[1];
}

/* The walk at all depths, apart like that of a tangent. */
static OWN_STACK void walk_depths(walk_state at, const gmi_grid *first, const gmi_grid *second,
                                  double end, int same_faces, gmi_line_sum *result) {
    enum { AT_DEPTHS = GMI_DEPTHS | GMI_DERIVATIVES };
    result->depths->from = end_at(&at, first, result->depths);
    if (same_faces) {
        walk(at, first, second, end, AT_DEPTHS, 1, NULL, result);
    } else {
        walk(at, first, second, end, AT_DEPTHS, 0, NULL, result);
    }
}

/* The walk for squares. */
static OWN_STACK void walk_squares(walk_state at, const gmi_grid *first, const gmi_grid *second,
                                   double end, int same_faces, gmi_line_sum *result) {
    if (same_faces) {
        walk(at, first, second, end, GMI_SQUARES, 1, NULL, result);
    } else {
        walk(at, first, second, end, GMI_SQUARES, 0, NULL, result);
    }
}

/* What a walk is for, beside sums. */
enum walk_kind { WALK_SUMS, WALK_TANGENT, WALK_DEPTHS, WALK_SQUARES };

/* The pinion, which leads, has a table; the wheel may have one. */
SPECIALIZED void walk_tables(const gmi_line *line, const gmi_grid *first, const gmi_grid *second,
                             int wanted, enum walk_kind kind, gmi_line_sum *result) {
    const double v1 = line->from * first->face_rate + first->face_base;
    const double to = line->to * first->face_rate + first->face_base;
    const int face = cell_of(v1, first->last_face);
    const double s = v1 - (double)face;

    int same_faces = 1;
    gmi_grid scaled;
    walk_state at; /* every field is set below; zeroing all first costs as much as ten pieces */
    at.s = s;
    at.faces = (double)face;
    at.f = (quadratic){line->overlap, line->half_slope / first->face_rate,
                       line->curvature / (first->face_rate * first->face_rate)};
    at.three_sums = at.contact = at.two_first = at.two_second = 0.0;

    /* Into both tables. Face lines are shared, or those of the second one are counted in cells of the first. */
    at.first.faces = cell_of(to, first->last_face) - face;
    double end =
        gmi_smaller(to - (double)face, begin(&at.first, first, line->pinion, line->pinion_profile,
                                             line->from, face, s, s, &at.f));
    if (line->wheel == NULL) {
        begin_ideal(&at.second);
        second = &ideal_grid;
    } else if (second->shares_faces) {
        at.second.faces = 0;
        end = gmi_smaller(end, begin(&at.second, second, line->wheel, line->wheel_profile,
                                     line->from, face, s, s, &at.f));
    } else {
        same_faces = 0;
        if (second->face_rate != first->face_rate) {
            scaled = *second;
            set_rates(&scaled, second->face_rate / first->face_rate);
            second = &scaled;
        }
        const double second_v1 = line->from * second->face_rate + second->face_base;
        const int second_face = cell_of(second_v1, second->last_face);
        const double p = second_v1 - (double)second_face;
        at.second.faces =
            cell_of(line->to * second->face_rate + second->face_base, second->last_face) -
            second_face;
        at.second.next_face = s + (1.0 - p) / second->face_ratio;
        end = gmi_smaller(end, begin(&at.second, second, line->wheel, line->wheel_profile,
                                     line->from, second_face, p, s, &at.f));
    }

    result->at_from = at.f.value;

    /* A walk of its own for each mask that solvers use: what is not wanted costs nothing in it. */
    enum { DAMPED = GMI_DERIVATIVES | GMI_CONTACT_DERIVATIVES };
    if (kind != WALK_SUMS && same_faces) {
        at.second.next_face = NO_CROSSING;
    }
    if (kind == WALK_TANGENT) {
        walk_tangent(&at, first, second, end, same_faces, result);
    } else if (kind == WALK_SQUARES) {
        walk_squares(at, first, second, end, same_faces, result);
    } else if (kind == WALK_DEPTHS) {
        walk_depths(at, first, second, end, same_faces, result);
    } else if (!same_faces) {
        walk_apart(at, first, second, end, wanted, result);
    } else if (wanted == GMI_SUM) {
        walk(at, first, second, end, GMI_SUM, 1, NULL, result);
    } else if (wanted == GMI_DERIVATIVES) {
        walk(at, first, second, end, GMI_DERIVATIVES, 1, NULL, result);
    } else if (wanted == DAMPED) {
        walk(at, first, second, end, DAMPED, 1, NULL, result);
    } else if (wanted == GMI_MOMENTS) {
        walk(at, first, second, end, GMI_MOMENTS, 1, NULL, result);
    } else {
        walk(at, first, second, end, wanted & ~(GMI_TANGENT | GMI_DEPTHS | GMI_SQUARES), 1, NULL,
             result);
    }
}

/* Where only the wheel has a table it leads: the same line with it in the pinion's place. */
static gmi_line led_by_wheel(const gmi_line *line) {
    gmi_line led = *line;
    led.pinion = line->wheel;
    led.pinion_profile = line->wheel_profile;
    led.wheel = NULL;
    return led;
}

static OWN_STACK void integrate_tables(const gmi_line *line, const gmi_grid *pinion,
                                       const gmi_grid *wheel, int wanted, gmi_line_sum *result) {
    walk_tables(line, pinion, wheel, wanted, WALK_SUMS, result);
}

static OWN_STACK void integrate_wheel(const gmi_line *line, const gmi_grid *wheel, int wanted,
                                      gmi_line_sum *result) {
    const gmi_line led = led_by_wheel(line);
    integrate_tables(&led, wheel, &ideal_grid, wanted, result);

    /* The first flank was the wheel. */
    result->wheel = result->pinion;
    result->pinion = 0.0;
    if (wanted & GMI_CONTACT_DERIVATIVES) {
        result->roots_wheel = result->roots_pinion;
        result->roots_pinion = 0.0;
    }
}

void gmi_line_integrate_tangent(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                                gmi_line_sum *result) {
    enum { TANGENT = GMI_TANGENT | GMI_MOMENTS };
    gmi_line_tangent *tangent = line->tangent;
    const int wheel_leads = line->pinion == NULL && line->wheel != NULL;
    result->sum = result->contact = result->sum_t1 = result->contact_t1 = 0.0;
    result->tangent = tangent;
    tangent->line = line;
    tangent->pinion = pinion;
    tangent->wheel = wheel;
    tangent->t1_zero = 0.0;
    tangent->per_place = 1.0;
    if (line->pinion == NULL && line->wheel == NULL) {
        integrate_ideal(line, TANGENT, result);
    } else {
        const gmi_line led = wheel_leads ? led_by_wheel(line) : *line;
        walk_tables(&led, wheel_leads ? wheel : pinion, wheel_leads ? &ideal_grid : wheel, TANGENT,
                    WALK_TANGENT, result);
    }
    finish_tangent(tangent);
}

void gmi_line_integrate_squares(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                                gmi_line_sum *result) {
    const int wheel_leads = line->pinion == NULL && line->wheel != NULL;
    result->sum = result->contact = 0.0;
    if (line->pinion == NULL && line->wheel == NULL) {
        const quadratic f = {line->overlap, line->half_slope, line->curvature};
        const piece whole = {line->from, line->to - line->from, f, 0.0, 0.0, 0.0, 0.0};
        add_split_squares(&whole, result);
    } else {
        const gmi_line led = wheel_leads ? led_by_wheel(line) : *line;
        walk_tables(&led, wheel_leads ? wheel : pinion, wheel_leads ? &ideal_grid : wheel,
                    GMI_SQUARES, WALK_SQUARES, result);
    }
}

void gmi_line_integrate_depths(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                               gmi_depths *depths, gmi_line_sum *result) {
    const double by_pinion = pinion->direction * pinion->per_rho;
    const double by_wheel = wheel->direction * wheel->per_rho;
    result->sum = result->contact = result->pinion = result->wheel = 0.0;
    result->depths = depths;
    depths->shift_first = depths->shift_second = 0.0;
    depths->origin_first = depths->origin_second = 0.0;

    if (line->pinion != NULL) {
        depths->per_place = 1.0 / pinion->face_rate;
        depths->shift_second = line->wheel != NULL ? by_wheel : 0.0;
        depths->origin_first = by_pinion;
        depths->origin_second = -depths->shift_second;
        walk_tables(line, pinion, wheel, GMI_DERIVATIVES, WALK_DEPTHS, result);
    } else if (line->wheel != NULL) {
        depths->per_place = 1.0 / wheel->face_rate;
        depths->shift_first = by_wheel;
        depths->origin_first = -by_wheel;
        const gmi_line led = led_by_wheel(line);
        walk_tables(&led, wheel, &ideal_grid, GMI_DERIVATIVES, WALK_DEPTHS, result);
    } else {
        const quadratic f = {line->overlap, 0.0, 0.0};
        const piece whole = {0.0, line->to - line->from, f, 0.0, 0.0, 0.0, 0.0};
        depths->per_place = 1.0;
        depths->from = depths->to = (gmi_depth_end){0.0, 0.0, 1.0, 0.0};
        const hull points = {{f.value, f.value, f.value}, {1.0, 1.0, 1.0}};
        add_depths(&whole, &points, depths);
        result->at_from = result->at_to = line->overlap;
    }
}

/* w of the cell that holds the place, bilinear. */
static double deviation_at(const gmi_grid *grid, const double *table, double profile, double t1) {
    const table_point at = point_at(grid, table, profile, t1);
    return at.node[0] + (at.across - at.mixed * at.q) * at.p + at.along * at.q;
}

double gmi_line_value(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                      double t1) {
    double value = line->overlap;
    if (line->pinion != NULL) {
        value += deviation_at(pinion, line->pinion, line->pinion_profile, t1);
    }
    if (line->wheel != NULL) {
        value += deviation_at(wheel, line->wheel, line->wheel_profile, t1);
    }
    return value;
}

void gmi_line_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                        int wanted, gmi_line_sum *result) {
    result->sum = result->contact = result->pinion = result->wheel = 0.0;
    result->sum_t1 = result->contact_t1 = 0.0;
    if (wanted & GMI_CONTACT_DERIVATIVES) {
        result->roots = result->roots_pinion = result->roots_wheel = 0.0;
    }

    /* The flank with a table leads; if both have one, the pinion. */
    if (line->pinion != NULL) {
        integrate_tables(line, pinion, wheel, wanted, result);
    } else if (line->wheel != NULL) {
        integrate_wheel(line, wheel, wanted, result);
    } else {
        integrate_ideal(line, wanted, result);
    }
}
