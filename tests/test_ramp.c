/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Linear reliefs as ramps: integrals by hand, tables that hold the same surface exactly, and what must not matter.
 * The sweep against the second model, derivatives, wrenches and mirror images have random ramps as well.
 */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "reference_gear.h"

#define UM 1e-6

enum { FACE_NODES = 5, PROFILE_NODES = 21, NODES = FACE_NODES * PROFILE_NODES };
enum { MEMORY_DOUBLES = 10 * NODES + 200 };

/* Of a pinion or wheel, with room for one table on either side, or none. */
static gm_flanks *flanks_of(const gm_pair *pair, int wheel, int tables) {
    static double memory[4][MEMORY_DOUBLES];
    static int next;
    double *place = memory[next++ % 4]; /* the fourth one back is no longer in use */
    const gm_flanks_params sizes = {.teeth = wheel ? pair->wheel.teeth : pair->pinion.teeth,
                                    .drive_tables = tables,
                                    .drive_face_nodes = FACE_NODES,
                                    .drive_profile_nodes = PROFILE_NODES,
                                    .coast_tables = tables,
                                    .coast_face_nodes = FACE_NODES,
                                    .coast_profile_nodes = PROFILE_NODES};
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, place, sizeof memory[0]), GM_OK);
    return flanks;
}

static void set_ramps(gm_flanks *flanks, const gm_flank_ramp *ramps, int count) {
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_DRIVE, ramps, count, 1.0), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_COAST, ramps, count, 1.0), GM_OK);
}

static void set_table(gm_flanks *flanks, const double *values) {
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_COAST, GM_ALL_TEETH, values, 1.0), GM_OK);
}

/* Deep enough at -5 um .. 20 um for parts of the flanks, or all of them. */
static double any_offset(uint64_t *seed, const gm_pair *pair) {
    const double x = 0.5 * pair->backlash + gm_test_uniform(seed, -5.0, 20.0) * UM;
    return gm_test_integer(seed, 0, 3) == 0 ? -x : x;
}

/* Everything that an evaluation gives; lengths to `tolerance` (m), the rest in proportion to it. */
static void same_results(const gm_pair *pair, const gm_flanks *const one[2],
                         const gm_flanks *const other[2], double angle, double x,
                         double tolerance) {
    gm_position position;
    gm_penetration a, b;
    gm_wrench force_a, force_b;
    GM_ASSERT_INT(gm_position_from_pinion_angle(pair, angle, x, 1e-3, &position), GM_OK);
    GM_ASSERT_INT(penetration_3d_at(pair, one[0], one[1], &position, &a), GM_OK);
    GM_ASSERT_INT(penetration_3d_at(pair, other[0], other[1], &position, &b), GM_OK);
    GM_ASSERT_INT(wrench_3d_at(pair, one[0], one[1], &position, 1e8, 0.0, &force_a), GM_OK);
    GM_ASSERT_INT(wrench_3d_at(pair, other[0], other[1], &position, 1e8, 0.0, &force_b), GM_OK);
    const double share = tolerance / (0.1 * UM); /* reliefs rise by more than that over the flank */
    GM_ASSERT_ABS(a.drive, b.drive, tolerance);
    GM_ASSERT_ABS(a.coast, b.coast, tolerance);
    GM_ASSERT_ABS(a.drive_contact, b.drive_contact, share);
    GM_ASSERT_ABS(a.coast_contact, b.coast_contact, share);
    GM_ASSERT_INT(a.drive_pairs, b.drive_pairs);
    GM_ASSERT_ABS(a.d_pinion_angle, b.d_pinion_angle, share * pair->pinion.base_radius);
    GM_ASSERT_ABS(a.d_wheel_angle, b.d_wheel_angle, share * pair->wheel.base_radius);
    for (int k = 0; k < 3; ++k) {
        const double newtons = 1e8 * tolerance;
        GM_ASSERT_ABS(force_a.wheel_force[k], force_b.wheel_force[k], newtons);
        GM_ASSERT_ABS(force_a.wheel_moment[k], force_b.wheel_moment[k],
                      2.0 * newtons * pair->center_distance);
        GM_ASSERT_ABS(force_a.pinion_moment[k], force_b.pinion_moment[k],
                      2.0 * newtons * pair->center_distance);
    }
}

/* ---------------------------------------------------------------------------------------------
 * By hand
 * ------------------------------------------------------------------------------------------- */

/*
 * An end relief C over the share l of the face of a spur pair takes C l / 2 off delta, as long as C < delta. If not,
 * the flanks touch where C (1 - t1 / l) < delta: over l delta / C of the relief, with a mean of delta / 2.
 */
static void end_relief_of_spur_gears_is_a_triangle(void) {
    const gm_pair pair = spur_pair();
    gm_flanks *flanks = flanks_of(&pair, 0, 0);
    const double share = 0.3, delta = 7.0 * UM;
    static const double amounts[] = {0.0, 3.0 * UM, 7.0 * UM, 20.0 * UM};
    for (int k = 0; k < 4; ++k) {
        const double amount = amounts[k];
        const gm_flank_ramp ramp = {amount, -amount / share, 0.0};
        set_ramps(flanks, &ramp, 1);
        const double touching = amount > delta ? share * delta / amount : share;
        const double sum = (1.0 - share) * delta +
                           touching * (amount > delta ? 0.5 * delta : delta - 0.5 * amount);
        for (int n = 0; n < 10; ++n) {
            gm_test_context("%g um, step %d", amount / UM, n);
            const double angle = 0.02 * n, x = 0.5 * pair.backlash + delta;
            const double pairs = at(&pair, NULL, NULL, angle, x).drive_contact;
            const gm_penetration got = at(&pair, flanks, NULL, angle, x);
            GM_ASSERT_REL(got.drive, pairs * sum, 1e-10); /* x is rounded: 1e-16 m of 7 um */
            GM_ASSERT_REL(got.drive_contact, pairs * (1.0 - share + touching), 1e-9);
        }
    }
}

/*
 * Over one base pitch the lines of contact cover the field of action once. So what a corner of amount C, length
 * l_beta (share of the face) and l_alpha (roll length) takes off the mean sum is a pyramid, C l_beta l_alpha / 6, over
 * p_bt - if it lies within the field, as a corner at the pinion's tip does, and the flanks touch all over.
 */
static void corner_takes_a_pyramid_off_the_mean(void) {
    enum { STEPS = 4000 };
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double share_beta = 0.3, share_alpha = 0.25, amount = 8.0 * UM;
    const double roll = pair.pinion.tip_roll_length - pair.pinion.start_roll_length;
    static const double sides[2] = {0.0, 1.0}; /* face I, face II */
    for (int k = 0; k < 2; ++k) {
        const double sign = 2.0 * sides[k] - 1.0;
        const gm_flank_ramp corner = {amount - amount * (sides[k] / share_beta + 1.0 / share_alpha),
                                      sign * amount / share_beta, amount / share_alpha};
        gm_flanks *flanks = flanks_of(&pair, 0, 0);
        set_ramps(flanks, &corner, 1);
        double taken = 0.0;
        for (int n = 0; n < STEPS; ++n) {
            const double angle = pair.pinion.pitch_angle * n / STEPS;
            const double x = 0.5 * pair.backlash + 10.0 * UM;
            taken +=
                (at(&pair, NULL, NULL, angle, x).drive - at(&pair, flanks, NULL, angle, x).drive) /
                STEPS;
        }
        gm_test_context("face %d", k);
        const double pyramid =
            amount * share_beta * share_alpha * roll / 6.0 / pair.transverse_base_pitch;
        GM_ASSERT_REL(taken, pyramid, 1e-6); /* the sampling: error falls with STEPS^2 and faster */
    }
}

/* Where all flanks touch all over, the sum is linear in what is taken off. */
static void ramps_of_both_gears_add_up_in_full_contact(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double delta = 30.0 * UM, x = 0.5 * pair.backlash + delta;
    gm_flanks *pinion = flanks_of(&pair, 0, 0), *wheel = flanks_of(&pair, 1, 0);
    /* Tip reliefs whose edges are the same line on the plane of action: rho_w = T0 + delta - rho_p. */
    const double edge = 0.7;
    const double rho = pair.pinion.start_roll_length +
                       edge * (pair.pinion.tip_roll_length - pair.pinion.start_roll_length);
    const double on_wheel = (pair.line_of_action + delta - rho - pair.wheel.start_roll_length) /
                            (pair.wheel.tip_roll_length - pair.wheel.start_roll_length);
    const gm_flank_ramp tip = {-edge * 20.0 * UM, 0.0, 20.0 * UM};
    const gm_flank_ramp opposite = {-on_wheel * 15.0 * UM, 0.0, 15.0 * UM};
    const gm_flank_ramp end = {-4.0 * UM, 8.0 * UM, 0.0};
    const gm_flank_ramp of_wheel[] = {opposite, end};
    set_ramps(pinion, &tip, 1);
    set_ramps(wheel, of_wheel, 2);
    for (int k = 0; k < 50; ++k) {
        gm_test_context("step %d", k);
        const double angle = 0.01 * k;
        const double none = at(&pair, NULL, NULL, angle, x).drive;
        const double by_pinion = none - at(&pair, pinion, NULL, angle, x).drive;
        const double by_wheel = none - at(&pair, NULL, wheel, angle, x).drive;
        const gm_penetration both = at(&pair, pinion, wheel, angle, x);
        GM_ASSERT(by_pinion > 0.1 * UM && by_wheel > 0.1 * UM);
        GM_ASSERT_ABS(none - both.drive, by_pinion + by_wheel, 1e-13 * none);
        GM_ASSERT_REL(both.drive_contact, at(&pair, NULL, NULL, angle, x).drive_contact, 1e-13);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Against tables
 * ------------------------------------------------------------------------------------------- */

/* All that a table of 5 x 21 nodes holds exactly: edges are on grid lines. */
static gm_modification on_grid[] = {
    {GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR, GM_RANGE_SHARE, 12 * UM, 0.0, 0.2},
    {GM_MOD_ROOT_RELIEF, GM_SHAPE_LINEAR, GM_RANGE_SHARE, 9 * UM, 0.0, 0.25},
    {GM_MOD_END_RELIEF_I, GM_SHAPE_LINEAR, 0, 6 * UM, 0.25, 0.0},
    {GM_MOD_END_RELIEF_II, GM_SHAPE_LINEAR, 0, 8 * UM, 0.5, 0.0},
};

/* Ramps of one flank and a table of some micrometres; or one table that is both. */
static void make_both(const gm_pair *pair, int wheel, int count, uint64_t *seed,
                      gm_flanks **made_ramped, gm_flanks **made_tabled) {
    gm_modification list[4], rest[4];
    const gm_modifications design = {list, count, wheel ? &pair->wheel : &pair->pinion,
                                     pair->face_width};
    gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX];
    double values[NODES];
    int ramp_count, rest_count;
    for (int k = 0; k < count; ++k) {
        list[k] = on_grid[k];
        list[k].face_range *= pair->face_width;
    }
    for (int k = 0; k < NODES; ++k) {
        values[k] = gm_test_uniform(seed, -1.0, 1.0) * UM;
    }
    GM_ASSERT_INT(gm_modifications_split(&design, ramps, &ramp_count, rest, &rest_count), GM_OK);
    GM_ASSERT_INT(ramp_count, count);
    GM_ASSERT_INT(rest_count, 0);
    gm_flanks *ramped = *made_ramped = flanks_of(pair, wheel, 1);
    gm_flanks *tabled = *made_tabled = flanks_of(pair, wheel, 1);
    set_table(ramped, values);
    set_ramps(ramped, ramps, ramp_count);
    GM_ASSERT_INT(gm_modifications_add(&design, FACE_NODES, PROFILE_NODES, values), GM_OK);
    set_table(tabled, values);
}

static void compare_with_tables(const gm_pair *pair, uint64_t seed) {
    for (int count = 1; count <= 4; ++count) {
        gm_flanks *ramped[2], *tabled[2];
        make_both(pair, 0, count, &seed, &ramped[0], &tabled[0]);
        make_both(pair, 1, count, &seed, &ramped[1], &tabled[1]);
        for (int k = 0; k < 60; ++k) {
            gm_test_context("%d reliefs, state %d, helix %g", count, k, pair->helix_angle);
            const gm_flanks *const one[2] = {ramped[0], k % 3 == 0 ? NULL : ramped[1]};
            const gm_flanks *const other[2] = {tabled[0], k % 3 == 0 ? NULL : tabled[1]};
            const double angle = gm_test_uniform(&seed, -3.0, 3.0);
            /* lengths of some millimetres, rounded: to 1e-17 m, some ten times */
            same_results(pair, one, other, angle, any_offset(&seed, pair), 1e-15);
        }
    }
}

static void tables_that_hold_the_reliefs_exactly_give_the_same(void) {
    const gm_pair helical = reference_pair(REFERENCE_FACE_WIDTH), spur = spur_pair();
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.helix_angle = -params.helix_angle;
    const gm_pair left = make_pair(&params);
    compare_with_tables(&helical, UINT64_C(71));
    compare_with_tables(&left, UINT64_C(72));
    compare_with_tables(&spur, UINT64_C(73));
}

/* A table of a corner is off by its bound at most; along all lines that makes the bound times what touches. */
static void a_fine_table_of_a_corner_is_off_by_no_more_than_its_bound(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_modification corner = {
        GM_MOD_ROOT_CORNER_II, GM_SHAPE_LINEAR, GM_RANGE_SHARE, 15 * UM, 5e-3, 0.35};
    const gm_modifications design = {&corner, 1, &pair.pinion, pair.face_width};
    gm_modifications_grid grid;
    gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX];
    gm_modification rest[1];
    int ramp_count, rest_count;
    GM_ASSERT_INT(gm_modifications_grid_find(&design, 2, 2, 0.2 * UM, &grid), GM_OK);
    GM_ASSERT_INT(gm_modifications_split(&design, ramps, &ramp_count, rest, &rest_count), GM_OK);
    const gm_flanks_params sizes = {
        pair.pinion.teeth, 1, grid.face_nodes, grid.profile_nodes, 0, 0, 0};
    const size_t size = gm_flanks_size(&sizes);
    void *place = malloc(size);
    double *values = calloc((size_t)(grid.face_nodes * grid.profile_nodes), sizeof *values);
    gm_flanks *tabled, *ramped = flanks_of(&pair, 0, 0);
    GM_ASSERT_INT(gm_modifications_add(&design, grid.face_nodes, grid.profile_nodes, values),
                  GM_OK);
    GM_ASSERT_INT(gm_flanks_init(&tabled, &sizes, place, size), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_table(tabled, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    set_ramps(ramped, ramps, ramp_count);
    double largest = 0.0;
    for (int k = 0; k < 400; ++k) {
        const double angle = 0.002 * k, x = 0.5 * pair.backlash + (k % 20) * UM;
        const gm_penetration exact = at(&pair, ramped, NULL, angle, x);
        const double error = at(&pair, tabled, NULL, angle, x).drive - exact.drive;
        gm_test_context("step %d", k);
        GM_ASSERT_ABS(error, 0.0, grid.error * (exact.drive_contact + 1e-3));
        largest = fmax(largest, fabs(error));
    }
    GM_ASSERT(largest > 0.005 * grid.error); /* it is not nothing: the corner takes part */
    free(values);
    free(place);
}

/* ---------------------------------------------------------------------------------------------
 * What must not matter
 * ------------------------------------------------------------------------------------------- */

static const gm_flank_ramp some[] = {
    {-9.0 * UM, 0.0, 12.0 * UM}, {3.0 * UM, -10.0 * UM, -6.0 * UM}, {-8.0 * UM, 9.0 * UM, 3.0 * UM},
    {2.0 * UM, 0.0, -7.0 * UM},  {1.5 * UM, -4.0 * UM, 0.0},
};
enum { SOME = 5 };

static void compare_ramps(const gm_flank_ramp *one, int one_count, const gm_flank_ramp *other,
                          int other_count, double tolerance) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    uint64_t seed = UINT64_C(81);
    gm_flanks *a = flanks_of(&pair, 0, 0), *b = flanks_of(&pair, 0, 0);
    set_ramps(a, one, one_count);
    set_ramps(b, other, other_count);
    for (int k = 0; k < 100; ++k) {
        gm_test_context("state %d", k);
        const gm_flanks *const first[2] = {a, NULL}, *const second[2] = {b, NULL};
        const double angle = gm_test_uniform(&seed, -3.0, 3.0);
        same_results(&pair, first, second, angle, any_offset(&seed, &pair), tolerance);
    }
}

static void two_halves_are_a_whole(void) {
    gm_flank_ramp halves[2 * SOME];
    for (int k = 0; k < 2 * SOME; ++k) {
        const gm_flank_ramp *whole = &some[k % SOME];
        halves[k] = (gm_flank_ramp){0.5 * whole->offset, 0.5 * whole->per_t1, 0.5 * whole->per_t2};
    }
    compare_ramps(some, SOME, halves, 2 * SOME, 1e-18);
}

static void order_does_not_matter(void) {
    gm_flank_ramp reversed[SOME];
    for (int k = 0; k < SOME; ++k) {
        reversed[k] = some[SOME - 1 - k];
    }
    compare_ramps(some, SOME, reversed, SOME, 1e-18);
}

/* Not even the last bit of it. */
static void ramps_that_take_nothing_off_change_nothing(void) {
    static const gm_flank_ramp none[] = {
        {0.0, 0.0, 0.0}, {-1.0 * UM, 0.0, 0.0}, {-9.0 * UM, 4.0 * UM, 4.0 * UM}};
    compare_ramps(none, 3, NULL, 0, 0.0);
}

/*
 * A relief parallel to the lines of contact: along a line it takes off the same everywhere. As a deviation it is the
 * same as a smaller delta of that line, so a line is either as without relief, or lower by a constant.
 */
static void edges_along_the_lines_of_contact_are_none(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double roll = pair.pinion.tip_roll_length - pair.pinion.start_roll_length;
    const double climb = pair.face_advance / roll;
    const double rise = 40.0 * UM;
    int lower = 0;
    gm_flanks *flanks = flanks_of(&pair, 0, 0);
    for (int k = 0; k < 200; ++k) {
        gm_position position;
        const double x = 0.5 * pair.backlash + 20.0 * UM;
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.003 * k, x, 0.0, &position), GM_OK);
        /* The edge is on line 0 itself, which has t2 = t2_0 + climb t1, and then beside it. */
        const double t2 =
            (pair.phase_origin[GM_DRIVE] + position.phase - pair.pinion.start_roll_length) / roll;
        const double beside = k % 2 == 0 ? 0.0 : 0.01;
        const gm_flank_ramp ramp = {-rise * (t2 - beside), -rise * climb, rise};
        set_ramps(flanks, &ramp, 1);
        gm_test_context("step %d", k);
        gm_penetration got, ideal;
        GM_ASSERT_INT(penetration_3d_at(&pair, flanks, NULL, &position, &got), GM_OK);
        GM_ASSERT_INT(penetration_3d_at(&pair, NULL, NULL, &position, &ideal), GM_OK);
        /* Line i is i p_bt behind the edge, and all that touch are longer than nothing. */
        double expected = 0.0;
        const double path[2] = {pair.line_of_action + 20.0 * UM - pair.wheel.tip_roll_length,
                                pair.pinion.tip_roll_length};
        for (int i = -4; i <= 4; ++i) {
            const double rho =
                pair.phase_origin[GM_DRIVE] + position.phase + i * pair.transverse_base_pitch;
            const double from = fmax(0.0, (path[0] - rho) / pair.face_advance);
            const double to = fmin(1.0, (path[1] - rho) / pair.face_advance);
            const double lacks = rise * (i * pair.transverse_base_pitch / roll + beside);
            if (to > from) {
                expected += (to - from) * fmax(0.0, 20.0 * UM - fmax(0.0, lacks));
            }
        }
        GM_ASSERT_ABS(got.drive, expected, 1e-15);
        lower += got.drive < ideal.drive;
        GM_ASSERT(isfinite(got.d_pinion_angle) && isfinite(got.d_wheel_angle));
    }
    GM_ASSERT(lower > 100); /* in the others the lines behind the edge have left */
}

/* ---------------------------------------------------------------------------------------------
 * In a cache
 * ------------------------------------------------------------------------------------------- */

static void a_cache_has_one_pass_for_ramps_and_follows_them(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    gm_flanks *pinion = flanks_of(&pair, 0, 0), *wheel = flanks_of(&pair, 1, 0);
    set_ramps(pinion, some, SOME);
    set_ramps(wheel, some, 2);
    gm_cache_params params;
    gm_cache_params_default(&params);
    plain_mesh room;
    gm_mesh *mesh;
    GM_ASSERT_INT(plain_mesh_make(&room, &pair, pinion, wheel, 1e8, 0.0, &mesh), GM_OK);
    const size_t size = gm_cache_size(&params, mesh);
    void *place = malloc(size);
    gm_cache *cache;
    gm_cache_errors errors;
    GM_ASSERT_INT(gm_cache_init(&cache, &params, mesh, place, size), GM_OK);
    GM_ASSERT_INT(gm_cache_passes(cache), 1);
    GM_ASSERT_INT(gm_cache_error(cache, 3000, 5, NULL, &errors), GM_OK);
    /* The mean sum is some 20 um. Without ramps in either of both it would be off by micrometres. */
    GM_ASSERT(errors.sum_rms < 0.02 * UM);
    GM_ASSERT(errors.sum_largest < 0.2 * UM);
    free(place);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(end_relief_of_spur_gears_is_a_triangle),
        GM_TEST(corner_takes_a_pyramid_off_the_mean),
        GM_TEST(ramps_of_both_gears_add_up_in_full_contact),
        GM_TEST(tables_that_hold_the_reliefs_exactly_give_the_same),
        GM_TEST(a_fine_table_of_a_corner_is_off_by_no_more_than_its_bound),
        GM_TEST(two_halves_are_a_whole),
        GM_TEST(order_does_not_matter),
        GM_TEST(ramps_that_take_nothing_off_change_nothing),
        GM_TEST(edges_along_the_lines_of_contact_are_none),
        GM_TEST(a_cache_has_one_pass_for_ramps_and_follows_them),
    };
    return gm_test_main("unit.ramp", tests, GM_TEST_COUNT(tests), argc, argv);
}
