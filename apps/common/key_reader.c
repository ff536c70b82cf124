/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "key_reader.h"
#include "ini_file.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum {
    FAULT_LIMIT = 20, /* of faults told: the wrong kind of file would give thousands */
    NAME_SIZE = 128   /* "section.key" of any key */
};

/* ---------------------------------------------------------------------------------------------
 * Messages
 * ------------------------------------------------------------------------------------------- */

void key_print_place(const char *path, enum key_origin origin, int line) {
    if (origin == ORIGIN_SET) {
        fputs("--set ", stderr);
    } else if (origin == ORIGIN_OUTPUT_OPTION) {
        fputs("--output: ", stderr);
    } else if (line > 0) {
        fprintf(stderr, "%s:%d: ", path, line);
    } else {
        fprintf(stderr, "%s: ", path);
    }
}

void key_reader_fault(key_reader *reader, const char *name, const char *format, ...) {
    va_list arguments;

    if (++reader->faults > FAULT_LIMIT) {
        return;
    }
    key_print_place(reader->path, reader->from, reader->line);
    if (*name != '\0') {
        fprintf(stderr, "%s: ", name);
    }
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    if (reader->faults == FAULT_LIMIT) {
        fprintf(stderr, "%s: further faults are not told\n", reader->path);
    }
}

static void unknown_section(key_reader *reader, const char *section) {
    const char *near = key_section_near(reader->table, section);

    if (near != NULL) {
        key_reader_fault(reader, "", "[%.80s]: unknown section, did you mean [%s]?", section, near);
    } else {
        key_reader_fault(reader, "", "[%.80s]: unknown section, `%s --help` lists all", section,
                         reader->table->program);
    }
}

static void unknown_key(key_reader *reader, const char *section, const char *name) {
    const int index = key_near(reader->table, section, name);
    const key_spec *near = index < 0 ? NULL : &reader->table->keys[index];
    char full_name[NAME_SIZE];

    snprintf(full_name, sizeof full_name, "%.40s.%.80s", section, name);
    if (near == NULL) {
        key_reader_fault(reader, full_name, "unknown key, `%s --help` lists all",
                         reader->table->program);
    } else if (strcmp(near->section, section) == 0) {
        key_reader_fault(reader, full_name, "unknown key, did you mean %s?", near->name);
    } else {
        key_reader_fault(reader, full_name, "unknown key of [%s], did you mean %s of [%s]?",
                         section, near->name, near->section);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Values
 * ------------------------------------------------------------------------------------------- */

/* `name` as seen from the folder of `path`. */
static char *path_beside(const char *path, const char *name) {
    const char *slash = strrchr(path, '/');
    const size_t folder = slash == NULL || *name == '/' ? 0 : (size_t)(slash - path) + 1;
    char *joined = allocate(folder + strlen(name) + 1);

    memcpy(joined, path, folder);
    memcpy(joined + folder, name, strlen(name) + 1);
    return joined;
}

static int assign(const key_reader *reader, const key_spec *key, const char *value, char *text) {
    int result;
    char *path;

    if (key->kind != KEY_PATH || reader->from != ORIGIN_FILE) {
        return key_assign(key, reader->filled, value, text);
    }
    path = path_beside(reader->path, value);
    result = key_assign(key, reader->filled, path, text);
    free(path);
    return result;
}

static void set_value(key_reader *reader, int index, const char *value) {
    const key_spec *key = &reader->table->keys[index];
    key_entry *entry = &reader->entries[index];
    char text[KEY_FAULT_SIZE];

    free(entry->text);
    entry->text = copy_text(value);
    entry->origin = reader->from;
    entry->line = reader->line;
    if (*value == '\0') {
        key_reader_fault(reader, key->full_name,
                         "no value, expected one behind the `=`, or leave the key out");
    } else if (assign(reader, key, value, text)) {
        key_reader_fault(reader, key->full_name, "%s", text);
    }
}

void key_reader_set(key_reader *reader, const char *section, const char *name, const char *value) {
    const int index = key_find(reader->table, section, name);

    if (index >= 0) {
        set_value(reader, index, value);
    } else if (key_section_find(reader->table, section) >= 0) {
        unknown_key(reader, section, name);
    } else {
        unknown_section(reader, section);
    }
}

void key_entries_free(key_entry *entries, int count) {
    for (int i = 0; entries != NULL && i < count; ++i) {
        free(entries[i].text);
    }
    free(entries);
}

/* ---------------------------------------------------------------------------------------------
 * The file
 * ------------------------------------------------------------------------------------------- */

static void meet_section(void *user, int line, const char *section) {
    key_reader *reader = user;
    const int first = key_section_find(reader->table, section);

    reader->line = line;
    reader->in_section = 1;
    reader->section = NULL;
    if (first < 0) {
        unknown_section(reader, section);
        return;
    }
    if (reader->section_lines[first] > 0) {
        key_reader_fault(reader, "",
                         "[%s]: repeated section, first in line %d: put all its keys there",
                         section, reader->section_lines[first]);
    } else {
        reader->section_lines[first] = line;
    }
    reader->section = reader->table->keys[first].section;
}

static void meet_value(void *user, int line, const char *name, const char *value) {
    key_reader *reader = user;
    int index;

    reader->line = line;
    if (reader->section == NULL) {
        /* The keys of an unknown section are passed over: the section is the fault. */
        if (!reader->in_section) {
            key_reader_fault(
                reader, "", "%.80s: a key without a section, expected `[section]` before it", name);
        }
        return;
    }
    index = key_find(reader->table, reader->section, name);
    if (index < 0) {
        unknown_key(reader, reader->section, name);
    } else if (reader->entries[index].text != NULL) {
        key_reader_fault(reader, reader->table->keys[index].full_name,
                         "repeated key, first in line %d: give it once",
                         reader->entries[index].line);
    } else {
        set_value(reader, index, value);
    }
}

static void meet_fault(void *user, int line, const char *text) {
    key_reader *reader = user;

    reader->line = line;
    key_reader_fault(reader, "", "%s", text);
}

void key_reader_read(key_reader *reader) {
    const ini_events events = {reader, meet_section, meet_value, meet_fault};

    reader->section_lines = allocate((size_t)reader->table->count * sizeof *reader->section_lines);
    reader->from = ORIGIN_FILE;
    ini_file_read(reader->path, &events);
    reader->line = 0;
    free(reader->section_lines);
    reader->section_lines = NULL;
}
