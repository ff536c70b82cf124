/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/gearsim/integrate*.c: CVODE and ARKODE on the model, against closed forms and an independent integration. */
#include "integrate.h"

#include "gearsim_case.h"
#include "gm_test.h"

static const double micrometre = 1e-6, pi = 3.14159265358979323846;
static const enum solver_method methods[] = {METHOD_ADAMS, METHOD_BDF, METHOD_ERK};
enum { METHODS = sizeof methods / sizeof methods[0] };

static integrator *create(const gear_model *model, enum solver_method method, double relative,
                          double absolute, const double start[]) {
    const integrator_options options = {
        .method = method, .relative_tolerance = relative, .absolute_tolerance = absolute};
    return integrator_create(model, &options, start);
}

/* Largest error of x (um) of an oscillator let go 1 um from its rest, over ten vibrations. */
static double oscillator_error(enum solver_method method, double tolerance, long *steps) {
    const config conf = case_config(MODEL_SIMPLE, DRIVE_SPEED);
    const gear_mesh gears = case_mesh(&conf);
    gear_model model;
    double rest[STATES_MAX], start[STATES_MAX], largest = 0.0;
    model_init(&model, &conf, &gears);
    model_quasi_static_start(&model, rest);
    start[STATE_OFFSET] = rest[STATE_OFFSET] + 1.0;
    start[STATE_OFFSET_RATE] = 0.0;

    /* Closed form: exp(-z w0 t) (cos wd t + z w0 / wd sin wd t). */
    const double mobility = pow(gears.pair.wheel.base_radius, 2) / case_wheel_inertia;
    const double w0 = sqrt(case_spring(&gears) * mobility);
    const double decay = 0.5 * case_damper(&gears) * mobility;
    const double wd = sqrt(w0 * w0 - decay * decay);

    integrator *solver = create(&model, method, 0.0, tolerance * micrometre, start);
    GM_ASSERT(solver != NULL);
    for (int i = 0; i <= 1000; ++i) {
        const double t = i * 10.0 * 2.0 * pi / w0 / 1000.0;
        double state[STATES_MAX];
        GM_ASSERT_INT(integrator_advance(solver, t, state), 0);
        const double expected =
            rest[STATE_OFFSET] + exp(-decay * t) * (cos(wd * t) + decay / wd * sin(wd * t));
        largest = fmax(largest, fabs(state[STATE_OFFSET] - expected));
    }
    *steps = integrator_counts(solver).steps;
    integrator_free(solver);
    model_free(&model);
    return largest;
}

/*
 * A step may be off by the tolerance; errors of a damped oscillator do not grow, so that all steps
 * together are off by less than their number times that. Smaller tolerance, smaller error.
 */
static void damped_oscillator_is_the_closed_form(void) {
    for (int m = 0; m < METHODS; ++m) {
        double before = (double)INFINITY;
        for (double tolerance = 1e-3; tolerance > 1e-8; tolerance *= 0.01) {
            long steps = 0;
            const double error = oscillator_error(methods[m], tolerance, &steps);
            gm_test_context("method %d, tolerance %g: error %g um, %ld steps", m, tolerance, error,
                            steps);
            GM_ASSERT(steps > 10);
            GM_ASSERT(error < (double)steps * tolerance);
            GM_ASSERT(error < 0.1 * before);
            before = error;
        }
    }
}

/*
 * Neither load nor damping: a wheel that flies through the backlash, is thrown back by one flank, then by
 * the other. A flight through the gap takes gap / v, each contact half a vibration: after twice both it
 * is where it was. Its energy (per mobility) never changes.
 */
static void bouncing_keeps_energy_and_period(void) {
    for (int m = 0; m < METHODS; ++m) {
        config conf = case_config(MODEL_SIMPLE, DRIVE_SPEED);
        conf.mean_load = 0.0;
        conf.damping = 0.0;
        const gear_mesh gears = case_mesh(&conf);
        gear_model model;
        model_init(&model, &conf, &gears);

        const double w0 = model.natural_frequency, gap = 100.0, speed = 30.0; /* um, um w0 */
        const double period = 2.0 * gap / (speed * w0) + 2.0 * pi / w0;
        const double start[STATES_MAX] = {0.0, speed};
        integrator *solver = create(&model, methods[m], 0.0, 1e-8 * micrometre, start);
        double state[STATES_MAX];
        int touched = 0;

        for (int i = 1; i <= 1000; ++i) {
            GM_ASSERT_INT(integrator_advance(solver, 20.0 * period * i / 1000.0, state), 0);
            const double over = fmax(fabs(state[STATE_OFFSET]) - 0.5 * gap, 0.0);
            const double energy = state[STATE_OFFSET_RATE] * state[STATE_OFFSET_RATE] + over * over;
            touched += over > 0.0;
            gm_test_context("method %d, sample %d", m, i);
            /* Each step adds the tolerance of the speed, 20e-8, at most; a wrong speed adds to x for the time
             * of the flights. A bounce that is missed or early makes tens of um. */
            const double drift = 20e-8 * (double)integrator_counts(solver).steps;
            GM_ASSERT_REL(energy, speed * speed, 2.0 * drift / speed);
            if (i % 50 == 0) {
                const double flights = 2.0 * gap / speed * (i / 50);
                GM_ASSERT_ABS(state[STATE_OFFSET], 0.0, drift * flights);
                GM_ASSERT_REL(state[STATE_OFFSET_RATE], speed, drift / speed);
                GM_ASSERT(drift * flights < 1.0);
            }
        }
        GM_ASSERT(touched > 100);
        integrator_free(solver);
        model_free(&model);
    }
}

/* x'' of the simple model from its definition, with the load as it is. */
static double simple_acceleration(const gear_mesh *gears, const load_signal *load, double t,
                                  double x, double v) {
    const double r_bw = gears->pair.wheel.base_radius;
    const double over = fabs(x) - 0.5 * gears->pair.backlash, sign = x > 0.0 ? 1.0 : -1.0;
    const double spring = gm_mesh_mean_stiffness(gears->prepared[0]) * over +
                          sign * gm_mesh_mean_damping(gears->prepared[0]) * v;
    const double force = over > 0.0 ? sign * fmax(spring, 0.0) : 0.0;

    return (r_bw * load_torque(load, t) - r_bw * r_bw * force) / case_wheel_inertia;
}

/* One step of the classical Runge-Kutta method of order 4. */
static void runge_kutta(const gear_mesh *gears, const load_signal *load, double t, double h,
                        double *x, double *v) {
    const double k1x = *v, k1v = simple_acceleration(gears, load, t, *x, *v);
    const double k2x = *v + 0.5 * h * k1v,
                 k2v = simple_acceleration(gears, load, t + 0.5 * h, *x + 0.5 * h * k1x, k2x);
    const double k3x = *v + 0.5 * h * k2v,
                 k3v = simple_acceleration(gears, load, t + 0.5 * h, *x + 0.5 * h * k2x, k3x);
    const double k4x = *v + h * k3v,
                 k4v = simple_acceleration(gears, load, t + h, *x + h * k3x, k4x);
    *x += h / 6.0 * (k1x + 2.0 * k2x + 2.0 * k3x + k4x);
    *v += h / 6.0 * (k1v + 2.0 * k2v + 2.0 * k3v + k4v);
}

typedef struct noise_case {
    double interval;  /* s */
    double amplitude; /* N m, with a mean of 20 */
    double damping;   /* share of the usual one */
    int closed_form;  /* whether the response takes the noise off the state */
    int lifts_off;    /* whether teeth lose contact */
    double allowed;   /* um */
} noise_case;

/* Largest differences over 10 ms (m), for each method; the lowest x as well. */
static void noise_errors(const noise_case *noise, double errors[METHODS], double *lowest) {
    config conf = case_config(MODEL_SIMPLE, DRIVE_SPEED);
    conf.noise_interval = noise->interval;
    conf.noise_amplitude = noise->amplitude;
    conf.damping *= noise->damping;
    conf.seed = 3;
    const gear_mesh gears = case_mesh(&conf);
    gear_model models[METHODS]; /* each has its own look back at the noise */
    integrator *solvers[METHODS];
    double state[STATES_MAX];
    for (int m = 0; m < METHODS; ++m) {
        model_init(&models[m], &conf, &gears);
        model_quasi_static_start(&models[m], state);
        GM_ASSERT_INT(models[m].noise != NULL, noise->closed_form);
        solvers[m] = create(&models[m], methods[m], 0.0, 1e-9 * micrometre, state);
        errors[m] = 0.0;
    }

    const int steps = 200, samples = 1000;
    const double h = 1e-5 / steps;
    double x = state[STATE_OFFSET] * micrometre, v = 0.0;
    *lowest = (double)INFINITY;
    for (int k = 0; k < samples; ++k) {
        for (int j = 0; j < steps; ++j) {
            runge_kutta(&gears, &models[0].load, (k * steps + j) * h, h, &x, &v);
        }
        const double t = (k + 1) * 1e-5;
        for (int m = 0; m < METHODS; ++m) {
            GM_ASSERT_INT(integrator_advance(solvers[m], t, state), 0);
            errors[m] = fmax(errors[m], fabs(model_motion(&models[m], t, state).offset - x));
        }
        *lowest = fmin(*lowest, x);
    }
    for (int m = 0; m < METHODS; ++m) {
        integrator_free(solvers[m]);
        model_free(&models[m]);
    }
}

/*
 * The noise as the load itself, in small fixed steps: no response, no CVODE, no scaling. What differs
 * is the sum of the solver's steps, some 1e3 to 5e4 times 20e-9 um at most, and the fixed steps, which are
 * exact to 1e-8 um except where they meet a kink: a touching or parting costs them about 1e-5 um, which
 * the flights amplify, and of the densest noise they see four points from value to value. The noise
 * moves x by 0.1 um and more.
 */
static void noise_and_loss_of_contact_match_small_fixed_steps(void) {
    static const noise_case cases[] = {
        {1e-5, 10.0, 1.0, 1, 0, 1e-5}, {1e-5, 5.0, 0.0, 1, 0, 1e-5},  {1e-4, 5.0, 30.0, 1, 0, 1e-5},
        {1e-5, 40.0, 0.0, 1, 1, 1e-3}, {2e-7, 60.0, 1.0, 0, 0, 1e-3},
    };

    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        double errors[METHODS], lowest;
        noise_errors(&cases[i], errors, &lowest);
        for (int m = 0; m < METHODS; ++m) {
            gm_test_context("case %zu, method %d: error %g um, lowest %g um", i, m,
                            errors[m] / micrometre, lowest / micrometre);
            GM_ASSERT(errors[m] < cases[i].allowed * micrometre);
        }
        GM_ASSERT_INT(lowest < 50.0 * micrometre, cases[i].lifts_off);
    }
}

/* Error of x and x' (um, um w0) of the oscillator below at a time. */
static void undamped_error(integrator *solver, double w0, double rest, double t, double error[2]) {
    double state[STATES_MAX];

    GM_ASSERT_INT(integrator_advance(solver, t, state), 0);
    error[0] = fabs(state[STATE_OFFSET] - rest - cos(w0 * t));
    error[1] = fabs(state[STATE_OFFSET_RATE] + sin(w0 * t));
}

/*
 * Within a step of ERK: errors of both ends are carried in with the weights of a polynomial of degree 5
 * (5/16 h of a slope at most, and 15/8 / h of a value to the slope), and the polynomial itself is off
 * by (w0 h)^6 / 46080, its slope by 7.5e-5 (w0 h)^5 of the amplitude of 1 um. A cubic's error is some
 * hundred times as large. BDF and Adams have polynomials of their own.
 */
static void values_within_a_step_are_as_good_as_its_ends(void) {
    config conf = case_config(MODEL_SIMPLE, DRIVE_SPEED);
    conf.damping = 0.0;
    const gear_mesh gears = case_mesh(&conf);
    gear_model model;
    double start[STATES_MAX], from[2], inside[2], to[2], longest = 0.0;
    model_init(&model, &conf, &gears);
    model_quasi_static_start(&model, start);
    const double w0 = model.natural_frequency, rest = start[STATE_OFFSET];
    start[STATE_OFFSET] += 1.0;
    integrator *solver = create(&model, METHOD_ERK, 0.0, 1e-5 * micrometre, start);

    for (double begin = 0.0, end; begin * w0 < 30.0; begin = end) {
        undamped_error(solver, w0, rest, begin, from);
        undamped_error(solver, w0, rest, nextafter(begin, 1.0), to);
        end = integrator_time(solver);
        undamped_error(solver, w0, rest, end, to);
        const double turned = w0 * (end - begin);
        longest = fmax(longest, turned);
        for (int i = 1; i < 8; ++i) {
            const double ends = from[0] + to[0] + turned * (from[1] + to[1]);
            undamped_error(solver, w0, rest, begin + 0.125 * i * (end - begin), inside);
            gm_test_context("step of %g rad, eighth %d", turned, i);
            /* x is some 50 um: its rounding. */
            GM_ASSERT(inside[0] <= 1.01 * ends + pow(turned, 6) / 46080.0 + 1e-13);
            GM_ASSERT(inside[1] <= 2.0 * ends / turned + 7.5e-5 * pow(turned, 5) + 1e-13 / turned);
        }
    }
    GM_ASSERT(longest > 0.5);
    integrator_free(solver);
    model_free(&model);
}

/* Samples may lie anywhere between the solver's steps, and more than one in a step. */
static void the_first_sample_is_the_start(void) {
    const config conf = case_config(MODEL_3D, DRIVE_TORQUE);
    const gear_mesh gears = case_mesh(&conf);
    gear_model model;
    double start[STATES_MAX], state[STATES_MAX];
    model_init(&model, &conf, &gears);
    model_quasi_static_start(&model, start);

    for (int m = 0; m < METHODS; ++m) {
        integrator *solver = create(&model, methods[m], 1e-4, 1e-10, start);
        GM_ASSERT_INT(integrator_advance(solver, 0.0, state), 0);
        for (int i = 0; i < STATES_MAX; ++i) {
            GM_ASSERT(state[i] == start[i]);
        }
        GM_ASSERT(integrator_time(solver) == 0.0);
        integrator_free(solver);
    }
    model_free(&model);
}

/* Thrown at the flanks so hard that the mesh would skip a tooth: the reason is told, not a number. */
static void a_skipped_tooth_is_a_failure_with_its_reason(void) {
    const config conf = case_config(MODEL_3D, DRIVE_SPEED);
    const gear_mesh gears = case_mesh(&conf);
    gear_model model;
    model_init(&model, &conf, &gears);

    /* Twice the speed whose energy the spring holds at half a base pitch. */
    const double start[STATES_MAX] = {0.0, 2.0 * 0.5e6 * gears.pair.transverse_base_pitch};
    double state[STATES_MAX];
    for (int m = 0; m < METHODS; ++m) {
        integrator *solver = create(&model, methods[m], 1e-4, 1e-10, start);
        gm_test_context("method %d", m);
        GM_ASSERT_INT(integrator_advance(solver, 1e-2, state), EXIT_RUN_FAILED);
        gm_test_context("method %d: %s", m, integrator_failure(solver));
        GM_ASSERT(strstr(integrator_failure(solver), gm_status_text(GM_STATE_OUT_OF_RANGE)) !=
                  NULL);
        GM_ASSERT(strstr(integrator_failure(solver), "at t = ") != NULL);
        integrator_free(solver);
    }
    model_free(&model);
}

/* A mesh at rest in a phase where nothing changes is no reason to step over the teeth to come, nor is a
 * user's permission. */
static void no_tooth_is_stepped_over(void) {
    const double longest[] = {0.0, 1.0};

    for (int i = 0; i < 2 * METHODS; ++i) {
        const config conf = case_config(MODEL_3D, DRIVE_SPEED);
        const gear_mesh gears = case_mesh(&conf);
        const integrator_options options = {.method = methods[i / 2],
                                            .relative_tolerance = 1e-4,
                                            .absolute_tolerance = 1e-10,
                                            .max_step = longest[i % 2]};
        gear_model model;
        double state[STATES_MAX];
        model_init(&model, &conf, &gears);
        model_quasi_static_start(&model, state);

        integrator *solver = integrator_create(&model, &options, state);
        GM_ASSERT_INT(integrator_advance(solver, 0.1, state), 0);
        /* 100 rad/s: 71.6 teeth in 0.1 s. */
        GM_ASSERT(integrator_counts(solver).steps > 8 * 71);
        integrator_free(solver);
        model_free(&model);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(damped_oscillator_is_the_closed_form),
        GM_TEST(bouncing_keeps_energy_and_period),
        GM_TEST(noise_and_loss_of_contact_match_small_fixed_steps),
        GM_TEST(values_within_a_step_are_as_good_as_its_ends),
        GM_TEST(the_first_sample_is_the_start),
        GM_TEST(a_skipped_tooth_is_a_failure_with_its_reason),
        GM_TEST(no_tooth_is_stepped_over),
    };
    return gm_test_main("gearsim.integrate", tests, GM_TEST_COUNT(tests), argc, argv);
}
