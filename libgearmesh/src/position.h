/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Positions: the nearest one of angles whose whole turns are not known, and what of a position is refused. */
#ifndef GEARMESH_POSITION_H
#define GEARMESH_POSITION_H

#include "internal.h"

/*
 * Of angles whose whole turns are not known: that x + shift is taken which is within half a base pitch, and
 * the wheel's tooth that is there.
 */
int gmi_position_nearest(const gm_pair *pair, const gm_state *state, double shift,
                         gm_position *position);

/* One comparison: below 0 is far above as unsigned. */
static inline int gmi_is_tooth(int tooth, int teeth) {
    return (unsigned)tooth < (unsigned)teeth;
}

/* Status of a position in the 3D model. */
static inline int gmi_check_position(const gm_pair *pair, const gm_position *position) {
    /* Negated, so that NaN is caught; a phase may be rounded up to p_bt. */
    if (!(fabs(position->offset) < 0.5 * pair->transverse_base_pitch) ||
        !(fabs(position->phase) < 1.5 * pair->transverse_base_pitch) ||
        !(fabs(position->offset_rate) <= GMI_LARGEST_SPEED)) {
        return gmi_is_finite(position->offset) && gmi_is_finite(position->phase) &&
                       gmi_is_finite(position->offset_rate)
                   ? GM_STATE_OUT_OF_RANGE
                   : GM_STATE_NOT_FINITE;
    }
    if (!gmi_is_tooth(position->pinion_tooth, pair->pinion.teeth) ||
        !gmi_is_tooth(position->wheel_tooth, pair->wheel.teeth)) {
        return GM_ERR_TOOTH;
    }
    return GM_OK;
}

/* Status of x and dx/dt in any model. */
int gmi_check_offset(double offset, double offset_rate);

/* Status of a speed of a gear, as friction takes it. */
static inline int gmi_check_speed(double speed) {
    if (fabs(speed) <= GMI_LARGEST_SPEED) {
        return GM_OK;
    }
    return gmi_is_finite(speed) ? GM_STATE_OUT_OF_RANGE : GM_STATE_NOT_FINITE;
}

#endif
