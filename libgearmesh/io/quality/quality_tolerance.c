/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Tolerances of ISO 1328-1:2013; docs/flank-quality.md. */

#include <math.h>

#include "gearmesh/gearmesh_io.h"
#include "shared.h"

static int kind_exists(int kind) {
    return kind >= 0 && kind < GM_QUALITY_KINDS;
}

const char *gm_quality_symbol(int kind) {
    static const char *const symbol[GM_QUALITY_KINDS] = {
        "f_p", "F_p", "F_r", "f_H_alpha", "f_f_alpha", "F_alpha", "f_H_beta", "f_f_beta", "F_beta"};
    return kind_exists(kind) ? symbol[kind] : "unknown";
}

/* ---------------------------------------------------------------------------------------------
 * Tolerances
 * ------------------------------------------------------------------------------------------- */

/* Class 5, not rounded, from reference diameter, normal module and face width in mm; um [5.3, annex for F_r]. */
static double base_tolerance(int kind, double d, double m, double b) {
    switch (kind) {
    case GM_QUALITY_SINGLE_PITCH:
        return 0.001 * d + 0.4 * m + 5.0;
    case GM_QUALITY_TOTAL_PITCH:
        return 0.002 * d + 0.55 * sqrt(d) + 0.7 * m + 12.0;
    case GM_QUALITY_RUN_OUT:
        return 0.9 * base_tolerance(GM_QUALITY_TOTAL_PITCH, d, m, b);
    case GM_QUALITY_PROFILE_SLOPE:
        return 0.4 * m + 0.001 * d + 4.0;
    case GM_QUALITY_PROFILE_FORM:
        return 0.55 * m + 5.0;
    case GM_QUALITY_HELIX_SLOPE:
        return 0.05 * sqrt(d) + 0.35 * sqrt(b) + 4.0;
    case GM_QUALITY_HELIX_FORM:
        return 0.07 * sqrt(d) + 0.45 * sqrt(b) + 4.0;
    default: { /* totals, from what is not rounded; their kinds follow those of slope and form */
        const double slope = base_tolerance(kind - 2, d, m, b);
        const double form = base_tolerance(kind - 1, d, m, b);
        return sqrt(slope * slope + form * form);
    }
    }
}

/* sqrt(2)^steps */
static double class_factor(int steps) {
    const int odd = (steps % 2 + 2) % 2;
    return ldexp(odd ? sqrt(2.0) : 1.0, (steps - odd) / 2);
}

/* Above 10 um to 1 um, from 5 um to 0.5 um, below to 0.1 um [5.2.3]; um -> m. */
static double rounded(double um) {
    const double tenths = um > 10.0 ? 10.0 : um >= 5.0 ? 5.0 : 1.0;
    return floor(10.0 * um / tenths + 0.5) * tenths / 1e7;
}

double gm_quality_tolerance(const gm_pair *pair, int wheel, int kind, int quality_class) {
    if (pair == NULL || !kind_exists(kind) || quality_class < GM_QUALITY_BEST_CLASS ||
        quality_class > GM_QUALITY_WORST_CLASS) {
        return (double)NAN;
    }
    const gm_gear *gear = gmi_gear_of(pair, wheel);
    const double tolerance = base_tolerance(kind, 2e3 * gear->reference_radius,
                                            1e3 * pair->normal_module, 1e3 * gear->face_width);
    return rounded(tolerance * class_factor(quality_class - 5));
}

int gm_quality_is_in_scope(const gm_pair *pair, int wheel) {
    if (pair == NULL) {
        return 0;
    }
    /* Limits are meant to be reached: a rounding error must not count. */
    const double slack = 1e-12;
    const gm_gear *gear = gmi_gear_of(pair, wheel);
    const double value[] = {gear->teeth, 2.0 * gear->reference_radius, pair->normal_module,
                            gear->face_width, fabs(pair->helix_angle)};
    static const double low[] = {5.0, 5e-3, 0.5e-3, 4e-3, 0.0};
    const double high[] = {1000.0, 15.0, 70e-3, 1.2, GMI_PI / 4.0};
    for (int i = 0; i < 5; ++i) {
        if (!(value[i] >= low[i] - slack && value[i] <= high[i] + slack)) {
            return 0;
        }
    }
    return 1;
}
