/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrate_corrector.h"

#include <cvode/cvode.h>
#include <math.h>
#include <stdlib.h>

/* As many as CVODE's own Newton iteration takes before it asks for a shorter step. */
enum { ITERATIONS = 3 };

/*
 * The error estimate of a high order takes the derivatives to be smooth. Where a stiffness is less than this share of the
 * one before, or the reverse, flanks have met or parted within the step, and all of the correction may be an error: it
 * must not be more than so many tolerances.
 */
static const double kink_share = 0.6, kink_correction = 10.0;

typedef struct corrector {
    const integrator *solver;
    SUNNonlinSolSysFn residual; /* of CVODE: evaluates the model on the way */
    N_Vector change;            /* of the correction, by one iteration */
    double stiffness;           /* dF/dx of the evaluation before, as the Jacobian has it */
} corrector;

static SUNNonlinearSolver_Type type(SUNNonlinearSolver module) {
    (void)module;
    return SUNNONLINEARSOLVER_ROOTFIND;
}

static int set_residual(SUNNonlinearSolver module, SUNNonlinSolSysFn residual) {
    corrector *own = module->content;

    own->residual = residual;
    return SUN_NLS_SUCCESS;
}

/*
 * Solve (I - gamma J) y = y, in place. J has w0 where a coordinate follows its speed: the speeds remain. For the two states
 * of x:
 */
static void solve_two(const integrator *solver, double gamma, double y[]) {
    const double follows = gamma * solver->model->natural_frequency;
    const double by_place = gamma * solver->tangent.jacobian[STATE_OFFSET][STATE_OFFSET_RATE];
    const double by_speed = gamma * solver->tangent.jacobian[STATE_OFFSET_RATE][STATE_OFFSET_RATE];

    y[1] = (y[1] + by_place * y[0]) / (1.0 - (by_speed + follows * by_place));
    y[0] += follows * y[1];
}

/* And for those of the pinion beside them. */
static void solve_four(const integrator *solver, double gamma, double y[]) {
    const double follows = gamma * solver->model->natural_frequency;
    double matrix[2][2] = {{1.0, 0.0}, {0.0, 1.0}}, right[2];

    for (int i = 0; i < 2; ++i) {
        const int row = 2 * i + 1;
        right[i] = y[row];
        for (int j = 0; j < 2; ++j) {
            const double by_place = gamma * solver->tangent.jacobian[2 * j][row];
            const double by_speed = gamma * solver->tangent.jacobian[2 * j + 1][row];
            right[i] += by_place * y[2 * j];
            matrix[i][j] -= by_speed + follows * by_place;
        }
    }

    /* Cramer's rule. */
    const double determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
    y[1] = (right[0] * matrix[1][1] - matrix[0][1] * right[1]) / determinant;
    y[3] = (matrix[0][0] * right[1] - right[0] * matrix[1][0]) / determinant;
    y[0] += follows * y[1];
    y[2] += follows * y[3];
}

/* Newton's step with the Jacobian of this evaluation: the residual becomes what it changes the correction by. */
static void correct(const integrator *solver, double gamma, double residual[],
                    double correction[]) {
    const int states = solver->model->states;

    if (states == STATES_MAX) {
        solve_four(solver, gamma, residual);
        correction[2] -= residual[2];
        correction[3] -= residual[3];
    } else {
        solve_two(solver, gamma, residual);
    }
    correction[0] -= residual[0];
    correction[1] -= residual[1];
}

/*
 * What the next iteration would change, in tolerances. The stiffness changes within the correction, which is a small part
 * of the step, by no more than it has from the evaluation before to this one. And flanks that would have to pull at the
 * corrected place do not.
 */
static double left_over(const corrector *own, double gamma, const double change[],
                        const double weights[]) {
    const model_tangent *tangent = &own->solver->tangent;
    const double *by_place = tangent->jacobian[STATE_OFFSET];
    const double *by_speed = tangent->jacobian[STATE_OFFSET_RATE];
    const double carried = tangent->carried + by_place[STATE_OFFSET_RATE] * change[STATE_OFFSET] +
                           by_speed[STATE_OFFSET_RATE] * change[STATE_OFFSET_RATE];
    const double pulled = carried * tangent->carried < 0.0 ? fabs(carried) : 0.0;
    const double softer = fabs(by_place[STATE_OFFSET_RATE] - own->stiffness);
    const double by_softer = softer * fabs(change[STATE_OFFSET]);
    const double speed = gamma * (by_softer > pulled ? by_softer : pulled);
    const double place = gamma * own->solver->model->natural_frequency * speed;
    const double of_place = weights[STATE_OFFSET] * place;
    const double of_speed = weights[STATE_OFFSET_RATE] * speed;

    return of_place > of_speed ? of_place : of_speed;
}

/* Whether the step is too long for a kink in it. */
static int is_beyond_kink(const corrector *own, N_Vector correction, N_Vector weights) {
    const double now = fabs(own->solver->tangent.jacobian[STATE_OFFSET][STATE_OFFSET_RATE]);
    const double before = fabs(own->stiffness);
    const int has_changed = now < kink_share * before || before < kink_share * now;

    return has_changed && N_VWrmsNorm(correction, weights) > kink_correction;
}

static int solve(SUNNonlinearSolver module, N_Vector predicted, N_Vector correction,
                 N_Vector weights, sunrealtype tolerance, int call_setup, void *cvode) {
    corrector *own = module->content;
    const integrator *solver = own->solver;
    sunrealtype gamma;
    (void)predicted;
    (void)call_setup;

    for (int k = 0; k < ITERATIONS; ++k) {
        const int flag = own->residual(correction, own->change, cvode);
        if (flag != 0) {
            return flag;
        }

        CVodeGetCurrentGamma(cvode, &gamma);
        correct(solver, gamma, NV_DATA_S(own->change), NV_DATA_S(correction));

        /* Good enough? */
        if (is_beyond_kink(own, correction, weights)) {
            break;
        }
        const double rest = left_over(own, gamma, NV_DATA_S(own->change), NV_DATA_S(weights));
        own->stiffness = solver->tangent.jacobian[STATE_OFFSET][STATE_OFFSET_RATE];
        if (rest <= tolerance) {
            return SUN_NLS_SUCCESS;
        }
    }
    return SUN_NLS_CONV_RECVR;
}

SUNNonlinearSolver corrector_create(const integrator *solver, N_Vector scratch) {
    SUNNonlinearSolver module = SUNNonlinSolNewEmpty(solver->context);
    corrector *own = calloc(1, sizeof *own);

    if (module == NULL || own == NULL) {
        SUNNonlinSolFree(module);
        free(own);
        return NULL;
    }
    own->solver = solver;
    own->change = scratch;

    /* Without a setup and counters, as CVODE asks for these only where they are there. */
    module->content = own; /* freed with the module */
    module->ops->gettype = type;
    module->ops->setsysfn = set_residual;
    module->ops->solve = solve;
    return module;
}
