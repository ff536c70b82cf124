/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "file_mesh.h"

#include <stdlib.h>
#include <string.h>

typedef struct complaint {
    char *text;
    size_t size;
} complaint;

static int failed(complaint to, const char *reason) {
    snprintf(to.text, to.size, "%s", reason);
    return -1;
}

/* A parameter that the library refuses, by its name if it has one. */
static int refused(complaint to, int status, const char *field, const char *requirement) {
    if (field == NULL) {
        return failed(to, gm_status_text(status));
    }
    snprintf(to.text, to.size, "%s: must be %s", field, requirement);
    return -1;
}

void file_mesh_free(file_mesh *made) {
    for (int gear = 0; gear < 2; ++gear) {
        gm_flanks_free(made->flanks[gear]);
    }
    free(made->memory);
    free(made->workspace_memory);
    memset(made, 0, sizeof *made);
}

/* Flanks of a gear from its two files. */
static int load_flanks(file_mesh *made, const gm_pair *pair, int gear, const file_mesh_paths *paths,
                       complaint to) {
    const char *deviations_path = paths->deviations[gear];
    const char *pitch_path = paths->pitch[gear];
    const int has_deviations = deviations_path[0] != '\0';
    const int has_pitch = pitch_path[0] != '\0';
    if (!has_deviations && !has_pitch) {
        return 0;
    }

    const int teeth = (gear == GM_PINION ? &pair->pinion : &pair->wheel)->teeth;
    gm_deviations deviations = {0};
    gm_pitch pitch = {0};
    gm_flanks_options options;
    gm_io_error error;
    gm_flanks_options_default(&options);
    options.normal_factor = pair->normal_to_transverse;
    int status = GM_IO_OK;
    if (has_deviations) {
        status = gm_deviations_read(&deviations, deviations_path, teeth, &error);
    }
    if (status == GM_IO_OK && has_pitch) {
        status = gm_pitch_read(&pitch, pitch_path, teeth, &error);
    }
    if (status == GM_IO_OK) {
        status = gm_flanks_build(&made->flanks[gear], teeth, has_deviations ? &deviations : NULL,
                                 has_pitch ? &pitch : NULL, &options, NULL, &error);
    }
    gm_deviations_free(&deviations);
    gm_pitch_free(&pitch);
    if (status != GM_IO_OK) {
        snprintf(to.text, to.size, "%s:%ld: %s", error.file, error.line, error.text);
        return -1;
    }
    return 0;
}

static int prepare(file_mesh *made, const gm_pair_params *pair_params, const gm_mesh_params *law,
                   const file_mesh_paths *paths, complaint to) {
    /* The parameters, each by its name. */
    const char *field = NULL;
    const char *requirement = NULL;
    gm_pair pair;
    int status = gm_pair_init(&pair, pair_params);
    if (status != GM_OK) {
        gm_pair_params_check(pair_params, &field, &requirement);
        return refused(to, status, field, requirement);
    }
    status = gm_mesh_params_check(law, &field, &requirement);
    if (status != GM_OK) {
        return refused(to, status, field, requirement);
    }

    if (load_flanks(made, &pair, GM_PINION, paths, to) != 0 ||
        load_flanks(made, &pair, GM_WHEEL, paths, to) != 0) {
        return -1;
    }
    const size_t size = gm_mesh_size(law, &pair);
    made->memory = malloc(size > 0 ? size : 1);
    if (made->memory == NULL) {
        return failed(to, "out of memory");
    }
    status = gm_mesh_init(&made->mesh, law, &pair, made->flanks[GM_PINION], made->flanks[GM_WHEEL],
                          made->memory, size);
    if (status != GM_OK) {
        return failed(to, gm_status_text(status));
    }

    /* What a law that iterates remembers. */
    const size_t workspace_size = gm_workspace_size(made->mesh);
    if (workspace_size == 0) {
        return 0;
    }
    made->workspace_memory = malloc(workspace_size);
    if (made->workspace_memory == NULL) {
        return failed(to, "out of memory");
    }
    status =
        gm_workspace_init(&made->workspace, made->mesh, made->workspace_memory, workspace_size);
    return status == GM_OK ? 0 : failed(to, gm_status_text(status));
}

int file_mesh_init(file_mesh *made, const gm_pair_params *pair, const gm_mesh_params *law,
                   const file_mesh_paths *paths, char *message, size_t message_size) {
    memset(made, 0, sizeof *made);
    const complaint to = {message, message_size};
    if (prepare(made, pair, law, paths, to) != 0) {
        file_mesh_free(made);
        return -1;
    }
    return 0;
}
