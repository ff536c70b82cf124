# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Flank and pitch files as libgearmesh/docs/flank-files.md describes them, read as strictly as the library does.

Deviations are in um, > 0 is material added. A side is 0 (drive) or 1 (coast); ALL stands for `*`.
"""
import re

import numpy as np

from program import InputError

FLANK_COLUMNS = ("tooth", "flank", "t1", "t2", "deviation_um")
PITCH_COLUMNS = ("tooth", "flank", "deviation_um")
TRACE_COLUMNS = ("tooth", "flank", "trace", "face_mm", "roll_length_mm", "deviation_um")
DIAMETER_COLUMNS = TRACE_COLUMNS[:4] + ("diameter_mm", "deviation_um")
SIDES = ("drive", "coast")
ALL = -1
POSITION_TOLERANCE = 1e-5
MAX_NODES = 10000
MAX_TEETH = 1000  # more cannot be shown
LINE_LENGTH = 1000

NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
FIELD_PATTERNS = {"tooth": r"[0-9]+|\*", "flank": r"drive|coast|\*"}
TRACE_PATTERNS = {"tooth": r"[0-9]+", "flank": r"left|right|drive|coast", "trace": r"profile|helix"}
RIGHT = {
    FIELD_PATTERNS["tooth"]: "a whole number from 0 on, or *",
    FIELD_PATTERNS["flank"]: "drive, coast or *",
    TRACE_PATTERNS["tooth"]: "a whole number from 0 on",
    TRACE_PATTERNS["flank"]: "left, right, drive or coast",
    TRACE_PATTERNS["trace"]: "profile or helix",
    NUMBER: "a number like 1.5 or -2e-3",
}


class FlankFileError(InputError):
    """A file is not what it should be; the text names file and line, the value, and what would be right."""


# ----------------------------------------------------------------------------------------------------
# Lines and fields
# ----------------------------------------------------------------------------------------------------


def _fail(path, line, text):
    raise FlankFileError(f"{path}:{line}: {text}" if line else f"{path}: {text}")


def _read_lines(path):
    """Text of all lines, without their ends."""
    try:
        with open(path, "rb") as file:
            content = file.read()
    except OSError as error:
        _fail(path, 0, f"cannot be read: {error.strerror}")
    if b"\0" in content:
        line = content[: content.index(b"\0")].count(b"\n") + 1
        _fail(path, line, "must be plain text (got a zero byte)")
    text = content.decode("utf-8-sig", errors="replace")
    lines = text.split("\n")
    if not lines[-1]:
        lines.pop()  # the last line has an end
    return [line[:-1] if line.endswith("\r") else line for line in lines]


def _other_delimiter(line):
    if ";" in line:
        return "semicolons"
    return "tabs" if "\t" in line and "," not in line else None


def _check_delimiter(path, number, line):
    if re.match(r"\s*[;\[]", line):
        _fail(path, number, "must be a flank file or measured traces (got a parameter file)")
    delimiter = _other_delimiter(line)
    if delimiter:
        _fail(path, number, f"fields must be separated by commas, with a point as decimal sign (got {delimiter})")


def _fields(line):
    return tuple(field.strip(" \t") for field in line.split(","))


def _check_header(path, number, line, columns):
    if _fields(line) == columns:
        return
    _check_delimiter(path, number, line)
    hint = "; this is a pitch file, which comes second" if _fields(line) == PITCH_COLUMNS else ""
    _fail(path, number, f"the header must be {','.join(columns)} (got '{line[:60].strip()}'){hint}")


def _fail_row(path, number, line, columns, patterns):
    """Say what is wrong with a row that does not match."""
    if len(line) > LINE_LENGTH:
        _fail(path, number, f"a line must have at most {LINE_LENGTH} characters (got more)")
    if "\r" in line:
        _fail(path, number, "lines must end with LF or CRLF (got a carriage return within the line)")
    _check_delimiter(path, number, line)
    fields = _fields(line)
    if len(fields) != len(columns):
        hint = "; a decimal comma makes two fields of one number: write 1.5" if len(fields) > len(columns) else ""
        wanted = f"{len(columns)} fields, {','.join(columns)}"
        _fail(path, number, f"a row must have {wanted} (got {len(fields)}){hint}")
    for column, field in zip(columns, fields):
        pattern = patterns.get(column, NUMBER)
        if not re.fullmatch(pattern, field):
            _fail(path, number, f"{column}: must be {RIGHT[pattern]} (got '{field[:40]}')")


class Rows:
    """The rows of a file as arrays: where they stand, what they are for, and their numbers."""

    def __init__(self, path, line, tooth, side, values):
        self.path = path
        self.line = np.array(line)
        self.tooth = np.array(tooth)
        self.side = np.array(side)
        self.values = np.array(values, dtype=float)  # [row, column behind tooth and flank]


def _is_content(line):
    return bool(line.strip(" \t")) and not line.lstrip(" \t").startswith("#")


def _matched_rows(path, columns, patterns):
    """Line number and fields of all rows below the header."""
    fields = [patterns.get(column, NUMBER) for column in columns]
    row = re.compile(",".join(rf"[ \t]*({pattern})[ \t]*" for pattern in fields)).fullmatch
    found = []
    header = None
    lines = _read_lines(path)
    for number, line in enumerate(lines, 1):
        match = row(line) if header is not None else None
        if match and len(line) <= LINE_LENGTH:
            found.append((number, match.groups()))
        elif not _is_content(line):
            continue
        elif header is None:
            _check_header(path, number, line, columns)
            header = number
        else:
            _fail_row(path, number, line, columns, patterns)
    if header is None:
        _fail(path, len(lines), f"the file must have the header {','.join(columns)} and rows below it (got nothing)")
    if not found:
        _fail(path, header, "there must be rows below the header (got none)")
    return found


def _read_rows(path, columns, teeth):
    """All rows below the header; `teeth` is None or the number that tooth must stay below."""
    sides = {"drive": 0, "coast": 1, "*": ALL}
    found = []
    for number, (tooth, flank, *numbers) in _matched_rows(path, columns, FIELD_PATTERNS):
        index = ALL if tooth == "*" else int(tooth)
        if index >= (teeth or MAX_TEETH):
            _fail(path, number, f"tooth: must be 0 to {(teeth or MAX_TEETH) - 1}, or * (got {tooth})")
        found.append((number, index, sides[flank], *map(float, numbers)))
    number, tooth, side, *values = zip(*found)
    rows = Rows(path, number, tooth, side, np.column_stack(values))
    _check_finite(rows)
    return rows


def _check_finite(rows):
    bad = np.flatnonzero(~np.isfinite(rows.values).all(axis=1))
    if len(bad):
        _fail(rows.path, rows.line[bad[0]], "numbers must be finite, like 1.5 (got one that is too large)")


def slot_name(tooth, side):
    tooth_name = "*" if tooth == ALL else tooth
    return f"tooth {tooth_name}, flank {'*' if side == ALL else SIDES[side]}"


# ----------------------------------------------------------------------------------------------------
# Grid
# ----------------------------------------------------------------------------------------------------


def _count_grid_lines(positions):
    """Distinct positions; those with a quarter of the most rows or less are taken for slips of the pen."""
    ordered = np.sort(positions)
    starts = np.r_[0, np.flatnonzero(np.diff(ordered) > 2.5 * POSITION_TOLERANCE) + 1]
    counts = np.diff(np.r_[starts, len(ordered)])
    lines = int((counts > counts.max() / 4).sum())
    return lines if lines >= 2 else len(counts)


def _axis_nodes(rows, first_set, axis):
    """Number of nodes along t1 (axis 0) or t2 (axis 1), from the first set of the file."""
    name = FLANK_COLUMNS[2 + axis]
    position = rows.values[:, axis]
    outside = np.flatnonzero((position < -POSITION_TOLERANCE) | (position > 1 + POSITION_TOLERANCE))
    if len(outside):
        _fail(rows.path, rows.line[outside[0]], f"{name}: must be from 0 to 1 (got {position[outside[0]]:g})")
    position, line = position[first_set], rows.line[first_set]
    nodes = _count_grid_lines(position)
    if nodes < 2:
        _fail(rows.path, line[0], f"{name}: must have at least two positions (got {position[0]:g} alone)")
    for end, at in ((0.0, position.argmin()), (1.0, position.argmax())):
        if abs(position[at] - end) > POSITION_TOLERANCE:
            _fail(rows.path, line[at], f"{name}: must be a grid from 0 to 1 (got an end at {position[at]:g})")
    if nodes > MAX_NODES:
        _fail(rows.path, line[0], f"{name}: must have 2 to {MAX_NODES} positions (got {nodes})")
    return nodes


def _node_indices(rows, nodes):
    """Indices [row, axis] of the nodes that the rows are for."""
    position, intervals = rows.values[:, :2], np.array(nodes) - 1
    index = np.rint(position * intervals).astype(int)
    off = np.abs(position - index / intervals) > POSITION_TOLERANCE * (1 + 1e-9)
    bad = np.flatnonzero(off.any(axis=1))
    if len(bad):
        axis = int(off[bad[0]].argmax())
        wrong, nearest = position[bad[0], axis], index[bad[0], axis] / intervals[axis]
        _fail(
            rows.path,
            rows.line[bad[0]],
            f"{FLANK_COLUMNS[2 + axis]}: must be on the uniform grid of {nodes[0]} x {nodes[1]} nodes that the file begins "
            f"with, for example {nearest:.6g} (got {wrong:g})",
        )
    return index


def _fill_set(rows, chosen, index, nodes):
    """Deviations [t1, t2] of one set."""
    name = slot_name(rows.tooth[chosen[0]], rows.side[chosen[0]])
    flat = index[chosen, 0] * nodes[1] + index[chosen, 1]
    _, first = np.unique(flat, return_index=True)
    again = np.setdiff1d(np.arange(len(flat)), first)
    if len(again):
        t1, t2 = rows.values[chosen[again[0]], :2]
        line = rows.line[chosen[again[0]]]
        _fail(rows.path, line, f"{name}: must have one row per node (got a second one for t1 = {t1:g}, t2 = {t2:g})")
    missing = np.setdiff1d(np.arange(nodes[0] * nodes[1]), flat)
    if len(missing):
        t1, t2 = missing[0] // nodes[1] / (nodes[0] - 1), missing[0] % nodes[1] / (nodes[1] - 1)
        _fail(
            rows.path,
            rows.line[chosen[0]],
            f"{name}, which begins here: must have rows for {nodes[0]} x {nodes[1]} nodes "
            f"(got none for t1 = {t1:.6g}, t2 = {t2:.6g})",
        )
    table = np.empty(nodes[0] * nodes[1])
    table[flat] = rows.values[chosen, 2]
    return table.reshape(nodes)


# ----------------------------------------------------------------------------------------------------
# Files
# ----------------------------------------------------------------------------------------------------


def _slots(rows):
    """Row numbers of each (tooth, side), in the order of the file."""
    key = rows.tooth * 3 + rows.side
    order = np.argsort(key, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(key[order])) + 1)
    groups.sort(key=lambda group: group[0])
    return {(int(rows.tooth[group[0]]), int(rows.side[group[0]])): group for group in groups}


def read_flanks(path, teeth=None):
    """Sets of a deviation file: {(tooth, side): deviations in um, [t1, t2]}."""
    rows = _read_rows(path, FLANK_COLUMNS, teeth)
    slots = _slots(rows)
    first_set = next(iter(slots.values()))
    nodes = tuple(_axis_nodes(rows, first_set, axis) for axis in (0, 1))
    index = _node_indices(rows, nodes)
    return {slot: _fill_set(rows, chosen, index, nodes) for slot, chosen in slots.items()}


def read_pitch(path, teeth=None):
    """Rows of a pitch file: {(tooth, side): deviation in um}."""
    rows = _read_rows(path, PITCH_COLUMNS, teeth)
    slots = _slots(rows)
    for slot, chosen in slots.items():
        if len(chosen) > 1:
            first, second = rows.line[chosen[:2]]
            _fail(path, second, f"{slot_name(*slot)}: must have one row (got a second one, the first is in line {first})")
    return {slot: float(rows.values[chosen[0], 0]) for slot, chosen in slots.items()}


def winner(sets, tooth, side):
    """What counts for a flank: the most special entry, or None."""
    for slot in ((tooth, side), (tooth, ALL), (ALL, side), (ALL, ALL)):
        if slot in sets:
            return sets[slot]
    return None


def highest_tooth(*files):
    """The highest tooth that has rows of its own, ALL if there is none."""
    return max((tooth for sets in files for tooth, _ in sets), default=ALL)


def single_pitch_um(pitch_um):
    """f_pi of each tooth: its flank against that of the tooth before it, round the gear."""
    return pitch_um - np.roll(pitch_um, 1)


def total_pitch_um(pitch_um):
    """F_p: the largest difference of the positions of any two flanks."""
    return float(pitch_um.max() - pitch_um.min())


# ----------------------------------------------------------------------------------------------------
# Traces as they were measured (libgearmesh/docs/measured-flanks.md)
# ----------------------------------------------------------------------------------------------------


class Trace:
    """One trace: `along` is face_mm of a helix, roll length or diameter of a profile."""

    def __init__(self, tooth, flank, kind, points):
        self.tooth, self.flank, self.kind = tooth, flank, kind
        self.along_mm, self.deviation_um = np.array(sorted(points)).T


def _header_of(path):
    return next((_fields(line) for line in _read_lines(path) if _is_content(line)), ())


def is_trace_file(path):
    return _header_of(path)[:3] == TRACE_COLUMNS[:3]


def read_traces(path):
    """(name of the profile's coordinate, traces in the order of the file); a trace goes on while its place stays."""
    columns = DIAMETER_COLUMNS if _header_of(path) == DIAMETER_COLUMNS else TRACE_COLUMNS
    groups = []
    previous = None
    for number, (tooth, flank, kind, *numbers) in _matched_rows(path, columns, TRACE_PATTERNS):
        face, profile, deviation = map(float, numbers)
        if not np.isfinite([face, profile, deviation]).all():
            _fail(path, number, "numbers must be finite, like 1.5 (got one that is too large)")
        place, along = (face, profile) if kind == "profile" else (profile, face)
        key = (int(tooth), flank, kind)
        if previous is None or key != previous[0] or abs(place - previous[1]) > 0.01:
            previous = (key, place)
            groups.append((number, key, []))
        groups[-1][2].append((along, deviation))
    for number, key, points in groups:
        if len(points) < 2:
            _fail(path, number, f"the {key[2]} trace of tooth {key[0]}, flank {key[1]}: must have 2 points or more (got 1)")
    return columns[4], [Trace(*key, points) for _, key, points in groups]
