/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* What is at a path. */
#ifndef APPS_PATHS_H
#define APPS_PATHS_H

/* Whether two paths lead to one file, also by links. 0 or 1. */
int is_same_file(const char *a, const char *b);

/* Why what is at `path` cannot become a result, NULL if it can or nothing is there. A device or pipe would be
 * replaced by a file. */
const char *path_obstacle(const char *path);

#endif
