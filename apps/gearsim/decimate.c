/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "decimate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/*
 * Kaiser's formulas for 90 dB and a transition of 0.2 of the row's rate: half width
 * (90 - 7.95) / (2 * 2.285 * 2 pi 0.2) = 14.3 rows, beta = 0.1102 (90 - 8.7) = 8.96. A little more of
 * both leaves a margin.
 */
enum { HALF_WIDTH_ROWS = 15 };
static const double kaiser_beta = 9.1;

struct decimator {
    int channels;
    int half;                /* samples on each side of the middle */
    int length;              /* 2 half + 1 */
    int next;                /* place of the next sample */
    int started;             /* the first sample fills the past */
    enum sample_kind *kinds; /* [channels] */
    double *weights;         /* [SAMPLE_KINDS - 1][length], from SAMPLE_VALUES on */

    /* [channels][4 length]: a ring written twice, so that the last `length` samples are always contiguous, from `next` on;
     * and the same from the newest to the oldest, from 3 length - `next` on; of plain channels the first ring alone */
    double *samples;
    double *sums; /* [4]: in memory, so that compilers make vectors of what ends there */
};

/* Modified Bessel function of order 0, by its power series. */
static double bessel_i0(double x) {
    double term = 1.0, sum = 1.0;

    for (int k = 1; term > 1e-17 * sum; ++k) {
        term *= (0.5 * x / k) * (0.5 * x / k);
        sum += term;
    }
    return sum;
}

static double sinc(double x) {
    return x == 0.0 ? 1.0 : sin(pi * x) / (pi * x);
}

/* The gain of a mean at a frequency in terms of the rate of the samples: it is lifted by the filter. */
static double gain_of_mean(enum sample_kind kind, double frequency) {
    const double box = sinc(frequency);

    return kind == SAMPLE_HAT ? box * box : kind == SAMPLE_BOX ? box : 1.0;
}

enum { INTERVALS = 256 }; /* of Simpson's rule */

/*
 * Weight of the ideal low-pass at half the row's rate over the gain of the mean, at a distance in samples: its inverse
 * transform, the integral of cos(2 pi f distance) / gain(f) from -1/(2 factor) to 1/(2 factor), by Simpson's rule. At most
 * 7.5 periods of the cosine fall into half of it: 256 intervals leave an error of 1e-7. From one frequency to the next the
 * cosine turns by the same angle, which takes less than a tenth of its time and is good to 256 roundings.
 */
static double ideal_weight(enum sample_kind kind, const double gains[], double distance,
                           int factor) {
    const double step = 0.5 / factor / INTERVALS;
    const double angle = 2.0 * pi * step * distance;
    const double turn[2] = {cos(angle), sin(angle)};
    double now[2] = {1.0, 0.0};
    double sum = 0.0;

    if (kind == SAMPLE_VALUES || kind == SAMPLE_BEHIND) {
        return sinc(distance / factor);
    }
    for (int k = 0; k <= INTERVALS; ++k) {
        const double share = k == 0 || k == INTERVALS ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
        const double cosine = now[0] * turn[0] - now[1] * turn[1];

        sum += share * now[0] / gains[k];
        now[1] = now[0] * turn[1] + now[1] * turn[0];
        now[0] = cosine;
    }
    return 2.0 * factor * sum * step / 3.0;
}

/* The ideal low-pass under a Kaiser window, scaled to the sum 1. Symmetric, with a weight of 0 behind an even number. */
static void design(double weights[], enum sample_kind kind, int half, int factor) {
    const int is_even = kind == SAMPLE_BEHIND;
    const int last = is_even ? 2 * half - 1 : 2 * half;
    double gains[INTERVALS + 1];
    double sum = 0.0;

    /* The gains are the same for every weight. */
    for (int k = 0; k <= INTERVALS; ++k) {
        gains[k] = gain_of_mean(kind, k * (0.5 / factor / INTERVALS));
    }

    for (int i = half; i <= last; ++i) {
        const double distance = i - half + (is_even ? 0.5 : 0.0);
        const double reach = half > 0 ? distance / (half + (is_even ? 0.5 : 1.0)) : 0.0;
        const double window = bessel_i0(kaiser_beta * sqrt(1.0 - reach * reach));

        weights[i] = weights[last - i] = window * ideal_weight(kind, gains, distance, factor);
        sum += (i != last - i ? 2.0 : 1.0) * weights[i];
    }
    if (is_even) {
        weights[2 * half] = 0.0;
    }
    for (int i = 0; i <= last; ++i) {
        weights[i] /= sum;
    }
}

static double *weights_of(const decimator *filter, enum sample_kind kind) {
    return filter->weights + (size_t)(kind - SAMPLE_VALUES) * (size_t)filter->length;
}

decimator *decimator_create(int factor, int channels, const enum sample_kind kinds[]) {
    decimator *created = calloc(1, sizeof *created);
    if (created == NULL) {
        return NULL;
    }

    const size_t count = (size_t)channels;
    created->channels = channels;
    created->half = factor > 1 ? HALF_WIDTH_ROWS * factor : 0;
    created->length = 2 * created->half + 1;
    created->kinds = malloc(count * sizeof *created->kinds);
    created->weights =
        malloc((SAMPLE_KINDS - 1) * (size_t)created->length * sizeof *created->weights);
    created->samples = malloc(count * 4 * (size_t)created->length * sizeof *created->samples);
    created->sums = malloc(4 * sizeof *created->sums);
    if (created->kinds == NULL || created->weights == NULL || created->samples == NULL ||
        created->sums == NULL) {
        decimator_free(created);
        return NULL;
    }

    memcpy(created->kinds, kinds, count * sizeof *kinds);

    /* Only the filters that a channel takes: each costs a sum of cosines per weight. */
    int is_designed[SAMPLE_KINDS] = {0};
    for (int channel = 0; channel < channels; ++channel) {
        const enum sample_kind kind = kinds[channel];
        if (kind != SAMPLE_PLAIN && !is_designed[kind]) {
            design(weights_of(created, kind), kind, created->half, factor);
            is_designed[kind] = 1;
        }
    }
    return created;
}

void decimator_free(decimator *filter) {
    if (filter != NULL) {
        free(filter->kinds);
        free(filter->weights);
        free(filter->samples);
        free(filter->sums);
        free(filter);
    }
}

int decimator_delay(const decimator *filter) {
    return filter->half;
}

const double *decimator_weights(const decimator *filter, enum sample_kind kind) {
    return weights_of(filter, kind);
}

static void hold(decimator *filter, const double values[], int stride) {
    const int size = 4 * filter->length;

    for (int channel = 0; channel < filter->channels; ++channel) {
        double *ring = filter->samples + (size_t)channel * (size_t)size;
        for (int i = 0; i < size; ++i) {
            ring[i] = values[channel * stride];
        }
    }
    filter->started = 1;
}

void decimator_hold(decimator *filter, const double values[]) {
    hold(filter, values, 1);
}

void decimator_push(decimator *filter, const double values[]) {
    decimator_push_all(filter, 1, values, 1);
}

/* Into the rings of a channel, from a place on that is far enough from their end. */
static void put(double *ring, int length, int place, int count, const double values[]) {
    double *forward = ring + place, *backward = ring + 3 * length - 1 - place;

    for (int n = 0; n < count; ++n) {
        forward[n] = forward[n + length] = values[n];
        backward[-n] = backward[length - n] = values[n];
    }
}

void decimator_push_all(decimator *filter, int count, const double values[], int stride) {
    const int length = filter->length;

    if (!filter->started) {
        hold(filter, values, stride);
    }
    for (int done = 0; done < count;) {
        const int rest = length - filter->next;
        const int some = count - done < rest ? count - done : rest;

        for (int channel = 0; channel < filter->channels; ++channel) {
            double *ring = filter->samples + (size_t)channel * 4 * (size_t)length;
            const double *value = values + channel * stride + done;

            if (filter->kinds[channel] == SAMPLE_PLAIN) {
                memcpy(ring + filter->next, value, (size_t)some * sizeof *value);
            } else {
                put(ring, length, filter->next, some, value);
            }
        }
        filter->next = some < rest ? filter->next + some : 0;
        done += some;
    }
}

/*
 * The weights are symmetric: the samples at equal distances from the middle share one. Each is with its mate from the other
 * end, and what is at one place of all three fills a register of two or four; several sums, so that none waits for the other.
 */
static double weighted_sum(const double *samples, const double *mates, const double *weights,
                           int half, double middle, double sums[4]) {
    double first[2] = {0.0, 0.0}, second[2] = {0.0, 0.0};
    int i = 0;

    for (; i + 4 <= half; i += 4) {
        first[0] += weights[i] * (samples[i] + mates[i]);
        first[1] += weights[i + 1] * (samples[i + 1] + mates[i + 1]);
        second[0] += weights[i + 2] * (samples[i + 2] + mates[i + 2]);
        second[1] += weights[i + 3] * (samples[i + 3] + mates[i + 3]);
    }
    sums[0] = first[0];
    sums[1] = first[1];
    sums[2] = second[0];
    sums[3] = second[1];
    for (; i < half; ++i) {
        sums[0] += weights[i] * (samples[i] + mates[i]);
    }
    return (sums[0] + sums[1]) + (sums[2] + sums[3]) + middle * samples[half];
}

void decimator_values(const decimator *filter, double values[]) {
    const int half = filter->half;
    const size_t length = (size_t)filter->length;
    const double *samples = filter->samples + filter->next;
    const double *mates = filter->samples + 3 * length - filter->next;

    for (int channel = 0; channel < filter->channels; ++channel) {
        const enum sample_kind kind = filter->kinds[channel];

        if (kind == SAMPLE_PLAIN) {
            values[channel] = samples[filter->next < filter->length - half ? half : -half - 1];
        } else {
            /* An even number has no middle, and leaves the newest sample out. */
            const int is_even = kind == SAMPLE_BEHIND;
            const double *weights = weights_of(filter, kind);
            values[channel] = weighted_sum(samples, mates + is_even, weights, half,
                                           is_even ? 0.0 : weights[half], filter->sums);
        }
        samples += 4 * length;
        mates += 4 * length;
    }
}
