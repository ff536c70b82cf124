/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Which of the columns of an analysis a file contains, in which order: `output.columns`.
 */
#ifndef GEARSIM_COLUMNS_H
#define GEARSIM_COLUMNS_H

#include "config.h"

enum { COLUMNS_MAX = 32 };

/* All columns that an analysis has. */
typedef struct column_names {
    int count;
    const char *name[COLUMNS_MAX];
} column_names;

typedef struct column_list {
    int count;
    int name[COLUMNS_MAX]; /* place among the names of the analysis */
} column_list;

/* Returns 0, or EXIT_BAD_INPUT after a message: unknown, repeated or empty names. */
int columns_select(column_list *columns, const config *conf, const char *const names[],
                   int name_count);

#endif
