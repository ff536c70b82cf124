/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The oscillator by CVODE (Adams), to tight tolerances: what the other solvers are compared with. */
#include "oscillator.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

static int right_hand_side(sunrealtype time, N_Vector state, N_Vector derivative, void *mesh) {
    return oscillator_motion(mesh, time, NV_DATA_S(state), NV_DATA_S(derivative));
}

int main(void) {
    const gm_mesh *mesh = oscillator_mesh();
    SUNContext context;
    if (mesh == NULL || SUNContext_Create(NULL, &context) != 0) {
        return 1;
    }

    double values[2] = {start[0], start[1]};
    N_Vector state = N_VMake_Serial(2, values, context);
    SUNNonlinearSolver corrector = SUNNonlinSol_FixedPoint(state, 0, context);
    void *cvode = CVodeCreate(CV_ADAMS, context);
    double time;
    const int failed = CVodeInit(cvode, right_hand_side, 0.0, state) != CV_SUCCESS ||
                       CVodeSStolerances(cvode, 1e-12, 1e-17) != CV_SUCCESS ||
                       CVodeSetUserData(cvode, (void *)mesh) != CV_SUCCESS ||
                       CVodeSetMaxNumSteps(cvode, 1000000) != CV_SUCCESS ||
                       CVodeSetNonlinearSolver(cvode, corrector) != CV_SUCCESS ||
                       CVodeSetStopTime(cvode, end_time) != CV_SUCCESS ||
                       CVode(cvode, end_time, state, &time, CV_NORMAL) < 0;
    if (!failed) {
        oscillator_print(values);
    }

    CVodeFree(&cvode);
    SUNNonlinSolFree(corrector);
    N_VDestroy(state);
    SUNContext_Free(&context);
    return failed;
}
