/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Trace files: what is read, and every text that must be refused. Lines, fields and numbers in general are tested in
 * test_pitch_file.c; all files are read by the same code.
 */
#include "io_test.h"
#include "reference_gear.h"

#define ROLL     "tooth,flank,trace,face_mm,roll_length_mm,deviation_um\n"
#define DIAMETER "tooth,flank,trace,face_mm,diameter_mm,deviation_um\n"

static gm_pair pair;
static gm_traces traces;
static gm_io_error error;

static int read_traces(const char *text) {
    pair = reference_pair(REFERENCE_FACE_WIDTH);
    return gm_traces_read(&traces, file_of(text), &pair, 0, GM_DECIMAL_POINT, &error);
}

static void refused(const char *text, long line, const char *value, const char *right) {
    GM_ASSERT_INT(read_traces(text), GM_IO_ERR_FORMAT);
    assert_error(&error, IO_TEST_PATH("csv"), line, value, right);
    GM_ASSERT(traces.traces == NULL && traces.count == 0 && traces.file[0] == '\0');
}

static void rows_become_traces_in_metres(void) {
    GM_ASSERT_INT(read_traces("\xEF\xBB\xBF# of a machine\r\n" ROLL "# the first\n"
                              "12,left,profile,8.75,9.5,-1.25\n12,left,profile,8.75,11,0.5\n"
                              "12,left,profile,8.755,20.75,3e-1\n\n"
                              "12,left,helix,16,15,1\n12,left,helix,1.5,15,2\n"
                              "7,coast,profile,8.75,9,0\n7,coast,profile,8.75,21,1\n"),
                  GM_IO_OK);
    if (!GM_ASSERT_INT(traces.count, 3)) {
        return;
    }
    GM_ASSERT_STRING(traces.file, IO_TEST_PATH("csv"));
    const gm_trace *profile = &traces.traces[0];
    GM_ASSERT_INT(profile->tooth, 12);
    GM_ASSERT_INT(profile->flank, GM_LEFT);
    GM_ASSERT_INT(profile->kind, GM_TRACE_PROFILE);
    GM_ASSERT_INT(profile->count, 3); /* 5 um off its place is the same trace */
    GM_ASSERT(same_bits(profile->at, 8.75e-3));
    GM_ASSERT(same_bits(profile->position[2], 20.75e-3));
    GM_ASSERT(same_bits(profile->deviation[0], -1.25e-6));
    GM_ASSERT_INT(profile->line[0], 4);
    GM_ASSERT_INT(profile->line[2], 6);
    /* This one ran the other way. */
    const gm_trace *helix = &traces.traces[1];
    GM_ASSERT_INT(helix->kind, GM_TRACE_HELIX);
    GM_ASSERT(same_bits(helix->at, 15e-3));
    GM_ASSERT(same_bits(helix->position[0], 1.5e-3) && same_bits(helix->position[1], 16e-3));
    GM_ASSERT(same_bits(helix->deviation[0], 2e-6));
    GM_ASSERT_INT(helix->line[0], 9);
    GM_ASSERT_INT(traces.traces[2].flank, GM_COAST);
    gm_traces_free(&traces);
    GM_ASSERT(traces.traces == NULL && traces.count == 0);
}

static void a_diameter_is_a_roll_length(void) {
    pair = reference_pair(REFERENCE_FACE_WIDTH);
    char text[400];
    const double base = 2e3 * pair.pinion.base_radius;
    sprintf(text, DIAMETER "1,left,profile,8,%.9f,0\n1,left,profile,8,93.5,1\n", base - 1e-5);
    GM_ASSERT_INT(read_traces(text), GM_IO_OK);
    /* Pythagoras in the triangle of axis, base tangent point and flank point. */
    GM_ASSERT_ABS(traces.traces[0].position[0], 0.0, 1e-12);
    GM_ASSERT_REL(hypot(traces.traces[0].position[1], pair.pinion.base_radius), 93.5e-3 / 2, 1e-14);
    gm_traces_free(&traces);
}

static void a_roll_angle_is_a_roll_length(void) {
    GM_ASSERT_INT(read_traces("tooth,flank,trace,face_mm,roll_angle_deg,deviation_um\n"
                              "1,left,profile,8,18,0\n1,left,profile,8,36,1\n"
                              "1,left,helix,8,20,1\n1,left,helix,9,20,1\n"),
                  GM_IO_OK);
    /* The arc of the base circle that has unwound: a tenth of pi. */
    GM_ASSERT_REL(traces.traces[0].position[0], 0.31415926535897932 * pair.pinion.base_radius,
                  1e-15);
    GM_ASSERT_REL(traces.traces[0].position[1], 2.0 * traces.traces[0].position[0], 1e-15);
    GM_ASSERT_REL(traces.traces[1].at, traces.traces[0].position[0] / 0.9, 1e-15);
    gm_traces_free(&traces);
}

static void numbers_may_have_a_comma_between_semicolons(void) {
    const char *path = file_of("tooth;flank;trace;face_mm;roll_length_mm;deviation_um\n"
                               "1;left;profile; 8,75;9,5 ;-1,25\n1;left;profile;8.75;11;0,5\n");
    pair = reference_pair(REFERENCE_FACE_WIDTH);
    GM_ASSERT_INT(gm_traces_read(&traces, path, &pair, 0, GM_DECIMAL_COMMA, &error), GM_IO_OK);
    GM_ASSERT(same_bits(traces.traces[0].at, 8.75e-3));
    GM_ASSERT(same_bits(traces.traces[0].position[0], 9.5e-3));
    GM_ASSERT(same_bits(traces.traces[0].deviation[0], -1.25e-6));
    gm_traces_free(&traces);

    /* Each style refuses the other, and says that there is one. */
    GM_ASSERT_INT(gm_traces_read(&traces, path, &pair, 0, GM_DECIMAL_POINT, &error),
                  GM_IO_ERR_FORMAT);
    assert_error(&error, path, 1, "got semicolons", "must be separated by commas");
    GM_ASSERT_STRING(error.option, "style");
    path = file_of(ROLL "1,left,profile,8.75,9.5,-1\n");
    GM_ASSERT_INT(gm_traces_read(&traces, path, &pair, 0, GM_DECIMAL_COMMA, &error),
                  GM_IO_ERR_FORMAT);
    assert_error(&error, path, 1, "got commas", "must be separated by semicolons");
}

/* r^2 - r_b^2 would lose all digits here; (r - r_b) (r + r_b) has none to lose. */
static void the_roll_length_next_to_the_base_circle_is_exact(void) {
    pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double base = pair.pinion.base_radius;
    for (int exponent = 0; exponent <= 52; ++exponent) {
        gm_test_context("base radius plus 2^-%d of it", exponent);
        const double radius = base + ldexp(base, -exponent);
        char number[64];
        char text[400];
        snprintf(number, sizeof number, "%.17e", 2.0 * radius);
        sprintf(strchr(number, 'e'), "e%d", atoi(strchr(number, 'e') + 1) + 3); /* mm */
        sprintf(text, DIAMETER "1,left,profile,8,%s,0\n1,left,profile,8,900,1\n", number);
        GM_ASSERT_INT(read_traces(text), GM_IO_OK);
        const long double right =
            sqrtl(((long double)radius - base) * ((long double)radius + base));
        GM_ASSERT_REL(traces.traces[0].position[0], (double)right, 1e-15);
        gm_traces_free(&traces);
    }
}

/* Near the base circle the roll length grows faster than the diameter. */
static void a_diameter_may_wander_as_a_face_may(void) {
    pair = reference_pair(REFERENCE_FACE_WIDTH);
    char text[400];
    const double base = 2e3 * pair.pinion.base_radius;
    sprintf(text, DIAMETER "1,left,helix,1,%.3f,0\n1,left,helix,16,%.3f,1\n", base + 0.1,
            base + 0.109);
    GM_ASSERT_INT(read_traces(text), GM_IO_OK);
    GM_ASSERT_INT(traces.count, 1);
    GM_ASSERT_INT(traces.traces[0].count, 2);
    gm_traces_free(&traces);
    sprintf(text, DIAMETER "1,left,helix,1,%.3f,0\n1,left,helix,16,%.3f,1\n", base + 0.1,
            base + 0.111);
    GM_ASSERT_INT(read_traces(text), GM_IO_OK);
    GM_ASSERT_INT(traces.count, 2);
    gm_traces_free(&traces);
}

static void headers_say_what_is_wrong(void) {
    refused("tooth,flank,trace,face_mm,roll_length_mm,deviation\n", 1, "'deviation' has no unit",
            "deviation_um");
    refused("tooth,flank,trace,face_mm,roll_length_mm,deviation_mm\n", 1, "'deviation_mm'",
            "deviation_um");
    refused("tooth,flank,trace,face,diameter_mm,deviation_um\n", 1, "'face'", "face_mm");
    refused("tooth,flank,trace,face_mm,diameter,deviation_um\n", 1, "'diameter'", "diameter_mm");
    refused("tooth,flank,trace,face_mm,roll_length,deviation_um\n", 1, "'roll_length'",
            "roll_length_mm");
    refused("tooth,flank,trace,face_mm,roll_length_mm (involute),deviation_um\n", 1,
            "'roll_length_mm (involute)'", "roll_length_mm");
    refused("tooth;flank;trace;face_mm;diameter_mm;deviation_um\n", 1, "semicolons", "commas");
    refused("tooth\tflank\n", 1, "tabs", "commas");
    refused("tooth,flank,t1,t2,deviation_um\n", 1, "'tooth,flank,t1,t2,deviation_um'",
            "roll_angle_deg,deviation_um (got");
    refused("1,left,profile,8,9,0\n", 1, "got the row '1,left,profile,8,9,0'",
            "the header must be tooth");
    refused("", 0, "got nothing", "header line tooth,flank,trace");
}

static void rows_say_what_is_wrong(void) {
    refused(ROLL, 1, "(got none)", "must be rows");
    refused(ROLL "1,left,profile,8,9\n", 2, "(got 5", "must have 6 fields");
    refused(ROLL "1,left,profile,8,9,1,5\n", 2, "(got 7", "write 1.5");
    refused(ROLL "1;left;profile;8;9;1\n", 2, "semicolons", "commas");
    refused(ROLL "1.0,left,profile,8,9,0\n", 2, "'1.0'", "a whole number");
    refused(ROLL "*,left,profile,8,9,0\n", 2, "'*'", "a whole number");
    refused(ROLL "1,L,profile,8,9,0\n", 2, "'L'", "flank: must be drive, coast, left or right");
    refused(ROLL "1,left,lead,8,9,0\n", 2, "'lead'", "trace: must be profile or helix");
    refused(ROLL "1,left,profile,x,9,0\n", 2, "got 'x'", "face_mm: must be a number");
    refused(ROLL "1,left,profile,8,,0\n", 2, "got ''", "roll_length_mm: must be a number");
    refused(ROLL "1,left,profile,8,9,nan\n", 2, "'nan'", "a number");
    refused(ROLL "1,left,profile,8,9,1e999\n", 2, "too large", "a number");
    refused(DIAMETER "1,left,profile,8,80,0\n", 2, "'80'", "(base circle) to 93.87678 (tip)");
    refused(DIAMETER "1,left,profile,8,9.3,0\n", 2, "'9.3'", "centimetres");
    refused(DIAMETER "1,left,profile,8,46,0\n", 2, "'46'", "a radius");
    refused(DIAMETER "1,left,profile,8,-92,0\n", 2, "'-92'", "(base circle)");
}

static void a_trace_goes_one_way(void) {
    refused(ROLL "3,left,profile,8,9,0\n3,left,profile,8,10,0\n3,left,profile,8,9.5,0\n", 4,
            "got '9.5'; are there", "two teeth with the number 3?");
    refused(ROLL "3,left,helix,8,9,0\n3,left,helix,7,9,0\n3,left,helix,7,9,0\n", 4, "got '7'",
            "face_mm: must go on from the row before");
    refused(DIAMETER "3,left,profile,8,90,0\n3,left,profile,8,91,0\n3,left,profile,8,90,0\n", 4,
            "got '90'", "diameter_mm: must go on from the row before");
}

static void bad_calls_are_refused(void) {
    GM_ASSERT_INT(gm_traces_read(NULL, "x.csv", &pair, 0, GM_DECIMAL_POINT, &error),
                  GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_traces_read(&traces, NULL, &pair, 0, GM_DECIMAL_POINT, NULL), GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_traces_read(&traces, "x.csv", NULL, 0, GM_DECIMAL_POINT, &error),
                  GM_IO_ERR_NULL);
    GM_ASSERT_INT(
        gm_traces_read(&traces, IO_TEST_PATH("is not there"), &pair, 0, GM_DECIMAL_POINT, &error),
        GM_IO_ERR_FILE);
    GM_ASSERT_STRING(error.file, IO_TEST_PATH("is not there"));
    gm_traces_free(NULL);
    gm_measured_pitch_free(NULL);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(rows_become_traces_in_metres),
        GM_TEST(a_diameter_is_a_roll_length),
        GM_TEST(a_roll_angle_is_a_roll_length),
        GM_TEST(numbers_may_have_a_comma_between_semicolons),
        GM_TEST(the_roll_length_next_to_the_base_circle_is_exact),
        GM_TEST(a_diameter_may_wander_as_a_face_may),
        GM_TEST(headers_say_what_is_wrong),
        GM_TEST(rows_say_what_is_wrong),
        GM_TEST(a_trace_goes_one_way),
        GM_TEST(bad_calls_are_refused),
    };
    return gm_test_main("unit.trace_file", tests, GM_TEST_COUNT(tests), argc, argv);
}
