/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Friction of elastic teeth: at each point of the lines mu_r / cos(beta_b) times the force that it carries, by the sliding
 * speed there. Derivatives are those of teeth in balance, by one adjoint solution for the friction and one for its torque.
 *
 * What damping adds to the force of a side is taken to be distributed over the points as the elastic one.
 */
#include "contact.h"
#include "elastic.h"
#include "elastic_mesh.h"
#include "friction.h"
#include "internal.h"
#include "law.h"
#include "mesh.h"
#include "meshing.h"
#include "tilt.h"

/* Sums over the points of a side, each force with its share. */
typedef struct point_sums {
    double force, moment, force_t1, loss;

    /* Derivatives of force and moment by both speeds. */
    double by_speed[2], moment_by_speed[2];
} point_sums;

static gmi_point_friction friction_at(const gm_mesh *mesh, const gmi_sliding *sliding,
                                      const gmi_elastic_work *work, int p) {
    const double t1 = mesh->engagement.face_from + work->z[p] / mesh->pair->face_width;
    return gmi_friction_at(sliding, work->roll[p], t1, work->load[p] * mesh->pair->face_width);
}

static point_sums sum_points(const gm_mesh *mesh, const gmi_sliding *sliding,
                             const gmi_elastic_work *work) {
    point_sums sums = {.force = 0.0};
    const double per_width = 1.0 / mesh->pair->face_width;
    const gmi_rolling_by rolling = gmi_rolling_differentiate(sliding);
    for (int p = 0; p < 2 * work->slots; ++p) {
        const gmi_point_friction at = friction_at(mesh, sliding, work, p);
        const double friction = at.share * work->force[p];
        sums.force += friction;
        sums.moment += friction * work->roll[p];
        sums.force_t1 += friction * (mesh->engagement.face_from + work->z[p] * per_width);
        sums.loss += friction * at.speed;

        const double rho_w = sliding->line_of_action - work->roll[p];
        const double by_speed[2] = {
            at.by_speed * work->roll[p] + at.by_rolling * rolling.pinion_speed,
            sliding->wheel_sign * (at.by_rolling * rolling.wheel_speed - at.by_speed * rho_w)};
        for (int k = 0; k < 2; ++k) {
            sums.by_speed[k] += by_speed[k] * work->force[p];
            sums.moment_by_speed[k] += by_speed[k] * work->force[p] * work->roll[p];
        }
    }
    return sums;
}

/* Derivatives of the friction, or of its moment, by x of the teeth and by their roll. */
static gmi_elastic_gradient differentiate(const gm_mesh *mesh, const gmi_sliding *sliding,
                                          int is_moment, gmi_elastic_work *work) {
    double *factor = work->table[0], *by_deviation = work->table[0] + 2 * work->slots;
    double *by_roll = work->table[1], *by_z = work->table[2], *by_load = work->table[3];
    const double both = sliding->pinion_speed + sliding->wheel_speed;
    for (int p = 0; p < 2 * work->slots; ++p) {
        const gmi_point_friction at = friction_at(mesh, sliding, work, p);
        const double arm = is_moment ? work->roll[p] : 1.0;
        factor[p] = arm * (at.share + at.by_load);
        const int is_kept = work->at.goes_on && work->beyond[p] != 0.0; /* at the end of the path */
        by_roll[p] = is_kept ? 0.0 : arm * at.by_speed * both + (is_moment ? at.share : 0.0);
        by_z[p] = -arm * at.by_speed * sliding->sideways[1] / mesh->pair->face_width;
        by_load[p] = arm * at.by_load;
    }
    const gmi_elastic_functional functional = {factor, by_roll, by_z, by_load};
    gmi_elastic_gradient gradient;
    gmi_elastic_differentiate_functional(&mesh->elastic->law, work, &functional, by_deviation,
                                         &gradient);
    return gradient;
}

/*
 * Of the sum of all line loads F_t, by the roll, with bodies in series; F itself where no edge enters, whose arm is shorter.
 */
static double loads_by_origin(const gm_mesh *mesh, const gmi_side_sum *total, double by_teeth,
                              gmi_elastic_work *work) {
    const double body = mesh->elastic->body_compliance;
    if (!work->is_entering || body == 0.0) {
        return mesh->law.stiffness * total->by_origin;
    }
    gmi_elastic_gradient loads, energy;
    gmi_elastic_differentiate(&mesh->elastic->law, work, &loads, &energy);
    return loads.by_roll / (1.0 + body * by_teeth);
}

/*
 * Over the force of the side, with derivatives. Bodies in series take a part of x: x of the teeth is x - c F_t, so that it
 * moves by 1 / (1 + c dF_t/dx) with x, and falls by c dF_t/d roll with the roll.
 */
static gmi_varying per_force(const gm_mesh *mesh, int side, const gmi_sliding *sliding,
                             const gmi_side_sum *total, double value, int is_moment,
                             const double by_speed[2], int with_derivatives,
                             gmi_elastic_work *work) {
    const double force = mesh->law.stiffness * total->sum;
    const double mean = value / force;
    gmi_varying result = {.value = mean};
    if (!with_derivatives) {
        return result;
    }

    const gmi_engagement *at = &mesh->engagement;
    const double body = mesh->elastic->body_compliance;
    const double by_teeth = gmi_elastic_sum(2 * work->slots, work->by_deviation);
    const double gain = at->is_tilted ? gmi_tilt_gain(mesh->pair, at, side) : 1.0;
    double held = 0.0, held_teeth = 0.0;
    const double force_by_origin = mesh->law.stiffness * total->by_origin;
    const double force_by_delta = mesh->law.stiffness * total->by_delta;
    const double teeth_by_origin = -body * loads_by_origin(mesh, total, by_teeth, work);
    const gmi_elastic_gradient by = differentiate(mesh, sliding, is_moment, work);
    const double by_origin = by.by_roll + by.by_approach * teeth_by_origin;

    /* The gap of the wheel's edge follows x by itself. */
    const double *by_deviation = work->table[0] + 2 * work->slots;
    for (int p = 0; p < 2 * work->slots && work->is_entering; ++p) {
        held += by_deviation[p] * work->entry_slope[p];
        held_teeth += work->by_deviation[p] * work->entry_slope[p];
    }
    const double moved = (gain + body * held_teeth) / (1.0 + body * by_teeth);
    const double by_delta = moved * by.by_approach - held;
    result = gmi_varying_of(mesh->pair, side, mean, (by_origin - mean * force_by_origin) / force,
                            (by_delta - mean * force_by_delta) / force, 0.0);
    result.by[GMI_PINION_SPEED] = by_speed[0] / force;
    result.by[GMI_WHEEL_SPEED] = by_speed[1] / force;
    return result;
}

void gmi_elastic_friction(const gm_mesh *mesh, int side, double approach_speed,
                          const gmi_sliding *sliding, const gmi_side_sum *total, int mask,
                          gm_workspace *workspace, gmi_friction_sum *friction) {
    const gmi_friction_sum none = {.loss = 0.0};
    *friction = none;
    gmi_side_force force;
    gmi_law_force(&mesh->law, total, approach_speed, mask, &force);
    if (!(total->sum > 0.0 && force.force > 0.0)) {
        return;
    }

    /* Of the elastic force, and then of all of it. */
    gmi_elastic_work *work = &workspace->side[side];
    const int with_derivatives = (mask & GMI_DERIVATIVES) != 0;
    const point_sums sums = sum_points(mesh, sliding, work);
    const gmi_varying share =
        per_force(mesh, side, sliding, total, sums.force, 0, sums.by_speed, with_derivatives, work);
    const gmi_varying arm = per_force(mesh, side, sliding, total, sums.moment, 1,
                                      sums.moment_by_speed, with_derivatives, work);
    const gmi_varying all = gmi_varying_of(mesh->pair, side, force.force, force.by_origin,
                                           force.by_delta, force.by_speed);
    const double with_damping = force.force / (mesh->law.stiffness * total->sum);
    gmi_varying_add_product(&share, &all, &friction->force);
    gmi_varying_add_product(&arm, &all, &friction->moment);
    friction->force_t1 = with_damping * sums.force_t1;
    friction->loss = with_damping * sums.loss;
    gmi_friction_finish(sliding, &all, friction, NULL);
}
