/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Stretches of a trace that were filled in, not measured: found with tooth, place and line wherever they are and whatever
 * the value, and left out on request; and none found on flanks that are flat, relieved, crowned, rounded or that run into
 * fillet and chamfer.
 */
#include "io_test.h"
#include "reference_gear.h"

enum { POINTS = 240, TEETH_MEASURED = 4 };

static gm_pair pair;
static gm_traces traces;
static gm_measurement setup;
static gm_traces_options options;
static gm_deviations deviations;
static gm_traces_report report;
static gm_io_error error;

static void begin(void) {
    pair = reference_pair(REFERENCE_FACE_WIDTH);
    gm_measurement_default(&setup);
    setup.datum_face = GM_FACE_I;
    setup.counting = GM_CLOCKWISE;
    gm_traces_options_default(&options);
    memset(&traces, 0, sizeof traces);
    strcpy(traces.file, "traces.csv");
}

static void end(void) {
    gm_traces_free(&traces);
    gm_deviations_free(&deviations);
}

static int build(void) {
    gm_deviations_free(&deviations);
    return gm_traces_build(&deviations, &report, &traces, &setup, &pair, 0, &options, &error);
}

/* ---------------------------------------------------------------------------------------------
 * Traces
 * ------------------------------------------------------------------------------------------- */

/* Deviation at t, in um. */
typedef double shape(double t);

static double rough_state;

/* About normal, standard deviation 1, the same numbers in every run. */
static double noise(void) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) {
        rough_state = fmod(16807.0 * rough_state, 2147483647.0);
        sum += rough_state / 2147483647.0;
    }
    return sum;
}

static double position_of(int kind, double t) {
    const gm_gear *gear = &pair.pinion;
    return kind == GM_TRACE_HELIX
               ? t * pair.face_width
               : gear->start_roll_length + t * (gear->tip_roll_length - gear->start_roll_length);
}

/*
 * Adds a trace of a tooth from t = from to 1, of this shape and roughness (um), rounded to a resolution (um) if that is
 * not 0. Its line numbers run on from trace to trace.
 */
static gm_trace *add_trace(int tooth, int kind, double from, int count, shape *of, double level,
                           double roughness, double resolution) {
    gm_trace *grown = realloc(traces.traces, (size_t)(traces.count + 1) * sizeof *grown);
    traces.traces = grown;
    gm_trace *trace = &grown[traces.count++];
    memset(trace, 0, sizeof *trace);
    trace->tooth = tooth;
    trace->flank = GM_LEFT;
    trace->kind = kind;
    trace->at = kind == GM_TRACE_HELIX ? position_of(GM_TRACE_PROFILE, 0.5) : 0.5 * pair.face_width;
    trace->count = count;
    trace->position = malloc((size_t)count * sizeof(double));
    trace->deviation = malloc((size_t)count * sizeof(double));
    trace->line = malloc((size_t)count * sizeof(long));
    for (int k = 0; k < count; ++k) {
        const double t = from + (1.0 - from) * k / (count - 1);
        double um = level + of(t) + (roughness > 0.0 ? roughness * noise() : 0.0);
        um = resolution > 0.0 ? resolution * floor(um / resolution + 0.5) : um;
        trace->position[k] = position_of(kind, t);
        trace->deviation[k] = 1e-6 * um;
        trace->line[k] = 2 + (long)(traces.count - 1) * count + k;
    }
    return trace;
}

/* Fills points first .. first + count - 1 with a value (um). */
static void fill(gm_trace *trace, int first, int count, double um) {
    for (int k = first; k < first + count; ++k) {
        trace->deviation[k] = 1e-6 * um;
    }
}

static double flat(double t) {
    return 0.0 * t;
}

static double sloped(double t) {
    return 6.0 * t;
}

static double crowned(double t) {
    return -20.0 * (2.0 * t - 1.0) * (2.0 * t - 1.0);
}

/* ---------------------------------------------------------------------------------------------
 * Filled stretches
 * ------------------------------------------------------------------------------------------- */

typedef struct fault {
    int first;
    int count;
    double um;
} fault;

static void assert_told(const gm_trace *trace, const fault *of) {
    char tooth[64];
    char count[64];
    snprintf(tooth, sizeof tooth, "the %s trace of tooth %d, flank left",
             trace->kind == GM_TRACE_PROFILE ? "profile" : "helix", trace->tooth);
    snprintf(count, sizeof count, "%g um at all %d points from ", of->um, of->count);
    GM_ASSERT_INT(build(), GM_IO_ERR_FORMAT);
    assert_error(&error, "traces.csv", trace->line[of->first], tooth,
                 "all points must be measured, rows without");
    GM_ASSERT(strstr(error.text, count) != NULL);
    GM_ASSERT(error.option != NULL && strcmp(error.option, "remove_spikes") == 0);
}

static void one_filled_stretch_is_told_by_tooth_and_place(void) {
    static shape *const shapes[] = {flat, sloped, crowned};
    static const fault faults[] = {
        {0, 12, 0.0},    {POINTS - 12, 12, 0.0}, {0, 3, 0.0},    {POINTS - 3, 3, 0.0},
        {0, 1, 0.0},     {POINTS - 1, 1, 0.0},   {0, 2, 0.0},    {0, 100, 0.0},
        {90, 40, 0.0},   {0, 12, -99.0},         {0, 12, -20.0}, {POINTS - 30, 30, 12.5},
        {60, 25, -100.0}};
    for (int face = GM_FACE_I; face <= GM_FACE_II; ++face) {
        for (int kind = GM_TRACE_PROFILE; kind <= GM_TRACE_HELIX; ++kind) {
            for (size_t i = 0; i < 3 * sizeof faults / sizeof faults[0]; ++i) {
                const fault *of = &faults[i / 3];
                begin();
                gm_test_context("face %d, kind %d, fault %d, shape %d", face, kind, (int)i / 3,
                                (int)i % 3);
                setup.datum_face = face;
                rough_state = 1.0 + (double)i;
                for (int tooth = 1; tooth <= TEETH_MEASURED; ++tooth) {
                    add_trace(5 * tooth, kind, 0.0, POINTS, shapes[i % 3], -56.0, 0.3, 1e-3);
                }
                GM_ASSERT_INT(build(), GM_IO_OK);
                GM_ASSERT_INT(report.filled_points, 0);
                fill(&traces.traces[2], of->first, of->count, of->um);
                assert_told(&traces.traces[2], of);
                end();
            }
        }
    }
}

static void both_ends_of_all_traces_can_be_left_out(void) {
    begin();
    rough_state = 7.0;
    for (int tooth = 1; tooth <= TEETH_MEASURED; ++tooth) {
        add_trace(tooth, GM_TRACE_HELIX, 0.0, POINTS, crowned, -56.0, 0.3, 1e-3);
    }
    GM_ASSERT_INT(build(), GM_IO_OK);
    const double right = deviations.sets[0].values[10 * deviations.profile_nodes];
    for (int tooth = 0; tooth < TEETH_MEASURED; ++tooth) {
        fill(&traces.traces[tooth], 0, 12, 0.0);
        fill(&traces.traces[tooth], POINTS - 20, 20, 0.0);
    }
    assert_told(&traces.traces[0], &(fault){0, 12, 0.0});
    options.remove_spikes = 1;
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(report.filled_points, 32 * TEETH_MEASURED);
    GM_ASSERT_ABS(report.face_range[0], 12.0 / (POINTS - 1), 1e-12);
    GM_ASSERT_ABS(report.face_range[1], (POINTS - 21.0) / (POINTS - 1), 1e-12);
    GM_ASSERT_ABS(deviations.sets[0].values[10 * deviations.profile_nodes], right, 1e-12);
    end();
}

/* If too little is left, the message says what is left, not what the file reaches over. */
static void too_much_left_out_is_told_with_what_is_left(void) {
    for (int face = GM_FACE_I; face <= GM_FACE_II; ++face) {
        begin();
        gm_test_context("face %d", face);
        setup.datum_face = face;
        options.remove_spikes = 1;
        rough_state = 6.0;
        gm_trace *trace = add_trace(1, GM_TRACE_HELIX, 0.0, 201, crowned, -56.0, 0.3, 1e-3);
        fill(trace, 0, 50, 0.0); /* a quarter, and a fifth may be missing */
        GM_ASSERT_INT(build(), GM_IO_ERR_FORMAT);
        assert_error(&error, "traces.csv", trace->line[0], "(got 4.375 to 17.5 mm)",
                     "must reach from 0 to 17.5 mm");
        end();
    }
}

/* A filter or a new sampling smears the edge of what was filled in. */
static void a_smeared_edge_is_a_step_all_the_same(void) {
    for (int width = 1; width <= 3; ++width) {
        begin();
        gm_test_context("%d points on the way", width);
        rough_state = 3.0;
        gm_trace *trace = add_trace(1, GM_TRACE_HELIX, 0.0, POINTS, crowned, -56.0, 0.3, 1e-3);
        fill(trace, 0, 12, 0.0);
        for (int k = 0; k < width; ++k) {
            trace->deviation[12 + k] *= (k + 1.0) / (width + 1.0);
        }
        assert_told(trace, &(fault){0, 12, 0.0});
        end();
    }
}

/* Computed traces have no roughness; the same holds there. */
static void ends_of_computed_traces_are_told(void) {
    static shape *const shapes[] = {flat, sloped, crowned};
    for (int i = 0; i < 3; ++i) {
        begin();
        gm_test_context("shape %d", i);
        gm_trace *trace = add_trace(1, GM_TRACE_HELIX, 0.0, 41, shapes[i], -40.0, 0.0, 0.0);
        fill(trace, 0, 4, 0.0);
        fill(trace, 37, 4, 0.0);
        assert_told(trace, &(fault){0, 4, 0.0});
        options.remove_spikes = 1;
        GM_ASSERT_INT(build(), GM_IO_OK);
        GM_ASSERT_INT(report.filled_points, 8);
        end();
    }
}

/* If next to nothing is left, leaving out does not help. */
static void a_trace_of_nothing_but_fillings_is_refused(void) {
    begin();
    options.remove_spikes = 1;
    rough_state = 5.0;
    gm_trace *trace = add_trace(1, GM_TRACE_HELIX, 0.0, 60, flat, -40.0, 0.3, 0.0);
    fill(trace, 0, 20, 0.0);
    fill(trace, 20, 20, -40.0);
    fill(trace, 40, 20, 0.0);
    GM_ASSERT_INT(build(), GM_IO_ERR_FORMAT);
    assert_error(&error, "traces.csv", trace->line[40], "0 um at all 20 points",
                 "all points must be measured, rows without");
    end();
}

/* What the documentation says: steps above 2 um; three equal points, of fewer it may be the edge of the flank. */
static void the_limits_are_as_documented(void) {
    for (int above = 0; above <= 1; ++above) {
        begin();
        rough_state = 4.0;
        gm_trace *trace = add_trace(1, GM_TRACE_HELIX, 0.0, POINTS, flat, -50.0, 0.05, 1e-3);
        fill(trace, 0, 12, above ? -47.7 : -48.3);
        GM_ASSERT_INT(build(), above ? GM_IO_ERR_FORMAT : GM_IO_OK);
        fill(trace, 0, 12, -50.1);
        fill(trace, 0, 2 + above, -99.0);
        GM_ASSERT_INT(build(), above ? GM_IO_ERR_FORMAT : GM_IO_OK);
        end();
    }
}

/* ---------------------------------------------------------------------------------------------
 * Flanks that only look so
 * ------------------------------------------------------------------------------------------- */

/* Plain, then a linear relief of 60 um over the last 3 %. */
static double steep_relief(double t) {
    return t > 0.97 ? -60.0 * (t - 0.97) / 0.03 : 0.0;
}

static double long_relief(double t) {
    return t > 0.7 ? -300.0 * (t - 0.7) * (t - 0.7) : 0.0;
}

/* Plain in the middle, relieved linearly at both ends. */
static double end_reliefs(double t) {
    const double outside = fmax(0.15 - t, t - 0.85);
    return outside > 0.0 ? -120.0 * outside : 0.0;
}

/* The fillet below, which stands out by 25 um where the trace begins, and the edge break at the tip. */
static double fillet_and_chamfer(double t) {
    const double fillet = t < 0.05 ? 25.0 * pow((0.05 - t) / 0.05, 3.0) : 0.0;
    const double chamfer = t > 0.98 ? 50.0 * (t - 0.98) / 0.02 : 0.0;
    return fillet - chamfer - 3.0 * (2.0 * t - 1.0) * (2.0 * t - 1.0);
}

/* The same, counted from its first point on, as some machines do: that is 0. */
static double from_first_point(double t) {
    return fillet_and_chamfer(t) - fillet_and_chamfer(0.0);
}

/* The last points have fallen off the edge. */
static double off_the_edge(double t) {
    return t > 0.995 ? -45.0 - 2000.0 * (t - 0.995) : 4.0 * t;
}

static double waved(double t) {
    return 8.0 * sin(20.0 * t);
}

static void flanks_as_they_are_raise_no_alarm(void) {
    static shape *const shapes[] = {flat,
                                    sloped,
                                    crowned,
                                    steep_relief,
                                    long_relief,
                                    end_reliefs,
                                    fillet_and_chamfer,
                                    from_first_point,
                                    waved,
                                    off_the_edge};
    static const int counts[] = {5, 9, 10, 11, 21, 31, 41, 101, 240, 481};
    static const double roughness[] = {0.0, 0.2, 0.5, 1.5};
    static const double resolutions[] = {0.0, 1e-3, 0.1, 0.5, 1.0};
    for (int i = 0; i < 10 * 10 * 4 * 5 * 2; ++i) {
        const int kind = i % 2;
        const int which = i / 2 % 10;
        const int count = counts[i / 20 % 10];
        const double rough = roughness[i / 200 % 4];
        const double resolution = resolutions[i / 800];
        /* Of one single point beyond the edge, dust cannot be told. */
        if (shapes[which] == off_the_edge && count < 240) {
            continue;
        }
        begin();
        gm_test_context("kind %d, shape %d, %d points, roughness %g, resolution %g", kind, which,
                        count, rough, resolution);
        options.hollow = 1;
        options.remove_spikes = 1; /* what is judged here is not these */
        rough_state = 11.0 + i;
        add_trace(1, kind, 0.0, count, shapes[which], which % 2 ? -17.0 : 0.0, rough, resolution);
        GM_ASSERT_INT(build(), GM_IO_OK);
        GM_ASSERT_INT(report.filled_points, 0);
        end();
    }
}

/* Below the active profile nothing is used, so what stands there does no harm. */
static void what_is_filled_below_the_active_profile_is_not_judged(void) {
    begin();
    rough_state = 2.0;
    gm_trace *trace = add_trace(1, GM_TRACE_PROFILE, -0.1, 221, sloped, -56.0, 0.3, 1e-3);
    fill(trace, 0, 20, 0.0); /* the 21st point is at t2 = 0 */
    GM_ASSERT_INT(build(), GM_IO_OK);
    fill(trace, 0, 21, 0.0);
    assert_told(trace, &(fault){0, 21, 0.0});
    end();
}

/* A flank that was not measured at all looks ideal. It is reported where others vary. */
static void a_constant_trace_among_others_is_reported(void) {
    begin();
    rough_state = 2.0;
    for (int tooth = 1; tooth <= TEETH_MEASURED; ++tooth) {
        add_trace(tooth, GM_TRACE_PROFILE, 0.0, POINTS, flat, 0.0, 0.0, 0.0);
        add_trace(tooth, GM_TRACE_HELIX, 0.0, POINTS, flat, 0.0, tooth == 3 ? 0.0 : 0.3, 0.0);
    }
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(report.constant_traces, 1); /* profiles are all alike: ideal */
    GM_ASSERT_INT(report.constant_trace, 5);
    fill(&traces.traces[1], 0, POINTS, 3.0);
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(report.constant_traces, 2);
    GM_ASSERT_INT(report.constant_trace, 1);
    traces.traces[1].deviation[5] = 3.5e-6;
    traces.traces[5].deviation[5] = 0.5e-6;
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(report.constant_traces, 0);
    GM_ASSERT_INT(report.constant_trace, -1);
    end();
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(one_filled_stretch_is_told_by_tooth_and_place),
        GM_TEST(both_ends_of_all_traces_can_be_left_out),
        GM_TEST(too_much_left_out_is_told_with_what_is_left),
        GM_TEST(a_smeared_edge_is_a_step_all_the_same),
        GM_TEST(ends_of_computed_traces_are_told),
        GM_TEST(a_trace_of_nothing_but_fillings_is_refused),
        GM_TEST(the_limits_are_as_documented),
        GM_TEST(flanks_as_they_are_raise_no_alarm),
        GM_TEST(what_is_filled_below_the_active_profile_is_not_judged),
        GM_TEST(a_constant_trace_among_others_is_reported),
    };
    return gm_test_main("unit.trace_fill", tests, GM_TEST_COUNT(tests), argc, argv);
}
