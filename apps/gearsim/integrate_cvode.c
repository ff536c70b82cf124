/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * CVODE: Adams or BDF formulas of variable order and step, Newton's iteration with the model's own
 * Jacobian.
 */
#include "integrate_package.h"

#include <cvode/cvode.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

typedef struct cvode_memory {
    void *cvode;
    SUNMatrix matrix;
    SUNLinearSolver linear_solver;
    N_Vector interpolated;
} cvode_memory;

static int jacobian(sunrealtype time, N_Vector state, N_Vector state_derivative, SUNMatrix result,
                    void *data, N_Vector scratch1, N_Vector scratch2, N_Vector scratch3) {
    integrator *solver = data;
    const int states = solver->model->states;
    double columns[STATES_MAX][STATES_MAX];
    (void)state_derivative;
    (void)scratch1;
    (void)scratch2;
    (void)scratch3;

    const int status = model_jacobian(solver->model, integrator_seen_time(solver, time),
                                      NV_DATA_S(state), columns);
    if (status == GM_OK) {
        for (int column = 0; column < states; ++column) {
            memcpy(SM_COLUMN_D(result, column), columns[column],
                   (size_t)states * sizeof columns[column][0]);
        }
    }
    return integrator_keep_status(solver, status);
}

static int create_vectors(const integrator *solver, cvode_memory *memory) {
    const sunindextype states = solver->model->states;

    memory->interpolated = N_VNew_Serial(states, solver->context);
    memory->matrix = SUNDenseMatrix(states, states, solver->context);
    if (memory->interpolated == NULL || memory->matrix == NULL) {
        return -1;
    }
    memory->linear_solver = SUNLinSol_Dense(solver->state, memory->matrix, solver->context);

    return memory->linear_solver != NULL ? 0 : -1;
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
    return memory->cvode == NULL ||
           CVodeInit(memory->cvode, integrator_derivative, 0.0, solver->state) ||
           CVodeSetUserData(memory->cvode, solver) ||
           CVodeWFtolerances(memory->cvode, integrator_error_weights) ||
           CVodeSetLinearSolver(memory->cvode, memory->linear_solver, memory->matrix) ||
           CVodeSetJacFn(memory->cvode, jacobian) || CVodeSetMaxNumSteps(memory->cvode, -1) ||
           CVodeSetMaxHnilWarns(memory->cvode, -1);
}

static int create(integrator *solver) {
    cvode_memory *memory = calloc(1, sizeof *memory);

    solver->memory = memory;
    if (memory == NULL || create_vectors(solver, memory) != 0) {
        return -1;
    }
    return set_up(solver, memory);
}

static void destroy(integrator *solver) {
    cvode_memory *memory = solver->memory;
    if (memory == NULL) {
        return;
    }

    CVodeFree(&memory->cvode);
    if (memory->linear_solver != NULL) {
        SUNLinSolFree(memory->linear_solver);
    }
    if (memory->matrix != NULL) {
        SUNMatDestroy(memory->matrix);
    }
    if (memory->interpolated != NULL) {
        N_VDestroy(memory->interpolated);
    }
    free(memory);
}

static int step(integrator *solver, double longest, double stop) {
    cvode_memory *memory = solver->memory;

    CVodeSetMaxStep(memory->cvode, longest);
    CVodeSetStopTime(memory->cvode, stop);
    return CVode(memory->cvode, integrator_first_target(solver), solver->state, &solver->time,
                 CV_ONE_STEP);
}

static int restart(integrator *solver) {
    cvode_memory *memory = solver->memory;

    return CVodeReInit(memory->cvode, solver->time, solver->state);
}

static int interpolate(integrator *solver, double time, double state[]) {
    cvode_memory *memory = solver->memory;

    if (CVodeGetDky(memory->cvode, time, 0, memory->interpolated) != CV_SUCCESS) {
        return -1;
    }
    memcpy(state, NV_DATA_S(memory->interpolated), (size_t)solver->model->states * sizeof state[0]);
    return 0;
}

static integrator_statistics counts(const integrator *solver) {
    const cvode_memory *memory = solver->memory;
    long int steps = 0, derivatives = 0, jacobians = 0, rejected = 0;

    CVodeGetNumSteps(memory->cvode, &steps);
    CVodeGetNumRhsEvals(memory->cvode, &derivatives);
    CVodeGetNumJacEvals(memory->cvode, &jacobians);
    CVodeGetNumErrTestFails(memory->cvode, &rejected);
    const integrator_statistics result = {
        .steps = steps, .derivatives = derivatives, .jacobians = jacobians, .rejected = rejected};

    return result;
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
