/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Pitch files: `tooth,flank,deviation_um`, described in docs/flank-files.md. */

#include "pitch_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "flank_slot.h"
#include "io_error.h"
#include "number_text.h"
#include "table_reader.h"
#include "table_writer.h"

enum { COLUMN_TOOTH, COLUMN_FLANK, COLUMN_DEVIATION, COLUMN_COUNT };

static const char *const columns[COLUMN_COUNT] = {"tooth", "flank", "deviation_um"};

/* Micrometres in the file, metres in memory. */
#define MICRO (-6)

/* What the file says of one slot. */
typedef struct entry {
    double deviation; /* (m) */
    long line;        /* 0 = the file has no row for it */
} entry;

/* ---------------------------------------------------------------------------------------------
 * Reading
 * ------------------------------------------------------------------------------------------- */

static int read_row(const gmi_table *table, int teeth, int *slot, double *deviation) {
    int tooth = GMI_ALL;
    int side = GMI_ALL;
    int status = gmi_table_tooth(table, COLUMN_TOOTH, teeth, &tooth);
    if (status == GM_IO_OK) {
        status = gmi_table_flank(table, COLUMN_FLANK, &side);
    }
    if (status == GM_IO_OK) {
        status = gmi_table_number(table, COLUMN_DEVIATION, MICRO, deviation);
    }
    *slot = gmi_slot(tooth, side);
    return status;
}

static int keep_row(const gmi_table *table, int slot, double deviation, entry *entries) {
    if (entries[slot].line != 0) {
        char name[GMI_SLOT_NAME_SIZE];
        return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line,
                             "%s: must have one row (got a second one, the first is in line %ld)",
                             gmi_slot_name(name, slot), entries[slot].line);
    }
    entries[slot].deviation = deviation;
    entries[slot].line = table->line;
    return GM_IO_OK;
}

static int read_rows(gmi_table *table, int teeth, entry *entries) {
    int more = 0;
    long rows = 0;
    while ((more = gmi_table_next(table)) > 0) {
        int slot = 0;
        double deviation = 0.0;
        int status = read_row(table, teeth, &slot, &deviation);
        if (status == GM_IO_OK) {
            status = keep_row(table, slot, deviation, entries);
        }
        if (status != GM_IO_OK) {
            return status;
        }
        ++rows;
    }

    if (more == 0 && rows == 0) {
        return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line,
                             "there must be at least one row below the header (got none)");
    }
    return more;
}

static int read_file(const char *path, int teeth, entry *entries, gm_io_error *error) {
    gmi_table table;
    int status = gmi_table_open(&table, path, columns, COLUMN_COUNT, error);
    if (status == GM_IO_OK) {
        status = read_rows(&table, teeth, entries);
    }
    gmi_table_close(&table);
    return status;
}

int gmi_pitch_allocate(gm_pitch *pitch, int teeth, gm_io_error *error) {
    const size_t count = (size_t)teeth;
    pitch->teeth = teeth;
    pitch->drive = calloc(count, sizeof *pitch->drive);
    pitch->coast = calloc(count, sizeof *pitch->coast);
    pitch->drive_set = calloc(count, sizeof *pitch->drive_set);
    pitch->coast_set = calloc(count, sizeof *pitch->coast_set);
    if (pitch->drive && pitch->coast && pitch->drive_set && pitch->coast_set) {
        return GM_IO_OK;
    }
    gm_pitch_free(pitch);
    return gmi_error_memory(error);
}

/* The most special row that serves a flank gives its deviation. */
static void resolve_flank(const entry *entries, int tooth, int side, double *deviation, int *set) {
    for (int k = 0; k < GMI_CANDIDATES; ++k) {
        const entry *candidate = &entries[gmi_slot_candidate(tooth, side, k)];
        if (candidate->line != 0) {
            *deviation = candidate->deviation;
            *set = 1;
            return;
        }
    }
}

static int make_pitch(gm_pitch *pitch, int teeth, const entry *entries, gm_io_error *error) {
    const int status = gmi_pitch_allocate(pitch, teeth, error);
    if (status != GM_IO_OK) {
        return status;
    }
    for (int tooth = 0; tooth < teeth; ++tooth) {
        resolve_flank(entries, tooth, GM_DRIVE, &pitch->drive[tooth], &pitch->drive_set[tooth]);
        resolve_flank(entries, tooth, GM_COAST, &pitch->coast[tooth], &pitch->coast_set[tooth]);
    }
    return GM_IO_OK;
}

int gm_pitch_read(gm_pitch *pitch, const char *path, int teeth, gm_io_error *error) {
    gmi_error_begin(error, path);
    if (pitch != NULL) {
        memset(pitch, 0, sizeof *pitch);
    }
    if (pitch == NULL || path == NULL) {
        return gmi_error_null(error);
    }
    int status = gmi_check_teeth(teeth, error);
    if (status != GM_IO_OK) {
        return status;
    }

    /* Rows may come in any order: they are kept by slot until the last one is read. */
    entry *entries = calloc((size_t)gmi_slot_count(teeth), sizeof *entries);
    if (entries == NULL) {
        return gmi_error_memory(error);
    }
    status = read_file(path, teeth, entries, error);
    if (status == GM_IO_OK) {
        status = make_pitch(pitch, teeth, entries, error);
    }
    free(entries);
    return status;
}

void gm_pitch_free(gm_pitch *pitch) {
    if (pitch == NULL) {
        return;
    }
    free(pitch->drive);
    free(pitch->coast);
    free(pitch->drive_set);
    free(pitch->coast_set);
    memset(pitch, 0, sizeof *pitch);
}

int gm_pitch_ideal_teeth(const gm_pitch *pitch, int side) {
    if (pitch == NULL || (side != GM_DRIVE && side != GM_COAST)) {
        return 0;
    }
    const int *set = side == GM_DRIVE ? pitch->drive_set : pitch->coast_set;
    int ideal = 0;
    for (int tooth = 0; tooth < pitch->teeth; ++tooth) {
        ideal += set[tooth] == 0 ? 1 : 0;
    }
    return ideal;
}

/* ---------------------------------------------------------------------------------------------
 * Checking and writing
 * ------------------------------------------------------------------------------------------- */

int gmi_pitch_check(const gm_pitch *pitch, gm_io_error *error) {
    const int status = gmi_check_teeth(pitch->teeth, error);
    if (status != GM_IO_OK) {
        return status;
    }
    if (!pitch->drive || !pitch->coast || !pitch->drive_set || !pitch->coast_set) {
        return gmi_error_set(error, GM_IO_ERR_NULL, 0,
                             "pitch deviations: no array must be NULL (got one that is)");
    }

    for (int tooth = 0; tooth < pitch->teeth; ++tooth) {
        if (!isfinite(pitch->drive[tooth]) || !isfinite(pitch->coast[tooth])) {
            return gmi_error_set(
                error, GM_IO_ERR_OPTION, 0,
                "the pitch deviations of tooth %d: must be finite (got one that is not)", tooth);
        }
    }
    return GM_IO_OK;
}

/* Pitch deviations that cannot be read back are not written. */
static int check_writable(const gm_pitch *pitch, gm_io_error *error) {
    const int status = gmi_pitch_check(pitch, error);
    if (status != GM_IO_OK) {
        return status;
    }
    if (gm_pitch_ideal_teeth(pitch, GM_DRIVE) == pitch->teeth &&
        gm_pitch_ideal_teeth(pitch, GM_COAST) == pitch->teeth) {
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "pitch deviations to write: must be at least one (got none)");
    }
    return GM_IO_OK;
}

/* Nonzero if it failed. */
static int print_flank(FILE *stream, int tooth, int side, double deviation, int set) {
    char value[GMI_NUMBER_SIZE];

    return set && fprintf(stream, "%d,%s,%s\n", tooth, gmi_side_name(side),
                          gmi_number_text(value, deviation, -MICRO, 0)) < 0;
}

static int print_rows(FILE *stream, const void *data) {
    const gm_pitch *pitch = data;
    int failed = 0;

    for (int tooth = 0; tooth < pitch->teeth && !failed; ++tooth) {
        failed =
            print_flank(stream, tooth, GM_DRIVE, pitch->drive[tooth], pitch->drive_set[tooth]) ||
            print_flank(stream, tooth, GM_COAST, pitch->coast[tooth], pitch->coast_set[tooth]);
    }
    return failed;
}

int gm_pitch_print(const gm_pitch *pitch, FILE *stream, gm_io_error *error) {
    gmi_error_begin(error, NULL);
    if (pitch == NULL || stream == NULL) {
        return gmi_error_null(error);
    }

    const int status = check_writable(pitch, error);
    const gmi_written table = {columns, COLUMN_COUNT, print_rows, pitch};
    return status == GM_IO_OK ? gmi_table_print(&table, stream, error) : status;
}

int gm_pitch_write(const gm_pitch *pitch, const char *path, gm_io_error *error) {
    gmi_error_begin(error, path);
    if (pitch == NULL || path == NULL) {
        return gmi_error_null(error);
    }

    /* No file is touched for data that cannot be read back. */
    const int status = check_writable(pitch, error);
    const gmi_written table = {columns, COLUMN_COUNT, print_rows, pitch};
    return status == GM_IO_OK ? gmi_table_write(&table, path, error) : status;
}
