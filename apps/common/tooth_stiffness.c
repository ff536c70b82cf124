/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "tooth_stiffness.h"
#include "memory.h"
#include "number.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_SIZE = 256 };

/* A crack through half of the root leaves about a third; beyond these it is a slip. */
static const double least = 0.01;
static const double most = 100.0;

typedef struct reader {
    const config *conf;
    const char *key, *path;
    FILE *file;
    long line;
} reader;

static int refuse(const reader *from, const char *text, const char *got) {
    message_error(from->conf->messages, "%s:%ld: %s (got %.80s)", from->path, from->line, text,
                  got);
    config_complain(from->conf, from->key, "names this file");
    return EXIT_BAD_INPUT;
}

/* The next line that is neither empty nor a comment, without its end; NULL at the end of the file. */
static char *next_line(reader *from, char text[LINE_SIZE]) {
    while (fgets(text, LINE_SIZE, from->file) != NULL) {
        ++from->line;
        text[strcspn(text, "\r\n")] = '\0';
        char *start = text + strspn(text, " \t");
        if (from->line == 1 && strncmp(start, "\xef\xbb\xbf", 3) == 0) {
            start += 3;
        }
        if (*start != '\0' && *start != '#') {
            return start;
        }
    }
    return NULL;
}

/* Cuts at the comma; the second field, or NULL. */
static char *second_field(char *text) {
    char *comma = strchr(text, ',');
    if (comma == NULL || strchr(comma + 1, ',') != NULL) {
        return NULL;
    }
    *comma = '\0';
    return comma + 1 + strspn(comma + 1, " \t");
}

static int read_row(const reader *from, char *line, double *factors, char *named, int teeth) {
    char whole[LINE_SIZE], *end;
    snprintf(whole, sizeof whole, "%s", line);
    const char *second = second_field(line);
    if (second == NULL) {
        return refuse(from, "a row must be tooth,factor", whole);
    }

    /* Which tooth, once. */
    const long tooth = strtol(line, &end, 10);
    if (end == line || *(end + strspn(end, " \t")) != '\0' || tooth < 0 || tooth >= teeth) {
        char text[80];
        snprintf(text, sizeof text, "tooth must be a whole number from 0 to %d", teeth - 1);
        return refuse(from, text, line);
    }
    if (named[tooth]) {
        return refuse(from, "each tooth must stand once", line);
    }

    const double factor = number_is_plain(second) ? strtod(second, NULL) : 0.0;
    if (!(factor >= least && factor <= most)) {
        return refuse(from, "factor must be a number from 0.01 to 100, 1 for a whole tooth",
                      second);
    }
    factors[tooth] = factor;
    named[tooth] = 1;
    return 0;
}

static int read_all(reader *from, double *factors, char *named, int teeth) {
    char text[LINE_SIZE];
    char *line = next_line(from, text);
    const char *second = line != NULL ? second_field(line) : NULL;
    if (second == NULL || strcmp(line, "tooth") != 0 || strcmp(second, "factor") != 0) {
        return refuse(from, "the columns must be tooth,factor", line != NULL ? line : "nothing");
    }
    int status = 0;
    while (status == 0 && (line = next_line(from, text)) != NULL) {
        status = read_row(from, line, factors, named, teeth);
    }
    return status;
}

int tooth_stiffness_load(double **factors, const config *conf, enum gm_role gear, int teeth) {
    const flank_files *files = gear == GM_PINION ? &conf->pinion_flanks : &conf->wheel_flanks;
    reader from = {.conf = conf,
                   .key = gear == GM_PINION ? "flanks.pinion_tooth_stiffness"
                                            : "flanks.wheel_tooth_stiffness",
                   .path = files->tooth_stiffness};
    *factors = NULL;
    if (from.path == NULL) {
        return 0;
    }

    from.file = fopen(from.path, "r");
    if (from.file == NULL) {
        message_error(conf->messages, "%s: %s", from.path, strerror(errno));
        config_complain(conf, from.key, "names this file");
        return EXIT_BAD_INPUT;
    }

    /* Teeth that the file does not name are whole. */
    char *named = allocate((size_t)teeth, 1);
    *factors = allocate((size_t)teeth, sizeof **factors);
    int status = EXIT_RUN_FAILED;
    if (named == NULL || *factors == NULL) {
        (void)message_no_memory(conf->messages);
    } else {
        for (int tooth = 0; tooth < teeth; ++tooth) {
            (*factors)[tooth] = 1.0;
        }
        status = read_all(&from, *factors, named, teeth);
    }
    fclose(from.file);
    free(named);
    return status;
}
