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
enum { HALF_WIDTH_ROWS = 15 }; /* a multiple of 3 */
static const double kaiser_beta = 9.1;

struct decimator {
    int channels;
    int half;                /* samples on each side of the middle */
    int length;              /* 2 half + 1 */
    int next;                /* place of the next sample */
    int started;             /* the first sample fills the past */
    enum sample_kind *kinds; /* [channels] */
    double *weights;         /* [SAMPLE_KINDS - 1][length], from SAMPLE_VALUES on */

    /* [channels][2 length]: a ring written twice, so that the last `length` samples are always
     * contiguous, from `next` on */
    double *samples;
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
 * Weight i of the ideal low-pass at half the row's rate over the gain of the mean: its inverse transform, the integral
 * of cos(2 pi f i) / gain(f) from -1/(2 factor) to 1/(2 factor), by Simpson's rule. At most 7.5 periods of the
 * cosine fall into half of it: 256 intervals leave an error of 1e-7.
 */
static double ideal_weight(enum sample_kind kind, const double gains[], int i, int factor) {
    const double step = 0.5 / factor / INTERVALS;
    double sum = 0.0;

    if (kind == SAMPLE_VALUES) {
        return sinc((double)i / factor);
    }
    for (int k = 0; k <= INTERVALS; ++k) {
        const double f = k * step;
        const double share = k == 0 || k == INTERVALS ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
        sum += share * cos(2.0 * pi * f * i) / gains[k];
    }
    return 2.0 * factor * sum * step / 3.0;
}

/* The ideal low-pass under a Kaiser window, scaled to the sum 1. */
static void design(double weights[], enum sample_kind kind, int half, int factor) {
    double gains[INTERVALS + 1];
    double sum = 0.0;

    /* The gains are the same for every weight. */
    for (int k = 0; k <= INTERVALS; ++k) {
        gains[k] = gain_of_mean(kind, k * (0.5 / factor / INTERVALS));
    }

    for (int i = 0; i <= half; ++i) {
        const double reach = half > 0 ? (double)i / (half + 1) : 0.0;
        const double window = bessel_i0(kaiser_beta * sqrt(1.0 - reach * reach));

        weights[half + i] = weights[half - i] = window * ideal_weight(kind, gains, i, factor);
        sum += (i > 0 ? 2.0 : 1.0) * weights[half + i];
    }
    for (int i = 0; i <= 2 * half; ++i) {
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
    created->samples = malloc(count * 2 * (size_t)created->length * sizeof *created->samples);
    if (created->kinds == NULL || created->weights == NULL || created->samples == NULL) {
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
        free(filter);
    }
}

int decimator_delay(const decimator *filter) {
    return filter->half;
}

const double *decimator_weights(const decimator *filter, enum sample_kind kind) {
    return weights_of(filter, kind);
}

static void hold(decimator *filter, const double values[]) {
    const int size = 2 * filter->length;

    for (int channel = 0; channel < filter->channels; ++channel) {
        double *ring = filter->samples + (size_t)channel * (size_t)size;
        for (int i = 0; i < size; ++i) {
            ring[i] = values[channel];
        }
    }
    filter->started = 1;
}

void decimator_push(decimator *filter, const double values[]) {
    const size_t length = (size_t)filter->length;
    double *place = filter->samples + filter->next;

    if (!filter->started) {
        hold(filter, values);
    }
    for (int channel = 0; channel < filter->channels; ++channel) {
        place[0] = values[channel];
        place[length] = values[channel];
        place += 2 * length;
    }
    filter->next = filter->next + 1 < filter->length ? filter->next + 1 : 0;
}

/*
 * The weights are symmetric: the samples at equal distances from the middle share one. Three sums side by side, so that none
 * waits for the other; `half` is a multiple of three.
 */
static double weighted_sum(const double *samples, const double *weights, int half) {
    const double *last = samples + 2 * half;
    double first = 0.0, second = 0.0, third = 0.0;

    for (int i = 0; i < half; i += 3) {
        first += weights[i] * (samples[i] + last[-i]);
        second += weights[i + 1] * (samples[i + 1] + last[-i - 1]);
        third += weights[i + 2] * (samples[i + 2] + last[-i - 2]);
    }
    return first + second + third + weights[half] * samples[half];
}

void decimator_values(const decimator *filter, double values[]) {
    const double *samples = filter->samples + filter->next;

    for (int channel = 0; channel < filter->channels; ++channel) {
        const enum sample_kind kind = filter->kinds[channel];

        values[channel] = kind != SAMPLE_PLAIN
                              ? weighted_sum(samples, weights_of(filter, kind), filter->half)
                              : samples[filter->half];
        samples += 2 * (size_t)filter->length;
    }
}
