/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "static_columns.h"
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

/* Touching part of the face width, summed over the pairs and both flanks. */
static double touching(const static_position *position) {
    return position->mesh.contact.drive_contact + position->mesh.contact.coast_contact;
}

static double mesh_stiffness(const static_position *position) {
    return gm_mesh_touching_stiffness(position->gears->prepared, &position->mesh) * 1e-6;
}

/* Along the lines of contact, which lie at the base helix angle to the face width. */
static double contact_length(const static_position *position) {
    const gm_pair *pair = &position->gears->pair;

    return touching(position) * pair->face_width / cos(pair->base_helix_angle) * 1e3;
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

/* The load tells rows apart only where there are several. */
const static_column static_columns[] = {{"pinion_angle_rad", 0, 0, pinion_angle},
                                        {"te_um", 0, 0, transmission_error},
                                        {"mesh_stiffness_N_per_um", 0, 0, mesh_stiffness},
                                        {"contact_length_mm", 0, 0, contact_length},
                                        {"pairs_in_contact", 0, 0, pairs_in_contact},
                                        {"load_torque_Nm", 1, 0, load_torque},
#define ROW(name, component) {#name, 0, 1, name},
                                        WRENCH_COLUMNS(ROW)
#undef ROW
};

const int static_column_count = sizeof static_columns / sizeof static_columns[0];

int static_column_is_there(const config *conf, int column) {
    return !static_columns[column].of_several_loads || conf->loads > 1;
}

column_names static_column_names(const config *conf) {
    column_names names = {.count = 0};

    for (int i = 0; i < static_column_count; ++i) {
        if (static_column_is_there(conf, i)) {
            names.name[names.count++] = static_columns[i].name;
        }
    }
    return names;
}
