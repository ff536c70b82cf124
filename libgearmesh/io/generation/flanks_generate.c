/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Flanks from random numbers: options, memory, the call. What they are to be is a class (generate_class.c) or
 * amounts that scatter (generate_scatter.c).
 *
 * Same flanks on every machine: integers, + - * / and sqrt only, and a sine of its own. What the pair derives with
 * those of the C library is wiped out by rounding to 1e-10 m.
 */

#include <stdlib.h>
#include <string.h>

#include "files/flank_slot.h"
#include "files/io_error.h"
#include "files/pitch_file.h"
#include "generate_class.h"
#include "generate_scatter.h"
#include "generator.h"
#include "shared.h"
#include "waves.h"

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

    /* Tooth by tooth, drive before coast; what is allocated so far is counted, so that it can be freed. */
    for (size_t i = 0; i < flanks; ++i) {
        gm_deviation_set *set = &deviations->sets[i];
        set->tooth = (int)(i / 2);
        set->side = i % 2 == 0 ? GM_DRIVE : GM_COAST;
        set->values = malloc(nodes * sizeof *set->values);
        ++deviations->set_count;
        if (set->values == NULL) {
            return gmi_error_memory(make->error);
        }
    }
    return GM_IO_OK;
}

static int allocate(gmi_generator *make) {
    const size_t pitch_work = 3 * (size_t)make->gear->teeth;
    const size_t trace_work = 6 * (size_t)GMI_MOST_NODES;
    const size_t work = pitch_work > trace_work ? pitch_work : trace_work;
    int status = allocate_deviations(make);
    if (status == GM_IO_OK) {
        status = gmi_pitch_allocate(make->pitch, make->gear->teeth, make->error);
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
                             "nodes: must be %d to %d each way (got %d x %d)", GMI_LEAST_NODES,
                             GMI_MOST_NODES, options->face_nodes, options->profile_nodes);
    }
    int status = gmi_check_teeth(make->gear->teeth, make->error);
    if (status == GM_IO_OK) {
        status = options->scatter != NULL ? gmi_scatter_check(make) : gmi_class_check(make);
    }
    return status == GM_IO_OK ? gmi_waves_check(make) : status;
}

static int fill(gmi_generator *make) {
    gmi_waves_draw(make);
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
        return gmi_error_null(error);
    }

    /* The wheel of a seed has nothing in common with its pinion. */
    gmi_generator make = {.deviations = deviations,
                          .pitch = pitch,
                          .pair = pair,
                          .gear = gmi_gear_of(pair, wheel),
                          .wheel = wheel != 0,
                          .options = options,
                          .random = wheel ? ~options->seed : options->seed,
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
