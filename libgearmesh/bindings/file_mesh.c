/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "file_mesh.h"

#include <math.h>
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
    for (int half = 0; half < 2; ++half) {
        gm_flanks_free(made->flanks[half][GM_PINION]);
        gm_flanks_free(made->flanks[half][GM_WHEEL]);
        free(made->memory[half]);
        free(made->workspace_memory[half]);
    }
    memset(made, 0, sizeof *made);
}

/* ---------------------------------------------------------------------------------------------
 * Preparation
 * ------------------------------------------------------------------------------------------- */

/* Flanks of a gear from its two files. */
static int load_flanks(gm_flanks **flanks, const gm_pair *pair, int gear,
                       const char *deviations_path, const char *pitch_path, complaint to) {
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

    /* Deviations, pitch, or both; an error is of the file that is read. */
    int status = GM_IO_OK;
    if (has_deviations) {
        status = gm_deviations_read(&deviations, deviations_path, teeth, &error);
    }
    if (status == GM_IO_OK && has_pitch) {
        status = gm_pitch_read(&pitch, pitch_path, teeth, &error);
    }
    if (status == GM_IO_OK) {
        status = gm_flanks_build(flanks, teeth, has_deviations ? &deviations : NULL,
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

static const char *either(const char *path, const char *instead) {
    return path[0] != '\0' ? path : instead;
}

/* Flanks of both gears of a half. What the second one has no file for is as in the first. */
static int load_half(file_mesh *made, const gm_pair *pair, const file_mesh_params *params, int half,
                     complaint to) {
    const file_mesh_paths *own = &params->files[half];
    const file_mesh_paths *first = &params->files[0];
    for (int gear = GM_PINION; gear <= GM_WHEEL; ++gear) {
        if (load_flanks(&made->flanks[half][gear], pair, gear,
                        either(own->deviations[gear], first->deviations[gear]),
                        either(own->pitch[gear], first->pitch[gear]), to) != 0) {
            return -1;
        }
    }
    return 0;
}

/* A mesh, and what a law that iterates remembers. */
static int make_mesh(file_mesh *made, const gm_pair *pair, const gm_mesh_params *law, int half,
                     complaint to) {
    const size_t size = gm_mesh_size(law, pair);
    made->memory[half] = malloc(size > 0 ? size : 1);
    if (made->memory[half] == NULL) {
        return failed(to, "out of memory");
    }
    int status = gm_mesh_init(&made->mesh[half], law, pair, made->flanks[half][GM_PINION],
                              made->flanks[half][GM_WHEEL], made->memory[half], size);
    if (status != GM_OK) {
        return failed(to, gm_status_text(status));
    }

    const size_t workspace_size = gm_workspace_size(made->mesh[half]);
    if (workspace_size == 0) {
        return 0;
    }
    made->workspace_memory[half] = malloc(workspace_size);
    if (made->workspace_memory[half] == NULL) {
        return failed(to, "out of memory");
    }
    status = gm_workspace_init(&made->workspace[half], made->mesh[half],
                               made->workspace_memory[half], workspace_size);
    return status == GM_OK ? 0 : failed(to, gm_status_text(status));
}

/* Each half of a double-helical pair has its share of stiffness, damping and load. */
static gm_mesh_params law_of_half(const gm_mesh_params *whole) {
    gm_mesh_params law = *whole;
    law.stiffness *= 0.5;
    law.damping *= 0.5;
    law.simple_stiffness *= 0.5;
    law.reference_torque *= 0.5;
    return law;
}

/* The drawing of the gears, or of a half of them, and the pair that it gives. */
static int draw(const file_mesh *made, const file_mesh_params *params, gm_pair *pair,
                complaint to) {
    gm_pair_params drawing = params->pair;
    if (made->halves == 2 &&
        gm_double_helical_half(&params->pair, params->gap, &drawing) != GM_OK) {
        return failed(to,
                      "double_helical_gap: must be at least 0 and below the narrower face width, "
                      "with a helix angle and without an axial offset");
    }
    const char *field = NULL;
    const char *requirement = NULL;
    const int status = gm_pair_init(pair, &drawing);
    if (status != GM_OK) {
        gm_pair_params_check(&drawing, &field, &requirement);
        return refused(to, status, field, requirement);
    }
    return 0;
}

static int prepare(file_mesh *made, const file_mesh_params *params, complaint to) {
    /* The parameters, each by its name. */
    const char *field = NULL;
    const char *requirement = NULL;
    gm_pair pair;
    made->halves = isnan(params->gap) ? 1 : 2;
    const int status = gm_mesh_params_check(&params->law, &field, &requirement);
    if (draw(made, params, &pair, to) != 0) {
        return -1;
    }
    if (status != GM_OK) {
        return refused(to, status, field, requirement);
    }

    if (made->halves == 1) {
        return load_half(made, &pair, params, 0, to) != 0
                   ? -1
                   : make_mesh(made, &pair, &params->law, 0, to);
    }
    gm_mesh_params law = law_of_half(&params->law);
    gm_pose poses[2];
    gm_double_helical_pose(&pair, params->gap, &params->law.pose, poses);
    for (int half = 0; half < 2; ++half) {
        law.pose = poses[half];
        if (load_half(made, &pair, params, half, to) != 0 ||
            make_mesh(made, &pair, &law, half, to) != 0) {
            return -1;
        }
        made->floating.half[half] = made->mesh[half];
        made->floating.workspace[half] = made->workspace[half];
    }
    made->floating.gap = params->gap;
    return 0;
}

int file_mesh_init(file_mesh *made, const file_mesh_params *params, char *message,
                   size_t message_size) {
    memset(made, 0, sizeof *made);
    const complaint to = {message, message_size};
    if (prepare(made, params, to) != 0) {
        file_mesh_free(made);
        return -1;
    }
    return 0;
}

/* ---------------------------------------------------------------------------------------------
 * Evaluation
 * ------------------------------------------------------------------------------------------- */

const gm_pair *file_mesh_pair(const file_mesh *made) {
    return gm_mesh_pair(made->mesh[0]);
}

double file_mesh_clearance(const file_mesh *made, int side) {
    const double first = gm_mesh_clearance(made->mesh[0], side);
    if (made->halves == 1) {
        return first;
    }

    /* Halves that touch at x - s tan(beta_b) and x + s tan(beta_b) bear a force once both do: the float s cancels. */
    return 0.5 * (first + gm_mesh_clearance(made->mesh[1], side));
}

/*
 * The halves carry the same, F_1(x - s tan(beta_b)) = F_2(x + s tan(beta_b)): what would make them differ moves s. At a given
 * pinion angle dx is -r_bw dphi_w.
 */
static gm_gradient float_by(const gm_pair *pair, const gm_mesh_result each[2]) {
    const gm_gradient *first = &each[0].force_by;
    const gm_gradient *second = &each[1].force_by;
    const gm_gradient none = {0.0, 0.0, 0.0, 0.0};
    const double by_offset = -(first->wheel_angle + second->wheel_angle) / pair->wheel.base_radius;
    const double by_float = by_offset * pair->face_advance / pair->face_width;
    if (by_float == 0.0) {
        return none; /* nothing touches */
    }
    const gm_gradient by = {(first->pinion_angle - second->pinion_angle) / by_float,
                            (first->wheel_angle - second->wheel_angle) / by_float,
                            (first->pinion_speed - second->pinion_speed) / by_float,
                            (first->wheel_speed - second->wheel_speed) / by_float};
    return by;
}

int file_mesh_evaluate(const file_mesh *made, const gm_position *position, int wanted,
                       file_mesh_float *floated, gm_mesh_result *result) {
    const gm_motion motion = {.position = *position};
    return file_mesh_evaluate_posed(made, &motion, wanted, floated, result);
}

int file_mesh_evaluate_posed(const file_mesh *made, const gm_motion *motion, int wanted,
                             file_mesh_float *floated, gm_mesh_result *result) {
    memset(floated, 0, sizeof *floated);
    if (made->halves == 1) {
        return gm_mesh_evaluate_posed(made->mesh[0], motion, wanted, made->workspace[0], result);
    }

    /* The float is sought from 0 each time, for the same bits. */
    gm_mesh_result each[2];
    const int status = gm_double_helical_evaluate_posed(&made->floating, motion, wanted,
                                                        &floated->shift, each, result);
    if (status == GM_OK) {
        floated->by = float_by(file_mesh_pair(made), each);
    }
    return status;
}

int file_mesh_equilibrium(const file_mesh *made, double pinion_angle, double pinion_speed,
                          double wheel_torque, double *offset) {
    gm_mesh_result each[2];
    gm_mesh_result result;
    double apex = 0.0;
    return made->halves == 2
               ? gm_double_helical_equilibrium(&made->floating, pinion_angle, pinion_speed,
                                               wheel_torque, NAN, offset, &apex, each, &result)
               : gm_rolling_equilibrium(made->mesh[0], pinion_angle, pinion_speed, wheel_torque,
                                        NAN, made->workspace[0], offset, &result);
}
