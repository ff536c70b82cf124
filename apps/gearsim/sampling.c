/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "sampling.h"
#include "exit_code.h"
#include "gear_contact.h"
#include "sample_means.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---------------------------------------------------------------------------------------------
 * What a column takes
 * ------------------------------------------------------------------------------------------- */

/* The momentum of the bodies tells the force, unless torques are not that of one force: with friction, or at corners. */
static int is_force_of_momentum(const config *conf) {
    return !config_has_friction(conf) && !config_has_corners(conf);
}

/* And the force tells the penetration, where flanks are springs that CVODE keeps account of. */
static int is_overlap_of_force(const config *conf, const gear_mesh *gears) {
    return is_force_of_momentum(conf) && conf->law != LAW_ELASTIC && gears->halves == 1 &&
           conf->method != METHOD_ERK;
}

static int takes_mean(const sampling *s, const dynamic_column *column) {
    if (s->factor == 1 || column->mean == NULL) {
        return 0;
    }
    switch (column->need) {
    case NEEDS_FORCE:
        return is_force_of_momentum(s->conf);
    case NEEDS_MESH:
        return is_overlap_of_force(s->conf, s->model->gears);
    default:
        return 1;
    }
}

/*
 * How means are taken. A force that jumps has lines far beyond the samples' rate, which the triangle takes off twice
 * as well; that of helical gears has next to none, and x' alone is known better than the second difference of x.
 */
static enum sample_kind mean_kind(const config *conf, const gear_mesh *gears) {
    return conf->model == MODEL_3D && gears->pair.face_advance == 0.0 ? SAMPLE_HAT : SAMPLE_BOX;
}

/* What the filter gets of a column. */
static enum sample_kind kind_of(const sampling *s, const dynamic_column *column) {
    if (!column->is_filtered) {
        return SAMPLE_PLAIN;
    }
    const enum sample_kind means = mean_kind(s->conf, s->model->gears);
    if (takes_mean(s, column)) {
        return means;
    }

    /* Where boxes end the motion is known anyway, so that it is not asked for at the samples' own times. */
    return s->factor > 1 && means == SAMPLE_BOX && column->need == NEEDS_MOTION ? SAMPLE_BEHIND
                                                                                : SAMPLE_VALUES;
}

static enum column_need larger(enum column_need a, enum column_need b) {
    return a > b ? a : b;
}

/* Elastic teeth and both halves of a double-helical pair tell how many pairs touch with their force alone. */
static enum column_need need_of(const sampling *s, const dynamic_column *column) {
    const int needs_force = s->conf->law == LAW_ELASTIC || s->model->gears->halves == 2;

    return column->need == NEEDS_PAIRS && needs_force ? NEEDS_FORCE : column->need;
}

/* What has to be known for a column: of the samples, of their means, or of the row alone. */
static void add_need(sampling *s, const dynamic_column *column, enum sample_kind kind) {
    switch (kind) {
    case SAMPLE_BEHIND:
        s->mean_kind = SAMPLE_BOX;
        s->edge_wanted = EDGE_OFFSET | EDGE_PINION;
        break;

    /* Means show themselves, and the load or the overlap with them. */
    case SAMPLE_BOX:
    case SAMPLE_HAT:
        s->mean_kind = kind;
        s->shows_means = 1;
        s->shows_load |= column->need == NEEDS_MOTION;
        s->shows_overlap |= column->need == NEEDS_MESH;
        break;

    /* Values are evaluated: of each sample, or of the row alone. */
    case SAMPLE_VALUES:
        s->sample_need = larger(s->sample_need, column->need);
        s->row_need = larger(s->row_need, column->need);
        break;
    default:
        s->row_need = larger(s->row_need, need_of(s, column));
        break;
    }
}

/* What the columns show, and what they need for that. Sets what the filter gets of each. */
static void set_columns(sampling *s, const int columns[], enum sample_kind kinds[]) {
    for (int k = 0; k < s->column_count; ++k) {
        const dynamic_column *column = &dynamic_columns[columns[k]];

        kinds[k] = kind_of(s, column);
        s->counts_pairs |= column->need == NEEDS_PAIRS;
        s->show[k] = takes_mean(s, column) ? column->mean : column->value;
        s->shown[k] = kinds[k] == SAMPLE_BEHIND ? &s->behind : &s->sample;
        add_need(s, column, kinds[k]);
    }
}

/* Those that are filtered first. */
static void order_columns(sampling *s, const int columns[]) {
    for (int pass = 1, n = 0; pass >= 0; --pass) {
        for (int k = 0; k < s->column_count; ++k) {
            if (dynamic_columns[columns[k]].is_filtered == pass) {
                s->filtered_first[n++] = k;
                s->filtered_count += pass;
            }
        }
    }
}

/* Whether the samples of a row can be taken together. */
static void choose_blocks(sampling *s) {
    const gear_model *model = s->model;

    /* Where torques follow the motion, it is gathered sample by sample; flanks that do not carry are looked at. */
    if (s->shows_overlap && s->follows) {
        s->sample_need = larger(s->sample_need, NEEDS_MOTION);
        s->row_need = larger(s->row_need, NEEDS_MOTION);
    }

    /* From row to row the same times, of which only boxes take nothing but their ends. */
    s->takes_blocks = s->mean_kind == SAMPLE_BOX && s->sample_need == NEEDS_TIME && !s->follows;
    for (int j = 0; j < s->factor && s->takes_blocks; ++j) {
        s->centre_share[j] = (j + 1.0) / s->factor;
        s->box_end_share[j] = (j + 1.5) / s->factor;
    }

    /* Cases that are in need of less, the default among them. */
    s->is_plain_box = s->takes_blocks && s->means.is_steady &&
                      (model->noise != NULL || model->load.amplitude == 0.0);
    s->is_force_alone = s->is_plain_box && s->filtered_count == 1 && s->shows_means &&
                        !s->shows_load && !s->shows_overlap;
}

int sampling_start(sampling *s, const config *conf, const gear_model *model, integrator *solver,
                   const int columns[], int count, enum column_need row_need) {
    enum sample_kind kinds[COLUMNS_MAX];
    int is_any_filtered = 0;

    s->conf = conf;
    s->model = model;
    s->solver = solver;
    s->sample.model = s->behind.model = model;
    s->column_count = count;
    s->row_need = larger(row_need, NEEDS_PINION); /* progress shows its speed */

    /* Without a column to filter there is a sample for each row. */
    for (int k = 0; k < count; ++k) {
        is_any_filtered |= dynamic_columns[columns[k]].is_filtered;
    }
    s->factor = is_any_filtered ? conf->oversampling : 1;

    /* What is asked for decides what has to be computed. */
    set_columns(s, columns, kinds);
    order_columns(s, columns);
    sample_means_prepare(s);
    choose_blocks(s);
    s->filter = decimator_create(s->factor, count, kinds);
    return s->filter != NULL ? 0 : -1;
}

void sampling_free(sampling *s) {
    decimator_free(s->filter);
}

/* ---------------------------------------------------------------------------------------------
 * Sample by sample
 * ------------------------------------------------------------------------------------------- */

/* The motion at the sample's time, where it is needed; the triangle of the sample before has ended there. */
static int see_sample_motion(sampling *s, enum column_need need) {
    if (s->mean_kind == SAMPLE_HAT && s->means.is_started) {
        s->sample.motion = s->means.next;
        return 0;
    }

    /* Without the solver, if its state is not in what is wanted. */
    if (s->mean_kind == SAMPLE_BOX && s->means.is_started && need == NEEDS_TIME) {
        return 0; /* between the rows nobody looks at it */
    }
    if (s->means.is_started && !row_needs_state(s)) {
        s->sample.motion = model_prescribed_motion(s->model, s->sample.time);
        return 0;
    }
    return sample_motion(s, s->sample.time, &s->sample.motion);
}

/* Of the row's sample all columns, of others those that are filtered. */
static void set_values(sampling *s, int of_row) {
    const int count = of_row ? s->column_count : s->filtered_count;

    for (int n = 0; n < count; ++n) {
        const int k = s->filtered_first[n];
        s->values[k] = s->show[k](s->shown[k]);
    }
}

/* Before the first sample: its values, or those at its own time in place of those behind it. */
static void hold_values(sampling *s) {
    const dynamic_sample behind = s->behind;
    double held[COLUMNS_MAX];

    memcpy(held, s->values, sizeof held);
    s->behind = s->sample;
    for (int k = 0; k < s->column_count; ++k) {
        if (s->shown[k] == &s->behind) {
            held[k] = s->show[k](&s->behind);
        }
    }
    s->behind = behind;
    decimator_hold(s->filter, held);
}

/* Sample i of a row's period; values that nobody needs are left as they were. */
static int take_sample(sampling *s, double row, int i) {
    const int of_row = i == 0;
    const enum column_need need = of_row ? s->row_need : s->sample_need;

    /* Where the gears are. */
    s->sample.time = sample_time(s, row, i);
    int failed = s->follows ? sample_means_gather(s, s->sample.time) : 0;
    if (!failed) {
        failed = see_sample_motion(s, need);
    }

    /* How they touch, if a column needs to know. */
    if (!failed && of_row) {
        failed = sample_row(s);
    } else if (!failed && need >= NEEDS_FORCE) {
        failed = sample_mesh(s, need);
    }

    /* And what they do about that time. */
    if (!failed) {
        if (!s->means.is_started) {
            s->means.edge = s->sample.motion;
        }
        failed = sample_means_see(s, need, row, i);
    }
    if (failed) {
        return failed;
    }

    set_values(s, of_row);
    if (!s->means.is_started) {
        hold_values(s);
    }
    s->means.is_started = 1;
    return 0;
}

/* ---------------------------------------------------------------------------------------------
 * All samples of a row at once
 * ------------------------------------------------------------------------------------------- */

/* Samples on the way from a row to the next: as many as a row has, the last of them at the next row's time. */
typedef struct sample_block {
    int count;
    double centre[MODEL_EDGES_MAX], end[MODEL_EDGES_MAX]; /* of their boxes */
    double times[2 * MODEL_EDGES_MAX];                    /* of the points below */
    gear_motion of_row;                                   /* at the last centre */
    model_edge edges[MODEL_EDGES_MAX];                    /* at the ends, */
    integrator_point points[2 * MODEL_EDGES_MAX];         /* and what the solver says there, */
    int each;                                             /* and at the centres before them: 2 */
} sample_block;

/* The times that the solver is asked about. */
static void set_times(const sampling *s, double row, sample_block *block) {
    const int count = s->factor, each = s->shows_overlap ? 2 : 1;

    block->count = count;
    block->each = each;
    for (int j = 0; j < count; ++j) {
        /* A division is dear beside the rest: centres only where somebody looks at them. */
        const int is_seen = !s->is_force_alone || j == count - 1;
        block->end[j] = time_of_share(s, row, s->box_end_share[j]);
        block->centre[j] = is_seen ? time_of_share(s, row, s->centre_share[j]) : block->end[j];

        /* Centres with the ends, where flanks that do not carry may have to be looked at there. */
        block->times[each * j] = block->centre[j];
        block->times[each * j + each - 1] = block->end[j];
    }
}

/* All ends, and before the last one, as the solver only goes forward, the state at the row's own time if it is asked for. */
static int see_points(sampling *s, double row, sample_block *block) {
    const double row_time = time_of_share(s, row, 1.0);
    const int is_row_apart = block->each == 1 && row_needs_state(s);
    const int last = block->each * block->count - 1;
    int failed = sample_points(s, is_row_apart ? last : last + 1, block->times, block->points);

    if (!failed && is_row_apart) {
        failed = sample_motion(s, row_time, &block->of_row);
        if (!failed) {
            failed = sample_points(s, 1, &block->times[last], &block->points[last]);
        }
    } else if (!failed) {
        block->of_row = block->each == 2
                            ? model_motion(s->model, row_time, block->points[last - 1].state)
                            : model_prescribed_motion(s->model, row_time);
    }
    return failed;
}

static int see_block(sampling *s, double row, sample_block *block) {
    const double *states[MODEL_EDGES_MAX];

    set_times(s, row, block);
    const int failed = see_points(s, row, block);
    if (failed) {
        return failed;
    }

    /* What is carried at the ends. */
    for (int j = 0; j < block->count; ++j) {
        states[j] = block->points[block->each * (j + 1) - 1].state;
    }
    model_edges(s->model, block->count, block->end, states, s->edge_wanted, block->edges);
    return 0;
}

/* Of the block the means of the force, the only column that is filtered. */
static void set_forces(sampling *s, const sample_block *block) {
    double *force = s->block + s->filtered_first[0] * MODEL_EDGES_MAX;

    for (int j = 0; j < block->count; ++j) {
        const double weight = 1.0 / (block->end[j] - s->means.edge_time);
        const double change = block->edges[j].momentum - s->means.edge_momentum;

        force[j] = model_mean_force(s->model, &s->means.steady, change * weight);
        s->means.edge_time = block->end[j];
        s->means.edge_momentum = block->edges[j].momentum;
    }
    s->means.edge = block->edges[block->count - 1].motion;
}

/* Of a sample of the block all columns that are filtered. */
static int set_sample(sampling *s, const sample_block *block, int j) {
    const int is_row = j == block->count - 1;
    const enum column_need seen = is_row ? s->row_need : NEEDS_TIME;
    const integrator_point *last = &block->points[block->each * (j + 1) - 1];

    s->sample.time = block->centre[j];
    if (!is_row && s->shows_overlap && !(last->carried_since <= s->means.edge_time)) {
        s->sample.motion = model_motion(s->model, block->centre[j], block->points[2 * j].state);
    }
    const int failed = sample_means_set_box(s, seen, block->end[j], &block->edges[j], last);
    for (int n = 0; n < s->filtered_count; ++n) {
        const int k = s->filtered_first[n];
        s->block[k * MODEL_EDGES_MAX + j] = s->show[k](s->shown[k]);
    }
    return failed;
}

/* All that samples take between the rows is where their boxes end. */
static int take_block(sampling *s, double row) {
    sample_block block;
    int failed = see_block(s, row, &block);
    const int last = block.count - 1;

    for (int j = 0; j < last && !failed && !s->is_force_alone; ++j) {
        failed = set_sample(s, &block, j);
    }

    /* The row's own sample, with the mesh if a column needs to know. */
    s->sample.time = block.centre[last];
    s->sample.motion = block.of_row;
    if (!failed) {
        failed = sample_row(s);
    }

    /* Columns that are filtered, and those of the row alone. */
    if (!failed && s->is_force_alone) {
        set_forces(s, &block);
    } else if (!failed) {
        failed = set_sample(s, &block, last);
    }
    for (int n = s->filtered_count; n < s->column_count && !failed; ++n) {
        const int k = s->filtered_first[n];
        s->block[k * MODEL_EDGES_MAX + last] = s->show[k](s->shown[k]);
    }
    if (!failed) {
        decimator_push_all(s->filter, block.count, s->block, MODEL_EDGES_MAX);
    }
    return failed;
}

/* ---------------------------------------------------------------------------------------------
 * From row to row
 * ------------------------------------------------------------------------------------------- */

int sampling_take_first(sampling *s) {
    const int failed = take_sample(s, 0.0, 0);

    if (!failed) {
        decimator_push(s->filter, s->values);
    }
    return failed;
}

int sampling_go_to_next_row(sampling *s, double row) {
    if (s->takes_blocks) {
        return take_block(s, row);
    }

    /* The last one is the first one of the next row's period. */
    for (int i = 1; i <= s->factor; ++i) {
        const int is_row = i == s->factor;
        const int failed = take_sample(s, is_row ? row + 1.0 : row, is_row ? 0 : i);
        if (failed) {
            return failed;
        }
        decimator_push(s->filter, s->values);
    }
    return 0;
}

int sampling_note(const gear_mesh *gears, config *conf) {
    char text[240] = "values at the time of the row";

    if (conf->analysis != ANALYSIS_DYNAMIC) {
        return 0;
    }
    if (conf->oversampling > 1) {
        snprintf(text, sizeof text,
                 "low-pass filtered, %s%sload_torque_Nm from means (%s of %.6g s), "
                 "but time_s, pinion_speed_rpm, angles and pairs_in_contact",
                 is_overlap_of_force(conf, gears) ? "penetration and its rate, " : "",
                 is_force_of_momentum(conf) ? "contact_force_N and " : "",
                 mean_kind(conf, gears) == SAMPLE_HAT ? "triangle, each side" : "box",
                 1.0 / (conf->output_rate * conf->oversampling));
    }

    /* Values of a force whose lines reach far beyond the samples' rate: told, not hidden. */
    const int jumps = mean_kind(conf, gears) == SAMPLE_HAT;
    if (jumps && !is_force_of_momentum(conf) && conf->oversampling > 1 && conf->oversampling < 16) {
        config_remark(conf, "output.oversampling",
                      "the force of spur gears with friction or corner contact is sampled, and "
                      "lines beyond the samples' rate fold into its rows; 16 fold less, 64 least");
    }
    return config_note_text(conf, "sampling", text) == 0 ? 0 : message_no_memory(conf->messages);
}
