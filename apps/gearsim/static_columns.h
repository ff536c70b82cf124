/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The columns of a static analysis, one row each: name and how it is computed. A new column is a new row.
 */
#ifndef GEARSIM_STATIC_COLUMNS_H
#define GEARSIM_STATIC_COLUMNS_H

#include "columns.h"
#include "gear_mesh.h"

/* What is known of a position in equilibrium. */
typedef struct static_position {
    const config *conf;
    const gear_mesh *gears;
    double pinion_angle; /* rad */
    double load;         /* N m */
    double offset;       /* x (m) */
    gm_mesh_result mesh; /* there */
    double apex;         /* float of a double-helical pinion there (m) */
    gm_line_loads faces; /* how the flanks are loaded */
} static_position;

/* When there is a column. */
enum static_column_use {
    ALWAYS,
    OF_SEVERAL_LOADS,
    OF_FLANKS, /* the simple model has none */
    OF_FRICTION,
    OF_DOUBLE_HELICAL
};

/* What a column takes from static_position that is only found where a column is asked for. */
enum static_column_taking {
    TAKES_NOTHING,
    TAKES_WRENCH,
    TAKES_ENERGY,
    TAKES_FACES,
    TAKES_WIDTH /* of elastic teeth the same; else it is known */
};

typedef struct static_column {
    const char *name;                 /* with its unit */
    enum static_column_use use;       /* of which analyses it is a column */
    enum static_column_taking taking; /* beyond the equilibrium */
    double (*value)(const static_position *position);
} static_column;

extern const static_column static_columns[];
extern const int static_column_count; /* at most COLUMNS_MAX */

/* Those of the analysis, in the order of static_columns, and behind them those of te_slopes.h that are asked for. */
column_names static_column_names(const config *conf);

/* Whether this one of static_columns is there. */
int static_column_is_there(const config *conf, int column);

#endif
