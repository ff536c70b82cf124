/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Any bytes as gearsim's INI file: refused with the exit status of bad input, or every number in it is what its
 * key allows, and the gear pair can be built or is refused as well. Twice the same bytes, twice the same answer.
 */
#include "fuzz.h"
#include "fuzz_file.h"
#include "fuzz_messages.h"

#include <config.h>
#include <gear_mesh.h>
#include <geometry_listing.h>
#include <math.h>

static fuzz_file input;

static void claim_config(const config *conf) {
    FUZZ_CLAIM(conf->gears.pinion_teeth >= 3 && abs(conf->gears.wheel_teeth) >= 3);
    FUZZ_CLAIM(isfinite(conf->gears.normal_module) && isfinite(conf->gears.center_distance));
    FUZZ_CLAIM(isfinite(conf->flank_scale) && conf->profile_from < conf->profile_to);
    FUZZ_CLAIM(isnan(conf->damping) || conf->damping >= 0.0);
    FUZZ_CLAIM(conf->noise_amplitude >= 0.0 && conf->noise_interval > 0.0);
    FUZZ_CLAIM(conf->digits >= 3 && conf->digits <= 17 && conf->oversampling >= 1);
    FUZZ_CLAIM(conf->output_file != NULL && conf->provenance_count > 0);
}

/* The listing of --geometry, of which only the end of the call is looked at. */
static void print_geometry(const gear_mesh *mesh, const config *conf) {
    static FILE *nowhere;
    if (nowhere == NULL) {
        nowhere = fopen("/dev/null", "w");
        FUZZ_CLAIM(nowhere != NULL);
    }
    geometry_print(mesh, conf, 0, nowhere);
}

/* With a listener or without: to find the words for a message is most of the work. */
static int load(enum config_purpose purpose, int listening) {
    int messages;
    message_sink sink = fuzz_messages(&messages);
    const config_request request = {
        .path = fuzz_file_path(&input), .purpose = purpose, .messages = listening ? &sink : NULL};
    config conf;
    const int status = config_load(&conf, &request);
    FUZZ_CLAIM(status == 0 || status == EXIT_BAD_INPUT);
    FUZZ_CLAIM(status == 0 || messages > 0 || !listening);
    FUZZ_CLAIM(messages <= 2 * MOST_MESSAGES);
    if (status != 0) {
        return status;
    }
    claim_config(&conf);

    /* Flank files have fuzzers of their own, and a name may be that of a device. */
    gear_mesh mesh;
    int opened = 0;
    if (conf.pinion_flanks.deviations == NULL && conf.pinion_flanks.pitch == NULL &&
        conf.pinion_flanks.tooth_stiffness == NULL && conf.wheel_flanks.deviations == NULL &&
        conf.wheel_flanks.pitch == NULL && conf.wheel_flanks.tooth_stiffness == NULL) {
        messages = 0;
        opened = gear_mesh_open(&mesh, &conf);
        FUZZ_CLAIM(opened == 0 || opened == EXIT_BAD_INPUT);
        FUZZ_CLAIM(opened == 0 || messages > 0 || !listening);
        if (opened == 0) {
            print_geometry(&mesh, &conf);
            gear_mesh_close(&mesh);
        }
    }
    config_free(&conf);
    return opened;
}

/* The last byte says for what. Some of the inputs are read again by somebody who listens: the answer is the same. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const int is_geometry = size > 0 && data[size - 1] == '\n';
    const enum config_purpose purpose = is_geometry ? CONFIG_FOR_GEOMETRY : CONFIG_FOR_RUN;
    fuzz_file_with(&input, data, size);
    const int status = load(purpose, 0);
    if (size % 64 == 0) {
        FUZZ_CLAIM(load(purpose, 1) == status);
    }
    return 0;
}
