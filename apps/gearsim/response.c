/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "response.h"

#include <math.h>
#include <stdlib.h>

/* Segments that are kept; a solver looks back by a step or two. */
enum { KEPT = 512 };

/*
 * From one noise value to the next p is a power series, cut off where all that follows is below this part of the noise's
 * static response. An interval is parted into segments of no more than so much of the frequency (rad), so that few terms
 * are enough.
 */
static const double longest_segment = 0.5;
static const double left_out = 1e-15;
enum { TERMS = 20 };

/* Below, there are as many segments as steps of a solver that follows the noise itself. */
static const double shortest_interval = 1e-2; /* rad of the frequency */

/* Over the share of a segment, from the power 0 up; an even number of terms. */
typedef struct segment {
    double offset[TERMS];  /* p */
    double rate[TERMS];    /* p' */
    double carried[TERMS]; /* what has been carried, see response_carried() */
} segment;

struct response {
    load_signal load;
    int parts;                 /* segments in an interval of the noise */
    double length, per_length; /* of a segment (s, 1/s) */
    int terms;
    double by_noise[4], by_offset[TERMS],
        by_rate[TERMS];        /* what makes a power from those below it */
    double to_rate[TERMS];     /* from p to p' (1/s) */
    double decay;              /* 2 zeta w0: what is carried by p, */
    double by_integral[TERMS]; /* and by the integral of the power before (1/s) */
    int64_t next;              /* first segment that has not been computed, */
    int64_t interval;          /* the noise's interval that it lies in, */
    int part;                  /* which of its parts it is, */
    double noise[4];           /* and the noise there, over the share of the interval */
    response_value start;      /* p and p' at its start */
    double start_carried;      /* likewise */
    segment kept[KEPT];        /* segment k at k mod KEPT */
};

int response_is_useful(const load_signal *load, double frequency) {
    return load->amplitude > 0.0 && frequency * load->interval >= shortest_interval;
}

static void restart(response *linear) {
    linear->next = 0;
    linear->interval = -1;
    linear->part = linear->parts - 1;
    linear->start = (response_value){0.0, 0.0};
    linear->start_carried = 0.0;
}

/*
 * The noise is a cubic whose last coefficient is up to 4 times the amplitude: that makes the term of degree 5, in parts of
 * the noise's static response, 4 / 20 x^2 for a segment of x rad, and those behind it become smaller by x / n.
 */
static int terms_for(double x) {
    double term = 0.2 * x * x;
    int n = 5;

    while (term > left_out && n < TERMS) {
        term *= x / ++n;
    }
    return n + n % 2;
}

/* Of the equation over the share of a segment, with h^2 p'' = sum of (k + 2) (k + 1) p[k + 2] share^k. */
static void set_recurrence(response *linear, double gain, double frequency, double damping_ratio) {
    const double x = frequency * linear->length;

    linear->terms = terms_for(x);
    for (int k = 0; k + 2 < TERMS; ++k) {
        const double both = (double)((k + 1) * (k + 2));
        linear->by_offset[k] = x * x / both;
        linear->by_rate[k] = 2.0 * damping_ratio * x / (double)(k + 2);
        if (k < 4) {
            linear->by_noise[k] = gain * linear->length * linear->length / both;
        }
    }

    linear->decay = 2.0 * damping_ratio * frequency;
    for (int k = 1; k < TERMS; ++k) {
        linear->to_rate[k] = (double)k / linear->length;
        linear->by_integral[k] = frequency * x / (double)k;
    }
}

response *response_create(const load_signal *load, double gain, double frequency,
                          double damping_ratio) {
    response *created = malloc(sizeof *created);

    if (created != NULL) {
        created->load = *load;
        created->parts = (int)ceil(frequency * load->interval / longest_segment);
        created->length = load->interval / (double)created->parts;
        created->per_length = 1.0 / created->length;
        set_recurrence(created, gain, frequency, damping_ratio);
        restart(created);
    }
    return created;
}

void response_free(response *linear) {
    free(linear);
}

/* The noise over the share of the next segment: the cubic of its interval from where the segment begins. */
static void next_noise(response *linear, double noise[4]) {
    if (++linear->part == linear->parts) {
        linear->part = 0;
        load_noise_cubic(&linear->load, ++linear->interval, linear->noise);
    }

    const double share = 1.0 / (double)linear->parts;
    const double from = (double)linear->part * share;
    const double *c = linear->noise;
    noise[0] = c[0] + from * (c[1] + from * (c[2] + from * c[3]));
    noise[1] = share * (c[1] + from * (2.0 * c[2] + from * 3.0 * c[3]));
    noise[2] = share * share * (c[2] + 3.0 * from * c[3]);
    noise[3] = share * share * share * c[3];
}

/* A polynomial by its even and its odd powers, so that neither waits for the other. */
static double evaluate(const double coefficients[], int terms, double share) {
    const double square = share * share;
    double even = 0.0, odd = 0.0;

    for (int k = terms - 2; k >= 0; k -= 2) {
        even = coefficients[k] + square * even;
        odd = coefficients[k + 1] + square * odd;
    }
    return even + share * odd;
}

/* Computes one more segment, from where the one before has ended. */
static void extend(response *linear) {
    segment *added = &linear->kept[(uint64_t)linear->next % KEPT];
    const int terms = linear->terms;
    double *p = added->offset;
    double noise[4];

    /* Each power from the two below it. */
    next_noise(linear, noise);
    p[0] = linear->start.offset;
    p[1] = linear->start.rate * linear->length;
    for (int k = 0; k < 4; ++k) {
        p[k + 2] = linear->by_noise[k] * noise[k] - linear->by_offset[k] * p[k] -
                   linear->by_rate[k] * p[k + 1];
    }
    for (int k = 4; k + 2 < terms; ++k) {
        p[k + 2] = -linear->by_offset[k] * p[k] - linear->by_rate[k] * p[k + 1];
    }

    /* What follows from p: its derivative, and what is carried with its integral. */
    for (int k = 1; k < terms; ++k) {
        added->rate[k - 1] = linear->to_rate[k] * p[k];
        added->carried[k] = linear->decay * p[k] + linear->by_integral[k] * p[k - 1];
    }
    added->rate[terms - 1] = 0.0;
    added->carried[0] = linear->start_carried;

    linear->start.offset = evaluate(p, terms, 1.0);
    linear->start.rate = evaluate(added->rate, terms, 1.0);
    linear->start_carried = evaluate(added->carried, terms, 1.0);
    ++linear->next;
}

/* The segment that a time is in, and the share of it before the time. */
static const segment *segment_at(response *linear, double time, double *share) {
    const double position = time > 0.0 ? time * linear->per_length : 0.0;
    const int64_t k = (int64_t)position;

    if (k < linear->next - KEPT) {
        restart(linear);
    }
    while (k >= linear->next) {
        extend(linear);
    }
    *share = position - (double)k;
    return &linear->kept[(uint64_t)k % KEPT];
}

response_value response_at(response *linear, double time) {
    double share;
    const segment *part = segment_at(linear, time, &share);

    return (response_value){.offset = evaluate(part->offset, linear->terms, share),
                            .rate = evaluate(part->rate, linear->terms, share)};
}

/* Whether a time is in the segment of the one before, which begins at a whole number of segments; its share there. */
static int is_within(const response *linear, double time, double begin, double *share) {
    *share = time * linear->per_length - begin;
    return *share >= 0.0 && *share < 1.0;
}

void response_carried(response *linear, int count, const double times[], double carried[],
                      response_value values[]) {
    const int terms = linear->terms;
    const segment *part = NULL;
    double begin = -1.0, share;

    for (int i = 0; i < count; ++i) {
        if (begin < 0.0 || !is_within(linear, times[i], begin, &share)) {
            part = segment_at(linear, times[i], &share);
            begin = (double)(int64_t)(times[i] > 0.0 ? times[i] * linear->per_length : 0.0);
        }
        carried[i] = evaluate(part->carried, terms, share);
        if (values != NULL) {
            values[i].offset = evaluate(part->offset, terms, share);
            values[i].rate = evaluate(part->rate, terms, share);
        }
    }
}
