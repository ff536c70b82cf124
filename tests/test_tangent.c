/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The exact tangent against differences of the evaluation; power between axes that tilt. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "random_gears.h"
#include "reference_gear.h"

enum { WRENCH = 12, VALUES = 1 + WRENCH, ALL = 2 * GM_COORDINATES };

static double *pose_place(gm_pose *pose, int coordinate) {
    double *const places[GM_COORDINATES] = {[GM_CENTER_DISTANCE_CHANGE] =
                                                &pose->center_distance_change,
                                            [GM_OFFSET] = &pose->offset,
                                            [GM_AXIAL_SHIFT] = &pose->axial_shift,
                                            [GM_SKEW] = &pose->skew,
                                            [GM_INCLINATION] = &pose->inclination};
    return places[coordinate];
}

/* Moves one of the seven coordinates, or behind them one of their rates. */
static gm_motion moved(const gm_pair *pair, const gm_motion *motion, int which, double by) {
    gm_motion result = *motion;
    const int is_rate = which >= GM_COORDINATES;
    const int coordinate = which % GM_COORDINATES;
    const double r_bp = pair->pinion.base_radius, r_bw = pair->wheel.base_radius;
    if (coordinate == GM_PINION_ANGLE || coordinate == GM_WHEEL_ANGLE) {
        const double arc = coordinate == GM_PINION_ANGLE ? r_bp * by : -r_bw * by;
        if (is_rate) {
            result.position.offset_rate += arc;
            result.position.pinion_speed += coordinate == GM_PINION_ANGLE ? by : 0.0;
        } else {
            result.position.offset += arc;
            result.position.phase += coordinate == GM_PINION_ANGLE ? arc : 0.0;
        }
    } else {
        *pose_place(is_rate ? &result.pose_rate : &result.pose, coordinate) += by;
    }
    return result;
}

static void pack(const gm_wrench *wrench, double force, double values[VALUES]) {
    values[0] = force;
    for (int k = 0; k < 3; ++k) {
        values[1 + k] = wrench->pinion_force[k];
        values[4 + k] = wrench->pinion_moment[k];
        values[7 + k] = wrench->wheel_force[k];
        values[10 + k] = wrench->wheel_moment[k];
    }
}

static int evaluate(const gm_mesh *mesh, const gm_motion *motion, double values[VALUES]) {
    gm_mesh_result r;
    const int status = gm_mesh_evaluate_posed(mesh, motion, GM_WANT_WRENCH, NULL, &r);
    pack(&r.wrench, r.force, values);
    return status;
}

static void difference(const gm_mesh *mesh, const gm_motion *motion, int which, double h,
                       double by[VALUES], int *status) {
    static const double place[4] = {-2.0, -1.0, 1.0, 2.0};
    static const double weight[4] = {1.0 / 12.0, -2.0 / 3.0, 2.0 / 3.0, -1.0 / 12.0};
    for (int k = 0; k < VALUES; ++k) {
        by[k] = 0.0;
    }
    for (int i = 0; i < 4; ++i) {
        double values[VALUES];
        const gm_motion there = moved(gm_mesh_pair(mesh), motion, which, place[i] * h);
        *status |= evaluate(mesh, &there, values);
        for (int k = 0; k < VALUES; ++k) {
            by[k] += weight[i] / h * values[k];
        }
    }
}

/* All three laws of friction; v0 such that the coefficient bends where flanks slide. */
static void add_friction(uint64_t *seed, int i, gm_mesh_params *law) {
    law->friction_law = i % 3;
    law->friction_coefficient = 0.1;
    law->friction_speed = gm_test_uniform(seed, 0.01, 0.2);
    law->oil_viscosity = 0.01;
    law->roughness = 1e-6;
}

/* What a mesh has beside stiffness and damping. */
enum kind { PLAIN, SLIDING, CORNERS, SLIDING_CORNERS };

/* In contact for the most part; damped in every other case, and simple in some. */
static int random_motion(const random_case *c, uint64_t *seed, int i, double tilt, enum kind kind,
                         gm_mesh **mesh, plain_mesh *room, gm_motion *motion) {
    const gm_pair *pair = &c->pair;
    const double m = pair->normal_module;
    const int may_be_parallel =
        c->use[0] == NULL && c->use[1] == NULL &&
        (kind < CORNERS || pair->face_advance != 0.0); /* a gap that is the same all along a line */
    const double tilted = i % 8 == 0 && may_be_parallel
                              ? 0.0 /* else a kink: tilted tables end where parallel ones do */
                              : tilt * pair->transverse_base_pitch / pair->face_width;
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = 1e8;
    law.damping = i % 2 == 0 ? 0.0 : 1e5;
    law.model = i % 11 == 0 && kind < CORNERS ? GM_MODEL_SIMPLE : GM_MODEL_3D;
    law.corner_contact = kind >= CORNERS ? GM_CORNER_ON : GM_CORNER_OFF;
    if (kind == SLIDING || kind == SLIDING_CORNERS) {
        add_friction(seed, i, &law);
    }
    const int status =
        gm_mesh_init(mesh, &law, pair, c->use[0], c->use[1], room->memory, sizeof room->memory);

    motion->pose =
        (gm_pose){gm_test_uniform(seed, -0.01, 0.01) * m, gm_test_uniform(seed, -0.01, 0.01) * m,
                  gm_test_uniform(seed, -0.05, 0.05) * m, gm_test_uniform(seed, -tilted, tilted),
                  gm_test_uniform(seed, -tilted, tilted)};

    /* Some axes as drawn: without tables, which would have a kink there. */
    if (i % 4 == 0 && may_be_parallel) {
        motion->pose.center_distance_change = motion->pose.offset = 0.0;
    }
    const double v = i % 3 == 0 ? 0.0 : 1e-3 * m;
    motion->pose_rate =
        (gm_pose){gm_test_uniform(seed, -v, v), gm_test_uniform(seed, -v, v),
                  gm_test_uniform(seed, -v, v), gm_test_uniform(seed, -v, v) / pair->face_width,
                  gm_test_uniform(seed, -v, v) / pair->face_width};
    const double side = i % 5 == 0 ? -1.0 : 1.0;
    const double x = side * (0.5 * pair->backlash + gm_test_uniform(seed, 0.0, 12e-3) * m);
    (void)gm_position_from_pinion_angle(pair, gm_test_uniform(seed, 0.0, 6.0), x,
                                        gm_test_uniform(seed, -1e-3, 1e-3) * m, &motion->position);
    if (kind == SLIDING || kind == SLIDING_CORNERS) { /* either way round, and next to rest */
        const double fastest = i % 7 == 0 ? 0.1 : 100.0;
        motion->position.pinion_speed =
            gm_test_uniform(seed, -fastest, fastest) * 0.1 / pair->center_distance;
    }
    return status;
}

/*
 * Differences of fourth order with two steps: where they disagree there is a kink between, or the law of another cell. The
 * tolerance is 1e-7 of the largest derivative of the same kind over the sizes of the gears, and what is left of 16 digits.
 */
static void compare_with_differences(const gm_mesh *mesh, const gm_motion *motion,
                                     const gm_tangent *tangent, int i, int *compared, int *kinks) {
    const gm_pair *pair = gm_mesh_pair(mesh);
    const double m = pair->normal_module;
    for (int which = 0; which < ALL; ++which) {
        const int q = which % GM_COORDINATES;
        const int is_rate = which >= GM_COORDINATES;
        const int is_turn = q == GM_PINION_ANGLE || q == GM_WHEEL_ANGLE;
        const double arm = q >= GM_SKEW ? pair->face_width + pair->center_distance
                           : is_turn    ? pair->center_distance
                                        : 1.0;
        const double h = (is_rate ? 1e-4 : 2e-6) * m / arm;
        double exact[VALUES], coarse[VALUES], fine[VALUES];
        int status = GM_OK;
        pack(is_rate ? &tangent->wrench_by_rate[q] : &tangent->wrench_by[q],
             is_rate ? tangent->force_by_rate[q] : tangent->force_by[q], exact);
        difference(mesh, motion, which, h, coarse, &status);
        difference(mesh, motion, which, 0.4 * h, fine, &status);
        for (int k = 0; k < VALUES && status == GM_OK; ++k) {
            const int is_moment = k > 0 && (k - 1) / 3 % 2 == 1;
            const double lever = is_moment ? pair->center_distance + pair->face_width : 1.0;
            const double size = (is_rate ? 1e5 : 1e8) * arm * lever;
            const double rounding = 1e-15 * 1e8 * pair->center_distance * lever / h;
            if (fabs(coarse[k] - fine[k]) > 3e-8 * size + 4.0 * rounding) {
                ++*kinks;
                continue;
            }
            ++*compared;
            gm_test_context("case %d, value %d by %d", i, k, which);
            GM_ASSERT_ABS(exact[k], fine[k], 1e-7 * size + 10.0 * rounding);
        }
    }
}

/* Returns how many motions were compared. */
static int compare_random_tangents(uint64_t seed, int cases, enum kind kind) {
    int compared = 0, kinks = 0, motions = 0;
    for (int i = 0; i < cases; ++i) {
        random_case c;
        plain_mesh room;
        gm_mesh *mesh;
        gm_motion motion;
        gm_tangent tangent;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        double here[VALUES];
        if (random_motion(&c, &seed, i, 0.02, kind, &mesh, &room, &motion) == GM_OK &&
            evaluate(mesh, &motion, here) == GM_OK && here[0] != 0.0 &&
            GM_ASSERT_INT(gm_mesh_tangent(mesh, &motion, &tangent), GM_OK)) {
            compare_with_differences(mesh, &motion, &tangent, i, &compared, &kinks);
            ++motions;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases: %d compared, %d kinks", compared, kinks);
    GM_ASSERT(compared > 66 * cases);
    GM_ASSERT(kinks < compared / 10);
    return motions;
}

static void tangent_is_that_of_differences(void) {
    GM_ASSERT(compare_random_tangents(UINT64_C(301), 300, PLAIN) > 200);
}

static void tangent_with_friction_is_that_of_differences(void) {
    GM_ASSERT(compare_random_tangents(UINT64_C(303), 300, SLIDING) > 200);
}

/* Lines that go on beyond the path, where tip corners touch: normals turn, arms are others. */
static void tangent_with_corners_is_that_of_differences(void) {
    GM_ASSERT(compare_random_tangents(UINT64_C(306), 240, CORNERS) > 200);
}

/* And rub: at a tip across the turned normal, with longer arms. One presses as it goes off the mate's flank. */
static void tangent_with_rubbing_corners_is_that_of_differences(void) {
    GM_ASSERT(compare_random_tangents(UINT64_C(336), 80, SLIDING_CORNERS) > 60);
}

/* The wrench from sums over pieces, and from the tangent; 1 where it is there and not 0. */
static int compare_walks(const gm_mesh *mesh, const gm_motion *motion) {
    const gm_pair *pair = gm_mesh_pair(mesh);
    gm_mesh_result pieces, stretches;
    if (gm_mesh_evaluate_posed(mesh, motion, GM_WANT_WRENCH, NULL, &pieces) != GM_OK ||
        !GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, motion, GM_WANT_WRENCH | GM_WANT_DERIVATIVES,
                                              NULL, &stretches),
                       GM_OK)) {
        return 0;
    }
    double values[2][VALUES];
    pack(&pieces.wrench, pieces.force, values[0]);
    pack(&stretches.wrench, stretches.force, values[1]);
    for (int k = 0; k < VALUES; ++k) {
        const int is_moment = k > 0 && (k - 1) / 3 % 2 == 1;
        const double lever = is_moment ? pair->center_distance + pair->face_width : 1.0;
        GM_ASSERT_ABS(values[1][k], values[0][k], 1e-15 * 1e8 * lever);
    }
    GM_ASSERT_INT(stretches.contact.drive_pairs, pieces.contact.drive_pairs);
    GM_ASSERT_INT(stretches.contact.coast_pairs, pieces.contact.coast_pairs);
    return pieces.force != 0.0;
}

/*
 * With derivatives and friction forces follow from the tangent: stretches along which the nodes of the tables leave no doubt
 * that flanks touch, or that they do not, and table by table over them. Without derivatives each piece is looked at.
 */
static void force_is_that_of_the_walk_piece_by_piece(void) {
    uint64_t seed = UINT64_C(307);
    int compared = 0;
    for (int i = 0; i < 400; ++i) {
        random_case c;
        plain_mesh room;
        gm_mesh *mesh;
        gm_motion motion;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        if (random_motion(&c, &seed, i, 0.02, SLIDING, &mesh, &room, &motion) == GM_OK) {
            motion.pose_rate = (gm_pose){0.0, 0.0, 0.0, 0.0, 0.0};
            compared += compare_walks(mesh, &motion);
        }
        random_case_free(&c);
    }
    GM_ASSERT(compared > 250);
}

/* Rough flanks that hardly touch, with many cells, some of them narrow, and face lines apart from each other. */
static void rough_flanks_touch_where_pieces_say(void) {
    enum { FACE = 25, PROFILE = 17, NODES = FACE * PROFILE };
    static double memory[2][5 * NODES + 200], nodes[NODES];
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    uint64_t seed = UINT64_C(308);
    int compared = 0;
    for (int i = 0; i < 200; ++i) {
        /* Tables of any size for one side of both gears. */
        gm_flanks *flanks[2];
        for (int gear = GM_PINION; gear <= GM_WHEEL; ++gear) {
            const int face = gm_test_integer(&seed, 2, i % 2 == 0 ? FACE : 5);
            const int profile = gm_test_integer(&seed, 2, PROFILE);
            const gm_flanks_params sizes = {
                gear == GM_PINION ? pair.pinion.teeth : pair.wheel.teeth,
                1,
                face,
                profile,
                0,
                0,
                0};

            for (int k = 0; k < NODES; ++k) {
                nodes[k] = gm_test_uniform(&seed, -1e-6, 1e-6) * (k % 37 == 0 ? 12.0 : 1.0);
            }
            GM_ASSERT_INT(gm_flanks_init(&flanks[gear], &sizes, memory[gear], sizeof memory[gear]),
                          GM_OK);
            GM_ASSERT_INT(gm_flanks_set_table(flanks[gear], GM_DRIVE, GM_ALL_TEETH, nodes, 1.0),
                          GM_OK);
        }

        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        law.friction_coefficient = 0.05;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, flanks[GM_PINION], flanks[GM_WHEEL],
                                   room.memory, sizeof room.memory),
                      GM_OK);

        /* Places about the touch, with the faces against each other. */
        for (int k = 0; k < 10; ++k) {
            gm_motion motion = {.pose = {.axial_shift = gm_test_uniform(&seed, -2e-3, 2e-3),
                                         .skew = gm_test_uniform(&seed, -1e-4, 1e-4)}};
            const double x = 0.5 * pair.backlash + gm_test_uniform(&seed, -4e-6, 6e-6) -
                             pair.face_advance / pair.face_width * motion.pose.axial_shift;
            (void)gm_position_from_pinion_angle(&pair, gm_test_uniform(&seed, 0.0, 6.0), x, 0.0,
                                                &motion.position);
            compared += compare_walks(mesh, &motion);
        }
    }
    GM_ASSERT(compared > 1000);
}

/* The change of a cross product r x f by dr. */
static void add_cross(const double r[3], const double f[3], double sum[3]) {
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        sum[k] += r[l] * f[m] - r[m] * f[l];
    }
}

/* What acts on one gear acts on the other, friction too, wherever the wheel is moved: all moments about one point stay 0. */
static void forces_stay_in_balance_with_friction(void) {
    uint64_t seed = UINT64_C(304);
    int compared = 0;
    for (int i = 0; i < 100; ++i) {
        random_case c;
        plain_mesh room;
        gm_mesh *mesh;
        gm_motion motion;
        gm_tangent tangent;
        gm_mesh_result r;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        if (random_motion(&c, &seed, i, 0.02, SLIDING, &mesh, &room, &motion) == GM_OK &&
            gm_mesh_evaluate_posed(mesh, &motion, GM_WANT_WRENCH, NULL, &r) == GM_OK &&
            r.force != 0.0 && GM_ASSERT_INT(gm_mesh_tangent(mesh, &motion, &tangent), GM_OK)) {
            const double apart = c.pair.wheel.sign * c.pair.center_distance;
            const double axis[3] = {apart + motion.pose.center_distance_change, motion.pose.offset,
                                    0.0};
            const double size = 1e8 * c.pair.center_distance * c.pair.center_distance;
            for (int which = 0; which < ALL; ++which) {
                const int q = which % GM_COORDINATES;
                const gm_wrench *by =
                    which < GM_COORDINATES ? &tangent.wrench_by[q] : &tangent.wrench_by_rate[q];
                const double moved[3] = {which == GM_CENTER_DISTANCE_CHANGE, which == GM_OFFSET,
                                         0.0};
                double left[3];
                for (int k = 0; k < 3; ++k) {
                    GM_ASSERT_ABS(by->pinion_force[k] + by->wheel_force[k], 0.0, 1e-12 * size);
                    left[k] = by->pinion_moment[k] + by->wheel_moment[k];
                }
                add_cross(axis, by->wheel_force, left);
                add_cross(moved, r.wrench.wheel_force, left);
                for (int k = 0; k < 3; ++k) {
                    GM_ASSERT_ABS(left[k], 0.0, 1e-11 * size);
                }
            }
            ++compared;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 50);
}

/* The wrench of friction does not depend on the way to it: as friction ends, so does what it adds, while axes tilt too. */
static void friction_ends_without_a_jump(void) {
    uint64_t seed = UINT64_C(305);
    int compared = 0;
    for (int i = 1; i < 60; i += 2) { /* damped */
        random_case c;
        plain_mesh room[2];
        gm_mesh *mesh[2];
        gm_motion motion;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        const int status = random_motion(&c, &seed, i, 0.02, PLAIN, &mesh[0], &room[0], &motion);
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        law.damping = 1e5;
        law.friction_coefficient = 1e-13;
        motion.position.pinion_speed = 10.0;
        double values[2][VALUES];
        if (status == GM_OK && i % 11 != 0 &&
            gm_mesh_init(&mesh[1], &law, &c.pair, c.use[0], c.use[1], room[1].memory,
                         sizeof room[1].memory) == GM_OK &&
            evaluate(mesh[0], &motion, values[0]) == GM_OK && values[0][0] != 0.0) {
            GM_ASSERT_INT(evaluate(mesh[1], &motion, values[1]), GM_OK);
            const double lever = c.pair.center_distance + c.pair.face_width;
            for (int k = 0; k < VALUES; ++k) {
                GM_ASSERT_ABS(values[1][k], values[0][k],
                              1e-11 * fabs(values[0][0]) * fmax(1.0, lever));
            }
            ++compared;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 10);
}

/* Parallel axes of which one begins to tilt: the power of the wrench is that of the force at each point. */
static void power_of_a_tilt_is_that_of_its_points(void) {
    uint64_t seed = UINT64_C(302);
    int compared = 0;
    for (int i = 0; i < 200; ++i) {
        random_case c;
        plain_mesh room;
        gm_mesh *mesh;
        gm_motion motion;
        gm_mesh_result still, moving;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        const int status = random_motion(&c, &seed, 2 * i + 1, 0.0, PLAIN, &mesh, &room, &motion);
        const gm_pose rate = motion.pose_rate;
        memset(&motion.pose_rate, 0, sizeof motion.pose_rate);
        motion.position.offset_rate = 0.0;
        if (status == GM_OK && (2 * i + 1) % 11 != 0 &&
            gm_mesh_evaluate_posed(mesh, &motion, GM_WANT_WRENCH, NULL, &still) == GM_OK &&
            fabs(still.force) > 0.0) {
            /* Of the elastic forces against a slow tilt, from the moment about the middle of the wheel's face. */
            const double z =
                c.pair.wheel.face_start + 0.5 * c.pair.wheel.face_width + motion.pose.axial_shift;
            const double *f = still.wrench.wheel_force, *m = still.wrench.wheel_moment;
            const double power =
                (m[0] + z * f[1]) * rate.skew + (m[1] - z * f[0]) * rate.inclination;

            /* Damping alike all over a side that is evenly pressed: D times the same integral, over K delta. */
            motion.pose_rate.skew = rate.skew;
            motion.pose_rate.inclination = rate.inclination;
            const int is_even = c.use[0] == NULL && c.use[1] == NULL;
            const int all = gm_mesh_evaluate_posed(mesh, &motion, GM_WANT_WRENCH, NULL, &moving);
            if (is_even && all == GM_OK && moving.force != 0.0 && still.coast_force == 0.0) {
                const double delta = still.contact.drive / still.contact.drive_contact;
                GM_ASSERT_NEAR(moving.force - still.force, -1e5 * power / (1e8 * delta), 1e-9,
                               1e-9 * fabs(still.force));
                ++compared;
            }
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 20);
}

static void what_has_no_tangent_is_refused(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    plain_mesh room;
    gm_mesh *mesh;
    gm_motion motion;
    gm_tangent tangent;
    memset(&motion, 0, sizeof motion);
    GM_ASSERT_INT(plain_mesh_make(&room, &pair, NULL, NULL, 1e8, 1e3, &mesh), GM_OK);
    GM_ASSERT_INT(gm_mesh_tangent(mesh, &motion, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_tangent(NULL, &motion, &tangent), GM_ERR_NULL);
    GM_ASSERT_NAN(tangent.force_by[GM_SKEW]);
    GM_ASSERT_INT(gm_mesh_tangent(mesh, NULL, &tangent), GM_ERR_NULL);

    /* Within the backlash nothing touches: there are no forces, and none come with any of the seven. */
    GM_ASSERT_INT(gm_mesh_tangent(mesh, &motion, &tangent), GM_OK);
    for (int k = 0; k < GM_COORDINATES; ++k) {
        GM_ASSERT_ABS(tangent.force_by[k], 0.0, 0.0);
        GM_ASSERT_ABS(tangent.wrench_by_rate[k].wheel_moment[2], 0.0, 0.0);
    }
    motion.pose.center_distance_change = (double)NAN;
    GM_ASSERT_INT(gm_mesh_tangent(mesh, &motion, &tangent), GM_STATE_NOT_FINITE);
    GM_ASSERT_NAN(tangent.force_by_rate[0]);
    GM_ASSERT_NAN(tangent.wrench_by[6].pinion_force[0]);
    motion.pose.center_distance_change = 20e-3;
    GM_ASSERT_INT(gm_mesh_tangent(mesh, &motion, &tangent), GM_POSE_OUT_OF_MESH);
    motion.pose.center_distance_change = 0.0;
    motion.position.offset = 0.51 * pair.transverse_base_pitch;
    GM_ASSERT_INT(gm_mesh_tangent(mesh, &motion, &tangent), GM_STATE_OUT_OF_RANGE);
    motion.position.offset = 0.0;
    motion.pose_rate.skew = 2e9;
    GM_ASSERT_INT(gm_mesh_tangent(mesh, &motion, &tangent), GM_STATE_OUT_OF_RANGE);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(power_of_a_tilt_is_that_of_its_points),
        GM_TEST(what_has_no_tangent_is_refused),
        GM_TEST(tangent_is_that_of_differences),
        GM_TEST(tangent_with_friction_is_that_of_differences),
        GM_TEST(tangent_with_corners_is_that_of_differences),
        GM_TEST(tangent_with_rubbing_corners_is_that_of_differences),
        GM_TEST(force_is_that_of_the_walk_piece_by_piece),
        GM_TEST(rough_flanks_touch_where_pieces_say),
        GM_TEST(forces_stay_in_balance_with_friction),
        GM_TEST(friction_ends_without_a_jump),
    };
    return gm_test_main("unit.tangent", tests, GM_TEST_COUNT(tests), argc, argv);
}
