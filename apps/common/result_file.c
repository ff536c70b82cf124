/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "result_file.h"
#include "exit_code.h"
#include "paths.h"
#include "platform.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { OPEN_ATTEMPTS = 100, OLD_NAMES = 100, NUMBER_SIZE = 16 };

static const char part_ending[] = ".part";

/* ---------------------------------------------------------------------------------------------
 * What is wrong
 * ------------------------------------------------------------------------------------------- */

static int refuse(result_file *file, const char *path, const char *reason, int exit_code) {
    file->wrong_path = path;
    snprintf(file->reason, sizeof file->reason, "%s", reason);
    return exit_code;
}

/* The same with the reason of the system. */
static int refuse_for(result_file *file, const char *path, int error, int exit_code) {
    file->wrong_path = path;
    snprintf(file->reason, sizeof file->reason, "cannot be written: %s", strerror(error));
    return exit_code;
}

/* ---------------------------------------------------------------------------------------------
 * Names
 * ------------------------------------------------------------------------------------------- */

static char *with_ending(const char *path, const char *ending) {
    const size_t size = strlen(path) + strlen(ending) + 1;
    char *name = malloc(size);

    if (name != NULL) {
        snprintf(name, size, "%s%s", path, ending);
    }
    return name;
}

static int ends_in_part(const char *path) {
    const size_t length = strlen(path), ending = sizeof part_ending - 1;

    return length >= ending && strcmp(path + length - ending, part_ending) == 0;
}

/* The folder must be there and take new files. */
static int check_folder(result_file *file) {
    char *folder = path_folder(file->path);
    if (folder == NULL) {
        return refuse_for(file, file->part, errno, EXIT_RUN_FAILED);
    }

    const int error = folder_refusal(folder);
    free(folder);

    return error != 0 ? refuse_for(file, file->part, error, EXIT_BAD_INPUT) : EXIT_DONE;
}

int result_file_would_replace(const char *path, const char *input) {
    char *target = path_behind_links(path);
    char *part = target != NULL ? with_ending(target, part_ending) : NULL;
    const int would = is_same_place(path, input) || (part != NULL && is_same_place(part, input));

    free(target);
    free(part);
    return would;
}

int result_file_check(result_file *file, const char *path) {
    *file = (result_file){.data = -1, .lock = -1, .wrong_path = path};

    /* The names. */
    file->path = path_behind_links(path);
    if (file->path == NULL) {
        return refuse_for(file, path, errno, errno == ENOMEM ? EXIT_RUN_FAILED : EXIT_BAD_INPUT);
    }
    file->part = with_ending(file->path, part_ending);
    if (file->part == NULL) {
        return refuse_for(file, path, ENOMEM, EXIT_RUN_FAILED);
    }

    /* A result of that name would be taken for the growing one of another run. */
    if (ends_in_part(file->path)) {
        return refuse(file, file->path, "must not end in .part: results grow under such names",
                      EXIT_BAD_INPUT);
    }

    /* What is there already. */
    const char *obstacle = path_obstacle(file->path);
    if (obstacle != NULL) {
        return refuse(file, file->path, obstacle, EXIT_BAD_INPUT);
    }

    /* A link of the system may lead to what has no name, such as /dev/stdout. */
    obstacle = path_obstacle(path);
    if (obstacle != NULL) {
        return refuse(file, path, obstacle, EXIT_BAD_INPUT);
    }

    /* The growing file: it would be written through a link. */
    if (path_kind(file->part) == PATH_LINK) {
        return refuse(file, file->part, "is a symbolic link; remove it", EXIT_BAD_INPUT);
    }
    obstacle = path_obstacle(file->part);
    if (obstacle != NULL) {
        return refuse(file, file->part, obstacle, EXIT_BAD_INPUT);
    }
    return check_folder(file);
}

/* ---------------------------------------------------------------------------------------------
 * FILE.part
 * ------------------------------------------------------------------------------------------- */

/* Locks what is open under the name FILE.part. Where the file system has no locks there is none; the check before the
 * rename then finds out that another run has replaced the file. */
static int lock_part(result_file *file, int descriptor) {
    if (file_lock(descriptor) == 0) {
        return EXIT_DONE;
    }
    return refuse(file, file->part, "is being written by another run; wait for it, or name another",
                  EXIT_BAD_INPUT);
}

/* Removes a FILE.part that no run writes any more. */
static int remove_stale(result_file *file) {
    const int stale = file_open_old(file->part);
    if (stale < 0) {
        /* Gone in the meantime: the next attempt creates it. */
        return errno == ENOENT ? EXIT_DONE : refuse_for(file, file->part, errno, EXIT_BAD_INPUT);
    }

    /* A run that ended since may have renamed this one, and the name may be that of a third run. */
    int exit_code = lock_part(file, stale);
    if (exit_code == EXIT_DONE && file_is_at(file->part, stale) == 1 && unlink(file->part) != 0 &&
        errno != ENOENT) {
        exit_code = refuse_for(file, file->part, errno, EXIT_BAD_INPUT);
    }
    close(stale);
    return exit_code;
}

/* Creates FILE.part; *descriptor is -1 if something is in the way that the next attempt may find gone. */
static int create_part(result_file *file, int *descriptor) {
    *descriptor = file_create(file->part);
    if (*descriptor < 0) {
        return errno == EEXIST ? remove_stale(file)
                               : refuse_for(file, file->part, errno, EXIT_BAD_INPUT);
    }

    /* Before the lock another run may have taken it for stale, and removed it. */
    const int exit_code = lock_part(file, *descriptor);
    if (exit_code != EXIT_DONE || file_is_at(file->part, *descriptor) != 1) {
        close(*descriptor);
        *descriptor = -1;
    }
    return exit_code;
}

int result_file_open(result_file *file) {
    int exit_code = EXIT_DONE;

    for (int i = 0; i < OPEN_ATTEMPTS && exit_code == EXIT_DONE && file->data < 0; ++i) {
        exit_code = create_part(file, &file->data);
    }
    if (exit_code != EXIT_DONE) {
        return exit_code;
    }
    if (file->data < 0) {
        return refuse_for(file, file->part, EEXIST, EXIT_BAD_INPUT);
    }

    file->lock = file_duplicate(file->data);
    if (file->lock < 0) {
        exit_code = refuse_for(file, file->part, errno, EXIT_RUN_FAILED);
        result_file_remove(file);
    }
    return exit_code;
}

/* ---------------------------------------------------------------------------------------------
 * Becoming FILE
 * ------------------------------------------------------------------------------------------- */

/* The bytes of FILE.part reach the disk, and it is still the file that was opened. */
static int finish_part(result_file *file) {
    int error = file_sync(file->data);
    if (close(file->data) != 0 && error == 0) {
        error = errno;
    }
    file->data = -1;
    if (error != 0) {
        return refuse_for(file, file->part, error, EXIT_RUN_FAILED);
    }
    const int is_ours = file_is_at(file->part, file->lock);
    if (is_ours < 0) {
        return refuse_for(file, file->part, errno, EXIT_RUN_FAILED);
    }
    return is_ours ? EXIT_DONE
                   : refuse(file, file->part, "was removed or replaced by another program",
                            EXIT_RUN_FAILED);
}

/* Gives the old FILE a second name. Where the file system has no links it goes under that name for a moment. */
static int name_old(const char *path, const char *name) {
    const int error = file_link(path, name);

    if (error == 0 || error == ENOENT || error == EEXIST || path_kind(name) != PATH_NOTHING) {
        return error;
    }
    return file_rename(path, name);
}

/* Keeps an old FILE, so that it can come back; EXIT_DONE also if there is none. */
static int keep_old(result_file *file) {
    int error = EEXIST;

    for (int i = 0; i < OLD_NAMES && error == EEXIST; ++i) {
        char ending[sizeof part_ending + NUMBER_SIZE];
        snprintf(ending, sizeof ending, "%s.%d", part_ending, i);
        char *name = with_ending(file->path, ending);
        error = name != NULL ? name_old(file->path, name) : ENOMEM;
        if (error == 0) {
            file->old = name;
        } else {
            free(name);
        }
    }
    return error == 0 || error == ENOENT ? EXIT_DONE
                                         : refuse_for(file, file->path, error, EXIT_RUN_FAILED);
}

static void forget_old(result_file *file) {
    if (file->old != NULL) {
        unlink(file->old);
        free(file->old);
        file->old = NULL;
    }
}

/* The state before keep_old() and rename_part(). An old file that cannot come back stays under its second name. */
static void restore(result_file *file, int was_renamed) {
    if (file->old == NULL) {
        if (was_renamed) {
            unlink(file->path);
        }
        return;
    }
    /* Two names of one file both stay, so that the second still has to go. */
    if (file_rename(file->old, file->path) == 0) {
        forget_old(file);
    }
}

static int rename_part(result_file *file) {
    const int error = file_rename(file->part, file->path);

    return error == 0 ? EXIT_DONE : refuse_for(file, file->path, error, EXIT_RUN_FAILED);
}

/* The new name reaches the disk as well. */
static int sync_folder(result_file *file) {
    char *folder = path_folder(file->path);
    const int error = folder != NULL ? folder_sync(folder) : 0;

    free(folder);
    return error == 0 ? EXIT_DONE : refuse_for(file, file->path, error, EXIT_RUN_FAILED);
}

/* Runs a step over the files until one fails; *done counts those that did not. */
static int each(int (*step)(result_file *file), result_file *const files[], int count, int *done,
                const result_file **wrong) {
    for (*done = 0; *done < count; ++*done) {
        if (step(files[*done]) != EXIT_DONE) {
            *wrong = files[*done];
            return EXIT_RUN_FAILED;
        }
    }
    return EXIT_DONE;
}

int result_files_replace(result_file *const files[], int count, const result_file **wrong) {
    int done;

    /* What can fail comes before the first name changes. The last file needs no way back. */
    int exit_code = each(finish_part, files, count, &done, wrong);
    if (exit_code != EXIT_DONE) {
        return exit_code;
    }
    exit_code = each(keep_old, files, count - 1, &done, wrong);
    int renamed = 0;
    if (exit_code == EXIT_DONE) {
        exit_code = each(rename_part, files, count, &renamed, wrong);
    }

    /* All or none. */
    for (int i = 0; i < count; ++i) {
        if (exit_code == EXIT_DONE) {
            forget_old(files[i]);
        } else {
            restore(files[i], i < renamed);
        }
    }
    return exit_code == EXIT_DONE ? each(sync_folder, files, count, &done, wrong) : exit_code;
}

/* ---------------------------------------------------------------------------------------------
 * The end
 * ------------------------------------------------------------------------------------------- */

void result_file_remove(result_file *file) {
    const int descriptor = file->lock >= 0 ? file->lock : file->data;

    if (descriptor >= 0 && file_is_at(file->part, descriptor) == 1) {
        unlink(file->part);
    }
}

void result_file_free(result_file *file) {
    if (file->data >= 0) {
        close(file->data);
    }
    if (file->lock >= 0) {
        close(file->lock);
    }
    free(file->path);
    free(file->part);
    free(file->old);
    *file = (result_file){.data = -1, .lock = -1};
}
