/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * A gear pair in a loop of fixed steps, as in a control unit or a hardware-in-the-loop bench: no heap, no files, bounded
 * work in each step. The pinion turns at constant speed, 1000 teeth a second; a load torque acts on the wheel. First with
 * a constant stiffness of the teeth, then with elastic ones.
 *
 * With x = r_bp phi_p - r_bw phi_w and I_w phi_w'' = F r_bw - M_w:  x'' = (M_w - F r_bw) r_bw / I_w
 */
#include <gearmesh/gearmesh.h>
#include <stdio.h>

enum { STEPS_PER_SECOND = 20000, STEPS_PER_MESH_CYCLE = 20 };

static const double inertia = 2.1e-3, load = 20; /* of the wheel (kg m2, N m) */
static const double speed = 139.62634;           /* of the pinion: 2 pi 1000 / 45 (rad/s) */

typedef struct motion {
    double pinion_angle; /* (rad) */
    double offset;       /* x (m) */
    double offset_rate;  /* (m/s) */
} motion;

/* One step (semi-implicit Euler); the force of the contact comes back. Status as in gearmesh.h. */
static int step(const gm_mesh *mesh, gm_workspace *workspace, motion *now, double dt,
                double *force) {
    const gm_pair *pair = gm_mesh_pair(mesh);
    gm_position position;
    gm_mesh_result result;
    int status = gm_position_from_pinion_angle(pair, now->pinion_angle, now->offset,
                                               now->offset_rate, &position);
    if (status == GM_OK) {
        status = gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, workspace, &result);
    }
    if (status != GM_OK) {
        return status;
    }
    *force = result.force;

    const double r_bw = pair->wheel.base_radius;
    now->offset_rate += dt * (load - *force * r_bw) * r_bw / inertia;
    now->offset += dt * now->offset_rate;
    now->pinion_angle += dt * speed;
    return GM_OK;
}

/* Half a second with one law, from rest at the middle of the backlash, which the load closes. Of the last 100 mesh cycles
 * the mean torque of the contact comes back: it is the load. */
static int run(const gm_pair *pair, const gm_mesh_params *law, double *torque) {
    /* Prepared before the loop, in memory of our own: enough for elastic teeth with 5 stations. Ideal flanks. */
    static double mesh_memory[8500], workspace_memory[12000];
    gm_mesh *mesh;
    gm_workspace *workspace = NULL;
    int status = gm_mesh_init(&mesh, law, pair, NULL, NULL, mesh_memory, sizeof mesh_memory);
    if (status == GM_OK) {
        status = gm_workspace_init(&workspace, mesh, workspace_memory, sizeof workspace_memory);
    }

    const double dt = 1.0 / STEPS_PER_SECOND;
    const int steps = STEPS_PER_SECOND / 2;
    const int counted = 100 * STEPS_PER_MESH_CYCLE;
    motion now = {0};
    double sum = 0;
    for (int i = 0; i < steps && status == GM_OK; ++i) {
        double force;
        status = step(mesh, workspace, &now, dt, &force);
        if (status == GM_OK && i >= steps - counted) {
            sum += force * pair->wheel.base_radius;
        }
    }
    *torque = sum / counted;
    return status;
}

int main(void) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 45;
    params.wheel_teeth = 41;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 0.279252680;
    params.helix_angle = 0.575958653;
    params.center_distance = 0.085;
    params.face_width = 0.0175;
    params.backlash = 100e-6;

    gm_pair pair;
    int status = gm_pair_init(&pair, &params);

    /* Stiffness of one pair of teeth, or none: it follows from drawing and material. */
    gm_mesh_params law[2];
    static const char *const name[2] = {"constant stiffness", "elastic teeth"};
    for (int k = 0; k < 2; ++k) {
        gm_mesh_params_default(&law[k]);
        law[k].damping = 844;
    }
    law[0].stiffness = 1.05e8;
    law[1].law = GM_LAW_ELASTIC;
    law[1].stations = 5;

    for (int k = 0; k < 2 && status == GM_OK; ++k) {
        double torque;
        status = run(&pair, &law[k], &torque);
        if (status == GM_OK) {
            printf("%s: mean torque of the contact on the wheel: %.3f N m\n", name[k], torque);
        }
    }
    if (status != GM_OK) {
        fprintf(stderr, "%s\n", gm_status_text(status));
        return 1;
    }
    return 0;
}
