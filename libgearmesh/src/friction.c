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
 * Lines of contact are cut at fixed places, one of them the pitch point, and mu_r of a part is that at its mean sliding
 * speed, weighted with the normal force. So the force of a part and its first moment say all: exact where mu_r is the same all along
 * a part, that is for spur gears, and for v far above v0. The torques of a part act at its mean rho_p, and its loss is its
 * friction times its mean sliding speed: power in is power out and loss, to rounding.
 */
#include "internal.h"

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

/* Mean sliding speed of a part, at its mean rho_p and t1. */
static gmi_varying sliding_speed(const gmi_sliding *s, const gmi_part_force *part) {
    const double rho_p = part->moment.value / part->force.value;
    const double rho_w = s->line_of_action - rho_p;
    const double t1 = part->force_t1.value / part->force.value;
    gmi_varying speed = {.value = sliding_at(s, rho_p, t1)};

    /* The place of the mean moves with the load along the line. */
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        const double force_by = part->force.by[k];
        const double rho_by = (part->moment.by[k] - rho_p * force_by) / part->force.value;
        const double t1_by = (part->force_t1.by[k] - t1 * force_by) / part->force.value;
        speed.by[k] = (s->pinion_speed + s->wheel_speed) * rho_by - s->sideways[1] * t1_by;
    }

    /* And the speeds of the gears count by themselves. */
    speed.by[GMI_PINION_SPEED] += rho_p;
    speed.by[GMI_WHEEL_SPEED] -= s->wheel_sign * rho_w;
    return speed;
}

/*
 * The same at a tip, where both arms are longer, the flanks slide along the turned tangent, and the wheel's axis moves
 * across that.
 */
static gmi_varying tip_sliding_speed(const gmi_sliding *s, const gmi_part_force *part,
                                     const gmi_tip_place *place) {
    const double t1 = part->force_t1.value / part->force.value;
    const double sideways = s->sideways[0] + s->sideways[1] * t1;
    const double forward = s->forward[0] + s->forward[1] * t1;

    /* On the flank, and what the edge adds. */
    gmi_varying speed = sliding_speed(s, part);
    const double both = s->pinion_speed + s->wheel_speed;
    speed.value += both * place->lead.value - s->wheel_speed * place->longer.value +
                   sideways * place->versine.value - forward * place->sine.value;

    /* As the edge moves on the flank, and the mean along the face. */
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        const double t1_by = (part->force_t1.by[k] - t1 * part->force.by[k]) / part->force.value;
        speed.by[k] +=
            both * place->lead.by[k] - s->wheel_speed * place->longer.by[k] +
            sideways * place->versine.by[k] - forward * place->sine.by[k] +
            (s->sideways[1] * place->versine.value - s->forward[1] * place->sine.value) * t1_by;
    }

    /* Longer arms turn the speeds of the gears into more. */
    speed.by[GMI_PINION_SPEED] += place->lead.value;
    speed.by[GMI_WHEEL_SPEED] -= s->wheel_sign * (place->longer.value - place->lead.value);
    return speed;
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
static coefficient coefficient_of(const gmi_sliding *s, double load, double speed) {
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

static gmi_varying share_of(const gmi_sliding *s, const gmi_varying *load,
                            const gmi_varying *speed) {
    const gmi_point_friction at = friction_of(s, load->value, speed->value);
    gmi_varying share = {.value = at.share};
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        share.by[k] = at.by_speed * speed->by[k] + at.by_load * load->by[k] / load->value +
                      at.by_rolling * s->rolling.by[k] / s->rolling.value;
    }
    return share;
}

gmi_point_friction gmi_friction_of_speed(const gmi_sliding *sliding, double load, double speed) {
    return friction_of(sliding, load, speed);
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
 * Of a part, and of a side
 * ------------------------------------------------------------------------------------------- */

/* The share of a part: by its load, of which rho_p and t1 are the means, and by how the flanks slide there. */
static void differentiate_share(const gmi_sliding *s, const gmi_point_friction *at,
                                const gmi_load *load, const gmi_load_by *load_by, double rho_p,
                                double t1, double by[GMI_VARIABLES]) {
    const double by_speed = at->by_speed;

    /* By what the load changes with: its middle slides at another speed, and its size changes the coefficient. */
    for (int k = 0; k < GMI_LOAD_VARIABLES; ++k) {
        const double *force_by = load_by->force[k];
        const double rho_by = force_by[GMI_BY_RHO] - rho_p * force_by[GMI_WHOLE];
        const double t1_by = force_by[GMI_BY_T1] - t1 * force_by[GMI_WHOLE];
        by[k] = (by_speed * ((s->pinion_speed + s->wheel_speed) * rho_by - s->sideways[1] * t1_by) +
                 at->by_load * force_by[GMI_WHOLE]) /
                load->force[GMI_WHOLE];
    }
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        by[k] -= at->by_load * load_by->contact[k] / load->contact;
    }

    /* By the line of action and the speeds of both gears, which roll and slide. */
    const gmi_rolling_by rolling = gmi_rolling_differentiate(s);
    by[GMI_BY_LENGTH] += at->by_rolling * rolling.length - by_speed * s->wheel_speed;
    by[GMI_BY_PINION_SPEED] = at->by_rolling * rolling.pinion_speed + by_speed * rho_p;
    by[GMI_BY_WHEEL_SPEED] =
        at->by_rolling * rolling.wheel_speed - by_speed * (s->line_of_action - rho_p);
    by[GMI_BY_SIDEWAYS] = -by_speed;
    by[GMI_BY_SIDEWAYS_T1] = -by_speed * t1;
}

void gmi_rubbing_add(const gmi_sliding *sliding, const gmi_load *load, const gmi_load_by *load_by,
                     gmi_rubbing *total, gmi_rubbing_by *by) {
    const double *force = load->force;
    if (!(force[GMI_WHOLE] > 0.0)) {
        return;
    }

    /* At its mean rho_p and t1, with its load over its touching length. */
    const double rho_p = force[GMI_BY_RHO] / force[GMI_WHOLE];
    const double t1 = force[GMI_BY_T1] / force[GMI_WHOLE];
    const gmi_point_friction at =
        gmi_friction_at(sliding, rho_p, t1, force[GMI_WHOLE] / load->contact);
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        total->force[weight] += at.share * force[weight];
    }
    total->loss += at.share * force[GMI_WHOLE] * at.speed;
    if (by == NULL) {
        return;
    }

    double share_by[GMI_VARIABLES];
    differentiate_share(sliding, &at, load, load_by, rho_p, t1, share_by);
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        for (int k = 0; k < GMI_VARIABLES; ++k) {
            by->force[k][weight] += share_by[k] * force[weight];
        }
        for (int k = 0; k < GMI_LOAD_VARIABLES; ++k) {
            by->force[k][weight] += at.share * load_by->force[k][weight];
        }
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

/* By the load of the part over its touching length; what it adds at the place of the line of action. */
static gmi_varying add_part(const gmi_sliding *sliding, const gmi_part_force *part,
                            const gmi_varying *speed, gmi_friction_sum *total) {
    const double contact = part->contact.value;
    gmi_varying load = {.value = part->force.value / contact};
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        load.by[k] = (part->force.by[k] - load.value * part->contact.by[k]) / contact;
    }

    const gmi_varying share = share_of(sliding, &load, speed);
    gmi_varying_add_product(&share, &part->force, &total->force);
    gmi_varying_add_product(&share, &part->moment, &total->moment);
    total->force_t1 += share.value * part->force_t1.value;
    total->loss += share.value * part->force.value * speed->value;
    return share;
}

void gmi_friction_add(const gmi_sliding *sliding, const gmi_part_force *part,
                      gmi_friction_sum *total) {
    if (part->force.value > 0.0) {
        const gmi_varying speed = sliding_speed(sliding, part);
        (void)add_part(sliding, part, &speed, total);
    }
}

void gmi_friction_add_tip(const gmi_sliding *sliding, const gmi_part_force *part,
                          const gmi_tip_place *place, gmi_friction_sum *total,
                          gmi_tip_friction *tip) {
    const gmi_varying speed = tip_sliding_speed(sliding, part, place);
    const gmi_varying share = add_part(sliding, part, &speed, total);

    /* From the line of action to the corner. */
    gmi_varying force = {.value = 0.0};
    gmi_varying_add_product(&share, &part->force, &force);
    gmi_varying_add_product(&force, &place->lead, &total->moment);
    gmi_varying_add_product(&force, &place->longer, &tip->longer);
    const double force_t1 = share.value * part->force_t1.value;
    tip->versine += place->versine.value * force.value;
    tip->versine_t1 += place->versine.value * force_t1;
    tip->sine += place->sine.value * force.value;
    tip->sine_t1 += place->sine.value * force_t1;
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
