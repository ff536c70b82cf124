/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Sample by sample: the solver gives the state at the sample's time, the model what is to be seen of it,
 * the decimator rows, the output lines.
 */
#include "dynamics.h"
#include "decimate.h"
#include "integrate.h"
#include "interrupt.h"
#include "model.h"
#include "output.h"
#include "progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Places of dynamic_columns. */
enum column {
    TIME,
    PINION_SPEED,
    WHEEL_SPEED,
    PINION_ANGLE,
    WHEEL_ANGLE,
    DTE,
    PENETRATION,
    PENETRATION_RATE,
    CONTACT_FORCE,
    LOAD_TORQUE,
    PAIRS,
    COLUMNS
};

/* Angles, time and the pinion's speed grow steadily, pairs are counts: a filter has nothing to do there. */
static const int is_filtered[COLUMNS] = {
    [WHEEL_SPEED] = 1,      [DTE] = 1,           [PENETRATION] = 1,
    [PENETRATION_RATE] = 1, [CONTACT_FORCE] = 1, [LOAD_TORQUE] = 1,
};
static const int needs_mesh[COLUMNS] = {
    [PENETRATION] = 1, [PENETRATION_RATE] = 1, [CONTACT_FORCE] = 1, [PAIRS] = 1};

static const double rpm = 60.0 / 6.283185307179586; /* of 1 rad/s */
static const double micro = 1e6;

typedef struct dynamic_run {
    const config *conf;
    gear_model model;
    integrator *solver;
    decimator *filter;
    output_file *output;
    progress progress;
    int factor;            /* samples per row */
    int row_needs_mesh;    /* some column asked for needs the mesh: in the samples of the rows, */
    int sample_needs_mesh; /* or in all samples, as it is filtered */
    int needs_load;        /* the load torque is asked for */
    double rows;           /* number of rows, a whole number */
    double values[COLUMNS];
    char why[640]; /* the run ended early */
} dynamic_run;

/* ---------------------------------------------------------------------------------------------
 * What a sample shows
 * ------------------------------------------------------------------------------------------- */

static void show_motion(dynamic_run *run, double time, const gear_motion *motion) {
    const double r_bp = run->model.gears->pair.pinion.base_radius;
    const double r_bw = run->model.gears->pair.wheel.base_radius;
    double *values = run->values;

    values[TIME] = time;
    values[PINION_SPEED] = motion->pinion_speed * rpm;
    values[WHEEL_SPEED] = (r_bp * motion->pinion_speed - motion->offset_rate) / r_bw * rpm;
    values[PINION_ANGLE] = motion->pinion_angle;
    values[WHEEL_ANGLE] = (r_bp * motion->pinion_angle - motion->offset) / r_bw;
    values[DTE] = -motion->offset * micro;
    if (run->needs_load) {
        values[LOAD_TORQUE] = load_torque(&run->model.load, time);
    }
}

static int show_mesh(dynamic_run *run, double time, const gear_motion *motion, int with_pairs) {
    gm_penetration mesh;
    int status = model_penetration(&run->model, motion, &mesh);
    double *values = run->values;

    if (status == GM_OK && with_pairs) {
        status = model_pairs(&run->model, motion, &mesh);
    }
    if (status != GM_OK) {
        snprintf(run->why, sizeof run->why, "no contact force at t = %.9g s; the gears: %s", time,
                 gm_status_text(status));
        return EXIT_RUN_FAILED;
    }
    values[PENETRATION] = mesh.penetration * micro;
    values[PENETRATION_RATE] = mesh.rate * micro;
    values[CONTACT_FORCE] = model_force(&run->model, &mesh);
    values[PAIRS] = mesh.drive_pairs + mesh.coast_pairs;
    return 0;
}

/* Values at a time; those that nobody needs are left as they were. */
static int take_sample(dynamic_run *run, double time, int of_row) {
    double state[STATES_MAX];
    const int failed = integrator_advance(run->solver, time, state);

    if (failed) {
        if (failed == EXIT_INTERRUPTED) {
            snprintf(run->why, sizeof run->why, "interrupted at t = %.9g s", time);
        } else {
            snprintf(run->why, sizeof run->why, "%s", integrator_failure(run->solver));
        }
        return failed;
    }

    const gear_motion motion = model_motion(&run->model, time, state);
    show_motion(run, time, &motion);
    if (of_row ? run->row_needs_mesh : run->sample_needs_mesh) {
        return show_mesh(run, time, &motion, of_row && output_wants(run->output, PAIRS));
    }
    return 0;
}

static void tell_progress(dynamic_run *run) {
    if (progress_due(&run->progress)) {
        const progress_state state = {
            .time = run->values[TIME],
            .speed = run->values[PINION_SPEED] / rpm,
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
            double values[COLUMNS];
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

static int out_of_memory(void) {
    fprintf(stderr, "gearsim: out of memory\n");
    return EXIT_RUN_FAILED;
}

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
        fprintf(stderr, "gearsim: no quasi-static start at the mean load: %s\n",
                gm_status_text(status));
        return EXIT_RUN_FAILED;
    }
    run->solver = integrator_create(&run->model, &options, start);
    return run->solver != NULL ? 0 : out_of_memory();
}

/* What is asked for decides what has to be computed, and whether there is anything to filter. */
static int start_filter(dynamic_run *run) {
    int filtered[COLUMNS];
    int any = 0;

    for (int i = 0; i < COLUMNS; ++i) {
        const int wanted = output_wants(run->output, i);
        filtered[i] = wanted && is_filtered[i];
        any |= filtered[i];
        run->row_needs_mesh |= wanted && needs_mesh[i];
        run->sample_needs_mesh |= filtered[i] && needs_mesh[i];
    }
    run->needs_load = output_wants(run->output, LOAD_TORQUE);
    run->factor = any ? run->conf->oversampling : 1;
    run->filter = decimator_create(run->factor, COLUMNS, filtered);
    return run->filter != NULL ? 0 : out_of_memory();
}

static int start_run(dynamic_run *run, const gear_mesh *gears) {
    if (model_init(&run->model, run->conf, gears) != 0) {
        return out_of_memory();
    }

    int exit_code = start_solver(run);

    if (exit_code == 0) {
        run->output = output_open(run->conf, dynamic_columns, dynamic_column_count, &exit_code);
    }
    return exit_code != 0 ? exit_code : start_filter(run);
}

static void summarize(const dynamic_run *run) {
    const integrator_statistics counts = integrator_counts(run->solver);

    if (!run->progress.quiet) {
        fprintf(
            stderr,
            "gearsim: %.6g s simulated in %.3g s: %ld steps (%ld more repeated), %ld right-hand "
            "sides, %ld Jacobians\n",
            integrator_time(run->solver), progress_elapsed(&run->progress), counts.steps,
            counts.rejected, counts.derivatives, counts.jacobians);
    }
}

/* Tells how it went and closes the file; returns the exit code of the run. */
static int end_run(dynamic_run *run, int exit_code) {
    progress_clear(&run->progress);
    if (exit_code != 0) {
        fprintf(stderr, "gearsim: %s\n", run->why);
    }
    summarize(run);

    const int closed = output_close(run->output, exit_code != 0 ? run->why : NULL);
    return exit_code != 0 ? exit_code : closed;
}

int dynamics_run(const config *conf, const gear_mesh *gears) {
    dynamic_run run = {.conf = conf,
                       .rows = floor(conf->duration * conf->output_rate + 1e-9) + 1.0};

    interrupt_watch();
    progress_start(&run.progress, conf->duration, conf->quiet);

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
