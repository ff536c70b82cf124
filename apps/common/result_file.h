/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * A result that replaces FILE as a whole or not at all. It grows in FILE.part beside it, and gets the name FILE when it
 * is complete and on the disk.
 *
 * FILE.part is always a new file, never one that was there before, and locked by the kernel as long as the run lives:
 * a second run with the same FILE is refused, what a dead run has left is replaced. Where FILE is a symbolic link, the
 * file that it names is replaced, and the link stays; where FILE.part is one, the run is refused.
 */
#ifndef APPS_RESULT_FILE_H
#define APPS_RESULT_FILE_H

#include <stddef.h>

enum { RESULT_FILE_REASON_SIZE = 160 };

typedef struct result_file {
    char *path; /* FILE, behind all links */
    char *part; /* FILE.part */
    char *old;  /* second name of an old FILE while others are replaced, NULL = none */
    int data;   /* descriptor to write the result to; -1 = none */
    int lock; /* second descriptor of FILE.part: keeps the lock when `data` is closed; -1 = none */

    /* After a failure: which of the files, and what is wrong with it, such as "is a folder; name a file". */
    const char *wrong_path;
    char reason[RESULT_FILE_REASON_SIZE];
} result_file;

/* Whether a result FILE would replace this input, by itself or by FILE.part. 0 or 1. */
int result_file_would_replace(const char *path, const char *input);

/*
 * Finds the names and checks that they can be written, without touching a file. The struct needs no preparation, and
 * result_file_free() afterwards, whatever came back: EXIT_DONE, EXIT_BAD_INPUT, or EXIT_RUN_FAILED (memory).
 */
int result_file_check(result_file *file, const char *path);

/* Creates and locks FILE.part after the check. EXIT_DONE, EXIT_BAD_INPUT (also: another run writes it) or EXIT_RUN_FAILED. */
int result_file_open(result_file *file);

/*
 * Brings the files to the disk and gives them their names: all of them, or none where one fails. Nothing may be
 * buffered any more. Returns EXIT_DONE or EXIT_RUN_FAILED; *wrong is the file that has the reason.
 */
int result_files_replace(result_file *const files[], int count, const result_file **wrong);

/* Removes FILE.part, if it is still the one that was opened. */
void result_file_remove(result_file *file);

/* Closes FILE.part, which stays if it has not become FILE, and frees the names. */
void result_file_free(result_file *file);

#endif
