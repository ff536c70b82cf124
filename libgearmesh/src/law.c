/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The force law: how force follows from overlap. Force and gradient stand in law.h, to be inlined; here are their
 * inverse, and what users ask of a mesh as a whole. Lines that lean, corners and line loads take its stiffness per length.
 */
#include "law.h"

#include "internal.h"
#include "mesh.h"

#include <math.h>

/* Both models share eigenfrequency and damping ratio unless the simple one has a spring of its own. */
gmi_law gmi_law_of(const gm_mesh_params *params, const gm_pair *pair) {
    const double contact_ratio = pair->transverse_contact_ratio;
    const double stiffness =
        params->law == GM_LAW_ISO6336
            ? pair->face_width * gm_iso6336_single_stiffness(pair, params->iso_blank_factor)
            : params->stiffness;
    gmi_law law = {stiffness, params->damping, stiffness * contact_ratio};

    /* The simple model has no lines: its spring is the mean of theirs. */
    if (params->model == GM_MODEL_SIMPLE) {
        law.damping = params->damping * contact_ratio;
        law.stiffness =
            isnan(params->simple_stiffness) ? law.mean_stiffness : params->simple_stiffness;
        law.mean_stiffness = law.stiffness;
    }
    return law;
}

double gmi_law_sum_of_torque(const gmi_law *law, double torque, double base_radius) {
    return torque / (law->stiffness * base_radius);
}

double gm_mesh_mean_stiffness(const gm_mesh *mesh) {
    return mesh == NULL ? gmi_nan() : mesh->law.mean_stiffness;
}

double gm_mesh_mean_damping(const gm_mesh *mesh) {
    if (mesh == NULL) {
        return gmi_nan();
    }
    return mesh->law.damping * (mesh->law.mean_stiffness / mesh->law.stiffness);
}

double gm_mesh_touching_stiffness(const gm_mesh *mesh, const gm_mesh_result *result) {
    if (mesh == NULL || result == NULL) {
        return gmi_nan();
    }
    return mesh->law.stiffness * (result->contact.drive_contact + result->contact.coast_contact);
}

double gm_mesh_eigenfrequency(const gm_mesh *mesh, double pinion_inertia, double wheel_inertia) {
    if (mesh == NULL || !(pinion_inertia > 0.0) || !(wheel_inertia > 0.0)) {
        return gmi_nan();
    }

    /* What a force of 1 N along the line of action does to x'' (1/kg); nothing through an infinite inertia. */
    const double r_bp = mesh->pair->pinion.base_radius;
    const double r_bw = mesh->pair->wheel.base_radius;
    const double mobility = r_bp * r_bp / pinion_inertia + r_bw * r_bw / wheel_inertia;
    return sqrt(mesh->law.mean_stiffness * mobility) / GMI_TWO_PI;
}
