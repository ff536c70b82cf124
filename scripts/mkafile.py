# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Traces of a text file of Klingelnberg machines (.mka), to be drawn. What is in it, and where that is known from, is in
libgearmesh/docs/measured-flanks.md; gearflanks reads it more strictly, against the gear that it should be of."""
import math
import re

import numpy as np

from flankfile import FlankFileError, Trace

FIRST_LINE = re.compile(r"HEADER\s+KS\.(M\w)\.FILE")
TOOTH = re.compile(r"(?:zahn-nr|tooth[- ]n|tooth:)[^:\d]*:?\s*(\d+)", re.IGNORECASE)
FLANK = re.compile(r"(links|left)|(rechts|right)", re.IGNORECASE)
PLACE = re.compile(r"([xzd])\s*=\s*([-+.,\d]+)", re.IGNORECASE)
CODE = re.compile(r"\s*(\d\d?)\s*:[^:]*:\s*(.*)")
NO_POINT_UM = -1e6  # and below stands for no point


def is_machine_file(path):
    """Whether it begins as files of these machines do: with traces, or with values that were evaluated."""
    try:
        with open(path, encoding="utf-8-sig", errors="replace") as file:
            return FIRST_LINE.match(file.readline(200)) is not None
    except OSError:
        return False


def number_of(text):
    return float(text.replace(",", "."))


class _Header:
    """Numbers of the header lines, by code."""

    def __init__(self, path, lines):
        self.path = path
        found = (CODE.match(line) for line in lines)
        self.texts = {int(match[1]): match[2] for match in found if match}
        undefined = (re.match(r"UNDEFINED\s+(-[.,\d]+)", line) for line in lines)
        self.no_point_um = max([NO_POINT_UM, *(number_of(match[1]) for match in undefined if match)])

    def numbers(self, code, what):
        numbers = [number_of(text) for text in re.findall(r"[-+]?\d+(?:[.,]\d+)?", self.texts.get(code, ""))]
        if not numbers:
            raise FlankFileError(f"{self.path}: the header must say in its line {code} {what} (got nothing)")
        return numbers

    def angle(self, code, what):
        """Degrees, minutes and seconds, in radians."""
        parts = self.numbers(code, what)[:3]
        return math.radians(sum(abs(part) / 60.0**i for i, part in enumerate(parts)))

    def base_radius_mm(self):
        module_mm, teeth = self.numbers(21, "the module")[0], self.numbers(22, "the teeth")[0]
        alpha, beta = self.angle(24, "the pressure angle"), self.angle(23, "the helix angle")
        return module_mm * abs(teeth) / (2.0 * math.cos(beta)) * math.cos(math.atan(math.tan(alpha) / math.cos(beta)))

    def range_mm(self, is_profile, flank):
        """First and last place of a trace: roll lengths of a profile, distances from the datum of a helix."""
        ends = [self.numbers(code, f"where the traces {what}")
                for code, what in zip((41, 44) if is_profile else (61, 64), ("begin", "end"))]
        ends = [numbers[1 if flank == "right" and len(numbers) > 1 else 0] for numbers in ends]
        if is_profile:
            base_mm = self.base_radius_mm()
            ends = [math.sqrt(max(diameter_mm**2 / 4.0 - base_mm**2, 0.0)) for diameter_mm in ends]
        return ends


def read_traces(path):
    """(name of the profile's coordinate, traces in the order of the file)."""
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        lines = file.read().splitlines()
    if FIRST_LINE.match(lines[0])[1] != "MK":
        raise FlankFileError(f"{path}:1: must be a file of measured curves; this one holds values that were evaluated: give "
                             "the .mka of this measurement")
    header = _Header(path, lines)
    traces, places, at = [], set(), 0
    while at < len(lines):
        tooth = TOOTH.search(lines[at])
        place = PLACE.search(lines[at])
        begin, at = at, at + 1
        if not tooth or not place:
            continue

        # Which trace, and its values.
        behind = lines[begin][tooth.end():]
        flank = FLANK.search(behind)
        count = flank and re.search(r"\d+", behind[flank.end():])
        if not count:
            raise FlankFileError(f"{path}:{begin + 1}: a trace must have its flank and a number of values behind the tooth")
        deviations_um = []
        while at < len(lines) and len(deviations_um) < int(count[0]):
            try:
                deviations_um += [number_of(word) for word in lines[at].split()]
            except ValueError:
                break
            at += 1
        if len(deviations_um) != int(count[0]):
            raise FlankFileError(f"{path}:{begin + 1}: the trace must have {count[0]} values (got {len(deviations_um)})")

        # A topography may repeat the trace of a block before it.
        kind = "profile" if place[1].lower() == "z" else "helix"
        name = "left" if flank[1] else "right"
        key = (int(tooth[1]), name, kind, place[2])
        ends_mm = header.range_mm(kind == "profile", name)
        points = [point for point in zip(np.linspace(*ends_mm, len(deviations_um)), deviations_um)
                  if point[1] > header.no_point_um]
        if key not in places and len(points) > 1:
            places.add(key)
            traces.append(Trace(*key[:3], points))
    if not traces:
        raise FlankFileError(f"{path}: must have a trace of a profile or a helix")
    return "roll_length_mm", traces
