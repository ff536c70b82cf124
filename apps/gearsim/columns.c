/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "columns.h"
#include "te_slopes.h"
#include "wrench_columns.h"

#include <stdio.h>
#include <string.h>

static const char key[] = "output.columns";

static const char blanks[] = " \t";

/* Place of a name in the list, -1 if it is not there. */
static int find(const char *text, size_t length, const char *const names[], int name_count) {
    for (int i = 0; i < name_count; ++i) {
        if (strlen(names[i]) == length && memcmp(names[i], text, length) == 0) {
            return i;
        }
    }
    return -1;
}

static int contains(const column_list *columns, int name) {
    for (int i = 0; i < columns->count; ++i) {
        if (columns->name[i] == name) {
            return 1;
        }
    }
    return 0;
}

static int is_among(const char *name, const char *const names[], size_t count) {
    for (size_t k = 0; k < count; ++k) {
        if (strcmp(names[k], name) == 0) {
            return 1;
        }
    }
    return 0;
}

/* Whether it belongs to `all`: not what costs an evaluation for itself, unless it is what the law is for. */
static int is_of_all(const config *conf, const char *name) {
    static const char *const faces[] = {"face_load_factor", "largest_line_load_N_per_mm",
                                        "largest_pressure_N_per_mm2"};
    if (is_among(name, faces, sizeof faces / sizeof faces[0])) {
        return conf->law == LAW_ELASTIC;
    }
    return is_wrench_column(name) ? conf->wrench == WRENCH_ON
                                  : strcmp(name, "stored_energy_J") != 0;
}

/* All names of the analysis, for the message about a wrong one. */
static void join(char *text, size_t size, const char *const names[], int name_count) {
    size_t used = 0;

    for (int i = 0; i < name_count; ++i) {
        const int written = snprintf(text + used, size - used, "%s%s", i > 0 ? ", " : "", names[i]);
        if (written < 0 || (size_t)written >= size - used) {
            return;
        }
        used += (size_t)written;
    }
}

static int add(column_list *columns, const config *conf, const char *text, size_t length,
               const char *const names[], int name_count) {
    const int name = find(text, length, names, name_count);
    char known[1024];

    if (name < 0 && strncmp(text, TE_SLOPE_PREFIX, strlen(TE_SLOPE_PREFIX)) == 0) {
        config_complain(conf, key,
                        "must name an amount of [modifications] behind " TE_SLOPE_PREFIX
                        ", as in " TE_SLOPE_PREFIX "pinion_tip_relief_um, of a static analysis "
                        "without friction, gap and tip corners of constant stiffness, %d at most "
                        "(got '%.*s')",
                        TE_SLOPES_MAX, (int)length, text);
        return EXIT_BAD_INPUT;
    }
    if (name < 0) {
        join(known, sizeof known, names, name_count);
        config_complain(conf, key, "must name columns of this analysis, which are %s (got '%.*s')",
                        known, (int)length, text);
        return EXIT_BAD_INPUT;
    }
    if (contains(columns, name)) {
        config_complain(conf, key, "must name each column once (got '%s' twice)", names[name]);
        return EXIT_BAD_INPUT;
    }
    columns->name[columns->count++] = name;
    return 0;
}

int columns_select(column_list *columns, const config *conf, const char *const names[],
                   int name_count) {
    columns->count = 0;
    if (conf->columns == NULL || strcmp(conf->columns, "all") == 0) {
        for (int i = 0; i < name_count; ++i) {
            if (is_of_all(conf, names[i])) {
                columns->name[columns->count++] = i;
            }
        }
        return 0;
    }

    const char *text = conf->columns;
    for (;;) {
        /* A name up to the comma or the end, without blanks around it. */
        text += strspn(text, blanks);
        const size_t field = strcspn(text, ",");
        size_t length = field;
        while (length > 0 && strchr(blanks, text[length - 1]) != NULL) {
            --length;
        }
        if (add(columns, conf, text, length, names, name_count) != 0) {
            return EXIT_BAD_INPUT;
        }

        if (text[field] == '\0') {
            return 0;
        }
        text += field + 1;
    }
}
