/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The kinds of designed modifications as an INI file names them, one row each: what a kind is called, which keys it has,
 * and what --help says of it. The keys of [modifications] (modification_rows.h) and what is read from them
 * (modification_keys.c) are made of these rows.
 *
 *     ROW(kind of gearmesh.h, name in the keys, name in --help, member of that family, range of the amount,
 *         size along the face, range along the profile, shapes, what the amount is)
 *
 * Size along the face: NO_FACE_SIZE, FACE_LENGTH (`_length_mm`) or FACE_WIDTH (`_width_mm`). Range along the profile:
 * NO_PROFILE_RANGE or PROFILE_RANGE (`_length_mm`, `_diameter_mm` or `_share`). Shapes: NO_SHAPE, CURVED_SHAPES
 * (parabolic, circular) or ALL_SHAPES (linear as well); the first is the default. Kinds whose keys --help shows as one
 * family stand together; it shows the keys of member 0.
 */
#ifndef APPS_MODIFICATION_KINDS_H
#define APPS_MODIFICATION_KINDS_H

/* clang-format off */
/* `...` is passed on to every row, before what is its own. */
#define MODIFICATION_KINDS(ROW, ...)                                                               \
    ROW(__VA_ARGS__, GM_MOD_HELIX_SLOPE, "helix_slope", "helix_slope", 0, ANY,                     \
        NO_FACE_SIZE, NO_PROFILE_RANGE, NO_SHAPE,                                                  \
        "C_H_beta, > 0: material towards face II")                                                 \
    ROW(__VA_ARGS__, GM_MOD_CROWNING, "crowning", "crowning", 0, ANY,                              \
        NO_FACE_SIZE, NO_PROFILE_RANGE, CURVED_SHAPES,                                             \
        "C_beta: removed at both faces, none at mid-face")                                         \
    ROW(__VA_ARGS__, GM_MOD_END_RELIEF_I, "end_relief_I", "end_relief_{I,II}", 0, NOT_NEGATIVE,    \
        FACE_LENGTH, NO_PROFILE_RANGE, ALL_SHAPES,                                                 \
        "C_beta_I, C_beta_II: removed at that face")                                               \
    ROW(__VA_ARGS__, GM_MOD_END_RELIEF_II, "end_relief_II", "end_relief_{I,II}", 1, NOT_NEGATIVE,  \
        FACE_LENGTH, NO_PROFILE_RANGE, ALL_SHAPES,                                                 \
        "C_beta_I, C_beta_II: removed at that face")                                               \
    ROW(__VA_ARGS__, GM_MOD_PROFILE_SLOPE, "profile_slope", "profile_slope", 0, ANY,               \
        NO_FACE_SIZE, NO_PROFILE_RANGE, NO_SHAPE,                                                  \
        "C_H_alpha, > 0: material towards the tip")                                                \
    ROW(__VA_ARGS__, GM_MOD_PROFILE_CROWNING, "profile_crowning", "profile_crowning", 0, ANY,      \
        NO_FACE_SIZE, NO_PROFILE_RANGE, CURVED_SHAPES,                                             \
        "C_alpha: removed at tip and start of the profile")                                        \
    ROW(__VA_ARGS__, GM_MOD_TIP_RELIEF, "tip_relief", "{tip,root}_relief", 0, NOT_NEGATIVE,        \
        NO_FACE_SIZE, PROFILE_RANGE, ALL_SHAPES,                                                   \
        "C_alpha_a, C_alpha_f: removed at the tip, at the start of the profile")                   \
    ROW(__VA_ARGS__, GM_MOD_ROOT_RELIEF, "root_relief", "{tip,root}_relief", 1, NOT_NEGATIVE,      \
        NO_FACE_SIZE, PROFILE_RANGE, ALL_SHAPES,                                                   \
        "C_alpha_a, C_alpha_f: removed at the tip, at the start of the profile")                   \
    ROW(__VA_ARGS__, GM_MOD_TWIST, "twist", "twist", 0, ANY,                                       \
        NO_FACE_SIZE, NO_PROFILE_RANGE, NO_SHAPE,                                                  \
        "S_alpha: profile slope at face II less that at face I")                                   \
    ROW(__VA_ARGS__, GM_MOD_TIP_CORNER_I, "tip_corner_I", "{tip,root}_corner_{I,II}", 0,           \
        NOT_NEGATIVE, FACE_WIDTH, PROFILE_RANGE, ALL_SHAPES,                                       \
        "triangular relief: removed at that corner")                                               \
    ROW(__VA_ARGS__, GM_MOD_TIP_CORNER_II, "tip_corner_II", "{tip,root}_corner_{I,II}", 1,         \
        NOT_NEGATIVE, FACE_WIDTH, PROFILE_RANGE, ALL_SHAPES,                                       \
        "triangular relief: removed at that corner")                                               \
    ROW(__VA_ARGS__, GM_MOD_ROOT_CORNER_I, "root_corner_I", "{tip,root}_corner_{I,II}", 2,         \
        NOT_NEGATIVE, FACE_WIDTH, PROFILE_RANGE, ALL_SHAPES,                                       \
        "triangular relief: removed at that corner")                                               \
    ROW(__VA_ARGS__, GM_MOD_ROOT_CORNER_II, "root_corner_II", "{tip,root}_corner_{I,II}", 3,       \
        NOT_NEGATIVE, FACE_WIDTH, PROFILE_RANGE, ALL_SHAPES,                                       \
        "triangular relief: removed at that corner")
/* clang-format on */

#endif
