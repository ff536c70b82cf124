/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "wrench_columns.h"

#include <string.h>

enum { X, Y, Z, COMPONENTS };

/* From z = 0 to another z on the same axis: M - z k x F. */
static double moment_at(const double force[COMPONENTS], const double moment[COMPONENTS], double z,
                        int component) {
    switch (component) {
    case X:
        return moment[X] + z * force[Y];
    case Y:
        return moment[Y] - z * force[X];
    default:
        return moment[Z];
    }
}

double wrench_component(const gear_mesh *gears, const gm_wrench *wrench, int component) {
    const gm_gear *pinion = &gears->pair.pinion, *wheel = &gears->pair.wheel;
    const int is_wheel = component >= 2 * COMPONENTS;
    const int is_moment = component % (2 * COMPONENTS) >= COMPONENTS;
    const int k = component % COMPONENTS;
    if (!is_moment) {
        return is_wheel ? wrench->wheel_force[k] : wrench->pinion_force[k];
    }
    if (!is_wheel) {
        const double middle = 0.5 * gear_mesh_face_width(gears, pinion);
        return moment_at(wrench->pinion_force, wrench->pinion_moment, middle, k);
    }
    const double middle =
        wheel->face_start + 0.5 * gear_mesh_face_width(gears, wheel) + gears->wheel_shift;
    return moment_at(wrench->wheel_force, wrench->wheel_moment, middle, k);
}

int is_wrench_column(const char *name) {
#define NAME_OF(column, component) #column,
    static const char *const names[] = {WRENCH_COLUMNS(NAME_OF)};
#undef NAME_OF
    for (size_t k = 0; k < sizeof names / sizeof names[0]; ++k) {
        if (strcmp(names[k], name) == 0) {
            return 1;
        }
    }
    return 0;
}
