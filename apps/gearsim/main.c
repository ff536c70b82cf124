/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * gearsim: two gears on their shafts, driven and loaded, in contact through measured flanks.
 *
 *     I_p phi_p'' =  M_p - F r_bp        (or phi_p prescribed)
 *     I_w phi_w'' = -M_w + F r_bw        F = contact force of libgearmesh
 *
 * `gearsim --help` says all of its use; the equations are in libgearmesh/docs/equations.md.
 */
#include "arguments.h"
#include "dynamic_columns.h"
#include "dynamics.h"
#include "each.h"
#include "forecast.h"
#include "gear_mesh.h"
#include "geometry_listing.h"
#include "key_template.h"
#include "lookup.h"
#include "output.h"
#include "platform.h"
#include "sampling.h"
#include "static_columns.h"
#include "statics.h"
#include "time_table.h"

static column_names names_of(const config *conf) {
    return conf->analysis == ANALYSIS_STATIC ? static_column_names(conf)
                                             : dynamic_column_names(conf);
}

static int run(const config *conf, const gear_mesh *mesh) {
    return conf->analysis == ANALYSIS_STATIC ? statics_run(conf, mesh) : dynamics_run(conf, mesh);
}

static int perform(const arguments *args, config *conf, const gear_mesh *mesh) {
    if (args->task == TASK_GEOMETRY) {
        geometry_print(mesh, conf, args->as_json, stdout);
        return EXIT_DONE;
    }

    /* What can be wrong shows before the run, and then --check has done its work. */
    const column_names names = names_of(conf);
    int status = lookup_note(mesh, conf);
    if (status == 0) {
        status = output_check(conf, names.name, names.count);
    }
    if (status == 0) {
        status = statics_check(conf, mesh);
    }
    if (status == 0 && args->task == TASK_CHECK) {
        forecast_print(conf, &names, args->as_json, stdout);
        return EXIT_DONE;
    }
    return status != 0 ? status : run(conf, mesh);
}

/* Reads the INI file and what it names, and does what the command line asks of it. */
static int load_and_perform(const arguments *args) {
    config conf;
    int status = config_load(&conf, &args->request);
    if (status != 0) {
        return status;
    }

    /* Gears and flanks, what there is to say of them, tables over time; each stage only if those before went well. */
    gear_mesh mesh;
    status = gear_mesh_open(&mesh, &conf);
    if (status == 0) {
        status = gear_mesh_note(&mesh, &conf);
        if (status == 0) {
            status = sampling_note(&mesh, &conf);
        }
        if (status == 0) {
            status = time_tables_read(&conf);
        }
        if (status == 0) {
            status = perform(args, &conf, &mesh);
        }
        time_tables_free(&conf);
        gear_mesh_close(&mesh);
    }
    config_free(&conf);
    return status;
}

static int do_task(const arguments *args) {
    switch (args->task) {
    case TASK_HELP:
        arguments_print_help(stdout);
        return EXIT_DONE;
    case TASK_VERSION:
        printf("gearsim %s\n", gm_version());
        return EXIT_DONE;
    case TASK_TEMPLATE:
        return key_template_print(args->template_kind, stdout, args->request.messages);
    case TASK_EACH:
        return each_run(args, load_and_perform);
    default:
        return load_and_perform(args);
    }
}

int main(int argc, char *argv[]) {
    if (process_prepare() != EXIT_DONE) {
        return EXIT_RUN_FAILED; /* there is nowhere to say it */
    }

    message_sink messages = messages_to(stderr, "gearsim");
    arguments args;

    int status = arguments_parse(&args, argc, argv, &messages);
    if (status == 0) {
        status = do_task(&args);
        arguments_free(&args);
    }
    return message_of_stdout(&messages, status);
}
