/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* A list of rows that grows block by block. */

#include "deviation_rows.h"
#include "shared.h"

#include <stdlib.h>

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

gmi_row *gmi_rows_room(gmi_rows *rows) {
    gmi_row_block *block = rows->last;
    if (block == NULL || block->count == GMI_ROWS_PER_BLOCK) {
        block = append_block(rows);
    }
    return block != NULL ? &block->rows[block->count] : NULL;
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
