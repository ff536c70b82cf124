/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "arguments.h"
#include "keys.h"
#include "memory.h"

#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: gearsim PARAMS.ini [--set section.key=value]... [--output FILE] [--quiet]\n"
    "       gearsim PARAMS.ini --check | --geometry\n"
    "       gearsim --help | --version";

static const char options_help[] =
    "\n"
    "Simulates the contact of two gears as PARAMS.ini describes them and writes a CSV file.\n"
    "\n"
    "Options, before or behind PARAMS.ini, with `--option value` or `--option=value`:\n"
    "  --set section.key=value  replaces a key of the file, or adds one; the last --set of a key "
    "wins;\n"
    "                           with nothing behind the `=` the key is not given, and its default "
    "counts\n"
    "  --output FILE            the result, in place of output.file\n"
    "  --quiet                  no progress, notes and warnings on stderr; errors stay\n"
    "  --check                  reads and checks everything, runs and writes nothing\n"
    "  --geometry               derived quantities as `name = value` lines on stdout, no run\n"
    "  --help                   this text\n"
    "  --version                the version\n"
    "  --                       all that follows is no option\n"
    "\n"
    "Exit codes: 0 done; 1 the run failed (solver, disk); 2 usage or input; 130 interrupted.\n"
    "\n"
    "The result grows in FILE.part, which becomes FILE when it is whole and on the disk. No "
    "second\n"
    "run can write it meanwhile. A link in place of FILE stays, and the file that it leads to is\n"
    "replaced. A run that is interrupted, by Ctrl-C or the signals TERM, HUP, XCPU, ALRM, USR1 "
    "and\n"
    "USR2, leaves FILE.part with the rows so far; the same signal again kills it.\n"
    "\n"
    "Paths in PARAMS.ini are relative to its folder, those on the command line (--output, --set)\n"
    "and the default result to the working folder.\n"
    "\n"
    "PARAMS.ini is UTF-8 text: `[section]` lines, `key = value` lines and comments behind `;` or "
    "`#`.\n"
    "`key =` with nothing behind it is the same as no such line.\n"
    "All keys, with [default], meaning, range and need; keys that the chosen kind, type or model "
    "does\n"
    "not use are accepted with a warning; --geometry needs [gears] alone and opens no flank file:\n"
    "\n";

enum option_value { NO_VALUE, TAKES_VALUE };

typedef struct option {
    const char *name;
    enum option_value value;
    enum task task; /* TASK_RUN = leaves the task as it is */
} option;

static const option options[] = {
    {"--set", TAKES_VALUE, TASK_RUN},        {"--output", TAKES_VALUE, TASK_RUN},
    {"--quiet", NO_VALUE, TASK_RUN},         {"--check", NO_VALUE, TASK_CHECK},
    {"--geometry", NO_VALUE, TASK_GEOMETRY}, {"--help", NO_VALUE, TASK_HELP},
    {"--version", NO_VALUE, TASK_VERSION},
};

enum { OPTION_COUNT = sizeof options / sizeof options[0] };

static int refuse(const arguments *args, const char *text, const char *what) {
    message_of_program(args->request.messages, "%s%s\n%s", text, what, usage);
    return EXIT_BAD_INPUT;
}

/* The option of this name, up to a `=`; NULL = none. */
static const option *find_option(const char *text) {
    const size_t length = strcspn(text, "=");

    for (int i = 0; i < OPTION_COUNT; ++i) {
        if (strlen(options[i].name) == length && strncmp(options[i].name, text, length) == 0) {
            return &options[i];
        }
    }
    return NULL;
}

static void take_value(arguments *args, const option *given, char *value) {
    if (strcmp(given->name, "--output") == 0) {
        args->request.output_file = value;
    } else {
        args->overrides[args->request.override_count++] = value;
    }
}

static int take_flag(arguments *args, const option *given) {
    if (given->task == TASK_RUN) {
        args->request.messages->quiet = 1;
        return 0;
    }
    if (args->task != TASK_RUN && args->task != given->task) {
        return refuse(args, "--check and --geometry exclude each other", "");
    }
    args->task = given->task;
    return 0;
}

static int take_file(arguments *args, const char *path) {
    if (args->request.path != NULL) {
        return refuse(args, "a second INI file, expected one: ", path);
    }
    if (*path == '\0') {
        return refuse(args, "the name of the INI file is empty", "");
    }
    args->request.path = path;
    return 0;
}

/* Takes the option at texts[*index], and its value from there or from the next text. */
static int take_option(arguments *args, int count, char *const texts[], int *index) {
    const option *given = find_option(texts[*index]);
    char *value = strchr(texts[*index], '=');

    if (given == NULL) {
        return refuse(args, "unknown option ", texts[*index]);
    }
    if (given->value == NO_VALUE) {
        return value == NULL ? take_flag(args, given)
                             : refuse(args, "no value expected: ", texts[*index]);
    }
    if (value == NULL && *index + 1 >= count) {
        return refuse(args, "a value is missing behind ", given->name);
    }
    take_value(args, given, value != NULL ? value + 1 : texts[++*index]);
    return 0;
}

static int is_informative(enum task task) {
    return task == TASK_HELP || task == TASK_VERSION;
}

static int take_all(arguments *args, int count, char *const texts[]) {
    int only_files = 0;
    int status = 0;

    for (int i = 1; i < count && status == 0; ++i) {
        if (!only_files && strcmp(texts[i], "--") == 0) {
            only_files = 1;
        } else if (!only_files && texts[i][0] == '-' && texts[i][1] != '\0') {
            status = take_option(args, count, texts, &i);
        } else {
            status = take_file(args, texts[i]);
        }
        if (is_informative(args->task)) {
            return 0; /* whatever follows */
        }
    }
    if (status == 0 && args->request.path == NULL) {
        status = refuse(args, "no INI file given", "");
    }
    return status;
}

int arguments_parse(arguments *args, int count, char *const texts[], message_sink *messages) {
    memset(args, 0, sizeof *args);
    args->request.messages = messages;
    args->overrides = allocate((size_t)count + 1, sizeof *args->overrides);
    if (args->overrides == NULL) {
        return message_no_memory(messages);
    }

    const int status = take_all(args, count, texts);
    args->request.overrides = args->overrides;
    args->request.purpose = args->task == TASK_GEOMETRY ? CONFIG_FOR_GEOMETRY : CONFIG_FOR_RUN;
    if (status != 0) {
        arguments_free(args);
    }
    return status;
}

void arguments_free(arguments *args) {
    free(args->overrides);
    args->overrides = NULL;
}

void arguments_print_help(FILE *stream) {
    fprintf(stream, "%s\n", usage);
    fputs(options_help, stream);
    key_table_print(&gearsim_keys, stream);
}
