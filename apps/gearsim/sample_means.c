/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "sample_means.h"
#include "gear_contact.h"

#include <math.h>
#include <string.h>

void sample_means_prepare(sampling *s) {
    const gear_model *model = s->model;
    const int drive_is_steady =
        model->states == STATES_MAX ? model->drive.table == NULL : drive_is_linear(&model->drive);
    const mean_weight any = {{0.0, 1.0, 1.0}, {{1.0, 1.0}, {0.0, 0.0}}};

    /* Torques that neither time nor motion changes have one mean. */
    s->follows = s->shows_means && model_follows_motion(model);
    s->means.is_steady = drive_is_steady && model->load.table == NULL;
    if (s->means.is_steady) {
        s->means.steady = model_mean_over_time(model, &any, 0.0);
    }

    /* The motion at the edges, from which torques that change follow. */
    if (s->follows || !drive_is_steady) {
        s->edge_wanted |= EDGE_OFFSET | EDGE_PINION;
    }

    /* What turns a force into an overlap. */
    if (s->shows_overlap) {
        s->edge_wanted |= EDGE_OFFSET;
        s->means.penetration_by_force = gear_contact_penetration(model->gears, 1.0, 0.0);
        s->means.penetration_by_rate = gear_contact_penetration(model->gears, 0.0, 1.0);
    }
}

/* ---------------------------------------------------------------------------------------------
 * What follows the motion
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
static int see_torques(sampling *s, double time, model_torques *torques) {
    gear_motion motion;
    const int failed = sample_motion(s, time, &motion);
    if (failed) {
        return failed;
    }

    *torques = model_by_motion(s->model, &motion);
    if (s->mean_kind == SAMPLE_HAT) {
        const double wheel_speed = model_wheel_speed(s->model, &motion);
        const model_torques linear = model_by_speeds(s->model, motion.pinion_speed, wheel_speed);
        add_torques(torques, 1.0, &linear);
    }
    return 0;
}

/* By Gauss's rule of four points, in pieces that are short to a natural vibration: good to 1e-9 of what changes. */
int sample_means_gather(sampling *s, double to) {
    static const double nodes[4] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                    0.9305681557970263};
    static const double shares[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                     0.17392742256872693};
    const double from = s->means.gathered_time, length = to - from;

    if (!(length > 0.0)) {
        return 0;
    }

    /* Gauss's rule of four points in each piece: the integral, and the one under a weight that rises from 0 to 1. */
    const double pieces = ceil(length / model_smooth_time(s->model, &s->means.edge));

    for (double piece = 0.0; piece < pieces; piece += 1.0) {
        for (int k = 0; k < 4; ++k) {
            const double share = (piece + nodes[k]) / pieces;
            model_torques torques;
            const int failed = see_torques(s, from + share * length, &torques);
            if (failed) {
                return failed;
            }
            add_torques(&s->means.gathered[0], shares[k] * length / pieces, &torques);
            add_torques(&s->means.gathered[1], shares[k] * length / pieces * share, &torques);
        }
    }
    s->means.gathered_time = to;
    return 0;
}

static void forget_gathered(sampling *s) {
    memset(s->means.gathered, 0, sizeof s->means.gathered);
}

/* The torques of a motion that follow it. */
static model_torques following_at(const sampling *s, const gear_motion *motion) {
    const model_torques linear =
        model_by_speeds(s->model, motion->pinion_speed, model_wheel_speed(s->model, motion));
    model_torques torques = model_by_motion(s->model, motion);

    add_torques(&torques, 1.0, &linear);
    return torques;
}

/* ---------------------------------------------------------------------------------------------
 * Force, load and overlap
 * ------------------------------------------------------------------------------------------- */

/* Mean of the noise under a weight. */
static double mean_noise(sampling *s, const mean_weight *weight) {
    double mean = 0.0;

    for (int side = 0; side < 2 && weight->time[side] < weight->time[side + 1]; ++side) {
        mean +=
            load_noise_integral(&s->model->load, weight->time[side], weight->time[side + 1],
                                weight->weight[side][0], weight->weight[side][1], &s->means.noise);
    }
    return mean;
}

/*
 * Means of force and load, with those of the accelerations and of the torques that follow the motion. Of x'' it may be the
 * part without the noise, whose mean then is asked for by the column of the load alone.
 */
static void set_means(sampling *s, const mean_weight *weight, double pinion_acceleration,
                      const model_torques *following, double acceleration, int is_without_noise) {
    dynamic_sample *sample = &s->sample;
    model_torques mean = s->means.is_steady
                             ? s->means.steady
                             : model_mean_over_time(s->model, weight, pinion_acceleration);
    const double noise = s->shows_load || !is_without_noise ? mean_noise(s, weight) : 0.0;

    /* The load has all of its noise; the force only what x'' has of it. */
    add_torques(&mean, 1.0, following);
    sample->mean_load = mean.load + noise;
    if (!is_without_noise) {
        mean.load = sample->mean_load;
    }
    sample->mean_force = model_mean_force(s->model, &mean, acceleration);
}

/*
 * Means of the penetration and of its rate, without the mesh as long as the flanks carry: the rate is the part that touches
 * times x', and the rest of the force comes from the penetration. Else their values at the sample's time.
 */
static int set_overlap(sampling *s, enum column_need seen, double begin, double end, double speed,
                       const integrator_point *last) {
    dynamic_sample *sample = &s->sample;
    const int is_hat = s->mean_kind == SAMPLE_HAT;

    /* Flanks that have carried all the time of the mean are springs; others are looked at. */
    if (last->carried_since <= begin && s->means.is_started) {
        sample->mean_rate = (last->touched - s->means.touched[0]) / (end - begin) * speed;
        sample->mean_penetration = s->means.penetration_by_force * sample->mean_force +
                                   s->means.penetration_by_rate * sample->mean_rate;
    } else {
        const int failed = seen < NEEDS_MESH ? sample_mesh(s, NEEDS_MESH) : 0;
        if (failed) {
            return failed;
        }
        sample->mean_rate = sample->mesh.contact.rate;
        sample->mean_penetration = sample->mesh.contact.penetration;
    }

    /* The next triangle begins in the middle of this one, where that before has ended. */
    s->means.touched[0] = is_hat ? s->means.touched[1] : last->touched;
    s->means.touched[1] = last->touched;
    return 0;
}

/* ---------------------------------------------------------------------------------------------
 * Boxes
 * ------------------------------------------------------------------------------------------- */

/* What follows the motion over a box between two times: from the angles at both ends, and what has been gathered. */
static model_torques mean_following(const sampling *s, double begin, double end,
                                    const gear_motion *motion) {
    const gear_model *model = s->model;
    const gm_pair *pair = &model->gears->pair;
    const double turned = motion->pinion_angle - s->means.edge.pinion_angle;
    const double rolled =
        pair->pinion.base_radius * turned - (motion->offset - s->means.edge.offset);
    const double weight = 1.0 / (end - begin);

    const model_torques linear = model_by_speeds(model, turned, rolled / pair->wheel.base_radius);
    model_torques mean = {0.0, 0.0, 0.0};
    add_torques(&mean, weight, &linear);
    add_torques(&mean, weight, &s->means.gathered[0]);
    return mean;
}

/* Means of force and load over a box in which nothing but the noise changes what acts. */
static void set_plain_means(sampling *s, double end, const model_edge *edge) {
    const double weight = 1.0 / (end - s->means.edge_time);
    const double change = edge->momentum - s->means.edge_momentum;

    s->sample.mean_force = model_mean_force(s->model, &s->means.steady, change * weight);
    if (s->shows_load) {
        /* What the noise has given x' tells its integral. */
        s->sample.mean_load = s->means.steady.load + (edge->given - s->means.edge_given) * weight /
                                                         s->model->torque_to_offset;
    }
}

/* Force and load over any box from the changes of both speeds; what follows the motion comes from its angles. */
static void set_box(sampling *s, double end, const model_edge *edge) {
    const gear_motion *motion = &edge->motion;

    /* Before t = 0 the gears rest against each other, at the speeds of the start: half of the first box. */
    const double begin = s->means.is_started ? s->means.edge_time : -end;
    const double before = s->means.is_started ? s->means.edge_momentum : 0.0;
    const double weight = 1.0 / (end - begin);

    /* Torques that follow the motion; over the half before the start those of the start are held. */
    model_torques following = {0.0, 0.0, 0.0};
    if (s->follows) {
        following = mean_following(s, begin, end, motion);
        if (!s->means.is_started) {
            const model_torques held = following_at(s, &s->means.edge);
            add_torques(&following, 0.5, &held);
        }
        forget_gathered(s);
    }

    const mean_weight box = {{begin, end, end}, {{weight, weight}, {0.0, 0.0}}};
    const double speed = motion->pinion_speed - s->means.edge.pinion_speed;
    const double rest = s->means.is_started ? 0.0 : 0.5 * drive_acceleration(&s->model->drive, 0.0);
    set_means(s, &box, rest + speed * weight, &following, (edge->momentum - before) * weight,
              s->model->noise != NULL);
}

/* Over the sample's period: from the middle between two samples to the next, x'' from the change of x'. */
int sample_means_set_box(sampling *s, enum column_need seen, double end, const model_edge *edge,
                         const integrator_point *last) {
    const gear_motion *motion = &edge->motion;
    const double begin = s->means.is_started ? s->means.edge_time : -end;

    /* Force and load, then the overlap from the force. */
    if (s->is_plain_box && s->means.is_started) {
        set_plain_means(s, end, edge);
    } else if (s->shows_means) {
        set_box(s, end, edge);
    }
    const double rolled = motion->offset - s->means.edge.offset;
    const int failed =
        s->shows_overlap ? set_overlap(s, seen, begin, end, rolled / (end - begin), last) : 0;

    /* The next box begins here. */
    s->means.edge_time = end;
    s->means.edge = *motion;
    s->means.edge_momentum = edge->momentum;
    s->means.edge_given = edge->given;
    s->behind.time = end;
    s->behind.motion = *motion;
    return failed;
}

/* Of a sample for itself: its box ends half-way to the next one. */
static int see_box_means(sampling *s, enum column_need seen, double row, int i) {
    const double end = sample_time(s, row, i + 0.5);
    integrator_point last;
    model_edge edge;
    int failed = s->follows ? sample_means_gather(s, end) : 0;
    if (!failed) {
        failed = sample_points(s, 1, &end, &last);
    }
    if (failed) {
        return failed;
    }

    const double *state = last.state;
    model_edges(s->model, 1, &end, &state, s->edge_wanted, &edge);
    return sample_means_set_box(s, seen, end, &edge, &last);
}

/* ---------------------------------------------------------------------------------------------
 * Triangles
 * ------------------------------------------------------------------------------------------- */

/* Mean of the pinion's acceleration under a triangle: second difference of its angle, constant before t = 0. */
static double hat_acceleration(const sampling *s, double begin, double middle,
                               const gear_motion *motion, double end) {
    const gear_motion *now = &s->sample.motion;
    const double fall = (motion->pinion_angle - now->pinion_angle) / (end - middle);

    if (s->means.is_started) {
        const double rise = (now->pinion_angle - s->means.edge.pinion_angle) / (middle - begin);
        return 2.0 * (fall - rise) / (end - begin);
    }
    return 0.5 * drive_acceleration(&s->model->drive, 0.0) +
           (fall - now->pinion_speed) / (end - middle);
}

/* Under a triangle from the sample before to the next, x'' from the second difference of x. */
static int see_hat_means(sampling *s, enum column_need seen, double row, int i) {
    const double middle = s->sample.time, end = sample_time(s, row, i + 1.0);
    integrator_point last;
    int failed = s->follows ? sample_means_gather(s, end) : 0;
    if (!failed) {
        failed = sample_points(s, 1, &end, &last);
    }
    if (failed) {
        return failed;
    }

    /* Before t = 0 the gears rest against each other: one side of the triangle is level. */
    const gear_motion motion = model_motion(s->model, end, last.state);
    const double x = s->sample.motion.offset;
    const double begin = s->means.is_started ? s->means.edge_time : middle - (end - middle);
    const double before = s->means.is_started ? s->means.edge.offset : x;
    const double peak = 2.0 / (end - begin);
    const double rise = (x - before) / (middle - begin),
                 fall = (motion.offset - x) / (end - middle);

    /* The weight falls from the peak to zero behind the middle; what rises with it is for the next sample. */
    model_torques following = {0.0, 0.0, 0.0};
    if (s->follows) {
        if (!s->means.is_started) {
            const model_torques rest = following_at(s, &s->sample.motion);
            add_torques(&s->means.rising, 0.5 * (middle - begin), &rest);
        }
        add_torques(&following, peak, &s->means.rising);
        add_torques(&following, peak, &s->means.gathered[0]);
        add_torques(&following, -peak, &s->means.gathered[1]);
        s->means.rising = s->means.gathered[1];
        forget_gathered(s);
    }

    const mean_weight hat = {{begin, middle, end}, {{0.0, peak}, {peak, 0.0}}};
    set_means(s, &hat, hat_acceleration(s, begin, middle, &motion, end), &following,
              peak * (fall - rise), 0);

    /* The mean speed under a triangle of a parabola. */
    if (s->shows_overlap) {
        const double speed =
            (s->means.edge.offset_rate + 10.0 * s->sample.motion.offset_rate + motion.offset_rate) /
            12.0;
        failed = set_overlap(s, seen, begin, end, speed, &last);
    }

    /* The next triangle begins at this sample, and its middle is where this one ends. */
    s->means.edge_time = middle;
    s->means.edge = s->sample.motion;
    s->means.next = motion;
    return failed;
}

int sample_means_see(sampling *s, enum column_need seen, double row, int i) {
    switch (s->mean_kind) {
    case SAMPLE_BOX:
        return see_box_means(s, seen, row, i);
    case SAMPLE_HAT:
        return see_hat_means(s, seen, row, i);
    default:
        return 0;
    }
}
