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

/*
 * The longest steps of the solver (an eighth of a tooth; a tenth of a natural vibration under noise) make so many evaluations
 * of the mesh at least, the explicit method six for each. Below this tolerance steps between teeth are shorter.
 */
static const double per_pass = 8.0, per_vibration = 10.0, stages_of_erk = 6.0;
static const double shortening_tolerance = 1e-5, shortening_power = 0.2;

/*
 * Instructions, counted by callgrind (libgearmesh/docs/cache.md#cost): of a look-up; and of an exact evaluation, for each
 * line of contact by what is on it. Rather too many of the one, and too few of the other.
 */
static const double per_look_up = 600.0, per_look_up_of_arms = 1300.0;
static const double per_even_line = 150.0, per_line = 450.0, per_ramp = 110.0, per_grid_line = 27.0;
static const double per_elastic_line = 8000.0, per_cornered_line = 7000.0;

/*
 * A column takes as long as so many evaluations: by a walk along its lines; or for each of its nodes and to find its start,
 * with derivatives, which take longer.
 */
static const double per_walk = 7.8, per_walked_node = 0.155, per_start = 14.0;
static const double with_derivatives = 1.2, with_derivatives_between_tilted_axes = 1.85,
                    with_derivatives_and_arms = 1.6;

/* The part of what tables save that filling may take. Finer tables are to take next to nothing of the evaluations that they
 * replace, and to be not too large for a processor's cache. */
static const double worth = 0.95, next_to_nothing = 0.25, finer_bytes = 32e6;

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

static double largest_deflection(const config *conf, const gear_mesh *gears) {
    const double force = largest_load(conf) / gears->pair.wheel.base_radius;

    return force / gm_mesh_mean_stiffness(gears->prepared[0]);
}

static double depth_of(const config *conf, const gear_mesh *gears) {
    const double deflection = largest_deflection(conf, gears);
    const double deepest = 0.25 * gears->pair.transverse_base_pitch;

    return isnan(conf->lookup_depth) ? fmin(deepest_deflection * deflection + deviation, deepest)
                                     : conf->lookup_depth;
}

static int carrying_side(const config *conf) {
    const double load =
        conf->load_table != NULL ? time_table_value(conf->load_table, 0.0) : conf->mean_load;

    return load < 0.0 ? GM_COAST : GM_DRIVE;
}

static gm_cache_params params_of(const config *conf, const gear_mesh *gears, int which) {
    gm_cache_params params;

    gm_cache_params_default(&params);
    params.side = carrying_side(conf);
    params.phase_cells = resolutions[which].phase_cells;
    params.depth_cells = resolutions[which].depth_cells;
    params.depth = depth_of(conf, gears);
    return params;
}

static int is_tilted(const config *conf) {
    return conf->pose.skew != 0.0 || conf->pose.inclination != 0.0;
}

static int has_arms(const config *conf) {
    return conf->law != LAW_ELASTIC && config_has_corners(conf);
}

/* What is on the flanks of the side that carries. */
typedef struct flank_content {
    int ramps;         /* linear reliefs, of both gears */
    double grid_lines; /* of the tables of both gears that all lines of contact cross */
} flank_content;

/*
 * The lines together are as long as the transverse contact ratio, in face widths, and as the overlap ratio along the path of
 * contact, in its lengths.
 */
static flank_content content_of(const config *conf, const gear_mesh *gears) {
    const double over_face = gears->pair.transverse_contact_ratio;
    const double over_profile = gears->pair.overlap_ratio;
    const int side = carrying_side(conf);
    flank_content content = {0, 0.0};

    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const gear_flanks *flanks = &gears->flanks[0][role];
        const gm_flanks_side_report *design =
            side == GM_DRIVE ? &flanks->report.drive : &flanks->report.coast;

        content.ramps += design->ramps;
        content.grid_lines += over_profile * fmax(flanks->profile_nodes, design->profile_nodes) +
                              over_face * fmax(flanks->face_nodes, design->face_nodes);
    }
    return content;
}

/* Instructions of an exact evaluation. */
static double evaluation_of(const config *conf, const gear_mesh *gears) {
    const flank_content content = content_of(conf, gears);
    const int is_even = content.ramps == 0 && content.grid_lines == 0.0 && !is_tilted(conf);
    const double line = conf->law == LAW_ELASTIC   ? per_elastic_line
                        : config_has_corners(conf) ? per_cornered_line
                        : is_even                  ? per_even_line
                                                   : per_line + per_ramp * content.ramps;
    const double tables = conf->law == LAW_ELASTIC || config_has_corners(conf)
                              ? 0.0
                              : per_grid_line * content.grid_lines;

    return gears->pair.total_contact_ratio * line + tables;
}

/* What a look-up takes, in evaluations. */
static double look_up_of(const config *conf, const gear_mesh *gears) {
    return (has_arms(conf) ? per_look_up_of_arms : per_look_up) / evaluation_of(conf, gears);
}

/* Whether columns are walked: tables without ramps, between axes as drawn, with teeth of a constant stiffness. */
static int is_walked(const config *conf, const gear_mesh *gears) {
    const flank_content content = content_of(conf, gears);

    return conf->law != LAW_ELASTIC && !config_has_corners(conf) && !is_tilted(conf) &&
           conf->pose.center_distance_change == 0.0 && conf->pose.offset == 0.0 &&
           content.ramps == 0 && content.grid_lines > 0.0;
}

/* What a column takes, in evaluations. */
static double column_of(const config *conf, const gear_mesh *gears, int nodes) {
    if (is_walked(conf, gears)) {
        return per_walk + per_walked_node * nodes;
    }
    const double dearer = conf->law == LAW_ELASTIC ? 1.0
                          : has_arms(conf)         ? with_derivatives_and_arms
                          : is_tilted(conf)        ? with_derivatives_between_tilted_axes
                                                   : with_derivatives;
    return dearer * (per_start + nodes);
}

/* Why these gears cannot have tables, NULL if they can: meshes that are not smooth, or have more in them than the tables. */
static const char *obstacle(const config *conf, const gear_mesh *gears) {
    if (gears->pair.face_advance == 0.0) {
        return "spur gears have no tables, as their sum of penetrations jumps";
    }
    if (gears->halves > 1) {
        return "double-helical pairs have no tables, as their pinion floats";
    }
    if (config_has_friction(conf)) {
        return "with friction there are no tables, as they do not hold it";
    }
    return NULL;
}

/* Whether the tables end before what the load presses flanks by: then they are mostly asked in vain. */
static int is_shallow(const config *conf, const gear_mesh *gears) {
    return conf->lookup_depth < largest_deflection(conf, gears);
}

/* ---------------------------------------------------------------------------------------------
 * The run
 * ------------------------------------------------------------------------------------------- */

/* Mean over the run of what acts in it, early values counting more, as they turn the gears for longer. */
static double lasting(const config *conf, const time_table *table, double number) {
    const double duration = conf->duration;

    return table != NULL ? time_table_weighted(table, 0.0, duration, duration, 0.0) /
                               (0.5 * duration * duration)
                         : number;
}

/* Both bodies as one at the speed of a torque-driven pinion: what turns it, less the load, and what drags on it. */
typedef struct driven_body {
    double inertia, torque, drag;
} driven_body;

static driven_body body_of(const config *conf, const gear_mesh *gears) {
    const double ratio = gears->pair.pinion.base_radius / gears->pair.wheel.base_radius;
    const double load = lasting(conf, conf->load_table, conf->mean_load);
    const double load_drag =
        conf->load_per_speed + conf->load_per_speed_squared * fabs(ratio * conf->start_speed);
    const driven_body body = {
        .inertia = conf->pinion_inertia + ratio * ratio * conf->wheel_inertia,
        .torque = lasting(conf, conf->drive_table, conf->drive_torque) - ratio * load,
        .drag = conf->pinion_drag + ratio * ratio * (conf->wheel_drag + load_drag)};
    return body;
}

/* Time that the run takes: a stop speed is reached no sooner than at its largest acceleration, with drag or without (s). */
static double duration_of(const config *conf, const gear_mesh *gears) {
    if (conf->drive != DRIVE_TORQUE || isnan(conf->stop_speed)) {
        return conf->duration;
    }
    const driven_body body = body_of(conf, gears);
    const double torque =
        fmax(fabs(body.torque), fabs(body.torque - body.drag * conf->start_speed));
    const double change = fabs(conf->stop_speed - conf->start_speed);

    return torque > 0.0 ? fmin(conf->duration, change * body.inertia / torque) : conf->duration;
}

/* Mean speed of a torque-driven pinion (rad/s). */
static double driven_speed(const config *conf, const gear_mesh *gears, double duration) {
    const driven_body body = body_of(conf, gears);
    const double start = conf->start_speed;
    const double acceleration = (body.torque - body.drag * start) / body.inertia;

    /* It dies away with exp(-drag / inertia t): twice integrated over the run. */
    const double decay = body.drag / body.inertia * duration;
    const double share = decay > 1e-3 ? (decay + expm1(-decay)) / (decay * decay) : 0.5;
    return start + share * acceleration * duration;
}

/* Mean of |speed| as it changes evenly from one to another, through 0 or not. */
static double mean_between(double start, double end) {
    const double sum = fabs(start) + fabs(end);

    return start * end < 0.0 ? 0.5 * (start * start + end * end) / sum : 0.5 * sum;
}

/* Tooth passes of the run, as far as they are known beforehand. */
static double tooth_passes(const config *conf, const gear_mesh *gears, double duration) {
    const double mean_speed = conf->drive == DRIVE_TORQUE ? driven_speed(conf, gears, duration)
                              : conf->drive_table != NULL
                                  ? time_table_integral(conf->drive_table, duration) / duration
                                  : mean_between(conf->start_speed, conf->end_speed);

    return fabs(mean_speed) * duration * gears->pair.pinion.teeth / two_pi;
}

/* How often the solver evaluates the mesh, at least. Most rows do without, and pairs in contact are counted in any case. */
static double evaluations(const config *conf, const gear_mesh *gears, double duration,
                          double passes) {
    const double shorter =
        fmax(1.0, pow(shortening_tolerance / conf->relative_tolerance, shortening_power));
    const double frequency = gear_mesh_eigenfrequency(gears, conf);
    const double shaken = conf->noise_amplitude > 0.0 && isfinite(frequency)
                              ? per_vibration * frequency * duration
                              : 0.0;
    const double steps = fmax(shaken, passes * per_pass * shorter);

    return conf->method == METHOD_ERK ? stages_of_erk * steps : steps;
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
    const double values = has_arms(conf) ? 6.0 : 4.0;
    const double column =
        2.0 * (double)sizeof(double) + (params->depth_cells + 1) * values * sizeof(float);

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

/* What a run fills of these tables, in evaluations: of as many tooth passes as it meets. */
static double filling_of(const config *conf, const gear_mesh *gears, const gm_cache_params *params,
                         double met) {
    return met * columns_of(conf, params, gears) * column_of(conf, gears, params->depth_cells + 1);
}

lookup_choice lookup_choose(const config *conf, const gear_mesh *gears) {
    const int is_forced = conf->lookup == LOOKUP_ALWAYS;
    lookup_choice choice = {0};
    if (conf->model != MODEL_3D || conf->analysis != ANALYSIS_DYNAMIC ||
        conf->lookup == LOOKUP_OFF || obstacle(conf, gears) != NULL ||
        (conf->lookup == LOOKUP_AUTO && conf->relative_tolerance < tightest_tolerance)) {
        return choice;
    }

    /* The coarsest that will do: elastic teeth that are all alike hardly vibrate, which asks for a finer one. */
    int coarsest = coarsest_of(conf);
    choice.params = params_of(conf, gears, coarsest);
    const double all = combinations(&choice.params, gears);
    if (conf->law == LAW_ELASTIC && all == 1.0) {
        choice.params = params_of(conf, gears, ++coarsest);
    }
    choice.pays_from = HUGE_VAL;
    if (all == 0.0 || is_shallow(conf, gears)) {
        choice.is_used = is_forced;
        return choice;
    }

    /* What the run evaluates, what of that tables save, and what it takes to fill as much of them as it meets. */
    const double duration = duration_of(conf, gears);
    const double passes = tooth_passes(conf, gears, duration);
    const double met = conf->lookup_threads > 0 ? 1.0 : fmin(1.0, (passes + 1.0) / all);
    const double evaluated = evaluations(conf, gears, duration, passes);
    const double saved = evaluated * (1.0 - look_up_of(conf, gears));
    choice.is_used = is_forced || filling_of(conf, gears, &choice.params, met) < worth * saved;
    if (saved > 0.0) {
        choice.pays_from =
            duration * filling_of(conf, gears, &choice.params, 1.0) / (worth * saved);
    }

    /* Finer ones where they cost next to nothing. */
    for (int k = coarsest + 1; choice.is_used && k < RESOLUTIONS; ++k) {
        const gm_cache_params finer = params_of(conf, gears, k);
        if (filling_of(conf, gears, &finer, met) <= next_to_nothing * evaluated &&
            (double)gm_cache_size(&finer, gears->prepared[0]) <= finer_bytes) {
            choice.params = finer;
        }
    }
    return choice;
}

/* ---------------------------------------------------------------------------------------------
 * What is said of it
 * ------------------------------------------------------------------------------------------- */

/* What is asked for in vain, or beyond what the library takes: deeper than that no tooth is pressed. */
static int check(const config *conf, const gear_mesh *gears) {
    const double deepest = 0.25 * gears->pair.transverse_base_pitch;
    const char *reason = obstacle(conf, gears);
    if (reason != NULL && conf->lookup == LOOKUP_ALWAYS) {
        config_complain(conf, "solver.lookup", "must be off, on or auto (got always): %s", reason);
        return EXIT_BAD_INPUT;
    }
    if (reason == NULL && conf->lookup_depth > deepest) {
        config_complain(conf, "solver.lookup_depth_um",
                        "must be at most a quarter of the base pitch, %.9g (got %.9g)",
                        1e6 * deepest, 1e6 * conf->lookup_depth);
        return EXIT_BAD_INPUT;
    }
    return 0;
}

/* Why tables would never pay, however long the run is. */
static const char *reason_for_never(const config *conf, const gear_mesh *gears) {
    if (look_up_of(conf, gears) >= 1.0) {
        return "a look-up takes longer than these flanks; with measured flanks, more reliefs, "
               "tilted "
               "axes, edges or elastic teeth it would not";
    }
    if (is_shallow(conf, gears)) {
        return "the load presses the flanks deeper than lookup_depth_um, beyond which nothing is "
               "looked up";
    }
    return "tables of all pairs of teeth would take more memory than 1 GB, or the gears do not "
           "turn";
}

/* Who asks for tables is told why there are none, and what would have to change. */
static void tell_exact(const config *conf, const gear_mesh *gears, const lookup_choice *choice) {
    const char *reason = obstacle(conf, gears);

    /* A longer run would have them. */
    if (reason == NULL && choice->pays_from < HUGE_VAL) {
        config_remark(conf, "solver.lookup",
                      "the run is exact: filling the tables would take longer than they save in "
                      "%.4g s; a run like this gains from some %.2g s on",
                      conf->duration, choice->pays_from);
        return;
    }

    /* No run of these gears would. */
    config_remark(conf, "solver.lookup", "the run is exact: %s",
                  reason != NULL ? reason : reason_for_never(conf, gears));
}

int lookup_note(const gear_mesh *gears, config *conf) {
    if (conf->model != MODEL_3D || conf->analysis != ANALYSIS_DYNAMIC ||
        gears->prepared[0] == NULL) {
        return 0;
    }
    const int is_asked = conf->lookup == LOOKUP_ON || conf->lookup == LOOKUP_ALWAYS;
    if (is_asked && check(conf, gears) != 0) {
        return EXIT_BAD_INPUT;
    }
    const lookup_choice choice = lookup_choose(conf, gears);
    if (!choice.is_used) {
        if (is_asked) {
            tell_exact(conf, gears, &choice);
        }
        return 0;
    }

    char text[120];
    snprintf(text, sizeof text, "%d x %d cells of base pitch and depth, %.6g um deep",
             choice.params.phase_cells, choice.params.depth_cells, 1e6 * choice.params.depth);
    return config_note_text(conf, "lookup_tables", text) == 0 ? 0
                                                              : message_no_memory(conf->messages);
}
