/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "write.h"
#include "exit_code.h"
#include "interrupt.h"
#include "result_file.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

static int complain(const result_file *wrong, int status) {
    if (status != EXIT_DONE) {
        fprintf(stderr, "gearflanks: %s %s\n", wrong->wrong_path, wrong->reason);
    }
    return status;
}

/* Head and rows. The stream has a descriptor of its own: that of the result stays open to bring it to the disk. */
static int print_part(const written *what, const result_file *result) {
    gm_io_error error;
    const int descriptor = dup(result->data);
    FILE *stream = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
    if (stream == NULL) {
        fprintf(stderr, "gearflanks: %s: %s\n", result->part, strerror(errno));
        if (descriptor >= 0) {
            close(descriptor);
        }
        return EXIT_RUN_FAILED;
    }

    what->print_head(stream, what->context);
    const int failed = what->deviations != NULL
                           ? gm_deviations_print(what->deviations, stream, &error)
                           : gm_pitch_print(what->pitch, stream, &error);
    errno = 0;
    const int not_closed = fclose(stream) != 0;
    if (failed || not_closed) {
        fprintf(stderr, "gearflanks: %s: %s\n", result->part,
                failed ? error.text : strerror(errno));
        return EXIT_RUN_FAILED;
    }
    return EXIT_DONE;
}

static int write_part(const written *what, result_file *result) {
    int status = result_file_check(result, what->path);

    if (status == EXIT_DONE) {
        status = result_file_open(result);
    }
    complain(result, status);
    return status == EXIT_DONE ? print_part(what, result) : status;
}

static int interrupted(void) {
    fputs("gearflanks: interrupted, no file was written\n", stderr);
    return EXIT_INTERRUPTED;
}

/* Flanks and pitch of a gear belong together: no file is touched before all are whole. */
int write_files(const written files[], int count) {
    result_file results[WRITTEN_MAX];
    const result_file *wrong = NULL;
    int status = EXIT_DONE;
    int begun = 0;

    /* A signal waits until the files are in order. */
    interrupt_watch(SECOND_WAITS);
    for (; begun < count && status == EXIT_DONE; ++begun) {
        status = write_part(&files[begun], &results[begun]);
        if (status == EXIT_DONE && interrupt_requested()) {
            status = interrupted();
        }
    }
    if (status == EXIT_DONE) {
        status = result_files_replace(results, count, &wrong);
        complain(wrong, status);
    }

    for (int i = 0; i < begun; ++i) {
        if (status != EXIT_DONE) {
            result_file_remove(&results[i]);
        }
        result_file_free(&results[i]);
    }
    interrupt_unwatch();
    return status;
}

/* What the command line calls a field of the library's options; empty if it has no name for it. */
static const char *see_option(const char *field) {
    static const char *const names[][2] = {{"first_number", " (see --first-number)"},
                                           {"first_tooth", " (see --first-tooth)"},
                                           {"pitch_diameter", " (see --pitch-diameter)"},
                                           {"held_limit", " (see --held)"},
                                           {"hollow", " (see --hollow)"},
                                           {"remove_spikes", " (see --remove-spikes)"}};

    for (size_t i = 0; field != NULL && i < sizeof names / sizeof names[0]; ++i) {
        if (strcmp(field, names[i][0]) == 0) {
            return names[i][1];
        }
    }
    return "";
}

int refuse_input(int status, const gm_io_error *error) {
    const char *option = see_option(error->option);

    if (error->file[0] == '\0') {
        fprintf(stderr, "gearflanks: %s%s\n", error->text, option);
    } else if (error->line > 0) {
        fprintf(stderr, "%s:%ld: %s%s\n", error->file, error->line, error->text, option);
    } else {
        fprintf(stderr, "%s: %s%s\n", error->file, error->text, option);
    }
    return status == GM_IO_ERR_MEMORY ? EXIT_RUN_FAILED : EXIT_BAD_INPUT;
}
