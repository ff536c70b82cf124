/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From angles to teeth and phase, once. r_b phi of a gear that has turned for an hour is metres, the
 * penetration micrometres; so whole teeth are taken off each angle exactly before anything is multiplied.
 */
#include "position.h"

#include "internal.h"

#include <math.h>

/* angle = turned * pitch + remainder, with `turned` a whole number (Cody-Waite with an exact product). */
typedef struct reduced_angle {
    double turned;
    double remainder; /* (rad) */
} reduced_angle;

static reduced_angle subtract_pitches(const gm_gear *gear, double angle, double turned) {
    const double product = turned * gear->pitch_angle;
    const double product_remainder = gmi_product_remainder(turned, gear->pitch_angle, product);
    const reduced_angle reduced = {turned, ((angle - product) - product_remainder) -
                                               turned * gear->pitch_angle_remainder};
    return reduced;
}

/* Remainder in [0, pitch). */
static reduced_angle reduce_angle(const gm_gear *gear, double angle) {
    reduced_angle reduced = subtract_pitches(gear, angle, floor(angle / gear->pitch_angle));
    /* The quotient's rounding may be off by one tooth at a boundary. */
    if (reduced.remainder < 0.0) {
        reduced = subtract_pitches(gear, angle, reduced.turned - 1.0);
    } else if (reduced.remainder >= gear->pitch_angle) {
        reduced = subtract_pitches(gear, angle, reduced.turned + 1.0);
    }
    return reduced;
}

/* After `turned` teeth have passed, tooth -turned (modulo z) is where tooth 0 was. */
static int tooth_after(double turned, int teeth) {
    const double number = (double)teeth;
    const double tooth = -turned - number * floor(-turned / number);
    return tooth < number ? (int)tooth : 0;
}

static int is_angle(double angle) {
    return fabs(angle) <= GMI_LARGEST_ANGLE;
}

static int is_speed(double speed) {
    return fabs(speed) <= GMI_LARGEST_SPEED;
}

static gm_position position_nan(void) {
    const gm_position position = {0, 0, gmi_nan(), gmi_nan(), gmi_nan(), gmi_nan()};
    return position;
}

static void set_pinion(const gm_pair *pair, reduced_angle pinion, gm_position *position) {
    position->pinion_tooth = tooth_after(pinion.turned, pair->pinion.teeth);
    position->wheel_tooth = tooth_after(pinion.turned, pair->wheel.teeth);
    position->phase = pair->pinion.base_radius * pinion.remainder;
}

/* x = r_bp phi_p - r_bw phi_w from the reduced angles: only whole base pitches and small arcs differ. */
static double offset_from(const gm_pair *pair, reduced_angle pinion, reduced_angle wheel) {
    return (pinion.turned - wheel.turned) * pair->transverse_base_pitch +
           (pair->pinion.base_radius * pinion.remainder -
            pair->wheel.base_radius * wheel.remainder);
}

static double offset_rate_from(const gm_pair *pair, const gm_state *state) {
    return pair->pinion.base_radius * state->pinion_speed -
           pair->wheel.base_radius * state->wheel_speed; /* [Paper, Eq. 11] */
}

static int check_state(const gm_state *state) {
    if (!gmi_is_finite(state->pinion_angle) || !gmi_is_finite(state->wheel_angle) ||
        !gmi_is_finite(state->pinion_speed) || !gmi_is_finite(state->wheel_speed)) {
        return GM_STATE_NOT_FINITE;
    }
    if (!is_angle(state->pinion_angle) || !is_angle(state->wheel_angle) ||
        !is_speed(state->pinion_speed) || !is_speed(state->wheel_speed)) {
        return GM_STATE_OUT_OF_RANGE;
    }
    return GM_OK;
}

int gmi_check_offset(double offset, double offset_rate) {
    if (!gmi_is_finite(offset) || !gmi_is_finite(offset_rate)) {
        return GM_STATE_NOT_FINITE;
    }
    const int is_within =
        fabs(offset) <= GMI_LARGEST_OFFSET && fabs(offset_rate) <= GMI_LARGEST_SPEED;
    return is_within ? GM_OK : GM_STATE_OUT_OF_RANGE;
}

/* An approach that is too fast comes from speeds that are each within their range, on gears of the size of a ship. */
static int finish(gm_position *position) {
    const int status = gmi_check_offset(position->offset, position->offset_rate);
    if (status != GM_OK) {
        *position = position_nan();
    }
    return status;
}

int gm_position_from_state(const gm_pair *pair, const gm_state *state, gm_position *position) {
    if (position == NULL) {
        return GM_ERR_NULL;
    }
    *position = position_nan();
    if (pair == NULL || state == NULL) {
        return GM_ERR_NULL;
    }
    const int status = check_state(state);
    if (status != GM_OK) {
        return status;
    }

    const reduced_angle pinion = reduce_angle(&pair->pinion, state->pinion_angle);
    const reduced_angle wheel = reduce_angle(&pair->wheel, state->wheel_angle);
    set_pinion(pair, pinion, position);
    position->offset = offset_from(pair, pinion, wheel);
    position->offset_rate = offset_rate_from(pair, state);
    position->pinion_speed = state->pinion_speed;
    return finish(position);
}

int gm_position_from_pinion_angle(const gm_pair *pair, double pinion_angle, double offset,
                                  double offset_rate, gm_position *position) {
    if (position == NULL) {
        return GM_ERR_NULL;
    }
    int status = pair == NULL ? GM_ERR_NULL : gmi_check_offset(offset, offset_rate);
    if (status != GM_ERR_NULL && !gmi_is_finite(pinion_angle)) {
        status = GM_STATE_NOT_FINITE;
    } else if (status == GM_OK && !is_angle(pinion_angle)) {
        status = GM_STATE_OUT_OF_RANGE;
    }
    if (status != GM_OK) {
        *position = position_nan();
        return status;
    }

    set_pinion(pair, reduce_angle(&pair->pinion, pinion_angle), position);
    position->offset = offset;
    position->offset_rate = offset_rate;
    position->pinion_speed = 0.0;
    return GM_OK;
}

int gmi_position_nearest(const gm_pair *pair, const gm_state *state, double shift,
                         gm_position *position) {
    *position = position_nan();
    const int status = check_state(state);
    if (status != GM_OK) {
        return status;
    }

    /* As if the wheel had turned by some teeth more: those of it that meet are others by as many. */
    const reduced_angle pinion = reduce_angle(&pair->pinion, state->pinion_angle);
    reduced_angle wheel = reduce_angle(&pair->wheel, state->wheel_angle);
    const double p_bt = pair->transverse_base_pitch;
    const double teeth = floor((offset_from(pair, pinion, wheel) + shift) / p_bt + 0.5);
    wheel.turned += teeth;
    set_pinion(pair, pinion, position);
    position->wheel_tooth = tooth_after(pinion.turned - teeth, pair->wheel.teeth);
    position->offset = offset_from(pair, pinion, wheel);
    position->offset_rate = offset_rate_from(pair, state);
    position->pinion_speed = state->pinion_speed;
    return finish(position);
}
