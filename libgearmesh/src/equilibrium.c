/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Quasi-static equilibrium at one pinion angle: the x at which stiffness * r_bw * net sum = torque. The net
 * sum grows with x (a spur pair may step where a pair enters or leaves), so the x is bracketed from the
 * clearance outwards and then found by Newton's method, kept inside the bracket by bisection. Where the sum steps
 * over the torque the bracket closes on the step: there the edge of the entering pair carries the rest.
 */
#include "internal.h"

#include <float.h>
#include <math.h>

#define BRACKET_STEPS 200
#define NEWTON_STEPS  200

typedef struct problem {
    const gm_pair *pair;
    const gm_flanks *pinion_flanks;
    const gm_flanks *wheel_flanks;
    gm_position position; /* phase and teeth; offset is the unknown */
    double target;        /* net sum that carries the torque (m) */
} problem;

/* Net sum less target at x, and the full result. Callers keep |x| below half a base pitch. */
static double residual(const problem *p, double offset, gm_penetration *result) {
    gm_position position = p->position;
    position.offset = offset;
    (void)gm_penetration_3d_at(p->pair, p->pinion_flanks, p->wheel_flanks, &position, result);
    return result->penetration - p->target;
}

static double peak_of(const gm_flanks *flanks, int side) {
    const gm_flank_tables *tables = gmi_flanks_side(flanks, side);
    return tables == NULL ? 0.0 : tables->peak;
}

/* No contact on a side whose ideal penetration is below minus this. */
static double sum_peak(const problem *p, int side) {
    return peak_of(p->pinion_flanks, side) + peak_of(p->wheel_flanks, side);
}

/* Just inside |x| < p_bt / 2. */
static double largest_offset(const problem *p) {
    return 0.4999999 * p->pair->transverse_base_pitch;
}

static double clamp(double value, double limit) {
    return fmin(fmax(value, -limit), limit);
}

/*
 * From `start` on in the direction of `direction` until the residual has that sign. *inner is the last x before.
 * Returns 0 if x leaves its range first.
 */
static int bracket(const problem *p, double start, double first_step, double direction,
                   double *inner, double *outer) {
    const double limit = largest_offset(p);
    gm_penetration result;
    /* A step shorter than the rounding of x would never leave it. */
    double step = fmax(first_step, DBL_EPSILON * p->pair->center_distance);
    *inner = *outer = start;
    for (int k = 0; k < BRACKET_STEPS; ++k) {
        if (direction * residual(p, *outer, &result) >= 0.0)
            return 1;
        if (*outer == direction * limit)
            return 0;
        *inner = *outer;
        *outer = clamp(*outer + direction * step, limit);
        step *= 2.0;
    }
    return 0;
}

/* Newton within [lower, upper], residual < 0 at lower and >= 0 at upper. */
static double solve(const problem *p, double lower, double upper, gm_penetration *result) {
    /* Shorter steps are below the rounding of the lengths that the lines of contact are clipped to. */
    const double resolution = DBL_EPSILON * p->pair->line_of_action;
    double offset = upper;
    for (int k = 0; k < NEWTON_STEPS; ++k) {
        const double value = residual(p, offset, result);
        if (value == 0.0)
            return offset;
        if (value < 0.0)
            lower = offset;
        else
            upper = offset;
        const double slope = -result->d_wheel_angle / p->pair->wheel.base_radius;
        double next = offset - value / slope;
        if (!(next > lower && next < upper))
            next = lower + 0.5 * (upper - lower);
        if (fabs(next - offset) <= resolution || next == lower || next == upper)
            break;
        offset = next;
    }
    return offset;
}

/* No torque: equilibrium only where both sides press against each other (negative backlash). */
static int bracket_unloaded(const problem *p, double *lower, double *upper) {
    const double half_backlash = 0.5 * p->pair->backlash;
    const double limit = largest_offset(p);
    *lower = clamp(half_backlash - sum_peak(p, GM_DRIVE), limit);  /* below: no drive contact */
    *upper = clamp(-half_backlash + sum_peak(p, GM_COAST), limit); /* above: no coast contact */
    return *lower < *upper;
}

/* From where nothing touches; the first step leads to where ideal flanks of one pair carry the torque. */
static int bracket_loaded(const problem *p, double *lower, double *upper) {
    const double half_backlash = 0.5 * p->pair->backlash;
    const double limit = largest_offset(p);
    const double peak = sum_peak(p, p->target > 0.0 ? GM_DRIVE : GM_COAST);
    const double first_step = fmax(peak, 0.0) + fabs(p->target);
    if (p->target > 0.0)
        return bracket(p, clamp(half_backlash - peak, limit), first_step, 1.0, lower, upper);
    return bracket(p, clamp(peak - half_backlash, limit), first_step, -1.0, upper, lower);
}

static int find(const problem *p, double *offset, gm_penetration *result) {
    double lower, upper;
    if (p->target == 0.0) {
        if (!bracket_unloaded(p, &lower, &upper))
            return GM_UNDETERMINED;
    } else if (!bracket_loaded(p, &lower, &upper)) {
        return GM_NO_EQUILIBRIUM;
    }
    const double found = solve(p, lower, upper, result);
    if (p->target == 0.0 && result->drive_contact == 0.0 && result->coast_contact == 0.0)
        return GM_UNDETERMINED;
    *offset = found;
    return GM_OK;
}

int gm_static_equilibrium(const gm_pair *pair, const gm_flanks *pinion_flanks,
                          const gm_flanks *wheel_flanks, double pinion_angle, double stiffness,
                          double wheel_torque, double *offset, gm_penetration *result) {
    gm_penetration found;
    if (result == NULL)
        result = &found;
    (void)gm_penetration_3d_at(NULL, NULL, NULL, NULL, result); /* NaN until found */
    if (offset == NULL)
        return GM_ERR_NULL;
    *offset = gmi_nan();
    if (pair == NULL)
        return GM_ERR_NULL;
    if (!(stiffness > 0.0) || !gmi_is_finite(stiffness) || !gmi_is_finite(wheel_torque))
        return GM_ERR_PARAMETER;

    problem p = {pair, pinion_flanks, wheel_flanks, {0, 0, 0.0, 0.0, 0.0}, 0.0};
    int status = gm_position_from_pinion_angle(pair, pinion_angle, 0.0, 0.0, &p.position);
    if (status == GM_OK)
        status = gmi_check_evaluation(pair, pinion_flanks, wheel_flanks, &p.position);
    if (status != GM_OK)
        return status;

    p.target = wheel_torque / (stiffness * pair->wheel.base_radius);
    gm_penetration at_equilibrium;
    status = find(&p, offset, &at_equilibrium);
    if (status == GM_OK)
        *result = at_equilibrium;
    return status;
}
