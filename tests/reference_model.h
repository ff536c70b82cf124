/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file reference_model.h
 * A second evaluation of the contact model for the tests: slow, plain and in long double.
 *
 * Written from the statement of the model in libgearmesh/docs/conventions.md alone; it shares no code
 * with the library. It tries all teeth, cuts every contact line at every grid line of both tables and at every
 * edge of a linear relief, and integrates piece by piece. Of gearmesh.h it uses nothing but the struct of parameters.
 */
#ifndef REFERENCE_MODEL_H
#define REFERENCE_MODEL_H

#include "gearmesh/gearmesh.h"

/** Geometry of a pair. Index 0 = pinion, 1 = wheel. */
typedef struct model_pair {
    int teeth[2];
    int is_ring; /**< the wheel is an internal gear; all lengths are above 0 */
    long double transverse_module;
    long double alpha_t;
    long double alpha_wt;
    long double beta_b;
    long double reference_radius[2];
    long double base_radius[2];
    long double tip_radius[2];
    long double start_radius[2];
    long double rho_start[2]; /**< roll length at the start radius (m) */
    long double rho_end[2];   /**< roll length at the tip (m) */
    long double shift[2];     /**< profile shift */
    long double normal_thickness[2];
    long double psi[2]; /**< half tooth thickness angle on the base circle (rad) */
    long double center_distance;
    long double line_of_action; /**< T0 (m) */
    long double base_pitch;     /**< p_bt (m) */
    long double face_width;
    long double face_advance; /**< b tan(beta_b) (m) */
    long double backlash;     /**< transverse, along the line of action (m) */
} model_pair;

/** Deviations of one flank; nodes = 0: ideal. */
typedef struct model_table {
    int face_nodes;
    int profile_nodes;
    const double *values; /**< [face_nodes][profile_nodes] (m) */
    long double factor;
} model_table;

/** A linear relief: max(0, factor (offset + per_t1 t1 + per_t2 t2)) of material are missing (m). */
typedef struct model_ramp {
    long double factor;
    double offset, per_t1, per_t2;
} model_ramp;

enum { MODEL_RAMPS = 16 };

/** Deviations of one gear. Index 0 = drive, 1 = coast; then the tooth, or the ramp of all teeth. */
typedef struct model_flanks {
    model_table *table[2];
    double *pitch[2];
    model_ramp ramp[2][MODEL_RAMPS];
    int ramp_count[2];
} model_flanks;

/** Result; index 0 = drive, 1 = coast. */
typedef struct model_result {
    long double offset;         /**< x (m) */
    long double sum[2];         /**< over pairs: integral over t1 of max(0, delta) (m) */
    long double overlap[2];     /**< over pairs: length in t1 where both flanks exist */
    long double contact[2];     /**< over pairs: length in t1 where they touch */
    int pairs[2];               /**< pairs that touch somewhere */
    long double square[2];      /**< over pairs: integral over t1 of max(0, delta)^2 (m2) */
    long double largest[2];     /**< largest delta (m) */
    long double sum_t1[2];      /**< over pairs: integral of t1 max(0, delta) (m) */
    long double sum_rho[2];     /**< over pairs: integral of ideal rho_p max(0, delta) (m2) */
    long double contact_t1[2];  /**< over pairs: integral of t1 where they touch */
    long double contact_rho[2]; /**< over pairs: integral of ideal rho_p where they touch (m) */
} model_result;

/** Derives the geometry; paper_base_helix as gm_pair_params.base_helix. */
void model_pair_init(model_pair *pair, const gm_pair_params *params);

/** Evaluates; NULL flanks = ideal. Angles that are doubles are reduced without any loss.
 *
 *  The two shifts widen the contact: `approach` is added to every delta, `border` extends the range of
 *  every rho at both ends (m). All results grow with both, so that evaluations with -e and +e enclose
 *  what may come out if lengths are uncertain by e.
 */
void model_evaluate(const model_pair *pair, const model_flanks *pinion, const model_flanks *wheel,
                    long double pinion_angle, long double wheel_angle, long double approach,
                    long double border, model_result *result);

/** Length of the path of contact at zero penetration (m); <= 0 if the tips do not reach. */
long double model_path_length(const model_pair *pair);

#endif /* REFERENCE_MODEL_H */
