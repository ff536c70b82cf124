/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Quasi-static equilibrium under a torque. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "random_gears.h"
#include "reference_gear.h"

static void equilibrium_inverts_the_sum(void) {
    uint64_t seed = UINT64_C(51);
    int solved = 0;
    for (int i = 0; i < 600; i++) {
        random_case c;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        GM_ASSERT_INT(random_case_make(&c, &seed, i % 4 != 0), GM_OK);
        const double r_bw = (double)c.model.base_radius[1];
        const double m_n = c.params.normal_module;
        const double stiffness = 1e8;
        const double sum = m_n * gm_test_uniform(&seed, 1e-4, 5e-3);
        const double torque = (i % 2 == 0 ? 1.0 : -1.0) * stiffness * r_bw * sum;
        double x = NAN;
        gm_penetration r;
        const int status = gm_static_equilibrium(&c.pair, c.use[0], c.use[1], c.pinion_angle,
                                                 stiffness, torque, &x, &r);
        /* Spur gears may jump across the torque: no exact solution then. All else has one. */
        const int helical = fabs((double)c.model.twist) > 0.05 * m_n;
        if (helical) {
            if (!GM_ASSERT_INT(status, GM_OK)) {
                random_case_free(&c);
                return;
            }
            gm_position position;
            gm_penetration there;
            GM_ASSERT_INT(gm_position_from_pinion_angle(&c.pair, c.pinion_angle, x, 0.0, &position),
                          GM_OK);
            GM_ASSERT_INT(gm_penetration_3d_at(&c.pair, c.use[0], c.use[1], &position, &there),
                          GM_OK);
            /* x is a double: it resolves the sum to contact length times its rounding. */
            const double resolution =
                1e-12 * sum + 8.0 * 0x1p-53 * c.params.center_distance *
                                  (1.0 + there.drive_contact + there.coast_contact);
            const int good =
                GM_ASSERT_ABS(there.penetration, torque / stiffness / r_bw, resolution) &&
                GM_ASSERT_ABS(r.penetration, there.penetration, resolution) &&
                GM_ASSERT(torque > 0.0 ? there.drive > 0.0 : there.coast > 0.0);
            solved++;
            if (!good) {
                random_case_free(&c);
                return;
            }
        } else {
            GM_ASSERT(status == GM_OK || status == GM_NO_EQUILIBRIUM);
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(solved > 300);
}

/* errata of the paper: b = 20 mm, K = 2.8e8 N/m, 20 N m (printed digits; 400 positions find the extremes
 * of a curve with kinks to their last digit) */
static void loaded_transmission_error_of_the_reference_gears(void) {
    static const struct {
        double pinion_tip, wheel_tip, mean, peak_to_peak;
    } racks[] = {{46.938390e-3, 43.003591e-3, -50.881e-6, 0.0197e-6},
                 {46.113390e-3, 42.178591e-3, -51.264e-6, 0.0411e-6}};
    for (int k = 0; k < 2; k++) {
        gm_test_context("rack %d", k);
        gm_pair_params params = reference_params(20e-3);
        params.pinion_tip_radius = racks[k].pinion_tip;
        params.wheel_tip_radius = racks[k].wheel_tip;
        const gm_pair pair = make_pair(&params);
        double sum = 0.0;
        double lowest = HUGE_VAL;
        double highest = -HUGE_VAL;
        enum { STEPS = 400 };
        for (int n = 0; n < STEPS; n++) {
            double x = NAN;
            GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL,
                                                pair.pinion.pitch_angle * n / STEPS, 2.8e8, 20.0,
                                                &x, NULL),
                          GM_OK);
            sum += -x;
            lowest = fmin(lowest, -x);
            highest = fmax(highest, -x);
        }
        GM_ASSERT_ABS(sum / STEPS, racks[k].mean, 0.5e-9);
        GM_ASSERT_ABS(highest - lowest, racks[k].peak_to_peak, 0.05e-9 + 0.05e-9);
    }
}

/* Spur gears drop a pair where its tip passes: the torque may be carried before and again after. What a mesh
 * reaches from the clearance on comes first. */
static void the_first_of_two_equilibria_counts(void) {
    const gm_pair pair = spur_pair();
    const double r_bp = pair.pinion.base_radius;
    const double target = 20e-6; /* sum of the penetrations (m) */
    const double torque = 1e8 * pair.wheel.base_radius * target;
    /* A drive pair ends at rho_p = T0 + delta - rho_w(tip): choose the phase so that it leaves at
     * delta = 0.75 target. Below it two pairs carry the torque at target / 2; above it one at target. */
    const double rho_p = pair.line_of_action + 0.75 * target - pair.wheel.tip_roll_length;
    double angle = (rho_p - pair.phase_origin) / r_bp;
    GM_ASSERT_INT(at(&pair, NULL, NULL, angle, pair.backlash / 2 + 0.74 * target).drive_pairs, 2);
    GM_ASSERT_INT(at(&pair, NULL, NULL, angle, pair.backlash / 2 + 0.76 * target).drive_pairs, 1);
    double x = NAN;
    gm_penetration r;
    GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL, angle, 1e8, torque, &x, &r), GM_OK);
    GM_ASSERT_ABS(x, pair.backlash / 2 + target / 2, length_rounding(&pair));
    GM_ASSERT_INT(r.drive_pairs, 2);
    /* A little more torque than two pairs reach before one leaves: the second branch it is. */
    const double more = 1.6 * torque;
    GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL, angle, 1e8, more, &x, &r), GM_OK);
    GM_ASSERT_ABS(x, pair.backlash / 2 + 1.6 * target, length_rounding(&pair));
    GM_ASSERT_INT(r.drive_pairs, 1);
}

/* Whatever it answers with GM_OK carries the torque, spur gears included. */
static void every_equilibrium_found_carries_the_torque(void) {
    uint64_t seed = UINT64_C(52);
    int found = 0;
    for (int i = 0; i < 1500; i++) {
        random_case c;
        GM_ASSERT_INT(random_case_make(&c, &seed, i % 2), GM_OK);
        gm_test_context("case %d, helix %g", i, c.params.helix_angle);
        const double r_bw = (double)c.model.base_radius[1];
        const double target = c.params.normal_module * gm_test_uniform(&seed, -1e-2, 1e-2);
        double x = NAN;
        gm_penetration r;
        int good = 1;
        if (gm_static_equilibrium(&c.pair, c.use[0], c.use[1], c.pinion_angle, 1e8,
                                  1e8 * r_bw * target, &x, &r) == GM_OK) {
            const gm_penetration there = at(&c.pair, c.use[0], c.use[1], c.pinion_angle, x);
            /* x is a double: steps of its rounding times the contact length, and of almost spur
             * lines times delta / twist. */
            const double e = 8.0 * 0x1p-53 * c.params.center_distance;
            const double twist = fabs((double)c.model.twist);
            const double steep =
                twist > 0.0 ? fmin(1.0, e / twist) * (fabs(target) + c.amplitude) : 0.0;
            const double tolerance = 1e-12 * fabs(target) + 10.0 * steep +
                                     e * (1.0 + there.drive_contact + there.coast_contact);
            /* A spur pair's sum may step over the torque where a pair enters: x is that place. */
            const gm_penetration before = at(&c.pair, c.use[0], c.use[1], c.pinion_angle, x - e);
            const gm_penetration behind = at(&c.pair, c.use[0], c.use[1], c.pinion_angle, x + e);
            const int steps_over = twist == 0.0 && before.penetration < target - tolerance &&
                                   behind.penetration > target + tolerance;
            good = steps_over || GM_ASSERT_ABS(there.penetration, target, tolerance);
            found++;
        }
        random_case_free(&c);
        if (!good) {
            return;
        }
    }
    gm_test_context("all cases");
    GM_ASSERT(found > 1200);
}

static void the_least_torque_is_carried_at_the_clearance(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    static const double torques[] = {1e-9, -1e-9, 1e-20, -1e-100, 1e-280};
    for (size_t i = 0; i < sizeof torques / sizeof torques[0]; i++) {
        gm_test_context("torque %g", torques[i]);
        double x = NAN;
        GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL, 0.1, 1e8, torques[i], &x, NULL),
                      GM_OK);
        GM_ASSERT_ABS(fabs(x), pair.backlash / 2, 1e-15);
        GM_ASSERT((x > 0.0) == (torques[i] > 0.0));
    }
}

/* One thick tooth jams between its neighbours; all other positions are open. */
static void a_thick_tooth_holds_without_torque_where_it_meshes(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_flanks_params sizes = {45, 0, 0, 0, 0, 0, 0};
    double memory[256];
    gm_flanks flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(&flanks, GM_DRIVE, 0, 60e-6), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(&flanks, GM_COAST, 0, 60e-6), GM_OK);
    double x = NAN;
    gm_penetration r;
    GM_ASSERT_INT(gm_static_equilibrium(&pair, &flanks, NULL, 3.0, 1e8, 0.0, &x, &r),
                  GM_UNDETERMINED);
    GM_ASSERT_NAN(x);
    GM_ASSERT_NAN(r.penetration);
    GM_ASSERT_INT(gm_static_equilibrium(&pair, &flanks, NULL, -0.1, 1e8, 0.0, &x, &r), GM_OK);
    GM_ASSERT(r.drive > 0.0 && r.coast > 0.0);
    GM_ASSERT_ABS(r.penetration, 0.0, 1e-15);
}

static void no_torque_leaves_the_position_open(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    double x = 0.0;
    gm_penetration r;
    GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL, 0.1, 1e8, 0.0, &x, &r), GM_UNDETERMINED);
    GM_ASSERT_NAN(x);
    GM_ASSERT_NAN(r.penetration);
    GM_ASSERT_NAN(r.d_wheel_angle);
    GM_ASSERT_INT(r.drive_pairs, 0);
    /* Without a result asked for. */
    GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL, 0.1, 1e8, 0.0, &x, NULL),
                  GM_UNDETERMINED);
}

static void negative_backlash_has_an_equilibrium_without_torque(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.backlash = -10e-6;
    const gm_pair pair = make_pair(&params);
    double x = NAN;
    gm_penetration r;
    const int status = gm_static_equilibrium(&pair, NULL, NULL, 0.1, 1e8, 0.0, &x, &r);
    GM_ASSERT_INT(status, GM_OK);
    GM_ASSERT_ABS(r.penetration, 0.0, 1e-15);
    GM_ASSERT(r.drive > 0.0 && r.coast > 0.0);
    GM_ASSERT(fabs(x) < 5e-6);
}

static void too_much_torque_has_no_equilibrium(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    for (int s = -1; s <= 1; s += 2) {
        gm_test_context("sign %d", s);
        double x = 0.0;
        gm_penetration r;
        /* p_bt / 2 of three pairs on 1e8 N/m carries less than 1e6 N, 4e4 N m. */
        GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL, 0.1, 1e8, s * 1e5, &x, &r),
                      GM_NO_EQUILIBRIUM);
        GM_ASSERT_NAN(x);
        GM_ASSERT_NAN(r.penetration);
    }
}

static void equilibrium_refuses_what_it_must(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    double x = 0.0;
    gm_penetration r;
    GM_ASSERT_INT(gm_static_equilibrium(NULL, NULL, NULL, 0.1, 1e8, 1.0, &x, &r), GM_ERR_NULL);
    GM_ASSERT_NAN(x);
    GM_ASSERT_NAN(r.penetration);
    r.penetration = 0.0;
    GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL, 0.1, 1e8, 1.0, NULL, &r), GM_ERR_NULL);
    GM_ASSERT_NAN(r.penetration);
    static const double bad_stiffness[] = {0.0, -1.0, NAN, HUGE_VAL};
    for (size_t k = 0; k < sizeof bad_stiffness / sizeof bad_stiffness[0]; k++) {
        gm_test_context("stiffness %g", bad_stiffness[k]);
        x = 0.0;
        r.penetration = 0.0;
        GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL, 0.1, bad_stiffness[k], 1.0, &x, &r),
                      GM_ERR_PARAMETER);
        GM_ASSERT_NAN(x);
        GM_ASSERT_NAN(r.penetration);
    }
    static const double bad_number[] = {NAN, HUGE_VAL, -HUGE_VAL};
    for (size_t k = 0; k < sizeof bad_number / sizeof bad_number[0]; k++) {
        gm_test_context("number %g", bad_number[k]);
        GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL, bad_number[k], 1e8, 1.0, &x, &r),
                      GM_STATE_NOT_FINITE);
        GM_ASSERT_NAN(x);
        GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL, 0.1, 1e8, bad_number[k], &x, &r),
                      GM_ERR_PARAMETER);
        GM_ASSERT_NAN(x);
    }
    GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, NULL, 2e9, 1e8, 1.0, &x, &r),
                  GM_STATE_OUT_OF_RANGE);
    GM_ASSERT_NAN(x);
    /* Flanks of another gear, on either side. */
    const gm_flanks_params sizes = {44, 0, 0, 0, 0, 0, 0};
    double memory[256];
    gm_flanks flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);
    GM_ASSERT_INT(gm_static_equilibrium(&pair, &flanks, NULL, 0.1, 1e8, 1.0, &x, &r), GM_ERR_TOOTH);
    GM_ASSERT_NAN(x);
    GM_ASSERT_INT(gm_static_equilibrium(&pair, NULL, &flanks, 0.1, 1e8, 1.0, &x, &r), GM_ERR_TOOTH);
    GM_ASSERT_NAN(r.penetration);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(equilibrium_inverts_the_sum),
        GM_TEST(loaded_transmission_error_of_the_reference_gears),
        GM_TEST(the_first_of_two_equilibria_counts),
        GM_TEST(every_equilibrium_found_carries_the_torque),
        GM_TEST(the_least_torque_is_carried_at_the_clearance),
        GM_TEST(a_thick_tooth_holds_without_torque_where_it_meshes),
        GM_TEST(no_torque_leaves_the_position_open),
        GM_TEST(negative_backlash_has_an_equilibrium_without_torque),
        GM_TEST(too_much_torque_has_no_equilibrium),
        GM_TEST(equilibrium_refuses_what_it_must),
    };
    return gm_test_main("unit.equilibrium", tests, GM_TEST_COUNT(tests), argc, argv);
}
