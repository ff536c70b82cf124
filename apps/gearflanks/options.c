/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "options.h"
#include "scatter.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: gearflanks PARAMS.ini --gear pinion|wheel --class N [--share X]\n"
    "                  --flanks FILE --pitch FILE [--seed N] [--nodes FACExPROFILE] [--wave "
    "ORDER:UM]...\n"
    "       gearflanks PARAMS.ini --gear pinion|wheel --scatter SCATTER.ini ... as above\n"
    "       gearflanks PARAMS.ini --gear pinion|wheel --evaluate [--flanks FILE] [--pitch FILE] "
    "[--teeth]\n"
    "       gearflanks --help | --version\n";

static const char help[] =
    "\n"
    "Makes flank and pitch files of a gear: of a flank tolerance class of ISO 1328-1, or with "
    "amounts "
    "that\n"
    "scatter from tooth to tooth; and prints what they measure to. Or evaluates such files. "
    "PARAMS.ini is\n"
    "that of gearsim; only [gears] is needed.\n"
    "\n"
    "  --gear pinion|wheel    which gear\n"
    "  --flanks FILE          deviation file: written, or with --evaluate read\n"
    "  --pitch FILE           pitch file: likewise\n"
    "  --class N              flanks of this class, 1 to 11\n"
    "  --share X              with --class: worst value / tolerance, 0.8 to 0.99 [0.95]\n"
    "  --scatter FILE         flanks that scatter as this INI file says\n"
    "  --seed N               same seed, same flanks; pinion and wheel have nothing in common [1]\n"
    "  --nodes FACExPROFILE   grid, 9 to 1000 each way [21x31]\n"
    "  --wave ORDER:UM        a wave (ghost order): per revolution, amplitude along the normal\n"
    "  --evaluate             prints worst values, their classes and tolerances; without --flanks "
    "and\n"
    "                         --pitch those of the files that [flanks] of PARAMS.ini names, as "
    "they\n"
    "                         are: scale, profile window and [modifications] play no part\n"
    "  --teeth                with --evaluate: the values of every flank as CSV instead\n"
    "  --help, --version\n"
    "\n"
    "Options may be written `--option value` or `--option=value`. Paths are relative to the "
    "working\n"
    "folder. A file is written as FILE.part and renamed when it is whole.\n"
    "Exit codes: 0 done; 1 a file cannot be written; 2 usage or input.\n"
    "What is evaluated and made: libgearmesh/docs/flank-quality.md.\n"
    "\n"
    "All keys of SCATTER.ini, with [default], meaning and range; amounts are along the surface "
    "normal:\n"
    "\n";

void options_print_help(FILE *stream) {
    fputs(usage, stream);
    fputs(help, stream);
    key_table_print(&scatter_keys, stream);
}

static int refuse(const char *text, const char *what) {
    fprintf(stderr, "gearflanks: %s%s\n%s", text, what, usage);
    return EXIT_BAD_INPUT;
}

/* ---------------------------------------------------------------------------------------------
 * Numbers, strict
 * ------------------------------------------------------------------------------------------- */

static int all_of(const char *text, const char *characters) {
    return *text != '\0' && text[strspn(text, characters)] == '\0';
}

static int parse_count(const char *text, int *value) {
    if (!all_of(text, "0123456789") || strlen(text) > 9)
        return 0;
    *value = atoi(text);
    return 1;
}

static int parse_seed(const char *text, uint64_t *value) {
    if (!all_of(text, "0123456789"))
        return 0;
    errno = 0;
    const unsigned long long number = strtoull(text, NULL, 10);
    *value = (uint64_t)number;
    return errno == 0 && *value == number;
}

/* Plain decimal or exponent notation; the program never leaves the locale "C". */
static int parse_number(const char *text, double *value) {
    char *end = NULL;

    if (!all_of(text, "0123456789.eE+-"))
        return 0;
    *value = strtod(text, &end);
    return *end == '\0' && isfinite(*value);
}

/* Splits `a<mark>b` into two texts of at most 31 characters. */
static int split(const char *text, char mark, char parts[2][32]) {
    const char *at = strchr(text, mark);

    if (at == NULL || at - text > 31 || strlen(at + 1) > 31)
        return 0;
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
    const char *made_with;      /* an option that --evaluate has no use for, NULL = none */
    const char *evaluated_with; /* the other way round */
} parsing;

static int take_gear(parsing *state, const char *value) {
    state->has_gear = 1;
    state->options->wheel = strcmp(value, "wheel") == 0;
    return state->options->wheel || strcmp(value, "pinion") == 0;
}

static int take_nodes(parsing *state, const char *value) {
    char parts[2][32];
    gm_generate_options *generate = &state->options->generate;

    return split(value, 'x', parts) && parse_count(parts[0], &generate->face_nodes) &&
           parse_count(parts[1], &generate->profile_nodes);
}

static int take_wave(parsing *state, const char *value) {
    char parts[2][32];
    gm_generate_options *generate = &state->options->generate;
    gm_flank_wave *wave = &state->options->waves[generate->wave_count];

    if (generate->wave_count == FLANKS_MOST_WAVES || !split(value, ':', parts) ||
        !parse_count(parts[0], &wave->order) || !parse_number(parts[1], &wave->amplitude))
        return 0;
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

enum use { FOR_BOTH, FOR_MAKING };

static const struct {
    const char *name;
    int (*take)(parsing *state, const char *value);
    enum use use;
    const char *right; /* what would be right */
} valued[] = {
    {"--gear", take_gear, FOR_BOTH, "pinion or wheel"},
    {"--flanks", take_deviations, FOR_BOTH, "a file name"},
    {"--pitch", take_pitch, FOR_BOTH, "a file name"},
    {"--class", take_class, FOR_MAKING, "1 to 11"},
    {"--scatter", take_scatter, FOR_MAKING, "a file name"},
    {"--seed", take_seed, FOR_MAKING, "0 to 18446744073709551615"},
    {"--share", take_share, FOR_MAKING, "0.8 to 0.99"},
    {"--nodes", take_nodes, FOR_MAKING, "such as 21x31"},
    {"--wave", take_wave, FOR_MAKING, "ORDER:UM such as 67:0.5, at most 100 times"},
};

enum { VALUED_COUNT = sizeof valued / sizeof valued[0] };

static int find_valued(const char *text) {
    const size_t length = strcspn(text, "=");

    for (int i = 0; i < VALUED_COUNT; ++i)
        if (strlen(valued[i].name) == length && strncmp(valued[i].name, text, length) == 0)
            return i;
    return -1;
}

/* Takes a flag; 0 = there is none of this name. */
static int take_flag(parsing *state, const char *text) {
    if (strcmp(text, "--evaluate") == 0)
        state->options->task = FLANKS_EVALUATE;
    else if (strcmp(text, "--teeth") == 0)
        state->options->teeth = 1;
    else
        return 0;
    if (state->options->teeth)
        state->evaluated_with = "--teeth";
    return 1;
}

/* Takes the option at texts[*index], and its value from there or from the next text. */
static int take_option(parsing *state, int count, char *const texts[], int *index) {
    const char *text = texts[*index];
    const char *value = strchr(text, '=');
    const int which = find_valued(text);

    if (which < 0)
        return take_flag(state, text) ? 0 : refuse("unknown option ", text);
    if (value == NULL && *index + 1 >= count)
        return refuse("a value is missing behind ", text);
    value = value != NULL ? value + 1 : texts[++*index];
    if (!valued[which].take(state, value)) {
        fprintf(stderr, "gearflanks: %s: got '%s', must be %s\n", valued[which].name, value,
                valued[which].right);
        return EXIT_BAD_INPUT;
    }
    if (valued[which].use == FOR_MAKING)
        state->made_with = valued[which].name;
    return 0;
}

static int take_parameters(parsing *state, const char *path) {
    if (state->options->parameters != NULL)
        return refuse("a second INI file, expected one: ", path);
    state->options->parameters = path;
    return *path != '\0' ? 0 : refuse("the name of the INI file is empty", "");
}

static int check_way(const parsing *state) {
    const flanks_options *options = state->options;

    if (options->generate.quality_class == 0 && options->scatter == NULL)
        return refuse("--class or --scatter is missing", "");
    if (options->generate.quality_class != 0 && options->scatter != NULL)
        return refuse("--class and --scatter exclude each other", "");
    if (state->has_share && options->scatter != NULL)
        return refuse("not together with --scatter: ", "--share");
    return 0;
}

static int check_outputs(const flanks_options *options) {
    const char *const inputs[] = {options->parameters, options->scatter};

    if (options->deviations == NULL || options->pitch == NULL)
        return refuse("--flanks and --pitch are both needed to make flanks", "");
    if (strcmp(options->deviations, options->pitch) == 0)
        return refuse("--flanks and --pitch are the same file: ", options->pitch);
    for (int i = 0; i < 2; ++i)
        if (inputs[i] != NULL &&
            (strcmp(options->deviations, inputs[i]) == 0 || strcmp(options->pitch, inputs[i]) == 0))
            return refuse("the INI file would be overwritten: ", inputs[i]);
    return 0;
}

static int check_making(const parsing *state) {
    const int status = check_way(state);

    return status == 0 ? check_outputs(state->options) : status;
}

static int check(const parsing *state) {
    const flanks_options *options = state->options;

    if (options->parameters == NULL)
        return refuse("an INI file is missing", "");
    if (!state->has_gear)
        return refuse("--gear is missing", "");
    if (options->task == FLANKS_EVALUATE && state->made_with != NULL)
        return refuse("not together with --evaluate: ", state->made_with);
    if (options->task == FLANKS_MAKE && state->evaluated_with != NULL)
        return refuse("only together with --evaluate: ", state->evaluated_with);
    return options->task == FLANKS_MAKE ? check_making(state) : 0;
}

int options_parse(flanks_options *options, int count, char *const texts[]) {
    parsing state = {.options = options};
    int status = 0;

    memset(options, 0, sizeof *options);
    gm_generate_options_default(&options->generate);
    options->generate.waves = options->waves;
    for (int i = 1; i < count && status == 0; ++i) {
        if (strcmp(texts[i], "--help") == 0 || strcmp(texts[i], "--version") == 0) {
            options->task = texts[i][2] == 'h' ? FLANKS_HELP : FLANKS_VERSION;
            return 0;
        }
        status = texts[i][0] == '-' ? take_option(&state, count, texts, &i)
                                    : take_parameters(&state, texts[i]);
    }
    return status == 0 ? check(&state) : status;
}
