/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Elastic teeth as the law of a mesh, through the public interface: the check values of an independent implementation, and
 * what physics demands of any pair, flank, pose and side.
 */
#include "elastic_mesh.h"
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "mesh.h"
#include "random_gears.h"
#include "tilt.h"

#define DEGREE 0.017453292519943296

/* A mesh with its memory. */
typedef struct elastic_mesh {
    gm_pair pair;
    gm_mesh *mesh;
    gm_workspace *workspace;
    void *mesh_memory, *workspace_memory;
} elastic_mesh;

static int make(elastic_mesh *m, const gm_pair_params *gears, const gm_mesh_params *law,
                const gm_flanks *pinion, const gm_flanks *wheel) {
    memset(m, 0, sizeof *m);
    int status = gm_pair_init(&m->pair, gears);
    if (status != GM_OK) {
        return status;
    }
    const size_t size = gm_mesh_size(law, &m->pair);
    m->mesh_memory = malloc(size);
    status = gm_mesh_init(&m->mesh, law, &m->pair, pinion, wheel, m->mesh_memory, size);
    if (status != GM_OK) {
        return status;
    }
    const size_t room = gm_workspace_size(m->mesh);
    GM_ASSERT(room > 0);
    m->workspace_memory = malloc(room);
    return gm_workspace_init(&m->workspace, m->mesh, m->workspace_memory, room);
}

static void release(elastic_mesh *m) {
    free(m->mesh_memory);
    free(m->workspace_memory);
}

static gm_mesh_params elastic_law(void) {
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.law = GM_LAW_ELASTIC;
    return law;
}

static gm_pair_params spur62(void) {
    gm_pair_params p;
    gm_pair_params_default(&p);
    p.pinion_teeth = p.wheel_teeth = 62;
    p.normal_module = 2e-3;
    p.normal_pressure_angle = 20.0 * DEGREE;
    p.face_width = 20e-3;
    p.center_distance = 124e-3;
    p.pinion_profile_shift = p.wheel_profile_shift = 0.0;
    return p;
}

static gm_pair_params paper(void) {
    gm_pair_params p;
    gm_pair_params_default(&p);
    p.pinion_teeth = 45;
    p.wheel_teeth = 41;
    p.normal_module = 1.65e-3;
    p.normal_pressure_angle = 16.0 * DEGREE;
    p.helix_angle = 33.0 * DEGREE;
    p.face_width = 17.5e-3;
    p.center_distance = 85.0000164e-3;
    p.pinion_profile_shift = p.wheel_profile_shift = 0.1242;
    p.pinion_tip_alteration = p.wheel_tip_alteration = 0.0;
    return p;
}

static gm_pair_params nrel3(void) {
    gm_pair_params p;
    gm_pair_params_default(&p);
    p.pinion_teeth = 24;
    p.wheel_teeth = 95;
    p.normal_module = 14e-3;
    p.normal_pressure_angle = 20.0 * DEGREE;
    p.helix_angle = 10.0 * DEGREE;
    p.face_width = 360e-3;
    p.center_distance = 861.0001467e-3;
    p.pinion_profile_shift = 0.48;
    p.wheel_profile_shift = 0.6691;
    p.pinion_tip_radius = 190.3736708e-3;
    p.wheel_tip_radius = 697.6880969e-3;
    return p;
}

/* Planet and ring of stage 2 of the NREL 5 MW gearbox, with a helix. */
static gm_pair_params ring(void) {
    gm_pair_params p;
    gm_pair_params_default(&p);
    p.pinion_teeth = 36;
    p.wheel_teeth = -93;
    p.normal_module = 21e-3;
    p.normal_pressure_angle = 20.0 * DEGREE;
    p.helix_angle = 8.0 * DEGREE;
    p.face_width = 400e-3;
    p.center_distance = 589.74e-3;
    p.pinion_profile_shift = 0.5039;
    p.wheel_profile_shift = 0.1171;
    p.pinion_tip_alteration = -0.08338;
    return p;
}

/* x less half the backlash, force, dF/dx, U and dU/do of the specification's table. */
static void check_values_are_met(void) {
    const struct {
        gm_pair_params gears;
        double roll, force, approach, stiffness, energy, roll_force;
        int stations;
    } cases[] = {
        {spur62(), 16.21679662e-3, 2000.0, 3.5204755e-6, 5.9267690e8, 3.4476122e-3, 0.1399209, 17},
        {spur62(), 18.87371492e-3, 2000.0, 3.3983351e-6, 6.1402245e8, 3.3277843e-3, -0.0395395, 17},
        {paper(), 12.06805254e-3, 1500.0, 4.3705490e-6, 3.5962402e8, 3.2032112e-3, 0.0357711, 17},
        {nrel3(), 60.71594136e-3, 259200.0, 31.313399e-6, 8.7153952e9, 3.9564999, -61.00005, 17},
        {paper(), 12.06805254e-3, 1500.0, 4.3519989e-6, 0.0, 0.0, 0.0, 9},
        {paper(), 12.06805254e-3, 1500.0, 4.3813663e-6, 0.0, 0.0, 0.0, 97},
        {nrel3(), 60.71594136e-3, 259200.0, 31.085570e-6, 0.0, 0.0, 0.0, 9},
        {nrel3(), 60.71594136e-3, 259200.0, 31.380103e-6, 0.0, 0.0, 0.0, 97},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        gm_test_context("case %zu", k);
        gm_mesh_params law = elastic_law();
        law.stations = cases[k].stations;
        law.corner_contact = GM_CORNER_OFF;
        elastic_mesh m;
        GM_ASSERT_INT(make(&m, &cases[k].gears, &law, NULL, NULL), GM_OK);

        /* The pinion angle at which tooth 0 touches there at z = 0. */
        const double r_bp = m.pair.pinion.base_radius;
        const double r_bw = m.pair.wheel.base_radius;
        const double angle = (cases[k].roll - m.pair.phase_origin[GM_DRIVE]) / r_bp;
        double offset;
        gm_mesh_result r;
        GM_ASSERT_INT(gm_static_equilibrium(m.mesh, angle, cases[k].force * r_bw, (double)NAN,
                                            m.workspace, &offset, &r),
                      GM_OK);
        GM_ASSERT_REL(r.force, cases[k].force, 1e-9);
        GM_ASSERT_REL(offset - 0.5 * m.pair.backlash, cases[k].approach, 1e-6);
        if (cases[k].stiffness > 0.0) {
            GM_ASSERT_REL(-r.force_by.wheel_angle / r_bw, cases[k].stiffness, 1e-5);
            GM_ASSERT_REL(r.pinion_torque / r_bp - r.force, cases[k].roll_force, 1e-4);
            GM_ASSERT_REL(r.wheel_torque, r.force * r_bw, 1e-15);
            gm_position position;
            (void)gm_position_from_pinion_angle(&m.pair, angle, offset, 0.0, &position);
            GM_ASSERT_INT(gm_mesh_evaluate_at(m.mesh, &position, GM_WANT_ENERGY, m.workspace, &r),
                          GM_OK);
            GM_ASSERT_REL(r.energy, cases[k].energy, 1e-7); /* printed to 8 digits */
        }
        release(&m);
    }
}

/* A state with its side pressed together by some micrometres, in any mesh. */
static gm_state pressed_state(const elastic_mesh *m, double pinion_angle, double offset) {
    gm_state state = {.pinion_angle = pinion_angle};
    state.wheel_angle =
        (m->pair.pinion.base_radius * pinion_angle - offset) / m->pair.wheel.base_radius;
    return state;
}

/* Forgets what the workspace knows. */
static void forget(elastic_mesh *m) {
    GM_ASSERT_INT(
        gm_workspace_init(&m->workspace, m->mesh, m->workspace_memory, gm_workspace_size(m->mesh)),
        GM_OK);
}

static gm_mesh_result evaluate(elastic_mesh *m, const gm_state *state, int wanted) {
    gm_mesh_result r;
    GM_ASSERT_INT(gm_mesh_evaluate(m->mesh, state, wanted, m->workspace, &r), GM_OK);
    return r;
}

/* Some pairs, posed and not, with and without flanks; k counts them. */
enum { VARIANTS = 16 };
typedef struct variant {
    elastic_mesh mesh;
    random_flanks flanks[2];
    double softness[2][100]; /* factors of the teeth, in the last ones */
    int has_flanks;
} variant;

static void variant_make_scaled(variant *v, int k, double deviations) {
    uint64_t seed = 7u + (uint64_t)k;
    const gm_pair_params gears[4] = {spur62(), paper(), nrel3(), ring()};
    gm_pair_params params = gears[k % 4];
    gm_mesh_params law = elastic_law();
    gm_pair pair;
    memset(v, 0, sizeof *v);
    params.helix_angle *= k % 2 == 0 ? 1.0 : -1.0;
    params.backlash = 20e-6;
    GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);

    v->has_flanks = k >= 4;
    for (int gear = 0; v->has_flanks && gear < 2; ++gear) {
        random_flanks_make(&v->flanks[gear], &seed, &pair, gear,
                           deviations * 1e-3 * params.normal_module);
    }
    if (k >= 8) {
        law.pose.center_distance_change = 5e-3 * params.normal_module;
        law.pose.offset = -3e-3 * params.normal_module;
        law.pose.axial_shift = k >= 12 ? 0.05 * params.face_width : 0.0;
    }
    for (int tooth = 0; tooth < 200; ++tooth) {
        v->softness[tooth / 100][tooth % 100] = gm_test_uniform(&seed, 0.5, 1.5);
    }
    if (k >= 12) {
        law.pinion_tooth_stiffness = v->softness[0];
        law.wheel_tooth_stiffness = v->softness[1];
        law.pose.skew = 1e-4;
        law.pose.inclination = -7e-5;
        law.pinion_bore_radius = 0.5 * pair.pinion.root_radius;
    }
    GM_ASSERT_INT(make(&v->mesh, &params, &law, v->has_flanks ? v->flanks[0].flanks : NULL,
                       v->has_flanks ? v->flanks[1].flanks : NULL),
                  GM_OK);
}

static void variant_make(variant *v, int k) {
    variant_make_scaled(v, k, 1.0);
}

static void variant_free(variant *v) {
    release(&v->mesh);
    for (int gear = 0; v->has_flanks && gear < 2; ++gear) {
        random_flanks_free(&v->flanks[gear]);
    }
}

/* x at which the flanks of a side carry 100 N per mm of face. */
static double pressed_offset(elastic_mesh *m, int side, double angle) {
    const double torque = 1e5 * m->pair.face_width * m->pair.wheel.base_radius;
    double offset;
    GM_ASSERT_INT(gm_static_equilibrium(m->mesh, angle, side == GM_DRIVE ? torque : -torque,
                                        (double)NAN, m->workspace, &offset, NULL),
                  GM_OK);
    return offset;
}

/* Results of all positions, each from the one before; is_wide: with vectors of four doubles. */
enum { WIDE_STEPS = 24 };

static void evaluate_all(elastic_mesh *m, int is_wide, double x, gm_mesh_result *results) {
    ((gmi_elastic_mesh *)(uintptr_t)m->mesh->elastic)->law.is_wide = is_wide;
    memset(results, 0, WIDE_STEPS * sizeof *results);
    forget(m);
    for (int k = 0; k < WIDE_STEPS; ++k) {
        const double angle = 0.13 * k * m->pair.pinion.pitch_angle;
        const gm_state state = pressed_state(m, angle, x * (1.0 + 0.1 * (k % 5)));
        GM_ASSERT_INT(gm_mesh_evaluate(m->mesh, &state, GM_WANT_DERIVATIVES | GM_WANT_WRENCH,
                                       m->workspace, &results[k]),
                      GM_OK);
    }
}

/* What is compiled once more for such vectors does the same operations in the same order. */
static void vectors_of_four_give_the_same_bits(void) {
    for (int k = 0; k < VARIANTS; ++k) {
        gm_test_context("variant %d", k);
        variant v;
        variant_make(&v, k);
        const double x = pressed_offset(&v.mesh, k % 3 == 0 ? GM_COAST : GM_DRIVE, 0.0);
        gm_mesh_result plain[WIDE_STEPS], wide[WIDE_STEPS];
        const int is_wide = v.mesh.mesh->elastic->law.is_wide;
        GM_ASSERT_INT(is_wide, gmi_processor_is_wide());
        evaluate_all(&v.mesh, 0, x, plain);
        evaluate_all(&v.mesh, is_wide, x, wide);
        GM_ASSERT(plain[0].force != 0.0);
        for (int n = 0; n < WIDE_STEPS; ++n) {
            GM_ASSERT_INT(memcmp(&plain[n], &wide[n], sizeof plain[n]), 0);
        }
        variant_free(&v);
    }
}

/* Three values of a quantity around a state decide: the middle difference, and whether there is a kink. */
/* Returns 1 where the slope could be compared, 0 next to a kink. */
static int assert_slope(double before, double at, double after, double step, double slope,
                        double scale, double accuracy) {
    const double left = (at - before) / step;
    const double right = (after - at) / step;
    if (fabs(right - left) >= 1e-3 * scale) { /* a pair enters or leaves here */
        return 0;
    }
    GM_ASSERT_ABS(slope, 0.5 * (left + right), accuracy * scale + 0.51 * fabs(right - left));
    return 1;
}

static void derivatives_are_those_of_differences(void) {
    for (int k = 0; k < VARIANTS; ++k) {
        variant v;
        variant_make(&v, k);
        elastic_mesh *m = &v.mesh;
        for (int n = 0; n < 8; ++n) {
            gm_test_context("variant %d, state %d", k, n);
            const double angle = 0.013 + 0.37 * n / m->pair.pinion.teeth;
            const gm_state state = pressed_state(m, angle, pressed_offset(m, n % 2, angle));
            forget(m);
            const gm_mesh_result at = evaluate(m, &state, GM_WANT_DERIVATIVES);
            GM_ASSERT(fabs(at.force) > 0.0);

            /* By both angles: force and both torques. */
            const double radii[2] = {m->pair.pinion.base_radius, m->pair.wheel.base_radius};
            for (int gear = 0; gear < 2; ++gear) {
                /* Force and torques a step before and behind each angle, from a cold start. */
                const double step = 2e-9 / radii[gear];
                gm_mesh_result beside[2];
                for (int sign = 0; sign < 2; ++sign) {
                    gm_state moved = state;
                    *(gear == 0 ? &moved.pinion_angle : &moved.wheel_angle) +=
                        sign == 0 ? -step : step;
                    forget(m);
                    beside[sign] = evaluate(m, &moved, GM_WANT_FORCE);
                }
                forget(m);
                const gm_mesh_result here = evaluate(m, &state, GM_WANT_FORCE);
                const double scale = fabs(at.force_by.wheel_angle / radii[1]) * radii[gear];

                const gm_gradient *const gradients[3] = {&at.force_by, &at.pinion_torque_by,
                                                         &at.wheel_torque_by};
                const double values[3][3] = {
                    {beside[0].force, here.force, beside[1].force},
                    {beside[0].pinion_torque, here.pinion_torque, beside[1].pinion_torque},
                    {beside[0].wheel_torque, here.wheel_torque, beside[1].wheel_torque}};
                for (int q = 0; q < 3; ++q) {
                    const double unit = q == 0 ? 1.0 : radii[q - 1];

                    /* The work of the roll has no derivative by the roll itself. */
                    const double accuracy = gear == 0 && q == 1 ? 1e-4 : 2e-5;
                    assert_slope(values[q][0], values[q][1], values[q][2], step,
                                 gear == 0 ? gradients[q]->pinion_angle : gradients[q]->wheel_angle,
                                 scale * unit, accuracy);
                }
            }
        }
        variant_free(&v);
    }
}

/*
 * What more of the same deviations does, tables, pitch and reliefs, to the force: differences between meshes of their own.
 * Of one gear, of the other, and of both in one call.
 */
static void force_by_flanks_is_that_of_differences(void) {
    int compared = 0, entering = 0;
    for (int k = 4; k < VARIANTS; ++k) {
        variant v, beside[2];
        variant_make(&v, k);
        elastic_mesh *m = &v.mesh;
        const double step = 1e-3 / (1e-3 * 1e6 * m->pair.normal_module); /* 1 nm */
        variant_make_scaled(&beside[0], k, 1.0 - step);
        variant_make_scaled(&beside[1], k, 1.0 + step);
        const gm_flanks *pinion[3] = {v.flanks[0].flanks, NULL, v.flanks[0].flanks};
        const gm_flanks *wheel[3] = {NULL, v.flanks[1].flanks, v.flanks[1].flanks};

        for (int n = 0; n < 24; ++n) {
            gm_test_context("variant %d, state %d", k, n);
            const double angle = 0.013 + 0.13 * n / m->pair.pinion.teeth;
            const gm_state state = pressed_state(m, angle, pressed_offset(m, n % 2, angle));
            gm_position position;
            GM_ASSERT_INT(gm_position_from_state(&m->pair, &state, &position), GM_OK);
            double by[3];
            GM_ASSERT_INT(
                gm_mesh_force_by_flanks(m->mesh, &position, pinion, wheel, 3, m->workspace, by),
                GM_OK);
            entering += m->workspace->side[n % 2].is_entering;

            const gm_mesh_result here = evaluate(m, &state, GM_WANT_FORCE);
            gm_mesh_result other[2];
            for (int sign = 0; sign < 2; ++sign) {
                GM_ASSERT_INT(gm_mesh_evaluate_at(beside[sign].mesh.mesh, &position, GM_WANT_FORCE,
                                                  beside[sign].mesh.workspace, &other[sign]),
                              GM_OK);
            }
            const double largest =
                gm_mesh_touching_stiffness(m->mesh, &here) * 1e-3 * m->pair.normal_module;
            compared += assert_slope(other[0].force, here.force, other[1].force, step, by[2],
                                     largest, 2e-5);
            GM_ASSERT_ABS(by[0] + by[1], by[2], 1e-10 * largest);
        }
        variant_free(&v);
        variant_free(&beside[0]);
        variant_free(&beside[1]);
    }
    GM_ASSERT(compared > 20 * (VARIANTS - 4));
    GM_ASSERT(entering > 10); /* a wheel's edge, with a force of its own */
}

/* A wheel moved along its helix by more than half a base pitch is where it is, not where the angles alone would have it. */
static void force_by_flanks_and_pairs_know_the_pose(void) {
    gm_mesh_params law = elastic_law();
    const gm_pair_params gears = paper();
    law.pose.axial_shift = 0.3 * gears.face_width;
    elastic_mesh m;
    GM_ASSERT_INT(make(&m, &gears, &law, NULL, NULL), GM_OK);
    GM_ASSERT(fabs(m.mesh->engagement.offset_shift) > 0.5 * m.pair.transverse_base_pitch);

    /* The same place in the coordinates of the drawing. */
    gm_position position;
    GM_ASSERT_INT(gm_position_from_pinion_angle(&m.pair, 0.01, 0.0, 0.0, &position), GM_OK);
    position.offset = pressed_offset(&m, GM_DRIVE, 0.01);
    gm_mesh_result result;
    GM_ASSERT_INT(gm_mesh_evaluate_at(m.mesh, &position, GM_WANT_DERIVATIVES, m.workspace, &result),
                  GM_OK);
    GM_ASSERT(result.force > 0.0);

    /* Pairs are counted there too. */
    int pairs[2];
    GM_ASSERT_INT(gm_mesh_pairs_at(m.mesh, &position, m.workspace, pairs), GM_OK);
    GM_ASSERT_INT(pairs[GM_DRIVE], result.contact.drive_pairs);

    /* More material all over a flank is approach. */
    random_flanks even;
    uint64_t seed = 5u;
    random_flanks_make(&even, &seed, &m.pair, 0, 0.0);
    for (int tooth = 0; tooth < m.pair.pinion.teeth; ++tooth) {
        GM_ASSERT_INT(gm_flanks_set_pitch(even.flanks, GM_DRIVE, tooth, 1e-6), GM_OK);
    }
    const gm_flanks *pinion[1] = {even.flanks}, *wheel[1] = {NULL};
    double by;
    GM_ASSERT_INT(gm_mesh_force_by_flanks(m.mesh, &position, pinion, wheel, 1, m.workspace, &by),
                  GM_OK);
    GM_ASSERT_REL(by, 1e-6 * gm_mesh_touching_stiffness(m.mesh, &result), 1e-3);
    random_flanks_free(&even);
    release(&m);
}

/* With x held the force changes by little as the gears roll on, which the derivatives by both angles hide from each other. */
static void roll_at_held_approach_is_differentiated_exactly(void) {
    int compared = 0;
    for (int k = 0; k < VARIANTS; ++k) {
        variant v;
        variant_make(&v, k);
        elastic_mesh *m = &v.mesh;
        const double r_bp = m->pair.pinion.base_radius;
        const double r_bw = m->pair.wheel.base_radius;

        for (int n = 0; n < 8; ++n) {
            gm_test_context("variant %d, state %d", k, n);
            const double angle = 0.013 + 0.37 * n / m->pair.pinion.teeth;
            const gm_state state = pressed_state(m, angle, pressed_offset(m, n % 2, angle));
            forget(m);
            const gm_mesh_result at = evaluate(m, &state, GM_WANT_DERIVATIVES);

            /* Both gears roll, and x stays. */
            const double slope = at.force_by.pinion_angle / r_bp + at.force_by.wheel_angle / r_bw;
            const double step = 5e-5 * m->pair.normal_module;
            double force[3];
            for (int i = 0; i < 3; ++i) {
                gm_state rolled = state;
                rolled.pinion_angle += (i - 1) * step / r_bp;
                rolled.wheel_angle += (i - 1) * step / r_bw;
                forget(m);
                force[i] = evaluate(m, &rolled, GM_WANT_FORCE).force;
            }

            /* Not where a grid line or the end of a line is passed within the step. */
            const double left = (force[1] - force[0]) / step;
            const double right = (force[2] - force[1]) / step;
            if (fabs(right - left) < 6e-4 * fabs(slope)) {
                GM_ASSERT_ABS(slope, 0.5 * (left + right), 3e-4 * fabs(slope));
                ++compared;
            }
        }
        variant_free(&v);
    }
    GM_ASSERT(compared > 20);
}

/* Work of the torques around a closed path of both angles, by Simpson's rule on each of its four sides. */
static double work_around(elastic_mesh *m, double angle, double offset, double turn, double press,
                          double *throughput) {
    enum { PARTS = 512 };
    const double r_bp = m->pair.pinion.base_radius;
    double work = 0.0;
    *throughput = 0.0;
    for (int side = 0; side < 4; ++side) {
        for (int k = 0; k <= PARTS; ++k) {
            /* Along phi_p at fixed x, along x at fixed phi_p, and back. */
            const double share = (double)k / PARTS;
            const double along = side == 0   ? share
                                 : side == 1 ? 1.0
                                 : side == 2 ? 1.0 - share
                                             : 0.0;
            const double deep = side == 0 ? 0.0 : side == 1 ? share : side == 2 ? 1.0 : 1.0 - share;
            const gm_state state = pressed_state(m, angle + turn * along, offset + press * deep);
            const gm_mesh_result r = evaluate(m, &state, GM_WANT_FORCE);
            const double weight = (k == 0 || k == PARTS ? 1.0
                                   : k % 2 == 1         ? 4.0
                                                        : 2.0) /
                                  (3.0 * PARTS);
            const double direction = side < 2 ? 1.0 : -1.0;

            /* At fixed x the wheel follows; at fixed phi_p it turns back as x grows. */
            const double power =
                side % 2 == 0
                    ? (r.pinion_torque - r.wheel_torque * r_bp / m->pair.wheel.base_radius) * turn
                    : r.wheel_torque / m->pair.wheel.base_radius * press;
            work += direction * weight * power;
            *throughput += weight * fabs(r.pinion_torque * turn);
        }
    }
    return work;
}

/*
 * Whatever flanks, pose and softer teeth, with edges and with bodies that wind up: both torques are the slopes of the energy
 * that is given. Between tilted axes the teeth feel the gain times x, and the torques leave that out.
 */
static void torques_are_the_slopes_of_the_energy(void) {
    int compared = 0;
    for (int k = 0; k < VARIANTS; ++k) {
        variant v;
        variant_make(&v, k);
        elastic_mesh *m = &v.mesh;

        const double arms[2] = {m->pair.pinion.base_radius, m->pair.wheel.base_radius};
        for (int n = 0; n < 12; ++n) {
            const int side = n % 2;
            const double angle = 0.013 + 0.37 * n / m->pair.pinion.teeth;
            const gm_state state = pressed_state(m, angle, pressed_offset(m, side, angle));
            const gm_mesh_result at = evaluate(m, &state, GM_WANT_ENERGY);

            const double gain = m->mesh->engagement.is_tilted
                                    ? gmi_tilt_gain(&m->pair, &m->mesh->engagement, side)
                                    : 1.0;
            const double expected[2] = {at.pinion_torque + (gain - 1.0) * at.force * arms[0],
                                        -gain * at.wheel_torque};

            for (int gear = 0; gear < 2; ++gear) {
                gm_test_context("variant %d, state %d, gear %d", k, n, gear);
                const double h = 2e-6 * m->pair.normal_module / arms[gear];
                double beside[4];
                for (int j = 0; j < 4; ++j) {
                    gm_state there = state;
                    *(gear == 0 ? &there.pinion_angle : &there.wheel_angle) +=
                        (j < 2 ? j - 2 : j - 1) * h;
                    forget(m);
                    beside[j] = evaluate(m, &there, GM_WANT_ENERGY).energy;
                }

                const double slope =
                    (8.0 * (beside[2] - beside[1]) - (beside[3] - beside[0])) / (12.0 * h);
                GM_ASSERT_ABS(slope, expected[gear], 2e-5 * fabs(expected[gear]));
                ++compared;
            }
        }
        variant_free(&v);
    }
    GM_ASSERT(compared == 24 * VARIANTS);
}

/* Helical gears between smooth flanks: what goes in comes out. */
static void energy_is_kept_around_closed_paths(void) {
    const gm_pair_params gears[2] = {paper(), nrel3()};
    for (int k = 0; k < 2; ++k) {
        gm_mesh_params law = elastic_law();
        elastic_mesh m;
        GM_ASSERT_INT(make(&m, &gears[k], &law, NULL, NULL), GM_OK);
        const double deep = 2e-3 * m.pair.normal_module;
        double throughput;
        const double work =
            work_around(&m, 0.02, deep, 0.3 / m.pair.pinion.teeth, 0.5 * deep, &throughput);
        GM_ASSERT_ABS(work, 0.0, 1e-7 * throughput);

        /* F r_bp alone would not keep it: the work of the roll is there to be found. */
        const gm_state state = pressed_state(&m, 0.02, deep);
        const gm_mesh_result r = evaluate(&m, &state, GM_WANT_FORCE);
        GM_ASSERT(fabs(r.pinion_torque - r.force * m.pair.pinion.base_radius) >
                  1e-7 * r.pinion_torque);
        release(&m);
    }
}

/* A mirror turns helix and rotation round, and drive into coast. */
static void coast_is_drive_in_a_mirror(void) {
    gm_pair_params gears = nrel3();
    const gm_mesh_params law = elastic_law();
    elastic_mesh right, left;
    GM_ASSERT_INT(make(&right, &gears, &law, NULL, NULL), GM_OK);
    gears.helix_angle = -gears.helix_angle;
    GM_ASSERT_INT(make(&left, &gears, &law, NULL, NULL), GM_OK);
    for (int n = 0; n < 10; ++n) {
        const double angle = 0.011 + 0.03 * n;
        const gm_state state =
            pressed_state(&right, angle, pressed_offset(&right, GM_DRIVE, angle));
        const gm_state mirrored = {-state.pinion_angle, -state.wheel_angle, 0.0, 0.0};
        const gm_mesh_result a = evaluate(&right, &state, GM_WANT_DERIVATIVES);
        const gm_mesh_result b = evaluate(&left, &mirrored, GM_WANT_DERIVATIVES);
        GM_ASSERT_REL(b.force, -a.force, 1e-8);
        GM_ASSERT_REL(b.coast_force, a.drive_force, 1e-8);
        GM_ASSERT_REL(b.pinion_torque, -a.pinion_torque, 1e-8);
        GM_ASSERT_REL(b.force_by.wheel_angle, a.force_by.wheel_angle, 1e-5);
    }
    release(&right);
    release(&left);
}

static void answer_does_not_depend_on_the_one_before(void) {
    for (int k = 0; k < VARIANTS; ++k) {
        variant v;
        variant_make(&v, k);
        elastic_mesh *m = &v.mesh;
        for (int n = 0; n < 40; ++n) {
            gm_test_context("variant %d, state %d", k, n);
            const double angle = 0.004 * n * (n % 7 == 0 ? -5.0 : 1.0);
            const double offset = pressed_offset(m, GM_DRIVE, angle) * (1.0 + 0.1 * sin(3.0 * n));
            const gm_state state = pressed_state(m, angle, offset);
            const gm_mesh_result warm = evaluate(m, &state, GM_WANT_FORCE);
            void *const memory = malloc(gm_workspace_size(m->mesh));
            gm_workspace *fresh;
            gm_mesh_result cold;
            GM_ASSERT_INT(gm_workspace_init(&fresh, m->mesh, memory, gm_workspace_size(m->mesh)),
                          GM_OK);
            GM_ASSERT_INT(gm_mesh_evaluate(m->mesh, &state, GM_WANT_FORCE, fresh, &cold), GM_OK);
            GM_ASSERT_REL(warm.force, cold.force, 1e-8);
            free(memory);
        }
        variant_free(&v);
    }
}

/* The same material on all teeth is a turn of the gears. */
static void even_material_is_approach(void) {
    const gm_pair_params gears = paper();
    gm_mesh_params law = elastic_law();
    law.corner_contact = GM_CORNER_OFF;
    elastic_mesh plain, thick;
    gm_pair pair;
    GM_ASSERT_INT(gm_pair_init(&pair, &gears), GM_OK);
    const gm_flanks_params sizes = {.teeth = gears.pinion_teeth,
                                    .drive_tables = 1,
                                    .drive_face_nodes = 3,
                                    .drive_profile_nodes = 4};
    const size_t size = gm_flanks_size(&sizes);
    void *const memory = malloc(size);
    gm_flanks *flanks;
    double values[12];
    for (int k = 0; k < 12; ++k) {
        values[k] = 1.5e-6;
    }
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, size), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, GM_ALL_TEETH, 0.7e-6), GM_OK);
    GM_ASSERT_INT(make(&plain, &gears, &law, NULL, NULL), GM_OK);
    GM_ASSERT_INT(make(&thick, &gears, &law, flanks, NULL), GM_OK);
    for (int n = 0; n < 10; ++n) {
        const gm_state with = pressed_state(&thick, 0.02 * n, 3e-6);
        const gm_state without = pressed_state(&plain, 0.02 * n, 3e-6 + 2.2e-6);
        GM_ASSERT_REL(evaluate(&thick, &with, GM_WANT_FORCE).force,
                      evaluate(&plain, &without, GM_WANT_FORCE).force, 1e-8);
    }
    release(&plain);
    release(&thick);
    free(memory);
}

/* Flanks of both gears, on both sides: a base, and on one gear an amount of a unit, on all of its teeth or on one. */
typedef struct changed_flanks {
    void *memory[2];
    gm_flanks *flanks[2];
} changed_flanks;

/* Bilinear in the places on a flank, so that a table of any nodes has it exactly. */
static double unit_material(double t1, double t2) {
    return 0.4 + 1.1 * (t1 - 0.5) - 0.9 * (t2 - 0.3) + 0.7 * t1 * t2;
}

static void change_flanks(changed_flanks *c, const gm_pair *pair, double base, int role, int tooth,
                          double amount) {
    for (int gear = 0; gear < 2; ++gear) {
        const int teeth = abs(gear == GM_PINION ? pair->pinion.teeth : pair->wheel.teeth);
        const gm_flanks_params sizes = {teeth, teeth, 3, 4, teeth, 3, 4};
        const size_t size = gm_flanks_size(&sizes);
        c->memory[gear] = malloc(size);
        GM_ASSERT_INT(gm_flanks_init(&c->flanks[gear], &sizes, c->memory[gear], size), GM_OK);
        for (int k = 0; k < teeth; ++k) {
            const int is_changed = gear == role && (tooth < 0 || tooth == k);
            double values[12];
            for (int node = 0; node < 12; ++node) {
                const double unit = unit_material((node / 4) / 2.0, (node % 4) / 3.0);
                values[node] = base * sin(1.3 * node + k) + (is_changed ? amount * unit : 0.0);
            }
            GM_ASSERT_INT(gm_flanks_set_table(c->flanks[gear], GM_DRIVE, k, values, 1.0), GM_OK);
            GM_ASSERT_INT(gm_flanks_set_table(c->flanks[gear], GM_COAST, k, values, 1.0), GM_OK);
        }
    }
}

/* Force at one position from undeformed teeth. */
static double force_with(const gm_pair_params *gears, const gm_mesh_params *law, int role,
                         int tooth, double amount, double angle, double offset) {
    elastic_mesh m;
    changed_flanks c;
    gm_pair pair;
    gm_position position;
    gm_mesh_result result;
    GM_ASSERT_INT(gm_pair_init(&pair, gears), GM_OK);
    change_flanks(&c, &pair, 1e-6, role, tooth, amount);
    GM_ASSERT_INT(make(&m, gears, law, c.flanks[0], c.flanks[1]), GM_OK);
    GM_ASSERT_INT(gm_position_from_pinion_angle(&m.pair, angle, offset, 0.0, &position), GM_OK);
    GM_ASSERT_INT(gm_mesh_evaluate_at(m.mesh, &position, GM_WANT_FORCE, m.workspace, &result),
                  GM_OK);
    release(&m);
    free(c.memory[0]);
    free(c.memory[1]);
    return result.force;
}

/* Its derivative by the amount, by differences of two steps, without the third order. */
static double change_of_force(const gm_pair_params *gears, const gm_mesh_params *law, int role,
                              int tooth, double angle, double offset) {
    const double step = 4e-9;
    double slope[2];
    for (int k = 0; k < 2; ++k) {
        const double amount = (k + 1) * step;
        slope[k] = (force_with(gears, law, role, tooth, amount, angle, offset) -
                    force_with(gears, law, role, tooth, -amount, angle, offset)) /
                   (2.0 * amount);
    }
    return slope[0] + (slope[0] - slope[1]) / 3.0;
}

/* The same from the mesh without the change, at once with that of the wheel alone (per m). */
static double force_by_unit(const gm_pair_params *gears, const gm_mesh_params *law, int role,
                            int tooth, double angle, double offset) {
    elastic_mesh m;
    changed_flanks c, unit;
    gm_pair pair;
    gm_position position;
    double by[2];
    GM_ASSERT_INT(gm_pair_init(&pair, gears), GM_OK);
    change_flanks(&c, &pair, 1e-6, role, tooth, 0.0);
    change_flanks(&unit, &pair, 0.0, role, tooth, 1e-6);
    GM_ASSERT_INT(make(&m, gears, law, c.flanks[0], c.flanks[1]), GM_OK);
    GM_ASSERT_INT(gm_position_from_pinion_angle(&m.pair, angle, offset, 0.0, &position), GM_OK);
    const gm_flanks *pinion[] = {unit.flanks[GM_PINION], NULL};
    const gm_flanks *wheel[] = {unit.flanks[GM_WHEEL], unit.flanks[GM_WHEEL]};
    GM_ASSERT_INT(gm_mesh_force_by_flanks(m.mesh, &position, pinion, wheel, 2, m.workspace, by),
                  GM_OK);
    GM_ASSERT_REL(by[1], role == GM_WHEEL ? by[0] : 0.0, 1e-12);
    release(&m);
    for (int gear = 0; gear < 2; ++gear) {
        free(c.memory[gear]);
        free(unit.memory[gear]);
    }
    return by[0] / 1e-6;
}

/* Flanks that differ from tooth to tooth, with edges that enter, bores and tilted axes, a ring among the pairs. */
static void force_by_flanks_is_that_of_fine_differences(void) {
    const gm_pair_params gears[] = {spur62(), paper(), nrel3(), ring()};
    uint64_t seed = 3;
    for (int k = 0; k < 48; ++k) {
        gm_pair_params pair = gears[k % 4];
        gm_mesh_params law = elastic_law();
        pair.backlash = 20e-6;
        law.stations = 17; /* those of its own follow the flanks */
        law.corner_contact = k % 3 == 0 ? GM_CORNER_OFF : GM_CORNER_ON;
        law.pinion_bore_radius =
            k % 2 == 1 ? 0.3 * pair.normal_module * pair.pinion_teeth : (double)NAN;
        law.pose.skew = k >= 24 ? 5e-5 : 0.0;
        const int role = k % 5 < 3 ? GM_PINION : GM_WHEEL;
        const double angle = gm_test_uniform(&seed, 0.0, 0.3);
        const double offset = (k % 7 < 4 ? 1.0 : -1.0) * (10e-6 + 2e-3 * pair.normal_module);
        gm_test_context("case %d", k);

        /* All teeth of a gear, and for a start single ones. */
        const double exact = force_by_unit(&pair, &law, role, -1, angle, offset);
        const double change = change_of_force(&pair, &law, role, -1, angle, offset);
        GM_ASSERT_REL(exact, change, 1e-6);
        for (int tooth = 0; k < 8 && tooth < 3; ++tooth) {
            GM_ASSERT_ABS(force_by_unit(&pair, &law, role, tooth, angle, offset),
                          change_of_force(&pair, &law, role, tooth, angle, offset),
                          1e-6 * fabs(exact));
        }
    }
}

/* Tables of some teeth; the others have none, or one of zeros. */
static gm_flanks *every_other_tooth(int teeth, int has_zeros, void *memory, size_t size,
                                    const gm_flanks_params *sizes) {
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, sizes, memory, size), GM_OK);
    for (int tooth = 0; tooth < teeth; ++tooth) {
        const double peak = tooth % 2 == 0 ? 2e-6 : 0.0;
        double values[12];
        for (int k = 0; k < 12; ++k) {
            values[k] = -peak * sin(1.3 * k + tooth);
        }
        if (tooth % 2 == 0 || has_zeros) {
            GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, tooth, values, 1.0), GM_OK);
        }
    }
    return flanks;
}

/* Within the path and beyond it. */
static void teeth_without_a_table_are_as_drawn(void) {
    const gm_pair_params gears = paper();
    const gm_mesh_params law = elastic_law();
    const gm_flanks_params sizes = {.teeth = gears.pinion_teeth,
                                    .drive_tables = gears.pinion_teeth,
                                    .drive_face_nodes = 3,
                                    .drive_profile_nodes = 4};
    const size_t size = gm_flanks_size(&sizes);
    void *const memory[2] = {malloc(size), malloc(size)};

    /* Tables on every other tooth; the others have none, or tables of zeros. */
    elastic_mesh with[2];
    for (int k = 0; k < 2; ++k) {
        gm_flanks *flanks = every_other_tooth(gears.pinion_teeth, k, memory[k], size, &sizes);
        GM_ASSERT_INT(make(&with[k], &gears, &law, flanks, NULL), GM_OK);
    }

    double largest = 0.0, smallest = 1e30;
    for (int n = 0; n < 12; ++n) {
        gm_mesh_result r[2];
        for (int k = 0; k < 2; ++k) {
            const gm_state state = pressed_state(&with[k], 0.031 * n, 5e-6);
            r[k] = evaluate(&with[k], &state, GM_WANT_DERIVATIVES);
        }
        GM_ASSERT_REL(r[0].force, r[1].force, 1e-9);
        GM_ASSERT_REL(r[0].pinion_torque, r[1].pinion_torque, 1e-9);
        GM_ASSERT_REL(r[0].force_by.pinion_angle, r[1].force_by.pinion_angle, 1e-6);
        largest = fmax(largest, r[0].force);
        smallest = fmin(smallest, r[0].force);
    }

    /* Which teeth meet matters. */
    GM_ASSERT(largest > 1.02 * smallest);
    for (int k = 0; k < 2; ++k) {
        release(&with[k]);
        free(memory[k]);
    }
}

/* Discs between bore and root: the transmission error moves by the turn of both under the torque. */
static void bodies_wind_up_in_series(void) {
    const gm_pair_params gears = spur62();
    gm_mesh_params law = elastic_law();
    law.corner_contact = GM_CORNER_OFF;
    elastic_mesh rigid, soft;
    GM_ASSERT_INT(make(&rigid, &gears, &law, NULL, NULL), GM_OK);
    law.pinion_bore_radius = 20e-3;
    law.wheel_bore_radius = 30e-3;
    GM_ASSERT_INT(make(&soft, &gears, &law, NULL, NULL), GM_OK);

    /* Shear of rings, one after the other: T / (2 pi r^2 b G) over r dr. */
    const double torque = 120.0;
    const double r_bw = soft.pair.wheel.base_radius;
    const double shear_modulus = 206e9 / 2.6;
    double expected = 0.0;
    for (int gear = 0; gear < 2; ++gear) {
        const gm_gear *g = gear == 0 ? &soft.pair.pinion : &soft.pair.wheel;
        const double bore = gear == 0 ? law.pinion_bore_radius : law.wheel_bore_radius;
        const double step = (g->root_radius - bore) / 20000.0;
        double turn = 0.0;
        for (int k = 0; k < 20000; ++k) {
            const double r = bore + (k + 0.5) * step;
            turn += torque / r_bw * g->base_radius /
                    (2.0 * 3.14159265358979 * r * r * r * g->face_width * shear_modulus) * step;
        }
        expected += turn * g->base_radius;
    }
    for (int n = 0; n < 6; ++n) {
        double stiff, loose;
        gm_mesh_result r;
        GM_ASSERT_INT(gm_static_equilibrium(rigid.mesh, 0.02 * n, torque, (double)NAN,
                                            rigid.workspace, &stiff, NULL),
                      GM_OK);
        GM_ASSERT_INT(gm_static_equilibrium(soft.mesh, 0.02 * n, torque, (double)NAN,
                                            soft.workspace, &loose, &r),
                      GM_OK);
        GM_ASSERT_REL(loose - stiff, expected, 1e-6);
        GM_ASSERT_REL(r.force * r_bw, torque, 1e-9);
    }
    release(&rigid);
    release(&soft);
}

/* A cracked tooth: softer while it is in mesh, and nothing else. */
static void soft_tooth_is_softer_in_mesh_alone(void) {
    const gm_pair_params gears = spur62();
    gm_mesh_params law = elastic_law();
    double factors[62];
    for (int k = 0; k < 62; ++k) {
        factors[k] = k == 5 ? 0.6 : 1.0;
    }
    elastic_mesh whole, cracked;
    GM_ASSERT_INT(make(&whole, &gears, &law, NULL, NULL), GM_OK);
    law.pinion_tooth_stiffness = factors;
    GM_ASSERT_INT(make(&cracked, &gears, &law, NULL, NULL), GM_OK);
    int softer = 0, same = 0;
    for (int n = 0; n < 62; ++n) {
        /* Tooth n on the centre line: so do its neighbours touch, and no others. */
        const double angle = -2.0 * 3.14159265358979323846 * n / 62.0;
        const gm_state state = pressed_state(&whole, angle, 4e-6);
        const double a = evaluate(&whole, &state, GM_WANT_FORCE).force;
        const double b = evaluate(&cracked, &state, GM_WANT_FORCE).force;
        if (n < 4 || n > 6) {
            GM_ASSERT_REL(b, a, 1e-8); /* teeth of their own are taken from other tables */
            ++same;
        }
        softer += b < 0.97 * a;
    }
    GM_ASSERT(softer >= 1 && softer <= 3);
    GM_ASSERT(same > 50);
    release(&whole);
    release(&cracked);
}

/* Damping goes with the stiffness that is felt; flanks do not pull. */
static void damping_follows_the_stiffness(void) {
    const gm_pair_params gears = paper();
    gm_mesh_params law = elastic_law();
    law.damping = 800.0;
    elastic_mesh m;
    GM_ASSERT_INT(make(&m, &gears, &law, NULL, NULL), GM_OK);
    gm_state state = pressed_state(&m, 0.03, 4e-6);
    const gm_mesh_result still = evaluate(&m, &state, GM_WANT_DERIVATIVES);
    state.pinion_speed = 0.5;
    const gm_mesh_result moving = evaluate(&m, &state, GM_WANT_DERIVATIVES);
    const double speed = 0.5 * m.pair.pinion.base_radius;
    const double stiffness = -still.force_by.wheel_angle / m.pair.wheel.base_radius;
    const double relaxation = gm_mesh_mean_damping(m.mesh) / gm_mesh_mean_stiffness(m.mesh);
    GM_ASSERT_REL(moving.force - still.force, relaxation * stiffness * speed, 1e-6);

    /* It grows with the stiffness as the flanks press harder. */
    const double step = 2e-9 / m.pair.wheel.base_radius;
    gm_state pressed = state, eased = state;
    pressed.wheel_angle -= step;
    eased.wheel_angle += step;
    GM_ASSERT_REL(
        moving.force_by.wheel_angle - still.force_by.wheel_angle,
        ((evaluate(&m, &eased, GM_WANT_FORCE).force - evaluate(&m, &pressed, GM_WANT_FORCE).force) /
             (2.0 * step) -
         still.force_by.wheel_angle),
        1e-3);
    state.pinion_speed = -1e3;
    GM_ASSERT(evaluate(&m, &state, GM_WANT_FORCE).force == 0.0);
    release(&m);
}

/* Stiffness of the mesh, known from its derivative over a cycle at the reference torque. */
static void stiffness_is_that_at_the_reference_torque(void) {
    const gm_pair_params kinds[2] = {spur62(), paper()};
    for (int k = 0; k < 4; ++k) {
        const int is_off = k < 2;
        gm_test_context("kind %d, edges %d", k % 2, !is_off);
        gm_mesh_params law = elastic_law();
        law.corner_contact = is_off ? GM_CORNER_OFF : GM_CORNER_ON;
        law.reference_torque = k % 2 == 0 ? 100.0 : 60.0;

        /* What the mesh says, and the same over 200 equilibria. */
        elastic_mesh m;
        gm_mesh_stiffness s;
        GM_ASSERT_INT(make(&m, &kinds[k % 2], &law, NULL, NULL), GM_OK);
        GM_ASSERT_INT(gm_mesh_elastic_stiffness(m.mesh, &s), GM_OK);
        double sum = 0.0, smallest = HUGE_VAL, largest = 0.0;
        for (int n = 0; n < 200; ++n) {
            double offset;
            gm_mesh_result r;
            GM_ASSERT_INT(
                gm_static_equilibrium(m.mesh, m.pair.pinion.pitch_angle * (n + 0.5) / 200.0,
                                      law.reference_torque, (double)NAN, m.workspace, &offset, &r),
                GM_OK);
            const double stiffness = -r.force_by.wheel_angle / m.pair.wheel.base_radius;
            sum += stiffness / 200.0;
            smallest = fmin(smallest, stiffness);
            largest = fmax(largest, stiffness);
        }

        /* At 32 places of its own in the cycle, and next to its extremes. */
        const double accuracy = k % 2 == 0 ? 1e-2 : 1e-3;
        GM_ASSERT_REL(s.mesh_mean, sum, accuracy);
        GM_ASSERT_REL(s.mesh_smallest, smallest, 1.5e-2);
        GM_ASSERT_REL(s.mesh_largest, largest, 1.5e-2);
        GM_ASSERT_REL(gm_mesh_mean_stiffness(m.mesh), s.mesh_mean, 1e-12);
        GM_ASSERT(s.mesh_smallest < s.mesh_mean && s.mesh_mean < s.mesh_largest);

        /* One pair alone is softer than two, and of spur gears as stiff as where one carries all. */
        GM_ASSERT(s.single_smallest < s.single_mean && s.single_mean < s.single_largest);
        GM_ASSERT(s.single_largest < s.mesh_largest);
        GM_ASSERT(k != 0 || s.single_largest > 0.9 * s.mesh_smallest);
        release(&m);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Tip edges beyond the path
 * ------------------------------------------------------------------------------------------- */

/*
 * Largest step of the force over a mesh cycle at a held x, less what its slopes at both ends say, over the force.
 */
static double largest_jump(elastic_mesh *m, int steps, double x) {
    const double r_bp = m->pair.pinion.base_radius, r_bw = m->pair.wheel.base_radius;
    double force = 0.0, slope = 0.0, largest = 0.0;
    for (int n = 0; n <= steps; ++n) {
        const double angle = m->pair.pinion.pitch_angle * n / steps;
        const gm_state state = pressed_state(m, angle, x);
        const gm_mesh_result r = evaluate(m, &state, GM_WANT_DERIVATIVES);
        const double by_roll = r.force_by.pinion_angle / r_bp + r.force_by.wheel_angle / r_bw;
        if (n > 0) {
            const double step = m->pair.transverse_base_pitch / steps;
            const double jump = r.force - force - 0.5 * step * (slope + by_roll);
            largest = fmax(largest, fabs(jump) / r.force);
        }
        force = r.force;
        slope = by_roll;
    }
    return largest;
}

/* Lines come and go without load, so neither the force jumps nor its slope: also where a spur pair enters as a whole. */
static void force_of_spur_gears_is_smooth(void) {
    const gm_pair_params gears = spur62();
    gm_mesh_params law = elastic_law();
    elastic_mesh smooth, cut;
    GM_ASSERT_INT(make(&smooth, &gears, &law, NULL, NULL), GM_OK);
    law.corner_contact = GM_CORNER_OFF;
    GM_ASSERT_INT(make(&cut, &gears, &law, NULL, NULL), GM_OK);

    /* A jump stays; what the slopes leave of a smooth curve falls with more than the step. */
    const double coarse = largest_jump(&smooth, 500, 4e-6),
                 fine = largest_jump(&smooth, 4000, 4e-6);
    GM_ASSERT(largest_jump(&cut, 4000, 4e-6) > 0.3);
    GM_ASSERT(coarse < 0.02);
    GM_ASSERT(fine < 0.2 * coarse);
    release(&smooth);
    release(&cut);
}

/*
 * Between tilted axes the flanks may all stand farther apart than x says, and edges with them: light loads are carried as
 * they are, on both sides, whatever the tilt.
 */
static void tilted_edges_carry_light_loads(void) {
    const gm_pair_params kinds[2] = {paper(), nrel3()};
    for (int k = 0; k < 16; ++k) {
        gm_mesh_params law = elastic_law();
        law.stations = 9;
        law.pose.skew = k & 1 ? 3e-4 : -3e-4;
        law.pose.inclination = k & 2 ? 3e-4 : -3e-4;
        gm_pair_params gears = kinds[k >> 3];
        gears.helix_angle *= k & 4 ? -1.0 : 1.0;
        gears.face_width = 4.0 * gears.normal_module;
        elastic_mesh m;
        GM_ASSERT_INT(make(&m, &gears, &law, NULL, NULL), GM_OK);
        for (int side = 0; side < 2; ++side) {
            const double load = (side == 0 ? 1e3 : -1e3) * gears.face_width;
            for (int n = 0; n < 3; ++n) {
                gm_test_context("case %d, side %d, position %d", k, side, n);
                const double angle = m.pair.pinion.pitch_angle * (n + 0.3) / 3.0;
                double offset;
                gm_mesh_result r;
                GM_ASSERT_INT(gm_static_equilibrium(m.mesh, angle, load * m.pair.wheel.base_radius,
                                                    (double)NAN, m.workspace, &offset, &r),
                              GM_OK);
                GM_ASSERT_REL(r.force, load, 1e-6);
            }
        }
        release(&m);
    }
}

/* A pair of 20 degrees, its face as wide as `modules`. */
static gm_pair_params helical(double helix_deg, double modules) {
    gm_pair_params p;
    gm_pair_params_default(&p);
    p.pinion_teeth = 23;
    p.wheel_teeth = 57;
    p.normal_module = 3e-3;
    p.normal_pressure_angle = 20.0 * DEGREE;
    p.helix_angle = helix_deg * DEGREE;
    p.face_width = modules * p.normal_module;
    p.center_distance = 40.0 * p.normal_module / cos(p.helix_angle);
    p.pinion_profile_shift = p.wheel_profile_shift = 0.0;
    return p;
}

/* None given: as many as gm_elastic_stations() says, to the bit; what they leave is in test_elastic.c. */
static void stations_follow_from_the_pair(void) {
    const gm_pair_params pairs[] = {nrel3(), spur62(), ring(), helical(20.0, 10.0),
                                    helical(30.0, 30.0)};
    for (size_t k = 0; k < sizeof pairs / sizeof pairs[0]; ++k) {
        gm_test_context("pair %d", (int)k);
        gm_mesh_params law = elastic_law();
        elastic_mesh free, given;
        law.stations = 0;
        GM_ASSERT_INT(make(&free, &pairs[k], &law, NULL, NULL), GM_OK);
        law.stations = gm_elastic_stations(&free.pair);
        GM_ASSERT_INT(make(&given, &pairs[k], &law, NULL, NULL), GM_OK);
        GM_ASSERT(gm_workspace_size(free.mesh) == gm_workspace_size(given.mesh));
        const double x = 1e-3 * pairs[k].normal_module;
        const gm_state state = pressed_state(&free, 0.3, x);
        GM_ASSERT(evaluate(&free, &state, GM_WANT_FORCE).force ==
                  evaluate(&given, &state, GM_WANT_FORCE).force);
        release(&free);
        release(&given);
    }

    /* Spur gears need no more than the usual ones, wide helical ones do; one number less leaves more than wanted. */
    gm_pair pair;
    const gm_pair_params spur = spur62(), wide = helical(30.0, 30.0), widest = helical(45.0, 200.0);
    GM_ASSERT_INT(gm_pair_init(&pair, &spur), GM_OK);
    GM_ASSERT_INT(gm_elastic_stations(&pair), 17);
    GM_ASSERT_ABS(gm_elastic_stations_error(&pair, 17), 0.0, 0.0);
    GM_ASSERT_INT(gm_pair_init(&pair, &wide), GM_OK);
    const int stations = gm_elastic_stations(&pair);
    GM_ASSERT(stations > 17 && stations < 97);
    GM_ASSERT(gm_elastic_stations_error(&pair, stations) <= 0.0018);
    GM_ASSERT(gm_elastic_stations_error(&pair, stations - 1) > 0.0018);
    GM_ASSERT_INT(gm_pair_init(&pair, &widest), GM_OK);
    GM_ASSERT_INT(gm_elastic_stations(&pair), 97);

    /* The estimate by hand: 0.04 h^2 tan(beta_b) / (l g_alpha). */
    GM_ASSERT_INT(gm_pair_init(&pair, &wide), GM_OK);
    const double h = wide.face_width / 8.0, l = 1.45 * wide.normal_module * cos(30.0 * DEGREE);
    GM_ASSERT_REL(
        gm_elastic_stations_error(&pair, 9),
        0.04 * h * h * tan(pair.base_helix_angle) / (l * (pair.path_end - pair.path_start)), 1e-14);

    /* What is no question. */
    GM_ASSERT_INT(gm_elastic_stations(NULL), 0);
    GM_ASSERT(isnan(gm_elastic_stations_error(NULL, 17)));
    GM_ASSERT(isnan(gm_elastic_stations_error(&pair, 1)));
    memset(&pair, 0, sizeof pair);
    GM_ASSERT_INT(gm_elastic_stations(&pair), 17);
}

/* Largest error of the force with so many stations against 97, at what carries the load there, over a mesh cycle. */
static double error_of_stations(const gm_pair_params *gears, double line_load, double reference,
                                int stations) {
    gm_mesh_params law = elastic_law();
    law.reference_torque =
        reference * gears->face_width * 0.5 * gears->wheel_teeth * gears->normal_module;
    law.stations = 97;
    elastic_mesh fine, coarse;
    GM_ASSERT_INT(make(&fine, gears, &law, NULL, NULL), GM_OK);
    law.stations = stations;
    GM_ASSERT_INT(make(&coarse, gears, &law, NULL, NULL), GM_OK);
    double largest = 0.0;
    for (int n = 0; n < 12; ++n) {
        const double angle = fine.pair.pinion.pitch_angle * (n + 0.37) / 12.0;
        const double load = line_load * gears->face_width;
        double offset;
        GM_ASSERT_INT(gm_static_equilibrium(fine.mesh, angle, load * fine.pair.wheel.base_radius,
                                            (double)NAN, fine.workspace, &offset, NULL),
                      GM_OK);
        const gm_state state = pressed_state(&coarse, angle, offset);
        const gm_mesh_result r = evaluate(&coarse, &state, GM_WANT_FORCE);
        largest = fmax(largest, fabs(r.force / load - 1.0));
    }
    release(&fine);
    release(&coarse);
    return largest;
}

/*
 * With edges 17 stations leave hardly more than without, as lines are cut where the path ends, and where edges leave the
 * flank under the reference torque: 0.4 % of the force at that, 1 % at a tenth of it and at four times as much.
 */
static void few_stations_are_enough_for_edges(void) {
    const gm_pair_params pairs[] = {nrel3(),
                                    paper(),
                                    helical(5.0, 40.0),
                                    helical(10.0, 30.0),
                                    helical(20.0, 10.0),
                                    helical(30.0, 15.0)};
    for (size_t k = 0; k < sizeof pairs / sizeof pairs[0]; ++k) {
        gm_test_context("pair %d", (int)k);
        const double usual = 5e7 * pairs[k].normal_module;
        GM_ASSERT_ABS(error_of_stations(&pairs[k], usual, usual, 17), 0.0, 0.004);
        GM_ASSERT_ABS(error_of_stations(&pairs[k], 0.1 * usual, usual, 17), 0.0, 0.01);
        GM_ASSERT_ABS(error_of_stations(&pairs[k], 4.0 * usual, usual, 17), 0.0, 0.01);
    }
}

/* What is relieved, on both sides of all teeth: the tip, or both ends of the face. */
enum { TIP, LONG_ENDS, SHORT_ENDS, RELIEFS };

/* To be freed. depth: transverse (m). */
static gm_flanks *make_relieved(int teeth, int what, double depth) {
    const double shares[RELIEFS] = {0.3, 0.3, 0.09};
    const double rise = depth / shares[what];
    const gm_flank_ramp tip = {depth - rise, 0.0, rise};
    const gm_flank_ramp ends[2] = {{depth, -rise, 0.0}, {depth - rise, rise, 0.0}};
    const gm_flanks_params sizes = {teeth, 0, 2, 2, 0, 2, 2};
    const size_t size = gm_flanks_size(&sizes);
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, malloc(size), size), GM_OK);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        GM_ASSERT_INT(
            gm_flanks_set_ramps(flanks, side, what == TIP ? &tip : ends, what == TIP ? 1 : 2, 1.0),
            GM_OK);
    }
    return flanks;
}

/* x under the reference torque at places of a mesh cycle; part: of that torque. */
enum { PLACES = 12 };

static void press_all(elastic_mesh *m, double torque, double x[PLACES]) {
    for (int n = 0; n < PLACES; ++n) {
        const double angle = m->pair.pinion.pitch_angle * (n + 0.37) / PLACES;
        GM_ASSERT_INT(
            gm_static_equilibrium(m->mesh, angle, torque, (double)NAN, m->workspace, &x[n], NULL),
            GM_OK);
    }
}

/* Largest error of x, of what the teeth give way by from the first touch on. is_cut: where reliefs begin. */
static double error_of_relief(const gm_pair_params *gears, const gm_flanks *flanks,
                              gm_mesh_params law, int stations, int is_cut,
                              const double exact[PLACES], const double touching[PLACES]) {
    elastic_mesh m;
    law.stations = stations;
    GM_ASSERT_INT(make(&m, gears, &law, flanks, NULL), GM_OK);
    m.workspace->side[GM_DRIVE].creases_max *= is_cut;
    double x[PLACES], largest = 0.0;
    press_all(&m, law.reference_torque, x);
    for (int n = 0; n < PLACES; ++n) {
        largest = fmax(largest, fabs((x[n] - exact[n]) / (exact[n] - touching[n])));
    }
    release(&m);
    return largest;
}

/*
 * Linear reliefs of any depth leave 0.4 % of what teeth give way by with the mesh's own number of stations, which needs both:
 * more of them than the pair alone wants, and cuts where reliefs begin. Exact: the limit of 48 and 96 elements.
 */
static void reliefs_leave_0_4_percent(void) {
    const gm_pair_params pairs[] = {helical(0.0, 30.0), helical(10.0, 20.0), helical(20.0, 12.0),
                                    helical(30.0, 15.0)};
    const double depths[] = {1.0, 4.0, 15.0};
    double uncut = 0.0, few = 0.0, few_uncut = 0.0;
    for (int k = 0; k < 4 * 3 * RELIEFS; ++k) {
        const gm_pair_params *gears = &pairs[k % 4];
        const double times = depths[k / 4 % 3];
        gm_test_context("pair %d, relief %d of %g times the deflection", k % 4, k / 12, times);
        gm_mesh_params law = elastic_law();
        law.corner_contact = k % 2 == 0 ? GM_CORNER_OFF : GM_CORNER_ON;
        const double line_load = 5e7 * gears->normal_module;
        gm_pair pair;
        GM_ASSERT_INT(gm_pair_init(&pair, gears), GM_OK);
        law.reference_torque = line_load * gears->face_width * pair.wheel.base_radius;
        gm_flanks *flanks = make_relieved(gears->pinion_teeth, k / 12,
                                          times * 10.0 * line_load / law.pinion_youngs_modulus);

        /* The limit, and where the flanks touch first. */
        double x[2][PLACES], touching[PLACES], exact[PLACES];
        for (int fine = 0; fine < 2; ++fine) {
            elastic_mesh m;
            law.stations = fine ? 97 : 49;
            GM_ASSERT_INT(make(&m, gears, &law, flanks, NULL), GM_OK);
            press_all(&m, law.reference_torque, x[fine]);
            press_all(&m, 1e-7 * law.reference_torque, touching);
            release(&m);
        }
        for (int n = 0; n < PLACES; ++n) {
            exact[n] = (4.0 * x[1][n] - x[0][n]) / 3.0;
        }

        GM_ASSERT_ABS(error_of_relief(gears, flanks, law, 0, 1, exact, touching), 0.0, 0.004);
        uncut = fmax(uncut, error_of_relief(gears, flanks, law, 0, 0, exact, touching));
        few = fmax(few, error_of_relief(gears, flanks, law, 17, 1, exact, touching));
        few_uncut = fmax(few_uncut, error_of_relief(gears, flanks, law, 17, 0, exact, touching));
        free(flanks);
    }
    gm_test_context("%s", "");
    GM_ASSERT(uncut > 0.005);
    GM_ASSERT(few > 0.01);
    GM_ASSERT(few_uncut > 2.0 * few);
}

/* The number of stations follows from the depth of the flanks, be they ramps or tables, against 10 F / (E b). */
static void stations_follow_from_the_flanks(void) {
    const struct {
        double times;
        int quarters;
    } rows[] = {{0.29, 4}, {0.31, 5}, {1.4, 5},   {1.6, 8},
                {5.9, 8},  {6.1, 12}, {24.0, 12}, {26.0, 16}};
    const gm_pair_params gears = helical(20.0, 10.0);
    gm_mesh_params law = elastic_law();
    gm_pair pair;
    GM_ASSERT_INT(gm_pair_init(&pair, &gears), GM_OK);
    const int usual = gm_elastic_stations(&pair);
    for (int k = 0; k < 16; ++k) {
        const double times = rows[k / 2].times;
        gm_test_context("%g times the deflection", times);
        law.reference_torque = 2e5 * gears.face_width * pair.wheel.base_radius;
        const double depth = times * 10.0 * 2e5 / law.pinion_youngs_modulus;
        const int expected = 1 + (rows[k / 2].quarters * (usual - 1) + 3) / 4;
        GM_ASSERT_INT(gm_elastic_stations_modified(&pair, &law, depth), expected);

        /* Of one flank that is relieved, or crowned upwards: then the lowest nodes are 0. */
        gm_flanks *flanks = make_relieved(gears.pinion_teeth, k / 2 % RELIEFS, depth);
        if (k % 2 == 1) {
            free(flanks);
            const double table[3][2] = {{0.0, 0.0}, {depth, depth}, {0.0, 0.0}};
            const gm_flanks_params sizes = {gears.pinion_teeth, 1, 3, 2, 0, 2, 2};
            const size_t size = gm_flanks_size(&sizes);
            GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, malloc(size), size), GM_OK);
            GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, &table[0][0], 1.0),
                          GM_OK);
        }
        elastic_mesh m;
        law.stations = 0;
        GM_ASSERT_INT(make(&m, &gears, &law, flanks, NULL), GM_OK);
        GM_ASSERT_INT(m.mesh->elastic->law.stations, expected);
        release(&m);

        /* Those given stay. */
        law.stations = 11;
        GM_ASSERT_INT(make(&m, &gears, &law, flanks, NULL), GM_OK);
        GM_ASSERT_INT(m.mesh->elastic->law.stations, 11);
        release(&m);
        free(flanks);
    }

    /* No more than there can be. */
    GM_ASSERT_INT(gm_elastic_stations_modified(NULL, &law, 0.0), 0);
    GM_ASSERT_INT(gm_elastic_stations_modified(&pair, NULL, 0.0), 0);
    const gm_pair_params wide = helical(30.0, 45.0);
    GM_ASSERT_INT(gm_pair_init(&pair, &wide), GM_OK);
    GM_ASSERT_INT(gm_elastic_stations_modified(&pair, &law, 1.0), 97);
}

/* Edges press hardest where their rounding begins to bear, between the stations: few of them find that pressure too. */
static void few_stations_find_the_pressure_of_edges(void) {
    const gm_pair_params gears = helical(20.0, 10.0);
    gm_mesh_params law = elastic_law();
    elastic_mesh fine, coarse;
    GM_ASSERT_INT(make(&coarse, &gears, &law, NULL, NULL), GM_OK);
    law.stations = 97;
    GM_ASSERT_INT(make(&fine, &gears, &law, NULL, NULL), GM_OK);
    for (int n = 0; n < 24; ++n) {
        gm_test_context("position %d", n);
        const double angle = fine.pair.pinion.pitch_angle * (n + 0.37) / 24.0;
        const gm_state state = pressed_state(&fine, angle, pressed_offset(&fine, GM_DRIVE, angle));
        gm_position position;
        gm_line_loads few, many;
        GM_ASSERT_INT(gm_position_from_state(&fine.pair, &state, &position), GM_OK);
        GM_ASSERT_INT(gm_mesh_line_loads(coarse.mesh, &position, coarse.workspace, NULL, 0, &few),
                      GM_OK);
        GM_ASSERT_INT(gm_mesh_line_loads(fine.mesh, &position, fine.workspace, NULL, 0, &many),
                      GM_OK);
        GM_ASSERT_REL(few.largest_pressure, many.largest_pressure, 0.05);
    }
    release(&fine);
    release(&coarse);
}

/* The pinion's torque in equilibrium under a load, over the pinion's angle. */
typedef struct driven {
    elastic_mesh mesh;
    double load, offset;
} driven;

static double pinion_torque_at(driven *d, double angle) {
    gm_mesh_result r;
    GM_ASSERT_INT(gm_static_equilibrium(d->mesh.mesh, angle, d->load, d->offset, d->mesh.workspace,
                                        &d->offset, &r),
                  GM_OK);
    return r.pinion_torque;
}

/* Gauss with 7 points and Kronrod's 8 more: the integral, and how far apart both are. */
static double pinion_work(driven *d, double from, double to, double *error) {
    static const double place[8] = {
        0.9914553711208126, 0.9491079123427585, 0.8648644233597691, 0.7415311855993944,
        0.5860872354676911, 0.4058451513773972, 0.2077849550078985, 0.0};
    static const double weight[8] = {0.0229353220105292, 0.0630920926299786, 0.1047900103222502,
                                     0.1406532597155259, 0.1690047266392679, 0.1903505780647854,
                                     0.2044329400752989, 0.2094821410847278};
    static const double gauss[4] = {0.1294849661688697, 0.2797053914892767, 0.3818300505051189,
                                    0.4179591836734694};
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double fine = 0.0, coarse = 0.0;
    for (int k = 0; k < 8; ++k) {
        double torque = pinion_torque_at(d, middle - half * place[k]);
        torque += k < 7 ? pinion_torque_at(d, middle + half * place[k]) : 0.0;
        fine += half * weight[k] * torque;
        coarse += k % 2 == 1 ? half * gauss[k / 2] * torque : 0.0;
    }
    *error = fabs(fine - coarse);
    return fine;
}

/*
 * What goes in comes out over a mesh cycle in equilibrium, through edges of both gears, and through a tip relief whose
 * begin moves along the lines. Each point that an edge begins to load leaves a kink in the torque, where the steps of the
 * integral are halved until it no longer counts.
 */
static void edges_and_reliefs_keep_the_energy(void) {
    const gm_pair_params kinds[6] = {spur62(), paper(), nrel3(), ring(), paper(), paper()};
    for (int kind = 0; kind < 6; ++kind) {
        gm_test_context("kind %d", kind);
        gm_mesh_params law = elastic_law();
        law.stations = 7;
        if (kind == 5) {
            /* Lines that end with the path, in an element that is cut. */
            law.corner_contact = GM_CORNER_OFF;
            law.stations = 3;
        }
        gm_flanks *relieved = kind >= 4 ? make_relieved(kinds[kind].pinion_teeth, TIP, 5e-6) : NULL;
        driven d = {.offset = (double)NAN};
        GM_ASSERT_INT(make(&d.mesh, &kinds[kind], &law, relieved, NULL), GM_OK);
        const gm_pair *pair = &d.mesh.pair;

        /* A load per face width, and work to 3e-14 of what goes through. */
        d.load = 1e5 * pair->face_width * pair->wheel.base_radius;
        const double pitch = pair->pinion.pitch_angle;
        const double turned = pitch * pair->pinion.base_radius / pair->wheel.base_radius;
        const double most = 3e-14 * d.load * turned;
        const double longest = pitch / 256.0; /* a kink beside the last point goes unseen */

        /* Steps are halved until two formulas agree. */
        double work = 0.0, from = 0.0, to = longest;
        for (int steps = 0; from < pitch && steps < 20000; ++steps) {
            double error;
            const double part = pinion_work(&d, from, to, &error);
            const int is_fine = error < most || to - from < 1e-6 * pitch;
            work += is_fine ? part : 0.0;
            const double length = is_fine ? 2.0 * (to - from) : 0.5 * (to - from);
            from = is_fine ? to : from;
            to = fmin(from + fmin(length, longest), pitch);
        }
        GM_ASSERT_ABS(from, pitch, 0.0);

        /* The wheel comes one pitch further. */
        GM_ASSERT_REL(work, d.load * turned, 1e-10);
        release(&d.mesh);
        free(relieved);
    }
}

static void cache_holds_elastic_teeth(void) {
    const gm_pair_params gears = paper();
    gm_mesh_params law = elastic_law();
    law.corner_contact = GM_CORNER_OFF;
    elastic_mesh m;
    GM_ASSERT_INT(make(&m, &gears, &law, NULL, NULL), GM_OK);
    gm_cache_params params;
    gm_cache_errors errors;
    gm_cache *cache;
    gm_cache_params_default(&params);
    const size_t size = gm_cache_size(&params, m.mesh);
    void *const memory = malloc(size);
    GM_ASSERT_INT(gm_cache_init(&cache, &params, m.mesh, memory, size), GM_OK);
    GM_ASSERT_INT(gm_cache_error(cache, 300, 5, m.workspace, &errors), GM_OK);
    GM_ASSERT(errors.sum_largest < 5e-3 * params.depth);
    GM_ASSERT(errors.contact_largest < 0.05);

    /* And answers for the mesh. */
    const gm_state state = pressed_state(&m, 0.2, 4e-6);
    const gm_mesh_result exact = evaluate(&m, &state, GM_WANT_DERIVATIVES);
    GM_ASSERT_INT(gm_mesh_use_cache(m.mesh, cache), GM_OK);
    const gm_mesh_result held = evaluate(&m, &state, GM_WANT_DERIVATIVES);
    GM_ASSERT_REL(held.force, exact.force, 1e-3);
    GM_ASSERT_REL(held.force_by.wheel_angle, exact.force_by.wheel_angle, 3e-2);
    GM_ASSERT(held.force != exact.force);

    /* Not for the energy, which the teeth alone know. */
    const gm_mesh_result asked = evaluate(&m, &state, GM_WANT_ENERGY);
    GM_ASSERT_REL(asked.force, exact.force, 1e-9);
    GM_ASSERT_REL(asked.energy, 0.5 * asked.force * asked.contact.penetration, 0.5);
    release(&m);
    free(memory);
}

/* Teeth of a different stiffness have columns of their own, whichever gear they belong to. */
static void cache_knows_the_softer_teeth(void) {
    const gm_pair_params gears = paper();
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        gm_test_context("gear %d", role);
        const int teeth = role == GM_PINION ? gears.pinion_teeth : gears.wheel_teeth;
        double factors[100];
        for (int tooth = 0; tooth < teeth; ++tooth) {
            factors[tooth] = tooth == 2 ? 0.5 : 1.0;
        }

        /* One soft tooth: a table for each tooth of its gear. */
        gm_mesh_params law = elastic_law();
        law.corner_contact = GM_CORNER_OFF;
        *(role == GM_PINION ? &law.pinion_tooth_stiffness : &law.wheel_tooth_stiffness) = factors;
        elastic_mesh m;
        GM_ASSERT_INT(make(&m, &gears, &law, NULL, NULL), GM_OK);

        gm_cache_params params;
        gm_cache *cache;
        gm_cache_params_default(&params);
        const size_t size = gm_cache_size(&params, m.mesh);
        void *memory = malloc(size);
        GM_ASSERT_INT(gm_cache_init(&cache, &params, m.mesh, memory, size), GM_OK);
        GM_ASSERT_INT(gm_cache_passes(cache), teeth);

        /* Wherever the soft tooth is, as without the cache. */
        const double pitch = 6.283185307179586 / gears.pinion_teeth;
        double force[100], softest = HUGE_VAL, stiffest = 0.0;
        for (int tooth = 0; tooth < teeth; ++tooth) {
            const gm_state state = pressed_state(&m, (tooth + 0.1) * pitch, 4e-6);
            force[tooth] = evaluate(&m, &state, GM_WANT_FORCE).force;
            softest = fmin(softest, force[tooth]);
            stiffest = fmax(stiffest, force[tooth]);
        }
        GM_ASSERT(softest < 0.97 * stiffest);
        GM_ASSERT_INT(gm_mesh_use_cache(m.mesh, cache), GM_OK);
        for (int tooth = 0; tooth < teeth; ++tooth) {
            const gm_state state = pressed_state(&m, (tooth + 0.1) * pitch, 4e-6);
            GM_ASSERT_REL(evaluate(&m, &state, GM_WANT_FORCE).force, force[tooth], 1e-3);
        }
        release(&m);
        free(memory);
    }
}

static void wrench_acts_where_the_load_is(void) {
    const gm_pair_params gears = spur62();
    gm_mesh_params law = elastic_law();
    elastic_mesh even, skewed;
    GM_ASSERT_INT(make(&even, &gears, &law, NULL, NULL), GM_OK);
    law.pose.inclination = 2e-4;
    GM_ASSERT_INT(make(&skewed, &gears, &law, NULL, NULL), GM_OK);
    const gm_state state = pressed_state(&even, 0.01, 4e-6);
    const gm_mesh_result a = evaluate(&even, &state, GM_WANT_WRENCH);
    const gm_mesh_result b = evaluate(&skewed, &state, GM_WANT_WRENCH);

    /* At mid-face; and beside it where the axes lean. The turning moment is F r_bw. */
    const double middle = a.wrench.wheel_moment[1] / a.wrench.wheel_force[0];
    const double beside = b.wrench.wheel_moment[1] / b.wrench.wheel_force[0];
    GM_ASSERT_REL(middle, 0.5 * gears.face_width, 1e-9);
    GM_ASSERT(fabs(beside - middle) > 0.02 * gears.face_width);
    GM_ASSERT_REL(a.wrench.wheel_moment[2], -a.force * even.pair.wheel.base_radius, 1e-12);
    release(&even);
    release(&skewed);

    /* Damping acts where the stiffness is: a little speed as a little more approach, moments too. */
    law.damping = 800.0;
    elastic_mesh damped;
    GM_ASSERT_INT(make(&damped, &gears, &law, NULL, NULL), GM_OK);
    const double relaxation =
        gm_mesh_mean_damping(damped.mesh) / gm_mesh_mean_stiffness(damped.mesh);
    const double more = 2e-9;
    const gm_state pressed = pressed_state(&damped, 0.01, 4e-6 + more);
    gm_state moving = state;
    moving.pinion_speed = more / relaxation / damped.pair.pinion.base_radius;
    const gm_mesh_result still = evaluate(&damped, &state, GM_WANT_WRENCH);
    const gm_mesh_result by_approach = evaluate(&damped, &pressed, GM_WANT_WRENCH);
    const gm_mesh_result by_speed = evaluate(&damped, &moving, GM_WANT_WRENCH);
    for (int axis = 0; axis < 3; ++axis) {
        GM_ASSERT_REL(by_speed.wrench.wheel_moment[axis] - still.wrench.wheel_moment[axis],
                      by_approach.wrench.wheel_moment[axis] - still.wrench.wheel_moment[axis],
                      2e-3);
    }
    release(&damped);
}

/* Line loads at stations and ends add up to the force, and follow from Hertz what the pressure is. */
static void line_loads_are_the_force(void) {
    const gm_pair_params gears = spur62();
    gm_mesh_params law = elastic_law();
    law.pose.inclination = 2e-4;
    for (int k = 0; k < 2; ++k) {
        law.law = k == 0 ? GM_LAW_ELASTIC : GM_LAW_CONSTANT;
        law.stiffness = 2.8e8;
        elastic_mesh m;
        memset(&m, 0, sizeof m);
        if (k == 0) {
            GM_ASSERT_INT(make(&m, &gears, &law, NULL, NULL), GM_OK);
        } else {
            GM_ASSERT_INT(gm_pair_init(&m.pair, &gears), GM_OK);
            const size_t size = gm_mesh_size(&law, &m.pair);
            m.mesh_memory = malloc(size);
            GM_ASSERT_INT(gm_mesh_init(&m.mesh, &law, &m.pair, NULL, NULL, m.mesh_memory, size),
                          GM_OK);
        }

        const gm_state state = pressed_state(&m, 0.01, 6e-6);
        const gm_mesh_result r = evaluate(&m, &state, GM_WANT_FORCE);

        gm_position position;
        GM_ASSERT_INT(gm_position_from_state(&m.pair, &state, &position), GM_OK);
        gm_line_load_point points[400];
        gm_line_loads loads;
        GM_ASSERT(gm_mesh_line_load_points(m.mesh) <= 400);
        position.pinion_speed = 30.0;
        GM_ASSERT_INT(gm_mesh_line_loads(m.mesh, &position, m.workspace, points, 400, &loads),
                      GM_OK);

        /* Two pairs on 17 stations. */
        GM_ASSERT_INT(loads.points, 34);
        double force = 0.0, largest = 0.0;
        for (int n = 0; n < loads.points; ++n) {
            const gm_line_load_point *p = &points[n];
            const int is_end = n % 17 == 0 || n % 17 == 16;
            force += p->line_load * gears.face_width / 16.0 * (is_end ? 0.5 : 1.0);
            largest = fmax(largest, p->line_load);

            GM_ASSERT_INT(p->side, GM_DRIVE);
            GM_ASSERT_REL(p->pinion_roll_length + p->wheel_roll_length, m.pair.line_of_action,
                          k == 0 ? 1e-12 : 1e-3);
            GM_ASSERT((p->gap < 0.0) == (p->line_load > 0.0));

            const gm_gear *pinion = &m.pair.pinion, *wheel = &m.pair.wheel;
            const double both = 30.0 * (1.0 + pinion->base_radius / wheel->base_radius);
            const double pitch_point = pinion->base_radius * tan(m.pair.working_pressure_angle);
            GM_ASSERT_ABS(p->sliding_speed, both * (p->pinion_roll_length - pitch_point), 1e-12);

            const double radius = p->pinion_roll_length * p->wheel_roll_length /
                                  (p->pinion_roll_length + p->wheel_roll_length);
            GM_ASSERT_REL(p->pressure,
                          sqrt(p->line_load * 206e9 / (2.0 * 0.91) / (3.14159265358979 * radius)),
                          1e-9);
        }

        GM_ASSERT_REL(force, r.force, 2e-3);

        /* With constant stiffness the lines end where the tilted face does: some 2e-4 radii before the last station. */
        const double moved = k == 0 ? 0.0 : 2e-4 * m.pair.wheel.tip_radius / gears.face_width;
        GM_ASSERT_REL(loads.largest_line_load, largest, 1e-12 + moved);
        GM_ASSERT_REL(loads.face_load_factor, largest * 2.0 * gears.face_width / r.force,
                      1e-9 + 2.0 * moved);
        GM_ASSERT_REL(loads.touching_width, 2.0 * gears.face_width, k == 0 ? 1e-9 : 1e-3);

        /* Without points, and with too little room. */
        gm_line_loads again;
        GM_ASSERT_INT(gm_mesh_line_loads(m.mesh, &position, m.workspace, NULL, 0, &again), GM_OK);
        GM_ASSERT_REL(again.largest_pressure, loads.largest_pressure, 1e-6);
        GM_ASSERT_INT(gm_mesh_line_loads(m.mesh, &position, m.workspace, points, 33, &again),
                      GM_ERR_MEMORY);
        GM_ASSERT_NAN(again.largest_line_load);
        GM_ASSERT_INT(gm_mesh_line_loads(NULL, &position, m.workspace, points, 400, &again),
                      GM_ERR_NULL);
        position.offset = (double)NAN;
        GM_ASSERT_INT(gm_mesh_line_loads(m.mesh, &position, m.workspace, points, 400, &again),
                      GM_STATE_NOT_FINITE);
        GM_ASSERT_NAN(again.face_load_factor);

        release(&m);
    }
}

/* Pressures beyond 10 GPa, and teeth of a ring. */
static void doubtful_loads_are_told(void) {
    const gm_pair_params gears[2] = {spur62(), ring()};
    for (int k = 0; k < 2; ++k) {
        const gm_mesh_params law = elastic_law();
        elastic_mesh m;
        GM_ASSERT_INT(make(&m, &gears[k], &law, NULL, NULL), GM_OK);

        /* A light load, and one beyond what any material bears. */
        const double press[2] = {1e-3, 0.3}; /* in modules */
        int told[2];
        for (int n = 0; n < 2; ++n) {
            const double offset = 0.5 * m.pair.backlash + press[n] * m.pair.normal_module;
            const gm_state state = pressed_state(&m, 0.01, offset);
            gm_position position;
            gm_line_loads loads;
            GM_ASSERT_INT(gm_position_from_state(&m.pair, &state, &position), GM_OK);
            GM_ASSERT_INT(gm_mesh_line_loads(m.mesh, &position, m.workspace, NULL, 0, &loads),
                          GM_OK);
            told[n] = loads.warnings & GM_WARN_LOAD_PRESSURE;
            GM_ASSERT_INT(told[n] != 0, loads.largest_pressure > 10e9);
            GM_ASSERT_INT(loads.warnings & ~GM_WARN_LOAD_PRESSURE, k == 1 ? GM_WARN_LOAD_RING : 0);
        }
        GM_ASSERT(told[0] == 0 && told[1] != 0);

        /* None without a load. */
        const gm_state apart = pressed_state(&m, 0.01, -1e-6);
        gm_position position;
        gm_line_loads loads;
        GM_ASSERT_INT(gm_position_from_state(&m.pair, &apart, &position), GM_OK);
        GM_ASSERT_INT(gm_mesh_line_loads(m.mesh, &position, m.workspace, NULL, 0, &loads), GM_OK);
        GM_ASSERT_INT(loads.warnings, 0);
        release(&m);
    }
}

/* A path so short that no position of the mean stiffness is on it: there is none to go by. */
static void teeth_that_hardly_reach_each_other_are_refused(void) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = params.wheel_teeth = 30;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = 0.3490658503988659;
    params.center_distance = 60e-3;
    params.face_width = 10e-3;
    gm_pair pair;
    double tip_alteration = -0.5;
    do {
        params.pinion_tip_alteration = params.wheel_tip_alteration = tip_alteration;
        GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);
        tip_alteration -= 1e-3;
    } while (pair.transverse_contact_ratio > 0.01);
    GM_ASSERT(pair.transverse_contact_ratio > 0.0);

    gm_mesh_params law = elastic_law();
    law.corner_contact = GM_CORNER_OFF;
    const size_t size = gm_mesh_size(&law, &pair);
    void *memory = malloc(size);
    gm_mesh *mesh = NULL;
    GM_ASSERT(size > 0);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, size), GM_ERR_GEOMETRY);
    GM_ASSERT(mesh == NULL);
    free(memory);
}

/* ---------------------------------------------------------------------------------------------
 * Bad input
 * ------------------------------------------------------------------------------------------- */

static void workspaces_that_are_too_small_are_refused(void) {
    const gm_pair_params gears = spur62();
    const gm_mesh_params law = elastic_law();
    elastic_mesh m;
    GM_ASSERT_INT(make(&m, &gears, &law, NULL, NULL), GM_OK);

    /* None at all. */
    gm_mesh_result r;
    const gm_state state = pressed_state(&m, 0.01, 4e-6);
    GM_ASSERT_INT(gm_mesh_evaluate(m.mesh, &state, GM_WANT_FORCE, NULL, &r), GM_ERR_NULL);
    GM_ASSERT_NAN(r.force);

    gm_workspace *workspace;
    const size_t room = gm_workspace_size(m.mesh);
    GM_ASSERT_INT(gm_workspace_init(&workspace, m.mesh, m.workspace_memory, room - 1),
                  GM_ERR_MEMORY);
    GM_ASSERT_INT(gm_workspace_init(&workspace, m.mesh, NULL, room), GM_ERR_NULL);
    GM_ASSERT_INT(gm_workspace_init(&workspace, NULL, m.workspace_memory, room), GM_ERR_NULL);
    release(&m);
}

/* What is missing, of other gears, or less than none. */
static void changes_of_flanks_that_cannot_be_are_refused(void) {
    const gm_pair_params gears = spur62();
    const gm_mesh_params law = elastic_law();
    elastic_mesh m;
    gm_position position;
    GM_ASSERT_INT(make(&m, &gears, &law, NULL, NULL), GM_OK);
    const gm_state state = pressed_state(&m, 0.01, 4e-6);
    GM_ASSERT_INT(gm_position_from_state(&m.pair, &state, &position), GM_OK);

    /* Flanks of a pinion with one tooth less. */
    uint64_t seed = 3u;
    gm_pair_params other_gears = spur62();
    other_gears.pinion_teeth = 61;
    other_gears.center_distance = 123e-3;
    gm_pair other;
    GM_ASSERT_INT(gm_pair_init(&other, &other_gears), GM_OK);
    random_flanks flanks;
    random_flanks_make(&flanks, &seed, &other, 0, 1e-6);

    /* No change is one of no force. */
    const gm_flanks *none[1] = {NULL}, *others[1] = {flanks.flanks};
    double by = 1.0;
    GM_ASSERT_INT(gm_mesh_force_by_flanks(m.mesh, &position, none, none, 1, m.workspace, &by),
                  GM_OK);
    GM_ASSERT(by == 0.0);

    GM_ASSERT_INT(gm_mesh_force_by_flanks(m.mesh, &position, others, none, 1, m.workspace, &by),
                  GM_ERR_TOOTH);
    GM_ASSERT_NAN(by);
    by = 1.0;
    GM_ASSERT_INT(gm_mesh_force_by_flanks(m.mesh, &position, none, none, 1, NULL, &by),
                  GM_ERR_NULL);
    GM_ASSERT_NAN(by);

    GM_ASSERT_INT(gm_mesh_force_by_flanks(m.mesh, &position, NULL, none, 1, m.workspace, &by),
                  GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_force_by_flanks(m.mesh, &position, none, none, 1, m.workspace, NULL),
                  GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_force_by_flanks(m.mesh, &position, NULL, NULL, -1, m.workspace, &by),
                  GM_ERR_PARAMETER);
    random_flanks_free(&flanks);
    release(&m);
}

static void parameters_out_of_range_are_named(void) {
    const struct {
        const char *field;
        size_t place;
        double value;
    } wrong[] = {
        {"pinion_youngs_modulus", offsetof(gm_mesh_params, pinion_youngs_modulus), 0.0},
        {"wheel_youngs_modulus", offsetof(gm_mesh_params, wheel_youngs_modulus), (double)NAN},
        {"pinion_poisson_ratio", offsetof(gm_mesh_params, pinion_poisson_ratio), 0.5},
        {"wheel_poisson_ratio", offsetof(gm_mesh_params, wheel_poisson_ratio), -0.1},
        {"pinion_bore_radius", offsetof(gm_mesh_params, pinion_bore_radius), 0.0},
        {"wheel_bore_radius", offsetof(gm_mesh_params, wheel_bore_radius), -1.0},
        {"reference_torque", offsetof(gm_mesh_params, reference_torque), 0.0},
    };
    gm_mesh_params law;
    const char *field;
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; ++k) {
        law = elastic_law();
        memcpy((char *)&law + wrong[k].place, &wrong[k].value, sizeof wrong[k].value);
        GM_ASSERT_INT(gm_mesh_params_check(&law, &field, NULL), GM_ERR_PARAMETER);
        GM_ASSERT_STRING(field, wrong[k].field);
    }

    /* Fewer than two have no element; 0 is the default. */
    const int wrong_stations[] = {-1, 1, 98};
    for (size_t k = 0; k < sizeof wrong_stations / sizeof wrong_stations[0]; ++k) {
        law = elastic_law();
        law.stations = wrong_stations[k];
        GM_ASSERT_INT(gm_mesh_params_check(&law, &field, NULL), GM_ERR_PARAMETER);
        GM_ASSERT_STRING(field, "stations");
    }
}

static void teeth_need_their_memory(void) {
    const gm_pair_params gears = spur62();
    const gm_mesh_params law = elastic_law();
    gm_pair pair;
    GM_ASSERT_INT(gm_pair_init(&pair, &gears), GM_OK);
    const size_t size = gm_mesh_size(&law, &pair);
    double *const memory = malloc(size);

    const char *field;
    gm_mesh *mesh;
    GM_ASSERT_INT(gm_mesh_check_teeth(&law, &pair, NULL, NULL, memory, size), GM_OK);
    GM_ASSERT_INT(gm_mesh_check_teeth(&law, &pair, &field, NULL, NULL, size), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_check_teeth(NULL, &pair, &field, NULL, memory, size), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_check_teeth(&law, &pair, &field, NULL, memory, size - 1), GM_ERR_MEMORY);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, size - 1), GM_ERR_MEMORY);
    free(memory);
}

/* What belongs to elastic teeth is refused to a constant stiffness, which needs no workspace. */
static void other_laws_have_no_elastic_teeth(void) {
    const gm_pair_params gears = spur62();
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.law = GM_LAW_CONSTANT;
    law.stiffness = 1e8;
    gm_pair pair;
    gm_mesh *mesh;
    GM_ASSERT_INT(gm_pair_init(&pair, &gears), GM_OK);
    double memory[512];
    const char *field;
    GM_ASSERT_INT(gm_mesh_check_teeth(&law, &pair, &field, NULL, memory, sizeof memory),
                  GM_ERR_PARAMETER);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, sizeof memory), GM_OK);

    gm_workspace *workspace;
    GM_ASSERT(gm_workspace_size(mesh) == 0 && gm_workspace_size(NULL) == 0);
    GM_ASSERT_INT(gm_workspace_init(&workspace, mesh, NULL, 0), GM_OK);
    GM_ASSERT(workspace == NULL);
    GM_ASSERT_INT(gm_workspace_init(NULL, mesh, NULL, 0), GM_ERR_NULL);

    gm_mesh_stiffness stiffness;
    GM_ASSERT_INT(gm_mesh_elastic_stiffness(mesh, &stiffness), GM_ERR_PARAMETER);
    GM_ASSERT_NAN(stiffness.mesh_mean);
    GM_ASSERT_INT(gm_mesh_elastic_stiffness(NULL, &stiffness), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_elastic_stiffness(mesh, NULL), GM_ERR_NULL);
}

/* The simple model has the mean stiffness of elastic teeth, and neither lines nor a workspace. */
static void the_simple_model_is_as_stiff_and_has_no_lines(void) {
    const gm_pair_params gears = spur62();
    gm_mesh_params law = elastic_law();
    law.model = GM_MODEL_SIMPLE;
    gm_pair pair;
    gm_mesh *mesh;
    GM_ASSERT_INT(gm_pair_init(&pair, &gears), GM_OK);
    const size_t size = gm_mesh_size(&law, &pair);
    double *const memory = malloc(size);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, size), GM_OK);

    gm_mesh_stiffness stiffness;
    GM_ASSERT_INT(gm_mesh_elastic_stiffness(mesh, &stiffness), GM_OK);
    GM_ASSERT_REL(gm_mesh_mean_stiffness(mesh), stiffness.mesh_mean, 1e-12);

    gm_mesh_result r;
    const gm_position somewhere = {0, 0, 0.0, 1e-6, 0.0, 0.0};
    GM_ASSERT(gm_workspace_size(mesh) == 0);
    GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &somewhere, GM_WANT_FORCE, NULL, &r), GM_OK);

    gm_line_loads loads;
    GM_ASSERT_INT(gm_mesh_line_loads(mesh, &somewhere, NULL, NULL, 0, &loads), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_line_loads(mesh, NULL, NULL, NULL, 0, &loads), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_line_loads(mesh, &somewhere, NULL, NULL, 0, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_line_load_points(NULL), 0);
    free(memory);
}

/* Factors of single teeth, a pose out of mesh, and more lines than there is room for. */
static void teeth_poses_and_faces_out_of_range_are_refused(void) {
    const gm_pair_params gears = spur62();
    gm_mesh_params law = elastic_law();
    gm_pair pair;
    GM_ASSERT_INT(gm_pair_init(&pair, &gears), GM_OK);
    const size_t size = gm_mesh_size(&law, &pair);
    double *const memory = malloc(size);

    const char *field;
    double factors[62];
    for (int k = 0; k < 62; ++k) {
        factors[k] = k == 61 ? 101.0 : 1.0;
    }
    law.wheel_tooth_stiffness = factors;
    GM_ASSERT_INT(gm_mesh_check_teeth(&law, &pair, &field, NULL, memory, size), GM_ERR_GEOMETRY);
    GM_ASSERT_STRING(field, "wheel_tooth_stiffness");

    gm_mesh *mesh;
    law.wheel_tooth_stiffness = NULL;
    law.pose.axial_shift = 1.0;
    GM_ASSERT_INT(gm_mesh_check_teeth(&law, &pair, &field, NULL, memory, size),
                  GM_POSE_OUT_OF_MESH);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, size), GM_POSE_OUT_OF_MESH);
    free(memory);

    gm_pair_params wide = paper();
    wide.face_width = 0.2;
    law = elastic_law();
    GM_ASSERT_INT(gm_pair_init(&pair, &wide), GM_OK);
    GM_ASSERT(gm_mesh_size(&law, &pair) == 0);
    double little[8];
    GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, little, sizeof little),
                  GM_ERR_GEOMETRY);
}

/* No fillet, a bore in the rim, few teeth that are undercut; of a ring a bore, and a rack that is too short. */
static void teeth_outside_the_model_are_refused(void) {
    gm_pair_params deep = spur62(), few = spur62(), short_ring = ring();
    deep.wheel_rack_dedendum = 1.75;
    few.pinion_teeth = 12;
    few.center_distance = 74e-3;
    short_ring.wheel_rack_dedendum = 0.6;

    const gm_pair_params cases[] = {deep, spur62(), few, ring(), short_ring};
    const char *const fields[] = {"wheel_rack_fillet_radius", "pinion_bore_radius",
                                  "pinion_profile_shift", "wheel_bore_radius",
                                  "wheel_start_radius"};
    for (int k = 0; k < 5; ++k) {
        gm_mesh_params law = elastic_law();
        law.pinion_bore_radius = k == 1 ? 61e-3 : (double)NAN;
        law.wheel_bore_radius = k == 3 ? 61e-3 : (double)NAN;
        gm_pair pair;
        GM_ASSERT_INT(gm_pair_init(&pair, &cases[k]), GM_OK);

        gm_mesh *mesh;
        const size_t size = gm_mesh_size(&law, &pair);
        void *const memory = malloc(size);
        GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, size), GM_ERR_GEOMETRY);
        GM_ASSERT(mesh == NULL);

        const char *field, *requirement;
        GM_ASSERT_INT(gm_mesh_check_teeth(&law, &pair, &field, &requirement, memory, size),
                      GM_ERR_GEOMETRY);
        GM_ASSERT_STRING(field, fields[k]);
        GM_ASSERT(requirement != NULL);
        free(memory);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(check_values_are_met),
        GM_TEST(derivatives_are_those_of_differences),
        GM_TEST(force_by_flanks_is_that_of_differences),
        GM_TEST(force_by_flanks_and_pairs_know_the_pose),
        GM_TEST(vectors_of_four_give_the_same_bits),
        GM_TEST(roll_at_held_approach_is_differentiated_exactly),
        GM_TEST(torques_are_the_slopes_of_the_energy),
        GM_TEST(energy_is_kept_around_closed_paths),
        GM_TEST(coast_is_drive_in_a_mirror),
        GM_TEST(answer_does_not_depend_on_the_one_before),
        GM_TEST(even_material_is_approach),
        GM_TEST(force_by_flanks_is_that_of_fine_differences),
        GM_TEST(teeth_without_a_table_are_as_drawn),
        GM_TEST(bodies_wind_up_in_series),
        GM_TEST(soft_tooth_is_softer_in_mesh_alone),
        GM_TEST(damping_follows_the_stiffness),
        GM_TEST(stiffness_is_that_at_the_reference_torque),
        GM_TEST(force_of_spur_gears_is_smooth),
        GM_TEST(tilted_edges_carry_light_loads),
        GM_TEST(stations_follow_from_the_pair),
        GM_TEST(few_stations_are_enough_for_edges),
        GM_TEST(stations_follow_from_the_flanks),
        GM_TEST(reliefs_leave_0_4_percent),
        GM_TEST(few_stations_find_the_pressure_of_edges),
        GM_TEST(edges_and_reliefs_keep_the_energy),
        GM_TEST(cache_holds_elastic_teeth),
        GM_TEST(cache_knows_the_softer_teeth),
        GM_TEST(wrench_acts_where_the_load_is),
        GM_TEST(line_loads_are_the_force),
        GM_TEST(doubtful_loads_are_told),
        GM_TEST(teeth_that_hardly_reach_each_other_are_refused),
        GM_TEST(workspaces_that_are_too_small_are_refused),
        GM_TEST(changes_of_flanks_that_cannot_be_are_refused),
        GM_TEST(parameters_out_of_range_are_named),
        GM_TEST(teeth_need_their_memory),
        GM_TEST(other_laws_have_no_elastic_teeth),
        GM_TEST(the_simple_model_is_as_stiff_and_has_no_lines),
        GM_TEST(teeth_poses_and_faces_out_of_range_are_refused),
        GM_TEST(teeth_outside_the_model_are_refused),
    };
    return gm_test_main("unit.elastic_mesh", tests, GM_TEST_COUNT(tests), argc, argv);
}
