/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "keys.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------------------------------------
 * The table
 * ------------------------------------------------------------------------------------------- */

#define NAME(the_section, the_name)                                                                \
    .section = (the_section), .name = (the_name), .full_name = the_section "." the_name

/* A field of config, and of gm_pair_params by its name there. */
#define INTO(member)     .target = offsetof(config, member)
#define INTO_GEARS(name) .target = offsetof(config, gears.name), .field = #name

#define ANY                                                                                        \
    { -HUGE_VAL, HUGE_VAL, 1, 1 }
#define ABOVE_ZERO                                                                                 \
    { 0, HUGE_VAL, 1, 1 }
#define NOT_NEGATIVE                                                                               \
    { 0, HUGE_VAL, 0, 1 }
#define AT_LEAST(a)                                                                                \
    { a, HUGE_VAL, 0, 1 }
#define BETWEEN(a, b)                                                                              \
    { a, b, 0, 0 }
#define WITHIN(a, b)                                                                               \
    { a, b, 1, 1 }

#define NUMBER(key_unit, ...) .kind = KEY_NUMBER, .unit = (key_unit), .range = __VA_ARGS__
#define COUNT(low, high)      .kind = KEY_COUNT, .range = BETWEEN(low, high)
#define CHOICE(names)         .kind = KEY_CHOICE, .choices = (names)

#include "modification_rows.h"

/* clang-format off */
const key_spec keys[] = {
    {NAME("gears", "pinion_teeth"), COUNT(3, 100000), INTO_GEARS(pinion_teeth),
     .required = FOR_ALL, .help = "number of teeth"},
    {NAME("gears", "wheel_teeth"), COUNT(3, 100000), INTO_GEARS(wheel_teeth),
     .required = FOR_ALL, .help = "number of teeth"},
    {NAME("gears", "normal_module_mm"), NUMBER(UNIT_MM, ABOVE_ZERO), INTO_GEARS(normal_module),
     .required = FOR_ALL, .help = "module in the normal section"},
    {NAME("gears", "normal_pressure_angle_deg"), NUMBER(UNIT_DEG, WITHIN(0, 45)),
     INTO_GEARS(normal_pressure_angle), .required = FOR_ALL, .help = "pressure angle in the normal section"},
    {NAME("gears", "helix_angle_deg"), NUMBER(UNIT_DEG, WITHIN(-60, 60)), INTO_GEARS(helix_angle),
     .standard = "0", .help = "> 0: the pinion is right-handed"},
    {NAME("gears", "center_distance_mm"), NUMBER(UNIT_MM, ABOVE_ZERO), INTO_GEARS(center_distance),
     .required = FOR_ALL, .help = "distance of the axes"},
    {NAME("gears", "face_width_mm"), NUMBER(UNIT_MM, ABOVE_ZERO), INTO_GEARS(face_width),
     .required = FOR_ALL, .help = "face width common to both gears"},
    {NAME("gears", "pinion_profile_shift"), NUMBER(UNIT_SI, ANY), INTO_GEARS(pinion_profile_shift),
     .derived = "half, or rest, of the zero-backlash sum", .help = "profile shift coefficient"},
    {NAME("gears", "wheel_profile_shift"), NUMBER(UNIT_SI, ANY), INTO_GEARS(wheel_profile_shift),
     .derived = "half, or rest, of the zero-backlash sum", .help = "profile shift coefficient"},
    {NAME("gears", "backlash_um"), NUMBER(UNIT_UM, ANY), INTO_GEARS(backlash),
     .derived = "from the tooth thicknesses",
     .help = "along the line of action, by thinning both teeth"},
    {NAME("gears", "pinion_tip_diameter_mm"), NUMBER(UNIT_MM_DIAMETER, ABOVE_ZERO),
     INTO_GEARS(pinion_tip_radius), .derived = "reference diameter + 2 m_n (1 + x)", .help = "tip circle"},
    {NAME("gears", "wheel_tip_diameter_mm"), NUMBER(UNIT_MM_DIAMETER, ABOVE_ZERO),
     INTO_GEARS(wheel_tip_radius), .derived = "reference diameter + 2 m_n (1 + x)", .help = "tip circle"},
    {NAME("gears", "pinion_start_diameter_mm"), NUMBER(UNIT_MM_DIAMETER, ABOVE_ZERO),
     INTO_GEARS(pinion_start_radius), .derived = "the point that meets the wheel's tip",
     .help = "start of the active profile"},
    {NAME("gears", "wheel_start_diameter_mm"), NUMBER(UNIT_MM_DIAMETER, ABOVE_ZERO),
     INTO_GEARS(wheel_start_radius), .derived = "the point that meets the pinion's tip",
     .help = "start of the active profile"},
    {NAME("gears", "base_helix"), CHOICE("iso paper"), INTO_GEARS(base_helix), .standard = "iso",
     .help = "paper: as printed there in Eq. 6, which is wrong"},

    {NAME("flanks", "pinion"), .kind = KEY_PATH, INTO(pinion_flanks.deviations),
     .derived = "ideal", .used = FOR_3D, .help = "file of measured deviations"},
    {NAME("flanks", "wheel"), .kind = KEY_PATH, INTO(wheel_flanks.deviations),
     .derived = "ideal", .used = FOR_3D, .help = "file of measured deviations"},
    {NAME("flanks", "pinion_pitch"), .kind = KEY_PATH, INTO(pinion_flanks.pitch),
     .derived = "ideal", .used = FOR_3D, .help = "file of pitch deviations"},
    {NAME("flanks", "wheel_pitch"), .kind = KEY_PATH, INTO(wheel_flanks.pitch),
     .derived = "ideal", .used = FOR_3D, .help = "file of pitch deviations"},
    {NAME("flanks", "scale"), NUMBER(UNIT_SI, ANY), INTO(flank_scale), .standard = "1",
     .used = FOR_3D, .help = "multiplies deviations and pitch"},
    {NAME("flanks", "deviation_direction"), CHOICE("normal transverse"), INTO(deviation_direction),
     .standard = "normal", .used = FOR_3D, .help = "in which deviations are measured"},
    {NAME("flanks", "profile_from"), NUMBER(UNIT_SI, BETWEEN(0, 1)), INTO(profile_from),
     .standard = "0", .used = FOR_3D, .help = "deviations (not pitch) count from here (start 0, tip 1)"},
    {NAME("flanks", "profile_to"), NUMBER(UNIT_SI, BETWEEN(0, 1)), INTO(profile_to),
     .standard = "1", .used = FOR_3D, .help = "to here"},
    {NAME("flanks", "profile_blend"), NUMBER(UNIT_SI, NOT_NEGATIVE), INTO(profile_blend),
     .standard = "0.1", .used = FOR_3D, .help = "width of the ramps to zero outside that range"},

    {NAME("modifications", "tolerance_um"), NUMBER(UNIT_UM, {1e-5, HUGE_VAL, 0, 1}), INTO(modification_tolerance),
     .standard = "0.01", .used = FOR_3D, .help = "how far the table of a design may be off"},
    MODIFICATION_ROWS,

    {NAME("mesh", "model"), CHOICE("simple 3d"), INTO(model), .standard = "3d",
     .help = "simple: a spring with backlash"},
    {NAME("mesh", "stiffness_N_per_m"), NUMBER(UNIT_SI, ABOVE_ZERO), INTO(stiffness),
     .required = FOR_RUN, .help = "of one tooth pair in contact over the full face width"},
    {NAME("mesh", "damping_Ns_per_m"), NUMBER(UNIT_SI, NOT_NEGATIVE), INTO(damping),
     .standard = "0", .used = FOR_DYNAMIC, .help = "of one tooth pair"},
    {NAME("mesh", "simple_stiffness_N_per_m"), NUMBER(UNIT_SI, ABOVE_ZERO), INTO(simple_stiffness),
     .derived = "stiffness_N_per_m * eps_alpha", .used = FOR_SIMPLE,
     .help = "of the simple model"},

    {NAME("bodies", "pinion_inertia_kg_m2"), NUMBER(UNIT_SI, ABOVE_ZERO), INTO(pinion_inertia),
     .used = FOR_DYNAMIC | FOR_TORQUE, .required = FOR_RUN | FOR_DYNAMIC | FOR_TORQUE,
     .help = "about its axis"},
    {NAME("bodies", "wheel_inertia_kg_m2"), NUMBER(UNIT_SI, ABOVE_ZERO), INTO(wheel_inertia),
     .used = FOR_DYNAMIC, .required = FOR_RUN | FOR_DYNAMIC, .help = "about its axis"},

    {NAME("drive", "kind"), CHOICE("speed torque"), INTO(drive), .standard = "speed",
     .used = FOR_DYNAMIC, .help = "what is prescribed at the pinion"},
    {NAME("drive", "start_rpm"), NUMBER(UNIT_RPM, ANY), INTO(start_speed), .standard = "0",
     .used = FOR_DYNAMIC, .required = FOR_RUN | FOR_DYNAMIC | FOR_SPEED,
     .help = "pinion speed at the start"},
    {NAME("drive", "end_rpm"), NUMBER(UNIT_RPM, ANY), INTO(end_speed),
     .used = FOR_DYNAMIC | FOR_SPEED, .required = FOR_RUN | FOR_DYNAMIC | FOR_SPEED,
     .help = "pinion speed at the end, linear in time"},
    {NAME("drive", "torque_Nm"), NUMBER(UNIT_SI, ANY), INTO(drive_torque),
     .used = FOR_DYNAMIC | FOR_TORQUE, .required = FOR_RUN | FOR_DYNAMIC | FOR_TORQUE,
     .help = "constant torque on the pinion"},

    {NAME("load", "mean_Nm"), NUMBER(UNIT_SI, ANY), INTO(mean_load),
     .required = FOR_RUN, .help = "on the wheel, > 0 resists its driven direction"},
    {NAME("load", "noise_amplitude_Nm"), NUMBER(UNIT_SI, NOT_NEGATIVE), INTO(noise_amplitude),
     .standard = "0", .used = FOR_DYNAMIC, .help = "noise on the load, uniform in +- amplitude"},
    {NAME("load", "noise_interval_s"), NUMBER(UNIT_SI, ABOVE_ZERO), INTO(noise_interval),
     .standard = "1e-5", .used = FOR_DYNAMIC, .help = "time between independent values, cubic in between"},
    {NAME("load", "seed"), .kind = KEY_SEED, INTO(seed),
     .standard = "1", .used = FOR_DYNAMIC, .help = "of the noise; same seed, same run"},

    {NAME("analysis", "type"), CHOICE("dynamic static"), INTO(analysis), .standard = "dynamic",
     .help = "static: transmission error under load (model 3d)"},
    {NAME("analysis", "duration_s"), NUMBER(UNIT_SI, ABOVE_ZERO), INTO(duration),
     .used = FOR_DYNAMIC, .required = FOR_RUN | FOR_DYNAMIC, .help = "simulated time"},
    {NAME("analysis", "positions"), COUNT(1, 100000000), INTO(positions),
     .standard = "200", .used = FOR_STATIC, .help = "equal steps over the period"},
    {NAME("analysis", "period"), CHOICE("mesh pinion hunting"), INTO(period),
     .standard = "mesh", .used = FOR_STATIC, .help = "one tooth, one turn, or until the same teeth meet"},

    {NAME("solver", "method"), CHOICE("bdf adams erk"), INTO(method), .standard = "adams",
     .used = FOR_DYNAMIC, .help = "of CVODE; erk: explicit Runge-Kutta, of ARKODE"},
    {NAME("solver", "relative_tolerance"), NUMBER(UNIT_SI, NOT_NEGATIVE), INTO(relative_tolerance),
     .standard = "1e-4", .used = FOR_DYNAMIC, .help = "of the integration"},
    {NAME("solver", "absolute_tolerance_um"), NUMBER(UNIT_UM, ABOVE_ZERO), INTO(absolute_tolerance),
     .standard = "1e-4", .used = FOR_DYNAMIC, .help = "of the mesh coordinate"},
    {NAME("solver", "max_step_s"), NUMBER(UNIT_SI, NOT_NEGATIVE), INTO(max_step),
     .standard = "0", .used = FOR_DYNAMIC, .help = "longest step, 0 = no limit"},
    {NAME("solver", "lookup"), CHOICE("off on"), INTO(lookup),
     .standard = "off", .used = FOR_DYNAMIC | FOR_3D,
     .help = "on: approximate mesh from tables for long runs, error of some 0.1 %"},
    {NAME("solver", "lookup_depth_um"), NUMBER(UNIT_UM, AT_LEAST(1e-3)), INTO(lookup_depth),
     .standard = "20", .used = FOR_DYNAMIC | FOR_3D,
     .help = "penetration up to which the tables reach, exact beyond"},

    {NAME("output", "file"), .kind = KEY_PATH, INTO(output_file),
     .derived = "name of the INI file, .csv", .help = "result; HDF5 if it ends in .h5 or .hdf5"},
    {NAME("output", "rate_Hz"), NUMBER(UNIT_SI, ABOVE_ZERO), INTO(output_rate),
     .standard = "25600", .used = FOR_DYNAMIC, .help = "rows per simulated second"},
    {NAME("output", "oversampling"), COUNT(1, 64), INTO(oversampling),
     .standard = "4", .used = FOR_DYNAMIC, .help = "samples per row, low-pass filtered; 1 = plain samples"},
    {NAME("output", "digits"), COUNT(3, 17), INTO(digits),
     .standard = "10", .help = "significant digits in CSV"},
    {NAME("output", "columns"), .kind = KEY_TEXT, INTO(columns),
     .standard = "all", .help = "names separated by commas"},
};
/* clang-format on */

const int key_count = (int)(sizeof keys / sizeof keys[0]);

/* ---------------------------------------------------------------------------------------------
 * Names
 * ------------------------------------------------------------------------------------------- */

int key_find(const char *section, const char *name) {
    for (int i = 0; i < key_count; ++i)
        if (strcmp(keys[i].section, section) == 0 && strcmp(keys[i].name, name) == 0)
            return i;
    return -1;
}

int key_section_exists(const char *section) {
    for (int i = 0; i < key_count; ++i)
        if (strcmp(keys[i].section, section) == 0)
            return 1;
    return 0;
}

enum { NAME_SIZE = 64, UNLIKE = 1000 };

static int lower(char c) {
    return tolower((unsigned char)c);
}

static size_t smaller(size_t a, size_t b) {
    return a < b ? a : b;
}

/* Levenshtein distance without regard to case: letters to change, add or drop. */
static size_t edit_distance(const char *a, const char *b) {
    const size_t width = strlen(b);
    size_t row[NAME_SIZE];

    for (size_t j = 0; j <= width; ++j)
        row[j] = j;
    for (size_t i = 0; a[i] != '\0'; ++i) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < width; ++j) {
            const size_t changed = diagonal + (lower(a[i]) != lower(b[j]));
            diagonal = row[j + 1];
            row[j + 1] = smaller(changed, 1 + smaller(row[j], row[j + 1]));
        }
    }
    return row[width];
}

/* How unlike two names are: UNLIKE = too much to guess one from the other. */
static size_t unlikeness(const char *given, const char *known) {
    const size_t length = strlen(given);
    size_t distance;

    if (length == 0 || length >= NAME_SIZE)
        return UNLIKE;
    distance = edit_distance(given, known);
    if (distance <= 1 + length / 4)
        return distance;
    return length >= 4 && strstr(known, given) != NULL ? distance : UNLIKE;
}

const char *key_section_near(const char *section) {
    const char *near = NULL;
    size_t least = UNLIKE;

    for (int i = 0; i < key_count; ++i) {
        const size_t distance = unlikeness(section, keys[i].section);
        if (distance < least) {
            least = distance;
            near = keys[i].section;
        }
    }
    return near;
}

int key_near(const char *section, const char *name) {
    int near = -1;
    size_t least = UNLIKE;

    for (int i = 0; i < key_count; ++i) {
        /* A key of another section is the better guess only if its name is more alike. */
        const int elsewhere = strcmp(keys[i].section, section) != 0;
        const size_t distance = 2 * unlikeness(name, keys[i].name) + (elsewhere ? 1 : 0);
        if (distance < least) {
            least = distance;
            near = i;
        }
    }
    return near;
}

/* ---------------------------------------------------------------------------------------------
 * Values
 * ------------------------------------------------------------------------------------------- */

static const struct {
    double divisor, factor;
} units[] = {
    [UNIT_SI] = {1, 1},
    [UNIT_MM] = {1e3, 1},
    [UNIT_MM_DIAMETER] = {2e3, 1},
    [UNIT_UM] = {1e6, 1},
    [UNIT_DEG] = {180, 3.14159265358979323846},
    [UNIT_RPM] = {30, 3.14159265358979323846},
};

void *allocate(size_t size) {
    void *memory = calloc(1, size);

    if (memory == NULL) {
        fputs("gearsim: out of memory\n", stderr);
        exit(EXIT_RUN_FAILED);
    }
    return memory;
}

char *copy_text(const char *text) {
    const size_t size = strlen(text) + 1;

    return memcpy(allocate(size), text, size);
}

static const char *skip_digits(const char *text) {
    while (*text >= '0' && *text <= '9')
        ++text;
    return text;
}

/* [+-] digits [. digits] [e [+-] digits]: what strtod() takes beyond that (hex, nan, inf) is refused. */
static int is_plain_number(const char *text) {
    const char *start = text + (*text == '+' || *text == '-');
    const char *end = skip_digits(start);
    long digits = end - start;

    if (*end == '.') {
        const char *fraction = end + 1;
        end = skip_digits(fraction);
        digits += end - fraction;
    }
    if (digits == 0)
        return 0;
    if (*end == 'e' || *end == 'E') {
        const char *exponent = end + 1;
        exponent += *exponent == '+' || *exponent == '-';
        end = skip_digits(exponent);
        if (end == exponent)
            return 0;
    }
    return *end == '\0';
}

static int not_a_number(const char *text, char *fault) {
    const char *advice = strchr(text, ',') != NULL
                             ? "write it with a decimal point and without separators"
                             : "write it as in 12, -0.5 or 1e-4, nothing behind it";
    snprintf(fault, KEY_FAULT_SIZE, "not a number (got %.80s), %s", text, advice);
    return 1;
}

static int read_number(const char *text, double *value, char *fault) {
    if (!is_plain_number(text))
        return not_a_number(text, fault);
    *value = strtod(text, NULL);
    if (isfinite(*value))
        return 0;
    snprintf(fault, KEY_FAULT_SIZE, "too large for a number (got %.80s), must be below 1.8e308",
             text);
    return 1;
}

/* "> 0", ">= 0", "between 0 and 45 (both excluded)", "from 0 to 1" */
static void describe_range(const key_range *range, char *text, size_t size) {
    if (isfinite(range->low) && isfinite(range->high))
        snprintf(text, size,
                 range->open_low ? "between %.9g and %.9g, both excluded" : "from %.9g to %.9g",
                 range->low, range->high);
    else if (isfinite(range->low))
        snprintf(text, size, "%s %.9g", range->open_low ? ">" : ">=", range->low);
    else
        snprintf(text, size, "finite");
}

static int check_range(const key_range *range, double value, const char *text, char *fault) {
    const int low = range->open_low ? value <= range->low : value < range->low;
    const int high = range->open_high ? value >= range->high : value > range->high;
    char requirement[80];

    if (!low && !high)
        return 0;
    describe_range(range, requirement, sizeof requirement);
    snprintf(fault, KEY_FAULT_SIZE, "out of range (got %.80s), must be %s", text, requirement);
    return 1;
}

static int assign_number(const key_spec *key, double *target, const char *text, char *fault) {
    double value;

    if (read_number(text, &value, fault) || check_range(&key->range, value, text, fault))
        return 1;
    *target = value / units[key->unit].divisor * units[key->unit].factor;
    return 0;
}

static int assign_count(const key_spec *key, int *target, const char *text, char *fault) {
    double value;

    if (read_number(text, &value, fault))
        return 1;
    if (check_range(&key->range, value, text, fault))
        return 1;
    if (value != floor(value)) {
        snprintf(fault, KEY_FAULT_SIZE, "not a whole number (got %.80s), must be one", text);
        return 1;
    }
    *target = (int)value;
    return 0;
}

static int assign_seed(uint64_t *target, const char *text, char *fault) {
    unsigned long long value = 0;
    int too_large = 0;

    if (*text != '\0' && *skip_digits(text) == '\0') {
        errno = 0;
        value = strtoull(text, NULL, 10);
        too_large = errno == ERANGE || value > UINT64_MAX;
        if (!too_large) {
            *target = (uint64_t)value;
            return 0;
        }
    }
    snprintf(fault, KEY_FAULT_SIZE,
             "%s (got %.80s), must be a whole number from 0 to 18446744073709551615",
             too_large ? "too large" : "not a seed", text);
    return 1;
}

/* Position of a name in a list separated by blanks, or -1. */
static int position_in(const char *names, const char *name) {
    const size_t length = strlen(name);

    for (int position = 0;; ++position) {
        const size_t span = strcspn(names, " ");
        if (span == length && strncmp(names, name, span) == 0)
            return position;
        if (names[span] == '\0')
            return -1;
        names += span + 1;
    }
}

/* "iso | paper" from "iso paper" */
static void print_choices(const char *names, char *text, size_t size) {
    size_t length = 0;

    for (; *names != '\0' && length + 4 < size; ++names) {
        if (*names == ' ') {
            memcpy(text + length, " | ", 3);
            length += 3;
        } else {
            text[length++] = *names;
        }
    }
    text[length] = '\0';
}

/* Enumerations of config are as wide as an int on every platform with POSIX. */
static int assign_choice(const key_spec *key, void *target, const char *text, char *fault) {
    const int position = position_in(key->choices, text);
    char choices[80];

    if (position >= 0) {
        memcpy(target, &position, sizeof position);
        return 0;
    }
    print_choices(key->choices, choices, sizeof choices);
    snprintf(fault, KEY_FAULT_SIZE, "unknown choice (got %.80s), must be %s", text, choices);
    return 1;
}

/* NULL where all that exists is meant. */
static int assign_text(char **target, const char *text) {
    free(*target);
    *target = strcmp(text, "all") == 0 ? NULL : copy_text(text);
    return 0;
}

int key_assign(const key_spec *key, config *conf, const char *text, char fault[KEY_FAULT_SIZE]) {
    void *target = (char *)conf + key->target;

    switch (key->kind) {
    case KEY_NUMBER:
        return assign_number(key, target, text, fault);
    case KEY_COUNT:
        return assign_count(key, target, text, fault);
    case KEY_SEED:
        return assign_seed(target, text, fault);
    case KEY_CHOICE:
        return assign_choice(key, target, text, fault);
    case KEY_TEXT:
        return assign_text(target, text);
    case KEY_PATH:
        break;
    }
    free(*(char **)target);
    *(char **)target = copy_text(text);
    return 0;
}

void key_assign_defaults(config *conf) {
    char fault[KEY_FAULT_SIZE];

    gm_pair_params_default(&conf->gears);
    for (int i = 0; i < key_count; ++i) {
        if (keys[i].standard != NULL)
            (void)key_assign(&keys[i], conf, keys[i].standard, fault);
        else if (keys[i].kind == KEY_NUMBER)
            *(double *)(void *)((char *)conf + keys[i].target) = (double)NAN;
        else if (keys[i].kind == KEY_CHOICE)
            *(int *)(void *)((char *)conf + keys[i].target) = -1;
    }
}

/* ---------------------------------------------------------------------------------------------
 * Situations
 * ------------------------------------------------------------------------------------------- */

static unsigned situation_of(const config *conf) {
    return (unsigned)(conf->model == MODEL_3D ? FOR_3D : FOR_SIMPLE) |
           (unsigned)(conf->drive == DRIVE_SPEED ? FOR_SPEED : FOR_TORQUE) |
           (unsigned)(conf->analysis == ANALYSIS_DYNAMIC ? FOR_DYNAMIC : FOR_STATIC);
}

int key_is_used(const key_spec *key, const config *conf, const char **reason) {
    const unsigned lacking = key->used & ~situation_of(conf);

    if (lacking & (FOR_DYNAMIC | FOR_STATIC))
        *reason = conf->analysis == ANALYSIS_DYNAMIC ? "analysis.type = dynamic"
                                                     : "analysis.type = static";
    else if (lacking & (FOR_SPEED | FOR_TORQUE))
        *reason = conf->drive == DRIVE_SPEED ? "drive.kind = speed" : "drive.kind = torque";
    else if (lacking)
        *reason = conf->model == MODEL_3D ? "mesh.model = 3d" : "mesh.model = simple";
    return lacking == 0;
}

int key_is_required(const key_spec *key, const config *conf) {
    const unsigned purposes = conf->purpose == CONFIG_FOR_RUN ? FOR_ALL | FOR_RUN : FOR_ALL;

    return key->required != 0 && (key->required & ~(situation_of(conf) | purposes)) == 0;
}

/* ---------------------------------------------------------------------------------------------
 * Help
 * ------------------------------------------------------------------------------------------- */

/* "= a | b", "> 0", "from 3 to 17": what may stand behind the key. */
static void describe_values(const key_spec *key, char *text, size_t size) {
    *text = '\0';
    if (key->kind == KEY_CHOICE)
        print_choices(key->choices, text, size);
    else if (key->kind == KEY_SEED)
        snprintf(text, size, "whole number");
    else if (key->kind == KEY_COUNT || (key->kind == KEY_NUMBER && isfinite(key->range.low)))
        describe_range(&key->range, text, size);
}

/* When the file must have the key, or NULL. */
static const char *describe_need(const key_spec *key) {
    if (key->required & FOR_SPEED)
        return "required for kind = speed";
    if (key->required & FOR_TORQUE)
        return "required for kind = torque";
    if (key->required & FOR_DYNAMIC)
        return "required for a dynamic run";
    if (key->required & FOR_RUN)
        return "required for a run";
    return key->required ? "required" : NULL;
}

static void print_key(const key_spec *key, FILE *stream) {
    const char *standard = key->standard != NULL ? key->standard : key->derived;
    const char *need = describe_need(key);
    char values[80];

    describe_values(key, values, sizeof values);
    fprintf(stream, "  %-25s ", key->family != NULL ? key->family : key->name);
    if (standard != NULL)
        fprintf(stream, "[%s] ", standard);
    fputs(key->help, stream);
    if (*values != '\0')
        fprintf(stream, "; %s", values);
    if (need != NULL)
        fprintf(stream, "; %s", need);
    fputc('\n', stream);
}

void keys_print(FILE *stream) {
    for (int i = 0; i < key_count; ++i) {
        if (i == 0 || strcmp(keys[i].section, keys[i - 1].section) != 0)
            fprintf(stream, "[%s]\n", keys[i].section);
        if (keys[i].family != NULL && keys[i - 1].family == NULL)
            fputs(modification_legend, stream);
        if (keys[i].family_member == 0)
            print_key(&keys[i], stream);
    }
}
