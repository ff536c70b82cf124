/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * A planetary set: sun, three planets, a ring that stands still, and a carrier that is free to turn, by CVODE. Each of the
 * six meshes sees two bodies; that planets mesh at different phases follows from where they stand. The pin of planet 0 is
 * off its place by 5 um along its way, so that it carries more or less than a third of the load: by how much is known.
 *
 *     planetary [FILE]    the force of each planet on the carrier over time, for planetary.gp
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

enum { SUN = 28, PLANET = 35, RING = 98, PLANETS = 3, TURNS = 2 + PLANETS };
enum { IN = 2 * TURNS, OUT, LOSS, STATES }; /* behind angles and speeds: energies */

static const double pi = 3.14159265358979323846;
static const double stiffness = 3e8, damping = 3e3, sun_torque = 300.0, speed = 60.0;
static const double inertia[TURNS] = {1e-3, 2e-2, 2e-3, 2e-3,
                                      2e-3}; /* sun, carrier with planets, planets */
static const double displaced = 5e-6;        /* planet 0, along its way (m) */

typedef struct gearbox {
    gm_mesh *at_sun, *at_ring;
    double arm;           /* of the carrier (m) */
    double ring_angle;    /* where the ring is fixed */
    double push[PLANETS]; /* tangential force on the carrier (N) */
    double stored;        /* in all meshes (J) */
} gearbox;

static gm_mesh *mesh_of(int pinion, int wheel, double helix_angle, double *distance) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = pinion;
    params.wheel_teeth = wheel;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = pi / 9.0;
    params.helix_angle = helix_angle;
    params.center_distance = abs(pinion + wheel) * 1e-3 / cos(helix_angle);
    params.face_width = 30e-3;
    params.backlash = 100e-6;
    *distance = params.center_distance;

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

/* Around the z axis at `radius` and `place`, turned by `angle`. */
static gm_body body_at(double radius, double place, double orbit, double angle, double turning) {
    const double c = cos(angle), s = sin(angle);
    const gm_body body = {
        {radius * cos(place), radius * sin(place), 0.0},
        {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0},
        {-radius * orbit * sin(place), radius * orbit * cos(place), 0.0},
        {0.0, 0.0, turning},
    };
    return body;
}

/* What damping takes: parallel axes approach each other at one speed all over the side that touches, the drive side. */
static double loss_of(const gm_penetration *c) {
    return c->drive_contact > 0.0 ? damping * c->drive_rate * c->drive_rate / c->drive_contact
                                  : 0.0;
}

static double place_of(int planet, const double *y) {
    return y[1] + 2.0 * pi * planet / PLANETS;
}

static gm_body planet_of(const gearbox *box, int planet, const double *y) {
    const double along = planet == 0 ? displaced / box->arm : 0.0;
    return body_at(box->arm, place_of(planet, y) + along, y[TURNS + 1], y[2 + planet],
                   y[TURNS + 2 + planet]);
}

/* y: angles of sun, carrier and planets, their speeds, energies. */
static int derivatives(sunrealtype t, N_Vector state, N_Vector rates, void *data) {
    gearbox *box = (gearbox *)data;
    const double *y = N_VGetArrayPointer(state);
    double *rate = N_VGetArrayPointer(rates);

    /* Sun and ring turn about the middle; the load of the carrier grows with its speed. */
    const gm_body sun = body_at(0.0, 0.0, 0.0, y[0], y[TURNS]);
    const gm_body ring = body_at(0.0, 0.0, 0.0, box->ring_angle, 0.0);
    const double load =
        sun_torque * (1.0 + (double)RING / SUN) * y[TURNS + 1] / (speed * SUN / (SUN + RING));
    double torque[TURNS] = {sun_torque, -load};
    (void)t;

    /* Each planet turns by both moments and pushes its pin by both forces. */
    double loss = 0.0;
    box->stored = 0.0;
    for (int k = 0; k < PLANETS; ++k) {
        const gm_body planet = planet_of(box, k, y);
        gm_mesh_result inner, outer;
        gm_load on_sun, from_sun, from_ring, on_ring;
        int status = gm_mesh_evaluate_bodies(box->at_sun, &sun, &planet, GM_WANT_ENERGY, NULL,
                                             &inner, &on_sun, &from_sun);
        if (status == GM_OK) {
            status = gm_mesh_evaluate_bodies(box->at_ring, &planet, &ring, GM_WANT_ENERGY, NULL,
                                             &outer, &from_ring, &on_ring);
        }
        if (status != GM_OK) {
            return status; /* > 0: a smaller step may help */
        }

        /* The force on the pin has a moment about the middle: that of the carrier. */
        const double *p = planet.position;
        const double f[2] = {from_sun.force[0] + from_ring.force[0],
                             from_sun.force[1] + from_ring.force[1]};
        torque[0] += on_sun.moment[2];
        torque[1] += p[0] * f[1] - p[1] * f[0];
        torque[2 + k] = from_sun.moment[2] + from_ring.moment[2];
        box->push[k] = (p[0] * f[1] - p[1] * f[0]) / box->arm;
        box->stored += inner.energy + outer.energy;
        loss += loss_of(&inner.contact) + loss_of(&outer.contact);
    }

    /* Angles, speeds, and what is summed over time. */
    for (int k = 0; k < TURNS; ++k) {
        rate[k] = y[TURNS + k];
        rate[TURNS + k] = torque[k] / inertia[k];
    }
    rate[IN] = sun_torque * y[TURNS];
    rate[OUT] = load * y[TURNS + 1];
    rate[LOSS] = loss;
    return 0;
}

/* Turns each planet until it stands in the middle of the sun's backlash, and the ring for planet 0; the other planets
 * then fit, as z_s + z_r is divisible by their number. */
static int assemble(gearbox *box, double *y) {
    for (int k = 0; k < PLANETS; ++k) {
        /* Turn the planet by its distance from the middle of the sun's backlash. */
        gm_motion motion;
        const gm_body sun = body_at(0.0, 0.0, 0.0, 0.0, 0.0);
        const gm_body ring = body_at(0.0, 0.0, 0.0, box->ring_angle, 0.0);
        gm_body planet = planet_of(box, k, y);
        if (gm_motion_of_bodies(box->at_sun, &sun, &planet, &motion, NULL) != GM_OK) {
            return 0;
        }
        y[2 + k] -= motion.position.offset / gm_mesh_pair(box->at_sun)->wheel.base_radius;

        /* Then the first planet's ring; the others have to fit into it by themselves. */
        planet = planet_of(box, k, y);
        if (gm_motion_of_bodies(box->at_ring, &planet, &ring, &motion, NULL) != GM_OK) {
            return 0;
        }
        if (k == 0) {
            box->ring_angle +=
                motion.position.offset / gm_mesh_pair(box->at_ring)->wheel.base_radius;
        } else if (fabs(motion.position.offset) > 100e-6) {
            return 0;
        }
    }
    return 1;
}

static double kinetic(const double *y) {
    double energy = 0.0;
    for (int k = 0; k < TURNS; ++k) {
        energy += 0.5 * inertia[k] * y[TURNS + k] * y[TURNS + k];
    }
    return energy;
}

/* Steady speeds of the set, from its numbers of teeth. */
static void set_speeds(double *y) {
    const double carrier = speed * SUN / (SUN + RING);
    y[TURNS] = speed;
    y[TURNS + 1] = carrier;
    for (int k = 0; k < PLANETS; ++k) {
        y[TURNS + 2 + k] = carrier * (1.0 - (double)RING / PLANET);
    }
}

/*
 * Share of the load that planet 0 carries: springs of both meshes in a row; 5 um along the way are 5 um cos(alpha_wt)
 * along each line of action.
 */
static double share_by_springs(const gearbox *box) {
    const gm_pair *sun = gm_mesh_pair(box->at_sun), *ring = gm_mesh_pair(box->at_ring);
    const double spring =
        stiffness / (1.0 / sun->transverse_contact_ratio + 1.0 / ring->transverse_contact_ratio);
    const double force = sun_torque / (PLANETS * sun->pinion.base_radius);
    const double less = spring * 2.0 * displaced * cos(sun->working_pressure_angle) / force;
    return (1.0 - less * (PLANETS - 1) / PLANETS) / PLANETS;
}

/* What the run has found: means of what pushes the carrier, and energies since the start had settled (J). */
typedef struct findings {
    double push[PLANETS];
    double in, out, loss, stored;
} findings;

enum { ROWS = 1500 };
static const double settled = 0.02, end = 0.05;

/* Behind the start: a row of the file at each step, and the means. */
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
        if (row == 0) {
            memcpy(before, y, sizeof before);
            energy = kinetic(y) + box->stored;
        }
        for (int k = 0; k < PLANETS; ++k) {
            found->push[k] += box->push[k] / (ROWS + 1);
        }
        if (file != NULL) {
            fprintf(file, "%.6f %.3f %.3f %.3f\n", time, box->push[0], box->push[1], box->push[2]);
        }
    }

    found->in = y[IN] - before[IN];
    found->out = y[OUT] - before[OUT];
    found->loss = y[LOSS] - before[LOSS];
    found->stored = kinetic(y) + box->stored - energy;
    return 0;
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
    /* Two meshes, which all planets share, and the gears put together at their steady speeds. */
    double distance, y[STATES] = {0.0};
    gearbox box = {.arm = 0.0};
    box.at_sun = mesh_of(SUN, PLANET, pi / 18.0, &box.arm);
    box.at_ring = mesh_of(PLANET, -RING, -pi / 18.0, &distance);
    if (box.at_sun == NULL || box.at_ring == NULL || !assemble(&box, y)) {
        return 1;
    }
    set_speeds(y);

    FILE *file = argc > 1 ? fopen(argv[1], "w") : NULL;
    findings found = {{0.0}, 0.0, 0.0, 0.0, 0.0};
    const int failed = run(&box, y, file, &found);
    if (file != NULL) {
        fclose(file);
    }

    /* What was found, beside what is known. */
    const double expected = share_by_springs(&box);
    const double share = found.push[0] / (found.push[0] + found.push[1] + found.push[2]);
    printf("planet 0 carries %.1f %% of the load, by springs %.1f %%\n", 100.0 * share,
           100.0 * expected);

    /* Open are the accuracy of the solver, and flanks that leave at a tip with some overlap. */
    const double open = found.in - found.out - found.loss - found.stored;
    printf("energy: %.3f J in, %.3f J out, %.2g J lost, %.2g %% open\n", found.in, found.out,
           found.loss, 100.0 * open / found.in);
    free(box.at_sun);
    free(box.at_ring);
    return failed || fabs(open) > 1e-3 * found.in || fabs(share - expected) > 0.01;
}
