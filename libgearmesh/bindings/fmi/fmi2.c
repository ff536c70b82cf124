/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* FMI 2.0: each call handed on to model.c. What is not here is refused: generate.py. */
#include "model.h"

#include <fmi2Functions.h>
#include <stdlib.h>
#include <string.h>

static void log_message(fmu_instance *instance, const char *message) {
    const fmi2CallbackFunctions *callbacks = instance->environment;
    if (callbacks->logger != NULL) {
        callbacks->logger(callbacks->componentEnvironment, instance->name, fmi2Error,
                          "logStatusError", "%s", message);
    }
}

/* A state that is refused is discarded: the environment may try a smaller step. */
static fmi2Status status_of(int status) {
    return status == 0 ? fmi2OK : status > 0 ? fmi2Discard : fmi2Error;
}

/* A folder from its URI, with a slash at its end: file:///a%20b is /a b/; as it is if it is no URI. */
static char *folder_of(const char *uri) {
    char *folder = malloc(strlen(uri) + 2);
    if (folder == NULL) {
        return NULL;
    }
    if (strncmp(uri, "file://", 7) == 0) {
        uri += 7;
    } else if (strncmp(uri, "file:", 5) == 0) {
        uri += 5;
    }
    if (uri[0] == '/' && uri[1] != '\0' && uri[2] == ':') {
        ++uri; /* the letter of a drive */
    }

    char *end = folder;
    for (; *uri != '\0'; ++uri) {
        const char digits[3] = {uri[0] == '%' ? uri[1] : '\0',
                                uri[0] == '%' && uri[1] != '\0' ? uri[2] : '\0', '\0'};
        char *behind;
        const long code = strtol(digits, &behind, 16);
        if (digits[0] != '\0' && behind == digits + 2) {
            *end = (char)code;
            uri += 2;
        } else {
            *end = *uri;
        }
        ++end;
    }
    if (end == folder || end[-1] != '/') {
        *end = '/';
        ++end;
    }
    *end = '\0';
    return folder;
}

const char *fmi2GetTypesPlatform(void) {
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void) {
    return fmi2Version;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean logging) {
    (void)type;
    (void)visible;
    (void)logging;
    if (functions == NULL || name == NULL || guid == NULL || strcmp(guid, FMU_TOKEN) != 0) {
        return NULL;
    }
    char *folder = folder_of(resources != NULL ? resources : "");
    fmu_instance *instance = folder != NULL ? fmu_new(name, folder) : NULL;
    free(folder);
    if (instance != NULL) {
        instance->environment = (void *)functions;
        instance->log = log_message;
    }
    return instance;
}

void fmi2FreeInstance(fmi2Component instance) {
    fmu_free(instance);
}

fmi2Status fmi2SetDebugLogging(fmi2Component instance, fmi2Boolean on, size_t count,
                               const fmi2String categories[]) {
    (void)instance;
    (void)on;
    (void)count;
    (void)categories;
    return fmi2OK;
}

fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean has_tolerance,
                               fmi2Real tolerance, fmi2Real start, fmi2Boolean has_stop,
                               fmi2Real stop) {
    (void)has_stop;
    (void)stop;
    fmu_instance *instance = component;
    instance->values.time = start;
    if (has_tolerance && tolerance > 0.0) {
        instance->values.tolerance = tolerance;
    }
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component instance) {
    (void)instance;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component instance) {
    return status_of(fmu_events(instance));
}

fmi2Status fmi2Terminate(fmi2Component instance) {
    (void)instance;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component instance) {
    fmu_reset(instance);
    return fmi2OK;
}

/* Values. */

fmi2Status fmi2GetReal(fmi2Component instance, const fmi2ValueReference references[], size_t count,
                       fmi2Real values[]) {
    return status_of(fmu_get(instance, references, count, KIND_REAL, values));
}

fmi2Status fmi2GetInteger(fmi2Component instance, const fmi2ValueReference references[],
                          size_t count, fmi2Integer values[]) {
    return status_of(fmu_get(instance, references, count, KIND_INTEGER, values));
}

fmi2Status fmi2GetString(fmi2Component instance, const fmi2ValueReference references[],
                         size_t count, fmi2String values[]) {
    return status_of(fmu_get_texts(instance, references, count, values));
}

fmi2Status fmi2SetReal(fmi2Component instance, const fmi2ValueReference references[], size_t count,
                       const fmi2Real values[]) {
    return status_of(fmu_set(instance, references, count, KIND_REAL, values));
}

fmi2Status fmi2SetInteger(fmi2Component instance, const fmi2ValueReference references[],
                          size_t count, const fmi2Integer values[]) {
    return status_of(fmu_set(instance, references, count, KIND_INTEGER, values));
}

fmi2Status fmi2SetString(fmi2Component instance, const fmi2ValueReference references[],
                         size_t count, const fmi2String values[]) {
    return status_of(fmu_set_texts(instance, references, count, values));
}

/* States of the FMU: a copy of its values. */

fmi2Status fmi2GetFMUstate(fmi2Component component, fmi2FMUstate *state) {
    const fmu_instance *instance = component;
    return status_of(fmu_save(&instance->values, state));
}

fmi2Status fmi2SetFMUstate(fmi2Component instance, fmi2FMUstate state) {
    fmu_restore(instance, state);
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component instance, fmi2FMUstate *state) {
    (void)instance;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component instance, fmi2FMUstate state, size_t *size) {
    (void)instance;
    (void)state;
    *size = sizeof(fmu_values);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component instance, fmi2FMUstate state, fmi2Byte bytes[],
                                 size_t size) {
    (void)instance;
    if (size < sizeof(fmu_values)) {
        return fmi2Error;
    }
    memcpy(bytes, state, sizeof(fmu_values));
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component instance, const fmi2Byte bytes[], size_t size,
                                   fmi2FMUstate *state) {
    (void)instance;
    return size == sizeof(fmu_values) ? status_of(fmu_save((const void *)bytes, state)) : fmi2Error;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component instance, const fmi2ValueReference unknown[],
                                        size_t unknown_count, const fmi2ValueReference known[],
                                        size_t known_count, const fmi2Real seed[],
                                        fmi2Real sensitivity[]) {
    return status_of(
        fmu_directional(instance, unknown, unknown_count, known, known_count, seed, sensitivity));
}

/* Model exchange. */

fmi2Status fmi2EnterEventMode(fmi2Component instance) {
    (void)instance;
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component instance, fmi2EventInfo *info) {
    info->newDiscreteStatesNeeded = fmi2False;
    info->terminateSimulation = fmi2False;
    info->nominalsOfContinuousStatesChanged = fmi2False;
    info->valuesOfContinuousStatesChanged = fmi2False;
    info->nextEventTimeDefined = fmi2False;
    return status_of(fmu_events(instance));
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component instance) {
    (void)instance;
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component instance, fmi2Boolean no_state_before,
                                       fmi2Boolean *event_mode, fmi2Boolean *terminate) {
    (void)instance;
    (void)no_state_before;
    *event_mode = fmi2False;
    *terminate = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component component, fmi2Real time) {
    fmu_instance *instance = component;
    instance->values.time = time;
    return fmi2OK;
}

fmi2Status fmi2SetContinuousStates(fmi2Component component, const fmi2Real states[], size_t count) {
    fmu_instance *instance = component;
    if (count != (size_t)model.states) {
        return fmi2Error;
    }
    fmu_set_states(instance, states);
    return fmi2OK;
}

fmi2Status fmi2GetDerivatives(fmi2Component component, fmi2Real derivatives[], size_t count) {
    fmu_instance *instance = component;
    if (count != (size_t)model.states) {
        return fmi2Error;
    }
    const int status = fmu_evaluate(instance);
    memcpy(derivatives, instance->values.derivative, count * sizeof(double));
    return status_of(status);
}

fmi2Status fmi2GetEventIndicators(fmi2Component component, fmi2Real indicators[], size_t count) {
    fmu_instance *instance = component;
    if (count != INDICATORS) {
        return fmi2Error;
    }
    const int status = fmu_evaluate(instance);
    memcpy(indicators, instance->values.indicator, count * sizeof(double));
    return status_of(status);
}

fmi2Status fmi2GetContinuousStates(fmi2Component component, fmi2Real states[], size_t count) {
    const fmu_instance *instance = component;
    if (count != (size_t)model.states) {
        return fmi2Error;
    }
    memcpy(states, instance->values.state, count * sizeof(double));
    return fmi2OK;
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component component, fmi2Real nominals[],
                                             size_t count) {
    (void)component;
    if (count != (size_t)model.states) {
        return fmi2Error;
    }
    fmu_nominals(nominals);
    return fmi2OK;
}

/* Co-simulation. */

fmi2Status fmi2DoStep(fmi2Component instance, fmi2Real time, fmi2Real step,
                      fmi2Boolean no_state_before) {
    (void)no_state_before;
    return status_of(fmu_step(instance, time + step));
}

fmi2Status fmi2GetRealStatus(fmi2Component component, const fmi2StatusKind kind, fmi2Real *value) {
    const fmu_instance *instance = component;
    *value = instance->values.time;
    return kind == fmi2LastSuccessfulTime ? fmi2OK : fmi2Discard;
}
