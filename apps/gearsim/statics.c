/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Loaded transmission error: at each pinion angle the position in which the flanks carry the mean load.
 */
#include "statics.h"
#include "interrupt.h"
#include "output.h"
#include "static_columns.h"

#include <math.h>

static const double two_pi = 6.283185307179586;

/* Tooth passes in the period. */
static double tooth_passes(const config *conf, const gm_pair *pair) {
    switch (conf->period) {
    case PERIOD_PINION:
        return pair->pinion.teeth;
    case PERIOD_HUNTING:
        return pair->hunting_passes;
    case PERIOD_MESH:
    default:
        return 1.0;
    }
}

/* From a fraction of whole numbers, so that no error adds up along the period. */
static double pinion_angle(const config *conf, const gm_pair *pair, int position) {
    return two_pi * (tooth_passes(conf, pair) * position) /
           ((double)conf->positions * pair->pinion.teeth);
}

/* The ends exactly as given. */
static double load_of(const config *conf, int index) {
    const double share = conf->loads > 1 ? (double)index / (conf->loads - 1) : 0.0;

    return share > 0.0 ? (1.0 - share) * conf->mean_load + share * conf->end_load : conf->mean_load;
}

/* A period under one load: where the position before was in equilibrium, and how it goes on from there. */
typedef struct sweep {
    double load;   /* (N m) */
    double angle;  /* (rad) */
    double offset; /* (m), NaN = not known yet */
    double slope;  /* its derivative by the pinion angle (m/rad) */
} sweep;

static int find_wrench(const gear_mesh *gears, static_position *position) {
    gm_position at;
    gm_mesh_result result;
    int status = gm_position_from_pinion_angle(&gears->pair, position->pinion_angle,
                                               position->offset, 0.0, &at);
    if (status == GM_OK) {
        status = gm_mesh_evaluate_at(gears->prepared, &at, GM_WANT_WRENCH, NULL, &result);
    }
    position->mesh.wrench = result.wrench;
    return status;
}

static int write_position(const config *conf, const gear_mesh *gears, double angle, sweep *before,
                          output_file *output, int *status) {
    const gm_pair *pair = &gears->pair;
    const double guess = before->offset + before->slope * (angle - before->angle);
    static_position position = {
        .conf = conf, .gears = gears, .pinion_angle = angle, .load = before->load};

    *status = gm_static_equilibrium(gears->prepared, angle, before->load, guess, NULL,
                                    &position.offset, &position.mesh);
    if (*status != GM_OK) {
        return EXIT_RUN_FAILED;
    }

    /* Along the curve of constant force, for the guess at the next position. */
    before->angle = angle;
    before->offset = position.offset;
    before->slope = pair->pinion.base_radius + pair->wheel.base_radius *
                                                   position.mesh.force_by.pinion_angle /
                                                   position.mesh.force_by.wheel_angle;

    /* The columns that are there; the equilibrium has no wrench. */
    double values[COLUMNS_MAX];
    int count = 0, has_wrench = 0;
    for (int i = 0; i < static_column_count; ++i) {
        if (!static_column_is_there(conf, i)) {
            continue;
        }
        if (static_columns[i].is_of_wrench && output_wants(output, count) && !has_wrench) {
            *status = find_wrench(gears, &position);
            if (*status != GM_OK) {
                return EXIT_RUN_FAILED;
            }
            has_wrench = 1;
        }
        values[count++] = static_columns[i].value(&position);
    }
    return output_row(output, values);
}

/* Which position a message is about. */
enum { PLACE_SIZE = 96 };
static const char *place_text(char text[PLACE_SIZE], double load, double angle) {
    snprintf(text, PLACE_SIZE, "at a pinion angle of %.9g rad under %.9g N m", angle, load);
    return text;
}

/* Why a position could not be written, as a message and in the file. */
static int fail(const config *conf, output_file *output, double load, double angle, int status) {
    char place[PLACE_SIZE];
    char why[256];

    place_text(place, load, angle);
    if (status == GM_OK) {
        snprintf(why, sizeof why, "the disk took no more %s", place);
    } else {
        snprintf(why, sizeof why, "no equilibrium %s: %s", place, gm_status_text(status));
    }
    message_of_program(conf->messages, "%s", why);
    output_close(output, why);
    return EXIT_RUN_FAILED;
}

static int interrupted(const config *conf, output_file *output, double load, double angle) {
    char place[PLACE_SIZE];
    char why[128];

    snprintf(why, sizeof why, "interrupted %s", place_text(place, load, angle));
    message_of_program(conf->messages, "%s", why);
    output_close(output, why);
    return EXIT_INTERRUPTED;
}

/* The period under one load; 0, or an exit code and the file is closed. */
static int write_period(const config *conf, const gear_mesh *gears, double load,
                        output_file *output) {
    sweep before = {load, 0.0, (double)NAN, 0.0};

    for (int position = 0; position < conf->positions; ++position) {
        const double angle = pinion_angle(conf, &gears->pair, position);
        int status;

        if (interrupt_requested()) {
            return interrupted(conf, output, load, angle);
        }
        if (write_position(conf, gears, angle, &before, output, &status) != 0) {
            return fail(conf, output, load, angle, status);
        }
    }
    return 0;
}

static int write_all(const config *conf, const gear_mesh *gears, output_file *output) {
    for (int index = 0; index < conf->loads; ++index) {
        const int exit_code = write_period(conf, gears, load_of(conf, index), output);
        if (exit_code != 0) {
            return exit_code;
        }
    }
    return output_close(output, NULL);
}

double statics_rows(const config *conf) {
    return (double)conf->loads * conf->positions;
}

int statics_run(const config *conf, const gear_mesh *gears) {
    const column_names names = static_column_names(conf);
    int exit_code = 0;

    interrupt_watch(SECOND_KILLS);
    output_file *output = output_open(conf, names.name, names.count, &exit_code);
    if (output != NULL) {
        exit_code = write_all(conf, gears, output);
    }
    interrupt_unwatch();
    return exit_code;
}
