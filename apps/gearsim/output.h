/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The result file: `FILE.part` while it grows, renamed to FILE when it is whole. Its name says the format:
 * HDF5 if it ends in .h5 or .hdf5, else CSV. A run that ends early leaves FILE.part with the rows until
 * then and the reason. The name "-" is standard output, as CSV.
 */
#ifndef GEARSIM_OUTPUT_H
#define GEARSIM_OUTPUT_H

#include "config.h"
#include "result_file.h"

typedef struct output_file output_file;

/* Checks that the columns asked for exist among `names` and that the file can be written, without
 * touching an existing FILE. Used by --check as well. Returns 0, EXIT_BAD_INPUT after a message. */
int output_check(const config *conf, const char *const names[], int name_count);

/* Opens FILE.part and writes provenance and header. NULL after a message (exit code in *exit_code). */
output_file *output_open(const config *conf, const char *const names[], int name_count,
                         int *exit_code);

/* Whether this one of the names is among the columns asked for. */
int output_wants(const output_file *output, int name);

/* Writes one row: a value for each name, those not asked for are skipped. 0, or EXIT_RUN_FAILED (disk)
 * after a message. */
int output_row(output_file *output, const double values[]);

/* Ends the file and frees it: `incomplete` NULL = whole, rename; otherwise keep .part and say why. Notes file, rows and time.
 * Returns 0, or EXIT_RUN_FAILED after a message. */
int output_close(output_file *output, const char *incomplete);

/* As output_close() of a whole result, together with another one that is on its way to the disk: both get their names,
 * or none does. NULL = there is no other. */
int output_close_with(output_file *output, result_file *other);

#endif
