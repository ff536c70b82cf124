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
    double evaluations;     /* of the mesh in the run, about and rather too few; without tables */
    double filling;         /* what the run fills of them takes as long as so many evaluations */
} lookup_choice;

/* Not used where these gears cannot have tables, or `auto` gains nothing. */
lookup_choice lookup_choose(const config *conf, const gear_mesh *gears);

/*
 * Whether these gears can have what is asked for, once the tables over time are read; notes which tables a run uses, and
 * says so where they take longer than they save. Returns 0, EXIT_BAD_INPUT after a message, or EXIT_RUN_FAILED.
 */
int lookup_note(const gear_mesh *gears, config *conf);

#endif
