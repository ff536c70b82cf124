/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* What a configuration lacks, and what of it does not fit together. Returned is the number of faults, each told. */
#ifndef APPS_CONFIG_CHECK_H
#define APPS_CONFIG_CHECK_H

#include "config.h"

/* Keys that the purpose requires. */
int config_check_missing(const config *conf);

/* Values that are right each by itself; only when nothing is missing. */
int config_check_together(const config *conf);

/* Notes of keys that are not given and whose default is seldom what is wanted. */
void config_remark_on_defaults(const config *conf);

/* Warns of keys that change nothing. */
void config_warn_of_unused(const config *conf);

#endif
