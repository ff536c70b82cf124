/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file measured_trace.h
 * A measured trace in the gear's own terms (tooth, side, t1, t2), what makes it doubtful, and the surface that a few
 * of them span.
 */
#ifndef GEARMESH_MEASURED_TRACE_H
#define GEARMESH_MEASURED_TRACE_H

#include "gearmesh/gearmesh_io.h"

/** Most traces of one kind on one flank: what a surface costs grows with their square. */
#define GMI_MAX_TRACES 100

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

/**
 * Finds points that stand far off their neighbours and removes them, or makes the first one an error.
 *
 * @param[in] work  [3 * count] room
 */
int gmi_remove_spikes(gmi_measured *trace, const gm_traces_options *options, double *work,
                      gm_traces_report *report, gm_io_error *error);

/** Refuses deviations in other units, and signs the wrong way round. Fills the report's judgement. */
int gmi_judge_deviations(const gmi_measured *traces, int count, const gm_pair *pair,
                         const gm_traces_options *options, gm_traces_report *report,
                         gm_io_error *error);

/** Value of a table at t1, t2 in 0 .. 1, bilinear between the nodes. */
double gmi_table_at(const double *table, int face_nodes, int profile_nodes, double t1, double t2);

/**
 * The surface of one flank that interpolates its traces, zero at t1 = 0.5, t2 = `t2_zero` (of the table).
 *
 * @param[out]    table    [face_nodes][profile_nodes] (m)
 * @param[in]     traces   [profiles + helices], the profiles first, each kind rising in `at`
 * @param[in,out] report   crossing error
 * @param[out]    error    of GM_IO_ERR_FORMAT or GM_IO_ERR_MEMORY
 */
int gmi_surface_make(double *table, const gm_traces_options *options, const gmi_measured *traces,
                     int profiles, int helices, double t2_zero, gm_traces_report *report,
                     gm_io_error *error);

#endif /* GEARMESH_MEASURED_TRACE_H */
