/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Writes flank and pitch files with a head that says where they come from. */
#ifndef GEARFLANKS_WRITE_H
#define GEARFLANKS_WRITE_H

#include "messages.h"

#include <gearmesh/gearmesh_io.h>
#include <stdio.h>

/* What becomes a file: either deviations or pitch, and its head of comment lines. */
typedef struct written {
    const char *path;
    const gm_deviations *deviations; /* NULL = pitch is written */
    const gm_pitch *pitch;
    void (*print_head)(FILE *file, const void *context);
    const void *context;
} written;

enum { WRITTEN_MAX = 2 };

/* Writes FILE.part of each and renames them when all are whole. Returns an exit code. */
int write_files(const written files[], int count, message_sink *messages);

/* Prints file, line and reason of an error in the input; returns EXIT_BAD_INPUT, or EXIT_RUN_FAILED if it is memory. */
int refuse_input(message_sink *messages, int status, const gm_io_error *error);

#endif
