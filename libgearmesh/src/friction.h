/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* From the force of a part of a line to what friction makes of it. */
#ifndef GEARMESH_FRICTION_H
#define GEARMESH_FRICTION_H

#include "contact.h"
#include "internal.h"
#include "meshing.h"
#include "side_tangent.h"

/* Places at which lines are cut into parts with a sliding speed each. */
enum { GMI_FRICTION_CUTS = 7 };

/* The friction of one mesh. */
typedef struct gmi_friction {
    int is_on;
    int law;                        /* enum gm_friction_law */
    double factor;                  /* mu of the constant law; else what of its law never changes */
    double normal;                  /* normal force per transverse force, 1 / cos(beta_b) (1) */
    double creep_squared;           /* v0^2 (m2/s2) */
    double pitch_point;             /* rho_p there (m) */
    double cuts[GMI_FRICTION_CUTS]; /* in rho_p, ascending; the pitch point in their middle (m) */
} gmi_friction;

gmi_friction gmi_friction_of(const gm_mesh_params *params, const gm_pair *pair,
                             const gmi_engagement *at);

/* Pitch point and cuts of the gears as they stand; and the derivative of cut k by T. */
void gmi_friction_place(const gm_pair *pair, const gmi_engagement *at, gmi_friction *friction);
double gmi_friction_cut_by_length(const gm_pair *pair, const gmi_engagement *at,
                                  const gmi_friction *friction, int k);

/* What a solver knows, in the order of gm_gradient. */
enum gmi_motion {
    GMI_PINION_ANGLE,
    GMI_WHEEL_ANGLE,
    GMI_PINION_SPEED,
    GMI_WHEEL_SPEED,
    GMI_MOTIONS
};

/* A number and its derivatives. */
typedef struct gmi_varying {
    double value;
    double by[GMI_MOTIONS];
} gmi_varying;

static inline void gmi_varying_add_product(const gmi_varying *a, const gmi_varying *b,
                                           gmi_varying *sum) {
    sum->value += a->value * b->value;
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        sum->by[k] += a->value * b->by[k] + a->by[k] * b->value;
    }
}

/* From derivatives by line origin, delta and speed of approach of a side to those by what a solver knows. */
static inline gmi_varying gmi_varying_of(const gm_pair *pair, int side, double value,
                                         double by_origin, double by_delta, double by_speed) {
    const double r_bp = gmi_side_sign(side) * pair->pinion.base_radius;
    const double r_bw = gmi_side_sign(side) * pair->wheel.base_radius;
    const gmi_varying result = {
        value,
        {r_bp * (by_delta + by_origin), -r_bw * by_delta, r_bp * by_speed, -r_bw * by_speed}};
    return result;
}

/* How the flanks of one side slide on each other. */
typedef struct gmi_sliding {
    const gmi_friction *friction;
    double pinion_speed, wheel_speed; /* in the signs of ISO 21771 (rad/s) */
    double wheel_sign;
    double line_of_action; /* T (m) */
    double sideways[2],
        forward[2]; /* of gmi_rates: where the wheel's axis moves, the flanks slide by less (m/s) */
    gmi_varying rolling; /* sum of both speeds of rolling in the pitch point, v0 included (m/s) */
} gmi_sliding;

/* rates: of the side, NULL = the axes stand still. */
void gmi_sliding_find(const gmi_friction *friction, const gm_pair *pair, const gmi_engagement *at,
                      const gm_position *position, const gmi_rates *rates, gmi_sliding *sliding);

/* The normal force of a part of a line, in the transverse section. */
typedef struct gmi_part_force {
    gmi_varying force;      /* (N) */
    gmi_varying moment;     /* times mean rho_p (N m) */
    gmi_varying contact;    /* touching part (1) */
    gmi_varying force_t1;   /* times mean t1 (N) */
    gmi_varying contact_t1; /* touching part times its mean t1 (1) */
} gmi_part_force;

/* Friction on the wheel, in the sense in which the pinion's flank moves; on the pinion the other way. And how it moves. */
typedef struct gmi_rubbing {
    double force[GMI_WEIGHTS]; /* times 1, t1, rho_p (N, N, N m) */
    double loss;               /* (W) */
} gmi_rubbing;

typedef struct gmi_rubbing_by {
    double force[GMI_VARIABLES][GMI_WEIGHTS];
} gmi_rubbing_by;

/* The same with the derivatives by what a solver knows. */
typedef struct gmi_friction_sum {
    gmi_varying force;  /* (N) */
    gmi_varying moment; /* times rho_p (N m) */
    double force_t1;    /* times t1 (N) */
    double loss;        /* (W) */
} gmi_friction_sum;

/* Where a part is that a tip corner bears: off the line of action, whose place has the roll lengths rho_p and T - rho_p. */
typedef struct gmi_tip_place {
    gmi_varying
        lead; /* what the arm of friction about the pinion's axis is longer by, on average of the load (m) */
    gmi_varying longer;        /* and that of both together (m) */
    gmi_varying versine, sine; /* 1 - cos and sin of the turn of the normal */
    gmi_varying lead_t1, longer_t1, versine_t1, sine_t1; /* in the middle of the load by t1 */
} gmi_tip_place;

/* What friction at tips adds to gmi_friction_sum. */
typedef struct gmi_tip_friction {
    gmi_varying longer;         /* times what both arms together are longer by (N m) */
    double versine, versine_t1; /* times that of the turn; and times t1 (N) */
    double sine, sine_t1;       /* likewise */
} gmi_tip_friction;

/* Friction at one point: over the transverse force there, less what is the same all over a side. */
typedef struct gmi_point_friction {
    double share; /* mu_r / cos(beta_b) */
    double speed; /* of sliding (m/s) */

    /* Derivatives of the share: by that speed, and by the logarithms of the load and of the rolling speed. */
    double by_speed, by_load, by_rolling;
} gmi_point_friction;

/* load: transverse, over the common face width (N). */
gmi_point_friction gmi_friction_at(const gmi_sliding *sliding, double rho_p, double t1,
                                   double load);

/* A part of a line on which the sliding speed is straight: speeds in the middle of its load and of its touching length. */
typedef struct gmi_sliding_part {
    double load;    /* over the touching length (N) */
    double contact; /* that length, C (1) */
    double speed;   /* v, at the middle of the load (m/s) */
    double slope;   /* w = dv / dt1 (m/s) */
    double apart;   /* t1 of the middle of the touching length less that of the load (1) */
} gmi_sliding_part;

/*
 * Friction of a part over its transverse force, less what is the same all over a side, with derivatives: by the speed, by
 * the logarithms of load, rolling speed and touching length, by the slope, and by how far the two middles are apart.
 */
typedef struct gmi_part_share {
    double value, by_speed, by_load, by_rolling, by_contact, by_slope, by_apart;
} gmi_part_share;

/* The whole; and its moment over t1 about the middle of the load. */
typedef struct gmi_part_friction {
    gmi_part_share share, lean;
} gmi_part_friction;

void gmi_friction_of_part(const gmi_sliding *sliding, const gmi_sliding_part *part,
                          gmi_part_friction *found);

/* What of the coefficient is the same all over a side, and of it the power of the side's force over the rolling speed. */
typedef struct gmi_common_friction {
    double value, power;
} gmi_common_friction;

gmi_common_friction gmi_friction_common(const gmi_sliding *sliding, double force);

/* The logarithm of the rolling speed by both speeds, and by T. */
typedef struct gmi_rolling_by {
    double pinion_speed, wheel_speed, length;
} gmi_rolling_by;

gmi_rolling_by gmi_rolling_differentiate(const gmi_sliding *sliding);

/* Adds the friction of one part, with derivatives where load_by and by are not NULL. advance: of rho_p over t1 (m). */
void gmi_rubbing_add(const gmi_sliding *sliding, double advance, const gmi_load *load,
                     const gmi_load_by *load_by, gmi_rubbing *total, gmi_rubbing_by *by);

/* What of the law is the same all over a side, by all of its load. */
void gmi_rubbing_finish(const gmi_sliding *sliding, const gmi_load *load,
                        const gmi_load_by *load_by, gmi_rubbing *total, gmi_rubbing_by *by);

/* by: NULL = without derivatives, which are 0 then. */
void gmi_friction_sum_of(const gm_pair *pair, int side, const gmi_rubbing *rubbing,
                         const gmi_rubbing_by *by, gmi_friction_sum *sum);

/* Adds that of one part; advance: of rho_p over t1 (m). */
void gmi_friction_add(const gmi_sliding *sliding, double advance, const gmi_part_force *part,
                      gmi_friction_sum *total);

/* Adds that of one part at a tip, whose force is above 0. */
void gmi_friction_add_tip(const gmi_sliding *sliding, double advance, const gmi_part_force *part,
                          const gmi_tip_place *place, gmi_friction_sum *total,
                          gmi_tip_friction *tip);

/* What of the law is the same all over a side, by the side's force; tip: NULL = without. */
void gmi_friction_finish(const gmi_sliding *sliding, const gmi_varying *force,
                         gmi_friction_sum *total, gmi_tip_friction *tip);

#endif
