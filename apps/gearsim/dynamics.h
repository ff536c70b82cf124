/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The dynamic analysis: from quasi-static start to CSV, with progress and interruption. */
#ifndef GEARSIM_DYNAMICS_H
#define GEARSIM_DYNAMICS_H

#include "gear_mesh.h"

/* Returns an exit code, after a message if it is not EXIT_DONE. */
int dynamics_run(const config *conf, const gear_mesh *gears);

/* How many rows it writes when it is not cut short. */
double dynamics_rows(const config *conf);

#endif
