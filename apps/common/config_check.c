/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "config_check.h"
#include "keys.h"
#include "modification_keys.h"
#include "paths.h"
#include "result_file.h"

#include <math.h>
#include <string.h>

/* More rows than anybody can read, and noise values beyond which a double cannot count them. */
static const double row_limit = 1e9;
static const double noise_limit = 1e15;

static const char *condition_of(const key_spec *key, const config *conf) {
    if (key->required & (FOR_SPEED | FOR_TORQUE)) {
        return conf->drive == DRIVE_SPEED ? " for drive.kind = speed" : " for drive.kind = torque";
    }
    if (key->required & FOR_DYNAMIC) {
        return " for a dynamic run";
    }
    return key->required & FOR_RUN ? " for a run" : "";
}

int config_check_missing(const config *conf) {
    int faults = 0;

    for (int i = 0; i < gearsim_keys.count; ++i) {
        if (conf->entries[i].text != NULL || !key_is_required(&gearsim_keys.keys[i], conf)) {
            continue;
        }
        config_complain(conf, gearsim_keys.keys[i].full_name,
                        "missing, but required%s: add %s to [%s]",
                        condition_of(&gearsim_keys.keys[i], conf), gearsim_keys.keys[i].name,
                        gearsim_keys.keys[i].section);
        ++faults;
    }
    return faults;
}

static int check_profile_window(const config *conf) {
    if (conf->profile_from < conf->profile_to) {
        return 0;
    }
    if (config_text(conf, "flanks.profile_from") != NULL) {
        config_complain(conf, "flanks.profile_from",
                        "must be smaller than flanks.profile_to (got %.9g and %.9g)",
                        conf->profile_from, conf->profile_to);
    } else {
        config_complain(conf, "flanks.profile_to",
                        "must be larger than flanks.profile_from (got %.9g and %.9g)",
                        conf->profile_to, conf->profile_from);
    }
    return 1;
}

/* How many loads a static analysis has, and which. */
static int check_loads(const config *conf) {
    const double rows = (double)conf->loads * conf->positions;

    if (!(rows <= row_limit)) {
        config_complain(conf, "analysis.loads",
                        "must give at most %.9g rows (got %d loads with %d positions)", row_limit,
                        conf->loads, conf->positions);
        return 1;
    }

    /* Several loads need the last one. */
    if (conf->loads > 1 && isnan(conf->end_load)) {
        config_complain(conf, "analysis.loads", "must be 1 without load.end_Nm (got %d)",
                        conf->loads);
        return 1;
    }
    return 0;
}

static int check_static(const config *conf) {
    int faults = 0;

    if (conf->model != MODEL_3D) {
        config_complain(conf, "mesh.model", "must be 3d for a static analysis (got simple)");
        ++faults;
    }
    if (conf->mean_load == 0 && !(conf->loads > 1 && conf->end_load != 0)) {
        config_complain(conf, "load.mean_Nm",
                        "must not be 0 in a static analysis, where no load leaves the gears "
                        "anywhere in the backlash (got 0)");
        ++faults;
    }
    return faults + check_loads(conf);
}

/* A table and the number that it stands for. */
static int check_one_of(const config *conf, const char *file, const char *number) {
    if (config_text(conf, file) == NULL || config_text(conf, number) == NULL) {
        return 0;
    }
    config_complain(conf, number, "must not stand beside %s, which is in its place (got %s)", file,
                    config_text(conf, number));
    return 1;
}

static int check_tables(const config *conf) {
    int faults = check_one_of(conf, "load.file", "load.mean_Nm");

    if (conf->drive == DRIVE_SPEED) {
        faults += check_one_of(conf, "drive.file", "drive.start_rpm");
        faults += check_one_of(conf, "drive.file", "drive.end_rpm");
    } else {
        faults += check_one_of(conf, "drive.file", "drive.torque_Nm");
    }
    return faults;
}

/* Two keys for one thing, also where neither is used: which one is meant cannot be told. */
static int check_damping(const config *conf) {
    const char *ratio = config_text(conf, "mesh.damping_ratio");

    if (ratio == NULL || config_text(conf, "mesh.damping_Ns_per_m") == NULL) {
        return 0;
    }
    config_complain(conf, "mesh.damping_ratio",
                    "must not stand beside mesh.damping_Ns_per_m, which says the same (got %s)",
                    ratio);
    return 1;
}

static int check_dynamic(const config *conf) {
    int faults = check_tables(conf);

    if (!(conf->duration * conf->output_rate <= row_limit)) {
        config_complain(conf, "output.rate_Hz",
                        "must give at most %.9g rows (got %.9g in %.9g s): lower it or "
                        "analysis.duration_s",
                        row_limit, conf->output_rate, conf->duration);
        ++faults;
    }
    if (!(conf->duration / conf->noise_interval <= noise_limit)) {
        config_complain(conf, "load.noise_interval_s",
                        "must be at least %.9g of analysis.duration_s (got %.9g)", 1 / noise_limit,
                        conf->noise_interval);
        ++faults;
    }
    return faults;
}

/* A file that is read, NULL = none, and what is told of it. */
typedef struct input_file {
    const char *path;
    const char *name;
} input_file;

/* Neither a file that is written nor the one that it grows in may be one that is read. A stream is no file. */
static int check_not_input(const config *conf, const char *output, const char *key,
                           const input_file *input) {
    if (output == NULL || input->path == NULL || strcmp(output, "-") == 0 ||
        !result_file_would_replace(output, input->path)) {
        return 0;
    }
    config_complain(conf, key,
                    "must not overwrite an input (got %s%s, which is %s): give another name",
                    output, is_same_place(output, input->path) ? "" : ".part", input->name);
    return 1;
}

static int check_outputs_are_no_inputs(const config *conf) {
    const input_file inputs[] = {
        {conf->path, "the INI file"},
        {conf->pinion_flanks.deviations, "flanks.pinion"},
        {conf->wheel_flanks.deviations, "flanks.wheel"},
        {conf->pinion_flanks.pitch, "flanks.pinion_pitch"},
        {conf->wheel_flanks.pitch, "flanks.wheel_pitch"},
        {conf->pinion_second_flanks.deviations, "flanks.pinion_second_half"},
        {conf->wheel_second_flanks.deviations, "flanks.wheel_second_half"},
        {conf->pinion_second_flanks.pitch, "flanks.pinion_second_half_pitch"},
        {conf->wheel_second_flanks.pitch, "flanks.wheel_second_half_pitch"},
        {conf->pinion_flanks.tooth_stiffness, "flanks.pinion_tooth_stiffness"},
        {conf->wheel_flanks.tooth_stiffness, "flanks.wheel_tooth_stiffness"},
        {conf->drive_file, "drive.file"},
        {conf->load_file, "load.file"},
    };
    int faults = 0;

    for (size_t i = 0; i < sizeof inputs / sizeof inputs[0]; ++i) {
        faults += check_not_input(conf, conf->output_file, "output.file", &inputs[i]);
        faults +=
            check_not_input(conf, conf->load_distribution, "output.load_distribution", &inputs[i]);
    }
    return faults;
}

int config_check_together(const config *conf) {
    int faults = check_profile_window(conf);

    if (conf->purpose != CONFIG_FOR_RUN) {
        return faults;
    }
    if (conf->model == MODEL_3D) {
        faults += modification_keys_check(conf);
    }
    faults += check_damping(conf);
    faults += conf->analysis == ANALYSIS_STATIC ? check_static(conf) : check_dynamic(conf);
    return faults + check_outputs_are_no_inputs(conf);
}

/* A key about a table that is not there. */
static void warn_without_table(const config *conf, const char *file, const char *key) {
    if (conf->analysis == ANALYSIS_DYNAMIC && config_text(conf, file) == NULL &&
        config_text(conf, key) != NULL) {
        config_warn(conf, key, "not used without %s", file);
    }
}

void config_remark_on_defaults(const config *conf) {
    const int is_damped = config_text(conf, "mesh.damping_ratio") != NULL ||
                          config_text(conf, "mesh.damping_Ns_per_m") != NULL;

    if (conf->analysis == ANALYSIS_DYNAMIC && !is_damped) {
        config_remark(conf, "mesh.damping_ratio",
                      "is not given, nor is mesh.damping_Ns_per_m, so vibrations of the teeth do "
                      "not decay; 0.02 to 0.1 are usual");
    }
}

void config_warn_of_unused(const config *conf) {
    const char *reason;

    /* Keys that belong to another situation. */
    for (int i = 0; i < gearsim_keys.count; ++i) {
        if (conf->entries[i].text != NULL && !key_is_used(&gearsim_keys.keys[i], conf, &reason)) {
            config_warn(conf, gearsim_keys.keys[i].full_name, "not used with %s", reason);
        }
    }

    /* Keys that say nothing without others, or beside them. */
    if (conf->analysis == ANALYSIS_STATIC && conf->loads == 1 && !isnan(conf->end_load)) {
        config_warn(conf, "load.end_Nm", "not used with analysis.loads = 1");
    }
    warn_without_table(conf, "drive.file", "drive.interpolation");
    warn_without_table(conf, "drive.file", "drive.repeat");
    warn_without_table(conf, "load.file", "load.interpolation");
    warn_without_table(conf, "load.file", "load.repeat");
    if (!isnan(conf->double_helical_gap) && conf->pose.axial_shift != 0.0) {
        config_warn(conf, "pose.axial_shift_um",
                    "changes nothing with gears.double_helical_gap_mm: the pinion follows");
    }
    if (conf->model == MODEL_3D) {
        modification_keys_warn(conf);
    }
}
