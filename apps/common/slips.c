/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "slips.h"
#include "modification_keys.h"

#include <math.h>
#include <stddef.h>

static const double pi = 3.14159265358979323846;

/* What gears are like, in mm, as far as the drawing can be made sense of: slips found so far are put right. */
typedef struct usual_gear {
    double module;    /* normal */
    double cos_helix; /* of the reference helix */
    double face_width;
    double diameter[2]; /* reference, pinion and wheel */
} usual_gear;

static int is_within(double value, double low, double high) {
    return value >= low && value <= high;
}

static int is_given(const config *conf, const char *key) {
    return config_text(conf, key) != NULL;
}

/* The number is as it was written. `why` says what is odd about it. */
static void tell(const config *conf, const char *key, const char *unit, const char *why,
                 const char *meant, double right) {
    config_warn(conf, key, "is %.40s%s, %s; was it meant %s? write %.6g", config_text(conf, key),
                unit, why, meant, right);
}

/* ---------------------------------------------------------------------------------------------
 * Another unit
 * ------------------------------------------------------------------------------------------- */

/* A unit that a value may have been written in: its size in the unit of the key. */
typedef struct other_unit {
    const char *meant;
    double size;
} other_unit;

static const other_unit lengths[] = {
    {"in metres", 1e3}, {"in inches", 25.4}, {"in micrometres", 1e-3}, {NULL, 0}};

/* The first unit that makes a value usual, NULL = none. */
static const other_unit *unit_for(const other_unit *units, double value, double low, double high) {
    for (; units->meant != NULL; ++units) {
        if (is_within(value * units->size, low, high)) {
            return units;
        }
    }
    return NULL;
}

/*
 * Tells a value that is outside of what is `possible` (low, high) and would be usual in another unit. `scale` is what
 * values are compared with, such as the module. Returns the value that is probably meant.
 */
static double judge(const config *conf, const char *key, double value, const char *unit,
                    double scale, const double possible[2], const double usual[2],
                    const other_unit *units, const char *why) {
    const double share = value / scale;

    if (isnan(share) || is_within(share, possible[0], possible[1]) || !is_given(conf, key)) {
        return value;
    }
    const other_unit *other = unit_for(units, share, usual[0], usual[1]);
    if (other == NULL) {
        return value;
    }
    tell(conf, key, unit, why, other->meant, value * other->size);
    return value * other->size;
}

/* ---------------------------------------------------------------------------------------------
 * Angles
 * ------------------------------------------------------------------------------------------- */

static double judge_pressure_angle(const config *conf) {
    static const double possible[] = {5, 45}, usual[] = {8, 40};
    static const other_unit radians[] = {{"in radians", 180 / 3.14159265358979323846}, {NULL, 0}};
    const double degrees = conf->gears.normal_pressure_angle * 180 / pi;

    return judge(conf, "gears.normal_pressure_angle_deg", degrees, " deg", 1, possible, usual,
                 radians, "smaller than that of any tooth");
}

/* Helix angles begin at some degrees: less has no overlap to speak of. */
static double judge_helix_angle(const config *conf) {
    static const double possible[] = {1.06, 60}, usual[] = {2.5, 60};
    static const other_unit radians[] = {{"in radians", 180 / 3.14159265358979323846}, {NULL, 0}};
    const double degrees = conf->gears.helix_angle * 180 / pi;

    if (degrees == 0) {
        return degrees;
    }
    /* The sign is the hand. */
    return judge(conf, "gears.helix_angle_deg", degrees, " deg", degrees > 0 ? 1 : -1, possible,
                 usual, radians, "less than helical gears have");
}

/* ---------------------------------------------------------------------------------------------
 * Module and centre distance
 * ------------------------------------------------------------------------------------------- */

/* Of a ring below 0, as centre distances of its pair are then. */
static double tooth_sum(const config *conf) {
    return conf->gears.pinion_teeth + conf->gears.wheel_teeth;
}

/* +1, -1 with a ring: its axes are too close where external ones are too far apart. */
static double sign_of_pair(const config *conf) {
    return conf->gears.wheel_teeth < 0 ? -1 : 1;
}

/*
 * Sum of the profile shifts that gives no backlash at a centre distance (mm), with a ring its opposite; NaN: the gears do
 * not reach or overlap.
 */
static double shift_sum(const config *conf, double module, double pressure_angle, double cos_helix,
                        double center_distance) {
    const double teeth = fabs(tooth_sum(conf));
    const double tan_normal = tan(pressure_angle * pi / 180);
    const double transverse = atan(tan_normal / cos_helix);
    const double reference = module * teeth / (2 * cos_helix);
    const double working = acos(reference * cos(transverse) / center_distance);

    return teeth * ((tan(working) - working) - (tan(transverse) - transverse)) / (2 * tan_normal);
}

/* The same of the shifts that are given; NaN where one of them is not. */
static double given_shift_sum(const config *conf) {
    return sign_of_pair(conf) *
           (conf->gears.pinion_profile_shift + conf->gears.wheel_profile_shift);
}

/*
 * Does a module fit the centre distance? Sums of profile shifts beyond these are not made; where both shifts are
 * given, the sum is known but for the backlash.
 */
static int fits(const config *conf, double sum) {
    const double given = given_shift_sum(conf);
    const int is_ring = conf->gears.wheel_teeth < 0;

    return isnan(given) ? is_within(sum, is_ring ? -1.5 : -0.6, is_ring ? 1.5 : 3)
                        : fabs(sum - given) <= 0.15;
}

/* A transverse module in place of the normal one is too large by 1 / cos(beta), and the shifts become negative. */
static int is_transverse_module(const config *conf, double as_given, double as_transverse) {
    const double given = given_shift_sum(conf);

    if (!isnan(given)) {
        return !fits(conf, as_given) && fabs(as_transverse - given) <= 0.03;
    }
    /* Gears without profile shift give themselves away sooner. */
    return (!fits(conf, as_given) && is_within(as_transverse, -0.3, 1.6)) ||
           (!(as_given >= -0.25) && fabs(as_transverse) <= 0.02);
}

/* Module that is probably meant, where it does not fit the centre distance. */
static double judge_against_distance(const config *conf, double module, double distance,
                                     double pressure_angle, double cos_helix) {
    static const char key[] = "gears.normal_module_mm";
    static const char why[] = "which does not fit the centre distance";
    const double sum = shift_sum(conf, module, pressure_angle, cos_helix, distance);

    const double transverse = module * cos_helix;
    const double transverse_sum = shift_sum(conf, transverse, pressure_angle, cos_helix, distance);
    if (cos_helix < 0.995 && is_transverse_module(conf, sum, transverse_sum)) {
        tell(conf, key, " mm", why, "as the transverse module", transverse);
        return transverse;
    }

    /* Teeth per inch of the reference diameter, in the normal section. */
    const double of_pitch = 25.4 / module;
    const double of_pitch_sum = shift_sum(conf, of_pitch, pressure_angle, cos_helix, distance);
    if (!fits(conf, sum) && fits(conf, of_pitch_sum)) {
        tell(conf, key, " mm", why, "as the diametral pitch", of_pitch);
        return of_pitch;
    }
    return module;
}

/* A drawing in inches: the diametral pitch P in place of the module, and a = sum(z) / (2 P cos(beta)) in inches. */
static int is_inch_drawing(const config *conf, double cos_helix) {
    const double teeth = fabs(tooth_sum(conf));
    const double pitch = 1e3 * conf->gears.normal_module;
    const double inches = 1e3 * conf->gears.center_distance;

    return is_within(inches * 2 * pitch * cos_helix / teeth, 0.9, 1.1);
}

static double judge_inch_drawing(const config *conf) {
    static const char why[] = "which does not fit the other";
    const double module = 25.4 / (1e3 * conf->gears.normal_module);

    tell(conf, "gears.normal_module_mm", " mm", why, "as the diametral pitch", module);
    tell(conf, "gears.center_distance_mm", " mm", why, "in inches",
         25.4e3 * conf->gears.center_distance);
    return module;
}

/* ---------------------------------------------------------------------------------------------
 * Lengths of the drawing
 * ------------------------------------------------------------------------------------------- */

/* Diameters in terms of the reference diameter. Half of one is a radius. */
static void judge_diameter(const config *conf, const char *key, double radius, double reference) {
    static const double possible[] = {0.75, 2}, usual[] = {0.85, 1.8};
    static const other_unit units[] = {{"as the radius", 2},
                                       {"in metres", 1e3},
                                       {"in inches", 25.4},
                                       {"in micrometres", 1e-3},
                                       {NULL, 0}};

    (void)judge(conf, key, 2e3 * radius, " mm", reference, possible, usual, units,
                "far from the reference diameter");
}

/* Coefficients are below 2, but for shifts in mm. */
static void judge_shift(const config *conf, const char *key, double shift, double module) {
    static const double possible[] = {-2, 2}, usual[] = {-1.2, 1.6};
    const other_unit units[] = {{"in mm, not in modules", 1 / module}, {NULL, 0}};

    (void)judge(conf, key, shift, "", 1, possible, usual, units, "more than teeth allow");
}

/* The basic rack and the tip alteration are in modules: a drawing has them in mm as well. */
static void judge_in_modules(const config *conf, const char *key, double value, double module,
                             const double possible[2], const double usual[2]) {
    const other_unit units[] = {{"in mm, not in modules", 1 / module}, {NULL, 0}};

    (void)judge(conf, key, value, "", 1, possible, usual, units, "far from that of any tool");
}

static void judge_racks(const config *conf, double module) {
    static const double addendum[] = {0.3, 1.8}, usual_addendum[] = {0.7, 1.4};
    static const double dedendum[] = {0.5, 2.2}, usual_dedendum[] = {0.9, 1.8};
    static const double fillet[] = {0, 0.6}, usual_fillet[] = {0.1, 0.5};
    static const double alteration[] = {-1, 1}, usual_alteration[] = {-0.8, 0.5};
    const gm_pair_params *gears = &conf->gears;

    judge_in_modules(conf, "gears.pinion_rack_addendum", gears->pinion_rack_addendum, module,
                     addendum, usual_addendum);
    judge_in_modules(conf, "gears.wheel_rack_addendum", gears->wheel_rack_addendum, module,
                     addendum, usual_addendum);
    judge_in_modules(conf, "gears.pinion_rack_dedendum", gears->pinion_rack_dedendum, module,
                     dedendum, usual_dedendum);
    judge_in_modules(conf, "gears.wheel_rack_dedendum", gears->wheel_rack_dedendum, module,
                     dedendum, usual_dedendum);

    judge_in_modules(conf, "gears.pinion_rack_fillet_radius", gears->pinion_rack_fillet_radius,
                     module, fillet, usual_fillet);
    judge_in_modules(conf, "gears.wheel_rack_fillet_radius", gears->wheel_rack_fillet_radius,
                     module, fillet, usual_fillet);
    judge_in_modules(conf, "gears.pinion_tip_alteration", gears->pinion_tip_alteration, module,
                     alteration, usual_alteration);
    judge_in_modules(conf, "gears.wheel_tip_alteration", gears->wheel_tip_alteration, module,
                     alteration, usual_alteration);
}

/* The common face width, or the smaller of both; NaN = none is given (mm). */
static double judge_face_widths(const config *conf, double module) {
    static const double possible[] = {0.2, 300}, usual[] = {1, 100};
    static const char why[] = "out of proportion to the module";
    const gm_pair_params *gears = &conf->gears;

    const double common = judge(conf, "gears.face_width_mm", 1e3 * gears->face_width, " mm", module,
                                possible, usual, lengths, why);
    const double pinion = judge(conf, "gears.pinion_face_width_mm", 1e3 * gears->pinion_face_width,
                                " mm", module, possible, usual, lengths, why);
    const double wheel = judge(conf, "gears.wheel_face_width_mm", 1e3 * gears->wheel_face_width,
                               " mm", module, possible, usual, lengths, why);
    return fmin(common, fmin(pinion, wheel));
}

/* Lengths that may be 0, below 0 or missing, in terms of another one. */
static void judge_share(const config *conf, const char *key, double length, double scale) {
    static const double possible[] = {2e-3, HUGE_VAL}, usual[] = {0.01, 3};

    if (length != 0) {
        (void)judge(conf, key, 1e3 * length, " mm", length < 0 ? -scale : scale, possible, usual,
                    lengths, "next to nothing of the face width");
    }
}

/* In terms of the reference diameter. */
static void judge_bore(const config *conf, const char *key, double radius, double reference) {
    static const double possible[] = {0.01, 2}, usual[] = {0.05, 1.5};

    (void)judge(conf, key, 2e3 * radius, " mm", reference, possible, usual, lengths,
                "out of proportion to the reference diameter");
}

/* In terms of the module. Narrower backlash presses, wider is none. */
static void judge_backlash(const config *conf, double module) {
    static const double possible[] = {0.003, HUGE_VAL}, usual[] = {0.003, 0.3};
    static const other_unit units[] = {{"in mm", 1e3}, {"in metres", 1e6}, {NULL, 0}};

    if (conf->gears.backlash > 0) {
        (void)judge(conf, "gears.backlash_um", 1e6 * conf->gears.backlash, " um", 1e3 * module,
                    possible, usual, units, "next to none for this module");
    }
}

/*
 * The module by itself, and against the centre distance; the one or the other may be at fault. Returned is the module that
 * is probably meant.
 */
static double judge_module(const config *conf, double pressure_angle, double cos_helix) {
    static const double module_possible[] = {0.05, 120}, module_usual[] = {0.1, 100};
    static const double possible[] = {0.5, 2}, usual[] = {0.8, 1.25};
    static const other_unit metric[] = {{"in metres", 1e3}, {"in micrometres", 1e-3}, {NULL, 0}};
    const double teeth = fabs(tooth_sum(conf));
    const double distance = 1e3 * conf->gears.center_distance;
    const double module =
        judge(conf, "gears.normal_module_mm", 1e3 * conf->gears.normal_module, " mm", 1,
              module_possible, module_usual, metric, "which no gear has");

    /* In terms of the pitch circles. */
    const double reference = module * teeth / (2 * cos_helix);
    const double share = distance / reference;
    if (is_within(share, possible[0], possible[1])) {
        return judge_against_distance(conf, module, distance, pressure_angle, cos_helix);
    }
    if (is_inch_drawing(conf, cos_helix)) {
        return judge_inch_drawing(conf);
    }

    /* Another unit of the distance, unless a diametral pitch explains it better. */
    const other_unit *other = unit_for(lengths, share, usual[0], usual[1]);
    const double of_pitch = fabs(log(share * module * module / 25.4));
    if (other == NULL || of_pitch < fabs(log(share * other->size))) {
        return judge_against_distance(conf, module, distance, pressure_angle, cos_helix);
    }
    (void)judge(
        conf, "gears.center_distance_mm", distance, " mm", reference, possible, usual, lengths,
        conf->gears.wheel_teeth < 0 ? "far from half the difference of the reference diameters"
                                    : "far from half the sum of the reference diameters");
    return module;
}

/* The drawing; returned is what the other values are compared with. */
static usual_gear judge_drawing(const config *conf) {
    const gm_pair_params *gears = &conf->gears;
    usual_gear usual;

    /* Angles and module first, as the rest is in terms of module and reference diameters. */
    const double pressure_angle = judge_pressure_angle(conf);
    usual.cos_helix = cos(judge_helix_angle(conf) * pi / 180);
    usual.module = judge_module(conf, pressure_angle, usual.cos_helix);
    usual.diameter[0] = usual.module * gears->pinion_teeth / usual.cos_helix;
    usual.diameter[1] = usual.module * fabs((double)gears->wheel_teeth) / usual.cos_helix;

    usual.face_width = judge_face_widths(conf, usual.module);

    judge_diameter(conf, "gears.pinion_tip_diameter_mm", gears->pinion_tip_radius,
                   usual.diameter[0]);
    judge_diameter(conf, "gears.wheel_tip_diameter_mm", gears->wheel_tip_radius, usual.diameter[1]);
    judge_diameter(conf, "gears.pinion_start_diameter_mm", gears->pinion_start_radius,
                   usual.diameter[0]);
    judge_diameter(conf, "gears.wheel_start_diameter_mm", gears->wheel_start_radius,
                   usual.diameter[1]);

    judge_shift(conf, "gears.pinion_profile_shift", gears->pinion_profile_shift, usual.module);
    judge_shift(conf, "gears.wheel_profile_shift", gears->wheel_profile_shift, usual.module);
    judge_racks(conf, usual.module);
    judge_backlash(conf, usual.module);

    judge_share(conf, "gears.axial_offset_mm", gears->axial_offset, usual.face_width);
    judge_share(conf, "gears.double_helical_gap_mm", conf->double_helical_gap, usual.face_width);
    judge_bore(conf, "gears.pinion_bore_diameter_mm", conf->pinion_bore_radius, usual.diameter[0]);
    judge_bore(conf, "gears.wheel_bore_diameter_mm", conf->wheel_bore_radius, usual.diameter[1]);
    return usual;
}

/* ---------------------------------------------------------------------------------------------
 * Mesh, bodies and loads
 * ------------------------------------------------------------------------------------------- */

/*
 * In terms of the face width, N/(mm um): steel has about 14 (ISO 6336-1, c'), plastics some tenths. A number far below
 * was meant for another unit; several may fit.
 */
static void judge_stiffness(const config *conf, const char *key, double stiffness,
                            const usual_gear *usual) {
    static const double possible = 0.05, usual_range[] = {3, 40};
    const other_unit units[] = {{"in N/um", 1e6},
                                {"in N/(mm um)", 1e6 * usual->face_width},
                                {"in N/mm", 1e3},
                                {"in GN/m", 1e9},
                                {NULL, 0}};
    const double scale = 1e6 * usual->face_width;

    if (!is_given(conf, key) || stiffness / scale >= possible) {
        return;
    }
    for (const other_unit *unit = units; unit->meant != NULL; ++unit) {
        if (is_within(stiffness * unit->size / scale, usual_range[0], usual_range[1])) {
            tell(conf, key, " N/m", "much softer than any tooth", unit->meant,
                 stiffness * unit->size);
        }
    }
}

/* From plastics to hard metal; a number in psi is too close to one in GPa to be told. */
static void judge_modulus(const config *conf, const char *key, double modulus) {
    static const double possible[] = {0.05, 1300}, usual[] = {1, 700};
    static const other_unit units[] = {{"in MPa", 1e-3}, {NULL, 0}};

    (void)judge(conf, key, 1e-9 * modulus, " GPa", 1, possible, usual, units,
                "which no gear is made of");
}

static void judge_oil(const config *conf) {
    static const double possible[] = {0.5, HUGE_VAL}, usual[] = {2, 5000};
    static const other_unit units[] = {{"in Pa s", 1e3}, {NULL, 0}};

    (void)judge(conf, "mesh.oil_viscosity_mPas", 1e3 * conf->oil_viscosity, " mPa s", 1, possible,
                usual, units, "thinner than any oil");
}

static void judge_roughness(const config *conf) {
    static const double possible[] = {5e-3, 50}, usual[] = {0.05, 20};
    static const other_unit units[] = {{"in mm", 1e3}, {"in nm", 1e-3}, {NULL, 0}};

    (void)judge(conf, "mesh.roughness_Ra_um", 1e6 * conf->roughness, " um", 1, possible, usual,
                units, "far from that of flanks");
}

/* Moved axes: less than a tenth of a um changes nothing. */
static void judge_shift_of_axis(const config *conf, const char *key, double shift) {
    static const double possible[] = {0.1, HUGE_VAL}, usual[] = {1, 5000};
    static const other_unit units[] = {{"in mm", 1e3}, {"in metres", 1e6}, {NULL, 0}};

    if (shift != 0) {
        (void)judge(conf, key, 1e6 * shift, " um", shift < 0 ? -1 : 1, possible, usual, units,
                    "which moves no axis");
    }
}

/* Tilted axes, in mrad. */
static void judge_tilt(const config *conf, const char *key, double tilt) {
    static const double possible[] = {1e-3, HUGE_VAL}, usual[] = {5e-3, 20};
    static const other_unit units[] = {{"in radians", 1e3}, {NULL, 0}};

    if (tilt != 0) {
        (void)judge(conf, key, 1e3 * tilt, " mrad", tilt < 0 ? -1 : 1, possible, usual, units,
                    "which tilts no axis");
    }
}

static void judge_pose(const config *conf) {
    judge_shift_of_axis(conf, "pose.center_distance_change_um", conf->pose.center_distance_change);
    judge_shift_of_axis(conf, "pose.offset_um", conf->pose.offset);
    judge_shift_of_axis(conf, "pose.axial_shift_um", conf->pose.axial_shift);
    judge_tilt(conf, "pose.skew_mrad", conf->pose.skew);
    judge_tilt(conf, "pose.inclination_mrad", conf->pose.inclination);
}

/* In terms of a steel disc with the reference diameter and the face width; shafts and machines have more. */
static double judge_inertia(const config *conf, const char *key, double inertia,
                            const usual_gear *usual, int gear) {
    static const double steel = 7850; /* kg/m3 */
    static const double possible[] = {1e-3, 1e4}, usual_range[] = {0.2, 60};
    static const other_unit units[] = {
        {"in kg cm2", 1e-4}, {"in kg mm2", 1e-6}, {"in g mm2", 1e-9}, {NULL, 0}};
    const double disc =
        pi / 32 * steel * 1e-3 * usual->face_width * pow(1e-3 * usual->diameter[gear], 4);

    return judge(conf, key, inertia, " kg m2", disc, possible, usual_range, units,
                 "out of proportion to the gear");
}

/* Mass of the bodies against each other along the line of action, at about the reference radii (kg). */
static double mesh_mass(const config *conf, const usual_gear *usual, double pinion_inertia,
                        double wheel_inertia) {
    const double pinion_radius = 0.5e-3 * usual->diameter[0];
    const double wheel_radius = 0.5e-3 * usual->diameter[1];
    double mobility = wheel_radius * wheel_radius / wheel_inertia;

    /* A prescribed speed is an infinite inertia. */
    if (conf->drive == DRIVE_TORQUE) {
        mobility += pinion_radius * pinion_radius / pinion_inertia;
    }
    return 1 / mobility;
}

/* In terms of the critical damping of the mesh, of which it has some 0.01 to 0.2. NaN without inertia: nothing is told. */
static void judge_damping(const config *conf, double mass) {
    static const double possible[] = {1e-4, HUGE_VAL}, usual_range[] = {5e-3, 0.5};
    const double critical = 2 * sqrt(conf->stiffness * mass);
    const other_unit units[] = {{"as the damping ratio", critical}, {"in N s/mm", 1e3}, {NULL, 0}};

    if (conf->damping > 0 && critical > 0) {
        (void)judge(conf, "mesh.damping_Ns_per_m", conf->damping, " N s/m", critical, possible,
                    usual_range, units, "next to none for these bodies");
    }
}

/* In terms of the tangential force over face width and module (N/mm2): steel bears some hundred. */
static void judge_torque(const config *conf, const char *key, double torque,
                         const usual_gear *usual, int gear) {
    static const double possible[] = {0, 3000}, usual_range[] = {0.05, 500};
    static const other_unit units[] = {{"in N mm", 1e-3}, {NULL, 0}};
    const double of_one = usual->face_width * usual->module * 0.5e-3 * usual->diameter[gear];

    (void)judge(conf, key, torque, " N m", torque < 0 ? -of_one : of_one, possible, usual_range,
                units, "more than the teeth bear");
}

/* A speed with decimals that is a round one in another unit, to the digits that people write, and that gears reach:
   among the largest numbers nearly every one is close to a round one. */
static void judge_speed(const config *conf, const char *key, double speed) {
    static const double of_a_radian = 30 / 3.14159265358979323846, roundness = 100, fastest = 3e4;
    static const other_unit units[] = {
        {"in rad/s", 30 / 3.14159265358979323846}, {"in turns per second", 60}, {NULL, 0}};
    const double written = of_a_radian * speed;

    if (!is_given(conf, key) || fabs(written - floor(written + 0.5)) <= 1e-9 * fabs(written)) {
        return;
    }
    for (const other_unit *unit = units; unit->meant != NULL; ++unit) {
        const double meant = unit->size * written;
        const double round = roundness * floor(meant / roundness + 0.5);
        if (round != 0 && fabs(round) <= fastest && fabs(meant - round) <= 5e-5 * fabs(round)) {
            tell(conf, key, " rpm", "which is no round speed", unit->meant, round);
        }
    }
}

/* Drag and loads over the wheel's speed, by the torque at the fastest speed that is prescribed (none: NaN). */
static void judge_torque_over_speed(const config *conf, const char *key, double per_speed,
                                    const usual_gear *usual) {
    static const double possible[] = {0, 3000}, usual_range[] = {0.0005, 500};
    static const other_unit units[] = {{"in N mm s", 1e-3}, {NULL, 0}};
    const double ratio = usual->diameter[0] / usual->diameter[1];
    const double speed = ratio * fmax(fabs(conf->start_speed), fabs(conf->end_speed));
    const double of_one = usual->face_width * usual->module * 0.5e-3 * usual->diameter[1];

    if (conf->drive == DRIVE_SPEED && conf->drive_file == NULL) {
        (void)judge(conf, key, per_speed, " N m s", of_one / speed, possible, usual_range, units,
                    "more at that speed than the teeth bear");
    }
}

/* A noise that changes less than once in a run is none. */
static void judge_noise_interval(const config *conf) {
    static const double usual[] = {1e-7, 1e-3};
    static const other_unit units[] = {{"in us", 1e-6}, {"in ms", 1e-3}, {NULL, 0}};
    const double possible[] = {0, conf->duration};

    if (conf->noise_amplitude > 0) {
        (void)judge(conf, "load.noise_interval_s", conf->noise_interval, " s", 1, possible, usual,
                    units, "longer than the run");
    }
}

/* Fewer rows than turns of the pinion show nothing of the mesh. */
static void judge_rate(const config *conf) {
    static const double usual[] = {1e3, 1e6};
    static const other_unit units[] = {{"in kHz", 1e3}, {"in MHz", 1e6}, {NULL, 0}};
    const double turns = fmax(fabs(conf->start_speed), fabs(conf->end_speed)) / (2 * pi);
    const double possible[] = {turns, HUGE_VAL};

    if (conf->drive == DRIVE_SPEED && conf->drive_file == NULL) {
        (void)judge(conf, "output.rate_Hz", conf->output_rate, " Hz", 1, possible, usual, units,
                    "fewer rows than turns of the pinion");
    }
}

/* A limit that no step of the run can reach is none. */
static void judge_max_step(const config *conf) {
    static const double usual[] = {1e-8, 1e-2};
    static const other_unit units[] = {{"in us", 1e-6}, {"in ms", 1e-3}, {NULL, 0}};
    const double possible[] = {0, conf->duration};

    (void)judge(conf, "solver.max_step_s", conf->max_step, " s", 1, possible, usual, units,
                "longer than the run");
}

/* A blend is a part of the profile. */
static void judge_profile_blend(const config *conf) {
    static const double possible[] = {0, 1}, usual[] = {0.01, 1};
    static const other_unit units[] = {{"in percent", 1e-2}, {NULL, 0}};

    (void)judge(conf, "flanks.profile_blend", conf->profile_blend, "", 1, possible, usual, units,
                "wider than the profile");
}

/* Deviations are in um already. */
static void judge_flank_scale(const config *conf) {
    if (conf->flank_scale != 0 && fabs(conf->flank_scale) <= 1e-3) {
        tell(conf, "flanks.scale", "", "which leaves nothing of deviations, whose unit is um",
             "as a change of unit", 1);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Modifications
 * ------------------------------------------------------------------------------------------- */

/* An amount in um: less than a tenth is lost in the roughness. */
static void judge_amount(const config *conf, const char *key, double amount) {
    static const double possible[] = {0.1, HUGE_VAL}, usual[] = {1, 300};
    static const other_unit units[] = {{"in mm", 1e3}, {"in metres", 1e6}, {NULL, 0}};

    if (amount != 0) {
        (void)judge(conf, key, 1e6 * amount, " um", amount < 0 ? -1 : 1, possible, usual, units,
                    "less than the roughness of flanks");
    }
}

/* The keys of one kind in one place: lengths in terms of face width, module and reference diameter. */
static int has_number(const modification_values *given) {
    for (int i = 0; i < (int)(sizeof given->value / sizeof given->value[0]); ++i) {
        if (!isnan(given->value[i])) {
            return 1;
        }
    }
    return 0;
}

static void judge_modification(const config *conf, const usual_gear *usual, enum gm_role gear,
                               int place, int kind) {
    static const double width_possible[] = {3e-3, HUGE_VAL}, width_usual[] = {0.01, 1};
    static const double length_possible[] = {0.02, HUGE_VAL}, length_usual[] = {0.1, 20};
    const modification_values *given = &conf->modifications[gear][place][kind];
    char key[MODIFICATION_KEY_SIZE];

    /* Hardly any of all kinds is there, and names take longer to make than numbers to look at. */
    if (!has_number(given)) {
        return;
    }
    modification_key_name(key, gear, place, kind, MODIFICATION_AMOUNT);
    judge_amount(conf, key, given->value[MODIFICATION_AMOUNT]);

    modification_key_name(key, gear, place, kind, MODIFICATION_WIDTH);
    (void)judge(conf, key, 1e3 * given->value[MODIFICATION_WIDTH], " mm", usual->face_width,
                width_possible, width_usual, lengths, "next to nothing of the face width");

    modification_key_name(key, gear, place, kind, MODIFICATION_LENGTH);
    (void)judge(conf, key, 1e3 * given->value[MODIFICATION_LENGTH], " mm", usual->module,
                length_possible, length_usual, lengths, "next to nothing of the profile");

    modification_key_name(key, gear, place, kind, MODIFICATION_RADIUS);
    judge_diameter(conf, key, given->value[MODIFICATION_RADIUS], usual->diameter[gear]);

    modification_key_name(key, gear, place, kind, MODIFICATION_SHARE);
    if (is_within(given->value[MODIFICATION_SHARE], 1 + 1e-9, 100)) {
        tell(conf, key, "", "more than the profile", "in percent",
             given->value[MODIFICATION_SHARE] / 100);
    }
}

static void judge_modifications(const config *conf, const usual_gear *usual) {
    for (enum gm_role gear = GM_PINION; gear <= GM_WHEEL; ++gear) {
        for (int place = 0; place < MODIFICATION_PLACES; ++place) {
            for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
                judge_modification(conf, usual, gear, place, kind);
            }
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * The whole
 * ------------------------------------------------------------------------------------------- */

static void judge_run(const config *conf, const usual_gear *usual) {
    /* The mesh. */
    judge_stiffness(conf, "mesh.stiffness_N_per_m", conf->stiffness, usual);
    judge_stiffness(conf, "mesh.simple_stiffness_N_per_m", conf->simple_stiffness, usual);
    judge_modulus(conf, "mesh.pinion_youngs_modulus_GPa", conf->pinion_youngs_modulus);
    judge_modulus(conf, "mesh.wheel_youngs_modulus_GPa", conf->wheel_youngs_modulus);
    judge_oil(conf);
    judge_roughness(conf);
    judge_pose(conf);

    /* What turns. */
    const double pinion =
        judge_inertia(conf, "bodies.pinion_inertia_kg_m2", conf->pinion_inertia, usual, 0);
    const double wheel =
        judge_inertia(conf, "bodies.wheel_inertia_kg_m2", conf->wheel_inertia, usual, 1);
    judge_damping(conf, mesh_mass(conf, usual, pinion, wheel));

    /* What drives and loads it. */
    judge_torque(conf, "drive.torque_Nm", conf->drive_torque, usual, 0);
    judge_torque(conf, "load.mean_Nm", conf->mean_load, usual, 1);
    judge_torque(conf, "load.end_Nm", conf->end_load, usual, 1);
    judge_torque(conf, "load.noise_amplitude_Nm", conf->noise_amplitude, usual, 1);
    judge_speed(conf, "drive.start_rpm", conf->start_speed);
    judge_speed(conf, "drive.end_rpm", conf->end_speed);
    judge_speed(conf, "analysis.stop_rpm", conf->stop_speed);

    /* What only some runs have. */
    if (conf->analysis == ANALYSIS_DYNAMIC) {
        judge_torque_over_speed(conf, "bodies.wheel_drag_Nms", conf->wheel_drag, usual);
        judge_torque_over_speed(conf, "load.per_speed_Nms", conf->load_per_speed, usual);
        judge_noise_interval(conf);
        judge_rate(conf);
        judge_max_step(conf);
    }
    if (conf->model == MODEL_3D) {
        judge_flank_scale(conf);
        judge_profile_blend(conf);
        judge_modifications(conf, usual);
    }
}

void slips_warn(const config *conf) {
    const usual_gear usual = judge_drawing(conf);

    if (conf->purpose == CONFIG_FOR_RUN) {
        judge_run(conf, &usual);
    }
}
