/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "options.h"
#include "command_line.h"
#include "paths.h"
#include "result_file.h"
#include "scatter.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: gearflanks PARAMS.ini --gear pinion|wheel --class N [--share X]\n"
    "                  --flanks FILE --pitch FILE [--seed N] [--nodes FACExPROFILE]\n"
    "                  [--wave ORDER:UM]...\n"
    "       gearflanks PARAMS.ini --gear pinion|wheel --scatter SCATTER.ini ... as above\n"
    "       gearflanks PARAMS.ini --gear pinion|wheel --evaluate [--flanks FILE] [--pitch FILE] "
    "[--teeth]\n"
    "       gearflanks PARAMS.ini --gear pinion|wheel --traces FILE --flanks FILE\n"
    "                  --measured-pitch FILE --pitch FILE --datum-face I|II\n"
    "                  --count clockwise|counterclockwise [--first-number 0|1] [--first-tooth N]\n"
    "                  [--nodes FACExPROFILE] [--pitch-diameter MM] [--transverse] [--held X]\n"
    "                  [--tip-form-diameter MM] [--probe-sign]\n"
    "                  [--decimal-comma] [--hollow] [--remove-spikes]\n"
    "       gearflanks --help | --version";

static const char help[] =
    "\n"
    "Makes flank and pitch files of a gear: of a flank tolerance class of ISO 1328-1, or with\n"
    "amounts that scatter from tooth to tooth, and prints what they measure to; or from what was\n"
    "measured. Or evaluates such files. PARAMS.ini is that of gearsim; only [gears] is needed.\n"
    "\n"
    "  --gear pinion|wheel    which gear\n"
    "  --flanks FILE          deviation file: written, or with --evaluate read\n"
    "  --pitch FILE           pitch file: likewise\n"
    "  --class N              flanks of this class, 1 to 11\n"
    "  --share X              with --class: worst value / tolerance, 0.8 to 0.99 [0.95]\n"
    "  --scatter FILE         flanks that scatter as this INI file says\n"
    "  --seed N               same seed, same flanks; pinion and wheel have nothing in common [1]\n"
    "  --nodes FACExPROFILE   grid, 9 to 1000 each way, from measurements 2 to 1000 [21x31]\n"
    "  --wave ORDER:UM        a wave (ghost order): per revolution, amplitude along the normal\n"
    "  --evaluate             prints worst values, their classes and tolerances; without --flanks "
    "and\n"
    "                         --pitch those of the files that [flanks] of PARAMS.ini names, as "
    "they\n"
    "                         are: scale, profile window and [modifications] play no part\n"
    "  --teeth                with --evaluate: the values of every flank as CSV instead\n"
    "\n"
    "From measurements, of traces and pitch or of one of them:\n"
    "  --traces FILE          profile and helix traces of some teeth, as CSV or as a Klingelnberg "
    "text\n"
    "                         file (.mka); --flanks is written\n"
    "  --measured-pitch FILE  pitch of all teeth, likewise; --pitch is written\n"
    "  --datum-face I|II      where the gear was looked at from and face_mm counts from: seen "
    "from\n"
    "                         face I a driving pinion turns clockwise, from face II the other way\n"
    "  --count WAY            how tooth numbers grow, seen from there: clockwise, "
    "counterclockwise\n"
    "  --first-number 0|1     number of the first tooth [1]\n"
    "  --first-tooth N        which tooth of the model that is [0]\n"
    "  --pitch-diameter MM    measuring circle of the pitch [reference circle]\n"
    "  --tip-form-diameter MM points of profiles beyond it are left out: a chamfer is no flank\n"
    "  --probe-sign           deviations have the sign of the probe: > 0 is material added on "
    "right\n"
    "                         flanks and removed on left ones\n"
    "  --decimal-comma        numbers are 1,5, and fields are separated by semicolons\n"
    "  --transverse           deviations are in the transverse section [along the normal]\n"
    "  --held X               share of profile or face that may be missing at an end [0.2]\n"
    "  --hollow               flanks that stand out at their edges are meant so\n"
    "  --remove-spikes        leaves out points far off their neighbours, and filled-in ones\n"
    "                         [they are errors]\n"
    "\n"
    "  --help, --version\n"
    "  --                     all that follows is no option\n"
    "\n"
    "Options may be written `--option value` or `--option=value`. Paths are relative to the "
    "working\n"
    "folder. A file grows in FILE.part, which becomes FILE when it is whole and on the disk; two\n"
    "files are replaced both or none. No second run can write them meanwhile. A link in place of\n"
    "FILE stays, and the file that it leads to is replaced.\n"
    "Exit codes: 0 done; 1 writing failed; 2 usage or input; 130 interrupted, no file replaced.\n"
    "What is evaluated, made and measured: flank-quality.md, measured-flanks.md in "
    "libgearmesh/docs.\n"
    "\n"
    "All keys of SCATTER.ini, with [default], meaning and range; amounts are along the normal:\n"
    "\n";

void options_print_help(FILE *stream) {
    fprintf(stream, "%s\n", usage);
    fputs(help, stream);
    key_table_print(&scatter_keys, stream);
}

/* ---------------------------------------------------------------------------------------------
 * Numbers, strict
 * ------------------------------------------------------------------------------------------- */

static int all_of(const char *text, const char *characters) {
    return *text != '\0' && text[strspn(text, characters)] == '\0';
}

static int parse_count(const char *text, int *value) {
    if (!all_of(text, "0123456789") || strlen(text) > 9) {
        return 0;
    }
    *value = atoi(text);
    return 1;
}

static int parse_seed(const char *text, uint64_t *value) {
    if (!all_of(text, "0123456789")) {
        return 0;
    }
    errno = 0;
    const unsigned long long number = strtoull(text, NULL, 10);
    *value = (uint64_t)number;
    return errno == 0 && *value == number;
}

/* Plain decimal or exponent notation; the program never leaves the locale "C". */
static int parse_number(const char *text, double *value) {
    char *end = NULL;

    if (!all_of(text, "0123456789.eE+-")) {
        return 0;
    }
    *value = strtod(text, &end);
    return *end == '\0' && isfinite(*value);
}

/* Splits `a<mark>b` into two texts of at most 31 characters. */
static int split(const char *text, char mark, char parts[2][32]) {
    const char *at = strchr(text, mark);

    if (at == NULL || at - text > 31 || strlen(at + 1) > 31) {
        return 0;
    }
    memcpy(parts[0], text, (size_t)(at - text));
    parts[0][at - text] = '\0';
    strcpy(parts[1], at + 1);
    return 1;
}

/* ---------------------------------------------------------------------------------------------
 * Options
 * ------------------------------------------------------------------------------------------- */

typedef struct parsing {
    flanks_options *options;
    command_line line;
    int has_gear;
    int has_share;
    const char *odd[FLANKS_TASKS]; /* an option that a task has no use for, NULL = none */
} parsing;

static int take_gear(parsing *state, const char *value) {
    state->has_gear = 1;
    state->options->wheel = strcmp(value, "wheel") == 0;
    return state->options->wheel || strcmp(value, "pinion") == 0;
}

static int take_nodes(parsing *state, const char *value) {
    char parts[2][32];
    gm_generate_options *generate = &state->options->generate;
    gm_traces_options *from_traces = &state->options->from_traces;

    if (!split(value, 'x', parts) || !parse_count(parts[0], &generate->face_nodes) ||
        !parse_count(parts[1], &generate->profile_nodes)) {
        return 0;
    }
    from_traces->face_nodes = generate->face_nodes;
    from_traces->profile_nodes = generate->profile_nodes;
    return 1;
}

static int take_wave(parsing *state, const char *value) {
    char parts[2][32];
    gm_generate_options *generate = &state->options->generate;
    gm_flank_wave *wave = &state->options->waves[generate->wave_count];

    if (generate->wave_count == GM_FLANK_WAVES_MAX || !split(value, ':', parts) ||
        !parse_count(parts[0], &wave->order) || !parse_number(parts[1], &wave->amplitude)) {
        return 0;
    }
    wave->amplitude *= 1e-6;
    ++generate->wave_count;
    return 1;
}

static int take_class(parsing *state, const char *value) {
    return parse_count(value, &state->options->generate.quality_class);
}

static int take_seed(parsing *state, const char *value) {
    return parse_seed(value, &state->options->generate.seed);
}

static int take_share(parsing *state, const char *value) {
    state->has_share = 1;
    return parse_number(value, &state->options->generate.share);
}

static int take_scatter(parsing *state, const char *value) {
    state->options->scatter = value;
    return *value != '\0';
}

static int take_deviations(parsing *state, const char *value) {
    state->options->deviations = value;
    return *value != '\0';
}

static int take_pitch(parsing *state, const char *value) {
    state->options->pitch = value;
    return *value != '\0';
}

static int take_traces(parsing *state, const char *value) {
    state->options->traces = value;
    return *value != '\0';
}

static int take_measured_pitch(parsing *state, const char *value) {
    state->options->measured_pitch = value;
    return *value != '\0';
}

/* One of two words as 1 or 2; 0 = neither. */
static int take_word(const char *value, const char *one, const char *two, int *which) {
    *which = strcmp(value, one) == 0 ? 1 : strcmp(value, two) == 0 ? 2 : 0;
    return *which != 0;
}

static int take_datum_face(parsing *state, const char *value) {
    return take_word(value, "I", "II", &state->options->measurement.datum_face);
}

static int take_count(parsing *state, const char *value) {
    return take_word(value, "clockwise", "counterclockwise", &state->options->measurement.counting);
}

static int take_first_number(parsing *state, const char *value) {
    return parse_count(value, &state->options->measurement.first_number) &&
           state->options->measurement.first_number <= 1;
}

static int take_first_tooth(parsing *state, const char *value) {
    return parse_count(value, &state->options->measurement.first_tooth);
}

static int take_diameter(const char *value, double *diameter) {
    if (!parse_number(value, diameter)) {
        return 0;
    }
    *diameter *= 1e-3;
    return 1;
}

static int take_pitch_diameter(parsing *state, const char *value) {
    return take_diameter(value, &state->options->measurement.pitch_diameter);
}

static int take_tip_form_diameter(parsing *state, const char *value) {
    return take_diameter(value, &state->options->from_traces.tip_form_diameter);
}

static int take_probe_sign(parsing *state, const char *value) {
    (void)value;
    state->options->from_traces.probe_sign = 1;
    return 1;
}

static int take_decimal_comma(parsing *state, const char *value) {
    (void)value;
    state->options->number_style = GM_DECIMAL_COMMA;
    return 1;
}

static int take_held(parsing *state, const char *value) {
    return parse_number(value, &state->options->from_traces.held_limit);
}

static int take_evaluate(parsing *state, const char *value) {
    (void)value;
    state->options->task = FLANKS_EVALUATE;
    return 1;
}

static int take_teeth(parsing *state, const char *value) {
    (void)value;
    state->options->teeth = 1;
    return 1;
}

static int take_transverse(parsing *state, const char *value) {
    (void)value;
    state->options->measurement.transverse = 1;
    return 1;
}

static int take_hollow(parsing *state, const char *value) {
    (void)value;
    state->options->from_traces.hollow = 1;
    return 1;
}

static int take_remove_spikes(parsing *state, const char *value) {
    (void)value;
    state->options->from_traces.remove_spikes = 1;
    return 1;
}

static int take_help(parsing *state, const char *value) {
    (void)value;
    state->options->task = FLANKS_HELP;
    return 1;
}

static int take_version(parsing *state, const char *value) {
    (void)value;
    state->options->task = FLANKS_VERSION;
    return 1;
}

/* Tasks that have a use for an option. */
enum use {
    FOR_MAKING = 1 << FLANKS_MAKE,
    FOR_EVALUATING = 1 << FLANKS_EVALUATE,
    FOR_MEASURED = 1 << FLANKS_MEASURED,
    FOR_EACH = FOR_MAKING | FOR_EVALUATING | FOR_MEASURED
};

static const struct {
    option_spec spec;
    int (*take)(parsing *state, const char *value); /* 0 = the value is wrong */
    int use;
} options_known[] = {
    {{"--gear", "pinion or wheel"}, take_gear, FOR_EACH},
    {{"--flanks", "a file name"}, take_deviations, FOR_EACH},
    {{"--pitch", "a file name"}, take_pitch, FOR_EACH},
    {{"--class", "1 to 11"}, take_class, FOR_MAKING},
    {{"--scatter", "a file name"}, take_scatter, FOR_MAKING},
    {{"--seed", "0 to 18446744073709551615"}, take_seed, FOR_MAKING},
    {{"--share", "0.8 to 0.99"}, take_share, FOR_MAKING},
    {{"--nodes", "such as 21x31"}, take_nodes, FOR_MAKING | FOR_MEASURED},
    {{"--wave", "ORDER:UM such as 67:0.5, at most 100 times"}, take_wave, FOR_MAKING},
    {{"--traces", "a file name"}, take_traces, FOR_MEASURED},
    {{"--measured-pitch", "a file name"}, take_measured_pitch, FOR_MEASURED},
    {{"--datum-face", "I or II"}, take_datum_face, FOR_MEASURED},
    {{"--count", "clockwise or counterclockwise"}, take_count, FOR_MEASURED},
    {{"--first-number", "0 or 1"}, take_first_number, FOR_MEASURED},
    {{"--first-tooth", "a tooth of the gear, 0 or more"}, take_first_tooth, FOR_MEASURED},
    {{"--pitch-diameter", "a diameter in mm"}, take_pitch_diameter, FOR_MEASURED},
    {{"--tip-form-diameter", "a diameter in mm"}, take_tip_form_diameter, FOR_MEASURED},
    {{"--probe-sign", NULL}, take_probe_sign, FOR_MEASURED},
    {{"--decimal-comma", NULL}, take_decimal_comma, FOR_MEASURED},
    {{"--held", "0 to 0.45"}, take_held, FOR_MEASURED},
    {{"--evaluate", NULL}, take_evaluate, FOR_EVALUATING},
    {{"--teeth", NULL}, take_teeth, FOR_EVALUATING},
    {{"--transverse", NULL}, take_transverse, FOR_MEASURED},
    {{"--hollow", NULL}, take_hollow, FOR_MEASURED},
    {{"--remove-spikes", NULL}, take_remove_spikes, FOR_MEASURED},
    {{"--help", NULL}, take_help, FOR_EACH},
    {{"--version", NULL}, take_version, FOR_EACH},
};

enum { OPTION_COUNT = sizeof options_known / sizeof options_known[0] };

static const option_spec *option_at(int which) {
    return &options_known[which].spec;
}

/* Notes for which tasks an option is odd. */
static void note_use(parsing *state, const char *name, int use) {
    for (int task = 0; task < FLANKS_TASKS; ++task) {
        if ((use >> task & 1) == 0) {
            state->odd[task] = name;
        }
    }
}

static enum option_result take_option(void *user, int which, const char *value) {
    parsing *state = user;

    if (!options_known[which].take(state, value)) {
        return OPTION_WRONG;
    }
    note_use(state, options_known[which].spec.name, options_known[which].use);

    /* --help and --version win over whatever follows. */
    return state->options->task >= FLANKS_HELP ? OPTION_LAST : OPTION_TAKEN;
}

/* ---------------------------------------------------------------------------------------------
 * What must fit together
 * ------------------------------------------------------------------------------------------- */

static int refuse(const parsing *state, const char *text, const char *what) {
    return command_line_refuse(&state->line, text, what);
}

static int check_way(const parsing *state) {
    const flanks_options *options = state->options;

    if (options->generate.quality_class == 0 && options->scatter == NULL) {
        return refuse(state, "--class or --scatter is missing", "");
    }
    if (options->generate.quality_class != 0 && options->scatter != NULL) {
        return refuse(state, "--class and --scatter exclude each other", "");
    }
    if (state->has_share && options->scatter != NULL) {
        return refuse(state, "not together with --scatter: ", "--share");
    }
    return 0;
}

static int check_place(const flanks_options *options, const char *output) {
    result_file file;
    const int status = result_file_check(&file, output);

    if (status != EXIT_DONE) {
        message_of_program(options->messages, "%s %s", file.wrong_path, file.reason);
    }
    result_file_free(&file);
    return status;
}

/* Two files are written, and none of those that are read. */
static int check_outputs(const parsing *state) {
    const flanks_options *options = state->options;
    const char *const inputs[] = {options->parameters, options->scatter, options->traces,
                                  options->measured_pitch};
    const char *const outputs[] = {options->deviations, options->pitch};

    if (outputs[0] != NULL && outputs[1] != NULL && is_same_place(outputs[0], outputs[1])) {
        return refuse(state, "--flanks and --pitch are the same file: ", outputs[0]);
    }
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k < 4; ++k) {
            if (outputs[i] != NULL && inputs[k] != NULL &&
                result_file_would_replace(outputs[i], inputs[k])) {
                return refuse(state, "an input would be overwritten: ", inputs[k]);
            }
        }
    }

    int status = EXIT_DONE;
    for (int i = 0; i < 2 && status == EXIT_DONE; ++i) {
        status = outputs[i] != NULL ? check_place(options, outputs[i]) : EXIT_DONE;
    }
    return status;
}

static int check_making(const parsing *state) {
    const int status = check_way(state);

    if (status == 0 && (state->options->deviations == NULL || state->options->pitch == NULL)) {
        return refuse(state, "--flanks and --pitch are both needed to make flanks", "");
    }
    return status == 0 ? check_outputs(state) : status;
}

/* What was measured and what is written belong together. */
static int check_measured(const parsing *state) {
    const flanks_options *options = state->options;

    if ((options->traces != NULL) != (options->deviations != NULL)) {
        return refuse(state, "--traces and --flanks go together: missing is ",
                      options->traces != NULL ? "--flanks" : "--traces");
    }
    if ((options->measured_pitch != NULL) != (options->pitch != NULL)) {
        return refuse(state, "--measured-pitch and --pitch go together: missing is ",
                      options->pitch != NULL ? "--measured-pitch" : "--pitch");
    }
    if (options->measurement.datum_face == 0) {
        return refuse(state, "--datum-face is missing", "");
    }
    if (options->measurement.counting == 0) {
        return refuse(state, "--count is missing", "");
    }
    return check_outputs(state);
}

static int refuse_odd(const parsing *state, const char *option) {
    const enum flanks_task task = state->options->task;

    if (task == FLANKS_EVALUATE) {
        return refuse(state, "not together with --evaluate: ", option);
    }
    if (task == FLANKS_MEASURED) {
        return refuse(state, "not together with --traces or --measured-pitch: ", option);
    }
    return refuse(state,
                  strcmp(option, "--teeth") == 0
                      ? "only together with --evaluate: "
                      : "only together with --traces or --measured-pitch: ",
                  option);
}

static int check(const parsing *state) {
    const flanks_options *options = state->options;

    if (options->parameters == NULL) {
        return refuse(state, "an INI file is missing", "");
    }
    if (!state->has_gear) {
        return refuse(state, "--gear is missing", "");
    }
    if (state->odd[options->task] != NULL) {
        return refuse_odd(state, state->odd[options->task]);
    }
    if (options->task == FLANKS_MEASURED) {
        return check_measured(state);
    }
    return options->task == FLANKS_MAKE ? check_making(state) : 0;
}

int options_parse(flanks_options *options, int count, char *const texts[], message_sink *messages) {
    memset(options, 0, sizeof *options);
    options->messages = messages;
    gm_generate_options_default(&options->generate);
    gm_measurement_default(&options->measurement);
    gm_traces_options_default(&options->from_traces);
    options->generate.waves = options->waves;

    parsing state = {.options = options,
                     .line = {.count = OPTION_COUNT,
                              .option = option_at,
                              .take = take_option,
                              .user = &state,
                              .usage = usage,
                              .messages = messages}};
    const int status = command_line_read(&state.line, count, texts);
    if (status != 0 || options->task >= FLANKS_HELP) {
        return status;
    }

    options->parameters = state.line.file;
    if (options->task == FLANKS_MAKE &&
        (options->traces != NULL || options->measured_pitch != NULL)) {
        options->task = FLANKS_MEASURED;
    }
    return check(&state);
}
