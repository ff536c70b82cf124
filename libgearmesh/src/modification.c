/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Designed flank modifications: their values, and the uniform grid on which a bilinear table of them is true
 * to a tolerance. Formulae and the derivation of the bound: libgearmesh/docs/modifications.md.
 */
#include "internal.h"

#include <float.h>
#include <math.h>

#define SMALLEST_TOLERANCE 1e-12 /* m; below it rounding takes over */
#define LARGEST_CELLS      (GMI_LARGEST_NODES - 1)

/* A table has 32 bytes per node, and every tooth with measured flanks has a table of its own. */
#define TABLE_NODES 262144

enum axis { FACE, PROFILE };

static int is_crowning(int kind) {
    return kind == GM_MOD_CROWNING || kind == GM_MOD_PROFILE_CROWNING;
}

/* Bilinear over the whole flank, so that every grid holds them exactly. */
static int is_plain(int kind) {
    return kind == GM_MOD_HELIX_SLOPE || kind == GM_MOD_PROFILE_SLOPE || kind == GM_MOD_TWIST;
}

static int is_corner(int kind) {
    return kind >= GM_MOD_TIP_CORNER_I && kind <= GM_MOD_ROOT_CORNER_II;
}

static int has_face_range(int kind) {
    return kind == GM_MOD_END_RELIEF_I || kind == GM_MOD_END_RELIEF_II || is_corner(kind);
}

static int has_profile_range(int kind) {
    return kind == GM_MOD_TIP_RELIEF || kind == GM_MOD_ROOT_RELIEF || is_corner(kind);
}

static int is_relief(int kind) {
    return has_face_range(kind) || has_profile_range(kind);
}

/* Begins at the tip, not at the start of the active profile. */
static int is_at_tip(int kind) {
    return kind == GM_MOD_TIP_RELIEF || kind == GM_MOD_TIP_CORNER_I || kind == GM_MOD_TIP_CORNER_II;
}

/* Begins at face II (t1 = 1), not at face I (t1 = 0). */
static int is_at_face_ii(int kind) {
    return kind == GM_MOD_END_RELIEF_II || kind == GM_MOD_TIP_CORNER_II ||
           kind == GM_MOD_ROOT_CORNER_II;
}

/* ---------------------------------------------------------------------------------------------
 * Ranges
 * ------------------------------------------------------------------------------------------- */

static double roll_of(const gm_modifications *of) {
    return fabs(of->gear->tip_roll_length - of->gear->start_roll_length);
}

/* Roll length of the range, from the tip or from the start of the active profile (m). */
static double profile_length(const gm_modifications *of, const gm_modification *m) {
    const gm_gear *gear = of->gear;
    if (m->profile_range_by == GM_RANGE_SHARE) {
        return m->profile_range * roll_of(of);
    }
    if (m->profile_range_by == GM_RANGE_LENGTH) {
        return m->profile_range;
    }
    const double limit = gmi_roll_length(m->profile_range, gear->base_radius);
    return fabs(limit - (is_at_tip(m->kind) ? gear->tip_roll_length : gear->start_roll_length));
}

/* Length over which the amount is reached, along the direction of the steepest descent (m). */
static double length_of(const gm_modifications *of, const gm_modification *m) {
    if (m->kind == GM_MOD_CROWNING) {
        return 0.5 * of->face_width;
    }
    if (m->kind == GM_MOD_PROFILE_CROWNING) {
        return 0.5 * roll_of(of);
    }

    /* Along one direction, or across a corner: the height of its triangle. */
    if (!has_face_range(m->kind)) {
        return profile_length(of, m);
    }
    if (!has_profile_range(m->kind)) {
        return m->face_range;
    }
    const double along_profile = profile_length(of, m);
    return m->face_range * along_profile / hypot(m->face_range, along_profile);
}

/* Range as a share of the face width or of the active profile; 0 = the kind has none along this axis. */
static double range_share(const gm_modifications *of, const gm_modification *m, int axis) {
    if (axis == FACE) {
        return has_face_range(m->kind) ? m->face_range / of->face_width : 0.0;
    }
    return has_profile_range(m->kind) ? profile_length(of, m) / roll_of(of) : 0.0;
}

/* ---------------------------------------------------------------------------------------------
 * Checks
 * ------------------------------------------------------------------------------------------- */

typedef struct problem {
    const char *field; /* NULL = none */
    const char *requirement;
} problem;

static problem problem_of(const char *field, const char *requirement) {
    const problem found = {field, requirement};
    return found;
}

/* The start of a ring's flank lies outside its tip. */
static int is_on_profile(const gm_gear *gear, double radius) {
    return radius >= fmin(gear->start_radius, gear->tip_radius) &&
           radius <= fmax(gear->start_radius, gear->tip_radius);
}

static problem check_profile_range(const gm_modifications *of, const gm_modification *m) {
    const double range = m->profile_range;
    static const char field[] = "profile_range";

    /* Each way to give it has its own range. */
    switch (m->profile_range_by) {
    case GM_RANGE_LENGTH:
        if (!(range > 0.0 && range <= roll_of(of) * (1.0 + 4.0 * DBL_EPSILON))) {
            return problem_of(field, "a roll length above 0 and within the active profile");
        }
        break;
    case GM_RANGE_SHARE:
        if (!(range > 0.0 && range <= 1.0)) {
            return problem_of(field, "a share above 0 and at most 1");
        }
        break;
    case GM_RANGE_RADIUS:
        if (!is_on_profile(of->gear, range) || !(profile_length(of, m) > 0.0)) {
            return problem_of(field, "a radius within the active profile that leaves a range");
        }
        break;
    default:
        return problem_of("profile_range_by", "GM_RANGE_LENGTH, GM_RANGE_SHARE or GM_RANGE_RADIUS");
    }
    return problem_of(NULL, NULL);
}

static problem check_shape(const gm_modifications *of, const gm_modification *m) {
    if (is_plain(m->kind)) {
        return problem_of(NULL, NULL);
    }
    if (is_crowning(m->kind) && m->shape == GM_SHAPE_LINEAR) {
        return problem_of("shape", "GM_SHAPE_PARABOLIC or GM_SHAPE_CIRCULAR");
    }
    if (m->shape < GM_SHAPE_LINEAR || m->shape > GM_SHAPE_CIRCULAR) {
        return problem_of("shape", "GM_SHAPE_LINEAR, GM_SHAPE_PARABOLIC or GM_SHAPE_CIRCULAR");
    }

    /* At half of its length a circle already falls by 4 in 3 where it ends: R = 1.25 L. */
    if (m->shape == GM_SHAPE_CIRCULAR && fabs(m->amount) > 0.5 * length_of(of, m)) {
        return problem_of("amount", "at most half of the length that a circular shape runs over");
    }
    return problem_of(NULL, NULL);
}

static problem check_one(const gm_modifications *of, const gm_modification *m) {
    if (m->kind < 0 || m->kind >= GM_MODIFICATION_KINDS) {
        return problem_of("kind", "one of enum gm_modification_kind");
    }
    if (!(fabs(m->amount) <= GMI_LARGEST_AMOUNT)) {
        return problem_of("amount", "a number of at most 10 mm");
    }
    if (is_relief(m->kind) && m->amount < 0.0) {
        return problem_of("amount", "a number >= 0: reliefs remove material");
    }

    /* Ranges, of the kinds that have them. */
    if (has_face_range(m->kind) && !(m->face_range > 0.0 && m->face_range <= of->face_width)) {
        return problem_of("face_range", "a length above 0 and at most the face width");
    }
    if (has_profile_range(m->kind)) {
        const problem found = check_profile_range(of, m);
        if (found.field != NULL) {
            return found;
        }
    }

    return check_shape(of, m);
}

static problem check_flank(const gm_modifications *of) {
    if (!(of->face_width > 0.0) || !gmi_is_finite(of->face_width)) {
        return problem_of("face_width", "a number > 0");
    }
    if (!(roll_of(of) > 0.0) || !gmi_is_finite(roll_of(of))) {
        return problem_of("gear", "a gear of a pair that gm_pair_init() has filled");
    }
    if (of->count < 0 || of->count > GM_MODIFICATIONS_MAX) {
        return problem_of("count", "a number from 0 to 200");
    }
    return problem_of(NULL, NULL);
}

/* The first problem, and which modification has it; index -1 = none in particular. */
static problem check_all(const gm_modifications *of, int *index) {
    problem found = check_flank(of);
    *index = -1;
    for (int k = 0; found.field == NULL && k < of->count; ++k) {
        found = check_one(of, &of->list[k]);
        *index = found.field == NULL ? -1 : k;
    }
    return found;
}

static int status_of(const gm_modifications *of) {
    int index;
    if (of == NULL || of->gear == NULL || (of->list == NULL && of->count > 0)) {
        return GM_ERR_NULL;
    }
    return check_all(of, &index).field == NULL ? GM_OK : GM_ERR_PARAMETER;
}

int gm_modifications_check(const gm_modifications *modifications, int *index, const char **field,
                           const char **requirement) {
    int at = -1;
    problem found = problem_of(NULL, NULL);
    int status = status_of(modifications);
    if (status == GM_ERR_PARAMETER) {
        found = check_all(modifications, &at);
    }

    /* What the caller wants to hear of it. */
    if (index != NULL) {
        *index = at;
    }
    if (field != NULL) {
        *field = found.field;
    }
    if (requirement != NULL) {
        *requirement = found.requirement;
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * Values
 * ------------------------------------------------------------------------------------------- */

/*
 * Material removed at the share s of the length. A circle of radius R = (L^2 + C^2) / (2 C) that touches the
 * ideal flank at s = 0 is R - sqrt(R^2 - (s L)^2) below it, written here without cancellation.
 */
static double removed(const gm_modification *m, double length, double s) {
    if (m->shape == GM_SHAPE_LINEAR) {
        return m->amount * s;
    }
    if (m->shape == GM_SHAPE_PARABOLIC || m->amount == 0.0) {
        return m->amount * s * s;
    }
    const double depth = fabs(m->amount);
    const double radius = 0.5 * (length * (length / depth) + depth);
    const double along = length * s;
    const double below = along * (along / (radius + sqrt((radius - along) * (radius + along))));
    return m->amount > 0.0 ? below : -below;
}

/* How far into the range a point is: 0 where it begins, 1 at its end, clipped below. */
static double share_of_range(const gm_modifications *of, const gm_modification *m, double t1,
                             double t2) {
    double s = 1.0;
    if (m->kind == GM_MOD_CROWNING) {
        return fabs(2.0 * t1 - 1.0);
    }
    if (m->kind == GM_MOD_PROFILE_CROWNING) {
        return fabs(2.0 * t2 - 1.0);
    }

    /* Reliefs: along the face, the profile, or for corners both, which falls off along the diagonal. */
    if (has_face_range(m->kind)) {
        s -= (is_at_face_ii(m->kind) ? 1.0 - t1 : t1) / range_share(of, m, FACE);
    }
    if (has_profile_range(m->kind)) {
        s -= (is_at_tip(m->kind) ? 1.0 - t2 : t2) / range_share(of, m, PROFILE);
    }
    return s > 0.0 ? s : 0.0;
}

static double value_of(const gm_modifications *of, const gm_modification *m, double t1, double t2) {
    switch (m->kind) {
    case GM_MOD_HELIX_SLOPE:
        return m->amount * (t1 - 0.5);
    case GM_MOD_PROFILE_SLOPE:
        return m->amount * (t2 - 0.5);
    case GM_MOD_TWIST:
        return m->amount * (t1 - 0.5) * (t2 - 0.5);
    default:
        return -removed(m, length_of(of, m), share_of_range(of, m, t1, t2));
    }
}

static double sum_of(const gm_modifications *of, double t1, double t2) {
    double sum = 0.0;
    for (int k = 0; k < of->count; ++k) {
        sum += value_of(of, &of->list[k], t1, t2);
    }
    return sum;
}

double gm_modifications_value(const gm_modifications *modifications, double t1, double t2) {
    if (status_of(modifications) != GM_OK || !(t1 >= 0.0 && t1 <= 1.0 && t2 >= 0.0 && t2 <= 1.0)) {
        return gmi_nan();
    }
    return sum_of(modifications, t1, t2);
}

static int are_nodes(int nodes) {
    return nodes >= GMI_SMALLEST_NODES && nodes <= GMI_LARGEST_NODES;
}

int gm_modifications_add(const gm_modifications *modifications, int face_nodes, int profile_nodes,
                         double *deviation) {
    const int status = status_of(modifications);
    if (status != GM_OK) {
        return status;
    }
    if (deviation == NULL) {
        return GM_ERR_NULL;
    }
    if (!are_nodes(face_nodes) || !are_nodes(profile_nodes)) {
        return GM_ERR_PARAMETER;
    }

    /* Row by row, as the table lies in memory. */
    for (int face = 0; face < face_nodes; ++face) {
        const double t1 = (double)face / (face_nodes - 1);
        for (int profile = 0; profile < profile_nodes; ++profile) {
            *deviation++ += sum_of(modifications, t1, (double)profile / (profile_nodes - 1));
        }
    }
    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Ramps
 * ------------------------------------------------------------------------------------------- */

/* amount * share_of_range(), as a plane. */
static gm_flank_ramp ramp_of(const gm_modifications *of, const gm_modification *m) {
    gm_flank_ramp ramp = {m->amount, 0.0, 0.0};
    if (has_face_range(m->kind)) {
        const double rise = m->amount / range_share(of, m, FACE);
        ramp.per_t1 = is_at_face_ii(m->kind) ? rise : -rise;
        ramp.offset -= is_at_face_ii(m->kind) ? rise : 0.0;
    }
    if (has_profile_range(m->kind)) {
        const double rise = m->amount / range_share(of, m, PROFILE);
        ramp.per_t2 = is_at_tip(m->kind) ? rise : -rise;
        ramp.offset -= is_at_tip(m->kind) ? rise : 0.0;
    }
    return ramp;
}

int gm_modifications_split(const gm_modifications *modifications,
                           gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX], int *ramp_count,
                           gm_modification *rest, int *rest_count) {
    if (ramp_count == NULL || rest_count == NULL) {
        return GM_ERR_NULL;
    }
    *ramp_count = *rest_count = 0;
    const int status = status_of(modifications);
    if (status != GM_OK) {
        return status;
    }
    if (ramps == NULL || (rest == NULL && modifications->count > 0)) {
        return GM_ERR_NULL;
    }

    /* Linear reliefs become ramps while there is room for them. */
    for (int k = 0; k < modifications->count; ++k) {
        const gm_modification *m = &modifications->list[k];
        if (m->amount == 0.0) {
            continue;
        }
        if (is_relief(m->kind) && m->shape == GM_SHAPE_LINEAR && *ramp_count < GM_FLANK_RAMPS_MAX) {
            ramps[(*ramp_count)++] = ramp_of(modifications, m);
        } else {
            rest[(*rest_count)++] = *m;
        }
    }
    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * The grid
 * ------------------------------------------------------------------------------------------- */

/* Largest second derivative of removed() by s (m). That of the circle is largest at its end. */
static double curvature_of(const gm_modification *m, double length) {
    const double depth = fabs(m->amount);
    if (m->shape == GM_SHAPE_PARABOLIC || depth == 0.0) {
        return 2.0 * depth;
    }
    const double radius = 0.5 * (length * (length / depth) + depth);
    const double cosine = (length - depth) * (length + depth) / (length * length + depth * depth);
    return length * length / (radius * cosine * cosine * cosine);
}

/*
 * Bound of the bilinear error of one modification along one axis (m); errors along both add up. `cell` is the
 * change of s over a cell. A kink at the part d of a cell costs C cell d (1 - d), nothing on a grid line.
 */
static double error_of(const gm_modifications *of, const gm_modification *m, int axis, int cells) {
    const double depth = fabs(m->amount);
    const double share = range_share(of, m, axis);
    if (is_crowning(m->kind)) {
        const double cell = (m->kind == GM_MOD_CROWNING) == (axis == FACE) ? 2.0 / cells : 0.0;
        return curvature_of(m, length_of(of, m)) * cell * cell / 8.0;
    }

    /* Kinds that are linear along this axis have no error along it. */
    if (!(share > 0.0)) {
        return 0.0;
    }

    /* What its curvature loses within a cell, or its kink costs; never more than the whole amount. */
    const double cell = 1.0 / (cells * share);
    const double at = cells * share;
    const double part = at - floor(at);
    double error = curvature_of(m, length_of(of, m)) * cell * cell / 8.0;
    if (m->shape == GM_SHAPE_LINEAR) {
        error = depth * cell * (is_corner(m->kind) ? 0.25 : part * (1.0 - part));
    }
    return error < depth ? error : depth;
}

static double axis_error(const gm_modifications *of, int axis, int cells) {
    double error = 0.0;
    for (int k = 0; k < of->count; ++k) {
        error += error_of(of, &of->list[k], axis, cells);
    }
    return error;
}

/* Fewest cells, a multiple of `base` up to `most`, with an error within the limit; 0 = none. */
static int fewest_cells(const gm_modifications *of, int axis, int base, int most, double limit) {
    for (int cells = base; cells <= most; cells += base) {
        if (axis_error(of, axis, cells) <= limit) {
            return cells;
        }
    }
    return 0;
}

/* Most cells along an axis beside others along the other one, so that a table stays affordable. */
static int most_cells(int axis, const int base[2], int others) {
    const int affordable = TABLE_NODES / (others + 1) - 1;
    const int most = affordable < LARGEST_CELLS ? affordable : LARGEST_CELLS;
    return most > base[axis] || others > base[1 - axis] ? most : base[axis];
}

/*
 * Fewest grid lines that keep the sum of both axes within the limit, over a set of ways to divide it; an axis that
 * gets next to nothing must hold its modifications exactly. Returns 0 if no affordable grid does.
 */
static int divide_limit(const gm_modifications *of, const int base[2], double limit, int cells[2]) {
    static const double face_part[] = {1e-6,  0.125, 0.25,  0.375,     0.5,
                                       0.625, 0.75,  0.875, 1.0 - 1e-6};

    int fewest = 0;
    for (size_t k = 0; k < sizeof face_part / sizeof face_part[0]; ++k) {
        const int face = fewest_cells(of, FACE, base[FACE], most_cells(FACE, base, base[PROFILE]),
                                      face_part[k] * limit);
        if (face == 0) {
            continue;
        }

        /* The rest of the limit is for the profile. */
        const int profile =
            fewest_cells(of, PROFILE, base[PROFILE], most_cells(PROFILE, base, face),
                         (1.0 - face_part[k]) * limit);
        if (profile > 0 && (fewest == 0 || face + profile < fewest)) {
            fewest = face + profile;
            cells[FACE] = face;
            cells[PROFILE] = profile;
        }
    }
    return fewest;
}

/* The grid for the tolerance, or for a limit that is about as low as a table can have. */
static void find_cells(const gm_modifications *of, const int base[2], double tolerance,
                       int cells[2]) {
    double kept = tolerance;
    /* At the latest a limit above all amounts is kept, by the grid that is given. */
    while (!divide_limit(of, base, kept, cells)) {
        kept *= 4.0;
    }
    double missed = 0.25 * kept;
    for (int halving = 0; kept > tolerance && halving < 3; ++halving) {
        const double limit = sqrt(missed * kept);
        if (divide_limit(of, base, limit, cells)) {
            kept = limit;
        } else {
            missed = limit;
        }
    }
}

/* What the operations at a node and in the table may lose beside the bound (m). */
static double rounding_of(const gm_modifications *of) {
    double sum = 0.0;
    for (int k = 0; k < of->count; ++k) {
        const double face = range_share(of, &of->list[k], FACE);
        const double profile = range_share(of, &of->list[k], PROFILE);
        const double steepness =
            1.0 + (face > 0.0 ? 1.0 / face : 0.0) + (profile > 0.0 ? 1.0 / profile : 0.0);
        sum += fabs(of->list[k].amount) * steepness;
    }
    return 16.0 * DBL_EPSILON * sum;
}

int gm_modifications_grid_find(const gm_modifications *modifications, int face_nodes,
                               int profile_nodes, double tolerance, gm_modifications_grid *grid) {
    if (grid == NULL) {
        return GM_ERR_NULL;
    }
    grid->face_nodes = grid->profile_nodes = 0;
    grid->error = gmi_nan();
    const int status = status_of(modifications);
    if (status != GM_OK) {
        return status;
    }
    if (!are_nodes(face_nodes) || !are_nodes(profile_nodes) || !gmi_is_finite(tolerance) ||
        !(tolerance >= SMALLEST_TOLERANCE)) {
        return GM_ERR_PARAMETER;
    }

    const int base[2] = {face_nodes - 1, profile_nodes - 1};
    int cells[2] = {base[FACE], base[PROFILE]};
    find_cells(modifications, base, tolerance, cells);
    grid->face_nodes = cells[FACE] + 1;
    grid->profile_nodes = cells[PROFILE] + 1;
    grid->error = axis_error(modifications, FACE, cells[FACE]) +
                  axis_error(modifications, PROFILE, cells[PROFILE]) + rounding_of(modifications);
    return GM_OK;
}
