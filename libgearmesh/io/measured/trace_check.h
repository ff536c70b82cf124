/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file trace_check.h
 * What makes traces implausible: spikes, other units, the sign the wrong way round.
 */
#ifndef GEARMESH_TRACE_CHECK_H
#define GEARMESH_TRACE_CHECK_H

#include "gearmesh/gearmesh_io.h"
#include "trace.h"

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

#endif /* GEARMESH_TRACE_CHECK_H */
