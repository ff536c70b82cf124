/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Loops over arrays, included in the extension module: what Python would pay for each call it pays once. A state that
 * is refused (status > 0) leaves NaN; a call that is at fault (status < 0) ends the loop and is returned.
 */
#include <gearmesh/gearmesh.h>
#include <math.h>

/* poses: NULL, or [count][2] pose of the wheel and its rate. */
static int evaluate_position(const gm_mesh *mesh, const gm_position *position, const gm_pose *pose,
                             int wanted, gm_workspace *workspace, gm_mesh_result *result) {
    if (pose == NULL) {
        return gm_mesh_evaluate_at(mesh, position, wanted, workspace, result);
    }
    const gm_motion motion = {.position = *position, .pose = pose[0], .pose_rate = pose[1]};
    return gm_mesh_evaluate_posed(mesh, &motion, wanted, workspace, result);
}

static int evaluate_states(const gm_mesh *mesh, size_t count, const gm_state *states,
                           const gm_pose *poses, int wanted, gm_workspace *workspace,
                           gm_mesh_result *results) {
    int status = GM_OK;
    for (size_t k = 0; k < count && status >= GM_OK; ++k) {
        gm_position position;
        status = gm_position_from_state(gm_mesh_pair(mesh), &states[k], &position);
        if (status >= GM_OK) {
            /* What is refused as angles is NaN in the position, and refused again. */
            status = evaluate_position(mesh, &position, poses != NULL ? &poses[2 * k] : NULL,
                                       wanted, workspace, &results[k]);
        }
    }
    return status < GM_OK ? status : GM_OK;
}

/* poses: [count][2] as above, here not NULL. */
static int evaluate_tangents(const gm_mesh *mesh, size_t count, const gm_state *states,
                             const gm_pose *poses, gm_tangent *tangents) {
    int status = GM_OK;
    for (size_t k = 0; k < count && status >= GM_OK; ++k) {
        gm_motion motion = {.pose = poses[2 * k], .pose_rate = poses[2 * k + 1]};
        status = gm_position_from_state(gm_mesh_pair(mesh), &states[k], &motion.position);
        if (status >= GM_OK) {
            status = gm_mesh_tangent(mesh, &motion, &tangents[k]);
        }
    }
    return status < GM_OK ? status : GM_OK;
}

/* coordinates: [count][3] pinion angle (rad), x (m), dx/dt (m/s). */
static int evaluate_offsets(const gm_mesh *mesh, size_t count, const double *coordinates,
                            const gm_pose *poses, int wanted, gm_workspace *workspace,
                            gm_mesh_result *results) {
    int status = GM_OK;
    for (size_t k = 0; k < count && status >= GM_OK; ++k) {
        const double *given = &coordinates[3 * k];
        gm_position position;
        status = gm_position_from_pinion_angle(gm_mesh_pair(mesh), given[0], given[1], given[2],
                                               &position);
        if (status >= GM_OK) {
            status = evaluate_position(mesh, &position, poses != NULL ? &poses[2 * k] : NULL,
                                       wanted, workspace, &results[k]);
        }
    }
    return status < GM_OK ? status : GM_OK;
}

/* bodies, loads: [count][2] pinion, wheel. */
static int evaluate_bodies(const gm_mesh *mesh, size_t count, const gm_body *bodies, int wanted,
                           gm_workspace *workspace, gm_mesh_result *results, gm_load *loads) {
    int status = GM_OK;
    for (size_t k = 0; k < count && status >= GM_OK; ++k) {
        status = gm_mesh_evaluate_bodies(mesh, &bodies[2 * k], &bodies[2 * k + 1], wanted,
                                         workspace, &results[k], &loads[2 * k], &loads[2 * k + 1]);
    }
    return status < GM_OK ? status : GM_OK;
}

/* loads: [count][2] pinion angle (rad), torque on the wheel (N m). */
static int solve_static(const gm_mesh *mesh, size_t count, const double *loads,
                        gm_workspace *workspace, double *offsets, gm_mesh_result *results) {
    const gm_pair *pair = gm_mesh_pair(mesh);
    const double r_bp = pair->pinion.base_radius;
    const double r_bw = pair->wheel.base_radius;
    int status = GM_OK;
    for (size_t k = 0; k < count && status >= GM_OK; ++k) {
        const double *load = &loads[2 * k];

        /* From one position to the next, x goes on in first order. */
        double guess = NAN;
        if (k > 0 && load[1] == load[-1]) {
            const gm_gradient *by = &results[k - 1].force_by;
            guess = offsets[k - 1] +
                    (r_bp + r_bw * by->pinion_angle / by->wheel_angle) * (load[0] - load[-2]);
        }
        status = gm_static_equilibrium(mesh, load[0], load[1], guess, workspace, &offsets[k],
                                       &results[k]);
    }
    return status < GM_OK ? status : GM_OK;
}
