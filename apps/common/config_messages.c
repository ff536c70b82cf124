/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Messages about the keys of a configuration, with the place where each was set. What loads a configuration calls
 * what checks it, and this is what both speak by. */
#include "config.h"
#include "key_reader.h"
#include "keys.h"

#include <stdarg.h>
#include <string.h>

enum { NAME_SIZE = 128 }; /* "section.key" of any key */

static const key_spec *key_at(int index) {
    return &gearsim_keys.keys[index];
}

/* Index of "section.key", or -1. */
static int find_full_name(const char *section_and_key) {
    char section[NAME_SIZE];
    const size_t length = strcspn(section_and_key, ".");
    if (section_and_key[length] == '\0' || length >= sizeof section) {
        return -1;
    }

    memcpy(section, section_and_key, length);
    section[length] = '\0';
    return key_find(&gearsim_keys, section, section_and_key + length + 1);
}

/* Where a key was set. */
static void place_of(const config *conf, const char *section_and_key, char place[KEY_PLACE_SIZE]) {
    const key_entry none = {.origin = ORIGIN_DEFAULT};
    const int index = find_full_name(section_and_key);
    const key_entry *entry = index >= 0 ? &conf->entries[index] : &none;

    key_place(place, conf->path, entry->origin, entry->line, section_and_key);
}

void config_complain(const config *conf, const char *section_and_key, const char *format, ...) {
    char place[KEY_PLACE_SIZE];
    va_list values;

    place_of(conf, section_and_key, place);
    va_start(values, format);
    message_error_list(conf->messages, place, format, values);
    va_end(values);
}

void config_warn(const config *conf, const char *section_and_key, const char *format, ...) {
    static const char kind[] = "warning: ";
    char place[KEY_PLACE_SIZE + sizeof kind];
    va_list values;

    place_of(conf, section_and_key, place);
    strcat(place, kind);
    va_start(values, format);
    message_note_list(conf->messages, place, format, values);
    va_end(values);
}

void config_remark(const config *conf, const char *section_and_key, const char *format, ...) {
    static const char kind[] = "note: ";
    char place[KEY_PLACE_SIZE + sizeof kind];
    va_list values;

    place_of(conf, section_and_key, place);
    strcat(place, kind);
    va_start(values, format);
    message_note_list(conf->messages, place, format, values);
    va_end(values);
}

const char *config_key_of_field(const char *field) {
    static const char *const unknown = "gears";

    for (int i = 0; i < gearsim_keys.count; ++i) {
        if (key_at(i)->field != NULL && strcmp(key_at(i)->field, field) == 0) {
            return key_at(i)->full_name;
        }
    }
    return unknown;
}

const char *config_text(const config *conf, const char *section_and_key) {
    const int index = find_full_name(section_and_key);

    return index < 0 ? NULL : conf->entries[index].text;
}
