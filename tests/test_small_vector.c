/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/gearsim/small_vector.c: each operation gives what that of SUNDIALS' own serial vector gives. */
#include "small_vector.h"

#include "gm_test.h"

#include <sundials/sundials_version.h>

#if SUNDIALS_VERSION_MAJOR < 7
#define NO_COMMUNICATOR NULL
#else
#define NO_COMMUNICATOR SUN_COMM_NULL
#endif

enum { VECTORS = 3 };
static const sunindextype lengths[] = {2, 4};

/* The same vectors twice: ours, and those of the package. */
typedef struct pair_of_vectors {
    SUNContext context;
    N_Vector ours[VECTORS], theirs[VECTORS];
} pair_of_vectors;

static pair_of_vectors create(sunindextype length) {
    pair_of_vectors both;
    uint64_t seed = 3;

    SUNContext_Create(NO_COMMUNICATOR, &both.context);
    for (int k = 0; k < VECTORS; ++k) {
        both.ours[k] = small_vector_create(length, both.context);
        both.theirs[k] = N_VNew_Serial(length, both.context);
        for (sunindextype n = 0; n < length; ++n) {
            NV_Ith_S(both.ours[k], n) = NV_Ith_S(both.theirs[k], n) =
                gm_test_uniform(&seed, -2.0, 2.0);
        }
    }
    return both;
}

static void destroy(pair_of_vectors *both) {
    for (int k = 0; k < VECTORS; ++k) {
        N_VDestroy(both->ours[k]);
        N_VDestroy(both->theirs[k]);
    }
    SUNContext_Free(&both->context);
}

/* Sums of a few products of numbers up to 2, in another order at most. */
static void assert_same(const pair_of_vectors *both, const char *operation) {
    for (int k = 0; k < VECTORS; ++k) {
        for (sunindextype n = 0; n < NV_LENGTH_S(both->ours[k]); ++n) {
            gm_test_context("%s, vector %d, value %d", operation, k, (int)n);
            GM_ASSERT_ABS(NV_Ith_S(both->ours[k], n), NV_Ith_S(both->theirs[k], n), 1e-15);
        }
    }
}

static void sums_and_multiples_are_those_of_the_package(void) {
    for (int i = 0; i < 2; ++i) {
        pair_of_vectors both = create(lengths[i]);

        /* Into a vector of its own, and into either of those that are summed. */
        for (int to = 0; to < VECTORS; ++to) {
            N_VLinearSum(0.7, both.ours[0], -1.3, both.ours[1], both.ours[to]);
            N_VLinearSum(0.7, both.theirs[0], -1.3, both.theirs[1], both.theirs[to]);
            assert_same(&both, "sum");
            N_VScale(-1.7, both.ours[0], both.ours[to]);
            N_VScale(-1.7, both.theirs[0], both.theirs[to]);
            assert_same(&both, "multiple");
        }
        N_VConst(4.5, both.ours[1]);
        N_VConst(4.5, both.theirs[1]);
        assert_same(&both, "constant");
        destroy(&both);
    }
}

static void sums_of_several_are_those_of_the_package(void) {
    double factors[VECTORS] = {0.3, -0.9, 1.1};

    for (int i = 0; i < 2; ++i) {
        pair_of_vectors both = create(lengths[i]);

        N_VLinearCombination(VECTORS, factors, both.ours, both.ours[0]);
        N_VLinearCombination(VECTORS, factors, both.theirs, both.theirs[0]);
        assert_same(&both, "combination");
        N_VScaleAddMulti(2, factors, both.ours[0], both.ours + 1, both.ours + 1);
        N_VScaleAddMulti(2, factors, both.theirs[0], both.theirs + 1, both.theirs + 1);
        assert_same(&both, "multiples added");
        destroy(&both);
    }
}

static void the_norm_is_that_of_the_package(void) {
    for (int i = 0; i < 2; ++i) {
        pair_of_vectors both = create(lengths[i]);

        GM_ASSERT_REL(N_VWrmsNorm(both.ours[0], both.ours[1]),
                      N_VWrmsNorm(both.theirs[0], both.theirs[1]), 1e-15);
        destroy(&both);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(sums_and_multiples_are_those_of_the_package),
        GM_TEST(sums_of_several_are_those_of_the_package),
        GM_TEST(the_norm_is_that_of_the_package),
    };
    return gm_test_main("gearsim.small_vector", tests, GM_TEST_COUNT(tests), argc, argv);
}
