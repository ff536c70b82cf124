/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From INI file and command line to a checked config: each value by itself as it is met (key_reader.c),
 * then what is missing, then what must fit together. All faults of a stage are told before the run is refused, so
 * that a user need not find them one by one.
 */
#include "config.h"
#include "key_reader.h"
#include "keys.h"
#include "modification_keys.h"
#include "paths.h"
#include "result_file.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_SIZE = 128 }; /* "section.key" of any key */

/* More rows than anybody can read, and noise values beyond which a double cannot count them. */
static const double row_limit = 1e9;
static const double noise_limit = 1e15;

/* ---------------------------------------------------------------------------------------------
 * Messages
 * ------------------------------------------------------------------------------------------- */

static void print_place(const config *conf, enum key_origin origin, int line) {
    key_print_place(conf->path, origin, line);
}

static const key_spec *key_at(int index) {
    return &gearsim_keys.keys[index];
}

/* Index of "section.key", or -1. */
static int find_full_name(const char *section_and_key) {
    const char *dot = strchr(section_and_key, '.');
    char section[NAME_SIZE];
    size_t length;

    if (dot == NULL || (length = (size_t)(dot - section_and_key)) >= sizeof section) {
        return -1;
    }
    memcpy(section, section_and_key, length);
    section[length] = '\0';
    return key_find(&gearsim_keys, section, dot + 1);
}

static void tell(const config *conf, const char *section_and_key, const char *kind,
                 const char *format, va_list arguments) {
    const int index = find_full_name(section_and_key);

    if (index >= 0) {
        print_place(conf, conf->entries[index].origin, conf->entries[index].line);
    } else {
        print_place(conf, ORIGIN_DEFAULT, 0);
    }
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

    if (conf->quiet) {
        return;
    }
    va_start(arguments, format);
    tell(conf, section_and_key, "warning: ", format, arguments);
    va_end(arguments);
}

const char *config_key_of_field(const char *field) {
    static const char *const unknown = "gears";

    for (int i = 0; i < gearsim_keys.count; ++i) {
        if (key_at(i)->field != NULL && strcmp(key_at(i)->field, field) == 0) {
            return key_at(i)->full_name;
        }
    }
    return unknown;
}

const char *config_text(const config *conf, const char *section_and_key) {
    const int index = find_full_name(section_and_key);

    return index < 0 ? NULL : conf->entries[index].text;
}

/* ---------------------------------------------------------------------------------------------
 * The command line
 * ------------------------------------------------------------------------------------------- */

/* Cuts white space off both ends, in place. */
static char *trim(char *text) {
    char *end = text + strlen(text);

    while (end > text && (end[-1] == ' ' || end[-1] == '\t')) {
        *--end = '\0';
    }
    return text + strspn(text, " \t");
}

/* Values end up in the head of the result, a line each. */
static int has_control_character(const char *text) {
    for (; *text != '\0'; ++text) {
        if ((unsigned char)*text < ' ' && *text != '\t') {
            return 1;
        }
    }
    return 0;
}

static void read_override(key_reader *reader, const char *override) {
    char *text = copy_text(override);
    char *equals = strchr(text, '=');
    char *dot = strchr(text, '.');

    if (has_control_character(text)) {
        key_reader_fault(reader, "", "a control character, expected plain text");
    } else if (equals == NULL || dot == NULL || dot > equals) {
        key_reader_fault(reader, "", "%.80s: not understood, expected section.key=value", override);
    } else {
        *equals = '\0';
        *dot = '\0';
        key_reader_set(reader, trim(text), trim(dot + 1), trim(equals + 1));
    }
    free(text);
}

static void read_command_line(key_reader *reader, const config_request *request) {
    reader->line = 0;
    reader->from = ORIGIN_SET;
    for (int i = 0; i < request->override_count; ++i) {
        read_override(reader, request->overrides[i]);
    }

    reader->from = ORIGIN_OUTPUT_OPTION;
    if (request->output_file == NULL) {
        return;
    }
    if (has_control_character(request->output_file)) {
        key_reader_fault(reader, "",
                         "a control character in the name of the output file, expected plain text");
    } else {
        key_reader_set(reader, "output", "file", request->output_file);
    }
}

/* ---------------------------------------------------------------------------------------------
 * What is missing, what must fit together
 * ------------------------------------------------------------------------------------------- */

static const char *condition_of(const key_spec *key, const config *conf) {
    if (key->required & (FOR_SPEED | FOR_TORQUE)) {
        return conf->drive == DRIVE_SPEED ? " for drive.kind = speed" : " for drive.kind = torque";
    }
    if (key->required & FOR_DYNAMIC) {
        return " for a dynamic run";
    }
    return key->required & FOR_RUN ? " for a run" : "";
}

static int check_missing(const config *conf) {
    int faults = 0;

    for (int i = 0; i < gearsim_keys.count; ++i) {
        if (conf->entries[i].text != NULL || !key_is_required(key_at(i), conf)) {
            continue;
        }
        config_complain(conf, key_at(i)->full_name, "missing, but required%s: add %s to [%s]",
                        condition_of(key_at(i), conf), key_at(i)->name, key_at(i)->section);
        ++faults;
    }
    return faults;
}

static int check_profile_window(const config *conf) {
    if (conf->profile_from < conf->profile_to) {
        return 0;
    }
    config_complain(conf, "flanks.profile_from",
                    "must be smaller than flanks.profile_to (got %.9g and %.9g)",
                    conf->profile_from, conf->profile_to);
    return 1;
}

/* The loads of a static analysis must not pass zero. */
static int check_loads(const config *conf) {
    const double rows = (double)conf->loads * conf->positions;

    if (!(rows <= row_limit)) {
        config_complain(conf, "analysis.loads",
                        "gives too many rows (got %d with %d positions), at most %.9g are written",
                        conf->loads, conf->positions, row_limit);
        return 1;
    }
    if (conf->loads > 1 && !(conf->mean_load * conf->end_load > 0)) {
        config_complain(conf, isnan(conf->end_load) ? "analysis.loads" : "load.end_Nm",
                        "several loads need load.end_Nm, with the sign of load.mean_Nm");
        return 1;
    }
    return 0;
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
    return faults + check_loads(conf);
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

static int check_not_input(const config *conf, const char *input, const char *name) {
    if (input == NULL || !result_file_would_replace(conf->output_file, input)) {
        return 0;
    }
    config_complain(
        conf, "output.file", "would overwrite an input (got %s%s, which is %s), give another name",
        conf->output_file, is_same_place(conf->output_file, input) ? "" : ".part", name);
    return 1;
}

/* Neither the result nor the file that it grows in may be one that is read. */
static int check_output_is_no_input(const config *conf) {
    return check_not_input(conf, conf->path, "the INI file") +
           check_not_input(conf, conf->pinion_flanks.deviations, "flanks.pinion") +
           check_not_input(conf, conf->wheel_flanks.deviations, "flanks.wheel") +
           check_not_input(conf, conf->pinion_flanks.pitch, "flanks.pinion_pitch") +
           check_not_input(conf, conf->wheel_flanks.pitch, "flanks.wheel_pitch");
}

static int check_together(const config *conf) {
    int faults = check_profile_window(conf);

    if (conf->purpose == CONFIG_FOR_GEOMETRY) {
        return faults;
    }
    if (conf->model == MODEL_3D) {
        faults += modification_keys_check(conf);
    }
    faults += conf->analysis == ANALYSIS_STATIC ? check_static(conf) : check_dynamic(conf);
    return faults + check_output_is_no_input(conf);
}

static void warn_of_unused(const config *conf) {
    const char *reason;

    for (int i = 0; i < gearsim_keys.count; ++i) {
        if (conf->entries[i].text != NULL && !key_is_used(key_at(i), conf, &reason)) {
            config_warn(conf, key_at(i)->full_name, "not used with %s", reason);
        }
    }
    if (conf->analysis == ANALYSIS_STATIC && conf->loads == 1 && !isnan(conf->end_load)) {
        config_warn(conf, "load.end_Nm", "not used with analysis.loads = 1");
    }
    if (conf->model == MODEL_3D) {
        modification_keys_warn(conf);
    }
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
    if (conf->entries[index].text != NULL) {
        return conf->entries[index].text;
    }
    if (strcmp(key_at(index)->full_name, "output.file") == 0) {
        return conf->output_file;
    }
    return key_at(index)->standard;
}

static void add_provenance(config *conf, const char *name, const char *text) {
    const size_t size = strlen(name) + sizeof " = " + strlen(text);

    conf->provenance[conf->provenance_count] = allocate(size);
    snprintf(conf->provenance[conf->provenance_count++], size, "%s = %s", name, text);
}

static void record_provenance(config *conf) {
    const char *reason;

    conf->provenance =
        allocate((size_t)(gearsim_keys.count + PROVENANCE_NOTES) * sizeof *conf->provenance);
    for (int i = 0; i < gearsim_keys.count; ++i) {
        const char *text = effective_text(conf, i);

        if (text != NULL && key_is_used(key_at(i), conf, &reason)) {
            add_provenance(conf, key_at(i)->full_name, text);
        }
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
    conf->entries = allocate((size_t)gearsim_keys.count * sizeof *conf->entries);
    modification_keys_clear(conf);
    gm_pair_params_default(&conf->gears);
    key_assign_defaults(&gearsim_keys, conf);
}

int config_load(config *conf, const config_request *request) {
    key_reader reader = {.table = &gearsim_keys, .filled = conf, .path = request->path};
    int faults;

    start(conf, request);
    reader.entries = conf->entries;
    key_reader_read(&reader);
    read_command_line(&reader, request);
    faults = reader.faults;

    if (conf->output_file == NULL) {
        conf->output_file = default_output_file(conf->path);
    }
    if (faults == 0) {
        faults = check_missing(conf);
    }
    if (faults == 0) {
        faults = check_together(conf);
    }
    if (faults > 0) {
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
    for (int i = 0; i < conf->provenance_count; ++i) {
        free(conf->provenance[i]);
    }
    free(conf->provenance);
    key_entries_free(conf->entries, gearsim_keys.count);
    free_flank_files(&conf->pinion_flanks);
    free_flank_files(&conf->wheel_flanks);
    free(conf->output_file);
    free(conf->columns);
    free(conf->path);
    memset(conf, 0, sizeof *conf);
}
