/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Means of force, load and overlap about a sample, from the momentum of the bodies: gearsim-solver.md derives them. They
 * take no evaluation of the mesh where flanks carry.
 */
#ifndef GEARSIM_SAMPLE_MEANS_H
#define GEARSIM_SAMPLE_MEANS_H

#include "sample.h"

/* What is the same for all samples. Before the first of them, when it is known which means are shown. */
void sample_means_prepare(sampling *s);

/*
 * Integrals of what follows the motion, up to a time, as the solver only goes forward. Call before the motion at that time is
 * asked for. Returns 0, or an exit code with the reason in `why`.
 */
int sample_means_gather(sampling *s, double to);

/* Sets the means of sample i of a row's period; seen: what is known of the sample itself. Returns as above. */
int sample_means_see(sampling *s, enum column_need seen, double row, int i);

/* The same of a box whose end is known. */
int sample_means_set_box(sampling *s, enum column_need seen, double end, const model_edge *edge,
                         const integrator_point *last);

#endif
