/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Any bytes as drawing, flanks and state: every result is finite, or there is a status and every result is
 * NaN. The first byte says which of the numbers are raw bits and which lie near a real gear pair, as raw bits
 * alone hardly ever get beyond the checks.
 */
#include "fuzz.h"

#include <gearmesh/gearmesh.h>
#include <math.h>

enum raw_numbers {
    RAW_PARAMS = 1,
    RAW_STATE = 2,
    RAW_DEVIATIONS = 4,
    RAW_TEETH = 8,
    EXTREME = 16,
    POSED = 32,
    RING = 64,
    ELASTIC = 128
};

static void take_params(fuzz_bytes *bytes, int how, gm_pair_params *params) {
    gm_pair_params_default(params);
    if (how & RAW_TEETH) {
        fuzz_take(bytes, &params->pinion_teeth, sizeof params->pinion_teeth);
        fuzz_take(bytes, &params->wheel_teeth, sizeof params->wheel_teeth);
        fuzz_take(bytes, &params->base_helix, sizeof params->base_helix);
    } else {
        params->pinion_teeth = 3 + fuzz_byte(bytes);
        params->wheel_teeth = 3 + fuzz_byte(bytes);
        if (how & RING) {
            params->wheel_teeth = -params->wheel_teeth - params->pinion_teeth;
        }
        params->base_helix = fuzz_byte(bytes) & 1;
    }

    double *const fields[] = {
        &params->normal_module,
        &params->normal_pressure_angle,
        &params->helix_angle,
        &params->center_distance,
        &params->face_width,
        &params->pinion_face_width,
        &params->wheel_face_width,
        &params->axial_offset,
        &params->pinion_rack_addendum,
        &params->wheel_rack_addendum,
        &params->pinion_rack_dedendum,
        &params->wheel_rack_dedendum,
        &params->pinion_rack_fillet_radius,
        &params->wheel_rack_fillet_radius,
        &params->pinion_tip_alteration,
        &params->wheel_tip_alteration,
        &params->pinion_profile_shift,
        &params->wheel_profile_shift,
        &params->backlash,
        &params->pinion_normal_thickness,
        &params->wheel_normal_thickness,
        &params->pinion_tip_radius,
        &params->wheel_tip_radius,
        &params->pinion_start_radius,
        &params->wheel_start_radius,
    };
    if (how & RAW_PARAMS) {
        for (size_t k = 0; k < sizeof fields / sizeof *fields; ++k) {
            *fields[k] = fuzz_any(bytes);
        }
        return;
    }

    /* Near a real pair; lengths scale with the module, optional fields are mostly left out. */
    const double m = how & EXTREME ? pow(10.0, fuzz_between(bytes, -7.0, 7.0)) : 1e-3;
    const double helix = fuzz_byte(bytes) & 1 ? 0.0 : fuzz_between(bytes, -1.0, 1.0);
    const double rp = 0.5 * m * params->pinion_teeth / cos(helix);
    const double outwards = params->wheel_teeth < 0 ? -1.0 : 1.0;
    const double rw = 0.5 * m * fabs((double)params->wheel_teeth) / cos(helix);
    const uint8_t given = fuzz_byte(bytes);

    params->normal_module = m;
    params->normal_pressure_angle = fuzz_between(bytes, 0.01, 0.78);
    params->helix_angle = helix;
    params->center_distance = fabs(rp + outwards * rw) * fuzz_between(bytes, 0.9, 1.1);
    params->face_width = m * fuzz_between(bytes, 0.01, 40.0);

    /* Shifts, backlash, radii and thickness, ... */
    if (given & 1) {
        params->pinion_profile_shift = fuzz_between(bytes, -1.0, 1.5);
    }
    if (given & 2) {
        params->wheel_profile_shift = fuzz_between(bytes, -1.0, 1.5);
    }
    if (given & 4) {
        params->backlash = m * fuzz_between(bytes, -0.2, 0.5);
    }
    if (given & 8) {
        params->pinion_tip_radius = rp + m * fuzz_between(bytes, -1.0, 2.0);
    }
    if (given & 16) {
        params->wheel_tip_radius = rw + outwards * m * fuzz_between(bytes, -1.0, 2.0);
    }
    if (given & 32) {
        params->pinion_start_radius = rp + m * fuzz_between(bytes, -3.0, 1.0);
    }
    if (given & 64) {
        params->wheel_start_radius = rw + outwards * m * fuzz_between(bytes, -3.0, 1.0);
    }
    if (given & 128) {
        params->pinion_normal_thickness = m * fuzz_between(bytes, 0.5, 2.5);
    }

    /* ... racks, alterations and faces. */
    const uint8_t drawn = fuzz_byte(bytes);
    if (drawn & 1) {
        params->pinion_rack_addendum = fuzz_between(bytes, 0.0, 2.0);
    }
    if (drawn & 2) {
        params->wheel_rack_dedendum = fuzz_between(bytes, 0.0, 2.5);
    }
    if (drawn & 4) {
        params->pinion_rack_fillet_radius = fuzz_between(bytes, 0.0, 1.0);
    }
    if (drawn & 8) {
        params->wheel_tip_alteration = fuzz_between(bytes, -1.0, 0.5);
    }
    if (drawn & 16) {
        params->pinion_face_width = m * fuzz_between(bytes, 0.01, 40.0);
    }
    if (drawn & 32) {
        params->wheel_face_width = m * fuzz_between(bytes, 0.01, 40.0);
    }
    if (drawn & 64) {
        params->axial_offset = m * fuzz_between(bytes, -20.0, 20.0);
    }
    if (drawn & 128) {
        params->face_width = (double)NAN;
    }
}

/* A few tables, pitch deviations and ramps; NULL if the bytes ask for ideal flanks. */
static gm_flanks *take_flanks(fuzz_bytes *bytes, int how, int teeth, double m) {
    gm_flanks *flanks;
    const gm_flanks_params params = {
        .teeth = teeth,
        .drive_tables = fuzz_byte(bytes) % 4,
        .drive_face_nodes = 2 + fuzz_byte(bytes) % 4,
        .drive_profile_nodes = 2 + fuzz_byte(bytes) % 4,
        .coast_tables = fuzz_byte(bytes) % 4,
        .coast_face_nodes = 2 + fuzz_byte(bytes) % 4,
        .coast_profile_nodes = 2 + fuzz_byte(bytes) % 4,
    };
    const size_t memory_size = gm_flanks_size(&params);
    void *memory = memory_size > 0 ? malloc(memory_size) : NULL;
    if (memory == NULL || gm_flanks_init(&flanks, &params, memory, memory_size) != GM_OK) {
        free(memory);
        return NULL;
    }

    /* Tables and pitch deviations, for sides and teeth that may not exist. */
    for (int calls = fuzz_byte(bytes) % 8; calls > 0; --calls) {
        double values[25];
        for (int k = 0; k < 25; ++k) {
            values[k] =
                how & RAW_DEVIATIONS ? fuzz_any(bytes) : m * fuzz_between(bytes, -0.02, 0.02);
        }
        const int side = fuzz_byte(bytes) % 3;
        const int tooth = fuzz_byte(bytes) - 1;
        const int status = fuzz_byte(bytes) & 1
                               ? gm_flanks_set_table(flanks, side, tooth, values, 1.0)
                               : gm_flanks_set_pitch(flanks, side, tooth, values[0]);
        FUZZ_CLAIM(status == GM_OK || status == GM_ERR_TOOTH || status == GM_ERR_MEMORY ||
                   status == GM_ERR_DEVIATION);
    }

    /* Ramps on both sides. */
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX];
        const int count = fuzz_byte(bytes) % (GM_FLANK_RAMPS_MAX + 1);
        for (int k = 0; k < count; ++k) {
            double *const fields[] = {&ramps[k].offset, &ramps[k].per_t1, &ramps[k].per_t2};
            for (int field = 0; field < 3; ++field) {
                *fields[field] =
                    how & RAW_DEVIATIONS ? fuzz_any(bytes) : m * fuzz_between(bytes, -0.1, 0.1);
            }
        }
        const int status = gm_flanks_set_ramps(flanks, side, ramps, count, 1.0);
        FUZZ_CLAIM(status == GM_OK || status == GM_ERR_DEVIATION);
    }
    return flanks;
}

/* All finite on success, all NaN on any error. */
static void claim_numbers(int status, const double *numbers, size_t count) {
    for (size_t k = 0; k < count; ++k) {
        FUZZ_CLAIM(status == GM_OK ? isfinite(numbers[k]) : isnan(numbers[k]));
    }
}

static void claim_penetration(int status, const gm_penetration *result) {
    const double numbers[] = {
        result->penetration,    result->rate,          result->drive,         result->coast,
        result->drive_rate,     result->coast_rate,    result->drive_contact, result->coast_contact,
        result->d_pinion_angle, result->d_wheel_angle,
    };
    claim_numbers(status, numbers, sizeof numbers / sizeof *numbers);
    if (status == GM_OK) {
        FUZZ_CLAIM(result->drive >= 0.0 && result->coast >= 0.0);
        FUZZ_CLAIM(result->drive_contact >= 0.0 && result->coast_contact >= 0.0);
        FUZZ_CLAIM(result->drive_pairs >= 0 && result->coast_pairs >= 0);
    } else {
        FUZZ_CLAIM(result->drive_pairs == 0 && result->coast_pairs == 0);
    }
}

static void claim_result(int status, const gm_mesh_result *result) {
    const double numbers[] = {result->force,
                              result->pinion_torque,
                              result->wheel_torque,
                              result->drive_force,
                              result->coast_force,
                              result->force_by.pinion_angle,
                              result->force_by.wheel_angle,
                              result->force_by.pinion_speed,
                              result->force_by.wheel_speed};
    claim_numbers(status, numbers, sizeof numbers / sizeof *numbers);
    claim_penetration(status, &result->contact);
    claim_numbers(status, result->wrench.pinion_force, 3);
    claim_numbers(status, result->wrench.pinion_moment, 3);
    claim_numbers(status, result->wrench.wheel_force, 3);
    claim_numbers(status, result->wrench.wheel_moment, 3);
    if (status == GM_OK) {
        FUZZ_CLAIM(result->drive_force >= 0.0 && result->coast_force >= 0.0);
    }
}

/* Elastic teeth of any material: refused, or every answer is a number or has a status. */
static void claim_elastic(fuzz_bytes *bytes, int how, const gm_pair *pair, const gm_flanks *pinion,
                          const gm_flanks *wheel, const gm_state *state) {
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.law = GM_LAW_ELASTIC;
    law.damping = 1e3;
    law.stations = 2 + fuzz_byte(bytes) % 20;
    law.corner_contact = fuzz_byte(bytes) % 4 == 0 ? GM_CORNER_OFF : GM_CORNER_BY_LAW;
    law.tip_rounding = pow(10.0, -3.0 * fuzz_byte(bytes) / 255.0);
    if (how & RAW_STATE) {
        law.pinion_youngs_modulus = fuzz_any(bytes);
        law.wheel_poisson_ratio = fuzz_any(bytes);
        law.reference_torque = fuzz_any(bytes);
        law.wheel_bore_radius = fuzz_any(bytes);
        law.tip_rounding = fuzz_byte(bytes) % 2 == 0 ? law.tip_rounding : fuzz_any(bytes);
    }
    const size_t size = gm_mesh_size(&law, pair);
    void *memory = malloc(size + 1);
    gm_mesh *mesh = NULL;
    const int made = gm_mesh_init(&mesh, &law, pair, pinion, wheel, memory, size);
    FUZZ_CLAIM((made == GM_OK) == (mesh != NULL));
    if (made == GM_OK) {
        const size_t room = gm_workspace_size(mesh);
        void *workspace_memory = malloc(room + 1);
        gm_workspace *workspace = NULL;
        gm_mesh_result result;
        FUZZ_CLAIM(gm_workspace_init(&workspace, mesh, workspace_memory, room) == GM_OK);
        const int all = GM_WANT_DERIVATIVES | GM_WANT_WRENCH | GM_WANT_PAIRS;
        const int evaluated = gm_mesh_evaluate(mesh, state, all, workspace, &result);

        /* An edge of three teeth that is pressed in by half a millimetre slides off: the force falls then. */
        if (law.corner_contact == GM_CORNER_BY_LAW && evaluated == GM_OK) {
            FUZZ_CLAIM(isfinite(result.contact.drive_contact) &&
                       isfinite(result.contact.coast_contact));
            result.contact.drive_contact = fmax(0.0, result.contact.drive_contact);
            result.contact.coast_contact = fmax(0.0, result.contact.coast_contact);
        }
        claim_result(evaluated, &result);

        gm_position position;
        gm_line_loads loads;
        if (evaluated == GM_OK && gm_position_from_state(pair, state, &position) == GM_OK) {
            const int loaded = gm_mesh_line_loads(mesh, &position, workspace, NULL, 0, &loads);
            FUZZ_CLAIM(loaded != GM_OK || loads.points >= 0);
        }
        double offset;
        const int found = gm_static_equilibrium(mesh, state->pinion_angle, fuzz_any(bytes),
                                                (double)NAN, workspace, &offset, &result);
        claim_numbers(found, &offset, 1);
        free(workspace_memory);
    }
    free(memory);
}

/* As many points as are promised are enough, and each has a load. */
static void claim_line_loads(const gm_mesh *mesh, const gm_state *state) {
    const int most = gm_mesh_line_load_points(mesh);
    gm_position position;
    gm_line_loads loads;
    if (most > 100000 || gm_position_from_state(gm_mesh_pair(mesh), state, &position) != GM_OK) {
        return;
    }
    gm_line_load_point *points = malloc((size_t)most * sizeof *points);
    const int loaded = gm_mesh_line_loads(mesh, &position, NULL, points, most, &loads);
    FUZZ_CLAIM(loaded != GM_ERR_MEMORY);
    for (int k = 0; loaded == GM_OK && k < loads.points; ++k) {
        FUZZ_CLAIM(points[k].line_load >= 0.0 && isfinite(points[k].line_load));
        FUZZ_CLAIM(isfinite(points[k].gap));
    }
    free(points);
}

/* All derivatives are numbers, or there are none. */
static void claim_tangent(const gm_mesh *mesh, const gm_state *state) {
    gm_motion motion = {.pose = {0.0, 0.0, 0.0, 0.0, 0.0}};
    if (gm_position_from_state(gm_mesh_pair(mesh), state, &motion.position) == GM_OK) {
        gm_tangent tangent;
        const int known = gm_mesh_tangent(mesh, &motion, &tangent);
        claim_numbers(known, tangent.force_by, GM_COORDINATES);
        claim_numbers(known, tangent.wrench_by_rate[GM_SKEW].wheel_moment, 3);
    }
}

/* Tip corners of constant stiffness, with friction of any law: refused, or every answer is a number or has a status. */
static void claim_corners(fuzz_bytes *bytes, int how, const gm_pair *pair, const gm_flanks *pinion,
                          const gm_flanks *wheel, const gm_state *state, const gm_pose *pose) {
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = 1e8;
    law.damping = 1e3;
    law.pose = *pose;
    law.corner_contact = GM_CORNER_ON;
    law.friction_law = fuzz_byte(bytes) % 3;
    law.friction_coefficient = fuzz_between(bytes, 0.0, 1.0);
    law.oil_viscosity = 0.02;
    law.roughness = 1e-6;
    if (how & RAW_STATE) {
        law.friction_speed = fuzz_any(bytes);
        law.oil_viscosity = fuzz_any(bytes);
        law.roughness = fuzz_any(bytes);
    }
    const size_t size = gm_mesh_size(&law, pair);
    void *memory = malloc(size + 1);
    gm_mesh *mesh = NULL;
    const int made = gm_mesh_init(&mesh, &law, pair, pinion, wheel, memory, size);
    FUZZ_CLAIM((made == GM_OK) == (mesh != NULL));
    if (made == GM_OK) {
        gm_mesh_result whole, alone;
        const int all = GM_WANT_DERIVATIVES | GM_WANT_WRENCH | GM_WANT_PAIRS;
        const int evaluated = gm_mesh_evaluate(mesh, state, all, NULL, &whole);
        claim_result(evaluated, &whole);
        claim_numbers(evaluated, &whole.loss, 1);
        FUZZ_CLAIM(evaluated != GM_OK || whole.loss >= 0.0);
        FUZZ_CLAIM(evaluated == gm_mesh_evaluate(mesh, state, GM_WANT_FORCE, NULL, &alone));
        FUZZ_CLAIM(evaluated != GM_OK || (alone.loss >= 0.0 && isfinite(alone.wheel_torque)));
        claim_line_loads(mesh, state);
    }

    /* And without corners the tangent. */
    law.corner_contact = GM_CORNER_OFF;
    if (gm_mesh_init(&mesh, &law, pair, pinion, wheel, memory, size) == GM_OK) {
        claim_tangent(mesh, state);
    }
    free(memory);
}

/* Any numbers, or speeds at a place within 0.6 base pitches of the middle of the backlash. */
static gm_state take_state(fuzz_bytes *bytes, int how, const gm_pair *pair) {
    gm_state state;
    if (how & RAW_STATE) {
        state.pinion_angle = fuzz_any(bytes);
        state.wheel_angle = fuzz_any(bytes);
        state.pinion_speed = fuzz_any(bytes);
        state.wheel_speed = fuzz_any(bytes);
    } else {
        const double x = pair->transverse_base_pitch * fuzz_between(bytes, -0.6, 0.6);
        state.pinion_angle = fuzz_between(bytes, -100.0, 100.0);
        state.wheel_angle =
            (pair->pinion.base_radius * state.pinion_angle - x) / pair->wheel.base_radius;
        state.pinion_speed = fuzz_between(bytes, -1000.0, 1000.0);
        state.wheel_speed = fuzz_between(bytes, -1000.0, 1000.0);
    }
    return state;
}

/* Constant stiffness or the simple model, the wheel where it has moved to. */
static gm_mesh_params take_law(fuzz_bytes *bytes, int how, double m) {
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.model = fuzz_byte(bytes) % 8 == 0 ? GM_MODEL_SIMPLE : GM_MODEL_3D;
    law.stiffness = how & RAW_STATE ? fuzz_any(bytes) : 1e8;
    law.damping = how & RAW_STATE ? fuzz_any(bytes) : 1e3;

    if (how & POSED) {
        double *const parts[] = {&law.pose.center_distance_change, &law.pose.offset,
                                 &law.pose.axial_shift};
        for (int k = 0; k < 3; ++k) {
            *parts[k] = how & RAW_STATE ? fuzz_any(bytes) : m * fuzz_between(bytes, -2.0, 2.0);
        }
    }
    return law;
}

/* Whatever is wanted, the force is the same. */
static void claim_evaluations(const gm_mesh *mesh, const gm_state *state) {
    const int all = GM_WANT_DERIVATIVES | GM_WANT_WRENCH | GM_WANT_PAIRS;
    gm_mesh_result whole, alone;
    const int evaluated = gm_mesh_evaluate(mesh, state, all, NULL, &whole);
    claim_result(evaluated, &whole);
    FUZZ_CLAIM(evaluated == gm_mesh_evaluate(mesh, state, GM_WANT_FORCE, NULL, &alone));
    FUZZ_CLAIM(evaluated != GM_OK || alone.force == whole.force);
}

static void claim_equilibria(fuzz_bytes *bytes, int how, const gm_mesh *mesh, const gm_pair *pair,
                             double pinion_angle, double stiffness) {
    gm_mesh_result result;
    double offset;
    const double torque = how & RAW_STATE ? fuzz_any(bytes) : fuzz_between(bytes, -1e3, 1e3);
    const int found =
        gm_static_equilibrium(mesh, pinion_angle, torque, (double)NAN, NULL, &offset, &result);
    claim_numbers(found, &offset, 1);
    claim_penetration(found, &result.contact);
    const int again =
        gm_static_equilibrium(mesh, pinion_angle, torque, fuzz_any(bytes), NULL, &offset, &result);
    claim_numbers(again, &offset, 1);
    claim_penetration(again, &result.contact);

    /* Several at once: a number where there is one. */
    const double torques[] = {torque, 0.5 * torque, -torque, fuzz_any(bytes), 0.999 * torque};
    enum { TORQUES = sizeof torques / sizeof torques[0] };
    double offsets[TORQUES];
    const int several = gm_rolling_equilibria(mesh, pinion_angle, 0.0, torques, TORQUES,
                                              GM_WANT_DERIVATIVES | GM_WANT_WRENCH | GM_WANT_PAIRS,
                                              NULL, offsets, NULL);
    int carried = 0;
    for (int k = 0; k < TORQUES; ++k) {
        carried += !isnan(offsets[k]);
        FUZZ_CLAIM(!isinf(offsets[k]));
    }
    FUZZ_CLAIM((several == GM_OK) == (carried == TORQUES));

    /* There is one for any guess or for none, unless it hangs on the rounding of the lengths, or teeth are pressed together
     * or deviate by so much that the sum may fall again. */
    const double length = fabs(torque) / (stiffness * pair->wheel.base_radius);
    const double little = 0.02 * pair->transverse_base_pitch;
    if (!(how & (RAW_DEVIATIONS | POSED)) && pair->transverse_contact_ratio > 0.5 &&
        pair->backlash > -little && length < little && length > 1e-15 * pair->center_distance) {
        FUZZ_CLAIM(again == found);
    }
}

/* All that a pair that can be made is asked. */
static void claim_pair(fuzz_bytes *bytes, int how, const gm_pair *pair, const gm_flanks *pinion,
                       const gm_flanks *wheel, const gm_state *state) {
    gm_penetration result;
    claim_penetration(gm_penetration_simple(pair, state, &result), &result);
    claim_penetration(gm_penetration_3d(pair, pinion, wheel, state, &result), &result);

    /* Far off a posed pair may be refused. */
    const gm_mesh_params law = take_law(bytes, how, pair->normal_module);
    const size_t size = gm_mesh_size(&law, pair);
    void *memory = malloc(size + 1);
    gm_mesh *mesh = NULL;
    const int made = gm_mesh_init(&mesh, &law, pair, pinion, wheel, memory, size);
    FUZZ_CLAIM((made == GM_OK) == (mesh != NULL));
    FUZZ_CLAIM((made == GM_OK) == (size > 0) || ((how & POSED) && size > 0));

    claim_evaluations(mesh, state);
    claim_equilibria(bytes, how, mesh, pair, state->pinion_angle, law.stiffness);
    free(memory);

    if (how & ELASTIC) {
        claim_elastic(bytes, how, pair, pinion, wheel, state);
    }
    claim_corners(bytes, how, pair, pinion, wheel, state, &law.pose);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_bytes bytes = {data, size};
    const int how = fuzz_byte(&bytes);

    /* A pair, or the reason why not. */
    gm_pair_params params;
    take_params(&bytes, how, &params);
    const char *field = "", *requirement = "";
    gm_pair pair;
    const int checked = gm_pair_params_check(&params, &field, &requirement);
    const int status = gm_pair_init(&pair, &params);
    FUZZ_CLAIM(checked == status);
    FUZZ_CLAIM((status == GM_OK) == (field == NULL));
    FUZZ_CLAIM((status == GM_OK) == (isfinite(pair.line_of_action) != 0));
    (void)gm_pair_warnings(&pair, &params);

    gm_flanks *pinion = NULL, *wheel = NULL;
    if (status == GM_OK && fuzz_byte(&bytes) & 1) {
        pinion = take_flanks(&bytes, how, params.pinion_teeth, params.normal_module);
        wheel = take_flanks(&bytes, how, pair.wheel.teeth, params.normal_module);
    }
    if (status == GM_OK) {
        const gm_state state = take_state(&bytes, how, &pair);
        claim_pair(&bytes, how, &pair, pinion, wheel, &state);
    }
    free(pinion); /* they begin at their memory */
    free(wheel);
    return 0;
}
