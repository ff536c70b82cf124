/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * A dynamic run from its quasi-static start to the result: the samples of each row, what is written of them, and how it ends.
 */
#include "dynamics.h"
#include "exit_code.h"
#include "gear_contact.h"
#include "integrate.h"
#include "mesh_cache.h"
#include "model.h"
#include "output.h"
#include "platform.h"
#include "progress.h"
#include "sampling.h"

#include <math.h>
#include <string.h>

typedef struct dynamic_run {
    const config *conf;
    gear_model model;
    integrator *solver;
    sampling sampling;
    output_file *output;
    progress progress;
    int place[COLUMNS_MAX]; /* where the output has the columns that are asked for */
    double rows;            /* number of rows, a whole number */
    double past_stop; /* +1 or -1: the stop speed is reached from below, from above; 0 = none */
} dynamic_run;

/* ---------------------------------------------------------------------------------------------
 * Rows
 * ------------------------------------------------------------------------------------------- */

static void tell_progress(dynamic_run *run) {
    if (progress_due(&run->progress)) {
        const progress_state state = {
            .time = run->sampling.sample.time,
            .speed = run->sampling.sample.motion.pinion_speed,
            .steps = integrator_counts(run->solver).steps,
        };
        progress_update(&run->progress, &state);
    }
}

/* The first row at or beyond the stop speed is the last one. */
static void look_for_stop(dynamic_run *run, double row) {
    const double beyond =
        run->past_stop * (run->sampling.sample.motion.pinion_speed - run->conf->stop_speed);

    if (run->past_stop != 0.0 && beyond >= 0.0 && row + 1.0 < run->rows) {
        run->rows = row + 1.0;
        run->past_stop = 0.0;
    }
}

/* A row that is complete: that of the first sample of a period, with the filter's delay behind it. */
static int write_row(dynamic_run *run) {
    double shown[COLUMNS_MAX], values[COLUMNS_MAX];

    decimator_values(run->sampling.filter, shown);
    for (int k = 0; k < run->sampling.column_count; ++k) {
        values[run->place[k]] = shown[k];
    }
    if (output_row(run->output, values) != 0) {
        snprintf(run->sampling.why, sizeof run->sampling.why, "the disk took no more at t = %.9g s",
                 run->sampling.sample.time);
        return EXIT_RUN_FAILED;
    }
    return 0;
}

static int take_all(dynamic_run *run) {
    const double delay = (double)(decimator_delay(run->sampling.filter) / run->sampling.factor);
    int failed = sampling_take_first(&run->sampling);

    for (double row = 0.0; !failed; row += 1.0) {
        tell_progress(run);
        look_for_stop(run, row);

        /* The rows that lag behind by the filter's delay are complete with their period's first sample. */
        if (row >= delay) {
            failed = write_row(run);
        }
        if (failed || row + 1.0 >= run->rows + delay) {
            break;
        }
        failed = sampling_go_to_next_row(&run->sampling, row);
    }
    return failed;
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

/* Which columns are asked for, and what a run looks at in every row beside them. */
static int start_sampling(dynamic_run *run) {
    const config *conf = run->conf;
    int columns[COLUMNS_MAX];
    int count = 0, name = 0;

    for (int i = 0; i < dynamic_column_count; ++i) {
        /* The output counts those that these gears have. */
        if (!dynamic_column_is_there(conf, i)) {
            continue;
        }
        if (output_wants(run->output, name)) {
            run->place[count] = name;
            columns[count++] = i;
        }
        ++name;
    }

    /* The speed that ends the run is looked at in every row. */
    enum column_need need = NEEDS_TIME;
    if (conf->drive == DRIVE_TORQUE && !isnan(conf->stop_speed)) {
        need = NEEDS_MOTION;
        run->past_stop = conf->stop_speed >= conf->start_speed ? 1.0 : -1.0;
    }
    return sampling_start(&run->sampling, conf, &run->model, run->solver, columns, count, need) == 0
               ? 0
               : message_no_memory(conf->messages);
}

static int start_run(dynamic_run *run, const gear_mesh *gears) {
    if (model_init(&run->model, run->conf, gears) != 0) {
        return message_no_memory(run->conf->messages);
    }

    int exit_code = start_solver(run);
    if (exit_code != 0) {
        return exit_code;
    }

    const column_names names = dynamic_column_names(run->conf);
    run->output = output_open(run->conf, names.name, names.count, &exit_code);
    if (exit_code == 0) {
        exit_code = start_sampling(run);
    }
    if (exit_code != 0) {
        return exit_code;
    }
    return mesh_cache_fill(run->model.cache, run->conf, gears, &run->progress) == 0
               ? 0
               : message_no_memory(run->conf->messages);
}

static void summarize(const dynamic_run *run) {
    const integrator_statistics counts = integrator_counts(run->solver);

    message_note(run->conf->messages,
                 "gearsim: %.6g s simulated in %.3g s: %ld steps (%ld more repeated), %ld "
                 "right-hand sides, %ld looks ahead",
                 integrator_time(run->solver), progress_elapsed(&run->progress), counts.steps,
                 counts.rejected, counts.derivatives, counts.looks);
}

/* Looks once at the pressure, where the force was largest. */
static void warn_of_pressure(dynamic_run *run) {
    const gear_mesh *gears = run->model.gears;
    gm_mesh_result mesh;
    gm_position position;
    gm_line_loads load;
    if (run->sampling.hardest_force > 0.0 &&
        model_evaluate(&run->model, &run->sampling.hardest, GM_WANT_FORCE, &mesh) == GM_OK &&
        gm_position_from_pinion_angle(&gears->pair, run->sampling.hardest.pinion_angle,
                                      run->sampling.hardest.offset, 0.0, &position) == GM_OK &&
        gear_contact_line_loads(gears, &position, NULL, 0, &load) == GM_OK) {
        gear_contact_warn(run->conf, &load);
    }
}

/* Tells how it went and closes the file; returns the exit code of the run. */
static int end_run(dynamic_run *run, int exit_code) {
    progress_clear(&run->progress);
    if (exit_code != 0) {
        message_of_program(run->conf->messages, "%s", run->sampling.why);
    } else if (run->past_stop != 0.0) {
        config_warn(run->conf, "analysis.stop_rpm",
                    "not reached within analysis.duration_s, which ended the run");
    }
    warn_of_pressure(run);
    summarize(run);

    const int closed = output_close(run->output, exit_code != 0 ? run->sampling.why : NULL);
    return exit_code != 0 ? exit_code : closed;
}

double dynamics_rows(const config *conf) {
    return floor(conf->duration * conf->output_rate + 1e-9) + 1.0;
}

int dynamics_run(const config *conf, const gear_mesh *gears) {
    dynamic_run run = {.conf = conf, .rows = dynamics_rows(conf)};

    interrupt_watch(SECOND_KILLS);
    progress_start(&run.progress, conf->duration, conf->messages);

    int exit_code = start_run(&run, gears);
    if (exit_code == 0) {
        exit_code = end_run(&run, take_all(&run));
    } else if (run.output != NULL) {
        output_close(run.output, "the run could not be started");
    }
    interrupt_unwatch();
    sampling_free(&run.sampling);
    integrator_free(run.solver);
    model_free(&run.model);
    return exit_code;
}
