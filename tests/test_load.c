/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/gearsim/load.c: the seeded load torque. */
#include "load.h"

#include "gm_test.h"

static const double interval = 1e-5;

enum { VALUES = 100000 };

static void same_seed_same_numbers(void) {
    const load_signal one = load_create(20.0, 10.0, interval, 7);
    const load_signal two = load_create(20.0, 10.0, interval, 7);

    for (int k = 0; k < 1000; ++k) {
        GM_ASSERT(load_noise_value(&one, k) == load_noise_value(&two, k));
        GM_ASSERT(load_torque(&one, 0.37e-5 * k) == load_torque(&two, 0.37e-5 * k));
    }
}

/* The finaliser of splitmix64 is published with this test vector (Vigna, splitmix64.c, seed 1234567:
 * 6457827717110365317). Ours takes the seed through it first; a changed constant would change every run. */
static void numbers_are_those_of_splitmix64(void) {
    uint64_t state = 5;
    uint64_t stream = gm_test_bits(&state);
    const load_signal load = load_create(0.0, 1.0, interval, 5);

    uint64_t vigna = 1234567;
    GM_ASSERT(gm_test_bits(&vigna) == UINT64_C(6457827717110365317));
    for (int k = 1; k < 100; ++k) {
        /* Value k is the k-th number after the stream's start: 52 bits, centred. */
        const uint64_t bits = gm_test_bits(&stream) >> 12;
        GM_ASSERT(load_noise_value(&load, k) == ((double)bits + 0.5) * 0x1p-51 - 1.0);
    }
}

/* Correlation of two runs of independent values: standard deviation 1 / sqrt(VALUES) = 0.0032. */
static void another_seed_gives_other_numbers(void) {
    const uint64_t seeds[] = {2, 3, UINT64_C(1) << 32, (UINT64_C(1) << 63) + 1, UINT64_MAX};
    const load_signal one = load_create(0.0, 1.0, interval, 1);

    for (size_t i = 0; i < sizeof seeds / sizeof seeds[0]; ++i) {
        const load_signal other = load_create(0.0, 1.0, interval, seeds[i]);
        for (int shift = -2; shift <= 2; ++shift) {
            double product = 0.0;
            for (int k = 0; k < VALUES; ++k) {
                product += load_noise_value(&one, k) * load_noise_value(&other, k + shift);
            }
            gm_test_context("seed %llu, shift %d", (unsigned long long)seeds[i], shift);
            /* Variance of a uniform value is 1/3; five standard deviations. */
            GM_ASSERT_ABS(3.0 * product / VALUES, 0.0, 0.016);
        }
    }
}

/* Mean, variance and neighbours as of independent uniform values, within five standard deviations. */
static void values_are_uniform_and_independent(void) {
    const load_signal load = load_create(0.0, 1.0, interval, 42);
    double sum = 0.0, squares = 0.0, neighbours = 0.0, largest = 0.0;
    int tenths[10] = {0};

    for (int k = 0; k < VALUES; ++k) {
        const double value = load_noise_value(&load, k);
        sum += value;
        squares += value * value;
        neighbours += value * load_noise_value(&load, k + 1);
        largest = fmax(largest, fabs(value));
        ++tenths[(int)(5.0 * (value + 1.0))];
    }
    GM_ASSERT_ABS(sum / VALUES, 0.0, 5.0 * sqrt(1.0 / 3.0 / VALUES));
    GM_ASSERT_ABS(squares / VALUES, 1.0 / 3.0, 5.0 * sqrt(4.0 / 45.0 / VALUES));
    GM_ASSERT_ABS(neighbours / VALUES, 0.0, 5.0 / 3.0 / sqrt(VALUES));
    GM_ASSERT(largest < 1.0);
    /* Not above 0.9995 in so many draws has the probability 0.9995^100000 = 2e-22. */
    GM_ASSERT(largest > 0.9995);
    for (int i = 0; i < 10; ++i) {
        GM_ASSERT_ABS(tenths[i], VALUES / 10, 5.0 * sqrt(0.09 * VALUES));
    }
}

/* time / interval may round down to just below k: then s is 1 to within 1e-13, and so is the value. */
static void torque_passes_through_the_values(void) {
    const load_signal load = load_create(20.0, 10.0, interval, 3);

    for (int k = 0; k < 1000; ++k) {
        const double expected = 20.0 + 10.0 * load_noise_value(&load, k);
        GM_ASSERT_REL(load_torque(&load, k * interval), expected, 1e-12);
    }
}

/*
 * On both sides of a value, at the distance e: value and slope have to agree. The cubic's second
 * derivative is at most 10 amplitudes per interval squared, its third 20; one-sided differences over e
 * are off by that times e.
 */
static void torque_and_its_slope_are_continuous(void) {
    const load_signal load = load_create(0.0, 1.0, 1.0, 3);
    const double e = 1e-6;

    for (int k = -20; k < 1000; ++k) {
        const double before = load_torque(&load, k - e), at = load_torque(&load, k),
                     after = load_torque(&load, k + e);
        const double chord =
            0.5 * (load_noise_value(&load, k + 1) - load_noise_value(&load, k - 1));
        gm_test_context("value %d", k);
        GM_ASSERT_ABS((at - before) / e, chord, 1.5e-5);
        GM_ASSERT_ABS((after - at) / e, chord, 1.5e-5);
    }
}

/* A cubic through values on a straight line is that line: half way between is the mean of all four. */
static void half_way_weights_are_those_of_catmull_rom(void) {
    const load_signal load = load_create(0.0, 1.0, 1.0, 9);

    for (int k = -5; k < 1000; ++k) {
        const double inner = load_noise_value(&load, k) + load_noise_value(&load, k + 1);
        const double outer = load_noise_value(&load, k - 1) + load_noise_value(&load, k + 2);
        /* Some roundings of numbers of size 1. */
        GM_ASSERT_ABS(load_torque(&load, k + 0.5), (9.0 * inner - outer) / 16.0, 1e-14);
    }
}

static void any_order_of_calls_gives_the_same(void) {
    const load_signal load = load_create(1.0, 2.0, interval, 11);
    double forward[500];

    for (int i = 0; i < 500; ++i) {
        forward[i] = load_torque(&load, 1.7e-6 * i);
    }
    for (int i = 499; i >= 0; --i) {
        GM_ASSERT(load_torque(&load, 1.7e-6 * i) == forward[i]);
    }
}

/* The cubic after the one before, the same one again, and any other one: bit for bit. */
static void cubics_one_after_the_other_are_those_alone(void) {
    const load_signal load = load_create(20.0, 10.0, interval, 5);
    noise_values kept = {.is_known = 0};
    uint64_t seed = 6;
    int64_t k = 0;

    for (int i = 0; i < 2000; ++i) {
        double next[4], alone[4];
        load_noise_next(&load, k, &kept, next);
        load_noise_cubic(&load, k, alone);
        gm_test_context("value %d, call %d", (int)k, i);
        GM_ASSERT(memcmp(next, alone, sizeof next) == 0);
        k += i % 5 != 0 ? 1 : gm_test_integer(&seed, -3, 3);
    }
}

static void without_amplitude_it_is_the_mean(void) {
    const load_signal load = load_create(-3.25, 0.0, interval, 1);

    GM_ASSERT(load_torque(&load, 0.0) == -3.25);
    GM_ASSERT(load_torque(&load, 12.345) == -3.25);
}

/*
 * Against Gauss's rule of three points within each piece, which is exact for a cubic times a straight line. The ends
 * lie anywhere; no noise counts before t = 0, while the weight is that of the whole line.
 */
static void integral_is_that_of_the_pieces(void) {
    static const double nodes[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
    static const double shares[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    const load_signal load = load_create(20.0, 10.0, interval, 7);
    noise_piece kept = {0};
    uint64_t seed = 3;

    for (int i = 0; i < 200; ++i) {
        const double from = gm_test_uniform(&seed, -2.0, 8.0) * interval;
        const double to = from + gm_test_uniform(&seed, 0.01, 6.0) * interval;
        const double first = gm_test_uniform(&seed, -1.0, 1.0);
        const double last = gm_test_uniform(&seed, -1.0, 1.0);
        double expected = 0.0;

        for (double begin = fmax(from, 0.0), end; begin < to; begin = end) {
            end = fmin((floor(begin / interval + 1e-9) + 1.0) * interval, to);
            for (int k = 0; k < 3; ++k) {
                const double t = begin + nodes[k] * (end - begin);
                const double weight = first + (last - first) * (t - from) / (to - from);
                expected += shares[k] * (end - begin) * weight * (load_torque(&load, t) - 20.0);
            }
        }
        gm_test_context("from %g to %g", from, to);
        GM_ASSERT_ABS(load_noise_integral(&load, from, to, first, last, &kept), expected,
                      1e-12 * interval);
    }
    GM_ASSERT(load_noise_integral(&load, -3.0 * interval, 0.0, 1.0, 1.0, &kept) == 0.0);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(same_seed_same_numbers),
        GM_TEST(numbers_are_those_of_splitmix64),
        GM_TEST(another_seed_gives_other_numbers),
        GM_TEST(values_are_uniform_and_independent),
        GM_TEST(torque_passes_through_the_values),
        GM_TEST(torque_and_its_slope_are_continuous),
        GM_TEST(half_way_weights_are_those_of_catmull_rom),
        GM_TEST(any_order_of_calls_gives_the_same),
        GM_TEST(cubics_one_after_the_other_are_those_alone),
        GM_TEST(without_amplitude_it_is_the_mean),
        GM_TEST(integral_is_that_of_the_pieces),
    };
    return gm_test_main("gearsim.load", tests, GM_TEST_COUNT(tests), argc, argv);
}
