/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* From rows in any order to full tables on one uniform grid. */

#include "deviation_grid.h"

#include <math.h>
#include <stdlib.h>

#include "flank_slot.h"
#include "io_error.h"
#include "number_text.h"
#include "shared.h"

/* Digits of a position in a message. */
#define SHOWN_DIGITS 6

static const char *const axis_name[2] = {"t1", "t2"};

static const char *position_text(char text[GMI_NUMBER_SIZE], double position) {
    return gmi_number_text(text, position, 0, SHOWN_DIGITS);
}

/* ---------------------------------------------------------------------------------------------
 * How many positions there are
 *
 * Positions are counted in a histogram as fine as their tolerance. Grid lines are at least 1e-4 apart,
 * so each shows up as a cluster of up to three buckets with empty ones around it.
 * ------------------------------------------------------------------------------------------- */

#define BUCKETS_TO_ONE 100000
#define BUCKETS        (BUCKETS_TO_ONE + 8) /* some to spare beyond 0 and 1, the last ones empty */

typedef struct positions {
    size_t *histogram;      /* [BUCKETS] */
    const gmi_row *lowest;  /* row with the smallest position */
    const gmi_row *highest; /* row with the largest position */
} positions;

static int bucket_of(double position) {
    return (int)(position * BUCKETS_TO_ONE + 2.5);
}

/* Of the rows of a slot, of which there are so many. */
static void count_positions(positions *seen, const gmi_rows *rows, int slot, size_t row_count,
                            int axis) {
    size_t left = row_count;
    gmi_rows_place place;
    for (const gmi_row *row = gmi_rows_first(&place, rows); left > 0; row = gmi_rows_next(&place)) {
        if (row->slot != slot) {
            continue;
        }
        --left;

        const double position = row->position[axis];
        ++seen->histogram[bucket_of(position)];
        if (seen->lowest == NULL || position < seen->lowest->position[axis]) {
            seen->lowest = row;
        }
        if (seen->highest == NULL || position > seen->highest->position[axis]) {
            seen->highest = row;
        }
    }
}

/* Rows in the next cluster from *bucket on, and moves *bucket behind it; 0 = no more clusters. */
static size_t next_cluster(const size_t *histogram, int *bucket) {
    int b = *bucket;
    while (b < BUCKETS && histogram[b] == 0) {
        ++b;
    }
    size_t rows = 0;
    /* Rounding both ways may leave the middle bucket of a cluster empty. */
    while (b < BUCKETS - 1 && (histogram[b] != 0 || histogram[b + 1] != 0)) {
        rows += histogram[b++];
    }
    *bucket = b;
    return rows;
}

static size_t largest_cluster(const size_t *histogram) {
    size_t most = 0;
    int bucket = 0;
    for (size_t rows; (rows = next_cluster(histogram, &bucket)) > 0;) {
        most = rows > most ? rows : most;
    }
    return most;
}

/* Clusters of more than so many rows. */
static int count_clusters(const size_t *histogram, size_t rows_to_beat) {
    int count = 0;
    int bucket = 0;
    for (size_t rows; (rows = next_cluster(histogram, &bucket)) > 0;) {
        count += rows > rows_to_beat ? 1 : 0;
    }
    return count;
}

/*
 * Number of grid lines. In a sound file all have the same number of rows; one with a quarter of the most
 * or less is taken for a slip of the pen, so that a message later names that row and not all others.
 */
static int count_grid_lines(const size_t *histogram) {
    const int lines = count_clusters(histogram, largest_cluster(histogram) / 4);
    return lines >= 2 ? lines : count_clusters(histogram, 0);
}

/* The grid must reach from 0 to 1 in at least two and at most GMI_LARGEST_NODES positions. */
static int check_axis(const positions *seen, int nodes, int axis, gm_io_error *error) {
    const double low = seen->lowest->position[axis];
    const double high = seen->highest->position[axis];
    char name[GMI_SLOT_NAME_SIZE];
    char number[GMI_NUMBER_SIZE];
    gmi_slot_name(name, seen->lowest->slot);

    if (high - low <= 2.0 * GMI_POSITION_TOLERANCE) {
        return gmi_error_set(error, GM_IO_ERR_FORMAT, seen->lowest->line,
                             "%s: must be a grid of at least 2 x 2 nodes from 0 to 1 (got only one "
                             "position %s = %s)",
                             name, axis_name[axis], position_text(number, low));
    }

    if (low > GMI_POSITION_TOLERANCE || high < 1.0 - GMI_POSITION_TOLERANCE) {
        const int is_low = low > GMI_POSITION_TOLERANCE;
        return gmi_error_set(
            error, GM_IO_ERR_FORMAT, is_low ? seen->lowest->line : seen->highest->line,
            "%s: must be a grid from 0 to 1 (got %s = %s as %s position)", name, axis_name[axis],
            position_text(number, is_low ? low : high), is_low ? "first" : "last");
    }

    if (nodes < 2 || nodes > GMI_LARGEST_NODES) {
        return gmi_error_set(error, GM_IO_ERR_FORMAT, seen->lowest->line,
                             "%s: positions %s must be 2 to %d uniform ones from 0 to 1 (got some "
                             "that are too close together)",
                             name, axis_name[axis], GMI_LARGEST_NODES);
    }
    return GM_IO_OK;
}

static int find_axis(gmi_grid *grid, const gmi_rows *rows, size_t row_count, int axis,
                     gm_io_error *error) {
    positions seen = {NULL, NULL, NULL};
    seen.histogram = calloc(BUCKETS, sizeof *seen.histogram);
    if (seen.histogram == NULL) {
        return gmi_error_memory(error);
    }
    count_positions(&seen, rows, grid->slot, row_count, axis);
    grid->nodes[axis] = count_grid_lines(seen.histogram);
    free(seen.histogram);
    return check_axis(&seen, grid->nodes[axis], axis, error);
}

int gmi_grid_find(gmi_grid *grid, const gmi_rows *rows, const size_t *row_count,
                  gm_io_error *error) {
    gmi_rows_place place;
    grid->slot = gmi_rows_first(&place, rows)->slot;

    const size_t count = row_count[grid->slot];
    const int status = find_axis(grid, rows, count, GMI_FACE, error);
    return status != GM_IO_OK ? status : find_axis(grid, rows, count, GMI_PROFILE, error);
}

/* ---------------------------------------------------------------------------------------------
 * Where a row belongs
 * ------------------------------------------------------------------------------------------- */

size_t gmi_grid_size(const gmi_grid *grid) {
    return (size_t)grid->nodes[GMI_FACE] * (size_t)grid->nodes[GMI_PROFILE];
}

/* Place of grid line k, exactly 0 and 1 at the ends. */
static double line_position(const gmi_grid *grid, int axis, int k) {
    return (double)k / (double)(grid->nodes[axis] - 1);
}

/* Never beyond the last line: positions are at most 1 + 1e-5, lines at least 1e-4 apart. */
static int nearest_line(const gmi_grid *grid, int axis, double position) {
    return (int)(position * (grid->nodes[axis] - 1) + 0.5);
}

static int fail_position(const gmi_grid *grid, const gmi_row *row, int axis, gm_io_error *error) {
    const double position = row->position[axis];
    const double nearest = line_position(grid, axis, nearest_line(grid, axis, position));
    char name[GMI_SLOT_NAME_SIZE];
    char got[GMI_NUMBER_SIZE];
    char right[GMI_NUMBER_SIZE];
    return gmi_error_set(
        error, GM_IO_ERR_FORMAT, row->line,
        "%s: must be on the grid of %d x %d uniform nodes that %s begins, for example %s (got %s)",
        axis_name[axis], grid->nodes[GMI_FACE], grid->nodes[GMI_PROFILE],
        gmi_slot_name(name, grid->slot), position_text(right, nearest),
        position_text(got, position));
}

/* Index of the node that a row is for. */
static int find_node(const gmi_grid *grid, const gmi_row *row, size_t *node, gm_io_error *error) {
    int k[2];
    for (int axis = GMI_FACE; axis <= GMI_PROFILE; ++axis) {
        const double position = row->position[axis];
        k[axis] = nearest_line(grid, axis, position);
        if (fabs(position - line_position(grid, axis, k[axis])) > GMI_POSITION_TOLERANCE) {
            return fail_position(grid, row, axis, error);
        }
    }
    *node = (size_t)k[GMI_FACE] * (size_t)grid->nodes[GMI_PROFILE] + (size_t)k[GMI_PROFILE];
    return GM_IO_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Missing and repeated nodes
 * ------------------------------------------------------------------------------------------- */

static int fail_repeated(const gmi_row *row, gm_io_error *error) {
    char name[GMI_SLOT_NAME_SIZE];
    char t1[GMI_NUMBER_SIZE];
    char t2[GMI_NUMBER_SIZE];
    return gmi_error_set(error, GM_IO_ERR_FORMAT, row->line,
                         "%s: must have one row per node (got a second one for t1 = %s, t2 = %s)",
                         gmi_slot_name(name, row->slot), position_text(t1, row->position[GMI_FACE]),
                         position_text(t2, row->position[GMI_PROFILE]));
}

static int fail_missing(const gmi_grid *grid, const gmi_row *first_row, size_t rows, size_t node,
                        gm_io_error *error) {
    const size_t profile_nodes = (size_t)grid->nodes[GMI_PROFILE];
    char name[GMI_SLOT_NAME_SIZE];
    char t1[GMI_NUMBER_SIZE];
    char t2[GMI_NUMBER_SIZE];
    return gmi_error_set(
        error, GM_IO_ERR_FORMAT, first_row->line,
        "%s, which begins here: must have %ld rows for %d x %d nodes (got %ld, and none for t1 = "
        "%s, t2 = %s)",
        gmi_slot_name(name, first_row->slot), (long)gmi_grid_size(grid), grid->nodes[GMI_FACE],
        grid->nodes[GMI_PROFILE], (long)rows,
        position_text(t1, line_position(grid, GMI_FACE, (int)(node / profile_nodes))),
        position_text(t2, line_position(grid, GMI_PROFILE, (int)(node % profile_nodes))));
}

/* Finds what is wrong with a set whose number of rows is not that of its nodes. */
static int explain_set(const gmi_grid *grid, const gmi_rows *rows, size_t row_count, int slot,
                       gm_io_error *error) {
    unsigned char *seen = calloc(gmi_grid_size(grid), 1);
    if (seen == NULL) {
        return gmi_error_memory(error);
    }
    int status = GM_IO_OK;
    const gmi_row *first_row = NULL;
    gmi_rows_place place;

    /* A row off the grid or a second one for a node comes first, ... */
    for (const gmi_row *row = gmi_rows_first(&place, rows); row && status == GM_IO_OK;
         row = gmi_rows_next(&place)) {
        if (row->slot != slot) {
            continue;
        }
        first_row = first_row == NULL ? row : first_row;
        size_t node = 0;
        status = find_node(grid, row, &node, error);
        if (status == GM_IO_OK && seen[node]++) {
            status = fail_repeated(row, error);
        }
    }

    /* ... else a node has none. */
    for (size_t node = 0; status == GM_IO_OK && node < gmi_grid_size(grid); ++node) {
        if (!seen[node]) {
            status = fail_missing(grid, first_row, row_count, node, error);
        }
    }

    free(seen);
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * Tables
 * ------------------------------------------------------------------------------------------- */

/* Allocates a table with every node marked as not given yet; values in a file are never NaN. */
static double *new_table(size_t nodes) {
    double *table = malloc(nodes * sizeof *table);
    for (size_t node = 0; table != NULL && node < nodes; ++node) {
        table[node] = (double)NAN;
    }
    return table;
}

/*
 * The number of rows is checked before anything is allocated, so that a few odd rows cannot ask for
 * large tables: memory stays in proportion to the file.
 */
static int check_row_counts(const gmi_grid *grid, const gmi_rows *rows, const size_t *row_count,
                            int slots, gm_io_error *error) {
    for (int slot = 0; slot < slots; ++slot) {
        if (row_count[slot] != 0 && row_count[slot] != gmi_grid_size(grid)) {
            return explain_set(grid, rows, row_count[slot], slot, error);
        }
    }
    return GM_IO_OK;
}

static int place_row(const gmi_grid *grid, const gmi_row *row, double *table, gm_io_error *error) {
    size_t node = 0;
    const int status = find_node(grid, row, &node, error);
    if (status != GM_IO_OK) {
        return status;
    }
    if (!isnan(table[node])) {
        return fail_repeated(row, error);
    }
    table[node] = row->value;
    return GM_IO_OK;
}

int gmi_grid_fill(const gmi_grid *grid, const gmi_rows *rows, const size_t *row_count,
                  double **values, int slots, gm_io_error *error) {
    int status = check_row_counts(grid, rows, row_count, slots, error);
    for (int slot = 0; status == GM_IO_OK && slot < slots; ++slot) {
        if (row_count[slot] != 0) {
            values[slot] = new_table(gmi_grid_size(grid));
            status = values[slot] != NULL ? GM_IO_OK : gmi_error_memory(error);
        }
    }
    /* As many rows as nodes and none repeated: none is missing. */
    gmi_rows_place place;
    for (const gmi_row *row = gmi_rows_first(&place, rows); row && status == GM_IO_OK;
         row = gmi_rows_next(&place)) {
        status = place_row(grid, row, values[row->slot], error);
    }
    return status;
}
