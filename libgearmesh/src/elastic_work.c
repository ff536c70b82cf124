/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The workspace of elastic teeth: its arrays in the memory of the caller.
 */
#include "elastic.h"
#include "internal.h"

#include <string.h>

/* Sizes of the arrays of a workspace, in doubles. */
typedef struct work_sizes {
    size_t points, slots, nodes, front, factor, ends, carry;
    size_t cuts; /* these in cuts */
} work_sizes;

static work_sizes find_sizes(int stations, int lines, int creases) {
    const size_t n = (size_t)stations, rows = (size_t)lines + 1;
    const size_t cuts = (size_t)gmi_elastic_cuts_of(lines, creases);
    const size_t slots = (size_t)lines * (n - 1) + cuts;
    const work_sizes sizes = {2 * slots,
                              slots,
                              rows * n,
                              rows * rows + 2 * rows * (rows + 4),
                              n * (rows * (rows + 4) + rows * (rows + 1) / 2),
                              8 * (size_t)lines,
                              rows * (rows + 4),
                              cuts};
    return sizes;
}

enum { POINT_ARRAYS = 31, TABLE_ARRAYS = 4, PART_ARRAYS = 4, NODE_ARRAYS = 8, LISTS = 3 };

static int sizes_fit(int stations, int lines, int creases) {
    return stations >= 2 && stations <= GMI_ELASTIC_STATIONS_MAX && lines >= 1 &&
           lines <= GMI_ELASTIC_LINES_MAX && creases >= 0 && creases <= GMI_ELASTIC_CREASES_MAX;
}

size_t gmi_elastic_work_size(int stations, int lines, int creases) {
    if (!sizes_fit(stations, lines, creases)) {
        return 0;
    }
    const work_sizes sizes = find_sizes(stations, lines, creases);
    const size_t doubles = (POINT_ARRAYS + 2 * TABLE_ARRAYS) * sizes.points +
                           (GMI_ELASTIC_MATRICES + PART_ARRAYS) * sizes.slots +
                           NODE_ARRAYS * sizes.nodes + sizes.front + sizes.factor + sizes.ends +
                           sizes.carry;

    /* Whole doubles, so that what comes behind is aligned as well. */
    const size_t bytes =
        sizeof(gmi_elastic_crease) * (size_t)creases + sizeof(gmi_elastic_cut) * sizes.cuts +
        sizeof(gmi_elastic_run) * (size_t)stations + sizeof(int) * LISTS * sizes.points;
    return sizeof(double) * (doubles + (bytes + sizeof(double) - 1) / sizeof(double));
}

static double *take(double **memory, size_t count) {
    double *array = *memory;
    *memory += count;
    return array;
}

void gmi_elastic_work_init(gmi_elastic_work *work, int stations, int lines, int creases,
                           void *memory) {
    const work_sizes sizes = find_sizes(stations, lines, creases);
    double *next = memory;
    memset(work, 0, sizeof *work);
    memset(memory, 0, gmi_elastic_work_size(stations, lines, creases));
    work->stations = stations;
    work->lines_max = lines;
    work->creases_max = creases;

    double **const points[POINT_ARRAYS] = {&work->z,
                                           &work->roll,
                                           &work->beyond,
                                           &work->weight,
                                           &work->deviation,
                                           &work->deviation_by_roll,
                                           &work->deviation_by_z,
                                           &work->load,
                                           &work->approach_at,
                                           &work->force,
                                           &work->stiffness,
                                           &work->by_deviation,
                                           &work->entry_slope,
                                           &work->entry_curvature,
                                           &work->place,
                                           &work->tooth,
                                           &work->tooth_by_roll,
                                           &work->tooth_by_action,
                                           &work->rate,
                                           &work->rate_by_roll,
                                           &work->rate_by_action,
                                           &work->deflection,
                                           &work->slope,
                                           &work->change_at,
                                           &work->expected,
                                           &work->excess,
                                           &work->stiffer,
                                           &work->held_by_roll,
                                           &work->scratch,
                                           &work->pull,
                                           &work->tooth_adjoint};

    for (int k = 0; k < POINT_ARRAYS; ++k) {
        *points[k] = take(&next, sizes.points);
    }
    for (int k = 0; k < TABLE_ARRAYS; ++k) {
        work->table[k] = take(&next, 2 * sizes.points);
    }

    work->matrix = take(&next, GMI_ELASTIC_MATRICES * sizes.slots);
    for (int k = 0; k < PART_ARRAYS; ++k) {
        work->parts[k] = take(&next, sizes.slots);
    }

    double **const nodes[NODE_ARRAYS] = {&work->state,     &work->change,   &work->adjoint,
                                         &work->last,      &work->by_place, &work->place_curve,
                                         &work->last_step, &work->other};
    for (int k = 0; k < NODE_ARRAYS; ++k) {
        *nodes[k] = take(&next, sizes.nodes);
    }
    work->front = take(&next, sizes.front);
    work->factor = take(&next, sizes.factor);
    work->carry = take(&next, sizes.carry);
    work->end_record = take(&next, sizes.ends);

    /* Behind the doubles, so that all are aligned: first what has doubles itself. */
    work->crease = (gmi_elastic_crease *)(void *)next;
    work->cut = (gmi_elastic_cut *)(void *)(work->crease + creases);
    work->run = (gmi_elastic_run *)(void *)(work->cut + sizes.cuts);
    work->outer[0] = (int *)(void *)(work->run + stations);
    work->outer[1] = work->outer[0] + sizes.points;
    work->chosen = work->outer[1] + sizes.points;
}

void gmi_elastic_work_reset(gmi_elastic_work *work) {
    memset(work->state, 0, sizeof(double) * (size_t)(work->lines_max + 1) * (size_t)work->stations);
    work->warm = 0;
    work->touching = 0;
}
