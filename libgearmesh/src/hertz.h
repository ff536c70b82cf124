/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The line contact law of two teeth and its inverse, without logarithm or exponential.
 *
 * Two flanks pressed together with the line load q (normal force per length, N/m) approach each other along the
 * transverse line of action by
 *
 *     delta(q) = B q (L - ln q),    B = (B_p + B_w) / (2 cos(beta_b)),    B_i = 2 (1 - nu_i^2) / (pi E_i).
 *
 * L holds the relative curvature and the depths of both teeth, see tooth_compliance.c. With w = L - ln q and
 * eta = delta / (B e^L) the law reads w e^-w = eta, one function for all gears. Its inverse y = 1 / w, w > 1, is a table of
 * polynomials found from the bits of eta, so that an evaluation needs +, -, *, / alone and gives the same bits everywhere:
 *
 *     q = delta y / B,    dq / d delta = y / ((1 - y) B),    energy = q (delta - B q / 2) / 2.
 *
 * Above eta = 2 e^-2, where w = 2, the law goes straight on with the slope 1 / B, so that any state has an answer. No gear
 * comes near: for a module of 2 mm it begins at 14 kN/mm.
 */
#ifndef GEARMESH_HERTZ_H
#define GEARMESH_HERTZ_H

#include <stdint.h>
#include <string.h>

enum {
    GMI_HERTZ_OCTAVES = 53,                 /* from 2^-56 to 2^-3 ... */
    GMI_HERTZ_ROWS = 8 * GMI_HERTZ_OCTAVES, /* ... in eight segments each */
    GMI_HERTZ_FIRST_ROW = 8 * (1023 - 56),  /* exponent and three bits of the mantissa of 2^-56 */
    GMI_HERTZ_COEFFICIENTS = 6,
    GMI_HERTZ_HIGH_COEFFICIENTS = 16
};

/* Where the table begins and ends. */
#define GMI_HERTZ_FROM 0x1p-56
#define GMI_HERTZ_TO   0x1p-3

/* hertz_table.c, made by hertz_table.py. */
extern const double gmi_hertz_table[GMI_HERTZ_ROWS][GMI_HERTZ_COEFFICIENTS];
extern const double gmi_hertz_high_table[2][2 + GMI_HERTZ_HIGH_COEFFICIENTS];
extern const double gmi_hertz_least;
extern const double gmi_hertz_least_reciprocal;
extern const double gmi_hertz_largest;

/* The same outside the table: no contact, next to none, and loads that no gear bears. */
double gmi_hertz_reciprocal_rare(double eta);

/*
 * y = 1 / w of eta; 0 for eta <= 0, and q B / delta on the straight part. Relative error of y and of y / (1 - y) below
 * 3e-11. Below 2^-56, at loads of 1e-10 N/m, y is constant.
 */
static inline double gmi_hertz_reciprocal(double eta) {
    uint64_t bits;
    memcpy(&bits, &eta, sizeof bits);
    const uint64_t row = (bits >> 49) - (uint64_t)GMI_HERTZ_FIRST_ROW;
    if (row >= (uint64_t)GMI_HERTZ_ROWS) {
        return gmi_hertz_reciprocal_rare(eta);
    }

    /* The rest of the mantissa is the place within the segment: 1 .. 1.125. */
    const uint64_t place = (bits & UINT64_C(0x0001FFFFFFFFFFFF)) | UINT64_C(0x3FF0000000000000);
    double t;
    memcpy(&t, &place, sizeof t);
    t -= 1.0625;
    const double *c = gmi_hertz_table[row];
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
}

/* One point of contact. */
typedef struct gmi_hertz_state {
    double load;        /* q (N/m) */
    double stiffness;   /* dq / d delta (N/m2) */
    double energy;      /* integral of q d delta (N) */
    double load_by_L;   /* dq / dL at fixed delta (N/m) */
    double energy_by_L; /* d energy / dL at fixed delta (N) */
} gmi_hertz_state;

/*
 * Everything of one point. compliance: B (m per N/m); rate: 1 / (B e^L) (1/m); approach: delta (m).
 */
void gmi_hertz_evaluate(double compliance, double rate, double approach, gmi_hertz_state *state);

#endif
