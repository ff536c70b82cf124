/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Event indicators as the root functions of CVODE: when do flanks touch, and when does a pair of teeth enter or leave? The
 * gears of cvode.c start in the middle of the backlash. The load moves the wheel until its flanks touch the pinion's; that
 * takes sqrt(backlash / acceleration). After some bounces a pair enters once per tooth.
 */
#include <cvode/cvode.h>
#include <gearmesh/gearmesh.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { OFFSET, OFFSET_RATE, STATES };

static const double inertia = 2.1e-3, load = 20; /* of the wheel (kg m2, N m) */
static const double speed = 139.62634;           /* of the pinion: 2 pi 1000 / 45 (rad/s) */

static int position_at(const gm_mesh *mesh, double time, N_Vector state, gm_position *position) {
    return gm_position_from_pinion_angle(gm_mesh_pair(mesh), speed * time, NV_Ith_S(state, OFFSET),
                                         NV_Ith_S(state, OFFSET_RATE), position);
}

/* The status of the library is that of a right-hand side: > 0 asks for a smaller step. */
static int right_hand_side(sunrealtype time, N_Vector state, N_Vector derivative, void *data) {
    const gm_mesh *mesh = data;
    gm_position position;
    gm_mesh_result result;
    int status = position_at(mesh, time, state, &position);
    if (status == GM_OK) {
        status = gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &result);
    }
    if (status != GM_OK) {
        return status;
    }
    const double r_bw = gm_mesh_pair(mesh)->wheel.base_radius;
    NV_Ith_S(derivative, OFFSET) = NV_Ith_S(state, OFFSET_RATE);
    NV_Ith_S(derivative, OFFSET_RATE) = (load - result.force * r_bw) * r_bw / inertia;
    return 0;
}

/* Each indicator is 0 at its events. */
static int indicators(sunrealtype time, N_Vector state, sunrealtype *roots, void *data) {
    const gm_mesh *mesh = data;
    gm_motion motion = {.pose = {0.0, 0.0, 0.0, 0.0, 0.0}};
    const int status = position_at(mesh, time, state, &motion.position);
    return status == GM_OK ? gm_mesh_event_indicators(mesh, &motion, roots) : status;
}

/* What happened up to a time. */
typedef struct history {
    double first_touch; /* (s); 0 = none */
    int touches, separations, entries, exits;
} history;

/* Goes to a time, from event to event; returns whether CVODE failed. */
static int run_to(void *cvode, double end, N_Vector state, history *seen) {
    double time = 0.0;
    int status = CV_ROOT_RETURN;
    while (status == CV_ROOT_RETURN) {
        status = CVode(cvode, end, state, &time, CV_NORMAL);
        int found[GM_EVENTS];
        if (status != CV_ROOT_RETURN || CVodeGetRootInfo(cvode, found) != CV_SUCCESS) {
            continue;
        }

        /* +1 where an indicator rises through 0, -1 where it falls. Between the drive flanks a pair enters at the lower end. */
        if (found[GM_EVENT_DRIVE_CONTACT] > 0 && seen->touches++ == 0) {
            seen->first_touch = time;
        }
        seen->separations += found[GM_EVENT_DRIVE_CONTACT] < 0;
        seen->entries += found[GM_EVENT_DRIVE_LOWER] > 0;
        seen->exits += found[GM_EVENT_DRIVE_UPPER] > 0;
    }
    return status != CV_SUCCESS;
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

    /* An implicit solver with the exact tangent. */
    N_Vector state = N_VNew_Serial(STATES, context);
    SUNMatrix matrix = SUNDenseMatrix(STATES, STATES, context);
    SUNLinearSolver solver = SUNLinSol_Dense(state, matrix, context);
    void *cvode = CVodeCreate(CV_BDF, context);
    N_VConst(0.0, state);

    /* A tenth of a second until the flanks have settled, and another one for 100 pairs. */
    history before = {.first_touch = 0.0}, after = {.first_touch = 0.0};
    int failed = CVodeInit(cvode, right_hand_side, 0.0, state) != CV_SUCCESS ||
                 CVodeRootInit(cvode, GM_EVENTS, indicators) != CV_SUCCESS ||
                 CVodeSStolerances(cvode, 1e-8, 1e-13) != CV_SUCCESS ||
                 CVodeSetUserData(cvode, mesh) != CV_SUCCESS ||
                 CVodeSetMaxNumSteps(cvode, 1000000) != CV_SUCCESS ||
                 CVodeSetLinearSolver(cvode, solver, matrix) != CV_SUCCESS ||
                 run_to(cvode, 0.1, state, &before) || run_to(cvode, 0.2, state, &after);
    if (!failed) {
        /* Free flight over half the backlash. */
        const double acceleration = load * pair.wheel.base_radius / inertia;
        const double flight = sqrt(pair.backlash / acceleration);
        printf("the flanks touch after %.4f ms, by free flight %.4f ms; %d times apart again\n",
               1e3 * before.first_touch, 1e3 * flight, before.separations);
        printf("in 0.1 s at 1000 teeth a second %d pairs enter and %d leave, %d times apart\n",
               after.entries, after.exits, after.separations);
        failed = fabs(before.first_touch - flight) > 1e-6 * flight;
    }

    CVodeFree(&cvode);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(state);
    SUNContext_Free(&context);
    return failed;
}
