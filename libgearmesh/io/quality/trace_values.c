/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Mean line, slope, form and total deviation of one trace. */

#include "trace_values.h"

#include <math.h>

#include "files/io_error.h"

/* Value of the polygon at t. */
static double trace_at(const double *trace, int nodes, double t) {
    const double place = t * (nodes - 1);
    const int before = place < nodes - 2 ? (int)place : nodes - 2;
    const double part = place - before;
    return trace[before] + part * (trace[before + 1] - trace[before]);
}

static double node_at(int node, int nodes) {
    return (double)node / (nodes - 1);
}

/* ---------------------------------------------------------------------------------------------
 * Mean line
 * ------------------------------------------------------------------------------------------- */

typedef struct moments {
    double sum;    /* integral of the trace */
    double moment; /* integral of the trace times distance from the middle */
} moments;

/* Adds a straight piece; Simpson's rule is exact for the quadratic under the second integral. */
static void add_piece(moments *of, double t0, double f0, double t1, double f1, double middle) {
    const double width = t1 - t0;
    const double f = 0.5 * (f0 + f1);
    const double t = 0.5 * (t0 + t1) - middle;
    of->sum += width * f;
    of->moment += width / 6.0 * (f0 * (t0 - middle) + 4.0 * f * t + f1 * (t1 - middle));
}

gmi_line gmi_trace_mean_line(const double *trace, int nodes, const gmi_range *range) {
    const double length = range->to - range->from;
    const double middle = 0.5 * (range->from + range->to);
    moments of = {0.0, 0.0};

    /* Piece by piece: from the begin of the range to its first node, from node to node, and to its end. */
    double t0 = range->from;
    double f0 = trace_at(trace, nodes, t0);
    for (int node = 1; node < nodes && node_at(node, nodes) < range->to; ++node) {
        const double t1 = node_at(node, nodes);
        if (t1 > t0) {
            add_piece(&of, t0, f0, t1, trace[node], middle);
            t0 = t1;
            f0 = trace[node];
        }
    }
    add_piece(&of, t0, f0, range->to, trace_at(trace, nodes, range->to), middle);
    /* The integral of (t - middle)^2 is length^3 / 12. */
    const double gradient = 12.0 * of.moment / (length * length * length);
    const gmi_line line = {of.sum / length - gradient * middle, gradient};
    return line;
}

/* ---------------------------------------------------------------------------------------------
 * Form and total
 * ------------------------------------------------------------------------------------------- */

typedef struct extremes {
    double low;
    double high;
} extremes;

static void add_high(extremes *of, double value) {
    of->high = value > of->high ? value : of->high;
}

static void add_both(extremes *of, double value) {
    of->low = value < of->low ? value : of->low;
    add_high(of, value);
}

/* Range of the deviations from a line. Those of a polygon are largest and least at corners and ends. */
static double range_from(const double *trace, int nodes, const gmi_range *range, gmi_line line) {
    extremes of = {(double)INFINITY, -(double)INFINITY};
    const double ends[2] = {range->from, range->to};
    for (int end = 0; end < 2; ++end) {
        const double t = ends[end];
        add_both(&of, trace_at(trace, nodes, t) - (line.level + line.gradient * t));
    }

    /* Corners within the range count both ways; behind it only material that sticks out, if at all. */
    for (int node = 0; node < nodes; ++node) {
        const double t = node_at(node, nodes);
        const double value = trace[node] - (line.level + line.gradient * t);
        if (t >= range->from && t <= range->to) {
            add_both(&of, value);
        } else if (t < range->from ? range->material_below : range->material_above) {
            add_high(&of, value);
        }
    }
    return of.high - of.low;
}

gmi_trace_values gmi_trace_evaluate(const double *trace, int nodes, const gmi_range *range) {
    const gmi_line design = {0.0, 0.0};
    const gmi_line mean = gmi_trace_mean_line(trace, nodes, range);
    gmi_trace_values values;
    values.slope = mean.gradient * (range->extrapolate ? 1.0 : range->to - range->from);
    values.form = range_from(trace, nodes, range, mean);
    values.total = range_from(trace, nodes, range, design);
    return values;
}

/* ---------------------------------------------------------------------------------------------
 * Ranges and traces of a flank
 * ------------------------------------------------------------------------------------------- */

static double face_margin(const gm_pair *pair, const gm_gear *gear,
                          const gm_quality_options *options) {
    if (!isnan(options->face_margin)) {
        return options->face_margin;
    }
    const double module = pair->normal_module / gear->face_width;
    return module < 0.05 ? module : 0.05;
}

int gmi_trace_ranges(gmi_range ranges[2], const gm_pair *pair, const gm_gear *gear,
                     const gm_quality_options *options, gm_io_error *error) {
    const double margin = face_margin(pair, gear, options);
    if (!(options->profile_from >= 0.0 && options->profile_from < options->profile_to &&
          options->profile_to <= 1.0)) {
        return gmi_error_set(
            error, GM_IO_ERR_OPTION, 0,
            "the profile evaluation range must begin before it ends, within 0 to 1");
    }
    if (!(margin >= 0.0 && margin <= 0.45)) {
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "the face margin must be from 0 to 0.45 of the face width");
    }

    /* What sticks out below the profile range is the fillet: it does not count. */
    const gmi_range profile = {options->profile_from, options->profile_to, 0, options->end_material,
                               options->extrapolate};
    const gmi_range helix = {margin, 1.0 - margin, options->end_material, options->end_material,
                             options->extrapolate};
    ranges[0] = profile;
    ranges[1] = helix;
    return GM_IO_OK;
}

void gmi_profile_trace(double *trace, const double *table, int face_nodes, int profile_nodes,
                       double factor) {
    /* An even number of grid lines has none in the middle: halfway between two. */
    const double *low = table + (size_t)((face_nodes - 1) / 2) * (size_t)profile_nodes;
    const double *high = table + (size_t)(face_nodes / 2) * (size_t)profile_nodes;
    for (int node = 0; node < profile_nodes; ++node) {
        trace[node] = factor * 0.5 * (low[node] + high[node]);
    }
}

void gmi_helix_trace(double *trace, const double *table, int face_nodes, int profile_nodes,
                     double factor) {
    for (int node = 0; node < face_nodes; ++node) {
        const double *row = table + (size_t)node * (size_t)profile_nodes;
        trace[node] = factor * 0.5 * (row[(profile_nodes - 1) / 2] + row[profile_nodes / 2]);
    }
}
