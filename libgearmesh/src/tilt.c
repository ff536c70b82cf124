/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Axes that are tilted against each other: what the overlap of a pair of flanks is along one line of contact.
 *
 * The wheel turns by the small rotation vector theta about the middle O of its own face. At the point P of a line, with
 *
 *     e   the line of action,  t  normal to it in the transverse section,  k  the axis,  tau = tan(beta_b),  n = e - tau k
 *     w = theta x (P - O)     what the tilt moves the wheel's flank by there,    v = -w.t
 *
 * the flanks part by d0 = w.n - (theta x w).n / 2 + v^2 / (2 rho_w) along the line of action: the movement along the
 * normal, its second order, and what the flank curves away from under the movement along it. The normals of both flanks
 * then differ by sigma = v / rho_w + tau (theta x k).t, so that they touch beside P, where they are closer by
 * sigma^2 rho_p rho_w / (2 T). With the path that the tilt takes off the rotation,
 *
 *     overlap = (1 + tau (theta x k).e) (delta - d0) + sigma^2 rho_p rho_w / (2 T).
 *
 * Against brute force of turned helicoids it is off by some nanometres at 4 mrad, where the first order alone is off by
 * micrometres.
 *
 * A line ends where either gear's own flank does: by the roll lengths of the points that touch, and by their place along
 * each gear's own face, which the tilt moves by w.k on the wheel.
 */
#include "internal.h"

#include <math.h>

/* The wheel's radius of curvature is not taken smaller than this part of the line of action. */
static const double smallest_curvature = 1e-3;

/* The step over which the excess is taken to change in proportion: this part of the face. */
static const double nearby = 1.0 / 64.0;

typedef struct vector {
    double x, y, z;
} vector;

static vector cross(vector a, vector b) {
    const vector result = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return result;
}

static double dot(vector a, vector b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* What is the same all over one side. */
typedef struct tilted_side {
    vector theta, line_of_action, across, normal;
    vector along_line; /* theta x e: how the movement changes along the line of action */
    double tau;
    double gain;     /* of delta - d0 */
    double twisting; /* the part of sigma that is the same everywhere */
} tilted_side;

static tilted_side side_of(const gm_pair *pair, const gmi_engagement *at, int side) {
    const double sign = gmi_side_sign(side);
    const double sine = sin(at->working_pressure_angle);
    const double cosine = cos(at->working_pressure_angle);
    const vector axis = {0.0, 0.0, 1.0};
    tilted_side s;
    s.tau = sign * pair->face_advance / pair->face_width;
    s.theta = (vector){at->tilt[0], at->tilt[1], 0.0};
    s.line_of_action = (vector){sine, sign * cosine, 0.0};
    s.across = (vector){cosine, -sign * sine, 0.0};
    s.normal = (vector){sine, sign * cosine, -s.tau};

    s.along_line = cross(s.theta, s.line_of_action);
    const vector of_axis = cross(s.theta, axis);
    s.gain = 1.0 + s.tau * dot(s.line_of_action, of_axis);
    s.twisting = s.tau * dot(s.across, of_axis);
    return s;
}

/* w at a point: how far the wheel's flank has moved there, in first order. */
static vector movement_at(const gm_pair *pair, const gmi_engagement *at, const tilted_side *s,
                          double rho, double z) {
    const double r_b = pair->pinion.base_radius;
    const vector arm = {r_b * s->across.x + rho * s->line_of_action.x - at->center_distance,
                        r_b * s->across.y + rho * s->line_of_action.y, z - at->tilt_center};
    return cross(s->theta, arm);
}

/* The overlap at a point less gain times delta, and its derivative along the line of action. */
typedef struct tilted_point {
    double shift;  /* (m) */
    double by_rho; /* (1) */
} tilted_point;

static tilted_point point_at(const gm_pair *pair, const gmi_engagement *at, const tilted_side *s,
                             double rho, double z) {
    /* How the wheel's flank has moved there, to second order; primes are derivatives by rho. */
    const vector moved = movement_at(pair, at, s, rho, z);
    const double v = -dot(s->across, moved);
    const double v_prime = -dot(s->across, s->along_line);
    const double length = at->line_of_action;
    const double rho_w = fmax(length - rho, smallest_curvature * length);
    const double d0 =
        dot(s->normal, moved) - 0.5 * dot(s->normal, cross(s->theta, moved)) + 0.5 * v * v / rho_w;
    const double d0_prime = dot(s->normal, s->along_line) -
                            0.5 * dot(s->normal, cross(s->theta, s->along_line)) +
                            v * v_prime / rho_w + 0.5 * v * v / (rho_w * rho_w);

    /* The flanks touch beside the point. */
    const double sigma = v / rho_w + s->twisting;
    const double sigma_prime = v_prime / rho_w + v / (rho_w * rho_w);
    const double closer = 0.5 * sigma * sigma * rho * rho_w / length;
    const double closer_prime =
        (sigma * sigma_prime * rho * rho_w + 0.5 * sigma * sigma * (rho_w - rho)) / length;
    const tilted_point point = {closer - s->gain * d0, closer_prime - s->gain * d0_prime};
    return point;
}

/* By how much the roll lengths of the points that touch exceed those of P: rho_p, and T + delta - rho_p (m). */
typedef struct roll_excess {
    double pinion, wheel;
} roll_excess;

static roll_excess excess_at(const gm_pair *pair, const gmi_engagement *at, const tilted_side *s,
                             double rho, double z) {
    const double length = at->line_of_action;
    const double rho_p = fmax(rho, smallest_curvature * length);
    const double rho_w = fmax(length - rho, smallest_curvature * length);
    const vector moved = movement_at(pair, at, s, rho, z);
    const double across = dot(s->across, moved);

    /* The gap is sigma u + u^2 T / (2 rho_p rho_w) at u beside P: least at -sigma rho_p rho_w / T. */
    const double sigma = s->twisting - across / rho_w;
    const double beside = -sigma * rho_p * rho_w / length;

    /* A flank's roll length grows by r_b / rho times the way along it, outwards. */
    const roll_excess excess = {pair->pinion.base_radius / rho_p * beside,
                                pair->wheel.base_radius / rho_w * (across - beside) +
                                    s->tau * moved.z};
    return excess;
}

/* t1 between which a line is on the faces of both gears. */
static gmi_interval on_both_faces(const gm_pair *pair, const gmi_engagement *at,
                                  const tilted_side *s, double rho_origin, double advance) {
    /* Own z of the wheel at both ends of the drawing's common face; linear in between. */
    const double b = pair->face_width;
    const double z_0 = pair->face_start;
    const double first = z_0 - movement_at(pair, at, s, rho_origin, z_0).z;
    const double last = z_0 + b - movement_at(pair, at, s, rho_origin + advance, z_0 + b).z;
    const double half_width = 0.5 * pair->wheel.face_width;
    const double per_rise = 1.0 / (last - first);
    const gmi_interval part = {fmax(-z_0 / b, (at->tilt_center - half_width - first) * per_rise),
                               fmin((pair->pinion.face_width - z_0) / b,
                                    (at->tilt_center + half_width - first) * per_rise)};
    return part;
}

/*
 * Cuts off the part in which own, a gear's roll length inside one of its limits, is below 0: a straight line along t1 from
 * `first` to `last`. An end set here moves with the line's origin and with delta, as own does.
 */
static void cut(gmi_tilted_part *kept, gmi_interval face, double first, double last,
                double own_by_origin, double own_by_delta) {
    const double per_slope = (face.to - face.from) / (last - first);
    const double root = face.from - first * per_slope;
    if (first < 0.0 && (last <= 0.0 || root > kept->from)) {
        kept->from = last <= 0.0 ? face.to : root;
        kept->from_by_origin = -own_by_origin * per_slope;
        kept->from_by_delta = -own_by_delta * per_slope;
    } else if (last < 0.0 && root < kept->to) {
        kept->to = root;
        kept->to_by_origin = -own_by_origin * per_slope;
        kept->to_by_delta = -own_by_delta * per_slope;
    }
}

/* Roll lengths along a spur gear's line change by the tilt alone. */
static void clip_spur(const gm_pair *pair, const gmi_engagement *at, const tilted_side *s,
                      double reach, double rho_origin, gmi_tilted_part *kept) {
    const double b = pair->face_width;
    const double z_0 = pair->face_start;
    const gmi_interval face = {kept->from, kept->to};
    const roll_excess first = excess_at(pair, at, s, rho_origin, z_0 + b * face.from);
    const roll_excess last = excess_at(pair, at, s, rho_origin, z_0 + b * face.to);
    const double start_p = at->start_roll_length[GM_PINION], tip_p = pair->pinion.tip_roll_length;
    const double start_w = at->start_roll_length[GM_WHEEL], tip_w = pair->wheel.tip_roll_length;

    const double rho_w = reach - rho_origin;
    cut(kept, face, rho_origin + first.pinion - start_p, rho_origin + last.pinion - start_p, 1.0,
        0.0);
    cut(kept, face, tip_p - rho_origin - first.pinion, tip_p - rho_origin - last.pinion, -1.0, 0.0);
    cut(kept, face, rho_w + first.wheel - start_w, rho_w + last.wheel - start_w, -1.0, 1.0);
    cut(kept, face, tip_w - rho_w - first.wheel, tip_w - rho_w - last.wheel, 1.0, -1.0);
}

/* Along a helical gear's line they change by its advance; the tilt's share is taken where the line meets the limit. */
static void clip_helical(const gm_pair *pair, const gmi_engagement *at, const tilted_side *s,
                         double reach, double advance, double rho_origin, gmi_tilted_part *kept) {
    const double b = pair->face_width;
    const double z_0 = pair->face_start;
    const double per_advance = 1.0 / advance;
    const gmi_interval face = {kept->from, kept->to};

    /* Limits of rho_p: the pinion's start and tip, the wheel's tip and start. */
    const double limits[4] = {at->start_roll_length[GM_PINION], pair->pinion.tip_roll_length,
                              reach - pair->wheel.tip_roll_length,
                              reach - at->start_roll_length[GM_WHEEL]};
    for (int k = 0; k < 4; ++k) {
        const int is_wheel = k >= 2;
        const int is_lower = k % 2 == 0;
        const double meets = (limits[k] - rho_origin) * per_advance;
        const double t1 = fmin(fmax(meets, face.from), face.to);
        const double beyond = t1 + nearby * (face.to - face.from);

        /* The excess there as if on the pinion, and a step further on. */
        const roll_excess here = excess_at(pair, at, s, rho_origin + advance * t1, z_0 + b * t1);
        const roll_excess next =
            excess_at(pair, at, s, rho_origin + advance * beyond, z_0 + b * beyond);
        const double excess = is_wheel ? -here.wheel : here.pinion;
        const double further = is_wheel ? -next.wheel : next.pinion;
        const double per_slope = 1.0 / (advance + (further - excess) / (beyond - t1));
        const double end = t1 - (rho_origin + advance * t1 + excess - limits[k]) * per_slope;

        /* A line that climbs enters at a lower limit, one that falls at an upper one. */
        const double by_delta = is_wheel ? per_slope : 0.0;
        if (is_lower == (advance > 0.0)) {
            if (end > kept->from) {
                kept->from = end;
                kept->from_by_origin = -per_slope;
                kept->from_by_delta = by_delta;
            }
        } else if (end < kept->to) {
            kept->to = end;
            kept->to_by_origin = -per_slope;
            kept->to_by_delta = by_delta;
        }
    }
}

gmi_tilted_part gmi_tilt_clip(const gm_pair *pair, const gmi_engagement *at, int side,
                              const gmi_lines *lines, double rho_origin) {
    const tilted_side s = side_of(pair, at, side);
    const double reach = at->line_of_action + lines->delta; /* rho_p + rho_w */
    const gmi_interval face = on_both_faces(pair, at, &s, rho_origin, lines->advance);
    gmi_tilted_part kept = {face.from, face.to, 0.0, 0.0, 0.0, 0.0};
    if (!(face.from < face.to)) {
        return kept;
    }
    if (lines->advance == 0.0) {
        clip_spur(pair, at, &s, reach, rho_origin, &kept);
    } else {
        clip_helical(pair, at, &s, reach, lines->advance, rho_origin, &kept);
    }
    return kept;
}

double gmi_tilt_gain(const gm_pair *pair, const gmi_engagement *at, int side) {
    return side_of(pair, at, side).gain;
}

double gmi_tilt_bound(const gm_pair *pair, const gmi_engagement *at, int side) {
    enum { POINTS = 5 };
    const tilted_side s = side_of(pair, at, side);
    const double first = at->start_roll_length[GM_PINION];
    const double last = pair->pinion.tip_roll_length;
    double most = 0.0;
    double size = 0.0;
    for (int i = 0; i < POINTS * POINTS; ++i) {
        const double along = (double)(i / POINTS) / (POINTS - 1);
        const double across = (double)(i % POINTS) / (POINTS - 1);
        const double t1 = at->face_from + across * (at->face_to - at->face_from);
        const double z = pair->face_start + t1 * pair->face_width;
        const double shift = point_at(pair, at, &s, first + along * (last - first), z).shift;
        most = fmax(most, shift);
        size = fmax(size, fabs(shift));
    }

    /* Between the points it is next to linear; and the gain acts on any delta. */
    return most + 0.05 * size + fabs(s.gain - 1.0) * pair->transverse_base_pitch;
}

void gmi_tilt_line(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                   double advance, double from, double to, gmi_tilted_line *line) {
    const tilted_side s = side_of(pair, at, side);
    const double middle = 0.5 * (from + to);
    const double t1[3] = {from, middle, to};
    tilted_point points[3];
    for (int k = 0; k < 3; ++k) {
        points[k] = point_at(pair, at, &s, rho_origin + advance * t1[k],
                             pair->face_start + t1[k] * pair->face_width);
    }

    /* The parabola through both ends and the middle. */
    const double per_length = 1.0 / (to - from);
    const double bend = points[0].shift - 2.0 * points[1].shift + points[2].shift;
    line->gain = s.gain;
    line->shift = points[0].shift;
    line->curvature = 2.0 * bend * per_length * per_length;
    line->half_slope = 0.5 * ((points[2].shift - points[0].shift) - 2.0 * bend) * per_length;

    /* Of the derivative, the straight line. */
    line->by_rho = points[0].by_rho;
    line->by_rho_slope = (points[2].by_rho - points[0].by_rho) * per_length;
}
