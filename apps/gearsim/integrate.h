/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Integration of a model in time by SUNDIALS, with values at any time wanted interpolated within the
 * solver's steps. It starts again where a table of drive or load has a step: everything else is smooth.
 */
#ifndef GEARSIM_INTEGRATE_H
#define GEARSIM_INTEGRATE_H

#include "model.h"

typedef struct integrator integrator;

typedef struct integrator_options {
    enum solver_method method;
    double relative_tolerance;
    double absolute_tolerance; /* of x (m) */
    double max_step;           /* s, 0 = none */
} integrator_options;

typedef struct integrator_statistics {
    long steps;
    long derivatives; /* evaluations of the right-hand side */
    long looks;       /* evaluations of the mesh ahead of the solver, in free flight */
    long rejected;    /* steps repeated because their error was too large */
} integrator_statistics;

/* The model must stay where it is. NULL: out of memory, or options that SUNDIALS refuses. */
integrator *integrator_create(const gear_model *model, const integrator_options *options,
                              const double start[]);
void integrator_free(integrator *solver);

/*
 * State at a time, which must not be before that of the call before by more than a step. Returns 0,
 * EXIT_RUN_FAILED (see integrator_failure()) or EXIT_INTERRUPTED.
 */
int integrator_advance(integrator *solver, double time, double state[]);

/* The same at several times, one after the other. */
typedef struct integrator_point {
    double state[STATES_MAX];
    double touched;       /* see integrator_touched(), only where it is wanted, */
    double carried_since; /* and since when all that touched has carried, HUGE_VAL = it does not */
} integrator_point;

int integrator_advance_through(integrator *solver, int count, const double times[],
                               int with_touched, integrator_point points[]);

/*
 * What the solver has seen of the contact on its way: the integral over time of the part of the flanks that touches, up to
 * a time within its last step (s), by straight lines from step to step. Returns whether all that touched has carried at all
 * steps since `since`. `erk` keeps no account of it and returns 0.
 */
int integrator_touched(const integrator *solver, double since, double time, double *touched);

/* How far the integration has come (s). */
double integrator_time(const integrator *solver);

/* Why and where it failed. */
const char *integrator_failure(const integrator *solver);

integrator_statistics integrator_counts(const integrator *solver);

#endif
