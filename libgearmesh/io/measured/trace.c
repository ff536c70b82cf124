/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* One measured trace: its polygon, its place in the file, its name in messages. */

#include "trace.h"
#include "shared.h"

#include <stdio.h>

#include "measurement.h"

double gmi_measured_at(const gmi_measured *trace, double t) {
    const double *place = trace->t;
    const double *value = trace->value;
    int low = 0;
    int high = trace->count - 1;
    if (t <= place[low]) {
        return value[low];
    }
    if (t >= place[high]) {
        return value[high];
    }

    /* Halve the interval until it is one piece of the polygon. */
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        if (place[middle] <= t) {
            low = middle;
        } else {
            high = middle;
        }
    }

    const double share = (t - place[low]) / (place[high] - place[low]);
    return value[low] + share * (value[high] - value[low]);
}

long gmi_measured_line(const gmi_measured *trace) {
    const gm_trace *from = trace->from;
    if (from->line == NULL) {
        return 0;
    }
    /* The rows may have come the other way round. */
    const long first = from->line[0];
    const long last = from->line[from->count - 1];
    return first < last ? first : last;
}

const char *gmi_trace_name(char name[GMI_TRACE_NAME_SIZE], const gm_trace *trace) {
    snprintf(name, GMI_TRACE_NAME_SIZE, "the %s trace of tooth %d, flank %s",
             trace->kind == GM_TRACE_PROFILE ? "profile" : "helix", trace->tooth,
             gmi_flank_word(trace->flank));
    return name;
}
