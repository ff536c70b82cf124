/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Forces and moments on both gears. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "random_gears.h"
#include "reference_gear.h"

static void cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/** Force and moment of one side on the wheel, from the line integrals of the second model. */
static void add_expected_side(const random_case *c, const model_result *m, int side,
                              double stiffness, double damping, double speed, gm_wrench *w) {
    const int s = side == 0 ? 1 : -1;
    const double approach = s * speed;
    /* Spread over the line: K delta + D v where it touches. Its integral, and that of t1 and rho. */
    const double force =
        stiffness * (double)m->sum[side] + damping * approach * (double)m->contact[side];
    if (force <= 0.0) {
        return;
    }
    const double t1 =
        (stiffness * (double)m->sum_t1[side] + damping * approach * (double)m->contact_t1[side]) /
        force;
    const double rho =
        (stiffness * (double)m->sum_rho[side] + damping * approach * (double)m->contact_rho[side]) /
        force;
    const double cos_w = cos((double)c->model.alpha_wt);
    const double sin_w = sin((double)c->model.alpha_wt);
    const double r_bp = (double)c->model.base_radius[0];
    const double d = c->model.is_ring ? -c->params.center_distance : c->params.center_distance;
    /* From the pinion's base tangent point along the line of action; axial part by the base helix. */
    const double along[3] = {sin_w, s * cos_w, -s * (double)tanl(c->model.beta_b)};
    const double point[3] = {r_bp * cos_w + rho * sin_w, -s * r_bp * sin_w + s * rho * cos_w,
                             t1 * c->params.face_width};
    const double from_wheel[3] = {point[0] - d, point[1], point[2]};
    double on_wheel[3];
    double on_pinion[3];
    cross(from_wheel, along, on_wheel);
    cross(point, along, on_pinion);
    for (int k = 0; k < 3; ++k) {
        w->wheel_force[k] += force * along[k];
        w->pinion_force[k] -= force * along[k];
        w->wheel_moment[k] += force * on_wheel[k];
        w->pinion_moment[k] -= force * on_pinion[k];
    }
}

static void each_line_of_contact_pushes_where_it_is(void) {
    uint64_t seed = UINT64_C(41);
    int touching = 0;
    int both = 0;
    for (int i = 0; i < 800; ++i) {
        random_case c;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        const double stiffness = 1e8;
        const double damping = i % 3 == 0 ? 0.0 : 1e3;
        gm_state state = {.pinion_angle = c.pinion_angle, .wheel_angle = c.wheel_angle};
        /* Slow enough that nothing pulls but at grazing contact. */
        state.pinion_speed = gm_test_uniform(&seed, -0.01, 0.01) * c.params.normal_module /
                             (double)c.model.base_radius[0];
        const double speed = (double)c.model.base_radius[0] * state.pinion_speed;

        /* The library. */
        gm_position position;
        gm_penetration r;
        gm_wrench got;
        GM_ASSERT_INT(gm_position_from_state(&c.pair, &state, &position), GM_OK);
        GM_ASSERT_INT(penetration_3d_at(&c.pair, c.use[0], c.use[1], &position, &r), GM_OK);
        GM_ASSERT_INT(
            wrench_3d_at(&c.pair, c.use[0], c.use[1], &position, stiffness, damping, &got), GM_OK);

        /* The sum over the lines of the reference model. */
        model_result m;
        model_evaluate(&c.model, c.model_use[0], c.model_use[1], c.pinion_angle, c.wheel_angle,
                       0.0L, 0.0L, &m);
        gm_wrench expected;
        memset(&expected, 0, sizeof expected);
        add_expected_side(&c, &m, 0, stiffness, damping, speed, &expected);
        add_expected_side(&c, &m, 1, stiffness, damping, speed, &expected);

        touching += r.drive_pairs + r.coast_pairs > 0;
        both += r.drive_pairs > 0 && r.coast_pairs > 0;

        /* Near an engagement of a (nearly) spur gear a rounding moves a whole pair: not here. */
        const double longest = c.params.center_distance + (double)c.model.base_radius[1];
        const double e = 4.0 * 0x1p-53 * longest;
        const int certain = fabs((double)c.model.face_advance) > 1e-3 * c.params.normal_module;
        /* Forces are K times lengths that are certain to e, and 1e-10 relative. */
        const double scale = stiffness * (double)(m.sum[0] + m.sum[1]) +
                             damping * fabs(speed) * (double)(m.contact[0] + m.contact[1]);
        const double force = 1e-10 * scale + 4.0 * stiffness * e +
                             2.0 * damping * fabs(speed) * e / fabs((double)c.model.face_advance);
        const double arm = 2.0 * longest + c.params.face_width;
        int good = 1;
        for (int k = 0; k < 3 && certain; ++k) {
            good &= GM_ASSERT_ABS(got.wheel_force[k], expected.wheel_force[k], 2.0 * force);
            good &= GM_ASSERT_ABS(got.pinion_force[k], expected.pinion_force[k], 2.0 * force);
            good &= GM_ASSERT_ABS(got.wheel_moment[k], expected.wheel_moment[k], 2.0 * force * arm);
            good &=
                GM_ASSERT_ABS(got.pinion_moment[k], expected.pinion_moment[k], 2.0 * force * arm);
        }

        /* Reaction equals action: the force, and the moment about the pinion's axis point. */
        const double rounding = 32.0 * 0x1p-53 * scale;
        const double sign = c.model.is_ring ? -1.0 : 1.0;
        const double arms[3] = {sign * c.params.center_distance, 0.0, 0.0};
        double moved[3];
        cross(arms, got.wheel_force, moved);
        for (int k = 0; k < 3; ++k) {
            good &= GM_ASSERT_ABS(got.pinion_force[k] + got.wheel_force[k], 0.0, rounding);
            good &= GM_ASSERT_ABS(got.pinion_moment[k] + got.wheel_moment[k] + moved[k], 0.0,
                                  rounding * arm);
        }

        /* Torques about the axes are those of the equations of motion [Paper, Eqs. 1-2, base
         * radii]: -F r_bp against +phi_p; +F r_bw along +phi_w, which is clockwise but of a ring. */
        gm_mesh_result whole;
        good &= GM_ASSERT_INT(plain_evaluate(&c.pair, c.use[0], c.use[1], &position, stiffness,
                                             damping, GM_WANT_FORCE, &whole),
                              GM_OK);
        const double net = whole.force;
        good &= GM_ASSERT_ABS(got.pinion_moment[2], -net * (double)c.model.base_radius[0],
                              rounding * arm);
        const double along_wheel = -sign * got.wheel_moment[2];
        good &= GM_ASSERT_ABS(along_wheel, net * (double)c.model.base_radius[1], rounding * arm);
        /* Axial force F tan(beta_b). */
        good &=
            GM_ASSERT_ABS(got.pinion_force[2], net * (double)tanl(c.model.beta_b), rounding * 4.0);
        /* Power on both gears: -F dx/dt, what springs store and dampers lose. */
        const double power =
            got.pinion_moment[2] * state.pinion_speed + along_wheel * state.wheel_speed;
        good &= GM_ASSERT_ABS(power, -net * speed, rounding * arm * fabs(state.pinion_speed));
        random_case_free(&c);
        if (!good) {
            return;
        }
    }
    gm_test_context("all cases");
    GM_ASSERT(touching > 500);
    GM_ASSERT(both > 8);
}

static void right_handed_driving_pinion_is_pushed_along_z(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH); /* beta = 33 deg */
    gm_position position;
    gm_wrench w;
    GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.05, 55e-6, 0.0, &position), GM_OK);
    GM_ASSERT_INT(wrench_3d_at(&pair, NULL, NULL, &position, REFERENCE_STIFFNESS, 0.0, &w), GM_OK);
    GM_ASSERT(w.pinion_force[2] > 0.0);
    GM_ASSERT(w.wheel_force[2] < 0.0);
    /* The teeth push the gears apart, the wheel's contact side up (+y), the wheel clockwise. */
    GM_ASSERT(w.wheel_force[0] > 0.0);
    GM_ASSERT(w.wheel_force[1] > 0.0);
    GM_ASSERT(w.wheel_moment[2] < 0.0);
    GM_ASSERT(w.pinion_moment[2] < 0.0);
    /* Coast: still apart, all else reversed. */
    GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.05, -55e-6, 0.0, &position), GM_OK);
    GM_ASSERT_INT(wrench_3d_at(&pair, NULL, NULL, &position, REFERENCE_STIFFNESS, 0.0, &w), GM_OK);
    GM_ASSERT(w.pinion_force[2] < 0.0);
    GM_ASSERT(w.wheel_force[0] > 0.0);
    GM_ASSERT(w.wheel_force[1] < 0.0);
    GM_ASSERT(w.wheel_moment[2] > 0.0);
}

/* A spur gear touches over the whole width: no axial force, force at mid-face. */
static void spur_wrench_acts_at_mid_face(void) {
    const gm_pair pair = spur_pair();
    gm_position position;
    gm_wrench w;
    GM_ASSERT_INT(
        gm_position_from_pinion_angle(&pair, 0.02, pair.backlash / 2 + 5e-6, 0.0, &position),
        GM_OK);
    GM_ASSERT_INT(wrench_3d_at(&pair, NULL, NULL, &position, 1e8, 0.0, &w), GM_OK);
    GM_ASSERT_ABS(w.pinion_force[2], 0.0, 0.0);
    GM_ASSERT_REL(w.pinion_moment[0], -pair.face_width / 2 * w.pinion_force[1], 1e-13);
    GM_ASSERT_REL(w.pinion_moment[1], pair.face_width / 2 * w.pinion_force[0], 1e-13);
}

enum { FACE_MM = 20, BEGIN_MM = 2, WIDE_MM = FACE_MM + 2 * BEGIN_MM, PROFILE_NODES = 4 };

/* One table for all teeth and both sides, in static memory; rows of PROFILE_NODES. */
static gm_flanks *flanks_of(int place, int teeth, int face_nodes, const double *values) {
    static double memory[3][2000];
    const gm_flanks_params sizes = {teeth, 1,          face_nodes,   PROFILE_NODES,
                                    1,     face_nodes, PROFILE_NODES};
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory[place], sizeof memory[place]), GM_OK);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        GM_ASSERT_INT(gm_flanks_set_table(flanks, side, GM_ALL_TEETH, values, 1.0), GM_OK);
    }
    return flanks;
}

/*
 * A wider pinion that begins earlier moves z = 0 away from the common face, and with it the point of the moments. Its
 * table has a row per mm, so that the narrow pinion has rows of it; the wheel's has one per 2 mm.
 */
static void the_common_face_may_begin_later(void) {
    gm_pair_params params = reference_params((double)NAN);
    const double begin = BEGIN_MM * 1e-3;

    /* The same gears with a pinion that begins before the wheel's face, and with one that ends with it. */
    params.wheel_face_width = FACE_MM * 1e-3;
    params.pinion_face_width = WIDE_MM * 1e-3;
    const gm_pair wide = make_pair(&params);
    params.pinion_face_width = FACE_MM * 1e-3;
    const gm_pair narrow = make_pair(&params);
    GM_ASSERT_ABS(wide.face_start, begin, 1e-17);
    const double turned = begin * tan(narrow.base_helix_angle);

    uint64_t seed = UINT64_C(46);
    double values[(WIDE_MM + 1) * PROFILE_NODES], wheel_values[(FACE_MM / 2 + 1) * PROFILE_NODES];
    for (int k = 0; k < (WIDE_MM + 1) * PROFILE_NODES; ++k) {
        values[k] = gm_test_uniform(&seed, -3e-6, 3e-6);
    }
    for (int k = 0; k < (FACE_MM / 2 + 1) * PROFILE_NODES; ++k) {
        wheel_values[k] = gm_test_uniform(&seed, -3e-6, 3e-6);
    }

    const gm_flanks *wide_flanks = flanks_of(0, 45, WIDE_MM + 1, values);
    const gm_flanks *narrow_flanks =
        flanks_of(1, 45, FACE_MM + 1, values + BEGIN_MM * PROFILE_NODES);
    const gm_flanks *wheel_flanks = flanks_of(2, 41, FACE_MM / 2 + 1, wheel_values);

    for (int i = 0; i < 80; ++i) {
        gm_test_context("position %d", i);
        const int with_pinion = i / 20 % 2, with_wheel = i / 40;
        const gm_flanks *wheel = with_wheel ? wheel_flanks : NULL;
        gm_position of_wide, of_narrow;
        gm_wrench got, same;

        const double angle = 0.07 * i;
        const double x = i % 2 ? 60e-6 : -60e-6;
        GM_ASSERT_INT(gm_position_from_pinion_angle(&wide, angle, x, 0.0, &of_wide), GM_OK);
        GM_ASSERT_INT(gm_position_from_pinion_angle(
                          &narrow, angle + turned / narrow.pinion.base_radius, x, 0.0, &of_narrow),
                      GM_OK);

        GM_ASSERT_INT(
            wrench_3d_at(&wide, with_pinion ? wide_flanks : NULL, wheel, &of_wide, 1e8, 0.0, &got),
            GM_OK);
        GM_ASSERT_INT(wrench_3d_at(&narrow, with_pinion ? narrow_flanks : NULL, wheel, &of_narrow,
                                   1e8, 0.0, &same),
                      GM_OK);

        /* About a point that lies `begin` lower: plus begin e_z cross force. */
        const double on_wheel[3] = {same.wheel_moment[0] - begin * same.wheel_force[1],
                                    same.wheel_moment[1] + begin * same.wheel_force[0],
                                    same.wheel_moment[2]};
        const double on_pinion[3] = {same.pinion_moment[0] - begin * same.pinion_force[1],
                                     same.pinion_moment[1] + begin * same.pinion_force[0],
                                     same.pinion_moment[2]};

        GM_ASSERT(fabs(same.wheel_force[1]) > 100.0);
        for (int k = 0; k < 3; ++k) {
            /* The origin of the lines is certain to some 1e-17 m of the face's 12 mm on the line of action. */
            GM_ASSERT_ABS(got.wheel_force[k], same.wheel_force[k], 1e-8);
            GM_ASSERT_ABS(got.wheel_moment[k], on_wheel[k], 1e-9);
            GM_ASSERT_ABS(got.pinion_moment[k], on_pinion[k], 1e-9);
        }
    }
}

/* Per flank max(0, K p + D rate): a side that parts fast gives nothing, the other all the same. */
static void teeth_do_not_pull(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.backlash = -20e-6; /* both sides touch */
    const gm_pair pair = make_pair(&params);
    for (int s = -1; s <= 1; s += 2) {
        gm_test_context("dx/dt = %d m/s", s);
        gm_position position;
        gm_penetration r;
        gm_wrench w;
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.1, 1e-6, s, &position), GM_OK);
        GM_ASSERT_INT(penetration_3d_at(&pair, NULL, NULL, &position, &r), GM_OK);
        GM_ASSERT_INT(wrench_3d_at(&pair, NULL, NULL, &position, 1e8, 1e6, &w), GM_OK);
        const double touching = s > 0 ? r.drive_contact : r.coast_contact;
        const double pressed = s > 0 ? r.drive : r.coast;
        const double force = 1e8 * pressed + 1e6 * touching;
        GM_ASSERT_REL(-w.pinion_moment[2] / pair.pinion.base_radius, s * force, 1e-12);
        /* Pushed apart by one side alone. */
        GM_ASSERT_REL(w.wheel_force[0], force * sin(pair.working_pressure_angle), 1e-12);
    }
}

static void null_pointers_are_refused(void) {
    const gm_pair pair = spur_pair();
    gm_position position;
    gm_wrench w;
    GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.1, 0.0, 0.0, &position), GM_OK);
    GM_ASSERT_INT(wrench_3d_at(&pair, NULL, NULL, &position, 1e8, 0.0, NULL), GM_ERR_NULL);
    for (int k = 0; k < 2; ++k) {
        memset(&w, 0, sizeof w);
        GM_ASSERT_INT(wrench_3d_at(k == 0 ? NULL : &pair, NULL, NULL, k == 0 ? &position : NULL,
                                   1e8, 0.0, &w),
                      GM_ERR_NULL);
        for (int i = 0; i < 3; ++i) {
            GM_ASSERT_NAN(w.pinion_force[i]);
            GM_ASSERT_NAN(w.pinion_moment[i]);
            GM_ASSERT_NAN(w.wheel_force[i]);
            GM_ASSERT_NAN(w.wheel_moment[i]);
        }
    }
}

static void absurd_stiffness_and_damping_are_refused(void) {
    const gm_pair pair = spur_pair();
    gm_position position;
    gm_wrench w;
    GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.1, 40e-6, 0.0, &position), GM_OK);
    static const double bad[] = {NAN, HUGE_VAL, -HUGE_VAL, 1.01e30, -1e-30};
    for (size_t k = 0; k < 2 * sizeof bad / sizeof bad[0]; ++k) {
        gm_test_context("%g, case %zu", bad[k / 2], k % 2);
        memset(&w, 0, sizeof w);
        GM_ASSERT_INT(wrench_3d_at(&pair, NULL, NULL, &position, k % 2 ? bad[k / 2] : 1e8,
                                   k % 2 ? 0.0 : bad[k / 2], &w),
                      GM_ERR_PARAMETER);
        for (int i = 0; i < 3; ++i) {
            GM_ASSERT_NAN(w.pinion_force[i]);
            GM_ASSERT_NAN(w.wheel_moment[i]);
        }
    }
    GM_ASSERT_INT(wrench_3d_at(&pair, NULL, NULL, &position, 1e30, 1e30, &w), GM_OK);
    GM_ASSERT(isfinite(w.wheel_moment[2]));
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(each_line_of_contact_pushes_where_it_is),
        GM_TEST(right_handed_driving_pinion_is_pushed_along_z),
        GM_TEST(spur_wrench_acts_at_mid_face),
        GM_TEST(the_common_face_may_begin_later),
        GM_TEST(teeth_do_not_pull),
        GM_TEST(null_pointers_are_refused),
        GM_TEST(absurd_stiffness_and_damping_are_refused),
    };
    return gm_test_main("unit.wrench", tests, GM_TEST_COUNT(tests), argc, argv);
}
