/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Compliance of a tooth: check values, the shape of its profile, its slope, and what is refused. */
#include "gm_test.h"
#include "tooth_compliance.h"

static const double degree = 0.017453292519943295;

static gmi_tooth_params params_of(double teeth, double module_mm, double angle_deg, double shift) {
    const double m_n = 1e-3 * module_mm, alpha_n = angle_deg * degree;
    const gmi_tooth_params params = {
        teeth, m_n,  alpha_n, shift, m_n * (1.5707963267948966 + 2.0 * shift * tan(alpha_n)),
        1.25,  0.38, 206e9,   0.3};
    return params;
}

/* Check values of the specification: rho mm, alpha' rad, y_p mm, t mm, c_tooth, c_found in 1e-12 m per N/m. */
typedef struct check_row {
    double rho, alpha, y, t, bending, foundation;
} check_row;

static void check_tooth(const gmi_tooth_params *params, double cosine, double foot_x, double foot_y,
                        const check_row *rows, int count) {
    gmi_tooth tooth;
    gmi_tooth_load load;
    GM_ASSERT_INT(gmi_tooth_init(&tooth, params), GMI_TOOTH_FINE);
    GM_ASSERT_REL(0.5e3 * tooth.foot_chord, foot_x, 1e-9);
    GM_ASSERT_REL(1e3 * tooth.foot_y, foot_y, 1e-9);
    for (int k = 0; k < count; ++k) {
        GM_ASSERT_INT(gmi_tooth_load_at(&tooth, 1e-3 * rows[k].rho / cosine, &load),
                      GMI_TOOTH_FINE);
        GM_ASSERT_ABS(load.angle, rows[k].alpha, 1e-9);
        GM_ASSERT_REL(1e3 * load.y, rows[k].y, 1e-9);
        GM_ASSERT_REL(1e3 * load.depth, rows[k].t, 1e-8);
        GM_ASSERT_ABS(1e12 * load.bending, rows[k].bending, 2e-7); /* digits and rho as printed */
        GM_ASSERT_ABS(1e12 * load.foundation, rows[k].foundation, 1e-7);
    }
}

static void check_values_of_a_spur_gear(void) {
    static const check_row rows[] = {
        {15.92158348, 0.233040760, 59.87956683, 2.093166927, 0.0548692, 6.5127282},
        {21.20524889, 0.323730426, 61.45310246, 1.656684169, 6.6365448, 10.8650009},
        {26.48891429, 0.414420092, 63.64881605, 0.860134277, 32.5202305, 25.2601538}};
    const gmi_tooth_params params = params_of(62.0, 2.0, 20.0, 0.0);
    check_tooth(&params, 1.0, 2.203336328, 59.86301146, rows, 3);
}

/* z / (cos^2 beta_b cos beta) and cos beta_b of a helical gear. */
static double virtual_teeth(double teeth, double angle_deg, double helix_deg, double *cosine) {
    const double beta = helix_deg * degree;
    const double alpha_t = atan(tan(angle_deg * degree) / cos(beta));
    *cosine = cos(atan(tan(beta) * cos(alpha_t)));
    return teeth / (*cosine * *cosine * cos(beta));
}

static void check_values_of_helical_gears(void) {
    static const check_row paper[] = {
        {10.60595781, 0.182652919, 59.61038429, 1.620726579, 0.8294389, 6.9300195},
        {14.95639959, 0.269760633, 60.81829313, 1.346325405, 7.8122874, 12.1156152},
        {19.30684137, 0.356868347, 62.56037134, 0.805652660, 35.0843244, 28.3945483}};
    static const check_row wheel[] = {
        {231.2859465, 0.323942069, 687.6597241, 15.54173109, -0.1254038, 6.2261610},
        {261.9237861, 0.371578796, 699.6399073, 11.45193440, 6.5133882, 10.4804781}};
    static const check_row pinion[] = {
        {72.50269157, 0.354621726, 175.6159954, 12.50751229, 5.1435906, 9.6211757}};
    double cosine;
    gmi_tooth_params params =
        params_of(virtual_teeth(45.0, 16.0, 33.0, &cosine), 1.65, 16.0, 0.1242);
    GM_ASSERT_REL(params.virtual_teeth, 73.916468, 1e-8);
    check_tooth(&params, cosine, 1.733361245, 59.42164036, paper, 3);
    params = params_of(virtual_teeth(95.0, 20.0, 10.0, &cosine), 14.0, 20.0, 0.6691);
    GM_ASSERT_REL(params.virtual_teeth, 99.104317, 1e-8);
    check_tooth(&params, cosine, 16.37650374, 687.9534404, wheel, 2);
    params = params_of(virtual_teeth(24.0, 20.0, 10.0, &cosine), 14.0, 20.0, 0.48);
    check_tooth(&params, cosine, 15.58798808, 166.0667977, pinion, 1);
}

/* Against a sum of thin slices of the profile, found by another way: the rack's rounding as an envelope of circles. */
static double slice_half_thickness(const gmi_tooth *tooth, double y) {
    /* Involute: radius and half angle of the point at height y, by bisection over the roll length. */
    double low = tooth->fillet_roll_length, high = 3.0 * tooth->reference_radius;
    double x = 0.0, at = 0.0;
    for (int k = 0; k < 100; ++k) {
        const double r = 0.5 * (low + high), tangent = r / tooth->base_radius;
        const double radius = hypot(r, tooth->base_radius);
        const double angle = tooth->base_half_thickness - tangent + atan(tangent);
        x = radius * sin(angle);
        at = radius * cos(angle);
        if (at < y) {
            low = r;
        } else {
            high = r;
        }
    }
    if (fabs(at - y) < 1e-9 * y) {
        return x;
    }

    /* Fillet: the largest space that any position of the rounding's centre leaves, seen across the tooth. */
    double smallest = 1.0;
    for (int k = 0; k <= 20000; ++k) {
        const double a = -0.5 + 1.0 * k / 20000.0; /* the rack has rolled by this angle */
        const double u = tooth->rounding_offset + a * tooth->reference_radius;
        const double v = tooth->reference_radius + tooth->rounding_center;
        const double turn = a + tooth->half_pitch_angle;
        const double c_x = u * cos(turn) - v * sin(turn), c_y = u * sin(turn) + v * cos(turn);
        const double height = y - c_y;
        if (fabs(height) < tooth->rounding_radius) {
            const double reach =
                sqrt(tooth->rounding_radius * tooth->rounding_radius - height * height);
            smallest = fmin(smallest, -c_x - reach);
        }
    }
    return smallest;
}

static void bending_is_that_of_thin_slices(void) {
    const double teeth[] = {20.0, 33.7, 62.0};
    const double shifts[] = {0.1, 0.3, 0.0};
    for (int g = 0; g < 3; ++g) {
        enum { SLICES = 400 };
        const gmi_tooth_params params = params_of(teeth[g], 3.0, 20.0, shifts[g]);
        gmi_tooth tooth;
        gmi_tooth_load load;
        GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FINE);
        const double roll = tooth.base_radius * (tan(20.0 * degree) + 0.06);
        GM_ASSERT_INT(gmi_tooth_load_at(&tooth, roll, &load), GMI_TOOTH_FINE);
        const double slice = (load.y - tooth.foot_y) / SLICES;
        double bending = 0.0, shear = 0.0;
        for (int k = 0; k < SLICES; ++k) {
            const double y = tooth.foot_y + slice * (k + 0.5);
            const double chord = 2.0 * slice_half_thickness(&tooth, y), arm = load.y - y;
            bending += slice * arm * arm / (chord * chord * chord);
            shear += slice / chord;
        }
        const double tangent = tan(load.angle), nu = 0.3;
        const double k = (1.0 - nu * nu) / 206e9 / (1.0 + tangent * tangent);
        const double expected =
            k * (12.0 * bending + (2.4 / (1.0 - nu) + tangent * tangent) * shear);
        gm_test_context("%g teeth", teeth[g]);
        GM_ASSERT_REL(load.bending, expected, 1e-4);
    }
}

/* The slope against differences, along the whole flank: also where y_p passes from the fillet to the involute and the foot. */
static void slope_is_that_of_differences(void) {
    const double teeth[] = {20.0, 62.0, 99.1, 400.0};
    for (int g = 0; g < 4; ++g) {
        const gmi_tooth_params params = params_of(teeth[g], 3.0, 20.0, 0.2);
        gmi_tooth tooth;
        GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FINE);
        const double tip = tooth.reference_radius + 1.2 * params.normal_module;
        const double end = sqrt(tip * tip - tooth.base_radius * tooth.base_radius);
        for (int k = 0; k <= 50; ++k) {
            const double roll =
                tooth.fillet_roll_length + (end - tooth.fillet_roll_length) * k / 50.0;
            const double step = 1e-5 * params.normal_module;
            gmi_tooth_load at, above, below;
            gm_test_context("%g teeth, point %d", teeth[g], k);
            GM_ASSERT_INT(gmi_tooth_load_at(&tooth, roll, &at), GMI_TOOTH_FINE);
            GM_ASSERT_INT(gmi_tooth_load_at(&tooth, roll + step, &above), GMI_TOOTH_FINE);
            GM_ASSERT_INT(gmi_tooth_load_at(&tooth, roll - step, &below), GMI_TOOTH_FINE);
            const double difference =
                (above.bending + above.foundation - below.bending - below.foundation) /
                (2.0 * step);
            GM_ASSERT_NEAR(at.slope, difference, 1e-6, 1e-4 * (at.bending + at.foundation));
            GM_ASSERT(at.bending + at.foundation > 0.0 && at.depth > 0.0);
        }
    }
}

/* Compliance is a pure number over E: it does not know the size of the gear. */
static void compliance_has_no_scale(void) {
    gmi_tooth_params small = params_of(25.0, 1.0, 20.0, 0.1),
                     large = params_of(25.0, 20.0, 20.0, 0.1);
    large.youngs_modulus = 2.0 * small.youngs_modulus;
    gmi_tooth first, second;
    gmi_tooth_load of_first, of_second;
    GM_ASSERT_INT(gmi_tooth_init(&first, &small), GMI_TOOTH_FINE);
    GM_ASSERT_INT(gmi_tooth_init(&second, &large), GMI_TOOTH_FINE);
    GM_ASSERT_INT(gmi_tooth_load_at(&first, 5e-3, &of_first), GMI_TOOTH_FINE);
    GM_ASSERT_INT(gmi_tooth_load_at(&second, 100e-3, &of_second), GMI_TOOTH_FINE);
    GM_ASSERT_REL(2.0 * of_second.bending, of_first.bending, 1e-12);
    GM_ASSERT_REL(2.0 * of_second.foundation, of_first.foundation, 1e-12);
}

/* A thinner tooth is softer. */
static void backlash_makes_a_tooth_softer(void) {
    gmi_tooth_params params = params_of(40.0, 3.0, 20.0, 0.0);
    gmi_tooth tooth;
    gmi_tooth_load nominal, thinner;
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FINE);
    GM_ASSERT_INT(gmi_tooth_load_at(&tooth, 22e-3, &nominal), GMI_TOOTH_FINE);
    params.normal_thickness -= 0.1e-3;
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FINE);
    GM_ASSERT_INT(gmi_tooth_load_at(&tooth, 22e-3, &thinner), GMI_TOOTH_FINE);
    GM_ASSERT(thinner.bending > 1.01 * nominal.bending);
    GM_ASSERT(thinner.foundation > nominal.foundation);
}

static void teeth_without_compliance_are_refused(void) {
    gmi_tooth tooth;
    gmi_tooth_load load;
    gmi_tooth_params params = params_of(30.0, 2.0, 20.0, 0.0);
    params.rack_fillet_radius = 0.6; /* two of them do not fit beside each other */
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FILLET);
    params = params_of(12.0, 2.0, 20.0, 0.0);
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_UNDERCUT);
    params = params_of(30.0, 2.0, 20.0, 1.2); /* the rounding works above the pitch line */
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FOOT);
    params = params_of(2000.0, 2.0, 32.0, 0.0);
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FILLET);
    params.rack_fillet_radius = 0.1;
    params.rack_dedendum = 1.0;
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FOOT);
    params = params_of(30.0, 2.0, 20.0, 0.0);
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FINE);
    GM_ASSERT_INT(gmi_tooth_load_at(&tooth, 40e-3, &load), GMI_TOOTH_POINTED);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {GM_TEST(check_values_of_a_spur_gear),
                                    GM_TEST(check_values_of_helical_gears),
                                    GM_TEST(bending_is_that_of_thin_slices),
                                    GM_TEST(slope_is_that_of_differences),
                                    GM_TEST(compliance_has_no_scale),
                                    GM_TEST(backlash_makes_a_tooth_softer),
                                    GM_TEST(teeth_without_compliance_are_refused)};
    return gm_test_main("unit.tooth_compliance", tests, GM_TEST_COUNT(tests), argc, argv);
}
