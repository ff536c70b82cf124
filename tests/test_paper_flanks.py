#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
The flank files of data/paper/ are, byte by byte, those that gearflanks makes from data/paper/flanks.ini; and they are
what the formulae in data/paper/README.md say.

    test_paper_flanks.py GEARFLANKS [-v] [name of a test]...
"""
import csv
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

GEARFLANKS = os.environ.get("GEARFLANKS", "gearflanks")
DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "data", "paper")
TEETH = {"pinion": 45, "wheel": 41}
FACE_NODES, PROFILE_NODES = 21, 31


def contents(folder, name):
    with open(os.path.join(folder, name), "rb") as file:
        return file.read()


def rows(name):
    with open(os.path.join(DATA, name), encoding="ascii", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def flanks(gear):
    """Values of each flank: [t1][t2]."""
    tables = {}
    for row in rows(gear + "_flanks.csv"):
        table = tables.setdefault((int(row["tooth"]), row["flank"]), [[] for _ in range(FACE_NODES)])
        table[round(float(row["t1"]) * (FACE_NODES - 1))].append(float(row["deviation_um"]))
    return tables


class MadeAgain(unittest.TestCase):
    def make(self, folder, gear, *more):
        command = [GEARFLANKS, os.path.join(DATA, "fig14.ini"), "--gear", gear, "--scatter",
                   os.path.join(DATA, "flanks.ini"), "--flanks", os.path.join(folder, gear + "_flanks.csv"),
                   "--pitch", os.path.join(folder, gear + "_pitch.csv"), *more]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)

    def test_the_same_bytes(self):
        """But for the version in the first line: a new one need not make new data."""
        with tempfile.TemporaryDirectory() as folder:
            for gear in TEETH:
                self.make(folder, gear)
                for kind in ("flanks", "pitch"):
                    name = f"{gear}_{kind}.csv"
                    made, kept = (
                        re.sub(rb"\A(# Made, not measured: gearflanks )[0-9.]+,", rb"\1", contents(place, name))
                        for place in (folder, DATA)
                    )
                    self.assertTrue(made == kept, name + " differs")
                    self.assertTrue(kept.startswith(b"# Made, not measured: gearflanks  " + gear.encode()))

    def test_another_seed_gives_other_flanks(self):
        with tempfile.TemporaryDirectory() as folder:
            self.make(folder, "wheel", "--seed", "2")
            for name in ("wheel_flanks.csv", "wheel_pitch.csv"):
                made, kept = (contents(place, name).split(b"deviation_um", 1)[1] for place in (folder, DATA))
                self.assertFalse(made == kept, name)


class Recipe(unittest.TestCase):
    """Means over all flanks leave what is the same on all; bounds are 4.5 standard errors."""

    def test_every_flank_has_a_full_grid_of_its_own(self):
        for gear, teeth in TEETH.items():
            tables = flanks(gear)
            self.assertEqual(set(tables), {(i, f) for i in range(teeth) for f in ("drive", "coast")})
            for table in tables.values():
                self.assertEqual([len(line) for line in table], [PROFILE_NODES] * FACE_NODES)
            self.assertEqual(len({str(table) for table in tables.values()}), 2 * teeth)

    def test_mean_flank_has_crownings_and_tip_relief(self):
        tables = [table for gear in TEETH for table in flanks(gear).values()]
        for k1, k2 in ((0, 15), (20, 15), (10, 15), (10, 24), (10, 30), (0, 30), (5, 0)):
            t1, t2 = k1 / (FACE_NODES - 1), k2 / (PROFILE_NODES - 1)
            u, v, tip = 2 * t1 - 1, 2 * t2 - 1, max(0.0, (t2 - 0.8) / 0.2)
            expected = -1.0 * v * v - 3.0 * u * u - 4.0 * tip * tip
            # Slopes of 1 and 2, 0.3 and 0.9 of the crownings, two waves of 0.4 (rms 0.29 each), roughness, foot
            variance = (v / 2) ** 2 + u * u + (0.3 * v * v) ** 2 + (0.9 * u * u) ** 2
            variance += 2 * 0.087 + 0.2**2 + (6 * max(0.0, 1 - t2 / 0.35)) ** 2
            mean = math.fsum(table[k1][k2] for table in tables) / len(tables)
            self.assertAlmostEqual(mean, expected, delta=4.5 * math.sqrt(variance / len(tables)), msg=(t1, t2))

    def test_foot_scatters_by_6_um(self):
        """Seen from where it ends, over which a slope, a crowning and waves change little."""
        feet = [math.fsum(line[0] - line[11] for line in table) / FACE_NODES
                for gear in TEETH for table in flanks(gear).values()]
        mean = math.fsum(feet) / len(feet)
        deviation = math.sqrt(math.fsum((foot - mean) ** 2 for foot in feet) / len(feet))
        self.assertAlmostEqual(deviation, 6.0, delta=4.5 * 6.0 / math.sqrt(2 * len(feet)))

    def test_pitch_is_an_eccentricity_of_8_um_and_errors_of_1_um(self):
        for gear, teeth in TEETH.items():
            for flank in ("drive", "coast"):
                pitch = [float(row["deviation_um"]) for row in rows(gear + "_pitch.csv") if row["flank"] == flank]
                self.assertEqual(len(pitch), teeth)
                angles = [2 * math.pi * i / teeth for i in range(teeth)]
                c = math.fsum(p * math.cos(a) for p, a in zip(pitch, angles)) * 2 / teeth
                s = math.fsum(p * math.sin(a) for p, a in zip(pitch, angles)) * 2 / teeth
                self.assertAlmostEqual(math.hypot(c, s), 8.0, delta=4.5 * math.sqrt(2 / teeth))
                rest = [p - c * math.cos(a) - s * math.sin(a) for p, a in zip(pitch, angles)]
                deviation = math.sqrt(math.fsum(r * r for r in rest) / (teeth - 3))
                self.assertAlmostEqual(deviation, 1.0, delta=4.5 / math.sqrt(2 * teeth))


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        GEARFLANKS = os.path.abspath(sys.argv.pop(1))
    unittest.main()
