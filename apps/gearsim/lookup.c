/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "lookup.h"
#include "gear_contact.h"
#include "time_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double two_pi = 6.283185307179586;

/* The tables reach as deep as so many static deflections under the largest load, and what flanks deviate by. */
static const double deepest_deflection = 4.0, deviation = 6e-6;

/* Steps over base pitch and depth, from coarse to fine: libgearmesh/docs/cache.md has their errors. */
typedef struct resolution {
    int phase_cells, depth_cells;
} resolution;

static const resolution resolutions[] = {{8, 16}, {16, 20}, {32, 40}, {64, 40}};
enum { RESOLUTIONS = sizeof resolutions / sizeof resolutions[0] };

/* The solver's error falls below that of the coarsest tables here, and below that of any here; both with a digit's slack. */
static const double coarse_tolerance = 0.999e-4, tightest_tolerance = 0.999e-5;

/* A run evaluates the mesh so often for each tooth pass at a tolerance of 1e-4, or with erk, and for each natural vibration
 * under noise. */
static const double per_pass = 15.0, per_pass_of_erk = 53.0, per_vibration = 10.0;

/* A column takes as long as so many evaluations: by walks along its lines, or for each of its nodes and to find its start. */
static const double per_walked_column = 9.6, per_walked_node = 0.14, per_start = 13.0;

/* Filling is to take at most these parts of the evaluations that it replaces; finer tables are to be next to nothing, and
 * not too large for a processor's cache. */
static const double worth = 0.85, next_to_nothing = 0.25, finer_bytes = 32e6;

/* More is not even prepared to see how much of it a run meets. */
static const double most_bytes = 1e9;

/* ---------------------------------------------------------------------------------------------
 * The gears
 * ------------------------------------------------------------------------------------------- */

static double largest_load(const config *conf) {
    const double steady =
        conf->load_table != NULL ? time_table_largest(conf->load_table) : fabs(conf->mean_load);

    return steady + conf->noise_amplitude + ripple_largest(&conf->load_ripple, 0);
}

static double depth_of(const config *conf, const gear_mesh *gears) {
    const double force = largest_load(conf) / gears->pair.wheel.base_radius;
    const double deflection = force / gm_mesh_mean_stiffness(gears->prepared[0]);
    const double deepest = 0.25 * gears->pair.transverse_base_pitch;

    return isnan(conf->lookup_depth) ? fmin(deepest_deflection * deflection + deviation, deepest)
                                     : conf->lookup_depth;
}

static gm_cache_params params_of(const config *conf, const gear_mesh *gears, int which) {
    gm_cache_params params;

    gm_cache_params_default(&params);
    const double load =
        conf->load_table != NULL ? time_table_value(conf->load_table, 0.0) : conf->mean_load;
    params.side = load < 0.0 ? GM_COAST : GM_DRIVE;
    params.phase_cells = resolutions[which].phase_cells;
    params.depth_cells = resolutions[which].depth_cells;
    params.depth = depth_of(conf, gears);
    return params;
}

static int has_modifications(const config *conf) {
    const modification_values *first = &conf->modifications[0][0][0];
    const size_t count = sizeof conf->modifications / sizeof *first;

    for (size_t i = 0; i < count; ++i) {
        if (!isnan(first[i].value[MODIFICATION_AMOUNT])) {
            return 1;
        }
    }
    return 0;
}

static int is_tilted(const config *conf) {
    return conf->pose.skew != 0.0 || conf->pose.inclination != 0.0;
}

static int has_flanks(const gear_mesh *gears) {
    return gears->flanks[0][GM_PINION].prepared != NULL ||
           gears->flanks[0][GM_WHEEL].prepared != NULL;
}

/* Whether the flanks are tables alone, between parallel axes and as stiff everywhere: columns are then walked. */
static int has_plain_tables(const config *conf, const gear_mesh *gears) {
    return conf->law != LAW_ELASTIC && has_flanks(gears) && !has_modifications(conf) &&
           !is_tilted(conf) && !config_has_corners(conf);
}

/* Even flanks of constant stiffness are sums of series, which no table is faster than; but for what their edges do. */
static int is_dear(const config *conf, const gear_mesh *gears) {
    return conf->law == LAW_ELASTIC || has_flanks(gears) || is_tilted(conf) ||
           config_has_corners(conf);
}

/* Why these gears cannot have tables, NULL if they can: meshes that are not smooth, or have more in them than the tables. */
static const char *obstacle(const config *conf, const gear_mesh *gears) {
    if (gears->pair.face_advance == 0.0) {
        return "must be off for spur gears, whose sum of penetrations jumps (got on)";
    }
    if (gears->halves > 1) {
        return "must be off for double-helical pairs, whose pinion floats (got on)";
    }
    if (config_has_friction(conf)) {
        return "must be off with friction, which the tables do not hold (got on)";
    }
    return NULL;
}

/* ---------------------------------------------------------------------------------------------
 * The run
 * ------------------------------------------------------------------------------------------- */

static double start_of(const time_table *table, double number) {
    return table != NULL ? time_table_value(table, 0.0) : number;
}

/* Mean speed of a torque-driven pinion (rad/s): both bodies as one, under what acts at the start and drags on them. */
static double driven_speed(const config *conf, const gear_mesh *gears) {
    const double ratio = gears->pair.pinion.base_radius / gears->pair.wheel.base_radius;
    const double start = conf->start_speed;
    const double load = start_of(conf->load_table, conf->mean_load);
    const double load_drag =
        conf->load_per_speed + conf->load_per_speed_squared * fabs(ratio * start);

    const double inertia = conf->pinion_inertia + ratio * ratio * conf->wheel_inertia;
    const double drag = conf->pinion_drag + ratio * ratio * (conf->wheel_drag + load_drag);
    const double torque = start_of(conf->drive_table, conf->drive_torque) - ratio * load;
    const double acceleration = (torque - drag * start) / inertia;

    /* It dies away with exp(-drag / inertia t): twice integrated over the run. */
    const double decay = drag / inertia * conf->duration;
    const double share = decay > 1e-3 ? (decay + expm1(-decay)) / (decay * decay) : 0.5;
    return start + share * acceleration * conf->duration;
}

/* Tooth passes of the run, as far as they are known beforehand. */
static double tooth_passes(const config *conf, const gear_mesh *gears) {
    const double duration = conf->duration;
    const double mean_speed = conf->drive == DRIVE_TORQUE ? driven_speed(conf, gears)
                              : conf->drive_table != NULL
                                  ? time_table_integral(conf->drive_table, duration) / duration
                                  : 0.5 * (fabs(conf->start_speed) + fabs(conf->end_speed));

    return fabs(mean_speed) * duration * gears->pair.pinion.teeth / two_pi;
}

/* How often the solver evaluates the mesh. Most rows do without, and pairs in contact are counted in any case. */
static double evaluations(const config *conf, const gear_mesh *gears, double passes) {
    const double finer = fmax(1.0, pow(1e-4 / conf->relative_tolerance, 0.25));
    const double frequency = gear_mesh_eigenfrequency(gears, conf);
    const double shaken = conf->noise_amplitude > 0.0 && isfinite(frequency)
                              ? per_vibration * frequency * conf->duration
                              : 0.0;

    return fmax(shaken, passes * (conf->method == METHOD_ERK ? per_pass_of_erk : per_pass * finer));
}

/* ---------------------------------------------------------------------------------------------
 * The choice
 * ------------------------------------------------------------------------------------------- */

/* The coarsest tables whose error is below the solver's. Elastic teeth share the load from line to line, with steeper kinks. */
static int coarsest_of(const config *conf) {
    return (conf->law == LAW_ELASTIC) + (conf->relative_tolerance < coarse_tolerance);
}

static double columns_of(const config *conf, const gm_cache_params *params,
                         const gear_mesh *gears) {
    const double values = conf->law != LAW_ELASTIC && config_has_corners(conf) ? 6.0 : 4.0;
    const double column =
        (double)sizeof(double) + (params->depth_cells + 1) * values * sizeof(float);

    return floor((double)gm_cache_size(params, gears->prepared[0]) / column);
}

/* Combinations of teeth that differ; 0 if there are more of them than memory. */
static double combinations(const gm_cache_params *params, const gear_mesh *gears) {
    const gm_mesh *mesh = gears->prepared[0];
    const size_t size = gm_cache_size(params, mesh);
    void *memory = size > 0 && (double)size <= most_bytes ? malloc(size) : NULL;
    gm_cache *cache = NULL;

    if (memory != NULL) {
        (void)gm_cache_init(&cache, params, mesh, memory, size);
    }
    const int passes = gm_cache_passes(cache);
    free(memory);
    return passes;
}

/* What a run fills of these tables: of as many tooth passes as it has, as long as they are not the same again. */
static double filling_of(const config *conf, const gear_mesh *gears, const gm_cache_params *params,
                         double met) {
    const double nodes = params->depth_cells + 1;
    const double per_column = has_plain_tables(conf, gears)
                                  ? per_walked_column + per_walked_node * nodes
                                  : per_start + nodes;

    return met * columns_of(conf, params, gears) * per_column;
}

lookup_choice lookup_choose(const config *conf, const gear_mesh *gears) {
    lookup_choice choice = {0};
    if (conf->model != MODEL_3D || conf->analysis != ANALYSIS_DYNAMIC ||
        conf->lookup == LOOKUP_OFF || obstacle(conf, gears) != NULL ||
        (conf->lookup == LOOKUP_AUTO &&
         (!is_dear(conf, gears) || conf->relative_tolerance < tightest_tolerance))) {
        return choice;
    }

    /* The coarsest that will do: elastic teeth that are all alike hardly vibrate, which asks for a finer one. */
    int coarsest = coarsest_of(conf);
    choice.params = params_of(conf, gears, coarsest);
    const double all = combinations(&choice.params, gears);
    if (conf->law == LAW_ELASTIC && all == 1.0) {
        choice.params = params_of(conf, gears, ++coarsest);
    }
    if (all == 0.0) {
        choice.is_used = conf->lookup == LOOKUP_ON;
        return choice;
    }
    const double passes = tooth_passes(conf, gears);
    const double met = conf->lookup_threads > 0 ? 1.0 : fmin(1.0, (passes + 1.0) / all);
    choice.evaluations = evaluations(conf, gears, passes);
    choice.filling = filling_of(conf, gears, &choice.params, met);
    choice.is_used = conf->lookup == LOOKUP_ON || choice.filling < worth * choice.evaluations;

    /* Finer ones where they cost next to nothing. */
    for (int k = coarsest + 1; choice.is_used && k < RESOLUTIONS; ++k) {
        const gm_cache_params finer = params_of(conf, gears, k);
        const double filling = filling_of(conf, gears, &finer, met);
        if (filling <= next_to_nothing * choice.evaluations &&
            (double)gm_cache_size(&finer, gears->prepared[0]) <= finer_bytes) {
            choice.params = finer;
            choice.filling = filling;
        }
    }
    return choice;
}

/* Only who asks for it is told why it cannot be had; `auto` does without. */
static int check(const config *conf, const gear_mesh *gears) {
    const double deepest = 0.25 * gears->pair.transverse_base_pitch;
    const char *reason = obstacle(conf, gears);
    if (reason != NULL) {
        config_complain(conf, "solver.lookup", "%s", reason);
        return EXIT_BAD_INPUT;
    }

    /* What the library takes: deeper than that no tooth is pressed. */
    if (conf->lookup_depth > deepest) {
        config_complain(conf, "solver.lookup_depth_um",
                        "must be at most a quarter of the base pitch, %.9g (got %.9g)",
                        1e6 * deepest, 1e6 * conf->lookup_depth);
        return EXIT_BAD_INPUT;
    }
    return 0;
}

int lookup_note(const gear_mesh *gears, config *conf) {
    if (conf->model != MODEL_3D || conf->analysis != ANALYSIS_DYNAMIC ||
        gears->prepared[0] == NULL) {
        return 0;
    }
    if (conf->lookup == LOOKUP_ON && check(conf, gears) != 0) {
        return EXIT_BAD_INPUT;
    }
    const lookup_choice choice = lookup_choose(conf, gears);
    if (!choice.is_used) {
        return 0;
    }
    if (choice.filling > choice.evaluations) {
        config_remark(conf, "solver.lookup",
                      "off is faster: the run has some %.2g evaluations of the mesh, and filling "
                      "the tables takes as long as %.2g",
                      choice.evaluations, choice.filling);
    }

    char text[120];
    snprintf(text, sizeof text, "%d x %d cells of base pitch and depth, %.6g um deep",
             choice.params.phase_cells, choice.params.depth_cells, 1e6 * choice.params.depth);
    return config_note_text(conf, "lookup_tables", text) == 0 ? 0
                                                              : message_no_memory(conf->messages);
}
