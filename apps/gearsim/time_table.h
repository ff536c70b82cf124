/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * A speed or a torque as a table over time.
 *
 * The file is CSV, `time_s,speed_rpm` or `time_s,torque_Nm`; lines that begin with # do not count. Between the
 * rows runs a straight line or a cubic: that of Hermite, whose slope at a row is the one of the parabola
 * through the row and its neighbours (C1). Two rows at one time are a step, across which no cubic looks; the
 * later one counts from there on.
 *
 * A table is read once and not changed then. Before t = 0 and behind its last row it keeps its value there.
 */
#ifndef GEARSIM_TIME_TABLE_H
#define GEARSIM_TIME_TABLE_H

#include "config.h"

typedef struct time_table time_table;

/* Reads the tables that the keys name, into conf->drive_table and conf->load_table. Returns 0, EXIT_BAD_INPUT (the
 * message names file and line, and the key) or EXIT_RUN_FAILED. Both are freed by time_tables_free(). */
int time_tables_read(config *conf);
void time_tables_free(config *conf);

double time_table_value(const time_table *table, double time); /* rad/s or N m */
double time_table_slope(const time_table *table, double time); /* its derivative */

/* Integral of the value from 0 on. */
double time_table_integral(const time_table *table, double time);

/* Integral from one time to a later one, weighted by a straight line between the weights at both, exact. */
double time_table_weighted(const time_table *table, double from, double to, double first_weight,
                           double last_weight);

/* Largest slope, and largest change of the slope per second, from a time to the next row. */
double time_table_steepest(const time_table *table, double time);
double time_table_curvature(const time_table *table, double time);

/* Time of the next row behind a time, HUGE_VAL = there is none; is_kink: the torque steps, or the speed has a kink. */
double time_table_next_row(const time_table *table, double time, int *is_kink);

/* Largest absolute value that the table reaches. */
double time_table_largest(const time_table *table);

/* How far times may be off by rounding (s). */
double time_table_tolerance(const time_table *table, double time);

#endif
