/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "gear_contact.h"

#include <math.h>

/* ---------------------------------------------------------------------------------------------
 * At a position
 * ------------------------------------------------------------------------------------------- */

int gear_contact_evaluate(const gear_mesh *mesh, const gm_position *position, int wanted,
                          gm_mesh_result *result) {
    pinion_float *floating = mesh->floating;
    if (floating == NULL) {
        return gm_mesh_evaluate_at(mesh->prepared[0], position, wanted, mesh->workspace[0], result);
    }
    return gm_double_helical_evaluate_at(&floating->gears, position, wanted, &floating->apex,
                                         floating->each, result);
}

int gear_contact_pairs(const gear_mesh *mesh, const gm_position *position, int *pairs) {
    int of_side[2];
    const int status = gm_mesh_pairs_at(mesh->prepared[0], position, mesh->workspace[0], of_side);

    *pairs = of_side[GM_DRIVE] + of_side[GM_COAST];
    return status;
}

int gear_contact_equilibrium(const gear_mesh *mesh, double pinion_angle, double pinion_speed,
                             double wheel_torque, double guess, double *offset,
                             gm_mesh_result *result) {
    pinion_float *floating = mesh->floating;
    if (floating == NULL) {
        return gm_rolling_equilibrium(mesh->prepared[0], pinion_angle, pinion_speed, wheel_torque,
                                      guess, mesh->workspace[0], offset, result);
    }
    return gm_double_helical_equilibrium(&floating->gears, pinion_angle, pinion_speed, wheel_torque,
                                         guess, offset, &floating->apex, floating->each, result);
}

int gear_contact_equilibria(const gear_mesh *mesh, double pinion_angle, double pinion_speed,
                            const double *wheel_torque, int count, double *offset,
                            gm_mesh_result *result) {
    return gm_rolling_equilibria(mesh->prepared[0], pinion_angle, pinion_speed, wheel_torque, count,
                                 GM_WANT_FORCE, mesh->workspace[0], offset, result);
}

int gear_contact_line_loads(const gear_mesh *mesh, const gm_position *position,
                            gm_line_load_point *points, int capacity, gm_line_loads *load) {
    const pinion_float *floating = mesh->floating;
    if (floating == NULL) {
        return gm_mesh_line_loads(mesh->prepared[0], position, mesh->workspace[0], points, capacity,
                                  load);
    }
    return gm_double_helical_line_loads(&floating->gears, position, floating->apex, points,
                                        capacity, load);
}

void gear_contact_warn(const config *conf, const gm_line_loads *load) {
    if (load->warnings & GM_WARN_LOAD_PRESSURE) {
        const char *key = config_text(conf, "load.mean_Nm") != NULL ? "load.mean_Nm" : "load.file";

        config_warn(conf, key,
                    "the contact pressure reaches %.5g N/mm2; beyond 10000 no material stays "
                    "elastic, and the results are those of one that would",
                    1e-6 * load->largest_pressure);
    }
}

int gear_contact_line_load_points(const gear_mesh *mesh) {
    return mesh->halves * gm_mesh_line_load_points(mesh->prepared[0]);
}

double gear_contact_apex(const gear_mesh *mesh) {
    return mesh->floating != NULL ? mesh->floating->apex : (double)NAN;
}

/* ---------------------------------------------------------------------------------------------
 * On average
 * ------------------------------------------------------------------------------------------- */

double gear_contact_mean_stiffness(const gear_mesh *mesh) {
    return mesh->halves * gm_mesh_mean_stiffness(mesh->prepared[0]);
}

double gear_contact_mean_damping(const gear_mesh *mesh) {
    return mesh->halves * gm_mesh_mean_damping(mesh->prepared[0]);
}

double gear_contact_touching_stiffness(const gear_mesh *mesh, const gm_mesh_result *result) {
    return mesh->halves * gm_mesh_touching_stiffness(mesh->prepared[0], result);
}

double gear_contact_penetration(const gear_mesh *mesh, double force, double rate) {
    const gm_mesh_result whole = {.contact = {.drive_contact = 1.0}};
    const double stiffness = gear_contact_touching_stiffness(mesh, &whole);
    const double slowness = gear_contact_mean_damping(mesh) / gear_contact_mean_stiffness(mesh);

    return force / stiffness - slowness * rate;
}

/* ---------------------------------------------------------------------------------------------
 * What flanks can do to meet
 * ------------------------------------------------------------------------------------------- */

double gear_contact_peak(const gear_mesh *mesh, int side) {
    double sum = 0.0;
    for (int half = 0; half < mesh->halves; ++half) {
        for (int gear = GM_PINION; gear <= GM_WHEEL; ++gear) {
            sum += gm_flanks_peak(mesh->flanks[half][gear].prepared, side);
        }
    }
    return sum / mesh->halves;
}

double gear_contact_slope(const gear_mesh *mesh, int side) {
    double sum = 0.0;
    for (int half = 0; half < mesh->halves; ++half) {
        for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
            const gm_gear *gear = role == GM_PINION ? &mesh->pair.pinion : &mesh->pair.wheel;
            sum += gm_flanks_profile_slope(mesh->flanks[half][role].prepared, side) /
                   fabs(gear->tip_roll_length - gear->start_roll_length);
        }
    }
    return sum / mesh->halves;
}

int gear_contact_is_ideal(const gear_mesh *mesh) {
    for (int half = 0; half < mesh->halves; ++half) {
        if (mesh->flanks[half][GM_PINION].prepared != NULL ||
            mesh->flanks[half][GM_WHEEL].prepared != NULL) {
            return 0;
        }
    }
    return 1;
}
