# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a run of gearsim says, as numbers with names: for words, for JSON, for a report.

Each number is a dictionary {"value", "unit"}; where there is none, "value" is None and "why" says so.
"""
import math

import numpy as np

import lines
import program
import results
import runup
import tracking

HARMONICS = 4  # of the mesh
NEAR_RESONANCE = 0.2  # share of its speed: what is loudest there is told
STATIC_COLUMNS = ("pinion_angle_rad", "te_um")
TE_COLUMN, LOAD_COLUMN = "dte_um", "load_torque_Nm"
WHOLE_CYCLES = 1e-4  # how near to whole mesh cycles the rows of a static run have to be

# Further columns of a static run: (name, what of them, unit, words).
STATIC_NUMBERS = (
    ("mesh_stiffness_N_per_um", np.mean, "N/µm", "mean mesh stiffness"),
    ("face_load_factor", np.max, "", "face load factor at most"),
    ("largest_pressure_N_per_mm2", np.max, "N/mm²", "pressure at most"),
    ("largest_line_load_N_per_mm", np.max, "N/mm", "line load at most"),
    ("loss_W", np.mean, "W", "mean loss"),
)


def number(value, unit, why=None):
    """A number, or why there is none."""
    if value is None or not math.isfinite(value):
        return {"value": None, "unit": unit, "why": why or "it is not finite"}
    return {"value": float(f"{value:.6g}"), "unit": unit}


def text_of(one, digits=4):
    """`1300 N`, or `no number (why)`."""
    if one["value"] is None:
        return f"no number ({one['why']})"
    return f"{one['value']:.{digits}g} {one['unit']}".strip()


class Options:
    """What lines.gears_of() asks a command line for."""

    pinion_teeth = wheel_teeth = eigenfrequency = None
    on_command_line = False


def read_all(path):
    """All columns of a run, and what its head says."""
    try:
        return results.read_columns(path, lambda _, names: [name for name in names if name])
    except results.RunError:
        raise
    except OSError as error:
        raise results.RunError(f"{path}: cannot be read: {program.first_line_of(error)}") from error


def of_file(path):
    """Summary of a run of either kind."""
    columns, provenance, incomplete = read_all(path)
    results.check_numbers(path, columns)
    return of_columns(path, columns, provenance, incomplete)


def of_columns(path, columns, provenance, incomplete):
    """The same of a run that has been read."""
    found = {"file": path, "gearsim": provenance.get("gearsim", ""), "warnings": warnings_of(provenance, incomplete)}
    gears = lines.gears_of(path, provenance, Options)
    found["gears"] = {"pinion_teeth": gears.pinion_teeth, "wheel_teeth": gears.signed_wheel_teeth,
                      "eigenfrequency": number(gears.eigenfrequency_Hz, "Hz", "the head of the run does not say it")}
    if all(name in columns for name in STATIC_COLUMNS) and "time_s" not in columns:
        return {**found, "kind": "static", "loads": static_loads(columns, provenance, gears)}
    return {**found, "kind": "dynamic", **dynamic(path, columns, provenance, gears)}


def warnings_of(provenance, incomplete):
    found = []
    if incomplete:
        found.append(f"the run ended early ({program.shown(incomplete)})")
    if provenance.get("output.oversampling") == "1":
        found.append("oversampling = 1: what lies above half the rate is folded into what is below")
    return found


# ----------------------------------------------------------------------------------------------------
# Static runs
# ----------------------------------------------------------------------------------------------------


def load_blocks(columns, provenance):
    """Rows of each load: [(load in N m or None, slice)]."""
    rows = len(columns["te_um"])
    if LOAD_COLUMN not in columns:
        mean = provenance.get("load.mean_Nm", "")
        return [(float(mean) if mean else None, slice(0, rows))]
    load_Nm = columns[LOAD_COLUMN]
    edges = np.concatenate([[0], np.flatnonzero(np.diff(load_Nm)) + 1, [rows]])
    return [(float(load_Nm[first]), slice(first, last)) for first, last in zip(edges[:-1], edges[1:])]


def harmonics(angle_rad, values, teeth, count=HARMONICS):
    """Amplitudes of the mesh harmonics 1 .. count of a periodic curve, and why there are none.

    The rows are at even steps, the first one of the next period left out: a discrete Fourier transform is exact.
    """
    if len(values) < 2 * count + 2:
        return None, f"{len(values)} positions are too few"
    cycles = (angle_rad[-1] - angle_rad[0]) * len(values) / (len(values) - 1) * teeth / (2.0 * math.pi)
    whole = round(cycles)
    if whole < 1 or abs(cycles - whole) > WHOLE_CYCLES * whole or len(values) < 2 * (count + 1) * whole:
        return None, "the rows do not hold whole mesh cycles with enough positions in each"
    amplitudes = np.abs(np.fft.rfft(values)) * 2.0 / len(values)
    return [float(amplitudes[k * whole]) for k in range(1, count + 1)], None


def static_loads(columns, provenance, gears):
    found = []
    for load_Nm, rows in load_blocks(columns, provenance):
        te_um = columns["te_um"][rows]
        amplitudes, why = harmonics(columns["pinion_angle_rad"][rows], te_um, gears.pinion_teeth)
        one = {
            "load": number(load_Nm, "N m", "the head of the run does not say it"),
            "te_peak_to_peak": number(np.ptp(te_um), "µm"),
            "te_harmonics": [number(amplitudes and amplitudes[k], "µm", why) for k in range(HARMONICS)],
        }
        for name, what, unit, _ in STATIC_NUMBERS:
            if name in columns:
                one[name] = number(what(columns[name][rows]), unit)
        found.append(one)
    return found


# ----------------------------------------------------------------------------------------------------
# Dynamic runs
# ----------------------------------------------------------------------------------------------------


class NoTracks:
    """There are no tracked orders, and why."""

    def __init__(self, why):
        self.why = why


class Tracks:
    """Tracked tooth orders of a column of a run."""

    def __init__(self, run, orders):
        self.run, self.orders = run, orders
        self.frames = tracking.track_frames(run)
        self.over_angle = tracking.OverAngle(run)
        self.amplitude = tracking.tracked(self.frames, self.over_angle, np.array(orders, dtype=float))
        turn = run.angle_rad / (2.0 * np.pi)
        ends = np.searchsorted(turn, (self.frames.start, self.frames.start + self.frames.turns)).T
        self.peak_to_peak = np.array([np.ptp(run.force_N[first:last]) for first, last in ends])


def tracks_of(path, columns, name, gears):
    """Tracked tooth orders of a column; NoTracks if there are none."""
    missing = [column for column in (*results.COLUMNS[:3], name) if column not in columns]
    if missing:
        return NoTracks(f"the run has no column {', '.join(missing)}")
    try:
        results.check_times(path, "time_s", columns["time_s"])
        run = runup.Run(*(columns[column] for column in (*results.COLUMNS[:3], name)))
        if not run.speed_rpm.any():
            return NoTracks("the pinion stands still")
        return Tracks(run, [k * gears.pinion_teeth for k in range(1, HARMONICS + 1)])
    except results.RunError as error:
        return NoTracks(str(error))


def at_most(values, frames, unit):
    """The largest of some values, and at which speed."""
    if not np.isfinite(values).any():
        return {**number(None, unit, "its frequency is above 0.4 of the rate at all speeds"), "at": None}
    at = int(np.nanargmax(values))
    return {**number(values[at], unit), "at": number(frames.speed_rpm[at], "rpm")}


def order_lines(tracks, unit):
    """The loudest place of each tooth order."""
    if isinstance(tracks, NoTracks):
        return [{"harmonic": k, **number(None, unit, tracks.why)} for k in range(1, HARMONICS + 1)]
    return [{"harmonic": k, "order": order, **at_most(values, tracks.frames, unit)}
            for k, (order, values) in enumerate(zip(tracks.orders, tracks.amplitude), start=1)]


def resonances(tracks, gears, unit):
    """What each tooth order has where it crosses the eigenfrequency."""
    if gears.eigenfrequency_Hz is None:
        return [{"harmonic": k, **number(None, unit, "the head of the run says no eigenfrequency")}
                for k in range(1, HARMONICS + 1)]
    found = []
    for k in range(1, HARMONICS + 1):
        order = k * gears.pinion_teeth
        crossing_rpm = 60.0 * gears.eigenfrequency_Hz / order
        one = {"harmonic": k, "order": order, "crosses_at": number(crossing_rpm, "rpm")}
        if isinstance(tracks, NoTracks):
            found.append({**one, **number(None, unit, tracks.why)})
            continue
        speed_rpm = tracks.frames.speed_rpm
        near = np.abs(speed_rpm / crossing_rpm - 1.0) <= NEAR_RESONANCE
        values = np.where(near, tracks.amplitude[k - 1], np.nan)
        if not speed_rpm.min() <= crossing_rpm <= speed_rpm.max():
            why = f"frames of the run go from {speed_rpm.min():.4g} to {speed_rpm.max():.4g} rpm"
            found.append({**one, **number(None, unit, why)})
        else:
            at = int(np.argmin(np.abs(speed_rpm - crossing_rpm)))
            damping = 100.0 * tracking.least_damping(tracks.run, tracks.frames)[at]
            found.append({**one, **at_most(values, tracks.frames, unit), "shown_in_full_from": number(damping, "% damping")})
    return found


def dynamic(path, columns, provenance, gears):
    """What a run over time says."""
    force = tracks_of(path, columns, "contact_force_N", gears)
    te = tracks_of(path, columns, TE_COLUMN, gears)
    found = {"resonances": resonances(force, gears, "N"), "force_orders": order_lines(force, "N"),
             "te_orders": order_lines(te, "µm")}

    # The speed.
    if "pinion_speed_rpm" in columns and "time_s" in columns:
        speed_rpm = columns["pinion_speed_rpm"]
        found["speed"] = {"first": number(speed_rpm[0], "rpm"), "last": number(speed_rpm[-1], "rpm"),
                          "duration": number(np.ptp(columns["time_s"]), "s")}

    # The force, and whether it is lost.
    if "contact_force_N" in columns:
        force_N = columns["contact_force_N"]
        pairs = columns.get(results.PAIRS_COLUMN)
        lost = np.mean(pairs == 0) if pairs is not None else None
        found["force"] = {
            "mean": number(force_N.mean(), "N"),
            "rms_about_mean": number(force_N.std(), "N"),
            "largest": number(np.abs(force_N).max(), "N"),
            "contact_lost": number(None if lost is None else 100.0 * lost, "%", "the run has no column pairs_in_contact"),
            "other_flank": number(100.0 * np.mean(force_N * np.sign(force_N.mean()) < -1e-3 * np.abs(force_N).max()), "%"),
        }
    else:
        found["force"] = {"mean": number(None, "N", "the run has no column contact_force_N")}

    # The transmission error within some turns.
    found["te_peak_to_peak"] = (number(None, "µm", te.why) if isinstance(te, NoTracks)
                                else at_most(te.peak_to_peak, te.frames, "µm"))
    return found


# ----------------------------------------------------------------------------------------------------
# Words
# ----------------------------------------------------------------------------------------------------


def words(found):
    """The summary as lines of text."""
    yield f"{program.shown(found['file'])}: gears {found['gears']['pinion_teeth']}/{found['gears']['wheel_teeth']} teeth, " \
          f"eigenfrequency {text_of(found['gears']['eigenfrequency'], 5)}"
    for warning in found["warnings"]:
        yield f"warning: {warning}"
    yield from _static_words(found) if found["kind"] == "static" else _dynamic_words(found)


def _harmonic_words(one):
    return f"mesh {one['harmonic']}" if "order" not in one else f"order {one['order']} (mesh {one['harmonic']})"


def _at(one):
    return f" at {text_of(one['at'])}" if one.get("at") else ""


def _swept(one):
    """What the sweep takes from a resonance, if it may take something."""
    damping = one["shown_in_full_from"]["value"]
    told = damping is not None and damping > 1.05 * 100.0 * tracking.RESOLVED_DAMPING
    return f" (too low if its damping is less than {damping:.2g} %: the speed changes fast)" if told else ""


def _static_words(found):
    for one in found["loads"]:
        values = [one_k for one_k in one["te_harmonics"]]
        if values[0]["value"] is None:
            tail = f"its harmonics: {text_of(values[0])}"
        else:
            tail = ", ".join(f"mesh {k} {text_of(value, 3)}" for k, value in enumerate(values, start=1))
        yield f"at {text_of(one['load'])}: TE peak-to-peak {text_of(one['te_peak_to_peak'], 3)}, {tail}"
        more = [f"{text} {text_of(one[name])}" for name, _, _, text in STATIC_NUMBERS if name in one]
        if more:
            yield "  " + ", ".join(more)


def _dynamic_words(found):
    if "speed" in found:
        speed = found["speed"]
        yield f"{text_of(speed['first'], 5)} to {text_of(speed['last'], 5)} in {text_of(speed['duration'])}"
    for one in found["resonances"]:
        if "crosses_at" not in one:
            yield f"resonance of {_harmonic_words(one)}: {text_of(one)}"
        elif one["value"] is None:
            yield f"{_harmonic_words(one)} would cross the resonance at {text_of(one['crosses_at'])}: {text_of(one)}"
        else:
            yield f"{_harmonic_words(one)} crosses the resonance at {text_of(one['crosses_at'])}: {text_of(one)}{_at(one)}" \
                  + _swept(one)
    force = found["force"]
    yield f"mean force {text_of(force['mean'])}"
    if "largest" in force:
        yield f"largest force {text_of(force['largest'])}, rms about the mean {text_of(force['rms_about_mean'])}"
        lost, other = force["contact_lost"], force["other_flank"]
        yield "contact lost " + text_of(lost, 3) + (" of the time" if lost["value"] is not None else "") \
            + f"; force on the other flank {text_of(other, 3)} of the time"
    loudest = [one for one in found["force_orders"] if one["value"] is not None]
    for one in loudest:
        yield f"force of {_harmonic_words(one)}: {text_of(one)} at most,{_at(one)}"
    if not loudest:
        yield f"tooth orders of the force: {text_of(found['force_orders'][0])}"
    te = found["te_peak_to_peak"]
    orders = [f"{_harmonic_words(one)} {text_of(one, 3)}" for one in found["te_orders"] if one["value"] is not None]
    if te["value"] is None:
        yield f"transmission error: {text_of(te)}"
    else:
        yield f"TE peak-to-peak {text_of(te, 3)} at most,{_at(te)}" + (f"; {', '.join(orders)} at most" if orders else "")
