# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""A run of gearsim or a measured record as one signal over time and angle: CSV, HDF5, WAV and other sound, UFF58."""
import math
import re
import warnings

import numpy as np
from scipy import interpolate, io

import program
import results
from results import Run, RunError

SPEED_UNITS = {"rpm": 1.0, "Hz": 60.0, "rad/s": 30.0 / math.pi, "deg/s": 1.0 / 6.0}  # in rpm
# What the end of a column's name of gearsim says of its unit; the longest end counts.
ENDINGS = {"um_per_s": "µm/s", "N_per_um": "N/µm", "N_per_mm": "N/mm", "N_per_mm2": "N/mm²", "um": "µm", "Nm": "N m",
           "N": "N", "rpm": "rpm", "rad": "rad", "mm": "mm", "W": "W", "s": "s"}
DEFAULT_SIGNAL = "contact_force_N"
SOUND_SUFFIXES = (".flac", ".ogg", ".oga", ".aif", ".aiff", ".caf", ".mp3")
JUMP = 0.8  # share of a pulse's height within a row: the edge is somewhere in it
KNOWN_ROWS = 0.02  # how well the edge of a pulse that rises over several rows is known
UFF_MARK = b"    -1"
STEADY_PULSES = 1.6  # an interval that is so many times its neighbours' lacks a pulse


class Record:
    """Columns of the same length by their names, with their units where the file says them."""

    def __init__(self, path, columns, units=None, rate_Hz=None, provenance=None, incomplete=None):
        self.path, self.columns = path, columns
        self.units = units or {}
        self.rate_Hz = rate_Hz  # None: a column tells the time
        self.provenance, self.incomplete = provenance or {}, incomplete

    def name_of(self, wanted, option):
        """The column that a user means, by its name or by its number from 1 on."""
        if wanted in self.columns:
            return wanted
        if wanted.isascii() and wanted.isdigit() and 1 <= int(wanted[:6]) <= len(self.columns):
            return list(self.columns)[int(wanted[:6]) - 1]
        raise RunError(f"{self.path}: no column '{program.shown(wanted)}' ({option}); it has {self.listed()}")

    def listed(self):
        names = [program.shown(name) for name in self.columns]
        return ", ".join(names[:20]) + (f" and {len(names) - 20} more" if len(names) > 20 else "")


class Signal:
    """What is analysed: a Run whose force_N are the values of any column, with its name, unit and origin."""

    def __init__(self, run, quantity, unit, record):
        self.run, self.quantity, self.unit = run, quantity, unit
        self.path, self.provenance, self.incomplete = record.path, record.provenance, record.incomplete


# ----------------------------------------------------------------------------------------------------
# Options
# ----------------------------------------------------------------------------------------------------


def add_arguments(parser):
    """Which columns of a record are what, and their units."""
    add = parser.add_argument_group("columns of a record, by name or number from 1 on").add_argument
    add("--signal", metavar="COLUMN", help=f"what is analysed [{DEFAULT_SIGNAL}, or the only one left]")
    add("--unit", metavar="TEXT", help="of the signal [what the file says]")
    add("--scale", type=finite, default=1.0, metavar="X", help="units for each 1 in the file [%(default)g]")
    add("--time", metavar="COLUMN", help="time in s [time_s, or one whose name begins with time or is t]")
    add("--rate", type=positive, metavar="HZ", help="rows a second, where no column tells the time")
    add("--speed", metavar="COLUMN", help="speed of the shaft that orders refer to [pinion_speed_rpm]")
    add("--speed-unit", default="rpm", metavar="UNIT",
        help="rpm, Hz, rad/s, deg/s, or the rpm for each 1 in the file [%(default)s]")
    add("--angle", metavar="COLUMN", help="its angle in rad [pinion_angle_rad, else the speed is integrated]")
    add("--pulses", metavar="COLUMN", help="in place of a speed: pulses of a tachometer, rising edges count")
    add("--pulses-per-turn", type=positive, default=1.0, metavar="N", help="[%(default)g]")
    add("--pulse-level", type=finite, metavar="X", help="where an edge counts [half-way between low and high]")
    add("--rpm", type=finite, metavar="RPM", help="in place of a speed: constant")
    add("--ratio", type=positive, default=1.0, metavar="I",
        help="turns of the shaft that orders refer to for each turn of the one measured [%(default)g]")


def finite(text):
    value = float(text)
    if not math.isfinite(value):
        raise ValueError
    return value


def positive(text):
    value = finite(text)
    if value <= 0.0:
        raise ValueError
    return value


def speed_factor(text):
    """rpm for each 1 of a speed."""
    if text in SPEED_UNITS:
        return SPEED_UNITS[text]
    try:
        return positive(text)
    except ValueError:
        raise program.InputError(f"--speed-unit: must be {', '.join(SPEED_UNITS)} or a number (got '{text}')") from None


# ----------------------------------------------------------------------------------------------------
# From a record to a signal
# ----------------------------------------------------------------------------------------------------


def read_signal(path, options):
    """Read a record and put together what an analysis needs; raises RunError with a message for people."""
    record = read_record(path)
    time_s = _times(record, options)
    speed_rpm, angle_rad, rows = _turning(record, time_s, options)
    name = _signal_name(record, options)
    values = record.columns[name] * options.scale
    results.check_numbers(path, {name: values})
    run = Run(time_s[rows], speed_rpm, angle_rad, values[rows], provenance=record.provenance)
    if not run.speed_rpm.any():
        raise RunError(f"{path}: the speed is 0 throughout: there are no orders of a shaft that stands still")
    quantity, unit = quantity_of(name, record.units.get(name))
    return Signal(run, quantity, unit if options.unit is None else options.unit, record)


def quantity_of(name, unit=None):
    """('contact force', 'N') of `contact_force_N`, and of `Force [N]`, `Force (N)` or `Force / N`."""
    if unit:
        return name, unit
    for pattern in (r"(.*\S)\s*\[(.*)\]", r"(.*\S)\s*\((.*)\)", r"(.*\S)\s+/\s*(.*)"):
        match = re.fullmatch(pattern, name)
        if match:
            return match[1], match[2].strip()
    for ending in sorted(ENDINGS, key=len, reverse=True):
        if name.endswith("_" + ending):
            return name[: -len(ending) - 1].replace("_", " "), ENDINGS[ending]
    return name.replace("_", " "), ""


def _time_column(record, options):
    """The column that tells the time; None: the rate does."""
    if options.time is not None:
        return record.name_of(options.time, "--time")
    if options.rate or record.rate_Hz:
        return None
    for name in record.columns:
        if name.lower().startswith("time") or quantity_of(name)[0].lower() == "t":
            return name
    raise RunError(f"{record.path}: no column tells the time; please give --time or --rate (it has {record.listed()})")


def _times(record, options):
    """Times of the rows, evenly spaced."""
    rows = len(next(iter(record.columns.values())))
    if rows < 16:
        raise RunError(f"{record.path}: must have 16 rows or more (got {rows})")
    name = _time_column(record, options)
    if name is None:
        return np.arange(rows) / (options.rate or record.rate_Hz)
    results.check_numbers(record.path, {name: record.columns[name]})
    results.check_times(record.path, name, record.columns[name])
    return record.columns[name]


def _turning(record, time_s, options):
    """(speed in rpm, angle in rad, rows that they are of) of the shaft that orders refer to."""
    given = [option for option in ("speed", "pulses", "rpm") if getattr(options, option) is not None]
    if len(given) > 1:
        raise program.InputError(f"--{given[0]}, --{given[1]}: must be one of them")
    whole = slice(None)

    # Pulses: angle and speed between the first edge and the last one.
    if options.pulses is not None:
        name = record.name_of(options.pulses, "--pulses")
        return _of_pulses(record.path, name, record.columns[name], time_s, options)

    # One speed.
    if options.rpm is not None:
        speed_rpm = np.full(len(time_s), options.rpm * options.ratio)
        return speed_rpm, integrated(time_s, speed_rpm), whole

    # A column, and another one for the angle or the integral of the speed.
    wanted = options.speed or results.COLUMNS[1]
    if options.speed is None and wanted not in record.columns:
        raise RunError(f"{record.path}: no column {wanted}; please give --speed, --pulses or --rpm "
                       f"(it has {record.listed()})")
    name = record.name_of(wanted, "--speed")
    speed_rpm = record.columns[name] * speed_factor(options.speed_unit) * options.ratio
    results.check_numbers(record.path, {name: speed_rpm})
    angle = options.angle or (results.COLUMNS[2] if options.speed is None else None)
    if angle is None or (options.angle is None and angle not in record.columns):
        return speed_rpm, integrated(time_s, speed_rpm), whole
    name = record.name_of(angle, "--angle")
    results.check_numbers(record.path, {name: record.columns[name]})
    angle_rad = record.columns[name] * options.ratio
    results.check_turning(record.path, name, speed_rpm, angle_rad)
    return speed_rpm, angle_rad, whole


def integrated(time_s, speed_rpm):
    """Angle in rad of a speed: the trapezoidal rule, exact where the speed is linear between rows."""
    steps_rad = np.diff(time_s) * (speed_rpm[1:] + speed_rpm[:-1]) * (math.pi / 60.0)
    return np.concatenate([[0.0], np.cumsum(steps_rad)])


def _of_pulses(path, name, values, time_s, options):
    """Speed and angle of pulses of a tachometer, which know no direction.

    Edges lie between rows where the straight line through both passes the level; of a jump from low to high within a
    row no more is known than that it lies there. A smoothing spline goes through the angles of the edges as near as that
    tells them; its slope is the speed. A pulse counts when the signal was below a tenth of its height under the level.
    """
    results.check_numbers(path, {name: values})
    low, high = np.percentile(values, (0.1, 99.9))
    level = 0.5 * (low + high) if options.pulse_level is None else options.pulse_level
    arm = level - 0.1 * (high - low)
    if not values.min() < arm < level < values.max():
        raise RunError(f"{path}: {name}: no pulses pass the level {level:.4g} (--pulse-level)")

    # Rising edges, those but the first since the signal was last well below left out.
    above = values >= level
    rising = np.flatnonzero(above[1:] & ~above[:-1])
    falls = np.cumsum(values < arm)
    rising = rising[np.diff(falls[rising], prepend=-1) > 0]
    if len(rising) < 4:
        raise RunError(f"{path}: {name}: must have four pulses or more (got {len(rising)})")
    share = (level - values[rising]) / (values[rising + 1] - values[rising])
    edge_s = time_s[rising] + share * (time_s[rising + 1] - time_s[rising])

    # A pulse that is missing, or one too many, would bend the angle.
    steps_s = np.diff(edge_s)
    beside_s = np.sqrt(np.concatenate([steps_s[1:2], steps_s[:-1]]) * np.concatenate([steps_s[1:], steps_s[-2:-1]]))
    odd = np.flatnonzero((steps_s > STEADY_PULSES * beside_s) | (steps_s < beside_s / STEADY_PULSES))
    odd = [i for i in odd if 0 < i < len(steps_s) - 1]
    if odd:
        raise RunError(f"{path}: {name}: a pulse is missing or one is too many near {edge_s[odd[0]]:.6g} s "
                       "(--pulse-level), or the shaft stands or turns back there, which pulses do not tell")

    turn = np.arange(len(edge_s)) / options.pulses_per_turn * options.ratio
    row_s = (time_s[-1] - time_s[0]) / (len(time_s) - 1)
    is_jump = np.median(values[rising + 1] - values[rising]) > JUMP * (high - low)
    known_s = row_s / math.sqrt(12.0) if is_jump else KNOWN_ROWS * row_s
    known_turn = known_s * np.gradient(turn, edge_s)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that it goes nearer to the edges than asked for, or not quite as near
        spline = interpolate.UnivariateSpline(edge_s, turn, 1.0 / known_turn, k=5 if len(turn) > 5 else 3, s=len(turn))
    rows = slice(int(rising[0]) + 1, int(rising[-1]) + 1)
    speed_rpm = 60.0 * spline.derivative()(time_s[rows])
    if speed_rpm.min() <= 0.0:
        raise RunError(f"{path}: {name}: pulses that come so unevenly have no speed (--pulse-level)")
    return speed_rpm, 2.0 * math.pi * spline(time_s[rows]), rows


def _signal_name(record, options):
    """The column that is analysed."""
    if options.signal is not None:
        return record.name_of(options.signal, "--signal")
    if DEFAULT_SIGNAL in record.columns:
        return DEFAULT_SIGNAL
    given = (options.speed or results.COLUMNS[1], options.angle or results.COLUMNS[2], options.pulses)
    taken = {record.name_of(column, "") for column in given if column in record.columns}
    left = [name for name in record.columns if name not in taken | {_time_column(record, options)}]
    if len(left) == 1:
        return left[0]
    raise RunError(f"{record.path}: please say with --signal what is analysed (it has {record.listed()})")


# ----------------------------------------------------------------------------------------------------
# Files
# ----------------------------------------------------------------------------------------------------


def read_record(path):
    """All columns of a file, whose kind is told by what it begins with."""
    try:
        with open(path, "rb") as file:
            head = file.read(4096)
        if head[:4] in (b"RIFF", b"RIFX") and head[8:12] == b"WAVE":
            return _read_wav(path)
        if head.startswith(UFF_MARK):
            return _read_uff(path)
        if path.lower().endswith(SOUND_SUFFIXES):
            return _read_sound(path)
        if head.startswith((results.HDF5_SIGNATURE, b"# gearsim")):
            columns, provenance, incomplete = results.read_columns(path, _all_columns)
            return Record(path, columns, provenance=provenance, incomplete=incomplete)
        return _read_text(path)
    except OSError as error:
        raise RunError(f"{path}: cannot be read: {error.strerror or program.first_line_of(error)}") from error


def _all_columns(path, names):
    """All columns of a CSV; of an open HDF5 those of numbers that are as long as the longest one, in any group."""
    if isinstance(names, list):
        return names
    found = {}
    names.visititems(lambda name, item: found.update({name: item}) if len(getattr(item, "shape", ())) == 1 else None)
    lengths = {name: item.shape[0] for name, item in found.items() if item.dtype.kind in "fiu"}
    if not lengths:
        raise RunError(f"{path}: no column of numbers in it")
    return [name for name, length in lengths.items() if length == max(lengths.values())]


def _channels(path, table, rate_Hz):
    """Channels of sound, which have numbers in place of names."""
    table = np.asarray(table, dtype=float)
    table = table[:, None] if table.ndim == 1 else table
    return Record(path, {str(i + 1): np.ascontiguousarray(column) for i, column in enumerate(table.T)}, rate_Hz=rate_Hz)


def _read_wav(path):
    """WAV; whole numbers become shares of full scale."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # chunks that are no samples
        try:
            rate_Hz, table = io.wavfile.read(path)
        except Exception as error:  # pylint: disable=broad-except  (whatever scipy meets in a broken file)
            raise RunError(f"{path}: cannot be read as WAV: {program.first_line_of(error)}") from error
    if table.dtype.kind == "u":  # 8 bit
        table = (table.astype(float) - 128.0) / 128.0
    elif table.dtype.kind == "i":
        table = table.astype(float) / -float(np.iinfo(table.dtype).min)
    return _channels(path, table, float(rate_Hz))


def _read_sound(path):
    soundfile = program.optional("soundfile")
    try:
        table, rate_Hz = soundfile.read(path)
    except (RuntimeError, TypeError, ValueError) as error:
        raise RunError(f"{path}: cannot be read as sound: {program.first_line_of(error)}") from error
    return _channels(path, table, float(rate_Hz))


def _read_uff(path):
    """Functions over time of a universal file, data set 58; their first line of text is the name."""
    pyuff = program.optional("pyuff")
    try:
        sets = pyuff.UFF(path).read_sets()
    except Exception as error:  # pylint: disable=broad-except  (whatever it meets in a broken file)
        raise RunError(f"{path}: cannot be read as UFF: {program.first_line_of(error)}") from error
    sets = [one for one in ([sets] if isinstance(sets, dict) else sets) if one.get("type") == 58]
    if not sets:
        raise RunError(f"{path}: no data set 58 in it")

    columns, units = {}, {}
    for number, one in enumerate(sets, start=1):
        if one.get("abscissa_spec_data_type") not in (0, 17):  # unknown or time
            raise RunError(f"{path}: data set 58 number {number}: must be over time")
        name = str(one.get("id1", "")).strip()
        name = name if name and name.upper() != "NONE" and name not in columns else f"{name} {number}".strip()
        columns[name] = np.asarray(one["data"])
        if np.iscomplexobj(columns[name]):
            raise RunError(f"{path}: {program.shown(name)}: must be real")
        columns[name] = columns[name].astype(float)
        unit = str(one.get("ordinate_axis_units_lab", "")).strip()
        if unit and unit.upper() != "NONE":
            units[name] = unit
    steps_s = {float(np.diff(one["x"]).mean()) for one in sets if len(one["x"]) > 1}
    lengths = {len(values) for values in columns.values()}
    if len(lengths) > 1 or not steps_s or max(steps_s) - min(steps_s) > 1e-6 * max(steps_s) or min(steps_s) <= 0:
        raise RunError(f"{path}: its data sets must have the same length and the same step of time")
    return Record(path, columns, units, rate_Hz=1.0 / min(steps_s))


def _read_text(path):
    """Columns of text: separated by semicolon, tabulator, comma or blanks, with names and units above or without.

    Where commas separate nothing, a comma in a number is its point.
    """
    results.refuse_other_files(path, "a record as text, HDF5, sound or UFF58")
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        lines = [line.rstrip("\r\n") for line in file]
    filled = [(number, line) for number, line in enumerate(lines, start=1) if line.strip() and not line.startswith("#")]
    notes = (line.lstrip("# ").partition("=") for line in lines if line.startswith("#"))
    provenance = {key.strip(): value.strip() for key, equals, value in notes if equals}
    if not filled:
        raise RunError(f"{path}: no rows in it")
    middle = filled[len(filled) // 2][1]
    separator = next((mark for mark in ";\t," if mark in middle), None)

    def fields(line):
        return [part.strip().strip('"') for part in line.split(separator)]

    def number_of(text):
        try:
            return float(text.replace(",", ".") if separator != "," else text)
        except ValueError:
            return None

    # The head ends where most of a line are numbers; its last lines of as many fields are names and units.
    width = len(fields(middle))

    def is_row(line):
        parts = fields(line)
        return 2 * sum(number_of(part) is not None for part in parts) > len(parts)

    first = next((i for i, (_, line) in enumerate(filled) if is_row(line) and len(fields(line)) == width), len(filled))
    head = [fields(line) for _, line in filled[:first] if len(fields(line)) == width]
    names, units = [str(i + 1) for i in range(width)], {}
    if head:
        names = head[-2] if len(head) > 1 else head[-1]
        units = {name: unit for name, unit in zip(names, head[-1]) if unit} if len(head) > 1 else {}
    if len(set(names)) < width:
        raise RunError(f"{path}: each column must have a name of its own (got {program.shown(', '.join(names))[:200]})")

    # All rows; a column with a text in it is none that can be chosen.
    table = np.full((len(filled) - first, width), np.nan)
    texts = {}
    for row, (number, line) in enumerate(filled[first:]):
        parts = fields(line)
        if len(parts) != width:
            raise RunError(f"{path}:{number}: must have {width} columns (got {len(parts)})")
        for column, part in enumerate(parts):
            value = number_of(part)
            if value is None:
                texts.setdefault(column, (number, part))
            else:
                table[row, column] = value
    numbers = [i for i in range(width) if i not in texts]
    if not numbers:
        number, part = texts[0]
        raise RunError(f"{path}:{number}: {program.shown(names[0])}: must be a number (got '{program.shown(part[:40])}')")
    return Record(path, {names[i]: np.ascontiguousarray(table[:, i]) for i in numbers}, units,
                  provenance=provenance)
