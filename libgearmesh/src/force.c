/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Contact force along the transverse line of action [Paper, Eq. 3]. */
#include "internal.h"

/* Teeth do not pull: damping may take a flank's force away, never turn it round. */
static double flank_force(double stiffness, double damping, double sum, double rate) {
    const double force = stiffness * sum + damping * rate;
    return force < 0.0 ? 0.0 : force;
}

double gm_contact_force(double stiffness, double damping, const gm_penetration *penetration) {
    if (penetration == NULL) {
        return gmi_nan();
    }
    const double force =
        flank_force(stiffness, damping, penetration->drive, penetration->drive_rate) -
        flank_force(stiffness, damping, penetration->coast, penetration->coast_rate);
    return gmi_is_finite(force) ? force : gmi_nan();
}
