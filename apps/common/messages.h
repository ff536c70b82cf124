/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Where messages to the user go. main() sets up one struct, and all below it speak through that: no other function
 * knows stderr. A struct is used by one thread.
 *
 * A message about an input reads `file:line: section.key: must be WHAT IS RIGHT (got VALUE)`; one about the run
 * `program: text`.
 */
#ifndef APPS_MESSAGES_H
#define APPS_MESSAGES_H

#include <stdarg.h>
#include <stdio.h>

typedef struct message_sink {
    const char *program; /* who speaks, such as "gearsim" */
    int quiet;           /* errors only: no warnings, notes and progress */

    /* Takes a line with its end. NULL: nobody listens. */
    void (*put)(void *user, const char *line);

    /* Shows a line without an end in place of the one before; "" clears it. NULL: there is no terminal. */
    void (*show)(void *user, const char *line);

    void *user; /* for both */

    int told; /* messages since message_begin() */
    int most; /* of them are put, the others counted; 0 = all are put */
} message_sink;

/* Messages to a stream; also what is to be shown, if the stream is a terminal. */
message_sink messages_to(FILE *stream, const char *program);

/* In all functions `to` may be NULL: nobody listens. Lines beyond some thousand characters are cut. */

/* A line as it is. */
void message_error(message_sink *to, const char *format, ...);

/* The same with `prefix` before it, and the values as a list. */
void message_error_list(message_sink *to, const char *prefix, const char *format, va_list values);

/* A line that is left out with --quiet: a warning or a note. */
void message_note(message_sink *to, const char *format, ...);
void message_note_list(message_sink *to, const char *prefix, const char *format, va_list values);

/* "program: text" */
void message_of_program(message_sink *to, const char *format, ...);

/* A line in place of the one before on a terminal, "" clears it; left out with --quiet, and without a terminal. */
void message_show(message_sink *to, const char *line);

/* "program: out of memory"; returns EXIT_RUN_FAILED. */
int message_no_memory(message_sink *to);

/*
 * Writes out what stands before standard output, as a full disk behind it shows only then; to be called at the end of a
 * program. Returns its exit code, EXIT_RUN_FAILED in place of EXIT_DONE where that fails.
 */
int message_of_stdout(message_sink *to, int status);

/*
 * Bounds what is told of one input: from here on the first `most` messages are put, and message_end() says how many
 * more there were, as "path: and N more". Not nested.
 */
enum { MOST_MESSAGES = 20 }; /* of a file: one of another kind would give thousands */
void message_begin(message_sink *to, int most);
void message_end(message_sink *to, const char *path);

/* Whether the next message will only be counted: it need not be thought about. */
int message_is_full(const message_sink *to);

#endif
