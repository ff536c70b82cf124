/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The deviations of the tooth flanks of one gear: views over the caller's memory. */
#ifndef GEARMESH_FLANK_H
#define GEARMESH_FLANK_H

#include "internal.h"

/* One side (drive or coast) of all teeth of a gear: views over the caller's memory, and ramps. */
typedef struct gmi_tables {
    int face_nodes;       /* grid lines along t1; without tables 0, or 2 if there are ramps */
    int profile_nodes;    /* grid lines along t2; likewise */
    int capacity;         /* table places */
    int count;            /* table places taken */
    double peak;          /* most material of any tooth, pitch included, before ramps (m) */
    double *values;       /* [capacity][face_nodes][profile_nodes][GMI_NODE_DOUBLES] (m) */
    size_t table_doubles; /* of one table; 0 without */
    double *table_peak;   /* [capacity] largest node value (m) */
    double *pitch;        /* [teeth] transverse pitch deviation, > 0 material added (m) */
    int *table;           /* [teeth] table of a tooth, -1 = ideal */
    int ramp_count;       /* 0 .. GM_FLANK_RAMPS_MAX */
    gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX]; /* of all teeth, in the transverse section */
} gmi_tables;

struct gm_flanks {
    int teeth;
    gmi_tables side[2]; /* GM_DRIVE, GM_COAST */
};

/* Doubles per node of a table: value, second difference along t1, along t2, and in place of one gmi_bounds. */
enum gmi_node {
    GMI_NODE_VALUE,
    GMI_NODE_FACE,
    GMI_NODE_PROFILE,
    GMI_NODE_BOUNDS,
    GMI_NODE_DOUBLES
};

/*
 * Lowest and highest node of a window: from its own node on so many cells across the face, and so many to either side along
 * the profile, as far as the table goes (m).
 */
enum { GMI_WINDOW_FACE = 2, GMI_WINDOW_PROFILE = 2 };
typedef struct gmi_bounds {
    float lowest, highest; /* rounded outwards by more than an evaluation rounds */
} gmi_bounds;

typedef struct gmi_flank {
    const double *values; /* [face_nodes][profile_nodes][4], NULL = no table */
    double pitch;         /* (m) */
    double peak;          /* most material, pitch included (m) */
} gmi_flank;

/* NULL = ideal. */
static inline const gmi_tables *gmi_flanks_side(const gm_flanks *flanks, int side) {
    return flanks == NULL ? NULL : &flanks->side[side];
}

static inline gmi_flank gmi_flank_of(const gmi_tables *tables, int tooth) {
    gmi_flank flank = {NULL, 0.0, 0.0};
    if (tables == NULL) {
        return flank;
    }
    const int table = tables->table[tooth];
    flank.pitch = tables->pitch[tooth];
    flank.peak = flank.pitch;
    if (table >= 0) {
        flank.values = tables->values + (size_t)table * tables->table_doubles;
        flank.peak += tables->table_peak[table];
    }
    return flank;
}

/* What gm_flanks_depth() says of this side; NULL = ideal. */
double gmi_tables_depth(const gmi_tables *tables);

int gmi_check_flanks(const gm_pair *pair, const gm_flanks *pinion_flanks,
                     const gm_flanks *wheel_flanks);

#endif
