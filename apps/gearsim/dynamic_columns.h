/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The columns of a dynamic run, one row each: name, what it takes, and how it is computed. A new column is a new row.
 */
#ifndef GEARSIM_DYNAMIC_COLUMNS_H
#define GEARSIM_DYNAMIC_COLUMNS_H

#include "columns.h"
#include "model.h"

/* What is known at a time of the run. */
typedef struct dynamic_sample {
    const gear_model *model;
    double time; /* s */
    gear_motion motion;
    gm_mesh_result mesh;     /* only where some column asked for needs it */
    int pairs;               /* likewise, that touch */
    double apex;             /* likewise, float of a double-helical pinion (m) */
    double mean_force;       /* about the time, only where samples are filtered (N) */
    double mean_load;        /* likewise (N m) */
    double mean_penetration; /* likewise (m) */
    double mean_rate;        /* likewise (m/s) */
} dynamic_sample;

/* What a column takes; the further down, the more time. */
enum column_need {
    NEEDS_TIME, /* alone */
    NEEDS_PINION, /* its angle and speed at the time, which a prescribed speed tells without the solver */
    NEEDS_MOTION, /* all angles and speeds, and x */
    NEEDS_PAIRS,  /* and how many pairs touch */
    NEEDS_FORCE,  /* that of the mesh */
    NEEDS_MESH,   /* and the penetration */
    NEEDS_WRENCH, /* and where they touch */
    NEEDS_ENERGY  /* and what is stored there */
};

typedef struct dynamic_column {
    const char *name; /* with its unit */
    int is_filtered;  /* by the low-pass of output.oversampling */
    enum column_need need;
    double (*value)(const dynamic_sample *sample);

    /* In place of the value where samples are filtered: a mean about the time, which needs no mesh. NULL: none. */
    double (*mean)(const dynamic_sample *sample);
} dynamic_column;

extern const dynamic_column dynamic_columns[];
extern const int dynamic_column_count; /* at most COLUMNS_MAX */

/* Some belong to certain gears alone. */
int dynamic_column_is_there(const config *conf, int column);

/* Those of the gears, in the order of dynamic_columns. */
column_names dynamic_column_names(const config *conf);

#endif
