/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Designed modifications in prepared flanks: alone, on top of files, and what they do to a pair of gears. */
#include "flank.h" /* what the objects hold */
#include "io_test.h"
#include "reference_gear.h"

#define UM 1e-6

enum { FACE_NODES = 4, PROFILE_NODES = 5 }; /* of the file */

static gm_pair pair;
static gm_modification list[3];
static gm_modifications design;
static double values[2][FACE_NODES * PROFILE_NODES];
static gm_deviation_set sets[2];
static gm_deviations deviations;
static gm_flanks_options options;
static gm_flanks *flanks;
static gm_flanks_report report;
static gm_io_error error;

/* Tip relief, which becomes a ramp, and crowning and a root relief, which need a table. */
static void begin(void) {
    pair = reference_pair(REFERENCE_FACE_WIDTH);
    list[0] =
        (gm_modification){GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR, GM_RANGE_SHARE, 15 * UM, 0.0, 0.3};
    list[1] = (gm_modification){GM_MOD_CROWNING, GM_SHAPE_PARABOLIC, 0, 6 * UM, 0.0, 0.0};
    list[2] =
        (gm_modification){GM_MOD_ROOT_RELIEF, GM_SHAPE_PARABOLIC, GM_RANGE_SHARE, 8 * UM, 0.0, 0.3};
    design = (gm_modifications){list, 3, &pair.pinion, pair.face_width};
    deviations = (gm_deviations){pair.pinion.teeth, FACE_NODES, PROFILE_NODES, 0, sets};
    gm_flanks_options_default(&options);
    options.drive_modifications = &design;
}

/* A set of a tooth, or of all (-1), with uneven values of some micrometres. */
static void add_set(int tooth, int side) {
    const int i = deviations.set_count++;
    sets[i] = (gm_deviation_set){tooth, side, values[i]};
    for (int k = 0; k < FACE_NODES * PROFILE_NODES; ++k) {
        values[i][k] = (k * k % 17 - 5 * i) * UM;
    }
}

static int build(int with_file) {
    return gm_flanks_build(&flanks, pair.pinion.teeth, with_file ? &deviations : NULL, NULL,
                           &options, &report, &error);
}

static void end(void) {
    gm_flanks_free(flanks);
    flanks = NULL;
}

static double node_of(const gmi_tables *side, int tooth, int face, int profile) {
    const int place =
        (side->table[tooth] * side->face_nodes + face) * side->profile_nodes + profile;
    return side->values[4 * place];
}

/* The file's table between its nodes, as libgearmesh/docs/flank-files.md defines it. */
static double of_file(int set, double t1, double t2) {
    int i = (int)(t1 * (FACE_NODES - 1)), j = (int)(t2 * (PROFILE_NODES - 1));
    i = i > FACE_NODES - 2 ? FACE_NODES - 2 : i;
    j = j > PROFILE_NODES - 2 ? PROFILE_NODES - 2 : j;
    const double u = t1 * (FACE_NODES - 1) - i, v = t2 * (PROFILE_NODES - 1) - j;
    const double *low = values[set] + i * PROFILE_NODES + j;
    const double *high = low + PROFILE_NODES;
    return (1 - u) * ((1 - v) * low[0] + v * low[1]) + u * ((1 - v) * high[0] + v * high[1]);
}

/* What is left at a point of a flank by the ramps of its side. */
static double ramps_at(const gmi_tables *side, double t1, double t2) {
    double sum = 0.0;
    for (int k = 0; k < side->ramp_count; ++k) {
        const gm_flank_ramp *ramp = &side->ramps[k];
        sum -= fmax(0.0, ramp->offset + ramp->per_t1 * t1 + ramp->per_t2 * t2);
    }
    return sum;
}

/* Every node of a tooth, less ramps, is file * scale + design, times the normal factor; set -1 = no file. */
static void nodes_are(const gmi_tables *side, int tooth, int set, double file_scale) {
    double worst = 0.0;
    for (int face = 0; face < side->face_nodes; ++face) {
        for (int profile = 0; profile < side->profile_nodes; ++profile) {
            const double t1 = (double)face / (side->face_nodes - 1);
            const double t2 = (double)profile / (side->profile_nodes - 1);
            const double file = set >= 0 ? file_scale * of_file(set, t1, t2) : 0.0;
            const double expected =
                options.normal_factor * (file + gm_modifications_value(&design, t1, t2));
            const double got = node_of(side, tooth, face, profile) + ramps_at(side, t1, t2);
            worst = fmax(worst, fabs(got - expected));
        }
    }
    /* some ten roundings of values below 50 um */
    GM_ASSERT_ABS(worst, 0.0, 1e-14 * 50 * UM);
}

/* Largest distance of a side's flank from the design between the nodes: the flank is the table and the ramps. */
static double distance_from_design(const gmi_tables *side) {
    enum { STEPS = 211 };
    double worst = 0.0;
    for (int i = 0; i <= STEPS; ++i) {
        for (int k = 0; k <= STEPS; ++k) {
            const double t1 = (double)i / STEPS, t2 = (double)k / STEPS;

            /* Bilinear within the cell. */
            const double along_face = t1 * (side->face_nodes - 1);
            const double along_profile = t2 * (side->profile_nodes - 1);
            const int face = (int)fmin(along_face, side->face_nodes - 2);
            const int profile = (int)fmin(along_profile, side->profile_nodes - 2);
            const double u = along_face - face, v = along_profile - profile;
            const double table = (1 - u) * ((1 - v) * node_of(side, 0, face, profile) +
                                            v * node_of(side, 0, face, profile + 1)) +
                                 u * ((1 - v) * node_of(side, 0, face + 1, profile) +
                                      v * node_of(side, 0, face + 1, profile + 1));

            const double got = table + ramps_at(side, t1, t2);
            worst = fmax(worst, fabs(got - gm_modifications_value(&design, t1, t2)));
        }
    }
    return worst;
}

static void the_report_says_what_holds_the_design_and_how_well(void) {
    begin();
    options.modification_tolerance = 0.05 * UM;
    GM_ASSERT_INT(build(0), GM_IO_OK);
    GM_ASSERT_INT(report.drive.ramps, 1);
    GM_ASSERT_INT(report.drive.face_nodes, flanks->side[GM_DRIVE].face_nodes);
    GM_ASSERT_INT(report.drive.profile_nodes, flanks->side[GM_DRIVE].profile_nodes);

    /* A bound that holds and is not far off: tables of parabolas are worst in the middle of a cell. */
    const double found = distance_from_design(&flanks->side[GM_DRIVE]);
    GM_ASSERT(report.drive.error <= options.modification_tolerance);
    GM_ASSERT(found <= report.drive.error * (1 + 1e-9) && found > 0.2 * report.drive.error);

    /* Nothing is said of the side without a design, nor after an error. */
    GM_ASSERT_INT(report.coast.ramps + report.coast.face_nodes + report.coast.profile_nodes, 0);
    GM_ASSERT_ABS(report.coast.error, 0.0, 0.0);
    end();
    options.scale = (double)NAN;
    GM_ASSERT_INT(build(0), GM_IO_ERR_OPTION);
    GM_ASSERT_INT(report.drive.ramps + report.drive.face_nodes, 0);

    /* A ramp alone needs no table. */
    begin();
    design.count = 1;
    GM_ASSERT_INT(build(0), GM_IO_OK);
    GM_ASSERT_INT(report.drive.ramps, 1);
    GM_ASSERT_INT(report.drive.face_nodes, 0);
    GM_ASSERT_ABS(report.drive.error, 0.0, 0.0);
    end();
}

static void a_design_alone_takes_one_table_for_all_teeth_of_its_side(void) {
    begin();
    options.normal_factor = 1.25;
    GM_ASSERT_INT(build(0), GM_IO_OK);
    const gm_modifications rest = {list + 1, 2, &pair.pinion, pair.face_width};
    gm_modifications_grid grid;
    GM_ASSERT_INT(gm_modifications_grid_find(&rest, 2, 2, 1e-8, &grid), GM_OK);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].count, 1);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].ramp_count, 1);
    GM_ASSERT_INT(flanks->side[GM_COAST].ramp_count, 0);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].table[44], 0);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].face_nodes, grid.face_nodes);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].profile_nodes, grid.profile_nodes);
    GM_ASSERT_INT(flanks->side[GM_COAST].capacity, 0);
    GM_ASSERT_INT(flanks->side[GM_COAST].table[0], -1);
    nodes_are(&flanks->side[GM_DRIVE], 7, -1, 0.0);
    end();
}

static void linear_reliefs_alone_need_no_table(void) {
    begin();
    list[1] =
        (gm_modification){GM_MOD_ROOT_CORNER_I, GM_SHAPE_LINEAR, GM_RANGE_SHARE, 9 * UM, 4e-3, 0.4};
    design.count = 2;
    options.normal_factor = 1.25;
    GM_ASSERT_INT(build(0), GM_IO_OK);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].capacity, 0);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].ramp_count, 2);
    for (int k = 0; k <= 100; ++k) {
        const double t1 = 0.1 * (k % 11), t2 = 0.01 * k;
        GM_ASSERT_ABS(ramps_at(&flanks->side[GM_DRIVE], t1, t2),
                      1.25 * gm_modifications_value(&design, t1, t2), 1e-14 * 50 * UM);
    }
    end();
    /* and leave the tables of a file as they are */
    add_set(-1, -1);
    GM_ASSERT_INT(build(1), GM_IO_OK);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].face_nodes, FACE_NODES);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].profile_nodes, PROFILE_NODES);
    nodes_are(&flanks->side[GM_DRIVE], 2, 0, 1.0);
    end();
}

static void each_side_has_a_design_and_a_grid_of_its_own(void) {
    begin();
    const gm_modification twist = {.kind = GM_MOD_TWIST, .amount = 3 * UM};
    const gm_modifications other = {&twist, 1, &pair.pinion, pair.face_width};
    options.coast_modifications = &other;
    GM_ASSERT_INT(build(0), GM_IO_OK);
    GM_ASSERT_INT(flanks->side[GM_COAST].face_nodes, 2);
    GM_ASSERT_INT(flanks->side[GM_COAST].profile_nodes, 2);
    GM_ASSERT_REL(node_of(&flanks->side[GM_COAST], 0, 1, 1), 0.75 * UM, 1e-15);
    GM_ASSERT(flanks->side[GM_DRIVE].profile_nodes > 2);
    end();
}

static void an_empty_design_is_none(void) {
    begin();
    design.count = 0;
    GM_ASSERT_INT(build(0), GM_IO_OK);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].capacity, 0);
    end();
}

static void a_design_is_added_to_the_tables_of_a_file(void) {
    begin();
    add_set(-1, -1);
    add_set(3, GM_DRIVE);
    options.scale = -2.0;
    options.normal_factor = 1.17;
    GM_ASSERT_INT(build(1), GM_IO_OK);
    GM_ASSERT_INT((flanks->side[GM_DRIVE].face_nodes - 1) % (FACE_NODES - 1), 0);
    GM_ASSERT_INT((flanks->side[GM_DRIVE].profile_nodes - 1) % (PROFILE_NODES - 1), 0);
    nodes_are(&flanks->side[GM_DRIVE], 0, 0, -2.0);
    nodes_are(&flanks->side[GM_DRIVE], 3, 1, -2.0);
    GM_ASSERT_INT(flanks->side[GM_COAST].face_nodes, FACE_NODES); /* no design there */
    GM_ASSERT_INT(flanks->side[GM_COAST].profile_nodes, PROFILE_NODES);
    end();
}

static void teeth_without_a_set_have_the_design_alone(void) {
    begin();
    add_set(3, GM_DRIVE);
    GM_ASSERT_INT(build(1), GM_IO_OK);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].count, 2);
    nodes_are(&flanks->side[GM_DRIVE], 3, 0, 1.0);
    nodes_are(&flanks->side[GM_DRIVE], 4, -1, 0.0);
    end();
    begin(); /* deviations without a set at all */
    GM_ASSERT_INT(build(1), GM_IO_OK);
    nodes_are(&flanks->side[GM_DRIVE], 0, -1, 0.0);
    end();
}

/* Outside the relief the file's nodes arrive with their bits. */
static void the_nodes_of_a_file_are_kept_exactly(void) {
    begin();
    list[0].shape = GM_SHAPE_PARABOLIC;
    design.count = 1;
    add_set(-1, -1);
    GM_ASSERT_INT(build(1), GM_IO_OK);
    const int per_face = (flanks->side[GM_DRIVE].face_nodes - 1) / (FACE_NODES - 1);
    const int per_profile = (flanks->side[GM_DRIVE].profile_nodes - 1) / (PROFILE_NODES - 1);
    for (int face = 0; face < FACE_NODES; ++face) {
        for (int profile = 0; profile < 3; ++profile) { /* t2 <= 0.5 */
            GM_ASSERT(same_bits(
                node_of(&flanks->side[GM_DRIVE], 9, face * per_face, profile * per_profile),
                values[0][face * PROFILE_NODES + profile] + 0.0));
        }
    }
    GM_ASSERT(per_profile > 1);
    end();
}

static void the_profile_window_acts_on_the_file_only(void) {
    begin();
    add_set(-1, -1);
    options.profile_from = 2.0; /* beside the flank: nothing is left of the file */
    options.profile_to = 3.0;
    GM_ASSERT_INT(build(1), GM_IO_OK);
    nodes_are(&flanks->side[GM_DRIVE], 5, 0, 0.0);
    end();
}

/* ---------------------------------------------------------------------------------------------
 * What is refused
 * ------------------------------------------------------------------------------------------- */

static void refused(const char *value, const char *right) {
    GM_ASSERT_INT(build(0), GM_IO_ERR_OPTION);
    assert_error(&error, "", 0, value, right);
    GM_ASSERT(flanks == NULL);
}

static void designs_that_cannot_be_are_refused(void) {
    begin();
    list[1].amount = (double)NAN;
    refused("modification 1: its amount", "at most 10 mm");
    begin();
    design.gear = &pair.wheel;
    refused("(got 41)", "the modifications must be for the 45 teeth of the gear");
    begin();
    design.gear = NULL;
    refused("pointer is NULL", "");
    begin();
    design.face_width = -1.0;
    refused("its face_width", "> 0");
    begin();
    options.modification_tolerance = 0.0;
    refused("(got 0)", "modification_tolerance: must be at least 1e-12 m");
    begin();

    /* 2 m together, beyond a double with this factor */
    static gm_modification many[GM_MODIFICATIONS_MAX];

    for (int k = 0; k < GM_MODIFICATIONS_MAX; ++k) {
        many[k] =
            (gm_modification){.kind = GM_MOD_CROWNING, .shape = GM_SHAPE_PARABOLIC, .amount = 0.01};
    }
    design.list = many;
    design.count = GM_MODIFICATIONS_MAX;
    options.normal_factor = 1.5e308;
    refused("the modifications cannot be used with these options", "");
    begin(); /* a ramp that would rise by 15 m over the profile, times 1e308 */
    list[0].profile_range = 1e-6;
    design.count = 1;
    options.normal_factor = 1.5e308;
    refused("the modifications cannot be used with these options", "not finite");
}

/* ---------------------------------------------------------------------------------------------
 * Long tip relief of a spur pair
 *
 * A pair of teeth carries K (delta - e), where delta is the same for all pairs and e is what both flanks lack.
 * Let L be the part of the path on which two pairs touch, and let both tips have a linear relief of amount C over
 * that length. Where one pair touches, no relief has begun: delta = F / K. Where two do, one is s L before its end,
 * 0 <= s <= 1, and lacks C (1 - s) at the pinion's tip; the other one is (1 - s) L behind its beginning and
 * lacks C s at the wheel's tip: K (2 delta - C) = F. Both agree for C = F / K, where delta, and with it the
 * transmission error, is constant: it varies by nothing. At half of that load delta is C / 2 and 3 C / 4, at
 * twice the load 2 C and 3 C / 2: it varies by C / 4 and by C / 2.
 *
 * The path is delta shorter than g_alpha, as the tips reach each other earlier by delta (libgearmesh/docs/equations.md):
 * L = g_alpha - C - p_bt at the design load. At others L is off by C / 2 and C of some 3 mm, which changes e by
 * that part of C: hence the tolerance of 1 % below.
 * ------------------------------------------------------------------------------------------- */

static double design_force(double amount) {
    return REFERENCE_STIFFNESS * amount;
}

static gm_modification long_relief(double amount) {
    const double length = path_of(&pair) - amount - pair.transverse_base_pitch;
    const gm_modification relief = {
        GM_MOD_TIP_RELIEF, GM_SHAPE_LINEAR, GM_RANGE_LENGTH, amount, 0.0, length};
    return relief;
}

static gm_flanks *flanks_of(const gm_gear *gear, const gm_modification *relief) {
    const gm_modifications tips = {relief, 1, gear, pair.face_width};
    gm_flanks *built;
    gm_flanks_options_default(&options);
    options.drive_modifications = &tips;
    GM_ASSERT_INT(gm_flanks_build(&built, gear->teeth, NULL, NULL, &options, NULL, &error),
                  GM_IO_OK);
    return built;
}

/* Peak-to-peak transmission error over a mesh (m). */
static double variation(const gm_flanks *pinion, const gm_flanks *wheel, double force) {
    enum { STEPS = 997 };
    double least = INFINITY, most = -INFINITY;
    for (int k = 0; k < STEPS; ++k) {
        const double angle = 6.283185307179586 * k / STEPS / pair.pinion.teeth;
        double offset = 0.0;
        GM_ASSERT_INT(equilibrium(&pair, pinion, wheel, angle, REFERENCE_STIFFNESS,
                                  force * pair.wheel.base_radius, &offset, NULL),
                      GM_OK);
        least = fmin(least, offset);
        most = fmax(most, offset);
    }
    return most - least;
}

static void long_tip_relief_takes_the_transmission_error_of_its_load_away(void) {
    const double amount = 20 * UM;
    pair = spur_pair();
    GM_ASSERT(pair.transverse_contact_ratio > 1.3 && pair.transverse_contact_ratio < 1.9);
    const gm_modification relief = long_relief(amount);
    gm_flanks *pinion = flanks_of(&pair.pinion, &relief);
    gm_flanks *wheel = flanks_of(&pair.wheel, &relief);
    const double force = design_force(amount);

    /* What remains are roundings of lengths of some millimetres. */
    GM_ASSERT_ABS(variation(pinion, wheel, force), 0.0, 1e-15);
    GM_ASSERT_REL(variation(pinion, wheel, 0.5 * force), 0.25 * amount, 0.01);
    GM_ASSERT_REL(variation(pinion, wheel, 2.0 * force), 0.5 * amount, 0.01);
    /* and without any relief delta steps between F / K and F / (2 K) */
    GM_ASSERT_REL(variation(NULL, NULL, force), 0.5 * amount, 1e-3);
    gm_flanks_free(pinion);
    gm_flanks_free(wheel);
}

/* ---------------------------------------------------------------------------------------------
 * Both flanks
 *
 * Mirrored at the plane through both axes, a spur pair turns from phi_p, x to -phi_p, -x, drive flanks become
 * coast flanks, and t1 and t2 of a point stay.
 * ------------------------------------------------------------------------------------------- */

static double offset_at(const gm_flanks *pinion, double angle, double torque) {
    double offset = (double)NAN;
    GM_ASSERT_INT(
        equilibrium(&pair, pinion, NULL, angle, REFERENCE_STIFFNESS, torque, &offset, NULL), GM_OK);
    return offset;
}

static void the_same_design_on_the_other_flank_is_its_mirror_image(void) {
    pair = spur_pair();
    const gm_modification uneven[] = {
        {GM_MOD_TIP_RELIEF, GM_SHAPE_PARABOLIC, GM_RANGE_SHARE, 15 * UM, 0.0, 0.4},
        {GM_MOD_END_RELIEF_I, GM_SHAPE_LINEAR, 0, 10 * UM, 4e-3, 0.0},
        {GM_MOD_TWIST, 0, 0, 8 * UM, 0.0, 0.0},
        {GM_MOD_HELIX_SLOPE, 0, 0, 12 * UM, 0.0, 0.0},
    };
    const gm_modifications of = {uneven, 4, &pair.pinion, pair.face_width};
    gm_flanks_options_default(&options);
    options.drive_modifications = options.coast_modifications = &of;
    GM_ASSERT_INT(gm_flanks_build(&flanks, pair.pinion.teeth, NULL, NULL, &options, NULL, &error),
                  GM_IO_OK);
    double largest = 0.0;
    for (int k = 0; k < 40; ++k) {
        const double angle = 6.283185307179586 * (k + 0.37) / 40 / pair.pinion.teeth;
        const double forward = offset_at(flanks, angle, 20.0);
        /* x is found to a rounding of the path, some millimetres */
        GM_ASSERT_ABS(offset_at(flanks, -angle, -20.0), -forward, 1e-15);
        largest = fmax(largest, fabs(forward - offset_at(NULL, angle, 20.0)));
    }
    GM_ASSERT(largest > UM); /* the design is felt */
    end();
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(a_design_alone_takes_one_table_for_all_teeth_of_its_side),
        GM_TEST(the_report_says_what_holds_the_design_and_how_well),
        GM_TEST(linear_reliefs_alone_need_no_table),
        GM_TEST(each_side_has_a_design_and_a_grid_of_its_own),
        GM_TEST(an_empty_design_is_none),
        GM_TEST(a_design_is_added_to_the_tables_of_a_file),
        GM_TEST(teeth_without_a_set_have_the_design_alone),
        GM_TEST(the_nodes_of_a_file_are_kept_exactly),
        GM_TEST(the_profile_window_acts_on_the_file_only),
        GM_TEST(designs_that_cannot_be_are_refused),
        GM_TEST(the_same_design_on_the_other_flank_is_its_mirror_image),
        GM_TEST(long_tip_relief_takes_the_transmission_error_of_its_load_away),
    };
    return gm_test_main("unit.flank_design", tests, GM_TEST_COUNT(tests), argc, argv);
}
