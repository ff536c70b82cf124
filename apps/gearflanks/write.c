/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "write.h"
#include "exit_code.h"
#include "platform.h"
#include "result_file.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

static int complain(message_sink *messages, const result_file *wrong, int status) {
    if (status != EXIT_DONE) {
        message_of_program(messages, "%s %s", wrong->wrong_path, wrong->reason);
    }
    return status;
}

/* Head and rows into an open stream; why they could not be written goes into the error. */
static int print_text(const written *what, FILE *stream, gm_io_error *error) {
    errno = 0;
    what->print_head(stream, what->context);
    if (ferror(stream)) {
        snprintf(error->text, sizeof error->text, "cannot be written: %s", strerror(errno));
        return GM_IO_ERR_FILE;
    }
    return what->deviations != NULL ? gm_deviations_print(what->deviations, stream, error)
                                    : gm_pitch_print(what->pitch, stream, error);
}

/* The stream has a descriptor of its own: that of the result stays open to bring it to the disk. */
static int print_part(message_sink *messages, const written *what, const result_file *result) {
    gm_io_error error;
    const int descriptor = dup(result->data);
    FILE *stream = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
    if (stream == NULL) {
        message_of_program(messages, "%s: %s", result->part, strerror(errno));
        if (descriptor >= 0) {
            close(descriptor);
        }
        return EXIT_RUN_FAILED;
    }

    const int failed = print_text(what, stream, &error) != GM_IO_OK;
    errno = 0;
    const int not_closed = fclose(stream) != 0;
    if (failed || not_closed) {
        message_of_program(messages, "%s: %s", result->part, failed ? error.text : strerror(errno));
        return EXIT_RUN_FAILED;
    }
    return EXIT_DONE;
}

static int write_part(message_sink *messages, const written *what, result_file *result) {
    int status = result_file_check(result, what->path);

    if (status == EXIT_DONE) {
        status = result_file_open(result);
    }
    complain(messages, result, status);
    return status == EXIT_DONE ? print_part(messages, what, result) : status;
}

static int interrupted(message_sink *messages) {
    message_of_program(messages, "interrupted, no file was written");
    return EXIT_INTERRUPTED;
}

/* Flanks and pitch of a gear belong together: no file is touched before all are whole. */
int write_files(const written files[], int count, message_sink *messages) {
    result_file results[WRITTEN_MAX];
    result_file *all[WRITTEN_MAX];
    const result_file *wrong = NULL;
    int status = EXIT_DONE;
    int begun = 0;

    /* A signal waits until the files are in order. */
    interrupt_watch(SECOND_WAITS);
    for (; begun < count && status == EXIT_DONE; ++begun) {
        all[begun] = &results[begun];
        status = write_part(messages, &files[begun], &results[begun]);
        if (status == EXIT_DONE && interrupt_requested()) {
            status = interrupted(messages);
        }
    }
    if (status == EXIT_DONE) {
        status = result_files_replace(all, count, &wrong);
        complain(messages, wrong, status);
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
                                           {"remove_spikes", " (see --remove-spikes)"},
                                           {"tip_form_diameter", " (see --tip-form-diameter)"},
                                           {"probe_sign", " (see --probe-sign)"},
                                           {"style", " (see --decimal-comma)"}};

    for (size_t i = 0; field != NULL && i < sizeof names / sizeof names[0]; ++i) {
        if (strcmp(field, names[i][0]) == 0) {
            return names[i][1];
        }
    }
    return "";
}

int refuse_input(message_sink *messages, int status, const gm_io_error *error) {
    const char *option = see_option(error->option);

    if (status == GM_IO_ERR_MEMORY) {
        return message_no_memory(messages);
    }
    if (error->file[0] == '\0') {
        message_of_program(messages, "%s%s", error->text, option);
    } else if (error->line > 0) {
        message_error(messages, "%s:%ld: %s%s", error->file, error->line, error->text, option);
    } else {
        message_error(messages, "%s: %s%s", error->file, error->text, option);
    }
    return EXIT_BAD_INPUT;
}
