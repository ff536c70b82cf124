/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * ARKODE: an explicit Runge-Kutta method with an embedded one for the error of a step. It takes more
 * right-hand sides than CVODE, but adds little to their cost.
 *
 * Values within a step are not ARKODE's: its cubics miss the tolerance in steps as long as these, and its
 * higher polynomials evaluate the model again for every value. Here every coordinate is known with its
 * speed and acceleration at both ends of the step; the polynomial of degree 5 through these six is off by
 * (w0 h)^6 / 46080 of a vibration's amplitude at most.
 */
#include "integrate_package.h"

#include <arkode/arkode_erkstep.h>
#include <stdlib.h>
#include <string.h>

/* Most accurate of ARKODE's pairs for the same time of computing, in all of the cases of gearsim-solver.md. */
static const ARKODE_ERKTableID method = ARKODE_CASH_KARP_6_4_5;

typedef struct step_end {
    double time;
    double state[STATES_MAX];
    double derivative[STATES_MAX];
} step_end;

typedef struct arkode_memory {
    void *arkode;
    N_Vector derivative;
    step_end from, to; /* the last step */
} arkode_memory;

static int set_up(integrator *solver, arkode_memory *memory) {
    memory->derivative = N_VClone(solver->state);
    memory->arkode = ERKStepCreate(integrator_derivative, 0.0, solver->state, solver->context);
    if (memory->derivative == NULL || memory->arkode == NULL) {
        return -1;
    }
#if SUNDIALS_VERSION_MAJOR < 7
    if (ERKStepSetErrHandlerFn(memory->arkode, integrator_keep_message, solver)) {
        return -1;
    }
#endif
    /* Degree 3: of what is there anyway. -1: no limits and warnings, see integrate_cvode.c. */
    return ERKStepSetUserData(memory->arkode, solver) ||
           ERKStepWFtolerances(memory->arkode, integrator_error_weights) ||
           ERKStepSetTableNum(memory->arkode, method) ||
           ERKStepSetInterpolantDegree(memory->arkode, 3) ||
           ERKStepSetMaxNumSteps(memory->arkode, -1) || ERKStepSetMaxHnilWarns(memory->arkode, -1);
}

static int create(integrator *solver) {
    arkode_memory *memory = calloc(1, sizeof *memory);

    solver->memory = memory;
    return memory != NULL ? set_up(solver, memory) : -1;
}

static void destroy(integrator *solver) {
    arkode_memory *memory = solver->memory;
    if (memory == NULL) {
        return;
    }

    ERKStepFree(&memory->arkode);
    if (memory->derivative != NULL) {
        N_VDestroy(memory->derivative);
    }
    free(memory);
}

static void note_state(const integrator *solver, step_end *end) {
    end->time = solver->time;
    memcpy(end->state, NV_DATA_S(solver->state),
           (size_t)solver->model->states * sizeof end->state[0]);
}

/* ARKODE has kept it for its own polynomial. */
static int note_derivative(const arkode_memory *memory, step_end *end) {
    const int flag = ERKStepGetDky(memory->arkode, end->time, 1, memory->derivative);

    memcpy(end->derivative, NV_DATA_S(memory->derivative),
           (size_t)NV_LENGTH_S(memory->derivative) * sizeof end->derivative[0]);
    return flag;
}

static int step(integrator *solver, double longest, double stop) {
    arkode_memory *memory = solver->memory;

    note_state(solver, &memory->from);
    ERKStepSetMaxStep(memory->arkode, longest);
    ERKStepSetStopTime(memory->arkode, stop);
    const int flag = ERKStepEvolve(memory->arkode, integrator_first_target(solver), solver->state,
                                   &solver->time, ARK_ONE_STEP);
    if (flag < 0) {
        return flag;
    }
    note_state(solver, &memory->to);

    const int from_flag = note_derivative(memory, &memory->from);
    const int to_flag = note_derivative(memory, &memory->to);
    return from_flag < 0 ? from_flag : to_flag;
}

static int restart(integrator *solver) {
    arkode_memory *memory = solver->memory;

    return ERKStepReInit(memory->arkode, integrator_derivative, solver->time, solver->state);
}

/* Value and slope at s in [0, 1] of the polynomial with these values, slopes and curvatures at 0 and 1. */
static void quintic(const double from[3], const double to[3], double s, double result[2]) {
    const double value = to[0] - from[0] - from[1] - 0.5 * from[2];
    const double slope = to[1] - from[1] - from[2];
    const double curvature = to[2] - from[2];
    const double c3 = 10.0 * value - 4.0 * slope + 0.5 * curvature;
    const double c4 = -15.0 * value + 7.0 * slope - curvature;
    const double c5 = 6.0 * value - 3.0 * slope + 0.5 * curvature;

    result[0] = from[0] + s * (from[1] + s * (0.5 * from[2] + s * (c3 + s * (c4 + s * c5))));
    result[1] = from[1] + s * (from[2] + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)));
}

/* A coordinate with its first and second derivative over the share of the step; in the state, each
 * coordinate is followed by its speed, in units of w0. */
static void motion_of(const step_end *end, int coordinate, double h, double w0, double motion[3]) {
    motion[0] = end->state[coordinate];
    motion[1] = end->derivative[coordinate] * h;
    motion[2] = end->derivative[coordinate + 1] * w0 * h * h;
}

static int interpolate(integrator *solver, int count, const double times[],
                       integrator_point points[]) {
    const arkode_memory *memory = solver->memory;
    const double w0 = solver->model->natural_frequency;
    const double h = memory->to.time - memory->from.time;

    for (int i = 0; i < solver->model->states; i += 2) {
        double from[3], to[3], motion[2];

        motion_of(&memory->from, i, h, w0, from);
        motion_of(&memory->to, i, h, w0, to);
        for (int k = 0; k < count; ++k) {
            quintic(from, to, (times[k] - memory->from.time) / h, motion);
            points[k].state[i] = motion[0];
            points[k].state[i + 1] = motion[1] / (h * w0);
        }
    }
    return 0;
}

static integrator_statistics counts(const integrator *solver) {
    const arkode_memory *memory = solver->memory;
    long int steps = 0, derivatives = 0, rejected = 0;

    ERKStepGetNumSteps(memory->arkode, &steps);
    ERKStepGetNumRhsEvals(memory->arkode, &derivatives);
    ERKStepGetNumErrTestFails(memory->arkode, &rejected);
    const integrator_statistics result = {
        .steps = steps, .derivatives = derivatives, .rejected = rejected};

    return result;
}

const solver_package arkode_package = {
    .create = create,
    .free = destroy,
    .step = step,
    .flag_name = ERKStepGetReturnFlagName,
    .restart = restart,
    .interpolate = interpolate,
    .counts = counts,
};
