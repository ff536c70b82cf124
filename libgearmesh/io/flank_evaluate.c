/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Tolerances, measured values and classes of flanks after ISO 1328-1:2013; docs/flank-quality.md. */

#include <math.h>
#include <stdlib.h>

#include "deviation_file.h"
#include "flank_slot.h"
#include "flank_trace.h"
#include "io_error.h"
#include "measurement.h"
#include "pitch_file.h"

static const double pi = 3.14159265358979323846;

/* Class of a value beyond the last tolerance. */
#define BEYOND_CLASSES (GM_QUALITY_WORST_CLASS + 1)

static int kind_exists(int kind) {
    return kind >= 0 && kind < GM_QUALITY_KINDS;
}

const char *gm_quality_symbol(int kind) {
    static const char *const symbol[GM_QUALITY_KINDS] = {
        "f_p", "F_p", "F_r", "f_H_alpha", "f_f_alpha", "F_alpha", "f_H_beta", "f_f_beta", "F_beta"};
    return kind_exists(kind) ? symbol[kind] : "unknown";
}

/* ---------------------------------------------------------------------------------------------
 * Tolerances
 * ------------------------------------------------------------------------------------------- */

/* Class 5, not rounded, from reference diameter, normal module and face width in mm; um [5.3, annex for F_r]. */
static double base_tolerance(int kind, double d, double m, double b) {
    switch (kind) {
    case GM_QUALITY_SINGLE_PITCH:
        return 0.001 * d + 0.4 * m + 5.0;
    case GM_QUALITY_TOTAL_PITCH:
        return 0.002 * d + 0.55 * sqrt(d) + 0.7 * m + 12.0;
    case GM_QUALITY_RUN_OUT:
        return 0.9 * base_tolerance(GM_QUALITY_TOTAL_PITCH, d, m, b);
    case GM_QUALITY_PROFILE_SLOPE:
        return 0.4 * m + 0.001 * d + 4.0;
    case GM_QUALITY_PROFILE_FORM:
        return 0.55 * m + 5.0;
    case GM_QUALITY_HELIX_SLOPE:
        return 0.05 * sqrt(d) + 0.35 * sqrt(b) + 4.0;
    case GM_QUALITY_HELIX_FORM:
        return 0.07 * sqrt(d) + 0.45 * sqrt(b) + 4.0;
    default: { /* totals, from what is not rounded; their kinds follow those of slope and form */
        const double slope = base_tolerance(kind - 2, d, m, b);
        const double form = base_tolerance(kind - 1, d, m, b);
        return sqrt(slope * slope + form * form);
    }
    }
}

/* sqrt(2)^steps */
static double class_factor(int steps) {
    const int odd = (steps % 2 + 2) % 2;
    return ldexp(odd ? sqrt(2.0) : 1.0, (steps - odd) / 2);
}

/* Above 10 um to 1 um, from 5 um to 0.5 um, below to 0.1 um [5.2.3]; um -> m. */
static double rounded(double um) {
    const double tenths = um > 10.0 ? 10.0 : um >= 5.0 ? 5.0 : 1.0;
    return floor(10.0 * um / tenths + 0.5) * tenths / 1e7;
}

double gm_quality_tolerance(const gm_pair *pair, int wheel, int kind, int quality_class) {
    if (pair == NULL || !kind_exists(kind) || quality_class < GM_QUALITY_BEST_CLASS ||
        quality_class > GM_QUALITY_WORST_CLASS) {
        return (double)NAN;
    }
    const double diameter = 2e3 * gmi_gear_of(pair, wheel)->reference_radius;
    const double tolerance =
        base_tolerance(kind, diameter, 1e3 * pair->normal_module, 1e3 * pair->face_width);
    return rounded(tolerance * class_factor(quality_class - 5));
}

int gm_quality_is_in_scope(const gm_pair *pair, int wheel) {
    if (pair == NULL) {
        return 0;
    }
    /* Limits are meant to be reached: a rounding error must not count. */
    const double slack = 1e-12;
    const gm_gear *gear = gmi_gear_of(pair, wheel);
    const double value[] = {gear->teeth, 2.0 * gear->reference_radius, pair->normal_module,
                            pair->face_width, fabs(pair->helix_angle)};
    static const double low[] = {5.0, 5e-3, 0.5e-3, 4e-3, 0.0};
    const double high[] = {1000.0, 15.0, 70e-3, 1.2, pi / 4.0};
    for (int i = 0; i < 5; i++) {
        if (!(value[i] >= low[i] - slack && value[i] <= high[i] + slack)) {
            return 0;
        }
    }
    return 1;
}

static int class_of(const gm_pair *pair, int wheel, int kind, double value) {
    int quality_class = GM_QUALITY_BEST_CLASS;
    while (quality_class < BEYOND_CLASSES &&
           value > gm_quality_tolerance(pair, wheel, kind, quality_class)) {
        quality_class++;
    }
    return quality_class;
}

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
    for (int kind = 0; kind < GM_QUALITY_KINDS; kind++) {
        quality->worst[kind] = none;
    }
    quality->quality_class = 0;
}

static void clear_flanks(const evaluation *of) {
    const double no = (double)NAN;
    const gm_flank_quality none = {no, no, no, no, no, no, no, no};
    for (int i = 0; i < 2 * of->gear->teeth; i++) {
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
    for (int tooth = 0; tooth < teeth; tooth++) {
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
    for (int tooth = 0; tooth < of->gear->teeth; tooth++) {
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
    for (int k = 0; k < GMI_CANDIDATES && set < 0; k++) {
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
    for (int i = 0; i < 2 * of->gear->teeth; i++) {
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

static void find_classes(const evaluation *of) {
    gm_quality *quality = of->quality;
    for (int kind = 0; kind < GM_QUALITY_KINDS; kind++) {
        gm_quality_value *worst = &quality->worst[kind];
        if (!isnan(worst->value)) {
            worst->quality_class = class_of(of->pair, of->wheel, kind, worst->value);
        }
        if (worst->quality_class > quality->quality_class) {
            quality->quality_class = worst->quality_class;
        }
    }
}

static int check_teeth(const evaluation *of, int teeth, const char *what, gm_io_error *error) {
    return teeth == of->gear->teeth
               ? GM_IO_OK
               : gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                               "the %s deviations are for %d teeth; the gear has %d", what, teeth,
                               of->gear->teeth);
}

static int check_inputs(evaluation *of, const gm_deviations *deviations, const gm_pitch *pitch,
                        const gm_quality_options *options, gm_io_error *error) {
    int status = gmi_check_teeth(of->gear->teeth, error);
    if (status == GM_IO_OK) {
        status = gmi_trace_ranges(of->range, of->pair, options, error);
    }
    if (status == GM_IO_OK && deviations != NULL) {
        status = check_teeth(of, deviations->teeth, "flank", error);
    }
    if (status == GM_IO_OK && pitch != NULL) {
        status = check_teeth(of, pitch->teeth, "pitch", error);
    }
    return status == GM_IO_OK && pitch != NULL ? gmi_pitch_check(pitch, error) : status;
}

static int evaluate(evaluation *of, const gm_deviations *deviations, const gm_pitch *pitch,
                    const gm_quality_options *options, gm_io_error *error) {
    int status = check_inputs(of, deviations, pitch, options, error);
    if (status != GM_IO_OK) {
        return status;
    }
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
        return gmi_error_set(error, GM_IO_ERR_NULL, 0, "a required pointer is NULL");
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
