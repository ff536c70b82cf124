/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What output.c asks of a format of the result file. Names, places, messages, `.part` and the rename are
 * common to all; a format puts provenance, names and rows into the file that is open. That of HDF5 is a
 * module of its own, loaded where a name asks for it: its forty libraries take ten times as long to bind
 * as all the rest of gearsim.
 */
#ifndef GEARSIM_OUTPUT_FORMAT_H
#define GEARSIM_OUTPUT_FORMAT_H

#include "columns.h"
#include "output.h"
#include "result_file.h"

typedef struct output_format {
    const char *version; /* of gearsim: a module of another one has other structures */

    /* Writes all that precedes the rows, to the disk: a full one is found before the run, not after it. */
    int (*begin)(output_file *output, const config *conf, const char *const names[]);

    int (*row)(output_file *output, const double values[]);

    /* Writes the rows that are left and, if there is a reason, that the file is not whole. Called whatever
     * became of begin() and the rows. */
    int (*end)(output_file *output, const char *incomplete);
} output_format;

/* All three return 0 or the errno of what failed. After that nothing more is written but the end. */
extern const output_format csv_format;

/* The one symbol of the module. */
extern const output_format gearsim_hdf5_format;

struct output_file {
    const output_format *format;
    message_sink *messages;
    void *memory; /* of the format, freed by its end() */
    result_file result;
    column_list columns;
    int digits;
    int is_stream;  /* standard output: no names, and nothing that was written comes back */
    int is_binary;  /* numbers of rows as they are in memory; a stream only */
    double rows;    /* written so far */
    double started; /* by wall_clock() */
    int error;      /* errno of the write that failed, 0 = none: nothing more is written */
};

#endif
