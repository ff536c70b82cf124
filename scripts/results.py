# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""What gearsim writes, CSV or HDF5, as columns of numbers and what the file says of its origin."""
import itertools
import os
import re

import numpy as np

import program

COLUMNS = ("time_s", "pinion_speed_rpm", "pinion_angle_rad", "contact_force_N")
PAIRS_COLUMN = "pairs_in_contact"
ROWS_AT_ONCE = 50000  # of a CSV
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
    """Columns of a result of gearsim, and what it says of its origin.

    speed_rpm and angle_rad are those of the pinion without their direction: the amount of its speed, and the angle it
    has turned through, whichever way. Orders do not depend on the direction.
    """

    def __init__(self, time_s, speed_rpm, angle_rad, force_N, pairs=None, provenance=None):
        self.time_s = time_s
        self.start_rpm, self.end_rpm = float(speed_rpm[0]), float(speed_rpm[-1])
        self.reverses = bool(speed_rpm.min() < 0 < speed_rpm.max())
        self.speed_rpm = np.abs(speed_rpm)
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
        return np.ptp(self.speed_rpm) <= CONSTANT_SHARE_OF_SPEED * self.speed_rpm.max()

    def sweep_rpm_per_s(self):
        """How fast the speed changes: of pieces of the run, the rate that all but one in twenty stay below."""
        pieces = int(min(200, max(2, len(self.time_s) // 16)))
        edges = np.linspace(0, len(self.time_s), pieces + 1).astype(int)
        middle_s, middle_rpm = (
            np.array([values[first:last].mean() for first, last in zip(edges[:-1], edges[1:])])
            for values in (self.time_s, self.speed_rpm)
        )
        return float(np.percentile(np.abs(np.diff(middle_rpm) / np.diff(middle_s)), 95))


def turned_angle(angle_rad):
    """The angle turned through, which grows whichever way the pinion turns."""
    steps_rad = np.diff(angle_rad)
    if (steps_rad >= 0).all():
        return angle_rad
    return np.concatenate([[0.0], np.cumsum(np.abs(steps_rad))])


def read_run(path):
    """Read a result of gearsim, CSV or HDF5; raises RunError with a message for people."""
    columns, provenance, incomplete = read_columns(path, _wanted)
    time_s, speed_rpm, angle_rad = (columns[name] for name in COLUMNS[:3])
    check_numbers(path, columns)
    check_times(path, COLUMNS[0], time_s)
    if not speed_rpm.any():
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
    try:
        read = _read_hdf5 if is_hdf5(path) else _read_csv
        columns, provenance, incomplete = read(path, wanted)
    except OSError as error:
        raise RunError(f"{path}: cannot be read: {error.strerror or program.first_line_of(error)}") from error
    rows = len(next(iter(columns.values())))
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
        bad = np.flatnonzero(~np.isfinite(column))
        if len(bad):
            raise RunError(f"{path}: {name}: must be a finite number (got {column[bad[0]]} in row {bad[0] + 1})")
        if np.abs(column).max() > 1e150:
            raise RunError(f"{path}: {name}: must be a number whose square can be told (got more than 1e150)")


def check_times(path, name, time_s):
    """Rows at an even distance in time."""
    steps_s = np.diff(time_s)
    mean_s = (time_s[-1] - time_s[0]) / len(steps_s)
    if mean_s <= 0 or np.abs(steps_s - mean_s).max() > 0.1 * mean_s:
        raise RunError(f"{path}: {name} must be evenly spaced (rows are missing, or too few digits: more output.digits)")


def check_turning(path, name, speed_rpm, angle_rad):
    """An angle that goes with the speed."""
    turning = np.abs(speed_rpm[1:]) > TURNING_SHARE_OF_SPEED * np.abs(speed_rpm).max()
    bad = np.flatnonzero(turning & (np.diff(angle_rad) * np.sign(speed_rpm[1:]) <= 0))
    if len(bad):
        raise RunError(
            f"{path}: {name} does not grow (or fall) from row {bad[0] + 1} to the next as the shaft turns "
            "(more output.digits may help)"
        )


# ----------------------------------------------------------------------------------------------------
# HDF5
# ----------------------------------------------------------------------------------------------------


def _read_hdf5(path, wanted):
    """Columns, provenance, and why the run ended early (None: it did not)."""
    try:
        import h5py
    except ImportError as error:
        raise RunError(f"{path}: HDF5 is read by h5py, which is not installed (Debian: python3-h5py)") from error
    try:
        with h5py.File(path, "r") as file:
            provenance = {name: _text(value) for name, value in file.attrs.items()}
            columns = {name: _column(path, name, file[name], h5py.Dataset) for name in wanted(path, file)}
    except (OSError, RuntimeError, ValueError, TypeError, KeyError) as error:
        raise RunError(f"{path}: cannot be read as HDF5: {program.first_line_of(error)}") from error
    lengths = {len(column) for column in columns.values()}
    if len(lengths) > 1:
        raise RunError(f"{path}: its columns must have the same length (got {sorted(lengths)})")
    return columns, provenance, provenance.pop("incomplete", None)


def _column(path, name, item, dataset):
    """A data set as a column of numbers."""
    if not isinstance(item, dataset) or len(item.shape) != 1 or item.dtype.kind not in "fiu":
        raise RunError(f"{path}: {name}: must be a column of numbers")
    return item[:].astype(float)


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


def _read_csv(path, wanted):
    """The same of a CSV."""
    refuse_other_files(path, "a result of gearsim, CSV or HDF5")
    provenance, names, head_lines = read_head(path)
    chosen = wanted(path, names)
    used = [names.index(name) for name in chosen]
    if _is_cut_off(path):
        raise RunError(f"{path}: its last line must have an end (the file is cut off)")
    rows = _count_rows(path, names, head_lines)
    columns = {name: np.empty(rows) for name in chosen}
    try:
        _fill(path, columns, used, head_lines)
    except ValueError as error:
        raise RunError(_bad_row(path, names, used, head_lines) or f"{path}: {program.first_line_of(error)}") from error
    return columns, provenance, _incomplete_reason(path)


def _fill(path, columns, used, head_lines):
    """Rows into the columns, some at a time: together they would take as much memory again."""
    rows = len(next(iter(columns.values())))
    with open(path, encoding="utf-8", errors="replace") as file:  # the head may have names that are no UTF-8
        for _ in range(head_lines):
            file.readline()
        for first in range(0, rows, ROWS_AT_ONCE):
            table = np.loadtxt(file, delimiter=",", usecols=used, ndmin=2, max_rows=min(ROWS_AT_ONCE, rows - first))
            for column, part in zip(columns.values(), table.T):
                column[first : first + ROWS_AT_ONCE] = part


def _count_rows(path, names, head_lines):
    """Number of rows below the head; each must have as many fields as the header."""
    rows = _count_even_rows(path, len(names) - 1, head_lines)
    if rows is not None:
        return rows
    rows = 0
    with open(path, encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(itertools.islice(file, head_lines, None), start=head_lines + 1):
            if line.startswith("#") or not line.strip():
                continue
            rows += 1
            if line.count(",") != len(names) - 1:
                raise RunError(f"{path}:{number}: must have {len(names)} columns, as the header has "
                               f"(got {line.count(',') + 1})")
    return rows


def _count_even_rows(path, commas, head_lines):
    """The same where all lines below the head have so many commas, which is told quickly; None where one has not."""
    others = bytes(byte for byte in range(256) if byte not in b",\n")
    rows = 0
    with open(path, "rb") as file:
        for _ in range(head_lines):
            file.readline()
        while block := file.read(1 << 20):
            marks = (block + file.readline()).translate(None, delete=others)
            count = marks.count(b"\n")
            if marks != (b"," * commas + b"\n") * count:
                return None
            rows += count
    return rows


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
