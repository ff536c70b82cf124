/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The penetration models: simple [Paper, Eqs. 9-11] and 3D [Paper, Eqs. 12-25].
 *
 * 3D: the sum over all lines of the integral of max(0, delta + deviations) over t1. Between ideal flanks that is delta
 * times the clipped length; with tables line.c integrates along each line, ramp.c where there are linear reliefs. No
 * slices, no quadrature error.
 */
#include "penetration.h"

#include "contact.h"
#include "flank.h"
#include "friction.h"
#include "internal.h"
#include "law.h"
#include "line.h"
#include "mesh.h"
#include "meshing.h"
#include "position.h"
#include "side_tangent.h"
#include "tilt.h"

#include <math.h>
#include <string.h>

/* ---------------------------------------------------------------------------------------------
 * One side, prepared
 * ------------------------------------------------------------------------------------------- */

/* From start to tip (m). */
static double flank_length(const gm_gear *gear) {
    return gear->sign * (gear->tip_roll_length - gear->start_roll_length);
}

static int ramp_count(const gmi_tables *tables) {
    return tables == NULL ? 0 : tables->ramp_count;
}

void gmi_side_init(gmi_side *prepared, const gm_pair *pair, const gmi_engagement *at,
                   const gm_flanks *pinion_flanks, const gm_flanks *wheel_flanks, int side) {
    prepared->pinion = gmi_flanks_side(pinion_flanks, side);
    prepared->wheel = gmi_flanks_side(wheel_flanks, side);
    prepared->ramps = ramp_count(prepared->pinion) + ramp_count(prepared->wheel);
    prepared->flank_peak = 0.0;

    /* On the wheel the same line runs the other way: rho_w falls as rho_p grows. */
    if (prepared->pinion != NULL || prepared->wheel != NULL || at->is_tilted) {
        const double advance = gmi_side_sign(side) * pair->face_advance;
        gmi_grid_init(&prepared->pinion_grid, prepared->pinion, advance,
                      flank_length(&pair->pinion), at->face_origin[GM_PINION],
                      at->face_scale[GM_PINION]);
        gmi_grid_init(&prepared->wheel_grid, prepared->wheel, -advance, flank_length(&pair->wheel),
                      at->face_origin[GM_WHEEL], at->face_scale[GM_WHEEL]);
        prepared->flank_peak =
            gm_flanks_peak(pinion_flanks, side) + gm_flanks_peak(wheel_flanks, side);
    }
    gmi_side_move(prepared, pair, at, side);
}

void gmi_side_move(gmi_side *prepared, const gm_pair *pair, const gmi_engagement *at, int side) {
    prepared->is_tilted = at->is_tilted;
    prepared->starts_deeper = prepared->leaves_tables = 0;
    prepared->tilt_bound = prepared->tilt_reach = 0.0;
    if (at->is_tilted) {
        prepared->tilt_bound = gmi_tilt_bound(pair, at, side, &prepared->tilt_reach);
    }
    prepared->peak = prepared->tilt_bound + prepared->flank_peak;
    if (prepared->pinion == NULL && prepared->wheel == NULL) {
        return;
    }

    /*
     * A start that follows the mate's tip may have left a table behind. Between tilted axes a line of spur gears may be
     * beyond a table as a whole, which is read where parallel axes would have the flanks touch.
     */
    const gmi_grid *pinion = &prepared->pinion_grid;
    gmi_grid *wheel = &prepared->wheel_grid;
    prepared->starts_deeper = (pinion->face_rate > 0.0 && at->starts_deeper[GM_PINION]) ||
                              (wheel->face_rate > 0.0 && at->starts_deeper[GM_WHEEL]);
    prepared->leaves_tables =
        prepared->starts_deeper || (at->is_tilted && pair->face_advance == 0.0);

    /* The wheel's face lines may no longer be those of the pinion. */
    gmi_grid_move(wheel, at->face_origin[GM_WHEEL]);
    wheel->shares_faces = wheel->last_face == pinion->last_face &&
                          wheel->face_base == pinion->face_base &&
                          wheel->face_rate == pinion->face_rate;
}

/* ---------------------------------------------------------------------------------------------
 * The sum over the lines of a side
 * ------------------------------------------------------------------------------------------- */

/* One side at one position: everything its lines have in common. */
typedef struct side_view {
    const gm_pair *pair;
    const gmi_engagement *at;
    int side;
    const gmi_side *prepared;
    gmi_lines lines;
    gmi_line_ends ends;

    /* Where the axes are tilted, or for a tangent: */
    gmi_tilt_cuts cuts;
    gmi_tilt tilt;
    gmi_line_part tilted_part; /* of the line at hand */

    double wheel_reach;        /* rho_w - start of the wheel's flank = wheel_reach - rho_p (m) */
    gmi_side_tangent *tangent; /* GMI_TANGENT */
    const gmi_law *law;        /* likewise, and where flanks slide */

    /* Where flanks slide: */
    const gmi_sliding *sliding;
    double approach_speed; /* of the flanks, without GMI_TANGENT (m/s) */
    gmi_rubbing *rubbing;
    gmi_rubbing_by *rubbing_by; /* GMI_TANGENT */
} side_view;

/*
 * The ends of a line that a limit of the flanks sets move with the line's origin and with delta:
 *     t1_end = (limit - rho_origin) / advance,
 * and each takes f there into the sum or out of it (Leibniz).
 */
static inline void add_end_derivatives(const gmi_line_ends *ends, gmi_interval part, double f_from,
                                       double f_to, gmi_side_sum *side) {
    if (part.from > ends->face_from && f_from > 0.0) {
        const double flow = f_from * ends->per_advance;
        side->by_origin += flow;
        side->by_delta -= flow * ends->enter_by_delta;
    }
    if (part.to < ends->face_to && f_to > 0.0) {
        const double flow = f_to * ends->per_advance;
        side->by_origin -= flow;
        side->by_delta += flow * ends->leave_by_delta;
    }
}

/* Inside the line f follows the line's origin and delta through both points looked up. */
static inline void add_derivatives(const side_view *view, gmi_interval part,
                                   const gmi_line_sum *line, gmi_side_sum *side) {
    const double by_pinion = line->pinion * view->prepared->pinion_grid.per_rho;
    const double by_wheel = line->wheel * view->prepared->wheel_grid.per_rho;
    side->by_origin += by_pinion - by_wheel;
    side->by_delta += line->contact + by_wheel;
    add_end_derivatives(&view->ends, part, line->at_from, line->at_to, side);
}

/* The touching part ends where f is zero, and f there moves that end; and where the line ends with f above zero. */
static void add_contact_derivatives(const side_view *view, gmi_interval part,
                                    const gmi_line_sum *line, gmi_side_sum *side) {
    const double by_pinion = line->roots_pinion * view->prepared->pinion_grid.per_rho;
    const double by_wheel = line->roots_wheel * view->prepared->wheel_grid.per_rho;
    side->contact_by_origin += by_pinion - by_wheel;
    side->contact_by_delta += line->roots + by_wheel;

    const gmi_line_ends *ends = &view->ends;
    if (part.from > ends->face_from && line->at_from > 0.0) {
        side->contact_by_origin += ends->per_advance;
        side->contact_by_delta -= ends->per_advance * ends->enter_by_delta;
    }
    if (part.to < ends->face_to && line->at_to > 0.0) {
        side->contact_by_origin -= ends->per_advance;
        side->contact_by_delta += ends->per_advance * ends->leave_by_delta;
    }
}

/* Between tilted axes f follows delta by the gain, and the line's origin also by where the point is; and the ends move. */
static void add_tilt_derivatives(const gmi_tilted_line *tilted, const gmi_line_part *part,
                                 const gmi_line_sum *line, gmi_side_sum *side) {
    const double f_from = fmax(0.0, line->at_from);
    const double f_to = fmax(0.0, line->at_to);
    side->by_delta += (tilted->gain - 1.0) * line->contact + f_to * part->to_by[GMI_BY_DELTA] -
                      f_from * part->from_by[GMI_BY_DELTA];
    side->by_origin += tilted->by_origin[0] * line->contact +
                       tilted->by_origin[1] * line->contact_t1 + f_to * part->to_by[GMI_BY_ORIGIN] -
                       f_from * part->from_by[GMI_BY_ORIGIN];
}

/* The touching part, likewise; at its roots the change by the origin is taken as it is in the middle of the line. */
static void add_tilt_contact_derivatives(const gmi_tilted_line *tilted, const gmi_line_part *part,
                                         const gmi_line_sum *line, gmi_side_sum *side) {
    const double middle = 0.5 * (part->from + part->to);
    side->contact_by_delta += (tilted->gain - 1.0) * line->roots;
    side->contact_by_origin += (tilted->by_origin[0] + tilted->by_origin[1] * middle) * line->roots;
    if (line->at_from > 0.0) {
        side->contact_by_delta -= part->from_by[GMI_BY_DELTA];
        side->contact_by_origin -= part->from_by[GMI_BY_ORIGIN];
    }
    if (line->at_to > 0.0) {
        side->contact_by_delta += part->to_by[GMI_BY_DELTA];
        side->contact_by_origin += part->to_by[GMI_BY_ORIGIN];
    }
}

static inline void add_moments(const gmi_lines *lines, double rho_origin, const gmi_line_sum *line,
                               gmi_side_sum *side) {
    side->sum_t1 += line->sum_t1;
    side->sum_rho += rho_origin * line->sum + lines->advance * line->sum_t1;
    side->contact_t1 += line->contact_t1;
    side->contact_rho += rho_origin * line->contact + lines->advance * line->contact_t1;
}

/*
 * Where lines end between tilted axes, and what the tilt does to the overlap. Tables are read where parallel axes would have
 * the flanks touch: a line ends where that leaves one of them, unless it goes on deeper.
 */
static void find_cuts(side_view *view) {
    gmi_tilt_cuts_find(view->pair, view->at, view->side, view->lines.delta,
                       gmi_side_table_ends(view->pair, view->prepared), &view->cuts);
    if (view->prepared->is_tilted) {
        gmi_tilt_find(view->pair, view->at, view->side, &view->tilt);
    }
}

/* How the ends of the line at hand move with all coordinates of the side. */
static void move_ends(side_view *view, double rho_origin) {
    gmi_tilt_move_ends(view->pair, view->at, view->side, rho_origin, view->lines.delta,
                       &view->tilted_part);
}

/*
 * Between tilted axes the line has ends of its own, and the overlap is a parabola along it. False where none of it is on
 * both flanks.
 */
static int tilt_line(side_view *view, double rho_origin, int wanted, gmi_line *line) {
    gmi_line_part *part = &view->tilted_part;
    if (!gmi_tilt_cut_line(&view->cuts, rho_origin, part)) {
        return 0;
    }
    if ((wanted & ~(GMI_MOMENTS | GMI_TANGENT | GMI_SQUARES)) != 0) {
        move_ends(view, rho_origin);
    }

    /* The parabola as seen from the line's beginning. */
    const gmi_tilted_line tilted = gmi_tilt_of_line(&view->tilt, rho_origin);
    const double *shift = tilted.shift;
    line->from = part->from;
    line->to = part->to;
    line->overlap += (tilted.gain - 1.0) * view->lines.delta + shift[0] +
                     part->from * (shift[1] + part->from * shift[2]);
    line->half_slope = 0.5 * shift[1] + part->from * shift[2];
    line->curvature = shift[2];
    return 1;
}

/* ---------------------------------------------------------------------------------------------
 * How a side moves with all its coordinates
 * ------------------------------------------------------------------------------------------- */

/* What the tangents of all lines have in common. */
static OWN_STACK void begin_tangents(const side_view *view, gmi_tilt_motion *motion) {
    const gmi_side *prepared = view->prepared;
    gmi_line_tangent *line = &view->tangent->line;
    line->pinion_per_rho = prepared->pinion_grid.per_rho;
    line->wheel_per_rho = prepared->wheel_grid.per_rho;
    line->face_per_length = prepared->wheel_grid.face_rate / view->pair->face_width;
    gmi_tilt_motion_find(view->pair, view->at, view->side, view->lines.delta, &view->tangent->rates,
                         motion);
}

/* What is known of a line's tangent before it is followed. */
static void begin_tangent(const side_view *view, const gmi_tilt_motion *motion, double rho_origin) {
    gmi_line_tangent *line = &view->tangent->line;
    memset(line->contact, 0, sizeof line->contact);
    memset(line->sum_by, 0, sizeof line->sum_by);
    memset(line->contact_by, 0, sizeof line->contact_by);
    gmi_tilt_tangent(motion, rho_origin, line);
}

/* Of a part: with friction all else takes more stack, and what lines have in common is found anew. */
static OWN_STACK void begin_part_tangent(const side_view *view, double rho_origin) {
    gmi_tilt_motion motion;
    begin_tangents(view, &motion);
    begin_tangent(view, &motion, rho_origin);
}

/* An end at t1 that moves by one coordinate takes f there into the sum or out of it, and the touching part likewise. */
static inline void move_end(gmi_line_tangent *line, int coordinate, double moved, double t1,
                            double f) {
    double *sum = line->sum_by[coordinate], *contact = line->contact_by[coordinate];
    sum[0] += f * moved;
    sum[1] += f * moved * t1;
    contact[0] += moved;
    contact[1] += moved * t1;
    contact[2] += moved * t1 * t1;
}

static void add_end(gmi_line_tangent *line, double sign, double t1, double f,
                    const double end_by[GMI_COORDINATES]) {
    for (int k = 0; k < GMI_COORDINATES && f > 0.0; ++k) {
        move_end(line, k, sign * end_by[k], t1, f);
    }
}

/* Of a whole line: most of them do not touch at their ends, and some end at the pinion's face, which stays. */
static OWN_STACK void add_touching_end(const side_view *view, double rho_origin, int is_beginning,
                                       double f) {
    const gmi_line_part *part = &view->tilted_part;
    double end_by[GMI_COORDINATES];
    if (gmi_tilt_move_end(view->pair, view->at, view->side, rho_origin, view->lines.delta, part,
                          is_beginning, end_by)) {
        add_end(&view->tangent->line, is_beginning ? -1.0 : 1.0,
                is_beginning ? part->from : part->to, f, end_by);
    }
}

/* The third weight, rho_p = rho_origin + advance t1, from the first two. */
static inline void weigh(double row[GMI_WEIGHTS], double rho_origin, double advance) {
    row[GMI_BY_RHO] = rho_origin * row[GMI_WHOLE] + advance * row[GMI_BY_T1];
}

/*
 * What a line or a part of one adds to how the force moves with the coordinates, and to the moments of the arm of a tilt
 * across: but for what finish_load() knows of all that touches.
 */
SPECIALIZED void add_rows(const side_view *view, double rho_origin,
                          double by[GMI_COORDINATES][GMI_WEIGHTS], double arm[GMI_WEIGHTS]) {
    const gmi_line_tangent *line = &view->tangent->line;
    const double advance = view->lines.advance;
    const double k = view->law->stiffness, d = view->law->damping;
    const double speed[2] = {d * line->speed[0], d * line->speed[1]};
    for (int of = 0; of < GMI_COORDINATES; ++of) {
        const double *sum = line->sum_by[of], *contact = line->contact_by[of];
        double row[GMI_WEIGHTS];
        row[GMI_WHOLE] = k * sum[0] + (speed[0] * contact[0] + speed[1] * contact[1]);
        row[GMI_BY_T1] = k * sum[1] + (speed[0] * contact[1] + speed[1] * contact[2]);
        weigh(row, rho_origin, advance);
        for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
            by[of][weight] += row[weight];
        }
    }

    const double *c = line->contact;
    double row[GMI_WEIGHTS] = {[GMI_WHOLE] = line->arm[0] * c[0] + line->arm[1] * c[1],
                               [GMI_BY_T1] = line->arm[0] * c[1] + line->arm[1] * c[2]};
    weigh(row, rho_origin, advance);
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        arm[weight] += row[weight];
    }
}

/*
 * The force, and what moves it beside: from integrals of the overlap, of 1 and of the arm over what touches. The speed of
 * approach there is that of the rates less the tilt across times the arm. Returns its integral.
 */
static double finish_load(const side_view *view, const double sum[GMI_WEIGHTS],
                          const double contact[GMI_WEIGHTS], const double arm[GMI_WEIGHTS],
                          double force[GMI_WEIGHTS], double by[GMI_LOAD_VARIABLES][GMI_WEIGHTS]) {
    const double k = view->law->stiffness, d = view->law->damping;
    const double tau =
        gmi_side_sign(view->side) * view->pair->face_advance / view->pair->face_width;
    const gmi_rates *rates = &view->tangent->rates;
    const double across = rates->across;
    const double of_along = -tau * view->at->wheel_base_radius;
    const double speed = rates->delta + of_along * rates->along;
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        const double touching = d * contact[weight];
        const double turning = d * arm[weight];
        force[weight] = k * sum[weight] + (speed * touching - across * turning);

        /* What the speed of approach changes by where the line is. */
        by[GMI_BY_ORIGIN][weight] -= across * tau * touching;
        by[GMI_BY_LENGTH][weight] += across * tau * touching;
        by[GMI_BY_AXIAL][weight] += across * touching;

        /* By the rates. */
        by[GMI_BY_DELTA_RATE][weight] = touching;
        by[GMI_BY_ALONG_RATE][weight] = of_along * touching;
        by[GMI_BY_ACROSS_RATE][weight] = -turning;
    }

    /* The moment over rho_p moves with the origin. */
    by[GMI_BY_ORIGIN][GMI_BY_RHO] += force[GMI_WHOLE];
    return speed * contact[GMI_WHOLE] - across * arm[GMI_WHOLE];
}

/* Of the sums. */
static void add_sum_derivatives(const gmi_line_tangent *line, gmi_side_sum *total) {
    total->by_origin += line->sum_by[GMI_BY_ORIGIN][0];
    total->by_delta += line->sum_by[GMI_BY_DELTA][0];
}

/* What a line adds to the tangent of the side. */
static OWN_STACK void add_tangent(const side_view *view, double rho_origin, gmi_side_sum *total) {
    gmi_side_tangent *side = view->tangent;
    add_rows(view, rho_origin, side->by.force, side->arm);
    add_sum_derivatives(&side->line, total);
}

/* What a part of a line adds to it, and to the friction. */
static OWN_STACK void add_sliding_tangent(const side_view *view, double rho_origin,
                                          const gmi_line_sum *sum, gmi_side_sum *total) {
    gmi_side_tangent *side = view->tangent;
    const gmi_line_tangent *line = &side->line;
    double sums[GMI_WEIGHTS] = {sum->sum, sum->sum_t1};
    double contact[GMI_WEIGHTS] = {line->contact[0], line->contact[1]};
    weigh(sums, rho_origin, view->lines.advance);
    weigh(contact, rho_origin, view->lines.advance);

    /* The force of the part. */
    double arm[GMI_WEIGHTS] = {0.0, 0.0, 0.0};
    gmi_load load;
    gmi_load_by by;
    memset(&by, 0, sizeof by);
    add_rows(view, rho_origin, by.force, arm);
    side->flow += finish_load(view, sums, contact, arm, load.force, by.force);
    load.contact[0] = line->contact[0];
    load.contact[1] = line->contact[1];
    by.contact = line->contact_by;

    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        side->load.force[weight] += load.force[weight];
        for (int of = 0; of < GMI_LOAD_VARIABLES; ++of) {
            side->by.force[of][weight] += by.force[of][weight];
        }
    }
    add_sum_derivatives(line, total);
    gmi_rubbing_add(view->sliding, view->lines.advance, &load, &by, view->rubbing,
                    view->rubbing_by);
}

/* The simple model's pair touches in the pitch point, which follows the line of action, at mid-face. */
static void set_simple_tangent(const gm_pair *pair, const gmi_engagement *at, const gmi_law *law,
                               const gmi_side_sum *sum, gmi_side_tangent *tangent) {
    if (!(sum->sum > 0.0)) {
        return;
    }
    const double where[GMI_WEIGHTS] = {1.0, sum->contact_t1, sum->contact_rho};
    const double force = law->stiffness * sum->sum + law->damping * tangent->rates.delta;
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        tangent->load.force[weight] = force * where[weight];
        tangent->by.force[GMI_BY_DELTA][weight] = law->stiffness * where[weight];
        tangent->by.force[GMI_BY_DELTA_RATE][weight] = law->damping * where[weight];
    }
    tangent->flow = tangent->rates.delta;
    tangent->by.force[GMI_BY_LENGTH][GMI_BY_RHO] =
        force * pair->pinion.base_radius / (pair->pinion.base_radius + at->wheel_base_radius);
}

/* ---------------------------------------------------------------------------------------------
 * Lines with friction: in parts
 * ------------------------------------------------------------------------------------------- */

/* Hands the normal force of a part on to friction. */
static OWN_STACK void add_friction(const side_view *view, double rho_origin,
                                   const gmi_line_sum *sum) {
    const double k = view->law->stiffness, viscous = view->law->damping * view->approach_speed;
    gmi_load load = {
        {k * sum->sum + viscous * sum->contact, k * sum->sum_t1 + viscous * sum->contact_t1, 0.0},
        {sum->contact, sum->contact_t1}};
    weigh(load.force, rho_origin, view->lines.advance);
    gmi_rubbing_add(view->sliding, view->lines.advance, &load, NULL, view->rubbing, NULL);
}

/* Where a line is cut for friction next, and which place that is; -1: the end of the line. */
typedef struct friction_cut {
    double t1;
    int place;
} friction_cut;

static friction_cut next_cut(const side_view *view, double rho_origin, double from, double to) {
    friction_cut next = {to, -1};
    for (int k = 0; k < GMI_FRICTION_CUTS; ++k) {
        const double cut = (view->sliding->friction->cuts[k] - rho_origin) / view->lines.advance;
        if (cut > from && cut < next.t1) { /* not for spur gears: infinite */
            next.t1 = cut;
            next.place = k;
        }
    }
    return next;
}

/*
 * An end of a part, as it moves. A cut stays where it is while the line moves: what one part loses there the next one
 * gains. All cuts follow the line of action.
 */
static OWN_STACK void add_part_end(const side_view *view, double sign, const friction_cut *end,
                                   double f, const double end_by[GMI_COORDINATES]) {
    gmi_line_tangent *line = &view->tangent->line;
    if (end->place < 0) {
        add_end(line, sign, end->t1, f, end_by);
    } else if (f > 0.0) {
        const double per_advance = sign * view->ends.per_advance;
        const double by_length =
            gmi_friction_cut_by_length(view->pair, view->at, view->sliding->friction, end->place);
        move_end(line, GMI_BY_ORIGIN, -per_advance, end->t1, f);
        move_end(line, GMI_BY_LENGTH, per_advance * by_length, end->t1, f);
    }
}

/* A line from cut to cut. */
SPECIALIZED void add_line_in_parts(side_view *view, const gmi_line *line, double rho_origin,
                                   int wanted, gmi_side_sum *side) {
    const gmi_side *prepared = view->prepared;
    const gmi_line_part *whole = &view->tilted_part;
    int touches = 0;
    if (wanted & GMI_TANGENT) {
        if (!prepared->is_tilted) {
            (void)gmi_tilt_cut_line(&view->cuts, rho_origin, &view->tilted_part);
        }
        move_ends(view, rho_origin);
    }
    friction_cut from = {line->from, -1}, to;
    for (; from.t1 < line->to; from = to) {
        to = next_cut(view, rho_origin, from.t1, line->to);
        gmi_line part = gmi_line_between(line, from.t1, to.t1);
        if (wanted & GMI_TANGENT) {
            begin_part_tangent(view, rho_origin);
            part.tangent = &view->tangent->line;
        }
        gmi_line_sum sum;
        gmi_flanks_integrate_line(prepared, &part, wanted, &sum);

        side->sum += sum.sum;
        side->contact += sum.contact;
        add_moments(&view->lines, rho_origin, &sum, side);
        if (wanted & GMI_TANGENT) {
            add_part_end(view, 1.0, &to, sum.at_to, whole->to_by);
            add_part_end(view, -1.0, &from, sum.at_from, whole->from_by);
            add_sliding_tangent(view, rho_origin, &sum, side);
        } else {
            add_friction(view, rho_origin, &sum);
        }
        touches = touches || sum.contact > 0.0;
    }
    side->pairs += touches;
}

/* ---------------------------------------------------------------------------------------------
 * All lines of a side
 * ------------------------------------------------------------------------------------------- */

SPECIALIZED gmi_line line_between(const gm_pair *pair, const gmi_side *prepared, double delta,
                                  double wheel_reach, const gmi_flank *pinion,
                                  const gmi_flank *wheel, double rho_origin, gmi_interval part) {
    const gmi_line line = {
        part.from,
        part.to,
        delta + pinion->pitch + wheel->pitch,
        0.0,
        0.0,
        pinion->values,
        wheel->values,
        (rho_origin - pair->pinion.start_roll_length) * prepared->pinion_grid.per_rho,
        (wheel_reach - rho_origin) * prepared->wheel_grid.per_rho,
        NULL,
    };
    return line;
}

/* motion: of a tangent without friction. */
SPECIALIZED void add_line(side_view *view, const gmi_tilt_motion *motion, const gmi_flank *pinion,
                          const gmi_flank *wheel, int k, int wanted, int is_tilted, int slides,
                          gmi_side_sum *side) {
    const gmi_interval part = gmi_line_clip(&view->ends, k);
    const gmi_side *prepared = view->prepared;
    if (!(part.from < part.to) && !is_tilted) {
        return;
    }

    /* The line in the terms of the tables it runs through. */
    const gm_pair *pair = view->pair;
    const double rho_origin = view->lines.origin + (double)k * pair->transverse_base_pitch;
    gmi_line line = line_between(pair, prepared, view->lines.delta, view->wheel_reach, pinion,
                                 wheel, rho_origin, part);
    if (is_tilted && !tilt_line(view, rho_origin, wanted, &line)) {
        return;
    }

    if (slides) {
        add_line_in_parts(view, &line, rho_origin, wanted, side);
        return;
    }

    if (wanted & GMI_TANGENT) {
        begin_tangent(view, motion, rho_origin);
        line.tangent = &view->tangent->line;
    }

    gmi_line_sum sum;
    gmi_flanks_integrate_line(prepared, &line, wanted, &sum);

    /* What it adds to the side. */
    side->sum += sum.sum;
    side->contact += sum.contact;
    side->pairs += sum.contact > 0.0;
    if (wanted & GMI_DERIVATIVES) {
        add_derivatives(view, part, &sum, side);
    }
    if (wanted & GMI_CONTACT_DERIVATIVES) {
        add_contact_derivatives(view, part, &sum, side);
    }
    if (wanted & GMI_MOMENTS) {
        add_moments(&view->lines, rho_origin, &sum, side);
    }

    /* And what is different between tilted axes. */
    if (is_tilted && wanted & GMI_DERIVATIVES) {
        const gmi_tilted_line tilted = gmi_tilt_of_line(&view->tilt, rho_origin);
        add_tilt_derivatives(&tilted, &view->tilted_part, &sum, side);
    }
    if (is_tilted && wanted & GMI_CONTACT_DERIVATIVES) {
        const gmi_tilted_line tilted = gmi_tilt_of_line(&view->tilt, rho_origin);
        add_tilt_contact_derivatives(&tilted, &view->tilted_part, &sum, side);
    }
    if (wanted & GMI_TANGENT) {
        if (!is_tilted) {
            (void)gmi_tilt_cut_line(&view->cuts, rho_origin, &view->tilted_part);
        }
        if (sum.at_from > 0.0) {
            add_touching_end(view, rho_origin, 1, sum.at_from);
        }
        if (sum.at_to > 0.0) {
            add_touching_end(view, rho_origin, 0, sum.at_to);
        }
        add_tangent(view, rho_origin, side);
    }
}

/* is_tilted: the axes are; slides: with friction; a constant at each call. view: with what is said of it there. */
SPECIALIZED void follow_lines(const gm_pair *pair, const gmi_engagement *at,
                              const gmi_side *prepared, int side, const gm_position *position,
                              int wanted, int is_tilted, int slides, side_view *view,
                              gmi_side_sum *total) {
    view->pair = pair;
    view->at = at;
    view->side = side;
    view->prepared = prepared;
    gmi_find_lines(pair, at, side, position, &view->lines);
    view->ends = gmi_line_ends_find(pair, at, &view->lines);
    if (is_tilted) {
        /* That may bring a line in that is just outside, and its ends are not those of parallel axes. */
        const gmi_lines *lines = &view->lines;
        const double pitch = pair->transverse_base_pitch;
        const double before = lines->origin + (double)(lines->first - 1) * pitch + lines->rise;
        const double behind = lines->origin + (double)(lines->last + 1) * pitch + lines->fall;
        const double reach = prepared->tilt_reach + gmi_larger(-lines->delta, 0.0);
        view->lines.first -= before > lines->lower - reach;
        view->lines.last += behind < lines->upper + reach;
        view->ends.face_from = HUGE_VAL;
        view->ends.face_to = -HUGE_VAL;
    }
    if (is_tilted || wanted & GMI_TANGENT) {
        find_cuts(view);
    }
    gmi_tilt_motion motion;
    if (wanted & GMI_TANGENT && !slides) {
        begin_tangents(view, &motion);
    }
    view->wheel_reach = at->line_of_action + view->lines.delta - at->wheel_profile_start;

    /* Line by line, each with the teeth that meet on it; those that cannot reach each other are left out. */
    gmi_teeth teeth = gmi_lines_teeth(pair, side, position, &view->lines);
    for (int k = view->lines.first; k <= view->lines.last; ++k) {
        const gmi_flank pinion = gmi_flank_of(prepared->pinion, teeth.pinion);
        const gmi_flank wheel = gmi_flank_of(prepared->wheel, teeth.wheel);
        const double reach = is_tilted ? prepared->tilt_bound : 0.0;
        if (view->lines.delta + pinion.peak + wheel.peak + reach > 0.0) {
            add_line(view, &motion, &pinion, &wheel, k, wanted, is_tilted, slides, total);
        }
        teeth.pinion = gmi_next_tooth(teeth.pinion, teeth.step, pair->pinion.teeth);
        teeth.wheel = gmi_next_tooth(teeth.wheel, teeth.step, pair->wheel.teeth);
    }
}

/*
 * An end of a line that the shift has moved outwards: f there at the depth of the walk. Adds what the line has gained, and
 * returns f at the new end.
 */
static double add_end_depth(const gmi_depth_end *end, double f, double shift, double moved,
                            double outwards, gmi_depth_sum *at) {
    const double slope = end->slope + shift * end->grows_rate;
    f += shift * end->grows;
    const double mean = f + moved * (0.5 * slope + moved * (1.0 / 3.0) * end->curvature);
    if (mean > 0.0) {
        at->sum += outwards * moved * mean;
        at->by_delta += outwards * moved * (end->grows + 0.5 * moved * end->grows_rate);
    }
    return gmi_larger(f + moved * (slope + moved * end->curvature), 0.0);
}

/*
 * Where a line ends at a shift, seen outwards: at the face, where the pinion's flank ends, or where the wheel's does, which
 * moves with the shift; whichever comes first. Of all lines but for the number of the line.
 */
typedef struct depth_limit {
    double outwards; /* -1 where a line begins, +1 where it ends: places along t1 times this */
    double face;
    double pinion, wheel; /* of line 0, without shift */
    double per_shift;     /* of the wheel's (1/m) */
} depth_limit;

static depth_limit limit_of(const gmi_engagement *at, const gmi_lines *lines,
                            const gmi_line_ends *ends, int is_end) {
    const double outwards = is_end ? 1.0 : -1.0;
    const double reach = at->line_of_action + lines->delta;

    /* A line that climbs begins at the lower limit, one that falls at the upper one. */
    const int is_lower = (lines->advance > 0.0) != is_end;
    const double pinion =
        is_lower ? at->start_roll_length[GM_PINION] : at->tip_roll_length[GM_PINION];
    const double wheel =
        reach - (is_lower ? at->tip_roll_length[GM_WHEEL] : at->start_roll_length[GM_WHEEL]);
    const double per = outwards * ends->per_advance;
    const depth_limit limit = {outwards, outwards * (is_end ? ends->face_to : ends->face_from),
                               per * (pinion - lines->origin), per * (wheel - lines->origin), per};
    return limit;
}

/*
 * What an end of line k adds at all depths. The wheel takes it along and f there, and which gear sets it may change: at
 * delta = 0 limits often coincide. place: where it is at the depth of the walk.
 */
static void add_end_depths(const depth_limit *limit, double along, double place, double f,
                           const gmi_depth_end *end, gmi_depths *depths) {
    const double held = gmi_smaller(limit->face, limit->pinion - along);
    const double wheel = limit->wheel - along;
    const double nearest = wheel + gmi_smaller(depths->shift[0] * limit->per_shift,
                                               depths->largest * limit->per_shift);
    place *= limit->outwards;

    /* Most lines end at the face at all depths. */
    if (place == limit->face && held == limit->face && !(nearest < held)) {
        return;
    }

    for (int n = 0; n < depths->count; ++n) {
        const double shift = depths->shift[n];
        const double reached = wheel + shift * limit->per_shift;
        const int moves = reached < held;
        const double moved = limit->outwards * ((moves ? reached : held) - place);
        gmi_depth_sum *at = &depths->part[n];
        const double f_there = add_end_depth(end, f, shift, moved, limit->outwards, at);
        if (moves || held < limit->face) {
            at->by_origin -= f_there * limit->per_shift;
            at->by_delta += moves ? f_there * limit->per_shift : 0.0;
        }
    }
}

void gmi_side_sum_depths(const gm_pair *pair, const gmi_engagement *at, const gmi_side *prepared,
                         int side, const gm_position *position, gmi_depths *depths) {
    gmi_lines lines;
    gmi_lines_find(pair, at, side, position, &lines);
    const gmi_line_ends ends = gmi_line_ends_find(pair, at, &lines);
    const depth_limit begin = limit_of(at, &lines, &ends, 0);
    const depth_limit end = limit_of(at, &lines, &ends, 1);
    const double wheel_reach = at->line_of_action + lines.delta - at->wheel_profile_start;

    /* All lines: what does not touch at this depth may touch at another one. */
    gmi_teeth teeth = gmi_lines_teeth(pair, side, position, &lines);
    for (int k = lines.first; k <= lines.last; ++k) {
        const gmi_flank pinion = gmi_flank_of(prepared->pinion, teeth.pinion);
        const gmi_flank wheel = gmi_flank_of(prepared->wheel, teeth.wheel);
        const gmi_interval part = gmi_line_clip(&ends, k);
        if (part.from < part.to) {
            const double rho_origin = lines.origin + (double)k * pair->transverse_base_pitch;
            const gmi_line line = line_between(pair, prepared, lines.delta, wheel_reach, &pinion,
                                               &wheel, rho_origin, part);
            gmi_line_sum sum;
            gmi_line_integrate_depths(&line, &prepared->pinion_grid, &prepared->wheel_grid, depths,
                                      &sum);

            /* Places of line k lie k spacings before those of line 0. */
            const double along = (double)k * ends.spacing;
            add_end_depths(&begin, -along, part.from, sum.at_from, &depths->from, depths);
            add_end_depths(&end, along, part.to, sum.at_to, &depths->to, depths);
        }
        teeth.pinion = gmi_next_tooth(teeth.pinion, teeth.step, pair->pinion.teeth);
        teeth.wheel = gmi_next_tooth(teeth.wheel, teeth.step, pair->wheel.teeth);
    }

    /* What touches all along does so at every larger depth. */
    gmi_depth_sum whole = {0.0, 0.0, 0.0, 0.0};
    double cube = 0.0;
    for (int n = 0; n < depths->count; ++n) {
        const double shift = depths->shift[n];
        gmi_depth_sum *part = &depths->part[n];
        whole.sum += depths->whole[n].sum;
        whole.by_delta += depths->whole[n].by_delta;
        whole.by_origin += depths->whole[n].by_origin;
        whole.bend += depths->whole[n].bend;
        cube += depths->cube[n];
        part->sum += whole.sum + shift * (whole.by_delta + shift * (whole.bend + shift * cube));
        part->by_delta += whole.by_delta + shift * (2.0 * whole.bend + shift * 3.0 * cube);
        part->by_origin += whole.by_origin;
        part->bend += whole.bend;
    }
}

void gmi_side_sum_tables(const gm_pair *pair, const gmi_engagement *at, const gmi_side *prepared,
                         int side, const gm_position *position, int wanted, gmi_side_sum *total) {
    /* Between parallel axes, what most calls want: a copy for each leaves all else out. */
    const int is_tilted = prepared->is_tilted;
    side_view view;
    if (wanted == GMI_SUM && !is_tilted) {
        follow_lines(pair, at, prepared, side, position, GMI_SUM, 0, 0, &view, total);
    } else if (wanted == GMI_SUM) {
        follow_lines(pair, at, prepared, side, position, GMI_SUM, 1, 0, &view, total);
    } else if (wanted == GMI_DERIVATIVES && !is_tilted) {
        follow_lines(pair, at, prepared, side, position, GMI_DERIVATIVES, 0, 0, &view, total);
    } else {
        follow_lines(pair, at, prepared, side, position, wanted & ~GMI_TANGENT, is_tilted, 0, &view,
                     total);
    }
}

void gmi_side_sum_sliding(const gm_mesh *mesh, int side, const gm_position *position,
                          double approach_speed, const gmi_sliding *sliding, gmi_side_sum *total,
                          gmi_rubbing *rubbing) {
    const gmi_rubbing none = {{0.0, 0.0, 0.0}, 0.0};
    *total = gmi_no_contact();
    *rubbing = none;
    side_view view;
    view.law = &mesh->law;
    view.sliding = sliding;
    view.approach_speed = approach_speed;
    view.rubbing = rubbing;
    const gmi_side *prepared = &mesh->side[side];
    follow_lines(mesh->pair, &mesh->engagement, prepared, side, position, GMI_MOMENTS,
                 prepared->is_tilted, 1, &view, total);

    /* What of the coefficient is the same all over the side. */
    gmi_load load = {
        {mesh->law.stiffness * total->sum + mesh->law.damping * approach_speed * total->contact,
         0.0, 0.0},
        {total->contact, 0.0}};
    gmi_rubbing_finish(sliding, &load, NULL, rubbing, NULL);
}

/*
 * Whether a line without ramps and tilt touches. Most of those that do are found out by a look at some places, all others by
 * the walk of a sum; `surely` is far beyond the rounding by which both may differ.
 */
static int touches(const gmi_side *prepared, const gmi_line *line) {
    static const double shares[] = {0.5, 0.25, 0.75, 0.05, 0.95};
    static const double surely = 1e-15; /* m */
    const gmi_grid *pinion = &prepared->pinion_grid, *wheel = &prepared->wheel_grid;
    for (int i = 0; i < (int)(sizeof shares / sizeof shares[0]); ++i) {
        const double t1 = line->from + shares[i] * (line->to - line->from);
        if (gmi_line_value(line, pinion, wheel, t1) > surely) {
            return 1;
        }
    }
    gmi_line_sum sum;
    gmi_line_integrate_sum(line, pinion, wheel, &sum);
    return sum.contact > 0.0;
}

int gmi_side_count_pairs(const gm_pair *pair, const gmi_engagement *at, const gmi_side *prepared,
                         int side, const gm_position *position) {
    if (gmi_side_is_clear(at, prepared, side, position->offset)) {
        return 0;
    }
    gmi_lines lines;
    gmi_lines_find(pair, at, side, position, &lines);
    const gmi_line_ends ends = gmi_line_ends_find(pair, at, &lines);
    const double wheel_reach = at->line_of_action + lines.delta - at->wheel_profile_start;

    /* Line by line, as in follow_lines(). */
    int pairs = 0;
    gmi_teeth teeth = gmi_lines_teeth(pair, side, position, &lines);
    for (int k = lines.first; k <= lines.last; ++k) {
        const gmi_flank pinion = gmi_flank_of(prepared->pinion, teeth.pinion);
        const gmi_flank wheel = gmi_flank_of(prepared->wheel, teeth.wheel);
        const gmi_interval part = gmi_line_clip(&ends, k);
        if (part.from < part.to && lines.delta + pinion.peak + wheel.peak > 0.0) {
            const double rho_origin = lines.origin + (double)k * pair->transverse_base_pitch;
            const gmi_line line = line_between(pair, prepared, lines.delta, wheel_reach, &pinion,
                                               &wheel, rho_origin, part);
            pairs += touches(prepared, &line);
        }
        teeth.pinion = gmi_next_tooth(teeth.pinion, teeth.step, pair->pinion.teeth);
        teeth.wheel = gmi_next_tooth(teeth.wheel, teeth.step, pair->wheel.teeth);
    }
    return pairs;
}

/* Apart from sums, as they take more stack. */
static OWN_STACK void follow_tangent(const gm_mesh *mesh, int side, const gm_position *position,
                                     gmi_side_sum *total, gmi_side_tangent *tangent) {
    const gmi_side *prepared = &mesh->side[side];
    side_view view;
    view.tangent = tangent;
    view.law = &mesh->law;
    follow_lines(mesh->pair, &mesh->engagement, prepared, side, position, GMI_TANGENT | GMI_MOMENTS,
                 prepared->is_tilted, 0, &view, total);

    /* All lines are known: their force. */
    const double sum[GMI_WEIGHTS] = {total->sum, total->sum_t1, total->sum_rho};
    const double contact[GMI_WEIGHTS] = {total->contact, total->contact_t1, total->contact_rho};
    tangent->flow =
        finish_load(&view, sum, contact, tangent->arm, tangent->load.force, tangent->by.force);
}

static OWN_STACK void follow_sliding_tangent(const gm_mesh *mesh, int side,
                                             const gm_position *position,
                                             const gmi_sliding *sliding, gmi_side_sum *total,
                                             gmi_side_tangent *tangent, gmi_rubbing *rubbing,
                                             gmi_rubbing_by *rubbing_by) {
    side_view view;
    view.tangent = tangent;
    view.law = &mesh->law;
    view.sliding = sliding;
    view.rubbing = rubbing;
    view.rubbing_by = rubbing_by;
    const gmi_side *prepared = &mesh->side[side];
    follow_lines(mesh->pair, &mesh->engagement, prepared, side, position, GMI_TANGENT | GMI_MOMENTS,
                 prepared->is_tilted, 1, &view, total);
}

void gmi_side_sum_tangent(const gm_mesh *mesh, int side, const gm_position *position,
                          const gmi_sliding *sliding, gmi_side_sum *total,
                          gmi_side_tangent *tangent, gmi_rubbing *rubbing,
                          gmi_rubbing_by *rubbing_by) {
    /* Nothing yet but the rates, which are the caller's. */
    const gmi_rates rates = tangent->rates;
    memset(tangent, 0, sizeof *tangent);
    tangent->rates = rates;
    *total = gmi_no_contact();
    if (sliding != NULL) {
        memset(rubbing, 0, sizeof *rubbing);
        memset(rubbing_by, 0, sizeof *rubbing_by);
    }

    /* The simple model has one pair of teeth and no friction. */
    if (mesh->model == GM_MODEL_SIMPLE) {
        gmi_side_sum_simple(mesh->pair, &mesh->engagement, side, position->offset, total);
        set_simple_tangent(mesh->pair, &mesh->engagement, &mesh->law, total, tangent);
        return;
    }

    /* Line by line, where the flanks can touch at all. */
    if (gmi_side_is_clear(&mesh->engagement, &mesh->side[side], side, position->offset)) {
        return;
    }
    if (sliding == NULL) {
        follow_tangent(mesh, side, position, total, tangent);
        return;
    }
    follow_sliding_tangent(mesh, side, position, sliding, total, tangent, rubbing, rubbing_by);
    gmi_rubbing_finish(sliding, &tangent->load, &tangent->by, rubbing, rubbing_by);
}

/* One pair, always there, which touches in the pitch point at mid-face. */
void gmi_side_sum_simple(const gm_pair *pair, const gmi_engagement *at, int side, double offset,
                         gmi_side_sum *total) {
    const double delta = gmi_ideal_penetration(at, side, offset);
    *total = gmi_no_contact();
    if (!(delta > 0.0)) {
        return;
    }

    const double pitch_point = pair->pinion.base_radius * tan(at->working_pressure_angle);
    total->sum = delta;
    total->contact = total->by_delta = 1.0;
    total->pairs = 1;
    total->contact_t1 = 0.5;
    total->contact_rho = pitch_point;
    total->sum_t1 = delta * total->contact_t1;
    total->sum_rho = delta * total->contact_rho;
}

double gmi_side_energy(const gm_mesh *mesh, int side, const gm_position *position) {
    const gmi_engagement *at = &mesh->engagement;
    const gmi_side *prepared = &mesh->side[side];
    const double half = 0.5 * mesh->law.stiffness;
    const double delta = gmi_ideal_penetration(at, side, position->offset);
    gmi_side_sum total;
    if (gmi_side_is_clear(at, prepared, side, position->offset)) {
        return 0.0;
    }

    /* One overlap all over the side: its square is that times the sum. */
    if (mesh->model == GM_MODEL_SIMPLE) {
        gmi_side_sum_simple(mesh->pair, at, side, position->offset, &total);
        return half * delta * total.sum;
    }
    if (prepared->pinion == NULL && prepared->wheel == NULL && !at->is_tilted) {
        total = gmi_no_contact();
        gmi_side_sum_ideal(mesh->pair, at, side, position, GMI_SUM, &total);
        return half * delta * total.sum;
    }

    /* Else line by line. */
    total = gmi_no_contact();
    gmi_side_sum_tables(mesh->pair, at, prepared, side, position, GMI_SQUARES, &total);
    return half * total.sum;
}

/* ---------------------------------------------------------------------------------------------
 * Both sides
 * ------------------------------------------------------------------------------------------- */

gm_penetration gmi_penetration_nan(void) {
    const double nan = gmi_nan();
    const gm_penetration result = {nan, nan, nan, nan, nan, nan, nan, nan, nan, nan, 0, 0};
    return result;
}

/* ---------------------------------------------------------------------------------------------
 * Checks
 * ------------------------------------------------------------------------------------------- */

int gmi_check_flanks(const gm_pair *pair, const gm_flanks *pinion_flanks,
                     const gm_flanks *wheel_flanks) {
    const int pinion_fits = pinion_flanks == NULL || pinion_flanks->teeth == pair->pinion.teeth;
    const int wheel_fits = wheel_flanks == NULL || wheel_flanks->teeth == pair->wheel.teeth;
    return pinion_fits && wheel_fits ? GM_OK : GM_ERR_TOOTH;
}

/* ---------------------------------------------------------------------------------------------
 * The plain entry points
 * ------------------------------------------------------------------------------------------- */

static int simple(const gm_pair *pair, const gm_state *state, gm_penetration *result) {
    gm_position position;
    int status = gm_position_from_state(pair, state, &position);
    if (status == GM_OK) {
        status = gmi_check_offset(position.offset, position.offset_rate);
    }

    /* Both sides of the pair as drawn: a spring with backlash. */
    if (status == GM_OK) {
        gmi_engagement at;
        gmi_side_sum drive, coast;
        (void)gmi_engagement_find(pair, NULL, &at);
        gmi_side_sum_simple(pair, &at, GM_DRIVE, position.offset, &drive);
        gmi_side_sum_simple(pair, &at, GM_COAST, position.offset, &coast);
        const double approach[2] = {position.offset_rate, -position.offset_rate};
        gmi_penetration_set(pair, &drive, &coast, approach, GMI_DERIVATIVES, result);
    }
    return status;
}

int gm_penetration_simple(const gm_pair *pair, const gm_state *state, gm_penetration *result) {
    if (result == NULL) {
        return GM_ERR_NULL;
    }
    *result = gmi_penetration_nan();
    return pair == NULL || state == NULL ? GM_ERR_NULL : simple(pair, state, result);
}

/* One side of two gears that no mesh has been prepared for. */
static gmi_side_sum side_sum(const gm_pair *pair, const gmi_engagement *at,
                             const gm_flanks *pinion_flanks, const gm_flanks *wheel_flanks,
                             int side, const gm_position *position) {
    gmi_side prepared;
    gmi_side_sum sum;
    gmi_side_init(&prepared, pair, at, pinion_flanks, wheel_flanks, side);
    if (gmi_side_is_clear(at, &prepared, side, position->offset)) {
        return gmi_no_contact();
    }
    gmi_side_sum_3d(pair, at, &prepared, side, position, GMI_DERIVATIVES, &sum);
    return sum;
}

int gm_penetration_3d(const gm_pair *pair, const gm_flanks *pinion_flanks,
                      const gm_flanks *wheel_flanks, const gm_state *state,
                      gm_penetration *result) {
    if (result == NULL) {
        return GM_ERR_NULL;
    }
    *result = gmi_penetration_nan();
    if (pair == NULL || state == NULL) {
        return GM_ERR_NULL;
    }

    gm_position position;
    int status = gmi_check_flanks(pair, pinion_flanks, wheel_flanks);
    if (status == GM_OK) {
        status = gm_position_from_state(pair, state, &position);
    }
    if (status == GM_OK) {
        status = gmi_check_position(pair, &position);
    }
    if (status != GM_OK) {
        return status;
    }

    gmi_engagement at;
    (void)gmi_engagement_find(pair, NULL, &at);
    const gmi_side_sum drive =
        side_sum(pair, &at, pinion_flanks, wheel_flanks, GM_DRIVE, &position);
    const gmi_side_sum coast =
        side_sum(pair, &at, pinion_flanks, wheel_flanks, GM_COAST, &position);
    const double approach[2] = {position.offset_rate, -position.offset_rate};
    gmi_penetration_set(pair, &drive, &coast, approach, GMI_DERIVATIVES, result);
    return GM_OK;
}
