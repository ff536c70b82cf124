/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* From a drawing to a pair: derived values, defaults, every range, every warning. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "reference_gear.h"

static const double degree = 0.017453292519943295;

/** All doubles of a pair. */
enum { GEAR_DOUBLES = 21, OWN_DOUBLES = 29, PAIR_DOUBLES = 2 * GEAR_DOUBLES + OWN_DOUBLES };

static void list_gear(const gm_gear *g, double *out) {
    const double values[GEAR_DOUBLES] = {g->sign,
                                         g->profile_shift,
                                         g->reference_radius,
                                         g->base_radius,
                                         g->tip_radius,
                                         g->start_radius,
                                         g->normal_thickness,
                                         g->base_half_thickness,
                                         g->start_roll_length,
                                         g->tip_roll_length,
                                         g->pitch_angle,
                                         g->rack_addendum,
                                         g->rack_dedendum,
                                         g->rack_fillet_radius,
                                         g->tip_alteration,
                                         g->root_radius,
                                         g->tip_thickness,
                                         g->face_width,
                                         g->face_start,
                                         g->pitch_angle_remainder,
                                         g->normal_tip_thickness};
    memcpy(out, values, sizeof values);
}

static void list_pair(const gm_pair *p, double out[PAIR_DOUBLES]) {
    list_gear(&p->pinion, out);
    list_gear(&p->wheel, out + GEAR_DOUBLES);
    const double values[OWN_DOUBLES] = {p->normal_module,
                                        p->transverse_module,
                                        p->normal_pressure_angle,
                                        p->transverse_pressure_angle,
                                        p->helix_angle,
                                        p->base_helix_angle,
                                        p->transverse_base_pitch,
                                        p->face_width,
                                        p->face_start,
                                        p->face_advance,
                                        p->normal_to_transverse,
                                        p->center_distance,
                                        p->reference_center_distance,
                                        p->working_pressure_angle,
                                        p->involute_difference,
                                        p->line_of_action,
                                        p->path_start,
                                        p->path_end,
                                        p->transverse_contact_ratio,
                                        p->overlap_ratio,
                                        p->total_contact_ratio,
                                        p->backlash,
                                        p->phase_origin[GM_DRIVE],
                                        p->phase_origin[GM_COAST],
                                        p->pinion_working_pitch_radius,
                                        p->wheel_working_pitch_radius,
                                        p->pinion_tip_clearance,
                                        p->wheel_tip_clearance,
                                        p->hunting_passes};
    memcpy(out + 2 * GEAR_DOUBLES, values, sizeof values);
}

/** Every byte of a pair is a listed double, a number of teeth or a flag: no field is forgotten above. */
static void the_lists_above_are_complete(void) {
    GM_ASSERT_INT((int)sizeof(gm_gear), (int)(GEAR_DOUBLES * sizeof(double) + 2 * sizeof(int)));
    GM_ASSERT_INT((int)sizeof(gm_pair), (int)(2 * sizeof(gm_gear) + OWN_DOUBLES * sizeof(double)));
}

/** Whether no field of the pair is of use. */
static void assert_unusable(const gm_pair *pair) {
    double values[PAIR_DOUBLES];
    list_pair(pair, values);
    for (int i = 0; i < PAIR_DOUBLES; ++i) {
        GM_ASSERT_NAN(values[i]);
    }
    GM_ASSERT_INT(pair->pinion.teeth, 0);
    GM_ASSERT_INT(pair->wheel.teeth, 0);
}

/* ---------------------------------------------------------------------------------------------
 * The reference gears
 * ------------------------------------------------------------------------------------------- */

/* Values worked out independently when the gear was chosen (data/paper/README.md), with the digits printed
 * there; the tolerance is half a unit of the last one. */
static void reference_gears_have_their_known_geometry(void) {
    const gm_pair p = reference_pair(REFERENCE_FACE_WIDTH);
    const double mm = 1e-3;
    GM_ASSERT_ABS(p.transverse_module, 1.967399 * mm, 0.5e-6 * mm);
    GM_ASSERT_ABS(p.transverse_pressure_angle, 18.87580 * degree, 0.5e-5 * degree);
    GM_ASSERT_ABS(p.base_helix_angle, 31.57005 * degree, 0.5e-5 * degree);
    GM_ASSERT_ABS(p.pinion.base_radius, 41.885928 * mm, 0.5e-6 * mm);
    GM_ASSERT_ABS(p.wheel.base_radius, 38.162735 * mm, 0.5e-6 * mm);
    GM_ASSERT_ABS(p.reference_center_distance, 84.598176 * mm, 0.5e-6 * mm);
    GM_ASSERT_ABS(p.working_pressure_angle, 19.65262 * degree, 0.5e-5 * degree);
    GM_ASSERT_ABS(p.line_of_action, 28.586911 * mm, 0.5e-6 * mm);
    GM_ASSERT_ABS(p.transverse_base_pitch, 5.848379 * mm, 0.5e-6 * mm);
    GM_ASSERT_ABS(p.face_advance, 10.753467 * mm, 0.5e-6 * mm);
    GM_ASSERT_ABS(p.normal_to_transverse, 1.17371, 0.5e-5);
    /* The tip radii are given to 1e-6 mm; at rho they count r_a / rho = 2.3 times as much. */
    GM_ASSERT_ABS(p.path_start, 8.764840 * mm, 0.5e-6 * mm + 1.2e-6 * mm);
    GM_ASSERT_ABS(p.path_end, 21.184463 * mm, 0.5e-6 * mm + 1.2e-6 * mm);
    GM_ASSERT_ABS(p.pinion.start_radius, 42.793147 * mm, 1e-6 * mm);
    GM_ASSERT_ABS(p.wheel.start_radius, 38.874035 * mm, 1e-6 * mm);
    GM_ASSERT_ABS(p.transverse_contact_ratio, 2.123601, 1e-6);
    GM_ASSERT_ABS(p.overlap_ratio, 1.838709, 0.5e-6);
    GM_ASSERT_ABS(p.total_contact_ratio, 3.962310, 1e-6);
    GM_ASSERT_ABS(p.pinion.profile_shift + p.wheel.profile_shift, 0.2483897, 0.5e-7);
    GM_ASSERT_ABS(p.pinion.profile_shift, 0.1241948, 1e-7);
    GM_ASSERT_ABS(p.pinion.normal_thickness, 2.6650177 * mm, 0.5e-7 * mm);
    GM_ASSERT_ABS(p.wheel.normal_thickness, 2.6650177 * mm, 0.5e-7 * mm);
    GM_ASSERT_REL(p.backlash, 100e-6, 1e-15);
    /* Roll angles chi = rho / r_b. */
    GM_ASSERT_ABS(p.pinion.start_roll_length / p.pinion.base_radius, 0.209255, 0.6e-6);
    GM_ASSERT_ABS(p.pinion.tip_roll_length / p.pinion.base_radius, 0.505766, 0.6e-6);
    GM_ASSERT_ABS(p.wheel.start_roll_length / p.wheel.base_radius, 0.193971, 0.6e-6);
    GM_ASSERT_ABS(p.wheel.tip_roll_length / p.wheel.base_radius, 0.519409, 0.6e-6);
    GM_ASSERT_INT(p.pinion.teeth, 45);
    GM_ASSERT_INT(p.wheel.teeth, 41);
}

static void wider_reference_gears_have_their_known_overlap(void) {
    const gm_pair p = reference_pair(20e-3);
    GM_ASSERT_ABS(p.overlap_ratio, 2.101382, 0.5e-6);
    GM_ASSERT_ABS(p.total_contact_ratio, 4.224983, 1e-6);
}

static void standard_rack_has_its_known_path(void) {
    gm_pair_params params = reference_params(20e-3);
    params.pinion_tip_radius = 46.113390e-3;
    params.wheel_tip_radius = 42.178591e-3;
    const gm_pair p = make_pair(&params);
    GM_ASSERT_ABS(p.transverse_contact_ratio, 1.481249, 1e-6);
    GM_ASSERT_ABS(p.path_start, 10.624750e-3, 0.5e-9 + 1.2e-9);
    GM_ASSERT_ABS(p.path_end, 19.287658e-3, 0.5e-9 + 1.2e-9);
    GM_ASSERT_ABS(p.pinion.start_radius, 43.212456e-3, 1e-9);
    GM_ASSERT_ABS(p.wheel.start_radius, 39.279390e-3, 1e-9);
}

/* [Paper, Eq. 6] as printed: 34.46244 deg, overlap 2.3470 at b = 20 mm. */
static void paper_base_helix_is_there_on_request_only(void) {
    gm_pair_params params = reference_params(20e-3);
    params.base_helix = GM_BASE_HELIX_PAPER;
    const gm_pair paper = make_pair(&params);
    GM_ASSERT_ABS(paper.base_helix_angle, 34.46244 * degree, 0.5e-5 * degree);
    GM_ASSERT_ABS(paper.overlap_ratio, 2.3470, 0.5e-4);
    GM_ASSERT_ABS(paper.face_advance, 13.726e-3, 0.5e-6);
    const gm_pair iso = reference_pair(20e-3);
    GM_ASSERT_ABS(iso.face_advance, 12.290e-3, 0.5e-6);
    GM_ASSERT_REL(paper.transverse_base_pitch, iso.transverse_base_pitch, 0.0);
}

static void left_hand_changes_signs_alone(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    const gm_pair right = make_pair(&params);
    params.helix_angle = -params.helix_angle;
    gm_pair left = make_pair(&params);
    GM_ASSERT(left.helix_angle < 0.0 && left.base_helix_angle < 0.0 && left.face_advance < 0.0);
    left.helix_angle = -left.helix_angle;
    left.base_helix_angle = -left.base_helix_angle;
    left.face_advance = -left.face_advance;
    double a[PAIR_DOUBLES];
    double b[PAIR_DOUBLES];
    list_pair(&right, a);
    list_pair(&left, b);
    for (int i = 0; i < PAIR_DOUBLES; ++i) {
        gm_test_context("field %d", i);
        GM_ASSERT_REL(b[i], a[i], 0.0);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Defaults
 * ------------------------------------------------------------------------------------------- */

static void defaults_are_missing_or_derived(void) {
    gm_pair_params p;
    memset(&p, 1, sizeof p);
    gm_pair_params_default(&p);
    GM_ASSERT_INT(p.pinion_teeth, 0);
    GM_ASSERT_INT(p.wheel_teeth, 0);
    GM_ASSERT_INT(p.base_helix, GM_BASE_HELIX_ISO);
    GM_ASSERT_REL(p.helix_angle, 0.0, 0.0);
    GM_ASSERT_REL(p.axial_offset, 0.0, 0.0);
    const double missing[] = {p.normal_module,
                              p.normal_pressure_angle,
                              p.center_distance,
                              p.face_width,
                              p.pinion_profile_shift,
                              p.wheel_profile_shift,
                              p.backlash,
                              p.pinion_normal_thickness,
                              p.wheel_normal_thickness,
                              p.pinion_tip_radius,
                              p.wheel_tip_radius,
                              p.pinion_start_radius,
                              p.wheel_start_radius,
                              p.pinion_face_width,
                              p.wheel_face_width,
                              p.pinion_rack_addendum,
                              p.wheel_rack_addendum,
                              p.pinion_rack_dedendum,
                              p.wheel_rack_dedendum,
                              p.pinion_rack_fillet_radius,
                              p.wheel_rack_fillet_radius,
                              p.pinion_tip_alteration,
                              p.wheel_tip_alteration};
    for (size_t i = 0; i < sizeof missing / sizeof missing[0]; ++i) {
        gm_test_context("field %d", (int)i);
        GM_ASSERT_NAN(missing[i]);
    }
    GM_ASSERT_INT(gm_pair_params_check(&p, NULL, NULL), GM_ERR_PARAMETER);
    gm_pair_params_default(NULL); /* does nothing */
}

static void a_zeroed_struct_is_refused(void) {
    gm_pair_params p;
    memset(&p, 0, sizeof p);
    const char *field = NULL;
    GM_ASSERT_INT(gm_pair_params_check(&p, &field, NULL), GM_ERR_PARAMETER);
    GM_ASSERT_STRING(field, "pinion_teeth");
}

static void shifts_default_to_zero_backlash(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.backlash = NAN;
    const gm_pair both = make_pair(&params);
    const double sum = both.pinion.profile_shift + both.wheel.profile_shift;
    GM_ASSERT_REL(both.pinion.profile_shift, both.wheel.profile_shift, 0.0);
    /* Backlash is a difference of lengths up to d. */
    const double rounding = 8.0 * 0x1p-53 * both.center_distance;
    GM_ASSERT_ABS(both.backlash, 0.0, rounding);

    params.pinion_profile_shift = 0.3;
    const gm_pair pinion = make_pair(&params);
    GM_ASSERT_REL(pinion.pinion.profile_shift, 0.3, 0.0);
    GM_ASSERT_REL(pinion.wheel.profile_shift, sum - 0.3, 1e-13);
    GM_ASSERT_ABS(pinion.backlash, 0.0, rounding);

    params.pinion_profile_shift = NAN;
    params.wheel_profile_shift = -0.2;
    const gm_pair wheel = make_pair(&params);
    GM_ASSERT_REL(wheel.wheel.profile_shift, -0.2, 0.0);
    GM_ASSERT_REL(wheel.pinion.profile_shift, sum + 0.2, 1e-13);
    GM_ASSERT_ABS(wheel.backlash, 0.0, rounding);

    /* Both given: s_n = m_n (pi / 2 + 2 x tan(alpha_n)) */
    params.pinion_profile_shift = 0.1;
    const gm_pair given = make_pair(&params);
    const double m_n = params.normal_module;
    GM_ASSERT_REL(given.pinion.normal_thickness,
                  m_n * (1.5707963267948966 + 2.0 * 0.1 * tan(params.normal_pressure_angle)),
                  1e-15);
    GM_ASSERT_REL(given.wheel.normal_thickness,
                  m_n * (1.5707963267948966 - 2.0 * 0.2 * tan(params.normal_pressure_angle)),
                  1e-15);
    GM_ASSERT(given.backlash > 0.0);
}

static void thickness_wins_over_shift(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.backlash = NAN;
    params.pinion_profile_shift = 0.3;
    params.pinion_normal_thickness = 2.6e-3;
    params.wheel_normal_thickness = 2.7e-3;
    const gm_pair p = make_pair(&params);
    GM_ASSERT_REL(p.pinion.normal_thickness, 2.6e-3, 1e-15);
    GM_ASSERT_REL(p.wheel.normal_thickness, 2.7e-3, 1e-15);
    GM_ASSERT_REL(p.pinion.profile_shift, 0.3, 0.0); /* nominal */
    /* Together 30.0 um thicker than the 2 x 2.6650177 mm that give 100 um: each micrometre of normal
     * thickness is cos(alpha_t) / cos(beta) along the line of action. */
    const double expected = 100e-6 - (5.3e-3 - 2.0 * 2.6650177e-3) *
                                         cos(p.transverse_pressure_angle) / cos(p.helix_angle);
    GM_ASSERT_ABS(p.backlash, expected, 2.0 * 0.5e-10 * 1.2);
}

static void backlash_thins_both_teeth_equally_and_leaves_the_shifts(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_normal_thickness = 2.6e-3;
    params.wheel_normal_thickness = 2.7e-3;
    params.backlash = NAN;
    const gm_pair before = make_pair(&params);
    params.backlash = 300e-6;
    const gm_pair after = make_pair(&params);
    GM_ASSERT_REL(after.backlash, 300e-6, 1e-15);
    const double thinner = before.pinion.normal_thickness - after.pinion.normal_thickness;
    GM_ASSERT_ABS(before.wheel.normal_thickness - after.wheel.normal_thickness, thinner, 1e-17);
    GM_ASSERT_REL(2.0 * thinner * cos(after.transverse_pressure_angle) / cos(after.helix_angle),
                  300e-6 - before.backlash, 1e-11);
    GM_ASSERT_REL(after.pinion.profile_shift, before.pinion.profile_shift, 0.0);
    /* Thinner on the base circle by as much: s_t / (2 r). */
    GM_ASSERT_REL(before.pinion.base_half_thickness - after.pinion.base_half_thickness,
                  thinner / cos(after.helix_angle) / 2.0 / after.pinion.reference_radius, 1e-10);
    params.backlash = -20e-6;
    GM_ASSERT_REL(make_pair(&params).backlash, -20e-6, 1e-15);
}

/** A pair with nothing but what a catalogue prints. */
static gm_pair_params catalogue_params(int pinion_teeth, int wheel_teeth, double module_mm,
                                       double helix_deg, double distance_mm, double x_p,
                                       double x_w) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = pinion_teeth;
    params.wheel_teeth = wheel_teeth;
    params.normal_module = module_mm * 1e-3;
    params.normal_pressure_angle = 20.0 * degree;
    params.helix_angle = helix_deg * degree;
    params.center_distance = distance_mm * 1e-3;
    params.face_width = 10.0 * module_mm * 1e-3;
    params.pinion_profile_shift = x_p;
    params.wheel_profile_shift = x_w;
    return params;
}

/*
 * Published pairs, with the digits printed there. NREL: KISSsoft reports of the gearbox of the open 5 MW wind turbine
 * model, sun-planet of stage 1, sun-planet of stage 2, stage 3; k m_n stands there as tip alteration. The last one is
 * the pair 12/24 of spur gear textbooks whose shifts ask for far more distance than there is.
 */
static void published_pairs_have_their_tips_and_contact_ratios(void) {
    static const struct {
        const char *name;
        int pinion_teeth, wheel_teeth;
        double module_mm, helix_deg, distance_mm, x_p, x_w;
        double shift_digit; /* half a unit of the last digit of the shifts */
        double k_mm, k_digit, contact_ratio;
        double pinion_tip_mm, wheel_tip_mm; /* diameters */
    } pairs[] = {
        {"NREL 5 MW, stage 1", 19, 17, 45.0, 0.0, 863.0, 0.617, 0.802, 0.5e-3, -10.86, 0.5e-2,
         1.115, NAN, NAN},
        {"NREL 5 MW, stage 2", 18, 36, 21.0, 0.0, 584.0, 0.3890, 0.5039, 0.5e-4, -1.751, 0.5e-3,
         1.370, NAN, NAN},
        {"NREL 5 MW, stage 3", 24, 95, 14.0, 10.0, 861.0, 0.4800, 0.6691, 0.5e-4, -0.938, 0.5e-3,
         1.463, 380.747, 1395.376},
        {"12/24", 12, 24, 3.0, 0.0, 56.5, 0.6, 0.36, 0.0, -0.38, 1e-9, 1.202, NAN, NAN},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; ++i) {
        gm_test_context("%s", pairs[i].name);
        const gm_pair_params params =
            catalogue_params(pairs[i].pinion_teeth, pairs[i].wheel_teeth, pairs[i].module_mm,
                             pairs[i].helix_deg, pairs[i].distance_mm, pairs[i].x_p, pairs[i].x_w);
        const gm_pair p = make_pair(&params);

        const double mm = 1e-3;
        const double by_shifts = 2.0 * pairs[i].shift_digit * pairs[i].module_mm;
        const double m_n = p.normal_module;
        GM_ASSERT_ABS(m_n * p.pinion.tip_alteration, pairs[i].k_mm * mm,
                      (pairs[i].k_digit + by_shifts) * mm);
        GM_ASSERT_ABS(m_n * p.wheel.tip_alteration, pairs[i].k_mm * mm,
                      (pairs[i].k_digit + by_shifts) * mm);
        GM_ASSERT_ABS(p.transverse_contact_ratio, pairs[i].contact_ratio, 0.5e-3);

        /* The tips keep the clearance of the rack, 0.25 m_n, so nothing is to be warned of. */
        GM_ASSERT_ABS(p.pinion_tip_clearance, 0.25 * m_n, 1e-15);
        GM_ASSERT_ABS(p.wheel_tip_clearance, 0.25 * m_n, 1e-15);
        GM_ASSERT_INT(gm_pair_warnings(&p, &params) & ~GM_WARN_BACKLASH_ROUNDED, 0);
        if (!isnan(pairs[i].pinion_tip_mm)) {
            GM_ASSERT_ABS(2.0 * p.pinion.tip_radius, pairs[i].pinion_tip_mm * mm,
                          (0.5e-3 + by_shifts) * mm);
            GM_ASSERT_ABS(2.0 * p.wheel.tip_radius, pairs[i].wheel_tip_mm * mm,
                          (0.5e-3 + by_shifts) * mm);
        }
    }
}

/* Where the rule or the drawing says so it is so, without a rounding. */
static void no_tip_alteration_is_none(void) {
    for (int teeth = 20; teeth < 90; ++teeth) {
        gm_test_context("%d teeth", teeth);
        for (int ring = 0; ring < 2; ++ring) {
            const int wheel = ring ? -(teeth + 60) : 31;
            const double distance_mm = 0.5 * 1.7 * abs(teeth + wheel);
            gm_pair_params params = catalogue_params(teeth, wheel, 1.7, 0.0, distance_mm, 0.0, 0.0);
            gm_pair p = make_pair(&params);
            GM_ASSERT_ABS(p.pinion.tip_alteration, 0.0, 0.0);
            GM_ASSERT_ABS(p.wheel.tip_alteration, 0.0, 0.0);
            params.wheel_tip_alteration = -0.1;
            p = make_pair(&params);
            GM_ASSERT_REL(p.wheel.tip_alteration, -0.1, 0.0);
        }
    }
}

static void tips_default_to_addendum_shift_and_tip_alteration(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    const double m_n = params.normal_module;
    params.pinion_tip_radius = NAN;
    params.wheel_tip_radius = NAN;
    params.pinion_profile_shift = 0.4;
    params.pinion_rack_addendum = NAN; /* 1 */
    params.wheel_rack_addendum = 1.2;
    const gm_pair p = make_pair(&params);
    /* a - r_p - r_w = 0.243530 m_n, and the shifts sum up to 0.2483897: data/paper/README.md. */
    const double k = -0.0048598;
    GM_ASSERT_ABS(p.pinion.tip_alteration, k, 1e-7);
    GM_ASSERT_ABS(p.wheel.tip_alteration, k, 1e-7);
    GM_ASSERT_ABS(p.pinion.tip_radius, p.pinion.reference_radius + m_n * (1.4 + k), 1e-7 * m_n);
    GM_ASSERT_ABS(p.wheel.tip_radius, p.wheel.reference_radius + m_n * (1.2 + 0.2483897 - 0.4 + k),
                  1e-7 * m_n);

    /* Thinning by backlash lowers no tip, nor a root. */
    params.backlash = 300e-6;
    const gm_pair thin = make_pair(&params);
    GM_ASSERT_REL(thin.pinion.tip_radius, p.pinion.tip_radius, 0.0);
    GM_ASSERT_REL(thin.wheel.root_radius, p.wheel.root_radius, 0.0);

    /* A tip alteration that is given stands, also a positive one, and leaves that of the mate alone. */
    params.pinion_tip_alteration = 0.05;
    const gm_pair longer = make_pair(&params);
    GM_ASSERT_REL(longer.pinion.tip_radius, p.pinion.reference_radius + m_n * 1.45, 1e-15);
    GM_ASSERT_ABS(longer.pinion.tip_alteration, 0.05, 1e-13);
    GM_ASSERT_REL(longer.wheel.tip_radius, p.wheel.tip_radius, 0.0);
    params.pinion_tip_alteration = NAN;
    params.wheel_tip_alteration = -0.1;
    const gm_pair shorter = make_pair(&params);
    GM_ASSERT_REL(shorter.pinion.tip_radius, p.pinion.tip_radius, 0.0);
    GM_ASSERT_ABS(shorter.wheel.tip_alteration, -0.1, 1e-13);

    /* Axes further apart than the shifts ask for do not lengthen a tooth. */
    params = catalogue_params(30, 40, 2.0, 0.0, 70.5, 0.1, 0.1);
    const gm_pair apart = make_pair(&params);
    GM_ASSERT_REL(apart.pinion.tip_radius, 30e-3 + 2e-3 * 1.1, 1e-15);
    GM_ASSERT_ABS(apart.pinion.tip_alteration, 0.0, 1e-13);
    GM_ASSERT(apart.pinion_tip_clearance > 0.25 * 2e-3);
}

/* Where k is at work, the clearance is that of the basic rack, c = h_fP - h_aP of the mate: by construction. */
static void tip_alteration_keeps_the_clearance_of_the_rack(void) {
    uint64_t seed = 9;
    for (int i = 0; i < 200; ++i) {
        gm_test_context("pair %d", i);
        gm_pair_params params =
            catalogue_params(gm_test_integer(&seed, 18, 60), gm_test_integer(&seed, 18, 90), 2.0,
                             gm_test_uniform(&seed, -30.0, 30.0), 0.0,
                             gm_test_uniform(&seed, 0.0, 0.6), gm_test_uniform(&seed, 0.0, 0.6));
        params.pinion_rack_addendum = gm_test_uniform(&seed, 0.9, 1.1);
        params.wheel_rack_dedendum = gm_test_uniform(&seed, 1.2, 1.4);
        const double shifts = params.pinion_profile_shift + params.wheel_profile_shift;
        params.center_distance =
            params.normal_module *
            (0.5 * (params.pinion_teeth + params.wheel_teeth) / cos(params.helix_angle) +
             shifts * gm_test_uniform(&seed, 0.7, 1.0));
        const gm_pair p = make_pair(&params);
        const double rounding = 8.0 * 0x1p-53 * p.center_distance;
        const double m_n = params.normal_module;
        GM_ASSERT_ABS(p.pinion_tip_clearance,
                      m_n * (params.wheel_rack_dedendum - params.pinion_rack_addendum), rounding);
        GM_ASSERT_ABS(p.wheel_tip_clearance, 0.25 * m_n, rounding);
        /* What the tip, root and pitch circles are for: they fill the centre distance. */
        GM_ASSERT_ABS(p.pinion.tip_radius + p.pinion_tip_clearance + p.wheel.root_radius,
                      p.center_distance, rounding);
        GM_ASSERT_ABS(p.pinion_working_pitch_radius + p.wheel_working_pitch_radius,
                      p.center_distance, rounding);
        GM_ASSERT_REL(p.wheel_working_pitch_radius / p.pinion_working_pitch_radius,
                      (double)params.wheel_teeth / params.pinion_teeth, 1e-14);
        GM_ASSERT_REL(p.pinion_working_pitch_radius * cos(p.working_pressure_angle),
                      p.pinion.base_radius, 1e-14);
    }
}

static void a_given_tip_tells_its_tip_alteration(void) {
    const gm_pair p = reference_pair(REFERENCE_FACE_WIDTH);
    const double m_n = p.normal_module;
    /* Chosen as h = 1.5 with k of the shift sum, rounded to 1e-6 mm: data/paper/README.md. */
    GM_ASSERT_ABS(p.pinion.tip_alteration, -0.0048598, 1e-6);
    GM_ASSERT_ABS(p.wheel.tip_alteration, -0.0048598, 1e-6);
    GM_ASSERT_REL(p.pinion.reference_radius +
                      m_n * (1.5 + p.pinion.profile_shift + p.pinion.tip_alteration),
                  46.938390e-3, 1e-15);
    GM_ASSERT_REL(p.pinion.root_radius,
                  p.pinion.reference_radius - m_n * (1.75 - p.pinion.profile_shift), 1e-15);
    GM_ASSERT_REL(p.wheel.root_radius,
                  p.wheel.reference_radius - m_n * (1.75 - p.wheel.profile_shift), 1e-15);
    GM_ASSERT_ABS(p.pinion_tip_clearance, 0.25 * m_n, 1e-6 * m_n);
    /* Transverse tip lands 0.617 and 0.599 modules: data/paper/README.md. */
    GM_ASSERT_ABS(p.pinion.tip_thickness, 0.617 * m_n, 0.5e-3 * m_n);
    GM_ASSERT_ABS(p.wheel.tip_thickness, 0.599 * m_n, 0.5e-3 * m_n);
}

/* ---------------------------------------------------------------------------------------------
 * Faces
 * ------------------------------------------------------------------------------------------- */

static void equal_faces_may_be_said_in_each_way(void) {
    const gm_pair_params common = reference_params(REFERENCE_FACE_WIDTH);
    const gm_pair expected = make_pair(&common);
    GM_ASSERT_REL(expected.face_start, 0.0, 0.0);
    GM_ASSERT_REL(expected.wheel.face_start, 0.0, 0.0);
    for (int way = 1; way < 8; ++way) {
        gm_test_context("way %d", way);
        gm_pair_params params = common;
        params.pinion_face_width = way & 1 ? REFERENCE_FACE_WIDTH : (double)NAN;
        params.wheel_face_width = way & 2 ? REFERENCE_FACE_WIDTH : (double)NAN;
        params.face_width = way & 4 ? (double)NAN : REFERENCE_FACE_WIDTH;
        gm_pair pair;
        const int status = gm_pair_init(&pair, &params);
        if (way == 5 || way == 6 || way == 4) {
            const char *field = "";
            GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_PARAMETER);
            GM_ASSERT_STRING(field, "face_width");
            continue;
        }
        GM_ASSERT_INT(status, GM_OK);
        GM_ASSERT(memcmp(&pair, &expected, sizeof pair) == 0);
    }
}

static void unequal_faces_share_what_lies_in_both(void) {
    static const struct {
        double pinion, wheel, offset; /* (mm) */
        double start, width, wheel_start;
    } cases[] = {
        {26.0, 32.0, -1.5, 0.0, 26.0, -4.5}, /* the pinion within the wheel */
        {32.0, 26.0, 1.5, 4.5, 26.0, 4.5},   /* the wheel within the pinion */
        {20.0, 20.0, 3.0, 3.0, 17.0, 3.0},   /* beyond face II */
        {20.0, 20.0, -3.0, 0.0, 17.0, -3.0}, /* beyond face I */
        {20.0, 10.0, 12.0, 17.0, 3.0, 17.0}, {20.0, 10.0, -12.0, 0.0, 3.0, -7.0},
    };

    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        gm_test_context("case %d", (int)i);
        gm_pair_params params = reference_params((double)NAN);
        params.pinion_face_width = cases[i].pinion * 1e-3;
        params.wheel_face_width = cases[i].wheel * 1e-3;
        params.axial_offset = cases[i].offset * 1e-3;
        const gm_pair p = make_pair(&params);

        GM_ASSERT_REL(p.pinion.face_width, cases[i].pinion * 1e-3, 0.0);
        GM_ASSERT_REL(p.wheel.face_width, cases[i].wheel * 1e-3, 0.0);
        GM_ASSERT_REL(p.pinion.face_start, 0.0, 0.0);
        GM_ASSERT_ABS(p.wheel.face_start, cases[i].wheel_start * 1e-3, 1e-17);
        GM_ASSERT_ABS(p.face_start, cases[i].start * 1e-3, 1e-17);
        GM_ASSERT_ABS(p.face_width, cases[i].width * 1e-3, 1e-17);
        GM_ASSERT_REL(p.face_advance, p.face_width * tan(p.base_helix_angle), 1e-14);
        GM_ASSERT_REL(p.overlap_ratio, p.face_advance / p.transverse_base_pitch, 1e-15);
        /* The lines of contact start where the common face does; angles refer to z = 0. */
        const double at_zero =
            p.pinion.base_radius * (p.working_pressure_angle + p.pinion.base_half_thickness);
        const double before = p.face_start * tan(p.base_helix_angle);
        GM_ASSERT_REL(p.phase_origin[GM_DRIVE], at_zero + before, 1e-14);
        GM_ASSERT_REL(p.phase_origin[GM_COAST], at_zero - before, 1e-14);
        /* The common width may be said as well. */
        params.face_width = p.face_width;
        GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_OK);
        params.face_width = fmin(params.pinion_face_width, params.wheel_face_width);
        GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_OK);
    }
}

/* Moved together along the axis, the gears are the same: the phase follows the helix. */
static void a_pinion_that_begins_earlier_only_turns_its_zero(void) {
    gm_pair_params params = reference_params((double)NAN);
    params.pinion_face_width = 24e-3;
    params.wheel_face_width = 20e-3; /* z = 2 .. 22 mm */
    const gm_pair wide = make_pair(&params);
    params.pinion_face_width = 20e-3;
    const gm_pair narrow = make_pair(&params);
    const double turn = 2e-3 * tan(narrow.base_helix_angle) / narrow.pinion.base_radius;
    const double wheel_turn = 2e-3 * tan(narrow.base_helix_angle) / narrow.wheel.base_radius;
    for (int i = 0; i < 40; ++i) {
        gm_test_context("position %d", i);
        const gm_state state = {.pinion_angle = 0.11 * i,
                                .wheel_angle = 0.11 * i * 45.0 / 41.0 + (i % 2 ? 1.5e-3 : -1.5e-3)};
        const gm_state later = {.pinion_angle = state.pinion_angle + turn,
                                .wheel_angle = state.wheel_angle + wheel_turn};
        gm_penetration of_wide, of_narrow;
        GM_ASSERT_INT(gm_penetration_3d(&wide, NULL, NULL, &state, &of_wide), GM_OK);
        GM_ASSERT_INT(gm_penetration_3d(&narrow, NULL, NULL, &later, &of_narrow), GM_OK);
        GM_ASSERT(of_narrow.drive + of_narrow.coast > 0.0);
        GM_ASSERT_REL(of_wide.drive, of_narrow.drive, 1e-9);
        GM_ASSERT_REL(of_wide.coast, of_narrow.coast, 1e-9);
    }
}

static void faces_that_contradict_each_other_are_refused(void) {
    static const struct {
        double common, pinion, wheel, offset; /* (mm) */
        const char *field;
    } cases[] = {
        {20.0, 15.0, NAN, 0.0, "face_width"}, /* the pinion's face is narrower */
        {20.0, NAN, 15.0, 0.0, "face_width"},
        {20.0, 25.0, 30.0, 0.0, "face_width"}, /* both are wider */
        {20.0001, 20.0, 30.0, 0.0, "face_width"},
        {NAN, 20.0, 30.0, 25.0, "axial_offset"}, /* next to each other */
        {NAN, 20.0, 30.0, -25.0, "axial_offset"},
        {20.0, NAN, NAN, 21.0, "axial_offset"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        gm_test_context("case %d", (int)i);
        gm_pair_params params = reference_params(cases[i].common * 1e-3);
        params.pinion_face_width = cases[i].pinion * 1e-3;
        params.wheel_face_width = cases[i].wheel * 1e-3;
        params.axial_offset = cases[i].offset * 1e-3;
        const char *field = "";
        GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_GEOMETRY);
        GM_ASSERT_STRING(field, cases[i].field);
    }
}

static void profiles_start_where_the_mates_tip_reaches(void) {
    const gm_pair p = reference_pair(REFERENCE_FACE_WIDTH);
    GM_ASSERT_REL(p.pinion.start_roll_length, p.line_of_action - p.wheel.tip_roll_length, 1e-14);
    GM_ASSERT_REL(p.wheel.start_roll_length, p.line_of_action - p.pinion.tip_roll_length, 1e-14);
    GM_ASSERT_REL(p.pinion.start_radius, hypot(p.pinion.base_radius, p.pinion.start_roll_length),
                  1e-15);
    /* A mate whose tip passes the base tangent point: the profile starts on the base circle. */
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.wheel_tip_radius = 48.2e-3; /* rho = 29.4 mm > 28.6 mm */
    const gm_pair deep = make_pair(&params);
    GM_ASSERT_REL(deep.pinion.start_roll_length, 0.0, 0.0);
    GM_ASSERT_REL(deep.pinion.start_radius, deep.pinion.base_radius, 1e-15);
}

static void a_start_below_the_base_circle_is_raised(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_start_radius = 30e-3;
    params.wheel_start_radius = 20e-3;
    const gm_pair p = make_pair(&params);
    GM_ASSERT_REL(p.pinion.start_radius, p.pinion.base_radius, 0.0);
    GM_ASSERT_REL(p.pinion.start_roll_length, 0.0, 0.0);
    GM_ASSERT_REL(p.wheel.start_radius, p.wheel.base_radius, 0.0);
    GM_ASSERT_REL(p.wheel.start_roll_length, 0.0, 0.0);
    GM_ASSERT_INT(gm_pair_warnings(&p, &params) &
                      (GM_WARN_PINION_START_RADIUS | GM_WARN_WHEEL_START_RADIUS),
                  GM_WARN_PINION_START_RADIUS | GM_WARN_WHEEL_START_RADIUS);
    /* The mate's tips still limit the path. */
    const gm_pair reference = reference_pair(REFERENCE_FACE_WIDTH);
    GM_ASSERT_REL(p.path_start, reference.path_start, 1e-15);
    GM_ASSERT_REL(p.path_end, reference.path_end, 1e-15);
}

static void a_later_start_shortens_the_path(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_start_radius = 43.5e-3;
    params.wheel_start_radius = 39.5e-3;
    const gm_pair p = make_pair(&params);
    GM_ASSERT_REL(p.path_start,
                  sqrt(43.5e-3 * 43.5e-3 - p.pinion.base_radius * p.pinion.base_radius), 1e-13);
    GM_ASSERT_REL(p.path_end,
                  p.line_of_action -
                      sqrt(39.5e-3 * 39.5e-3 - p.wheel.base_radius * p.wheel.base_radius),
                  1e-13);
    GM_ASSERT_REL(p.transverse_contact_ratio, (p.path_end - p.path_start) / p.transverse_base_pitch,
                  1e-15);
}

static void pitch_angle_carries_two_doubles(void) {
    /* z (pitch_angle + remainder) = 2 pi to 100 bits: 2 pi = 0x6.487ED5110B4611A6 2633145C... */
    const gm_pair p = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_gear *const gears[2] = {&p.pinion, &p.wheel};
    for (int g = 0; g < 2; ++g) {
        gm_test_context("gear %d", g);
        const long double leading = 0x6.487ED5110B46p0L; /* 51 bits */
        const long double rest = 0x11A62633145C06E1p-112L;
        const long double high = (long double)gears[g]->pitch_angle * gears[g]->teeth;
        const long double low = (long double)gears[g]->pitch_angle_remainder * gears[g]->teeth;
        GM_ASSERT_ABS((double)((high - leading) - rest + low), 0.0, 1e-30);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Ranges
 * ------------------------------------------------------------------------------------------- */

typedef struct wrong_value {
    const char *field; /**< expected answer */
    size_t offset;
    double value; /**< put there; integers are converted */
    int is_integer;
    int status;
} wrong_value;

#define NUMBER(name, value, status)                                                                \
    { #name, offsetof(gm_pair_params, name), value, 0, status }
#define INTEGER(name, value, status)                                                               \
    { #name, offsetof(gm_pair_params, name), value, 1, status }

static const wrong_value wrong_values[] = {
    INTEGER(pinion_teeth, 2, GM_ERR_PARAMETER),
    INTEGER(pinion_teeth, -45, GM_ERR_PARAMETER),
    INTEGER(pinion_teeth, 100001, GM_ERR_PARAMETER),
    INTEGER(wheel_teeth, 2, GM_ERR_PARAMETER),
    INTEGER(wheel_teeth, 0, GM_ERR_PARAMETER),
    INTEGER(wheel_teeth, 100001, GM_ERR_PARAMETER),
    INTEGER(base_helix, 2, GM_ERR_PARAMETER),
    INTEGER(base_helix, -1, GM_ERR_PARAMETER),
    NUMBER(normal_module, 0.0, GM_ERR_PARAMETER),
    NUMBER(normal_module, -1e-3, GM_ERR_PARAMETER),
    NUMBER(normal_module, NAN, GM_ERR_PARAMETER),
    NUMBER(normal_module, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(normal_pressure_angle, 0.0, GM_ERR_PARAMETER),
    NUMBER(normal_pressure_angle, -0.1, GM_ERR_PARAMETER),
    NUMBER(normal_pressure_angle, 0.7854, GM_ERR_PARAMETER),
    NUMBER(normal_pressure_angle, NAN, GM_ERR_PARAMETER),
    NUMBER(normal_pressure_angle, 45.0 * 0.017453292519943295, GM_ERR_PARAMETER),
    NUMBER(helix_angle, 60.0 * 0.017453292519943295, GM_ERR_PARAMETER),
    NUMBER(helix_angle, -60.0 * 0.017453292519943295, GM_ERR_PARAMETER),
    NUMBER(helix_angle, 1.0472, GM_ERR_PARAMETER),
    NUMBER(helix_angle, -1.0472, GM_ERR_PARAMETER),
    NUMBER(helix_angle, NAN, GM_ERR_PARAMETER),
    NUMBER(center_distance, 0.0, GM_ERR_PARAMETER),
    NUMBER(center_distance, -85e-3, GM_ERR_PARAMETER),
    NUMBER(center_distance, NAN, GM_ERR_PARAMETER),
    NUMBER(center_distance, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(face_width, 0.0, GM_ERR_PARAMETER),
    NUMBER(face_width, -1e-3, GM_ERR_PARAMETER),
    NUMBER(face_width, NAN, GM_ERR_PARAMETER),
    NUMBER(face_width, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(pinion_face_width, 0.0, GM_ERR_PARAMETER),
    NUMBER(pinion_face_width, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(wheel_face_width, 0.99e-6, GM_ERR_PARAMETER),
    NUMBER(wheel_face_width, 1.01e9, GM_ERR_PARAMETER),
    NUMBER(axial_offset, NAN, GM_ERR_PARAMETER),
    NUMBER(axial_offset, 1.01e9, GM_ERR_PARAMETER),
    NUMBER(axial_offset, -1.01e9, GM_ERR_PARAMETER),
    NUMBER(pinion_rack_addendum, -1e-9, GM_ERR_PARAMETER),
    NUMBER(wheel_rack_addendum, 10.01, GM_ERR_PARAMETER),
    NUMBER(pinion_rack_dedendum, 10.01, GM_ERR_PARAMETER),
    NUMBER(wheel_rack_dedendum, -1e-9, GM_ERR_PARAMETER),
    NUMBER(pinion_rack_fillet_radius, -1e-9, GM_ERR_PARAMETER),
    NUMBER(wheel_rack_fillet_radius, 10.01, GM_ERR_PARAMETER),
    NUMBER(pinion_tip_alteration, -10.01, GM_ERR_PARAMETER),
    NUMBER(wheel_tip_alteration, 10.01, GM_ERR_PARAMETER),
    NUMBER(wheel_tip_alteration, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(pinion_profile_shift, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(wheel_profile_shift, -HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(backlash, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(backlash, -HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(pinion_normal_thickness, 0.0, GM_ERR_PARAMETER),
    NUMBER(pinion_normal_thickness, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(wheel_normal_thickness, -1e-3, GM_ERR_PARAMETER),
    NUMBER(wheel_normal_thickness, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(pinion_tip_radius, 0.0, GM_ERR_PARAMETER),
    NUMBER(pinion_tip_radius, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(wheel_tip_radius, -1.0, GM_ERR_PARAMETER),
    NUMBER(wheel_tip_radius, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(pinion_start_radius, 0.0, GM_ERR_PARAMETER),
    NUMBER(pinion_start_radius, HUGE_VAL, GM_ERR_PARAMETER),
    NUMBER(wheel_start_radius, -1.0, GM_ERR_PARAMETER),
    NUMBER(wheel_start_radius, HUGE_VAL, GM_ERR_PARAMETER),
    /* Far beyond all gears. */
    NUMBER(normal_module, 0.99e-6, GM_ERR_PARAMETER),
    NUMBER(normal_module, 1.01e9, GM_ERR_PARAMETER),
    NUMBER(center_distance, 0.99e-6, GM_ERR_PARAMETER),
    NUMBER(center_distance, 1.01e9, GM_ERR_PARAMETER),
    NUMBER(face_width, 0.99e-6, GM_ERR_PARAMETER),
    NUMBER(face_width, 1.01e9, GM_ERR_PARAMETER),
    NUMBER(pinion_profile_shift, 1001.0, GM_ERR_PARAMETER),
    NUMBER(wheel_profile_shift, -1001.0, GM_ERR_PARAMETER),
    NUMBER(backlash, -1.01e9, GM_ERR_PARAMETER),
    NUMBER(pinion_normal_thickness, 1.01e9, GM_ERR_PARAMETER),
    NUMBER(wheel_normal_thickness, 0.99e-6, GM_ERR_PARAMETER),
    NUMBER(pinion_tip_radius, 1.01e9, GM_ERR_PARAMETER),
    NUMBER(wheel_tip_radius, 0.99e-6, GM_ERR_PARAMETER),
    NUMBER(pinion_start_radius, 1e-7, GM_ERR_PARAMETER),
    NUMBER(wheel_start_radius, 1e300, GM_ERR_PARAMETER),
    /* Each fine, together not. r_bp + r_bw = 80.05 mm. */
    NUMBER(center_distance, 80.04e-3, GM_ERR_GEOMETRY),
    NUMBER(pinion_tip_radius, 41.8e-3, GM_ERR_GEOMETRY), /* below the base circle */
    NUMBER(wheel_tip_radius, 38.1e-3, GM_ERR_GEOMETRY),
    NUMBER(pinion_start_radius, 46.94e-3, GM_ERR_GEOMETRY), /* above the tip */
    NUMBER(wheel_start_radius, 43.01e-3, GM_ERR_GEOMETRY),
    NUMBER(backlash, 7e-3, GM_ERR_GEOMETRY), /* no tooth left: 2 x 2.7 mm cos(alpha_t)/cos(beta) */
    NUMBER(pinion_profile_shift, -3.0, GM_ERR_GEOMETRY), /* s_n = m_n (pi/2 - 6 tan(16 deg)) < 0 */
    NUMBER(wheel_profile_shift, -3.0, GM_ERR_GEOMETRY),
    NUMBER(backlash, -5.85e-3, GM_ERR_GEOMETRY), /* the base pitch is 5.848 mm */
    /* 1.75 / (1 - sin(16 deg)) = 2.4159 modules of fillet take all of the dedendum. */
    NUMBER(pinion_rack_fillet_radius, 2.416, GM_ERR_GEOMETRY),
    NUMBER(wheel_rack_fillet_radius, 2.416, GM_ERR_GEOMETRY),
    NUMBER(pinion_rack_dedendum, 0.275, GM_ERR_GEOMETRY), /* 0.38 (1 - sin(16 deg)) = 0.27526 */
    NUMBER(wheel_rack_dedendum, 0.275, GM_ERR_GEOMETRY),
    NUMBER(face_width, 100.0, GM_ERR_GEOMETRY), /* thousands of lines of contact at once */
    /* Teeth so thick that they would overlap by more than a pitch, also where no backlash is given. */
    NUMBER(pinion_normal_thickness, 20e-3, GM_ERR_GEOMETRY),
    NUMBER(wheel_normal_thickness, 1e6, GM_ERR_GEOMETRY),
    NUMBER(pinion_profile_shift, 20.0, GM_ERR_GEOMETRY),
};

static void set_wrong(gm_pair_params *params, const wrong_value *wrong) {
    char *place = (char *)params + wrong->offset;
    if (wrong->is_integer) {
        const int value = (int)wrong->value;
        memcpy(place, &value, sizeof value);
    } else {
        memcpy(place, &wrong->value, sizeof wrong->value);
    }
}

static void every_wrong_value_is_named(void) {
    for (size_t i = 0; i < sizeof wrong_values / sizeof wrong_values[0]; ++i) {
        const wrong_value *wrong = &wrong_values[i];
        gm_test_context("%s = %g", wrong->field, wrong->value);
        gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
        if (strstr(wrong->field, "shift") != NULL || strstr(wrong->field, "thickness") != NULL) {
            params.backlash = NAN; /* else the backlash decides the thickness */
            params.pinion_profile_shift = params.wheel_profile_shift = 0.1;
        }
        set_wrong(&params, wrong);
        const char *field = "";
        const char *requirement = NULL;
        GM_ASSERT_INT(gm_pair_params_check(&params, &field, &requirement), wrong->status);
        GM_ASSERT_STRING(field, wrong->field);
        GM_ASSERT(requirement != NULL && strlen(requirement) > 3);
        GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), wrong->status);
        gm_pair pair;
        memset(&pair, 0, sizeof pair);
        GM_ASSERT_INT(gm_pair_init(&pair, &params), wrong->status);
        assert_unusable(&pair);
    }
}

/* Bounds belong to the ranges; what they make together is another matter. */
static void the_bounds_themselves_are_within_the_ranges(void) {
    static const wrong_value bounds[] = {
        INTEGER(pinion_teeth, 3, GM_OK),
        INTEGER(pinion_teeth, 100000, GM_OK),
        INTEGER(wheel_teeth, 3, GM_OK),
        INTEGER(wheel_teeth, 100000, GM_OK),
        NUMBER(normal_module, 1e-6, GM_OK),
        NUMBER(normal_module, 1e9, GM_OK),
        NUMBER(center_distance, 1e-6, GM_OK),
        NUMBER(center_distance, 1e9, GM_OK),
        NUMBER(face_width, 1e-6, GM_OK),
        NUMBER(face_width, 1e9, GM_OK),
        NUMBER(pinion_face_width, 1e-6, GM_OK),
        NUMBER(wheel_face_width, 1e9, GM_OK),
        NUMBER(axial_offset, 1e9, GM_OK),
        NUMBER(axial_offset, -1e9, GM_OK),
        NUMBER(pinion_profile_shift, 1000.0, GM_OK),
        NUMBER(wheel_profile_shift, -1000.0, GM_OK),
        NUMBER(backlash, 1e9, GM_OK),
        NUMBER(backlash, -1e9, GM_OK),
        NUMBER(pinion_normal_thickness, 1e-6, GM_OK),
        NUMBER(wheel_normal_thickness, 1e9, GM_OK),
        NUMBER(pinion_rack_addendum, 0.0, GM_OK),
        NUMBER(wheel_rack_addendum, 10.0, GM_OK),
        NUMBER(pinion_rack_dedendum, 10.0, GM_OK),
        NUMBER(wheel_rack_fillet_radius, 0.0, GM_OK),
        NUMBER(pinion_tip_alteration, 10.0, GM_OK),
        NUMBER(wheel_tip_alteration, -10.0, GM_OK),
        NUMBER(pinion_tip_radius, 1e-6, GM_OK),
        NUMBER(wheel_tip_radius, 1e9, GM_OK),
        NUMBER(pinion_start_radius, 1e-6, GM_OK),
        NUMBER(wheel_start_radius, 1e9, GM_OK),
    };
    for (size_t i = 0; i < sizeof bounds / sizeof bounds[0]; ++i) {
        gm_test_context("%s = %g", bounds[i].field, bounds[i].value);
        gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
        set_wrong(&params, &bounds[i]);
        GM_ASSERT(gm_pair_params_check(&params, NULL, NULL) != GM_ERR_PARAMETER);
    }
}

static void the_total_contact_ratio_ends_at_1000(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    const gm_pair p = make_pair(&params);
    const double per_width = p.overlap_ratio / p.face_width;
    params.face_width = (999.9 - p.transverse_contact_ratio) / per_width;
    GM_ASSERT_ABS(make_pair(&params).total_contact_ratio, 999.9, 1e-9);
    params.face_width = (1000.1 - p.transverse_contact_ratio) / per_width;
    const char *field = "";
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_GEOMETRY);
    GM_ASSERT_STRING(field, "face_width");
}

/* Of pairs that mesh far from the pitch point, the largest one that is taken is 1000 base pitches off. */
static void the_place_of_the_teeth_ends_at_1000_base_pitches(void) {
    double accepted = 1.0, refused = 400.0;
    double place = NAN;
    while (refused - accepted > 1e-6) {
        const double d = 0.5 * (accepted + refused);
        gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
        params.center_distance = d;
        params.pinion_tip_radius = 0.425 * d;
        params.pinion_start_radius = 0.4125 * d;
        params.wheel_tip_radius = 0.59 * d;
        params.wheel_start_radius = 0.575 * d;
        gm_pair p;
        const char *field = "";
        (void)gm_pair_params_check(&params, &field, NULL);
        if (gm_pair_init(&p, &params) == GM_OK) {
            accepted = d;
            place = fabs(p.phase_origin[GM_DRIVE] - p.path_start) / p.transverse_base_pitch;
        } else {
            refused = d;
            GM_ASSERT_STRING(field, "center_distance");
        }
    }
    GM_ASSERT_ABS(place, 1000.0, 0.1);
}

static void a_helix_below_all_rounding_is_none(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.center_distance = 72e-3;
    params.pinion_tip_radius = params.wheel_tip_radius = NAN;
    params.helix_angle =
        1e-15; /* 1.7e-17 m over the face; the base pitch is rounded to 5.5e-19 m */
    GM_ASSERT_REL(make_pair(&params).face_advance, 17.5e-18 * cos(16.0 * degree), 1e-12);
    params.helix_angle = 1e-17;
    GM_ASSERT_REL(make_pair(&params).face_advance, 0.0, 0.0);
}

static void the_narrowest_common_face_is_a_micrometre(void) {
    gm_pair_params params = reference_params(1e-6);
    GM_ASSERT_REL(make_pair(&params).face_width, 1e-6, 0.0);
}

/* A common width may repeat the common face but for rounding, 1e-9 of it. */
static void a_common_width_may_be_rounded(void) {
    static const struct {
        double times;
        int status;
    } cases[] = {
        {1.0 + 0.9e-9, GM_OK},
        {1.0 - 0.9e-9, GM_OK},
        {1.0 + 2.0e-9, GM_ERR_GEOMETRY},
        {1.0 - 2.0e-9, GM_ERR_GEOMETRY},
    };
    for (int i = 0; i < 4; ++i) {
        gm_test_context("case %d", i);
        gm_pair_params params = reference_params(20e-3 * cases[i].times);
        params.pinion_face_width = 20e-3;
        params.wheel_face_width = 30e-3;
        GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), cases[i].status);
        params.axial_offset = 10e-3; /* 15 of the pinion's 20 mm are left */
        params.face_width = 15e-3 * cases[i].times;
        GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), cases[i].status);
    }
}

/* The same bounds from the other side. */
static void racks_just_inside_the_ranges_are_taken(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_rack_fillet_radius = 2.4158;
    params.wheel_rack_fillet_radius = 0.0;
    GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_OK);
    params.wheel_rack_fillet_radius = 2.4158;
    params.pinion_rack_fillet_radius = 0.0;
    GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_OK);
    params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_rack_dedendum = params.wheel_rack_dedendum = 0.2753;
    params.pinion_rack_addendum = params.wheel_rack_addendum = 0.0;
    GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_OK);
    params.pinion_rack_addendum = params.wheel_rack_addendum = 10.0;
    params.pinion_rack_dedendum = params.wheel_rack_dedendum = 10.0;
    params.pinion_rack_fillet_radius = params.wheel_rack_fillet_radius = 10.0;
    GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_OK);
    params.pinion_tip_alteration = 10.0;
    params.wheel_tip_alteration = -10.0;
    GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_OK);
    params.axial_offset = 17e-3; /* leaves 0.5 mm */
    GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_OK);
    params.axial_offset = REFERENCE_FACE_WIDTH - 1.1e-6;
    GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_OK);
    params.axial_offset = REFERENCE_FACE_WIDTH - 0.9e-6; /* below the smallest length */
    GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_ERR_GEOMETRY);
}

/* A gear of 15 teeth and a rack of 10 modules: nothing is left of its body, r = 7.5 m_n. */
static void a_rack_deeper_than_the_gear_is_refused(void) {
    const struct {
        int pinion_teeth, wheel_teeth;
        double dedendum;
        const char *field;
    } cases[] = {
        {15, 40, 7.51, "pinion_rack_dedendum"},
        {40, 15, 7.51, "wheel_rack_dedendum"},
        {15, 40, 7.49, NULL},
        {40, 15, 7.49, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        gm_test_context("case %d", (int)i);
        gm_pair_params params =
            catalogue_params(cases[i].pinion_teeth, cases[i].wheel_teeth, 2.0, 0.0, 55.0, 0.0, 0.0);
        params.pinion_rack_dedendum = params.wheel_rack_dedendum = cases[i].dedendum;
        const char *field = "";
        const int status = gm_pair_params_check(&params, &field, NULL);
        GM_ASSERT_INT(status, cases[i].field == NULL ? GM_OK : GM_ERR_GEOMETRY);
        GM_ASSERT_STRING(field, cases[i].field);
    }
}

/* What makes a tip too low is named: the tip alteration where it is given, else the tip. */
static void a_tip_below_the_base_circle_is_blamed_on_what_was_given(void) {
    static const struct {
        double pinion_k, wheel_k, pinion_addendum;
        const char *field;
    } cases[] = {
        {-3.0, NAN, NAN, "pinion_tip_alteration"},
        {NAN, -4.0, 1.2, "wheel_tip_alteration"},
        /* 10 teeth: r_b = r - 0.3015 m_n, and x_p = -0.7: h_aP > 0.3985. */
        {NAN, NAN, 0.39, "pinion_tip_radius"},
        {NAN, NAN, 0.41, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        gm_test_context("case %d", (int)i);
        gm_pair_params params = catalogue_params(10, 30, 2.0, 0.0, 40.0, -0.7, 0.7);
        params.pinion_tip_alteration = cases[i].pinion_k;
        params.wheel_tip_alteration = cases[i].wheel_k;
        params.pinion_rack_addendum = cases[i].pinion_addendum;
        params.wheel_rack_addendum = 2.0; /* reaches beyond the pinion's base circle */
        const char *field = "";
        (void)gm_pair_params_check(&params, &field, NULL);
        GM_ASSERT_STRING(field, cases[i].field);
    }
}

static void values_just_inside_the_ranges_are_taken(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    const char *field = "";
    const char *requirement = "";
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, &requirement), GM_OK);
    GM_ASSERT_STRING(field, NULL);
    GM_ASSERT_STRING(requirement, NULL);

    params = reference_params(REFERENCE_FACE_WIDTH);
    params.base_helix = GM_BASE_HELIX_PAPER;
    GM_ASSERT_INT(gm_pair_params_check(&params, NULL, NULL), GM_OK);

    /* 3 and 100000 teeth. The smallest gear is shifted so that its tip is above its base circle. */
    gm_pair_params_default(&params);
    params.pinion_teeth = 3;
    params.wheel_teeth = 100000;
    params.normal_module = 1e-3;
    params.normal_pressure_angle = 20.0 * degree;
    params.center_distance = 100003.0e-3 / 2.0 + 0.4e-3;
    params.face_width = 10e-3;
    gm_pair pair;
    GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);
    GM_ASSERT_INT(pair.pinion.teeth, 3);
    GM_ASSERT_INT(pair.wheel.teeth, 100000);

    /* Angles next to their bounds. */
    params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_tip_radius = NAN;
    params.wheel_tip_radius = NAN;
    params.normal_pressure_angle = 44.9 * degree;
    params.helix_angle = 59.9 * degree;
    params.center_distance = 86.0 * 1.65e-3 / 2.0 / cos(params.helix_angle) + 0.1e-3;
    GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);
    params.helix_angle = -59.9 * degree;
    GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);
}

static void teeth_far_from_their_path_of_contact_are_refused(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    gm_pair pair;
    /* The wheel's tips are far out, so that the pair meshes nowhere near the pitch point. */
    params.center_distance = 400.0;
    params.pinion_tip_radius = 170.0;
    params.pinion_start_radius = 165.0;
    params.wheel_tip_radius = 236.0;
    params.wheel_start_radius = 230.0;
    const char *field = "";
    const char *requirement = "";
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, &requirement), GM_ERR_GEOMETRY);
    GM_ASSERT_STRING(field, "center_distance");
    GM_ASSERT(requirement != NULL && strstr(requirement, "1000 base pitches") != NULL);
    GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_ERR_GEOMETRY);
    assert_unusable(&pair);
}

static void tips_that_do_not_reach_each_other_are_refused(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_tip_radius = 43.5e-3;
    params.wheel_tip_radius = 39.5e-3;
    const char *field = "";
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_GEOMETRY);
    GM_ASSERT(field != NULL && strstr(field, "tip_radius") != NULL);
    /* The same if the profiles are said to start further down. */
    params.pinion_start_radius = 42.0e-3;
    params.wheel_start_radius = 38.2e-3;
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_GEOMETRY);
    GM_ASSERT(field != NULL);
    /* Tips that reach, but only below where the mate's profile starts. */
    params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_start_radius = 46.5e-3;
    params.wheel_start_radius = 42.5e-3;
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_GEOMETRY);
    GM_ASSERT(field != NULL);
    gm_pair pair;
    GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_ERR_GEOMETRY);
    assert_unusable(&pair);
}

/* The wheel alone at fault: its start is derived from a pinion tip that does not reach. */
/* A shift that was derived is not at fault: what it was derived from is. */
static void a_thin_tooth_is_blamed_on_what_was_given(void) {
    const struct {
        int teeth;
        double wheel_shift, center_distance;
        const char *field;
    } cases[] = {
        {45, 4.0, 85e-3, "wheel_profile_shift"}, /* leaves the pinion x = 0.25 - 4 */
        /* Base radii 186.16 mm: all but no working angle, x = -200 inv(alpha_t) / tan(16 deg) < -4. */
        {200, NAN, 372.5e-3, "center_distance"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        gm_test_context("case %d", (int)i);
        gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
        params.backlash = NAN;
        params.pinion_teeth = params.wheel_teeth = cases[i].teeth;
        params.pinion_profile_shift = NAN;
        params.wheel_profile_shift = cases[i].wheel_shift;
        params.center_distance = cases[i].center_distance;
        const char *field = "";
        (void)gm_pair_params_check(&params, &field, NULL);
        GM_ASSERT_STRING(field, cases[i].field);
    }
}

/* Base circles that just touch leave no line of action. */
static void base_circles_must_be_apart(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    const gm_pair p = make_pair(&params);
    params.center_distance = p.pinion.base_radius + p.wheel.base_radius;
    const char *field = "";
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_GEOMETRY);
    GM_ASSERT_STRING(field, "center_distance");
}

static void the_gear_at_fault_is_named(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_start_radius = 42.5e-3;
    params.pinion_tip_radius = 43.0e-3;
    params.wheel_tip_radius = 39.0e-3;
    const char *field = "";
    GM_ASSERT_INT(gm_pair_params_check(&params, &field, NULL), GM_ERR_GEOMETRY);
    GM_ASSERT_STRING(field, "wheel_tip_radius");
}

static void null_pointers_are_refused(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    gm_pair pair;
    const char *field = "";
    const char *requirement = "";
    GM_ASSERT_INT(gm_pair_params_check(NULL, &field, &requirement), GM_ERR_NULL);
    GM_ASSERT_STRING(field, NULL);
    GM_ASSERT_STRING(requirement, NULL);
    GM_ASSERT_INT(gm_pair_params_check(NULL, NULL, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_pair_init(NULL, &params), GM_ERR_NULL);
    GM_ASSERT_INT(gm_pair_init(NULL, NULL), GM_ERR_NULL);
    memset(&pair, 0, sizeof pair);
    GM_ASSERT_INT(gm_pair_init(&pair, NULL), GM_ERR_NULL);
    assert_unusable(&pair);
}

/* A pair that is said to be good holds only numbers, however absurd the drawing. */
static void success_means_finite(void) {
    static const double extremes[] = {1e-320, 1e-300, 1e-150, 1e150, 1e300, 1.7e308};
    for (size_t i = 0; i < sizeof wrong_values / sizeof wrong_values[0]; ++i) {
        for (size_t k = 0; k < 2 * sizeof extremes / sizeof extremes[0]; ++k) {
            wrong_value wrong = wrong_values[i];
            if (wrong.is_integer || (i > 0 && wrong.offset == wrong_values[i - 1].offset)) {
                continue;
            }
            wrong.value = extremes[k / 2] * (k % 2 == 0 ? 1.0 : -1.0);
            gm_test_context("%s = %g", wrong.field, wrong.value);
            for (int with_backlash = 0; with_backlash < 2; ++with_backlash) {
                gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
                if (!with_backlash) {
                    params.backlash = NAN;
                }
                set_wrong(&params, &wrong);
                gm_pair pair;
                double values[PAIR_DOUBLES];
                const int status = gm_pair_init(&pair, &params);
                list_pair(&pair, values);
                int finite = 1;
                for (int v = 0; v < PAIR_DOUBLES; ++v) {
                    finite = finite && isfinite(values[v]);
                }
                GM_ASSERT((status == GM_OK) == finite);
            }
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * Warnings
 * ------------------------------------------------------------------------------------------- */

static int warnings_of(const gm_pair_params *params) {
    const gm_pair pair = make_pair(params);
    return gm_pair_warnings(&pair, params);
}

static void reference_gears_give_no_warning(void) {
    const gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    GM_ASSERT_INT(warnings_of(&params), 0);
}

static void warnings_need_both_pointers(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.backlash = -10e-6;
    const gm_pair pair = make_pair(&params);
    GM_ASSERT_INT(gm_pair_warnings(&pair, &params), GM_WARN_BACKLASH);
    GM_ASSERT_INT(gm_pair_warnings(NULL, &params), 0);
    GM_ASSERT_INT(gm_pair_warnings(&pair, NULL), 0);
}

/** A small spur gear without shift, cut by a standard rack, with a large mate; by role. */
static gm_pair_params undercut_params(int small_is_pinion) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = small_is_pinion ? 10 : 60;
    params.wheel_teeth = small_is_pinion ? 60 : 10;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = 20.0 * degree;
    params.center_distance = 70e-3;
    params.face_width = 20e-3;
    params.pinion_profile_shift = 0.0;
    params.wheel_profile_shift = 0.0;
    params.backlash = 50e-6;
    return params;
}

/* A rack undercuts below z = 2 (h + 0.05) / sin^2(alpha) = 18 teeth of 20 degrees. */
static void few_teeth_without_shift_are_undercut(void) {
    const gm_pair_params pinion = undercut_params(1);
    GM_ASSERT_INT(warnings_of(&pinion) & (GM_WARN_PINION_UNDERCUT | GM_WARN_WHEEL_UNDERCUT),
                  GM_WARN_PINION_UNDERCUT);
    const gm_pair_params wheel = undercut_params(0);
    GM_ASSERT_INT(warnings_of(&wheel) & (GM_WARN_PINION_UNDERCUT | GM_WARN_WHEEL_UNDERCUT),
                  GM_WARN_WHEEL_UNDERCUT);
}

static void thin_and_pointed_tips_are_warned_of(void) {
    /* s_t at the tip = 2 r_a (psi_b - inv(alpha_a)): the reference gear's land is 0.5 m_n; a tip 0.8 mm
     * larger leaves less than 0.2 m_n, one 2 mm larger nothing. */
    static const double longer[] = {0.8e-3, 2.0e-3};
    for (int k = 0; k < 2; ++k) {
        gm_test_context("%g", longer[k]);
        gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
        params.pinion_tip_radius += longer[k];
        const gm_pair p = make_pair(&params);
        const double chi = p.pinion.tip_roll_length / p.pinion.base_radius;
        const double land =
            2.0 * p.pinion.tip_radius * (p.pinion.base_half_thickness - (chi - atan(chi)));
        GM_ASSERT(land * cos(p.helix_angle) < 0.2 * p.normal_module);
        GM_ASSERT_INT(gm_pair_warnings(&p, &params) &
                          (GM_WARN_PINION_TIP_LAND | GM_WARN_WHEEL_TIP_LAND),
                      GM_WARN_PINION_TIP_LAND);
        params = reference_params(REFERENCE_FACE_WIDTH);
        params.wheel_tip_radius += longer[k];
        GM_ASSERT_INT(warnings_of(&params) & (GM_WARN_PINION_TIP_LAND | GM_WARN_WHEEL_TIP_LAND),
                      GM_WARN_WHEEL_TIP_LAND);
    }
}

/* Normal tip land = 2 r_a (psi_b - inv(alpha_a)) cos(beta_a), tan(beta_a) = tan(beta) r_a / r: 0.2 m_n is enough. */
static void the_least_tip_land_is_a_fifth_of_a_module(void) {
    const gm_pair p = reference_pair(REFERENCE_FACE_WIDTH);
    for (int wheel = 0; wheel < 2; ++wheel) {
        gm_test_context("wheel %d", wheel);
        const gm_gear *gear = wheel ? &p.wheel : &p.pinion;
        double low = gear->tip_radius, high = gear->tip_radius + 2e-3;
        while (high - low > 1e-12) {
            const double r = 0.5 * (low + high);
            const double alpha = acos(gear->base_radius / r);
            const double land = 2.0 * r * (gear->base_half_thickness - (tan(alpha) - alpha)) *
                                cos(atan(tan(p.helix_angle) * r / gear->reference_radius));
            *(land > 0.2 * p.normal_module ? &low : &high) = r;
        }
        for (int above = 0; above < 2; ++above) {
            gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
            *(wheel ? &params.wheel_tip_radius : &params.pinion_tip_radius) =
                low + (above ? 1e-8 : -1e-8);
            const gm_pair at_limit = make_pair(&params);
            const gm_gear *thin = wheel ? &at_limit.wheel : &at_limit.pinion;
            GM_ASSERT_REL(thin->normal_tip_thickness, 0.2 * p.normal_module, 1e-3);
            const int flag = wheel ? GM_WARN_WHEEL_TIP_LAND : GM_WARN_PINION_TIP_LAND;
            GM_ASSERT_INT(warnings_of(&params) & (GM_WARN_WHEEL_TIP_LAND | GM_WARN_PINION_TIP_LAND),
                          above ? flag : 0);
        }
    }
}

/* The same two teeth meet again after the first number of passes that both numbers of teeth divide. */
static void the_hunting_period_is_the_least_that_both_gears_divide(void) {
    static const int teeth[][2] = {{45, 41}, {20, 20}, {20, 40},      {40, 20},
                                   {24, 36}, {3, 97},  {99990, 99999}};
    for (size_t k = 0; k < sizeof teeth / sizeof teeth[0]; ++k) {
        gm_test_context("%d/%d", teeth[k][0], teeth[k][1]);
        gm_pair_params params;
        gm_pair_params_default(&params);
        params.pinion_teeth = teeth[k][0];
        params.wheel_teeth = teeth[k][1];
        params.normal_module = 2e-3;
        params.normal_pressure_angle = 20.0 * degree;
        params.face_width = 20e-3;
        params.center_distance = 1e-3 * (teeth[k][0] + teeth[k][1]);
        const gm_pair pair = make_pair(&params);

        long long passes = teeth[k][0];
        while (passes % teeth[k][1] != 0) {
            passes += teeth[k][0];
        }
        GM_ASSERT_ABS(pair.hunting_passes, (double)passes, 0.0);
    }
}

static void a_start_below_the_root_form_is_warned_of(void) {
    /* A straight rack flank 0.05 m_n deeper than needed ends near rho = 7 mm: the base circle is deeper. */
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_start_radius = 41.886e-3;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_PINION_ROOT_FORM);
    params = reference_params(REFERENCE_FACE_WIDTH);
    params.wheel_start_radius = 38.163e-3;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_WHEEL_ROOT_FORM);
    /* Below the base circle both warnings are named. */
    params.wheel_start_radius = 38.0e-3;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_WHEEL_ROOT_FORM | GM_WARN_WHEEL_START_RADIUS);
    /* A start on the base circle is where it is said to be. */
    params.wheel_start_radius = make_pair(&params).wheel.base_radius;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_WHEEL_ROOT_FORM);
    params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_start_radius = 41.0e-3;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_PINION_ROOT_FORM | GM_WARN_PINION_START_RADIUS);
}

/* With the rack given, form and undercut are those of this rack; without, of one that suits the mate's tip. */
static void the_rack_that_is_given_cuts_the_root(void) {
    /* r sin^2(20 deg) = 0.1170 * r, so a straight flank down to that depth ends on the base circle: for 20 teeth,
     * r = 10 m_n, it is 1.1698 m_n deep. A fillet of 0.38 takes 0.38 (1 - sin(20 deg)) = 0.25003 off the dedendum. */
    const struct {
        double dedendum, fillet;
        int undercut;
        double shift;
    } cases[] = {
        {1.419, NAN, 0, 0.0}, {1.421, NAN, 1, 0.0}, /* 1.1690 and 1.1710 straight */
        {NAN, 0.0, 1, 0.0},                         /* 1.25 straight */
        {NAN, 0.13, 0, 0.0},                        /* 1.1645 straight */
        {1.30, 0.19, 1, 0.0}, {1.30, 0.21, 0, 0.0}, /* 1.1750 and 1.1618 */
        {NAN, NAN, 0, 0.0},                         /* 1.05: the mate's tip, and a little more */
        {1.50, NAN, 0, 0.1},  {1.60, NAN, 1, 0.1},  /* 1.15 and 1.25 below the reference circle */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        for (int wheel = 0; wheel < 2; ++wheel) {
            gm_test_context("case %d, wheel %d", (int)i, wheel);
            gm_pair_params params = catalogue_params(wheel ? 60 : 20, wheel ? 20 : 60, 2.0, 0.0,
                                                     80.0, wheel ? -cases[i].shift : cases[i].shift,
                                                     wheel ? cases[i].shift : -cases[i].shift);
            params.backlash = 50e-6;
            *(wheel ? &params.wheel_rack_dedendum : &params.pinion_rack_dedendum) =
                cases[i].dedendum;
            *(wheel ? &params.wheel_rack_fillet_radius : &params.pinion_rack_fillet_radius) =
                cases[i].fillet;
            const int expected = wheel ? GM_WARN_WHEEL_UNDERCUT : GM_WARN_PINION_UNDERCUT;
            GM_ASSERT_INT(warnings_of(&params) & (GM_WARN_WHEEL_UNDERCUT | GM_WARN_PINION_UNDERCUT),
                          cases[i].undercut ? expected : 0);
        }
    }
}

/* The assumed rack reaches 0.05 m_n deeper than the mate's tip: with these tips the form circle is passed by the start. */
static void the_assumed_rack_suits_the_mates_tip(void) {
    gm_pair_params params = catalogue_params(40, 50, 2.0, 0.0, 90.0, 0.0, 0.0);
    params.backlash = 50e-6;
    const gm_pair p = make_pair(&params);
    /* rho_Ff = r sin(20 deg) - 1.05 m_n / sin(20 deg) */
    const double sine = sin(20.0 * degree);
    const double form = 40e-3 * sine - 1.05 * 2e-3 / sine;
    params.pinion_start_radius = hypot(p.pinion.base_radius, form - 1e-6);
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_PINION_ROOT_FORM);
    params.pinion_start_radius = hypot(p.pinion.base_radius, form + 1e-6);
    GM_ASSERT_INT(warnings_of(&params), 0);
    params.pinion_start_radius = NAN;
    const double wheel_form = 50e-3 * sine - 1.05 * 2e-3 / sine;
    params.wheel_start_radius = hypot(p.wheel.base_radius, wheel_form - 1e-6);
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_WHEEL_ROOT_FORM);
    params.wheel_start_radius = hypot(p.wheel.base_radius, wheel_form + 1e-6);
    GM_ASSERT_INT(warnings_of(&params), 0);
}

static void small_tip_clearances_are_warned_of(void) {
    /* Without shifts the clearance of the pinion's tip is h_fP of the wheel - h_aP of the pinion - k. */
    gm_pair_params params = catalogue_params(40, 50, 2.0, 0.0, 90.0, 0.0, 0.0);
    params.backlash = 50e-6;
    params.pinion_tip_alteration = 0.1499;
    GM_ASSERT_INT(warnings_of(&params), 0);
    params.pinion_tip_alteration = 0.1501;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_PINION_TIP_CLEARANCE);
    params.pinion_tip_alteration = NAN;
    params.wheel_tip_alteration = 0.1499;
    GM_ASSERT_INT(warnings_of(&params), 0);
    params.wheel_tip_alteration = 0.1501;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_WHEEL_TIP_CLEARANCE);
}

static void a_tip_alteration_beside_a_tip_is_not_used(void) {
    const gm_pair_params reference = reference_params(REFERENCE_FACE_WIDTH);
    const gm_pair expected = make_pair(&reference);
    gm_pair_params params = reference;
    params.pinion_tip_alteration = -0.2;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_PINION_TIP_ALTERATION);
    params.wheel_tip_alteration = -0.2;
    GM_ASSERT_INT(warnings_of(&params),
                  GM_WARN_PINION_TIP_ALTERATION | GM_WARN_WHEEL_TIP_ALTERATION);
    const gm_pair p = make_pair(&params);
    GM_ASSERT(memcmp(&p, &expected, sizeof p) == 0);
    params.pinion_tip_alteration = NAN;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_WHEEL_TIP_ALTERATION);
}

static void a_little_negative_backlash_is_that_of_rounded_shifts(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    const double limit = -1e-4 * params.normal_module;
    params.backlash = 1.001 * limit;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_BACKLASH);
    params.backlash = 0.999 * limit;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_BACKLASH_ROUNDED);
    params.backlash = -2e-12 * make_pair(&params).transverse_base_pitch;
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_BACKLASH_ROUNDED);
    params.backlash = -0.5e-12 * make_pair(&params).transverse_base_pitch; /* rounding of zero */
    GM_ASSERT_INT(warnings_of(&params), 0);
    params.backlash = 0.0;
    GM_ASSERT_INT(warnings_of(&params), 0);
}

static void short_paths_are_warned_of(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_tip_radius = 45.3e-3;
    params.wheel_tip_radius = 41.3e-3;
    GM_ASSERT(make_pair(&params).transverse_contact_ratio < 1.0);
    GM_ASSERT_INT(warnings_of(&params), GM_WARN_CONTACT_RATIO);
    params.wheel_tip_radius = 41.9e-3;
    const double enough = make_pair(&params).transverse_contact_ratio;
    GM_ASSERT(enough > 1.0 && enough < 1.1);
    GM_ASSERT_INT(warnings_of(&params), 0);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(the_lists_above_are_complete),
        GM_TEST(reference_gears_have_their_known_geometry),
        GM_TEST(wider_reference_gears_have_their_known_overlap),
        GM_TEST(standard_rack_has_its_known_path),
        GM_TEST(paper_base_helix_is_there_on_request_only),
        GM_TEST(left_hand_changes_signs_alone),
        GM_TEST(defaults_are_missing_or_derived),
        GM_TEST(a_zeroed_struct_is_refused),
        GM_TEST(shifts_default_to_zero_backlash),
        GM_TEST(thickness_wins_over_shift),
        GM_TEST(backlash_thins_both_teeth_equally_and_leaves_the_shifts),
        GM_TEST(published_pairs_have_their_tips_and_contact_ratios),
        GM_TEST(no_tip_alteration_is_none),
        GM_TEST(tips_default_to_addendum_shift_and_tip_alteration),
        GM_TEST(tip_alteration_keeps_the_clearance_of_the_rack),
        GM_TEST(a_given_tip_tells_its_tip_alteration),
        GM_TEST(equal_faces_may_be_said_in_each_way),
        GM_TEST(unequal_faces_share_what_lies_in_both),
        GM_TEST(a_pinion_that_begins_earlier_only_turns_its_zero),
        GM_TEST(faces_that_contradict_each_other_are_refused),
        GM_TEST(profiles_start_where_the_mates_tip_reaches),
        GM_TEST(a_start_below_the_base_circle_is_raised),
        GM_TEST(a_later_start_shortens_the_path),
        GM_TEST(pitch_angle_carries_two_doubles),
        GM_TEST(every_wrong_value_is_named),
        GM_TEST(the_bounds_themselves_are_within_the_ranges),
        GM_TEST(the_total_contact_ratio_ends_at_1000),
        GM_TEST(the_place_of_the_teeth_ends_at_1000_base_pitches),
        GM_TEST(a_helix_below_all_rounding_is_none),
        GM_TEST(the_narrowest_common_face_is_a_micrometre),
        GM_TEST(a_common_width_may_be_rounded),
        GM_TEST(racks_just_inside_the_ranges_are_taken),
        GM_TEST(a_rack_deeper_than_the_gear_is_refused),
        GM_TEST(a_tip_below_the_base_circle_is_blamed_on_what_was_given),
        GM_TEST(values_just_inside_the_ranges_are_taken),
        GM_TEST(teeth_far_from_their_path_of_contact_are_refused),
        GM_TEST(tips_that_do_not_reach_each_other_are_refused),
        GM_TEST(a_thin_tooth_is_blamed_on_what_was_given),
        GM_TEST(base_circles_must_be_apart),
        GM_TEST(the_gear_at_fault_is_named),
        GM_TEST(null_pointers_are_refused),
        GM_TEST(success_means_finite),
        GM_TEST(reference_gears_give_no_warning),
        GM_TEST(warnings_need_both_pointers),
        GM_TEST(few_teeth_without_shift_are_undercut),
        GM_TEST(thin_and_pointed_tips_are_warned_of),
        GM_TEST(the_least_tip_land_is_a_fifth_of_a_module),
        GM_TEST(the_hunting_period_is_the_least_that_both_gears_divide),
        GM_TEST(a_start_below_the_root_form_is_warned_of),
        GM_TEST(the_rack_that_is_given_cuts_the_root),
        GM_TEST(the_assumed_rack_suits_the_mates_tip),
        GM_TEST(small_tip_clearances_are_warned_of),
        GM_TEST(a_tip_alteration_beside_a_tip_is_not_used),
        GM_TEST(a_little_negative_backlash_is_that_of_rounded_shifts),
        GM_TEST(short_paths_are_warned_of),
    };
    return gm_test_main("unit.pair", tests, GM_TEST_COUNT(tests), argc, argv);
}
