/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* A line of contact over flanks with ramps: linear reliefs along face and profile. */
#ifndef GEARMESH_RAMP_H
#define GEARMESH_RAMP_H

#include "flank.h"
#include "internal.h"
#include "line.h"

/* gmi_line_integrate() with the ramps of both flanks, NULL = none, taken off. */
void gmi_ramps_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                         const gmi_tables *pinion_tables, const gmi_tables *wheel_tables,
                         int wanted, gmi_line_sum *result);
void gmi_ramps_integrate_tangent(const gmi_line *line, const gmi_grid *pinion,
                                 const gmi_grid *wheel, const gmi_tables *pinion_tables,
                                 const gmi_tables *wheel_tables, gmi_line_sum *result);

#endif
