/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Status texts and version. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"

static const int all_statuses[] = {GM_OK,
                                   GM_STATE_NOT_FINITE,
                                   GM_STATE_OUT_OF_RANGE,
                                   GM_NO_EQUILIBRIUM,
                                   GM_UNDETERMINED,
                                   GM_POSE_OUT_OF_MESH,
                                   GM_NO_CONVERGENCE,
                                   GM_ERR_NULL,
                                   GM_ERR_PARAMETER,
                                   GM_ERR_GEOMETRY,
                                   GM_ERR_MEMORY,
                                   GM_ERR_TOOTH,
                                   GM_ERR_DEVIATION};

enum { STATUS_COUNT = sizeof all_statuses / sizeof all_statuses[0] };

static void every_status_has_its_own_text(void) {
    for (int i = 0; i < STATUS_COUNT; ++i) {
        const char *text = gm_status_text(all_statuses[i]);
        gm_test_context("status %d", all_statuses[i]);
        GM_ASSERT(text != NULL && strlen(text) > 3);
        GM_ASSERT(strcmp(text, "unknown status") != 0);
        for (int k = 0; k < i; ++k) {
            GM_ASSERT(strcmp(text, gm_status_text(all_statuses[k])) != 0);
        }
    }
}

static void any_other_status_is_unknown(void) {
    static const int others[] = {7, -7, 100, -100, 2147483647, -2147483647 - 1};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        gm_test_context("status %d", others[i]);
        GM_ASSERT_STRING(gm_status_text(others[i]), "unknown status");
    }
}

/* The contract of a SUNDIALS right-hand side: > 0 recoverable, < 0 not. */
static void signs_tell_who_is_at_fault(void) {
    GM_ASSERT_INT(GM_OK, 0);
    for (int i = 0; i < STATUS_COUNT; ++i) {
        gm_test_context("entry %d", i);
        GM_ASSERT(i < 1 || i > 6 || all_statuses[i] > 0);
        GM_ASSERT(i < 7 || all_statuses[i] < 0);
    }
}

static void version_is_that_of_the_header(void) {
    char expected[64];
    snprintf(expected, sizeof expected, "%d.%d.%d", GM_VERSION_MAJOR, GM_VERSION_MINOR,
             GM_VERSION_PATCH);
    GM_ASSERT_STRING(gm_version(), expected);
    GM_ASSERT_STRING(GM_VERSION_STRING, expected);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(every_status_has_its_own_text),
        GM_TEST(any_other_status_is_unknown),
        GM_TEST(signs_tell_who_is_at_fault),
        GM_TEST(version_is_that_of_the_header),
    };
    return gm_test_main("unit.status", tests, GM_TEST_COUNT(tests), argc, argv);
}
