/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "drawing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------------------------------------
 * Pairs that cannot be
 * ------------------------------------------------------------------------------------------- */

/* The library speaks of radii, the file of diameters. */
static void speak_of_diameters(const char *requirement, char *text, size_t size) {
    size_t length = 0;

    *text = '\0';
    const char *radius = strstr(requirement, "radius");
    while (radius != NULL && length < size) {
        length += (size_t)snprintf(text + length, size - length, "%.*sdiameter",
                                   (int)(radius - requirement), requirement);
        requirement = radius + strlen("radius");
        radius = strstr(requirement, "radius");
    }

    if (length < size) {
        snprintf(text + length, size - length, "%s", requirement);
    }
}

/* What most geometry faults are measured against; needs nothing but teeth, module and angles (m). */
static double base_diameter(const gm_pair_params *gears, int teeth) {
    const double cos_helix = cos(gears->helix_angle);
    const double transverse_pressure_angle = atan(tan(gears->normal_pressure_angle) / cos_helix);

    return abs(teeth) * gears->normal_module / cos_helix * cos(transverse_pressure_angle);
}

/* The measures that a fault is judged by: where the faces lie, or the base circles (mm). */
static void describe_measures(char *text, size_t size, const gm_pair_params *gears,
                              const char *field) {
    const double pinion =
        isnan(gears->pinion_face_width) ? gears->face_width : gears->pinion_face_width;
    const double wheel =
        isnan(gears->wheel_face_width) ? gears->face_width : gears->wheel_face_width;
    const double wheel_middle = 0.5 * pinion + gears->axial_offset;

    if (strstr(field, "axial_offset") != NULL || strstr(field, "face_width") != NULL) {
        snprintf(text, size, "the faces are: pinion 0 to %.9g mm, wheel %.9g to %.9g mm",
                 1e3 * pinion, 1e3 * (wheel_middle - 0.5 * wheel),
                 1e3 * (wheel_middle + 0.5 * wheel));
    } else {
        snprintf(text, size, "the base diameters are %.9g and %.9g mm",
                 1e3 * base_diameter(gears, gears->pinion_teeth),
                 1e3 * base_diameter(gears, gears->wheel_teeth));
    }
}

/* A geometry that cannot be, said of the key that sets the field at fault. */
static int refuse_geometry(const config *conf, int status) {
    const char *field = NULL;
    const char *requirement = NULL;

    /* Which field it is, and the key that sets it. */
    (void)gm_pair_params_check(&conf->gears, &field, &requirement);
    const char *key = field != NULL ? config_key_of_field(field) : "gears";
    const char *text = config_text(conf, key);

    char wanted[256];
    char measures[160];
    speak_of_diameters(requirement != NULL ? requirement : gm_status_text(status), wanted,
                       sizeof wanted);
    describe_measures(measures, sizeof measures, &conf->gears, key);
    config_complain(conf, key, "must be %s (got %s); %s", wanted,
                    text != NULL ? text : "none, so it is derived", measures);
    return EXIT_BAD_INPUT;
}

/* What keeps a pair from being double-helical. */
static int refuse_double_helical(const config *conf, const gm_pair *pair) {
    if (pair->helix_angle == 0.0) {
        config_complain(conf, "gears.helix_angle_deg",
                        "must not be 0 with gears.double_helical_gap_mm (got 0)");
    } else if (conf->gears.axial_offset != 0.0) {
        config_complain(conf, "gears.axial_offset_mm",
                        "must be 0 with gears.double_helical_gap_mm, as the pinion floats to "
                        "where both halves carry the same (got %.9g)",
                        1e3 * conf->gears.axial_offset);
    } else {
        config_complain(
            conf, "gears.double_helical_gap_mm",
            "must leave teeth on both sides: less than the common face width, %.9g (got "
            "%.9g)",
            1e3 * pair->face_width, 1e3 * conf->double_helical_gap);
    }
    return EXIT_BAD_INPUT;
}

int drawing_derive(gm_pair *pair, const config *conf) {
    const int status = gm_pair_init(pair, &conf->gears);
    if (status != GM_OK) {
        return refuse_geometry(conf, status);
    }
    if (isnan(conf->double_helical_gap)) {
        return 0;
    }

    /* Of a double-helical pair one half; what was right of the whole is only too narrow now. */
    gm_pair_params params;
    gm_pair half;
    if (gm_double_helical_half(&conf->gears, conf->double_helical_gap, &params) != GM_OK ||
        gm_pair_init(&half, &params) != GM_OK) {
        return refuse_double_helical(conf, pair);
    }
    *pair = half;
    return 0;
}

/* ---------------------------------------------------------------------------------------------
 * Pairs to be warned of
 * ------------------------------------------------------------------------------------------- */

static void warn_of_tip(const config *conf, const gm_pair *pair, const gm_gear *gear,
                        const char *key, const char *name) {
    const double land = gear->normal_tip_thickness / pair->normal_module;

    if (land <= 0) {
        config_warn(conf, key,
                    "pointed tip: the flanks of the %s cross below the tip diameter of %.6g mm",
                    name, 2e3 * gear->tip_radius);
    } else {
        config_warn(
            conf, key,
            "thin tip: the teeth of the %s are %.3f normal modules thick at the tip diameter "
            "of %.6g mm, less than 0.2",
            name, land, 2e3 * gear->tip_radius);
    }
}

/* What is said of one gear: keys and warnings of the pinion or of the wheel. */
typedef struct gear_words {
    const char *name, *mate;
    const char *teeth_key, *tip_key, *start_key, *alteration_key, *mate_dedendum_key;
    int undercut, tip_land, root_form, start_radius, tip_clearance, tip_alteration;
} gear_words;

static const gear_words words_of[2] = {
    [GM_PINION] = {.name = "pinion",
                   .mate = "wheel",
                   .teeth_key = "gears.pinion_teeth",
                   .tip_key = "gears.pinion_tip_diameter_mm",
                   .start_key = "gears.pinion_start_diameter_mm",
                   .alteration_key = "gears.pinion_tip_alteration",
                   .mate_dedendum_key = "gears.wheel_rack_dedendum",
                   .undercut = GM_WARN_PINION_UNDERCUT,
                   .tip_land = GM_WARN_PINION_TIP_LAND,
                   .root_form = GM_WARN_PINION_ROOT_FORM,
                   .start_radius = GM_WARN_PINION_START_RADIUS,
                   .tip_clearance = GM_WARN_PINION_TIP_CLEARANCE,
                   .tip_alteration = GM_WARN_PINION_TIP_ALTERATION},
    [GM_WHEEL] = {.name = "wheel",
                  .mate = "pinion",
                  .teeth_key = "gears.wheel_teeth",
                  .tip_key = "gears.wheel_tip_diameter_mm",
                  .start_key = "gears.wheel_start_diameter_mm",
                  .alteration_key = "gears.wheel_tip_alteration",
                  .mate_dedendum_key = "gears.pinion_rack_dedendum",
                  .undercut = GM_WARN_WHEEL_UNDERCUT,
                  .tip_land = GM_WARN_WHEEL_TIP_LAND,
                  .root_form = GM_WARN_WHEEL_ROOT_FORM,
                  .start_radius = GM_WARN_WHEEL_START_RADIUS,
                  .tip_clearance = GM_WARN_WHEEL_TIP_CLEARANCE,
                  .tip_alteration = GM_WARN_WHEEL_TIP_ALTERATION},
};

/* With the tip that would leave the usual quarter of a module. */
static void warn_of_clearance(const config *conf, const gm_pair *pair, const gm_gear *gear,
                              const gear_words *words, double clearance) {
    const double usual = 0.25;
    const double excess = usual - clearance / pair->normal_module; /* of the tooth, in modules */
    const double tip_radius = gear->tip_radius - gear->sign * excess * pair->normal_module;

    config_warn(conf, words->tip_key,
                "the tip clearance to the root of the %s is %.3f normal modules, less than 0.1: a "
                "tip alteration of %.4f (tip diameter %.6f mm) would leave %.2f; if the root is "
                "deeper, give %s",
                words->mate, clearance / pair->normal_module, gear->tip_alteration - excess,
                2e3 * tip_radius, usual, words->mate_dedendum_key);
}

static void warn_of_gear(const config *conf, const gm_pair *pair, enum gm_role role, int warnings) {
    const gm_gear *gear = role == GM_PINION ? &pair->pinion : &pair->wheel;
    const double clearance =
        role == GM_PINION ? pair->pinion_tip_clearance : pair->wheel_tip_clearance;
    const gear_words *words = &words_of[role];

    if (warnings & words->undercut) {
        config_warn(
            conf, words->teeth_key,
            "undercut: a generating rack cuts into the involute of the %s (%d teeth, profile "
            "shift %.6g)",
            words->name, gear->teeth, gear->profile_shift);
    }
    if (warnings & words->tip_land) {
        warn_of_tip(conf, pair, gear, words->tip_key, words->name);
    }
    if (warnings & words->tip_clearance) {
        warn_of_clearance(conf, pair, gear, words, clearance);
    }
    if (warnings & words->tip_alteration) {
        config_warn(conf, words->alteration_key, "not used, as %s gives the tip", words->tip_key);
    }

    /* Where the active profile begins. */
    if (warnings & words->root_form) {
        config_warn(
            conf, words->start_key,
            "the active profile of the %s starts at a diameter of %.6g mm, below the root form "
            "circle that a generating rack leaves",
            words->name, 2e3 * gear->start_radius);
    }
    if (warnings & words->start_radius) {
        config_warn(conf, words->start_key,
                    "below the base circle of the %s, its diameter %.6g mm is taken instead",
                    words->name, 2e3 * gear->base_radius);
    }
}

void drawing_warn(const config *conf, const gm_pair *pair) {
    const int warnings = gm_pair_warnings(pair, &conf->gears);

    warn_of_gear(conf, pair, GM_PINION, warnings);
    warn_of_gear(conf, pair, GM_WHEEL, warnings);

    /* Of both gears together. */
    if (warnings & GM_WARN_CONTACT_RATIO) {
        config_warn(
            conf, "gears.center_distance_mm",
            "the transverse contact ratio is %.4f, below 1: no smooth handover between teeth",
            pair->transverse_contact_ratio);
    }
    if (warnings & GM_WARN_BACKLASH) {
        config_warn(conf, "gears.backlash_um",
                    "the backlash is %.6g um, negative: both flanks touch and press",
                    1e6 * pair->backlash);
    }
    if (warnings & GM_WARN_BACKLASH_ROUNDED) {
        config_remark(conf, "gears.backlash_um",
                      "the backlash is %.3g um, within 1e-4 normal modules below 0: taken as "
                      "rounded profile shifts",
                      1e6 * pair->backlash);
    }
}
