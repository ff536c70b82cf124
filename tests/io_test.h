/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file io_test.h
 * What the tests of flank files share: files of a given content, in the build folder.
 */
#ifndef IO_TEST_H
#define IO_TEST_H

#include <gearmesh/gearmesh_io.h>

#include "gm_test.h"

/* GM_TEST_FOLDER and GM_TEST_NAME come from the build, so that programs can run side by side. */
#define IO_TEST_PATH(name) GM_TEST_FOLDER "/" GM_TEST_NAME "." name

/** Writes a file of these bytes and returns its path. */
GM_TEST_UNUSED static const char *file_of_bytes(const char *bytes, size_t size) {
    static const char path[] = IO_TEST_PATH("csv");
    FILE *file = fopen(path, "wb");
    const int written = file != NULL && fwrite(bytes, 1, size, file) == size;
    const int closed = file != NULL && fclose(file) == 0;
    if (!written || !closed) {
        fprintf(stderr, "%s cannot be written\n", path);
        exit(1);
    }
    return path;
}

/** Writes a file of this text and returns its path. */
GM_TEST_UNUSED static const char *file_of(const char *text) {
    return file_of_bytes(text, strlen(text));
}

/** Holds an error against what it should say: where, which value, what would be right. */
GM_TEST_UNUSED static void assert_error(const gm_io_error *error, const char *path, long line,
                                        const char *value, const char *right) {
    gm_test_context("%.150s", error->text);
    GM_ASSERT_STRING(error->file, path);
    GM_ASSERT_INT(error->line, line);
    GM_ASSERT(strstr(error->text, value) != NULL);
    GM_ASSERT(strstr(error->text, right) != NULL);
    GM_ASSERT(strchr(error->text, '\n') == NULL);
    gm_test_context("%s", "");
}

/** Whether a and b are the same bits, so that -0 is not 0 and no rounding passes. */
GM_TEST_UNUSED static int same_bits(double a, double b) {
    uint64_t bits[2];
    memcpy(&bits[0], &a, sizeof a);
    memcpy(&bits[1], &b, sizeof b);
    return bits[0] == bits[1];
}

#endif /* IO_TEST_H */
