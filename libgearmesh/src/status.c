/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Texts and numbers that every other source may use. */
#include "internal.h"

const char *gm_status_text(int status) {
    switch (status) {
    case GM_OK:
        return "done";
    case GM_STATE_NOT_FINITE:
        return "an angle, speed or coordinate is not finite";
    case GM_STATE_OUT_OF_RANGE:
        return "the gears are turned against each other by half a base pitch or more, an angle "
               "exceeds 1e9 rad, or a speed 1e9 rad/s or m/s";
    case GM_NO_EQUILIBRIUM:
        return "no contact within half a base pitch carries the torque";
    case GM_UNDETERMINED:
        return "without torque the position within the backlash is undetermined";
    case GM_POSE_OUT_OF_MESH:
        return "the gears are posed so that they do not mesh: tips or faces miss each other, or a "
               "tip meets the "
               "mate's root";
    case GM_NO_CONVERGENCE:
        return "elastic teeth found no balance in the steps allowed";
    case GM_ERR_NULL:
        return "a required pointer is NULL";
    case GM_ERR_PARAMETER:
        return "a parameter is out of its range";
    case GM_ERR_GEOMETRY:
        return "the parameters together give no gear pair";
    case GM_ERR_MEMORY:
        return "the memory provided is too small, or all table places are taken";
    case GM_ERR_TOOTH:
        return "no such tooth or flank, or the flanks have another number of teeth";
    case GM_ERR_DEVIATION:
        return "a flank or pitch deviation is not finite, or beyond 1 m";
    default:
        return "unknown status";
    }
}

const char *gm_version(void) {
    return GM_VERSION_STRING;
}

double gmi_product_remainder(double a, double b, double product) {
    const double splitter = 134217729.0; /* 2^27 + 1: halves of 26 bits (Veltkamp) */
    const double a_scaled = splitter * a;
    const double a_high = a_scaled - (a_scaled - a);
    const double a_low = a - a_high;
    const double b_scaled = splitter * b;
    const double b_high = b_scaled - (b_scaled - b);
    const double b_low = b - b_high;
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}
