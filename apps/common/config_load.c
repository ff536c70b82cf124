/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From INI file and command line to a checked config: each value by itself as it is met (key_reader.c),
 * then what is missing, then what must fit together. All faults of a stage are told before the run is refused, so
 * that a user need not find them one by one.
 */
#include "config.h"
#include "config_check.h"
#include "key_reader.h"
#include "keys.h"
#include "memory.h"
#include "modification_keys.h"
#include "platform.h"
#include "slips.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    if (text == NULL) {
        reader->no_memory = 1;
        return;
    }

    char *equals = strchr(text, '=');
    char *dot = strchr(text, '.');
    if (has_control_character(text)) {
        key_reader_fault(reader, "section.key=value",
                         "must be plain text (got a control character)");
    } else if (equals == NULL || dot == NULL || dot > equals) {
        key_reader_fault(reader, override, "must read section.key=value");
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
    if (*request->output_file == '\0') {
        key_reader_fault(reader, "output.file", "must be the name of a file (got nothing)");
    } else if (has_control_character(request->output_file)) {
        key_reader_fault(reader, "output.file", "must be plain text (got a control character)");
    } else {
        key_reader_set(reader, "output", "file", request->output_file);
    }
}

/* ---------------------------------------------------------------------------------------------
 * The whole
 * ------------------------------------------------------------------------------------------- */

/* "folder/run.ini" gives "run.csv", standard input standard output. NULL: no memory. */
static char *default_output_file(const char *path) {
    if (strcmp(path, "-") == 0) {
        return copy_text(path);
    }

    const char *name = path + path_name_start(path);
    const char *dot = strrchr(name, '.');
    const size_t length = dot == NULL || dot == name ? strlen(name) : (size_t)(dot - name);
    char *file = join_texts(name, ".csv");

    if (file != NULL) {
        strcpy(file + length, ".csv");
    }
    return file;
}

static const key_spec *key_at(int index) {
    return &gearsim_keys.keys[index];
}

/* The text in effect, NULL where the value is derived from others. */
static const char *effective_text(const config *conf, int index) {
    if (conf->entries[index].text != NULL) {
        return conf->entries[index].text;
    }
    if (strcmp(key_at(index)->full_name, "output.file") == 0) {
        return conf->output_file;
    }
    if (strcmp(key_at(index)->full_name, "mesh.law") == 0) {
        return conf->law == LAW_CONSTANT ? "constant" : "elastic";
    }
    if (strcmp(key_at(index)->full_name, "mesh.corner_contact") == 0) {
        return conf->corner_contact == CORNER_CONTACT_ON ? "on" : "off";
    }
    return key_at(index)->standard;
}

static int add_provenance(config *conf, const char *name, const char *text) {
    const size_t size = strlen(name) + sizeof " = " + strlen(text);
    char *line = allocate(size, 1);

    if (line == NULL) {
        return EXIT_RUN_FAILED;
    }
    snprintf(line, size, "%s = %s", name, text);
    conf->provenance[conf->provenance_count++] = line;
    return 0;
}

static int record_provenance(config *conf) {
    const char *reason;
    int status = 0;

    for (int i = 0; i < gearsim_keys.count && status == 0; ++i) {
        const char *text = effective_text(conf, i);

        if (text != NULL && key_is_used(key_at(i), conf, &reason)) {
            status = add_provenance(conf, key_at(i)->full_name, text);
        }
    }
    return status;
}

int config_note(config *conf, const char *name, double value) {
    char text[32];

    snprintf(text, sizeof text, "%.9g", value);
    return add_provenance(conf, name, text);
}

int config_note_text(config *conf, const char *name, const char *text) {
    return add_provenance(conf, name, text);
}

/* Everything at its default. */
static int start(config *conf, const config_request *request) {
    const size_t keys = (size_t)gearsim_keys.count;

    memset(conf, 0, sizeof *conf);
    conf->messages = request->messages;
    conf->purpose = request->purpose;
    conf->path = copy_text(request->path);
    conf->entries = allocate(keys, sizeof *conf->entries);
    conf->provenance = allocate(keys + PROVENANCE_NOTES, sizeof *conf->provenance);
    if (conf->path == NULL || conf->entries == NULL || conf->provenance == NULL) {
        return EXIT_RUN_FAILED;
    }

    modification_keys_clear(conf);
    gm_pair_params_default(&conf->gears);
    return key_assign_defaults(&gearsim_keys, conf) == KEY_TAKEN ? 0 : EXIT_RUN_FAILED;
}

/* One tolerance does for both, so that who tightens one is not left with the error of the other (m). */
static double absolute_tolerance_of(double relative_tolerance) {
    static const double usual = 1e-4, micrometre = 1e-6;
    const int is_tighter = relative_tolerance > 0 && relative_tolerance < usual;

    return micrometre * (is_tighter ? relative_tolerance : usual);
}

/* Each value by itself, from the file and then from the command line. */
static int read_values(config *conf, const config_request *request) {
    key_reader reader = {.table = &gearsim_keys,
                         .filled = conf,
                         .entries = conf->entries,
                         .path = request->path,
                         .messages = conf->messages};

    key_reader_read(&reader);
    read_command_line(&reader, request);
    if (reader.no_memory) {
        return EXIT_RUN_FAILED;
    }
    if (reader.faults > 0) {
        return EXIT_BAD_INPUT;
    }

    /* Who gives a stiffness means it; from the gear data alone the teeth are elastic. */
    if (config_text(conf, "mesh.law") == NULL) {
        conf->law = isnan(conf->stiffness) ? LAW_ELASTIC : LAW_CONSTANT;
    }
    if (config_text(conf, "mesh.corner_contact") == NULL) {
        conf->corner_contact = conf->law == LAW_ELASTIC ? CORNER_CONTACT_ON : CORNER_CONTACT_OFF;
    }
    if (isnan(conf->absolute_tolerance)) {
        conf->absolute_tolerance = absolute_tolerance_of(conf->relative_tolerance);
    }
    if (conf->output_file == NULL) {
        conf->output_file = default_output_file(conf->path);
    }
    conf->binary_rows = request->binary_rows;
    return conf->output_file != NULL ? 0 : EXIT_RUN_FAILED;
}

static int load(config *conf, const config_request *request) {
    int status = start(conf, request);

    if (status == 0) {
        status = read_values(conf, request);
    }
    if (status == 0 && (config_check_missing(conf) > 0 || config_check_together(conf) > 0)) {
        status = EXIT_BAD_INPUT;
    }
    return status == 0 ? record_provenance(conf) : status;
}

int config_load(config *conf, const config_request *request) {
    message_begin(request->messages, MOST_MESSAGES);
    const int status = load(conf, request);
    message_end(request->messages, request->path);

    if (status == 0) {
        message_begin(request->messages, MOST_MESSAGES);
        slips_warn(conf);
        if (conf->purpose == CONFIG_FOR_RUN) {
            config_remark_on_defaults(conf);
        }
        if (conf->purpose != CONFIG_FOR_FLANKS) {
            config_warn_of_unused(conf);
        }
        message_end(request->messages, request->path);
        return 0;
    }
    if (status == EXIT_RUN_FAILED) {
        (void)message_no_memory(request->messages);
    }
    config_free(conf);
    return status;
}

static void free_flank_files(flank_files *files) {
    free(files->deviations);
    free(files->pitch);
    free(files->tooth_stiffness);
}

void config_free(config *conf) {
    for (int i = 0; i < conf->provenance_count; ++i) {
        free(conf->provenance[i]);
    }
    free(conf->provenance);
    key_entries_free(conf->entries, gearsim_keys.count);
    free_flank_files(&conf->pinion_flanks);
    free_flank_files(&conf->wheel_flanks);
    free_flank_files(&conf->pinion_second_flanks);
    free_flank_files(&conf->wheel_second_flanks);
    free(conf->drive_file);
    free(conf->load_file);
    free(conf->output_file);
    free(conf->columns);
    free(conf->load_distribution);
    free(conf->path);
    memset(conf, 0, sizeof *conf);
}
