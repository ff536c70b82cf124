/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file table_reader.h
 * Reads a tidy CSV table line by line, in bounded memory whatever the file is.
 *
 * One header line, fields separated by commas, white space around a field is dropped. Blank lines and
 * lines that begin with `#` are skipped; CRLF and a UTF-8 byte order mark are accepted.
 */
#ifndef GEARMESH_TABLE_READER_H
#define GEARMESH_TABLE_READER_H

#include <stdio.h>

#include "gearmesh/gearmesh_io.h"

/** Longest line that is not a comment; real ones are shorter than 80. */
#define GMI_LINE_LENGTH 1000

/** What is read at a time. */
#define GMI_BUFFER_SIZE 16384

#define GMI_MAX_COLUMNS 6

typedef struct gmi_table {
    FILE *file;
    gm_io_error *error;
    const char *const *columns; /**< [column_count] names in the header, once it is read */
    int column_count;
    const char *const *const *headers; /**< [header_count] lists of columns; while it is opened */
    int header_count;
    long line;                     /**< line last read, from 1 */
    int style;                     /**< enum gm_number_style of fields and numbers */
    char *fields[GMI_MAX_COLUMNS]; /**< [column_count] of the row last read, within text */
    char *text;                    /**< the line last read, within the buffer */
    size_t begin, end;             /**< of what is in the buffer and not read yet */
    int is_odd;                    /**< a zero byte or a carriage return may be in it */
    char buffer[GMI_BUFFER_SIZE];
} gmi_table;

/** Opens a file and reads its header. Needs gmi_table_close() whatever it returns. */
int gmi_table_open(gmi_table *table, const char *path, const char *const *columns, int column_count,
                   gm_io_error *error);

/** The same where there is a choice of headers with as many columns; which = the one that is there. Fields and numbers
 *  are as in a style, enum gm_number_style. */
int gmi_table_open_any(gmi_table *table, const char *path, const char *const *const *headers,
                       int header_count, int column_count, int style, int *which,
                       gm_io_error *error);

/** Opens a file of lines that are no table. Needs gmi_table_close() whatever it returns. */
int gmi_lines_open(gmi_table *table, const char *path, gm_io_error *error);

/** Reads the next line into text, without its end: 1 = a line, 0 = end of the file, < 0 = gm_io_status. */
int gmi_lines_next(gmi_table *table);

/** Reads the next row into fields: 1 = a row, 0 = end of the file, < 0 = gm_io_status. */
int gmi_table_next(gmi_table *table);

/** The first half of that: the row as one text. */
int gmi_table_line(gmi_table *table);

/** The second half: cuts the text into fields, 1, or < 0 = gm_io_status. */
int gmi_table_split(gmi_table *table);

void gmi_table_close(gmi_table *table);

/** A field of the row as tooth number 0 .. teeth - 1, or GMI_ALL. */
int gmi_table_tooth(const gmi_table *table, int column, int teeth, int *tooth);

/** A field of the row as GM_DRIVE, GM_COAST or GMI_ALL. */
int gmi_table_flank(const gmi_table *table, int column, int *side);

/** A field of the row as a whole number >= 0; one beyond int becomes INT_MAX. */
int gmi_table_whole(const gmi_table *table, int column, int *value);

/** A field of the row as one of some words; which = its index. */
int gmi_table_word(const gmi_table *table, int column, const char *const *words, int word_count,
                   int *which);

/** A field of the row as a number times 10^exponent. */
int gmi_table_number(const gmi_table *table, int column, int exponent, double *value);

#endif /* GEARMESH_TABLE_READER_H */
