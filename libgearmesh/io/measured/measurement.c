/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Which tooth and flank of the gear something is that was measured. Derived in docs/measured-flanks.md from the
 * frame of docs/conventions.md: seen from face II (against +z) the drive flank of a tooth with its tip up is the
 * left one, on pinion, wheel and ring, as left flanks always meet left flanks.
 */

#include "measurement.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "files/flank_slot.h"
#include "files/io_error.h"
#include "files/number_text.h"
#include "shared.h"

void gm_measurement_default(gm_measurement *measurement) {
    if (measurement != NULL) {
        memset(measurement, 0, sizeof *measurement);
        measurement->first_number = 1;
        measurement->pitch_diameter = (double)NAN;
    }
}

double gmi_measuring_radius(const gm_measurement *measurement, const gm_gear *gear) {
    return isnan(measurement->pitch_diameter) ? gear->reference_radius
                                              : 0.5 * measurement->pitch_diameter;
}

int gm_measurement_side(const gm_measurement *measurement, int flank) {
    if (flank == GM_DRIVE || flank == GM_COAST) {
        return flank;
    }
    if (measurement == NULL || (flank != GM_LEFT && flank != GM_RIGHT) ||
        (measurement->datum_face != GM_FACE_I && measurement->datum_face != GM_FACE_II)) {
        return -1;
    }
    return (flank == GM_LEFT) == (measurement->datum_face == GM_FACE_II) ? GM_DRIVE : GM_COAST;
}

int gmi_measurement_sense(const gm_measurement *measurement, const gm_pair *pair, int wheel) {
    /* Counter-clockwise from face II is clockwise from face I. */
    const int counterclockwise =
        (measurement->counting == GM_COUNTERCLOCKWISE) == (measurement->datum_face == GM_FACE_II);

    /* A ring turns, and its teeth follow each other, as those of the pinion. */
    const int follows_pinion = !wheel || pair->wheel.sign < 0.0;
    return counterclockwise == follows_pinion ? 1 : -1;
}

int gm_measurement_tooth(const gm_measurement *measurement, const gm_pair *pair, int wheel,
                         int number) {
    if (measurement == NULL || pair == NULL) {
        return -1;
    }
    const int teeth = gmi_gear_of(pair, wheel)->teeth;
    const int first = measurement->first_number;
    const int zero = measurement->first_tooth;
    if (first < 0 || number < first || number - first >= teeth || zero < 0 || zero >= teeth) {
        return -1;
    }

    /* Numbers grow with or against the direction in which the teeth of gearmesh follow each other. */
    const int steps = gmi_measurement_sense(measurement, pair, wheel) * (number - first);
    return (zero + steps + teeth) % teeth;
}

int gmi_measurement_check(const gm_measurement *measurement, const gm_pair *pair, int wheel,
                          gm_io_error *error) {
    const int teeth = gmi_gear_of(pair, wheel)->teeth;
    const int status = gmi_check_teeth(teeth, error);
    if (status != GM_IO_OK) {
        return status;
    }

    /* What has no default: a guess would mirror the gear. */
    if (measurement->datum_face != GM_FACE_I && measurement->datum_face != GM_FACE_II) {
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "the datum face: must be said, I or II (got none)");
    }
    if (measurement->counting != GM_CLOCKWISE && measurement->counting != GM_COUNTERCLOCKWISE) {
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "the direction of counting: must be said, clockwise or "
                             "counter-clockwise as seen from the datum face (got none)");
    }

    /* How the teeth are numbered. */
    if (measurement->first_number < 0 || measurement->first_number > 1) {
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "the number of the first tooth: must be 0 or 1 (got %d)",
                             measurement->first_number);
    }
    if (measurement->first_tooth < 0 || measurement->first_tooth >= teeth) {
        gmi_error_option(error, "first_tooth");
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "the first tooth measured: must be from 0 to %d (got %d)", teeth - 1,
                             measurement->first_tooth);
    }

    /* The measuring circle has to cut the flanks; NaN stands for that of reference. Those of a ring lie outside its tip. */
    const double diameter = measurement->pitch_diameter;
    const gm_gear *gear = gmi_gear_of(pair, wheel);
    const int is_ring = gear->sign < 0.0;
    const double smallest = 2.0 * fmax(gear->base_radius, is_ring ? gear->tip_radius : 0.0);
    const double largest = 2.0 * (is_ring ? gear->root_radius : gear->tip_radius);
    if (!isnan(diameter) && !(diameter >= smallest && diameter <= largest)) {
        char got[GMI_NUMBER_SIZE];
        char low[GMI_NUMBER_SIZE];
        char high[GMI_NUMBER_SIZE];
        gmi_error_option(error, "pitch_diameter");
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "the measuring circle of the pitch: must be from %s mm (%s) to %s "
                             "mm (%s) in diameter (got %s mm)",
                             gmi_number_text(low, smallest, 3, 7), is_ring ? "tip" : "base",
                             gmi_number_text(high, largest, 3, 7), is_ring ? "root" : "tip",
                             isfinite(diameter) ? gmi_number_text(got, diameter, 3, 7)
                                                : "infinite");
    }
    return GM_IO_OK;
}

int gmi_measurement_place(const gm_measurement *measurement, const gm_pair *pair, int wheel,
                          int number, int flank, long line, int *tooth, int *side,
                          gm_io_error *error) {
    const int teeth = gmi_gear_of(pair, wheel)->teeth;
    *side = gm_measurement_side(measurement, flank);
    if (*side < 0) {
        return gmi_error_set(error, GM_IO_ERR_FORMAT, line,
                             "flank: must be drive, coast, left or right (got number %d)", flank);
    }

    /* A wrong number is often that of the mate, or counted from 0. */
    *tooth = gm_measurement_tooth(measurement, pair, wheel, number);
    if (*tooth < 0) {
        const int mate = gmi_gear_of(pair, !wheel)->teeth;
        const int first = measurement->first_number;
        gmi_error_option(error, number == 0 ? "first_number" : NULL);
        return gmi_error_set(error, GM_IO_ERR_FORMAT, line,
                             "tooth: must be from %d to %d, as the gear has %d teeth (got %d)%s",
                             first, first + teeth - 1, teeth, number,
                             number >= first && number - first < mate
                                 ? " (is it the other gear that was measured?)"
                             : number == 0 ? " (if the count begins at 0, that has to be said)"
                                           : "");
    }
    return GM_IO_OK;
}

const char *gmi_flank_word(int flank) {
    static const char *const words[] = {"drive", "coast", "left", "right"};
    return flank >= GM_DRIVE && flank <= GM_RIGHT ? words[flank] : "unknown";
}

/* ---------------------------------------------------------------------------------------------
 * Units
 * ------------------------------------------------------------------------------------------- */

const char *gmi_length_hint(double length, double expected) {
    static const struct {
        double factor;
        const char *text;
    } units[] = {{10.0, " (it looks like centimetres)"},
                 {25.4, " (it looks like inches)"},
                 {1000.0, " (it looks like metres)"},
                 {1e-3, " (it looks like micrometres)"},
                 {2.0, " (it looks like a radius)"}};

    /* With which unit would it reach about as far as it should? */
    for (size_t i = 0; i < sizeof units / sizeof units[0]; ++i) {
        const double share = length * units[i].factor / expected;
        if (share > 0.8 && share < 1.02) {
            return units[i].text;
        }
    }
    return "";
}

/* Below this no gear has ever been measured. */
static const double least_range = 1e-7;

int gmi_check_size(double range, double most, const char *what, long line, gm_io_error *error) {
    if (range == 0.0 || (range >= least_range && range <= most)) {
        return GM_IO_OK;
    }
    char text[GMI_NUMBER_SIZE];
    char low[GMI_NUMBER_SIZE];
    char high[GMI_NUMBER_SIZE];
    return gmi_error_set(error, GM_IO_ERR_FORMAT, line,
                         "%s: must vary by %s to %s um for this gear (got %s um at most: %s)", what,
                         gmi_number_text(low, least_range, 6, 1), gmi_number_text(high, most, 6, 4),
                         gmi_number_text(text, range, 6, 4),
                         range < least_range ? "it looks like millimetres"
                                             : "it looks like nanometres, or a point is wild");
}

/* ---------------------------------------------------------------------------------------------
 * Arrays
 * ------------------------------------------------------------------------------------------- */

void *gmi_array_grow(void *array, size_t size, int count, int *capacity) {
    if (count < *capacity) {
        return array;
    }
    if (*capacity > INT_MAX / 2) {
        return NULL;
    }

    /* Not realloc(): the old array has to stay if there is no memory. */
    const int larger = *capacity > 0 ? 2 * *capacity : 64;
    void *grown = malloc((size_t)larger * size);
    if (grown == NULL) {
        return NULL;
    }
    if (count > 0) {
        memcpy(grown, array, (size_t)count * size);
    }
    free(array);
    *capacity = larger;
    return grown;
}
