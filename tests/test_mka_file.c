/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Text files of Klingelnberg machines: made here after the grammar of docs/measured-flanks.md, of the gear pair with 21
 * and 30 teeth below. Where the points of a trace lie follows from the definition of the roll length alone.
 */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gearmesh/gearmesh_io.h>

#include "gm_test.h"
#include "io_test.h"

static const double pi = 3.14159265358979323846;

static gm_pair pair;
static gm_io_error error;
static gm_traces traces;
static gm_measured_pitch pitch;

static void make_pair(void) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 21;
    params.wheel_teeth = 30;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = 20 * pi / 180;
    params.helix_angle = 15.5 * pi / 180;
    params.center_distance = 53e-3;
    params.face_width = 12e-3;
    if (gm_pair_init(&pair, &params) != GM_OK) {
        exit(1);
    }
}

/* The header of that pinion; the hand is that of the second argument. */
#define HEADER(teeth, hand)                                                                        \
    "HEADER KS.MK.FILE\r\nTYPE STI\r\nUNITS mm\r\nPROFILE diameter\r\n"                            \
    "UNDEFINED -2147483.648 ! Undefined\r\nFILTER LEAD:    F:S 2\r\n\r\n"                          \
    "  7 :ME/Seite/KS/LZ....................: A-1\r\n"                                             \
    " 21 :Normalmodul mn [mm]................: 2.000\r\n"                                          \
    " 22 :Z\xE4hnezahl z.......................: " teeth "  Au\xDF"                                \
    "enverzahnung\r\n"                                                                             \
    " 23 :Schr\xC3\xA4gungswinkel..................: 15\xC2\xB0"                                   \
    "30'00\"  " hand "\r\n"                                                                        \
    " 24 :Eingriffswinkel...................: 20\xB0"                                              \
    "00'00\"\r\n"                                                                                  \
    " 41 :Start Messbereich da [mm].: 42.000 42.500\r\n"                                           \
    " 44 :Ende Messbereich de [mm]..: 47.000\r\n"                                                  \
    " 61 :Start Messbereich ba [mm].: 1.0\r\n"                                                     \
    " 64 :Ende Messbereich be [mm]..: 11.0\r\n165 :R_FHB: 1 : L: + : R: -\r\n\r\n"

#define PLAIN HEADER("21", "rechts")

static int read_text(const char *text) {
    gm_traces_free(&traces);
    return gm_traces_read(&traces, file_of(text), &pair, 0, GM_DECIMAL_POINT, &error);
}

static void refuse(const char *text, long line, const char *fragment) {
    GM_ASSERT_INT(read_text(text), GM_IO_ERR_FORMAT);
    GM_ASSERT_INT(error.line, line);
    if (strstr(error.text, fragment) == NULL) {
        GM_ASSERT_STRING(error.text, fragment);
    }
    GM_ASSERT(traces.traces == NULL);
}

static double roll_length(double diameter) {
    const double base = pair.pinion.base_radius;
    return sqrt(0.25 * diameter * diameter - base * base);
}

static void a_profile_is_even_in_roll_length(void) {
    GM_ASSERT_INT(read_text("\xEF\xBB\xBF" PLAIN
                            "Profil:\r\nZahn-Nr.: 3 links / 5  Werte  z= 6.5\r\n"
                            "-2147483.648 1.5 .25\r\n\r\n-2.5 -2147483.65\r\n"),
                  GM_IO_OK);
    GM_ASSERT_INT(traces.count, 1);
    const gm_trace *trace = &traces.traces[0];
    GM_ASSERT_INT(trace->tooth, 3);
    GM_ASSERT_INT(trace->flank, GM_LEFT);
    GM_ASSERT_INT(trace->kind, GM_TRACE_PROFILE);
    GM_ASSERT_INT(trace->count, 3);
    GM_ASSERT_REL(trace->at, 6.5e-3, 1e-14);

    /* The first and the last of five points are not there. */
    const double from = roll_length(42e-3), to = roll_length(47e-3);
    for (int i = 0; i < 3; ++i) {
        GM_ASSERT_REL(trace->position[i], from + (i + 1) / 4.0 * (to - from), 1e-12);
    }
    GM_ASSERT_REL(trace->deviation[0], 1.5e-6, 1e-14);
    GM_ASSERT_REL(trace->deviation[1], 0.25e-6, 1e-14);
    GM_ASSERT_REL(trace->deviation[2], -2.5e-6, 1e-14);
    GM_ASSERT_INT(trace->line[0], 21);
    GM_ASSERT_INT(trace->line[2], 23);
}

static void a_second_number_is_that_of_right_flanks(void) {
    GM_ASSERT_INT(read_text(PLAIN "Zahn-Nr.: 3 rechts / 2 Werte z= 6.5\r\n1 2\r\n"), GM_IO_OK);
    GM_ASSERT_REL(traces.traces[0].position[0], roll_length(42.5e-3), 1e-12);
    GM_ASSERT_REL(traces.traces[0].position[1], roll_length(47e-3), 1e-12);
}

static void a_helix_is_even_over_its_range_and_lies_at_a_roll_length_or_diameter(void) {
    GM_ASSERT_INT(read_text(PLAIN
                            "Flankenlinie:\nZahn-Nr.: 1 rechts / 3 Werte x= 8.742\n1 2 3\n"
                            "Flankenlinie:  Zahn-Nr.: 2 rechts / 3 Werte  / d= 44.5\n1 2 3\n"),
                  GM_IO_OK);
    GM_ASSERT_INT(traces.count, 2);
    GM_ASSERT_INT(traces.traces[0].kind, GM_TRACE_HELIX);
    GM_ASSERT_REL(traces.traces[0].at, 8.742e-3, 1e-14);
    GM_ASSERT_REL(traces.traces[0].position[1], 6e-3, 1e-12);
    GM_ASSERT_REL(traces.traces[1].at, roll_length(44.5e-3), 1e-12);
}

static void twist_and_topography_are_further_traces_and_no_trace_is_there_twice(void) {
    GM_ASSERT_INT(
        read_text(PLAIN
                  "Profil:\nZahn-Nr.: 1 links / 2 Werte z= 6\n1 2\n"
                  "Verschr\xE4nkung: Zahn-Nr.: 1k /Flankenlinie:3 links / 2  Werte  x= 10\n1 2\n"
                  "Verschr\xC3\xA4nkung: Zahn-Nr.: 1f /Profil:1 links / 2  Werte  z= 2\n3 4\n"
                  "TOPOGRAFIE: Zahn-Nr.: 1 /Profil:2 links / 2 Werte  / z= 6\n9 9\n"
                  "Profil:  Zahn-Nr.: 1a links / 2 Werte  / z= 10\n5 6\n"),
        GM_IO_OK);
    GM_ASSERT_INT(traces.count, 4);
    GM_ASSERT_INT(traces.traces[1].kind, GM_TRACE_HELIX);
    GM_ASSERT_INT(traces.traces[2].kind, GM_TRACE_PROFILE);
    GM_ASSERT_REL(traces.traces[2].at, 2e-3, 1e-14);
    GM_ASSERT_REL(traces.traces[3].at, 10e-3, 1e-14);
    for (int i = 0; i < 4; ++i) {
        GM_ASSERT_INT(traces.traces[i].tooth, 1);
        GM_ASSERT_INT(traces.traces[i].flank, GM_LEFT);
    }
}

static void english_reads_as_well(void) {
    GM_ASSERT_INT(read_text("HEADER KS.MK.FILE\n 22 :Number of teeth z...: 21 external\n"
                            " 23 :Helix angle...: 15.5 right\n 41 :Start..: 42\n 44 :End..: 47\n"
                            "Profile:\nTooth-No.: 4 right / 2 values z= 6\n1 2\n"
                            "   left tooth flank\n  Tooth-No.  fp  Fp  Fr\n 1 1 2 3\n"),
                  GM_IO_OK);
    GM_ASSERT_INT(traces.traces[0].tooth, 4);
    GM_ASSERT_INT(traces.traces[0].flank, GM_RIGHT);
}

static void pitch_is_the_cumulative_column_of_both_flanks(void) {
    gm_measured_pitch_free(&pitch);
    GM_ASSERT_INT(
        gm_measured_pitch_read(
            &pitch,
            file_of(PLAIN
                    "Profil:\nZahn-Nr.: 1 links / 3 Werte z= 6\n1 2\n3\n"
                    "Fu\xC3\x9Fkreisdurchmesser / H\xC3\xB6he :     7.500\n   49.5 49.6\n"
                    "   linke Zahnflanke\n  Zahn-Nr.  fp  Fp  Fr\n\n 1  0.662 0.5 0.778\n"
                    " 2 -0.5 0.0 1\n  rechte Zahnflanke\n Zahn-Nr.  fp  Fr  Fp\n 1 1 2 -3\n\n"
                    "Teilung:\nZ-Nr. Seite PHI X Y Z\n  1   R  0.0000  .1198  25.5249  87.2302\n"),
            GM_DECIMAL_POINT, &error),
        GM_IO_OK);
    GM_ASSERT_INT(pitch.single, 0);
    GM_ASSERT_INT(pitch.count, 3);
    GM_ASSERT_REL(pitch.points[0].value, 0.5e-6, 1e-14);
    GM_ASSERT_INT(pitch.points[1].tooth, 2);
    GM_ASSERT_INT(pitch.points[2].flank, GM_RIGHT);
    GM_ASSERT_REL(pitch.points[2].value, -3e-6, 1e-14);
    gm_measured_pitch_free(&pitch);
    GM_ASSERT_INT(gm_measured_pitch_read(&pitch, file_of(PLAIN), GM_DECIMAL_POINT, &error),
                  GM_IO_ERR_FORMAT);
}

static void another_gear_is_refused(void) {
    static const char trace[] = "Profil:\nZahn-Nr.: 3 links / 2 Werte z= 6.5\n1 2\n";
    char text[2000];
    snprintf(text, sizeof text, "%s%s", HEADER("30", "rechts"), trace);
    refuse(text, 10,
           "number of teeth: must be 21, that of the pinion in the parameter file (got 30)");
    snprintf(text, sizeof text, "%s%s", HEADER("21", "links"), trace);
    refuse(text, 11, "right-handed");
    snprintf(text, sizeof text, "%s%s", HEADER("21 Innenverzahnung", "rechts"), trace);
    refuse(text, 10, "external");

    /* The wheel has the other hand. */
    snprintf(text, sizeof text, "%s%s", HEADER("30", "links"),
             "Flankenlinie:\nZahn-Nr.: 3 links / 2 Werte x= 9\n1 2\n");
    gm_traces_free(&traces);
    GM_ASSERT_INT(gm_traces_read(&traces, file_of(text), &pair, 1, GM_DECIMAL_POINT, &error),
                  GM_IO_OK);
}

/* A ring has the hand of its pinion, and its teeth are counted with either sign. */
static void a_ring_is_read_as_one(void) {
    static const char trace[] = "Profil:\nZahn-Nr.: 3 links / 3 Werte z= 6.5\n1 2 3\n";
    static const struct {
        const char *header;
        const char *refusal; /* NULL: accepted */
    } files[] = {
        {HEADER("63", "rechts"), "must be an internal gear, as the wheel"},
        {HEADER("63 Innenverzahnung ", "rechts"), NULL},
        {HEADER("-63 Innenverzahnung ", "rechts"), NULL},
        {HEADER("-63 Innenverzahnung ", "links"), "the helix must be right-handed"},
        {HEADER("64 Innenverzahnung ", "rechts"), "number of teeth: must be 63"},
    };
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 21;
    params.wheel_teeth = -63;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = 20 * pi / 180;
    params.helix_angle = 15.5 * pi / 180;
    params.center_distance = 43.5e-3;
    params.face_width = 12e-3;
    gm_pair ring;
    GM_ASSERT_INT(gm_pair_init(&ring, &params), GM_OK);

    for (size_t i = 0; i < sizeof files / sizeof files[0]; ++i) {
        char text[2000];
        char *range = NULL;
        snprintf(text, sizeof text, "%s%s", files[i].header, trace);

        /* From the tip of the ring outwards. */
        range = strstr(text, "42.000 42.500");
        memcpy(range, "128.50       ", 13);
        range = strstr(text, "47.000");
        memcpy(range, "133.50", 6);
        gm_traces_free(&traces);
        const int status =
            gm_traces_read(&traces, file_of(text), &ring, 1, GM_DECIMAL_POINT, &error);
        gm_test_context("file %d: %s", (int)i, error.text);
        GM_ASSERT_INT(status, files[i].refusal == NULL ? GM_IO_OK : GM_IO_ERR_FORMAT);
        if (files[i].refusal != NULL) {
            GM_ASSERT(strstr(error.text, files[i].refusal) != NULL);
        } else if (traces.count == 1) {
            const double base = ring.wheel.base_radius;
            const double from = sqrt(64.25e-3 * 64.25e-3 - base * base);
            const double to = sqrt(66.75e-3 * 66.75e-3 - base * base);
            GM_ASSERT_REL(traces.traces[0].position[1], 0.5 * (from + to), 1e-12);
        }
    }
    gm_test_context("%s", "");
    gm_traces_free(&traces);
    GM_ASSERT_INT(
        gm_traces_read(
            &traces,
            file_of(HEADER("21 Innenverzahnung",
                           "rechts") "Profil:\nZahn-Nr.: 3 links / 2 Werte z= 6.5\n1 2\n"),
            &pair, 0, GM_DECIMAL_POINT, &error),
        GM_IO_ERR_FORMAT);
}

static void what_is_not_understood_is_refused_with_its_line(void) {
    refuse(PLAIN "Zahn-Nr.: 1 links / 24  Werte  z= 7.5\n 1.0 2.0 3.0\n", 19,
           "must have 24 values (got 3)");
    refuse(PLAIN "Zahn-Nr.: 1 links / 4  Werte  z= 7.5\n1 2 3\nZahn-Nr.: 2 links / 2 Werte z= 7\n",
           21, "the trace that begins in line 19: must have 4 values (got 3)");
    refuse(PLAIN "Zahn-Nr.: 1 links / 2  Werte  z= 7.5\n 1.0 2.0 3.0\n", 20, "(got more)");
    refuse(PLAIN "Zahn-Nr.: 1 links / 2  Werte  z= 7.5\n 1.0 2.x\n", 20, "got '2.x'");
    refuse(PLAIN "Zahn-Nr.: 1 links / 2  Werte  z= 7.5\n 1.0 2,5\n", 20, "got '2,5'");
    GM_ASSERT_STRING(error.option, "style");
    refuse(PLAIN "Zahn-Nr. links: 1 / 2 Werte z= 7.5\n 1.0 2.0\n", 19, "its flank");
    refuse(PLAIN "Zahn-Nr.: 1 links\n 1.0 2.5\n", 19, "a number of values");
    refuse(PLAIN "Zahn-Nr.: 1 links / 2 Werte\n 1.0 2.5\n", 19, "its place z=, x= or d=");
    refuse(PLAIN "Zahn-Nr.: 1 links / 2 Werte q= 3\n 1.0 2.5\n", 19, "its place z=, x= or d=");
    refuse(PLAIN "Zahn-Nr.: 1 links / 2 Werte z= 3\n -2147483.648 -2147483.648\n", 20,
           "at least 2 measured points");
    refuse(PLAIN, 0, "there must be traces");
    refuse("HEADER KS.MW.FILE\n  7 :ME: 1\n10111 : fHb links 1 : 1.0\n", 1, "give the .mka");
    refuse("HEADER KS.MK.FILE\nUNITS inch\n", 2, "UNITS: must be mm (got 'inch')");
    refuse("HEADER KS.MK.FILE\nPROFILE angle\n", 2, "PROFILE: must be diameter");
    refuse("HEADER KS.MK.FILE\nZahn-Nr.: 1 links / 2 Werte z= 3\n1 2\n", 3, "line 41");
    refuse("HEADER KS.MK.FILE\n 41 :x: 30\n 44 :x: 47\nZahn-Nr.: 1 links / 2 Werte z= 3\n1 2\n", 2,
           "base circle");
}

static void numbers_may_have_a_comma_where_that_is_said(void) {
    gm_traces_free(&traces);
    GM_ASSERT_INT(gm_traces_read(&traces,
                                 file_of("HEADER KS.MK.FILE\n 41 :x: 42,0\n 44 :x: 47,0\n"
                                         "Zahn-Nr.: 1 links / 2 Werte z= 6,5\n1,5 -2147483,648\n"
                                         "Zahn-Nr.: 2 links / 2 Werte z= 6,5\n1,5 2,25\n"),
                                 &pair, 0, GM_DECIMAL_COMMA, &error),
                  GM_IO_ERR_FORMAT); /* one point is no trace */
    GM_ASSERT_INT(gm_traces_read(&traces,
                                 file_of("HEADER KS.MK.FILE\n 41 :x: 42,0\n 44 :x: 47,0\n"
                                         "Zahn-Nr.: 2 links / 2 Werte z= 6,5\n1,5 2,25\n"),
                                 &pair, 0, GM_DECIMAL_COMMA, &error),
                  GM_IO_OK);
    GM_ASSERT_REL(traces.traces[0].at, 6.5e-3, 1e-14);
    GM_ASSERT_REL(traces.traces[0].deviation[1], 2.25e-6, 1e-14);
}

int main(int argc, char *argv[]) {
    static const gm_test tests[] = {
        GM_TEST(a_profile_is_even_in_roll_length),
        GM_TEST(a_second_number_is_that_of_right_flanks),
        GM_TEST(a_helix_is_even_over_its_range_and_lies_at_a_roll_length_or_diameter),
        GM_TEST(twist_and_topography_are_further_traces_and_no_trace_is_there_twice),
        GM_TEST(english_reads_as_well),
        GM_TEST(pitch_is_the_cumulative_column_of_both_flanks),
        GM_TEST(another_gear_is_refused),
        GM_TEST(a_ring_is_read_as_one),
        GM_TEST(what_is_not_understood_is_refused_with_its_line),
        GM_TEST(numbers_may_have_a_comma_where_that_is_said),
    };
    make_pair();
    const int failed = gm_test_main("unit.mka_file", tests, GM_TEST_COUNT(tests), argc, argv);
    gm_traces_free(&traces);
    gm_measured_pitch_free(&pitch);
    return failed;
}
