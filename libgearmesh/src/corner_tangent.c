/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * How lines that go on beyond the path of contact move with all coordinates of a side: the overlap with its gap, the force
 * at tips, whose normal turns, and the friction there. libgearmesh/docs/equations.md, corner contact, derives it.
 */
#include "corner.h"
#include "corner_line.h"
#include "friction.h"
#include "internal.h"
#include "line.h"
#include "mesh.h"
#include "meshing.h"
#include "side_tangent.h"
#include "tilt.h"

#include <math.h>
#include <string.h>

/* How the parabola moves with T, as the same of what gap and slope at its joints move by; of spur gears at one place. */
typedef struct moved_parabola {
    double gap, slope, curvature; /* at its beginning */
} moved_parabola;

static moved_parabola by_length_of(const gmi_corner_parabola *gap) {
    const gmi_corner_joint *begins = &gap->begins, *ends = &gap->ends;
    const double half = 0.5 * (gap->pair_to - gap->pair_from);
    moved_parabola by = {-begins->versine, -begins->versine_by_roll, 0.0};
    if (!(half > 0.0)) {
        return by;
    }
    const double middle_slope = (begins->versine - ends->versine) / half +
                                0.5 * (begins->versine_by_roll + ends->versine_by_roll);
    if (gap->from == gap->pair_from) {
        by.curvature = (middle_slope - by.slope) / half;
    } else {
        by.gap += 0.5 * half * (by.slope + middle_slope);
        by.slope = middle_slope;
        by.curvature = (-ends->versine_by_roll - middle_slope) / half;
    }
    return by;
}

/* The gap moves the part with all coordinates: by the roll beyond the tip, which moves straight along t1, and by T. */
OWN_STACK void gmi_corner_follow_gap(const gmi_corner_view *v, const gmi_corner_line *whole,
                                     int role, const gmi_corner_parabola *gap) {
    const gm_mesh *mesh = v->mesh;
    const gmi_beyond *beyond = &whole->beyond[role];
    double roll_by[GMI_COORDINATES][2];
    gmi_tilt_beyond_by(mesh->pair, &mesh->engagement, v->side, whole->origin, role, roll_by);
    const double gone = beyond->at_zero - gap->from, rate = beyond->per_t1;
    const double slope_0 = gap->slope + gap->curvature * gone;
    const double slope_1 = gap->curvature * rate;
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        double *by = v->tangent->by[k];
        by[0] -= roll_by[k][0] * slope_0;
        by[1] -= roll_by[k][0] * slope_1 + roll_by[k][1] * slope_0;
        by[2] -= roll_by[k][1] * slope_1;
    }

    const moved_parabola moved = by_length_of(gap);
    double *by_length = v->tangent->by[GMI_BY_LENGTH];
    by_length[0] -= moved.gap + gone * (moved.slope + 0.5 * gone * moved.curvature);
    by_length[1] -= rate * (moved.slope + gone * moved.curvature);
    by_length[2] -= 0.5 * rate * rate * moved.curvature;
}

/* ---------------------------------------------------------------------------------------------
 * How a side moves with all its coordinates
 * ------------------------------------------------------------------------------------------- */

/* How the place of a line at a roll beyond a tip moves; by_length: of that roll. */
static OWN_STACK void follow_place(const gmi_corner_view *v, const gmi_corner_line *whole, int role,
                                   double t1, double by_length, double by[GMI_COORDINATES]) {
    const gm_mesh *mesh = v->mesh;
    double roll_by[GMI_COORDINATES][2];
    gmi_tilt_beyond_by(mesh->pair, &mesh->engagement, v->side, whole->origin, role, roll_by);
    roll_by[GMI_BY_LENGTH][0] -= by_length;
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        by[k] = -(roll_by[k][0] + roll_by[k][1] * t1) / whole->beyond[role].per_t1;
    }
}

/* A face of the wheel moves; 0 for one of the pinion, which does not. */
static OWN_STACK int follow_face(const gmi_corner_view *v, const gmi_corner_line *whole,
                                 int is_beginning, double by[GMI_COORDINATES]) {
    const gm_mesh *mesh = v->mesh;
    gmi_tilt_cuts cuts;
    gmi_line_part part;
    gmi_tilt_cuts_find(mesh->pair, &mesh->engagement, v->side, v->lines.delta, GMI_FACES_ALONE,
                       &cuts);
    (void)gmi_tilt_cut_line(&cuts, whole->origin, &part);
    return gmi_tilt_move_end(mesh->pair, &mesh->engagement, v->side, whole->origin, v->lines.delta,
                             &part, is_beginning, by);
}

/* An end of the line takes f there along: at a face, or where a corner presses as it goes off the mate's flank. */
OWN_STACK void gmi_corner_follow_end(const gmi_corner_view *v, const gmi_corner_line *whole,
                                     int is_beginning, const gmi_corner_cut *end, double f) {
    double by[GMI_COORDINATES];
    if (gmi_corner_is_stop(end)) {
        const int role = end->what - GMI_CUT_STOP;
        follow_place(v, whole, role, end->t1, gmi_corner_reach_by_length(&v->mesh->corners[role]),
                     by);
    } else if (end->what != GMI_CUT_FACE || !follow_face(v, whole, is_beginning, by)) {
        return;
    }
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        const double moved = is_beginning ? -by[k] : by[k];
        double *sum = v->tangent->sum_by[k], *contact = v->tangent->contact_by[k];
        sum[0] += f * moved;
        sum[1] += f * moved * end->t1;
        contact[0] += moved;
        contact[1] += moved * end->t1;
    }
}

/* Adds what has the integrals whole and by_t1, with the weights. */
static inline void add_weighted(const gmi_corner_view *v, const gmi_corner_line *whole, double all,
                                double by_t1, double sums[GMI_WEIGHTS]) {
    sums[GMI_WHOLE] += all;
    sums[GMI_BY_T1] += by_t1;
    sums[GMI_BY_RHO] += whole->origin * all + v->lines.advance * by_t1;
}

/* What of a corner goes with the middle of the load of a part, and how that moves. */
typedef struct at_middle {
    double value, by_roll, by_length;
} at_middle;

/* Linear between both joints of the parabola. */
static at_middle between(const gmi_corner_parabola *gap, double roll, double begins, double ends,
                         double by_roll_there) {
    const double length = gap->pair_to - gap->pair_from;
    const double by_roll = length > 0.0 ? (ends - begins) / length : by_roll_there;
    const at_middle result = {begins + (roll - gap->pair_from) * by_roll, by_roll, 0.0};
    return result;
}

/* The normal force of a part and its moment over t1, and how both and what touches move; behind the coordinates by the speed. */
typedef struct part_load {
    double force, moment;
    double force_by[GMI_TIP_OWN], moment_by[GMI_TIP_OWN];
    double contact_by[GMI_COORDINATES], contact_t1_by[GMI_COORDINATES];
} part_load;

/* How a cut within a line moves with it; 0 for an end of the line. */
static OWN_STACK int follow_cut(const gmi_corner_view *v, const gmi_corner_line *whole,
                                const gmi_corner_cut *end, double by[GMI_COORDINATES]) {
    const gm_mesh *mesh = v->mesh;
    if (end->what == GMI_CUT_FACE || gmi_corner_is_stop(end)) {
        return 0;
    }
    memset(by, 0, GMI_COORDINATES * sizeof *by);
    by[GMI_BY_ORIGIN] = end->by[GMI_BY_ORIGIN];
    by[GMI_BY_DELTA] = end->by[GMI_BY_DELTA];
    if (end->what >= GMI_CUT_FRICTION) {
        by[GMI_BY_LENGTH] =
            gmi_friction_cut_by_length(mesh->pair, &mesh->engagement, &mesh->friction,
                                       end->what - GMI_CUT_FRICTION) /
            v->lines.advance;
    } else if (end->what >= GMI_CUT_TABLE) {
        by[GMI_BY_LENGTH] = end->by[GMI_BY_DELTA]; /* of the wheel's table */
    } else {
        follow_place(v, whole, end->what - GMI_CUT_ROLL, end->t1, 0.0, by);
    }
    return 1;
}

/*
 * A cut moves with the line, and what one part loses there the next one gains: that is not the same to what goes with the
 * middle of each.
 */
static void add_cut(const gmi_corner_view *v, const gmi_corner_line *whole,
                    const gmi_corner_cut *end, double sign, double f, part_load *load) {
    double by[GMI_COORDINATES];
    if (!(f > 0.0 && follow_cut(v, whole, end, by))) {
        return;
    }
    const double density = v->mesh->law.stiffness * f + v->viscous;
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        const double moved = sign * by[k];
        load->force_by[k] += density * moved;
        load->moment_by[k] += density * moved * end->t1;
        load->contact_by[k] += moved;
        load->contact_t1_by[k] += moved * end->t1;
    }
}

static OWN_STACK void find_part_load(const gmi_corner_view *v, const gmi_corner_line *whole,
                                     const gmi_corner_cut *from, const gmi_corner_cut *to,
                                     const gmi_line_sum *sum, part_load *load) {
    const double stiffness = v->mesh->law.stiffness, damping = v->mesh->law.damping;
    const double viscous = v->viscous;
    const gmi_line_tangent *line = v->tangent;
    load->force = stiffness * sum->sum + viscous * sum->contact;
    load->moment = stiffness * sum->sum_t1 + viscous * sum->contact_t1;
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        const double *contact_by = line->contact_by[k];
        load->force_by[k] = stiffness * line->sum_by[k][0] + viscous * contact_by[0];
        load->moment_by[k] = stiffness * line->sum_by[k][1] + viscous * contact_by[1];
        load->contact_by[k] = contact_by[0];
        load->contact_t1_by[k] = contact_by[1];
    }
    load->force_by[GMI_BY_DELTA_RATE] = damping * sum->contact;
    load->moment_by[GMI_BY_DELTA_RATE] = damping * sum->contact_t1;
    add_cut(v, whole, from, -1.0, sum->at_from, load);
    add_cut(v, whole, to, 1.0, sum->at_to, load);
}

/* The roll beyond a tip in the middle of the load, which moves with the line and along it. */
static OWN_STACK double follow_roll(const gmi_corner_view *v, const gmi_corner_line *whole,
                                    int role, const part_load *load, double by[GMI_TIP_OWN]) {
    const gm_mesh *mesh = v->mesh;
    const gmi_beyond *beyond = &whole->beyond[role];
    const double t1 = load->moment / load->force;
    double line_by[GMI_COORDINATES][2];
    gmi_tilt_beyond_by(mesh->pair, &mesh->engagement, v->side, whole->origin, role, line_by);
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        by[k] = beyond->per_t1 * (load->moment_by[k] - t1 * load->force_by[k]) / load->force;
        by[k] += k < GMI_COORDINATES ? line_by[k][0] + line_by[k][1] * t1 : 0.0;
    }
    return gmi_corner_roll_at(beyond, t1);
}

/* The gap's slope at a roll, and 1 - cos of the turn of the normal. */
static void find_turn(const gmi_corner_parabola *gap, double roll, at_middle *slope,
                      at_middle *versine) {
    const gmi_corner_joint *a = &gap->begins, *b = &gap->ends;
    const double gone = roll - gap->from;
    const moved_parabola moved = by_length_of(gap);
    slope->value = gap->slope + gone * gap->curvature;
    slope->by_roll = gap->curvature;
    slope->by_length = moved.slope + gone * moved.curvature;
    *versine = between(gap, roll, a->versine, b->versine, a->versine_by_roll);
    versine->by_length = between(gap, roll, a->versine_by_length, b->versine_by_length, 0.0).value;
}

/* How it moves by one variable, as the roll does. */
static inline double moved_by(const at_middle *what, const double roll_by[GMI_TIP_OWN], int k) {
    return what->by_roll * roll_by[k] + (k == GMI_BY_LENGTH ? what->by_length : 0.0);
}

/* Adds its product with the force, or with the force's moment, and how that moves. */
static void add_product(const at_middle *what, const double roll_by[GMI_TIP_OWN], double load,
                        const double load_by[GMI_TIP_OWN], int weight, double sum[GMI_WEIGHTS],
                        double by[][GMI_WEIGHTS]) {
    sum[weight] += what->value * load;
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        by[k][weight] += what->value * load_by[k] + moved_by(what, roll_by, k) * load;
    }
}

/* What acts at a corner, as add_tip_load() has it. */
OWN_STACK void gmi_corner_follow_tip(const gmi_corner_view *v, const gmi_corner_line *whole,
                                     int role, const gmi_corner_parabola *gap,
                                     const gmi_corner_cut *from, const gmi_corner_cut *to,
                                     const gmi_line_sum *sum) {
    part_load load;
    find_part_load(v, whole, from, to, sum, &load);
    if (load.force == 0.0) {
        return;
    }
    at_middle slope, versine;
    double roll_by[GMI_TIP_OWN];
    const double roll = follow_roll(v, whole, role, &load, roll_by);
    find_turn(gap, roll, &slope, &versine);

    /* And where the corner is. */
    const gmi_corner_joint *a = &gap->begins, *b = &gap->ends;
    const at_middle across = between(gap, roll, a->across, b->across, a->across_by_roll);
    const at_middle along = between(gap, roll, a->along, b->along, a->along_by_roll);
    gmi_tip_tangent *tip = &v->followed->tips[role];
    const at_middle *const turned[2] = {&slope, &versine}, *const place[2] = {&across, &along};
    for (int part = 0; part < GMI_TIP_PARTS; ++part) {
        double *total = tip->sum[part];
        double(*by)[GMI_WEIGHTS] = tip->by[part];
        add_product(turned[part], roll_by, load.force, load.force_by, GMI_WHOLE, total, by);
        add_product(turned[part], roll_by, load.moment, load.moment_by, GMI_BY_T1, total, by);
        add_product(place[part], roll_by, load.force, load.force_by, GMI_BY_RHO, total, by);
    }
}

/* ---------------------------------------------------------------------------------------------
 * How its friction moves
 * ------------------------------------------------------------------------------------------- */

/* A number and its derivatives by all that friction depends on. */
typedef struct moving {
    double value, by[GMI_TIP_VARIABLES];
} moving;

/* The middle of the load of a part; by what moves it. */
typedef struct moving_middle {
    double t1, t1_by[GMI_TIP_OWN];
    double apart, apart_by[GMI_TIP_OWN]; /* that of gmi_sliding_part */
} moving_middle;

/* As middle_of() has it. */
static void follow_middle(const part_load *load, const gmi_line_sum *sum, moving_middle *part) {
    const double contact = sum->contact;
    const double t1 = load->moment / load->force;
    const double touching = sum->contact_t1 / contact;
    part->t1 = t1;
    part->apart = touching - t1;
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        const double contact_by = k < GMI_COORDINATES ? load->contact_by[k] : 0.0;
        const double contact_t1_by = k < GMI_COORDINATES ? load->contact_t1_by[k] : 0.0;
        part->t1_by[k] = (load->moment_by[k] - t1 * load->force_by[k]) / load->force;
        part->apart_by[k] = (contact_t1_by - touching * contact_by) / contact - part->t1_by[k];
    }
}

/* What a tip has, with derivatives by what moves it alone; and how it changes along a part, by t1. */
typedef struct of_tip {
    double value, by[GMI_TIP_OWN];
    double per_t1, per_t1_by[GMI_TIP_OWN];
} of_tip;

/* What a tip makes of the place on the line of action: gmi_tip_place with all derivatives. */
typedef struct moving_tip {
    of_tip lead, versine, sine;
} moving_tip;

/* What changes with the roll beyond a tip; and its derivative by T. */
typedef struct at_tip {
    gmi_bend own, by_length;
} at_tip;

static at_tip scaled_sum(const at_tip *a, double a_factor, const at_tip *b, double b_factor) {
    const at_tip sum = {gmi_bend_sum(&a->own, a_factor, &b->own, b_factor),
                        gmi_bend_sum(&a->by_length, a_factor, &b->by_length, b_factor)};
    return sum;
}

/* Times T, or over it, which is the power of -1. */
static at_tip times_length(const at_tip *a, double length, int power) {
    const double factor = power > 0 ? length : 1.0 / length;
    const double factor_by = factor * power / length;
    const at_tip product = {gmi_bend_sum(&a->own, factor, &a->own, 0.0),
                            gmi_bend_sum(&a->own, factor_by, &a->by_length, factor)};
    return product;
}

/* How the roll moves along the line with what moves the part. */
typedef struct moving_roll {
    double middle, middle_by[GMI_TIP_OWN]; /* of the load (m) */
    double per_t1, per_t1_by[GMI_TIP_OWN];
    double square, square_by[GMI_TIP_OWN]; /* mean of (t1 of the load less its middle)^2 (1) */
} moving_roll;

static OWN_STACK void find_moving_roll(const gmi_corner_view *v, const gmi_corner_line *whole,
                                       int role, const part_load *load, double contact,
                                       const moving_middle *part, moving_roll *roll) {
    const gmi_beyond *beyond = &whole->beyond[role];
    double line_by[GMI_COORDINATES][2];
    gmi_tilt_beyond_by(v->mesh->pair, &v->mesh->engagement, v->side, whole->origin, role, line_by);
    roll->middle = gmi_corner_roll_at(beyond, part->t1);
    roll->per_t1 = beyond->per_t1;
    roll->square = contact * contact / 12.0 - part->apart * part->apart;
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        roll->middle_by[k] = beyond->per_t1 * part->t1_by[k];
        roll->per_t1_by[k] = 0.0;
        roll->square_by[k] = -2.0 * part->apart * part->apart_by[k];
    }
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        roll->middle_by[k] += line_by[k][0] + line_by[k][1] * part->t1;
        roll->per_t1_by[k] = line_by[k][1];
        roll->square_by[k] += contact * load->contact_by[k] / 6.0;
    }
}

/* Over the load: the mean, and how it changes along the part. */
static void set_tip(const at_tip *what, const moving_roll *roll, of_tip *found) {
    const gmi_bend *own = &what->own, *by_length = &what->by_length;
    const double per_t1 = roll->per_t1;
    const double half_square = 0.5 * per_t1 * per_t1 * roll->square;
    found->value = own->value + own->by_roll_twice * half_square;
    found->per_t1 = per_t1 * own->by_roll;
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        const double roll_by = roll->middle_by[k], per_t1_by = roll->per_t1_by[k];
        const double half_square_by =
            per_t1 * (per_t1_by * roll->square + 0.5 * per_t1 * roll->square_by[k]);
        found->by[k] = own->by_roll * roll_by + own->by_roll_twice * half_square_by;
        found->per_t1_by[k] = per_t1 * own->by_roll_twice * roll_by + per_t1_by * own->by_roll;
    }
    found->by[GMI_BY_LENGTH] += by_length->value + by_length->by_roll_twice * half_square;
    found->per_t1_by[GMI_BY_LENGTH] += per_t1 * by_length->by_roll;
}

/* As find_tip_place() has it: the slope of the gap, the turn by it, and the pinion's arm by both. */
static OWN_STACK void follow_tip_place(const gmi_corner_view *v, int role,
                                       const gmi_corner_parabola *gap,
                                       const gmi_corner_joint *halfway, const moving_roll *roll,
                                       moving_tip *tip) {
    const gmi_engagement *at = &v->mesh->engagement;
    const double base[2] = {v->mesh->pair->pinion.base_radius, at->wheel_base_radius};
    const double base_sum = base[GM_PINION] + base[GM_WHEEL];
    const double length = at->line_of_action, middle = roll->middle;
    const gmi_corner_joint *a = &gap->begins, *m = halfway, *b = &gap->ends;

    /* At a fixed roll d gap' / dT = -d versine / d roll; second derivatives count between joints alone. */
    const at_tip slope = {
        gmi_corner_bend(gap, middle, a->slope, m->slope, b->slope, gap->curvature),
        gmi_corner_bend(gap, middle, -a->versine_by_roll, -m->versine_by_roll, -b->versine_by_roll,
                        0.0)};
    const at_tip versine = {
        gmi_corner_bend(gap, middle, a->versine, m->versine, b->versine, a->versine_by_roll),
        gmi_corner_bend(gap, middle, a->versine_by_length, m->versine_by_length,
                        b->versine_by_length, 0.0)};
    at_tip lead = {
        gmi_corner_bend(gap, middle, a->gain, m->gain, b->gain, a->gain_by_roll),
        gmi_corner_bend(gap, middle, a->gain_by_length, m->gain_by_length, b->gain_by_length, 0.0)};
    at_tip sine = scaled_sum(&slope, base[role], &versine, -base_sum);
    sine = times_length(&sine, length, -1);
    if (role == GM_PINION) {
        const at_tip shorter = times_length(&versine, length, 1);
        lead = scaled_sum(&shorter, -1.0, &lead, -1.0);
        lead = scaled_sum(&sine, base_sum, &lead, 1.0);
    }
    set_tip(&lead, roll, &tip->lead);
    set_tip(&versine, roll, &tip->versine);
    set_tip(&sine, roll, &tip->sine);
}

/* How a part slides. */
typedef struct moving_speed {
    moving speed, slope; /* those of gmi_sliding_part */
} moving_speed;

/* How a part slides on the line of action. */
static OWN_STACK void follow_sliding(const gmi_corner_view *v, const gmi_corner_line *whole,
                                     const moving_middle *part, moving_speed *found) {
    const gmi_sliding *s = v->sliding;
    const double t1 = part->t1;
    const double advance = v->lines.advance;
    const double rho_p = whole->origin + advance * t1;
    const double rho_w = s->line_of_action - rho_p;
    const double both = s->pinion_speed + s->wheel_speed;
    moving *speed = &found->speed, *slope = &found->slope;
    memset(speed, 0, sizeof *speed);
    memset(slope, 0, sizeof *slope);
    speed->value =
        s->pinion_speed * rho_p - s->wheel_speed * rho_w - s->sideways[0] - s->sideways[1] * t1;
    slope->value = both * advance - s->sideways[1];

    /* The middle moves along the line, and the line with its origin. */
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        speed->by[k] = slope->value * part->t1_by[k];
    }
    speed->by[GMI_BY_ORIGIN] += both;
    speed->by[GMI_BY_LENGTH] -= s->wheel_speed;
    speed->by[GMI_BY_PINION_SPEED] = rho_p;
    speed->by[GMI_BY_WHEEL_SPEED] = -rho_w;
    speed->by[GMI_BY_SIDEWAYS] = -1.0;
    speed->by[GMI_BY_SIDEWAYS_T1] = -t1;
    slope->by[GMI_BY_PINION_SPEED] = slope->by[GMI_BY_WHEEL_SPEED] = advance;
    slope->by[GMI_BY_SIDEWAYS_T1] = -1.0;
}

/*
 * At a tip both arms are longer, and the wheel's axis moves across the turned tangent. Both arms together are longer by
 * (r_bp + r_bw) sine - T versine, which the wheel turns by as its axis moves.
 */
static OWN_STACK void follow_tip_sliding(const gmi_corner_view *v, const moving_tip *tip,
                                         const moving_middle *part, moving_speed *found) {
    const gmi_sliding *s = v->sliding;
    const double t1 = part->t1, length = s->line_of_action;
    const double base_sum =
        v->mesh->pair->pinion.base_radius + v->mesh->engagement.wheel_base_radius;
    const double both = s->pinion_speed + s->wheel_speed;
    const double sideways = s->sideways[0] + s->sideways[1] * t1 + s->wheel_speed * length;
    const double forward = s->forward[0] + s->forward[1] * t1 + s->wheel_speed * base_sum;
    const of_tip *lead = &tip->lead, *versine = &tip->versine, *sine = &tip->sine;
    const double along = s->sideways[1] * versine->value - s->forward[1] * sine->value;
    const double turning = s->sideways[1] * versine->per_t1 - s->forward[1] * sine->per_t1;

    /* In the middle of the load, and along the line. */
    moving *speed = &found->speed, *slope = &found->slope;
    speed->value += both * lead->value + sideways * versine->value - forward * sine->value;
    slope->value +=
        both * lead->per_t1 + sideways * versine->per_t1 - forward * sine->per_t1 + along;
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        speed->by[k] += both * lead->by[k] + sideways * versine->by[k] - forward * sine->by[k] +
                        along * part->t1_by[k];
        slope->by[k] += both * lead->per_t1_by[k] + sideways * versine->per_t1_by[k] -
                        forward * sine->per_t1_by[k] + s->sideways[1] * versine->by[k] -
                        s->forward[1] * sine->by[k] + turning * part->t1_by[k];
    }
    speed->by[GMI_BY_LENGTH] += s->wheel_speed * versine->value;
    slope->by[GMI_BY_LENGTH] += s->wheel_speed * versine->per_t1;

    /* By the speeds themselves. */
    speed->by[GMI_BY_PINION_SPEED] += lead->value;
    speed->by[GMI_BY_WHEEL_SPEED] += lead->value + length * versine->value - base_sum * sine->value;
    speed->by[GMI_BY_SIDEWAYS] += versine->value;
    speed->by[GMI_BY_SIDEWAYS_T1] += versine->value * t1;
    speed->by[GMI_BY_FORWARD] = -sine->value;
    speed->by[GMI_BY_FORWARD_T1] = -sine->value * t1;
    slope->by[GMI_BY_PINION_SPEED] += lead->per_t1;
    slope->by[GMI_BY_WHEEL_SPEED] +=
        lead->per_t1 + length * versine->per_t1 - base_sum * sine->per_t1;
    slope->by[GMI_BY_SIDEWAYS] += versine->per_t1;
    slope->by[GMI_BY_SIDEWAYS_T1] += versine->value + versine->per_t1 * t1;
    slope->by[GMI_BY_FORWARD] = -sine->per_t1;
    slope->by[GMI_BY_FORWARD_T1] = -sine->value - sine->per_t1 * t1;
}

/* Share or lean of the load: by its size over what touches and by the speeds. */
static OWN_STACK void follow_share(const gmi_corner_view *v, const part_load *load, double contact,
                                   const moving_middle *part, const moving_speed *sliding,
                                   const gmi_part_share *at, moving *share) {
    const gmi_rolling_by rolling = gmi_rolling_differentiate(v->sliding);
    share->value = at->value;
    for (int k = 0; k < GMI_TIP_VARIABLES; ++k) {
        share->by[k] = at->by_speed * sliding->speed.by[k] + at->by_slope * sliding->slope.by[k];
    }
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        share->by[k] +=
            at->by_load * load->force_by[k] / load->force + at->by_apart * part->apart_by[k];
    }
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        share->by[k] += (at->by_contact - at->by_load) * load->contact_by[k] / contact;
    }
    share->by[GMI_BY_LENGTH] += at->by_rolling * rolling.length;
    share->by[GMI_BY_PINION_SPEED] += at->by_rolling * rolling.pinion_speed;
    share->by[GMI_BY_WHEEL_SPEED] += at->by_rolling * rolling.wheel_speed;
}

/* One weight of the force of friction of a part, from its share of the load. */
static void weigh_share(const gmi_corner_view *v, const gmi_corner_line *whole,
                        const part_load *load, const moving *share, int weight, moving *weighted) {
    const double advance = v->lines.advance, origin = whole->origin;

    /* Force and moment over t1 make up each of them: 1, t1 and rho_p. */
    const double of_force = weight == GMI_WHOLE ? 1.0 : weight == GMI_BY_RHO ? origin : 0.0;
    const double of_moment = weight == GMI_BY_T1 ? 1.0 : weight == GMI_BY_RHO ? advance : 0.0;
    const double loaded = of_force * load->force + of_moment * load->moment;
    weighted->value = share->value * loaded;
    for (int k = 0; k < GMI_TIP_VARIABLES; ++k) {
        weighted->by[k] = share->by[k] * loaded;
    }
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        weighted->by[k] +=
            share->value * (of_force * load->force_by[k] + of_moment * load->moment_by[k]);
    }
    if (weight == GMI_BY_RHO) {
        weighted->by[GMI_BY_ORIGIN] += share->value * load->force;
    }
}

/* Adds what has a value and moves, times a factor. */
static void add_moving(const moving *a, double factor, int weight, double sum[GMI_WEIGHTS],
                       double by[][GMI_WEIGHTS]) {
    sum[weight] += factor * a->value;
    for (int k = 0; k < GMI_TIP_VARIABLES; ++k) {
        by[k][weight] += factor * a->by[k];
    }
}

/* Adds what a tip has, times a force. */
static void add_at_tip(const of_tip *tip, const moving *force, int weight, double sum[GMI_WEIGHTS],
                       double by[][GMI_WEIGHTS]) {
    add_moving(force, tip->value, weight, sum, by);
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        by[k][weight] += tip->by[k] * force->value;
    }
}

/* Adds the lean times how that changes along the part, and for the moment along the face times t1. */
static void add_along_tip(const of_tip *tip, const moving *lean, const moving_middle *part,
                          int weight, double sum[GMI_WEIGHTS], double by[][GMI_WEIGHTS]) {
    const double t1 = weight == GMI_BY_T1 ? part->t1 : 1.0;
    add_moving(lean, tip->per_t1 * t1, weight, sum, by);
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        const double t1_by = weight == GMI_BY_T1 ? part->t1_by[k] : 0.0;
        by[k][weight] += lean->value * (tip->per_t1_by[k] * t1 + tip->per_t1 * t1_by);
    }
}

/* Adds the friction of a part in the middle of its load; tip: NULL = on the line of action. */
static OWN_STACK void add_share(const gmi_corner_view *v, const gmi_corner_line *whole,
                                const part_load *load, const moving *share, const moving_tip *tip) {
    gmi_corner_rubbing *side = v->rubbing;
    double(*sum)[GMI_WEIGHTS] = side->sum;
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        moving weighted;
        weigh_share(v, whole, load, share, weight, &weighted);
        add_moving(&weighted, 1.0, weight, sum[GMI_RUBBING_FLANKS], side->by[GMI_RUBBING_FLANKS]);
        if (tip == NULL || weight == GMI_BY_RHO) {
            continue;
        }

        /* What the normal has turned, and the pinion's arm from the line of action to the corner. */
        add_at_tip(&tip->sine, &weighted, weight, sum[GMI_RUBBING_SINE],
                   side->by[GMI_RUBBING_SINE]);
        add_at_tip(&tip->versine, &weighted, weight, sum[GMI_RUBBING_VERSINE],
                   side->by[GMI_RUBBING_VERSINE]);
        if (weight == GMI_WHOLE) {
            add_at_tip(&tip->lead, &weighted, GMI_BY_RHO, sum[GMI_RUBBING_FLANKS],
                       side->by[GMI_RUBBING_FLANKS]);
        }
    }
}

/* And what makes it lean along the part: a moment over t1, which the middle of the load does not have (N). */
static OWN_STACK void add_lean(const gmi_corner_view *v, const moving *lean,
                               const moving_middle *part, const moving_tip *tip) {
    gmi_corner_rubbing *side = v->rubbing;
    double(*sum)[GMI_WEIGHTS] = side->sum;
    double *flanks = sum[GMI_RUBBING_FLANKS];
    double(*flanks_by)[GMI_WEIGHTS] = side->by[GMI_RUBBING_FLANKS];
    add_moving(lean, 1.0, GMI_BY_T1, flanks, flanks_by);
    add_moving(lean, v->lines.advance, GMI_BY_RHO, flanks, flanks_by);
    if (tip == NULL) {
        return;
    }

    /* With it the arm gets longer, and the moment of what is turned grows. */
    add_along_tip(&tip->lead, lean, part, GMI_BY_RHO, flanks, flanks_by);
    const of_tip *turned[GMI_RUBBING_PARTS] = {
        [GMI_RUBBING_SINE] = &tip->sine, [GMI_RUBBING_VERSINE] = &tip->versine};
    for (int of = GMI_RUBBING_SINE; of <= GMI_RUBBING_VERSINE; ++of) {
        add_at_tip(turned[of], lean, GMI_BY_T1, sum[of], side->by[of]);
        add_along_tip(turned[of], lean, part, GMI_WHOLE, sum[of], side->by[of]);
        add_along_tip(turned[of], lean, part, GMI_BY_T1, sum[of], side->by[of]);
    }
}

/* What a tip makes of the place of the part. */
static OWN_STACK void follow_tip(const gmi_corner_view *v, const gmi_corner_line *whole, int role,
                                 const gmi_corner_parabola *gap, const part_load *load,
                                 double contact, const moving_middle *part, moving_tip *tip) {
    moving_roll roll;
    gmi_corner_joint halfway;
    find_moving_roll(v, whole, role, load, contact, part, &roll);
    gmi_corner_joint_at(&v->mesh->corners[role], gmi_corner_middle(gap), &halfway);
    follow_tip_place(v, role, gap, &halfway, &roll, tip);
}

/* What is known of a part, to its friction. */
static OWN_STACK void find_friction(const gmi_corner_view *v, const part_load *load,
                                    const gmi_line_sum *sum, const moving_middle *part,
                                    const moving_speed *sliding, gmi_part_friction *found) {
    const gmi_sliding_part as = {.load = load->force / sum->contact,
                                 .contact = sum->contact,
                                 .speed = sliding->speed.value,
                                 .slope = sliding->slope.value,
                                 .apart = part->apart};
    gmi_friction_of_part(v->sliding, &as, found);
}

/* Adds the friction of a part; tip: NULL = on the line of action. */
static OWN_STACK void add_rubbing(const gmi_corner_view *v, const gmi_corner_line *whole,
                                  const part_load *load, const gmi_line_sum *sum,
                                  const moving_middle *part, const moving_tip *tip) {
    moving_speed sliding;
    follow_sliding(v, whole, part, &sliding);
    if (tip != NULL) {
        follow_tip_sliding(v, tip, part, &sliding);
    }
    gmi_part_friction at;
    moving found;
    find_friction(v, load, sum, part, &sliding, &at);
    follow_share(v, load, sum->contact, part, &sliding, &at.share, &found);
    add_share(v, whole, load, &found, tip);

    /* The lean is that of the whole load. */
    follow_share(v, load, sum->contact, part, &sliding, &at.lean, &found);
    for (int k = 0; k < GMI_TIP_VARIABLES; ++k) {
        found.by[k] *= load->force;
    }
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        found.by[k] += found.value * load->force_by[k];
    }
    found.value *= load->force;
    add_lean(v, &found, part, tip);
}

/* Of a part that presses. */
static OWN_STACK void follow_rubbing(const gmi_corner_view *v, const gmi_corner_line *whole,
                                     int role, const gmi_corner_parabola *gap,
                                     const part_load *load, const gmi_line_sum *sum) {
    moving_middle part;
    moving_tip tip;
    follow_middle(load, sum, &part);
    if (gap != NULL) {
        follow_tip(v, whole, role, gap, load, sum->contact, &part, &tip);
    }
    add_rubbing(v, whole, load, sum, &part, gap != NULL ? &tip : NULL);
}

OWN_STACK void gmi_corner_follow_friction(const gmi_corner_view *v, const gmi_corner_line *whole,
                                          int role, const gmi_corner_parabola *gap,
                                          const gmi_corner_cut *from, const gmi_corner_cut *to,
                                          const gmi_line_sum *sum) {
    gmi_corner_rubbing *side = v->rubbing;
    part_load load;
    find_part_load(v, whole, from, to, sum, &load);
    side->force += load.force;
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        side->force_by[k] += load.force_by[k];
    }
    if (load.force > 0.0) {
        follow_rubbing(v, whole, role, gap, &load, sum);
    }
}

/* What of the coefficient is the same all over the side. */
OWN_STACK void gmi_corner_finish_friction(const gmi_corner_view *v) {
    gmi_corner_rubbing *side = v->rubbing;
    gmi_common_friction mu = {0.0, 0.0};
    if (side->force > 0.0) { /* else damping has taken the force of the side away */
        mu = gmi_friction_common(v->sliding, side->force);
    }

    /* By the logarithm of its power of the force over the rolling speed. */
    const gmi_rolling_by rolling = gmi_rolling_differentiate(v->sliding);
    double power_by[GMI_TIP_VARIABLES] = {0.0};
    for (int k = 0; k < GMI_TIP_OWN && mu.power != 0.0; ++k) {
        power_by[k] = mu.power * side->force_by[k] / side->force;
    }
    power_by[GMI_BY_LENGTH] -= mu.power * rolling.length;
    power_by[GMI_BY_PINION_SPEED] = -mu.power * rolling.pinion_speed;
    power_by[GMI_BY_WHEEL_SPEED] = -mu.power * rolling.wheel_speed;
    for (int part = 0; part < GMI_RUBBING_PARTS; ++part) {
        for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
            double *sum = &side->sum[part][weight];
            for (int k = 0; k < GMI_TIP_VARIABLES; ++k) {
                double *by = &side->by[part][k][weight];
                *by = mu.value * (*by + power_by[k] * *sum);
            }
            *sum *= mu.value;
        }
    }
}

/* Adds what a part has to the forces of the side. */
OWN_STACK void gmi_corner_follow_forces(const gmi_corner_view *v, const gmi_corner_line *whole,
                                        const gmi_line_sum *sum) {
    gmi_corner_tangent *side = v->followed;
    const gmi_line_tangent *line = v->tangent;
    const double *c = line->contact, *arm = line->arm, *speed = line->speed;
    add_weighted(v, whole, sum->sum, sum->sum_t1, side->sum);
    add_weighted(v, whole, sum->contact, sum->contact_t1, side->contact);
    add_weighted(v, whole, arm[0] * c[0] + arm[1] * c[1], arm[0] * c[1] + arm[1] * c[2], side->arm);
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        const double *contact_by = line->contact_by[k];
        add_weighted(v, whole, line->sum_by[k][0], line->sum_by[k][1], side->sum_by[k]);
        add_weighted(v, whole, contact_by[0], contact_by[1], side->contact_by[k]);
        side->flow_by[k] += speed[0] * contact_by[0] + speed[1] * contact_by[1];
    }

    /* The moment over rho_p moves with the origin. */
    side->sum_by[GMI_BY_ORIGIN][GMI_BY_RHO] += sum->sum;
    side->contact_by[GMI_BY_ORIGIN][GMI_BY_RHO] += sum->contact;
}
