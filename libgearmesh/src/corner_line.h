/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What corner_line.c, which follows lines beyond the path of contact, shares with corner_tangent.c, which knows how all of
 * it moves.
 */
#ifndef GEARMESH_CORNER_LINE_H
#define GEARMESH_CORNER_LINE_H

#include "contact.h"
#include "corner.h"
#include "friction.h"
#include "internal.h"
#include "line.h"
#include "meshing.h"
#include "tilt.h"

/* The gap around one roll: a parabola from `from` on, and where the corner is. */
typedef struct gmi_corner_parabola {
    double from, gap, slope, curvature;
    double pair_from, pair_to;     /* between them are this one and its neighbour */
    gmi_corner_joint begins, ends; /* there */
} gmi_corner_parabola;

/* One side at one position. */
typedef struct gmi_corner_view {
    const gm_mesh *mesh;
    int side;
    int wanted;
    gmi_lines lines;
    double stop[2]; /* [enum gm_role] roll beyond the tip at which nothing touches any more (m) */
    const gmi_grid *running[2]; /* [enum gm_role] of flanks with tables or ramps */
    gmi_grid held[2];
    gmi_corner_parabola last; /* what was found last, of the tip of this gear: */
    int last_role;
    gmi_line_tangent *tangent; /* of the part at hand, where derivatives are wanted */
    const gmi_rates *rates; /* where lines are followed with all coordinates; NULL = sums alone */
    gmi_corner_tangent *followed; /* the forces then, */
    gmi_corner_rubbing *rubbing;  /* or the friction */
    gmi_corner_sums *sums;        /* or NULL */
    double approach_speed;        /* (m/s) */
    double viscous;               /* damping times speed of approach (N) */
    const gmi_sliding *sliding;   /* NULL = without friction */
} gmi_corner_view;

/* What cuts a line: a face, a roll beyond the tip of a gear, an end of its table; where its corner ends; cuts of friction. */
enum {
    GMI_CUT_FACE,
    GMI_CUT_ROLL,
    GMI_CUT_TABLE = GMI_CUT_ROLL + 2,
    GMI_CUT_STOP = GMI_CUT_TABLE + 2,
    GMI_CUT_FRICTION = GMI_CUT_STOP + 2
};

/* A place at which a line is cut, and how that moves by origin and delta. */
typedef struct gmi_corner_cut {
    double t1;
    double by[2];
    int what; /* of both gears: their first one and enum gm_role */
} gmi_corner_cut;

static inline int gmi_corner_is_stop(const gmi_corner_cut *end) {
    return end->what >= GMI_CUT_STOP && end->what < GMI_CUT_FRICTION;
}

/* One line of it. */
typedef struct gmi_corner_line {
    gmi_line line;
    double gain, by_origin[2];   /* of tilted axes, see gmi_tilted_line */
    double from_by[2], to_by[2]; /* how their faces' ends move by origin and delta */
    double origin;               /* rho_p at t1 = 0 (m) */
    gmi_beyond beyond[2];        /* [enum gm_role] the tip */
} gmi_corner_line;

static inline double gmi_corner_roll_at(const gmi_beyond *beyond, double t1) {
    return beyond->at_zero + beyond->per_t1 * t1;
}

/* Where both parabolas between two joints meet. */
static inline double gmi_corner_middle(const gmi_corner_parabola *gap) {
    return 0.5 * (gap->pair_from + gap->pair_to);
}

/* What of a corner changes with the roll beyond the tip. */
typedef struct gmi_bend {
    double value, by_roll, by_roll_twice;
} gmi_bend;

/* A parabola through three joints; of spur gears one that is known where they are with how it changes. */
static inline gmi_bend gmi_corner_bend(const gmi_corner_parabola *gap, double roll, double begins,
                                       double middle, double ends, double by_roll_there) {
    const double length = gap->pair_to - gap->pair_from;
    gmi_bend bend = {begins, by_roll_there, 0.0};
    if (length > 0.0) {
        const double q = (roll - gap->pair_from) / length;
        bend.value = (1.0 - q) * (1.0 - 2.0 * q) * begins + 4.0 * q * (1.0 - q) * middle +
                     q * (2.0 * q - 1.0) * ends;
        bend.by_roll =
            ((4.0 * q - 3.0) * begins + (4.0 - 8.0 * q) * middle + (4.0 * q - 1.0) * ends) / length;
        bend.by_roll_twice = 4.0 * (begins - 2.0 * middle + ends) / (length * length);
    }
    return bend;
}

static inline gmi_bend gmi_bend_sum(const gmi_bend *a, double a_factor, const gmi_bend *b,
                                    double b_factor) {
    const gmi_bend sum = {a_factor * a->value + b_factor * b->value,
                          a_factor * a->by_roll + b_factor * b->by_roll,
                          a_factor * a->by_roll_twice + b_factor * b->by_roll_twice};
    return sum;
}

/* corner_tangent.c: the gap moves a part of a line with all coordinates. */
void gmi_corner_follow_gap(const gmi_corner_view *v, const gmi_corner_line *whole, int role,
                           const gmi_corner_parabola *gap);

/* An end of the line, or a cut in it, that moves; f: the overlap there, above 0. */
void gmi_corner_follow_end(const gmi_corner_view *v, const gmi_corner_line *whole, int is_beginning,
                           const gmi_corner_cut *end, double f);

/* What a part adds to the forces of the side, and what it does at a tip. */
void gmi_corner_follow_forces(const gmi_corner_view *v, const gmi_corner_line *whole,
                              const gmi_line_sum *sum);
void gmi_corner_follow_tip(const gmi_corner_view *v, const gmi_corner_line *whole, int role,
                           const gmi_corner_parabola *gap, const gmi_corner_cut *from,
                           const gmi_corner_cut *to, const gmi_line_sum *sum);

/* What it adds to the friction; gap: of the tip that it is beyond, or NULL. And what is the same all over the side. */
void gmi_corner_follow_friction(const gmi_corner_view *v, const gmi_corner_line *whole, int role,
                                const gmi_corner_parabola *gap, const gmi_corner_cut *from,
                                const gmi_corner_cut *to, const gmi_line_sum *sum);
void gmi_corner_finish_friction(const gmi_corner_view *v);

#endif
