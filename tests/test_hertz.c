/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The inverse of the line contact law against the law itself, and against what physics demands of it. */
#include "gm_test.h"
#include "hertz.h"

/* Steel on steel, module 2 mm. */
static const double compliance = 2.812252392497568e-12;
static const double level = 18.45781478408708;

static double rate_of(double L) {
    return 1.0 / (compliance * exp(L));
}

/* w with w e^-w = eta, w > 1, by bisection of its logarithm. */
static long double bisected(long double eta) {
    long double low = 1.0L, high = 1e4L;
    for (int k = 0; k < 300; ++k) {
        const long double w = 0.5L * (low + high);
        if (logl(w) - w > logl(eta)) {
            low = w;
        } else {
            high = w;
        }
    }
    return 0.5L * (low + high);
}

static void reciprocal_is_that_of_bisection(void) {
    uint64_t seed = 3;
    for (int k = 0; k < 20000; ++k) {
        const double eta = pow(2.0, gm_test_uniform(&seed, -56.0, -1.9));
        const long double w = bisected(eta);
        const double y = gmi_hertz_reciprocal(eta);
        gm_test_context("eta %.17g", eta);
        if (!GM_ASSERT_REL(y, (double)(1.0L / w), 3e-11) ||
            !GM_ASSERT_REL(y / (1.0 - y), (double)(1.0L / (w - 1.0L)), 3e-11)) {
            break;
        }
    }
}

/* Polynomials meet at the ends of their segments, the table the rest, and the law its straight part. */
static void reciprocal_is_continuous(void) {
    for (int octave = -56; octave <= -2; ++octave) {
        for (int part = 0; part < 8; ++part) {
            const double eta = ldexp(1.0 + part / 8.0, octave);
            gm_test_context("eta %g", eta);
            GM_ASSERT_REL(gmi_hertz_reciprocal(eta * (1.0 - 0x1p-53)), gmi_hertz_reciprocal(eta),
                          6e-11);
        }
    }
    GM_ASSERT_REL(gmi_hertz_reciprocal(gmi_hertz_largest * (1.0 - 0x1p-53)), 0.5, 1e-13);
    GM_ASSERT_REL(gmi_hertz_reciprocal(gmi_hertz_largest * (1.0 + 0x1p-52)), 0.5, 1e-13);
}

static void no_approach_means_no_load(void) {
    gmi_hertz_state state;
    const double none[] = {0.0, -0.0, -1e-300, -1e-6, -1.0};
    for (int k = 0; k < 5; ++k) {
        gmi_hertz_evaluate(compliance, rate_of(level), none[k], &state);
        GM_ASSERT(state.load == 0.0 && state.stiffness == 0.0 && state.energy == 0.0);
        GM_ASSERT(state.load_by_L == 0.0 && state.energy_by_L == 0.0);
    }
    GM_ASSERT_NAN(gmi_hertz_reciprocal((double)NAN));
}

/* Check values of the specification, from the law solved to 15 digits. */
static void loads_are_the_check_values(void) {
    static const double rows[][4] = {
        {1e-7, 3448.214324, 3.818504182e10, 1.640511680e-4},
        {1e-6, 46059.75920, 5.291376781e10, 2.153833024e-2},
        {5e-6, 304971.2714, 7.362287758e10, 6.970380540e-1},
        {2e-5, 1739316.185, 1.151209071e11, 15.26624075},
    };
    for (int k = 0; k < 4; ++k) {
        gmi_hertz_state state;
        gmi_hertz_evaluate(2.8122523925e-12, 1.0 / (2.8122523925e-12 * exp(18.4578147841)),
                           rows[k][0], &state);
        GM_ASSERT_REL(state.load, rows[k][1], 1e-9);
        GM_ASSERT_REL(state.stiffness, rows[k][2], 1e-9);
        GM_ASSERT_REL(state.energy, rows[k][3], 1e-9);
    }
}

/* Newton in long double on delta = B q (L - ln q), independent of the substitution. */
static long double exact_load(long double delta, long double L) {
    long double low = logl(1e-30L), high = L - 1.0L;
    for (int k = 0; k < 300; ++k) {
        const long double v = 0.5L * (low + high);
        if (compliance * expl(v) * (L - v) < delta) {
            low = v;
        } else {
            high = v;
        }
    }
    return expl(0.5L * (low + high));
}

static void derivatives_are_those_of_differences(void) {
    uint64_t seed = 5;
    for (int k = 0; k < 500; ++k) {
        const double delta = pow(10.0, gm_test_uniform(&seed, -10.0, -4.15));
        const double step = 1e-5 * delta, step_L = 1e-5;
        gmi_hertz_state at, above, below, more, less;
        gm_test_context("delta %.17g", delta);
        gmi_hertz_evaluate(compliance, rate_of(level), delta, &at);
        gmi_hertz_evaluate(compliance, rate_of(level), delta + step, &above);
        gmi_hertz_evaluate(compliance, rate_of(level), delta - step, &below);
        gmi_hertz_evaluate(compliance, rate_of(level + step_L), delta, &more);
        gmi_hertz_evaluate(compliance, rate_of(level - step_L), delta, &less);
        GM_ASSERT_REL(at.load, (double)exact_load(delta, level), 3e-11);
        GM_ASSERT_REL((above.load - below.load) / (2.0 * step), at.stiffness, 1e-5);
        GM_ASSERT_REL((above.energy - below.energy) / (2.0 * step), at.load, 1e-8);
        GM_ASSERT_REL((more.load - less.load) / (2.0 * step_L), at.load_by_L, 1e-5);
        GM_ASSERT_REL((more.energy - less.energy) / (2.0 * step_L), at.energy_by_L, 1e-5);
    }
}

/* The straight part: tangent to the law where it begins, with the energy of a spring. */
static void straight_part_goes_on(void) {
    const double begin = 2.0 * compliance * exp(level - 2.0);
    const double factors[] = {1.001, 1.5, 3.0, 100.0};
    for (int k = 0; k < 4; ++k) {
        const double delta = factors[k] * begin, step = 1e-4 * begin, step_L = 1e-5;
        gmi_hertz_state at, above, below, more, less;
        gmi_hertz_evaluate(compliance, rate_of(level), delta, &at);
        gmi_hertz_evaluate(compliance, rate_of(level), delta + step, &above);
        gmi_hertz_evaluate(compliance, rate_of(level), delta - step, &below);
        gmi_hertz_evaluate(compliance, rate_of(level + step_L), delta, &more);
        gmi_hertz_evaluate(compliance, rate_of(level - step_L), delta, &less);
        GM_ASSERT_REL(at.load, exp(level - 2.0) + (delta - begin) / compliance, 1e-12);
        GM_ASSERT_REL(at.stiffness, 1.0 / compliance, 1e-12);
        GM_ASSERT_REL((above.energy - below.energy) / (2.0 * step), at.load, 1e-8);
        GM_ASSERT_REL((more.load - less.load) / (2.0 * step_L), at.load_by_L, 1e-5);
        GM_ASSERT_REL((more.energy - less.energy) / (2.0 * step_L), at.energy_by_L, 1e-5);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {GM_TEST(reciprocal_is_that_of_bisection),
                                    GM_TEST(reciprocal_is_continuous),
                                    GM_TEST(no_approach_means_no_load),
                                    GM_TEST(loads_are_the_check_values),
                                    GM_TEST(derivatives_are_those_of_differences),
                                    GM_TEST(straight_part_goes_on)};
    return gm_test_main("unit.hertz", tests, GM_TEST_COUNT(tests), argc, argv);
}
