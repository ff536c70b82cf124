/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Generated flanks measure to their class, whatever the seed, the class and the gear. */
#include "io_test.h"
#include "reference_gear.h"

static const double pi = 3.14159265358979323846;

static gm_pair pair;
static gm_deviations deviations;
static gm_pitch pitch;
static gm_generate_options options;
static gm_quality quality;
static gm_io_error error;

/* Teeth of pinion and wheel (< 0: a ring), module mm, helix angle deg, face width mm; all within the standard. */
static const double gears[][5] = {{45, 41, 1.65, 33, 17.5},
                                  {20, 60, 3, 0, 30},
                                  {11, 90, 2, -25, 20},
                                  {17, 18, 20, 30, 150},
                                  {25, -80, 2, 15, 30}};
enum { GEARS = sizeof gears / sizeof gears[0], RING = GEARS - 1 };

static void begin(int which) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = (int)gears[which][0];
    params.wheel_teeth = (int)gears[which][1];
    params.normal_module = 1e-3 * gears[which][2];
    params.normal_pressure_angle = 20.0 / 180.0 * pi;
    params.helix_angle = gears[which][3] / 180.0 * pi;
    params.face_width = 1e-3 * gears[which][4];
    params.center_distance = 0.5 * abs(params.pinion_teeth + params.wheel_teeth) *
                             params.normal_module / cos(params.helix_angle) * 1.002;
    pair = make_pair(&params);
    gm_generate_options_default(&options);
    options.quality_class = 6;
}

static int generate(int wheel) {
    return gm_flanks_generate(&deviations, &pitch, &pair, wheel, &options, &error);
}

static void end(void) {
    gm_deviations_free(&deviations);
    gm_pitch_free(&pitch);
}

/* Every kind at the share and in the class, by the evaluation with its defaults. */
static void assert_measures_to_class(int wheel) {
    GM_ASSERT_INT(
        gm_quality_evaluate(&quality, NULL, &pair, wheel, &deviations, &pitch, NULL, &error),
        GM_IO_OK);
    for (int kind = 0; kind < GM_QUALITY_KINDS; ++kind) {
        const double limit = gm_quality_tolerance(&pair, wheel, kind, options.quality_class);
        /* 1e-9 m: values are rounded to 1e-10 m, and a range takes some of them */
        GM_ASSERT_ABS(quality.worst[kind].value, options.share * limit, 1e-9);
        GM_ASSERT_INT(quality.worst[kind].quality_class, options.quality_class);
    }
    GM_ASSERT_INT(quality.quality_class, options.quality_class);
}

static void every_worst_value_is_at_the_share_of_its_tolerance(void) {
    int checked = 0;
    for (int which = 0; which < GEARS; ++which) {
        begin(which);
        for (int run = 0; run < 44; ++run) {
            const int wheel = run % 2;
            options.quality_class = 1 + run / 2 % 11;
            options.seed = (uint64_t)(1000 * which + run);
            gm_test_context("gears %d.%d, class %d, seed %d", which, wheel, options.quality_class,
                            (int)options.seed);
            if (!GM_ASSERT_INT(generate(wheel), GM_IO_OK)) {
                continue;
            }
            assert_measures_to_class(wheel);
            end();
            ++checked;
        }
    }
    GM_ASSERT_INT(checked, 44 * GEARS);
}

static void any_share_from_the_next_class_on_is_met(void) {
    static const double shares[3] = {0.8, 0.9, 0.99};
    begin(0);
    for (int i = 0; i < 3; ++i) {
        for (options.quality_class = 1; options.quality_class <= 11; ++options.quality_class) {
            options.share = shares[i];
            gm_test_context("share %g, class %d", shares[i], options.quality_class);
            GM_ASSERT_INT(generate(0), GM_IO_OK);
            assert_measures_to_class(0);
            end();
        }
    }
}

static void any_grid_is_met(void) {
    static const int nodes[3][2] = {{9, 10}, {50, 9}, {10, 121}};
    begin(0);
    for (int i = 0; i < 3; ++i) {
        options.face_nodes = nodes[i][0];
        options.profile_nodes = nodes[i][1];
        GM_ASSERT_INT(generate(1), GM_IO_OK);
        GM_ASSERT_INT(deviations.face_nodes, nodes[i][0]);
        GM_ASSERT_INT(deviations.profile_nodes, nodes[i][1]);
        assert_measures_to_class(1);
        end();
    }
}

static void files_of_generated_flanks_measure_the_same(void) {
    gm_deviations read_deviations;
    gm_pitch read_pitch;
    begin(0);
    options.face_nodes = options.profile_nodes = 9;
    GM_ASSERT_INT(generate(0), GM_IO_OK);
    GM_ASSERT_INT(gm_deviations_write(&deviations, IO_TEST_PATH("flanks.csv"), &error), GM_IO_OK);
    GM_ASSERT_INT(gm_pitch_write(&pitch, IO_TEST_PATH("pitch.csv"), &error), GM_IO_OK);
    end();
    GM_ASSERT_INT(gm_deviations_read(&read_deviations, IO_TEST_PATH("flanks.csv"), 45, &error),
                  GM_IO_OK);
    GM_ASSERT_INT(gm_pitch_read(&read_pitch, IO_TEST_PATH("pitch.csv"), 45, &error), GM_IO_OK);
    deviations = read_deviations;
    pitch = read_pitch;
    assert_measures_to_class(0);
    end();
}

/* ---------------------------------------------------------------------------------------------
 * Seeds
 * ------------------------------------------------------------------------------------------- */

static void the_same_seed_gives_the_same_bits(void) {
    begin(2);
    options.seed = UINT64_C(18446744073709551615);
    GM_ASSERT_INT(generate(0), GM_IO_OK);
    const gm_deviations first = deviations;
    const gm_pitch first_pitch = pitch;
    const size_t size = sizeof(double) * 21 * 31;
    GM_ASSERT_INT(generate(0), GM_IO_OK);
    for (int i = 0; i < first.set_count; ++i) {
        GM_ASSERT_INT(memcmp(first.sets[i].values, deviations.sets[i].values, size), 0);
    }
    GM_ASSERT_INT(memcmp(first_pitch.coast, pitch.coast, 11 * sizeof(double)), 0);
    end();
    --options.seed;
    GM_ASSERT_INT(generate(0), GM_IO_OK);
    GM_ASSERT(memcmp(first.sets[0].values, deviations.sets[0].values, size) != 0);
    GM_ASSERT(memcmp(first_pitch.coast, pitch.coast, 11 * sizeof(double)) != 0);
    end();
    deviations = first;
    pitch = first_pitch;
    end();
}

static void every_flank_differs(void) {
    begin(2);
    GM_ASSERT_INT(generate(1), GM_IO_OK);
    GM_ASSERT_INT(deviations.set_count, 180);
    for (int i = 0; i < deviations.set_count; ++i) {
        GM_ASSERT_INT(deviations.sets[i].tooth, i / 2);
        GM_ASSERT_INT(deviations.sets[i].side, i % 2);
        for (int j = 0; j < i; ++j) {
            GM_ASSERT(memcmp(deviations.sets[i].values, deviations.sets[j].values, 64) != 0);
        }
    }
    end();
}

/* ---------------------------------------------------------------------------------------------
 * What is in it
 * ------------------------------------------------------------------------------------------- */

/* What is left of values over equal angles when mean and first order (by projection) are taken off. */
static double beyond_first_order(const double *values, int count) {
    double mean = 0.0, c = 0.0, s = 0.0, most = 0.0;
    for (int i = 0; i < count; ++i) {
        mean += values[i] / count;
        c += 2.0 / count * values[i] * cos(2.0 * pi * i / count);
        s += 2.0 / count * values[i] * sin(2.0 * pi * i / count);
    }
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * pi * i / count;
        most = fmax(most, fabs(values[i] - mean - c * cos(angle) - s * sin(angle)));
    }
    return most;
}

/* The two flanks of a space: their sum is what moves a ball in it radially. */
static void run_out_is_a_pure_first_order(void) {
    begin(3); /* large gears of the worst class, so that little is hidden by rounding */
    options.quality_class = 11;
    for (int wheel = 0; wheel < 2; ++wheel) {
        double ball[60];
        GM_ASSERT_INT(generate(wheel), GM_IO_OK);
        const int teeth = pitch.teeth;
        for (int i = 0; i < teeth; ++i) {
            ball[i] = pitch.drive[i] + pitch.coast[(i + (wheel ? teeth - 1 : 1)) % teeth];
        }
        GM_ASSERT(beyond_first_order(ball, teeth) < 2e-10); /* rounding to 1e-10 m */
        GM_ASSERT(beyond_first_order(pitch.drive, teeth) > 1e-7);
        end();
    }
}

static void the_middle_of_a_flank_stands_where_the_pitch_says(void) {
    begin(0);
    GM_ASSERT_INT(generate(0), GM_IO_OK);
    for (int i = 0; i < deviations.set_count; ++i) {
        GM_ASSERT_ABS(deviations.sets[i].values[10 * 31 + 15], 0.0, 1e-10);
    }
    end();
}

/*
 * A wave as gear tooth and section meet it: with the tooth's turn, the place of its contact line, and the
 * rise of that line over the face; from conventions.md. In sections the forms of profile and helix
 * add up, so that mixed differences over t1 and t2 hold the wave alone.
 */
static double wave_angle(int wheel, int order, const gm_deviation_set *set, double t1, double t2) {
    const gm_gear *gear = wheel ? &pair.wheel : &pair.pinion;
    const double chi_start =
        sqrt(pow(gear->start_radius / gear->base_radius, 2.0) - 1.0); /* tan of the profile angle */
    const double chi_tip = sqrt(pow(gear->tip_radius / gear->base_radius, 2.0) - 1.0);
    const double chi = chi_start + t2 * (chi_tip - chi_start);
    /* A ring's flanks look the other way, and turn as those of the pinion do. */
    const int as_pinion = wheel == 0 || pair.wheel.sign < 0.0;
    const double s = as_pinion == (set->side == GM_DRIVE) ? -1.0 : 1.0;
    return order * (2.0 * pi * set->tooth / gear->teeth + s * chi +
                    t1 * pair.face_width * tan(pair.base_helix_angle) / gear->base_radius);
}

static double mixed_difference(const gm_deviation_set *set, int face, int profile) {
    const double *v = set->values;
    return v[face * 31 + profile] - v[face * 31] - v[profile] + v[0];
}

/* The same of cos (part 0) or sin (part 1) of the wave's angle. */
static double mixed_wave(int wheel, int order, const gm_deviation_set *set, int face, int profile,
                         int part) {
    double result = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        const double t1 = corner & 1 ? face / 20.0 : 0.0;
        const double t2 = corner & 2 ? profile / 30.0 : 0.0;
        const double angle = wave_angle(wheel, order, set, t1, t2);
        result += (corner == 0 || corner == 3 ? 1.0 : -1.0) * (part ? sin(angle) : cos(angle));
    }
    return result;
}

/* Fits A cos + B sin to all mixed differences of a side. */
static void assert_wave(int wheel, int side, int order, double amplitude) {
    double cc = 0, cs = 0, ss = 0, cv = 0, sv = 0, worst_rest = 0;
    double a = 0, b = 0;
    for (int pass = 0; pass < 2; ++pass) {
        for (int i = side; i < deviations.set_count; i += 2) {
            const gm_deviation_set *set = &deviations.sets[i];
            for (int node = 0; node < 21 * 31; node += 7) {
                const double c = mixed_wave(wheel, order, set, node / 31, node % 31, 0);
                const double s = mixed_wave(wheel, order, set, node / 31, node % 31, 1);
                const double v = mixed_difference(set, node / 31, node % 31);
                cc += c * c;
                cs += c * s;
                ss += s * s;
                cv += c * v;
                sv += s * v;
                worst_rest = pass ? fmax(worst_rest, fabs(v - a * c - b * s)) : 0.0;
            }
        }
        a = (cv * ss - sv * cs) / (cc * ss - cs * cs);
        b = (sv * cc - cv * cs) / (cc * ss - cs * cs);
    }
    GM_ASSERT_REL(sqrt(a * a + b * b), amplitude, 1e-3);
    GM_ASSERT(worst_rest < 3e-10); /* four values rounded to 1e-10 m each */
}

static void waves_go_on_from_tooth_to_tooth(void) {
    const gm_flank_wave wave = {67, 0.8e-6};
    for (int i = 0; i < 3; ++i) {
        const int wheel = i > 0;
        begin(i == 2 ? RING : 0);
        options.waves = &wave;
        options.wave_count = 1;
        GM_ASSERT_INT(generate(wheel), GM_IO_OK);
        for (int side = 0; side < 2; ++side) {
            gm_test_context("gear %d, side %d", i, side);
            assert_wave(wheel, side, 67, 0.8e-6);
        }
        assert_measures_to_class(wheel);
        end();
    }
}

static void several_waves_leave_the_gear_in_its_class(void) {
    const gm_flank_wave waves[3] = {{1, 1e-6}, {31, 0.5e-6}, {90, 0.3e-6}};
    options.waves = waves;
    for (int seed = 0; seed < 8; ++seed) {
        begin(0);
        options.seed = (uint64_t)seed;
        options.waves = waves;
        options.wave_count = 3;
        gm_test_context("seed %d", seed);
        GM_ASSERT_INT(generate(seed % 2), GM_IO_OK);
        assert_measures_to_class(seed % 2);
        end();
    }
}

/* ---------------------------------------------------------------------------------------------
 * Refusals
 * ------------------------------------------------------------------------------------------- */

static void refused(const char *text) {
    GM_ASSERT_INT(generate(0), GM_IO_ERR_OPTION);
    gm_test_context("%.150s", error.text);
    GM_ASSERT(strstr(error.text, text) != NULL);
    GM_ASSERT(deviations.sets == NULL && pitch.drive == NULL);
    GM_ASSERT_INT(deviations.teeth + pitch.teeth, 0);
    gm_test_context("%s", "");
}

static void options_out_of_range_are_refused(void) {
    begin(0);
    options.quality_class = 0;
    refused("class: must be from 1 to 11 (got 0)");
    options.quality_class = 12;
    refused("class: must be from 1 to 11 (got 12)");
    begin(0);
    options.share = 0.79;
    refused("0.8 to 0.99");
    options.share = (double)NAN;
    refused("0.8 to 0.99");
    begin(0);
    options.face_nodes = 8;
    refused("nodes: must be 9 to 1000 each way (got 8 x 31)");
    begin(0);
    options.profile_nodes = 1001;
    refused("(got 21 x 1001)");
    begin(0);
    options.wave_count = 1;
    refused("waves: must be 0 to 100 (got 1)");
    pair.pinion.teeth = 2;
    refused("teeth: must be from 3 to 100000 (got 2)");
    begin(0);
    GM_ASSERT_INT(gm_flanks_generate(&deviations, &pitch, NULL, 0, &options, &error),
                  GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_flanks_generate(&deviations, &pitch, &pair, 0, NULL, NULL), GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_flanks_generate(NULL, &pitch, &pair, 0, &options, NULL), GM_IO_ERR_NULL);
}

static void waves_out_of_range_are_refused(void) {
    gm_flank_wave wave = {0, 1e-6};
    begin(0);
    options.waves = &wave;
    options.wave_count = 1;
    refused("the order of a wave: must be from 1 to 1000000 (got 0)");
    wave.order = 1000001;
    refused("the order of a wave: must be from 1 to 1000000 (got 1000001)");
    options.wave_count = -1;
    refused("waves: must be 0 to 100 (got -1)");
    options.wave_count = GM_FLANK_WAVES_MAX + 1;
    refused("waves: must be 0 to 100 (got 101)");
    options.wave_count = 1;
    wave = (gm_flank_wave){30, (double)INFINITY};
    refused("must be finite");
    wave = (gm_flank_wave){30, -1e-9};
    refused("not below 0");
    wave = (gm_flank_wave){30, (double)NAN};
    refused("must be finite");
    wave = (gm_flank_wave){5000, 1e-7};
    refused("must have 4 nodes per wave (got 205 waves along t1 for 21 nodes)");
    wave = (gm_flank_wave){67, 20e-6};
    refused("the waves use up a tolerance");
}

/* Between five teeth a sine of the whole F_p steps by more than f_p: no choice can be right. */
static void too_few_teeth_for_a_run_out_of_the_class_are_refused(void) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 5;
    params.wheel_teeth = 30;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = 20.0 / 180.0 * pi;
    params.center_distance = 36e-3;
    params.face_width = 20e-3;
    params.pinion_profile_shift = 0.5;
    begin(0);
    pair = make_pair(&params);
    refused("exclude each other");
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(every_worst_value_is_at_the_share_of_its_tolerance),
        GM_TEST(any_share_from_the_next_class_on_is_met),
        GM_TEST(any_grid_is_met),
        GM_TEST(files_of_generated_flanks_measure_the_same),
        GM_TEST(the_same_seed_gives_the_same_bits),
        GM_TEST(every_flank_differs),
        GM_TEST(run_out_is_a_pure_first_order),
        GM_TEST(the_middle_of_a_flank_stands_where_the_pitch_says),
        GM_TEST(waves_go_on_from_tooth_to_tooth),
        GM_TEST(several_waves_leave_the_gear_in_its_class),
        GM_TEST(options_out_of_range_are_refused),
        GM_TEST(waves_out_of_range_are_refused),
        GM_TEST(too_few_teeth_for_a_run_out_of_the_class_are_refused),
    };
    return gm_test_main("unit.generate_class", tests, GM_TEST_COUNT(tests), argc, argv);
}
