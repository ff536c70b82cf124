/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* One line of contact: what is along it, what moves it, and its integrals. */
#ifndef GEARMESH_LINE_H
#define GEARMESH_LINE_H

#include "contact.h"
#include "grid.h"
#include "internal.h"
#include "wide.h"

/* What moves the lines of one side and what is on them: its coordinates. */
enum gmi_coordinate {
    GMI_BY_ORIGIN, /* of the lines (m) */
    GMI_BY_DELTA,  /* ideal penetration (m) */
    GMI_BY_LENGTH, /* of the line of action (m) */
    GMI_BY_ALONG,  /* the tilt along the line of action, gmi_engagement.along (rad) */
    GMI_BY_ACROSS, /* and across it (rad) */
    GMI_BY_AXIAL,  /* the wheel's face (m) */
    GMI_COORDINATES
};

/*
 * How f along a line moves with the coordinates of its side, and how fast it approaches: by polynomials in t1, and by
 * what the tables have at the points looked up. In the result integrals over the touching part.
 */
typedef struct gmi_line_tangent {
    double by[GMI_COORDINATES]
             [3];    /* beside the tables; of second order by the length and the tilts alone */
    double speed[2]; /* of approach (m/s); line.c leaves it and the next to others */

    /* u of tilt.c: the speed of approach falls by it times that of the tilt across (m) */
    double arm[2];

    double pinion_per_rho, wheel_per_rho,
        face_per_length; /* d v2 / d rho of both, d v1 / d z of the wheel (1/m) */

    /* Times 1 and t1, over all parts of the line: */
    double contact[4];                 /* of 1, t1, t1^2, t1^3 */
    double sum_by[GMI_COORDINATES][2]; /* of d f / d coordinate */
    double contact_by[GMI_COORDINATES]
                     [3]; /* how the touching part moves, at the roots of f; and times t1^2 */

} gmi_line_tangent;

/*
 * One line: t1 from `from` to `to`, with f = overlap + 2 half_slope s + curvature s^2 + tables of both flanks, s = t1 - from.
 */
typedef struct gmi_line {
    double from, to;
    double overlap;       /* delta, both pitch deviations, and ramps (m) */
    double half_slope;    /* half of what ramps and tilt make of d f / d t1 there (m) */
    double curvature;     /* half of what the tilt makes of d2 f / d t1^2 (m) */
    const double *pinion; /* table, NULL = none */
    const double *wheel;
    double pinion_profile; /* v2 of the pinion's table at t1 = 0 */
    double wheel_profile;
    gmi_line_tangent *tangent; /* GMI_TANGENT */
} gmi_line;

/* The part of a line between two places: the parabola as seen from where it begins. */
static inline gmi_line gmi_line_between(const gmi_line *line, double from, double to) {
    gmi_line part = *line;
    const double gone = from - line->from;
    part.from = from;
    part.to = to;
    part.overlap += gone * (2.0 * line->half_slope + gone * line->curvature);
    part.half_slope += gone * line->curvature;
    return part;
}

/* At one depth: the sum, its derivatives by delta and by the origin of the lines, and half of its second one by delta. */
typedef struct gmi_depth_sum {
    double sum, by_delta, by_origin, bend;
} gmi_depth_sum;

/* One end of a line: how f changes from there on with t1 and with the shift (m). */
typedef struct gmi_depth_end {
    double slope, curvature; /* the latter half the second derivative */
    double grows, grows_rate;
} gmi_depth_end;

/*
 * A side at many depths from one walk along its lines (GMI_DEPTHS): delta is that of the walk and a shift. With the shift f
 * grows by itself and by the slope of the wheel's flank, whose place moves, and with it the kinks of its table; where the
 * wheel sets the ends of lines these move. That is the whole of it as long as no kink or end that moves passes another one
 * or a place where f is zero.
 */
enum { GMI_DEPTHS_MAX = 41 };
typedef struct gmi_depths {
    int count;
    double shift[GMI_DEPTHS_MAX]; /* ascending (m) */
    double largest;               /* the last one; -infinite without any */
    double per_shift; /* depths per shift on average; 0 if they are all the same (1/m) */
    double touch; /* least shift at which anything touches, if it is below what it is set to (m) */

    /* Of pieces that touch all along from depth n on, without shift; of those that touch in part, and of the ends. */
    gmi_depth_sum whole[GMI_DEPTHS_MAX], part[GMI_DEPTHS_MAX];
    double cube[GMI_DEPTHS_MAX]; /* by the third power of the shift, from depth n on */

    /* Of the line at hand, by the slopes of the table that leads and of the other one: */
    double per_place;                 /* from its places to t1 */
    double shift_first, shift_second; /* d f / d shift */
    double origin_first, origin_second;
    gmi_depth_end from, to;
} gmi_depths;

/* Integrals over the part of a line where f > 0. */
typedef struct gmi_line_sum {
    double sum;        /* of f (m) */
    double contact;    /* of 1 (1) */
    double pinion;     /* of the pinion's d deviation / d v2 (GMI_DERIVATIVES) (m) */
    double wheel;      /* of the wheel's (m) */
    double sum_t1;     /* of f t1 (GMI_MOMENTS) (m) */
    double contact_t1; /* of t1 (1) */

    /* Over the roots of f within the line, where the touching part ends (GMI_CONTACT_DERIVATIVES): */
    double roots;        /* sum of 1 / |df/dt1| (1/m) */
    double roots_pinion; /* of the pinion's d deviation / d v2, over |df/dt1| (1) */
    double roots_wheel;  /* of the wheel's (1) */

    double at_from; /* f itself at both ends (m) */
    double at_to;
    gmi_depths *depths; /* GMI_DEPTHS */
} gmi_line_sum;

/* What the tables add to d f / d coordinate, from the slopes of the pinion, of the wheel and of the wheel's face. */
static inline void gmi_line_add_slopes(const gmi_line_tangent *tangent, double pinion, double wheel,
                                       double face, double by[GMI_COORDINATES]) {
    const double by_pinion = tangent->pinion_per_rho * pinion;
    const double by_wheel = tangent->wheel_per_rho * wheel;
    by[GMI_BY_ORIGIN] += by_pinion - by_wheel;
    by[GMI_BY_DELTA] += by_wheel;
    by[GMI_BY_LENGTH] += by_wheel;
    by[GMI_BY_AXIAL] -= tangent->face_per_length * face;
}

/* The same at all depths; the result has f at both ends of the line at the depth of the walk. */
void gmi_line_integrate_depths(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                               gmi_depths *depths, gmi_line_sum *result);

/* Of f squared, and of 1, alone. */
void gmi_line_integrate_squares(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                                gmi_line_sum *result);

/* f at one place of a line without ramps and tilt (m). */
double gmi_line_value(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                      double t1);

/* wanted: none of GMI_TANGENT, GMI_DEPTHS and GMI_SQUARES. */
void gmi_line_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                        int wanted, gmi_line_sum *result);

/* Sum and moments with the line's tangent: apart, as it takes more stack. */
void gmi_line_integrate_tangent(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                                gmi_line_sum *result);

/* The same on processors with vectors of four doubles: line_wide.c, not to be called but from the functions above. */
#if GMI_HAS_WIDE
void gmi_wide_line_integrate_squares(const gmi_line *line, const gmi_grid *pinion,
                                     const gmi_grid *wheel, gmi_line_sum *result);
void gmi_wide_line_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                             int wanted, gmi_line_sum *result);
void gmi_wide_line_sum(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                       gmi_line_sum *result); /* with a table on the pinion */
#endif

/* The sum and the touching part alone, which most evaluations want: by the shortest way. */
static inline void gmi_line_integrate_sum(const gmi_line *line, const gmi_grid *pinion,
                                          const gmi_grid *wheel, gmi_line_sum *result) {
#if GMI_HAS_WIDE
    if (pinion->is_wide && line->pinion != NULL) {
        gmi_wide_line_sum(line, pinion, wheel, result);
        return;
    }
#endif
    gmi_line_integrate(line, pinion, wheel, GMI_SUM, result);
}

#endif
