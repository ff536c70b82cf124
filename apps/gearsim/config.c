/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From INI file and command line to a checked config: each value by itself as it is met (keys.c knows
 * how), then what is missing, then what must fit together. All faults of a stage are told before the run
 * is refused, so that a user need not find them one by one.
 */
#include "config.h"
#include "ini_file.h"
#include "keys.h"
#include "modification_keys.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum {
    FAULT_LIMIT = 20, /* of faults told: the wrong kind of file would give thousands */
    NAME_SIZE = 128   /* "section.key" of any key */
};

/* More rows than anybody can read, and noise values beyond which a double cannot count them. */
static const double row_limit = 1e9;
static const double noise_limit = 1e15;

typedef struct loading {
    config *conf;
    int faults;
    const char *section;  /* of the lines that follow, NULL = unknown or none yet */
    int in_section;       /* after the first section line */
    int *section_lines;   /* [key_count] where the section that begins with this key was met */
    enum key_origin from; /* where values come from now */
    int line;
} loading;

/* ---------------------------------------------------------------------------------------------
 * Messages
 * ------------------------------------------------------------------------------------------- */

static void print_place(const config *conf, enum key_origin origin, int line) {
    if (origin == ORIGIN_SET)
        fputs("--set ", stderr);
    else if (origin == ORIGIN_OUTPUT_OPTION)
        fputs("--output: ", stderr);
    else if (line > 0)
        fprintf(stderr, "%s:%d: ", conf->path, line);
    else
        fprintf(stderr, "%s: ", conf->path);
}

/* Tells a fault in what is being read: place, name (may be empty), text. */
static void fault(loading *load, const char *name, const char *format, ...) {
    va_list arguments;

    if (++load->faults > FAULT_LIMIT)
        return;
    print_place(load->conf, load->from, load->line);
    if (*name != '\0')
        fprintf(stderr, "%s: ", name);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    if (load->faults == FAULT_LIMIT)
        fprintf(stderr, "%s: further faults are not told\n", load->conf->path);
}

/* Index of "section.key", or -1. */
static int find_full_name(const char *section_and_key) {
    const char *dot = strchr(section_and_key, '.');
    char section[NAME_SIZE];
    size_t length;

    if (dot == NULL || (length = (size_t)(dot - section_and_key)) >= sizeof section)
        return -1;
    memcpy(section, section_and_key, length);
    section[length] = '\0';
    return key_find(section, dot + 1);
}

static void tell(const config *conf, const char *section_and_key, const char *kind,
                 const char *format, va_list arguments) {
    const int index = find_full_name(section_and_key);

    if (index >= 0)
        print_place(conf, conf->entries[index].origin, conf->entries[index].line);
    else
        print_place(conf, ORIGIN_DEFAULT, 0);
    fprintf(stderr, "%s: %s", section_and_key, kind);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
}

void config_complain(const config *conf, const char *section_and_key, const char *format, ...) {
    va_list arguments;

    va_start(arguments, format);
    tell(conf, section_and_key, "", format, arguments);
    va_end(arguments);
}

void config_warn(const config *conf, const char *section_and_key, const char *format, ...) {
    va_list arguments;

    if (conf->quiet)
        return;
    va_start(arguments, format);
    tell(conf, section_and_key, "warning: ", format, arguments);
    va_end(arguments);
}

const char *config_key_of_field(const char *field) {
    static const char *const unknown = "gears";

    for (int i = 0; i < key_count; ++i)
        if (keys[i].field != NULL && strcmp(keys[i].field, field) == 0)
            return keys[i].full_name;
    return unknown;
}

const char *config_text(const config *conf, const char *section_and_key) {
    const int index = find_full_name(section_and_key);

    return index < 0 ? NULL : conf->entries[index].text;
}

/* ---------------------------------------------------------------------------------------------
 * Values
 * ------------------------------------------------------------------------------------------- */

/* `name` as seen from the folder of `path`. */
static char *path_beside(const char *path, const char *name) {
    const char *slash = strrchr(path, '/');
    const size_t folder = slash == NULL || *name == '/' ? 0 : (size_t)(slash - path) + 1;
    char *joined = allocate(folder + strlen(name) + 1);

    memcpy(joined, path, folder);
    memcpy(joined + folder, name, strlen(name) + 1);
    return joined;
}

static int assign(loading *load, const key_spec *key, const char *value, char *text) {
    int result;
    char *path;

    if (key->kind != KEY_PATH || load->from != ORIGIN_FILE)
        return key_assign(key, load->conf, value, text);
    path = path_beside(load->conf->path, value);
    result = key_assign(key, load->conf, path, text);
    free(path);
    return result;
}

static void set_value(loading *load, int index, const char *value) {
    key_entry *entry = &load->conf->entries[index];
    char text[KEY_FAULT_SIZE];

    free(entry->text);
    entry->text = copy_text(value);
    entry->origin = load->from;
    entry->line = load->line;
    if (*value == '\0')
        fault(load, keys[index].full_name,
              "no value, expected one behind the `=`, or leave the key out");
    else if (assign(load, &keys[index], value, text))
        fault(load, keys[index].full_name, "%s", text);
}

/* ---------------------------------------------------------------------------------------------
 * The INI file
 * ------------------------------------------------------------------------------------------- */

static void unknown_section(loading *load, const char *section) {
    const char *near = key_section_near(section);

    if (near != NULL)
        fault(load, "", "[%.80s]: unknown section, did you mean [%s]?", section, near);
    else
        fault(load, "", "[%.80s]: unknown section, `gearsim --help` lists all", section);
}

static void unknown_key(loading *load, const char *section, const char *name) {
    const int near = key_near(section, name);
    char full_name[NAME_SIZE];

    snprintf(full_name, sizeof full_name, "%.40s.%.80s", section, name);
    if (near < 0)
        fault(load, full_name, "unknown key, `gearsim --help` lists all");
    else if (strcmp(keys[near].section, section) == 0)
        fault(load, full_name, "unknown key, did you mean %s?", keys[near].name);
    else
        fault(load, full_name, "unknown key of [%s], did you mean %s of [%s]?", section,
              keys[near].name, keys[near].section);
}

static int first_key_of(const char *section) {
    int index = 0;

    while (strcmp(keys[index].section, section) != 0)
        ++index;
    return index;
}

static void meet_section(void *user, int line, const char *section) {
    loading *load = user;
    int index;

    load->line = line;
    load->in_section = 1;
    load->section = NULL;
    if (!key_section_exists(section)) {
        unknown_section(load, section);
        return;
    }
    index = first_key_of(section);
    if (load->section_lines[index] > 0)
        fault(load, "", "[%s]: repeated section, first in line %d: put all its keys there", section,
              load->section_lines[index]);
    else
        load->section_lines[index] = line;
    load->section = keys[index].section;
}

static void meet_value(void *user, int line, const char *name, const char *value) {
    loading *load = user;
    int index;

    load->line = line;
    if (load->section == NULL) {
        /* The keys of an unknown section are passed over: the section is the fault. */
        if (!load->in_section)
            fault(load, "", "%.80s: a key without a section, expected `[section]` before it", name);
        return;
    }
    index = key_find(load->section, name);
    if (index < 0)
        unknown_key(load, load->section, name);
    else if (load->conf->entries[index].text != NULL)
        fault(load, keys[index].full_name, "repeated key, first in line %d: give it once",
              load->conf->entries[index].line);
    else
        set_value(load, index, value);
}

static void meet_fault(void *user, int line, const char *text) {
    loading *load = user;

    load->line = line;
    fault(load, "", "%s", text);
}

static void read_file(loading *load) {
    const ini_events events = {load, meet_section, meet_value, meet_fault};

    load->from = ORIGIN_FILE;
    ini_file_read(load->conf->path, &events);
    load->line = 0;
}

/* ---------------------------------------------------------------------------------------------
 * The command line
 * ------------------------------------------------------------------------------------------- */

/* Cuts white space off both ends, in place. */
static char *trim(char *text) {
    char *end = text + strlen(text);

    while (end > text && (end[-1] == ' ' || end[-1] == '\t'))
        *--end = '\0';
    return text + strspn(text, " \t");
}

/* Values end up in the head of the result, a line each. */
static int has_control_character(const char *text) {
    for (; *text != '\0'; ++text)
        if ((unsigned char)*text < ' ' && *text != '\t')
            return 1;
    return 0;
}

static void set_override(loading *load, char *section, char *name, char *value) {
    const int index = key_find(section, name);

    if (index >= 0)
        set_value(load, index, value);
    else if (key_section_exists(section))
        unknown_key(load, section, name);
    else
        unknown_section(load, section);
}

static void read_override(loading *load, const char *override) {
    char *text = copy_text(override);
    char *equals = strchr(text, '=');
    char *dot = strchr(text, '.');

    if (has_control_character(text)) {
        fault(load, "", "a control character, expected plain text");
    } else if (equals == NULL || dot == NULL || dot > equals) {
        fault(load, "", "%.80s: not understood, expected section.key=value", override);
    } else {
        *equals = '\0';
        *dot = '\0';
        set_override(load, trim(text), trim(dot + 1), trim(equals + 1));
    }
    free(text);
}

static void read_command_line(loading *load, const config_request *request) {
    load->line = 0;
    load->from = ORIGIN_SET;
    for (int i = 0; i < request->override_count; ++i)
        read_override(load, request->overrides[i]);

    load->from = ORIGIN_OUTPUT_OPTION;
    if (request->output_file == NULL)
        return;
    if (has_control_character(request->output_file))
        fault(load, "", "a control character in the name of the output file, expected plain text");
    else
        set_value(load, find_full_name("output.file"), request->output_file);
}

/* ---------------------------------------------------------------------------------------------
 * What is missing, what must fit together
 * ------------------------------------------------------------------------------------------- */

static const char *condition_of(const key_spec *key, const config *conf) {
    if (key->required & (FOR_SPEED | FOR_TORQUE))
        return conf->drive == DRIVE_SPEED ? " for drive.kind = speed" : " for drive.kind = torque";
    if (key->required & FOR_DYNAMIC)
        return " for a dynamic run";
    return key->required & FOR_RUN ? " for a run" : "";
}

static int check_missing(const config *conf) {
    int faults = 0;

    for (int i = 0; i < key_count; ++i) {
        if (conf->entries[i].text != NULL || !key_is_required(&keys[i], conf))
            continue;
        config_complain(conf, keys[i].full_name, "missing, but required%s: add %s to [%s]",
                        condition_of(&keys[i], conf), keys[i].name, keys[i].section);
        ++faults;
    }
    return faults;
}

static int check_profile_window(const config *conf) {
    if (conf->profile_from < conf->profile_to)
        return 0;
    config_complain(conf, "flanks.profile_from",
                    "must be smaller than flanks.profile_to (got %.9g and %.9g)",
                    conf->profile_from, conf->profile_to);
    return 1;
}

static int check_static(const config *conf) {
    int faults = 0;

    if (conf->model != MODEL_3D) {
        config_complain(conf, "mesh.model",
                        "no model for a static analysis (got simple), must be 3d");
        ++faults;
    }
    if (conf->mean_load == 0) {
        config_complain(conf, "load.mean_Nm",
                        "no load (got 0) leaves a static analysis undetermined within the "
                        "backlash, must not be 0");
        ++faults;
    }
    return faults;
}

static int check_dynamic(const config *conf) {
    int faults = 0;

    if (!(conf->duration * conf->output_rate <= row_limit)) {
        config_complain(conf, "output.rate_Hz",
                        "gives too many rows (got %.9g in %.9g s), at most %.9g are written: lower "
                        "it or analysis.duration_s",
                        conf->output_rate, conf->duration, row_limit);
        ++faults;
    }
    if (!(conf->duration / conf->noise_interval <= noise_limit)) {
        config_complain(conf, "load.noise_interval_s",
                        "too short (got %.9g), must be at least %.9g of analysis.duration_s",
                        conf->noise_interval, 1 / noise_limit);
        ++faults;
    }
    return faults;
}

static int is_same_file(const char *a, const char *b) {
    struct stat status_a, status_b;

    if (strcmp(a, b) == 0)
        return 1;
    return stat(a, &status_a) == 0 && stat(b, &status_b) == 0 &&
           status_a.st_dev == status_b.st_dev && status_a.st_ino == status_b.st_ino;
}

static int check_not_input(const config *conf, const char *output, const char *input,
                           const char *name) {
    if (input == NULL || !is_same_file(output, input))
        return 0;
    config_complain(conf, "output.file",
                    "would overwrite an input (got %s, which is %s), give another name", output,
                    name);
    return 1;
}

/* Neither the result nor the file that it grows in may be one that is read. */
static int check_output_is_no_input(const config *conf) {
    const size_t size = strlen(conf->output_file) + sizeof ".part";
    char *part = allocate(size);
    int faults = 0;

    snprintf(part, size, "%s.part", conf->output_file);
    for (int i = 0; i < 2 && faults == 0; ++i) {
        const char *output = i == 0 ? conf->output_file : part;
        faults += check_not_input(conf, output, conf->path, "the INI file");
        faults += check_not_input(conf, output, conf->pinion_flanks.deviations, "flanks.pinion");
        faults += check_not_input(conf, output, conf->wheel_flanks.deviations, "flanks.wheel");
        faults += check_not_input(conf, output, conf->pinion_flanks.pitch, "flanks.pinion_pitch");
        faults += check_not_input(conf, output, conf->wheel_flanks.pitch, "flanks.wheel_pitch");
    }
    free(part);
    return faults;
}

static int check_together(const config *conf) {
    int faults = check_profile_window(conf);

    if (conf->purpose == CONFIG_FOR_GEOMETRY)
        return faults;
    if (conf->model == MODEL_3D)
        faults += modification_keys_check(conf);
    faults += conf->analysis == ANALYSIS_STATIC ? check_static(conf) : check_dynamic(conf);
    return faults + check_output_is_no_input(conf);
}

static void warn_of_unused(const config *conf) {
    const char *reason;

    for (int i = 0; i < key_count; ++i)
        if (conf->entries[i].text != NULL && !key_is_used(&keys[i], conf, &reason))
            config_warn(conf, keys[i].full_name, "not used with %s", reason);
    if (conf->model == MODEL_3D)
        modification_keys_warn(conf);
}

/* ---------------------------------------------------------------------------------------------
 * The whole
 * ------------------------------------------------------------------------------------------- */

/* "folder/run.ini" gives "run.csv". */
static char *default_output_file(const char *path) {
    const char *slash = strrchr(path, '/');
    const char *name = slash == NULL ? path : slash + 1;
    const char *dot = strrchr(name, '.');
    const size_t length = dot == NULL || dot == name ? strlen(name) : (size_t)(dot - name);
    char *file = allocate(length + sizeof ".csv");

    memcpy(file, name, length);
    memcpy(file + length, ".csv", sizeof ".csv");
    return file;
}

/* The text in effect, NULL where the value is derived from others. */
static const char *effective_text(const config *conf, int index) {
    if (conf->entries[index].text != NULL)
        return conf->entries[index].text;
    if (strcmp(keys[index].full_name, "output.file") == 0)
        return conf->output_file;
    return keys[index].standard;
}

static void add_provenance(config *conf, const char *name, const char *text) {
    const size_t size = strlen(name) + sizeof " = " + strlen(text);

    conf->provenance[conf->provenance_count] = allocate(size);
    snprintf(conf->provenance[conf->provenance_count++], size, "%s = %s", name, text);
}

static void record_provenance(config *conf) {
    const char *reason;

    conf->provenance = allocate((size_t)(key_count + PROVENANCE_NOTES) * sizeof *conf->provenance);
    for (int i = 0; i < key_count; ++i) {
        const char *text = effective_text(conf, i);

        if (text != NULL && key_is_used(&keys[i], conf, &reason))
            add_provenance(conf, keys[i].full_name, text);
    }
}

void config_note(config *conf, const char *name, double value) {
    char text[32];

    snprintf(text, sizeof text, "%.9g", value);
    add_provenance(conf, name, text);
}

static void start(config *conf, const config_request *request) {
    memset(conf, 0, sizeof *conf);
    conf->path = copy_text(request->path);
    conf->quiet = request->quiet;
    conf->purpose = request->purpose;
    conf->entries = allocate((size_t)key_count * sizeof *conf->entries);
    modification_keys_clear(conf);
    key_assign_defaults(conf);
}

int config_load(config *conf, const config_request *request) {
    loading load = {.conf = conf};

    start(conf, request);
    load.section_lines = allocate((size_t)key_count * sizeof *load.section_lines);
    read_file(&load);
    read_command_line(&load, request);
    free(load.section_lines);

    if (conf->output_file == NULL)
        conf->output_file = default_output_file(conf->path);
    if (load.faults == 0)
        load.faults = check_missing(conf);
    if (load.faults == 0)
        load.faults = check_together(conf);
    if (load.faults > 0) {
        config_free(conf);
        return EXIT_BAD_INPUT;
    }
    warn_of_unused(conf);
    record_provenance(conf);
    return 0;
}

static void free_flank_files(flank_files *files) {
    free(files->deviations);
    free(files->pitch);
}

void config_free(config *conf) {
    for (int i = 0; i < conf->provenance_count; ++i)
        free(conf->provenance[i]);
    free(conf->provenance);
    for (int i = 0; conf->entries != NULL && i < key_count; ++i)
        free(conf->entries[i].text);
    free(conf->entries);
    free_flank_files(&conf->pinion_flanks);
    free_flank_files(&conf->wheel_flanks);
    free(conf->output_file);
    free(conf->columns);
    free(conf->path);
    memset(conf, 0, sizeof *conf);
}
