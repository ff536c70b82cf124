/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The static analysis: loaded transmission error over the pinion angle. */
#ifndef GEARSIM_STATICS_H
#define GEARSIM_STATICS_H

#include "gear_mesh.h"

/* Checks that its second file can be written, and its derivatives be made. 0, or EXIT_BAD_INPUT after a message. */
int statics_check(const config *conf, const gear_mesh *gears);

/* Returns an exit code, after a message if it is not EXIT_DONE. */
int statics_run(const config *conf, const gear_mesh *gears);

/* How many rows it writes when it is not cut short. */
double statics_rows(const config *conf);

#endif
