/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The columns `te_um_by_KEY` of a static analysis without friction: how the transmission error under the given load moves
 * with the amount of a modification, KEY being one of [modifications]. Exact derivatives, for the search of modifications.
 */
#ifndef GEARSIM_TE_SLOPES_H
#define GEARSIM_TE_SLOPES_H

#include "columns.h"
#include "flank_loading.h"
#include "gear_mesh.h"

/* What the names of these columns begin with. */
#define TE_SLOPE_PREFIX "te_um_by_"

enum { TE_SLOPES_MAX = 8 };

/* What each key adds to the flanks of both gears. All zero = none. */
typedef struct te_slopes {
    int count;
    gear_flanks change[2][TE_SLOPES_MAX]; /* [enum gm_role] */
} te_slopes;

/* Adds the names of those that `output.columns` asks for, as many as there is room for. */
void te_slopes_add_names(const config *conf, column_names *names);

/* Makes the flanks of each of these. Returns 0 or an exit code after a message; to be closed in any case. */
int te_slopes_open(te_slopes *slopes, const config *conf, const gear_mesh *gears);
void te_slopes_close(te_slopes *slopes);

/* The derivatives at an equilibrium (um/um), [count]; at_rest: its result. Returns a status of the library. */
int te_slopes_find(const te_slopes *slopes, const gear_mesh *gears, const gm_position *position,
                   const gm_mesh_result *at_rest, double *te_by);

#endif
