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

/* p over the share of a segment. */
typedef struct segment {
    double coefficients[TERMS];
} segment;

struct response {
    load_signal load;
    int64_t parts;             /* segments in an interval of the noise */
    double length, per_length; /* of a segment (s, 1/s) */
    int terms;
    double by_noise[4], by_offset[TERMS],
        by_rate[TERMS];   /* what makes a power from those below it */
    int64_t next;         /* first segment that has not been computed */
    response_value start; /* p and p' at its start */
    segment kept[KEPT];   /* segment k at k mod KEPT */
};

int response_is_useful(const load_signal *load, double frequency) {
    return load->amplitude > 0.0 && frequency * load->interval >= shortest_interval;
}

static void restart(response *linear) {
    linear->next = 0;
    linear->start = (response_value){0.0, 0.0};
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
    return n;
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
}

response *response_create(const load_signal *load, double gain, double frequency,
                          double damping_ratio) {
    response *created = malloc(sizeof *created);

    if (created != NULL) {
        created->load = *load;
        created->parts = (int64_t)ceil(frequency * load->interval / longest_segment);
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

/* The noise over the share of a segment: the cubic of its interval from where the segment begins. */
static void noise_of(const response *linear, int64_t number, double noise[4]) {
    const double share = 1.0 / (double)linear->parts;
    const double from = (double)(number % linear->parts) * share;
    double c[4];

    load_noise_cubic(&linear->load, number / linear->parts, c);
    noise[0] = c[0] + from * (c[1] + from * (c[2] + from * c[3]));
    noise[1] = share * (c[1] + from * (2.0 * c[2] + from * 3.0 * c[3]));
    noise[2] = share * share * (c[2] + 3.0 * from * c[3]);
    noise[3] = share * share * share * c[3];
}

static response_value evaluate(const response *linear, const segment *part, double share) {
    const double *p = part->coefficients;
    double offset = p[linear->terms - 1], rate = 0.0;

    for (int k = linear->terms - 2; k >= 0; --k) {
        rate = offset + share * rate;
        offset = p[k] + share * offset;
    }
    return (response_value){.offset = offset, .rate = rate * linear->per_length};
}

/* Computes one more segment, from where the one before has ended. */
static void extend(response *linear) {
    double *p = linear->kept[linear->next % KEPT].coefficients;
    double noise[4];

    noise_of(linear, linear->next, noise);
    p[0] = linear->start.offset;
    p[1] = linear->start.rate * linear->length;
    for (int k = 0; k + 2 < linear->terms; ++k) {
        p[k + 2] = -linear->by_offset[k] * p[k] - linear->by_rate[k] * p[k + 1];
        if (k < 4) {
            p[k + 2] += linear->by_noise[k] * noise[k];
        }
    }

    linear->start = evaluate(linear, &linear->kept[linear->next % KEPT], 1.0);
    ++linear->next;
}

response_value response_at(response *linear, double time) {
    const double position = time > 0.0 ? time * linear->per_length : 0.0;
    const int64_t k = (int64_t)position;

    if (k < linear->next - KEPT) {
        restart(linear);
    }
    while (k >= linear->next) {
        extend(linear);
    }
    return evaluate(linear, &linear->kept[k % KEPT], position - (double)k);
}
