/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file gm_test.h
 * What every test of this project shares: assertions that say by how much they failed, a table of
 * tests as the suite, random numbers that are the same on every machine.
 *
 *     static void backlash_is_symmetric(void) { GM_ASSERT_REL(got, expected, 1e-12); }
 *
 *     int main(int argc, char **argv) {
 *         static const gm_test tests[] = {GM_TEST(backlash_is_symmetric)};
 *         return gm_test_main("unit.pair", tests, GM_TEST_COUNT(tests), argc, argv);
 *     }
 *
 * The program runs all tests, or those whose names are its arguments, and returns 0 or 1.
 */
#ifndef GM_TEST_H
#define GM_TEST_H

#include <CUnit/Basic.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shared.h"

#if defined(__GNUC__)
#define GM_TEST_PRINTF(text, first) __attribute__((format(printf, text, first)))
#define GM_TEST_UNUSED              __attribute__((unused))
#else
#define GM_TEST_PRINTF(text, first)
#define GM_TEST_UNUSED
#endif

/* ---------------------------------------------------------------------------------------------
 * Context: which case of a loop is being tested. Shown in front of every failure.
 * ------------------------------------------------------------------------------------------- */

static char gm_test_context_text[160];

/** Names the case under test, as printf does. Cleared before every test. */
GM_TEST_UNUSED GM_TEST_PRINTF(1, 2) static void gm_test_context(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(gm_test_context_text, sizeof gm_test_context_text, format, arguments);
    va_end(arguments);
}

/** Reports one assertion to CUnit; returns whether it held. */
GM_TEST_UNUSED GM_TEST_PRINTF(4, 5) static int gm_test_report(int passed, const char *file,
                                                              int line, const char *format, ...) {
    char text[640];
    int used = 0;
    if (gm_test_context_text[0] != '\0') {
        used = snprintf(text, sizeof text, "[%s] ", gm_test_context_text);
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, sizeof text - (size_t)used, format, arguments);
    va_end(arguments);
    CU_assertImplementation(passed ? CU_TRUE : CU_FALSE, (unsigned)line, text, file, "", CU_FALSE);
    return passed;
}

/* ---------------------------------------------------------------------------------------------
 * Assertions. All are values (whether they held), so that a loop can stop at the first failure.
 * ------------------------------------------------------------------------------------------- */

/** Largest difference allowed: relative * |expected| + absolute. NaN never passes. */
GM_TEST_UNUSED static int gm_test_near(double got, double expected, double relative,
                                       double absolute, const char *what, const char *file,
                                       int line) {
    const double difference = got - expected;
    const double tolerance = relative * fabs(expected) + absolute;
    const int passed = (got == expected) || (isfinite(expected) && fabs(difference) <= tolerance);
    return gm_test_report(passed, file, line,
                          "%s: got %.17g, expected %.17g, difference %.3g, tolerance %.3g", what,
                          got, expected, difference, tolerance);
}

GM_TEST_UNUSED static int gm_test_int(long long got, long long expected, const char *what,
                                      const char *file, int line) {
    return gm_test_report(got == expected, file, line, "%s: got %lld, expected %lld", what, got,
                          expected);
}

GM_TEST_UNUSED static int gm_test_string(const char *got, const char *expected, const char *what,
                                         const char *file, int line) {
    const int passed =
        (got == expected) || (got != NULL && expected != NULL && strcmp(got, expected) == 0);
    return gm_test_report(passed, file, line, "%s: got \"%s\", expected \"%s\"", what,
                          got != NULL ? got : "(null)", expected != NULL ? expected : "(null)");
}

#define GM_ASSERT(condition)                                                                       \
    gm_test_report((condition) ? 1 : 0, __FILE__, __LINE__, "%s", #condition)
#define GM_ASSERT_NEAR(got, expected, relative, absolute)                                          \
    gm_test_near((got), (expected), (relative), (absolute), #got, __FILE__, __LINE__)
#define GM_ASSERT_REL(got, expected, relative) GM_ASSERT_NEAR(got, expected, relative, 0.0)
#define GM_ASSERT_ABS(got, expected, absolute) GM_ASSERT_NEAR(got, expected, 0.0, absolute)
#define GM_ASSERT_INT(got, expected)                                                               \
    gm_test_int((long long)(got), (long long)(expected), #got, __FILE__, __LINE__)
#define GM_ASSERT_STRING(got, expected) gm_test_string((got), (expected), #got, __FILE__, __LINE__)
#define GM_ASSERT_NAN(got)                                                                         \
    gm_test_report(isnan(got) ? 1 : 0, __FILE__, __LINE__, "%s: got %.17g, expected NaN", #got,    \
                   (double)(got))

/**
 * Opens a file of the sources for reading. Without it the test fails and ends there: paths begin at the folder tests/,
 * in which ctest starts the programs.
 */
GM_TEST_UNUSED static FILE *gm_test_open(const char *path) {
    FILE *file = fopen(path, "r");
    if (!gm_test_report(file != NULL, __FILE__, __LINE__,
                        "%s: cannot be read: start the program in the folder tests/", path)) {
        CU_FAIL_FATAL("without its file a test has nothing to say");
    }
    return file;
}

/* ---------------------------------------------------------------------------------------------
 * Random numbers: the same sequence from the same seed on every machine.
 * ------------------------------------------------------------------------------------------- */

GM_TEST_UNUSED static uint64_t gm_test_bits(uint64_t *seed) {
    return gmi_random_bits(seed);
}

/** Uniform in [low, high). */
GM_TEST_UNUSED static double gm_test_uniform(uint64_t *seed, double low, double high) {
    return low + (high - low) * gmi_random_unit(seed);
}

/** Uniform integer in low .. high, both included. */
GM_TEST_UNUSED static int gm_test_integer(uint64_t *seed, int low, int high) {
    const uint64_t count = (uint64_t)(high - low) + 1;
    return low + (int)(gm_test_bits(seed) % count);
}

/* ---------------------------------------------------------------------------------------------
 * Suite
 * ------------------------------------------------------------------------------------------- */

typedef struct gm_test {
    const char *name; /**< a claim: backlash_is_symmetric */
    void (*function)(void);
} gm_test;

#define GM_TEST(function)                                                                          \
    { #function, function }
#define GM_TEST_COUNT(tests) (sizeof(tests) / sizeof((tests)[0]))

/* CUnit hands a test nothing, so the clearing of the context is a set-up function. */
GM_TEST_UNUSED static void gm_test_set_up(void) {
    gm_test_context_text[0] = '\0';
}

static int gm_test_wanted(const char *name, int argc, char **argv) {
    for (int i = 1; i < argc; ++i) {
        if (strcmp(argv[i], name) == 0) {
            return 1;
        }
    }
    return argc <= 1;
}

/** Runs the tests; 0 if all ran and passed, else 1. A run without any assertion fails. */
GM_TEST_UNUSED static int gm_test_main(const char *suite_name, const gm_test *tests, size_t count,
                                       int argc, char **argv) {
    if (CU_initialize_registry() != CUE_SUCCESS) {
        fprintf(stderr, "%s: CUnit does not start\n", suite_name);
        return 1;
    }
    CU_pSuite suite =
        CU_add_suite_with_setup_and_teardown(suite_name, NULL, NULL, gm_test_set_up, NULL);
    int added = suite != NULL;
    for (size_t i = 0; added && i < count; ++i) {
        if (gm_test_wanted(tests[i].name, argc, argv)) {
            added = CU_add_test(suite, tests[i].name, tests[i].function) != NULL;
        }
    }
    int passed = 0;
    if (added) {
        CU_basic_set_mode(CU_BRM_VERBOSE);
        CU_basic_run_tests();
        passed = CU_get_number_of_asserts() > 0 && CU_get_number_of_failures() == 0 &&
                 CU_get_number_of_failure_records() == 0;
    }
    CU_cleanup_registry();
    return passed ? 0 : 1;
}

#endif /* GM_TEST_H */
