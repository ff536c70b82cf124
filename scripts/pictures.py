# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of what gearsim computes: each function writes the data for gnuplot and returns (file of gnuplot, variables)."""
import math

import numpy as np

import lines
import program
import results
import summary
import tracking

SHOWN_LOADS = 7
SIGNAL_CYCLES = 16  # mesh cycles in the picture of a time signal
SPECTRUM_TURNS = 16
FLOOR_SHARE = 1e-4  # of the loudest power: what is weaker in both runs is equal in a map of differences
HARMONICS = summary.HARMONICS
# What a static run may have: (column, axis).
STATIC_PANELS = (
    ("te_um", "transmission error / µm"),
    ("mesh_stiffness_N_per_um", "mesh stiffness / (N/µm)"),
    ("largest_pressure_N_per_mm2", "largest pressure / (N/mm²)"),
)


class Result:
    """A run of either kind, read once for all its pictures."""

    def __init__(self, path, title=None):
        self.path, self.title = path, program.title_of(title, path)
        self.columns, self.provenance, self.incomplete = summary.read_all(path)
        results.check_numbers(path, self.columns)
        self.gears = lines.gears_of(path, self.provenance, summary.Options)
        self.is_static = "time_s" not in self.columns and "te_um" in self.columns
        self._tracks = {}

    @property
    def gears_text(self):
        return self.gears.teeth_text

    def tracks(self, name="contact_force_N"):
        """Tooth orders of a column; raises RunError if it has none."""
        if name not in self._tracks:
            self._tracks[name] = summary.tracks_of(self.path, self.columns, name, self.gears)
        tracks = self._tracks[name]
        if isinstance(tracks, summary.NoTracks):
            raise results.RunError(f"{self.path}: {tracks.why}")
        return tracks

    @property
    def why_no_tracks(self):
        """Why the force has no tooth orders; None if it has."""
        try:
            self.tracks()
        except results.RunError as error:
            return str(error)
        return None

    def frame_at(self, speed_rpm):
        """Number of the frame whose speed is nearest; where the tooth orders are loudest if no speed is given."""
        tracks = self.tracks()
        if speed_rpm is None:
            loudness = np.nansum(tracks.amplitude**2, axis=0)
            return int(np.argmax(loudness))
        frames_rpm = tracks.frames.speed_rpm
        if not 0.98 * frames_rpm.min() <= abs(speed_rpm) <= 1.02 * frames_rpm.max():
            raise program.InputError(f"--at: must be {frames_rpm.min():.5g} to {frames_rpm.max():.5g} rpm for {self.path} "
                                     f"(got {speed_rpm:g})")
        return int(np.argmin(np.abs(frames_rpm - abs(speed_rpm))))


def padded(values, share=0.06):
    """Range of an axis that holds all finite values, with some room."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    room = share * (high - low) or 0.05 * abs(high) or 1.0
    return low - room, high + room


def titles(result, text):
    return {"title_text": result.title, "subtitle_text": f"{result.gears_text}; {text}"}


# ----------------------------------------------------------------------------------------------------
# Static runs
# ----------------------------------------------------------------------------------------------------


def static_curves(result, folder):
    """Transmission error, stiffness and pressure over the mesh cycle, a curve for each of some loads."""
    blocks = summary.load_blocks(result.columns, result.provenance)
    shown = [blocks[i] for i in np.unique(np.linspace(0, len(blocks) - 1, SHOWN_LOADS).astype(int))]
    panels = [(name, axis) for name, axis in STATIC_PANELS if name in result.columns]
    with open(f"{folder}/static.dat", "w", encoding="ascii") as file:
        for _, rows in shown:
            cycles = result.columns["pinion_angle_rad"][rows] * result.gears.pinion_teeth / (2.0 * np.pi)
            np.savetxt(file, np.column_stack([cycles, *(result.columns[name][rows] for name, _ in panels)]), "%.8g")
            file.write("\n\n")
    values = {**titles(result, "quasi-static, over the mesh cycle"), "curves": len(shown), "panels": len(panels),
              "cycles": float(cycles.max())}
    for i, (load_Nm, _) in enumerate(shown):
        values[f"label_{i}"] = "" if load_Nm is None else f"{load_Nm:.5g} N m"
    for i, (name, axis) in enumerate(panels):
        values[f"axis_{i}"] = axis
        values[f"low_{i}"], values[f"high_{i}"] = padded(np.concatenate([result.columns[name][rows] for _, rows in shown]))
    return "plot_static.gp", values


def static_harmonics(result, folder):
    """Peak-to-peak transmission error and its mesh harmonics over the load; None where there are no harmonics."""
    found = summary.static_loads(result.columns, result.provenance, result.gears)
    if found[0]["te_harmonics"][0]["value"] is None or found[0]["load"]["value"] is None:
        return None
    table = np.array([[one["load"]["value"], one["te_peak_to_peak"]["value"],
                       *(value["value"] for value in one["te_harmonics"])] for one in found])
    np.savetxt(f"{folder}/harmonics.dat", table[np.argsort(table[:, 0])], "%.8g")
    one_load = len(table) == 1
    return "plot_harmonics.gp", {
        **titles(result, "harmonics of the quasi-static transmission error"),
        "harmonics": HARMONICS, "loads": len(table), "load_low": float(table[:, 0].min()),
        "load_high": float(table[:, 0].max()) + (1.0 if one_load else 0.0), "top": 1.08 * float(table[:, 1:].max()) or 1.0,
    }


# ----------------------------------------------------------------------------------------------------
# Dynamic runs at one speed
# ----------------------------------------------------------------------------------------------------


def time_signal(result, folder, speed_rpm=None):
    """Force over some mesh cycles, and the phase portrait of the transmission error, told apart by the flank that touches."""
    frame = result.frame_at(speed_rpm)
    tracks, columns = result.tracks(), result.columns
    row = int(tracks.frames.row[frame])
    turn = tracks.run.angle_rad / (2.0 * np.pi)
    half = 0.5 * SIGNAL_CYCLES / result.gears.pinion_teeth
    first, last = np.searchsorted(turn, (turn[row] - half, turn[row] + half))
    first, last = max(0, min(first, row - 8)), min(len(turn), max(last, row + 8))
    rows = slice(int(first), int(last))

    # Which flanks touch: 0 none, 1 those that drive forward, 2 those of coast.
    force_N = columns["contact_force_N"]
    none = columns[results.PAIRS_COLUMN][rows] == 0 if results.PAIRS_COLUMN in columns else force_N[rows] == 0.0
    flank = np.where(none, 0, np.where(force_N[rows] < 0.0, 2, 1))
    te_um = columns[summary.TE_COLUMN]
    rate_mm_per_s = 1e-3 * np.gradient(te_um, columns["time_s"])
    table = np.column_stack([1e3 * (columns["time_s"][rows] - columns["time_s"][rows][0]), force_N[rows], te_um[rows],
                             rate_mm_per_s[rows], flank])
    np.savetxt(f"{folder}/signal.dat", table, "%.8g")
    values = {**titles(result, f"{SIGNAL_CYCLES} mesh cycles at {tracks.frames.speed_rpm[frame]:.5g} rpm, "
                               f"from {columns['time_s'][rows][0]:.5g} s on"), "time_high": float(table[-1, 0])}
    for name, column in (("force", 1), ("te", 2), ("rate", 3)):
        values[f"{name}_low"], values[f"{name}_high"] = padded(table[:, column])
    values["share_text"] = (f"in these cycles {100 * np.mean(flank == 0):.3g} % without contact, "
                            f"{100 * np.mean(flank == 2):.3g} % on coast flanks")
    return "plot_signal.gp", values


def one_turn(result, folder, speed_rpm=None):
    """Force and transmission error over one turn of the pinion."""
    frame = result.frame_at(speed_rpm)
    tracks, columns = result.tracks(), result.columns
    turn = tracks.run.angle_rad / (2.0 * np.pi)
    row = int(tracks.frames.row[frame])
    first, last = np.searchsorted(turn, (turn[row] - 0.5, turn[row] + 0.5))
    rows = slice(int(first), int(max(last, first + 2)))
    teeth = (turn[rows] - turn[rows][0]) * result.gears.pinion_teeth
    table = np.column_stack([teeth, columns["contact_force_N"][rows], columns[summary.TE_COLUMN][rows]])
    np.savetxt(f"{folder}/turn.dat", table, "%.8g")
    values = {**titles(result, f"one turn of the pinion at {tracks.frames.speed_rpm[frame]:.5g} rpm"),
              "teeth": result.gears.pinion_teeth}
    for name, column in (("force", 1), ("te", 2)):
        values[f"{name}_low"], values[f"{name}_high"] = padded(table[:, column])
    return "plot_turn.gp", values


def spectrum(result, folder, speed_rpm=None, edge_harmonics=HARMONICS):
    """Spectrum of the force at one speed, its lines by name."""
    tracks, gears = result.tracks(), result.gears
    frame = result.frame_at(speed_rpm)
    row = tracks.frames.row[frame]
    turns = tracking.fitting_turns(tracks.run)
    if tracking.whole_turns(tracks.run) > 2 * SPECTRUM_TURNS:
        turns = min(SPECTRUM_TURNS, 4 * turns)
    frames = tracking.frames_of(tracks.run, turns)
    nearest = int(np.argmin(np.abs(frames.row - row)))
    one = tracking.Frames(tracks.run, frames.turns, *(values[nearest : nearest + 1] for values in (
        frames.start, frames.row, frames.lowest_rpm, frames.highest_rpm)))
    hertz = float(one.speed_rpm[0]) / 60.0
    edge = min(1.1 * edge_harmonics * gears.pinion_teeth, tracks.run.trusted_Hz / hertz)
    order, power = tracking.spectra(one, tracks.over_angle, edge)
    amplitude = np.sqrt(power[0])
    good = np.isfinite(amplitude) & (order > 0)
    np.savetxt(f"{folder}/spectrum.dat", np.column_stack([order * hertz, amplitude])[good], "%.8g")
    high = 10.0 ** math.ceil(math.log10(max(amplitude[good].max(), 1e-12)) + 1e-9)
    known = lines.of_gears(gears, edge_harmonics, 5)
    swept = one.highest_rpm[0] - one.lowest_rpm[0]
    return "plot_spectrum.gp", {
        **titles(result, f"{one.turns:g} turns about {60 * hertz:.5g} rpm" + (f", {swept:.3g} rpm wide" if swept > 1 else "")),
        "edge": edge * hertz, "low": high * 1e-5, "high": high,
        "eigenfrequency": gears.eigenfrequency_Hz or 0.0, **lines.rim_values(known, [], edge, hertz),
    }


# ----------------------------------------------------------------------------------------------------
# Several runs
# ----------------------------------------------------------------------------------------------------


def comparison(found, folder):
    """Tooth orders of several runs over the speed, a panel for each order."""
    tracks = [result.tracks() for result in found]
    values = {"title_text": "Comparison of runs", "curves": len(found), "panels": HARMONICS}
    for i, (result, track) in enumerate(zip(found, tracks)):
        np.savetxt(f"{folder}/run_{i}.dat", np.column_stack([track.frames.speed_rpm, *track.amplitude]), "%.8g")
        values[f"label_{i}"] = result.title
    same = len({result.gears.pinion_teeth for result in found}) == 1
    for k in range(HARMONICS):
        order = (k + 1) * found[0].gears.pinion_teeth
        values[f"panel_{k}"] = f"order {order}, mesh {k + 1}" if same else f"mesh {k + 1}"
        heights = np.concatenate([track.amplitude[k] for track in tracks])
        heights = heights[np.isfinite(heights) & (heights > 0)]
        top = 10.0 ** (math.ceil(2 * math.log10(heights.max()) - 1e-9) / 2) if len(heights) else 1.0
        values[f"high_{k}"] = top
        values[f"low_{k}"] = max(1e-3 * top, 10.0 ** (math.floor(2 * math.log10(np.percentile(heights, 5))) / 2)) \
            if len(heights) else 1e-3
        values[f"low_{k}"] = min(values[f"low_{k}"], values[f"high_{k}"] / 10)
    speeds = np.concatenate([track.frames.speed_rpm for track in tracks])
    values["speed_low"], values["speed_high"] = float(speeds.min()), float(speeds.max())
    if values["speed_high"] - values["speed_low"] < 1e-3 * values["speed_high"]:
        values["speed_low"], values["speed_high"] = padded(speeds)
    return "plot_compare.gp", values


def difference(found, folder):
    """Order map of the second run over that of the first one, in dB."""
    first, second = found
    tracks = [result.tracks() for result in found]
    if first.gears.pinion_teeth != second.gears.pinion_teeth:
        raise program.InputError(f"{first.path}, {second.path}: the pinions must have the same number of teeth")
    low = max(track.frames.speed_rpm.min() for track in tracks)
    high = min(track.frames.speed_rpm.max() for track in tracks)
    if high < low:
        raise program.InputError(f"{first.path}, {second.path}: the runs have no speed in common")

    # Both maps over the same orders and speeds.
    turns = min(tracking.fitting_turns(track.run) for track in tracks)
    edge = 1.1 * HARMONICS * first.gears.pinion_teeth
    edge = min([edge, *(60.0 * track.run.trusted_Hz / low for track in tracks)])
    maps = []
    for track in tracks:
        frames = tracking.frames_of(track.run, turns)
        order, power = tracking.spectra(frames, track.over_angle, edge)
        maps.append(tracking.order_map(frames, order, power, False, 200, (low, high)))
    rows = min(len(one.row) for one in maps)
    step, shown = 0.0, []
    for one in maps:
        step, pooled = tracking.pooled(one.order, one.power)
        shown.append(pooled[np.linspace(0, len(pooled) - 1, rows).astype(int)])
    floor = FLOOR_SHARE * max(np.nanmax(power) for power in shown)
    level_dB = 10.0 * np.log10((shown[1] + floor) / (shown[0] + floor))
    level_dB.astype("<f4").tofile(f"{folder}/difference.bin")
    reach = np.nanpercentile(np.abs(level_dB), 99.9)
    known = lines.of_gears(first.gears, HARMONICS, 5)
    return "plot_difference.gp", {
        "title_text": f"{second.title} over {first.title}", "edge": edge, "order_step": float(step),
        "subtitle_text": f"{first.gears_text}; what is {-10 * math.log10(FLOOR_SHARE):.0f} dB below the loudest counts as equal",
        "columns": int(level_dB.shape[1]), "rows": int(level_dB.shape[0]), "row_low": maps[0].row_range[0],
        "row_high": maps[0].row_range[1], "reach": float(max(1.0, math.ceil(reach))), **lines.rim_values(known, [], edge),
    }


# ----------------------------------------------------------------------------------------------------
# All of them
# ----------------------------------------------------------------------------------------------------


def of_run(result, folder, at_rpm=None):
    """{name: (file of gnuplot, variables)} of one run: all that it has."""
    if result.is_static:
        found = {"_static": static_curves(result, folder), "_harmonics": static_harmonics(result, folder)}
        return {name: picture for name, picture in found.items() if picture}
    found = {"_spectrum": spectrum(result, folder, at_rpm)}
    if "dte_um" in result.columns:
        found["_signal"] = time_signal(result, folder, at_rpm)
        found["_turn"] = one_turn(result, folder, at_rpm)
    else:
        program.warn(f"{result.path}: no column dte_um: no pictures of the transmission error")
    return found


def of_several(found, folder):
    """The same of several runs."""
    made = {"_compare": comparison(found, folder)}
    if len(found) == 2 and not any(result.tracks().run.is_constant for result in found):
        made["_difference"] = difference(found, folder)
    return made
