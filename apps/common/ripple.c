/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "ripple.h"
#include "number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double radians = 3.14159265358979323846 / 180.0; /* of 1 degree */

/* Far beyond all machines. */
static const double highest_order = 1e4, largest_amplitude = 1e12, largest_phase = 1e6;

enum { FIELDS = 3, FIELD_SIZE = 48 };

static int refuse(char *fault, size_t size, const char *right, const char *got, int length) {
    if (length == 0) {
        snprintf(fault, size, "must be %s (got nothing)", right);
    } else {
        snprintf(fault, size, "must be %s (got %.*s)", right, length < 80 ? length : 80, got);
    }
    return -1;
}

/* The part of a text up to one of some characters, without blanks around it; -1 if it is too long. */
static int take_field(const char *text, size_t length, char field[FIELD_SIZE]) {
    while (length > 0 && (*text == ' ' || *text == '\t')) {
        ++text;
        --length;
    }
    while (length > 0 && (text[length - 1] == ' ' || text[length - 1] == '\t')) {
        --length;
    }
    if (length >= FIELD_SIZE) {
        return -1;
    }
    memcpy(field, text, length);
    field[length] = '\0';
    return 0;
}

/* The three plain numbers of a harmonic. */
static int read_numbers(const char *text, size_t length, double number[FIELDS]) {
    const char *end = text + length;

    for (int i = 0; i < FIELDS; ++i) {
        const char *colon = memchr(text, ':', (size_t)(end - text));
        const char *stop = colon != NULL ? colon : end;
        char field[FIELD_SIZE];

        if ((colon == NULL) != (i == FIELDS - 1) ||
            take_field(text, (size_t)(stop - text), field) != 0 || !number_is_plain(field)) {
            return -1;
        }
        number[i] = strtod(field, NULL);
        text = stop + 1;
    }
    return 0;
}

/* One `ORDER:AMPLITUDE:PHASE_DEG`, added to what is there. */
static int read_harmonic(ripple *made, const char *text, size_t length, char *fault, size_t size) {
    double number[FIELDS];

    if (read_numbers(text, length, number) != 0) {
        return refuse(fault, size,
                      "ORDER:AMPLITUDE:PHASE_DEG, harmonics separated by commas, such as 2:5:0, "
                      "4:1.5:90",
                      text, (int)length);
    }
    if (!(number[0] > 0 && number[0] <= highest_order)) {
        return refuse(fault, size, "harmonics of an order above 0, up to 10000", text, (int)length);
    }
    if (!(fabs(number[1]) <= largest_amplitude && fabs(number[2]) <= largest_phase)) {
        return refuse(fault, size, "amplitudes within +-1e12 and phases within +-1e6 degrees", text,
                      (int)length);
    }
    if (made->count == RIPPLE_HARMONICS) {
        return refuse(fault, size, "32 harmonics at most", text, (int)length);
    }
    made->harmonics[made->count++] = (harmonic){number[0], number[1], number[2] * radians};
    return 0;
}

int ripple_parse(ripple *made, const char *text, char *fault, size_t fault_size) {
    made->count = 0;

    for (;;) {
        text += strspn(text, " \t");
        const size_t length = strcspn(text, ",");
        if (read_harmonic(made, text, length, fault, fault_size) != 0) {
            return -1;
        }
        if (text[length] == '\0') {
            return 0;
        }
        text += length + 1;
    }
}

ripple ripple_scaled(const ripple *given, double factor) {
    ripple made = *given;

    for (int i = 0; i < made.count; ++i) {
        made.harmonics[i].amplitude *= factor;
    }
    return made;
}

double ripple_value(const ripple *made, double angle) {
    double sum = 0.0;

    for (int i = 0; i < made->count; ++i) {
        const harmonic *part = &made->harmonics[i];
        sum += part->amplitude * sin(part->order * angle + part->phase);
    }
    return sum;
}

double ripple_slope(const ripple *made, double angle) {
    double sum = 0.0;

    for (int i = 0; i < made->count; ++i) {
        const harmonic *part = &made->harmonics[i];
        sum += part->order * part->amplitude * cos(part->order * angle + part->phase);
    }
    return sum;
}

double ripple_largest(const ripple *made, int derivative) {
    double sum = 0.0;

    for (int i = 0; i < made->count; ++i) {
        const harmonic *part = &made->harmonics[i];
        sum += fabs(part->amplitude) * pow(part->order, derivative);
    }
    return sum;
}

double ripple_highest_order(const ripple *made) {
    double highest = 0.0;

    for (int i = 0; i < made->count; ++i) {
        highest = fmax(highest, made->harmonics[i].order);
    }
    return highest;
}
