/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What the programs ask of the system beyond the C library: platform_posix.c or platform_windows.c. No other file knows
 * which of them it is. Calls that both have under one name (stat, access, close, dup, write and their like) are used as
 * they are.
 */
#ifndef APPS_PLATFORM_H
#define APPS_PLATFORM_H

#include <stddef.h>
#include <stdio.h>

/* ---------------------------------------------------------------------------------------------
 * The process
 * ------------------------------------------------------------------------------------------- */

/*
 * Opens those of the descriptors 0 to 2 that the caller has closed, so that no file gets their numbers, and messages
 * with it. Writes beyond the limit on file sizes, and to a pipe that nobody reads, fail with an error from now on
 * instead of killing the process. Files have the bytes that are written. The first call of main(). Returns EXIT_DONE
 * or EXIT_RUN_FAILED.
 */
int process_prepare(void);

/* What the same signal does when it comes again: a run whose step takes for ever can be killed, a short one that has
 * to put files in order cannot. */
enum interrupt_second { SECOND_KILLS, SECOND_WAITS };

/* From now on Ctrl-C, SIGTERM, SIGHUP and their like are noted, to end a run at its next step, instead of killing it. */
void interrupt_watch(enum interrupt_second second);

/* Gives the signals back to whoever had them. */
void interrupt_unwatch(void);

int interrupt_requested(void);

/*
 * Calls work(of, 0) to work(of, count - 1), count <= THREADS_MAX, each in a thread of its own, the first one here; one
 * for which there is no thread is called here as well. Returns when all are done.
 */
enum { THREADS_MAX = 64 };
void threads_run(int count, void (*work)(void *of, int which), void *of);

/* Seconds of a clock that nobody sets, from an arbitrary origin. */
double wall_clock(void);

/* Whether a person sees the stream, and a line on it can be wiped (ESC [K). 0 or 1. */
int is_terminal(FILE *stream);

/* ---------------------------------------------------------------------------------------------
 * Paths
 * ------------------------------------------------------------------------------------------- */

/* Characters of a path before the name of its file, the sign between both included; 0: no folder is named. */
size_t path_name_start(const char *path);

int path_is_absolute(const char *path);

/* Whether two names in one folder are those of one file. 0 or 1. */
int is_same_name(const char *a, const char *b);

/* Whether two paths lead to one file, also by links. 0 or 1. */
int is_same_file(const char *a, const char *b);

/* Where the link at the path leads, as text; 0: it is no link, or not one that can be read. 1 otherwise. */
int path_read_link(const char *path, char *text, size_t size);

/* What a path names, which is not followed if it is a link. */
enum path_kind { PATH_NOTHING, PATH_LINK, PATH_TAKEN, PATH_UNKNOWN };
enum path_kind path_kind(const char *path);

/* Why no file can be made in a folder, as an errno; 0: nothing is known against it. */
int folder_refusal(const char *folder);

/* ---------------------------------------------------------------------------------------------
 * Files that become results
 * ------------------------------------------------------------------------------------------- */

/* A new file, to read and write, or the one that is there; neither follows a link. The descriptor, or -1 with errno. */
int file_create(const char *path);
int file_open_old(const char *path);

/* A second descriptor of an open file, for this process alone; -1 with errno. */
int file_duplicate(int descriptor);

/* Locks an open file as long as it is open here. 0: locked, or the file system has no locks; -1: another run has it. */
int file_lock(int descriptor);

/* Whether the path, not followed, is the file that is open: 1 or 0, or -1 if that cannot be told, with errno. */
int file_is_at(const char *path, int descriptor);

/* Brings a file, and the names in a folder, to the disk. 0, or an errno. */
int file_sync(int descriptor);
int folder_sync(const char *folder);

/* Gives the file another name, in the place of a file that has it. 0, or an errno. */
int file_rename(const char *path, const char *name);

/* Gives the file a second name that no file has. 0, or an errno. */
int file_link(const char *path, const char *name);

#endif
