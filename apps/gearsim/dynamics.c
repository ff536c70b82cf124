/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Sample by sample: the solver gives the state at the sample's time, the model what is to be seen of it,
 * the decimator rows, the output lines.
 */
#include "dynamics.h"
#include "decimate.h"
#include "dynamic_columns.h"
#include "gear_contact.h"
#include "integrate.h"
#include "mesh_cache.h"
#include "model.h"
#include "output.h"
#include "platform.h"
#include "progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct dynamic_run {
    const config *conf;
    gear_model model;
    integrator *solver;
    decimator *filter;
    output_file *output;
    progress progress;
    int factor;              /* samples per row */
    int column_count;        /* that are asked for, */
    int column[COLUMNS_MAX]; /* which of dynamic_columns they are, */
    int place[COLUMNS_MAX];  /* where the output has them, */
    double (*show[COLUMNS_MAX])(const dynamic_sample *sample); /* what is taken of a sample, */
    const dynamic_sample *shown[COLUMNS_MAX];                  /* and of which one */
    enum sample_kind mean_kind; /* of the columns that show means, SAMPLE_PLAIN: none does */
    int shows_means;            /* of force or load, */
    int shows_load;             /* and of the load */
    int edge_wanted;            /* what they need of the motion at the edges of boxes */
    int takes_blocks;           /* between rows nothing is needed but that, see take_block(), */
    int is_force_alone;         /* and of that nothing but the means of the force */
    int is_steady; /* nothing but noise and mesh changes what acts: it is in `steady` */
    model_torques steady;
    int is_started;       /* there is a sample before */
    double edge_time;     /* where the mean of the sample before has its end or its middle, */
    gear_motion edge;     /* and the motion there, */
    double edge_momentum; /* of boxes alone */
    gear_motion next;     /* at the next sample */
    double touched
        [2]; /* see integrator_touched(), where the mean begins, and up to where it is known */
    int shows_overlap; /* a column shows the mean of the penetration or of its rate: */
    double penetration_by_force, penetration_by_rate; /* what it follows from (m/N, s) */
    int follows;                                      /* drive or load depend on the motion */
    double gathered_time; /* up to which their integrals have been taken, */

    /* of the part since the edge: of the torques, and of them times the share of it */
    model_torques gathered[2];

    model_torques rising;         /* the second over the side of a triangle before its middle */
    enum column_need row_need;    /* the most that a column asked for needs of the mesh, */
    enum column_need sample_need; /* and of the mesh between the rows, as it is filtered */
    noise_piece noise;            /* of the load, about the last mean */
    double rows;                  /* number of rows, a whole number */
    double past_stop; /* +1 or -1: the stop speed is reached from below, from above; 0 = none */
    dynamic_sample sample;
    dynamic_sample behind;      /* time and motion half a period behind it, where its box ends */
    gear_motion hardest;        /* the sample with the largest force of elastic teeth, */
    double hardest_force;       /* and that force (N) */
    double values[COLUMNS_MAX]; /* of the sample, of the columns asked for, */
    double block[COLUMNS_MAX *
                 MODEL_EDGES_MAX];   /* and of a block of samples, one column after the other */
    int filtered_count;              /* of these columns are filtered, */
    int filtered_first[COLUMNS_MAX]; /* in front of the others in this order */
    char why[640];                   /* the run ended early */
} dynamic_run;

/* ---------------------------------------------------------------------------------------------
 * What a sample shows
 * ------------------------------------------------------------------------------------------- */

/* The mesh at the time and motion of the sample. */
static int see_mesh(dynamic_run *run, enum column_need need) {
    dynamic_sample *sample = &run->sample;

    /* Pairs are counted anyway, but by a cache. */
    const int pairs = run->model.cache != NULL ? GM_WANT_PAIRS : GM_WANT_FORCE;
    const int wanted = need == NEEDS_WRENCH  ? pairs | GM_WANT_WRENCH
                       : need == NEEDS_PAIRS ? pairs
                                             : GM_WANT_FORCE;
    const int status = model_evaluate(&run->model, &sample->motion, wanted, &sample->mesh);
    sample->apex = gear_contact_apex(run->model.gears);
    if (status != GM_OK) {
        snprintf(run->why, sizeof run->why, "no contact force at t = %.9g s; the gears: %s",
                 sample->time, gm_status_text(status));
        return EXIT_RUN_FAILED;
    }
    if (run->conf->law == LAW_ELASTIC && fabs(sample->mesh.force) > run->hardest_force) {
        run->hardest = sample->motion;
        run->hardest_force = fabs(sample->mesh.force);
    }
    return 0;
}

/* States of the solver at some times. */
static int see_points(dynamic_run *run, int count, const double times[],
                      integrator_point points[]) {
    const int failed =
        integrator_advance_through(run->solver, count, times, run->shows_overlap, points);
    const double time = integrator_time(run->solver);

    if (failed == EXIT_INTERRUPTED) {
        snprintf(run->why, sizeof run->why, "interrupted at t = %.9g s", time);
    } else if (failed) {
        snprintf(run->why, sizeof run->why, "%s", integrator_failure(run->solver));
    }
    return failed;
}

/* Motion at a time. */
static int see_motion(dynamic_run *run, double time, gear_motion *motion) {
    integrator_point point;
    const int failed = see_points(run, 1, &time, &point);

    if (!failed) {
        *motion = model_motion(&run->model, time, point.state);
    }
    return failed;
}

/* Time of a sample: divided once, so that k / rate is the time of row k to the last bit. */
static double sample_time(const dynamic_run *run, double row, double sample) {
    return (row + sample / run->factor) / run->conf->output_rate;
}

/* ---------------------------------------------------------------------------------------------
 * Means about a sample
 * ------------------------------------------------------------------------------------------- */

static void add_torques(model_torques *sum, double weight, const model_torques *torques) {
    sum->drive += weight * torques->drive;
    sum->load += weight * torques->load;
    sum->drag += weight * torques->drag;
}

/*
 * What follows the motion at a time. The part that is linear in the speeds is left out of boxes, whose mean
 * speeds follow exactly from the angles.
 */
static int see_torques(dynamic_run *run, double time, model_torques *torques) {
    gear_motion motion;
    const int failed = see_motion(run, time, &motion);
    if (failed) {
        return failed;
    }

    *torques = model_by_motion(&run->model, &motion);
    if (run->mean_kind == SAMPLE_HAT) {
        const double wheel_speed = model_wheel_speed(&run->model, &motion);
        const model_torques linear = model_by_speeds(&run->model, motion.pinion_speed, wheel_speed);
        add_torques(torques, 1.0, &linear);
    }
    return 0;
}

/* Adds the integrals over a time, if anything follows the motion, on which the solver goes forward: Gauss's rule of four points in pieces that are short
 * to a natural vibration, good to 1e-9 of what changes. The weights are 1, and the share of the time that is over. */
static int gather(dynamic_run *run, double to) {
    static const double nodes[4] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                    0.9305681557970263};
    static const double shares[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                     0.17392742256872693};
    const double from = run->gathered_time, length = to - from;

    if (!(length > 0.0)) {
        return 0;
    }
    const double pieces = ceil(length / model_smooth_time(&run->model, &run->edge));

    for (double piece = 0.0; piece < pieces; piece += 1.0) {
        for (int k = 0; k < 4; ++k) {
            const double share = (piece + nodes[k]) / pieces;
            model_torques torques;
            const int failed = see_torques(run, from + share * length, &torques);
            if (failed) {
                return failed;
            }
            add_torques(&run->gathered[0], shares[k] * length / pieces, &torques);
            add_torques(&run->gathered[1], shares[k] * length / pieces * share, &torques);
        }
    }
    run->gathered_time = to;
    return 0;
}

static void forget_gathered(dynamic_run *run) {
    memset(run->gathered, 0, sizeof run->gathered);
}

/* Mean of the noise under a weight. */
static double mean_noise(dynamic_run *run, const mean_weight *weight) {
    double mean = 0.0;

    for (int side = 0; side < 2 && weight->time[side] < weight->time[side + 1]; ++side) {
        mean += load_noise_integral(&run->model.load, weight->time[side], weight->time[side + 1],
                                    weight->weight[side][0], weight->weight[side][1], &run->noise);
    }
    return mean;
}

/*
 * Means of force and load, with those of the accelerations and of the torques that follow the motion. Of x'' it may be the
 * part without the noise, whose mean then is asked for by the column of the load alone.
 */
static void set_means(dynamic_run *run, const mean_weight *weight, double pinion_acceleration,
                      const model_torques *following, double acceleration, int is_without_noise) {
    dynamic_sample *sample = &run->sample;
    model_torques mean = run->is_steady
                             ? run->steady
                             : model_mean_over_time(&run->model, weight, pinion_acceleration);
    const double noise = run->shows_load || !is_without_noise ? mean_noise(run, weight) : 0.0;

    add_torques(&mean, 1.0, following);
    sample->mean_load = mean.load + noise;
    if (!is_without_noise) {
        mean.load = sample->mean_load;
    }
    sample->mean_force = model_mean_force(&run->model, &mean, acceleration);
}

/* What follows the motion over a box between two times: from the angles at both ends, and what has been gathered. */
static model_torques mean_following(const dynamic_run *run, double begin, double end,
                                    const gear_motion *motion) {
    const gear_model *model = &run->model;
    const gm_pair *pair = &model->gears->pair;
    const double turned = motion->pinion_angle - run->edge.pinion_angle;
    const double rolled = pair->pinion.base_radius * turned - (motion->offset - run->edge.offset);
    const double weight = 1.0 / (end - begin);

    const model_torques linear = model_by_speeds(model, turned, rolled / pair->wheel.base_radius);
    model_torques mean = {0.0, 0.0, 0.0};
    add_torques(&mean, weight, &linear);
    add_torques(&mean, weight, &run->gathered[0]);
    return mean;
}

/*
 * Means of the penetration and of its rate, without the mesh as long as the flanks carry: the rate is the part that touches
 * times x', and the rest of the force comes from the penetration. Else their values at the sample's time.
 */
static int set_overlap(dynamic_run *run, enum column_need seen, double begin, double end,
                       double speed, const integrator_point *last) {
    dynamic_sample *sample = &run->sample;
    const int is_hat = run->mean_kind == SAMPLE_HAT;

    if (last->carried_since <= begin && run->is_started) {
        sample->mean_rate = (last->touched - run->touched[0]) / (end - begin) * speed;
        sample->mean_penetration = run->penetration_by_force * sample->mean_force +
                                   run->penetration_by_rate * sample->mean_rate;
    } else {
        const int failed = seen < NEEDS_MESH ? see_mesh(run, NEEDS_MESH) : 0;
        if (failed) {
            return failed;
        }
        sample->mean_rate = sample->mesh.contact.rate;
        sample->mean_penetration = sample->mesh.contact.penetration;
    }

    /* The next triangle begins in the middle of this one, where that before has ended. */
    run->touched[0] = is_hat ? run->touched[1] : last->touched;
    run->touched[1] = last->touched;
    return 0;
}

/* The torques of a motion that follow it. */
static model_torques following_at(const dynamic_run *run, const gear_motion *motion) {
    const model_torques linear =
        model_by_speeds(&run->model, motion->pinion_speed, model_wheel_speed(&run->model, motion));
    model_torques torques = model_by_motion(&run->model, motion);

    add_torques(&torques, 1.0, &linear);
    return torques;
}

/* Over the sample's period: from the middle between two samples to the next, x'' from the change of x'. */
static int set_box_means(dynamic_run *run, enum column_need seen, double end,
                         const model_edge *edge, const integrator_point *last) {
    const gear_motion *motion = &edge->motion;

    /* Before t = 0 the gears rest against each other, at the speeds of the start: half of the first box. */
    const double begin = run->is_started ? run->edge_time : -end;
    const double before = run->is_started ? run->edge_momentum : 0.0;
    const double weight = 1.0 / (end - begin);
    model_torques following = {0.0, 0.0, 0.0};
    if (run->follows) {
        following = mean_following(run, begin, end, motion);
        if (!run->is_started) {
            const model_torques held = following_at(run, &run->edge);
            add_torques(&following, 0.5, &held);
        }
        forget_gathered(run);
    }
    if (run->shows_means) {
        const mean_weight box = {{begin, end, end}, {{weight, weight}, {0.0, 0.0}}};
        const double speed = motion->pinion_speed - run->edge.pinion_speed;
        const double rest =
            run->is_started ? 0.0 : 0.5 * drive_acceleration(&run->model.drive, 0.0);
        set_means(run, &box, rest + speed * weight, &following, (edge->momentum - before) * weight,
                  run->model.noise != NULL);
    }
    const double rolled = motion->offset - run->edge.offset;
    const int failed =
        run->shows_overlap ? set_overlap(run, seen, begin, end, rolled * weight, last) : 0;

    run->edge_time = end;
    run->edge = *motion;
    run->edge_momentum = edge->momentum;
    run->behind.time = end;
    run->behind.motion = *motion;
    return failed;
}

static int see_box_means(dynamic_run *run, enum column_need seen, double row, int i) {
    const double end = sample_time(run, row, i + 0.5);
    integrator_point last;
    model_edge edge;
    int failed = run->follows ? gather(run, end) : 0;
    if (!failed) {
        failed = see_points(run, 1, &end, &last);
    }
    if (failed) {
        return failed;
    }
    const double *state = last.state;
    model_edges(&run->model, 1, &end, &state, run->edge_wanted, &edge);
    return set_box_means(run, seen, end, &edge, &last);
}

/* Mean of the pinion's acceleration under a triangle: second difference of its angle, constant before t = 0. */
static double hat_acceleration(const dynamic_run *run, double begin, double middle,
                               const gear_motion *motion, double end) {
    const gear_motion *now = &run->sample.motion;
    const double fall = (motion->pinion_angle - now->pinion_angle) / (end - middle);

    if (run->is_started) {
        const double rise = (now->pinion_angle - run->edge.pinion_angle) / (middle - begin);
        return 2.0 * (fall - rise) / (end - begin);
    }
    return 0.5 * drive_acceleration(&run->model.drive, 0.0) +
           (fall - now->pinion_speed) / (end - middle);
}

/* Under a triangle from the sample before to the next, x'' from the second difference of x. */
static int see_hat_means(dynamic_run *run, enum column_need seen, double row, int i) {
    const double middle = run->sample.time, end = sample_time(run, row, i + 1.0);
    integrator_point last;
    int failed = run->follows ? gather(run, end) : 0;
    if (!failed) {
        failed = see_points(run, 1, &end, &last);
    }
    if (failed) {
        return failed;
    }

    const gear_motion motion = model_motion(&run->model, end, last.state);
    const double x = run->sample.motion.offset;
    const double begin = run->is_started ? run->edge_time : middle - (end - middle);
    const double before = run->is_started ? run->edge.offset : x;
    const double peak = 2.0 / (end - begin);
    const double rise = (x - before) / (middle - begin),
                 fall = (motion.offset - x) / (end - middle);

    /* The weight falls from the peak to zero behind the middle; what rises with it is for the next sample. */
    model_torques following = {0.0, 0.0, 0.0};
    if (run->follows) {
        if (!run->is_started) {
            const model_torques rest = following_at(run, &run->sample.motion);
            add_torques(&run->rising, 0.5 * (middle - begin), &rest);
        }
        add_torques(&following, peak, &run->rising);
        add_torques(&following, peak, &run->gathered[0]);
        add_torques(&following, -peak, &run->gathered[1]);
        run->rising = run->gathered[1];
        forget_gathered(run);
    }
    const mean_weight hat = {{begin, middle, end}, {{0.0, peak}, {peak, 0.0}}};
    set_means(run, &hat, hat_acceleration(run, begin, middle, &motion, end), &following,
              peak * (fall - rise), 0);

    /* The mean speed under a triangle of a parabola. */
    if (run->shows_overlap) {
        const double speed =
            (run->edge.offset_rate + 10.0 * run->sample.motion.offset_rate + motion.offset_rate) /
            12.0;
        failed = set_overlap(run, seen, begin, end, speed, &last);
    }

    run->edge_time = middle;
    run->edge = run->sample.motion;
    run->next = motion;
    return failed;
}

/* The motion at the sample's time, where it is needed; the triangle of the sample before has ended there. */
static int see_sample_motion(dynamic_run *run, enum column_need need) {
    if (run->mean_kind == SAMPLE_HAT && run->is_started) {
        run->sample.motion = run->next;
        return 0;
    }
    if (run->mean_kind == SAMPLE_BOX && run->is_started && need == NEEDS_TIME) {
        run->sample.motion = run->edge; /* near enough for the display of progress */
        return 0;
    }
    return see_motion(run, run->sample.time, &run->sample.motion);
}

static int see_means(dynamic_run *run, enum column_need seen, double row, int i) {
    switch (run->mean_kind) {
    case SAMPLE_BOX:
        return see_box_means(run, seen, row, i);
    case SAMPLE_HAT:
        return see_hat_means(run, seen, row, i);
    default:
        return 0;
    }
}

/* The momentum of the bodies tells the force, unless torques are not that of one force: with friction, or at corners. */
static int is_force_of_momentum(const config *conf) {
    return !config_has_friction(conf) && !config_has_corners(conf);
}

/* And the force tells the penetration, where flanks are springs that CVODE keeps account of. */
static int is_overlap_of_force(const config *conf, const gear_mesh *gears) {
    return is_force_of_momentum(conf) && conf->law != LAW_ELASTIC && gears->halves == 1 &&
           conf->method != METHOD_ERK;
}

static int takes_mean(const dynamic_run *run, const dynamic_column *column) {
    if (run->factor == 1 || column->mean == NULL) {
        return 0;
    }
    switch (column->need) {
    case NEEDS_FORCE:
        return is_force_of_momentum(run->conf);
    case NEEDS_MESH:
        return is_overlap_of_force(run->conf, run->model.gears);
    default:
        return 1;
    }
}

/* Of the row's sample all columns, of others those that are filtered. */
static void set_values(dynamic_run *run, int of_row) {
    const int count = of_row ? run->column_count : run->filtered_count;

    for (int n = 0; n < count; ++n) {
        const int k = run->filtered_first[n];
        run->values[k] = run->show[k](run->shown[k]);
    }
}

/* Before the first sample: its values, or those at its own time in place of those behind it. */
static void hold_values(dynamic_run *run) {
    const dynamic_sample behind = run->behind;
    double held[COLUMNS_MAX];

    memcpy(held, run->values, sizeof held);
    run->behind = run->sample;
    for (int k = 0; k < run->column_count; ++k) {
        if (run->shown[k] == &run->behind) {
            held[k] = run->show[k](&run->behind);
        }
    }
    run->behind = behind;
    decimator_hold(run->filter, held);
}

/* Sample i of a row's period; values that nobody needs are left as they were. */
static int take_sample(dynamic_run *run, double row, int i) {
    const int of_row = i == 0;
    const enum column_need need = of_row ? run->row_need : run->sample_need;

    /* Where the gears are, how they touch if a column needs to know, and what they do about that time. */
    run->sample.time = sample_time(run, row, i);
    int failed = run->follows ? gather(run, run->sample.time) : 0;
    if (!failed) {
        failed = see_sample_motion(run, need);
    }
    if (!failed && need >= NEEDS_FORCE) {
        failed = see_mesh(run, need);
    }
    if (!failed) {
        if (!run->is_started) {
            run->edge = run->sample.motion;
        }
        failed = see_means(run, need, row, i);
    }
    if (failed) {
        return failed;
    }

    set_values(run, of_row);
    if (!run->is_started) {
        hold_values(run);
    }
    run->is_started = 1;
    return 0;
}

/* Samples on the way from a row to the next: as many as a row has, the last of them at the next row's time. */
typedef struct sample_block {
    int count;
    double centre[MODEL_EDGES_MAX], end[MODEL_EDGES_MAX]; /* of their boxes */
    gear_motion of_row;                                   /* at the last centre */
    model_edge edges[MODEL_EDGES_MAX];                    /* at the ends, */
    integrator_point points[2 * MODEL_EDGES_MAX];         /* and what the solver says there, */
    int each;                                             /* and at the centres before them: 2 */
} sample_block;

/* The solver only goes forward: centres with the ends, where flanks that do not carry may have to be looked at there. */
static int see_block(dynamic_run *run, double row, sample_block *block) {
    const int count = run->factor, each = run->shows_overlap ? 2 : 1;
    double times[2 * MODEL_EDGES_MAX];
    const double *states[MODEL_EDGES_MAX];

    block->count = count;
    block->each = each;
    for (int j = 0; j < count; ++j) {
        block->centre[j] = sample_time(run, row, j + 1.0);
        block->end[j] = sample_time(run, row, j + 1.5);
        times[each * j] = block->centre[j];
        times[each * j + each - 1] = block->end[j];
        states[j] = block->points[each * j + each - 1].state;
    }

    /* All ends, and before the last one the row's own time. */
    int failed = see_points(run, each * count - 1, times, block->points);
    if (!failed && each == 2) {
        block->of_row =
            model_motion(&run->model, block->centre[count - 1], block->points[2 * count - 2].state);
    } else if (!failed && run->row_need > NEEDS_TIME) {
        failed = see_motion(run, block->centre[count - 1], &block->of_row);
    }
    if (!failed) {
        failed = see_points(run, 1, &block->end[count - 1], &block->points[each * count - 1]);
    }
    if (!failed) {
        model_edges(&run->model, count, block->end, states, run->edge_wanted, block->edges);
    }
    if (!failed && each == 1 && run->row_need == NEEDS_TIME) {
        /* Near enough for the display of progress. */
        block->of_row = block->edges[count - 1].motion;
    }
    return failed;
}

/* Of the block the means of the force, the only column that is filtered. */
static void set_forces(dynamic_run *run, const sample_block *block) {
    double *force = run->block + run->filtered_first[0] * MODEL_EDGES_MAX;

    for (int j = 0; j < block->count; ++j) {
        const double weight = 1.0 / (block->end[j] - run->edge_time);
        const double change = block->edges[j].momentum - run->edge_momentum;

        force[j] = model_mean_force(&run->model, &run->steady, change * weight);
        run->edge_time = block->end[j];
        run->edge_momentum = block->edges[j].momentum;
    }
    run->edge = block->edges[block->count - 1].motion;
}

/* Of a sample of the block all columns that are filtered. */
static int set_sample(dynamic_run *run, const sample_block *block, int j) {
    const int is_row = j == block->count - 1;
    const enum column_need seen = is_row ? run->row_need : NEEDS_TIME;
    const integrator_point *last = &block->points[block->each * (j + 1) - 1];

    run->sample.time = block->centre[j];
    if (!is_row && run->shows_overlap && !(last->carried_since <= run->edge_time)) {
        run->sample.motion =
            model_motion(&run->model, block->centre[j], block->points[2 * j].state);
    }
    const int failed = set_box_means(run, seen, block->end[j], &block->edges[j], last);
    for (int n = 0; n < run->filtered_count; ++n) {
        const int k = run->filtered_first[n];
        run->block[k * MODEL_EDGES_MAX + j] = run->show[k](run->shown[k]);
    }
    return failed;
}

/* All that samples take between the rows is where their boxes end. */
static int take_block(dynamic_run *run, double row) {
    sample_block block;
    int failed = see_block(run, row, &block);
    const int last = block.count - 1;

    for (int j = 0; j < last && !failed && !run->is_force_alone; ++j) {
        failed = set_sample(run, &block, j);
    }

    /* The row's own sample, with the mesh if a column needs to know. */
    run->sample.time = block.centre[last];
    run->sample.motion = block.of_row;
    if (!failed && run->row_need >= NEEDS_FORCE) {
        failed = see_mesh(run, run->row_need);
    }
    if (!failed && run->is_force_alone) {
        set_forces(run, &block);
    } else if (!failed) {
        failed = set_sample(run, &block, last);
    }
    for (int n = run->filtered_count; n < run->column_count && !failed; ++n) {
        const int k = run->filtered_first[n];
        run->block[k * MODEL_EDGES_MAX + last] = run->show[k](run->shown[k]);
    }
    if (!failed) {
        decimator_push_all(run->filter, block.count, run->block, MODEL_EDGES_MAX);
    }
    return failed;
}

static void tell_progress(dynamic_run *run) {
    if (progress_due(&run->progress)) {
        const progress_state state = {
            .time = run->sample.time,
            .speed = run->sample.motion.pinion_speed,
            .steps = integrator_counts(run->solver).steps,
        };
        progress_update(&run->progress, &state);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Rows
 * ------------------------------------------------------------------------------------------- */

/* The first row at or beyond the stop speed is the last one. */
static void look_for_stop(dynamic_run *run, double row) {
    const double beyond =
        run->past_stop * (run->sample.motion.pinion_speed - run->conf->stop_speed);

    if (run->past_stop != 0.0 && beyond >= 0.0 && row + 1.0 < run->rows) {
        run->rows = row + 1.0;
        run->past_stop = 0.0;
    }
}

/* A row that is complete: that of the first sample of a period, with the filter's delay behind it. */
static int write_row(dynamic_run *run) {
    double shown[COLUMNS_MAX], values[COLUMNS_MAX];

    decimator_values(run->filter, shown);
    for (int k = 0; k < run->column_count; ++k) {
        values[run->place[k]] = shown[k];
    }
    if (output_row(run->output, values) != 0) {
        snprintf(run->why, sizeof run->why, "the disk took no more at t = %.9g s",
                 run->sample.time);
        return EXIT_RUN_FAILED;
    }
    return 0;
}

/* The samples from a row's time on, up to that of the next. */
static int go_to_next_row(dynamic_run *run, double row) {
    if (run->takes_blocks) {
        return take_block(run, row);
    }

    /* The last one is the first one of the next row's period. */
    for (int i = 1; i <= run->factor; ++i) {
        const int is_row = i == run->factor;
        const int failed = take_sample(run, is_row ? row + 1.0 : row, is_row ? 0 : i);
        if (failed) {
            return failed;
        }
        decimator_push(run->filter, run->values);
    }
    return 0;
}

static int take_all(dynamic_run *run) {
    const double delay = (double)(decimator_delay(run->filter) / run->factor);
    int failed = take_sample(run, 0.0, 0);

    if (!failed) {
        decimator_push(run->filter, run->values);
    }
    for (double row = 0.0; !failed; row += 1.0) {
        tell_progress(run);
        look_for_stop(run, row);

        /* The rows that lag behind by the filter's delay are complete with their period's first sample. */
        if (row >= delay) {
            failed = write_row(run);
        }
        if (failed || row + 1.0 >= run->rows + delay) {
            break;
        }
        failed = go_to_next_row(run, row);
    }
    return failed;
}

/* ---------------------------------------------------------------------------------------------
 * Start and end
 * ------------------------------------------------------------------------------------------- */

static int start_solver(dynamic_run *run) {
    const config *conf = run->conf;
    const integrator_options options = {
        .method = conf->method,
        .relative_tolerance = conf->relative_tolerance,
        .absolute_tolerance = conf->absolute_tolerance,
        .max_step = conf->max_step,
    };
    double start[STATES_MAX];
    const int status = model_quasi_static_start(&run->model, start);

    if (status != GM_OK) {
        message_of_program(conf->messages, "no quasi-static start at the mean load: %s",
                           gm_status_text(status));
        return EXIT_RUN_FAILED;
    }
    run->solver = integrator_create(&run->model, &options, start);
    return run->solver != NULL ? 0 : message_no_memory(run->conf->messages);
}

static enum column_need larger(enum column_need a, enum column_need b) {
    return a > b ? a : b;
}

/*
 * How means are taken. A force that jumps has lines far beyond the samples' rate, which the triangle takes off twice
 * as well; that of helical gears has next to none, and x' alone is known better than the second difference of x.
 */
static enum sample_kind mean_kind(const config *conf, const gear_mesh *gears) {
    return conf->model == MODEL_3D && gears->pair.face_advance == 0.0 ? SAMPLE_HAT : SAMPLE_BOX;
}

/* What the filter gets of a column. */
static enum sample_kind kind_of(const dynamic_run *run, const dynamic_column *column) {
    if (!column->is_filtered) {
        return SAMPLE_PLAIN;
    }
    const enum sample_kind means = mean_kind(run->conf, run->model.gears);
    if (takes_mean(run, column)) {
        return means;
    }

    /* Where boxes end the motion is known anyway, so that it is not asked for at the samples' own times. */
    return run->factor > 1 && means == SAMPLE_BOX && column->need == NEEDS_MOTION ? SAMPLE_BEHIND
                                                                                  : SAMPLE_VALUES;
}

/* What the means take. */
static void prepare_means(dynamic_run *run) {
    const gear_model *model = &run->model;
    const int drive_is_steady =
        model->states == STATES_MAX ? model->drive.table == NULL : drive_is_linear(&model->drive);
    const mean_weight any = {{0.0, 1.0, 1.0}, {{1.0, 1.0}, {0.0, 0.0}}};

    run->follows = run->shows_means && model_follows_motion(model);
    run->is_steady = drive_is_steady && model->load.table == NULL;
    if (run->is_steady) {
        run->steady = model_mean_over_time(model, &any, 0.0);
    }

    /* The motion at the edges, if it is only for the display of progress. */
    if (run->follows || !drive_is_steady || run->row_need < NEEDS_MOTION) {
        run->edge_wanted |= EDGE_OFFSET | EDGE_PINION;
    }
    if (run->shows_overlap) {
        run->edge_wanted |= EDGE_OFFSET;
        run->penetration_by_force = gear_contact_penetration(model->gears, 1.0, 0.0);
        run->penetration_by_rate = gear_contact_penetration(model->gears, 0.0, 1.0);
    }

    /* Where torques follow the motion, it is gathered sample by sample; flanks that do not carry are looked at. */
    if (run->shows_overlap && run->follows) {
        run->sample_need = larger(run->sample_need, NEEDS_MOTION);
        run->row_need = larger(run->row_need, NEEDS_MOTION);
    }
    run->takes_blocks =
        run->mean_kind == SAMPLE_BOX && run->sample_need == NEEDS_TIME && !run->follows;
    run->is_force_alone = run->takes_blocks && run->filtered_count == 1 && run->shows_means &&
                          !run->shows_load && !run->shows_overlap && run->is_steady &&
                          (model->noise != NULL || model->load.amplitude == 0.0);
}

/* Those that are filtered first. */
static void order_columns(dynamic_run *run) {
    for (int pass = 1, n = 0; pass >= 0; --pass) {
        for (int k = 0; k < run->column_count; ++k) {
            if (dynamic_columns[run->column[k]].is_filtered == pass) {
                run->filtered_first[n++] = k;
                run->filtered_count += pass;
            }
        }
    }
}

/* What is asked for decides what has to be computed, and whether there is anything to filter. */
static int start_filter(dynamic_run *run) {
    enum sample_kind kinds[COLUMNS_MAX];
    int any = 0, name = 0;

    for (int i = 0; i < dynamic_column_count; ++i) {
        /* The output counts those that these gears have. */
        if (!dynamic_column_is_there(run->conf, i)) {
            continue;
        }
        if (output_wants(run->output, name)) {
            run->place[run->column_count] = name;
            run->column[run->column_count++] = i;
            any |= dynamic_columns[i].is_filtered;
        }
        ++name;
    }
    run->factor = any ? run->conf->oversampling : 1;

    for (int k = 0; k < run->column_count; ++k) {
        const dynamic_column *column = &dynamic_columns[run->column[k]];

        kinds[k] = kind_of(run, column);
        run->show[k] = takes_mean(run, column) ? column->mean : column->value;
        run->shown[k] = kinds[k] == SAMPLE_BEHIND ? &run->behind : &run->sample;
        switch (kinds[k]) {
        case SAMPLE_BEHIND:
            run->mean_kind = SAMPLE_BOX;
            run->edge_wanted = EDGE_OFFSET | EDGE_PINION;
            break;
        case SAMPLE_BOX:
        case SAMPLE_HAT:
            run->mean_kind = kinds[k];
            run->shows_means = 1;
            run->shows_load |= column->need == NEEDS_MOTION;
            run->shows_overlap |= column->need == NEEDS_MESH;
            break;
        case SAMPLE_VALUES:
            run->sample_need = larger(run->sample_need, column->need);
            run->row_need = larger(run->row_need, column->need);
            break;
        default:
            run->row_need = larger(run->row_need, column->need);
            break;
        }
    }

    /* The speed that ends the run is looked at in every row. */
    if (run->conf->drive == DRIVE_TORQUE && !isnan(run->conf->stop_speed)) {
        run->row_need = larger(run->row_need, NEEDS_MOTION);
        run->past_stop = run->conf->stop_speed >= run->conf->start_speed ? 1.0 : -1.0;
    }

    order_columns(run);
    prepare_means(run);
    run->filter = decimator_create(run->factor, run->column_count, kinds);
    return run->filter != NULL ? 0 : message_no_memory(run->conf->messages);
}

static int start_run(dynamic_run *run, const gear_mesh *gears) {
    if (model_init(&run->model, run->conf, gears) != 0) {
        return message_no_memory(run->conf->messages);
    }
    run->sample.model = run->behind.model = &run->model;

    int exit_code = start_solver(run);
    if (exit_code != 0) {
        return exit_code;
    }

    const column_names names = dynamic_column_names(run->conf);
    run->output = output_open(run->conf, names.name, names.count, &exit_code);
    if (exit_code == 0) {
        exit_code = start_filter(run);
    }
    if (exit_code != 0) {
        return exit_code;
    }
    return mesh_cache_fill(run->model.cache, run->conf, gears, &run->progress) == 0
               ? 0
               : message_no_memory(run->conf->messages);
}

static void summarize(const dynamic_run *run) {
    const integrator_statistics counts = integrator_counts(run->solver);

    message_note(run->conf->messages,
                 "gearsim: %.6g s simulated in %.3g s: %ld steps (%ld more repeated), %ld "
                 "right-hand sides, %ld looks ahead",
                 integrator_time(run->solver), progress_elapsed(&run->progress), counts.steps,
                 counts.rejected, counts.derivatives, counts.looks);
}

/* Looks once at the pressure, where the force was largest. */
static void warn_of_pressure(dynamic_run *run) {
    const gear_mesh *gears = run->model.gears;
    gm_mesh_result mesh;
    gm_position position;
    gm_line_loads load;
    if (run->hardest_force > 0.0 &&
        model_evaluate(&run->model, &run->hardest, GM_WANT_FORCE, &mesh) == GM_OK &&
        gm_position_from_pinion_angle(&gears->pair, run->hardest.pinion_angle, run->hardest.offset,
                                      0.0, &position) == GM_OK &&
        gear_contact_line_loads(gears, &position, NULL, 0, &load) == GM_OK) {
        gear_contact_warn(run->conf, &load);
    }
}

/* Tells how it went and closes the file; returns the exit code of the run. */
static int end_run(dynamic_run *run, int exit_code) {
    progress_clear(&run->progress);
    if (exit_code != 0) {
        message_of_program(run->conf->messages, "%s", run->why);
    } else if (run->past_stop != 0.0) {
        config_warn(run->conf, "analysis.stop_rpm",
                    "not reached within analysis.duration_s, which ended the run");
    }
    warn_of_pressure(run);
    summarize(run);

    const int closed = output_close(run->output, exit_code != 0 ? run->why : NULL);
    return exit_code != 0 ? exit_code : closed;
}

int dynamics_note(const gear_mesh *gears, config *conf) {
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

double dynamics_rows(const config *conf) {
    return floor(conf->duration * conf->output_rate + 1e-9) + 1.0;
}

int dynamics_run(const config *conf, const gear_mesh *gears) {
    dynamic_run run = {.conf = conf, .rows = dynamics_rows(conf)};

    interrupt_watch(SECOND_KILLS);
    progress_start(&run.progress, conf->duration, conf->messages);

    int exit_code = start_run(&run, gears);
    if (exit_code == 0) {
        exit_code = end_run(&run, take_all(&run));
    } else if (run.output != NULL) {
        output_close(run.output, "the run could not be started");
    }
    interrupt_unwatch();
    decimator_free(run.filter);
    integrator_free(run.solver);
    model_free(&run.model);
    return exit_code;
}
