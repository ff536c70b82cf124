/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* What is at a path. */
#ifndef APPS_PATHS_H
#define APPS_PATHS_H

/* Whether two paths name one file, also one that is not there yet. 0 or 1. */
int is_same_place(const char *a, const char *b);

/* The path, or where it leads if it is a symbolic link, be there a file or not. To be freed; NULL: errno says why. */
char *path_behind_links(const char *path);

/* The folder of a path, "." if it names none. To be freed; NULL: out of memory. */
char *path_folder(const char *path);

/* Why what is at `path` cannot become a result, NULL if it can or nothing is there. A device or pipe would be
 * replaced by a file. */
const char *path_obstacle(const char *path);

#endif
