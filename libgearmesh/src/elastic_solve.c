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
 * against the energy itself, the step is the last one. So it is where the contact law's own bend is known well enough over the
 * step: by its series the loads exceed the expected ones by g, of which the layers take what the adjoint says,
 *
 *     F = sum (W q expected) + (1 - J lambda) g,    dF/dx = sum W q' (1 - J lambda) + (W q')' (1 - J lambda)^2,
 *
 * to the second order of what the matrix, the adjoint's too, is off by.
 *
 * The first state comes from the last solution, by its derivative by x and along the roll by the two solutions before it.
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
/*
 * Where only sums are wanted, the last step is also one that the series of the contact law follows: it has to be below this
 * root, and to leave less of the force than LEAVES by an estimate that is mostly two to five times the truth. A later
 * step has to be shorter: what its sums by the roll lack is known after the first one alone, whose state was foretold. No load
 * may change by more than FAR of itself.
 */
#define NEAR       0.1
#define NEAR_AGAIN 1e-3
#define LEAVES     1e-8
#define FAR        0.5
#define LEAST_LOAD 1e-300 /* (N/m) */
#define HUGE_DOUBT 1e100
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

/* Whether the lines are elsewhere than those of the last solution. */
static int has_rolled(const gmi_elastic_work *work) {
    return fabs(place_of(work) - work->warm_place) >= LEAST_CHANGE * work->at.pitch;
}

/* Whether a change of the roll tells nothing of one so much farther. */
static int is_farther(double known, double rolled) {
    return fabs(rolled) > FARTHEST * fabs(known);
}

/* One row of the state moves by its derivatives. */
APART void predict_row(int count, double by_approach, double by_roll, double by_curve,
                       const double *restrict by_x, const double *restrict by_place,
                       const double *restrict curve, double *restrict state) {
    for (int k = 0; k < count; ++k) {
        state[k] =
            ((state[k] + by_approach * by_x[k]) + by_roll * by_place[k]) + by_curve * curve[k];
    }
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
    const double of_roll = work->warm > 1 && !is_farther(work->rolled, rolled) ? rolled : 0.0;
    const double of_curve = work->warm > 2 ? of_roll * (rolled + work->rolled) : 0.0;
    for (int row = 0; row <= work->count; ++row) {
        const gmi_elastic_span span = gmi_elastic_span_of(work, row);
        const int at = span.at + span.begin;
        predict_row(span.end - span.begin, change, of_roll, of_curve, work->adjoint + at,
                    work->by_place + at, work->place_curve + at, work->state + at);
    }
}

/* What one row of the last states tells. */
APART void learn_row(int count, double change, double per_roll, double per_both,
                     const double *restrict by_x, const double *restrict state,
                     const double *restrict last, double *restrict by_place,
                     double *restrict curve) {
    for (int k = 0; k < count; ++k) {
        const double slope = (state[k] - last[k] - change * by_x[k]) * per_roll;
        curve[k] = (slope - by_place[k]) * per_both;
        by_place[k] = slope;
    }
}

/* What the last solutions tell of the roll: the change of the state beside that by the approach, which the adjoint tells. */
static void learn(gmi_elastic_work *work, double x, int is_foretold) {
    const double place = place_of(work);
    const double rolled = place - work->warm_place;
    if (work->warm > 0 && has_rolled(work)) {
        const double per_roll = 1.0 / rolled, change = x - work->approach;

        /* How that bends, if it went on in the same direction. */
        const int goes_on =
            work->warm > 1 && rolled * work->rolled > 0.0 && !is_farther(work->rolled, rolled);
        const double per_both = goes_on ? 1.0 / (rolled + work->rolled) : 0.0;
        for (int row = 0; row <= work->count; ++row) {
            const gmi_elastic_span span = gmi_elastic_span_of(work, row);
            const int at = span.at + span.begin;
            learn_row(span.end - span.begin, change, per_roll, per_both, work->adjoint + at,
                      work->state + at, work->last + at, work->by_place + at,
                      work->place_curve + at);
        }
        work->rolled = rolled;
        work->is_foretold = is_foretold;
        work->warm = goes_on ? 3 : 2;
    } else if (work->warm == 0) {
        work->warm = 1;
    }

    /* From here to the next solution. */
    work->warm_place = place;
    work->approach = x;
}

/* Derivative by the roll of one row. */
APART void roll_row(int count, double rolled, const double *restrict by_place,
                    const double *restrict curve, double *restrict by_roll) {
    for (int k = 0; k < count; ++k) {
        by_roll[k] = by_place[k] + rolled * curve[k];
    }
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

/* How far the layers give way at the points as the lines roll: by the series through the last three solutions. */
static void roll_points(gmi_elastic_work *work) {
    for (int row = 0; row <= work->count; ++row) {
        const gmi_elastic_span span = gmi_elastic_span_of(work, row);
        const int at = span.at + span.begin;
        roll_row(span.end - span.begin, work->rolled, work->by_place + at, work->place_curve + at,
                 work->other + at);
    }
    double *pull = work->pull, *tooth_adjoint = work->tooth_adjoint;
    work->pull = work->held_by_roll;
    work->tooth_adjoint = work->scratch;
    gmi_elastic_pull(work, NULL, work->other);
    work->pull = pull;
    work->tooth_adjoint = tooth_adjoint;
}

/* What the next solution begins with. */
static void keep(const gmi_elastic *law, gmi_elastic_work *work, double x, int is_foretold,
                 double energy) {
    learn(work, x, is_foretold);
    if (work->is_rolling) {
        roll_points(work);
    }
    extend(law, work, work->state);
    extend(law, work, work->adjoint);
    extend(law, work, work->by_place);
    extend(law, work, work->place_curve);
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

/*
 * How far the series of the contact law follows a step, from the points before it and gamma behind it. With the rise t of a
 * load in first order, as part of it, and p = B q',
 *
 *     q'' = p q'^2 / q,    q''' = (3 p - 1) p q'^3 / q^2:
 *
 * what the load grows by is q t (1 + p t / 2 (1 + (p - 1/3) t)), and q' grows by the part p t (1 + (3 p - 1) t / 2). doubt:
 * the next term, about, and what the second order leaves out of the adjoint; huge where a load changes too much, begins, or
 * is on the straight part. energy: in first order.
 */
APART void look_at_points(int count, double per_compliance, double x, const double *restrict slope,
                          const double *restrict load, const double *restrict change,
                          const double *restrict approach, const double *restrict weight,
                          const double *restrict expected, const double *restrict deviation,
                          double *restrict doubt, double *restrict energy) {
    const double quarter = 0.25 / per_compliance;
    for (int k = 0; k < count; ++k) {
        const double p = slope[k], q = load[k];
        const double rise = p * change[k] * per_compliance;
        const double t = fabs(rise / (q + LEAST_LOAD));
        const double begins = q > 0.0 ? 0.0 : approach[k];
        const double changed = t > FAR ? HUGE_DOUBT : 0.0;
        const double straight = p < 1.0 ? changed : HUGE_DOUBT;
        const double beyond = begins > 0.0 ? HUGE_DOUBT : straight;
        const double bend = 0.5 * weight[k] * p * fabs(rise) * t;
        doubt[k] = beyond + bend * (0.3 * p * t + t * t);
        energy[k] = expected[k] * (0.5 * (x + deviation[k]) - quarter * (q + rise));
    }
}

/* Loads, forces and energies of the points after the last step, and the stiffness there as sums see it. */
APART void finish_points(int count, double per_compliance, double x, const double *restrict slope,
                         const double *restrict change, const double *restrict approach,
                         const double *restrict weight, const double *restrict expected,
                         const double *restrict deviation, const double *restrict pull,
                         double *restrict load, double *restrict force, double *restrict stiffness,
                         double *restrict by_deviation, double *restrict excess,
                         double *restrict stiffer, double *restrict energy) {
    const double half = 0.5 / per_compliance, third = 1.0 / 3.0;
    for (int k = 0; k < count; ++k) {
        /* The series of look_at_points(), where it holds. */
        const double p = slope[k], rise = p * change[k] * per_compliance;
        const double t = rise / (load[k] + LEAST_LOAD);
        const double within = fabs(t) > FAR ? 0.0 : 1.0;
        const double holds = p < 1.0 ? within : 0.0;
        const double further = holds * p * t, next = (p - third) * t;
        const double bend = 0.5 * rise * further * (1.0 + next);
        const double steeper = further * (1.0 + 1.5 * next);

        /* What the layers take of it. */
        const double q = load[k] + rise + bend;
        const double change_of = stiffness[k] * steeper;
        load[k] = q;
        excess[k] = weight[k] * bend;
        force[k] = expected[k] + weight[k] * bend * pull[k];
        stiffer[k] = change_of;
        by_deviation[k] = (stiffness[k] + change_of * pull[k]) * pull[k];
        stiffness[k] = stiffness[k] + change_of;

        /* In balance the layers hold half the work of the loads expected. */
        const double given_way = x + deviation[k] - approach[k];
        energy[k] = 0.5 * (expected[k] * given_way + weight[k] * q * (approach[k] - half * q));
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

/*
 * Whether the last step may be one that the contact law's series follows: the estimate of what that leaves of the force. Also
 * the energy in first order.
 */
static double look_at_step(const gmi_elastic *law, gmi_elastic_work *work, double x,
                           double *energy) {
    const int count = 2 * work->slots;
    double *energies = work->by_deviation;
    look_at_points(count, 1.0 / law->hertz_compliance, x, work->slope, work->load, work->change_at,
                   work->approach_at, work->weight, work->expected, work->deviation, work->scratch,
                   energies);
    *energy = gmi_elastic_sum(count, energies);
    return gmi_elastic_sum(count, work->scratch) / gmi_elastic_sum(count, work->expected);
}

/* What the last step leaves at the points, and the sums of it. */
static void finish(const gmi_elastic *law, gmi_elastic_work *work, double x,
                   gmi_elastic_result *result) {
    const int slots = work->slots;

    /* What the layers leave of a change at each point, and the points behind the step. */
    find_adjoint(law, work);
    gmi_elastic_pull(work, NULL, work->adjoint);
    finish_points(2 * slots, 1.0 / law->hertz_compliance, x, work->slope, work->change_at,
                  work->approach_at, work->weight, work->expected, work->deviation, work->pull,
                  work->load, work->force, work->stiffness, work->by_deviation, work->excess,
                  work->stiffer, work->scratch);

    /* The sums, line by line. */
    result->force = 0.0;
    for (int k = 0; k < work->count; ++k) {
        const gmi_elastic_line *line = &work->line[k];
        result->line_force[k] = gmi_elastic_sum(line->slots, work->force + line->slot) +
                                gmi_elastic_sum(line->slots, work->force + slots + line->slot);
        result->force += result->line_force[k];
    }
    result->by_approach = gmi_elastic_sum(2 * slots, work->by_deviation);
    result->energy = gmi_elastic_sum(2 * slots, work->scratch);

    work->straight = is_straight(2 * slots, work->slope);
    if (work->straight) {
        result->energy += straight_energy(law, work);
    }
}

/* How the search for the balance stands. */
typedef struct search {
    double scale;    /* of the energy, of the last solution or from the first step */
    double root;     /* where it ends */
    int is_followed; /* whether the series of the contact law may be trusted with a step ... */
    int iteration;
    int is_foretold; /* ... of which the first one was short */
} search;

/* Whether the step just made is the last one: by what another one could win, or as the series follows it. */
static int is_last(const gmi_elastic *law, gmi_elastic_work *work, double x, double fall,
                   search *at) {
    const int is_first = at->iteration == 1;
    if (is_first) {
        at->is_foretold = fall <= NEAR * NEAR * at->scale;
    }
    const double near = at->is_followed ? NEAR : 10.0 * at->root;
    if (!(fall <= near * near * at->scale)) {
        return 0;
    }

    /* With the energy that belongs to this state: far from balance it may come out as anything, below 0 too. */
    double energy;
    const double left = look_at_step(law, work, x, &energy);
    const double limit = is_first ? NEAR : NEAR_AGAIN;
    const int is_over = fall <= at->root * at->root * energy;
    work->is_rolling = !is_over && is_first;
    return is_over ||
           (at->is_followed && fall <= limit * limit * energy && left >= 0.0 && left <= LEAVES);
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
    const int is_warm = work->warm > 0;
    search at = {.scale = is_warm ? work->energy : (double)INFINITY,
                 .root = is_warm ? CONVERGED : CONVERGED_COLD,
                 .is_followed =
                     work->sums_alone && work->warm > 1 && (work->is_foretold || has_rolled(work))};
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

        at.iteration = iteration;
        if (is_last(law, work, approach, fall, &at)) {
            finish(law, work, approach, result);
            result->iterations = iteration;
            keep(law, work, approach, at.is_foretold, result->energy);
            return GM_OK;
        }

        /* The next residual: what the loads exceed the expected ones by. */
        memcpy(work->last_step, work->change, bytes);
        clear_rows(work, work->change);
        gmi_elastic_load(law, work);
        gmi_elastic_gather(work, work->scratch, work->change);
        at.scale = at.scale < (double)INFINITY ? at.scale : fall;
        last = fall;
    }
    answer_nan(work, result);
    return GM_NO_CONVERGENCE;
}
