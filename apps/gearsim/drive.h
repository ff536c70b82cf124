/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What moves the pinion: a speed that is linear in time or as a table says, or a torque, constant or as a table says.
 */
#ifndef GEARSIM_DRIVE_H
#define GEARSIM_DRIVE_H

#include "time_table.h"

typedef struct pinion_drive {
    enum drive_kind kind;
    double start_speed;      /* rad/s */
    double acceleration;     /* of a prescribed speed, rad/s2; 0 for a torque */
    double torque;           /* M_p, N m; 0 for a prescribed speed */
    const time_table *table; /* in place of speed or torque, NULL = none */
} pinion_drive;

typedef struct drive_motion {
    double angle;        /* phi_p, 0 at t = 0 (rad) */
    double speed;        /* rad/s */
    double acceleration; /* rad/s2 */
} drive_motion;

pinion_drive drive_create(const config *conf);

/* Prescribed motion of the pinion; goes on beyond the duration of the run. Speed kind only. */
drive_motion drive_at(const pinion_drive *drive, double time);

/* M_p at a time (N m). Torque kind only. */
double drive_torque(const pinion_drive *drive, double time);

#endif
