/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * A stretch was filled, not measured, if it repeats one value exactly and the trace steps from there to another level.
 * Neither alone tells: a flat flank, a crowning of 0 in the middle and a plain profile before its relief repeat values,
 * but go on without a step; a relief falls steeply, but does not stop falling. docs/measured-flanks.md
 */

#include "trace_fill.h"

#include <math.h>

#include "files/io_error.h"
#include "files/number_text.h"
#include "robust.h"

/* Below so many points a trace says too little of itself. */
enum { LEAST_POINTS = 10 };

/* A stretch has so many equal points. At an end of a trace with many points, 0 says enough with fewer. */
enum { LEAST_REPEATS = 3, LEAST_POINTS_FOR_ZERO = 20 };

/* A filter smears a step over up to so many intervals; so many intervals behind it show the new level. */
enum { WIDEST_STEP = 4, LEVEL_INTERVALS = 2 };

/* On the new level neighbours differ by less than this share of the step. On a straight relief it would be
 * 1 / WIDEST_STEP. */
static const double level_share = 0.15;

/* A step is more than so many standard deviations of neighbours' differences ... */
static const double step_deviations = 8.0;
/* ... and more than this (m). */
static const double step_floor = 2e-6;

/* Points first .. last, all of one value. */
typedef struct stretch {
    int first;
    int last;

    /* how far the trace stands off behind it, or before (m); 0 = it goes on smoothly */
    double step;
} stretch;

/* ---------------------------------------------------------------------------------------------
 * Steps
 * ------------------------------------------------------------------------------------------- */

/* Whether the trace stays on one level from point k on, in one direction, seen against a step. */
static int is_level(const gmi_measured *trace, int k, int direction, double step) {
    for (int i = 0; i < LEVEL_INTERVALS; ++i, k += direction) {
        const int next = k + direction;
        if (next < 0 || next >= trace->count ||
            fabs(trace->value[next] - trace->value[k]) >= level_share * fabs(step)) {
            return 0;
        }
    }
    return 1;
}

/* Height of the step from point `edge` on, in one direction: within `widest` intervals to a new level. 0 = none. */
static double step_from(const gmi_measured *trace, int edge, int direction, int widest) {
    const double *value = trace->value;
    for (int width = 1; width <= widest; ++width) {
        const int k = edge + width * direction;
        if (k < 0 || k >= trace->count) {
            break;
        }
        const double step = value[k] - value[edge];
        const double last_rise = value[k] - value[k - direction];
        if (step * last_rise <= 0.0) { /* a smeared step rises or falls all the way */
            break;
        }
        if (is_level(trace, k, direction, step)) {
            return fabs(step);
        }
    }
    return 0.0;
}

/* At an end of the trace one step tells; within it there must be one on both sides. */
static double step_of(const gmi_measured *trace, const stretch *of) {
    const int begins = of->first == 0;
    const int ends = of->last == trace->count - 1;
    if (begins && ends) {
        return 0.0;
    }
    /* A trace whose level is 0 at its first point may fall steeply from there; that is no step. */
    const int widest = of->last - of->first + 1 >= LEAST_REPEATS ? WIDEST_STEP : 1;
    const double before = begins ? 0.0 : step_from(trace, of->first, -1, widest);
    const double behind = ends ? 0.0 : step_from(trace, of->last, 1, widest);
    return begins ? behind : ends ? before : before < behind ? before : behind;
}

/* Points below the start of the active profile are not used: what is wrong with them does no harm. */
static int is_used(const gmi_measured *trace, const stretch *of) {
    const int next = of->last + 1;
    const int before = of->first - 1;
    return (next >= trace->count || trace->t[next] > 0.0) && (before < 0 || trace->t[before] < 1.0);
}

static int has_enough_points(const gmi_measured *trace, const stretch *of) {
    const int at_end = of->first == 0 || of->last == trace->count - 1;
    const int points = of->last - of->first + 1;
    return points >= LEAST_REPEATS ||
           (at_end && trace->value[of->first] == 0.0 && trace->count >= LEAST_POINTS_FOR_ZERO);
}

/* The next points of one value from k on, and the step that makes them suspicious. */
static stretch next_stretch(const gmi_measured *trace, int k) {
    stretch found = {k, k, 0.0};
    while (found.last + 1 < trace->count && trace->value[found.last + 1] == trace->value[k]) {
        ++found.last;
    }
    if (has_enough_points(trace, &found) && is_used(trace, &found)) {
        found.step = step_of(trace, &found);
    }
    return found;
}

/* ---------------------------------------------------------------------------------------------
 * How large a step has to be
 * ------------------------------------------------------------------------------------------- */

/* A stretch was filled if its step is larger and its points are not more than this. */
typedef struct limits {
    double step; /* (m) */
    int points;
} limits;

/*
 * From the differences of neighbours where the trace varies at all, without those across the steps in question. A
 * computed trace may have none: it is not rough, and what most of its points share is the trace itself.
 */
static limits find_limits(const gmi_measured *trace, double *work) {
    double *difference = work;
    int count = 0;
    int free_from = 0; /* first point whose difference from the one before is not part of a step */
    for (int k = 0; k < trace->count;) {
        const stretch of = next_stretch(trace, k);
        if (of.step > step_floor) {
            /* The step before it is within the differences noted last, that behind it is still to come. */
            count = count < WIDEST_STEP ? 0 : count - WIDEST_STEP;
            free_from = of.last + 1 + WIDEST_STEP;
        } else if (of.first >= free_from && of.first > 0) {
            difference[count++] = trace->value[of.first] - trace->value[of.first - 1];
        }
        k = of.last + 1;
    }
    if (count == 0) {
        return (limits){step_floor, trace->count / 2};
    }
    /* A few differences do not say well how rough the trace is. */
    const double rough = gmi_spread(difference, count, work + trace->count);
    const double step = step_deviations * (1.0 + 10.0 / count) * rough;
    return (limits){fmax(step_floor, step), trace->count};
}

/* ---------------------------------------------------------------------------------------------
 * What becomes of it
 * ------------------------------------------------------------------------------------------- */

/* Index of a point in the trace as it was measured. */
static int measured_index(const gmi_measured *trace, int k) {
    return trace->turned ? trace->from->count - 1 - k : k;
}

static int fail_filled(const gmi_measured *trace, const stretch *of, gm_io_error *error) {
    const gm_trace *from = trace->from;
    const int a = measured_index(trace, of->first);
    const int b = measured_index(trace, of->last);
    const int low = a < b ? a : b;
    const int high = a < b ? b : a;

    /* The rows may have come the other way round. */
    long line = 0;
    if (from->line != NULL) {
        line = from->line[low] < from->line[high] ? from->line[low] : from->line[high];
    }

    char name[GMI_TRACE_NAME_SIZE];
    char begin[GMI_NUMBER_SIZE];
    char end[GMI_NUMBER_SIZE];
    char value[GMI_NUMBER_SIZE];
    char step[GMI_NUMBER_SIZE];
    gmi_error_option(error, "remove_spikes");
    return gmi_error_set(
        error, GM_IO_ERR_FORMAT, line,
        "%s: all points must be measured, rows without a measurement left out (got exactly %s um "
        "at all %d points from %s to %s mm %s, and a step of %s um beside them)",
        gmi_trace_name(name, from), gmi_number_text(value, from->deviation[low], 6, 6),
        high - low + 1, gmi_number_text(begin, from->position[low], 3, 6),
        gmi_number_text(end, from->position[high], 3, 6),
        from->kind == GM_TRACE_PROFILE ? "roll length" : "from the datum face",
        gmi_number_text(step, of->step, 6, 3));
}

/* Moves the points up that are not filled, and returns how many these are. */
static int close_ranks(gmi_measured *trace, const double *is_filled) {
    int kept = 0;
    for (int k = 0; k < trace->count; ++k) {
        if (is_filled[k] == 0.0) {
            trace->t[kept] = trace->t[k];
            trace->value[kept++] = trace->value[k];
        }
    }
    return kept;
}

int gmi_remove_filled(gmi_measured *trace, const gm_traces_options *options, double *work,
                      gm_traces_report *report, gm_io_error *error) {
    if (trace->count < LEAST_POINTS) {
        return GM_IO_OK;
    }
    const limits limit = find_limits(trace, work);
    double *is_filled = work; /* [count] 0 or 1 */
    int filled_points = 0;

    /* All stretches are judged before the first point goes: each is the neighbour of another one. */
    for (int k = 0; k < trace->count;) {
        const stretch of = next_stretch(trace, k);
        const int points = of.last - of.first + 1;
        const int filled = of.step > limit.step && points <= limit.points;
        filled_points += filled ? points : 0;
        if (filled && (!options->remove_spikes || filled_points > trace->count - LEAST_REPEATS)) {
            return fail_filled(trace, &of, error);
        }
        for (; k <= of.last; ++k) {
            is_filled[k] = filled;
        }
    }
    trace->count = close_ranks(trace, is_filled);
    report->filled_points += filled_points;
    return GM_IO_OK;
}

int gmi_is_constant(const gmi_measured *trace) {
    int k = 1;
    while (k < trace->count && trace->value[k] == trace->value[0]) {
        ++k;
    }
    return k == trace->count;
}
