/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "dynamic_columns.h"

static const double rpm = 60.0 / 6.283185307179586; /* of 1 rad/s */
static const double micro = 1e6;

static double time_of(const dynamic_sample *sample) {
    return sample->time;
}

static double pinion_speed(const dynamic_sample *sample) {
    return sample->motion.pinion_speed * rpm;
}

/* From x' = r_bp phi_p' - r_bw phi_w'. */
static double wheel_speed(const dynamic_sample *sample) {
    const gm_pair *pair = &sample->model->gears->pair;
    const double r_bp = pair->pinion.base_radius;
    const double r_bw = pair->wheel.base_radius;

    return (r_bp * sample->motion.pinion_speed - sample->motion.offset_rate) / r_bw * rpm;
}

static double pinion_angle(const dynamic_sample *sample) {
    return sample->motion.pinion_angle;
}

static double wheel_angle(const dynamic_sample *sample) {
    const gm_pair *pair = &sample->model->gears->pair;
    const double r_bp = pair->pinion.base_radius;
    const double r_bw = pair->wheel.base_radius;

    return (r_bp * sample->motion.pinion_angle - sample->motion.offset) / r_bw;
}

/* Dynamic transmission error, -x. */
static double transmission_error(const dynamic_sample *sample) {
    return -sample->motion.offset * micro;
}

static double penetration(const dynamic_sample *sample) {
    return sample->mesh.contact.penetration * micro;
}

static double penetration_rate(const dynamic_sample *sample) {
    return sample->mesh.contact.rate * micro;
}

static double contact_force(const dynamic_sample *sample) {
    return sample->mesh.force;
}

static double load(const dynamic_sample *sample) {
    return load_torque(&sample->model->load, sample->time);
}

static double pairs_in_contact(const dynamic_sample *sample) {
    return sample->mesh.contact.drive_pairs + sample->mesh.contact.coast_pairs;
}

/* Angles, time and the pinion's speed grow steadily, pairs are counts: a filter has nothing to do there. */
const dynamic_column dynamic_columns[] = {
    {"time_s", 0, NEEDS_NOTHING, time_of},
    {"pinion_speed_rpm", 0, NEEDS_NOTHING, pinion_speed},
    {"wheel_speed_rpm", 1, NEEDS_NOTHING, wheel_speed},
    {"pinion_angle_rad", 0, NEEDS_NOTHING, pinion_angle},
    {"wheel_angle_rad", 0, NEEDS_NOTHING, wheel_angle},
    {"dte_um", 1, NEEDS_NOTHING, transmission_error},
    {"penetration_um", 1, NEEDS_MESH, penetration},
    {"penetration_rate_um_per_s", 1, NEEDS_MESH, penetration_rate},
    {"contact_force_N", 1, NEEDS_MESH, contact_force},
    {"load_torque_Nm", 1, NEEDS_NOTHING, load},
    {"pairs_in_contact", 0, NEEDS_PAIRS, pairs_in_contact},
};

const int dynamic_column_count = sizeof dynamic_columns / sizeof dynamic_columns[0];

column_names dynamic_column_names(void) {
    column_names names = {.count = dynamic_column_count};

    for (int i = 0; i < dynamic_column_count; ++i) {
        names.name[i] = dynamic_columns[i].name;
    }
    return names;
}
