/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "gear_mesh.h"
#include "drawing.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Both models shall share eigenfrequency and damping ratio unless told otherwise. */
static void derive_simple_model(gear_mesh *mesh, const config *conf) {
    const double contact_ratio = mesh->pair.transverse_contact_ratio;

    mesh->simple_stiffness =
        isnan(conf->simple_stiffness) ? conf->stiffness * contact_ratio : conf->simple_stiffness;
    mesh->simple_damping = conf->damping * contact_ratio;
}

/* Flanks with deviations are evaluated on faces that both begin and end together. */
static int check_faces(const gear_mesh *mesh, const config *conf) {
    static const char *const keys[] = {"gears.axial_offset_mm", "gears.pinion_face_width_mm",
                                       "gears.wheel_face_width_mm"};
    const gm_pair *pair = &mesh->pair;
    int key = 0;

    if (pair->wheel.face_start == 0 && pair->pinion.face_width == pair->wheel.face_width) {
        return 0;
    }
    while (key < 2 && config_text(conf, keys[key]) == NULL) {
        ++key;
    }
    config_complain(
        conf, keys[key],
        "must leave both gears the same face for flanks with deviations or "
        "modifications (got a pinion from 0 to %.9g mm and a wheel from %.9g to %.9g mm)",
        1e3 * pair->pinion.face_width, 1e3 * pair->wheel.face_start,
        1e3 * (pair->wheel.face_start + pair->wheel.face_width));
    return EXIT_BAD_INPUT;
}

static int load_flanks(gear_mesh *mesh, const config *conf) {
    gear_flanks *pinion = &mesh->loaded_flanks[GM_PINION];
    gear_flanks *wheel = &mesh->loaded_flanks[GM_WHEEL];

    int status = gear_flanks_load(pinion, conf, &mesh->pair, GM_PINION);
    if (status == 0) {
        status = gear_flanks_load(wheel, conf, &mesh->pair, GM_WHEEL);
    }
    if (status == 0 && (pinion->memory != NULL || wheel->memory != NULL)) {
        status = check_faces(mesh, conf);
    }

    mesh->pinion_flanks = pinion->memory != NULL ? &pinion->storage : NULL;
    mesh->wheel_flanks = wheel->memory != NULL ? &wheel->storage : NULL;
    return status;
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
    derive_simple_model(mesh, conf);

    if (conf->model == MODEL_3D && conf->purpose == CONFIG_FOR_RUN) {
        status = load_flanks(mesh, conf);
    }
    if (status != 0) {
        gear_mesh_close(mesh);
    }
    return status;
}

void gear_mesh_close(gear_mesh *mesh) {
    gear_flanks_free(&mesh->loaded_flanks[GM_PINION]);
    gear_flanks_free(&mesh->loaded_flanks[GM_WHEEL]);
    memset(mesh, 0, sizeof *mesh);
}

double gear_mesh_mean_stiffness(const gear_mesh *mesh, const config *conf) {
    return conf->model == MODEL_SIMPLE ? mesh->simple_stiffness
                                       : conf->stiffness * mesh->pair.transverse_contact_ratio;
}

double gear_mesh_eigenfrequency(const gear_mesh *mesh, const config *conf) {
    const double r_bp = mesh->pair.pinion.base_radius;
    const double r_bw = mesh->pair.wheel.base_radius;
    double mobility = r_bw * r_bw / conf->wheel_inertia;

    if (conf->drive == DRIVE_TORQUE) {
        mobility += r_bp * r_bp / conf->pinion_inertia;
    }
    return sqrt(gear_mesh_mean_stiffness(mesh, conf) * mobility) / (2 * pi);
}

int gear_mesh_note(const gear_mesh *mesh, config *conf) {
    const double frequency = gear_mesh_eigenfrequency(mesh, conf);
    int status = 0;

    for (int gear = 0; gear < 2 && status == 0; ++gear) {
        status = gear_flanks_note(&mesh->loaded_flanks[gear], conf, gear);
    }
    if (status == 0 && isfinite(frequency)) {
        status = config_note(conf, "eigenfrequency_Hz", frequency);
    }
    return status == 0 ? 0 : message_no_memory(conf->messages);
}
