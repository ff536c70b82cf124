/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Evaluates flank and pitch files and prints what they measure to. */
#ifndef GEARFLANKS_REPORT_H
#define GEARFLANKS_REPORT_H

#include "options.h"

/* `files`: what PARAMS.ini names. Returns an exit code; messages go to stderr. */
int report_flanks(const flanks_options *options, const gm_pair *pair, const flank_files *files);

#endif
