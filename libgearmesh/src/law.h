/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* From overlap to force, and back. */
#ifndef GEARMESH_LAW_H
#define GEARMESH_LAW_H

#include "contact.h"
#include "internal.h"
#include "line.h"
#include "side_tangent.h"

/* The law of one mesh. */
typedef struct gmi_law {
    /* of one pair over the common face width; of the mesh in the simple model (N/m) */
    double stiffness;

    double damping;        /* likewise (N s/m) */
    double mean_stiffness; /* of the mesh over all pairs that touch on average (N/m) */
} gmi_law;

gmi_law gmi_law_of(const gm_mesh_params *params, const gm_pair *pair);

/* What the flanks of one side do. */
typedef struct gmi_side_force {
    double force;               /* >= 0, along the transverse line of action (N) */
    double by_origin, by_delta; /* its partial derivatives (N/m) */
    double by_speed;            /* by the approach speed (N s/m) */
    double force_t1;            /* force times mean t1 (N) */
    double force_rho;           /* force times mean rho_p (N m) */
} gmi_side_force;

/* Force of a side; here to be inlined. Constant law [Paper, Eq. 3]: K sum + D contact v, v the speed of approach. */
static inline void gmi_law_force(const gmi_law *law, const gmi_side_sum *sum, double approach_speed,
                                 int wanted, gmi_side_force *result) {
    const double k = law->stiffness;
    const double d = law->damping;
    const gmi_side_force none = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    *result = none;

    /* Teeth do not pull: damping may take the force of a side away, never turn it round. */
    const double force = k * sum->sum + d * (approach_speed * sum->contact);
    if (!(force > 0.0)) {
        return;
    }
    result->force = force;

    /* The touching part moves with the flanks as well, and with it the damping. */
    const double viscous = d * approach_speed;
    if (wanted & GMI_DERIVATIVES) {
        result->by_origin = k * sum->by_origin;
        result->by_delta = k * sum->by_delta;
        result->by_speed = d * sum->contact;
    }
    if (wanted & GMI_CONTACT_DERIVATIVES) {
        result->by_origin += viscous * sum->contact_by_origin;
        result->by_delta += viscous * sum->contact_by_delta;
    }
    if (wanted & GMI_MOMENTS) {
        result->force_t1 = k * sum->sum_t1 + viscous * sum->contact_t1;
        result->force_rho = k * sum->sum_rho + viscous * sum->contact_rho;
    }
}

/* The same from the tangent of a side, on which each point may have a speed of approach of its own. */
static inline void gmi_law_force_of_tangent(const gmi_side_tangent *tangent,
                                            gmi_side_force *result) {
    const gmi_side_force none = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    const double *force = tangent->load.force;
    *result = none;
    if (!(force[GMI_WHOLE] > 0.0)) {
        return;
    }
    result->force = force[GMI_WHOLE];
    result->force_t1 = force[GMI_BY_T1];
    result->force_rho = force[GMI_BY_RHO];
    result->by_origin = tangent->by.force[GMI_BY_ORIGIN][GMI_WHOLE];
    result->by_delta = tangent->by.force[GMI_BY_DELTA][GMI_WHOLE];
    result->by_speed = tangent->by.force[GMI_BY_DELTA_RATE][GMI_WHOLE];
}

/* Net sum of overlaps that carries a torque at rest (m). */
double gmi_law_sum_of_torque(const gmi_law *law, double torque, double base_radius);

#endif
