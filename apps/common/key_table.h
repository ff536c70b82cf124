/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Tables of the keys that an INI file may have, each stated once. A row says how a value reads, its range, unit and
 * default, which kind of run uses it, and where it goes in a struct; reading, checks, defaults, provenance
 * and --help all follow it.
 */
#ifndef APPS_KEY_TABLE_H
#define APPS_KEY_TABLE_H

#include <stddef.h>
#include <stdio.h>

enum key_kind {
    KEY_NUMBER, /* double */
    KEY_COUNT,  /* int */
    KEY_SEED,   /* uint64_t */
    KEY_CHOICE, /* enum, one of the names in `choices` */
    KEY_RIPPLE, /* ripple */
    KEY_TEXT,   /* char * */
    KEY_PATH    /* char *, relative to the folder of the INI file */
};

/* SI value = value in the file / divisor * factor: mm have an exact divisor, but no exact factor. */
enum key_unit {
    UNIT_SI,
    UNIT_SHARE,
    UNIT_MM,
    UNIT_MM_DIAMETER,
    UNIT_UM,
    UNIT_MPAS,
    UNIT_MRAD,
    UNIT_GPA,
    UNIT_DEG,
    UNIT_RPM
};

typedef struct key_range {
    double low, high;        /* in the unit of the file */
    int open_low, open_high; /* the bound itself is excluded */
    int either_sign;         /* the range is that of the absolute value */
} key_range;

/* Situations that use or require a key. A mask with bits of several pairs means all of these pairs. */
enum key_situation {
    FOR_SIMPLE = 1 << 0,
    FOR_3D = 1 << 1,
    FOR_SPEED = 1 << 2,
    FOR_TORQUE = 1 << 3,
    FOR_DYNAMIC = 1 << 4,
    FOR_STATIC = 1 << 5,
    FOR_RUN = 1 << 6, /* only in `required`: not for --geometry */
    FOR_ALL = 1 << 7, /* only in `required`: for --geometry as well */
    FOR_CONSTANT = 1 << 8,
    FOR_ISO6336 = 1 << 9,
    FOR_ELASTIC = 1 << 10,
    FOR_COEFFICIENT = 1 << 11, /* of friction; else from the oil, */
    FOR_OIL = 1 << 12,
    FOR_ROUGHNESS = 1 << 13, /* and from that of the flanks */
    FOR_DOUBLE_HELICAL = 1 << 14
};

typedef struct key_spec {
    const char *section;
    const char *name;
    const char *full_name; /* "section.name" */
    enum key_kind kind;
    enum key_unit unit;
    key_range range;
    size_t target;        /* offset in what the table fills */
    const char *field;    /* field of gm_pair_params, NULL = none */
    const char *choices;  /* names separated by one blank, in the order of the enum */
    const char *standard; /* default, as it would be written in the file; NULL = none */
    const char *derived;  /* what happens without the key, in words, where there is no `standard` */
    unsigned used;        /* situations that use the key, 0 = all */
    unsigned required;    /* situations that require it, 0 = none */
    const char *help;
    const char *example; /* value in a template, NULL = the key is commented out there */
    const char *family;  /* how --help names a key that exists in many places; NULL = by its name */
    int family_member;   /* 0 = the one that --help shows */
} key_spec;

typedef struct key_table {
    const char *program; /* whose --help lists the keys */
    const key_spec *keys;
    int count;
    const char *legend; /* printed before the first family of keys, NULL = there is none */
} key_table;

/* What was given for a key. */
enum key_origin { ORIGIN_DEFAULT, ORIGIN_FILE, ORIGIN_SET, ORIGIN_OUTPUT_OPTION };

typedef struct key_entry {
    char *text; /* as given, NULL = not given, or given as empty: the default counts */
    enum key_origin origin;
    int line; /* in the INI file, 0 = not there */
} key_entry;

/* Index of a key, or -1. Names are case-sensitive. */
int key_find(const key_table *table, const char *section, const char *name);

/* Index of the first key of a section, or -1. */
int key_section_find(const key_table *table, const char *section);

/* What an unknown name was perhaps meant to be: a section (or NULL), the index of a key (or -1), which
 * may be one of another section. */
const char *key_section_near(const key_table *table, const char *section);
int key_near(const key_table *table, const char *section, const char *name);

/* Puts a value into the struct that the table fills. If it is refused, `fault` says what would be right. */
enum key_result { KEY_TAKEN, KEY_REFUSED, KEY_NO_MEMORY };
enum { KEY_FAULT_SIZE = 512 };
enum key_result key_assign(const key_spec *key, void *filled, const char *text,
                           char fault[KEY_FAULT_SIZE]);

/* The default of a key; without one NaN, -1 for a choice, 0 for a count, NULL for a text. KEY_TAKEN or KEY_NO_MEMORY. */
enum key_result key_assign_default(const key_spec *key, void *filled);

/* The defaults of all keys. */
enum key_result key_assign_defaults(const key_table *table, void *filled);

/* The part of --help that lists all keys. */
void key_table_print(const key_table *table, FILE *stream);

/* A key as a line of a parameter file with what it means behind it. `value` NULL: commented out, with its example or default. */
void key_print_line(const key_spec *key, const char *value, FILE *stream);

/* Position of a name in a list separated by blanks such as key_spec.choices, or -1; and the list as "iso | paper". */
int key_choice_find(const char *choices, const char *name);
void key_choices_print(const char *choices, char *text, size_t size);

#endif
