/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Two gears at another centre distance than that of their drawing. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "meshing.h"
#include "random_gears.h"
#include "reference_gear.h"

enum { PAIRS = 2000 };

/** Every number of a meshing, and of a drawing in the same order. */
enum { NUMBERS = 16 };

static void list(const gmi_meshing *m, double out[NUMBERS]) {
    const double values[NUMBERS] = {m->center_distance,
                                    m->line_of_action,
                                    m->working_pressure_angle,
                                    m->involute_difference,
                                    m->backlash,
                                    m->path_start,
                                    m->path_end,
                                    m->transverse_contact_ratio,
                                    m->phase_origin[GM_DRIVE],
                                    m->phase_origin[GM_COAST],
                                    m->working_pitch_radius[GM_PINION],
                                    m->working_pitch_radius[GM_WHEEL],
                                    m->tip_clearance[GM_PINION],
                                    m->tip_clearance[GM_WHEEL],
                                    m->start_roll_length[GM_PINION],
                                    m->start_roll_length[GM_WHEEL]};
    memcpy(out, values, sizeof values);
}

static void list_drawing(const gm_pair *p, double out[NUMBERS]) {
    const double values[NUMBERS] = {p->center_distance,
                                    p->line_of_action,
                                    p->working_pressure_angle,
                                    p->involute_difference,
                                    p->backlash,
                                    p->path_start,
                                    p->path_end,
                                    p->transverse_contact_ratio,
                                    p->phase_origin[GM_DRIVE],
                                    p->phase_origin[GM_COAST],
                                    p->pinion_working_pitch_radius,
                                    p->wheel_working_pitch_radius,
                                    p->pinion_tip_clearance,
                                    p->wheel_tip_clearance,
                                    p->pinion.start_roll_length,
                                    p->wheel.start_roll_length};
    memcpy(out, values, sizeof values);
}

static void at_its_own_distance_the_drawing_comes_back_to_the_last_bit(void) {
    uint64_t seed = 77;
    for (int i = 0; i < PAIRS; ++i) {
        gm_test_context("pair %d", i);
        gm_pair_params params;
        model_pair model;
        random_params(&seed, &params, &model);
        const gm_pair pair = make_pair(&params);
        gmi_meshing meshing;
        GM_ASSERT_INT(gmi_meshing_find(&pair, params.center_distance, &meshing), 1);
        double got[NUMBERS], expected[NUMBERS];
        list(&meshing, got);
        list_drawing(&pair, expected);
        GM_ASSERT(memcmp(got, expected, sizeof got) == 0);
    }
}

/** The same gears drawn for another distance: all that belongs to one gear is given. */
static gm_pair_params drawn_at(const gm_pair *pair, const gm_pair_params *params, double distance) {
    gm_pair_params other = *params;
    other.center_distance = distance;
    other.backlash = NAN;
    other.pinion_profile_shift = pair->pinion.profile_shift;
    other.wheel_profile_shift = pair->wheel.profile_shift;
    other.pinion_normal_thickness = pair->pinion.normal_thickness;
    other.wheel_normal_thickness = pair->wheel.normal_thickness;
    other.pinion_tip_radius = pair->pinion.tip_radius;
    other.wheel_tip_radius = pair->wheel.tip_radius;
    return other;
}

static void at_another_distance_it_is_the_pair_drawn_there(void) {
    uint64_t seed = 78;
    int meshed = 0;
    for (int i = 0; i < PAIRS; ++i) {
        gm_test_context("pair %d", i);
        gm_pair_params params;
        model_pair model;
        random_params(&seed, &params, &model);
        const gm_pair pair = make_pair(&params);

        /* The pair at another distance, and a drawing of it there. */
        const double distance =
            params.center_distance + params.normal_module * gm_test_uniform(&seed, -0.3, 0.3);
        const gm_pair_params there = drawn_at(&pair, &params, distance);
        gm_pair expected;
        gmi_meshing meshing;

        const int status = gm_pair_init(&expected, &there);
        const int meshes = gmi_meshing_find(&pair, distance, &meshing);
        if (status != GM_OK || !meshes) {
            continue; /* at the border of what meshes the roundings decide */
        }
        ++meshed;

        /* Lengths are differences of lengths up to d; next to touching base circles T and the angle lose half. */
        const double base_sum = pair.pinion.base_radius + pair.wheel.base_radius;
        const double loss = distance / (distance - base_sum);
        const double rounding = 8.0 * 0x1p-53 * distance * (1.0 + loss);
        double got[NUMBERS], drawn[NUMBERS];
        list(&meshing, got);
        list_drawing(&expected, drawn);
        for (int k = 0; k < NUMBERS; ++k) {
            gm_test_context("pair %d, number %d", i, k);
            const int is_ratio = k == 2 || k == 3 || k == 7;
            const double unit = k == 7 ? pair.transverse_base_pitch : distance;
            GM_ASSERT_ABS(got[k], drawn[k], is_ratio ? rounding / unit : rounding);
        }
    }
    GM_ASSERT(meshed > PAIRS / 2);
}

static void spreading_the_axes_opens_the_backlash(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    gmi_meshing meshing;
    /* d j / d d = 2 sin(alpha_wt): 40 um and sin(19.65262 deg), the next order is 0.1 um * 0.04 / 85. */
    GM_ASSERT_INT(gmi_meshing_find(&pair, 85.04e-3, &meshing), 1);
    GM_ASSERT_ABS(meshing.backlash, 100e-6 + 2.0 * 40e-6 * sin(19.65262 * 0.017453292519943295),
                  0.05e-6);
    GM_ASSERT_ABS(meshing.tip_clearance[GM_PINION] - pair.pinion_tip_clearance, 40e-6, 1e-16);
    GM_ASSERT_ABS(meshing.tip_clearance[GM_WHEEL] - pair.wheel_tip_clearance, 40e-6, 1e-16);
}

static void a_given_start_stays_and_a_derived_one_follows_the_mates_tip(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_start_radius = 43.0e-3;
    const gm_pair pair = make_pair(&params);
    GM_ASSERT_INT(pair.pinion.start_is_given, 1);
    GM_ASSERT_INT(pair.wheel.start_is_given, 0);
    gmi_meshing meshing;
    GM_ASSERT_INT(gmi_meshing_find(&pair, 85.1e-3, &meshing), 1);
    GM_ASSERT_REL(meshing.start_roll_length[GM_PINION], pair.pinion.start_roll_length, 0.0);
    GM_ASSERT_REL(meshing.start_roll_length[GM_WHEEL],
                  meshing.line_of_action - pair.pinion.tip_roll_length, 0.0);
    GM_ASSERT(meshing.line_of_action > pair.line_of_action);
    /* Where the mate's tip does not reach the given start, it limits the path. */
    GM_ASSERT_REL(
        meshing.path_start,
        fmax(pair.pinion.start_roll_length, meshing.line_of_action - pair.wheel.tip_roll_length),
        0.0);
    GM_ASSERT_REL(meshing.path_end, pair.pinion.tip_roll_length, 1e-14);
}

static void distances_at_which_nothing_meshes_are_told(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double base_sum = pair.pinion.base_radius + pair.wheel.base_radius;
    gmi_meshing meshing;
    GM_ASSERT_INT(gmi_meshing_find(&pair, base_sum, &meshing), 0);
    GM_ASSERT_INT(gmi_meshing_find(&pair, 0.0, &meshing), 0);
    GM_ASSERT_INT(gmi_meshing_find(&pair, NAN, &meshing), 0);
    /* Tips that just miss each other: r_ap + r_aw = 89.942 mm; on the line of action they do so a little earlier. */
    GM_ASSERT_INT(gmi_meshing_find(&pair, 89.95e-3, &meshing), 0);
    GM_ASSERT_INT(gmi_meshing_find(&pair, 88.0e-3, &meshing), 1);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(at_its_own_distance_the_drawing_comes_back_to_the_last_bit),
        GM_TEST(at_another_distance_it_is_the_pair_drawn_there),
        GM_TEST(spreading_the_axes_opens_the_backlash),
        GM_TEST(a_given_start_stays_and_a_derived_one_follows_the_mates_tip),
        GM_TEST(distances_at_which_nothing_meshes_are_told),
    };
    return gm_test_main("unit.meshing", tests, GM_TEST_COUNT(tests), argc, argv);
}
