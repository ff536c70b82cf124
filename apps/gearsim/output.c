/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700

#include "output.h"
#include "columns.h"
#include "number.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    BUFFER_SIZE = 1 << 16,
    ROW_SIZE_MAX = COLUMNS_MAX * NUMBER_TEXT_SIZE,
    FILE_MODE = 0666 /* as the umask allows */
};

static const char file_key[] = "output.file";

struct output_file {
    int file;
    char *path; /* where the result goes in the end */
    char *part; /* where it grows */
    column_list columns;
    int digits;
    off_t written; /* bytes of whole lines in the file */
    int error;     /* errno of the write that failed, 0 = none */
    size_t used;   /* bytes in the buffer; whole lines only */
    char buffer[BUFFER_SIZE];
};

/* ---------------------------------------------------------------------------------------------
 * Paths
 * ------------------------------------------------------------------------------------------- */

static char *copy_of(const char *text, const char *suffix) {
    const size_t length = strlen(text);
    char *const copy = malloc(length + strlen(suffix) + 1);

    if (copy != NULL) {
        memcpy(copy, text, length);
        strcpy(copy + length, suffix);
    }
    return copy;
}

/* The file itself where the path is a link to one, so that the rename replaces that file. */
static char *resolved(const char *path) {
    char *const target = realpath(path, NULL);

    return target != NULL ? target : copy_of(path, "");
}

/* Why the result cannot go there, NULL if it can. A device or pipe would be replaced by a file. */
static const char *obstacle(const char *path, const char *part) {
    const char *const places[] = {path, part};
    struct stat status;

    for (int i = 0; i < 2; ++i) {
        if (stat(places[i], &status) == 0) {
            if (S_ISDIR(status.st_mode)) {
                return "is a folder; name a file";
            }
            if (!S_ISREG(status.st_mode)) {
                return "is not a regular file; name a file";
            }
            if (access(places[i], W_OK) != 0) {
                return "is write-protected";
            }
        }
    }
    return NULL;
}

/* The folder must be there and take new files. NULL if so. */
static const char *folder_obstacle(const char *path) {
    char *const folder = copy_of(path, "");
    if (folder == NULL) {
        return strerror(errno);
    }

    char *const slash = strrchr(folder, '/');
    if (slash != NULL) {
        /* The folder of "/file" is "/". */
        slash[slash == folder] = '\0';
    }
    const int denied = access(slash != NULL ? folder : ".", W_OK | X_OK);
    const char *const reason = denied ? strerror(errno) : NULL;
    free(folder);

    return reason;
}

static int check_place(const config *conf, const char *path, const char *part) {
    const char *const reason = obstacle(path, part);
    if (reason != NULL) {
        config_complain(conf, file_key, "'%s' %s", path, reason);
        return EXIT_BAD_INPUT;
    }

    const char *const folder_reason = folder_obstacle(path);
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
    output_file *const created = calloc(1, sizeof *created);
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

    *exit_code = columns_select(&created->columns, conf, names, name_count);
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
    output_file *const checked = create(conf, names, name_count, &exit_code);

    if (checked != NULL) {
        output_free(checked);
    }
    return exit_code;
}

/* ---------------------------------------------------------------------------------------------
 * Writing
 * ------------------------------------------------------------------------------------------- */

/* Writes as much as the disk takes, in *done; returns an errno or 0. */
static int write_all(int file, const char *text, size_t size, size_t *done) {
    *done = 0;
    while (*done < size) {
        const ssize_t count = write(file, text + *done, size - *done);
        if (count < 0 && errno != EINTR) {
            return errno;
        }
        if (count > 0) {
            *done += (size_t)count;
        }
    }
    return 0;
}

/* Length of the whole lines at the start of a text. */
static size_t whole_lines(const char *text, size_t size) {
    while (size > 0 && text[size - 1] != '\n') {
        --size;
    }
    return size;
}

/* Cuts the line that a full disk has left half written. */
static void cut_to_whole_lines(output_file *output) {
    if (ftruncate(output->file, output->written) == 0) {
        (void)lseek(output->file, output->written, SEEK_SET);
    }
}

/* Empties the buffer. After an error nothing more is written. Returns 0 or EXIT_RUN_FAILED. */
static int flush(output_file *output) {
    size_t done;

    if (output->error != 0) {
        return EXIT_RUN_FAILED;
    }
    output->error = write_all(output->file, output->buffer, output->used, &done);
    output->written += (off_t)whole_lines(output->buffer, done);
    output->used = 0;
    if (output->error == 0) {
        return 0;
    }

    fprintf(stderr, "gearsim: %s: %s\n", output->part, strerror(output->error));
    cut_to_whole_lines(output);
    return EXIT_RUN_FAILED;
}

/* A line of any length, which must end in '\n' and not be split: longer than the buffer is an error. */
static int put_line(output_file *output, const char *first, const char *second) {
    const size_t size = strlen(first) + strlen(second) + 1;

    if (size > BUFFER_SIZE - output->used && flush(output) != 0) {
        return EXIT_RUN_FAILED;
    }
    if (size >= BUFFER_SIZE) {
        output->error = EOVERFLOW;
        return EXIT_RUN_FAILED;
    }
    output->used += (size_t)sprintf(output->buffer + output->used, "%s%s", first, second);
    output->buffer[output->used++] = '\n';
    return 0;
}

static int put_header(output_file *output, const config *conf, const char *const names[]) {
    char header[BUFFER_SIZE / 16] = "";
    int failed = put_line(output, "# gearsim ", gm_version());

    for (int i = 0; i < conf->provenance_count && !failed; ++i) {
        failed = put_line(output, "# ", conf->provenance[i]);
    }
    for (int i = 0; i < output->columns.count; ++i) {
        if (i > 0) {
            strcat(header, ",");
        }
        strcat(header, names[output->columns.name[i]]);
    }
    failed = failed || put_line(output, header, "");

    /* On the disk at once: a full one is found before the run, not after it. */
    return failed ? EXIT_RUN_FAILED : flush(output);
}

/* A write beyond the limit on file sizes is to fail like a full disk, not to kill the run. */
static void ignore_file_size_signal(void) {
#ifdef SIGXFSZ
    (void)signal(SIGXFSZ, SIG_IGN);
#endif
}

output_file *output_open(const config *conf, const char *const names[], int name_count,
                         int *exit_code) {
    output_file *const opened = create(conf, names, name_count, exit_code);
    if (opened == NULL) {
        return NULL;
    }

    ignore_file_size_signal();
    opened->file = open(opened->part, O_WRONLY | O_CREAT | O_TRUNC, FILE_MODE);
    if (opened->file < 0) {
        config_complain(conf, file_key, "cannot write '%s': %s", opened->part, strerror(errno));
        *exit_code = EXIT_BAD_INPUT;
        output_free(opened);
        return NULL;
    }
    if (put_header(opened, conf, names) != 0) {
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
    if (output->used > BUFFER_SIZE - ROW_SIZE_MAX && flush(output) != 0) {
        return EXIT_RUN_FAILED;
    }

    char *out = output->buffer + output->used;
    for (int i = 0; i < output->columns.count; ++i) {
        /* + 0.0: no "-0" in tables. */
        out += number_format(out, values[output->columns.name[i]] + 0.0, output->digits);
        *out++ = ',';
    }
    out[-1] = '\n';
    output->used = (size_t)(out - output->buffer);

    return output->error != 0 ? EXIT_RUN_FAILED : 0;
}

/* ---------------------------------------------------------------------------------------------
 * The end
 * ------------------------------------------------------------------------------------------- */

/* Says in the file that it is not whole, if the disk takes that line as a whole. */
static void mark_incomplete(output_file *output, const char *why) {
    char line[512];
    size_t done;
    const int length = snprintf(line, sizeof line, "# incomplete: %s\n", why);

    if (length > 0 && (size_t)length < sizeof line &&
        write_all(output->file, line, (size_t)length, &done) != 0) {
        cut_to_whole_lines(output);
    }
}

/* close() is the last to tell of a write that failed. */
static int close_file(output_file *output) {
    const int failed = close(output->file) != 0;

    if (failed) {
        fprintf(stderr, "gearsim: %s: %s\n", output->part, strerror(errno));
    }
    return failed ? EXIT_RUN_FAILED : 0;
}

int output_close(output_file *output, const char *incomplete) {
    int exit_code = flush(output);

    if (exit_code != 0 || incomplete != NULL) {
        mark_incomplete(output, output->error != 0 ? strerror(output->error) : incomplete);
    }
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
