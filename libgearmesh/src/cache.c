/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * A cache in place of the 3D model for one flank side: per tooth pass a table over phase and delta.
 *
 * A column is one phase of one tooth pass. Its nodes stand at equal steps of delta from where that phase begins to
 * touch; each keeps the exact sum, the exact derivatives by delta and phase, and the mixed derivative from its
 * neighbours. Between nodes a bicubic Hermite polynomial gives the sum and its derivatives. Columns start where
 * they begin to touch because that varies by tens of micrometres from tooth to tooth, and what lies below is zero.
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

#define SMALLEST_DEPTH 1e-10 /* (m) */

/* Values of a node; by_delta and mixed are per step of delta, not per metre. */
enum node { NODE_SUM, NODE_BY_DELTA, NODE_BY_PHASE, NODE_MIXED, NODE_VALUES };

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
    if (cache->has_corners) {
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

/* Knots, and equal steps between them of at most p_bt / cells. Returns the number of columns; phases may be NULL. */
static int place_columns(const gm_cache *cache, int cells, double *phases) {
    const double p_bt = cache->pair->transverse_base_pitch;
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
    return columns + 1;
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
    cache->columns = place_columns(cache, params->phase_cells, NULL);

    /* 1e5 teeth each give 1e10 passes at most: more than fits any memory, but not into an int. */
    const int64_t passes = (int64_t)cache->pinion_period * (cache->wheel_period / cache->common);
    if (passes * cache->columns > INT32_MAX) {
        return GM_ERR_MEMORY;
    }
    cache->passes = (int)passes;
    return GM_OK;
}

static size_t all_columns(const gm_cache *cache) {
    return (size_t)cache->passes * (size_t)cache->columns;
}

/* Bytes: the object, a phase per column, a start per column of every pass, then nodes and arms. 0 if too many. */
static size_t bytes_of(const gm_cache *cache) {
    const uint64_t values = NODE_VALUES + (cache->has_corners ? 2 : 0);
    const uint64_t column = sizeof(double) + (uint64_t)cache->nodes * values * sizeof(float);
    const uint64_t bytes = sizeof *cache + (uint64_t)cache->columns * sizeof(double) +
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
    made->starts = made->phases + made->columns;
    made->values = (float *)(made->starts + all_columns(made));
    made->arms = made->values + all_columns(made) * (size_t)made->nodes * NODE_VALUES;
    (void)place_columns(made, params->phase_cells, made->phases);
    for (size_t column = 0; column < all_columns(made); ++column) {
        made->starts[column] = gmi_nan(); /* not filled */
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
static void set_mixed(float *values, int nodes) {
    for (int n = 0; n < nodes; ++n) {
        const int before = n > 0 ? n - 1 : 0;
        const int behind = n < nodes - 1 ? n + 1 : n;
        const float change = values[behind * NODE_VALUES + NODE_BY_PHASE] -
                             values[before * NODE_VALUES + NODE_BY_PHASE];
        values[n * NODE_VALUES + NODE_MIXED] = change / (float)(behind - before);
    }
}

static void set_node(const gm_cache *cache, float *node, double value, const gmi_side_sum *sum) {
    node[NODE_SUM] = (float)value;
    node[NODE_BY_DELTA] = (float)(sum->by_delta * cache->step);
    node[NODE_BY_PHASE] = (float)(cache->side == GM_DRIVE ? sum->by_origin : -sum->by_origin);
}

/* Walks at a delta, for nodes first .. first + count - 1 of a column that begins at `start`. */
static void walk_at(const gm_cache *cache, gm_position *position, double delta, double start,
                    int first, int count, gmi_depths *depths) {
    const gm_mesh *mesh = cache->mesh;
    position->offset = gmi_side_sign(cache->side) * (delta + 0.5 * mesh->engagement.backlash);
    memset(depths, 0, sizeof *depths);
    depths->count = count;
    for (int n = 0; n < count; ++n) {
        depths->shift[n] = start - delta + (double)(first + n) * cache->step;
    }
    depths->largest = count > 0 ? depths->shift[count - 1] : -HUGE_VAL;
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
 * A column from a few walks. The first ones find where contact begins: each is off by what is of second order in its
 * distance. They begin where the tips of even flanks would touch, so that no column depends on another one. The last of
 * them, where contact begins, serves the nodes as well; of a column with many nodes the first ones.
 */
static OWN_STACK double walk_column(const gm_cache *cache, gm_position *position, float *values) {
    enum { WALKS = 8 };
    const double fine = ldexp(cache->depth, -START_BISECTIONS);
    int first = cache->nodes < GMI_DEPTHS_MAX ? cache->nodes : GMI_DEPTHS_MAX;
    gmi_depths depths;
    double start = 0.0, touch = 0.0, moved = HUGE_VAL;
    for (int k = 0; k < 2 || (k < WALKS && fabs(moved) > 0.45 * fine); ++k) {
        start = touch - 0.5 * fine; /* a little below */
        walk_at(cache, position, touch, start, 0, k > 0 ? first : 0, &depths);
        moved = depths.touch;
        if (!(moved < HUGE_VAL)) {
            return HUGE_VAL;
        }
        touch += moved;
    }
    set_nodes(cache, values, 0, &depths);

    /* The others from walks in their middle. */
    while (first < cache->nodes) {
        const int left = cache->nodes - first;
        const int count = left < GMI_DEPTHS_MAX ? left : GMI_DEPTHS_MAX;
        const double middle = start + ((double)first + 0.5 * (double)count) * cache->step;
        walk_at(cache, position, middle, start, first, count, &depths);
        set_nodes(cache, values, first, &depths);
        first += count;
    }

    /* Even flanks touch all at once, others with a power of 1.5: the slope of a parabola to the next node serves both. */
    const float slope = 2.0F * values[NODE_VALUES + NODE_SUM] - values[NODE_VALUES + NODE_BY_DELTA];
    values[NODE_SUM] = 0.0F;
    values[NODE_BY_DELTA] = slope > 0.0F ? slope : 0.0F;

    return start;
}

/* Nodes from the first touch on, each by an evaluation; none where no line exists. */
static double evaluate_column(const gm_cache *cache, gm_position *position, size_t column,
                              gm_workspace *workspace) {
    const double start = find_start(cache, position, workspace);
    if (!(start < HUGE_VAL)) {
        return start;
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
    return start;
}

static void fill_column(gm_cache *cache, int pass, int index, gm_workspace *workspace) {
    const size_t column = (size_t)pass * (size_t)cache->columns + (size_t)index;
    float *values = values_of(cache, column);
    gm_position position = {.phase = cache->phases[index]};
    set_teeth(cache, pass, &position);

    const double start = gmi_side_has_depths(cache->mesh, cache->side)
                             ? walk_column(cache, &position, values)
                             : evaluate_column(cache, &position, column, workspace);
    if (start < HUGE_VAL) {
        set_mixed(values, cache->nodes);
    }
    cache->starts[column] = start;
}

/* Filled already, or fills it. */
static void need_column(gm_cache *cache, int pass, int index, gm_workspace *workspace) {
    const double start = cache->starts[(size_t)pass * (size_t)cache->columns + (size_t)index];
    if (start != start) {
        fill_column(cache, pass, index, workspace);
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
            need_column(cache, pass, index, workspace);
        }
    }
    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Looking up
 * ------------------------------------------------------------------------------------------- */

/* Weights of value and slope at both ends of a cubic on [0, 1]. */
typedef struct hermite {
    double begin, begin_slope, end, end_slope;
} hermite;

static inline hermite hermite_value(double t) {
    const double rest = 1.0 - t;
    const double end = t * t * (3.0 - 2.0 * t);
    const hermite weights = {1.0 - end, t * rest * rest, end, -t * t * rest};
    return weights;
}

/* Of its derivative. */
static inline hermite hermite_slope(double t) {
    const double rest = 1.0 - t;
    const double end = 6.0 * t * rest;
    const hermite weights = {-end, rest * (1.0 - 3.0 * t), end, t * (3.0 * t - 2.0)};
    return weights;
}

static inline double combine(const hermite *weights, double begin, double begin_slope, double end,
                             double end_slope) {
    return weights->begin * begin + weights->begin_slope * begin_slope + weights->end * end +
           weights->end_slope * end_slope;
}

/* What a column says at a delta; by_delta and mixed per step. */
typedef struct column_value {
    double sum, by_delta, by_phase, mixed;
} column_value;

/* Returns 0 beyond the last node. */
static int read_column(const gm_cache *cache, size_t column, double delta, column_value *value) {
    const double place = (delta - cache->starts[column]) * cache->per_step;
    const column_value none = {0.0, 0.0, 0.0, 0.0};
    *value = none;

    /* Before the first node nothing touches; beyond the last one nothing is known. */
    if (!(place > 0.0)) {
        return 1;
    }
    if (place >= (double)(cache->nodes - 1)) {
        return 0;
    }

    /* The nodes around it. */
    const int n = (int)place;
    const float *a = values_of(cache, column) + (size_t)n * NODE_VALUES;
    const float *b = a + NODE_VALUES;
    const double a_sum = (double)a[NODE_SUM], a_by_delta = (double)a[NODE_BY_DELTA];
    const double b_sum = (double)b[NODE_SUM], b_by_delta = (double)b[NODE_BY_DELTA];
    const double a_by_phase = (double)a[NODE_BY_PHASE], a_mixed = (double)a[NODE_MIXED];
    const double b_by_phase = (double)b[NODE_BY_PHASE], b_mixed = (double)b[NODE_MIXED];

    /* Cubic in delta: the sum and its slope, and their derivatives by the phase. */
    const hermite at = hermite_value(place - (double)n);
    const hermite slope = hermite_slope(place - (double)n);
    value->sum = combine(&at, a_sum, a_by_delta, b_sum, b_by_delta);
    value->by_delta = combine(&slope, a_sum, a_by_delta, b_sum, b_by_delta);
    value->by_phase = combine(&at, a_by_phase, a_mixed, b_by_phase, b_mixed);
    value->mixed = combine(&slope, a_by_phase, a_mixed, b_by_phase, b_mixed);
    return 1;
}

/* The column before or at a phase in [0, p_bt], not the last one. */
static int column_before(const gm_cache *cache, double phase) {
    int before = 0, behind = cache->columns - 1;
    while (behind - before > 1) {
        const int middle = (before + behind) / 2;
        if (cache->phases[middle] <= phase) {
            before = middle;
        } else {
            behind = middle;
        }
    }
    return before;
}

/* Between two columns. The cubic may dip below zero just where contact begins; the sum never does. */
static void join_columns(const gm_cache *cache, int index, double phase, const column_value *a,
                         const column_value *b, gmi_side_sum *sum) {
    const double width = cache->phases[index + 1] - cache->phases[index];
    const double place = (phase - cache->phases[index]) / width;

    /* Sum and derivative by delta, each cubic in the phase. */
    const hermite at = hermite_value(place);
    const double value = combine(&at, a->sum, a->by_phase * width, b->sum, b->by_phase * width);
    const double by_delta =
        combine(&at, a->by_delta, a->mixed * width, b->by_delta, b->mixed * width);
    if (!(value > 0.0)) {
        return;
    }

    /* The derivative by the phase is that of the same cubic. */
    const hermite slope = hermite_slope(place);
    const double by_phase =
        combine(&slope, a->sum, a->by_phase * width, b->sum, b->by_phase * width) / width;

    /* The touching part is the derivative by delta, but for the slope of the flanks. */
    sum->sum = value;
    sum->by_delta = by_delta * cache->per_step;
    sum->by_origin = cache->side == GM_DRIVE ? by_phase : -by_phase;
    sum->contact = sum->by_delta > 0.0 ? sum->by_delta : 0.0;
    sum->pairs = -1;
}

/* Straight in delta along one column: 0 where nothing touches. */
static gmi_cache_arm arm_in_column(const gm_cache *cache, size_t column, double delta, int role) {
    const double place = (delta - cache->starts[column]) * cache->per_step;
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
static void look_up_arms(const gm_cache *cache, size_t column, int index, double phase,
                         double delta, gmi_cache_arm arms[2]) {
    const double width = cache->phases[index + 1] - cache->phases[index];
    const double share = (phase - cache->phases[index]) / width;
    const double per_width = gmi_side_sign(cache->side) / width;
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const gmi_cache_arm a = arm_in_column(cache, column, delta, role);
        const gmi_cache_arm b = arm_in_column(cache, column + 1, delta, role);
        arms[role].value = a.value + share * (b.value - a.value);
        arms[role].by_delta = a.by_delta + share * (b.by_delta - a.by_delta);
        arms[role].by_origin = (b.value - a.value) * per_width;
    }
}

int gmi_cache_look_up(gm_cache *cache, const gm_position *position, gm_workspace *workspace,
                      gmi_side_sum *sum, gmi_cache_arm arms[2]) {
    static const gmi_cache_arm none = {0.0, 0.0, 0.0};
    arms[GM_PINION] = arms[GM_WHEEL] = none;
    const double delta =
        gmi_ideal_penetration(&cache->mesh->engagement, cache->side, position->offset);
    *sum = gmi_no_contact();
    if (delta <= cache->lowest) {
        return 1;
    }

    /* Teeth that never meet, or a phase outside the table: the exact evaluation answers. */
    const int pass = pass_of(cache, position);
    if (pass < 0 || position->phase < 0.0 || position->phase > cache->phases[cache->columns - 1]) {
        return 0;
    }

    /* Both columns around the phase, filled where they are not yet. */
    const int index = column_before(cache, position->phase);
    const size_t column = (size_t)pass * (size_t)cache->columns + (size_t)index;
    need_column(cache, pass, index, workspace);
    need_column(cache, pass, index + 1, workspace);

    column_value a, b;
    if (!read_column(cache, column, delta, &a) || !read_column(cache, column + 1, delta, &b)) {
        return 0;
    }
    join_columns(cache, index, position->phase, &a, &b, sum);
    if (cache->has_corners && sum->sum > 0.0) {
        look_up_arms(cache, column, index, position->phase, delta, arms);
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

    const double last_phase = cache->phases[cache->columns - 1];
    double sum_largest = 0.0, sum_squares = 0.0, contact_largest = 0.0, contact_squares = 0.0;
    uint64_t random = seed;
    for (int i = 0; i < states; ++i) {
        /* A random tooth pass, phase and depth behind the first touch. */
        const int pass = (int)(gmi_random_unit(&random) * (double)cache->passes);
        gm_position position = {.phase = gmi_random_unit(&random) * last_phase};
        const int index = column_before(cache, position.phase);
        set_teeth(cache, pass, &position);
        need_column(cache, pass, index, workspace);
        const double start = cache->starts[(size_t)pass * (size_t)cache->columns + (size_t)index];
        const double depth = gmi_random_unit(&random) * cache->depth;
        if (!(start < HUGE_VAL)) {
            continue; /* no line of contact at this phase: nothing to be off by */
        }

        gmi_side_sum looked_up;
        gmi_cache_arm arms[2];
        const gmi_side_sum exact = exact_at(cache, &position, start + depth, workspace, NULL);
        if (!gmi_cache_look_up(cache, &position, workspace, &looked_up, arms)) {
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
