/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file trace_map.h
 * From the machine's terms to the gear's.
 */
#ifndef GEARMESH_TRACE_MAP_H
#define GEARMESH_TRACE_MAP_H

#include "gearmesh/gearmesh_io.h"
#include "trace.h"

/** Most of a flank that a trace may leave out at an end, whatever the options say. */
#define GMI_MOST_HELD 0.45

/** Traces on their way. What is to be mapped is filled in by the caller, measured is filled by gmi_traces_map(). */
typedef struct gmi_mapping {
    const gm_measurement *measurement;
    const gm_pair *pair;
    const gm_gear *gear;
    int wheel; /**< 0 = the gear is the pinion */
    const gm_traces_options *options;
    gm_traces_report *report;
    gm_io_error *error;
    gmi_measured *measured; /**< [traces->count] in the order of the traces */
    double *points;         /**< what they live in */
    double *work;           /**< [4 * points of the longest] */
} gmi_mapping;

/** Maps all traces and takes out their spikes. Needs gmi_mapping_free() whatever it returns. */
int gmi_traces_map(gmi_mapping *map, const gm_traces *traces);

void gmi_mapping_free(gmi_mapping *map);

/** t2 of a roll length (m), not limited to 0 .. 1. */
double gmi_profile_place(const gm_gear *gear, double roll_length);

#endif /* GEARMESH_TRACE_MAP_H */
