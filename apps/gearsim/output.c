/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700

#include "output_format.h"
#include "paths.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FILE_MODE = 0666 }; /* as the umask allows */

static const char file_key[] = "output.file";

/* ---------------------------------------------------------------------------------------------
 * Formats
 * ------------------------------------------------------------------------------------------- */

static int ends_with(const char *text, const char *suffix) {
    const size_t length = strlen(text), suffix_length = strlen(suffix);

    return length >= suffix_length && strcmp(text + length - suffix_length, suffix) == 0;
}

/* By the name that was asked for, a link's target may have any. NULL after a message. */
static const output_format *format_of(const config *conf) {
    if (!ends_with(conf->output_file, ".h5") && !ends_with(conf->output_file, ".hdf5")) {
        return &csv_format;
    }
#ifdef GEARSIM_HDF5
    return &hdf5_format;
#else
    config_complain(conf, file_key, "'%s': this gearsim was built without HDF5; name a .csv file",
                    conf->output_file);
    return NULL;
#endif
}

int output_fail(output_file *output, int error) {
    output->error = error;
    fprintf(stderr, "gearsim: %s: %s\n", output->part, strerror(error));
    return EXIT_RUN_FAILED;
}

/* ---------------------------------------------------------------------------------------------
 * Paths
 * ------------------------------------------------------------------------------------------- */

static char *copy_of(const char *text, const char *suffix) {
    const size_t length = strlen(text);
    char *copy = malloc(length + strlen(suffix) + 1);

    if (copy != NULL) {
        memcpy(copy, text, length);
        strcpy(copy + length, suffix);
    }
    return copy;
}

/* The file itself where the path is a link to one, so that the rename replaces that file. */
static char *resolved(const char *path) {
    char *target = realpath(path, NULL);

    return target != NULL ? target : copy_of(path, "");
}

/* The same for the result or the file that it grows in. */
static const char *obstacle(const char *path, const char *part) {
    const char *reason = path_obstacle(path);

    return reason != NULL ? reason : path_obstacle(part);
}

/* The folder must be there and take new files. NULL if so. */
static const char *folder_obstacle(const char *path) {
    char *folder = copy_of(path, "");
    if (folder == NULL) {
        return strerror(errno);
    }

    char *slash = strrchr(folder, '/');
    if (slash != NULL) {
        /* The folder of "/file" is "/". */
        slash[slash == folder] = '\0';
    }
    const int denied = access(slash != NULL ? folder : ".", W_OK | X_OK);
    const char *reason = denied ? strerror(errno) : NULL;
    free(folder);

    return reason;
}

static int check_place(const config *conf, const char *path, const char *part) {
    const char *reason = obstacle(path, part);
    if (reason != NULL) {
        config_complain(conf, file_key, "'%s' %s", path, reason);
        return EXIT_BAD_INPUT;
    }

    const char *folder_reason = folder_obstacle(path);
    if (folder_reason != NULL) {
        config_complain(conf, file_key, "cannot write '%s': %s", part, folder_reason);
        return EXIT_BAD_INPUT;
    }
    return 0;
}

static void output_free(output_file *output) {
    free(output->path);
    free(output->part);
    free(output);
}

/* Everything but the file. NULL after a message. */
static output_file *create(const config *conf, const char *const names[], int name_count,
                           int *exit_code) {
    output_file *created = calloc(1, sizeof *created);
    if (created != NULL) {
        created->file = -1;
        created->digits = conf->digits;
        created->path = resolved(conf->output_file);
        created->part = created->path != NULL ? copy_of(created->path, ".part") : NULL;
    }
    if (created == NULL || created->part == NULL) {
        fprintf(stderr, "gearsim: out of memory\n");
        *exit_code = EXIT_RUN_FAILED;
        if (created != NULL) {
            output_free(created);
        }
        return NULL;
    }

    created->format = format_of(conf);
    *exit_code = created->format == NULL
                     ? EXIT_BAD_INPUT
                     : columns_select(&created->columns, conf, names, name_count);
    if (*exit_code == 0) {
        *exit_code = check_place(conf, created->path, created->part);
    }
    if (*exit_code != 0) {
        output_free(created);
        return NULL;
    }
    return created;
}

int output_check(const config *conf, const char *const names[], int name_count) {
    int exit_code = 0;
    output_file *checked = create(conf, names, name_count, &exit_code);

    if (checked != NULL) {
        output_free(checked);
    }
    return exit_code;
}

/* ---------------------------------------------------------------------------------------------
 * Writing
 * ------------------------------------------------------------------------------------------- */

/* A write beyond the limit on file sizes is to fail like a full disk, not to kill the run. */
static void ignore_file_size_signal(void) {
#ifdef SIGXFSZ
    (void)signal(SIGXFSZ, SIG_IGN);
#endif
}

output_file *output_open(const config *conf, const char *const names[], int name_count,
                         int *exit_code) {
    output_file *opened = create(conf, names, name_count, exit_code);
    if (opened == NULL) {
        return NULL;
    }

    ignore_file_size_signal();
    opened->file = open(opened->part, O_RDWR | O_CREAT | O_TRUNC, FILE_MODE);
    if (opened->file < 0) {
        config_complain(conf, file_key, "cannot write '%s': %s", opened->part, strerror(errno));
        *exit_code = EXIT_BAD_INPUT;
        output_free(opened);
        return NULL;
    }
    if (opened->format->begin(opened, conf, names) != 0) {
        *exit_code = output_close(opened, "the header could not be written");
        return NULL;
    }
    return opened;
}

int output_wants(const output_file *output, int name) {
    for (int i = 0; i < output->columns.count; ++i) {
        if (output->columns.name[i] == name) {
            return 1;
        }
    }
    return 0;
}

int output_row(output_file *output, const double values[]) {
    return output->format->row(output, values);
}

/* ---------------------------------------------------------------------------------------------
 * The end
 * ------------------------------------------------------------------------------------------- */

/* close() is the last to tell of a write that failed. */
static int close_file(output_file *output) {
    const int failed = close(output->file) != 0;

    if (failed) {
        fprintf(stderr, "gearsim: %s: %s\n", output->part, strerror(errno));
    }
    return failed ? EXIT_RUN_FAILED : 0;
}

int output_close(output_file *output, const char *incomplete) {
    int exit_code = output->format->end(output, incomplete);

    if (close_file(output) != 0) {
        exit_code = EXIT_RUN_FAILED;
    }
    if (exit_code == 0 && incomplete == NULL && rename(output->part, output->path) != 0) {
        fprintf(stderr, "gearsim: cannot rename %s to %s: %s\n", output->part, output->path,
                strerror(errno));
        exit_code = EXIT_RUN_FAILED;
    }
    output_free(output);
    return exit_code;
}
