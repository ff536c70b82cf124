/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The least a program does with the core: header and library fit, a pair of gears touches. */
#include <gearmesh/gearmesh.h>
#include <stdio.h>
#include <string.h>

int main(void) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 45;
    params.wheel_teeth = 41;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 0.27925268;
    params.helix_angle = 0.57595865;
    params.center_distance = 0.085;
    params.face_width = 0.0175;

    gm_pair pair;
    const gm_state state = {.pinion_angle = 1e-3, .wheel_angle = 0, .pinion_speed = 100};
    gm_penetration result;
    int status = gm_pair_init(&pair, &params);
    if (status == GM_OK) {
        status = gm_penetration_3d(&pair, NULL, NULL, &state, &result);
    }
    if (status != GM_OK) {
        fprintf(stderr, "%s\n", gm_status_text(status));
        return 1;
    }
    printf("gearmesh %s: penetration %g um\n", gm_version(), 1e6 * result.penetration);
    return strcmp(gm_version(), GM_VERSION_STRING) != 0 || !(result.penetration > 0);
}
