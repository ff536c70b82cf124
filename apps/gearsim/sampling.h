/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The samples of a run, one after the other, into the filter that makes rows of them: which columns they are for, what these
 * need, and how much of it can be had for all samples of a row at once.
 */
#ifndef GEARSIM_SAMPLING_H
#define GEARSIM_SAMPLING_H

#include "sample.h"

/*
 * Begins: model and solver stand at t = 0 and stay where they are; columns [count] are places in dynamic_columns.
 * row_need: what the caller looks at in every row. Returns 0, or -1 if there is no memory.
 */
int sampling_start(sampling *s, const config *conf, const gear_model *model, integrator *solver,
                   const int columns[], int count, enum column_need row_need);
void sampling_free(sampling *s);

/* The sample at t = 0, then those behind the time of a row up to that of the next one. Both return 0, or EXIT_RUN_FAILED or
 * EXIT_INTERRUPTED with the reason in `why`. */
int sampling_take_first(sampling *s);
int sampling_go_to_next_row(sampling *s, double row);

/* Notes for the head of the result what the values of a row are. Returns 0, or an exit code after a message. */
int sampling_note(const gear_mesh *gears, config *conf);

#endif
