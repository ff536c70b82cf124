/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "make.h"
#include "report.h"
#include "scatter.h"
#include "write.h"

/* What is made, and from what. */
typedef struct making {
    const flanks_options *options;
    gm_generate_options generate;
    scatter_file scatter; /* entries = NULL: of a class */
    gm_deviations deviations;
    gm_pitch pitch;
} making;

/* How the flanks were made, so that a file says where it comes from. */
static void print_head(FILE *file, const void *context) {
    const making *of = context;
    const gm_generate_options *generate = &of->generate;

    fprintf(file, "# Made, not measured: gearflanks %s, %s of %d teeth, ", gm_version(),
            of->options->wheel ? "wheel" : "pinion", of->pitch.teeth);
    if (generate->scatter != NULL) {
        fputs("scatter from tooth to tooth\n", file);
    } else {
        fprintf(file, "ISO 1328-1 class %d, share %g\n", generate->quality_class, generate->share);
    }

    /* All that the same flanks need to be made again. */
    fprintf(file, "# seed %llu, nodes %dx%d\n", (unsigned long long)generate->seed,
            generate->face_nodes, generate->profile_nodes);
    if (generate->scatter != NULL) {
        scatter_print(&of->scatter, file);
    }
    for (int i = 0; i < generate->wave_count; ++i) {
        fprintf(file, "# wave of order %d, %g um\n", generate->waves[i].order,
                1e6 * generate->waves[i].amplitude);
    }
}

static int generate(making *of, const gm_pair *pair) {
    gm_io_error error;
    const int status = gm_flanks_generate(&of->deviations, &of->pitch, pair, of->options->wheel,
                                          &of->generate, &error);

    return status == GM_IO_OK ? EXIT_DONE : refuse_input(of->options->messages, status, &error);
}

static int make_and_write(making *of, const gm_pair *pair) {
    const written files[] = {{of->options->deviations, &of->deviations, NULL, print_head, of},
                             {of->options->pitch, NULL, &of->pitch, print_head, of}};
    int status = generate(of, pair);

    if (status != EXIT_DONE) {
        return status;
    }
    status = write_files(files, 2, of->options->messages);
    if (status == EXIT_DONE) {
        status = report_quality(of->options, pair, &of->deviations, &of->pitch);
    }
    gm_deviations_free(&of->deviations);
    gm_pitch_free(&of->pitch);
    return status;
}

int make_flanks(const flanks_options *options, const gm_pair *pair) {
    making of = {.options = options, .generate = options->generate};
    int status = EXIT_DONE;

    if (options->scatter != NULL) {
        status = scatter_read(&of.scatter, options->scatter, options->messages);
        of.generate.scatter = &of.scatter.amounts;
    }
    if (status == EXIT_DONE) {
        status = make_and_write(&of, pair);
    }
    scatter_free(&of.scatter);
    return status;
}
