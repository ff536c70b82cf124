/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Gears that move: a pose at every call, and bodies of a multibody code. Bodies are built from angles, pose and a frame
 * that moves itself, by rotation matrices; their velocities are differences.
 */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "random_gears.h"
#include "reference_gear.h"

enum { POSES = 250 };

/* ---------------------------------------------------------------------------------------------
 * Bodies from angles and pose
 * ------------------------------------------------------------------------------------------- */

static void multiply(const double a[9], const double b[9], double c[9]) {
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
        }
    }
}

static void apply(const double a[9], const double v[3], double result[3]) {
    for (int i = 0; i < 3; ++i) {
        result[i] = a[3 * i] * v[0] + a[3 * i + 1] * v[1] + a[3 * i + 2] * v[2];
    }
}

/* Rodrigues: the rotation by a vector. */
static void rotation_by(const double w[3], double r[9]) {
    const double angle = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    const double s = angle > 0.0 ? sin(angle) / angle : 1.0;
    const double c = angle > 0.0 ? (1.0 - cos(angle)) / (angle * angle) : 0.5;
    const double k[9] = {0.0, -w[2], w[1], w[2], 0.0, -w[0], -w[1], w[0], 0.0};
    double kk[9];
    multiply(k, k, kk);
    for (int i = 0; i < 9; ++i) {
        r[i] = (i % 4 == 0) + s * k[i] + c * kk[i];
    }
}

/* How everything moves: values at time 0 and rates. */
typedef struct motion_plan {
    double angle[2], speed[2];     /* phi_p, phi_w */
    gm_pose pose, rate;            /* offset 0: the mesh frame looks at the wheel */
    double origin[3], velocity[3]; /* of the pinion's point in the common frame */
    double attitude[3], omega[3];  /* of the mesh frame: exp(omega t) exp(attitude) */
} motion_plan;

static void bodies_at(const gm_pair *pair, const motion_plan *plan, double t, gm_body bodies[2]) {
    double turning[3], turned[9], start[9], frame[9];
    for (int k = 0; k < 3; ++k) {
        turning[k] = plan->omega[k] * t;
    }
    rotation_by(turning, turned);
    rotation_by(plan->attitude, start);
    multiply(turned, start, frame);

    const double about_pinion[3] = {0.0, 0.0, plan->angle[0] + plan->speed[0] * t};
    const double sign = pair->wheel.sign; /* of a ring -1 */
    const double about_wheel[3] = {0.0, 0.0, -sign * (plan->angle[1] + plan->speed[1] * t)};
    const double tilting[3] = {plan->pose.skew + plan->rate.skew * t,
                               plan->pose.inclination + plan->rate.inclination * t, 0.0};
    const double drawn =
        pair->wheel.face_start + 0.5 * pair->wheel.face_width - 0.5 * pair->pinion.face_width;
    const double arm[3] = {sign * pair->center_distance + plan->pose.center_distance_change +
                               plan->rate.center_distance_change * t,
                           0.0, drawn + plan->pose.axial_shift + plan->rate.axial_shift * t};
    double spin[9], tilt[9], both[9], way[3];
    rotation_by(about_pinion, spin);
    multiply(frame, spin, bodies[0].rotation);
    rotation_by(about_wheel, spin);
    rotation_by(tilting, tilt);
    multiply(tilt, spin, both);
    multiply(frame, both, bodies[1].rotation);
    apply(frame, arm, way);
    for (int k = 0; k < 3; ++k) {
        bodies[0].position[k] = plan->origin[k] + plan->velocity[k] * t;
        bodies[1].position[k] = bodies[0].position[k] + way[k];
    }
}

/* With velocities by differences of fourth order: omega x = R' R^T. */
static void moving_bodies(const gm_pair *pair, const motion_plan *plan, gm_body bodies[2]) {
    static const double weight[4] = {1.0 / 12.0, -2.0 / 3.0, 2.0 / 3.0, -1.0 / 12.0};
    static const double place[4] = {-2.0, -1.0, 1.0, 2.0};
    const double h = 1e-3;
    gm_body near_by[4][2];
    bodies_at(pair, plan, 0.0, bodies);
    for (int k = 0; k < 4; ++k) {
        bodies_at(pair, plan, place[k] * h, near_by[k]);
    }
    for (int body = 0; body < 2; ++body) {
        double rate[9] = {0.0}, transposed[9], spinning[9];
        for (int i = 0; i < 3; ++i) {
            bodies[body].velocity[i] = 0.0;
        }
        for (int k = 0; k < 4; ++k) {
            for (int i = 0; i < 9; ++i) {
                rate[i] += weight[k] / h * near_by[k][body].rotation[i];
            }
            for (int i = 0; i < 3; ++i) {
                bodies[body].velocity[i] += weight[k] / h * near_by[k][body].position[i];
            }
        }
        for (int i = 0; i < 9; ++i) {
            transposed[i] = bodies[body].rotation[3 * (i % 3) + i / 3];
        }
        multiply(rate, transposed, spinning);
        bodies[body].angular_velocity[0] = spinning[7];
        bodies[body].angular_velocity[1] = spinning[2];
        bodies[body].angular_velocity[2] = spinning[3];
    }
}

static void random_vector(uint64_t *seed, double size, double v[3]) {
    for (int k = 0; k < 3; ++k) {
        v[k] = gm_test_uniform(seed, -size, size);
    }
}

/* Near contact on either side; tilted by `tilt` times what the pair allows. */
static motion_plan random_plan(const gm_pair *pair, uint64_t *seed, double tilt) {
    motion_plan plan;
    const double m = pair->normal_module;
    const double tilted = tilt * pair->transverse_base_pitch / pair->face_width;
    const double x =
        gm_test_uniform(seed, -0.5, 0.5) * pair->backlash + gm_test_uniform(seed, -4e-3, 4e-3) * m;
    plan.angle[0] = gm_test_uniform(seed, -3.0, 3.0);
    plan.angle[1] = (pair->pinion.base_radius * plan.angle[0] - x) / pair->wheel.base_radius;
    plan.speed[0] = gm_test_uniform(seed, -2.0, 2.0);
    plan.speed[1] = gm_test_uniform(seed, -2.0, 2.0);
    plan.pose = (gm_pose){
        gm_test_uniform(seed, -0.01, 0.01) * m, 0.0, gm_test_uniform(seed, -0.02, 0.02) * m,
        gm_test_uniform(seed, -tilted, tilted), gm_test_uniform(seed, -tilted, tilted)};
    plan.rate = (gm_pose){gm_test_uniform(seed, -m, m), 0.0, gm_test_uniform(seed, -m, m),
                          gm_test_uniform(seed, -0.1, 0.1), gm_test_uniform(seed, -0.1, 0.1)};
    random_vector(seed, 1.0, plan.origin);
    random_vector(seed, 1.0, plan.velocity);
    random_vector(seed, 1.7, plan.attitude);
    random_vector(seed, 1.0, plan.omega);
    return plan;
}

static gm_mesh *mesh_of(plain_mesh *room, const random_case *c, double damping) {
    gm_mesh *mesh;
    GM_ASSERT_INT(plain_mesh_make(room, &c->pair, c->use[0], c->use[1], 1e8, damping, &mesh),
                  GM_OK);
    return mesh;
}

/* ---------------------------------------------------------------------------------------------
 * Motion
 * ------------------------------------------------------------------------------------------- */

static void motion_is_the_one_that_bodies_were_built_from(void) {
    uint64_t seed = UINT64_C(201);
    for (int i = 0; i < POSES; ++i) {
        random_case c;
        plain_mesh room;
        gm_body bodies[2];
        gm_motion motion;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        const motion_plan plan = random_plan(&c.pair, &seed, 0.02);
        const gm_mesh *mesh = mesh_of(&room, &c, 0.0);
        double frame[9];
        moving_bodies(&c.pair, &plan, bodies);
        GM_ASSERT_INT(gm_motion_of_bodies(mesh, &bodies[0], &bodies[1], &motion, frame), GM_OK);

        /* Roundings of a rotation, and of a difference of fourth order. */
        const double size = 1.0 + c.pair.center_distance;
        GM_ASSERT_ABS(motion.pose.center_distance_change, plan.pose.center_distance_change,
                      1e-14 * size);
        GM_ASSERT_ABS(motion.pose.offset, 0.0, 0.0);
        GM_ASSERT_ABS(motion.pose.axial_shift, plan.pose.axial_shift, 1e-14 * size);
        GM_ASSERT_ABS(motion.pose.skew, plan.pose.skew, 1e-14);
        GM_ASSERT_ABS(motion.pose.inclination, plan.pose.inclination, 1e-14);
        GM_ASSERT_ABS(motion.pose_rate.center_distance_change, plan.rate.center_distance_change,
                      1e-10 * size);
        GM_ASSERT_ABS(motion.pose_rate.axial_shift, plan.rate.axial_shift, 1e-10 * size);
        GM_ASSERT_ABS(motion.pose_rate.skew, plan.rate.skew, 1e-10);
        GM_ASSERT_ABS(motion.pose_rate.inclination, plan.rate.inclination, 1e-10);
        GM_ASSERT_ABS(motion.position.offset_rate,
                      c.pair.pinion.base_radius * plan.speed[0] -
                          c.pair.wheel.base_radius * plan.speed[1],
                      1e-10 * size);

        gm_position expected;
        const gm_state state = {plan.angle[0], plan.angle[1], 0.0, 0.0};
        GM_ASSERT_INT(gm_position_from_state(&c.pair, &state, &expected), GM_OK);
        const double p_bt = c.pair.transverse_base_pitch;
        if (expected.phase > 1e-9 * p_bt && expected.phase < (1.0 - 1e-9) * p_bt) {
            GM_ASSERT_INT(motion.position.pinion_tooth, expected.pinion_tooth);
            GM_ASSERT_INT(motion.position.wheel_tooth, expected.wheel_tooth);
            GM_ASSERT_ABS(motion.position.phase, expected.phase, 1e-14 * size);
        }
        GM_ASSERT_ABS(motion.position.offset, expected.offset, 1e-14 * size);

        /* The frame is that of the attitude. */
        double start[9];
        rotation_by(plan.attitude, start);
        for (int k = 0; k < 9; ++k) {
            GM_ASSERT_ABS(frame[k], start[k], 1e-13);
        }
        random_case_free(&c);
    }
}

/* Bodies know nothing of whole turns, and the wheel may be assembled any number of teeth further. */
static void any_teeth_may_meet(void) {
    uint64_t seed = UINT64_C(202);
    for (int i = 0; i < POSES; ++i) {
        random_case c;
        plain_mesh room;
        gm_body bodies[2];
        gm_motion plain, further;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        motion_plan plan = random_plan(&c.pair, &seed, 0.0);
        const gm_mesh *mesh = mesh_of(&room, &c, 0.0);
        moving_bodies(&c.pair, &plan, bodies);
        GM_ASSERT_INT(gm_motion_of_bodies(mesh, &bodies[0], &bodies[1], &plain, NULL), GM_OK);

        const int z = c.pair.wheel.teeth;
        const int teeth = (int)gm_test_uniform(&seed, -3.0 * z, 3.0 * z);
        plan.angle[1] += teeth * 6.283185307179586 / z;
        moving_bodies(&c.pair, &plan, bodies);
        GM_ASSERT_INT(gm_motion_of_bodies(mesh, &bodies[0], &bodies[1], &further, NULL), GM_OK);
        GM_ASSERT_ABS(further.position.offset, plain.position.offset,
                      1e-13 * (1.0 + c.pair.center_distance));
        GM_ASSERT_INT(further.position.pinion_tooth, plain.position.pinion_tooth);

        /* The wheel has turned clockwise by so many teeth, which count clockwise. */
        const int expected = ((plain.position.wheel_tooth - teeth) % z + z) % z;
        GM_ASSERT_INT(further.position.wheel_tooth, expected);
        random_case_free(&c);
    }
}

/* The teeth that meet are those within half a base pitch once the helix has turned the shift of the face into x. */
static void an_axial_shift_counts_in_which_teeth_meet(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double p_bt = pair.transverse_base_pitch, tangent = tan(pair.base_helix_angle);
    static const struct {
        double offset, shift,
            expected; /* x as the bodies stand, dz tan(beta_b), x that counts: in base pitches */
    } cases[] = {{0.3, 0.4, -0.7},  {0.095, 0.4, 0.095},    {0.105, 0.4, -0.895},
                 {-0.3, -0.4, 0.7}, {-0.095, -0.4, -0.095}, {0.3, -0.4, 0.3},
                 {0.0, 0.497, 0.0}, {0.0, 0.503, -1.0}};
    plain_mesh room;
    gm_mesh *mesh;
    GM_ASSERT_INT(plain_mesh_make(&room, &pair, NULL, NULL, 1e8, 0.0, &mesh), GM_OK);
    for (int i = 0; i < (int)(sizeof cases / sizeof cases[0]); ++i) {
        gm_test_context("case %d", i);
        const motion_plan plan = {
            .angle = {0.3, (pair.pinion.base_radius * 0.3 - cases[i].offset * p_bt) /
                               pair.wheel.base_radius},
            .pose = {.axial_shift = cases[i].shift * p_bt / tangent}};
        gm_body bodies[2];
        gm_motion motion;
        moving_bodies(&pair, &plan, bodies);
        GM_ASSERT_INT(gm_motion_of_bodies(mesh, &bodies[0], &bodies[1], &motion, NULL), GM_OK);
        GM_ASSERT_ABS(motion.position.offset, cases[i].expected * p_bt, 1e-13);
    }
    gm_test_context("%s", "");
}

/* ---------------------------------------------------------------------------------------------
 * Loads
 * ------------------------------------------------------------------------------------------- */

static double largest_of(const double v[3]) {
    return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
}

static void add_moment(const gm_load *load, const double position[3], double moment[3]) {
    const double *f = load->force;
    moment[0] += load->moment[0] + position[1] * f[2] - position[2] * f[1];
    moment[1] += load->moment[1] + position[2] * f[0] - position[0] * f[2];
    moment[2] += load->moment[2] + position[0] * f[1] - position[1] * f[0];
}

static void loads_are_in_balance_and_turn_with_the_frame(void) {
    uint64_t seed = UINT64_C(203);
    int touching = 0;
    for (int i = 0; i < 2 * POSES; ++i) {
        random_case c;
        plain_mesh room;
        gm_body bodies[2];
        gm_load loads[2], others[2];
        gm_mesh_result result;

        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        motion_plan plan = random_plan(&c.pair, &seed, 0.02);
        const gm_mesh *mesh = mesh_of(&room, &c, 1e3);
        moving_bodies(&c.pair, &plan, bodies);

        /* What acts on both bodies cancels, forces and moments about any point. */
        const int status = gm_mesh_evaluate_bodies(mesh, &bodies[0], &bodies[1], GM_WANT_FORCE,
                                                   NULL, &result, &loads[0], &loads[1]);
        if (status == GM_OK && (result.drive_force > 0.0 || result.coast_force > 0.0)) {
            double moment[3] = {0.0, 0.0, 0.0};
            add_moment(&loads[0], bodies[0].position, moment);
            add_moment(&loads[1], bodies[1].position, moment);
            const double size = largest_of(loads[0].force);
            for (int k = 0; k < 3; ++k) {
                GM_ASSERT_ABS(loads[0].force[k] + loads[1].force[k], 0.0, 1e-14 * size);
                GM_ASSERT_ABS(moment[k], 0.0, 1e-13 * size * (2.0 + c.pair.center_distance));
            }

            /* About the pinion's axis it is F r_bp. */
            double torque = 0.0;
            for (int k = 0; k < 3; ++k) {
                torque += loads[0].moment[k] * bodies[0].rotation[3 * k + 2];
            }
            GM_ASSERT_ABS(torque, -result.force * c.pair.pinion.base_radius,
                          1e-12 * size * (1.0 + c.pair.center_distance));

            /* The same in a frame elsewhere, which moves otherwise. */
            motion_plan other = plan;
            random_vector(&seed, 1.0, other.origin);
            random_vector(&seed, 1.0, other.velocity);
            random_vector(&seed, 1.7, other.attitude);
            random_vector(&seed, 1.0, other.omega);
            gm_body elsewhere[2];
            moving_bodies(&c.pair, &other, elsewhere);
            GM_ASSERT_INT(gm_mesh_evaluate_bodies(mesh, &elsewhere[0], &elsewhere[1], GM_WANT_FORCE,
                                                  NULL, &result, &others[0], &others[1]),
                          GM_OK);

            /* Turned back from the other frame, the loads are those of the first one. */
            double from[9], into[9], back[9];
            rotation_by(plan.attitude, into);
            rotation_by(other.attitude, from);
            for (int k = 0; k < 9; ++k) {
                back[k] = into[3 * (k % 3) + k / 3];
            }
            multiply(from, back, into);
            for (int body = 0; body < 2; ++body) {
                double force[3], turned[3];
                apply(into, loads[body].force, force);
                apply(into, loads[body].moment, turned);

                /* Positions of metres leave 1e-15 m, and differences 1e-10 m/s. */
                const double little = 1e8 * 4e-15 * (1.0 + c.pair.center_distance) + 1e3 * 1e-9;
                for (int k = 0; k < 3; ++k) {
                    GM_ASSERT_ABS(others[body].force[k], force[k], 4.0 * little);
                    GM_ASSERT_ABS(others[body].moment[k], turned[k],
                                  4.0 * little * (c.pair.center_distance + c.pair.face_width));
                }
            }
            ++touching;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(touching > POSES / 2);
}

static double power_of(const gm_load *load, const gm_body *body) {
    double power = 0.0;
    for (int k = 0; k < 3; ++k) {
        power += load->force[k] * body->velocity[k] + load->moment[k] * body->angular_velocity[k];
    }
    return power;
}

/* Parallel axes: all points of a side approach at one speed, that of the ideal overlap, here by differences. */
static void power_is_force_times_speed_of_approach(void) {
    uint64_t seed = UINT64_C(204);
    int touching = 0;
    for (int i = 0; i < 2 * POSES; ++i) {
        random_case c;
        plain_mesh room;
        gm_body bodies[2];
        gm_load loads[2];
        gm_mesh_result r;

        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);

        /* Bodies that move, but do not tip, with damping every other time. */
        motion_plan plan = random_plan(&c.pair, &seed, 0.0);
        plan.rate.skew = plan.rate.inclination = 0.0;
        const double damping = i % 2 == 0 ? 0.0 : 1e3;
        const gm_mesh *mesh = mesh_of(&room, &c, damping);
        moving_bodies(&c.pair, &plan, bodies);

        const int status = gm_mesh_evaluate_bodies(mesh, &bodies[0], &bodies[1], GM_WANT_FORCE,
                                                   NULL, &r, &loads[0], &loads[1]);

        /* x less the clearance of ideal flanks in that pose is the overlap. */
        const double h = 1e-4;
        double approach[2] = {0.0, 0.0};
        int all = status;
        for (int k = -1; k <= 1 && all == GM_OK; k += 2) {
            plain_mesh place;
            gm_mesh *ideal;
            gm_mesh_params law;
            gm_mesh_params_default(&law);
            law.stiffness = 1.0;
            law.pose.center_distance_change =
                plan.pose.center_distance_change + k * h * plan.rate.center_distance_change;
            law.pose.axial_shift = plan.pose.axial_shift + k * h * plan.rate.axial_shift;
            all =
                gm_mesh_init(&ideal, &law, &c.pair, NULL, NULL, place.memory, sizeof place.memory);
            for (int side = GM_DRIVE; all == GM_OK && side <= GM_COAST; ++side) {
                approach[side] -= k * gm_mesh_clearance(ideal, side) / (2.0 * h);
            }
        }
        if (all == GM_OK && (r.drive_force > 0.0 || r.coast_force > 0.0)) {
            const double x_rate = c.pair.pinion.base_radius * plan.speed[0] -
                                  c.pair.wheel.base_radius * plan.speed[1];
            const double expected = -r.drive_force * (approach[GM_DRIVE] + x_rate) -
                                    r.coast_force * (approach[GM_COAST] - x_rate);
            const double got = power_of(&loads[0], &bodies[0]) + power_of(&loads[1], &bodies[1]);
            const double size = (r.drive_force + r.coast_force) * (2.0 + c.pair.center_distance);
            GM_ASSERT_ABS(got, expected, 1e-8 * size); /* differences of second order */
            GM_ASSERT_ABS(r.contact.drive_rate,
                          (approach[GM_DRIVE] + x_rate) * r.contact.drive_contact, 1e-7);
            GM_ASSERT_ABS(r.contact.coast_rate,
                          (approach[GM_COAST] - x_rate) * r.contact.coast_contact, 1e-7);
            ++touching;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(touching > POSES / 2);
}

/* Energy of the mesh at a time of the plan; positions alone tell it. */
static double energy_at(const gm_mesh *mesh, const motion_plan *plan, double t, int *status) {
    gm_body bodies[2];
    gm_load loads[2];
    gm_mesh_result r;
    memset(bodies, 0, sizeof bodies);
    bodies_at(gm_mesh_pair(mesh), plan, t, bodies);
    *status |= gm_mesh_evaluate_bodies(mesh, &bodies[0], &bodies[1], GM_WANT_ENERGY, NULL, &r,
                                       &loads[0], &loads[1]);
    return r.energy;
}

/*
 * What the bodies lose the mesh has stored, or friction has taken. Between ideal flanks whose edges go on beyond the path
 * nothing is left open, however both bodies move on parallel axes, but for what overlaps at the faces along them. Without
 * edges it is what lines that enter and leave with the overlap bring and take along: the overlap squared times K / 2 and the
 * change of the touching part.
 */
static void what_bodies_lose_is_stored_or_lost(void) {
    uint64_t seed = UINT64_C(209);
    int compared = 0, cornered = 0;
    for (int i = 0; i < 2 * POSES; ++i) {
        random_case c;
        double room[1024];
        gm_body bodies[2];
        gm_load loads[2];
        gm_mesh_result r;
        gm_mesh *mesh;
        gm_mesh_params law;

        /* External pairs and rings; a wider wheel, so that a shift moves no end of lines. */
        gm_test_context("case %d", i);
        GM_ASSERT_INT((i % 5 == 0 ? random_ring_case_make : random_case_make)(&c, &seed, 0), GM_OK);
        c.params.pinion_face_width = c.params.face_width;
        c.params.wheel_face_width = 1.4 * c.params.face_width; /* a shift moves no end of lines */
        GM_ASSERT_INT(gm_pair_init(&c.pair, &c.params), GM_OK);

        /* Corners, damping and friction in all combinations. */
        motion_plan plan = random_plan(&c.pair, &seed, 0.0);
        plan.rate.skew = plan.rate.inclination = 0.0;
        plan.rate.axial_shift *= i % 2 == 0 ? 0.0 : 1.0;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        law.corner_contact = i % 2 == 0 ? GM_CORNER_ON : GM_CORNER_OFF;
        law.damping = i % 4 == 1 ? 1e3 : 0.0;
        law.friction_coefficient = i % 3 == 0 ? 0.1 : 0.0;

        int status = gm_mesh_init(&mesh, &law, &c.pair, NULL, NULL, room, sizeof room);
        if (status == GM_OK) {
            moving_bodies(&c.pair, &plan, bodies);
            status = gm_mesh_evaluate_bodies(mesh, &bodies[0], &bodies[1], GM_WANT_FORCE, NULL, &r,
                                             &loads[0], &loads[1]);
        }

        /* The change of the energy, by differences of two steps: not about a kink. Over the speed at which flanks roll. */
        const double rolling = c.pair.pinion.base_radius * fabs(plan.speed[0]) +
                               c.pair.wheel.base_radius * fabs(plan.speed[1]) +
                               fabs(plan.rate.center_distance_change) + fabs(plan.rate.axial_shift);
        const double size = status == GM_OK ? (r.drive_force + r.coast_force) * rolling : 0.0;
        double change[2] = {0.0, 0.0};
        for (int k = 0; k < 2 && size > 0.0; ++k) {
            const double h = (1 + k) * 2e-5 * c.pair.normal_module / rolling;
            change[k] = (energy_at(mesh, &plan, h, &status) - energy_at(mesh, &plan, -h, &status)) /
                        (2.0 * h);
        }
        const double lost = power_of(&loads[0], &bodies[0]) + power_of(&loads[1], &bodies[1]);
        if (size > 0.0 && status == GM_OK && fabs(change[1] - change[0]) < 3e-6 * size) {
            double damped = 0.0, open = 0.0;
            const gm_penetration *contact = &r.contact;
            if (contact->drive_contact > 0.0 && law.corner_contact == GM_CORNER_OFF) {
                const double approach = contact->drive_rate / contact->drive_contact;
                damped += (r.drive_force - 1e8 * contact->drive) * approach;
                open += change[0] - 1e8 * contact->drive * approach;
            }
            if (contact->coast_contact > 0.0 && law.corner_contact == GM_CORNER_OFF) {
                const double approach = contact->coast_rate / contact->coast_contact;
                damped += (r.coast_force - 1e8 * contact->coast) * approach;
                open += contact->drive_contact > 0.0 ? -1e8 * contact->coast * approach
                                                     : change[0] - 1e8 * contact->coast * approach;
            }
            GM_ASSERT_ABS(lost + change[0] + r.loss + damped - open, 0.0, 3e-6 * size);
            ++compared;
            cornered += law.corner_contact == GM_CORNER_ON;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > POSES / 2);
    GM_ASSERT(cornered > POSES / 5);
}

/*
 * Friction takes its loss and nothing else, whatever the bodies do: also as one axis moves and begins to tilt, where each
 * point slides by another speed.
 */
static void friction_takes_its_loss(void) {
    uint64_t seed = UINT64_C(208);
    int touching = 0, slow = 0;
    for (int i = 0; i < 2 * POSES; ++i) {
        random_case c;
        gm_body bodies[2];
        double power[2] = {0.0, 0.0}, loss = 0.0, force = 0.0;
        int status = GM_OK;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);

        motion_plan plan = random_plan(&c.pair, &seed, 0.0);
        if (i % 2 == 0) { /* next to the creep speed, where the movement of the axes counts */
            plan.speed[0] *= 1e-2;
            plan.speed[1] *= 1e-2;
        }
        moving_bodies(&c.pair, &plan, bodies);

        /* Power of both bodies without friction and with it. */
        for (int rubs = 0; rubs < 2; ++rubs) {
            plain_mesh room;
            gm_mesh *mesh;
            gm_mesh_params law;
            gm_load loads[2];
            gm_mesh_result r;
            gm_mesh_params_default(&law);
            law.stiffness = 1e8;
            law.friction_coefficient = 0.3 * rubs;
            law.friction_law =
                rubs && i % 3 == 2 ? GM_FRICTION_BENEDICT_KELLEY : GM_FRICTION_CONSTANT;
            law.oil_viscosity = 0.05;
            GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &c.pair, c.use[0], c.use[1], room.memory,
                                       sizeof room.memory),
                          GM_OK);

            status |= gm_mesh_evaluate_bodies(mesh, &bodies[0], &bodies[1], GM_WANT_FORCE, NULL, &r,
                                              &loads[0], &loads[1]);
            power[rubs] = power_of(&loads[0], &bodies[0]) + power_of(&loads[1], &bodies[1]);
            loss = r.loss;
            force = r.drive_force + r.coast_force;
        }

        if (status == GM_OK && force > 0.0) {
            const double size = force * (2.0 + c.pair.center_distance);
            GM_ASSERT(loss >= 0.0);
            GM_ASSERT_ABS(power[1] - power[0], -loss, 1e-12 * size);
            ++touching;
            slow += loss > 1e-6 * size && i % 2 == 0;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(touching > POSES / 2);
    GM_ASSERT(slow > POSES / 10);
}

/* ---------------------------------------------------------------------------------------------
 * A pose at every call
 * ------------------------------------------------------------------------------------------- */

static void no_pose_is_the_plain_evaluation_to_the_last_bit(void) {
    uint64_t seed = UINT64_C(205);
    for (int i = 0; i < POSES; ++i) {
        random_case c;
        plain_mesh room;
        gm_mesh_result plain, posed;
        gm_motion motion;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        const gm_mesh *mesh = mesh_of(&room, &c, 1e3);
        memset(&motion, 0, sizeof motion);
        memset(&plain, 0, sizeof plain);
        memset(&posed, 0, sizeof posed);
        const gm_state state = {c.pinion_angle, c.wheel_angle, 0.01, -0.02};
        const int wanted = i % 8;
        const int a = gm_mesh_evaluate(mesh, &state, wanted, NULL, &plain);
        (void)gm_position_from_state(&c.pair, &state, &motion.position);
        const int b = gm_mesh_evaluate_posed(mesh, &motion, wanted, NULL, &posed);
        GM_ASSERT_INT(a, b);
        GM_ASSERT(memcmp(&plain, &posed, sizeof plain) == 0);
        random_case_free(&c);
    }
}

/* Bits where the pose is that of the call alone or of the mesh alone; roundings where each has a part. */
static void a_pose_of_the_call_is_one_of_the_mesh(void) {
    uint64_t seed = UINT64_C(206);
    int compared = 0;
    for (int i = 0; i < POSES; ++i) {
        random_case c;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);

        const motion_plan plan = random_plan(&c.pair, &seed, 0.02);
        const double shared[3] = {0.0, 1.0, gm_test_uniform(&seed, 0.1, 0.9)};
        gm_mesh_result results[3];
        int status[3];
        memset(results, 0, sizeof results);

        /* All of the pose in the call, all in the mesh, and some in each. */
        for (int k = 0; k < 3; ++k) {
            const double part = shared[k], rest = 1.0 - part;
            plain_mesh room;
            gm_mesh *mesh;
            gm_mesh_params law;
            gm_motion motion;

            memset(&motion, 0, sizeof motion);
            gm_mesh_params_default(&law);
            law.stiffness = 1e8;
            law.damping = 1e3;
            law.pose = (gm_pose){part * plan.pose.center_distance_change,
                                 part * 1e-3 * c.pair.normal_module, part * plan.pose.axial_shift,
                                 part * plan.pose.skew, part * plan.pose.inclination};

            motion.pose = (gm_pose){
                rest * plan.pose.center_distance_change, rest * 1e-3 * c.pair.normal_module,
                rest * plan.pose.axial_shift, rest * plan.pose.skew, rest * plan.pose.inclination};
            const gm_state state = {plan.angle[0], plan.angle[1], plan.speed[0], plan.speed[1]};
            (void)gm_position_from_state(&c.pair, &state, &motion.position);

            status[k] = gm_mesh_init(&mesh, &law, &c.pair, c.use[0], c.use[1], room.memory,
                                     sizeof room.memory);
            if (status[k] == GM_OK) {
                status[k] = gm_mesh_evaluate_posed(
                    mesh, &motion, GM_WANT_DERIVATIVES | GM_WANT_WRENCH, NULL, &results[k]);
            }
        }

        GM_ASSERT_INT(status[0], status[1]);
        GM_ASSERT(status[0] != GM_OK || memcmp(&results[0], &results[1], sizeof results[0]) == 0);
        if (status[0] == GM_OK && status[2] == GM_OK) {
            GM_ASSERT_ABS(results[2].force, results[0].force, 1e8 * 1e-13 * c.pair.center_distance);
            compared += results[0].force != 0.0;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > POSES / 4);
}

/*
 * Elastic teeth in a pose of the call and in one of the mesh: the same but for the compliance, which is prepared where the
 * mesh is. Loads on bodies balance, and teeth do not bend in a way that a workspace would not allow.
 */
static void elastic_teeth_follow_a_pose_too(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_pose pose = {10e-6, 0.0, 20e-6, 1e-4, -1e-4};
    double forces[2];
    for (int of_mesh = 0; of_mesh < 2; ++of_mesh) {
        gm_mesh_params law;
        gm_mesh *mesh;
        gm_workspace *workspace;
        gm_mesh_result r;
        gm_motion motion;

        /* The pose stands in the mesh, or comes with the call. */
        gm_mesh_params_default(&law);
        law.law = GM_LAW_ELASTIC;
        memset(&motion, 0, sizeof motion);
        *(of_mesh ? &law.pose : &motion.pose) = pose;

        const size_t size = gm_mesh_size(&law, &pair);
        void *memory = malloc(size);
        GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, size), GM_OK);
        const size_t room = gm_workspace_size(mesh);
        void *work = malloc(room);
        GM_ASSERT_INT(gm_workspace_init(&workspace, mesh, work, room), GM_OK);

        /* The same force, and none without a workspace. */
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.02, 0.5 * pair.backlash + 12e-6, 0.0,
                                                    &motion.position),
                      GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, GM_WANT_FORCE, workspace, &r), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, GM_WANT_FORCE, NULL, &r), GM_ERR_NULL);
        GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, GM_WANT_FORCE, workspace, &r), GM_OK);
        forces[of_mesh] = r.force;

        /* And moving, between bodies. */
        if (!of_mesh) {
            uint64_t seed = UINT64_C(208);
            gm_body bodies[2];
            gm_load loads[2];
            gm_tangent tangent;
            motion_plan plan = random_plan(&pair, &seed, 0.0);
            plan.pose = pose;
            plan.angle[1] =
                (pair.pinion.base_radius * plan.angle[0] - 0.5 * pair.backlash - 12e-6) /
                pair.wheel.base_radius;
            moving_bodies(&pair, &plan, bodies);
            GM_ASSERT_INT(gm_mesh_evaluate_bodies(mesh, &bodies[0], &bodies[1], GM_WANT_FORCE,
                                                  workspace, &r, &loads[0], &loads[1]),
                          GM_OK);
            double moment[3] = {0.0, 0.0, 0.0};
            add_moment(&loads[0], bodies[0].position, moment);
            add_moment(&loads[1], bodies[1].position, moment);
            for (int k = 0; k < 3; ++k) {
                GM_ASSERT_ABS(loads[0].force[k] + loads[1].force[k], 0.0, 1e-13 * fabs(r.force));
                GM_ASSERT_ABS(moment[k], 0.0, 1e-12 * fabs(r.force));
            }
            GM_ASSERT(r.force > 0.0);
            GM_ASSERT_INT(gm_mesh_tangent(mesh, &motion, &tangent), GM_ERR_PARAMETER);
            GM_ASSERT_NAN(tangent.force_by[0]);
        }
        free(work);
        free(memory);
    }
    GM_ASSERT(forces[0] > 0.0);
    GM_ASSERT_REL(forces[0], forces[1], 0.01);
}

static void what_cannot_be_is_refused(void) {
    uint64_t seed = UINT64_C(207);
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    plain_mesh room;
    gm_mesh *mesh;
    GM_ASSERT_INT(plain_mesh_make(&room, &pair, NULL, NULL, 1e8, 1e3, &mesh), GM_OK);

    motion_plan plan = random_plan(&pair, &seed, 0.0);
    plan.angle[1] = pair.pinion.base_radius * plan.angle[0] / pair.wheel.base_radius;
    plan.pose.center_distance_change = plan.pose.axial_shift = 0.0;
    gm_body good[2];
    moving_bodies(&pair, &plan, good);

    static const struct {
        int body, field, status;
        double value;
    } wrong[] = {
        {0, 0, GM_STATE_NOT_FINITE, NAN},     {1, 2, GM_STATE_NOT_FINITE, HUGE_VAL},
        {0, 3, GM_STATE_NOT_FINITE, NAN},     {1, 11, GM_STATE_NOT_FINITE, -HUGE_VAL},
        {0, 12, GM_STATE_NOT_FINITE, NAN},    {1, 17, GM_STATE_NOT_FINITE, NAN},
        {0, 3, GM_STATE_OUT_OF_RANGE, 2.0},   {1, 7, GM_STATE_OUT_OF_RANGE, -2.0},
        {1, 12, GM_STATE_OUT_OF_RANGE, 1e10}, {1, 15, GM_STATE_OUT_OF_RANGE, 1e10},
        {1, 0, GM_POSE_OUT_OF_MESH, 1e3},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; ++k) {
        gm_body bodies[2] = {good[0], good[1]};
        gm_load loads[2];
        gm_mesh_result r;
        gm_motion motion;
        gm_test_context("value %d", (int)k);
        ((double *)&bodies[wrong[k].body])[wrong[k].field] = wrong[k].value;

        GM_ASSERT_INT(gm_mesh_evaluate_bodies(mesh, &bodies[0], &bodies[1], GM_WANT_FORCE, NULL, &r,
                                              &loads[0], &loads[1]),
                      wrong[k].status);

        GM_ASSERT_NAN(r.force);
        GM_ASSERT_NAN(r.wrench.wheel_moment[2]);
        GM_ASSERT_NAN(loads[0].force[0]);
        GM_ASSERT_NAN(loads[1].moment[2]);

        if (wrong[k].status == GM_STATE_NOT_FINITE) {
            GM_ASSERT_INT(gm_motion_of_bodies(mesh, &bodies[0], &bodies[1], &motion, NULL),
                          GM_STATE_NOT_FINITE);
            GM_ASSERT_NAN(motion.position.offset);
            GM_ASSERT_NAN(motion.pose.skew);
        }
    }

    /* On one axis, and turned upside down. */
    gm_body bodies[2] = {good[0], good[1]};
    gm_load loads[2];
    gm_mesh_result r;
    memcpy(bodies[1].position, bodies[0].position, sizeof bodies[0].position);
    GM_ASSERT_INT(gm_mesh_evaluate_bodies(mesh, &bodies[0], &bodies[1], GM_WANT_FORCE, NULL, &r,
                                          &loads[0], &loads[1]),
                  GM_POSE_OUT_OF_MESH);
    bodies[1] = good[1];
    for (int k = 0; k < 3; ++k) {
        bodies[1].rotation[3 * k + 1] = -bodies[1].rotation[3 * k + 1];
        bodies[1].rotation[3 * k + 2] = -bodies[1].rotation[3 * k + 2];
    }
    GM_ASSERT_INT(gm_mesh_evaluate_bodies(mesh, &bodies[0], &bodies[1], GM_WANT_FORCE, NULL, &r,
                                          &loads[0], &loads[1]),
                  GM_POSE_OUT_OF_MESH);

    /* Nothing where something must be. */
    gm_motion motion;
    memset(&motion, 0, sizeof motion);
    GM_ASSERT_INT(
        gm_mesh_evaluate_bodies(NULL, &good[0], &good[1], 0, NULL, &r, &loads[0], &loads[1]),
        GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_evaluate_bodies(mesh, &good[0], &good[1], 0, NULL, &r, &loads[0], NULL),
                  GM_ERR_NULL);
    GM_ASSERT_INT(gm_motion_of_bodies(mesh, NULL, &good[1], &motion, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_motion_of_bodies(mesh, &good[0], &good[1], NULL, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, NULL, 0, NULL, &r), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, 0, NULL, NULL), GM_ERR_NULL);

    /* Poses and rates that are none. */
    memset(&motion, 0, sizeof motion);
    motion.pose.skew = (double)NAN;
    GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, 0, NULL, &r), GM_STATE_NOT_FINITE);
    motion.pose.skew = 0.1;
    GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, 0, NULL, &r), GM_POSE_OUT_OF_MESH);
    motion.pose.skew = 0.0;
    motion.pose_rate.offset = (double)NAN;
    GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, 0, NULL, &r), GM_STATE_NOT_FINITE);
    motion.pose_rate.offset = 1.1e9;
    GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, 0, NULL, &r), GM_STATE_OUT_OF_RANGE);
    motion.pose_rate.offset = 1.0;
    GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, 16, NULL, &r), GM_ERR_PARAMETER);
    motion.position.offset = 0.6 * pair.transverse_base_pitch;
    GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, 0, NULL, &r), GM_STATE_OUT_OF_RANGE);
    GM_ASSERT_NAN(r.force);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(motion_is_the_one_that_bodies_were_built_from),
        GM_TEST(any_teeth_may_meet),
        GM_TEST(an_axial_shift_counts_in_which_teeth_meet),
        GM_TEST(loads_are_in_balance_and_turn_with_the_frame),
        GM_TEST(power_is_force_times_speed_of_approach),
        GM_TEST(what_bodies_lose_is_stored_or_lost),
        GM_TEST(friction_takes_its_loss),
        GM_TEST(no_pose_is_the_plain_evaluation_to_the_last_bit),
        GM_TEST(a_pose_of_the_call_is_one_of_the_mesh),
        GM_TEST(elastic_teeth_follow_a_pose_too),
        GM_TEST(what_cannot_be_is_refused),
    };
    return gm_test_main("unit.body", tests, GM_TEST_COUNT(tests), argc, argv);
}
