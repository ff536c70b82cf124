/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Tables from traces: surfaces of closed form come back from their traces, whichever way the gear stood on the machine;
 * made flanks keep their quality; teeth in between; every refusal that needs the gear.
 */
#include "io_test.h"
#include "reference_gear.h"

#define FACE_NODES    21
#define PROFILE_NODES 31

static gm_pair pair;
static int wheel;
static gm_traces traces;
static gm_measurement setup;
static gm_traces_options options;
static gm_deviations deviations;
static gm_traces_report report;
static gm_io_error error;

static const gm_gear *gear(void) {
    return wheel ? &pair.wheel : &pair.pinion;
}

static void begin(void) {
    pair = reference_pair(REFERENCE_FACE_WIDTH);
    wheel = 0;
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
    return gm_traces_build(&deviations, &report, &traces, &setup, &pair, wheel, &options, &error);
}

/* ---------------------------------------------------------------------------------------------
 * Traces of a surface, in the words of the machine
 * ------------------------------------------------------------------------------------------- */

/* Deviation of a flank at t1, t2 (m). */
typedef double surface(int tooth, int side, double t1, double t2);

static double face_of(double t1) {
    return pair.face_width * (setup.datum_face == GM_FACE_I ? t1 : 1.0 - t1);
}

static double roll_of(double t2) {
    return gear()->start_roll_length + t2 * (gear()->tip_roll_length - gear()->start_roll_length);
}

/* Which number the machine gives to a tooth. */
static int number_of(int tooth) {
    for (int number = 0; number <= gear()->teeth; ++number) {
        if (gm_measurement_tooth(&setup, &pair, wheel, number) == tooth) {
            return number;
        }
    }
    return -1;
}

static int flank_of(int side) {
    return gm_measurement_side(&setup, GM_LEFT) == side ? GM_LEFT : GM_RIGHT;
}

/* A trace at t1 (profile) or t2 (helix), through count points from t = from to to, moved by a constant. */
static void add_trace(surface *of, int tooth, int side, int kind, double at, double from, double to,
                      int count, double constant) {
    gm_trace *grown = malloc((size_t)(traces.count + 1) * sizeof *grown);
    if (traces.count > 0) {
        memcpy(grown, traces.traces, (size_t)traces.count * sizeof *grown);
    }
    free(traces.traces);
    traces.traces = grown;
    gm_trace *trace = &grown[traces.count++];
    memset(trace, 0, sizeof *trace);
    const int profile = kind == GM_TRACE_PROFILE;
    trace->tooth = number_of(tooth);
    trace->flank = flank_of(side);
    trace->kind = kind;
    trace->at = profile ? face_of(at) : roll_of(at);
    trace->count = count;
    trace->position = malloc((size_t)count * sizeof(double));
    trace->deviation = malloc((size_t)count * sizeof(double));
    const int turned = !profile && setup.datum_face == GM_FACE_II;
    for (int i = 0; i < count; ++i) {
        const double t = from + (to - from) * i / (count - 1);
        const int place = turned ? count - 1 - i : i;
        trace->position[place] = profile ? roll_of(t) : face_of(t);
        trace->deviation[place] =
            (profile ? of(tooth, side, at, t) : of(tooth, side, t, at)) + constant;
    }
}

static void add_profile(surface *of, int tooth, int side, double t1, double constant) {
    add_trace(of, tooth, side, GM_TRACE_PROFILE, t1, 0.0, 1.0, PROFILE_NODES, constant);
}

static void add_helix(surface *of, int tooth, int side, double t2, double constant) {
    add_trace(of, tooth, side, GM_TRACE_HELIX, t2, 0.0, 1.0, FACE_NODES, constant);
}

static const double *table_of(int tooth, int side) {
    for (int i = 0; i < deviations.set_count; ++i) {
        const gm_deviation_set *set = &deviations.sets[i];
        if ((set->tooth == tooth || set->tooth < 0) && set->side == side) {
            return set->values;
        }
    }
    return NULL;
}

/* t2 of the reference circle. */
static double t2_of_pitch(void) {
    const double roll = sqrt(pow(gear()->reference_radius, 2.0) - pow(gear()->base_radius, 2.0));
    return (roll - roll_of(0.0)) / (roll_of(1.0) - roll_of(0.0));
}

/* The table as a bilinear surface. */
static double table_at(const double *table, double t1, double t2) {
    const int i = (int)fmin(t1 * (FACE_NODES - 1), FACE_NODES - 2);
    const int k = (int)fmin(t2 * (PROFILE_NODES - 1), PROFILE_NODES - 2);
    const double x = t1 * (FACE_NODES - 1) - i;
    const double y = t2 * (PROFILE_NODES - 1) - k;
    const double *at = table + i * PROFILE_NODES + k;
    return (1 - x) * ((1 - y) * at[0] + y * at[1]) +
           x * ((1 - y) * at[PROFILE_NODES] + y * at[PROFILE_NODES + 1]);
}

/* A flank of the tables is the surface at the nodes, up to a constant that makes it zero where the pitch is taken. */
static void assert_surface(surface *of, int tooth, int side) {
    const double *table = table_of(tooth, side);
    if (!GM_ASSERT(table != NULL)) {
        return;
    }
    double worst = 0.0;
    const double constant = table[0] - of(tooth, side, 0.0, 0.0);
    for (int i = 0; i < FACE_NODES; ++i) {
        for (int k = 0; k < PROFILE_NODES; ++k) {
            const double expected =
                of(tooth, side, (double)i / (FACE_NODES - 1), (double)k / (PROFILE_NODES - 1)) +
                constant;
            worst = fmax(worst, fabs(table[i * PROFILE_NODES + k] - expected));
        }
    }
    GM_ASSERT_ABS(worst, 0.0, 1e-16); /* of some 10 um */
    GM_ASSERT_ABS(table_at(table, 0.5, t2_of_pitch()), 0.0, 1e-16);
}

/* ---------------------------------------------------------------------------------------------
 * Surfaces
 * ------------------------------------------------------------------------------------------- */

/* Slopes, crowning and relief, all different from flank to flank. */
static double additive(int tooth, int side, double t1, double t2) {
    const double u = t1 - 0.5;
    const double v = t2 - 0.4;
    return 1e-6 * ((tooth + 1) * u - 8.0 * u * u + (side ? 3.0 : -2.0) * v - (5.0 + tooth) * v * v +
                   (v > 0.3 ? -70.0 * (v - 0.3) * (v - 0.3) : 0.0));
}

static void profile_and_helix_come_back_as_their_sum(void) {
    begin();
    for (int which = 0; which < 8; ++which) {
        gm_test_context("case %d", which);
        wheel = which & 1;
        setup.datum_face = which & 2 ? GM_FACE_II : GM_FACE_I;
        setup.counting = which & 4 ? GM_COUNTERCLOCKWISE : GM_CLOCKWISE;
        setup.first_tooth = 5 * which;
        for (int side = 0; side < 2; ++side) {
            for (int tooth = 1; tooth < 41; tooth += 13) {
                add_helix(additive, tooth, side, 0.4, 17e-6 * tooth); /* between two nodes */
                add_profile(additive, tooth, side, 0.55, -3e-6);
            }
        }
        GM_ASSERT_INT(build(), GM_IO_OK);
        GM_ASSERT_INT(report.profile_teeth[GM_DRIVE], 4);
        GM_ASSERT_INT(report.helix_traces[GM_COAST], 4);
        GM_ASSERT_ABS(report.crossing_error, 0.0, 1e-18);
        GM_ASSERT_ABS(report.resampling_error, 0.0, 1e-18);
        for (int tooth = 1; tooth < 41; tooth += 13) {
            assert_surface(additive, tooth, GM_DRIVE);
            assert_surface(additive, tooth, GM_COAST);
        }
        gm_traces_free(&traces);
        gm_deviations_free(&deviations);
    }
}

/* With a twist. */
static double twisted(int tooth, int side, double t1, double t2) {
    return additive(tooth, side, t1, t2) + 12e-6 * (t1 - 0.5) * (t2 - 0.5) * (side ? -1 : 1);
}

static void a_twist_comes_back_from_two_traces_each_way(void) {
    begin();
    for (int face = GM_FACE_I; face <= GM_FACE_II; ++face) {
        setup.datum_face = face;
        for (int side = 0; side < 2; ++side) {
            /* At nodes, as the crossings are; every trace at a level of its own, in any order. */
            add_profile(twisted, 2, side, 0.8, 5e-6);
            add_helix(twisted, 2, side, 0.2, -4e-6);
            add_profile(twisted, 2, side, 0.2, 1e-6);
            add_helix(twisted, 2, side, 0.9, 2e-6);
        }
        GM_ASSERT_INT(build(), GM_IO_OK);
        GM_ASSERT_ABS(report.crossing_error, 0.0, 1e-17);
        assert_surface(twisted, 2, GM_DRIVE);
        assert_surface(twisted, 2, GM_COAST);
        GM_ASSERT_INT(deviations.sets[0].tooth, -1); /* all teeth are like the one measured */
        end();
        traces.count = 0;
        strcpy(traces.file, "traces.csv");
    }
    /* Two profiles and one helix say it as well: the twist is bilinear. */
    add_profile(twisted, 2, 0, 0.1, 0.0);
    add_profile(twisted, 2, 0, 0.9, 0.0);
    add_helix(twisted, 2, 0, 0.5, 0.0);
    GM_ASSERT_INT(build(), GM_IO_OK);
    assert_surface(twisted, 2, GM_DRIVE);
    end();
}

/* The twist itself is curved along the face. */
static double curved_twist(int tooth, int side, double t1, double t2) {
    return additive(tooth, side, t1, t2) + 40e-6 * (t1 - 0.3) * (t1 - 0.3) * (t2 - 0.4);
}

static void three_profiles_are_met_and_the_surface_is_linear_in_between(void) {
    static const int places[] = {0, 8, 20};
    begin();
    for (int i = 0; i < 3; ++i) {
        add_profile(curved_twist, 2, 0, places[i] / 20.0, 1e-6 * i);
    }
    add_helix(curved_twist, 2, 0, 0.2, 0.0);
    GM_ASSERT_INT(build(), GM_IO_OK);
    const double *table = table_of(2, 0);
    for (int k = 0; table != NULL && k < PROFILE_NODES; ++k) {
        const double t2 = (double)k / (PROFILE_NODES - 1);
        double rise[3]; /* from where the helix is */
        for (int i = 0; i < 3; ++i) {
            const double *row = table + places[i] * PROFILE_NODES;
            rise[i] = row[k] - row[6];
            GM_ASSERT_ABS(rise[i],
                          curved_twist(2, 0, places[i] / 20.0, t2) -
                              curved_twist(2, 0, places[i] / 20.0, 0.2),
                          1e-16);
            GM_ASSERT_ABS(row[6] - table[6],
                          curved_twist(2, 0, places[i] / 20.0, 0.2) - curved_twist(2, 0, 0.0, 0.2),
                          1e-16);
        }
        const double *low = table + 4 * PROFILE_NODES;
        const double *high = table + 17 * PROFILE_NODES;
        GM_ASSERT_ABS(low[k] - low[6], 0.5 * (rise[0] + rise[1]), 1e-16);
        GM_ASSERT_ABS(high[k] - high[6], 0.25 * rise[1] + 0.75 * rise[2], 1e-16);
    }
    end();
}

static void too_many_traces_of_a_flank_are_refused(void) {
    begin();
    for (int i = 0; i <= 100; ++i) {
        add_profile(additive, 2, 0, i / 100.0, 0.0);
    }
    GM_ASSERT_INT(build(), GM_IO_ERR_FORMAT);
    assert_error(&error, "traces.csv", 0, "101 profiles", "at most 100 of a kind");
    traces.traces[0].flank = flank_of(1); /* 100 on one, 1 on the other */
    GM_ASSERT_INT(build(), GM_IO_OK);
    end();
}

static void beyond_close_traces_the_surface_does_not_run_away(void) {
    begin();
    /* Profiles at 0.5 and 0.6: straight on from 0.4 to 0.7, held beyond. */
    add_profile(twisted, 2, 0, 0.5, 0.0);
    add_profile(twisted, 2, 0, 0.6, 0.0);
    GM_ASSERT_INT(build(), GM_IO_OK);
    const double *table = table_of(0, GM_DRIVE);
    for (int k = 0; table != NULL && k < PROFILE_NODES; ++k) {
        GM_ASSERT_ABS(table[k], table[8 * PROFILE_NODES + k], 1e-18);
        GM_ASSERT_ABS(table[20 * PROFILE_NODES + k], table[14 * PROFILE_NODES + k], 1e-18);
        const double slope = table[12 * PROFILE_NODES + k] - table[10 * PROFILE_NODES + k];
        GM_ASSERT_ABS(table[14 * PROFILE_NODES + k], table[10 * PROFILE_NODES + k] + 2.0 * slope,
                      1e-17);
    }
    end();
}

/* Traces of one kind alone: constant in the other direction. */
static void one_kind_alone_is_constant_the_other_way(void) {
    begin();
    add_profile(additive, 0, GM_DRIVE, 0.3, 0.0);
    add_helix(additive, 0, GM_COAST, 0.6, 0.0);
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(report.helix_teeth[GM_DRIVE], 0);
    GM_ASSERT_INT(deviations.set_count, 2);
    const double *drive = table_of(30, GM_DRIVE);
    const double *coast = table_of(30, GM_COAST);
    for (int node = 0; node < FACE_NODES * PROFILE_NODES; ++node) {
        GM_ASSERT_ABS(drive[node], drive[node % PROFILE_NODES], 1e-18);
        GM_ASSERT_ABS(coast[node], coast[node - node % PROFILE_NODES], 1e-18);
    }
    GM_ASSERT_ABS(drive[30] - drive[12], additive(0, 0, 0, 1) - additive(0, 0, 0, 0.4), 1e-16);
    end();
}

static double parabola(int tooth, int side, double t1, double t2) {
    (void)tooth;
    (void)side;
    (void)t1;
    return -40e-6 * t2 * t2;
}

static void resampling_is_linear_and_its_error_is_told(void) {
    begin();
    /* Points at all nodes and halfway: there the polygon is off by c h^2 / 4. */
    add_trace(parabola, 0, 0, GM_TRACE_PROFILE, 0.5, 0.0, 1.0, 2 * PROFILE_NODES - 1, 0.0);
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_REL(report.resampling_error, 40e-6 / (30.0 * 30.0) / 4.0, 1e-9);
    assert_surface(parabola, 0, GM_DRIVE);
    end();
    begin();
    /* Few uneven points: the table is their polygon. */
    add_trace(parabola, 0, 0, GM_TRACE_PROFILE, 0.5, 0.0, 1.0, 4, 0.0);
    traces.traces[0].position[1] = roll_of(0.1);
    GM_ASSERT_INT(build(), GM_IO_OK);
    const double *table = table_of(0, GM_DRIVE);
    const double y[4] = {0.0, parabola(0, 0, 0, 1.0 / 3), parabola(0, 0, 0, 2.0 / 3), -40e-6};
    GM_ASSERT_ABS(table[3] - table[0], y[1] - y[0], 1e-16);
    GM_ASSERT_ABS(table[6] - table[0], y[1] + (y[2] - y[1]) * 0.1 / (2.0 / 3 - 0.1), 1e-16);
    end();
}

static void ends_that_were_left_out_are_held_and_told(void) {
    begin();
    add_trace(parabola, 0, 0, GM_TRACE_PROFILE, 0.5, 0.1, 0.9, 25, 0.0);
    add_trace(additive, 0, 0, GM_TRACE_HELIX, 0.5, 0.05, 0.85, 17, 0.0);
    /* Below the active profile there may be more. */
    add_trace(parabola, 0, 1, GM_TRACE_PROFILE, 0.5, -0.1, 1.0, 34, 0.0);
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_REL(report.profile_range[0], 0.1, 1e-12);
    GM_ASSERT_REL(report.profile_range[1], 0.9, 1e-12);
    GM_ASSERT_REL(report.face_range[0], 0.05, 1e-12);
    GM_ASSERT_REL(report.face_range[1], 0.85, 1e-12);
    const double *table = table_of(0, GM_DRIVE);
    GM_ASSERT_ABS(table[0], table[3], 1e-18);
    GM_ASSERT_ABS(table[30], table[27], 1e-18);
    GM_ASSERT_ABS(table[20 * PROFILE_NODES], table[17 * PROFILE_NODES], 1e-18);
    assert_surface(parabola, 0, GM_COAST);
    gm_deviations_free(&deviations);
    options.held_limit = 0.12;
    GM_ASSERT_INT(build(), GM_IO_ERR_FORMAT);
    assert_error(&error, "traces.csv", 0, "the helix trace of tooth 1", "0.12 may be missing");
    end();
}

static void transverse_deviations_are_turned_into_the_normal(void) {
    begin();
    add_profile(additive, 0, 0, 0.5, 0.0);
    GM_ASSERT_INT(build(), GM_IO_OK);
    const double along_normal = table_of(0, 0)[0];
    gm_deviations_free(&deviations);
    setup.transverse = 1;
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_REL(table_of(0, 0)[0], along_normal * cos(pair.base_helix_angle), 1e-12);
    end();
}

/* ---------------------------------------------------------------------------------------------
 * Teeth in between
 * ------------------------------------------------------------------------------------------- */

/* A slope from tooth to tooth. */
static double slope_of_tooth(int tooth, int side, double t1, double t2) {
    (void)side;
    return 1e-6 * (tooth * (t2 - 0.5) + 2 * tooth * (t1 - 0.5));
}

static void teeth_in_between_are_linear_around_the_gear(void) {
    begin();
    add_profile(slope_of_tooth, 40, 0, 0.5, 0.0);
    add_profile(slope_of_tooth, 5, 0, 0.5, 0.0); /* ten teeth on: 40, 41 .. 44, 0, .. 5 */
    add_profile(slope_of_tooth, 10, 0, 0.5, 0.0);
    add_helix(slope_of_tooth, 10, 0, 0.5, 0.0); /* the only helix: that of all */
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(deviations.set_count, 45);
    for (int tooth = 0; tooth < 45; ++tooth) {
        const double *table = table_of(tooth, GM_DRIVE);
        const double slope = tooth >= 40   ? 40 + (5 - 40) * (tooth - 40) / 10.0
                             : tooth < 5   ? 40 + (5 - 40) * (tooth + 5) / 10.0
                             : tooth <= 10 ? tooth
                                           : 10 + (tooth - 10);
        GM_ASSERT_ABS(table[30] - table[0], 1e-6 * slope, 1e-16);
        GM_ASSERT_ABS(table[20 * PROFILE_NODES] - table[0], 20e-6, 1e-16);
    }
    end();
}

static double same_on_all(int tooth, int side, double t1, double t2) {
    (void)tooth;
    return additive(3, side, t1, t2) * 0.7;
}

static void equal_teeth_stay_equal_to_the_bit(void) {
    begin();
    for (int tooth = 0; tooth < 45; tooth += 11) {
        add_profile(same_on_all, tooth, 1, 0.5, 0.0);
    }
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(deviations.set_count, 45);
    for (int tooth = 1; tooth < 45; ++tooth) {
        GM_ASSERT_INT(
            memcmp(table_of(tooth, 1), table_of(0, 1), FACE_NODES * PROFILE_NODES * sizeof(double)),
            0);
    }
    end();
}

static void a_side_may_stand_for_all_beside_one_tooth_by_tooth(void) {
    begin();
    add_profile(additive, 9, 1, 0.5, 0.0);
    add_profile(additive, 9, 0, 0.5, 0.0);
    add_profile(additive, 20, 0, 0.5, 0.0);
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(deviations.set_count, 46);
    GM_ASSERT(deviations.sets[0].tooth == -1 && deviations.sets[0].side == GM_COAST);
    GM_ASSERT_ABS(table_of(9, 0)[30] - table_of(9, 0)[0],
                  additive(9, 0, 0, 1) - additive(9, 0, 0, 0), 1e-16);
    GM_ASSERT_ABS(table_of(20, 0)[30] - table_of(20, 0)[0],
                  additive(20, 0, 0, 1) - additive(20, 0, 0, 0), 1e-16);
    GM_ASSERT_ABS(table_of(44, 1)[30] - table_of(44, 1)[0],
                  additive(9, 1, 0, 1) - additive(9, 1, 0, 0), 1e-16);
    end();
}

/* ---------------------------------------------------------------------------------------------
 * Made flanks
 * ------------------------------------------------------------------------------------------- */

static const gm_deviations *made;

static double made_surface(int tooth, int side, double t1, double t2) {
    for (int i = 0; i < made->set_count; ++i) {
        if (made->sets[i].tooth == tooth && made->sets[i].side == side) {
            return table_at(made->sets[i].values, t1, t2);
        }
    }
    return (double)NAN;
}

static void make(gm_deviations *flanks, gm_pitch *pitch, int quality_class, unsigned seed) {
    gm_generate_options wanted;
    gm_generate_options_default(&wanted);
    wanted.quality_class = quality_class;
    wanted.seed = seed;
    GM_ASSERT_INT(gm_flanks_generate(flanks, pitch, &pair, wheel, &wanted, &error), GM_IO_OK);
    made = flanks;
}

static void made_flanks_keep_their_quality(void) {
    begin();
    for (wheel = 0; wheel < 2; ++wheel) {
        gm_deviations flanks;
        gm_pitch pitch;
        gm_quality before;
        gm_quality after;
        make(&flanks, &pitch, 5, 3);
        setup.datum_face = wheel ? GM_FACE_II : GM_FACE_I;
        for (int tooth = 0; tooth < gear()->teeth; ++tooth) {
            for (int side = 0; side < 2; ++side) {
                add_profile(made_surface, tooth, side, 0.5, 1e-6 * tooth);
                add_helix(made_surface, tooth, side, 0.5, -2e-6);
            }
        }
        GM_ASSERT_INT(build(), GM_IO_OK);
        GM_ASSERT_INT(gm_quality_evaluate(&before, NULL, &pair, wheel, &flanks, NULL, NULL, &error),
                      GM_IO_OK);
        GM_ASSERT_INT(
            gm_quality_evaluate(&after, NULL, &pair, wheel, &deviations, NULL, NULL, &error),
            GM_IO_OK);
        for (int kind = GM_QUALITY_PROFILE_SLOPE; kind <= GM_QUALITY_HELIX_FORM; ++kind) {
            GM_ASSERT_ABS(after.worst[kind].value, before.worst[kind].value, 1e-15);
            GM_ASSERT_INT(after.worst[kind].tooth, before.worst[kind].tooth);
            GM_ASSERT_INT(after.worst[kind].side, before.worst[kind].side);
        }
        GM_ASSERT_INT(after.quality_class, before.quality_class);
        gm_deviations_free(&flanks);
        gm_pitch_free(&pitch);
        end();
        traces.count = 0;
    }
}

static void flanks_of_random_form_raise_no_alarm(void) {
    static const int classes[] = {2, 5, 8, 11};
    for (int which = 0; which < 32; ++which) {
        begin();
        wheel = which & 1;
        gm_deviations flanks;
        gm_pitch pitch;
        make(&flanks, &pitch, classes[which / 2 % 4], 100 + (unsigned)which);
        const int step = which < 16 ? 11 : 3;
        for (int tooth = 0; tooth + step <= gear()->teeth; tooth += step) {
            for (int side = 0; side < 2; ++side) {
                add_profile(made_surface, tooth, side, 0.5, 0.0);
                add_helix(made_surface, tooth, side, 0.5, 0.0);
            }
        }
        if (!GM_ASSERT_INT(build(), GM_IO_OK)) {
            printf("%s\n", error.text);
        }
        gm_deviations_free(&flanks);
        gm_pitch_free(&pitch);
        end();
    }
}

/* ---------------------------------------------------------------------------------------------
 * Signs, units and spikes
 * ------------------------------------------------------------------------------------------- */

static double crowned(int tooth, int side, double t1, double t2) {
    (void)side;
    const double u = t1 - 0.5;
    const double v = t2 - 0.45;
    return 1e-6 *
           ((tooth - 20) * u * 0.2 - 10.0 * u * u + 2.0 * v - 9.0 * v * v + 0.3 * sin(40 * t2));
}

static double wrong_sign(int tooth, int side, double t1, double t2) {
    return -crowned(tooth, side, t1, t2);
}

static double hollow_helix(int tooth, int side, double t1, double t2) {
    return crowned(tooth, side, 0.5, t2) + 11e-6 * (t1 - 0.5) * (t1 - 0.5);
}

static void add_teeth(surface *of, int teeth) {
    for (int tooth = 0; tooth < teeth; ++tooth) {
        for (int side = 0; side < 2; ++side) {
            add_profile(of, 11 * tooth, side, 0.5, 0.0);
            add_helix(of, 11 * tooth, side, 0.5, 0.0);
        }
    }
}

static void refused(long line, const char *value, const char *right) {
    GM_ASSERT_INT(build(), GM_IO_ERR_FORMAT);
    assert_error(&error, "traces.csv", line, value, right);
    GM_ASSERT(deviations.sets == NULL && deviations.set_count == 0 && deviations.teeth == 0);
}

static void the_opposite_sign_is_noticed(void) {
    begin();
    add_teeth(crowned, 3);
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(report.hollow_traces, 0);
    GM_ASSERT_INT(report.judged_traces, 12);
    end();
    begin();
    add_teeth(wrong_sign, 3);
    refused(0, "12 of 12 traces that stand out at their ends", "material added: must be > 0");
    options.hollow = 1;
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(report.hollow_traces, 12);
    end();
    /* Helices that are hollow beside profiles that are relieved are meant so; and three of four may be chance. */
    begin();
    for (int tooth = 0; tooth < 18; ++tooth) {
        add_helix(hollow_helix, tooth, 0, 0.5, 0.0);
    }
    add_profile(hollow_helix, 0, 0, 0.5, 0.0);
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(report.hollow_traces, 18);
    end();
    begin();
    for (int tooth = 0; tooth < 44; ++tooth) {
        add_profile(tooth % 4 ? wrong_sign : crowned, tooth, 0, 0.5, 0.0);
    }
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(report.hollow_traces, 33);
    end();
    /* Two teeth are too few to tell. */
    begin();
    add_teeth(wrong_sign, 2);
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_INT(report.hollow_traces, 8);
    end();
}

static double scale;

static double scaled(int tooth, int side, double t1, double t2) {
    return scale * crowned(tooth, side, t1, t2);
}

static void other_units_are_noticed(void) {
    begin();
    scale = 1e-3;
    add_teeth(scaled, 3);
    refused(0, "um at most", "millimetres");
    end();
    begin();
    scale = 1e3;
    add_teeth(scaled, 3);
    refused(0, "um at most", "nanometres");
    end();
    begin();
    scale = 0.0; /* nothing at all may be meant */
    add_teeth(scaled, 3);
    GM_ASSERT_INT(build(), GM_IO_OK);
    end();
}

/* Multiplies all lengths along the traces by a factor. */
static void stretch(double profile_factor, double face_factor) {
    for (int i = 0; i < traces.count; ++i) {
        gm_trace *trace = &traces.traces[i];
        const int profile = trace->kind == GM_TRACE_PROFILE;
        trace->at *= profile ? face_factor : profile_factor;
        for (int k = 0; k < trace->count; ++k) {
            trace->position[k] *= profile ? profile_factor : face_factor;
        }
    }
}

static void lengths_in_other_units_are_noticed(void) {
    static const struct {
        double profile;
        double face;
        const char *said;
    } cases[] = {
        {0.1, 1.0, "centimetres"}, {1e-3, 1.0, "metres"},     {1 / 25.4, 1.0, "inches"},
        {1e3, 1.0, "micrometres"}, {1.0, 0.1, "centimetres"}, {1.0, 1 / 25.4, "inches"},
        {1.0, 1e3, "micrometres"}, {1.1, 1.0, "the tip"},     {1.0, 1.1, "the face width"},
    };
    for (size_t i = 0; i < GM_TEST_COUNT(cases); ++i) {
        begin();
        add_profile(crowned, 0, 0, 1.0, 0.0);
        if (cases[i].face != 1.0) {
            add_helix(crowned, 0, 0, 1.0, 0.0);
        }
        stretch(cases[i].profile, cases[i].face);
        refused(0, "trace of tooth 1, flank right", cases[i].said);
        end();
    }
}

static void a_spike_is_refused_or_left_out(void) {
    for (int width = 1; width <= 3; ++width) {
        begin();
        gm_test_context("width %d", width);
        setup.datum_face = GM_FACE_II; /* the helix is turned */
        add_trace(crowned, 0, 0, GM_TRACE_HELIX, 0.5, 0.0, 1.0, 101, 0.0);
        gm_trace *trace = &traces.traces[0];
        trace->line = malloc(101 * sizeof *trace->line);
        for (int k = 0; k < 101; ++k) {
            trace->line[k] = 2 + k;
        }

        /* A spike of some points. */
        for (int k = 0; k < width; ++k) {
            trace->deviation[70 + k] += 6e-6;
        }

        /* Refused with its line, or left out on request. */
        GM_ASSERT_INT(build(), GM_IO_ERR_FORMAT);
        GM_ASSERT(error.line >= 72 && error.line < 72 + width);
        GM_ASSERT(strstr(error.text, "spike") != NULL);
        options.remove_spikes = 1;
        GM_ASSERT_INT(build(), GM_IO_OK);
        GM_ASSERT_INT(report.spikes, width);
        gm_deviations_free(&deviations);
        /* What is not a spike: a step, as at the edge of a relief, and one below 2 um. */
        for (int k = 0; k < width; ++k) {
            trace->deviation[70 + k] -= 4.2e-6;
        }
        options.remove_spikes = 0;
        GM_ASSERT_INT(build(), GM_IO_OK);
        end();
    }
    begin();
    add_trace(crowned, 0, 0, GM_TRACE_PROFILE, 0.5, 0.0, 1.0, 101, 0.0);
    for (int k = 60; k < 101; ++k) {
        traces.traces[0].deviation[k] -= 20e-6;
    }
    GM_ASSERT_INT(build(), GM_IO_OK);
    end();
}

/* ---------------------------------------------------------------------------------------------
 * Refusals, with lines
 * ------------------------------------------------------------------------------------------- */

#define HEADER "tooth,flank,trace,face_mm,roll_length_mm,deviation_um\n"
/* Traces of a pinion tooth: the active profile is from 8.76 to 21.18 mm of roll length. */
#define PROFILE(tooth, at) tooth ",left,profile," at ",9,0\n" tooth ",left,profile," at ",21,-5\n"
#define HELIX(tooth, at)   tooth ",left,helix,0," at ",0\n" tooth ",left,helix,17.5," at ",-3\n"

static int read_and_build(const char *text) {
    int status = gm_traces_read(&traces, file_of(text), &pair, wheel, GM_DECIMAL_POINT, &error);
    if (status == GM_IO_OK) {
        status = build();
    }
    gm_traces_free(&traces);
    return status;
}

static void refused_text(const char *text, long line, const char *value, const char *right) {
    begin();
    GM_ASSERT_INT(read_and_build(text), GM_IO_ERR_FORMAT);
    assert_error(&error, IO_TEST_PATH("csv"), line, value, right);
    GM_ASSERT(deviations.sets == NULL);
}

static void files_that_do_not_fit_the_gear_are_refused(void) {
    begin();
    GM_ASSERT_INT(read_and_build(HEADER PROFILE("1", "8.75") HELIX("1", "12")), GM_IO_OK);
    gm_deviations_free(&deviations);
    refused_text(HEADER PROFILE("1", "8.75") PROFILE("46", "8.75"), 4, "(got 46)",
                 "must be from 1 to 45");
    refused_text(HEADER PROFILE("0", "8.75"), 2, "(got 0)", "begins at 0");
    refused_text(HEADER PROFILE("1", "18"), 2, "(got 18 mm)", "0 to 17.5 mm");
    refused_text(HEADER PROFILE("1", "-1"), 2, "(got -1 mm)", "0 to 17.5 mm");
    refused_text(HEADER HELIX("1", "22"), 2, "(got 22 mm, diameter", "the tip");
    refused_text(HEADER HELIX("1", "2"), 2, "(got 2 mm)", "must be on the active profile");
    refused_text(HEADER "1,left,profile,8.75,9,0\n1,left,profile,8.75,22,0\n", 3, "22 mm",
                 "the tip");
    refused_text(HEADER "1,left,profile,8.75,-1,0\n1,left,profile,8.75,21,0\n", 2, "(got -1 mm",
                 "must be at a roll length up to");
    refused_text(HEADER "1,left,helix,0,12,0\n1,left,helix,17.6,12,0\n", 3, "17.6 mm",
                 "0 to 17.5 mm");
    refused_text(HEADER "1,left,helix,0,12,0\n1,left,helix,9,12,0\n", 2, "(got 0 to 9 mm)",
                 "must reach from 0 to 17.5 mm");
    refused_text(HEADER "1,left,profile,8.75,12,0\n1,left,profile,8.75,21,0\n", 2,
                 "(got 12 to 21 mm)", "must reach from 8.7648 to 21.184 mm");
    refused_text(HEADER "1,left,profile,8.75,12,0\n", 2, "(got 1)", "must be at least 2 rows");
    refused_text(HEADER "1,left,profile,8,4,0\n1,left,profile,8.1,5,0\n1,left,profile,8.2,6,0\n", 2,
                 "(got 1)", "all at the same distance");
    refused_text(HEADER PROFILE("1", "8.75") HELIX("1", "12") PROFILE("1", "8.751"), 6,
                 "begins in line 2", "two teeth with the number 1");
    refused_text(HEADER HELIX("1", "12") HELIX("1", "14"), 2, "without a profile",
                 "must have a profile trace beside it");
}

/* How much more the surface rises along the profile, from 0.2 to 0.8, at t1 = 0.8 than at 0.2. */
static double mixed_difference(const double *table) {
    return table_at(table, 0.8, 0.8) - table_at(table, 0.8, 0.2) - table_at(table, 0.2, 0.8) +
           table_at(table, 0.2, 0.2);
}

static double mixed_difference_of(surface *of) {
    return of(2, 0, 0.8, 0.8) - of(2, 0, 0.8, 0.2) - of(2, 0, 0.2, 0.8) + of(2, 0, 0.2, 0.2);
}

static void traces_that_contradict_each_other_are_refused(void) {
    begin();
    add_profile(twisted, 2, 0, 0.2, 0.0);
    add_profile(twisted, 2, 0, 0.8, 0.0);
    add_helix(twisted, 2, 0, 0.2, 0.0);
    add_helix(twisted, 2, 0, 0.8, 0.0);
    /* The second profile with a slope of its own: what no level can take out is a quarter of 16 um * 0.6. */
    for (int k = 0; k < PROFILE_NODES; ++k) {
        traces.traces[1].deviation[k] += 16e-6 * k / (PROFILE_NODES - 1);
    }
    GM_ASSERT_INT(build(), GM_IO_OK);
    GM_ASSERT_REL(report.crossing_error, 16e-6 * 0.6 / 4, 1e-9);
    /* The twist of the helices is the surface's own, that of the profiles has 16 um * 0.6 more: halfway between. */
    GM_ASSERT_REL(mixed_difference(table_of(2, 0)) - mixed_difference_of(twisted),
                  0.5 * 16e-6 * 0.6, 1e-9);
    gm_deviations_free(&deviations);
    for (int k = 0; k < PROFILE_NODES; ++k) { /* a hump at one of the two crossings */
        traces.traces[1].deviation[k] -= 16e-6 * k / (PROFILE_NODES - 1);
        traces.traces[1].deviation[k] += 18e-6 * fmax(0.0, 1.0 - fabs(k - 6.0) / 6.0);
    }
    refused(0, "a contradiction of 4.5 um", "must be of the same flank");
    end();
}

static void bad_calls_are_refused(void) {
    begin();
    GM_ASSERT_INT(build(), GM_IO_ERR_FORMAT); /* no traces */
    add_profile(crowned, 0, 0, 0.5, 0.0);
    options.profile_nodes = 1;
    GM_ASSERT_INT(build(), GM_IO_ERR_OPTION);
    options.profile_nodes = 1001;
    GM_ASSERT_INT(build(), GM_IO_ERR_OPTION);
    options.profile_nodes = PROFILE_NODES;
    options.held_limit = 0.5;
    GM_ASSERT_INT(build(), GM_IO_ERR_OPTION);
    options.held_limit = (double)NAN;
    GM_ASSERT_INT(build(), GM_IO_ERR_OPTION);
    options.held_limit = 0.2;
    setup.datum_face = 0;
    GM_ASSERT_INT(build(), GM_IO_ERR_OPTION);
    setup.datum_face = GM_FACE_I;
    traces.traces[0].flank = 4;
    refused(0, "got number 4", "left or right");
    traces.traces[0].flank = GM_DRIVE;
    traces.traces[0].kind = 2;
    refused(0, "kind 2", "profile or helix");
    traces.traces[0].kind = GM_TRACE_PROFILE;
    traces.traces[0].deviation[3] = (double)NAN;
    refused(0, "not finite", "rise");
    traces.traces[0].deviation[3] = -1e308;
    refused(0, "beyond 1 km", "values of a gear");
    traces.traces[0].deviation[3] = 0.0;
    traces.traces[0].position[3] = traces.traces[0].position[2];
    refused(0, "not finite", "rise");
    GM_ASSERT_INT(gm_traces_build(&deviations, NULL, NULL, &setup, &pair, 0, NULL, &error),
                  GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_traces_build(NULL, NULL, &traces, &setup, &pair, 0, NULL, NULL),
                  GM_IO_ERR_NULL);
    end();
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(profile_and_helix_come_back_as_their_sum),
        GM_TEST(a_twist_comes_back_from_two_traces_each_way),
        GM_TEST(three_profiles_are_met_and_the_surface_is_linear_in_between),
        GM_TEST(too_many_traces_of_a_flank_are_refused),
        GM_TEST(beyond_close_traces_the_surface_does_not_run_away),
        GM_TEST(one_kind_alone_is_constant_the_other_way),
        GM_TEST(resampling_is_linear_and_its_error_is_told),
        GM_TEST(ends_that_were_left_out_are_held_and_told),
        GM_TEST(transverse_deviations_are_turned_into_the_normal),
        GM_TEST(teeth_in_between_are_linear_around_the_gear),
        GM_TEST(equal_teeth_stay_equal_to_the_bit),
        GM_TEST(a_side_may_stand_for_all_beside_one_tooth_by_tooth),
        GM_TEST(made_flanks_keep_their_quality),
        GM_TEST(flanks_of_random_form_raise_no_alarm),
        GM_TEST(the_opposite_sign_is_noticed),
        GM_TEST(other_units_are_noticed),
        GM_TEST(lengths_in_other_units_are_noticed),
        GM_TEST(a_spike_is_refused_or_left_out),
        GM_TEST(files_that_do_not_fit_the_gear_are_refused),
        GM_TEST(traces_that_contradict_each_other_are_refused),
        GM_TEST(bad_calls_are_refused),
    };
    return gm_test_main("unit.traces_build", tests, GM_TEST_COUNT(tests), argc, argv);
}
