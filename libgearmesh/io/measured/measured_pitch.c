/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* From the pitch that a machine measured to the pitch list of the gear. docs/measured-flanks.md */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "files/io_error.h"
#include "files/number_text.h"
#include "files/pitch_file.h"
#include "measurement.h"
#include "shared.h"

enum { SIDES = 2 };

typedef struct builder {
    const gm_measured_pitch *measured;
    const gm_measurement *measurement;
    const gm_pair *pair;
    const gm_gear *gear;
    int wheel;
    int *row; /* [2 * teeth] flanks in the machine's order: 1 + index of the point, 0 = missing */
    int present[SIDES]; /* teeth */
    gm_measured_pitch_report report;
    gm_io_error *error;
} builder;

/* Which point is the flank that a machine measured as the index-th of a side; NULL = none. */
static const gm_pitch_point *point_of(const builder *build, int side, int index) {
    const int row = build->row[side * build->gear->teeth + index];
    return row > 0 ? &build->measured->points[row - 1] : NULL;
}

/* ---------------------------------------------------------------------------------------------
 * Every flank once
 * ------------------------------------------------------------------------------------------- */

static int place_point(builder *build, int row) {
    const gm_pitch_point *point = &build->measured->points[row];
    int tooth = 0;
    int side = 0;
    const int status =
        gmi_measurement_place(build->measurement, build->pair, build->wheel, point->tooth,
                              point->flank, point->line, &tooth, &side, build->error);
    if (status != GM_IO_OK) {
        return status;
    }

    /* Every flank once, and with a value that can be added up. */
    const int index = point->tooth - build->measurement->first_number;
    const gm_pitch_point *first = point_of(build, side, index);
    if (first != NULL) {
        return gmi_error_set(build->error, GM_IO_ERR_FORMAT, point->line,
                             "tooth %d, flank %s: must have one row (got a second one, the first "
                             "is in line %ld; are there two teeth with this number?)",
                             point->tooth, gmi_flank_word(point->flank), first->line);
    }

    if (!(fabs(point->value) < 1.0)) { /* no overflow on the way to a message */
        return gmi_error_set(build->error, GM_IO_ERR_FORMAT, point->line,
                             "the pitch of tooth %d: must be a deviation, of some um (got one that "
                             "is not finite or beyond 1 m)",
                             point->tooth);
    }
    build->row[side * build->gear->teeth + index] = row + 1;
    ++build->present[side];
    return GM_IO_OK;
}

/* Appends a number to a list of them; the list is long enough for a few. */
static void list_number(char *list, int number) {
    char text[GMI_NUMBER_SIZE];
    strcat(list, *list != '\0' ? ", " : "");
    strcat(list, gmi_number_text(text, number, 0, 0));
}

static int fail_missing(const builder *build, int side) {
    enum { SHOWN = 5 };
    const int teeth = build->gear->teeth;
    const int mate = gmi_gear_of(build->pair, !build->wheel)->teeth;
    const int missing = teeth - build->present[side];
    const char *flank = "";
    char list[(SHOWN + 1) * GMI_NUMBER_SIZE] = "";
    int shown = 0;

    /* Name the first few. */
    for (int i = 0; i < teeth; ++i) {
        const gm_pitch_point *point = point_of(build, side, i);
        if (point != NULL) {
            flank = gmi_flank_word(point->flank);
        } else if (shown < SHOWN) {
            list_number(list, i + build->measurement->first_number);
            ++shown;
        }
    }

    return gmi_error_set(
        build->error, GM_IO_ERR_FORMAT, 0,
        "flank %s: must have a row for each of the %d teeth (got none for %s %s%s)%s", flank, teeth,
        missing == 1 ? "tooth" : "the teeth", list, missing > shown ? " and others" : "",
        build->present[side] == mate ? " (is it the other gear that was measured?)" : "");
}

static int place_points(builder *build) {
    for (int i = 0; i < build->measured->count; ++i) {
        const int status = place_point(build, i);
        if (status != GM_IO_OK) {
            return status;
        }
    }
    for (int side = 0; side < SIDES; ++side) {
        if (build->present[side] > 0 && build->present[side] < build->gear->teeth) {
            return fail_missing(build, side);
        }
    }
    return GM_IO_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Values
 * ------------------------------------------------------------------------------------------- */

/* What rounding in the file may leave of the sum, per pitch and as a whole (m). */
static const double rounding_per_pitch = 0.05e-6;
static const double rounding = 0.5e-6;

/* Places from single pitches: sums from the first flank on, whose place is 0. What rounding leaves of the whole sum
 * is spread over all. */
static int add_up(builder *build, int side, double *place) {
    const int teeth = build->gear->teeth;
    double sum = 0.0;
    for (int i = 0; i < teeth; ++i) {
        sum += place[i];
    }
    if (fabs(sum) > teeth * rounding_per_pitch + rounding) {
        char text[GMI_NUMBER_SIZE];
        return gmi_error_set(build->error, GM_IO_ERR_FORMAT, point_of(build, side, 0)->line,
                             "the single pitch deviations of flank %s: must add up to 0, as the "
                             "last pitch leads back to the first tooth (got %s um)",
                             gmi_flank_word(point_of(build, side, 0)->flank),
                             gmi_number_text(text, sum, 6, 4));
    }

    build->report.sum[side] = sum;
    double at = 0.0;
    for (int i = 0; i < teeth; ++i) {
        at += i > 0 ? place[i] - sum / teeth : 0.0;
        place[i] = at;
    }
    return GM_IO_OK;
}

static int check_size(const builder *build, int side, const double *place) {
    const int teeth = build->gear->teeth;
    int lowest = 0;
    int highest = 0;
    for (int i = 1; i < teeth; ++i) {
        lowest = place[i] < place[lowest] ? i : lowest;
        highest = place[i] > place[highest] ? i : highest;
    }
    const double most = 0.1 * build->pair->normal_module + 500e-6;
    return gmi_check_size(place[highest] - place[lowest], most, "the places of the flanks",
                          point_of(build, side, highest)->line, build->error);
}

static void take_out_mean(builder *build, int side, double *place) {
    const int teeth = build->gear->teeth;
    double mean = 0.0;
    for (int i = 0; i < teeth; ++i) {
        mean += place[i] / teeth;
    }
    for (int i = 0; i < teeth; ++i) {
        place[i] -= mean;
    }
    build->report.level[side] = mean;
}

/* From how far a flank stands ahead on the machine, as an arc, to the material added on it. */
static double material_per_arc(const builder *build, int side) {
    const double ahead = (side == GM_DRIVE) == !build->wheel ? 1.0 : -1.0;
    return ahead * gmi_measurement_sense(build->measurement, build->pair, build->wheel) *
           build->gear->base_radius / gmi_measuring_radius(build->measurement, build->gear);
}

static int build_side(builder *build, gm_pitch *pitch, int side) {
    const int teeth = build->gear->teeth;
    if (build->present[side] == 0) {
        return GM_IO_OK;
    }
    double *place = calloc((size_t)teeth, sizeof *place); /* in the machine's order */
    if (place == NULL) {
        return gmi_error_memory(build->error);
    }

    /* Places along the arc, one after the other as they were counted. */
    for (int i = 0; i < teeth; ++i) {
        place[i] = point_of(build, side, i)->value;
    }
    int status = build->measured->single ? add_up(build, side, place) : GM_IO_OK;
    if (status == GM_IO_OK) {
        status = check_size(build, side, place);
    }

    /* As material on the teeth of the model, whose order may be the other one. */
    if (status == GM_IO_OK) {
        take_out_mean(build, side, place);
        double *material = side == GM_DRIVE ? pitch->drive : pitch->coast;
        int *set = side == GM_DRIVE ? pitch->drive_set : pitch->coast_set;
        for (int i = 0; i < teeth; ++i) {
            const int tooth = gm_measurement_tooth(build->measurement, build->pair, build->wheel,
                                                   i + build->measurement->first_number);
            material[tooth] = material_per_arc(build, side) * place[i];
            set[tooth] = 1;
        }
    }
    free(place);
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * First order
 * ------------------------------------------------------------------------------------------- */

typedef struct vector {
    double x;
    double y;
} vector;

static vector turned(vector from, double angle) {
    const vector to = {from.x * cos(angle) - from.y * sin(angle),
                       from.x * sin(angle) + from.y * cos(angle)};
    return to;
}

static double square(vector of) {
    return of.x * of.x + of.y * of.y;
}

/* The displacement that would add this material on flanks whose normals look along their teeth: first order around the
 * gear. */
static vector first_order(const builder *build, const double *material) {
    const int teeth = build->gear->teeth;
    /* Teeth follow each other counter-clockwise on pinion and ring, clockwise on an external wheel, seen from face II. */
    const int clockwise = build->wheel && build->gear->sign > 0.0;
    const double step = (clockwise ? -1.0 : 1.0) * build->gear->pitch_angle;
    vector sum = {0.0, 0.0};
    for (int i = 0; i < teeth; ++i) {
        sum.x += 2.0 / teeth * material[i] * cos(step * i);
        sum.y += 2.0 / teeth * material[i] * sin(step * i);
    }
    return sum;
}

/* Share that is left of two vectors if their mean stands for both; fills the mean. */
static double rest_of(vector a, vector b, vector *mean) {
    mean->x = 0.5 * (a.x + b.x);
    mean->y = 0.5 * (a.y + b.y);
    const vector half = {0.5 * (a.x - b.x), 0.5 * (a.y - b.y)};
    const double all = square(a) + square(b);
    return all > 0.0 ? 2.0 * square(half) / all : 0.0;
}

/*
 * A displaced gear adds on each flank what its displacement has along the flank's normal. The normal of a drive
 * flank stands at `lean` to the direction of its tooth (from the axis), that of a coast flank at -lean, on both gears.
 * On an external gear the drive flank is the counter-clockwise one, and its normal leans outwards. On a ring it is the
 * clockwise one, thicker by the involute function farther out, and its normal leans inwards.
 */
static void fit_displacement(builder *build, const gm_pitch *pitch) {
    gm_measured_pitch_report *report = &build->report;
    report->displacement = report->rest = report->mirrored_rest = (double)NAN;
    if (build->present[GM_DRIVE] == 0 || build->present[GM_COAST] == 0) {
        return;
    }

    /* The normal touches the base circle at the roll angle of the measuring circle; psi_b is half of the tooth. */
    const double base = build->gear->base_radius;
    const double radius = gmi_measuring_radius(build->measurement, build->gear);
    const double roll_angle = gmi_roll_length(radius, base) / base;
    const double lean =
        build->gear->sign * (0.5 * GMI_PI + build->gear->base_half_thickness) - roll_angle;

    /* Turned back by it, the first orders of both sides are the displacement, if there is one. */
    const vector drive = first_order(build, pitch->drive);
    const vector coast = first_order(build, pitch->coast);
    vector displacement;
    report->mirrored_rest = rest_of(turned(drive, -lean), turned(coast, lean), &displacement);
    report->rest = rest_of(turned(drive, lean), turned(coast, -lean), &displacement);
    report->displacement = sqrt(square(displacement));
}

/* ---------------------------------------------------------------------------------------------
 * All of it
 * ------------------------------------------------------------------------------------------- */

static int build_pitch(builder *build, gm_pitch *pitch) {
    int status = gmi_measurement_check(build->measurement, build->pair, build->wheel, build->error);
    if (status == GM_IO_OK && (build->measured->count < 1 || build->measured->points == NULL)) {
        status = gmi_error_set(build->error, GM_IO_ERR_FORMAT, 0,
                               "measured pitch: must be that of all teeth (got none)");
    }
    if (status == GM_IO_OK) {
        status = gmi_pitch_allocate(pitch, build->gear->teeth, build->error);
    }
    if (status == GM_IO_OK) {
        build->row = calloc(SIDES * (size_t)build->gear->teeth, sizeof *build->row);
        status = build->row != NULL ? GM_IO_OK : gmi_error_memory(build->error);
    }

    /* Sort the points by flank, then one side after the other. */
    if (status == GM_IO_OK) {
        status = place_points(build);
    }
    for (int side = 0; side < SIDES && status == GM_IO_OK; ++side) {
        status = build_side(build, pitch, side);
    }

    /* Both sides together show whether the gear ran off its axis. */
    if (status == GM_IO_OK) {
        fit_displacement(build, pitch);
    }
    return status;
}

int gm_measured_pitch_build(gm_pitch *pitch, gm_measured_pitch_report *report,
                            const gm_measured_pitch *measured, const gm_measurement *measurement,
                            const gm_pair *pair, int wheel, gm_io_error *error) {
    gmi_error_begin(error, measured != NULL ? measured->file : NULL);
    if (pitch != NULL) {
        memset(pitch, 0, sizeof *pitch);
    }
    if (pitch == NULL || measured == NULL || measurement == NULL || pair == NULL) {
        return gmi_error_null(error);
    }

    builder build;
    memset(&build, 0, sizeof build);
    build.measured = measured;
    build.measurement = measurement;
    build.pair = pair;
    build.gear = gmi_gear_of(pair, wheel);
    build.wheel = wheel;
    build.error = error;

    const int status = build_pitch(&build, pitch);
    free(build.row);
    if (status != GM_IO_OK) {
        gm_pitch_free(pitch);
    } else if (report != NULL) {
        *report = build.report;
    }
    return status;
}
