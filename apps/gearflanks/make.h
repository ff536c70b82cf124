/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Makes flanks, writes them, and prints what they measure to. */
#ifndef GEARFLANKS_MAKE_H
#define GEARFLANKS_MAKE_H

#include "options.h"

/* Returns an exit code. */
int make_flanks(const flanks_options *options, const gm_pair *pair);

#endif
