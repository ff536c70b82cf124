/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Force law, its gradient, and what follows from it for the whole mesh; the simple model. */
#include "contact.h" /* the law by itself */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "law.h"
#include "random_gears.h"
#include "reference_gear.h"

static void force_is_stiffness_and_damping_of_a_side(void) {
    /* Chosen by hand: sums of powers of two, so that every product is exact. */
    const gmi_law law = {8.0, 16.0, 8.0};
    const gmi_side_sum sum = {.sum = 4.0,
                              .contact = 2.0,
                              .by_origin = 0.5,
                              .by_delta = 3.0,
                              .contact_by_origin = 0.25,
                              .contact_by_delta = -0.5,
                              .sum_t1 = 1.0,
                              .sum_rho = 2.0,
                              .contact_t1 = 0.5,
                              .contact_rho = 4.0};
    enum { ALL = GMI_DERIVATIVES | GMI_CONTACT_DERIVATIVES | GMI_MOMENTS };
    gmi_side_force f;
    gmi_law_force(&law, &sum, 0.25, ALL, &f);
    GM_ASSERT_ABS(f.force, 8.0 * 4.0 + 16.0 * 0.25 * 2.0, 0.0);
    GM_ASSERT_ABS(f.by_origin, 8.0 * 0.5 + 16.0 * 0.25 * 0.25, 0.0);
    GM_ASSERT_ABS(f.by_delta, 8.0 * 3.0 - 16.0 * 0.25 * 0.5, 0.0);
    GM_ASSERT_ABS(f.by_speed, 16.0 * 2.0, 0.0);
    GM_ASSERT_ABS(f.force_t1, 8.0 * 1.0 + 4.0 * 0.5, 0.0);
    GM_ASSERT_ABS(f.force_rho, 8.0 * 2.0 + 4.0 * 4.0, 0.0);

    /* Parting so fast that damping would pull: no force, no gradient, no moment. */
    gmi_law_force(&law, &sum, -1.5, ALL, &f);
    const gmi_side_force none = {.force = 0.0};
    GM_ASSERT(memcmp(&f, &none, sizeof f) == 0);

    /* Just not: what is left of the force, and its whole gradient. */
    gmi_law_force(&law, &sum, -0.75, ALL, &f);
    GM_ASSERT_ABS(f.force, 32.0 - 24.0, 0.0);
    GM_ASSERT_ABS(f.by_delta, 24.0 + 6.0, 0.0);
    GM_ASSERT_ABS(f.by_speed, 32.0, 0.0);
}

/* Both sides, and each by itself: net = drive - coast. */
static void force_of_a_mesh_is_that_of_its_sides(void) {
    uint64_t seed = UINT64_C(61);
    for (int i = 0; i < 300; ++i) {
        random_case c;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        const gm_state state = {c.pinion_angle, c.wheel_angle, gm_test_uniform(&seed, -1.0, 1.0),
                                0.0};
        gm_position position;
        gm_mesh_result r;
        GM_ASSERT_INT(gm_position_from_state(&c.pair, &state, &position), GM_OK);
        GM_ASSERT_INT(
            plain_evaluate(&c.pair, c.use[0], c.use[1], &position, 1e8, 1e3, GM_WANT_FORCE, &r),
            GM_OK);
        const double drive = fmax(0.0, 1e8 * r.contact.drive + 1e3 * r.contact.drive_rate);
        const double coast = fmax(0.0, 1e8 * r.contact.coast + 1e3 * r.contact.coast_rate);
        GM_ASSERT_REL(r.drive_force, drive, 4e-16);
        GM_ASSERT_REL(r.coast_force, coast, 4e-16);
        GM_ASSERT_ABS(r.force, drive - coast, 4e-16 * (drive + coast));
        random_case_free(&c);
    }
}

/* F at a state moved by h along one of angles and speeds. */
static double moved_force(const random_case *c, gm_mesh *mesh, gm_state state, int which,
                          double h) {
    double *const coordinate[] = {&state.pinion_angle, &state.wheel_angle, &state.pinion_speed,
                                  &state.wheel_speed};
    gm_mesh_result r;
    (void)c;
    *coordinate[which] += h;
    GM_ASSERT_INT(gm_mesh_evaluate(mesh, &state, GM_WANT_FORCE, NULL, &r), GM_OK);
    return r.force;
}

/*
 * The gradient of the force, damping and the size of the touching part included, against central differences. At a kink
 * (a line that enters, a root that merges) the two one-sided differences disagree: such states are left out, and counted.
 */
static void gradient_of_the_force_is_that_of_differences(void) {
    uint64_t seed = UINT64_C(62);
    int compared = 0, kinks = 0, damped = 0;
    for (int i = 0; i < 600; ++i) {
        random_case c;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        const double r_bp = c.pair.pinion.base_radius;
        const double stiffness = 1e8;

        /* Damping and speed so that the viscous part is of the size of the elastic one. */
        const double damping = i % 3 == 0 ? 0.0 : 1e4;
        const double reach = stiffness * 1e-3 * c.params.normal_module / 1e4;
        const gm_state state = {c.pinion_angle -
                                    floor(c.pinion_angle), /* small: angles cost digits */
                                0.0, gm_test_uniform(&seed, -0.5, 1.0) * reach / r_bp, 0.0};

        gm_state placed = state;
        placed.wheel_angle = c.wheel_angle + c.pair.pinion.base_radius / c.pair.wheel.base_radius *
                                                 (state.pinion_angle - c.pinion_angle);

        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_result r;
        GM_ASSERT_INT(
            plain_mesh_make(&room, &c.pair, c.use[0], c.use[1], stiffness, damping, &mesh), GM_OK);
        const int status = gm_mesh_evaluate(mesh, &placed, GM_WANT_DERIVATIVES, NULL, &r);
        if (status != GM_OK || !(fabs(r.force) > 0.0) || fabs(c.pinion_angle) > 100.0) {
            random_case_free(&c);
            continue;
        }

        const double exact[] = {r.force_by.pinion_angle, r.force_by.wheel_angle,
                                r.force_by.pinion_speed, r.force_by.wheel_speed};

        /* One-sided differences, which agree where nothing begins to touch between. */
        for (int which = 0; which < 4; ++which) {
            const double scale =
                which < 2 ? 1e-7 * c.params.normal_module / r_bp * 100.0 : 1e-4 * reach / r_bp;
            const double ahead = moved_force(&c, mesh, placed, which, scale);
            const double behind = moved_force(&c, mesh, placed, which, -scale);
            const double forward = (ahead - r.force) / scale;
            const double backward = (r.force - behind) / scale;

            const double size = fabs(exact[which]) + stiffness * (which < 2 ? r_bp : 0.0);
            if (fabs(forward - backward) > 1e-4 * size) {
                ++kinks;
                continue;
            }
            ++compared;
            damped += damping > 0.0 && which < 2;
            GM_ASSERT_ABS(0.5 * (forward + backward), exact[which], 1e-4 * size);
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 1000);
    GM_ASSERT(damped > 300);
    GM_ASSERT(kinks < compared / 4);
}

/*
 * How the touching part moves with the flanks: K is next to nothing here, so that the force of the side that is approached
 * is D v contact, and its derivatives are those of the contact of the second model, whose differences in long double are
 * exact to 1e-8. At a kink (a line that enters, a root that merges) the one-sided differences disagree: left out, and
 * counted.
 */
static void touching_part_moves_as_in_the_second_model(void) {
    uint64_t seed = UINT64_C(63);
    int compared = 0, kinks = 0, by_flanks = 0;
    for (int i = 0; i < 4000; ++i) {
        random_case c;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        const double r_bp = c.pair.pinion.base_radius, r_bw = c.pair.wheel.base_radius;
        const int side = i % 3 == 0 ? GM_COAST : GM_DRIVE;
        const double approach = side == GM_DRIVE ? 1.0 : -1.0;
        const gm_state state = {c.pinion_angle, c.wheel_angle, approach / r_bp, 0.0};

        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_result r;
        GM_ASSERT_INT(plain_mesh_make(&room, &c.pair, c.use[0], c.use[1], 1e-30, 1.0, &mesh),
                      GM_OK);
        const int status = gm_mesh_evaluate(mesh, &state, GM_WANT_DERIVATIVES, NULL, &r);
        const double contact = side == GM_DRIVE ? r.contact.drive_contact : r.contact.coast_contact;
        const int is_spur = fabs((double)c.model.face_advance) < 1e-3 * c.params.normal_module;
        if (status != GM_OK || !(contact > 0.0) || is_spur || fabs(c.pinion_angle) > 10.0) {
            random_case_free(&c);
            continue;
        }

        /* By x alone, as the wheel turns; and by the phase alone, as both gears roll. */
        const double by_offset = -r.force_by.wheel_angle / r_bw;
        const double by_phase = (r.force_by.pinion_angle - r_bp * by_offset) / r_bp;
        for (int rolls = 0; rolls < 2; ++rolls) {
            const long double h = 1e-7L * c.params.normal_module;
            long double moved[3];
            for (int k = 0; k < 3; ++k) {
                model_result m;
                const long double step = (k - 1) * h;
                const long double pinion =
                    c.pinion_angle + (rolls ? step / c.model.base_radius[0] : 0.0L);
                const long double wheel =
                    c.wheel_angle + (rolls ? step : -step) / c.model.base_radius[1];
                model_evaluate(&c.model, c.model_use[0], c.model_use[1], pinion, wheel, 0.0L, 0.0L,
                               &m);
                moved[k] = m.contact[side];
            }
            const double exact = approach * (rolls ? by_phase : by_offset);
            const double forward = (double)((moved[2] - moved[1]) / h);
            const double backward = (double)((moved[1] - moved[0]) / h);
            const double size = fabs(exact) + fabs(by_offset);
            if (fabs(forward - backward) > 1e-3 * size) {
                ++kinks;
                continue;
            }
            ++compared;
            by_flanks += rolls && c.amplitude > 0.0 && exact != 0.0;
            GM_ASSERT_ABS(0.5 * (forward + backward), exact,
                          1e-5 * size + 1e-6 / c.params.normal_module);
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 1000);
    GM_ASSERT(by_flanks > 200);
    GM_ASSERT(kinks < compared / 4);
}

/* [Paper, Eqs. 9-11] with |x| in Eq. 10 */
static void simple_model_is_a_spring_with_backlash(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double half = pair.backlash / 2;
    const double speed = 0.125;
    static const double offsets[] = {-80e-6, -50.1e-6, -49e-6, 0.0, 49e-6, 50.1e-6, 80e-6, 1e-2};
    for (size_t i = 0; i < sizeof offsets / sizeof offsets[0]; ++i) {
        const double x = offsets[i];
        gm_test_context("x = %g", x);
        gm_penetration r;
        GM_ASSERT_INT(penetration_simple_at(&pair, x, speed, &r), GM_OK);

        /* Beyond half of the backlash to either side. */
        const int drive = x > half;
        const int coast = x < -half;
        GM_ASSERT_REL(r.drive, drive ? x - half : 0.0, 1e-15);
        GM_ASSERT_REL(r.coast, coast ? -x - half : 0.0, 1e-15);
        GM_ASSERT_REL(r.penetration, r.drive - r.coast, 0.0);
        GM_ASSERT_REL(r.drive_rate, drive ? speed : 0.0, 0.0);
        GM_ASSERT_REL(r.coast_rate, coast ? -speed : 0.0, 0.0);
        GM_ASSERT_REL(r.rate, drive || coast ? speed : 0.0, 0.0);

        /* All of it touches there, or nothing. */
        GM_ASSERT_ABS(r.drive_contact, drive, 0.0);
        GM_ASSERT_ABS(r.coast_contact, coast, 0.0);
        GM_ASSERT_INT(r.drive_pairs, drive);
        GM_ASSERT_INT(r.coast_pairs, coast);
        GM_ASSERT_ABS(r.d_pinion_angle, drive || coast ? pair.pinion.base_radius : 0.0, 0.0);
        GM_ASSERT_ABS(r.d_wheel_angle, drive || coast ? -pair.wheel.base_radius : 0.0, 0.0);

        const gm_state state = {.pinion_angle = 0.25,
                                .wheel_angle =
                                    (pair.pinion.base_radius * 0.25 - x) / pair.wheel.base_radius,
                                .pinion_speed = 3.0,
                                .wheel_speed = 2.0};
        gm_penetration s;
        GM_ASSERT_INT(gm_penetration_simple(&pair, &state, &s), GM_OK);
        GM_ASSERT_ABS(s.penetration, r.penetration, length_rounding(&pair));
        GM_ASSERT_REL(s.rate,
                      drive || coast ? 3.0 * pair.pinion.base_radius - 2.0 * pair.wheel.base_radius
                                     : 0.0,
                      1e-14);
    }
}

/* Both models have the eigenfrequency of K eps_alpha; bodies in series on it. */
static void mean_stiffness_and_eigenfrequency_are_those_of_the_contact_ratio(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double spring = REFERENCE_STIFFNESS * pair.transverse_contact_ratio;
    const double r_bp = pair.pinion.base_radius, r_bw = pair.wheel.base_radius;
    for (int model = GM_MODEL_3D; model <= GM_MODEL_SIMPLE; ++model) {
        gm_test_context("model %d", model);
        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_params params;
        gm_mesh_params_default(&params);
        params.model = model;
        params.stiffness = REFERENCE_STIFFNESS;
        params.damping = REFERENCE_DAMPING;
        GM_ASSERT_INT(
            gm_mesh_init(&mesh, &params, &pair, NULL, NULL, room.memory, sizeof room.memory),
            GM_OK);
        GM_ASSERT_REL(gm_mesh_mean_stiffness(mesh), spring, 1e-15);
        GM_ASSERT_REL(gm_mesh_mean_damping(mesh), REFERENCE_DAMPING * pair.transverse_contact_ratio,
                      1e-15);

        /* The wheel alone on the spring, as in the documents of the reference pair: 1979.16 Hz. */
        GM_ASSERT_ABS(gm_mesh_eigenfrequency(mesh, HUGE_VAL, 2.1e-3), 1979.16, 0.005);
        const double omega =
            2.0 * 3.14159265358979323846 * gm_mesh_eigenfrequency(mesh, 1.7e-3, 2.1e-3);
        GM_ASSERT_REL(omega * omega, spring * (r_bp * r_bp / 1.7e-3 + r_bw * r_bw / 2.1e-3), 1e-14);
        GM_ASSERT_NAN(gm_mesh_eigenfrequency(mesh, 0.0, 2.1e-3));
        GM_ASSERT_NAN(gm_mesh_eigenfrequency(mesh, 2.1e-3, 0.0));
        GM_ASSERT_NAN(gm_mesh_eigenfrequency(mesh, 2.1e-3, -1.0));
        GM_ASSERT_NAN(gm_mesh_eigenfrequency(mesh, 1.0, NAN));
        GM_ASSERT_NAN(gm_mesh_eigenfrequency(mesh, NAN, 1.0));

        /* Of gears for a watch, and of two bodies that are both prescribed. */
        const double small =
            2.0 * 3.14159265358979323846 * gm_mesh_eigenfrequency(mesh, 1e-9, 2e-9);
        GM_ASSERT_REL(small * small, spring * (r_bp * r_bp / 1e-9 + r_bw * r_bw / 2e-9), 1e-14);
        GM_ASSERT(gm_mesh_eigenfrequency(mesh, HUGE_VAL, HUGE_VAL) == 0.0);
    }

    /* A law with a stiffness of its own: c' times the common face. */
    plain_mesh room;
    gm_mesh *mesh;
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.law = GM_LAW_ISO6336;
    params.iso_blank_factor = 0.9;
    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &pair, NULL, NULL, room.memory, sizeof room.memory),
                  GM_OK);
    GM_ASSERT_REL(gm_mesh_mean_stiffness(mesh),
                  gm_iso6336_single_stiffness(&pair, 0.9) * REFERENCE_FACE_WIDTH *
                      pair.transverse_contact_ratio,
                  1e-14);
    GM_ASSERT_NAN(gm_mesh_mean_stiffness(NULL));
    GM_ASSERT_NAN(gm_mesh_mean_damping(NULL));
    GM_ASSERT_NAN(gm_mesh_eigenfrequency(NULL, 1.0, 1.0));
    GM_ASSERT_NAN(gm_mesh_touching_stiffness(NULL, NULL));
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(force_is_stiffness_and_damping_of_a_side),
        GM_TEST(force_of_a_mesh_is_that_of_its_sides),
        GM_TEST(gradient_of_the_force_is_that_of_differences),
        GM_TEST(touching_part_moves_as_in_the_second_model),
        GM_TEST(simple_model_is_a_spring_with_backlash),
        GM_TEST(mean_stiffness_and_eigenfrequency_are_those_of_the_contact_ratio),
    };
    return gm_test_main("unit.law", tests, GM_TEST_COUNT(tests), argc, argv);
}
