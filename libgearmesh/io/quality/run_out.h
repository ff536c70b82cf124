/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file run_out.h
 * The ball in a tooth space that measures run-out.
 */
#ifndef GEARMESH_RUN_OUT_H
#define GEARMESH_RUN_OUT_H

#include "gearmesh/gearmesh_io.h"

/**
 * What a radial shift of a ball in a tooth space is to each of its flanks, along the base tangent: sin(alpha_t +
 * eta), - in a ring, eta = half the angle of the space, both at the reference circle. The normals of the two flanks stand at
 * that angle to the tangent of the ball's circle.
 */
double gmi_ball_sine(const gm_pair *pair, const gm_gear *gear);

#endif /* GEARMESH_RUN_OUT_H */
