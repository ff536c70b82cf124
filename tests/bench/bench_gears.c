/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "bench_gears.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "shared.h"

static const double degree = 0.017453292519943295;
static const double two_pi = 6.283185307179586;
static const double micro = 1e-6;

/* Of the reference pair. The relatives get the same transverse contact ratio by their tips. */
static const double contact_ratio = 2.123601;

/* Twelve uniform numbers less six: near enough to normal, and without logarithms. */
static double normal(uint64_t *seed) {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) {
        sum += gmi_random_unit(seed);
    }
    return sum;
}

static void stop(const char *what, const char *why) {
    fprintf(stderr, "gearmesh_bench: %s: %s\n", what, why);
    exit(1);
}

void bench_check(int status, const char *what) {
    if (status != GM_OK) {
        stop(what, gm_status_text(status));
    }
}

static void *allocate(size_t size) {
    void *memory = malloc(size);
    if (memory == NULL) {
        stop("memory", "none left");
    }
    return memory;
}

bench_params bench_params_default(void) {
    const bench_params params = {45, 41, 33.0, 21, 31, BENCH_NO_RELIEFS, 0.0};
    return params;
}

/* ---------------------------------------------------------------------------------------------
 * Pair
 * ------------------------------------------------------------------------------------------- */

/* Tips that give the contact ratio, with both gears' halves of the path equal. */
static void set_tips(gm_pair_params *params) {
    gm_pair pair;
    params->pinion_tip_radius = params->wheel_tip_radius = (double)NAN;
    bench_check(gm_pair_init(&pair, params), "pair");
    const double half_path = 0.5 * contact_ratio * pair.transverse_base_pitch;
    const double climb = tan(pair.working_pressure_angle);
    params->pinion_tip_radius =
        hypot(pair.pinion.base_radius, pair.pinion.base_radius * climb + half_path);
    params->wheel_tip_radius =
        hypot(pair.wheel.base_radius, pair.wheel.base_radius * climb + half_path);
}

static void make_pair(gm_pair *pair, const bench_params *wanted) {
    const bench_params reference = bench_params_default();
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = wanted->pinion_teeth;
    params.wheel_teeth = wanted->wheel_teeth;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 16.0 * degree;
    params.helix_angle = wanted->helix_angle_deg * degree;
    params.face_width = 17.5e-3;
    params.backlash = 100.0 * micro;
    if (wanted->pinion_teeth == reference.pinion_teeth &&
        wanted->wheel_teeth == reference.wheel_teeth &&
        wanted->helix_angle_deg == reference.helix_angle_deg) {
        params.center_distance = 85e-3;
        params.pinion_tip_radius = 46.938390e-3;
        params.wheel_tip_radius = 43.003591e-3;
    } else {
        params.center_distance = 0.5 * params.normal_module *
                                 (params.pinion_teeth + params.wheel_teeth) /
                                 cos(params.helix_angle);
        set_tips(&params);
    }
    bench_check(gm_pair_init(pair, &params), "pair");
}

/* ---------------------------------------------------------------------------------------------
 * Flanks: the recipe of data/paper/README.md
 * ------------------------------------------------------------------------------------------- */

static void make_table(double *values, int face_nodes, int profile_nodes, uint64_t *seed) {
    const double slope_profile = 1.0 * normal(seed), slope_face = 2.0 * normal(seed);
    const double crown_profile = 1.0 * (1.0 + 0.3 * normal(seed));
    const double crown_face = 3.0 * (1.0 + 0.3 * normal(seed));
    const double wave_profile = 0.4 * (0.5 + gmi_random_unit(seed));
    const double wave_face = 0.4 * (0.5 + gmi_random_unit(seed));
    const double waves_profile = 1.0 + 2.0 * gmi_random_unit(seed);
    const double waves_face = 1.0 + 2.0 * gmi_random_unit(seed);
    const double start_profile = two_pi * gmi_random_unit(seed);
    const double start_face = two_pi * gmi_random_unit(seed);
    const double foot = 6.0 * normal(seed);

    double *along_face = allocate((size_t)face_nodes * sizeof *along_face);
    for (int face = 0; face < face_nodes; ++face) {
        const double t1 = (double)face / (face_nodes - 1), u = 2.0 * t1 - 1.0;
        along_face[face] = 0.5 * slope_face * u - crown_face * u * u +
                           wave_face * sin(two_pi * waves_face * t1 + start_face);
    }
    for (int profile = 0; profile < profile_nodes; ++profile) {
        const double t2 = (double)profile / (profile_nodes - 1), v = 2.0 * t2 - 1.0;
        const double tip = fmax(0.0, (t2 - 0.8) / 0.2);
        const double along_profile =
            0.5 * slope_profile * v - crown_profile * v * v +
            wave_profile * sin(two_pi * waves_profile * t2 + start_profile) +
            foot * fmax(0.0, 1.0 - t2 / 0.35) - 4.0 * tip * tip;
        for (int face = 0; face < face_nodes; ++face) {
            const double rough = 0.6 * (gmi_random_unit(seed) - 0.5); /* rms 0.17 */
            values[face * profile_nodes + profile] =
                micro * (along_face[face] + along_profile + rough);
        }
    }
    free(along_face);
}

static gm_flanks *make_flanks(const gm_pair *pair, int teeth, const bench_params *params,
                              uint64_t *seed) {
    gm_flanks *flanks;
    const gm_flanks_params sizes = {teeth,
                                    teeth,
                                    params->face_nodes,
                                    params->profile_nodes,
                                    teeth,
                                    params->face_nodes,
                                    params->profile_nodes};
    const size_t size = gm_flanks_size(&sizes);
    double *values =
        allocate((size_t)params->face_nodes * (size_t)params->profile_nodes * sizeof *values);
    bench_check(gm_flanks_init(&flanks, &sizes, allocate(size), size), "flanks");

    /* Every tooth has tables of its own, and a pitch that scatters about the run-out. */
    const double eccentric = two_pi * gmi_random_unit(seed);
    for (int tooth = 0; tooth < teeth; ++tooth) {
        const double pitch = normal(seed) + 8.0 * sin(two_pi * tooth / teeth + eccentric);
        for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
            make_table(values, params->face_nodes, params->profile_nodes, seed);
            bench_check(
                gm_flanks_set_table(flanks, side, tooth, values, pair->normal_to_transverse),
                "table");
            bench_check(gm_flanks_set_pitch(flanks, side, tooth,
                                            side == GM_DRIVE ? pitch * micro : -pitch * micro),
                        "pitch");
        }
    }
    free(values);
    return flanks;
}

/* ---------------------------------------------------------------------------------------------
 * Linear reliefs
 * ------------------------------------------------------------------------------------------- */

enum { RELIEFS = 3 };

static void list_reliefs(gm_modification list[RELIEFS]) {
    static const int kinds[RELIEFS] = {GM_MOD_TIP_RELIEF, GM_MOD_TIP_CORNER_I,
                                       GM_MOD_TIP_CORNER_II};
    for (int k = 0; k < RELIEFS; ++k) {
        const gm_modification relief = {
            kinds[k], GM_SHAPE_LINEAR, GM_RANGE_SHARE, (k == 0 ? 10.0 : 15.0) * micro, 4e-3, 0.3};
        list[k] = relief;
    }
}

static void set_ramps(gm_flanks *flanks, const gm_modifications *reliefs, double factor) {
    gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX];
    gm_modification rest[RELIEFS];
    int count, rest_count;
    bench_check(gm_modifications_split(reliefs, ramps, &count, rest, &rest_count), "ramps");
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        bench_check(gm_flanks_set_ramps(flanks, side, ramps, count, factor), "ramps");
    }
}

/* Flanks without tables, or with the finest table of the reliefs that gearsim would have taken. */
static gm_flanks *make_relief_flanks(const gm_modifications *reliefs, int in_table, double factor) {
    gm_flanks *flanks;
    gm_modifications_grid grid;
    bench_check(gm_modifications_grid_find(reliefs, 2, 2, 1e-8, &grid), "grid");
    const gm_flanks_params sizes = {.teeth = reliefs->gear->teeth,
                                    .drive_tables = in_table,
                                    .drive_face_nodes = grid.face_nodes,
                                    .drive_profile_nodes = grid.profile_nodes,
                                    .coast_tables = in_table,
                                    .coast_face_nodes = grid.face_nodes,
                                    .coast_profile_nodes = grid.profile_nodes};
    const size_t size = gm_flanks_size(&sizes);
    const size_t nodes = (size_t)grid.face_nodes * (size_t)grid.profile_nodes;
    bench_check(gm_flanks_init(&flanks, &sizes, allocate(size), size), "flanks");
    if (!in_table) {
        return flanks;
    }

    /* One table of the reliefs for all teeth. */
    double *values = allocate(nodes * sizeof *values);
    for (size_t k = 0; k < nodes; ++k) {
        values[k] = 0.0;
    }
    bench_check(gm_modifications_add(reliefs, grid.face_nodes, grid.profile_nodes, values),
                "table");
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        bench_check(gm_flanks_set_table(flanks, side, GM_ALL_TEETH, values, factor), "table");
    }
    free(values);
    return flanks;
}

static void make_reliefs(bench_gears *gears, const bench_params *params) {
    const gm_pair *pair = &gears->pair;
    const gm_gear *const gear[2] = {&pair->pinion, &pair->wheel};
    for (int k = 0; k < 2; ++k) {
        gm_modification list[RELIEFS];
        const gm_modifications reliefs = {list, RELIEFS, gear[k], pair->face_width};
        list_reliefs(list);
        if (params->profile_nodes == 0) {
            gears->flanks[k] = make_relief_flanks(&reliefs, params->reliefs == BENCH_RELIEF_TABLE,
                                                  pair->normal_to_transverse);
        }
        if (params->reliefs == BENCH_RAMPS) {
            set_ramps(gears->flanks[k], &reliefs, pair->normal_to_transverse);
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * States
 * ------------------------------------------------------------------------------------------- */

/* Crossings of the grid lines in (from, to), v = origin + rate t. */
static double crossings(double origin, double rate, double from, double to) {
    return fabs(floor(origin + rate * to) - floor(origin + rate * from));
}

/* Lines of contact of the drive side and their smooth pieces: 1 + the grid lines crossed. */
static void count_pieces(bench_gears *gears, const gm_position *position,
                         const bench_params *params) {
    const gm_pair *pair = &gears->pair;

    /* The path of contact in rho_p, and nodes per length on the profile of each gear. */
    const double delta = position->offset - 0.5 * pair->backlash;
    const double reach = pair->line_of_action + delta;
    const double lower = fmax(pair->pinion.start_roll_length, reach - pair->wheel.tip_roll_length);
    const double upper = fmin(pair->pinion.tip_roll_length, reach - pair->wheel.start_roll_length);
    const double face_lines = params->face_nodes - 1;
    const double pinion_scale = (params->profile_nodes - 1) /
                                (pair->pinion.tip_roll_length - pair->pinion.start_roll_length);
    const double wheel_scale =
        (params->profile_nodes - 1) / (pair->wheel.tip_roll_length - pair->wheel.start_roll_length);

    for (int k = -20; k <= 20; ++k) {
        /* The part of line k that lies on the path and on the face. */
        const double origin =
            pair->phase_origin[GM_DRIVE] + position->phase + k * pair->transverse_base_pitch;
        const double at_lower = (lower - origin) / pair->face_advance;
        const double at_upper = (upper - origin) / pair->face_advance;
        const double from = fmax(0.0, fmin(at_lower, at_upper));
        const double to = fmin(1.0, fmax(at_lower, at_upper));
        if (!(from < to)) {
            continue;
        }

        /* It is one piece, and one more for each line of a grid that it crosses. */
        gears->mean_lines += 1.0;
        gears->mean_pieces += 1.0;
        if (params->profile_nodes == 0) {
            continue;
        }
        gears->mean_pieces +=
            crossings(0.0, face_lines, from, to) +
            crossings((origin - pair->pinion.start_roll_length) * pinion_scale,
                      pair->face_advance * pinion_scale, from, to) +
            crossings((reach - origin - pair->wheel.start_roll_length) * wheel_scale,
                      -pair->face_advance * wheel_scale, from, to);
    }
}

/* All over the hunting period, in no order. */
static void make_states(bench_gears *gears, const bench_params *params) {
    uint64_t seed = 7;
    gears->mean_sum = gears->mean_pieces = gears->mean_lines = 0.0;
    for (int k = 0; k < BENCH_STATES; ++k) {
        const double angle =
            params->first_angle + gmi_random_unit(&seed) * two_pi * params->wheel_teeth;
        double offset;
        gm_mesh_result result;
        bench_check(gm_static_equilibrium(gears->mesh, angle, BENCH_TORQUE, (double)NAN, NULL,
                                          &offset, &result),
                    "equilibrium");
        const gm_state state = {angle,
                                (gears->pair.pinion.base_radius * angle - offset) /
                                    gears->pair.wheel.base_radius,
                                100.0, 100.0 * params->pinion_teeth / params->wheel_teeth};
        gears->states[k] = state;
        bench_check(gm_position_from_state(&gears->pair, &state, &gears->positions[k]), "position");
        gears->mean_sum += result.contact.penetration;
        count_pieces(gears, &gears->positions[k], params);
    }
    gears->mean_sum /= BENCH_STATES;
    gears->mean_pieces /= BENCH_STATES;
    gears->mean_lines /= BENCH_STATES;
}

static void make_mesh(bench_gears *gears) {
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.stiffness = BENCH_STIFFNESS;
    params.damping = BENCH_DAMPING;
    const size_t size = gm_mesh_size(&params, &gears->pair);
    bench_check(gm_mesh_init(&gears->mesh, &params, &gears->pair, gears->flanks[GM_PINION],
                             gears->flanks[GM_WHEEL], allocate(size), size),
                "mesh");
}

void bench_gears_make(bench_gears *gears, const bench_params *params) {
    uint64_t seed = 1;
    make_pair(&gears->pair, params);
    gears->flanks[GM_PINION] = gears->flanks[GM_WHEEL] = NULL;
    if (params->profile_nodes > 0) {
        gears->flanks[GM_PINION] = make_flanks(&gears->pair, params->pinion_teeth, params, &seed);
        gears->flanks[GM_WHEEL] = make_flanks(&gears->pair, params->wheel_teeth, params, &seed);
    }
    if (params->reliefs != BENCH_NO_RELIEFS) {
        make_reliefs(gears, params);
    }
    make_mesh(gears);
    make_states(gears, params);
}

void bench_gears_free(bench_gears *gears) {
    free(gears->mesh); /* each object begins at its memory */
    free(gears->flanks[GM_PINION]);
    free(gears->flanks[GM_WHEEL]);
}
