/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "drive.h"
#include "memory.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

static const double rad_per_s = 3.14159265358979323846 / 30.0; /* of 1 rpm */

/* ---------------------------------------------------------------------------------------------
 * Without ripple
 * ------------------------------------------------------------------------------------------- */

static double steady_angle(const pinion_drive *drive, double time) {
    return drive->table != NULL ? time_table_integral(drive->table, time)
                                : time * (drive->start_speed + 0.5 * drive->acceleration * time);
}

static double steady_speed(const pinion_drive *drive, double time) {
    return drive->table != NULL ? time_table_value(drive->table, time)
                                : drive->start_speed + drive->acceleration * time;
}

static double steady_acceleration(const pinion_drive *drive, double time) {
    return drive->table != NULL ? time_table_slope(drive->table, time) : drive->acceleration;
}

/* ---------------------------------------------------------------------------------------------
 * What the ripple of a speed turns the pinion by
 * ------------------------------------------------------------------------------------------- */

/* Sums that are kept; a solver looks back by a step or two. */
enum { KEPT = 512 };

/* The integral of the ripple at equal steps of time, in which no harmonic turns by more than 1 rad. */
struct rippled_angle {
    double step;       /* (s) */
    int64_t next;      /* first sum that has not been computed */
    double kept[KEPT]; /* sum k at k mod KEPT (rad) */
};

/* Gauss's rule of six points: good to 2e-16 of a harmonic that turns by 1 rad meanwhile. */
static double gauss(const pinion_drive *drive, double from, double to) {
    static const double nodes[3] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
    static const double weights[3] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double sum = 0.0;

    for (int k = 0; k < 3; ++k) {
        const double before = steady_angle(drive, middle - nodes[k] * half);
        const double behind = steady_angle(drive, middle + nodes[k] * half);
        sum += weights[k] *
               (ripple_value(&drive->ripple, before) + ripple_value(&drive->ripple, behind));
    }
    return half * sum;
}

/* From row to row of a table, where the acceleration may jump. */
static double integral_between(const pinion_drive *drive, double from, double to) {
    double sum = 0.0;

    for (double begin = from, end; begin < to; begin = end) {
        int kink;
        end = drive->table != NULL ? fmin(time_table_next_row(drive->table, begin, &kink), to) : to;
        sum += gauss(drive, begin, end);
    }
    return sum;
}

static double turned_by_ripple(const pinion_drive *drive, double time) {
    rippled_angle *turned = drive->turned;
    const double step = turned->step;
    const int64_t k = time > 0.0 ? (int64_t)(time / step) : 0;

    /* Far back: from the beginning again. */
    if (turned->next == 0 || k < turned->next - KEPT) {
        turned->kept[0] = 0.0;
        turned->next = 1;
    }
    while (k >= turned->next) {
        const double begin = (double)(turned->next - 1) * step, end = (double)turned->next * step;
        turned->kept[turned->next % KEPT] =
            turned->kept[(turned->next - 1) % KEPT] + integral_between(drive, begin, end);
        ++turned->next;
    }
    return turned->kept[k % KEPT] + integral_between(drive, (double)k * step, time);
}

static int start_ripple(pinion_drive *drive, const config *conf) {
    const double fastest = ripple_highest_order(&drive->ripple) * drive->fastest;

    if (drive->kind != DRIVE_SPEED || drive->ripple.count == 0) {
        return 0;
    }
    drive->turned = allocate(1, sizeof *drive->turned);
    if (drive->turned == NULL) {
        return EXIT_RUN_FAILED;
    }
    drive->turned->step = fastest * conf->duration > 1.0 ? 1.0 / fastest : conf->duration;
    return 0;
}

/* ---------------------------------------------------------------------------------------------
 * Both
 * ------------------------------------------------------------------------------------------- */

int drive_create(pinion_drive *drive, const config *conf) {
    *drive = (pinion_drive){
        .kind = conf->drive, .start_speed = conf->start_speed, .table = conf->drive_table};

    if (conf->drive == DRIVE_SPEED) {
        drive->acceleration = (conf->end_speed - conf->start_speed) / conf->duration;
        drive->ripple = ripple_scaled(&conf->drive_ripple, rad_per_s);
        drive->fastest = drive->table != NULL
                             ? time_table_largest(drive->table)
                             : fmax(fabs(conf->start_speed), fabs(conf->end_speed));
    } else {
        drive->torque = conf->drive_torque;
        drive->ripple = conf->drive_ripple;
    }
    return start_ripple(drive, conf);
}

void drive_free(pinion_drive *drive) {
    free(drive->turned);
    drive->turned = NULL;
}

drive_motion drive_at(const pinion_drive *drive, double time) {
    drive_motion motion = {
        .angle = steady_angle(drive, time),
        .speed = steady_speed(drive, time),
    };

    if (drive->turned != NULL) {
        motion.speed += ripple_value(&drive->ripple, motion.angle);
        motion.angle += turned_by_ripple(drive, time);
    }
    return motion;
}

double drive_acceleration(const pinion_drive *drive, double time) {
    const double steady = steady_acceleration(drive, time);

    return drive->turned == NULL
               ? steady
               : steady + steady_speed(drive, time) *
                              ripple_slope(&drive->ripple, steady_angle(drive, time));
}

int drive_is_linear(const pinion_drive *drive) {
    return drive->table == NULL && drive->turned == NULL;
}

double drive_jerk(const pinion_drive *drive, double time) {
    const double steady = drive->table != NULL ? time_table_curvature(drive->table, time) : 0.0;
    if (drive->turned == NULL) {
        return steady;
    }

    /* (w A sin'(n phi))' = w' A sin' + w^2 A sin'' at most. */
    const double acceleration =
        drive->table != NULL ? time_table_steepest(drive->table, time) : fabs(drive->acceleration);
    return steady + acceleration * ripple_largest(&drive->ripple, 1) +
           drive->fastest * drive->fastest * ripple_largest(&drive->ripple, 2);
}

double drive_torque(const pinion_drive *drive, double time) {
    return drive->table != NULL ? time_table_value(drive->table, time) : drive->torque;
}
