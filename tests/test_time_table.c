/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/gearsim/time_table.c: values, slopes, integrals and rows of a table over time. */
#include "time_table.h"

#include "gm_test.h"

#include <stdlib.h>
#include <unistd.h>

static const double rad_per_s = 3.14159265358979323846 / 30.0; /* of 1 rpm */

/* A load of these rows; freed by close_table(). */
static config open_table(const char *rows, enum table_interpolation interpolation,
                         enum table_repeat repeat) {
    char path[] = "/tmp/gearmesh_table_XXXXXX";
    const int descriptor = mkstemp(path);
    FILE *file = fdopen(descriptor, "w");
    fprintf(file, "time_s,torque_Nm\n%s", rows);
    fclose(file);

    config conf = {.analysis = ANALYSIS_DYNAMIC,
                   .purpose = CONFIG_FOR_RUN,
                   .duration = 0.1,
                   .load_file = path,
                   .load_interpolation = interpolation,
                   .load_repeat = repeat};
    GM_ASSERT_INT(time_tables_read(&conf), 0);
    GM_ASSERT(conf.load_table != NULL && conf.drive_table == NULL);
    unlink(path);
    conf.load_file = NULL;
    return conf;
}

static void close_table(config *conf) {
    time_tables_free(conf);
    GM_ASSERT(conf->load_table == NULL);
}

/* -1 s: 2, 1 s: 6, step to 10, 3 s: 4. */
static void lines_and_steps_are_as_written(void) {
    config conf = open_table("-1,2\n1,6\n1,10\n3,4\n", INTERPOLATION_LINEAR, REPEAT_OFF);
    const time_table *table = conf.load_table;

    /* The value at 0 is kept before it, the last one behind the end; the later row of a step counts at its time. */
    const double at[][3] = {{-5.0, 4.0, 0.0}, {0.0, 4.0, 2.0}, {0.5, 5.0, 2.0}, {1.0, 10.0, -3.0},
                            {2.0, 7.0, -3.0}, {3.0, 4.0, 0.0}, {9.0, 4.0, 0.0}};
    for (size_t i = 0; i < sizeof at / sizeof at[0]; ++i) {
        gm_test_context("t = %g", at[i][0]);
        GM_ASSERT_ABS(time_table_value(table, at[i][0]), at[i][1], 1e-14);
        if (at[i][0] >= 0.0) {
            GM_ASSERT_ABS(time_table_slope(table, at[i][0]), at[i][2], 1e-14);
        }
    }

    /* From 0 on: 4 t + t^2; 5 at the step, then 10 s - 1.5 s^2; 14 more to the end, then 4 per second. */
    GM_ASSERT_ABS(time_table_integral(table, -2.0), -8.0, 1e-14);
    GM_ASSERT_ABS(time_table_integral(table, 0.0), 0.0, 1e-14);
    GM_ASSERT_ABS(time_table_integral(table, 0.5), 2.25, 1e-14);
    GM_ASSERT_ABS(time_table_integral(table, 2.0), 5.0 + 8.5, 1e-14);
    GM_ASSERT_ABS(time_table_integral(table, 5.0), 5.0 + 14.0 + 8.0, 1e-14);
    GM_ASSERT_ABS(time_table_largest(table), 10.0, 0.0);

    /* Rows behind a time, and where the solver starts again: at the step, and where the slope of a speed would change. */
    int is_kink = -1;
    GM_ASSERT_ABS(time_table_next_row(table, 0.0, &is_kink), 1.0, 0.0);
    GM_ASSERT_INT(is_kink, 1);
    GM_ASSERT_ABS(time_table_next_row(table, 1.0, &is_kink), 3.0, 0.0);
    GM_ASSERT(!isfinite(time_table_next_row(table, 3.0, &is_kink)));
    close_table(&conf);
}

/* Weights w0 .. w1 along a straight line: the integral of the table times them, across the step and before t = 0. */
static void weighted_integrals_are_exact(void) {
    config conf = open_table("-1,2\n1,6\n1,10\n3,4\n", INTERPOLATION_LINEAR, REPEAT_OFF);

    /* From 0.5 to 1.5 with weights 0 .. 1, s = t - 0.5: int (5 + 2 s) s over 0 .. 0.5 = 0.70833.., and
       int (10 - 3 (s - 0.5)) s over 0.5 .. 1 = 3.75 - 3 (0.291666.. - 0.1875) = 3.4375. */
    GM_ASSERT_REL(time_table_weighted(conf.load_table, 0.5, 1.5, 0.0, 1.0),
                  5.0 / 8.0 + 2.0 / 24.0 + 3.4375, 1e-14);

    /* Held at 4 before 0: int 4 (t + 1) / 2 over -1 .. 0 = 1, and int (4 + 2 t) (t + 1) / 2 over 0 .. 1 = 23 / 6. */
    GM_ASSERT_REL(time_table_weighted(conf.load_table, -1.0, 1.0, 0.0, 1.0), 1.0 + 23.0 / 6.0,
                  1e-14);
    close_table(&conf);
}

/* Three neighbours give a parabola its own slope, so that every piece is that parabola: 1 + 2 t - 3 t^2. */
static void cubics_go_through_parabolas(void) {
    char rows[200] = "";
    const double times[] = {-0.2, 0.0, 0.3, 0.35, 0.9, 1.4};
    for (int i = 0; i < 6; ++i) {
        const double t = times[i];
        snprintf(rows + strlen(rows), sizeof rows - strlen(rows), "%.17g,%.17g\n", t,
                 1.0 + 2.0 * t - 3.0 * t * t);
    }
    config conf = open_table(rows, INTERPOLATION_CUBIC, REPEAT_OFF);
    for (double t = 0.0; t < 1.39; t += 0.013) {
        gm_test_context("t = %g", t);
        GM_ASSERT_ABS(time_table_value(conf.load_table, t), 1.0 + 2.0 * t - 3.0 * t * t, 1e-13);
        GM_ASSERT_ABS(time_table_slope(conf.load_table, t), 2.0 - 6.0 * t, 1e-12);
        GM_ASSERT_ABS(time_table_integral(conf.load_table, t), t + t * t - t * t * t, 1e-13);
        GM_ASSERT(time_table_curvature(conf.load_table, t) > 6.0 - 1e-9);
    }
    close_table(&conf);
}

/* What flights and steps rely on: nothing goes beyond the bounds until the next row. */
static void bounds_hold(void) {
    const char rows[] = "0,3\n0.03,20\n0.05,-5\n0.09,-4.5\n0.13,30\n0.2,3\n";
    for (int cubic = 0; cubic < 2; ++cubic) {
        config conf = open_table(rows, cubic ? INTERPOLATION_CUBIC : INTERPOLATION_LINEAR,
                                 cubic ? REPEAT_ON : REPEAT_OFF);
        const time_table *table = conf.load_table;
        const double largest = time_table_largest(table);
        double highest = 0.0;

        for (double t = 0.0; t < 0.2; t += 1e-5) {
            int is_kink;
            const double row = time_table_next_row(table, t, &is_kink);
            const double steepest = time_table_steepest(table, t);
            const double curved = time_table_curvature(table, t);
            gm_test_context("cubic %d, t = %g", cubic, t);
            highest = fmax(highest, fabs(time_table_value(table, t)));
            GM_ASSERT(fabs(time_table_slope(table, t)) <= steepest * (1.0 + 1e-12));
            const double later = fmin(t + 1e-6, row);
            const double bend = time_table_slope(table, later) - time_table_slope(table, t);
            if (later < row) {
                GM_ASSERT(fabs(bend) <= curved * (later - t) * (1.0 + 1e-6) + 1e-9);
            }
        }
        gm_test_context("cubic %d: %g of %g", cubic, highest, largest);
        GM_ASSERT(highest <= largest * (1.0 + 1e-12));
        GM_ASSERT(highest > largest * (1.0 - 1e-4)); /* of a parabola, half a step from its top */
        GM_ASSERT(cubic ? largest > 30.1 : largest == 30.0);
        close_table(&conf);
    }
}

static void a_repeated_table_begins_again(void) {
    config conf = open_table("-0.5,1\n0.5,3\n1.5,2\n", INTERPOLATION_LINEAR, REPEAT_ON);
    const time_table *table = conf.load_table;

    /* Period 2 s: 2 at 0, 3 at 0.5, 2 at 1.5 and a step to 1, 2 again at 2. */
    for (int k = 0; k < 4; ++k) {
        const double begin = 2.0 * k;
        gm_test_context("period %d", k);
        GM_ASSERT_ABS(time_table_value(table, begin), 2.0, 1e-13);
        GM_ASSERT_ABS(time_table_value(table, begin + 0.5), 3.0, 1e-13);
        GM_ASSERT_ABS(time_table_value(table, begin + 1.0), 2.5, 1e-13);
        GM_ASSERT_ABS(time_table_value(table, begin + 1.5), 1.0, 1e-13);

        /* 2 + 2.5 in a period: means 2.5 from 0 to 0.5, 2.5 to 1.5, 1.5 to 2. */
        GM_ASSERT_ABS(time_table_integral(table, begin), 4.5 * k, 1e-12);
        GM_ASSERT_ABS(time_table_integral(table, begin + 0.5), 4.5 * k + 1.25, 1e-12);
        int is_kink = 0;
        GM_ASSERT_ABS(time_table_next_row(table, begin + 1.0, &is_kink), begin + 1.5, 1e-12);
        GM_ASSERT_INT(is_kink, 1);
    }
    close_table(&conf);
}

/* rpm in the file, rad/s inside. */
static void speeds_are_in_rad_per_s(void) {
    char path[] = "/tmp/gearmesh_table_XXXXXX";
    FILE *file = fdopen(mkstemp(path), "w");
    fprintf(file, "time_s,speed_rpm\n0,300\n1,900\n");
    fclose(file);
    config conf = {.analysis = ANALYSIS_DYNAMIC,
                   .purpose = CONFIG_FOR_RUN,
                   .drive = DRIVE_SPEED,
                   .duration = 0.1,
                   .drive_file = path};
    GM_ASSERT_INT(time_tables_read(&conf), 0);
    GM_ASSERT_REL(time_table_value(conf.drive_table, 0.5), 600.0 * rad_per_s, 1e-15);
    GM_ASSERT_REL(time_table_integral(conf.drive_table, 1.0), 600.0 * rad_per_s, 1e-15);
    unlink(path);
    conf.drive_file = NULL;
    time_tables_free(&conf);

    /* A static run, and what only asks for the drawing, open no table. */
    conf.drive_file = path;
    conf.analysis = ANALYSIS_STATIC;
    GM_ASSERT_INT(time_tables_read(&conf), 0);
    GM_ASSERT(conf.drive_table == NULL);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(lines_and_steps_are_as_written), GM_TEST(weighted_integrals_are_exact),
        GM_TEST(cubics_go_through_parabolas),    GM_TEST(bounds_hold),
        GM_TEST(a_repeated_table_begins_again),  GM_TEST(speeds_are_in_rad_per_s),
    };
    return gm_test_main("gearsim.time_table", tests, GM_TEST_COUNT(tests), argc, argv);
}
