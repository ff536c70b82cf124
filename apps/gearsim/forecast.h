/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* What --check says of a parameter file that is right: which run comes, with how many rows of which columns, and where. */
#ifndef GEARSIM_FORECAST_H
#define GEARSIM_FORECAST_H

#include "columns.h"

#include <stdio.h>

/* Of a configuration that output_check() has accepted with these names. */
void forecast_print(const config *conf, const column_names *names, int as_json, FILE *stream);

#endif
