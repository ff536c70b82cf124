/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "mesh_cache.h"
#include "lookup.h"
#include "platform.h"

#include <stdlib.h>

int mesh_cache_create(gm_cache **cache, const config *conf, const gear_mesh *gears) {
    const lookup_choice choice = lookup_choose(conf, gears);
    *cache = NULL;
    if (!choice.is_used) {
        return 0;
    }

    const size_t size = gm_cache_size(&choice.params, gears->prepared[0]);
    void *memory = size > 0 ? malloc(size) : NULL;
    if (memory == NULL) {
        return EXIT_RUN_FAILED;
    }
    if (gm_cache_init(cache, &choice.params, gears->prepared[0], memory, size) != GM_OK) {
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
