/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The file of `output.load_distribution`: line load, pressure and gap of each station that a line of contact passes, as
 * CSV. It grows in FILE.part and gets its name when it is whole, as the result.
 */
#ifndef GEARSIM_LOAD_FILE_H
#define GEARSIM_LOAD_FILE_H

#include "config.h"
#include "result_file.h"

typedef struct load_file load_file;

/* Checks that the file can be written, without touching one. 0, or EXIT_BAD_INPUT after a message; 0 without the key. */
int load_file_check(const config *conf);

/* Opens FILE.part and writes its head; *file is NULL without the key. Returns 0 or an exit code after a message. */
int load_file_open(load_file **file, const config *conf);

/* Rows of one position; `file` may be NULL. 0, or EXIT_RUN_FAILED (disk) after a message. */
int load_file_rows(load_file *file, double pinion_angle, double load,
                   const gm_line_load_point *points, int count);

/* Writes what is buffered still. 0, or EXIT_RUN_FAILED after a message. `file` may be NULL. */
int load_file_flush(load_file *file);

/* What gets its name together with the result of the run, after load_file_flush(). NULL without a file. */
result_file *load_file_result(load_file *file);

/* Frees the file. `incomplete`: FILE.part stays and says why; NULL: it says nothing. `file` may be NULL. */
void load_file_close(load_file *file, const char *incomplete);

#endif
