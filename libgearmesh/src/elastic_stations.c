/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * How many stations along the face elastic teeth need.
 *
 * A tooth deflects over the length l of its layer from where a line of contact ends in the path. Elements of the length h
 * that are long against l, on lines that are short, leave an error of the transmission error: at its worst position some
 * 0.04 h^2 / (l s), s the length of a line across the path, along the face. The form follows from linear elements, whose
 * error falls with h^2, and one end per line; the factor was measured on random pairs: docs/elastic.md.
 *
 * Where modifications are a multiple of what teeth give way by, lines bear on a part of themselves and end between stations,
 * where the flanks part: more elements are needed, by factors that were measured as well.
 */
#include "elastic.h"
#include "elastic_mesh.h"
#include "flank.h"
#include "gearmesh/gearmesh.h"
#include "internal.h"

#include <math.h>

enum {
    USUAL = 17 /* of gears that need no more: lines without an end in the path, among others */
};

/* Up to 2.2 times the estimate is left where a face is hardly wider than lines are long: 0.4 %. */
static const double wanted_error = 0.0018;

/* Of two stations: that of others falls with the square of the number of their elements. */
static double error_of_one_element(const gm_pair *pair) {
    const double decay = GMI_ELASTIC_TOOTH_LENGTH * pair->normal_module * cos(pair->helix_angle);
    const double path = pair->path_end - pair->path_start;
    return 0.04 * pair->face_width * fabs(pair->face_advance) / (decay * path);
}

double gm_elastic_stations_error(const gm_pair *pair, int stations) {
    if (pair == NULL || stations < 2) {
        return gmi_nan();
    }
    const double elements = stations - 1;
    return error_of_one_element(pair) / (elements * elements);
}

int gm_elastic_stations(const gm_pair *pair) {
    if (pair == NULL) {
        return 0;
    }

    /* What is no number stays with the usual ones. */
    const double wanted = ceil(sqrt(error_of_one_element(pair) / wanted_error)) + 1.0;
    if (!(wanted > USUAL)) {
        return USUAL;
    }
    return wanted < GMI_ELASTIC_STATIONS_MAX ? (int)wanted : GMI_ELASTIC_STATIONS_MAX;
}

/* ---------------------------------------------------------------------------------------------
 * Modified flanks
 * ------------------------------------------------------------------------------------------- */

/* How many quarters of the usual elements are needed: ratio of the deepest modification to what teeth give way by. */
static int quarters_of(double ratio) {
    static const struct {
        double above;
        int quarters;
    } rows[] = {{25.0, 16}, {6.0, 12}, {1.5, 8}, {0.3, 5}};
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        if (ratio > rows[k].above) {
            return rows[k].quarters;
        }
    }
    return 4;
}

static int refined(const gm_pair *pair, double ratio) {
    const int elements = (quarters_of(ratio) * (gm_elastic_stations(pair) - 1) + 3) / 4;
    return elements < GMI_ELASTIC_STATIONS_MAX ? elements + 1 : GMI_ELASTIC_STATIONS_MAX;
}

double gmi_elastic_usual_approach(const gm_mesh_params *params, double force_per_width) {
    return 5.0 * force_per_width *
           (1.0 / params->pinion_youngs_modulus + 1.0 / params->wheel_youngs_modulus);
}

double gmi_elastic_usual_force(const gm_mesh_params *params, const gm_pair *pair) {
    return isnan(params->reference_torque) ? 1e5 * pair->face_width
                                           : params->reference_torque / pair->wheel.base_radius;
}

int gm_elastic_stations_modified(const gm_pair *pair, const gm_mesh_params *params, double depth) {
    if (pair == NULL || params == NULL) {
        return 0;
    }
    const double force = gmi_elastic_usual_force(params, pair);
    return refined(pair,
                   depth / fabs(gmi_elastic_usual_approach(params, force / pair->face_width)));
}

int gmi_elastic_stations_of(const gm_mesh *mesh, double usual_approach) {
    double depth = 0.0;
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const gmi_tables *flanks[2] = {mesh->side[side].pinion, mesh->side[side].wheel};
        for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
            depth = fmax(depth, gmi_tables_depth(flanks[role]));
        }
    }
    return refined(mesh->pair, depth / fabs(usual_approach));
}
