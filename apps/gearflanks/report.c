/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "report.h"
#include "memory.h"
#include "write.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct measured {
    const gm_deviations *deviations; /* NULL = no file */
    const gm_pitch *pitch;
    gm_deviations deviation_storage;
    gm_pitch pitch_storage;
} measured;

static void close_files(measured *of) {
    gm_deviations_free(&of->deviation_storage);
    gm_pitch_free(&of->pitch_storage);
}

/* Files of the command line win as a pair over those of the INI file. */
static int open_files(measured *of, const flanks_options *options, const flank_files *files,
                      int teeth) {
    const int given = options->deviations != NULL || options->pitch != NULL;
    const char *deviations = given ? options->deviations : files->deviations;
    const char *pitch = given ? options->pitch : files->pitch;

    memset(of, 0, sizeof *of);
    if (deviations == NULL && pitch == NULL) {
        message_of_program(options->messages,
                           "nothing to evaluate: neither --flanks or --pitch nor [flanks] of %s "
                           "name a file of the %s",
                           options->parameters, options->wheel ? "wheel" : "pinion");
        return EXIT_BAD_INPUT;
    }

    gm_io_error error;
    if (deviations != NULL) {
        const int status = gm_deviations_read(&of->deviation_storage, deviations, teeth, &error);
        if (status != GM_IO_OK) {
            return refuse_input(options->messages, status, &error);
        }
        of->deviations = &of->deviation_storage;
    }

    if (pitch != NULL) {
        const int status = gm_pitch_read(&of->pitch_storage, pitch, teeth, &error);
        if (status != GM_IO_OK) {
            close_files(of);
            return refuse_input(options->messages, status, &error);
        }
        of->pitch = &of->pitch_storage;
    }
    return EXIT_DONE;
}

/* ---------------------------------------------------------------------------------------------
 * Worst values
 * ------------------------------------------------------------------------------------------- */

static const char *class_text(char text[16], int quality_class) {
    if (quality_class == 0) {
        strcpy(text, "-");
    } else if (quality_class > GM_QUALITY_WORST_CLASS) {
        snprintf(text, 16, ">%d", GM_QUALITY_WORST_CLASS);
    } else {
        snprintf(text, 16, "%d", quality_class);
    }
    return text;
}

static const char *flank_name(int side) {
    return side == GM_DRIVE ? "drive" : side == GM_COAST ? "coast" : "-";
}

static void print_kind(const gm_pair *pair, int wheel, int kind, const gm_quality_value *worst) {
    const int held = worst->quality_class >= GM_QUALITY_BEST_CLASS &&
                     worst->quality_class <= GM_QUALITY_WORST_CLASS;
    const double tolerance =
        gm_quality_tolerance(pair, wheel, kind, held ? worst->quality_class : 11);
    char quality_class[16];
    char tooth[16] = "-";

    if (worst->tooth >= 0) {
        snprintf(tooth, sizeof tooth, "%d", worst->tooth);
    }
    class_text(quality_class, worst->quality_class);
    if (worst->quality_class == 0) {
        printf("%-10s %9s %6s %6s %6s %13s\n", gm_quality_symbol(kind), "-", "-", "-", "-", "-");
    } else {
        printf("%-10s %9.3f %6s %6s %6s %13.1f\n", gm_quality_symbol(kind), 1e6 * worst->value,
               tooth, flank_name(worst->side), quality_class, 1e6 * tolerance);
    }
}

static void print_quality(const gm_quality *quality, const gm_pair *pair, int wheel, int teeth) {
    char text[16];

    printf("# %s of %d teeth, ISO 1328-1:2013\n", wheel ? "wheel" : "pinion", teeth);
    if (!gm_quality_is_in_scope(pair, wheel)) {
        puts("# outside the ranges of the standard: its formulae are used all the same");
    }
    printf("%-10s %9s %6s %6s %6s %13s\n", "quantity", "value_um", "tooth", "flank", "class",
           "tolerance_um");
    for (int kind = 0; kind < GM_QUALITY_KINDS; ++kind) {
        print_kind(pair, wheel, kind, &quality->worst[kind]);
    }
    printf("class %s\n", class_text(text, quality->quality_class));
}

/* ---------------------------------------------------------------------------------------------
 * Every flank
 * ------------------------------------------------------------------------------------------- */

/* Nothing where nothing was evaluated. */
static void print_value(double value) {
    if (isnan(value)) {
        putchar(',');
    } else {
        printf(",%.4f", 1e6 * value);
    }
}

static void print_teeth(const gm_flank_quality *flanks, int teeth) {
    puts("tooth,flank,single_pitch_um,cumulative_pitch_um,f_H_alpha_um,f_f_alpha_um,F_alpha_um,"
         "f_H_beta_um,f_f_beta_um,F_beta_um");
    for (int i = 0; i < 2 * teeth; ++i) {
        const gm_flank_quality *flank = &flanks[i];
        const double values[] = {flank->single_pitch, flank->cumulative_pitch, flank->profile_slope,
                                 flank->profile_form, flank->profile_total,    flank->helix_slope,
                                 flank->helix_form,   flank->helix_total};

        printf("%d,%s", i % teeth, flank_name(i / teeth));
        for (size_t k = 0; k < sizeof values / sizeof values[0]; ++k) {
            print_value(values[k]);
        }
        putchar('\n');
    }
}

/* ---------------------------------------------------------------------------------------------
 * The calls
 * ------------------------------------------------------------------------------------------- */

int report_quality(const flanks_options *options, const gm_pair *pair,
                   const gm_deviations *deviations, const gm_pitch *pitch) {
    const int teeth = options->wheel ? pair->wheel.teeth : pair->pinion.teeth;
    gm_flank_quality *flanks = allocate(2 * (size_t)teeth, sizeof *flanks);
    if (flanks == NULL) {
        return message_no_memory(options->messages);
    }

    gm_quality quality;
    gm_io_error error;
    int status = gm_quality_evaluate(&quality, flanks, pair, options->wheel, deviations, pitch,
                                     NULL, &error);

    if (status != GM_IO_OK) {
        status = refuse_input(options->messages, status, &error);
    } else if (options->teeth) {
        print_teeth(flanks, teeth);
    } else {
        print_quality(&quality, pair, options->wheel, teeth);
    }
    free(flanks);
    return status;
}

int report_flanks(const flanks_options *options, const gm_pair *pair, const flank_files *files) {
    measured of;
    int status =
        open_files(&of, options, files, options->wheel ? pair->wheel.teeth : pair->pinion.teeth);

    if (status == EXIT_DONE) {
        status = report_quality(options, pair, of.deviations, of.pitch);
        close_files(&of);
    }
    return status;
}
