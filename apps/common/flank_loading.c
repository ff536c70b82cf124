/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "flank_loading.h"
#include "modification_keys.h"

#include <gearmesh/gearmesh_io.h>
#include <stdio.h>
#include <string.h>

/* One gear's part of [flanks]. */
typedef struct flank_task {
    const char *deviations_key, *pitch_key;
    const char *deviations, *pitch; /* files, NULL = none */
    enum gm_role gear;
    int teeth;
} flank_task;

int gear_flanks_has_second(const config *conf, enum gm_role gear) {
    const flank_files *files =
        gear == GM_PINION ? &conf->pinion_second_flanks : &conf->wheel_second_flanks;

    return files->deviations != NULL || files->pitch != NULL;
}

/* What the second half has no file for is as in the first. */
static flank_task task_of(const config *conf, const gm_pair *pair, enum gm_role gear, int half) {
    const int is_pinion = gear == GM_PINION;
    const flank_files *files = is_pinion ? &conf->pinion_flanks : &conf->wheel_flanks;
    flank_task task = {.deviations_key = is_pinion ? "flanks.pinion" : "flanks.wheel",
                       .pitch_key = is_pinion ? "flanks.pinion_pitch" : "flanks.wheel_pitch",
                       .deviations = files->deviations,
                       .pitch = files->pitch,
                       .gear = gear,
                       .teeth = is_pinion ? pair->pinion.teeth : pair->wheel.teeth};

    /* Files of the second half stand in for those of the first. */
    const flank_files *second =
        is_pinion ? &conf->pinion_second_flanks : &conf->wheel_second_flanks;
    if (half == 1 && second->deviations != NULL) {
        task.deviations_key = is_pinion ? "flanks.pinion_second_half" : "flanks.wheel_second_half";
        task.deviations = second->deviations;
    }
    if (half == 1 && second->pitch != NULL) {
        task.pitch_key =
            is_pinion ? "flanks.pinion_second_half_pitch" : "flanks.wheel_second_half_pitch";
        task.pitch = second->pitch;
    }
    return task;
}

/* The file is at fault, and the key that names it tells where it came from. */
static int refuse_file(const config *conf, const char *key, const gm_io_error *error) {
    const char *file = error->file[0] != '\0' ? error->file : conf->path;

    if (error->line > 0) {
        message_error(conf->messages, "%s:%ld: %s", file, error->line, error->text);
    } else {
        message_error(conf->messages, "%s: %s", file, error->text);
    }
    config_complain(conf, key, "names this file");
    return EXIT_BAD_INPUT;
}

static void note_ideal_teeth(const config *conf, const char *file, int drive, int coast,
                             int teeth) {
    if (drive > 0 || coast > 0) {
        message_note(conf->messages,
                     "%s: note: no rows for the drive flank of %d and the coast flank of %d of %d "
                     "teeth: these are ideal",
                     file, drive, coast, teeth);
    }
}

static int read_deviations(const config *conf, const flank_task *task, gm_deviations *deviations) {
    gm_io_error error = {0};
    const int status = gm_deviations_read(deviations, task->deviations, task->teeth, &error);

    if (status == GM_IO_ERR_MEMORY) {
        return message_no_memory(conf->messages);
    }
    if (status != GM_IO_OK) {
        return refuse_file(conf, task->deviations_key, &error);
    }
    note_ideal_teeth(conf, task->deviations, gm_deviations_ideal_teeth(deviations, GM_DRIVE),
                     gm_deviations_ideal_teeth(deviations, GM_COAST), task->teeth);
    return 0;
}

static int read_pitch(const config *conf, const flank_task *task, gm_pitch *pitch) {
    gm_io_error error = {0};
    const int status = gm_pitch_read(pitch, task->pitch, task->teeth, &error);

    if (status == GM_IO_ERR_MEMORY) {
        return message_no_memory(conf->messages);
    }
    if (status != GM_IO_OK) {
        return refuse_file(conf, task->pitch_key, &error);
    }
    note_ideal_teeth(conf, task->pitch, gm_pitch_ideal_teeth(pitch, GM_DRIVE),
                     gm_pitch_ideal_teeth(pitch, GM_COAST), task->teeth);
    return 0;
}

static gm_flanks_options flank_options(const config *conf, const gm_pair *pair) {
    const int normal = conf->deviation_direction == DEVIATION_NORMAL;
    gm_flanks_options options;

    gm_flanks_options_default(&options);
    options.scale = conf->flank_scale;
    options.normal_factor = normal ? pair->normal_to_transverse : 1;
    options.profile_from = conf->profile_from;
    options.profile_to = conf->profile_to;
    options.profile_blend = conf->profile_blend;
    return options;
}

static const char *const flank_names[2][2] = {{"pinion_drive", "pinion_coast"},
                                              {"wheel_drive", "wheel_coast"}};

static int has_design(const gm_flanks_side_report *form) {
    return form->ramps > 0 || form->face_nodes > 0;
}

/* What holds a design and how true it is: a note, or a warning where the tolerance is missed. */
static void note_design(const config *conf, const char *flank, const gm_flanks_side_report *form) {
    const char *key = "modifications.tolerance_um";
    char ramps[64] = "", table[128] = "";

    if (form->error > conf->modification_tolerance) {
        config_warn(conf, key,
                    "missed: the table of %s with %d x %d nodes is off by up to %.3g um, a finer "
                    "one would have too many nodes",
                    flank, form->face_nodes, form->profile_nodes, 1e6 * form->error);
        return;
    }
    if (!has_design(form)) {
        return;
    }

    if (form->ramps > 0) {
        snprintf(ramps, sizeof ramps, "%d linear relief%s, exact", form->ramps,
                 form->ramps > 1 ? "s" : "");
    }
    if (form->face_nodes > 0) {
        snprintf(table, sizeof table, "table of %d x %d nodes, off by at most %.3g um",
                 form->face_nodes, form->profile_nodes, 1e6 * form->error);
    }
    message_note(conf->messages, "%s: note: [modifications] of %s: %s%s%s", conf->path, flank,
                 ramps, ramps[0] != '\0' && table[0] != '\0' ? "; " : "", table);
}

static int refuse_flanks(const config *conf, const flank_task *task, int status,
                         const gm_io_error *error) {
    if (status == GM_IO_ERR_MEMORY) {
        return message_no_memory(conf->messages);
    }
    if (task->deviations != NULL) {
        return refuse_file(conf, task->deviations_key, error);
    }
    if (task->pitch != NULL) {
        return refuse_file(conf, task->pitch_key, error);
    }
    message_error(conf->messages, "%s: [modifications]: %s", conf->path, error->text);
    return EXIT_BAD_INPUT;
}

static int build_flanks(gear_flanks *flanks, const config *conf, const gm_pair *pair,
                        const flank_task *task, const gear_design *design,
                        const gm_deviations *deviations, const gm_pitch *pitch) {
    gm_flanks_options options = flank_options(conf, pair);
    gm_io_error error = {0};

    options.drive_modifications = &design->of[GM_DRIVE];
    options.coast_modifications = &design->of[GM_COAST];
    options.modification_tolerance = conf->modification_tolerance;
    const int status = gm_flanks_build(&flanks->prepared, task->teeth, deviations, pitch, &options,
                                       &flanks->report, &error);
    if (status != GM_IO_OK) {
        return refuse_flanks(conf, task, status, &error);
    }

    note_design(conf, flank_names[task->gear][GM_DRIVE], &flanks->report.drive);
    note_design(conf, flank_names[task->gear][GM_COAST], &flanks->report.coast);
    return 0;
}

int gear_flanks_load(gear_flanks *flanks, const config *conf, const gm_pair *pair,
                     enum gm_role gear, int half) {
    const flank_task task = task_of(conf, pair, gear, half);
    const int has_deviations = task.deviations != NULL;
    const int has_pitch = task.pitch != NULL;
    gm_deviations deviations = {0};
    gm_pitch pitch = {0};

    /* What is designed, and what was measured. */
    gear_design design;
    int status = gear_design_make(&design, conf, pair, gear);
    const int has_design = design.of[GM_DRIVE].count + design.of[GM_COAST].count > 0;
    if (status == 0 && has_deviations) {
        status = read_deviations(conf, &task, &deviations);
    }
    if (status == 0 && has_pitch) {
        status = read_pitch(conf, &task, &pitch);
    }

    /* All of it in the form that the model evaluates. */
    if (status == 0 && (has_deviations || has_pitch || has_design)) {
        status = build_flanks(flanks, conf, pair, &task, &design,
                              has_deviations ? &deviations : NULL, has_pitch ? &pitch : NULL);
        flanks->face_nodes = deviations.face_nodes;
        flanks->profile_nodes = deviations.profile_nodes;
    }
    gm_deviations_free(&deviations);
    gm_pitch_free(&pitch);
    return status;
}

void gear_flanks_free(gear_flanks *flanks) {
    gm_flanks_free(flanks->prepared);
    memset(flanks, 0, sizeof *flanks);
}

static int note_value(config *conf, const char *flank, const char *what, double value) {
    char name[64];

    snprintf(name, sizeof name, "%s_modification_%s", flank, what);
    return config_note(conf, name, value);
}

/* What holds a design. */
static int note_form(config *conf, const char *flank, const gm_flanks_side_report *form) {
    if (!has_design(form)) {
        return 0;
    }

    int status = note_value(conf, flank, "ramps", form->ramps);
    if (status == 0 && form->face_nodes > 0) {
        status = note_value(conf, flank, "face_nodes", form->face_nodes);
    }
    if (status == 0 && form->face_nodes > 0) {
        status = note_value(conf, flank, "profile_nodes", form->profile_nodes);
    }
    return status == 0 ? note_value(conf, flank, "error_um", 1e6 * form->error) : status;
}

int gear_flanks_note(const gear_flanks *flanks, config *conf, enum gm_role gear) {
    const int status = note_form(conf, flank_names[gear][GM_DRIVE], &flanks->report.drive);

    return status == 0 ? note_form(conf, flank_names[gear][GM_COAST], &flanks->report.coast)
                       : status;
}
