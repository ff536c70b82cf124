/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The program of README.md: the force between two gears in one position. */
#include <gearmesh/gearmesh.h>
#include <stdio.h>

int main(void) {
    gm_pair_params params; /* SI units and radians everywhere */
    gm_pair_params_default(&params);
    params.pinion_teeth = 45;
    params.wheel_teeth = 41;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 0.279252680;
    params.helix_angle = 0.575958653;
    params.center_distance = 0.085;
    params.face_width = 0.0175;
    params.backlash = 100e-6; /* the rest is derived: profile shifts, tip and start radii */

    gm_pair pair;
    int status = gm_pair_init(&pair, &params);

    gm_mesh_params law; /* stiffness and damping of one pair of teeth */
    gm_mesh_params_default(&law);
    law.stiffness = 1.05e8; /* N/m */
    law.damping = 844;      /* N s/m */

    static double memory[256]; /* of our own: the library takes none */
    gm_mesh *mesh; /* prepared once, read-only afterwards; NULL: ideal flanks on both gears */
    if (status == GM_OK) {
        status = gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, sizeof memory);
    }

    const gm_state state = {.pinion_angle = 1.25e-3, .wheel_angle = 0, .pinion_speed = 0.01};
    gm_mesh_result result;
    if (status == GM_OK) {
        status = gm_mesh_evaluate(mesh, &state, GM_WANT_DERIVATIVES, NULL, &result);
    }
    if (status != GM_OK) {
        fprintf(stderr, "%s\n", gm_status_text(status));
        return 1;
    }

    printf("force %.2f N, by pinion angle %.4g N/rad, %d pairs\n", result.force,
           result.force_by.pinion_angle, result.contact.drive_pairs);
    return 0;
}
