/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "arguments.h"
#include "command_line.h"
#include "keys.h"
#include "memory.h"

#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: gearsim PARAMS.ini [--set section.key=value]... [--output FILE] [--quiet]\n"
    "       gearsim PARAMS.ini --each [--binary] [--set section.key=value]... [--quiet] <SETTINGS\n"
    "       gearsim PARAMS.ini --check | --geometry [--json]\n"
    "       gearsim --template [KIND]\n"
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
    "  --each                   a run for each line of standard input, which has what stands "
    "behind "
    "--set, separated\n"
    "                           by tabs; all results go to standard output as CSV, with "
    "`# message: TEXT` lines\n"
    "                           and a last line `# exit CODE` each; the exit code is that of the "
    "last run that failed\n"
    "  --binary                 with --each: rows come in blocks behind a line `# rows COUNT` "
    "each, "
    "their numbers row by\n"
    "                           row as 64 bit floats in this machine's order of bytes, which takes "
    "neither printing\n"
    "                           nor reading of text\n"
    "  --check                  reads and checks everything, says what a run would do, runs and "
    "writes nothing\n"
    "  --geometry               derived quantities as `name = value` lines on stdout, no run\n"
    "  --json                   prints what --check or --geometry says as a JSON object\n"
    "  --template [KIND]        prints a parameter file with comments that runs as it stands: all "
    "keys, or those\n"
    "                           of a KIND: dynamic, static, speed, torque, simple, 3d, constant, "
    "iso6336, elastic\n"
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
    "`-` in place of PARAMS.ini reads standard input; its result goes to standard output if "
    "nothing else is "
    "said.\n"
    "`--output -` writes the result to standard output, as CSV, with `# incomplete: why` as the "
    "last line of a\n"
    "run that ends early.\n"
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

/* ---------------------------------------------------------------------------------------------
 * Options
 * ------------------------------------------------------------------------------------------- */

/* What is known so far, and the command line that it is read from. */
typedef struct parsing {
    arguments *args;
    command_line line;
} parsing;

static enum option_result take_override(parsing *state, const char *value) {
    arguments *args = state->args;

    args->overrides[args->request.override_count++] = value;
    return OPTION_TAKEN;
}

static enum option_result take_output(parsing *state, const char *value) {
    state->args->request.output_file = value;
    return OPTION_TAKEN;
}

static enum option_result take_quiet(parsing *state, const char *value) {
    (void)value;
    state->line.messages->quiet = 1;
    return OPTION_TAKEN;
}

static enum option_result take_task(parsing *state, enum task task) {
    if (state->args->task != TASK_RUN && state->args->task != task) {
        (void)command_line_refuse(
            &state->line, "--each, --check, --geometry and --template exclude each other", "");
        return OPTION_FAULT;
    }
    state->args->task = task;
    return OPTION_TAKEN;
}

static enum option_result take_each(parsing *state, const char *value) {
    (void)value;
    return take_task(state, TASK_EACH);
}

static enum option_result take_binary(parsing *state, const char *value) {
    (void)value;
    state->args->request.binary_rows = 1;
    return OPTION_TAKEN;
}

static enum option_result take_check(parsing *state, const char *value) {
    (void)value;
    return take_task(state, TASK_CHECK);
}

static enum option_result take_geometry(parsing *state, const char *value) {
    (void)value;
    return take_task(state, TASK_GEOMETRY);
}

static enum option_result take_template(parsing *state, const char *value) {
    state->args->template_kind = value;
    return take_task(state, TASK_TEMPLATE);
}

static enum option_result take_json(parsing *state, const char *value) {
    (void)value;
    state->args->as_json = 1;
    return OPTION_TAKEN;
}

static enum option_result take_help(parsing *state, const char *value) {
    (void)value;
    state->args->task = TASK_HELP;
    return OPTION_LAST;
}

static enum option_result take_version(parsing *state, const char *value) {
    (void)value;
    state->args->task = TASK_VERSION;
    return OPTION_LAST;
}

static const struct {
    option_spec spec;
    enum option_result (*take)(parsing *state, const char *value);
} options[] = {
    {{"--set", "section.key=value"}, take_override},
    {{"--output", "a file name"}, take_output},
    {{"--quiet", NULL}, take_quiet},
    {{"--each", NULL}, take_each},
    {{"--binary", NULL}, take_binary},
    {{"--check", NULL}, take_check},
    {{"--geometry", NULL}, take_geometry},
    {{"--json", NULL}, take_json},
    {{"--template", "[a kind of analysis]"}, take_template},
    {{"--help", NULL}, take_help},
    {{"--version", NULL}, take_version},
};

enum { OPTION_COUNT = sizeof options / sizeof options[0] };

static const option_spec *option_at(int which) {
    return &options[which].spec;
}

static enum option_result take_option(void *user, int which, const char *value) {
    return options[which].take(user, value);
}

/* ---------------------------------------------------------------------------------------------
 * The whole
 * ------------------------------------------------------------------------------------------- */

/* What goes together, when all of the line is known. */
static int check_together(parsing *state) {
    arguments *args = state->args;

    switch (args->task) {
    case TASK_HELP:
    case TASK_VERSION:
        return 0;

    /* The word behind --template was read as the name of a file. */
    case TASK_TEMPLATE:
        if (state->line.file != NULL && args->template_kind != NULL) {
            return command_line_refuse(&state->line,
                                       "--template reads no file: ", state->line.file);
        }
        if (args->request.override_count > 0 || args->request.output_file != NULL ||
            args->request.binary_rows || args->as_json) {
            return command_line_refuse(&state->line, "--template takes no other options", "");
        }
        if (args->template_kind == NULL) {
            args->template_kind = state->line.file;
        }
        return 0;

    default:
        if (state->line.file == NULL) {
            return command_line_refuse(&state->line, "no INI file given", "");
        }
        if (args->as_json && args->task != TASK_CHECK && args->task != TASK_GEOMETRY) {
            return command_line_refuse(&state->line, "--json goes with --check or --geometry", "");
        }
        if (args->request.binary_rows && args->task != TASK_EACH) {
            return command_line_refuse(&state->line, "--binary goes with --each", "");
        }
        if (args->task == TASK_EACH && args->request.output_file != NULL) {
            return command_line_refuse(&state->line, "--each writes to standard output, not to ",
                                       args->request.output_file);
        }
        return args->task == TASK_EACH && strcmp(state->line.file, "-") == 0
                   ? command_line_refuse(&state->line,
                                         "--each reads its settings from standard input, not ",
                                         "the INI file")
                   : 0;
    }
}

int arguments_parse(arguments *args, int count, char *const texts[], message_sink *messages) {
    memset(args, 0, sizeof *args);
    args->request.messages = messages;
    args->overrides = allocate((size_t)count + 1, sizeof *args->overrides);
    if (args->overrides == NULL) {
        return message_no_memory(messages);
    }

    parsing state = {.args = args,
                     .line = {.count = OPTION_COUNT,
                              .option = option_at,
                              .take = take_option,
                              .user = &state,
                              .usage = usage,
                              .messages = messages}};
    int status = command_line_read(&state.line, count, texts);
    if (status == 0) {
        status = check_together(&state);
    }

    args->request.path = state.line.file;
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
