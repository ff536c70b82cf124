/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Lines of contact between tilted axes: their ends, and the overlap along them. */
#ifndef GEARMESH_TILT_H
#define GEARMESH_TILT_H

#include "contact.h"
#include "internal.h"
#include "line.h"
#include "meshing.h"

/* The part of a line on both flanks, none where not from < to, what ends it, and how its ends move. */
typedef struct gmi_line_part {
    double from, to; /* t1 */
    int from_place, to_place;
    double from_by[GMI_COORDINATES], to_by[GMI_COORDINATES];
} gmi_line_part;

/* One end of the lines of a side: a place is within its limits from enter to leave (t1), less by_origin rho_origin. */
typedef struct gmi_tilt_cut {
    double enter, leave, by_origin;
} gmi_tilt_cut;

/* All that ends the lines of a side, and the pinion's face. */
enum { GMI_TILT_CUTS_MAX = 5 };
typedef struct gmi_tilt_cuts {
    gmi_interval face;
    gmi_tilt_cut cut[GMI_TILT_CUTS_MAX];
    unsigned char place[GMI_TILT_CUTS_MAX]; /* of each cut */
    unsigned char count;
} gmi_tilt_cuts;

/* What ends lines beside the faces, tips and starts, or does not: a sum of these. */
enum {
    GMI_ENDS_WITH_PINION_TABLE = 1,
    GMI_ENDS_WITH_WHEEL_TABLE = 2,
    GMI_FACES_ALONE = 4 /* tips and starts end none */
};

/* ends: a sum of the above. */
void gmi_tilt_cuts_find(const gm_pair *pair, const gmi_engagement *at, int side, double delta,
                        int ends, gmi_tilt_cuts *cuts);

/* The part of one line; 0 where there is none. Not from_by and to_by, which gmi_tilt_move_ends() sets. */
int gmi_tilt_cut_line(const gmi_tilt_cuts *cuts, double rho_origin, gmi_line_part *part);
void gmi_tilt_move_ends(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                        double delta, gmi_line_part *part);

/* One of both ends alone; 0 where it does not move. */
int gmi_tilt_move_end(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                      double delta, const gmi_line_part *part, int is_beginning,
                      double by[GMI_COORDINATES]);

/* How far a line is beyond the tip of a gear: at_zero + per_t1 t1 (m), and how it moves. */
typedef struct gmi_beyond {
    double at_zero, per_t1;
    double by_origin, by_delta; /* (1) */
} gmi_beyond;

void gmi_tilt_beyond(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                     double delta, int role, gmi_beyond *beyond);

/* How it moves with all coordinates of the side: at t1 = 0, and per t1. */
void gmi_tilt_beyond_by(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                        int role, double by[GMI_COORDINATES][2]);

/* Speed of approach, on average over the touching part; sum with GMI_MOMENTS where the tilt changes. */
double gmi_rates_mean_approach(const gmi_rates *rates, const gm_pair *pair,
                               const gmi_engagement *at, int side, const gmi_side_sum *sum);

/* f along a line is gain delta + shift, a polynomial in t1, and d f / d rho another. */
typedef struct gmi_tilted_line {
    double gain;         /* (1) */
    double shift[3];     /* (m) */
    double by_origin[2]; /* (1) */
} gmi_tilted_line;

/* The same for all lines of a side: polynomials in rho_p at t1 = 0 too. */
typedef struct gmi_tilt {
    double gain;           /* (1) */
    double shift[3];       /* (m) */
    double by_rho[2];      /* of the first two (1) */
    double by_rho_squared; /* of the first (1/m) */
} gmi_tilt;

void gmi_tilt_find(const gm_pair *pair, const gmi_engagement *at, int side, gmi_tilt *tilt);

static inline gmi_tilted_line gmi_tilt_of_line(const gmi_tilt *tilt, double rho_origin) {
    const double by_square = tilt->by_rho_squared * rho_origin;
    const gmi_tilted_line line = {
        tilt->gain,
        {tilt->shift[0] + rho_origin * (tilt->by_rho[0] + by_square),
         tilt->shift[1] + rho_origin * tilt->by_rho[1], tilt->shift[2]},
        {tilt->by_rho[0] + 2.0 * by_square, tilt->by_rho[1]},
    };
    return line;
}

void gmi_tilt_line(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                   gmi_tilted_line *line);

/* What the polynomials of the tangents of all lines of a side follow from. */
typedef struct gmi_tilt_motion {
    double tau, u,
        u_per_t1;      /* u of the line with rho_p = 0 at t1 = 0, there and more per t1 (1, m) */
    double per_length; /* 1 / T (1/m) */
    double gain;       /* (1) */
    double linear, square;                        /* of the overlap as a polynomial in u (1, 1/m) */
    double along, across;                         /* the tilts (rad) */
    double by_along, by_across, by_across_per_t1; /* by the tilts, what does not go with u (m) */
    double speed, speed_by_arm;                   /* of approach (m/s, 1/s) */
} gmi_tilt_motion;

void gmi_tilt_motion_find(const gm_pair *pair, const gmi_engagement *at, int side, double delta,
                          const gmi_rates *rates, gmi_tilt_motion *motion);

/* Those of one line: by, arm and speed. */
void gmi_tilt_tangent(const gmi_tilt_motion *motion, double rho_origin, gmi_line_tangent *tangent);

/* d f / d delta of a side (1). */
double gmi_tilt_gain(const gm_pair *pair, const gmi_engagement *at, int side);

/* f exceeds delta nowhere on a side by more than this; and ends of lines move along rho_p by no more than *reach (m). */
double gmi_tilt_bound(const gm_pair *pair, const gmi_engagement *at, int side, double *reach);

/* By how much that bound grows with the roll beyond the tips (1). */
double gmi_tilt_bound_by_roll(const gm_pair *pair, const gmi_engagement *at, int side);

#endif
