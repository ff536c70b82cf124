/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * One line that tells how far a run is, if messages go to a terminal.
 */
#ifndef GEARSIM_PROGRESS_H
#define GEARSIM_PROGRESS_H

#include "messages.h"

typedef struct progress {
    message_sink *messages;
    int shown;      /* there is a terminal, and nobody asked for quiet */
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

void progress_start(progress *line, double end, message_sink *messages);

/* Cheap enough to be called very often. Returns whether an update is due. */
int progress_due(progress *line);
void progress_update(progress *line, const progress_state *state);

/* What comes before the run itself: what it is, and which share of it is done. Rare calls. */
void progress_tell(progress *line, const char *what, double share);

/* Clears the line. Has to come before any other message. */
void progress_clear(const progress *line);

/* Wall clock since the start (s). */
double progress_elapsed(const progress *line);

#endif
