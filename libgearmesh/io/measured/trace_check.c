/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* What makes traces implausible: spikes, other units, the sign the wrong way round. docs/measured-flanks.md */

#include "trace_check.h"

#include <math.h>

#include "files/io_error.h"
#include "files/number_text.h"
#include "measurement.h"
#include "robust.h"

/* ---------------------------------------------------------------------------------------------
 * Spikes
 * ------------------------------------------------------------------------------------------- */

/* Spikes are up to so many points wide. */
#define SPIKE_WIDTH 3

/* A point is a spike if it stands off by more than so many standard deviations of the trace's own roughness ... */
static const double spike_deviations = 8.0;
/* ... and by more than this (m). */
static const double spike_floor = 2e-6;

/* How far a point stands off the line between its neighbours `stride` points away. */
static double stand_off(const gmi_measured *trace, int k, int stride) {
    const double *t = trace->t;
    const double *value = trace->value;
    const double share = (t[k] - t[k - stride]) / (t[k + stride] - t[k - stride]);
    return value[k] - (value[k - stride] + share * (value[k + stride] - value[k - stride]));
}

static double smaller(double a, double b) {
    return a < b ? a : b;
}

/*
 * A lone point that is off by s is off its neighbours by s, and these off theirs by -s/2. A crest or a kink is
 * not: there the neighbours do not stand off the other way.
 */
static double spike_height(double before, double here, double after) {
    if (before * here >= 0.0 || after * here >= 0.0) {
        return 0.0;
    }
    return smaller(fabs(here), 2.0 * smaller(fabs(before), fabs(after)));
}

/* Marks the spikes that are `stride` points wide; work [2 * count]. */
static void mark_spikes(const gmi_measured *trace, int stride, double *marks, double *work) {
    const int count = trace->count - 2 * stride; /* points with two neighbours */
    double *off = work;
    if (count <= 2 * stride) {
        return;
    }
    for (int k = 0; k < count; ++k) {
        off[k] = stand_off(trace, k + stride, stride);
    }
    /* A few points do not say well how rough the trace is. */
    double limit = spike_deviations * (1.0 + 10.0 / count) * gmi_spread(off, count, work + count);
    limit = limit > spike_floor ? limit : spike_floor;

    for (int k = stride; k < count - stride; ++k) {
        const double height = spike_height(off[k - stride], off[k], off[k + stride]);
        if (height > limit && height > marks[k + stride]) {
            marks[k + stride] = height;
        }
    }
}

static int fail_spike(const gmi_measured *trace, int k, double height, gm_io_error *error) {
    const gm_trace *from = trace->from;
    const int index = trace->turned ? from->count - 1 - k : k;
    char name[GMI_TRACE_NAME_SIZE];
    char text[GMI_NUMBER_SIZE];
    gmi_error_option(error, "remove_spikes");
    return gmi_error_set(error, GM_IO_ERR_FORMAT, from->line != NULL ? from->line[index] : 0,
                         "%s: must be without dust (got a spike of %s um here; spikes can be left "
                         "out if that is asked for)",
                         gmi_trace_name(name, from), gmi_number_text(text, height, 6, 3));
}

int gmi_remove_spikes(gmi_measured *trace, const gm_traces_options *options, double *work,
                      gm_traces_report *report, gm_io_error *error) {
    double *marks = work;
    for (int k = 0; k < trace->count; ++k) {
        marks[k] = 0.0;
    }

    /* Spikes of one, two and three points. */
    for (int stride = 1; stride <= SPIKE_WIDTH; ++stride) {
        mark_spikes(trace, stride, marks, work + trace->count);
    }

    /* Leave them out, or make the first one an error. */
    int kept = 0;
    for (int k = 0; k < trace->count; ++k) {
        if (marks[k] > 0.0 && !options->remove_spikes) {
            return fail_spike(trace, k, marks[k], error);
        }

        if (marks[k] > 0.0) {
            ++report->spikes;
            continue;
        }
        trace->t[kept] = trace->t[k];
        trace->value[kept++] = trace->value[k];
    }
    trace->count = kept;
    return GM_IO_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Units
 * ------------------------------------------------------------------------------------------- */

static double range_of(const gmi_measured *trace) {
    double low = trace->value[0];
    double high = trace->value[0];
    for (int k = 1; k < trace->count; ++k) {
        low = trace->value[k] < low ? trace->value[k] : low;
        high = trace->value[k] > high ? trace->value[k] : high;
    }
    return high - low;
}

static int check_units(const gmi_measured *traces, int count, const gm_pair *pair,
                       gm_io_error *error) {
    int worst = 0;
    double range = 0.0;
    for (int i = 0; i < count; ++i) {
        const double of_trace = range_of(&traces[i]);
        if (of_trace > range) {
            range = of_trace;
            worst = i;
        }
    }
    const double most = 0.1 * pair->normal_module + 100e-6; /* no relief is that large */
    return gmi_check_size(range, most, "the deviations of the traces",
                          gmi_measured_line(&traces[worst]), error);
}

/* ---------------------------------------------------------------------------------------------
 * Sign
 * ------------------------------------------------------------------------------------------- */

/* How far both ends of a trace stand out beyond its middle; a slope has no part in it. */
static double end_height(const gmi_measured *trace) {
    const double last = trace->t[trace->count - 1];
    const double from = trace->t[0] > 0.0 ? trace->t[0] : 0.0;
    const double to = last < 1.0 ? last : 1.0;
    double value[9];
    for (int i = 0; i < 9; ++i) {
        value[i] = gmi_measured_at(trace, from + (to - from) * i / 8.0);
    }
    return 0.25 * (value[0] + value[1] + value[7] + value[8]) -
           (value[3] + value[4] + value[5]) / 3.0;
}

/* Mean height of the ends over the traces of a kind; 0 if there is none. */
static double mean_end_height(const gmi_measured *traces, int count, int kind) {
    double sum = 0.0;
    int found = 0;
    for (int i = 0; i < count; ++i) {
        if (traces[i].kind == kind) {
            sum += end_height(&traces[i]);
            ++found;
        }
    }
    return found > 0 ? sum / found : 0.0;
}

/* Ends that stand out by less than this say nothing of a sign (m). */
static const double least_end_height = 0.5e-6;

/*
 * Real flanks are relieved and crowned, or neither: their ends fall away. If chance alone were at work, the ends of
 * half of the traces would stand out. That many is 3.1 standard deviations of a fair coin more (which takes 10
 * traces at least), and four of five.
 */
static double hollow_limit(int count) {
    return fmax(0.5 * count + 1.55 * sqrt(count), 0.8 * count);
}

/*
 * The probe of a machine is pushed one way by left flanks and the other way by right ones. Values with its sign are hollow
 * on all traces of one flank and on none of the other: by chance less than once in a hundred times with so many traces.
 */
enum { LEAST_TRACES_OF_BOTH = 8 };

static int check_probe_sign(const gmi_measured *traces, int count, gm_io_error *error) {
    /* How many traces of each flank stand out at their ends. One that is neither says nothing of any. */
    int hollow[2] = {0, 0}; /* left, right */
    int judged[2] = {0, 0};
    for (int i = 0; i < count; ++i) {
        const int flank = traces[i].from->flank;
        if (flank == GM_LEFT || flank == GM_RIGHT) {
            const double height = end_height(&traces[i]);
            if (fabs(height) < least_end_height) {
                return GM_IO_OK;
            }
            ++judged[flank == GM_RIGHT];
            hollow[flank == GM_RIGHT] += height > 0.0;
        }
    }

    /* All of one flank and none of the other, with enough traces. */
    const int left = hollow[0] == judged[0] && hollow[1] == 0;
    const int right = hollow[1] == judged[1] && hollow[0] == 0;
    if (judged[0] == 0 || judged[1] == 0 || judged[0] + judged[1] < LEAST_TRACES_OF_BOTH ||
        !(left || right)) {
        return GM_IO_OK;
    }
    gmi_error_option(error, "probe_sign");
    return gmi_error_set(error, GM_IO_ERR_FORMAT, 0,
                         "material added: must be > 0 on both flanks (got all traces of %s flanks "
                         "standing out at their ends and none of the others, as if values had the "
                         "sign of the probe)",
                         left ? "left" : "right");
}

static int check_sign(const gmi_measured *traces, int count, const gm_traces_options *options,
                      gm_traces_report *report, gm_io_error *error) {
    int hollow = 0;
    for (int i = 0; i < count; ++i) {
        hollow += end_height(&traces[i]) > 0.0 ? 1 : 0;
    }
    report->hollow_traces = hollow;
    report->judged_traces = count;
    if (!options->hollow) {
        const int status = check_probe_sign(traces, count, error);
        if (status != GM_IO_OK) {
            return status;
        }
    }

    /* A wrong sign shows in both kinds of traces, and beyond chance. */
    const double profile = mean_end_height(traces, count, GM_TRACE_PROFILE);
    const double helix = mean_end_height(traces, count, GM_TRACE_HELIX);
    if (options->hollow || profile < 0.0 || helix < 0.0 ||
        (profile < least_end_height && helix < least_end_height) || hollow <= hollow_limit(count)) {
        return GM_IO_OK;
    }

    char profile_text[GMI_NUMBER_SIZE];
    char helix_text[GMI_NUMBER_SIZE];
    gmi_error_option(error, "hollow");
    return gmi_error_set(error, GM_IO_ERR_FORMAT, 0,
                         "material added: must be > 0 (got %d of %d traces that stand out at their "
                         "ends, profile by %s um, helix by %s um in the mean, as if it were < 0; "
                         "flanks that are meant hollow have to be called so)",
                         hollow, count, gmi_number_text(profile_text, profile, 6, 2),
                         gmi_number_text(helix_text, helix, 6, 2));
}

int gmi_judge_deviations(const gmi_measured *traces, int count, const gm_pair *pair,
                         const gm_traces_options *options, gm_traces_report *report,
                         gm_io_error *error) {
    const int status = check_units(traces, count, pair, error);
    return status == GM_IO_OK ? check_sign(traces, count, options, report, error) : status;
}
