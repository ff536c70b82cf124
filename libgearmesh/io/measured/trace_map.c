/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From the machine's terms to the gear's: tooth numbers, left and right, millimetres from a datum face and roll lengths
 * become tooth, side, t1 and t2. What leaves the gear, or misses too much of it, is an error. docs/measured-flanks.md
 */

#include "trace_map.h"

#include <math.h>
#include <stdlib.h>

#include "files/io_error.h"
#include "files/number_text.h"
#include "measurement.h"
#include "shared.h"
#include "trace_check.h"
#include "trace_fill.h"

/* How far a trace may stand out beyond tip or face: the digits of a file (1). */
static const double overrun = 1e-3;

double gmi_profile_place(const gm_gear *gear, double roll_length) {
    return (roll_length - gear->start_roll_length) /
           (gear->tip_roll_length - gear->start_roll_length);
}

static double face_place(const gmi_mapping *map, double face) {
    const double t1 = face / map->gear->face_width;
    return map->measurement->datum_face == GM_FACE_I ? t1 : 1.0 - t1;
}

static long line_of(const gm_trace *trace, int point) {
    return trace->line != NULL ? trace->line[point] : 0;
}

static int fail_face(const gmi_mapping *map, const gm_trace *trace, int point, double face,
                     double reach) {
    char name[GMI_TRACE_NAME_SIZE];
    char got[GMI_NUMBER_SIZE];
    char right[GMI_NUMBER_SIZE];
    return gmi_error_set(
        map->error, GM_IO_ERR_FORMAT, line_of(trace, point),
        "%s leaves the gear: must be 0 to %s mm from the datum face, the face width (got %s mm)%s",
        gmi_trace_name(name, trace), gmi_number_text(right, map->gear->face_width, 3, 7),
        gmi_number_text(got, face, 3, 7), gmi_length_hint(reach, map->gear->face_width));
}

static int is_ring(const gm_gear *gear) {
    return gear->sign < 0.0;
}

/* The roll length where the flank of a gear ends at its root, at most: the involute of a ring goes no farther out. */
static double root_roll_length(const gm_gear *gear) {
    return is_ring(gear) ? gmi_roll_length(gear->root_radius, gear->base_radius) : 0.0;
}

/* Profiles of a ring run from the tip to the root as roll lengths rise, between two circles that both end the flank. */
static int fail_roll_of_ring(const gmi_mapping *map, const gm_trace *trace, int point, double roll,
                             double reach) {
    const gm_gear *gear = map->gear;
    const double tip = gear->tip_roll_length;
    const double root = root_roll_length(gear);
    char name[GMI_TRACE_NAME_SIZE];
    char got[2][GMI_NUMBER_SIZE];
    char right[2][GMI_NUMBER_SIZE];
    char diameter[2][GMI_NUMBER_SIZE];
    return gmi_error_set(map->error, GM_IO_ERR_FORMAT, line_of(trace, point),
                         "%s leaves the ring: must be at a roll length from %s mm (diameter %s mm, "
                         "the tip) to %s mm "
                         "(diameter %s mm, the root) (got %s mm, diameter %s mm)%s",
                         gmi_trace_name(name, trace), gmi_number_text(right[0], tip, 3, 7),
                         gmi_number_text(diameter[0], 2.0 * gear->tip_radius, 3, 7),
                         gmi_number_text(right[1], root, 3, 7),
                         gmi_number_text(diameter[1], 2.0 * gear->root_radius, 3, 7),
                         gmi_number_text(got[0], roll, 3, 7),
                         gmi_number_text(got[1], 2.0 * hypot(roll, gear->base_radius), 3, 7),
                         gmi_length_hint(reach, root));
}

static int fail_roll(const gmi_mapping *map, const gm_trace *trace, int point, double roll,
                     double reach) {
    const double base = map->gear->base_radius;
    char name[GMI_TRACE_NAME_SIZE];
    char got[GMI_NUMBER_SIZE];
    char got_diameter[GMI_NUMBER_SIZE];
    char right[GMI_NUMBER_SIZE];
    char right_diameter[GMI_NUMBER_SIZE];
    if (is_ring(map->gear)) {
        return fail_roll_of_ring(map, trace, point, roll, reach);
    }

    /* Both lengths also as diameters, as the file may have either. */
    return gmi_error_set(map->error, GM_IO_ERR_FORMAT, line_of(trace, point),
                         "%s leaves the gear: must be at a roll length up to %s mm (diameter %s "
                         "mm), the tip (got %s mm, diameter %s mm)%s",
                         gmi_trace_name(name, trace),
                         gmi_number_text(right, map->gear->tip_roll_length, 3, 7),
                         gmi_number_text(right_diameter, 2.0 * map->gear->tip_radius, 3, 7),
                         gmi_number_text(got, roll, 3, 7),
                         gmi_number_text(got_diameter, 2.0 * hypot(roll, base), 3, 7),
                         gmi_length_hint(reach, map->gear->tip_roll_length));
}

static int is_on_face(double t1) {
    return t1 >= -overrun && t1 <= 1.0 + overrun;
}

/*
 * A profile may begin anywhere below the active profile: an external one on the base circle, that of a ring on the root
 * circle, as its involute goes on outwards.
 */
static int is_on_profile(const gmi_mapping *map, double roll) {
    const gm_gear *gear = map->gear;
    const double beyond = overrun * fabs(gear->tip_roll_length - gear->start_roll_length);
    return gear->sign * (roll - root_roll_length(gear)) >= (is_ring(gear) ? -beyond : 0.0) &&
           gmi_profile_place(gear, roll) <= 1.0 + overrun;
}

/* Lengths that can be worked with: no overflow on the way to a message. */
static int is_sane(double length) {
    return fabs(length) < 1e3;
}

static int check_structure(const gmi_mapping *map, const gm_trace *trace) {
    const int known = trace->kind == GM_TRACE_PROFILE || trace->kind == GM_TRACE_HELIX;
    if (!known || trace->position == NULL || trace->deviation == NULL || trace->count < 1) {
        return gmi_error_set(
            map->error, GM_IO_ERR_FORMAT, 0,
            "a trace: must be a profile or helix, with points (got kind %d with %d points)",
            trace->kind, trace->count);
    }

    /* One point is no polygon: neighbouring rows do not agree where the trace lies. */
    if (trace->count < 2) {
        char name[GMI_TRACE_NAME_SIZE];
        return gmi_error_set(
            map->error, GM_IO_ERR_FORMAT, line_of(trace, 0),
            "%s: must be at least 2 rows that stand together, all at the same %s (got 1)",
            gmi_trace_name(name, trace),
            trace->kind == GM_TRACE_PROFILE ? "distance from the datum face"
                                            : "roll length or diameter");
    }

    /* Positions must rise, so that t can be searched. */
    for (int i = 0; i < trace->count; ++i) {
        const int rises = i == 0 || trace->position[i] > trace->position[i - 1];
        if (!is_sane(trace->deviation[i]) || !is_sane(trace->position[i]) || !is_sane(trace->at) ||
            !rises) {
            char name[GMI_TRACE_NAME_SIZE];
            return gmi_error_set(map->error, GM_IO_ERR_FORMAT, line_of(trace, i),
                                 "%s: must have rising positions and values of a gear (got one "
                                 "that is not finite, beyond 1 km, or does not rise)",
                                 gmi_trace_name(name, trace));
        }
    }
    return GM_IO_OK;
}

/* Where a trace lies: t1 of a profile, t2 of a helix. */
static int map_place(const gmi_mapping *map, const gm_trace *trace, double *at) {
    if (trace->kind == GM_TRACE_PROFILE) {
        *at = face_place(map, trace->at);
        return is_on_face(*at) ? GM_IO_OK : fail_face(map, trace, 0, trace->at, trace->at);
    }

    /* A helix must lie on the active profile. */
    *at = gmi_profile_place(map->gear, trace->at);
    if (*at >= -overrun && *at <= 1.0 + overrun) {
        return GM_IO_OK;
    }
    if (*at > 0.0) {
        return fail_roll(map, trace, 0, trace->at, trace->at);
    }

    /* Below the start of the active profile no flank is modelled. */
    char name[GMI_TRACE_NAME_SIZE];
    char got[GMI_NUMBER_SIZE];
    char low[GMI_NUMBER_SIZE];
    char high[GMI_NUMBER_SIZE];
    return gmi_error_set(
        map->error, GM_IO_ERR_FORMAT, line_of(trace, 0),
        "%s: must be on the active profile, at a roll length of %s to %s mm (got %s mm)",
        gmi_trace_name(name, trace), gmi_number_text(low, map->gear->start_roll_length, 3, 7),
        gmi_number_text(high, map->gear->tip_roll_length, 3, 7),
        gmi_number_text(got, trace->at, 3, 7));
}

/*
 * Which points of a trace [begin, end) there are up to the tip form circle; a chamfer behind it is no flank. Roll lengths
 * rise along the trace, to the tip of an external gear and from that of a ring.
 */
static void find_below_chamfer(const gmi_mapping *map, const gm_trace *trace, int *begin,
                               int *end) {
    const double form_radius = 0.5 * map->options->tip_form_diameter;
    *begin = 0;
    *end = trace->count;
    if (trace->kind != GM_TRACE_PROFILE || isnan(form_radius)) {
        return;
    }

    const double form = gmi_roll_length(form_radius, map->gear->base_radius);
    if (is_ring(map->gear)) {
        while (*begin < *end && trace->position[*begin] < form) {
            ++*begin;
        }
    } else {
        while (*end > *begin && trace->position[*end - 1] > form) {
            --*end;
        }
    }
    map->report->chamfer_points += trace->count - (*end - *begin);
}

static int fail_chamfer(const gmi_mapping *map, const gm_trace *trace) {
    char name[GMI_TRACE_NAME_SIZE];
    char diameter[GMI_NUMBER_SIZE];
    gmi_error_option(map->error, "tip_form_diameter");
    return gmi_error_set(map->error, GM_IO_ERR_FORMAT, line_of(trace, 0),
                         "%s: must have points up to the tip form circle (got none %s %s mm)",
                         gmi_trace_name(name, trace), is_ring(map->gear) ? "outside" : "below",
                         gmi_number_text(diameter, map->options->tip_form_diameter, 3, 7));
}

/* Points of a trace as t and deviation along the normal. */
static int map_points(const gmi_mapping *map, const gm_trace *trace, gmi_measured *to) {
    /* Material added is > 0, whatever the sign of the probe; transverse deviations are turned into normal ones. */
    const double sign = map->options->probe_sign && trace->flank == GM_LEFT ? -1.0 : 1.0;
    const double scale =
        sign * (map->measurement->transverse ? 1.0 / map->pair->normal_to_transverse : 1.0);
    const double reach = trace->position[trace->count - 1];
    int begin = 0;
    int end = 0;
    find_below_chamfer(map, trace, &begin, &end);
    to->count = end - begin;
    if (to->count < 2) {
        return fail_chamfer(map, trace);
    }

    /* Each point must lie on the active flank; t grows from the start to the tip and from face I to face II. */
    for (int i = begin; i < end; ++i) {
        const double position = trace->position[i];
        const int place = to->turned ? end - 1 - i : i - begin;
        if (trace->kind == GM_TRACE_PROFILE) {
            if (!is_on_profile(map, position)) {
                if (gmi_profile_place(map->gear, position) > 1.0) { /* perhaps on a chamfer */
                    gmi_error_option(map->error, "tip_form_diameter");
                }
                return fail_roll(map, trace, i, position, reach);
            }
            to->t[place] = gmi_profile_place(map->gear, position);
        } else {
            to->t[place] = face_place(map, position);
            if (!is_on_face(to->t[place])) {
                return fail_face(map, trace, i, position, reach);
            }
        }

        to->value[place] = scale * trace->deviation[i];
    }
    return GM_IO_OK;
}

/* The length in the file that t stands for: what map_points() has done, undone. */
static double length_of(const gmi_mapping *map, const gmi_measured *trace, double t) {
    const gm_gear *gear = map->gear;
    if (trace->kind == GM_TRACE_PROFILE) {
        return gear->start_roll_length + t * (gear->tip_roll_length - gear->start_roll_length);
    }
    return (trace->turned ? 1.0 - t : t) * gear->face_width;
}

/* What a trace leaves out at its ends is held, up to a limit. */
static int check_cover(const gmi_mapping *map, const gmi_measured *trace) {
    const double from = trace->t[0];
    const double to = trace->t[trace->count - 1];
    const double limit = map->options->held_limit;
    if (from <= limit && to >= 1.0 - limit) {
        return GM_IO_OK;
    }

    /* The message gives the lengths as they stand in the file, of the points that are left, and of a flank rising. */
    const double first = length_of(map, trace, trace->turned ? to : from);
    const double last = length_of(map, trace, trace->turned ? from : to);
    const gm_trace *raw = trace->from;
    const int profile = raw->kind == GM_TRACE_PROFILE;
    const double least = profile ? length_of(map, trace, trace->turned ? 1.0 : 0.0) : 0.0;
    const double full =
        profile ? length_of(map, trace, trace->turned ? 0.0 : 1.0) : map->gear->face_width;

    char name[GMI_TRACE_NAME_SIZE];
    char got[2][GMI_NUMBER_SIZE];
    char right[2][GMI_NUMBER_SIZE];
    char share[GMI_NUMBER_SIZE];
    if (from <= GMI_MOST_HELD && to >= 1.0 - GMI_MOST_HELD) { /* else no limit helps */
        gmi_error_option(map->error, "held_limit");
    }
    return gmi_error_set(
        map->error, GM_IO_ERR_FORMAT, gmi_measured_line(trace),
        "%s: must reach from %s to %s mm %s, of which %s may be missing at either end (got %s to "
        "%s mm)%s",
        gmi_trace_name(name, raw), gmi_number_text(right[0], least, 3, 5),
        gmi_number_text(right[1], full, 3, 5), profile ? "roll length" : "from the datum face",
        gmi_number_text(share, limit, 0, 3), gmi_number_text(got[0], first, 3, 5),
        gmi_number_text(got[1], last, 3, 5), gmi_length_hint(last, full));
}

static int map_trace(const gmi_mapping *map, const gm_trace *trace, gmi_measured *to) {
    to->from = trace;
    to->kind = trace->kind;
    to->count = trace->count;

    /* Positions rise, and t with them but for helices from face II and profiles of a ring, whose tip is its smallest. */
    to->turned = trace->kind == GM_TRACE_HELIX ? map->measurement->datum_face == GM_FACE_II
                                               : is_ring(map->gear);

    /* Which tooth and flank, and where on it. */
    int status =
        gmi_measurement_place(map->measurement, map->pair, map->wheel, trace->tooth, trace->flank,
                              line_of(trace, 0), &to->tooth, &to->side, map->error);
    if (status == GM_IO_OK) {
        status = map_place(map, trace, &to->at);
    }

    /* Its points; what is left without those that were filled in, and without spikes, has to cover the flank. */
    if (status == GM_IO_OK) {
        status = map_points(map, trace, to);
    }
    if (status == GM_IO_OK) {
        status = gmi_remove_filled(to, map->options, map->work, map->report, map->error);
    }
    if (status == GM_IO_OK) {
        status = gmi_remove_spikes(to, map->options, map->work, map->report, map->error);
    }
    return status == GM_IO_OK ? check_cover(map, to) : status;
}

static int allocate(gmi_mapping *map, const gm_traces *traces) {
    size_t all = 0;
    size_t longest = 0;
    for (int i = 0; i < traces->count; ++i) {
        const size_t count = (size_t)traces->traces[i].count;
        all += count;
        longest = count > longest ? count : longest;
    }
    map->measured = calloc((size_t)traces->count, sizeof *map->measured);
    map->points = malloc(2 * all * sizeof *map->points);
    map->work = malloc(4 * longest * sizeof *map->work);
    return map->measured && map->points && map->work ? GM_IO_OK : gmi_error_memory(map->error);
}

int gmi_traces_map(gmi_mapping *map, const gm_traces *traces) {
    int status = GM_IO_OK;
    for (int i = 0; i < traces->count && status == GM_IO_OK; ++i) {
        status = check_structure(map, &traces->traces[i]);
    }
    if (status == GM_IO_OK) {
        status = allocate(map, traces);
    }

    double *points = map->points;
    for (int i = 0; i < traces->count && status == GM_IO_OK; ++i) {
        const gm_trace *trace = &traces->traces[i];
        map->measured[i].t = points;
        map->measured[i].value = points + trace->count;
        points += 2 * (size_t)trace->count;
        status = map_trace(map, trace, &map->measured[i]);
    }
    return status;
}

void gmi_mapping_free(gmi_mapping *map) {
    free(map->measured);
    free(map->points);
    free(map->work);
    map->measured = NULL;
    map->points = map->work = NULL;
}
