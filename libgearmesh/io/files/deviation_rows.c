/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* A list of rows that grows block by block. */

#include "deviation_rows.h"

#include <stdlib.h>

#define ROWS_PER_BLOCK 1024

struct gmi_row_block {
    gmi_row_block *next;
    int count; /* never 0 in a list */
    gmi_row rows[ROWS_PER_BLOCK];
};

static gmi_row_block *append_block(gmi_rows *rows) {
    gmi_row_block *block = malloc(sizeof *block);
    if (block == NULL) {
        return NULL;
    }
    block->next = NULL;
    block->count = 0;
    if (rows->last != NULL) {
        rows->last->next = block;
    } else {
        rows->first = block;
    }
    rows->last = block;
    return block;
}

int gmi_rows_append(gmi_rows *rows, const gmi_row *row) {
    gmi_row_block *block = rows->last;
    if (block == NULL || block->count == ROWS_PER_BLOCK) {
        block = append_block(rows);
        if (block == NULL) {
            return 0;
        }
    }
    block->rows[block->count++] = *row;
    return 1;
}

const gmi_row *gmi_rows_first(gmi_rows_place *place, const gmi_rows *rows) {
    place->block = rows->first;
    place->index = 0;
    return place->block != NULL ? place->block->rows : NULL;
}

const gmi_row *gmi_rows_next(gmi_rows_place *place) {
    if (++place->index == place->block->count) {
        place->block = place->block->next;
        place->index = 0;
    }
    return place->block != NULL ? place->block->rows + place->index : NULL;
}

void gmi_rows_free(gmi_rows *rows) {
    for (gmi_row_block *block = rows->first; block != NULL;) {
        gmi_row_block *next = block->next;
        free(block);
        block = next;
    }
    rows->first = NULL;
    rows->last = NULL;
}
