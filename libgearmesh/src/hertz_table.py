#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Make hertz_table.c, the tables of the inverse of the line contact law, and state their error.

    hertz_table.py > hertz_table.c

The law delta = B q (L - ln q) has one universal inverse: with w = L - ln q and eta = delta / (B e^L) it reads
w e^-w = eta, w > 1. The tables hold y = 1 / w as polynomials in eta, in eight parts of every octave, so that the
place is found from the bits of a double. Computed with 40 digits, interpolated at Chebyshev points, rounded once.
"""
import math
import sys
from decimal import Decimal, getcontext

getcontext().prec = 40

SEGMENTS = 8          # per octave; hertz.h knows it as three bits of the mantissa
DEGREE = 5
LEAST_EXPONENT = -56  # first octave is [2^-56, 2^-55)
LAST_EXPONENT = -4    # last octave is [2^-4, 2^-3)
HIGH_DEGREE = 15      # above 2^-3, where w nears the end of the law at w = 2

LARGEST = 2 * Decimal(-2).exp()
PI = Decimal("3.141592653589793238462643383279502884197")

HEAD = """\
/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The universal inverse of the line contact law, y = 1 / w with w e^-w = eta; see hertz.h. Made by hertz_table.py,
 * do not edit. Relative error of y and of y / (1 - y), the stiffness: {low:.1e} below eta = 1/8, {high:.1e} above.
 */
#include "hertz.h"
#include "internal.h"

/* clang-format off */
"""


def reciprocal(eta):
    """y = 1 / w, by Newton's iteration for ln w - w = ln eta."""
    target = eta.ln()
    w = max(Decimal(2), -target + (-target).ln())
    for _ in range(100):
        change = (w.ln() - w - target) / (1 / w - 1)
        w = max(w - change, (1 + w) / 2)
        if abs(change) < Decimal(10) ** -36:
            return 1 / w
    raise SystemExit(f"no convergence at {eta}")


def cosine(x):
    """cos of a Decimal in [0, pi] by its series."""
    term = total = Decimal(1)
    for k in range(1, 40):
        term *= -x * x / ((2 * k - 1) * (2 * k))
        total += term
    return total


def polynomial(begin, end, middle, scale, degree):
    """Coefficients in t = (eta - middle) / scale of the interpolant on [begin, end], lowest first."""
    count = degree + 1
    points = [(begin + end) / 2 + (end - begin) / 2 * cosine(PI * (2 * k + 1) / (2 * count)) for k in range(count)]
    t = [(point - middle) / scale for point in points]
    c = [reciprocal(point) for point in points]
    for j in range(1, count):  # divided differences
        for i in range(count - 1, j - 1, -1):
            c[i] = (c[i] - c[i - 1]) / (t[i] - t[i - j])
    result = [Decimal(0)] * count
    for i in range(count - 1, -1, -1):  # Horner's rule on polynomials
        result = [(result[k - 1] if k > 0 else 0) - t[i] * result[k] for k in range(count)]
        result[0] += c[i]
    return [float(value) for value in result]


def error(begin, end, middle, scale, coefficients):
    """Largest relative error of y / (1 - y), which is that of y times 1 / (1 - y), at some points."""
    worst = 0.0
    for k in range(9):
        eta = begin + (end - begin) * k / 8
        t = (eta - middle) / scale
        value = Decimal(0)
        for c in reversed(coefficients):
            value = value * t + Decimal(c)
        y = reciprocal(eta)
        worst = max(worst, float(abs(value - y) / (y * (1 - y))))
    return worst


def rows():
    """(coefficients, error) of the segments in their order."""
    for exponent in range(LEAST_EXPONENT, LAST_EXPONENT + 1):
        octave = Decimal(2) ** exponent
        for k in range(SEGMENTS):
            begin = octave * (1 + Decimal(k) / SEGMENTS)
            end = octave * (1 + Decimal(k + 1) / SEGMENTS)
            where = begin, end, (begin + end) / 2, octave
            coefficients = polynomial(*where, DEGREE)
            yield coefficients, error(*where, coefficients)


def high_rows():
    """The same for [1/8, 1/4] and [1/4, 2 e^-2], in t = (eta - middle) / half length."""
    for begin, end in (Decimal("0.125"), Decimal("0.25")), (Decimal("0.25"), LARGEST):
        where = begin, end, Decimal(float((begin + end) / 2)), Decimal(float((end - begin) / 2))
        coefficients = polynomial(*where, HIGH_DEGREE)
        yield coefficients, error(*where, coefficients), float(where[2]), float(where[3])


def write_table(out, name, sizes, table):
    out.write(f"const double {name}{sizes} = {{\n")
    for row in table:
        text = [repr(value) for value in row]
        lines = [", ".join(text[k:k + 4]) for k in range(0, len(text), 4)]
        out.write("    {" + ",\n     ".join(lines) + "},\n")
    out.write("};\n")


def main():
    if len(sys.argv) != 1:
        raise SystemExit(__doc__)
    low, high = list(rows()), list(high_rows())
    out = sys.stdout
    out.write(HEAD.format(low=max(row[1] for row in low), high=max(row[1] for row in high)))
    write_table(out, "gmi_hertz_table", "[GMI_HERTZ_ROWS][GMI_HERTZ_COEFFICIENTS]", [row[0] for row in low])
    out.write("\n/* Middle and inverse half length of the segment, then the coefficients. */\n")
    write_table(out, "gmi_hertz_high_table", "[2][2 + GMI_HERTZ_HIGH_COEFFICIENTS]",
                [[row[2], 1.0 / row[3], *row[0]] for row in high])
    out.write(f"\nconst double gmi_hertz_least = {2.0**LEAST_EXPONENT!r};\n"
              f"const double gmi_hertz_least_reciprocal = {float(reciprocal(Decimal(2)**LEAST_EXPONENT))!r};\n"
              f"const double gmi_hertz_largest = {float(LARGEST)!r};\n")


if __name__ == "__main__":
    main()
