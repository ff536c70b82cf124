/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file deviation_rows.h
 * The rows of a deviation file as they come, in any order, kept until their grid is known.
 */
#ifndef GEARMESH_DEVIATION_ROWS_H
#define GEARMESH_DEVIATION_ROWS_H

#include <stddef.h>

/** Axes of a flank: t1 along the face, t2 along the profile. */
enum { GMI_FACE = 0, GMI_PROFILE = 1 };

typedef struct gmi_row {
    double position[2]; /**< t1, t2 */
    double value;       /**< deviation (m) */
    long line;
    int slot; /**< which tooth and flank, see flank_slot.h */
} gmi_row;

enum { GMI_ROWS_PER_BLOCK = 1024 };

typedef struct gmi_row_block {
    struct gmi_row_block *next;
    int count; /**< never 0 in a list, but while its first row is read */
    gmi_row rows[GMI_ROWS_PER_BLOCK];
} gmi_row_block;

/** All rows, in a list of blocks: nothing is moved as it grows. Empty = all zero. */
typedef struct gmi_rows {
    gmi_row_block *first;
    gmi_row_block *last;
} gmi_rows;

/** Room for one more row, which becomes one with gmi_rows_take(); NULL if there is no memory for it. */
gmi_row *gmi_rows_room(gmi_rows *rows);

static inline void gmi_rows_take(gmi_rows *rows) {
    ++rows->last->count;
}

/** A place in the rows: `for (row = gmi_rows_first(&at, rows); row; row = gmi_rows_next(&at))`. */
typedef struct gmi_rows_place {
    const gmi_row_block *block;
    int index;
} gmi_rows_place;

static inline const gmi_row *gmi_rows_first(gmi_rows_place *place, const gmi_rows *rows) {
    place->block = rows->first;
    place->index = 0;
    return place->block != NULL ? place->block->rows : NULL;
}

static inline const gmi_row *gmi_rows_next(gmi_rows_place *place) {
    if (++place->index == place->block->count) {
        place->block = place->block->next;
        place->index = 0;
    }
    return place->block != NULL ? place->block->rows + place->index : NULL;
}

void gmi_rows_free(gmi_rows *rows);

#endif /* GEARMESH_DEVIATION_ROWS_H */
