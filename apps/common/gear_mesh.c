/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "gear_mesh.h"
#include "drawing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int load_flanks(gear_mesh *mesh, const config *conf) {
    int status = gear_flanks_load(&mesh->flanks[GM_PINION], conf, &mesh->pair, GM_PINION);

    if (status == 0) {
        status = gear_flanks_load(&mesh->flanks[GM_WHEEL], conf, &mesh->pair, GM_WHEEL);
    }
    return status;
}

/* The key of the pose that moves the wheel most is the one to look at. */
static int refuse_pose(const config *conf, const gm_pair *pair) {
    const double half_face = 0.5 * pair->face_width;
    const struct {
        const char *key;
        double amount; /* as the key gives it */
        double move;   /* (m) */
    } moves[] = {
        {"pose.center_distance_change_um", 1e6 * conf->pose.center_distance_change,
         conf->pose.center_distance_change},
        {"pose.offset_um", 1e6 * conf->pose.offset, conf->pose.offset},
        {"pose.axial_shift_um", 1e6 * conf->pose.axial_shift, conf->pose.axial_shift},
        {"pose.skew_mrad", 1e3 * conf->pose.skew, half_face * conf->pose.skew},
        {"pose.inclination_mrad", 1e3 * conf->pose.inclination, half_face * conf->pose.inclination},
    };
    int largest = 0;

    for (int k = 1; k < (int)(sizeof moves / sizeof moves[0]); ++k) {
        if (fabs(moves[k].move) > fabs(moves[largest].move)) {
            largest = k;
        }
    }
    config_complain(conf, moves[largest].key,
                    "must leave the gears in mesh, with tips that reach each other and stay clear "
                    "of the roots, faces that overlap, and tilts of less than an eighth of the "
                    "transverse base pitch over the face (got %.9g)",
                    moves[largest].amount);
    return EXIT_BAD_INPUT;
}

/* Pair, flanks and law as one object; none without a stiffness, which only a run requires. */
static int prepare(gear_mesh *mesh, const config *conf) {
    gm_mesh_params params;

    gm_mesh_params_default(&params);
    params.model = conf->model == MODEL_SIMPLE ? GM_MODEL_SIMPLE : GM_MODEL_3D;
    params.stiffness = conf->stiffness;
    params.damping = conf->damping;
    params.simple_stiffness = conf->simple_stiffness;
    params.pose = conf->pose;

    const size_t size = gm_mesh_size(&params, &mesh->pair);
    if (size == 0) {
        return 0;
    }
    void *memory = malloc(size);
    if (memory == NULL) {
        return message_no_memory(conf->messages);
    }
    const int status =
        gm_mesh_init(&mesh->prepared, &params, &mesh->pair, mesh->flanks[GM_PINION].prepared,
                     mesh->flanks[GM_WHEEL].prepared, memory, size);
    if (status == GM_OK) {
        return 0;
    }
    free(memory);
    return status == GM_POSE_OUT_OF_MESH ? refuse_pose(conf, &mesh->pair) : EXIT_RUN_FAILED;
}

int gear_mesh_open(gear_mesh *mesh, const config *conf) {
    memset(mesh, 0, sizeof *mesh);

    int status = drawing_derive(&mesh->pair, conf);
    if (status != 0) {
        return status;
    }
    if (conf->purpose != CONFIG_FOR_FLANKS) {
        drawing_warn(conf, &mesh->pair);
    }

    if (conf->model == MODEL_3D && conf->purpose == CONFIG_FOR_RUN) {
        status = load_flanks(mesh, conf);
    }
    if (status == 0) {
        status = prepare(mesh, conf);
    }
    if (status != 0) {
        gear_mesh_close(mesh);
    }
    return status;
}

void gear_mesh_close(gear_mesh *mesh) {
    free(mesh->prepared); /* it begins at its memory */
    gear_flanks_free(&mesh->flanks[GM_PINION]);
    gear_flanks_free(&mesh->flanks[GM_WHEEL]);
    memset(mesh, 0, sizeof *mesh);
}

double gear_mesh_eigenfrequency(const gear_mesh *mesh, const config *conf) {
    const double pinion_inertia = conf->drive == DRIVE_TORQUE ? conf->pinion_inertia : HUGE_VAL;

    return gm_mesh_eigenfrequency(mesh->prepared, pinion_inertia, conf->wheel_inertia);
}

int gear_mesh_note(const gear_mesh *mesh, config *conf) {
    const double frequency = gear_mesh_eigenfrequency(mesh, conf);
    int status = 0;

    for (enum gm_role gear = GM_PINION; gear <= GM_WHEEL && status == 0; ++gear) {
        status = gear_flanks_note(&mesh->flanks[gear], conf, gear);
    }
    if (status == 0 && isfinite(frequency)) {
        status = config_note(conf, "eigenfrequency_Hz", frequency);
    }
    return status == 0 ? 0 : message_no_memory(conf->messages);
}
