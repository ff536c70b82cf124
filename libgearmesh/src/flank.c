/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Flank tables in memory of the caller, prepared for walking along a contact line: beside each node value
 * stand its second differences along both grid directions, which are what slope and curvature of the
 * bilinear surface change by where the line crosses a grid line. They are zero at the borders.
 */
#include "flank.h"

#include "internal.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

static int check_side(int tables, int face_nodes, int profile_nodes, int teeth) {
    if (tables < 0 || tables > teeth + 1) {
        return 0;
    }
    return tables == 0 ||
           (face_nodes >= GMI_SMALLEST_NODES && face_nodes <= GMI_LARGEST_NODES &&
            profile_nodes >= GMI_SMALLEST_NODES && profile_nodes <= GMI_LARGEST_NODES);
}

static int check_params(const gm_flanks_params *p) {
    return p->teeth >= GMI_SMALLEST_TEETH && p->teeth <= GMI_LARGEST_TEETH &&
           check_side(p->drive_tables, p->drive_face_nodes, p->drive_profile_nodes, p->teeth) &&
           check_side(p->coast_tables, p->coast_face_nodes, p->coast_profile_nodes, p->teeth);
}

/* Doubles of one side: the tables, their peaks, the pitch deviations. 64 bits hold the largest. */
static uint64_t side_doubles(int tables, int face_nodes, int profile_nodes, int teeth) {
    const uint64_t table =
        tables == 0 ? 0 : (uint64_t)face_nodes * (uint64_t)profile_nodes * GMI_NODE_DOUBLES;
    return (uint64_t)tables * (table + 1) + (uint64_t)teeth;
}

static uint64_t all_doubles(const gm_flanks_params *p) {
    return side_doubles(p->drive_tables, p->drive_face_nodes, p->drive_profile_nodes, p->teeth) +
           side_doubles(p->coast_tables, p->coast_face_nodes, p->coast_profile_nodes, p->teeth);
}

/* The object itself, the doubles of both sides, and tooth -> table of both sides. */
static uint64_t all_bytes(const gm_flanks_params *p) {
    return sizeof(gm_flanks) + all_doubles(p) * sizeof(double) +
           2 * (uint64_t)p->teeth * sizeof(int);
}

size_t gm_flanks_size(const gm_flanks_params *params) {
    if (params == NULL || !check_params(params)) {
        return 0;
    }
    const uint64_t bytes = all_bytes(params);
    return bytes <= SIZE_MAX / 2 ? (size_t)bytes : 0;
}

/* Lays one side, all zero, out from `doubles` and `ints` on and returns the next free double. */
static double *side_init(gmi_tables *side, int tables, int face_nodes, int profile_nodes, int teeth,
                         double *doubles, int *ints) {
    side->face_nodes = tables == 0 ? 0 : face_nodes;
    side->profile_nodes = tables == 0 ? 0 : profile_nodes;
    side->capacity = tables;
    side->table_doubles = (size_t)side->face_nodes * (size_t)side->profile_nodes * GMI_NODE_DOUBLES;

    /* Tables, their peaks and the pitch deviations one behind the other. */
    side->values = doubles;
    doubles += (size_t)tables * side->table_doubles;
    side->table_peak = doubles;
    doubles += tables;
    side->pitch = doubles;
    doubles += teeth;

    /* All teeth ideal. */
    side->table = ints;
    for (int tooth = 0; tooth < teeth; ++tooth) {
        side->pitch[tooth] = 0.0;
        side->table[tooth] = -1;
    }
    return doubles;
}

int gm_flanks_init(gm_flanks **flanks, const gm_flanks_params *params, void *memory,
                   size_t memory_size) {
    if (flanks == NULL) {
        return GM_ERR_NULL;
    }
    *flanks = NULL;
    if (params == NULL || memory == NULL) {
        return GM_ERR_NULL;
    }
    const size_t needed = gm_flanks_size(params);
    if (needed == 0) {
        return GM_ERR_PARAMETER;
    }
    if (memory_size < needed || !gmi_is_aligned(memory)) {
        return GM_ERR_MEMORY;
    }

    /* The object, then all doubles, then all integers. */
    gm_flanks *made = (gm_flanks *)memory;
    double *doubles = (double *)(made + 1);
    int *ints = (int *)(doubles + all_doubles(params));
    memset(made, 0, sizeof *made);
    made->teeth = params->teeth;
    doubles = side_init(&made->side[GM_DRIVE], params->drive_tables, params->drive_face_nodes,
                        params->drive_profile_nodes, params->teeth, doubles, ints);
    (void)side_init(&made->side[GM_COAST], params->coast_tables, params->coast_face_nodes,
                    params->coast_profile_nodes, params->teeth, doubles, ints + params->teeth);
    *flanks = made;
    return GM_OK;
}

int gm_flanks_teeth(const gm_flanks *flanks) {
    return flanks == NULL ? 0 : flanks->teeth;
}

static int is_side(int side) {
    return side == GM_DRIVE || side == GM_COAST;
}

double gm_flanks_peak(const gm_flanks *flanks, int side) {
    if (!is_side(side)) {
        return gmi_nan();
    }
    return flanks == NULL ? 0.0 : flanks->side[side].peak;
}

/* Steepest rise of a table over one cell along the profile, where it is linear (m). */
static double steepest_cell(const gmi_tables *tables) {
    const size_t lines = (size_t)tables->count * (size_t)tables->face_nodes;
    const size_t nodes = (size_t)tables->profile_nodes;
    double steepest = 0.0;
    for (size_t line = 0; line < lines; ++line) {
        const double *node = tables->values + line * nodes * GMI_NODE_DOUBLES;
        for (size_t k = 1; k < nodes; ++k) {
            const double rise = node[k * GMI_NODE_DOUBLES] - node[(k - 1) * GMI_NODE_DOUBLES];
            steepest = fmax(steepest, fabs(rise));
        }
    }
    return steepest;
}

double gm_flanks_profile_slope(const gm_flanks *flanks, int side) {
    if (!is_side(side)) {
        return gmi_nan();
    }
    if (flanks == NULL) {
        return 0.0;
    }

    /* Cells are 1 / (nodes - 1) long in t2; each ramp may add all of its slope. */
    const gmi_tables *tables = &flanks->side[side];
    double slope = 0.0;
    if (tables->count > 0) {
        slope = steepest_cell(tables) * (double)(tables->profile_nodes - 1);
    }
    for (int k = 0; k < tables->ramp_count; ++k) {
        slope += fabs(tables->ramps[k].per_t2);
    }
    return slope;
}

/* Most that the ramps of a flank take off: at one of its corners, as each is a plane above 0. */
static double depth_of_ramps(const gmi_tables *tables) {
    double depth = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        const double t1 = (double)(corner & 1), t2 = (double)(corner >> 1);
        double taken = 0.0;
        for (int k = 0; k < tables->ramp_count; ++k) {
            const gm_flank_ramp *ramp = &tables->ramps[k];
            taken += fmax(ramp->offset + ramp->per_t1 * t1 + ramp->per_t2 * t2, 0.0);
        }
        depth = fmax(depth, taken);
    }
    return depth;
}

/* From the highest to the lowest node of a table, the deepest of all teeth. */
static double depth_of_tables(const gmi_tables *tables) {
    const size_t nodes = (size_t)tables->face_nodes * (size_t)tables->profile_nodes;
    double depth = 0.0;
    for (int table = 0; table < tables->count; ++table) {
        const double *node = tables->values + (size_t)table * nodes * GMI_NODE_DOUBLES;
        for (size_t k = 0; k < nodes; ++k, node += GMI_NODE_DOUBLES) {
            depth = fmax(depth, tables->table_peak[table] - node[GMI_NODE_VALUE]);
        }
    }
    return depth;
}

double gmi_tables_depth(const gmi_tables *tables) {
    return tables == NULL ? 0.0 : depth_of_ramps(tables) + depth_of_tables(tables);
}

double gm_flanks_depth(const gm_flanks *flanks, int side) {
    return is_side(side) ? gmi_tables_depth(gmi_flanks_side(flanks, side)) : gmi_nan();
}

static gmi_tables *side_of(gm_flanks *flanks, int side) {
    return is_side(side) ? &flanks->side[side] : NULL;
}

/* Most material of one tooth: its highest node (bilinear surfaces peak at nodes) and its pitch. */
static double tooth_peak(const gmi_tables *side, int tooth) {
    const int table = side->table[tooth];
    return side->pitch[tooth] + (table < 0 ? 0.0 : side->table_peak[table]);
}

static void find_peak(const gm_flanks *flanks, gmi_tables *side) {
    side->peak = tooth_peak(side, 0);
    for (int tooth = 1; tooth < flanks->teeth; ++tooth) {
        const double peak = tooth_peak(side, tooth);
        if (peak > side->peak) {
            side->peak = peak;
        }
    }
}

/* After a change of one tooth, or of all. Looks at all teeth only if the highest one may have come down. */
static void update_peak(const gm_flanks *flanks, gmi_tables *side, int tooth, double before) {
    const double now = tooth == GM_ALL_TEETH ? before : tooth_peak(side, tooth);
    if (tooth == GM_ALL_TEETH || (before == side->peak && now < before)) {
        find_peak(flanks, side);
    } else if (now > side->peak) {
        side->peak = now;
    }
}

/* Negated elsewhere, so that NaN is caught. */
static int is_deviation(double deviation) {
    return fabs(deviation) <= GMI_LARGEST_DEVIATION;
}

static int check_deviation(const gmi_tables *side, const double *deviation, double factor) {
    const size_t nodes = (size_t)side->face_nodes * (size_t)side->profile_nodes;
    for (size_t k = 0; k < nodes; ++k) {
        if (!is_deviation(deviation[k] * factor)) {
            return 0;
        }
    }
    return 1;
}

/* w[k-1] - 2 w[k] + w[k+1] with nodes `stride` doubles apart; 0 at the ends of the grid. */
static double second_difference(const double *node, size_t stride, int k, int count) {
    return k == 0 || k == count - 1 ? 0.0 : (node[stride] - *node) - (*node - *(node - stride));
}

/* The lowest and the highest node of the window of a node. */
static gmi_bounds window_bounds(const gmi_tables *side, const double *node, int face, int profile) {
    const ptrdiff_t row = (ptrdiff_t)side->profile_nodes * GMI_NODE_DOUBLES;
    const int behind = side->profile_nodes - 1 - profile;
    const int from = profile < GMI_WINDOW_PROFILE ? -profile : -GMI_WINDOW_PROFILE;
    const int to = behind < GMI_WINDOW_PROFILE ? behind : GMI_WINDOW_PROFILE;
    double lowest = *node, highest = *node;
    for (int k = 0; k <= GMI_WINDOW_FACE && face + k < side->face_nodes; ++k) {
        for (int l = from; l <= to; ++l) {
            const double value = node[k * row + l * GMI_NODE_DOUBLES];
            lowest = gmi_smaller(lowest, value);
            highest = gmi_larger(highest, value);
        }
    }

    /* Outwards by four units in the last place of a float, and by what is not 0. */
    const gmi_bounds bounds = {(float)(lowest - (0x1p-22 * fabs(lowest) + 1e-30)),
                               (float)(highest + (0x1p-22 * fabs(highest) + 1e-30))};
    return bounds;
}

static void fill_table(const gmi_tables *side, double *table, const double *deviation,
                       double factor) {
    const size_t nodes = (size_t)side->face_nodes * (size_t)side->profile_nodes;
    const size_t row = (size_t)side->profile_nodes * GMI_NODE_DOUBLES;

    /* Values first: differences look at their neighbours. */
    for (size_t k = 0; k < nodes; ++k) {
        table[k * GMI_NODE_DOUBLES] = deviation[k] * factor;
    }

    for (int face = 0; face < side->face_nodes; ++face) {
        for (int profile = 0; profile < side->profile_nodes; ++profile) {
            double *node = table + (size_t)face * row + (size_t)profile * GMI_NODE_DOUBLES;
            node[GMI_NODE_FACE] = second_difference(node, row, face, side->face_nodes);
            node[GMI_NODE_PROFILE] =
                second_difference(node, GMI_NODE_DOUBLES, profile, side->profile_nodes);
            const gmi_bounds bounds = window_bounds(side, node, face, profile);
            memcpy(node + GMI_NODE_BOUNDS, &bounds, sizeof bounds);
        }
    }
}

static double table_maximum(const double *table, size_t doubles) {
    double maximum = table[0];
    for (size_t k = GMI_NODE_DOUBLES; k < doubles; k += GMI_NODE_DOUBLES) {
        if (table[k] > maximum) {
            maximum = table[k];
        }
    }
    return maximum;
}

int gm_flanks_set_table(gm_flanks *flanks, int side, int tooth, const double *deviation,
                        double factor) {
    if (flanks == NULL || deviation == NULL) {
        return GM_ERR_NULL;
    }
    gmi_tables *tables = side_of(flanks, side);
    if (tables == NULL || tooth < GM_ALL_TEETH || tooth >= flanks->teeth) {
        return GM_ERR_TOOTH;
    }
    if (tables->count >= tables->capacity) {
        return GM_ERR_MEMORY;
    }
    if (!check_deviation(tables, deviation, factor)) {
        return GM_ERR_DEVIATION;
    }

    /* The next place, prepared for the walk along a line. */
    const int place = tables->count++;
    double *table = tables->values + (size_t)place * tables->table_doubles;
    fill_table(tables, table, deviation, factor);
    tables->table_peak[place] = table_maximum(table, tables->table_doubles);

    /* Hand it to its tooth, or to all. */
    const double before = tooth == GM_ALL_TEETH ? 0.0 : tooth_peak(tables, tooth);
    if (tooth != GM_ALL_TEETH) {
        tables->table[tooth] = place;
    } else {
        for (int k = 0; k < flanks->teeth; ++k) {
            tables->table[k] = place;
        }
    }
    update_peak(flanks, tables, tooth, before);
    return GM_OK;
}

int gm_flanks_set_pitch(gm_flanks *flanks, int side, int tooth, double deviation) {
    if (flanks == NULL) {
        return GM_ERR_NULL;
    }
    gmi_tables *tables = side_of(flanks, side);
    if (tables == NULL || tooth < GM_ALL_TEETH || tooth >= flanks->teeth) {
        return GM_ERR_TOOTH;
    }
    if (!is_deviation(deviation)) {
        return GM_ERR_DEVIATION;
    }

    const double before = tooth == GM_ALL_TEETH ? 0.0 : tooth_peak(tables, tooth);
    if (tooth != GM_ALL_TEETH) {
        tables->pitch[tooth] = deviation;
    } else {
        for (int k = 0; k < flanks->teeth; ++k) {
            tables->pitch[k] = deviation;
        }
    }
    update_peak(flanks, tables, tooth, before);
    return GM_OK;
}

int gm_flanks_set_ramps(gm_flanks *flanks, int side, const gm_flank_ramp *ramps, int count,
                        double factor) {
    if (flanks == NULL || (ramps == NULL && count > 0)) {
        return GM_ERR_NULL;
    }
    gmi_tables *tables = side_of(flanks, side);
    if (tables == NULL) {
        return GM_ERR_TOOTH;
    }
    if (count < 0 || count > GM_FLANK_RAMPS_MAX || !(factor > 0.0)) {
        return GM_ERR_PARAMETER;
    }

    /* All of them are checked before one is taken. */
    gm_flank_ramp scaled[GM_FLANK_RAMPS_MAX];
    for (int k = 0; k < count; ++k) {
        const gm_flank_ramp ramp = {factor * ramps[k].offset, factor * ramps[k].per_t1,
                                    factor * ramps[k].per_t2};
        if (!(fabs(ramp.offset) <= GMI_LARGEST_RAMP && fabs(ramp.per_t1) <= GMI_LARGEST_RAMP &&
              fabs(ramp.per_t2) <= GMI_LARGEST_RAMP)) {
            return GM_ERR_DEVIATION;
        }
        scaled[k] = ramp;
    }

    memcpy(tables->ramps, scaled, (size_t)count * sizeof scaled[0]);
    tables->ramp_count = count;
    if (tables->capacity == 0) { /* places on the flank are then in t1, t2 */
        tables->face_nodes = tables->profile_nodes = count > 0 ? 2 : 0;
    }
    return GM_OK;
}
