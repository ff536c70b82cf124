/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file trace_surface.h
 * The surface that the traces of one flank span.
 */
#ifndef GEARMESH_TRACE_SURFACE_H
#define GEARMESH_TRACE_SURFACE_H

#include "gearmesh/gearmesh_io.h"
#include "trace.h"

/** Most traces of one kind on one flank: what a surface costs grows with their square. */
#define GMI_MAX_TRACES 100

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

#endif /* GEARMESH_TRACE_SURFACE_H */
