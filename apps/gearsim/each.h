/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Many runs of one parameter file in one process: a line of standard input for each, results on standard output. */
#ifndef GEARSIM_EACH_H
#define GEARSIM_EACH_H

#include "arguments.h"

/*
 * Performs a run for each line, which has what stands behind --set, separated by tabs, and wins over the command line. Its
 * messages go to standard output as `# message: TEXT`, and behind all of it comes a line `# exit STATUS`. With
 * args->request.binary_rows the rows are not text (output_csv.c). Returns the exit code of the last run that was not whole,
 * else 0.
 */
int each_run(const arguments *args, int (*perform)(const arguments *args));

#endif
