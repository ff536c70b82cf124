/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * CVODE from SUNDIALS 6 or 7: Adams or BDF formulas of variable order and step, Newton's iteration with
 * the model's own Jacobian.
 */
#include "integrate.h"
#include "interrupt.h"

#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_types.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#if SUNDIALS_VERSION_MAJOR >= 7
#define NO_COMMUNICATOR SUN_COMM_NULL
#else
#define NO_COMMUNICATOR NULL
#endif

/* So many steps in a row that are next to nothing of a vibration (in rad of it): the solver is stuck. */
enum { STALLED_STEPS = 100 };
static const double stalled_step = 1e-10;

struct integrator {
    const gear_model *model;
    integrator_options options;
    SUNContext context;
    void *cvode;
    N_Vector state;        /* at the end of the last step */
    N_Vector interpolated; /* at the time wanted */
    SUNMatrix matrix;
    SUNLinearSolver linear_solver;
    sunrealtype time;  /* end of the last step (s) */
    int stalled;       /* steps of next to nothing in a row */
    int status;        /* of the last evaluation of the model that went wrong */
    char message[256]; /* what CVODE said last */
    char failure[512];
};

/* ---------------------------------------------------------------------------------------------
 * What CVODE calls
 * ------------------------------------------------------------------------------------------- */

static int keep_status(integrator *solver, int status) {
    if (status != GM_OK) {
        solver->status = status;
    }
    return status;
}

/* The library's status is CVODE's: > 0 try a smaller step, < 0 give up. */
static int derivative(sunrealtype time, N_Vector state, N_Vector result, void *data) {
    integrator *const solver = data;

    return keep_status(solver,
                       model_derivative(solver->model, time, NV_DATA_S(state), NV_DATA_S(result)));
}

static int jacobian(sunrealtype time, N_Vector state, N_Vector state_derivative, SUNMatrix result,
                    void *data, N_Vector scratch1, N_Vector scratch2, N_Vector scratch3) {
    integrator *const solver = data;
    const int states = solver->model->states;
    double columns[STATES_MAX][STATES_MAX];
    (void)state_derivative;
    (void)scratch1;
    (void)scratch2;
    (void)scratch3;

    const int status = model_jacobian(solver->model, time, NV_DATA_S(state), columns);
    if (status == GM_OK) {
        for (int column = 0; column < states; ++column) {
            memcpy(SM_COLUMN_D(result, column), columns[column],
                   (size_t)states * sizeof columns[column][0]);
        }
    }
    return keep_status(solver, status);
}

static int error_weights(N_Vector state, N_Vector weights, void *data) {
    const integrator *const solver = data;

    model_error_weights(solver->model, solver->options.relative_tolerance,
                        solver->options.absolute_tolerance, NV_DATA_S(state), NV_DATA_S(weights));
    return 0;
}

/* CVODE's messages are kept for our own report instead of being printed. */
#if SUNDIALS_VERSION_MAJOR >= 7
static void keep_message(int line, const char *function, const char *file, const char *message,
                         SUNErrCode code, void *data, SUNContext context) {
    integrator *const solver = data;
    (void)line;
    (void)function;
    (void)file;
    (void)code;
    (void)context;

    snprintf(solver->message, sizeof solver->message, "%s", message);
}
#else
static void keep_message(int code, const char *module, const char *function, char *message,
                         void *data) {
    integrator *const solver = data;
    (void)code;
    (void)module;
    (void)function;

    snprintf(solver->message, sizeof solver->message, "%s", message);
}
#endif

/* ---------------------------------------------------------------------------------------------
 * Setting up
 * ------------------------------------------------------------------------------------------- */

static int create_vectors(integrator *solver) {
    const sunindextype states = solver->model->states;

    if (SUNContext_Create(NO_COMMUNICATOR, &solver->context) != 0) {
        return -1;
    }
    solver->state = N_VNew_Serial(states, solver->context);
    solver->interpolated = N_VNew_Serial(states, solver->context);
    solver->matrix = SUNDenseMatrix(states, states, solver->context);
    if (solver->state == NULL || solver->interpolated == NULL || solver->matrix == NULL) {
        return -1;
    }
    solver->linear_solver = SUNLinSol_Dense(solver->state, solver->matrix, solver->context);

    return solver->linear_solver != NULL ? 0 : -1;
}

static int redirect_messages(integrator *solver) {
#if SUNDIALS_VERSION_MAJOR >= 7
    return SUNContext_ClearErrHandlers(solver->context) ||
           SUNContext_PushErrHandler(solver->context, keep_message, solver);
#else
    return CVodeSetErrHandlerFn(solver->cvode, keep_message, solver);
#endif
}

static int set_up(integrator *solver) {
    const int formulas = solver->options.method == METHOD_BDF ? CV_BDF : CV_ADAMS;

    solver->cvode = CVodeCreate(formulas, solver->context);
    /* -1: any number of steps, as each is asked for by itself; no warnings of short ones, see step(). */
    return solver->cvode == NULL || redirect_messages(solver) ||
           CVodeInit(solver->cvode, derivative, 0.0, solver->state) ||
           CVodeSetUserData(solver->cvode, solver) ||
           CVodeWFtolerances(solver->cvode, error_weights) ||
           CVodeSetLinearSolver(solver->cvode, solver->linear_solver, solver->matrix) ||
           CVodeSetJacFn(solver->cvode, jacobian) || CVodeSetMaxNumSteps(solver->cvode, -1) ||
           CVodeSetMaxHnilWarns(solver->cvode, -1);
}

integrator *integrator_create(const gear_model *model, const integrator_options *options,
                              const double start[]) {
    integrator *const solver = calloc(1, sizeof *solver);
    if (solver == NULL) {
        return NULL;
    }

    solver->model = model;
    solver->options = *options;
    if (create_vectors(solver) == 0) {
        memcpy(NV_DATA_S(solver->state), start, (size_t)model->states * sizeof start[0]);
        if (set_up(solver) == 0) {
            return solver;
        }
    }
    integrator_free(solver);
    return NULL;
}

void integrator_free(integrator *solver) {
    if (solver == NULL) {
        return;
    }
    CVodeFree(&solver->cvode);
    if (solver->linear_solver != NULL) {
        SUNLinSolFree(solver->linear_solver);
    }
    if (solver->matrix != NULL) {
        SUNMatDestroy(solver->matrix);
    }
    if (solver->interpolated != NULL) {
        N_VDestroy(solver->interpolated);
    }
    if (solver->state != NULL) {
        N_VDestroy(solver->state);
    }
    if (solver->context != NULL) {
        SUNContext_Free(&solver->context);
    }
    free(solver);
}

/* ---------------------------------------------------------------------------------------------
 * Running
 * ------------------------------------------------------------------------------------------- */

static int fail(integrator *solver, const char *what) {
    const int model_at_fault = solver->status != GM_OK;

    snprintf(solver->failure, sizeof solver->failure, "%s at t = %.9g s%s%s", what, solver->time,
             model_at_fault ? "; the gears: " : "",
             model_at_fault ? gm_status_text(solver->status) : "");
    return EXIT_RUN_FAILED;
}

/* The smaller of what the user allows and what the model needs; 0 = none. */
static double longest_step(const integrator *solver) {
    const double asked = solver->options.max_step;
    const double needed = model_max_step(solver->model, solver->time, NV_DATA_S(solver->state));

    if (asked > 0.0 && needed > 0.0) {
        return fmin(asked, needed);
    }
    return asked > 0.0 ? asked : needed;
}

static int step(integrator *solver) {
    /* CVODE takes its first step by this; not the next sample, so that no result depends on sampling. */
    const double target = 1.0 / solver->model->natural_frequency;

    /* A fault that CVODE got over by a smaller step is not the reason of a later failure, unless the steps
     * have been next to nothing since. */
    if (solver->stalled == 0) {
        solver->status = GM_OK;
    }
    solver->message[0] = '\0';

    const double before = solver->time;
    CVodeSetMaxStep(solver->cvode, longest_step(solver));
    const int flag = CVode(solver->cvode, target, solver->state, &solver->time, CV_ONE_STEP);
    if (flag < 0) {
        char *const name = CVodeGetReturnFlagName(flag);
        char what[sizeof solver->message + 64];

        snprintf(what, sizeof what, "the solver stopped (%s%s%s)", name,
                 solver->message[0] != '\0' ? ": " : "", solver->message);
        free(name);
        return fail(solver, what);
    }

    /* In front of a state that the model refuses CVODE would creep up to it for ever. */
    const double turned = (solver->time - before) * solver->model->natural_frequency;
    solver->stalled = turned > stalled_step ? 0 : solver->stalled + 1;
    if (solver->stalled >= STALLED_STEPS) {
        return fail(solver, "the solver's steps became too short");
    }
    return 0;
}

int integrator_advance(integrator *solver, double time, double state[]) {
    const size_t size = (size_t)solver->model->states * sizeof state[0];

    while (solver->time < time) {
        if (interrupt_requested()) {
            return EXIT_INTERRUPTED;
        }
        const int failed = step(solver);
        if (failed) {
            return failed;
        }
    }

    /* Before its first step CVODE has nothing to interpolate. */
    if (solver->time == 0.0) {
        memcpy(state, NV_DATA_S(solver->state), size);
        return 0;
    }
    if (CVodeGetDky(solver->cvode, time, 0, solver->interpolated) != CV_SUCCESS) {
        return fail(solver, "no value between the solver's steps");
    }
    memcpy(state, NV_DATA_S(solver->interpolated), size);
    return 0;
}

double integrator_time(const integrator *solver) {
    return solver->time;
}

const char *integrator_failure(const integrator *solver) {
    return solver->failure;
}

integrator_statistics integrator_counts(const integrator *solver) {
    integrator_statistics counts = {0, 0, 0, 0};
    long int steps = 0, derivatives = 0, jacobians = 0, rejected = 0;

    CVodeGetNumSteps(solver->cvode, &steps);
    CVodeGetNumRhsEvals(solver->cvode, &derivatives);
    CVodeGetNumJacEvals(solver->cvode, &jacobians);
    CVodeGetNumErrTestFails(solver->cvode, &rejected);
    counts.steps = steps;
    counts.derivatives = derivatives;
    counts.jacobians = jacobians;
    counts.rejected = rejected;

    return counts;
}
