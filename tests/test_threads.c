/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Same inputs, same bits, from any thread: four threads share one pair and one set of flanks. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "plain_mesh.h"
#include "random_gears.h"

#include <pthread.h>

enum { THREADS = 4, EVALUATIONS = 3000 };

typedef struct worker {
    const random_case *shared;
    gm_penetration results[EVALUATIONS];
    gm_wrench wrench;
    double equilibrium;
    int failures;
} worker;

static void *work(void *argument) {
    worker *w = argument;
    const random_case *c = w->shared;
    gm_position position;
    for (int i = 0; i < EVALUATIONS; ++i) {
        const double angle = 0.01 * i - 10.0;
        const double offset = (i % 2 == 0 ? 1.0 : -1.0) * (c->pair.backlash / 2 + 1e-9 * i);
        w->failures +=
            gm_position_from_pinion_angle(&c->pair, angle, offset, 0.1, &position) != GM_OK;
        w->failures +=
            penetration_3d_at(&c->pair, c->use[0], c->use[1], &position, &w->results[i]) != GM_OK;
    }
    w->failures +=
        wrench_3d_at(&c->pair, c->use[0], c->use[1], &position, 1e8, 1e3, &w->wrench) != GM_OK;
    w->failures +=
        equilibrium(&c->pair, c->use[0], c->use[1], 0.1, 1e8, 20.0, &w->equilibrium, NULL) != GM_OK;
    return NULL;
}

static void every_thread_gets_the_same_bits(void) {
    static worker workers[THREADS];
    uint64_t seed = UINT64_C(81);
    random_case c;
    /* The first helical pair of which both gears have deviations. */
    for (;;) {
        GM_ASSERT_INT(random_case_make(&c, &seed, 1), GM_OK);
        if (c.use[0] != NULL && c.use[1] != NULL && fabs(c.params.helix_angle) > 0.1 &&
            c.params.normal_module > 1e-3) {
            break;
        }
        random_case_free(&c);
    }
    memset(workers, 0, sizeof workers);
    pthread_t threads[THREADS];
    for (int t = 0; t < THREADS; ++t) {
        workers[t].shared = &c;
        GM_ASSERT_INT(pthread_create(&threads[t], NULL, work, &workers[t]), 0);
    }
    for (int t = 0; t < THREADS; ++t) {
        GM_ASSERT_INT(pthread_join(threads[t], NULL), 0);
    }
    int touching = 0;
    for (int i = 0; i < EVALUATIONS; ++i) {
        touching += workers[0].results[i].drive_pairs + workers[0].results[i].coast_pairs > 0;
    }
    GM_ASSERT(touching > EVALUATIONS / 4);
    for (int t = 0; t < THREADS; ++t) {
        gm_test_context("thread %d", t);
        GM_ASSERT_INT(workers[t].failures, 0);
        GM_ASSERT(memcmp(workers[t].results, workers[0].results, sizeof workers[0].results) == 0);
        GM_ASSERT(memcmp(&workers[t].wrench, &workers[0].wrench, sizeof(gm_wrench)) == 0);
        GM_ASSERT_REL(workers[t].equilibrium, workers[0].equilibrium, 0.0);
    }
    random_case_free(&c);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {GM_TEST(every_thread_gets_the_same_bits)};
    return gm_test_main("property.threads", tests, GM_TEST_COUNT(tests), argc, argv);
}
