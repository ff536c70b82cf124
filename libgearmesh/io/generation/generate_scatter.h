/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file generate_scatter.h
 * Flanks whose amounts scatter.
 */
#ifndef GEARMESH_GENERATE_SCATTER_H
#define GEARMESH_GENERATE_SCATTER_H

#include "generator.h"

/** Checks the options that these flanks alone have. */
int gmi_scatter_check(const gmi_generator *make);

/** Fills deviations and pitch. */
void gmi_scatter_fill(gmi_generator *make);

#endif /* GEARMESH_GENERATE_SCATTER_H */
