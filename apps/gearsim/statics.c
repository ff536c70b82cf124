/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Loaded transmission error: at each pinion angle the position in which the flanks carry the mean load.
 */
#include "statics.h"
#include "gear_contact.h"
#include "load_file.h"
#include "memory.h"
#include "output.h"
#include "platform.h"
#include "static_columns.h"
#include "te_slopes.h"

#include <math.h>
#include <stdlib.h>

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

/* A step of the loads from one side of the backlash to the other may be 0, up to a rounding. */
static int is_no_load(const config *conf, int index) {
    const double largest =
        conf->loads > 1 ? fmax(fabs(conf->mean_load), fabs(conf->end_load)) : 0.0;

    return fabs(load_of(conf, index)) <= 1e-12 * largest;
}

/* Where a position was in equilibrium, and how it goes on from there. */
typedef struct known_position {
    double angle;  /* (rad) */
    double offset; /* (m), NaN = not known yet */
    double slope;  /* its derivative by the pinion angle (m/rad) */
} known_position;

/* A period under one load: the last two positions, and which guess would have been the better one at the last. */
typedef struct sweep {
    double load; /* (N m) */
    known_position last, before;
    int bends; /* tables do; ideal flanks and elastic teeth begin as well along the slope */
    int is_cubic;
    double
        stiffening; /* how the slope of the torque over x changes with x, at the last position (N/m) */
} sweep;

/* What of an equilibrium is kept until its row is written. */
typedef struct found_state {
    double offset; /* (m), NaN = not found */
    double loss;   /* (W) */
    gm_penetration contact;
} found_state;

/* Where rows go. */
typedef struct static_results {
    output_file *output;
    load_file *distribution;    /* NULL = none */
    gm_line_load_point *points; /* of one position */
    int capacity;
    te_slopes slopes;        /* columns behind those below */
    int first_slope;         /* their first place */
    int columns;             /* that are asked for */
    int column[COLUMNS_MAX]; /* their rows in static_columns */
    int place[COLUMNS_MAX];  /* where output_row() takes their values from */
    unsigned needs;          /* bits 1 << enum static_column_taking of all that is written */
    gm_line_loads worst;     /* the load with the largest pressure that was seen */
} static_results;

/* Bits of what a column takes; with constant stiffness the sums tell the length of contact. */
static unsigned need_of(const config *conf, enum static_column_taking taking) {
    if (taking == TAKES_WIDTH) {
        taking = conf->law == LAW_ELASTIC ? TAKES_FACES : TAKES_NOTHING;
    }
    return 1u << taking;
}

/* What of a position goes to the result, and what has to be found for it beyond the equilibrium. */
static void choose_columns(static_results *results, const config *conf) {
    results->needs = results->distribution != NULL ? 1u << TAKES_FACES : 0;

    /* The output counts those that these gears have. */
    int place = 0;
    for (int i = 0; i < static_column_count; ++i) {
        if (!static_column_is_there(conf, i)) {
            continue;
        }
        if (output_wants(results->output, place)) {
            results->column[results->columns] = i;
            results->place[results->columns++] = place;
            results->needs |= need_of(conf, static_columns[i].taking);
        }
        ++place;
    }
    results->first_slope = place;
}

/* The equilibrium itself has neither wrench nor energy nor line loads. */
static int find_needed(static_results *results, unsigned needs, static_position *at) {
    const unsigned faces = 1u << TAKES_FACES;
    const int wanted = (needs & 1u << TAKES_WRENCH ? GM_WANT_WRENCH : 0) |
                       (needs & 1u << TAKES_ENERGY ? GM_WANT_ENERGY : 0);
    gm_position position;
    gm_mesh_result result;
    if (wanted == 0 && (needs & faces) == 0) {
        return GM_OK;
    }

    /* The place again, with the speed that friction depends on. */
    int status = gm_position_from_pinion_angle(&at->gears->pair, at->pinion_angle, at->offset, 0.0,
                                               &position);
    position.pinion_speed = at->conf->start_speed;

    /* Of the whole mesh, */
    if (status == GM_OK && wanted != 0) {
        status = gear_contact_evaluate(at->gears, &position, wanted, &result);
        at->mesh.wrench = result.wrench;
        at->mesh.energy = result.energy;
    }

    /* and along its lines of contact. */
    if (status == GM_OK && (needs & faces)) {
        status = gear_contact_line_loads(at->gears, &position, results->points, results->capacity,
                                         &at->faces);
        if (at->faces.largest_pressure > results->worst.largest_pressure) {
            results->worst = at->faces;
        }
    }
    return status;
}

/* How the transmission error moves with the modifications that are asked for. */
static int find_slopes(const static_results *results, const static_position *at, double *te_by) {
    gm_position position;
    if (results->slopes.count == 0) {
        return GM_OK;
    }
    const int status = gm_position_from_pinion_angle(&at->gears->pair, at->pinion_angle, at->offset,
                                                     0.0, &position);
    return status != GM_OK
               ? status
               : te_slopes_find(&results->slopes, at->gears, &position, &at->mesh, te_by);
}

/* What the cubic through both positions with their slopes is beyond the slope of the last one, by divided differences. */
static double bend_of(const sweep *known, double on) {
    const known_position *last = &known->last, *before = &known->before;
    const double per_step = 1.0 / (last->angle - before->angle);
    const double mean = (last->offset - before->offset) * per_step;
    const double bend = (last->slope - mean) * per_step;
    const double before_bend = (mean - before->slope) * per_step;

    return on * on * (bend + (1.0 + on * per_step) * (bend - before_bend));
}

/* Of the torque over x (N). */
static double torque_slope(const gm_pair *pair, const gm_mesh_result *mesh) {
    return -mesh->wheel_torque_by.wheel_angle / pair->wheel.base_radius;
}

/*
 * Newton's step from a guess, with the bend of the torque over x as it was at the position before: it changes by a twentieth from
 * one close position to the next, so that the step is twenty times better. Returns the guess where it cannot be evaluated.
 */
static double step_from(const gear_mesh *gears, const sweep *known, const static_position *at,
                        double guess, double *slope) {
    gm_position position;
    gm_mesh_result mesh;
    int status =
        gm_position_from_pinion_angle(&gears->pair, at->pinion_angle, guess, 0.0, &position);

    *slope = (double)NAN;
    position.pinion_speed = at->conf->start_speed;
    if (status == GM_OK) {
        status = gear_contact_evaluate(gears, &position, GM_WANT_DERIVATIVES, &mesh);
    }
    if (status != GM_OK) {
        return guess;
    }

    /* missing = slope step + stiffening step^2 / 2, from the straight line on; a bend of more than a part is none to count on. */
    *slope = torque_slope(&gears->pair, &mesh);
    const double straight = (known->load - mesh.wheel_torque) / *slope;
    const double bent = 0.5 * known->stiffening / *slope * straight;
    const double share = fabs(bent) < 0.1 ? 1.0 - bent * (1.0 - 2.0 * bent) : 1.0;
    return guess + share * straight;
}

/* The equilibrium, from the positions before: close positions follow a cubic, others at best the slope. */
static int find_position(const gear_mesh *gears, sweep *known, static_position *position) {
    const gm_pair *pair = &gears->pair;
    const double angle = position->pinion_angle;
    const double on = angle - known->last.angle;
    const double straight = known->last.offset + known->last.slope * on;
    const double cubic = known->bends ? straight + bend_of(known, on) : straight;

    /* From the better guess, with what the position before knows of the torque. */
    const double first = known->is_cubic ? cubic : straight;
    double first_slope = (double)NAN;
    const double guess = known->bends && !isnan(first)
                             ? step_from(gears, known, position, first, &first_slope)
                             : first;
    const int status =
        gear_contact_equilibrium(gears, angle, position->conf->start_speed, known->load, guess,
                                 &position->offset, &position->mesh);

    /* Along the curve of constant torque, for the guess at the next position. */
    if (known->bends) {
        const double change = torque_slope(pair, &position->mesh) - first_slope;
        const double stiffening = change / (position->offset - first);
        known->stiffening = isfinite(stiffening) ? stiffening : 0.0;
        known->is_cubic = fabs(position->offset - cubic) < fabs(position->offset - straight);
        known->before = known->last;
    }
    known->last.angle = angle;
    known->last.offset = position->offset;
    known->last.slope = pair->pinion.base_radius + pair->wheel.base_radius *
                                                       position->mesh.wheel_torque_by.pinion_angle /
                                                       position->mesh.wheel_torque_by.wheel_angle;
    return status;
}

/* state: what has been found there; NULL = nothing yet. */
static int write_position(const config *conf, const gear_mesh *gears, double angle,
                          const found_state *state, sweep *known, static_results *results,
                          int *status) {
    /* The pressure of elastic teeth is looked at under each load at least once. */
    const int is_first = isnan(known->last.offset) && conf->law == LAW_ELASTIC;
    const unsigned needs = results->needs | (is_first ? 1u << TAKES_FACES : 0);
    static_position position = {
        .conf = conf, .gears = gears, .pinion_angle = angle, .load = known->load};

    /* The equilibrium, if it is not known from all loads of the position at once. */
    if (state != NULL && !isnan(state->offset)) {
        position.offset = state->offset;
        position.mesh.contact = state->contact;
        position.mesh.loss = state->loss;
    } else {
        *status = find_position(gears, known, &position);
        if (*status != GM_OK) {
            return EXIT_RUN_FAILED;
        }
    }
    position.apex = gear_contact_apex(gears);

    /* What columns show beyond it. */
    *status = find_needed(results, needs, &position);
    if (*status != GM_OK) {
        return EXIT_RUN_FAILED;
    }
    double values[COLUMNS_MAX];
    *status = find_slopes(results, &position, values + results->first_slope);
    if (*status != GM_OK) {
        return EXIT_RUN_FAILED;
    }

    /* The row, and those of the load distribution. */
    for (int i = 0; i < results->columns; ++i) {
        values[results->place[i]] = static_columns[results->column[i]].value(&position);
    }
    if (load_file_rows(results->distribution, angle, known->load, results->points,
                       position.faces.points) != 0) {
        return EXIT_RUN_FAILED;
    }
    return output_row(results->output, values);
}

/* Which position a message is about. */
enum { PLACE_SIZE = 96 };
static const char *place_text(char text[PLACE_SIZE], double load, double angle) {
    snprintf(text, PLACE_SIZE, "at a pinion angle of %.9g rad under %.9g N m", angle, load);
    return text;
}

/* Why a position could not be written, as a message and in the file. */
static int fail(const config *conf, const static_results *results, double load, double angle,
                int status) {
    char place[PLACE_SIZE];
    char why[256];

    place_text(place, load, angle);
    if (status == GM_OK) {
        snprintf(why, sizeof why, "the disk took no more %s", place);
    } else {
        snprintf(why, sizeof why, "no equilibrium %s: %s", place, gm_status_text(status));
    }
    message_of_program(conf->messages, "%s", why);
    output_close(results->output, why);
    load_file_close(results->distribution, why);
    return EXIT_RUN_FAILED;
}

static int interrupted(const config *conf, const static_results *results, double load,
                       double angle) {
    char place[PLACE_SIZE];
    char why[128];

    snprintf(why, sizeof why, "interrupted %s", place_text(place, load, angle));
    message_of_program(conf->messages, "%s", why);
    output_close(results->output, why);
    load_file_close(results->distribution, why);
    return EXIT_INTERRUPTED;
}

/*
 * Equilibria under several loads at all positions: what all loads of a position have in common is done once, although
 * their rows are far apart.
 */
typedef struct load_block {
    int loads;              /* side by side at most; 0 = each load for itself */
    found_state *state;     /* [loads][positions] */
    double *torque;         /* [loads] at one position (N m) */
    double *offset;         /* [loads] (m) */
    gm_mesh_result *result; /* [loads] */
} load_block;

/* Loads side by side that pay, and bytes of what is kept of them at most. */
enum { LEAST_LOADS = 4, MOST_BYTES = 1 << 24 };

/* With as many loads as have room. 0, or an exit code after a message. */
static int load_block_open(load_block *block, const config *conf, const gear_mesh *gears) {
    const double room = (double)MOST_BYTES / ((double)conf->positions * sizeof *block->state);
    const int loads = (int)fmin(room, conf->loads);

    /* Elastic teeth begin best from the position before, and so does a pinion that floats; ideal flanks need nothing. */
    if (loads < LEAST_LOADS || conf->law == LAW_ELASTIC || !isnan(conf->double_helical_gap) ||
        gear_contact_is_ideal(gears)) {
        return 0;
    }

    /* Closed by the caller, whether all of it was to be had or not. */
    block->loads = loads;
    block->state = allocate((size_t)loads * (size_t)conf->positions, sizeof *block->state);
    block->torque = allocate((size_t)loads, sizeof *block->torque);
    block->offset = allocate((size_t)loads, sizeof *block->offset);
    block->result = allocate((size_t)loads, sizeof *block->result);
    return block->state != NULL && block->torque != NULL && block->offset != NULL &&
                   block->result != NULL
               ? 0
               : message_no_memory(conf->messages);
}

static void load_block_close(load_block *block) {
    free(block->state);
    free(block->torque);
    free(block->offset);
    free(block->result);
}

/* The block that begins with load `first`, until the run is interrupted. */
static void load_block_fill(load_block *block, const config *conf, const gear_mesh *gears,
                            int first) {
    const int left = conf->loads - first;
    const int count = left < block->loads ? left : block->loads;
    for (int k = 0; k < count; ++k) {
        block->torque[k] = load_of(conf, first + k);
    }

    /* What is not found here is looked for, and told, when its row is due. */
    for (int position = 0; position < conf->positions && !interrupt_requested(); ++position) {
        (void)gear_contact_equilibria(gears, pinion_angle(conf, &gears->pair, position),
                                      conf->start_speed, block->torque, count, block->offset,
                                      block->result);
        for (int k = 0; k < count; ++k) {
            found_state *state =
                &block->state[(size_t)k * (size_t)conf->positions + (size_t)position];
            state->offset = block->offset[k];
            state->loss = block->result[k].loss;
            state->contact = block->result[k].contact;
        }
    }
}

/* Those of load `index` at all positions; NULL = none. */
static const found_state *states_under(load_block *block, const config *conf,
                                       const gear_mesh *gears, int index) {
    if (block->loads == 0) {
        return NULL;
    }
    if (index % block->loads == 0) {
        load_block_fill(block, conf, gears, index);
    }
    return block->state + (size_t)(index % block->loads) * (size_t)conf->positions;
}

/* The period under one load; 0, or an exit code and the file is closed. */
static int write_period(const config *conf, const gear_mesh *gears, double load,
                        const found_state *states, static_results *results) {
    const known_position none = {0.0, (double)NAN, 0.0};
    const int bends = conf->law != LAW_ELASTIC && !gear_contact_is_ideal(gears);
    sweep known = {load, none, none, bends, 0, 0.0};

    for (int position = 0; position < conf->positions; ++position) {
        const double angle = pinion_angle(conf, &gears->pair, position);
        int status;

        if (interrupt_requested()) {
            return interrupted(conf, results, load, angle);
        }
        const found_state *state = states != NULL ? &states[position] : NULL;
        if (write_position(conf, gears, angle, state, &known, results, &status) != 0) {
            return fail(conf, results, load, angle, status);
        }
    }
    return 0;
}

static int write_all(const config *conf, const gear_mesh *gears, load_block *block,
                     static_results *results) {
    for (int index = 0; index < conf->loads; ++index) {
        const found_state *states = states_under(block, conf, gears, index);
        if (is_no_load(conf, index)) {
            message_note(conf->messages,
                         "%s: note: no rows under the load of 0, which leaves the gears anywhere "
                         "in the backlash",
                         conf->path);
            continue;
        }
        const int exit_code = write_period(conf, gears, load_of(conf, index), states, results);
        if (exit_code != 0) {
            return exit_code;
        }
    }

    /* Both files get their names, or none: nothing may be left to write when the first name changes. */
    if (load_file_flush(results->distribution) != EXIT_DONE) {
        output_close(results->output, "the load distribution could not be written");
        load_file_close(results->distribution, "the disk took no more");
        return EXIT_RUN_FAILED;
    }
    const int exit_code =
        output_close_with(results->output, load_file_result(results->distribution));
    load_file_close(results->distribution,
                    exit_code != EXIT_DONE ? "the result could not be written" : NULL);
    return exit_code;
}

double statics_rows(const config *conf) {
    int loads = 0;
    for (int index = 0; index < conf->loads; ++index) {
        loads += !is_no_load(conf, index);
    }
    return (double)loads * conf->positions;
}

int statics_check(const config *conf, const gear_mesh *gears) {
    te_slopes slopes;
    const int status = te_slopes_open(&slopes, conf, gears);

    te_slopes_close(&slopes);
    return status != 0 ? status : load_file_check(conf);
}

/* What a run needs beside its equilibria. 0, or an exit code after a message. */
static int open_run(static_results *results, load_block *block, const config *conf,
                    const gear_mesh *gears) {
    int exit_code = load_file_open(&results->distribution, conf);

    /* Points of a position are kept where a file takes them. */
    if (exit_code == 0 && results->distribution != NULL) {
        results->capacity = gear_contact_line_load_points(gears);
        results->points = allocate((size_t)results->capacity, sizeof *results->points);
        exit_code = results->points != NULL ? 0 : message_no_memory(conf->messages);
    }

    /* Equilibria under several loads side by side, and what modifications do to them. */
    if (exit_code == 0) {
        exit_code = load_block_open(block, conf, gears);
    }
    if (exit_code == 0) {
        exit_code = te_slopes_open(&results->slopes, conf, gears);
    }
    return exit_code;
}

static void close_run(static_results *results, load_block *block) {
    te_slopes_close(&results->slopes);
    load_block_close(block);
    free(results->points);
}

int statics_run(const config *conf, const gear_mesh *gears) {
    const column_names names = static_column_names(conf);
    static_results results = {.distribution = NULL};
    load_block block = {.loads = 0};

    int exit_code = open_run(&results, &block, conf, gears);
    if (exit_code != 0) {
        load_file_close(results.distribution, "no rows");
        close_run(&results, &block);
        return exit_code;
    }

    /* The file of the load distribution is closed with the result, see write_all(). */
    interrupt_watch(SECOND_KILLS);
    results.output = output_open(conf, names.name, names.count, &exit_code);
    if (results.output != NULL) {
        choose_columns(&results, conf);
        exit_code = write_all(conf, gears, &block, &results);
        gear_contact_warn(conf, &results.worst);
    } else {
        load_file_close(results.distribution, "there is no result");
    }
    interrupt_unwatch();

    close_run(&results, &block);
    return exit_code;
}
