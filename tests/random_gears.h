/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file random_gears.h
 * Seeded random gear pairs, flanks and states, each for the library and for the second model alike.
 */
#ifndef RANDOM_GEARS_H
#define RANDOM_GEARS_H

#include "gearmesh/gearmesh.h"
#include "reference_model.h"

#include <stdint.h>

/** Flanks of one gear in both forms. */
typedef struct random_flanks {
    gm_flanks *flanks;
    model_flanks model;
    void *memory;
    double *tables[2][200]; /**< node values that model.table points into */
    int table_count[2];
} random_flanks;

/** A pair in both forms; use[] is NULL for a gear without deviations. */
typedef struct random_case {
    gm_pair_params params;
    gm_pair pair;
    model_pair model;
    double amplitude; /**< of the deviations in the transverse section (m) */
    random_flanks flanks[2];
    const gm_flanks *use[2];
    const model_flanks *model_use[2];
    double pinion_angle;
    double wheel_angle;
} random_case;

/** Draws parameters of a pair whose tips reach each other; always succeeds. */
void random_params(uint64_t *seed, gm_pair_params *params, model_pair *model);

/** The same of a pinion in a ring, which gm_pair_init() takes. */
void random_ring_params(uint64_t *seed, gm_pair_params *params, model_pair *model);

/** Draws tables, pitch and ramps for one gear of the pair: 0 = the pinion, 1 = the wheel. */
void random_flanks_make(random_flanks *f, uint64_t *seed, const gm_pair *pair, int wheel,
                        double amplitude);
void random_flanks_free(random_flanks *f);

/** All flanks of a side of the library's form as they were drawn, and `by` higher. */
void random_flanks_grow(const random_flanks *f, int side, double by);

/** Draws a whole case; returns the status of gm_pair_init(). Free it in any case. */
int random_case_make(random_case *c, uint64_t *seed, int with_flanks);
int random_ring_case_make(random_case *c, uint64_t *seed, int with_flanks);

/** Case i of a test of all kinds: every fifth a ring, every fourth with ideal flanks. */
int random_mixed_case_make(random_case *c, uint64_t *seed, int i);
void random_case_free(random_case *c);

/** Sets the angles so that x comes out as asked for, up to the rounding of the wheel angle. */
void random_case_place(random_case *c, double pinion_angle, double offset);

/** Place i of a test: flanks pressed by up to some thousandths of the module, every fifth on the coast side. */
gm_position random_pressed(uint64_t *seed, const gm_pair *pair, int i);

/** A pose of up to some thousandths of the module; the ends of tilted faces move by up to `tilt` base pitches. */
gm_pose random_pose(uint64_t *seed, const gm_pair *pair, double tilt);

#endif /* RANDOM_GEARS_H */
