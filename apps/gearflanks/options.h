/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The command line of gearflanks. */
#ifndef GEARFLANKS_OPTIONS_H
#define GEARFLANKS_OPTIONS_H

#include "config.h"

#include <gearmesh/gearmesh_io.h>

enum flanks_task { FLANKS_MAKE, FLANKS_EVALUATE, FLANKS_MEASURED, FLANKS_HELP, FLANKS_VERSION };

enum { FLANKS_TASKS = FLANKS_HELP }; /* that need gears */

typedef struct flanks_options {
    message_sink *messages;
    enum flanks_task task;
    const char *parameters; /* the INI file */
    int wheel;              /* 0 = pinion, 1 = wheel */
    const char *deviations; /* file names, NULL = not given */
    const char *pitch;
    const char *scatter; /* INI file of amounts, NULL = of a class */
    int teeth;           /* --teeth: the values of every flank */
    const char *traces;  /* what was measured, NULL = nothing */
    const char *measured_pitch;
    int number_style; /* enum gm_number_style of what was measured */
    gm_measurement measurement;
    gm_traces_options from_traces;
    gm_generate_options generate;
    gm_flank_wave waves[GM_FLANK_WAVES_MAX]; /* what generate.waves points to */
} flanks_options;

/* Returns 0, or EXIT_BAD_INPUT after a message. */
int options_parse(flanks_options *options, int count, char *const texts[], message_sink *messages);

void options_print_help(FILE *stream);

#endif
