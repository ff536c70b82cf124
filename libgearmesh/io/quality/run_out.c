/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The ball in a tooth space. */

#include "run_out.h"
#include "shared.h"

#include <math.h>

double gmi_ball_sine(const gm_pair *pair, const gm_gear *gear) {
    const double thickness = gear->normal_thickness / cos(pair->helix_angle);
    const double space = 0.5 * (gear->pitch_angle - thickness / gear->reference_radius);
    return sin(pair->transverse_pressure_angle + gear->sign * space);
}
