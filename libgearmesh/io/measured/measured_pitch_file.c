/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Pitch as measuring machines give it: docs/measured-flanks.md. Only the text is judged here. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files/io_error.h"
#include "files/table_reader.h"
#include "measured_table.h"
#include "measurement.h"
#include "mka_file.h"

/* Micrometres in the file, metres in memory. */
#define MICRO (-6)

enum { VALUE = GMI_COLUMN_FLANK + 1, PITCH_COLUMNS };

static const char *const cumulative_header[PITCH_COLUMNS] = {"tooth", "flank",
                                                             "cumulative_pitch_um"};
static const char *const single_header[PITCH_COLUMNS] = {"tooth", "flank", "single_pitch_um"};
static const char *const *const pitch_headers[] = {cumulative_header, single_header};
enum { PITCH_HEADERS = 2 };

static int read_pitch_row(const gmi_table *table, gm_pitch_point *row) {
    int status = gmi_measured_place(table, &row->tooth, &row->flank);
    if (status == GM_IO_OK) {
        status = gmi_table_number(table, VALUE, MICRO, &row->value);
    }
    row->line = table->line;
    return status;
}

static int read_pitch_rows(gm_measured_pitch *pitch, gmi_table *table) {
    int capacity = 0;
    int more = 0;
    while ((more = gmi_table_next(table)) > 0) {
        gm_pitch_point row;
        const int status = read_pitch_row(table, &row);
        if (status != GM_IO_OK) {
            return status;
        }

        gm_pitch_point *grown =
            gmi_array_grow(pitch->points, sizeof *grown, pitch->count, &capacity);
        if (grown == NULL) {
            return gmi_error_memory(table->error);
        }
        pitch->points = grown;
        pitch->points[pitch->count++] = row;
    }
    return more == 0 && pitch->count == 0 ? gmi_measured_fail_empty(table) : more;
}

static int read_pitch_table(gm_measured_pitch *pitch, const char *path, int style,
                            gm_io_error *error) {
    gmi_table table;
    int status = gmi_table_open_any(&table, path, pitch_headers, PITCH_HEADERS, PITCH_COLUMNS,
                                    style, &pitch->single, error);
    if (status == GM_IO_OK) {
        status = read_pitch_rows(pitch, &table);
    }
    gmi_table_close(&table);
    return status;
}

int gm_measured_pitch_read(gm_measured_pitch *pitch, const char *path, int style,
                           gm_io_error *error) {
    gmi_error_begin(error, path);
    if (pitch != NULL) {
        memset(pitch, 0, sizeof *pitch);
    }
    if (pitch == NULL || path == NULL) {
        return gmi_error_null(error);
    }

    const int status = gmi_is_mka(path) ? gmi_mka_pitch(pitch, path, style, error)
                                        : read_pitch_table(pitch, path, style, error);
    if (status == GM_IO_OK) {
        snprintf(pitch->file, sizeof pitch->file, "%s", path);
    } else {
        gm_measured_pitch_free(pitch);
    }
    return status;
}

void gm_measured_pitch_free(gm_measured_pitch *pitch) {
    if (pitch != NULL) {
        free(pitch->points);
        memset(pitch, 0, sizeof *pitch);
    }
}
