/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file reference_gear.h
 * The gear pair of [Paper, Table 1], completed as data/paper/README.md states and explains; a spur pair
 * beside it; and what the tests of evaluations share.
 */
#ifndef REFERENCE_GEAR_H
#define REFERENCE_GEAR_H

#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "plain_mesh.h"

#define REFERENCE_STIFFNESS  1.05e8  /**< K of one tooth pair (N/m) */
#define REFERENCE_DAMPING    844.361 /**< D of one tooth pair (N s/m) */
#define REFERENCE_FACE_WIDTH 17.5e-3 /**< b (m) */

GM_TEST_UNUSED static gm_pair_params reference_params(double face_width) {
    const double degree = 0.017453292519943295;
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 45;
    params.wheel_teeth = 41;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 16.0 * degree;
    params.helix_angle = 33.0 * degree;
    params.center_distance = 85e-3;
    params.face_width = face_width;
    params.backlash = 100e-6;
    params.pinion_rack_addendum = params.wheel_rack_addendum = 1.5; /* a deep rack */
    params.pinion_rack_dedendum = params.wheel_rack_dedendum = 1.75;
    params.pinion_tip_radius = 46.938390e-3;
    params.wheel_tip_radius = 43.003591e-3;
    return params;
}

/** Evaluates at pinion angle and x; asserts that it works. */
GM_TEST_UNUSED static gm_penetration at(const gm_pair *pair, const gm_flanks *pinion,
                                        const gm_flanks *wheel, double pinion_angle,
                                        double offset) {
    gm_position position;
    gm_penetration result;
    GM_ASSERT_INT(gm_position_from_pinion_angle(pair, pinion_angle, offset, 0.0, &position), GM_OK);
    GM_ASSERT_INT(penetration_3d_at(pair, pinion, wheel, &position, &result), GM_OK);
    return result;
}

GM_TEST_UNUSED static gm_pair make_pair(const gm_pair_params *params) {
    gm_pair pair;
    GM_ASSERT_INT(gm_pair_init(&pair, params), GM_OK);
    return pair;
}

GM_TEST_UNUSED static gm_pair reference_pair(double face_width) {
    const gm_pair_params params = reference_params(face_width);
    return make_pair(&params);
}

/** A spur pair, contact ratio 1.6. */
GM_TEST_UNUSED static gm_pair_params spur_pair_params(void) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 25;
    params.wheel_teeth = 37;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = 0.3490658503988659 /* 20 deg */;
    params.center_distance = 62.2e-3;
    params.face_width = 15e-3;
    params.backlash = 60e-6;
    return params;
}

GM_TEST_UNUSED static gm_pair spur_pair(void) {
    const gm_pair_params params = spur_pair_params();
    return make_pair(&params);
}

GM_TEST_UNUSED static double path_of(const gm_pair *pair) {
    return pair->path_end - pair->path_start;
}

/** Rounding of the lengths of a pair: a handful of operations on lengths below d. */
GM_TEST_UNUSED static double length_rounding(const gm_pair *pair) {
    return 8.0 * 0x1p-53 * pair->center_distance;
}

#endif /* REFERENCE_GEAR_H */
