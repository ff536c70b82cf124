/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Ctrl-C, SIGTERM, SIGHUP and their like end a run at its next step instead of killing it.
 */
#ifndef APPS_INTERRUPT_H
#define APPS_INTERRUPT_H

/* What the same signal does when it comes again: a run whose step takes for ever can be killed, a short one that has
 * to put files in order cannot. */
enum interrupt_second { SECOND_KILLS, SECOND_WAITS };

void interrupt_watch(enum interrupt_second second);

/* Gives the signals back to whoever had them. */
void interrupt_unwatch(void);

int interrupt_requested(void);

#endif
