/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The deviation of one tooth flank along a line of contact. In grid units the line runs through the table as
 *     v1 = (face_nodes - 1) t1,     v2 = profile_origin + profile_rate t1,
 * and within a cell the bilinear surface is quadratic in t1 there. At a grid line only slope and curvature
 * change, by the second difference of the nodes across that line, interpolated along it. So value, slope and
 * curvature of the sum of both flanks are carried along the line and corrected at each crossing: exact, and
 * two node reads per crossing.
 */
#ifndef GEARMESH_TRACE_H
#define GEARMESH_TRACE_H

#include "internal.h"

/* Later than any crossing: t1 ends at 1. */
#define GMI_NO_CROSSING 2.0

/* Doubles per node: value, second difference along t1, along t2, padding. */
enum gmi_node { GMI_NODE_VALUE, GMI_NODE_FACE, GMI_NODE_PROFILE, GMI_NODE_DOUBLES = 4 };

/* A quadratic in t1, at the current t1: value, slope, half the second derivative. */
typedef struct gmi_quadratic {
    double value, slope, curvature;
} gmi_quadratic;

typedef struct gmi_trace {
    const double *cell;          /* corner node of the current cell with the lowest indices */
    int row;                     /* doubles from one face line to the next */
    int face, profile;           /* indices of that node */
    int last_face, last_profile; /* of the last cell */
    int step;                    /* +1 or -1: where v2 goes */
    double face_rate;            /* d v1 / d t1 */
    double face_spacing;         /* its inverse */
    double profile_origin, profile_rate, per_profile_rate;
    double next_face, next_profile; /* t1 of the next crossings */

    double profile_slope; /* d deviation / d v2 at the current t1 (m) */
    double mixed;         /* its rate of change with v1 (m) */
} gmi_trace;

static inline void gmi_trace_none(gmi_trace *trace) {
    trace->next_face = trace->next_profile = GMI_NO_CROSSING;
    trace->profile_slope = trace->mixed = 0.0;
    trace->face_rate = 0.0;
}

static inline void gmi_trace_schedule_face(gmi_trace *trace) {
    trace->next_face = trace->face < trace->last_face
                           ? (double)(trace->face + 1) * trace->face_spacing
                           : GMI_NO_CROSSING;
}

static inline void gmi_trace_schedule_profile(gmi_trace *trace) {
    const int line = trace->step > 0 ? trace->profile + 1 : trace->profile;
    trace->next_profile = line > 0 && line <= trace->last_profile && trace->profile_rate != 0.0
                              ? ((double)line - trace->profile_origin) * trace->per_profile_rate
                              : GMI_NO_CROSSING;
}

/* Index of the cell that holds v, clamped into the table against rounding at its rim. */
static inline int gmi_trace_cell(double v, int last) {
    const int cell = v > 0.0 ? (int)v : 0;
    return cell < last ? cell : last;
}

/*
 * Starts at t1 = from and adds the flank's deviation to `sum`. profile_origin and profile_rate: t2 of the line
 * at t1 = 0 and its rate.
 */
static inline void gmi_trace_begin(gmi_trace *trace, const gmi_flank *flank, double from,
                                   double t2_origin, double t2_rate, gmi_quadratic *sum) {
    const double profile_scale = (double)(flank->profile_nodes - 1);
    trace->face_rate = (double)(flank->face_nodes - 1);
    trace->face_spacing = 1.0 / trace->face_rate;
    trace->profile_origin = t2_origin * profile_scale;
    trace->profile_rate = t2_rate * profile_scale;
    trace->per_profile_rate = 1.0 / trace->profile_rate;
    trace->step = t2_rate > 0.0 ? 1 : -1;
    trace->last_face = flank->face_nodes - 2;
    trace->last_profile = flank->profile_nodes - 2;
    trace->row = flank->profile_nodes * GMI_NODE_DOUBLES;

    const double v1 = from * trace->face_rate;
    const double v2 = trace->profile_origin + from * trace->profile_rate;
    trace->face = gmi_trace_cell(v1, trace->last_face);
    trace->profile = gmi_trace_cell(v2, trace->last_profile);
    trace->cell = flank->values + (size_t)trace->face * (size_t)trace->row +
                  (size_t)trace->profile * GMI_NODE_DOUBLES;

    /* w = corner + along_face p + along_profile q + mixed p q with p, q in [0, 1] */
    const double p = v1 - (double)trace->face;
    const double q = v2 - (double)trace->profile;
    const double corner = trace->cell[0];
    const double next_on_profile = trace->cell[GMI_NODE_DOUBLES];
    const double next_on_face = trace->cell[trace->row];
    const double opposite = trace->cell[trace->row + GMI_NODE_DOUBLES];
    const double along_face = next_on_face - corner;
    const double along_profile = next_on_profile - corner;
    trace->mixed = (opposite - next_on_face) - along_profile;
    trace->profile_slope = along_profile + trace->mixed * p;
    sum->value += corner + along_face * p + trace->profile_slope * q;
    sum->slope += trace->face_rate * (along_face + trace->mixed * q) +
                  trace->profile_rate * trace->profile_slope;
    sum->curvature += trace->face_rate * trace->profile_rate * trace->mixed;

    gmi_trace_schedule_face(trace);
    gmi_trace_schedule_profile(trace);
}

/* Crosses the face line (constant t1) ahead. */
static inline void gmi_trace_cross_face(gmi_trace *trace, double t1, gmi_quadratic *sum) {
    trace->cell += trace->row;
    trace->face += 1;
    const double q = trace->profile_origin + t1 * trace->profile_rate - (double)trace->profile;
    const double near = trace->cell[GMI_NODE_FACE];
    const double change = trace->cell[GMI_NODE_DOUBLES + GMI_NODE_FACE] - near;
    sum->slope += trace->face_rate * (near + q * change);
    sum->curvature += trace->face_rate * trace->profile_rate * change;
    trace->mixed += change;
    gmi_trace_schedule_face(trace);
}

/* Crosses the profile line (constant t2) ahead, upwards or downwards. */
static inline void gmi_trace_cross_profile(gmi_trace *trace, double t1, gmi_quadratic *sum) {
    const double *line = trace->step > 0 ? trace->cell + GMI_NODE_DOUBLES : trace->cell;
    const double p = t1 * trace->face_rate - (double)trace->face;
    const double near = line[GMI_NODE_PROFILE];
    const double change = line[trace->row + GMI_NODE_PROFILE] - near;
    const double direction = (double)trace->step;
    const double slope_change = direction * (near + p * change);
    sum->slope += trace->profile_rate * slope_change;
    sum->curvature += trace->face_rate * trace->profile_rate * direction * change;
    trace->profile_slope += slope_change;
    trace->mixed += direction * change;
    trace->cell += trace->step * GMI_NODE_DOUBLES;
    trace->profile += trace->step;
    gmi_trace_schedule_profile(trace);
}

/* Slope across the profile after `length` further on. */
static inline double gmi_trace_profile_slope(const gmi_trace *trace, double length) {
    return trace->profile_slope + trace->mixed * trace->face_rate * length;
}

#endif
