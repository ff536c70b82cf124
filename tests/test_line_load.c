/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Line loads with constant stiffness: the largest one, which lies anywhere on a line. Of corners test_corner_mesh.c has the
 * points themselves, of elastic teeth test_elastic_mesh.c.
 */
#include "gm_test.h"
#include "plain_mesh.h"
#include "random_gears.h"

/* The second model cuts each line at all grid lines and edges. Not where a line just ends or begins, which rounding moves. */
static void largest_line_load_is_that_of_the_second_model(void) {
    uint64_t seed = UINT64_C(311);
    const gm_mesh_params law = plain_law(GM_CORNER_OFF);
    int compared = 0, inside = 0;
    for (int i = 0; i < 800; ++i) {
        random_case c;
        plain_mesh room;
        gm_mesh *mesh;
        gm_position position;
        gm_line_loads load;

        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        GM_ASSERT_INT(plain_mesh_of(&room, &c.pair, c.use, &law, &mesh), GM_OK);
        const gm_state state = {.pinion_angle = c.pinion_angle, .wheel_angle = c.wheel_angle};
        GM_ASSERT_INT(gm_position_from_state(&c.pair, &state, &position), GM_OK);

        const int points = gm_mesh_line_load_points(mesh);
        gm_line_load_point *list = malloc((size_t)points * sizeof *list);
        GM_ASSERT_INT(gm_mesh_line_loads(mesh, &position, NULL, list, points, &load), GM_OK);

        const double e =
            1e-13 * fmax(c.params.center_distance, (double)c.model.reference_radius[1]);
        double bounds[2];
        for (int k = 0; k < 2; ++k) {
            model_result m;
            model_evaluate(&c.model, c.model_use[0], c.model_use[1], c.pinion_angle, c.wheel_angle,
                           k == 0 ? -e : e, k == 0 ? -e : e, &m);
            bounds[k] =
                plain_stiffness / c.pair.face_width * (double)fmaxl(m.largest[0], m.largest[1]);
        }
        if (bounds[0] > 0.0) {
            GM_ASSERT(load.largest_line_load >= bounds[0] * (1.0 - 1e-9));
            GM_ASSERT(load.largest_line_load <= bounds[1] * (1.0 + 1e-9));
            double at_stations = 0.0;
            for (int k = 0; k < load.points; ++k) {
                at_stations = fmax(at_stations, list[k].line_load);
            }
            inside += at_stations < 0.999 * load.largest_line_load;
            ++compared;
        }
        free(list);
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 400);
    GM_ASSERT(inside > 100); /* stations alone would not do */
}

/*
 * The largest overlap is the material that has to go until nothing touches any more: with a part of 1e-3 less gone there is
 * still a force, with as much more none. Also between tilted axes, and beyond tips.
 */
static void as_much_material_gone_and_nothing_touches(void) {
    uint64_t seed = UINT64_C(312);
    int compared = 0, tilted = 0, cornered = 0;
    for (int i = 0; i < 600; ++i) {
        random_case c;
        const int made =
            i % 5 == 0 ? random_ring_case_make(&c, &seed, 1) : random_case_make(&c, &seed, 1);
        gm_test_context("case %d", i);
        GM_ASSERT_INT(made, GM_OK);

        /* Every third without tilts, every second with corners, every seventh on the coast side. */
        gm_mesh_params law = plain_law(i % 2 == 0 ? GM_CORNER_OFF : GM_CORNER_ON);
        law.pose = random_pose(&seed, &c.pair, i % 3 == 0 ? 0.0 : 0.02);
        const int side = i % 7 == 0 ? GM_COAST : GM_DRIVE;
        const double depth = gm_test_uniform(&seed, 0.5e-3, 5e-3) * c.pair.normal_module;
        const double x = (side == GM_DRIVE ? 1.0 : -1.0) * (0.5 * c.pair.backlash + depth);
        gm_position position;
        (void)gm_position_from_pinion_angle(&c.pair, gm_test_uniform(&seed, 0.0, 6.0), x, 0.0,
                                            &position);

        /* Helical gears whose pinion has a table to take from. */
        plain_mesh room;
        gm_mesh *mesh;
        gm_line_loads load;
        gm_mesh_result r;
        int status = c.use[GM_PINION] == NULL || c.pair.face_advance == 0.0 ? GM_ERR_NULL : GM_OK;
        if (status == GM_OK) {
            status = plain_mesh_of(&room, &c.pair, c.use, &law, &mesh);
        }
        if (status == GM_OK) {
            (void)gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r);
            status = gm_mesh_line_loads(mesh, &position, NULL, NULL, 0, &load);
        }

        /* Only where the other flanks, which stay as they are, carry nothing. */
        if (status == GM_OK && (side == GM_DRIVE ? r.coast_force : r.drive_force) == 0.0 &&
            load.largest_line_load > 0.0) {
            const double overlap = load.largest_line_load * c.pair.face_width / plain_stiffness;
            for (int k = 0; k < 2; ++k) {
                random_flanks_grow(&c.flanks[GM_PINION], side, -overlap * (k == 0 ? 0.999 : 1.001));
                GM_ASSERT_INT(plain_mesh_of(&room, &c.pair, c.use, &law, &mesh), GM_OK);
                GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
                GM_ASSERT((r.drive_force + r.coast_force > 0.0) == (k == 0));
            }
            ++compared;
            tilted += i % 3 != 0;
            cornered += law.corner_contact == GM_CORNER_ON;
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 200);
    GM_ASSERT(tilted > 100);
    GM_ASSERT(cornered > 50);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(largest_line_load_is_that_of_the_second_model),
        GM_TEST(as_much_material_gone_and_nothing_touches),
    };
    return gm_test_main("unit.line_load", tests, GM_TEST_COUNT(tests), argc, argv);
}
