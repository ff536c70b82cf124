/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "write.h"
#include "config.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

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

    while ((size = fread(block, 1, sizeof block, in)) > 0)
        if (fwrite(block, 1, size, out) != size)
            return 0;
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
    if (out != NULL && fclose(out) != 0)
        whole = 0;
    if (in != NULL)
        fclose(in);
    return whole ? EXIT_DONE : complain(part, "written");
}

/* Rows -> FILE.rows -> FILE.part with a head -> FILE, which is not touched before it is whole. */
static int finish(const char *path, const char *rows, const written *what) {
    char *part = with_ending(path, ".part");
    int status = part != NULL ? join(part, rows, what) : EXIT_RUN_FAILED;

    if (status == EXIT_DONE && rename(part, path) != 0)
        status = complain(path, "written");
    if (status != EXIT_DONE && part != NULL)
        remove(part);
    free(part);
    return status;
}

int write_file(const char *path, const written *what) {
    char *rows = with_ending(path, ".rows");
    gm_io_error error;
    int status = EXIT_RUN_FAILED;

    if (rows == NULL)
        return status;
    if ((what->deviations != NULL ? gm_deviations_write(what->deviations, rows, &error)
                                  : gm_pitch_write(what->pitch, rows, &error)) == GM_IO_OK)
        status = finish(path, rows, what);
    else
        fprintf(stderr, "%s: %s\n", path, error.text);
    remove(rows);
    free(rows);
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

    for (size_t i = 0; field != NULL && i < sizeof names / sizeof names[0]; ++i)
        if (strcmp(field, names[i][0]) == 0)
            return names[i][1];
    return "";
}

int refuse_input(int status, const gm_io_error *error) {
    const char *option = see_option(error->option);

    if (error->file[0] == '\0')
        fprintf(stderr, "gearflanks: %s%s\n", error->text, option);
    else if (error->line > 0)
        fprintf(stderr, "%s:%ld: %s%s\n", error->file, error->line, error->text, option);
    else
        fprintf(stderr, "%s: %s%s\n", error->file, error->text, option);
    return status == GM_IO_ERR_MEMORY ? EXIT_RUN_FAILED : EXIT_BAD_INPUT;
}
