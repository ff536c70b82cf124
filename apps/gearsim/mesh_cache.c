/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "mesh_cache.h"
#include "time_table.h"

#include <stdlib.h>

/* Steps of 0.5 um with the default depth, as the library's defaults. */
static gm_cache_params params_of(const config *conf) {
    gm_cache_params params;

    gm_cache_params_default(&params);
    const double load =
        conf->load_table != NULL ? time_table_value(conf->load_table, 0.0) : conf->mean_load;
    params.side = load < 0.0 ? GM_COAST : GM_DRIVE;
    params.depth = conf->lookup_depth;
    return params;
}

static int is_wanted(const config *conf) {
    return conf->lookup == LOOKUP_ON && conf->model == MODEL_3D &&
           conf->analysis == ANALYSIS_DYNAMIC;
}

int mesh_cache_check(const config *conf, const gear_mesh *gears) {
    const double deepest = 0.25 * gears->pair.transverse_base_pitch;

    if (!is_wanted(conf)) {
        return 0;
    }
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
    if (conf->lookup_depth > deepest) {
        config_complain(conf, "solver.lookup_depth_um",
                        "must be at most a quarter of the base pitch, %.9g (got %.9g)",
                        1e6 * deepest, 1e6 * conf->lookup_depth);
        return EXIT_BAD_INPUT;
    }
    return 0;
}

int mesh_cache_create(gm_cache **cache, const config *conf, const gear_mesh *gears) {
    const gm_cache_params params = params_of(conf);

    *cache = NULL;
    if (!is_wanted(conf)) {
        return 0;
    }

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

void mesh_cache_free(gm_cache *cache, const gear_mesh *gears) {
    if (cache != NULL) {
        (void)gm_mesh_use_cache(gears->prepared[0], NULL);
    }
    free(cache); /* it begins at its memory */
}
