/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The gap of a tip corner: published numbers, and the same corner turned about its axis and looked up on the mate's involute. */
#include "corner.h"
#include "gm_test.h"
#include "meshing.h"
#include "random_gears.h"
#include "reference_gear.h"

static const double degree = 0.017453292519943295;

/* ---------------------------------------------------------------------------------------------
 * Brute force, in the frame of conventions.md, drive side, and in long double
 * ------------------------------------------------------------------------------------------- */

typedef struct point {
    long double x, y;
} point;

/* Turn of an involute about the origin that brings it to P: arg P less inv of the pressure angle there, and plus its roll. */
static long double turn_to(point p, long double base) {
    const long double t = sqrtl((p.x * p.x + p.y * p.y) / (base * base) - 1.0L);
    return atan2l(p.y, p.x) - atanl(t) + t;
}

static point turned_about(point p, long double axis, long double angle) {
    const long double x = p.x - axis, c = cosl(angle), s = sinl(angle);
    const point result = {axis + c * x - s * p.y, s * x + c * p.y};
    return result;
}

/* On the drive line of action, rho_p from the pinion's base tangent point. */
static point on_line(const gm_pair *pair, const gmi_engagement *at, long double rho) {
    const long double a = at->working_pressure_angle, r = pair->pinion.base_radius;
    const point p = {r * cosl(a) + rho * sinl(a), -r * sinl(a) + rho * cosl(a)};
    return p;
}

/* As the mate sees it: about its own axis, and an external wheel turned by half a turn. */
static point seen(const gmi_engagement *at, int mate, point p) {
    if (mate == GM_PINION) {
        return p;
    }
    const long double d = at->center_distance, sign = d < 0.0L ? 1.0L : -1.0L;
    const point result = {sign * (p.x - d), sign * p.y};
    return result;
}

static long double gap_of(const gm_pair *pair, const gmi_engagement *at, int role, long double u) {
    const int mate = role == GM_PINION ? GM_WHEEL : GM_PINION;
    const long double rho = role == GM_PINION ? at->tip_roll_length[GM_PINION]
                                              : at->line_of_action - at->tip_roll_length[GM_WHEEL];
    const point end = on_line(pair, at, rho);

    /* The pinion goes on counter-clockwise; the wheel goes back, counter-clockwise, or clockwise if it is a ring. */
    const point corner = role == GM_PINION
                             ? turned_about(end, 0.0L, u / pair->pinion.base_radius)
                             : turned_about(end, at->center_distance, u / at->wheel_base_radius);
    const long double base = mate == GM_PINION ? pair->pinion.base_radius : at->wheel_base_radius;
    return u + base * (turn_to(seen(at, mate, corner), fabsl(base)) -
                       turn_to(seen(at, mate, end), fabsl(base)));
}

/* ---------------------------------------------------------------------------------------------
 * Tests
 * ------------------------------------------------------------------------------------------- */

static gm_pair_params spur_params(int pinion_teeth, int wheel_teeth, double module,
                                  double distance) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = pinion_teeth;
    params.wheel_teeth = wheel_teeth;
    params.normal_module = module;
    params.normal_pressure_angle = 20.0 * degree;
    params.center_distance = distance;
    params.face_width = 10.0 * module;
    return params;
}

/* Exact gaps in um at 0.02, 0.05, 0.1 and 0.2 base pitches before the path, and the error of kappa u^2 / 2. */
static void published_gaps_come_out(void) {
    gm_pair_params sets[3];
    sets[0] = spur_params(62, 62, 2e-3, 124e-3);
    sets[0].pinion_profile_shift = sets[0].wheel_profile_shift = 0.0;

    /* Stage 3 of the NREL 5 MW wind turbine, and the planet and ring of its stage 2. */
    sets[1] = spur_params(24, 95, 14e-3, 861e-3);
    sets[1].helix_angle = 10.0 * degree;
    sets[1].pinion_profile_shift = 0.4800;
    sets[1].wheel_profile_shift = 0.6691;
    sets[1].pinion_tip_radius = 0.5 * 380.747e-3;
    sets[1].wheel_tip_radius = 0.5 * 1395.376e-3;
    sets[2] = spur_params(36, -93, 21e-3, 584e-3);
    sets[2].pinion_profile_shift = 0.5039;
    sets[2].wheel_profile_shift = 0.1171;
    sets[2].pinion_tip_alteration = -1.751 / 21.0;

    static const double rolls[4] = {0.02, 0.05, 0.1, 0.2};
    static const double gaps[3][4] = {{0.145714, 0.918066, 3.721376, 15.279054},
                                      {2.064687, 13.091796, 53.608797, 224.210644},
                                      {0.371858, 2.347518, 9.548079, 39.485678}};
    static const double errors[2][4] = {{-0.54, -1.3, -2.6, -5.1}, {-0.97, -2.4, -4.7, -8.8}};

    /* The printed gaps, and how far the parabola with the curvature at the tip is off. */
    for (int set = 0; set < 3; ++set) {
        const gm_pair pair = make_pair(&sets[set]);
        gmi_engagement at;
        gmi_corner corner;
        GM_ASSERT_INT(gmi_engagement_find(&pair, NULL, &at), GM_OK);
        GM_ASSERT(gmi_corner_init(&pair, &at, GM_WHEEL, &corner));

        const double tip = at.tip_roll_length[GM_WHEEL], length = at.line_of_action;
        const double kappa =
            tip * length / (at.wheel_base_radius * at.wheel_base_radius * (length - tip));

        for (int k = 0; k < 4; ++k) {
            gm_test_context("set %d, %g base pitches", set, rolls[k]);
            const double u = rolls[k] * pair.transverse_base_pitch;
            gmi_corner_place place;
            gmi_corner_at(&corner, u, &place);
            GM_ASSERT_ABS(1e6 * place.gap, gaps[set][k], 1e-6);
            if (set < 2) {
                const double error = 100.0 * (0.5 * kappa * u * u / place.gap - 1.0);
                GM_ASSERT_ABS(error, errors[set][k], fabs(errors[set][k]) < 1.0 ? 0.006 : 0.06);
            }
        }

        /* At the end of the path there is no gap, and it begins with kappa. */
        gmi_corner_place end;
        gmi_corner_at(&corner, 0.0, &end);
        GM_ASSERT_ABS(end.gap, 0.0, 0.0);
        GM_ASSERT_ABS(end.by_roll, 0.0, 0.0);
        GM_ASSERT_REL(end.by_roll_twice, kappa, 1e-13);
        GM_ASSERT_REL(end.mate_roll, length - tip, 1e-15);
        GM_ASSERT_ABS(end.tip_arm, at.wheel_base_radius, 0.0);
    }
}

/* A random pair, a ring every third time, in a random pose. */
static int random_corner(uint64_t *seed, int i, gm_pair *pair, gmi_engagement *at) {
    random_case c;
    const int status =
        i % 3 == 2 ? random_ring_case_make(&c, seed, 0) : random_case_make(&c, seed, 0);
    *pair = c.pair;
    random_case_free(&c);
    if (status != GM_OK) {
        return 0;
    }
    const double most = 0.05 * pair->normal_module;
    const gm_pose pose = {gm_test_uniform(seed, -most, most), gm_test_uniform(seed, -most, most),
                          0.0, 0.0, 0.0};
    return gmi_engagement_find(pair, &pose, at) == GM_OK;
}

/* Gap, both derivatives, that by T, and where on the flank: of 400 corners at random places. */
static void gaps_are_those_of_turned_corners(void) {
    uint64_t seed = 20261;
    int met = 0, refused = 0;
    double largest_reach = 0.0;
    for (int i = 0; i < 300; ++i) {
        gm_pair pair;
        gmi_engagement at;
        if (!random_corner(&seed, i, &pair, &at)) {
            continue;
        }

        for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
            gm_test_context("case %d, role %d", i, role);
            gmi_corner corner;
            if (!gmi_corner_init(&pair, &at, role, &corner)) {
                ++refused;
                continue;
            }

            /* A place near the tip, or up to two base pitches away. */
            const double p = pair.transverse_base_pitch;
            const long double u =
                gm_test_uniform(&seed, 0.0, 1.0) * fmin(corner.reach, (i % 2 == 0 ? 0.1 : 2.0) * p);
            gmi_corner_place place;
            gmi_corner_at(&corner, (double)u, &place);
            ++met;
            largest_reach = fmax(largest_reach, corner.reach / p);

            /* The angle of the axes in `at` is a rounding off the line of action. */
            const long double gap = gap_of(&pair, &at, role, u);
            const double rounding = 1e-16 * fabs(at.center_distance);
            GM_ASSERT_NEAR(place.gap, (double)gap, 1e-9, 20.0 * rounding);
            GM_ASSERT(place.gap >= 0.0);
            const long double h = 1e-3L * u;
            const long double before = gap_of(&pair, &at, role, u - h);
            const long double after = gap_of(&pair, &at, role, u + h);
            GM_ASSERT_NEAR(place.by_roll, (double)((after - before) / (2.0L * h)), 2e-6, 1e-12);
            gmi_corner_place next, last;
            gmi_corner_at(&corner, (double)(u + h), &next);
            gmi_corner_at(&corner, (double)(u - h), &last);
            GM_ASSERT_NEAR(place.by_roll_twice, (next.by_roll - last.by_roll) / (2.0 * (double)h),
                           5e-6, 1e-9 / p);

            /* How far the normal has turned, and what the mate's roll length exceeds that of the line of action by. */
            const double half = sin(0.5 * place.turn);
            gmi_corner_place start;
            gmi_corner_at(&corner, 0.0, &start);
            GM_ASSERT_NEAR(place.versine, 2.0 * half * half, 1e-12, 1e-16);
            GM_ASSERT_NEAR(place.gain, place.mate_roll - start.mate_roll + (double)u, 1e-12,
                           1e-14 * fabs(at.line_of_action));
            GM_ASSERT_NEAR(place.versine_by_roll, (next.versine - last.versine) / (2.0 * (double)h),
                           5e-6, 1e-9 / p);
            GM_ASSERT_NEAR(place.gain_by_roll, (next.gain - last.gain) / (2.0 * (double)h), 5e-6,
                           1e-9);

            /* The arm of the tip is d overlap / d angle, overlap = roll of both less gap. */
            GM_ASSERT_REL(place.tip_arm, corner.tip_base * (1.0 - place.by_roll), 1e-15);
        }
    }
    GM_ASSERT(met > 400);
    GM_ASSERT(refused > 0);
    GM_ASSERT(largest_reach > 1.0);
}

/* Off the mate's flank where its tip circle is crossed: the corner is at that radius at the end of its reach. */
static void corners_reach_to_the_tip_of_the_mate(void) {
    uint64_t seed = 77;
    int met = 0;
    for (int i = 0; i < 100; ++i) {
        gm_pair pair;
        gmi_engagement at;
        gmi_corner corner;
        const int role = i % 2;
        if (!random_corner(&seed, i, &pair, &at) || !gmi_corner_init(&pair, &at, role, &corner)) {
            continue;
        }
        gm_test_context("case %d", i);
        gmi_corner_place place;
        gmi_corner_at(&corner, corner.reach, &place);
        if (corner.reach < fabs(corner.tip_base)) {
            const double tip = at.tip_roll_length[1 - role];
            GM_ASSERT_NEAR(fabs(place.mate_roll), fabs(tip), 1e-12, 1e-12);
            ++met;
        }
    }
    GM_ASSERT(met > 50);
}

/* The gap changes with T as that of gears further apart does. */
static void gap_follows_the_line_of_action(void) {
    uint64_t seed = 5;
    for (int i = 0; i < 60; ++i) {
        gm_pair pair;
        gmi_engagement at;
        gmi_corner corner, longer;
        const int role = i % 2;
        if (!random_corner(&seed, i, &pair, &at) || !gmi_corner_init(&pair, &at, role, &corner)) {
            continue;
        }
        gm_test_context("case %d", i);
        const double h = 1e-5 * pair.normal_module;
        gmi_engagement moved = at;
        gmi_corner_place place, before, after;
        const double u = gm_test_uniform(&seed, 0.0, fmin(corner.reach, 0.3 * pair.normal_module));
        gmi_corner_at(&corner, u, &place);
        moved.line_of_action = at.line_of_action + h;
        (void)gmi_corner_init(&pair, &moved, role, &longer);
        gmi_corner_at(&longer, u, &after);
        moved.line_of_action = at.line_of_action - h;
        (void)gmi_corner_init(&pair, &moved, role, &longer);
        gmi_corner_at(&longer, u, &before);
        GM_ASSERT_NEAR(place.by_length, (after.gap - before.gap) / (2.0 * h), 1e-5, 1e-10);
    }
}

/* The roll at which a gap is as large as an overlap is the one that the gap is of; beyond the reach it ends there. */
static void touch_is_where_the_gap_is_the_overlap(void) {
    uint64_t seed = 6;
    int met = 0, ended = 0;
    for (int i = 0; i < 200; ++i) {
        gm_pair pair;
        gmi_engagement at;
        gmi_corner corner;
        const int role = i % 2;
        if (!random_corner(&seed, i, &pair, &at) || !gmi_corner_init(&pair, &at, role, &corner)) {
            continue;
        }
        gm_test_context("case %d", i);

        /* In a ring far larger gaps than teeth bend by may shrink again: others may be as large there. */
        gmi_corner_place place, end;
        gmi_corner_at(&corner, corner.reach, &end);
        if (!(end.by_roll > 0.0)) {
            continue;
        }

        /* From next to nothing to all of the reach; a gap is known to some 1e-15 of the line of action. */
        const double u = corner.reach * pow(gm_test_uniform(&seed, 0.03, 1.0), 3.0);
        gmi_corner_at(&corner, u, &place);
        const double noise = 1e-14 * fabs(at.line_of_action) / place.by_roll;
        GM_ASSERT_NEAR(gmi_corner_touch(&corner, place.gap), u, 1e-9, noise);
        ++met;

        GM_ASSERT_REL(gmi_corner_touch(&corner, 1.01 * end.gap), corner.reach, 0.0);
        GM_ASSERT_REL(gmi_corner_touch(&corner, 0.0), 0.0, 0.0);
        GM_ASSERT_REL(gmi_corner_touch(&corner, -1e-6), 0.0, 0.0);
        ended += corner.reach < fabs(corner.tip_base);
    }
    GM_ASSERT(met > 100 && ended > 50);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(published_gaps_come_out),
        GM_TEST(gaps_are_those_of_turned_corners),
        GM_TEST(corners_reach_to_the_tip_of_the_mate),
        GM_TEST(gap_follows_the_line_of_action),
        GM_TEST(touch_is_where_the_gap_is_the_overlap),
    };
    return gm_test_main("unit.corner", tests, GM_TEST_COUNT(tests), argc, argv);
}
