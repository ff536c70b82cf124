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
        .damping = REFERENCE_DAMPING,
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

/* Ideal flanks. */
static inline gear_mesh case_mesh(const config *conf) {
    gear_mesh gears = {.pinion_flanks = NULL};
    gm_pair_init(&gears.pair, &conf->gears);
    gears.simple_stiffness = conf->stiffness * gears.pair.transverse_contact_ratio;
    gears.simple_damping = conf->damping * gears.pair.transverse_contact_ratio;
    return gears;
}

#endif /* GEARSIM_CASE_H */
