/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Flanks whose table covers the profile of the drawing, in poses that take lines of contact further to the root. The
 * deviation there is that of the end of the table. So the same gears drawn with a start nearer to the root, which is given,
 * and with tables that have more rows there, all like the one at the end, must do the same in every respect: these never
 * leave their tables.
 */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "plain_mesh.h"
#include "reference_gear.h"

enum { FACE_NODES = 4, CELLS = 24, MOST_MORE = 3, WIDE = CELLS + 1 + MOST_MORE };

/* The same gears twice: as drawn, and with the start and the tables nearer to the root. */
typedef struct two_drawings {
    gm_pair pair[2];
    gm_flanks *flanks[2][2]; /* [drawing][enum gm_role] */
    double cell[2];          /* of each table along the line of action (m) */
} two_drawings;

/* The relief at the root ends at this node of the drawing's table. */
enum { RELIEF_CELLS = 6 };

/* nodes: of the drawing's table. relief at the root (m): of the drawing a linear one, with more rows in the table. */
static gm_flanks *flanks_of(int teeth, int more, const double *nodes, double relief) {
    const gm_flanks_params sizes = {teeth, 1,          FACE_NODES,      CELLS + 1 + more,
                                    1,     FACE_NODES, CELLS + 1 + more};
    const size_t size = gm_flanks_size(&sizes);
    double table[FACE_NODES * WIDE];
    for (int i = 0; i < FACE_NODES; ++i) {
        for (int k = 0; k < CELLS + 1 + more; ++k) {
            const int node = k < more ? 0 : k - more;
            const double taken = relief * fmax(0.0, 1.0 - (double)node / RELIEF_CELLS);
            table[i * (CELLS + 1 + more) + k] =
                nodes[i * (CELLS + 1) + node] - (more > 0 ? taken : 0.0);
        }
    }
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, malloc(size), size), GM_OK);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        GM_ASSERT_INT(gm_flanks_set_table(flanks, side, GM_ALL_TEETH, table, 1.0), GM_OK);
        const gm_flank_ramp ramp = {relief, 0.0, -relief * CELLS / RELIEF_CELLS};
        const int count = more == 0 && relief > 0.0;
        GM_ASSERT_INT(gm_flanks_set_ramps(flanks, side, &ramp, count, 1.0), GM_OK);
    }
    return flanks;
}

static double deeper_start(const gm_gear *gear, int more, double *cell) {
    *cell = (gear->tip_roll_length - gear->start_roll_length) / CELLS;
    const double start = gear->start_roll_length - more * *cell;
    GM_ASSERT(start > 0.0);
    return hypot(gear->base_radius, start);
}

/* roles: which gears have tables, 1 the pinion, 2 the wheel; more: cells nearer to the root. */
static void draw(two_drawings *two, const gm_pair_params *params, uint64_t *seed, int roles,
                 int more, double relief) {
    two->pair[0] = make_pair(params);
    gm_pair_params deeper = *params;
    deeper.pinion_start_radius = deeper_start(&two->pair[0].pinion, more, &two->cell[GM_PINION]);
    deeper.wheel_start_radius = deeper_start(&two->pair[0].wheel, more, &two->cell[GM_WHEEL]);
    deeper.pinion_start_radius = roles & 1 ? deeper.pinion_start_radius : (double)NAN;
    deeper.wheel_start_radius = roles & 2 ? deeper.wheel_start_radius : (double)NAN;
    two->pair[1] = make_pair(&deeper);

    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        double nodes[FACE_NODES * (CELLS + 1)];
        for (int k = 0; k < FACE_NODES * (CELLS + 1); ++k) {
            nodes[k] = gm_test_uniform(seed, -2e-6, 2e-6);
        }
        const gm_gear *gear = role == GM_PINION ? &two->pair[0].pinion : &two->pair[0].wheel;
        const int has_table = roles >> role & 1;
        two->flanks[0][role] = has_table ? flanks_of(gear->teeth, 0, nodes, relief) : NULL;
        two->flanks[1][role] = has_table ? flanks_of(gear->teeth, more, nodes, relief) : NULL;
    }
}

static void put_away(two_drawings *two) {
    for (int k = 0; k < 4; ++k) {
        free(two->flanks[k / 2][k % 2]);
    }
}

/* The change of the centre distance that changes the length of the line of action so (m). */
static double distance_for(const gm_pair *pair, double change) {
    const double base_sum = pair->pinion.base_radius + pair->wheel.sign * pair->wheel.base_radius;
    const double sign = pair->wheel.sign;
    return sign * (hypot(base_sum, pair->line_of_action + sign * change) - pair->center_distance);
}

/* Both helical, spur and internal gears that have room at their roots. */
enum { PAIRS = 3 };
static gm_pair_params drawn_pair(int which) {
    gm_pair_params params = which == 1 ? spur_pair_params() : reference_params(17.5e-3);
    if (which == 2) {
        gm_pair_params_default(&params);
        params.pinion_teeth = 36;
        params.wheel_teeth = -93;
        params.normal_module = 2e-3;
        params.normal_pressure_angle = 0.3490658503988659 /* 20 deg */;
        params.helix_angle = 0.2;
        params.center_distance = 58.4e-3;
        params.face_width = 20e-3;
        params.pinion_rack_dedendum = params.wheel_rack_dedendum = 1.6;
    }
    params.backlash = 800e-6;
    return params;
}

static void compare_numbers(const double *got, const double *expected, size_t count,
                            double relative) {
    double scale = 0.0;
    for (size_t k = 0; k < count; ++k) {
        scale = isnan(expected[k]) ? scale : fmax(scale, fabs(expected[k]));
    }
    for (size_t k = 0; k < count; ++k) {
        if (isnan(expected[k])) {
            GM_ASSERT_NAN(got[k]);
        } else {
            GM_ASSERT_ABS(got[k], expected[k], relative * scale + 1e-9); /* rounding of 1e8 N/m */
        }
    }
}

static void compare_results(const gm_mesh_result *got, const gm_mesh_result *expected) {
    const double little = 1e-9;
    GM_ASSERT_REL(got->force, expected->force, little);
    GM_ASSERT_REL(got->pinion_torque, expected->pinion_torque, little);
    GM_ASSERT_REL(got->wheel_torque, expected->wheel_torque, little);
    GM_ASSERT_REL(got->energy, expected->energy, little);
    GM_ASSERT_NEAR(got->loss, expected->loss, little, 1e-9);
    GM_ASSERT_INT(got->contact.drive_pairs, expected->contact.drive_pairs);
    GM_ASSERT_INT(got->contact.coast_pairs, expected->contact.coast_pairs);
    compare_numbers(&got->force_by.pinion_angle, &expected->force_by.pinion_angle, 4, 1e-8);
    compare_numbers(&got->pinion_torque_by.pinion_angle, &expected->pinion_torque_by.pinion_angle,
                    4, 1e-8);
    compare_numbers(got->wrench.pinion_force, expected->wrench.pinion_force,
                    sizeof(gm_wrench) / sizeof(double), little);
}

enum { WANT_ALL = GM_WANT_DERIVATIVES | GM_WANT_WRENCH | GM_WANT_PAIRS | GM_WANT_ENERGY };

/* One place: as prepared in the pose, as it moves there, its tangent, its line loads. */
static void compare_at(const two_drawings *two, const gm_mesh_params *law, double angle, int side) {
    gm_mesh_result prepared[2], moving[2];
    gm_tangent tangent[2];
    gm_line_loads loads[2];
    static gm_line_load_point points[2][400];
    int pairs[2][2];
    double x = 0.0;

    /* Either drawing: prepared in the pose, and posed in the call. */
    for (int k = 0; k < 2; ++k) {
        plain_mesh rooms[2];
        gm_mesh *posed, *drawn;
        GM_ASSERT_INT(gm_mesh_init(&posed, law, &two->pair[k], two->flanks[k][GM_PINION],
                                   two->flanks[k][GM_WHEEL], &rooms[0], sizeof rooms[0]),
                      GM_OK);

        gm_mesh_params unposed = *law;
        gm_motion motion = {.pose = law->pose, .pose_rate = {1e-3, -2e-3, 1e-3, 0.02, -0.03}};
        const gm_pose none = {0.0, 0.0, 0.0, 0.0, 0.0};
        unposed.pose = none;
        GM_ASSERT_INT(gm_mesh_init(&drawn, &unposed, &two->pair[k], two->flanks[k][GM_PINION],
                                   two->flanks[k][GM_WHEEL], &rooms[1], sizeof rooms[1]),
                      GM_OK);

        /* The place of both is 14 um behind the touch of the first. */
        if (k == 0) {
            x = (side == GM_DRIVE ? 1.0 : -1.0) * (gm_mesh_clearance(posed, side) + 14e-6);
        }

        gm_position *position = &motion.position;
        GM_ASSERT_INT(gm_position_from_pinion_angle(&two->pair[k], angle, x, 1e-3, position),
                      GM_OK);
        position->pinion_speed = 20.0;

        GM_ASSERT_INT(gm_mesh_evaluate_at(posed, position, WANT_ALL, NULL, &prepared[k]), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_posed(drawn, &motion, WANT_ALL, NULL, &moving[k]), GM_OK);
        GM_ASSERT_INT(gm_mesh_tangent(drawn, &motion, &tangent[k]), GM_OK);
        GM_ASSERT_INT(gm_mesh_line_loads(posed, position, NULL, points[k], 400, &loads[k]), GM_OK);
        GM_ASSERT_INT(gm_mesh_pairs_at(posed, position, NULL, pairs[k]), GM_OK);
    }

    compare_results(&prepared[0], &prepared[1]);
    compare_results(&moving[0], &moving[1]);
    for (int k = 0; k < GM_COORDINATES; ++k) {
        gm_test_context("tangent by coordinate %d", k);
        const size_t count = sizeof(gm_wrench) / sizeof(double);
        compare_numbers(&tangent[0].force_by[k], &tangent[1].force_by[k], 1, 1e-7);
        compare_numbers(tangent[0].wrench_by[k].pinion_force, tangent[1].wrench_by[k].pinion_force,
                        count, 1e-7);
        compare_numbers(tangent[0].wrench_by_rate[k].pinion_force,
                        tangent[1].wrench_by_rate[k].pinion_force, count, 1e-7);
    }

    GM_ASSERT_INT(pairs[0][side], pairs[1][side]);
    GM_ASSERT_REL(loads[0].largest_line_load, loads[1].largest_line_load, 1e-9);
    GM_ASSERT_REL(loads[0].touching_width, loads[1].touching_width, 1e-9);

    if (GM_ASSERT_INT(loads[0].points, loads[1].points)) {
        for (int k = 0; k < loads[0].points; ++k) {
            GM_ASSERT_ABS(points[0][k].gap, points[1][k].gap, 1e-14);
        }
    }
}

/* Closer axes (of rings: further apart), in the drawing's direction and beside it, tilted or not, with friction or without. */
static void flanks_go_on_with_the_end_of_their_table(void) {
    uint64_t seed = UINT64_C(801);
    for (int i = 0; i < 48; ++i) {
        two_drawings two;
        const gm_pair_params params = drawn_pair(i % PAIRS);
        draw(&two, &params, &seed, 1 + i % 7 % 3, 3, i % 5 == 4 ? 3e-6 : 0.0);
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        law.damping = 1e3;
        law.friction_coefficient = i & 4 ? 0.06 : 0.0;
        const double cell = fmin(two.cell[GM_PINION], two.cell[GM_WHEEL]);
        law.pose.center_distance_change =
            distance_for(&two.pair[0], -cell * gm_test_uniform(&seed, 0.5, 2.0));
        law.pose.offset = i & 1 ? 30e-6 : 0.0;
        law.pose.axial_shift = i & 8 ? 1e-3 : 0.0;
        law.pose.skew = i & 2 ? 0.3e-3 : 0.0;
        law.pose.inclination = i & 2 ? -0.2e-3 : 0.0;
        for (int k = 0; k < 8; ++k) {
            const double angle = gm_test_uniform(&seed, 0.0, 6.0);
            const int side = k % 2 == 0 ? GM_DRIVE : GM_COAST;
            gm_test_context("case %d, place %d", i, k);
            compare_at(&two, &law, angle, side);
        }
        put_away(&two);
    }
    gm_test_context("%s", "");
}

/* Spur lines within some micrometres of where a table starts, between axes that are tilted and no closer than drawn. */
static void tilted_spur_flanks_go_on_with_the_end_of_their_table(void) {
    uint64_t seed = UINT64_C(806);
    for (int i = 0; i < 4; ++i) {
        two_drawings two;
        const gm_pair_params params = drawn_pair(1);
        draw(&two, &params, &seed, 1, 3, 0.0);
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        law.pose.skew = i & 1 ? 1e-3 : -1e-3;
        law.pose.inclination = i & 2 ? 1e-3 : -1e-3;
        const gm_pair *pair = &two.pair[0];
        for (int k = -8; k <= 8; ++k) {
            const double rho = pair->pinion.start_roll_length + 1.03e-6 * k;
            gm_test_context("case %d, place %d", i, k);
            compare_at(&two, &law, (rho - pair->phase_origin[GM_DRIVE]) / pair->pinion.base_radius,
                       GM_DRIVE);
        }
        put_away(&two);
    }
    gm_test_context("%s", "");
}

/* The force as the wheel moves to or from the pinion (N). */
static double force_at(const gm_mesh *mesh, const gm_motion *motion, double moved) {
    gm_motion there = *motion;
    there.pose.center_distance_change += moved;
    gm_mesh_result result;
    GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &there, 0, NULL, &result), GM_OK);
    return result.force;
}

/* Its derivative by central differences (N/m). */
static double slope_at(const gm_mesh *mesh, const gm_motion *motion, double h) {
    return (force_at(mesh, motion, h) - force_at(mesh, motion, -h)) / (2.0 * h);
}

/*
 * Between tilted axes lines end at a table, or at the mate's tip beyond it once a pose takes them deeper: in between the force
 * has no jump, and the tangent is that of differences where the table still ends some lines. Places where differences with two
 * steps disagree have a kink between: they are left out, and are few.
 */
static void lines_go_deeper_without_a_jump(void) {
    uint64_t seed = UINT64_C(805);
    int kinks = 0, all = 0;
    for (int i = 0; i < 12; ++i) {
        two_drawings two;
        const gm_pair_params params = drawn_pair(i % 2 == 0 ? 0 : 2);
        draw(&two, &params, &seed, 1 + i % 3, 3, 0.0);

        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        plain_mesh memory;
        gm_mesh *mesh;
        GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &two.pair[0], two.flanks[0][GM_PINION],
                                   two.flanks[0][GM_WHEEL], &memory, sizeof memory),
                      GM_OK);

        const double tilt = i & 4 ? 0.8e-3 : -0.8e-3;
        for (int k = 0; k < 30; ++k) {
            gm_test_context("case %d, place %d", i, k);
            gm_motion motion = {.pose = {0.0, 0.0, 0.0, tilt, i & 8 ? tilt : -tilt}};
            const double x = 0.5 * two.pair[0].backlash + gm_test_uniform(&seed, 10e-6, 20e-6);
            const double angle = gm_test_uniform(&seed, 0.0, 6.0);
            GM_ASSERT_INT(gm_position_from_pinion_angle(&two.pair[0], angle, k % 2 == 0 ? x : -x,
                                                        0.0, &motion.position),
                          GM_OK);

            /* As drawn: the overlap grows by 2e-12 m at most from one to the other, on less than two lines' length. */
            const double before = force_at(mesh, &motion, -1e-12);
            GM_ASSERT_ABS(before, force_at(mesh, &motion, 1e-12), 2.0 * law.stiffness * 2e-12);

            /* A micrometre deeper. */
            gm_tangent tangent;
            motion.pose.center_distance_change = distance_for(&two.pair[0], -1.5e-6);
            GM_ASSERT_INT(gm_mesh_tangent(mesh, &motion, &tangent), GM_OK);
            const double coarse = slope_at(mesh, &motion, 20e-9);
            const double fine = slope_at(mesh, &motion, 8e-9);
            const double exact = tangent.force_by[GM_CENTER_DISTANCE_CHANGE];
            ++all;
            if (fabs(fine - coarse) > 1e-5 * fabs(exact)) {
                ++kinks;
            } else {
                GM_ASSERT_REL(fine, exact, 1e-5);
            }
        }
        put_away(&two);
    }
    gm_test_context("%s", "");
    GM_ASSERT(kinks <= all / 20);
}

/* Equilibria under several loads, which look at many depths at once, and the look-up. */
static void equilibria_and_caches_see_the_same_flanks(void) {
    uint64_t seed = UINT64_C(802);
    two_drawings two;
    const gm_pair_params params = drawn_pair(0);
    draw(&two, &params, &seed, 3, 3, 0.0);

    /* Both drawings of the same flanks, moved until lines end in the tables. */
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = 1e8;
    law.pose.center_distance_change = distance_for(&two.pair[0], -1.7 * two.cell[GM_PINION]);
    plain_mesh rooms[2];
    gm_mesh *meshes[2];
    for (int k = 0; k < 2; ++k) {
        GM_ASSERT_INT(gm_mesh_init(&meshes[k], &law, &two.pair[k], two.flanks[k][GM_PINION],
                                   two.flanks[k][GM_WHEEL], &rooms[k], sizeof rooms[k]),
                      GM_OK);
    }

    /* The same equilibria under three loads. */
    static const double torque[3] = {20.0, 60.0, 120.0};
    for (int i = 0; i < 40; ++i) {
        gm_test_context("angle %d", i);
        double offset[2][3];
        gm_mesh_result result[2][3];
        for (int k = 0; k < 2; ++k) {
            GM_ASSERT_INT(gm_rolling_equilibria(meshes[k], 0.013 * i, 0.0, torque, 3, 0, NULL,
                                                offset[k], result[k]),
                          GM_OK);
        }
        for (int n = 0; n < 3; ++n) {
            GM_ASSERT_ABS(offset[0][n], offset[1][n], 1e-14);
        }
    }

    gm_test_context("cache");
    gm_cache_errors found[2];
    for (int k = 0; k < 2; ++k) {
        gm_cache *cache;
        gm_cache_params resolution;
        gm_cache_params_default(&resolution);
        const size_t size = gm_cache_size(&resolution, meshes[k]);
        void *memory = malloc(size);
        GM_ASSERT_INT(gm_cache_init(&cache, &resolution, meshes[k], memory, size), GM_OK);
        GM_ASSERT_INT(gm_cache_error(cache, 300, 3, NULL, &found[k]), GM_OK);
        free(memory);
    }
    GM_ASSERT(found[1].sum_rms > 0.0);
    GM_ASSERT(found[0].sum_rms < 1.2 * found[1].sum_rms);
    put_away(&two);
    gm_test_context("%s", "");
}

/* Spur lines are beyond a table as a whole: what touches is counted alike with and without the force. */
static void pairs_are_counted_with_the_same_flanks(void) {
    uint64_t seed = UINT64_C(804);
    two_drawings two;
    const gm_pair_params params = drawn_pair(1);
    draw(&two, &params, &seed, 3, 3, 0.0);
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = 1e8;
    law.pose.center_distance_change = distance_for(&two.pair[0], -2.0 * two.cell[GM_PINION]);
    plain_mesh memory;
    gm_mesh *mesh;
    GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &two.pair[0], two.flanks[0][GM_PINION],
                               two.flanks[0][GM_WHEEL], &memory, sizeof memory),
                  GM_OK);
    for (int i = 0; i < 400; ++i) {
        gm_test_context("place %d", i);
        const double x = gm_mesh_clearance(mesh, GM_DRIVE) + gm_test_uniform(&seed, 0.0, 6e-6);
        const double angle = gm_test_uniform(&seed, 0.0, 6.0);
        gm_position position;
        gm_mesh_result result;
        int pairs[2];
        GM_ASSERT_INT(gm_position_from_pinion_angle(&two.pair[0], angle, x, 0.0, &position), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, 0, NULL, &result), GM_OK);
        GM_ASSERT_INT(gm_mesh_pairs_at(mesh, &position, NULL, pairs), GM_OK);
        GM_ASSERT_INT(pairs[GM_DRIVE], result.contact.drive_pairs);
    }
    put_away(&two);
    gm_test_context("%s", "");
}

/*
 * Elastic teeth, which know their compliance from the start of the profile on: a pose that brings it exactly to where the
 * other drawing has it. With corner contact or without.
 */
static void elastic_teeth_read_the_same_flanks(void) {
    uint64_t seed = UINT64_C(803);
    for (int i = 0; i < 4; ++i) {
        two_drawings two;
        const gm_pair_params params = drawn_pair(i % 2);
        draw(&two, &params, &seed, 1, 1, i == 3 ? 3e-6 : 0.0);
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.law = GM_LAW_ELASTIC;
        law.corner_contact = i < 2 ? GM_CORNER_OFF : GM_CORNER_ON;
        law.pose.center_distance_change = distance_for(&two.pair[0], -two.cell[GM_PINION]);

        gm_mesh_result result[10][2];
        gm_line_loads loads[10][2];
        double x[10];

        /* Ten places of either drawing, 20 um behind the touch of the first. */
        for (int k = 0; k < 2; ++k) {
            const size_t size = gm_mesh_size(&law, &two.pair[k]);
            void *memory = malloc(size);
            gm_mesh *mesh;
            gm_workspace *workspace;
            GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &two.pair[k], two.flanks[k][GM_PINION],
                                       two.flanks[k][GM_WHEEL], memory, size),
                          GM_OK);

            const size_t work = gm_workspace_size(mesh);
            void *work_memory = malloc(work);
            GM_ASSERT_INT(gm_workspace_init(&workspace, mesh, work_memory, work), GM_OK);

            for (int n = 0; n < 10; ++n) {
                gm_test_context("case %d, drawing %d, place %d", i, k, n);
                x[n] = k == 0 ? gm_mesh_clearance(mesh, GM_DRIVE) + 20e-6 : x[n];
                gm_position at;
                GM_ASSERT_INT(
                    gm_position_from_pinion_angle(&two.pair[k], 0.031 * n, x[n], 0.0, &at), GM_OK);
                GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &at, GM_WANT_DERIVATIVES | GM_WANT_WRENCH,
                                                  workspace, &result[n][k]),
                              GM_OK);
                GM_ASSERT_INT(gm_mesh_line_loads(mesh, &at, workspace, NULL, 0, &loads[n][k]),
                              GM_OK);
            }
            free(work_memory);
            free(memory);
        }

        for (int n = 0; n < 10; ++n) {
            gm_test_context("case %d, place %d", i, n);
            GM_ASSERT_REL(result[n][0].force, result[n][1].force, 1e-7);
            GM_ASSERT_REL(result[n][0].force_by.pinion_angle, result[n][1].force_by.pinion_angle,
                          1e-6);
            GM_ASSERT_REL(result[n][0].wrench.wheel_moment[0], result[n][1].wrench.wheel_moment[0],
                          1e-6);
            GM_ASSERT_REL(loads[n][0].largest_line_load, loads[n][1].largest_line_load, 1e-6);
        }
        put_away(&two);
    }
    gm_test_context("%s", "");
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(flanks_go_on_with_the_end_of_their_table),
        GM_TEST(tilted_spur_flanks_go_on_with_the_end_of_their_table),
        GM_TEST(lines_go_deeper_without_a_jump),
        GM_TEST(equilibria_and_caches_see_the_same_flanks),
        GM_TEST(pairs_are_counted_with_the_same_flanks),
        GM_TEST(elastic_teeth_read_the_same_flanks),
    };
    return gm_test_main("unit.table_end", tests, GM_TEST_COUNT(tests), argc, argv);
}
