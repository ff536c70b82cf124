/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The value is scaled by a power of ten to an integer of the wanted number of digits, in double-double arithmetic (about
 * 100 bits), and rounded; up to ten digits are told by doubles. Where the rest is so near one half that the rounding
 * could be in doubt, and outside 1e-20..1e20, printf does the work.
 */
#include "number.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Apart from what nearly all numbers take, which else would have to save registers for it. */
#if defined(__GNUC__)
#define APART static __attribute__((noinline))
#else
#define APART static
#endif

typedef struct double_double {
    double high, low;
} double_double;

/* 10^k exactly, as the sum of two doubles. */
static const double_double power_of_ten[] = {
    {1e0, 0.0},
    {1e1, 0.0},
    {1e2, 0.0},
    {1e3, 0.0},
    {1e4, 0.0},
    {1e5, 0.0},
    {1e6, 0.0},
    {1e7, 0.0},
    {1e8, 0.0},
    {1e9, 0.0},
    {1e10, 0.0},
    {1e11, 0.0},
    {1e12, 0.0},
    {1e13, 0.0},
    {1e14, 0.0},
    {1e15, 0.0},
    {1e16, 0.0},
    {1e17, 0.0},
    {1e18, 0.0},
    {1e19, 0.0},
    {1e20, 0.0},
    {1e21, 0.0},
    {1e22, 0.0},
    {1e23, 8388608.0},
    {1e24, 16777216.0},
    {1e25, -905969664.0},
    {1e26, -4764729344.0},
    {1e27, -13287555072.0},
    {1e28, 416880263168.0},
    {1e29, 8566849142784.0},
    {1e30, -19884624838656.0},
    {1e31, 364103705034752.0},
    {1e32, -5366162204393472.0},
    {1e33, 5.442476901295718e+16},
    {1e34, 5.4424769012957184e+17},
    {1e35, 3.1366338920820244e+18},
    {1e36, -4.242063737401796e+19},
    {1e37, 4.6123734179787886e+20},
    {1e38, 2.251190176543966e+21},
    {1e39, 6.029083362839682e+22},
};

static const double smallest = 1e-20, largest = 1e20;

/* Exact product. */
static double_double product(double a, double b) {
    const double high = a * b;
    const double_double result = {high, fma(a, b, -high)};

    return result;
}

/* value * 10^power */
static double_double scaled(double value, int power) {
    if (power >= 0) {
        double_double result = product(value, power_of_ten[power].high);
        result.low += value * power_of_ten[power].low;
        return result;
    }

    /* Powers up to 10^22 are exact in one double; more are not divided by. */
    const double divisor = power_of_ten[-power].high;
    const double quotient = value / divisor;
    const double_double back = product(quotient, divisor);
    const double_double result = {quotient, ((value - back.high) - back.low) / divisor};

    return result;
}

/* floor(log10(value)), or one more or less; log10(2) = 0.30103 = 1233 / 4096. */
static int guess_exponent(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    const int binary = (int)(bits >> 52) - 1023; /* of a positive number that is not too small */

    /* 4096 more, which makes 1233, so that no negative number is shifted: what is cut off makes a floor. */
    return (int)((unsigned)(binary + 4096) * 1233u >> 12) - 1233;
}

/* 10^k */
static const int64_t whole_power_of_ten[] = {1,
                                             10,
                                             100,
                                             1000,
                                             10000,
                                             100000,
                                             1000000,
                                             10000000,
                                             100000000,
                                             1000000000,
                                             10000000000,
                                             100000000000,
                                             1000000000000,
                                             10000000000000,
                                             100000000000000,
                                             1000000000000000,
                                             10000000000000000,
                                             100000000000000000};

/* So many digits are told by doubles alone: a product or quotient below 10^10 is off by 2e-6 of the last digit at most, and
 * one half added to it by 1e-6 more. */
enum { FEW_DIGITS = 10 };
static const double near_tie_of_few = 6e-6;

/* The same as decompose() for few digits. */
static int decompose_few(double value, int digits, int64_t *mantissa, int *exponent) {
    int e = guess_exponent(value);
    int power = digits - 1 - e;
    double m = power >= 0 ? value * power_of_ten[power].high : value / power_of_ten[-power].high;

    if (m >= power_of_ten[digits].high) {
        ++e;
        --power;
        m = power >= 0 ? value * power_of_ten[power].high : value / power_of_ten[-power].high;
    }

    /* Rounded to the nearest; next to a tie the rest is next to 0 or to 1. */
    const double higher = m + 0.5;
    int64_t n = (int64_t)higher;
    const double rest = higher - (double)n;
    if (n == whole_power_of_ten[digits]) {
        n /= 10;
        ++e;
    }
    *mantissa = n;
    *exponent = e;
    return fabs(rest - 0.5) <= 0.5 - near_tie_of_few && n >= whole_power_of_ten[digits - 1] &&
           n < whole_power_of_ten[digits];
}

static const double near_tie = 1e-11;

/* value = mantissa * 10^(exponent + 1 - digits) with just so many digits; 0 if that is in doubt. */
static int decompose(double value, int digits, int64_t *mantissa, int *exponent) {
    int e = guess_exponent(value);
    double_double m = scaled(value, digits - 1 - e);

    /* The high part alone may have been rounded up to the power. */
    const double power = power_of_ten[digits].high;
    if (m.high > power || (m.high == power && m.low >= 0.0)) {
        ++e;
        m = scaled(value, digits - 1 - e);
    }

    int64_t n = (int64_t)m.high;
    double rest = (m.high - (double)n) + m.low;
    const double carry = floor(rest);
    n += (int64_t)carry;
    rest -= carry;

    /* The scaling is good to 1e-13 of the last digit; printf settles ties and what is nearer to one than any time is that
     * has one digit more. */
    if (fabs(rest - 0.5) < near_tie) {
        return 0;
    }
    n += rest > 0.5;

    /* 999.9996 has become 1000. */
    if (n == whole_power_of_ten[digits]) {
        n /= 10;
        ++e;
    }
    *mantissa = n;
    *exponent = e;
    return n >= whole_power_of_ten[digits - 1] && n < whole_power_of_ten[digits];
}

/*
 * Eight digits of n < 10^8, in one word, the first one in its lowest byte: halves by 10^4, their halves by 100 and those by
 * 10, side by side. Multiplications take the place of divisions: x * 10486 >> 20 is x / 100 below 10^4, x * 103 >> 10 is
 * x / 10 below 100.
 */
static uint64_t eight_digits(uint32_t n) {
    const uint64_t fours = (n / 10000) | ((uint64_t)(n % 10000) << 32);
    const uint64_t hundreds = ((fours * 10486) >> 20) & 0x0000007f0000007f;
    const uint64_t twos = ((fours - 100 * hundreds) << 16) + hundreds;
    const uint64_t tens = ((twos * 103) >> 10) & 0x000f000f000f000f;

    return ((twos - 10 * tens) << 8) + tens + 0x3030303030303030;
}

/* In the order of the text, on any machine. */
static inline void put_word(char *out, uint64_t word) {
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(out, &word, sizeof word);
#else
    for (int i = 0; i < 8; ++i) {
        out[i] = (char)(word >> (8 * i));
    }
#endif
}

static void put_eight(char *out, uint32_t n) {
    put_word(out, eight_digits(n));
}

/* Figures end at a place, with some more that may be copied behind them: copies of a fixed size take no call. */
enum { FIGURES = 24, COPIED = 24 };

/* Digits of n < 10^17, of which `digits` are wanted, at the end of their places. */
static void put_digits(char figures[FIGURES], uint64_t n, int digits) {
    const uint64_t above = n / 100000000;

    put_eight(figures + 16, (uint32_t)(n - above * 100000000));
    if (digits > 9) {
        put_eight(figures + 8, (uint32_t)(above % 100000000));
        figures[7] = (char)('0' + above / 100000000);
    } else {
        figures[15] = (char)('0' + above);
    }
}

/* 123.45 or 0.00123, without zeros at the end. */
static char *put_fixed(char *out, const char *figures, int count, int exponent) {
    if (exponent < 0) {
        memcpy(out, "0.000", 5);
        memcpy(out + 1 - exponent, figures, COPIED);
        return out + 1 - exponent + count;
    }

    /* Figures before the point, which include zeros where the others end, then the rest. */
    const int whole = exponent + 1;
    memcpy(out, figures, COPIED);
    if (whole >= count) {
        return out + whole;
    }
    out[whole] = '.';
    memcpy(out + whole + 1, figures + whole, COPIED);
    return out + count + 1;
}

/* 1.2345e-07 */
static char *put_scientific(char *out, const char *figures, int count, int exponent) {
    const int size = exponent < 0 ? -exponent : exponent;

    *out++ = figures[0];
    if (count > 1) {
        *out++ = '.';
        memcpy(out, figures + 1, COPIED);
        out += count - 1;
    }
    *out++ = 'e';
    *out++ = exponent < 0 ? '-' : '+';
    *out++ = (char)('0' + size / 10);
    *out++ = (char)('0' + size % 10);
    return out;
}

/* The text of digits that are known. */
static int put_number(char *text, int is_negative, int64_t mantissa, int exponent, int digits) {
    char room[FIGURES + COPIED];
    const char *figures = room + FIGURES - digits;
    int count = digits;
    put_digits(room, (uint64_t)mantissa, digits);
    memset(room + FIGURES, '0', COPIED);
    while (count > 1 && figures[count - 1] == '0') {
        --count;
    }

    char *out = text;
    *out = '-';
    out += is_negative;
    out = exponent >= -4 && exponent < digits ? put_fixed(out, figures, count, exponent)
                                              : put_scientific(out, figures, count, exponent);
    *out = '\0';
    return (int)(out - text);
}

/*
 * The same of ten digits, from 0.000123 to 1234567890: the first one, a word of eight, and the last one. The word is written
 * from its register, and once more from the point on. Nothing that has been written is read, which would have to wait for it.
 */
static inline int put_ten(char *text, int is_negative, uint32_t nine, int last, int exponent) {
    const uint32_t first = nine / 100000000;
    const uint64_t word = eight_digits(nine - first * 100000000);

    /* Without zeros at the end. */
    int count = last != 0 ? 10 : 9;
    for (uint64_t rest = word; count > 1 && count < 10 && rest >> 56 == '0'; rest <<= 8) {
        --count;
    }

    char *out = text;
    *out = '-';
    out += is_negative;
    if (exponent < 0) {
        memcpy(out, "0.000", 5);
        out += 1 - exponent;
    }
    out[0] = (char)('0' + first);
    put_word(out + 1, word);
    out[9] = (char)('0' + last);

    /* Figures before the point include zeros where the others end. Half of the shift twice, as all of it may be the word. */
    const int whole = exponent + 1;
    if (exponent >= 0 && whole < count) {
        out[whole] = '.';
        put_word(out + whole + 1, (word >> (4 * exponent)) >> (4 * exponent));
        out[10] = (char)('0' + last);
        out += count + 1;
    } else {
        out += whole > count ? whole : count;
    }
    *out = '\0';
    return (int)(out - text);
}

/* Where few digits are in doubt, or many are wanted. */
APART int format_any(char text[NUMBER_TEXT_SIZE], double value, int digits) {
    const double size = fabs(value);
    int64_t mantissa;
    int exponent;

    if (size >= smallest && size <= largest && decompose(size, digits, &mantissa, &exponent)) {
        return put_number(text, value < 0.0, mantissa, exponent, digits);
    }
    return snprintf(text, NUMBER_TEXT_SIZE, "%.*g", digits, value);
}

int number_format(char text[NUMBER_TEXT_SIZE], double value, int digits) {
    const double size = fabs(value);
    int64_t mantissa;
    int exponent;

    /* Counts, and nothing at all. */
    if (value < 10.0 && !signbit(value) && value == (double)(int)value) {
        text[0] = (char)('0' + (int)value);
        text[1] = '\0';
        return 1;
    }

    /* Where one way is in doubt the next one, which takes longer. */
    if (digits <= FEW_DIGITS && size >= smallest && size <= largest &&
        decompose_few(size, digits, &mantissa, &exponent)) {
        if (exponent < -4 || exponent >= digits) {
            return put_number(text, value < 0.0, mantissa, exponent, digits);
        }

        /* Filled up with zeros. */
        const int is_short = digits < FEW_DIGITS;
        const int64_t nine =
            is_short ? mantissa * whole_power_of_ten[FEW_DIGITS - 1 - digits] : mantissa / 10;
        const int last = is_short ? 0 : (int)(mantissa - 10 * nine);
        return put_ten(text, value < 0.0, (uint32_t)nine, last, exponent);
    }
    return format_any(text, value, digits);
}

static const char *skip_digits(const char *text) {
    while (*text >= '0' && *text <= '9') {
        ++text;
    }
    return text;
}

/* [+-] digits [. digits] [e [+-] digits]: what strtod() takes beyond that (hex, nan, inf) is refused. */
int number_is_plain(const char *text) {
    const char *start = text + (*text == '+' || *text == '-');
    const char *end = skip_digits(start);
    ptrdiff_t digits = end - start;

    /* Digits before the point, behind it, or both. */
    if (*end == '.') {
        const char *fraction = end + 1;
        end = skip_digits(fraction);
        digits += end - fraction;
    }
    if (digits == 0) {
        return 0;
    }

    if (*end == 'e' || *end == 'E') {
        const char *exponent = end + 1;
        exponent += *exponent == '+' || *exponent == '-';
        end = skip_digits(exponent);
        if (end == exponent) {
            return 0;
        }
    }
    return *end == '\0';
}
