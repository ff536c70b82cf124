/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The library against the second model (reference_model.h) on thousands of random gears, flanks and states:
 * both hands, spur, almost spur, wide faces, coarse and fine tables, one per tooth, pitch, both sides, negative
 * backlash, angles up to 1e6 rad, profiles that start on the base circle, modules from microns to metres.
 *
 * How close is close: the library works in double precision, so its result has to be the exact result of a
 * gear whose lengths differ by a few roundings of its largest length. All results grow with the approach of
 * the flanks and with the width of the active profile; so evaluations with these lengths e smaller and e larger
 * enclose what may come out, at jumps and grazing contacts too. Nothing else is allowed but 1e-12 relative.
 */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "random_gears.h"

#define CASES 6000

/** Number of failed cases that are printed. */
#define PRINTED 5

/* One rounding of the longest length of a pair: the center distance, or the radius of a ring. */
static double rounding(const gm_pair_params *params, const model_pair *model) {
    return 0x1p-53 *
           (model->is_ring ? (double)model->reference_radius[1] : params->center_distance);
}

static int inside(double got, long double low, long double high, double relative, double absolute,
                  const char *what) {
    const int good = got >= (double)low * (1.0 - relative) - absolute &&
                     got <= (double)high * (1.0 + relative) + absolute;
    return gm_test_report(good, __FILE__, __LINE__, "%s: got %.17g, expected %.17g .. %.17g", what,
                          got, (double)low, (double)high);
}

static int compare(const random_case *c, const gm_penetration *got) {
    /* The limits of a line of contact and delta are each the sum of three or four lengths below d.
     * Angles are exact inputs and are reduced without loss: their size does not matter. */
    const double e = 4.0 * rounding(&c->params, &c->model);
    model_result low;
    model_result high;
    model_evaluate(&c->model, c->model_use[0], c->model_use[1], c->pinion_angle, c->wheel_angle, -e,
                   -e, &low);
    model_evaluate(&c->model, c->model_use[0], c->model_use[1], c->pinion_angle, c->wheel_angle, e,
                   e, &high);
    const double sum[2] = {got->drive, got->coast};
    const double contact[2] = {got->drive_contact, got->coast_contact};
    const int pairs[2] = {got->drive_pairs, got->coast_pairs};
    int good = 1;
    for (int side = 0; side < 2; ++side) {
        const char *const names[2][3] = {{"drive", "drive_contact", "drive_pairs"},
                                         {"coast", "coast_contact", "coast_pairs"}};
        good &= inside(sum[side], low.sum[side], high.sum[side], 1e-12, 0.0, names[side][0]);
        good &= inside(contact[side], low.contact[side], high.contact[side], 1e-12, 1e-14,
                       names[side][1]);
        good &= inside(pairs[side], low.pairs[side], high.pairs[side], 0.0, 0.0, names[side][2]);
    }
    /* Plain sums of two numbers that were just tested: one rounding. */
    good &= GM_ASSERT_NEAR(got->penetration, sum[0] - sum[1], 0x1p-52, 0.0);
    return good;
}

typedef int case_maker(random_case *c, uint64_t *seed, int with_flanks);

static void run(case_maker *make, int cases, uint64_t seed, int with_flanks) {
    int failed = 0;
    int touching = 0;
    int jumps = 0;
    for (int i = 0; i < cases && failed < PRINTED; ++i) {
        random_case c;
        const uint64_t first = seed;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)first);
        if (!GM_ASSERT_INT(make(&c, &seed, with_flanks), GM_OK)) {
            ++failed;
        } else {
            gm_test_context("case %d, seed %llx, z %d/%d, helix %.3g, x %.3g p_bt, angle %.3g", i,
                            (unsigned long long)first, c.params.pinion_teeth, c.params.wheel_teeth,
                            c.params.helix_angle,
                            (double)((c.model.base_radius[0] * c.pinion_angle -
                                      c.model.base_radius[1] * c.wheel_angle) /
                                     c.model.base_pitch),
                            c.pinion_angle);
            const gm_state state = {.pinion_angle = c.pinion_angle, .wheel_angle = c.wheel_angle};
            gm_penetration got;
            const int good =
                GM_ASSERT_INT(gm_penetration_3d(&c.pair, c.use[0], c.use[1], &state, &got), GM_OK);
            failed += !(good && compare(&c, &got));
            touching += got.drive_pairs + got.coast_pairs > 0;
            jumps += got.drive_pairs > 0 && got.coast_pairs > 0;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    printf("%d of %d touch, %d on both sides ", touching, cases, jumps);
    GM_ASSERT(touching > cases / 2); /* else the sweep would prove little */
    GM_ASSERT(jumps > cases / 100);
}

static void ideal_flanks_agree_with_the_second_model(void) {
    run(random_case_make, CASES / 2, UINT64_C(20260101), 0);
}

static void real_flanks_agree_with_the_second_model(void) {
    run(random_case_make, CASES / 2, UINT64_C(20260102), 1);
}

static void rings_agree_with_the_second_model(void) {
    run(random_ring_case_make, CASES / 6, UINT64_C(20260104), 0);
    run(random_ring_case_make, CASES / 4, UINT64_C(20260105), 1);
}

static void derived_geometry_agrees_with_the_second_model(void) {
    uint64_t seed = UINT64_C(20260103);
    for (int i = 0; i < CASES; ++i) {
        gm_pair_params params;
        model_pair model;
        gm_pair pair;
        if (i % 5 == 0) {
            random_ring_params(&seed, &params, &model);
        } else {
            random_params(&seed, &params, &model);
        }
        gm_test_context("case %d, z %d/%d, helix %.3g", i, params.pinion_teeth, params.wheel_teeth,
                        params.helix_angle);
        int good = GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);
        /* A dozen operations. */
        const double e = 12.0 * rounding(&params, &model);
        good &= GM_ASSERT_ABS(pair.backlash, (double)model.backlash, e);
        /* The line of action is the root of (d - r_bp - r_bw)(d + r_bp + r_bw): shorter than d, it loses by
         * the ratio of both. The path is what two tips leave of it. */
        const double magnified = e * params.center_distance / (double)model.line_of_action;
        good &= GM_ASSERT_ABS(pair.line_of_action, (double)model.line_of_action, magnified);
        good &= GM_ASSERT_ABS(pair.path_end - pair.path_start, (double)model_path_length(&model),
                              magnified);
        /* Roll lengths are square roots of differences of squares: where they are short they lose
         * by the ratio of radius and roll length. Below the base circle they are exactly 0. */
        const gm_gear *const gears[2] = {&pair.pinion, &pair.wheel};
        for (int g = 0; g < 2; ++g) {
            const double r_b = (double)model.base_radius[g];
            good &= GM_ASSERT_ABS(gears[g]->base_radius, r_b, e);
            good &= GM_ASSERT_ABS(gears[g]->tip_radius, (double)model.tip_radius[g], e);
            good &= GM_ASSERT_ABS(gears[g]->start_radius, (double)model.start_radius[g], e);
            const double rho = (double)model.rho_start[g];
            const double allowed = rho > 0.0 ? e + e * r_b / rho : 0.0;
            good &= GM_ASSERT_ABS(gears[g]->start_roll_length, rho, allowed);
            good &=
                GM_ASSERT_ABS(gears[g]->base_half_thickness * r_b, (double)model.psi[g] * r_b, e);
        }
        if (!good) {
            break;
        }
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(derived_geometry_agrees_with_the_second_model),
        GM_TEST(ideal_flanks_agree_with_the_second_model),
        GM_TEST(real_flanks_agree_with_the_second_model),
        GM_TEST(rings_agree_with_the_second_model),
    };
    return gm_test_main("reference.sweep", tests, GM_TEST_COUNT(tests), argc, argv);
}
