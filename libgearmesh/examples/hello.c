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

    gm_pair pair; /* once, read-only afterwards */
    gm_penetration mesh;
    const gm_state state = {.pinion_angle = 1.25e-3, .wheel_angle = 0, .pinion_speed = 0.01};
    int status = gm_pair_init(&pair, &params);
    if (status == GM_OK) /* NULL: ideal flanks on both gears */
        status = gm_penetration_3d(&pair, NULL, NULL, &state, &mesh);
    if (status != GM_OK)
        return fprintf(stderr, "%s\n", gm_status_text(status)), 1;

    const double K = 1.05e8, D = 844; /* of one pair of teeth: N/m, N s/m */
    printf("force %.2f N, ", gm_contact_force(K, D, &mesh));
    printf("by pinion angle %.4g N/rad, %d pairs\n", K * mesh.d_pinion_angle, mesh.drive_pairs);
    return 0;
}
