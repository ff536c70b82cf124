/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "small_vector.h"

#include <math.h>

/* Lengths are even: two values at a time, which compilers put into one register. */

/* z = a x + b y; z may be x or y. */
static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z) {
    const double *from = NV_DATA_S(x), *with = NV_DATA_S(y);
    double *to = NV_DATA_S(z);

    for (sunindextype n = 0; n < NV_LENGTH_S(z); n += 2) {
        const double first = a * from[n] + b * with[n];
        const double second = a * from[n + 1] + b * with[n + 1];
        to[n] = first;
        to[n + 1] = second;
    }
}

static void scale(sunrealtype factor, N_Vector x, N_Vector z) {
    const double *from = NV_DATA_S(x);
    double *to = NV_DATA_S(z);

    for (sunindextype n = 0; n < NV_LENGTH_S(z); n += 2) {
        const double first = factor * from[n], second = factor * from[n + 1];
        to[n] = first;
        to[n + 1] = second;
    }
}

static void set_all(sunrealtype value, N_Vector z) {
    double *to = NV_DATA_S(z);

    for (sunindextype n = 0; n < NV_LENGTH_S(z); n += 2) {
        to[n] = value;
        to[n + 1] = value;
    }
}

/* Root mean square of x under the weights w. */
static sunrealtype weighted_norm(N_Vector x, N_Vector w) {
    const double *value = NV_DATA_S(x), *weight = NV_DATA_S(w);
    double sum = 0.0;

    for (sunindextype n = 0; n < NV_LENGTH_S(x); n += 2) {
        const double first = value[n] * weight[n], second = value[n + 1] * weight[n + 1];
        sum += first * first + second * second;
    }
    return sqrt(sum / (double)NV_LENGTH_S(x));
}

/* z = sum of factors[k] x[k]; z may be x[0]. NOLINTNEXTLINE(readability-non-const-parameter): SUNDIALS' type. */
static int linear_combination(int count, sunrealtype *factors, N_Vector *x, N_Vector z) {
    double *to = NV_DATA_S(z);

    for (sunindextype n = 0; n < NV_LENGTH_S(z); n += 2) {
        double first = 0.0, second = 0.0;
        for (int k = 0; k < count; ++k) {
            first += factors[k] * NV_Ith_S(x[k], n);
            second += factors[k] * NV_Ith_S(x[k], n + 1);
        }
        to[n] = first;
        to[n + 1] = second;
    }
    return 0;
}

/* z[k] = factors[k] x + y[k] */
static int scale_add_each(int count, sunrealtype *factors, N_Vector x, N_Vector *y, N_Vector *z) {
    for (int k = 0; k < count; ++k) {
        linear_sum(factors[k], x, 1.0, y[k], z[k]);
    }
    return 0;
}

N_Vector small_vector_create(sunindextype length, SUNContext context) {
    N_Vector vector = N_VNew_Serial(length, context);

    if (vector != NULL) {
        vector->ops->nvlinearsum = linear_sum;
        vector->ops->nvscale = scale;
        vector->ops->nvconst = set_all;
        vector->ops->nvwrmsnorm = weighted_norm;
        vector->ops->nvlinearcombination = linear_combination;
        vector->ops->nvscaleaddmulti = scale_add_each;
    }
    return vector;
}
