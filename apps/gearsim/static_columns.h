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
} static_position;

typedef struct static_column {
    const char *name;     /* with its unit */
    int of_several_loads; /* there only if the analysis has several loads */
    int is_of_wrench;     /* takes the wrench */
    double (*value)(const static_position *position);
} static_column;

extern const static_column static_columns[];
extern const int static_column_count; /* at most COLUMNS_MAX */

/* Those of the analysis. */
column_names static_column_names(const config *conf);

/* Whether this one of static_columns is there. */
int static_column_is_there(const config *conf, int column);

#endif
