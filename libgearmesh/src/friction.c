/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Friction of the flanks. Where they touch at rho_p they slide on each other by
 *
 *     v = omega_p rho_p - omega_w rho_w,     rho_w = T - rho_p      (in the signs of ISO 21771, a ring's below 0),
 *
 * which at constant x is (omega_p + omega_w) (rho_p - rho_C), zero in the pitch point C, and less what the wheel's body
 * moves across the line of action, where its axis moves. Friction mu_r times the normal
 * force acts across the line of action, with mu_r = mu v / sqrt(v^2 + v0^2): it turns round in the pitch point without a
 * jump.
 *
 * Lines of contact are cut at fixed places, one of them the pitch point. Along a part v is straight, and the integrals
 * of mu_r have a closed form for a load that is even or straight there: exact between ideal flanks of parallel axes.
 * They take the force of a part, its first moments and its touching length. Friction of a part acts a little farther
 * from the pitch point than the middle of its load; torques and loss take it there, so that power in is power out and
 * loss, to rounding.
 */
#include "friction.h"

#include "internal.h"
#include "line.h"
#include "meshing.h"
#include "side_tangent.h"

#include <math.h>

static const double per_ln_10 = 0.43429448190325182765;

/* Of the formulas below, which take N/mm, mm, mPa s and um. */
static const double milli = 1e3, micro = 1e6;

/* ---------------------------------------------------------------------------------------------
 * What never changes
 * ------------------------------------------------------------------------------------------- */

/* Mean coefficient of Schlenk [ISO14179]: 0.048 (F/b / (v_sum rho_red))^0.2 eta^-0.05 Ra^0.25, without F and v_sum. */
static double schlenk_factor(const gm_mesh_params *params, const gm_pair *pair, double rho_p,
                             double rho_w) {
    const double reduced = rho_p * rho_w / (rho_p + rho_w) / cos(pair->base_helix_angle);
    const double load = 1.0 / (milli * pair->face_width * milli * reduced);
    return 0.048 * pow(load, 0.2) * pow(milli * params->oil_viscosity, -0.05) *
           pow(micro * params->roughness, 0.25);
}

/* Parts are twice as long from one to the next: as mu_r changes most next to the pitch point. */
static const double cut_shares[GMI_FRICTION_CUTS] = {-0.5, -0.25, -0.125, 0.0, 0.125, 0.25, 0.5};

void gmi_friction_place(const gm_pair *pair, const gmi_engagement *at, gmi_friction *friction) {
    const double pitch_point = pair->pinion.base_radius * tan(at->working_pressure_angle);
    const double beyond = at->line_of_action - pitch_point;
    const double reach =
        fmax(pair->pinion.tip_roll_length - pitch_point, at->tip_roll_length[GM_WHEEL] - beyond);
    friction->pitch_point = pitch_point;
    for (int k = 0; k < GMI_FRICTION_CUTS; ++k) {
        friction->cuts[k] = pitch_point + cut_shares[k] * reach;
    }
}

/* The pitch point divides the line of action in a ratio that stays; the longer way to a tip is one of two. */
double gmi_friction_cut_by_length(const gm_pair *pair, const gmi_engagement *at,
                                  const gmi_friction *friction, int k) {
    const double pitch_point = friction->pitch_point;
    const double beyond = at->line_of_action - pitch_point;
    const double pitch_point_by = pitch_point / at->line_of_action;
    const int is_pinions =
        pair->pinion.tip_roll_length - pitch_point >= at->tip_roll_length[GM_WHEEL] - beyond;
    return pitch_point_by - cut_shares[k] * (is_pinions ? pitch_point_by : 1.0 - pitch_point_by);
}

gmi_friction gmi_friction_of(const gm_mesh_params *params, const gm_pair *pair,
                             const gmi_engagement *at) {
    gmi_friction friction = {.is_on = 0};
    const int is_constant = params->friction_law == GM_FRICTION_CONSTANT;
    if (params->model == GM_MODEL_SIMPLE || (is_constant && params->friction_coefficient == 0.0)) {
        return friction;
    }

    friction.is_on = 1;
    friction.law = params->friction_law;
    friction.normal = 1.0 / cos(pair->base_helix_angle);
    friction.creep_squared = params->friction_speed * params->friction_speed;
    gmi_friction_place(pair, at, &friction);
    const double rho_p = friction.pitch_point;
    switch (params->friction_law) {
    case GM_FRICTION_ISO14179:
        friction.factor = schlenk_factor(params, pair, rho_p, at->line_of_action - rho_p);
        break;
    case GM_FRICTION_BENEDICT_KELLEY:
        friction.factor =
            29.66 * friction.normal / (pair->face_width * milli * params->oil_viscosity);
        break;
    default:
        friction.factor = params->friction_coefficient;
        break;
    }

    return friction;
}

/* ---------------------------------------------------------------------------------------------
 * Sliding and rolling
 * ------------------------------------------------------------------------------------------- */

void gmi_sliding_find(const gmi_friction *friction, const gm_pair *pair, const gmi_engagement *at,
                      const gm_position *position, const gmi_rates *rates, gmi_sliding *s) {
    const gmi_sliding none = {.friction = friction};
    *s = none;
    s->pinion_speed = position->pinion_speed;
    s->wheel_speed = (pair->pinion.base_radius * position->pinion_speed - position->offset_rate) /
                     at->wheel_base_radius;
    s->wheel_sign = pair->wheel.sign;
    s->line_of_action = at->line_of_action;
    for (int k = 0; k < 2 && rates != NULL; ++k) {
        s->sideways[k] = rates->sideways[k];
        s->forward[k] = rates->forward[k];
    }

    /* In the pitch point; v0 keeps the coefficients finite at rest. */
    const double rho_p = friction->pitch_point;
    const double rho_w = at->line_of_action - rho_p;
    const double sum = s->pinion_speed * rho_p + s->wheel_speed * rho_w;
    s->rolling.value = sqrt(sum * sum + friction->creep_squared);
    s->rolling.by[GMI_PINION_SPEED] = sum / s->rolling.value * rho_p;
    s->rolling.by[GMI_WHEEL_SPEED] = sum / s->rolling.value * s->wheel_sign * rho_w;
}

/* Where a point slides by. */
static double sliding_at(const gmi_sliding *s, double rho_p, double t1) {
    return s->pinion_speed * rho_p - s->wheel_speed * (s->line_of_action - rho_p) - s->sideways[0] -
           s->sideways[1] * t1;
}

/* ---------------------------------------------------------------------------------------------
 * Coefficients
 * ------------------------------------------------------------------------------------------- */

/* Of mu what depends on the place, by the sliding speed and by the logarithms of the load and of the rolling speed. */
typedef struct coefficient {
    double value, by_speed, by_load, by_rolling;
} coefficient;

/*
 * [BenedictKelley]: 0.0127 lg(29.66 (F/b) / (eta |v| v_sum^2)), N/m and mPa s, with sqrt(v^2 + v0^2) for |v|. Not below 0,
 * where the formula does not hold. The other laws have the same mu all over a side.
 */
SPECIALIZED coefficient coefficient_of(const gmi_sliding *s, double load, double speed) {
    coefficient mu = {1.0, 0.0, 0.0, 0.0};
    if (s->friction->law != GM_FRICTION_BENEDICT_KELLEY) {
        return mu;
    }

    /* A sliding speed of 0 has a finite logarithm by the creep speed. */
    const double squared = speed * speed + s->friction->creep_squared;
    const double factor = 0.0127 * per_ln_10;
    mu.value = factor * log(s->friction->factor * load /
                            (sqrt(squared) * s->rolling.value * s->rolling.value));
    if (!(mu.value > 0.0)) {
        mu.value = 0.0;
        return mu;
    }

    mu.by_speed = -factor * speed / squared;
    mu.by_load = factor;
    mu.by_rolling = -2.0 * factor;
    return mu;
}

/* ---------------------------------------------------------------------------------------------
 * Friction
 * ------------------------------------------------------------------------------------------- */

/* mu_r / cos(beta_b) with its derivatives: v / sqrt(v^2 + v0^2) changes by v0^2 / sqrt(v^2 + v0^2)^3. */
static gmi_point_friction friction_of(const gmi_sliding *s, double load, double speed) {
    const coefficient mu = coefficient_of(s, load, speed);
    const double creep_squared = s->friction->creep_squared;
    const double squared = speed * speed + creep_squared;
    const double per_root = s->friction->normal / sqrt(squared);
    const gmi_point_friction result = {
        .share = per_root * mu.value * speed,
        .speed = speed,
        .by_speed = per_root * (mu.value * creep_squared / squared + mu.by_speed * speed),
        .by_load = per_root * mu.by_load * speed,
        .by_rolling = per_root * mu.by_rolling * speed,
    };
    return result;
}

gmi_point_friction gmi_friction_at(const gmi_sliding *sliding, double rho_p, double t1,
                                   double load) {
    return friction_of(sliding, load, sliding_at(sliding, rho_p, t1));
}

/* v_sum is that in the pitch point, which divides T in a ratio that stays: it grows in proportion, v0 aside. */
gmi_rolling_by gmi_rolling_differentiate(const gmi_sliding *sliding) {
    const gmi_varying *rolling = &sliding->rolling;
    const double creep = sliding->friction->creep_squared / (rolling->value * rolling->value);
    const gmi_rolling_by by = {
        .pinion_speed = rolling->by[GMI_PINION_SPEED] / rolling->value,
        .wheel_speed = rolling->by[GMI_WHEEL_SPEED] * sliding->wheel_sign / rolling->value,
        .length = (1.0 - creep) / sliding->line_of_action,
    };
    return by;
}

/* ---------------------------------------------------------------------------------------------
 * Along a part
 * ------------------------------------------------------------------------------------------- */

/* A number of a part, by the sliding speed, by ln C, by the slope, and by how far the two middles are apart. */
typedef struct along_part {
    double value, by_speed, by_contact, by_slope, by_apart;
} along_part;

/* (y - asinh(y)) / y^3, and the derivative of its logarithm over y. */
static double arc_remainder(double y, double *growth) {
    const double y2 = y * y;
    if (y < 0.1) {
        const double value =
            1.0 / 6.0 -
            y2 * (3.0 / 40.0 - y2 * (15.0 / 336.0 - y2 * (105.0 / 3456.0 - y2 * 945.0 / 42240.0)));
        const double slope =
            3.0 / 20.0 - y2 * (15.0 / 84.0 - y2 * (105.0 / 576.0 - y2 * 945.0 / 5280.0));
        *growth = -slope / value;
        return value;
    }
    const double remainder = y - asinh(y);
    const double root = sqrt(1.0 + y2);
    *growth = y / (root * (1.0 + root) * remainder) - 3.0 / y2;
    return remainder / (y * y2);
}

/*
 * Of r = v / sqrt(v^2 + v0^2) where flanks slide by u - h .. u + h, u = v + w apart and h = |w| C / 2: its mean, and its
 * covariance with t1, by which it leans that way. With s the roots at both ends,
 *
 *     S = s_+ + s_-,     D = S^2 - 4 u^2,     y = h D / (S v0^2),     k = (v0^2 / 4) (y / h)^3 (y - asinh(y)) / y^3
 *     mean = 2 u / S + 3 k (v - u),     lean = k w C^2 / 4
 *
 * An even load has 2 u / S, and k h^2 is its covariance of r and v; a load that is straight in v has the second term too.
 */
static void find_along_part(const gmi_sliding_part *part, double creep_squared, along_part *mean,
                            along_part *lean) {
    const double w = part->slope, half_contact = 0.5 * part->contact;
    const double u = part->speed + w * part->apart;
    const double half = fabs(w) * half_contact;
    const double s_upper = sqrt((u + half) * (u + half) + creep_squared);
    const double s_lower = sqrt((u - half) * (u - half) + creep_squared);
    const double both = s_upper + s_lower, product = s_upper * s_lower;

    /* D without the difference of large numbers: the roots exceed |u +- h|, which are twice the larger of |u| and h. */
    const double half2 = half * half, along = fabs(u);
    const double larger = fmax(along, half);
    const double excess =
        creep_squared / (s_upper + fabs(u + half)) + creep_squared / (s_lower + fabs(u - half));
    const double d = 4.0 * (larger - along) * (larger + along) + excess * (4.0 * larger + excess);

    /* k, by u and, over h, by h. */
    const double both_by_speed = (u + half) / s_upper + (u - half) / s_lower;
    const double both_by_half = d / (both * product);
    const double ratio = d / (both * creep_squared); /* y / h */
    double growth;
    const double remainder = arc_remainder(half * ratio, &growth);
    const double grown = 3.0 + growth * half2 * ratio * ratio;
    const double k = 0.25 * creep_squared * ratio * ratio * ratio * remainder;
    const double k_by_speed =
        k * grown * ((2.0 * both * both_by_speed - 8.0 * u) / d - both_by_speed / both);
    const double k_by_half =
        k * (grown * (2.0 * both / d - 1.0 / both) * both_by_half + growth * ratio * ratio);

    /* The mean, first by u and, over h, by h. */
    const double behind = -w * part->apart; /* v - u */
    const double even = 2.0 * u / both;
    const double by_middle = 0.5 * d / (both * product) + 3.0 * k_by_speed * behind - 3.0 * k;
    const double by_half = -even / both * both_by_half + 3.0 * k_by_half * behind;
    const double half_by_slope = half_contact * half_contact * w; /* h dh / dw */
    mean->value = even + 3.0 * k * behind;
    mean->by_speed = by_middle + 3.0 * k;
    mean->by_contact = by_half * half2;
    mean->by_slope = by_half * half_by_slope + by_middle * part->apart;
    mean->by_apart = by_middle * w;

    const double square = half_contact * half_contact;
    lean->value = k * w * square;
    lean->by_speed = k_by_speed * w * square;
    lean->by_contact = w * square * (2.0 * k + k_by_half * half2);
    lean->by_slope = square * (k + w * (k_by_half * half_by_slope + k_by_speed * part->apart));
    lean->by_apart = k_by_speed * w * w * square;
}

static gmi_part_share share_of_part(const coefficient *mu, double normal, const along_part *r) {
    const double factor = normal * mu->value;
    const gmi_part_share share = {
        .value = factor * r->value,
        .by_speed = factor * r->by_speed + normal * mu->by_speed * r->value,
        .by_load = normal * mu->by_load * r->value,
        .by_rolling = normal * mu->by_rolling * r->value,
        .by_contact = factor * r->by_contact,
        .by_slope = factor * r->by_slope,
        .by_apart = factor * r->by_apart,
    };
    return share;
}

void gmi_friction_of_part(const gmi_sliding *s, const gmi_sliding_part *part,
                          gmi_part_friction *found) {
    const coefficient mu = coefficient_of(s, part->load, part->speed);
    along_part mean, lean;
    find_along_part(part, s->friction->creep_squared, &mean, &lean);
    found->share = share_of_part(&mu, s->friction->normal, &mean);
    found->lean = share_of_part(&mu, s->friction->normal, &lean);
}

/* ---------------------------------------------------------------------------------------------
 * Of a part, and of a side
 * ------------------------------------------------------------------------------------------- */

/* Share or lean of a part: by its load, of which rho_p and t1 are the means, and by how the flanks slide there. */
static void differentiate_share(const gmi_sliding *s, double advance, const gmi_part_share *at,
                                const gmi_load *load, const gmi_load_by *load_by, double rho_p,
                                double t1, double by[GMI_VARIABLES]) {
    const double by_speed = at->by_speed;
    const double touching_t1 = load->contact[1] / load->contact[0];

    /* By what the load changes with: its middle slides at another speed, and its size changes the coefficient. */
    for (int k = 0; k < GMI_LOAD_VARIABLES; ++k) {
        const double *force_by = load_by->force[k];
        const double rho_by = force_by[GMI_BY_RHO] - rho_p * force_by[GMI_WHOLE];
        const double t1_by = force_by[GMI_BY_T1] - t1 * force_by[GMI_WHOLE];
        by[k] = (by_speed * ((s->pinion_speed + s->wheel_speed) * rho_by - s->sideways[1] * t1_by) +
                 at->by_load * force_by[GMI_WHOLE] - at->by_apart * t1_by) /
                load->force[GMI_WHOLE];
    }
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        const double *contact_by = load_by->contact[k];
        const double middle_by = contact_by[1] - touching_t1 * contact_by[0];
        by[k] += ((at->by_contact - at->by_load) * contact_by[0] + at->by_apart * middle_by) /
                 load->contact[0];
    }

    /* By the line of action and the speeds of both gears, which roll and slide. */
    const gmi_rolling_by rolling = gmi_rolling_differentiate(s);
    const double by_both = at->by_slope * advance;
    by[GMI_BY_LENGTH] += at->by_rolling * rolling.length - by_speed * s->wheel_speed;
    by[GMI_BY_PINION_SPEED] = at->by_rolling * rolling.pinion_speed + by_speed * rho_p + by_both;
    by[GMI_BY_WHEEL_SPEED] =
        at->by_rolling * rolling.wheel_speed - by_speed * (s->line_of_action - rho_p) + by_both;
    by[GMI_BY_SIDEWAYS] = -by_speed;
    by[GMI_BY_SIDEWAYS_T1] = -by_speed * t1 - at->by_slope;
}

/* Derivatives of the friction of a part: of its share with all weights, of its lean with the moments. */
static OWN_STACK void add_part_derivatives(const gmi_sliding *sliding, double advance,
                                           const gmi_part_friction *at, const gmi_load *load,
                                           const gmi_load_by *load_by, double rho_p, double t1,
                                           gmi_rubbing_by *by) {
    double share_by[GMI_VARIABLES];
    differentiate_share(sliding, advance, &at->share, load, load_by, rho_p, t1, share_by);
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        for (int k = 0; k < GMI_VARIABLES; ++k) {
            by->force[k][weight] += share_by[k] * load->force[weight];
        }
        for (int k = 0; k < GMI_LOAD_VARIABLES; ++k) {
            by->force[k][weight] += at->share.value * load_by->force[k][weight];
        }
    }

    /* rho_p advances with t1. */
    differentiate_share(sliding, advance, &at->lean, load, load_by, rho_p, t1, share_by);
    for (int k = 0; k < GMI_VARIABLES; ++k) {
        double lean_by = share_by[k] * load->force[GMI_WHOLE];
        if (k < GMI_LOAD_VARIABLES) {
            lean_by += at->lean.value * load_by->force[k][GMI_WHOLE];
        }
        by->force[k][GMI_BY_T1] += lean_by;
        by->force[k][GMI_BY_RHO] += advance * lean_by;
    }
}

void gmi_rubbing_add(const gmi_sliding *sliding, double advance, const gmi_load *load,
                     const gmi_load_by *load_by, gmi_rubbing *total, gmi_rubbing_by *by) {
    const double *force = load->force;
    if (!(force[GMI_WHOLE] > 0.0)) {
        return;
    }

    /* About its mean rho_p and t1, with its load over its touching length. */
    const double rho_p = force[GMI_BY_RHO] / force[GMI_WHOLE];
    const double t1 = force[GMI_BY_T1] / force[GMI_WHOLE];
    const gmi_sliding_part part = {
        .load = force[GMI_WHOLE] / load->contact[0],
        .contact = load->contact[0],
        .speed = sliding_at(sliding, rho_p, t1),
        .slope = (sliding->pinion_speed + sliding->wheel_speed) * advance - sliding->sideways[1],
        .apart = load->contact[1] / load->contact[0] - t1,
    };

    /* Its friction, and the moment of that about the middle of the load. */
    gmi_part_friction at;
    gmi_friction_of_part(sliding, &part, &at);
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        total->force[weight] += at.share.value * force[weight];
    }

    const double lean = at.lean.value * force[GMI_WHOLE];
    total->force[GMI_BY_T1] += lean;
    total->force[GMI_BY_RHO] += advance * lean;
    total->loss += at.share.value * part.speed * force[GMI_WHOLE] + part.slope * lean;

    if (by != NULL) {
        add_part_derivatives(sliding, advance, &at, load, load_by, rho_p, t1, by);
    }
}

gmi_common_friction gmi_friction_common(const gmi_sliding *s, double force) {
    gmi_common_friction mu = {1.0, 0.0};
    if (s->friction->law == GM_FRICTION_CONSTANT) {
        mu.value = s->friction->factor;
    } else if (s->friction->law == GM_FRICTION_ISO14179) {
        mu.power = 0.2;
        mu.value = s->friction->factor * pow(force / s->rolling.value, mu.power);
    }
    return mu;
}

void gmi_rubbing_finish(const gmi_sliding *sliding, const gmi_load *load,
                        const gmi_load_by *load_by, gmi_rubbing *total, gmi_rubbing_by *by) {
    const double force = load->force[GMI_WHOLE];
    gmi_common_friction mu = {0.0, 0.0};
    if (force > 0.0) { /* else damping has taken the force of the side away */
        mu = gmi_friction_common(sliding, force);
    }

    /* The coefficient changes with the load, and with the speed of rolling. */
    if (by != NULL) {
        double power_by[GMI_VARIABLES] = {0.0};
        const gmi_rolling_by rolling = gmi_rolling_differentiate(sliding);
        for (int k = 0; k < GMI_LOAD_VARIABLES && mu.power != 0.0; ++k) {
            power_by[k] = mu.power * load_by->force[k][GMI_WHOLE] / force;
        }
        power_by[GMI_BY_LENGTH] -= mu.power * rolling.length;
        power_by[GMI_BY_PINION_SPEED] = -mu.power * rolling.pinion_speed;
        power_by[GMI_BY_WHEEL_SPEED] = -mu.power * rolling.wheel_speed;

        for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
            for (int k = 0; k < GMI_VARIABLES; ++k) {
                by->force[k][weight] =
                    mu.value * (by->force[k][weight] + power_by[k] * total->force[weight]);
            }
        }
    }

    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        total->force[weight] *= mu.value;
    }
    total->loss *= mu.value;
}

/* One weight of the friction of a side, with what a solver knows. */
static gmi_varying varying_of(const gm_pair *pair, int side, const gmi_rubbing *rubbing,
                              const gmi_rubbing_by *by, int weight) {
    gmi_varying result = {.value = rubbing->force[weight]};
    if (by != NULL) {
        result =
            gmi_varying_of(pair, side, rubbing->force[weight], by->force[GMI_BY_ORIGIN][weight],
                           by->force[GMI_BY_DELTA][weight], by->force[GMI_BY_DELTA_RATE][weight]);
        result.by[GMI_PINION_SPEED] += by->force[GMI_BY_PINION_SPEED][weight];
        result.by[GMI_WHEEL_SPEED] += pair->wheel.sign * by->force[GMI_BY_WHEEL_SPEED][weight];
    }
    return result;
}

void gmi_friction_sum_of(const gm_pair *pair, int side, const gmi_rubbing *rubbing,
                         const gmi_rubbing_by *by, gmi_friction_sum *sum) {
    sum->force = varying_of(pair, side, rubbing, by, GMI_WHOLE);
    sum->moment = varying_of(pair, side, rubbing, by, GMI_BY_RHO);
    sum->force_t1 = rubbing->force[GMI_BY_T1];
    sum->loss = rubbing->loss;
}

/* ---------------------------------------------------------------------------------------------
 * By what a solver knows
 * ------------------------------------------------------------------------------------------- */

/* A part with all that its friction depends on. */
typedef struct varying_part {
    double t1; /* the middle of its load */
    double t1_by[GMI_MOTIONS];
    gmi_varying speed, slope, apart; /* those of gmi_sliding_part */
} varying_part;

/* The middle of the load, and how far that of the touching length is from it. */
static void find_middle(const gmi_part_force *part, varying_part *found) {
    const double force = part->force.value, contact = part->contact.value;
    const double t1 = part->force_t1.value / force;
    const double touching = part->contact_t1.value / contact;
    found->t1 = t1;
    found->apart.value = touching - t1;
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        found->t1_by[k] = (part->force_t1.by[k] - t1 * part->force.by[k]) / force;
        found->apart.by[k] =
            (part->contact_t1.by[k] - touching * part->contact.by[k]) / contact - found->t1_by[k];
    }
}

/* How a part slides on the line of action; advance: of rho_p over t1. */
static void find_sliding(const gmi_sliding *s, double advance, const gmi_part_force *part,
                         varying_part *found) {
    find_middle(part, found);
    const double force = part->force.value;
    const double rho_p = part->moment.value / force;
    const double both = s->pinion_speed + s->wheel_speed;
    const gmi_varying none = {.value = 0.0};
    found->speed = found->slope = none;
    found->speed.value = sliding_at(s, rho_p, found->t1);
    found->slope.value = both * advance - s->sideways[1];

    /* The place of the mean moves with the load along the line. */
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        const double rho_by = (part->moment.by[k] - rho_p * part->force.by[k]) / force;
        found->speed.by[k] = both * rho_by - s->sideways[1] * found->t1_by[k];
    }

    /* And the speeds of the gears count by themselves. */
    found->speed.by[GMI_PINION_SPEED] += rho_p;
    found->speed.by[GMI_WHEEL_SPEED] -= s->wheel_sign * (s->line_of_action - rho_p);
    found->slope.by[GMI_PINION_SPEED] += advance;
    found->slope.by[GMI_WHEEL_SPEED] += s->wheel_sign * advance;
}

/*
 * The same at a tip, where both arms are longer, the flanks slide along the turned tangent, and the wheel's axis moves
 * across that.
 */
static void add_tip_sliding(const gmi_sliding *s, const gmi_tip_place *place, varying_part *found) {
    const double both = s->pinion_speed + s->wheel_speed;
    const double sideways = s->sideways[0] + s->sideways[1] * found->t1;
    const double forward = s->forward[0] + s->forward[1] * found->t1;
    const double along = s->sideways[1] * place->versine.value - s->forward[1] * place->sine.value;
    const double turning =
        s->sideways[1] * place->versine_t1.value - s->forward[1] * place->sine_t1.value;

    /* In the middle of the load what the edge adds, and along the line. */
    found->speed.value += both * place->lead.value - s->wheel_speed * place->longer.value +
                          sideways * place->versine.value - forward * place->sine.value;
    found->slope.value += both * place->lead_t1.value - s->wheel_speed * place->longer_t1.value +
                          sideways * place->versine_t1.value - forward * place->sine_t1.value +
                          along;

    /* As the edge moves on the flank, and the middle along the face. */
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        found->speed.by[k] += both * place->lead.by[k] - s->wheel_speed * place->longer.by[k] +
                              sideways * place->versine.by[k] - forward * place->sine.by[k] +
                              along * found->t1_by[k];
        found->slope.by[k] += both * place->lead_t1.by[k] -
                              s->wheel_speed * place->longer_t1.by[k] +
                              sideways * place->versine_t1.by[k] - forward * place->sine_t1.by[k] +
                              s->sideways[1] * place->versine.by[k] -
                              s->forward[1] * place->sine.by[k] + turning * found->t1_by[k];
    }

    /* Longer arms turn the speeds of the gears into more. */
    found->speed.by[GMI_PINION_SPEED] += place->lead.value;
    found->speed.by[GMI_WHEEL_SPEED] -= s->wheel_sign * (place->longer.value - place->lead.value);
    found->slope.by[GMI_PINION_SPEED] += place->lead_t1.value;
    found->slope.by[GMI_WHEEL_SPEED] -=
        s->wheel_sign * (place->longer_t1.value - place->lead_t1.value);
}

/* Share or lean of a part, times its force. */
static gmi_varying rubbing_of(const gmi_sliding *s, const gmi_part_share *at,
                              const gmi_part_force *part, const varying_part *moving) {
    const double by_touching = at->by_contact - at->by_load;
    gmi_varying share = {.value = at->value}, force = {.value = 0.0};
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        share.by[k] = at->by_speed * moving->speed.by[k] + at->by_slope * moving->slope.by[k] +
                      at->by_apart * moving->apart.by[k] +
                      at->by_load * part->force.by[k] / part->force.value +
                      by_touching * part->contact.by[k] / part->contact.value +
                      at->by_rolling * s->rolling.by[k] / s->rolling.value;
    }
    gmi_varying_add_product(&share, &part->force, &force);
    return force;
}

/* The friction of a part, and by how much more than the middle of its load has it leans over t1 (N). */
typedef struct part_rubbing {
    gmi_varying force, lean;
} part_rubbing;

static void add_scaled(const gmi_varying *a, double factor, gmi_varying *sum) {
    sum->value += factor * a->value;
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        sum->by[k] += factor * a->by[k];
    }
}

/* Adds what a part has at the place of the line of action. */
static part_rubbing add_part(const gmi_sliding *sliding, double advance, const gmi_part_force *part,
                             const varying_part *moving, gmi_friction_sum *total) {
    const gmi_sliding_part as = {.load = part->force.value / part->contact.value,
                                 .contact = part->contact.value,
                                 .speed = moving->speed.value,
                                 .slope = moving->slope.value,
                                 .apart = moving->apart.value};
    gmi_part_friction at;
    gmi_friction_of_part(sliding, &as, &at);
    const part_rubbing found = {rubbing_of(sliding, &at.share, part, moving),
                                rubbing_of(sliding, &at.lean, part, moving)};

    /* About the pinion's axis with the mean arm of the load, and farther out by its lean. */
    const double rho_p = part->moment.value / part->force.value;
    gmi_varying arm = {.value = rho_p};
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        arm.by[k] = (part->moment.by[k] - rho_p * part->force.by[k]) / part->force.value;
    }
    add_scaled(&found.force, 1.0, &total->force);
    gmi_varying_add_product(&found.force, &arm, &total->moment);
    add_scaled(&found.lean, advance, &total->moment);
    total->force_t1 += found.force.value * moving->t1 + found.lean.value;
    total->loss += found.force.value * as.speed + found.lean.value * as.slope;
    return found;
}

void gmi_friction_add(const gmi_sliding *sliding, double advance, const gmi_part_force *part,
                      gmi_friction_sum *total) {
    if (part->force.value > 0.0) {
        varying_part moving;
        find_sliding(sliding, advance, part, &moving);
        (void)add_part(sliding, advance, part, &moving, total);
    }
}

void gmi_friction_add_tip(const gmi_sliding *sliding, double advance, const gmi_part_force *part,
                          const gmi_tip_place *place, gmi_friction_sum *total,
                          gmi_tip_friction *tip) {
    varying_part moving;
    find_sliding(sliding, advance, part, &moving);
    add_tip_sliding(sliding, place, &moving);
    const part_rubbing at = add_part(sliding, advance, part, &moving, total);

    /* From the line of action to the corner. */
    gmi_varying_add_product(&at.force, &place->lead, &total->moment);
    gmi_varying_add_product(&at.lean, &place->lead_t1, &total->moment);
    gmi_varying_add_product(&at.force, &place->longer, &tip->longer);
    gmi_varying_add_product(&at.lean, &place->longer_t1, &tip->longer);

    /* Moments along the face of what is turned: sine and versine in the middle of the load, and the lean there. */
    const double force = at.force.value, lean = at.lean.value, t1 = moving.t1;
    const double force_t1 = force * t1 + lean;
    tip->versine += place->versine.value * force + place->versine_t1.value * lean;
    tip->versine_t1 += place->versine.value * force_t1 + place->versine_t1.value * t1 * lean;
    tip->sine += place->sine.value * force + place->sine_t1.value * lean;
    tip->sine_t1 += place->sine.value * force_t1 + place->sine_t1.value * t1 * lean;
}

/* Times the common part of mu. */
static void finish_tip(const gmi_varying *mu, gmi_tip_friction *tip) {
    const gmi_tip_friction parts = *tip;
    const gmi_varying none = {.value = 0.0};
    tip->longer = none;
    gmi_varying_add_product(mu, &parts.longer, &tip->longer);
    tip->versine *= mu->value;
    tip->versine_t1 *= mu->value;
    tip->sine *= mu->value;
    tip->sine_t1 *= mu->value;
}

void gmi_friction_finish(const gmi_sliding *sliding, const gmi_varying *force,
                         gmi_friction_sum *total, gmi_tip_friction *tip) {
    /* The coefficient, with how it changes. */
    const gmi_friction_sum parts = *total;
    const gmi_friction_sum none = {.loss = 0.0};
    gmi_varying mu = {.value = 0.0};
    *total = none;
    if (force->value > 0.0) { /* else damping has taken the force of the side away */
        const gmi_common_friction common = gmi_friction_common(sliding, force->value);
        mu.value = common.value;
        for (int k = 0; k < GMI_MOTIONS && common.power != 0.0; ++k) {
            mu.by[k] =
                common.power * mu.value *
                (force->by[k] / force->value - sliding->rolling.by[k] / sliding->rolling.value);
        }
    }

    if (tip != NULL) {
        finish_tip(&mu, tip);
    }
    if (!(force->value > 0.0)) {
        return;
    }

    gmi_varying_add_product(&mu, &parts.force, &total->force);
    gmi_varying_add_product(&mu, &parts.moment, &total->moment);
    total->force_t1 = mu.value * parts.force_t1;
    total->loss = mu.value * parts.loss;
}
