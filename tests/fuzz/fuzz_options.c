/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Any bytes as the command line of gearsim or gearflanks, one argument a line: refused with a message, or every option has
 * a value that is a number. No file is opened. Twice the same line, twice the same answer.
 */
#include "fuzz.h"
#include "fuzz_messages.h"

#include <arguments.h>
#include <math.h>
#include <options.h>

enum { MOST_ARGUMENTS = 40 };

typedef struct command_line {
    int count;
    char *texts[MOST_ARGUMENTS + 1]; /* NULL behind the last, as for main() */
    char *memory;
} command_line;

static command_line split(const uint8_t *data, size_t size) {
    static char program[] = "program";
    command_line line = {.count = 1, .texts = {program}, .memory = malloc(size + 1)};
    FUZZ_CLAIM(line.memory != NULL);
    memcpy(line.memory, data, size);
    line.memory[size] = '\0';

    /* What is left behind the last argument that has a place is one argument with line ends. */
    char *rest = line.memory;
    while (rest != NULL && line.count < MOST_ARGUMENTS) {
        line.texts[line.count++] = rest;
        rest = strchr(rest, '\n');
        if (rest != NULL) {
            *rest++ = '\0';
        }
    }
    return line;
}

static int try_gearsim(const command_line *line) {
    int messages;
    message_sink sink = fuzz_messages(&messages);
    arguments args;
    const int status = arguments_parse(&args, line->count, line->texts, &sink);
    FUZZ_CLAIM(status == 0 || (status == EXIT_BAD_INPUT && messages > 0));
    if (status != 0) {
        return status;
    }

    FUZZ_CLAIM(args.request.override_count < line->count);
    const int needs_file =
        args.task != TASK_HELP && args.task != TASK_VERSION && args.task != TASK_TEMPLATE;
    FUZZ_CLAIM(!needs_file || (args.request.path != NULL && *args.request.path != '\0'));
    arguments_free(&args);
    return 10 + (int)args.task;
}

static int try_gearflanks(const command_line *line) {
    int messages;
    message_sink sink = fuzz_messages(&messages);
    flanks_options options;
    const int status = options_parse(&options, line->count, line->texts, &sink);
    FUZZ_CLAIM(status == 0 || (status == EXIT_BAD_INPUT && messages > 0));
    if (status != 0 || options.task >= FLANKS_TASKS) {
        return status;
    }

    FUZZ_CLAIM(options.parameters != NULL);
    FUZZ_CLAIM(options.wheel == 0 || options.wheel == 1);
    /* Ranges are judged by the library, which the values must reach as numbers. */
    if (options.task == FLANKS_MAKE) {
        FUZZ_CLAIM(isfinite(options.generate.share));
        FUZZ_CLAIM(options.generate.wave_count >= 0 &&
                   options.generate.wave_count <= GM_FLANK_WAVES_MAX);
        for (int i = 0; i < options.generate.wave_count; ++i) {
            FUZZ_CLAIM(isfinite(options.waves[i].amplitude));
        }
        FUZZ_CLAIM(options.deviations != NULL && options.pitch != NULL);
    }
    if (options.task == FLANKS_MEASURED) {
        FUZZ_CLAIM(options.traces != NULL || options.measured_pitch != NULL);
        FUZZ_CLAIM(isfinite(options.from_traces.held_limit));
        FUZZ_CLAIM(!isinf(options.measurement.pitch_diameter)); /* NaN: not given */
        FUZZ_CLAIM(!isinf(options.from_traces.tip_form_diameter));
    }
    return 10 + (int)options.task;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const int is_gearflanks = size > 0 && data[0] == 'f';
    command_line line = split(data + (size > 0), size - (size > 0));
    if (is_gearflanks) {
        FUZZ_CLAIM(try_gearflanks(&line) == try_gearflanks(&line));
    } else {
        FUZZ_CLAIM(try_gearsim(&line) == try_gearsim(&line));
    }
    free(line.memory);
    return 0;
}
