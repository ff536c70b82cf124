/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The value is scaled by a power of ten to an integer of the wanted number of digits, in double-double
 * arithmetic (about 100 bits), and rounded. Where the rest is so near one half that the rounding could
 * be in doubt, and outside 1e-20..1e20, printf does the work.
 */
#include "number.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

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

/* floor(log10(value)), or one more or less; log10(2) = 0.30103. */
static int guess_exponent(double value) {
    int binary;
    (void)frexp(value, &binary);

    /* The shift by 100 makes truncation a floor. */
    return (int)((binary - 1) * 0.30103 + 100.0) - 100;
}

/* value = mantissa * 10^(exponent + 1 - digits) with just so many digits; 0 if that is in doubt. */
static int decompose(double value, int digits, uint64_t *mantissa, int *exponent) {
    int e = guess_exponent(value);
    double_double m = scaled(value, digits - 1 - e);

    /* The high part alone may have been rounded up to the power. */
    const double power = power_of_ten[digits].high;
    if (m.high > power || (m.high == power && m.low >= 0.0)) {
        ++e;
        m = scaled(value, digits - 1 - e);
    }

    uint64_t n = (uint64_t)m.high;
    double rest = (m.high - (double)n) + m.low;
    const double carry = floor(rest);
    n += (uint64_t)(int64_t)carry;
    rest -= carry;

    /* The scaling is good to 1e-13 of the last digit; printf settles ties and what is near one. */
    if (fabs(rest - 0.5) < 1e-6) {
        return 0;
    }
    n += rest > 0.5;

    /* 999.9996 has become 1000. */
    if (n == (uint64_t)power_of_ten[digits].high) {
        n /= 10;
        ++e;
    }
    *mantissa = n;
    *exponent = e;
    return n >= (uint64_t)power_of_ten[digits - 1].high && n < (uint64_t)power_of_ten[digits].high;
}

/* Digits of n, right-aligned before `end`. */
static void put_digits(char *end, uint64_t n) {
    static const char pairs[] = "0001020304050607080910111213141516171819"
                                "2021222324252627282930313233343536373839"
                                "4041424344454647484950515253545556575859"
                                "6061626364656667686970717273747576777879"
                                "8081828384858687888990919293949596979899";
    while (n >= 10) {
        end -= 2;
        memcpy(end, pairs + 2 * (n % 100), 2);
        n /= 100;
    }
    if (n > 0) {
        *--end = (char)('0' + n);
    }
}

/* 123.45 or 0.00123, without zeros at the end. */
static char *put_fixed(char *out, const char *figures, int count, int exponent) {
    if (exponent < 0) {
        *out++ = '0';
        *out++ = '.';
        for (int i = -1; i > exponent; --i) {
            *out++ = '0';
        }
        memcpy(out, figures, (size_t)count);
        return out + count;
    }

    /* Figures before the point, zeros where there are none, then the rest. */
    const int whole = exponent + 1 < count ? exponent + 1 : count;
    int i = 0;
    for (; i < whole; ++i) {
        *out++ = figures[i];
    }
    for (; i <= exponent; ++i) {
        *out++ = '0';
    }
    if (whole < count) {
        *out++ = '.';
        memcpy(out, figures + whole, (size_t)(count - whole));
        out += count - whole;
    }
    return out;
}

/* 1.2345e-07 */
static char *put_scientific(char *out, const char *figures, int count, int exponent) {
    const int size = exponent < 0 ? -exponent : exponent;

    *out++ = figures[0];
    if (count > 1) {
        *out++ = '.';
        memcpy(out, figures + 1, (size_t)(count - 1));
        out += count - 1;
    }
    *out++ = 'e';
    *out++ = exponent < 0 ? '-' : '+';
    *out++ = (char)('0' + size / 10);
    *out++ = (char)('0' + size % 10);
    return out;
}

int number_format(char text[NUMBER_TEXT_SIZE], double value, int digits) {
    const double size = fabs(value);
    uint64_t mantissa;
    int exponent;

    if (value == 0.0 && !signbit(value)) {
        text[0] = '0';
        text[1] = '\0';
        return 1;
    }
    if (!(size >= smallest && size <= largest) || !decompose(size, digits, &mantissa, &exponent)) {
        return snprintf(text, NUMBER_TEXT_SIZE, "%.*g", digits, value);
    }

    char figures[20];
    int count = digits;
    put_digits(figures + digits, mantissa);
    while (count > 1 && figures[count - 1] == '0') {
        --count;
    }

    char *out = text;
    if (value < 0.0) {
        *out++ = '-';
    }
    out = exponent >= -4 && exponent < digits ? put_fixed(out, figures, count, exponent)
                                              : put_scientific(out, figures, count, exponent);
    *out = '\0';
    return (int)(out - text);
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
