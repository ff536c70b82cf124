/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Numbers in files. strtod() and printf() round correctly but follow the decimal sign of the locale;
 * so the sign is taken out of the text before the one and after the other.
 */

#include "number_text.h"
#include "shared.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Digits of a number without leading zeros, from digits[1] on, and the power of ten of the last one. */
typedef struct decimal {
    char digits[GMI_NUMBER_LENGTH + 24]; /* room for sign and exponent, see long_value() */
    int count;
    int exponent;
    int negative;
} decimal;

/* Beyond any double, but far from the limits of int. */
static const int largest_exponent = 100000;

static int is_digit(char c) {
    return c >= '0' && c <= '9';
}

static const char *read_sign(const char *text, int *negative) {
    *negative = *text == '-';
    return *text == '-' || *text == '+' ? text + 1 : text;
}

static const char *read_digits(const char *text, decimal *number, int *seen) {
    for (; is_digit(*text); ++text) {
        if (number->count > 0 || *text != '0') {
            number->digits[1 + number->count++] = *text;
        }
        ++*seen;
    }
    return text;
}

/* Takes the `e-12` of a number; NULL if there is an e but no digit behind it. */
static const char *read_exponent(const char *text, decimal *number) {
    if (*text != 'e' && *text != 'E') {
        return text;
    }
    int negative = 0;
    text = read_sign(text + 1, &negative);
    if (!is_digit(*text)) {
        return NULL;
    }

    int exponent = 0;
    for (; is_digit(*text); ++text) {
        if (exponent < largest_exponent) {
            exponent = 10 * exponent + (*text - '0');
        }
    }
    number->exponent += negative ? -exponent : exponent;
    return text;
}

/* Reads the parts of a number; 0 if the text is anything else. */
static int read_decimal(const char *text, decimal *number) {
    number->count = 0;
    number->exponent = 0;

    int seen = 0;
    text = read_digits(read_sign(text, &number->negative), number, &seen);
    if (*text == '.') {
        const int before = seen;
        text = read_digits(text + 1, number, &seen);
        number->exponent = before - seen;
    }
    if (seen == 0) {
        return 0;
    }
    text = read_exponent(text, number);
    return text != NULL && *text == '\0';
}

/*
 * Up to 15 digits and 22 decimals are exact doubles, so that one division rounds correctly [Clinger 1990,
 * "How to read floating point numbers accurately"]. Nearly all measured values are of this kind, and
 * this is several times faster than strtod(). Wider registers would round twice: not used there.
 */
#define EXACT_DIGITS   15
#define EXACT_DECIMALS 22

/* Adds digits to a number, which of too many overflows; returns what follows them. */
static inline const char *add_digits(const char *text, uint64_t *whole) {
    for (unsigned digit; (digit = (unsigned)*text - '0') <= 9; ++text) {
        *whole = 10 * *whole + digit;
    }
    return text;
}

const char *gmi_number_short(const char *text, int exponent, double *value) {
    static const double powers_of_ten[EXACT_DECIMALS + 1] = {
        1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
        1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    int negative = 0;
    const char *begin = read_sign(text, &negative);

    /* Digits, and behind a point more of them. */
    uint64_t whole = 0;
    const char *end = add_digits(begin, &whole);
    ptrdiff_t seen = end - begin, decimals = 0;
    if (*end == '.') {
        const char *point = end;
        end = add_digits(point + 1, &whole);
        decimals = end - point - 1;
        seen += decimals;
    }

    const ptrdiff_t power = decimals - exponent;
    if (seen == 0 || seen > EXACT_DIGITS || power < 0 || power > EXACT_DECIMALS ||
        FLT_EVAL_METHOD != 0) {
        return NULL;
    }
    const double amount = (double)(int64_t)whole / powers_of_ten[power];
    *value = negative ? -amount : amount;
    return end;
}

/* Without a decimal sign every locale reads the same. */
static double long_value(decimal *number, int exponent) {
    if (number->count == 0) {
        return number->negative ? -0.0 : 0.0;
    }
    number->digits[0] = number->negative ? '-' : '+';
    snprintf(number->digits + 1 + number->count, 16, "e%d", exponent);
    return strtod(number->digits, NULL);
}

int gmi_number_parse(const char *text, int exponent, double *value) {
    double parsed = 0.0;
    const char *end = gmi_number_short(text, exponent, &parsed);
    if (end != NULL && *end == '\0') {
        *value = parsed;
        return GMI_NUMBER_OK;
    }

    /* Any number. */
    decimal number;
    if (strlen(text) > GMI_NUMBER_LENGTH || !read_decimal(text, &number)) {
        return GMI_NUMBER_WRONG;
    }
    parsed = long_value(&number, number.exponent + exponent);
    if (!isfinite(parsed)) {
        return GMI_NUMBER_TOO_LARGE;
    }
    *value = parsed;
    return GMI_NUMBER_OK;
}

/* Prints in exponent notation with the fewest digits from 15 on that read back as the same double. */
static void print_shortest(char text[GMI_NUMBER_SIZE], double value) {
    for (int digits = 15; digits <= 17; ++digits) {
        snprintf(text, GMI_NUMBER_SIZE, "%.*e", digits - 1, value);
        if (strtod(text, NULL) == value) { /* both in the same locale */
            return;
        }
    }
}

/* Significant digits of a double as they are printed, 1.25e-5 as 125 and -5. */
typedef struct printed {
    char digits[18];
    int count;
    int exponent; /* of the first digit */
    int negative;
} printed;

/* Splits `-1.2500e-05` into sign, the digits 125 and the exponent -5 of the first of them. */
static void split_exponent_notation(const char *text, printed *number) {
    number->negative = *text == '-';
    number->count = 0;
    for (; *text != 'e'; ++text) {
        if (is_digit(*text) && number->count < 17) {
            number->digits[number->count++] = *text;
        }
    }
    while (number->count > 1 && number->digits[number->count - 1] == '0') {
        --number->count;
    }
    number->digits[number->count] = '\0';
    number->exponent = atoi(text + 1);
}

/* Writes 0.000125, 12.5, 12500 or 1.25e+20, whichever is easy to read. */
static void join_plain(char text[GMI_NUMBER_SIZE], const printed *number) {
    const char *sign = number->negative ? "-" : "";
    const char *digits = number->digits;
    const int point = number->exponent + 1; /* digits in front of the decimal point */

    if (point < -4 || point > 15) {
        snprintf(text, GMI_NUMBER_SIZE, "%s%c%s%se%d", sign, digits[0],
                 number->count > 1 ? "." : "", digits + 1, number->exponent);
    } else if (point <= 0) {
        snprintf(text, GMI_NUMBER_SIZE, "%s0.%.*s%s", sign, -point, "0000", digits);
    } else if (point >= number->count) {
        snprintf(text, GMI_NUMBER_SIZE, "%s%s%.*s", sign, digits, point - number->count,
                 "00000000000000");
    } else {
        snprintf(text, GMI_NUMBER_SIZE, "%s%.*s.%s", sign, point, digits, digits + point);
    }
}

const char *gmi_number_text(char text[GMI_NUMBER_SIZE], double value, int exponent, int digits) {
    if (digits > 0) {
        snprintf(text, GMI_NUMBER_SIZE, "%.*e", digits - 1, value);
    } else {
        print_shortest(text, value);
    }
    printed number;
    split_exponent_notation(text, &number);
    if (value != 0.0) {
        number.exponent += exponent;
    }
    join_plain(text, &number);
    return text;
}
