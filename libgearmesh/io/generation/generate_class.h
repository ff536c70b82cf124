/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file generate_class.h
 * Flanks that measure to a class.
 */
#ifndef GEARMESH_GENERATE_CLASS_H
#define GEARMESH_GENERATE_CLASS_H

#include "generator.h"

/** Checks the options that these flanks alone have. */
int gmi_class_check(const gmi_generator *make);

/** Fills deviations and pitch. */
int gmi_class_fill(gmi_generator *make);

#endif /* GEARMESH_GENERATE_CLASS_H */
