/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Co-simulation: CVODE (BDF) with the exact Jacobian between two communication points. */
#include "model.h"

#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

struct fmu_integrator {
    SUNContext context;
    void *cvode;
    N_Vector state;
    SUNMatrix matrix;
    SUNLinearSolver solver;
    fmu_values values; /* those of the call, with the states of a step that CVODE tries */
    const file_mesh *made;
    double end; /* of the last step (s) */
};

static int evaluate(fmu_integrator *integrator, double time, N_Vector state,
                    fmu_jacobian *jacobian) {
    fmu_values *values = &integrator->values;
    values->time = time;
    memcpy(values->state, NV_DATA_S(state), (size_t)model.states * sizeof(double));
    return model.evaluate(values, integrator->made, 0, jacobian);
}

static int right_hand_side(sunrealtype time, N_Vector state, N_Vector derivative, void *data) {
    fmu_integrator *integrator = data;
    const int status = evaluate(integrator, time, state, NULL);
    memcpy(NV_DATA_S(derivative), integrator->values.derivative,
           (size_t)model.states * sizeof(double));
    return status;
}

static int jacobian_matrix(sunrealtype time, N_Vector state, N_Vector derivative, SUNMatrix matrix,
                           void *data, N_Vector scratch1, N_Vector scratch2, N_Vector scratch3) {
    (void)derivative;
    (void)scratch1;
    (void)scratch2;
    (void)scratch3;
    fmu_jacobian jacobian;
    memset(&jacobian, 0, sizeof jacobian);
    const int status = evaluate(data, time, state, &jacobian);
    for (int row = 0; row < model.states; ++row) {
        for (int column = 0; column < model.states; ++column) {
            SM_ELEMENT_D(matrix, row, column) = jacobian.by[row][column];
        }
    }
    return status;
}

/* A share of what matters of each state: of its amount, but not of an angle, which grows without end. */
static int weights(N_Vector state, N_Vector weight, void *data) {
    const fmu_integrator *integrator = data;
    const double tolerance = integrator->values.tolerance;
    double nominals[MAX_STATES];
    fmu_nominals(nominals);
    for (int k = 0; k < model.states; ++k) {
        const double amount = k == model.angle_state ? 0.0 : fabs(NV_Ith_S(state, k));
        NV_Ith_S(weight, k) = 1.0 / (tolerance * (amount + nominals[k]));
    }
    return 0;
}

void fmu_integrator_free(fmu_integrator *integrator) {
    if (integrator == NULL) {
        return;
    }
    CVodeFree(&integrator->cvode);
    if (integrator->solver != NULL) {
        SUNLinSolFree(integrator->solver);
    }
    SUNMatDestroy(integrator->matrix);
    N_VDestroy(integrator->state);
    SUNContext_Free(&integrator->context);
    free(integrator);
}

/* An integrator that begins at the time and the states of the instance; NULL without memory. */
static fmu_integrator *start(const fmu_instance *instance) {
    fmu_integrator *integrator = calloc(1, sizeof *integrator);
    if (integrator == NULL || SUNContext_Create(NULL, &integrator->context) != 0) {
        free(integrator);
        return NULL;
    }
    integrator->values = instance->values;
    integrator->made = &instance->made;
    integrator->end = instance->values.time;

    /* Few states and stiff contacts: BDF with the exact Jacobian, dense. */
    SUNContext context = integrator->context;
    integrator->state = N_VNew_Serial(model.states, context);
    integrator->matrix = SUNDenseMatrix(model.states, model.states, context);
    integrator->cvode = CVodeCreate(CV_BDF, context);
    if (integrator->state != NULL && integrator->matrix != NULL) {
        memcpy(NV_DATA_S(integrator->state), instance->values.state,
               (size_t)model.states * sizeof(double));
        integrator->solver = SUNLinSol_Dense(integrator->state, integrator->matrix, context);
    }

    /* Its own messages go nowhere: the importer is told by a status. */
    if (integrator->solver == NULL || integrator->cvode == NULL ||
        CVodeInit(integrator->cvode, right_hand_side, instance->values.time, integrator->state) !=
            CV_SUCCESS ||
        CVodeSetUserData(integrator->cvode, integrator) != CV_SUCCESS ||
        CVodeSetErrFile(integrator->cvode, NULL) != CV_SUCCESS ||
        CVodeWFtolerances(integrator->cvode, weights) != CV_SUCCESS ||
        CVodeSetMaxNumSteps(integrator->cvode, 10000000) != CV_SUCCESS ||
        CVodeSetLinearSolver(integrator->cvode, integrator->solver, integrator->matrix) !=
            CV_SUCCESS ||
        CVodeSetJacFn(integrator->cvode, jacobian_matrix) != CV_SUCCESS) {
        fmu_integrator_free(integrator);
        return NULL;
    }
    return integrator;
}

int fmu_integrate(fmu_instance *instance, double end) {
    /* Inputs that have changed have freed the integrator. */
    if (instance->integrator == NULL) {
        instance->integrator = start(instance);
    }
    fmu_integrator *integrator = instance->integrator;
    if (integrator == NULL) {
        return -1;
    }

    /* It never steps beyond the end, as inputs may change there. */
    if (end > integrator->end) {
        double time;
        if (CVodeSetStopTime(integrator->cvode, end) != CV_SUCCESS ||
            CVode(integrator->cvode, end, integrator->state, &time, CV_NORMAL) < 0) {
            fmu_integrator_free(integrator);
            instance->integrator = NULL;
            return -1;
        }
        integrator->end = end;
    }
    memcpy(instance->values.state, NV_DATA_S(integrator->state),
           (size_t)model.states * sizeof(double));
    return 0;
}
