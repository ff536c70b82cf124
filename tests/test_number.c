/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/common/number.c: the same text as printf("%.*g"), for any value and number of digits. */
#include "number.h"

#include "gm_test.h"

#include <float.h>

/* Returns whether it was the same, so that a loop of a million ends at the first difference. */
static int same_as_printf(double value, int digits) {
    char expected[64], got[NUMBER_TEXT_SIZE];

    snprintf(expected, sizeof expected, "%.*g", digits, value);
    const int length = number_format(got, value, digits);

    gm_test_context("%.17g with %d digits", value, digits);
    return GM_ASSERT_STRING(got, expected) && GM_ASSERT_INT(length, strlen(expected));
}

static void special_values_are_written_as_printf_does(void) {
    const double values[] = {0.0,
                             -0.0,
                             1.0,
                             -1.0,
                             0.1,
                             1e-5,
                             1e-4,
                             1e15,
                             1e16,
                             1e17,
                             123456.0,
                             0.5,
                             2.5,
                             1.125,
                             0.0625,
                             999.9996,
                             9.9999999999,
                             99999.5,
                             1e20,
                             1e21,
                             1e-20,
                             1e-21,
                             DBL_MAX,
                             DBL_MIN,
                             4.9e-324,
                             1e22,
                             1e23,
                             9007199254740993.0,
                             (double)INFINITY,
                             -(double)INFINITY,
                             0.30000000000000004,
                             5e-324,
                             1.0 / 3.0,
                             -2.0 / 3.0};

    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        for (int digits = 1; digits <= 17; ++digits) {
            if (!same_as_printf(values[i], digits)) {
                return;
            }
        }
    }
    char text[NUMBER_TEXT_SIZE];
    number_format(text, (double)NAN, 10);
    GM_ASSERT(strstr(text, "nan") != NULL);
}

/* Powers of ten and their neighbours: where a guess of the exponent goes wrong, and 9.99.. becomes 10. */
static void around_powers_of_ten(void) {
    for (int power = -25; power <= 25; ++power) {
        double value = pow(10.0, power);
        for (int i = 0; i < 5; ++i) {
            value = nextafter(value, 0.0);
        }
        for (int i = 0; i < 10; ++i, value = nextafter(value, (double)INFINITY)) {
            for (int digits = 1; digits <= 17; ++digits) {
                if (!same_as_printf(value, digits) || !same_as_printf(-value, digits)) {
                    return;
                }
            }
        }
    }
}

/* Exact ties (k + 1/2 with few bits), which printf rounds to even. */
static void ties_are_rounded_as_printf_does(void) {
    for (int k = 0; k < 3000; ++k) {
        for (int digits = 1; digits <= 6; ++digits) {
            if (!same_as_printf(k + 0.5, digits) || !same_as_printf((k + 0.5) / 1024.0, digits)) {
                return;
            }
        }
    }
}

/* All exponents that a result can have, all numbers of digits. */
static void random_values_are_written_as_printf_does(void) {
    uint64_t seed = 1;

    for (int i = 0; i < 300000; ++i) {
        const double value =
            gm_test_uniform(&seed, -1.0, 1.0) * pow(10.0, gm_test_integer(&seed, -22, 22));
        if (!same_as_printf(value, gm_test_integer(&seed, 1, 17))) {
            return;
        }
    }
}

/* Numbers as people write them: with few digits, so that the rest is exactly zero or a tie. */
static void short_decimals_are_written_as_printf_does(void) {
    uint64_t seed = 2;

    for (int i = 0; i < 300000; ++i) {
        const double value =
            gm_test_integer(&seed, 0, 1000000) / pow(10.0, gm_test_integer(&seed, 0, 12));
        if (!same_as_printf(value, gm_test_integer(&seed, 1, 17))) {
            return;
        }
    }
}

/* Times of rows: often with one digit more than are wanted, so that they are a tie but for the rounding of the double. */
static void times_of_rows(void) {
    for (int row = 0; row < 40000; ++row) {
        const double time = row * 13 / 25600.0;
        for (int digits = 6; digits <= 10; ++digits) {
            if (!same_as_printf(time, digits)) {
                return;
            }
        }
    }
}

/* Each length of the figures, with the point at each of their places. */
static void every_place_of_the_point(void) {
    for (int count = 1; count <= 12; ++count) {
        const double figures = floor(123406789012.0 / pow(10.0, 12 - count));
        for (int places = -2; places <= 16; ++places) {
            const double value =
                places < 0 ? figures * pow(10.0, -places) : figures / pow(10.0, places);
            for (int digits = 1; digits <= 17; ++digits) {
                if (!same_as_printf(value, digits) || !same_as_printf(-value, digits)) {
                    return;
                }
            }
        }
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(special_values_are_written_as_printf_does),
        GM_TEST(around_powers_of_ten),
        GM_TEST(ties_are_rounded_as_printf_does),
        GM_TEST(random_values_are_written_as_printf_does),
        GM_TEST(short_decimals_are_written_as_printf_does),
        GM_TEST(times_of_rows),
        GM_TEST(every_place_of_the_point),
    };
    return gm_test_main("gearsim.number", tests, GM_TEST_COUNT(tests), argc, argv);
}
