/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Pairs of a pinion and a ring: published numbers, the frame, and what is in the way of their tips. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "random_gears.h"
#include "reference_gear.h"

static const double pi = 3.14159265358979323846;
static const double degree = 0.017453292519943295;

static gm_pair_params ring_params(int pinion_teeth, int ring_teeth, double module, double distance,
                                  double x_p, double x_w) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = pinion_teeth;
    params.wheel_teeth = -ring_teeth;
    params.normal_module = module;
    params.normal_pressure_angle = 20.0 * degree;
    params.center_distance = distance;
    params.face_width = 10.0 * module;
    params.pinion_profile_shift = x_p;
    params.wheel_profile_shift = x_w;
    return params;
}

/* ---------------------------------------------------------------------------------------------
 * The drawing
 * ------------------------------------------------------------------------------------------- */

/*
 * Planet and ring of stage 2 of the open NREL 5 MW wind turbine model, with the digits of its KISSsoft report, the angle
 * to a unit of the last one. The tip of the planet is the one that it has for the sun: k m_n = -1.751 mm.
 */
static void a_published_ring_has_its_geometry(void) {
    const double mm = 1e-3;
    gm_pair_params params = ring_params(36, 93, 21.0 * mm, 584.0 * mm, 0.5039, 0.1171);
    params.pinion_tip_alteration = -1.751 / 21.0;
    const gm_pair p = make_pair(&params);
    GM_ASSERT_ABS(p.working_pressure_angle, 15.630 * degree, 1e-3 * degree);
    GM_ASSERT_ABS(p.line_of_action, 157.339 * mm, 0.5e-3 * mm);
    GM_ASSERT_ABS(p.transverse_contact_ratio, 1.618, 0.5e-3);

    /* Shifts with four digits leave so much backlash: 2 m_n tan(alpha_n) times half a digit of each, cos(alpha_t). */
    GM_ASSERT_ABS(p.backlash, 0.0,
                  2.0 * params.normal_module * sin(params.normal_pressure_angle) * 1e-4);

    /* Lengths are above 0, whatever the sign of the number of teeth. */
    GM_ASSERT_INT(p.wheel.teeth, 93);
    GM_ASSERT_ABS(p.wheel.sign, -1.0, 0.0);
    GM_ASSERT_ABS(p.pinion.sign, 1.0, 0.0);
    GM_ASSERT_ABS(p.reference_center_distance, 598.5 * mm, 1e-15);
    GM_ASSERT_ABS(p.wheel.reference_radius, 976.5 * mm, 1e-15);
    GM_ASSERT_ABS(p.hunting_passes, 1116.0, 0.0);

    /* The axes are closer than the shifts ask for, which a ring's teeth do not mind: k = 0. */
    GM_ASSERT_ABS(p.wheel.tip_alteration, 0.0, 0.0);
    GM_ASSERT_REL(p.wheel.tip_radius, (976.5 - 21.0 * 1.1171) * mm, 1e-15);
    GM_ASSERT_REL(p.wheel.root_radius, (976.5 + 21.0 * (1.25 - 0.1171)) * mm, 1e-15);
    GM_ASSERT_INT(gm_pair_warnings(&p, &params) & ~GM_WARN_BACKLASH_ROUNDED, 0);

    /* Its sun and planet. */
    params = ring_params(18, -36, 21.0 * mm, 584.0 * mm, 0.3890, 0.5039);
    const gm_pair sun = make_pair(&params);
    GM_ASSERT_ABS(sun.working_pressure_angle, 24.169 * degree, 1e-3 * degree);
}

/* Axes further apart than the shifts ask for: the teeth of both are cut so that the clearance of the rack stays. */
static void tips_keep_clear_of_roots(void) {
    const double m_n = 2e-3;
    for (int k = 0; k < 7; ++k) {
        gm_test_context("distance %d", k);
        const double off = 0.1 * (k - 3);
        const gm_pair_params params =
            ring_params(31, 88, m_n, 0.5 * (88 - 31) * m_n + off * m_n, 0.3, (double)NAN);
        const gm_pair p = make_pair(&params);
        const double sum = p.pinion.profile_shift + p.wheel.profile_shift;
        GM_ASSERT_ABS(p.wheel.tip_alteration, fmin(0.0, -off - sum), 1e-14);
        GM_ASSERT_ABS(p.pinion.tip_alteration, p.wheel.tip_alteration, 0.0);

        /* a + r_ap to the root circle, r_aw - a to the pinion's. */
        const double c_p = p.wheel.root_radius - p.center_distance - p.pinion.tip_radius;
        const double c_w = p.wheel.tip_radius - p.center_distance - p.pinion.root_radius;
        GM_ASSERT_ABS(p.pinion_tip_clearance, c_p, 1e-16);
        GM_ASSERT_ABS(p.wheel_tip_clearance, c_w, 1e-16);
        if (-off - sum < 0.0) {
            GM_ASSERT_ABS(c_p, 0.25 * m_n, 1e-15);
            GM_ASSERT_ABS(c_w, 0.25 * m_n, 1e-15);
        } else {
            GM_ASSERT(c_p > 0.25 * m_n - 1e-15);
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * Tips in the way of each other
 * ------------------------------------------------------------------------------------------- */

static void what_is_in_the_way_is_named(void) {
    static const struct {
        int pinion_teeth, ring_teeth;
        const char *field, *says;
    } cases[] = {
        {20, 40, "wheel_tip_radius", "involute interference"},
        {60, 66, "wheel_teeth", "trochoid interference"},
        {60, 72, "wheel_teeth", "trimming"},
        {60, 80, NULL, NULL},
        {60, 60, "wheel_teeth", "more teeth than the pinion"},
        {60, 40, "wheel_teeth", "more teeth than the pinion"},
        {20, 30, "wheel_tip_radius", "larger than the base radius"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        gm_test_context("%d/-%d", cases[k].pinion_teeth, cases[k].ring_teeth);
        const int more = abs(cases[k].ring_teeth - cases[k].pinion_teeth);
        const double apart = more > 0 ? 1e-3 * more : 1e-3;
        const gm_pair_params params =
            ring_params(cases[k].pinion_teeth, cases[k].ring_teeth, 2e-3, apart, 0.0, 0.0);
        const char *field, *requirement;
        const int status = gm_pair_params_check(&params, &field, &requirement);
        if (cases[k].field == NULL) {
            GM_ASSERT_INT(status, GM_OK);
            continue;
        }
        GM_ASSERT_INT(status, GM_ERR_GEOMETRY);
        GM_ASSERT_STRING(field, cases[k].field);
        GM_ASSERT(requirement != NULL && strstr(requirement, cases[k].says) != NULL);
    }
}

/* Wrong numbers by themselves, and in the wrong place. */
static void wrong_numbers_of_teeth_are_refused(void) {
    const char *field;
    gm_pair_params params = ring_params(31, 88, 2e-3, 57e-3, 0.0, 0.0);
    GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_OK);
    params.wheel_teeth = -2;
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_PARAMETER);
    GM_ASSERT_STRING(field, "wheel_teeth");
    params.wheel_teeth = -100001;
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_PARAMETER);
    params.wheel_teeth = -88;
    params.pinion_teeth = -31;
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_PARAMETER);
    GM_ASSERT_STRING(field, "pinion_teeth");

    /* A start on the wrong side of the tip, and axes that are too close. */
    params.pinion_teeth = 31;
    params.wheel_start_radius = 85e-3;
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_GEOMETRY);
    GM_ASSERT_STRING(field, "wheel_start_radius");
    params.wheel_start_radius = (double)NAN;
    params.center_distance = 57e-3 * 0.93;
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_GEOMETRY);
    GM_ASSERT_STRING(field, "center_distance");
}

static double inv(double base_radius, double radius) {
    const double angle = acos(fmin(1.0, base_radius / radius));
    return tan(angle) - angle;
}

/*
 * How deep the pinion's tip corner of the flank that drives gets into a ring tooth, and likewise the ring's into the pinion
 * (m, < 0 not at all), while the flanks touch: both corners are followed through half a turn, in the frame of the mate's
 * tooth. Radii and angles in the plane alone; shares nothing with the formulas of the library.
 */
static double deepest_corner(const gm_pair *p) {
    enum { STEPS = 4000 };
    const double a = p->center_distance;
    const double r_bp = p->pinion.base_radius, r_bw = p->wheel.base_radius;
    const double half_p = p->pinion.base_half_thickness, half_w = p->wheel.base_half_thickness;
    double deepest = -HUGE_VAL;
    for (int k = 0; k < STEPS; ++k) {
        const double phi_p = pi * ((double)k / STEPS - 0.5);
        const double phi_w = (r_bp * phi_p - 0.5 * p->backlash) / r_bw;

        /* The corner of pinion tooth 0, seen from the ring tooth that it touches. */
        const double r_p = p->pinion.tip_radius;
        const double at_p = phi_p + half_p - inv(r_bp, r_p);
        const double x = a + r_p * cos(at_p), y = r_p * sin(at_p);
        const double r = hypot(x, y);
        if (r > p->wheel.tip_radius && r < p->wheel.root_radius) {
            const double flank = phi_w + pi / p->wheel.teeth - half_w - inv(r_bw, r);
            deepest = fmax(deepest, r * (atan2(y, x) - flank));
        }

        /* The corner of that ring tooth, seen from the pinion tooth. */
        const double r_w = p->wheel.tip_radius;
        const double at_w = phi_w + pi / p->wheel.teeth - half_w - inv(r_bw, r_w);
        const double u = r_w * cos(at_w) - a, v = r_w * sin(at_w);
        const double s = hypot(u, v);
        if (s < r_p && s > r_bp) {
            const double flank = phi_p + half_p - inv(r_bp, s);
            deepest = fmax(deepest, s * (flank - atan2(v, u)));
        }
    }
    return deepest;
}

/* Whether a pinion moved in along the centre line passes, at any of many angles, both sides alike. */
static double highest_corner(const gm_pair *p) {
    enum { STEPS = 4000 };
    const double r_bp = p->pinion.base_radius, r_bw = p->wheel.base_radius;
    double highest = -HUGE_VAL;
    for (int k = 0; k < STEPS; ++k) {
        const double phi_p = 0.5 * pi * k / STEPS;
        const double phi_w = r_bp * phi_p / r_bw;
        const double at_p = phi_p + p->pinion.base_half_thickness - inv(r_bp, p->pinion.tip_radius);
        const double at_w = phi_w + pi / p->wheel.teeth - p->wheel.base_half_thickness -
                            inv(r_bw, p->wheel.tip_radius);
        if (at_p < 0.5 * pi && at_w < 0.5 * pi) {
            highest =
                fmax(highest, p->pinion.tip_radius * sin(at_p) - p->wheel.tip_radius * sin(at_w));
        }
    }
    return highest;
}

/* On either side of the limits, from 60/-64 to 60/-80 and with shorter teeth, the corners say the same. */
static void corners_meet_where_pairs_are_refused(void) {
    int refused[2] = {0, 0}, taken = 0;
    for (int i = 0; i < 170; ++i) {
        const int teeth = 64 + i % 17;
        gm_test_context("60/-%d, teeth %d", teeth, i / 17);
        gm_pair_params params =
            ring_params(60, teeth, 2e-3, (teeth - 60) * 1e-3, 0.02 * (i % 5), -0.02 * (i % 5));
        params.backlash = 100e-6 * (i % 3);
        params.pinion_tip_alteration = -0.04 * (i / 17);
        params.wheel_tip_alteration = -0.04 * (i / 17);
        const char *requirement;
        const int status = gm_pair_params_check(&params, NULL, &requirement);

        /* The corners of the same gears, drawn where a reduced pinion tip lets them be: the geometry follows the axes alone. */
        gm_pair_params harmless = params;
        harmless.pinion_tip_alteration = -0.7;
        harmless.wheel_tip_alteration = -0.7;
        gm_pair pair;
        if (gm_pair_init(&pair, &harmless) != GM_OK) {
            continue;
        }
        const double m_n = params.normal_module;
        pair.pinion.tip_radius = pair.pinion.reference_radius +
                                 m_n * (1.0 + pair.pinion.profile_shift - 0.04 * (i / 17));
        pair.wheel.tip_radius =
            pair.wheel.reference_radius - m_n * (1.0 + pair.wheel.profile_shift - 0.04 * (i / 17));
        const double depth = deepest_corner(&pair);
        const double height = highest_corner(&pair);

        /* Corners are followed in steps of 0.04 degrees: 0.1 um of depth do not count. */
        if (status == GM_OK) {
            GM_ASSERT(depth < 1e-7 && height < 1e-7);
            ++taken;
        } else if (strstr(requirement, "trochoid") != NULL) {
            GM_ASSERT(depth > -1e-7);
            ++refused[0];
        } else if (strstr(requirement, "trimming") != NULL) {
            GM_ASSERT(depth < 1e-7 && height > -1e-7);
            ++refused[1];
        }
    }
    gm_test_context("all pairs");
    GM_ASSERT(refused[0] > 15);
    GM_ASSERT(refused[1] > 15);
    GM_ASSERT(taken > 15);
}

/* ---------------------------------------------------------------------------------------------
 * The frame
 * ------------------------------------------------------------------------------------------- */

/* Both turn the same way; the ring's axis is behind the pinion's, and its tooth spaces open towards it. */
static void the_pinion_drives_the_ring_its_own_way(void) {
    gm_pair_params params = ring_params(31, 88, 2e-3, 58.9e-3, (double)NAN, (double)NAN);
    params.helix_angle = 12.0 * degree;
    params.backlash = 60e-6;
    const gm_pair pair = make_pair(&params);
    gm_position at;
    gm_mesh_result r;
    const gm_state state = {.pinion_angle = 0.01,
                            .wheel_angle =
                                (pair.pinion.base_radius * 0.01 - 40e-6) / pair.wheel.base_radius};
    GM_ASSERT_INT(gm_position_from_state(&pair, &state, &at), GM_OK);
    GM_ASSERT_ABS(at.offset, 40e-6, 1e-16);
    GM_ASSERT_INT(plain_evaluate(&pair, NULL, NULL, &at, 1e8, 0.0, GM_WANT_WRENCH, &r), GM_OK);
    GM_ASSERT(r.force > 0.0);

    /* The ring is pushed counter-clockwise, outwards at its teeth, and along -z by a right-handed pinion. */
    GM_ASSERT_REL(r.wrench.wheel_moment[2], r.force * pair.wheel.base_radius, 1e-12);
    GM_ASSERT_REL(r.wrench.pinion_moment[2], -r.force * pair.pinion.base_radius, 1e-12);
    GM_ASSERT(r.wrench.wheel_force[0] > 0.0 && r.wrench.wheel_force[1] > 0.0);
    GM_ASSERT(r.wrench.wheel_force[2] < 0.0);
}

/* The cache finds the ends of the lines as the exact sums do: as good as that of an external pair of the same teeth. */
static void a_cache_of_a_ring_is_as_good(void) {
    double errors[2];
    for (int ring = 0; ring < 2; ++ring) {
        gm_pair_params params = ring_params(31, ring ? 88 : -88, 2e-3, ring ? 58.9e-3 : 122.5e-3,
                                            (double)NAN, (double)NAN);
        params.helix_angle = 12.0 * degree;
        params.backlash = 60e-6;
        const gm_pair pair = make_pair(&params);
        plain_mesh room;
        gm_mesh *mesh;
        gm_cache *cache;
        gm_cache_params resolution;
        gm_cache_errors found;
        GM_ASSERT_INT(plain_mesh_make(&room, &pair, NULL, NULL, 1e8, 0.0, &mesh), GM_OK);
        gm_cache_params_default(&resolution);
        const size_t size = gm_cache_size(&resolution, mesh);
        void *memory = malloc(size);
        GM_ASSERT_INT(gm_cache_init(&cache, &resolution, mesh, memory, size), GM_OK);
        GM_ASSERT_INT(gm_cache_error(cache, 2000, 3, NULL, &found), GM_OK);
        errors[ring] = found.sum_rms;
        free(memory);
    }
    GM_ASSERT(errors[1] > 0.0 && errors[1] < 3.0 * errors[0] + 1e-10);
}

/* Poses that take the ring's tip to the pinion's base circle, its teeth off the pinion, and the tips into each other. */
static void a_ring_out_of_mesh_is_refused(void) {
    const gm_pair_params params = ring_params(60, 80, 2e-3, 20e-3, 0.0, 0.0);
    const gm_pair pair = make_pair(&params);
    static const struct {
        double along_x;
        int status;
    } moves[] = {{0.0, GM_OK},
                 {0.1e-3, GM_OK},
                 {-0.1e-3, GM_OK},
                 {1.5e-3, GM_POSE_OUT_OF_MESH}, /* base circles meet */
                 {-5e-3, GM_POSE_OUT_OF_MESH}}; /* no path of contact */
    for (size_t k = 0; k < sizeof moves / sizeof moves[0]; ++k) {
        gm_test_context("move %d", (int)k);
        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        law.pose.center_distance_change = moves[k].along_x;
        GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, room.memory, sizeof room.memory),
                      moves[k].status);
    }
}

/*
 * Axes that have moved are another drawing of the same gears: what is in the way there is in the way of the pose.
 * Trimming alone is not, as the gears were put together where they are drawn.
 */
static void tips_in_the_way_of_a_moved_ring_are_refused(void) {
    int refused = 0, taken = 0;
    for (int i = 0; i < 12 * 15; ++i) {
        const int teeth = 68 + i / 15;
        const double along_x = 1e-4 * (i % 15 - 4); /* 0.5 mm is left to the root */
        gm_test_context("60/-%d moved by %g", teeth, along_x);
        gm_pair_params params = ring_params(60, teeth, 2e-3, (teeth - 60) * 1e-3, 0.0, 0.0);
        params.backlash = 1e-3; /* so that it is the tips that decide, not the flanks */
        gm_pair pair;
        if (gm_pair_init(&pair, &params) != GM_OK) {
            continue;
        }

        /* All that belongs to one gear is given; a ring that moves along +x comes nearer. */
        gm_pair_params there = params;
        there.center_distance -= along_x;
        there.backlash = (double)NAN;
        there.pinion_normal_thickness = pair.pinion.normal_thickness;
        there.wheel_normal_thickness = pair.wheel.normal_thickness;
        there.pinion_tip_radius = pair.pinion.tip_radius;
        there.wheel_tip_radius = pair.wheel.tip_radius;
        const char *requirement = NULL;
        const int status = gm_pair_params_check(&there, NULL, &requirement);

        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        law.pose.center_distance_change = along_x;
        const int posed =
            gm_mesh_init(&mesh, &law, &pair, NULL, NULL, room.memory, sizeof room.memory);
        if (status == GM_OK) {
            GM_ASSERT_INT(posed, GM_OK);
            ++taken;
        } else if (requirement != NULL && strstr(requirement, "trochoid") != NULL) {
            GM_ASSERT_INT(posed, GM_POSE_OUT_OF_MESH);
            ++refused;
        }
    }
    GM_ASSERT(refused > 5 && taken > 100);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(a_published_ring_has_its_geometry),
        GM_TEST(tips_keep_clear_of_roots),
        GM_TEST(what_is_in_the_way_is_named),
        GM_TEST(wrong_numbers_of_teeth_are_refused),
        GM_TEST(corners_meet_where_pairs_are_refused),
        GM_TEST(the_pinion_drives_the_ring_its_own_way),
        GM_TEST(a_cache_of_a_ring_is_as_good),
        GM_TEST(a_ring_out_of_mesh_is_refused),
        GM_TEST(tips_in_the_way_of_a_moved_ring_are_refused),
    };
    return gm_test_main("unit.ring", tests, GM_TEST_COUNT(tests), argc, argv);
}
