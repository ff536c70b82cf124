/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The penetration models: simple [Paper, Eqs. 9-11] and 3D [Paper, Eqs. 12-25].
 *
 * 3D: the sum over all lines of the integral of max(0, delta + deviations) over t1. Along a line the integrand is
 * a quadratic between grid-line crossings (trace.h); each piece is integrated in closed form, split at its roots
 * where its sign changes. No slices, no quadrature error.
 */
#include "internal.h"
#include "trace.h"

#include <math.h>

/* The integrals over the touching part of one line. */
typedef struct line_sum {
    double sum;        /* of f = max(0, delta) (m) */
    double contact;    /* of 1 (1) */
    double pinion;     /* of the pinion flank's d deviation / d v2 (m) */
    double wheel;      /* of the wheel flank's (m) */
    double sum_t1;     /* of f t1 (m) */
    double contact_t1; /* of t1 (1) */
} line_sum;

/* Two traces and their sum at t1, where a piece begins. */
typedef struct line_walk {
    double t1;
    gmi_quadratic f;
    gmi_trace pinion;
    gmi_trace wheel;
} line_walk;

/* Adds the part [begin, end] (from the start of the piece) where f > 0. */
static inline void add_touching(const line_walk *walk, double begin, double end, int wanted,
                                line_sum *total) {
    const gmi_quadratic f = walk->f;
    const double length = end - begin;
    const double middle = 0.5 * (begin + end);
    /* Integral of the quadratic about the middle: exact, and no differences of cubes. */
    const double at_middle = f.value + middle * (f.slope + middle * f.curvature);
    const double second = length * length * (1.0 / 12.0);
    const double integral = length * (at_middle + f.curvature * second);
    total->sum += integral;
    total->contact += length;
    if (wanted & GMI_DERIVATIVES) {
        total->pinion += length * gmi_trace_profile_slope(&walk->pinion, middle);
        total->wheel += length * gmi_trace_profile_slope(&walk->wheel, middle);
    }
    if (wanted & GMI_MOMENTS) {
        const double t1 = walk->t1 + middle;
        const double slope_at_middle = f.slope + 2.0 * middle * f.curvature;
        total->sum_t1 += t1 * integral + length * second * slope_at_middle;
        total->contact_t1 += t1 * length;
    }
}

/* A piece in which f changes its sign: splits it at the roots of the quadratic. */
static void add_split_piece(const line_walk *walk, double length, int wanted, line_sum *total) {
    const gmi_quadratic f = walk->f;
    const double discriminant = f.slope * f.slope - 4.0 * f.curvature * f.value;
    double cuts[4] = {0.0, 0.0, 0.0, length};
    if (discriminant > 0.0) {
        const double q = -0.5 * (f.slope + copysign(sqrt(discriminant), f.slope));
        const double root_1 = fmin(fmax(q / f.curvature, 0.0), length);
        const double root_2 = fmin(fmax(f.value / q, 0.0), length);
        cuts[1] = fmin(root_1, root_2);
        cuts[2] = fmax(root_1, root_2);
    }
    for (int k = 0; k < 3; ++k) {
        const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
        if (cuts[k + 1] > cuts[k] && f.value + middle * (f.slope + middle * f.curvature) > 0.0)
            add_touching(walk, cuts[k], cuts[k + 1], wanted, total);
    }
}

/* One piece. A quadratic stays within the hull of its three Bezier points, so most need no roots. */
static inline void add_piece(const line_walk *walk, double length, double end_value, int wanted,
                             line_sum *total) {
    const double start_value = walk->f.value;
    const double control = start_value + 0.5 * length * walk->f.slope;
    if (start_value <= 0.0 && control <= 0.0 && end_value <= 0.0)
        return;
    if (start_value >= 0.0 && control >= 0.0 && end_value >= 0.0)
        add_touching(walk, 0.0, length, wanted, total);
    else
        add_split_piece(walk, length, wanted, total);
}

/* Walks from walk->t1 to `to`, piece by piece. On return walk->f.value is f at `to`. */
static inline void walk_line(line_walk *walk, double to, int wanted, line_sum *total) {
    for (;;) {
        const double next_pinion = fmin(walk->pinion.next_face, walk->pinion.next_profile);
        const double next_wheel = fmin(walk->wheel.next_face, walk->wheel.next_profile);
        const double crossing = fmin(next_pinion, next_wheel);
        const double end = fmin(crossing, to);
        const double length = end - walk->t1;
        if (length > 0.0) {
            const gmi_quadratic f = walk->f;
            const double end_value = f.value + length * (f.slope + length * f.curvature);
            add_piece(walk, length, end_value, wanted, total);
            walk->f.value = end_value;
            walk->f.slope = f.slope + 2.0 * length * f.curvature;
            walk->pinion.profile_slope = gmi_trace_profile_slope(&walk->pinion, length);
            walk->wheel.profile_slope = gmi_trace_profile_slope(&walk->wheel, length);
            walk->t1 = end;
        }
        if (crossing >= to)
            return;
        if (walk->pinion.next_face == crossing)
            gmi_trace_cross_face(&walk->pinion, crossing, &walk->f);
        if (walk->pinion.next_profile == crossing)
            gmi_trace_cross_profile(&walk->pinion, crossing, &walk->f);
        if (walk->wheel.next_face == crossing)
            gmi_trace_cross_face(&walk->wheel, crossing, &walk->f);
        if (walk->wheel.next_profile == crossing)
            gmi_trace_cross_profile(&walk->wheel, crossing, &walk->f);
    }
}

/* How t2 of both flanks follows from rho_p; the same on all lines of a side. */
typedef struct profile_maps {
    double pinion_per_rho; /* d t2 / d rho of the pinion (1/m) */
    double wheel_per_rho;  /* of the wheel (1/m) */
    double
        wheel_reach; /* rho_p + rho_w - start of the wheel: rho_w - start = wheel_reach - rho_p (m) */
} profile_maps;

static profile_maps maps_of(const gm_pair *pair, double delta) {
    const gm_gear *pinion = &pair->pinion;
    const gm_gear *wheel = &pair->wheel;
    const profile_maps maps = {1.0 / (pinion->tip_roll_length - pinion->start_roll_length),
                               1.0 / (wheel->tip_roll_length - wheel->start_roll_length),
                               pair->line_of_action + delta - wheel->start_roll_length};
    return maps;
}

/*
 * Derivatives of one line's sum. Inside, f depends on the line's origin and on delta through both look-up
 * points; at an end that a limit of the flanks sets, the end itself moves (Leibniz):
 *     t1_end = (limit - rho_origin) / twist.
 */
static void add_derivatives(const gmi_lines *lines, const profile_maps *maps, double pinion_scale,
                            double wheel_scale, const line_sum *line, double from, double to,
                            double f_from, double f_to, gmi_side_sum *side) {
    const double by_pinion = line->pinion * pinion_scale * maps->pinion_per_rho;
    const double by_wheel = line->wheel * wheel_scale * maps->wheel_per_rho;
    side->by_origin += by_pinion - by_wheel;
    side->by_delta += line->contact + by_wheel;

    const int upwards = lines->twist > 0.0;
    if (from > 0.0 && f_from > 0.0) {
        const double limit_by_delta = upwards ? lines->lower_by_delta : lines->upper_by_delta;
        side->by_origin += f_from / lines->twist;
        side->by_delta -= f_from * limit_by_delta / lines->twist;
    }
    if (to < 1.0 && f_to > 0.0) {
        const double limit_by_delta = upwards ? lines->upper_by_delta : lines->lower_by_delta;
        side->by_origin -= f_to / lines->twist;
        side->by_delta += f_to * limit_by_delta / lines->twist;
    }
}

static inline void add_line(const gm_pair *pair, const gmi_lines *lines, const profile_maps *maps,
                            const gmi_flank *pinion, const gmi_flank *wheel, double rho_origin,
                            int wanted, gmi_side_sum *side) {
    double from, to;
    if (!gmi_line_clip(lines, rho_origin, &from, &to))
        return;

    line_walk walk = {.t1 = from, .f = {lines->delta + pinion->pitch + wheel->pitch, 0.0, 0.0}};
    gmi_trace_none(&walk.pinion);
    gmi_trace_none(&walk.wheel);
    if (pinion->values != NULL)
        gmi_trace_begin(&walk.pinion, pinion, from,
                        (rho_origin - pair->pinion.start_roll_length) * maps->pinion_per_rho,
                        lines->twist * maps->pinion_per_rho, &walk.f);
    if (wheel->values != NULL)
        gmi_trace_begin(&walk.wheel, wheel, from,
                        (maps->wheel_reach - rho_origin) * maps->wheel_per_rho,
                        -lines->twist * maps->wheel_per_rho, &walk.f);

    const double f_from = walk.f.value;
    line_sum line = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    walk_line(&walk, to, wanted, &line);

    side->sum += line.sum;
    side->contact += line.contact;
    side->pairs += line.contact > 0.0;
    if (wanted & GMI_DERIVATIVES)
        add_derivatives(lines, maps, (double)(pinion->profile_nodes - 1),
                        (double)(wheel->profile_nodes - 1), &line, from, to, f_from, walk.f.value,
                        side);
    if (wanted & GMI_MOMENTS) {
        side->sum_t1 += line.sum_t1;
        side->sum_rho += rho_origin * line.sum + lines->twist * line.sum_t1;
        side->contact_t1 += line.contact_t1;
        side->contact_rho += rho_origin * line.contact + lines->twist * line.contact_t1;
    }
}

static int next_tooth(int tooth, int step, int teeth) {
    const int next = tooth + step;
    return next < 0 ? teeth - 1 : next == teeth ? 0 : next;
}

gmi_side_sum gmi_side_sum_3d(const gm_pair *pair, const gm_flanks *pinion_flanks,
                             const gm_flanks *wheel_flanks, int side, const gm_position *position,
                             int wanted) {
    gmi_side_sum total = {0.0, 0.0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    gmi_lines lines;
    gmi_lines_find(pair, side, position, &lines);

    /* Nothing reaches across the gap: the usual state of one of both sides. */
    if (lines.delta + gmi_flanks_peak(pinion_flanks, side) + gmi_flanks_peak(wheel_flanks, side) <=
        0.0)
        return total;

    const profile_maps maps = maps_of(pair, lines.delta);
    int pinion_tooth = lines.pinion_tooth;
    int wheel_tooth = lines.wheel_tooth;
    for (int k = lines.first; k <= lines.last; ++k) {
        const gmi_flank pinion = gmi_flank_of(pinion_flanks, side, pinion_tooth);
        const gmi_flank wheel = gmi_flank_of(wheel_flanks, side, wheel_tooth);
        if (lines.delta + pinion.peak + wheel.peak > 0.0) {
            const double rho_origin = lines.origin + (double)k * pair->transverse_base_pitch;
            add_line(pair, &lines, &maps, &pinion, &wheel, rho_origin, wanted, &total);
        }
        pinion_tooth = next_tooth(pinion_tooth, lines.tooth_step, pair->pinion.teeth);
        wheel_tooth = next_tooth(wheel_tooth, lines.tooth_step, pair->wheel.teeth);
    }
    return total;
}

static gm_penetration penetration_nan(void) {
    const double nan = gmi_nan();
    const gm_penetration result = {nan, nan, nan, nan, nan, nan, nan, nan, nan, nan, 0, 0};
    return result;
}

static void set_rates(gm_penetration *result, double offset_rate) {
    result->penetration = result->drive - result->coast;
    result->drive_rate = offset_rate * result->drive_contact;
    result->coast_rate = -offset_rate * result->coast_contact;
    result->rate = result->drive_rate - result->coast_rate;
}

int gm_penetration_simple_at(const gm_pair *pair, double offset, double offset_rate,
                             gm_penetration *result) {
    if (result == NULL)
        return GM_ERR_NULL;
    *result = penetration_nan();
    if (pair == NULL)
        return GM_ERR_NULL;
    if (!gmi_is_finite(offset) || !gmi_is_finite(offset_rate))
        return GM_STATE_NOT_FINITE;

    const double drive = offset - 0.5 * pair->backlash;
    const double coast = -offset - 0.5 * pair->backlash;
    result->drive = drive > 0.0 ? drive : 0.0;
    result->coast = coast > 0.0 ? coast : 0.0;
    result->drive_pairs = drive > 0.0;
    result->coast_pairs = coast > 0.0;
    result->drive_contact = (double)result->drive_pairs;
    result->coast_contact = (double)result->coast_pairs;
    const double touching = result->drive_contact + result->coast_contact;
    result->d_pinion_angle = pair->pinion.base_radius * touching;
    result->d_wheel_angle = -pair->wheel.base_radius * touching;
    set_rates(result, offset_rate);
    return GM_OK;
}

int gmi_check_evaluation(const gm_pair *pair, const gm_flanks *pinion_flanks,
                         const gm_flanks *wheel_flanks, const gm_position *position) {
    if (pair == NULL || position == NULL)
        return GM_ERR_NULL;
    if ((pinion_flanks != NULL && pinion_flanks->teeth != pair->pinion.teeth) ||
        (wheel_flanks != NULL && wheel_flanks->teeth != pair->wheel.teeth))
        return GM_ERR_TOOTH;
    if (!gmi_is_finite(position->phase) || !gmi_is_finite(position->offset) ||
        !gmi_is_finite(position->offset_rate))
        return GM_STATE_NOT_FINITE;
    /* One base pitch of slack: a phase may be rounded up to p_bt. */
    if (fabs(position->offset) >= 0.5 * pair->transverse_base_pitch ||
        fabs(position->phase) > 2.0 * pair->transverse_base_pitch)
        return GM_STATE_OUT_OF_RANGE;
    if (position->pinion_tooth < 0 || position->pinion_tooth >= pair->pinion.teeth ||
        position->wheel_tooth < 0 || position->wheel_tooth >= pair->wheel.teeth)
        return GM_ERR_TOOTH;
    return GM_OK;
}

/*
 * From line origin and delta to angles. Drive: origin grows with r_bp phi_p, delta with x; coast: both with the
 * opposite sign, and it counts negatively in the net sum, so that the signs are the same again.
 */
static void set_derivatives(const gm_pair *pair, const gmi_side_sum *drive,
                            const gmi_side_sum *coast, gm_penetration *result) {
    const double by_offset = drive->by_delta + coast->by_delta;
    const double by_origin = drive->by_origin + coast->by_origin;
    result->d_pinion_angle = pair->pinion.base_radius * (by_offset + by_origin);
    result->d_wheel_angle = -pair->wheel.base_radius * by_offset;
}

int gm_penetration_3d_at(const gm_pair *pair, const gm_flanks *pinion_flanks,
                         const gm_flanks *wheel_flanks, const gm_position *position,
                         gm_penetration *result) {
    if (result == NULL)
        return GM_ERR_NULL;
    *result = penetration_nan();
    const int status = gmi_check_evaluation(pair, pinion_flanks, wheel_flanks, position);
    if (status != GM_OK)
        return status;

    const gmi_side_sum drive =
        gmi_side_sum_3d(pair, pinion_flanks, wheel_flanks, GM_DRIVE, position, GMI_DERIVATIVES);
    const gmi_side_sum coast =
        gmi_side_sum_3d(pair, pinion_flanks, wheel_flanks, GM_COAST, position, GMI_DERIVATIVES);
    result->drive = drive.sum;
    result->coast = coast.sum;
    result->drive_contact = drive.contact;
    result->coast_contact = coast.contact;
    result->drive_pairs = drive.pairs;
    result->coast_pairs = coast.pairs;
    set_rates(result, position->offset_rate);
    set_derivatives(pair, &drive, &coast, result);
    return GM_OK;
}

int gm_penetration_3d(const gm_pair *pair, const gm_flanks *pinion_flanks,
                      const gm_flanks *wheel_flanks, const gm_state *state,
                      gm_penetration *result) {
    if (result == NULL)
        return GM_ERR_NULL;
    *result = penetration_nan();
    gm_position position;
    const int status = gm_position_from_state(pair, state, &position);
    if (status != GM_OK)
        return status;
    return gm_penetration_3d_at(pair, pinion_flanks, wheel_flanks, &position, result);
}
