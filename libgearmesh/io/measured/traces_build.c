/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From the traces of some teeth to the tables of all: the machine's names and lengths become the gear's, traces are
 * judged, those of one flank become a surface, and what lies between measured teeth is interpolated around the gear.
 * docs/measured-flanks.md
 */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "files/flank_slot.h"
#include "files/io_error.h"
#include "files/number_text.h"
#include "measurement.h"
#include "shared.h"
#include "trace.h"
#include "trace_check.h"
#include "trace_fill.h"
#include "trace_map.h"
#include "trace_surface.h"

enum { LEAST_NODES = 2, MOST_NODES = 1000, SIDES = 2 };

void gm_traces_options_default(gm_traces_options *options) {
    if (options != NULL) {
        memset(options, 0, sizeof *options);
        options->face_nodes = 21;
        options->profile_nodes = 31;
        options->held_limit = 0.2;
        options->tip_form_diameter = (double)NAN;
    }
}

typedef struct builder {
    const gm_traces *traces;
    const gm_measurement *measurement;
    const gm_pair *pair;
    const gm_gear *gear;
    int wheel;
    gm_traces_options options;
    gmi_mapping map;
    double t2_zero;         /* where the pitch is measured */
    gmi_measured *measured; /* [traces->count] of the mapping */
    gm_traces_report report;
    gm_io_error *error;
} builder;

/* ---------------------------------------------------------------------------------------------
 * Arguments
 * ------------------------------------------------------------------------------------------- */

static int check_options(const gm_traces_options *options, const gm_gear *gear,
                         gm_io_error *error) {
    if (options->face_nodes < LEAST_NODES || options->face_nodes > MOST_NODES ||
        options->profile_nodes < LEAST_NODES || options->profile_nodes > MOST_NODES) {
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "nodes: must be %d to %d each way (got %d x %d)", LEAST_NODES,
                             MOST_NODES, options->face_nodes, options->profile_nodes);
    }
    if (!(options->held_limit >= 0.0 && options->held_limit <= GMI_MOST_HELD)) {
        gmi_error_option(error, "held_limit");
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "the part of a flank that traces may leave out at an end must be from "
                             "0 to 0.45");
    }
    if (options->tip_form_diameter <= 2.0 * gear->base_radius) {
        char low[GMI_NUMBER_SIZE];
        gmi_error_option(error, "tip_form_diameter");
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "the tip form circle must be larger than the base circle, %s mm",
                             gmi_number_text(low, 2.0 * gear->base_radius, 3, 7));
    }
    return GM_IO_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Order: side, tooth, kind, place
 * ------------------------------------------------------------------------------------------- */

static int compare_traces(const void *first, const void *second) {
    const gmi_measured *a = first;
    const gmi_measured *b = second;
    if (a->side != b->side) {
        return a->side - b->side;
    }
    if (a->tooth != b->tooth) {
        return a->tooth - b->tooth;
    }
    if (a->kind != b->kind) {
        return a->kind - b->kind;
    }
    return (a->at > b->at) - (a->at < b->at);
}

static int is_same_flank(const gmi_measured *a, const gmi_measured *b) {
    return a->side == b->side && a->tooth == b->tooth;
}

/* Traces closer to each other than this (of t1 or t2) are taken for one measured twice. */
static const double least_distance = 1e-3;

static int check_double(const builder *build, const gmi_measured *a, const gmi_measured *b) {
    if (!is_same_flank(a, b) || a->kind != b->kind || b->at - a->at >= least_distance) {
        return GM_IO_OK;
    }
    const gmi_measured *later = gmi_measured_line(a) > gmi_measured_line(b) ? a : b;
    const gmi_measured *earlier = later == a ? b : a;
    char name[GMI_TRACE_NAME_SIZE];
    return gmi_error_set(build->error, GM_IO_ERR_FORMAT, gmi_measured_line(later),
                         "%s: must be there once (got a second one at the same place, the first "
                         "one begins in line %ld; are there two teeth with the number %d?)",
                         gmi_trace_name(name, later->from), gmi_measured_line(earlier),
                         later->from->tooth);
}

static int sort_traces(builder *build) {
    const int count = build->traces->count;
    qsort(build->measured, (size_t)count, sizeof *build->measured, compare_traces);
    for (int i = 1; i < count; ++i) {
        const int status = check_double(build, &build->measured[i - 1], &build->measured[i]);
        if (status != GM_IO_OK) {
            return status;
        }
    }
    return GM_IO_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Report
 * ------------------------------------------------------------------------------------------- */

/* Largest distance of a point from the polygon between uniform nodes, as measured. */
static double resampling_error(const builder *build, const gmi_measured *trace) {
    const int profile = trace->kind == GM_TRACE_PROFILE;
    const int cells = (profile ? build->options.profile_nodes : build->options.face_nodes) - 1;
    double worst = 0.0;
    for (int i = 0; i < trace->count; ++i) {
        if (trace->t[i] < 0.0 || trace->t[i] > 1.0) {
            continue;
        }

        /* The polygon of the table between the two nodes around the point. */
        const double place = trace->t[i] * cells;
        const double before = floor(place < cells ? place : cells - 1.0);
        const double low = gmi_measured_at(trace, before / cells);
        const double high = gmi_measured_at(trace, (before + 1.0) / cells);
        const double off = fabs(trace->value[i] - (low + (place - before) * (high - low)));
        worst = off > worst ? off : worst;
    }
    return worst * (build->measurement->transverse ? build->pair->normal_to_transverse : 1.0);
}

static double within(double value, double low, double high) {
    return value < low ? low : value > high ? high : value;
}

static void narrow(double range[2], double from, double to) {
    from = within(from, 0.0, 1.0);
    to = within(to, 0.0, 1.0);
    range[0] = isnan(range[0]) || from > range[0] ? from : range[0];
    range[1] = isnan(range[1]) || to < range[1] ? to : range[1];
}

/* A flank that was never touched looks ideal. Where all flanks are, nothing is odd. */
static void report_constant(builder *build, int kind) {
    gm_traces_report *report = &build->report;
    int constant = 0;
    int varying = 0;
    int first = build->traces->count;
    for (int i = 0; i < build->traces->count; ++i) {
        const gmi_measured *trace = &build->measured[i];
        const int index = (int)(trace->from - build->traces->traces);
        if (trace->kind != kind) {
            continue;
        }
        if (!gmi_is_constant(trace)) {
            ++varying;
            continue;
        }

        ++constant;
        first = index < first ? index : first;
    }

    if (constant == 0 || varying == 0) {
        return;
    }
    report->constant_traces += constant;
    if (report->constant_trace < 0 || first < report->constant_trace) {
        report->constant_trace = first;
    }
}

static void report_traces(builder *build) {
    gm_traces_report *report = &build->report;
    for (int i = 0; i < build->traces->count; ++i) {
        const gmi_measured *trace = &build->measured[i];
        const int begins =
            i == 0 || !is_same_flank(trace, trace - 1) || trace->kind != trace[-1].kind;
        const double last = trace->t[trace->count - 1];

        /* Traces and teeth of either kind, and how far all of them reach. */
        if (trace->kind == GM_TRACE_PROFILE) {
            ++report->profile_traces[trace->side];
            report->profile_teeth[trace->side] += begins;
            narrow(report->profile_range, trace->t[0], last);
        } else {
            ++report->helix_traces[trace->side];
            report->helix_teeth[trace->side] += begins;
            narrow(report->face_range, trace->t[0], last);
        }
        report->resampling_error = fmax(report->resampling_error, resampling_error(build, trace));
    }

    report_constant(build, GM_TRACE_PROFILE);
    report_constant(build, GM_TRACE_HELIX);
}

/* ---------------------------------------------------------------------------------------------
 * Tables
 * ------------------------------------------------------------------------------------------- */

static size_t node_count(const builder *build) {
    return (size_t)build->options.face_nodes * (size_t)build->options.profile_nodes;
}

/* A side is one table for all teeth where no more than one tooth tells anything. */
static int is_for_all(const builder *build, int side) {
    return build->report.profile_teeth[side] <= 1 && build->report.helix_teeth[side] <= 1;
}

static int is_measured(const builder *build, int side) {
    return build->report.profile_teeth[side] + build->report.helix_teeth[side] > 0;
}

static int add_set(const builder *build, gm_deviations *deviations, int tooth, int side) {
    gm_deviation_set *set = &deviations->sets[deviations->set_count];
    set->tooth = tooth;
    set->side = side;
    set->values = calloc(node_count(build), sizeof *set->values);
    if (set->values == NULL) {
        return gmi_error_memory(build->error);
    }
    ++deviations->set_count;
    return GM_IO_OK;
}

/* All sets, zero; those for all teeth first, then by tooth. Table [side][tooth], or [side][0] for all. */
static int make_sets(const builder *build, gm_deviations *deviations) {
    const int teeth = build->gear->teeth;
    deviations->teeth = teeth;
    deviations->face_nodes = build->options.face_nodes;
    deviations->profile_nodes = build->options.profile_nodes;
    deviations->sets = calloc(SIDES * (size_t)teeth, sizeof *deviations->sets);
    int status = deviations->sets != NULL ? GM_IO_OK : gmi_error_memory(build->error);

    /* In the order of the file format: `*` first, then by tooth. */
    for (int tooth = GMI_ALL; tooth < teeth; ++tooth) {
        for (int side = 0; side < SIDES && status == GM_IO_OK; ++side) {
            if (is_measured(build, side) && is_for_all(build, side) == (tooth == GMI_ALL)) {
                status = add_set(build, deviations, tooth, side);
            }
        }
    }
    return status;
}

static double *table_of(const builder *build, const gm_deviations *deviations, int side,
                        int tooth) {
    const int other = !side;
    const int other_has = is_measured(build, other);
    if (is_for_all(build, side)) {
        const int behind = side == GM_COAST && other_has && is_for_all(build, other);
        return deviations->sets[behind].values;
    }
    const int other_each = other_has && !is_for_all(build, other);
    const int before = other_has && !other_each ? 1 : 0;
    const int step = other_each ? 2 : 1;
    return deviations->sets[before + step * tooth + (other_each ? side : 0)].values;
}

/* What one measured flank says: a part that varies along the profile (and perhaps the face), and one that varies
 * along the face alone. */
typedef struct part {
    int tooth;
    double *values;
} part;

typedef struct parts {
    int count;
    part *list;
} parts;

/* Adds what the measured teeth say to the tables of all, linear in the tooth number around the gear. `repeat`:
 * a value serves so many nodes in a row. */
static void interpolate(const builder *build, const gm_deviations *deviations, int side,
                        const parts *of, int repeat) {
    const int teeth = build->gear->teeth;
    const int shown = is_for_all(build, side) ? 1 : teeth;
    for (int k = 0; k < of->count; ++k) {
        const part *low = &of->list[k];
        const part *high = &of->list[(k + 1) % of->count];
        const int turn = (high->tooth - low->tooth + teeth) % teeth;
        const int steps = turn > 0 ? turn : shown;
        for (int step = 0; step < steps; ++step) {
            double *table = table_of(build, deviations, side, (low->tooth + step) % teeth);
            const double share = (double)step / steps;

            for (size_t node = 0; node < node_count(build); ++node) {
                const double from = low->values[node / (size_t)repeat];
                table[node] += from + share * (high->values[node / (size_t)repeat] - from);
            }
        }
    }
}

/* Splits a surface: along t1 alone at the place of the pitch, and the rest. */
static void split_surface(const builder *build, double *table, double *helix) {
    const int nodes = build->options.profile_nodes;
    for (int face = 0; face < build->options.face_nodes; ++face) {
        const double t1 = (double)face / (build->options.face_nodes - 1);
        helix[face] = gmi_table_at(table, build->options.face_nodes, nodes, t1, build->t2_zero);
    }
    for (size_t node = 0; node < node_count(build); ++node) {
        table[node] -= helix[node / (size_t)nodes];
    }
}

/* Where the traces of a flank end, and how many of them are profiles. */
static int flank_end(const builder *build, int begin, int *profiles) {
    int end = begin;
    *profiles = 0;
    while (end < build->traces->count &&
           is_same_flank(&build->measured[begin], &build->measured[end])) {
        *profiles += build->measured[end].kind == GM_TRACE_PROFILE ? 1 : 0;
        ++end;
    }
    return end;
}

static int check_flank(const builder *build, int begin, int profiles, int helices) {
    const gmi_measured *trace = &build->measured[begin];
    char name[GMI_TRACE_NAME_SIZE];
    if (profiles > GMI_MAX_TRACES || helices > GMI_MAX_TRACES) {
        return gmi_error_set(
            build->error, GM_IO_ERR_FORMAT, gmi_measured_line(trace),
            "%s: must be one of at most %d of a kind on its flank (got %d profiles and %d helices)",
            gmi_trace_name(name, trace->from), GMI_MAX_TRACES, profiles, helices);
    }

    /* Helices alone have no levels that fit each other: nothing crosses them. */
    if (profiles == 0 && helices > 1) {
        return gmi_error_set(build->error, GM_IO_ERR_FORMAT, gmi_measured_line(trace),
                             "%s: must have a profile trace beside it, or be the only helix trace "
                             "(got %d on a flank without a profile)",
                             gmi_trace_name(name, trace->from), helices);
    }
    return GM_IO_OK;
}

/* Surfaces of the measured flanks of one side, `table` being room for each of them. */
static int build_parts(builder *build, int side, parts *profile, parts *helix, double *tables,
                       double *lines) {
    for (int begin = 0; begin < build->traces->count;) {
        const gmi_measured *traces = &build->measured[begin];
        int profiles = 0;
        const int end = flank_end(build, begin, &profiles);
        const int helices = end - begin - profiles;

        /* What the traces of one flank span. */
        if (traces->side == side) {
            int status = check_flank(build, begin, profiles, helices);
            if (status == GM_IO_OK) {
                status = gmi_surface_make(tables, &build->options, traces, profiles, helices,
                                          build->t2_zero, &build->report, build->error);
            }
            if (status != GM_IO_OK) {
                return status;
            }

            /* Helix and rest apart: teeth that lack one of them get it from others. */
            split_surface(build, tables, lines);
            const part surface = {traces->tooth, tables};
            const part line = {traces->tooth, lines};
            if (profiles > 0) {
                profile->list[profile->count++] = surface;
            }
            if (helices > 0) {
                helix->list[helix->count++] = line;
            }

            tables += node_count(build);
            lines += build->options.face_nodes;
        }
        begin = end;
    }
    return GM_IO_OK;
}

static int build_side(builder *build, gm_deviations *deviations, int side) {
    const size_t flanks =
        (size_t)build->report.profile_teeth[side] + (size_t)build->report.helix_teeth[side];
    const size_t nodes = node_count(build) + (size_t)build->options.face_nodes;
    if (flanks == 0) {
        return GM_IO_OK;
    }

    /* A surface and a helix for every flank that was measured. */
    double *values = malloc(flanks * nodes * sizeof *values);
    part *list = malloc(2 * flanks * sizeof *list);

    int status = values != NULL && list != NULL ? GM_IO_OK : gmi_error_memory(build->error);
    if (status == GM_IO_OK) {
        parts profile = {0, list};
        parts helix = {0, list + flanks};
        status =
            build_parts(build, side, &profile, &helix, values, values + flanks * node_count(build));
        if (status == GM_IO_OK) {
            interpolate(build, deviations, side, &profile, 1);
            interpolate(build, deviations, side, &helix, build->options.profile_nodes);
        }
    }
    free(values);
    free(list);
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * All of it
 * ------------------------------------------------------------------------------------------- */

static int check_arguments(builder *build) {
    int status = gmi_measurement_check(build->measurement, build->pair, build->wheel, build->error);
    if (status == GM_IO_OK) {
        status = check_options(&build->options, build->gear, build->error);
    }
    if (status == GM_IO_OK && (build->traces->count < 1 || build->traces->traces == NULL)) {
        return gmi_error_set(build->error, GM_IO_ERR_FORMAT, 0,
                             "traces: must be at least one (got none)");
    }
    return status;
}

static void prepare(builder *build) {
    const double radius = gmi_measuring_radius(build->measurement, build->gear);
    const double roll_length = gmi_roll_length(radius, build->gear->base_radius);
    build->t2_zero = within(gmi_profile_place(build->gear, roll_length), 0.0, 1.0);
    build->report.constant_trace = -1;
    build->report.profile_range[0] = build->report.profile_range[1] = (double)NAN;
    build->report.face_range[0] = build->report.face_range[1] = (double)NAN;
}

static int build_deviations(builder *build, gm_deviations *deviations) {
    int status = check_arguments(build);
    if (status == GM_IO_OK) {
        prepare(build);
        status = gmi_traces_map(&build->map, build->traces);
        build->measured = build->map.measured;
    }

    /* Traces that look as if in other units, or with the other sign, go no further. */
    if (status == GM_IO_OK) {
        status = gmi_judge_deviations(build->measured, build->traces->count, build->pair,
                                      &build->options, &build->report, build->error);
    }
    if (status == GM_IO_OK) {
        status = sort_traces(build);
    }

    /* One side after the other: surfaces of measured flanks, and the teeth in between. */
    if (status == GM_IO_OK) {
        report_traces(build);
        status = make_sets(build, deviations);
    }
    for (int side = 0; side < SIDES && status == GM_IO_OK; ++side) {
        status = build_side(build, deviations, side);
    }
    return status;
}

int gm_traces_build(gm_deviations *deviations, gm_traces_report *report, const gm_traces *traces,
                    const gm_measurement *measurement, const gm_pair *pair, int wheel,
                    const gm_traces_options *options, gm_io_error *error) {
    gmi_error_begin(error, traces != NULL ? traces->file : NULL);
    if (deviations != NULL) {
        memset(deviations, 0, sizeof *deviations);
    }
    if (deviations == NULL || traces == NULL || measurement == NULL || pair == NULL) {
        return gmi_error_null(error);
    }

    /* What all steps share. */
    builder build;
    memset(&build, 0, sizeof build);
    build.traces = traces;
    build.measurement = measurement;
    build.pair = pair;
    build.gear = gmi_gear_of(pair, wheel);
    build.wheel = wheel;
    gm_traces_options_default(&build.options);
    if (options != NULL) {
        build.options = *options;
    }
    build.error = error;

    /* The mapping fills its part of the same report. */
    build.map = (gmi_mapping){.measurement = measurement,
                              .pair = pair,
                              .gear = build.gear,
                              .wheel = wheel,
                              .options = &build.options,
                              .report = &build.report,
                              .error = error};

    const int status = build_deviations(&build, deviations);
    gmi_mapping_free(&build.map);
    if (status != GM_IO_OK) {
        gm_deviations_free(deviations);
    } else if (report != NULL) {
        *report = build.report;
    }
    return status;
}
