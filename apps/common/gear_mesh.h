/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The two gears in mesh as a configuration says: pair, flanks and stiffness. Analyses ask for what they do by
 * gear_contact.h. */
#ifndef APPS_GEAR_MESH_H
#define APPS_GEAR_MESH_H

#include "config.h"
#include "flank_loading.h"

/* Where the pinion of a double-helical pair has floated; changes with each evaluation. */
typedef struct pinion_float {
    gm_double_helical gears;
    double apex;            /* last found, along +z (m) */
    gm_mesh_result each[2]; /* of both halves there */
} pinion_float;

typedef struct gear_mesh {
    gm_pair pair;               /* of a double-helical pair one of its halves */
    int halves;                 /* 1, or 2 */
    double gap;                 /* between them, else 0 (m) */
    double wheel_shift;         /* of the wheel along its axis, by its pose (m) */
    gear_flanks flanks[2][2];   /* [half][enum gm_role] */
    gm_mesh *prepared[2];       /* [half] pair, flanks and law as one; NULL where there is no law */
    gm_workspace *workspace[2]; /* [half] of elastic teeth, for one thread; NULL with other laws */
    pinion_float *floating;     /* of a double-helical pair with a law, else NULL */
    double *tooth_stiffness[2]; /* [enum gm_role] factors of single teeth, NULL = 1 */
} gear_mesh;

/* Derives the pair, warns of its drawing, and for a run loads the flanks. Returns 0 or an exit code after a message. The
 * mesh must stay where it is. */
int gear_mesh_open(gear_mesh *mesh, const config *conf);
void gear_mesh_close(gear_mesh *mesh);

/* Of the wheel on the mesh if the pinion's speed is prescribed, else of both bodies against each other; NaN without the
 * keys that it needs (Hz). */
double gear_mesh_eigenfrequency(const gear_mesh *mesh, const config *conf);

/* Of elastic teeth along the face: those given, or as many as leave 0.4 % in the transmission error. */
int gear_mesh_stations(const gear_mesh *mesh, const config *conf);

/* Face widths of the whole gears, the gap between halves included (m). */
double gear_mesh_face_width(const gear_mesh *mesh, const gm_gear *gear);

/* Notes what follows from the configuration and a reader of the output needs. Returns 0 or an exit code after a
 * message. */
int gear_mesh_note(const gear_mesh *mesh, config *conf);

#endif
