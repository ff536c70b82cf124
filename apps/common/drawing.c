/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "drawing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---------------------------------------------------------------------------------------------
 * Pairs that cannot be
 * ------------------------------------------------------------------------------------------- */

/* The library speaks of radii, the file of diameters. */
static void speak_of_diameters(const char *requirement, char *text, size_t size) {
    const char *radius;
    size_t length = 0;

    *text = '\0';
    while ((radius = strstr(requirement, "radius")) != NULL && length < size) {
        length += (size_t)snprintf(text + length, size - length, "%.*sdiameter",
                                   (int)(radius - requirement), requirement);
        requirement = radius + strlen("radius");
    }
    if (length < size) {
        snprintf(text + length, size - length, "%s", requirement);
    }
}

/* What most geometry faults are measured against; needs nothing but teeth, module and angles (m). */
static double base_diameter(const gm_pair_params *gears, int teeth) {
    const double cos_helix = cos(gears->helix_angle);
    const double transverse_pressure_angle = atan(tan(gears->normal_pressure_angle) / cos_helix);

    return teeth * gears->normal_module / cos_helix * cos(transverse_pressure_angle);
}

/* A geometry that cannot be, said of the key that sets the field at fault. */
static int refuse_geometry(const config *conf, int status) {
    const char *field = NULL;
    const char *requirement = NULL;
    const char *key = "gears";
    const char *text;
    char wanted[256];

    (void)gm_pair_params_check(&conf->gears, &field, &requirement);
    if (field != NULL) {
        key = config_key_of_field(field);
    }
    text = config_text(conf, key);
    speak_of_diameters(requirement != NULL ? requirement : gm_status_text(status), wanted,
                       sizeof wanted);
    config_complain(conf, key, "must be %s (got %s); the base diameters are %.9g and %.9g mm",
                    wanted, text != NULL ? text : "none, so it is derived",
                    1e3 * base_diameter(&conf->gears, conf->gears.pinion_teeth),
                    1e3 * base_diameter(&conf->gears, conf->gears.wheel_teeth));
    return EXIT_BAD_INPUT;
}

int drawing_derive(gm_pair *pair, const config *conf) {
    const int status = gm_pair_init(pair, &conf->gears);

    return status == GM_OK ? 0 : refuse_geometry(conf, status);
}

/* ---------------------------------------------------------------------------------------------
 * Pairs to be warned of
 * ------------------------------------------------------------------------------------------- */

/* Normal tooth thickness at the tip circle, in modules; negative = the flanks cross below it. */
static double tip_land(const gm_gear *gear, const gm_pair *pair) {
    const double alpha = acos(gear->base_radius / gear->tip_radius);
    const double half_angle = gear->base_half_thickness - (tan(alpha) - alpha);
    const double helix = atan(gear->tip_radius / gear->reference_radius * tan(pair->helix_angle));

    return 2 * gear->tip_radius * half_angle * cos(helix) / pair->normal_module;
}

static void warn_of_tip(const config *conf, const gm_pair *pair, const gm_gear *gear,
                        const char *key, const char *name) {
    const double land = tip_land(gear, pair);

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
    const char *name, *teeth_key, *tip_key, *start_key;
    int undercut, tip_land, root_form, start_radius;
} gear_words;

static const gear_words pinion_words = {"pinion",
                                        "gears.pinion_teeth",
                                        "gears.pinion_tip_diameter_mm",
                                        "gears.pinion_start_diameter_mm",
                                        GM_WARN_PINION_UNDERCUT,
                                        GM_WARN_PINION_TIP_LAND,
                                        GM_WARN_PINION_ROOT_FORM,
                                        GM_WARN_PINION_START_RADIUS};
static const gear_words wheel_words = {"wheel",
                                       "gears.wheel_teeth",
                                       "gears.wheel_tip_diameter_mm",
                                       "gears.wheel_start_diameter_mm",
                                       GM_WARN_WHEEL_UNDERCUT,
                                       GM_WARN_WHEEL_TIP_LAND,
                                       GM_WARN_WHEEL_ROOT_FORM,
                                       GM_WARN_WHEEL_START_RADIUS};

static void warn_of_gear(const config *conf, const gm_pair *pair, const gm_gear *gear,
                         const gear_words *words, int warnings) {
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

    warn_of_gear(conf, pair, &pair->pinion, &pinion_words, warnings);
    warn_of_gear(conf, pair, &pair->wheel, &wheel_words, warnings);
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
}
