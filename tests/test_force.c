/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Force law, and the simple model. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "reference_gear.h"

static void force_is_stiffness_and_damping_of_each_flank(void) {
    /* Chosen by hand: sums of powers of two, so that every product is exact. */
    gm_penetration p;
    memset(&p, 0, sizeof p);
    p.drive = 4.0;
    p.drive_rate = 0.5;
    p.coast = 2.0;
    p.coast_rate = -0.25;
    p.penetration = p.drive - p.coast;
    p.rate = p.drive_rate - p.coast_rate;
    GM_ASSERT_ABS(gm_contact_force(8.0, 0.0, &p), 8.0 * 4.0 - 8.0 * 2.0, 0.0);
    GM_ASSERT_ABS(gm_contact_force(8.0, 16.0, &p), (32.0 + 8.0) - (16.0 - 4.0), 0.0);
    /* The coast flanks part fast enough to pull: they do not. */
    GM_ASSERT_ABS(gm_contact_force(8.0, 128.0, &p), 32.0 + 64.0, 0.0);
    /* And the drive flanks. */
    p.drive_rate = -0.5;
    p.coast_rate = 0.25;
    GM_ASSERT_ABS(gm_contact_force(8.0, 128.0, &p), -(16.0 + 32.0), 0.0);
    GM_ASSERT_ABS(gm_contact_force(0.0, 0.0, &p), 0.0, 0.0);
}

static void force_is_nan_without_a_result(void) {
    gm_penetration p;
    memset(&p, 0, sizeof p);
    GM_ASSERT_ABS(gm_contact_force(1.0, 1.0, &p), 0.0, 0.0);
    GM_ASSERT_NAN(gm_contact_force(1.0, 1.0, NULL));
    double *const fields[] = {&p.drive, &p.coast, &p.drive_rate, &p.coast_rate};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        gm_test_context("field %d", (int)i);
        *fields[i] = NAN;
        GM_ASSERT_NAN(gm_contact_force(1.0, 1.0, &p));
        *fields[i] = HUGE_VAL;
        GM_ASSERT_NAN(gm_contact_force(1.0, 1.0, &p));
        *fields[i] = 0.0;
    }
    /* What a failed evaluation leaves. */
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_state state = {.pinion_angle = NAN};
    GM_ASSERT_INT(gm_penetration_3d(&pair, NULL, NULL, &state, &p), GM_STATE_NOT_FINITE);
    GM_ASSERT_NAN(gm_contact_force(1.0, 1.0, &p));
}

/* [Paper, Eqs. 9-11] with |x| in Eq. 10 */
static void simple_model_is_a_spring_with_backlash(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double half = pair.backlash / 2;
    const double speed = 0.125;
    static const double offsets[] = {-80e-6, -50.1e-6, -49e-6, 0.0, 49e-6, 50.1e-6, 80e-6, 1e-2};
    for (size_t i = 0; i < sizeof offsets / sizeof offsets[0]; i++) {
        const double x = offsets[i];
        gm_test_context("x = %g", x);
        gm_penetration r;
        GM_ASSERT_INT(gm_penetration_simple_at(&pair, x, speed, &r), GM_OK);
        const int drive = x > half;
        const int coast = x < -half;
        GM_ASSERT_REL(r.drive, drive ? x - half : 0.0, 1e-15);
        GM_ASSERT_REL(r.coast, coast ? -x - half : 0.0, 1e-15);
        GM_ASSERT_REL(r.penetration, r.drive - r.coast, 0.0);
        GM_ASSERT_REL(r.drive_rate, drive ? speed : 0.0, 0.0);
        GM_ASSERT_REL(r.coast_rate, coast ? -speed : 0.0, 0.0);
        GM_ASSERT_REL(r.rate, drive || coast ? speed : 0.0, 0.0);
        GM_ASSERT_ABS(r.drive_contact, drive, 0.0);
        GM_ASSERT_ABS(r.coast_contact, coast, 0.0);
        GM_ASSERT_INT(r.drive_pairs, drive);
        GM_ASSERT_INT(r.coast_pairs, coast);
        GM_ASSERT_ABS(r.d_pinion_angle, drive || coast ? pair.pinion.base_radius : 0.0, 0.0);
        GM_ASSERT_ABS(r.d_wheel_angle, drive || coast ? -pair.wheel.base_radius : 0.0, 0.0);

        const gm_state state = {.pinion_angle = 0.25,
                                .wheel_angle =
                                    (pair.pinion.base_radius * 0.25 - x) / pair.wheel.base_radius,
                                .pinion_speed = 3.0,
                                .wheel_speed = 2.0};
        gm_penetration s;
        GM_ASSERT_INT(gm_penetration_simple(&pair, &state, &s), GM_OK);
        GM_ASSERT_ABS(s.penetration, r.penetration, length_rounding(&pair));
        GM_ASSERT_REL(s.rate,
                      drive || coast ? 3.0 * pair.pinion.base_radius - 2.0 * pair.wheel.base_radius
                                     : 0.0,
                      1e-14);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(force_is_stiffness_and_damping_of_each_flank),
        GM_TEST(force_is_nan_without_a_result),
        GM_TEST(simple_model_is_a_spring_with_backlash),
    };
    return gm_test_main("unit.force", tests, GM_TEST_COUNT(tests), argc, argv);
}
