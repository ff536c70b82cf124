/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file flank_generate.h
 * What the two ways to make flanks share.
 */
#ifndef GEARMESH_FLANK_GENERATE_H
#define GEARMESH_FLANK_GENERATE_H

#include "flank_random.h"
#include "gearmesh/gearmesh_io.h"

/** Limits of the grid. */
#define GMI_LEAST_NODES 9
#define GMI_MOST_NODES  1000

/** Nodes that a wave needs. */
#define GMI_NODES_PER_WAVE 4

typedef struct gmi_generator {
    gm_deviations
        *deviations; /**< a set for every flank, tooth by tooth; their values are to be filled */
    gm_pitch *pitch; /**< to be filled */
    const gm_pair *pair;
    const gm_gear *gear;
    int wheel; /**< 0 or 1 */
    const gm_generate_options *options;
    gmi_random random;
    double *wave_phase; /**< [2 * wave_count] turns, of both sides */
    double *work;       /**< [3 * teeth], and at least [6 * GMI_MOST_NODES] */
    gm_io_error *error;
} gmi_generator;

/** Sum of all waves at the nodes of a set, along the normal; replaces what is there. */
void gmi_waves_fill(const gmi_generator *make, const gm_deviation_set *set);

/** Flanks of a class: checks the options that it alone has, and fills deviations and pitch. */
int gmi_class_check(const gmi_generator *make);
int gmi_class_fill(gmi_generator *make);

/** Flanks that scatter: likewise. */
int gmi_scatter_check(const gmi_generator *make);
void gmi_scatter_fill(gmi_generator *make);

#endif /* GEARMESH_FLANK_GENERATE_H */
