/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Measured pitch: a displaced gear, constructed point by point and looked at as a machine does, from both faces, counted
 * both ways, as pinion, as wheel and as ring; single and cumulative values; everything that must be refused.
 */
#include "io_test.h"
#include "reference_gear.h"

static const double pi = 3.14159265358979323846;

static gm_pair pair;
static gm_measured_pitch measured;
static gm_measurement setup;
static gm_pitch pitch;
static gm_measured_pitch_report report;
static gm_io_error error;

static void begin(void) {
    pair = reference_pair(REFERENCE_FACE_WIDTH);
    gm_measurement_default(&setup);
    setup.datum_face = GM_FACE_II;
    setup.counting = GM_COUNTERCLOCKWISE;
}

/* ---------------------------------------------------------------------------------------------
 * A displaced gear, in the frame of docs/conventions.md, seen against +z
 * ------------------------------------------------------------------------------------------- */

typedef struct displaced {
    const gm_gear *gear;
    int wheel;
    double x; /* where the axis stands (m) */
    double y;
} displaced;

static int is_ring(const displaced *of) {
    return of->gear->sign < 0.0;
}

/* Direction of the middle of a tooth in the section z = 0 at zero angles, counter-clockwise from +x. */
static double tooth_direction(const displaced *of, int tooth) {
    const int teeth = of->gear->teeth;
    if (is_ring(of)) {
        return (2 * tooth + 1) * pi / teeth;
    }
    return of->wheel ? pi - (2 * tooth + 1) * pi / teeth : 2.0 * pi * tooth / teeth;
}

/* A point of the flank on the counter-clockwise (turn = 1) or clockwise (-1) side of a tooth, and its normal. */
typedef struct flank_point {
    double x;
    double y;
    double normal_x;
    double normal_y;
} flank_point;

static flank_point involute(const displaced *of, int tooth, int turn, double roll_angle) {
    const double base = of->gear->base_radius;
    if (is_ring(of)) {
        /* The same thread the other way round: internal teeth grow thicker outwards, and their normals look inwards. */
        const double left =
            tooth_direction(of, tooth) + turn * (of->gear->base_half_thickness + roll_angle);
        const flank_point inner = {base * cos(left) + turn * base * roll_angle * sin(left) + of->x,
                                   base * sin(left) - turn * base * roll_angle * cos(left) + of->y,
                                   -turn * sin(left), turn * cos(left)};
        return inner;
    }

    /* The thread unwinds from the base circle: where it leaves it, and along which tangent. */
    const double leaves =
        tooth_direction(of, tooth) + turn * (of->gear->base_half_thickness - roll_angle);
    const flank_point at = {base * cos(leaves) - turn * base * roll_angle * sin(leaves) + of->x,
                            base * sin(leaves) + turn * base * roll_angle * cos(leaves) + of->y,
                            -turn * sin(leaves), turn * cos(leaves)};
    return at;
}

/* Direction in which a flank crosses the measuring circle, by bisection along the flank. */
static double crossing_direction(const displaced *of, int tooth, int turn, double radius) {
    double low = 0.0;
    double high = 1.5;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        const flank_point at = involute(of, tooth, turn, middle);
        *(hypot(at.x, at.y) < radius ? &low : &high) = middle;
    }
    const flank_point at = involute(of, tooth, turn, low);
    return atan2(at.y, at.x);
}

/* From face I everything is mirrored: left is right, and the directions of rotation too. */
static double seen(double direction, int datum_face) {
    return datum_face == GM_FACE_II ? direction : pi - direction;
}

static double turned(double from, double to) {
    return remainder(to - from, 2.0 * pi);
}

/* What a machine prints of a tooth's flank. */
static gm_pitch_point observe(const displaced *of, const displaced *ideal, int tooth, int turn,
                              double radius) {
    const int teeth = of->gear->teeth;
    const int face = setup.datum_face;
    const double middle = seen(tooth_direction(of, tooth), face);
    const double nominal = seen(crossing_direction(ideal, tooth, turn, radius), face);
    const double actual = seen(crossing_direction(of, tooth, turn, radius), face);
    /* With the tip up, counter-clockwise is left; the tip of a ring looks to the axis. */
    const int left = (turned(middle, nominal) > 0.0) != is_ring(of);
    const double counted = setup.counting == GM_COUNTERCLOCKWISE ? 1.0 : -1.0;
    const double first = seen(tooth_direction(of, setup.first_tooth), face);
    const int steps = (int)lround(counted * turned(first, middle) * teeth / (2.0 * pi));
    const gm_pitch_point point = {(steps + teeth) % teeth + setup.first_number,
                                  left ? GM_LEFT : GM_RIGHT,
                                  counted * turned(nominal, actual) * radius, 0};
    return point;
}

static void measure(const displaced *of, double radius) {
    const displaced ideal = {of->gear, of->wheel, 0.0, 0.0};
    measured.count = 0;
    measured.points = malloc(2 * (size_t)of->gear->teeth * sizeof *measured.points);
    for (int tooth = 0; tooth < of->gear->teeth; ++tooth) {
        for (int turn = -1; turn <= 1; turn += 2) {
            measured.points[measured.count++] = observe(of, &ideal, tooth, turn, radius);
        }
    }
}

/* Material that the displacement adds on a flank: its share along the normal. */
static double added(const displaced *of, int tooth, int turn, double radius) {
    const displaced ideal = {of->gear, of->wheel, 0.0, 0.0};
    const double base = of->gear->base_radius;
    const double roll_angle = sqrt(radius * radius / (base * base) - 1.0);
    const flank_point at = involute(&ideal, tooth, turn, roll_angle);
    return of->x * at.normal_x + of->y * at.normal_y;
}

static void try_displaced_gear(int wheel, double radius) {
    const displaced of = {wheel ? &pair.wheel : &pair.pinion, wheel, 0.7e-6, -0.4e-6};
    measure(&of, radius);
    GM_ASSERT_INT(gm_measured_pitch_build(&pitch, &report, &measured, &setup, &pair, wheel, &error),
                  GM_IO_OK);
    for (int tooth = 0; pitch.teeth > 0 && tooth < of.gear->teeth; ++tooth) {
        /* The drive flank is the counter-clockwise one: the pinion's leads, the wheel's is hit; on a ring the other one. */
        const int drive = is_ring(&of) ? -1 : 1;
        GM_ASSERT_ABS(pitch.drive[tooth], added(&of, tooth, drive, radius), 1e-10);
        GM_ASSERT_ABS(pitch.coast[tooth], added(&of, tooth, -drive, radius), 1e-10);
        GM_ASSERT(pitch.drive_set[tooth] && pitch.coast_set[tooth]);
    }
    GM_ASSERT_REL(report.displacement, hypot(of.x, of.y), 1e-4);
    GM_ASSERT_ABS(report.rest, 0.0, 1e-6);
    GM_ASSERT(report.mirrored_rest > 0.2);
    gm_pitch_free(&pitch);
    /* Counted the other way than said: it looks like the mirror image of a displaced gear. */
    setup.counting = GM_CLOCKWISE + GM_COUNTERCLOCKWISE - setup.counting;
    GM_ASSERT_INT(gm_measured_pitch_build(&pitch, &report, &measured, &setup, &pair, wheel, &error),
                  GM_IO_OK);
    GM_ASSERT_ABS(report.mirrored_rest, 0.0, 1e-6);
    GM_ASSERT(report.rest > 0.2);
    gm_pitch_free(&pitch);
    gm_measured_pitch_free(&measured);
}

static void a_displaced_gear_is_seen_however_it_stood_and_was_counted(void) {
    begin();
    for (int which = 0; which < 16; ++which) {
        const int wheel = which & 1;
        setup.datum_face = which & 2 ? GM_FACE_I : GM_FACE_II;
        setup.counting = which & 4 ? GM_CLOCKWISE : GM_COUNTERCLOCKWISE;
        setup.first_number = which & 8 ? 0 : 1;
        setup.first_tooth = 3 * which % 41;
        gm_test_context("case %d", which);
        try_displaced_gear(wheel,
                           wheel ? pair.wheel.reference_radius : pair.pinion.reference_radius);
    }
}

static void a_displaced_ring_is_seen_so_too(void) {
    begin();
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 23;
    params.wheel_teeth = -71;
    params.normal_module = 3e-3;
    params.normal_pressure_angle = pi / 9.0;
    params.center_distance = 72e-3;
    params.face_width = 30e-3;
    GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);
    for (int which = 0; which < 8; ++which) {
        setup.datum_face = which & 1 ? GM_FACE_I : GM_FACE_II;
        setup.counting = which & 2 ? GM_CLOCKWISE : GM_COUNTERCLOCKWISE;
        setup.first_number = which & 4 ? 0 : 1;
        setup.first_tooth = 9 * which;
        gm_test_context("case %d", which);
        try_displaced_gear(1, pair.wheel.reference_radius);
    }

    /* The measuring circle lies between tip and root. */
    setup.pitch_diameter = 2.0 * pair.wheel.tip_radius;
    try_displaced_gear(1, pair.wheel.tip_radius);
    const double wrong[2] = {2.0 * pair.wheel.tip_radius - 1e-6,
                             2.0 * pair.wheel.root_radius + 1e-6};
    for (int k = 0; k < 2; ++k) {
        setup.pitch_diameter = wrong[k];
        GM_ASSERT_INT(gm_measured_pitch_build(&pitch, &report, &measured, &setup, &pair, 1, &error),
                      GM_IO_ERR_OPTION);
        assert_error(&error, "", 0, k == 0 ? "206.999 mm" : "220.501 mm",
                     "from 207 mm (tip) to 220.5 mm (root)");
    }
}

static void the_measuring_circle_counts(void) {
    begin();
    setup.pitch_diameter = 2.0 * 45.1e-3;
    try_displaced_gear(0, 45.1e-3);
    /* An arc at a larger circle is less material. */
    setup.pitch_diameter = (double)NAN;
    const gm_gear *gear = &pair.pinion;
    const displaced of = {gear, 0, 1e-6, 0.0};
    measure(&of, gear->reference_radius);
    GM_ASSERT_INT(gm_measured_pitch_build(&pitch, NULL, &measured, &setup, &pair, 0, &error),
                  GM_IO_OK);
    gm_pitch again;
    setup.pitch_diameter = 2.0 * gear->tip_radius;
    GM_ASSERT_INT(gm_measured_pitch_build(&again, NULL, &measured, &setup, &pair, 0, &error),
                  GM_IO_OK);
    GM_ASSERT_REL(again.drive[5] * gear->tip_radius, pitch.drive[5] * gear->reference_radius,
                  1e-12);
    gm_pitch_free(&again);
    gm_pitch_free(&pitch);
    gm_measured_pitch_free(&measured);
}

/* ---------------------------------------------------------------------------------------------
 * Values
 * ------------------------------------------------------------------------------------------- */

/* A text of one row per tooth and flank, the value of tooth i on both flanks from a function. */
static char text[200000];

static const char *pitch_file(const char *value_column, int teeth, double (*um)(int tooth)) {
    size_t used = (size_t)sprintf(text, "tooth,flank,%s\n", value_column);
    for (int tooth = 1; tooth <= teeth; ++tooth) {
        used += (size_t)sprintf(text + used, "%d,left,%.3f\n", tooth, um(tooth));
        used += (size_t)sprintf(text + used, "%d,right,%.3f\n", tooth, um(tooth));
    }
    return file_of(text);
}

static int read_and_build(const char *path, int wheel) {
    int status = gm_measured_pitch_read(&measured, path, GM_DECIMAL_POINT, &error);
    if (status == GM_IO_OK) {
        status = gm_measured_pitch_build(&pitch, &report, &measured, &setup, &pair, wheel, &error);
        gm_measured_pitch_free(&measured);
    }
    return status;
}

static double step_um(int tooth) {
    return tooth == 10 ? 9.0 : tooth == 1 ? -9.0 : 0.0;
}

static double step_places_um(int tooth) {
    return tooth >= 10 ? 107.0 : 98.0;
}

static void single_and_cumulative_values_say_the_same(void) {
    begin();
    /* Tooth 10 and all behind it stand 9 um ahead; 36 of 45 teeth. The first pitch leads back. */
    GM_ASSERT_INT(read_and_build(pitch_file("single_pitch_um", 45, step_um), 0), GM_IO_OK);
    gm_pitch single = pitch;
    GM_ASSERT_ABS(report.sum[GM_DRIVE], 0.0, 1e-12);
    GM_ASSERT_REL(report.level[GM_DRIVE], 9e-6 * 36 / 45, 1e-12);
    GM_ASSERT_INT(read_and_build(pitch_file("cumulative_pitch_um", 45, step_places_um), 0),
                  GM_IO_OK);
    GM_ASSERT_REL(report.level[GM_COAST], 98e-6 + 9e-6 * 36 / 45, 1e-12);
    const double arc = pair.pinion.base_radius / pair.pinion.reference_radius;
    for (int tooth = 0; tooth < 45; ++tooth) {
        const double ahead = arc * (tooth >= 9 ? 9e-6 * 9 / 45 : -9e-6 * 36 / 45);
        GM_ASSERT_ABS(single.drive[tooth], ahead, 1e-15);
        GM_ASSERT_ABS(single.coast[tooth], -ahead, 1e-15);
        GM_ASSERT_ABS(pitch.drive[tooth], ahead, 1e-15);
        GM_ASSERT_ABS(pitch.coast[tooth], -ahead, 1e-15);
    }
    gm_pitch_free(&single);
    gm_pitch_free(&pitch);
}

static double rounded_um(int tooth) {
    return tooth == 2 ? 9.0 : tooth == 3 ? -8.1 : 0.0;
}

static void what_rounding_leaves_of_the_sum_is_spread(void) {
    begin();
    GM_ASSERT_INT(read_and_build(pitch_file("single_pitch_um", 45, rounded_um), 0), GM_IO_OK);
    GM_ASSERT_ABS(report.sum[GM_DRIVE], 0.9e-6, 1e-12);
    const double arc = pair.pinion.base_radius / pair.pinion.reference_radius;
    GM_ASSERT_ABS(pitch.drive[4] - pitch.drive[3], -arc * 0.9e-6 / 45, 1e-15);
    GM_ASSERT_ABS(pitch.drive[0] - pitch.drive[44], -arc * 0.9e-6 / 45, 1e-15);
    gm_pitch_free(&pitch);
}

static void one_flank_alone_is_fine(void) {
    begin();
    size_t used = (size_t)sprintf(text, "tooth,flank,cumulative_pitch_um\n");
    for (int tooth = 45; tooth >= 1; --tooth) { /* in any order */
        used += (size_t)sprintf(text + used, "%d,right,%d\n", tooth, tooth % 5);
    }
    GM_ASSERT_INT(read_and_build(file_of(text), 0), GM_IO_OK);
    GM_ASSERT_INT(gm_pitch_ideal_teeth(&pitch, GM_DRIVE), 45);
    GM_ASSERT_NAN(report.displacement);
    GM_ASSERT_NAN(report.rest);
    GM_ASSERT_INT(gm_pitch_ideal_teeth(&pitch, GM_COAST), 0);
    /* Tooth number 4 is tooth 3: 4 um ahead, 2 um taken out as the mean. */
    GM_ASSERT_REL(pitch.coast[3], -2e-6 * pair.pinion.base_radius / pair.pinion.reference_radius,
                  1e-12);
    gm_pitch_free(&pitch);
}

/* ---------------------------------------------------------------------------------------------
 * Refusals
 * ------------------------------------------------------------------------------------------- */

static void refused(const char *path, int wheel, long line, const char *value, const char *right) {
    GM_ASSERT_INT(read_and_build(path, wheel), GM_IO_ERR_FORMAT);
    assert_error(&error, path, line, value, right);
    GM_ASSERT(pitch.drive == NULL && pitch.teeth == 0);
}

#define HEADER "tooth,flank,cumulative_pitch_um\n"

static double plain_um(int tooth) {
    return tooth % 7;
}

static double mm_for_um(int tooth) {
    return 0.001 * (tooth % 7);
}

static double nm_for_um(int tooth) {
    return 1000.0 * (tooth % 7);
}

static void lopsided_text(const char *end) {
    pitch_file("cumulative_pitch_um", 45, plain_um);
    strcat(text, end);
}

static void bad_files_are_refused(void) {
    begin();
    refused(file_of("tooth,flank,cumulative_pitch\n1,left,1\n"), 0, 1, "'cumulative_pitch'",
            "cumulative_pitch_um");
    refused(file_of("tooth,flank,single_pitch_mm\n1,left,1\n"), 0, 1, "'single_pitch_mm'",
            "single_pitch_um");
    refused(file_of("tooth;flank;cumulative_pitch_um\n1;left;1\n"), 0, 1, "semicolons", "commas");
    refused(file_of(HEADER "1,left,1,5\n"), 0, 2, "(got 4", "decimal comma");
    refused(file_of(HEADER "1,left,nan\n"), 0, 2, "'nan'", "a number like 1.5");
    refused(file_of(HEADER "1,lefft,1\n"), 0, 2, "'lefft'", "left or right");
    refused(file_of(HEADER "-1,left,1\n"), 0, 2, "'-1'", "whole number");
    refused(file_of(HEADER), 0, 1, "(got none)", "must be rows");
    refused(file_of("pitch\n"), 0, 1, "'pitch'", "or tooth,flank,single_pitch_um");
}

static void wrong_teeth_are_refused(void) {
    begin();
    lopsided_text("46,left,1\n");
    refused(file_of(text), 0, 92, "(got 46)", "tooth: must be from 1 to 45");
    lopsided_text("0,left,1\n");
    refused(file_of(text), 0, 92, "(got 0)", "begins at 0");
    lopsided_text("7,left,1\n");
    refused(file_of(text), 0, 92, "line 14", "must have one row");
    /* 41 of 45 teeth: those of the wheel; and the pinion's 45 for a wheel of 41. */
    refused(pitch_file("cumulative_pitch_um", 41, plain_um), 0, 0, "42, 43, 44, 45", "other gear");
    refused(pitch_file("cumulative_pitch_um", 45, plain_um), 1, 84, "(got 42)", "other gear");
    pitch_file("cumulative_pitch_um", 45, plain_um);
    *strstr(text, "44,right") = '#';
    refused(file_of(text), 0, 0, "none for tooth 44",
            "flank right: must have a row for each of the 45 teeth");
    pitch_file("cumulative_pitch_um", 20, plain_um);
    refused(file_of(text), 0, 0, "the teeth 21, 22, 23, 24, 25 and others", "each of the 45");
}

static double open_um(int tooth) {
    return tooth == 5 ? 12.5 : 0.0;
}

static void wrong_values_are_refused(void) {
    begin();
    refused(pitch_file("cumulative_pitch_um", 45, mm_for_um), 0, 12, "0.006 um", "millimetres");
    refused(pitch_file("cumulative_pitch_um", 45, nm_for_um), 0, 12, "6000 um", "nanometres");
    refused(file_of(HEADER "1,left,-1e300\n"), 0, 2, "tooth 1", "must be a deviation, of some um");
    refused(pitch_file("single_pitch_um", 45, open_um), 0, 2, "12.5 um", "must add up to 0");
}

static void wrong_set_ups_are_refused(void) {
    begin();
    const char *path = pitch_file("cumulative_pitch_um", 45, plain_um);
    const struct {
        gm_measurement setup;
        const char *said;
    } cases[] = {
        {{0, GM_CLOCKWISE, 1, 0, 0, (double)NAN}, "I or II"},
        {{3, GM_CLOCKWISE, 1, 0, 0, (double)NAN}, "I or II"},
        {{GM_FACE_I, 0, 1, 0, 0, (double)NAN}, "clockwise"},
        {{GM_FACE_I, GM_CLOCKWISE, 2, 0, 0, (double)NAN}, "0 or 1"},
        {{GM_FACE_I, GM_CLOCKWISE, 1, 45, 0, (double)NAN}, "0 to 44"},
        {{GM_FACE_I, GM_CLOCKWISE, 1, -1, 0, (double)NAN}, "0 to 44"},
        {{GM_FACE_I, GM_CLOCKWISE, 1, 0, 0, 44e-3}, "44 mm"},
        {{GM_FACE_I, GM_CLOCKWISE, 1, 0, 0, (double)INFINITY}, "infinite"},
    };

    for (size_t i = 0; i < GM_TEST_COUNT(cases); ++i) {
        setup = cases[i].setup;
        GM_ASSERT_INT(read_and_build(path, 0), GM_IO_ERR_OPTION);
        gm_test_context("%s", error.text);
        GM_ASSERT(strstr(error.text, cases[i].said) != NULL);
        GM_ASSERT(strstr(error.text, "must be") != NULL);
    }

    /* Nothing measured. */
    measured.count = 0;
    setup = cases[0].setup;
    setup.datum_face = GM_FACE_I;
    GM_ASSERT_INT(gm_measured_pitch_build(&pitch, NULL, &measured, &setup, &pair, 0, &error),
                  GM_IO_ERR_FORMAT);
    GM_ASSERT(strstr(error.text, "measured pitch: must be that of all teeth") != NULL);

    /* Sides and numbers of teeth by themselves; without a set-up only what needs none. */
    GM_ASSERT_INT(gm_measurement_side(NULL, GM_COAST), GM_COAST);
    GM_ASSERT_INT(gm_measurement_tooth(NULL, &pair, 0, 1), -1);
    GM_ASSERT_INT(gm_measurement_side(&setup, 7), -1);
    GM_ASSERT_INT(gm_measurement_side(NULL, GM_LEFT), -1);
    GM_ASSERT_INT(gm_measurement_tooth(&setup, &pair, 0, 46), -1);
    GM_ASSERT_INT(gm_measurement_tooth(&setup, &pair, 0, 0), -1);
    GM_ASSERT_INT(gm_measurement_tooth(&setup, NULL, 0, 1), -1);
    GM_ASSERT_INT(gm_measurement_tooth(&setup, &pair, 0, 45), 44);

    setup.first_tooth = 45;
    GM_ASSERT_INT(gm_measurement_tooth(&setup, &pair, 0, 1), -1);
    setup.first_tooth = -1;
    GM_ASSERT_INT(gm_measurement_tooth(&setup, &pair, 0, 1), -1);
    setup.first_tooth = 0;
    setup.first_number = -1;
    GM_ASSERT_INT(gm_measurement_tooth(&setup, &pair, 0, 1), -1);

    setup.datum_face = 0;
    GM_ASSERT_INT(gm_measurement_side(&setup, GM_LEFT), -1);
    GM_ASSERT_INT(gm_measurement_side(&setup, GM_DRIVE), GM_DRIVE);

    GM_ASSERT_INT(gm_measured_pitch_build(NULL, NULL, &measured, &setup, &pair, 0, &error),
                  GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_measured_pitch_read(&measured, NULL, GM_DECIMAL_POINT, &error),
                  GM_IO_ERR_NULL);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(a_displaced_gear_is_seen_however_it_stood_and_was_counted),
        GM_TEST(a_displaced_ring_is_seen_so_too),
        GM_TEST(the_measuring_circle_counts),
        GM_TEST(single_and_cumulative_values_say_the_same),
        GM_TEST(what_rounding_leaves_of_the_sum_is_spread),
        GM_TEST(one_flank_alone_is_fine),
        GM_TEST(bad_files_are_refused),
        GM_TEST(wrong_teeth_are_refused),
        GM_TEST(wrong_values_are_refused),
        GM_TEST(wrong_set_ups_are_refused),
    };
    return gm_test_main("unit.measured_pitch", tests, GM_TEST_COUNT(tests), argc, argv);
}
