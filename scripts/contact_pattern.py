# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""The contact pattern of a gear pair: loads along the lines of contact as gearsim wrote them, as maps of both flanks."""
import math
import os
import tempfile

import numpy as np

import loaded_te
import program
import results

COLUMNS = ("pinion_angle_rad", "load_torque_Nm", "pair", "z_mm", "pinion_roll_length_mm", "wheel_roll_length_mm",
           "line_load_N_per_mm", "pressure_N_per_mm2", "gap_um")
QUANTITIES = (("line load", "line_load_N_per_mm", "N/mm"), ("pressure", "pressure_N_per_mm2", "N/mm²"))
NODES = 300  # of a map, along each edge
EDGE = 0.02  # of the active flank, at either end: where tip edges press
STANDS_OUT = 1.5  # times what the flank carries elsewhere: the colours are those of elsewhere
SHOWN_POSITIONS = 6


# ----------------------------------------------------------------------------------------------------
# What is loaded, and how much
# ----------------------------------------------------------------------------------------------------


class Loads:
    """Rows of one load on one flank, by column, and the gears that they are of."""

    def __init__(self, path, listing_of):
        columns, head, incomplete = results.read_columns(path, self._wanted)
        results.check_numbers(path, columns)
        if incomplete:
            raise results.RunError(f"{path}: must be whole (it ended early: {incomplete})")
        if not columns["line_load_N_per_mm"].any():
            raise results.RunError(f"{path}: must have a load (nothing touches)")
        self.path, self.head, self.geometry = path, head, listing_of(head)

        # One load and one flank of it.
        torque_Nm = columns["load_torque_Nm"]
        self.torque_Nm = float(torque_Nm[np.argmax(np.abs(torque_Nm))])
        flanks = self._flanks(path)
        loaded = {flank: columns["line_load_N_per_mm"][(flanks == flank) & (torque_Nm == self.torque_Nm)].sum()
                  for flank in ("drive", "coast")}
        self.flank = max(loaded, key=loaded.get)
        self.other_carries = min(loaded.values()) > 0
        chosen = (flanks == self.flank) & (torque_Nm == self.torque_Nm)
        self.columns = {name: column[chosen] for name, column in columns.items()}
        self.columns["overlap_um"] = -self.columns.pop("gap_um")  # > 0 where flanks press
        self.cycles = self.columns["pinion_angle_rad"] * int(head["gears.pinion_teeth"]) / (2 * math.pi)
        self.stations_mm = np.unique(self.columns["z_mm"])
        if len(self.stations_mm) < 2:
            raise results.RunError(f"{path}: z_mm: must have two stations or more")

    @staticmethod
    def _wanted(path, names):
        missing = [name for name in (*COLUMNS, "flank") if name not in names]
        if missing:
            raise results.RunError(f"{path}: must be a load distribution of gearsim or a parameter file "
                                   f"(it has no column {', '.join(missing)})")
        return COLUMNS

    @staticmethod
    def _flanks(path):
        _, names, head_lines = results.read_head(path)
        return np.loadtxt(path, str, delimiter=",", skiprows=head_lines, usecols=names.index("flank"), ndmin=1)

    def step_mm(self):
        """How far a line of contact moves along the line of action from one position to the next."""
        steps_rad = np.diff(np.unique(self.columns["pinion_angle_rad"]))
        path_mm = self.geometry["path_end_mm"] - self.geometry["path_start_mm"]
        return self.geometry["pinion_base_radius_mm"] * np.median(steps_rad) if len(steps_rad) else path_mm

    def largest(self, name):
        """At each station the pinion's roll lengths, and the largest value of all teeth that pass there.

        A part of the path as long as a step has one row of each tooth.
        """
        rho_mm, values = self.columns["pinion_roll_length_mm"], self.columns[name]
        part = np.floor((rho_mm - self.geometry["path_start_mm"]) / self.step_mm() + 1e-6)
        found = []
        for z_mm in self.stations_mm:
            rows = np.flatnonzero(self.columns["z_mm"] == z_mm)
            rows = rows[np.lexsort((values[rows], part[rows]))]
            last = np.append(np.diff(part[rows]) > 0, True)
            rows = rows[last]
            rows = rows[np.argsort(rho_mm[rows])]
            found.append((rho_mm[rows], values[rows]))
        return found


class Flank:
    """The flank of one gear, from root to tip, and the part of it that lines of contact pass."""

    def __init__(self, gear, loads):
        listed = loads.geometry
        self.gear, self.base_mm = gear, listed[f"{gear}_base_radius_mm"]
        self.root_mm, self.tip_mm = (2 * listed[f"{gear}_{end}_radius_mm"] for end in ("root", "tip"))

        # rho_w = sum - rho_p of external gears, rho_w = difference + rho_p of a pinion in a ring.
        is_wheel = gear == "wheel"
        self.sign = 1 if not is_wheel or int(loads.head["gears.wheel_teeth"]) < 0 else -1
        pinion_mm = loads.columns["pinion_roll_length_mm"]
        self.offset_mm = float(np.median(loads.columns[f"{gear}_roll_length_mm"] - self.sign * pinion_mm))
        ends_mm = [self.diameter_mm(listed[f"path_{end}_mm"]) for end in ("start", "end")]
        self.active_mm = np.linspace(min(ends_mm), max(ends_mm), NODES)

    def diameter_mm(self, pinion_roll_length_mm):
        """Where a point of the pinion's path touches this gear."""
        return 2 * np.hypot(self.base_mm, self.sign * pinion_roll_length_mm + self.offset_mm)

    def pinion_roll_length_mm(self, diameter_mm):
        rho_mm = np.sqrt(np.maximum(diameter_mm**2 / 4 - self.base_mm**2, 0))
        return self.sign * (rho_mm - self.offset_mm)

    def map(self, largest, stations_mm):
        """Values on an even grid [diameter, z] of the active flank."""
        rho_mm = self.pinion_roll_length_mm(self.active_mm)
        at_stations = np.array([np.interp(rho_mm, *station) for station in largest])
        even_mm = np.linspace(stations_mm[0], stations_mm[-1], NODES)
        return np.array([np.interp(even_mm, stations_mm, row) for row in at_stations.T])


def has_loads(path):
    """Whether a result is a load distribution, not a run."""
    if not os.path.isfile(path) or results.is_hdf5(path):
        return False
    return "line_load_N_per_mm" in results.read_head(path)[1]


def is_distribution(path):
    """A CSV of whatever columns, as a parameter file has a section before anything else."""
    with open(path, encoding="utf-8", errors="replace") as file:
        first = next((line for line in file if line.strip() and line.strip()[0] not in "#;\ufeff"), "")
    return "," in first and not first.lstrip().startswith("[")


def geometry_of(gearsim, head):
    """What follows from the gears of a head."""
    with tempfile.TemporaryDirectory(prefix="gearmesh_") as folder:
        return loaded_te.listing(loaded_te.call(gearsim, loaded_te.write_gears(folder, head), {}, "--geometry"))


# ----------------------------------------------------------------------------------------------------
# Numbers
# ----------------------------------------------------------------------------------------------------


class Pattern:
    """Loads over the flanks of both gears."""

    def __init__(self, loads):
        self.loads = loads
        self.flanks = [Flank(gear, loads) for gear in loaded_te.GEARS]
        named = {"overlap": "overlap_um", **{name: column for name, column, _ in QUANTITIES}}
        largest = {name: loads.largest(column) for name, column in named.items()}
        self.maps = {(flank.gear, name): flank.map(largest[name], loads.stations_mm)
                     for flank in self.flanks for name in largest}

    def words(self):
        """Lines of text: what was loaded, the largest values with their places, and what touches."""
        loads, columns = self.loads, self.loads.columns
        yield (f"{loads.path}: {loads.flank} flanks at {loads.torque_Nm:.6g} N m on the wheel, "
               f"{len(np.unique(columns['pinion_angle_rad']))} positions, {len(loads.stations_mm)} stations")
        for name, column, unit in QUANTITIES:
            row = int(np.argmax(columns[column]))
            rho_mm = columns["pinion_roll_length_mm"][row]
            places = ", ".join(f"{flank.gear} diameter {flank.diameter_mm(rho_mm):.5g} mm" for flank in self.flanks)
            yield (f"  largest {name:9} {columns[column][row]:8.5g} {unit.replace('²', '2')} at z = "
                   f"{columns['z_mm'][row]:.4g} mm, {places}")
            elsewhere, at_edges = largest_by_place(self.maps, self.flanks, name)
            if at_edges > STANDS_OUT * elsewhere:
                yield f"                    {elsewhere:8.5g} {unit.replace('²', '2')} away from the tip edges"
        share = np.mean(self.maps["pinion", "overlap"] > 0)
        weight = columns["line_load_N_per_mm"].copy()
        weight[np.isin(columns["z_mm"], loads.stations_mm[[0, -1]])] /= 2  # stations at the ends stand for half as much
        yield (f"  touching {100 * share:.3g} % of the pinion's active flank, mean of the load at z = "
               f"{np.average(columns['z_mm'], weights=weight):.4g} mm")

    def pictures(self, title, folder, cycles=()):
        """{name: (file of gnuplot, variables)}; the data are written into the folder."""
        found = {"_pattern": pattern_values(self.loads, self.flanks, self.maps, folder)}
        if cycles:
            found["_lines"] = lines_values(self.loads, self.flanks[0], cycles, folder)
        common = common_values(self.loads, title)
        return {name: (script, {**common, **values}) for name, (script, values) in found.items()}


# ----------------------------------------------------------------------------------------------------
# Pictures
# ----------------------------------------------------------------------------------------------------


def common_values(loads, title):
    gears = f"gears {loads.head['gears.pinion_teeth']}/{loads.head['gears.wheel_teeth']} teeth"
    return {
        "title_text": title, "z_low": float(loads.stations_mm[0]), "z_high": float(loads.stations_mm[-1]),
        "subtitle_text": f"{gears}; {loads.flank} flanks at {loads.torque_Nm:.6g} N m on the wheel",
    }


def whole_steps(top, step):
    return step * math.ceil(top / step - 1e-9)


def largest_by_place(maps, flanks, name):
    """The largest value away from the ends of the active flank, and that at them, where tip edges press."""
    rows = round(EDGE * NODES)
    drawn = [maps[flank.gear, name] for flank in flanks]
    return max(part[rows:-rows].max() for part in drawn), max(max(part[:rows].max(), part[-rows:].max()) for part in drawn)


def four_digits(value):
    """A number above 0 as people write it: with four digits, and all of those before the point."""
    return f"{value:.0f}" if value >= 1000 else f"{value:.4g}"


def pattern_values(loads, flanks, maps, folder):
    """Maps of both gears, without colour where nothing touches; its edge is where the overlap of the flanks ends."""
    values = {"nodes": NODES}
    for k, (name, _, unit) in enumerate(QUANTITIES):
        # Tip edges that press harder by far would leave one colour for the rest: they have the last one, and are told.
        elsewhere, at_edges = largest_by_place(maps, flanks, name)
        stands_out = at_edges > STANDS_OUT * elsewhere > 0
        top = elsewhere if stands_out else max(elsewhere, at_edges)
        step = loaded_te.round_step(top, 8)
        values |= {f"name_{k}": name, f"unit_{k}": unit, f"step_{k}": step, f"top_{k}": whole_steps(top, step),
                   f"note_{k}": f"tip edges: up to {four_digits(at_edges)}" if stands_out else ""}
        for i, flank in enumerate(flanks):
            drawn = maps[flank.gear, name]
            drawn.astype("<f4").tofile(f"{folder}/values_{i}_{k}.bin")
            touching = np.where(maps[flank.gear, "overlap"] > 0, drawn, np.nan)
            touching.astype("<f4").tofile(f"{folder}/colours_{i}_{k}.bin")
    for i, flank in enumerate(flanks):
        values |= {f"gear_{i}": flank.gear, f"root_{i}": flank.root_mm, f"tip_{i}": flank.tip_mm,
                   f"low_{i}": float(flank.active_mm[0]), f"high_{i}": float(flank.active_mm[-1])}
    return "pattern_map.gp", values


def shown_positions(loads, text):
    """The positions nearest to those asked for, in mesh cycles, as they are in the file."""
    there = np.unique(loads.cycles)
    step = there[1] - there[0] if len(there) > 1 else 1.0
    last = there[-1] + step
    try:
        asked = [float(word) for word in text.split(",")]
    except ValueError:
        asked = []
    good = all(there[0] <= cycle <= last * (1 + 1e-9) for cycle in asked)
    if not good or not 1 <= len(asked) <= SHOWN_POSITIONS:
        raise program.InputError(f"--positions {text}: must be 1 to {SHOWN_POSITIONS} numbers from 0 to {last:.4g} "
                                 "with commas between")
    return [float(there[np.argmin(np.abs(there - cycle))]) for cycle in asked]


def lines_values(loads, flank, cycles, folder):
    """Lines of contact on a flank at some positions; a block of rows for each."""
    values = {"positions": len(cycles), "root": flank.root_mm, "tip": flank.tip_mm,
              "low": float(flank.active_mm[0]), "high": float(flank.active_mm[-1])}
    blocks, columns = [], loads.columns
    for i, cycle in enumerate(cycles):
        values[f"first_{i}"], values[f"cycle_{i}"] = len(blocks), cycle
        here = loads.cycles == cycle
        for pair in np.unique(columns["pair"][here]):
            rows = np.flatnonzero(here & (columns["pair"] == pair))
            rows = rows[np.argsort(columns["z_mm"][rows])]
            blocks.append((columns["z_mm"][rows], flank.diameter_mm(columns["pinion_roll_length_mm"][rows]),
                           columns["line_load_N_per_mm"][rows]))
            values[f"label_{len(blocks) - 1}"] = f"tooth {int(pair)}"
        values[f"last_{i}"] = len(blocks) - 1
    loaded_te.write_blocks(f"{folder}/lines.dat", blocks)
    top = max(block[2].max() for block in blocks)
    step = loaded_te.round_step(top, 5)
    return "pattern_lines.gp", {**values, "step": step, "top": whole_steps(top, step)}
