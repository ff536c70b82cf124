/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Ctrl-C and SIGTERM end a run at its next step instead of killing it; a second one kills.
 */
#ifndef GEARSIM_INTERRUPT_H
#define GEARSIM_INTERRUPT_H

void interrupt_watch(void);

/* Gives the signals back to whoever had them. */
void interrupt_unwatch(void);

int interrupt_requested(void);

#endif
