/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "make.h"

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

/* How the flanks were made, so that a file says where it comes from. */
static void print_head(FILE *file, const flanks_options *options, int teeth) {
    const gm_generate_options *generate = &options->generate;

    fprintf(file, "# Made, not measured: gearflanks %s, %s of %d teeth, ISO 1328-1 class %d\n",
            gm_version(), options->wheel ? "wheel" : "pinion", teeth, generate->quality_class);
    fprintf(file, "# seed %llu, share %g, nodes %dx%d\n", (unsigned long long)generate->seed,
            generate->share, generate->face_nodes, generate->profile_nodes);
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
static int join(const char *part, const char *rows, const flanks_options *options, int teeth) {
    FILE *in = fopen(rows, "rb");
    FILE *out = in != NULL ? fopen(part, "wb") : NULL;
    int whole = out != NULL;

    if (whole) {
        print_head(out, options, teeth);
        whole = copy_rows(out, in);
    }
    if (out != NULL && fclose(out) != 0)
        whole = 0;
    if (in != NULL)
        fclose(in);
    return whole ? EXIT_DONE : complain(part, "written");
}

/* Rows -> FILE.rows -> FILE.part with a head -> FILE, which is not touched before it is whole. */
static int finish(const char *path, const char *rows, const flanks_options *options, int teeth) {
    char *part = with_ending(path, ".part");
    int status = part != NULL ? join(part, rows, options, teeth) : EXIT_RUN_FAILED;

    if (status == EXIT_DONE && rename(part, path) != 0)
        status = complain(path, "written");
    if (status != EXIT_DONE && part != NULL)
        remove(part);
    free(part);
    return status;
}

static int write_file(const char *path, const flanks_options *options,
                      const gm_deviations *deviations, const gm_pitch *pitch) {
    const int teeth = deviations != NULL ? deviations->teeth : pitch->teeth;
    char *rows = with_ending(path, ".rows");
    gm_io_error error;
    int status = EXIT_RUN_FAILED;

    if (rows == NULL)
        return status;
    if ((deviations != NULL ? gm_deviations_write(deviations, rows, &error)
                            : gm_pitch_write(pitch, rows, &error)) == GM_IO_OK)
        status = finish(path, rows, options, teeth);
    else
        fprintf(stderr, "%s: %s\n", path, error.text);
    remove(rows);
    free(rows);
    return status;
}

int make_flanks(const flanks_options *options, const gm_pair *pair) {
    gm_deviations deviations;
    gm_pitch pitch;
    gm_io_error error;
    int status =
        gm_flanks_generate(&deviations, &pitch, pair, options->wheel, &options->generate, &error);

    if (status != GM_IO_OK) {
        fprintf(stderr, "gearflanks: %s\n", error.text);
        return status == GM_IO_ERR_MEMORY ? EXIT_RUN_FAILED : EXIT_BAD_INPUT;
    }
    status = write_file(options->deviations, options, &deviations, NULL);
    if (status == EXIT_DONE)
        status = write_file(options->pitch, options, NULL, &pitch);
    gm_deviations_free(&deviations);
    gm_pitch_free(&pitch);
    return status;
}
