/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* A flank's deviation at one point, where an integral along a line is not wanted. */
#ifndef GEARMESH_SURFACE_H
#define GEARMESH_SURFACE_H

#include "internal.h"

typedef struct gmi_surface {
    double value;   /* material added (m) */
    double by_t1;   /* its slope along t1 of the common face (m) */
    double by_roll; /* along the gear's own roll length (1) */
} gmi_surface;

/* Cell that holds v, clamped into the table. */
static inline int gmi_surface_cell(double v, int last) {
    const int cell = v > 0.0 ? (int)v : 0;
    return cell < last ? cell : last;
}

/*
 * Table (NULL = none) and ramps of one flank, bilinear as along a line; pitch apart. t1 of the common face; roll: own roll
 * length beyond the start of the flank (m).
 */
static inline gmi_surface gmi_surface_at(const gmi_tables *tables, const gmi_grid *grid,
                                         const double *values, double t1, double roll) {
    gmi_surface result = {0.0, 0.0, 0.0};
    const double v1 = grid->face_base + grid->face_rate * t1;
    const double v2 = roll * grid->per_rho;

    /* Within the cell: corner + along_face p + (along_profile + mixed p) q. */
    if (values != NULL) {
        const int face = gmi_surface_cell(v1, grid->last_face);
        const int profile = gmi_surface_cell(v2, grid->last_profile);
        const double p = v1 - (double)face;
        const double q = v2 - (double)profile;
        const double *near = values + face * grid->row + (ptrdiff_t)profile * GMI_NODE_DOUBLES;
        const double *far = near + grid->row;
        const double along_profile = near[GMI_NODE_DOUBLES] - near[0];
        const double along_face = far[0] - near[0];
        const double mixed = far[GMI_NODE_DOUBLES] - far[0] - along_profile;
        result.value = near[0] + along_face * p + (along_profile + mixed * p) * q;
        result.by_t1 = (along_face + mixed * q) * grid->face_rate;
        result.by_roll = (along_profile + mixed * p) * grid->per_rho;
    }

    /* Each ramp takes off what it exceeds zero by. */
    for (int k = 0; k < tables->ramp_count; ++k) {
        const gm_flank_ramp *ramp = &tables->ramps[k];
        const double per_profile = ramp->per_t2 / grid->profile_cells;
        const double height = ramp->offset +
                              ramp->per_t1 * (grid->face_origin + grid->face_scale * t1) +
                              per_profile * v2;
        if (height > 0.0) {
            result.value -= height;
            result.by_t1 -= ramp->per_t1 * grid->face_scale;
            result.by_roll -= per_profile * grid->per_rho;
        }
    }
    return result;
}

#endif
