/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file generator.h
 * What the two ways to make flanks share.
 */
#ifndef GEARMESH_GENERATOR_H
#define GEARMESH_GENERATOR_H

#include "gearmesh/gearmesh_io.h"
#include "random.h"

/** Limits of the grid. */
#define GMI_LEAST_NODES 9
#define GMI_MOST_NODES  1000

/** Nodes that a wave needs. */
#define GMI_NODES_PER_WAVE 4

typedef struct gmi_generator {
    /** a set for every flank, tooth by tooth; their values are to be filled */
    gm_deviations *deviations;

    gm_pitch *pitch; /**< to be filled */
    const gm_pair *pair;
    const gm_gear *gear;
    int wheel; /**< 0 or 1 */
    const gm_generate_options *options;
    uint64_t random;
    double *wave_phase; /**< [2 * wave_count] turns, of both sides */
    double *work;       /**< [3 * teeth], and at least [6 * GMI_MOST_NODES] */
    gm_io_error *error;
} gmi_generator;

#endif /* GEARMESH_GENERATOR_H */
