/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * A planetary set: sun, planets, a ring that stands still, and a carrier that is free to turn, by CVODE. Each mesh sees two
 * bodies; that planets mesh at different phases follows from where they stand. The pin of planet 0 is off its place by 5 um
 * along its way, so that it carries more or less than its part of the load: by how much is known.
 *
 *     planetary [FILE|- [PLANETS [SUN PLANET]]]    3 planets, sun of 28 and planets of 35 teeth
 *
 * FILE gets the force of each planet on the carrier over time, for planetary.gp.
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

enum { PLANETS_MAX = 12, TURNS_MAX = 2 + PLANETS_MAX };
enum {
    IN,
    OUT,
    LOSS,
    ANGLES,
    STATES_MAX = ANGLES + 2 * TURNS_MAX
}; /* energies; angles and speeds */

static const double pi = 3.14159265358979323846;
static const double stiffness = 3e8, damping = 3e3, sun_torque = 300.0, speed = 60.0;
static const double sun_inertia = 1e-3, carrier_inertia = 2e-2, planet_inertia = 2e-3;
static const double displaced = 5e-6; /* planet 0, along its way (m) */

typedef struct gearbox {
    int planets, turns;    /* how many planets; and they, sun and carrier */
    int sun, planet, ring; /* numbers of teeth */
    gm_mesh *at_sun, *at_ring;
    double arm;               /* of the carrier (m) */
    double ring_angle;        /* where the ring is fixed */
    double push[PLANETS_MAX]; /* tangential force on the carrier (N) */
    double stored;            /* in all meshes (J) */
} gearbox;

static double inertia_of(int turn) {
    return turn == 0 ? sun_inertia : turn == 1 ? carrier_inertia : planet_inertia;
}

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

/* Angles of sun, carrier and planets, and behind them their speeds. */
static gm_body planet_of(const gearbox *box, int planet, const double *angles) {
    const double *speeds = angles + box->turns;
    const double along = planet == 0 ? displaced / box->arm : 0.0;
    const double place = angles[1] + 2.0 * pi * planet / box->planets + along;
    return body_at(box->arm, place, speeds[1], angles[2 + planet], speeds[2 + planet]);
}

/* Of the carrier, as the sun turns: from the numbers of teeth. */
static double carrier_speed(const gearbox *box) {
    return speed * box->sun / (box->sun + box->ring);
}

static int derivatives(sunrealtype t, N_Vector state, N_Vector rates, void *data) {
    gearbox *box = (gearbox *)data;
    const double *angles = N_VGetArrayPointer(state) + ANGLES, *speeds = angles + box->turns;
    double *rate = N_VGetArrayPointer(rates);

    /* Sun and ring turn about the middle; the load of the carrier grows with its speed. */
    const gm_body sun = body_at(0.0, 0.0, 0.0, angles[0], speeds[0]);
    const gm_body ring = body_at(0.0, 0.0, 0.0, box->ring_angle, 0.0);
    const double load =
        sun_torque * (1.0 + (double)box->ring / box->sun) * speeds[1] / carrier_speed(box);
    double torque[TURNS_MAX] = {sun_torque, -load};
    (void)t;

    /* Each planet turns by both moments and pushes its pin by both forces. */
    double loss = 0.0;
    box->stored = 0.0;
    for (int k = 0; k < box->planets; ++k) {
        const gm_body planet = planet_of(box, k, angles);
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
    for (int k = 0; k < box->turns; ++k) {
        rate[ANGLES + k] = speeds[k];
        rate[ANGLES + box->turns + k] = torque[k] / inertia_of(k);
    }
    rate[IN] = sun_torque * speeds[0];
    rate[OUT] = load * speeds[1];
    rate[LOSS] = loss;
    return 0;
}

/* Turns each planet until it stands in the middle of the sun's backlash, and the ring for planet 0; the other planets
 * then fit, as z_s + z_r is divisible by their number. */
static int assemble(gearbox *box, double *angles) {
    for (int k = 0; k < box->planets; ++k) {
        /* Turn the planet by its distance from the middle of the sun's backlash. */
        gm_motion motion;
        const gm_body sun = body_at(0.0, 0.0, 0.0, 0.0, 0.0);
        const gm_body ring = body_at(0.0, 0.0, 0.0, box->ring_angle, 0.0);
        gm_body planet = planet_of(box, k, angles);
        if (gm_motion_of_bodies(box->at_sun, &sun, &planet, &motion, NULL) != GM_OK) {
            return 0;
        }
        angles[2 + k] -= motion.position.offset / gm_mesh_pair(box->at_sun)->wheel.base_radius;

        /* Then the first planet's ring; the others have to fit into it by themselves. */
        planet = planet_of(box, k, angles);
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

static double kinetic(const gearbox *box, const double *y) {
    const double *speeds = y + ANGLES + box->turns;
    double energy = 0.0;
    for (int k = 0; k < box->turns; ++k) {
        energy += 0.5 * inertia_of(k) * speeds[k] * speeds[k];
    }
    return energy;
}

/* Steady speeds of the set. */
static void set_speeds(const gearbox *box, double *speeds) {
    const double carrier = carrier_speed(box);
    speeds[0] = speed;
    speeds[1] = carrier;
    for (int k = 0; k < box->planets; ++k) {
        speeds[2 + k] = carrier * (1.0 - (double)box->ring / box->planet);
    }
}

/*
 * Share of the load that planet 0 carries, if it carries any: springs of both meshes in a row. 5 um along the way are
 * 5 um cos(alpha_wt) along each line of action.
 */
static double share_by_springs(const gearbox *box) {
    const gm_pair *sun = gm_mesh_pair(box->at_sun), *ring = gm_mesh_pair(box->at_ring);
    const double spring =
        stiffness / (1.0 / sun->transverse_contact_ratio + 1.0 / ring->transverse_contact_ratio);
    const double force = sun_torque / (box->planets * sun->pinion.base_radius);
    const double less = spring * 2.0 * displaced * cos(sun->working_pressure_angle) / force;
    return fmax(0.0, (1.0 - less * (box->planets - 1) / box->planets) / box->planets);
}

/* What the run has found: means of what pushes the carrier, and energies since the start had settled (J). */
typedef struct findings {
    double push[PLANETS_MAX];
    double in, out, loss, stored;
} findings;

enum { ROWS = 1500 };
static const double settled = 0.02, end = 0.05;

/* Behind the start: a row of the file at each step, and the means. */
static int observe(void *cvode, gearbox *box, N_Vector state, N_Vector rates, FILE *file,
                   findings *found) {
    const double *y = N_VGetArrayPointer(state);
    double before[ANGLES], energy = 0.0;
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
            energy = kinetic(box, y) + box->stored;
        }

        if (file != NULL) {
            fprintf(file, "%.6f", time);
        }
        for (int k = 0; k < box->planets; ++k) {
            found->push[k] += box->push[k] / (ROWS + 1);
            if (file != NULL) {
                fprintf(file, k + 1 < box->planets ? " %.3f" : " %.3f\n", box->push[k]);
            }
        }
    }

    found->in = y[IN] - before[IN];
    found->out = y[OUT] - before[OUT];
    found->loss = y[LOSS] - before[LOSS];
    found->stored = kinetic(box, y) + box->stored - energy;
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
    const int states = ANGLES + 2 * box->turns;
    double rate[STATES_MAX];
    N_Vector state = N_VMake_Serial(states, y, context);
    N_Vector rates = N_VMake_Serial(states, rate, context);
    SUNMatrix matrix = SUNDenseMatrix(states, states, context);
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

/*
 * Planets at equal steps mesh with sun and ring only where z_s + z_r is divisible by their number; and next to each other
 * only where their tips do not meet.
 */
static int is_possible(const gearbox *box) {
    if (box->planets < 1 || box->planets > PLANETS_MAX || box->sun < 10 || box->planet < 10) {
        fprintf(stderr, "planetary: 1 to %d planets, and teeth from 10 on\n", PLANETS_MAX);
        return 0;
    }

    /* The same phase at every planet, or none. */
    if ((box->sun + box->ring) % box->planets != 0) {
        fprintf(stderr, "planetary: %d planets do not fit: (%d + %d) / %d is no whole number\n",
                box->planets, box->sun, box->ring, box->planets);
        return 0;
    }
    if (box->at_sun == NULL || box->at_ring == NULL) {
        fprintf(stderr, "planetary: no gears with these teeth\n");
        return 0;
    }

    /* Neighbours on the carrier. */
    const double apart = 2.0 * box->arm * sin(pi / box->planets);
    if (box->planets > 1 && apart < 2.0 * gm_mesh_pair(box->at_sun)->wheel.tip_radius) {
        fprintf(stderr, "planetary: %d planets do not fit: their tips meet\n", box->planets);
        return 0;
    }
    return 1;
}

/* Share of each planet, and of the first one what is known; whether both agree. */
static int print_shares(const gearbox *box, const findings *found) {
    double all = 0.0;
    for (int k = 0; k < box->planets; ++k) {
        all += found->push[k];
    }
    const double expected = share_by_springs(box), share = found->push[0] / all;
    printf("planet 0 carries %.1f %% of the load, by springs %.1f %%", 100.0 * share,
           100.0 * expected);
    for (int k = 1; k < box->planets; ++k) {
        printf("%s %.1f %%", k == 1 ? "; the others" : ",", 100.0 * found->push[k] / all);
    }
    printf("\n");
    return fabs(share - expected) < 0.01;
}

int main(int argc, char **argv) {
    gearbox box = {.planets = argc > 2 ? atoi(argv[2]) : 3,
                   .sun = argc > 4 ? atoi(argv[3]) : 28,
                   .planet = argc > 4 ? atoi(argv[4]) : 35};
    box.turns = 2 + box.planets;
    box.ring = box.sun + 2 * box.planet;

    /* Two meshes, which all planets share, and the gears put together at their steady speeds. */
    double distance, y[STATES_MAX] = {0.0};
    box.at_sun = mesh_of(box.sun, box.planet, pi / 18.0, &box.arm);
    box.at_ring = mesh_of(box.planet, -box.ring, -pi / 18.0, &distance);
    if (!is_possible(&box)) {
        return 2;
    }
    if (!assemble(&box, y + ANGLES)) {
        fprintf(stderr, "planetary: the planets do not fit into the ring\n");
        return 1;
    }
    set_speeds(&box, y + ANGLES + box.turns);

    const int to_file = argc > 1 && strcmp(argv[1], "-") != 0;
    FILE *file = to_file ? fopen(argv[1], "w") : NULL;
    findings found = {{0.0}, 0.0, 0.0, 0.0, 0.0};
    const int failed = run(&box, y, file, &found);
    if (file != NULL) {
        fclose(file);
    }

    /* What was found, beside what is known. Open are the accuracy of the solver, and flanks that leave at a tip with some
     * overlap. */
    const int is_shared = print_shares(&box, &found);
    const double open = found.in - found.out - found.loss - found.stored;
    printf("energy: %.3f J in, %.3f J out, %.2g J lost, %.2g %% open\n", found.in, found.out,
           found.loss, 100.0 * open / found.in);
    free(box.at_sun);
    free(box.at_ring);
    return failed || (to_file && file == NULL) || fabs(open) > 1e-3 * found.in || !is_shared;
}
