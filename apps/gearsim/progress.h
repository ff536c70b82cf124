/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * One line on stderr that tells how far a run is, if stderr is a terminal; and a summary at the end.
 */
#ifndef GEARSIM_PROGRESS_H
#define GEARSIM_PROGRESS_H

#include <stddef.h>

typedef struct progress {
    int shown;      /* stderr is a terminal, and nobody asked for quiet */
    int quiet;      /* no summary either */
    double end;     /* simulated time at the end (s) */
    double started; /* seconds of a clock that only runs forward */
    double updated;
    int calls;
} progress;

typedef struct progress_state {
    double time;  /* simulated (s) */
    double speed; /* of the pinion (rad/s) */
    long steps;   /* of the solver */
} progress_state;

void progress_start(progress *line, double end, int quiet);

/* Cheap enough to be called very often. Returns whether an update is due. */
int progress_due(progress *line);
void progress_update(progress *line, const progress_state *state);

/* Clears the line. Has to come before any other message. */
void progress_clear(const progress *line);

/* Wall clock since the start (s). */
double progress_elapsed(const progress *line);

#endif
