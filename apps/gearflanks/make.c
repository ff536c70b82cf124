/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "make.h"
#include "report.h"
#include "scatter.h"

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

/* What is made, and from what. */
typedef struct making {
    const flanks_options *options;
    gm_generate_options generate;
    scatter_file scatter; /* entries = NULL: of a class */
    gm_deviations deviations;
    gm_pitch pitch;
} making;

/* How the flanks were made, so that a file says where it comes from. */
static void print_head(FILE *file, const making *of) {
    const gm_generate_options *generate = &of->generate;

    fprintf(file, "# Made, not measured: gearflanks %s, %s of %d teeth, ", gm_version(),
            of->options->wheel ? "wheel" : "pinion", of->pitch.teeth);
    if (generate->scatter != NULL)
        fputs("scatter from tooth to tooth\n", file);
    else
        fprintf(file, "ISO 1328-1 class %d, share %g\n", generate->quality_class, generate->share);
    fprintf(file, "# seed %llu, nodes %dx%d\n", (unsigned long long)generate->seed,
            generate->face_nodes, generate->profile_nodes);
    if (generate->scatter != NULL)
        scatter_print(&of->scatter, file);
    for (int i = 0; i < generate->wave_count; ++i)
        fprintf(file, "# wave of order %d, %g um\n", generate->waves[i].order,
                1e6 * generate->waves[i].amplitude);
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
static int join(const char *part, const char *rows, const making *of) {
    FILE *in = fopen(rows, "rb");
    FILE *out = in != NULL ? fopen(part, "wb") : NULL;
    int whole = out != NULL;

    if (whole) {
        print_head(out, of);
        whole = copy_rows(out, in);
    }
    if (out != NULL && fclose(out) != 0)
        whole = 0;
    if (in != NULL)
        fclose(in);
    return whole ? EXIT_DONE : complain(part, "written");
}

/* Rows -> FILE.rows -> FILE.part with a head -> FILE, which is not touched before it is whole. */
static int finish(const char *path, const char *rows, const making *of) {
    char *part = with_ending(path, ".part");
    int status = part != NULL ? join(part, rows, of) : EXIT_RUN_FAILED;

    if (status == EXIT_DONE && rename(part, path) != 0)
        status = complain(path, "written");
    if (status != EXIT_DONE && part != NULL)
        remove(part);
    free(part);
    return status;
}

enum content { DEVIATIONS, PITCH };

static int write_file(const char *path, const making *of, enum content content) {
    char *rows = with_ending(path, ".rows");
    gm_io_error error;
    int status = EXIT_RUN_FAILED;

    if (rows == NULL)
        return status;
    if ((content == DEVIATIONS ? gm_deviations_write(&of->deviations, rows, &error)
                               : gm_pitch_write(&of->pitch, rows, &error)) == GM_IO_OK)
        status = finish(path, rows, of);
    else
        fprintf(stderr, "%s: %s\n", path, error.text);
    remove(rows);
    free(rows);
    return status;
}

static int generate(making *of, const gm_pair *pair) {
    gm_io_error error;
    const int status = gm_flanks_generate(&of->deviations, &of->pitch, pair, of->options->wheel,
                                          &of->generate, &error);

    if (status == GM_IO_OK)
        return EXIT_DONE;
    fprintf(stderr, "gearflanks: %s\n", error.text);
    return status == GM_IO_ERR_MEMORY ? EXIT_RUN_FAILED : EXIT_BAD_INPUT;
}

static int make_and_write(making *of, const gm_pair *pair) {
    int status = generate(of, pair);

    if (status != EXIT_DONE)
        return status;
    status = write_file(of->options->deviations, of, DEVIATIONS);
    if (status == EXIT_DONE)
        status = write_file(of->options->pitch, of, PITCH);
    if (status == EXIT_DONE)
        status = report_quality(of->options, pair, &of->deviations, &of->pitch);
    gm_deviations_free(&of->deviations);
    gm_pitch_free(&of->pitch);
    return status;
}

int make_flanks(const flanks_options *options, const gm_pair *pair) {
    making of = {.options = options, .generate = options->generate};
    int status = EXIT_DONE;

    if (options->scatter != NULL) {
        status = scatter_read(&of.scatter, options->scatter);
        of.generate.scatter = &of.scatter.amounts;
    }
    if (status == EXIT_DONE)
        status = make_and_write(&of, pair);
    scatter_free(&of.scatter);
    return status;
}
