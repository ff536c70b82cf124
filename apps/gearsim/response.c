/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "response.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Not inlined, see evaluate_motion(). */
#if defined(__GNUC__)
#define APART static __attribute__((noinline))
#else
#define APART static
#endif

/* Segments that are kept; a solver looks back by a step or two. */
enum { KEPT = 512 };

/*
 * From one noise value to the next p is a power series, cut off where all that follows is below this part of the noise's
 * static response. An interval is parted into segments of no more than so much of the frequency (rad), so that few terms
 * are enough.
 */
static const double longest_segment = 0.65;
static const double left_out = 1e-15;
enum { TERMS = 20 };

/* Below, there are as many segments as steps of a solver that follows the noise itself. */
static const double shortest_interval = 1e-2; /* rad of the frequency */

enum { GIVEN = 5 }; /* terms of the integral of a cubic */

/* Over the share of a segment, from the power 0 up; an even number of terms of p. */
typedef struct segment {
    double offset[TERMS]; /* p */
    double rate[TERMS];   /* p' */
    double given[GIVEN];  /* what the noise has given, see response_given() */
} segment;

/* What a segment starts with: p and p' there, and the four coefficients of its noise. */
enum { STARTS = 6 };

struct response {
    load_signal load;
    int parts;                 /* segments in an interval of the noise */
    double length, per_length; /* of a segment (s, 1/s) */
    int terms;
    double by_noise[4], by_offset[TERMS],
        by_rate[TERMS];         /* what makes a power from those below it */
    double to_rate[TERMS];      /* from p to p' (1/s) */
    double to_given[GIVEN - 1]; /* from the noise to what it gives (m/s per N m) */
    double to_end[2][STARTS];   /* p and p' where a segment ends, from what it starts with */
    int64_t next;               /* first segment that has not been computed, */
    int64_t interval;           /* the noise's interval that it lies in, */
    int part;                   /* which of its parts it is, */
    noise_values values;        /* the values about it, */
    double noise[4];            /* and the noise there, over the share of the interval */
    response_value start;       /* p and p' at its start */
    double start_given;         /* likewise */
    segment kept[KEPT];         /* segment k at k mod KEPT */
};

int response_is_useful(const load_signal *load, double frequency) {
    return load->amplitude > 0.0 && frequency * load->interval >= shortest_interval;
}

static void restart(response *linear) {
    linear->next = 0;
    linear->interval = -1;
    linear->part = linear->parts - 1;
    linear->start = (response_value){0.0, 0.0};
    linear->start_given = 0.0;
    linear->values.is_known = 0;
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
        linear->by_offset[k] = -x * x / both;
        linear->by_rate[k] = -2.0 * damping_ratio * x / (double)(k + 2);
        if (k < 4) {
            linear->by_noise[k] = gain * linear->length * linear->length / both;
            linear->to_given[k] = gain * linear->length / (double)(k + 1);
        }
    }

    /* From the powers of p to those of p'. */
    for (int k = 1; k < TERMS; ++k) {
        linear->to_rate[k] = (double)k / linear->length;
    }
}

/* The noise over the share of the next segment: the cubic of its interval from where the segment begins. */
static void next_noise(response *linear, double noise[4]) {
    if (++linear->part == linear->parts) {
        linear->part = 0;
        load_noise_next(&linear->load, ++linear->interval, &linear->values, linear->noise);
    }

    /* Most intervals are one segment. */
    const double *c = linear->noise;
    if (linear->parts == 1) {
        memcpy(noise, c, sizeof linear->noise);
        return;
    }

    const double share = 1.0 / (double)linear->parts;
    const double from = (double)linear->part * share;
    noise[0] = c[0] + from * (c[1] + from * (c[2] + from * c[3]));
    noise[1] = share * (c[1] + from * (2.0 * c[2] + from * 3.0 * c[3]));
    noise[2] = share * share * (c[2] + 3.0 * from * c[3]);
    noise[3] = share * share * share * c[3];
}

/* The powers of p, each from the two below it, and those of its derivative. */
static void set_series(const response *linear, const double start[STARTS], segment *series) {
    const int terms = linear->terms;
    const double *noise = start + 2;
    double *p = series->offset;

    p[0] = start[0];
    p[1] = start[1] * linear->length;
    for (int k = 0; k < 4; ++k) {
        p[k + 2] = linear->by_noise[k] * noise[k] + linear->by_offset[k] * p[k] +
                   linear->by_rate[k] * p[k + 1];
    }
    for (int k = 4; k + 2 < terms; ++k) {
        p[k + 2] = linear->by_offset[k] * p[k] + linear->by_rate[k] * p[k + 1];
    }

    for (int k = 1; k < terms; ++k) {
        series->rate[k - 1] = linear->to_rate[k] * p[k];
    }
    series->rate[terms - 1] = 0.0;
}

static double sum_of(const double coefficients[], int terms) {
    double sum = 0.0;

    for (int k = terms - 1; k >= 0; --k) {
        sum += coefficients[k];
    }
    return sum;
}

/* All is linear: each thing that a segment may start with is followed to the end by itself, once. */
static void set_ends(response *linear) {
    for (int i = 0; i < STARTS; ++i) {
        double start[STARTS] = {0.0};
        segment series;
        start[i] = 1.0;
        set_series(linear, start, &series);
        linear->to_end[0][i] = sum_of(series.offset, linear->terms);
        linear->to_end[1][i] = sum_of(series.rate, linear->terms);
    }
}

static double end_of(const double row[STARTS], const double start[STARTS]) {
    return (row[0] * start[0] + row[1] * start[1]) + (row[2] * start[2] + row[3] * start[3]) +
           (row[4] * start[4] + row[5] * start[5]);
}

static double given_in(const segment *part, double share) {
    const double *given = part->given;

    return given[0] +
           share * (given[1] + share * (given[2] + share * (given[3] + share * given[4])));
}

/* Computes one more segment, from where the one before has ended. */
APART void extend(response *linear) {
    segment *added = &linear->kept[(uint64_t)linear->next % KEPT];
    double start[STARTS] = {linear->start.offset, linear->start.rate};

    next_noise(linear, start + 2);
    set_series(linear, start, added);
    added->given[0] = linear->start_given;
    for (int k = 0; k + 1 < GIVEN; ++k) {
        added->given[k + 1] = linear->to_given[k] * start[2 + k];
    }

    linear->start.offset = end_of(linear->to_end[0], start);
    linear->start.rate = end_of(linear->to_end[1], start);
    linear->start_given = given_in(added, 1.0);
    ++linear->next;
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
        set_ends(created);
        restart(created);
    }
    return created;
}

void response_free(response *linear) {
    free(linear);
}

/*
 * Polynomials by their even and their odd powers, so that neither waits for the other. Both are a vector of two: they end in
 * memory, so that compilers see it. p and p':
 */
APART void evaluate_motion(const segment *part, int terms, double square, double ends[4]) {
    double p[2] = {0.0, 0.0}, rate[2] = {0.0, 0.0};

    for (int k = terms - 2; k >= 0; k -= 2) {
        p[0] = part->offset[k] + square * p[0];
        p[1] = part->offset[k + 1] + square * p[1];
        rate[0] = part->rate[k] + square * rate[0];
        rate[1] = part->rate[k + 1] + square * rate[1];
    }
    ends[0] = p[0];
    ends[1] = p[1];
    ends[2] = rate[0];
    ends[3] = rate[1];
}

/* p' alone. */
APART void evaluate_rate(const segment *part, int terms, double square, double ends[2]) {
    double rate[2] = {0.0, 0.0};

    for (int k = terms - 2; k >= 0; k -= 2) {
        rate[0] = part->rate[k] + square * rate[0];
        rate[1] = part->rate[k + 1] + square * rate[1];
    }
    ends[0] = rate[0];
    ends[1] = rate[1];
}

static response_value motion_in(const segment *part, int terms, double share) {
    double ends[4];

    evaluate_motion(part, terms, share * share, ends);
    return (response_value){.offset = ends[0] + share * ends[1], .rate = ends[2] + share * ends[3]};
}

static double rate_in(const segment *part, int terms, double share) {
    double ends[2];

    evaluate_rate(part, terms, share * share, ends);
    return ends[0] + share * ends[1];
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

    return motion_in(part, linear->terms, share);
}

/*
 * Four places in a segment at once: a polynomial at all of them, side by side for the same reason as above, and once more by
 * its even and its odd powers. Places are numbers of their own: an array that has just been filled would be waited for.
 */
enum { AT_ONCE = 4 };

typedef struct four {
    double at[AT_ONCE];
} four;

static inline void go_on(double sum[AT_ONCE], double coefficient, const double square[AT_ONCE]) {
    sum[0] = coefficient + square[0] * sum[0];
    sum[1] = coefficient + square[1] * sum[1];
    sum[2] = coefficient + square[2] * sum[2];
    sum[3] = coefficient + square[3] * sum[3];
}

APART void evaluate_four(const double coefficients[], int terms, double a, double b, double c,
                         double d, four *values) {
    const double square[AT_ONCE] = {a * a, b * b, c * c, d * d};
    double even[AT_ONCE] = {0.0, 0.0, 0.0, 0.0}, odd[AT_ONCE] = {0.0, 0.0, 0.0, 0.0};

    for (int k = terms - 2; k >= 0; k -= 2) {
        go_on(even, coefficients[k], square);
        go_on(odd, coefficients[k + 1], square);
    }
    values->at[0] = even[0] + a * odd[0];
    values->at[1] = even[1] + b * odd[1];
    values->at[2] = even[2] + c * odd[2];
    values->at[3] = even[3] + d * odd[3];
}

/* Up to four; the last one stands in for those that are missing. */
static void rates_of_some(const segment *part, int terms, int count, const double share[AT_ONCE],
                          response_sum sums[]) {
    const double third = share[count > 2 ? 2 : 1], fourth = share[count - 1];
    four rate;

    evaluate_four(part->rate, terms, share[0], share[1], third, fourth, &rate);
    for (int n = 0; n < count; ++n) {
        sums[n].given = given_in(part, share[n]);
        sums[n].value = (response_value){.rate = rate.at[n]};
    }
}

/* Shares of the times behind the first one, up to four in all, that lie in its segment as well; how many there are. */
static int find_more(const response *linear, int count, const double times[],
                     double share[AT_ONCE]) {
    const double begin = (double)(int64_t)(times[0] > 0.0 ? times[0] * linear->per_length : 0.0);
    int found = 1;

    while (found < AT_ONCE && found < count) {
        share[found] = times[found] * linear->per_length - begin;
        if (!(share[found] >= 0.0 && share[found] < 1.0)) {
            break;
        }
        ++found;
    }
    return found;
}

void response_given(response *linear, int count, const double times[], int with_offset,
                    response_sum sums[]) {
    const int terms = linear->terms;

    for (int i = 0; i < count;) {
        double share[AT_ONCE];
        const segment *part = segment_at(linear, times[i], &share[0]);
        const int found = find_more(linear, count - i, times + i, share);

        if (found > 1 && !with_offset) {
            rates_of_some(part, terms, found, share, sums + i);
            i += found;
            continue;
        }
        for (int n = 0; n < found; ++n, ++i) {
            sums[i].given = given_in(part, share[n]);
            if (with_offset) {
                sums[i].value = motion_in(part, terms, share[n]);
            } else {
                sums[i].value = (response_value){.rate = rate_in(part, terms, share[n])};
            }
        }
    }
}
