/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "command_line.h"
#include "exit_code.h"

#include <string.h>

int command_line_refuse(const command_line *line, const char *text, const char *what) {
    message_of_program(line->messages, "%s%s", text, what);

    /* A message is one line, the usage has several. */
    for (const char *at = line->usage; *at != '\0';) {
        const size_t length = strcspn(at, "\n");
        message_error(line->messages, "%.*s", (int)length, at);
        at += length + (at[length] == '\n');
    }
    return EXIT_BAD_INPUT;
}

/* Place of the option of this name, up to a `=`; -1 = there is none. */
static int find_option(const command_line *line, const char *text) {
    const size_t length = strcspn(text, "=");

    for (int which = 0; which < line->count; ++which) {
        const char *name = line->option(which)->name;
        if (strlen(name) == length && strncmp(name, text, length) == 0) {
            return which;
        }
    }
    return -1;
}

static int take_file(command_line *line, const char *path) {
    if (line->file != NULL) {
        return command_line_refuse(line, "a second INI file, expected one: ", path);
    }
    if (*path == '\0') {
        return command_line_refuse(line, "the name of the INI file is empty", "");
    }
    line->file = path;
    return 0;
}

/* Takes the option at texts[*index], and its value from there or from the next text. */
static int take_option(const command_line *line, int count, char *const texts[], int *index,
                       int *is_last) {
    const int which = find_option(line, texts[*index]);
    if (which < 0) {
        return command_line_refuse(line, "unknown option ", texts[*index]);
    }

    /* An option has a value, or it has none. */
    const option_spec *given = line->option(which);
    const char *value = strchr(texts[*index], '=');
    if (given->right == NULL && value != NULL) {
        return command_line_refuse(line, "no value expected: ", texts[*index]);
    }
    const int needs_next = given->right != NULL && value == NULL && *given->right != '[';
    if (needs_next && *index + 1 >= count) {
        return command_line_refuse(line, "a value is missing behind ", given->name);
    }
    if (value != NULL) {
        ++value;
    } else if (needs_next) {
        value = texts[++*index];
    }

    const enum option_result result = line->take(line->user, which, value);
    *is_last = result == OPTION_LAST;
    if (result == OPTION_WRONG) {
        message_of_program(line->messages, "%s: must be %s (got '%s')", given->name, given->right,
                           value);
    }
    return result == OPTION_WRONG || result == OPTION_FAULT ? EXIT_BAD_INPUT : 0;
}

int command_line_read(command_line *line, int count, char *const texts[]) {
    int only_files = 0;
    int is_last = 0;
    int status = 0;

    line->file = NULL;
    for (int i = 1; i < count && status == 0 && !is_last; ++i) {
        if (!only_files && strcmp(texts[i], "--") == 0) {
            only_files = 1;
        } else if (!only_files && texts[i][0] == '-' && texts[i][1] != '\0') {
            status = take_option(line, count, texts, &i, &is_last);
        } else {
            status = take_file(line, texts[i]);
        }
    }
    return status;
}
