/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Generated flanks that scatter: amounts are read back off the nodes, and many of them have the stated statistics. */
#include "io_test.h"
#include "reference_gear.h"

#define PAPER "../data/paper/"

static const double pi = 3.14159265358979323846;
static const double micro = 1e-6;

static gm_pair pair;
static gm_deviations deviations;
static gm_pitch pitch;
static gm_flank_scatter scatter;
static gm_generate_options options;
static gm_io_error error;

static void begin(void) {
    pair = reference_pair(REFERENCE_FACE_WIDTH);
    gm_flank_scatter_default(&scatter);
    gm_generate_options_default(&options);
    options.scatter = &scatter;
}

static int generate(int wheel) {
    return gm_flanks_generate(&deviations, &pitch, &pair, wheel, &options, &error);
}

static void end(void) {
    gm_deviations_free(&deviations);
    gm_pitch_free(&pitch);
}

static double node(const gm_deviation_set *set, int face, int profile) {
    return set->values[face * deviations.profile_nodes + profile];
}

/* ---------------------------------------------------------------------------------------------
 * Statistics. Seeds are fixed: a bound of 4.5 standard errors holds or does not, once and for all.
 * ------------------------------------------------------------------------------------------- */

enum { MOST_SAMPLES = 10000 };
static const double bound = 4.5;

typedef struct samples {
    int count;
    double value[MOST_SAMPLES];
} samples;

static void take(samples *of, double value) {
    if (of->count < MOST_SAMPLES) {
        of->value[of->count++] = value;
    }
}

static double mean_of(const samples *of) {
    double sum = 0.0;
    for (int i = 0; i < of->count; ++i) {
        sum += of->value[i];
    }
    return sum / of->count;
}

/* Mean of (a - its mean) * (b - its mean), b being `lag` samples later. */
static double covariance(const samples *a, const samples *b, int lag) {
    const double means[2] = {mean_of(a), mean_of(b)};
    double sum = 0.0;
    for (int i = 0; i + lag < a->count; ++i) {
        sum += (a->value[i] - means[0]) * (b->value[i + lag] - means[1]);
    }
    return sum / (a->count - lag);
}

static double deviation_of(const samples *of) {
    return sqrt(covariance(of, of, 0));
}

/* kurtosis: mean fourth power over the square of the variance; it makes the error of the deviation. */
static void assert_distribution(const samples *of, double mean, double deviation, double kurtosis) {
    const double root = sqrt((double)of->count);
    GM_ASSERT_ABS(mean_of(of), mean, bound * deviation / root);
    GM_ASSERT_ABS(deviation_of(of), deviation,
                  bound * deviation * 0.5 * sqrt(kurtosis - 1.0) / root);
}

/* About normal: 31.7 % are farther than one deviation from the mean, 4.6 % farther than two, none farther than six. */
static void assert_normal(const samples *of, double mean, double deviation) {
    int beyond[3] = {0, 0, 0};
    assert_distribution(of, mean, deviation, 3.0);
    for (int i = 0; i < of->count; ++i) {
        const double distance = fabs(of->value[i] - mean) / deviation;
        beyond[0] += distance > 1.0;
        beyond[1] += distance > 2.0;
        beyond[2] += distance > 6.0;
    }
    const double root = sqrt((double)of->count);
    GM_ASSERT_ABS((double)beyond[0] / of->count, 0.3173, bound * 0.47 / root);
    GM_ASSERT_ABS((double)beyond[1] / of->count, 0.0455, bound * 0.21 / root);
    GM_ASSERT_INT(beyond[2], 0);
}

static void assert_uniform(const samples *of, double low, double high) {
    assert_distribution(of, 0.5 * (low + high), (high - low) / sqrt(12.0), 1.8);
    for (int i = 0; i < of->count; ++i) {
        GM_ASSERT(of->value[i] > low - 1e-6 * high && of->value[i] < high * (1.0 + 1e-6));
    }
}

static void assert_uncorrelated(const samples *a, const samples *b, int lag) {
    GM_ASSERT_ABS(covariance(a, b, lag) / (deviation_of(a) * deviation_of(b)), 0.0,
                  bound / sqrt((double)a->count));
}

/* ---------------------------------------------------------------------------------------------
 * Amounts of each flank
 * ------------------------------------------------------------------------------------------- */

enum { PROFILE_SLOPE, HELIX_SLOPE, PROFILE_CROWNING, HELIX_CROWNING, FOOT, RELIEF, AMOUNTS };

/* Without waves and roughness: from few nodes, outside the foot (t2 < 0.35) and the relief (t2 > 0.8). */
static void read_amounts(const gm_deviation_set *set, double amounts[AMOUNTS]) {
    const double part = 8.0 / 30.0; /* from node 11 to 19 of 0 .. 30, v = -part .. part */
    const double low = node(set, 10, 11), middle = node(set, 10, 15), high = node(set, 10, 19);
    const double slope = (high - low) / part;
    const double crowning = (middle - 0.5 * (low + high)) / (part * part);
    amounts[PROFILE_SLOPE] = slope;
    amounts[PROFILE_CROWNING] = crowning;
    amounts[FOOT] = node(set, 10, 0) - middle + 0.5 * slope + crowning;
    amounts[RELIEF] = -(node(set, 10, 30) - middle - 0.5 * slope + crowning);
    amounts[HELIX_SLOPE] = node(set, 20, 15) - node(set, 0, 15);
    amounts[HELIX_CROWNING] = middle - 0.5 * (node(set, 0, 15) + node(set, 20, 15));
}

static samples drawn[2][2][AMOUNTS]; /* of gear, side */

static void draw_many(int runs) {
    memset(drawn, 0, sizeof drawn);
    for (int run = 0; run < runs; ++run) {
        for (int wheel = 0; wheel < 2; ++wheel) {
            options.seed = (uint64_t)run;
            GM_ASSERT_INT(generate(wheel), GM_IO_OK);
            for (int i = 0; i < 2 * 41; ++i) { /* as many of both gears */
                const gm_deviation_set *set = &deviations.sets[i];
                double amounts[AMOUNTS];
                read_amounts(set, amounts);
                for (int k = 0; k < AMOUNTS; ++k) {
                    take(&drawn[wheel][set->side][k], amounts[k]);
                }
            }
            end();
        }
    }
}

static void amounts_have_the_stated_mean_and_deviation(void) {
    static const double mean[AMOUNTS] = {3.0, -4.0, 5.0, 6.0, -7.0, 8.0};
    static const double deviation[AMOUNTS] = {1.0, 2.0, 0.5, 1.5, 6.0, 0.8};
    begin();
    const gm_scatter_normal wanted[AMOUNTS] = {{3e-6, 1e-6},   {-4e-6, 2e-6}, {5e-6, 0.5e-6},
                                               {6e-6, 1.5e-6}, {-7e-6, 6e-6}, {8e-6, 0.8e-6}};
    scatter.profile.slope = wanted[PROFILE_SLOPE];
    scatter.helix.slope = wanted[HELIX_SLOPE];
    scatter.profile.crowning = wanted[PROFILE_CROWNING];
    scatter.helix.crowning = wanted[HELIX_CROWNING];
    scatter.foot = wanted[FOOT];
    scatter.tip_relief = wanted[RELIEF];
    draw_many(60);
    for (int wheel = 0; wheel < 2; ++wheel) {
        for (int side = 0; side < 2; ++side) {
            for (int k = 0; k < AMOUNTS; ++k) {
                gm_test_context("wheel %d, side %d, amount %d", wheel, side, k);
                GM_ASSERT_INT(drawn[wheel][side][k].count, 60 * 41);
                assert_normal(&drawn[wheel][side][k], mean[k] * micro, deviation[k] * micro);
                assert_uncorrelated(&drawn[wheel][side][k], &drawn[wheel][side][k], 1);
            }
        }
    }
}

/* Of one flank, of both flanks of a tooth, of both gears with the same seed; uses what has been drawn before. */
static void amounts_are_independent_of_each_other(void) {
    for (int i = 0; i < AMOUNTS; ++i) {
        for (int k = 0; k < AMOUNTS; ++k) {
            gm_test_context("amounts %d and %d", i, k);
            if (i != k) {
                assert_uncorrelated(&drawn[0][0][i], &drawn[0][0][k], 0);
            }
            assert_uncorrelated(&drawn[0][0][i], &drawn[0][1][k], 0);
            assert_uncorrelated(&drawn[1][0][i], &drawn[1][1][k], 0);
            assert_uncorrelated(&drawn[0][0][i], &drawn[1][0][k], 0);
        }
    }
}

/* Every node of a flank without scatter, against the formulae in the comments of gearmesh_io.h. */
static void shapes_are_those_stated(void) {
    begin();
    scatter.profile.slope.mean = 3e-6;
    scatter.profile.crowning.mean = 5e-6;
    scatter.helix.slope.mean = -4e-6;
    scatter.helix.crowning.mean = 6e-6;
    scatter.foot.mean = -7e-6;
    scatter.foot_end = 0.5;
    scatter.tip_relief.mean = 8e-6;
    scatter.tip_start = 0.7;
    options.face_nodes = 11;
    options.profile_nodes = 41;
    GM_ASSERT_INT(generate(1), GM_IO_OK);
    for (int i = 0; i < deviations.set_count; ++i) {
        for (int k = 0; k < 11 * 41; ++k) {
            const double t1 = (double)(k / 41) / 10.0, t2 = (double)(k % 41) / 40.0;
            const double expected = 3.0 * (t2 - 0.5) - 20.0 * pow(t2 - 0.5, 2.0) -
                                    4.0 * (t1 - 0.5) - 24.0 * pow(t1 - 0.5, 2.0) -
                                    7.0 * fmax(0.0, 1.0 - 2.0 * t2) -
                                    8.0 * pow(fmax(0.0, (t2 - 0.7) / 0.3), 2.0);
            GM_ASSERT_ABS(deviations.sets[i].values[k], expected * micro, 0.6e-10);
        }
        GM_ASSERT(pitch.drive[i / 2] == 0.0 && pitch.coast[i / 2] == 0.0);
    }
    end();
}

/* ---------------------------------------------------------------------------------------------
 * Waves and roughness
 * ------------------------------------------------------------------------------------------- */

/* Sine with n values at equal distances: its angle per node, from x[k-1] + x[k+1] = 2 cos(angle) x[k]. */
static double angle_per_node(const double *x, int count) {
    double cross = 0.0, square = 0.0;
    for (int k = 1; k + 1 < count; ++k) {
        cross += 0.5 * x[k] * (x[k - 1] + x[k + 1]);
        square += x[k] * x[k];
    }
    return acos(cross / square);
}

/* A and phase (turns) of A sin(angle k + 2 pi phase), from the first and the last of 31 values. */
static double amplitude(const double *x, double angle, double *phase) {
    const double sine = x[0];
    const double cosine = (x[7] - x[0] * cos(7.0 * angle)) / sin(7.0 * angle);
    *phase = atan2(sine, cosine) / (2.0 * pi);
    return hypot(sine, cosine);
}

/* Waves of 2 to 6 mm, so that what is read back is not blurred by the rounding to 0.1 nm. */
static void waves_have_the_stated_amplitudes_and_numbers(void) {
    static samples amplitudes, counts, phases;
    for (int helix = 0; helix < 2; ++helix) {
        begin();
        gm_trace_scatter *trace = helix ? &scatter.helix : &scatter.profile;
        trace->wave = (gm_scatter_uniform){2e-3, 6e-3};
        trace->wave_count = (gm_scatter_uniform){1.0, 2.0};
        options.face_nodes = options.profile_nodes = 31;
        amplitudes.count = counts.count = phases.count = 0;
        for (options.seed = 0; options.seed < 20; ++options.seed) {
            GM_ASSERT_INT(generate(0), GM_IO_OK);
            for (int i = 0; i < deviations.set_count; ++i) {
                double x[31], phase;
                for (int k = 0; k < 31; ++k) {
                    const gm_deviation_set *set = &deviations.sets[i];
                    x[k] = helix ? node(set, k, 3) : node(set, 3, k);
                    GM_ASSERT((helix ? node(set, k, 9) : node(set, 9, k)) == x[k]);
                }
                const double angle = angle_per_node(x, 31);
                take(&amplitudes, amplitude(x, angle, &phase));
                take(&counts, angle * 30.0 / (2.0 * pi));
                take(&phases, phase);
            }
            end();
        }
        gm_test_context("helix %d", helix);
        assert_uniform(&amplitudes, 2e-3, 6e-3);
        assert_uniform(&counts, 1.0, 2.0);
        assert_distribution(&phases, 0.0, 1.0 / sqrt(12.0), 1.8);
        assert_uncorrelated(&amplitudes, &counts, 0);
        assert_uncorrelated(&amplitudes, &phases, 0);
        assert_uncorrelated(&counts, &phases, 0);
    }
}

static void roughness_is_independent_from_node_to_node(void) {
    static samples nodes;
    begin();
    scatter.roughness = 3e-6;
    nodes.count = 0;
    GM_ASSERT_INT(generate(0), GM_IO_OK);
    for (int i = 0; i < 15; ++i) {
        for (int k = 0; k < 21 * 31; ++k) {
            take(&nodes, deviations.sets[i].values[k]);
        }
    }
    end();
    assert_normal(&nodes, 0.0, 3e-6);
    for (int lag = 1; lag < 100; ++lag) {
        assert_uncorrelated(&nodes, &nodes, lag);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Pitch
 * ------------------------------------------------------------------------------------------- */

/* Amplitude of the first order by projection, and what is left beside it. */
static double first_order(const double *values, int count, double *rest) {
    double c = 0.0, s = 0.0;
    for (int i = 0; i < count; ++i) {
        c += 2.0 / count * values[i] * cos(2.0 * pi * i / count);
        s += 2.0 / count * values[i] * sin(2.0 * pi * i / count);
    }
    *rest = 0.0;
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * pi * i / count;
        *rest = fmax(*rest, fabs(values[i] - c * cos(angle) - s * sin(angle)));
    }
    return hypot(c, s);
}

static double run_out(int wheel) {
    gm_quality quality;
    GM_ASSERT_INT(gm_quality_evaluate(&quality, NULL, &pair, wheel, NULL, &pitch, NULL, &error),
                  GM_IO_OK);
    return quality.worst[GM_QUALITY_RUN_OUT].value;
}

static void eccentricity_is_a_pure_first_order_and_half_the_run_out(void) {
    static samples phases[2];
    begin();
    scatter.eccentricity = 8e-6;
    phases[0].count = phases[1].count = 0;
    for (options.seed = 0; options.seed < 200; ++options.seed) {
        for (int wheel = 0; wheel < 2; ++wheel) {
            double rest[2];
            GM_ASSERT_INT(generate(wheel), GM_IO_OK);
            GM_ASSERT_ABS(first_order(pitch.drive, pitch.teeth, &rest[0]), 8e-6, 1e-10);
            GM_ASSERT_ABS(first_order(pitch.coast, pitch.teeth, &rest[1]), 8e-6, 1e-10);
            GM_ASSERT(rest[0] < 1e-10 && rest[1] < 1e-10); /* rounded to 1e-10 m */
            /* The highest of z balls is at most half a tooth from the top, as is the lowest one. */
            const double measured = run_out(wheel);
            GM_ASSERT(measured < 16e-6 + 5e-10 && measured > 16e-6 * cos(pi / pitch.teeth) - 5e-10);
            take(&phases[wheel], pitch.drive[0]);
            end();
        }
    }
    assert_distribution(&phases[0], 0.0, 8e-6 / sqrt(2.0), 1.5);
    assert_distribution(&phases[1], 0.0, 8e-6 / sqrt(2.0), 1.5);
    assert_uncorrelated(&phases[0], &phases[1], 0);
}

/* Phase of values e cos(2 pi i / z + phase). */
static double phase_of(const double *values, int count) {
    double c = 0.0, s = 0.0;
    for (int i = 0; i < count; ++i) {
        c += values[i] * cos(2.0 * pi * i / count);
        s -= values[i] * sin(2.0 * pi * i / count);
    }
    return atan2(s, c);
}

/*
 * A displaced gear adds the displacement's share along its normal to each flank. Angles in the gear's positive direction,
 * in which teeth are counted: the flank of a tooth at phi that faces that way stands at phi + half, its normal points
 * to phi + half + 90 deg - alpha_t, that of the other flank to phi - half - 90 deg + alpha_t.
 */
static void both_flanks_of_a_tooth_see_the_same_displacement(void) {
    begin();
    scatter.eccentricity = 10e-6;
    for (int wheel = 0; wheel < 2; ++wheel) {
        const gm_gear *gear = wheel ? &pair.wheel : &pair.pinion;
        const double half =
            0.5 * gear->normal_thickness / cos(pair.helix_angle) / gear->reference_radius;
        const double expected = 2.0 * half + pi - 2.0 * pair.transverse_pressure_angle;
        GM_ASSERT_INT(generate(wheel), GM_IO_OK);
        const double between =
            phase_of(pitch.drive, pitch.teeth) - phase_of(pitch.coast, pitch.teeth);
        end();
        /* A pinion's drive flanks face its direction of rotation, those of a wheel face back. */
        const double error_of = between - (wheel ? -expected : expected);
        GM_ASSERT_ABS(remainder(error_of, 2.0 * pi), 0.0, 1e-4);
    }
}

/* Spaces, not teeth: both flanks of a space go the same way round, so that no ball in it moves. */
static void places_of_spaces_scatter_about_their_mean(void) {
    static samples places;
    begin();
    scatter.pitch = 2e-6;
    places.count = 0;
    for (options.seed = 0; options.seed < 100; ++options.seed) {
        for (int wheel = 0; wheel < 2; ++wheel) {
            double sum = 0.0;
            GM_ASSERT_INT(generate(wheel), GM_IO_OK);
            const int teeth = pitch.teeth;
            for (int i = 0; i < teeth; ++i) {
                const int other = (i + (wheel ? teeth - 1 : 1)) % teeth;
                GM_ASSERT_ABS(pitch.drive[i] + pitch.coast[other], 0.0, 1.01e-10);
                GM_ASSERT(pitch.drive_set[i] && pitch.coast_set[i]);
                sum += pitch.drive[i];
                take(&places, pitch.drive[i]);
            }
            GM_ASSERT_ABS(sum, 0.0, 45 * 0.5e-10);
            GM_ASSERT(run_out(wheel) < 1e-9);
            end();
        }
    }
    assert_normal(&places, 0.0, 2e-6 * sqrt(1.0 - 1.0 / 43.0)); /* about the mean of 45 or 41 */
}

/* ---------------------------------------------------------------------------------------------
 * The paper's flanks, ghost orders, seeds
 * ------------------------------------------------------------------------------------------- */

static int same_values(const double *a, const double *b, int count) {
    for (int i = 0; i < count; ++i) {
        if (!same_bits(a[i], b[i])) {
            return 0;
        }
    }
    return 1;
}

static void the_flanks_of_the_paper_are_one_call(void) {
    static const char *const files[2][2] = {{PAPER "pinion_flanks.csv", PAPER "pinion_pitch.csv"},
                                            {PAPER "wheel_flanks.csv", PAPER "wheel_pitch.csv"}};
    begin();
    gm_flank_scatter_paper(&scatter);
    for (int wheel = 0; wheel < 2; ++wheel) {
        gm_deviations read_deviations;
        gm_pitch read_pitch;
        GM_ASSERT_INT(generate(wheel), GM_IO_OK);
        const int teeth = pitch.teeth;
        fclose(gm_test_open(files[wheel][0]));
        fclose(gm_test_open(files[wheel][1]));
        GM_ASSERT_INT(gm_deviations_read(&read_deviations, files[wheel][0], teeth, &error),
                      GM_IO_OK);
        GM_ASSERT_INT(gm_pitch_read(&read_pitch, files[wheel][1], teeth, &error), GM_IO_OK);
        GM_ASSERT_INT(read_deviations.set_count, 2 * teeth);
        int different = 0;
        for (int i = 0; i < read_deviations.set_count; ++i) {
            different +=
                !same_values(read_deviations.sets[i].values, deviations.sets[i].values, 21 * 31);
        }
        GM_ASSERT_INT(different, 0);
        GM_ASSERT(same_values(read_pitch.drive, pitch.drive, teeth));
        GM_ASSERT(same_values(read_pitch.coast, pitch.coast, teeth));
        gm_deviations_free(&read_deviations);
        gm_pitch_free(&read_pitch);
        end();
    }
}

static void a_ghost_order_leaves_all_else_as_it_is(void) {
    const gm_flank_wave wave = {67, 0.8e-6};
    begin();
    gm_flank_scatter_paper(&scatter);
    GM_ASSERT_INT(generate(1), GM_IO_OK);
    const gm_deviations plain = deviations;
    const gm_pitch plain_pitch = pitch;
    options.waves = &wave;
    options.wave_count = 1;
    GM_ASSERT_INT(generate(1), GM_IO_OK);
    GM_ASSERT(same_values(plain_pitch.drive, pitch.drive, pitch.teeth));
    for (int i = 0; i < deviations.set_count; ++i) {
        double most = 0.0;
        for (int k = 0; k < 21 * 31; ++k) {
            most = fmax(most, fabs(deviations.sets[i].values[k] - plain.sets[i].values[k]));
        }
        GM_ASSERT_ABS(most, 0.8e-6, 0.02e-6); /* a crest is never far from one of 651 nodes */
    }
    end();
    deviations = plain;
    pitch = plain_pitch;
    end();
}

static void another_seed_gives_other_flanks(void) {
    begin();
    scatter.profile.slope.deviation = scatter.pitch = 1e-6;
    GM_ASSERT_INT(generate(0), GM_IO_OK);
    const double first[2] = {deviations.sets[0].values[0], pitch.drive[0]};
    end();
    options.seed = UINT64_C(18446744073709551615);
    GM_ASSERT_INT(generate(0), GM_IO_OK);
    GM_ASSERT(deviations.sets[0].values[0] != first[0] && pitch.drive[0] != first[1]);
    end();
}

/* ---------------------------------------------------------------------------------------------
 * Refusals
 * ------------------------------------------------------------------------------------------- */

static void refused(const char *text) {
    GM_ASSERT_INT(generate(0), GM_IO_ERR_OPTION);
    gm_test_context("%.150s", error.text);
    GM_ASSERT(strstr(error.text, text) != NULL);
    GM_ASSERT(deviations.sets == NULL && pitch.drive == NULL);
    gm_test_context("%s", "");
    begin();
}

static void what_cannot_be_is_refused(void) {
    begin();
    options.quality_class = 6;
    refused("(got class 6 and a scatter)");
    options.face_nodes = 8;
    refused("(got 8 x 31)");

    scatter.profile.slope.mean = 0.011;
    refused("profile: must be slope and crowning of at most 10 mm");
    scatter.helix.slope.deviation = -1e-6;
    refused(
        "helix: must be slope and crowning of at most 10 mm, with standard deviations not below 0");
    scatter.helix.crowning.mean = (double)NAN;
    refused("helix: must be slope and crowning");

    /* Waves. */
    scatter.profile.wave = (gm_scatter_uniform){2e-6, 1e-6};
    refused("profile: must be amplitudes of waves from low to high");
    scatter.profile.wave = (gm_scatter_uniform){-1e-6, 1e-6};
    refused("profile: must be amplitudes of waves from low to high");
    scatter.helix.wave_count = (gm_scatter_uniform){3.0, 2.0};
    refused("helix: must be numbers of waves from low to high");
    scatter.helix.wave_count = (gm_scatter_uniform){1.0, (double)INFINITY};
    refused("helix: must be numbers of waves from low to high");
    scatter.helix.wave = (gm_scatter_uniform){0.0, 1e-6};
    scatter.helix.wave_count = (gm_scatter_uniform){1.0, 5.1};
    refused("helix: must have 4 nodes per wave (got too many waves for 21 nodes)");

    /* Foot, tip and the rest. */
    scatter.foot.mean = (double)NAN;
    refused("foot: must be at most 10 mm");
    scatter.foot_end = 0.0;
    refused("foot: must be at most 10 mm, with an end above 0");
    scatter.tip_relief.deviation = 1.0;
    refused("tip relief: must be at most 10 mm");
    scatter.tip_start = 1.0;
    refused("tip relief: must be at most 10 mm, with a start from 0 to below 1");

    scatter.roughness = -1e-9;
    refused("roughness, pitch, eccentricity: must be from 0 to 10 mm");
    scatter.pitch = (double)NAN;
    refused("roughness, pitch, eccentricity: must be from 0 to 10 mm");
    scatter.eccentricity = 0.02;
    refused("roughness, pitch, eccentricity: must be from 0 to 10 mm");

    GM_ASSERT_INT(generate(0), GM_IO_OK);
    end();
    gm_flank_scatter_default(NULL);
    gm_flank_scatter_paper(NULL);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(amounts_have_the_stated_mean_and_deviation),
        GM_TEST(amounts_are_independent_of_each_other),
        GM_TEST(shapes_are_those_stated),
        GM_TEST(waves_have_the_stated_amplitudes_and_numbers),
        GM_TEST(roughness_is_independent_from_node_to_node),
        GM_TEST(eccentricity_is_a_pure_first_order_and_half_the_run_out),
        GM_TEST(both_flanks_of_a_tooth_see_the_same_displacement),
        GM_TEST(places_of_spaces_scatter_about_their_mean),
        GM_TEST(the_flanks_of_the_paper_are_one_call),
        GM_TEST(a_ghost_order_leaves_all_else_as_it_is),
        GM_TEST(another_seed_gives_other_flanks),
        GM_TEST(what_cannot_be_is_refused),
    };
    return gm_test_main("unit.generate_scatter", tests, GM_TEST_COUNT(tests), argc, argv);
}
