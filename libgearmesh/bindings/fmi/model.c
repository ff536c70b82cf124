/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failed(fmu_instance *instance, const char *reason) {
    if (reason != instance->message) {
        snprintf(instance->message, sizeof instance->message, "%s", reason);
    }
    instance->log(instance, instance->message);
    return -1;
}

void fmu_defaults(fmu_values *values) {
    memset(values, 0, sizeof *values);
    gm_pair_params_default(&values->pair);
    gm_mesh_params_default(&values->mesh);
    values->double_helical_gap = NAN;

    /* What a drawing has to give is that of the paper's gears, so that the FMU runs as it is. */
    values->pair.pinion_teeth = 45;
    values->pair.wheel_teeth = 41;
    values->pair.normal_module = 1.65e-3;
    values->pair.normal_pressure_angle = 0.27925268031909273;
    values->pair.helix_angle = 0.57595865315812877;
    values->pair.center_distance = 0.085;
    values->pair.face_width = 0.0175;
    values->pair.backlash = 100e-6;
    values->mesh.stiffness = 1.05e8;
    values->mesh.damping = 844.361;
    values->pinion_inertia = 2.1e-3;
    values->wheel_inertia = 2.1e-3;
    values->tolerance = 1e-6;
}

static char *copy_of(const char *text) {
    char *copy = malloc(strlen(text) + 1);
    return copy != NULL ? strcpy(copy, text) : NULL;
}

fmu_instance *fmu_new(const char *name, const char *resources) {
    fmu_instance *instance = calloc(1, sizeof *instance);
    if (instance == NULL) {
        return NULL;
    }
    fmu_defaults(&instance->values);
    instance->name = copy_of(name);
    instance->resources = copy_of(resources);
    if (instance->name == NULL || instance->resources == NULL) {
        fmu_free(instance);
        return NULL;
    }
    return instance;
}

/* What follows from the parameters is forgotten. */
static void discard(fmu_instance *instance) {
    fmu_integrator_free(instance->integrator);
    instance->integrator = NULL;
    file_mesh_free(&instance->made);
    instance->is_prepared = 0;
    instance->is_evaluated = 0;
}

void fmu_free(fmu_instance *instance) {
    if (instance == NULL) {
        return;
    }
    discard(instance);
    free(instance->name);
    free(instance->resources);
    free(instance);
}

void fmu_reset(fmu_instance *instance) {
    discard(instance);
    fmu_defaults(&instance->values);
}

/* ---------------------------------------------------------------------------------------------
 * Preparation
 * ------------------------------------------------------------------------------------------- */

/* Where a file lies: in the resources unless its path is absolute; "" for none. */
static int locate(fmu_instance *instance, const char *given, char path[2 * TEXT_SIZE]) {
    const int is_absolute =
        given[0] == '/' || given[0] == '\\' || (given[0] != '\0' && given[1] == ':');
    const int length = snprintf(path, 2 * TEXT_SIZE, "%s%s",
                                is_absolute || given[0] == '\0' ? "" : instance->resources, given);
    if (length < 0 || length >= 2 * TEXT_SIZE) {
        return failed(instance, "the path of a file of flanks is too long");
    }
    return 0;
}

static int prepare(fmu_instance *instance) {
    const fmu_values *values = &instance->values;
    discard(instance);
    if (!(values->pinion_inertia > 0.0) || !(values->wheel_inertia > 0.0)) {
        return failed(instance, "pinion_inertia, wheel_inertia: must be above 0");
    }
    if (!(values->tolerance >= 1e-14 && values->tolerance <= 0.1)) {
        return failed(instance, "relative_tolerance: must be 1e-14 .. 0.1");
    }

    char path[TEXTS][2 * TEXT_SIZE];
    for (int file = 0; file < TEXTS; ++file) {
        if (locate(instance, values->text[file], path[file]) != 0) {
            return -1;
        }
    }
    const file_mesh_params params = {.pair = values->pair,
                                     .law = values->mesh,
                                     .gap = values->double_helical_gap,
                                     .files = {{{path[0], path[2]}, {path[1], path[3]}},
                                               {{path[4], path[6]}, {path[5], path[7]}}}};
    if (file_mesh_init(&instance->made, &params, instance->message, sizeof instance->message) !=
        0) {
        return failed(instance, instance->message);
    }
    instance->is_prepared = 1;
    return 0;
}

/* ---------------------------------------------------------------------------------------------
 * Evaluation
 * ------------------------------------------------------------------------------------------- */

/* The mesh at the values as they are; what the model says of them with its Jacobian unless that is NULL. */
static int evaluate(fmu_instance *instance, fmu_jacobian *jacobian) {
    if (!instance->is_prepared && prepare(instance) != 0) {
        return -1;
    }
    const int status = model.evaluate(&instance->values, &instance->made, 1, jacobian);
    if (status != GM_OK) {
        failed(instance, gm_status_text(status));
        return status;
    }
    instance->is_evaluated = 1;
    return 0;
}

int fmu_evaluate(fmu_instance *instance) {
    return instance->is_evaluated ? 0 : evaluate(instance, NULL);
}

int fmu_events(fmu_instance *instance) {
    const int status = fmu_evaluate(instance);
    fmu_values *values = &instance->values;
    const int drive = values->indicator[GM_DRIVE] > 0.0;
    const int coast = values->indicator[GM_COAST] > 0.0;
    values->contact = drive && coast ? 2 : drive - coast;
    return status;
}

static size_t size_of(int kind) {
    return kind == KIND_REAL ? sizeof(double) : sizeof(int);
}

/* Address of a variable of that kind; NULL if there is none. */
static void *address_of(fmu_instance *instance, unsigned reference, int kind) {
    if (reference >= (unsigned)model.variable_count ||
        (int)model.variables[reference].kind != kind) {
        return NULL;
    }
    return (char *)&instance->values + model.variables[reference].offset;
}

static int get(fmu_instance *instance, unsigned reference, int kind, void *value) {
    const void *address = address_of(instance, reference, kind);
    if (address == NULL) {
        return failed(instance, "there is no variable of this kind with this value reference");
    }
    const int role = (int)model.variables[reference].role;
    const int is_computed =
        role == ROLE_DERIVATIVE || role == ROLE_OUTPUT || role == ROLE_INDICATOR;
    const int status = is_computed ? fmu_evaluate(instance) : 0;
    memcpy(value, address, size_of(kind));
    return status;
}

int fmu_get(fmu_instance *instance, const unsigned *references, size_t count, int kind,
            void *values) {
    int status = 0;
    for (size_t k = 0; k < count && status == 0; ++k) {
        status = get(instance, references[k], kind, (char *)values + k * size_of(kind));
    }
    return status;
}

static int set(fmu_instance *instance, unsigned reference, int kind, const void *value) {
    void *address = address_of(instance, reference, kind);
    if (address == NULL) {
        return failed(instance, "there is no variable of this kind with this value reference");
    }
    const size_t size = size_of(kind);
    const int role = (int)model.variables[reference].role;
    if (role != ROLE_PARAMETER && role != ROLE_INPUT && role != ROLE_STATE &&
        role != ROLE_STATE_OUTPUT) {
        return failed(instance, "this variable cannot be set");
    }

    /* An input that stays what it was lets the integration go on. */
    if (memcmp(address, value, size) != 0) {
        memcpy(address, value, size);
        instance->is_evaluated = 0;
        fmu_integrator_free(instance->integrator);
        instance->integrator = NULL;
        if (role == ROLE_PARAMETER) {
            instance->is_prepared = 0;
        }
    }
    return 0;
}

int fmu_set(fmu_instance *instance, const unsigned *references, size_t count, int kind,
            const void *values) {
    int status = 0;
    for (size_t k = 0; k < count && status == 0; ++k) {
        status = set(instance, references[k], kind, (const char *)values + k * size_of(kind));
    }
    return status;
}

int fmu_get_texts(fmu_instance *instance, const unsigned *references, size_t count,
                  const char **texts) {
    for (size_t k = 0; k < count; ++k) {
        texts[k] = address_of(instance, references[k], KIND_STRING);
        if (texts[k] == NULL) {
            return failed(instance, "there is no text with this value reference");
        }
    }
    return 0;
}

static int set_text(fmu_instance *instance, unsigned reference, const char *text) {
    char *address = address_of(instance, reference, KIND_STRING);
    if (address == NULL || text == NULL) {
        return failed(instance, "there is no text with this value reference");
    }
    if (strlen(text) >= TEXT_SIZE) {
        return failed(instance, "the name of a file is too long");
    }
    memset(address, 0, TEXT_SIZE);
    strcpy(address, text);
    instance->is_prepared = 0;
    instance->is_evaluated = 0;
    return 0;
}

int fmu_set_texts(fmu_instance *instance, const unsigned *references, size_t count,
                  const char *const *texts) {
    int status = 0;
    for (size_t k = 0; k < count && status == 0; ++k) {
        status = set_text(instance, references[k], texts[k]);
    }
    return status;
}

void fmu_set_states(fmu_instance *instance, const double *states) {
    memcpy(instance->values.state, states, (size_t)model.states * sizeof(double));
    instance->is_evaluated = 0;
}

int fmu_save(const fmu_values *values, void **copy) {
    if (*copy == NULL) {
        *copy = malloc(sizeof *values);
    }
    if (*copy == NULL) {
        return -1;
    }
    memcpy(*copy, values, sizeof *values);
    return 0;
}

void fmu_restore(fmu_instance *instance, const fmu_values *values) {
    /* The mesh stays if the parameters, which stand first, are the same. */
    if (memcmp(values, &instance->values, offsetof(fmu_values, time)) != 0) {
        discard(instance);
    }
    fmu_integrator_free(instance->integrator);
    instance->integrator = NULL;
    instance->values = *values;
    instance->is_evaluated = 0;
}

int fmu_step(fmu_instance *instance, double end) {
    if (model.states > 0) {
        if (!instance->is_prepared && prepare(instance) != 0) {
            return -1;
        }
        const int status = fmu_integrate(instance, end);
        if (status != 0) {
            failed(instance, status > 0 ? gm_status_text(status) : "the integration failed");
            return -1;
        }
    }
    instance->values.time = end;
    instance->is_evaluated = 0;
    return fmu_events(instance) == 0 ? 0 : -1;
}

/* The number of a variable within an array of fmu_values. */
static int index_in(const fmu_variable *variable, size_t array) {
    return (int)((variable->offset - array) / sizeof(double));
}

/* Row of the Jacobian that belongs to a variable, -1 = none: derivatives of the states, then outputs. */
static int row_of(unsigned reference) {
    const fmu_variable *variable = &model.variables[reference];
    switch (variable->role) {
    case ROLE_DERIVATIVE:
        return variable->state;
    case ROLE_OUTPUT:
        return model.states + index_in(variable, offsetof(fmu_values, output));
    default:
        return -1;
    }
}

/* Column likewise: states, then inputs. */
static int column_of(unsigned reference) {
    const fmu_variable *variable = &model.variables[reference];
    switch (variable->role) {
    case ROLE_STATE:
    case ROLE_STATE_OUTPUT:
        return index_in(variable, offsetof(fmu_values, state));
    case ROLE_INPUT:
        return model.states + index_in(variable, offsetof(fmu_values, input));
    default:
        return -1;
    }
}

/* A step of a variable for differences: flanks move by about a nanometre, or some um/s, far beyond rounding. */
static double step_of(const fmu_variable *variable) {
    static const struct {
        const char *unit;
        double step;
    } steps[] = {{"rad", 1e-8}, {"m", 1e-9}, {"rad/s", 1e-4}, {"m/s", 1e-6}};
    for (size_t k = 0; k < sizeof steps / sizeof steps[0]; ++k) {
        if (strcmp(variable->unit, steps[k].unit) == 0) {
            return steps[k].step;
        }
    }
    return 1e-6;
}

/* Outputs by a state or an input, where the model does not know, by central differences. */
static int differences(const fmu_instance *instance, int column, unsigned reference,
                       fmu_jacobian *jacobian) {
    fmu_values aside[2] = {instance->values, instance->values};
    const double step = step_of(&model.variables[reference]);

    /* The outputs a step below and a step above. */
    for (int side = 0; side < 2; ++side) {
        double *place = column < model.states ? &aside[side].state[column]
                                              : &aside[side].input[column - model.states];
        *place += side == 0 ? -step : step;
        const int status = model.evaluate(&aside[side], &instance->made, 1, NULL);
        if (status != GM_OK) {
            return status;
        }
    }

    /* Only where the model has left a gap. */
    for (int output = 0; output < model.outputs; ++output) {
        double *by = &jacobian->by[model.states + output][column];
        if (isnan(*by)) {
            *by = (aside[1].output[output] - aside[0].output[output]) / (2.0 * step);
        }
    }
    return GM_OK;
}

int fmu_directional(fmu_instance *instance, const unsigned *unknown, size_t unknown_count,
                    const unsigned *known, size_t known_count, const double *seed,
                    double *sensitivity) {
    for (size_t k = 0; k < unknown_count + known_count; ++k) {
        if ((k < unknown_count ? unknown[k] : known[k - unknown_count]) >=
            (unsigned)model.variable_count) {
            return failed(instance, "there is no variable with this value reference");
        }
    }

    /* All derivatives that the model knows, and those by the wanted states and inputs that it does not. */
    fmu_jacobian jacobian;
    memset(&jacobian, 0, sizeof jacobian);
    int status = evaluate(instance, &jacobian);
    for (size_t i = 0; i < known_count && status == GM_OK; ++i) {
        const int column = column_of(known[i]);
        if (column >= 0) {
            status = differences(instance, column, known[i], &jacobian);
        }
    }

    /* A state that is an output too changes with itself. */
    for (size_t k = 0; k < unknown_count; ++k) {
        sensitivity[k] = 0.0;
        const int row = row_of(unknown[k]);
        for (size_t i = 0; i < known_count; ++i) {
            const int column = column_of(known[i]);
            if (column >= 0 && row >= 0) {
                sensitivity[k] += jacobian.by[row][column] * seed[i];
            } else if (unknown[k] == known[i]) {
                sensitivity[k] += seed[i];
            }
        }
    }
    return status;
}
