/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/common/ripple.c: how harmonics are read, and their sum. */
#include "ripple.h"

#include "gm_test.h"

static const double degree = 3.14159265358979323846 / 180.0;

static void harmonics_are_read(void) {
    ripple made;
    char fault[200];

    GM_ASSERT_INT(ripple_parse(&made, "2:5:0", fault, sizeof fault), 0);
    GM_ASSERT_INT(made.count, 1);
    GM_ASSERT(made.harmonics[0].order == 2.0 && made.harmonics[0].amplitude == 5.0 &&
              made.harmonics[0].phase == 0.0);

    /* Blanks, halves of an order, negative amplitudes and phases. */
    GM_ASSERT_INT(
        ripple_parse(&made, " 0.5 : -1.5e2 : -90 ,4:0:720,\t1e1:+3:.5", fault, sizeof fault), 0);
    GM_ASSERT_INT(made.count, 3);
    GM_ASSERT(made.harmonics[0].order == 0.5 && made.harmonics[0].amplitude == -150.0);
    GM_ASSERT_REL(made.harmonics[0].phase, -90.0 * degree, 1e-15);
    GM_ASSERT(made.harmonics[2].order == 10.0 && made.harmonics[2].amplitude == 3.0);
    GM_ASSERT_REL(made.harmonics[2].phase, 0.5 * degree, 1e-15);
    GM_ASSERT_REL(ripple_highest_order(&made), 10.0, 0.0);
}

static void what_is_no_ripple_is_refused(void) {
    static const char form[] = "must be ORDER:AMPLITUDE:PHASE_DEG";
    static const char order[] = "must be harmonics of an order above 0";
    static const struct {
        const char *text, *fault;
    } wrong[] = {
        {"", form},
        {",", form},
        {"2", form},
        {"2:5", form},
        {"2:5:0:1", form},
        {"2:5:0,", form},
        {"2:5:0,,1:1:1", form},
        {"2:5:x", form},
        {"2;5;0", form},
        {"nan:5:0", form},
        {"2:inf:0", form},
        {"0x2:5:0", form},
        {"2:5:0 3:1:0", form},
        {"0:5:0", order},
        {"1:1:0,0:5:0", order},
        {"-1:5:0", order},
        {"10001:5:0", order},
        {"1e400:5:0", order},
        {"1:1.01e12:0", "must be amplitudes within"},
        {"1:1:1.01e6", "must be amplitudes within"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
        ripple made;
        char fault[200] = "";
        gm_test_context("%s", wrong[i].text);
        GM_ASSERT_INT(ripple_parse(&made, wrong[i].text, fault, sizeof fault), -1);
        GM_ASSERT(strncmp(fault, wrong[i].fault, strlen(wrong[i].fault)) == 0);
    }

    /* The harmonic at fault is named, and there is room for so many only. */
    ripple made;
    char fault[200], many[400] = "1:1:0";
    GM_ASSERT_INT(ripple_parse(&made, "1:1:0, 0:5:0", fault, sizeof fault), -1);
    GM_ASSERT(strstr(fault, "(got 0:5:0)") != NULL);
    GM_ASSERT_INT(ripple_parse(&made, "1:1:0,", fault, sizeof fault), -1);
    GM_ASSERT(strstr(fault, "(got nothing)") != NULL);
    for (int i = 1; i < RIPPLE_HARMONICS; ++i) {
        strcat(many, ",1:1:0");
    }
    GM_ASSERT_INT(ripple_parse(&made, many, fault, sizeof fault), 0);
    GM_ASSERT_INT(made.count, RIPPLE_HARMONICS);
    strcat(many, ",1:1:0");
    GM_ASSERT_INT(ripple_parse(&made, many, fault, sizeof fault), -1);
    GM_ASSERT(strstr(fault, "32 harmonics at most") != NULL);
}

static void sum_and_slope_are_those_of_sines(void) {
    const ripple made = {2, {{2.0, 3.0, 0.25}, {0.5, -1.0, 0.0}}};
    const ripple twice = ripple_scaled(&made, 2.0);

    for (double angle = -7.0; angle < 7.0; angle += 0.37) {
        const double value = 3.0 * sin(2.0 * angle + 0.25) - sin(0.5 * angle);
        const double slope = 6.0 * cos(2.0 * angle + 0.25) - 0.5 * cos(0.5 * angle);
        GM_ASSERT_ABS(ripple_value(&made, angle), value, 1e-14);
        GM_ASSERT_ABS(ripple_slope(&made, angle), slope, 1e-14);
        GM_ASSERT_ABS(ripple_value(&twice, angle), 2.0 * value, 1e-14);
    }
    GM_ASSERT_ABS(ripple_largest(&made, 0), 4.0, 1e-15);
    GM_ASSERT_ABS(ripple_largest(&made, 1), 6.5, 1e-15);
    GM_ASSERT_ABS(ripple_largest(&made, 2), 12.25, 1e-14);

    const ripple none = {.count = 0};
    GM_ASSERT(ripple_value(&none, 1.0) == 0.0 && ripple_slope(&none, 1.0) == 0.0);
    GM_ASSERT(ripple_largest(&none, 0) == 0.0 && ripple_highest_order(&none) == 0.0);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(harmonics_are_read),
        GM_TEST(what_is_no_ripple_is_refused),
        GM_TEST(sum_and_slope_are_those_of_sines),
    };
    return gm_test_main("gearsim.ripple", tests, GM_TEST_COUNT(tests), argc, argv);
}
