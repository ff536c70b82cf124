# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Orders of any signal over the angle of a shaft: short spectra, single orders, Vold-Kalman filter, overall level.

A frame holds a number of turns, whichever way the shaft turns and however its speed changes in it: the signal is read
at even steps of the angle. So an order stands still in it, and is read at any number, whole or not. Amplitudes are peak
values.

The Vold-Kalman filter of the second generation (H. Vold, J. Leuridan, SAE 931288, 1993; J. Tuma, "Setting the passband
width in the Vold-Kalman order tracking filter", ICSV12, 2005) finds the envelopes of all its orders at once: those that
change least and leave least of the signal. Here envelopes are constant over a sixteenth of 1 / bandwidth of the angle.
So the passband is the same in orders at all speeds, and the equations are well conditioned however narrow it is.
"""
import math

import numpy as np
from scipy import fft, linalg

from results import RunError

SLOWEST_SHARE = 0.02  # of the highest speed: what turns slower has no frames
STEADY_RATIO = 2.0  # highest to lowest speed of a frame
SWEEP_OF_FRAME = 0.05  # share of the speed by which it may change in a frame of a map, if nothing is asked for
FEWEST_TURNS, MOST_TURNS = 5, 40
# The same for single orders: a resonance of RESOLVED_DAMPING is then shown to 1 %. So many turns tell orders 1 apart.
SWEEP_OF_TRACK, RESOLVED_DAMPING, TURNS_APART = 0.035, 0.02, 2.5
BANDWIDTH_TURNS, LEAST_BANDWIDTH = 4.0, 0.1  # of a Vold-Kalman filter, times the turns of such a frame
MOST_BANDWIDTH = 0.5  # of what is 1 order away, as the sidebands of a gear are, 1 % leaks in then
BESIDE = 24  # rows to each side of a piece: more than the low-pass of a doubled rate reaches, and a spline feels
POINTS = 600  # frames in a record, at most
DOUBLING_REACH = 20  # half rows to each side
WINDOWS = {"hann": (0.5, 0.5), "flattop": (0.21557895, 0.41663158, 0.277263158, 0.083578947, 0.006947368)}
PADDING = 8  # between two bins of a map a Hann window then loses 0.3 % at most
STEPS_OF_BANDWIDTH = 16  # steps of an envelope of the Vold-Kalman filter in 1 / bandwidth


class OverAngle:
    """A signal without its mean that can be read at any angle.

    At twice its rate a cubic spline through the signal is exact to 0.1 % up to the trusted frequency.
    """

    def __init__(self, run):
        self.angle_rad = run.angle_rad
        self.rate_Hz = run.rate_Hz
        self.values, self.mean = run.force_N, run.force_N.mean()
        self._kept = None  # where a half begins, and its spline

    def rows(self, start, turns):
        """The first row in so many turns from a turn on, and that behind the last one."""
        return np.searchsorted(self.angle_rad, (2.0 * np.pi * start, 2.0 * np.pi * (start + turns)))

    def piece(self, start, turns, samples):
        """So many samples at even steps of the angle."""
        return self._spline(start, turns)(start + np.arange(samples) * (turns / samples))

    def overlapping_piece(self, start, turns, samples):
        """The same, where pieces are half of one apart: each has a half in common with the one before."""
        half = 0.5 * turns
        if self._kept is None or abs(self._kept[0] - start) > 1e-9 * turns:
            self._kept = start, self._spline(start, half)
        at = start + np.arange(samples) * (turns / samples)
        behind = np.searchsorted(at, start + half)
        first, self._kept = self._kept[1](at[:behind]), (start + half, self._spline(start + half, half))
        return np.concatenate([first, self._kept[1](at[behind:])])

    def _spline(self, start, turns):
        from scipy import interpolate  # pylint: disable=import-outside-toplevel  (takes its time to load)

        first, last = self.rows(start, turns)
        part = slice(max(0, first - BESIDE), last + BESIDE)

        # At twice the rate. The angle half-way between two rows is their mean.
        values, rows_turn = doubled(self.values[part] - self.mean), self.angle_rad[part] / (2.0 * np.pi)
        turn = np.repeat(rows_turn, 2)
        turn[1:-1:2] += 0.5 * np.diff(rows_turn)

        growing = np.diff(turn, prepend=-np.inf) > 0  # it may stand still beside the piece
        if not growing.all():
            turn, values = turn[growing], values[growing]
        return interpolate.CubicSpline(turn, values)

    def samples_per_turn(self, highest_order, lowest_rpm):
        """So many that the slowest stretch holds the whole bandwidth: nothing is aliased."""
        return max(2.2 * highest_order, 1.1 * self.rate_Hz * 60.0 / lowest_rpm)


def window_of(name, length):
    """Weights of a Hann or a flat-top window, a sum of cosines over a period; the flat one is that of scipy and of Matlab."""
    coefficients = WINDOWS[name]
    turn = 2.0 * np.pi / length * np.arange(length)
    return sum((-1) ** k * value * np.cos(k * turn) for k, value in enumerate(coefficients))


def doubled(values):
    """A signal at twice its rate: a sinc under a Kaiser window (beta 5), ten rows to each side; its weights have the sum 2."""
    away = np.arange(-DOUBLING_REACH, DOUBLING_REACH + 1)
    weights = np.sinc(away / 2.0) * np.kaiser(len(away), 5.0)
    weights *= 2.0 / weights.sum()

    # Of the weights at rows the sinc leaves the middle one alone; the others are at the places between two rows.
    found = np.empty(2 * len(values))
    found[::2] = weights[DOUBLING_REACH] * values
    found[1::2] = np.convolve(values, weights[1::2])[DOUBLING_REACH // 2 : DOUBLING_REACH // 2 + len(values)]
    return found


class Frames:
    """Pieces of some turns, the same or each its own: where they begin, the row in their middle, lowest and highest speed."""

    def __init__(self, run, turns, start, row, lowest_rpm, highest_rpm):
        self.run, self.turns = run, turns
        self.start, self.row = start, row
        self.lowest_rpm, self.highest_rpm = lowest_rpm, highest_rpm

    @property
    def time_s(self):
        return self.run.time_s[self.row]

    @property
    def speed_rpm(self):
        return self.run.speed_rpm[self.row]

    def pieces(self, over_angle, highest_order):
        """The signal over the angle, frame by frame."""
        for start, turns, lowest_rpm in zip(self.start, np.broadcast_to(self.turns, self.start.shape), self.lowest_rpm):
            samples = turns * over_angle.samples_per_turn(highest_order, lowest_rpm)
            yield over_angle.piece(start, turns, fft.next_fast_len(math.ceil(samples), real=True))

    def trusted(self, orders):
        """[frame, order]: whether the frequency of an order is one that the rate of the record holds."""
        return np.outer(self.highest_rpm / 60.0, orders) <= self.run.trusted_Hz


def whole_turns(run):
    return (run.angle_rad[-1] - run.angle_rad[0]) / (2.0 * np.pi)


def fitting_turns(run):
    """Turns of the frames of a map, in which the speed changes by SWEEP_OF_FRAME at the mean speed."""
    mean_rpm = run.speed_rpm.mean()
    turns = SWEEP_OF_FRAME * mean_rpm**2 / (60.0 * max(run.sweep_rpm_per_s(), 1e-9))
    return max(1.0, min(max(FEWEST_TURNS, min(MOST_TURNS, round(turns))), math.floor(whole_turns(run) / 4)))


def track_frames(run, apart=1.0):
    """Frames for single orders that are `apart` from what they are to be told from: as long as the sweep allows."""
    sweep_rpm_per_s = max(run.sweep_rpm_per_s(), 1e-9)

    def turns_at(speed_rpm):
        longest = min(max(MOST_TURNS, TURNS_APART / apart), max(1.0, whole_turns(run) / 4.0))
        turns = SWEEP_OF_TRACK * speed_rpm**2 / (60.0 * sweep_rpm_per_s)
        return np.clip(turns, min(TURNS_APART / apart, longest), longest)

    return frames_of(run, turns_at)


def fitting_bandwidth(run, apart):
    """Bandwidth of a Vold-Kalman filter, in orders, that follows a resonance as frames of track_frames() do.

    It is the same at all speeds, and as wide as those of the lower quarter want it.
    """
    turns = SWEEP_OF_TRACK * np.percentile(run.speed_rpm, 25) ** 2 / (60.0 * max(run.sweep_rpm_per_s(), 1e-9))
    most = min(MOST_BANDWIDTH, apart / 2.0)
    return float(np.clip(BANDWIDTH_TURNS / max(turns, 1e-9), min(LEAST_BANDWIDTH, most), most))


def least_damping(run, frames):
    """[frame] Damping ratio from which on a resonance that an order passes there is shown to 1 %."""
    duration_s = 60.0 * frames.turns / frames.speed_rpm
    return RESOLVED_DAMPING / SWEEP_OF_TRACK * duration_s * run.sweep_rpm_per_s() / frames.speed_rpm


def frames_of(run, turns, points=None):
    """Frames about rows at even distances in time, where the shaft turns fast enough and one way.

    `turns` is a number, or a function of the speeds.
    """
    turn = run.angle_rad / (2.0 * np.pi)
    row = np.unique(np.linspace(0, len(turn) - 1, points or POINTS).astype(int))
    own_turns = callable(turns)
    turns = turns(run.speed_rpm[row]) if own_turns else np.full(len(row), float(turns))
    start = turn[row] - turns / 2.0
    first, last = np.searchsorted(turn, start), np.searchsorted(turn, start + turns)
    slow = np.concatenate([[0], np.cumsum(run.speed_rpm < SLOWEST_SHARE * run.speed_rpm.max())])
    inside = (start >= turn[0]) & (start + turns <= turn[-1]) & (last > first)
    inside[inside] = slow[last[inside]] == slow[first[inside]]
    row, start, turns, first, last = (values[inside] for values in (row, start, turns, first, last))

    speeds = [run.speed_rpm[a:b] for a, b in zip(first, last)]
    lowest, highest = np.array([(s.min(), s.max()) for s in speeds]).reshape(-1, 2).T
    steady = highest <= STEADY_RATIO * np.maximum(lowest, 1e-300)
    if not steady.any():
        raise RunError(f"no frame of some turns at a speed that is steady enough; the record has {whole_turns(run):.4g} "
                       "turns (--turns)")
    turns = turns[steady] if own_turns else float(turns[0])
    return Frames(run, turns, start[steady], row[steady], lowest[steady], highest[steady])


# ----------------------------------------------------------------------------------------------------
# Spectra
# ----------------------------------------------------------------------------------------------------


def spectra(frames, over_angle, highest_order, window="hann", padding=PADDING):
    """(order, squared peak amplitude [frame, order]) of all frames, NaN where the rate does not hold the order."""
    power = None
    for i, piece in enumerate(frames.pieces(over_angle, highest_order)):
        weight = window_of(window, len(piece))
        bins = int(highest_order * frames.turns * padding) + 1
        spectrum = fft.rfft(piece * weight, padding * len(piece))[:bins]
        if power is None:
            power = np.empty((len(frames.row), bins), dtype=np.float32)
        power[i] = np.abs(2.0 * spectrum / weight.sum()) ** 2
    order = np.arange(power.shape[1]) / (frames.turns * padding)
    power[~frames.trusted(order)] = np.nan
    return order, power


def mean_power(power):
    """Mean over the frames that hold an order; NaN where none does."""
    count = np.isfinite(power).sum(axis=0)
    return np.where(count > 0, np.nansum(power, axis=0, dtype=float) / np.maximum(count, 1), np.nan)


def even_weight(length):
    """Weights of a window of an order: sum 1, and no second moment.

    A plain window takes the peak of a resonance down by half its second moment times the curvature of the amplitude.
    A Hann window times a + b u^2, u from -1/2 to 1/2, has the sum 1 and the second moment 0 with
    b = -1 / (m4 / m2 - m2), a = 1 - b m2, where m2 and m4 are the moments of the Hann window.
    """
    half = np.arange((length + 1) // 2)
    u = (half + 0.5) / length - 0.5
    hann, square = 1.0 + np.cos(2.0 * np.pi * u), u * u

    # Half of it, and what is on the other side: all but the middle of an odd number.
    count = np.where(half == length - 1 - half, 1.0, 2.0)
    hann /= count @ hann
    both = count * hann
    m2, m4 = both @ square, both @ (square * square)
    b = -1.0 / (m4 / m2 - m2)
    weight = hann * (1.0 - b * m2 + b * square)
    return np.concatenate([weight, weight[: length // 2][::-1]])


def _hann_weight(length):
    weight = window_of("hann", length)
    return weight / weight.sum()


def tracked(frames, over_angle, orders):
    """Amplitudes [order, frame] of any orders, whole or not, read at the order itself; NaN: the rate does not hold it.

    Under a Hann window if all frames have the same turns, which somebody chose to tell lines apart: those 3 / turns apart
    are. Frames as long as the sweep allows have a window that follows what an amplitude does in them, see even_weight().
    """
    weight_of = even_weight if np.ndim(frames.turns) else _hann_weight
    highest = max(orders)
    apart = min(np.diff([0.0, *sorted(orders)]))
    found = np.empty((len(orders), len(frames.row)))
    all_turns = np.broadcast_to(frames.turns, frames.row.shape)
    for i, (turns, piece) in enumerate(zip(all_turns, frames.pieces(over_angle, highest))):
        at = np.arange(len(piece)) * (turns / len(piece))
        waves = np.exp(2j * np.pi * np.outer(orders, at))
        found[:, i] = 2.0 * np.abs(_shares(piece, waves, weight_of(len(piece)), apart * turns))
    return np.where(frames.trusted(orders).T, found, np.nan)


def _shares(values, waves, weight, apart_bins):
    """Complex share of each wave in the values, half the amplitude of its sine.

    Under the window a wave shows a little of each other one, of the opposite waves, and of the mean: a small matrix, which
    is the same for whatever amplitudes and is taken out (the orthogonality compensation of J. R. Blough, D. L. Brown, H.
    Vold, SAE 972006, 1997). Waves nearer than a bin look the same, and stay as they are.
    """
    if apart_bins < 1.0:
        return waves.conj() @ (values * weight)
    basis = np.vstack([waves, waves.conj(), np.ones(len(values))])
    weighted = basis.conj() * weight
    return np.linalg.solve(weighted @ basis.T, weighted @ values)[: len(waves)]


def overall(frames):
    """Rms of the signal without its mean in each frame."""
    turn = frames.run.angle_rad / (2.0 * np.pi)
    ends = np.searchsorted(turn, (frames.start, frames.start + frames.turns)).T
    return np.array([frames.run.force_N[first:last].std() for first, last in ends])


# ----------------------------------------------------------------------------------------------------
# Vold-Kalman filter
# ----------------------------------------------------------------------------------------------------


def vold_kalman(run, orders, bandwidth, at_rows):
    """Amplitudes [order, row] of any orders at some rows; `bandwidth` in orders, between the half powers."""
    found = np.full((len(orders), len(at_rows)), np.nan)
    turn = run.angle_rad / (2.0 * np.pi)
    fast = run.speed_rpm >= SLOWEST_SHARE * run.speed_rpm.max()
    edges = np.flatnonzero(np.diff(np.concatenate([[False], fast, [False]]).astype(int)))
    values = run.force_N - run.force_N.mean()

    # Each stretch that turns one way by itself.
    for first, last in zip(edges[::2], edges[1::2]):
        steps = STEPS_OF_BANDWIDTH * bandwidth * (turn[first:last] - turn[first])
        if steps[-1] < STEPS_OF_BANDWIDTH:
            continue
        envelopes = _envelopes(values[first:last], run.angle_rad[first:last], steps, orders)
        rows = np.flatnonzero((at_rows >= first) & (at_rows < last))
        middles = np.arange(envelopes.shape[1]) + 0.5
        for k, envelope in enumerate(envelopes):
            parts = [np.interp(steps[at_rows[rows] - first], middles, part) for part in (envelope.real, envelope.imag)]
            found[k, rows] = np.hypot(*parts)
    frequency_Hz = np.outer(orders, run.speed_rpm[at_rows] / 60.0)
    return np.where(frequency_Hz <= run.trusted_Hz, found, np.nan)


def _envelopes(values, angle_rad, steps, orders):
    """Complex envelopes [order, step] that minimise |values - sum of Re(envelope exp(i order angle))|^2 + r^2 |D envelope|^2.

    D are the second differences from step to step. In the mean over a turn the first term weighs an envelope with half
    the number of rows n of its step. With r^2 = n / 2 (sqrt(2) - 1) / (2 sin(pi b / 2))^4 a modulation by half the
    bandwidth, b = 1 / STEPS_OF_BANDWIDTH of it in a step, comes out with half its power.
    """
    size, unknowns = 2 * len(orders), 2 * len(orders)
    step_of = np.minimum(steps.astype(int), math.ceil(steps[-1]) - 1)
    count = int(step_of[-1]) + 1
    waves = np.empty((size, len(values)))
    for k, order in enumerate(orders):
        phase = np.remainder(order * angle_rad, 2.0 * np.pi)
        waves[2 * k], waves[2 * k + 1] = np.cos(phase), -np.sin(phase)

    # The signal: sums over the rows of each step, a band of `unknowns` at either side of the diagonal.
    band = 2 * unknowns
    matrix, right = np.zeros((band + 1, count * unknowns)), np.zeros((count, unknowns))
    for i in range(unknowns):
        right[:, i] = np.bincount(step_of, waves[i] * values, count)
        for j in range(i, unknowns):
            matrix[band + i - j, j::unknowns] = np.bincount(step_of, waves[i] * waves[j], count)

    # The smoothness.
    rows = np.interp(np.arange(count - 2) + 1.5, steps, np.gradient(np.arange(len(steps)), steps))
    weight = rows / 2.0 * (math.sqrt(2.0) - 1.0) / (2.0 * math.sin(math.pi / (2 * STEPS_OF_BANDWIDTH))) ** 4
    for i, one in enumerate((1.0, -2.0, 1.0)):
        for j, other in list(enumerate((1.0, -2.0, 1.0)))[i:]:
            into = matrix[band - (j - i) * unknowns].reshape(count, unknowns)
            into[j : j + count - 2] += (weight * one * other)[:, None]

    parts = linalg.solveh_banded(matrix, right.ravel(), overwrite_ab=True, check_finite=False).reshape(count, unknowns)
    return (parts[:, 0::2] + 1j * parts[:, 1::2]).T


# ----------------------------------------------------------------------------------------------------
# Maps
# ----------------------------------------------------------------------------------------------------


class Map:
    """Power over order and speed (or time): rows from low to high, evenly."""

    def __init__(self, order, row, row_range, power, over_time):
        self.order, self.row, self.row_range, self.power, self.over_time = order, row, row_range, power, over_time


def order_map(frames, order, power, over_time, rows=330, limits=None):
    """Mean power of the frames of each row, from the lowest speed (or time) to the highest, or between limits.

    A row without a frame is that of the nearest one that has some.
    """
    run = frames.run
    along = frames.time_s if over_time else frames.speed_rpm
    whole = run.time_s if over_time else run.speed_rpm
    low, high = (float(whole.min()), float(whole.max())) if over_time else (float(along.min()), float(along.max()))
    low, high = limits or (low, high)
    if high <= low:
        low, high = low - 0.5, high + 0.5
    rows = max(1, min(rows, len(along) // 2))
    row_of = np.floor((along - low) / (high - low) * rows)
    row_of = np.where(along == high, rows - 1, row_of).astype(int)
    filled = np.unique(row_of[(row_of >= 0) & (row_of < rows)])
    mean = np.array([mean_power(power[row_of == row]) for row in filled])
    middles = low + (np.arange(rows) + 0.5) * (high - low) / rows
    nearest = np.abs(np.arange(rows)[:, None] - filled).argmin(axis=1)
    return Map(order, middles, (low, high), mean[nearest], over_time)


def pooled(order, power, columns=1400):
    """The same with no more columns than a picture shows: the highest of those beside each other. (step, power)"""
    group = max(1, -(-len(order) // columns))
    kept = len(order) // group * group
    with np.errstate(invalid="ignore"):
        shown = np.fmax.reduce(power[:, :kept].reshape(len(power), -1, group), axis=2)
    return group * (order[1] - order[0]), shown
