/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file double_helical.h
 * What the equilibrium of both halves of a double-helical pair and their sum share.
 */
#ifndef GEARMESH_DOUBLE_HELICAL_H
#define GEARMESH_DOUBLE_HELICAL_H

#include "gearmesh/gearmesh.h"

/** The pose of half k where the whole wheel has one, see gm_double_helical_pose(). */
gm_pose gmi_pose_of_half(const gm_pair *half, double gap, const gm_pose *whole, int k);

/** At fixed phi_p a change of x is one of -phi_w. */
static inline double gmi_by_offset(const gm_pair *pair, const gm_gradient *by) {
    return -by->wheel_angle / pair->wheel.base_radius;
}

/** How the force of the first half less that of the second changes with the shift (N/m). */
static inline double gmi_slope_of_halves(const gm_pair *pair, const gm_mesh_result each[2]) {
    return gmi_by_offset(pair, &each[0].force_by) + gmi_by_offset(pair, &each[1].force_by);
}

/**
 * Both halves together.
 *
 * @param[in]  gears   the meshes
 * @param[in]  whole   pose that the wheel is in; NULL: the wrench is not wanted
 * @param[in]  each    [2] of the halves
 * @param[in]  wanted  a sum of enum gm_wanted
 * @param[out] sum     of the pair
 */
void gmi_double_helical_add(const gm_double_helical *gears, const gm_pose *whole,
                            const gm_mesh_result each[2], int wanted, gm_mesh_result *sum);

#endif /* GEARMESH_DOUBLE_HELICAL_H */
