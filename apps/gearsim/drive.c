/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "drive.h"

pinion_drive drive_create(const config *conf) {
    pinion_drive created = {
        .kind = conf->drive, .start_speed = conf->start_speed, .table = conf->drive_table};

    if (conf->drive == DRIVE_SPEED) {
        created.acceleration = (conf->end_speed - conf->start_speed) / conf->duration;
    } else {
        created.torque = conf->drive_torque;
    }

    return created;
}

drive_motion drive_at(const pinion_drive *drive, double time) {
    if (drive->table != NULL) {
        return (drive_motion){
            .angle = time_table_integral(drive->table, time),
            .speed = time_table_value(drive->table, time),
            .acceleration = time_table_slope(drive->table, time),
        };
    }
    const drive_motion motion = {
        .angle = time * (drive->start_speed + 0.5 * drive->acceleration * time),
        .speed = drive->start_speed + drive->acceleration * time,
        .acceleration = drive->acceleration,
    };

    return motion;
}

double drive_torque(const pinion_drive *drive, double time) {
    return drive->table != NULL ? time_table_value(drive->table, time) : drive->torque;
}
