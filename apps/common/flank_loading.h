/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* From the files of [flanks] and the designs of [modifications] to the prepared flanks of a gear. */
#ifndef APPS_FLANK_LOADING_H
#define APPS_FLANK_LOADING_H

#include "config.h"

#include <gearmesh/gearmesh_io.h>

/* All zero = ideal. */
typedef struct gear_flanks {
    gm_flanks *prepared;           /* NULL = ideal */
    int face_nodes, profile_nodes; /* of the files' tables, 0 without */
    gm_flanks_report report;       /* what holds the designs */
} gear_flanks;

/* Files and design of one gear (0 = pinion, 1 = wheel) become prepared flanks, if there are any; `flanks` is all zero
 * before. `half` 1: the second half of a double-helical pair, which has the design of the first. Returns 0 or an exit code
 * after a message. */
int gear_flanks_load(gear_flanks *flanks, const config *conf, const gm_pair *pair,
                     enum gm_role gear, int half);

/* Whether the second half of a gear has files of its own. */
int gear_flanks_has_second(const config *conf, enum gm_role gear);
void gear_flanks_free(gear_flanks *flanks);

/* Notes for the head of the output what holds the designs of a gear. Returns 0 or EXIT_RUN_FAILED (no memory). */
int gear_flanks_note(const gear_flanks *flanks, config *conf, enum gm_role gear);

#endif
