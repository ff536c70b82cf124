/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The line contact law where speed does not matter: outside the table, and with all its derivatives. See hertz.h. */
#include "hertz.h"

#include "internal.h"

double gmi_hertz_reciprocal_rare(double eta) {
    if (!(eta >= gmi_hertz_least)) {
        /* NaN goes through. */
        return eta > 0.0 ? gmi_hertz_least_reciprocal : eta <= 0.0 ? 0.0 : eta;
    }
    if (eta >= gmi_hertz_largest) {
        return 1.0 - 0.5 * gmi_hertz_largest / eta;
    }

    /* Up to w = 2: middle, inverse half length, coefficients. */
    const double *row = gmi_hertz_high_table[eta >= 0.25];
    const double t = (eta - row[0]) * row[1];
    double y = 0.0;
    for (int k = GMI_HERTZ_HIGH_COEFFICIENTS - 1; k >= 0; --k) {
        y = y * t + row[2 + k];
    }
    return y;
}

void gmi_hertz_evaluate(double compliance, double rate, double approach, gmi_hertz_state *state) {
    const double delta = approach > 0.0 ? approach : 0.0;
    const double eta = delta * rate;
    const double y = gmi_hertz_reciprocal(eta);
    const double per_compliance = 1.0 / compliance;
    const double load = delta * y * per_compliance;

    /* B times the slope: y / (1 - y), and 1 on the straight part. */
    const int straight = eta > gmi_hertz_largest;
    const double slope = straight ? 1.0 : y / (1.0 - y);
    state->load = load;
    state->stiffness = slope * per_compliance;

    /* On the straight part, which begins at load `last`, the energy grows as that of a linear spring. */
    const double last = straight ? 0.5 * gmi_hertz_largest * per_compliance / rate : load;
    const double excess = load - last;
    state->energy =
        0.5 * load * (delta - 0.5 * compliance * load) + 0.25 * compliance * excess * excess;

    /* From delta = B q (L - ln q): dq/dL = -B q dq/d delta; the energy follows by integration. */
    state->load_by_L = -last * slope;
    state->energy_by_L = -compliance * last * (load - 0.5 * last);
}
