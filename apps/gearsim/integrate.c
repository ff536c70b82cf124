/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Step by step to the samples, with whichever package of SUNDIALS 6 or 7 has the method asked for. */
#include "flight.h"
#include "integrate_package.h"
#include "platform.h"
#include "small_vector.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#if SUNDIALS_VERSION_MAJOR >= 7
#define NO_COMMUNICATOR SUN_COMM_NULL
#else
#define NO_COMMUNICATOR NULL
#endif

/* So many steps in a row that are next to nothing of a vibration (in rad of it): the solver is stuck. */
enum { STALLED_STEPS = 100 };
static const double stalled_step = 1e-10;

/* Longest step without a force where nothing else limits it, in rad of a vibration. */
static const double longest_flight = 600.0;

/* ---------------------------------------------------------------------------------------------
 * What the packages call
 * ------------------------------------------------------------------------------------------- */

int integrator_keep_status(integrator *solver, int status) {
    if (status != GM_OK) {
        solver->status = status;
    }
    return status;
}

/* Up to a step of a table counts what is before it. */
double integrator_seen_time(const integrator *solver, double time) {
    return time < solver->last_time ? time : solver->last_time;
}

/* The library's status is that of SUNDIALS: > 0 try a smaller step, < 0 give up. */
int integrator_derivative(sunrealtype time, N_Vector state, N_Vector result, void *data) {
    integrator *solver = data;
    const double seen = integrator_seen_time(solver, time);

    return integrator_keep_status(solver, model_derivative(solver->model, seen, NV_DATA_S(state),
                                                           NV_DATA_S(result), &solver->contact));
}

int integrator_error_weights(N_Vector state, N_Vector weights, void *data) {
    const integrator *solver = data;

    model_error_weights(solver->model, solver->options.relative_tolerance,
                        solver->options.absolute_tolerance, NV_DATA_S(state), NV_DATA_S(weights));
    return 0;
}

double integrator_first_target(const integrator *solver) {
    return solver->time + 1.0 / solver->model->natural_frequency;
}

#if SUNDIALS_VERSION_MAJOR >= 7
static void keep_message(int line, const char *function, const char *file, const char *message,
                         SUNErrCode code, void *data, SUNContext context) {
    integrator *solver = data;
    (void)line;
    (void)function;
    (void)file;
    (void)code;
    (void)context;

    snprintf(solver->message, sizeof solver->message, "%s", message);
}

static int redirect_messages(integrator *solver) {
    return SUNContext_ClearErrHandlers(solver->context) ||
           SUNContext_PushErrHandler(solver->context, keep_message, solver);
}
#else
void integrator_keep_message(int code, const char *module, const char *function, char *message,
                             void *data) {
    integrator *solver = data;
    (void)code;
    (void)module;
    (void)function;

    snprintf(solver->message, sizeof solver->message, "%s", message);
}

static int redirect_messages(integrator *solver) {
    (void)solver;
    return 0;
}
#endif

/* ---------------------------------------------------------------------------------------------
 * Setting up
 * ------------------------------------------------------------------------------------------- */

static const solver_package *package_of(enum solver_method method) {
    switch (method) {
    case METHOD_ERK:
        return &arkode_package;
    case METHOD_BDF:
    case METHOD_ADAMS:
    default:
        return &cvode_package;
    }
}

/* The row that the solver has to stop at next. */
static void look_for_row(integrator *solver) {
    solver->row_time = model_next_row(solver->model, solver->time, &solver->is_kink);
    solver->last_time =
        solver->is_kink ? model_before_row(solver->model, solver->row_time) : HUGE_VAL;
}

static int set_up(integrator *solver, const double start[]) {
    const sunindextype states = solver->model->states;

    if (SUNContext_Create(NO_COMMUNICATOR, &solver->context) != 0 ||
        redirect_messages(solver) != 0) {
        return -1;
    }
    solver->state = small_vector_create(states, solver->context);
    if (solver->state == NULL) {
        return -1;
    }
    memcpy(NV_DATA_S(solver->state), start, (size_t)states * sizeof start[0]);
    look_for_row(solver);

    /* Whether the first step starts in contact; a state that the model refuses fails in that step. */
    double derivative[STATES_MAX];
    (void)model_derivative(solver->model, 0.0, start, derivative, &solver->contact);
    return solver->package->create(solver);
}

integrator *integrator_create(const gear_model *model, const integrator_options *options,
                              const double start[]) {
    integrator *solver = calloc(1, sizeof *solver);
    if (solver == NULL) {
        return NULL;
    }

    solver->package = package_of(options->method);
    solver->model = model;
    solver->options = *options;
    solver->carried_since = HUGE_VAL;
    if (set_up(solver, start) == 0) {
        return solver;
    }
    integrator_free(solver);
    return NULL;
}

void integrator_free(integrator *solver) {
    if (solver == NULL) {
        return;
    }
    solver->package->free(solver);
    if (solver->state != NULL) {
        N_VDestroy(solver->state);
    }
    if (solver->context != NULL) {
        SUNContext_Free(&solver->context);
    }
    free(solver);
}

/* ---------------------------------------------------------------------------------------------
 * Running
 * ------------------------------------------------------------------------------------------- */

/* What to try where gears have been driven apart: jumps of the force put energy into a resonance without bound. */
static const char *advice(const integrator *solver) {
    static const char no_jumps[] =
        "; the force of these spur gears jumps where pairs come and go, which can drive a "
        "resonance that far: mesh.corner_contact = on takes the jumps away";

    return solver->status == GM_STATE_OUT_OF_RANGE && solver->model->jumps ? no_jumps : "";
}

static int fail(integrator *solver, const char *what) {
    const int model_at_fault = solver->status != GM_OK;

    snprintf(solver->failure, sizeof solver->failure, "%s at t = %.9g s%s%s%s", what, solver->time,
             model_at_fault ? "; the gears: " : "",
             model_at_fault ? gm_status_text(solver->status) : "", advice(solver));
    return EXIT_RUN_FAILED;
}

/* Error that a step may make in x' (m/s). */
static double speed_tolerance(const integrator *solver) {
    double weights[STATES_MAX];

    model_error_weights(solver->model, solver->options.relative_tolerance,
                        solver->options.absolute_tolerance, NV_DATA_S(solver->state), weights);
    return model_speed_unit(solver->model) / weights[STATE_OFFSET_RATE];
}

/*
 * Time that the next step must not go beyond. In flight the error estimate is zero and does not limit the step: the
 * next contact does. Firm contact, and flights that strong noise bends, are left to the error estimate.
 */
static double stop_time(integrator *solver, double longest) {
    const gear_model *model = solver->model;
    const double *state = NV_DATA_S(solver->state);

    if (solver->contact == MESH_CARRIES) {
        return DBL_MAX;
    }

    const double limit = longest > 0.0 ? longest : longest_flight / model->natural_frequency;
    const flight_options options = {
        .longest = fmin(limit, solver->row_time - solver->time),
        .speed_tolerance = speed_tolerance(solver),
    };
    if (flight_noise_guides(model, &options)) {
        return DBL_MAX;
    }

    const double allowed =
        solver->contact == MESH_FREE
            ? flight_clear_time(model, solver->time, state, &options, &solver->looks)
            : flight_light_step(model, solver->time, state, &options);
    return solver->time + allowed;
}

/* The smaller of what the user allows and what the model needs; 0 = none. It holds for a while. */
static double longest_step(integrator *solver) {
    if (solver->time < solver->longest_until) {
        return solver->longest;
    }
    const double asked = solver->options.max_step;
    const double needed = model_held_step(solver->model, solver->time, NV_DATA_S(solver->state),
                                          &solver->longest_until);

    if (asked > 0.0 && needed > 0.0) {
        solver->longest = fmin(asked, needed);
    } else {
        solver->longest = asked > 0.0 ? asked : needed;
    }
    return solver->longest;
}

/* Behind a row of a table; where it is a kink, what the solver knows of the steps before is worth nothing. */
static int pass_row(integrator *solver) {
    if (solver->time < solver->row_time) {
        return 0;
    }

    const int is_kink = solver->is_kink;
    look_for_row(solver);
    if (!is_kink) {
        return 0;
    }
    solver->before = integrator_counts(solver);
    solver->before.looks = 0;
    return solver->package->restart(solver);
}

/* At the end of a step. */
static void keep_account(integrator *solver, double before) {
    const model_tangent *tangent = &solver->tangent;

    solver->step_length = solver->time - before;
    solver->touching[0] = solver->touching[1];
    solver->touching[1] = tangent->touching;
    solver->touched += 0.5 * (solver->touching[0] + solver->touching[1]) * solver->step_length;
    if (!tangent->is_spring) {
        solver->carried_since = HUGE_VAL;
    } else if (solver->carried_since == HUGE_VAL) {
        solver->carried_since = solver->time;
    }
}

static int step(integrator *solver) {
    /* A fault that the solver got over by a smaller step is not the reason of a later failure, unless the
     * steps have been next to nothing since. */
    if (solver->stalled == 0) {
        solver->status = GM_OK;
    }
    solver->message[0] = '\0';

    if (pass_row(solver) != 0) {
        return fail(solver, "the solver could not start again");
    }
    const double before = solver->time;
    const double longest = longest_step(solver);
    const double stop = fmin(stop_time(solver, longest), solver->row_time);
    const int flag = solver->package->step(solver, longest, stop);
    if (flag < 0) {
        char *name = solver->package->flag_name(flag);
        char what[sizeof solver->message + 64];

        snprintf(what, sizeof what, "the solver stopped (%s%s%s)", name,
                 solver->message[0] != '\0' ? ": " : "", solver->message);
        free(name);
        return fail(solver, what);
    }

    keep_account(solver, before);

    /* In front of a state that the model refuses the solver would creep up to it for ever. */
    const double turned = (solver->time - before) * solver->model->natural_frequency;
    solver->stalled = turned > stalled_step ? 0 : solver->stalled + 1;
    if (solver->stalled >= STALLED_STEPS) {
        return fail(solver, "the solver's steps became too short");
    }
    return 0;
}

int integrator_touched(const integrator *solver, double since, double time, double *touched) {
    const double rest = solver->time - time;
    const double share = solver->step_length > 0.0 ? 0.5 * rest / solver->step_length : 0.0;
    const double middle = solver->touching[1] + share * (solver->touching[0] - solver->touching[1]);

    *touched = solver->touched - rest * middle;
    return solver->carried_since <= since;
}

/* Steps until a time is behind. */
static int go_beyond(integrator *solver, double time) {
    while (solver->time < time) {
        if (interrupt_requested()) {
            return EXIT_INTERRUPTED;
        }
        const int failed = step(solver);
        if (failed) {
            return failed;
        }
    }
    return 0;
}

/* States at times within the last step. */
static int read_states(integrator *solver, int count, const double times[],
                       integrator_point points[]) {
    /* Before the first step there is nothing to interpolate. */
    if (solver->time == 0.0) {
        for (int k = 0; k < count; ++k) {
            memcpy(points[k].state, NV_DATA_S(solver->state),
                   (size_t)solver->model->states * sizeof points[k].state[0]);
        }
        return 0;
    }
    if (solver->package->interpolate(solver, count, times, points) != 0) {
        return fail(solver, "no value between the solver's steps");
    }
    return 0;
}

int integrator_advance_through(integrator *solver, int count, const double times[],
                               int with_touched, integrator_point points[]) {
    int done = 0;

    while (done < count) {
        int failed = go_beyond(solver, times[done]);
        if (failed) {
            return failed;
        }

        /* All that this step has reached. */
        int next = done + 1;
        while (next < count && times[next] <= solver->time) {
            ++next;
        }
        failed = read_states(solver, next - done, times + done, points + done);
        if (failed) {
            return failed;
        }
        for (int k = done; k < next && with_touched; ++k) {
            integrator_touched(solver, times[k], times[k], &points[k].touched);
            points[k].carried_since = solver->carried_since;
        }
        done = next;
    }
    return 0;
}

int integrator_advance(integrator *solver, double time, double state[]) {
    integrator_point point;
    const int failed = integrator_advance_through(solver, 1, &time, 0, &point);

    if (!failed) {
        memcpy(state, point.state, (size_t)solver->model->states * sizeof state[0]);
    }
    return failed;
}

double integrator_time(const integrator *solver) {
    return solver->time;
}

const char *integrator_failure(const integrator *solver) {
    return solver->failure;
}

integrator_statistics integrator_counts(const integrator *solver) {
    integrator_statistics counts = solver->package->counts(solver);

    counts.steps += solver->before.steps;
    counts.derivatives += solver->before.derivatives;
    counts.rejected += solver->before.rejected;
    counts.looks = solver->looks;
    return counts;
}
