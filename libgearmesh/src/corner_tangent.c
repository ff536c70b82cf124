/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * How lines that go on beyond the path of contact move with all coordinates of a side: the overlap with its gap, the force
 * at tips, whose normal turns, and the friction there. libgearmesh/docs/equations.md, corner contact, derives it.
 */
#include "corner.h"
#include "corner_line.h"
#include "internal.h"

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
    double contact_by[GMI_COORDINATES];
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

static void set_moving(const at_middle *what, const double roll_by[GMI_TIP_OWN], moving *result) {
    memset(result, 0, sizeof *result);
    result->value = what->value;
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        result->by[k] = moved_by(what, roll_by, k);
    }
}

/* What a tip makes of the place on the line of action: gmi_tip_place with all derivatives. */
typedef struct moving_tip {
    moving lead, longer, versine, sine;
} moving_tip;

/* As tip_place_of() has it. */
static OWN_STACK void follow_tip_place(const gmi_corner_view *v, const gmi_corner_line *whole,
                                       int role, const gmi_corner_parabola *gap,
                                       const part_load *load, moving_tip *tip) {
    const gmi_engagement *at = &v->mesh->engagement;
    const double base[2] = {v->mesh->pair->pinion.base_radius, at->wheel_base_radius};
    const double base_sum = base[GM_PINION] + base[GM_WHEEL];
    const double length = at->line_of_action;
    at_middle slope, versine;
    double roll_by[GMI_TIP_OWN];
    const double roll = follow_roll(v, whole, role, load, roll_by);
    find_turn(gap, roll, &slope, &versine);

    /* The turn by the slope of the gap, and the arms by both. */
    const gmi_corner_joint *a = &gap->begins, *b = &gap->ends;
    at_middle gain = between(gap, roll, a->gain, b->gain, a->gain_by_roll);
    gain.by_length = between(gap, roll, a->gain_by_length, b->gain_by_length, 0.0).value;
    const double sine_value = (base[role] * slope.value - base_sum * versine.value) / length;
    const at_middle sine = {
        sine_value, (base[role] * slope.by_roll - base_sum * versine.by_roll) / length,
        (base[role] * slope.by_length - base_sum * versine.by_length - sine_value) / length};
    const at_middle longer = {base_sum * sine.value - length * versine.value,
                              base_sum * sine.by_roll - length * versine.by_roll,
                              base_sum * sine.by_length - length * versine.by_length -
                                  versine.value};
    const at_middle other = {longer.value - gain.value, longer.by_roll - gain.by_roll,
                             longer.by_length - gain.by_length};
    set_moving(role == GM_PINION ? &other : &gain, roll_by, &tip->lead);
    set_moving(&longer, roll_by, &tip->longer);
    set_moving(&versine, roll_by, &tip->versine);
    set_moving(&sine, roll_by, &tip->sine);
}

/* Sliding speed in the middle of the load; tip: NULL = on the line of action. */
static OWN_STACK void follow_sliding(const gmi_corner_view *v, const gmi_corner_line *whole,
                                     const part_load *load, const moving_tip *tip, moving *speed) {
    const gmi_sliding *s = v->sliding;
    const double t1 = load->moment / load->force;
    const double rho_p = whole->origin + v->lines.advance * t1;
    const double both = s->pinion_speed + s->wheel_speed;
    memset(speed, 0, sizeof *speed);
    speed->value = s->pinion_speed * rho_p - s->wheel_speed * (s->line_of_action - rho_p) -
                   s->sideways[0] - s->sideways[1] * t1;

    /* The middle moves along the line, and the line with its origin. */
    const double per_t1 = both * v->lines.advance - s->sideways[1];
    double t1_by[GMI_TIP_OWN];
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        t1_by[k] = (load->moment_by[k] - t1 * load->force_by[k]) / load->force;
        speed->by[k] = per_t1 * t1_by[k];
    }
    speed->by[GMI_BY_ORIGIN] += both;
    speed->by[GMI_BY_LENGTH] -= s->wheel_speed;
    speed->by[GMI_BY_PINION_SPEED] = rho_p;
    speed->by[GMI_BY_WHEEL_SPEED] = -(s->line_of_action - rho_p);
    speed->by[GMI_BY_SIDEWAYS] = -1.0;
    speed->by[GMI_BY_SIDEWAYS_T1] = -t1;
    if (tip == NULL) {
        return;
    }

    /* At a tip both arms are longer, and the wheel's axis moves across the turned tangent. */
    const double sideways = s->sideways[0] + s->sideways[1] * t1;
    const double forward = s->forward[0] + s->forward[1] * t1;
    const double versine = tip->versine.value, sine = tip->sine.value;
    const double lead = tip->lead.value, longer = tip->longer.value;
    speed->value += both * lead - s->wheel_speed * longer + sideways * versine - forward * sine;
    const double tip_per_t1 = s->sideways[1] * versine - s->forward[1] * sine;
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        speed->by[k] += both * tip->lead.by[k] - s->wheel_speed * tip->longer.by[k] +
                        sideways * tip->versine.by[k] - forward * tip->sine.by[k] +
                        tip_per_t1 * t1_by[k];
    }
    speed->by[GMI_BY_PINION_SPEED] += lead;
    speed->by[GMI_BY_WHEEL_SPEED] += lead - longer;
    speed->by[GMI_BY_SIDEWAYS] += versine;
    speed->by[GMI_BY_SIDEWAYS_T1] += versine * t1;
    speed->by[GMI_BY_FORWARD] = -sine;
    speed->by[GMI_BY_FORWARD_T1] = -sine * t1;
}

/* The share of the load that rubs, by its size over what touches and by the speeds. */
static OWN_STACK void follow_share(const gmi_corner_view *v, const part_load *load, double contact,
                                   const moving *speed, moving *share) {
    const gmi_point_friction at =
        gmi_friction_of_speed(v->sliding, load->force / contact, speed->value);
    const gmi_rolling_by rolling = gmi_rolling_differentiate(v->sliding);
    share->value = at.share;
    for (int k = 0; k < GMI_TIP_VARIABLES; ++k) {
        share->by[k] = at.by_speed * speed->by[k];
    }
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        share->by[k] += at.by_load * load->force_by[k] / load->force;
    }
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        share->by[k] -= at.by_load * load->contact_by[k] / contact;
    }
    share->by[GMI_BY_LENGTH] += at.by_rolling * rolling.length;
    share->by[GMI_BY_PINION_SPEED] += at.by_rolling * rolling.pinion_speed;
    share->by[GMI_BY_WHEEL_SPEED] += at.by_rolling * rolling.wheel_speed;
}

/* Adds what has the value a b. */
static void add_moving(const moving *a, const moving *b, int weight, double sum[GMI_WEIGHTS],
                       double by[][GMI_WEIGHTS]) {
    sum[weight] += a->value * b->value;
    for (int k = 0; k < GMI_TIP_VARIABLES; ++k) {
        by[k][weight] += a->value * b->by[k] + a->by[k] * b->value;
    }
}

/* The force of friction of a part with its moments: times 1, t1 and rho_p. */
static void weigh_share(const gmi_corner_view *v, const gmi_corner_line *whole,
                        const part_load *load, const moving *share, moving weighted[GMI_WEIGHTS]) {
    const double advance = v->lines.advance, origin = whole->origin;
    const double loads[GMI_WEIGHTS] = {load->force, load->moment,
                                       origin * load->force + advance * load->moment};
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        moving *result = &weighted[weight];
        result->value = share->value * loads[weight];
        for (int k = 0; k < GMI_TIP_VARIABLES; ++k) {
            result->by[k] = share->by[k] * loads[weight];
        }
    }
    for (int k = 0; k < GMI_TIP_OWN; ++k) {
        const double force_by = load->force_by[k], moment_by = load->moment_by[k];
        weighted[GMI_WHOLE].by[k] += share->value * force_by;
        weighted[GMI_BY_T1].by[k] += share->value * moment_by;
        weighted[GMI_BY_RHO].by[k] += share->value * (origin * force_by + advance * moment_by);
    }
    weighted[GMI_BY_RHO].by[GMI_BY_ORIGIN] += share->value * load->force;
}

static OWN_STACK void find_share(const gmi_corner_view *v, const gmi_corner_line *whole,
                                 const part_load *load, double contact, const moving_tip *tip,
                                 moving *share) {
    moving speed;
    follow_sliding(v, whole, load, tip, &speed);
    follow_share(v, load, contact, &speed, share);
}

/* tip: NULL = on the line of action. */
static OWN_STACK void add_share(const gmi_corner_view *v, const gmi_corner_line *whole,
                                const part_load *load, const moving *share, const moving_tip *tip) {
    static const moving one = {1.0, {0.0}};
    gmi_corner_rubbing *side = v->rubbing;
    double *flanks = side->sum[GMI_RUBBING_FLANKS];
    double(*flanks_by)[GMI_WEIGHTS] = side->by[GMI_RUBBING_FLANKS];
    moving weighted[GMI_WEIGHTS];
    weigh_share(v, whole, load, share, weighted);
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        add_moving(&one, &weighted[weight], weight, flanks, flanks_by);
    }
    if (tip == NULL) {
        return;
    }

    /* From the line of action to the corner. */
    add_moving(&tip->lead, &weighted[GMI_WHOLE], GMI_BY_RHO, flanks, flanks_by);
    for (int weight = GMI_WHOLE; weight <= GMI_BY_T1; ++weight) {
        add_moving(&tip->sine, &weighted[weight], weight, side->sum[GMI_RUBBING_SINE],
                   side->by[GMI_RUBBING_SINE]);
        add_moving(&tip->versine, &weighted[weight], weight, side->sum[GMI_RUBBING_VERSINE],
                   side->by[GMI_RUBBING_VERSINE]);
    }
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
    if (!(load.force > 0.0)) {
        return;
    }

    moving share;
    moving_tip tip;
    if (gap != NULL) {
        follow_tip_place(v, whole, role, gap, &load, &tip);
    }
    find_share(v, whole, &load, sum->contact, gap != NULL ? &tip : NULL, &share);
    add_share(v, whole, &load, &share, gap != NULL ? &tip : NULL);
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
