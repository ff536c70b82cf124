/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Reads a command line: options in any order, with `--option value` or `--option=value`, and one parameter file. All
 * behind `--` is no option. A program says what its options are, and what becomes of them.
 */
#ifndef APPS_COMMAND_LINE_H
#define APPS_COMMAND_LINE_H

#include "messages.h"

typedef struct option_spec {
    const char *name; /* such as "--output" */

    /* what its value must be, in words; NULL = it takes none; in brackets: it may lack, and stands behind a `=` */
    const char *right;
} option_spec;

enum option_result {
    OPTION_TAKEN,
    OPTION_WRONG, /* the value is not what it must be: the reader says so */
    OPTION_FAULT, /* wrong in another way, and told */
    OPTION_LAST   /* taken, and whatever follows does not count: --help */
};

typedef struct command_line {
    int count;                               /* options that there are */
    const option_spec *(*option)(int which); /* the one at a place, 0 .. count - 1 */
    enum option_result (*take)(void *user, int which,
                               const char *value); /* value NULL: none is there */
    void *user;
    const char *usage; /* told with every fault, without a line end */
    message_sink *messages;
    const char *file; /* out: the parameter file, NULL = none was given */
} command_line;

/* Returns 0, or EXIT_BAD_INPUT after a message. */
int command_line_read(command_line *line, int count, char *const texts[]);

/* "program: textwhat" and the usage; returns EXIT_BAD_INPUT. */
int command_line_refuse(const command_line *line, const char *text, const char *what);

#endif
