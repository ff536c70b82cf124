/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "static_columns.h"
#include "gear_contact.h"
#include "te_slopes.h"
#include "wrench_columns.h"

#include <math.h>

static const double micro = 1e6;

static double pinion_angle(const static_position *position) {
    return position->pinion_angle;
}

/* te = -x */
static double transmission_error(const static_position *position) {
    return -position->offset * micro;
}

static double mesh_stiffness(const static_position *position) {
    return gear_contact_touching_stiffness(position->gears, &position->mesh) * 1e-6;
}

/* Along the lines of contact, which lie at the base helix angle to the face width. */
static double contact_length(const static_position *position) {
    const gm_pair *pair = &position->gears->pair;
    const gm_penetration *contact = &position->mesh.contact;
    const double width = position->conf->law == LAW_ELASTIC
                             ? position->faces.touching_width
                             : (contact->drive_contact + contact->coast_contact) *
                                   position->gears->halves * pair->face_width;

    return width / cos(pair->base_helix_angle) * 1e3;
}

static double pairs_in_contact(const static_position *position) {
    return position->mesh.contact.drive_pairs + position->mesh.contact.coast_pairs;
}

static double load_torque(const static_position *position) {
    return position->load;
}

#define COMPONENT(name, component)                                                                 \
    static double name(const static_position *position) {                                          \
        return wrench_component(position->gears, &position->mesh.wrench, component);               \
    }
WRENCH_COLUMNS(COMPONENT)
#undef COMPONENT

static double loss(const static_position *position) {
    return position->mesh.loss;
}

static double apex(const static_position *position) {
    return position->apex * micro;
}

static double stored_energy(const static_position *position) {
    return position->mesh.energy;
}

static double face_load_factor(const static_position *position) {
    return position->faces.face_load_factor;
}

static double largest_line_load(const static_position *position) {
    return position->faces.largest_line_load * 1e-3;
}

static double largest_pressure(const static_position *position) {
    return position->faces.largest_pressure * 1e-6;
}

/* The load tells rows apart only where there are several. */
/* clang-format off */
#define ROW(name, component) {#name, ALWAYS, TAKES_WRENCH, name},
const static_column static_columns[] = {
    {"pinion_angle_rad", ALWAYS, TAKES_NOTHING, pinion_angle},
    {"te_um", ALWAYS, TAKES_NOTHING, transmission_error},
    {"mesh_stiffness_N_per_um", ALWAYS, TAKES_NOTHING, mesh_stiffness},
    {"contact_length_mm", ALWAYS, TAKES_WIDTH, contact_length},
    {"pairs_in_contact", ALWAYS, TAKES_NOTHING, pairs_in_contact},
    {"load_torque_Nm", OF_SEVERAL_LOADS, TAKES_NOTHING, load_torque},
    {"face_load_factor", OF_FLANKS, TAKES_FACES, face_load_factor},
    {"largest_line_load_N_per_mm", OF_FLANKS, TAKES_FACES, largest_line_load},
    {"largest_pressure_N_per_mm2", OF_FLANKS, TAKES_FACES, largest_pressure},
    WRENCH_COLUMNS(ROW)
    {"apex_shift_um", OF_DOUBLE_HELICAL, TAKES_NOTHING, apex},
    {"loss_W", OF_FRICTION, TAKES_NOTHING, loss},
    {"stored_energy_J", ALWAYS, TAKES_ENERGY, stored_energy},
};
#undef ROW
/* clang-format on */

const int static_column_count = sizeof static_columns / sizeof static_columns[0];

int static_column_is_there(const config *conf, int column) {
    switch (static_columns[column].use) {
    case OF_SEVERAL_LOADS:
        return conf->loads > 1;
    case OF_FLANKS:
        return conf->model == MODEL_3D;
    case OF_FRICTION:
        return config_has_friction(conf);
    case OF_DOUBLE_HELICAL:
        return !isnan(conf->double_helical_gap);
    case ALWAYS:
    default:
        return 1;
    }
}

column_names static_column_names(const config *conf) {
    column_names names = {.count = 0};

    for (int i = 0; i < static_column_count; ++i) {
        if (static_column_is_there(conf, i)) {
            names.name[names.count++] = static_columns[i].name;
        }
    }
    te_slopes_add_names(conf, &names);
    return names;
}
