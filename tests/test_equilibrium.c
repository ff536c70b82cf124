/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Quasi-static equilibrium under a torque. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "random_gears.h"
#include "reference_gear.h"

#include <stdlib.h>

/* Stated accuracy of x, as part of the centre distance. */
#define ACCURACY 1e-15

/* Evaluations made by the library: the linker puts this in their place (--wrap). Elsewhere none are counted. */
static long evaluations;

#ifdef GM_TEST_COUNTS_EVALUATIONS
int __real_gmi_mesh_evaluate_exact(const gm_mesh *mesh, const gm_position *position, int wanted,
                                   gm_workspace *workspace, gm_mesh_result *result);
int __wrap_gmi_mesh_evaluate_exact(const gm_mesh *mesh, const gm_position *position, int wanted,
                                   gm_workspace *workspace, gm_mesh_result *result);

int __wrap_gmi_mesh_evaluate_exact(const gm_mesh *mesh, const gm_position *position, int wanted,
                                   gm_workspace *workspace, gm_mesh_result *result) {
    ++evaluations;
    return __real_gmi_mesh_evaluate_exact(mesh, position, wanted, workspace, result);
}
#endif

/* Draws a net sum of up to some per cent of a module, as a torque for a stiffness of 1e8 N/m. */
static double random_torque(const random_case *c, uint64_t *seed) {
    return 1e8 * (double)c->model.base_radius[1] * c->params.normal_module *
           gm_test_uniform(seed, -1e-2, 1e-2);
}

static void equilibrium_inverts_the_sum(void) {
    uint64_t seed = UINT64_C(51);
    int solved = 0;
    for (int i = 0; i < 600; ++i) {
        random_case c;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);

        const double r_bw = (double)c.model.base_radius[1];
        const double m_n = c.params.normal_module;
        const double stiffness = 1e8;
        const double sum = m_n * gm_test_uniform(&seed, 1e-4, 5e-3);
        const double torque = (i % 2 == 0 ? 1.0 : -1.0) * stiffness * r_bw * sum;
        double x = NAN;
        gm_penetration r;
        const int status =
            equilibrium(&c.pair, c.use[0], c.use[1], c.pinion_angle, stiffness, torque, &x, &r);

        /* Spur gears may jump across the torque: no exact solution then. All else has one. */
        const int helical = fabs((double)c.model.face_advance) > 0.05 * m_n;
        if (helical) {
            if (!GM_ASSERT_INT(status, GM_OK)) {
                random_case_free(&c);
                return;
            }

            gm_position position;
            gm_penetration there;
            GM_ASSERT_INT(gm_position_from_pinion_angle(&c.pair, c.pinion_angle, x, 0.0, &position),
                          GM_OK);
            GM_ASSERT_INT(penetration_3d_at(&c.pair, c.use[0], c.use[1], &position, &there), GM_OK);

            /* x is a double: it resolves the sum to contact length times its rounding. */
            const double resolution =
                1e-12 * sum + 8.0 * 0x1p-53 * c.params.center_distance *
                                  (1.0 + there.drive_contact + there.coast_contact);
            const int good =
                GM_ASSERT_ABS(there.penetration, torque / stiffness / r_bw, resolution) &&
                GM_ASSERT_ABS(r.penetration, there.penetration, resolution) &&
                GM_ASSERT(torque > 0.0 ? there.drive > 0.0 : there.coast > 0.0);

            ++solved;
            if (!good) {
                random_case_free(&c);
                return;
            }
        } else {
            GM_ASSERT(status == GM_OK || status == GM_NO_EQUILIBRIUM);
        }
        random_case_free(&c);
    }

    gm_test_context("all cases");
    GM_ASSERT(solved > 300);
}

/* errata of the paper: b = 20 mm, K = 2.8e8 N/m, 20 N m (printed digits; 400 positions find the extremes
 * of a curve with kinks to their last digit) */
static void loaded_transmission_error_of_the_reference_gears(void) {
    static const struct {
        double pinion_tip, wheel_tip, mean, peak_to_peak;
    } racks[] = {{46.938390e-3, 43.003591e-3, -50.881e-6, 0.0197e-6},
                 {46.113390e-3, 42.178591e-3, -51.264e-6, 0.0411e-6}};
    for (int k = 0; k < 2; ++k) {
        gm_test_context("rack %d", k);
        gm_pair_params params = reference_params(20e-3);
        params.pinion_tip_radius = racks[k].pinion_tip;
        params.wheel_tip_radius = racks[k].wheel_tip;
        const gm_pair pair = make_pair(&params);
        double sum = 0.0;
        double lowest = HUGE_VAL;
        double highest = -HUGE_VAL;
        enum { STEPS = 400 };
        for (int n = 0; n < STEPS; ++n) {
            double x = NAN;
            GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, pair.pinion.pitch_angle * n / STEPS, 2.8e8,
                                      20.0, &x, NULL),
                          GM_OK);
            sum += -x;
            lowest = fmin(lowest, -x);
            highest = fmax(highest, -x);
        }
        GM_ASSERT_ABS(sum / STEPS, racks[k].mean, 0.5e-9);
        GM_ASSERT_ABS(highest - lowest, racks[k].peak_to_peak, 0.05e-9 + 0.05e-9);
    }
}

/* Spur gears drop a pair where its tip passes: the torque may be carried before and again after. What a mesh
 * reaches from the clearance on comes first. */
static void the_first_of_two_equilibria_counts(void) {
    const gm_pair pair = spur_pair();
    const double r_bp = pair.pinion.base_radius;
    const double target = 20e-6; /* sum of the penetrations (m) */
    const double torque = 1e8 * pair.wheel.base_radius * target;
    /* A drive pair ends at rho_p = T0 + delta - rho_w(tip): choose the phase so that it leaves at
     * delta = 0.75 target. Below it two pairs carry the torque at target / 2; above it one at target. */
    const double rho_p = pair.line_of_action + 0.75 * target - pair.wheel.tip_roll_length;
    double angle = (rho_p - pair.phase_origin[GM_DRIVE]) / r_bp;
    GM_ASSERT_INT(at(&pair, NULL, NULL, angle, pair.backlash / 2 + 0.74 * target).drive_pairs, 2);
    GM_ASSERT_INT(at(&pair, NULL, NULL, angle, pair.backlash / 2 + 0.76 * target).drive_pairs, 1);
    double x = NAN;
    gm_penetration r;
    /* Also from within the second branch, and for a torque that no first step outwards meets by chance. */
    static const double guesses[] = {NAN, 0.5, 0.74, 0.8, 1.0, 3.0, 40.0};
    static const double parts[] = {1.0, 0.9, 1.13, 1.49};
    for (size_t k = 0; k < 28; ++k) {
        const double part = parts[k / 7];
        gm_test_context("%g of the torque, guess %g", part, guesses[k % 7]);
        GM_ASSERT_INT(equilibrium_near(&pair, NULL, NULL, angle, 1e8, part * torque,
                                       pair.backlash / 2 + guesses[k % 7] * target, &x, &r),
                      GM_OK);
        GM_ASSERT_ABS(x, pair.backlash / 2 + part * target / 2, length_rounding(&pair));
        GM_ASSERT_INT(r.drive_pairs, 2);
    }
    gm_test_context("the second branch");
    /* A little more torque than two pairs reach before one leaves: the second branch it is. */
    const double more = 1.6 * torque;
    GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, angle, 1e8, more, &x, &r), GM_OK);
    GM_ASSERT_ABS(x, pair.backlash / 2 + 1.6 * target, length_rounding(&pair));
    GM_ASSERT_INT(r.drive_pairs, 1);
}

/*
 * The same next to spur, where a line leaves over some um of travel, and with pitch deviations: where a scan in small
 * steps finds the load carried first. On both sides, from any guess.
 */
static void the_first_place_that_carries_counts_next_to_spur(void) {
    const double step = 0.02e-6;
    static double memory[512];
    const gm_flanks_params sizes = {.teeth = 25};
    uint64_t seed = UINT64_C(57);
    int falling = 0;
    for (int i = 0; i < 300; ++i) {
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);

        /* Lines that climb by some micrometres over the face, or by nothing. */
        gm_pair_params params = spur_pair_params();
        const double advance = i % 3 == 0 ? 0.0 : gm_test_uniform(&seed, 0.5e-6, 12e-6);
        params.helix_angle = atan(advance / params.face_width) * (i % 2 ? 1.0 : -1.0);
        const gm_pair pair = make_pair(&params);

        /* Pitch deviations on most of them. */
        gm_flanks *flanks;
        const int side = i / 2 % 2 ? GM_COAST : GM_DRIVE;
        const double sign = side == GM_DRIVE ? 1.0 : -1.0;
        GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);
        for (int tooth = 0; tooth < 25; ++tooth) {
            GM_ASSERT_INT(gm_flanks_set_pitch(flanks, side, tooth,
                                              gm_test_uniform(&seed, -3e-6, 3e-6) * (i % 5 > 1)),
                          GM_OK);
        }

        /* A line leaves where rho_p = T0 + delta - rho_w(tip): the angle at which one does within the travel of the load. */
        const double target = gm_test_uniform(&seed, 10e-6, 40e-6);
        const double delta = gm_test_uniform(&seed, 0.1, 1.1) * target;
        const double rho_p = pair.line_of_action + delta - pair.wheel.tip_roll_length;
        const double angle = sign * (rho_p - pair.phase_origin[side]) / pair.pinion.base_radius +
                             gm_test_integer(&seed, 0, 24) * pair.pinion.pitch_angle;

        /* The first crossing of a scan, where there is one within 80 um. */
        const double begin = 0.5 * pair.backlash - 10e-6;
        double low = begin, last = 0.0;
        int k = 0, fell = 0;
        for (; k < 4000; ++k) {
            low = begin + k * step;
            const double sum = sign * at(&pair, flanks, NULL, angle, sign * low).penetration;
            fell += sum < last - 1e-9;
            last = sum;
            if (sum >= target) {
                break;
            }
        }
        if (k == 4000) {
            continue;
        }

        double x = NAN;
        gm_penetration r;
        const double torque = sign * 1e8 * pair.wheel.base_radius * target;
        const double guesses[] = {NAN, sign * low, sign * (low + 3e-6), sign * (low + target)};
        for (int guess = 0; guess < 4; ++guess) {
            GM_ASSERT_INT(
                equilibrium_near(&pair, flanks, NULL, angle, 1e8, torque, guesses[guess], &x, &r),
                GM_OK);
            GM_ASSERT_ABS(sign * x, low - 0.5 * step, 0.51 * step);
        }
        /* The same among several loads, which take their walks together. */
        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_result results[3];
        const double torques[3] = {0.4 * torque, torque, 0.9 * torque};
        double offsets[3];
        GM_ASSERT_INT(plain_mesh_make(&room, &pair, flanks, NULL, 1e8, 0.0, &mesh), GM_OK);
        GM_ASSERT_INT(gm_rolling_equilibria(mesh, angle, 0.0, torques, 3, GM_WANT_FORCE, NULL,
                                            offsets, results),
                      GM_OK);
        GM_ASSERT_ABS(sign * offsets[1], low - 0.5 * step, 0.51 * step);
        falling += fell > 0;
    }
    gm_test_context("all cases");
    GM_ASSERT(falling > 80);
}

/* Whatever it answers with GM_OK carries the torque, spur gears included. */
static void every_equilibrium_found_carries_the_torque(void) {
    uint64_t seed = UINT64_C(52);
    int found = 0;
    for (int i = 0; i < 1500; ++i) {
        random_case c;
        GM_ASSERT_INT(random_case_make(&c, &seed, i % 2), GM_OK);
        gm_test_context("case %d, helix %g", i, c.params.helix_angle);
        const double r_bw = (double)c.model.base_radius[1];
        const double target = c.params.normal_module * gm_test_uniform(&seed, -1e-2, 1e-2);
        double x = NAN;
        gm_penetration r;
        int good = 1;
        if (equilibrium(&c.pair, c.use[0], c.use[1], c.pinion_angle, 1e8, 1e8 * r_bw * target, &x,
                        &r) == GM_OK) {
            const gm_penetration there = at(&c.pair, c.use[0], c.use[1], c.pinion_angle, x);
            /* x is a double: steps of its rounding times the contact length, and of almost spur
             * lines times delta / advance. */
            const double e = 8.0 * 0x1p-53 * c.params.center_distance;
            const double advance = fabs((double)c.model.face_advance);
            const double steep =
                advance > 0.0 ? fmin(1.0, e / advance) * (fabs(target) + c.amplitude) : 0.0;
            const double tolerance = 1e-12 * fabs(target) + 10.0 * steep +
                                     e * (1.0 + there.drive_contact + there.coast_contact);
            /* A spur pair's sum may step over the torque where a pair enters: x is that place. */
            const gm_penetration before = at(&c.pair, c.use[0], c.use[1], c.pinion_angle, x - e);
            const gm_penetration behind = at(&c.pair, c.use[0], c.use[1], c.pinion_angle, x + e);
            const int steps_over = advance == 0.0 && before.penetration < target - tolerance &&
                                   behind.penetration > target + tolerance;
            good = steps_over || GM_ASSERT_ABS(there.penetration, target, tolerance);
            ++found;
        }
        random_case_free(&c);
        if (!good) {
            return;
        }
    }
    gm_test_context("all cases");
    GM_ASSERT(found > 1200);
}

static void the_least_torque_is_carried_at_the_clearance(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    static const double torques[] = {1e-9, -1e-9, 1e-20, -1e-100, 1e-280};
    for (size_t i = 0; i < sizeof torques / sizeof torques[0]; ++i) {
        gm_test_context("torque %g", torques[i]);
        double x = NAN;
        GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, 0.1, 1e8, torques[i], &x, NULL), GM_OK);
        GM_ASSERT_ABS(fabs(x), pair.backlash / 2, 1e-15);
        GM_ASSERT((x > 0.0) == (torques[i] > 0.0));
    }
}

/* One thick tooth jams between its neighbours; all other positions are open. */
static void a_thick_tooth_holds_without_torque_where_it_meshes(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_flanks_params sizes = {45, 0, 0, 0, 0, 0, 0};
    double memory[512];
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, 0, 60e-6), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_COAST, 0, 60e-6), GM_OK);
    double x = NAN;
    gm_penetration r;
    GM_ASSERT_INT(equilibrium(&pair, flanks, NULL, 3.0, 1e8, 0.0, &x, &r), GM_UNDETERMINED);
    GM_ASSERT_NAN(x);
    GM_ASSERT_NAN(r.penetration);
    GM_ASSERT_INT(equilibrium(&pair, flanks, NULL, -0.1, 1e8, 0.0, &x, &r), GM_OK);
    GM_ASSERT(r.drive > 0.0 && r.coast > 0.0);
    GM_ASSERT_ABS(r.penetration, 0.0, 1e-15);
}

static void no_torque_leaves_the_position_open(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    double x = 0.0;
    gm_penetration r;
    GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, 0.1, 1e8, 0.0, &x, &r), GM_UNDETERMINED);
    GM_ASSERT_NAN(x);
    GM_ASSERT_NAN(r.penetration);
    GM_ASSERT_NAN(r.d_wheel_angle);
    GM_ASSERT_INT(r.drive_pairs, 0);
    /* Without a result asked for. */
    GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, 0.1, 1e8, 0.0, &x, NULL), GM_UNDETERMINED);
}

static void negative_backlash_has_an_equilibrium_without_torque(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.backlash = -10e-6;
    const gm_pair pair = make_pair(&params);
    double x = NAN;
    gm_penetration r;
    const int status = equilibrium(&pair, NULL, NULL, 0.1, 1e8, 0.0, &x, &r);
    GM_ASSERT_INT(status, GM_OK);
    GM_ASSERT_ABS(r.penetration, 0.0, 1e-15);
    GM_ASSERT(r.drive > 0.0 && r.coast > 0.0);
    GM_ASSERT(fabs(x) < 5e-6);
}

static void too_much_torque_has_no_equilibrium(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    for (int s = -1; s <= 1; s += 2) {
        gm_test_context("sign %d", s);
        double x = 0.0;
        gm_penetration r;
        /* p_bt / 2 of three pairs on 1e8 N/m carries less than 1e6 N, 4e4 N m. */
        GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, 0.1, 1e8, s * 1e5, &x, &r), GM_NO_EQUILIBRIUM);
        GM_ASSERT_NAN(x);
        GM_ASSERT_NAN(r.penetration);
    }
}

/*
 * Just below |x| = p_bt / 2, where teeth are not yet skipped, a load is carried still; at that place the load has hardly
 * any room to grow: from 0.4999 to 0.5 p_bt by 1 / 5000 of itself, as contact lines get no longer under load.
 */
static void loads_are_carried_up_to_half_a_base_pitch(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double stiffness = 1e8;
    for (int i = 0; i < 12; ++i) {
        gm_test_context("position %d", i);
        const double angle = 0.013 * i, sign = i % 2 == 0 ? 1.0 : -1.0;
        const double x = sign * 0.4999 * pair.transverse_base_pitch;
        const double torque =
            at(&pair, NULL, NULL, angle, x).penetration * stiffness * pair.wheel.base_radius;
        double found = 0.0;
        GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, angle, stiffness, torque, &found, NULL),
                      GM_OK);
        GM_ASSERT_ABS(found, x, 1e-12);
        GM_ASSERT_INT(
            equilibrium(&pair, NULL, NULL, angle, stiffness, 1.001 * torque, &found, NULL),
            GM_NO_EQUILIBRIUM);
        GM_ASSERT_NAN(found);
    }
}

/*
 * Short paths: a line that is pressed leaves its path before half a base pitch is reached, so that the sum rises, falls and
 * may come to nothing. A load just below the largest sum is carried, where a scan of the sum finds it first; also if a
 * tooth far from the mesh sticks out, so that the search begins where the sum has fallen already.
 */
static void a_load_below_the_largest_sum_is_carried(void) {
    enum { STEPS = 2000 };
    const double stiffness = 1e8;
    static double memory[512];
    const gm_flanks_params sizes = {.teeth = 45};
    uint64_t seed = UINT64_C(56);
    int falling = 0;
    for (int i = 0; i < 400; ++i) {
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        gm_pair_params params = reference_params(15e-3);
        params.helix_angle = gm_test_uniform(&seed, 0.002, 0.2);
        params.center_distance = 0.5 * (45 + 41) * 1.65e-3 / cos(params.helix_angle);
        params.pinion_tip_radius = params.wheel_tip_radius = (double)NAN;
        params.pinion_tip_alteration = params.wheel_tip_alteration =
            gm_test_uniform(&seed, -1.3, -1.0);
        const gm_pair pair = make_pair(&params);

        /* One high tooth, every other time. */
        gm_flanks *flanks;
        GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);
        const double high_tooth = i % 2 * gm_test_uniform(&seed, 0.1e-3, 0.6e-3);
        GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, 22, high_tooth), GM_OK);

        /* The largest sum of all approaches, and a load a little below it. */
        const double angle = gm_test_uniform(&seed, 0.0, 0.2);
        const double limit = 0.49999 * pair.transverse_base_pitch;
        const double begin = 0.5 * pair.backlash, step = (limit - begin) / STEPS;
        double largest = 0.0;
        for (int k = 0; k <= STEPS; ++k) {
            largest = fmax(largest, at(&pair, flanks, NULL, angle, begin + k * step).penetration);
        }
        const double wanted = gm_test_uniform(&seed, 0.8, 0.995) * largest;
        if (!(largest > 1e-4) || at(&pair, flanks, NULL, angle, limit).penetration > 0.9 * wanted) {
            continue;
        }
        ++falling;

        /* The first crossing of the scan, by bisection. */
        int k = 0;
        while (at(&pair, flanks, NULL, angle, begin + k * step).penetration < wanted) {
            ++k;
        }
        double low = begin + (k - 1) * step, high = begin + k * step;
        for (int halving = 0; halving < 60; ++halving) {
            const double middle = 0.5 * (low + high);
            *(at(&pair, flanks, NULL, angle, middle).penetration < wanted ? &low : &high) = middle;
        }
        double found = 0.0;
        const double torque = wanted * stiffness * pair.wheel.base_radius;
        GM_ASSERT_INT(equilibrium(&pair, flanks, NULL, angle, stiffness, torque, &found, NULL),
                      GM_OK);
        GM_ASSERT_ABS(found, high, 1e-11);
    }
    gm_test_context("all cases");
    GM_ASSERT(falling > 100);
}

/* The spring of the simple model carries any torque: it has no tooth to skip. Only numbers end. */
static void the_simple_model_carries_what_can_be_written(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.model = GM_MODEL_SIMPLE;
    params.stiffness = 1e-10;
    params.simple_stiffness = 1e-10;
    plain_mesh room;
    gm_mesh *mesh;
    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &pair, NULL, NULL, room.memory, sizeof room.memory),
                  GM_OK);

    static const double torques[] = {1e-15, 1.0, 1e290, 1e300, 1e307, 1.7e308};
    for (size_t k = 0; k < sizeof torques / sizeof torques[0]; ++k) {
        for (int sign = -1; sign <= 1; sign += 2) {
            gm_test_context("torque %g", sign * torques[k]);
            double x = 0.0;
            gm_mesh_result r;
            const int status =
                gm_static_equilibrium(mesh, 0.1, sign * torques[k], NAN, NULL, &x, &r);
            const double compression = torques[k] / pair.wheel.base_radius / params.stiffness;
            if (isfinite(compression)) {
                GM_ASSERT_INT(status, GM_OK);
                GM_ASSERT_REL(x, sign * (0.5 * pair.backlash + compression), 1e-14);
                GM_ASSERT_REL(r.force * pair.wheel.base_radius, sign * torques[k], 1e-9);
            } else {
                GM_ASSERT_INT(status, GM_NO_EQUILIBRIUM);
                GM_ASSERT_NAN(x);
                GM_ASSERT_NAN(r.force);
            }
        }
    }
}

static void equilibrium_refuses_what_it_must(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    double x = 0.0;
    gm_penetration r;
    GM_ASSERT_INT(equilibrium(NULL, NULL, NULL, 0.1, 1e8, 1.0, &x, &r), GM_ERR_NULL);
    GM_ASSERT_NAN(x);
    GM_ASSERT_NAN(r.penetration);
    r.penetration = 0.0;
    GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, 0.1, 1e8, 1.0, NULL, &r), GM_ERR_NULL);
    GM_ASSERT_NAN(r.penetration);

    static const double bad_stiffness[] = {0.0, -1.0, NAN, HUGE_VAL, 0.99e-30, 1.01e30};
    for (size_t k = 0; k < sizeof bad_stiffness / sizeof bad_stiffness[0]; ++k) {
        gm_test_context("stiffness %g", bad_stiffness[k]);
        x = 0.0;
        r.penetration = 0.0;
        GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, 0.1, bad_stiffness[k], 1.0, &x, &r),
                      GM_ERR_PARAMETER);
        GM_ASSERT_NAN(x);
        GM_ASSERT_NAN(r.penetration);
    }

    static const double bad_number[] = {NAN, HUGE_VAL, -HUGE_VAL};
    for (size_t k = 0; k < sizeof bad_number / sizeof bad_number[0]; ++k) {
        gm_test_context("number %g", bad_number[k]);
        GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, bad_number[k], 1e8, 1.0, &x, &r),
                      GM_STATE_NOT_FINITE);
        GM_ASSERT_NAN(x);
        GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, 0.1, 1e8, bad_number[k], &x, &r),
                      GM_ERR_PARAMETER);
        GM_ASSERT_NAN(x);
    }

    GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, 2e9, 1e8, 1.0, &x, &r), GM_STATE_OUT_OF_RANGE);
    GM_ASSERT_NAN(x);

    /* Flanks of another gear, on either side. */
    const gm_flanks_params sizes = {44, 0, 0, 0, 0, 0, 0};
    double memory[512];
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);
    GM_ASSERT_INT(equilibrium(&pair, flanks, NULL, 0.1, 1e8, 1.0, &x, &r), GM_ERR_TOOTH);
    GM_ASSERT_NAN(x);
    GM_ASSERT_INT(equilibrium(&pair, NULL, flanks, 0.1, 1e8, 1.0, &x, &r), GM_ERR_TOOTH);
    GM_ASSERT_NAN(r.penetration);
}

/* ---------------------------------------------------------------------------------------------
 * Against bisection of the sum alone
 * ------------------------------------------------------------------------------------------- */

static gm_penetration sum_at(const random_case *c, double offset) {
    gm_position position;
    gm_penetration result;
    GM_ASSERT_INT(gm_position_from_pinion_angle(&c->pair, c->pinion_angle, offset, 0.0, &position),
                  GM_OK);
    GM_ASSERT_INT(penetration_3d_sum_at(&c->pair, c->use[0], c->use[1], &position, &result), GM_OK);
    return result;
}

enum quantity { NET, DRIVE, COAST };

static double quantity_at(const random_case *c, enum quantity quantity, double offset) {
    const gm_penetration r = sum_at(c, offset);
    return quantity == NET ? r.penetration : quantity == DRIVE ? r.drive : -r.coast;
}

/* Where a quantity that grows with x passes `target`: the middle of two neighbouring doubles, about. */
static double bisect(const random_case *c, enum quantity quantity, double target) {
    double high = 0.499999 * c->pair.transverse_base_pitch;
    double low = -high;
    for (int k = 0; k < 80; ++k) {
        const double middle = 0.5 * (low + high);
        if (quantity_at(c, quantity, middle) > target) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return 0.5 * (low + high);
}

static void bisection_of_the_sum_gives_the_same(void) {
    uint64_t seed = UINT64_C(53);
    int compared = 0;
    for (int i = 0; i < 400; ++i) {
        random_case c;
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        gm_test_context("case %d, helix %g", i, c.params.helix_angle);
        const double torque = random_torque(&c, &seed);
        const double target = torque / (1e8 * c.pair.wheel.base_radius);
        double x = NAN;
        gm_penetration r;
        /* Next to spur the sum falls where a line leaves, and more than one x carries the torque. */
        const int grows = fabs(c.pair.face_advance) > 0.05 * c.params.normal_module;
        if (grows && equilibrium(&c.pair, c.use[0], c.use[1], c.pinion_angle, 1e8, torque, &x,
                                 &r) == GM_OK) {
            /* Where little touches, the rounding of the sum moves x by more. */
            const double touching = fmin(1.0, r.drive_contact + r.coast_contact);
            GM_ASSERT_ABS(x, bisect(&c, NET, target),
                          ACCURACY * c.params.center_distance / touching);
            ++compared;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 200);
}

/* Without torque x is determined where the first drive flank touches before the last coast flank lets go. */
static void no_torque_is_carried_where_both_sides_touch(void) {
    uint64_t seed = UINT64_C(54);
    int jammed = 0, open = 0;
    for (int i = 0; i < 400; ++i) {
        random_case c;
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        c.pair.backlash = c.params.normal_module * gm_test_uniform(&seed, -2e-3, 2e-3);
        gm_test_context("case %d, helix %g", i, c.params.helix_angle);
        const double overlap = bisect(&c, COAST, -1e-300) - bisect(&c, DRIVE, 0.0);
        /* Next to spur the only line may have left where bisection looks for it. */
        const int grows = fabs(c.pair.face_advance) > 0.05 * c.params.normal_module;
        double x = NAN;
        gm_penetration r;
        const int status =
            equilibrium(&c.pair, c.use[0], c.use[1], c.pinion_angle, 1e8, 0.0, &x, &r);
        if (overlap > 1e-9) {
            if (GM_ASSERT_INT(status, GM_OK) && fabs(c.pair.face_advance) > 0.0) {
                GM_ASSERT(r.drive > 0.0 && r.coast > 0.0);
                GM_ASSERT_ABS(r.drive, r.coast, 1e-14 * c.params.center_distance);
            }
            ++jammed;
        } else if (overlap < -1e-9 && grows) {
            GM_ASSERT_INT(status, GM_UNDETERMINED);
            GM_ASSERT_NAN(x);
            ++open;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(jammed > 80 && open > 80);
}

/* ---------------------------------------------------------------------------------------------
 * A guess
 * ------------------------------------------------------------------------------------------- */

static void a_guess_does_not_change_the_answer(void) {
    uint64_t seed = UINT64_C(55);
    int found = 0;
    for (int i = 0; i < 600; ++i) {
        random_case c;
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);

        const double torque = i % 20 == 0 ? 0.0 : random_torque(&c, &seed);
        double x = NAN;
        gm_penetration r;
        const int status =
            equilibrium(&c.pair, c.use[0], c.use[1], c.pinion_angle, 1e8, torque, &x, &r);
        found += status == GM_OK;

        const double pitch = c.pair.transverse_base_pitch;
        const double sum = torque / (1e8 * c.pair.wheel.base_radius);
        const double guesses[] = {x,
                                  x + 1e-3 * sum,
                                  x - 1e-3 * sum,
                                  x + 10.0 * sum,
                                  x - sum,
                                  0.0,
                                  -x,
                                  0.49 * pitch,
                                  -0.4999999 * pitch,
                                  pitch,
                                  -1e300,
                                  1e-300,
                                  HUGE_VAL,
                                  -HUGE_VAL,
                                  NAN};

        for (size_t k = 0; k < sizeof guesses / sizeof guesses[0]; ++k) {
            gm_test_context("case %d, helix %g, guess %zu", i, c.params.helix_angle, k);
            double again = 0.0;
            gm_penetration there;
            GM_ASSERT_INT(equilibrium_near(&c.pair, c.use[0], c.use[1], c.pinion_angle, 1e8, torque,
                                           guesses[k], &again, &there),
                          status);
            if (status == GM_OK) {
                const double touching = fmin(1.0, r.drive_contact + r.coast_contact);
                GM_ASSERT_ABS(again, x, 2.0 * ACCURACY * c.params.center_distance / touching);
            } else {
                GM_ASSERT_NAN(again);
                GM_ASSERT_NAN(there.penetration);
            }
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(found > 500);
}

/*
 * Spur flanks with 20 um more on every pinion tooth touch from delta = -20 um on. Choose the phase so that one more line
 * enters at delta = -5 um: there n lines with 15 um each become n + 1, and a sum between is carried by the edge.
 */
static void a_step_of_the_sum_is_the_answer_from_any_guess(void) {
    const gm_pair pair = spur_pair();
    const gm_flanks_params sizes = {25, 0, 0, 0, 0, 0, 0};
    double memory[512];
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, GM_ALL_TEETH, 20e-6), GM_OK);
    const double rho = pair.line_of_action - 5e-6 - pair.wheel.start_roll_length;
    const double angle = (rho - pair.phase_origin[GM_DRIVE]) / pair.pinion.base_radius;
    const double step = 0.5 * pair.backlash - 5e-6;
    const gm_penetration before = at(&pair, flanks, NULL, angle, step - 1e-12);
    const gm_penetration behind = at(&pair, flanks, NULL, angle, step + 1e-12);
    GM_ASSERT_INT(behind.drive_pairs, before.drive_pairs + 1);
    GM_ASSERT_ABS(behind.drive - before.drive, 15e-6, 1e-11);

    const double torque = 1e8 * pair.wheel.base_radius * 0.5 * (before.drive + behind.drive);
    const double guesses[] = {NAN,         step,         step - 1e-6, step + 1e-6,
                              step - 9e-6, step + 30e-6, 0.0,         1e-3};
    for (size_t k = 0; k < sizeof guesses / sizeof guesses[0]; ++k) {
        gm_test_context("guess %g", guesses[k]);
        double x = NAN;
        gm_penetration r;
        GM_ASSERT_INT(equilibrium_near(&pair, flanks, NULL, angle, 1e8, torque, guesses[k], &x, &r),
                      GM_OK);
        GM_ASSERT_ABS(x, step, ACCURACY * pair.center_distance);
        GM_ASSERT(fabs(r.drive - before.drive) < 1e-11 || fabs(r.drive - behind.drive) < 1e-11);
    }
}

/*
 * With a transverse contact ratio of 0.6 the lines grow shorter as x grows, and the sum is largest near 0.3 base
 * pitches: what carries the torque lies before. From behind it, or across a gap, the way must lead back there.
 */
static void a_guess_beyond_the_largest_sum_finds_back(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    const gm_pair full = make_pair(&params);
    const double half_path = 0.3 * full.transverse_base_pitch;
    const double climb = tan(full.working_pressure_angle);
    params.pinion_tip_radius =
        hypot(full.pinion.base_radius, full.pinion.base_radius * climb + half_path);
    params.wheel_tip_radius =
        hypot(full.wheel.base_radius, full.wheel.base_radius * climb + half_path);
    const gm_pair pair = make_pair(&params);
    const double pitch = pair.transverse_base_pitch;
    GM_ASSERT_ABS(pair.transverse_contact_ratio, 0.6, 1e-12);
    const gm_flanks_params sizes = {45, 0, 0, 0, 0, 0, 0};
    double memory[512];
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);

    /* Without and with a gap of 0.12 base pitches before all teeth but one, which is elsewhere. */
    for (int n = 0; n < 8; ++n) {
        const int gap = n / 4;
        const double angle = n % 2 == 0 ? 0.1 : 0.9 * pair.pinion.pitch_angle;
        for (int tooth = 0; tooth < 45 && gap; ++tooth) {
            GM_ASSERT_INT(
                gm_flanks_set_pitch(flanks, GM_DRIVE, tooth, tooth == 20 ? 0.0 : -0.12 * pitch),
                GM_OK);
        }
        double largest = 0.0, best = 0.0;
        for (int k = 0; k < 500; ++k) {
            const double x = 1e-3 * k * pitch;
            const double drive = at(&pair, flanks, NULL, angle, x).drive;
            best = drive > largest ? x : best;
            largest = fmax(drive, largest);
        }
        const double sum = (n % 4 < 2 ? 0.98 : 0.9999) * largest;
        const double torque = 1e8 * pair.wheel.base_radius * sum;
        const double behind = 0.49 * pitch;
        GM_ASSERT(at(&pair, flanks, NULL, angle, behind).drive < sum);
        const double guesses[] = {NAN, behind, 0.4999 * pitch, 0.6 * pair.backlash};
        for (size_t k = 0; k < sizeof guesses / sizeof guesses[0]; ++k) {
            gm_test_context("case %d, guess %g", n, guesses[k]);
            double x = NAN;
            gm_penetration r;
            GM_ASSERT_INT(
                equilibrium_near(&pair, flanks, NULL, angle, 1e8, torque, guesses[k], &x, &r),
                GM_OK);
            GM_ASSERT(x < best);
            GM_ASSERT_ABS(r.drive, sum, ACCURACY * pair.center_distance);
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * How many evaluations it takes
 * ------------------------------------------------------------------------------------------- */

/* Flanks of one gear: a crowned and rough table of its own on each drive tooth, runout in the pitch. */
static gm_flanks *measured_flanks(int teeth, uint64_t *seed, void **memory) {
    enum { FACE_NODES = 21, PROFILE_NODES = 31 };
    const gm_flanks_params sizes = {teeth, teeth, FACE_NODES, PROFILE_NODES, 0, 0, 0};
    const size_t size = gm_flanks_size(&sizes);
    gm_flanks *flanks;
    *memory = malloc(size);
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, *memory, size), GM_OK);
    for (int tooth = 0; tooth < teeth; ++tooth) {
        double values[FACE_NODES * PROFILE_NODES];
        const double slope = gm_test_uniform(seed, -3e-6, 3e-6);
        for (int n = 0; n < FACE_NODES * PROFILE_NODES; ++n) {
            const double u = 2.0 * (n / PROFILE_NODES) / (FACE_NODES - 1.0) - 1.0;
            const double v = 2.0 * (n % PROFILE_NODES) / (PROFILE_NODES - 1.0) - 1.0;
            values[n] =
                slope * u - 4e-6 * u * u - 2e-6 * v * v + gm_test_uniform(seed, -3e-7, 3e-7);
        }
        GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, tooth, values, 1.0), GM_OK);
        const double pitch = 8e-6 * sin(0.2 + 6.283185307179586 * tooth / teeth);
        GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, tooth,
                                          pitch + gm_test_uniform(seed, -2e-6, 2e-6)),
                      GM_OK);
    }
    return flanks;
}

/* Evaluations of a curve of 1000 positions over one turn: in all, and at most for one of them. */
static void count_along_a_curve(const gm_pair *pair, const gm_flanks *pinion,
                                const gm_flanks *wheel, double torque, int guessing, long *all,
                                long *most) {
    enum { POSITIONS = 1000 };
    const double step = 6.283185307179586 / POSITIONS;
    double guess = NAN;
    *all = *most = 0;
    for (int k = 0; k < POSITIONS; ++k) {
        double x = NAN;
        gm_penetration r;
        evaluations = 0;
        GM_ASSERT_INT(equilibrium_near(pair, pinion, wheel, k * step, REFERENCE_STIFFNESS, torque,
                                       guessing ? guess : (double)NAN, &x, &r),
                      GM_OK);
        guess = x + step * (pair->pinion.base_radius +
                            pair->wheel.base_radius * r.d_pinion_angle / r.d_wheel_angle);
        *all += evaluations;
        *most = evaluations > *most ? evaluations : *most;
    }
}

static void few_evaluations_are_enough(void) {
    uint64_t seed = UINT64_C(56);
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    void *memory[2];
    const gm_flanks *pinion = measured_flanks(45, &seed, &memory[0]);
    const gm_flanks *wheel = measured_flanks(41, &seed, &memory[1]);
    static const double torques[] = {2.0, 20.0, 200.0};
    for (size_t k = 0; k < sizeof torques / sizeof torques[0]; ++k) {
        gm_test_context("torque %g", torques[k]);
        long all, most;
        count_along_a_curve(&pair, pinion, wheel, torques[k], 0, &all, &most);
        GM_ASSERT(all <= 7500 && most <= 9);
        count_along_a_curve(&pair, pinion, wheel, torques[k], 1, &all, &most);
        GM_ASSERT(all <= 3800 && most <= 7);
        count_along_a_curve(&pair, NULL, NULL, -torques[k], 0, &all, &most);
        GM_ASSERT(all <= 4000 && most <= 4);
        count_along_a_curve(&pair, NULL, NULL, -torques[k], 1, &all, &most);
        GM_ASSERT(all <= 1700 && most <= 4);
    }
    free(memory[0]);
    free(memory[1]);
}

/* ---------------------------------------------------------------------------------------------
 * Several loads at one position
 * ------------------------------------------------------------------------------------------- */

/* Room for a mesh of any of these laws. */
typedef union any_mesh {
    double alignment;
    char memory[8192];
} any_mesh;

/* 20 loads from 20 to 60 N m at positions over a turn: three walks, and one evaluation for nearly each of them. */
static void one_evaluation_is_enough_for_each_load(void) {
    enum { LOADS = 20, POSITIONS = 200 };
    uint64_t seed = UINT64_C(58);
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    void *memory[2];
    const gm_flanks *pinion = measured_flanks(45, &seed, &memory[0]);
    const gm_flanks *wheel = measured_flanks(41, &seed, &memory[1]);
    plain_mesh room;
    gm_mesh *mesh;
    GM_ASSERT_INT(plain_mesh_make(&room, &pair, pinion, wheel, REFERENCE_STIFFNESS, 0.0, &mesh),
                  GM_OK);
    double torque[LOADS];
    for (int k = 0; k < LOADS; ++k) {
        torque[k] = 20.0 + 40.0 * k / (LOADS - 1.0);
    }
    evaluations = 0;
    for (int i = 0; i < POSITIONS; ++i) {
        double x[LOADS];
        GM_ASSERT_INT(gm_rolling_equilibria(mesh, i * 6.283185307179586 / POSITIONS, 0.0, torque,
                                            LOADS, GM_WANT_FORCE, NULL, x, NULL),
                      GM_OK);
    }
    GM_ASSERT(evaluations <= (long)(1.1 * LOADS * POSITIONS));
    free(memory[0]);
    free(memory[1]);
}

/* Random gears in any order of loads on both sides, some not carried: as each load for itself. */
static void several_loads_are_carried_as_each_is(void) {
    enum { LOADS = 37 };
    uint64_t seed = UINT64_C(59);
    long found = 0;
    for (int i = 0; i < 300; ++i) {
        random_case c;
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);

        /* Every kind of mesh: simple, posed, tilted, with friction. */
        gm_mesh_params params;
        gm_mesh_params_default(&params);
        params.stiffness = 1e8;
        params.model = i % 29 == 28 ? GM_MODEL_SIMPLE : GM_MODEL_3D;
        params.pose.center_distance_change = i % 3 == 1 ? 1e-3 * c.params.normal_module : 0.0;
        params.pose.axial_shift = i % 3 == 1 ? 0.1 * c.params.normal_module : 0.0;
        params.pose.skew = i % 9 == 4 ? 1e-5 : 0.0;
        params.friction_coefficient = i % 7 == 3 ? 0.05 : 0.0;

        any_mesh room;
        gm_mesh *mesh;
        if (gm_mesh_init(&mesh, &params, &c.pair, c.use[0], c.use[1], room.memory,
                         sizeof room.memory) != GM_OK) {
            random_case_free(&c);
            continue; /* tips out of mesh */
        }

        /* Loads of either sign, one of none, one beyond what is carried, and one that is there twice. */
        double torque[LOADS], x[LOADS];
        gm_mesh_result result[LOADS];
        for (int k = 0; k < LOADS; ++k) {
            torque[k] = k == 5 ? 0.0 : random_torque(&c, &seed) * (k == 7 ? 1e4 : 1.0);
        }
        torque[9] = torque[8];
        const int status = gm_rolling_equilibria(mesh, c.pinion_angle, 1.0, torque, LOADS,
                                                 GM_WANT_WRENCH, NULL, x, result);

        /* Each by itself; the status is the first one that is not done. */
        int first = GM_OK;
        for (int k = 0; k < LOADS; ++k) {
            gm_test_context("case %d, helix %g, load %d", i, c.params.helix_angle, k);
            double alone;
            gm_mesh_result there;
            const int status_alone = gm_rolling_equilibrium(mesh, c.pinion_angle, 1.0, torque[k],
                                                            (double)NAN, NULL, &alone, &there);
            first = first == GM_OK ? status_alone : first;
            if (status_alone != GM_OK) {
                GM_ASSERT_NAN(x[k]);
                GM_ASSERT_NAN(result[k].force);
                continue;
            }

            ++found;
            const double touching =
                fmin(1.0, there.contact.drive_contact + there.contact.coast_contact);
            const double accuracy = 2.0 * ACCURACY * c.params.center_distance / touching;
            GM_ASSERT_ABS(x[k], alone, accuracy);
            GM_ASSERT(isfinite(result[k].wrench.wheel_moment[2]));

            if (fabs(c.pair.face_advance) > 0.05 * c.params.normal_module) { /* no steps */
                const double contact =
                    1.0 + there.contact.drive_contact + there.contact.coast_contact;
                GM_ASSERT_ABS(result[k].wheel_torque, torque[k],
                              1e-9 * fabs(torque[k]) +
                                  1e8 * c.pair.wheel.base_radius * accuracy * contact);
            }
        }

        GM_ASSERT_INT(status, first);
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(found > 7000);
}

/* The sums of both sides of a thick tooth act against each other. */
static void several_loads_are_carried_without_backlash(void) {
    enum { LOADS = 9 };
    uint64_t seed = UINT64_C(60);
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.backlash = -20e-6;
    const gm_pair pair = make_pair(&params);
    void *memory;
    const gm_flanks *pinion = measured_flanks(45, &seed, &memory);
    plain_mesh room;
    gm_mesh *mesh;
    GM_ASSERT_INT(plain_mesh_make(&room, &pair, pinion, NULL, REFERENCE_STIFFNESS, 0.0, &mesh),
                  GM_OK);
    double torque[LOADS], x[LOADS];
    for (int k = 0; k < LOADS; ++k) {
        torque[k] = 5.0 * (k - 4);
    }
    GM_ASSERT_INT(
        gm_rolling_equilibria(mesh, 0.3, 0.0, torque, LOADS, GM_WANT_DERIVATIVES, NULL, x, NULL),
        GM_OK);
    for (int k = 0; k < LOADS; ++k) {
        double alone;
        GM_ASSERT_INT(gm_static_equilibrium(mesh, 0.3, torque[k], (double)NAN, NULL, &alone, NULL),
                      GM_OK);
        GM_ASSERT_ABS(x[k], alone, 2.0 * ACCURACY * pair.center_distance);
    }
    free(memory);
}

static void several_loads_are_refused_as_one_is(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    plain_mesh room;
    gm_mesh *mesh;
    GM_ASSERT_INT(plain_mesh_make(&room, &pair, NULL, NULL, 1e8, 0.0, &mesh), GM_OK);
    const double torque[2] = {1.0, 2.0};
    double x[2] = {0.0, 0.0};
    gm_mesh_result r[2];
    static const double bad_number[] = {NAN, HUGE_VAL, -HUGE_VAL};
    for (size_t k = 0; k < sizeof bad_number / sizeof bad_number[0]; ++k) {
        gm_test_context("number %g", bad_number[k]);
        const double bad[2] = {1.0, bad_number[k]};
        x[0] = r[0].force = 0.0;
        GM_ASSERT_INT(gm_rolling_equilibria(mesh, 0.1, 0.0, bad, 2, 0, NULL, x, r),
                      GM_ERR_PARAMETER);
        GM_ASSERT_NAN(x[0]);
        GM_ASSERT_NAN(r[0].force);
        x[1] = 0.0;
        GM_ASSERT_INT(gm_rolling_equilibria(mesh, bad_number[k], 0.0, torque, 2, 0, NULL, x, r),
                      GM_STATE_NOT_FINITE);
        GM_ASSERT_NAN(x[1]);
        GM_ASSERT_INT(gm_rolling_equilibria(mesh, 0.1, bad_number[k], torque, 2, 0, NULL, x, r),
                      GM_STATE_NOT_FINITE);
    }
    gm_test_context("others");
    GM_ASSERT_INT(gm_rolling_equilibria(mesh, 0.1, 2e9, torque, 2, 0, NULL, x, r),
                  GM_STATE_OUT_OF_RANGE);
    GM_ASSERT_INT(gm_rolling_equilibria(mesh, 0.1, 0.0, torque, -1, 0, NULL, x, r),
                  GM_ERR_PARAMETER);
    GM_ASSERT_INT(gm_rolling_equilibria(mesh, 0.1, 0.0, torque, 2, 16, NULL, x, r),
                  GM_ERR_PARAMETER);
    GM_ASSERT_INT(gm_rolling_equilibria(NULL, 0.1, 0.0, torque, 2, 0, NULL, x, r), GM_ERR_NULL);
    GM_ASSERT_INT(gm_rolling_equilibria(mesh, 0.1, 0.0, NULL, 2, 0, NULL, x, r), GM_ERR_NULL);
    x[0] = 0.0;
    GM_ASSERT_INT(gm_rolling_equilibria(mesh, 0.1, 0.0, torque, 2, 0, NULL, NULL, r), GM_ERR_NULL);
    GM_ASSERT_NAN(r[1].force);
    GM_ASSERT_INT(gm_rolling_equilibria(mesh, 0.1, 0.0, torque, 0, 0, NULL, x, NULL), GM_OK);
    GM_ASSERT(x[0] == 0.0);
}

/* Bounded work, whatever the flanks, the torque and the guess. */
static void no_case_takes_many_evaluations(void) {
    uint64_t seed = UINT64_C(57);
    for (int i = 0; i < 1000; ++i) {
        random_case c;
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        gm_test_context("case %d, helix %g", i, c.params.helix_angle);
        const double pitch = c.pair.transverse_base_pitch;
        double x;
        evaluations = 0;
        (void)equilibrium_near(&c.pair, c.use[0], c.use[1], c.pinion_angle, 1e8,
                               random_torque(&c, &seed) * (i % 5 == 0 ? 1e3 : 1.0),
                               gm_test_uniform(&seed, -0.5, 0.5) * pitch, &x, NULL);
        GM_ASSERT(evaluations <= 120);
        random_case_free(&c);
    }
}

/*
 * Faces of 26 and 32 mm, the middle of the wheel's 1.5 mm before that of the pinion's. Right values by brute force of
 * turned helicoids, to 2e-5 um.
 */
static void unequal_faces_carry_as_turned_helicoids_do(void) {
    static const struct {
        double hand, torque;
        double te_um[5]; /* at 0, 0.4 pi, 0.8 pi, 1.2 pi, 1.6 pi of the pinion's angle */
    } cases[] = {
        {1.0,
         83.3,
         {-50.66419558518596, -51.10885554019886, -51.326450640219484, -50.5968456728733,
          -51.39000857709836}},
        {-1.0,
         -83.3,
         {50.66419558518596, 51.39000857709873, 50.596845672908884, 51.326450640122864,
          51.10885554006444}},
    };

    const double degree = 0.017453292519943295;
    for (int i = 0; i < 2; ++i) {
        gm_pair_params params;
        gm_pair_params_default(&params);
        params.pinion_teeth = 27;
        params.wheel_teeth = 38;
        params.normal_module = 2.5e-3;
        params.normal_pressure_angle = 20.0 * degree;
        params.helix_angle = cases[i].hand * 22.0 * degree;
        params.center_distance = 88.2e-3;
        params.backlash = 90e-6;
        params.pinion_face_width = 26e-3;
        params.wheel_face_width = 32e-3;
        params.axial_offset = -1.5e-3;
        params.pinion_start_radius = 0.5 * 68.2600963e-3;
        params.wheel_start_radius = 0.5 * 96.3795598e-3;

        const gm_pair pair = make_pair(&params);
        for (int k = 0; k < 5; ++k) {
            gm_test_context("case %d, position %d", i, k);
            double offset = 0.0;
            GM_ASSERT_INT(equilibrium(&pair, NULL, NULL, k * 72.0 * degree, 2e8, cases[i].torque,
                                      &offset, NULL),
                          GM_OK);
            GM_ASSERT_ABS(-1e6 * offset, cases[i].te_um[k], 2e-5);
        }
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(equilibrium_inverts_the_sum),
        GM_TEST(loaded_transmission_error_of_the_reference_gears),
        GM_TEST(unequal_faces_carry_as_turned_helicoids_do),
        GM_TEST(the_first_of_two_equilibria_counts),
        GM_TEST(the_first_place_that_carries_counts_next_to_spur),
        GM_TEST(every_equilibrium_found_carries_the_torque),
        GM_TEST(the_least_torque_is_carried_at_the_clearance),
        GM_TEST(a_thick_tooth_holds_without_torque_where_it_meshes),
        GM_TEST(no_torque_leaves_the_position_open),
        GM_TEST(negative_backlash_has_an_equilibrium_without_torque),
        GM_TEST(too_much_torque_has_no_equilibrium),
        GM_TEST(loads_are_carried_up_to_half_a_base_pitch),
        GM_TEST(a_load_below_the_largest_sum_is_carried),
        GM_TEST(the_simple_model_carries_what_can_be_written),
        GM_TEST(equilibrium_refuses_what_it_must),
        GM_TEST(bisection_of_the_sum_gives_the_same),
        GM_TEST(no_torque_is_carried_where_both_sides_touch),
        GM_TEST(a_guess_does_not_change_the_answer),
        GM_TEST(a_step_of_the_sum_is_the_answer_from_any_guess),
        GM_TEST(a_guess_beyond_the_largest_sum_finds_back),
        GM_TEST(few_evaluations_are_enough),
        GM_TEST(one_evaluation_is_enough_for_each_load),
        GM_TEST(several_loads_are_carried_as_each_is),
        GM_TEST(several_loads_are_carried_without_backlash),
        GM_TEST(several_loads_are_refused_as_one_is),
        GM_TEST(no_case_takes_many_evaluations),
    };
    return gm_test_main("unit.equilibrium", tests, GM_TEST_COUNT(tests), argc, argv);
}
