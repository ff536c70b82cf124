/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* [modifications]: from keys of an INI file to the designs of all flanks. */
/* mkdtemp() */
#define _XOPEN_SOURCE 700

#include "modification_keys.h"
#include "reference_gear.h"

#include <unistd.h>

static const char gears_text[] =
    "[gears]\npinion_teeth = 45\nwheel_teeth = 41\nnormal_module_mm = 1.65\n"
    "normal_pressure_angle_deg = 16\nhelix_angle_deg = 33\ncenter_distance_mm = 85\n"
    "face_width_mm = 17.5\nbacklash_um = 100\npinion_tip_diameter_mm = 93.87678\n"
    "wheel_tip_diameter_mm = 86.007182\n"
    "pinion_rack_dedendum = 1.75\nwheel_rack_dedendum = 1.75\n[mesh]\nstiffness_N_per_m = "
    "1e8\n[load]\nmean_Nm = 20\n"
    "[analysis]\ntype = static\n[modifications]\n";

static char folder[] = "/tmp/gearsim_modifications_XXXXXX";
static char path[sizeof folder + 16];
static config conf;
static gm_pair pair;
static gear_design designs[2];

/* Loads these keys and makes the designs of both gears. */
static void load(const char *keys_text) {
    FILE *file = fopen(path, "w");
    GM_ASSERT(file != NULL);
    fprintf(file, "%s%s", gears_text, keys_text);
    fclose(file);
    const config_request request = {.path = path, .purpose = CONFIG_FOR_RUN};
    GM_ASSERT_INT(config_load(&conf, &request), 0);
    GM_ASSERT_INT(gm_pair_init(&pair, &conf.gears), GM_OK);
    for (int gear = 0; gear < 2; ++gear) {
        GM_ASSERT_INT(gear_design_make(&designs[gear], &conf, &pair, gear), 0);
    }
}

static void unload(void) {
    config_free(&conf);
}

/* The modification of a flank, NULL = none of this kind. */
static const gm_modification *find(int gear, int side, int kind) {
    const gm_modifications *of = &designs[gear].of[side];
    for (int k = 0; k < of->count; ++k) {
        if (of->list[k].kind == kind) {
            return &of->list[k];
        }
    }
    return NULL;
}

static double amount(int gear, int side, int kind) {
    const gm_modification *found = find(gear, side, kind);
    return found == NULL ? 0.0 : found->amount;
}

/* Names by hand, beside the table of the program. */
static const struct {
    const char *name;
    int kind;
    const char *width; /* suffix, "" = none */
    int has_range;
    const char *last_shape;
} kinds[GM_MODIFICATION_KINDS] = {
    {"helix_slope", GM_MOD_HELIX_SLOPE, "", 0, NULL},
    {"crowning", GM_MOD_CROWNING, "", 0, "circular"},
    {"end_relief_I", GM_MOD_END_RELIEF_I, "_length_mm", 0, "circular"},
    {"end_relief_II", GM_MOD_END_RELIEF_II, "_length_mm", 0, "circular"},
    {"profile_slope", GM_MOD_PROFILE_SLOPE, "", 0, NULL},
    {"profile_crowning", GM_MOD_PROFILE_CROWNING, "", 0, "circular"},
    {"tip_relief", GM_MOD_TIP_RELIEF, "", 1, "circular"},
    {"root_relief", GM_MOD_ROOT_RELIEF, "", 1, "circular"},
    {"twist", GM_MOD_TWIST, "", 0, NULL},
    {"tip_corner_I", GM_MOD_TIP_CORNER_I, "_width_mm", 1, "circular"},
    {"tip_corner_II", GM_MOD_TIP_CORNER_II, "_width_mm", 1, "circular"},
    {"root_corner_I", GM_MOD_ROOT_CORNER_I, "_width_mm", 1, "circular"},
    {"root_corner_II", GM_MOD_ROOT_CORNER_II, "_width_mm", 1, "circular"},
};
static const char *const places[2][3] = {{"pinion", "pinion_drive", "pinion_coast"},
                                         {"wheel", "wheel_drive", "wheel_coast"}};

/* Text with every key of a modification. */
static void write_keys(char *text, size_t size, const char *place, int k) {
    int used = snprintf(text, size, "%s_%s_um = 7.5\n", place, kinds[k].name);
    if (*kinds[k].width != '\0') {
        used += snprintf(text + used, size - (size_t)used, "%s_%s%s = 2.5\n", place, kinds[k].name,
                         kinds[k].width);
    }
    if (kinds[k].has_range) {
        used +=
            snprintf(text + used, size - (size_t)used, "%s_%s_share = 0.3\n", place, kinds[k].name);
    }
    if (kinds[k].last_shape != NULL) {
        snprintf(text + used, size - (size_t)used, "%s_%s_shape = %s\n", place, kinds[k].name,
                 kinds[k].last_shape);
    }
}

static void every_key_arrives_at_its_gear_flank_and_kind(void) {
    char text[512];
    for (int gear = 0; gear < 2; ++gear) {
        for (int place = 0; place < 3; ++place) {
            for (int k = 0; k < GM_MODIFICATION_KINDS; ++k) {
                write_keys(text, sizeof text, places[gear][place], k);
                load(text);
                gm_test_context("%s_%s", places[gear][place], kinds[k].name);
                for (int g = 0; g < 2; ++g) {
                    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
                        const int wanted = g == gear && (place == 0 || place == 1 + side);
                        GM_ASSERT_INT(designs[g].of[side].count, wanted);
                    }
                }
                const gm_modification *got =
                    find(gear, place == 2 ? GM_COAST : GM_DRIVE, kinds[k].kind);
                if (GM_ASSERT(got != NULL)) {
                    GM_ASSERT_REL(got->amount, 7.5e-6, 1e-15);
                    if (kinds[k].last_shape != NULL) {
                        GM_ASSERT_INT(got->shape, GM_SHAPE_CIRCULAR);
                    }
                    if (*kinds[k].width != '\0') {
                        GM_ASSERT_REL(got->face_range, 2.5e-3, 1e-15);
                    }
                    if (kinds[k].has_range) {
                        GM_ASSERT_INT(got->profile_range_by, GM_RANGE_SHARE);
                        GM_ASSERT_REL(got->profile_range, 0.3, 0.0);
                    }
                }
                unload();
            }
        }
    }
}

static void ranges_and_shapes_read_as_they_are_named(void) {
    load("pinion_tip_relief_um = 10\npinion_tip_relief_length_mm = 2\n"
         "pinion_root_relief_um = 9\npinion_root_relief_diameter_mm = 87\n"
         "pinion_root_relief_shape = parabolic\npinion_crowning_um = -4\n"
         "pinion_profile_crowning_um = 3\npinion_profile_crowning_shape = circular\n");
    const gm_modification *tip = find(0, GM_COAST, GM_MOD_TIP_RELIEF);
    const gm_modification *root = find(0, GM_COAST, GM_MOD_ROOT_RELIEF);
    GM_ASSERT_INT(tip->profile_range_by, GM_RANGE_LENGTH);
    GM_ASSERT_REL(tip->profile_range, 2e-3, 1e-15);
    GM_ASSERT_INT(tip->shape, GM_SHAPE_LINEAR);
    GM_ASSERT_INT(root->profile_range_by, GM_RANGE_RADIUS);
    GM_ASSERT_REL(root->profile_range, 43.5e-3, 1e-15);
    GM_ASSERT_INT(root->shape, GM_SHAPE_PARABOLIC);
    GM_ASSERT_INT(find(0, GM_DRIVE, GM_MOD_CROWNING)->shape, GM_SHAPE_PARABOLIC);
    GM_ASSERT_REL(amount(0, GM_DRIVE, GM_MOD_CROWNING), -4e-6, 1e-15);
    GM_ASSERT_INT(find(0, GM_DRIVE, GM_MOD_PROFILE_CROWNING)->shape, GM_SHAPE_CIRCULAR);
    GM_ASSERT(designs[0].of[GM_DRIVE].gear == &pair.pinion);
    GM_ASSERT(designs[1].of[GM_DRIVE].gear == &pair.wheel);
    unload();
}

static void a_key_with_a_flank_replaces_the_one_without(void) {
    load("pinion_tip_relief_um = 10\npinion_tip_relief_length_mm = 2\n"
         "pinion_tip_relief_shape = circular\n"
         "pinion_coast_tip_relief_um = 6\npinion_coast_tip_relief_share = 0.5\n"
         "wheel_crowning_um = 5\nwheel_drive_crowning_um = 0\n");
    const gm_modification *coast = find(0, GM_COAST, GM_MOD_TIP_RELIEF);
    GM_ASSERT_REL(coast->amount, 6e-6, 1e-15);
    GM_ASSERT_INT(coast->profile_range_by, GM_RANGE_SHARE);
    GM_ASSERT_REL(coast->profile_range, 0.5, 0.0);
    GM_ASSERT_INT(coast->shape, GM_SHAPE_CIRCULAR); /* as for both flanks */
    GM_ASSERT_REL(amount(0, GM_DRIVE, GM_MOD_TIP_RELIEF), 10e-6, 1e-15);
    GM_ASSERT(find(1, GM_DRIVE, GM_MOD_CROWNING) == NULL); /* 0 = none */
    GM_ASSERT_REL(amount(1, GM_COAST, GM_MOD_CROWNING), 5e-6, 1e-15);
    unload();
}

static void nothing_given_is_no_design(void) {
    load("");
    for (int gear = 0; gear < 2; ++gear) {
        GM_ASSERT_INT(designs[gear].of[GM_DRIVE].count + designs[gear].of[GM_COAST].count, 0);
    }
    GM_ASSERT_REL(conf.modification_tolerance, 1e-8, 1e-15);
    unload();
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(every_key_arrives_at_its_gear_flank_and_kind),
        GM_TEST(ranges_and_shapes_read_as_they_are_named),
        GM_TEST(a_key_with_a_flank_replaces_the_one_without),
        GM_TEST(nothing_given_is_no_design),
    };
    if (mkdtemp(folder) == NULL) {
        return 1;
    }
    snprintf(path, sizeof path, "%s/run.ini", folder);
    const int result =
        gm_test_main("unit.modification_keys", tests, GM_TEST_COUNT(tests), argc, argv);
    (void)unlink(path);
    (void)rmdir(folder);
    return result;
}
