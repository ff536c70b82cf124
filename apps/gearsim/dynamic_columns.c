/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "dynamic_columns.h"
#include "wrench_columns.h"

#include <math.h>
#include <stddef.h>

static const double rpm = 60.0 / 6.283185307179586; /* of 1 rad/s */
static const double micro = 1e6;

static double time_of(const dynamic_sample *sample) {
    return sample->time;
}

static double pinion_speed(const dynamic_sample *sample) {
    return sample->motion.pinion_speed * rpm;
}

static double wheel_speed(const dynamic_sample *sample) {
    return model_wheel_speed(sample->model, &sample->motion) * rpm;
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

static double mean_penetration(const dynamic_sample *sample) {
    return sample->mean_penetration * micro;
}

static double mean_penetration_rate(const dynamic_sample *sample) {
    return sample->mean_rate * micro;
}

static double contact_force(const dynamic_sample *sample) {
    return sample->mesh.force;
}

static double mean_contact_force(const dynamic_sample *sample) {
    return sample->mean_force;
}

static double load(const dynamic_sample *sample) {
    return model_load(sample->model, sample->time, &sample->motion);
}

static double mean_load(const dynamic_sample *sample) {
    return sample->mean_load;
}

static double pairs_in_contact(const dynamic_sample *sample) {
    return sample->pairs;
}

static double apex(const dynamic_sample *sample) {
    return sample->apex * micro;
}

static double stored_energy(const dynamic_sample *sample) {
    return sample->mesh.energy;
}

#define COMPONENT(name, component)                                                                 \
    static double name(const dynamic_sample *sample) {                                             \
        return wrench_component(sample->model->gears, &sample->mesh.wrench, component);            \
    }
WRENCH_COLUMNS(COMPONENT)
#undef COMPONENT

/* Angles, time and the pinion's speed grow steadily, pairs are counts: a filter has nothing to do there. */
const dynamic_column dynamic_columns[] = {
    {"time_s", 0, NEEDS_TIME, time_of, NULL},
    {"pinion_speed_rpm", 0, NEEDS_PINION, pinion_speed, NULL},
    {"wheel_speed_rpm", 1, NEEDS_MOTION, wheel_speed, NULL},
    {"pinion_angle_rad", 0, NEEDS_PINION, pinion_angle, NULL},
    {"wheel_angle_rad", 0, NEEDS_MOTION, wheel_angle, NULL},
    {"dte_um", 1, NEEDS_MOTION, transmission_error, NULL},
    {"penetration_um", 1, NEEDS_MESH, penetration, mean_penetration},
    {"penetration_rate_um_per_s", 1, NEEDS_MESH, penetration_rate, mean_penetration_rate},
    {"contact_force_N", 1, NEEDS_FORCE, contact_force, mean_contact_force},
    {"load_torque_Nm", 1, NEEDS_MOTION, load, mean_load},
    {"pairs_in_contact", 0, NEEDS_PAIRS, pairs_in_contact, NULL},
#define ROW(name, component) {#name, 1, NEEDS_WRENCH, name, NULL},
    WRENCH_COLUMNS(ROW)
#undef ROW
        {"apex_shift_um", 1, NEEDS_MESH, apex, NULL},
    {"stored_energy_J", 1, NEEDS_ENERGY, stored_energy, NULL},
};

const int dynamic_column_count = sizeof dynamic_columns / sizeof dynamic_columns[0];

int dynamic_column_is_there(const config *conf, int column) {
    return dynamic_columns[column].value != apex || !isnan(conf->double_helical_gap);
}

column_names dynamic_column_names(const config *conf) {
    column_names names = {.count = 0};

    for (int i = 0; i < dynamic_column_count; ++i) {
        if (dynamic_column_is_there(conf, i)) {
            names.name[names.count++] = dynamic_columns[i].name;
        }
    }
    return names;
}
