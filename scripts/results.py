# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""What gearsim writes, CSV or HDF5, as columns of numbers and what the file says of its origin."""
import functools
import io
import os
import re

import numpy as np

import program
import stored

COLUMNS = ("time_s", "pinion_speed_rpm", "pinion_angle_rad", "contact_force_N")
PAIRS_COLUMN = "pairs_in_contact"
BYTES_AT_ONCE = 1 << 20  # of a CSV
LARGEST = 1e150  # its square is a number as well
HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"

# A sampled signal is trusted up to this share of its rate: the low-pass of gearsim passes it unchanged.
TRUSTED_SHARE_OF_RATE = 0.4
# From this share of the highest speed on, the pinion angle has to go on with every row.
TURNING_SHARE_OF_SPEED = 0.1
# A speed that changes less than this, in shares of the highest one, is constant.
CONSTANT_SHARE_OF_SPEED = 0.005


class RunError(program.InputError):
    """A run cannot be read or cannot be analysed; the text says why."""


# ----------------------------------------------------------------------------------------------------
# Runs
# ----------------------------------------------------------------------------------------------------


class Run:
    """Columns of a result of gearsim, arrays or stored.Column, and what it says of its origin.

    speed_rpm and angle_rad are those of the pinion without their direction: the amount of its speed, and the angle it
    has turned through, whichever way. Orders do not depend on the direction.
    """

    def __init__(self, time_s, speed_rpm, angle_rad, force_N, pairs=None, provenance=None):
        self.time_s = time_s
        self.start_rpm, self.end_rpm = float(speed_rpm[0]), float(speed_rpm[-1])
        self.reverses = bool(speed_rpm.min() < 0 < speed_rpm.max())
        self.speed_rpm = amount(speed_rpm)
        self.angle_rad = turned_angle(angle_rad)
        self.force_N = force_N
        self.pairs = pairs  # None if the column is missing
        self.provenance = provenance or {}
        self.incomplete = None  # the reason if the run ended early
        self.rate_Hz = (len(time_s) - 1) / (time_s[-1] - time_s[0])

    @property
    def trusted_Hz(self):
        return TRUSTED_SHARE_OF_RATE * self.rate_Hz

    @property
    def is_constant(self):
        """Whether there is one speed only: then time takes its place in the pictures."""
        return self.speed_rpm.max() - self.speed_rpm.min() <= CONSTANT_SHARE_OF_SPEED * self.speed_rpm.max()

    def sweep_rpm_per_s(self):
        return self._sweep_rpm_per_s

    @functools.cached_property
    def _sweep_rpm_per_s(self):
        """How fast the speed changes: of pieces of the run, the rate that all but one in twenty stay below."""
        pieces = int(min(200, max(2, len(self.time_s) // 16)))
        edges = np.linspace(0, len(self.time_s), pieces + 1).astype(int)
        middle_s, middle_rpm = (
            np.array([values[first:last].mean() for first, last in zip(edges[:-1], edges[1:])])
            for values in (self.time_s, self.speed_rpm)
        )
        return float(np.percentile(np.abs(np.diff(middle_rpm) / np.diff(middle_s)), 95))


def amount(speed_rpm):
    if not isinstance(speed_rpm, stored.Rows):
        return np.abs(speed_rpm)
    if speed_rpm.min() >= 0:
        return speed_rpm
    return stored.like(speed_rpm, (np.abs(part) for _, part in stored.blocks(speed_rpm)))


def turned_angle(angle_rad):
    """The angle turned through, which grows whichever way the pinion turns."""
    if all((np.diff(part) >= 0).all() for _, part in stored.blocks(angle_rad, before=1)):
        return angle_rad

    def parts():
        turned_rad, last_rad = 0.0, angle_rad[0]
        for _, part in stored.blocks(angle_rad):
            part_rad = turned_rad + np.cumsum(np.abs(np.diff(part, prepend=last_rad)))
            turned_rad, last_rad = part_rad[-1], part[-1]
            yield part_rad

    return stored.like(angle_rad, parts())


def read_run(path):
    """Read a result of gearsim, CSV or HDF5, once, into columns in a file; raises RunError with a message for people."""
    columns, provenance, incomplete = _read(path, _wanted, stored.Column)
    time_s, speed_rpm, angle_rad = (columns[name] for name in COLUMNS[:3])
    check_numbers(path, columns)
    check_times(path, COLUMNS[0], time_s)
    if speed_rpm.min() == 0.0 == speed_rpm.max():
        raise RunError(f"{path}: pinion_speed_rpm is 0 throughout: there are no orders of a pinion that stands still")
    check_turning(path, COLUMNS[2], speed_rpm, angle_rad)
    run = Run(*columns.values(), provenance=provenance)
    run.incomplete = incomplete
    return run


def read_columns(path, wanted):
    """{name: values} of a CSV or HDF5, {key: text} of its head, and why it ended early (None: it did not).

    `wanted(path, names)` says which of the names in the file are read, and in which order. For HDF5 the names are the
    open file itself.
    """
    columns, provenance, incomplete = _read(path, wanted, list)
    return {name: np.concatenate(columns.pop(name)) for name in list(columns)}, provenance, incomplete


def _read(path, wanted, new_column):
    """The same with columns to which blocks of rows have been appended."""
    try:
        read = _read_hdf5 if is_hdf5(path) else _read_csv
        columns, provenance, incomplete, rows = read(path, wanted, new_column)
    except OSError as error:
        raise RunError(f"{path}: cannot be read: {error.strerror or program.first_line_of(error)}") from error
    if rows < 2:
        raise RunError(f"{path}: must have two rows or more (got {rows})")
    return columns, provenance, incomplete


def is_hdf5(path):
    with open(path, "rb") as file:
        return file.read(len(HDF5_SIGNATURE)) == HDF5_SIGNATURE


def _wanted(path, names):
    """Those of the names that an analysis reads, in the order of Run."""
    missing = [name for name in COLUMNS if name not in names]
    if "time_s" in missing and "te_um" in names:
        raise RunError(f"{path}: must be a dynamic run (got a static one, which `plot` draws)")
    if missing:
        raise RunError(f"{path}: no column {', '.join(missing)}; add it to output.columns of the run")
    return [name for name in COLUMNS + (PAIRS_COLUMN,) if name in names]


def check_numbers(path, columns):
    """Numbers all of them, whose squares are numbers as well."""
    for name, column in columns.items():
        low, high = column.min(), column.max()
        if -LARGEST <= low and high <= LARGEST:  # neither is NaN
            continue
        for first, part in stored.blocks(column):
            bad = np.flatnonzero(~np.isfinite(part))
            if len(bad):
                raise RunError(f"{path}: {name}: must be a finite number (got {part[bad[0]]} in row {first + bad[0] + 1})")
        raise RunError(f"{path}: {name}: must be a number whose square can be told (got more than 1e150)")


def check_times(path, name, time_s):
    """Rows at an even distance in time."""
    mean_s = (time_s[-1] - time_s[0]) / (len(time_s) - 1)
    if mean_s <= 0 or any(
        np.abs(np.diff(part) - mean_s).max(initial=0.0) > 0.1 * mean_s for _, part in stored.blocks(time_s, before=1)
    ):
        raise RunError(f"{path}: {name} must be evenly spaced (rows are missing, or too few digits: more output.digits)")


def check_turning(path, name, speed_rpm, angle_rad):
    """An angle that goes with the speed."""
    fast_rpm = TURNING_SHARE_OF_SPEED * max(-speed_rpm.min(), speed_rpm.max())
    parts = zip(stored.blocks(speed_rpm, before=1), stored.blocks(angle_rad, before=1))
    for (first, speed), (_, angle) in parts:
        bad = np.flatnonzero((np.abs(speed[1:]) > fast_rpm) & (np.diff(angle) * np.sign(speed[1:]) <= 0))
        if len(bad):
            raise RunError(
                f"{path}: {name} does not grow (or fall) from row {first + bad[0] + 1} to the next as the shaft turns "
                "(more output.digits may help)"
            )


# ----------------------------------------------------------------------------------------------------
# HDF5
# ----------------------------------------------------------------------------------------------------


def _read_hdf5(path, wanted, new_column):
    """Columns, provenance, why the run ended early (None: it did not), and the number of rows."""
    try:
        import h5py
    except ImportError as error:
        raise RunError(f"{path}: HDF5 is read by h5py, which is not installed (Debian: python3-h5py)") from error
    try:
        with h5py.File(path, "r") as file:
            provenance = {name: _text(value) for name, value in file.attrs.items()}
            items = {name: _data_set(path, name, file[name], h5py.Dataset) for name in wanted(path, file)}
            lengths = {item.shape[0] for item in items.values()}
            if len(lengths) > 1:
                raise RunError(f"{path}: its columns must have the same length (got {sorted(lengths)})")
            columns = {name: new_column() for name in items}
            for name, item in items.items():
                for _, part in stored.blocks(item):
                    columns[name].append(part.astype(float))
    except (OSError, RuntimeError, ValueError, TypeError, KeyError) as error:
        raise RunError(f"{path}: cannot be read as HDF5: {program.first_line_of(error)}") from error
    return columns, provenance, provenance.pop("incomplete", None), max(lengths)


def _data_set(path, name, item, dataset):
    """A data set that is a column of numbers."""
    if not isinstance(item, dataset) or len(item.shape) != 1 or item.dtype.kind not in "fiu":
        raise RunError(f"{path}: {name}: must be a column of numbers")
    return item


def _text(value):
    return value.decode("utf-8", errors="replace") if isinstance(value, bytes) else str(value)


# ----------------------------------------------------------------------------------------------------
# CSV
# ----------------------------------------------------------------------------------------------------


def refuse_other_files(path, right):
    """Tell of a file that is no table at all by what it is; `right` says what would be right."""
    with open(path, "rb") as file:
        begin = file.read(65536)
    if b"\0" in begin:
        raise RunError(f"{path}: must be {right} (got a file that is no text)")
    lines = (line.strip() for line in begin.decode("utf-8-sig", errors="replace").splitlines())
    first = next((line for line in lines if line and line[0] not in "#;"), "")
    if re.fullmatch(r"\[\w+\]\s*([;#].*)?", first):
        raise RunError(f"{path}: must be {right} (got a parameter file, whose result `gearsim {program.shown(path)}` writes)")


def read_head(path):
    """Provenance lines `# section.key = value`, the column names, and how many lines both take."""
    provenance = {}
    with open(path, encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            line = line.strip()
            if not line.startswith("#"):
                return provenance, [name.strip() for name in line.split(",")], number
            key, equals, value = line.lstrip("# ").partition("=")
            if equals:
                provenance[key.strip()] = value.strip()
            elif number == 1 and key.startswith("gearsim "):
                provenance["gearsim"] = key.removeprefix("gearsim ")
    raise RunError(f"{path}: no header line")


def _read_csv(path, wanted, new_column):
    """The same of a CSV, in one pass."""
    refuse_other_files(path, "a result of gearsim, CSV or HDF5")
    provenance, names, head_lines = read_head(path)
    chosen = wanted(path, names)
    used = [names.index(name) for name in chosen]
    if _is_cut_off(path):
        raise RunError(f"{path}: its last line must have an end (the file is cut off)")
    columns, rows = {name: new_column() for name in chosen}, 0
    only_used = None if len(used) == len(names) else used  # where all are read, their number is checked with that
    try:
        for block in _blocks_of_rows(path, names, head_lines, is_checked=only_used is None):
            table = np.loadtxt(io.BytesIO(block), delimiter=",", usecols=only_used, ndmin=2)
            if only_used is None and table.shape[1] != len(names):
                raise ValueError(f"must have {len(names)} columns (got {table.shape[1]})")
            parts = np.ascontiguousarray(table.T)
            rows += len(table)
            for column, place in zip(columns.values(), used if only_used is None else range(len(used))):
                column.append(parts[place])
    except ValueError as error:
        for _ in _blocks_of_rows(path, names, head_lines):  # fields that are missing or too many, by their line
            pass
        raise RunError(_bad_row(path, names, used, head_lines) or f"{path}: {program.first_line_of(error)}") from error
    return columns, provenance, _incomplete_reason(path), rows


def _blocks_of_rows(path, names, head_lines, is_checked=False):
    """Text below the head in blocks of whole lines with rows among them, each with as many fields as the header.

    `is_checked`: whoever takes the blocks looks at that himself, in blocks of rows alone.
    """
    commas, number = len(names) - 1, head_lines
    others = bytes(byte for byte in range(256) if byte not in b",\n")
    with open(path, "rb") as file:
        for _ in range(head_lines):
            file.readline()
        while block := file.read(BYTES_AT_ONCE):
            block += file.readline()
            lines = block.count(b"\n")
            if is_checked and b"," in block and b"#" not in block:
                yield block
                number += lines
                continue

            # Where all lines have so many commas, which is told quickly, they are rows.
            is_even = block.translate(None, delete=others) == (b"," * commas + b"\n") * lines
            if is_even or _has_rows(path, number, block, commas):
                yield block
            number += lines


def _has_rows(path, number, block, commas):
    """Whether there are rows among lines behind the line of a number. Comments and empty lines are none."""
    has_rows = False
    for number, line in enumerate(block.splitlines(), start=number + 1):
        if line.startswith(b"#") or not line.strip():
            continue
        has_rows = True
        if line.count(b",") != commas:
            raise RunError(f"{path}:{number}: must have {commas + 1} columns, as the header has (got {line.count(b',') + 1})")
    return has_rows


def _is_cut_off(path):
    """Whether the last line has no end, so that its last number may be a part of one."""
    with open(path, "rb") as file:
        file.seek(-1, os.SEEK_END)
        return file.read() != b"\n"


def _bad_row(path, names, used, head_lines):
    """A message about the first row that is not one, with its line; None if all are."""
    with open(path, encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            fields = line.partition("#")[0].strip().split(",")
            if number <= head_lines or fields == [""]:
                continue
            if len(fields) != len(names):
                return None
            for column in used:
                try:
                    float(fields[column])
                except ValueError:
                    got = program.shown(fields[column][:40])
                    return f"{path}:{number}: {names[column]}: must be a number (got '{got}')"
    return None


def _incomplete_reason(path):
    """What the last line says if it is `# incomplete: why`, else None."""
    with open(path, "rb") as file:
        file.seek(max(0, os.path.getsize(path) - 4096))
        last = file.read().decode("utf-8", errors="replace").rstrip().rpartition("\n")[2]
    return last.partition(":")[2].strip() or "no reason given" if last.startswith("# incomplete") else None
