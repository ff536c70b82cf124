/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The text of an INI file, line by line: UTF-8, byte order mark and CRLF accepted; `;` and `#` begin a
 * comment, also after white space behind a value; no continuation lines.
 */
#ifndef APPS_INI_FILE_H
#define APPS_INI_FILE_H

/* What the reader meets, in the order of the file. Strings live as long as the call. */
typedef struct ini_events {
    void *user;
    void (*section)(void *user, int line, const char *section);
    void (*value)(void *user, int line, const char *name, const char *value);
    void (*fault)(void *user, int line, const char *text); /* line 0: the file as a whole */
} ini_events;

/* The path "-" is standard input. What is wrong with the file is told by events->fault. */
enum ini_result { INI_READ, INI_NO_MEMORY };
enum ini_result ini_file_read(const char *path, const ini_events *events);

#endif
