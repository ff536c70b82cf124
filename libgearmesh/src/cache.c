/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * A cache in place of the 3D model for one flank side: per tooth pass a table over phase and delta.
 *
 * A column is one phase of one tooth pass. Its first node is where that phase begins to touch, the others stand at equal
 * steps of delta behind it; each keeps the exact sum, the exact derivatives by delta and phase, and the mixed derivative
 * from its neighbours. Between nodes a bicubic Hermite polynomial gives the sum and its derivatives. Columns start where
 * they begin to touch because that varies by tens of micrometres from tooth to tooth, and what lies below is zero. The
 * phase p_bt of a pass is phase 0 of the next one, and its column is that one's.
 *
 * In phase the sum has kinks: where a line of contact enters or leaves the field of action through a corner, four
 * times per base pitch. Columns stand just before and just behind each kink, so that all other cells are smooth. A
 * kink moves with delta where the wheel sets the limit; the cell around it is as wide as it moves, and narrow still.
 *
 * With corner contact lines enter and leave without a kink. What a tip's arm is shorter by is small beside the sum: each
 * node keeps it for both tips, and it is straight in delta and phase between them.
 */
#include "cache.h"

#include "contact.h"
#include "corner.h"
#include "elastic_mesh.h"
#include "flank.h"
#include "internal.h"
#include "line.h"
#include "mesh.h"
#include "meshing.h"
#include "penetration.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Corners of the field of action; phases that must have a column: 0, p_bt, and both sides of each corner. */
enum { CORNERS = 4, KNOTS = 2 + 2 * CORNERS };

/* Columns stand off the kinks by this part of p_bt; below half of it two of them are one. */
static const double kink_margin = 1e-4;

/* A column begins at most depth / 2^START_BISECTIONS below the delta at which contact begins. */
enum { START_BISECTIONS = 12 };

enum { LARGEST_CELLS = 10000 };

/*
 * A kink within a cell is weak beside all else that tables leave where cells are few, where a line that enters grows by less
 * than this part of its length within a cell, and where flanks deviate by more than the load presses them.
 */
static const double weak_kink = 1.0 / 12.0;
enum { CELLS_WITH_KINKS = 12 };

#define SMALLEST_DEPTH 1e-10 /* (m) */

/* Values of a node: two, and how they grow with delta, per step. */
enum node { NODE_SUM, NODE_BY_PHASE, NODE_BY_DELTA, NODE_MIXED, NODE_VALUES };

/* ---------------------------------------------------------------------------------------------
 * Tooth passes
 * ------------------------------------------------------------------------------------------- */

/* Teeth after which the flanks of a gear repeat: 1 or all. */
static int period_of(const gmi_tables *tables, int teeth) {
    for (int tooth = 1; tables != NULL && tooth < teeth; ++tooth) {
        if (tables->table[tooth] != tables->table[0] || tables->pitch[tooth] != tables->pitch[0]) {
            return teeth;
        }
    }
    return 1;
}

/* Greatest common divisor of both periods, each of which is 1 or the number of teeth. */
static int common_divisor(const gm_cache *cache) {
    if (cache->pinion_period == 1 || cache->wheel_period == 1) {
        return 1;
    }
    const double all = (double)cache->pinion_period * cache->wheel_period;
    return (int)(all / cache->pair->hunting_passes);
}

/* Number of the tooth pass, -1 if these two teeth never meet in the pair as assembled. */
static int pass_of(const gm_cache *cache, const gm_position *position) {
    const int pinion = cache->pinion_period == 1 ? 0 : position->pinion_tooth;
    const int wheel = cache->wheel_period == 1 ? 0 : position->wheel_tooth;
    if (cache->common == 1) {
        return pinion * cache->wheel_period + wheel;
    }
    if ((pinion - wheel) % cache->common != 0) {
        return -1;
    }
    return pinion * (cache->wheel_period / cache->common) + wheel / cache->common;
}

/* Teeth of a tooth pass: the inverse. */
static void set_teeth(const gm_cache *cache, int pass, gm_position *position) {
    const int per_tooth = cache->wheel_period / cache->common;
    position->pinion_tooth = pass / per_tooth;
    position->wheel_tooth =
        (pass % per_tooth) * cache->common + position->pinion_tooth % cache->common;
}

/* The pass that follows, in which both gears are one tooth further on: as in position.c. */
static int pass_behind(const gm_cache *cache, int pass) {
    gm_position next;
    set_teeth(cache, pass, &next);
    next.pinion_tooth = gmi_next_tooth(next.pinion_tooth, -1, cache->pinion_period);
    next.wheel_tooth = gmi_next_tooth(next.wheel_tooth, -1, cache->wheel_period);
    return pass_of(cache, &next);
}

/* ---------------------------------------------------------------------------------------------
 * Phases of the columns
 * ------------------------------------------------------------------------------------------- */

/* Ends of the field of action in rho_p, as in contact.c. */
typedef struct field_ends {
    double lower, upper;
} field_ends;

static field_ends find_field(const gmi_engagement *at, double delta) {
    const double reach = at->line_of_action + delta;
    const field_ends ends = {
        fmax(at->start_roll_length[GM_PINION], reach - at->tip_roll_length[GM_WHEEL]),
        fmin(at->tip_roll_length[GM_PINION], reach - at->start_roll_length[GM_WHEEL])};
    return ends;
}

static void insert_knot(double knots[KNOTS], int *count, double phase) {
    int place = (*count)++;
    for (; place > 0 && knots[place - 1] > phase; --place) {
        knots[place] = knots[place - 1];
    }
    knots[place] = phase;
}

/* How many there are. Line k is in a corner where origin + k p_bt + t1 advance = end, with t1 = 0 or 1; see contact.c. */
static int find_knots(const gm_cache *cache, double knots[KNOTS]) {
    const gm_pair *pair = cache->pair;
    const gmi_engagement *at = &cache->mesh->engagement;
    const double p_bt = pair->transverse_base_pitch;
    const double sign = cache->side == GM_DRIVE ? 1.0 : -1.0;
    const field_ends low = find_field(at, cache->lowest);
    const field_ends high = find_field(at, fmax(0.0, cache->lowest) + 2.0 * cache->depth);

    /* Columns stand a margin off the range that a kink moves over. */
    const double margin = kink_margin * p_bt;

    int count = 0;
    insert_knot(knots, &count, 0.0);
    insert_knot(knots, &count, p_bt);
    if (cache->has_corners || cache->has_weak_kinks) {
        return count;
    }

    /* Each corner of the field of action: lower or upper end of the path, one end of the face or the other. */
    for (int corner = 0; corner < CORNERS; ++corner) {
        const double origin =
            at->phase_origin[cache->side] +
            (corner % 2 == 0 ? at->face_from : at->face_to) * (sign * pair->face_advance);
        const double ends[2] = {(corner < 2 ? low.lower : low.upper) - margin,
                                (corner < 2 ? high.lower : high.upper) + margin};
        for (int end = 0; end < 2; ++end) {
            const double phase = sign * (ends[end] - origin);
            insert_knot(knots, &count, phase - p_bt * floor(phase / p_bt));
        }
    }
    return count;
}

/*
 * Knots, and equal steps between them of at most p_bt / cells, or of one more where kinks have no columns. Returns the number
 * of columns before p_bt; phases may be NULL.
 */
static int place_columns(const gm_cache *cache, int phase_cells, double *phases) {
    const double p_bt = cache->pair->transverse_base_pitch;
    const int cells = phase_cells + (cache->has_weak_kinks ? 1 : 0);
    double knots[KNOTS];
    const int count = find_knots(cache, knots);

    /* From knot to knot; those that lie together are one. */
    int columns = 0;
    double from = 0.0;
    for (int i = 1; i < count; ++i) {
        /* The last knot is p_bt, or another one within a rounding of it. */
        const double width = (i == count - 1 ? p_bt : knots[i]) - from;
        if (width < 0.5 * kink_margin * p_bt && i < count - 1) {
            continue;
        }

        /* Columns at the begin of each step, the first one at the knot itself. */
        const int steps = (int)ceil(width / p_bt * (double)cells);
        for (int k = 0; k < steps; ++k, ++columns) {
            if (phases != NULL) {
                phases[columns] = from + width * (double)k / (double)steps;
            }
        }
        from += width;
    }
    if (phases != NULL) {
        phases[columns] = p_bt;
    }
    return columns;
}

/* ---------------------------------------------------------------------------------------------
 * Set-up
 * ------------------------------------------------------------------------------------------- */

void gm_cache_params_default(gm_cache_params *params) {
    if (params == NULL) {
        return;
    }
    params->side = GM_DRIVE;
    params->phase_cells = 16;
    params->depth_cells = 40;
    params->depth = 20e-6;
}

static int check_cells(int cells) {
    return cells >= 4 && cells <= LARGEST_CELLS;
}

static int check_params(const gm_cache_params *params, const gm_pair *pair) {
    return (params->side == GM_DRIVE || params->side == GM_COAST) &&
           check_cells(params->phase_cells) && check_cells(params->depth_cells) &&
           params->depth >= SMALLEST_DEPTH && params->depth <= 0.25 * pair->transverse_base_pitch;
}

/* Whether kinks go without columns, and better cells have their time. Where one pass is all there is, they take none. */
static int has_weak_kinks(const gm_cache *cache, int cells, int64_t passes) {
    const double cell = cache->pair->transverse_base_pitch / (double)cells;

    return !cache->has_corners && passes > 1 && cells < CELLS_WITH_KINKS &&
           cell < weak_kink * cache->pair->face_advance &&
           cache->depth < cache->mesh->side[cache->side].flank_peak;
}

/* All of the cache but its memory. */
static int describe(gm_cache *cache, const gm_cache_params *params, const gm_mesh *mesh) {
    if (params == NULL || mesh == NULL) {
        return GM_ERR_NULL;
    }
    const gm_pair *pair = mesh->pair;
    if (!check_params(params, pair)) {
        return GM_ERR_PARAMETER;
    }
    if (pair->face_advance == 0.0 || mesh->model == GM_MODEL_SIMPLE) {
        return GM_ERR_GEOMETRY;
    }

    /* Which teeth there are to tell apart. */
    const gmi_side *side = &mesh->side[params->side];
    memset(cache, 0, sizeof *cache);
    cache->mesh = mesh;
    cache->pair = pair;
    cache->side = params->side;
    cache->has_corners = mesh->has_corners;
    cache->pinion_period = period_of(side->pinion, pair->pinion.teeth);
    cache->wheel_period = period_of(side->wheel, pair->wheel.teeth);

    /* Teeth that are not all as stiff differ as well. */
    if (gmi_elastic_is_uneven(mesh, GM_PINION)) {
        cache->pinion_period = pair->pinion.teeth;
    }
    if (gmi_elastic_is_uneven(mesh, GM_WHEEL)) {
        cache->wheel_period = pair->wheel.teeth;
    }
    cache->common = common_divisor(cache);

    /* The grid over phase and delta. */
    cache->depth = params->depth;
    cache->lowest = -side->peak;
    cache->nodes = params->depth_cells + 1;
    cache->step = params->depth / (double)params->depth_cells;
    cache->per_step = 1.0 / cache->step;

    /* Which columns there are. */
    const int64_t passes = (int64_t)cache->pinion_period * (cache->wheel_period / cache->common);
    cache->has_weak_kinks = has_weak_kinks(cache, params->phase_cells, passes);
    cache->columns = place_columns(cache, params->phase_cells, NULL);
    cache->columns_per_phase = (double)cache->columns / pair->transverse_base_pitch;

    /* 1e5 teeth each give 1e10 passes at most: more than fits any memory, but not into an int. */
    if (passes * cache->columns > INT32_MAX) {
        return GM_ERR_MEMORY;
    }
    cache->passes = (int)passes;
    return GM_OK;
}

static size_t all_columns(const gm_cache *cache) {
    return (size_t)cache->passes * (size_t)cache->columns;
}

/* Bytes: the object, a phase per column and p_bt, a start per column of every pass, then nodes and arms. 0 if too many. */
static size_t bytes_of(const gm_cache *cache) {
    const uint64_t values = NODE_VALUES + (cache->has_corners ? 2 : 0);
    const uint64_t column =
        sizeof(gmi_cache_start) + (uint64_t)cache->nodes * values * sizeof(float);
    const uint64_t bytes = sizeof *cache + (uint64_t)(cache->columns + 1) * sizeof(double) +
                           (uint64_t)all_columns(cache) * column;
    return bytes <= SIZE_MAX / 2 ? (size_t)bytes : 0;
}

size_t gm_cache_size(const gm_cache_params *params, const gm_mesh *mesh) {
    gm_cache cache;
    return describe(&cache, params, mesh) == GM_OK ? bytes_of(&cache) : 0;
}

int gm_cache_init(gm_cache **cache, const gm_cache_params *params, const gm_mesh *mesh,
                  void *memory, size_t memory_size) {
    if (cache == NULL) {
        return GM_ERR_NULL;
    }
    *cache = NULL;
    gm_cache described;
    const int status = describe(&described, params, mesh);
    if (status != GM_OK) {
        return status;
    }
    if (memory == NULL) {
        return GM_ERR_NULL;
    }
    const size_t needed = bytes_of(&described);
    if (needed == 0 || memory_size < needed || !gmi_is_aligned(memory)) {
        return GM_ERR_MEMORY;
    }

    /* The object, then phases, starts, nodes and arms. */
    gm_cache *made = (gm_cache *)memory;
    *made = described;
    made->phases = (double *)(made + 1);
    made->starts = (gmi_cache_start *)(made->phases + made->columns + 1);
    made->values = (float *)(made->starts + all_columns(made));
    made->arms = made->values + all_columns(made) * (size_t)made->nodes * NODE_VALUES;
    (void)place_columns(made, params->phase_cells, made->phases);
    for (size_t column = 0; column < all_columns(made); ++column) {
        made->starts[column].delta = gmi_nan(); /* not filled */
    }
    *cache = made;
    return GM_OK;
}

int gm_cache_passes(const gm_cache *cache) {
    return cache == NULL ? 0 : cache->passes;
}

/* ---------------------------------------------------------------------------------------------
 * Filling
 * ------------------------------------------------------------------------------------------- */

/* With corners; arm: NULL = not wanted. */
static OWN_STACK gmi_side_sum exact_corners(const gm_cache *cache, const gm_position *position,
                                            float arm[2]) {
    const gm_mesh *mesh = cache->mesh;
    gmi_corner_sums sums;
    gmi_side_sum_corners(mesh, cache->side, position, GMI_DERIVATIVES, 0.0, NULL, &sums);
    for (int role = GM_PINION; role <= GM_WHEEL && arm != NULL; ++role) {
        arm[role] = (float)(sums.tips[role].arm / mesh->law.stiffness);
    }
    return sums.side;
}

static gmi_side_sum exact_at(const gm_cache *cache, gm_position *position, double delta,
                             gm_workspace *workspace, float arm[2]) {
    const double offset = delta + 0.5 * cache->mesh->engagement.backlash;
    gmi_side_sum sum;
    position->offset = gmi_side_sign(cache->side) * offset;
    if (cache->has_corners) {
        return exact_corners(cache, position, arm);
    }
    (void)gmi_side_sum_by_law(
        cache->mesh, cache->side, position,
        GMI_DERIVATIVES | (cache->mesh->engagement.is_tilted ? GMI_MOMENTS : 0), workspace, &sum);
    return sum;
}

/* Where contact begins, or a little below; infinite if no line exists at this phase. */
static double find_start(const gm_cache *cache, gm_position *position, gm_workspace *workspace) {
    const double fine = ldexp(cache->depth, -START_BISECTIONS);

    /* In growing steps upwards to the first delta at which something touches. */
    double without = cache->lowest;
    double step = cache->depth;
    for (; exact_at(cache, position, without + step, workspace, NULL).sum == 0.0; step *= 2.0) {
        without += step;
        if (without > 0.5 * cache->pair->transverse_base_pitch) {
            return HUGE_VAL;
        }
    }

    /* Bisection between there and the last delta without contact. */
    while (step > fine) {
        step *= 0.5;
        if (exact_at(cache, position, without + step, workspace, NULL).sum == 0.0) {
            without += step;
        }
    }
    return without;
}

static float *values_of(const gm_cache *cache, size_t column) {
    return cache->values + column * (size_t)cache->nodes * NODE_VALUES;
}

/* With corners. */
static float *arms_of(const gm_cache *cache, size_t column) {
    return cache->arms + column * (size_t)cache->nodes * 2;
}

/* d2 sum / d phase d delta from the neighbours: it has to be the same for both cells, and not more. */
static void set_mixed(float *values, int nodes, double ahead) {
    for (int n = 0; n < nodes; ++n) {
        const int before = n > 0 ? n - 1 : 0;
        const int behind = n < nodes - 1 ? n + 1 : n;
        const float change = values[behind * NODE_VALUES + NODE_BY_PHASE] -
                             values[before * NODE_VALUES + NODE_BY_PHASE];
        const double steps = (double)(behind - before) - (before == 0 ? ahead : 0.0);
        values[n * NODE_VALUES + NODE_MIXED] = change / (float)steps;
    }
}

static void set_node(const gm_cache *cache, float *node, double value, const gmi_side_sum *sum) {
    node[NODE_SUM] = (float)value;
    node[NODE_BY_DELTA] = (float)(sum->by_delta * cache->step);
    node[NODE_BY_PHASE] = (float)(cache->side == GM_DRIVE ? sum->by_origin : -sum->by_origin);
}

/* Walks at a delta, for nodes first .. first + count - 1 at equal steps of which `origin` is the first. */
static void walk_at(const gm_cache *cache, gm_position *position, double delta, double origin,
                    int first, int count, gmi_depths *depths) {
    const gm_mesh *mesh = cache->mesh;
    position->offset = gmi_side_sign(cache->side) * (delta + 0.5 * mesh->engagement.backlash);
    memset(depths, 0, sizeof *depths);
    depths->count = count;
    for (int n = 0; n < count; ++n) {
        depths->shift[n] = origin - delta + (double)(first + n) * cache->step;
    }
    depths->largest = depths->shift[count - 1];
    depths->per_shift = cache->per_step;
    depths->touch = HUGE_VAL;
    gmi_side_sum_depths(mesh->pair, &mesh->engagement, &mesh->side[cache->side], cache->side,
                        position, depths);
}

static void set_nodes(const gm_cache *cache, float *values, int first, const gmi_depths *depths) {
    for (int n = 0; n < depths->count; ++n) {
        const gmi_depth_sum *at = &depths->part[n];
        const gmi_side_sum sum = {.by_delta = at->by_delta, .by_origin = at->by_origin};
        set_node(cache, values + (first + n) * NODE_VALUES, at->sum, &sum);
    }
}

/*
 * About where contact begins: by the highest of some places on each line, at delta = 0. Infinite without any line. Lines
 * whose flanks reach nowhere as high as the highest so far are left out.
 */
static OWN_STACK double guess_touch(const gm_cache *cache, gm_position *position) {
    enum { PLACES = 9 };
    const gm_pair *pair = cache->pair;
    const gmi_engagement *at = &cache->mesh->engagement;
    const gmi_side *side = &cache->mesh->side[cache->side];
    position->offset = gmi_side_sign(cache->side) * (0.5 * at->backlash);

    gmi_lines lines;
    gmi_lines_find(pair, at, cache->side, position, &lines);
    const gmi_line_ends ends = gmi_line_ends_find(pair, at, &lines);
    const double wheel_reach = at->line_of_action + lines.delta - at->wheel_profile_start;
    double highest = -HUGE_VAL;

    gmi_teeth teeth = gmi_lines_teeth(pair, cache->side, position, &lines);
    for (int k = lines.first; k <= lines.last; ++k) {
        const gmi_flank pinion = gmi_flank_of(side->pinion, teeth.pinion);
        const gmi_flank wheel = gmi_flank_of(side->wheel, teeth.wheel);
        const gmi_interval part = gmi_line_clip(&ends, k);
        if (part.from < part.to && pinion.peak + wheel.peak > highest) {
            /* The line in the terms of its tables, as in penetration.c. */
            const double rho = lines.origin + (double)k * pair->transverse_base_pitch;
            const gmi_line line = {.from = part.from,
                                   .to = part.to,
                                   .overlap = pinion.pitch + wheel.pitch,
                                   .pinion = pinion.values,
                                   .wheel = wheel.values,
                                   .pinion_profile = (rho - pair->pinion.start_roll_length) *
                                                     side->pinion_grid.per_rho,
                                   .wheel_profile = (wheel_reach - rho) * side->wheel_grid.per_rho};
            for (int i = 0; i < PLACES; ++i) {
                const double t1 = part.from + (part.to - part.from) / (PLACES - 1) * i;
                highest = gmi_larger(
                    highest, gmi_line_value(&line, &side->pinion_grid, &side->wheel_grid, t1));
            }
        }
        teeth.pinion = gmi_next_tooth(teeth.pinion, teeth.step, pair->pinion.teeth);
        teeth.wheel = gmi_next_tooth(teeth.wheel, teeth.step, pair->wheel.teeth);
    }
    return -highest;
}

/*
 * A column from a walk where contact about begins: it says where that is, and what is at the nodes, which need not begin
 * there but in the cell before. Mostly the guess is near enough for that, and always what a walk has said. No column
 * depends on another one.
 */
static OWN_STACK gmi_cache_start walk_column(const gm_cache *cache, gm_position *position,
                                             float *values) {
    enum { WALKS = 8 };
    static const double usual = 0.75, middle = 0.5, most = 0.95; /* parts of the first cell */
    const gmi_cache_start none = {HUGE_VAL, 0.0};
    const double below = 0.5 * ldexp(cache->depth, -START_BISECTIONS);
    const int last = cache->nodes - 1;
    int count = last < GMI_DEPTHS_MAX ? last : GMI_DEPTHS_MAX;
    double place = guess_touch(cache, position), origin = 0.0;
    if (!(place < HUGE_VAL)) {
        return none;
    }

    /* Some place on a line may well be higher than those looked at: contact then begins before the guess. */
    gmi_depths depths;
    gmi_cache_start start = {0.0, -1.0};
    for (int k = 0; k < WALKS && !(start.ahead >= 0.0 && start.ahead <= most); ++k) {
        origin = place - (k == 0 ? usual : middle) * cache->step;
        walk_at(cache, position, place, origin, 1, count, &depths);
        if (!(depths.touch < HUGE_VAL)) {
            return none;
        }
        place += depths.touch;
        start.ahead = (place - below - origin) * cache->per_step;
    }
    start.ahead = gmi_larger(0.0, gmi_smaller(start.ahead, most));
    start.delta = origin + start.ahead * cache->step;
    set_nodes(cache, values, 1, &depths);

    /* The others from walks in their middle. */
    for (int first = 1 + count; first <= last; first += count) {
        const int left = last + 1 - first;
        count = left < GMI_DEPTHS_MAX ? left : GMI_DEPTHS_MAX;
        const double centre = origin + ((double)first + 0.5 * (double)count) * cache->step;
        walk_at(cache, position, centre, origin, first, count, &depths);
        set_nodes(cache, values, first, &depths);
    }

    /* Even flanks touch all at once, others with a power of 1.5: the slope of a parabola to the next node serves both. */
    const float *next = values + NODE_VALUES;
    const float width = (float)(1.0 - start.ahead);
    const float slope = 2.0F * next[NODE_SUM] / width - next[NODE_BY_DELTA];
    values[NODE_SUM] = values[NODE_BY_PHASE] = 0.0F;
    values[NODE_BY_DELTA] = slope > 0.0F ? slope : 0.0F;

    return start;
}

/* Nodes from the first touch on, each by an evaluation; none where no line exists. */
static OWN_STACK gmi_cache_start evaluate_column(const gm_cache *cache, gm_position *position,
                                                 size_t column, gm_workspace *workspace) {
    const gmi_cache_start begin = {find_start(cache, position, workspace), 0.0};
    const double start = begin.delta;
    if (!(start < HUGE_VAL)) {
        return begin;
    }

    /* Even flanks touch all at once: the slope at the start is the one behind it. */
    float *values = values_of(cache, column);
    float arm[2] = {0.0F, 0.0F};
    gmi_side_sum sum =
        exact_at(cache, position, start + ldexp(cache->depth, -START_BISECTIONS), workspace, NULL);
    for (int n = 0; n < cache->nodes; ++n) {
        if (n > 0) {
            sum = exact_at(cache, position, start + (double)n * cache->step, workspace, arm);
        }
        set_node(cache, values + n * NODE_VALUES, n > 0 ? sum.sum : 0.0, &sum);
        if (cache->has_corners) {
            memcpy(arms_of(cache, column) + 2 * n, arm, sizeof arm);
        }
    }
    return begin;
}

/* Column `index` of a pass: its last one, at p_bt, is the first of the next. */
static size_t column_of(const gm_cache *cache, int pass, int index) {
    return index < cache->columns ? (size_t)pass * (size_t)cache->columns + (size_t)index
                                  : (size_t)pass_behind(cache, pass) * (size_t)cache->columns;
}

static void fill_column(gm_cache *cache, size_t column, gm_workspace *workspace) {
    float *values = values_of(cache, column);
    const int pass = (int)(column / (size_t)cache->columns);
    gm_position position = {.phase = cache->phases[column % (size_t)cache->columns]};
    set_teeth(cache, pass, &position);

    const gmi_cache_start start = gmi_side_has_depths(cache->mesh, cache->side)
                                      ? walk_column(cache, &position, values)
                                      : evaluate_column(cache, &position, column, workspace);
    if (start.delta < HUGE_VAL) {
        set_mixed(values, cache->nodes, start.ahead);
    }
    cache->starts[column] = start;
}

/* Filled already, or fills it. */
static void need_column(gm_cache *cache, size_t column, gm_workspace *workspace) {
    const double start = cache->starts[column].delta;
    if (start != start) {
        fill_column(cache, column, workspace);
    }
}

int gm_cache_fill(gm_cache *cache, int first_pass, int count, gm_workspace *workspace) {
    if (cache == NULL) {
        return GM_ERR_NULL;
    }
    if (first_pass < 0 || count < 0 || count > cache->passes - first_pass) {
        return GM_ERR_PARAMETER;
    }
    for (int pass = first_pass; pass < first_pass + count; ++pass) {
        for (int index = 0; index < cache->columns; ++index) {
            need_column(cache, column_of(cache, pass, index), workspace);
        }
    }
    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Looking up
 * ------------------------------------------------------------------------------------------- */

/* A cubic on [0, 1] by values and slopes at both ends: value = begin + t (begin_slope + t (square + t cube)). */
typedef struct cubic {
    double begin, begin_slope, square, cube;
} cubic;

static inline cubic cubic_between(double begin, double begin_slope, double end, double end_slope) {
    const double rise = end - begin;
    const double cube = begin_slope + end_slope - (rise + rise);
    const cubic between = {begin, begin_slope, rise - begin_slope - cube, cube};
    return between;
}

static inline double cubic_value(const cubic *of, double t) {
    return of->begin + t * (of->begin_slope + t * (of->square + t * of->cube));
}

static inline double cubic_slope(const cubic *of, double t) {
    return of->begin_slope + t * (of->square + of->square + 3.0 * t * of->cube);
}

/* What a column says at a delta: the sum and its derivative by the phase, and how both grow with delta, per step. */
typedef struct column_value {
    double sum[2], grows[2];
} column_value;

enum { ITSELF, BY_PHASE };

/* Where a column is at a delta, in steps; contact begins where the part of the first one is gone that is ahead of it. */
static inline double place_in(const gm_cache *cache, size_t column, double delta) {
    const gmi_cache_start *start = &cache->starts[column];
    return (delta - start->delta) * cache->per_step + start->ahead;
}

/* Cubic in delta between two nodes, at a share of the cell; its width in steps. */
static inline void read_cell(const float *a, const float *b, double share, double width,
                             double per_width, column_value *value) {
    for (int i = ITSELF; i <= BY_PHASE; ++i) {
        const cubic of =
            cubic_between((double)a[NODE_SUM + i], width * (double)a[NODE_BY_DELTA + i],
                          (double)b[NODE_SUM + i], width * (double)b[NODE_BY_DELTA + i]);
        value->sum[i] = cubic_value(&of, share);
        value->grows[i] = per_width * cubic_slope(&of, share);
    }
}

/* Returns 0 beyond the last node. */
static OWN_STACK int read_column(const gm_cache *cache, size_t column, double delta,
                                 column_value *value) {
    const double place = place_in(cache, column, delta);
    const double ahead = cache->starts[column].ahead;
    const column_value none = {{0.0, 0.0}, {0.0, 0.0}};

    /* Before the first node nothing touches; beyond the last one nothing is known. */
    if (!(place > ahead)) {
        *value = none;
        return 1;
    }
    if (place >= (double)(cache->nodes - 1)) {
        return 0;
    }

    /* The nodes around it, the first cell from where contact begins. */
    const int n = (int)place;
    const float *a = values_of(cache, column) + (size_t)n * NODE_VALUES;
    const float *b = a + NODE_VALUES;
    if (n > 0) {
        read_cell(a, b, place - (double)n, 1.0, 1.0, value);
    } else {
        const double width = 1.0 - ahead, per_width = 1.0 / width;
        read_cell(a, b, (place - ahead) * per_width, width, per_width, value);
    }
    return 1;
}

/* The column before or at a phase in [0, p_bt], not the last one: near where it would be at equal steps. */
static inline int column_before(const gm_cache *cache, double phase) {
    const int last = cache->columns - 1;
    const int guess = (int)(phase * cache->columns_per_phase);
    int before = guess < last ? guess : last;
    while (before > 0 && cache->phases[before] > phase) {
        --before;
    }
    while (before < last && cache->phases[before + 1] <= phase) {
        ++before;
    }
    return before;
}

/* Between two columns. The cubic may dip below zero just where contact begins; the sum never does. */
static inline void join_columns(const gm_cache *cache, int index, double phase, int wanted,
                                const column_value *a, const column_value *b, gmi_side_sum *sum) {
    const double width = cache->phases[index + 1] - cache->phases[index];
    const double per_width = 1.0 / width;
    const double place = (phase - cache->phases[index]) * per_width;

    /* Sum and derivative by delta, each cubic in the phase. */
    const cubic sums = cubic_between(a->sum[ITSELF], a->sum[BY_PHASE] * width, b->sum[ITSELF],
                                     b->sum[BY_PHASE] * width);
    const cubic grows = cubic_between(a->grows[ITSELF], a->grows[BY_PHASE] * width,
                                      b->grows[ITSELF], b->grows[BY_PHASE] * width);
    const double value = cubic_value(&sums, place);
    if (!(value > 0.0)) {
        return;
    }

    /* The touching part is the derivative by delta, but for the slope of the flanks. */
    sum->sum = value;
    sum->by_delta = cubic_value(&grows, place) * cache->per_step;
    sum->contact = sum->by_delta > 0.0 ? sum->by_delta : 0.0;
    sum->pairs = -1;

    /* The derivative by the phase is that of the same cubic. */
    if (wanted & GMI_DERIVATIVES) {
        const double turns = cubic_slope(&sums, place) * per_width;
        sum->by_origin = cache->side == GM_DRIVE ? turns : -turns;
    }
}

/* Straight in delta along one column: 0 where nothing touches. */
static gmi_cache_arm arm_in_column(const gm_cache *cache, size_t column, double delta, int role) {
    const double place = place_in(cache, column, delta);
    gmi_cache_arm arm = {0.0, 0.0, 0.0};
    if (place > 0.0) {
        const int n = (int)place;
        const float *node = arms_of(cache, column) + 2 * n + role;
        const double grows = (double)node[2] - (double)node[0];
        arm.value = (double)node[0] + (place - (double)n) * grows;
        arm.by_delta = grows * cache->per_step;
    }
    return arm;
}

/* And straight in the phase between two of them. */
static void look_up_arms(const gm_cache *cache, const size_t columns[2], int index, double phase,
                         double delta, gmi_cache_arm arms[2]) {
    const double width = cache->phases[index + 1] - cache->phases[index];
    const double share = (phase - cache->phases[index]) / width;
    const double per_width = gmi_side_sign(cache->side) / width;
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const gmi_cache_arm a = arm_in_column(cache, columns[0], delta, role);
        const gmi_cache_arm b = arm_in_column(cache, columns[1], delta, role);
        arms[role].value = a.value + share * (b.value - a.value);
        arms[role].by_delta = a.by_delta + share * (b.by_delta - a.by_delta);
        arms[role].by_origin = (b.value - a.value) * per_width;
    }
}

int gmi_cache_look_up(gm_cache *cache, const gm_position *position, int wanted,
                      gm_workspace *workspace, gmi_side_sum *sum, gmi_cache_arm arms[2]) {
    static const gmi_cache_arm none = {0.0, 0.0, 0.0};
    if (cache->has_corners) {
        arms[GM_PINION] = arms[GM_WHEEL] = none;
    }
    const double delta =
        gmi_ideal_penetration(&cache->mesh->engagement, cache->side, position->offset);
    *sum = gmi_no_contact();
    if (delta <= cache->lowest) {
        return 1;
    }

    /* Teeth that never meet, or a phase outside the table: the exact evaluation answers. */
    const int pass = pass_of(cache, position);
    if (pass < 0 || position->phase < 0.0 || position->phase > cache->phases[cache->columns]) {
        return 0;
    }

    /* Both columns around the phase, filled where they are not yet. */
    const int index = column_before(cache, position->phase);
    const size_t columns[2] = {column_of(cache, pass, index), column_of(cache, pass, index + 1)};
    need_column(cache, columns[0], workspace);
    need_column(cache, columns[1], workspace);

    column_value a, b;
    if (!read_column(cache, columns[0], delta, &a) || !read_column(cache, columns[1], delta, &b)) {
        return 0;
    }
    join_columns(cache, index, position->phase, wanted, &a, &b, sum);
    if (cache->has_corners && sum->sum > 0.0) {
        look_up_arms(cache, columns, index, position->phase, delta, arms);
    }
    return 1;
}

/* ---------------------------------------------------------------------------------------------
 * Measuring the error
 * ------------------------------------------------------------------------------------------- */

static void add_error(double error, double *largest, double *squares) {
    *largest = fmax(*largest, fabs(error));
    *squares += error * error;
}

int gm_cache_error(gm_cache *cache, int states, unsigned seed, gm_workspace *workspace,
                   gm_cache_errors *errors) {
    if (errors == NULL) {
        return GM_ERR_NULL;
    }
    errors->sum_largest = errors->sum_rms = gmi_nan();
    errors->contact_largest = errors->contact_rms = gmi_nan();
    if (cache == NULL) {
        return GM_ERR_NULL;
    }
    if (states < 1) {
        return GM_ERR_PARAMETER;
    }

    const double last_phase = cache->phases[cache->columns];
    double sum_largest = 0.0, sum_squares = 0.0, contact_largest = 0.0, contact_squares = 0.0;
    uint64_t random = seed;
    for (int i = 0; i < states; ++i) {
        /* A random tooth pass, phase and depth behind the first touch. */
        const int pass = (int)(gmi_random_unit(&random) * (double)cache->passes);
        gm_position position = {.phase = gmi_random_unit(&random) * last_phase};
        const int index = column_before(cache, position.phase);
        set_teeth(cache, pass, &position);
        const size_t column = column_of(cache, pass, index);
        need_column(cache, column, workspace);
        const double start = cache->starts[column].delta;
        const double depth = gmi_random_unit(&random) * cache->depth;
        if (!(start < HUGE_VAL)) {
            continue; /* no line of contact at this phase: nothing to be off by */
        }

        gmi_side_sum looked_up;
        gmi_cache_arm arms[2];
        const gmi_side_sum exact = exact_at(cache, &position, start + depth, workspace, NULL);
        if (!gmi_cache_look_up(cache, &position, GMI_SUM, workspace, &looked_up, arms)) {
            continue; /* beyond the cache, which answers exactly there */
        }
        add_error(looked_up.sum - exact.sum, &sum_largest, &sum_squares);
        add_error(looked_up.contact - exact.contact, &contact_largest, &contact_squares);
    }
    errors->sum_largest = sum_largest;
    errors->sum_rms = sqrt(sum_squares / (double)states);
    errors->contact_largest = contact_largest;
    errors->contact_rms = sqrt(contact_squares / (double)states);
    return GM_OK;
}
