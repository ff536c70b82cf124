# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""The orders of a signal: map, tracked orders, spectrum and overall level as numbers, and their pictures."""
import math
from fractions import Fraction

import numpy as np

import lines
import program
import runup
import tracking

HARMONICS = 4  # of the mesh, tracked if nothing is asked for
SPECTRUM_TURNS, SHORTEST_TURNS = 80, 10  # in a frame of the order spectrum
SPECTRUM_FRAMES = 200
STRONG = 10.0  # times the median around in power: a line
SKIRT = 1e-3  # of the power of a line within 1.5 orders: may be its skirt
WEAKEST = 1e-4  # of the strongest line
MOST_STRONG = 12
LINE_WIDTH = 3.0  # resolutions of a frame: what is nearer to a line is a part of it
FLOOR = 1e-30  # keeps logarithms finite


class Settings:
    """What is asked for where nobody asks; a command line has the same names."""

    orders = turns = db = over = max_order = max_frequency = range = ghost = planetary = title = None
    pinion_teeth = wheel_teeth = eigenfrequency = None
    method, bandwidth, window, amplitude, sidebands = "resampling", None, "hann", "peak", 5


# ----------------------------------------------------------------------------------------------------
# Scale
# ----------------------------------------------------------------------------------------------------


class Scale:
    """How an amplitude is told: peak, rms or power, as it is or in dB."""

    def __init__(self, kind, reference, quantity, unit):
        self.kind, self.reference, self.quantity, self.unit = kind, reference, quantity, unit

    def of_power(self, squared_peak):
        """Of the squared peak amplitude of a sine."""
        return self._told(squared_peak if self.kind == "peak" else squared_peak / 2.0)

    def of_rms(self, rms):
        """Of an overall rms, which has no peak amplitude."""
        return self._told(rms**2)

    def _told(self, square):
        if self.reference:
            return 10.0 * np.log10(np.maximum(square, FLOOR) / self.reference**2)
        return square if self.kind == "power" else np.sqrt(square)

    def shown(self, values):
        """As colours tell it: the logarithm of what is no level."""
        return values if self.reference else np.log10(np.maximum(values, FLOOR))

    @property
    def unit_text(self):
        if self.reference:
            return f"dB re {self.reference:g} {self.unit}".strip()
        return f"({self.unit})²" if self.kind == "power" and self.unit else self.unit

    @property
    def text(self):
        kind = {"peak": "peak amplitude", "rms": "rms", "power": "mean square"}[self.kind]
        return f"{self.quantity}, {kind}" + (f" / {self.unit_text}" if self.unit_text else "")

    def value_text(self, value):
        return f"{value:.1f} {self.unit_text}" if self.reference else f"{value:.4g} {self.unit_text}".strip()


# ----------------------------------------------------------------------------------------------------
# Which orders
# ----------------------------------------------------------------------------------------------------


def order_text(order):
    return f"{float(order):.6g}"


def known_lines(gears, options):
    """All lines that the gears and the options name."""
    found = []
    if options.planetary:
        found += lines.of_planetary(options.planetary, HARMONICS)
    elif gears is not None:
        found += lines.of_gears(gears, HARMONICS, options.sidebands)
    if options.ghost:
        found += lines.of_ghosts(options.ghost, gears)
    return found


def highest_order(run, known, asked, options):
    """Right edge of map and spectrum: past the tooth orders and what is asked for, as far as the rate goes."""
    held = 60.0 * run.trusted_Hz / max(np.percentile(run.speed_rpm, 5), tracking.SLOWEST_SHARE * run.speed_rpm.max())
    if options.max_order:
        return min(options.max_order, held)
    wanted = [float(line.order) for line in known if line.kind in ("mesh", "ghost", "planet")] + [float(o) for o in asked]
    all_speeds = 60.0 * run.trusted_Hz / run.speed_rpm.max()
    return min(held, 1.1 * max(wanted) if wanted else all_speeds)


def spectrum_frames(run, asked_turns):
    """Long frames, which tell lines apart; shorter ones where the speed changes so fast that few long ones fit."""
    whole = (run.angle_rad[-1] - run.angle_rad[0]) / (2.0 * np.pi)
    turns = asked_turns or max(1, min(SPECTRUM_TURNS, math.floor(whole / 2)))
    while True:
        try:
            frames = tracking.frames_of(run, turns, SPECTRUM_FRAMES)
            if asked_turns or turns < 2 * SHORTEST_TURNS or len(frames.row) > SPECTRUM_FRAMES / 2:
                return frames
        except runup.RunError:
            if asked_turns or turns < 2:
                raise
        turns //= 2


def strong_lines(order, power, turns):
    """Orders that stand out of what is around in most frames: [(order, mean power)], strongest first.

    What stands beside a much stronger line is its skirt, and what is in some frames only a resonance.
    """
    if len(power) < 4:
        return []
    count = np.isfinite(power).sum(axis=0)
    typical = np.where(count > 0, np.nanmedian(np.where(count > 0, power, 0.0), axis=0), 0.0)
    reach = max(3, int(round(1.5 / order[1])))
    rises = (typical[1:-1] > typical[:-2]) & (typical[1:-1] >= typical[2:])
    found = []
    for peak in np.flatnonzero(rises) + 1:
        around = typical[max(0, peak - reach) : peak + reach + 1]
        stands_out = typical[peak] > STRONG * np.median(around) and typical[peak] > SKIRT * around.max()
        if order[peak] * turns > 3.0 and stands_out and typical[peak] > WEAKEST * typical.max():
            found.append((order[peak], float(np.nanmean(power[:, peak], dtype=float))))
    return sorted(found, key=lambda line: -line[1])


# ----------------------------------------------------------------------------------------------------
# Numbers
# ----------------------------------------------------------------------------------------------------


class Analysis:
    """Everything that is drawn and told of a signal."""

    def __init__(self, signal, options, gears_needed=False):
        self.signal, self.options = signal, options
        run = signal.run
        self.gears = lines.gears_of(signal.path, signal.provenance, options, gears_needed)
        self.known = known_lines(self.gears, options)
        asked = lines.orders_asked(options.orders) if options.orders else []
        self.scale = Scale(options.amplitude, options.db, signal.quantity, signal.unit)
        edge = highest_order(run, self.known, asked, options)
        over_angle = tracking.OverAngle(run)

        # The order spectrum, and which orders are tracked.
        long_frames = spectrum_frames(run, options.turns)
        self.long_turns = long_frames.turns
        self.order, power = tracking.spectra(long_frames, over_angle, edge, options.window)
        self.mean = tracking.mean_power(power)
        self.strong = strong_lines(self.order, power, self.long_turns)
        self.tracked = (asked or [line.order for line in self.known if line.kind == "mesh"]
                        or [Fraction(peak) for peak, _ in self.strong[:HARMONICS]])
        self.nothing_stands_out = not self.tracked
        if self.nothing_stands_out:
            loud = np.where(self.order * self.long_turns > 3.0, self.mean, -np.inf)
            self.tracked = [Fraction(float(f"{self.order[np.nanargmax(loud)]:.5g}"))]

        # The map.
        over_time = run.is_constant if options.over is None else options.over == "time"
        self.map_frames = tracking.frames_of(run, options.turns or tracking.fitting_turns(run))
        spectra = tracking.spectra(self.map_frames, over_angle, edge, options.window)
        self.map = tracking.order_map(self.map_frames, *spectra, over_time)

        # The orders.
        orders = np.array([float(one) for one in self.tracked])
        self.frames = frames = (tracking.frames_of(run, options.turns) if options.turns
                                else tracking.track_frames(run, min(1.0, self.nearest)))
        if options.method == "vold-kalman":
            self.bandwidth = options.bandwidth or tracking.fitting_bandwidth(run, self.nearest)
            found = tracking.vold_kalman(run, orders, self.bandwidth, frames.row)
        else:
            found = tracking.tracked(frames, over_angle, orders)
        self.found = self.scale.of_power(found**2)
        self.overall = self.scale.of_rms(tracking.overall(frames))

    @property
    def nearest(self):
        """Distance of a tracked order from the next one, or from order 0."""
        return min(np.diff([0.0, *sorted(map(float, self.tracked))]))

    @property
    def method_text(self):
        if self.options.method == "vold-kalman":
            return f"Orders by a Vold-Kalman filter, {self.bandwidth:.2g} of an order wide"
        low, high = np.min(self.frames.turns), np.max(self.frames.turns)
        turns = f"{low:.3g}" if low == high else f"{low:.3g} to {high:.3g}"
        return f"Orders by resampling over the angle, frames of {turns} turns"

    def nameless(self):
        """Strong lines without a name: [(order, mean power, what it may be)]."""
        width = LINE_WIDTH / self.long_turns
        for peak, mean in self.strong[:MOST_STRONG]:
            if lines.name_of(peak, self.known, width) is None and all(abs(float(one) - peak) > width for one in self.tracked):
                yield peak, mean, self.gears and lines.named_turns(peak, self.gears, 1.0 / self.long_turns)


    def speed_map(self):
        """Map over frequency and speed, in windows in which no tracked order loses more than 1 %; and these windows (s)."""
        run, options = self.signal.run, self.options
        length = runup.window_length(run, max(map(float, self.tracked)))
        map_ = runup.speed_map(run, options.window, length, max(1, length // 4), over_time=self.map.over_time)
        return map_, length / run.rate_Hz


# ----------------------------------------------------------------------------------------------------
# Pictures
# ----------------------------------------------------------------------------------------------------


def range_of(values, scale, most, least):
    """Range that holds the loudest and nine of ten: in dB, or in exponents of 10."""
    good = values[np.isfinite(values) & (values > math.log10(FLOOR) + 1 if not scale.reference else np.isfinite(values))]
    if not len(good):
        return -1.0, 1.0
    step, most, least = (5.0, 20 * most, 20 * least) if scale.reference else (0.5, most, least)
    high = math.ceil(good.max() / step - 1e-9) * step
    low = math.floor(np.percentile(good, 10) / step) * step
    return max(min(low, high - least), high - most), high


def write_eigenfrequency(path, frequency_Hz, frames, map_):
    """Where a frequency passes a map of orders; returns whether it does."""
    if map_.over_time:
        row, speed_rpm = frames.time_s, frames.speed_rpm
    else:
        row = speed_rpm = np.linspace(*map_.row_range, 300)
    order = 60.0 * frequency_Hz / np.maximum(speed_rpm, 1e-9)
    inside = (order > 0) & (order < map_.order[-1])
    np.savetxt(path, np.column_stack([order, row])[inside] if inside.any() else np.array([[-1.0, row[0]]]), "%.8g")
    return int(inside.any())


def subtitle(signal, gears, frames, edge):
    run = signal.run
    gears_text = f"{gears.teeth_text}, " if gears else ""
    white = "" if frames.trusted([edge]).all() else "; white: above 0.4 of the rate"
    return f"{gears_text}{runup.speed_text(run)}; frames of {frames.turns:g} turns{white}"


def frequency_edge_Hz(analysis, frequency_Hz):
    """Right edge of the speed map: what is tracked at the highest speed, and the eigenfrequency, as far as the rate goes."""
    run, asked = analysis.signal.run, analysis.options.max_frequency
    lines_Hz = max(map(float, analysis.tracked)) * run.speed_rpm.max() / 60.0
    return min(asked or 1.2 * max(lines_Hz, 1.25 * frequency_Hz), run.trusted_Hz)


def speed_map_picture(analysis, folder):
    """The same of the map over frequency and speed."""
    signal, options, scale, gears = analysis.signal, analysis.options, analysis.scale, analysis.gears
    run = signal.run
    frequency_Hz = (gears and gears.eigenfrequency_Hz) or options.eigenfrequency or 0.0
    map_, window_s = analysis.speed_map()
    grid = map_.grid(frequency_edge_Hz(analysis, frequency_Hz))

    # A row without a window is that of the nearest one that has some.
    filled = np.flatnonzero(np.isfinite(map_.amplitude_N[:, 0]))
    nearest = filled[np.abs(np.arange(grid["rows"])[:, None] - filled).argmin(axis=1)]
    shown = scale.shown(scale.of_power(map_.amplitude_N[nearest, : grid["columns"]] ** 2))
    shown.astype("<f4").tofile(f"{folder}/speeds.bin")
    colours = options.range or range_of(shown, scale, 4.0, 1.5)

    # Over time an order is a straight line at a constant speed only.
    is_straight = not map_.over_time or run.is_constant
    rim = lines.speed_rim([float(one) for one in analysis.tracked] if is_straight else [], grid["frequency_high"],
                          *map_.row_range, run.speed_rpm.mean() if map_.over_time else None)
    gears_text = f"{gears.teeth_text}, " if gears else ""
    return {
        "_speedmap": ("speed_map.gp", {
            "data": "speeds.bin",
            "title_text": program.title_of(options.title, signal.path),
            "subtitle_text": f"{gears_text}{runup.speed_text(run)}; windows of {1e3 * window_s:.3g} ms",
            "map_text": scale.text if scale.reference else "log10 " + scale.text,
            "is_level": int(bool(scale.reference)),
            "over_time": int(map_.over_time),
            "speed_name": "pinion speed" if gears else "speed",
            "rim_note": "rim: orders" if rim["marks"] else "",
            "eigenfrequency": frequency_Hz,
            "colour_low": float(colours[0]),
            "colour_high": float(colours[1]),
            **rim,
            **grid,
        })
    }


def pictures(analysis, folder):
    """{name: (file of gnuplot, variables)}; the data are written into the folder."""
    signal, options, scale, known = analysis.signal, analysis.options, analysis.scale, analysis.known
    gears, frames, map_, tracked = analysis.gears, analysis.frames, analysis.map, analysis.tracked
    found, overall = analysis.found, analysis.overall
    edge = float(map_.order[-1])
    step, power = tracking.pooled(map_.order, map_.power)
    shown = scale.shown(scale.of_power(power))
    colours = options.range or range_of(shown, scale, 4.0, 1.5)
    shown.astype("<f4").tofile(f"{folder}/map.bin")

    # Tracks over the speed: in the order of time, with gaps where the rate does not hold an order.
    along = frames.time_s if map_.over_time else frames.speed_rpm
    np.savetxt(f"{folder}/tracks.dat", np.column_stack([along, overall, *found]), "%.8g")
    levels = range_of(scale.shown(np.concatenate([overall, *found])), scale, 5.0, 2.0)
    order, values = analysis.order, scale.of_power(analysis.mean)
    group = max(1, len(order) // 6000)
    kept = len(order) // group * group
    drawn = np.column_stack([order[:kept:group], np.fmax.reduce(values[:kept].reshape(-1, group), axis=1)])
    np.savetxt(f"{folder}/spectrum.dat", drawn[1:], "%.8g")
    low, high = range_of(scale.shown(values[1:]), scale, 6.0, 2.0)
    frequency_Hz = (gears and gears.eigenfrequency_Hz) or options.eigenfrequency or 0.0
    common = {
        "title_text": program.title_of(options.title, signal.path),
        "subtitle_text": subtitle(signal, gears, analysis.map_frames, edge),
        "axis_text": scale.text,
        "map_text": scale.text if scale.reference else "log10 " + scale.text,
        "overall_text": "all (mean square)" if scale.kind == "power" else "all (rms)",
        "is_level": int(bool(scale.reference)),
        "over_time": int(map_.over_time),
        "speed_name": "pinion speed" if gears else "speed",
        "eigenfrequency": frequency_Hz,
        "eigenfrequency_is_shown": write_eigenfrequency(f"{folder}/eigenfrequency.dat", frequency_Hz, analysis.map_frames, map_),
        "edge": edge,
        **lines.rim_values(known, tracked, edge),
    }
    grid = {
        "columns": int(shown.shape[1]),
        "rows": int(shown.shape[0]),
        "order_step": float(step),
        "row_low": map_.row_range[0],
        "row_high": map_.row_range[1],
        "colour_low": float(colours[0]),
        "colour_high": float(colours[1]),
    }
    tracks = {
        "method_text": analysis.method_text,
        "curves": len(tracked),
        "low": levels[0] if scale.reference else 10.0 ** levels[0],
        "high": levels[1] if scale.reference else 10.0 ** levels[1],
        "row_low": float(along.min()),
        "row_high": float(max(along.max(), along.min() + 1e-9)),
    }
    for i, one in enumerate(tracked):
        name = lines.name_of(float(one), known, 1e-6)
        tracks[f"curve_{i}"] = f"{order_text(one)}" + (f" {name}" if name else "")
    ends = (low, high) if scale.reference else (10.0**low, 10.0**high)
    return {
        "_ordermap": ("orders_map.gp", {**common, **grid}),
        "_tracks": ("orders_tracks.gp", {**common, **tracks}),
        "_orderspectrum": ("orders_spectrum.gp", {**common, "low": ends[0], "high": ends[1]}),
    }
