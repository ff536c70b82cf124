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
#include "line.h"

#include "contact.h"
#include "flank.h"
#include "internal.h"
#include "stretch.h"

#include <math.h>
#include <string.h>

#define NO_CROSSING    1e300 /* farther ahead than any place on a line */
#define LEAST_DISTANCE 1e-20 /* to the profile line ahead (cells) */

/* On processors with vectors of four (wide.h) code may be large: the walk has copies of itself for cells of each kind. */
#ifdef GMI_IN_WIDE
#define HAS_COPIES 1
#else
#define HAS_COPIES 0
#endif

/* For compilers to keep in registers what is needed otherwise. */
#if defined(__GNUC__)
#define RARELY(condition) __builtin_expect((condition) != 0, 0)
#else
#define RARELY(condition) (condition)
#endif

/* In place of a table that is not there: zeros wherever one looks. */
static const double ideal_nodes[GMI_NODE_DOUBLES] = {0.0};
static const gmi_grid ideal_grid = {0};

/* Doubles from one face line to the next, and from one profile line to the next. */
typedef struct strides {
    ptrdiff_t row, step;
} strides;

/* Where the line is in one flank's table. */
typedef struct trace {
    const double *ahead; /* node of the profile line ahead on the face line behind */
    double next_profile; /* s of the profile line ahead */
    double next_face;    /* s of the face line ahead, where the other table leads */
    strides kept;        /* of the grid, in registers */
    int faces;           /* face lines still to cross */
    double slope;        /* d deviation / d u here (m) */
    double slope_rate;   /* its d / d s within the cell (m) */
} trace;

/* f around the current s: value, half the slope, half the second derivative. */
typedef struct quadratic {
    double value, half_slope, curvature;
} quadratic;

static void begin_ideal(trace *path) {
    const trace ideal = {ideal_nodes, NO_CROSSING, NO_CROSSING, {0, 0}, 0, 0.0, 0.0};
    *path = ideal;
}

/*
 * gmi_cell_index() without a branch at 0, of which no processor foresees the way where lines begin at the face: half of
 * v + |v| is v or 0.
 */
static inline int cell_index(double v, int last) {
    const int cell = (int)(0.5 * (v + fabs(v)));
    return cell < last ? cell : last;
}

/* Kept where code may be large: a task that is small has no stack to spare for them. */
SPECIALIZED strides strides_of(const trace *path, const gmi_grid *grid) {
    const strides read = {grid->row, grid->step};
    return HAS_COPIES ? path->kept : read;
}

/* Adds the deviation of a table to f at the place p, q of its cell. */
SPECIALIZED void add_table(trace *path, const gmi_grid *grid, double p, double q, quadratic *f) {
    const double *ahead = path->ahead, *behind = path->ahead - grid->step;

    /* w = corner + along_face p + along_profile q + mixed p q with p, q in [0, 1] */
    const double corner = behind[0];
    const double along_face = behind[grid->row] - corner;
    const double along_profile = ahead[0] - corner;
    const double mixed = (ahead[grid->row] - behind[grid->row]) - along_profile;
    path->slope = along_profile + mixed * p;
    path->slope_rate = mixed * grid->face_ratio;
    f->value += corner + along_face * p + path->slope * q;
    f->half_slope += grid->face_kick * (along_face + mixed * q) + grid->profile_kick * path->slope;
    f->curvature += grid->bend * mixed;
}

/*
 * Enters the table in its cell number `face`, at the place p between the face lines of that cell and at `s` of the
 * table that leads, and adds its deviation to f. Returns the s at which the table ends.
 */
SPECIALIZED double begin(trace *path, const gmi_grid *grid, const double *table, double profile,
                         double t1, int face, double p, double s, quadratic *f) {
    const double u = grid->base + (grid->direction * profile + t1 * grid->climb);
    const int cell = cell_index(u, grid->last_profile);
    const double *behind = table + (face * grid->row + cell * grid->step + grid->corner);
    const double *ahead = behind + grid->step;

    const double q = u - (double)cell;
    path->ahead = ahead;
    path->kept.row = grid->row;
    path->kept.step = grid->step;
    add_table(path, grid, p, q, f);

    /* The profile line ahead, and the place where the table ends. */
    path->next_profile = s + gmi_larger(1.0 - q, LEAST_DISTANCE) * grid->profile_spacing;
    return s + gmi_larger(grid->profile_cells - u, LEAST_DISTANCE) * grid->profile_spacing;
}

/* Across the face line ahead, at `s`; `ahead` is already that of the new cell. */
SPECIALIZED void cross_face(trace *path, const gmi_grid *grid, double s, int wanted, quadratic *f) {
    const strides to = strides_of(path, grid);
    path->ahead += to.row;
    const double ahead = path->ahead[GMI_NODE_FACE];
    const double back = path->ahead[GMI_NODE_FACE - to.step] - ahead;

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
    const strides to = strides_of(path, grid);
    const double behind = path->ahead[GMI_NODE_PROFILE];
    const double *on_next_face = path->ahead + to.row;
    const double change = on_next_face[GMI_NODE_PROFILE] - behind;
    const double kink = behind + p * change;
    f->half_slope += grid->profile_kick * kink;
    f->curvature += grid->bend * change;
    if (wanted & GMI_DERIVATIVES) {
        path->slope += kink;
        path->slope_rate += grid->face_ratio * change;
    }
    path->ahead += to.step;
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

/* A part of a piece in which f > 0: it goes on with a stretch, or begins one, and may end it. */
static void go_on_touching(const piece *part, double begin, double end, double moves,
                           gmi_stretches *found) {
    if (begin > 0.0) {
        gmi_stretches_end(found, part->s, 0.0);
        gmi_stretches_begin(found, part->s + begin, moves);
    } else if (found->since == GMI_NOWHERE) {
        gmi_stretches_begin(found, part->s, 0.0);
    }
    if (end < part->length) {
        gmi_stretches_end(found, part->s + end, moves);
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

/*
 * A piece in which f may change its sign: split at the roots of the quadratic. found: NULL = sums are wanted; is_square: a
 * constant at each call.
 */
SPECIALIZED void split_piece(const piece *part, int wanted, int is_square, gmi_stretches *found,
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
        if (wanted & GMI_CONTACT_DERIVATIVES || found != NULL) {
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
            } else if (found != NULL) {
                go_on_touching(part, cuts[k], cuts[k + 1], per_slope, found);
            } else {
                add_touching(part, cuts[k], cuts[k + 1], wanted, total);
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

/* Where the flanks touch in it; end_value: f at its end, where rounding may have put a root on either side. */
static void find_in_piece(const piece *part, double end_value, gmi_stretches *found) {
    split_piece(part, GMI_STRETCHES, 0, found, NULL);
    const double end = part->s + part->length;
    if (!(end_value > 0.0)) {
        gmi_stretches_end(found, end, 0.0);
    } else if (found->since == GMI_NOWHERE) {
        gmi_stretches_begin(found, end, 0.0);
    }
}

/* A walk along a line: where it is, f there, and the sums over whole pieces so far. */
typedef struct walk_state {
    double s;
    quadratic f;
    trace first, second; /* through the tables of both flanks; the first one's face lines lead */
    double faces; /* face lines behind that one (GMI_MOMENTS), or the last one (GMI_STRETCHES) */
    double three_sums; /* three times the sum; of squares once */
    double contact;
    double two_first, two_second; /* twice the sums of d deviation / d u of both flanks */
} walk_state;

/* Where it is, counted from the first face line on. */
SPECIALIZED double place_of(const walk_state *at, int wanted) {
    return (wanted & GMI_STRETCHES ? at->faces - (double)at->first.faces : at->faces) + at->s;
}

SPECIALIZED piece piece_ahead(const walk_state *at, double length, int wanted) {
    const piece part = {wanted & (GMI_MOMENTS | GMI_STRETCHES) ? place_of(at, wanted) : 0.0,
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

/* Integrates the piece up to `end` and goes there. found: GMI_STRETCHES. */
SPECIALIZED void advance(walk_state *at, double end, int wanted, gmi_stretches *found,
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
        if (!(wanted & GMI_STRETCHES)) { /* which tell */
            at->three_sums += wanted & GMI_SQUARES
                                  ? square_integral_of(value, control, end_value, length)
                                  : length * (value + control + end_value);
            at->contact += length;
        }
        if (wanted & GMI_DERIVATIVES) {
            at->two_first += length * (at->first.slope + first_slope);
            at->two_second += length * (at->second.slope + second_slope);
        }
        if (wanted & GMI_MOMENTS) {
            const piece part = piece_ahead(at, length, wanted);
            add_moments(&part, 0.0, length, split);
        }
    } else if (RARELY(gmi_larger(gmi_larger(value, control), end_value) > 0.0)) {
        const piece part = piece_ahead(at, length, wanted);
        if (wanted & GMI_STRETCHES) {
            find_in_piece(&part, end_value, found);
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

/* Across the profile lines of both tables in their order, and on to a face line. */
SPECIALIZED void walk_to(walk_state *at, const gmi_grid *first, const gmi_grid *second,
                         double face_line, int wanted, int same_faces, gmi_stretches *found,
                         gmi_line_sum *split) {
    for (;;) {
        if (at->first.next_profile < at->second.next_profile) {
            if (!(at->first.next_profile < face_line)) {
                break;
            }
            advance(at, at->first.next_profile, wanted, found, split);

            /* Of the table that leads: s is the place between its face lines. */
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
            advance(at, at->second.next_profile, wanted, found, split);

            /* Of the other one, whose face lines may be elsewhere. */
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
    advance(at, face_line, wanted, found, split);
}

/* Whether a face line of the table that does not lead comes before s = end. */
SPECIALIZED int crosses_second_face(const walk_state *at, double end, int same_faces) {
    return !same_faces && at->second.faces > 0 && at->second.next_face < end;
}

SPECIALIZED void cross_second_face(walk_state *at, const gmi_grid *second, int wanted) {
    cross_face(&at->second, second, at->s, wanted, &at->f);
    at->second.faces -= 1;
    at->second.next_face += 1.0 / second->face_ratio;
}

/*
 * Walks on through the tables of two flanks until s = end, behind any face line of the one that leads. same_faces: its face
 * lines serve both. `wanted` and `same_faces` are constants at each call.
 */
SPECIALIZED void walk_cell(walk_state *at, const gmi_grid *first, const gmi_grid *second,
                           double end, int wanted, int same_faces, gmi_stretches *found,
                           gmi_line_sum *split) {
    /* A copy for the way to the other table's face lines. */
    while (HAS_COPIES && crosses_second_face(at, end, same_faces)) {
        walk_to(at, first, second, at->second.next_face, wanted, same_faces, found, split);
        cross_second_face(at, second, wanted);
    }
    for (;;) {
        const int crosses = !HAS_COPIES && crosses_second_face(at, end, same_faces);
        walk_to(at, first, second, crosses ? at->second.next_face : end, wanted, same_faces, found,
                split);
        if (!crosses) {
            return;
        }
        cross_second_face(at, second, wanted);
    }
}

/* Across the face line of the leading table, where s begins again. */
SPECIALIZED void enter_next_cell(walk_state *at, const gmi_grid *first, const gmi_grid *second,
                                 int wanted, int same_faces) {
    at->s = 0.0;
    if (wanted & GMI_MOMENTS) {
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
                      int wanted, int same_faces, gmi_line_sum *result) {
    const double end_in_last = end - (double)at.first.faces;

    /*
     * A copy for all cells but the last one. They end at 1, which is read from the grid: a constant would be fetched anew for
     * each comparison.
     */
    while (HAS_COPIES && at.first.faces > 0) {
        walk_cell(&at, first, second, first->face_ratio, wanted, same_faces, NULL, result);
        enter_next_cell(&at, first, second, wanted, same_faces);
    }
    for (;;) {
        const int is_last = HAS_COPIES || at.first.faces <= 0;
        walk_cell(&at, first, second, is_last ? end_in_last : 1.0, wanted, same_faces, NULL,
                  result);
        if (is_last) {
            break;
        }
        enter_next_cell(&at, first, second, wanted, same_faces);
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
        add_split(&part, wanted, result);
    } else if (line->overlap > 0.0) {
        result->sum = line->overlap * length;
        result->contact = length;
        result->contact_t1 = 0.5 * length * (line->from + line->to);
        result->sum_t1 = line->overlap * result->contact_t1;
    }
}

/* Face lines of both tables for themselves: as of two gears that have moved against each other. */
static OWN_STACK void walk_apart(walk_state at, const gmi_grid *first, const gmi_grid *second,
                                 double end, int wanted, gmi_line_sum *result) {
    if (wanted == GMI_SUM) {
        walk(at, first, second, end, GMI_SUM, 0, result);
    } else {
        walk(at, first, second, end, wanted & ~(GMI_STRETCHES | GMI_DEPTHS | GMI_SQUARES), 0,
             result);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Where the flanks touch
 * ------------------------------------------------------------------------------------------- */

/* How windows are used along a line. */
typedef struct windows {
    int most_faces, least_faces; /* still to cross: between these they are used */
    quadratic parabola;          /* of f beside the tables, where the line begins */
    double behind, ahead;        /* its values at both face lines (m) */
    double rise, rise_more;      /* their next differences (m) */
    double bow; /* by so much it leaves the straight line between them at most (m) */
} windows;

/* Places that rounding puts this far outside of a table are in it (cells). */
#define ROUNDED_OUT 1e-12

/* Face lines of the table that leads within `beyond` of its cells; 0 if that is no more than rounding. */
static inline int faces_within(double beyond) {
    return beyond > ROUNDED_OUT ? 1 + (int)beyond : 0;
}

/*
 * A window holds what the line meets in one cell of the table that leads, if it climbs by no more than all columns but one.
 * Beyond the rims of tables, where their last cells go on, no window knows. begin_out, end_out: how far the line is outside
 * of a face (cells of the table that leads).
 */
SPECIALIZED windows windows_along(const walk_state *at, const gmi_grid *first,
                                  const gmi_grid *second, double begin_out, double end_out,
                                  const quadratic *parabola) {
    windows used;
    const double columns = (double)GMI_WINDOW_PROFILE + ROUNDED_OUT;
    const double q_first = 1.0 - (at->first.next_profile - at->s) * first->rate;
    const double q_second = 1.0 - (at->second.next_profile - at->s) * second->rate;
    const int are_used = first->rate <= columns && second->rate <= columns &&
                         second->face_ratio <= 1.0 + ROUNDED_OUT && q_first >= -ROUNDED_OUT &&
                         q_second >= -ROUNDED_OUT;
    used.most_faces = are_used ? at->first.faces - faces_within(begin_out) : -1;
    used.least_faces = faces_within(end_out);
    used.parabola = *parabola;

    /* From the face line behind to the one ahead, and on by second differences. */
    const double h = parabola->half_slope, c = parabola->curvature;
    const double to_behind = -at->s, to_ahead = 1.0 - at->s;
    used.behind = parabola->value + to_behind * (2.0 * h + to_behind * c);
    used.ahead = parabola->value + to_ahead * (2.0 * h + to_ahead * c);
    used.rise_more = 2.0 * c;
    used.rise = used.ahead - used.behind + used.rise_more;
    used.bow = 0.25 * fabs(c);
    return used;
}

/* Lowest and highest node around the line up to the next face line of the table that leads. */
SPECIALIZED gmi_bounds bounds_ahead(const trace *path) {
    gmi_bounds bounds;
    memcpy(&bounds, path->ahead + GMI_NODE_BOUNDS, sizeof bounds);
    return bounds;
}

/* +1 or -1 where f has this sign for sure up to the next face line, else 0. */
SPECIALIZED int sign_ahead(const walk_state *at, const windows *used) {
    if (at->first.faces > used->most_faces || at->first.faces < used->least_faces) {
        return 0;
    }
    const gmi_bounds a = bounds_ahead(&at->first), b = bounds_ahead(&at->second);
    const double lowest = gmi_smaller(used->behind, used->ahead) - used->bow;
    const double highest = gmi_larger(used->behind, used->ahead) + used->bow;
    if (lowest + (double)(a.lowest + b.lowest) > 0.0) {
        return 1;
    }
    return highest + (double)(a.highest + b.highest) < 0.0 ? -1 : 0;
}

/* Leaves a cell of the table that leads out: on to its next face line. */
SPECIALIZED void skip_profiles(trace *path, const gmi_grid *grid) {
    if (path->next_profile < 1.0) {
        const int lines = 1 + (int)((1.0 - path->next_profile) * grid->rate);
        path->next_profile += (double)lines * grid->profile_spacing;
        path->ahead += lines * grid->step;
    }
    path->next_profile -= 1.0;
}

SPECIALIZED void skip_cell(walk_state *at, const gmi_grid *first, const gmi_grid *second,
                           int same_faces) {
    skip_profiles(&at->first, first);
    skip_profiles(&at->second, second);
    at->s = 0.0;
    at->first.ahead += first->row;
    at->first.faces -= 1;
    if (same_faces) {
        at->second.ahead += second->row;
        return;
    }
    if (at->second.faces > 0 && at->second.next_face < 1.0) {
        at->second.ahead += second->row;
        at->second.faces -= 1;
        at->second.next_face += 1.0 / second->face_ratio;
    }
    at->second.next_face -= 1.0;
}

/* On a face line of the table that leads, behind cells left out: f there anew. */
SPECIALIZED void enter_again(walk_state *at, const gmi_grid *first, const gmi_grid *second,
                             double gone, const quadratic *parabola, int same_faces) {
    const double half_slope = parabola->half_slope + gone * parabola->curvature;
    at->f.value = parabola->value + gone * (parabola->half_slope + half_slope);
    at->f.half_slope = half_slope;
    at->f.curvature = parabola->curvature;
    const double p = same_faces ? 0.0 : 1.0 - at->second.next_face * second->face_ratio;
    add_table(&at->first, first, 0.0, 1.0 - at->first.next_profile * first->rate, &at->f);
    add_table(&at->second, second, p, 1.0 - at->second.next_profile * second->rate, &at->f);
}

/* From here on the flanks touch, or do not. */
static inline void settle(gmi_stretches *found, double place, int touches) {
    if (!touches) {
        gmi_stretches_end(found, place, 0.0);
    } else if (found->since == GMI_NOWHERE) {
        gmi_stretches_begin(found, place, 0.0);
    }
}

/*
 * Walks a line piece by piece, but for cells of the table that leads in which the nodes around it leave no doubt whether the
 * flanks touch.
 */
SPECIALIZED void search(walk_state at, const gmi_grid *first, const gmi_grid *second, double end,
                        windows used, int same_faces, gmi_stretches *found, gmi_line_sum *result) {
    const double end_in_last = end - (double)at.first.faces;
    const double from = place_of(&at, GMI_STRETCHES);
    int is_entered = 1;
    settle(found, from, at.f.value > 0.0);
    result->at_to = 0.0;
    for (;;) {
        const int is_last = at.first.faces <= 0;
        const int sign = sign_ahead(&at, &used);
        if (sign != 0) {
            settle(found, place_of(&at, GMI_STRETCHES), sign > 0);
            is_entered = 0;
            if (is_last) {
                break;
            }
            skip_cell(&at, first, second, same_faces);
        } else {
            if (!is_entered) {
                enter_again(&at, first, second, place_of(&at, GMI_STRETCHES) - from, &used.parabola,
                            same_faces);
                settle(found, place_of(&at, GMI_STRETCHES), at.f.value > 0.0);
                is_entered = 1;
            }
            walk_cell(&at, first, second, is_last ? end_in_last : 1.0, GMI_STRETCHES, same_faces,
                      found, NULL);
            if (is_last) {
                result->at_to = at.f.value;
                break;
            }
            enter_next_cell(&at, first, second, GMI_STRETCHES, same_faces);
        }
        used.behind = used.ahead;
        used.ahead += used.rise;
        used.rise += used.rise_more;
    }

    /* To the end of the line. */
    if (found->since > GMI_NOWHERE) {
        const double place = at.faces + end_in_last;
        gmi_stretches_end(found, place, 0.0);
        if (!is_entered) {
            result->at_to = gmi_stretches_value(found, found->t1_zero + place * found->per_place);
        }
    }
}

/* The walk that finds stretches, copied into what calls it: no other walk is there. */
SPECIALIZED void search_line(const walk_state *at, const gmi_grid *first, const gmi_grid *second,
                             double end, double begin_out, double end_out,
                             const quadratic *parabola, int same_faces, gmi_stretches *found,
                             gmi_line_sum *result) {
    const windows used = windows_along(at, first, second, begin_out, end_out, parabola);
    if (same_faces) {
        search(*at, first, second, end, used, 1, found, result);
    } else {
        search(*at, first, second, end, used, 0, found, result);
    }
}

/* The walk at all depths, apart like that of a tangent. */
static OWN_STACK void walk_depths(walk_state at, const gmi_grid *first, const gmi_grid *second,
                                  double end, int same_faces, gmi_line_sum *result) {
    enum { AT_DEPTHS = GMI_DEPTHS | GMI_DERIVATIVES };
    result->depths->from = end_at(&at, first, result->depths);
    if (same_faces) {
        walk(at, first, second, end, AT_DEPTHS, 1, result);
    } else {
        walk(at, first, second, end, AT_DEPTHS, 0, result);
    }
}

/* The walk for squares. */
static OWN_STACK void walk_squares(walk_state at, const gmi_grid *first, const gmi_grid *second,
                                   double end, int same_faces, gmi_line_sum *result) {
    if (same_faces) {
        walk(at, first, second, end, GMI_SQUARES, 1, result);
    } else {
        walk(at, first, second, end, GMI_SQUARES, 0, result);
    }
}

/* What a walk is for, beside sums. */
enum walk_kind { WALK_SUMS, WALK_STRETCHES, WALK_DEPTHS, WALK_SQUARES };

/*
 * A walk of its own for each kind and each mask that solvers use: what is not wanted costs nothing in it. begin_out, end_out,
 * parabola: see windows_along().
 */
SPECIALIZED void walk_entered(walk_state *at, const gmi_grid *first, const gmi_grid *second,
                              double end, double begin_out, double end_out,
                              const quadratic *parabola, int wanted, enum walk_kind kind,
                              int same_faces, gmi_stretches *found, gmi_line_sum *result) {
    enum { DAMPED = GMI_DERIVATIVES | GMI_CONTACT_DERIVATIVES };
    if (kind != WALK_SUMS && same_faces) {
        at->second.next_face = NO_CROSSING;
    }

    /* Stretches, squares, depths, or else sums. */
    if (kind == WALK_STRETCHES) {
        at->faces += (double)at->first.faces;
        search_line(at, first, second, end, begin_out, end_out, parabola, same_faces, found,
                    result);
    } else if (kind == WALK_SQUARES) {
        walk_squares(*at, first, second, end, same_faces, result);
    } else if (kind == WALK_DEPTHS) {
        walk_depths(*at, first, second, end, same_faces, result);
    } else if (!same_faces) {
        walk_apart(*at, first, second, end, wanted, result);
    } else if (wanted == GMI_SUM) {
        walk(*at, first, second, end, GMI_SUM, 1, result);
    } else if (wanted == GMI_DERIVATIVES) {
        walk(*at, first, second, end, GMI_DERIVATIVES, 1, result);
    } else if (wanted == DAMPED) {
        walk(*at, first, second, end, DAMPED, 1, result);
    } else if (wanted == GMI_MOMENTS) {
        walk(*at, first, second, end, GMI_MOMENTS, 1, result);
    } else {
        walk(*at, first, second, end, wanted & ~(GMI_STRETCHES | GMI_DEPTHS | GMI_SQUARES), 1,
             result);
    }
}

/* The pinion, which leads, has a table; the wheel may have one. found: WALK_STRETCHES. */
SPECIALIZED void walk_tables(const gmi_line *line, const gmi_grid *first, const gmi_grid *second,
                             int wanted, enum walk_kind kind, gmi_stretches *found,
                             gmi_line_sum *result) {
    const double v1 = line->from * first->face_rate + first->face_base;
    const double to = line->to * first->face_rate + first->face_base;
    const int face = cell_index(v1, first->last_face);
    const double s = v1 - (double)face;

    int same_faces = 1;
    gmi_grid scaled;
    walk_state at; /* every field is set below; zeroing all first costs as much as ten pieces */
    at.s = s;
    at.faces = (double)face;
    const quadratic parabola = {line->overlap, line->half_slope / first->face_rate,
                                line->curvature / (first->face_rate * first->face_rate)};
    at.f = parabola;
    double begin_out = -v1, end_out = to - (double)(first->last_face + 1); /* of the faces */
    at.three_sums = at.contact = at.two_first = at.two_second = 0.0;

    /* Into both tables. Face lines are shared, or those of the second one are counted in cells of the first. */
    at.first.faces = cell_index(to, first->last_face) - face;
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
            gmi_grid_set_rates(&scaled, second->face_rate / first->face_rate);
            second = &scaled;
        }
        const double second_v1 = line->from * second->face_rate + second->face_base;
        const int second_face = cell_index(second_v1, second->last_face);
        const double p = second_v1 - (double)second_face;
        at.second.faces =
            cell_index(line->to * second->face_rate + second->face_base, second->last_face) -
            second_face;
        at.second.next_face = s + (1.0 - p) / second->face_ratio;
        end = gmi_smaller(end, begin(&at.second, second, line->wheel, line->wheel_profile,
                                     line->from, second_face, p, s, &at.f));
        if (kind == WALK_STRETCHES) {
            const double second_to = line->to * second->face_rate + second->face_base;
            const double per_ratio = 1.0 / second->face_ratio;
            begin_out = gmi_larger(begin_out, -second_v1 * per_ratio);
            end_out =
                gmi_larger(end_out, (second_to - (double)(second->last_face + 1)) * per_ratio);
        }
    }

    result->at_from = at.f.value;
    walk_entered(&at, first, second, end, begin_out, end_out, &parabola, wanted, kind, same_faces,
                 found, result);
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
    walk_tables(line, pinion, wheel, wanted, WALK_SUMS, NULL, result);
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

/* ---------------------------------------------------------------------------------------------
 * Where the flanks touch
 * ------------------------------------------------------------------------------------------- */

#ifndef GMI_IN_WIDE /* there these would take more stack */

/* No table on either flank: one piece at most. */
static void find_ideal_stretches(const gmi_line *line, gmi_stretches *found, gmi_line_sum *result) {
    const double length = line->to - line->from;
    const quadratic f = {line->overlap, line->half_slope, line->curvature};
    const piece whole = {line->from, length, f, 0.0, 0.0, 0.0, 0.0};
    result->at_from = line->overlap;
    result->at_to = line->overlap + length * (2.0 * line->half_slope + length * line->curvature);
    if (line->half_slope != 0.0 || line->curvature != 0.0) {
        find_in_piece(&whole, result->at_to, found);
    } else if (line->overlap > 0.0) {
        gmi_stretches_begin(found, line->from, 0.0);
    }
    gmi_stretches_end(found, line->to, 0.0);
}

void gmi_line_integrate_tangent(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                                gmi_line_sum *result) {
    gmi_stretches found = {.line = line,
                           .pinion = pinion,
                           .wheel = wheel,
                           .per_place = 1.0,
                           .since = GMI_NOWHERE,
                           .tangent = line->tangent};
    if (line->pinion != NULL || line->wheel != NULL) {
        gmi_line led;
        const gmi_line *leading = line;
        const gmi_grid *first = pinion, *second = wheel;
        if (line->pinion == NULL) {
            led = led_by_wheel(line);
            leading = &led;
            first = wheel;
            second = &ideal_grid;
        }
        found.per_place = 1.0 / first->face_rate;
        found.t1_zero = -first->face_base * found.per_place;
        walk_tables(leading, first, second, GMI_STRETCHES, WALK_STRETCHES, &found, result);
    } else {
        find_ideal_stretches(line, &found, result);
    }

    result->sum = gmi_larger(found.sum, 0.0); /* below 0 by rounding where f is next to nothing */
    result->contact = found.contact[0];
    result->sum_t1 = found.sum_t1;
    result->contact_t1 = found.contact[1];
    gmi_stretches_finish(&found);
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
        walk_tables(line, pinion, wheel, GMI_DERIVATIVES, WALK_DEPTHS, NULL, result);
    } else if (line->wheel != NULL) {
        depths->per_place = 1.0 / wheel->face_rate;
        depths->shift_first = by_wheel;
        depths->origin_first = -by_wheel;
        const gmi_line led = led_by_wheel(line);
        walk_tables(&led, wheel, &ideal_grid, GMI_DERIVATIVES, WALK_DEPTHS, NULL, result);
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

#endif

void gmi_line_integrate_squares(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                                gmi_line_sum *result) {
    GMI_CALL_WIDE(pinion, gmi_wide_line_integrate_squares(line, pinion, wheel, result))
    const int wheel_leads = line->pinion == NULL && line->wheel != NULL;
    result->sum = result->contact = 0.0;
    if (line->pinion == NULL && line->wheel == NULL) {
        const quadratic f = {line->overlap, line->half_slope, line->curvature};
        const piece whole = {line->from, line->to - line->from, f, 0.0, 0.0, 0.0, 0.0};
        add_split_squares(&whole, result);
    } else {
        const gmi_line led = wheel_leads ? led_by_wheel(line) : *line;
        walk_tables(&led, wheel_leads ? wheel : pinion, wheel_leads ? &ideal_grid : wheel,
                    GMI_SQUARES, WALK_SQUARES, NULL, result);
    }
}

#ifdef GMI_IN_WIDE

/* Apart from others, the walk for a sum alone has the registers for itself. */
OWN_STACK void gmi_wide_line_sum(const gmi_line *line, const gmi_grid *pinion,
                                 const gmi_grid *wheel, gmi_line_sum *result) {
    result->sum = result->contact = 0.0;
    walk_tables(line, pinion, wheel, GMI_SUM, WALK_SUMS, NULL, result);
}

#endif

void gmi_line_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                        int wanted, gmi_line_sum *result) {
    GMI_CALL_WIDE(pinion, gmi_wide_line_integrate(line, pinion, wheel, wanted, result))
#ifdef GMI_IN_WIDE
    if (wanted == GMI_SUM && line->pinion != NULL) {
        gmi_wide_line_sum(line, pinion, wheel, result);
        return;
    }
#endif

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
