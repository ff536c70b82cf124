/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * CVODE: Adams or BDF formulas of variable order and step, with a corrector of its own (integrate_corrector.h).
 * Values within a step are those of its polynomial, which is read once in each step that somebody asks about.
 */
#include "integrate_corrector.h"
#include "integrate_package.h"

#include <cvode/cvode.h>
#include <stdlib.h>
#include <string.h>

/* A step is shortened to a quarter so many times in a row, at most: down to 1e-12 of it. */
enum { SHORTENINGS = 20 };

/* Adams formulas go up to order 12. */
enum { ORDERS = 12 };

typedef struct cvode_memory {
    void *cvode;
    SUNNonlinearSolver corrector;
    N_Vector scratch;
    N_Vector reader; /* sees CVODE's polynomial, see read_polynomial() */
    int known;       /* highest order of which CVODE's vector has been seen, -1: none, */
    N_Vector vectors[ORDERS + 1]; /* and these vectors */
    int order;         /* of the polynomial below, -1: that of the last step has not been read */
    double per_length; /* of the step (1/s) */
    double polynomial[ORDERS + 1][STATES_MAX]; /* over the share of the step from its end on */
} cvode_memory;

static int derivative(sunrealtype time, N_Vector state, N_Vector result, void *data) {
    integrator *solver = data;
    const double seen = integrator_seen_time(solver, time);

    return integrator_keep_status(solver,
                                  model_derivative_and_tangent(solver->model, seen,
                                                               NV_DATA_S(state), NV_DATA_S(result),
                                                               &solver->tangent, &solver->contact));
}

/* Operation of the reader: the coefficients come from the highest down. NOLINTNEXTLINE(readability-non-const-parameter) */
static int note_vectors(int count, sunrealtype *factors, N_Vector *coefficients, N_Vector reader) {
    cvode_memory *memory = reader->content;
    (void)factors;

    for (int k = 0; k < count; ++k) {
        memory->vectors[count - 1 - k] = coefficients[k];
    }
    memory->known = count - 1;
    return 0;
}

static int set_up(integrator *solver, cvode_memory *memory) {
    const int formulas = solver->options.method == METHOD_BDF ? CV_BDF : CV_ADAMS;

    memory->cvode = CVodeCreate(formulas, solver->context);
#if SUNDIALS_VERSION_MAJOR < 7
    if (memory->cvode == NULL ||
        CVodeSetErrHandlerFn(memory->cvode, integrator_keep_message, solver)) {
        return -1;
    }
#endif
    /* -1: any number of steps, as each is asked for by itself; no warnings of short ones, integrate.c
     * watches them. */
    return memory->cvode == NULL || CVodeInit(memory->cvode, derivative, 0.0, solver->state) ||
           CVodeSetUserData(memory->cvode, solver) ||
           CVodeWFtolerances(memory->cvode, integrator_error_weights) ||
           CVodeSetNonlinearSolver(memory->cvode, memory->corrector) ||
           CVodeSetMaxConvFails(memory->cvode, SHORTENINGS) ||
           CVodeSetMaxNumSteps(memory->cvode, -1) || CVodeSetMaxHnilWarns(memory->cvode, -1);
}

static int create(integrator *solver) {
    cvode_memory *memory = calloc(1, sizeof *memory);

    solver->memory = memory;
    if (memory == NULL) {
        return -1;
    }
    memory->order = memory->known = -1;
    memory->scratch = N_VClone(solver->state);
    memory->reader = N_VNewEmpty(solver->context);
    if (memory->scratch == NULL || memory->reader == NULL) {
        return -1;
    }
    memory->reader->content = memory;
    memory->reader->ops->nvlinearcombination = note_vectors;
    memory->corrector = corrector_create(solver, memory->scratch);
    return memory->corrector != NULL ? set_up(solver, memory) : -1;
}

static void destroy(integrator *solver) {
    cvode_memory *memory = solver->memory;
    if (memory == NULL) {
        return;
    }

    CVodeFree(&memory->cvode);
    if (memory->corrector != NULL) {
        SUNNonlinSolFree(memory->corrector);
    }
    if (memory->scratch != NULL) {
        N_VDestroy(memory->scratch);
    }
    N_VFreeEmpty(memory->reader);
    free(memory);
}

static int step(integrator *solver, double longest, double stop) {
    cvode_memory *memory = solver->memory;

    memory->order = -1;
    CVodeSetMaxStep(memory->cvode, longest);
    CVodeSetStopTime(memory->cvode, stop);
    return CVode(memory->cvode, integrator_first_target(solver), solver->state, &solver->time,
                 CV_ONE_STEP);
}

static int restart(integrator *solver) {
    cvode_memory *memory = solver->memory;

    return CVodeReInit(memory->cvode, solver->time, solver->state);
}

/* Order and length of the last step, and what has been counted so far. */
typedef struct cvode_statistics {
    int order;
    sunrealtype length;
    integrator_statistics counts;
} cvode_statistics;

/* By one function of CVODE, as each takes its time to be bound when gearsim starts. */
static cvode_statistics statistics(const cvode_memory *memory) {
    cvode_statistics all = {.order = 0};
    long steps = 0, derivatives = 0, setups, rejected = 0;
    int next_order;
    sunrealtype first_length, next_length, time;

    CVodeGetIntegratorStats(memory->cvode, &steps, &derivatives, &setups, &rejected, &all.order,
                            &next_order, &first_length, &all.length, &next_length, &time);
    all.counts =
        (integrator_statistics){.steps = steps, .derivatives = derivatives, .rejected = rejected};
    return all;
}

/*
 * The vector of order 0 is the state at the end of the step, but for a rounding where CVODE has stopped at a time that it
 * was given: if it were another one, the others would be too, and they are looked for again.
 */
static int are_those_of_the_step(const integrator *solver, const cvode_memory *memory, int order) {
    return order <= memory->known && memcmp(NV_DATA_S(memory->vectors[0]), NV_DATA_S(solver->state),
                                            (size_t)solver->model->states * sizeof(double)) == 0;
}

/*
 * CVODE's polynomial: the value at the end of the step is a sum over its coefficients, which our vector gets to see. CVODE
 * keeps each of them in a vector of its own from its first step to its last, so that they are looked for once and then
 * read without a call. By derivatives it would take a call for each of them.
 */
static int read_polynomial(const integrator *solver, cvode_memory *memory) {
    const cvode_statistics all = statistics(memory);
    const int order = all.order;

    if (!are_those_of_the_step(solver, memory, order)) {
        memory->known = -1;
        if (CVodeGetDky(memory->cvode, solver->time, 0, memory->reader) != CV_SUCCESS ||
            order > memory->known) {
            return -1;
        }
    }

    for (int k = 0; k <= order; ++k) {
        memcpy(memory->polynomial[k], NV_DATA_S(memory->vectors[k]),
               (size_t)solver->model->states * sizeof memory->polynomial[0][0]);
    }
    memory->order = order;
    memory->per_length = 1.0 / all.length;
    return 0;
}

static int interpolate(integrator *solver, int count, const double times[],
                       integrator_point points[]) {
    cvode_memory *memory = solver->memory;

    if (memory->order < 0 && read_polynomial(solver, memory) != 0) {
        return -1;
    }
    for (int n = 0; n < count; ++n) {
        const double share = (times[n] - solver->time) * memory->per_length;
        for (int i = 0; i < solver->model->states; i += 2) {
            double first = 0.0, second = 0.0;
            for (int k = memory->order; k >= 0; --k) {
                first = memory->polynomial[k][i] + share * first;
                second = memory->polynomial[k][i + 1] + share * second;
            }
            points[n].state[i] = first;
            points[n].state[i + 1] = second;
        }
    }
    return 0;
}

static integrator_statistics counts(const integrator *solver) {
    return statistics(solver->memory).counts;
}

const solver_package cvode_package = {
    .create = create,
    .free = destroy,
    .step = step,
    .flag_name = CVodeGetReturnFlagName,
    .restart = restart,
    .interpolate = interpolate,
    .counts = counts,
};
