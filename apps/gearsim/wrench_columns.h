/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Force and moment on each gear as columns of both analyses: what bearings feel. In the frame of the library; moments
 * about the gear's own axis in the middle of its own face, where a static pose has moved that, and before it tilts it.
 */
#ifndef GEARSIM_WRENCH_COLUMNS_H
#define GEARSIM_WRENCH_COLUMNS_H

#include "config.h"
#include "gear_mesh.h"

/* All of them by `column(name, component)`. */
#define WRENCH_COLUMNS(column)                                                                     \
    column(pinion_force_x_N, 0) column(pinion_force_y_N, 1) column(pinion_force_z_N, 2)            \
        column(pinion_moment_x_Nm, 3) column(pinion_moment_y_Nm, 4) column(pinion_moment_z_Nm, 5)  \
            column(wheel_force_x_N, 6) column(wheel_force_y_N, 7) column(wheel_force_z_N, 8)       \
                column(wheel_moment_x_Nm, 9) column(wheel_moment_y_Nm, 10)                         \
                    column(wheel_moment_z_Nm, 11)

/* One of them. */
double wrench_component(const gear_mesh *gears, const gm_wrench *wrench, int component);

/* Whether a column is one of them: then it is there if asked for, by `output.wrench` or by its name. */
int is_wrench_column(const char *name);

#endif
