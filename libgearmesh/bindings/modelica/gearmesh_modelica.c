/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "gearmesh_modelica.h"

#include "file_mesh.h"
#include "parameter_places.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the tool [Modelica specification, utility functions]; does not return. */
void ModelicaError(const char *text);

enum { MESSAGE_SIZE = 1200 };

/* Beyond every range of a parameter: not given. */
static const double derived = 1e60;

/* Values that are given; the others stay what they are, the defaults. */
static void fill(void *params, const parameter_place *places, const double *values, size_t count) {
    for (size_t k = 0; k < count; ++k) {
        if (!(values[k] >= derived)) { /* NaN is for the library to refuse */
            parameter_set(params, &places[k], values[k]);
        }
    }
}

static void need(int condition, const char *what) {
    if (!condition) {
        ModelicaError(what);
    }
}

static void check(int status) {
    if (status != GM_OK) {
        ModelicaError(gm_status_text(status));
    }
}

void *gearmesh_modelica_new(const double *pair, size_t pair_size, const double *law,
                            size_t law_size, double gap, const char *pinion_flanks,
                            const char *pinion_pitch, const char *wheel_flanks,
                            const char *wheel_pitch, const char *pinion_second_half,
                            const char *pinion_second_half_pitch, const char *wheel_second_half,
                            const char *wheel_second_half_pitch) {
    need(pair_size == PAIR_PLACES && law_size == LAW_PLACES,
         "GearMesh: package and library must be of one version");

    file_mesh_params params = {
        .gap = gap >= derived ? NAN : gap,
        .files = {{{pinion_flanks, wheel_flanks}, {pinion_pitch, wheel_pitch}},
                  {{pinion_second_half, wheel_second_half},
                   {pinion_second_half_pitch, wheel_second_half_pitch}}}};
    gm_pair_params_default(&params.pair);
    gm_mesh_params_default(&params.law);
    fill(&params.pair, pair_places, pair, pair_size);
    fill(&params.law, law_places, law, law_size);

    /* Nothing is held any more when the tool takes over. */
    char message[MESSAGE_SIZE] = "out of memory";
    file_mesh *object = malloc(sizeof *object);
    if (object == NULL || file_mesh_init(object, &params, message, sizeof message) != 0) {
        free(object);
        ModelicaError(message);
    }
    return object;
}

void gearmesh_modelica_free(void *object) {
    if (object != NULL) {
        file_mesh_free(object);
        free(object);
    }
}

void gearmesh_modelica_base_radii(void *object, double *radii, size_t size) {
    const gm_pair *pair = file_mesh_pair(object);
    need(size == 2, "GearMesh: two radii");
    radii[0] = pair->pinion.base_radius;
    radii[1] = pair->wheel.base_radius;
}

static void evaluate(const file_mesh *made, const double *state, size_t size, int wanted,
                     gm_mesh_result *result) {
    need(size == 4, "GearMesh: the state must be two angles and two speeds");
    const gm_state at = {state[0], state[1], state[2], state[3]};
    gm_position position;
    file_mesh_float floated;
    check(gm_position_from_state(file_mesh_pair(made), &at, &position));
    check(file_mesh_evaluate(made, &position, wanted, &floated, result));
}

void gearmesh_modelica_evaluate(void *object, const double *state, size_t state_size,
                                double *result, size_t result_size) {
    gm_mesh_result found;
    need(result_size == 3, "GearMesh: the result must be two torques and a force");
    evaluate(object, state, state_size, GM_WANT_FORCE, &found);
    result[0] = found.pinion_torque;
    result[1] = found.wheel_torque;
    result[2] = found.force;
}

void gearmesh_modelica_evaluate_der(void *object, const double *state, size_t state_size,
                                    const double *state_rate, size_t rate_size, double *result_rate,
                                    size_t result_size) {
    gm_mesh_result found;
    need(rate_size == 4 && result_size == 3, "GearMesh: sizes of the derivatives");
    evaluate(object, state, state_size, GM_WANT_DERIVATIVES, &found);

    const gm_gradient *by[3] = {&found.pinion_torque_by, &found.wheel_torque_by, &found.force_by};
    for (int k = 0; k < 3; ++k) {
        result_rate[k] = by[k]->pinion_angle * state_rate[0] + by[k]->wheel_angle * state_rate[1] +
                         by[k]->pinion_speed * state_rate[2] + by[k]->wheel_speed * state_rate[3];
    }
}

void gearmesh_modelica_loads(void *object, const double *pinion, size_t pinion_size,
                             const double *wheel, size_t wheel_size, double *loads,
                             size_t loads_size) {
    const file_mesh *made = object;
    gm_body bodies[2];
    gm_load on[2];
    gm_mesh_result found;
    need(pinion_size * sizeof(double) == sizeof(gm_body) && wheel_size == pinion_size &&
             loads_size * sizeof(double) == sizeof on,
         "GearMesh: a body must have 18 numbers");

    need(made->halves == 1,
         "GearMesh: double-helical gears between bodies must be two meshes of opposite hand");

    /* The structs are plain numbers in the order of the arrays. */
    memcpy(&bodies[0], pinion, sizeof bodies[0]);
    memcpy(&bodies[1], wheel, sizeof bodies[1]);
    check(gm_mesh_evaluate_bodies(made->mesh[0], &bodies[0], &bodies[1], GM_WANT_FORCE,
                                  made->workspace[0], &found, &on[0], &on[1]));
    memcpy(loads, on, sizeof on);
}

double gearmesh_modelica_static_offset(void *object, double pinion_angle, double wheel_torque) {
    double offset;
    check(file_mesh_equilibrium(object, pinion_angle, 0.0, wheel_torque, &offset));
    return offset;
}
