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
 * moving end changes weight and places of the two points of that part. So do cuts where reliefs begin, if they move with the
 * line.
 */
#include "elastic.h"
#include "hertz.h"
#include "internal.h"
#include "wide.h"

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

/* What the adjoint of a matrix less `stiffer` counts too much of how the layers give way. */
APART void stiffer_terms(int count, const double *restrict stiffer, const double *restrict pull,
                         const double *restrict held, double *restrict terms) {
    for (int p = 0; p < count; ++p) {
        terms[p] = stiffer[p] * pull[p] * (1.0 - held[p]);
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

static double slope_of(const double *row, double per_spacing) {
    return (row[1] - row[0]) * per_spacing;
}

static double optional(const double *values, int p, double otherwise) {
    return values != NULL ? values[p] : otherwise;
}

/*
 * What moves with the path and the lines: a part of a line, and which ends of it: 1 its begin, 2 its end, 3 both. by_roll:
 * along z, where it is not limited by the path.
 */
typedef struct moving_part {
    int row, node, slot, ends, limited;
    double by_roll;
} moving_part;

/* Of the ends of a part that move, none, 1, 2 or 3: the share of it that each point makes, and how much both weights grow. */
static const double share_of[4][2] = {{0.0, 0.0},
                                      {0.78867513459481288225, 0.21132486540518711775},
                                      {0.21132486540518711775, 0.78867513459481288225},
                                      {1.0, 1.0}};
static const double growth_of[4] = {0.0, -0.5, 0.5, 0.0};

/* Slopes of both layers along z in the element of a part, of an array over stations. */
typedef struct layer_slopes {
    double tooth, rim;
} layer_slopes;

static layer_slopes slopes_of(const gmi_elastic *law, const gmi_elastic_work *work,
                              const double *rows, const moving_part *part) {
    const double *tooth = rows + part->row * work->stations + part->node;
    const double *rim = rows + work->lines_max * work->stations + part->node;
    const layer_slopes slopes = {slope_of(tooth, law->per_spacing),
                                 slope_of(rim, law->per_spacing)};
    return slopes;
}

/* By how much the approach of a point grows that goes along z, and with the line along rho_p. */
static double opened_at(const gmi_elastic_work *work, const layer_slopes *state, int p) {
    const double by_roll =
        work->deviation_by_roll[p] - work->tooth_by_roll[p] * work->deflection[p];
    return work->deviation_by_z[p] + work->at.climb * by_roll - work->tooth[p] * state->tooth -
           state->rim;
}

/*
 * What moving ends along z do to a functional; rows: its adjoint. From q (L - ln q) = gamma / B: dq/d ln(rate) =
 * q B dq/d gamma.
 */
static double move_functional(const gmi_elastic *law, const gmi_elastic_work *work,
                              const gmi_elastic_functional *functional, const double *rows,
                              const moving_part *part) {
    const double climb = work->at.climb, grown = growth_of[part->ends];
    const layer_slopes state = slopes_of(law, work, work->state, part);
    const layer_slopes adjoint = slopes_of(law, work, rows, part);
    double effect = 0.0;
    for (int half = 0; half < 2; ++half) {
        const int p = part->slot + half * work->slots;
        const double force = work->force[p], load = work->load[p], pull = work->pull[p];
        const double rate_by_z = climb * work->rate_by_roll[p];
        double pushed =
            work->stiffness[p] * opened_at(work, &state, p) + force * work->slope[p] * rate_by_z;
        if (work->slope[p] >= 1.0) {
            pushed -= work->weight[p] * (load - last_load(law, work, p)) * rate_by_z;
        }
        const double factor_by_z = optional(functional->factor_by_z, p, 0.0) +
                                   climb * optional(functional->factor_by_roll, p, 0.0);
        const double bent = climb * work->tooth_by_roll[p] * work->tooth_adjoint[p] +
                            work->tooth[p] * adjoint.tooth + adjoint.rim;
        const double along = force * (factor_by_z - bent) + pushed * pull;

        /* A weight leaves q as it is. */
        const double by_load = optional(functional->by_load, p, 0.0);
        effect += grown * load * (pull - by_load) + share_of[part->ends][half] * along;
    }
    return effect;
}

/* To the energy, which is q (gamma - B q / 2) / 2 at a point, and by ln(rate) B q^2 / 2. */
static double move_energy(const gmi_elastic *law, const gmi_elastic_work *work,
                          const moving_part *part) {
    const double half_compliance = 0.5 * law->hertz_compliance;
    const double climb = work->at.climb, grown = growth_of[part->ends];
    const layer_slopes state = slopes_of(law, work, work->state, part);
    double effect = 0.0;
    for (int half = 0; half < 2; ++half) {
        const int p = part->slot + half * work->slots;
        const double load = work->load[p], rate_by_z = climb * work->rate_by_roll[p];
        const double own = half_compliance * load;
        double energy = 0.5 * load * (work->approach_at[p] - own);
        double along = work->force[p] * (opened_at(work, &state, p) + own * rate_by_z);

        /* What is lacking on the straight part of the contact law. */
        if (work->slope[p] >= 1.0) {
            const double excess = load - last_load(law, work, p);
            const double lacking = half_compliance * excess * excess;
            energy += 0.5 * lacking;
            along -= work->weight[p] * lacking * rate_by_z;
        }
        effect += grown * energy + share_of[part->ends][half] * along;
    }
    return effect;
}

/* An end moves along z by 1 / climb with the path, and by -1 / climb with the line; a crease as it says. */
static void add_end(const gmi_elastic_work *work, const moving_part *part, double effect,
                    gmi_elastic_gradient *gradient) {
    if (part->limited == 0) {
        gradient->by_roll += effect * part->by_roll;
        return;
    }
    const double along = effect / work->at.climb;
    gradient->by_roll -= along;
    if (part->limited < 0) {
        gradient->by_lower += along;
    } else {
        gradient->by_upper += along;
    }
}

/* functional and gradient of it, energy: may be NULL. */
static void add_part(const gmi_elastic *law, const gmi_elastic_work *work, const moving_part *part,
                     const gmi_elastic_functional *functional, const double *rows,
                     gmi_elastic_gradient *gradient, gmi_elastic_gradient *energy) {
    if (gradient != NULL) {
        add_end(work, part, move_functional(law, work, functional, rows, part), gradient);
    }
    if (energy != NULL) {
        add_end(work, part, move_energy(law, work, part), energy);
    }
}

static int is_loaded(const gmi_elastic_work *work, int slot) {
    return work->force[slot] != 0.0 || work->force[slot + work->slots] != 0.0;
}

static void add_ends(const gmi_elastic *law, const gmi_elastic_work *work,
                     const gmi_elastic_functional *functional, const double *rows,
                     gmi_elastic_gradient *gradient, gmi_elastic_gradient *energy) {
    for (int row = 0; row < work->count; ++row) {
        const gmi_elastic_line *line = &work->line[row];
        for (int end = 0; end < 2; ++end) {
            const int last = end == 0 ? 0 : line->elements - 1;
            const int slot = end == 0 ? line->slot : line->end;
            if (line->limited[end] != 0 && is_loaded(work, slot)) {
                const moving_part part = {row,      line->element + last, slot,
                                          1 << end, line->limited[end],   0.0};
                add_part(law, work, &part, functional, rows, gradient, energy);
            }
        }
    }

    /* A cut is the end of one part and the begin of the next; what lies between two of the same end moves as a whole. */
    int is_joined = 0;
    for (int k = 0; k < work->cuts; ++k) {
        const gmi_elastic_cut *cut = &work->cut[k];
        if (cut->by_roll == 0.0) {
            is_joined = 0; /* a relief at an end of the face */
            continue;
        }
        if (is_loaded(work, cut->before)) {
            const moving_part before = {cut->row,          cut->element, cut->before,
                                        is_joined ? 3 : 2, cut->limit,   cut->by_roll};
            add_part(law, work, &before, functional, rows, gradient, energy);
        }
        is_joined = cut->limit != 0 && !cut->is_last && cut[1].limit == cut->limit;
        if (!is_joined && is_loaded(work, cut->after)) {
            const moving_part after = {cut->row, cut->element, cut->after,
                                       1,        cut->limit,   cut->by_roll};
            add_part(law, work, &after, functional, rows, gradient, energy);
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * Together
 * ------------------------------------------------------------------------------------------- */

APART void multiply(int count, const double *restrict first, const double *restrict second,
                    double *restrict product) {
    for (int p = 0; p < count; ++p) {
        product[p] = first[p] * second[p];
    }
}

/* The factor of a functional times an array over the points. */
static void weigh(int count, const double *factor, const double *values, double *product) {
    if (factor == NULL) {
        memcpy(product, values, sizeof(double) * (size_t)count);
    } else {
        multiply(count, factor, values, product);
    }
}

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
    if (work->is_rolling) {
        stiffer_terms(count, work->stiffer, work->pull, work->held_by_roll, work->scratch);
        gradient->by_roll -= gmi_elastic_sum(count, work->scratch);
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

    /* By the common roll. */
    energy_terms(count, half, work->force, work->load, work->deflection, work->deviation_by_roll,
                 work->tooth_by_roll, work->rate_by_roll, work->scratch);
    energy->by_roll = gmi_elastic_sum(count, work->scratch);
    if (work->straight) {
        energy->by_roll -= straight_energy_by(law, work, work->rate_by_roll);
    }

    /* And by the line of action at a fixed roll of the pinion, where that is asked for. */
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
    memset(energy, 0, sizeof *energy);
    if (force != NULL) {
        memset(force, 0, sizeof *force);
    }
    if (!work->touching) {
        return;
    }

    /* The energy: by x it is the force. */
    const int count = 2 * work->slots;
    energy->value = work->energy;
    energy->by_approach = gmi_elastic_sum(count, work->force);
    differentiate_energy(law, work, energy);

    /* The force, by the adjoint that it has left. */
    if (force != NULL) {
        force->value = energy->by_approach;
        force->by_approach = gmi_elastic_sum(count, work->by_deviation);
        move_points(law, work, force);
        move_action(law, work, force);
    }

    /* Both by the ends of the lines, which move with the roll. */
    add_ends(law, work, &unit, work->adjoint, force, energy);
}

/* terms -= factor * stiffer: to the stiffness of the matrix that was eliminated. */
static void less_stiff(int count, const double *factor, const double *stiffer, double *terms) {
    for (int p = 0; p < count; ++p) {
        terms[p] -= optional(factor, p, 1.0) * stiffer[p];
    }
}

/*
 * What the series of the contact law leaves to a functional, in second order: of the excess beyond what it leaves to the
 * points, which is the result, and of the stiffness. pull: that of the force.
 */
static double follow_series(const gmi_elastic_work *work, const double *factor, const double *pull,
                            double *by_deviation) {
    double sum = 0.0;
    for (int p = 0; p < 2 * work->slots; ++p) {
        sum += work->excess[p] * (work->pull[p] - optional(factor, p, 1.0) * pull[p]);
        by_deviation[p] -= work->stiffer[p] * (1.0 - pull[p]) * work->pull[p];
    }
    return sum;
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
    weigh(count, functional->factor, work->stiffness, work->scratch);
    less_stiff(count, functional->factor, work->stiffer, work->scratch);
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

    /* By the deviations, and the functional itself. */
    multiply(count, work->stiffness, work->pull, by_deviation);
    const double bent = follow_series(work, functional->factor, pull, by_deviation);
    weigh(count, functional->factor, work->force, work->scratch);
    gradient->by_approach = gmi_elastic_sum(count, by_deviation);
    gradient->value = gmi_elastic_sum(count, work->scratch) + bent;
    if (functional->factor_by_roll != NULL) {
        multiply(count, functional->factor_by_roll, work->force, work->scratch);
        gradient->by_roll += gmi_elastic_sum(count, work->scratch);
    }
    work->pull = pull;
    work->tooth_adjoint = tooth_adjoint;
}
