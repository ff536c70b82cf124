/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "key_reader.h"
#include "ini_file.h"
#include "memory.h"
#include "platform.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_SIZE = 128 }; /* "section.key" of any key */

/* ---------------------------------------------------------------------------------------------
 * Messages
 * ------------------------------------------------------------------------------------------- */

void key_place(char place[KEY_PLACE_SIZE], const char *path, enum key_origin origin, int line,
               const char *name) {
    const char *colon = *name != '\0' ? ": " : "";

    if (origin == ORIGIN_SET) {
        snprintf(place, KEY_PLACE_SIZE, "--set %s%s", name, colon);
    } else if (origin == ORIGIN_OUTPUT_OPTION) {
        snprintf(place, KEY_PLACE_SIZE, "--output: %s%s", name, colon);
    } else if (line > 0) {
        snprintf(place, KEY_PLACE_SIZE, "%s:%d: %s%s", path, line, name, colon);
    } else {
        snprintf(place, KEY_PLACE_SIZE, "%s: %s%s", path, name, colon);
    }
}

void key_reader_fault(key_reader *reader, const char *name, const char *format, ...) {
    char place[KEY_PLACE_SIZE];
    va_list values;

    ++reader->faults;
    key_place(place, reader->path, reader->from, reader->line, name);
    va_start(values, format);
    message_error_list(reader->messages, place, format, values);
    va_end(values);
}

/* A fault that only counts needs no search for the name that was meant. */
static int is_to_be_told(key_reader *reader) {
    if (!message_is_full(reader->messages)) {
        return 1;
    }
    key_reader_fault(reader, "", "");
    return 0;
}

static void unknown_section(key_reader *reader, const char *section) {
    if (!is_to_be_told(reader)) {
        return;
    }

    const char *near = key_section_near(reader->table, section);
    if (near != NULL) {
        key_reader_fault(reader, "", "[%.80s]: unknown section, did you mean [%s]?", section, near);
    } else {
        key_reader_fault(reader, "", "[%.80s]: unknown section, `%s --help` lists all", section,
                         reader->table->program);
    }
}

static void unknown_key(key_reader *reader, const char *section, const char *name) {
    if (!is_to_be_told(reader)) {
        return;
    }

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
    const size_t folder = path_name_start(path);
    if (folder == 0 || path_is_absolute(name)) {
        return copy_text(name);
    }

    char *joined = join_texts(path, name);
    if (joined != NULL) {
        strcpy(joined + folder, name);
    }
    return joined;
}

static enum key_result assign(const key_reader *reader, const key_spec *key, const char *value,
                              char fault[KEY_FAULT_SIZE]) {
    if (key->kind != KEY_PATH || reader->from != ORIGIN_FILE) {
        return key_assign(key, reader->filled, value, fault);
    }

    /* Names in the file are relative to its folder, but for "-", a stream. */
    char *path = strcmp(value, "-") == 0 ? copy_text(value) : path_beside(reader->path, value);
    if (path == NULL) {
        return KEY_NO_MEMORY;
    }
    const enum key_result result = key_assign(key, reader->filled, path, fault);
    free(path);
    return result;
}

static void set_value(key_reader *reader, int index, const char *value) {
    const key_spec *key = &reader->table->keys[index];
    key_entry *entry = &reader->entries[index];
    char fault[KEY_FAULT_SIZE];

    free(entry->text);
    entry->text = NULL;
    entry->origin = reader->from;
    entry->line = reader->line;

    /* Nothing behind the `=`: not given. */
    if (*value == '\0') {
        reader->no_memory = key_assign_default(key, reader->filled) == KEY_NO_MEMORY;
        return;
    }

    entry->text = copy_text(value);
    const enum key_result result =
        entry->text != NULL ? assign(reader, key, value, fault) : KEY_NO_MEMORY;
    if (result == KEY_REFUSED) {
        key_reader_fault(reader, key->full_name, "%s", fault);
    } else if (result == KEY_NO_MEMORY) {
        reader->no_memory = 1;
    }
}

void key_reader_set(key_reader *reader, const char *section, const char *name, const char *value) {
    if (reader->no_memory) {
        return;
    }

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
        key_reader_fault(
            reader, "",
            "[%s]: repeated section, must stand once with all its keys (first in line %d)", section,
            reader->section_lines[first]);
    } else {
        reader->section_lines[first] = line;
    }
    reader->section = reader->table->keys[first].section;
}

static void meet_value(void *user, int line, const char *name, const char *value) {
    key_reader *reader = user;

    reader->line = line;
    if (reader->no_memory) {
        return;
    }
    if (reader->section == NULL) {
        /* The keys of an unknown section are passed over: the section is the fault. */
        if (!reader->in_section) {
            key_reader_fault(
                reader, "",
                "%.80s: a key without a section, must stand behind a line such as `[gears]`", name);
        }
        return;
    }

    const int index = key_find(reader->table, reader->section, name);
    if (index < 0) {
        unknown_key(reader, reader->section, name);
    } else if (reader->entries[index].line > 0) {
        key_reader_fault(reader, reader->table->keys[index].full_name,
                         "repeated key, must be given once (first in line %d)",
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

    reader->section_lines = allocate((size_t)reader->table->count, sizeof *reader->section_lines);
    if (reader->section_lines == NULL) {
        reader->no_memory = 1;
        return;
    }

    reader->from = ORIGIN_FILE;
    if (ini_file_read(reader->path, &events) == INI_NO_MEMORY) {
        reader->no_memory = 1;
    }
    reader->line = 0;
    free(reader->section_lines);
    reader->section_lines = NULL;
}
