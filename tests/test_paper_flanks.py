#!/usr/bin/python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""The flank files of data/paper/ are those that scripts/make_paper_flanks makes, and follow the format."""
import os
import re
import subprocess
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir)
DATA = os.path.join(ROOT, "data", "paper")
SCRIPT = os.path.join(ROOT, "scripts", "make_paper_flanks")
FILES = ("pinion_flanks.csv", "wheel_flanks.csv", "pinion_pitch.csv", "wheel_pitch.csv")
TEETH = {"pinion": 45, "wheel": 41}


def contents(folder, name):
    with open(os.path.join(folder, name), "rb") as file:
        return file.read()


def rows(name):
    """Cells of the rows of a file behind its `#` lines and its header line."""
    lines = contents(DATA, name).decode("ascii").splitlines()
    return [line.split(",") for line in lines if not line.startswith("#")][1:]


class MadeAgain(unittest.TestCase):
    def test_seed_of_the_head_gives_the_same_bytes(self):
        seeds = re.findall(rb"--seed (\d+)", b"".join(contents(DATA, name) for name in FILES))
        self.assertEqual(len(seeds), len(FILES))
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([SCRIPT, "--output", folder, "--seed", seeds[0].decode()], check=True)
            for name in FILES:
                self.assertTrue(contents(folder, name) == contents(DATA, name), name + " differs")

    def test_another_seed_gives_other_flanks(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([SCRIPT, "--output", folder, "--seed", "2"], check=True)
            for name in FILES:
                self.assertFalse(contents(folder, name) == contents(DATA, name), name)

    def test_missing_folder_is_said(self):
        result = subprocess.run([SCRIPT, "--output", "no/such/folder"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn("no/such/folder", result.stderr)


class Format(unittest.TestCase):
    def test_every_flank_has_a_full_grid(self):
        for gear, teeth in TEETH.items():
            nodes = {}
            for tooth, flank, t1, t2, _ in rows(gear + "_flanks.csv"):
                nodes.setdefault((int(tooth), flank), set()).add((t1, t2))
            self.assertEqual(set(nodes), {(i, f) for i in range(teeth) for f in ("drive", "coast")})
            for grid in nodes.values():
                self.assertEqual(len(grid), 21 * 31)
                self.assertEqual(grid, nodes[(0, "drive")])

    def test_every_tooth_differs(self):
        for gear, teeth in TEETH.items():
            forms = {}
            for tooth, flank, _, _, deviation in rows(gear + "_flanks.csv"):
                forms.setdefault((tooth, flank), []).append(deviation)
            self.assertEqual(len({tuple(form) for form in forms.values()}), 2 * teeth)

    def test_deviations_are_rounded_to_a_nanometre(self):
        for name in FILES:
            for row in rows(name):
                self.assertRegex(row[-1], r"^(?!-0\.000$)-?\d+\.\d{3}$")

    def test_displaced_tooth_lacks_on_one_side_what_it_adds_on_the_other(self):
        for gear, teeth in TEETH.items():
            pitch_um = {(int(tooth), flank): float(value) for tooth, flank, value in rows(gear + "_pitch.csv")}
            self.assertEqual(len(pitch_um), 2 * teeth)
            for tooth in range(teeth):
                self.assertEqual(pitch_um[tooth, "coast"], -pitch_um[tooth, "drive"])
            # The run-out is 16 um; single errors of 1 um blur it.
            drive_um = [pitch_um[tooth, "drive"] for tooth in range(teeth)]
            self.assertAlmostEqual(max(drive_um) - min(drive_um), 16.0, delta=4.0)


if __name__ == "__main__":
    unittest.main()
