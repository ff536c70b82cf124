/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The command line of gearsim. */
#ifndef GEARSIM_ARGUMENTS_H
#define GEARSIM_ARGUMENTS_H

#include "config.h"

enum task {
    TASK_RUN,
    TASK_EACH,
    TASK_CHECK,
    TASK_GEOMETRY,
    TASK_TEMPLATE,
    TASK_HELP,
    TASK_VERSION
};

typedef struct arguments {
    enum task task;
    int as_json;               /* what --check and --geometry print */
    const char *template_kind; /* NULL = all keys */
    config_request request;
    const char **overrides; /* what request.overrides points to */
} arguments;

/* Returns 0, or an exit code with nothing allocated after a message. --quiet makes the messages quiet. */
int arguments_parse(arguments *arguments, int count, char *const texts[], message_sink *messages);
void arguments_free(arguments *arguments);

/* What --help prints. */
void arguments_print_help(FILE *stream);

#endif
