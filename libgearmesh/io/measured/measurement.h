/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file measurement.h
 * What reading and building of measured flanks share: the gear's names for the machine's, units that look
 * wrong, arrays that grow.
 */
#ifndef GEARMESH_MEASUREMENT_H
#define GEARMESH_MEASUREMENT_H

#include <stddef.h>

#include "gearmesh/gearmesh_io.h"

/** Checks how a gear was measured, and which one. */
int gmi_measurement_check(const gm_measurement *measurement, const gm_pair *pair, int wheel,
                          gm_io_error *error);

/** Radius of the circle on which the pitch was measured (m): that of reference unless another one is given. */
double gmi_measuring_radius(const gm_measurement *measurement, const gm_gear *gear);

/**
 * 1 if teeth are counted in the direction in which the gear's angle grows, -1 if against it: pinion and ring
 * counter-clockwise, external wheel clockwise, all seen from face II.
 */
int gmi_measurement_sense(const gm_measurement *measurement, const gm_pair *pair, int wheel);

/**
 * Tooth and side of what was measured, or an error that says which numbers are right.
 *
 * @param[in] line  of the file
 */
int gmi_measurement_place(const gm_measurement *measurement, const gm_pair *pair, int wheel,
                          int number, int flank, long line, int *tooth, int *side,
                          gm_io_error *error);

/** `left`, `right`, `drive` or `coast`. */
const char *gmi_flank_word(int flank);

/** How a length looks that should reach about `expected`: " (as if in inches)" or so; empty if like nothing. */
const char *gmi_length_hint(double length, double expected);

/**
 * Refuses deviations in millimetres or nanometres for micrometres.
 *
 * @param[in] range  largest less smallest value (m)
 * @param[in] most   what no gear like this exceeds (m)
 * @param[in] what   is deviating
 */
int gmi_check_size(double range, double most, const char *what, long line, gm_io_error *error);

/**
 * Room for one more element behind `count` of them, in an array from malloc() that doubles.
 *
 * @return the array, perhaps moved; NULL = no memory, the old one is still there
 */
void *gmi_array_grow(void *array, size_t size, int count, int *capacity);

#endif /* GEARMESH_MEASUREMENT_H */
