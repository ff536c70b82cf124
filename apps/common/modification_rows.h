/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The rows of [modifications] for the table in keys.c, which includes this behind key_macros.h and macros of its own. They
 * are made of modification_kinds.h: every key of a kind exists for each gear with and without a flank.
 */
#ifndef APPS_MODIFICATION_ROWS_H
#define APPS_MODIFICATION_ROWS_H

#include "modification_kinds.h"

/* clang-format off */
static const char modification_legend[] =
    "    With * = pinion, pinion_drive, pinion_coast, wheel, wheel_drive or wheel_coast: a key without a flank is\n"
    "    for both, one with a flank replaces it there. Amounts are along the surface normal, ranges need one of\n"
    "    length_mm, diameter_mm and share. Face I: t1 = 0, face II: t1 = 1. Without an amount: no modification.\n";

/* One key: in which place (gear and flank), of which kind and family, and what goes into it. */
#define MODIFICATION_KEY(place, gear, flank, kind_of_it, which, key, shown, member, ...)           \
    {NAME("modifications", place "_" key), INTO(modifications[gear][flank][kind_of_it].member),    \
     .family = "*_" shown, .family_member = 6 * (which) + 3 * (gear) + (flank), .used = FOR_3D,    \
     __VA_ARGS__},

/* Size along the face. */
#define NO_FACE_SIZE_KEY(...)
#define FACE_LENGTH_KEY(...) FACE_SIZE_KEY("_length_mm", __VA_ARGS__)
#define FACE_WIDTH_KEY(...)  FACE_SIZE_KEY("_width_mm", __VA_ARGS__)
#define FACE_SIZE_KEY(suffix, p, g, f, kind, which, key, shown)                                    \
    MODIFICATION_KEY(p, g, f, kind, which, key suffix, shown suffix, value[MODIFICATION_WIDTH],    \
                     NUMBER(UNIT_MM, ABOVE_ZERO), .help = "length along the face")

/* Range along the profile, in one of three ways. */
#define NO_PROFILE_RANGE_KEYS(...)
#define PROFILE_RANGE_KEYS(p, g, f, kind, which, key, shown)                                       \
    MODIFICATION_KEY(p, g, f, kind, which, key "_length_mm", shown "_length_mm",                   \
                     value[MODIFICATION_LENGTH], NUMBER(UNIT_MM, ABOVE_ZERO),                      \
                     .help = "range: roll length from the tip, or from the start of the profile")  \
    MODIFICATION_KEY(p, g, f, kind, which, key "_diameter_mm", shown "_diameter_mm",               \
                     value[MODIFICATION_RADIUS], NUMBER(UNIT_MM_DIAMETER, ABOVE_ZERO),             \
                     .help = "or the diameter that it reaches")                                    \
    MODIFICATION_KEY(p, g, f, kind, which, key "_share", shown "_share",                           \
                     value[MODIFICATION_SHARE], NUMBER(UNIT_SHARE, ABOVE_ZERO),                    \
                     .help = "or the share of the active profile's roll length, at most 1")

/* How it runs. */
#define NO_SHAPE_KEY(...)
#define CURVED_SHAPES_KEY(...) SHAPE_KEY("parabolic circular", "parabolic", __VA_ARGS__)
#define ALL_SHAPES_KEY(...)    SHAPE_KEY("linear parabolic circular", "linear", __VA_ARGS__)
#define SHAPE_KEY(names, standard_name, p, g, f, kind, which, key, shown)                          \
    MODIFICATION_KEY(p, g, f, kind, which, key "_shape", shown "_shape", shape, CHOICE(names),     \
                     .derived = (standard_name), .help = "how it runs")

/* All keys of a kind in one place. */
#define KIND_KEYS(p, g, f, kind, key, shown, which, range_of_amount, size, range, shapes, text)    \
    MODIFICATION_KEY(p, g, f, kind, which, key "_um", shown "_um", value[MODIFICATION_AMOUNT],     \
                     NUMBER(UNIT_UM, range_of_amount), .help = (text))                             \
    size##_KEY(p, g, f, kind, which, key, shown)                                                   \
    range##_KEYS(p, g, f, kind, which, key, shown)                                                 \
    shapes##_KEY(p, g, f, kind, which, key, shown)

#define MODIFICATION_ROWS                                                                          \
    MODIFICATION_KINDS(KIND_KEYS, "pinion", 0, 0)                                                  \
    MODIFICATION_KINDS(KIND_KEYS, "pinion_drive", 0, 1)                                            \
    MODIFICATION_KINDS(KIND_KEYS, "pinion_coast", 0, 2)                                            \
    MODIFICATION_KINDS(KIND_KEYS, "wheel", 1, 0)                                                   \
    MODIFICATION_KINDS(KIND_KEYS, "wheel_drive", 1, 1)                                             \
    MODIFICATION_KINDS(KIND_KEYS, "wheel_coast", 1, 2)
/* clang-format on */

#endif
