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
    const load_signal created = {mean, amplitude, interval, mix(seed + golden_step)};

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

/* Through p1 at s = 0 and p2 at s = 1, with the slopes of the chords p0 p2 and p1 p3. */
static double catmull_rom(double p0, double p1, double p2, double p3, double s) {
    const double slope = p2 - p0;
    const double square = 2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3;
    const double cube = 3.0 * (p1 - p2) + p3 - p0;

    return p1 + 0.5 * s * (slope + s * (square + s * cube));
}

double load_torque(const load_signal *load, double time) {
    const double position = time / load->interval;

    /* Beyond 2^52 intervals (1400 years of 1e-5 s) a double cannot tell one value from the next. */
    if (load->amplitude == 0.0 || !(fabs(position) < 0x1p52)) {
        return load->mean;
    }

    /* Conversion truncates towards zero, which is upwards before t = 0. */
    const int64_t truncated = (int64_t)position;
    const int64_t interval = truncated - (position < (double)truncated);
    const uint64_t place = (uint64_t)interval;
    const double noise =
        catmull_rom(value_of_place(load->stream, place - 1), value_of_place(load->stream, place),
                    value_of_place(load->stream, place + 1),
                    value_of_place(load->stream, place + 2), position - (double)interval);

    return load->mean + load->amplitude * noise;
}
