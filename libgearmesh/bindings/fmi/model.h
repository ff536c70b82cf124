/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * An FMU apart from the standard: variables in a table, equations, and an instance. fmi2.c and fmi3.c hand the calls of
 * the two versions on to it, describe.c prints the table as modelDescription.xml. gear_mesh.c and gear_pair.c are the two
 * models.
 */
#ifndef MODEL_H
#define MODEL_H

#include "file_mesh.h"

enum {
    MAX_STATES = 4,
    MAX_INPUTS = 14,
    MAX_OUTPUTS = 19,
    INDICATORS = 2,
    TEXTS = 8,
    TEXT_SIZE = 1024
};

/* All that an instance knows, plain data: a copy of it is a state of the FMU. */
typedef struct fmu_values {
    gm_pair_params pair;
    gm_mesh_params mesh;
    double double_helical_gap; /* m; NaN: one helix */
    double pinion_inertia;     /* kg m2 */
    double wheel_inertia;
    double tolerance; /* relative, of the integration of co-simulation */

    /* files: deviations and pitch of pinion and wheel, then those of the second half */
    char text[TEXTS][TEXT_SIZE];
    double time;              /* s */
    double input[MAX_INPUTS]; /* as the model says */
    double state[MAX_STATES]; /* likewise */
    double derivative[MAX_STATES];
    double output[MAX_OUTPUTS];

    /* how far drive and coast flanks are beyond their clearance (m) */
    double indicator[INDICATORS];

    int contact; /* 1 drive flanks may touch, -1 coast flanks, 0 neither, 2 both; changes at events */
} fmu_values;

/* A row of the table of variables; its value reference is its place there. */
typedef struct fmu_variable {
    const char *name;
    const char *unit; /* "" = none */
    const char *description;
    enum { KIND_REAL, KIND_INTEGER, KIND_STRING } kind;
    enum {
        ROLE_TIME,
        ROLE_PARAMETER,
        ROLE_INPUT,
        ROLE_STATE,
        ROLE_STATE_OUTPUT, /* a state that others want to be connected to */
        ROLE_DERIVATIVE,
        ROLE_OUTPUT,
        ROLE_DISCRETE, /* an output that changes at events only */
        ROLE_INDICATOR
    } role;
    size_t offset;  /* of its value in fmu_values */
    double nominal; /* of a state; 0 = 1 */
    int state;      /* of a derivative: which state */
} fmu_variable;

/* The partial derivatives of an evaluation: rows derivatives, then outputs; columns states, then inputs. NaN: not known, to
 * be found by differences. */
typedef struct fmu_jacobian {
    double by[MAX_STATES + MAX_OUTPUTS][MAX_STATES + MAX_INPUTS];
} fmu_jacobian;

typedef struct fmu_model {
    const char *name;
    const char *description;
    const fmu_variable *variables;
    int variable_count;
    int states;
    int angle_state; /* which state grows without end; -1 = none */
    int inputs;
    int outputs;

    /* Derivatives and indicators of the values, and unless a solver asks in the middle of a step, outputs; the Jacobian unless
     * it is NULL. Status of gearmesh.h. */
    int (*evaluate)(fmu_values *values, const file_mesh *made, int with_outputs,
                    fmu_jacobian *jacobian);
} fmu_model;

extern const fmu_model model; /* the one that this FMU is */

typedef struct fmu_integrator fmu_integrator;

typedef struct fmu_instance {
    fmu_values values;
    char *resources; /* folder, with a slash at its end */
    int is_prepared; /* 1: mesh and flanks are those of the parameters */
    int is_evaluated; /* 1: derivatives, outputs and indicators are those of states, inputs and time */
    file_mesh made;
    fmu_integrator *integrator; /* co-simulation, from the first step on */
    char message[1700];         /* why the last call failed */

    /* How the environment is told: set by the adapter. */
    void (*log)(struct fmu_instance *instance, const char *message);
    void *environment;
    void (*logger)(void); /* a function of the environment, as the adapter knows it */
    char *name;
} fmu_instance;

void fmu_defaults(fmu_values *values);
fmu_instance *fmu_new(const char *name, const char *resources);
void fmu_free(fmu_instance *instance);
void fmu_reset(fmu_instance *instance);

/* These return 0; -1 after a message was logged; > 0, after a message too, where a state is refused: a smaller step may
 * help. Arrays are [count]; doubles or ints as the kind says. */
int fmu_get(fmu_instance *instance, const unsigned *references, size_t count, int kind,
            void *values);
int fmu_set(fmu_instance *instance, const unsigned *references, size_t count, int kind,
            const void *values);
int fmu_get_texts(fmu_instance *instance, const unsigned *references, size_t count,
                  const char **texts);
int fmu_set_texts(fmu_instance *instance, const unsigned *references, size_t count,
                  const char *const *texts);
void fmu_set_states(fmu_instance *instance, const double *states);
int fmu_evaluate(fmu_instance *instance);
int fmu_events(fmu_instance *instance);
int fmu_step(fmu_instance *instance, double end);

/* Sum over the known variables of partial derivatives times seed; 0 where a variable is none of the unknown or known. */
int fmu_directional(fmu_instance *instance, const unsigned *unknown, size_t unknown_count,
                    const unsigned *known, size_t known_count, const double *seed,
                    double *sensitivity);

/* [model.states] amounts that matter. */
static inline void fmu_nominals(double *nominals) {
    for (int k = 0; k < model.variable_count; ++k) {
        const fmu_variable *variable = &model.variables[k];
        if (variable->role == ROLE_STATE || variable->role == ROLE_STATE_OUTPUT) {
            nominals[(variable->offset - offsetof(fmu_values, state)) / sizeof(double)] =
                variable->nominal;
        }
    }
}

/* A copy of the values in memory that is taken unless there is some (-1: there is none), and the way back. */
int fmu_save(const fmu_values *values, void **copy);
void fmu_restore(fmu_instance *instance, const fmu_values *values);

/* integrator.c: frees it, after which integration begins anew where the values are; NULL is fine. */
void fmu_integrator_free(fmu_integrator *integrator);
int fmu_integrate(fmu_instance *instance, double end);

#endif
