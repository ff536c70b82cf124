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

/* coordinates: [count][4] pinion angle (rad), x (m), dx/dt (m/s), speed of the pinion (rad/s). */
static int evaluate_offsets(const gm_mesh *mesh, size_t count, const double *coordinates,
                            const gm_pose *poses, int wanted, gm_workspace *workspace,
                            gm_mesh_result *results) {
    int status = GM_OK;
    for (size_t k = 0; k < count && status >= GM_OK; ++k) {
        const double *given = &coordinates[4 * k];
        gm_position position;
        status = gm_position_from_pinion_angle(gm_mesh_pair(mesh), given[0], given[1], given[2],
                                               &position);
        position.pinion_speed = given[3];
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

/* Where to begin at the second of two loads [3] from the first: x goes on in first order. NaN: under another torque. */
static double guess_from(const gm_pair *pair, const double loads[6], double offset,
                         const gm_mesh_result *result) {
    const gm_gradient *by = &result->force_by;
    const double slope =
        pair->pinion.base_radius + pair->wheel.base_radius * by->pinion_angle / by->wheel_angle;

    return loads[4] == loads[1] ? offset + slope * (loads[3] - loads[0]) : NAN;
}

/* loads: [count][3] pinion angle (rad), torque on the wheel (N m), speed of the pinion (rad/s). */
static int solve_static(const gm_mesh *mesh, size_t count, const double *loads,
                        gm_workspace *workspace, double *offsets, gm_mesh_result *results) {
    const gm_pair *pair = gm_mesh_pair(mesh);
    int status = GM_OK;
    for (size_t k = 0; k < count && status >= GM_OK; ++k) {
        const double *load = &loads[3 * k];
        const double guess =
            k > 0 ? guess_from(pair, load - 3, offsets[k - 1], &results[k - 1]) : NAN;
        status = gm_rolling_equilibrium(mesh, load[0], load[2], load[1], guess, workspace,
                                        &offsets[k], &results[k]);
    }
    return status < GM_OK ? status : GM_OK;
}

/*
 * Double-helical pairs. each: [count][2] of both halves. The float of the pinion begins where it was.
 */
static int evaluate_halves_at(const gm_double_helical *gears, size_t k, const gm_position *position,
                              int wanted, double *apexes, gm_mesh_result *each,
                              gm_mesh_result *results) {
    apexes[k] = k > 0 && isfinite(apexes[k - 1]) ? apexes[k - 1] : 0.0;
    return gm_double_helical_evaluate_at(gears, position, wanted, &apexes[k], &each[2 * k],
                                         &results[k]);
}

static int evaluate_halves(const gm_double_helical *gears, size_t count, const gm_state *states,
                           int wanted, double *apexes, gm_mesh_result *each,
                           gm_mesh_result *results) {
    int status = GM_OK;
    for (size_t k = 0; k < count && status >= GM_OK; ++k) {
        gm_position position;
        status = gm_position_from_state(gm_mesh_pair(gears->half[0]), &states[k], &position);
        if (status >= GM_OK) {
            status = evaluate_halves_at(gears, k, &position, wanted, apexes, each, results);
        }
    }
    return status < GM_OK ? status : GM_OK;
}

/* coordinates as in evaluate_offsets(). */
static int evaluate_halves_offsets(const gm_double_helical *gears, size_t count,
                                   const double *coordinates, int wanted, double *apexes,
                                   gm_mesh_result *each, gm_mesh_result *results) {
    int status = GM_OK;
    for (size_t k = 0; k < count && status >= GM_OK; ++k) {
        const double *given = &coordinates[4 * k];
        gm_position position;
        status = gm_position_from_pinion_angle(gm_mesh_pair(gears->half[0]), given[0], given[1],
                                               given[2], &position);
        position.pinion_speed = given[3];
        if (status >= GM_OK) {
            status = evaluate_halves_at(gears, k, &position, wanted, apexes, each, results);
        }
    }
    return status < GM_OK ? status : GM_OK;
}

/* loads as in solve_static(). */
static int solve_halves(const gm_double_helical *gears, size_t count, const double *loads,
                        double *offsets, double *apexes, gm_mesh_result *each,
                        gm_mesh_result *results) {
    int status = GM_OK;
    for (size_t k = 0; k < count && status >= GM_OK; ++k) {
        const double *load = &loads[3 * k];
        const double guess = k > 0 ? guess_from(gm_mesh_pair(gears->half[0]), load - 3,
                                                offsets[k - 1], &results[k - 1])
                                   : NAN;
        apexes[k] = k > 0 && isfinite(apexes[k - 1]) ? apexes[k - 1] : 0.0;
        status = gm_double_helical_equilibrium(gears, load[0], load[2], load[1], guess, &offsets[k],
                                               &apexes[k], &each[2 * k], &results[k]);
    }
    return status < GM_OK ? status : GM_OK;
}
