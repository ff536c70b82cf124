/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "paths.h"
#include "platform.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---------------------------------------------------------------------------------------------
 * Folders and links
 * ------------------------------------------------------------------------------------------- */

enum {
    LINKS_MAX = 40,       /* in a row, as the kernel follows them */
    LINK_TEXT_SIZE = 4096 /* of a link's target */
};

/* The first characters of a path. */
static char *beginning_of(const char *path, size_t length) {
    char *copy = malloc(length + 1);

    if (copy != NULL) {
        memcpy(copy, path, length);
        copy[length] = '\0';
    }
    return copy;
}

char *path_folder(const char *path) {
    const size_t length = path_name_start(path);

    if (length == 0) {
        return beginning_of(".", 1);
    }
    /* Without the slash, but that of "/file" is its folder. */
    return beginning_of(path, length > 1 ? length - 1 : 1);
}

/* What the text of a link at `path` means from here. */
static char *target_of(const char *path, const char *text) {
    const size_t folder = path_is_absolute(text) ? 0 : path_name_start(path);
    char *target = malloc(folder + strlen(text) + 1);

    if (target != NULL) {
        memcpy(target, path, folder);
        strcpy(target + folder, text);
    }
    return target;
}

char *path_behind_links(const char *path) {
    char *reached = beginning_of(path, strlen(path));

    for (int i = 0; i < LINKS_MAX && reached != NULL; ++i) {
        char text[LINK_TEXT_SIZE];
        if (!path_read_link(reached, text, sizeof text)) {
            return reached;
        }

        char *next = target_of(reached, text);
        free(reached);
        reached = next;
    }

    /* Out of memory, or links in a circle. */
    errno = reached == NULL ? ENOMEM : ELOOP;
    free(reached);
    return NULL;
}

int is_same_place(const char *a, const char *b) {
    char *target_a = path_behind_links(a), *target_b = path_behind_links(b);
    int same = is_same_file(a, b);

    if (target_a != NULL && target_b != NULL && !same) {
        char *folder_a = path_folder(target_a), *folder_b = path_folder(target_b);
        same = folder_a != NULL && folder_b != NULL && is_same_file(folder_a, folder_b) &&
               is_same_name(target_a + path_name_start(target_a),
                            target_b + path_name_start(target_b));
        free(folder_a);
        free(folder_b);
    }
    free(target_a);
    free(target_b);
    return same;
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
