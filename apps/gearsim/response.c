/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "response.h"

#include <math.h>
#include <stdlib.h>

/* Solutions between two noise values that are kept; a solver looks back by a step or two. */
enum { KEPT = 512 };

/*
 * Places within an interval at which the free vibration is kept; from there on it goes by its series, so many rad at
 * most: the terms left out are below 3e-16.
 */
enum { NODES = 128 };
static const double longest_series = 0.125;

/* Below, the terms of the closed form are more than 1e7 times as large as their sum - 12 zeta over the
 * cube of this - and p is worse than 1e-15 m. */
static const double shortest_interval = 1e-2; /* rad of the frequency */

/* p = polynomial + exp(-decay s) (cosine cos(wd s) + sine sin(wd s)), s = time since its start. */
typedef struct segment {
    double polynomial[4];
    double cosine, sine;
} segment;

struct response {
    load_signal load;
    double gain;
    double square; /* w0^2 */
    double decay;  /* zeta w0 */
    double damped; /* wd = w0 sqrt(1 - zeta^2) */
    int nodes;     /* spacings of the places below, 0: there would be too many of them */
    double spacing, per_spacing;               /* s, 1/s */
    double cosine[NODES + 1], sine[NODES + 1]; /* exp(-decay s) cos(wd s) and sin(wd s) there */
    int64_t next;                              /* first segment that has not been computed */
    response_value start;                      /* p and p' at its start */
    segment kept[KEPT];                        /* segment k at k mod KEPT */
};

int response_is_useful(const load_signal *load, double frequency) {
    return load->amplitude > 0.0 && frequency * load->interval >= shortest_interval;
}

static void restart(response *linear) {
    linear->next = 0;
    linear->start = (response_value){0.0, 0.0};
}

/* exp(-decay s) cos(wd s) and sin(wd s). */
typedef struct turn {
    double cosine, sine;
} turn;

/* Coefficients of exp(x), cos(y) and sin(y) / y over x and y^2. */
static const double of_exp[] = {1.0,         1.0,         1.0 / 2.0,    1.0 / 6.0,    1.0 / 24.0,
                                1.0 / 120.0, 1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40320.0};
static const double of_cos[] = {1.0, -1.0 / 2.0, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40320.0};
static const double of_sin[] = {1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362880.0};
enum { EXP_TERMS = 9, TURN_TERMS = 5 };

static inline double series(const double coefficients[], int terms, double x) {
    double sum = coefficients[terms - 1];

    for (int k = terms - 2; k >= 0; --k) {
        sum = coefficients[k] + x * sum;
    }
    return sum;
}

static turn turn_by_series(const response *linear, double s) {
    const int k = s > 0.0 ? (int)(s * linear->per_spacing) : 0;
    const double r = s - (double)k * linear->spacing;
    const double y = linear->damped * r;
    const double envelope = series(of_exp, EXP_TERMS, -linear->decay * r);
    const double c = envelope * series(of_cos, TURN_TERMS, y * y);
    const double d = envelope * y * series(of_sin, TURN_TERMS, y * y);

    /* On from the node. */
    const turn at = {linear->cosine[k] * c - linear->sine[k] * d,
                     linear->sine[k] * c + linear->cosine[k] * d};
    return at;
}

static turn turn_at(const response *linear, double s) {
    if (linear->nodes > 0) {
        return turn_by_series(linear, s);
    }
    const double envelope = exp(-linear->decay * s);
    const turn at = {envelope * cos(linear->damped * s), envelope * sin(linear->damped * s)};
    return at;
}

static void set_nodes(response *linear, double frequency) {
    const double needed = ceil(frequency * linear->load.interval / longest_series);

    linear->nodes = 0;
    if (!(needed <= NODES)) {
        return;
    }
    linear->spacing = linear->load.interval / needed;
    linear->per_spacing = 1.0 / linear->spacing;
    for (int k = 0; k <= (int)needed; ++k) {
        const turn at = turn_at(linear, k * linear->spacing);
        linear->cosine[k] = at.cosine;
        linear->sine[k] = at.sine;
    }
    linear->nodes = (int)needed;
}

response *response_create(const load_signal *load, double gain, double frequency,
                          double damping_ratio) {
    response *created = malloc(sizeof *created);

    if (created != NULL) {
        created->load = *load;
        created->gain = gain;
        created->square = frequency * frequency;
        created->decay = damping_ratio * frequency;
        created->damped = frequency * sqrt(1.0 - damping_ratio * damping_ratio);
        set_nodes(created, frequency);
        restart(created);
    }
    return created;
}

void response_free(response *linear) {
    free(linear);
}

/* Polynomial that solves the equation for the noise of segment k: power by power from the highest. */
static void particular_solution(const response *linear, int64_t k, double q[4]) {
    const double h = linear->load.interval;
    const double two_decay = 2.0 * linear->decay;
    const double scale = linear->gain / linear->square;
    double noise[4]; /* over s / h */

    load_noise_cubic(&linear->load, k, noise);

    q[3] = scale * noise[3] / (h * h * h);
    q[2] = scale * noise[2] / (h * h) - 3.0 * two_decay * q[3] / linear->square;
    q[1] = scale * noise[1] / h - (2.0 * two_decay * q[2] + 6.0 * q[3]) / linear->square;
    q[0] = scale * noise[0] - (two_decay * q[1] + 2.0 * q[2]) / linear->square;
}

static response_value evaluate(const response *linear, const segment *part, double s) {
    const double *q = part->polynomial;
    const turn free_turn = turn_at(linear, s);
    const double rate_cosine = linear->damped * part->sine - linear->decay * part->cosine;
    const double rate_sine = -linear->damped * part->cosine - linear->decay * part->sine;

    const response_value value = {
        .offset = q[0] + s * (q[1] + s * (q[2] + s * q[3])) + part->cosine * free_turn.cosine +
                  part->sine * free_turn.sine,
        .rate = q[1] + s * (2.0 * q[2] + s * 3.0 * q[3]) + rate_cosine * free_turn.cosine +
                rate_sine * free_turn.sine,
    };
    return value;
}

/* Computes one more segment: its free vibration makes p and p' continuous. */
static void extend(response *linear) {
    segment *part = &linear->kept[linear->next % KEPT];

    particular_solution(linear, linear->next, part->polynomial);
    part->cosine = linear->start.offset - part->polynomial[0];
    part->sine =
        (linear->start.rate - part->polynomial[1] + linear->decay * part->cosine) / linear->damped;

    linear->start = evaluate(linear, part, linear->load.interval);
    ++linear->next;
}

response_value response_at(response *linear, double time) {
    const double interval = linear->load.interval;
    const int64_t k = time > 0.0 ? (int64_t)(time / interval) : 0;

    if (k < linear->next - KEPT) {
        restart(linear);
    }
    while (k >= linear->next) {
        extend(linear);
    }
    return evaluate(linear, &linear->kept[k % KEPT], time - (double)k * interval);
}
