/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Sample by sample: the solver gives the state at the sample's time, the model what is to be seen of it,
 * the decimator rows, the output lines.
 */
#include "dynamics.h"
#include "decimate.h"
#include "dynamic_columns.h"
#include "integrate.h"
#include "interrupt.h"
#include "model.h"
#include "output.h"
#include "progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct dynamic_run {
    const config *conf;
    gear_model model;
    integrator *solver;
    decimator *filter;
    output_file *output;
    progress progress;
    int factor; /* samples per row */
    int is_wanted[COLUMNS_MAX];
    enum column_need row_need;    /* the most that a column asked for needs of the mesh, */
    enum column_need sample_need; /* and of the mesh between the rows, as it is filtered */
    double rows;                  /* number of rows, a whole number */
    dynamic_sample sample;
    double values[COLUMNS_MAX]; /* of the sample */
    char why[640];              /* the run ended early */
} dynamic_run;

/* ---------------------------------------------------------------------------------------------
 * What a sample shows
 * ------------------------------------------------------------------------------------------- */

/* The mesh at the time and motion of the sample. */
static int see_mesh(dynamic_run *run, enum column_need need) {
    dynamic_sample *sample = &run->sample;

    const int wanted = need == NEEDS_PAIRS ? GM_WANT_PAIRS : GM_WANT_FORCE;
    const int status = model_evaluate(&run->model, &sample->motion, wanted, &sample->mesh);
    if (status != GM_OK) {
        snprintf(run->why, sizeof run->why, "no contact force at t = %.9g s; the gears: %s",
                 sample->time, gm_status_text(status));
        return EXIT_RUN_FAILED;
    }
    return 0;
}

/* Values at a time; those that nobody needs are left as they were. */
static int take_sample(dynamic_run *run, double time, int of_row) {
    const enum column_need need = of_row ? run->row_need : run->sample_need;
    double state[STATES_MAX];
    int failed = integrator_advance(run->solver, time, state);

    if (failed) {
        if (failed == EXIT_INTERRUPTED) {
            snprintf(run->why, sizeof run->why, "interrupted at t = %.9g s", time);
        } else {
            snprintf(run->why, sizeof run->why, "%s", integrator_failure(run->solver));
        }
        return failed;
    }

    /* Where the gears are, and how they touch if a column needs to know. */
    run->sample.time = time;
    run->sample.motion = model_motion(&run->model, time, state);
    if (need != NEEDS_NOTHING) {
        failed = see_mesh(run, need);
        if (failed) {
            return failed;
        }
    }

    for (int i = 0; i < dynamic_column_count; ++i) {
        if (run->is_wanted[i] && (of_row || dynamic_columns[i].is_filtered)) {
            run->values[i] = dynamic_columns[i].value(&run->sample);
        }
    }
    return 0;
}

static void tell_progress(dynamic_run *run) {
    if (progress_due(&run->progress)) {
        const progress_state state = {
            .time = run->sample.time,
            .speed = run->sample.motion.pinion_speed,
            .steps = integrator_counts(run->solver).steps,
        };
        progress_update(&run->progress, &state);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Rows
 * ------------------------------------------------------------------------------------------- */

/* Samples of one row period, the first of them at the row's time itself. */
static int take_row_period(dynamic_run *run, double row) {
    for (int i = 0; i < run->factor; ++i) {
        /* Divided once: k / rate is the time of row k to the last bit. */
        const double time = (row + (double)i / run->factor) / run->conf->output_rate;
        const int failed = take_sample(run, time, i == 0);
        if (failed) {
            return failed;
        }

        decimator_push(run->filter, run->values);
        tell_progress(run);

        /* The rows that lag behind by the filter's delay are complete with their period's first sample. */
        const double complete = row - (double)(decimator_delay(run->filter) / run->factor);
        if (i == 0 && complete >= 0.0) {
            double values[COLUMNS_MAX];
            decimator_values(run->filter, values);
            if (output_row(run->output, values) != 0) {
                snprintf(run->why, sizeof run->why, "the disk took no more at t = %.9g s", time);
                return EXIT_RUN_FAILED;
            }
            if (complete + 1.0 >= run->rows) {
                return 0;
            }
        }
    }
    return 0;
}

static int take_all(dynamic_run *run) {
    const double periods = run->rows + (double)(decimator_delay(run->filter) / run->factor);

    for (double row = 0.0; row < periods; row += 1.0) {
        const int failed = take_row_period(run, row);
        if (failed) {
            return failed;
        }
    }
    return 0;
}

/* ---------------------------------------------------------------------------------------------
 * Start and end
 * ------------------------------------------------------------------------------------------- */

static int start_solver(dynamic_run *run) {
    const config *conf = run->conf;
    const integrator_options options = {
        .method = conf->method,
        .relative_tolerance = conf->relative_tolerance,
        .absolute_tolerance = conf->absolute_tolerance,
        .max_step = conf->max_step,
    };
    double start[STATES_MAX];
    const int status = model_quasi_static_start(&run->model, start);

    if (status != GM_OK) {
        message_of_program(conf->messages, "no quasi-static start at the mean load: %s",
                           gm_status_text(status));
        return EXIT_RUN_FAILED;
    }
    run->solver = integrator_create(&run->model, &options, start);
    return run->solver != NULL ? 0 : message_no_memory(run->conf->messages);
}

static enum column_need larger(enum column_need a, enum column_need b) {
    return a > b ? a : b;
}

/* What is asked for decides what has to be computed, and whether there is anything to filter. */
static int start_filter(dynamic_run *run) {
    int filtered[COLUMNS_MAX];
    int any = 0;

    for (int i = 0; i < dynamic_column_count; ++i) {
        const dynamic_column *column = &dynamic_columns[i];
        run->is_wanted[i] = output_wants(run->output, i);
        filtered[i] = run->is_wanted[i] && column->is_filtered;
        any |= filtered[i];

        if (run->is_wanted[i]) {
            run->row_need = larger(run->row_need, column->need);
        }
        if (filtered[i]) {
            run->sample_need = larger(run->sample_need, column->need);
        }
    }
    run->factor = any ? run->conf->oversampling : 1;
    run->filter = decimator_create(run->factor, dynamic_column_count, filtered);
    return run->filter != NULL ? 0 : message_no_memory(run->conf->messages);
}

static int start_run(dynamic_run *run, const gear_mesh *gears) {
    if (model_init(&run->model, run->conf, gears) != 0) {
        return message_no_memory(run->conf->messages);
    }
    run->sample.model = &run->model;

    int exit_code = start_solver(run);
    if (exit_code != 0) {
        return exit_code;
    }

    const column_names names = dynamic_column_names();
    run->output = output_open(run->conf, names.name, names.count, &exit_code);
    return exit_code != 0 ? exit_code : start_filter(run);
}

static void summarize(const dynamic_run *run) {
    const integrator_statistics counts = integrator_counts(run->solver);

    message_note(run->conf->messages,
                 "gearsim: %.6g s simulated in %.3g s: %ld steps (%ld more repeated), %ld "
                 "right-hand sides, %ld Jacobians, %ld looks ahead",
                 integrator_time(run->solver), progress_elapsed(&run->progress), counts.steps,
                 counts.rejected, counts.derivatives, counts.jacobians, counts.looks);
}

/* Tells how it went and closes the file; returns the exit code of the run. */
static int end_run(dynamic_run *run, int exit_code) {
    progress_clear(&run->progress);
    if (exit_code != 0) {
        message_of_program(run->conf->messages, "%s", run->why);
    }
    summarize(run);

    const int closed = output_close(run->output, exit_code != 0 ? run->why : NULL);
    return exit_code != 0 ? exit_code : closed;
}

int dynamics_run(const config *conf, const gear_mesh *gears) {
    dynamic_run run = {.conf = conf,
                       .rows = floor(conf->duration * conf->output_rate + 1e-9) + 1.0};

    interrupt_watch(SECOND_KILLS);
    progress_start(&run.progress, conf->duration, conf->messages);

    int exit_code = start_run(&run, gears);
    if (exit_code == 0) {
        exit_code = end_run(&run, take_all(&run));
    } else if (run.output != NULL) {
        output_close(run.output, "the run could not be started");
    }
    interrupt_unwatch();
    decimator_free(run.filter);
    integrator_free(run.solver);
    model_free(&run.model);
    return exit_code;
}
