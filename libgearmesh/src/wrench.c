/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Forces and moments on both gears. The force of each side acts along the surface normal: along the line of action in
 * the transverse section, and tan(beta_b) of it along the axis. Where it acts follows from the first moments of
 * the penetration (stiffness) and of the touching parts (damping) over t1 and rho_p.
 */
#include "internal.h"

#include <math.h>
#include <string.h>

/* The resultant of one side: transverse force and its first moments. */
typedef struct side_force {
    double force;     /* >= 0, along the transverse line of action (N) */
    double force_t1;  /* force times mean t1 (N) */
    double force_rho; /* force times mean rho_p (N m) */
} side_force;

static side_force force_of(const gmi_side_sum *sum, double approach_speed, double stiffness,
                           double damping) {
    const double viscous = damping * approach_speed;
    side_force result = {0.0, 0.0, 0.0};
    const double force = stiffness * sum->sum + viscous * sum->contact;
    if (force < 0.0) { /* teeth do not pull */
        return result;
    }
    result.force = force;
    result.force_t1 = stiffness * sum->sum_t1 + viscous * sum->contact_t1;
    result.force_rho = stiffness * sum->sum_rho + viscous * sum->contact_rho;
    return result;
}

/*
 * Adds one side. mirror = +1 drive, -1 coast: the coast plane of action is the drive one mirrored at the plane
 * of both axes. On the wheel acts force * (sin(alpha), mirror cos(alpha), -mirror tan(beta_b)) at
 *     (r_bp cos(alpha) + rho sin(alpha), mirror (rho cos(alpha) - r_bp sin(alpha)), z_0 + b t1).
 */
static void add_side(const gm_pair *pair, const side_force *side, double mirror,
                     gm_wrench *wrench) {
    const double sin_alpha = sin(pair->working_pressure_angle);
    const double cos_alpha = cos(pair->working_pressure_angle);
    const double force = side->force;
    const double f_x = force * sin_alpha;
    const double f_y = force * mirror * cos_alpha;
    const double axial_share = -mirror * pair->face_advance / pair->face_width;
    const double f_z = force * axial_share;

    /* Moments of position times force, about the pinion axis at z = 0. */
    const double r_b = pair->pinion.base_radius;
    const double x_force = force * r_b * cos_alpha + side->force_rho * sin_alpha;
    const double y_force = mirror * (side->force_rho * cos_alpha - force * r_b * sin_alpha);
    const double z_force = pair->face_start * force + pair->face_width * side->force_t1;
    const double m_x = y_force * axial_share - z_force * mirror * cos_alpha;
    const double m_y = z_force * sin_alpha - x_force * axial_share;
    const double m_z = force * mirror * r_b;

    const double on_wheel_force[3] = {f_x, f_y, f_z};
    const double about_pinion[3] = {m_x, m_y, m_z};
    /* About the wheel axis: less d e_x cross force. */
    const double d = pair->center_distance;
    const double about_wheel[3] = {m_x, m_y + d * f_z, -force * mirror * pair->wheel.base_radius};
    for (int k = 0; k < 3; ++k) {
        wrench->wheel_force[k] += on_wheel_force[k];
        wrench->wheel_moment[k] += about_wheel[k];
        wrench->pinion_force[k] -= on_wheel_force[k];
        wrench->pinion_moment[k] -= about_pinion[k];
    }
}

static void wrench_nan(gm_wrench *wrench) {
    for (int k = 0; k < 3; ++k) {
        wrench->pinion_force[k] = wrench->pinion_moment[k] = gmi_nan();
        wrench->wheel_force[k] = wrench->wheel_moment[k] = gmi_nan();
    }
}

int gm_wrench_3d_at(const gm_pair *pair, const gm_flanks *pinion_flanks,
                    const gm_flanks *wheel_flanks, const gm_position *position, double stiffness,
                    double damping, gm_wrench *wrench) {
    if (wrench == NULL) {
        return GM_ERR_NULL;
    }
    wrench_nan(wrench);
    const int status = gmi_check_evaluation(pair, pinion_flanks, wheel_flanks, position);
    if (status != GM_OK) {
        return status;
    }
    if (!(fabs(stiffness) <= GMI_LARGEST_STIFFNESS) || !(fabs(damping) <= GMI_LARGEST_STIFFNESS)) {
        return GM_ERR_PARAMETER;
    }

    gmi_side_sum drive, coast;
    gmi_side_sum_3d(pair, pinion_flanks, wheel_flanks, GM_DRIVE, position, GMI_MOMENTS, &drive);
    gmi_side_sum_3d(pair, pinion_flanks, wheel_flanks, GM_COAST, position, GMI_MOMENTS, &coast);
    const side_force drive_force = force_of(&drive, position->offset_rate, stiffness, damping);
    const side_force coast_force = force_of(&coast, -position->offset_rate, stiffness, damping);
    memset(wrench, 0, sizeof *wrench);
    add_side(pair, &drive_force, 1.0, wrench);
    add_side(pair, &coast_force, -1.0, wrench);
    return GM_OK;
}
