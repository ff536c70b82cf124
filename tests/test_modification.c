/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Designed modifications: values against their definitions, and tables against their bound. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "reference_gear.h"

#define UM     1e-6
#define AMOUNT 20e-6

enum { MOST = 8, TABLE_NODES = 262144 };

static gm_pair pair;
static gm_modification list[MOST];
static gm_modifications design;

static void begin(void) {
    pair = reference_pair(REFERENCE_FACE_WIDTH);
    memset(list, 0, sizeof list);
    design = (gm_modifications){list, 0, &pair.pinion, pair.face_width};
}

/* Ranges: a quarter of the face, a fifth of the profile. */
static gm_modification *add(int kind, int shape, double amount) {
    gm_modification *added = &list[design.count++];
    *added = (gm_modification){kind, shape, GM_RANGE_SHARE, amount, 0.25 * pair.face_width, 0.2};
    return added;
}

static gm_modification *only(int kind, int shape, double amount) {
    begin();
    return add(kind, shape, amount);
}

static double value(double t1, double t2) {
    return gm_modifications_value(&design, t1, t2);
}

static double roll_length(void) {
    return pair.pinion.tip_roll_length - pair.pinion.start_roll_length;
}

static int is_relief(int kind) {
    return kind != GM_MOD_HELIX_SLOPE && kind != GM_MOD_PROFILE_SLOPE && kind != GM_MOD_TWIST &&
           kind != GM_MOD_CROWNING && kind != GM_MOD_PROFILE_CROWNING;
}

static int first_shape(int kind) {
    return kind == GM_MOD_CROWNING || kind == GM_MOD_PROFILE_CROWNING ? GM_SHAPE_PARABOLIC
                                                                      : GM_SHAPE_LINEAR;
}

/* ---------------------------------------------------------------------------------------------
 * Values
 * ------------------------------------------------------------------------------------------- */

/* A point, and the value there in amounts, worked out by hand from the definition. */
static const struct {
    int kind, shape;
    double t1, t2, expected;
} points[] = {
    {GM_MOD_HELIX_SLOPE, 0, 0.0, 0.3, -0.5},
    {GM_MOD_HELIX_SLOPE, 0, 0.5, 0.3, 0.0},
    {GM_MOD_HELIX_SLOPE, 0, 1.0, 0.9, 0.5},
    {GM_MOD_PROFILE_SLOPE, 0, 0.3, 0.0, -0.5},
    {GM_MOD_PROFILE_SLOPE, 0, 0.3, 1.0, 0.5},
    {GM_MOD_TWIST, 0, 1.0, 1.0, 0.25},
    {GM_MOD_TWIST, 0, 1.0, 0.0, -0.25},
    {GM_MOD_TWIST, 0, 0.0, 1.0, -0.25},
    {GM_MOD_TWIST, 0, 0.5, 0.7, 0.0},
    {GM_MOD_CROWNING, GM_SHAPE_PARABOLIC, 0.5, 0.2, 0.0},
    {GM_MOD_CROWNING, GM_SHAPE_PARABOLIC, 0.25, 0.2, -0.25},
    {GM_MOD_CROWNING, GM_SHAPE_PARABOLIC, 1.0, 0.2, -1.0},
    {GM_MOD_CROWNING, GM_SHAPE_CIRCULAR, 0.0, 0.2, -1.0},
    {GM_MOD_PROFILE_CROWNING, GM_SHAPE_PARABOLIC, 0.2, 0.75, -0.25},
    {GM_MOD_PROFILE_CROWNING, GM_SHAPE_PARABOLIC, 0.2, 0.0, -1.0},
    {GM_MOD_END_RELIEF_I, GM_SHAPE_LINEAR, 0.0, 0.5, -1.0},
    {GM_MOD_END_RELIEF_I, GM_SHAPE_LINEAR, 0.125, 0.5, -0.5},
    {GM_MOD_END_RELIEF_I, GM_SHAPE_LINEAR, 0.25, 0.5, 0.0},
    {GM_MOD_END_RELIEF_I, GM_SHAPE_PARABOLIC, 0.125, 0.5, -0.25},
    {GM_MOD_END_RELIEF_II, GM_SHAPE_LINEAR, 1.0, 0.5, -1.0},
    {GM_MOD_END_RELIEF_II, GM_SHAPE_PARABOLIC, 0.875, 0.5, -0.25},
    {GM_MOD_END_RELIEF_II, GM_SHAPE_LINEAR, 0.0, 0.5, 0.0},
    {GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR, 0.1, 1.0, -1.0},
    {GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR, 0.1, 0.9, -0.5},
    {GM_MOD_TIP_RELIEF, GM_SHAPE_PARABOLIC, 0.1, 0.9, -0.25},
    {GM_MOD_TIP_RELIEF, GM_SHAPE_CIRCULAR, 0.1, 1.0, -1.0},
    {GM_MOD_ROOT_RELIEF, GM_SHAPE_LINEAR, 0.1, 0.0, -1.0},
    {GM_MOD_ROOT_RELIEF, GM_SHAPE_PARABOLIC, 0.1, 0.1, -0.25},
    {GM_MOD_ROOT_RELIEF, GM_SHAPE_LINEAR, 0.1, 1.0, 0.0},
    {GM_MOD_TIP_CORNER_I, GM_SHAPE_LINEAR, 0.0, 1.0, -1.0},
    {GM_MOD_TIP_CORNER_I, GM_SHAPE_LINEAR, 0.125, 1.0, -0.5},
    {GM_MOD_TIP_CORNER_I, GM_SHAPE_LINEAR, 0.0, 0.9, -0.5},
    {GM_MOD_TIP_CORNER_I, GM_SHAPE_LINEAR, 0.0625, 0.95, -0.5},
    {GM_MOD_TIP_CORNER_I, GM_SHAPE_LINEAR, 0.15, 0.9, 0.0},
    {GM_MOD_TIP_CORNER_II, GM_SHAPE_LINEAR, 1.0, 1.0, -1.0},
    {GM_MOD_TIP_CORNER_II, GM_SHAPE_PARABOLIC, 1.0, 0.9, -0.25},
    {GM_MOD_TIP_CORNER_II, GM_SHAPE_LINEAR, 1.0, 0.0, 0.0},
    {GM_MOD_ROOT_CORNER_I, GM_SHAPE_LINEAR, 0.0, 0.0, -1.0},
    {GM_MOD_ROOT_CORNER_I, GM_SHAPE_CIRCULAR, 0.0, 0.0, -1.0},
    {GM_MOD_ROOT_CORNER_I, GM_SHAPE_LINEAR, 0.0, 1.0, 0.0},
    {GM_MOD_ROOT_CORNER_II, GM_SHAPE_LINEAR, 0.875, 0.0, -0.5},
    {GM_MOD_ROOT_CORNER_II, GM_SHAPE_LINEAR, 0.0, 0.0, 0.0},
};

static void every_kind_has_its_value_where_it_is_known(void) {
    for (size_t k = 0; k < sizeof points / sizeof points[0]; ++k) {
        gm_test_context("point %d, kind %d", (int)k, points[k].kind);
        only(points[k].kind, points[k].shape, AMOUNT);
        /* 0.9 and 0.2 carry a rounding, five times magnified by the range */
        GM_ASSERT_ABS(value(points[k].t1, points[k].t2), points[k].expected * AMOUNT,
                      1e-15 * AMOUNT);
    }
}

/* The circle by its equation, x^2 + (R - v)^2 = R^2 with R = (L^2 + C^2) / (2 C), in long double. */
static void a_circular_relief_is_a_circle(void) {
    gm_modification *m = only(GM_MOD_END_RELIEF_II, GM_SHAPE_CIRCULAR, 0.4 * 4e-3);
    m->face_range = 4e-3; /* far deeper than any gear, so that a parabola would be off by a lot */
    const long double length = 4e-3L;
    const long double depth = 0.4L * length;
    const long double radius = (length * length + depth * depth) / (2.0L * depth);
    for (int k = 0; k <= 20; ++k) {
        const double t1 = 1.0 - (4e-3 / pair.face_width) * (1.0 - k / 20.0);
        const long double x = length * k / 20.0L;
        const long double expected = radius - sqrtl(radius * radius - x * x);
        GM_ASSERT_ABS(value(t1, 0.5), -(double)expected, 1e-14 * 4e-3);
    }
}

static void a_shallow_circle_is_a_parabola_to_the_second_order(void) {
    only(GM_MOD_PROFILE_CROWNING, GM_SHAPE_CIRCULAR, AMOUNT);
    const double circle = value(0.5, 0.75);
    only(GM_MOD_PROFILE_CROWNING, GM_SHAPE_PARABOLIC, AMOUNT);
    const double slope = AMOUNT / (0.5 * roll_length());
    /* circle = C s^2 (1 - (C/L)^2 (1 - s^2) + ..): the difference lies within (C/L)^2, but is not 0 */
    GM_ASSERT_REL(circle, value(0.5, 0.75), slope * slope);
    GM_ASSERT(circle != value(0.5, 0.75));
}

static void the_amount_of_crownings_may_be_negative(void) {
    for (int shape = GM_SHAPE_PARABOLIC; shape <= GM_SHAPE_CIRCULAR; ++shape) {
        only(GM_MOD_CROWNING, shape, AMOUNT);
        const double convex = value(0.2, 0.0);
        only(GM_MOD_CROWNING, shape, -AMOUNT);
        GM_ASSERT_REL(value(0.2, 0.0), -convex, 0.0);
    }
}

static void an_amount_of_zero_changes_nothing(void) {
    for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
        only(kind, GM_SHAPE_CIRCULAR, 0.0);
        GM_ASSERT_ABS(value(0.0, 0.0), 0.0, 0.0);
        GM_ASSERT_ABS(value(1.0, 1.0), 0.0, 0.0);
    }
}

/* Sharp zero outside, something below zero inside: sampled on a grid that has the limits between its lines. */
static void reliefs_change_nothing_outside_their_range(void) {
    for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
        if (!is_relief(kind)) {
            continue;
        }
        for (int shape = GM_SHAPE_LINEAR; shape <= GM_SHAPE_CIRCULAR; ++shape) {
            only(kind, shape, AMOUNT);
            gm_test_context("kind %d, shape %d", kind, shape);

            int inside = 0;
            int wrong = 0;
            for (int i = 0; i <= 97; ++i) {
                for (int j = 0; j <= 97; ++j) {
                    const double t1 = i / 97.3, t2 = j / 97.3;

                    /* Along face and profile from where the relief begins to act. */
                    const double face = kind == GM_MOD_END_RELIEF_I ||
                                                kind == GM_MOD_TIP_CORNER_I ||
                                                kind == GM_MOD_ROOT_CORNER_I
                                            ? t1
                                            : 1.0 - t1;
                    const double profile = kind == GM_MOD_ROOT_RELIEF ||
                                                   kind == GM_MOD_ROOT_CORNER_I ||
                                                   kind == GM_MOD_ROOT_CORNER_II
                                               ? t2
                                               : 1.0 - t2;

                    double covered = 0.0; /* 1 = where the range begins */
                    if (kind != GM_MOD_TIP_RELIEF && kind != GM_MOD_ROOT_RELIEF) {
                        covered += face / 0.25;
                    }
                    if (kind != GM_MOD_END_RELIEF_I && kind != GM_MOD_END_RELIEF_II) {
                        covered += profile / 0.2;
                    }

                    const double v = value(t1, t2);
                    wrong += covered > 1.0 ? v != 0.0 : !(v < 0.0 && v >= -AMOUNT);
                    inside += covered < 1.0;
                }
            }

            GM_ASSERT_INT(wrong, 0);
            GM_ASSERT(inside > 100);
        }
    }
}

/* Mean over the flank by the midpoint rule with 400 x 400 cells. */
static double mean(void) {
    double sum = 0.0;
    for (int i = 0; i < 400; ++i) {
        for (int j = 0; j < 400; ++j) {
            sum += value((i + 0.5) / 400.0, (j + 0.5) / 400.0);
        }
    }
    return sum / (400.0 * 400.0);
}

static void the_mean_over_the_flank_is_that_of_the_formula(void) {
    static const struct {
        int kind, shape;
        double expected; /* in amounts: ranges of 1/4 and 1/5 times the mean within the range */
    } means[] = {
        {GM_MOD_HELIX_SLOPE, 0, 0.0},
        {GM_MOD_PROFILE_SLOPE, 0, 0.0},
        {GM_MOD_TWIST, 0, 0.0},
        {GM_MOD_CROWNING, GM_SHAPE_PARABOLIC, -1.0 / 3.0},
        {GM_MOD_PROFILE_CROWNING, GM_SHAPE_CIRCULAR, -1.0 / 3.0},
        {GM_MOD_END_RELIEF_I, GM_SHAPE_LINEAR, -0.25 / 2.0},
        {GM_MOD_END_RELIEF_II, GM_SHAPE_PARABOLIC, -0.25 / 3.0},
        {GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR, -0.2 / 2.0},
        {GM_MOD_ROOT_RELIEF, GM_SHAPE_CIRCULAR, -0.2 / 3.0},
        {GM_MOD_TIP_CORNER_II, GM_SHAPE_LINEAR, -0.25 * 0.2 / 6.0},
        {GM_MOD_ROOT_CORNER_I, GM_SHAPE_PARABOLIC, -0.25 * 0.2 / 12.0},
    };
    for (size_t k = 0; k < sizeof means / sizeof means[0]; ++k) {
        gm_test_context("kind %d", means[k].kind);
        only(means[k].kind, means[k].shape, AMOUNT);
        /* midpoint rule: cell^2 / 24 times the second derivative, 2 / 0.2^2, over a fifth of the flank; twice that */
        GM_ASSERT_ABS(mean(), means[k].expected * AMOUNT, 1e-5 * AMOUNT);
    }
}

/* Slope by s where a relief begins, from one step inside it. */
static double slope_at_begin(int kind, int shape, double step) {
    only(kind, shape, AMOUNT);
    const int is_face = kind == GM_MOD_END_RELIEF_I || kind == GM_MOD_END_RELIEF_II;
    const double begin_at = kind == GM_MOD_END_RELIEF_I    ? 0.25 * (1.0 - step)
                            : kind == GM_MOD_END_RELIEF_II ? 0.75 + 0.25 * step
                            : kind == GM_MOD_TIP_RELIEF    ? 0.8 + 0.2 * step
                                                           : 0.2 * (1.0 - step);
    return value(is_face ? begin_at : 0.4, is_face ? 0.4 : begin_at) / step;
}

static void parabola_and_circle_begin_tangentially_and_the_line_with_a_kink(void) {
    static const int kinds[] = {GM_MOD_END_RELIEF_I, GM_MOD_END_RELIEF_II, GM_MOD_TIP_RELIEF,
                                GM_MOD_ROOT_RELIEF};
    for (int k = 0; k < 4; ++k) {
        gm_test_context("kind %d", kinds[k]);
        GM_ASSERT_REL(slope_at_begin(kinds[k], GM_SHAPE_LINEAR, 1e-4), -AMOUNT, 1e-10);
        GM_ASSERT_REL(slope_at_begin(kinds[k], GM_SHAPE_PARABOLIC, 1e-4), -1e-4 * AMOUNT, 1e-10);
        /* (C/L)^2 = 3e-5 for the shortest length, half of it counts */
        GM_ASSERT_REL(slope_at_begin(kinds[k], GM_SHAPE_CIRCULAR, 1e-4), -1e-4 * AMOUNT, 1e-3);
    }
}

static void twist_is_the_difference_of_the_slopes_at_the_ends(void) {
    only(GM_MOD_TWIST, 0, AMOUNT);
    const double profile_slope_i = value(0.0, 1.0) - value(0.0, 0.0);
    const double profile_slope_ii = value(1.0, 1.0) - value(1.0, 0.0);
    const double helix_slope_start = value(1.0, 0.0) - value(0.0, 0.0);
    const double helix_slope_tip = value(1.0, 1.0) - value(0.0, 1.0);
    GM_ASSERT_REL(profile_slope_ii - profile_slope_i, AMOUNT, 1e-15);
    GM_ASSERT_REL(helix_slope_tip - helix_slope_start, AMOUNT, 1e-15);
}

static void modifications_add_up(void) {
    double sum[5] = {0.0};
    static const double at[5][2] = {{0, 0}, {1, 1}, {0.03, 0.97}, {0.98, 0.02}, {0.4, 0.6}};
    begin();
    static const int kinds[] = {GM_MOD_CROWNING,      GM_MOD_TIP_RELIEF,    GM_MOD_TIP_RELIEF,
                                GM_MOD_HELIX_SLOPE,   GM_MOD_TIP_CORNER_II, GM_MOD_TWIST,
                                GM_MOD_ROOT_CORNER_II};
    for (int k = 0; k < 7; ++k) {
        only(kinds[k], GM_SHAPE_PARABOLIC, (k + 1) * UM);
        for (int i = 0; i < 5; ++i) {
            sum[i] += value(at[i][0], at[i][1]);
        }
    }
    begin();
    for (int k = 0; k < 7; ++k) {
        add(kinds[k], GM_SHAPE_PARABOLIC, (k + 1) * UM);
    }
    for (int i = 0; i < 5; ++i) {
        GM_ASSERT_ABS(value(at[i][0], at[i][1]), sum[i], 1e-15 * 28 * UM);
    }
}

/* Looking at the flank from the other end: faces change their places, helix slope and twist their sign. */
static void the_other_hand_is_the_mirror_image(void) {
    static const int mirrored[GM_MODIFICATION_KINDS] = {
        [GM_MOD_HELIX_SLOPE] = GM_MOD_HELIX_SLOPE,
        [GM_MOD_CROWNING] = GM_MOD_CROWNING,
        [GM_MOD_END_RELIEF_I] = GM_MOD_END_RELIEF_II,
        [GM_MOD_END_RELIEF_II] = GM_MOD_END_RELIEF_I,
        [GM_MOD_PROFILE_SLOPE] = GM_MOD_PROFILE_SLOPE,
        [GM_MOD_PROFILE_CROWNING] = GM_MOD_PROFILE_CROWNING,
        [GM_MOD_TIP_RELIEF] = GM_MOD_TIP_RELIEF,
        [GM_MOD_ROOT_RELIEF] = GM_MOD_ROOT_RELIEF,
        [GM_MOD_TWIST] = GM_MOD_TWIST,
        [GM_MOD_TIP_CORNER_I] = GM_MOD_TIP_CORNER_II,
        [GM_MOD_TIP_CORNER_II] = GM_MOD_TIP_CORNER_I,
        [GM_MOD_ROOT_CORNER_I] = GM_MOD_ROOT_CORNER_II,
        [GM_MOD_ROOT_CORNER_II] = GM_MOD_ROOT_CORNER_I,
    };
    for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
        const double sign = kind == GM_MOD_HELIX_SLOPE || kind == GM_MOD_TWIST ? -1.0 : 1.0;
        for (int k = 0; k < 50; ++k) {
            const double t1 = k / 49.0, t2 = (k * 31 % 50) / 49.0;
            gm_test_context("kind %d at %g, %g", kind, t1, t2);
            only(kind, GM_SHAPE_PARABOLIC, AMOUNT);
            const double here = value(t1, t2);
            only(mirrored[kind], GM_SHAPE_PARABOLIC, sign * AMOUNT);
            GM_ASSERT_ABS(value(1.0 - t1, t2), here, 1e-14 * AMOUNT);
        }
    }
}

static void a_range_may_be_given_in_three_ways(void) {
    static const int kinds[] = {GM_MOD_TIP_RELIEF, GM_MOD_ROOT_RELIEF, GM_MOD_TIP_CORNER_I,
                                GM_MOD_ROOT_CORNER_II};
    for (int k = 0; k < 4; ++k) {
        const int is_tip = kinds[k] == GM_MOD_TIP_RELIEF || kinds[k] == GM_MOD_TIP_CORNER_I;
        const double t1 = kinds[k] == GM_MOD_ROOT_CORNER_II ? 0.97 : 0.03;
        const double t2 = is_tip ? 0.93 : 0.07;
        gm_modification *m = only(kinds[k], GM_SHAPE_LINEAR, AMOUNT);
        const double expected = value(t1, t2);
        GM_ASSERT(expected < 0.0);
        m->profile_range_by = GM_RANGE_LENGTH;
        m->profile_range = 0.2 * roll_length();
        GM_ASSERT_REL(value(t1, t2), expected, 1e-13);
        m->profile_range_by = GM_RANGE_RADIUS;
        m->profile_range = hypot(pair.pinion.base_radius,
                                 is_tip ? pair.pinion.tip_roll_length - 0.2 * roll_length()
                                        : pair.pinion.start_roll_length + 0.2 * roll_length());
        /* the roll length loses r / rho, about 4, in a radius */
        GM_ASSERT_REL(value(t1, t2), expected, 1e-12);
    }
}

static void a_point_beside_the_flank_has_no_value(void) {
    only(GM_MOD_CROWNING, GM_SHAPE_PARABOLIC, AMOUNT);
    GM_ASSERT_NAN(value(-1e-9, 0.5));
    GM_ASSERT_NAN(value(1.0 + 1e-9, 0.5));
    GM_ASSERT_NAN(value(0.5, -1e-9));
    GM_ASSERT_NAN(value(0.5, 1.0 + 1e-9));
    GM_ASSERT_NAN(value((double)NAN, 0.5));
    GM_ASSERT_NAN(gm_modifications_value(NULL, 0.5, 0.5));
    list[0].amount = (double)NAN;
    GM_ASSERT_NAN(value(0.5, 0.5));
}

/* ---------------------------------------------------------------------------------------------
 * Tables
 * ------------------------------------------------------------------------------------------- */

static double *table;

/* Bilinear between the nodes. */
static double interpolated(const gm_modifications_grid *grid, double t1, double t2) {
    const int face_cells = grid->face_nodes - 1, profile_cells = grid->profile_nodes - 1;
    int i = (int)(t1 * face_cells), j = (int)(t2 * profile_cells);
    i = i == face_cells ? i - 1 : i;
    j = j == profile_cells ? j - 1 : j;
    const double u = t1 * face_cells - i, v = t2 * profile_cells - j;
    const double *low = table + (size_t)i * (size_t)grid->profile_nodes + (size_t)j;
    const double *high = low + grid->profile_nodes;
    return (1 - u) * ((1 - v) * low[0] + v * low[1]) + u * ((1 - v) * high[0] + v * high[1]);
}

/* Largest error of the table found at points: all over the flank, and in the middle of random cells. */
static double largest_error(const gm_modifications_grid *grid, int samples) {
    uint64_t seed = 7;
    double largest = 0.0;
    table = calloc((size_t)grid->face_nodes * (size_t)grid->profile_nodes, sizeof *table);
    GM_ASSERT_INT(gm_modifications_add(&design, grid->face_nodes, grid->profile_nodes, table),
                  GM_OK);
    for (int k = 0; k < samples; ++k) {
        double t1 = gm_test_uniform(&seed, 0.0, 1.0), t2 = gm_test_uniform(&seed, 0.0, 1.0);
        if (k % 2 == 0) { /* where curvature shows most */
            t1 = (floor(t1 * (grid->face_nodes - 1)) + 0.5) / (grid->face_nodes - 1);
            t2 = (floor(t2 * (grid->profile_nodes - 1)) + 0.5) / (grid->profile_nodes - 1);
        }
        largest = fmax(largest, fabs(interpolated(grid, t1, t2) - value(t1, t2)));
    }
    free(table);
    return largest;
}

static gm_modifications_grid grid_for(int face_nodes, int profile_nodes, double tolerance) {
    gm_modifications_grid grid;
    GM_ASSERT_INT(gm_modifications_grid_find(&design, face_nodes, profile_nodes, tolerance, &grid),
                  GM_OK);
    return grid;
}

static void a_grid_that_can_be_exact_is(void) {
    static const struct {
        int kind, shape;
        int face_nodes, profile_nodes;
    } grids[] = {
        {GM_MOD_HELIX_SLOPE, 0, 2, 2},
        {GM_MOD_PROFILE_SLOPE, 0, 2, 2},
        {GM_MOD_TWIST, 0, 2, 2},
        {GM_MOD_END_RELIEF_I, GM_SHAPE_LINEAR, 5, 2}, /* a quarter of the face */
        {GM_MOD_END_RELIEF_II, GM_SHAPE_LINEAR, 5, 2},
        {GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR, 2, 6}, /* a fifth of the profile */
        {GM_MOD_ROOT_RELIEF, GM_SHAPE_LINEAR, 2, 6},
    };
    for (size_t k = 0; k < sizeof grids / sizeof grids[0]; ++k) {
        gm_test_context("kind %d", grids[k].kind);
        only(grids[k].kind, grids[k].shape, AMOUNT);
        const gm_modifications_grid grid = grid_for(2, 2, 1e-8);
        GM_ASSERT_INT(grid.face_nodes, grids[k].face_nodes);
        GM_ASSERT_INT(grid.profile_nodes, grids[k].profile_nodes);
        /* roundings of the amount, six times magnified by the range */
        GM_ASSERT(grid.error < 1e-12 * AMOUNT);
        GM_ASSERT(largest_error(&grid, 20000) <= grid.error);
    }
}

static void limits_of_ranges_are_hit_where_few_lines_suffice(void) {
    begin();
    add(GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR, AMOUNT)->profile_range = 0.3;
    add(GM_MOD_ROOT_RELIEF, GM_SHAPE_LINEAR, AMOUNT)->profile_range = 0.25;
    const gm_modifications_grid grid = grid_for(2, 2, 1e-8);
    GM_ASSERT_INT(grid.profile_nodes, 21); /* 3/10 and 1/4 share twentieths */
    GM_ASSERT(grid.error < 1e-12 * AMOUNT);
}

/* The bound holds, and is no more than five times what can be found: it means something. */
static void every_kind_alone_keeps_its_bound_and_nearly_reaches_it(void) {
    for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
        for (int shape = first_shape(kind); shape <= GM_SHAPE_CIRCULAR; ++shape) {
            gm_modification *m = only(kind, shape, AMOUNT);
            m->face_range = 0.2371 * pair.face_width;
            m->profile_range = 0.1873;
            gm_test_context("kind %d, shape %d", kind, shape);
            const gm_modifications_grid grid = grid_for(2, 2, 0.2 * UM);
            const double found = largest_error(&grid, 300000);
            GM_ASSERT(grid.error <= 0.2 * UM);
            GM_ASSERT(found <= grid.error);
            if (kind != GM_MOD_HELIX_SLOPE && kind != GM_MOD_PROFILE_SLOPE &&
                kind != GM_MOD_TWIST) {
                GM_ASSERT(found >= 0.2 * grid.error);
            }
        }
    }
}

static void random_designs_keep_bound_tolerance_and_given_grid(void) {
    uint64_t seed = 2026;
    for (int round = 0; round < 60; ++round) {
        begin();
        const int count = gm_test_integer(&seed, 1, MOST);
        for (int k = 0; k < count; ++k) {
            int kind = gm_test_integer(&seed, 0, GM_MOD_ROOT_CORNER_II);
            const int shape = gm_test_integer(&seed, first_shape(kind), GM_SHAPE_CIRCULAR);
            if (kind >= GM_MOD_TIP_CORNER_I && shape == GM_SHAPE_LINEAR) {
                kind -= GM_MOD_TIP_CORNER_I - GM_MOD_TIP_RELIEF; /* never fine enough: see below */
                kind = kind > GM_MOD_ROOT_RELIEF ? GM_MOD_TWIST : kind;
            }
            gm_modification *m = add(kind, shape, gm_test_uniform(&seed, 1, 30) * UM);
            m->face_range = gm_test_uniform(&seed, 0.1, 1.0) * pair.face_width;
            m->profile_range = gm_test_uniform(&seed, 0.1, 1.0);
        }
        const int face_nodes = gm_test_integer(&seed, 2, 30);
        const int profile_nodes = gm_test_integer(&seed, 2, 40);
        const double tolerance = gm_test_uniform(&seed, 0.02, 0.5) * UM;
        gm_test_context("round %d", round);
        const gm_modifications_grid grid = grid_for(face_nodes, profile_nodes, tolerance);
        GM_ASSERT_INT((grid.face_nodes - 1) % (face_nodes - 1), 0);
        GM_ASSERT_INT((grid.profile_nodes - 1) % (profile_nodes - 1), 0);
        GM_ASSERT(grid.error <= tolerance + 1e-18); /* the rounding counts as well */
        GM_ASSERT(largest_error(&grid, 20000) <= grid.error);
    }
}

/* A kink across the grid costs in proportion to a cell: here 20 um / 0.2 / 500 / 4 is far above 0.01 um. */
static void a_linear_corner_says_that_it_misses_the_tolerance(void) {
    only(GM_MOD_TIP_CORNER_II, GM_SHAPE_LINEAR, AMOUNT);
    const gm_modifications_grid grid = grid_for(2, 2, 1e-8);
    GM_ASSERT(grid.error > 1e-8);
    GM_ASSERT(grid.error < 0.2 * UM);
    GM_ASSERT(grid.face_nodes * grid.profile_nodes <= TABLE_NODES);
    GM_ASSERT(largest_error(&grid, 300000) <= grid.error);
}

static void a_given_grid_beyond_the_limit_is_taken_as_it_is(void) {
    only(GM_MOD_TIP_CORNER_II, GM_SHAPE_LINEAR, AMOUNT);
    const gm_modifications_grid grid = grid_for(1001, 801, 1e-8);
    GM_ASSERT_INT(grid.face_nodes, 1001);
    GM_ASSERT_INT(grid.profile_nodes, 801);
}

static void no_modifications_need_no_grid(void) {
    begin();
    design.list = NULL;
    const gm_modifications_grid grid = grid_for(21, 31, 1e-8);
    GM_ASSERT_INT(grid.face_nodes, 21);
    GM_ASSERT_INT(grid.profile_nodes, 31);
    GM_ASSERT_ABS(grid.error, 0.0, 0.0);
    GM_ASSERT_ABS(value(0.5, 0.5), 0.0, 0.0);
}

static void the_table_is_added_to_what_is_there(void) {
    double nodes[2][3] = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
    only(GM_MOD_TWIST, 0, 4.0e-3);
    GM_ASSERT_INT(gm_modifications_add(&design, 2, 3, &nodes[0][0]), GM_OK);
    GM_ASSERT_REL(nodes[0][0], 1.001, 1e-15);
    GM_ASSERT_REL(nodes[0][1], 2.0, 0.0);
    GM_ASSERT_REL(nodes[1][2], 6.001, 1e-15);
    GM_ASSERT_REL(nodes[1][0], 3.999, 1e-15);
}

/* ---------------------------------------------------------------------------------------------
 * Ramps
 * ------------------------------------------------------------------------------------------- */

static gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX];
static int ramp_count;
static gm_modification rest_list[GM_MODIFICATIONS_MAX];
static gm_modifications rest;

static void split(void) {
    rest = design;
    rest.list = rest_list;
    GM_ASSERT_INT(gm_modifications_split(&design, ramps, &ramp_count, rest_list, &rest.count),
                  GM_OK);
}

/* By the definition of a ramp. */
static double parts_at(double t1, double t2) {
    double sum = gm_modifications_value(&rest, t1, t2);
    for (int k = 0; k < ramp_count; ++k) {
        sum -= fmax(0.0, ramps[k].offset + ramps[k].per_t1 * t1 + ramps[k].per_t2 * t2);
    }
    return sum;
}

static void ramps_and_the_rest_are_the_design(void) {
    uint64_t seed = 77;
    int linear = 0;
    for (int round = 0; round < 300; ++round) {
        begin();

        /* Modifications of all kinds, of which linear reliefs become ramps. */
        const int count = gm_test_integer(&seed, 0, MOST);
        int expected = 0;
        for (int k = 0; k < count; ++k) {
            const int kind = gm_test_integer(&seed, 0, GM_MODIFICATION_KINDS - 1);
            const int shape = gm_test_integer(&seed, first_shape(kind), GM_SHAPE_CIRCULAR);
            gm_modification *m = add(kind, shape, gm_test_uniform(&seed, 1, 30) * UM);
            m->face_range = gm_test_uniform(&seed, 0.1, 1.0) * pair.face_width;
            m->profile_range = gm_test_uniform(&seed, 0.1, 1.0);
            expected += is_relief(kind) && shape == GM_SHAPE_LINEAR;
        }

        split();
        gm_test_context("round %d", round);
        GM_ASSERT_INT(ramp_count, expected);
        GM_ASSERT_INT(rest.count, count - expected);
        linear += expected;
        for (int k = 0; k < 100; ++k) {
            const double t1 = k % 10 == 0 ? 1.0 : gm_test_uniform(&seed, 0.0, 1.0);
            const double t2 = k % 7 == 0 ? 0.0 : gm_test_uniform(&seed, 0.0, 1.0);
            /* roundings of 30 um, ten times magnified by the range, in each of eight */
            GM_ASSERT_ABS(parts_at(t1, t2), value(t1, t2), 8 * 10 * 4 * 0x1p-53 * 30 * UM);
        }
    }
    GM_ASSERT(linear > 200);
}

static void more_ramps_than_flanks_hold_are_left_for_a_table(void) {
    static gm_modification many[GM_FLANK_RAMPS_MAX + 3];
    begin();
    for (int k = 0; k < GM_FLANK_RAMPS_MAX + 3; ++k) {
        many[k] = (gm_modification){
            GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR, GM_RANGE_SHARE, (k == 1) ? 0.0 : k * UM, 0.0,
            0.05 * (k + 1)};
    }
    many[0].kind = GM_MOD_TWIST; /* without an amount, as the second one: nothing is left of them */
    design = (gm_modifications){many, GM_FLANK_RAMPS_MAX + 3, &pair.pinion, pair.face_width};
    split();
    GM_ASSERT_INT(ramp_count, GM_FLANK_RAMPS_MAX);
    GM_ASSERT_INT(rest.count, 1);
    GM_ASSERT_REL(rest_list[0].amount, (GM_FLANK_RAMPS_MAX + 2) * UM, 0.0);
    GM_ASSERT_REL(parts_at(0.3, 0.9), value(0.3, 0.9), 1e-13);
}

/* ---------------------------------------------------------------------------------------------
 * What is refused
 * ------------------------------------------------------------------------------------------- */

static void refused(const char *field, int index) {
    int got_index = -2;
    const char *got_field = "", *requirement = NULL;
    gm_modifications_grid grid = {1, 1, 0.0};
    double nodes[4] = {1.0, 1.0, 1.0, 1.0};
    gm_test_context("%s", field);
    GM_ASSERT_INT(gm_modifications_check(&design, &got_index, &got_field, &requirement),
                  GM_ERR_PARAMETER);
    GM_ASSERT_STRING(got_field, field);
    GM_ASSERT_INT(got_index, index);
    GM_ASSERT(requirement != NULL);
    GM_ASSERT_INT(gm_modifications_check(&design, NULL, NULL, NULL), GM_ERR_PARAMETER);
    GM_ASSERT_NAN(value(0.5, 0.5));
    GM_ASSERT_INT(gm_modifications_grid_find(&design, 2, 2, 1e-8, &grid), GM_ERR_PARAMETER);
    GM_ASSERT_INT(grid.face_nodes, 0);
    GM_ASSERT_NAN(grid.error);
    GM_ASSERT_INT(gm_modifications_add(&design, 2, 2, nodes), GM_ERR_PARAMETER);
    GM_ASSERT_REL(nodes[0], 1.0, 0.0);
    ramp_count = rest.count = 7;
    GM_ASSERT_INT(gm_modifications_split(&design, ramps, &ramp_count, rest_list, &rest.count),
                  GM_ERR_PARAMETER);
    GM_ASSERT_INT(ramp_count, 0);
    GM_ASSERT_INT(rest.count, 0);
}

/* The second of two modifications, so that the index tells something. */
static gm_modification *second(int kind, int shape) {
    only(GM_MOD_CROWNING, GM_SHAPE_PARABOLIC, AMOUNT);
    return add(kind, shape, AMOUNT);
}

static void what_is_out_of_range_is_refused(void) {
    second(-1, 0);
    refused("kind", 1);
    second(GM_MODIFICATION_KINDS, 0);
    refused("kind", 1);
    static const double amounts[] = {(double)NAN, (double)INFINITY, 0.0101, -0.0101};
    for (int k = 0; k < 4; ++k) {
        second(GM_MOD_HELIX_SLOPE, 0)->amount = amounts[k];
        refused("amount", 1);
    }
    second(GM_MOD_TIP_CORNER_I, GM_SHAPE_LINEAR)->amount = -1e-9;
    refused("amount", 1);
    second(GM_MOD_CROWNING, GM_SHAPE_LINEAR);
    refused("shape", 1);
    second(GM_MOD_TIP_RELIEF, 3);
    refused("shape", 1);
    second(GM_MOD_TIP_RELIEF, -1);
    refused("shape", 1);
    gm_modification *m = second(GM_MOD_END_RELIEF_I, GM_SHAPE_CIRCULAR);
    m->face_range = 2e-3;
    m->amount = 1.001e-3; /* more than half of it */
    refused("amount", 1);
}

static void ranges_beyond_the_flank_are_refused(void) {
    static const double lengths[] = {0.0, -1e-3, 17.6e-3, (double)NAN};
    for (int k = 0; k < 4; ++k) {
        second(GM_MOD_END_RELIEF_II, GM_SHAPE_LINEAR)->face_range = lengths[k];
        refused("face_range", 1);
        gm_modification *m = second(GM_MOD_ROOT_RELIEF, GM_SHAPE_LINEAR);
        m->profile_range_by = GM_RANGE_LENGTH;
        m->profile_range = lengths[k];
        refused("profile_range", 1);
    }
    static const double shares[] = {0.0, -0.1, 1.0001, (double)NAN};
    for (int k = 0; k < 4; ++k) {
        second(GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR)->profile_range = shares[k];
        refused("profile_range", 1);
    }
    begin();
    const double radii[] = {pair.pinion.start_radius - 1e-6, pair.pinion.tip_radius,
                            pair.pinion.tip_radius + 1e-6, (double)NAN};
    for (int k = 0; k < 4; ++k) {
        gm_modification *m = second(GM_MOD_TIP_CORNER_II, GM_SHAPE_LINEAR);
        m->profile_range_by = GM_RANGE_RADIUS;
        m->profile_range = radii[k];
        refused("profile_range", 1);
    }
    second(GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR)->profile_range_by = 3;
    refused("profile_range_by", 1);
}

static void the_whole_flank_is_the_longest_range(void) {
    gm_modification *m = only(GM_MOD_END_RELIEF_I, GM_SHAPE_LINEAR, AMOUNT);
    m->face_range = pair.face_width;
    GM_ASSERT_REL(value(0.5, 0.5), -0.5 * AMOUNT, 1e-15);
    m = only(GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR, AMOUNT);
    m->profile_range = 1.0;
    GM_ASSERT_REL(value(0.5, 0.5), -0.5 * AMOUNT, 1e-15);
    m->profile_range_by = GM_RANGE_LENGTH;
    m->profile_range = roll_length();
    GM_ASSERT_REL(value(0.5, 0.5), -0.5 * AMOUNT, 1e-15);
    m->profile_range_by = GM_RANGE_RADIUS;
    m->profile_range = pair.pinion.start_radius;
    GM_ASSERT_REL(value(0.5, 0.5), -0.5 * AMOUNT, 1e-13);
}

static void flanks_that_are_none_are_refused(void) {
    only(GM_MOD_CROWNING, GM_SHAPE_PARABOLIC, AMOUNT);
    design.face_width = 0.0;
    refused("face_width", -1);
    design.face_width = (double)INFINITY;
    refused("face_width", -1);
    only(GM_MOD_CROWNING, GM_SHAPE_PARABOLIC, AMOUNT);
    pair.pinion.tip_roll_length = pair.pinion.start_roll_length;
    refused("gear", -1);
    only(GM_MOD_CROWNING, GM_SHAPE_PARABOLIC, AMOUNT);
    design.count = -1;
    refused("count", -1);
    design.count = GM_MODIFICATIONS_MAX + 1;
    refused("count", -1);
}

static void calls_that_cannot_be_done_are_refused(void) {
    gm_modifications_grid grid;
    double nodes[4] = {0.0};
    only(GM_MOD_CROWNING, GM_SHAPE_PARABOLIC, AMOUNT);
    GM_ASSERT_INT(gm_modifications_check(NULL, NULL, NULL, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_modifications_grid_find(NULL, 2, 2, 1e-8, &grid), GM_ERR_NULL);
    GM_ASSERT_INT(gm_modifications_grid_find(&design, 2, 2, 1e-8, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_modifications_add(NULL, 2, 2, nodes), GM_ERR_NULL);
    GM_ASSERT_INT(gm_modifications_add(&design, 2, 2, NULL), GM_ERR_NULL);
    int count;
    GM_ASSERT_INT(gm_modifications_split(NULL, ramps, &count, rest_list, &count), GM_ERR_NULL);
    GM_ASSERT_INT(gm_modifications_split(&design, NULL, &count, rest_list, &count), GM_ERR_NULL);
    GM_ASSERT_INT(gm_modifications_split(&design, ramps, NULL, rest_list, &count), GM_ERR_NULL);
    GM_ASSERT_INT(gm_modifications_split(&design, ramps, &count, NULL, &count), GM_ERR_NULL);
    GM_ASSERT_INT(gm_modifications_split(&design, ramps, &count, rest_list, NULL), GM_ERR_NULL);
    static const int bad_nodes[] = {1, 0, -5, 10001};
    for (int k = 0; k < 4; ++k) {
        GM_ASSERT_INT(gm_modifications_grid_find(&design, bad_nodes[k], 2, 1e-8, &grid),
                      GM_ERR_PARAMETER);
        GM_ASSERT_INT(gm_modifications_grid_find(&design, 2, bad_nodes[k], 1e-8, &grid),
                      GM_ERR_PARAMETER);
        GM_ASSERT_INT(gm_modifications_add(&design, bad_nodes[k], 2, nodes), GM_ERR_PARAMETER);
    }
    static const double bad_tolerances[] = {0.0, -1e-8, 0.9e-12, (double)NAN, (double)INFINITY};
    for (int k = 0; k < 5; ++k) {
        GM_ASSERT_INT(gm_modifications_grid_find(&design, 2, 2, bad_tolerances[k], &grid),
                      GM_ERR_PARAMETER);
    }
    design.gear = NULL;
    GM_ASSERT_INT(gm_modifications_check(&design, NULL, NULL, NULL), GM_ERR_NULL);
    begin();
    design.count = 1;
    design.list = NULL;
    GM_ASSERT_INT(gm_modifications_check(&design, NULL, NULL, NULL), GM_ERR_NULL);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(every_kind_has_its_value_where_it_is_known),
        GM_TEST(a_circular_relief_is_a_circle),
        GM_TEST(a_shallow_circle_is_a_parabola_to_the_second_order),
        GM_TEST(the_amount_of_crownings_may_be_negative),
        GM_TEST(an_amount_of_zero_changes_nothing),
        GM_TEST(reliefs_change_nothing_outside_their_range),
        GM_TEST(the_mean_over_the_flank_is_that_of_the_formula),
        GM_TEST(parabola_and_circle_begin_tangentially_and_the_line_with_a_kink),
        GM_TEST(twist_is_the_difference_of_the_slopes_at_the_ends),
        GM_TEST(modifications_add_up),
        GM_TEST(the_other_hand_is_the_mirror_image),
        GM_TEST(a_range_may_be_given_in_three_ways),
        GM_TEST(a_point_beside_the_flank_has_no_value),
        GM_TEST(a_grid_that_can_be_exact_is),
        GM_TEST(limits_of_ranges_are_hit_where_few_lines_suffice),
        GM_TEST(every_kind_alone_keeps_its_bound_and_nearly_reaches_it),
        GM_TEST(random_designs_keep_bound_tolerance_and_given_grid),
        GM_TEST(a_linear_corner_says_that_it_misses_the_tolerance),
        GM_TEST(a_given_grid_beyond_the_limit_is_taken_as_it_is),
        GM_TEST(no_modifications_need_no_grid),
        GM_TEST(the_table_is_added_to_what_is_there),
        GM_TEST(ramps_and_the_rest_are_the_design),
        GM_TEST(more_ramps_than_flanks_hold_are_left_for_a_table),
        GM_TEST(what_is_out_of_range_is_refused),
        GM_TEST(ranges_beyond_the_flank_are_refused),
        GM_TEST(the_whole_flank_is_the_longest_range),
        GM_TEST(flanks_that_are_none_are_refused),
        GM_TEST(calls_that_cannot_be_done_are_refused),
    };
    return gm_test_main("unit.modification", tests, GM_TEST_COUNT(tests), argc, argv);
}
