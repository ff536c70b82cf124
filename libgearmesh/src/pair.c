/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From a drawing to a pair ready for evaluation: checks, and the geometry of two gears in mesh
 * [Paper, Eqs. 4-8, 13-17, 23, corrected; ISO21771]. Each step fills the part of gm_pair it is named after.
 */
#include "gear.h"
#include "internal.h"
#include "meshing.h"

#include <float.h>
#include <math.h>

#define LARGEST_CONTACT_RATIO 1000.0 /* keeps the work of an evaluation bounded, */
#define LARGEST_PLACE                                                                              \
    1000.0 /* and so do so many base pitches from tooth 0 to the path of contact */
#define LARGEST_SHIFT 1000.0
#define LARGEST_RACK  10.0 /* parts of a basic rack, and tip alteration, in modules */

/* The basic rack of ISO 53, in modules. */
#define RACK_ADDENDUM      1.0
#define RACK_DEDENDUM      1.25
#define RACK_FILLET_RADIUS 0.38

/* Relative: how far a common face width may be off that of the faces that it repeats. */
#define FACE_WIDTH_ROUNDING 1e-9

/* Of the base pitch: what zero backlash may come out as. */
#define BACKLASH_ROUNDING 1e-12

/*
 * In normal modules: the backlash that profile shifts printed with four digits may leave; straight flank of the assumed
 * rack beyond the mate's tip; the tip land below which case-hardened tips crack; the least tip clearance.
 */
#define SHIFT_ROUNDING         1e-4
#define STRAIGHT_RACK_EXTRA    0.05
#define SMALLEST_TIP_LAND      0.2
#define SMALLEST_TIP_CLEARANCE 0.1

/* What is wrong with the parameters; field NULL = nothing. */
typedef struct problem {
    int status;
    const char *field;
    const char *requirement;
} problem;

static const problem no_problem = {GM_OK, NULL, NULL};

/* What the drawing gives of one gear, and how these fields are called. */
typedef struct gear_params {
    int teeth;
    double face_width;
    double profile_shift;
    double normal_thickness;
    double rack_addendum, rack_dedendum, rack_fillet_radius;
    double tip_alteration;
    double tip_radius;
    double start_radius;
} gear_params;

typedef struct gear_fields {
    const char *teeth, *face_width, *profile_shift, *normal_thickness;
    const char *rack_addendum, *rack_dedendum, *rack_fillet_radius, *tip_alteration;
    const char *tip_radius, *start_radius;
} gear_fields;

#define FIELDS_OF(gear)                                                                            \
    {                                                                                              \
        gear "_teeth", gear "_face_width", gear "_profile_shift", gear "_normal_thickness",        \
            gear "_rack_addendum", gear "_rack_dedendum", gear "_rack_fillet_radius",              \
            gear "_tip_alteration", gear "_tip_radius", gear "_start_radius"                       \
    }

static const gear_fields fields_of[2] = {
    [GM_PINION] = FIELDS_OF("pinion"), [GM_WHEEL] = FIELDS_OF("wheel")};

static gear_params params_of(const gm_pair_params *p, enum gm_role role) {
    if (role == GM_PINION) {
        const gear_params pinion = {
            .teeth = p->pinion_teeth,
            .face_width = p->pinion_face_width,

            /* The teeth. */
            .profile_shift = p->pinion_profile_shift,
            .normal_thickness = p->pinion_normal_thickness,

            /* What cut them. */
            .rack_addendum = p->pinion_rack_addendum,
            .rack_dedendum = p->pinion_rack_dedendum,
            .rack_fillet_radius = p->pinion_rack_fillet_radius,

            /* Where their flanks end. */
            .tip_alteration = p->pinion_tip_alteration,
            .tip_radius = p->pinion_tip_radius,
            .start_radius = p->pinion_start_radius,
        };
        return pinion;
    }
    const gear_params wheel = {
        .teeth = p->wheel_teeth,
        .face_width = p->wheel_face_width,

        /* The teeth. */
        .profile_shift = p->wheel_profile_shift,
        .normal_thickness = p->wheel_normal_thickness,

        /* What cut them. */
        .rack_addendum = p->wheel_rack_addendum,
        .rack_dedendum = p->wheel_rack_dedendum,
        .rack_fillet_radius = p->wheel_rack_fillet_radius,

        /* Where their flanks end. */
        .tip_alteration = p->wheel_tip_alteration,
        .tip_radius = p->wheel_tip_radius,
        .start_radius = p->wheel_start_radius,
    };
    return wheel;
}

static gm_gear *gear_of(gm_pair *pair, enum gm_role role) {
    return role == GM_PINION ? &pair->pinion : &pair->wheel;
}

static enum gm_role mate_of(enum gm_role role) {
    return role == GM_PINION ? GM_WHEEL : GM_PINION;
}

static double or_else(double value, double otherwise) {
    return isnan(value) ? otherwise : value;
}

void gm_pair_params_default(gm_pair_params *params) {
    if (params == NULL) {
        return;
    }
    const double missing = gmi_nan();
    const gm_pair_params defaults = {
        /* Of the pair. */
        .base_helix = GM_BASE_HELIX_ISO,
        .normal_module = missing,
        .normal_pressure_angle = missing,
        .helix_angle = 0.0,
        .center_distance = missing,

        /* The faces. */
        .face_width = missing,
        .pinion_face_width = missing,
        .wheel_face_width = missing,
        .axial_offset = 0.0,

        /* The thickness of the teeth. */
        .pinion_profile_shift = missing,
        .wheel_profile_shift = missing,
        .backlash = missing,
        .pinion_normal_thickness = missing,
        .wheel_normal_thickness = missing,

        /* The basic racks. */
        .pinion_rack_addendum = missing,
        .wheel_rack_addendum = missing,
        .pinion_rack_dedendum = missing,
        .wheel_rack_dedendum = missing,
        .pinion_rack_fillet_radius = missing,
        .wheel_rack_fillet_radius = missing,

        /* Where the flanks end. */
        .pinion_tip_alteration = missing,
        .wheel_tip_alteration = missing,
        .pinion_tip_radius = missing,
        .wheel_tip_radius = missing,
        .pinion_start_radius = missing,
        .wheel_start_radius = missing,
    };
    *params = defaults;
}

static int is_teeth(int teeth) {
    return teeth >= GMI_SMALLEST_TEETH && teeth <= GMI_LARGEST_TEETH;
}

/* Of the wheel, which may be a ring. */
static int is_wheel_teeth(int teeth) {
    return is_teeth(teeth) || (teeth >= -GMI_LARGEST_TEETH && teeth <= -GMI_SMALLEST_TEETH);
}

static int is_length(double value) {
    return value >= GMI_SMALLEST_LENGTH && value <= GMI_LARGEST_LENGTH;
}

static int is_optional_length(double value) {
    return isnan(value) || is_length(value);
}

static int is_optional_within(double value, double limit) {
    return isnan(value) || fabs(value) <= limit;
}

/* NaN, or 0 .. 10 modules. */
static int is_optional_rack(double value) {
    return isnan(value) || (value >= 0.0 && value <= LARGEST_RACK);
}

static problem problem_of(int status, const char *field, const char *requirement) {
    const problem found = {status, field, requirement};
    return found;
}

static problem geometry_problem(const char *field, const char *requirement) {
    return problem_of(GM_ERR_GEOMETRY, field, requirement);
}

/* A parameter by itself: whether it is valid, how it is called, what would be right. */
typedef struct check {
    int valid;
    const char *field;
    const char *requirement;
} check;

static problem first_invalid(const check *checks, size_t count) {
    for (size_t k = 0; k < count; ++k) {
        if (!checks[k].valid) {
            return problem_of(GM_ERR_PARAMETER, checks[k].field, checks[k].requirement);
        }
    }
    return no_problem;
}

static const char length_requirement[] = "a length from 1e-6 to 1e9 m";

/* Each parameter of the pair by itself. */
static problem check_pair_fields(const gm_pair_params *p) {
    const double degree = GMI_PI / 180.0;
    const int both_widths_given = !isnan(p->pinion_face_width) && !isnan(p->wheel_face_width);
    const check checks[] = {
        /* Teeth and their normal section. */
        {is_teeth(p->pinion_teeth), "pinion_teeth", "a whole number from 3 to 100000"},
        {is_wheel_teeth(p->wheel_teeth), "wheel_teeth",
         "a whole number from 3 to 100000, or from -100000 to -3 for a ring"},
        {p->base_helix == GM_BASE_HELIX_ISO || p->base_helix == GM_BASE_HELIX_PAPER, "base_helix",
         "GM_BASE_HELIX_ISO or GM_BASE_HELIX_PAPER"},
        {is_length(p->normal_module), "normal_module", length_requirement},
        {p->normal_pressure_angle > 0.0 && p->normal_pressure_angle < 45.0 * degree,
         "normal_pressure_angle", "an angle between 0 and 45 degrees"},
        {fabs(p->helix_angle) < 60.0 * degree, "helix_angle",
         "an angle between -60 and 60 degrees"},

        /* Where the gears are, and how wide. */
        {is_length(p->center_distance), "center_distance", length_requirement},
        {is_length(p->face_width) || (isnan(p->face_width) && both_widths_given), "face_width",
         length_requirement},
        {fabs(p->axial_offset) <= GMI_LARGEST_LENGTH, "axial_offset",
         "a length from -1e9 to 1e9 m"},
        {is_optional_within(p->backlash, GMI_LARGEST_LENGTH), "backlash",
         "a length from -1e9 to 1e9 m"},
    };
    return first_invalid(checks, sizeof checks / sizeof checks[0]);
}

/* Each parameter of one gear by itself. */
static problem check_gear_fields(const gm_pair_params *params, enum gm_role role) {
    static const char rack[] = "a number of modules from 0 to 10";
    const gear_params p = params_of(params, role);
    const gear_fields *field = &fields_of[role];
    const check checks[] = {
        /* Face and thickness of the teeth. */
        {is_optional_length(p.face_width), field->face_width, length_requirement},
        {is_optional_within(p.profile_shift, LARGEST_SHIFT), field->profile_shift,
         "a number from -1000 to 1000"},
        {is_optional_length(p.normal_thickness), field->normal_thickness, length_requirement},

        /* Basic rack. */
        {is_optional_rack(p.rack_addendum), field->rack_addendum, rack},
        {is_optional_rack(p.rack_dedendum), field->rack_dedendum, rack},
        {is_optional_rack(p.rack_fillet_radius), field->rack_fillet_radius, rack},

        /* Where the flanks end. */
        {is_optional_within(p.tip_alteration, LARGEST_RACK), field->tip_alteration,
         "a number of modules from -10 to 10"},
        {is_optional_length(p.tip_radius), field->tip_radius, length_requirement},
        {is_optional_length(p.start_radius), field->start_radius, length_requirement},
    };
    return first_invalid(checks, sizeof checks / sizeof checks[0]);
}

static problem check_fields(const gm_pair_params *params) {
    problem found = check_pair_fields(params);
    for (enum gm_role role = GM_PINION; found.field == NULL && role <= GM_WHEEL; ++role) {
        found = check_gear_fields(params, role);
    }
    return found;
}

/* A common width that is given beside those of the gears: the narrower one, or what both faces share. */
static problem check_common_width(const gm_pair *pair, const gm_pair_params *p) {
    const double narrower = fmin(pair->pinion.face_width, pair->wheel.face_width);
    const double rounding = FACE_WIDTH_ROUNDING * narrower;
    if (isnan(p->face_width)) {
        return no_problem;
    }

    /* Wider than a gear, or narrower without being what both share. */
    if (p->face_width > narrower + rounding) {
        return geometry_problem("face_width",
                                "a common width, no larger than the face of either gear");
    }
    if (p->face_width < narrower - rounding && fabs(p->face_width - pair->face_width) > rounding) {
        return geometry_problem(
            "face_width", "the width that the faces given for both gears share, or be left out");
    }
    return no_problem;
}

/* Where the faces of both gears begin, and the common face [z from the pinion's face I]. */
static problem derive_faces(gm_pair *pair, const gm_pair_params *p) {
    gm_gear *pinion = &pair->pinion;
    gm_gear *wheel = &pair->wheel;
    pinion->face_width = or_else(p->pinion_face_width, p->face_width);
    wheel->face_width = or_else(p->wheel_face_width, p->face_width);
    pinion->face_start = 0.0;
    wheel->face_start = 0.5 * pinion->face_width + p->axial_offset - 0.5 * wheel->face_width;

    /* The common face has the width of the narrower gear where it lies within the other one. */
    const double wheel_end = wheel->face_start + wheel->face_width;
    const int wheel_begins = wheel->face_start > 0.0;
    const int wheel_ends = wheel_end < pinion->face_width;
    pair->face_start = wheel_begins ? wheel->face_start : 0.0;
    if (wheel_begins && wheel_ends) {
        pair->face_width = wheel->face_width;
    } else {
        pair->face_width = (wheel_ends ? wheel_end : pinion->face_width) - pair->face_start;
    }

    if (!(pair->face_width >= GMI_SMALLEST_LENGTH)) {
        return geometry_problem("axial_offset",
                                "an offset at which the faces of both gears overlap");
    }
    return check_common_width(pair, p);
}

/* Least common multiple by Euclid's algorithm; exact, as 1e5 teeth each give 1e10 at most. */
static double hunting_passes(int pinion_teeth, int wheel_teeth) {
    int divisor = pinion_teeth;
    int rest = wheel_teeth;
    while (rest != 0) {
        const int next = divisor % rest;
        divisor = rest;
        rest = next;
    }
    return (double)pinion_teeth * (wheel_teeth / divisor);
}

/* Transverse section, base circles and base helix: what no mate and no pose changes. */
static void derive_sections(gm_pair *pair, const gm_pair_params *p) {
    const double cos_helix = cos(p->helix_angle);
    const double tan_transverse = tan(p->normal_pressure_angle) / cos_helix; /* [Paper, Eq. 5] */
    const double alpha_t = atan(tan_transverse);
    pair->normal_module = p->normal_module;
    pair->transverse_module = p->normal_module / cos_helix; /* [Paper, Eq. 4] */
    pair->normal_pressure_angle = p->normal_pressure_angle;
    pair->transverse_pressure_angle = alpha_t;
    pair->helix_angle = p->helix_angle;

    gmi_gear_init(&pair->pinion, p->pinion_teeth, pair->transverse_module, alpha_t);
    gmi_gear_init(&pair->wheel, p->wheel_teeth, pair->transverse_module, alpha_t);
    pair->hunting_passes = hunting_passes(pair->pinion.teeth, pair->wheel.teeth);
    pair->transverse_base_pitch = GMI_PI * pair->transverse_module * cos(alpha_t);
    pair->reference_center_distance =
        fabs(pair->pinion.reference_radius + pair->wheel.sign * pair->wheel.reference_radius);

    /* [Paper, Eq. 6] divides by cos(alpha_t); right is the product [ISO21771]. */
    const double cos_transverse = cos(alpha_t);
    const double tan_base_helix = p->base_helix == GM_BASE_HELIX_PAPER
                                      ? tan(p->helix_angle) / cos_transverse
                                      : tan(p->helix_angle) * cos_transverse;
    pair->base_helix_angle = atan(tan_base_helix);
    pair->normal_to_transverse = sqrt(1.0 + tan_base_helix * tan_base_helix);

    /* A line that advances less than a phase is rounded: a spur pair. */
    pair->face_advance = pair->face_width * tan_base_helix;
    if (fabs(pair->face_advance) < DBL_EPSILON * pair->transverse_base_pitch) {
        pair->face_advance = 0.0;
    }
    pair->overlap_ratio = fabs(pair->face_advance) / pair->transverse_base_pitch;
}

/* Depth to which the flank of the rack is straight, below its reference line, in modules. */
static double straight_rack_depth(const gm_gear *gear, double normal_pressure_angle) {
    return gear->rack_dedendum - gear->rack_fillet_radius * (1.0 - sin(normal_pressure_angle));
}

/* The basic rack of each gear; a fillet deeper than the dedendum leaves no straight flank. */
static problem derive_rack(gm_gear *gear, const gm_pair_params *params, enum gm_role role) {
    const gear_params p = params_of(params, role);
    gear->rack_addendum = or_else(p.rack_addendum, RACK_ADDENDUM);
    gear->rack_dedendum = or_else(p.rack_dedendum, RACK_DEDENDUM);
    gear->rack_fillet_radius = or_else(p.rack_fillet_radius, RACK_FILLET_RADIUS);

    /* The fault is with what was given. */
    if (straight_rack_depth(gear, params->normal_pressure_angle) >= 0.0) {
        return no_problem;
    }
    return isnan(p.rack_fillet_radius)
               ? geometry_problem(fields_of[role].rack_dedendum,
                                  "a number of modules that leaves room for the fillet radius")
               : geometry_problem(fields_of[role].rack_fillet_radius,
                                  "a number of modules for which the dedendum has room");
}

/* Working pressure angle and line of action of the drawing. */
static void derive_angles(gm_pair *pair, double center_distance) {
    gmi_meshing nominal;
    gmi_meshing_find_angles(pair, center_distance, &nominal);
    pair->center_distance = nominal.center_distance;
    pair->line_of_action = nominal.line_of_action;
    pair->working_pressure_angle = nominal.working_pressure_angle;
    pair->involute_difference = nominal.involute_difference;
}

/* What the thickness of a tooth comes from: what was given for it, else for its mate, else the centre distance. */
static const char *thickness_field(const gm_pair_params *params, enum gm_role role) {
    const gear_params own = params_of(params, role);
    const gear_params mate = params_of(params, mate_of(role));
    if (!isnan(own.normal_thickness)) {
        return fields_of[role].normal_thickness;
    }
    if (!isnan(own.profile_shift)) {
        return fields_of[role].profile_shift;
    }
    return isnan(mate.profile_shift) ? "center_distance" : fields_of[mate_of(role)].profile_shift;
}

static problem check_thickness(const gm_pair *pair, const gm_pair_params *p) {
    const int backlash_given = !isnan(p->backlash);
    const int pinion_fits = pair->pinion.normal_thickness > 0.0;
    const int wheel_fits = pair->wheel.normal_thickness > 0.0;

    /* A tooth has to be there at the reference circle. */
    if (!(pinion_fits && wheel_fits)) {
        const enum gm_role thin = pinion_fits ? GM_WHEEL : GM_PINION;
        return geometry_problem(backlash_given ? "backlash" : thickness_field(p, thin),
                                "a value that leaves the teeth thicker than 0");
    }

    /* Thicker ones would overlap by more than a tooth. */
    if (!(pair->backlash > -pair->transverse_base_pitch)) {
        const int pinion_thicker = pair->pinion.normal_thickness > pair->wheel.normal_thickness;
        const enum gm_role thick = pinion_thicker ? GM_PINION : GM_WHEEL;
        return geometry_problem(backlash_given ? "backlash" : thickness_field(p, thick),
                                "a value that leaves the backlash above minus one base pitch");
    }
    return no_problem;
}

/* Profile shifts as printed; what is not given follows from the sum that leaves no backlash. */
static void derive_shifts(gm_pair *pair, const gm_pair_params *p) {
    const double shift_sum = (double)(p->pinion_teeth + p->wheel_teeth) *
                             pair->involute_difference /
                             (2.0 * tan(p->normal_pressure_angle)); /* [ISO21771] */
    const int neither_given = isnan(p->pinion_profile_shift) && isnan(p->wheel_profile_shift);
    const double pinion_rest = neither_given ? 0.5 * shift_sum : shift_sum - p->wheel_profile_shift;
    const double wheel_rest = neither_given ? 0.5 * shift_sum : shift_sum - p->pinion_profile_shift;
    pair->pinion.profile_shift = or_else(p->pinion_profile_shift, pinion_rest);
    pair->wheel.profile_shift = or_else(p->wheel_profile_shift, wheel_rest);
}

/*
 * Tooth thicknesses and backlash along the line of action:
 *     p_bt - 2 r_bp psi_p - 2 r_bw psi_w + 2 (r_bp + r_bw) inv(alpha_wt)
 *   = 2 (r_bp + r_bw) (inv(alpha_wt) - inv(alpha_t)) - (s_np + s_nw - pi m_n) cos(alpha_t) / cos(beta),
 * the second form without cancellation of the large terms; r_bw of a ring is below 0.
 */
static problem derive_thickness(gm_pair *pair, const gm_pair_params *p) {
    gm_gear *pinion = &pair->pinion;
    gm_gear *wheel = &pair->wheel;
    const double tan_normal = tan(p->normal_pressure_angle);

    /* Excess of the normal thickness over half a pitch, m_n pi / 2. */
    const double half_pitch = 0.5 * GMI_PI * p->normal_module;
    double excess_p = isnan(p->pinion_normal_thickness)
                          ? 2.0 * p->normal_module * pinion->profile_shift * tan_normal
                          : p->pinion_normal_thickness - half_pitch;
    double excess_w = isnan(p->wheel_normal_thickness)
                          ? 2.0 * p->normal_module * wheel->profile_shift * tan_normal
                          : p->wheel_normal_thickness - half_pitch;

    /* A backlash that is given thins both teeth alike. */
    const double along_line = cos(pair->transverse_pressure_angle) / cos(p->helix_angle);
    pair->backlash =
        2.0 * gmi_base_sum(pair) * pair->involute_difference - (excess_p + excess_w) * along_line;
    if (!isnan(p->backlash)) {
        const double change = 0.5 * (pair->backlash - p->backlash) / along_line;
        excess_p += change;
        excess_w += change;
        pair->backlash = p->backlash;
    }

    const double alpha_t = pair->transverse_pressure_angle;
    gmi_gear_set_thickness(pinion, half_pitch + excess_p, p->helix_angle, alpha_t);
    gmi_gear_set_thickness(wheel, half_pitch + excess_w, p->helix_angle, alpha_t);
    return check_thickness(pair, p);
}

/*
 * Tip alteration that keeps the tip clearance of the basic rack when the axes are closer than the shifts ask for
 * [ISO21771, k m_n = a - a_0 - m_n (x_p + x_w)], or further apart with a ring, where a and a_0 are below 0; a tooth is not
 * made longer.
 */
static double default_tip_alteration(const gm_pair *pair) {
    const double spread = pair->wheel.sign *
                          (pair->center_distance - pair->reference_center_distance) /
                          pair->normal_module;
    const double k = spread - (pair->pinion.profile_shift + pair->wheel.profile_shift);

    /* What axes and shifts that agree leave is none. */
    const double rounding = 8.0 * DBL_EPSILON * pair->center_distance / pair->normal_module;
    return k < -rounding ? k : 0.0;
}

/* Root circle, tip circle and what is left of the tooth there. */
static problem derive_tip(gm_pair *pair, const gm_pair_params *params, enum gm_role role) {
    const gear_params p = params_of(params, role);
    const gear_fields *field = &fields_of[role];
    gm_gear *gear = gear_of(pair, role);
    gmi_gear_set_root(gear, pair->normal_module);
    if (!(gear->root_radius > 0.0)) {
        return geometry_problem(field->rack_dedendum, "a number of modules that leaves a root "
                                                      "radius above 0");
    }

    /* r_a = r + m_n (h_aP + x + k) where the drawing gives no tip [ISO21771]. */
    gmi_gear_set_tip(gear, p.tip_radius, or_else(p.tip_alteration, default_tip_alteration(pair)),
                     pair->normal_module);
    gmi_gear_set_tip_thickness(gear, pair->helix_angle);
    if (gear->tip_roll_length > 0.0) {
        return no_problem;
    }
    return isnan(p.tip_radius) && !isnan(p.tip_alteration)
               ? geometry_problem(field->tip_alteration,
                                  "a number that leaves the tip radius larger than the base radius")
               : geometry_problem(field->tip_radius, "a radius larger than the base radius");
}

/* Start of the active profile [Paper, Eqs. 13-15]: as given, else the point that meets the mate's tip. */
static problem derive_start(gm_pair *pair, const gm_pair_params *params, enum gm_role role) {
    const gear_params p = params_of(params, role);
    const gm_gear *mate = gear_of(pair, mate_of(role));
    gm_gear *gear = gear_of(pair, role);
    gear->start_is_given = !isnan(p.start_radius);
    if (gear->start_is_given) {
        gmi_gear_set_start(gear, p.start_radius);
    } else {
        const double line_of_action = pair->wheel.sign * pair->line_of_action;
        gmi_gear_set_start_roll_length(gear, gmi_start_roll_length(gear, mate, line_of_action));
    }

    /* The teeth of a ring begin outside. */
    const double length = gear->tip_roll_length - gear->start_roll_length;
    if (gear->sign * length > 0.0) {
        return no_problem;
    }
    return gear->start_is_given
               ? geometry_problem(fields_of[role].start_radius,
                                  gear->sign < 0.0 ? "a radius larger than the ring's tip radius"
                                                   : "a radius smaller than the tip radius")
               : geometry_problem(fields_of[role].tip_radius,
                                  "a radius at which the tips of both gears reach each other");
}

/* The gears of a ring's pair may meet where no flank does. */
static problem interference_problem(enum gmi_interference found) {
    switch (found) {
    case GMI_INVOLUTE_INTERFERENCE:
        return geometry_problem("wheel_tip_radius",
                                "a larger radius: the ring's tip reaches beyond the pinion's "
                                "tangent point (involute interference)");
    case GMI_TROCHOID_INTERFERENCE:
        return geometry_problem("wheel_teeth",
                                "a ring with more teeth, or shorter ones: the tips meet beside the "
                                "path of contact (trochoid interference)");
    case GMI_TRIMMING:
        return geometry_problem("wheel_teeth",
                                "a ring with more teeth, or shorter ones: the tips meet when the "
                                "pinion is moved in along the centre line (trimming)");
    case GMI_CLEAR:
        break;
    }
    return no_problem;
}

/* Path of contact at zero penetration and contact ratios [ISO21771]. */
static problem derive_path(gm_pair *pair) {
    gmi_meshing nominal;
    const int meshes = gmi_meshing_find(pair, pair->center_distance, &nominal);

    /* Lengths and ratios along the path. */
    pair->path_start = nominal.path_start;
    pair->path_end = nominal.path_end;
    pair->transverse_contact_ratio = nominal.transverse_contact_ratio;
    pair->total_contact_ratio = pair->transverse_contact_ratio + pair->overlap_ratio;
    pair->phase_origin[GM_DRIVE] = nominal.phase_origin[GM_DRIVE];
    pair->phase_origin[GM_COAST] = nominal.phase_origin[GM_COAST];

    /* Circles. */
    pair->pinion_working_pitch_radius = nominal.working_pitch_radius[GM_PINION];
    pair->wheel_working_pitch_radius = nominal.working_pitch_radius[GM_WHEEL];
    pair->pinion_tip_clearance = nominal.tip_clearance[GM_PINION];
    pair->wheel_tip_clearance = nominal.tip_clearance[GM_WHEEL];

    if (!meshes) {
        return geometry_problem(
            "pinion_tip_radius",
            "a radius at which the active flanks of both gears reach each other");
    }
    if (!(pair->total_contact_ratio <= LARGEST_CONTACT_RATIO)) {
        return geometry_problem("face_width",
                                "a width that gives a total contact ratio below 1000");
    }
    return interference_problem(gmi_meshing_interference(pair, &nominal));
}

/* Absurd thicknesses and distances put the flanks of the teeth at zero angles far from where they meet. */
static problem check_place(const gm_pair *pair, const gm_pair_params *p) {
    if (fabs(pair->phase_origin[GM_DRIVE] - pair->path_start) <=
        LARGEST_PLACE * pair->transverse_base_pitch) {
        return no_problem;
    }
    return geometry_problem(thickness_field(p, GM_PINION),
                            "a value with which the teeth at zero angles stand less than 1000 base "
                            "pitches from their path of contact");
}

/* Finite parameters of absurd sizes overflow where they meet. */
static problem check_finite(const gm_pair *pair) {
    const double derived[] = {
        /* Teeth of each gear. */
        pair->pinion.profile_shift,
        pair->wheel.profile_shift,
        pair->pinion.normal_thickness,
        pair->wheel.normal_thickness,
        pair->pinion.base_half_thickness,
        pair->wheel.base_half_thickness,

        /* Tips. */
        pair->pinion.tip_alteration,
        pair->wheel.tip_alteration,
        pair->pinion.tip_thickness,
        pair->wheel.tip_thickness,
        pair->pinion.tip_roll_length,
        pair->wheel.tip_roll_length,

        /* Both gears together. */
        pair->line_of_action,
        pair->face_advance,
        pair->backlash,
        pair->phase_origin[GM_DRIVE],
        pair->phase_origin[GM_COAST],
        pair->pinion_tip_clearance,
        pair->wheel_tip_clearance,
    };
    for (size_t k = 0; k < sizeof derived / sizeof derived[0]; ++k) {
        if (!gmi_is_finite(derived[k])) {
            return geometry_problem("normal_module", "one that goes with the other sizes: "
                                                     "together they overflow");
        }
    }
    return no_problem;
}

/* A line of action needs base circles that lie apart, one inside the other with a ring. */
static problem check_distance(const gm_pair *pair, const gm_pair_params *p) {
    if (pair->wheel.sign < 0.0 && pair->wheel.teeth <= pair->pinion.teeth) {
        return geometry_problem("wheel_teeth", "a ring with more teeth than the pinion");
    }
    if (p->center_distance > fabs(gmi_base_sum(pair))) {
        return no_problem;
    }
    return geometry_problem("center_distance",
                            pair->wheel.sign < 0.0
                                ? "a distance larger than the difference of the base radii"
                                : "a distance larger than the sum of the base radii");
}

/* All of a drawing, in the order in which one follows from the other. Stops at the first problem. */
static problem derive(gm_pair *pair, const gm_pair_params *params) {
    problem found = check_fields(params);
    if (found.field != NULL) {
        return found;
    }

    /* Each gear alone. */
    found = derive_faces(pair, params);
    if (found.field != NULL) {
        return found;
    }
    derive_sections(pair, params);
    for (enum gm_role role = GM_PINION; found.field == NULL && role <= GM_WHEEL; ++role) {
        found = derive_rack(gear_of(pair, role), params, role);
    }
    if (found.field != NULL) {
        return found;
    }

    /* Both at the centre distance of the drawing. */
    found = check_distance(pair, params);
    if (found.field != NULL) {
        return found;
    }
    derive_angles(pair, params->center_distance);
    derive_shifts(pair, params);
    found = derive_thickness(pair, params);

    /* Tips first: the active flank of a gear starts where the tip of its mate reaches. */
    for (enum gm_role role = GM_PINION; found.field == NULL && role <= GM_WHEEL; ++role) {
        found = derive_tip(pair, params, role);
    }
    for (enum gm_role role = GM_PINION; found.field == NULL && role <= GM_WHEEL; ++role) {
        found = derive_start(pair, params, role);
    }

    /* How they mesh, and whether it makes sense as a whole. */
    if (found.field == NULL) {
        found = derive_path(pair);
    }
    if (found.field == NULL) {
        found = check_finite(pair);
    }
    if (found.field == NULL) {
        found = check_place(pair, params);
    }
    return found;
}

static gm_gear gear_nan(void) {
    const double nan = gmi_nan();
    const gm_gear gear = {
        .teeth = 0,
        .start_is_given = 0,

        /* Sign, shift, basic rack and tip alteration. */
        .sign = nan,
        .profile_shift = nan,
        .rack_addendum = nan,
        .rack_dedendum = nan,
        .rack_fillet_radius = nan,
        .tip_alteration = nan,

        /* Circles. */
        .reference_radius = nan,
        .base_radius = nan,
        .root_radius = nan,
        .tip_radius = nan,
        .start_radius = nan,

        /* Teeth on them. */
        .normal_thickness = nan,
        .base_half_thickness = nan,
        .tip_thickness = nan,
        .normal_tip_thickness = nan,

        /* Flank, pitch and face. */
        .start_roll_length = nan,
        .tip_roll_length = nan,
        .pitch_angle = nan,
        .pitch_angle_remainder = nan,
        .face_width = nan,
        .face_start = nan,
    };
    return gear;
}

static gm_pair pair_nan(void) {
    const double nan = gmi_nan();
    const gm_gear gear = gear_nan();
    const gm_pair pair = {
        .pinion = gear,
        .wheel = gear,

        /* From the gears alone: sections, */
        .normal_module = nan,
        .transverse_module = nan,
        .normal_pressure_angle = nan,
        .transverse_pressure_angle = nan,
        .helix_angle = nan,
        .base_helix_angle = nan,
        .transverse_base_pitch = nan,

        /* the common face and what lies across it. */
        .face_width = nan,
        .face_start = nan,
        .face_advance = nan,
        .normal_to_transverse = nan,
        .hunting_passes = nan,

        /* From the centre distance: line of action, */
        .center_distance = nan,
        .reference_center_distance = nan,
        .working_pressure_angle = nan,
        .involute_difference = nan,
        .line_of_action = nan,

        /* path of contact, */
        .path_start = nan,
        .path_end = nan,
        .transverse_contact_ratio = nan,
        .overlap_ratio = nan,
        .total_contact_ratio = nan,

        /* and how the teeth stand in each other. */
        .backlash = nan,
        .phase_origin = {nan, nan},
        .pinion_working_pitch_radius = nan,
        .wheel_working_pitch_radius = nan,
        .pinion_tip_clearance = nan,
        .wheel_tip_clearance = nan,
    };
    return pair;
}

int gm_pair_params_check(const gm_pair_params *params, const char **field,
                         const char **requirement) {
    problem found = {GM_ERR_NULL, NULL, NULL};
    if (params != NULL) {
        gm_pair pair = pair_nan();
        found = derive(&pair, params);
    }
    if (field != NULL) {
        *field = found.field;
    }
    if (requirement != NULL) {
        *requirement = found.requirement;
    }
    return found.status;
}

int gm_pair_init(gm_pair *pair, const gm_pair_params *params) {
    if (pair == NULL) {
        return GM_ERR_NULL;
    }
    *pair = pair_nan();
    if (params == NULL) {
        return GM_ERR_NULL;
    }
    gm_pair derived = pair_nan();
    const problem found = derive(&derived, params);
    if (found.status == GM_OK) {
        *pair = derived;
    }
    return found.status;
}

/* Roll length of the root form point cut by the rack; negative = undercut. */
static double root_form_roll_length(const gm_pair *pair, const gm_pair_params *params,
                                    enum gm_role role) {
    const gear_params p = params_of(params, role);
    const gm_gear *gear = gmi_gear_of(pair, role == GM_WHEEL);
    const gm_gear *mate = gmi_gear_of(pair, role == GM_PINION);

    /* Depth below the reference circle. A rack of which nothing is said reaches a little deeper than the mate's tip. */
    const int rack_given = !isnan(p.rack_dedendum) || !isnan(p.rack_fillet_radius);
    const double sign = pair->wheel.sign;
    const double needed =
        (gear->reference_radius + sign * mate->tip_radius - sign * pair->center_distance) /
        pair->normal_module;
    const double depth =
        rack_given ? straight_rack_depth(gear, pair->normal_pressure_angle) - gear->profile_shift
                   : needed + STRAIGHT_RACK_EXTRA;
    const double sin_transverse = sin(pair->transverse_pressure_angle);
    return gear->reference_radius * sin_transverse - depth * pair->normal_module / sin_transverse;
}

/* The warnings that both gears share, as one gear has them. */
typedef struct gear_warnings {
    int undercut, tip_land, root_form, start_radius, tip_clearance, tip_alteration;
} gear_warnings;

static int warnings_of_gear(const gm_pair *pair, const gm_pair_params *params, enum gm_role role) {
    static const gear_warnings flags[2] = {
        [GM_PINION] = {GM_WARN_PINION_UNDERCUT, GM_WARN_PINION_TIP_LAND, GM_WARN_PINION_ROOT_FORM,
                       GM_WARN_PINION_START_RADIUS, GM_WARN_PINION_TIP_CLEARANCE,
                       GM_WARN_PINION_TIP_ALTERATION},
        [GM_WHEEL] = {GM_WARN_WHEEL_UNDERCUT, GM_WARN_WHEEL_TIP_LAND, GM_WARN_WHEEL_ROOT_FORM,
                      GM_WARN_WHEEL_START_RADIUS, GM_WARN_WHEEL_TIP_CLEARANCE,
                      GM_WARN_WHEEL_TIP_ALTERATION},
    };
    const gear_params p = params_of(params, role);
    const gm_gear *gear = gmi_gear_of(pair, role == GM_WHEEL);
    const gear_warnings *flag = &flags[role];
    int warnings = 0;

    /* Root: what the rack leaves of the involute. No rack cuts a ring. */
    if (gear->sign > 0.0) {
        const double form = root_form_roll_length(pair, params, role);
        if (form < 0.0) {
            warnings |= flag->undercut;
        }
        if (gear->start_roll_length < form) {
            warnings |= flag->root_form;
        }
    }
    if (p.start_radius < gear->base_radius) {
        warnings |= flag->start_radius;
    }

    /* Tip: its thickness, and its clearance to the mate's root. */
    const double clearance =
        role == GM_PINION ? pair->pinion_tip_clearance : pair->wheel_tip_clearance;
    if (gear->normal_tip_thickness < SMALLEST_TIP_LAND * pair->normal_module) {
        warnings |= flag->tip_land;
    }
    if (clearance < SMALLEST_TIP_CLEARANCE * pair->normal_module) {
        warnings |= flag->tip_clearance;
    }
    if (!isnan(p.tip_alteration) && !isnan(p.tip_radius)) {
        warnings |= flag->tip_alteration;
    }
    return warnings;
}

int gm_pair_warnings(const gm_pair *pair, const gm_pair_params *params) {
    if (pair == NULL || params == NULL) {
        return 0;
    }
    int warnings =
        warnings_of_gear(pair, params, GM_PINION) | warnings_of_gear(pair, params, GM_WHEEL);
    if (pair->transverse_contact_ratio < 1.0) {
        warnings |= GM_WARN_CONTACT_RATIO;
    }

    /* Profile shifts are printed with four digits or so. */
    if (pair->backlash < -SHIFT_ROUNDING * pair->normal_module) {
        warnings |= GM_WARN_BACKLASH;
    } else if (pair->backlash < -BACKLASH_ROUNDING * pair->transverse_base_pitch) {
        warnings |= GM_WARN_BACKLASH_ROUNDED;
    }
    return warnings;
}
