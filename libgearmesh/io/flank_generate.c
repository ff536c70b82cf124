/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Flanks from random numbers: options, memory, waves. What they are to be is a class (flank_generate_class.c) or
 * amounts that scatter (flank_generate_scatter.c).
 *
 * Same flanks on every machine: integers, + - * / and sqrt only, and a sine of its own. What the pair derives with
 * those of the C library is wiped out by rounding to 1e-10 m.
 */

#include "flank_generate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "flank_slot.h"
#include "io_error.h"

static const double pi = 3.14159265358979323846;

/* Limits of the waves. */
enum { MOST_WAVES = 100, MOST_ORDER = 1000000 };

void gm_generate_options_default(gm_generate_options *options) {
    if (options != NULL) {
        memset(options, 0, sizeof *options);
        options->seed = 1;
        options->share = 0.95;
        options->face_nodes = 21;
        options->profile_nodes = 31;
        options->waves = NULL;
    }
}

/* ---------------------------------------------------------------------------------------------
 * Waves
 * ------------------------------------------------------------------------------------------- */

/*
 * Turns of the gear at which a point of a flank comes into contact, less a constant and with the opposite
 * sign. Forward rotation moves the contact of pinion drive and wheel coast flanks to the tip, that of the
 * others to the root.
 */
static double contact_turns(const gmi_generator *make, int tooth, int side, double t1, double t2) {
    const gm_gear *gear = make->gear;
    const double rho =
        gear->start_roll_length + t2 * (gear->tip_roll_length - gear->start_roll_length);
    const double roll = (side == GM_DRIVE) == !make->wheel ? -rho : rho;
    return (double)tooth / gear->teeth +
           (roll + t1 * make->pair->face_advance) / (2.0 * pi * gear->base_radius);
}

/* From a stream of their own, so that a wave leaves all else as it is. */
static void draw_phases(const gmi_generator *make) {
    gmi_random start = make->random;
    gmi_random own = {gmi_random_bits(&start)};
    for (int i = 0; i < 2 * make->options->wave_count; i++) {
        make->wave_phase[i] = gmi_random_uniform(&own, 0.0, 1.0);
    }
}

void gmi_waves_fill(const gmi_generator *make, const gm_deviation_set *set) {
    const int face_nodes = make->options->face_nodes;
    const int profile_nodes = make->options->profile_nodes;
    for (int node = 0; node < face_nodes * profile_nodes; node++) {
        const double t1 = (double)(node / profile_nodes) / (face_nodes - 1);
        const double t2 = (double)(node % profile_nodes) / (profile_nodes - 1);
        const double turns = contact_turns(make, set->tooth, set->side, t1, t2);
        set->values[node] = 0.0;
        for (int i = 0; i < make->options->wave_count; i++) {
            const gm_flank_wave *wave = &make->options->waves[i];
            const double phase = make->wave_phase[2 * i + set->side];
            set->values[node] += wave->amplitude * gmi_sine_of_turns(wave->order * turns + phase);
        }
    }
}

static int check_resolution(const gmi_generator *make, const char *axis, double length, int nodes,
                            int order) {
    const double waves = order * fabs(length) / (2.0 * pi * make->gear->base_radius);
    if (nodes - 1 >= GMI_NODES_PER_WAVE * waves) {
        return GM_IO_OK;
    }
    return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                         "order %d makes %ld waves along %s, too many for %d nodes; %d nodes per "
                         "wave are right",
                         order, (long)waves + 1, axis, nodes, GMI_NODES_PER_WAVE);
}

static int check_waves(const gmi_generator *make) {
    const gm_generate_options *options = make->options;
    if (options->wave_count < 0 || options->wave_count > MOST_WAVES ||
        (options->wave_count > 0 && options->waves == NULL)) {
        return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0, "%d waves; 0 to %d are right",
                             options->wave_count, MOST_WAVES);
    }
    int status = GM_IO_OK;
    for (int i = 0; status == GM_IO_OK && i < options->wave_count; i++) {
        const gm_flank_wave *wave = &options->waves[i];
        if (wave->order < 1 || wave->order > MOST_ORDER) {
            return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                                 "a wave of order %d; 1 to %d are right", wave->order, MOST_ORDER);
        }
        if (!(wave->amplitude >= 0.0) || !isfinite(wave->amplitude)) {
            return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                                 "the amplitude of a wave must be finite and not below 0");
        }
        status = check_resolution(make, "t1", make->pair->face_advance, options->face_nodes,
                                  wave->order);
        if (status == GM_IO_OK) {
            status = check_resolution(make, "t2",
                                      make->gear->tip_roll_length - make->gear->start_roll_length,
                                      options->profile_nodes, wave->order);
        }
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * Memory, checks, and the call
 * ------------------------------------------------------------------------------------------- */

static int allocate_deviations(gmi_generator *make) {
    gm_deviations *deviations = make->deviations;
    const size_t nodes = (size_t)make->options->face_nodes * (size_t)make->options->profile_nodes;
    const size_t flanks = 2 * (size_t)make->gear->teeth;
    deviations->teeth = make->gear->teeth;
    deviations->face_nodes = make->options->face_nodes;
    deviations->profile_nodes = make->options->profile_nodes;
    deviations->sets = calloc(flanks, sizeof *deviations->sets);
    if (deviations->sets == NULL) {
        return gmi_error_memory(make->error);
    }
    for (size_t i = 0; i < flanks; i++) {
        gm_deviation_set *set = &deviations->sets[i];
        set->tooth = (int)(i / 2);
        set->side = i % 2 == 0 ? GM_DRIVE : GM_COAST;
        set->values = malloc(nodes * sizeof *set->values);
        deviations->set_count++;
        if (set->values == NULL) {
            return gmi_error_memory(make->error);
        }
    }
    return GM_IO_OK;
}

static int allocate_pitch(gmi_generator *make) {
    gm_pitch *pitch = make->pitch;
    const size_t teeth = (size_t)make->gear->teeth;
    pitch->teeth = make->gear->teeth;
    pitch->drive = malloc(teeth * sizeof *pitch->drive);
    pitch->coast = malloc(teeth * sizeof *pitch->coast);
    pitch->drive_set = malloc(teeth * sizeof *pitch->drive_set);
    pitch->coast_set = malloc(teeth * sizeof *pitch->coast_set);
    return pitch->drive && pitch->coast && pitch->drive_set && pitch->coast_set
               ? GM_IO_OK
               : gmi_error_memory(make->error);
}

static int allocate(gmi_generator *make) {
    const size_t pitch_work = 3 * (size_t)make->gear->teeth;
    const size_t trace_work = 6 * (size_t)GMI_MOST_NODES;
    const size_t work = pitch_work > trace_work ? pitch_work : trace_work;
    int status = allocate_deviations(make);
    if (status == GM_IO_OK) {
        status = allocate_pitch(make);
    }
    if (status == GM_IO_OK) {
        make->work = malloc(work * sizeof *make->work);
        make->wave_phase =
            malloc((2 * (size_t)make->options->wave_count + 1) * sizeof *make->wave_phase);
        status = make->work && make->wave_phase ? GM_IO_OK : gmi_error_memory(make->error);
    }
    return status;
}

static int check_options(const gmi_generator *make) {
    const gm_generate_options *options = make->options;
    if (options->face_nodes < GMI_LEAST_NODES || options->face_nodes > GMI_MOST_NODES ||
        options->profile_nodes < GMI_LEAST_NODES || options->profile_nodes > GMI_MOST_NODES) {
        return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                             "a grid of %d x %d nodes; %d to %d each way are right",
                             options->face_nodes, options->profile_nodes, GMI_LEAST_NODES,
                             GMI_MOST_NODES);
    }
    int status = gmi_check_teeth(make->gear->teeth, make->error);
    if (status == GM_IO_OK) {
        status = options->scatter != NULL ? gmi_scatter_check(make) : gmi_class_check(make);
    }
    return status == GM_IO_OK ? check_waves(make) : status;
}

static int fill(gmi_generator *make) {
    draw_phases(make);
    if (make->options->scatter == NULL) {
        return gmi_class_fill(make);
    }
    gmi_scatter_fill(make);
    return GM_IO_OK;
}

static void clear(gm_deviations *deviations, gm_pitch *pitch) {
    if (deviations != NULL) {
        memset(deviations, 0, sizeof *deviations);
    }
    if (pitch != NULL) {
        memset(pitch, 0, sizeof *pitch);
    }
}

int gm_flanks_generate(gm_deviations *deviations, gm_pitch *pitch, const gm_pair *pair, int wheel,
                       const gm_generate_options *options, gm_io_error *error) {
    gmi_error_begin(error, NULL);
    clear(deviations, pitch);
    if (deviations == NULL || pitch == NULL || pair == NULL || options == NULL) {
        return gmi_error_set(error, GM_IO_ERR_NULL, 0, "a required pointer is NULL");
    }
    gmi_generator make = {.deviations = deviations,
                          .pitch = pitch,
                          .pair = pair,
                          .gear = wheel ? &pair->wheel : &pair->pinion,
                          .wheel = wheel != 0,
                          .options = options,
                          .random = {wheel ? ~options->seed : options->seed},
                          .error = error};
    int status = check_options(&make);
    if (status == GM_IO_OK) {
        status = allocate(&make);
    }
    if (status == GM_IO_OK) {
        status = fill(&make);
    }
    free(make.work);
    free(make.wave_phase);
    if (status != GM_IO_OK) {
        gm_deviations_free(deviations);
        gm_pitch_free(pitch);
    }
    return status;
}
