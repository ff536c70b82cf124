/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file trace_fill.h
 * Stretches of a trace that were not measured but filled with one value, as 0, by the machine or on the way here.
 */
#ifndef GEARMESH_TRACE_FILL_H
#define GEARMESH_TRACE_FILL_H

#include "gearmesh/gearmesh_io.h"
#include "trace.h"

/**
 * Finds filled stretches and removes them, or makes the first one an error.
 *
 * @param[in] work  [3 * count] room
 */
int gmi_remove_filled(gmi_measured *trace, const gm_traces_options *options, double *work,
                      gm_traces_report *report, gm_io_error *error);

/** 1 if all points have exactly one value, as an ideal flank has, or one that was never touched. */
int gmi_is_constant(const gmi_measured *trace);

#endif /* GEARMESH_TRACE_FILL_H */
