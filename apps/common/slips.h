/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Values that are possible but hardly meant: lengths in metres, angles in radians, a diametral pitch in place of the
 * module, N/um in place of N/m. Each is judged against what gears are like, and is told only where another unit gives a
 * usual value: nothing is said of a gear that is odd in other ways.
 */
#ifndef APPS_SLIPS_H
#define APPS_SLIPS_H

#include "config.h"

/* Warns of the likely slips in what was given, with the number to write. Only for a complete configuration. */
void slips_warn(const config *conf);

#endif
