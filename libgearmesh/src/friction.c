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

void gmi_friction_place(const gm_pair *pair, const gmi_engagement *at, gmi_friction *friction) {
    /* Parts are twice as long from one to the next: as mu_r changes most next to the pitch point. */
    const double shares[GMI_FRICTION_CUTS] = {-0.5, -0.25, -0.125, 0.0, 0.125, 0.25, 0.5};
    const double pitch_point = pair->pinion.base_radius * tan(at->working_pressure_angle);
    const double beyond = at->line_of_action - pitch_point;
    const double reach =
        fmax(pair->pinion.tip_roll_length - pitch_point, at->tip_roll_length[GM_WHEEL] - beyond);
    friction->pitch_point = pitch_point;
    for (int k = 0; k < GMI_FRICTION_CUTS; ++k) {
        friction->cuts[k] = pitch_point + shares[k] * reach;
    }
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

gmi_sliding gmi_sliding_find(const gmi_friction *friction, const gm_pair *pair,
                             const gmi_engagement *at, const gm_position *position,
                             const gmi_rates *rates) {
    gmi_sliding s = {.friction = friction};
    s.pinion_speed = position->pinion_speed;
    s.wheel_speed = (pair->pinion.base_radius * position->pinion_speed - position->offset_rate) /
                    at->wheel_base_radius;
    s.wheel_sign = pair->wheel.sign;
    s.line_of_action = at->line_of_action;
    for (int k = 0; k < 2 && rates != NULL; ++k) {
        s.sideways[k] = rates->sideways[k];
        s.forward[k] = rates->forward[k];
    }

    /* In the pitch point; v0 keeps the coefficients finite at rest. */
    const double rho_p = friction->pitch_point;
    const double rho_w = at->line_of_action - rho_p;
    const double sum = s.pinion_speed * rho_p + s.wheel_speed * rho_w;
    s.rolling.value = sqrt(sum * sum + friction->creep_squared);
    s.rolling.by[GMI_PINION_SPEED] = sum / s.rolling.value * rho_p;
    s.rolling.by[GMI_WHEEL_SPEED] = sum / s.rolling.value * s.wheel_sign * rho_w;
    return s;
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
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        const double force_by = part->force.by[k];
        const double rho_by = (part->moment.by[k] - rho_p * force_by) / part->force.value;
        const double t1_by = (part->force_t1.by[k] - t1 * force_by) / part->force.value;
        speed.by[k] = (s->pinion_speed + s->wheel_speed) * rho_by - s->sideways[1] * t1_by;
    }
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
    gmi_varying speed = sliding_speed(s, part);
    const double both = s->pinion_speed + s->wheel_speed;
    speed.value += both * place->lead.value - s->wheel_speed * place->longer.value +
                   sideways * place->versine.value - forward * place->sine.value;
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        const double t1_by = (part->force_t1.by[k] - t1 * part->force.by[k]) / part->force.value;
        speed.by[k] +=
            both * place->lead.by[k] - s->wheel_speed * place->longer.by[k] +
            sideways * place->versine.by[k] - forward * place->sine.by[k] +
            (s->sideways[1] * place->versine.value - s->forward[1] * place->sine.value) * t1_by;
    }
    speed.by[GMI_PINION_SPEED] += place->lead.value;
    speed.by[GMI_WHEEL_SPEED] -= s->wheel_sign * (place->longer.value - place->lead.value);
    return speed;
}

/* ---------------------------------------------------------------------------------------------
 * Coefficients
 * ------------------------------------------------------------------------------------------- */

/*
 * [BenedictKelley]: 0.0127 lg(29.66 (F/b) / (eta |v| v_sum^2)), N/m and mPa s, with sqrt(v^2 + v0^2) for |v|. Not below 0,
 * where the formula does not hold.
 */
static gmi_varying benedict_kelley(const gmi_sliding *s, const gmi_varying *load,
                                   const gmi_varying *speed) {
    const double squared = speed->value * speed->value + s->friction->creep_squared;
    const double factor = 0.0127 * per_ln_10;
    gmi_varying mu = {.value = factor * log(s->friction->factor * load->value /
                                            (sqrt(squared) * s->rolling.value * s->rolling.value))};
    if (!(mu.value > 0.0)) {
        mu.value = 0.0;
        return mu;
    }
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        mu.by[k] = factor * (load->by[k] / load->value - speed->value * speed->by[k] / squared -
                             2.0 * s->rolling.by[k] / s->rolling.value);
    }
    return mu;
}

/* What of mu depends on the place; the rest is the same all over the side. */
static gmi_varying coefficient_of(const gmi_sliding *s, const gmi_varying *load,
                                  const gmi_varying *speed) {
    if (s->friction->law == GM_FRICTION_BENEDICT_KELLEY) {
        return benedict_kelley(s, load, speed);
    }
    const gmi_varying one = {1.0, {0.0, 0.0, 0.0, 0.0}};
    return one;
}

/* And the rest. */
static gmi_varying common_coefficient(const gmi_sliding *s, const gmi_varying *force) {
    gmi_varying mu = {1.0, {0.0, 0.0, 0.0, 0.0}};
    if (s->friction->law == GM_FRICTION_CONSTANT) {
        mu.value = s->friction->factor;
    } else if (s->friction->law == GM_FRICTION_ISO14179) {
        mu.value = s->friction->factor * pow(force->value / s->rolling.value, 0.2);
        for (int k = 0; k < GMI_MOTIONS; ++k) {
            mu.by[k] = 0.2 * mu.value *
                       (force->by[k] / force->value - s->rolling.by[k] / s->rolling.value);
        }
    }
    return mu;
}

/* ---------------------------------------------------------------------------------------------
 * Friction
 * ------------------------------------------------------------------------------------------- */

/* mu_r / cos(beta_b) with its derivatives: v / sqrt(v^2 + v0^2) changes by v0^2 / sqrt(v^2 + v0^2)^3. */
static gmi_varying share_of(const gmi_sliding *sliding, const gmi_varying *load,
                            const gmi_varying *speed) {
    const gmi_varying mu = coefficient_of(sliding, load, speed);
    const double creep_squared = sliding->friction->creep_squared;
    const double squared = speed->value * speed->value + creep_squared;
    const double per_root = 1.0 / sqrt(squared);
    const double normal = sliding->friction->normal;
    gmi_varying share = {.value = normal * mu.value * speed->value * per_root};
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        share.by[k] = normal * per_root *
                      (mu.value * creep_squared / squared * speed->by[k] + mu.by[k] * speed->value);
    }
    return share;
}

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

gmi_point_friction gmi_friction_at(const gmi_sliding *sliding, double rho_p, double t1,
                                   double load) {
    enum { BY_SLIDING = GMI_PINION_ANGLE, BY_LOAD = GMI_WHEEL_ANGLE }; /* in place of the angles */
    const double rho_w = sliding->line_of_action - rho_p;
    const gmi_varying speed = {
        sliding_at(sliding, rho_p, t1),
        {[BY_SLIDING] = 1.0,
         [GMI_PINION_SPEED] = rho_p,
         [GMI_WHEEL_SPEED] = -sliding->wheel_sign * rho_w},
    };
    const gmi_varying loaded = {load, {[BY_LOAD] = load}};
    const gmi_varying share = share_of(sliding, &loaded, &speed);
    const double by_sliding = share.by[BY_SLIDING];
    const gmi_point_friction result = {
        .share = share.value,
        .speed = speed.value,
        .by_roll = by_sliding * (sliding->pinion_speed + sliding->wheel_speed),
        .by_t1 = -by_sliding * sliding->sideways[1],
        .by_load = share.by[BY_LOAD],
        .by_pinion_speed = share.by[GMI_PINION_SPEED],
        .by_wheel_speed = share.by[GMI_WHEEL_SPEED],
    };
    return result;
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
        mu = common_coefficient(sliding, force);
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
