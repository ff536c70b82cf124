/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * gearflanks: makes the flank and pitch files of a gear, of a class of ISO 1328-1, with amounts that scatter, or from
 * measured traces, and says which class such files measure to. `gearflanks --help` says all of its use.
 */
#include "gear_mesh.h"
#include "make.h"
#include "measured.h"
#include "platform.h"
#include "report.h"

static int do_with_gears(const flanks_options *options, const gm_pair *pair, const config *conf) {
    switch (options->task) {
    case FLANKS_MAKE:
        return make_flanks(options, pair);
    case FLANKS_MEASURED:
        return build_measured(options, pair);
    default:
        return report_flanks(options, pair,
                             options->wheel ? &conf->wheel_flanks : &conf->pinion_flanks);
    }
}

static int load_and_do(const flanks_options *options) {
    const config_request request = {
        .path = options->parameters, .purpose = CONFIG_FOR_FLANKS, .messages = options->messages};
    config conf;
    int status = config_load(&conf, &request);
    if (status != 0) {
        return status;
    }

    gear_mesh mesh;
    status = gear_mesh_open(&mesh, &conf);
    if (status == 0) {
        status = do_with_gears(options, &mesh.pair, &conf);
        gear_mesh_close(&mesh);
    }
    config_free(&conf);
    return status;
}

static int do_task(const flanks_options *options) {
    switch (options->task) {
    case FLANKS_HELP:
        options_print_help(stdout);
        return EXIT_DONE;
    case FLANKS_VERSION:
        printf("gearflanks %s\n", gm_version());
        return EXIT_DONE;
    default:
        return load_and_do(options);
    }
}

int main(int argc, char *argv[]) {
    if (process_prepare() != EXIT_DONE) {
        return EXIT_RUN_FAILED; /* there is nowhere to say it */
    }

    message_sink messages = messages_to(stderr, "gearflanks");
    flanks_options options;

    int status = options_parse(&options, argc, argv, &messages);
    if (status == 0) {
        status = do_task(&options);
    }
    return message_of_stdout(&messages, status);
}
