/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From a drawing to a pair ready for evaluation: checks, and the geometry of two gears in mesh
 * [Paper, Eqs. 4-8, 13-17, 23, corrected; ISO21771]. Each step fills the part of gm_pair it is named after.
 */
#include "internal.h"

#include <float.h>
#include <math.h>

#define LARGEST_CONTACT_RATIO 1000.0 /* keeps the work of an evaluation bounded, */
#define LARGEST_PLACE                                                                              \
    1000.0 /* and so do so many base pitches from tooth 0 to the path of contact */
#define LARGEST_SHIFT 1000.0

/* Of the base pitch: what zero backlash may come out as. */
#define BACKLASH_ROUNDING 1e-12

/* In normal modules: straight flank of the assumed rack beyond the mate's tip, and the tip land below which
 * case-hardened tips crack. */
#define STRAIGHT_RACK_EXTRA 0.05
#define SMALLEST_TIP_LAND   0.2

/* What is wrong with the parameters; field NULL = nothing. */
typedef struct problem {
    int status;
    const char *field;
    const char *requirement;
} problem;

static const problem no_problem = {GM_OK, NULL, NULL};

void gm_pair_params_default(gm_pair_params *params) {
    if (params == NULL) {
        return;
    }
    const double missing = gmi_nan();
    const gm_pair_params defaults = {
        .base_helix = GM_BASE_HELIX_ISO,
        .normal_module = missing,
        .normal_pressure_angle = missing,
        .helix_angle = 0.0,
        .center_distance = missing,
        .face_width = missing,
        .pinion_profile_shift = missing,
        .wheel_profile_shift = missing,
        .backlash = missing,
        .pinion_normal_thickness = missing,
        .wheel_normal_thickness = missing,
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

static int is_length(double value) {
    return value >= GMI_SMALLEST_LENGTH && value <= GMI_LARGEST_LENGTH;
}

static int is_optional_length(double value) {
    return isnan(value) || is_length(value);
}

static int is_optional_within(double value, double limit) {
    return isnan(value) || fabs(value) <= limit;
}

/* Each parameter by itself. */
static problem check_fields(const gm_pair_params *p) {
    static const char teeth[] = "a whole number from 3 to 100000";
    static const char length[] = "a length from 1e-6 to 1e9 m";
    static const char shift[] = "a number from -1000 to 1000";
    const double degree = GMI_PI / 180.0;
    const struct {
        int valid;
        const char *field;
        const char *requirement;
    } checks[] = {
        {is_teeth(p->pinion_teeth), "pinion_teeth", teeth},
        {is_teeth(p->wheel_teeth), "wheel_teeth", teeth},
        {p->base_helix == GM_BASE_HELIX_ISO || p->base_helix == GM_BASE_HELIX_PAPER, "base_helix",
         "GM_BASE_HELIX_ISO or GM_BASE_HELIX_PAPER"},
        {is_length(p->normal_module), "normal_module", length},
        {p->normal_pressure_angle > 0.0 && p->normal_pressure_angle < 45.0 * degree,
         "normal_pressure_angle", "an angle between 0 and 45 degrees"},
        {fabs(p->helix_angle) < 60.0 * degree, "helix_angle",
         "an angle between -60 and 60 degrees"},
        {is_length(p->center_distance), "center_distance", length},
        {is_length(p->face_width), "face_width", length},
        {is_optional_within(p->pinion_profile_shift, LARGEST_SHIFT), "pinion_profile_shift", shift},
        {is_optional_within(p->wheel_profile_shift, LARGEST_SHIFT), "wheel_profile_shift", shift},
        {is_optional_within(p->backlash, GMI_LARGEST_LENGTH), "backlash",
         "a length from -1e9 to 1e9 m"},
        {is_optional_length(p->pinion_normal_thickness), "pinion_normal_thickness", length},
        {is_optional_length(p->wheel_normal_thickness), "wheel_normal_thickness", length},
        {is_optional_length(p->pinion_tip_radius), "pinion_tip_radius", length},
        {is_optional_length(p->wheel_tip_radius), "wheel_tip_radius", length},
        {is_optional_length(p->pinion_start_radius), "pinion_start_radius", length},
        {is_optional_length(p->wheel_start_radius), "wheel_start_radius", length},
    };
    for (size_t k = 0; k < sizeof checks / sizeof checks[0]; ++k) {
        if (!checks[k].valid) {
            const problem found = {GM_ERR_PARAMETER, checks[k].field, checks[k].requirement};
            return found;
        }
    }
    return no_problem;
}

static problem geometry_problem(const char *field, const char *requirement) {
    const problem found = {GM_ERR_GEOMETRY, field, requirement};
    return found;
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
    pair->face_width = p->face_width;

    gmi_gear_init(&pair->pinion, p->pinion_teeth, pair->transverse_module, alpha_t);
    gmi_gear_init(&pair->wheel, p->wheel_teeth, pair->transverse_module, alpha_t);
    pair->transverse_base_pitch = GMI_PI * pair->transverse_module * cos(alpha_t);
    pair->reference_center_distance = pair->pinion.reference_radius + pair->wheel.reference_radius;

    /* [Paper, Eq. 6] divides by cos(alpha_t); right is the product [ISO21771]. */
    const double cos_transverse = cos(alpha_t);
    const double tan_base_helix = p->base_helix == GM_BASE_HELIX_PAPER
                                      ? tan(p->helix_angle) / cos_transverse
                                      : tan(p->helix_angle) * cos_transverse;
    pair->base_helix_angle = atan(tan_base_helix);
    pair->face_advance = p->face_width * tan_base_helix;
    if (fabs(pair->face_advance) < DBL_EPSILON * pair->transverse_base_pitch) {
        pair->face_advance = 0.0; /* a line climbs less than a phase is rounded: a spur pair */
    }
    pair->normal_to_transverse = sqrt(1.0 + tan_base_helix * tan_base_helix);
}

/*
 * Working pressure angle and line of action. Both are found from the small difference to the
 * reference position, so that inv(alpha_wt) - inv(alpha_t) keeps its digits when they nearly agree.
 * Returns inv(alpha_wt) - inv(alpha_t).
 */
static double derive_pose(gm_pair *pair, double center_distance) {
    const double base_sum = pair->pinion.base_radius + pair->wheel.base_radius;
    const double alpha_t = pair->transverse_pressure_angle;
    pair->center_distance = center_distance;
    pair->line_of_action =
        sqrt((center_distance - base_sum) * (center_distance + base_sum)); /* [Paper, Eq. 23] */
    const double alpha_w = atan2(pair->line_of_action, base_sum);

    /* cos(alpha_t) - cos(alpha_wt) = 2 sin((alpha_wt + alpha_t) / 2) sin((alpha_wt - alpha_t) / 2) */
    const double cos_difference =
        cos(alpha_t) * ((center_distance - pair->reference_center_distance) / center_distance);
    const double difference = 2.0 * asin(cos_difference / (2.0 * sin(0.5 * (alpha_w + alpha_t))));
    pair->working_pressure_angle = alpha_w;
    return sin(difference) / (cos(alpha_w) * cos(alpha_t)) - difference;
}

/* What the thickness of a tooth comes from: what was given for it, else for its mate, else the centre distance. */
static const char *thickness_field(const gm_pair_params *p, int of_pinion) {
    if (!isnan(of_pinion ? p->pinion_normal_thickness : p->wheel_normal_thickness)) {
        return of_pinion ? "pinion_normal_thickness" : "wheel_normal_thickness";
    }
    if (isnan(p->pinion_profile_shift) && isnan(p->wheel_profile_shift)) {
        return "center_distance";
    }
    const int own_given = !isnan(of_pinion ? p->pinion_profile_shift : p->wheel_profile_shift);
    return own_given == of_pinion ? "pinion_profile_shift" : "wheel_profile_shift";
}

static problem check_thickness(const gm_pair *pair, const gm_pair_params *p) {
    const int backlash_given = !isnan(p->backlash);
    const int pinion_fits = pair->pinion.normal_thickness > 0.0;
    const int wheel_fits = pair->wheel.normal_thickness > 0.0;
    if (!(pinion_fits && wheel_fits)) {
        return geometry_problem(backlash_given ? "backlash" : thickness_field(p, !pinion_fits),
                                "a value that leaves the teeth thicker than 0");
    }
    const int pinion_thicker = pair->pinion.normal_thickness > pair->wheel.normal_thickness;
    if (!(pair->backlash > -pair->transverse_base_pitch)) {
        return geometry_problem(backlash_given ? "backlash" : thickness_field(p, pinion_thicker),
                                "a value that leaves the backlash above minus one base pitch");
    }
    return no_problem;
}

/*
 * Profile shifts, tooth thicknesses and backlash along the line of action:
 *     p_bt - 2 r_bp psi_p - 2 r_bw psi_w + 2 (r_bp + r_bw) inv(alpha_wt)
 *   = 2 (r_bp + r_bw) (inv(alpha_wt) - inv(alpha_t)) - (s_np + s_nw - pi m_n) cos(alpha_t) / cos(beta),
 * the second form without cancellation of the large terms.
 */
static problem derive_thickness(gm_pair *pair, const gm_pair_params *p,
                                double involute_difference) {
    gm_gear *pinion = &pair->pinion;
    gm_gear *wheel = &pair->wheel;
    const double tan_normal = tan(p->normal_pressure_angle);
    const double shift_sum = (double)(p->pinion_teeth + p->wheel_teeth) * involute_difference /
                             (2.0 * tan_normal); /* [ISO21771]: no backlash */
    double x_p = p->pinion_profile_shift;
    double x_w = p->wheel_profile_shift;
    if (isnan(x_p) && isnan(x_w)) {
        x_p = x_w = 0.5 * shift_sum;
    } else if (isnan(x_p)) {
        x_p = shift_sum - x_w;
    } else if (isnan(x_w)) {
        x_w = shift_sum - x_p;
    }
    pinion->profile_shift = x_p;
    wheel->profile_shift = x_w;

    /* Excess of the normal thickness over half a pitch, m_n pi / 2. */
    const double half_pitch = 0.5 * GMI_PI * p->normal_module;
    double excess_p = isnan(p->pinion_normal_thickness) ? 2.0 * p->normal_module * x_p * tan_normal
                                                        : p->pinion_normal_thickness - half_pitch;
    double excess_w = isnan(p->wheel_normal_thickness) ? 2.0 * p->normal_module * x_w * tan_normal
                                                       : p->wheel_normal_thickness - half_pitch;
    const double along_line = cos(pair->transverse_pressure_angle) / cos(p->helix_angle);
    pair->backlash = 2.0 * (pinion->base_radius + wheel->base_radius) * involute_difference -
                     (excess_p + excess_w) * along_line;
    if (!isnan(p->backlash)) {
        const double change = 0.5 * (pair->backlash - p->backlash) / along_line;
        excess_p += change;
        excess_w += change;
        pair->backlash = p->backlash;
    }

    const double alpha_t = pair->transverse_pressure_angle;
    gmi_gear_set_thickness(pinion, half_pitch + excess_p, p->helix_angle, alpha_t);
    gmi_gear_set_thickness(wheel, half_pitch + excess_w, p->helix_angle, alpha_t);
    pair->phase_origin =
        pinion->base_radius * (pair->working_pressure_angle + pinion->base_half_thickness);
    return check_thickness(pair, p);
}

static double default_tip(const gm_gear *gear, double tip_radius, double normal_module) {
    return isnan(tip_radius) ? gear->reference_radius + normal_module * (1.0 + gear->profile_shift)
                             : tip_radius;
}

/* Flank ends [Paper, Eqs. 13-15]; a start radius that is not given meets the mate's tip. */
static problem derive_flank_ends(gm_pair *pair, const gm_pair_params *p) {
    gm_gear *pinion = &pair->pinion;
    gm_gear *wheel = &pair->wheel;
    gmi_gear_set_tip(pinion, default_tip(pinion, p->pinion_tip_radius, p->normal_module));
    gmi_gear_set_tip(wheel, default_tip(wheel, p->wheel_tip_radius, p->normal_module));
    static const char above_base[] = "a radius larger than the base radius";
    if (!(pinion->tip_roll_length > 0.0)) {
        return geometry_problem("pinion_tip_radius", above_base);
    }
    if (!(wheel->tip_roll_length > 0.0)) {
        return geometry_problem("wheel_tip_radius", above_base);
    }

    if (isnan(p->pinion_start_radius)) {
        gmi_gear_set_start_roll_length(pinion, pair->line_of_action - wheel->tip_roll_length);
    } else {
        gmi_gear_set_start(pinion, p->pinion_start_radius);
    }
    if (isnan(p->wheel_start_radius)) {
        gmi_gear_set_start_roll_length(wheel, pair->line_of_action - pinion->tip_roll_length);
    } else {
        gmi_gear_set_start(wheel, p->wheel_start_radius);
    }

    static const char below_tip[] = "a radius smaller than the tip radius";
    static const char reach[] = "a radius at which the tips of both gears reach each other";
    const int pinion_ends = pinion->start_roll_length < pinion->tip_roll_length;
    const int wheel_ends = wheel->start_roll_length < wheel->tip_roll_length;
    if (!pinion_ends) {
        return isnan(p->pinion_start_radius) ? geometry_problem("pinion_tip_radius", reach)
                                             : geometry_problem("pinion_start_radius", below_tip);
    }
    if (!wheel_ends) {
        return isnan(p->wheel_start_radius) ? geometry_problem("wheel_tip_radius", reach)
                                            : geometry_problem("wheel_start_radius", below_tip);
    }
    return no_problem;
}

/* Path of contact at zero penetration and contact ratios [ISO21771]. */
static problem derive_path(gm_pair *pair) {
    pair->path_start =
        fmax(pair->pinion.start_roll_length, pair->line_of_action - pair->wheel.tip_roll_length);
    pair->path_end =
        fmin(pair->pinion.tip_roll_length, pair->line_of_action - pair->wheel.start_roll_length);
    pair->transverse_contact_ratio =
        (pair->path_end - pair->path_start) / pair->transverse_base_pitch;
    pair->overlap_ratio = fabs(pair->face_advance) / pair->transverse_base_pitch;
    pair->total_contact_ratio = pair->transverse_contact_ratio + pair->overlap_ratio;

    if (!(pair->path_end > pair->path_start)) {
        return geometry_problem(
            "pinion_tip_radius",
            "a radius at which the active flanks of both gears reach each other");
    }
    if (!(pair->total_contact_ratio <= LARGEST_CONTACT_RATIO)) {
        return geometry_problem("face_width",
                                "a width that gives a total contact ratio below 1000");
    }
    return no_problem;
}

/* Absurd thicknesses and distances put the flanks of the teeth at zero angles far from where they meet. */
static problem check_place(const gm_pair *pair, const gm_pair_params *p) {
    if (fabs(pair->phase_origin - pair->path_start) <=
        LARGEST_PLACE * pair->transverse_base_pitch) {
        return no_problem;
    }
    return geometry_problem(thickness_field(p, 1),
                            "a value with which the teeth at zero angles stand less than 1000 base "
                            "pitches from their path of contact");
}

/* Finite parameters of absurd sizes overflow where they meet. */
static problem check_finite(const gm_pair *pair) {
    const double derived[] = {
        pair->pinion.base_half_thickness,
        pair->wheel.base_half_thickness,
        pair->pinion.tip_roll_length,
        pair->wheel.tip_roll_length,
        pair->pinion.normal_thickness,
        pair->wheel.normal_thickness,
        pair->pinion.profile_shift,
        pair->wheel.profile_shift,
        pair->line_of_action,
        pair->face_advance,
        pair->backlash,
        pair->phase_origin,
    };
    for (size_t k = 0; k < sizeof derived / sizeof derived[0]; ++k) {
        if (!gmi_is_finite(derived[k])) {
            return geometry_problem("normal_module", "one that goes with the other sizes: "
                                                     "together they overflow");
        }
    }
    return no_problem;
}

static problem derive(gm_pair *pair, const gm_pair_params *params) {
    problem found = check_fields(params);
    if (found.field != NULL) {
        return found;
    }
    derive_sections(pair, params);
    if (!(params->center_distance > pair->pinion.base_radius + pair->wheel.base_radius)) {
        return geometry_problem("center_distance",
                                "a distance larger than the sum of the base radii");
    }
    const double involute_difference = derive_pose(pair, params->center_distance);
    found = derive_thickness(pair, params, involute_difference);
    if (found.field == NULL) {
        found = derive_flank_ends(pair, params);
    }
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
    const gm_gear gear = {0, nan, nan, nan, nan, nan, nan, nan, nan, nan, nan, nan};
    return gear;
}

static gm_pair pair_nan(void) {
    const double nan = gmi_nan();
    const gm_gear gear = gear_nan();
    const gm_pair pair = {gear, gear, nan, nan, nan, nan, nan, nan, nan, nan, nan, nan,
                          nan,  nan,  nan, nan, nan, nan, nan, nan, nan, nan, nan};
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

/* Roll length of the root form point cut by the assumed rack; negative = undercut. */
static double root_form_roll_length(const gm_pair *pair, const gm_gear *gear, const gm_gear *mate) {
    const double m_n = pair->normal_module;
    const double sin_transverse = sin(pair->transverse_pressure_angle);
    const double mate_addendum =
        (mate->tip_radius - mate->reference_radius) / m_n - mate->profile_shift;
    const double depth = mate_addendum + STRAIGHT_RACK_EXTRA - gear->profile_shift;
    return gear->reference_radius * sin_transverse - depth * m_n / sin_transverse;
}

static double normal_tip_land(const gm_pair *pair, const gm_gear *gear) {
    const double tip_pressure_angle = atan2(gear->tip_roll_length, gear->base_radius);
    const double transverse_land =
        2.0 * gear->tip_radius * (gear->base_half_thickness - gmi_involute(tip_pressure_angle));
    const double tip_helix =
        atan(tan(pair->helix_angle) * gear->tip_radius / gear->reference_radius);
    return transverse_land * cos(tip_helix);
}

int gm_pair_warnings(const gm_pair *pair, const gm_pair_params *params) {
    if (pair == NULL || params == NULL) {
        return 0;
    }
    const gm_gear *pinion = &pair->pinion;
    const gm_gear *wheel = &pair->wheel;
    const double pinion_form = root_form_roll_length(pair, pinion, wheel);
    const double wheel_form = root_form_roll_length(pair, wheel, pinion);
    const double least_land = SMALLEST_TIP_LAND * pair->normal_module;

    int warnings = 0;
    if (pinion_form < 0.0) {
        warnings |= GM_WARN_PINION_UNDERCUT;
    }
    if (wheel_form < 0.0) {
        warnings |= GM_WARN_WHEEL_UNDERCUT;
    }
    if (normal_tip_land(pair, pinion) < least_land) {
        warnings |= GM_WARN_PINION_TIP_LAND;
    }
    if (normal_tip_land(pair, wheel) < least_land) {
        warnings |= GM_WARN_WHEEL_TIP_LAND;
    }
    if (pinion->start_roll_length < pinion_form) {
        warnings |= GM_WARN_PINION_ROOT_FORM;
    }
    if (wheel->start_roll_length < wheel_form) {
        warnings |= GM_WARN_WHEEL_ROOT_FORM;
    }
    if (pair->transverse_contact_ratio < 1.0) {
        warnings |= GM_WARN_CONTACT_RATIO;
    }
    if (pair->backlash < -BACKLASH_ROUNDING * pair->transverse_base_pitch) {
        warnings |= GM_WARN_BACKLASH;
    }
    if (params->pinion_start_radius < pinion->base_radius) {
        warnings |= GM_WARN_PINION_START_RADIUS;
    }
    if (params->wheel_start_radius < wheel->base_radius) {
        warnings |= GM_WARN_WHEEL_START_RADIUS;
    }
    return warnings;
}
