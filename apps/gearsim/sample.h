/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * One sample of a dynamic run: where the gears are at its time and what the mesh does there. With it all that is kept from
 * sample to sample, which sample_means.c and sampling.c work on.
 */
#ifndef GEARSIM_SAMPLE_H
#define GEARSIM_SAMPLE_H

#include "decimate.h"
#include "dynamic_columns.h"
#include "integrate.h"

/* What means about a sample begin from, and what is the same for all of them. */
typedef struct means_state {
    int is_steady; /* nothing but noise and mesh changes what acts: it is in `steady` */
    model_torques steady;
    double penetration_by_force, penetration_by_rate; /* what an overlap follows from (m/N, s) */

    /* The edge: where the mean of the sample before has its end or its middle. */
    int is_started; /* there is a sample before */
    double edge_time;
    gear_motion edge;
    double edge_momentum; /* of boxes alone, */
    double edge_given;    /* and what the noise has given up to there */
    gear_motion next;     /* at the next sample, where a triangle has ended */

    /* See integrator_point: where the mean begins, and up to where it is known. */
    double touched[2];

    /* Of the part since the edge, up to a time: integrals of the torques, and of them times the share of it that is over. */
    double gathered_time;
    model_torques gathered[2];
    model_torques rising; /* the second over the side of a triangle before its middle */
    noise_piece noise;    /* of the load, about the last mean */
} means_state;

typedef struct sampling {
    const config *conf;
    const gear_model *model;
    integrator *solver;
    decimator *filter;
    int factor; /* samples per row, */
    double centre_share
        [MODEL_EDGES_MAX]; /* parts of a row's period from a row to the next samples of a block, */
    double box_end_share[MODEL_EDGES_MAX]; /* and to where their boxes end */

    /* The columns that are asked for: what is taken of a sample, and of which one. */
    int column_count;
    double (*show[COLUMNS_MAX])(const dynamic_sample *sample);
    const dynamic_sample *shown[COLUMNS_MAX];
    int filtered_count;              /* of these columns are filtered, */
    int filtered_first[COLUMNS_MAX]; /* in front of the others in this order */

    /* What they need. */
    enum column_need row_need;    /* the most at the time of a row, */
    enum column_need sample_need; /* and between the rows; */
    int counts_pairs;             /* and the pairs that touch at the time of a row */
    enum sample_kind mean_kind;   /* of the columns that show means, SAMPLE_PLAIN: none does */
    int shows_means;              /* of force or load, */
    int shows_load;               /* and of the load */
    int shows_overlap;            /* of the penetration or of its rate */
    int follows;                  /* means of drive or load depend on the motion */
    int edge_wanted;              /* of the motion at the edges of boxes */
    int takes_blocks;             /* between rows nothing is needed but edges, see sampling.c, */
    int is_plain_box;             /* where nothing but noise changes what acts; */
    int is_force_alone;           /* and of them nothing but the means of the force */

    /* What is known now. */
    dynamic_sample sample;
    dynamic_sample behind; /* time and motion half a period behind it, where its box ends */
    means_state means;
    double values[COLUMNS_MAX];                  /* of the sample, */
    double block[COLUMNS_MAX * MODEL_EDGES_MAX]; /* and of a block of samples, column by column */
    gear_motion hardest;  /* the sample with the largest force of elastic teeth, */
    double hardest_force; /* and that force (N) */
    char why[640];        /* no more samples can be taken */
} sampling;

/* Time of a sample: divided once, so that k / rate is the time of row k to the last bit. */
static inline double time_of_share(const sampling *s, double row, double share) {
    return (row + share) / s->conf->output_rate;
}

static inline double sample_time(const sampling *s, double row, double sample) {
    return time_of_share(s, row, sample / s->factor);
}

/*
 * States of the solver at some times, or the motion at one; the solver only goes forward. Returns 0, or EXIT_RUN_FAILED or
 * EXIT_INTERRUPTED with the reason in `why`.
 */
int sample_points(sampling *s, int count, const double times[], integrator_point points[]);
int sample_motion(sampling *s, double time, gear_motion *motion);

/* Whether the motion of a row takes a state of the solver. */
static inline int row_needs_state(const sampling *s) {
    return s->row_need >= NEEDS_MOTION || s->model->states == STATES_MAX;
}

/* The mesh at the time and motion of the sample; of one that is a row's, what rows need. Both return 0, or EXIT_RUN_FAILED
 * with the reason in `why`. */
int sample_mesh(sampling *s, enum column_need need);
int sample_row(sampling *s);

#endif
