/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "random.h"

#include <math.h>

#include "shared.h"

double gmi_random_uniform(uint64_t *state, double low, double high) {
    return low + (high - low) * gmi_random_unit(state);
}

double gmi_random_normal(uint64_t *state, double mean, double deviation) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) {
        sum += gmi_random_unit(state);
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
