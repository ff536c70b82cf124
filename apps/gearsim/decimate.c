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

/* Vectors of four doubles, which most x86-64 processors have beyond those of two that all of them have. */
#if defined(__GNUC__) && defined(__x86_64__) && !defined(_WIN32) && !defined(__AVX2__) &&          \
    !defined(GEARMESH_WITHOUT_AVX2)
#define HAS_WIDE 1
#define INLINED  inline __attribute__((always_inline)) /* compiled for what it is called from */
#else
#define HAS_WIDE 0
#define INLINED  inline
#endif

/* A strip is so many times as long as the filter. The longer, the fewer of its samples are moved to where it begins. */
enum { STRIP_LENGTHS = 3 };

struct decimator {
    int channels;
    int half;                /* samples on each side of the middle */
    int length;              /* 2 half + 1 */
    int strip;               /* STRIP_LENGTHS length */
    int next;                /* place of the next sample, `length` or more */
    int started;             /* the first sample fills the past */
    int is_wide;             /* the processor has vectors of four */
    enum sample_kind *kinds; /* [channels] */
    double *weights;         /* [SAMPLE_KINDS - 1][length], from SAMPLE_VALUES on */

    /* [channels][2 strip]: a strip with the last `length` samples before `next`; and one from the newest to the oldest, in
     * which they begin at strip - `next`. Of plain channels the first one alone. */
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
    created->strip = STRIP_LENGTHS * created->length;
    created->next = created->length;
#if HAS_WIDE
    created->is_wide = __builtin_cpu_supports("avx2") != 0;
#endif

    /* What grows with the channels and the length. */
    created->kinds = malloc(count * sizeof *created->kinds);
    created->weights =
        malloc((SAMPLE_KINDS - 1) * (size_t)created->length * sizeof *created->weights);
    created->samples = malloc(count * 2 * (size_t)created->strip * sizeof *created->samples);
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

/* The strips of a channel. */
static double *strips_of(const decimator *filter, int channel) {
    return filter->samples + (size_t)channel * 2 * (size_t)filter->strip;
}

static void hold(decimator *filter, const double values[], int stride) {
    for (int channel = 0; channel < filter->channels; ++channel) {
        double *strip = strips_of(filter, channel);
        for (int i = 0; i < 2 * filter->strip; ++i) {
            strip[i] = values[channel * stride];
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

/* Both strips are full: what the filter still needs moves to where they begin. */
static void begin_again(decimator *filter) {
    const size_t kept = (size_t)filter->length, size = kept * sizeof *filter->samples;

    for (int channel = 0; channel < filter->channels; ++channel) {
        double *end = strips_of(filter, channel) + filter->strip;
        memcpy(end - filter->strip, end - kept, size);
        if (filter->kinds[channel] != SAMPLE_PLAIN) {
            memcpy(end + filter->strip - kept, end, size);
        }
    }
    filter->next = filter->length;
}

/* Into the strip of a plain channel; a few without a call. */
static void put_plain(double *place, int count, const double values[]) {
    if (count > 8) {
        memcpy(place, values, (size_t)count * sizeof *values);
        return;
    }
    for (int n = 0; n < count; ++n) {
        place[n] = values[n];
    }
}

/* Into both strips of a channel. */
static void put(double *strip, int length, int place, int count, const double values[]) {
    double *forward = strip + place, *backward = strip + 2 * length - 1 - place;
    int n = 0;

    /* Four at a time: with the usual oversampling those of a row. */
    for (; n + 4 <= count; n += 4) {
        const double four[4] = {values[n], values[n + 1], values[n + 2], values[n + 3]};
        forward[n] = four[0];
        forward[n + 1] = four[1];
        forward[n + 2] = four[2];
        forward[n + 3] = four[3];
        backward[-n] = four[0];
        backward[-n - 1] = four[1];
        backward[-n - 2] = four[2];
        backward[-n - 3] = four[3];
    }
    for (; n < count; ++n) {
        forward[n] = backward[-n] = values[n];
    }
}

void decimator_push_all(decimator *filter, int count, const double values[], int stride) {
    if (!filter->started) {
        hold(filter, values, stride);
    }
    for (int done = 0; done < count;) {
        const int rest = filter->strip - filter->next;
        const int some = count - done < rest ? count - done : rest;

        for (int channel = 0; channel < filter->channels; ++channel) {
            double *strip = strips_of(filter, channel);
            const double *value = values + channel * stride + done;

            if (filter->kinds[channel] == SAMPLE_PLAIN) {
                put_plain(strip + filter->next, some, value);
            } else {
                put(strip, filter->strip, filter->next, some, value);
            }
        }
        filter->next += some;
        done += some;
        if (filter->next == filter->strip) {
            begin_again(filter);
        }
    }
}

static INLINED void add_four(const double samples[4], const double mates[4],
                             const double weights[4], double first[2], double second[2]) {
    first[0] += weights[0] * (samples[0] + mates[0]);
    first[1] += weights[1] * (samples[1] + mates[1]);
    second[0] += weights[2] * (samples[2] + mates[2]);
    second[1] += weights[3] * (samples[3] + mates[3]);
}

/*
 * The weights are symmetric: the samples at equal distances from the middle share one. Each is with its mate from the other
 * end, and what is at one place of all three fills a register of two or four; several sums, so that none waits for the other.
 */
static INLINED double weighted_sum(const double *samples, const double *mates,
                                   const double *weights, int half, double middle, double sums[4]) {
    double first[2] = {0.0, 0.0}, second[2] = {0.0, 0.0};
    int i = 0;

    for (; i + 8 <= half; i += 8) {
        add_four(samples + i, mates + i, weights + i, first, second);
        add_four(samples + i + 4, mates + i + 4, weights + i + 4, first, second);
    }
    if (i + 4 <= half) {
        add_four(samples + i, mates + i, weights + i, first, second);
        i += 4;
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

static INLINED void take_values(const decimator *filter, double values[]) {
    const int half = filter->half;

    for (int channel = 0; channel < filter->channels; ++channel) {
        const enum sample_kind kind = filter->kinds[channel];
        const double *strip = strips_of(filter, channel);
        const double *samples = strip + filter->next - filter->length;

        if (kind == SAMPLE_PLAIN) {
            values[channel] = samples[half];
        } else {
            /* An even number has no middle, and leaves the newest sample out. */
            const int is_even = kind == SAMPLE_BEHIND;
            const double *weights = weights_of(filter, kind);
            const double *mates = strip + 2 * filter->strip - filter->next + is_even;
            values[channel] = weighted_sum(samples, mates, weights, half,
                                           is_even ? 0.0 : weights[half], filter->sums);
        }
    }
}

/* The same operations in the same order, four of them at a time. */
#if HAS_WIDE
__attribute__((target("avx2"))) static void take_values_wide(const decimator *filter,
                                                             double values[]) {
    take_values(filter, values);
}
#endif

void decimator_values(const decimator *filter, double values[]) {
#if HAS_WIDE
    if (filter->is_wide) {
        take_values_wide(filter, values);
        return;
    }
#endif
    take_values(filter, values);
}
