/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Deflections of elastic teeth in contact: the minimum of the energy of teeth, rim and contacts, by Newton's method.
 *
 * At a point of contact the flanks approach each other by gamma = x + w - s phi - psi, with the rigid approach x, the
 * deviation w, the deflection phi of the line's tooth layer and psi of the rim, which all lines of the side share. The
 * contact law gives the line load q. The residual is what the layers lack to balance the loads; its derivative is
 * symmetric and positive definite, as the energy is convex.
 *
 * A step leaves the layers in balance with the loads expected in first order, so the next residual is what the new loads
 * exceed them by. Twice the energy that a step can still win is the product of residual and step; where that is small
 * against the energy itself, the step is the last one, and loads and approach are carried along in first order: force and
 * energy are then exact to the square of it, the derivatives to itself.
 *
 * The first state comes from the last solution, by its derivative by x and by the change from the one before it along the roll.
 */
#include "elastic.h"
#include "hertz.h"
#include "internal.h"
#include "wide.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/*
 * Root of the energy that is still to be won, as part of the energy: the last step begins below it. What is left of the
 * force is some percent of its square, 1e-9. From undeformed teeth, where a step more costs little, its derivatives
 * are exact to 1e-7 too.
 */
#define CONVERGED      3e-5
#define CONVERGED_COLD 1e-7
/* A step that leaves more of that root is checked by the energy, which has to fall by this part of the prediction. */
#define SLOW   0.5
#define ARMIJO 1e-4
/* The roll may change by this many times the change before for a prediction, and its rate is kept below the least change. */
#define FARTHEST     4.0
#define LEAST_CHANGE 1e-9 /* of the pitch */

enum { HALVINGS_MAX = 30 };

/* ---------------------------------------------------------------------------------------------
 * Residual and energy
 * ------------------------------------------------------------------------------------------- */

/* What a layer takes on stations begin .. end - 1: -A v. */
static void balance_layer(const gmi_elastic_layer *layer, int begin, int end,
                          const double *restrict v, double *restrict residual) {
    const int last = end - 1;
    residual[begin] = -(layer->left[begin] * v[begin] + layer->beside[begin] * v[begin + 1]);
    for (int k = begin + 1; k < last; ++k) {
        residual[k] = -(layer->beside[k - 1] * v[k - 1] + layer->diagonal[k] * v[k] +
                        layer->beside[k] * v[k + 1]);
    }
    residual[last] = -(layer->beside[last - 1] * v[last - 1] + layer->right[last] * v[last]);
}

static const gmi_elastic_layer *layer_of(const gmi_elastic *law, const gmi_elastic_work *work,
                                         int row) {
    return row == work->count ? &law->rim : &law->tooth;
}

/* Of all lines, and of the rim. */
static void clear_rows(const gmi_elastic_work *work, double *rows) {
    const size_t row = sizeof(double) * (size_t)work->stations;
    memset(rows, 0, (size_t)work->count * row);
    memset(gmi_elastic_rim(work, rows), 0, row);
}

/* Points and residual at the state of the workspace. Returns whether anything touches. */
static int begin_at_state(const gmi_elastic *law, gmi_elastic_work *work, double x) {
    clear_rows(work, work->change);
    for (int row = 0; row <= work->count; ++row) {
        const gmi_elastic_span span = gmi_elastic_span_of(work, row);
        balance_layer(layer_of(law, work, row), span.begin, span.end, work->state + span.at,
                      work->change + span.at);
    }
    memset(work->expected, 0, 2 * sizeof(double) * (size_t)work->slots);
    gmi_elastic_approach(work, x);
    gmi_elastic_load(law, work);
    gmi_elastic_gather(work, work->force, work->change);
    return gmi_elastic_sum(2 * work->slots, work->force) > 0.0;
}

/* Energy of a layer on stations begin .. end - 1, with what lies beyond them. */
static double layer_energy(const gmi_elastic_layer *layer, int begin, int end, const double *v) {
    double sum = 0.5 * layer->left[begin] * v[begin] * v[begin];
    for (int k = begin + 1; k < end; ++k) {
        const double diagonal = k + 1 == end ? layer->right[k] : layer->diagonal[k];
        sum += v[k] * (layer->beside[k - 1] * v[k - 1] + 0.5 * diagonal * v[k]);
    }
    return sum;
}

/* The whole energy at the state of the workspace and approach x. */
static double energy_at(const gmi_elastic *law, gmi_elastic_work *work, double x) {
    double sum = 0.0;
    for (int row = 0; row <= work->count; ++row) {
        const gmi_elastic_span span = gmi_elastic_span_of(work, row);
        sum += layer_energy(layer_of(law, work, row), span.begin, span.end, work->state + span.at);
    }
    gmi_elastic_approach(work, x);
    for (int p = 0; p < 2 * work->slots; ++p) {
        gmi_hertz_state point;
        gmi_hertz_evaluate(law->hertz_compliance, work->rate[p], work->approach_at[p], &point);
        sum += work->weight[p] * point.energy;
    }
    return sum;
}

/* ---------------------------------------------------------------------------------------------
 * Steps
 * ------------------------------------------------------------------------------------------- */

/* to += part * from */
APART void add_scaled(int count, double part, const double *restrict from, double *restrict to) {
    for (int k = 0; k < count; ++k) {
        to[k] += part * from[k];
    }
}

/* The state moves by part of a step, which is 0 where nothing touches: all rows at once, and the rim. */
static void move_state(gmi_elastic_work *work, double part, const double *step) {
    const int n = work->stations, rim = work->lines_max * n;
    add_scaled(work->count * n, part, step, work->state);
    add_scaled(n, part, step + rim, work->state + rim);
}

/* rows += part * other, over the stations that lines touch. */
static void add_multiple(const gmi_elastic_work *work, double part, const double *other,
                         double *rows) {
    for (int row = 0; row <= work->count; ++row) {
        const gmi_elastic_span span = gmi_elastic_span_of(work, row);
        add_scaled(span.end - span.begin, part, other + span.at + span.begin,
                   rows + span.at + span.begin);
    }
}

/* rows += part * other + more * another */
static void add_two(const gmi_elastic_work *work, double part, const double *other, double more,
                    const double *another, double *rows) {
    for (int row = 0; row <= work->count; ++row) {
        const gmi_elastic_span span = gmi_elastic_span_of(work, row);
        const double *restrict first = other + span.at;
        const double *restrict second = another + span.at;
        double *restrict to = rows + span.at;
        for (int k = span.begin; k < span.end; ++k) {
            to[k] = (to[k] + part * first[k]) + more * second[k];
        }
    }
}

/* The step for the residual of work->change. Returns their product. */
static double find_step(const gmi_elastic *law, gmi_elastic_work *work) {
    gmi_elastic_stiffen(work);
    return gmi_elastic_factor(law, work, work->change);
}

/*
 * The adjoint of the force: K lambda = J' W q' 1. A rim that moves by 1 as a whole moves each point by 1, so that this is K of
 * that movement less what the rim's own layer A_r takes: lambda = 1 of the rim - K^-1 A_r 1.
 */
static void find_adjoint(const gmi_elastic *law, gmi_elastic_work *work) {
    const gmi_elastic_layer *layer = &law->rim;
    const int begin = work->begin, end = work->end;
    double *restrict rim = gmi_elastic_rim(work, work->adjoint);
    clear_rows(work, work->adjoint);
    rim[begin] = -(layer->left[begin] + layer->beside[begin]);
    for (int k = begin + 1; k < end; ++k) {
        rim[k] = -(layer->beside[k - 1] + layer->diagonal[k] + layer->beside[k]);
    }
    rim[end] = -(layer->beside[end - 1] + layer->right[end]);
    gmi_elastic_substitute(work, work->adjoint);
    for (int k = begin; k <= end; ++k) {
        rim[k] += 1.0;
    }
}

/* The step was too long: goes back, and halves it until the energy falls as it should. `fall`: what it promised. */
static void shorten(const gmi_elastic *law, gmi_elastic_work *work, double x, double fall) {
    const double after = energy_at(law, work, x);
    move_state(work, -1.0, work->last_step);
    const double before = energy_at(law, work, x);
    double part = 1.0;
    for (int k = 0; k < HALVINGS_MAX; ++k) {
        if (k == 0 && after <= before - ARMIJO * fall) {
            break;
        }
        part *= 0.5;
        move_state(work, part, work->last_step);
        const double now = energy_at(law, work, x);
        move_state(work, -part, work->last_step);
        if (now <= before - ARMIJO * part * fall) {
            break;
        }
    }
    move_state(work, part, work->last_step);
}

/* ---------------------------------------------------------------------------------------------
 * Begin and end
 * ------------------------------------------------------------------------------------------- */

/* Roll of row 0 at z = 0. */
static double place_of(const gmi_elastic_work *work) {
    return work->at.origin + (double)work->line[0].index * work->at.pitch;
}

/* From the last solution to the state expected now; keeps the last one. */
static void predict(gmi_elastic_work *work, double x) {
    if (work->warm == 0) {
        return;
    }
    memcpy(work->last, work->state,
           sizeof(double) * (size_t)(work->lines_max + 1) * (size_t)work->stations);
    const double rolled = place_of(work) - work->warm_place;
    const double change = x - work->approach;
    if (work->warm > 1 && fabs(rolled) <= FARTHEST * fabs(work->rolled)) {
        add_two(work, change, work->adjoint, rolled, work->by_place, work->state);
    } else {
        add_multiple(work, change, work->adjoint, work->state);
    }
}

/* What the last two solutions tell of the roll. */
static void learn(gmi_elastic_work *work, double x) {
    const double place = place_of(work);
    const double rolled = place - work->warm_place;
    if (work->warm > 0 && fabs(rolled) >= LEAST_CHANGE * work->at.pitch) {
        /* The state has changed by the approach, which the adjoint tells, and by the roll: the rest. */
        const double per_roll = 1.0 / rolled, change = x - work->approach;
        for (int row = 0; row <= work->count; ++row) {
            const gmi_elastic_span span = gmi_elastic_span_of(work, row);
            const double *restrict state = work->state + span.at;
            const double *restrict last = work->last + span.at;
            const double *restrict by_x = work->adjoint + span.at;
            double *restrict by_place = work->by_place + span.at;
            for (int k = span.begin; k < span.end; ++k) {
                by_place[k] = (state[k] - last[k] - change * by_x[k]) * per_roll;
            }
        }
        work->rolled = rolled;
        work->warm = 2;
    } else if (work->warm == 0) {
        work->warm = 1;
    }

    /* From here to the next solution. */
    work->warm_place = place;
    work->approach = x;
}

/* Stations beside the loaded ones bend with them: where a line begins next. */
static void extend(const gmi_elastic *law, const gmi_elastic_work *work, double *rows) {
    for (int row = 0; row <= work->count; ++row) {
        const gmi_elastic_span span = gmi_elastic_span_of(work, row);
        const gmi_elastic_layer *layer = layer_of(law, work, row);
        double *v = rows + span.at;
        if (span.begin > 0) {
            const int k = span.begin;
            v[k - 1] = -layer->beside[k - 1] / layer->left[k - 1] * v[k];
        }
        if (span.end < work->stations) {
            const int k = span.end;
            v[k] = -layer->beside[k - 1] / layer->right[k] * v[k - 1];
        }
    }
}

/* What the next solution begins with. */
static void keep(const gmi_elastic *law, gmi_elastic_work *work, double x, double energy) {
    learn(work, x);
    extend(law, work, work->state);
    extend(law, work, work->adjoint);
    extend(law, work, work->by_place);
    work->energy = energy;
    work->touching = 1;
}

/* No line, or no contact on any. */
static void answer_nothing(gmi_elastic_work *work, gmi_elastic_result *result) {
    const size_t bytes = 2 * sizeof(double) * (size_t)work->slots;
    gmi_elastic_work_reset(work);
    memset(work->load, 0, bytes);
    memset(work->force, 0, bytes);
    memset(work->stiffness, 0, bytes);
    memset(work->by_deviation, 0, bytes);
    memset(result, 0, sizeof *result);
    work->touching = 0;
}

static void answer_nan(gmi_elastic_work *work, gmi_elastic_result *result) {
    gmi_elastic_work_reset(work);
    work->touching = 0;
    result->force = result->energy = result->by_approach = gmi_nan();
    for (int k = 0; k < GMI_ELASTIC_LINES_MAX; ++k) {
        result->line_force[k] = gmi_nan();
    }
}

/* Loads and energies of the points after the last step. */
APART void finish_points(int count, double per_compliance, double x, const double *restrict slope,
                         const double *restrict change, const double *restrict expected,
                         const double *restrict deviation, double *restrict load,
                         double *restrict force, double *restrict energy) {
    const double quarter = 0.25 / per_compliance;
    for (int p = 0; p < count; ++p) {
        const double q = load[p] + slope[p] * change[p] * per_compliance;
        load[p] = q;
        force[p] = expected[p];
        energy[p] = expected[p] * (0.5 * (x + deviation[p]) - quarter * q);
    }
}

/* Whether a point is on the straight part of the contact law. */
APART int is_straight(int count, const double *slope) {
    int64_t any = 0;
    for (int p = 0; p < count; ++p) {
        any |= slope[p] >= 1.0;
    }
    return any != 0;
}

/* What the energy above lacks there. */
static double straight_energy(const gmi_elastic *law, const gmi_elastic_work *work) {
    double sum = 0.0;
    for (int p = 0; p < 2 * work->slots; ++p) {
        if (work->slope[p] >= 1.0) {
            const double excess =
                work->load[p] - 0.5 * gmi_hertz_largest / (law->hertz_compliance * work->rate[p]);
            sum += 0.25 * law->hertz_compliance * work->weight[p] * excess * excess;
        }
    }
    return sum;
}

/* In balance the layers hold half the work of the loads: U = sum W (q (x + w) / 2 - B q^2 / 4). */
static void finish(const gmi_elastic *law, gmi_elastic_work *work, double x,
                   gmi_elastic_result *result) {
    const int slots = work->slots;
    finish_points(2 * slots, 1.0 / law->hertz_compliance, x, work->slope, work->change_at,
                  work->expected, work->deviation, work->load, work->force, work->scratch);
    result->force = 0.0;
    for (int k = 0; k < work->count; ++k) {
        const gmi_elastic_line *line = &work->line[k];
        result->line_force[k] = gmi_elastic_sum(line->slots, work->force + line->slot) +
                                gmi_elastic_sum(line->slots, work->force + slots + line->slot);
        result->force += result->line_force[k];
    }
    result->energy = gmi_elastic_sum(2 * slots, work->scratch);
    work->straight = is_straight(2 * slots, work->slope);
    if (work->straight) {
        result->energy += straight_energy(law, work);
    }
}

/* dF/dx, as a whole and by points. */
static void find_stiffness(const gmi_elastic *law, gmi_elastic_work *work,
                           gmi_elastic_result *result) {
    const int slots = work->slots;
    find_adjoint(law, work);
    gmi_elastic_pull(work, NULL, work->adjoint);
    for (int p = 0; p < 2 * slots; ++p) {
        work->by_deviation[p] = work->stiffness[p] * work->pull[p];
    }
    result->by_approach = gmi_elastic_sum(2 * slots, work->by_deviation);
}

int gmi_elastic_solve(const gmi_elastic *law, gmi_elastic_work *work, double approach,
                      gmi_elastic_result *result) {
    GMI_RETURN_WIDE(law, gmi_wide_solve(law, work, approach, result))
    if (work->count == 0) {
        answer_nothing(work, result);
        return GM_OK;
    }

    const size_t bytes = sizeof(double) * (size_t)(work->lines_max + 1) * (size_t)work->stations;
    predict(work, approach);
    if (!begin_at_state(law, work, approach)) {
        /* The last solution tells nothing, or nothing touches. */
        gmi_elastic_work_reset(work);
        if (!begin_at_state(law, work, approach)) {
            answer_nothing(work, result);
            return GM_OK;
        }
    }

    /* Newton's steps, until the energy to be gained from another one is nothing. */
    double last = (double)INFINITY;
    double scale = work->warm > 0 ? work->energy : (double)INFINITY;
    const double root = work->warm > 0 ? CONVERGED : CONVERGED_COLD;
    for (int iteration = 1; iteration <= GMI_ELASTIC_ITERATIONS; ++iteration) {
        const double fall = find_step(law, work);

        /* Hardly less to be gained than before: the last step went too far. */
        if (last < (double)INFINITY && !(fall < SLOW * SLOW * last)) {
            shorten(law, work, approach, last);
            (void)begin_at_state(law, work, approach);
            last = (double)INFINITY;
            continue;
        }

        gmi_elastic_follow(work);
        move_state(work, 1.0, work->change);

        if (fall <= root * root * scale) {
            finish(law, work, approach, result);
            scale = result->energy;
            if (fall <= root * root * scale) {
                result->iterations = iteration;
                find_stiffness(law, work, result);
                keep(law, work, approach, result->energy);
                return GM_OK;
            }
        }

        /* The next residual: what the loads exceed the expected ones by. */
        memcpy(work->last_step, work->change, bytes);
        clear_rows(work, work->change);
        gmi_elastic_load(law, work);
        gmi_elastic_gather(work, work->scratch, work->change);
        scale = scale < (double)INFINITY ? scale : fall;
        last = fall;
    }
    answer_nan(work, result);
    return GM_NO_CONVERGENCE;
}
