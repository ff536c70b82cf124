/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "progress.h"
#include "platform.h"

#include <stdio.h>

/* Between two looks at the clock; a sample takes some microseconds. */
enum { CALLS_PER_LOOK = 256 };

static const double seconds_between_updates = 0.2;
static const double rpm = 60.0 / 6.283185307179586; /* of 1 rad/s */

void progress_start(progress *line, double end, message_sink *messages) {
    const double start = wall_clock();

    *line = (progress){
        .messages = messages,
        .shown = messages != NULL && messages->show != NULL && !messages->quiet,
        .end = end,
        .started = start,
        .updated = start,
    };
}

double progress_elapsed(const progress *line) {
    return wall_clock() - line->started;
}

int progress_due(progress *line) {
    if (!line->shown || ++line->calls < CALLS_PER_LOOK) {
        return 0;
    }
    line->calls = 0;
    return wall_clock() - line->updated >= seconds_between_updates;
}

void progress_update(progress *line, const progress_state *state) {
    const double elapsed = progress_elapsed(line);
    const double left = state->time > 0.0 ? elapsed * (line->end / state->time - 1.0) : 0.0;
    char text[160];

    line->updated = wall_clock();
    snprintf(text, sizeof text, "%.3f of %g s, %.0f rpm, %ld steps, %.0f s left", state->time,
             line->end, state->speed * rpm, state->steps, left);
    message_show(line->messages, text);
}

void progress_tell(progress *line, const char *what, double share) {
    char text[160];

    if (!line->shown || wall_clock() - line->updated < seconds_between_updates) {
        return;
    }
    line->updated = wall_clock();
    snprintf(text, sizeof text, "%s, %.0f %%", what, 100.0 * share);
    message_show(line->messages, text);
}

void progress_clear(const progress *line) {
    if (line->shown) {
        message_show(line->messages, "");
    }
}
