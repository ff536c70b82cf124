/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* FMI 3.0: each call handed on to model.c. What is not here is refused: generate.py. */
#include "model.h"

#include <fmi3Functions.h>
#include <stdlib.h>
#include <string.h>

static void log_message(fmu_instance *instance, const char *message) {
    const fmi3LogMessageCallback log = (fmi3LogMessageCallback)instance->logger;
    if (log != NULL) {
        log(instance->environment, fmi3Error, "logStatusError", message);
    }
}

/* A state that is refused is discarded: the environment may try a smaller step. */
static fmi3Status status_of(int status) {
    return status == 0 ? fmi3OK : status > 0 ? fmi3Discard : fmi3Error;
}

const char *fmi3GetVersion(void) {
    return fmi3Version;
}

static fmi3Instance instantiate(fmi3String name, fmi3String token, fmi3String resources,
                                fmi3InstanceEnvironment environment, fmi3LogMessageCallback log) {
    if (name == NULL || token == NULL || strcmp(token, FMU_TOKEN) != 0) {
        return NULL;
    }
    fmu_instance *instance = fmu_new(name, resources != NULL ? resources : "");
    if (instance != NULL) {
        instance->environment = environment;
        instance->logger = (void (*)(void))log;
        instance->log = log_message;
    }
    return instance;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean logging,
                                          fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log) {
    (void)visible;
    (void)logging;
    return instantiate(name, token, resources, environment, log);
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                         fmi3Boolean visible, fmi3Boolean logging,
                                         fmi3Boolean event_mode, fmi3Boolean early_return,
                                         const fmi3ValueReference required[], size_t required_count,
                                         fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback intermediate) {
    (void)visible;
    (void)logging;
    (void)event_mode;
    (void)early_return;
    (void)required;
    (void)required_count;
    (void)intermediate;
    return instantiate(name, token, resources, environment, log);
}

void fmi3FreeInstance(fmi3Instance instance) {
    fmu_free(instance);
}

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean on, size_t count,
                               const fmi3String categories[]) {
    (void)instance;
    (void)on;
    (void)count;
    (void)categories;
    return fmi3OK;
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance component, fmi3Boolean has_tolerance,
                                       fmi3Float64 tolerance, fmi3Float64 start,
                                       fmi3Boolean has_stop, fmi3Float64 stop) {
    (void)has_stop;
    (void)stop;
    fmu_instance *instance = component;
    instance->values.time = start;
    if (has_tolerance && tolerance > 0.0) {
        instance->values.tolerance = tolerance;
    }
    return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) {
    return status_of(fmu_events(instance));
}

fmi3Status fmi3Terminate(fmi3Instance instance) {
    (void)instance;
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance instance) {
    fmu_reset(instance);
    return fmi3OK;
}

/* Values, all of them scalars. */

fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference references[],
                          size_t count, fmi3Float64 values[], size_t value_count) {
    return count == value_count ? status_of(fmu_get(instance, references, count, KIND_REAL, values))
                                : fmi3Error;
}

fmi3Status fmi3GetInt32(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                        fmi3Int32 values[], size_t value_count) {
    return count == value_count
               ? status_of(fmu_get(instance, references, count, KIND_INTEGER, values))
               : fmi3Error;
}

fmi3Status fmi3GetString(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                         fmi3String values[], size_t value_count) {
    return count == value_count ? status_of(fmu_get_texts(instance, references, count, values))
                                : fmi3Error;
}

fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference references[],
                          size_t count, const fmi3Float64 values[], size_t value_count) {
    return count == value_count ? status_of(fmu_set(instance, references, count, KIND_REAL, values))
                                : fmi3Error;
}

fmi3Status fmi3SetInt32(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                        const fmi3Int32 values[], size_t value_count) {
    return count == value_count
               ? status_of(fmu_set(instance, references, count, KIND_INTEGER, values))
               : fmi3Error;
}

fmi3Status fmi3SetString(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                         const fmi3String values[], size_t value_count) {
    return count == value_count ? status_of(fmu_set_texts(instance, references, count, values))
                                : fmi3Error;
}

/* States of the FMU: a copy of its values. */

fmi3Status fmi3GetFMUState(fmi3Instance component, fmi3FMUState *state) {
    const fmu_instance *instance = component;
    return status_of(fmu_save(&instance->values, state));
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state) {
    fmu_restore(instance, state);
    return fmi3OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *state) {
    (void)instance;
    free(*state);
    *state = NULL;
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state, size_t *size) {
    (void)instance;
    (void)state;
    *size = sizeof(fmu_values);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[],
                                 size_t size) {
    (void)instance;
    if (size < sizeof(fmu_values)) {
        return fmi3Error;
    }
    memcpy(bytes, state, sizeof(fmu_values));
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte bytes[], size_t size,
                                   fmi3FMUState *state) {
    (void)instance;
    return size == sizeof(fmu_values) ? status_of(fmu_save((const void *)bytes, state)) : fmi3Error;
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknown[],
                                        size_t unknown_count, const fmi3ValueReference known[],
                                        size_t known_count, const fmi3Float64 seed[],
                                        size_t seed_count, fmi3Float64 sensitivity[],
                                        size_t sensitivity_count) {
    if (seed_count != known_count || sensitivity_count != unknown_count) {
        return fmi3Error;
    }
    return status_of(
        fmu_directional(instance, unknown, unknown_count, known, known_count, seed, sensitivity));
}

/* Model exchange. */

fmi3Status fmi3EnterEventMode(fmi3Instance instance) {
    (void)instance;
    return fmi3OK;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *update,
                                    fmi3Boolean *terminate, fmi3Boolean *nominals,
                                    fmi3Boolean *states, fmi3Boolean *has_next, fmi3Float64 *next) {
    *update = fmi3False;
    *terminate = fmi3False;
    *nominals = fmi3False;
    *states = fmi3False;
    *has_next = fmi3False;
    *next = 0.0;
    return status_of(fmu_events(instance));
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance) {
    (void)instance;
    return fmi3OK;
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean no_state_before,
                                       fmi3Boolean *event_mode, fmi3Boolean *terminate) {
    (void)instance;
    (void)no_state_before;
    *event_mode = fmi3False;
    *terminate = fmi3False;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance component, fmi3Float64 time) {
    fmu_instance *instance = component;
    instance->values.time = time;
    return fmi3OK;
}

fmi3Status fmi3SetContinuousStates(fmi3Instance component, const fmi3Float64 states[],
                                   size_t count) {
    fmu_instance *instance = component;
    if (count != (size_t)model.states) {
        return fmi3Error;
    }
    fmu_set_states(instance, states);
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance component, fmi3Float64 derivatives[],
                                             size_t count) {
    fmu_instance *instance = component;
    if (count != (size_t)model.states) {
        return fmi3Error;
    }
    const int status = fmu_evaluate(instance);
    memcpy(derivatives, instance->values.derivative, count * sizeof(double));
    return status_of(status);
}

fmi3Status fmi3GetEventIndicators(fmi3Instance component, fmi3Float64 indicators[], size_t count) {
    fmu_instance *instance = component;
    if (count != INDICATORS) {
        return fmi3Error;
    }
    const int status = fmu_evaluate(instance);
    memcpy(indicators, instance->values.indicator, count * sizeof(double));
    return status_of(status);
}

fmi3Status fmi3GetContinuousStates(fmi3Instance component, fmi3Float64 states[], size_t count) {
    const fmu_instance *instance = component;
    if (count != (size_t)model.states) {
        return fmi3Error;
    }
    memcpy(states, instance->values.state, count * sizeof(double));
    return fmi3OK;
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance component, fmi3Float64 nominals[],
                                             size_t count) {
    (void)component;
    if (count != (size_t)model.states) {
        return fmi3Error;
    }
    fmu_nominals(nominals);
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *count) {
    (void)instance;
    *count = INDICATORS;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *count) {
    (void)instance;
    *count = (size_t)model.states;
    return fmi3OK;
}

/* Co-simulation. */

fmi3Status fmi3EnterStepMode(fmi3Instance instance) {
    (void)instance;
    return fmi3OK;
}

fmi3Status fmi3DoStep(fmi3Instance component, fmi3Float64 time, fmi3Float64 step,
                      fmi3Boolean no_state_before, fmi3Boolean *event, fmi3Boolean *terminate,
                      fmi3Boolean *early, fmi3Float64 *last) {
    (void)no_state_before;
    fmu_instance *instance = component;
    *event = fmi3False;
    *terminate = fmi3False;
    *early = fmi3False;
    const fmi3Status status = status_of(fmu_step(instance, time + step));
    *last = instance->values.time;
    return status;
}
