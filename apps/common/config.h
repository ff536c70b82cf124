/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What a run is asked to do: the INI file and the command line, checked and converted to SI once. NaN in
 * an optional number means that the key is missing.
 */
#ifndef APPS_CONFIG_H
#define APPS_CONFIG_H

#include "exit_code.h"
#include "messages.h"
#include "ripple.h"

#include <gearmesh/gearmesh.h>
#include <stdint.h>
#include <stdio.h>

enum mesh_model { MODEL_SIMPLE, MODEL_3D };
enum mesh_law { LAW_CONSTANT, LAW_ISO6336, LAW_ELASTIC };
enum friction_law { FRICTION_CONSTANT, FRICTION_ISO14179, FRICTION_BENEDICT_KELLEY };
enum corner_contact { CORNER_CONTACT_OFF, CORNER_CONTACT_ON };
enum drive_kind { DRIVE_SPEED, DRIVE_TORQUE };
enum analysis_type { ANALYSIS_DYNAMIC, ANALYSIS_STATIC };
enum static_period { PERIOD_MESH, PERIOD_PINION, PERIOD_HUNTING };
enum solver_method { METHOD_BDF, METHOD_ADAMS, METHOD_ERK };
enum table_interpolation { INTERPOLATION_LINEAR, INTERPOLATION_CUBIC };
enum table_repeat { REPEAT_OFF, REPEAT_ON };
enum lookup_use { LOOKUP_OFF, LOOKUP_ON, LOOKUP_AUTO, LOOKUP_ALWAYS };
enum wrench_use { WRENCH_OFF, WRENCH_ON };
enum deviation_direction { DEVIATION_NORMAL, DEVIATION_TRANSVERSE };

/* What a configuration is loaded for. All but a run need [gears] alone and open no flank file. */
enum config_purpose {
    CONFIG_FOR_RUN,
    CONFIG_FOR_GEOMETRY, /* of gearsim */
    CONFIG_FOR_FLANKS    /* of gearflanks, which does not warn of what gearsim warns of */
};

typedef struct flank_files {
    char *deviations; /* path as it can be opened from the working folder, NULL = ideal */
    char *pitch;
    char *tooth_stiffness; /* factors of single teeth, NULL = 1 */
} flank_files;

/* Keys of one modification; MODIFICATION_SHAPE is the only one that is no number. */
enum modification_field {
    MODIFICATION_AMOUNT,
    MODIFICATION_WIDTH,  /* along the face */
    MODIFICATION_LENGTH, /* along the profile, in one of three ways */
    MODIFICATION_RADIUS,
    MODIFICATION_SHARE,
    MODIFICATION_SHAPE,
    MODIFICATION_FIELDS
};

typedef struct modification_values {
    double value[MODIFICATION_SHAPE]; /* SI, NaN = not given */
    int shape;                        /* place in the key's choices, -1 = not given */
} modification_values;

typedef struct config {
    char *path; /* of the INI file, as given */

    gm_pair_params gears;
    double pinion_bore_radius; /* of a disc that winds up, m; NaN: rigid body */
    double wheel_bore_radius;
    double double_helical_gap; /* between two halves of opposite hand, m; NaN: one helix */

    flank_files pinion_flanks;
    flank_files wheel_flanks;
    flank_files pinion_second_flanks; /* of a double-helical gear, NULL = as in the first half */
    flank_files wheel_second_flanks;
    double flank_scale;
    enum deviation_direction deviation_direction;
    double profile_from, profile_to, profile_blend;

    /* [gear][both flanks, drive, coast][enum gm_modification_kind] as given, see modification_keys.h */
    modification_values modifications[2][3][GM_MODIFICATION_KINDS];
    double modification_tolerance; /* m */

    enum mesh_model model;
    enum mesh_law law;
    enum friction_law friction_law;
    double stiffness;             /* K of one tooth pair, N/m */
    double iso_blank_factor;      /* C_R of ISO 6336-1 */
    double damping;               /* D of one tooth pair, N s/m; NaN: not given */
    double damping_ratio;         /* zeta of both bodies on the mean mesh, NaN: not given */
    double simple_stiffness;      /* of the simple model, N/m; NaN: stiffness * eps_alpha */
    double pinion_youngs_modulus; /* N/m2 */
    double wheel_youngs_modulus;
    double pinion_poisson_ratio;
    double wheel_poisson_ratio;
    double friction_coefficient; /* of the constant law */
    double friction_speed;       /* at which mu has reached 0.7 of itself, m/s */
    double oil_viscosity;        /* Pa s */
    double roughness;            /* Ra, m */
    enum corner_contact corner_contact;
    double tip_rounding; /* radius in modules */
    int stations;        /* of elastic teeth along the face; 0 = as the pair wants */

    gm_pose pose; /* of the wheel against the drawing */

    double pinion_inertia; /* kg m2 */
    double wheel_inertia;
    double pinion_drag; /* N m s */
    double wheel_drag;

    enum drive_kind drive;
    double start_speed, end_speed; /* rad/s */
    double drive_torque;           /* N m */
    char *drive_file;              /* table over time in place of them, NULL = none */
    enum table_interpolation drive_interpolation;
    enum table_repeat drive_repeat;
    struct time_table *drive_table; /* what the file says, once gearsim has read it */
    ripple drive_ripple;            /* amplitudes in rpm, or N m for a torque */

    double mean_load; /* N m */
    double end_load;  /* of the last of the static sweeps, N m; NaN: mean_load */
    double noise_amplitude;
    double noise_interval; /* s */
    uint64_t seed;
    double load_per_speed;         /* N m s */
    double load_per_speed_squared; /* N m s2 */
    char *load_file;               /* table over time in place of mean_load, NULL = none */
    enum table_interpolation load_interpolation;
    enum table_repeat load_repeat;
    struct time_table *load_table;
    ripple load_ripple; /* amplitudes in N m */

    enum analysis_type analysis;
    double duration;   /* s */
    double stop_speed; /* of the pinion, that ends the run; NaN: none (rad/s) */
    int positions;
    int loads; /* static sweeps over the positions, from mean_load to end_load */
    enum static_period period;

    enum solver_method method;
    double relative_tolerance;
    double absolute_tolerance; /* of x, m */
    double max_step;           /* s, 0 = none */
    enum lookup_use lookup;    /* in place of the 3D model */
    double lookup_depth;       /* m; NaN: from the loads */
    int lookup_threads;        /* that fill it before the run; 0: filled on the way */

    char *output_file;  /* as it can be opened from the working folder */
    double output_rate; /* Hz */
    int oversampling;
    int digits;
    char *columns;           /* names separated by commas, NULL = all */
    enum wrench_use wrench;  /* all contains force and moment on each gear */
    char *load_distribution; /* file of a static analysis, NULL = none */
    int binary_rows;         /* numbers of standard output as they are in memory */

    message_sink *messages; /* where to speak, NULL = nobody listens */
    enum config_purpose purpose;

    /* Every key in effect, defaults included, as "section.key = value", and some values that follow from them
     * as "name = value": what an output says of its origin. */
    char **provenance;
    int provenance_count;

    struct key_entry *entries; /* [gearsim_keys.count] what was given, and where: see key_table.h */
} config;

/* Whether flanks rub on each other. */
static inline int config_has_friction(const config *conf) {
    return conf->model == MODEL_3D &&
           (conf->friction_law != FRICTION_CONSTANT || conf->friction_coefficient > 0);
}

/* Whether lines of contact of constant stiffness go on beyond the path; those of elastic teeth need no care. */
static inline int config_has_corners(const config *conf) {
    return conf->model == MODEL_3D && conf->law != LAW_ELASTIC &&
           conf->corner_contact == CORNER_CONTACT_ON;
}

/* Room for config_note(). */
enum { PROVENANCE_NOTES = 24 };

/* What the command line asks for. */
typedef struct config_request {
    const char *path;             /* of the INI file */
    const char *const *overrides; /* "section.key=value" of each --set, in order */
    int override_count;
    const char *output_file; /* of --output, NULL = not given */
    int binary_rows;         /* of --binary */
    enum config_purpose purpose;
    message_sink *messages; /* where to speak, NULL = nobody listens */
} config_request;

/*
 * Reads and checks an INI file and the `--set section.key=value` overrides, of which a later one wins. A key with nothing
 * behind the `=` is not given, also where the file gives it. Messages read
 * `file:line: section.key: must be WHAT IS RIGHT (got VALUE)`; the first 20 are told, the others counted. Returns 0, or
 * EXIT_BAD_INPUT or EXIT_RUN_FAILED (no memory) with nothing allocated.
 *
 * Paths in the INI file are relative to its folder, those of --set and --output, and the default output
 * file, to the working folder.
 */
int config_load(config *config, const config_request *request);

void config_free(config *config);

/* A message about a key whose fault only a later step can find: "file:line: section.key: " (or "--set section.key: ") and
 * then the formatted text. */
void config_complain(const config *config, const char *section_and_key, const char *format, ...);

/* The same with "warning: " behind the key; left out with --quiet. */
void config_warn(const config *config, const char *section_and_key, const char *format, ...);

/* The same with "note: ", of what is right as it is; silent with --quiet. */
void config_remark(const config *config, const char *section_and_key, const char *format, ...);

/* The INI key "section.key" that sets a field of gm_pair_params, and the text it was given (NULL = none). */
const char *config_key_of_field(const char *field);
const char *config_text(const config *config, const char *section_and_key);

/* One more line of provenance, at most PROVENANCE_NOTES of them: a value that follows from the keys. Returns 0 or
 * EXIT_RUN_FAILED (no memory). */
int config_note(config *config, const char *name, double value);
int config_note_text(config *config, const char *name, const char *text);

#endif
