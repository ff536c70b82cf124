/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Median and median distance. */

#include "robust.h"
#include "shared.h"

#include <math.h>
#include <stdlib.h>

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

double gmi_median(double *values, int count) {
    qsort(values, (size_t)count, sizeof *values, compare_doubles);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

double gmi_spread(const double *values, int count, double *work) {
    for (int k = 0; k < count; ++k) {
        work[k] = values[k];
    }
    const double middle = gmi_median(work, count);

    for (int k = 0; k < count; ++k) {
        work[k] = fabs(values[k] - middle);
    }
    return 1.4826 * gmi_median(work, count);
}
