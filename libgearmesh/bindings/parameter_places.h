/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file parameter_places.h
 * The numbers of gm_pair_params and gm_mesh_params as lists, in the order of gearmesh.h. The lists are made from the header
 * by modelica/generate.py.
 */
#ifndef PARAMETER_PLACES_H
#define PARAMETER_PLACES_H

#include <gearmesh/gearmesh.h>
#include <stddef.h>
#include <string.h>

/** Where a number stands in its struct. */
typedef struct parameter_place {
    size_t offset;
    int is_integer;
} parameter_place;

#define REAL(type, field)                                                                          \
    { offsetof(type, field), 0 }
#define INTEGER(type, field)                                                                       \
    { offsetof(type, field), 1 }
static const parameter_place pair_places[] = {
#include "pair_parameters.inc"
};
static const parameter_place law_places[] = {
#include "mesh_parameters.inc"
};
#undef REAL
#undef INTEGER

enum {
    PAIR_PLACES = sizeof pair_places / sizeof pair_places[0],
    LAW_PLACES = sizeof law_places / sizeof law_places[0]
};

/** Sets one number of a struct of parameters. */
static void parameter_set(void *params, const parameter_place *place, double value) {
    char *field = (char *)params + place->offset;
    if (place->is_integer) {
        const int integer = (int)value;
        memcpy(field, &integer, sizeof integer);
    } else {
        memcpy(field, &value, sizeof value);
    }
}

#endif /* PARAMETER_PLACES_H */
