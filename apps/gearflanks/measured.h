/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Makes flank and pitch files from what was measured, says what it made of it and what that
 * measures to. */
#ifndef GEARFLANKS_MEASURED_H
#define GEARFLANKS_MEASURED_H

#include "options.h"

/* Returns an exit code. */
int build_measured(const flanks_options *options, const gm_pair *pair);

#endif
