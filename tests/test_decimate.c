/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/gearsim/decimate.c: what it promises of its filter, measured with sines. */
#include "decimate.h"

#include "gm_test.h"

static const double two_pi = 6.283185307179586;
static const int factors[] = {2, 3, 4, 16};
enum { FACTORS = sizeof factors / sizeof factors[0] };

/* Sine of a frequency in terms of the rate of the rows, at a time in rows. */
static double sine(double frequency, double time) {
    return sin(two_pi * frequency * time + 0.3);
}

static const enum sample_kind filtered_kinds[] = {SAMPLE_VALUES, SAMPLE_BEHIND, SAMPLE_BOX,
                                                  SAMPLE_HAT};
enum { FILTERED_KINDS = sizeof filtered_kinds / sizeof filtered_kinds[0] };

/* What the mean over an interval of length 1 leaves of a sine; the triangle is two such means in a row. */
static double gain_of_kind(enum sample_kind kind, double frequency) {
    const double half = 0.5 * two_pi * frequency;
    const double box = half == 0.0 ? 1.0 : sin(half) / half;

    return kind == SAMPLE_HAT ? box * box : kind == SAMPLE_BOX ? box : 1.0;
}

/* Where in the period from one sample to the next its value is that of. */
static double place_of_kind(enum sample_kind kind) {
    return kind == SAMPLE_BEHIND ? 0.5 : 0.0;
}

/* Largest size of (filtered - gain * sine at the row's own time) over some rows in the middle of a run. */
static double filtered_error(enum sample_kind kind, int factor, double frequency, double gain) {
    decimator *filter = decimator_create(factor, 1, &kind);
    const double mean = gain_of_kind(kind, frequency / factor);
    const int delay = decimator_delay(filter);
    double largest = 0.0;

    for (int j = 0; j < 80 * factor; ++j) {
        const double sample = mean * sine(frequency, (j + place_of_kind(kind)) / factor);
        double value;
        decimator_push(filter, &sample);
        decimator_values(filter, &value);
        /* Away from the start, where the past is held. */
        if (j >= 2 * delay) {
            largest =
                fmax(largest, fabs(value - gain * sine(frequency, (double)(j - delay) / factor)));
        }
    }
    decimator_free(filter);
    return largest;
}

/* At the row's time, with neither delay nor phase: 0.01 % and 0.03 % as the header says. */
static void pass_band_is_flat_and_without_delay(void) {
    for (int i = 0; i < FACTORS; ++i) {
        for (double f = 0.0; f <= 0.4001; f += 0.02) {
            for (int k = 0; k < FILTERED_KINDS; ++k) {
                gm_test_context("kind %d, factor %d, frequency %.2f", k, factors[i], f);
                /* The lift of the triangle by two samples per row is steep next to the edge. */
                const double allowed =
                    filtered_kinds[k] == SAMPLE_HAT && factors[i] == 2 ? 3e-4 : 1e-4;
                GM_ASSERT_ABS(filtered_error(filtered_kinds[k], factors[i], f, 1.0), 0.0, allowed);
            }
        }
    }
}

/* 90 dB as the header says, up to half the rate of the samples. */
static void stop_band_is_shut(void) {
    for (int i = 0; i < FACTORS; ++i) {
        for (double f = 0.6; f <= 0.5 * factors[i]; f += 0.03 * factors[i]) {
            for (int k = 0; k < FILTERED_KINDS; ++k) {
                gm_test_context("kind %d, factor %d, frequency %.2f", k, factors[i], f);
                GM_ASSERT_ABS(filtered_error(filtered_kinds[k], factors[i], f, 0.0), 0.0, 3.162e-5);
            }
        }
    }
}

/* Half way down between the bands: it does filter, and where it says. */
static void half_the_rate_is_halved(void) {
    /* Symmetry of a windowed sinc about its edge makes the gain 1/2 there but for the ripple of 3e-5. */
    for (int i = 0; i < FACTORS; ++i) {
        gm_test_context("factor %d", factors[i]);
        GM_ASSERT_ABS(filtered_error(SAMPLE_VALUES, factors[i], 0.5, 0.5), 0.0, 1e-4);
    }
}

static void a_constant_stays(void) {
    for (int i = 0; i < FACTORS; ++i) {
        const enum sample_kind kinds[] = {SAMPLE_VALUES, SAMPLE_PLAIN};
        const double values[] = {524.0666, 7.0};
        decimator *filter = decimator_create(factors[i], 2, kinds);
        double got[2];

        /* From the first sample on, as the past is held. */
        for (int j = 0; j < 3; ++j) {
            decimator_push(filter, values);
            decimator_values(filter, got);
            /* A sum of up to 481 products with the sum of weights 1: each rounding counts 1e-16, and they
             * seldom agree. */
            GM_ASSERT_REL(got[0], 524.0666, 1e-14);
            GM_ASSERT(got[1] == 7.0);
        }
        decimator_free(filter);
    }
}

static void weights_are_symmetric_with_the_sum_one(void) {
    for (int i = 0; i < FACTORS; ++i) {
        const enum sample_kind kinds[] = {SAMPLE_VALUES};
        decimator *filter = decimator_create(factors[i], 1, kinds);
        const int half = decimator_delay(filter);
        const double *weights = decimator_weights(filter, SAMPLE_VALUES);
        double sum = 0.0;

        GM_ASSERT_INT(half % factors[i], 0);
        for (int k = 0; k <= 2 * half; ++k) {
            sum += weights[k];
            GM_ASSERT_ABS(weights[k], weights[2 * half - k], 1e-17);
        }
        GM_ASSERT_REL(sum, 1.0, 1e-14);
        decimator_free(filter);
    }
}

/* What is not filtered comes out at the same row, bit for bit. */
static void plain_channels_are_delayed_alike(void) {
    const enum sample_kind kinds[] = {SAMPLE_PLAIN, SAMPLE_VALUES};
    decimator *filter = decimator_create(4, 2, kinds);
    const int delay = decimator_delay(filter);

    for (int j = 0; j < 1000; ++j) {
        const double values[] = {0.1 * j, 1.0};
        double got[2];
        decimator_push(filter, values);
        decimator_values(filter, got);
        if (j >= delay) {
            GM_ASSERT(got[0] == 0.1 * (j - delay));
        } else {
            GM_ASSERT(got[0] == 0.0);
        }
    }
    decimator_free(filter);
}

/* Columns of all kinds side by side, in any number and order, are what each of them is alone. */
static void channels_do_not_disturb_each_other(void) {
    enum { CHANNELS = 9 };
    const enum sample_kind kinds[CHANNELS] = {SAMPLE_BOX,   SAMPLE_PLAIN,  SAMPLE_VALUES,
                                              SAMPLE_BOX,   SAMPLE_BEHIND, SAMPLE_BOX,
                                              SAMPLE_PLAIN, SAMPLE_HAT,    SAMPLE_HAT};

    for (int channels = 2; channels <= CHANNELS; ++channels) {
        decimator *all = decimator_create(3, channels, kinds), *alone[CHANNELS];
        for (int k = 0; k < channels; ++k) {
            alone[k] = decimator_create(3, 1, &kinds[k]);
        }
        for (int j = 0; j < 300; ++j) {
            double values[CHANNELS], got[CHANNELS], expected;
            for (int k = 0; k < channels; ++k) {
                values[k] = sine(0.1 + 0.05 * k, j);
            }
            decimator_push(all, values);
            decimator_values(all, got);

            /* Up to 91 products of numbers up to 1 in another order. */
            for (int k = 0; k < channels; ++k) {
                decimator_push(alone[k], &values[k]);
                decimator_values(alone[k], &expected);
                gm_test_context("%d channels, channel %d, sample %d", channels, k, j);
                GM_ASSERT_ABS(got[k], expected, 1e-14);
            }
        }
        for (int k = 0; k < channels; ++k) {
            decimator_free(alone[k]);
        }
        decimator_free(all);
    }
}

/* However many samples come at a time and have come before: the sum of weights times samples about the row's time. */
static void long_runs_in_any_pieces_are_the_weighted_sum(void) {
    enum { SAMPLES = 4000, FACTOR = 3, AT_ONCE = 11, CHANNELS = 3 };
    const enum sample_kind kinds[CHANNELS] = {SAMPLE_BOX, SAMPLE_PLAIN, SAMPLE_BEHIND};
    static double samples[CHANNELS * SAMPLES];
    decimator *filter = decimator_create(FACTOR, CHANNELS, kinds);
    const int half = decimator_delay(filter);
    uint64_t seed = 9;

    for (int i = 0; i < CHANNELS * SAMPLES; ++i) {
        samples[i] = gm_test_uniform(&seed, -1.0, 1.0);
    }
    for (int done = 0; done + AT_ONCE < SAMPLES;) {
        const int count = gm_test_integer(&seed, 1, AT_ONCE);
        double got[CHANNELS];

        decimator_push_all(filter, count, samples + done, SAMPLES);
        done += count;
        decimator_values(filter, got);
        if (done <= 2 * half) {
            continue;
        }
        for (int k = 0; k < CHANNELS; ++k) {
            const double *first = samples + k * SAMPLES + done - 1 - 2 * half;
            double expected = kinds[k] == SAMPLE_PLAIN ? first[half] : 0.0;
            for (int i = 0; i <= 2 * half && kinds[k] != SAMPLE_PLAIN; ++i) {
                expected += decimator_weights(filter, kinds[k])[i] * first[i];
            }
            /* 91 products of numbers up to 1 in another order. */
            gm_test_context("channel %d, sample %d", k, done);
            GM_ASSERT_ABS(got[k], expected, 1e-14);
        }
    }
    decimator_free(filter);
}

static void factor_one_is_the_identity(void) {
    const enum sample_kind kinds[] = {SAMPLE_VALUES};
    decimator *filter = decimator_create(1, 1, kinds);

    GM_ASSERT_INT(decimator_delay(filter), 0);
    for (int j = 0; j < 100; ++j) {
        const double sample = sine(0.37, j);
        double got;
        decimator_push(filter, &sample);
        decimator_values(filter, &got);
        GM_ASSERT(got == sample);
    }
    decimator_free(filter);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(pass_band_is_flat_and_without_delay),
        GM_TEST(stop_band_is_shut),
        GM_TEST(half_the_rate_is_halved),
        GM_TEST(a_constant_stays),
        GM_TEST(weights_are_symmetric_with_the_sum_one),
        GM_TEST(plain_channels_are_delayed_alike),
        GM_TEST(channels_do_not_disturb_each_other),
        GM_TEST(long_runs_in_any_pieces_are_the_weighted_sum),
        GM_TEST(factor_one_is_the_identity),
    };
    return gm_test_main("gearsim.decimate", tests, GM_TEST_COUNT(tests), argc, argv);
}
