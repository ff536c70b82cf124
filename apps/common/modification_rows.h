/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The rows of [modifications] for the table in keys.c, which includes this behind key_macros.h and macros of its own.
 * Every key exists for each gear with and without a flank; a row is written once and --help shows it once, as a family
 * of keys.
 */
#ifndef APPS_MODIFICATION_ROWS_H
#define APPS_MODIFICATION_ROWS_H

/* clang-format off */
static const char modification_legend[] =
    "    With * = pinion, pinion_drive, pinion_coast, wheel, wheel_drive or wheel_coast: a key without a flank is\n"
    "    for both, one with a flank replaces it there. Amounts are along the surface normal, ranges need one of\n"
    "    length_mm, diameter_mm and share. Face I: t1 = 0, face II: t1 = 1. Without an amount: no modification.\n";

#define MODIFICATION_ROW(prefix, gear, flank, kind_of_it, which, key, shown, member, ...)          \
    {NAME("modifications", prefix "_" key), INTO(modifications[gear][flank][kind_of_it].member),   \
     .family = "*_" shown, .family_member = 6 * (which) + 3 * (gear) + (flank), .used = FOR_3D,    \
     __VA_ARGS__}

#define AMOUNT_ROW(p, g, f, kind, which, key, shown, range, text)                                  \
    MODIFICATION_ROW(p, g, f, kind, which, key "_um", shown "_um", value[MODIFICATION_AMOUNT],     \
                     NUMBER(UNIT_UM, range), .help = (text))
#define SHAPE_ROW(p, g, f, kind, which, key, shown, names, standard_name)                          \
    MODIFICATION_ROW(p, g, f, kind, which, key "_shape", shown "_shape", shape, CHOICE(names),     \
                     .derived = (standard_name), .help = "how it runs")
#define WIDTH_ROW(p, g, f, kind, which, key, shown, suffix)                                        \
    MODIFICATION_ROW(p, g, f, kind, which, key suffix, shown suffix, value[MODIFICATION_WIDTH],    \
                     NUMBER(UNIT_MM, ABOVE_ZERO), .help = "length along the face")
#define RANGE_ROWS(p, g, f, kind, which, key, shown)                                               \
    MODIFICATION_ROW(p, g, f, kind, which, key "_length_mm", shown "_length_mm",                   \
                     value[MODIFICATION_LENGTH], NUMBER(UNIT_MM, ABOVE_ZERO),                      \
                     .help = "range: roll length from the tip, or from the start of the profile"), \
    MODIFICATION_ROW(p, g, f, kind, which, key "_diameter_mm", shown "_diameter_mm",               \
                     value[MODIFICATION_RADIUS], NUMBER(UNIT_MM_DIAMETER, ABOVE_ZERO),             \
                     .help = "or the diameter that it reaches"),                                   \
    MODIFICATION_ROW(p, g, f, kind, which, key "_share", shown "_share",                           \
                     value[MODIFICATION_SHARE], NUMBER(UNIT_SI, ABOVE_ZERO),                       \
                     .help = "or the share of the active profile's roll length, at most 1")

#define CROWNING_ROWS(p, g, f, kind, key, text)                                                    \
    AMOUNT_ROW(p, g, f, kind, 0, key, key, ANY, text),                                             \
    SHAPE_ROW(p, g, f, kind, 0, key, key, "parabolic circular", "parabolic")
#define END_RELIEF_ROWS(p, g, f, kind, which, key)                                                 \
    AMOUNT_ROW(p, g, f, kind, which, key, "end_relief_{I,II}", NOT_NEGATIVE,                       \
               "C_beta_I, C_beta_II: removed at that face"),                                       \
    WIDTH_ROW(p, g, f, kind, which, key, "end_relief_{I,II}", "_length_mm"),                       \
    SHAPE_ROW(p, g, f, kind, which, key, "end_relief_{I,II}", "linear parabolic circular", "linear")
#define PROFILE_RELIEF_ROWS(p, g, f, kind, which, key)                                             \
    AMOUNT_ROW(p, g, f, kind, which, key, "{tip,root}_relief", NOT_NEGATIVE,                       \
               "C_alpha_a, C_alpha_f: removed at the tip, at the start of the profile"),           \
    RANGE_ROWS(p, g, f, kind, which, key, "{tip,root}_relief"),                                    \
    SHAPE_ROW(p, g, f, kind, which, key, "{tip,root}_relief", "linear parabolic circular", "linear")
#define CORNER_ROWS(p, g, f, kind, which, key)                                                     \
    AMOUNT_ROW(p, g, f, kind, which, key, "{tip,root}_corner_{I,II}", NOT_NEGATIVE,                \
               "triangular relief: removed at that corner"),                                       \
    WIDTH_ROW(p, g, f, kind, which, key, "{tip,root}_corner_{I,II}", "_width_mm"),                 \
    RANGE_ROWS(p, g, f, kind, which, key, "{tip,root}_corner_{I,II}"),                             \
    SHAPE_ROW(p, g, f, kind, which, key, "{tip,root}_corner_{I,II}", "linear parabolic circular",  \
              "linear")

/* Families stand together: --help shows the first member of each. */
#define FLANK_ROWS(p, g, f)                                                                        \
    AMOUNT_ROW(p, g, f, GM_MOD_HELIX_SLOPE, 0, "helix_slope", "helix_slope", ANY,                  \
               "C_H_beta, > 0: material towards face II"),                                         \
    CROWNING_ROWS(p, g, f, GM_MOD_CROWNING, "crowning",                                            \
                  "C_beta: removed at both faces, none at mid-face"),                              \
    END_RELIEF_ROWS(p, g, f, GM_MOD_END_RELIEF_I, 0, "end_relief_I"),                              \
    END_RELIEF_ROWS(p, g, f, GM_MOD_END_RELIEF_II, 1, "end_relief_II"),                            \
    AMOUNT_ROW(p, g, f, GM_MOD_PROFILE_SLOPE, 0, "profile_slope", "profile_slope", ANY,            \
               "C_H_alpha, > 0: material towards the tip"),                                        \
    CROWNING_ROWS(p, g, f, GM_MOD_PROFILE_CROWNING, "profile_crowning",                            \
                  "C_alpha: removed at tip and start of the profile"),                             \
    PROFILE_RELIEF_ROWS(p, g, f, GM_MOD_TIP_RELIEF, 0, "tip_relief"),                              \
    PROFILE_RELIEF_ROWS(p, g, f, GM_MOD_ROOT_RELIEF, 1, "root_relief"),                            \
    AMOUNT_ROW(p, g, f, GM_MOD_TWIST, 0, "twist", "twist", ANY,                                    \
               "S_alpha: profile slope at face II less that at face I"),                           \
    CORNER_ROWS(p, g, f, GM_MOD_TIP_CORNER_I, 0, "tip_corner_I"),                                  \
    CORNER_ROWS(p, g, f, GM_MOD_TIP_CORNER_II, 1, "tip_corner_II"),                                \
    CORNER_ROWS(p, g, f, GM_MOD_ROOT_CORNER_I, 2, "root_corner_I"),                                \
    CORNER_ROWS(p, g, f, GM_MOD_ROOT_CORNER_II, 3, "root_corner_II")

#define MODIFICATION_ROWS                                                                          \
    FLANK_ROWS("pinion", 0, 0), FLANK_ROWS("pinion_drive", 0, 1), FLANK_ROWS("pinion_coast", 0, 2),\
    FLANK_ROWS("wheel", 1, 0), FLANK_ROWS("wheel_drive", 1, 1), FLANK_ROWS("wheel_coast", 1, 2)
/* clang-format on */

#endif
