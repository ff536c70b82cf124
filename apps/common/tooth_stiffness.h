/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Files of single teeth that are softer than the others: columns tooth, factor. */
#ifndef APPS_TOOTH_STIFFNESS_H
#define APPS_TOOTH_STIFFNESS_H

#include "config.h"

/* The factors of all teeth of a gear, 1 for those that the file does not name; NULL without a file. To be freed. Returns 0
 * or an exit code after a message. */
int tooth_stiffness_load(double **factors, const config *conf, enum gm_role gear, int teeth);

#endif
