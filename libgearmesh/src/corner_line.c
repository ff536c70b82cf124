/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Lines of contact that go on beyond the path of contact, where a tip corner touches: there the overlap falls by the gap
 * of corner.c, a function of the roll beyond the tip alone, which is straight along a line.
 *
 * Of spur gears the gap is the same all along a line, and taken as it is. Of helical gears it is a chain of parabolas with
 * the exact gap and slope at every second joint, and without a jump or kink at any joint: within 1e-7 of the base pitch,
 * and on average within 1e-8. So each part of a line between two joints is one that line.c integrates, tables and ramps as
 * they are. Beyond its ends a flank has the deviation of the end. Nothing jumps where a corner begins, and no end of a line
 * counts but those of the faces; starts of profiles end no line either.
 */
#include "corner_line.h"

#include "contact.h"
#include "corner.h"
#include "flank.h"
#include "friction.h"
#include "internal.h"
#include "law.h"
#include "line.h"
#include "mesh.h"
#include "meshing.h"
#include "penetration.h"
#include "tilt.h"

#include <math.h>
#include <string.h>

/* Of a flank without tables and ramps. */
static const gmi_grid no_grid = {0};

/* What lines are followed for: sums, or with all coordinates. */
enum { FOLLOW_SUMS, FOLLOW_FORCES, FOLLOW_FRICTION };

#define JOINT_ROUNDING 1e-9 /* of the shortest parabola: a place this close to a joint is at it */

/* ---------------------------------------------------------------------------------------------
 * The gap as parabolas
 * ------------------------------------------------------------------------------------------- */

/* Widths double as the roll grows, so that all joints are at whole numbers of them. */
static double width_at(const gmi_corner *corner, double roll) {
    double width = corner->coarse;
    while (roll < 8.0 * width && width > corner->fine) {
        width *= 0.5;
    }
    return width;
}

/* The next joint on the way of the line, from a roll on that may be one. */
static double next_joint(const gmi_corner *corner, double roll, int climbs) {
    const double rounding = JOINT_ROUNDING * corner->fine;
    if (climbs) {
        const double width = width_at(corner, roll + rounding);
        return (floor(roll / width + JOINT_ROUNDING) + 1.0) * width;
    }
    const double width = width_at(corner, roll - rounding);
    return (ceil(roll / width - JOINT_ROUNDING) - 1.0) * width;
}

/* Both parabolas between two joints meet halfway with the same slope: gap and slope at both ends say which. */
static OWN_STACK void find_parabola(const gmi_corner *corner, double roll,
                                    gmi_corner_parabola *found) {
    const double width = 2.0 * width_at(corner, roll);
    const double from = floor(roll / width) * width;
    if (from != found->pair_from) {
        /* Lines go from joint to joint: one of both is known from the last. */
        const double to = fmin(from + width, corner->reach);
        const gmi_corner_joint begins = found->begins, ends = found->ends;
        const int is_known = found->pair_from >= 0.0;
        if (is_known && from == found->pair_to) {
            found->begins = ends;
        } else {
            gmi_corner_joint_at(corner, from, &found->begins);
        }
        if (is_known && to == found->pair_from) {
            found->ends = begins;
        } else {
            gmi_corner_joint_at(corner, to, &found->ends);
        }
        found->pair_from = from;
        found->pair_to = to;
    }

    /* Two parabolas from joint to joint that meet half-way, with the slope that both then have there. */
    const gmi_corner_joint *begins = &found->begins, *ends = &found->ends;
    const double half = 0.5 * (found->pair_to - from);
    const double middle_slope =
        (ends->gap - begins->gap) / half - 0.5 * (begins->slope + ends->slope);

    if (roll < from + half) {
        found->from = from;
        found->gap = begins->gap;
        found->slope = begins->slope;
        found->curvature = (middle_slope - begins->slope) / half;
    } else {
        found->from = from + half;
        found->gap = begins->gap + 0.5 * half * (begins->slope + middle_slope);
        found->slope = middle_slope;
        found->curvature = (ends->slope - middle_slope) / half;
    }
}

/* Of spur gears. */
static OWN_STACK void find_point(const gmi_corner *corner, double roll,
                                 gmi_corner_parabola *found) {
    if (roll == found->pair_from) {
        return;
    }
    gmi_corner_place place;
    gmi_corner_at(corner, roll, &place);
    gmi_corner_joint_at(corner, roll, &found->begins);
    found->ends = found->begins;
    found->from = found->pair_from = found->pair_to = roll;
    found->gap = place.gap;
    found->slope = place.by_roll;
    found->curvature = place.by_roll_twice;
}

/* The gap of one tip around a place on a line. */
static const gmi_corner_parabola *gap_at(gmi_corner_view *v, const gmi_beyond *beyond, int role,
                                         double t1) {
    const gmi_corner *corner = &v->mesh->corners[role];
    const double roll = gmi_corner_roll_at(beyond, t1);
    if (role != v->last_role) {
        v->last_role = role;
        v->last.pair_from = -1.0; /* nothing found yet */
    }
    if (beyond->per_t1 == 0.0) {
        find_point(corner, roll, &v->last);
    } else {
        find_parabola(corner, roll, &v->last);
    }
    return &v->last;
}

/* The roll at which the gap exceeds an overlap, which tilts raise with the roll: kappa u^2 / 2 is not far from it. */
static OWN_STACK double stop_of(const gmi_corner *corner, double overlap, double by_roll) {
    gmi_corner_place place;
    gmi_corner_at(corner, 0.0, &place);
    double roll = fmin(sqrt(2.0 * overlap / place.by_roll_twice), corner->reach);
    for (int k = 0; k < 40 && roll < corner->reach; ++k) {
        gmi_corner_at(corner, roll, &place);
        if (place.gap > overlap + by_roll * roll) {
            break;
        }
        roll = fmin(1.25 * roll, corner->reach);
    }
    return roll;
}

/* ---------------------------------------------------------------------------------------------
 * Parts of a line
 * ------------------------------------------------------------------------------------------- */

/* v2 of a flank along the line, at t1 = 0 and by t1. */
static double profile_of(const gmi_line *line, int role) {
    return role == GM_PINION ? line->pinion_profile : line->wheel_profile;
}

static double profile_rate(const gmi_grid *grid) {
    return grid->direction * grid->climb;
}

static void take_nearer(double t1, double from, double by_origin, double by_delta, int what,
                        gmi_corner_cut *next) {
    if (t1 > from && t1 < next->t1) { /* not for spur gears: infinite, or no number */
        next->t1 = t1;
        next->by[GMI_BY_ORIGIN] = by_origin;
        next->by[GMI_BY_DELTA] = by_delta;
        next->what = what;
    }
}

/* Where the next part begins: at an end of either flank's table, at a tip, at a joint of the gap, and on the path of contact
 * where sliding speeds differ enough. */
static gmi_corner_cut next_cut(const gmi_corner_view *v, const gmi_corner_line *whole, double from,
                               const gmi_corner_cut *last) {
    gmi_corner_cut next = *last;
    const double per_advance = 1.0 / v->lines.advance;
    int is_on_path = 1;
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        /* Ends of the table. */
        const gmi_grid *grid = v->running[role];
        if (grid->face_rate > 0.0) {
            const double profile = profile_of(&whole->line, role);
            const double by_delta = role == GM_PINION ? 0.0 : per_advance;
            take_nearer(-profile / profile_rate(grid), from, -per_advance, by_delta,
                        GMI_CUT_TABLE + role, &next);
            take_nearer((grid->profile_cells - profile) / profile_rate(grid), from, -per_advance,
                        by_delta, GMI_CUT_TABLE + role, &next);
        }

        /* The tip, and beyond it the next joint. */
        const gmi_beyond *beyond = &whole->beyond[role];
        const gmi_corner *corner = &v->mesh->corners[role];
        const double rounding = JOINT_ROUNDING * corner->fine;
        const double roll = gmi_corner_roll_at(beyond, from);
        const int climbs = beyond->per_t1 > 0.0;
        const int is_before = climbs ? roll < -rounding : roll <= rounding;
        is_on_path = is_on_path && is_before;
        const double next_roll = is_before ? 0.0 : next_joint(corner, roll, climbs);
        take_nearer((next_roll - beyond->at_zero) / beyond->per_t1, from,
                    -beyond->by_origin / beyond->per_t1, -beyond->by_delta / beyond->per_t1,
                    GMI_CUT_ROLL + role, &next);
    }
    for (int k = 0; k < GMI_FRICTION_CUTS && v->sliding != NULL && is_on_path; ++k) {
        take_nearer((v->sliding->friction->cuts[k] - whole->origin) * per_advance, from,
                    -per_advance, 0.0, GMI_CUT_FRICTION + k, &next);
    }
    return next;
}

/* A flank that has ended before this part has the deviation of its end. */
static void hold_flanks(const gmi_corner_view *v, double middle, gmi_line *part, int held[2]) {
    double *profile[2] = {&part->pinion_profile, &part->wheel_profile};
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const gmi_grid *grid = v->running[role];
        const double place = *profile[role] + profile_rate(grid) * middle;
        held[role] = grid->face_rate > 0.0 && !(place >= 0.0 && place <= grid->profile_cells);
        if (held[role]) {
            *profile[role] = place < 0.0 ? 0.0 : grid->profile_cells;
        }
    }
}

/* What is known of the tangent of a part before it is followed. */
static OWN_STACK void begin_tangent(gmi_corner_view *v, const gmi_corner_line *whole,
                                    const int held[2]) {
    const gm_mesh *mesh = v->mesh;
    gmi_line_tangent *tangent = v->tangent;
    memset(tangent, 0, sizeof *tangent);
    tangent->by[GMI_BY_DELTA][0] = 1.0;
    if (v->rates != NULL) {
        gmi_tilt_motion motion;
        gmi_tilt_motion_find(mesh->pair, &mesh->engagement, v->side, v->lines.delta, v->rates,
                             &motion);
        gmi_tilt_tangent(&motion, whole->origin, tangent);
        tangent->face_per_length = v->running[GM_WHEEL]->face_rate / mesh->pair->face_width;
    } else if (mesh->engagement.is_tilted) {
        tangent->by[GMI_BY_DELTA][0] = whole->gain;
        tangent->by[GMI_BY_ORIGIN][0] = whole->by_origin[0];
        tangent->by[GMI_BY_ORIGIN][1] = whole->by_origin[1];
    }
    tangent->pinion_per_rho = held[GM_PINION] ? 0.0 : v->running[GM_PINION]->per_rho;
    tangent->wheel_per_rho = held[GM_WHEEL] ? 0.0 : v->running[GM_WHEEL]->per_rho;
}

/* A corner takes its gap off the part, and changes what the part moves by. */
static void take_gap_off(gmi_corner_view *v, const gmi_corner_line *whole, int role,
                         const gmi_corner_parabola *gap, gmi_line *part) {
    const gmi_beyond *beyond = &whole->beyond[role];
    const double gone = gmi_corner_roll_at(beyond, part->from) - gap->from;
    const double rate = beyond->per_t1;
    part->overlap -= gap->gap + gone * (gap->slope + 0.5 * gone * gap->curvature);
    part->half_slope -= 0.5 * rate * (gap->slope + gone * gap->curvature);
    part->curvature -= 0.5 * rate * rate * gap->curvature;
    if (v->rates != NULL) {
        gmi_corner_follow_gap(v, whole, role, gap);
    } else if (v->wanted & GMI_DERIVATIVES) {
        const double slope_0 = gap->slope + gap->curvature * (beyond->at_zero - gap->from);
        const double slope_1 = gap->curvature * rate;
        v->tangent->by[GMI_BY_ORIGIN][0] -= beyond->by_origin * slope_0;
        v->tangent->by[GMI_BY_ORIGIN][1] -= beyond->by_origin * slope_1;
        v->tangent->by[GMI_BY_DELTA][0] -= beyond->by_delta * slope_0;
        v->tangent->by[GMI_BY_DELTA][1] -= beyond->by_delta * slope_1;
    }
}

/* The force of a part, and its derivatives by origin and delta. */
typedef struct part_force {
    double whole, by_t1;
    double whole_by[2], by_t1_by[2];
} part_force;

/* Of stiffness and damping. */
static part_force force_of(const gmi_corner_view *v, const gmi_line_sum *sum) {
    const double stiffness = v->mesh->law.stiffness, viscous = v->viscous;
    part_force force = {stiffness * sum->sum + viscous * sum->contact,
                        stiffness * sum->sum_t1 + viscous * sum->contact_t1,
                        {0.0, 0.0},
                        {0.0, 0.0}};
    if (v->wanted & GMI_DERIVATIVES) {
        const gmi_line_tangent *tangent = v->tangent;
        for (int k = GMI_BY_ORIGIN; k <= GMI_BY_DELTA; ++k) {
            force.whole_by[k] =
                stiffness * tangent->sum_by[k][0] + viscous * tangent->contact_by[k][0];
            force.by_t1_by[k] =
                stiffness * tangent->sum_by[k][1] + viscous * tangent->contact_by[k][1];
        }
    }
    return force;
}

/* What acts at a corner: arms are exact, moments along the face those of the middle of the load. */
static void add_tip_load(const gmi_corner_view *v, const gmi_beyond *beyond,
                         const gmi_corner_parabola *gap, const gmi_line_sum *sum,
                         gmi_tip_load *tip) {
    const part_force load = force_of(v, sum);
    tip->contact += sum->contact;
    if (load.whole == 0.0) {
        return;
    }

    /* Where the middle of the load is: slope of the gap, and the share of the way between both joints of the parabola. */
    const double roll = gmi_corner_roll_at(beyond, load.by_t1 / load.whole);
    const double slope = gap->slope + gap->curvature * (roll - gap->from);
    const double length = gap->pair_to - gap->pair_from;
    const double q = length > 0.0 ? (roll - gap->pair_from) / length : 0.0;
    const gmi_corner_joint *a = &gap->begins, *b = &gap->ends;
    const double versine = a->versine + q * (b->versine - a->versine);

    /* How much shorter the arm is, and how the normal has turned, times the force. */
    tip->arm += slope * load.whole;
    tip->arm_t1 += slope * load.by_t1;
    tip->versine += versine * load.whole;
    tip->versine_t1 += versine * load.by_t1;
    tip->across += (a->across + q * (b->across - a->across)) * load.whole;
    tip->along += (a->along + q * (b->along - a->along)) * load.whole;

    /* The slope is linear in t1 on a parabola, slope_0 + slope_1 t1, so the derivatives of two sums are enough. */
    if (v->wanted & GMI_DERIVATIVES) {
        const double slope_0 = gap->slope + gap->curvature * (beyond->at_zero - gap->from);
        const double slope_1 = gap->curvature * beyond->per_t1;
        tip->arm_by_origin += slope_0 * load.whole_by[GMI_BY_ORIGIN] +
                              slope_1 * load.by_t1_by[GMI_BY_ORIGIN] +
                              gap->curvature * beyond->by_origin * load.whole;
        tip->arm_by_delta += slope_0 * load.whole_by[GMI_BY_DELTA] +
                             slope_1 * load.by_t1_by[GMI_BY_DELTA] +
                             gap->curvature * beyond->by_delta * load.whole;
        tip->arm_by_speed +=
            v->mesh->law.damping * (slope_0 * sum->contact + slope_1 * sum->contact_t1);
    }
}

/* What a part has at a place and speed of the side's friction: the normal force with its moments. */
static gmi_part_force force_with_moments(const gmi_corner_view *v, const gmi_corner_line *whole,
                                         const part_force *load, const gmi_line_sum *sum) {
    const gm_pair *pair = v->mesh->pair;
    const int side = v->side;
    const double damping = v->mesh->law.damping, advance = v->lines.advance;
    const double origin = whole->origin;

    /* rho_p = origin + advance t1: the moment grows by the force as the origin moves. */
    double moment_by[2] = {load->whole, 0.0}, touching_by[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
    for (int k = GMI_BY_ORIGIN; k <= GMI_BY_DELTA && v->wanted & GMI_DERIVATIVES; ++k) {
        moment_by[k] += origin * load->whole_by[k] + advance * load->by_t1_by[k];
        touching_by[0][k] = v->tangent->contact_by[k][0];
        touching_by[1][k] = v->tangent->contact_by[k][1];
    }

    /* By angles and speeds. */
    const gmi_part_force result = {
        .force = gmi_varying_of(pair, side, load->whole, load->whole_by[GMI_BY_ORIGIN],
                                load->whole_by[GMI_BY_DELTA], damping * sum->contact),
        .moment = gmi_varying_of(pair, side, origin * load->whole + advance * load->by_t1,
                                 moment_by[GMI_BY_ORIGIN], moment_by[GMI_BY_DELTA],
                                 damping * (origin * sum->contact + advance * sum->contact_t1)),
        .contact = gmi_varying_of(pair, side, sum->contact, touching_by[0][GMI_BY_ORIGIN],
                                  touching_by[0][GMI_BY_DELTA], 0.0),
        .force_t1 = gmi_varying_of(pair, side, load->by_t1, load->by_t1_by[GMI_BY_ORIGIN],
                                   load->by_t1_by[GMI_BY_DELTA], damping * sum->contact_t1),
        .contact_t1 = gmi_varying_of(pair, side, sum->contact_t1, touching_by[1][GMI_BY_ORIGIN],
                                     touching_by[1][GMI_BY_DELTA], 0.0)};
    return result;
}

/* The middle of the load of a part beyond a tip: its roll, and the mean square of how far the load is from it. */
typedef struct tip_middle {
    gmi_varying roll, square;
    double per_t1; /* of the roll (m) */
} tip_middle;

/* The load is even or straight over what touches, C: so far as friction knows, its mean square is C^2/12 - apart^2. */
static tip_middle middle_of(const gmi_corner_view *v, const gmi_beyond *beyond,
                            const gmi_part_force *part) {
    const double t1 = part->force_t1.value / part->force.value;
    const double contact = part->contact.value, touching = part->contact_t1.value / contact;
    const double apart = touching - t1, per_t1 = beyond->per_t1;
    tip_middle middle = {
        .roll = gmi_varying_of(v->mesh->pair, v->side, gmi_corner_roll_at(beyond, t1),
                               beyond->by_origin, beyond->by_delta, 0.0),
        .square = {.value = per_t1 * per_t1 * (contact * contact / 12.0 - apart * apart)},
        .per_t1 = per_t1};

    /* Both by what a solver knows, as load and touching length move. */
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        const double contact_by = part->contact.by[k];
        const double t1_by = (part->force_t1.by[k] - t1 * part->force.by[k]) / part->force.value;
        const double apart_by = (part->contact_t1.by[k] - touching * contact_by) / contact - t1_by;
        middle.roll.by[k] += per_t1 * t1_by;
        middle.square.by[k] =
            per_t1 * per_t1 * (contact * contact_by / 6.0 - 2.0 * apart * apart_by);
    }
    return middle;
}

/* Over the load: the mean of what changes with the roll, and how it changes along the part. */
static void follow(const gmi_bend *bend, const tip_middle *middle, gmi_varying *mean,
                   gmi_varying *by_t1) {
    mean->value = bend->value + 0.5 * bend->by_roll_twice * middle->square.value;
    by_t1->value = middle->per_t1 * bend->by_roll;
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        mean->by[k] =
            bend->by_roll * middle->roll.by[k] + 0.5 * bend->by_roll_twice * middle->square.by[k];
        by_t1->by[k] = middle->per_t1 * bend->by_roll_twice * middle->roll.by[k];
    }
}

/* Where the load of a part is off the line of action. */
static void find_tip_place(const gmi_corner_view *v, const gmi_beyond *beyond, int role,
                           const gmi_corner_parabola *gap, const gmi_part_force *part,
                           gmi_tip_place *place) {
    const gmi_engagement *at = &v->mesh->engagement;
    const double base[2] = {v->mesh->pair->pinion.base_radius, at->wheel_base_radius};
    const double base_sum = base[GM_PINION] + base[GM_WHEEL];
    const double length = at->line_of_action;
    const tip_middle middle = middle_of(v, beyond, part);
    const double roll = middle.roll.value;

    /* The turn by the slope of the gap, T sin(Delta) = r_g gap' - (r_bp + r_bw) (1 - cos(Delta)), and the arms by both. */
    gmi_corner_joint halfway;
    const gmi_corner_joint *a = &gap->begins, *m = &halfway, *b = &gap->ends;
    gmi_corner_joint_at(&v->mesh->corners[role], gmi_corner_middle(gap), &halfway);
    const gmi_bend slope = gmi_corner_bend(gap, roll, a->slope, m->slope, b->slope, gap->curvature);
    const gmi_bend versine =
        gmi_corner_bend(gap, roll, a->versine, m->versine, b->versine, a->versine_by_roll);
    const gmi_bend gain = gmi_corner_bend(gap, roll, a->gain, m->gain, b->gain, a->gain_by_roll);
    const gmi_bend sine = gmi_bend_sum(&slope, base[role] / length, &versine, -base_sum / length);
    const gmi_bend longer = gmi_bend_sum(&sine, base_sum, &versine, -length);
    const gmi_bend other = gmi_bend_sum(&longer, 1.0, &gain, -1.0);
    follow(role == GM_PINION ? &other : &gain, &middle, &place->lead, &place->lead_t1);
    follow(&longer, &middle, &place->longer, &place->longer_t1);
    follow(&versine, &middle, &place->versine, &place->versine_t1);
    follow(&sine, &middle, &place->sine, &place->sine_t1);
}

/* Friction of a part, on the line of action or at a tip. */
static OWN_STACK void add_friction(gmi_corner_view *v, const gmi_corner_line *whole,
                                   const gmi_line_sum *sum, const int is_beyond[2], double middle) {
    gmi_corner_sums *sums = v->sums;
    const part_force load = force_of(v, sum);
    const gmi_part_force part = force_with_moments(v, whole, &load, sum);
    if (!(load.whole > 0.0 && (is_beyond[GM_PINION] || is_beyond[GM_WHEEL]))) {
        gmi_friction_add(v->sliding, v->lines.advance, &part, &sums->friction);
        return;
    }
    const int role = is_beyond[GM_PINION] ? GM_PINION : GM_WHEEL;
    const gmi_beyond *beyond = &whole->beyond[role];
    gmi_tip_place place;
    find_tip_place(v, beyond, role, gap_at(v, beyond, role, middle), &part, &place);
    gmi_friction_add_tip(v->sliding, v->lines.advance, &part, &place, &sums->friction,
                         &sums->tip_friction);
}

/* The end of a part that moves, and takes the overlap and the touching part along. */
static void add_end(gmi_line_tangent *tangent, double sign, double t1, double f,
                    const double end_by[2]) {
    if (!(f > 0.0)) {
        return;
    }
    for (int k = GMI_BY_ORIGIN; k <= GMI_BY_DELTA; ++k) {
        const double moved = sign * end_by[k];
        tangent->sum_by[k][0] += f * moved;
        tangent->sum_by[k][1] += f * moved * t1;
        tangent->contact_by[k][0] += moved;
        tangent->contact_by[k][1] += moved * t1;
    }
}

/* What a part adds to the side and to the tips that it is beyond of. */
static OWN_STACK void add_sums(gmi_corner_view *v, const gmi_corner_line *whole,
                               const gmi_line_sum *sum, const int is_beyond[2], double middle) {
    gmi_side_sum *side = &v->sums->side;
    const double advance = v->lines.advance;
    side->sum += sum->sum;
    if (v->wanted & GMI_SQUARES) {
        return; /* nothing else is known then */
    }
    side->contact += sum->contact;
    side->sum_t1 += sum->sum_t1;
    side->sum_rho += whole->origin * sum->sum + advance * sum->sum_t1;
    side->contact_t1 += sum->contact_t1;
    side->contact_rho += whole->origin * sum->contact + advance * sum->contact_t1;

    if (v->wanted & GMI_DERIVATIVES) {
        const gmi_line_tangent *tangent = v->tangent;
        side->by_origin += tangent->sum_by[GMI_BY_ORIGIN][0];
        side->by_delta += tangent->sum_by[GMI_BY_DELTA][0];
        side->contact_by_origin += tangent->contact_by[GMI_BY_ORIGIN][0];
        side->contact_by_delta += tangent->contact_by[GMI_BY_DELTA][0];
    }
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        if (is_beyond[role]) {
            const gmi_beyond *beyond = &whole->beyond[role];
            add_tip_load(v, beyond, gap_at(v, beyond, role, middle), sum, &v->sums->tips[role]);
        }
    }
}

/*
 * How the ends of a part move: those of the faces under tilted axes, and where a corner presses as it goes off the mate's
 * flank. Other cuts stay with the flank while the line moves:
 * what one part loses there the next one gains, so that only friction, another one on each part, is to know.
 */
static void add_ends(gmi_corner_view *v, const gmi_corner_line *whole, const gmi_corner_cut *from,
                     const gmi_corner_cut *to, const gmi_line_sum *sum) {
    const int is_tilted = v->mesh->engagement.is_tilted, slides = v->sliding != NULL;
    const int begins = from->what == GMI_CUT_FACE, ends = to->what == GMI_CUT_FACE;
    if (begins ? is_tilted : slides || gmi_corner_is_stop(from)) {
        add_end(v->tangent, -1.0, from->t1, sum->at_from, begins ? whole->from_by : from->by);
    }
    if (ends ? is_tilted : slides || gmi_corner_is_stop(to)) {
        add_end(v->tangent, 1.0, to->t1, sum->at_to, ends ? whole->to_by : to->by);
    }
}

/* What a part adds to the tangent of the side. */
static OWN_STACK void add_followed(gmi_corner_view *v, const gmi_corner_line *whole,
                                   const gmi_corner_cut *from, const gmi_corner_cut *to,
                                   const gmi_line_sum *sum, const int is_beyond[2], double middle,
                                   int follows) {
    if (sum->at_from > 0.0) {
        gmi_corner_follow_end(v, whole, 1, from, sum->at_from);
    }
    if (sum->at_to > 0.0) {
        gmi_corner_follow_end(v, whole, 0, to, sum->at_to);
    }

    if (follows == FOLLOW_FRICTION) {
        const int is_tip = is_beyond[GM_PINION] || is_beyond[GM_WHEEL];
        const int role = is_beyond[GM_PINION] ? GM_PINION : GM_WHEEL;
        const gmi_corner_parabola *gap =
            is_tip ? gap_at(v, &whole->beyond[role], role, middle) : NULL;
        gmi_corner_follow_friction(v, whole, role, gap, from, to, sum);
        return;
    }
    gmi_corner_follow_forces(v, whole, sum);
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        if (is_beyond[role]) {
            const gmi_corner_parabola *gap = gap_at(v, &whole->beyond[role], role, middle);
            gmi_corner_follow_tip(v, whole, role, gap, from, to, sum);
        }
    }
}

/* One part between two cuts; whether it touches. follows: a constant at each call. */
SPECIALIZED int add_part(gmi_corner_view *v, const gmi_corner_line *whole,
                         const gmi_corner_cut *from, const gmi_corner_cut *to, int follows) {
    const gm_mesh *mesh = v->mesh;
    const double middle = 0.5 * (from->t1 + to->t1);
    gmi_line part = gmi_line_between(&whole->line, from->t1, to->t1);
    int held[2], is_beyond[2];
    hold_flanks(v, middle, &part, held);
    int mask = v->sliding != NULL ? GMI_MOMENTS : v->wanted & (GMI_MOMENTS | GMI_SQUARES);
    if (follows || v->wanted & GMI_DERIVATIVES) {
        mask = GMI_TANGENT | GMI_MOMENTS;
        begin_tangent(v, whole, held);
        part.tangent = v->tangent;
    }

    /* The gap of each tip that the part is beyond of. */
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const gmi_beyond *beyond = &whole->beyond[role];
        const double roll = gmi_corner_roll_at(beyond, middle);
        is_beyond[role] = roll > 0.0;
        if (is_beyond[role]) {
            mask |= GMI_MOMENTS;
            take_gap_off(v, whole, role, gap_at(v, beyond, role, middle), &part);
        }
    }

    gmi_line_sum sum;
    gmi_flanks_integrate(
        &mesh->side[v->side], held[GM_PINION] ? &v->held[GM_PINION] : v->running[GM_PINION],
        held[GM_WHEEL] ? &v->held[GM_WHEEL] : v->running[GM_WHEEL], &part, mask, &sum);
    if (follows) {
        add_followed(v, whole, from, to, &sum, is_beyond, middle, follows);
        return sum.contact > 0.0;
    }
    if (v->wanted & GMI_DERIVATIVES) {
        add_ends(v, whole, from, to, &sum);
    }
    add_sums(v, whole, &sum, is_beyond, middle);
    if (v->sliding != NULL) {
        add_friction(v, whole, &sum, is_beyond, middle);
    }
    return sum.contact > 0.0;
}

/* ---------------------------------------------------------------------------------------------
 * All lines of a side
 * ------------------------------------------------------------------------------------------- */

/* A line ends where the corner of a gear no longer touches. */
static void end_at_stop(const gmi_beyond *beyond, double stop, int role, gmi_corner_cut *from,
                        gmi_corner_cut *to) {
    if (beyond->per_t1 == 0.0) {
        to->t1 = beyond->at_zero <= stop ? to->t1 : from->t1;
        return;
    }
    const gmi_corner_cut end = {
        (stop - beyond->at_zero) / beyond->per_t1,
        {-beyond->by_origin / beyond->per_t1, -beyond->by_delta / beyond->per_t1},
        GMI_CUT_STOP + role};
    if (beyond->per_t1 > 0.0) {
        *to = end.t1 < to->t1 ? end : *to;
    } else {
        *from = end.t1 > from->t1 ? end : *from;
    }
}

/* Between tilted axes the overlap is a parabola along the line, and faces end elsewhere. */
static OWN_STACK void tilt_line(const gmi_corner_view *v, gmi_corner_line *whole) {
    const gm_pair *pair = v->mesh->pair;
    const gmi_engagement *at = &v->mesh->engagement;
    gmi_tilt_cuts cuts;
    gmi_line_part part;
    gmi_tilted_line tilted;
    gmi_tilt_cuts_find(pair, at, v->side, v->lines.delta, GMI_FACES_ALONE, &cuts);
    (void)gmi_tilt_cut_line(&cuts, whole->origin, &part);
    gmi_tilt_move_ends(pair, at, v->side, whole->origin, v->lines.delta, &part);
    gmi_tilt_line(pair, at, v->side, whole->origin, &tilted);

    /* How overlap and ends move. */
    whole->gain = tilted.gain;
    for (int k = 0; k < 2; ++k) {
        whole->by_origin[k] = tilted.by_origin[k];
        whole->from_by[k] = part.from_by[k];
        whole->to_by[k] = part.to_by[k];
    }

    /* The parabola as seen from the line's beginning. */
    gmi_line *line = &whole->line;
    const double *shift = tilted.shift;
    line->from = part.from;
    line->to = part.to;
    line->overlap += (tilted.gain - 1.0) * v->lines.delta + shift[0] +
                     line->from * (shift[1] + line->from * shift[2]);
    line->half_slope = 0.5 * shift[1] + line->from * shift[2];
    line->curvature = shift[2];
}

/* Adds what line k has of flanks and of edges, between the cuts at which one takes over from the other. */
SPECIALIZED void add_line(gmi_corner_view *v, const gmi_flank *pinion, const gmi_flank *wheel,
                          int k, int follows) {
    const gm_mesh *mesh = v->mesh;
    const gm_pair *pair = mesh->pair;
    const gmi_engagement *at = &mesh->engagement;

    /* The line as if both flanks went on beyond their tips. */
    gmi_corner_line whole;
    whole.origin = v->lines.origin + (double)k * pair->transverse_base_pitch;
    const double delta = v->lines.delta;
    whole.line = (gmi_line){
        at->face_from,
        at->face_to,
        delta + pinion->pitch + wheel->pitch,
        0.0,
        0.0,
        pinion->values,
        wheel->values,
        (whole.origin - pair->pinion.start_roll_length) * v->running[GM_PINION]->per_rho,
        (at->line_of_action + delta - at->wheel_profile_start - whole.origin) *
            v->running[GM_WHEEL]->per_rho,
        NULL,
    };

    /* All of the faces, as far as corners reach. */
    if (at->is_tilted) {
        tilt_line(v, &whole);
    }
    gmi_corner_cut from = {whole.line.from, {0.0, 0.0}, GMI_CUT_FACE},
                   last = {whole.line.to, {0.0, 0.0}, GMI_CUT_FACE};
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        gmi_tilt_beyond(pair, at, v->side, whole.origin, delta, role, &whole.beyond[role]);
        end_at_stop(&whole.beyond[role], v->stop[role], role, &from, &last);
    }

    /* From cut to cut. */
    int touches = 0;
    gmi_corner_cut to;
    for (; from.t1 < last.t1; from = to) {
        to = next_cut(v, &whole, from.t1, &last);
        touches |= add_part(v, &whole, &from, &to, follows);
    }
    if (v->sums != NULL) {
        v->sums->side.pairs += touches;
    }
}

/* What of the coefficient is the same all over the side. */
static OWN_STACK void finish_friction(const gmi_corner_view *v) {
    enum { MASK = GMI_DERIVATIVES | GMI_CONTACT_DERIVATIVES };
    gmi_side_force force;
    gmi_law_force(&v->mesh->law, &v->sums->side, v->approach_speed,
                  v->wanted & GMI_DERIVATIVES ? MASK : GMI_SUM, &force);
    const gmi_varying all = gmi_varying_of(v->mesh->pair, v->side, force.force, force.by_origin,
                                           force.by_delta, force.by_speed);
    gmi_friction_finish(v->sliding, &all, &v->sums->friction, &v->sums->tip_friction);
}

/* All lines of a side that is not clear; v: with what is wanted of them. follows: a constant, v has what they are followed for. */
SPECIALIZED void follow_lines(const gm_mesh *mesh, int side, const gm_position *position,
                              double approach_speed, int follows, gmi_corner_view *v) {
    const gm_pair *pair = mesh->pair;
    const gmi_engagement *at = &mesh->engagement;
    const gmi_side *prepared = &mesh->side[side];
    v->mesh = mesh;
    v->side = side;
    v->last_role = -1;
    v->approach_speed = approach_speed;
    v->viscous = mesh->law.damping * approach_speed;

    /* The tables as lines run through them, and as they are held beyond their ends. */
    const int has_tables = prepared->pinion != NULL || prepared->wheel != NULL;
    v->running[GM_PINION] = has_tables ? &prepared->pinion_grid : &no_grid;
    v->running[GM_WHEEL] = has_tables ? &prepared->wheel_grid : &no_grid;
    const double overlap = gmi_ideal_penetration(at, side, position->offset) + prepared->peak;
    const double by_roll = at->is_tilted ? gmi_tilt_bound_by_roll(pair, at, side) : 0.0;
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        v->held[role] = *v->running[role];
        gmi_grid_hold(&v->held[role]);
        v->stop[role] = stop_of(&mesh->corners[role], overlap, by_roll);
    }

    /* Starts of profiles end no line; tilted axes may bring one in that is just outside. */
    gmi_lines_find(pair, at, side, position, &v->lines);
    const double lower = at->line_of_action + v->lines.delta - at->tip_roll_length[GM_WHEEL];
    gmi_lines_widen(pair, lower - v->stop[GM_WHEEL],
                    at->tip_roll_length[GM_PINION] + v->stop[GM_PINION], &v->lines);
    v->lines.first -= at->is_tilted;
    v->lines.last += at->is_tilted;

    /* Line by line, each with the teeth that meet on it; those that cannot reach each other are left out. */
    gmi_teeth teeth = gmi_lines_teeth(pair, side, position, &v->lines);
    for (int k = v->lines.first; k <= v->lines.last; ++k) {
        const gmi_flank pinion = gmi_flank_of(prepared->pinion, teeth.pinion);
        const gmi_flank wheel = gmi_flank_of(prepared->wheel, teeth.wheel);
        if (v->lines.delta + pinion.peak + wheel.peak + prepared->tilt_bound > 0.0) {
            add_line(v, &pinion, &wheel, k, follows);
        }
        teeth.pinion = gmi_next_tooth(teeth.pinion, teeth.step, pair->pinion.teeth);
        teeth.wheel = gmi_next_tooth(teeth.wheel, teeth.step, pair->wheel.teeth);
    }
}

void gmi_side_sum_corners(const gm_mesh *mesh, int side, const gm_position *position, int wanted,
                          double approach_speed, const gmi_sliding *sliding,
                          gmi_corner_sums *sums) {
    memset(sums, 0, sizeof *sums);
    if (gmi_side_is_clear(&mesh->engagement, &mesh->side[side], side, position->offset)) {
        return;
    }
    gmi_corner_view v;
    gmi_line_tangent tangent;
    v.wanted = wanted;
    v.sums = sums;
    v.rates = NULL;
    v.tangent = &tangent;
    v.sliding = sliding;
    follow_lines(mesh, side, position, approach_speed, FOLLOW_SUMS, &v);
    if (sliding != NULL) {
        finish_friction(&v);
    }
}

void gmi_side_sum_corner_tangent(const gm_mesh *mesh, int side, const gm_position *position,
                                 gmi_corner_tangent *tangent) {
    gmi_corner_view v;
    v.wanted = GMI_DERIVATIVES | GMI_MOMENTS;
    v.sums = NULL;
    v.rates = &tangent->rates;
    v.followed = tangent;
    v.tangent = &tangent->line;
    v.sliding = NULL;
    follow_lines(mesh, side, position, tangent->rates.delta, FOLLOW_FORCES, &v);
}

void gmi_side_sum_corner_rubbing(const gm_mesh *mesh, int side, const gm_position *position,
                                 const gmi_sliding *sliding, gmi_corner_rubbing *rubbing) {
    gmi_corner_view v;
    v.wanted = GMI_DERIVATIVES | GMI_MOMENTS;
    v.sums = NULL;
    v.rates = &rubbing->rates;
    v.rubbing = rubbing;
    v.tangent = &rubbing->line;
    v.sliding = sliding;
    follow_lines(mesh, side, position, rubbing->rates.delta, FOLLOW_FRICTION, &v);
    gmi_corner_finish_friction(&v);
}
