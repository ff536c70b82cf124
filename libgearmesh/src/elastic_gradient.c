/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Exact derivatives of elastic teeth in balance, whatever their number, by one adjoint solution.
 *
 * For G = sum m W q over the points, with K the Newton matrix and J the row of a point (s N of its tooth layer, N of the
 * rim), K lambda = sum J' m W dq/d gamma. A parameter p that changes w, s, rate, weight or place of the points changes G by
 *
 *     dG/dp = sum (m_p W q + m (W_p q + W q_p)) - lambda . h_p
 *           = sum m_p W q + (W_p q + W q_p)(m - J lambda) - W q J_p lambda,
 *
 * where q_p is taken at fixed deflections: q_p = dq/d gamma (w_p - J_p v) + q b (ln rate)_p, b = B dq/d gamma. The energy
 * needs no adjoint, as its derivative by the deflections vanishes: U_p = sum W_p U_H + W (q gamma_p + B q^2 / 2 (ln rate)_p).
 *
 * A line that ends within the face has an end that moves with the line and with the path. Its last part is cut there: a
 * moving end changes weight and places of the two points of that part.
 */
#include "elastic.h"

#include "hertz.h"
#include "internal.h"

#include <string.h>

/* ---------------------------------------------------------------------------------------------
 * All points moved along rho_p, or the line of action
 * ------------------------------------------------------------------------------------------- */

/* What that does to a functional: without its own slope. by_p: slopes along what is moved; deviation NULL: none. */
APART void functional_terms(int count, const double *restrict force,
                            const double *restrict stiffness, const double *restrict slope,
                            const double *restrict deflection, const double *restrict pull,
                            const double *restrict tooth_adjoint,
                            const double *restrict deviation_by_p,
                            const double *restrict tooth_by_p, const double *restrict rate_by_p,
                            double *restrict terms) {
    for (int p = 0; p < count; ++p) {
        const double moved = deviation_by_p[p] - tooth_by_p[p] * deflection[p];
        const double change = stiffness[p] * moved + force[p] * slope[p] * rate_by_p[p];
        terms[p] = change * pull[p] - force[p] * tooth_by_p[p] * tooth_adjoint[p];
    }
}

/* To the energy. half: B / 2. */
APART void energy_terms(int count, double half, const double *restrict force,
                        const double *restrict load, const double *restrict deflection,
                        const double *restrict deviation_by_p, const double *restrict tooth_by_p,
                        const double *restrict rate_by_p, double *restrict terms) {
    for (int p = 0; p < count; ++p) {
        const double moved = deviation_by_p[p] - tooth_by_p[p] * deflection[p];
        terms[p] = force[p] * (moved + half * load[p] * rate_by_p[p]);
    }
}

/* Load at which the straight part of the contact law begins, from where on it does not depend on the rate. */
static double last_load(const gmi_elastic *law, const gmi_elastic_work *work, int p) {
    return 0.5 * gmi_hertz_largest / (law->hertz_compliance * work->rate[p]);
}

/* On the straight part: what the terms above count too much. */
static double straight_functional(const gmi_elastic *law, const gmi_elastic_work *work,
                                  const double *rate_by_p) {
    double sum = 0.0;
    for (int p = 0; p < 2 * work->slots; ++p) {
        if (work->slope[p] >= 1.0) {
            const double excess = work->load[p] - last_load(law, work, p);
            sum += work->weight[p] * excess * rate_by_p[p] * work->pull[p];
        }
    }
    return sum;
}

static double straight_energy_by(const gmi_elastic *law, const gmi_elastic_work *work,
                                 const double *rate_by_p) {
    double sum = 0.0;
    for (int p = 0; p < 2 * work->slots; ++p) {
        if (work->slope[p] >= 1.0) {
            const double excess = work->load[p] - last_load(law, work, p);
            sum += 0.5 * law->hertz_compliance * work->weight[p] * excess * excess * rate_by_p[p];
        }
    }
    return sum;
}

/* ---------------------------------------------------------------------------------------------
 * Ends of lines
 * ------------------------------------------------------------------------------------------- */

typedef struct end_effect {
    double functional, energy;
} end_effect;

static double slope_of(const double *row, double per_spacing) {
    return (row[1] - row[0]) * per_spacing;
}

/* Share of the movement of an end (0: begin, 1: end of the line) that a point of its part makes. */
static double share_of_end(int end, int half) {
    static const double gauss[2] = {0.21132486540518711775, 0.78867513459481288225};
    return end == 0 ? 1.0 - gauss[half] : gauss[half];
}

static double optional(const double *values, int p, double otherwise) {
    return values != NULL ? values[p] : otherwise;
}

/* What moving one end of a line along z does. rows: the adjoint. */
static end_effect move_end(const gmi_elastic *law, const gmi_elastic_work *work,
                           const gmi_elastic_functional *functional, const double *rows, int row,
                           int end) {
    const gmi_elastic_line *line = &work->line[row];
    const int last = end == 0 ? 0 : line->elements - 1;
    const int node = line->element + last;
    const int at = row * work->stations + node, at_rim = work->lines_max * work->stations + node;
    const double climb = work->at.climb, sign = end == 0 ? -0.5 : 0.5;
    const double tooth_slope = slope_of(work->state + at, law->per_spacing);
    const double rim_slope = slope_of(work->state + at_rim, law->per_spacing);
    const double adjoint_slope = slope_of(rows + at, law->per_spacing);
    const double rim_adjoint_slope = slope_of(rows + at_rim, law->per_spacing);
    end_effect effect = {0.0, 0.0};
    for (int half = 0; half < 2; ++half) {
        const int p = line->slot + last + half * work->slots;
        const double tooth = work->tooth[p], force = work->force[p], pull = work->pull[p];
        const double tooth_by_z = climb * work->tooth_by_roll[p];
        const double rate_by_z = climb * work->rate_by_roll[p];

        /* The point goes along z, and with the line along rho_p. */
        const double opened = work->deviation_by_z[p] + climb * work->deviation_by_roll[p] -
                              tooth_by_z * work->deflection[p] - tooth * tooth_slope - rim_slope;
        gmi_hertz_state contact;
        gmi_hertz_evaluate(law->hertz_compliance, work->rate[p], work->approach_at[p], &contact);
        const double weight = work->weight[p];
        const double pushed = work->stiffness[p] * opened - weight * contact.load_by_L * rate_by_z;
        const double factor_by_z = optional(functional->factor_by_z, p, 0.0) +
                                   climb * optional(functional->factor_by_roll, p, 0.0);
        const double along = factor_by_z * force + pushed * pull -
                             force * (tooth_by_z * work->tooth_adjoint[p] + tooth * adjoint_slope +
                                      rim_adjoint_slope);
        const double share = share_of_end(end, half);
        const double by_load =
            optional(functional->by_load, p, 0.0); /* a weight leaves q as it is */
        effect.functional += sign * work->load[p] * (pull - by_load) + share * along;
        effect.energy += sign * contact.energy +
                         share * (force * opened - weight * contact.energy_by_L * rate_by_z);
    }
    return effect;
}

/* An end moves along z by 1 / climb with the path, and by -1 / climb with the line. */
static void add_end(const gmi_elastic_work *work, int limited, double effect,
                    gmi_elastic_gradient *gradient) {
    const double along = effect / work->at.climb;
    gradient->by_roll -= along;
    if (limited < 0) {
        gradient->by_lower += along;
    } else {
        gradient->by_upper += along;
    }
}

/* energy: may be NULL. */
static void add_ends(const gmi_elastic *law, const gmi_elastic_work *work,
                     const gmi_elastic_functional *functional, const double *rows,
                     gmi_elastic_gradient *gradient, gmi_elastic_gradient *energy) {
    for (int row = 0; row < work->count; ++row) {
        for (int end = 0; end < 2; ++end) {
            const int limited = work->line[row].limited[end];
            if (limited != 0) {
                const end_effect effect = move_end(law, work, functional, rows, row, end);
                add_end(work, limited, effect.functional, gradient);
                if (energy != NULL) {
                    add_end(work, limited, effect.energy, energy);
                }
            }
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * Together
 * ------------------------------------------------------------------------------------------- */

/* work->pull and work->tooth_adjoint are those of the functional. */
static void move_points(const gmi_elastic *law, gmi_elastic_work *work,
                        gmi_elastic_gradient *gradient) {
    const int count = 2 * work->slots;
    functional_terms(count, work->force, work->stiffness, work->slope, work->deflection, work->pull,
                     work->tooth_adjoint, work->deviation_by_roll, work->tooth_by_roll,
                     work->rate_by_roll, work->scratch);
    gradient->by_roll = gmi_elastic_sum(count, work->scratch);
    if (work->straight) {
        gradient->by_roll -= straight_functional(law, work, work->rate_by_roll);
    }
}

/* The line of action alone is moved in a pose: the deviations have no slope along it. */
static void move_action(const gmi_elastic *law, gmi_elastic_work *work,
                        gmi_elastic_gradient *gradient) {
    if (work->at.slopes < 2) {
        return;
    }
    double sum = 0.0;
    for (int p = 0; p < 2 * work->slots; ++p) {
        const double moved = -work->tooth_by_action[p] * work->deflection[p];
        const double change =
            work->stiffness[p] * moved + work->force[p] * work->slope[p] * work->rate_by_action[p];
        sum += change * work->pull[p] -
               work->force[p] * work->tooth_by_action[p] * work->tooth_adjoint[p];
    }
    if (work->straight) {
        sum -= straight_functional(law, work, work->rate_by_action);
    }
    gradient->by_action = sum;
}

static void differentiate_energy(const gmi_elastic *law, gmi_elastic_work *work,
                                 gmi_elastic_gradient *energy) {
    const int count = 2 * work->slots;
    const double half = 0.5 * law->hertz_compliance;
    energy_terms(count, half, work->force, work->load, work->deflection, work->deviation_by_roll,
                 work->tooth_by_roll, work->rate_by_roll, work->scratch);
    energy->by_roll = gmi_elastic_sum(count, work->scratch);
    if (work->straight) {
        energy->by_roll -= straight_energy_by(law, work, work->rate_by_roll);
    }
    if (work->at.slopes > 1) {
        double sum = 0.0;
        for (int p = 0; p < count; ++p) {
            sum += work->force[p] * (half * work->load[p] * work->rate_by_action[p] -
                                     work->tooth_by_action[p] * work->deflection[p]);
        }
        if (work->straight) {
            sum -= straight_energy_by(law, work, work->rate_by_action);
        }
        energy->by_action = sum;
    }
}

void gmi_elastic_differentiate(const gmi_elastic *law, gmi_elastic_work *work,
                               gmi_elastic_gradient *force, gmi_elastic_gradient *energy) {
    GMI_CALL_WIDE(law, gmi_wide_differentiate(law, work, force, energy))
    static const gmi_elastic_functional unit = {NULL, NULL, NULL, NULL};
    memset(force, 0, sizeof *force);
    memset(energy, 0, sizeof *energy);
    if (!work->touching) {
        return;
    }
    const int count = 2 * work->slots;
    force->value = energy->by_approach = gmi_elastic_sum(count, work->force);
    force->by_approach = gmi_elastic_sum(count, work->by_deviation);
    energy->value = work->energy;
    move_points(law, work, force);
    differentiate_energy(law, work, energy);
    move_action(law, work, force);
    add_ends(law, work, &unit, work->adjoint, force, energy);
}

void gmi_elastic_differentiate_functional(const gmi_elastic *law, gmi_elastic_work *work,
                                          const gmi_elastic_functional *functional,
                                          double *by_deviation, gmi_elastic_gradient *gradient) {
    GMI_CALL_WIDE(law,
                  gmi_wide_differentiate_functional(law, work, functional, by_deviation, gradient))
    const int count = 2 * work->slots;
    memset(gradient, 0, sizeof *gradient);
    if (!work->touching) {
        memset(by_deviation, 0, sizeof *by_deviation * (size_t)count);
        return;
    }

    /* Its adjoint. */
    memset(work->other, 0, sizeof(double) * (size_t)(work->lines_max + 1) * (size_t)work->stations);
    for (int p = 0; p < count; ++p) {
        work->scratch[p] = optional(functional->factor, p, 1.0) * work->stiffness[p];
    }
    gmi_elastic_gather(work, work->scratch, work->other);
    gmi_elastic_substitute(work, work->other);

    /* Beside that of the force, which stays for the next call: in arrays that are free after the last step. */
    double *pull = work->pull, *tooth_adjoint = work->tooth_adjoint;
    work->pull = work->change_at;
    work->tooth_adjoint = work->expected;
    gmi_elastic_pull(work, functional->factor, work->other);

    move_points(law, work, gradient);
    move_action(law, work, gradient);
    add_ends(law, work, functional, work->other, gradient, NULL);
    for (int p = 0; p < count; ++p) {
        by_deviation[p] = work->stiffness[p] * work->pull[p];
        work->scratch[p] = optional(functional->factor, p, 1.0) * work->force[p];
    }
    gradient->by_approach = gmi_elastic_sum(count, by_deviation);
    gradient->value = gmi_elastic_sum(count, work->scratch);
    for (int p = 0; p < count && functional->factor_by_roll != NULL; ++p) {
        gradient->by_roll += functional->factor_by_roll[p] * work->force[p];
    }
    work->pull = pull;
    work->tooth_adjoint = tooth_adjoint;
}
