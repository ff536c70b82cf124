/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The copy of the walks along lines of contact for processors with vectors of four doubles (wide.h): it does the same
 * operations in the same order, so that every result has the same bits with it and without.
 */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "mesh.h"
#include "random_gears.h"
#include "wide.h"

enum { CASES = 200, LOADS = 6 };

/* Everything that follows lines: sums, derivatives, moments, squares, stretches, and many depths at once. */
typedef struct results {
    gm_mesh_result force, at, posed;
    gm_tangent tangent;
    double offsets[LOADS];
    gm_mesh_result loaded[LOADS];
    int status[5];
} results;

static void set_wide(gm_mesh *mesh, int is_wide) {
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        mesh->side[side].pinion_grid.is_wide = mesh->side[side].wheel_grid.is_wide = is_wide;
    }
}

static gm_mesh *make_mesh(const random_case *c, int i) {
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.stiffness = 1e8;
    params.damping = i % 2 == 0 ? 1e3 : 0.0;
    params.friction_coefficient = i % 3 == 0 ? 0.05 : 0.0;
    const size_t size = gm_mesh_size(&params, &c->pair);
    gm_mesh *mesh = NULL;
    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &c->pair, c->use[0], c->use[1], malloc(size), size),
                  GM_OK);
    return mesh;
}

static void evaluate_all(const gm_mesh *mesh, const gm_motion *motion, results *r) {
    memset(r, 0, sizeof *r);
    r->status[0] =
        gm_mesh_evaluate_at(mesh, &motion->position,
                            GM_WANT_DERIVATIVES | GM_WANT_WRENCH | GM_WANT_ENERGY, NULL, &r->at);
    r->status[1] = gm_mesh_evaluate_posed(mesh, motion, GM_WANT_FORCE, NULL, &r->posed);
    r->status[2] = gm_mesh_tangent(mesh, motion, &r->tangent);

    /* One walk at all depths: not with friction. */
    double loads[LOADS];
    for (int n = 0; n < LOADS; ++n) {
        loads[n] = 5.0 * (n + 1);
    }
    r->status[3] = gm_rolling_equilibria(mesh, 0.1 * motion->position.phase, 100.0, loads, LOADS,
                                         GM_WANT_FORCE, NULL, r->offsets, r->loaded);

    /* The sum alone has a way of its own. */
    r->status[4] = gm_mesh_evaluate_at(mesh, &motion->position, GM_WANT_FORCE, NULL, &r->force);
}

/* Random pairs of all kinds with tables, ramps and none, posed and tilted, with friction and damping. */
static void walks_give_the_same_bits(void) {
    uint64_t seed = UINT64_C(20261);
    int touching = 0;
    for (int i = 0; i < CASES; ++i) {
        random_case c;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        gm_mesh *mesh = make_mesh(&c, i);
        const int is_wide = mesh->side[GM_DRIVE].pinion_grid.is_wide;
        GM_ASSERT_INT(is_wide, gmi_processor_is_wide());

        const double x = 0.5 * c.pair.backlash + 0.3 * c.amplitude +
                         1e-3 * c.params.normal_module * gm_test_uniform(&seed, 0.0, 2.0);
        const double tilt = i % 4 == 0 ? 0.0 : 1e-4;
        gm_motion motion = {.pose = {gm_test_uniform(&seed, -1e-6, 1e-6), 0.0,
                                     i % 5 == 0 ? 0.0 : gm_test_uniform(&seed, -1e-4, 1e-4),
                                     gm_test_uniform(&seed, -tilt, tilt), 0.0}};
        GM_ASSERT_INT(gm_position_from_pinion_angle(&c.pair, gm_test_uniform(&seed, 0.0, 6.0),
                                                    i % 2 == 0 ? x : -x, 1e-3, &motion.position),
                      GM_OK);
        motion.position.pinion_speed = 100.0;

        results plain, wide;
        set_wide(mesh, 0);
        evaluate_all(mesh, &motion, &plain);
        set_wide(mesh, is_wide);
        evaluate_all(mesh, &motion, &wide);
        GM_ASSERT_INT(memcmp(&plain, &wide, sizeof plain), 0);
        touching += plain.status[0] == GM_OK && plain.at.force != 0.0 && plain.status[1] == GM_OK &&
                    plain.posed.force != 0.0 && plain.status[2] == GM_OK;
        free(mesh);
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(touching > CASES / 2);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(walks_give_the_same_bits),
    };
    return gm_test_main("unit.line_wide", tests, GM_TEST_COUNT(tests), argc, argv);
}
