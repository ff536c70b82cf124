/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Tip edges of elastic teeth beyond the path of contact: what they add at a point. Whole meshes: test_elastic_mesh.c. */
#include "elastic_mesh.h"
#include "gm_test.h"
#include "meshing.h"

#include <math.h>

static const double degree = 0.017453292519943295;

static gm_pair make_pair(int kind) {
    gm_pair_params p;
    gm_pair_params_default(&p);
    p.pinion_teeth = kind == 0 ? 62 : 24;
    p.wheel_teeth = kind == 0 ? 62 : 95;
    p.normal_module = kind == 0 ? 2e-3 : 14e-3;
    p.normal_pressure_angle = 20.0 * degree;
    p.helix_angle = kind == 0 ? 0.0 : 10.0 * degree;
    p.face_width = kind == 0 ? 20e-3 : 360e-3;
    p.center_distance = kind == 0 ? 124e-3 : 861.0001467e-3;
    p.pinion_profile_shift = kind == 0 ? 0.0 : 0.48;
    p.wheel_profile_shift = kind == 0 ? 0.0 : 0.6691;
    gm_pair pair;
    GM_ASSERT_INT(gm_pair_init(&pair, &p), GM_OK);
    return pair;
}

static void make_tips(const gm_pair *pair, double rounding, gmi_elastic_tips *tips) {
    gmi_engagement at;
    GM_ASSERT_INT(gmi_engagement_find(pair, NULL, &at), GM_OK);
    GM_ASSERT_INT(gmi_elastic_tips_init(pair, &at, rounding, tips), 1);
}

/* Turn of an involute with the base circle r_b from where it begins on the axis x to where it goes through a point. */
static double turn_to(double x, double y, double r_b) {
    const double r = hypot(x, y);
    const double roll = sqrt((r - r_b) * (r + r_b)) / r_b;
    return atan2(y, x) + roll - atan(roll);
}

/*
 * Gap along the line of action, from turning the gears in the plane: the mate about the origin, the other gear about (a, 0).
 * From where its tip corner is at the end of the path it is turned back by `roll`, the mate by `mate_roll`.
 */
static double turned_gap(const gm_pair *pair, int role, double roll, double mate_roll) {
    const gm_gear *gear = role == GM_PINION ? &pair->pinion : &pair->wheel;
    const gm_gear *mate = role == GM_PINION ? &pair->wheel : &pair->pinion;
    const double a = pair->center_distance, r_bm = mate->base_radius, r_bg = gear->base_radius;
    const double alpha = acos((r_bm + r_bg) / a);
    const double start =
        a * sin(alpha) - sqrt((gear->tip_radius - r_bg) * (gear->tip_radius + r_bg));
    const double x0 = r_bm * cos(alpha) + start * sin(alpha);
    const double y0 = start * cos(alpha) - r_bm * sin(alpha);

    const double turn = roll / r_bg;
    const double x = a + (x0 - a) * cos(turn) - y0 * sin(turn);
    const double y = (x0 - a) * sin(turn) + y0 * cos(turn);
    return r_bm * (turn_to(x, y, r_bm) - turn_to(x0, y0, r_bm)) + mate_roll;
}

/* Also within the path, where the wheel is already beyond its tip because it gives way by x. */
static void gaps_are_those_of_turned_gears(void) {
    for (int kind = 0; kind < 2; ++kind) {
        const gm_pair pair = make_pair(kind);
        gmi_elastic_tips tips;
        make_tips(&pair, 0.05, &tips);
        const double begin = pair.path_start, end = pair.path_end;
        const double pitch = pair.transverse_base_pitch, x = 2e-3 * pitch;
        for (int n = 0; n < 30; ++n) {
            gm_test_context("kind %d, %d", kind, n);
            const double beyond = (0.01 * n - 1.5e-3) * pitch;

            /* The pinion is so far before the begin of the path, and the wheel has x more to roll. */
            const double outside = beyond > 0.0 ? beyond : 0.0;
            const gmi_elastic_edge entry =
                gmi_elastic_edge_at(&tips, x, begin, end, begin + outside - beyond, -outside);
            GM_ASSERT_INT(entry.enters, 1);
            GM_ASSERT_ABS(entry.gap.value - x, turned_gap(&pair, GM_WHEEL, beyond + x, beyond),
                          1e-13);

            /* The pinion is beyond the end, and the wheel stands back by x. */
            if (beyond > 0.0) {
                const gmi_elastic_edge leaving =
                    gmi_elastic_edge_at(&tips, x, begin, end, end, beyond);
                GM_ASSERT_INT(leaving.enters, 0);
                GM_ASSERT_ABS(leaving.gap.value - x,
                              turned_gap(&pair, GM_PINION, beyond, beyond - x), 1e-13);
            }
        }
    }
}

/* All slopes, from the path over the rounding to the last that is followed and beyond. */
static void slopes_are_those_of_differences(void) {
    const gm_pair pair = make_pair(0);
    gmi_elastic_tips tips;
    make_tips(&pair, 0.05, &tips);
    const double begin = pair.path_start, end = pair.path_end, x = 5e-6, step = 1e-8;
    for (int n = 0; n < 200; ++n) {
        for (int side = 0; side < 2; ++side) {
            gm_test_context("%d, side %d", n, side);
            const double sign = side == 0 ? -1.0 : 1.0;
            const double beyond = 2e-6 + 20e-6 * n;
            const double path = side == 0 ? begin : end;
            gmi_elastic_edge e[3];
            for (int k = 0; k < 3; ++k) {
                e[k] = gmi_elastic_edge_at(&tips, x, begin, end, path,
                                           sign * (beyond + (k - 1) * step));
            }

            /* The gap by the roll of the tip, ln of the rate along rho_p. */
            GM_ASSERT_ABS((e[2].gap.value - e[0].gap.value) / (2.0 * step), e[1].gap.by_roll, 1e-7);
            GM_ASSERT_ABS((e[2].gap.by_roll - e[0].gap.by_roll) / (2.0 * step),
                          e[1].gap.by_roll_twice, 1e-4 * tips.tip[GM_PINION].curvature);
            GM_ASSERT_ABS(sign * log(e[2].rate_factor / e[0].rate_factor) / (2.0 * step),
                          e[1].rate_by_roll, 1e-4 * fabs(e[1].rate_by_roll) + 1e-3);
        }
    }
}

/* Curvatures add: of both flanks where the path ends, of the mate's flank and the rounding in the end. */
static void rounding_takes_the_place_of_the_flank(void) {
    const gm_pair pair = make_pair(1);
    for (int n = 1; n <= 4; ++n) {
        gmi_elastic_tips tips;
        make_tips(&pair, 0.03 * n, &tips);
        const double cosine = cos(pair.base_helix_angle);
        const double edge = 0.03 * n * pair.normal_module * cosine;
        for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
            const gm_gear *gear = role == GM_PINION ? &pair.pinion : &pair.wheel;
            const double tip = gear->tip_roll_length, mate = pair.line_of_action - tip;
            const double sign = role == GM_PINION ? 1.0 : -1.0;
            const double path = role == GM_PINION ? pair.path_end : pair.path_start;
            const gmi_elastic_edge at =
                gmi_elastic_edge_at(&tips, 0.0, pair.path_start, pair.path_end, path, sign * 1e-12);
            const gmi_elastic_edge off =
                gmi_elastic_edge_at(&tips, 0.0, pair.path_start, pair.path_end, path,
                                    sign * 0.2 * pair.transverse_base_pitch);
            GM_ASSERT_ABS(at.rate_factor, 1.0, 1e-9);
            GM_ASSERT_REL(off.rate_factor, (1.0 / mate + 1.0 / tip) / (1.0 / mate + 1.0 / edge),
                          1e-12);
        }
    }
}

/* Lines are followed as far as edges can reach: more load, farther; there the gap is no less than what it has to be. */
static void lines_go_on_until_nothing_reaches(void) {
    for (int kind = 0; kind < 2; ++kind) {
        const gm_pair pair = make_pair(kind);
        gmi_elastic_tips tips;
        make_tips(&pair, 0.05, &tips);
        double last = 0.0;
        for (int n = 1; n <= 8; ++n) {
            const double x = 1e-4 * n * pair.normal_module, peak = 2e-6;
            const double below = gmi_elastic_tips_below(&tips, x, peak);
            const double above = gmi_elastic_tips_above(&tips, x, peak);
            const double begin = pair.path_start, end = pair.path_end;
            GM_ASSERT(above > last);
            GM_ASSERT(gmi_elastic_edge_at(&tips, x, begin, end, begin, -below).gap.value >=
                      x + peak);
            GM_ASSERT(gmi_elastic_edge_at(&tips, x, begin, end, end, above).gap.value >= x + peak);
            last = above;
        }
        GM_ASSERT(gmi_elastic_tips_above(&tips, 1.0, 0.0) <= 0.5 * pair.transverse_base_pitch);
        GM_ASSERT(gmi_elastic_tips_above(&tips, -1.0, 0.0) == 0.0);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(gaps_are_those_of_turned_gears),
        GM_TEST(slopes_are_those_of_differences),
        GM_TEST(rounding_takes_the_place_of_the_flank),
        GM_TEST(lines_go_on_until_nothing_reaches),
    };
    return gm_test_main("unit.elastic_corner", tests, GM_TEST_COUNT(tests), argc, argv);
}
