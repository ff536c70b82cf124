/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file trace_values.h
 * Slope, form and total deviation of one trace, that is of a polygon over t = 0 .. 1 with uniform nodes.
 */
#ifndef GEARMESH_TRACE_VALUES_H
#define GEARMESH_TRACE_VALUES_H

#include "gearmesh/gearmesh_io.h"

/** Where a trace is evaluated, and what becomes of the rest. */
typedef struct gmi_range {
    double from;        /**< 0 <= from < to <= 1 */
    double to;          /**< end */
    int material_below; /**< excess of material below `from` counts */
    int material_above; /**< excess of material above `to` counts */
    int extrapolate;    /**< slope over 0 .. 1 instead of from .. to */
} gmi_range;

typedef struct gmi_trace_values {
    double slope; /**< rise of the mean line, signed */
    double form;  /**< range of the deviations from the mean line */
    double total; /**< range of the deviations from the design, which is 0 */
} gmi_trace_values;

/** The mean line of least squares: level + gradient * t. */
typedef struct gmi_line {
    double level;
    double gradient;
} gmi_line;

/** Exact for the polygon, not only for its nodes. */
gmi_line gmi_trace_mean_line(const double *trace, int nodes, const gmi_range *range);

gmi_trace_values gmi_trace_evaluate(const double *trace, int nodes, const gmi_range *range);

/** Checks options and makes the ranges of profile (at [0]) and helix (at [1]) from them. */
int gmi_trace_ranges(gmi_range ranges[2], const gm_pair *pair, const gm_gear *gear,
                     const gm_quality_options *options, gm_io_error *error);

/** The trace along t2 at t1 = 0.5 of a table [face_nodes][profile_nodes], times a factor. */
void gmi_profile_trace(double *trace, const double *table, int face_nodes, int profile_nodes,
                       double factor);

/** The trace along t1 at t2 = 0.5. */
void gmi_helix_trace(double *trace, const double *table, int face_nodes, int profile_nodes,
                     double factor);

#endif /* GEARMESH_TRACE_VALUES_H */
