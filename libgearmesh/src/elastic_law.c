/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What an elastic pair is made of, prepared once: the compliance of both teeth over their profiles as tables, the
 * contact law's rate, the layers along the face. All logarithms and trigonometry happen here.
 */
#include "elastic.h"
#include "internal.h"
#include "tooth_compliance.h"
#include "wide.h"

#include <math.h>
#include <string.h>

int gmi_elastic_lines(double total_contact_ratio) {
    /* A path of that many pitches holds one line more at times; and one for a path that a pose lengthens. */
    return (int)fmin(total_contact_ratio, 1e6) + 2;
}

static int check(const gmi_elastic_params *params) {
    int good = params->line_of_action * params->gear[1].teeth > 0.0 && params->stations >= 2 &&
               params->stations <= GMI_ELASTIC_STATIONS_MAX && params->lines >= 1 &&
               params->lines <= GMI_ELASTIC_LINES_MAX;
    for (int g = 0; g < 2; ++g) {
        const gmi_elastic_gear_params *gear = &params->gear[g];
        good =
            good && gear->youngs_modulus >= GMI_ELASTIC_LEAST_MODULUS &&
            gear->youngs_modulus <= GMI_ELASTIC_LARGEST_MODULUS && gear->poisson_ratio >= 0.0 &&
            gear->poisson_ratio <= GMI_ELASTIC_LARGEST_RATIO && gear->rack_dedendum > 0.0 &&
            gear->rack_fillet_radius >= 0.0 && gear->rack_fillet_radius < gear->rack_dedendum &&
            (gear->teeth < 0.0 ? gear->tip_roll_length <= 0.0 : gear->start_roll_length >= 0.0) &&
            gear->tip_roll_length > gear->start_roll_length;
    }
    return good;
}

/* B_i of one gear: line contact of a half plane, plane strain. */
static double half_plane(const gmi_elastic_gear_params *gear) {
    const double nu = gear->poisson_ratio;
    return 2.0 * (1.0 - nu * nu) / (GMI_PI * gear->youngs_modulus);
}

/* Virtual spur gear of the normal section [ISO21771]. */
static gmi_tooth_params tooth_params(const gmi_elastic_params *params,
                                     const gmi_elastic_gear_params *gear) {
    const double cosine = cos(params->base_helix_angle);
    const gmi_tooth_params tooth = {gear->teeth / (cosine * cosine * cos(params->helix_angle)),
                                    params->normal_module,
                                    params->normal_pressure_angle,
                                    gear->profile_shift,
                                    gear->normal_thickness,
                                    gear->rack_dedendum,
                                    gear->rack_fillet_radius,
                                    gear->youngs_modulus,
                                    gear->poisson_ratio};
    return tooth;
}

/* Value and slope of both columns of a table at one roll length. */
typedef struct table_node {
    double value[2], slope[2];
} table_node;

/* share: B_i / B_m. The normal section is entered with rho / cos(beta_b). */
static int find_node(const gmi_tooth *tooth, double cosine, double share, double roll,
                     table_node *node) {
    gmi_tooth_load load;
    const int fault = gmi_tooth_load_at(tooth, roll / cosine, &load);
    if (fault != GMI_TOOTH_FINE) {
        return fault;
    }
    node->value[0] = (load.bending + load.foundation) / cosine;
    node->slope[0] = load.slope / (cosine * cosine);

    /* h = rho (2 t e^kappa_H)^-share, and dt/d rho_n = -tan(alpha')^2 */
    const double tangent = tan(load.angle);
    const double depth = pow(2.0 * load.depth * exp(GMI_ELASTIC_HERTZ_OFFSET), -share);
    const double depth_rate = -tangent * tangent / (cosine * load.depth);
    node->value[1] = roll * depth;
    node->slope[1] = depth * (1.0 - share * roll * depth_rate);
    return GMI_TOOTH_FINE;
}

/*
 * Slope of a cell's end times its length. Where both slopes go the way of the rise, no more than three times that: so the
 * cubic stays between both values [Fritsch, Carlson 1980]. Beside a pointed tip, where 1 / t grows without bound, it would
 * fall below 0 and turn a gap into a load.
 */
static double bounded(double slope, double other, double rise) {
    const int same_way = slope * rise > 0.0 && other * rise > 0.0;
    return same_way && fabs(slope) > 3.0 * fabs(rise) ? 3.0 * rise : slope;
}

/* Cubic through values and slopes at both ends of a cell. */
static void set_cell(gmi_elastic_cell *cell, const table_node *from, const table_node *to,
                     double length) {
    for (int k = 0; k < 2; ++k) {
        const double rise = to->value[k] - from->value[k];
        const double first = bounded(from->slope[k] * length, to->slope[k] * length, rise);
        const double last = bounded(to->slope[k] * length, from->slope[k] * length, rise);
        const double square = 3.0 * rise - 2.0 * first - last, cube = first + last - 2.0 * rise;
        cell->value[0][k] = from->value[k];
        cell->value[1][k] = first;
        cell->value[2][k] = square;
        cell->value[3][k] = cube;
    }
}

static void hold_cell(gmi_elastic_cell *cell, const table_node *node) {
    memset(cell, 0, sizeof *cell);
    cell->value[0][0] = node->value[0];
    cell->value[0][1] = node->value[1];
}

/* A tooth of each gear, in the normal section that is entered with rho / cos(beta_b). */
typedef struct tooth_pair {
    gmi_tooth tooth[2];
    double share[2]; /* B_i / B_m */
    double cosine;   /* cos(beta_b) */
    double rim;      /* r^2 */
    double action;   /* T */
} tooth_pair;

/* s^2 = c_p + c_w - r^2 and 1 / (B e^L) = 4 h_p h_w / T, by rho_p. */
static int find_pair_node(const tooth_pair *pair, double roll, table_node *node) {
    table_node pinion, wheel;
    int fault = find_node(&pair->tooth[0], pair->cosine, pair->share[0], roll, &pinion);
    if (fault == GMI_TOOTH_FINE) {
        fault =
            find_node(&pair->tooth[1], pair->cosine, pair->share[1], pair->action - roll, &wheel);
    }
    if (fault != GMI_TOOTH_FINE) {
        return fault;
    }
    const double per_action = 4.0 / pair->action;
    node->value[0] = sqrt(pinion.value[0] + wheel.value[0] - pair->rim);
    node->slope[0] = 0.5 * (pinion.slope[0] - wheel.slope[0]) / node->value[0];
    node->value[1] = per_action * pinion.value[1] * wheel.value[1];
    node->slope[1] =
        per_action * (pinion.slope[1] * wheel.value[1] - pinion.value[1] * wheel.slope[1]);
    return GMI_TOOTH_FINE;
}

enum { OF_PINION, OF_WHEEL, OF_BOTH };

static int find_any_node(const tooth_pair *pair, int of, double roll, table_node *node) {
    return of == OF_BOTH ? find_pair_node(pair, roll, node)
                         : find_node(&pair->tooth[of], pair->cosine, pair->share[of], roll, node);
}

/* The table of one gear, or of both, over its roll lengths. *least: the smallest value of its first column. */
static int set_table(gmi_elastic_gear *table, const tooth_pair *pair, int of, double start,
                     double end, double *least) {
    const double length = (end - start) / (double)GMI_ELASTIC_CELLS;
    table->start = start;
    table->per_cell = 1.0 / length;
    table->last = (double)(GMI_ELASTIC_CELLS + 1);

    /* One cell after the other, each from the node behind it. */
    table_node from = {{0.0, 0.0}, {0.0, 0.0}}, to;
    int fault = find_any_node(pair, of, start, &from);
    hold_cell(&table->cell[0], &from);
    *least = from.value[0];
    for (int k = 0; k < GMI_ELASTIC_CELLS && fault == GMI_TOOTH_FINE; ++k) {
        fault = find_any_node(pair, of, start + length * (double)(k + 1), &to);
        if (fault == GMI_TOOTH_FINE) {
            set_cell(&table->cell[k + 1], &from, &to, length);
            *least = fmin(*least, to.value[0]);
            from = to;
        }
    }
    hold_cell(&table->cell[GMI_ELASTIC_CELLS + 1], &from);
    return fault;
}

/* squared(z_m) of each element over its length, and its mass. */
static void add_element(gmi_elastic_layer *layer, int k, double length, double squared) {
    const double mass = length / 6.0;
    const double coupling = squared / length;
    layer->diagonal[k] += 2.0 * mass + coupling;
    layer->diagonal[k + 1] += 2.0 * mass + coupling;
    layer->beside[k] = mass - coupling;
}

/* Diagonals that remain of the nodes on one side. */
static void set_tails(gmi_elastic_layer *layer, int stations) {
    const int last = stations - 1;
    layer->left[0] = layer->diagonal[0];
    layer->right[last] = layer->diagonal[last];
    for (int k = 1; k <= last; ++k) {
        const double beside = layer->beside[k - 1];
        layer->left[k] = layer->diagonal[k] - beside * beside / layer->left[k - 1];
    }
    for (int k = last - 1; k >= 0; --k) {
        const double beside = layer->beside[k];
        layer->right[k] = layer->diagonal[k] - beside * beside / layer->right[k + 1];
    }
}

void gmi_elastic_divide(gmi_elastic *law, double normal_module, double helix_angle, int stations) {
    law->stations = stations;
    law->spacing = law->face_width / (double)(stations - 1);
    law->per_spacing = 1.0 / law->spacing;

    /* The layers on them. */
    const double m_n = normal_module;
    const double cosine = cos(helix_angle);
    const double along_tooth = GMI_ELASTIC_TOOTH_LENGTH * m_n * cosine;
    const double along_rim = GMI_ELASTIC_RIM_LENGTH * m_n * cosine;
    const double per_rim = 1.0 / law->rim_compliance;

    for (int k = 0; k < law->stations; ++k) {
        law->tooth.diagonal[k] = law->tooth.beside[k] = 0.0;
        law->rim.diagonal[k] = law->rim.beside[k] = 0.0;
    }
    for (int k = 0; k < law->stations - 1; ++k) {
        /* Softer towards the ends of the face, where the tooth has no neighbour. */
        const double middle = law->spacing * ((double)k + 0.5);
        const double from_end = fmin(middle, law->face_width - middle) / cosine;
        const double softening =
            GMI_ELASTIC_END_SOFTENING * exp(-from_end / (GMI_ELASTIC_END_LENGTH * m_n));
        add_element(&law->tooth, k, law->spacing, along_tooth * along_tooth * (1.0 - softening));
        add_element(&law->rim, k, law->spacing, along_rim * along_rim);
    }

    /* The rim is as stiff all along the face. */
    for (int k = 0; k < law->stations; ++k) {
        law->rim.diagonal[k] *= per_rim;
        law->rim.beside[k] *= per_rim;
    }

    set_tails(&law->tooth, law->stations);
    set_tails(&law->rim, law->stations);
}

int gmi_elastic_init(gmi_elastic *law, const gmi_elastic_params *params,
                     const double contact_start[2], int *fault, int *wheel) {
    *fault = GMI_TOOTH_FINE;
    *wheel = 0;
    if (!check(params)) {
        return GM_ERR_PARAMETER;
    }
    law->lines_max = params->lines;
    law->creases_max = 0;
    law->is_wide = gmi_processor_is_wide();
    law->face_width = params->face_width;

    /* Contact and rim in the transverse measure: normal compliances count 1 / cos(beta_b). */
    const double cosine = cos(params->base_helix_angle);
    const double first = half_plane(&params->gear[0]), second = half_plane(&params->gear[1]);
    const double mean = 0.5 * (first + second);
    law->hertz_compliance = mean / cosine;
    law->rim_compliance =
        GMI_ELASTIC_RIM_SHARE *
        (1.0 / params->gear[0].youngs_modulus + 1.0 / params->gear[1].youngs_modulus) / cosine;
    gmi_elastic_divide(law, params->normal_module, params->helix_angle, params->stations);

    /* The tables of both gears. */
    tooth_pair pair = {.share = {first / mean, second / mean},
                       .cosine = cosine,
                       .rim = law->rim_compliance,
                       .action = params->line_of_action};
    law->line_of_action = params->line_of_action;
    for (int g = 0; g < 2; ++g) {
        const gmi_elastic_gear_params *gear = &params->gear[g];
        const gmi_tooth_params data = tooth_params(params, gear);
        *wheel = g;

        *fault = gmi_tooth_init(&pair.tooth[g], &data);
        const double fillet_end = cosine * pair.tooth[g].fillet_roll_length;
        if (*fault == GMI_TOOTH_FINE && contact_start[g] < fillet_end - 1e-9 * fabs(fillet_end)) {
            *fault = GMI_TOOTH_CONTACT;
        }

        if (*fault == GMI_TOOTH_FINE) {
            *fault = set_table(&law->gear[g], &pair, g, gear->start_roll_length,
                               gear->tip_roll_length, &law->least_compliance[g]);
        }
        if (*fault != GMI_TOOTH_FINE) {
            return GM_ERR_GEOMETRY;
        }
    }
    if (!(law->least_compliance[0] + law->least_compliance[1] > law->rim_compliance)) {
        return GM_ERR_GEOMETRY;
    }

    /* That of the pair, where both gears have profiles. */
    const double lower = fmax(params->gear[0].start_roll_length,
                              params->line_of_action - params->gear[1].tip_roll_length);
    const double upper = fmin(params->gear[0].tip_roll_length,
                              params->line_of_action - params->gear[1].start_roll_length);
    double least;
    *fault = lower < upper ? set_table(&law->pair, &pair, OF_BOTH, lower, upper, &least)
                           : GMI_TOOTH_CONTACT;
    return *fault == GMI_TOOTH_FINE ? GM_OK : GM_ERR_GEOMETRY;
}
