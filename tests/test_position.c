/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Angles reduced to teeth and phase: one rounding of the angle is all that large angles may cost. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "random_gears.h"
#include "reference_gear.h"

static int modulo(long long value, int modulus) {
    const int rest = (int)(value % modulus);
    return rest < 0 ? rest + modulus : rest;
}

/** Two roundings of lengths below d and one more for r_b times an angle below a pitch. */
static double rounding(const gm_pair_params *params) {
    return 3.0 * 0x1p-53 * params->center_distance;
}

/** Angle in pitches. */
static long double pitches_of(long double angle, int teeth) {
    return angle * teeth / 6.28318530717958647692528676655900577L;
}

static void offset_is_exact_whatever_the_angle(void) {
    uint64_t seed = UINT64_C(61);
    for (int i = 0; i < 4000; ++i) {
        random_case c;
        GM_ASSERT_INT(random_case_make(&c, &seed, 0), GM_OK);
        const double angle =
            gm_test_uniform(&seed, -1.0, 1.0) * pow(10.0, gm_test_integer(&seed, 0, 8));
        random_case_place(&c, angle,
                          (double)c.model.base_pitch * gm_test_uniform(&seed, -0.4, 0.4));
        gm_test_context("case %d, angle %.17g", i, angle);
        model_result m;
        model_evaluate(&c.model, NULL, NULL, c.pinion_angle, c.wheel_angle, 0.0L, 0.0L, &m);
        const gm_state state = {.pinion_angle = c.pinion_angle, .wheel_angle = c.wheel_angle};
        gm_position position;
        int good = 1;
        if (fabs(c.wheel_angle) > 1e9 || fabsl(m.offset) >= 0.499L * c.model.base_pitch) {
            /* At 1e8 rad a rounding of the wheel angle may be more than the clearance left. */
            random_case_free(&c);
            continue;
        }
        good &= GM_ASSERT_INT(gm_position_from_state(&c.pair, &state, &position), GM_OK);
        good &= GM_ASSERT_ABS(position.offset, (double)m.offset, rounding(&c.params));
        random_case_free(&c);
        if (!good) {
            return;
        }
    }
}

static void tooth_and_phase_are_those_of_the_angle(void) {
    uint64_t seed = UINT64_C(62);
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double p_bt = pair.transverse_base_pitch;
    for (int i = 0; i < 4000; ++i) {
        const double angle =
            gm_test_uniform(&seed, -1.0, 1.0) * pow(10.0, gm_test_integer(&seed, -3, 5));
        gm_test_context("angle %.17g", angle);
        gm_position position;
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, angle, 1e-6, 0.5, &position), GM_OK);
        /* phase = r_bp (phi_p + 2 pi i / z_p) in [0, p_bt): i = -floor(phi_p z_p / 2 pi) */
        const long double pitches = pitches_of(angle, 45);
        const long double whole = floorl(pitches);
        if (pitches - whole < 1e-9L || pitches - whole > 1.0L - 1e-9L) {
            continue;
        }
        /* long double keeps 1e5 rad to 1e-15, here in pitches of 0.14 rad. */
        int good = GM_ASSERT_ABS(position.phase, (double)(pitches - whole) * p_bt, 1e-12 * p_bt);
        good &= GM_ASSERT_INT(position.pinion_tooth, modulo(-(long long)whole, 45));
        good &= GM_ASSERT_INT(position.wheel_tooth, modulo(-(long long)whole, 41));
        good &= GM_ASSERT(position.phase >= 0.0 && position.phase < p_bt);
        good &= GM_ASSERT_REL(position.offset, 1e-6, 0.0);
        good &= GM_ASSERT_REL(position.offset_rate, 0.5, 0.0);
        if (!good) {
            return;
        }
    }
}

/* There the quotient of angle and pitch may round to the wrong side, up or down with the number of teeth. */
static void multiples_of_the_pitch_stay_in_range(void) {
    for (int teeth = 40; teeth <= 52; ++teeth) {
        gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
        params.pinion_teeth = teeth;
        params.center_distance += (teeth - 45) * 0.984e-3;
        params.pinion_tip_radius += (teeth - 45) * 0.984e-3;
        const gm_pair pair = make_pair(&params);
        for (int n = -100000; n <= 100000; n += 77) {
            const double exact = pair.pinion.pitch_angle * n;
            for (int step = -1; step <= 1; ++step) {
                const double angle = step == 0 ? exact : nextafter(exact, step * HUGE_VAL);
                gm_test_context("%d teeth, %d pitches %+d", teeth, n, step);
                gm_position position;
                GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, angle, 0.0, 0.0, &position),
                              GM_OK);
                /* At the ends of the range a rounding may lead across, with the tooth that
                 * belongs to it. */
                const int good =
                    GM_ASSERT(position.phase >= -0x1p-52 * pair.transverse_base_pitch &&
                              position.phase <= pair.transverse_base_pitch * (1.0 + 0x1p-52)) &
                    GM_ASSERT(position.pinion_tooth >= 0 && position.pinion_tooth < teeth) &
                    GM_ASSERT(position.wheel_tooth >= 0 && position.wheel_tooth < 41);
                if (!good) {
                    return;
                }
            }
        }
    }
}

static void both_ways_to_a_position_agree(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_state state = {.pinion_angle = 123.456,
                            .wheel_angle = 123.456 * 45.0 / 41.0,
                            .pinion_speed = 100.0,
                            .wheel_speed = 109.0};
    gm_position a;
    gm_position b;
    GM_ASSERT_INT(gm_position_from_state(&pair, &state, &a), GM_OK);
    GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 123.456, a.offset, a.offset_rate, &b),
                  GM_OK);
    GM_ASSERT_INT(a.pinion_tooth, b.pinion_tooth);
    GM_ASSERT_INT(a.wheel_tooth, b.wheel_tooth);
    GM_ASSERT_REL(a.phase, b.phase, 0.0);
    GM_ASSERT_REL(a.offset, b.offset, 0.0);
    /* [Paper, Eq. 11] */
    GM_ASSERT(a.pinion_speed == 100.0 && b.pinion_speed == 0.0);
    GM_ASSERT_REL(a.offset_rate, 100.0 * pair.pinion.base_radius - 109.0 * pair.wheel.base_radius,
                  1e-14);
}

/* A position may be anywhere, as the simple model is; the 3D model ends where a tooth would be skipped. */
static void half_a_base_pitch_is_the_limit_of_the_3d_model(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double limit = pair.transverse_base_pitch / 2;
    gm_position position;
    for (int s = -1; s <= 1; s += 2) {
        gm_test_context("sign %d", s);
        GM_ASSERT_INT(
            gm_position_from_pinion_angle(&pair, 0.3, s * limit * (1.0 - 1e-15), 0.0, &position),
            GM_OK);
        gm_penetration r;
        GM_ASSERT_INT(penetration_3d_at(&pair, NULL, NULL, &position, &r), GM_OK);
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.3, s * limit, 0.0, &position), GM_OK);
        GM_ASSERT_REL(position.offset, s * limit, 0.0);
        GM_ASSERT_INT(penetration_3d_at(&pair, NULL, NULL, &position, &r), GM_STATE_OUT_OF_RANGE);
        GM_ASSERT_NAN(r.penetration);
        const gm_state state = {.pinion_angle = 0.3,
                                .wheel_angle = (0.3 * pair.pinion.base_radius - s * limit * 1.001) /
                                               pair.wheel.base_radius};
        GM_ASSERT_INT(gm_position_from_state(&pair, &state, &position), GM_OK);
        GM_ASSERT_ABS(position.offset, s * limit * 1.001, length_rounding(&pair));
        GM_ASSERT_INT(gm_penetration_3d(&pair, NULL, NULL, &state, &r), GM_STATE_OUT_OF_RANGE);
        GM_ASSERT_NAN(r.penetration);
        GM_ASSERT_INT(gm_penetration_simple(&pair, &state, &r), GM_OK);
    }
}

static void angles_are_taken_up_to_1e9_rad(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    gm_position position;
    gm_penetration r;
    for (int s = -1; s <= 1; s += 2) {
        gm_test_context("sign %d", s);
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, s * 1e9, 0.0, 0.0, &position), GM_OK);
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, s * 1.0000001e9, 0.0, 0.0, &position),
                      GM_STATE_OUT_OF_RANGE);
        GM_ASSERT_NAN(position.phase);
        gm_state state = {.pinion_angle = s * 1.1e9, .wheel_angle = s * 0.9e9};
        GM_ASSERT_INT(gm_position_from_state(&pair, &state, &position), GM_STATE_OUT_OF_RANGE);
        GM_ASSERT_INT(gm_penetration_simple(&pair, &state, &r), GM_STATE_OUT_OF_RANGE);
        GM_ASSERT_NAN(r.penetration);
        state.pinion_angle = s * 0.9e9;
        state.wheel_angle = s * 1.1e9;
        GM_ASSERT_INT(gm_position_from_state(&pair, &state, &position), GM_STATE_OUT_OF_RANGE);
        GM_ASSERT_NAN(position.offset);
    }
}

/* Speeds of both gears, x and its rate: the last number that is taken, and one beyond, either way. */
static void speeds_and_offsets_have_their_limits(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    gm_position position;
    for (int s = -1; s <= 1; s += 2) {
        gm_test_context("sign %d", s);
        for (int gear = 0; gear < 2; ++gear) {
            gm_state state = {.pinion_angle = 0.1, .wheel_angle = 0.11};
            double *const speed = gear == 0 ? &state.pinion_speed : &state.wheel_speed;
            *speed = s * 1e9;
            GM_ASSERT_INT(gm_position_from_state(&pair, &state, &position), GM_OK);
            *speed = s * 1.0000001e9;
            GM_ASSERT_INT(gm_position_from_state(&pair, &state, &position), GM_STATE_OUT_OF_RANGE);
            GM_ASSERT_NAN(position.offset_rate);
        }
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.1, s * 1e18, 0.0, &position), GM_OK);
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.1, s * 1.0000001e18, 0.0, &position),
                      GM_STATE_OUT_OF_RANGE);
        GM_ASSERT_NAN(position.phase);
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.1, 0.0, s * 1e9, &position), GM_OK);
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.1, 0.0, s * 1.0000001e9, &position),
                      GM_STATE_OUT_OF_RANGE);
        GM_ASSERT_NAN(position.offset);
        GM_ASSERT_NAN(position.phase);
        GM_ASSERT_NAN(position.pinion_speed);
        GM_ASSERT_INT(position.pinion_tooth, 0);
        GM_ASSERT_INT(position.wheel_tooth, 0);
    }
}

static void numbers_that_are_none_are_refused(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    static const double bad[] = {NAN, HUGE_VAL, -HUGE_VAL};
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; ++k) {
        for (int field = 0; field < 4; ++field) {
            gm_test_context("field %d, %g", field, bad[k]);
            gm_state state = {.pinion_angle = 0.1, .wheel_angle = 0.11};
            double *const fields[] = {&state.pinion_angle, &state.wheel_angle, &state.pinion_speed,
                                      &state.wheel_speed};
            *fields[field] = bad[k];
            gm_position position = {.phase = 1.0, .offset = 1.0, .offset_rate = 1.0};
            GM_ASSERT_INT(gm_position_from_state(&pair, &state, &position), GM_STATE_NOT_FINITE);
            GM_ASSERT_NAN(position.phase);
            GM_ASSERT_NAN(position.offset);
            GM_ASSERT_NAN(position.offset_rate);
            gm_penetration r;
            GM_ASSERT_INT(gm_penetration_3d(&pair, NULL, NULL, &state, &r), GM_STATE_NOT_FINITE);
            GM_ASSERT_NAN(r.penetration);
            GM_ASSERT_INT(gm_penetration_simple(&pair, &state, &r), GM_STATE_NOT_FINITE);
            GM_ASSERT_NAN(r.penetration);
            if (field < 3) {
                const double a = field == 0 ? bad[k] : 0.1;
                const double x = field == 1 ? bad[k] : 1e-6;
                const double v = field == 2 ? bad[k] : 0.0;
                GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, a, x, v, &position),
                              GM_STATE_NOT_FINITE);
                GM_ASSERT_NAN(position.phase);
                GM_ASSERT_NAN(position.offset);
                GM_ASSERT_NAN(position.offset_rate);
            }
        }
    }
}

static void null_pointers_are_refused(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_state state = {.pinion_angle = 0.1, .wheel_angle = 0.11};
    gm_position position = {.offset = 1.0};
    GM_ASSERT_INT(gm_position_from_state(NULL, &state, &position), GM_ERR_NULL);
    GM_ASSERT_NAN(position.offset);
    position.offset = 1.0;
    GM_ASSERT_INT(gm_position_from_state(&pair, NULL, &position), GM_ERR_NULL);
    GM_ASSERT_NAN(position.offset);
    GM_ASSERT_INT(gm_position_from_state(&pair, &state, NULL), GM_ERR_NULL);
    position.offset = 1.0;
    GM_ASSERT_INT(gm_position_from_pinion_angle(NULL, 0.1, 0.0, 0.0, &position), GM_ERR_NULL);
    GM_ASSERT_NAN(position.offset);
    GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.1, 0.0, 0.0, NULL), GM_ERR_NULL);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(offset_is_exact_whatever_the_angle),
        GM_TEST(tooth_and_phase_are_those_of_the_angle),
        GM_TEST(multiples_of_the_pitch_stay_in_range),
        GM_TEST(both_ways_to_a_position_agree),
        GM_TEST(half_a_base_pitch_is_the_limit_of_the_3d_model),
        GM_TEST(angles_are_taken_up_to_1e9_rad),
        GM_TEST(speeds_and_offsets_have_their_limits),
        GM_TEST(numbers_that_are_none_are_refused),
        GM_TEST(null_pointers_are_refused),
    };
    return gm_test_main("unit.position", tests, GM_TEST_COUNT(tests), argc, argv);
}
