/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Where equilibria under several loads at one position are, from walks along the lines that tell of all of them at once.
 *
 * A first walk gives the sum at a few places between no contact and more than the largest load; a cubic between them says
 * where each load is carried. Two more walks, with all loads as depths, correct that by the sum, its slope and its bend.
 * What is left is of third order in the distance from the place of the walk: next to nothing.
 *
 * As in equilibrium.c, "travel" is direction * x, which grows with the load.
 */
#include "contact.h"
#include "equilibrium.h"
#include "internal.h"
#include "law.h"
#include "line.h"
#include "mesh.h"
#include "penetration.h"

#include <math.h>
#include <string.h>

enum { COARSE_PLACES = 12, CORRECTIONS = 2 };

/* Loads on one side, by size. */
typedef struct load_block {
    const gm_mesh *mesh;
    int side;
    gm_position position; /* phase and teeth, posed */
    int count;
    short index[GMI_LOADS_MAX];   /* of each load among those of the caller */
    double target[GMI_LOADS_MAX]; /* sums that carry them, ascending (m) */
    double travel[GMI_LOADS_MAX]; /* where they are carried (m) */
} load_block;

/* The sums at several places, which ascend, by a walk in their middle. */
static void walk(load_block *block, const double *places, int count, gmi_depths *depths) {
    const gm_mesh *mesh = block->mesh;
    const double middle = 0.5 * (places[0] + places[count - 1]);

    /* How far each place is from there, and about how many there are to a length: where to look first. */
    memset(depths, 0, sizeof *depths);
    depths->count = count;
    for (int n = 0; n < count; ++n) {
        depths->shift[n] = places[n] - middle;
    }
    depths->largest = depths->shift[count - 1];
    const double range = depths->largest - depths->shift[0];
    depths->per_shift = range > 0.0 ? (double)(count - 1) / range : 0.0;
    depths->touch = -HUGE_VAL; /* not wanted */

    block->position.offset = gmi_side_sign(block->side) * middle;
    gmi_side_sum_depths(mesh->pair, &mesh->engagement, &mesh->side[block->side], block->side,
                        &block->position, depths);
}

/* Where a sum is reached between two places, as a share of their distance; slopes over that distance. */
static double share_between(const gmi_depth_sum *from, const gmi_depth_sum *to, double distance,
                            double target) {
    enum { STEPS = 4 };
    const double rise = to->sum - from->sum;
    const double begin = from->by_delta * distance, end = to->by_delta * distance;
    const double square = 3.0 * rise - 2.0 * begin - end, cube = begin + end - 2.0 * rise;

    /* Newton's method on the cubic, from the straight line. */
    double share = (target - from->sum) / rise;
    for (int k = 0; k < STEPS; ++k) {
        const double value = from->sum + share * (begin + share * (square + share * cube));
        const double slope = begin + share * (2.0 * square + share * 3.0 * cube);
        const double next = share - (value - target) / slope;
        share = next > 0.0 && next < 1.0 ? next : share;
    }
    return share;
}

/* Roughly, and only as many as are carried. */
static void place_loads(load_block *block, gmi_depths *depths) {
    const gm_mesh *mesh = block->mesh;
    const double peak = mesh->side[block->side].peak;
    const double limit = 0.4999999 * mesh->pair->transverse_base_pitch;
    const double largest = block->target[block->count - 1];

    /* From where nothing touches to beyond all deviations. */
    const double lower = 0.5 * mesh->engagement.backlash - peak;
    const double upper = fmin(lower + largest + 3.0 * fmax(peak, 0.0), limit);
    const double distance = (upper - lower) / (double)(COARSE_PLACES - 1);
    double places[COARSE_PLACES];
    for (int n = 0; n < COARSE_PLACES; ++n) {
        places[n] = lower + (double)n * distance;
    }
    if (!(distance > 0.0) || upper - lower > fabs(mesh->pair->face_advance)) {
        block->count = 0; /* so close to spur gears the sum may fall */
        return;
    }
    walk(block, places, COARSE_PLACES, depths);

    /* Loads ascend as the sums do, so that each is looked for from the one before. */
    int n = 0;
    for (int k = 0; k < block->count; ++k) {
        while (n < COARSE_PLACES - 1 && !(depths->part[n + 1].sum > block->target[k])) {
            ++n;
        }
        if (n == COARSE_PLACES - 1) {
            block->count = k;
            return;
        }
        const double share =
            share_between(&depths->part[n], &depths->part[n + 1], distance, block->target[k]);
        block->travel[k] = places[n] + share * distance;
    }
}

/* Each by what the sum there lacks: to second order. */
static void correct_loads(load_block *block, gmi_depths *depths) {
    walk(block, block->travel, block->count, depths);
    for (int k = 0; k < block->count; ++k) {
        const gmi_depth_sum *at = &depths->part[k];
        const double missing = block->target[k] - at->sum;
        const double root = sqrt(fmax(0.0, at->by_delta * at->by_delta + 4.0 * at->bend * missing));
        const double step = 2.0 * missing / (at->by_delta + root);
        block->travel[k] += gmi_is_finite(step) ? step : 0.0;
    }
}

static OWN_STACK void guess_loads(load_block *block, double *offset, double *slope) {
    gmi_depths depths;
    if (block->count > 0) {
        place_loads(block, &depths);
    }
    for (int k = 0; k < CORRECTIONS && block->count > 0; ++k) {
        correct_loads(block, &depths);
    }
    for (int k = 0; k < block->count; ++k) {
        offset[block->index[k]] = gmi_side_sign(block->side) * block->travel[k];
        slope[block->index[k]] = depths.part[k].by_delta;
    }
}

/* The loads of the side. */
static void take_loads(load_block *block, const double *wheel_torque, int count) {
    const double r_bw = block->mesh->pair->wheel.base_radius;
    block->count = 0;
    for (int k = 0; k < count; ++k) {
        const double target = gmi_side_sign(block->side) *
                              gmi_law_sum_of_torque(&block->mesh->law, wheel_torque[k], r_bw);
        if (!(target > 0.0)) {
            continue;
        }

        /* Where it belongs among those before it. */
        int place = block->count++;
        for (; place > 0 && block->target[place - 1] > target; --place) {
            block->target[place] = block->target[place - 1];
            block->index[place] = block->index[place - 1];
        }
        block->target[place] = target;
        block->index[place] = (short)k;
    }
}

void gmi_equilibrium_guesses(const gm_mesh *mesh, const gm_position *position,
                             const double *wheel_torque, int count, double *offset, double *slope) {
    load_block block;
    block.mesh = mesh;
    block.position = *position;
    for (int k = 0; k < count; ++k) {
        offset[k] = slope[k] = gmi_nan();
    }
    for (block.side = GM_DRIVE; block.side <= GM_COAST; ++block.side) {
        if (gmi_side_has_depths(mesh, block.side)) {
            take_loads(&block, wheel_torque, count);
            guess_loads(&block, offset, slope);
        }
    }
}
