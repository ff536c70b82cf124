/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file plain_mesh.h
 * Evaluations of two gears that no mesh has been prepared for: prepares one for each call. For tests, which look at many
 * pairs once.
 */
#ifndef PLAIN_MESH_H
#define PLAIN_MESH_H

#include "gearmesh/gearmesh.h"
#include "gm_test.h"

/** Room for any mesh of the constant law, with corners too. */
typedef union plain_mesh {
    double alignment;
    char memory[8192];
} plain_mesh;

/** Stiffness of plain_law() (N/m). */
static const double plain_stiffness = 1e8;

/** Constant stiffness without damping, with corners or without. */
GM_TEST_UNUSED static gm_mesh_params plain_law(int corner) {
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = plain_stiffness;
    law.corner_contact = corner;
    return law;
}

/** A mesh of any such law between the flanks of both gears, NULL without any. Returns the status of gm_mesh_init(). */
GM_TEST_UNUSED static int plain_mesh_of(plain_mesh *room, const gm_pair *pair,
                                        const gm_flanks *const use[2], const gm_mesh_params *law,
                                        gm_mesh **mesh) {
    return gm_mesh_init(mesh, law, pair, use != NULL ? use[0] : NULL, use != NULL ? use[1] : NULL,
                        room->memory, sizeof room->memory);
}

/** Returns the status of gm_mesh_init(); *mesh is NULL on an error. */
GM_TEST_UNUSED static int plain_mesh_make(plain_mesh *room, const gm_pair *pair,
                                          const gm_flanks *pinion, const gm_flanks *wheel,
                                          double stiffness, double damping, gm_mesh **mesh) {
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.stiffness = stiffness;
    params.damping = damping;
    return gm_mesh_init(mesh, &params, pair, pinion, wheel, room->memory, sizeof room->memory);
}

GM_TEST_UNUSED static int plain_evaluate(const gm_pair *pair, const gm_flanks *pinion,
                                         const gm_flanks *wheel, const gm_position *position,
                                         double stiffness, double damping, int wanted,
                                         gm_mesh_result *result) {
    plain_mesh room;
    gm_mesh *mesh;
    const int made = plain_mesh_make(&room, pair, pinion, wheel, stiffness, damping, &mesh);
    const int status = gm_mesh_evaluate_at(mesh, position, wanted, NULL, result);
    return made != GM_OK ? made : status;
}

/** No result to write to, no result of the library either. */
GM_TEST_UNUSED static int plain_contact(const gm_pair *pair, const gm_flanks *pinion,
                                        const gm_flanks *wheel, const gm_position *position,
                                        int wanted, gm_penetration *penetration) {
    gm_mesh_result result;
    const int status = plain_evaluate(pair, pinion, wheel, position, 1.0, 0.0, wanted,
                                      penetration == NULL ? NULL : &result);
    if (penetration != NULL) {
        *penetration = result.contact;
    }
    return status;
}

/** Overlap and contact with exact derivatives. */
GM_TEST_UNUSED static int penetration_3d_at(const gm_pair *pair, const gm_flanks *pinion,
                                            const gm_flanks *wheel, const gm_position *position,
                                            gm_penetration *penetration) {
    return plain_contact(pair, pinion, wheel, position, GM_WANT_DERIVATIVES, penetration);
}

/** The same without derivatives. */
GM_TEST_UNUSED static int penetration_3d_sum_at(const gm_pair *pair, const gm_flanks *pinion,
                                                const gm_flanks *wheel, const gm_position *position,
                                                gm_penetration *penetration) {
    return plain_contact(pair, pinion, wheel, position, GM_WANT_FORCE, penetration);
}

/** The simple model at x. */
GM_TEST_UNUSED static int penetration_simple_at(const gm_pair *pair, double offset,
                                                double offset_rate, gm_penetration *penetration) {
    const gm_position position = {.offset = offset, .offset_rate = offset_rate};
    plain_mesh room;
    gm_mesh *mesh;
    gm_mesh_params params;
    gm_mesh_result result;
    gm_mesh_params_default(&params);
    params.model = GM_MODEL_SIMPLE;
    params.stiffness = 1.0;
    const int made =
        gm_mesh_init(&mesh, &params, pair, NULL, NULL, room.memory, sizeof room.memory);
    const int status = gm_mesh_evaluate_at(mesh, &position, GM_WANT_DERIVATIVES, NULL,
                                           penetration == NULL ? NULL : &result);
    if (penetration != NULL) {
        *penetration = result.contact;
    }
    return made != GM_OK ? made : status;
}

GM_TEST_UNUSED static int wrench_3d_at(const gm_pair *pair, const gm_flanks *pinion,
                                       const gm_flanks *wheel, const gm_position *position,
                                       double stiffness, double damping, gm_wrench *wrench) {
    gm_mesh_result result;
    const int status = plain_evaluate(pair, pinion, wheel, position, stiffness, damping,
                                      GM_WANT_WRENCH, wrench == NULL ? NULL : &result);
    if (wrench != NULL) {
        *wrench = result.wrench;
    }
    return status;
}

GM_TEST_UNUSED static int equilibrium_near(const gm_pair *pair, const gm_flanks *pinion,
                                           const gm_flanks *wheel, double pinion_angle,
                                           double stiffness, double torque, double guess,
                                           double *offset, gm_penetration *penetration) {
    plain_mesh room;
    gm_mesh *mesh;
    gm_mesh_result result;
    const int made = plain_mesh_make(&room, pair, pinion, wheel, stiffness, 0.0, &mesh);
    const int status =
        gm_static_equilibrium(mesh, pinion_angle, torque, guess, NULL, offset, &result);
    if (penetration != NULL) {
        *penetration = result.contact;
    }
    return made != GM_OK ? made : status;
}

GM_TEST_UNUSED static int equilibrium(const gm_pair *pair, const gm_flanks *pinion,
                                      const gm_flanks *wheel, double pinion_angle, double stiffness,
                                      double torque, double *offset, gm_penetration *penetration) {
    return equilibrium_near(pair, pinion, wheel, pinion_angle, stiffness, torque, (double)NAN,
                            offset, penetration);
}

#endif /* PLAIN_MESH_H */
