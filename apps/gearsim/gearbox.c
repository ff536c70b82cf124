/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "gearbox.h"
#include "lookup.h"
#include "modification_keys.h"

#include <gearmesh/gearmesh_io.h>
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* ---------------------------------------------------------------------------------------------
 * The pair
 * ------------------------------------------------------------------------------------------- */

/* The library speaks of radii, the file of diameters. */
static void speak_of_diameters(const char *requirement, char *text, size_t size) {
    const char *radius;
    size_t length = 0;

    *text = '\0';
    while ((radius = strstr(requirement, "radius")) != NULL && length < size) {
        length += (size_t)snprintf(text + length, size - length, "%.*sdiameter",
                                   (int)(radius - requirement), requirement);
        requirement = radius + strlen("radius");
    }
    if (length < size) {
        snprintf(text + length, size - length, "%s", requirement);
    }
}

/* What most geometry faults are measured against; needs nothing but teeth, module and angles (m). */
static double base_diameter(const gm_pair_params *gears, int teeth) {
    const double cos_helix = cos(gears->helix_angle);
    const double transverse_pressure_angle = atan(tan(gears->normal_pressure_angle) / cos_helix);

    return teeth * gears->normal_module / cos_helix * cos(transverse_pressure_angle);
}

/* A geometry that cannot be, said of the key that sets the field at fault. */
static int refuse_geometry(const config *conf, int status) {
    const char *field = NULL;
    const char *requirement = NULL;
    const char *key = "gears";
    const char *text;
    char wanted[256];

    (void)gm_pair_params_check(&conf->gears, &field, &requirement);
    if (field != NULL) {
        key = config_key_of_field(field);
    }
    text = config_text(conf, key);
    speak_of_diameters(requirement != NULL ? requirement : gm_status_text(status), wanted,
                       sizeof wanted);
    config_complain(conf, key,
                    "gives no gear pair (got %s), must be %s (base diameters %.9g and %.9g mm)",
                    text != NULL ? text : "none, so it is derived", wanted,
                    1e3 * base_diameter(&conf->gears, conf->gears.pinion_teeth),
                    1e3 * base_diameter(&conf->gears, conf->gears.wheel_teeth));
    return EXIT_BAD_INPUT;
}

static int derive_pair(gearbox *box, const config *conf) {
    const int status = gm_pair_init(&box->pair, &conf->gears);

    return status == GM_OK ? 0 : refuse_geometry(conf, status);
}

/* ---------------------------------------------------------------------------------------------
 * Doubts
 * ------------------------------------------------------------------------------------------- */

/* Normal tooth thickness at the tip circle, in modules; negative = the flanks cross below it. */
static double tip_land(const gm_gear *gear, const gm_pair *pair) {
    const double alpha = acos(gear->base_radius / gear->tip_radius);
    const double half_angle = gear->base_half_thickness - (tan(alpha) - alpha);
    const double helix = atan(gear->tip_radius / gear->reference_radius * tan(pair->helix_angle));

    return 2 * gear->tip_radius * half_angle * cos(helix) / pair->normal_module;
}

static void warn_of_tip(const config *conf, const gm_pair *pair, const gm_gear *gear,
                        const char *key, const char *name) {
    const double land = tip_land(gear, pair);

    if (land <= 0) {
        config_warn(conf, key,
                    "pointed tip: the flanks of the %s cross below the tip diameter of %.6g mm",
                    name, 2e3 * gear->tip_radius);
    } else {
        config_warn(
            conf, key,
            "thin tip: the teeth of the %s are %.3f normal modules thick at the tip diameter "
            "of %.6g mm, less than 0.2",
            name, land, 2e3 * gear->tip_radius);
    }
}

/* What is said of one gear: keys and doubts of the pinion or of the wheel. */
typedef struct gear_words {
    const char *name, *teeth_key, *tip_key, *start_key;
    int undercut, tip_land, root_form, start_radius;
} gear_words;

static const gear_words pinion_words = {"pinion",
                                        "gears.pinion_teeth",
                                        "gears.pinion_tip_diameter_mm",
                                        "gears.pinion_start_diameter_mm",
                                        GM_DOUBT_PINION_UNDERCUT,
                                        GM_DOUBT_PINION_TIP_LAND,
                                        GM_DOUBT_PINION_ROOT_FORM,
                                        GM_DOUBT_PINION_START_RADIUS};
static const gear_words wheel_words = {"wheel",
                                       "gears.wheel_teeth",
                                       "gears.wheel_tip_diameter_mm",
                                       "gears.wheel_start_diameter_mm",
                                       GM_DOUBT_WHEEL_UNDERCUT,
                                       GM_DOUBT_WHEEL_TIP_LAND,
                                       GM_DOUBT_WHEEL_ROOT_FORM,
                                       GM_DOUBT_WHEEL_START_RADIUS};

static void warn_of_gear(const config *conf, const gm_pair *pair, const gm_gear *gear,
                         const gear_words *words, int doubts) {
    if (doubts & words->undercut) {
        config_warn(
            conf, words->teeth_key,
            "undercut: a generating rack cuts into the involute of the %s (%d teeth, profile "
            "shift %.6g)",
            words->name, gear->teeth, gear->profile_shift);
    }
    if (doubts & words->tip_land) {
        warn_of_tip(conf, pair, gear, words->tip_key, words->name);
    }
    if (doubts & words->root_form) {
        config_warn(
            conf, words->start_key,
            "the active profile of the %s starts at a diameter of %.6g mm, below the root form "
            "circle that a generating rack leaves",
            words->name, 2e3 * gear->start_radius);
    }
    if (doubts & words->start_radius) {
        config_warn(conf, words->start_key,
                    "below the base circle of the %s, its diameter %.6g mm is taken instead",
                    words->name, 2e3 * gear->base_radius);
    }
}

static void warn_of_doubts(const config *conf, const gm_pair *pair) {
    const int doubts = gm_pair_doubts(pair, &conf->gears);

    warn_of_gear(conf, pair, &pair->pinion, &pinion_words, doubts);
    warn_of_gear(conf, pair, &pair->wheel, &wheel_words, doubts);
    if (doubts & GM_DOUBT_CONTACT_RATIO) {
        config_warn(
            conf, "gears.center_distance_mm",
            "the transverse contact ratio is %.4f, below 1: no smooth handover between teeth",
            pair->transverse_contact_ratio);
    }
    if (doubts & GM_DOUBT_BACKLASH) {
        config_warn(conf, "gears.backlash_um",
                    "the backlash is %.6g um, negative: both flanks touch and press",
                    1e6 * pair->backlash);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Flanks
 * ------------------------------------------------------------------------------------------- */

/* One gear's part of [flanks]. */
typedef struct flank_task {
    const char *deviations_key;
    const char *pitch_key;
    const flank_files *files;
    int teeth;
} flank_task;

/* The file is at fault, and the key that names it tells where it came from. */
static int refuse_file(const config *conf, const char *key, const gm_io_error *error) {
    const char *file = error->file[0] != '\0' ? error->file : conf->path;

    if (error->line > 0) {
        fprintf(stderr, "%s:%ld: %s\n", file, error->line, error->text);
    } else {
        fprintf(stderr, "%s: %s\n", file, error->text);
    }
    config_complain(conf, key, "names this file");
    return EXIT_BAD_INPUT;
}

static void note_ideal_teeth(const config *conf, const char *file, int drive, int coast,
                             int teeth) {
    if (conf->quiet || (drive == 0 && coast == 0)) {
        return;
    }
    fprintf(
        stderr,
        "%s: note: no rows for the drive flank of %d and the coast flank of %d of %d teeth: these "
        "are ideal\n",
        file, drive, coast, teeth);
}

static int read_deviations(const config *conf, const flank_task *task, gm_deviations *deviations) {
    gm_io_error error = {0};

    if (gm_deviations_read(deviations, task->files->deviations, task->teeth, &error) != GM_IO_OK) {
        return refuse_file(conf, task->deviations_key, &error);
    }
    note_ideal_teeth(conf, task->files->deviations, gm_deviations_ideal_teeth(deviations, GM_DRIVE),
                     gm_deviations_ideal_teeth(deviations, GM_COAST), task->teeth);
    return 0;
}

static int read_pitch(const config *conf, const flank_task *task, gm_pitch *pitch) {
    gm_io_error error = {0};

    if (gm_pitch_read(pitch, task->files->pitch, task->teeth, &error) != GM_IO_OK) {
        return refuse_file(conf, task->pitch_key, &error);
    }
    note_ideal_teeth(conf, task->files->pitch, gm_pitch_ideal_teeth(pitch, GM_DRIVE),
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

/* What holds a design and how true it is: a note, or a warning where the tolerance is missed. */
static void note_design(const config *conf, const char *flank, const design_form *form) {
    const char *key = "modifications.tolerance_um";
    const gm_modifications_grid *grid = &form->grid;
    char ramps[64] = "", table[128] = "";

    if (grid->error > conf->modification_tolerance) {
        config_warn(conf, key,
                    "missed: the table of %s with %d x %d nodes is off by up to %.3g um, a finer "
                    "one would have too many nodes",
                    flank, grid->face_nodes, grid->profile_nodes, 1e6 * grid->error);
    } else if (!conf->quiet) {
        if (form->ramps > 0) {
            snprintf(ramps, sizeof ramps, "%d linear relief%s, exact", form->ramps,
                     form->ramps > 1 ? "s" : "");
        }
        if (grid->face_nodes > 0) {
            snprintf(table, sizeof table, "table of %d x %d nodes, off by at most %.3g um",
                     grid->face_nodes, grid->profile_nodes, 1e6 * grid->error);
        }
        fprintf(stderr, "%s: note: [modifications] of %s: %s%s%s\n", conf->path, flank, ramps,
                ramps[0] != '\0' && table[0] != '\0' ? "; " : "", table);
    }
}

/* What gm_flanks_build() will find as well. */
static design_form form_of(const gm_modifications *design, const config *conf,
                           const gm_deviations *deviations) {
    gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX];
    gm_modification list[GM_MODIFICATION_KINDS];
    gm_modifications rest = *design;
    design_form form = {0};

    rest.list = list;
    (void)gm_modifications_split(design, ramps, &form.ramps, list, &rest.count);
    if (rest.count > 0) {
        (void)gm_modifications_grid_find(&rest, deviations != NULL ? deviations->face_nodes : 2,
                                         deviations != NULL ? deviations->profile_nodes : 2,
                                         conf->modification_tolerance, &form.grid);
    }
    return form;
}

static void find_forms(gearbox *box, const config *conf, int gear, const gear_design *design,
                       const gm_deviations *deviations) {
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        design_form *form = &box->design_form[gear][side];
        *form = form_of(&design->of[side], conf, deviations);
        if (form->ramps > 0 || form->grid.face_nodes > 0) {
            note_design(conf, flank_names[gear][side], form);
        }
    }
}

static int refuse_flanks(const config *conf, const flank_task *task, const gm_io_error *error) {
    if (task->files->deviations != NULL) {
        return refuse_file(conf, task->deviations_key, error);
    }
    if (task->files->pitch != NULL) {
        return refuse_file(conf, task->pitch_key, error);
    }
    fprintf(stderr, "%s: [modifications]: %s\n", conf->path, error->text);
    return EXIT_BAD_INPUT;
}

static int build_flanks(gearbox *box, const config *conf, const flank_task *task, int gear,
                        const gear_design *design, const gm_deviations *deviations,
                        const gm_pitch *pitch) {
    gm_flanks_options options = flank_options(conf, &box->pair);
    gm_io_error error = {0};

    options.drive_modifications = &design->of[GM_DRIVE];
    options.coast_modifications = &design->of[GM_COAST];
    options.modification_tolerance = conf->modification_tolerance;
    find_forms(box, conf, gear, design, deviations);
    if (gm_flanks_build(&box->flank_storage[gear], &box->flank_memory[gear], task->teeth,
                        deviations, pitch, &options, &error) == GM_IO_OK) {
        return 0;
    }
    return refuse_flanks(conf, task, &error);
}

/* Files and design of one gear (0 = pinion, 1 = wheel) become prepared flanks, if there are any. */
static int load_flanks(gearbox *box, const config *conf, const flank_task *task, int gear) {
    const int has_deviations = task->files->deviations != NULL;
    const int has_pitch = task->files->pitch != NULL;
    gm_deviations deviations = {0};
    gm_pitch pitch = {0};
    gear_design design;
    int status = gear_design_make(&design, conf, &box->pair, gear);
    const int has_design = design.of[GM_DRIVE].count + design.of[GM_COAST].count > 0;

    if (status == 0 && has_deviations) {
        status = read_deviations(conf, task, &deviations);
    }
    if (status == 0 && has_pitch) {
        status = read_pitch(conf, task, &pitch);
    }
    if (status == 0 && (has_deviations || has_pitch || has_design)) {
        status = build_flanks(box, conf, task, gear, &design, has_deviations ? &deviations : NULL,
                              has_pitch ? &pitch : NULL);
    }
    gm_deviations_free(&deviations);
    gm_pitch_free(&pitch);
    return status;
}

static int load_both_flanks(gearbox *box, const config *conf) {
    const flank_task pinion = {"flanks.pinion", "flanks.pinion_pitch", &conf->pinion_flanks,
                               box->pair.pinion.teeth};
    const flank_task wheel = {"flanks.wheel", "flanks.wheel_pitch", &conf->wheel_flanks,
                              box->pair.wheel.teeth};
    int status = load_flanks(box, conf, &pinion, 0);

    if (status == 0) {
        status = load_flanks(box, conf, &wheel, 1);
    }
    box->pinion_flanks = box->flank_memory[0] != NULL ? &box->flank_storage[0] : NULL;
    box->wheel_flanks = box->flank_memory[1] != NULL ? &box->flank_storage[1] : NULL;
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * The whole
 * ------------------------------------------------------------------------------------------- */

/* Both models shall share eigenfrequency and damping ratio unless told otherwise. */
static void derive_simple_model(gearbox *box, const config *conf) {
    const double contact_ratio = box->pair.transverse_contact_ratio;

    box->simple_stiffness =
        isnan(conf->simple_stiffness) ? conf->stiffness * contact_ratio : conf->simple_stiffness;
    box->simple_damping = conf->damping * contact_ratio;
}

int gearbox_open(gearbox *box, const config *conf) {
    int status;

    memset(box, 0, sizeof *box);
    status = derive_pair(box, conf);
    if (status != 0) {
        return status;
    }
    warn_of_doubts(conf, &box->pair);
    derive_simple_model(box, conf);
    if (conf->model == MODEL_3D && conf->purpose == CONFIG_FOR_RUN) {
        status = load_both_flanks(box, conf);
    }
    if (status == 0 && conf->purpose == CONFIG_FOR_RUN) {
        status = lookup_check(conf, box);
    }
    if (status != 0) {
        gearbox_close(box);
    }
    return status;
}

void gearbox_close(gearbox *box) {
    for (int gear = 0; gear < 2; ++gear) {
        gm_flanks_memory_free(box->flank_memory[gear]);
    }
    memset(box, 0, sizeof *box);
}

/* ---------------------------------------------------------------------------------------------
 * The --geometry listing
 * ------------------------------------------------------------------------------------------- */

/* Nothing is printed of a quantity whose inputs are missing (NaN), or that no number holds. */
static void print_value(FILE *stream, const char *name, double value) {
    if (isfinite(value)) {
        fprintf(stream, "%s = %.17g\n", name, value);
    }
}

static double degrees(double angle) {
    return angle * (180 / pi);
}

static double millimetres(double length) {
    return length * 1e3;
}

/* K eps_alpha, or that of the simple model (N/m). */
static double mean_stiffness(const gearbox *box, const config *conf) {
    return conf->model == MODEL_SIMPLE ? box->simple_stiffness
                                       : conf->stiffness * box->pair.transverse_contact_ratio;
}

/* Of the wheel on the mesh if the pinion's speed is prescribed, else of both bodies against each other (Hz). */
static double eigenfrequency(const gearbox *box, const config *conf) {
    const double r_bp = box->pair.pinion.base_radius;
    const double r_bw = box->pair.wheel.base_radius;
    double mobility = r_bw * r_bw / conf->wheel_inertia;

    if (conf->drive == DRIVE_TORQUE) {
        mobility += r_bp * r_bp / conf->pinion_inertia;
    }
    return sqrt(mean_stiffness(box, conf) * mobility) / (2 * pi);
}

static void print_pair(const gm_pair *pair, FILE *stream) {
    print_value(stream, "transverse_module_mm", millimetres(pair->transverse_module));
    print_value(stream, "transverse_pressure_angle_deg", degrees(pair->transverse_pressure_angle));
    print_value(stream, "working_pressure_angle_deg", degrees(pair->working_pressure_angle));
    print_value(stream, "base_helix_angle_deg", degrees(pair->base_helix_angle));
    print_value(stream, "reference_center_distance_mm",
                millimetres(pair->reference_center_distance));
    print_value(stream, "pinion_profile_shift", pair->pinion.profile_shift);
    print_value(stream, "wheel_profile_shift", pair->wheel.profile_shift);
    print_value(stream, "pinion_base_radius_mm", millimetres(pair->pinion.base_radius));
    print_value(stream, "wheel_base_radius_mm", millimetres(pair->wheel.base_radius));
    print_value(stream, "pinion_tip_radius_mm", millimetres(pair->pinion.tip_radius));
    print_value(stream, "wheel_tip_radius_mm", millimetres(pair->wheel.tip_radius));
    print_value(stream, "pinion_start_radius_mm", millimetres(pair->pinion.start_radius));
    print_value(stream, "wheel_start_radius_mm", millimetres(pair->wheel.start_radius));
    print_value(stream, "transverse_base_pitch_mm", millimetres(pair->transverse_base_pitch));
    print_value(stream, "line_of_action_mm", millimetres(pair->line_of_action));
    print_value(stream, "path_start_mm", millimetres(pair->path_start));
    print_value(stream, "path_end_mm", millimetres(pair->path_end));
    print_value(stream, "transverse_contact_ratio", pair->transverse_contact_ratio);
    print_value(stream, "overlap_ratio", pair->overlap_ratio);
    print_value(stream, "total_contact_ratio", pair->total_contact_ratio);
    print_value(stream, "backlash_um", 1e6 * pair->backlash);
}

void gearbox_print_geometry(const gearbox *box, const config *conf, FILE *stream) {
    print_pair(&box->pair, stream);
    print_value(stream, "mean_mesh_stiffness_N_per_um", 1e-6 * mean_stiffness(box, conf));
    print_value(stream, "eigenfrequency_Hz", eigenfrequency(box, conf));
    print_value(stream, "mesh_frequency_per_rpm_Hz", box->pair.pinion.teeth / 60.0);
}

static void note_value(config *conf, const char *flank, const char *what, double value) {
    char name[64];

    snprintf(name, sizeof name, "%s_modification_%s", flank, what);
    config_note(conf, name, value);
}

/* What holds a design. */
static void note_form(config *conf, const char *flank, const design_form *form) {
    if (form->ramps == 0 && form->grid.face_nodes == 0) {
        return;
    }
    note_value(conf, flank, "ramps", form->ramps);
    if (form->grid.face_nodes > 0) {
        note_value(conf, flank, "face_nodes", form->grid.face_nodes);
        note_value(conf, flank, "profile_nodes", form->grid.profile_nodes);
    }
    note_value(conf, flank, "error_um", 1e6 * form->grid.error);
}

void gearbox_note(const gearbox *box, config *conf) {
    const double frequency = eigenfrequency(box, conf);

    for (int gear = 0; gear < 2; ++gear) {
        for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
            note_form(conf, flank_names[gear][side], &box->design_form[gear][side]);
        }
    }

    if (isfinite(frequency)) {
        config_note(conf, "eigenfrequency_Hz", frequency);
    }
}
