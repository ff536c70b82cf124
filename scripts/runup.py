# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a run-up says: spectra over speed, order lines, and numbers that stand for what a map shows.

Amplitudes are peak values: a sine of 1 N is 1 N in a map, in an order cut and in an order spectrum.
Frequencies are in Hz, speeds in rpm of the pinion, orders in events per turn of the pinion.
Window functions and their scaling: G. Heinzel, A. Ruediger, R. Schilling, "Spectrum and spectral density
estimation by the Discrete Fourier transform", 2002 (amplitude scaling by the sum of the window, density
scaling by its equivalent noise bandwidth).
"""
import math
import os

import numpy as np
from scipy import interpolate, signal

from results import RunError, read_head

COLUMNS = ("time_s", "pinion_speed_rpm", "pinion_angle_rad", "contact_force_N")
PAIRS_COLUMN = "pairs_in_contact"
HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"

# A sampled signal is trusted up to this share of its rate: the low-pass of gearsim passes it unchanged.
TRUSTED_SHARE_OF_RATE = 0.4
# Order blocks begin at this share of the highest speed: slower ones last so long that the speed changes.
BLOCK_MIN_SHARE_OF_SPEED = 0.1
BLOCK_TURNS = 82  # about so many turns of the pinion: 1/82 order from bin to bin
# Bins around an order line that tell its floor: nearer ones hold the line, farther ones other lines.
FLOOR_NEAR, FLOOR_FAR = 4, 24


# ----------------------------------------------------------------------------------------------------
# Reading
# ----------------------------------------------------------------------------------------------------


class Run:
    """Columns of a result of gearsim, and what it says of its origin."""

    def __init__(self, time_s, speed_rpm, angle_rad, force_N, pairs=None, provenance=None):
        self.time_s = time_s
        self.speed_rpm = speed_rpm
        self.angle_rad = angle_rad
        self.force_N = force_N
        self.pairs = pairs  # None if the column is missing
        self.provenance = provenance or {}
        self.incomplete = None  # the reason if the run ended early
        self.rate_Hz = (len(time_s) - 1) / (time_s[-1] - time_s[0])

    @property
    def trusted_Hz(self):
        return TRUSTED_SHARE_OF_RATE * self.rate_Hz


def read_run(path):
    """Read a result of gearsim, CSV or HDF5; raises RunError or OSError with a message for people."""
    with open(path, "rb") as file:
        is_hdf5 = file.read(len(HDF5_SIGNATURE)) == HDF5_SIGNATURE
    columns, provenance, incomplete = _read_hdf5(path) if is_hdf5 else _read_csv(path)
    if len(columns[0]) < 2:
        raise RunError(f"{path}: fewer than two rows")
    _check_columns(path, columns)
    run = Run(*columns, provenance=provenance)
    run.incomplete = incomplete
    return run


def _wanted(path, names):
    """Those of the names that an analysis reads, in the order of Run."""
    missing = [name for name in COLUMNS if name not in names]
    if missing:
        raise RunError(f"{path}: no column {', '.join(missing)}; add it to output.columns of the run")
    return [name for name in COLUMNS + (PAIRS_COLUMN,) if name in names]


def _read_hdf5(path):
    """Columns, provenance, and why the run ended early (None: it did not)."""
    try:
        import h5py
    except ImportError as error:
        raise RunError(f"{path}: HDF5 is read by h5py, which is not installed (Debian: python3-h5py)") from error
    try:
        with h5py.File(path, "r") as file:
            provenance = {name: _text(value) for name, value in file.attrs.items()}
            columns = [file[name][:] for name in _wanted(path, file)]
    except OSError as error:
        raise RunError(f"{path}: {error}") from error
    return columns, provenance, provenance.pop("incomplete", None)


def _text(value):
    return value.decode("utf-8", errors="replace") if isinstance(value, bytes) else str(value)


def _read_csv(path):
    """The same of a CSV."""
    provenance, names, head_lines = read_head(path)
    try:
        table = np.loadtxt(
            path,
            delimiter=",",
            comments="#",
            skiprows=head_lines,
            usecols=[names.index(name) for name in _wanted(path, names)],
            ndmin=2,
        )
    except ValueError as error:
        raise RunError(f"{path}: {error}") from error
    return [np.ascontiguousarray(column) for column in table.T], provenance, _incomplete_reason(path)


def _incomplete_reason(path):
    """What the last line says if it is `# incomplete: why`, else None."""
    with open(path, "rb") as file:
        file.seek(max(0, os.path.getsize(path) - 4096))
        last = file.read().decode("utf-8", errors="replace").rstrip().rpartition("\n")[2]
    return last.partition(":")[2].strip() or "no reason given" if last.startswith("# incomplete") else None


def _check_columns(path, columns):
    time_s, angle_rad = columns[0], columns[2]
    if not all(np.isfinite(column).all() for column in columns):
        raise RunError(f"{path}: a value is not a finite number")
    steps_s = np.diff(time_s)
    mean_s = (time_s[-1] - time_s[0]) / len(steps_s)
    if mean_s <= 0 or np.abs(steps_s - mean_s).max() > 0.1 * mean_s:
        raise RunError(f"{path}: time_s is not evenly spaced (more output.digits may help)")
    if np.diff(angle_rad).min() <= 0:
        raise RunError(f"{path}: pinion_angle_rad does not grow from row to row")


class Gears:
    """What the analysis has to know of the gears: the lines that a map can show."""

    def __init__(self, pinion_teeth, wheel_teeth, eigenfrequency_Hz):
        self.pinion_teeth = pinion_teeth
        self.wheel_teeth = wheel_teeth
        self.eigenfrequency_Hz = eigenfrequency_Hz

    @property
    def wheel_order(self):
        """One event per turn of the wheel, in turns of the pinion."""
        return self.pinion_teeth / self.wheel_teeth


# ----------------------------------------------------------------------------------------------------
# Spectra over time
# ----------------------------------------------------------------------------------------------------


class Spectra:
    """Short-time spectra: power[frame, bin] is the squared peak amplitude (N^2)."""

    def __init__(self, frequency_Hz, speed_rpm, speed_range_rpm, power, noise_bandwidth_bins):
        self.frequency_Hz = frequency_Hz
        self.speed_rpm = speed_rpm  # at the middle of each frame
        self.speed_range_rpm = speed_range_rpm  # of the whole run
        self.power = power
        self.noise_bandwidth_bins = noise_bandwidth_bins

    def band(self, low_Hz, high_Hz):
        return (self.frequency_Hz >= low_Hz) & (self.frequency_Hz <= high_Hz)

    def mean_square(self, bins):
        """Mean square of the signal in the chosen bins, over all frames (N^2)."""
        total = np.where(bins, self.power, 0.0).sum(axis=1).mean()
        return total / 2.0 / self.noise_bandwidth_bins


def short_time_spectra(run, window="hann", length=2048, hop=512):
    """Spectra of the contact force without its mean, in frames of `length` rows every `hop` rows."""
    if len(run.force_N) < length:
        raise RunError(f"the run has {len(run.force_N)} rows, a window needs {length}")
    weight = signal.get_window(window, length)
    force_N = run.force_N - run.force_N.mean()
    frames = np.lib.stride_tricks.sliding_window_view(force_N, length)[::hop]
    power = np.empty((len(frames), length // 2 + 1), dtype=np.float32)
    for first in range(0, len(frames), 256):  # piecewise, as all windowed frames at once fill the memory
        spectrum = np.fft.rfft(frames[first : first + 256] * weight, axis=1)
        power[first : first + 256] = np.abs(2.0 * spectrum / weight.sum()) ** 2
    middle = np.arange(len(frames)) * hop + length // 2
    return Spectra(
        np.fft.rfftfreq(length, 1.0 / run.rate_Hz),
        run.speed_rpm[middle],
        (run.speed_rpm.min(), run.speed_rpm.max()),
        power,
        length * (weight**2).sum() / weight.sum() ** 2,
    )


def speed_map(spectra, speed_bins=330):
    """Rms of the amplitudes over the frames of each speed bin: (bin middles in rpm, [speed, bin] in N).

    A bin without a frame is NaN. There are never more bins than a third of the frames.
    """
    low, high = spectra.speed_range_rpm
    if high - low < 1.0:
        raise RunError("the pinion speed does not change: a map needs a run-up or a run-down")
    bins = max(1, min(speed_bins, len(spectra.speed_rpm) // 3))
    edges = np.linspace(low, high, bins + 1)
    index = np.clip(np.searchsorted(edges, spectra.speed_rpm, side="right") - 1, 0, bins - 1)
    power = np.full((bins, spectra.power.shape[1]), np.nan)
    for i in range(bins):
        frames = index == i
        if frames.any():
            power[i] = spectra.power[frames].mean(axis=0)
    return (edges[:-1] + edges[1:]) / 2.0, np.sqrt(power)


# ----------------------------------------------------------------------------------------------------
# Orders
# ----------------------------------------------------------------------------------------------------


def order_cut(run, order, window_s=0.25, hop_s=0.05):
    """Amplitude of one order over the speed: (rpm, N), NaN where its frequency is not trusted.

    The force is turned back by order times the angle, so that the order stands still, and averaged under
    a Hann window. That follows the order exactly, however fast it sweeps, with the same bandwidth in Hz
    (1.5 / window_s) at all speeds.
    """
    length, hop = int(round(window_s * run.rate_Hz)), max(1, int(round(hop_s * run.rate_Hz)))
    if len(run.force_N) < length:
        raise RunError(f"the run is shorter than {window_s} s, which an order cut needs")
    weight = signal.get_window("hann", length)
    weight /= weight.sum()
    force_N = run.force_N - run.force_N.mean()
    still = force_N * np.exp(-1j * np.remainder(order * run.angle_rad, 2.0 * np.pi))
    amplitude_N = 2.0 * np.abs(np.lib.stride_tricks.sliding_window_view(still, length)[::hop] @ weight)
    speed_rpm = run.speed_rpm[np.arange(len(amplitude_N)) * hop + length // 2]
    amplitude_N[np.abs(order * speed_rpm / 60.0) > run.trusted_Hz] = np.nan
    return speed_rpm, amplitude_N


class OrderBlocks:
    """Spectra over the pinion angle: power[block, bin], squared peak amplitude (N^2)."""

    def __init__(self, turns, speed_rpm, power, trusted_Hz):
        self.turns = turns  # of the pinion in a block: bins for each order
        self.order = np.arange(power.shape[1]) / turns
        self.speed_rpm = speed_rpm  # mean of each block
        self.power = power
        self.trusted_Hz = trusted_Hz

    def line(self, order, above_Hz=0.0):
        """Squared peak amplitude of a line and of the floor under it, one value for each block (N^2).

        Only blocks where the line lies above `above_Hz` and is trusted. The line is the sum of 3 bins
        divided by 1.5, as a Hann window spreads it; the floor is what a noise of the median strength of
        the bins around puts there (median / ln 2 is the mean of its power; 3 bins / 1.5 = 2).
        """
        middle = int(round(order * self.turns))
        beside = np.arange(FLOOR_NEAR, FLOOR_FAR + 1)
        around = np.r_[middle - beside, middle + beside]
        around = around[(around > 0) & (around < self.power.shape[1])]
        frequency_Hz = order * self.speed_rpm / 60.0
        power = self.power[(frequency_Hz > above_Hz) & (frequency_Hz < self.trusted_Hz)]
        line = power[:, middle - 1 : middle + 2].sum(axis=1) / 1.5
        floor = np.median(power[:, around], axis=1) / np.log(2.0) * 2.0
        return line, floor

    def mean_amplitude_N(self, above_Hz=0.0):
        """Rms of the amplitude at each order over the blocks where it lies above `above_Hz` and is trusted.

        NaN where there is no such block.
        """
        frequency_Hz = np.outer(self.speed_rpm / 60.0, self.order)
        counts = (frequency_Hz >= above_Hz) & (frequency_Hz < self.trusted_Hz)
        count = counts.sum(axis=0)
        mean = np.where(counts, self.power, 0.0).sum(axis=0) / np.maximum(count, 1)
        return np.where(count > 0, np.sqrt(mean), np.nan)


def block_turns(pinion_teeth, wheel_teeth):
    """Pinion turns of a block: near BLOCK_TURNS, and such that the wheel makes whole turns as well.

    Then the orders of both gears lie on bins. If that took too many turns, it is given up.
    """
    hunting_turns = wheel_teeth // math.gcd(pinion_teeth, wheel_teeth)
    if hunting_turns > 2 * BLOCK_TURNS:
        return BLOCK_TURNS
    return hunting_turns * max(1, round(BLOCK_TURNS / hunting_turns))


def order_blocks(run, turns, highest_order):
    """Spectra of blocks of `turns` pinion turns, Hann, overlapping by half; None if the run has none."""
    lowest_rpm = BLOCK_MIN_SHARE_OF_SPEED * run.speed_rpm.max()
    fast = np.flatnonzero(run.speed_rpm >= lowest_rpm)
    turn = run.angle_rad / (2.0 * np.pi)
    starts = np.arange(turn[fast[0]], turn[fast[-1]] - turns, turns / 2.0)
    if not len(starts):
        return None
    # At twice its rate a cubic spline through the signal is exact to 0.1 % up to the trusted frequency.
    force_N = signal.resample_poly(run.force_N - run.force_N.mean(), 2, 1)
    fine_turn = np.interp(np.arange(len(force_N)) / 2.0, np.arange(len(turn)), turn)
    # So many samples per turn that the slowest block holds the whole bandwidth: nothing is aliased.
    per_turn = max(2.2 * highest_order, 1.1 * run.rate_Hz * 60.0 / lowest_rpm)
    samples = turns * int(2 ** np.ceil(np.log2(per_turn)))
    at = np.arange(samples) * (turns / samples)
    weight = signal.get_window("hann", samples)
    bins = int(highest_order * turns) + 1
    power, speed_rpm = np.empty((len(starts), bins), dtype=np.float32), np.empty(len(starts))
    for i, start in enumerate(starts):
        first, last = np.searchsorted(fine_turn, (start, start + turns))
        part = slice(max(0, first - 16), last + 16)
        spline = interpolate.CubicSpline(fine_turn[part], force_N[part])
        spectrum = np.fft.rfft(spline(start + at) * weight)[:bins]
        power[i] = np.abs(2.0 * spectrum / weight.sum()) ** 2
        first, last = np.searchsorted(turn, (start, start + turns))
        speed_rpm[i] = run.speed_rpm[first:last].mean()
    return OrderBlocks(turns, speed_rpm, power, run.trusted_Hz)
