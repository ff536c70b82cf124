/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Stiffness of ISO 6336-1, method B: published values, hand-computed ones, and where it ends. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "plain_mesh.h"

static const double per_mm_um = 1e9; /* N/m2 of 1 N/(mm um) */
static const double degree = 3.14159265358979323846 / 180.0;

/* NREL 5 MW, stage 3. */
static gm_pair_params nrel_stage_3(void) {
    gm_pair_params p;
    gm_pair_params_default(&p);
    p.pinion_teeth = 24;
    p.wheel_teeth = 95;
    p.normal_module = 14e-3;
    p.normal_pressure_angle = 20.0 * degree;
    p.helix_angle = 10.0 * degree;
    p.center_distance = 0.861;
    p.face_width = 0.36;
    p.pinion_profile_shift = 0.48;
    p.wheel_profile_shift = 0.6691;
    p.pinion_tip_radius = 0.5 * 0.380747;
    p.wheel_tip_radius = 0.5 * 1.395376;
    return p;
}

/* Spur gears without shift on the rack for which C_B is 1. */
static gm_pair_params plain_spur(int pinion_teeth, int wheel_teeth) {
    gm_pair_params p;
    gm_pair_params_default(&p);
    p.pinion_teeth = pinion_teeth;
    p.wheel_teeth = wheel_teeth;
    p.normal_module = 2e-3;
    p.normal_pressure_angle = 20.0 * degree;
    p.center_distance = 1e-3 * (pinion_teeth + wheel_teeth);
    p.face_width = 0.02;
    p.pinion_profile_shift = p.wheel_profile_shift = 0.0;
    p.pinion_rack_dedendum = p.wheel_rack_dedendum = 1.2;
    return p;
}

static gm_pair pair_of(const gm_pair_params *params) {
    gm_pair pair;
    GM_ASSERT_INT(gm_pair_init(&pair, params), GM_OK);
    return pair;
}

/* KISSsoft's report of the model, C_R as printed there: to half a unit of its last place. */
static void published_stiffness_comes_out(void) {
    const gm_pair_params params = nrel_stage_3();
    const gm_pair pair = pair_of(&params);
    GM_ASSERT_ABS(gm_iso6336_single_stiffness(&pair, 0.898) / per_mm_um, 13.832, 5e-4);
    GM_ASSERT_ABS(gm_iso6336_mesh_stiffness(&pair, 0.898) / per_mm_um, 18.632, 5e-4);
}

/*
 * KISSsoft's reports of the planetary stages: sun and planet, planet and ring, with the same C_R of 0.862. Both values of
 * a stage to half a unit of their last place against each other; each to that of C_R. In stage 1 the planet has fewer
 * teeth than the sun that drives it.
 */
static void published_stiffness_of_planetary_stages(void) {
    static const struct {
        int sun, planet, ring;
        double module, sun_distance, ring_distance, shift[3], inner, outer;
    } stages[] = {
        {19, 17, -56, 45e-3, 0.863, 0.863, {0.6170, 0.8021, -0.5013}, 12.362, 13.289},
        {18, 36, -93, 21e-3, 0.584, 0.584, {0.3890, 0.5039, 0.1171}, 12.240, 14.053},
    };
    for (int k = 0; k < 2; ++k) {
        gm_test_context("stage %d", k + 1);
        gm_pair_params params = plain_spur(stages[k].sun, stages[k].planet);
        params.normal_module = stages[k].module;
        params.center_distance = stages[k].sun_distance;
        params.pinion_profile_shift = stages[k].shift[0];
        params.wheel_profile_shift = stages[k].shift[1];
        params.pinion_rack_dedendum = params.wheel_rack_dedendum = 1.25;
        gm_pair pair = pair_of(&params);
        const double inner = gm_iso6336_single_stiffness(&pair, 0.862) / per_mm_um;

        params.pinion_teeth = stages[k].planet;
        params.wheel_teeth = stages[k].ring;
        params.center_distance = stages[k].ring_distance;
        params.pinion_profile_shift = stages[k].shift[1];
        params.wheel_profile_shift = stages[k].shift[2];
        params.pinion_tip_alteration = k == 0 ? -0.2413 : -0.08338; /* of the mesh with the sun */
        pair = pair_of(&params);
        const double outer = gm_iso6336_single_stiffness(&pair, 0.862) / per_mm_um;
        GM_ASSERT_REL(inner, stages[k].inner, 0.0005 / 0.862);
        GM_ASSERT_REL(outer, stages[k].outer, 0.0005 / 0.862);
        GM_ASSERT_REL(outer / inner, stages[k].outer / stages[k].inner,
                      0.0005 / 12.24 + 0.0005 / 13.289);
    }
    gm_test_context("%s", "");
}

/* Without shift and helix: 0.8 / (0.04723 + 0.15551 / 20 + 0.25791 / 40) = 0.8 / 0.06145325. */
static void spur_gears_without_shift_by_hand(void) {
    gm_pair_params params = plain_spur(20, 40);
    gm_pair pair = pair_of(&params);
    const double expected = 0.8 / 0.06145325 * per_mm_um;
    GM_ASSERT_REL(gm_iso6336_single_stiffness(&pair, 1.0), expected, 1e-12);
    GM_ASSERT_REL(gm_iso6336_single_stiffness(&pair, 0.7), 0.7 * expected, 1e-12);

    /* The rack: 1 + 0.5 (1.2 - 1.25) = 0.975 of both, half of it of one; 2 % for each degree of pressure angle. */
    params.pinion_rack_dedendum = 1.25;
    pair = pair_of(&params);
    GM_ASSERT_REL(gm_iso6336_single_stiffness(&pair, 1.0), 0.9875 * expected, 1e-12);
    params = plain_spur(20, 40);
    params.normal_pressure_angle = 22.5 * degree;
    pair = pair_of(&params);
    GM_ASSERT_REL(gm_iso6336_single_stiffness(&pair, 1.0), 1.05 * expected, 1e-12);
}

/* A ring has infinitely many teeth there: 0.8 / (0.04723 + 0.15551 / 40) = 0.8 / 0.05111775; of x_2 -0.00193 is left. */
static void a_ring_is_as_stiff_as_a_rack(void) {
    gm_pair_params params = plain_spur(40, -100);
    params.center_distance = 0.06;
    gm_pair pair = pair_of(&params);
    GM_ASSERT_REL(gm_iso6336_single_stiffness(&pair, 1.0), 0.8 / 0.05111775 * per_mm_um, 1e-12);
    params.wheel_profile_shift = 0.1;
    pair = pair_of(&params);
    const double q = 0.05111775 - 0.000193 + 0.0000182;
    GM_ASSERT_REL(gm_iso6336_single_stiffness(&pair, 1.0), 0.8 / q * per_mm_um, 1e-12);
}

/* x = 0.3 / 0.1 adds -0.001905 - 0.034962 / 20 - 0.000193 - 0.024188 / 40 + 0.0004761 + 0.0000182 to q'. */
static void profile_shifts_by_hand(void) {
    gm_pair_params params = plain_spur(20, 40);
    params.pinion_profile_shift = 0.3;
    params.wheel_profile_shift = 0.1;
    params.center_distance = 0.0608;
    const gm_pair pair = pair_of(&params);
    const double q =
        0.06145325 - 0.001905 - 0.0017481 - 0.000193 - 0.0006047 + 0.0004761 + 0.0000182;
    GM_ASSERT_REL(gm_iso6336_single_stiffness(&pair, 1.0), 0.8 / q * per_mm_um, 1e-12);
}

/* Which gear drives is no matter, and neither is the hand. */
static void stiffness_is_that_of_the_pair(void) {
    gm_pair_params params = nrel_stage_3();
    const gm_pair pair = pair_of(&params);
    const double expected = gm_iso6336_single_stiffness(&pair, 1.0);
    const int warnings = gm_iso6336_warnings(&pair);

    gm_pair_params other = nrel_stage_3();
    other.pinion_teeth = params.wheel_teeth;
    other.wheel_teeth = params.pinion_teeth;
    other.pinion_profile_shift = params.wheel_profile_shift;
    other.wheel_profile_shift = params.pinion_profile_shift;
    other.pinion_tip_radius = params.wheel_tip_radius;
    other.wheel_tip_radius = params.pinion_tip_radius;
    other.helix_angle = -params.helix_angle;
    const gm_pair swapped = pair_of(&other);
    GM_ASSERT_REL(gm_iso6336_single_stiffness(&swapped, 1.0), expected, 1e-12);
    GM_ASSERT_INT(gm_iso6336_warnings(&swapped), warnings);
}

/* Of gears with as many teeth as each other 1 is the one with the larger shift. */
static void of_equal_numbers_of_teeth_the_larger_shift_is_first(void) {
    for (int swapped = 0; swapped < 2; ++swapped) {
        gm_pair_params params = plain_spur(25, 25);
        params.pinion_profile_shift = swapped ? 0.1 : 0.3;
        params.wheel_profile_shift = swapped ? 0.3 : 0.1;
        params.center_distance = 0.0507;
        const gm_pair pair = pair_of(&params);
        const double q = 0.04723 + (0.15551 + 0.25791) / 25.0 - 0.00635 * 0.3 -
                         0.11654 * 0.3 / 25.0 - 0.00193 * 0.1 - 0.24188 * 0.1 / 25.0 +
                         0.00529 * 0.09 + 0.00182 * 0.01;
        GM_ASSERT_REL(gm_iso6336_single_stiffness(&pair, 1.0), 0.8 / q * per_mm_um, 1e-12);
        GM_ASSERT_REL(gm_iso6336_single_stiffness(&pair, 5e-4), 4e-4 / q * per_mm_um, 1e-12);
        GM_ASSERT_INT(gm_iso6336_warnings(&pair), 0);
    }
}

static void gears_outside_the_fit_are_told(void) {
    gm_pair_params params = nrel_stage_3();
    gm_pair pair = pair_of(&params);
    GM_ASSERT_INT(gm_iso6336_warnings(&pair), GM_WARN_ISO6336_SHIFT_ORDER);
    params.pinion_profile_shift = 0.6;
    params.wheel_profile_shift = 0.5;
    pair = pair_of(&params);
    GM_ASSERT_INT(gm_iso6336_warnings(&pair), 0);

    params = plain_spur(30, 60);
    params.pinion_profile_shift = -0.2;
    params.wheel_profile_shift = -0.31;
    params.center_distance = 0.0890;
    pair = pair_of(&params);
    GM_ASSERT_INT(gm_iso6336_warnings(&pair), GM_WARN_ISO6336_SHIFT_SUM);
    params = plain_spur(30, 60);
    params.pinion_profile_shift = 1.5;
    params.wheel_profile_shift = 0.51;
    params.center_distance = 0.0935;
    pair = pair_of(&params);
    GM_ASSERT_INT(gm_iso6336_warnings(&pair), GM_WARN_ISO6336_SHIFT_SUM);

    /* Sums on the limits are within them. */
    static const double within[4][2] = {{0.0, -0.5}, {1.5, 0.5}, {0.0, -0.5005}, {1.5, 0.5005}};
    for (int k = 0; k < 4; ++k) {
        gm_test_context("sum %g", within[k][0] + within[k][1]);
        params = plain_spur(30, 60);
        params.pinion_profile_shift = within[k][0];
        params.wheel_profile_shift = within[k][1];
        params.center_distance = k % 2 == 0 ? 0.0890 : 0.0935;
        pair = pair_of(&params);
        GM_ASSERT_INT(gm_iso6336_warnings(&pair), k < 2 ? 0 : GM_WARN_ISO6336_SHIFT_SUM);
    }
    gm_test_context("%s", "");

    params = plain_spur(30, 60);
    params.helix_angle = -46.0 * degree;
    params.center_distance = 0.090 / cos(46.0 * degree);
    pair = pair_of(&params);
    GM_ASSERT_INT(gm_iso6336_warnings(&pair), GM_WARN_ISO6336_HELIX);
    GM_ASSERT_INT(gm_iso6336_warnings(NULL), 0);
}

/* K = c' b of the common face, also where the faces differ. */
static void mesh_has_the_single_stiffness_over_the_common_face(void) {
    gm_pair_params params = nrel_stage_3();
    params.pinion_face_width = 0.38;
    params.wheel_face_width = 0.36;
    params.axial_offset = 0.02;
    const gm_pair pair = pair_of(&params);
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.law = GM_LAW_ISO6336; /* and no stiffness */
    law.iso_blank_factor = 0.9;

    plain_mesh room;
    gm_mesh *mesh;
    GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, &room, sizeof room), GM_OK);
    const double k = gm_iso6336_single_stiffness(&pair, 0.9) * 0.35;
    GM_ASSERT_REL(gm_mesh_mean_stiffness(mesh), k * pair.transverse_contact_ratio, 1e-12);

    /* Force of the mesh: K times the overlap. */
    gm_mesh_result result;
    const gm_state state = {.pinion_angle = 1e-4};
    GM_ASSERT_INT(gm_mesh_evaluate(mesh, &state, GM_WANT_FORCE, NULL, &result), GM_OK);
    GM_ASSERT(result.force > 0.0);
    GM_ASSERT_REL(result.force, k * result.contact.penetration, 1e-12);
}

static void gears_without_a_stiffness_are_refused(void) {
    gm_pair_params params = plain_spur(20, 40);
    params.pinion_rack_dedendum = params.wheel_rack_dedendum = 3.3; /* C_B < 0 */
    const gm_pair pair = pair_of(&params);
    GM_ASSERT_NAN(gm_iso6336_single_stiffness(&pair, 1.0));
    GM_ASSERT_NAN(gm_iso6336_mesh_stiffness(&pair, 1.0));
    GM_ASSERT_NAN(gm_iso6336_single_stiffness(NULL, 1.0));
    GM_ASSERT_NAN(gm_iso6336_mesh_stiffness(NULL, 1.0));

    const gm_pair_params good = plain_spur(20, 40);
    const gm_pair good_pair = pair_of(&good);
    GM_ASSERT_NAN(gm_iso6336_single_stiffness(&good_pair, 0.0));
    GM_ASSERT_NAN(gm_iso6336_single_stiffness(&good_pair, NAN));

    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.law = GM_LAW_ISO6336;
    plain_mesh room;
    gm_mesh *mesh;
    GM_ASSERT(gm_mesh_size(&law, &pair) == 0);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, &room, sizeof room),
                  GM_ERR_GEOMETRY);
    GM_ASSERT(gm_mesh_size(&law, &good_pair) > 0);

    /* q' falls below 0 at numbers of teeth and shifts that no gear has. */
    gm_pair shifted = good_pair;
    shifted.pinion.teeth = 3;
    shifted.wheel.teeth = 4;
    shifted.pinion.profile_shift = 4.0;
    shifted.wheel.profile_shift = 20.0;
    GM_ASSERT_NAN(gm_iso6336_single_stiffness(&shifted, 1.0));

    const char *field = NULL;
    law.iso_blank_factor = 0.0099;
    GM_ASSERT_INT(gm_mesh_params_check(&law, &field, NULL), GM_ERR_PARAMETER);
    GM_ASSERT_STRING(field, "iso_blank_factor");
    law.iso_blank_factor = 2.001;
    GM_ASSERT_INT(gm_mesh_params_check(&law, &field, NULL), GM_ERR_PARAMETER);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(published_stiffness_comes_out),
        GM_TEST(published_stiffness_of_planetary_stages),
        GM_TEST(spur_gears_without_shift_by_hand),
        GM_TEST(a_ring_is_as_stiff_as_a_rack),
        GM_TEST(profile_shifts_by_hand),
        GM_TEST(stiffness_is_that_of_the_pair),
        GM_TEST(of_equal_numbers_of_teeth_the_larger_shift_is_first),
        GM_TEST(gears_outside_the_fit_are_told),
        GM_TEST(mesh_has_the_single_stiffness_over_the_common_face),
        GM_TEST(gears_without_a_stiffness_are_refused),
    };
    return gm_test_main("unit.iso6336", tests, GM_TEST_COUNT(tests), argc, argv);
}
