/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file trace.h
 * A measured trace in the gear's own terms: tooth, side, t1, t2.
 */
#ifndef GEARMESH_TRACE_H
#define GEARMESH_TRACE_H

#include "gearmesh/gearmesh_io.h"

/** A trace on the way into a table: a polygon. */
typedef struct gmi_measured {
    int tooth;  /**< 0 .. z - 1 */
    int side;   /**< GM_DRIVE or GM_COAST */
    int kind;   /**< enum gm_trace_kind */
    double at;  /**< where it lies: t1 of a profile, t2 of a helix */
    int turned; /**< its points run against those of the measurement */
    int count;  /**< points */
    double *t; /**< [count] rising: t2 along a profile, t1 along a helix; may reach beyond 0 .. 1 */
    double *value;        /**< [count] along the surface normal (m) */
    const gm_trace *from; /**< as it was measured */
} gmi_measured;

/** The polygon at t; beyond the ends the last value is held. */
double gmi_measured_at(const gmi_measured *trace, double t);

/** Line in the file where a trace begins; 0 = unknown. */
long gmi_measured_line(const gmi_measured *trace);

/** `the profile of tooth 3, flank left`, numbers and names as in the file. Returns name. */
#define GMI_TRACE_NAME_SIZE 80
const char *gmi_trace_name(char name[GMI_TRACE_NAME_SIZE], const gm_trace *trace);

#endif /* GEARMESH_TRACE_H */
