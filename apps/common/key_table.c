/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "key_table.h"
#include "memory.h"
#include "number.h"
#include "ripple.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------------------------------------
 * Names
 * ------------------------------------------------------------------------------------------- */

int key_find(const key_table *table, const char *section, const char *name) {
    for (int i = 0; i < table->count; ++i) {
        if (strcmp(table->keys[i].section, section) == 0 &&
            strcmp(table->keys[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

int key_section_find(const key_table *table, const char *section) {
    for (int i = 0; i < table->count; ++i) {
        if (strcmp(table->keys[i].section, section) == 0) {
            return i;
        }
    }
    return -1;
}

enum { NAME_SIZE = 64, UNLIKE = 1000 };

static int lower(char c) {
    return tolower((unsigned char)c);
}

static size_t smaller(size_t a, size_t b) {
    return a < b ? a : b;
}

/* Levenshtein distance without regard to case: letters to change, add or drop. */
static size_t edit_distance(const char *a, const char *b) {
    const size_t width = strlen(b);
    size_t row[NAME_SIZE];

    for (size_t j = 0; j <= width; ++j) {
        row[j] = j;
    }
    for (size_t i = 0; a[i] != '\0'; ++i) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < width; ++j) {
            const size_t changed = diagonal + (lower(a[i]) != lower(b[j]));
            diagonal = row[j + 1];
            row[j + 1] = smaller(changed, 1 + smaller(row[j], row[j + 1]));
        }
    }
    return row[width];
}

/* How unlike two names are: UNLIKE = too much to guess one from the other. */
static size_t unlikeness(const char *given, const char *known) {
    const size_t length = strlen(given);
    const size_t known_length = strlen(known);

    if (length == 0 || length >= NAME_SIZE) {
        return UNLIKE;
    }

    /* Each letter that one has more costs 1: most names are too unlike by that alone. */
    const size_t most = 1 + length / 4;
    const size_t surplus = length > known_length ? length - known_length : known_length - length;
    const int is_part = length >= 4 && strstr(known, given) != NULL;
    if (surplus > most && !is_part) {
        return UNLIKE;
    }

    const size_t distance = edit_distance(given, known);
    return distance <= most || is_part ? distance : UNLIKE;
}

const char *key_section_near(const key_table *table, const char *section) {
    const char *near = NULL;
    size_t least = UNLIKE;

    for (int i = 0; i < table->count; ++i) {
        if (i > 0 && strcmp(table->keys[i].section, table->keys[i - 1].section) == 0) {
            continue; /* the rows of a section stand together */
        }
        const size_t distance = unlikeness(section, table->keys[i].section);
        if (distance < least) {
            least = distance;
            near = table->keys[i].section;
        }
    }
    return near;
}

int key_near(const key_table *table, const char *section, const char *name) {
    int near = -1;
    size_t least = UNLIKE;

    for (int i = 0; i < table->count; ++i) {
        /* A key of another section is the better guess only if its name is more alike. */
        const int elsewhere = strcmp(table->keys[i].section, section) != 0;
        const size_t distance = 2 * unlikeness(name, table->keys[i].name) + (elsewhere ? 1 : 0);
        if (distance < least) {
            least = distance;
            near = i;
        }
    }
    return near;
}

/* ---------------------------------------------------------------------------------------------
 * Values
 * ------------------------------------------------------------------------------------------- */

static const struct {
    double divisor, factor;
} units[] = {
    [UNIT_SI] = {1, 1},
    [UNIT_SHARE] = {1, 1},
    [UNIT_MM] = {1e3, 1},
    [UNIT_MM_DIAMETER] = {2e3, 1},
    [UNIT_UM] = {1e6, 1},
    [UNIT_MPAS] = {1e3, 1},
    [UNIT_MRAD] = {1e3, 1},
    [UNIT_GPA] = {1, 1e9},
    [UNIT_DEG] = {180, 3.14159265358979323846},
    [UNIT_RPM] = {30, 3.14159265358979323846},
};

/* Minus signs, spaces and digits that look like those of a keyboard, as documents have them: tells which it is. */
static int not_plain(const char *text, char *fault) {
    const unsigned char *at = (const unsigned char *)text;

    while (*at != '\0' && *at < 0x80) {
        ++at;
    }
    if (*at == '\0') {
        return 0;
    }

    /* Its number in Unicode, from the bits behind the marks of UTF-8. */
    const int more = *at >= 0xf0 ? 3 : *at >= 0xe0 ? 2 : 1;
    unsigned code = *at & (0x3fU >> more);
    for (int i = 1; i <= more && (at[i] & 0xc0) == 0x80; ++i) {
        code = code << 6 | (at[i] & 0x3fU);
    }
    snprintf(fault, KEY_FAULT_SIZE,
             "must be a number such as 12, -0.5 or 1e-4, without the character U+%04X (got %.80s)",
             code, text);
    return 1;
}

static int not_a_number(const char *text, char *fault) {
    if (not_plain(text, fault)) {
        return 1;
    }

    const char *right = strchr(text, ',') != NULL
                            ? "must be a number with a decimal point and without separators"
                            : "must be a number such as 12, -0.5 or 1e-4 with nothing behind it";

    snprintf(fault, KEY_FAULT_SIZE, "%s (got %.80s)", right, text);
    return 1;
}

static int read_number(const char *text, double *value, char *fault) {
    if (!number_is_plain(text)) {
        return not_a_number(text, fault);
    }
    *value = strtod(text, NULL);
    if (isfinite(*value)) {
        return 0;
    }
    snprintf(fault, KEY_FAULT_SIZE, "must be %s1.8e308 (got %.80s)",
             *value > 0 ? "below " : "above -", text);
    return 1;
}

/* "> 0", ">= 0", "between 0 and 45, both excluded", "from 0 to 1", "above 0, up to 1" */
static void describe_range(const key_range *range, char *text, size_t size) {
    static const char *const bounded[2][2] = {
        {"from %.9g to %.9g", "from %.9g to below %.9g"},
        {"above %.9g, up to %.9g", "between %.9g and %.9g, both excluded"}};

    if (range->either_sign) {
        snprintf(text, size, "from %.9g to %.9g, or from -%.9g to -%.9g", range->low, range->high,
                 range->high, range->low);
    } else if (isfinite(range->low) && isfinite(range->high)) {
        snprintf(text, size, bounded[range->open_low][range->open_high], range->low, range->high);
    } else if (isfinite(range->low)) {
        snprintf(text, size, "%s %.9g", range->open_low ? ">" : ">=", range->low);
    } else {
        snprintf(text, size, "finite");
    }
}

static int is_below(const key_range *range, double size) {
    return range->open_low ? size <= range->low : size < range->low;
}

static int is_above(const key_range *range, double size) {
    return range->open_high ? size >= range->high : size > range->high;
}

/* A unit that people mix up with that of a key, and its size in the unit of the key. */
typedef struct mixed_up_unit {
    enum key_unit unit;
    const char *meant;
    double size;
} mixed_up_unit;

/* What a number beyond its range was perhaps meant to be, as the end of a message: the first that would be in range. */
static void describe_slip(const key_spec *key, double value, char *text, size_t size_of_text) {
    static const mixed_up_unit others[] = {
        {UNIT_MM, "metres", 1e3}, {UNIT_MM_DIAMETER, "metres", 1e3}, {UNIT_UM, "mm", 1e3},
        {UNIT_UM, "metres", 1e6}, {UNIT_SHARE, "percent", 1e-2},     {UNIT_GPA, "MPa", 1e-3},
        {UNIT_GPA, "Pa", 1e-9},   {UNIT_MRAD, "microradians", 1e-3},
    };

    *text = '\0';
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        const double meant = value * others[i].size;
        const double size = fabs(meant);
        const int is_toward_range = others[i].size < 1 ? is_above(&key->range, fabs(value))
                                                       : is_below(&key->range, fabs(value));
        if (key->unit == others[i].unit && is_toward_range && !is_below(&key->range, size) &&
            !is_above(&key->range, size)) {
            snprintf(text, size_of_text, "; was it meant in %s? write %.6g", others[i].meant,
                     meant);
            return;
        }
    }
}

static int check_range(const key_spec *key, double value, const char *text, char *fault) {
    const key_range *range = &key->range;
    const double size = range->either_sign ? fabs(value) : value;
    const int low = is_below(range, size);
    const int high = is_above(range, size);
    const int broken = key->kind == KEY_COUNT && value != floor(value);
    char requirement[120];
    char slip[80];

    if (!low && !high && !broken) {
        return 0;
    }
    describe_range(range, requirement, sizeof requirement);
    describe_slip(key, value, slip, sizeof slip);
    snprintf(fault, KEY_FAULT_SIZE, "must be %s%s (got %.80s)%s", broken ? "a whole number " : "",
             requirement, text, slip);
    return 1;
}

static int assign_number(const key_spec *key, double *target, const char *text, char *fault) {
    double value = 0.0;

    if (read_number(text, &value, fault) || check_range(key, value, text, fault)) {
        return 1;
    }
    *target = value / units[key->unit].divisor * units[key->unit].factor;
    return 0;
}

static int assign_count(const key_spec *key, int *target, const char *text, char *fault) {
    double value = 0.0;

    if (read_number(text, &value, fault) || check_range(key, value, text, fault)) {
        return 1;
    }
    *target = (int)value;
    return 0;
}

static int assign_seed(uint64_t *target, const char *text, char *fault) {
    if (*text != '\0' && strspn(text, "0123456789") == strlen(text)) {
        errno = 0;
        const unsigned long long value = strtoull(text, NULL, 10);
        if (errno != ERANGE && value <= UINT64_MAX) {
            *target = (uint64_t)value;
            return 0;
        }
    }
    snprintf(fault, KEY_FAULT_SIZE,
             "must be a whole number from 0 to 18446744073709551615 (got %.80s)", text);
    return 1;
}

int key_choice_find(const char *names, const char *name) {
    const size_t length = strlen(name);

    for (int position = 0;; ++position) {
        const size_t span = strcspn(names, " ");
        if (span == length && strncmp(names, name, span) == 0) {
            return position;
        }
        if (names[span] == '\0') {
            return -1;
        }
        names += span + 1;
    }
}

void key_choices_print(const char *names, char *text, size_t size) {
    size_t length = 0;

    for (; *names != '\0' && length + 4 < size; ++names) {
        if (*names == ' ') {
            memcpy(text + length, " | ", 3);
            length += 3;
        } else {
            text[length++] = *names;
        }
    }
    text[length] = '\0';
}

/* Enumerations of config are as wide as an int on every platform with POSIX. */
static int assign_choice(const key_spec *key, void *target, const char *text, char *fault) {
    const int position = key_choice_find(key->choices, text);
    char choices[80];

    if (position >= 0) {
        memcpy(target, &position, sizeof position);
        return 0;
    }
    key_choices_print(key->choices, choices, sizeof choices);
    snprintf(fault, KEY_FAULT_SIZE, "must be %s (got %.80s)", choices, text);
    return 1;
}

static enum key_result assign_text(char **target, const char *text) {
    free(*target);
    *target = copy_text(text);
    return *target != NULL ? KEY_TAKEN : KEY_NO_MEMORY;
}

/* Where a key goes, as one of the types that key_kind names. */
static void *target_of(const key_spec *key, void *filled) {
    return (char *)filled + key->target;
}

enum key_result key_assign(const key_spec *key, void *filled, const char *text,
                           char fault[KEY_FAULT_SIZE]) {
    void *target = target_of(key, filled);

    switch (key->kind) {
    case KEY_NUMBER:
        return assign_number(key, target, text, fault) ? KEY_REFUSED : KEY_TAKEN;
    case KEY_COUNT:
        return assign_count(key, target, text, fault) ? KEY_REFUSED : KEY_TAKEN;
    case KEY_SEED:
        return assign_seed(target, text, fault) ? KEY_REFUSED : KEY_TAKEN;
    case KEY_CHOICE:
        return assign_choice(key, target, text, fault) ? KEY_REFUSED : KEY_TAKEN;
    case KEY_RIPPLE:
        return ripple_parse(target, text, fault, KEY_FAULT_SIZE) ? KEY_REFUSED : KEY_TAKEN;
    case KEY_TEXT:
    case KEY_PATH:
        break;
    }
    return assign_text(target, text);
}

enum key_result key_assign_default(const key_spec *key, void *filled) {
    char fault[KEY_FAULT_SIZE];

    if (key->standard != NULL) {
        return key_assign(key, filled, key->standard, fault);
    }

    /* NaN and -1 say that a number or choice is not given. */
    switch (key->kind) {
    case KEY_NUMBER:
        *(double *)target_of(key, filled) = (double)NAN;
        break;
    case KEY_COUNT:
        *(int *)target_of(key, filled) = 0;
        break;
    case KEY_CHOICE:
        *(int *)target_of(key, filled) = -1;
        break;
    case KEY_SEED:
        *(uint64_t *)target_of(key, filled) = 0;
        break;
    case KEY_RIPPLE:
        ((ripple *)target_of(key, filled))->count = 0;
        break;

    /* Texts are on the heap. */
    case KEY_TEXT:
    case KEY_PATH:
        free(*(char **)target_of(key, filled));
        *(char **)target_of(key, filled) = NULL;
        break;
    }
    return KEY_TAKEN;
}

enum key_result key_assign_defaults(const key_table *table, void *filled) {
    enum key_result result = KEY_TAKEN;

    for (int i = 0; i < table->count && result == KEY_TAKEN; ++i) {
        result = key_assign_default(&table->keys[i], filled);
    }
    return result;
}

/* ---------------------------------------------------------------------------------------------
 * Help
 * ------------------------------------------------------------------------------------------- */

/* "= a | b", "> 0", "from 3 to 17": what may stand behind the key. */
static void describe_values(const key_spec *key, char *text, size_t size) {
    *text = '\0';
    if (key->kind == KEY_CHOICE) {
        key_choices_print(key->choices, text, size);
    } else if (key->kind == KEY_SEED) {
        snprintf(text, size, "whole number");
    } else if (key->kind == KEY_RIPPLE) {
        snprintf(text, size, "ORDER:AMPLITUDE:PHASE_DEG, ...");
    } else if (key->kind == KEY_COUNT || (key->kind == KEY_NUMBER && isfinite(key->range.low))) {
        describe_range(&key->range, text, size);
    }
}

/* When the file must have the key, or NULL. */
static const char *describe_need(const key_spec *key) {
    if (key->required & FOR_SPEED) {
        return "required for kind = speed";
    }
    if (key->required & FOR_TORQUE) {
        return "required for kind = torque";
    }
    if (key->required & FOR_DYNAMIC) {
        return "required for a dynamic run";
    }
    if (key->required & FOR_RUN) {
        return "required for a run";
    }
    return key->required ? "required" : NULL;
}

/* The choice that makes a key count, where it is not the usual one; or NULL. */
static const char *describe_use(const key_spec *key) {
    if (key->used & FOR_STATIC) {
        return "type = static";
    }
    if (key->used & FOR_TORQUE) {
        return "kind = torque";
    }
    if (key->used & FOR_ISO6336) {
        return "law = iso6336";
    }
    if (key->used & FOR_ELASTIC) {
        return "law = elastic";
    }
    return key->used & FOR_SIMPLE ? "model = simple" : NULL;
}

static void print_key(const key_spec *key, FILE *stream) {
    const char *standard = key->standard != NULL ? key->standard : key->derived;
    const char *need = describe_need(key);
    char values[80];

    describe_values(key, values, sizeof values);
    fprintf(stream, "  %-25s ", key->family != NULL ? key->family : key->name);
    if (standard != NULL) {
        fprintf(stream, "[%s] ", standard);
    }
    fputs(key->help, stream);
    if (*values != '\0') {
        fprintf(stream, "; %s", values);
    }
    if (need != NULL) {
        fprintf(stream, "; %s", need);
    }
    fputc('\n', stream);
}

void key_table_print(const key_table *table, FILE *stream) {
    for (int i = 0; i < table->count; ++i) {
        if (i == 0 || strcmp(table->keys[i].section, table->keys[i - 1].section) != 0) {
            fprintf(stream, "[%s]\n", table->keys[i].section);
        }
        if (table->keys[i].family != NULL && table->keys[i - 1].family == NULL) {
            fputs(table->legend, stream);
        }
        if (table->keys[i].family_member == 0) {
            print_key(&table->keys[i], stream);
        }
    }
}

/* A default that is told in words but is a value. */
static int is_value(const key_spec *key, const char *text) {
    return text != NULL && (key->kind == KEY_CHOICE ? key_choice_find(key->choices, text) >= 0
                                                    : number_is_plain(text));
}

void key_print_line(const key_spec *key, const char *value, FILE *stream) {
    const char *standard = key->standard != NULL ? key->standard : key->derived;
    const char *shown = value != NULL ? value : key->example != NULL ? key->example : key->standard;
    if (shown == NULL && is_value(key, standard)) {
        shown = standard;
    }

    /* The comments stand below each other. */
    char line[160];
    snprintf(line, sizeof line, "%s%s =%s%s", value == NULL ? "; " : "", key->name,
             shown != NULL ? " " : "", shown != NULL ? shown : "");
    fprintf(stream, "%-40s ; ", line);

    /* Where it counts, what it may be, and what it means. */
    if (value == NULL && describe_use(key) != NULL) {
        fprintf(stream, "%s: ", describe_use(key));
    }
    if (key->kind == KEY_CHOICE) {
        char choices[80];
        key_choices_print(key->choices, choices, sizeof choices);
        fprintf(stream, "%s: ", choices);
    }
    if (key->family != NULL) {
        fprintf(stream, "%s: ", key->family);
    }
    fputs(key->help, stream);

    /* What happens without it, if that does not stand there. */
    if (standard != NULL && standard != shown) {
        fprintf(stream, "; without: %s", standard);
    }
    fputc('\n', stream);
}
