/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file flank_design.h
 * Designed modifications as ramps and a table, and what becomes of a file's table when that is added to it.
 */
#ifndef GEARMESH_FLANK_DESIGN_H
#define GEARMESH_FLANK_DESIGN_H

#include "gearmesh/gearmesh_io.h"

/** The design of one side of all teeth. All zero = none. */
typedef struct gmi_design {
    gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX]; /**< linear reliefs, along the surface normal */
    int ramp_count;
    int file_nodes[2]; /**< grid of the file's tables, along t1 and t2; 2 x 2 if there is no file */
    int nodes[2];      /**< grid of the design, which holds all nodes of the file's */
    double *values;    /**< [nodes[0]][nodes[1]] what ramps do not hold (m); NULL = nothing */
    double error;      /**< bound of the error of the table (m) */
} gmi_design;

/**
 * Finds ramps and grid and computes the table; free it with gmi_design_free() whatever this returns.
 *
 * @param[in] modifications  NULL or none in its list: no design
 * @param[in] deviations     whose grid is to be kept; NULL = no file
 */
int gmi_design_make(gmi_design *design, const gm_modifications *modifications,
                    const gm_deviations *deviations, double tolerance, gm_io_error *error);

/**
 * Table of the design plus one of the file, between whose nodes it is bilinear.
 *
 * @param[in]  deviation  [file_nodes[0]][file_nodes[1]]; NULL = zero
 * @param[out] table      [nodes[0]][nodes[1]]
 */
void gmi_design_table(const gmi_design *design, const double *deviation, double *table);

void gmi_design_free(gmi_design *design);

#endif /* GEARMESH_FLANK_DESIGN_H */
