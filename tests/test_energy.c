/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The energy stored in a mesh: against the second model, closed forms, and the forces whose work it is. Of elastic teeth
 * test_elastic_mesh.c has check values, and test_body.c the balance of power between two bodies.
 */
#include "gm_test.h"
#include "plain_mesh.h"
#include "random_gears.h"
#include "reference_gear.h"

/* ---------------------------------------------------------------------------------------------
 * Against others
 * ------------------------------------------------------------------------------------------- */

/* Between evaluations with lengths that are some roundings smaller and larger, as in test_sweep.c. */
static void it_is_that_of_the_second_model(void) {
    uint64_t seed = UINT64_C(301);
    int touching = 0;
    for (int i = 0; i < 1200; ++i) {
        random_case c;
        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_result r;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        const gm_mesh_params law = plain_law(GM_CORNER_OFF);
        const gm_state state = {.pinion_angle = c.pinion_angle, .wheel_angle = c.wheel_angle};
        GM_ASSERT_INT(plain_mesh_of(&room, &c.pair, c.use, &law, &mesh), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate(mesh, &state, GM_WANT_ENERGY, NULL, &r), GM_OK);

        const double longest = fmax(c.params.center_distance, (double)c.model.reference_radius[1]);
        const double e = 4.0 * 0x1p-53 * longest;
        model_result low, high;
        model_evaluate(&c.model, c.model_use[0], c.model_use[1], c.pinion_angle, c.wheel_angle, -e,
                       -e, &low);
        model_evaluate(&c.model, c.model_use[0], c.model_use[1], c.pinion_angle, c.wheel_angle, e,
                       e, &high);
        const double half = 0.5 * plain_stiffness;
        const double least = half * (double)(low.square[0] + low.square[1]);
        const double most = half * (double)(high.square[0] + high.square[1]);
        GM_ASSERT(r.energy >= least * (1.0 - 1e-12));
        GM_ASSERT(r.energy <= most * (1.0 + 1e-12));
        touching += r.energy > 0.0;
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(touching > 600);
}

/* Between ideal flanks the overlap is the same all over a side: F^2 / (2 K touching part). Poses without tilts too. */
static void between_ideal_flanks_it_is_that_of_one_spring(void) {
    uint64_t seed = UINT64_C(302);
    for (int i = 0; i < 300; ++i) {
        random_case c;
        plain_mesh room;
        gm_mesh *mesh;
        gm_test_context("case %d", i);
        GM_ASSERT_INT((i % 4 == 0 ? random_ring_case_make : random_case_make)(&c, &seed, 0), GM_OK);
        const gm_pose pose = random_pose(&seed, &c.pair, 0.0);
        gm_mesh_params law = plain_law(GM_CORNER_OFF);
        if (i % 2 != 0) {
            law.pose = pose;
        }
        if (plain_mesh_of(&room, &c.pair, NULL, &law, &mesh) == GM_OK) {
            const gm_position position = random_pressed(&seed, &c.pair, i);
            gm_mesh_result r;
            GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_ENERGY, NULL, &r), GM_OK);
            double expected = 0.0;
            if (r.drive_force > 0.0) {
                expected += r.drive_force * r.drive_force / r.contact.drive_contact;
            }
            if (r.coast_force > 0.0) {
                expected += r.coast_force * r.coast_force / r.contact.coast_contact;
            }
            GM_ASSERT_REL(r.energy, expected / (2.0 * plain_stiffness), 1e-13);
        }
        random_case_free(&c);
    }
}

static void of_the_simple_model_it_is_that_of_its_spring(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    gm_mesh_params law = plain_law(GM_CORNER_OFF);
    plain_mesh room;
    gm_mesh *mesh;
    law.model = GM_MODEL_SIMPLE;
    law.simple_stiffness = 3e8;
    GM_ASSERT_INT(plain_mesh_of(&room, &pair, NULL, &law, &mesh), GM_OK);
    const double depth[3] = {5e-6, -5e-6, 0.02};
    for (int i = 0; i < 3; ++i) {
        const double x = copysign(0.5 * pair.backlash, depth[i]) + depth[i];
        const gm_position position = {.offset = x};
        gm_mesh_result r;
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_ENERGY, NULL, &r), GM_OK);
        GM_ASSERT_REL(r.energy, 0.5 * 3e8 * depth[i] * depth[i], 1e-9);
        GM_ASSERT_REL(r.energy, 0.5 * r.force * depth[i], 1e-9);
    }
}

/* ---------------------------------------------------------------------------------------------
 * The work of the force
 * ------------------------------------------------------------------------------------------- */

/*
 * Material that is added evenly moves no line and no place in a table: the energy grows by the force, whatever flanks,
 * reliefs, tilts and edges. By differences of two steps, which agree but where a line or a cell begins to touch.
 */
static void material_adds_the_force(void) {
    uint64_t seed = UINT64_C(303);
    int compared = 0, tilted = 0, cornered = 0;
    for (int i = 0; i < 600; ++i) {
        random_case c;
        const int made =
            i % 5 == 0 ? random_ring_case_make(&c, &seed, 1) : random_case_make(&c, &seed, 1);
        gm_test_context("case %d", i);
        GM_ASSERT_INT(made, GM_OK);
        const gm_pose pose = random_pose(&seed, &c.pair, i % 3 == 0 ? 0.0 : 0.02);
        gm_mesh_params law = plain_law(i % 2 == 0 ? GM_CORNER_OFF : GM_CORNER_ON);
        if (i % 6 >= 2) {
            law.pose = pose;
        }
        const gm_position position = random_pressed(&seed, &c.pair, i);
        const int side = i % 5 == 0 ? GM_COAST : GM_DRIVE;
        const double h = 2e-5 * c.pair.normal_module;

        /* The energy without more material, and with two steps less and more. */
        double energy[5] = {0.0}, force = 0.0;
        int status = c.use[GM_PINION] == NULL ? GM_ERR_NULL : GM_OK;
        for (int k = 0; k < 5 && status == GM_OK; ++k) {
            plain_mesh room;
            gm_mesh *mesh;
            gm_mesh_result r;
            random_flanks_grow(&c.flanks[GM_PINION], side,
                               k == 0 ? 0.0 : (k < 3 ? k - 3 : k - 2) * h);
            status = plain_mesh_of(&room, &c.pair, c.use, &law, &mesh);
            if (status == GM_OK) {
                status = gm_mesh_evaluate_at(mesh, &position, GM_WANT_ENERGY, NULL, &r);
            }
            energy[k] = r.energy;
            force = k == 0 ? side == GM_DRIVE ? r.drive_force : r.coast_force : force;
        }

        const double slope = (energy[3] - energy[2]) / (2.0 * h);
        const double wider = (energy[4] - energy[1]) / (4.0 * h);
        if (status == GM_OK && force > 0.0 && fabs(wider - slope) < 1e-5 * force) {
            GM_ASSERT_ABS(slope, force, 1e-5 * force);
            ++compared;
            tilted += i % 3 != 0 && i % 6 >= 2;
            cornered += i % 2 == 1;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 250);
    GM_ASSERT(tilted > 80);
    GM_ASSERT(cornered > 80);
}

static double energy_at(const gm_mesh *mesh, const gm_motion *motion) {
    gm_mesh_result r;
    GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, motion, GM_WANT_ENERGY, NULL, &r), GM_OK);
    return r.energy;
}

/* The motion with one of both angles or the first three coordinates of the pose another. */
static gm_motion moved(const gm_pair *pair, const gm_motion *motion, int coordinate, double by) {
    gm_motion there = *motion;
    double *const places[5] = {NULL, NULL, &there.pose.center_distance_change, &there.pose.offset,
                               &there.pose.axial_shift};
    if (coordinate == GM_PINION_ANGLE) {
        there.position.phase += pair->pinion.base_radius * by;
        there.position.offset += pair->pinion.base_radius * by;
    } else if (coordinate == GM_WHEEL_ANGLE) {
        there.position.offset -= pair->wheel.base_radius * by;
    } else {
        *places[coordinate] += by;
    }
    return there;
}

/*
 * With edges that touch beyond the path nothing ends with an overlap, so that both torques and the force on the wheel are
 * the gradient of the energy: also of rings, and in poses. Along the axis a shift of the wheel does what a turn does: the
 * force there differs from that by the overlap squared with which lines end at the faces. The wheel is wider, so that a
 * shift moves no end of the common face.
 */
static void torques_and_forces_are_its_gradient(void) {
    uint64_t seed = UINT64_C(304);
    int compared = 0;
    for (int i = 0; i < 300; ++i) {
        random_case c;
        plain_mesh room;
        gm_mesh *mesh;
        const int made =
            i % 4 == 0 ? random_ring_case_make(&c, &seed, 0) : random_case_make(&c, &seed, 0);
        gm_test_context("case %d", i);
        GM_ASSERT_INT(made, GM_OK);
        c.params.pinion_face_width = c.params.face_width;
        c.params.wheel_face_width = 1.4 * c.params.face_width;
        GM_ASSERT_INT(gm_pair_init(&c.pair, &c.params), GM_OK);

        /* Somewhere in contact, in a pose. */
        const gm_pair *pair = &c.pair;
        const gm_mesh_params law = plain_law(GM_CORNER_ON);
        gm_motion motion = {.position = random_pressed(&seed, pair, i),
                            .pose = random_pose(&seed, pair, 0.0)};
        gm_mesh_result r;
        int status = plain_mesh_of(&room, pair, NULL, &law, &mesh);
        if (status == GM_OK) {
            status = gm_mesh_evaluate_posed(mesh, &motion, GM_WANT_WRENCH, NULL, &r);
        }
        if (status == GM_OK && r.force != 0.0) {
            /* What the slopes of the energy have to be. */
            const double size = r.drive_force + r.coast_force;
            const double arms[5] = {pair->pinion.base_radius, pair->wheel.base_radius, 1.0, 1.0,
                                    1.0};
            const double by_turn = r.wheel_torque / (pair->wheel.base_radius * r.force);
            const double expected[5] = {r.pinion_torque, -r.wheel_torque, -r.wrench.wheel_force[0],
                                        -r.wrench.wheel_force[1],
                                        -r.wrench.wheel_force[2] * by_turn};

            for (int k = 0; k < 5; ++k) {
                gm_test_context("case %d, coordinate %d", i, k);
                const double h = 2e-5 * pair->normal_module / arms[k];
                double beside[4];
                for (int j = 0; j < 4; ++j) {
                    const gm_motion there = moved(pair, &motion, k, (j < 2 ? j - 2 : j - 1) * h);
                    beside[j] = energy_at(mesh, &there);
                }

                const double slope = (beside[2] - beside[1]) / (2.0 * h);
                const double wider = (beside[3] - beside[0]) / (4.0 * h);
                if (fabs(wider - slope) < 1e-5 * size * arms[k]) { /* not about a kink */
                    /* The turn of the normal at an edge is taken at the middle of the load. */
                    const double allowed = k < 2 || k == 4 ? 1e-5 : 1e-4;
                    GM_ASSERT_ABS(slope, expected[k], allowed * size * arms[k]);
                    ++compared;
                }
            }
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 1000);
}

/* Along any way of both angles the torques do what the energy gains; and a mesh cycle later it is what it was. */
static void over_a_mesh_cycle_it_is_the_work(void) {
    const gm_pair pairs[2] = {spur_pair(), reference_pair(REFERENCE_FACE_WIDTH)};
    for (int which = 0; which < 2; ++which) {
        enum { STEPS = 4000 };
        const gm_pair *pair = &pairs[which];
        const gm_mesh_params law = plain_law(GM_CORNER_ON);
        plain_mesh room;
        gm_mesh *mesh;
        GM_ASSERT_INT(plain_mesh_of(&room, pair, NULL, &law, &mesh), GM_OK);
        const double m = pair->normal_module, pitch = pair->transverse_base_pitch;
        double first = 0.0, work = 0.0, largest = 0.0, before = 0.0;
        for (int k = 0; k <= STEPS; ++k) {
            gm_test_context("pair %d, step %d", which, k);
            const double turn = 6.283185307179586 * k / STEPS;
            const double x = 0.5 * pair->backlash + m * (4e-3 + 3e-3 * sin(turn));
            gm_position position;
            gm_mesh_result r;
            (void)gm_position_from_pinion_angle(pair, pitch * k / STEPS / pair->pinion.base_radius,
                                                x, 0.0, &position);
            GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_ENERGY, NULL, &r), GM_OK);
            const double x_by = m * 3e-3 * cos(turn), roll_by = pitch / 6.283185307179586;
            const double power = r.pinion_torque * roll_by / pair->pinion.base_radius -
                                 r.wheel_torque * (roll_by - x_by) / pair->wheel.base_radius;
            first = k == 0 ? r.energy : first;
            largest = fmax(largest, r.energy);
            work += k > 0 ? 0.5 * (before + power) * 6.283185307179586 / STEPS : 0.0;
            before = power;
            if (k % 500 == 0) {
                GM_ASSERT_ABS(r.energy - first, work, 1e-5 * largest);
            }
        }
        GM_ASSERT(largest > 1.5 * first);
        GM_ASSERT_ABS(work, 0.0, 1e-5 * largest);
    }
}

/* ---------------------------------------------------------------------------------------------
 * What it depends on, and what not
 * ------------------------------------------------------------------------------------------- */

static void it_is_zero_apart_and_nan_unasked(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    for (int corner = GM_CORNER_OFF; corner <= GM_CORNER_ON; ++corner) {
        const gm_mesh_params law = plain_law(corner);
        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_result r;
        GM_ASSERT_INT(plain_mesh_of(&room, &pair, NULL, &law, &mesh), GM_OK);
        gm_position position = {.phase = 1e-3, .offset = 0.49 * pair.backlash};
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_ENERGY, NULL, &r), GM_OK);
        GM_ASSERT(r.energy == 0.0);
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_WRENCH, NULL, &r), GM_OK);
        GM_ASSERT_NAN(r.energy);
        position.pinion_tooth = -1;
        r.energy = 0.0;
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_ENERGY, NULL, &r), GM_ERR_TOOTH);
        GM_ASSERT_NAN(r.energy);
    }
}

/* Speeds, damping, friction and a cache are nothing to it, and it is nothing to the rest. */
static void it_depends_on_the_place_alone(void) {
    uint64_t seed = UINT64_C(305);
    int compared = 0;
    for (int i = 0; i < 120; ++i) {
        random_case c;
        plain_mesh room[2];
        gm_mesh *mesh[2];
        gm_mesh_result still, busy, unasked;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);

        /* At rest. */
        const int corner = i % 3 == 0 ? GM_CORNER_ON : GM_CORNER_OFF;
        gm_mesh_params law = plain_law(corner);
        gm_motion motion = {.position = random_pressed(&seed, &c.pair, i),
                            .pose = random_pose(&seed, &c.pair, i % 4 == 0 ? 0.0 : 0.01)};
        int status = plain_mesh_of(&room[0], &c.pair, c.use, &law, &mesh[0]);

        law.damping = 1e3;
        law.friction_coefficient = i % 2 == 0 ? 0.1 : 0.0;
        if (status == GM_OK) {
            status = gm_mesh_evaluate_posed(mesh[0], &motion, GM_WANT_ENERGY, NULL, &still);
        }

        /* Moving, with damping and friction; and whatever else is asked for. */
        if (status == GM_OK) {
            GM_ASSERT_INT(plain_mesh_of(&room[1], &c.pair, c.use, &law, &mesh[1]), GM_OK);
            motion.position.offset_rate = 0.01;
            motion.position.pinion_speed = 20.0;
            motion.pose_rate.center_distance_change = i % 5 < 2 ? 0.0 : 1e-3;
            motion.pose_rate.skew = i % 5 < 4 ? 0.0 : 1e-3;
            compared += still.energy > 0.0 && i % 5 >= 2;

            for (int wanted = 0; wanted < 4; ++wanted) {
                GM_ASSERT_INT(
                    gm_mesh_evaluate_posed(mesh[1], &motion, wanted | GM_WANT_ENERGY, NULL, &busy),
                    GM_OK);
                GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh[1], &motion, wanted, NULL, &unasked),
                              GM_OK);
                GM_ASSERT(busy.energy == still.energy);
                GM_ASSERT_NAN(unasked.energy);
                unasked.energy = busy.energy;
                GM_ASSERT(memcmp(&busy, &unasked, sizeof busy) == 0);
            }
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 40);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(it_is_that_of_the_second_model),
        GM_TEST(between_ideal_flanks_it_is_that_of_one_spring),
        GM_TEST(of_the_simple_model_it_is_that_of_its_spring),
        GM_TEST(material_adds_the_force),
        GM_TEST(torques_and_forces_are_its_gradient),
        GM_TEST(over_a_mesh_cycle_it_is_the_work),
        GM_TEST(it_is_zero_apart_and_nan_unasked),
        GM_TEST(it_depends_on_the_place_alone),
    };
    return gm_test_main("property.energy", tests, GM_TEST_COUNT(tests), argc, argv);
}
