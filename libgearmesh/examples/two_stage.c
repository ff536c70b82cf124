/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * A gearbox of two stages by CVODE: an intermediate shaft that twists carries the wheel of the first and the pinion of the
 * second. Where their teeth stand on the shaft, and where the shafts stand, says how the stages mesh: there are no phases to
 * give. Both gears of the shaft have the same hand, so that their axial forces are against each other: what is left of them
 * is known from torque and helix. So are the frequencies at which the teeth of both stages mesh.
 *
 *     two_stage [FILE]    energies and forces of both stages over time, and the spectra of the forces, for two_stage.gp
 */
#include <cvode/cvode.h>
#include <gearmesh/gearmesh.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { INPUT, LARGE, SMALL, OUTPUT, GEARS, STAGES = 2 }; /* large and small stand on one shaft */
enum {
    IN = 2 * GEARS,
    OUT,
    LOSS,
    AXIAL,
    STATES
}; /* behind angles and speeds: integrals over time */

static const double pi = 3.14159265358979323846;
static const int teeth[GEARS] = {23, 61, 19, 55};
static const double inertia[GEARS] = {3e-4, 6e-3, 3e-4, 1.5e-2};
static const double keyed[GEARS] = {0.0, 0.0, 0.21, 0.0}; /* of tooth 0 on its shaft (rad) */
static const double stage_z[STAGES] = {0.0, 80e-3};
static const double stiffness = 3e8, damping = 3e3, torque = 60.0, speed = 150.0;
static const double shaft_stiffness = 6e4, shaft_damping = 2.0; /* N m/rad, N m s/rad */
static const double bend = 0.7; /* between both lines of centres (rad) */

typedef struct gearbox {
    gm_mesh *mesh[STAGES];
    double place[GEARS][3];
    double zero[GEARS];   /* angles in which they were assembled */
    double stored;        /* in both meshes and the shaft (J) */
    double force[STAGES]; /* along the line of action (N) */
} gearbox;

static gm_mesh *mesh_of(int pinion, int wheel, double module, double helix_angle) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = pinion;
    params.wheel_teeth = wheel;
    params.normal_module = module;
    params.normal_pressure_angle = pi / 9.0;
    params.helix_angle = helix_angle;
    params.center_distance = 0.5 * (pinion + wheel) * module / cos(helix_angle);
    params.face_width = 30e-3;
    params.backlash = 100e-6;

    gm_pair pair;
    gm_mesh_params law;
    gm_mesh *mesh = NULL;
    gm_mesh_params_default(&law);
    law.stiffness = stiffness;
    law.damping = damping;
    law.corner_contact =
        GM_CORNER_ON; /* no line ends with an overlap, whose energy would be open */
    if (gm_pair_init(&pair, &params) == GM_OK) {
        const size_t size = gm_mesh_size(&law, &pair);
        (void)gm_mesh_init(&mesh, &law, &pair, NULL, NULL, malloc(size), size);
    }
    return mesh;
}

static gm_body body_of(const gearbox *box, int gear, const double *y) {
    const double angle = box->zero[gear] + y[gear];
    const double c = cos(angle), s = sin(angle);
    const double *place = box->place[gear];
    const gm_body body = {{place[0], place[1], place[2]},
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
    gearbox *box = (gearbox *)data;
    const double *y = N_VGetArrayPointer(state);
    double *rate = N_VGetArrayPointer(rates);

    /* Both stages turn the sense around; the load grows with the speed of the output. */
    const double ratio = (double)teeth[LARGE] / teeth[INPUT] * teeth[OUTPUT] / teeth[SMALL];
    const double load = torque * ratio * y[GEARS + OUTPUT] / (speed / ratio);

    /* The intermediate shaft, a spring with a damper. */
    const double twist = y[LARGE] - y[SMALL];
    const double untwisting = y[GEARS + LARGE] - y[GEARS + SMALL];
    const double shaft = shaft_stiffness * twist + shaft_damping * untwisting;
    double moment[GEARS] = {torque, -shaft, shaft, -load};
    double loss = shaft_damping * untwisting * untwisting, axial = 0.0;
    (void)t;
    box->stored = 0.5 * shaft_stiffness * twist * twist;

    /* Both meshes: their moments turn the gears, their axial forces meet on the intermediate shaft. */
    for (int stage = 0; stage < STAGES; ++stage) {
        const int driver = 2 * stage, driven = driver + 1;
        const gm_body pinion = body_of(box, driver, y), wheel = body_of(box, driven, y);
        gm_load on[2];
        gm_mesh_result result;
        const int status = gm_mesh_evaluate_bodies(box->mesh[stage], &pinion, &wheel,
                                                   GM_WANT_ENERGY, NULL, &result, &on[0], &on[1]);
        if (status != GM_OK) {
            return status; /* > 0: a smaller step may help */
        }

        moment[driver] += on[0].moment[2];
        moment[driven] += on[1].moment[2];
        axial += on[1 - stage].force[2];
        box->stored += result.energy;
        box->force[stage] = result.force;
        loss += loss_of(&result.contact);
    }

    /* Angles, speeds, and what is summed over time. */
    for (int k = 0; k < GEARS; ++k) {
        rate[k] = y[GEARS + k];
        rate[GEARS + k] = moment[k] / inertia[k];
    }
    rate[IN] = torque * y[GEARS + INPUT];
    rate[OUT] = load * y[GEARS + OUTPUT];
    rate[LOSS] = loss;
    rate[AXIAL] = axial;
    return 0;
}

/* The large gear is turned into its mate; with it stands the small one, and the output gear is turned into that. */
static int assemble(gearbox *box) {
    const double y[2 * GEARS] = {0.0};
    for (int stage = 0; stage < STAGES; ++stage) {
        const int driver = 2 * stage, driven = driver + 1;
        const gm_pair *pair = gm_mesh_pair(box->mesh[stage]);

        /* Where the gears stand: the small one on the shaft of the large one. */
        if (stage > 0) {
            box->place[driver][0] = box->place[driver - 1][0];
            box->place[driver][1] = box->place[driver - 1][1];
            box->zero[driver] = box->zero[driver - 1] + keyed[driver];
        }
        box->place[driven][0] = box->place[driver][0] + pair->center_distance * cos(bend * stage);
        box->place[driven][1] = box->place[driver][1] + pair->center_distance * sin(bend * stage);
        box->place[driver][2] = box->place[driven][2] = stage_z[stage];

        /* Turn the driven gear by its distance from the middle of the backlash. */
        gm_motion motion;
        const gm_body pinion = body_of(box, driver, y), wheel = body_of(box, driven, y);
        if (gm_motion_of_bodies(box->mesh[stage], &pinion, &wheel, &motion, NULL) != GM_OK) {
            return 0;
        }
        box->zero[driven] -= motion.position.offset / pair->wheel.base_radius;
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

/* What the run has found since the start had settled: energies (J), the mean axial force (N), and forces at all steps. */
enum { ROWS = 4000, LINES = 250 };
static const double settled = 0.3, end = 0.4;

typedef struct findings {
    double in, out, loss, stored, axial;
    double force[STAGES][ROWS];
    double line[STAGES][LINES]; /* amplitudes of the forces, each 1 / (end - settled) further (N) */
} findings;

/* Behind the start: a row of the file at each step. */
static int observe(void *cvode, gearbox *box, N_Vector state, N_Vector rates, FILE *file,
                   findings *found) {
    const double *y = N_VGetArrayPointer(state);
    double before[STATES], energy = 0.0;
    sunrealtype time = 0.0;
    for (int row = 0; row <= ROWS; ++row) {
        const double to = settled + (end - settled) * row / ROWS;
        if (CVode(cvode, to, state, &time, CV_NORMAL) < 0 ||
            derivatives(time, state, rates, box) != 0) {
            return 1;
        }

        /* All is told from here on. */
        if (row == 0) {
            memcpy(before, y, sizeof before);
            energy = kinetic(y) + box->stored;
        }

        /* Forces for the spectra, and where the energy has gone. */
        for (int stage = 0; stage < STAGES && row < ROWS; ++stage) {
            found->force[stage][row] = box->force[stage];
        }
        found->in = y[IN] - before[IN];
        found->out = y[OUT] - before[OUT];
        found->loss = y[LOSS] - before[LOSS];
        found->stored = kinetic(y) + box->stored - energy;
        if (file != NULL) {
            fprintf(file, "%.6f %.3f %.3f %.9g %.9g %.9g\n", time, box->force[0], box->force[1],
                    found->in - found->out, found->loss, found->stored);
        }
    }
    found->axial = (y[AXIAL] - before[AXIAL]) / (end - settled);
    return 0;
}

/* Fourier's sum under a window that begins and ends with 0, so that lines between two others do not smear. */
static double amplitude_of(const double force[ROWS], int line) {
    double mean = 0.0, re = 0.0, im = 0.0;
    for (int row = 0; row < ROWS; ++row) {
        mean += force[row] / ROWS;
    }
    for (int row = 0; row < ROWS; ++row) {
        const double turn = 2.0 * pi * row / ROWS;
        const double part = (1.0 - cos(turn)) * (force[row] - mean);
        re += part * cos(line * turn);
        im += part * sin(line * turn);
    }
    return 2.0 * hypot(re, im) / ROWS;
}

static double frequency_of(int line) {
    return line / (end - settled);
}

static double mesh_frequency(int stage) {
    const double first = speed * teeth[INPUT] / (2.0 * pi);
    return stage == 0 ? first : first / teeth[LARGE] * teeth[SMALL];
}

/* The spectra, to the file too; whether the strongest line of each stage is that of its teeth. */
static int find_lines(findings *found, FILE *file) {
    int is_right = 1;
    for (int stage = 0; stage < STAGES; ++stage) {
        int strongest = 1;
        for (int line = 1; line < LINES; ++line) {
            found->line[stage][line] = amplitude_of(found->force[stage], line);
            strongest = found->line[stage][line] > found->line[stage][strongest] ? line : strongest;
        }
        printf("stage %d: strongest line at %.0f Hz, by teeth and speed %.1f Hz\n", stage + 1,
               frequency_of(strongest), mesh_frequency(stage));
        is_right =
            is_right && fabs(frequency_of(strongest) - mesh_frequency(stage)) < frequency_of(1);
    }
    for (int line = 1; line < LINES && file != NULL; ++line) {
        fprintf(file, line == 1 ? "\n\n%.6g %.6g %.6g\n" : "%.6g %.6g %.6g\n", frequency_of(line),
                found->line[0][line], found->line[1][line]);
    }
    return is_right;
}

/* The solver: implicit, as meshes are stiff. */
static int run(gearbox *box, double *y, FILE *file, findings *found) {
    SUNContext context;
#if SUNDIALS_VERSION_MAJOR < 7
    SUNContext_Create(NULL, &context);
#else
    SUNContext_Create(SUN_COMM_NULL, &context);
#endif
    double rate[STATES];
    N_Vector state = N_VMake_Serial(STATES, y, context);
    N_Vector rates = N_VMake_Serial(STATES, rate, context);
    SUNMatrix matrix = SUNDenseMatrix(STATES, STATES, context);
    SUNLinearSolver solver = SUNLinSol_Dense(state, matrix, context);
    void *cvode = CVodeCreate(CV_BDF, context);
    const int failed = CVodeInit(cvode, derivatives, 0.0, state) ||
                       CVodeSStolerances(cvode, 1e-9, 1e-10) || CVodeSetUserData(cvode, box) ||
                       CVodeSetMaxNumSteps(cvode, 1000000) ||
                       CVodeSetLinearSolver(cvode, solver, matrix) ||
                       observe(cvode, box, state, rates, file, found);

    CVodeFree(&cvode);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(rates);
    N_VDestroy(state);
    SUNContext_Free(&context);
    return failed;
}

int main(int argc, char **argv) {
    static findings found;
    const double first_helix = pi / 9.0, second_helix = -pi / 18.0;
    double y[STATES] = {0.0};
    gearbox box = {.mesh = {mesh_of(teeth[INPUT], teeth[LARGE], 2e-3, first_helix),
                            mesh_of(teeth[SMALL], teeth[OUTPUT], 3e-3, second_helix)}};
    if (box.mesh[0] == NULL || box.mesh[1] == NULL || !assemble(&box)) {
        return 1;
    }

    /* All gears turn at their steady speeds. */
    y[GEARS + INPUT] = speed;
    y[GEARS + LARGE] = y[GEARS + SMALL] = -speed * teeth[INPUT] / teeth[LARGE];
    y[GEARS + OUTPUT] = -y[GEARS + SMALL] * teeth[SMALL] / teeth[OUTPUT];
    FILE *file = argc > 1 ? fopen(argv[1], "w") : NULL;
    const int failed = run(&box, y, file, &found) || (argc > 1 && file == NULL);
    const int is_right = find_lines(&found, file);
    if (file != NULL) {
        fclose(file);
    }

    /* A right-handed pinion that drives counter-clockwise is pushed along +z, its wheel the other way; the small gear is
     * left-handed and turns clockwise. */
    const gm_pair *first = gm_mesh_pair(box.mesh[0]), *second = gm_mesh_pair(box.mesh[1]);
    const double first_force = torque / first->pinion.base_radius;
    const double second_force = torque * teeth[LARGE] / teeth[INPUT] / second->pinion.base_radius;
    const double known =
        -first_force * tan(first->base_helix_angle) - second_force * tan(second->base_helix_angle);
    printf("axial force of the shaft: %.1f N, by both helices %.1f N\n", found.axial, known);

    /* What came in has gone out, been lost or been stored. Open are the accuracy of the solver, and what dampers do beyond
     * the path: they act by dx/dt, while edges approach the flank by more. */
    const double open = found.in - found.out - found.loss - found.stored;
    printf("energy: %.3f J in, %.3f J out, %.2g J lost, %.2g %% open\n", found.in, found.out,
           found.loss, 100.0 * open / found.in);
    free(box.mesh[0]);
    free(box.mesh[1]);
    return failed || !is_right || fabs(open) > 1e-3 * found.in ||
           fabs(found.axial - known) > 1e-3 * fabs(second_force);
}
