/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Flanks from arrays: a pinion whose teeth run out by 10 um and have a tip relief of 8 um. Prints how far the
 * transmission error under load wanders during one turn of the pinion.
 */
#include <gearmesh/gearmesh.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TEETH = 45, FACE_NODES = 3, PROFILE_NODES = 21, POSITIONS = 40 * TEETH };

static const double pi = 3.14159265358979323846;
static const double run_out = 10e-6, relief = 8e-6; /* along the surface normal (m) */

/* One tooth: t1 along the face, t2 from the start of the profile (0) to the tip (1), > 0 material added. */
static void fill(double deviation[FACE_NODES][PROFILE_NODES], int tooth) {
    for (int i = 0; i < FACE_NODES; ++i) {
        for (int k = 0; k < PROFILE_NODES; ++k) {
            const double t2 = (double)k / (PROFILE_NODES - 1);
            const double above = fmax(0.0, t2 - 0.7) / 0.3; /* the relief begins at 0.7 */
            deviation[i][k] = run_out * sin(2.0 * pi * tooth / TEETH) - relief * above * above;
        }
    }
}

int main(void) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = TEETH;
    params.wheel_teeth = 41;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 0.279252680;
    params.helix_angle = 0.575958653;
    params.center_distance = 0.085;
    params.face_width = 0.0175;
    params.backlash = 100e-6;

    gm_pair pair;
    int status = gm_pair_init(&pair, &params);

    /* A table for each tooth of the drive side, in memory of our own; the coast side stays ideal. */
    const gm_flanks_params sizes = {.teeth = TEETH,
                                    .drive_tables = TEETH,
                                    .drive_face_nodes = FACE_NODES,
                                    .drive_profile_nodes = PROFILE_NODES};
    const size_t size = gm_flanks_size(&sizes);
    void *memory = malloc(size);
    gm_flanks *pinion_flanks;
    if (status == GM_OK) {
        status = gm_flanks_init(&pinion_flanks, &sizes, memory, size);
    }
    for (int tooth = 0; tooth < TEETH && status == GM_OK; ++tooth) {
        double deviation[FACE_NODES][PROFILE_NODES];
        fill(deviation, tooth);
        status = gm_flanks_set_table(pinion_flanks, GM_DRIVE, tooth, &deviation[0][0],
                                     pair.normal_to_transverse);
    }

    /* Pair, flanks and stiffness of a pair of teeth as one object. */
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = 1.05e8;
    static double mesh_memory[256];
    gm_mesh *mesh;
    if (status == GM_OK) {
        status =
            gm_mesh_init(&mesh, &law, &pair, pinion_flanks, NULL, mesh_memory, sizeof mesh_memory);
    }

    /* The quasi-static transmission error under 20 N m; each position begins where the last one was. */
    double offset = (double)NAN;
    double lowest = HUGE_VAL;
    double highest = -HUGE_VAL;
    for (int i = 0; i < POSITIONS && status == GM_OK; ++i) {
        status = gm_static_equilibrium(mesh, 2.0 * pi * i / POSITIONS, 20.0, offset, NULL, &offset,
                                       NULL);
        lowest = fmin(lowest, -offset);
        highest = fmax(highest, -offset);
    }
    free(memory);

    if (status != GM_OK) {
        fprintf(stderr, "%s\n", gm_status_text(status));
        return 1;
    }
    printf("transmission error: %.1f um peak to peak\n", (highest - lowest) * 1e6);
    return 0;
}
