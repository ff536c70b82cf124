/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The evaluation itself: entries agree, refusals leave NaN, nothing but the output is written. What comes out
 * is judged by test_reference.c, test_sweep.c and test_properties.c. */
#include "flank.h" /* what the objects hold */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "random_gears.h"
#include "reference_gear.h"

static void assert_all_nan(const gm_penetration *r) {
    const double fields[] = {r->penetration,    r->rate,         r->drive,         r->coast,
                             r->drive_rate,     r->coast_rate,   r->drive_contact, r->coast_contact,
                             r->d_pinion_angle, r->d_wheel_angle};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        GM_ASSERT_NAN(fields[i]);
    }
    GM_ASSERT_INT(r->drive_pairs, 0);
    GM_ASSERT_INT(r->coast_pairs, 0);
}

static gm_position good_position(void) {
    const gm_position position = {
        .pinion_tooth = 44, .wheel_tooth = 40, .phase = 1e-3, .offset = 55e-6, .offset_rate = 0.25};
    return position;
}

static void state_and_position_give_the_same_bits(void) {
    uint64_t seed = UINT64_C(71);
    for (int i = 0; i < 200; ++i) {
        random_case c;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_case_make(&c, &seed, 1), GM_OK);
        const gm_state state = {c.pinion_angle, c.wheel_angle, 3.0, 2.0};
        gm_position position;
        gm_penetration a;
        gm_penetration b;
        memset(&a, 0, sizeof a);
        memset(&b, 0, sizeof b);
        GM_ASSERT_INT(gm_penetration_3d(&c.pair, c.use[0], c.use[1], &state, &a), GM_OK);
        GM_ASSERT_INT(gm_position_from_state(&c.pair, &state, &position), GM_OK);
        GM_ASSERT_INT(penetration_3d_at(&c.pair, c.use[0], c.use[1], &position, &b), GM_OK);
        GM_ASSERT(memcmp(&a, &b, sizeof a) == 0);

        /* The sum alone: the same, derivatives NaN. */
        gm_penetration sum;
        GM_ASSERT_INT(penetration_3d_sum_at(&c.pair, c.use[0], c.use[1], &position, &sum), GM_OK);
        GM_ASSERT_NAN(sum.d_pinion_angle);
        GM_ASSERT_NAN(sum.d_wheel_angle);
        /* Another way of adding up may round differently: 1e-13 of the sum. */
        GM_ASSERT_REL(sum.drive, a.drive, 1e-13);
        GM_ASSERT_REL(sum.coast, a.coast, 1e-13);
        GM_ASSERT_REL(sum.drive_contact, a.drive_contact, 1e-13);
        GM_ASSERT_REL(sum.coast_contact, a.coast_contact, 1e-13);
        GM_ASSERT_NEAR(sum.rate, a.rate, 1e-13, 0.0);
        GM_ASSERT_INT(sum.drive_pairs, a.drive_pairs);
        GM_ASSERT_INT(sum.coast_pairs, a.coast_pairs);
        random_case_free(&c);
    }
}

typedef int evaluation(const gm_pair *pair, const gm_flanks *pinion, const gm_flanks *wheel,
                       const gm_position *position, gm_penetration *result);

static evaluation *const evaluations[] = {penetration_3d_at, penetration_3d_sum_at};

static void null_pointers_are_refused(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_position position = good_position();
    const gm_state state = {.pinion_angle = 0.1, .wheel_angle = 0.11};
    gm_penetration r;
    for (int e = 0; e < 2; ++e) {
        gm_test_context("evaluation %d", e);
        memset(&r, 1, sizeof r);
        GM_ASSERT_INT(evaluations[e](NULL, NULL, NULL, &position, &r), GM_ERR_NULL);
        assert_all_nan(&r);
        memset(&r, 1, sizeof r);
        GM_ASSERT_INT(evaluations[e](&pair, NULL, NULL, NULL, &r), GM_ERR_NULL);
        assert_all_nan(&r);
        GM_ASSERT_INT(evaluations[e](&pair, NULL, NULL, &position, NULL), GM_ERR_NULL);
    }
    gm_test_context("from a state");
    memset(&r, 1, sizeof r);
    GM_ASSERT_INT(gm_penetration_3d(NULL, NULL, NULL, &state, &r), GM_ERR_NULL);
    assert_all_nan(&r);
    memset(&r, 1, sizeof r);
    GM_ASSERT_INT(gm_penetration_3d(&pair, NULL, NULL, NULL, &r), GM_ERR_NULL);
    assert_all_nan(&r);
    GM_ASSERT_INT(gm_penetration_3d(&pair, NULL, NULL, &state, NULL), GM_ERR_NULL);
    gm_test_context("simple");
    memset(&r, 1, sizeof r);
    GM_ASSERT_INT(gm_penetration_simple(NULL, &state, &r), GM_ERR_NULL);
    assert_all_nan(&r);
    memset(&r, 1, sizeof r);
    GM_ASSERT_INT(gm_penetration_simple(&pair, NULL, &r), GM_ERR_NULL);
    assert_all_nan(&r);
    GM_ASSERT_INT(gm_penetration_simple(&pair, &state, NULL), GM_ERR_NULL);
    memset(&r, 1, sizeof r);
    GM_ASSERT_INT(penetration_simple_at(NULL, 0.0, 0.0, &r), GM_ERR_NULL);
    assert_all_nan(&r);
    GM_ASSERT_INT(penetration_simple_at(&pair, 0.0, 0.0, NULL), GM_ERR_NULL);
}

/* A solver may fill a position itself: no number in it may lead outside the tables. */
static void positions_out_of_range_are_refused(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double p_bt = pair.transverse_base_pitch;

    gm_position wrong[16];
    int expected[16];
    int count = 0;

    /* No number, in one field after the other. */
    static const double bad[] = {NAN, HUGE_VAL, -HUGE_VAL};
    for (int k = 0; k < 3; ++k) {
        for (int field = 0; field < 3; ++field) {
            wrong[count] = good_position();
            double *const fields[] = {&wrong[count].phase, &wrong[count].offset,
                                      &wrong[count].offset_rate};
            *fields[field] = bad[k];
            expected[count++] = GM_STATE_NOT_FINITE;
        }
    }

    /* Beyond half a pitch, and teeth that the gears do not have. */
    wrong[count] = good_position();
    wrong[count].offset = 0.5 * p_bt;
    expected[count++] = GM_STATE_OUT_OF_RANGE;
    wrong[count] = good_position();
    wrong[count].phase = 10.0 * p_bt;
    expected[count++] = GM_STATE_OUT_OF_RANGE;

    for (int k = 0; k < 4; ++k) {
        wrong[count] = good_position();
        *(k < 2 ? &wrong[count].pinion_tooth : &wrong[count].wheel_tooth) =
            k % 2 == 0 ? -1 : (k < 2 ? 45 : 41);
        expected[count++] = GM_ERR_TOOTH;
    }

    for (int i = 0; i < count; ++i) {
        gm_test_context("position %d", i);
        gm_penetration r;
        for (int e = 0; e < 2; ++e) {
            memset(&r, 1, sizeof r);
            GM_ASSERT_INT(evaluations[e](&pair, NULL, NULL, &wrong[i], &r), expected[i]);
            assert_all_nan(&r);
        }

        gm_wrench w;
        memset(&w, 1, sizeof w);
        GM_ASSERT_INT(wrench_3d_at(&pair, NULL, NULL, &wrong[i], 1e8, 1.0, &w), expected[i]);
        GM_ASSERT_NAN(w.pinion_force[0]);
        GM_ASSERT_NAN(w.wheel_moment[2]);
    }

    const gm_position good = good_position();
    gm_penetration r;
    GM_ASSERT_INT(penetration_3d_at(&pair, NULL, NULL, &good, &r), GM_OK);
    GM_ASSERT(r.drive > 0.0);
}

static void simple_model_refuses_what_is_no_number(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    static const double bad[] = {NAN, HUGE_VAL, -HUGE_VAL};
    for (int k = 0; k < 3; ++k) {
        gm_test_context("%g", bad[k]);
        gm_penetration r;
        memset(&r, 1, sizeof r);
        GM_ASSERT_INT(penetration_simple_at(&pair, bad[k], 0.0, &r), GM_STATE_NOT_FINITE);
        assert_all_nan(&r);
        memset(&r, 1, sizeof r);
        GM_ASSERT_INT(penetration_simple_at(&pair, 0.0, bad[k], &r), GM_STATE_NOT_FINITE);
        assert_all_nan(&r);
    }
}

/* Both sides touch, so that the rates of both add up. */
static void speeds_are_taken_up_to_1e9(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.backlash = -20e-6;
    const gm_pair pair = make_pair(&params);

    static const double absurd[] = {1.01e9, -1.01e9, 1e80, -1.7e308};
    for (int k = 0; k < 4; ++k) {
        gm_test_context("%g", absurd[k]);
        gm_state states[2] = {{0.1, 0.1 * 45.0 / 41.0, absurd[k], 0.0},
                              {0.1, 0.1 * 45.0 / 41.0, 0.0, absurd[k]}};
        gm_position position = {0, 0, 0.0, 0.0, absurd[k], 0.0};
        gm_penetration r;
        gm_wrench w;

        for (int gear = 0; gear < 2; ++gear) {
            GM_ASSERT_INT(gm_penetration_3d(&pair, NULL, NULL, &states[gear], &r),
                          GM_STATE_OUT_OF_RANGE);
            assert_all_nan(&r);
            GM_ASSERT_INT(gm_penetration_simple(&pair, &states[gear], &r), GM_STATE_OUT_OF_RANGE);
            assert_all_nan(&r);
            GM_ASSERT_INT(gm_position_from_state(&pair, &states[gear], &position),
                          GM_STATE_OUT_OF_RANGE);
            GM_ASSERT_NAN(position.offset_rate);
        }

        position = (gm_position){0, 0, 0.0, 0.0, absurd[k], 0.0};
        GM_ASSERT_INT(penetration_3d_at(&pair, NULL, NULL, &position, &r), GM_STATE_OUT_OF_RANGE);
        assert_all_nan(&r);
        GM_ASSERT_INT(wrench_3d_at(&pair, NULL, NULL, &position, 1e8, 1e3, &w),
                      GM_STATE_OUT_OF_RANGE);
        GM_ASSERT_NAN(w.wheel_force[0]);

        GM_ASSERT_INT(penetration_simple_at(&pair, 0.0, absurd[k], &r), GM_STATE_OUT_OF_RANGE);
        assert_all_nan(&r);
        GM_ASSERT_INT(penetration_simple_at(&pair, k % 2 ? 1.01e18 : -1.7e308, 0.0, &r),
                      GM_STATE_OUT_OF_RANGE);
        assert_all_nan(&r);

        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.1, 0.0, absurd[k], &position),
                      GM_STATE_OUT_OF_RANGE);
        GM_ASSERT_NAN(position.offset_rate);
    }

    /* The bounds themselves are taken. */
    gm_penetration r;
    gm_position position = {0, 0, 0.0, 0.0, 1e9, 0.0};
    GM_ASSERT_INT(penetration_3d_at(&pair, NULL, NULL, &position, &r), GM_OK);
    GM_ASSERT_REL(r.rate, 1e9 * (r.drive_contact + r.coast_contact), 1e-15);

    GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.1, 0.0, -1e9, &position), GM_OK);
    GM_ASSERT_INT(penetration_simple_at(&pair, -1e18, -1e9, &r), GM_OK);
    GM_ASSERT_REL(r.coast, 1e18, 1e-15);
    GM_ASSERT_REL(r.rate, -1e9, 1e-15);

    const gm_state state = {0.1, 0.1 * 45.0 / 41.0, 1e9, -1e9};
    GM_ASSERT_INT(gm_penetration_simple(&pair, &state, &r), GM_OK);
    GM_ASSERT_INT(gm_penetration_3d(&pair, NULL, NULL, &state, &r), GM_OK);
    GM_ASSERT(isfinite(r.rate));
}

static void a_pair_that_failed_cannot_be_evaluated(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.normal_module = 0.0;
    gm_pair pair;
    GM_ASSERT(gm_pair_init(&pair, &params) < 0);
    const gm_state state = {.pinion_angle = 0.1, .wheel_angle = 0.11};
    gm_penetration r;
    GM_ASSERT(gm_penetration_3d(&pair, NULL, NULL, &state, &r) != GM_OK);
    assert_all_nan(&r);
}

/* Inputs are const in fact: neither the pair nor the memory of the tables changes; a copy of the pair is as good;
 * the same question gets the same bits again. */
static void evaluation_writes_its_output_alone(void) {
    uint64_t seed = UINT64_C(72);
    for (int i = 0; i < 50; ++i) {
        random_case c;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_case_make(&c, &seed, 1), GM_OK);
        const gm_state state = {c.pinion_angle, c.wheel_angle, 3.0, 2.0};
        const gm_pair before = c.pair;
        gm_pair copy;
        memcpy(&copy, &c.pair, sizeof copy);

        /* Pair and tables as they were. */
        double *tables[2] = {NULL, NULL};
        size_t bytes[2] = {0, 0};
        for (int g = 0; g < 2; ++g) {
            if (c.use[g] != NULL) {
                const gmi_tables *s = &c.flanks[g].flanks->side[GM_DRIVE];
                bytes[g] =
                    (size_t)(s->capacity * s->face_nodes * s->profile_nodes) * 4 * sizeof(double);
                tables[g] = malloc(bytes[g] + 1);
                memcpy(tables[g], s->values, bytes[g]);
            }
        }

        gm_penetration first;
        gm_penetration again;
        memset(&first, 0, sizeof first);
        memset(&again, 0, sizeof again);
        GM_ASSERT_INT(gm_penetration_3d(&c.pair, c.use[0], c.use[1], &state, &first), GM_OK);
        GM_ASSERT_INT(gm_penetration_3d(&copy, c.use[0], c.use[1], &state, &again), GM_OK);

        GM_ASSERT(memcmp(&first, &again, sizeof first) == 0);
        GM_ASSERT(memcmp(&before, &c.pair, sizeof before) == 0);
        for (int g = 0; g < 2; ++g) {
            if (c.use[g] != NULL) {
                GM_ASSERT(memcmp(tables[g], c.flanks[g].flanks->side[GM_DRIVE].values, bytes[g]) ==
                          0);
            }
            free(tables[g]);
        }
        random_case_free(&c);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(state_and_position_give_the_same_bits),
        GM_TEST(null_pointers_are_refused),
        GM_TEST(positions_out_of_range_are_refused),
        GM_TEST(simple_model_refuses_what_is_no_number),
        GM_TEST(speeds_are_taken_up_to_1e9),
        GM_TEST(a_pair_that_failed_cannot_be_evaluated),
        GM_TEST(evaluation_writes_its_output_alone),
    };
    return gm_test_main("unit.penetration", tests, GM_TEST_COUNT(tests), argc, argv);
}
