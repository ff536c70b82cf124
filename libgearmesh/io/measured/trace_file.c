/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Traces as measuring machines give them: docs/measured-flanks.md. Here only the text is judged and put
 * into plain data; what it means for a gear is the business of traces_build.c.
 */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files/io_error.h"
#include "files/number_text.h"
#include "files/table_reader.h"
#include "measured_table.h"
#include "measurement.h"
#include "mka_file.h"
#include "shared.h"

/* Units of the file. */
#define MICRO (-6)
#define MILLI (-3)

static const char *const kind_words[] = {"profile", "helix"};
enum { KIND_WORDS = 2 };

/* ---------------------------------------------------------------------------------------------
 * Traces: rows
 * ------------------------------------------------------------------------------------------- */

/* How a profile counts its places. */
enum { BY_ROLL_LENGTH, BY_DIAMETER, BY_ROLL_ANGLE, TRACE_HEADERS };

enum { TRACE = GMI_COLUMN_FLANK + 1, FACE, ROLL, DEVIATION, TRACE_COLUMNS };

static const char *const roll_header[TRACE_COLUMNS] = {"tooth",   "flank",          "trace",
                                                       "face_mm", "roll_length_mm", "deviation_um"};
static const char *const diameter_header[TRACE_COLUMNS] = {
    "tooth", "flank", "trace", "face_mm", "diameter_mm", "deviation_um"};
static const char *const angle_header[TRACE_COLUMNS] = {
    "tooth", "flank", "trace", "face_mm", "roll_angle_deg", "deviation_um"};
static const char *const *const trace_headers[TRACE_HEADERS] = {roll_header, diameter_header,
                                                                angle_header};

static const double degree = 3.14159265358979323846 / 180.0;

/* How far the place of a trace may wander within it: a machine corrects its path. */
static const double place_tolerance = 1e-5;

/* What a row says. */
typedef struct trace_row {
    gm_trace trace;  /* what it belongs to, without arrays */
    double place;    /* of that trace, as in the file: diameters are not roll lengths (m) */
    double position; /* along it (m) */
    double deviation;
    long line;
} trace_row;

typedef struct point {
    double position;
    double deviation;
    long line;
} point;

/* A file on its way into memory. */
typedef struct loader {
    const gm_gear *gear;
    int counting;     /* BY_ROLL_LENGTH ... */
    gm_trace *traces; /* as they will be, still without arrays */
    int trace_count;
    int trace_capacity;
    point *points; /* of all traces, one after the other */
    int point_count;
    int point_capacity;
    double place;  /* of the trace last read, as in the file (m) */
    int direction; /* along it: 1, -1, 0 = not known yet */
    gm_io_error *error;
} loader;

/* A file has few digits: the base circle may come out just below itself, by this share of it. */
static const double base_tolerance = 5e-6;

/* The roll length of a diameter. */
static int roll_of_diameter(const loader *load, const gmi_table *table, double diameter,
                            double *roll) {
    const gm_gear *gear = load->gear;
    const double base = gear->base_radius;

    /* Below the base circle there is no involute; a little below is its rounding. The flank of a ring begins farther out. */
    if (!(0.5 * diameter >= (1.0 - base_tolerance) * base)) {
        char quoted[GMI_QUOTE_SIZE];
        char low[GMI_NUMBER_SIZE];
        char high[GMI_NUMBER_SIZE];
        const int is_ring = gear->sign < 0.0;
        const double most = 2.0 * (is_ring ? gear->root_radius : gear->tip_radius);
        return gmi_error_set(load->error, GM_IO_ERR_FORMAT, table->line,
                             "diameter_mm: must be from %s (%s) to %s (%s) (got %s)%s",
                             gmi_number_text(low, 2.0 * (is_ring ? gear->tip_radius : base), 3, 7),
                             is_ring ? "tip" : "base circle", gmi_number_text(high, most, 3, 7),
                             is_ring ? "root" : "tip", gmi_quote(quoted, table->fields[ROLL]),
                             gmi_length_hint(diameter, most));
    }

    *roll = gmi_roll_length(0.5 * diameter, base);
    return GM_IO_OK;
}

static int read_trace_row(const loader *load, const gmi_table *table, trace_row *row) {
    gm_trace *trace = &row->trace;
    double face = 0.0;
    double length = 0.0; /* roll length or diameter */
    double roll = 0.0;
    memset(row, 0, sizeof *row);
    int status = gmi_measured_place(table, &trace->tooth, &trace->flank);
    if (status == GM_IO_OK) {
        status = gmi_table_word(table, TRACE, kind_words, KIND_WORDS, &trace->kind);
    }
    if (status == GM_IO_OK) {
        status = gmi_table_number(table, FACE, MILLI, &face);
    }
    if (status == GM_IO_OK) {
        status =
            gmi_table_number(table, ROLL, load->counting == BY_ROLL_ANGLE ? 0 : MILLI, &length);
    }

    /* The string that unwinds from the base circle by an angle. */
    if (load->counting == BY_ROLL_ANGLE) {
        length *= degree * load->gear->base_radius;
    }
    roll = length;
    if (status == GM_IO_OK && load->counting == BY_DIAMETER) {
        status = roll_of_diameter(load, table, length, &roll);
    }
    if (status == GM_IO_OK) {
        status = gmi_table_number(table, DEVIATION, MICRO, &row->deviation);
    }

    /* A profile lies at a distance from the datum face and runs along the roll length, a helix the other way round. */
    trace->at = trace->kind == GM_TRACE_PROFILE ? face : roll;
    row->place = trace->kind == GM_TRACE_PROFILE ? face : length;
    row->position = trace->kind == GM_TRACE_PROFILE ? roll : face;
    row->line = table->line;
    return status;
}

/* Whether a row belongs to the trace last read. */
static int goes_on(const loader *load, const trace_row *row) {
    if (load->trace_count == 0) {
        return 0;
    }
    const gm_trace *last = &load->traces[load->trace_count - 1];
    return row->trace.tooth == last->tooth && row->trace.flank == last->flank &&
           row->trace.kind == last->kind && fabs(row->place - load->place) <= place_tolerance;
}

/* Checks that a row goes on in the direction of its trace. */
static int check_direction(loader *load, const gmi_table *table, const trace_row *row) {
    const double before = load->points[load->point_count - 1].position;
    const int direction = (row->position > before) - (row->position < before);
    if (direction == 0 || direction == -load->direction) {
        const int column = row->trace.kind == GM_TRACE_PROFILE ? ROLL : FACE;
        char quoted[GMI_QUOTE_SIZE];
        return gmi_error_set(load->error, GM_IO_ERR_FORMAT, table->line,
                             "%s: must go on from the row before, as positions of a trace only "
                             "rise or only fall (got %s; are there two teeth with the number %d?)",
                             table->columns[column], gmi_quote(quoted, table->fields[column]),
                             row->trace.tooth);
    }
    load->direction = direction;
    return GM_IO_OK;
}

static int begin_trace(loader *load, const trace_row *row) {
    gm_trace *grown =
        gmi_array_grow(load->traces, sizeof *grown, load->trace_count, &load->trace_capacity);
    if (grown == NULL) {
        return gmi_error_memory(load->error);
    }
    load->traces = grown;
    load->traces[load->trace_count++] = row->trace;
    load->place = row->place;
    load->direction = 0;
    return GM_IO_OK;
}

static int append_point(loader *load, const trace_row *row) {
    point *grown =
        gmi_array_grow(load->points, sizeof *grown, load->point_count, &load->point_capacity);
    if (grown == NULL) {
        return gmi_error_memory(load->error);
    }
    const point added = {row->position, row->deviation, row->line};
    load->points = grown;
    load->points[load->point_count++] = added;
    ++load->traces[load->trace_count - 1].count;
    return GM_IO_OK;
}

static int place_row(loader *load, const gmi_table *table, const trace_row *row) {
    const int status =
        goes_on(load, row) ? check_direction(load, table, row) : begin_trace(load, row);
    return status == GM_IO_OK ? append_point(load, row) : status;
}

static int read_trace_rows(loader *load, gmi_table *table) {
    int more = 0;
    while ((more = gmi_table_next(table)) > 0) {
        trace_row row;
        int status = read_trace_row(load, table, &row);
        if (status == GM_IO_OK) {
            status = place_row(load, table, &row);
        }
        if (status != GM_IO_OK) {
            return status;
        }
    }
    return more == 0 && load->trace_count == 0 ? gmi_measured_fail_empty(table) : more;
}

/* ---------------------------------------------------------------------------------------------
 * Traces: from rows to arrays
 * ------------------------------------------------------------------------------------------- */

/* Gives a trace its points, rising whatever the direction of the rows. */
static int fill_trace(gm_trace *trace, const point *points) {
    const size_t count = (size_t)trace->count;
    const int falls = count > 1 && points[1].position < points[0].position;
    trace->position = malloc(count * sizeof *trace->position);
    trace->deviation = malloc(count * sizeof *trace->deviation);
    trace->line = malloc(count * sizeof *trace->line);
    if (!trace->position || !trace->deviation || !trace->line) {
        return 0;
    }

    for (size_t i = 0; i < count; ++i) {
        const point *from = &points[falls ? count - 1 - i : i];
        trace->position[i] = from->position;
        trace->deviation[i] = from->deviation;
        trace->line[i] = from->line;
    }
    return 1;
}

static int make_traces(loader *load, gm_traces *traces) {
    const point *points = load->points;
    traces->traces = load->traces;
    traces->count = load->trace_count;
    load->traces = NULL;
    for (int i = 0; i < traces->count; ++i) {
        if (!fill_trace(&traces->traces[i], points)) {
            return gmi_error_memory(load->error);
        }
        points += traces->traces[i].count;
    }
    return GM_IO_OK;
}

static int load_traces(loader *load, gm_traces *traces, const char *path, int style) {
    gmi_table table;
    int status = gmi_table_open_any(&table, path, trace_headers, TRACE_HEADERS, TRACE_COLUMNS,
                                    style, &load->counting, load->error);
    if (status == GM_IO_OK) {
        status = read_trace_rows(load, &table);
    }
    gmi_table_close(&table);
    return status == GM_IO_OK ? make_traces(load, traces) : status;
}

int gm_traces_read(gm_traces *traces, const char *path, const gm_pair *pair, int wheel, int style,
                   gm_io_error *error) {
    gmi_error_begin(error, path);
    if (traces != NULL) {
        memset(traces, 0, sizeof *traces);
    }
    if (traces == NULL || path == NULL || pair == NULL) {
        return gmi_error_null(error);
    }

    int status = GM_IO_OK;
    if (gmi_is_mka(path)) {
        status = gmi_mka_traces(traces, path, pair, wheel, style, error);
    } else {
        loader load;
        memset(&load, 0, sizeof load);
        load.gear = gmi_gear_of(pair, wheel);
        load.error = error;
        status = load_traces(&load, traces, path, style);
        free(load.traces);
        free(load.points);
    }
    if (status == GM_IO_OK) {
        snprintf(traces->file, sizeof traces->file, "%s", path);
    } else {
        gm_traces_free(traces);
    }
    return status;
}

void gm_traces_free(gm_traces *traces) {
    if (traces == NULL) {
        return;
    }
    for (int i = 0; traces->traces != NULL && i < traces->count; ++i) {
        free(traces->traces[i].position);
        free(traces->traces[i].deviation);
        free(traces->traces[i].line);
    }
    free(traces->traces);
    memset(traces, 0, sizeof *traces);
}
