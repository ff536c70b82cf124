/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* What a program needs of its process before it opens the first file. */
#ifndef APPS_PROCESS_H
#define APPS_PROCESS_H

/*
 * Opens those of the descriptors 0 to 2 that the caller has closed, so that no file gets their numbers, and messages
 * with it. Writes beyond the limit on file sizes, and to a pipe that nobody reads, fail with an error from now on
 * instead of killing the process. The first call of main(). Returns EXIT_DONE or EXIT_RUN_FAILED.
 */
int process_prepare(void);

#endif
