/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * inih splits a line into section, name and value; this file hands it the lines. How inih was built
 * (comment signs, byte order mark, continuation lines, length of a line) differs between distributions,
 * so each line is cleaned here first and a line that inih would split is refused.
 */
#include "ini_file.h"

#include <errno.h>
#include <ini.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum {
    LINE_SIZE = 4096,   /* longest line with its comment */
    LINE_LIMIT = 100000 /* more lines than any INI file has: something else was given */
};

typedef struct line_source {
    FILE *file;
    const ini_events *events;
    int line;    /* of the line read last, from 1 */
    int stopped; /* after a fault that leaves no sense in reading on */
    char text[LINE_SIZE];
} line_source;

static void report(line_source *source, const char *text) {
    source->events->fault(source->events->user, source->line, text);
}

static void stop(line_source *source, const char *text) {
    source->stopped = 1;
    report(source, text);
}

static void stop_unreadable(line_source *source) {
    char text[256];

    snprintf(text, sizeof text, "cannot be read: %s", strerror(errno));
    source->line = 0;
    stop(source, text);
}

static int is_blank(char c) {
    return c == ' ' || c == '\t';
}

/* The one fault that text of another kind (binary, UTF-16) shows first. */
static const char *forbidden(int c) {
    if (c == 0) {
        return "a NUL byte: the file is no UTF-8 text, save it as such";
    }
    if (c < ' ' && c != '\t') {
        return "a control character: the file is no plain text, save it as UTF-8 text";
    }
    return NULL;
}

/* Reads a line without its end into `text`. 0 at the end of the file, or after a fault. */
static int read_line(line_source *source) {
    int c = getc(source->file);
    if (c == EOF) {
        return 0;
    }
    ++source->line;

    size_t length = 0;
    for (; c != EOF && c != '\n'; c = getc(source->file)) {
        /* CRLF ends a line as LF does. */
        if (c == '\r') {
            c = getc(source->file);
            if (c == '\n') {
                break;
            }
            ungetc(c, source->file);
            stop(source, "a carriage return within a line: end lines with LF or CRLF");
            return 0;
        }

        /* What is no text, or more than there is room for, ends the reading. */
        if (forbidden(c) != NULL) {
            stop(source, forbidden(c));
            return 0;
        }
        if (length + 1 >= sizeof source->text) {
            stop(source, "the line is too long: at most 4095 characters");
            return 0;
        }

        source->text[length++] = (char)c;
    }
    source->text[length] = '\0';
    return 1;
}

/* The part of the line that means something: without byte order mark, comment and white space around. */
static char *significant_part(line_source *source) {
    static const char byte_order_mark[] = "\xEF\xBB\xBF";
    char *start = source->text;

    if (source->line == 1 && strncmp(start, byte_order_mark, 3) == 0) {
        start += 3;
    }
    while (is_blank(*start)) {
        ++start;
    }

    /* A comment begins where a word could. */
    char *end = start;
    for (; *end != '\0'; ++end) {
        const int at_word_start = end == start || is_blank(end[-1]);
        if (at_word_start && (*end == ';' || *end == '#')) {
            break;
        }
    }

    while (end > start && is_blank(end[-1])) {
        --end;
    }
    *end = '\0';
    return start;
}

/* Sections are reported here, because inih is silent about one without keys. */
static void report_section(line_source *source, char *text) {
    const size_t length = strlen(text);

    if (text[length - 1] != ']') {
        report(source, "a section must stand alone on its line, as in `[gears]`");
        return;
    }
    text[length - 1] = '\0';
    source->events->section(source->events->user, source->line, text + 1);
    text[length - 1] = ']';
}

/* Gives inih its next line (an ini_reader). */
static char *next_line(char *line, int size, void *stream) {
    line_source *source = stream;

    if (source->stopped || !read_line(source)) {
        return NULL;
    }
    if (source->line > LINE_LIMIT) {
        stop(source, "too many lines: this is no INI file of parameters");
        return NULL;
    }

    /* A line that inih would split is refused. */
    char *text = significant_part(source);
    if (strlen(text) + 3 > (size_t)size) {
        stop(source, "the line is too long: shorten it, or give the value with --set");
        return NULL;
    }

    if (*text == '[') {
        report_section(source, text);
    }
    memcpy(line, text, strlen(text) + 1);
    return line;
}

/* Takes a key from inih (an ini_handler). */
static int take_value(void *user, const char *section, const char *name, const char *value) {
    line_source *source = user;

    (void)section; /* inih cuts long ones; report_section() has told the whole */
    source->events->value(source->events->user, source->line, name, value == NULL ? "" : value);
    return 1;
}

/* inih returns the line of its first fault, -1 for a file and -2 for memory. */
static enum ini_result read_stream(line_source *source) {
    const int result = ini_parse_stream(next_line, source, take_value, source);

    if (ferror(source->file)) {
        stop_unreadable(source);
    } else if (result > 0 && !source->stopped) {
        source->line = result;
        report(source, "not understood: must be `[section]`, `key = value` or a comment");
    }
    return result == -2 ? INI_NO_MEMORY : INI_READ;
}

enum ini_result ini_file_read(const char *path, const ini_events *events) {
    line_source source = {.events = events};
    enum ini_result result = INI_READ;
    struct stat status;

    const int is_stdin = strcmp(path, "-") == 0;
    source.file = is_stdin ? stdin : fopen(path, "r");
    if (source.file == NULL) {
        stop_unreadable(&source);
        return result;
    }
    if (fstat(fileno(source.file), &status) == 0 && S_ISDIR(status.st_mode)) {
        stop(&source, "is a folder, must be an INI file");
    } else {
        result = read_stream(&source);
    }
    if (!is_stdin) {
        fclose(source.file);
    }
    return result;
}
