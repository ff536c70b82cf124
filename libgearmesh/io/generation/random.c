/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "random.h"

#include <math.h>

#include "shared.h"

/* splitmix64 (Steele, Lea, Flood 2014). */
uint64_t gmi_random_bits(gmi_random *from) {
    from->state += UINT64_C(0x9E3779B97F4A7C15);
    uint64_t bits = from->state;
    bits = (bits ^ (bits >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    bits = (bits ^ (bits >> 27)) * UINT64_C(0x94D049BB133111EB);
    return bits ^ (bits >> 31);
}

double gmi_random_uniform(gmi_random *from, double low, double high) {
    const double unit = (double)(gmi_random_bits(from) >> 11) * (1.0 / 9007199254740992.0);
    return low + (high - low) * unit;
}

double gmi_random_normal(gmi_random *from, double mean, double deviation) {
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += gmi_random_uniform(from, 0.0, 1.0);
    }
    return mean + deviation * sum;
}

double gmi_sine_of_turns(double turns) {
    double part = turns - floor(turns + 0.5);
    if (part > 0.25) {
        part = 0.5 - part;
    } else if (part < -0.25) {
        part = -0.5 - part;
    }
    const double angle = 2.0 * GMI_PI * part;
    const double square = angle * angle;
    /* The series up to the power 21; the next term is below 1e-18 at GMI_PI / 2. */
    double sum = 0.0;
    for (int power = 21; power >= 3; power -= 2) {
        sum = -(square / ((double)power * (power - 1))) * (1.0 + sum);
    }
    return angle * (1.0 + sum);
}

double gmi_rounded(double value) {
    return floor(value * 1e10 + 0.5) / 1e10;
}
