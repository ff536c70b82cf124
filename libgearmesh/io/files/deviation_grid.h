/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file deviation_grid.h
 * The uniform grid that the rows of a deviation file form.
 *
 * A file does not say how many nodes it has: the rows of one set tell, and all rows must lie on that
 * grid. Work and memory grow linearly with the number of rows.
 */
#ifndef GEARMESH_DEVIATION_GRID_H
#define GEARMESH_DEVIATION_GRID_H

#include <stddef.h>

#include "deviation_rows.h"
#include "gearmesh/gearmesh_io.h"

/** How far a position may be off its place on the uniform grid, and beyond 0 and 1. */
#define GMI_POSITION_TOLERANCE 1e-5

typedef struct gmi_grid {
    int nodes[2]; /**< along t1 and t2, 2 .. GMI_LARGEST_NODES */
    int slot;     /**< the set that gave the grid */
} gmi_grid;

/** Finds the grid of the set that the first row belongs to. */
int gmi_grid_find(gmi_grid *grid, const gmi_rows *rows, const size_t *row_count,
                  gm_io_error *error);

/** Nodes of one set. */
size_t gmi_grid_size(const gmi_grid *grid);

/**
 * Puts every row into its place.
 *
 * @param[in]  row_count  [slots] rows of every set, 0 = no such set
 * @param[out] values     [slots] tables of gmi_grid_size() nodes, allocated by this function where
 *                        there are rows; on an error some may be, and are the caller's to free
 * @param[in]  slots      number of slots
 */
int gmi_grid_fill(const gmi_grid *grid, const gmi_rows *rows, const size_t *row_count,
                  double **values, int slots, gm_io_error *error);

#endif /* GEARMESH_DEVIATION_GRID_H */
