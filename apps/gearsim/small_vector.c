/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "small_vector.h"

#include <math.h>

/*
 * Lengths are 2 or 4: two values at a time, which compilers put into one register, and no loop about them. The second two of
 * vectors of 4 are those from 2 on.
 */
static int is_long(N_Vector vector) {
    return NV_LENGTH_S(vector) > 2;
}

static inline void sum_two(double a, const double x[2], double b, const double y[2], double z[2]) {
    const double first = a * x[0] + b * y[0], second = a * x[1] + b * y[1];

    z[0] = first;
    z[1] = second;
}

/* z = a x + b y; z may be x or y. */
static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z) {
    sum_two(a, NV_DATA_S(x), b, NV_DATA_S(y), NV_DATA_S(z));
    if (is_long(z)) {
        sum_two(a, NV_DATA_S(x) + 2, b, NV_DATA_S(y) + 2, NV_DATA_S(z) + 2);
    }
}

static inline void scale_two(double factor, const double x[2], double z[2]) {
    const double first = factor * x[0], second = factor * x[1];

    z[0] = first;
    z[1] = second;
}

static void scale(sunrealtype factor, N_Vector x, N_Vector z) {
    scale_two(factor, NV_DATA_S(x), NV_DATA_S(z));
    if (is_long(z)) {
        scale_two(factor, NV_DATA_S(x) + 2, NV_DATA_S(z) + 2);
    }
}

static void set_all(sunrealtype value, N_Vector z) {
    double *to = NV_DATA_S(z);

    for (sunindextype n = 0; n < NV_LENGTH_S(z); n += 2) {
        to[n] = value;
        to[n + 1] = value;
    }
}

static inline double squares_of_two(const double value[2], const double weight[2]) {
    const double first = value[0] * weight[0], second = value[1] * weight[1];

    return first * first + second * second;
}

/* Root mean square of x under the weights w. */
static sunrealtype weighted_norm(N_Vector x, N_Vector w) {
    const double *value = NV_DATA_S(x), *weight = NV_DATA_S(w);
    const double sum = squares_of_two(value, weight);

    return is_long(x) ? sqrt((sum + squares_of_two(value + 2, weight + 2)) * 0.25)
                      : sqrt(sum * 0.5);
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
