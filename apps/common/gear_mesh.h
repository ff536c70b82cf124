/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The two gears in mesh as a configuration says: pair, flanks and stiffness; shared read-only by all analyses. */
#ifndef APPS_GEAR_MESH_H
#define APPS_GEAR_MESH_H

#include "config.h"
#include "flank_loading.h"

typedef struct gear_mesh {
    gm_pair pair;
    double wheel_shift;         /* of the wheel along its axis, by its pose (m) */
    gear_flanks flanks[2];      /* GM_PINION, GM_WHEEL */
    gm_mesh *prepared;          /* pair, flanks and law as one; NULL where there is no law */
    gm_workspace *workspace;    /* of elastic teeth, for one thread; NULL with other laws */
    double *tooth_stiffness[2]; /* [enum gm_role] factors of single teeth, NULL = 1 */
} gear_mesh;

/* Derives the pair, warns of its drawing, and for a run loads the flanks. Returns 0 or an exit code after a message. The
 * mesh must stay where it is. */
int gear_mesh_open(gear_mesh *mesh, const config *conf);
void gear_mesh_close(gear_mesh *mesh);

/* Of the wheel on the mesh if the pinion's speed is prescribed, else of both bodies against each other; NaN without the
 * keys that it needs (Hz). */
double gear_mesh_eigenfrequency(const gear_mesh *mesh, const config *conf);

/* Notes what follows from the configuration and a reader of the output needs. Returns 0 or an exit code after a
 * message. */
int gear_mesh_note(const gear_mesh *mesh, config *conf);

#endif
