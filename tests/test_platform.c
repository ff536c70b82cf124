/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/common/platform_posix.c: work on several threads. */
#define _XOPEN_SOURCE 700

#include "platform.h"

#include "gm_test.h"

#include <pthread.h>
#include <stdlib.h>
#include <sys/resource.h>

/* What became of each call. */
typedef struct calls {
    int count[THREADS_MAX];
    pthread_t thread[THREADS_MAX];
} calls;

static void note_call(void *of, int which) {
    calls *made = of;

    ++made->count[which];
    made->thread[which] = pthread_self();
}

static void each_task_is_done_once(void) {
    for (int count = 1; count <= THREADS_MAX; count += 9) {
        calls made = {.count = {0}};
        threads_run(count, note_call, &made);
        gm_test_context("%d threads", count);
        for (int k = 0; k < THREADS_MAX; ++k) {
            GM_ASSERT_INT(made.count[k], k < count ? 1 : 0);
        }
        GM_ASSERT(pthread_equal(made.thread[0], pthread_self()));
    }
}

/* Two calls that wait for each other come to an end only if they run at the same time. */
static void wait_for_other(void *of, int which) {
    (void)which;
    (void)pthread_barrier_wait(of);
}

static void tasks_run_at_the_same_time(void) {
    pthread_barrier_t both;

    GM_ASSERT_INT(pthread_barrier_init(&both, NULL, 2), 0);

    /* Also where gcovr counts and threads run in turn (threads_in_turn.c). */
    GM_ASSERT_INT(setenv("GM_TEST_THREADS", "together", 1), 0);
    threads_run(2, wait_for_other, &both);
    GM_ASSERT_INT(unsetenv("GM_TEST_THREADS"), 0);
    pthread_barrier_destroy(&both);
}

#if !defined(__SANITIZE_ADDRESS__) /* which needs memory for its own notes on a thread */
static void what_gets_no_thread_is_done_here(void) {
    struct rlimit before;
    calls made = {.count = {0}};

    /* No memory for the stack of another thread. */
    GM_ASSERT_INT(getrlimit(RLIMIT_AS, &before), 0);
    const struct rlimit none = {1, before.rlim_max};
    GM_ASSERT_INT(setrlimit(RLIMIT_AS, &none), 0);
    threads_run(3, note_call, &made);
    GM_ASSERT_INT(setrlimit(RLIMIT_AS, &before), 0);
    for (int k = 0; k < 3; ++k) {
        GM_ASSERT_INT(made.count[k], 1);
    }
    GM_ASSERT(pthread_equal(made.thread[2], pthread_self()));
}
#endif

int main(int argc, char **argv) {
    static const gm_test tests[] = {
#if !defined(__SANITIZE_ADDRESS__)
        GM_TEST(what_gets_no_thread_is_done_here), /* first: stacks of ended threads are kept */
#endif
        GM_TEST(each_task_is_done_once),
        GM_TEST(tasks_run_at_the_same_time),
    };
    return gm_test_main("gearsim.platform", tests, GM_TEST_COUNT(tests), argc, argv);
}
