/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "write.h"
#include "config.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int complain(const char *path, const char *action) {
    fprintf(stderr, "%s: cannot be %s: %s\n", path, action, strerror(errno));
    return EXIT_RUN_FAILED;
}

/* `path` with an ending; NULL = out of memory. */
static char *with_ending(const char *path, const char *ending) {
    char *name = malloc(strlen(path) + strlen(ending) + 1);

    if (name == NULL) {
        fputs("gearflanks: out of memory\n", stderr);
        return NULL;
    }
    strcpy(name, path);
    return strcat(name, ending);
}

static int copy_rows(FILE *out, FILE *in) {
    char block[16384];
    size_t size;

    while ((size = fread(block, 1, sizeof block, in)) > 0) {
        if (fwrite(block, 1, size, out) != size) {
            return 0;
        }
    }
    return !ferror(in);
}

/* The head and what the library has written to `rows`, in `part`. */
static int join(const char *part, const char *rows, const written *what) {
    FILE *in = fopen(rows, "rb");
    FILE *out = in != NULL ? fopen(part, "wb") : NULL;
    int whole = out != NULL;

    if (whole) {
        what->print_head(out, what->context);
        whole = copy_rows(out, in);
    }
    if (out != NULL && fclose(out) != 0) {
        whole = 0;
    }
    if (in != NULL) {
        fclose(in);
    }
    return whole ? EXIT_DONE : complain(part, "written");
}

/* What the library writes -> FILE.rows -> `part`, with its head. */
static int write_part(const written *what, const char *part) {
    char *rows = with_ending(what->path, ".rows");
    gm_io_error error;
    int status = EXIT_RUN_FAILED;

    if (rows == NULL) {
        return status;
    }
    if ((what->deviations != NULL ? gm_deviations_write(what->deviations, rows, &error)
                                  : gm_pitch_write(what->pitch, rows, &error)) == GM_IO_OK) {
        status = join(part, rows, what);
    } else {
        fprintf(stderr, "%s: %s\n", what->path, error.text);
    }
    unlink(rows);
    free(rows);
    return status;
}

/* Flanks and pitch of a gear belong together: no file is touched before all are whole. */
int write_files(const written files[], int count) {
    char *parts[WRITTEN_MAX] = {NULL};
    int status = EXIT_DONE;

    for (int i = 0; i < count && status == EXIT_DONE; ++i) {
        parts[i] = with_ending(files[i].path, ".part");
        status = parts[i] != NULL ? write_part(&files[i], parts[i]) : EXIT_RUN_FAILED;
    }
    for (int i = 0; i < count && status == EXIT_DONE; ++i) {
        if (rename(parts[i], files[i].path) != 0) {
            status = complain(files[i].path, "written");
        }
    }
    for (int i = 0; i < count; ++i) {
        if (status != EXIT_DONE && parts[i] != NULL) {
            unlink(parts[i]); /* a folder stays */
        }
        free(parts[i]);
    }
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
