/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "load.h"

#include <math.h>

/* 2^64 / golden ratio, odd: steps by it visit every 64-bit number and are far apart. */
static const uint64_t golden_step = 0x9e3779b97f4a7c15u;

/* The finaliser of splitmix64 (Steele, Lea, Flood 2014): a bijection that changes about half of the
 * bits of its result for every bit of its argument. */
static uint64_t mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

load_signal load_create(double mean, double amplitude, double interval, uint64_t seed) {
    /* Mixed once more, so that neighbouring seeds do not give the same values some places apart. */
    const load_signal created = {.mean = mean,
                                 .amplitude = amplitude,
                                 .interval = interval,
                                 .per_interval = 1.0 / interval,
                                 .stream = mix(seed + golden_step)};

    return created;
}

/* 52 bits and a half: exact in a double, symmetric about zero, never +-1. */
static double value_of_place(uint64_t stream, uint64_t place) {
    const uint64_t bits = mix(stream + golden_step * place) >> 12;

    return ((double)bits + 0.5) * 0x1p-51 - 1.0;
}

double load_noise_value(const load_signal *load, int64_t k) {
    return value_of_place(load->stream, (uint64_t)k);
}

/* Catmull-Rom: through p1 at s = 0 and p2 at s = 1, with the slopes of the chords p0 p2 and p1 p3. */
static void set_cubic(double amplitude, const double p[4], double coefficients[4]) {
    const double half = 0.5 * amplitude;

    coefficients[0] = amplitude * p[1];
    coefficients[1] = half * (p[2] - p[0]);
    coefficients[2] = half * (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3]);
    coefficients[3] = half * (3.0 * (p[1] - p[2]) + p[3] - p[0]);
}

static void set_values(const load_signal *load, int64_t k, double p[4]) {
    for (int n = 0; n < 4; ++n) {
        p[n] = value_of_place(load->stream, (uint64_t)k + (uint64_t)n - 1);
    }
}

void load_noise_cubic(const load_signal *load, int64_t k, double coefficients[4]) {
    double p[4];

    set_values(load, k, p);
    set_cubic(load->amplitude, p, coefficients);
}

void load_noise_next(const load_signal *load, int64_t k, noise_values *kept,
                     double coefficients[4]) {
    double *p = kept->value;

    if (kept->is_known && k == kept->k + 1) {
        p[0] = p[1];
        p[1] = p[2];
        p[2] = p[3];
        p[3] = value_of_place(load->stream, (uint64_t)k + 2);
    } else {
        set_values(load, k, p);
    }
    kept->is_known = 1;
    kept->k = k;
    set_cubic(load->amplitude, p, coefficients);
}

double load_with_noise(const load_signal *load, double torque, double time) {
    const double position = time / load->interval;

    /* Beyond 2^52 intervals (1400 years of 1e-5 s) a double cannot tell one value from the next. */
    if (load->amplitude == 0.0 || !(fabs(position) < 0x1p52)) {
        return torque;
    }

    /* Conversion truncates towards zero, which is upwards before t = 0. */
    const int64_t truncated = (int64_t)position;
    const int64_t k = truncated - (position < (double)truncated);
    const double s = position - (double)k;
    double c[4];

    load_noise_cubic(load, k, c);
    return torque + c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

double load_steady(const load_signal *load, double time) {
    return load->table != NULL ? time_table_value(load->table, time) : load->mean;
}

double load_torque(const load_signal *load, double time) {
    return load_with_noise(load, load_steady(load, time), time);
}

double load_at_speed(const load_signal *load, double wheel_speed) {
    return wheel_speed * (load->per_speed + load->per_speed_squared * fabs(wheel_speed));
}

double load_by_speed(const load_signal *load, double wheel_speed) {
    return load->per_speed + 2.0 * load->per_speed_squared * fabs(wheel_speed);
}

/* Integral of weight times cubic over the part [from, to] of a piece, in its own s; the weight is w[0] + w[1] s. */
static double piece_integral(const double c[4], const double w[2], double from, double to) {
    const double d[5] = {w[0] * c[0], (w[0] * c[1] + w[1] * c[0]) * (1.0 / 2.0),
                         (w[0] * c[2] + w[1] * c[1]) * (1.0 / 3.0),
                         (w[0] * c[3] + w[1] * c[2]) * (1.0 / 4.0), w[1] * c[3] * (1.0 / 5.0)};
    const double first =
        from * (d[0] + from * (d[1] + from * (d[2] + from * (d[3] + from * d[4]))));
    const double last = to * (d[0] + to * (d[1] + to * (d[2] + to * (d[3] + to * d[4]))));

    return last - first;
}

/* The same of the cubic alone. */
static double unweighted_integral(const double d[4], double from, double to) {
    const double first = from * (d[0] + from * (d[1] + from * (d[2] + from * d[3])));
    const double last = to * (d[0] + to * (d[1] + to * (d[2] + to * d[3])));

    return last - first;
}

static void keep_piece(const load_signal *load, int64_t k, noise_piece *kept) {
    if (kept->values.is_known && kept->values.k == k) {
        return;
    }
    load_noise_next(load, k, &kept->values, kept->coefficients);
    for (int n = 0; n < 4; ++n) {
        kept->integral[n] = kept->coefficients[n] / (n + 1);
    }
}

double load_noise_integral(const load_signal *load, double from, double to, double first_weight,
                           double last_weight, noise_piece *kept) {
    if (load->amplitude == 0.0 || !(to > 0.0) || !(to > from)) {
        return 0.0;
    }

    /* In units of the interval; the weight stays that of the whole line where the part before 0 is left out. */
    const double h = load->interval;
    const double slope =
        last_weight != first_weight ? (last_weight - first_weight) * h / (to - from) : 0.0;
    const double begin = from * load->per_interval;
    const double end = to * load->per_interval;
    double position = begin > 0.0 ? begin : 0.0;
    double sum = 0.0;

    /* Beyond 2^52 intervals there is no noise, see load_torque(). */
    if (!(end < 0x1p52)) {
        return 0.0;
    }
    for (int64_t k = (int64_t)position; position < end; ++k) {
        const double behind = (double)k + 1.0, next = behind < end ? behind : end;

        keep_piece(load, k, kept);
        if (slope == 0.0) {
            sum += first_weight *
                   unweighted_integral(kept->integral, position - (double)k, next - (double)k);
        } else {
            const double weight[2] = {first_weight + slope * ((double)k - begin), slope};
            sum +=
                piece_integral(kept->coefficients, weight, position - (double)k, next - (double)k);
        }
        position = next;
    }
    return h * sum;
}
