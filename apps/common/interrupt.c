/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700 /* SIGXCPU */

#include "interrupt.h"

#include <signal.h>
#include <stddef.h>

/* What asks a process to end, or would end it. SIGQUIT stays the way to a core file. */
static const int watched[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGALRM, SIGUSR1, SIGUSR2};
enum { WATCHED_COUNT = sizeof watched / sizeof watched[0] };

static volatile sig_atomic_t requested;
static struct sigaction previous[WATCHED_COUNT];

static void request(int signal_number) {
    (void)signal_number;
    requested = 1;
}

void interrupt_watch(enum interrupt_second second) {
    /* SA_RESTART: a write is not cut short. SA_RESETHAND: the second signal finds the default again. */
    struct sigaction action = {.sa_handler = request, .sa_flags = SA_RESTART};
    if (second == SECOND_KILLS) {
        action.sa_flags |= (int)SA_RESETHAND;
    }
    sigemptyset(&action.sa_mask);

    requested = 0;
    for (int i = 0; i < WATCHED_COUNT; ++i) {
        sigaction(watched[i], NULL, &previous[i]);
        /* A signal that the caller had ignored (nohup, a background job) stays ignored. */
        if (previous[i].sa_handler != SIG_IGN) {
            sigaction(watched[i], &action, NULL);
        }
    }
}

void interrupt_unwatch(void) {
    for (int i = 0; i < WATCHED_COUNT; ++i) {
        sigaction(watched[i], &previous[i], NULL);
    }
}

int interrupt_requested(void) {
    return requested != 0;
}
