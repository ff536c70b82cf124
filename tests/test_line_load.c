/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Line loads with constant stiffness: the largest one, which lies anywhere on a line. Of corners test_corner_mesh.c has the
 * points themselves, of elastic teeth test_elastic_mesh.c.
 */
#include "flank.h"
#include "gm_test.h"
#include "random_gears.h"

static const double stiffness_of_all = 1e8;

typedef union room {
    double alignment;
    char memory[8192];
} room;

static int make_mesh(room *where, const random_case *c, int corner, const gm_pose *pose,
                     gm_mesh **mesh) {
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = stiffness_of_all;
    law.corner_contact = corner;
    law.pose = *pose;
    return gm_mesh_init(mesh, &law, &c->pair, c->use[0], c->use[1], where->memory,
                        sizeof where->memory);
}

/* The second model cuts each line at all grid lines and edges. Not where a line just ends or begins, which rounding moves. */
static void largest_line_load_is_that_of_the_second_model(void) {
    uint64_t seed = UINT64_C(311);
    const gm_pose none = {0.0, 0.0, 0.0, 0.0, 0.0};
    int compared = 0, inside = 0;
    for (int i = 0; i < 800; ++i) {
        random_case c;
        room where;
        gm_mesh *mesh;
        gm_position position;
        gm_line_loads load;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        GM_ASSERT_INT(make_mesh(&where, &c, GM_CORNER_OFF, &none, &mesh), GM_OK);
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
                stiffness_of_all / c.pair.face_width * (double)fmaxl(m.largest[0], m.largest[1]);
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

/* All flanks of the pinion's side lose so much. */
static void thin(random_case *c, int side, double by) {
    gmi_tables *tables = &c->flanks[GM_PINION].flanks->side[side];
    for (int tooth = 0; tooth < c->pair.pinion.teeth; ++tooth) {
        tables->pitch[tooth] -= by;
    }
    tables->peak -= by;
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
        const double m = c.pair.normal_module;
        const double tilt =
            i % 3 == 0 ? 0.0 : 0.02 * c.pair.transverse_base_pitch / c.pair.face_width;
        const gm_pose pose = {
            gm_test_uniform(&seed, -5e-3, 5e-3) * m, gm_test_uniform(&seed, -1e-3, 1e-3) * m,
            gm_test_uniform(&seed, -1e-2, 1e-2) * m, gm_test_uniform(&seed, -tilt, tilt),
            gm_test_uniform(&seed, -tilt, tilt)};
        const int corner = i % 2 == 0 ? GM_CORNER_OFF : GM_CORNER_ON;
        const int side = i % 7 == 0 ? GM_COAST : GM_DRIVE;
        gm_position position;
        (void)gm_position_from_pinion_angle(
            &c.pair, gm_test_uniform(&seed, 0.0, 6.0),
            (side == GM_DRIVE ? 1.0 : -1.0) *
                (0.5 * c.pair.backlash + gm_test_uniform(&seed, 0.5e-3, 5e-3) * m),
            0.0, &position);
        room where;
        gm_mesh *mesh;
        gm_line_loads load;
        gm_mesh_result r;
        int status = c.use[GM_PINION] == NULL || c.pair.face_advance == 0.0 ? GM_ERR_NULL : GM_OK;
        if (status == GM_OK) {
            status = make_mesh(&where, &c, corner, &pose, &mesh);
        }
        if (status == GM_OK) {
            (void)gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r);
            status = gm_mesh_line_loads(mesh, &position, NULL, NULL, 0, &load);
        }
        const double other =
            status == GM_OK ? side == GM_DRIVE ? r.coast_force : r.drive_force : 1.0;
        if (other == 0.0 && load.largest_line_load > 0.0) {
            const double overlap = load.largest_line_load * c.pair.face_width / stiffness_of_all;
            for (int k = 0; k < 2; ++k) {
                const double by = overlap * (k == 0 ? 0.999 : 1.001);
                thin(&c, side, by);
                GM_ASSERT_INT(make_mesh(&where, &c, corner, &pose, &mesh), GM_OK);
                GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
                GM_ASSERT((r.drive_force + r.coast_force > 0.0) == (k == 0));
                thin(&c, side, -by);
            }
            ++compared;
            tilted += tilt > 0.0;
            cornered += corner == GM_CORNER_ON;
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
