/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* equilibrium_guess.c: equilibria under several loads at once. */
#ifndef GEARMESH_EQUILIBRIUM_H
#define GEARMESH_EQUILIBRIUM_H

#include "internal.h"

/* Loads of one call. */
enum { GMI_LOADS_MAX = 32 };

/*
 * x of the equilibria at a posed position without friction (m), next to exact, and the slope of the sum there; NaN = none.
 */
void gmi_equilibrium_guesses(const gm_mesh *mesh, const gm_position *position,
                             const double *wheel_torque, int count, double *offset, double *slope);

#endif
