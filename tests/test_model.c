/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/gearsim/model.c, flight.c: equations of motion, their tangent, the quasi-static start, free flight. */
#include "flight.h"
#include "model.h"

#include "gearsim_case.h"
#include "gm_test.h"

static const double micrometre = 1e-6;
static const enum mesh_model meshes[] = {MODEL_SIMPLE, MODEL_3D};
static const enum drive_kind drives[] = {DRIVE_SPEED, DRIVE_TORQUE};

/* A scaled state from x (m), x' (m/s), phi_p (rad), phi_p' (rad/s), without noise. */
static void set_state(const gear_model *model, double x, double rate, double angle, double speed,
                      double state[STATES_MAX]) {
    const double r_bp = model->gears->pair.pinion.base_radius;
    const double speed_unit = model->natural_frequency * micrometre;

    state[STATE_OFFSET] = x / micrometre;
    state[STATE_OFFSET_RATE] = rate / speed_unit;
    state[STATE_PINION_ARC] = r_bp * angle / micrometre;
    state[STATE_PINION_SPEED] = r_bp * speed / speed_unit;
}

/* x'' and phi_p'' in SI units from the derivative of the scaled state. */
static void accelerations(const gear_model *model, double time, const double state[STATES_MAX],
                          double *offset, double *pinion) {
    const double unit = model->natural_frequency * micrometre;
    double derivative[STATES_MAX] = {0.0};
    enum mesh_contact contact;

    GM_ASSERT_INT(model_derivative(model, time, state, derivative, &contact), GM_OK);
    *offset = derivative[STATE_OFFSET_RATE] * unit;
    *pinion = derivative[STATE_PINION_SPEED] * unit / model->gears->pair.pinion.base_radius;
}

/* Newton's law for each body by itself, with the force of the simple model written out. */
static void bodies_obey_newton(void) {
    const double offsets[] = {52e-6, 40e-6, -55e-6};
    const double rate = 2e-3, angle = 3.0, speed = 120.0;

    for (int d = 0; d < 2; ++d) {
        config conf = case_config(MODEL_SIMPLE, drives[d]);
        conf.end_speed = 400.0;
        const gear_mesh gears = case_mesh(&conf);
        gear_model model;
        GM_ASSERT_INT(model_init(&model, &conf, &gears), 0);

        for (int i = 0; i < 3; ++i) {
            const double x = offsets[i];
            const double over = fabs(x) - 50e-6;
            const double sign = x > 0.0 ? 1.0 : -1.0;
            const double spring = case_spring(&gears) * over + case_damper(&gears) * rate * sign;
            const double force = over > 0.0 ? sign * fmax(spring, 0.0) : 0.0;

            const double r_bp = gears.pair.pinion.base_radius, r_bw = gears.pair.wheel.base_radius;
            const double wheel = (-20.0 + force * r_bw) / case_wheel_inertia;
            const double pinion = d == 0 ? 300.0 : (22.0 - force * r_bp) / case_pinion_inertia;

            double state[STATES_MAX], offset_got, pinion_got;
            set_state(&model, x, rate, angle, speed, state);
            accelerations(&model, 0.0, state, &offset_got, &pinion_got);
            gm_test_context("drive %d, x = %g", d, x);
            /* x - 50 um loses three digits of sixteen. */
            GM_ASSERT_NEAR(offset_got, r_bp * pinion - r_bw * wheel, 1e-12, 1e-12);
            if (d == 1) {
                GM_ASSERT_NEAR(pinion_got, pinion, 1e-12, 1e-12);
            }
        }
        model_free(&model);
    }
}

/* 2 zeta sqrt(K_mean m) of all pairs, m the mass of the bodies against each other along the line of action. */
static void damping_ratio_is_a_share_of_critical_damping(void) {
    const double zeta = 0.07;

    for (int i = 0; i < 8; ++i) {
        config conf = case_config(meshes[i & 1], drives[i >> 1 & 1]);
        conf.law = i >> 2 ? LAW_ISO6336 : LAW_CONSTANT;
        conf.damping = (double)NAN;
        conf.damping_ratio = zeta;
        const gear_mesh gears = case_mesh(&conf);

        const double r_bp = gears.pair.pinion.base_radius, r_bw = gears.pair.wheel.base_radius;
        const double pinion = conf.drive == DRIVE_TORQUE ? r_bp * r_bp / case_pinion_inertia : 0.0;
        const double mass = 1.0 / (pinion + r_bw * r_bw / case_wheel_inertia);
        const double k = gm_mesh_mean_stiffness(gears.prepared[0]);
        gm_test_context("case %d", i);
        GM_ASSERT_REL(gm_mesh_mean_damping(gears.prepared[0]), 2.0 * zeta * sqrt(k * mass), 1e-14);
    }
}

/* Derivative row by central differences along one state. */
static void difference(const gear_model *model, const double state[STATES_MAX], int column,
                       double step, double result[STATES_MAX]) {
    double below[STATES_MAX] = {0.0}, above[STATES_MAX] = {0.0}, moved[STATES_MAX];
    enum mesh_contact contact;

    memcpy(moved, state, sizeof moved);
    moved[column] = state[column] - step;
    GM_ASSERT_INT(model_derivative(model, 0.1, moved, below, &contact), GM_OK);
    moved[column] = state[column] + step;
    GM_ASSERT_INT(model_derivative(model, 0.1, moved, above, &contact), GM_OK);
    for (int row = 0; row < model->states; ++row) {
        result[row] = (above[row] - below[row]) / (2.0 * step);
    }
}

/*
 * At x' = 0, where nothing is left out of the Jacobian. Differences over 1e-4 um: their rounding is that
 * of F (1e-16 * 500 N out of 50 um + 2 um: 1e-12 relative) over 1e-4 of 2 um; truncation is small, as the
 * force is quadratic in x between kinks. A state whose difference straddles a kink may be off: few are.
 */
static void jacobian_is_that_of_differences(void) {
    for (int m = 0; m < 3; ++m) {
        for (int d = 0; d < 2; ++d) {
            /* The third time with friction. */
            config conf = case_config(meshes[m % 2], drives[d]);
            conf.friction_coefficient = m == 2 ? 0.1 : 0.0;
            conf.pinion_drag = 0.3;
            conf.wheel_drag = 0.5;
            conf.load_per_speed = 0.7;
            conf.load_per_speed_squared = 0.02;
            conf.drive_ripple = (ripple){1, {{2.0, 40.0, 0.3}}};
            conf.load_ripple = (ripple){2, {{3.0, 30.0, 0.0}, {0.5, 20.0, 1.0}}};
            const gear_mesh gears = case_mesh(&conf);
            gear_model model;
            int compared = 0, kinks = 0;
            uint64_t seed = 5;
            model_init(&model, &conf, &gears);

            for (int i = 0; i < 200; ++i) {
                double state[STATES_MAX], rates[STATES_MAX], expected[STATES_MAX];
                model_tangent tangent;
                enum mesh_contact contact;
                const double side = i % 4 == 0 ? -1.0 : 1.0;
                set_state(&model, side * gm_test_uniform(&seed, 45e-6, 60e-6), 0.0,
                          gm_test_uniform(&seed, 0.0, 20.0), 100.0, state);
                GM_ASSERT_INT(
                    model_derivative_and_tangent(&model, 0.1, state, rates, &tangent, &contact),
                    GM_OK);

                for (int column = 0; column < model.states; ++column) {
                    difference(&model, state, column, 1e-4, expected);
                    for (int row = 0; row < model.states; ++row) {
                        /* Speed rows have the size w0, which is what the solver sees. */
                        const double scale = model.natural_frequency;
                        /* What the tangent leaves out: lines that grow with x, and friction. */
                        const double left_out = m == 2 ? 0.1 : m == 1 ? 1e-3 : 0.0;
                        ++compared;
                        kinks += fabs(tangent.jacobian[column][row] - expected[row]) >
                                 (1e-6 + left_out) * scale;
                    }
                }
            }
            gm_test_context("mesh %d, drive %d: %d of %d differ", m, d, kinks, compared);
            GM_ASSERT(compared >= 800);
            GM_ASSERT(kinks * 200 <= compared);
            model_free(&model);
        }
    }
}

/* The damping's entry needs x' != 0 on neither side of zero: in firm contact it is D times the contact. */
static void jacobian_knows_when_flanks_would_pull(void) {
    const config conf = case_config(MODEL_SIMPLE, DRIVE_SPEED);
    const gear_mesh gears = case_mesh(&conf);
    gear_model model;
    double state[STATES_MAX], rates[STATES_MAX];
    model_tangent tangent;
    enum mesh_contact contact;
    model_init(&model, &conf, &gears);

    /* Parting so fast that the damper would pull: no force, no derivative. */
    set_state(&model, 50.1e-6, -1.0, 0.0, 0.0, state);
    model_derivative_and_tangent(&model, 0.0, state, rates, &tangent, &contact);
    GM_ASSERT(tangent.jacobian[STATE_OFFSET][STATE_OFFSET_RATE] == 0.0);
    GM_ASSERT(tangent.jacobian[STATE_OFFSET_RATE][STATE_OFFSET_RATE] == 0.0);

    set_state(&model, 52e-6, 1e-3, 0.0, 0.0, state);
    model_derivative_and_tangent(&model, 0.0, state, rates, &tangent, &contact);
    const double mobility = pow(gears.pair.wheel.base_radius, 2) / case_wheel_inertia;
    GM_ASSERT_REL(tangent.jacobian[STATE_OFFSET_RATE][STATE_OFFSET_RATE],
                  -case_damper(&gears) * mobility, 1e-13);
    GM_ASSERT_REL(tangent.jacobian[STATE_OFFSET][STATE_OFFSET_RATE],
                  -case_spring(&gears) * mobility / model.natural_frequency, 1e-13);
    model_free(&model);
}

/* Nothing moves relative to the rigid motion, under load both ways, at rest and speeding up. */
static void start_is_an_equilibrium(void) {
    const double loads[] = {20.0, -20.0};

    for (int m = 0; m < 2; ++m) {
        for (int d = 0; d < 2; ++d) {
            for (int l = 0; l < 2; ++l) {
                config conf = case_config(meshes[m], drives[d]);
                conf.mean_load = loads[l];
                conf.drive_torque = 1.2 * loads[l];
                conf.end_speed = 400.0;
                conf.drive_ripple = (ripple){1, {{2.0, 3.0, 0.3}}};
                conf.load_ripple = (ripple){1, {{3.0, 4.0, 1.0}}};
                const gear_mesh gears = case_mesh(&conf);
                gear_model model;
                double state[STATES_MAX], offset, pinion;
                model_init(&model, &conf, &gears);

                gm_test_context("mesh %d, drive %d, load %g", m, d, loads[l]);
                GM_ASSERT_INT(model_quasi_static_start(&model, state), GM_OK);
                accelerations(&model, 0.0, state, &offset, &pinion);
                /* Without contact it would be 400 m/s2. 1e-12: the rounding of 52 um against 2 um. */
                GM_ASSERT_ABS(offset, 0.0, 400.0 * 1e-12 * 30.0);
                GM_ASSERT(state[STATE_OFFSET] * loads[l] > 50.0 * fabs(loads[l]));
                GM_ASSERT(state[STATE_OFFSET_RATE] == 0.0);
                model_free(&model);
            }
        }
    }
}

/* Simple model: gap / 2 + F / K with the load and the torque that speeds up the wheel. */
static void simple_start_is_the_closed_form(void) {
    config conf = case_config(MODEL_SIMPLE, DRIVE_SPEED);
    conf.end_speed = 400.0;
    const gear_mesh gears = case_mesh(&conf);
    const double r_bp = gears.pair.pinion.base_radius, r_bw = gears.pair.wheel.base_radius;
    const double force = (20.0 + case_wheel_inertia * 300.0 * r_bp / r_bw) / r_bw;
    gear_model model;
    double state[STATES_MAX];

    model_init(&model, &conf, &gears);
    GM_ASSERT_INT(model_quasi_static_start(&model, state), GM_OK);
    GM_ASSERT_REL(state[STATE_OFFSET], 50.0 + 1e6 * force / case_spring(&gears), 1e-14);
    model_free(&model);
}

static void without_a_force_it_starts_in_the_middle(void) {
    for (int m = 0; m < 2; ++m) {
        config conf = case_config(meshes[m], DRIVE_SPEED);
        conf.mean_load = 0.0;
        const gear_mesh gears = case_mesh(&conf);
        gear_model model;
        double state[STATES_MAX];

        model_init(&model, &conf, &gears);
        GM_ASSERT_INT(model_quasi_static_start(&model, state), GM_OK);
        GM_ASSERT(state[STATE_OFFSET] == 0.0);
        model_free(&model);
    }
}

/* Both flanks push against each other; the closed form of two springs. */
static void negative_backlash_starts_preloaded(void) {
    const double loads[] = {0.0, 2.0, 200.0};

    for (int i = 0; i < 3; ++i) {
        config conf = case_config(MODEL_SIMPLE, DRIVE_SPEED);
        conf.gears.backlash = -10e-6;
        conf.mean_load = loads[i];
        const gear_mesh gears = case_mesh(&conf);
        gear_model model;
        double state[STATES_MAX], offset, pinion;

        model_init(&model, &conf, &gears);
        GM_ASSERT_INT(model_quasi_static_start(&model, state), GM_OK);
        accelerations(&model, 0.0, state, &offset, &pinion);
        gm_test_context("load %g", loads[i]);
        GM_ASSERT_ABS(offset, 0.0, 1e-8);
        model_free(&model);
    }
}

/* The library's status comes through: a skipped tooth is for a smaller step, a bad call is for nobody. */
static void library_status_is_handed_on(void) {
    const config conf = case_config(MODEL_3D, DRIVE_SPEED);
    const gear_mesh gears = case_mesh(&conf);
    gear_model model;
    double state[STATES_MAX], derivative[STATES_MAX];
    model_tangent tangent;
    enum mesh_contact contact;
    model_init(&model, &conf, &gears);

    set_state(&model, 3e-3, 0.0, 0.0, 0.0, state);
    GM_ASSERT_INT(model_derivative(&model, 0.0, state, derivative, &contact),
                  GM_STATE_OUT_OF_RANGE);
    GM_ASSERT_INT(model_derivative_and_tangent(&model, 0.0, state, derivative, &tangent, &contact),
                  GM_STATE_OUT_OF_RANGE);
    set_state(&model, (double)NAN, 0.0, 0.0, 0.0, state);
    GM_ASSERT_INT(model_derivative(&model, 0.0, state, derivative, &contact), GM_STATE_NOT_FINITE);
    model_free(&model);
}

/* However far the pinion has turned, its tolerance is the same: relative ones would grow without end. */
static void tolerance_of_the_angle_never_loosens(void) {
    const config conf = case_config(MODEL_3D, DRIVE_TORQUE);
    const gear_mesh gears = case_mesh(&conf);
    gear_model model;
    double state[STATES_MAX], early[STATES_MAX], late[STATES_MAX];
    model_init(&model, &conf, &gears);

    set_state(&model, 52e-6, 0.0, 0.0, 100.0, state);
    model_error_weights(&model, 1e-4, 1e-10, state, early);
    set_state(&model, 52e-6, 0.0, 1e5, 1000.0, state);
    model_error_weights(&model, 1e-4, 1e-10, state, late);
    for (int i = 0; i < STATES_MAX; ++i) {
        GM_ASSERT_REL(late[i], early[i], 1e-12);
    }
    /* And the tolerance of x is as documented: 1e-4 of the 2 um beyond the backlash and 1e-4 um. */
    GM_ASSERT_REL(1.0 / early[STATE_OFFSET], 1e-4 * 2.0 + 1e-4, 1e-9);
    model_free(&model);
}

/* A step cannot pass a tooth unseen, whether at speed or from standstill. */
static void longest_step_is_a_part_of_a_tooth(void) {
    config conf = case_config(MODEL_3D, DRIVE_SPEED);
    conf.start_speed = 0.0;
    conf.end_speed = 1000.0;
    const gear_mesh gears = case_mesh(&conf);
    gear_model model;
    double state[STATES_MAX];
    model_init(&model, &conf, &gears);
    set_state(&model, 52e-6, 0.0, 0.0, 0.0, state);

    for (double t = 0.0; t <= 1.0; t += 0.1) {
        const double step = model_max_step(&model, t, state);
        const double turned = (1000.0 * t + 500.0 * step) * step;
        gm_test_context("t = %g", t);
        GM_ASSERT(step > 0.0);
        /* An eighth of a pitch, by the closed form of the motion. */
        GM_ASSERT_REL(turned, 6.283185307179586 / 45 / 8, 1e-12);
    }
    model_free(&model);
}

/* A longest step that is kept is none that is too long for what begins until it is looked for again, and hardly shorter. */
static void longest_step_holds_until_it_says(void) {
    static const double ends[][2] = {{0.0, 1000.0}, {1000.0, 0.0}, {-500.0, -20.0}, {300.0, 300.0}};

    for (int i = 0; i < (int)(sizeof ends / sizeof ends[0]); ++i) {
        config conf = case_config(MODEL_3D, DRIVE_SPEED);
        conf.start_speed = ends[i][0];
        conf.end_speed = ends[i][1];
        const gear_mesh gears = case_mesh(&conf);
        gear_model model;
        double state[STATES_MAX], until;
        model_init(&model, &conf, &gears);
        set_state(&model, 52e-6, 0.0, 0.0, 0.0, state);

        for (double t = 0.05; t < 0.95; t += 0.05) {
            const double held = model_held_step(&model, t, state, &until);
            gm_test_context("%g to %g rad/s, t = %g", ends[i][0], ends[i][1], t);
            GM_ASSERT(until > t);
            for (int k = 0; k <= 8; ++k) {
                const double within = t + k / 8.0 * (isfinite(until) ? until - t : 1.0);
                const double allowed = model_max_step(&model, within, state);
                GM_ASSERT(held <= (1.0 + 1e-12) * allowed && held > 0.995 * allowed);
            }
        }
        model_free(&model);
    }

    /* Where the speed follows from torques, nobody knows. */
    const config conf = case_config(MODEL_3D, DRIVE_TORQUE);
    const gear_mesh gears = case_mesh(&conf);
    gear_model model;
    double state[STATES_MAX], until;
    model_init(&model, &conf, &gears);
    set_state(&model, 52e-6, 0.0, 0.0, 100.0, state);
    GM_ASSERT_ABS(model_held_step(&model, 0.25, state, &until), model_max_step(&model, 0.25, state),
                  0.0);
    GM_ASSERT(until == 0.25);
    model_free(&model);
}

/* Without contact x'' and the pinion's acceleration change by the bound of their rates at most, whatever ripples. */
static void ripple_changes_a_flight_less_than_its_bound(void) {
    for (int d = 0; d < 2; ++d) {
        config conf = case_config(MODEL_3D, drives[d]);
        conf.drive_ripple = (ripple){1, {{2.0, 40.0, 0.3}}};
        conf.load_ripple = (ripple){2, {{3.0, 30.0, 0.0}, {0.5, 20.0, 1.0}}};
        conf.end_speed = 400.0;
        const gear_mesh gears = case_mesh(&conf);
        gear_model model;
        double state[STATES_MAX], now, later, pinion_now, pinion_later;
        const double r_bp = gears.pair.pinion.base_radius, horizon = 2e-3;
        model_init(&model, &conf, &gears);

        set_state(&model, 0.0, 0.01, 0.0, 100.0, state);
        for (int i = 0; i < 50; ++i) {
            const double start = 2e-3 * i;
            const double angle = d == 0 ? 0.0 : 0.2 * i;
            set_state(&model, 0.0, 0.01, angle, 100.0, state);
            const gear_motion motion = model_motion(&model, start, state);
            const model_flight flight = model_without_contact(&model, start, &motion, horizon);
            accelerations(&model, start, state, &now, &pinion_now);
            gm_test_context("drive %d, start %g", d, start);
            GM_ASSERT_REL(flight.acceleration, now, 1e-12);

            for (double t = 0.0; t <= horizon; t += horizon / 16) {
                const double turned = t * (100.0 + 0.5 * t * flight.pinion_acceleration);
                set_state(&model, 0.0, 0.01, angle + turned, 100.0 + t * flight.pinion_acceleration,
                          state);
                accelerations(&model, start + t, state, &later, &pinion_later);
                GM_ASSERT(fabs(later - now) <= flight.jerk * t * (1.0 + 1e-9));
                if (d == 1) {
                    GM_ASSERT(fabs(pinion_later - pinion_now) * r_bp <=
                              r_bp * flight.pinion_jerk * t * (1.0 + 1e-9));
                }
            }
        }
        model_free(&model);
    }
}

/*
 * Thrown up from the middle of the backlash at v, falling at a: x = v t - a t^2 / 2 leaves +-gap / 2 at the smallest
 * positive root. The look ahead ends there or less than a shortest touch earlier, and never before half of it.
 */
static void flight_ends_at_the_touch(void) {
    /* um and m/s; the vertex v^2 / (2 a) with a = 389.4 m/s2 lies at 46 um, 51.4 um and 0. */
    const double speeds[] = {0.1893, 0.2, 0.0};
    const double half_gap = 50e-6;

    for (int m = 0; m < 2; ++m) {
        for (int i = 0; i < 3; ++i) {
            config conf = case_config(meshes[m], DRIVE_SPEED);
            conf.mean_load = -20.0;
            const gear_mesh gears = case_mesh(&conf);
            const flight_options options = {.longest = 1e-2, .speed_tolerance = 1e-8};
            gear_model model;
            double state[STATES_MAX];
            long looks = 0;
            model_init(&model, &conf, &gears);
            set_state(&model, 0.0, speeds[i], 0.0, 100.0, state);

            const double fall = 20.0 * gears.pair.wheel.base_radius / case_wheel_inertia;
            const double v = speeds[i];
            const double up = v * v - 2.0 * fall * half_gap;
            const double touch =
                up > 0.0 ? (v - sqrt(up)) / fall : (v + sqrt(v * v + 2.0 * fall * half_gap)) / fall;
            const double clear = flight_clear_time(&model, 0.0, state, &options, &looks);

            gm_test_context("mesh %d, speed %g: touch at %g s, clear for %g s", m, v, touch, clear);
            /* Approach at 10 m/s or less within `longest`: sqrt(2 1e-8 / v) / w0 < 4e-8 s. */
            GM_ASSERT(clear <= touch);
            GM_ASSERT(clear > touch - 4e-8);
            GM_ASSERT(looks == 0);
            model_free(&model);
        }
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(bodies_obey_newton),
        GM_TEST(damping_ratio_is_a_share_of_critical_damping),
        GM_TEST(jacobian_is_that_of_differences),
        GM_TEST(jacobian_knows_when_flanks_would_pull),
        GM_TEST(start_is_an_equilibrium),
        GM_TEST(simple_start_is_the_closed_form),
        GM_TEST(without_a_force_it_starts_in_the_middle),
        GM_TEST(negative_backlash_starts_preloaded),
        GM_TEST(library_status_is_handed_on),
        GM_TEST(tolerance_of_the_angle_never_loosens),
        GM_TEST(longest_step_is_a_part_of_a_tooth),
        GM_TEST(longest_step_holds_until_it_says),
        GM_TEST(ripple_changes_a_flight_less_than_its_bound),
        GM_TEST(flight_ends_at_the_touch),
    };
    return gm_test_main("gearsim.model", tests, GM_TEST_COUNT(tests), argc, argv);
}
