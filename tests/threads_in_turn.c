/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Stands before pthread_create() where gcovr counts (linked with --wrap), so that counters need not be atomic, which makes
 * tests three to seven times as fast. Programs get no thread, and do the work by themselves; to tests, which count on it, a
 * thread is handed out when it has ended. With GM_TEST_THREADS=together in the environment threads run as ever.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdlib.h>
#include <string.h>

typedef struct call {
    void *(*start)(void *argument);
    void *argument;
    sem_t done;
} call;

int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*start)(void *argument), void *argument);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*start)(void *argument), void *argument);

static void *run(void *argument) {
    call *of = argument;
    void *const result = of->start(of->argument);

    (void)sem_post(&of->done);
    return result;
}

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*start)(void *argument), void *argument) {
    const char *asked = getenv("GM_TEST_THREADS");
    call of = {.start = start, .argument = argument};

    /* For tests of threads that wait for each other. */
    if (asked != NULL && strcmp(asked, "together") == 0) {
        return __real_pthread_create(thread, attributes, start, argument);
    }
    if (strncmp(program_invocation_short_name, "test_", 5) != 0) {
        return EAGAIN;
    }

    (void)sem_init(&of.done, 0, 0);
    const int failure = __real_pthread_create(thread, attributes, run, &of);
    while (failure == 0 && sem_wait(&of.done) != 0) {
        /* a signal came */
    }
    (void)sem_destroy(&of.done);
    return failure;
}
