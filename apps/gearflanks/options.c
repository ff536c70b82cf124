/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "options.h"
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
    "                  [--hollow] [--remove-spikes]\n"
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
    "  --traces FILE          profile and helix traces of some teeth; --flanks is written\n"
    "  --measured-pitch FILE  pitch of all teeth; --pitch is written\n"
    "  --datum-face I|II      where the gear was looked at from and face_mm counts from: seen "
    "from\n"
    "                         face I a driving pinion turns clockwise, from face II the other way\n"
    "  --count WAY            how tooth numbers grow, seen from there: clockwise, "
    "counterclockwise\n"
    "  --first-number 0|1     number of the first tooth [1]\n"
    "  --first-tooth N        which tooth of the model that is [0]\n"
    "  --pitch-diameter MM    measuring circle of the pitch [reference circle]\n"
    "  --transverse           deviations are in the transverse section [along the normal]\n"
    "  --held X               share of profile or face that may be missing at an end [0.2]\n"
    "  --hollow               flanks that stand out at their edges are meant so\n"
    "  --remove-spikes        leaves out points far off their neighbours, and filled-in ones\n"
    "                         [they are errors]\n"
    "\n"
    "  --help, --version\n"
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

static int refuse(const flanks_options *options, const char *text, const char *what) {
    message_of_program(options->messages, "%s%s\n%s", text, what, usage);
    return EXIT_BAD_INPUT;
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
    generate->wave_count++;
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

static int take_pitch_diameter(parsing *state, const char *value) {
    double *diameter = &state->options->measurement.pitch_diameter;

    if (!parse_number(value, diameter)) {
        return 0;
    }
    *diameter *= 1e-3;
    return 1;
}

static int take_held(parsing *state, const char *value) {
    return parse_number(value, &state->options->from_traces.held_limit);
}

static void take_evaluate(parsing *state) {
    state->options->task = FLANKS_EVALUATE;
}

static void take_teeth(parsing *state) {
    state->options->teeth = 1;
}

static void take_transverse(parsing *state) {
    state->options->measurement.transverse = 1;
}

static void take_hollow(parsing *state) {
    state->options->from_traces.hollow = 1;
}

static void take_remove_spikes(parsing *state) {
    state->options->from_traces.remove_spikes = 1;
}

/* Tasks that have a use for an option. */
enum use {
    FOR_MAKING = 1 << FLANKS_MAKE,
    FOR_EVALUATING = 1 << FLANKS_EVALUATE,
    FOR_MEASURED = 1 << FLANKS_MEASURED,
    FOR_EACH = FOR_MAKING | FOR_EVALUATING | FOR_MEASURED
};

static const struct {
    const char *name;
    int (*take)(parsing *state, const char *value);
    int use;
    const char *right; /* what would be right */
} valued[] = {
    {"--gear", take_gear, FOR_EACH, "pinion or wheel"},
    {"--flanks", take_deviations, FOR_EACH, "a file name"},
    {"--pitch", take_pitch, FOR_EACH, "a file name"},
    {"--class", take_class, FOR_MAKING, "1 to 11"},
    {"--scatter", take_scatter, FOR_MAKING, "a file name"},
    {"--seed", take_seed, FOR_MAKING, "0 to 18446744073709551615"},
    {"--share", take_share, FOR_MAKING, "0.8 to 0.99"},
    {"--nodes", take_nodes, FOR_MAKING | FOR_MEASURED, "such as 21x31"},
    {"--wave", take_wave, FOR_MAKING, "ORDER:UM such as 67:0.5, at most 100 times"},
    {"--traces", take_traces, FOR_MEASURED, "a file name"},
    {"--measured-pitch", take_measured_pitch, FOR_MEASURED, "a file name"},
    {"--datum-face", take_datum_face, FOR_MEASURED, "I or II"},
    {"--count", take_count, FOR_MEASURED, "clockwise or counterclockwise"},
    {"--first-number", take_first_number, FOR_MEASURED, "0 or 1"},
    {"--first-tooth", take_first_tooth, FOR_MEASURED, "a tooth of the gear, 0 or more"},
    {"--pitch-diameter", take_pitch_diameter, FOR_MEASURED, "a diameter in mm"},
    {"--held", take_held, FOR_MEASURED, "0 to 0.45"},
};

enum { VALUED_COUNT = sizeof valued / sizeof valued[0] };

static const struct {
    const char *name;
    void (*take)(parsing *state);
    int use;
} flags[] = {
    {"--evaluate", take_evaluate, FOR_EVALUATING},         {"--teeth", take_teeth, FOR_EVALUATING},
    {"--transverse", take_transverse, FOR_MEASURED},       {"--hollow", take_hollow, FOR_MEASURED},
    {"--remove-spikes", take_remove_spikes, FOR_MEASURED},
};

enum { FLAG_COUNT = sizeof flags / sizeof flags[0] };

/* Notes for which tasks an option is odd. */
static void note_use(parsing *state, const char *name, int use) {
    for (int task = 0; task < FLANKS_TASKS; ++task) {
        if ((use >> task & 1) == 0) {
            state->odd[task] = name;
        }
    }
}

static int find_valued(const char *text) {
    const size_t length = strcspn(text, "=");

    for (int i = 0; i < VALUED_COUNT; ++i) {
        if (strlen(valued[i].name) == length && strncmp(valued[i].name, text, length) == 0) {
            return i;
        }
    }
    return -1;
}

/* Takes a flag; 0 = there is none of this name. */
static int take_flag(parsing *state, const char *text) {
    for (int i = 0; i < FLAG_COUNT; ++i) {
        if (strcmp(text, flags[i].name) == 0) {
            flags[i].take(state);
            note_use(state, flags[i].name, flags[i].use);
            return 1;
        }
    }
    return 0;
}

/* Takes the option at texts[*index], and its value from there or from the next text. */
static int take_option(parsing *state, int count, char *const texts[], int *index) {
    const char *text = texts[*index];
    const char *value = strchr(text, '=');
    const int which = find_valued(text);

    if (which < 0) {
        return take_flag(state, text) ? 0 : refuse(state->options, "unknown option ", text);
    }
    if (value == NULL && *index + 1 >= count) {
        return refuse(state->options, "a value is missing behind ", text);
    }
    value = value != NULL ? value + 1 : texts[++*index];
    if (!valued[which].take(state, value)) {
        message_of_program(state->options->messages, "%s: must be %s (got '%s')",
                           valued[which].name, valued[which].right, value);
        return EXIT_BAD_INPUT;
    }
    note_use(state, valued[which].name, valued[which].use);
    return 0;
}

static int take_parameters(parsing *state, const char *path) {
    if (state->options->parameters != NULL) {
        return refuse(state->options, "a second INI file, expected one: ", path);
    }
    state->options->parameters = path;
    return *path != '\0' ? 0 : refuse(state->options, "the name of the INI file is empty", "");
}

static int check_way(const parsing *state) {
    const flanks_options *options = state->options;

    if (options->generate.quality_class == 0 && options->scatter == NULL) {
        return refuse(state->options, "--class or --scatter is missing", "");
    }
    if (options->generate.quality_class != 0 && options->scatter != NULL) {
        return refuse(state->options, "--class and --scatter exclude each other", "");
    }
    if (state->has_share && options->scatter != NULL) {
        return refuse(state->options, "not together with --scatter: ", "--share");
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
static int check_outputs(const flanks_options *options) {
    const char *const inputs[] = {options->parameters, options->scatter, options->traces,
                                  options->measured_pitch};
    const char *const outputs[] = {options->deviations, options->pitch};

    if (outputs[0] != NULL && outputs[1] != NULL && is_same_place(outputs[0], outputs[1])) {
        return refuse(options, "--flanks and --pitch are the same file: ", outputs[0]);
    }
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k < 4; ++k) {
            if (outputs[i] != NULL && inputs[k] != NULL &&
                result_file_would_replace(outputs[i], inputs[k])) {
                return refuse(options, "an input would be overwritten: ", inputs[k]);
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
        return refuse(state->options, "--flanks and --pitch are both needed to make flanks", "");
    }
    return status == 0 ? check_outputs(state->options) : status;
}

/* What was measured and what is written belong together. */
static int check_measured(const flanks_options *options) {
    if ((options->traces != NULL) != (options->deviations != NULL)) {
        return refuse(options, "--traces and --flanks go together: missing is ",
                      options->traces != NULL ? "--flanks" : "--traces");
    }
    if ((options->measured_pitch != NULL) != (options->pitch != NULL)) {
        return refuse(options, "--measured-pitch and --pitch go together: missing is ",
                      options->pitch != NULL ? "--measured-pitch" : "--pitch");
    }
    if (options->measurement.datum_face == 0) {
        return refuse(options, "--datum-face is missing", "");
    }
    if (options->measurement.counting == 0) {
        return refuse(options, "--count is missing", "");
    }
    return check_outputs(options);
}

static int refuse_odd(const flanks_options *options, const char *option) {
    if (options->task == FLANKS_EVALUATE) {
        return refuse(options, "not together with --evaluate: ", option);
    }
    if (options->task == FLANKS_MEASURED) {
        return refuse(options, "not together with --traces or --measured-pitch: ", option);
    }
    return refuse(options,
                  strcmp(option, "--teeth") == 0
                      ? "only together with --evaluate: "
                      : "only together with --traces or --measured-pitch: ",
                  option);
}

static int check(const parsing *state) {
    const flanks_options *options = state->options;

    if (options->parameters == NULL) {
        return refuse(state->options, "an INI file is missing", "");
    }
    if (!state->has_gear) {
        return refuse(state->options, "--gear is missing", "");
    }
    if (state->odd[options->task] != NULL) {
        return refuse_odd(options, state->odd[options->task]);
    }
    if (options->task == FLANKS_MEASURED) {
        return check_measured(options);
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

    /* --help and --version win over whatever follows. */
    parsing state = {.options = options};
    int status = 0;
    for (int i = 1; i < count && status == 0; ++i) {
        if (strcmp(texts[i], "--help") == 0 || strcmp(texts[i], "--version") == 0) {
            options->task = texts[i][2] == 'h' ? FLANKS_HELP : FLANKS_VERSION;
            return 0;
        }
        status = texts[i][0] == '-' ? take_option(&state, count, texts, &i)
                                    : take_parameters(&state, texts[i]);
    }

    if (options->task == FLANKS_MAKE &&
        (options->traces != NULL || options->measured_pitch != NULL)) {
        options->task = FLANKS_MEASURED;
    }
    return status == 0 ? check(&state) : status;
}
