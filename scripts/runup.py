# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a run-up says: spectra over speed, order lines, and how far both can be trusted.

Amplitudes are peak values: a sine of 1 N is 1 N in a map, in an order cut and in an order spectrum.
Frequencies are in Hz, speeds in rpm of the pinion, orders in events per turn of the pinion.
Window functions and their scaling: G. Heinzel, A. Ruediger, R. Schilling, "Spectrum and spectral density
estimation by the Discrete Fourier transform", 2002 (amplitude scaling by the sum of the window, density
scaling by its equivalent noise bandwidth).
"""
import itertools
import math

import numpy as np
from scipy import fft

import stored
import tracking
from results import Run, RunError, read_run  # noqa: F401  (a run-up is read and analysed by one module)

# Standard window, with which the indicators are defined.
STANDARD_LENGTH, STANDARD_HOP = 2048, 512
# A window in which an order sweeps by this many of its own resolutions (1 / window) shows it 0.2 % too low.
SWEEP_OF_WINDOW = 0.5
LONGEST_WINDOW_S = 0.2
FEWEST_WINDOWS = 20  # in a run, so that a short one has a map as well
SHORTEST_WINDOW = 32  # rows
PADDING = 8  # of the windows of a map: between two bins a Hann window then loses 0.3 % at most, not 15 %

# The speed may change by SWEEP_OF_CUT within a window of an order cut: a resonance of RESOLVED_DAMPING is then shown to
# 1 %. The window is never longer than CUT_WINDOW_S, and holds at least so many teeth as tell tooth orders apart.
SWEEP_OF_CUT, RESOLVED_DAMPING = 0.035, 0.02
CUT_WINDOW_S, CUT_LEAST_WINDOW_S, CUT_TEETH = 0.5, 0.25, 4
CUT_TURNS = tracking.TURNS_APART
CUT_HOP_S, CUT_POINTS = 0.05, 800  # from window to window; at least so many in a run

# Order blocks begin at this share of the highest speed: slower ones last so long that the speed changes.
BLOCK_MIN_SHARE_OF_SPEED = 0.1
BLOCK_TURNS = 82  # about so many turns of the pinion: 1/82 order from bin to bin
LINE_BINS = 4  # between lines of pinion and wheel, so that a Hann window keeps them apart
# Bins around an order line that tell its floor: nearer ones hold the line, farther ones other lines.
FLOOR_NEAR, FLOOR_FAR = 4, 24

FRAMES_AT_ONCE = 16  # windows, transformed together
PIECE_FRAMES, PIECE_BLOCKS = 512, 64  # spectra that are looked at together


class Gears:
    """What the analysis has to know of the gears: the lines that a map can show."""

    def __init__(self, pinion_teeth, wheel_teeth, eigenfrequency_Hz, is_ring=False):
        self.pinion_teeth = pinion_teeth
        self.wheel_teeth = wheel_teeth  # > 0, of a ring too
        self.eigenfrequency_Hz = eigenfrequency_Hz
        self.is_ring = is_ring

    @property
    def teeth_text(self):
        """As in a parameter file, where a ring has teeth < 0."""
        return f"gears {self.pinion_teeth}/{self.signed_wheel_teeth} teeth"

    @property
    def signed_wheel_teeth(self):
        return -self.wheel_teeth if self.is_ring else self.wheel_teeth

    @property
    def wheel_order(self):
        """One event per turn of the wheel, in turns of the pinion."""
        return self.pinion_teeth / self.wheel_teeth


def speed_text(run):
    """How the pinion turns: `100 to 6000 rpm in 10 s`."""
    duration = f"{run.time_s[-1] - run.time_s[0]:.3g} s"
    start_rpm, end_rpm = (float(f"{speed_rpm:.4g}") for speed_rpm in (run.start_rpm, run.end_rpm))
    if run.is_constant:
        return f"{run.start_rpm:.5g} rpm for {duration}"
    reverses = ", reversing" if run.reverses else ""
    return f"{start_rpm:g} to {end_rpm:g} rpm{reverses} in {duration}"


# ----------------------------------------------------------------------------------------------------
# Spectra over time
# ----------------------------------------------------------------------------------------------------


class Spectra:
    """Short-time spectra: power[frame, bin] is the squared peak amplitude (N^2), an array or stored.Rows."""

    def __init__(self, frequency_Hz, speed_rpm, power, noise_bandwidth_bins):
        self.frequency_Hz = frequency_Hz
        self.speed_rpm = speed_rpm  # at the middle of each frame
        self.power = power
        self.noise_bandwidth_bins = noise_bandwidth_bins

    def band(self, low_Hz, high_Hz):
        return (self.frequency_Hz >= low_Hz) & (self.frequency_Hz <= high_Hz)

    def pieces(self):
        """The same, some frames at a time."""
        for first in range(0, len(self.speed_rpm), PIECE_FRAMES):
            part = slice(first, first + PIECE_FRAMES)
            yield Spectra(self.frequency_Hz, self.speed_rpm[part], self.power[part], self.noise_bandwidth_bins)

    def mean_square(self, bins, among=None):
        """Mean square of the signal in the chosen bins, over all frames (N^2); of them those of among(piece) [frame, bin]."""
        total = 0.0
        for piece in self.pieces():
            chosen = bins if among is None else bins & among(piece)
            total += piece.power.sum(axis=1, dtype=float, where=chosen).sum()
        return total / len(self.speed_rpm) / 2.0 / self.noise_bandwidth_bins


def frames_of(run, window, length, hop, padding=1):
    """Windowed spectra of the force without its mean: pieces (first frame, squared peak amplitude [frame, bin] in N^2).

    In pieces, as all windowed frames at once would fill the memory. The window is followed by zeros up to at least
    `padding` times its length.
    """
    if len(run.force_N) < length:
        raise RunError(f"the run has {len(run.force_N)} rows, a window needs {length}")
    weight = tracking.window_of(window, length)
    weight *= 2.0 / weight.sum()
    mean_N, count = run.force_N.mean(), (len(run.force_N) - length) // hop + 1
    for first in range(0, count, FRAMES_AT_ONCE):
        last = min(first + FRAMES_AT_ONCE, count) - 1
        force_N = run.force_N[first * hop : last * hop + length] - mean_N
        frames = np.lib.stride_tricks.sliding_window_view(force_N, length)[::hop]
        spectrum = fft.rfft(frames * weight, padded(length, padding), axis=1)
        yield first, spectrum.real**2 + spectrum.imag**2


def padded(length, padding):
    """Rows of a window and the zeros behind it: not fewer than asked for, and as many as are transformed quickly."""
    return fft.next_fast_len(padding * length, real=True) if padding > 1 else length


def middles_of(values, length, hop):
    """Values of the rows in the middle of each frame."""
    frames = (len(values) - length) // hop + 1
    return values[np.arange(frames) * hop + length // 2]


def short_time_spectra(run, window="hann", length=STANDARD_LENGTH, hop=STANDARD_HOP):
    """Spectra of the contact force without its mean, in frames of `length` rows every `hop` rows."""
    power = stored.Rows(length // 2 + 1, np.float32)
    for _, piece in frames_of(run, window, length, hop):
        power.append(piece)
    weight = tracking.window_of(window, length)
    return Spectra(
        np.fft.rfftfreq(length, 1.0 / run.rate_Hz),
        middles_of(run.speed_rpm, length, hop),
        power,
        length * (weight**2).sum() / weight.sum() ** 2,
    )


def window_length(run, highest_order):
    """Rows of a window in which the highest order of interest sweeps so slowly that it is shown in full.

    The frequency of an order that passes through a window of T seconds at c Hz/s changes by c T, which is c T^2 of the
    resolution 1 / T. A slower sweep gets a longer window, which tells more lines apart.
    """
    sweep_Hz_per_s = highest_order * run.sweep_rpm_per_s() / 60.0
    length_s = min(LONGEST_WINDOW_S, run.time_s[-1] - run.time_s[0])
    if sweep_Hz_per_s > 0:
        length_s = min(length_s, math.sqrt(SWEEP_OF_WINDOW / sweep_Hz_per_s))
    rows = min(length_s * run.rate_Hz, len(run.time_s) / FEWEST_WINDOWS)
    return max(min(SHORTEST_WINDOW, len(run.time_s)), 2 * round(rows / 2))


def sweep_gain(run, order, window, length):
    """What share of the amplitude of an order a map shows whose windows have this length.

    The spectrum of a unit wave exp(i pi c t^2) under the window, at its highest point: c is the rate at which the
    frequency of the order changes. 1 at constant speed.
    """
    weight = tracking.window_of(window, length)
    time_s = (np.arange(length) - (length - 1) / 2) / run.rate_Hz
    sweep_Hz_per_s = order * run.sweep_rpm_per_s() / 60.0
    wave = weight * np.exp(1j * np.pi * sweep_Hz_per_s * time_s**2)
    return float(np.abs(np.fft.fft(wave, PADDING * length)).max() / weight.sum())


class Map:
    """Amplitudes over frequency and speed, or over frequency and time if the speed is constant."""

    def __init__(self, frequency_Hz, row, row_range, amplitude_N, over_time):
        self.frequency_Hz = frequency_Hz
        self.row = row  # middles of the rows: rpm, or s
        self.row_range = row_range  # of the whole run
        self.amplitude_N = amplitude_N  # [row, bin]; a row without a frame is NaN
        self.over_time = over_time

    def grid(self, frequency_high):
        """What gnuplot has to know of the grid up to a frequency."""
        low, high = self.row_range
        return {
            "columns": int((self.frequency_Hz <= frequency_high).sum()),
            "rows": len(self.row),
            "frequency_step": self.frequency_Hz[1],
            "row_first": self.row[0],
            "row_step": self.row[1] - self.row[0] if len(self.row) > 1 else high - low,
            "row_low": low,
            "row_high": high,
            "frequency_high": frequency_high,
        }


def speed_map(run, window="hann", length=STANDARD_LENGTH, hop=STANDARD_HOP, rows=330, over_time=None, highest_Hz=None):
    """Rms of the amplitudes over the frames of each row: a Map with never more rows than a third of the frames.

    The frames of a row have slightly different speeds, so an order stands at another frequency in each of them, a
    resonance does not. Both are read: the mean over the frames at the same frequency, and at the same order. What is
    shown is the larger one; for noise they are equal, but for some tenths of a dB. Up to `highest_Hz`, if not half the rate.
    """
    over_time = run.is_constant if over_time is None else over_time
    along = middles_of(run.time_s if over_time else run.speed_rpm, length, hop)
    speed_rpm = middles_of(run.speed_rpm, length, hop)
    whole = run.time_s if over_time else run.speed_rpm
    low, high = float(whole.min()), float(whole.max())

    # Which row each frame belongs to, and the mean speed of each row.
    rows = max(1, min(rows, len(along) // 3))
    edges = np.linspace(low, high, rows + 1)
    row_of = np.clip(np.searchsorted(edges, along, side="right") - 1, 0, rows - 1)
    count = np.bincount(row_of, minlength=rows)
    mean_rpm = np.bincount(row_of, speed_rpm, rows) / np.maximum(count, 1)

    # Sums over the frames of each row, at the same frequency and at the same order.
    all_Hz = np.fft.rfftfreq(padded(length, PADDING), 1.0 / run.rate_Hz)
    frequency_Hz = all_Hz[all_Hz <= (highest_Hz or np.inf)]
    fixed, moving = np.zeros((2, rows, len(frequency_Hz)))
    for first, pieces in frames_of(run, window, length, hop, PADDING):
        for frame, power in enumerate(pieces, start=first):
            row = row_of[frame]
            fixed[row] += power[: len(frequency_Hz)]
            if mean_rpm[row] > 0:
                moving[row] += np.interp(frequency_Hz * (speed_rpm[frame] / mean_rpm[row]), all_Hz, power)
    amplitude_N = np.maximum(fixed, moving, out=fixed)
    amplitude_N /= np.where(count > 0, count, np.nan)[:, None]
    np.sqrt(amplitude_N, out=amplitude_N)
    return Map(frequency_Hz, (edges[:-1] + edges[1:]) / 2.0, (low, high), amplitude_N, over_time)


# ----------------------------------------------------------------------------------------------------
# Orders
# ----------------------------------------------------------------------------------------------------


def cut_windows_s(run, speed_rpm, teeth):
    """Length of the window of an order cut at each of some speeds: as long as the sweep allows."""
    sweep_rpm_per_s = max(run.sweep_rpm_per_s(), 1e-9)
    teeth_s = 60.0 * CUT_TEETH / (np.maximum(speed_rpm, 1e-9) * teeth)
    longest_s = min(CUT_WINDOW_S, (run.time_s[-1] - run.time_s[0]) / 8.0)
    return np.clip(SWEEP_OF_CUT * speed_rpm / sweep_rpm_per_s, np.minimum(CUT_LEAST_WINDOW_S, teeth_s), longest_s)


def least_damping(run, speed_rpm, teeth):
    """Damping ratio from which on a resonance at this speed is shown to 1 % in an order cut."""
    window_s = float(cut_windows_s(run, np.array([speed_rpm]), teeth)[0])
    return window_s * run.sweep_rpm_per_s() / speed_rpm * RESOLVED_DAMPING / SWEEP_OF_CUT


def single_order_rpm(run):
    """Speed from which on the window of an order cut holds CUT_TURNS turns: below it, the orders beside count too."""
    return math.sqrt(60.0 * CUT_TURNS * run.sweep_rpm_per_s() / SWEEP_OF_CUT)


def order_cuts(run, order, multiples, teeth):
    """Amplitudes of rising whole multiples of an order: (row in the middle of each window, N [multiple, window]), NaN where a
    frequency is not trusted.

    The force is turned back by order times the angle, so that the order stands still, and averaged under a window. That
    follows the order exactly, however fast it sweeps. What remains to be lost is what its amplitude changes within
    the window, see cut_windows_s().
    """
    hop_s = min(CUT_HOP_S, (run.time_s[-1] - run.time_s[0]) / CUT_POINTS)
    hop = max(1, int(round(hop_s * run.rate_Hz)))
    mean_N, rows = run.force_N.mean(), len(run.force_N)

    # Windows that lie within the run, each as long as its speed wants it.
    middle = np.arange(hop // 2, rows, hop)
    half = np.maximum(4, (cut_windows_s(run, run.speed_rpm[middle], teeth) * run.rate_Hz / 2).astype(int))
    inside = (middle >= half) & (middle + half <= rows)
    middle, half = middle[inside], half[inside]
    if not len(middle):
        raise RunError(f"the run has {rows} rows, too few for an order cut")

    # Some windows at a time, so that what is turned back is never all of the run.
    amplitude_N, weight = np.empty((len(multiples), len(middle))), np.empty(0)
    for piece in np.array_split(np.arange(len(middle)), max(1, len(middle) // 64)):
        low, high = (middle - half)[piece].min(), (middle + half)[piece].max()
        phase, force_N = order * run.angle_rad[low:high], run.force_N[low:high] - mean_N
        back = np.cos(phase) - 1j * np.sin(phase)
        powers = itertools.accumulate(itertools.repeat(back, max(multiples)), np.multiply)
        still = [force_N * power for multiple, power in enumerate(powers, 1) if multiple in multiples]
        for window in piece:
            if len(weight) != 2 * half[window]:
                weight = tracking.even_weight(2 * half[window])
            part = slice(middle[window] - half[window] - low, middle[window] + half[window] - low)
            amplitude_N[:, window] = [2.0 * abs(values[part] @ weight) for values in still]

    amplitude_N[np.outer(multiples, order * run.speed_rpm[middle] / 60.0) > run.trusted_Hz] = np.nan
    return middle, amplitude_N


class OrderBlocks:
    """Spectra over the pinion angle: power[block, bin], squared peak amplitude (N^2), an array or stored.Rows."""

    def __init__(self, turns, bins, speed_rpm, lowest_rpm, highest_rpm, power, trusted_Hz, sweep_rpm_per_s):
        self.turns = turns  # of the pinion in a block: bins for each order
        self.order = np.arange(bins) / turns
        self.speed_rpm = speed_rpm  # mean of each block
        self.lowest_rpm, self.highest_rpm = lowest_rpm, highest_rpm  # of each block
        self.power = power
        self.trusted_Hz = trusted_Hz
        self.sweep_rpm_per_s = sweep_rpm_per_s

    def pieces(self):
        """The same, some blocks at a time."""
        for first in range(0, len(self.speed_rpm), PIECE_BLOCKS):
            part = slice(first, first + PIECE_BLOCKS)
            speeds_rpm = self.speed_rpm[part], self.lowest_rpm[part], self.highest_rpm[part]
            yield OrderBlocks(self.turns, len(self.order), *speeds_rpm, self.power[part], self.trusted_Hz,
                              self.sweep_rpm_per_s)

    def passes(self, order, low_Hz, high_Hz):
        """[block]: whether an order is in a band of frequencies at some time of the block."""
        return (order * self.lowest_rpm / 60.0 < high_Hz) & (order * self.highest_rpm / 60.0 > low_Hz)

    def line(self, order, above_Hz=0.0, left_out=False, on_slope=False):
        """Squared peak amplitude of a line and of the floor under it, one value for each block (N^2).

        Only blocks where the line lies above `above_Hz` and is trusted, but those of `left_out` [block].

        The line is the sum of 3 bins divided by 1.5, as a Hann window spreads it. The floor is what a noise of the
        median strength of the bins around puts there (median / ln 2 is the mean of its power; 3 bins / 1.5 = 2). Where
        the line stands on the slope of a wide peak, `on_slope` [block], which falls exponentially, the geometric mean of
        the next bins to either side, which the line does not reach, tells the floor as well.
        """
        middle = int(round(order * self.turns))

        # Bins that tell the noise, counted from the first of all that are needed.
        first = max(0, middle - FLOOR_FAR)
        beside = np.arange(FLOOR_NEAR, FLOOR_FAR + 1)
        around = np.r_[middle - beside, middle + beside]
        around = around[(around > 0) & (around < len(self.order))] - first

        # Blocks that count.
        frequency_Hz = order * self.speed_rpm / 60.0
        counts = (frequency_Hz > above_Hz) & (frequency_Hz < self.trusted_Hz)
        counts = counts & ~np.broadcast_to(left_out, counts.shape)
        power = self.power[:][:, first : middle + FLOOR_FAR + 1][counts]

        # The line, and what is under it.
        middle -= first
        line = power[:, middle - 1 : middle + 2].sum(axis=1) / 1.5
        floor = np.median(power[:, around], axis=1) / np.log(2.0) * 2.0
        slope = 2.0 * np.sqrt(power[:, middle - 2] * power[:, middle + 2])
        floor = np.where(np.broadcast_to(on_slope, len(self.power))[counts], np.maximum(floor, slope), floor)
        return line, floor

    def mean_amplitude_N(self, above_Hz=0.0):
        """Rms of the amplitude at each order over the blocks where it lies above `above_Hz` and is trusted.

        NaN where there is no such block.
        """
        count, total = np.zeros((2, len(self.order)))
        for piece in self.pieces():
            for speed_rpm, power in zip(piece.speed_rpm, piece.power):
                counts = slice(*np.searchsorted(speed_rpm / 60.0 * self.order, (above_Hz, self.trusted_Hz)))
                count[counts] += 1
                total[counts] += power[counts]
        return np.where(count > 0, np.sqrt(total / np.maximum(count, 1)), np.nan)


def block_turns(pinion_teeth, wheel_teeth):
    """Pinion turns of a block: near BLOCK_TURNS, and such that the wheel makes whole turns as well.

    Then the orders of both gears lie on bins, LINE_BINS of them or more from each other where the wheel turns slowly. If
    whole turns of the wheel took too many, they are given up.
    """
    least = max(BLOCK_TURNS, math.ceil(LINE_BINS * wheel_teeth / pinion_teeth))
    hunting_turns = wheel_teeth // math.gcd(pinion_teeth, wheel_teeth)
    if hunting_turns > 2 * least:
        return least
    turns = hunting_turns * max(1, round(least / hunting_turns))
    return turns if turns * pinion_teeth >= LINE_BINS * wheel_teeth else turns + hunting_turns


def fast_stretches(run):
    """(first row, row behind it) of each stretch that is fast enough for blocks throughout."""
    least_rpm = BLOCK_MIN_SHARE_OF_SPEED * run.speed_rpm.max()
    edges, was_fast = [], False
    for first, speed_rpm in stored.blocks(run.speed_rpm):
        fast = speed_rpm >= least_rpm
        edges.extend(first + np.flatnonzero(np.diff(fast, prepend=was_fast)))
        was_fast = fast[-1]
    if was_fast:
        edges.append(len(run.speed_rpm))
    return list(zip(edges[::2], edges[1::2]))


def block_starts(run, turns):
    """Turns at which blocks begin, half a block apart: each lies in a stretch that is fast enough throughout."""

    def turn(row):
        return run.angle_rad[row] / (2.0 * np.pi)

    parts = [np.arange(turn(first), turn(behind - 1) - turns, turns / 2.0) for first, behind in fast_stretches(run)]
    return np.concatenate(parts)


def order_blocks(run, turns, highest_order):
    """Spectra of blocks of `turns` pinion turns, Hann, overlapping by half; None if the run has none."""
    starts = block_starts(run, turns)
    if not len(starts):
        return None

    over_angle = tracking.OverAngle(run)

    # Each block over even steps of the angle, so many that it holds the whole bandwidth and nothing is aliased, and its
    # spectrum up to the highest order.
    bins = int(highest_order * turns) + 1
    power, speeds_rpm = stored.Rows(bins, np.float32), np.empty((3, len(starts)))
    for i, start in enumerate(starts):
        first, last = over_angle.rows(start, turns)
        inside_rpm = run.speed_rpm[first:last]
        speeds_rpm[:, i] = inside_rpm.mean(), inside_rpm.min(), inside_rpm.max()
        samples = math.ceil(turns * over_angle.samples_per_turn(highest_order, inside_rpm.min()))
        samples = fft.next_fast_len(samples, real=True)
        weight = tracking.window_of("hann", samples)
        spectrum = fft.rfft(over_angle.overlapping_piece(start, turns, samples) * weight)[:bins] * (2.0 / weight.sum())
        power.append((spectrum.real**2 + spectrum.imag**2)[None])
    return OrderBlocks(turns, bins, *speeds_rpm, power, run.trusted_Hz, run.sweep_rpm_per_s())
