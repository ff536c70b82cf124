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

/* The circle that touches the root circle of a ring from within, and its flank: moved along until no point is closer. */
typedef struct ring_circle {
    double x, y;
} ring_circle;

static ring_circle circle_in_ring(const gmi_tooth *tooth, const gmi_tooth_params *params) {
    const double round = params->rack_fillet_radius * params->normal_module;
    const double depth = params->normal_module * (params->rack_dedendum - params->profile_shift);
    const double radius = 0.5 * params->normal_module * fabs(params->virtual_teeth) + depth - round;
    const double base = fabs(tooth->base_radius);
    ring_circle circle = {0.0, 0.0};
    double low = 0.0, high = fabs(tooth->half_pitch_angle);
    for (int step = 0; step < 50; ++step) {
        const double angle = 0.5 * (low + high);
        circle.x = radius * sin(angle);
        circle.y = -radius * cos(angle);
        double nearest = 1.0;
        for (int k = 0; k <= 2000; ++k) {
            const double r = base * (0.3 + 0.4 * k / 2000.0), half = 0.5 * params->normal_thickness;
            const double at_base =
                half / (radius + round - depth) - tan(20.0 * degree) + 20.0 * degree;
            const double polar = at_base + r / base - atan(r / base), away = hypot(base, r);
            nearest =
                fmin(nearest, hypot(away * sin(polar) - circle.x, -away * cos(polar) - circle.y));
        }
        if (nearest < round) {
            low = angle;
        } else {
            high = angle;
        }
    }
    return circle;
}

/* Against a sum of thin slices of the profile, found by another way: the rack's rounding as an envelope of circles. */
static double slice_half_thickness(const gmi_tooth *tooth, const ring_circle *circle, double y) {
    /* Involute: radius and half angle of the point at height y, by bisection over the roll length. */
    const int is_ring = tooth->base_radius < 0.0;
    double low = tooth->fillet_roll_length, high = is_ring ? 0.0 : 3.0 * tooth->reference_radius;
    double x = 0.0, at = 0.0;
    for (int k = 0; k < 100; ++k) {
        const double r = 0.5 * (low + high), tangent = r / tooth->base_radius;
        const double radius = copysign(hypot(r, tooth->base_radius), tooth->base_radius);
        const double angle = tooth->base_half_thickness - tangent + atan(tangent);
        x = radius * sin(angle);
        at = radius * cos(angle);
        if (at < y) {
            low = r;
        } else {
            high = r;
        }
    }
    if (fabs(at - y) < 1e-9 * fabs(y)) {
        return x;
    }

    if (is_ring) {
        const double height = y - circle->y;
        return circle->x - sqrt(tooth->rounding_radius * tooth->rounding_radius - height * height);
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
    const double teeth[] = {20.0, 33.7, 62.0, -93.3, -61.0};
    const double shifts[] = {0.1, 0.3, 0.0, 0.1, -0.2};
    for (int g = 0; g < 5; ++g) {
        enum { SLICES = 400 };
        const gmi_tooth_params params = params_of(teeth[g], 3.0, 20.0, shifts[g]);
        gmi_tooth tooth;
        gmi_tooth_load load;
        GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FINE);
        const ring_circle circle = circle_in_ring(&tooth, &params);
        const double toward_tip = teeth[g] > 0.0 ? 0.06 : -0.03;
        const double roll = tooth.base_radius * (tan(20.0 * degree) + toward_tip);
        GM_ASSERT_INT(gmi_tooth_load_at(&tooth, roll, &load), GMI_TOOTH_FINE);
        const double slice = (load.y - tooth.foot_y) / SLICES;
        double bending = 0.0, shear = 0.0;
        for (int k = 0; k < SLICES; ++k) {
            const double y = tooth.foot_y + slice * (k + 0.5);
            const double chord = 2.0 * slice_half_thickness(&tooth, &circle, y), arm = load.y - y;
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

/*
 * A load leans by rho / r_b - psi: near the base circle, where gears close to undercut have their flanks too, the other way.
 * The compliance depends on the square of its tangent alone, so loads that lean alike have the same, with opposite slopes.
 */
static void loads_that_lean_either_way_are_alike(void) {
    static const double teeth[] = {18.0, 20.0, 24.0}, shift[] = {0.0, 0.0, 0.16};
    static const double angle_deg[] = {20.0, 20.0, 16.0};
    for (int g = 0; g < 3; ++g) {
        const gmi_tooth_params params = params_of(teeth[g], 3.0, angle_deg[g], shift[g]);
        gmi_tooth tooth;
        GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FINE);
        const double straight = tooth.base_radius * tooth.base_half_thickness;
        int checked = 0;
        for (int k = 1; k <= 20; ++k) {
            const double way = 0.05 * k * straight;
            if (straight - way < tooth.fillet_roll_length) {
                break;
            }
            gmi_tooth_load up, down;
            gm_test_context("%g teeth, %d", teeth[g], k);
            GM_ASSERT_INT(gmi_tooth_load_at(&tooth, straight + way, &up), GMI_TOOTH_FINE);
            GM_ASSERT_INT(gmi_tooth_load_at(&tooth, straight - way, &down), GMI_TOOTH_FINE);
            GM_ASSERT_ABS(down.angle, -up.angle, 1e-12);
            GM_ASSERT_REL(down.bending, up.bending, 1e-10);
            GM_ASSERT_REL(down.foundation, up.foundation, 1e-10);
            GM_ASSERT_REL(down.slope, -up.slope, 1e-9);
            ++checked;
        }
        GM_ASSERT(checked >= 5);
    }
}

/* The slope against differences, along the whole flank: also where y_p passes from the fillet to the involute and the foot. */
static void slope_is_that_of_differences(void) {
    const double teeth[] = {20.0, 62.0, 99.1, 400.0, -400.0, -93.3, -41.0};
    for (int g = 0; g < 7; ++g) {
        const gmi_tooth_params params = params_of(teeth[g], 3.0, 20.0, teeth[g] > 0.0 ? 0.2 : -0.1);
        gmi_tooth tooth;
        GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FINE);
        const double tip = tooth.reference_radius + 1.2 * params.normal_module;
        const double squared = tip * tip - tooth.base_radius * tooth.base_radius;
        const double end = copysign(sqrt(fmax(squared, 0.0)), teeth[g]);
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

/*
 * Teeth of very large gears and rings are those of their rack: straight flanks, a circle as fillet, the foot under 30 and 60
 * degrees. The frame: height over the reference line, half thickness.
 */
static double rack_half_thickness(double m_n, double alpha, double height) {
    const double round = 0.38 * m_n, center = -(1.25 - 0.38) * m_n;
    const double joint = center - round * sin(alpha);
    const double at_joint = 0.25 * 3.14159265358979 * m_n - joint * tan(alpha);
    const double below = height - center;
    return height > joint ? 0.25 * 3.14159265358979 * m_n - height * tan(alpha)
                          : at_joint + round * cos(alpha) - sqrt(round * round - below * below);
}

static void rack_is_the_limit_of_gears_and_rings(void) {
    enum { SLICES = 4000 };
    const double m_n = 3e-3, alpha = 20.0 * degree, nu = 0.3;
    for (int g = 0; g < 2; ++g) {
        const double teeth = g == 0 ? 1e6 : -1e6;
        const gmi_tooth_params params = params_of(teeth, 3.0, 20.0, 0.0);
        gmi_tooth tooth;
        gmi_tooth_load load;
        gm_test_context("%g teeth", teeth);
        GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FINE);
        const double foot_angle = (g == 0 ? 30.0 : 60.0) * degree;
        const double foot = -(1.25 - 0.38) * m_n - 0.38 * m_n * sin(foot_angle);
        const double chord = 2.0 * rack_half_thickness(m_n, alpha, foot);
        GM_ASSERT_REL(tooth.foot_chord, chord, 1e-5);
        for (int place = -2; place <= 4; ++place) {
            /* The normal of the flank at this height meets the centre line. */
            const double height = 0.2 * place * m_n;
            const double top = height - rack_half_thickness(m_n, alpha, height) * tan(alpha);
            const double slice = (top - foot) / SLICES;
            double bending = 0.0, shear = 0.0;
            for (int k = 0; k < SLICES; ++k) {
                const double y = foot + slice * (k + 0.5);
                const double whole = 2.0 * rack_half_thickness(m_n, alpha, y);
                bending += slice * (top - y) * (top - y) / (whole * whole * whole);
                shear += slice / whole;
            }
            const double square = tan(alpha) * tan(alpha), arm = (top - foot) / chord;
            const double pi = 3.14159265358979;
            const double k = (1.0 - nu * nu) / 206e9 / (1.0 + square);
            const double in_tooth = 12.0 * bending + (2.4 / (1.0 - nu) + square) * shear;
            const double in_foundation = 18.0 / pi * arm * arm +
                                         2.0 * (1.0 - 2.0 * nu) / (1.0 - nu) * arm +
                                         4.8 / pi * (1.0 + (1.0 - nu) / 2.4 * square);

            const double roll = tooth.reference_radius * sin(alpha) + height / sin(alpha);
            GM_ASSERT_INT(gmi_tooth_load_at(&tooth, roll, &load), GMI_TOOTH_FINE);
            GM_ASSERT_REL(load.bending + load.foundation, k * (in_tooth + in_foundation), 2e-5);
            GM_ASSERT_REL(load.depth, rack_half_thickness(m_n, alpha, height) / cos(alpha), 1e-5);
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
    params = params_of(
        -80.0, 2.0, 20.0,
        -0.2); /* no room for the rounding in a space, or it has no end below 60 degrees */
    params.rack_fillet_radius = 0.6;
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_SPACE);
    params = params_of(-10.0, 2.0, 44.0, 0.0);
    params.rack_fillet_radius = 0.01;
    params.normal_thickness = 0.5e-3;
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FOOT);
    params = params_of(30.0, 2.0, 20.0, 0.0);
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FINE);
    GM_ASSERT_INT(gmi_tooth_load_at(&tooth, 40e-3, &load), GMI_TOOTH_POINTED);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {GM_TEST(check_values_of_a_spur_gear),
                                    GM_TEST(check_values_of_helical_gears),
                                    GM_TEST(bending_is_that_of_thin_slices),
                                    GM_TEST(loads_that_lean_either_way_are_alike),
                                    GM_TEST(slope_is_that_of_differences),
                                    GM_TEST(rack_is_the_limit_of_gears_and_rings),
                                    GM_TEST(compliance_has_no_scale),
                                    GM_TEST(backlash_makes_a_tooth_softer),
                                    GM_TEST(teeth_without_compliance_are_refused)};
    return gm_test_main("unit.tooth_compliance", tests, GM_TEST_COUNT(tests), argc, argv);
}
