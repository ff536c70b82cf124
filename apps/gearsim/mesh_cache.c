/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "mesh_cache.h"
#include "platform.h"
#include "time_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A column of the tables takes as long as so many evaluations of the mesh, and a tooth pass of a run as so many. */
static const double evaluations_per_column = 14.0, evaluations_per_pass = 15.0;

/* The tables reach as deep as so many static deflections under the largest load, and what flanks deviate by. */
static const double deepest_deflection = 4.0, deviation = 6e-6;

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

static gm_cache_params params_of(const config *conf, const gear_mesh *gears) {
    gm_cache_params params;

    gm_cache_params_default(&params);
    const double load =
        conf->load_table != NULL ? time_table_value(conf->load_table, 0.0) : conf->mean_load;
    params.side = load < 0.0 ? GM_COAST : GM_DRIVE;
    params.depth = depth_of(conf, gears);
    return params;
}

/* Whether the flanks are tables alone, between parallel axes: others take longer to fill in. */
static int has_plain_tables(const config *conf, const gear_mesh *gears) {
    const gm_pose *pose = &conf->pose;
    const modification_values *first = &conf->modifications[0][0][0];
    const size_t count = sizeof conf->modifications / sizeof *first;

    for (size_t i = 0; i < count; ++i) {
        if (!isnan(first[i].value[MODIFICATION_AMOUNT])) {
            return 0;
        }
    }
    return (gears->flanks[0][GM_PINION].prepared != NULL ||
            gears->flanks[0][GM_WHEEL].prepared != NULL) &&
           pose->skew == 0.0 && pose->inclination == 0.0;
}

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
    static const double turn = 6.283185307179586;
    const double duration = conf->duration;
    const double mean_speed = conf->drive == DRIVE_TORQUE ? driven_speed(conf, gears)
                              : conf->drive_table != NULL
                                  ? time_table_integral(conf->drive_table, duration) / duration
                                  : 0.5 * (fabs(conf->start_speed) + fabs(conf->end_speed));

    return fabs(mean_speed) * duration * gears->pair.pinion.teeth / turn;
}

/* How often a run evaluates the mesh. Most samples do without, and pairs in contact are counted in any case. */
static double evaluations(const config *conf, const gear_mesh *gears) {
    const int shows_all = conf->columns == NULL || strcmp(conf->columns, "all") == 0;
    const double samples = shows_all && conf->method == METHOD_ERK ? conf->oversampling : 0.0;

    return evaluations_per_pass * tooth_passes(conf, gears) +
           samples * conf->output_rate * conf->duration;
}

/* Whether the run is so long that filling the tables takes less than they save. */
static int pays(const config *conf, const gear_mesh *gears) {
    if (gears->pair.face_advance == 0.0 || gears->halves > 1 || config_has_friction(conf) ||
        config_has_corners(conf) || conf->law == LAW_ELASTIC || !has_plain_tables(conf, gears)) {
        return 0;
    }

    const gm_cache_params params = params_of(conf, gears);
    const double column = (double)sizeof(double) + (params.depth_cells + 1) * 4.0 * sizeof(float);
    const double columns = (double)gm_cache_size(&params, gears->prepared[0]) / column;
    return columns > 0.0 && evaluations(conf, gears) > evaluations_per_column * columns;
}

static int is_wanted(const config *conf, const gear_mesh *gears) {
    if (conf->model != MODEL_3D || conf->analysis != ANALYSIS_DYNAMIC) {
        return 0;
    }
    return conf->lookup == LOOKUP_ON || (conf->lookup == LOOKUP_AUTO && pays(conf, gears));
}

int mesh_cache_check(const config *conf, const gear_mesh *gears) {
    const double deepest = 0.25 * gears->pair.transverse_base_pitch;

    /* Only who asks for it is told why it cannot be had; `auto` does without. */
    if (conf->lookup != LOOKUP_ON || !is_wanted(conf, gears)) {
        return 0;
    }

    /* Meshes that are not smooth in both angles, or have more in them than the tables. */
    if (gears->pair.face_advance == 0.0) {
        config_complain(conf, "solver.lookup",
                        "must be off for spur gears, whose sum of penetrations jumps (got on)");
        return EXIT_BAD_INPUT;
    }
    if (gears->halves > 1) {
        config_complain(conf, "solver.lookup",
                        "must be off for double-helical pairs, whose pinion floats (got on)");
        return EXIT_BAD_INPUT;
    }
    if (config_has_friction(conf)) {
        config_complain(conf, "solver.lookup",
                        "must be off with friction, which the tables do not hold (got on)");
        return EXIT_BAD_INPUT;
    }
    if (config_has_corners(conf)) {
        config_complain(conf, "solver.lookup",
                        "must be off with corner contact, which the tables do not hold (got on)");
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

int mesh_cache_create(gm_cache **cache, const config *conf, const gear_mesh *gears) {
    *cache = NULL;
    if (!is_wanted(conf, gears)) {
        return 0;
    }

    const gm_cache_params params = params_of(conf, gears);
    const size_t size = gm_cache_size(&params, gears->prepared[0]);
    void *memory = size > 0 ? malloc(size) : NULL;
    if (memory == NULL) {
        return EXIT_RUN_FAILED;
    }
    if (gm_cache_init(cache, &params, gears->prepared[0], memory, size) != GM_OK) {
        free(memory);
        return EXIT_RUN_FAILED;
    }
    return gm_mesh_use_cache(gears->prepared[0], *cache) == GM_OK ? 0 : EXIT_RUN_FAILED;
}

/* ---------------------------------------------------------------------------------------------
 * Filling before the run
 * ------------------------------------------------------------------------------------------- */

/* Tooth passes filled between two looks at the clock and at signals; a pass takes about a millisecond. */
enum { PASSES_AT_ONCE = 8 };

typedef struct filling {
    gm_cache *cache;
    gm_workspace *workspace[THREADS_MAX]; /* NULL: the law needs none */
    int threads;
    progress *line;
} filling;

/* A share of the passes: one of as many as there are threads, all of the same size. The first one shows how far it is. */
static void fill_share(void *of, int which) {
    const filling *all = of;
    const int passes = gm_cache_passes(all->cache);
    const int first = (int)((long long)passes * which / all->threads);
    const int end = (int)((long long)passes * (which + 1) / all->threads);

    for (int pass = first; pass < end && !interrupt_requested(); pass += PASSES_AT_ONCE) {
        const int count = end - pass < PASSES_AT_ONCE ? end - pass : PASSES_AT_ONCE;
        (void)gm_cache_fill(all->cache, pass, count, all->workspace[which]);
        if (which == 0) {
            progress_tell(all->line, "filling the look-up",
                          (double)(pass + count - first) / (end - first));
        }
    }
}

/* Memory for each thread, where the law needs it. 0, or -1. */
static int make_workspaces(filling *all, const gm_mesh *mesh) {
    const size_t size = gm_workspace_size(mesh);

    for (int k = 0; k < all->threads && size > 0; ++k) {
        void *memory = malloc(size);
        if (memory == NULL || gm_workspace_init(&all->workspace[k], mesh, memory, size) != GM_OK) {
            free(memory);
            return -1;
        }
    }
    return 0;
}

int mesh_cache_fill(gm_cache *cache, const config *conf, const gear_mesh *gears, progress *line) {
    if (cache == NULL || conf->lookup_threads == 0) {
        return 0;
    }

    filling all = {.cache = cache, .threads = conf->lookup_threads, .line = line};
    const int status = make_workspaces(&all, gears->prepared[0]);
    if (status == 0) {
        threads_run(all.threads, fill_share, &all);
    }
    for (int k = 0; k < all.threads; ++k) {
        free(all.workspace[k]); /* it begins at its memory */
    }
    return status == 0 ? 0 : EXIT_RUN_FAILED;
}

void mesh_cache_free(gm_cache *cache, const gear_mesh *gears) {
    if (cache != NULL) {
        (void)gm_mesh_use_cache(gears->prepared[0], NULL);
    }
    free(cache); /* it begins at its memory */
}
