/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Evaluates flanks and prints what they measure to. */
#ifndef GEARFLANKS_REPORT_H
#define GEARFLANKS_REPORT_H

#include "options.h"

/* Of flanks in memory, NULL = none. Returns an exit code. */
int report_quality(const flanks_options *options, const gm_pair *pair,
                   const gm_deviations *deviations, const gm_pitch *pitch);

/* Of files; `files`: what PARAMS.ini names. Returns an exit code. */
int report_flanks(const flanks_options *options, const gm_pair *pair, const flank_files *files);

#endif
