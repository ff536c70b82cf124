/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "messages.h"
#include "exit_code.h"
#include "platform.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

enum { LINE_SIZE = 8192 }; /* more than the longest path and text */

static void put_to_stream(void *user, const char *line) {
    FILE *stream = user;

    fputs(line, stream);
}

/* \033[K: the rest of a longer line before is wiped. */
static void show_on_stream(void *user, const char *line) {
    FILE *stream = user;

    fprintf(stream, "\r%s\033[K", line);
    fflush(stream);
}

message_sink messages_to(FILE *stream, const char *program) {
    message_sink made = {.program = program, .put = put_to_stream, .user = stream};

    if (is_terminal(stream)) {
        made.show = show_on_stream;
    }
    return made;
}

/* Ends a line that may have been cut, and passes it on. */
static void put_line(const message_sink *to, char line[LINE_SIZE]) {
    size_t length = strlen(line);

    if (length > LINE_SIZE - 2) {
        length = LINE_SIZE - 2;
    }

    /* A name may have any byte: none may end the line or tell the terminal what to do. */
    for (size_t i = 0; i < length; ++i) {
        if ((unsigned char)line[i] < ' ' || line[i] == 0x7f) {
            line[i] = '?';
        }
    }
    line[length] = '\n';
    line[length + 1] = '\0';
    to->put(to->user, line);
}

/* Counts a message; 0 = it is not to be put. */
static int is_to_be_put(message_sink *to) {
    if (to == NULL || to->put == NULL) {
        return 0;
    }
    ++to->told;
    return to->most == 0 || to->told <= to->most;
}

void message_error_list(message_sink *to, const char *prefix, const char *format, va_list values) {
    char line[LINE_SIZE];

    if (!is_to_be_put(to)) {
        return;
    }
    const int used = snprintf(line, sizeof line, "%s", prefix);
    if (used >= 0 && used < LINE_SIZE) {
        (void)vsnprintf(line + used, sizeof line - (size_t)used, format, values);
    }
    put_line(to, line);
}

void message_error(message_sink *to, const char *format, ...) {
    va_list values;

    va_start(values, format);
    message_error_list(to, "", format, values);
    va_end(values);
}

void message_note_list(message_sink *to, const char *prefix, const char *format, va_list values) {
    if (to != NULL && !to->quiet) {
        message_error_list(to, prefix, format, values);
    }
}

void message_note(message_sink *to, const char *format, ...) {
    va_list values;

    va_start(values, format);
    message_note_list(to, "", format, values);
    va_end(values);
}

void message_of_program(message_sink *to, const char *format, ...) {
    char prefix[64];
    va_list values;

    snprintf(prefix, sizeof prefix, "%s: ", to != NULL ? to->program : "");
    va_start(values, format);
    message_error_list(to, prefix, format, values);
    va_end(values);
}

void message_show(message_sink *to, const char *line) {
    if (to != NULL && to->show != NULL && !to->quiet) {
        to->show(to->user, line);
    }
}

int message_no_memory(message_sink *to) {
    message_of_program(to, "out of memory");
    return EXIT_RUN_FAILED;
}

int message_of_stdout(message_sink *to, int status) {
    if (fflush(stdout) == 0 && !ferror(stdout)) {
        return status;
    }
    message_of_program(to, "standard output: cannot be written: %s", strerror(errno));
    return status == EXIT_DONE ? EXIT_RUN_FAILED : status;
}

void message_begin(message_sink *to, int most) {
    if (to != NULL) {
        to->told = 0;
        to->most = most;
    }
}

void message_end(message_sink *to, const char *path) {
    if (to == NULL) {
        return;
    }

    const int more = to->most > 0 ? to->told - to->most : 0;
    to->most = 0;
    if (more > 0) {
        message_error(to, "%s: and %d more", path, more);
    }
}

int message_is_full(const message_sink *to) {
    return to == NULL || to->put == NULL || (to->most > 0 && to->told >= to->most);
}
