/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file robust.h
 * Middle and spread of values of which some are wrong.
 */
#ifndef GEARMESH_ROBUST_H
#define GEARMESH_ROBUST_H

/** Median of count >= 1 values, which are sorted by this. */
double gmi_median(double *values, int count);

/**
 * Robust standard deviation of count >= 1 values: 1.4826 times the median distance from their median, which is the
 * standard deviation where the values are distributed normally.
 *
 * @param[in] work  [count] room
 */
double gmi_spread(const double *values, int count, double *work);

#endif /* GEARMESH_ROBUST_H */
