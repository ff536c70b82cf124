/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The INI file that says how flanks scatter from tooth to tooth. */
#ifndef GEARFLANKS_SCATTER_H
#define GEARFLANKS_SCATTER_H

#include "key_table.h"
#include "messages.h"

#include <gearmesh/gearmesh_io.h>

typedef struct scatter_file {
    gm_flank_scatter amounts;
    key_entry *entries; /* of scatter_keys: what was given */
} scatter_file;

/* Fills a gm_flank_scatter. */
extern const key_table scatter_keys;

/* Returns 0, or an exit code after messages, with nothing allocated. */
int scatter_read(scatter_file *file, const char *path, message_sink *messages);

/* What was given, a comment line each. */
void scatter_print(const scatter_file *file, FILE *stream);

void scatter_free(scatter_file *file);

#endif
