/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The gear pair of fixed_step.c by CVODE, with the exact derivatives of the library as Jacobian. States: x, x', and the
 * angular momentum that the contact has given to the wheel, whose growth is its mean torque.
 */
#include <cvode/cvode.h>
#include <gearmesh/gearmesh.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { OFFSET, OFFSET_RATE, MOMENTUM, STATES };

static const double inertia = 2.1e-3, load = 20; /* of the wheel (kg m2, N m) */
static const double speed = 139.62634;           /* of the pinion: 2 pi 1000 / 45 (rad/s) */

static int evaluate(const gm_mesh *mesh, double time, const double *state, int wanted,
                    gm_mesh_result *result) {
    gm_position position;
    const int status = gm_position_from_pinion_angle(gm_mesh_pair(mesh), speed * time,
                                                     state[OFFSET], state[OFFSET_RATE], &position);
    return status == GM_OK ? gm_mesh_evaluate_at(mesh, &position, wanted, NULL, result) : status;
}

/* The status of the library is that of a right-hand side: > 0 asks for a smaller step. */
static int right_hand_side(sunrealtype time, N_Vector state, N_Vector derivative, void *data) {
    const gm_mesh *mesh = data;
    const double *y = NV_DATA_S(state);
    double *dy = NV_DATA_S(derivative);
    gm_mesh_result result;
    const int status = evaluate(mesh, time, y, GM_WANT_FORCE, &result);
    if (status != GM_OK) {
        return status;
    }

    const double r_bw = gm_mesh_pair(mesh)->wheel.base_radius;
    const double torque = result.force * r_bw;
    dy[OFFSET] = y[OFFSET_RATE];
    dy[OFFSET_RATE] = (load - torque) * r_bw / inertia;
    dy[MOMENTUM] = torque;
    return 0;
}

static int jacobian(sunrealtype time, N_Vector state, N_Vector derivative, SUNMatrix result,
                    void *data, N_Vector scratch1, N_Vector scratch2, N_Vector scratch3) {
    const gm_mesh *mesh = data;
    gm_mesh_result exact;
    (void)derivative;
    (void)scratch1;
    (void)scratch2;
    (void)scratch3;
    const int status = evaluate(mesh, time, NV_DATA_S(state), GM_WANT_DERIVATIVES, &exact);
    if (status != GM_OK) {
        return status;
    }

    /* At a given pinion angle, x changes with the wheel angle alone: dx = -r_bw dphi_w. */
    const double r_bw = gm_mesh_pair(mesh)->wheel.base_radius;
    const double torque_by_x = -exact.force_by.wheel_angle / r_bw * r_bw;
    const double torque_by_rate = -exact.force_by.wheel_speed / r_bw * r_bw;
    SM_ELEMENT_D(result, OFFSET, OFFSET_RATE) = 1.0;
    SM_ELEMENT_D(result, OFFSET_RATE, OFFSET) = -torque_by_x * r_bw / inertia;
    SM_ELEMENT_D(result, OFFSET_RATE, OFFSET_RATE) = -torque_by_rate * r_bw / inertia;
    SM_ELEMENT_D(result, MOMENTUM, OFFSET) = torque_by_x;
    SM_ELEMENT_D(result, MOMENTUM, OFFSET_RATE) = torque_by_rate;
    return 0;
}

int main(void) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 45;
    params.wheel_teeth = 41;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 0.279252680;
    params.helix_angle = 0.575958653;
    params.center_distance = 0.085;
    params.face_width = 0.0175;
    params.backlash = 100e-6;

    gm_pair pair;
    int status = gm_pair_init(&pair, &params);

    /* Ideal flanks; stiffness and damping of one pair of teeth. */
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = 1.05e8;
    law.damping = 844;
    static double memory[256];
    gm_mesh *mesh;
    if (status == GM_OK) {
        status = gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, sizeof memory);
    }
    if (status != GM_OK) {
        fprintf(stderr, "%s\n", gm_status_text(status));
        return 1;
    }

    SUNContext context;
#if SUNDIALS_VERSION_MAJOR < 7
    SUNContext_Create(NULL, &context);
#else
    SUNContext_Create(SUN_COMM_NULL, &context);
#endif
    N_Vector state = N_VNew_Serial(STATES, context);
    SUNMatrix matrix = SUNDenseMatrix(STATES, STATES, context);
    SUNLinearSolver solver = SUNLinSol_Dense(state, matrix, context);
    void *cvode = CVodeCreate(CV_BDF, context);
    N_VConst(0.0, state);

    /* Half a second; the last tenth, 100 mesh cycles, counts. x is some micrometres. */
    int failed = CVodeInit(cvode, right_hand_side, 0.0, state) != CV_SUCCESS ||
                 CVodeSStolerances(cvode, 1e-6, 1e-12) != CV_SUCCESS ||
                 CVodeSetUserData(cvode, mesh) != CV_SUCCESS ||
                 CVodeSetMaxNumSteps(cvode, 1000000) != CV_SUCCESS ||
                 CVodeSetLinearSolver(cvode, solver, matrix) != CV_SUCCESS ||
                 CVodeSetJacFn(cvode, jacobian) != CV_SUCCESS;
    double time;
    double before = 0.0;
    failed = failed || CVode(cvode, 0.4, state, &time, CV_NORMAL) != CV_SUCCESS;
    if (!failed) {
        before = NV_Ith_S(state, MOMENTUM);
        failed = CVode(cvode, 0.5, state, &time, CV_NORMAL) != CV_SUCCESS;
    }
    if (!failed) {
        printf("mean torque of the contact on the wheel: %.3f N m\n",
               (NV_Ith_S(state, MOMENTUM) - before) / 0.1);
    }

    CVodeFree(&cvode);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(state);
    SUNContext_Free(&context);
    return failed;
}
