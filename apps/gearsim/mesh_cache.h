/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The cache of a run that lookup.h gives one; it fills itself as the run goes on, or is filled before. */
#ifndef GEARSIM_MESH_CACHE_H
#define GEARSIM_MESH_CACHE_H

#include "gear_mesh.h"
#include "progress.h"

/* Lets the mesh answer from a cache; NULL if the run is not to use one. Returns 0, or EXIT_RUN_FAILED if there is no
 * memory. */
int mesh_cache_create(gm_cache **cache, const config *conf, const gear_mesh *gears);

/*
 * Fills all of it by [solver] lookup_threads threads, if there is one, and shows how far it is. Ends early when the run is
 * interrupted. Returns 0, or EXIT_RUN_FAILED if there is no memory.
 */
int mesh_cache_fill(gm_cache *cache, const config *conf, const gear_mesh *gears, progress *line);

void mesh_cache_free(gm_cache *cache, const gear_mesh *gears);

#endif
