/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "paths.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int is_same_file(const char *a, const char *b) {
    struct stat status_a, status_b;

    if (strcmp(a, b) == 0) {
        return 1;
    }
    return stat(a, &status_a) == 0 && stat(b, &status_b) == 0 &&
           status_a.st_dev == status_b.st_dev && status_a.st_ino == status_b.st_ino;
}

const char *path_obstacle(const char *path) {
    struct stat status;

    if (stat(path, &status) != 0) {
        return NULL;
    }
    if (S_ISDIR(status.st_mode)) {
        return "is a folder; name a file";
    }
    if (!S_ISREG(status.st_mode)) {
        return "is not a regular file; name a file";
    }
    return access(path, W_OK) != 0 ? "is write-protected" : NULL;
}
