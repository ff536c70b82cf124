/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Whether a run looks the mesh up in tables, and in which: from the gears, its length and its tolerance alone, so that rows
 * do not depend on what is written of them. */
#ifndef GEARSIM_LOOKUP_H
#define GEARSIM_LOOKUP_H

#include "gear_mesh.h"

typedef struct lookup_choice {
    int is_used;
    gm_cache_params params; /* of the tables */
    double
        pays_from; /* about how long a run of this kind saves more than it fills (s); infinite: none does */
} lookup_choice;

/* Not used where these gears cannot have tables, or `on` and `auto` gain nothing. */
lookup_choice lookup_choose(const config *conf, const gear_mesh *gears);

/*
 * Whether these gears can have what is asked for, once the tables over time are read; notes which tables a run uses, and
 * says so where it was to use some and does not. Returns 0, EXIT_BAD_INPUT after a message, or EXIT_RUN_FAILED.
 */
int lookup_note(const gear_mesh *gears, config *conf);

#endif
