/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/gearsim/response.c: the series solve their differential equation. */
#include "response.h"

#include "gm_test.h"

static const double gain = 18.0, frequency = 12000.0;

static load_signal noise(double interval) {
    return load_create(20.0, 10.0, interval, 4);
}

/*
 * p' is the derivative of p, and p'' - from differences of p' - what the equation says; within the noise
 * intervals. Central differences over 2 e are off by e^2/6 times the next but one derivative, which for
 * p'' is gain * 100 / interval^2 at most: 1e-6 * 300 m/s2. What the series leaves out is 1e-15 of
 * gain * 10 / w0^2 = 1.3e-6 m, which over 2 e is 3e-13 m/s; times are rounded by 1e-16 s, which over 2 e makes
 * 1e-8 of p'.
 */
static void it_solves_its_equation(void) {
    const double intervals[] = {2e-6, 1e-5, 1e-4, 1e-3};
    const double ratios[] = {0.02, 0.05, 0.5};

    for (int i = 0; i < 4; ++i) {
        for (int r = 0; r < 3; ++r) {
            const double interval = intervals[i], e = 1e-3 * fmin(interval, 1e-5);
            const load_signal load = noise(interval);
            response *linear = response_create(&load, gain, frequency, ratios[r]);
            gm_test_context("interval %g, ratio %g", interval, ratios[r]);

            for (int k = 0; k < 1000; ++k) {
                const double t = (k + 0.1 + 0.8e-3 * k) * interval;
                const response_value before = response_at(linear, t - e),
                                     at = response_at(linear, t),
                                     after = response_at(linear, t + e);
                const double acceleration = gain * (load_torque(&load, t) - 20.0) -
                                            2.0 * ratios[r] * frequency * at.rate -
                                            frequency * frequency * at.offset;
                if (!GM_ASSERT_ABS((after.rate - before.rate) / (2.0 * e), acceleration, 2e-3) ||
                    !GM_ASSERT_ABS((after.offset - before.offset) / (2.0 * e), at.rate, 2e-7)) {
                    break;
                }
            }
            response_free(linear);
        }
    }
}

/* p and p' go on without a jump from one noise value to the next. */
static void it_is_smooth_across_the_noise_values(void) {
    const double interval = 1e-5;
    const load_signal load = noise(interval);
    response *linear = response_create(&load, gain, frequency, 0.05);

    for (int k = 1; k < 2000; ++k) {
        const double e = 1e-9 * interval;
        const response_value before = response_at(linear, k * interval - e),
                             after = response_at(linear, k * interval + e);
        /* Over 2 e p moves by 2 e p' and p' by 2e-14 s * 225 m/s2; times of 0.02 s are rounded by 3e-18 s, p by 1e-22 m. */
        GM_ASSERT_ABS(after.offset - before.offset, 2.0 * e * after.rate, 2e-18);
        GM_ASSERT_ABS(after.rate - before.rate, 0.0, 1e-11);
    }
    response_free(linear);
}

/*
 * What the noise has given x' is the gain times its integral, within and across noise values and parts of their intervals:
 * sums of up to 1 m/s, rounded by 1e-16 in each of 1200 segments.
 */
static void it_tells_what_the_noise_has_given(void) {
    const double intervals[] = {2e-6, 1e-5, 1e-4};

    for (int i = 0; i < 3; ++i) {
        const load_signal load = noise(intervals[i]);
        response *linear = response_create(&load, gain, frequency, 0.05);
        double given = 0.0, from = 0.0, before = 0.0;
        noise_piece piece = {.values = {.is_known = 0}};

        for (int k = 0; k < 300; ++k) {
            const double times[] = {from + 0.3 * intervals[i], from + 1.7 * intervals[i]};
            response_sum sums[2], alone[2];
            response_given(linear, 2, times, 1, sums);
            response_given(linear, 2, times, 0, alone);
            for (int n = 0; n < 2; ++n) {
                const response_value at = response_at(linear, times[n]);

                given += gain * load_noise_integral(&load, from, times[n], 1.0, 1.0, &piece);
                gm_test_context("interval %g, time %.12g", intervals[i], times[n]);
                GM_ASSERT_ABS(sums[n].given, given, 1e-12);
                GM_ASSERT(alone[n].given == sums[n].given && sums[n].value.offset == at.offset &&
                          sums[n].value.rate == at.rate && alone[n].value.rate == at.rate);
                from = times[n];
            }
            GM_ASSERT(sums[1].given != before);
            before = sums[1].given;
        }
        response_free(linear);
    }
}

/* However many times are asked for at once, and how they lie in the segments: to some roundings what each is alone. */
static void many_times_at_once_are_those_alone(void) {
    enum { TIMES = 40 };
    const double steps[] = {0.05, 0.22, 0.3, 0.9, 2.5}; /* in terms of the interval */

    for (int i = 0; i < 5; ++i) {
        const load_signal load = noise(1e-5);
        response *linear = response_create(&load, gain, frequency, 0.05);
        response_sum together[TIMES], with_offset[TIMES];
        double times[TIMES];

        for (int n = 0; n < TIMES; ++n) {
            times[n] =
                (n - 3 + 0.01) * steps[i] * 1e-5; /* the first ones before the noise begins */
        }
        response_given(linear, TIMES, times, 0, together);
        response_given(linear, TIMES, times, 1, with_offset);
        for (int n = 0; n < TIMES; ++n) {
            response_sum alone;
            response_given(linear, 1, &times[n], 1, &alone);
            gm_test_context("step %g, time %d", steps[i], n);
            GM_ASSERT_ABS(together[n].given, alone.given, 1e-15);
            GM_ASSERT_ABS(together[n].value.rate, alone.value.rate, 1e-16);
            GM_ASSERT(with_offset[n].given == alone.given &&
                      with_offset[n].value.offset == alone.value.offset &&
                      with_offset[n].value.rate == alone.value.rate);
        }
        response_free(linear);
    }
}

static void it_starts_at_rest(void) {
    const load_signal load = noise(1e-5);
    response *linear = response_create(&load, gain, frequency, 0.05);
    const response_value start = response_at(linear, 0.0);

    GM_ASSERT(start.offset == 0.0 && start.rate == 0.0);
    response_free(linear);
}

/* Looking back by a little or by much: the same bits. */
static void it_may_be_asked_in_any_order(void) {
    enum { TIMES = 3000 };
    const load_signal load = noise(1e-5);
    response *linear = response_create(&load, gain, frequency, 0.05);
    static response_value forward[TIMES];
    uint64_t seed = 8;

    for (int i = 0; i < TIMES; ++i) {
        forward[i] = response_at(linear, 0.7e-5 * i);
    }
    for (int i = 0; i < 200; ++i) {
        const int at = gm_test_integer(&seed, 0, TIMES - 1);
        const response_value again = response_at(linear, 0.7e-5 * at);
        GM_ASSERT(again.offset == forward[at].offset && again.rate == forward[at].rate);
    }
    response_free(linear);
}

static void useful_only_with_noise_that_is_not_too_dense(void) {
    const load_signal silent = load_create(20.0, 0.0, 1e-5, 1);
    const load_signal usual = noise(1e-5), dense = noise(1e-8);

    GM_ASSERT(!response_is_useful(&silent, frequency));
    GM_ASSERT(response_is_useful(&usual, frequency));
    GM_ASSERT(!response_is_useful(&dense, frequency));
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(it_solves_its_equation),
        GM_TEST(it_is_smooth_across_the_noise_values),
        GM_TEST(it_tells_what_the_noise_has_given),
        GM_TEST(many_times_at_once_are_those_alone),
        GM_TEST(it_starts_at_rest),
        GM_TEST(it_may_be_asked_in_any_order),
        GM_TEST(useful_only_with_noise_that_is_not_too_dense),
    };
    return gm_test_main("gearsim.response", tests, GM_TEST_COUNT(tests), argc, argv);
}
