/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Friction of elastic teeth: against conservation, against its formula along the lines, differences, and known limits. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "random_gears.h"

#define DEGREE 0.017453292519943296

static const double pi = 3.14159265358979323846;

typedef struct elastic_mesh {
    gm_pair pair;
    gm_mesh_params law;
    gm_mesh *mesh;
    gm_workspace *workspace;
    void *mesh_memory, *workspace_memory;
} elastic_mesh;

static void make(elastic_mesh *m, const gm_pair_params *gears, const gm_mesh_params *law,
                 const gm_flanks *pinion, const gm_flanks *wheel) {
    memset(m, 0, sizeof *m);
    m->law = *law;
    GM_ASSERT_INT(gm_pair_init(&m->pair, gears), GM_OK);
    const size_t size = gm_mesh_size(law, &m->pair);
    m->mesh_memory = malloc(size);
    GM_ASSERT_INT(gm_mesh_init(&m->mesh, law, &m->pair, pinion, wheel, m->mesh_memory, size),
                  GM_OK);
    const size_t room = gm_workspace_size(m->mesh);
    m->workspace_memory = malloc(room);
    GM_ASSERT_INT(gm_workspace_init(&m->workspace, m->mesh, m->workspace_memory, room), GM_OK);
}

static void release(elastic_mesh *m) {
    free(m->mesh_memory);
    free(m->workspace_memory);
}

static gm_mesh_params elastic_law(double coefficient) {
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.law = GM_LAW_ELASTIC;
    law.friction_coefficient = coefficient;
    law.oil_viscosity = 0.05;
    law.roughness = 0.6e-6;
    return law;
}

static gm_pair_params gears_of(int pinion, int wheel, double module, double helix_degrees,
                               double face_width, double center_distance) {
    gm_pair_params p;
    gm_pair_params_default(&p);
    p.pinion_teeth = pinion;
    p.wheel_teeth = wheel;
    p.normal_module = module;
    p.normal_pressure_angle = 20.0 * DEGREE;
    p.helix_angle = helix_degrees * DEGREE;
    p.face_width = face_width;
    p.center_distance = center_distance;
    return p;
}

static gm_pair_params spur62(void) {
    return gears_of(62, 62, 2e-3, 0.0, 20e-3, 124e-3);
}

static gm_pair_params nrel3(void) {
    gm_pair_params p = gears_of(24, 95, 14e-3, 10.0, 360e-3, 861.0001467e-3);
    p.pinion_profile_shift = 0.48;
    p.wheel_profile_shift = 0.6691;
    p.pinion_tip_radius = 190.3736708e-3;
    p.wheel_tip_radius = 697.6880969e-3;
    return p;
}

static gm_pair_params helical(void) {
    gm_pair_params p = gears_of(31, 43, 2.5e-3, -25.0, 30e-3, 0.5 * 2.5e-3 * 74 / cos(0.4363323));
    p.pinion_profile_shift = p.wheel_profile_shift = 0.05;
    p.center_distance += 0.25e-3;
    return p;
}

/* Planet and ring, with a helix. */
static gm_pair_params ring(void) {
    gm_pair_params p = gears_of(36, -93, 21e-3, 8.0, 400e-3, 589.74e-3);
    p.pinion_profile_shift = 0.5039;
    p.wheel_profile_shift = 0.1171;
    p.pinion_tip_alteration = -0.08338;
    return p;
}

static gm_mesh_result evaluate(elastic_mesh *m, const gm_state *state, int wanted) {
    gm_mesh_result r;
    GM_ASSERT_INT(
        gm_workspace_init(&m->workspace, m->mesh, m->workspace_memory, gm_workspace_size(m->mesh)),
        GM_OK);
    GM_ASSERT_INT(gm_mesh_evaluate(m->mesh, state, wanted, m->workspace, &r), GM_OK);
    return r;
}

/* ---------------------------------------------------------------------------------------------
 * Variants: four pairs, all laws, damped, posed, with flanks, with bodies that wind up
 * ------------------------------------------------------------------------------------------- */

enum { VARIANTS = 16 };

typedef struct variant {
    elastic_mesh rubbing, smooth;
    random_flanks flanks[2];
    int has_flanks;
    gm_state state;
} variant;

static void variant_make(variant *v, int k, int n) {
    uint64_t seed = 91u + (uint64_t)k;
    const gm_pair_params gears[4] = {spur62(), helical(), nrel3(), ring()};
    gm_pair_params params = gears[k % 4];
    gm_mesh_params law = elastic_law(0.3);
    gm_pair pair;
    memset(v, 0, sizeof *v);
    params.backlash = 20e-6;
    GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);

    /* The more the later it comes: flanks of its own, laws of friction and damping, shifted axes, tilted ones. */
    v->has_flanks = k >= 4;
    for (int gear = 0; v->has_flanks && gear < 2; ++gear) {
        random_flanks_make(&v->flanks[gear], &seed, &pair, gear, 1e-3 * params.normal_module);
    }
    law.friction_law = (k + k / 4) % 4 == 1   ? GM_FRICTION_ISO14179
                       : (k + k / 4) % 4 == 2 ? GM_FRICTION_BENEDICT_KELLEY
                                              : GM_FRICTION_CONSTANT;
    law.damping = k % 2 ? 1e4 : 0.0;
    if (k >= 8) {
        law.pose.center_distance_change = 5e-3 * params.normal_module;
        law.pose.offset = -3e-3 * params.normal_module;
    }
    if (k >= 12) {
        law.pose.skew = 1e-4;
        law.pose.inclination = -7e-5;
        law.pinion_bore_radius = 0.1 * pair.pinion.root_radius;
    }

    /* The same mesh with friction and without. */
    const gm_flanks *pinion = v->has_flanks ? v->flanks[0].flanks : NULL;
    const gm_flanks *wheel = v->has_flanks ? v->flanks[1].flanks : NULL;
    make(&v->rubbing, &params, &law, pinion, wheel);
    law.friction_law = GM_FRICTION_CONSTANT;
    law.friction_coefficient = 0.0;
    make(&v->smooth, &params, &law, pinion, wheel);

    /* Pressed by 100 N per mm of face, sliding at some v0 and at many. */
    const double torque = 1e5 * pair.face_width * pair.wheel.base_radius * (n % 2 ? -1.0 : 1.0);
    double offset;
    v->state.pinion_angle = 0.013 + 0.37 * n / pair.pinion.teeth;
    v->state.pinion_speed = (n % 3 ? 100.0 : -1.0) * (n % 4 == 3 ? -1.0 : 1.0);
    GM_ASSERT_INT(gm_static_equilibrium(v->smooth.mesh, v->state.pinion_angle, torque, (double)NAN,
                                        v->smooth.workspace, &offset, NULL),
                  GM_OK);
    const double approach = (k % 4 < 2 ? 1.0 : -1.0) * 1e-3;
    const double r_bp = pair.pinion.base_radius, r_bw = pair.wheel.base_radius;
    v->state.wheel_angle = (r_bp * v->state.pinion_angle - offset) / r_bw;
    v->state.wheel_speed = (r_bp * v->state.pinion_speed - approach) / r_bw;
}

static void variant_free(variant *v) {
    release(&v->rubbing);
    release(&v->smooth);
    for (int gear = 0; v->has_flanks && gear < 2; ++gear) {
        random_flanks_free(&v->flanks[gear]);
    }
}

static void what_friction_takes_is_lost(void) {
    for (int k = 0; k < VARIANTS; ++k) {
        for (int n = 0; n < 6; ++n) {
            variant v;
            gm_test_context("variant %d, state %d", k, n);
            variant_make(&v, k, n);
            const gm_mesh_result r = evaluate(&v.rubbing, &v.state, GM_WANT_WRENCH);
            const gm_mesh_result s = evaluate(&v.smooth, &v.state, GM_WANT_WRENCH);
            const double on_pinion = r.pinion_torque - s.pinion_torque;
            const double on_wheel = r.wheel_torque - s.wheel_torque;
            const double size = fabs(s.pinion_torque * v.state.pinion_speed);
            GM_ASSERT_REL(r.force, s.force, 1e-12);
            GM_ASSERT_ABS(s.loss, 0.0, 0.0);
            GM_ASSERT(r.loss > 0.0);
            GM_ASSERT_ABS(on_pinion * v.state.pinion_speed - on_wheel * v.state.wheel_speed, r.loss,
                          1e-11 * size);

            /* The side force makes these torques, and is in balance. */
            const double length = r.force * v.rubbing.pair.center_distance;
            GM_ASSERT_ABS(r.wrench.pinion_moment[2] - s.wrench.pinion_moment[2], -on_pinion,
                          1e-10 * fabs(length));
            GM_ASSERT_ABS(r.wrench.wheel_moment[2] - s.wrench.wheel_moment[2],
                          -v.rubbing.pair.wheel.sign * on_wheel, 1e-10 * fabs(length));
            for (int axis = 0; axis < 3; ++axis) {
                GM_ASSERT_ABS(r.wrench.pinion_force[axis] + r.wrench.wheel_force[axis], 0.0,
                              1e-12 * fabs(r.force));
            }
            variant_free(&v);
        }
    }
}

static double power_of(const gm_load *load, const gm_body *body) {
    double power = 0.0;
    for (int k = 0; k < 3; ++k) {
        power += load->force[k] * body->velocity[k] + load->moment[k] * body->angular_velocity[k];
    }
    return power;
}

/* Between bodies whose axes move and begin to tilt the power that friction takes is its loss. */
static void friction_between_bodies_takes_its_loss(void) {
    for (int k = 0; k < 6; ++k) {
        variant v;
        gm_test_context("variant %d", k);
        variant_make(&v, k, k);
        const gm_pair *pair = &v.rubbing.pair;
        gm_body bodies[2] = {
            {.angular_velocity = {0.1, -0.2, 0.01 * v.state.pinion_speed}},
            {.position = {pair->center_distance, 0.0,
                          pair->wheel.face_start + 0.5 * pair->wheel.face_width -
                              0.5 * pair->pinion.face_width},
             .velocity = {3e-3, 2e-3, -1e-3},
             .angular_velocity = {0.2, 0.1, -0.01 * v.state.wheel_speed}},
        };
        const double turns[2] = {v.state.pinion_angle, -v.state.wheel_angle};
        for (int gear = 0; gear < 2; ++gear) {
            const double c = cos(turns[gear]), s = sin(turns[gear]);
            const double rotation[9] = {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0};
            memcpy(bodies[gear].rotation, rotation, sizeof rotation);
        }
        gm_load rubbing[2], smooth[2];
        gm_mesh_result r, s;
        GM_ASSERT_INT(gm_mesh_evaluate_bodies(v.rubbing.mesh, &bodies[0], &bodies[1], GM_WANT_FORCE,
                                              v.rubbing.workspace, &r, &rubbing[0], &rubbing[1]),
                      GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_bodies(v.smooth.mesh, &bodies[0], &bodies[1], GM_WANT_FORCE,
                                              v.smooth.workspace, &s, &smooth[0], &smooth[1]),
                      GM_OK);
        const double taken = power_of(&rubbing[0], &bodies[0]) + power_of(&rubbing[1], &bodies[1]) -
                             power_of(&smooth[0], &bodies[0]) - power_of(&smooth[1], &bodies[1]);
        GM_ASSERT(r.loss > 0.0);
        GM_ASSERT_ABS(taken, -r.loss, 1e-9 * r.loss);
        variant_free(&v);
    }
}

/* ---------------------------------------------------------------------------------------------
 * The formula along the lines
 * ------------------------------------------------------------------------------------------- */

enum { POINTS = 2000 };

/* mu by its law at a sliding speed; transverse force, and per length along z (N/m). */
static double coefficient(const gm_mesh_params *law, const gm_pair *pair, double force,
                          double line_load, double speed, double rolling) {
    const double per_cos = 1.0 / cos(pair->base_helix_angle);
    const double rho_p = pair->pinion.base_radius * tan(pair->working_pressure_angle);
    const double rho_w = pair->line_of_action - rho_p;
    const double v = sqrt(speed * speed + law->friction_speed * law->friction_speed);
    switch (law->friction_law) {
    case GM_FRICTION_ISO14179:
        return 0.048 *
               pow(force / (1e3 * pair->face_width) /
                       (rolling * 1e3 * rho_p * rho_w / (rho_p + rho_w) * per_cos),
                   0.2) *
               pow(1e3 * law->oil_viscosity, -0.05) * pow(1e6 * law->roughness, 0.25);
    case GM_FRICTION_BENEDICT_KELLEY:
        return fmax(0.0, 0.0127 * log10(29.66 * line_load * per_cos /
                                        (1e3 * law->oil_viscosity * v * rolling * rolling)));
    default:
        return law->friction_coefficient;
    }
}

/* Trapezoids between the stations of each line, scaled to the force. Those of helical gears leave the ends of lines out. */
static void torques_are_those_of_the_formula_along_the_lines(void) {
    static gm_line_load_point points[POINTS];
    for (int k = 0; k < 9; ++k) {
        const gm_pair_params gears[3] = {spur62(), helical(), nrel3()};

        /* A mesh with each law of friction, and one without; stations enough for sums by trapezia. */
        gm_mesh_params law = elastic_law(0.1);
        elastic_mesh m;
        law.friction_law = k / 3;
        law.friction_speed = 0.1;
        law.stations = 97;
        gm_test_context("case %d", k);
        make(&m, &gears[k % 3], &law, NULL, NULL);

        elastic_mesh smooth;
        law.friction_law = GM_FRICTION_CONSTANT;
        law.friction_coefficient = 0.0;
        make(&smooth, &gears[k % 3], &law, NULL, NULL);

        const double r_bp = m.pair.pinion.base_radius, r_bw = m.pair.wheel.base_radius;
        gm_position position;
        GM_ASSERT_INT(
            gm_position_from_pinion_angle(
                &m.pair, 0.03, 3e-3 * m.pair.normal_module + 0.5 * m.pair.backlash, 0.0, &position),
            GM_OK);
        position.pinion_speed = 90.0;

        gm_mesh_result r, s;
        gm_line_loads loads;
        GM_ASSERT_INT(
            gm_mesh_evaluate_at(smooth.mesh, &position, GM_WANT_FORCE, smooth.workspace, &s),
            GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(m.mesh, &position, GM_WANT_DERIVATIVES, m.workspace, &r),
                      GM_OK);
        GM_ASSERT_INT(gm_mesh_line_loads(m.mesh, &position, m.workspace, points, POINTS, &loads),
                      GM_OK);

        /* Force, torques and loss along the lines, from the load of each point and how it slides. */
        const double rho_c = r_bp * tan(m.pair.working_pressure_angle);
        const double wheel_speed = 90.0 * r_bp / r_bw;
        const double rolling = 90.0 * rho_c + wheel_speed * (m.pair.line_of_action - rho_c);
        double sums[4] = {0.0, 0.0, 0.0, 0.0};
        for (int i = 0; i + 1 < loads.points; ++i) {
            for (int end = 0; end < 2 && points[i].pinion_tooth == points[i + 1].pinion_tooth;
                 ++end) {
                const gm_line_load_point *p = &points[i + end];
                const double q = p->line_load, rho = p->pinion_roll_length;
                const double force = 0.5 * q * (points[i + 1].z - points[i].z);
                const double v = (90.0 + wheel_speed) * (rho - rho_c);
                const double mu = coefficient(&m.law, &m.pair, r.force, q, v, rolling);
                const double friction = mu * v / sqrt(v * v + 0.01) * force;

                sums[0] += force;
                sums[1] += friction * rho;
                sums[2] += friction * (m.pair.line_of_action - rho);
                sums[3] += friction * v;
            }
        }

        const double scale = r.force / sums[0] / cos(m.pair.base_helix_angle);
        const double tolerance = m.pair.face_advance == 0.0 ? 1e-3 : 0.04;
        const double least = 0.04 * tolerance * r.force;
        GM_ASSERT_REL(sums[0], r.force, tolerance);
        GM_ASSERT_ABS(r.pinion_torque - s.pinion_torque, scale * sums[1], least * rho_c);
        GM_ASSERT_ABS(r.wheel_torque - s.wheel_torque, scale * sums[2],
                      least * (m.pair.line_of_action - rho_c));
        GM_ASSERT_REL(r.loss, scale * sums[3], tolerance);

        release(&smooth);
        release(&m);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Derivatives
 * ------------------------------------------------------------------------------------------- */

/* Differences of both torques less those without friction, which test_elastic_mesh.c knows. */
static void gradients_are_those_of_differences(void) {
    int compared = 0;
    for (int k = 0; k < VARIANTS; ++k) {
        for (int n = 0; n < 4; ++n) {
            variant v;
            variant_make(&v, k, n);
            const gm_pair *pair = &v.rubbing.pair;
            const double radii[2] = {pair->pinion.base_radius, pair->wheel.base_radius};
            const gm_mesh_result r = evaluate(&v.rubbing, &v.state, GM_WANT_DERIVATIVES);
            const gm_mesh_result s = evaluate(&v.smooth, &v.state, GM_WANT_DERIVATIVES);
            const double stiffness = fabs(s.force_by.wheel_angle) / radii[1];

            /* What friction adds to both torques, a step before and behind each coordinate. */
            for (int which = 0; which < 4; ++which) {
                const double step = which < 2 ? 3e-7 * pair->normal_module / radii[which] : 1e-4;
                double torque[3][2];
                for (int i = 0; i < 3; ++i) {
                    gm_state moved = v.state;
                    double *const places[4] = {&moved.pinion_angle, &moved.wheel_angle,
                                               &moved.pinion_speed, &moved.wheel_speed};
                    *places[which] += (i - 1) * step;
                    const gm_mesh_result there = evaluate(&v.rubbing, &moved, GM_WANT_FORCE);
                    const gm_mesh_result bare = evaluate(&v.smooth, &moved, GM_WANT_FORCE);
                    torque[i][0] = there.pinion_torque - bare.pinion_torque;
                    torque[i][1] = there.wheel_torque - bare.wheel_torque;
                }

                /* Differences on both sides, as kinks may lie on one of them. */
                for (int gear = 0; gear < 2; ++gear) {
                    const gm_gradient *by = gear ? &r.wheel_torque_by : &r.pinion_torque_by;
                    const gm_gradient *less = gear ? &s.wheel_torque_by : &s.pinion_torque_by;
                    const double exact[4] = {
                        by->pinion_angle - less->pinion_angle, by->wheel_angle - less->wheel_angle,
                        by->pinion_speed - less->pinion_speed, by->wheel_speed - less->wheel_speed};
                    const double size = which < 2 ? stiffness * radii[which] * radii[gear]
                                                  : fabs(r.force) * radii[gear] /
                                                        (fabs(v.state.pinion_speed) + 0.1);
                    const double left = (torque[1][gear] - torque[0][gear]) / step;
                    const double right = (torque[2][gear] - torque[1][gear]) / step;
                    gm_test_context("variant %d, state %d, gear %d by %d", k, n, gear, which);

                    /* The touching part of damping moves with the roll, which elastic teeth leave out. */
                    const double accuracy = k % 2 && which < 2 ? 1e-4 : 2e-6;
                    if (fabs(right - left) < 5e-5 * size) { /* else a grid line is passed */
                        GM_ASSERT_ABS(0.5 * (left + right), exact[which],
                                      accuracy * size + 0.51 * fabs(right - left));
                        ++compared;
                    }
                }
            }
            variant_free(&v);
        }
    }
    GM_ASSERT(compared > 300);
}

/* ---------------------------------------------------------------------------------------------
 * Equilibrium, energy over a mesh cycle, known limits
 * ------------------------------------------------------------------------------------------- */

/* Quasi-static means over a mesh cycle at constant torque: loss over power in. */
typedef struct cycle {
    double in, out, loss, stored; /* (W), the last one F dx/dt of the curve */
} cycle;

static cycle roll_through(elastic_mesh *m, int positions, double speed, double torque) {
    enum { MOST = 512 };
    double offset[MOST], force[MOST], guess = (double)NAN;
    const double ratio = m->pair.pinion.base_radius / m->pair.wheel.base_radius;
    cycle sums = {0.0, torque * speed * ratio, 0.0, 0.0};
    GM_ASSERT(positions <= MOST);
    for (int k = 0; k < positions; ++k) {
        const double angle = m->pair.pinion.pitch_angle * (k + 0.5) / positions;
        gm_mesh_result r;
        GM_ASSERT_INT(gm_rolling_equilibrium(m->mesh, angle, speed, torque, guess, m->workspace,
                                             &offset[k], &r),
                      GM_OK);
        GM_ASSERT_REL(r.wheel_torque, torque, 1e-9);
        guess = offset[k];
        force[k] = r.force;
        sums.in += r.pinion_torque * speed / positions;
        sums.loss += r.loss / positions;
    }
    for (int k = 0; k < positions; ++k) {
        const double rise =
            0.5 * (offset[(k + 1) % positions] - offset[(k + positions - 1) % positions]);
        sums.stored += force[k] * rise * speed / m->pair.pinion.pitch_angle;
    }
    return sums;
}

/* What a curve of equilibrium takes in is what it gives and loses, with the work of the force on x, which turns no gear. */
static void a_mesh_cycle_gives_back_what_it_does_not_lose(void) {
    const gm_pair_params gears = helical();
    const gm_mesh_params law = elastic_law(0.1);
    elastic_mesh m;
    make(&m, &gears, &law, NULL, NULL);
    const cycle c = roll_through(&m, 400, 100.0, 300.0);
    GM_ASSERT(c.loss > 1e-3 * c.in);
    GM_ASSERT_ABS(c.in - c.loss + c.stored, c.out, 1e-5 * c.loss);
    release(&m);
}

/* eps_1^2 + eps_2^2, of the parts of the contact ratio on both sides of the pitch point. */
static double squares_of(const gm_pair *pair) {
    const double pitch_point = pair->pinion.base_radius * tan(pair->working_pressure_angle);
    const double end = (pair->path_end - pitch_point) / pair->transverse_base_pitch;
    const double start = (pitch_point - pair->path_start) / pair->transverse_base_pitch;
    return end * end + start * start;
}

/* Loss over power in per mu, over pi (u + 1) / (z_p u cos(beta_b)): the bracket of [Ohlendorf]. */
static double bracket_of(elastic_mesh *m, int positions, double torque) {
    const gm_pair *pair = &m->pair;
    const double u = (double)pair->wheel.teeth / pair->pinion.teeth;
    const cycle c = roll_through(m, positions, 100.0, torque);
    return c.loss / (m->law.friction_coefficient * c.out) /
           (pi * (u + 1.0) / (pair->pinion.teeth * u * cos(pair->base_helix_angle)));
}

/*
 * Elastic spur teeth give a pair near its tip, where it slides most, less than its half: below equal sharing. Lines of
 * constant length carry more in the middle of the path, where they slide least: below uniform line load.
 */
static void losses_are_next_to_their_known_limits(void) {
    gm_mesh_params law = elastic_law(1e-6);
    law.friction_speed = 1e-8;
    law.corner_contact = GM_CORNER_OFF; /* the limits are those of the path */
    gm_pair_params spur = spur62();
    elastic_mesh m;
    make(&m, &spur, &law, NULL, NULL);
    const double equal = 1.0 - m.pair.transverse_contact_ratio + squares_of(&m.pair);
    GM_ASSERT_ABS(equal, 0.811877, 1e-6);
    const double shared = bracket_of(&m, 400, 0.2 * 100e3 * spur.face_width);
    GM_ASSERT(shared < equal && shared > 0.8 * equal);
    release(&m);

    gm_pair_params wide = nrel3();
    wide.backlash = 0.3e-3;
    gm_pair pair;
    GM_ASSERT_INT(gm_pair_init(&pair, &wide), GM_OK);
    wide.face_width /= pair.overlap_ratio;
    make(&m, &wide, &law, NULL, NULL);
    const double uniform = squares_of(&m.pair) / m.pair.transverse_contact_ratio;
    GM_ASSERT_ABS(uniform, 0.7513, 5e-5);
    const double helical_bracket =
        bracket_of(&m, 100, 1e5 * wide.face_width * m.pair.wheel.base_radius);
    GM_ASSERT(helical_bracket < uniform && helical_bracket > 0.85 * uniform);
    release(&m);
}

static void gears_at_rest_have_none(void) {
    variant v;
    variant_make(&v, 1, 1);
    v.state.pinion_speed = v.state.wheel_speed = 0.0;
    const gm_mesh_result r = evaluate(&v.rubbing, &v.state, GM_WANT_DERIVATIVES);
    const gm_mesh_result s = evaluate(&v.smooth, &v.state, GM_WANT_DERIVATIVES);
    GM_ASSERT_REL(r.pinion_torque, s.pinion_torque, 1e-15);
    GM_ASSERT_ABS(r.loss, 0.0, 0.0);

    /* Nor those that do not touch. */
    v.state.pinion_speed = 10.0;
    v.state.wheel_angle =
        v.state.pinion_angle * v.rubbing.pair.pinion.base_radius / v.rubbing.pair.wheel.base_radius;
    const gm_mesh_result apart = evaluate(&v.rubbing, &v.state, GM_WANT_DERIVATIVES);
    GM_ASSERT_ABS(apart.pinion_torque, 0.0, 0.0);
    GM_ASSERT_ABS(apart.wheel_torque_by.pinion_speed, 0.0, 0.0);
    v.state.pinion_speed = (double)NAN;
    gm_mesh_result none;
    GM_ASSERT_INT(
        gm_mesh_evaluate(v.rubbing.mesh, &v.state, GM_WANT_FORCE, v.rubbing.workspace, &none),
        GM_STATE_NOT_FINITE);
    GM_ASSERT_NAN(none.loss);
    variant_free(&v);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(what_friction_takes_is_lost),
        GM_TEST(friction_between_bodies_takes_its_loss),
        GM_TEST(torques_are_those_of_the_formula_along_the_lines),
        GM_TEST(gradients_are_those_of_differences),
        GM_TEST(a_mesh_cycle_gives_back_what_it_does_not_lose),
        GM_TEST(losses_are_next_to_their_known_limits),
        GM_TEST(gears_at_rest_have_none),
    };
    return gm_test_main("unit.elastic_friction", tests, GM_TEST_COUNT(tests), argc, argv);
}
