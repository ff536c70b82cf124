/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Reads tidy CSV. Whatever the file is, no more than one buffer of it is kept. */

#include "table_reader.h"

#include <errno.h>
#include <limits.h>
#include <string.h>

#include "flank_slot.h"
#include "io_error.h"
#include "number_text.h"

/* ---------------------------------------------------------------------------------------------
 * Lines
 * ------------------------------------------------------------------------------------------- */

static int is_blank(char c) {
    return c == ' ' || c == '\t';
}

static char *skip_blanks(char *text) {
    while (is_blank(*text)) {
        ++text;
    }
    return text;
}

static int fail(const gmi_table *table, const char *message) {
    return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line, "%s", message);
}

static int has_byte(const char *text, size_t length, char byte) {
    return memchr(text, byte, length) != NULL;
}

/* Moves what is left to the front of the buffer and reads more behind it: 1 = there is more, 0 = end of the file, < 0 =
 * gm_io_status. */
static int refill(gmi_table *table) {
    const size_t left = table->end - table->begin;
    memmove(table->buffer, table->buffer + table->begin, left);
    table->begin = 0;

    errno = 0;
    table->end = left + fread(table->buffer + left, 1, GMI_BUFFER_SIZE - left, table->file);
    if (ferror(table->file)) {
        return gmi_error_file(table->error, left > 0 ? table->line : 0, "read", errno);
    }

    /* Most files have neither, which is seen here for many lines at once. */
    const char *added = table->buffer + left;
    const size_t length = table->end - left;
    table->is_odd = (left > 0 && table->is_odd) || has_byte(added, length, '\0') ||
                    has_byte(added, length, '\r');
    return table->end > left;
}

/* The end of the line that begins at `begin`, read up to there; NULL at the end of the file, or where the line is longer
 * than what is kept. */
static char *find_end(gmi_table *table, int *status) {
    size_t seen = 0;
    *status = 1;
    for (;;) {
        char *begin = table->buffer + table->begin;
        char *end = memchr(begin + seen, '\n', table->end - table->begin - seen);
        seen = table->end - table->begin;
        if (end != NULL || seen > GMI_LINE_LENGTH + 1) {
            return end;
        }
        *status = refill(table);
        if (*status <= 0) {
            return NULL;
        }
    }
}

static int fail_zero(const gmi_table *table) {
    return fail(table,
                "the file must be plain UTF-8 text with comma separated values (got a zero byte)");
}

/* Reads over the rest of a line whose first characters stay at the front of the buffer. */
static int skip_rest(gmi_table *table) {
    const size_t kept = GMI_LINE_LENGTH + 1; /* with its end */
    memmove(table->buffer, table->text, kept);
    table->text = table->buffer;
    table->is_odd = 1; /* what is read here is looked at line by line */

    for (;;) {
        const char *rest = table->buffer + table->begin;
        const size_t size = table->end - table->begin;
        const char *end = memchr(rest, '\n', size);
        if (has_byte(rest, end != NULL ? (size_t)(end - rest) : size, '\0')) {
            return fail_zero(table);
        }
        if (end != NULL) {
            table->begin += (size_t)(end - rest) + 1;
            return 1;
        }

        errno = 0;
        table->begin = kept;
        table->end = kept + fread(table->buffer + kept, 1, GMI_BUFFER_SIZE - kept, table->file);
        if (ferror(table->file)) {
            return gmi_error_file(table->error, table->line, "read", errno);
        }
        if (table->end == kept) {
            return 1;
        }
    }
}

/* A line of more than what is kept: right if it is a comment, of which the beginning stays. */
static int read_long_line(gmi_table *table) {
    if (has_byte(table->text, GMI_LINE_LENGTH + 1, '\0')) {
        return fail_zero(table);
    }
    if (*skip_blanks(table->text) != '#') {
        return gmi_error_set(
            table->error, GM_IO_ERR_FORMAT, table->line,
            "a line must be one row of at most %d characters, ended by LF or CRLF (got more)",
            GMI_LINE_LENGTH);
    }
    return skip_rest(table);
}

static void drop_byte_order_mark(gmi_table *table) {
    if (strncmp(table->text, "\xEF\xBB\xBF", 3) == 0) {
        table->text += 3;
    }
}

int gmi_lines_next(gmi_table *table) {
    ++table->line;
    int status = 1;
    const char *end = find_end(table, &status);
    size_t length = (end != NULL ? (size_t)(end - table->buffer) : table->end) - table->begin;
    if (status < 0 || (length == 0 && end == NULL)) {
        --table->line;
        return status;
    }
    table->text = table->buffer + table->begin;

    if (length > GMI_LINE_LENGTH) {
        length = GMI_LINE_LENGTH;
        status = read_long_line(table);
    } else if (table->is_odd && has_byte(table->text, length, '\0')) {
        status = fail_zero(table);
    } else {
        table->begin += length + (end != NULL);
        status = 1;
    }
    if (status < 0) {
        return status;
    }

    /* The end of the line goes; a carriage return elsewhere is that of an old Macintosh, or of damage. */
    if (length > 0 && table->text[length - 1] == '\r') {
        --length;
    }
    table->text[length] = '\0';
    if (table->is_odd && has_byte(table->text, length, '\r')) {
        return fail(table,
                    "lines must end with LF or CRLF (got a carriage return within the line)");
    }
    if (table->line == 1) {
        drop_byte_order_mark(table);
    }
    return 1;
}

/* The next line that is neither blank nor a comment. */
int gmi_table_line(gmi_table *table) {
    for (;;) {
        const int status = gmi_lines_next(table);
        if (status <= 0) {
            return status;
        }
        const char begin = *skip_blanks(table->text);
        if (begin != '\0' && begin != '#') {
            return 1;
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * Fields
 * ------------------------------------------------------------------------------------------- */

/* A field without the blanks around it, which is ended where they begin. */
static char *trim(char *field, char *end) {
    field = skip_blanks(field);
    while (end > field && is_blank(end[-1])) {
        --end;
    }
    *end = '\0';
    return field;
}

/* A decimal comma becomes a point. */
static char *with_point(char *field) {
    char *comma = strchr(field, ',');
    if (comma != NULL) {
        *comma = '.';
    }
    return field;
}

/* Cuts the line at its commas, or semicolons, and returns the number of fields, also where they are too many. */
static int split_fields(gmi_table *table) {
    const int with_comma = table->style == GM_DECIMAL_COMMA;
    char *last = table->text + strlen(table->text);
    int count = 0;
    for (char *field = table->text; field != NULL; ++count) {
        char *end = strchr(field, with_comma ? ';' : ',');
        if (count < table->column_count) {
            char *trimmed = trim(field, end != NULL ? end : last);
            table->fields[count] = with_comma ? with_point(trimmed) : trimmed;
        }
        field = end != NULL ? end + 1 : NULL;
    }
    return count;
}

/* The names of all columns as they stand in a header. */
static const char *columns_text(const gmi_table *table, const char *const *columns,
                                char text[GMI_LINE_LENGTH]) {
    text[0] = '\0';
    for (int i = 0; i < table->column_count; ++i) {
        strcat(text, i > 0 ? "," : "");
        strcat(text, columns[i]);
    }
    return text;
}

/* Every header that would be right; they are few and short. */
static const char *header_text(const gmi_table *table, char text[GMI_LINE_LENGTH]) {
    text[0] = '\0';
    for (int i = 0; i < table->header_count; ++i) {
        char header[GMI_LINE_LENGTH];
        strcat(text, i > 0 ? " or " : "");
        strcat(text, columns_text(table, table->headers[i], header));
    }
    return text;
}

/* A delimiter that is used in place of the comma, as spreadsheets of some countries do; or NULL. */
static const char *other_delimiter(const gmi_table *table, const char *line) {
    if (table->style == GM_DECIMAL_COMMA) {
        return strchr(line, ';') == NULL && strchr(line, ',') != NULL ? "commas" : NULL;
    }
    if (strchr(line, ';') != NULL) {
        return "semicolons";
    }
    if (strchr(line, ',') == NULL && strchr(line, '\t') != NULL) {
        return "tabs";
    }
    return NULL;
}

static int fail_delimiter(const gmi_table *table, const char *delimiter) {
    gmi_error_option(table->error, "style");
    return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line,
                         "fields must be separated by %s as decimal sign (got %s)",
                         table->style == GM_DECIMAL_COMMA ? "semicolons, with a comma"
                                                          : "commas, with a point",
                         delimiter);
}

static int fail_field_count(const gmi_table *table, int count) {
    char header[GMI_LINE_LENGTH];
    return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line,
                         "a row must have %d fields, %s (got %d%s)", table->column_count,
                         columns_text(table, table->columns, header), count,
                         count > table->column_count && table->style == GM_DECIMAL_POINT
                             ? "; a decimal comma makes two fields of one number: write 1.5"
                             : "");
}

int gmi_table_split(gmi_table *table) {
    const char *delimiter = other_delimiter(table, table->text);
    if (delimiter != NULL) {
        return fail_delimiter(table, delimiter);
    }
    const int count = split_fields(table);
    return count == table->column_count ? 1 : fail_field_count(table, count);
}

int gmi_table_next(gmi_table *table) {
    const int status = gmi_table_line(table);
    return status <= 0 ? status : gmi_table_split(table);
}

/* ---------------------------------------------------------------------------------------------
 * Header
 * ------------------------------------------------------------------------------------------- */

/* Length of a column's name without its unit; 0 = it has none. */
static size_t quantity_length(const char *column) {
    const char *end = strrchr(column, '_');
    const int has_unit = end != NULL && (strcmp(end, "_um") == 0 || strcmp(end, "_mm") == 0);
    return has_unit ? (size_t)(end - column) : 0;
}

/* Whether a field of the header is this column without its unit, or with another one. */
static int lacks_unit(const char *field, const char *column) {
    const size_t length = quantity_length(column);
    return length > 0 && strncmp(field, column, length) == 0 && strcmp(field, column) != 0 &&
           strchr("_ ([", field[length]) != NULL; /* also at the end of the field */
}

/* The column that a field of the header should have been, were it not for the unit; or NULL. */
static const char *column_with_unit(const gmi_table *table, const char *field) {
    for (int i = 0; i < table->header_count; ++i) {
        for (int k = 0; k < table->column_count; ++k) {
            if (lacks_unit(field, table->headers[i][k])) {
                return table->headers[i][k];
            }
        }
    }
    return NULL;
}

/* Names the first field whose unit is missing or another one; empty if there is none. */
static const char *unit_hint(const gmi_table *table, int count, char text[GMI_LINE_LENGTH]) {
    text[0] = '\0';
    for (int i = 0; i < count && i < table->column_count; ++i) {
        const char *column = column_with_unit(table, table->fields[i]);
        if (column != NULL) {
            char quoted[GMI_QUOTE_SIZE];
            snprintf(text, GMI_LINE_LENGTH,
                     " (%s has no unit or another one: values and name as in %s)",
                     gmi_quote(quoted, table->fields[i]), column);
            break;
        }
    }
    return text;
}

/* `count`: of the fields in the header. */
static int fail_header(const gmi_table *table, const char *line, int count) {
    const char *delimiter = other_delimiter(table, line);
    if (delimiter != NULL) {
        return fail_delimiter(table, delimiter);
    }
    char header[GMI_LINE_LENGTH];
    char hint[GMI_LINE_LENGTH];
    char quoted[GMI_QUOTE_SIZE];
    const int is_row = strchr("*+-.0123456789", line[0]) != NULL;
    return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line,
                         "the header must be %s (got %s%s)%s", header_text(table, header),
                         is_row ? "the row " : "", gmi_quote(quoted, line),
                         unit_hint(table, count, hint));
}

static int has_columns(const gmi_table *table, const char *const *columns) {
    for (int i = 0; i < table->column_count; ++i) {
        if (strcmp(table->fields[i], columns[i]) != 0) {
            return 0;
        }
    }
    return 1;
}

static int read_header(gmi_table *table, int *which) {
    const int status = gmi_table_line(table);
    if (status < 0) {
        return status;
    }
    if (status == 0) {
        char header[GMI_LINE_LENGTH];
        return gmi_error_set(
            table->error, GM_IO_ERR_FORMAT, table->line,
            "the file must have the header line %s and rows below it (got nothing)",
            header_text(table, header));
    }
    char line[GMI_LINE_LENGTH + 1]; /* as it was before it is cut into fields */
    strcpy(line, skip_blanks(table->text));

    const int count = split_fields(table);
    for (int i = 0; count == table->column_count && i < table->header_count; ++i) {
        if (has_columns(table, table->headers[i])) {
            table->columns = table->headers[i];
            *which = i;
            return GM_IO_OK;
        }
    }
    return fail_header(table, line, count);
}

int gmi_lines_open(gmi_table *table, const char *path, gm_io_error *error) {
    table->error = error;
    table->line = 0;
    table->begin = table->end = 0;
    table->text = table->buffer;

    errno = 0;
    table->file = fopen(path, "rb");
    return table->file != NULL ? GM_IO_OK : gmi_error_file(error, 0, "opened", errno);
}

int gmi_table_open_any(gmi_table *table, const char *path, const char *const *const *headers,
                       int header_count, int column_count, int style, int *which,
                       gm_io_error *error) {
    table->columns = headers[0];
    table->column_count = column_count;
    table->headers = headers;
    table->header_count = header_count;
    table->style = style;

    int status = gmi_lines_open(table, path, error);
    if (status == GM_IO_OK) {
        status = read_header(table, which);
    }
    table->headers = NULL;
    table->header_count = 0;
    return status;
}

int gmi_table_open(gmi_table *table, const char *path, const char *const *columns, int column_count,
                   gm_io_error *error) {
    int which = 0;
    return gmi_table_open_any(table, path, &columns, 1, column_count, GM_DECIMAL_POINT, &which,
                              error);
}

void gmi_table_close(gmi_table *table) {
    if (table->file != NULL) {
        fclose(table->file); /* only read from: nothing can be lost */
        table->file = NULL;
    }
}

/* ---------------------------------------------------------------------------------------------
 * Values
 * ------------------------------------------------------------------------------------------- */

/* Reads digits and nothing else; a number beyond int becomes INT_MAX. */
static int parse_whole_number(const char *text, int *value) {
    if (*text == '\0') {
        return 0;
    }
    *value = 0;
    for (; *text >= '0' && *text <= '9'; ++text) {
        const int digit = *text - '0';
        *value = *value > (INT_MAX - digit) / 10 ? INT_MAX : 10 * *value + digit;
    }
    return *text == '\0';
}

int gmi_table_tooth(const gmi_table *table, int column, int teeth, int *tooth) {
    const char *field = table->fields[column];
    if (field[0] == '*' && field[1] == '\0') {
        *tooth = GMI_ALL;
        return GM_IO_OK;
    }

    int value = 0;
    if (!parse_whole_number(field, &value) || value >= teeth) {
        char quoted[GMI_QUOTE_SIZE];
        return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line,
                             "%s: must be a whole number from 0 to %d (the gear has %d teeth), or "
                             "* for all teeth (got %s)",
                             table->columns[column], teeth - 1, teeth, gmi_quote(quoted, field));
    }
    *tooth = value;
    return GM_IO_OK;
}

int gmi_table_whole(const gmi_table *table, int column, int *value) {
    if (parse_whole_number(table->fields[column], value)) {
        return GM_IO_OK;
    }
    char quoted[GMI_QUOTE_SIZE];
    return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line,
                         "%s: must be a whole number (got %s)", table->columns[column],
                         gmi_quote(quoted, table->fields[column]));
}

int gmi_table_word(const gmi_table *table, int column, const char *const *words, int word_count,
                   int *which) {
    char right[GMI_LINE_LENGTH] = "";
    for (int i = 0; i < word_count; ++i) {
        if (strcmp(table->fields[column], words[i]) == 0) {
            *which = i;
            return GM_IO_OK;
        }
        strcat(right, i == 0 ? "" : i == word_count - 1 ? " or " : ", ");
        strcat(right, words[i]);
    }
    char quoted[GMI_QUOTE_SIZE];
    return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line, "%s: must be %s (got %s)",
                         table->columns[column], right, gmi_quote(quoted, table->fields[column]));
}

int gmi_table_flank(const gmi_table *table, int column, int *side) {
    const char *field = table->fields[column];
    for (int candidate = GMI_ALL; candidate <= GM_COAST; ++candidate) {
        const char *name = gmi_side_name(candidate);
        if (field[0] == name[0] && strcmp(field, name) == 0) {
            *side = candidate;
            return GM_IO_OK;
        }
    }
    char quoted[GMI_QUOTE_SIZE];
    return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line,
                         "%s: must be drive, coast, or * for both (got %s)", table->columns[column],
                         gmi_quote(quoted, field));
}

int gmi_table_number(const gmi_table *table, int column, int exponent, double *value) {
    const char *field = table->fields[column];
    const int status = gmi_number_parse(field, exponent, value);
    if (status == GMI_NUMBER_OK) {
        return GM_IO_OK;
    }
    char quoted[GMI_QUOTE_SIZE];
    return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line,
                         "%s: must be a number like 1.5 or -2e-3 (got %s%s)",
                         table->columns[column], gmi_quote(quoted, field),
                         status == GMI_NUMBER_TOO_LARGE ? ", which is too large" : "");
}
