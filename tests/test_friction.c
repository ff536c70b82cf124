/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Friction: torques, loss and side force against conservation, against its formula point by point, and known limits. */
#include "gm_test.h"
#include "plain_mesh.h"
#include "random_gears.h"
#include "reference_gear.h"

static const double pi = 3.14159265358979323846;

/* ---------------------------------------------------------------------------------------------
 * Meshes
 * ------------------------------------------------------------------------------------------- */

static gm_mesh_params params_with(double stiffness, double damping, double coefficient) {
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.stiffness = stiffness;
    params.damping = damping;
    params.friction_coefficient = coefficient;
    params.oil_viscosity = 0.05;
    params.roughness = 0.6e-6;
    return params;
}

static gm_mesh *mesh_with(plain_mesh *room, const gm_mesh_params *params, const gm_pair *pair,
                          const gm_flanks *pinion, const gm_flanks *wheel) {
    gm_mesh *mesh;
    GM_ASSERT_INT(gm_mesh_init(&mesh, params, pair, pinion, wheel, room->memory, sizeof *room),
                  GM_OK);
    return mesh;
}

/* A random pair in a random state, small angles, with the wheel some um within the backlash or beyond. */
typedef struct moving_case {
    random_case gears;
    gm_mesh_params params;
    plain_mesh room;
    gm_mesh *mesh;
    gm_state state;
} moving_case;

static const double stiffness_of_all = 1e8;

static void moving_case_make(moving_case *c, uint64_t *seed, int index) {
    GM_ASSERT_INT(random_mixed_case_make(&c->gears, seed, index), GM_OK);
    const gm_pair *pair = &c->gears.pair;
    const double turned = floor(c->gears.pinion_angle);
    const double back = turned * pair->pinion.base_radius / pair->wheel.base_radius;

    /* Damping of the size of the elastic force, and sliding of the size of v0 up to far above it. */
    const double approach = gm_test_uniform(seed, -0.3, 0.5) * 1e-7 * pair->normal_module * 1e3;
    const double speed = gm_test_uniform(seed, -1.0, 1.0) * (index % 2 ? 300.0 : 3.0);
    c->params = params_with(stiffness_of_all, index % 6 == 5 ? 0.0 : 1e5, 0.5);
    c->params.friction_law = index % 3 == 1   ? GM_FRICTION_ISO14179
                             : index % 3 == 2 ? GM_FRICTION_BENEDICT_KELLEY
                                              : GM_FRICTION_CONSTANT;
    if (index % 7 == 3) {
        c->params.pose.center_distance_change = 1e-3 * pair->normal_module;
        c->params.pose.offset = -2e-3 * pair->normal_module;
    }
    if (index % 7 == 5) {
        const double most = pair->transverse_base_pitch / pair->face_width;
        c->params.pose.skew = gm_test_uniform(seed, -0.01, 0.01) * most;
        c->params.pose.inclination = gm_test_uniform(seed, -0.01, 0.01) * most;
    }
    c->mesh = mesh_with(&c->room, &c->params, pair, c->gears.use[0], c->gears.use[1]);
    c->state.pinion_angle = c->gears.pinion_angle - turned;
    c->state.wheel_angle = c->gears.wheel_angle - back;
    c->state.pinion_speed = speed;
    c->state.wheel_speed = (pair->pinion.base_radius * speed - approach) / pair->wheel.base_radius;
}

static gm_pair standard_spur(int teeth) {
    gm_pair_params params;
    gm_pair pair;
    gm_pair_params_default(&params);
    params.pinion_teeth = params.wheel_teeth = teeth;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = 20.0 * pi / 180.0;
    params.center_distance = 2e-3 * teeth;
    params.face_width = 20e-3;
    GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);
    return pair;
}

/* ---------------------------------------------------------------------------------------------
 * Conservation
 * ------------------------------------------------------------------------------------------- */

static void power_in_is_power_out_and_stored_and_lost(void) {
    uint64_t seed = UINT64_C(901);
    int touching = 0;
    for (int i = 0; i < 500; ++i) {
        moving_case c;
        gm_mesh_result r;
        gm_test_context("case %d", i);
        moving_case_make(&c, &seed, i);
        if (gm_mesh_evaluate(c.mesh, &c.state, GM_WANT_FORCE, NULL, &r) == GM_OK &&
            r.drive_force + r.coast_force > 0.0) {
            const gm_pair *pair = &c.gears.pair;
            const double rate = pair->pinion.base_radius * c.state.pinion_speed -
                                pair->wheel.base_radius * c.state.wheel_speed;
            const double in = r.pinion_torque * c.state.pinion_speed;
            const double out = r.wheel_torque * c.state.wheel_speed;
            const double scale = (r.drive_force + r.coast_force) * pair->pinion.base_radius *
                                 fabs(c.state.pinion_speed);
            GM_ASSERT_ABS(in - out, r.force * rate + r.loss, 1e-13 * scale);
            GM_ASSERT(r.loss >= 0.0);
            ++touching;
        }
        random_case_free(&c.gears);
    }
    gm_test_context("all cases");
    GM_ASSERT(touching > 300);
}

/* What acts on one gear acts on the other; about the wheel's axis instead of the pinion's, d further along x. */
static void what_acts_on_one_gear_acts_on_the_other(void) {
    uint64_t seed = UINT64_C(902);
    int touching = 0;
    for (int i = 0; i < 300; ++i) {
        moving_case c;
        gm_mesh_result r;
        gm_test_context("case %d", i);
        moving_case_make(&c, &seed, i);
        if (gm_mesh_evaluate(c.mesh, &c.state, GM_WANT_WRENCH, NULL, &r) == GM_OK &&
            r.drive_force + r.coast_force > 0.0) {
            const gm_pose *pose = &c.params.pose;
            const double sign = c.gears.pair.wheel.sign;
            const double dx = sign * c.gears.pair.center_distance + pose->center_distance_change;
            const double dy = pose->offset;

            /* The wrench on the wheel, about the axis of the pinion. */
            const gm_wrench *w = &r.wrench;
            const double size = r.drive_force + r.coast_force;
            const double arm = c.gears.pair.wheel.base_radius + fabs(dx);
            const double about_pinion[3] = {w->wheel_moment[0] + dy * w->wheel_force[2],
                                            w->wheel_moment[1] - dx * w->wheel_force[2],
                                            w->wheel_moment[2] + dx * w->wheel_force[1] -
                                                dy * w->wheel_force[0]};

            for (int k = 0; k < 3; ++k) {
                GM_ASSERT_ABS(w->pinion_force[k], -w->wheel_force[k], 1e-14 * size);
                GM_ASSERT_ABS(w->pinion_moment[k], -about_pinion[k], 1e-12 * size * arm);
            }

            /* Counter-clockwise: against the pinion's motion; the wheel's is clockwise, but for a ring. */
            GM_ASSERT_ABS(w->pinion_moment[2], -r.pinion_torque, 1e-13 * size * arm);
            GM_ASSERT_ABS(w->wheel_moment[2], -sign * r.wheel_torque, 1e-13 * size * arm);
            ++touching;
        }
        random_case_free(&c.gears);
    }
    gm_test_context("all cases");
    GM_ASSERT(touching > 150);
}

/* The side force is across the line of action, mu over cos(beta_b) of the transverse force far above v0. */
static void side_force_stands_across_the_normal_one(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    plain_mesh room, plain_room;
    gm_mesh_params params = params_with(1e9, 0.0, 0.08);
    params.friction_speed = 1e-9;
    gm_mesh *mesh = mesh_with(&room, &params, &pair, NULL, NULL);
    params.friction_coefficient = 0.0;
    gm_mesh *without = mesh_with(&plain_room, &params, &pair, NULL, NULL);
    const double alpha = pair.working_pressure_angle;

    /* On both sides of the teeth. */
    for (int sign = -1; sign <= 1; sign += 2) {
        gm_position position;
        gm_mesh_result r, plain;
        GM_ASSERT_INT(gm_position_from_pinion_angle(
                          &pair, 0.03, sign * (0.5 * pair.backlash + 5e-6), 0.0, &position),
                      GM_OK);

        /* What friction adds, along the normal of the flanks and across it. */
        position.pinion_speed = 100.0;
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_WRENCH, NULL, &r), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(without, &position, GM_WANT_WRENCH, NULL, &plain), GM_OK);
        const double side[2] = {r.wrench.wheel_force[0] - plain.wrench.wheel_force[0],
                                r.wrench.wheel_force[1] - plain.wrench.wheel_force[1]};
        const double along = side[0] * sin(alpha) + sign * side[1] * cos(alpha);
        const double across = -sign * side[0] * cos(alpha) + side[1] * sin(alpha);
        GM_ASSERT_ABS(along, 0.0, 1e-12 * fabs(r.force));
        GM_ASSERT_ABS(r.wrench.wheel_force[2], plain.wrench.wheel_force[2], 1e-12 * fabs(r.force));

        /* Lines push both ways, left and right of the pitch point: no more than all of them in one. */
        GM_ASSERT(fabs(across) <= 0.08 / cos(pair.base_helix_angle) * fabs(r.force));
        GM_ASSERT(fabs(across) > 1e-4 * fabs(r.force));
    }
}

/* ---------------------------------------------------------------------------------------------
 * The formula, point by point
 * ------------------------------------------------------------------------------------------- */

/* Torques and loss of ideal flanks from many points on each line, the drive side, without damping. */
static void by_points(const gm_pair *pair, const gm_mesh_params *params, double pinion_speed,
                      double phase, double offset, double result[3]) {
    enum { POINTS = 20000 };
    const double delta = offset - 0.5 * pair->backlash;
    const double T = pair->line_of_action;
    const double lower =
        fmax(pair->pinion.start_roll_length, T + delta - pair->wheel.tip_roll_length);
    const double upper =
        fmin(pair->pinion.tip_roll_length, T + delta - pair->wheel.start_roll_length);
    const double wheel_speed = pinion_speed * pair->pinion.base_radius / pair->wheel.base_radius;
    const double per_cos = 1.0 / cos(pair->base_helix_angle);
    const double v0 = params->friction_speed;
    result[0] = result[1] = result[2] = 0.0;
    for (int line = -20; line <= 20; ++line) {
        /* Where the line is within the path; spur gears have all of it there, or nothing. */
        const double start =
            pair->phase_origin[GM_DRIVE] + phase + line * pair->transverse_base_pitch;
        double from = start < lower || start > upper ? 1.0 : 0.0, to = 1.0;
        if (pair->face_advance != 0.0) {
            const double ends[2] = {(lower - start) / pair->face_advance,
                                    (upper - start) / pair->face_advance};
            from = fmax(0.0, fmin(ends[0], ends[1]));
            to = fmin(1.0, fmax(ends[0], ends[1]));
        }
        for (int k = 0; k < POINTS && from < to; ++k) {
            const double t1 = from + (to - from) * (k + 0.5) / POINTS;
            const double rho = start + t1 * pair->face_advance;
            const double force = params->stiffness * delta * (to - from) / POINTS;
            const double v = (pinion_speed + wheel_speed) *
                             (rho - pair->pinion.base_radius * tan(pair->working_pressure_angle));
            const double friction =
                params->friction_coefficient * v / sqrt(v * v + v0 * v0) * force * per_cos;
            result[0] += force * pair->pinion.base_radius + friction * rho;
            result[1] += force * pair->wheel.base_radius + friction * (T - rho);
            result[2] += friction * v;
        }
    }
}

/* To rounding, and to what the points miss next to the pitch point where v0 is small. */
static void torques_and_loss_are_those_of_the_formula(void) {
    static const struct {
        double helix_angle, v0, tolerance;
    } cases[] = {
        {0.0, 0.01, 1e-11},   {0.0, 0.5, 1e-11}, {0.0, 1e-6, 1e-11},  {0.5759, 1e-6, 2e-5},
        {0.5759, 0.01, 1e-8}, {-0.3, 0.1, 1e-8}, {-0.03, 0.01, 1e-8}, {-0.3, 1e-9, 2e-5},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        gm_pair_params drawing = reference_params(REFERENCE_FACE_WIDTH);
        drawing.helix_angle = cases[k].helix_angle;
        drawing.center_distance = 0.5 * 1.65e-3 * 86 / cos(cases[k].helix_angle) + 0.3e-3;
        drawing.pinion_tip_radius = drawing.wheel_tip_radius = (double)NAN;
        gm_pair pair;
        gm_test_context("case %d", (int)k);
        GM_ASSERT_INT(gm_pair_init(&pair, &drawing), GM_OK);
        gm_mesh_params params = params_with(1e8, 0.0, 0.1);
        params.friction_speed = cases[k].v0;
        plain_mesh room;
        gm_mesh *mesh = mesh_with(&room, &params, &pair, NULL, NULL);
        for (int i = 0; i < 7; ++i) {
            gm_position position;
            gm_mesh_result r;
            GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.0231 * i,
                                                        0.5 * pair.backlash + 4e-6, 0.0, &position),
                          GM_OK);
            position.pinion_speed = i % 2 ? 100.0 : -40.0;
            GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
            double expected[3];
            by_points(&pair, &params, position.pinion_speed, position.phase, position.offset,
                      expected);
            const double tolerance = cases[k].tolerance;
            GM_ASSERT_REL(r.pinion_torque, expected[0], fmax(1e-11, 0.2 * tolerance));
            GM_ASSERT_REL(r.wheel_torque, expected[1], fmax(1e-11, 0.2 * tolerance));
            GM_ASSERT_REL(r.loss, expected[2], tolerance);
        }
    }
}

/* A line of spur gears through the pitch point: friction turns round, goes through zero, and jumps nowhere. */
static void friction_turns_round_in_the_pitch_point(void) {
    const gm_pair pair = standard_spur(30);
    gm_mesh_params params = params_with(1e8, 0.0, 0.1);
    plain_mesh room;
    gm_mesh *mesh = mesh_with(&room, &params, &pair, NULL, NULL);

    /* The phase at which tooth 0 touches in the pitch point, where it may be the only one. */
    const double pitch_point = pair.pinion.base_radius * tan(pair.working_pressure_angle);
    const double phase = pitch_point - pair.phase_origin[GM_DRIVE];
    double before = 0.0;
    for (int i = -20; i <= 20; ++i) {
        const double s = 1e-5 * i; /* 2 mm/s of sliding for each */
        gm_position position = {0, 0, phase + s, 0.5 * pair.backlash + 4e-6, 0.0, 100.0};
        gm_mesh_result r;
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
        const double friction = r.pinion_torque - r.force * pair.pinion.base_radius;
        const double largest = 0.1 * r.force * pitch_point;
        GM_ASSERT_INT(r.contact.drive_pairs, 1);
        if (i == 0) {
            GM_ASSERT_ABS(friction, 0.0, 1e-9 * largest);
        } else {
            GM_ASSERT(i > 0 ? friction > 0.0 : friction < 0.0);
        }
        GM_ASSERT(i == -20 || fabs(friction - before) < 0.3 * largest);
        GM_ASSERT(i < 20 || friction > 0.9 * largest);
        before = friction;
    }
}

/* ---------------------------------------------------------------------------------------------
 * Symmetries
 * ------------------------------------------------------------------------------------------- */

static void gears_that_turn_back_slide_the_other_way(void) {
    uint64_t seed = UINT64_C(903);
    int touching = 0;
    for (int i = 0; i < 200; ++i) {
        moving_case c;
        gm_mesh_result forth, back;
        gm_test_context("case %d", i);
        moving_case_make(&c, &seed, i);
        c.state.wheel_speed = c.state.pinion_speed * c.gears.pair.pinion.base_radius /
                              c.gears.pair.wheel.base_radius; /* x stays */
        gm_state turned = c.state;
        turned.pinion_speed = -turned.pinion_speed;
        turned.wheel_speed = -turned.wheel_speed;
        if (gm_mesh_evaluate(c.mesh, &c.state, GM_WANT_FORCE, NULL, &forth) == GM_OK &&
            forth.drive_force + forth.coast_force > 0.0) {
            GM_ASSERT_INT(gm_mesh_evaluate(c.mesh, &turned, GM_WANT_FORCE, NULL, &back), GM_OK);
            const double r_bp = c.gears.pair.pinion.base_radius;
            const double r_bw = c.gears.pair.wheel.base_radius;
            const double size = (forth.drive_force + forth.coast_force) * (r_bp + r_bw);
            GM_ASSERT_ABS(back.pinion_torque - back.force * r_bp,
                          forth.force * r_bp - forth.pinion_torque, 1e-12 * size);
            GM_ASSERT_ABS(back.wheel_torque - back.force * r_bw,
                          forth.force * r_bw - forth.wheel_torque, 1e-12 * size);
            GM_ASSERT_REL(back.loss, forth.loss, 1e-9);
            ++touching;
        }
        random_case_free(&c.gears);
    }
    gm_test_context("all cases");
    GM_ASSERT(touching > 100);
}

/* The wheel becomes the pinion: the same torques, each with the other name. */
static void gears_may_exchange_their_roles(void) {
    uint64_t seed = UINT64_C(904);
    int touching = 0;
    for (int i = 0; i < 300; ++i) {
        gm_pair_params params, turned_params;
        model_pair model;
        gm_pair pair, turned;
        random_params(&seed, &params, &model);
        GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);

        /* The drawing with the gears exchanged: the other hand, and each with the numbers of its mate. */
        gm_pair_params_default(&turned_params);
        turned_params.pinion_teeth = params.wheel_teeth;
        turned_params.wheel_teeth = params.pinion_teeth;
        turned_params.normal_module = params.normal_module;
        turned_params.normal_pressure_angle = params.normal_pressure_angle;
        turned_params.helix_angle = -params.helix_angle;
        turned_params.center_distance = params.center_distance;
        turned_params.face_width = pair.face_width;
        turned_params.base_helix = params.base_helix;
        turned_params.backlash = pair.backlash;

        turned_params.pinion_profile_shift = pair.wheel.profile_shift;
        turned_params.wheel_profile_shift = pair.pinion.profile_shift;
        turned_params.pinion_normal_thickness = pair.wheel.normal_thickness;
        turned_params.wheel_normal_thickness = pair.pinion.normal_thickness;
        turned_params.pinion_tip_radius = pair.wheel.tip_radius;
        turned_params.wheel_tip_radius = pair.pinion.tip_radius;
        turned_params.pinion_start_radius = pair.wheel.start_radius;
        turned_params.wheel_start_radius = pair.pinion.start_radius;

        gm_test_context("case %d", i);
        if (pair.face_start != 0.0 || pair.wheel.face_start != 0.0 ||
            gm_pair_init(&turned, &turned_params) != GM_OK ||
            fabs(params.helix_angle) < 0.02) { /* spur gears jump where a line ends */
            continue;
        }

        gm_mesh_params law = params_with(1e8, 0.0, 0.1);
        law.friction_law = i % 3;
        plain_mesh rooms[2];
        gm_mesh *meshes[2] = {mesh_with(&rooms[0], &law, &pair, NULL, NULL),
                              mesh_with(&rooms[1], &law, &turned, NULL, NULL)};
        const double x = 0.5 * pair.backlash + 1e-3 * pair.normal_module;
        const double angle = gm_test_uniform(&seed, -1.0, 1.0);
        const double speed = gm_test_uniform(&seed, -200.0, 200.0);
        const double ratio = pair.pinion.base_radius / pair.wheel.base_radius;
        const gm_state state = {angle, ratio * angle - x / pair.wheel.base_radius, speed,
                                ratio * speed};
        const gm_state other = {-(state.wheel_angle + pi / pair.wheel.teeth),
                                -(state.pinion_angle + pi / pair.pinion.teeth), -state.wheel_speed,
                                -state.pinion_speed};
        gm_mesh_result r, s;
        if (gm_mesh_evaluate(meshes[0], &state, GM_WANT_FORCE, NULL, &r) != GM_OK ||
            gm_mesh_evaluate(meshes[1], &other, GM_WANT_FORCE, NULL, &s) != GM_OK ||
            !(r.force > 0.0)) {
            continue;
        }

        /* Under load the place of contact, counted from the other gear, is off by the overlap: that share of the path
         * pushes the other way, at arms up to T. */
        const double path = pair.path_end - pair.path_start;
        const double arm =
            r.force * (x - 0.5 * pair.backlash) * fmax(1.0, pair.line_of_action / path);
        GM_ASSERT_REL(s.force, r.force, 1e-8);
        GM_ASSERT_ABS(s.wheel_torque, r.pinion_torque, arm);
        GM_ASSERT_ABS(s.pinion_torque, r.wheel_torque, arm);
        GM_ASSERT_ABS(s.loss, r.loss, arm * fabs(speed) * (1.0 + ratio));
        ++touching;
    }
    gm_test_context("all cases");
    GM_ASSERT(touching > 100);
}

/* ---------------------------------------------------------------------------------------------
 * Derivatives
 * ------------------------------------------------------------------------------------------- */

static void torques_at(gm_mesh *mesh, gm_state state, int which, double h, double torque[2]) {
    double *const coordinate[] = {&state.pinion_angle, &state.wheel_angle, &state.pinion_speed,
                                  &state.wheel_speed};
    gm_mesh_result r;
    *coordinate[which] += h;
    GM_ASSERT_INT(gm_mesh_evaluate(mesh, &state, GM_WANT_FORCE, NULL, &r), GM_OK);
    torque[0] = r.pinion_torque;
    torque[1] = r.wheel_torque;
}

/* At kinks the two one-sided differences disagree: such states are left out, and counted. */
static void gradients_of_the_torques_are_those_of_differences(void) {
    uint64_t seed = UINT64_C(905);
    int compared = 0, kinks = 0, tilted = 0;
    for (int i = 0; i < 1200; ++i) {
        moving_case c;
        gm_mesh_result r;
        gm_test_context("case %d", i);
        moving_case_make(&c, &seed, i);
        const gm_pair *pair = &c.gears.pair;
        const double r_bp = pair->pinion.base_radius, r_bw = pair->wheel.base_radius;
        if (gm_mesh_evaluate(c.mesh, &c.state, GM_WANT_DERIVATIVES, NULL, &r) == GM_OK &&
            r.drive_force + r.coast_force > 0.0) {
            const gm_gradient *by[2] = {&r.pinion_torque_by, &r.wheel_torque_by};

            /* One-sided differences, which agree where nothing begins to touch between. */
            for (int which = 0; which < 4; ++which) {
                const double scale = which < 2 ? 3e-6 * pair->normal_module / r_bp
                                               : 1e-5 * (fabs(c.state.pinion_speed) + 0.01);

                double ahead[2], behind[2];
                torques_at(c.mesh, c.state, which, scale, ahead);
                torques_at(c.mesh, c.state, which, -scale, behind);

                for (int gear = 0; gear < 2; ++gear) {
                    const double exact[4] = {by[gear]->pinion_angle, by[gear]->wheel_angle,
                                             by[gear]->pinion_speed, by[gear]->wheel_speed};
                    const double arm = gear ? r_bw : r_bp;
                    const double middle = gear ? r.wheel_torque : r.pinion_torque;

                    const double forward = (ahead[gear] - middle) / scale;
                    const double backward = (middle - behind[gear]) / scale;
                    const double size = which < 2 ? stiffness_of_all * r_bp * arm
                                                  : (r.drive_force + r.coast_force) * arm /
                                                            (fabs(c.state.pinion_speed) + 0.01) +
                                                        c.params.damping * r_bp * arm;

                    if (fabs(forward - backward) > 2e-5 * size) {
                        ++kinks;
                        continue;
                    }

                    ++compared;
                    tilted += c.params.pose.skew != 0.0;
                    GM_ASSERT_ABS(0.5 * (forward + backward), exact[which], 2e-5 * size);
                }
            }
        }
        random_case_free(&c.gears);
    }
    gm_test_context("all cases");
    GM_ASSERT(tilted > 400);
    GM_ASSERT(compared > 4000);
    GM_ASSERT(kinks < compared / 3);
}

/*
 * The same of a mesh that is a damper alone: its force is that of the touching part, which moves with the roots of the
 * overlap and with the ends of the lines.
 */
static void touching_part_moves_the_friction_too(void) {
    uint64_t seed = UINT64_C(907);
    int compared = 0, kinks = 0;
    for (int i = 0; i < 1500; ++i) {
        moving_case c;
        gm_mesh_result r;
        gm_test_context("case %d", i);
        moving_case_make(&c, &seed, i);
        const gm_pair *pair = &c.gears.pair;

        /* Hardly any stiffness: all is damping, whose force follows the touching part. */
        c.params.stiffness = 1e-3;
        c.params.damping = 1e5;
        c.params.friction_law = GM_FRICTION_CONSTANT;
        c.mesh = mesh_with(&c.room, &c.params, pair, c.gears.use[0], c.gears.use[1]);

        if (gm_mesh_evaluate(c.mesh, &c.state, GM_WANT_DERIVATIVES, NULL, &r) == GM_OK &&
            r.drive_force + r.coast_force > 0.0) {
            /* What friction alone makes of it. */
            const double r_bp = pair->pinion.base_radius;
            const double exact[2] = {
                r.pinion_torque_by.pinion_angle - r_bp * r.force_by.pinion_angle,
                r.pinion_torque_by.wheel_angle - r_bp * r.force_by.wheel_angle};
            const double size = fmax(fabs(exact[0]), fabs(exact[1]));

            for (int which = 0; which < 2; ++which) {
                const double h = 1e-7 * pair->normal_module / r_bp;
                double friction[3];
                for (int k = 0; k < 3; ++k) {
                    gm_state moved = c.state;
                    gm_mesh_result there;
                    *(which == 0 ? &moved.pinion_angle : &moved.wheel_angle) += (k - 1) * h;
                    GM_ASSERT_INT(gm_mesh_evaluate(c.mesh, &moved, GM_WANT_FORCE, NULL, &there),
                                  GM_OK);
                    friction[k] = there.pinion_torque - r_bp * there.force;
                }

                const double forward = (friction[2] - friction[1]) / h;
                const double backward = (friction[1] - friction[0]) / h;
                if (fabs(forward - backward) > 1e-3 * size) {
                    ++kinks;
                    continue;
                }

                ++compared;
                GM_ASSERT_ABS(0.5 * (forward + backward), exact[which], 1e-3 * size + 1e-6);
            }
        }
        random_case_free(&c.gears);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 1000);
}

/* While the axes move and tilt each point slides by another speed, and the torques still have exact derivatives. */
static void gradients_hold_while_the_axes_tilt(void) {
    uint64_t seed = UINT64_C(908);
    int compared = 0, kinks = 0;
    for (int i = 0; i < 300; ++i) {
        moving_case c;
        gm_test_context("case %d", i);
        moving_case_make(&c, &seed, i);

        const gm_pair *pair = &c.gears.pair;
        const double m = pair->normal_module;

        /* Nearly at rest, next to the creep speed, while the axes move. */
        c.params.damping =
            0.0; /* its mean speed of approach moves too, which derivatives leave out */
        c.params.friction_speed = 1e-3;
        c.mesh = mesh_with(&c.room, &c.params, pair, c.gears.use[0], c.gears.use[1]);
        c.state.pinion_speed *= 1e-3;
        c.state.wheel_speed *= 1e-3;

        const gm_pose rate = {gm_test_uniform(&seed, -1.0, 1.0) * m, 1e-1 * m, 0.0,
                              gm_test_uniform(&seed, -1.0, 1.0) * 0.1,
                              gm_test_uniform(&seed, -1.0, 1.0) * 0.1};
        const double radii[2] = {pair->pinion.base_radius, pair->wheel.base_radius};
        gm_mesh_result at[3];

        /* One-sided differences, as above. */
        for (int which = 0; which < 4; ++which) {
            const double h = which < 2 ? 1e-7 * m / radii[which] : 1e-6;
            int status = GM_OK;

            for (int k = 0; k < 3; ++k) {
                gm_state state = c.state;
                double *const places[4] = {&state.pinion_angle, &state.wheel_angle,
                                           &state.pinion_speed, &state.wheel_speed};
                *places[which] += (k - 1) * h;
                gm_motion motion = {.pose_rate = rate};
                status |= gm_position_from_state(pair, &state, &motion.position);
                status |=
                    gm_mesh_evaluate_posed(c.mesh, &motion, GM_WANT_DERIVATIVES, NULL, &at[k]);
            }

            if (status != GM_OK || at[1].drive_force + at[1].coast_force == 0.0) {
                continue;
            }

            const gm_gradient *by = &at[1].pinion_torque_by;
            const double exact[4] = {by->pinion_angle, by->wheel_angle, by->pinion_speed,
                                     by->wheel_speed};
            const double forward = (at[2].pinion_torque - at[1].pinion_torque) / h;
            const double backward = (at[1].pinion_torque - at[0].pinion_torque) / h;
            const double size =
                which < 2 ? stiffness_of_all * radii[0] * radii[which] : fabs(exact[which]) + 1e-3;

            if (fabs(forward - backward) > 1e-4 * size) {
                ++kinks;
                continue;
            }
            ++compared;
            GM_ASSERT_ABS(0.5 * (forward + backward), exact[which],
                          1e-5 * size + 0.51 * fabs(forward - backward));
        }
        random_case_free(&c.gears);
    }
    gm_test_context("all cases: %d compared, %d kinks", compared, kinks);
    GM_ASSERT(compared > 300);
    GM_ASSERT(kinks < compared);
}

/* ---------------------------------------------------------------------------------------------
 * Known limits
 * ------------------------------------------------------------------------------------------- */

/* eps_1 and eps_2: the parts of the contact ratio on both sides of the pitch point. */
static void contact_ratios(const gm_pair *pair, double eps[2]) {
    const double pitch_point = pair->pinion.base_radius * tan(pair->working_pressure_angle);
    eps[0] = (pair->path_end - pitch_point) / pair->transverse_base_pitch;
    eps[1] = (pitch_point - pair->path_start) / pair->transverse_base_pitch;
}

/* Loss over power in per mu, mean over a mesh cycle under constant torque, teeth next to rigid and mu next to 0. */
static double loss_factor(const gm_pair *pair, int positions) {
    gm_mesh_params params = params_with(1e10, 0.0, 1e-6);
    params.friction_speed = 1e-8;
    plain_mesh room;
    gm_mesh *mesh = mesh_with(&room, &params, pair, NULL, NULL);
    const double torque = 1.0, speed = 100.0;
    double loss = 0.0, guess = (double)NAN;
    for (int k = 0; k < positions; ++k) {
        const double angle = pair->pinion.pitch_angle * (k + 0.5) / positions;
        gm_mesh_result r;
        GM_ASSERT_INT(gm_rolling_equilibrium(mesh, angle, speed, torque, guess, NULL, &guess, &r),
                      GM_OK);
        loss += r.loss / positions;
    }
    return loss /
           (params.friction_coefficient * torque * speed * pair->pinion.teeth / pair->wheel.teeth);
}

/* [Ohlendorf]: H_V = pi (u + 1) / (z_1 u cos(beta_b)) (1 - eps_alpha + eps_1^2 + eps_2^2), pairs sharing the load equally. */
static void equal_sharing_gives_the_loss_factor_of_ohlendorf(void) {
    const gm_pair pair = standard_spur(62);
    double eps[2];
    contact_ratios(&pair, eps);
    const double bracket = 1.0 - pair.transverse_contact_ratio + eps[0] * eps[0] + eps[1] * eps[1];
    GM_ASSERT_ABS(bracket, 0.811877, 1e-6);

    /* The mean over steps misses up to one of them where a pair enters. */
    const double expected = pi * 2.0 / 62.0 * bracket;
    GM_ASSERT_REL(loss_factor(&pair, 4000), expected, 1e-3);
}

/* NREL 5 MW gearbox, stage 3, as wide as its lines of contact stay equally long: uniform line load. */
static gm_pair nrel_stage_3(double face_width) {
    gm_pair_params params;
    gm_pair pair;
    gm_pair_params_default(&params);
    params.pinion_teeth = 24;
    params.wheel_teeth = 95;
    params.normal_module = 14e-3;
    params.normal_pressure_angle = 20.0 * pi / 180.0;
    params.helix_angle = 10.0 * pi / 180.0;
    params.center_distance = 0.861;
    params.face_width = face_width;
    params.backlash = 0.3e-3; /* the shifts as printed have none */
    params.pinion_profile_shift = 0.4800;
    params.wheel_profile_shift = 0.6691;
    params.pinion_tip_radius = 0.5 * 380.747e-3;
    params.wheel_tip_radius = 0.5 * 1395.376e-3;
    GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);
    return pair;
}

static void uniform_line_load_gives_its_loss_factor(void) {
    gm_pair pair = nrel_stage_3(0.36);
    pair = nrel_stage_3(0.36 / pair.overlap_ratio);
    GM_ASSERT_ABS(pair.overlap_ratio, 1.0, 1e-12);
    double eps[2];
    contact_ratios(&pair, eps);
    const double ratio = pair.transverse_contact_ratio;
    const double squares = eps[0] * eps[0] + eps[1] * eps[1];
    const double bracket = squares / ratio;
    GM_ASSERT_ABS(bracket, 0.7513, 5e-5);

    const double u = 95.0 / 24.0;
    const double factor = pi * (u + 1.0) / (24.0 * u * cos(pair.base_helix_angle));
    GM_ASSERT_ABS(factor * (1.0 - ratio + squares), 0.10574, 1e-5); /* as printed */
    GM_ASSERT_REL(loss_factor(&pair, 400), factor * bracket, 1e-5);
}

/* ---------------------------------------------------------------------------------------------
 * Laws, and where there is no friction
 * ------------------------------------------------------------------------------------------- */

/* One pair of spur gears in contact, far above v0: mu is the friction over the normal force. */
static double coefficient_at(const gm_pair *pair, const gm_mesh_params *params, double phase,
                             double speed, gm_mesh_result *r) {
    plain_mesh room;
    gm_mesh *mesh = mesh_with(&room, params, pair, NULL, NULL);
    gm_position position = {0, 0, phase, 0.5 * pair->backlash + 10e-6, 0.0, speed};
    GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, r), GM_OK);
    GM_ASSERT_INT(r->contact.drive_pairs, 1);
    const double rho = pair->phase_origin[GM_DRIVE] + phase;
    return (r->pinion_torque - r->force * pair->pinion.base_radius) / (r->force * rho);
}

static void coefficients_are_those_of_their_laws(void) {
    const gm_pair pair = standard_spur(30);
    const double pitch_point = pair.pinion.base_radius * tan(pair.working_pressure_angle);
    const double s = 0.5e-3; /* beyond the pitch point */
    const double phase = pitch_point + s - pair.phase_origin[GM_DRIVE];
    const double speed = 150.0;
    gm_mesh_params params = params_with(3e8, 0.0, 0.0);
    params.friction_speed = 1e-9;
    gm_mesh_result r;

    /* z 30/30, m 2, alpha 20: rho_C = 15 mm * 2 * sin(20), both gears; v_sum = 2 omega rho_C, v = 2 omega s. */
    const double rho_c = 30e-3 * sin(20.0 * pi / 180.0);
    const double v_sum = 2.0 * speed * rho_c, v = 2.0 * speed * s;
    GM_ASSERT_REL(pitch_point, rho_c, 1e-12);
    params.friction_law = GM_FRICTION_ISO14179;
    const double iso = coefficient_at(&pair, &params, phase, speed, &r);
    const double per_mm = r.force / 20.0;
    GM_ASSERT_REL(iso,
                  0.048 * pow(per_mm / (v_sum * 1e3 * rho_c / 2.0), 0.2) * pow(50.0, -0.05) *
                      pow(0.6, 0.25),
                  1e-9);
    params.friction_law = GM_FRICTION_BENEDICT_KELLEY;
    GM_ASSERT_REL(coefficient_at(&pair, &params, phase, speed, &r),
                  0.0127 * log10(29.66 * 1e3 * per_mm / (50.0 * v * v_sum * v_sum)), 1e-9);

    /* In the units of its authors: 3.17e8, lbf/in, cP, in/s, three digits. */
    const double inch = 0.0254, pound = 4.4482216;
    const double imperial = 3.17e8 * (per_mm * 1e3 * inch / pound) /
                            (50.0 * (v / inch) * (v_sum / inch) * (v_sum / inch));
    GM_ASSERT_ABS(coefficient_at(&pair, &params, phase, speed, &r), 0.0127 * log10(imperial),
                  0.0127 * 0.005 / 3.17 / log(10.0));
    params.friction_law = GM_FRICTION_CONSTANT;
    params.friction_coefficient = 0.07;
    GM_ASSERT_REL(coefficient_at(&pair, &params, phase, speed, &r), 0.07, 1e-9);

    /* Where the logarithm would turn friction round there is none. */
    params.friction_law = GM_FRICTION_BENEDICT_KELLEY;
    params.oil_viscosity = 1e6;
    GM_ASSERT_ABS(coefficient_at(&pair, &params, phase, speed, &r), 0.0, 1e-15);
}

static void there_is_no_friction_at_rest_and_in_the_simple_model(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    gm_mesh_params params = params_with(1e8, 0.0, 0.1);
    plain_mesh room, simple_room;
    gm_mesh *mesh = mesh_with(&room, &params, &pair, NULL, NULL);
    params.model = GM_MODEL_SIMPLE;
    gm_mesh *simple = mesh_with(&simple_room, &params, &pair, NULL, NULL);

    /* At rest. */
    gm_position position = {0, 0, 1e-3, 0.5 * pair.backlash + 4e-6, 0.0, 0.0};
    gm_mesh_result r;
    GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
    GM_ASSERT_REL(r.pinion_torque, r.force * pair.pinion.base_radius, 1e-15);
    GM_ASSERT_ABS(r.loss, 0.0, 0.0);

    /* The simple model, which has no sliding. */
    position.pinion_speed = 100.0;
    GM_ASSERT_INT(gm_mesh_evaluate_at(simple, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
    GM_ASSERT_REL(r.wheel_torque, r.force * pair.wheel.base_radius, 1e-15);
    GM_ASSERT_ABS(r.loss, 0.0, 0.0);

    /* Without a speed there is no answer. */
    position.pinion_speed = (double)NAN;
    GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r),
                  GM_STATE_NOT_FINITE);
    GM_ASSERT_NAN(r.pinion_torque);
    GM_ASSERT_NAN(r.loss);

    /* Nor a number in a pose of the call, nor in its tangent. */
    const gm_motion motion = {.position = position, .pose = {.skew = 1e-5}};
    gm_tangent tangent;
    GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, GM_WANT_FORCE, NULL, &r),
                  GM_STATE_NOT_FINITE);
    GM_ASSERT_NAN(r.force);
    GM_ASSERT_INT(gm_mesh_tangent(mesh, &motion, &tangent), GM_STATE_NOT_FINITE);
    GM_ASSERT_NAN(tangent.force_by[GM_SKEW]);
}

/* ---------------------------------------------------------------------------------------------
 * Equilibrium
 * ------------------------------------------------------------------------------------------- */

static void rolling_gears_carry_the_torque_with_friction(void) {
    uint64_t seed = UINT64_C(906);
    int carried = 0;
    for (int i = 0; i < 200; ++i) {
        moving_case c;
        gm_test_context("case %d", i);
        moving_case_make(&c, &seed, i);
        const double arm = c.gears.pair.wheel.base_radius;
        const double torque =
            (i % 2 ? 1.0 : -1.0) * stiffness_of_all * 2e-3 * c.gears.pair.normal_module * arm;
        double x;
        gm_mesh_result r;
        const int status = gm_rolling_equilibrium(
            c.mesh, c.state.pinion_angle, c.state.pinion_speed, torque, (double)NAN, NULL, &x, &r);
        if (status == GM_OK && c.gears.pair.face_advance != 0.0) {
            GM_ASSERT_REL(r.wheel_torque, torque, 1e-9);

            /* Over the turn at constant x the power goes out or is lost. */
            const double ratio = c.gears.pair.pinion.base_radius / c.gears.pair.wheel.base_radius;
            GM_ASSERT_REL(r.pinion_torque * c.state.pinion_speed - r.loss,
                          torque * c.state.pinion_speed * ratio, 1e-9);
            ++carried;
        }
        random_case_free(&c.gears);
    }
    gm_test_context("all cases");
    GM_ASSERT(carried > 100);
}

static void parameters_out_of_range_are_refused(void) {
    const struct {
        const char *field;
        int law;
        double coefficient, speed, viscosity, roughness;
    } cases[] = {
        {"friction_law", 3, 0.1, 0.01, 0.05, 1e-6},
        {"friction_coefficient", 0, -0.1, 0.01, NAN, NAN},
        {"friction_coefficient", 0, 1.1, 0.01, NAN, NAN},
        {"friction_coefficient", 0, NAN, 0.01, NAN, NAN},
        {"friction_speed", 0, 0.1, 0.0, NAN, NAN},
        {"oil_viscosity", 1, 0.1, 0.01, NAN, 1e-6},
        {"oil_viscosity", 2, 0.1, 0.01, 0.0, 1e-6},
        {"roughness", 1, 0.1, 0.01, 0.05, NAN},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        gm_mesh_params params = params_with(1e8, 0.0, cases[k].coefficient);
        const char *field = NULL, *requirement = NULL;
        params.friction_law = cases[k].law;
        params.friction_speed = cases[k].speed;
        params.oil_viscosity = cases[k].viscosity;
        params.roughness = cases[k].roughness;
        gm_test_context("case %d", (int)k);
        GM_ASSERT_INT(gm_mesh_params_check(&params, &field, &requirement), GM_ERR_PARAMETER);
        GM_ASSERT_STRING(field, cases[k].field);
        GM_ASSERT(requirement != NULL);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(power_in_is_power_out_and_stored_and_lost),
        GM_TEST(what_acts_on_one_gear_acts_on_the_other),
        GM_TEST(side_force_stands_across_the_normal_one),
        GM_TEST(torques_and_loss_are_those_of_the_formula),
        GM_TEST(friction_turns_round_in_the_pitch_point),
        GM_TEST(gears_that_turn_back_slide_the_other_way),
        GM_TEST(gears_may_exchange_their_roles),
        GM_TEST(gradients_of_the_torques_are_those_of_differences),
        GM_TEST(touching_part_moves_the_friction_too),
        GM_TEST(gradients_hold_while_the_axes_tilt),
        GM_TEST(equal_sharing_gives_the_loss_factor_of_ohlendorf),
        GM_TEST(uniform_line_load_gives_its_loss_factor),
        GM_TEST(coefficients_are_those_of_their_laws),
        GM_TEST(there_is_no_friction_at_rest_and_in_the_simple_model),
        GM_TEST(rolling_gears_carry_the_torque_with_friction),
        GM_TEST(parameters_out_of_range_are_refused),
    };
    return gm_test_main("unit.friction", tests, GM_TEST_COUNT(tests), argc, argv);
}
