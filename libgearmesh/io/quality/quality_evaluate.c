/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Measured values and classes of flanks after ISO 1328-1:2013; docs/flank-quality.md. */

#include <math.h>
#include <stdlib.h>

#include "files/deviation_file.h"
#include "files/flank_slot.h"
#include "files/io_error.h"
#include "files/pitch_file.h"
#include "run_out.h"
#include "shared.h"
#include "trace_values.h"

/* ---------------------------------------------------------------------------------------------
 * Evaluation
 * ------------------------------------------------------------------------------------------- */

void gm_quality_options_default(gm_quality_options *options) {
    if (options != NULL) {
        options->profile_from = 0.0;
        options->profile_to = 0.95;
        options->face_margin = (double)NAN;
        options->extrapolate = 1;
        options->end_material = 1;
    }
}

typedef struct evaluation {
    gm_quality *quality;
    gm_flank_quality *flanks; /* [2 * teeth] */
    const gm_pair *pair;
    const gm_gear *gear;
    int wheel;
    gmi_range range[2]; /* of profile and helix */
} evaluation;

static gm_flank_quality *flank_of(const evaluation *of, int tooth, int side) {
    return &of->flanks[side * of->gear->teeth + tooth];
}

static void clear_quality(gm_quality *quality) {
    const gm_quality_value none = {(double)NAN, -1, -1, 0};
    for (int kind = 0; kind < GM_QUALITY_KINDS; ++kind) {
        quality->worst[kind] = none;
    }
    quality->quality_class = 0;
}

static void clear_flanks(const evaluation *of) {
    const double no = (double)NAN;
    const gm_flank_quality none = {no, no, no, no, no, no, no, no};
    for (int i = 0; i < 2 * of->gear->teeth; ++i) {
        of->flanks[i] = none;
    }
}

/* Notes a value of a kind if it is the worst yet; NaN never is. */
static void note(const evaluation *of, int kind, double value, int tooth, int side) {
    gm_quality_value *worst = &of->quality->worst[kind];
    const double size = fabs(value);
    if (size > worst->value || (isnan(worst->value) && !isnan(size))) {
        worst->value = size;
        worst->tooth = tooth;
        worst->side = side;
    }
}

/* ---------------------------------------------------------------------------------------------
 * Pitch and run-out
 * ------------------------------------------------------------------------------------------- */

/* From the material added on a flank to how far it stands ahead, as an arc at the reference circle. */
static double arc_per_material(const evaluation *of, int side) {
    const double ahead = (side == GM_DRIVE) == !of->wheel ? 1.0 : -1.0;
    return ahead * of->gear->reference_radius / of->gear->base_radius;
}

static void evaluate_pitch(const evaluation *of, const double *material, int side) {
    const int teeth = of->gear->teeth;
    const double arc = arc_per_material(of, side);
    double low = (double)INFINITY;
    double high = -(double)INFINITY;
    for (int tooth = 0; tooth < teeth; ++tooth) {
        const double place = arc * material[tooth];
        const double before = arc * material[(tooth + teeth - 1) % teeth];
        gm_flank_quality *flank = flank_of(of, tooth, side);

        flank->single_pitch = place - before;
        flank->cumulative_pitch = place - arc * material[0];
        low = place < low ? place : low;
        high = place > high ? place : high;
        note(of, GM_QUALITY_SINGLE_PITCH, flank->single_pitch, tooth, side);
    }
    note(of, GM_QUALITY_TOTAL_PITCH, high - low, -1, side);
}

/* Radial shift of a ball that touches both flanks of the space at the drive flank of a tooth. */
static double ball_shift(const evaluation *of, const gm_pitch *pitch, int tooth) {
    const int teeth = of->gear->teeth;
    const int neighbour = (tooth + (of->wheel ? teeth - 1 : 1)) % teeth;
    return (pitch->drive[tooth] + pitch->coast[neighbour]) /
           (2.0 * gmi_ball_sine(of->pair, of->gear));
}

static void evaluate_run_out(const evaluation *of, const gm_pitch *pitch) {
    double low = (double)INFINITY;
    double high = -(double)INFINITY;
    int outermost = -1;
    for (int tooth = 0; tooth < of->gear->teeth; ++tooth) {
        const double shift = ball_shift(of, pitch, tooth);
        low = shift < low ? shift : low;
        if (shift > high) {
            high = shift;
            outermost = tooth;
        }
    }
    note(of, GM_QUALITY_RUN_OUT, high - low, outermost, -1);
}

static void evaluate_positions(const evaluation *of, const gm_pitch *pitch) {
    const int teeth = of->gear->teeth;
    const int has_drive = gm_pitch_ideal_teeth(pitch, GM_DRIVE) < teeth;
    const int has_coast = gm_pitch_ideal_teeth(pitch, GM_COAST) < teeth;
    if (has_drive) {
        evaluate_pitch(of, pitch->drive, GM_DRIVE);
    }
    if (has_coast) {
        evaluate_pitch(of, pitch->coast, GM_COAST);
    }
    if (has_drive && has_coast) {
        evaluate_run_out(of, pitch);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Profile and helix
 * ------------------------------------------------------------------------------------------- */

/* The set that serves a flank, -1 = none. */
static int set_of_flank(const int *set_of_slot, int tooth, int side) {
    int set = -1;
    for (int k = 0; k < GMI_CANDIDATES && set < 0; ++k) {
        set = set_of_slot[gmi_slot_candidate(tooth, side, k)];
    }
    return set;
}

static void evaluate_flank(const evaluation *of, const gm_deviations *deviations,
                           const double *table, double *trace, int tooth, int side) {
    const double factor = of->pair->normal_to_transverse;
    gm_flank_quality *flank = flank_of(of, tooth, side);

    gmi_profile_trace(trace, table, deviations->face_nodes, deviations->profile_nodes, factor);
    const gmi_trace_values profile =
        gmi_trace_evaluate(trace, deviations->profile_nodes, &of->range[0]);
    flank->profile_slope = profile.slope;
    flank->profile_form = profile.form;
    flank->profile_total = profile.total;

    gmi_helix_trace(trace, table, deviations->face_nodes, deviations->profile_nodes, factor);
    const gmi_trace_values helix = gmi_trace_evaluate(trace, deviations->face_nodes, &of->range[1]);
    flank->helix_slope = helix.slope;
    flank->helix_form = helix.form;
    flank->helix_total = helix.total;
}

static void note_flank(const evaluation *of, int tooth, int side) {
    const gm_flank_quality *flank = flank_of(of, tooth, side);
    note(of, GM_QUALITY_PROFILE_SLOPE, flank->profile_slope, tooth, side);
    note(of, GM_QUALITY_PROFILE_FORM, flank->profile_form, tooth, side);
    note(of, GM_QUALITY_PROFILE_TOTAL, flank->profile_total, tooth, side);
    note(of, GM_QUALITY_HELIX_SLOPE, flank->helix_slope, tooth, side);
    note(of, GM_QUALITY_HELIX_FORM, flank->helix_form, tooth, side);
    note(of, GM_QUALITY_HELIX_TOTAL, flank->helix_total, tooth, side);
}

static void evaluate_all_flanks(const evaluation *of, const gm_deviations *deviations,
                                const int *set_of_slot, double *trace) {
    for (int i = 0; i < 2 * of->gear->teeth; ++i) {
        const int side = i / of->gear->teeth;
        const int tooth = i % of->gear->teeth;
        const int set = set_of_flank(set_of_slot, tooth, side);
        if (set >= 0) {
            evaluate_flank(of, deviations, deviations->sets[set].values, trace, tooth, side);
            note_flank(of, tooth, side);
        }
    }
}

static int evaluate_deviations(const evaluation *of, const gm_deviations *deviations,
                               gm_io_error *error) {
    int *set_of_slot = NULL;
    const int status = gmi_deviations_index(deviations, &set_of_slot, error);
    if (status != GM_IO_OK) {
        return status;
    }

    /* One trace at a time, along the longer direction at the most. */
    const int nodes = deviations->face_nodes > deviations->profile_nodes
                          ? deviations->face_nodes
                          : deviations->profile_nodes;
    double *trace = malloc((size_t)nodes * sizeof *trace);
    if (trace != NULL) {
        evaluate_all_flanks(of, deviations, set_of_slot, trace);
    }

    free(set_of_slot);
    const int has_memory = trace != NULL;
    free(trace);
    return has_memory ? GM_IO_OK : gmi_error_memory(error);
}

/* ---------------------------------------------------------------------------------------------
 * Classes, and the call
 * ------------------------------------------------------------------------------------------- */

/* Class of a value beyond the last tolerance. */
#define BEYOND_CLASSES (GM_QUALITY_WORST_CLASS + 1)

static int class_of(const gm_pair *pair, int wheel, int kind, double value) {
    int quality_class = GM_QUALITY_BEST_CLASS;
    while (quality_class < BEYOND_CLASSES &&
           value > gm_quality_tolerance(pair, wheel, kind, quality_class)) {
        ++quality_class;
    }
    return quality_class;
}

static void find_classes(const evaluation *of) {
    gm_quality *quality = of->quality;
    for (int kind = 0; kind < GM_QUALITY_KINDS; ++kind) {
        gm_quality_value *worst = &quality->worst[kind];
        if (!isnan(worst->value)) {
            worst->quality_class = class_of(of->pair, of->wheel, kind, worst->value);
        }
        if (worst->quality_class > quality->quality_class) {
            quality->quality_class = worst->quality_class;
        }
    }
}

static int check_inputs(evaluation *of, const gm_deviations *deviations, const gm_pitch *pitch,
                        const gm_quality_options *options, gm_io_error *error) {
    int status = gmi_check_teeth(of->gear->teeth, error);
    if (status == GM_IO_OK) {
        status = gmi_trace_ranges(of->range, of->pair, of->gear, options, error);
    }
    if (status == GM_IO_OK && deviations != NULL) {
        status = gmi_check_same_teeth(of->gear->teeth, deviations->teeth, "flank", error);
    }
    if (status == GM_IO_OK && pitch != NULL) {
        status = gmi_check_same_teeth(of->gear->teeth, pitch->teeth, "pitch", error);
    }
    return status == GM_IO_OK && pitch != NULL ? gmi_pitch_check(pitch, error) : status;
}

static int evaluate(evaluation *of, const gm_deviations *deviations, const gm_pitch *pitch,
                    const gm_quality_options *options, gm_io_error *error) {
    int status = check_inputs(of, deviations, pitch, options, error);
    if (status != GM_IO_OK) {
        return status;
    }

    /* Room for the values of every flank, unless the caller wants them. */
    gm_flank_quality *own = NULL;
    if (of->flanks == NULL) {
        own = malloc(2 * (size_t)of->gear->teeth * sizeof *own);
        of->flanks = own;
    }
    if (of->flanks == NULL) {
        return gmi_error_memory(error);
    }

    clear_flanks(of);
    if (deviations != NULL) {
        status = evaluate_deviations(of, deviations, error);
    }
    if (status == GM_IO_OK && pitch != NULL) {
        evaluate_positions(of, pitch);
    }
    free(own);
    return status;
}

int gm_quality_evaluate(gm_quality *quality, gm_flank_quality *flanks, const gm_pair *pair,
                        int wheel, const gm_deviations *deviations, const gm_pitch *pitch,
                        const gm_quality_options *options, gm_io_error *error) {
    gmi_error_begin(error, NULL);
    if (quality != NULL) {
        clear_quality(quality);
    }
    if (quality == NULL || pair == NULL) {
        return gmi_error_null(error);
    }
    gm_quality_options defaults;
    gm_quality_options_default(&defaults);

    evaluation of = {.quality = quality,
                     .flanks = flanks,
                     .pair = pair,
                     .gear = gmi_gear_of(pair, wheel),
                     .wheel = wheel != 0};
    const int status =
        evaluate(&of, deviations, pitch, options != NULL ? options : &defaults, error);
    if (status == GM_IO_OK) {
        find_classes(&of);
    } else {
        clear_quality(quality);
    }
    return status;
}
