/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * How many stations along the face elastic teeth need.
 *
 * A tooth deflects over the length l of its layer from where a line of contact ends in the path. Elements of the length h
 * that are long against l, on lines that are short, leave an error of the transmission error: at its worst position some
 * 0.04 h^2 / (l s), s the length of a line across the path, along the face. The form follows from linear elements, whose
 * error falls with h^2, and one end per line; the factor was measured on random pairs: docs/elastic.md.
 */
#include "elastic.h"
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
