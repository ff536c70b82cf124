/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The oscillator by PETSc TS. Runge-Kutta unless another method is asked for; `-ts_type bdf` uses the exact Jacobian. */
#include "oscillator.h"

#include <petscts.h>

static PetscErrorCode motion(TS ts, PetscReal time, Vec state, Vec derivative, void *mesh) {
    const PetscScalar *y;
    PetscScalar *dy;
    (void)ts;
    PetscCall(VecGetArrayRead(state, &y));
    PetscCall(VecGetArray(derivative, &dy));
    /* What is refused is no number, at which PETSc takes a smaller step. */
    const int status = oscillator_motion(mesh, time, y, dy);
    PetscCheck(status >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "%s", gm_status_text(status));
    PetscCall(VecRestoreArray(derivative, &dy));
    PetscCall(VecRestoreArrayRead(state, &y));
    return 0;
}

static PetscErrorCode jacobian(TS ts, PetscReal time, Vec state, Mat matrix, Mat preconditioner,
                               void *mesh) {
    const PetscScalar *y;
    const PetscInt places[2] = {0, 1};
    PetscScalar rows[4];
    (void)ts;
    (void)preconditioner;
    PetscCall(VecGetArrayRead(state, &y));
    const int status = oscillator_jacobian(mesh, time, y, rows);
    PetscCheck(status >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "%s", gm_status_text(status));
    PetscCall(VecRestoreArrayRead(state, &y));
    PetscCall(MatSetValues(matrix, 2, places, 2, places, rows, INSERT_VALUES));
    PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    return 0;
}

int main(int argc, char **argv) {
    const gm_mesh *mesh = oscillator_mesh();
    if (mesh == NULL) {
        return 1;
    }
    PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));

    /* The state in memory of our own, and room for the tangent. */
    double values[2] = {start[0], start[1]};
    Vec state;
    Mat matrix;
    PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, 2, values, &state));
    PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, 2, 2, NULL, &matrix));

    /* Runge-Kutta of order 8 with step control; the tangent serves whoever chooses an implicit method by -ts_type. */
    TS ts;
    PetscCall(TSCreate(PETSC_COMM_SELF, &ts));
    PetscCall(TSSetRHSFunction(ts, NULL, motion, (void *)mesh));
    PetscCall(TSSetRHSJacobian(ts, matrix, matrix, jacobian, (void *)mesh));
    PetscCall(TSSetType(ts, TSRK));
    PetscCall(TSRKSetType(ts, TSRK8VR));
    PetscCall(TSSetTolerances(ts, 1e-16, NULL, 1e-11, NULL));

    /* From a small first step to the end time exactly. */
    PetscCall(TSSetTimeStep(ts, 1e-7));
    PetscCall(TSSetMaxSteps(ts, 1000000));
    PetscCall(TSSetMaxTime(ts, end_time));
    PetscCall(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_MATCHSTEP));
    PetscCall(TSSetFromOptions(ts));
    PetscCall(TSSolve(ts, state));
    oscillator_print(values);

    PetscCall(TSDestroy(&ts));
    PetscCall(MatDestroy(&matrix));
    PetscCall(VecDestroy(&state));
    PetscCall(PetscFinalize());
    return 0;
}
