/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "each.h"
#include "memory.h"

#include <stdlib.h>
#include <string.h>

enum { LINE_SIZE = 4096 }; /* of most lines */

/* At once, as the rows of the result take another way to the same place. */
static void put_as_comment(void *user, const char *line) {
    (void)user;
    fprintf(stdout, "# message: %s", line);
    (void)fflush(stdout);
}

/* A sink of a run: what the others say stays as it is. */
static message_sink comments_of(const message_sink *messages) {
    message_sink made = *messages;

    made.put = put_as_comment;
    made.show = NULL;
    return made;
}

static int count_settings(const char *line) {
    int count = 1;
    for (; *line != '\0'; ++line) {
        count += *line == '\t';
    }
    return count;
}

/* Cuts a line at its tabs; nothing between two of them is no setting. */
static int split_settings(char *line, const char *settings[]) {
    int count = 0;
    while (line != NULL) {
        char *tab = strchr(line, '\t');
        if (tab != NULL) {
            *tab = '\0';
        }
        if (*line != '\0') {
            settings[count++] = line;
        }
        line = tab != NULL ? tab + 1 : NULL;
    }
    return count;
}

/* One run, with the settings of the command line and then its own. */
static int run_line(const arguments *args, char *line, int (*perform)(const arguments *args)) {
    const int given = args->request.override_count;
    message_sink messages = comments_of(args->request.messages);
    arguments run = *args;

    run.overrides = allocate((size_t)(given + count_settings(line)), sizeof *run.overrides);
    if (run.overrides == NULL) {
        return message_no_memory(&messages);
    }
    for (int i = 0; i < given; ++i) {
        run.overrides[i] = args->overrides[i];
    }
    run.request.overrides = run.overrides;
    run.request.override_count = given + split_settings(line, run.overrides + given);
    run.request.messages = &messages;
    run.request.output_file = "-";

    const int status = perform(&run);
    free(run.overrides);
    return status;
}

/* Reads a line of any length without its end into `line`, which grows. 0 at the end of all lines, or without memory. */
static int read_line(char **line, size_t *size) {
    int c = getchar();
    if (c == EOF) {
        return 0;
    }

    for (size_t length = 0;; c = getchar()) {
        if (length == *size) {
            const size_t more = 2 * *size + LINE_SIZE;
            char *longer = realloc(*line, more);
            if (longer == NULL) {
                return 0;
            }
            *line = longer;
            *size = more;
        }
        if (c == EOF || c == '\n') {
            (*line)[length] = '\0';
            return 1;
        }
        (*line)[length++] = (char)c;
    }
}

int each_run(const arguments *args, int (*perform)(const arguments *args)) {
    char *line = NULL;
    size_t size = 0;
    int exit_code = EXIT_DONE;

    while (read_line(&line, &size)) {
        line[strcspn(line, "\r")] = '\0';
        const int status = run_line(args, line, perform);
        exit_code = status != EXIT_DONE ? status : exit_code;

        /* Whoever reads this may go away, or interrupt all of it. */
        printf("# exit %d\n", status);
        if (fflush(stdout) != 0 || status == EXIT_INTERRUPTED) {
            break;
        }
    }
    free(line);
    return exit_code;
}
