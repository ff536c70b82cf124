/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Three gears in a row, not in line, by CVODE: the one in the middle, an idler, meshes with both others on opposite flanks.
 * Two meshes share its body, and their forces together are what its bearing feels.
 */
#include <cvode/cvode.h>
#include <gearmesh/gearmesh.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { DRIVER, IDLER, DRIVEN, GEARS };
enum {
    IN = 2 * GEARS,
    OUT,
    LOSS,
    BEARING_X,
    BEARING_Y,
    STATES
}; /* behind angles and speeds: integrals over time */

static const double pi = 3.14159265358979323846;
static const int teeth[GEARS] = {23, 31, 37};
static const double inertia[GEARS] = {2e-4, 6e-4, 1e-3};
static const double stiffness = 2e8, damping = 2e3, torque = 40.0, speed = 100.0,
                    bend = 1.1; /* rad, at the idler */

typedef struct row_of_gears {
    gm_mesh *mesh[2]; /* driver and idler, idler and driven */
    double place[GEARS][2];
    double zero[GEARS]; /* angles in which they were assembled */
    double stored;
} row_of_gears;

static gm_mesh *mesh_of(int pinion, int wheel, double helix_angle) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = pinion;
    params.wheel_teeth = wheel;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = pi / 9.0;
    params.helix_angle = helix_angle;
    params.center_distance = (pinion + wheel) * 1e-3 / cos(helix_angle);
    params.face_width = 20e-3;
    params.backlash = 80e-6;

    gm_pair pair;
    gm_mesh_params law;
    gm_mesh *mesh = NULL;
    gm_mesh_params_default(&law);
    law.stiffness = stiffness;
    law.damping = damping;
    if (gm_pair_init(&pair, &params) == GM_OK) {
        const size_t size = gm_mesh_size(&law, &pair);
        (void)gm_mesh_init(&mesh, &law, &pair, NULL, NULL, malloc(size), size);
    }
    return mesh;
}

static gm_body body_of(const row_of_gears *row, int gear, const double *y) {
    const double angle = row->zero[gear] + y[gear];
    const double c = cos(angle), s = sin(angle);
    const gm_body body = {{row->place[gear][0], row->place[gear][1], 0.0},
                          {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0},
                          {0.0, 0.0, 0.0},
                          {0.0, 0.0, y[GEARS + gear]}};
    return body;
}

/* What damping takes: parallel axes approach each other at one speed all over the side that touches. */
static double loss_of(const gm_penetration *c) {
    const double contact = c->drive_contact + c->coast_contact;
    return contact > 0.0 ? damping * c->rate * c->rate / contact : 0.0;
}

static int derivatives(sunrealtype t, N_Vector state, N_Vector rates, void *data) {
    row_of_gears *row = (row_of_gears *)data;
    const double *y = N_VGetArrayPointer(state);
    double *rate = N_VGetArrayPointer(rates);

    /* The driven gear turns as the driver does; its load grows with its speed. */
    const double ratio = (double)teeth[DRIVEN] / teeth[DRIVER];
    const double load = torque * ratio * y[GEARS + DRIVEN] / (speed / ratio);
    double moment[GEARS] = {torque, 0.0, -load};
    double loss = 0.0, bearing[2] = {0.0, 0.0};
    (void)t;

    /* Both meshes: their moments turn the gears, their forces meet in the bearing of the idler. */
    row->stored = 0.0;
    for (int k = 0; k < 2; ++k) {
        const gm_body pinion = body_of(row, k, y), wheel = body_of(row, k + 1, y);
        gm_load on[2];
        gm_mesh_result result;
        const int status = gm_mesh_evaluate_bodies(row->mesh[k], &pinion, &wheel, GM_WANT_ENERGY,
                                                   NULL, &result, &on[0], &on[1]);
        if (status != GM_OK) {
            return status; /* > 0: a smaller step may help */
        }

        moment[k] += on[0].moment[2];
        moment[k + 1] += on[1].moment[2];
        bearing[0] += on[1 - k].force[0];
        bearing[1] += on[1 - k].force[1];
        row->stored += result.energy;
        loss += loss_of(&result.contact);
    }

    /* Angles, speeds, and what is summed over time. */
    for (int k = 0; k < GEARS; ++k) {
        rate[k] = y[GEARS + k];
        rate[GEARS + k] = moment[k] / inertia[k];
    }
    rate[IN] = torque * y[GEARS + DRIVER];
    rate[OUT] = load * y[GEARS + DRIVEN];
    rate[LOSS] = loss;
    rate[BEARING_X] = bearing[0];
    rate[BEARING_Y] = bearing[1];
    return 0;
}

/* The idler sits beside the driver, the driven gear beside the idler around the corner; each turned into its mate. */
static int assemble(row_of_gears *row) {
    const double y[2 * GEARS] = {0.0};
    for (int k = 0; k < 2; ++k) {
        const double distance = gm_mesh_pair(row->mesh[k])->center_distance;
        row->place[k + 1][0] = row->place[k][0] + distance * cos(bend * k);
        row->place[k + 1][1] = row->place[k][1] + distance * sin(bend * k);
        const gm_body pinion = body_of(row, k, y), wheel = body_of(row, k + 1, y);
        gm_motion motion;
        if (gm_motion_of_bodies(row->mesh[k], &pinion, &wheel, &motion, NULL) != GM_OK) {
            return 0;
        }
        row->zero[k + 1] -= motion.position.offset / gm_mesh_pair(row->mesh[k])->wheel.base_radius;
    }
    return 1;
}

static double kinetic(const double *y) {
    double energy = 0.0;
    for (int k = 0; k < GEARS; ++k) {
        energy += 0.5 * inertia[k] * y[GEARS + k] * y[GEARS + k];
    }
    return energy;
}

int main(void) {
    const double settled = 0.1, end = 0.2, helix_angle = pi / 12.0;
    double y[STATES] = {0.0}, rates[STATES], before[STATES] = {0.0};
    row_of_gears row = {.mesh = {mesh_of(teeth[DRIVER], teeth[IDLER], helix_angle),
                                 mesh_of(teeth[IDLER], teeth[DRIVEN], -helix_angle)}};
    if (row.mesh[0] == NULL || row.mesh[1] == NULL || !assemble(&row)) {
        return 1;
    }

    /* All gears turn at their steady speeds. */
    for (int k = 0; k < GEARS; ++k) {
        y[GEARS + k] = (k % 2 == 0 ? speed : -speed) * teeth[DRIVER] / teeth[k];
    }

    /* The solver: implicit, as meshes are stiff. */
    SUNContext context;
#if SUNDIALS_VERSION_MAJOR < 7
    SUNContext_Create(NULL, &context);
#else
    SUNContext_Create(SUN_COMM_NULL, &context);
#endif
    N_Vector state = N_VMake_Serial(STATES, y, context),
             unused = N_VMake_Serial(STATES, rates, context);
    SUNMatrix matrix = SUNDenseMatrix(STATES, STATES, context);
    SUNLinearSolver solver = SUNLinSol_Dense(state, matrix, context);
    void *cvode = CVodeCreate(CV_BDF, context);
    sunrealtype time = 0.0;
    int failed = CVodeInit(cvode, derivatives, 0.0, state) ||
                 CVodeSStolerances(cvode, 1e-9, 1e-10) || CVodeSetUserData(cvode, &row) ||
                 CVodeSetMaxNumSteps(cvode, 1000000) || CVodeSetLinearSolver(cvode, solver, matrix);

    /* Behind the start the means are taken and the energies counted. */
    failed = failed || CVode(cvode, settled, state, &time, CV_NORMAL) < 0 ||
             derivatives(time, state, unused, &row);
    for (int k = 0; k < STATES; ++k) {
        before[k] = y[k];
    }
    const double energy = kinetic(y) + row.stored;
    failed = failed || CVode(cvode, end, state, &time, CV_NORMAL) < 0 ||
             derivatives(time, state, unused, &row);

    /* Both lines of action carry the same force; on the idler they are turned against each other by the bend and twice
     * the working pressure angle. */
    const gm_pair *pair = gm_mesh_pair(row.mesh[0]);
    const double force = torque / pair->pinion.base_radius;
    const double known = 2.0 * force * fabs(cos(pair->working_pressure_angle + 0.5 * bend));
    const double bearing =
        hypot(y[BEARING_X] - before[BEARING_X], y[BEARING_Y] - before[BEARING_Y]) / (end - settled);
    printf("bearing of the idler: %.1f N, by two forces %.1f N\n", bearing, known);

    /* What came in has gone out, been lost or been stored. */
    const double in = y[IN] - before[IN], out = y[OUT] - before[OUT], loss = y[LOSS] - before[LOSS];
    const double open = in - out - loss - (kinetic(y) + row.stored - energy);
    printf("energy: %.3f J in, %.3f J out, %.2g J lost, %.2g %% open\n", in, out, loss,
           100.0 * open / in);

    CVodeFree(&cvode);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(state);
    N_VDestroy(unused);
    SUNContext_Free(&context);
    free(row.mesh[0]);
    free(row.mesh[1]);
    return failed || fabs(open) > 1e-3 * in || fabs(bearing - known) > 1e-3 * known;
}
