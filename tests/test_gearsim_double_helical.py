#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Double-helical pairs through gearsim, against a second model in numpy that sums over stations of the face.

    test_gearsim_double_helical.py GEARSIM

The second model knows nothing of a mirror: it writes down where the teeth of both halves stand, and lets the pinion slide
along its axis until both carry the same. Random pairs of both hands, with unequal faces, flanks and pitch of each half, axes
that have moved, friction, and loads on either side.
"""
import math
import os
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "scripts"))

import program  # noqa: E402

program.require("numpy")

import numpy as np  # noqa: E402

GEARSIM = ""
PAIRS, STATIONS = 40, 500
DRIVE, COAST = 0, 1
ROLES = ("pinion", "wheel")


def involute(angle):
    return np.tan(angle) - angle


class Gears:
    """What the drawing gives (m, rad), from its keys."""

    def __init__(self, keys, dx, dy):
        module = 1e-3 * keys["normal_module_mm"]
        normal, helix = np.radians([keys["normal_pressure_angle_deg"], abs(keys["helix_angle_deg"])])
        self.teeth = np.array([keys["pinion_teeth"], keys["wheel_teeth"]])
        transverse = math.atan(math.tan(normal) / math.cos(helix))
        reference = module * self.teeth / (2 * math.cos(helix))
        self.base = reference * math.cos(transverse)
        self.tan_helix = math.tan(helix) * math.cos(transverse)
        self.hand = np.sign(keys["helix_angle_deg"])
        self.pitch = 2 * math.pi * self.base[0] / self.teeth[0]

        # Teeth of equal shifts that would have no backlash, thinned equally to what they have.
        distance = 1e-3 * keys["center_distance_mm"]
        angle = math.acos(self.base.sum() / distance)
        shift = self.teeth.sum() * (involute(angle) - involute(transverse)) / (4 * math.tan(normal))
        thickness = np.full(2, module * (math.pi / 2 + 2 * shift * math.tan(normal)))
        thickness -= 1e-6 * keys["backlash_um"] * math.cos(helix) / (self.base / reference).sum()
        self.half_thickness = thickness / math.cos(helix) / (2 * reference) + involute(transverse)
        alteration = min(0.0, (distance - reference.sum()) / module - 2 * shift)
        self.tip = np.sqrt((reference + module * (1 + shift + alteration)) ** 2 - self.base ** 2)
        self.start = np.maximum(0, distance * math.sin(angle) - self.tip[::-1])
        self.faces = 1e-3 * np.array([keys[f"{role}_face_width_mm"] - keys["double_helical_gap_mm"] for role in ROLES]) / 2

        # Where the axes are.
        self.direction = math.atan2(dy, distance + dx)
        self.angle = math.acos(self.base.sum() / math.hypot(distance + dx, dy))
        self.length = math.hypot(distance + dx, dy) * math.sin(self.angle)


class Pair:
    """Gears, flanks of both halves and friction; stiffness is that of both halves together."""

    def __init__(self, gears, stiffness, tables, pitch, friction, speed):
        self.gears, self.stiffness, self.tables, self.pitch = gears, stiffness, tables, pitch
        self.friction, self.speed = friction, speed

    def side(self, half, side, phi, x):
        """Overlap, touching part and torque of friction on the wheel per K, of one side of a half at x (m, 1, m2)."""
        g, sign = self.gears, 1 if side == DRIVE else -1
        width = g.faces.min()
        step = width / STATIONS
        along = g.faces[0] - width + (np.arange(STATIONS) + 0.5) * step  # from the pinion's outer face; all end at the gap
        phi_w = (g.base[0] * phi - x) / g.base[1]
        first = g.base[0] * (g.angle + g.half_thickness[0] + sign * (phi - g.direction))
        reach = np.ceil((g.length + g.tan_helix * g.faces.max()) / g.pitch) + 2
        number = sign * (np.arange(-reach, reach + 1) - np.floor(first / g.pitch))[:, None].astype(int)
        mate = number if side == DRIVE else number - 1

        twist = sign * g.hand * g.tan_helix * along
        rho = np.array([
            g.base[0] * (g.angle + g.half_thickness[0] + sign * (phi - g.direction + number * 2 * math.pi / g.teeth[0])) + twist,
            g.base[1] * (g.angle + g.half_thickness[1]
                         - sign * (phi_w + g.direction + (2 * mate + 1) * math.pi / g.teeth[1])) - twist])
        overlap = rho.sum(axis=0) - g.length

        # Each line ends at both tips, a part of a station there; a tip may reach deeper than a table, whose end goes on there.
        weight = np.full(overlap.shape, step / width)
        for gear in (0, 1):
            from_outer = along - g.faces[0] + g.faces[gear]
            share = (rho[gear] - g.start[gear]) / (g.tip[gear] - g.start[gear])
            weight *= np.clip((g.tip[gear] - rho[gear]) / (g.tan_helix * step) + 0.5, 0, 1)
            table = self.tables.get((gear, half, side))
            if table is not None:
                overlap = overlap + math.hypot(1, g.tan_helix) * bilinear(table, from_outer / g.faces[gear], share)
            pitch = self.pitch.get((gear, half, side))
            if pitch is not None:
                overlap = overlap + pitch[(number if gear == 0 else mate) % g.teeth[gear]]

        pressed = weight * np.maximum(0, overlap)
        slides = self.speed * (rho[0] - g.teeth[0] / g.teeth[1] * (g.length - rho[0]))
        rubs = self.friction * slides / np.hypot(slides, 0.01) * math.hypot(1, g.tan_helix)
        return np.array([pressed.sum(), (weight * (overlap > 0)).sum(), (pressed * rubs * (g.length - rho[0])).sum()])

    def half(self, half, phi, x):
        """Net overlap, touching part of both sides, torque of friction, which goes by where flanks slide alone."""
        drive, coast = (self.side(half, side, phi, x) for side in (DRIVE, COAST))
        return drive[0] - coast[0], drive[1] + coast[1], drive[2] + coast[2]

    def x_of(self, half, phi, wanted):
        """x at which a half has this net overlap: it grows with x, and the touching part is its slope."""
        low, high = -0.45 * self.gears.pitch, 0.45 * self.gears.pitch
        x = 0.0
        for _ in range(200):
            overlap, slope, friction = self.half(half, phi, x)
            low, high = (x, high) if overlap < wanted else (low, x)
            if abs(overlap - wanted) < 1e-9 * abs(wanted):
                break
            following = x - (overlap - wanted) / slope if slope > 0 else math.nan
            x = following if low < following < high else 0.5 * (low + high)
        return x, slope, friction

    def equilibrium(self, phi, torque):
        """x, float of the pinion along +z and touching part, mean of both halves, under a torque on the wheel."""
        wanted = torque / (self.stiffness * self.gears.base[1])  # of each half, which has half of the stiffness
        for _ in range(50):
            first, second = (self.x_of(half, phi, wanted) for half in (0, 1))
            carried = self.stiffness * (self.gears.base[1] * wanted + 0.5 * (first[2] + second[2]))
            if abs(carried - torque) < 1e-8 * abs(torque):
                break
            wanted *= torque / carried

        # The halves stand at x - s tan(beta_b) and x + s tan(beta_b).
        helix = self.gears.hand * self.gears.tan_helix
        return 0.5 * (first[0] + second[0]), (second[0] - first[0]) / (2 * helix), 0.5 * (first[1] + second[1])


def bilinear(table, t1, t2):
    rows, columns = table.shape
    t1, t2 = np.broadcast_arrays(np.clip(t1, 0, 1) * (rows - 1), np.clip(t2, 0, 1) * (columns - 1))
    i, k = np.minimum(t1.astype(int), rows - 2), np.minimum(t2.astype(int), columns - 2)
    u, v = t1 - i, t2 - k
    return (table[i, k] * (1 - u) * (1 - v) + table[i + 1, k] * u * (1 - v) + table[i, k + 1] * (1 - u) * v
            + table[i + 1, k + 1] * u * v)


class TestDoubleHelical(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, name, lines):
        path = os.path.join(self.folder.name, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
        return path

    def flanks(self, rng, teeth):
        """Files of tables and pitch, of every half or of the first alone, and the same for the second model (m)."""
        settings, tables, pitch = {}, {}, {}
        for gear, role in enumerate(ROLES):
            for half, key in enumerate((f"flanks.{role}", f"flanks.{role}_second_half")):
                halves = (0, 1) if half == 0 else (1,)  # what the second half has no file for is as in the first
                if rng.random() < 0.6:
                    values = np.round(rng.normal(0, 3, (2, 4, 3)), 2)
                    rows = [f"*,{side},{i / 3:.7f},{k / 2:.7f},{values[number, i, k]}"
                            for number, side in enumerate(("drive", "coast")) for i in range(4) for k in range(3)]
                    settings[key] = self.file(f"{key}.csv", ["tooth,flank,t1,t2,deviation_um", *rows])
                    tables |= {(gear, of, side): 1e-6 * values[side] for of in halves for side in (DRIVE, COAST)}
                if rng.random() < 0.6:
                    values = np.round(rng.normal(0, 4, (2, teeth[gear])), 2)
                    rows = [f"{tooth},{side},{values[number, tooth]}"
                            for number, side in enumerate(("drive", "coast")) for tooth in range(teeth[gear])]
                    settings[f"{key}_pitch"] = self.file(f"{key}_pitch.csv", ["tooth,flank,deviation_um", *rows])
                    pitch |= {(gear, of, side): 1e-6 * values[side] for of in halves for side in (DRIVE, COAST)}
        return settings, tables, pitch

    def run_gearsim(self, keys, settings):
        """Rows of a static run, as dicts of numbers."""
        path = self.file("pair.ini", ["[gears]", *(f"{key} = {value}" for key, value in keys.items())])
        sets = [f"--set={key}={value}" for key, value in settings.items()]
        run = subprocess.run([GEARSIM, path, "--quiet", "--output", "-", *sets], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        head, *rows = [line.split(",") for line in run.stdout.splitlines() if line[:1] != "#"]
        return [dict(zip(head, map(float, row))) for row in rows]

    def test_random_pairs_are_those_of_a_second_model(self):
        floats = 0
        for seed in range(PAIRS):
            rng = np.random.default_rng(seed)
            module, helix = round(rng.uniform(1, 10), 2), round(rng.uniform(8, 38), 2)
            teeth = [int(rng.integers(24, 45)), int(rng.integers(45, 110))]
            width, gap = rng.uniform(3, 12) * module, round(rng.uniform(0, 5) * module, 2)
            distance = module * sum(teeth) / (2 * math.cos(math.radians(helix))) + rng.uniform(-0.1, 0.6) * module
            keys = {"pinion_teeth": teeth[0], "wheel_teeth": teeth[1], "normal_module_mm": module,
                    "normal_pressure_angle_deg": rng.choice([17.5, 20, 22.5]), "helix_angle_deg": helix * rng.choice([-1, 1]),
                    "center_distance_mm": round(distance, 3), "backlash_um": round(rng.uniform(20, 60) * module, 1),
                    "double_helical_gap_mm": gap, "pinion_face_width_mm": round(2 * width + gap, 2),
                    "wheel_face_width_mm": round(2 * width * rng.uniform(0.8, 1.25) + gap, 2)}
            dx, dy = np.round(rng.uniform(-40, 60, 2), 1) if seed % 2 else (0.0, 0.0)
            gears = Gears(keys, 1e-6 * dx, 1e-6 * dy)
            stiffness = round(14e9 * gears.faces.min() * 2, -3)
            torque = round(stiffness * gears.base[1] * rng.uniform(3e-6, 20e-6) * rng.choice([1, 1, -1]), 3)
            files, tables, pitch = self.flanks(rng, teeth)
            settings = {**files, "mesh.stiffness_N_per_m": stiffness, "load.mean_Nm": torque, "analysis.type": "static",
                        "analysis.positions": 2, "pose.center_distance_change_um": dx, "pose.offset_um": dy,
                        "output.digits": 15}
            speed = friction = 0.0
            if seed % 3 == 0:
                speed, friction = 100.0, 0.07
                settings |= {"mesh.friction_coefficient": friction, "drive.start_rpm": repr(speed * 30 / math.pi)}

            # Stations leave some 1e-3 of the deflection, and so does what the float moves at the ends of lines.
            pair = Pair(gears, stiffness, tables, pitch, friction, speed)
            deflection_um = 1e6 * abs(torque) / (gears.base[1] * stiffness)
            for row in self.run_gearsim(keys, settings):
                x, floated, touching = pair.equilibrium(row["pinion_angle_rad"], torque)
                with self.subTest(seed=seed, angle=row["pinion_angle_rad"]):
                    self.assertAlmostEqual(-row["te_um"], 1e6 * x, delta=2e-3 * deflection_um)
                    self.assertAlmostEqual(row["apex_shift_um"] * gears.tan_helix, 1e6 * floated * gears.tan_helix,
                                           delta=2e-3 * deflection_um)
                    self.assertAlmostEqual(1e6 * row["mesh_stiffness_N_per_um"], stiffness * touching, delta=6e-3 * stiffness)
                floats += abs(floated) > 1e-7
        self.assertGreater(floats, PAIRS)


if __name__ == "__main__":
    GEARSIM = sys.argv.pop(1)
    unittest.main()
