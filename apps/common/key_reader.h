/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Reads an INI file into the struct that a table of keys fills. Faults are told as they are met, as
 * `file:line: section.key: must be WHAT IS RIGHT (got VALUE)`, and counted.
 */
#ifndef APPS_KEY_READER_H
#define APPS_KEY_READER_H

#include "key_table.h"
#include "messages.h"

typedef struct key_reader {
    const key_table *table;
    void *filled;       /* what the table fills, with its defaults at first */
    key_entry *entries; /* [table->count] what was given, and where; all zero at first */
    const char *path;   /* of the INI file */
    message_sink *messages;

    int faults;
    int no_memory; /* reading has ended for want of memory */

    enum key_origin from; /* where values come from now */
    int line;             /* in the file, 0 = none */

    const char *section; /* of the lines that follow, NULL = unknown or none yet */
    int in_section;      /* after the first section line */
    int *section_lines;  /* [table->count] where the section that begins with this key was met */
} key_reader;

/* The whole file. */
void key_reader_read(key_reader *reader);

/*
 * A value from elsewhere, in place of that of the file: origin and line are to be set before. An empty one takes the
 * value back, as if the key had never been given.
 */
void key_reader_set(key_reader *reader, const char *section, const char *name, const char *value);

/* Tells a fault in what is being read: place, name (may be empty), text. */
void key_reader_fault(key_reader *reader, const char *name, const char *format, ...);

/* How a message about a value begins: where it was given, and its name (may be empty). */
enum { KEY_PLACE_SIZE = 4352 };
void key_place(char place[KEY_PLACE_SIZE], const char *path, enum key_origin origin, int line,
               const char *name);

void key_entries_free(key_entry *entries, int count);

#endif
