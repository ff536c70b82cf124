/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file gearsim_case.h
 * The reference gear pair as a configuration of gearsim, for tests below its command line.
 */
#ifndef GEARSIM_CASE_H
#define GEARSIM_CASE_H

#include "gear_mesh.h"
#include "reference_gear.h"

static const double case_wheel_inertia = 2.1e-3, case_pinion_inertia = 1.7e-3; /* kg m2 */

static inline config case_config(enum mesh_model model, enum drive_kind drive) {
    const config conf = {
        .gears = reference_params(REFERENCE_FACE_WIDTH),
        .model = model,
        .stiffness = REFERENCE_STIFFNESS,
        .simple_stiffness = (double)NAN,
        .double_helical_gap = (double)NAN,
        .pinion_bore_radius = (double)NAN,
        .wheel_bore_radius = (double)NAN,
        .pinion_youngs_modulus = 206e9,
        .wheel_youngs_modulus = 206e9,
        .pinion_poisson_ratio = 0.3,
        .wheel_poisson_ratio = 0.3,
        .tip_rounding = 0.05,
        .stations = 17,
        .iso_blank_factor = 1.0,
        .damping = REFERENCE_DAMPING,
        .damping_ratio = (double)NAN,
        .friction_speed = 0.01,
        .pinion_inertia = case_pinion_inertia,
        .wheel_inertia = case_wheel_inertia,
        .drive = drive,
        .start_speed = 100.0,
        .end_speed = 100.0,
        .drive_torque = 22.0,
        .mean_load = 20.0,
        .noise_interval = 1e-5,
        .seed = 1,
        .duration = 1.0,
        .method = METHOD_ADAMS,
    };
    return conf;
}

/* Spring and damper of the simple model [the same eigenfrequency and damping ratio as the 3D model]. */
static inline double case_spring(const gear_mesh *gears) {
    return REFERENCE_STIFFNESS * gears->pair.transverse_contact_ratio;
}

static inline double case_damper(const gear_mesh *gears) {
    return REFERENCE_DAMPING * gears->pair.transverse_contact_ratio;
}

/* Meshes of the whole test program; closed at its end. */
enum { CASE_MESHES = 256 };
static gear_mesh case_meshes[CASE_MESHES];
static int case_mesh_count;

static inline void case_meshes_close(void) {
    while (case_mesh_count > 0) {
        gear_mesh_close(&case_meshes[--case_mesh_count]);
    }
}

/* Ideal flanks. */
static inline gear_mesh case_mesh(const config *conf) {
    if (case_mesh_count == 0) {
        atexit(case_meshes_close);
    }
    gear_mesh *gears = &case_meshes[case_mesh_count++];
    config silent = *conf;
    silent.purpose = CONFIG_FOR_FLANKS; /* without warnings of the drawing, which would name keys */
    GM_ASSERT_INT(gear_mesh_open(gears, &silent), 0);
    return *gears;
}

#endif /* GEARSIM_CASE_H */
