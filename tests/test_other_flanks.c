/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * How the force of constant stiffness grows with other flanks: against differences between meshes of their own. Of elastic
 * teeth test_elastic_mesh.c has the same.
 */
#include "gm_test.h"
#include "plain_mesh.h"
#include "random_gears.h"

#include <math.h>
#include <stdlib.h>

/* The same flanks of both gears, from less to more of all their deviations; the middle ones as drawn. */
enum { SIZES = 5, DRAWN = 2 };
typedef struct grown_case {
    gm_pair_params params;
    model_pair model;
    gm_pair pair;
    double amplitude; /* of the deviations (m) */
    random_flanks flanks[SIZES][2];
} grown_case;

/* step: of the deviations from one size to the next (1). */
static void grown_case_make(grown_case *c, uint64_t *seed, int is_ring, double step) {
    if (is_ring) {
        random_ring_params(seed, &c->params, &c->model);
    } else {
        random_params(seed, &c->params, &c->model);
    }
    GM_ASSERT_INT(gm_pair_init(&c->pair, &c->params), GM_OK);
    c->amplitude = gm_test_uniform(seed, 0.2e-3, 2e-3) * c->pair.normal_module;
    for (int gear = 0; gear < 2; ++gear) {
        const uint64_t begin = *seed;
        for (int k = 0; k < SIZES; ++k) {
            *seed = begin;
            random_flanks_make(&c->flanks[k][gear], seed, &c->pair, gear,
                               c->amplitude * (1.0 + (k - DRAWN) * step));
        }
    }
}

static void grown_case_free(grown_case *c) {
    for (int k = 0; k < SIZES; ++k) {
        random_flanks_free(&c->flanks[k][0]);
        random_flanks_free(&c->flanks[k][1]);
    }
}

/* From forces at even steps: 1 if they have no kink between them, and their slope. */
static int slope_of(const double force[SIZES], double step, double scale, double *slope) {
    const double near = (force[3] - force[1]) / (2.0 * step);
    const double far = (force[4] - force[0]) / (4.0 * step);
    const double bend = (force[4] - 2.0 * force[2] + force[0]) / (4.0 * step);
    const double near_bend = (force[3] - 2.0 * force[2] + force[1]) / step;
    *slope = near + (near - far) / 3.0;
    return fabs(near - far) < 3e-6 * scale && fabs(bend - near_bend) < 1e-4 * scale;
}

/* Tables, pitch and reliefs of both gears, on all teeth: between parallel axes, shifted ones and tilted ones. */
static void force_by_flanks_is_that_of_differences(void) {
    const double step = 1e-5;
    uint64_t seed = UINT64_C(411);
    int compared = 0, tilted = 0, straight = 0, in_part = 0, rings = 0;
    for (int i = 0; i < 600; ++i) {
        grown_case c;
        gm_test_context("case %d", i);
        grown_case_make(&c, &seed, i % 4 == 1, step);
        gm_mesh_params law = plain_law(GM_CORNER_OFF);
        law.pose = random_pose(&seed, &c.pair, i % 3 == 0 ? 0.02 : 0.0);
        if (i % 3 == 1) {
            law.pose = (gm_pose){0};
        }
        const gm_position position = random_pressed(&seed, &c.pair, i);

        /* What the meshes of all sizes bear there. */
        double force[SIZES], by[4];
        gm_mesh_result r;
        gm_mesh *mesh = NULL;
        plain_mesh room;
        int status = GM_OK;
        for (int k = 0; k < SIZES && status == GM_OK; ++k) {
            const gm_flanks *const use[2] = {c.flanks[k][0].flanks, c.flanks[k][1].flanks};
            status = plain_mesh_of(&room, &c.pair, use, &law, &mesh);
            if (status == GM_OK) {
                status = gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r);
            }
            force[k] = r.force;
        }
        if (status != GM_OK) { /* this pose is none */
            grown_case_free(&c);
            continue;
        }

        /* And what the drawn one says of it: of one gear, of the other, of both, and of nothing. */
        const gm_flanks *const *flanks =
            (const gm_flanks *const[]){c.flanks[DRAWN][0].flanks, c.flanks[DRAWN][1].flanks};
        const gm_flanks *pinion[4] = {flanks[0], NULL, flanks[0], NULL};
        const gm_flanks *wheel[4] = {NULL, flanks[1], flanks[1], NULL};
        GM_ASSERT_INT(plain_mesh_of(&room, &c.pair, flanks, &law, &mesh), GM_OK);
        GM_ASSERT_INT(gm_mesh_force_by_flanks(mesh, &position, pinion, wheel, 4, NULL, by), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
        const double scale = plain_stiffness * c.amplitude;
        GM_ASSERT_ABS(by[0] + by[1], by[2], 1e-9 * scale);
        GM_ASSERT(by[3] == 0.0);
        double slope;
        if (slope_of(force, step, scale, &slope)) {
            GM_ASSERT_ABS(by[2], slope, 1e-7 * scale);
            const double contact = r.contact.drive_contact + r.contact.coast_contact;
            const int touches = fabs(slope) > 0.01 * scale;
            compared += touches;
            tilted += touches && i % 3 == 0;
            rings += touches && i % 4 == 1;
            straight += touches && c.pair.face_advance == 0.0;
            in_part += touches && fabs(contact - round(contact)) > 0.01;
        }
        grown_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 450);
    GM_ASSERT(tilted > 150);
    GM_ASSERT(rings > 100);
    GM_ASSERT(straight > 80);
    GM_ASSERT(in_part > 300);
}

/* Flanks of 3 by 4 nodes and of one pitch, `amount` of a unit more of one gear; the unit alone has 2 by 3 nodes. */
static gm_flanks *flanks_with(int teeth, int is_unit, double base, double amount, void **memory) {
    const gm_flanks_params sizes = {.teeth = teeth,
                                    .drive_tables = 1,
                                    .drive_face_nodes = is_unit ? 2 : 3,
                                    .drive_profile_nodes = is_unit ? 3 : 4};
    const int faces = sizes.drive_face_nodes - 1, profiles = sizes.drive_profile_nodes - 1;
    gm_flanks *flanks;
    double values[12];
    *memory = malloc(gm_flanks_size(&sizes));
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, *memory, gm_flanks_size(&sizes)), GM_OK);
    for (int node = 0; node < (faces + 1) * (profiles + 1); ++node) {
        const int across = node / (profiles + 1), along = node % (profiles + 1);
        const double t1 = (double)across / faces, t2 = (double)along / profiles;
        const double unit = 0.4 + 1.1 * (t1 - 0.5) - 0.9 * (t2 - 0.3) + 0.7 * t1 * t2;
        values[node] = base * sin(1.3 * node + 0.4) + amount * unit;
    }
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, GM_ALL_TEETH, 0.2 * amount), GM_OK);
    return flanks;
}

/* A change has nodes of its own, and may be many times as large as the overlap, or hardly any: it is what it is per size. */
static void a_change_needs_neither_the_nodes_nor_the_size_of_the_flanks(void) {
    static const double sizes[] = {1e-9, 1e-6, 1e-3, 0.1};
    const double base = 4e-6, step = 1e-10;
    const gm_mesh_params law = plain_law(GM_CORNER_OFF);
    uint64_t seed = UINT64_C(412);
    int compared = 0;
    for (int i = 0; i < 60; ++i) {
        gm_pair_params params;
        model_pair model;
        gm_pair pair;
        gm_test_context("case %d", i);
        random_params(&seed, &params, &model);
        GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);
        const double depth = gm_test_uniform(&seed, 0.0, 2.0 * base);
        gm_position position;
        (void)gm_position_from_pinion_angle(&pair, gm_test_uniform(&seed, 0.0, 6.0),
                                            0.5 * pair.backlash + depth, 0.0, &position);
        const int role = i % 2;
        const int teeth = role == GM_PINION ? pair.pinion.teeth : pair.wheel.teeth;

        double force[SIZES];
        gm_mesh_result r;
        gm_mesh *mesh;
        plain_mesh room;
        void *memory = NULL;
        for (int k = 0; k <= SIZES; ++k) { /* the drawn one last */
            const double amount = k < SIZES ? (k - DRAWN) * step : 0.0;
            free(memory);
            const gm_flanks *use[2] = {NULL, NULL};
            use[role] = flanks_with(teeth, 0, base, amount, &memory);
            GM_ASSERT_INT(plain_mesh_of(&room, &pair, use, &law, &mesh), GM_OK);
            GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
            force[k < SIZES ? k : DRAWN] = r.force;
        }
        double slope;
        if (slope_of(force, step, plain_stiffness, &slope) && slope != 0.0) {
            for (int k = 0; k < 4; ++k) {
                void *unit_memory;
                const gm_flanks *change = flanks_with(teeth, 1, 0.0, sizes[k], &unit_memory);
                const gm_flanks *none = NULL;
                double by;
                GM_ASSERT_INT(
                    gm_mesh_force_by_flanks(mesh, &position, role == GM_PINION ? &change : &none,
                                            role == GM_WHEEL ? &change : &none, 1, NULL, &by),
                    GM_OK);
                GM_ASSERT_ABS(by / sizes[k], slope, 1e-7 * plain_stiffness);
                free(unit_memory);
            }
            ++compared;
        }
        free(memory);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 40);
}

/* The simple model has no flanks; under a tip corner the overlap is no parabola. */
static void what_has_no_answer_is_refused(void) {
    uint64_t seed = UINT64_C(413);
    random_case c;
    GM_ASSERT_INT(random_case_make(&c, &seed, 0), GM_OK);
    gm_mesh_params laws[3] = {plain_law(GM_CORNER_OFF), plain_law(GM_CORNER_ON),
                              plain_law(GM_CORNER_OFF)};
    laws[2].model = GM_MODEL_SIMPLE;
    gm_position position;
    (void)gm_position_from_pinion_angle(&c.pair, 0.1, 0.0, 0.0, &position);
    for (int k = 0; k < 3; ++k) {
        const gm_flanks *none = NULL;
        gm_mesh *mesh;
        plain_mesh room;
        double by = 1.0;
        GM_ASSERT_INT(plain_mesh_of(&room, &c.pair, NULL, &laws[k], &mesh), GM_OK);
        GM_ASSERT_INT(gm_mesh_force_by_flanks(mesh, &position, &none, &none, 1, NULL, &by),
                      k == 0 ? GM_OK : GM_ERR_PARAMETER);
        GM_ASSERT(k == 0 ? by == 0.0 : isnan(by));
    }
    random_case_free(&c);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(force_by_flanks_is_that_of_differences),
        GM_TEST(a_change_needs_neither_the_nodes_nor_the_size_of_the_flanks),
        GM_TEST(what_has_no_answer_is_refused),
    };
    return gm_test_main("unit.other_flanks", tests, GM_TEST_COUNT(tests), argc, argv);
}
