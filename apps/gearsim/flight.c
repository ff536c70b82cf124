/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "flight.h"

#include <math.h>

/* Pieces that one look ahead is made of, at most. */
enum { PIECES_MAX = 200 };

/* Between its values the noise exceeds its amplitude by up to a quarter (load.h). */
static const double noise_overshoot = 1.25;

/* Ratio of the noise to the tolerance from which on the solver's error estimate is never next to zero. */
static const double guiding_noise = 100.0;

/* A new touch widens to the whole line within so many half vibrations. */
static const double widening = 5.0;

static const double pi = 3.14159265358979323846;

/* Motion without contact: x and the pinion's angle are parabolas over the time from here on. */
typedef struct flight {
    const gear_model *model;
    gear_motion start;
    model_flight force_free;   /* accelerations of drive, load without noise, and drag */
    double noise_acceleration; /* most that the noise adds to x'' (m/s2) */
    long *evaluations;
} flight;

typedef struct range {
    double lowest, highest;
} range;

static double offset_at(const flight *free, double t) {
    return free->start.offset +
           t * (free->start.offset_rate + 0.5 * free->force_free.acceleration * t);
}

static double angle_at(const flight *free, double t) {
    return free->start.pinion_angle +
           t * (free->start.pinion_speed + 0.5 * free->force_free.pinion_acceleration * t);
}

/* Values of x between two times: those at both ends, at the vertex, and what noise and change of the torques may add. */
static range offsets_between(const flight *free, double from, double to) {
    const double fall = free->force_free.acceleration;
    const double first = offset_at(free, from), last = offset_at(free, to);
    const double vertex = fall != 0.0 ? -free->start.offset_rate / fall : from;
    const double middle = vertex > from && vertex < to ? offset_at(free, vertex) : first;
    const double other =
        0.5 * free->noise_acceleration * to * to + free->force_free.jerk / 6.0 * to * to * to;

    const range found = {
        .lowest = fmin(fmin(first, last), middle) - other,
        .highest = fmax(fmax(first, last), middle) + other,
    };
    return found;
}

/* Largest speed of the contact along the profiles between two times (m/s). */
static double sliding_between(const flight *free, double from, double to) {
    const double first = free->start.pinion_speed + free->force_free.pinion_acceleration * from;
    const double last = free->start.pinion_speed + free->force_free.pinion_acceleration * to;
    const double other = 0.5 * free->force_free.pinion_jerk * to * to;

    return free->model->gears->pair.pinion.base_radius * (fmax(fabs(first), fabs(last)) + other);
}

/* Whether a side is free of contact at a time, if x were the one given. A failed evaluation is no freedom. */
static int side_is_free(const flight *free, int side, double t, double offset) {
    gear_motion motion = free->start;
    gm_mesh_result mesh;

    motion.pinion_angle = angle_at(free, t);
    motion.offset = offset;
    ++*free->evaluations;
    return model_evaluate(free->model, &motion, GM_WANT_FORCE, &mesh) == GM_OK &&
           (side == GM_DRIVE ? mesh.contact.drive : mesh.contact.coast) == 0.0;
}

/*
 * A point of a flank that lies on a line of contact at some time between `from` and `to` does so at one of both
 * ends too, as passing through the path of contact takes longer. Meanwhile its gap shrinks by what the mates
 * move together and by what the profiles rise along the way of the contact, at most.
 */
static int side_stays_clear(const flight *free, int side, double from, double to, range x) {
    const gear_model *model = free->model;
    const double direction = side == GM_DRIVE ? 1.0 : -1.0;
    const double nearest = side == GM_DRIVE ? x.highest : x.lowest;
    const double clearance = 0.5 * model->gears->pair.backlash;

    /* Too far for the highest points of both flanks. */
    if (direction * nearest + model->reach[side] <= clearance) {
        return 1;
    }
    if (model->is_ideal[side]) {
        return 0;
    }

    const double off_parabola =
        model->gears->pair.pinion.base_radius * free->force_free.pinion_jerk / 6.0 * to * to * to;
    const double way =
        sliding_between(free, from, to) * (to - from) + (x.highest - x.lowest) + off_parabola;
    const double closest = nearest + direction * model->slope[side] * way;
    return side_is_free(free, side, from, closest) && side_is_free(free, side, to, closest);
}

static int stays_clear(const flight *free, double from, double to) {
    const range x = offsets_between(free, from, to);

    return side_stays_clear(free, GM_DRIVE, from, to, x) &&
           side_stays_clear(free, GM_COAST, from, to, x);
}

/*
 * With an approach at the speed v, a touch of the time h is no deeper than v h and changes x' by
 * w0^2 v h^2 / 2 at most.
 */
static double shortest_touch(const flight *free, const flight_options *options) {
    const double w0 = free->model->natural_frequency;
    const double slope = fmax(free->model->slope[GM_DRIVE], free->model->slope[GM_COAST]);
    const double fall = fabs(free->force_free.acceleration) + free->noise_acceleration +
                        free->force_free.jerk * options->longest;
    const double approach = fabs(free->start.offset_rate) + fall * options->longest +
                            slope * sliding_between(free, 0.0, options->longest);

    return approach > 0.0 ? sqrt(2.0 * options->speed_tolerance / approach) / w0 : options->longest;
}

static double noise_acceleration(const gear_model *model) {
    return model->torque_to_offset * noise_overshoot * model->load.amplitude;
}

static flight flight_from(const gear_model *model, double time, const double state[],
                          double horizon, long *evaluations) {
    flight free = {
        .model = model,
        .start = model_motion(model, time, state),
        .noise_acceleration = noise_acceleration(model),
    };

    free.force_free = model_without_contact(model, time, &free.start, horizon);
    free.evaluations = evaluations;
    return free;
}

int flight_noise_guides(const gear_model *model, const flight_options *options) {
    return noise_acceleration(model) * options->longest > guiding_noise * options->speed_tolerance;
}

double flight_light_step(const gear_model *model, double time, const double state[],
                         const flight_options *options) {
    const flight free = flight_from(model, time, state, options->longest, NULL);
    const double shortest = shortest_touch(&free, options);
    const double while_it_widens = widening * pi / model->natural_frequency;

    return fmin(cbrt(while_it_widens * shortest * shortest), options->longest);
}

double flight_clear_time(const gear_model *model, double time, const double state[],
                         const flight_options *options, long *evaluations) {
    const flight free = flight_from(model, time, state, options->longest, evaluations);
    const double shortest = fmin(shortest_touch(&free, options), options->longest);
    double clear = 0.0, piece = options->longest;

    /* Piece by piece: twice as long after one that is clear, half as long after one that is not. */
    for (int i = 0; i < PIECES_MAX && clear < options->longest; ++i) {
        const double to = fmin(clear + piece, options->longest);

        if (stays_clear(&free, clear, to)) {
            clear = to;
            piece *= 2.0;
        } else if (piece > shortest) {
            piece *= 0.5;
        } else {
            break;
        }
    }
    return fmax(clear, shortest);
}
