/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "output_format.h"
#include "paths.h"
#include "platform.h"

#ifdef GEARSIM_HDF5
#include <dlfcn.h>
#endif
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char file_key[] = "output.file";

static int is_stream(const char *path) {
    return strcmp(path, "-") == 0;
}

/* ---------------------------------------------------------------------------------------------
 * Formats
 * ------------------------------------------------------------------------------------------- */

static int ends_with(const char *text, const char *suffix) {
    const size_t length = strlen(text), suffix_length = strlen(suffix);

    return length >= suffix_length && strcmp(text + length - suffix_length, suffix) == 0;
}

#ifdef GEARSIM_HDF5
/* The module, which stays loaded. It lies at one place beside the program, and no other one is searched.
 * NULL: not there, with the reason. */
static const output_format *load_hdf5(const char **why) {
    char *program = path_behind_links("/proc/self/exe");
    char *folder = program != NULL ? path_folder(program) : NULL;
    char path[PATH_MAX];
    const int length =
        folder != NULL ? snprintf(path, sizeof path, "%s/" GEARSIM_HDF5_MODULE, folder) : -1;
    free(program);
    free(folder);
    if (length < 0 || length >= PATH_MAX) {
        *why = "the folder of gearsim cannot be told";
        return NULL;
    }

    void *module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const output_format *format = module != NULL ? dlsym(module, "gearsim_hdf5_format") : NULL;
    if (format == NULL) {
        *why = dlerror();
        return NULL;
    }
    if (strcmp(format->version, GM_VERSION_STRING) != 0) {
        *why = "its module is that of another version of gearsim";
        return NULL;
    }
    return format;
}
#else
static const output_format *load_hdf5(const char **why) {
    *why = "this gearsim was built without HDF5";
    return NULL;
}
#endif

/* By the name that was asked for, a link's target may have any. NULL after a message. */
static const output_format *format_of(const config *conf) {
    if (!ends_with(conf->output_file, ".h5") && !ends_with(conf->output_file, ".hdf5")) {
        return &csv_format;
    }
    const char *why = NULL;
    const output_format *format = load_hdf5(&why);

    if (format == NULL) {
        config_complain(conf, file_key, "'%s': HDF5 cannot be written (%s); name a .csv file",
                        conf->output_file, why);
    }
    return format;
}

/* Keeps and tells why the file takes no more, the first time; returns an exit code. */
static int settle(output_file *output, int error) {
    if (error == 0) {
        return EXIT_DONE;
    }
    if (output->error == 0) {
        output->error = error;
        message_of_program(output->messages, "%s: %s",
                           output->is_stream ? "standard output" : output->result.part,
                           strerror(error));
    }
    return EXIT_RUN_FAILED;
}

/* ---------------------------------------------------------------------------------------------
 * Opening
 * ------------------------------------------------------------------------------------------- */

static void output_free(output_file *output) {
    result_file_free(&output->result);
    free(output);
}

/* A file that cannot be written, with the key that named it. */
static int complain(const config *conf, const output_file *output, int exit_code) {
    if (exit_code != EXIT_DONE) {
        config_complain(conf, file_key, "'%s' %s", output->result.wrong_path,
                        output->result.reason);
    }
    return exit_code;
}

/* Everything but the file. NULL after a message. */
static output_file *create(const config *conf, const char *const names[], int name_count,
                           int *exit_code) {
    output_file *created = calloc(1, sizeof *created);
    if (created == NULL) {
        *exit_code = message_no_memory(conf->messages);
        return NULL;
    }

    created->messages = conf->messages;
    created->digits = conf->digits;
    created->format = format_of(conf);
    created->is_stream = is_stream(conf->output_file);
    created->is_binary = conf->binary_rows;
    created->started = wall_clock();
    created->result.data = created->result.lock = -1;
    *exit_code = created->format == NULL
                     ? EXIT_BAD_INPUT
                     : columns_select(&created->columns, conf, names, name_count);
    if (*exit_code == EXIT_DONE && !created->is_stream) {
        *exit_code =
            complain(conf, created, result_file_check(&created->result, conf->output_file));
    }
    if (*exit_code != EXIT_DONE) {
        output_free(created);
        return NULL;
    }
    return created;
}

int output_check(const config *conf, const char *const names[], int name_count) {
    int exit_code = EXIT_DONE;
    output_file *checked = create(conf, names, name_count, &exit_code);

    if (checked != NULL) {
        output_free(checked);
    }
    return exit_code;
}

/* A descriptor of our own, to be closed as that of a file. */
static int open_stream(output_file *output) {
    output->result.data = file_duplicate(STDOUT_FILENO);
    return settle(output, output->result.data >= 0 ? 0 : errno);
}

output_file *output_open(const config *conf, const char *const names[], int name_count,
                         int *exit_code) {
    output_file *opened = create(conf, names, name_count, exit_code);
    if (opened == NULL) {
        return NULL;
    }

    *exit_code = opened->is_stream ? open_stream(opened)
                                   : complain(conf, opened, result_file_open(&opened->result));
    if (*exit_code != EXIT_DONE) {
        output_free(opened);
        return NULL;
    }
    if (settle(opened, opened->format->begin(opened, conf, names)) != EXIT_DONE) {
        *exit_code = output_close(opened, "the header could not be written");
        return NULL;
    }
    return opened;
}

/* ---------------------------------------------------------------------------------------------
 * Rows
 * ------------------------------------------------------------------------------------------- */

int output_wants(const output_file *output, int name) {
    for (int i = 0; i < output->columns.count; ++i) {
        if (output->columns.name[i] == name) {
            return 1;
        }
    }
    return 0;
}

int output_row(output_file *output, const double values[]) {
    ++output->rows;
    return settle(output, output->error != 0 ? output->error : output->format->row(output, values));
}

/* ---------------------------------------------------------------------------------------------
 * The end
 * ------------------------------------------------------------------------------------------- */

/* What there is now, where, and how long it took. */
static void tell_result(const output_file *output, const char *path, const char *incomplete) {
    message_note(output->messages, "gearsim: %s: %.0f rows%s in %.3g s",
                 output->is_stream ? "standard output" : path, output->rows,
                 incomplete != NULL ? ", incomplete," : "", wall_clock() - output->started);
}

static int close_together(output_file *output, const char *incomplete, result_file *other) {
    int exit_code = settle(output, output->format->end(output, incomplete));

    /* Whole results get their names. */
    if (exit_code == EXIT_DONE && incomplete == NULL) {
        result_file *files[2];
        const result_file *wrong;
        int count = 0;

        /* Both or none. */
        if (!output->is_stream) {
            files[count] = &output->result;
            ++count;
        }
        if (other != NULL) {
            files[count] = other;
            ++count;
        }

        exit_code = result_files_replace(files, count, &wrong);
        if (exit_code != EXIT_DONE) {
            message_of_program(output->messages, "%s: %s", wrong->wrong_path, wrong->reason);
        }
    }

    if (exit_code == EXIT_DONE) {
        tell_result(output, incomplete == NULL ? output->result.path : output->result.part,
                    incomplete);
    }
    output_free(output);
    return exit_code;
}

int output_close(output_file *output, const char *incomplete) {
    return close_together(output, incomplete, NULL);
}

int output_close_with(output_file *output, result_file *other) {
    return close_together(output, NULL, other);
}
