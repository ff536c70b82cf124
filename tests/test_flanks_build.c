/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Flanks from the contents of files: which set serves which tooth, scale, normal factor, profile window. */
#include "flank.h" /* what the objects hold */
#include "io_test.h"

enum { TEETH = 5, FACE_NODES = 3, PROFILE_NODES = 11, NODES = 33, MOST_SETS = 8 };

static double values[MOST_SETS][NODES];
static gm_deviation_set sets[MOST_SETS];
static gm_deviations deviations;

static double drive_pitch[TEETH];
static double coast_pitch[TEETH];
static int drive_set[TEETH];
static int coast_set[TEETH];
static gm_pitch pitch;

static gm_flanks *flanks;
static gm_flanks_options options;
static gm_io_error error;

static void begin(void) {
    deviations = (gm_deviations){TEETH, FACE_NODES, PROFILE_NODES, 0, sets};
    pitch = (gm_pitch){TEETH, drive_pitch, coast_pitch, drive_set, coast_set};
    for (int tooth = 0; tooth < TEETH; ++tooth) {
        drive_pitch[tooth] = 1e-6 * (tooth + 1);
        coast_pitch[tooth] = -2e-6 * (tooth + 1);
        drive_set[tooth] = coast_set[tooth] = 1;
    }
    gm_flanks_options_default(&options);
}

/* Adds a set whose nodes are level, level + 1 um, level + 2 um .. in the order of the file. */
static void add_set(int tooth, int side, double level) {
    const int i = deviations.set_count++;
    sets[i] = (gm_deviation_set){tooth, side, values[i]};
    for (int node = 0; node < NODES; ++node) {
        values[i][node] = level + 1e-6 * node;
    }
}

static int build(const gm_deviations *of, const gm_pitch *with) {
    return gm_flanks_build(&flanks, TEETH, of, with, &options, NULL, &error);
}

static void end(void) {
    gm_flanks_free(flanks);
    flanks = NULL;
}

static const gmi_tables *tables(int side) {
    return side == GM_DRIVE ? &flanks->side[GM_DRIVE] : &flanks->side[GM_COAST];
}

/* Prepared value of a node; NaN if the tooth is ideal. */
static double node_value(int side, int tooth, int face, int profile) {
    const gmi_tables *of = tables(side);
    const int table = of->table[tooth];
    if (table < 0) {
        return (double)NAN;
    }
    return of->values[4 * ((table * of->face_nodes + face) * of->profile_nodes + profile)];
}

/* ---------------------------------------------------------------------------------------------
 * Which set serves which tooth
 * ------------------------------------------------------------------------------------------- */

static void nothing_given_makes_ideal_flanks(void) {
    begin();
    GM_ASSERT_INT(build(NULL, NULL), GM_IO_OK);
    GM_ASSERT_INT(flanks->teeth, TEETH);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].count, 0);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].table[3], -1);
    GM_ASSERT_REL(flanks->side[GM_COAST].pitch[3], 0.0, 0.0);
    end();
    GM_ASSERT_INT(build(&deviations, NULL), GM_IO_OK); /* deviations without a set */
    GM_ASSERT_INT(flanks->side[GM_COAST].table[0], -1);
    end();
}

static void every_node_arrives_in_its_place(void) {
    begin();
    add_set(2, GM_COAST, 1e-6);
    GM_ASSERT_INT(build(&deviations, NULL), GM_IO_OK);
    GM_ASSERT_INT(flanks->side[GM_COAST].face_nodes, FACE_NODES);
    GM_ASSERT_INT(flanks->side[GM_COAST].profile_nodes, PROFILE_NODES);
    for (int face = 0; face < FACE_NODES; ++face) {
        for (int profile = 0; profile < PROFILE_NODES; ++profile) {
            GM_ASSERT_REL(node_value(GM_COAST, 2, face, profile),
                          1e-6 + 1e-6 * (face * PROFILE_NODES + profile), 0.0);
        }
    }
    end();
}

static void teeth_without_a_set_are_ideal(void) {
    begin();
    add_set(2, GM_COAST, 1e-6);
    GM_ASSERT_INT(build(&deviations, NULL), GM_IO_OK);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].capacity, 0);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].table[2], -1);
    GM_ASSERT_INT(flanks->side[GM_COAST].capacity, 1);
    GM_ASSERT_INT(flanks->side[GM_COAST].table[1], -1);
    GM_ASSERT_INT(flanks->side[GM_COAST].table[3], -1);
    end();
}

static void the_most_special_set_wins_in_any_order(void) {
    /* Sets by bits of `present`; expected by the rule: tooth and flank, tooth, flank, all. */
    static const int tooth[4] = {-1, -1, 3, 3};
    static const int side[4] = {-1, GM_DRIVE, -1, GM_DRIVE};
    const double ideal = -1.0;
    for (int present = 1; present < 16; ++present) {
        const double all = present & 1 ? 100e-6 : ideal;
        const double drive = present & 2 ? 200e-6 : all;
        const double own = present & 4 ? 300e-6 : drive;
        const double both = present & 8 ? 400e-6 : own;
        const double own_coast = present & 4 ? 300e-6 : all;
        for (int backward = 0; backward < 2; ++backward) {
            begin();
            for (int i = 0; i < 4; ++i) {
                const int k = backward ? 3 - i : i;
                if (present & (1 << k)) {
                    add_set(tooth[k], side[k], 100e-6 * (k + 1));
                }
            }
            gm_test_context("present %d backward %d", present, backward);
            GM_ASSERT_INT(build(&deviations, NULL), GM_IO_OK);
            const double got[4] = {node_value(GM_DRIVE, 3, 0, 0), node_value(GM_COAST, 3, 0, 0),
                                   node_value(GM_DRIVE, 0, 0, 0), node_value(GM_COAST, 0, 0, 0)};
            const double expected[4] = {both, own_coast, drive, all};
            for (int i = 0; i < 4; ++i) {
                GM_ASSERT_REL(isnan(got[i]) ? ideal : got[i], expected[i], 1e-15);
            }
            end();
        }
    }
}

static void a_shared_set_takes_one_place_on_each_side(void) {
    begin();
    add_set(-1, -1, 0.0);
    GM_ASSERT_INT(build(&deviations, NULL), GM_IO_OK);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].count, 1);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].capacity, 1);
    GM_ASSERT_INT(flanks->side[GM_COAST].count, 1);
    for (int tooth = 0; tooth < TEETH; ++tooth) {
        GM_ASSERT_INT(flanks->side[GM_DRIVE].table[tooth], 0);
        GM_ASSERT_INT(flanks->side[GM_COAST].table[tooth], 0);
    }
    end();
}

static void own_sets_take_a_place_each_beside_the_shared_one(void) {
    begin();
    add_set(-1, -1, 0.0);
    add_set(1, GM_DRIVE, 0.0);
    add_set(4, -1, 0.0);
    GM_ASSERT_INT(build(&deviations, NULL), GM_IO_OK);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].capacity, 3);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].count, 3);
    GM_ASSERT_INT(flanks->side[GM_COAST].capacity, 2);
    GM_ASSERT_INT(flanks->side[GM_COAST].count, 2);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].table[0], flanks->side[GM_DRIVE].table[3]);
    GM_ASSERT(flanks->side[GM_DRIVE].table[1] != flanks->side[GM_DRIVE].table[0]);
    GM_ASSERT(flanks->side[GM_DRIVE].table[4] != flanks->side[GM_DRIVE].table[0]);
    end();
}

/* ---------------------------------------------------------------------------------------------
 * Scale, normal factor, profile window
 * ------------------------------------------------------------------------------------------- */

static void the_defaults_change_nothing(void) {
    GM_ASSERT_REL((gm_flanks_options_default(&options), options.scale), 1.0, 0.0);
    GM_ASSERT_REL(options.normal_factor, 1.0, 0.0);
    GM_ASSERT_REL(options.profile_from, 0.0, 0.0);
    GM_ASSERT_REL(options.profile_to, 1.0, 0.0);
    GM_ASSERT_REL(options.profile_blend, 0.1, 0.0);
    begin();
    add_set(-1, -1, 1e-6);
    GM_ASSERT_INT(gm_flanks_build(&flanks, TEETH, &deviations, &pitch, NULL, NULL, NULL), GM_IO_OK);
    GM_ASSERT_REL(node_value(GM_DRIVE, 0, 0, 0), 1e-6, 0.0);
    GM_ASSERT_REL(node_value(GM_DRIVE, 0, 0, 10), 11e-6, 1e-15);
    GM_ASSERT_REL(flanks->side[GM_DRIVE].pitch[4], 5e-6, 1e-15);
    GM_ASSERT_REL(flanks->side[GM_COAST].pitch[4], -10e-6, 1e-15);
    end();
}

static void the_scale_multiplies_deviations_and_pitch(void) {
    begin();
    add_set(-1, -1, 1e-6);
    options.scale = -0.5;
    GM_ASSERT_INT(build(&deviations, &pitch), GM_IO_OK);
    GM_ASSERT_REL(node_value(GM_COAST, 1, 0, 1), -1e-6, 1e-15);
    GM_ASSERT_REL(flanks->side[GM_DRIVE].pitch[1], -1e-6, 1e-15);
    GM_ASSERT_REL(flanks->side[GM_COAST].pitch[1], 2e-6, 1e-15);
    end();
}

static void the_normal_factor_multiplies_deviations_but_not_pitch(void) {
    begin();
    add_set(-1, -1, 1e-6);
    options.normal_factor = 1.25;
    options.scale = 2.0;
    GM_ASSERT_INT(build(&deviations, &pitch), GM_IO_OK);
    GM_ASSERT_REL(node_value(GM_DRIVE, 1, 0, 3), 2.5 * 4e-6, 1e-15);
    GM_ASSERT_REL(flanks->side[GM_DRIVE].pitch[1], 2.0 * 2e-6, 1e-15);
    end();
}

/* Holds the weight of every node along the profile against what it should be. */
static void weights_are(double from, double to, double blend, const double *weights) {
    begin();
    add_set(-1, -1, 1e-6);
    options.profile_from = from;
    options.profile_to = to;
    options.profile_blend = blend;
    GM_ASSERT_INT(build(&deviations, &pitch), GM_IO_OK);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        for (int profile = 0; profile < PROFILE_NODES; ++profile) {
            gm_test_context("%g to %g blend %g: t2 = %g", from, to, blend, profile / 10.0);
            const double plain = 1e-6 * (PROFILE_NODES + profile + 1);
            /* t2 and the ends of the window carry a rounding each, over the width of a blend */
            GM_ASSERT_ABS(node_value(side, 2, 1, profile) / plain, weights[profile], 1e-14);
        }
    }
    GM_ASSERT_REL(flanks->side[GM_DRIVE].pitch[2], 3e-6, 1e-15); /* never windowed */
    GM_ASSERT_REL(flanks->side[GM_COAST].pitch[2], -6e-6, 1e-15);
    end();
}

static void the_window_falls_linearly_to_zero_over_the_blend(void) {
    weights_are(0.3, 0.6, 0.2, (const double[]){0, 0, 0.5, 1, 1, 1, 1, 0.5, 0, 0, 0});
    weights_are(0.3, 0.6, 0.4, (const double[]){0.25, 0.5, 0.75, 1, 1, 1, 1, 0.75, 0.5, 0.25, 0});
    weights_are(0.4, 2.0, 0.1, (const double[]){0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1});
    weights_are(0.35, 0.65, 0.1, (const double[]){0, 0, 0, 0.5, 1, 1, 1, 0.5, 0, 0, 0});
}

static void a_blend_of_zero_cuts_hard(void) {
    weights_are(0.3, 0.6, 0.0, (const double[]){0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0});
    weights_are(0.35, 0.55, 0.0, (const double[]){0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0});
}

static void a_window_beside_the_flank_leaves_only_pitch(void) {
    weights_are(2.0, 3.0, 0.5, (const double[]){0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    weights_are(-2.0, -1.0, 0.5, (const double[]){0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
}

static void pitch_that_is_not_set_is_not_used(void) {
    begin();
    drive_set[2] = 0;
    GM_ASSERT_INT(build(NULL, &pitch), GM_IO_OK);
    GM_ASSERT_REL(flanks->side[GM_DRIVE].pitch[2], 0.0, 0.0);
    GM_ASSERT_REL(flanks->side[GM_COAST].pitch[2], -6e-6, 1e-15);
    end();
}

/* ---------------------------------------------------------------------------------------------
 * What is refused
 * ------------------------------------------------------------------------------------------- */

static void refused(const char *value) {
    flanks = (gm_flanks *)&pitch; /* anything but NULL */
    GM_ASSERT_INT(build(&deviations, &pitch), GM_IO_ERR_OPTION);
    assert_error(&error, "", 0, value, "");
    GM_ASSERT(flanks == NULL);
    end();
}

static void options_out_of_range_are_refused(void) {
    begin();
    options.scale = (double)NAN;
    refused("the scale must be finite");
    begin();
    options.normal_factor = 0.0;
    refused("normal factor");
    begin();
    options.normal_factor = (double)INFINITY;
    refused("normal factor");
    begin();
    options.profile_from = options.profile_to;
    refused("window");
    begin();
    options.profile_to = (double)INFINITY;
    refused("window");
    begin();
    options.profile_blend = -0.1;
    refused("blend");
    begin();
    options.profile_blend = (double)NAN;
    refused("blend");
}

static void another_number_of_teeth_is_refused(void) {
    begin();
    deviations.teeth = TEETH + 1;
    refused("flank deviations must be for the 5 teeth of the gear (got 6)");
    begin();
    pitch.teeth = TEETH - 1;
    refused("pitch deviations must be for the 5 teeth of the gear (got 4)");
    begin();
    GM_ASSERT_INT(gm_flanks_build(&flanks, 2, NULL, NULL, NULL, NULL, &error), GM_IO_ERR_OPTION);
    assert_error(&error, "", 0, "(got 2)", "teeth: must be from 3 to 100000");
}

static void values_that_are_not_finite_are_refused(void) {
    begin();
    add_set(1, 1, 0.0);
    values[0][7] = (double)NAN;
    refused("set 0 of the deviations: all values must be finite");
    begin();
    coast_pitch[3] = (double)INFINITY;
    refused("pitch deviations of tooth 3: must be finite");
}

static void values_that_the_scale_makes_absurd_are_refused(void) {
    static const double scales[] = {1e4, 1e300};
    for (int k = 0; k < 2; ++k) {
        begin();
        add_set(1, 1, 1e-3);
        options.scale = scales[k];
        refused("set 0 of the deviations cannot be used");
    }
    begin();
    drive_pitch[3] = 1e-3;
    options.scale = 1e4;
    refused("pitch deviation of tooth 3 cannot be used");
}

static void two_sets_for_the_same_flank_are_refused(void) {
    begin();
    add_set(1, GM_DRIVE, 0.0);
    add_set(-1, -1, 0.0);
    add_set(1, GM_DRIVE, 0.0);
    refused("tooth 1, flank drive: must have one set");
}

static void a_call_without_a_required_pointer_is_refused(void) {
    begin();
    GM_ASSERT_INT(gm_flanks_build(NULL, TEETH, NULL, NULL, NULL, NULL, NULL), GM_IO_ERR_NULL);
    gm_flanks_free(NULL);
    gm_flanks_options_default(NULL);
}

/* ---------------------------------------------------------------------------------------------
 * From the file to the flank
 * ------------------------------------------------------------------------------------------- */

static void files_become_flanks(void) {
    gm_deviations read;
    gm_pitch read_pitch;
    begin();
    GM_ASSERT_INT(
        gm_deviations_read(&read,
                           file_of("tooth,flank,t1,t2,deviation_um\n*,*,0,0,1\n*,*,0,1,2\n"
                                   "*,*,1,0,3\n*,*,1,1,4\n4,drive,1,1,8\n4,drive,1,0,7\n"
                                   "4,drive,0,1,6\n4,drive,0,0,5\n"),
                           TEETH, &error),
        GM_IO_OK);
    GM_ASSERT_INT(gm_pitch_read(&read_pitch, file_of("tooth,flank,deviation_um\n1,coast,-3\n"),
                                TEETH, &error),
                  GM_IO_OK);
    GM_ASSERT_INT(build(&read, &read_pitch), GM_IO_OK);
    gm_deviations_free(&read); /* the flanks have values of their own */
    gm_pitch_free(&read_pitch);
    GM_ASSERT_REL(node_value(GM_COAST, 4, 1, 0), 3e-6, 0.0);
    GM_ASSERT_REL(node_value(GM_DRIVE, 3, 0, 1), 2e-6, 0.0);
    GM_ASSERT_REL(node_value(GM_DRIVE, 4, 0, 1), 6e-6, 0.0);
    GM_ASSERT_REL(node_value(GM_DRIVE, 4, 1, 0), 7e-6, 0.0);
    GM_ASSERT_REL(flanks->side[GM_COAST].pitch[1], -3e-6, 0.0);
    GM_ASSERT_REL(flanks->side[GM_DRIVE].pitch[1], 0.0, 0.0);
    end();
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(nothing_given_makes_ideal_flanks),
        GM_TEST(every_node_arrives_in_its_place),
        GM_TEST(teeth_without_a_set_are_ideal),
        GM_TEST(the_most_special_set_wins_in_any_order),
        GM_TEST(a_shared_set_takes_one_place_on_each_side),
        GM_TEST(own_sets_take_a_place_each_beside_the_shared_one),
        GM_TEST(the_defaults_change_nothing),
        GM_TEST(the_scale_multiplies_deviations_and_pitch),
        GM_TEST(the_normal_factor_multiplies_deviations_but_not_pitch),
        GM_TEST(the_window_falls_linearly_to_zero_over_the_blend),
        GM_TEST(a_blend_of_zero_cuts_hard),
        GM_TEST(a_window_beside_the_flank_leaves_only_pitch),
        GM_TEST(pitch_that_is_not_set_is_not_used),
        GM_TEST(options_out_of_range_are_refused),
        GM_TEST(another_number_of_teeth_is_refused),
        GM_TEST(values_that_are_not_finite_are_refused),
        GM_TEST(values_that_the_scale_makes_absurd_are_refused),
        GM_TEST(two_sets_for_the_same_flank_are_refused),
        GM_TEST(a_call_without_a_required_pointer_is_refused),
        GM_TEST(files_become_flanks),
    };
    return gm_test_main("unit.flanks_build", tests, GM_TEST_COUNT(tests), argc, argv);
}
