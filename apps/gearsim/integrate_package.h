/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What integrate.c asks of a package of SUNDIALS, and what both have in common. A package takes steps and
 * knows the values within the last one; when to step, when to give up and what to say is common to all.
 */
#ifndef GEARSIM_INTEGRATE_PACKAGE_H
#define GEARSIM_INTEGRATE_PACKAGE_H

#include "integrate.h"

#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_types.h>

typedef struct solver_package {
    /* Sets `memory` up for the state at t = 0; 0 = done. Whatever became of it, free() follows. */
    int (*create)(integrator *solver);
    void (*free)(integrator *solver);

    /* One step, no longer than `longest` (s, 0 = any) and not beyond the time `stop`: moves `time` and `state`. A
     * longest step that has become shorter holds from the step after on, `stop` at once. Returns the package's
     * flag, < 0 = failed, and its name in a string for free(). */
    int (*step)(integrator *solver, double longest, double stop);
    char *(*flag_name)(long flag);

    /* Forgets the steps before the time and state reached; 0 = done. */
    int (*restart)(integrator *solver);

    /* States at times within the last step; 0 = done. */
    int (*interpolate)(integrator *solver, int count, const double times[],
                       integrator_point points[]);

    integrator_statistics (*counts)(const integrator *solver);
} solver_package;

extern const solver_package cvode_package, arkode_package;

struct integrator {
    const solver_package *package;
    void *memory; /* of the package */
    const gear_model *model;
    integrator_options options;
    SUNContext context;
    N_Vector state;            /* at the end of the last step */
    sunrealtype time;          /* end of the last step (s) */
    enum mesh_contact contact; /* in the last evaluation of the model */
    model_tangent tangent;     /* likewise; of CVODE alone */
    double touching[2];        /* part of the flanks that touches, at both ends of the last step */
    double touched;            /* its integral up to the end of the last step (s) */
    double step_length;        /* of the last step (s) */
    double longest;            /* step, 0 = any, (s) */
    double longest_until;      /* and until when that holds (s) */
    double carried_since;      /* all that touched has carried, HUGE_VAL = it does not */
    double row_time;           /* next row of the tables, HUGE_VAL = there is none */
    double last_time;          /* before it; nothing is evaluated later until it is reached */
    int is_kink;               /* the solver starts again there */
    integrator_statistics before; /* of the starts before */
    long looks;                   /* evaluations of the mesh ahead of the solver */
    int stalled;                  /* steps of next to nothing in a row */
    int status;                   /* of the last evaluation of the model that went wrong */
    char message[256];            /* what the package said last */
    char failure[512];
};

/* For both packages, with the integrator as their user data. */
int integrator_derivative(sunrealtype time, N_Vector state, N_Vector result, void *data);
/* A time that a package asks about, or the latest before a step of a table. */
double integrator_seen_time(const integrator *solver, double time);
int integrator_error_weights(N_Vector state, N_Vector weights, void *data);
int integrator_keep_status(integrator *solver, int status);

/* Both take their first step by this; not the next sample, so that no result depends on sampling. */
double integrator_first_target(const integrator *solver);

/* SUNDIALS' messages are kept for our own report instead of being printed. In version 6 each package takes
 * a handler of its own, from 7 on the context has it. */
#if SUNDIALS_VERSION_MAJOR < 7
void integrator_keep_message(int code, const char *module, const char *function, char *message,
                             void *data);
#endif

#endif
