/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From the contents of flank files to the prepared flanks of a gear: which set serves which tooth, what
 * scale and profile window make of its nodes, and the designed modifications on top.
 */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "files/deviation_file.h"
#include "files/flank_slot.h"
#include "files/io_error.h"
#include "files/pitch_file.h"
#include "flank_design.h"

/* What all steps of one build share. */
typedef struct builder {
    gm_flanks *flanks;
    int teeth;
    const gm_deviations *deviations; /* NULL = none */
    const int *set_of_slot;          /* set of every slot, -1 = none */
    const gm_flanks_options *options;
    double *nodes;        /* [face_nodes][profile_nodes] one set, scaled; NULL without deviations */
    gmi_design design[2]; /* of the drive and of the coast side */
    double *table;        /* room for one table of either design */
    gm_io_error *error;
} builder;

void gm_flanks_options_default(gm_flanks_options *options) {
    if (options != NULL) {
        options->scale = 1.0;
        options->normal_factor = 1.0;
        options->profile_from = 0.0;
        options->profile_to = 1.0;
        options->profile_blend = 0.1;
        options->drive_modifications = NULL;
        options->coast_modifications = NULL;
        options->modification_tolerance = 1e-8;
    }
}

static int check_options(const gm_flanks_options *options, gm_io_error *error) {
    const char *wrong = NULL;

    /* One option at fault is named, the last of them. */
    if (!isfinite(options->scale)) {
        wrong = "the scale must be finite";
    }
    if (!(options->normal_factor > 0.0) || !isfinite(options->normal_factor)) {
        wrong = "the normal factor must be finite and above 0";
    }
    if (!isfinite(options->profile_from) || !isfinite(options->profile_to) ||
        !(options->profile_from < options->profile_to)) {
        wrong = "the profile window must be finite and begin before it ends";
    }
    if (!(options->profile_blend >= 0.0) || !isfinite(options->profile_blend)) {
        wrong = "the profile blend must be finite and not below 0";
    }

    return wrong == NULL ? GM_IO_OK
                         : gmi_error_set(error, GM_IO_ERR_OPTION, 0, "flank options: %s", wrong);
}

/* ---------------------------------------------------------------------------------------------
 * Which set serves which tooth
 * ------------------------------------------------------------------------------------------- */

/* The set of the tooth's own, -1 = none. */
static int own_set(const builder *build, int tooth, int side) {
    const int set = build->set_of_slot[gmi_slot_candidate(tooth, side, 0)];
    return set >= 0 ? set : build->set_of_slot[gmi_slot_candidate(tooth, side, 1)];
}

/* The set that all teeth without one of their own share, -1 = none. */
static int shared_set(const builder *build, int side) {
    const int set = build->set_of_slot[gmi_slot(GMI_ALL, side)];
    return set >= 0 ? set : build->set_of_slot[gmi_slot(GMI_ALL, GMI_ALL)];
}

static int has_design_table(const builder *build, int side) {
    return build->design[side].values != NULL;
}

/* A shared set takes one place, however many teeth it serves; so does the design of teeth without a set. */
static int count_tables(const builder *build, int side) {
    int tables = has_design_table(build, side);
    if (build->deviations == NULL) {
        return tables;
    }
    tables = tables || shared_set(build, side) >= 0;
    for (int tooth = 0; tooth < build->teeth; ++tooth) {
        tables += own_set(build, tooth, side) >= 0 ? 1 : 0;
    }
    return tables;
}

/* ---------------------------------------------------------------------------------------------
 * What becomes of a table
 * ------------------------------------------------------------------------------------------- */

/* 1 inside the profile window, falling linearly to 0 over the width of the blend outside. */
static double window_weight(const gm_flanks_options *options, double t2) {
    const double below = options->profile_from - t2;
    const double above = t2 - options->profile_to;
    const double outside = below > above ? below : above;
    if (outside <= 0.0) {
        return 1.0;
    }
    return outside < options->profile_blend ? 1.0 - outside / options->profile_blend : 0.0;
}

static void fill_nodes(const builder *build, const double *values) {
    const int face_nodes = build->deviations->face_nodes;
    const int profile_nodes = build->deviations->profile_nodes;
    for (int profile = 0; profile < profile_nodes; ++profile) {
        const double t2 = (double)profile / (profile_nodes - 1);
        const double factor = build->options->scale * window_weight(build->options, t2);
        for (int face = 0; face < face_nodes; ++face) {
            const size_t node = (size_t)face * (size_t)profile_nodes + (size_t)profile;
            build->nodes[node] = factor * values[node];
        }
    }
}

/* The table of a set with that of the design on top; set -1 = the latter alone. */
static const double *make_table(const builder *build, int side, int set) {
    if (set >= 0) {
        fill_nodes(build, build->deviations->sets[set].values);
    }
    if (!has_design_table(build, side)) {
        return build->nodes;
    }
    gmi_design_table(&build->design[side], set >= 0 ? build->nodes : NULL, build->table);
    return build->table;
}

static int fail_design(const builder *build, int status) {
    return gmi_error_set(build->error, GM_IO_ERR_OPTION, 0,
                         "the modifications cannot be used with these options: %s",
                         gm_status_text(status));
}

static int set_ramps(const builder *build, int side) {
    const gmi_design *design = &build->design[side];
    const int status = gm_flanks_set_ramps(build->flanks, side, design->ramps, design->ramp_count,
                                           build->options->normal_factor);
    return status == GM_OK ? GM_IO_OK : fail_design(build, status);
}

static int set_table(const builder *build, int side, int tooth, int set) {
    const int status = gm_flanks_set_table(build->flanks, side, tooth, make_table(build, side, set),
                                           build->options->normal_factor);
    if (status == GM_OK) {
        return GM_IO_OK;
    }
    if (set < 0) {
        return fail_design(build, status);
    }
    return gmi_error_set(build->error, GM_IO_ERR_OPTION, 0,
                         "set %d of the deviations cannot be used with these options: %s", set,
                         gm_status_text(status));
}

static int set_side(const builder *build, int side) {
    const int has_sets = build->deviations != NULL;
    int status = set_ramps(build, side);
    const int shared = has_sets ? shared_set(build, side) : -1;
    if (status == GM_IO_OK && (shared >= 0 || has_design_table(build, side))) {
        status = set_table(build, side, GM_ALL_TEETH, shared);
    }
    for (int tooth = 0; has_sets && status == GM_IO_OK && tooth < build->teeth; ++tooth) {
        const int own = own_set(build, tooth, side);
        if (own >= 0) {
            status = set_table(build, side, tooth, own);
        }
    }
    return status;
}

static int set_pitch(const builder *build, int side, const double *deviation, const int *set) {
    for (int tooth = 0; tooth < build->teeth; ++tooth) {
        if (!set[tooth]) {
            continue;
        }

        const int status = gm_flanks_set_pitch(build->flanks, side, tooth,
                                               build->options->scale * deviation[tooth]);
        if (status != GM_OK) {
            return gmi_error_set(build->error, GM_IO_ERR_OPTION, 0,
                                 "the pitch deviation of tooth %d cannot be used with this scale: "
                                 "%s",
                                 tooth, gm_status_text(status));
        }
    }
    return GM_IO_OK;
}

/* ---------------------------------------------------------------------------------------------
 * The build
 * ------------------------------------------------------------------------------------------- */

/* Grid lines of one side along t1 (axis 0) or t2 (axis 1). */
static int grid_nodes(const builder *build, int side, int axis) {
    if (has_design_table(build, side)) {
        return build->design[side].nodes[axis];
    }
    if (build->deviations == NULL) {
        return 0;
    }
    return axis == 0 ? build->deviations->face_nodes : build->deviations->profile_nodes;
}

static gm_flanks_params sizes_of(const builder *build) {
    gm_flanks_params params;
    memset(&params, 0, sizeof params);
    params.teeth = build->teeth;
    params.drive_tables = count_tables(build, GM_DRIVE);
    params.coast_tables = count_tables(build, GM_COAST);
    params.drive_face_nodes = grid_nodes(build, GM_DRIVE, 0);
    params.drive_profile_nodes = grid_nodes(build, GM_DRIVE, 1);
    params.coast_face_nodes = grid_nodes(build, GM_COAST, 0);
    params.coast_profile_nodes = grid_nodes(build, GM_COAST, 1);
    return params;
}

/* Allocates the flanks and prepares them as ideal. */
static int make_ideal(builder *build) {
    /* The size in bytes, which is 0 where it would not fit a size_t. */
    const gm_flanks_params params = sizes_of(build);
    const size_t size = gm_flanks_size(&params);
    if (size == 0) {
        return gmi_error_set(
            build->error, GM_IO_ERR_OPTION, 0,
            "the flank tables of %d teeth must fit into memory (got too large ones)", build->teeth);
    }

    /* The flanks lie in memory of their own; who gets them frees it. */
    void *memory = malloc(size);
    if (memory == NULL) {
        return gmi_error_memory(build->error);
    }
    const int status = gm_flanks_init(&build->flanks, &params, memory, size);
    if (status != GM_OK) {
        free(memory);
        return gmi_error_set(build->error, GM_IO_ERR_OPTION, 0, "the flanks cannot be prepared: %s",
                             gm_status_text(status));
    }
    return GM_IO_OK;
}

static int allocate_table(double **table, size_t nodes, gm_io_error *error) {
    if (nodes > 0) {
        *table = malloc(nodes * sizeof **table);
    }
    return nodes == 0 || *table != NULL ? GM_IO_OK : gmi_error_memory(error);
}

static size_t design_size(const gmi_design *design) {
    return design->values == NULL ? 0 : (size_t)design->nodes[0] * (size_t)design->nodes[1];
}

/* Room for one table of a set, and for one with the design on top. */
static int allocate_tables(builder *build) {
    const size_t drive = design_size(&build->design[GM_DRIVE]);
    const size_t coast = design_size(&build->design[GM_COAST]);
    size_t set = 0;
    if (build->deviations != NULL) {
        set = (size_t)build->deviations->face_nodes * (size_t)build->deviations->profile_nodes;
    }
    const int status = allocate_table(&build->nodes, set, build->error);
    return status == GM_IO_OK
               ? allocate_table(&build->table, drive > coast ? drive : coast, build->error)
               : status;
}

static int fill_flanks(builder *build, const gm_pitch *pitch) {
    int status = allocate_tables(build);
    if (status == GM_IO_OK) {
        status = set_side(build, GM_DRIVE);
    }
    if (status == GM_IO_OK) {
        status = set_side(build, GM_COAST);
    }

    if (status == GM_IO_OK && pitch != NULL) {
        status = set_pitch(build, GM_DRIVE, pitch->drive, pitch->drive_set);
    }
    if (status == GM_IO_OK && pitch != NULL) {
        status = set_pitch(build, GM_COAST, pitch->coast, pitch->coast_set);
    }

    free(build->nodes);
    free(build->table);
    build->nodes = build->table = NULL;
    return status;
}

static int make_design(builder *build, int side) {
    const gm_modifications *modifications = side == GM_DRIVE ? build->options->drive_modifications
                                                             : build->options->coast_modifications;
    const int is_for_gear = modifications == NULL || modifications->gear == NULL ||
                            modifications->gear->teeth == build->teeth;
    if (!is_for_gear) {
        return gmi_error_set(build->error, GM_IO_ERR_OPTION, 0,
                             "the modifications must be for the %d teeth of the gear (got %d)",
                             build->teeth, modifications->gear->teeth);
    }
    return gmi_design_make(&build->design[side], modifications, build->deviations,
                           build->options->modification_tolerance, build->error);
}

static int check_inputs(int teeth, const gm_deviations *deviations, const gm_pitch *pitch,
                        const gm_flanks_options *options, gm_io_error *error) {
    int status = gmi_check_teeth(teeth, error);
    if (status == GM_IO_OK) {
        status = check_options(options, error);
    }
    if (status == GM_IO_OK && deviations != NULL) {
        status = gmi_check_same_teeth(teeth, deviations->teeth, "flank", error);
    }
    if (status == GM_IO_OK && pitch != NULL) {
        status = gmi_check_same_teeth(teeth, pitch->teeth, "pitch", error);
    }
    return status == GM_IO_OK && pitch != NULL ? gmi_pitch_check(pitch, error) : status;
}

/* What holds the design of a side. */
static gm_flanks_side_report report_of(const gmi_design *design) {
    gm_flanks_side_report report = {.ramps = design->ramp_count};

    if (design->values != NULL) {
        report.face_nodes = design->nodes[0];
        report.profile_nodes = design->nodes[1];
        report.error = design->error;
    }
    return report;
}

/* On an error the flanks may be there and half done: for the caller to free. */
static int build_flanks(builder *build, const gm_pitch *pitch, gm_flanks_report *report) {
    int *set_of_slot = NULL;
    int status = check_inputs(build->teeth, build->deviations, pitch, build->options, build->error);
    if (status == GM_IO_OK && build->deviations != NULL) {
        status = gmi_deviations_index(build->deviations, &set_of_slot, build->error);
        build->set_of_slot = set_of_slot;
    }

    /* The sizes of the designs have to be known before the memory. */
    for (int side = GM_DRIVE; status == GM_IO_OK && side <= GM_COAST; ++side) {
        status = make_design(build, side);
    }
    if (status == GM_IO_OK) {
        status = make_ideal(build);
    }
    if (status == GM_IO_OK) {
        status = fill_flanks(build, pitch);
    }
    if (status == GM_IO_OK && report != NULL) {
        report->drive = report_of(&build->design[GM_DRIVE]);
        report->coast = report_of(&build->design[GM_COAST]);
    }

    gmi_design_free(&build->design[GM_DRIVE]);
    gmi_design_free(&build->design[GM_COAST]);
    free(set_of_slot);
    return status;
}

int gm_flanks_build(gm_flanks **flanks, int teeth, const gm_deviations *deviations,
                    const gm_pitch *pitch, const gm_flanks_options *options,
                    gm_flanks_report *report, gm_io_error *error) {
    gmi_error_begin(error, NULL);
    if (report != NULL) {
        memset(report, 0, sizeof *report);
    }
    if (flanks == NULL) {
        return gmi_error_null(error);
    }
    *flanks = NULL;

    gm_flanks_options defaults;
    gm_flanks_options_default(&defaults);
    builder build = {.teeth = teeth,
                     .deviations = deviations,
                     .options = options != NULL ? options : &defaults,
                     .error = error};
    const int status = build_flanks(&build, pitch, report);
    if (status == GM_IO_OK) {
        *flanks = build.flanks;
    } else {
        free(build.flanks);
    }
    return status;
}

void gm_flanks_free(gm_flanks *flanks) {
    free(flanks); /* they begin at their memory */
}
