/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What moves the pinion: a speed that is linear in time or as a table says, or a torque, constant or as a table says;
 * with ripple on either. The ripple of a speed follows the angle that the pinion would have without it, that of a torque
 * the pinion's own angle.
 */
#ifndef GEARSIM_DRIVE_H
#define GEARSIM_DRIVE_H

#include "time_table.h"

typedef struct rippled_angle rippled_angle;

typedef struct pinion_drive {
    enum drive_kind kind;
    double start_speed;      /* rad/s */
    double acceleration;     /* of a prescribed speed, rad/s2; 0 for a torque */
    double torque;           /* M_p, N m; 0 for a prescribed speed */
    const time_table *table; /* in place of speed or torque, NULL = none */
    ripple ripple;           /* rad/s or N m */
    double fastest;          /* speed without ripple in the run, kind speed only (rad/s) */
    rippled_angle *turned;   /* by the ripple of a speed; NULL without one */
} pinion_drive;

typedef struct drive_motion {
    double angle; /* phi_p, 0 at t = 0 (rad) */
    double speed; /* rad/s */
} drive_motion;

/* Returns 0, or EXIT_RUN_FAILED if there is no memory. */
int drive_create(pinion_drive *drive, const config *conf);
void drive_free(pinion_drive *drive);

/*
 * Prescribed motion of the pinion; goes on beyond the duration of the run. Speed kind only. The angle is the integral of
 * the speed to 1e-14 of what the ripple adds; it costs little where times come about in order, in one thread.
 */
drive_motion drive_at(const pinion_drive *drive, double time);

/* And its acceleration (rad/s2). */
double drive_acceleration(const pinion_drive *drive, double time);

/* Whether the acceleration is the same at all times. */
int drive_is_linear(const pinion_drive *drive);

/* Most that the acceleration changes by per second from a time to the next row of the table (rad/s3). */
double drive_jerk(const pinion_drive *drive, double time);

/* M_p without its ripple at a time (N m). Torque kind only. */
double drive_torque(const pinion_drive *drive, double time);

#endif
