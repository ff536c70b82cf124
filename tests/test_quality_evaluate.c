/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Measured values, tolerances and classes, against the definitions worked out by hand or by another way. */
#include "io_test.h"
#include "reference_gear.h"

enum { FACE_NODES = 21, PROFILE_NODES = 31, MOST_TEETH = 60 };

static const double pi = 3.14159265358979323846;

static gm_pair pair;
static gm_quality quality;
static gm_flank_quality flanks[2 * MOST_TEETH];
static gm_quality_options options;
static gm_io_error error;

static double table[FACE_NODES * PROFILE_NODES];
static gm_deviation_set set;
static gm_deviations deviations;
static double drive[MOST_TEETH];
static double coast[MOST_TEETH];
static int drive_set[MOST_TEETH];
static int coast_set[MOST_TEETH];
static gm_pitch pitch;

/* Spur gears of module 3 mm, 40 and 60 teeth, 30 mm wide. */
static gm_pair module_3(void) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 40;
    params.wheel_teeth = 60;
    params.normal_module = 3e-3;
    params.normal_pressure_angle = 20.0 / 180.0 * pi;
    params.center_distance = 150e-3;
    params.face_width = 30e-3;
    return make_pair(&params);
}

static void begin(const gm_pair *of, int wheel) {
    const int teeth = wheel ? of->wheel.teeth : of->pinion.teeth;
    pair = *of;
    set = (gm_deviation_set){-1, -1, table};
    deviations = (gm_deviations){teeth, FACE_NODES, PROFILE_NODES, 1, &set};
    pitch = (gm_pitch){teeth, drive, coast, drive_set, coast_set};
    for (int i = 0; i < MOST_TEETH; ++i) {
        drive[i] = coast[i] = 0.0;
        drive_set[i] = coast_set[i] = 1;
    }
    for (int node = 0; node < FACE_NODES * PROFILE_NODES; ++node) {
        table[node] = 0.0;
    }
    gm_quality_options_default(&options);
}

/* Adds f(t1) along the face or f(t2) along the profile. */
static void add_profile(double (*f)(double)) {
    for (int node = 0; node < FACE_NODES * PROFILE_NODES; ++node) {
        table[node] += f((double)(node % PROFILE_NODES) / (PROFILE_NODES - 1));
    }
}

static void add_helix(double (*f)(double)) {
    for (int node = 0; node < FACE_NODES * PROFILE_NODES; ++node) {
        table[node] += f((double)(node / PROFILE_NODES) / (FACE_NODES - 1));
    }
}

static int evaluate(int wheel) {
    return gm_quality_evaluate(&quality, flanks, &pair, wheel, &deviations, &pitch, &options,
                               &error);
}

static double worst(int kind) {
    return quality.worst[kind].value;
}

/* ---------------------------------------------------------------------------------------------
 * Tolerances
 * ------------------------------------------------------------------------------------------- */

/* m 3, d 120, b 30 mm. By hand, not rounded, class 5: 6.32, 20.3649, 18.3284, 5.32, 6.65, 8.5160, 6.4647, 7.2315,
 * 9.6999 um; class 6 is sqrt(2) times that, class 1 a quarter, class 11 eight times. */
static void tolerances_are_those_of_the_formulae(void) {
    static const int classes[4] = {1, 5, 6, 11};
    static const double expected[4][GM_QUALITY_KINDS] = {
        {1.6, 5.0, 4.6, 1.3, 1.7, 2.1, 1.6, 1.8, 2.4},
        {6.5, 20.0, 18.0, 5.5, 6.5, 8.5, 6.5, 7.0, 9.5},
        {9.0, 29.0, 26.0, 7.5, 9.5, 12.0, 9.0, 10.0, 14.0},
        {51.0, 163.0, 147.0, 43.0, 53.0, 68.0, 52.0, 58.0, 78.0}};
    const gm_pair gears = module_3();
    for (int i = 0; i < 4; ++i) {
        for (int kind = 0; kind < GM_QUALITY_KINDS; ++kind) {
            gm_test_context("class %d, %s", classes[i], gm_quality_symbol(kind));
            GM_ASSERT_REL(gm_quality_tolerance(&gears, 0, kind, classes[i]),
                          expected[i][kind] * 1e-6, 1e-15);
        }
    }
}

static void the_wheel_has_tolerances_of_its_own_diameter(void) {
    const gm_pair gears = module_3();
    /* d = 180: 0.18 + 1.2 + 5 = 6.38 -> 6.5; 0.36 + 7.3790 + 2.1 + 12 = 21.84 -> 22 */
    GM_ASSERT_REL(gm_quality_tolerance(&gears, 1, GM_QUALITY_SINGLE_PITCH, 5), 6.5e-6, 1e-15);
    GM_ASSERT_REL(gm_quality_tolerance(&gears, 1, GM_QUALITY_TOTAL_PITCH, 5), 22e-6, 1e-15);
}

static void no_tolerance_where_there_is_no_class(void) {
    const gm_pair gears = module_3();
    GM_ASSERT_NAN(gm_quality_tolerance(&gears, 0, GM_QUALITY_SINGLE_PITCH, 0));
    GM_ASSERT_NAN(gm_quality_tolerance(&gears, 0, GM_QUALITY_SINGLE_PITCH, 12));
    GM_ASSERT_NAN(gm_quality_tolerance(&gears, 0, -1, 5));
    GM_ASSERT_NAN(gm_quality_tolerance(&gears, 0, GM_QUALITY_KINDS, 5));
    GM_ASSERT_NAN(gm_quality_tolerance(NULL, 0, GM_QUALITY_SINGLE_PITCH, 5));
    GM_ASSERT_STRING(gm_quality_symbol(GM_QUALITY_HELIX_FORM), "f_f_beta");
    GM_ASSERT_STRING(gm_quality_symbol(GM_QUALITY_KINDS), "unknown");
}

static void scope_ends_where_the_standard_says(void) {
    gm_pair gears = module_3();
    GM_ASSERT_INT(gm_quality_is_in_scope(&gears, 0), 1);
    GM_ASSERT_INT(gm_quality_is_in_scope(NULL, 0), 0);
    gears.pinion.face_width = 3.9e-3;
    GM_ASSERT_INT(gm_quality_is_in_scope(&gears, 0), 0);
    gears.pinion.face_width = 4e-3;
    GM_ASSERT_INT(gm_quality_is_in_scope(&gears, 0), 1);
    gears.helix_angle = -pi / 4.0;
    GM_ASSERT_INT(gm_quality_is_in_scope(&gears, 0), 1);
    gears.helix_angle = -pi / 3.99;
    GM_ASSERT_INT(gm_quality_is_in_scope(&gears, 0), 0);
    gears = module_3();
    gears.normal_module = 0.49e-3;
    GM_ASSERT_INT(gm_quality_is_in_scope(&gears, 0), 0);
    gears = module_3();
    gears.wheel.teeth = 1001;
    GM_ASSERT_INT(gm_quality_is_in_scope(&gears, 0), 1);
    GM_ASSERT_INT(gm_quality_is_in_scope(&gears, 1), 0);
}

static void a_value_at_the_limit_is_within_the_class(void) {
    const gm_pair gears = module_3();
    const double limit = gm_quality_tolerance(&gears, 0, GM_QUALITY_TOTAL_PITCH, 7);
    const double arc = gears.pinion.reference_radius / gears.pinion.base_radius;
    static const double part[3] = {0.999999, 1.000001, 8.0};
    static const int expected[3] = {7, 8, 12};
    begin(&gears, 0);
    for (int i = 0; i < 3; ++i) {
        drive[3] = part[i] * limit / arc;
        GM_ASSERT_INT(evaluate(0), GM_IO_OK);
        GM_ASSERT_INT(quality.worst[GM_QUALITY_TOTAL_PITCH].quality_class, expected[i]);
    }
    GM_ASSERT_INT(quality.quality_class, 12);
    GM_ASSERT_INT(quality.worst[GM_QUALITY_HELIX_FORM].quality_class, 1);
}

/* ---------------------------------------------------------------------------------------------
 * Profile and helix
 * ------------------------------------------------------------------------------------------- */

static double rise(double t) {
    return 10e-6 * t;
}

static double fall(double t) {
    return -10e-6 * t;
}

static double crown(double t) {
    return -8e-6 * (2.0 * t - 1.0) * (2.0 * t - 1.0);
}

static double tip_up(double t) {
    return t > 0.999 ? 5e-6 : 0.0;
}

static double tip_down(double t) {
    return t > 0.999 ? -5e-6 : 0.0;
}

static double rough(double t) {
    return 1e-6 * sin(37.0 * t) + 3e-6 * t * t * t;
}

/* Values are along the normal; in the transverse section 1/cos(beta_b) times. */
static void a_slope_is_the_rise_over_the_whole_flank(void) {
    const gm_pair gears = reference_pair(REFERENCE_FACE_WIDTH);
    const double factor = 1.0 / cos(gears.base_helix_angle);
    begin(&gears, 0);
    add_profile(rise);
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT_REL(flanks[7].profile_slope, factor * 10e-6, 1e-12);
    GM_ASSERT_ABS(flanks[7].profile_form, 0.0, 1e-18);
    GM_ASSERT_REL(flanks[7].profile_total, factor * 10e-6, 1e-12); /* the tip sticks out */
    GM_ASSERT_ABS(flanks[7].helix_slope, 0.0, 1e-18);
    GM_ASSERT_ABS(flanks[7].helix_total, 0.0, 1e-18);

    options.extrapolate = 0;
    options.end_material = 0;
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT_REL(flanks[7].profile_slope, 0.95 * factor * 10e-6, 1e-12);
    GM_ASSERT_REL(flanks[7].profile_total, 0.95 * factor * 10e-6, 1e-12);
}

static void a_falling_slope_is_negative_and_its_size_counts(void) {
    const gm_pair gears = module_3();
    begin(&gears, 0);
    add_helix(fall);
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT_REL(flanks[0].helix_slope, -10e-6, 1e-12);
    GM_ASSERT_REL(worst(GM_QUALITY_HELIX_SLOPE), 10e-6, 1e-12);
    GM_ASSERT_ABS(flanks[0].profile_slope, 0.0, 1e-18);
    /* At t1 = 0 material sticks out, at t1 = 1 it is missing: range from 0 to 0.95. */
    GM_ASSERT_REL(flanks[0].helix_total, 9.5e-6, 1e-12);
}

static void a_crowning_is_form(void) {
    const gm_pair gears = module_3();
    begin(&gears, 0);
    options.face_margin = 0.0;
    add_helix(crown);
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT_ABS(flanks[1].helix_slope, 0.0, 1e-18);
    GM_ASSERT_REL(flanks[1].helix_form, 8e-6, 1e-12);
    GM_ASSERT_REL(flanks[1].helix_total, 8e-6, 1e-12);
}

static void the_face_margin_is_the_smaller_of_both(void) {
    gm_pair gears = module_3(); /* 0.05 < m / b = 0.1 */
    begin(&gears, 0);
    add_helix(crown);
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT_REL(flanks[1].helix_form, 8e-6 * 0.9 * 0.9, 1e-12); /* 0.05 is a node */

    gears.pinion.face_width = 120e-3; /* m / b = 0.025, halfway between nodes */
    begin(&gears, 0);
    add_helix(crown);
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT_REL(flanks[1].helix_form, 8e-6 * 0.5 * (1.0 + 0.9 * 0.9), 1e-12);
}

static void behind_the_range_only_excess_of_material_counts(void) {
    const gm_pair gears = module_3();
    begin(&gears, 0);
    options.profile_to = 29.0 / 30.0; /* the last node alone is behind it */
    add_profile(tip_up);
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT_ABS(flanks[1].profile_slope, 0.0, 1e-15);
    GM_ASSERT_REL(flanks[1].profile_form, 5e-6, 1e-9);
    GM_ASSERT_REL(flanks[1].profile_total, 5e-6, 1e-9);

    options.end_material = 0;
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT_ABS(flanks[1].profile_form, 0.0, 1e-15);

    begin(&gears, 0);
    options.profile_to = 29.0 / 30.0;
    add_profile(tip_down);
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT_ABS(flanks[1].profile_form, 0.0, 1e-15);
}

/* Mean line by the normal equations of very many points of the polygon. */
static double slope_of_points(double from, double to) {
    enum { POINTS = 200000 };
    double st = 0.0, sf = 0.0, stt = 0.0, stf = 0.0;
    for (int i = 0; i < POINTS; ++i) {
        const double t = from + (to - from) * (i + 0.5) / POINTS;
        const double place = t * (PROFILE_NODES - 1);
        const int node = (int)place;
        const double f = table[node] + (place - node) * (table[node + 1] - table[node]);
        st += t;
        sf += f;
        stt += t * t;
        stf += t * f;
    }
    return (POINTS * stf - st * sf) / (POINTS * stt - st * st);
}

static void the_mean_line_is_that_of_least_squares(void) {
    static const double ranges[3][2] = {{0.0, 0.95}, {0.12, 0.77}, {0.4, 0.41}};
    const gm_pair gears = module_3();
    for (int i = 0; i < 3; ++i) {
        begin(&gears, 0);
        add_profile(rough);
        options.profile_from = ranges[i][0];
        options.profile_to = ranges[i][1];
        GM_ASSERT_INT(evaluate(0), GM_IO_OK);
        /* Midpoints of 2e5 pieces: error of the sums about 1e-10 of them, more of their small differences. */
        GM_ASSERT_NEAR(flanks[0].profile_slope, slope_of_points(ranges[i][0], ranges[i][1]), 1e-6,
                       1e-12);
    }
}

static void an_even_grid_is_read_halfway_between_its_middle_lines(void) {
    const gm_pair gears = module_3();
    double nodes[8] = {0, 0, 1e-6, 4e-6, 3e-6, 0, 0, 0}; /* 2 x 4: t1, t2 */
    begin(&gears, 0);
    set.values = nodes;
    deviations.face_nodes = 2;
    deviations.profile_nodes = 4;
    options.profile_to = 1.0;
    options.face_margin = 0.0;
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    /* profile 1.5 0 0.5 2, from (0 3), (0 0), (1 0), (4 0); helix 0.5, 0 */
    GM_ASSERT_REL(flanks[0].profile_total, 2e-6, 1e-12);
    GM_ASSERT_REL(flanks[0].helix_slope, -0.5e-6, 1e-12);
}

static void the_flank_with_the_worst_value_is_named(void) {
    const gm_pair gears = module_3();
    double other[FACE_NODES * PROFILE_NODES];
    begin(&gears, 0);
    add_profile(crown);
    memcpy(other, table, sizeof table);
    for (int node = 0; node < FACE_NODES * PROFILE_NODES; ++node) {
        other[node] *= 1.5;
    }
    gm_deviation_set sets[2] = {set, {17, GM_COAST, other}};
    deviations.sets = sets;
    deviations.set_count = 2;
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT_INT(quality.worst[GM_QUALITY_PROFILE_FORM].tooth, 17);
    GM_ASSERT_INT(quality.worst[GM_QUALITY_PROFILE_FORM].side, GM_COAST);
    GM_ASSERT_REL(flanks[40 + 17].profile_form, 1.5 * flanks[40 + 16].profile_form, 1e-12);
    GM_ASSERT_REL(flanks[17].profile_form, flanks[40 + 16].profile_form, 0.0);
}

/* ---------------------------------------------------------------------------------------------
 * Pitch and run-out
 * ------------------------------------------------------------------------------------------- */

static void pitch_is_an_arc_at_the_reference_circle(void) {
    const gm_pair gears = reference_pair(REFERENCE_FACE_WIDTH);
    const double arc = 1.0 / cos(gears.transverse_pressure_angle);
    for (int wheel = 0; wheel < 2; ++wheel) {
        /* A tooth ahead by f: +f on the pinion's drive flank, -f on the wheel's (conventions). */
        const double ahead = wheel ? -1.0 : 1.0;
        gm_test_context("wheel %d", wheel);
        begin(&gears, wheel);
        drive[3] = ahead * 2e-6;
        drive[4] = ahead * -3e-6;
        coast[9] = ahead * -7e-6;
        GM_ASSERT_INT(evaluate(wheel), GM_IO_OK);
        GM_ASSERT_REL(flanks[3].single_pitch, 2e-6 * arc, 1e-12);
        GM_ASSERT_REL(flanks[4].single_pitch, -5e-6 * arc, 1e-12);
        GM_ASSERT_REL(flanks[5].single_pitch, 3e-6 * arc, 1e-12);
        GM_ASSERT_REL(flanks[4].cumulative_pitch, -3e-6 * arc, 1e-12);
        GM_ASSERT_REL(flanks[pitch.teeth + 9].single_pitch, 7e-6 * arc, 1e-12);
        GM_ASSERT_REL(worst(GM_QUALITY_SINGLE_PITCH), 7e-6 * arc, 1e-12);
        GM_ASSERT_INT(quality.worst[GM_QUALITY_SINGLE_PITCH].tooth, 9);
        GM_ASSERT_INT(quality.worst[GM_QUALITY_SINGLE_PITCH].side, GM_COAST);
        GM_ASSERT_REL(worst(GM_QUALITY_TOTAL_PITCH), 7e-6 * arc, 1e-12);
    }
}

static void a_pitch_goes_round_the_gear(void) {
    const gm_pair gears = module_3();
    begin(&gears, 0);
    drive[39] = 4e-6;
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT(flanks[0].single_pitch < -4e-6);
}

/*
 * A gear whose teeth stand on a circle with another centre, off by `shift`: every flank adds the component
 * of the shift along its normal. At the reference circle the normal leans out of the tangent by alpha_t.
 */
static void displace(const gm_pair *gears, int wheel, double shift, double direction) {
    const gm_gear *gear = wheel ? &gears->wheel : &gears->pinion;
    const double alpha = gears->transverse_pressure_angle;
    const double half =
        gear->normal_thickness / (2.0 * gear->reference_radius * cos(gears->helix_angle));
    for (int i = 0; i < gear->teeth; ++i) {
        for (int side = 0; side < 2; ++side) {
            /* Angles in the gear's own sense of rotation; the pinion's drive flank looks ahead, the wheel's back. */
            const double ahead = (side == GM_DRIVE) == !wheel ? 1.0 : -1.0;
            const double place = 2.0 * pi * i / gear->teeth + ahead * half - direction;
            const double along =
                shift * (sin(alpha) * cos(place) - ahead * cos(alpha) * sin(place));
            (side == GM_DRIVE ? drive : coast)[i] = along;
        }
    }
}

/* A ball in a space of a displaced gear goes along: its places range over twice the eccentricity, or a
 * bit less where no space stands in the direction of the shift. */
static void run_out_is_twice_the_eccentricity(void) {
    const gm_pair gears = reference_pair(REFERENCE_FACE_WIDTH);
    for (int wheel = 0; wheel < 2; ++wheel) {
        for (int direction = 0; direction < 5; ++direction) {
            const double angle = 0.3 + direction;
            double low = (double)INFINITY;
            double high = -(double)INFINITY;
            begin(&gears, wheel);
            gm_test_context("wheel %d, direction %d", wheel, direction);
            displace(&gears, wheel, 5e-6, angle);
            for (int i = 0; i < pitch.teeth; ++i) {
                /* the space behind or in front of tooth i: all spaces are visited */
                const double place = 5e-6 * cos(2.0 * pi * (i + 0.5) / pitch.teeth - angle);
                low = fmin(low, place);
                high = fmax(high, place);
            }
            GM_ASSERT_INT(evaluate(wheel), GM_IO_OK);
            GM_ASSERT_REL(worst(GM_QUALITY_RUN_OUT), high - low, 1e-9);
            GM_ASSERT(worst(GM_QUALITY_RUN_OUT) > 0.99 * 10e-6);
        }
    }
}

static void a_space_that_stands_elsewhere_has_no_run_out(void) {
    const gm_pair gears = reference_pair(REFERENCE_FACE_WIDTH);
    for (int wheel = 0; wheel < 2; ++wheel) {
        begin(&gears, wheel);
        drive[5] = 4e-6;
        coast[wheel ? 4 : 6] = -4e-6; /* the other flank of the same space */
        GM_ASSERT_INT(evaluate(wheel), GM_IO_OK);
        GM_ASSERT_ABS(worst(GM_QUALITY_RUN_OUT), 0.0, 1e-18);
        GM_ASSERT(worst(GM_QUALITY_TOTAL_PITCH) > 4e-6);
    }
}

/* ---------------------------------------------------------------------------------------------
 * What is not there, and what is refused
 * ------------------------------------------------------------------------------------------- */

static void what_no_file_says_is_not_evaluated(void) {
    const gm_pair gears = module_3();
    begin(&gears, 0);
    for (int i = 0; i < MOST_TEETH; ++i) {
        coast_set[i] = 0;
    }
    set.side = GM_COAST;
    GM_ASSERT_INT(evaluate(0), GM_IO_OK);
    GM_ASSERT_NAN(worst(GM_QUALITY_RUN_OUT));
    GM_ASSERT_INT(quality.worst[GM_QUALITY_RUN_OUT].quality_class, 0);
    GM_ASSERT_INT(quality.worst[GM_QUALITY_SINGLE_PITCH].quality_class, 1);
    GM_ASSERT_NAN(flanks[40].single_pitch);
    GM_ASSERT_ABS(flanks[0].single_pitch, 0.0, 0.0);
    GM_ASSERT_NAN(flanks[0].profile_form);
    GM_ASSERT_ABS(flanks[40].profile_form, 0.0, 0.0);
    GM_ASSERT_INT(gm_quality_evaluate(&quality, NULL, &pair, 0, NULL, NULL, NULL, &error),
                  GM_IO_OK);
    GM_ASSERT_INT(quality.quality_class, 0);
    GM_ASSERT_NAN(worst(GM_QUALITY_PROFILE_FORM));
    GM_ASSERT_INT(quality.worst[GM_QUALITY_PROFILE_FORM].tooth, -1);
}

/* Far below what can be measured, down to numbers with few digits: small, not wrong. */
static void deviations_of_any_size_measure_to_the_best_class(void) {
    static const double sizes[] = {1e-20, 1e-200, 1e-304, 1e-310, 4.9406564584124654e-324};
    for (int i = 0; i < 5; ++i) {
        const gm_pair of = module_3();
        begin(&of, 0);
        gm_test_context("%g m", sizes[i]);
        for (int node = 0; node < FACE_NODES * PROFILE_NODES; ++node) {
            table[node] = node % 3 ? sizes[i] : -sizes[i];
        }
        drive[3] = coast[5] = sizes[i];
        GM_ASSERT_INT(evaluate(0), GM_IO_OK);
        for (int kind = 0; kind < GM_QUALITY_KINDS; ++kind) {
            GM_ASSERT(worst(kind) >= 0.0 && worst(kind) <= 8.0 * sizes[i]);
            GM_ASSERT_INT(quality.worst[kind].quality_class, 1);
        }
    }
}

static void refused(int status, const char *text) {
    GM_ASSERT_INT(evaluate(0), status);
    gm_test_context("%.150s", error.text);
    GM_ASSERT(strstr(error.text, text) != NULL);
    GM_ASSERT_INT(quality.quality_class, 0);
    GM_ASSERT_NAN(worst(GM_QUALITY_SINGLE_PITCH));
    gm_test_context("%s", "");
}

static void wrong_input_is_refused(void) {
    const gm_pair gears = module_3();
    begin(&gears, 0);
    options.profile_to = 1.1;
    refused(GM_IO_ERR_OPTION, "within 0 to 1");
    begin(&gears, 0);
    options.profile_from = 0.95;
    refused(GM_IO_ERR_OPTION, "begin before it ends");
    begin(&gears, 0);
    options.face_margin = 0.5;
    refused(GM_IO_ERR_OPTION, "0.45");
    begin(&gears, 0);
    deviations.teeth = 39;
    refused(GM_IO_ERR_OPTION, "flank deviations must be for the 40 teeth of the gear (got 39)");
    begin(&gears, 0);
    pitch.teeth = 41;
    refused(GM_IO_ERR_OPTION, "pitch deviations must be for the 40 teeth of the gear (got 41)");
    begin(&gears, 0);
    drive[2] = (double)NAN;
    refused(GM_IO_ERR_OPTION, "tooth 2: must be finite");
    begin(&gears, 0);
    table[3] = (double)INFINITY;
    refused(GM_IO_ERR_OPTION, "must be finite");
    GM_ASSERT_INT(gm_quality_evaluate(NULL, NULL, &pair, 0, NULL, NULL, NULL, &error),
                  GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_quality_evaluate(&quality, NULL, NULL, 0, NULL, NULL, NULL, NULL),
                  GM_IO_ERR_NULL);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(tolerances_are_those_of_the_formulae),
        GM_TEST(the_wheel_has_tolerances_of_its_own_diameter),
        GM_TEST(no_tolerance_where_there_is_no_class),
        GM_TEST(scope_ends_where_the_standard_says),
        GM_TEST(a_value_at_the_limit_is_within_the_class),
        GM_TEST(a_slope_is_the_rise_over_the_whole_flank),
        GM_TEST(a_falling_slope_is_negative_and_its_size_counts),
        GM_TEST(a_crowning_is_form),
        GM_TEST(the_face_margin_is_the_smaller_of_both),
        GM_TEST(behind_the_range_only_excess_of_material_counts),
        GM_TEST(the_mean_line_is_that_of_least_squares),
        GM_TEST(an_even_grid_is_read_halfway_between_its_middle_lines),
        GM_TEST(the_flank_with_the_worst_value_is_named),
        GM_TEST(pitch_is_an_arc_at_the_reference_circle),
        GM_TEST(a_pitch_goes_round_the_gear),
        GM_TEST(run_out_is_twice_the_eccentricity),
        GM_TEST(a_space_that_stands_elsewhere_has_no_run_out),
        GM_TEST(what_no_file_says_is_not_evaluated),
        GM_TEST(deviations_of_any_size_measure_to_the_best_class),
        GM_TEST(wrong_input_is_refused),
    };
    return gm_test_main("unit.quality_evaluate", tests, GM_TEST_COUNT(tests), argc, argv);
}
