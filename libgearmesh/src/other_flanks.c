/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * How the force of constant stiffness K grows with other flanks. On each line F has K times the integral of max(0, f) dt1,
 * f = delta + w. Where w grows by a c, the flanks touch up to roots of f, or up to ends of the line that stay where they are:
 *
 *     dF/da = K sum over the lines of the integral of c dt1 over what touches.
 *
 * From bend to bend f is a parabola, whose roots are known, and the integral of c is that of a line whose overlap is raised
 * until it touches all along: no quadrature error.
 */
#include "contact.h"
#include "flank.h"
#include "internal.h"
#include "line.h"
#include "line_load.h"
#include "mesh.h"
#include "penetration.h"
#include "surface.h"
#include "tilt.h"

#include <math.h>

/* A part of a line as long as another one up to this share is the other one. */
static const double rounding = 1e-10;

/* All that the walk along one line needs. */
typedef struct change_walk {
    const gm_mesh *mesh;
    const gmi_side_lines *found;
    const gm_flanks **pinion_changes, **wheel_changes;
    int count;
    double *force_by;

    /* Of the line at hand: */
    gmi_line_flanks flanks;
    double origin; /* rho_p at t1 = 0 (m) */
    double gain;   /* d f / d delta (1) */
} change_walk;

static double overlap_at(const change_walk *w, double t1) {
    const gmi_side_lines *found = w->found;
    const double roll = w->origin + found->lines.advance * t1;
    double by_roll;
    return w->gain * found->delta +
           gmi_line_flanks_at(&w->flanks, found->side, t1, roll, found->reach, &by_roll);
}

/* ---------------------------------------------------------------------------------------------
 * The integral of a change
 * ------------------------------------------------------------------------------------------- */

/* The part of a line as a side with these flanks has it, at delta 0. */
static gmi_line line_with(const change_walk *w, const gmi_side *side, double from, double to) {
    const gm_mesh *mesh = w->mesh;
    const gmi_flank pinion = gmi_flank_of(side->pinion, w->flanks.pinion_tooth);
    const gmi_flank wheel = gmi_flank_of(side->wheel, w->flanks.wheel_tooth);
    const double roll = w->origin - mesh->pair->pinion.start_roll_length;
    const double wheel_roll = w->found->reach - mesh->engagement.wheel_profile_start - w->origin;
    const gmi_line line = {
        .from = from,
        .to = to,
        .overlap = pinion.pitch + wheel.pitch,
        .pinion = pinion.values,
        .wheel = wheel.values,
        .pinion_profile = roll * side->pinion_grid.per_rho,
        .wheel_profile = wheel_roll * side->wheel_grid.per_rho,
    };
    return line;
}

/* Its integral over t1 from .. to (m). */
static OWN_STACK double integral_of(const change_walk *w, int k, double from, double to) {
    static const double first_rise = 1e-3, last_rise = 1e12;
    const gm_mesh *mesh = w->mesh;
    gmi_side change;
    gmi_side_init(&change, mesh->pair, &mesh->engagement, w->pinion_changes[k], w->wheel_changes[k],
                  w->found->side);
    if (change.pinion == NULL && change.wheel == NULL) {
        return 0.0;
    }

    /* Raised until it touches all along: by little, as what is added is taken away again. */
    const double length = to - from;
    gmi_line line = line_with(w, &change, from, to);
    gmi_line_sum sum = {.sum = 0.0};
    double rise = first_rise;
    for (double raised = 0.0; rise <= last_rise; rise *= 1e3) {
        line.overlap += rise - raised;
        raised = rise;
        gmi_flanks_integrate_line(&change, &line, GMI_SUM, &sum);
        if (sum.contact >= length * (1.0 - rounding)) {
            break;
        }
    }
    return sum.sum - rise * length;
}

static void add_stretch(const change_walk *w, double from, double to) {
    const double sign = gmi_side_sign(w->found->side);
    for (int k = 0; k < w->count; ++k) {
        w->force_by[k] += sign * w->mesh->law.stiffness * integral_of(w, k, from, to);
    }
}

/* ---------------------------------------------------------------------------------------------
 * What touches
 * ------------------------------------------------------------------------------------------- */

/* Roots of the parabola value + slope s + bend s^2 within 0 < s < 1, in their order; returns how many. */
static int roots_of(double value, double slope, double bend, double root[2]) {
    const double square = slope * slope - 4.0 * bend * value;
    int count = 0;
    if (!(square > 0.0)) {
        return 0;
    }

    /* Without the difference of close numbers. */
    const double half = -0.5 * (slope + copysign(sqrt(square), slope));
    const double both[2] = {half / bend, value / half};
    for (int k = 0; k < 2; ++k) {
        if (both[k] > 0.0 && both[k] < 1.0) {
            root[count++] = both[k];
        }
    }
    if (count == 2 && root[0] > root[1]) {
        const double first = root[1];
        root[1] = root[0];
        root[0] = first;
    }
    return count;
}

/* A line from bend to bend, and there from root to root: a stretch goes on as long as it touches. */
static void walk_bends(const change_walk *w, gmi_interval part) {
    const double nowhere = gmi_nan();
    double since = nowhere, before = overlap_at(w, part.from);
    for (double from = part.from, to; from < part.to; from = to) {
        to = gmi_line_next_bend(w->mesh, w->found, w->origin, from, part.to);

        /* The parabola up to the next bend, through both ends and the middle, and its roots. */
        const double length = to - from;
        const double middle = overlap_at(w, from + 0.5 * length), behind = overlap_at(w, to);
        const double bend = 2.0 * (before - 2.0 * middle + behind);
        const double slope = behind - before - bend;
        double root[2];
        const int roots = roots_of(before, slope, bend, root);

        /* Between two roots it touches all along, or nowhere. */
        double s = 0.0;
        for (int k = 0; k <= roots; ++k) {
            const double next = k < roots ? root[k] : 1.0, at = 0.5 * (s + next);
            const int touches = before + at * (slope + at * bend) > 0.0;
            if (touches && isnan(since)) {
                since = from + s * length;
            } else if (!touches && !isnan(since)) {
                add_stretch(w, since, from + s * length);
                since = nowhere;
            }
            s = next;
        }
        before = behind;
    }

    /* The last stretch may go on to the end. */
    if (!isnan(since)) {
        add_stretch(w, since, part.to);
    }
}

/* The sums of a part of the line at hand. */
static OWN_STACK gmi_line_sum sum_of(const change_walk *w, double from, double to) {
    const gmi_side *side = &w->mesh->side[w->found->side];
    gmi_line_sum sum = {.sum = 0.0};
    gmi_line line = line_with(w, side, from, to);
    line.overlap += w->gain * w->found->delta;
    if (side->is_tilted) {
        const double *shift = w->flanks.tilted.shift;
        line.overlap += shift[0] + from * (shift[1] + from * shift[2]);
        line.half_slope = 0.5 * shift[1] + from * shift[2];
        line.curvature = shift[2];
    }
    gmi_flanks_integrate_line(side, &line, GMI_MOMENTS, &sum);
    return sum;
}

/*
 * Nearly all lines touch along one stretch: its length and its middle are known from the line's sums, and it is one if all
 * of it touches. Others are walked from bend to bend, which takes several times as long.
 */
static void walk_line(const change_walk *w, gmi_interval part) {
    const gmi_line_sum whole = sum_of(w, part.from, part.to);
    const double length = whole.contact;
    if (!(length > 0.0)) {
        return;
    }

    /* All of it, or the stretch about the middle. */
    if (length >= (part.to - part.from) * (1.0 - rounding)) {
        add_stretch(w, part.from, part.to);
        return;
    }
    const double middle = whole.contact_t1 / length;
    const double from = gmi_larger(middle - 0.5 * length, part.from);
    const double to = gmi_smaller(middle + 0.5 * length, part.to);
    if (from < to && sum_of(w, from, to).contact >= length * (1.0 - rounding)) {
        add_stretch(w, from, to);
    } else {
        walk_bends(w, part);
    }
}

void gmi_side_by_flanks(const gm_mesh *mesh, int side, const gm_position *position,
                        const gm_flanks **pinion_changes, const gm_flanks **wheel_changes,
                        int count, double *force_by) {
    const gm_pair *pair = mesh->pair;
    const gmi_engagement *at = &mesh->engagement;
    if (gmi_side_is_clear(at, &mesh->side[side], side, position->offset)) {
        return;
    }

    /* Its lines, and where they end. */
    gmi_side_lines found = {.side = side,
                            .delta = gmi_ideal_penetration(at, side, position->offset)};
    gmi_side_ends ends;
    found.reach = at->line_of_action + found.delta;
    gmi_lines_find(pair, at, side, position, &found.lines);
    gmi_side_ends_find(mesh, &found, &ends);
    found.teeth = gmi_lines_teeth(pair, side, position, &found.lines);
    change_walk w = {.mesh = mesh,
                     .found = &found,
                     .pinion_changes = pinion_changes,
                     .wheel_changes = wheel_changes,
                     .count = count,
                     .gain = at->is_tilted ? gmi_tilt_gain(pair, at, side) : 1.0};
    w.force_by = force_by;

    /* Line by line, the part that lies within path and face. */
    for (int k = found.lines.first; k <= found.lines.last; ++k) {
        const gmi_interval none = {0.0, 0.0};
        const int is_listed = k >= ends.first && k <= ends.last;
        const gmi_interval listed = is_listed ? gmi_line_clip(&ends.path, k) : none;
        const gmi_interval part = gmi_side_line_part(&ends, mesh, &found, k, listed);
        if (part.from < part.to) {
            w.flanks = gmi_line_flanks_of(mesh, side, &found.lines, &found.teeth, k);
            w.origin = found.lines.origin + (double)k * pair->transverse_base_pitch;
            walk_line(&w, part);
        }
    }
}
