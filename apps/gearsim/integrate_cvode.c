/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * CVODE: Adams or BDF formulas of variable order and step, with a corrector of its own (integrate_corrector.h).
 * Values within a step are those of its polynomial, which is read once in each step that somebody asks about.
 */
#include "integrate_corrector.h"
#include "integrate_package.h"

#include <cvode/cvode.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

/* A step is shortened to a quarter so many times in a row, at most: down to 1e-12 of it. */
enum { SHORTENINGS = 20 };

/* Adams formulas go up to order 12. */
enum { ORDERS = 12 };

typedef struct cvode_memory {
    void *cvode;
    SUNNonlinearSolver corrector;
    N_Vector scratch;
    N_Vector reader; /* sees CVODE's polynomial, see read_polynomial() */
    int known;       /* highest order of which CVODE's coefficients have been seen, -1: none, */
    const double *coefficients[ORDERS + 1]; /* and where they are */
    int order;            /* of the last step's polynomial, -1: nobody has asked yet */
    double per_length;    /* of the step, which it is over from the end on (1/s) */
    double longest, stop; /* what CVODE has been told, see step() */
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
        memory->coefficients[count - 1 - k] = NV_DATA_S(coefficients[k]);
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
    memory->longest = 0.0;  /* none, as CVODE begins, */
    memory->stop = DBL_MAX; /* and none either */

    /* A vector that only sees others go by, and the corrector with one to work in. */
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

    /* CVODE keeps both, but for a stop that it has reached. Of DBL_MAX, which is none, it is told where another was before. */
    if (longest != memory->longest) {
        CVodeSetMaxStep(memory->cvode, longest);
        memory->longest = longest;
    }
    if (stop != memory->stop) {
        CVodeSetStopTime(memory->cvode, stop);
        memory->stop = stop;
    }
    const int flag = CVode(memory->cvode, integrator_first_target(solver), solver->state,
                           &solver->time, CV_ONE_STEP);
    if (flag == CV_TSTOP_RETURN) {
        memory->stop = DBL_MAX;
    }
    return flag;
}

static int restart(integrator *solver) {
    cvode_memory *memory = solver->memory;

    memory->stop = HUGE_VAL; /* to be told again */
    return CVodeReInit(memory->cvode, solver->time, solver->state);
}

/*
 * The vector of order 0 is the state at the end of the step, but for a rounding where CVODE has stopped at a time that it
 * was given: if it were another one, the others would be too, and they are looked for again.
 */
static int are_those_of_the_step(const integrator *solver, const cvode_memory *memory, int order) {
    const double *state = NV_DATA_S(solver->state), *end = memory->coefficients[0];

    return order <= memory->known && end[STATE_OFFSET] == state[STATE_OFFSET] &&
           end[STATE_OFFSET_RATE] == state[STATE_OFFSET_RATE];
}

/*
 * CVODE's polynomial: the value at the end of the step is a sum over its coefficients, which our vector gets to see. CVODE
 * keeps each of them in a vector of its own from its first step to its last, so that they are looked for once and then
 * read where they are. By derivatives it would take a call for each of them.
 */
static int read_polynomial(const integrator *solver, cvode_memory *memory) {
    int order = 0;
    sunrealtype length = 0.0;

    CVodeGetLastOrder(memory->cvode, &order);
    CVodeGetLastStep(memory->cvode, &length);
    if (!are_those_of_the_step(solver, memory, order)) {
        memory->known = -1;
        if (CVodeGetDky(memory->cvode, solver->time, 0, memory->reader) != CV_SUCCESS ||
            order > memory->known) {
            return -1;
        }
    }

    memory->order = order;
    memory->per_length = 1.0 / length;
    return 0;
}

/* Two states side by side. Of orders that a compiler does not know, which else writes all of them out. */
static inline void evaluate_two(const double *const coefficients[], int order, int i, double share,
                                double state[]) {
    double first = coefficients[order][i], second = coefficients[order][i + 1];

    for (int k = order - 1; k >= 0; --k) {
        first = coefficients[k][i] + share * first;
        second = coefficients[k][i + 1] + share * second;
    }
    state[i] = first;
    state[i + 1] = second;
}

static int interpolate(integrator *solver, int count, const double times[],
                       integrator_point points[]) {
    cvode_memory *memory = solver->memory;

    if (memory->order < 0 && read_polynomial(solver, memory) != 0) {
        return -1;
    }
    for (int n = 0; n < count; ++n) {
        const double share = (times[n] - solver->time) * memory->per_length;
        evaluate_two(memory->coefficients, memory->order, STATE_OFFSET, share, points[n].state);
        if (solver->model->states == STATES_MAX) {
            evaluate_two(memory->coefficients, memory->order, STATE_PINION_ARC, share,
                         points[n].state);
        }
    }
    return 0;
}

/* By one function of CVODE, as each takes its time to be bound when gearsim starts. */
static integrator_statistics counts(const integrator *solver) {
    const cvode_memory *memory = solver->memory;
    long steps = 0, derivatives = 0, setups, rejected = 0;
    int order, next_order;
    sunrealtype first_length, length, next_length, time;

    CVodeGetIntegratorStats(memory->cvode, &steps, &derivatives, &setups, &rejected, &order,
                            &next_order, &first_length, &length, &next_length, &time);
    return (integrator_statistics){
        .steps = steps, .derivatives = derivatives, .rejected = rejected};
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
