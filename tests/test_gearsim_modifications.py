#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
[modifications] of gearsim: keys, refusals, what a result says of them, and the example in data/relief/.

    test_gearsim_modifications.py GEARSIM [-v] [name of a test]...
"""
import os
import re
import sys
import unittest

sys.dont_write_bytecode = True
import test_gearsim_cli  # noqa: E402
from test_gearsim_cli import DEVIATIONS, PARAMS, line_of, with_key  # noqa: E402

RELIEF = os.path.join(os.path.dirname(test_gearsim_cli.EXAMPLE), "..", "relief", "params.ini")
STATIC = ["--set", "analysis.type=static", "--set", "analysis.positions=50"]


def settings(*pairs):
    return [word for pair in pairs for word in ("--set", f"modifications.{pair}")]


class Case(test_gearsim_cli.Case):
    def run_te(self, *arguments, file="run.ini"):
        """(te_um of all rows, head lines)"""
        self.accepted(file, "--quiet", "--output", "te.csv", *arguments)
        lines = self.read("te.csv").splitlines()
        head = [line for line in lines if line.startswith("#")]
        rows = [line.split(",") for line in lines if not line.startswith("#")]
        column = rows[0].index("te_um")
        return [float(row[column]) for row in rows[1:]], head


class Refusals(Case):
    def refused_keys(self, *keys, at, fragments):
        """Keys in the file; the message names the line of the key `at`."""
        params = PARAMS + "[modifications]\n" + "".join(f"{key}\n" for key in keys)
        self.refused(f"run.ini:{line_of(params, at + ' =')}: modifications.{at}: ", *fragments, params=params)

    def test_what_is_no_amount_range_or_shape(self):
        for key, value, *fragments in [["pinion_tip_relief_um", "nan", "must be a number "],
                                       ["wheel_coast_twist_um", "1e400", "must be below 1.8e308"],
                                       ["pinion_tip_relief_um", "-5", "must be >= 0 (got -5)"],
                                       ["wheel_drive_end_relief_II_um", "-1e-9", "must be >= 0"],
                                       ["wheel_tip_corner_I_um", "-1", "must be >= 0"],
                                       ["pinion_tip_relief_length_mm", "-2", "must be > 0"],
                                       ["pinion_tip_relief_length_mm", "0", "must be > 0"],
                                       ["pinion_root_relief_share", "-0.1", "must be > 0"],
                                       ["pinion_root_relief_diameter_mm", "0", "must be > 0"],
                                       ["wheel_root_corner_II_width_mm", "-1", "must be > 0"],
                                       ["pinion_drive_tip_relief_shape", "cubic", "must be linear | parabolic | circular"],
                                       ["wheel_crowning_shape", "linear", "must be parabolic | circular"],
                                       ["tolerance_um", "0", "must be from 1e-05 to 10000"]]:
            with self.subTest(f"{key} = {value}"):
                self.refused_value("modifications", key, value, *fragments)

    def test_smallest_tolerance_is_accepted(self):
        self.write("run.ini", PARAMS)
        self.accepted("run.ini", "--check", *settings("tolerance_um=1e-5", "pinion_tip_relief_um=1",
                                                      "pinion_tip_relief_share=0.3"))

    def test_two_ranges_at_once(self):
        self.refused_keys("pinion_tip_relief_um = 10", "pinion_tip_relief_length_mm = 2", "pinion_tip_relief_share = 0.3",
                          at="pinion_tip_relief_share",
                          fragments=["must not be given beside modifications.pinion_tip_relief_length_mm"])
        self.refused_keys("wheel_coast_root_corner_I_diameter_mm = 78", "wheel_coast_root_corner_I_share = 0.3",
                          at="wheel_coast_root_corner_I_share", fragments=["must not be given beside"])

    def test_range_that_is_missing(self):
        text = self.refused("modifications.pinion_tip_relief_um: must have a range: add modifications.pinion_tip_relief_length_mm",
                            arguments=settings("pinion_tip_relief_um=10"))
        self.assertEqual(text.count("\n"), 1)  # once for both flanks
        self.refused_keys("wheel_coast_end_relief_I_um = 10", at="wheel_coast_end_relief_I_um",
                          fragments=["add modifications.wheel_coast_end_relief_I_length_mm\n"])
        self.refused_keys("wheel_tip_corner_I_um = 10", "wheel_tip_corner_I_share = 0.2", at="wheel_tip_corner_I_um",
                          fragments=["add modifications.wheel_tip_corner_I_width_mm"])
        self.refused_keys("wheel_drive_tip_relief_share = 0.2", "wheel_tip_relief_um = 10", at="wheel_tip_relief_um",
                          fragments=["must have a range"])  # the coast flank lacks it

    def test_range_beyond_the_flank(self):
        for key, values, limit in [("pinion_tip_relief_length_mm", ["13", "99"], "at most the roll length of the active profile, "),
                                   ("pinion_tip_relief_diameter_mm", ["85.5", "93.88"], "from 85.58629"),
                                   ("pinion_tip_relief_share", ["1.001"], "at most 1 "),
                                   ("pinion_end_relief_I_length_mm", ["17.6"], "at most the face width, 17.5 mm")]:
            name = re.sub("_(length_mm|diameter_mm|share)$", "_um", key)
            for value in values:
                with self.subTest(f"{key} = {value}"):
                    self.refused_keys(f"{name} = 10", f"{key} = {value}", at=key,
                                      fragments=[limit, f" (got {value})"])

    def test_amount_beyond_the_flank(self):
        self.refused_keys("pinion_twist_um = -10001", at="pinion_twist_um", fragments=["(got -10001)", "at most 10 mm"])
        self.refused_keys("wheel_tip_relief_um = 510", "wheel_tip_relief_length_mm = 1", "wheel_tip_relief_shape = circular",
                          at="wheel_tip_relief_um", fragments=["at most half of the length"])

    def test_misspelt_keys(self):
        self.refused("unknown key, did you mean pinion_drive_tip_relief_um?",
                     arguments=settings("pinion_drive_tip_releif_um=1"))
        self.refused("unknown key, did you mean wheel_end_relief_II_length_mm?",
                     arguments=settings("wheel_end_relief_II_lenght_mm=1"))
        self.refused("unknown key", arguments=settings("pinion_crowning_length_mm=1"))

    def test_check_finds_them_too(self):
        self.refused("must have a range", arguments=["--check", *settings("pinion_tip_relief_um=10")])


class Notes(Case):
    def setUp(self):
        super().setUp()
        self.write("run.ini", PARAMS)

    def stderr(self, *pairs):
        return self.accepted("run.ini", "--check", *settings(*pairs)).stderr

    def test_help_shows_a_family_of_keys_once(self):
        text = self.accepted("--help").stdout
        part = text[text.index("[modifications]\n"):text.index("[mesh]\n")]
        self.assertLess(part.count("\n"), 30)
        for name in ["*_helix_slope_um", "*_crowning_shape", "*_end_relief_{I,II}_length_mm", "*_{tip,root}_relief_share",
                     "*_{tip,root}_corner_{I,II}_width_mm"]:
            self.assertEqual(part.count(f"  {name} "), 1, name)

    def test_ramps_grid_and_error_are_noted(self):
        relief = ["pinion_drive_tip_relief_um=10", "pinion_drive_tip_relief_share=0.2"]
        start = "run.ini: note: [modifications] of pinion_drive: "
        self.assertEqual(self.stderr(*relief), start + "1 linear relief, exact\n")
        table = re.escape(start) + r"%stable of 2 x %d nodes, off by at most %s um\n$"
        self.assertRegex(self.stderr("pinion_drive_profile_slope_um=5"), "^" + table % ("", 2, r"\S+e-1\d"))
        corner = ["pinion_drive_tip_corner_I_um=20", "pinion_drive_tip_corner_I_width_mm=4", "pinion_drive_tip_corner_I_share=0.3"]
        self.assertRegex(self.stderr(*relief, *corner, "pinion_drive_profile_crowning_um=2"),
                         "^" + table % ("2 linear reliefs, exact; ", 16, r"0\.00889"))  # 2 um / 15^2, and 14 cells are too few
        result = self.accepted("run.ini", "--check", "--quiet", *settings("pinion_crowning_um=10"))
        self.assertEqual(result.stderr, "")

    def test_missed_tolerance_is_warned_of(self):
        corner = ["pinion_drive_tip_corner_I_um=20", "pinion_drive_tip_corner_I_width_mm=4", "pinion_drive_tip_corner_I_share=0.3"]
        text = self.stderr(*corner, "pinion_drive_tip_corner_I_shape=parabolic", "tolerance_um=1e-4")
        self.assertRegex(text, r"modifications\.tolerance_um: warning: missed: the table of pinion_drive .* by up to 0\.00\d+ um")
        text = self.stderr(*corner, "pinion_drive_tip_corner_I_shape=parabolic", "tolerance_um=0.2")
        self.assertNotIn("warning", text)
        text = self.stderr(*corner, "tolerance_um=1e-4")  # linear: exact, whatever the tolerance
        self.assertNotIn("warning", text)

    def test_keys_that_change_nothing_are_warned_of(self):
        for pairs, key, reason in [
                (["pinion_tip_relief_shape=circular"], "pinion_tip_relief_shape", "not used without an amount"),
                (["wheel_drive_end_relief_I_length_mm=3"], "wheel_drive_end_relief_I_length_mm", "not used without an amount"),
                (["pinion_crowning_um=3", "pinion_drive_crowning_um=1", "pinion_coast_crowning_um=2"], "pinion_crowning_um",
                 "not used as the keys of both flanks replace it"),
                (["pinion_tip_relief_um=3", "pinion_tip_relief_share=0.1", "pinion_drive_tip_relief_share=0.2",
                  "pinion_coast_tip_relief_length_mm=2"], "pinion_tip_relief_share", "not used as the keys of both")]:
            with self.subTest(key):
                text = self.stderr(*pairs)
                self.assertIn(f"--set modifications.{key}: warning: {reason}", text)
                self.assertEqual(text.count("warning"), 1)

    def test_keys_that_count_are_not_warned_of(self):
        text = self.stderr("pinion_tip_relief_um=3", "pinion_tip_relief_share=0.1", "pinion_coast_tip_relief_um=0",
                           "wheel_crowning_um=3", "wheel_drive_crowning_um=1", "wheel_crowning_shape=circular")
        self.assertNotIn("warning", text)

    def test_simple_model_uses_none(self):
        for pair in ["pinion_tip_relief_um=3", "pinion_tip_relief_shape=linear"]:  # neither is looked at any further
            result = self.accepted("run.ini", "--check", "--set", "mesh.model=simple", *settings(pair))
            key = pair.split("=")[0]
            self.assertEqual(result.stderr, f"--set modifications.{key}: warning: not used with mesh.model = simple\n")

    def test_geometry_looks_at_none(self):
        result = self.accepted("run.ini", "--geometry", *settings("pinion_tip_relief_um=3"))
        self.assertEqual(result.stderr, "")

    def test_result_says_what_held_the_design(self):
        relief = settings("wheel_coast_tip_relief_um=10", "wheel_coast_tip_relief_share=0.25")
        _, head = self.run_te(*STATIC, *relief)
        self.assertIn("# modifications.wheel_coast_tip_relief_um = 10", head)
        notes = [line for line in head if "_modification_" in line]
        self.assertEqual(notes, ["# wheel_coast_modification_ramps = 1", "# wheel_coast_modification_error_um = 0"])
        _, head = self.run_te(*STATIC, *relief, *settings("wheel_coast_crowning_um=3"))
        notes = [line for line in head if "_modification_" in line]
        self.assertEqual(notes[:3], ["# wheel_coast_modification_ramps = 1", "# wheel_coast_modification_face_nodes = 19",
                                     "# wheel_coast_modification_profile_nodes = 2"])
        self.assertRegex(notes[3], r"^# wheel_coast_modification_error_um = 0\.009")
        self.assertEqual(len(notes), 4)


class Runs(Case):
    def setUp(self):
        super().setUp()
        self.write("run.ini", PARAMS)

    def test_profile_slope_and_a_file_of_the_same_surface_agree(self):
        # DEVIATIONS rise by 1 um from start to tip: half a micrometre of material more than the slope alone.
        self.write("flanks.csv", DEVIATIONS.replace("0,0,0\n", "0,0,-0.5\n").replace("1,0,0\n", "1,0,-0.5\n")
                   .replace("0,1,1\n", "0,1,0.5\n").replace("1,1,1\n", "1,1,0.5\n"))
        designed, _ = self.run_te(*STATIC, *settings("pinion_profile_slope_um=1"))
        measured, _ = self.run_te(*STATIC, "--set", "flanks.pinion=flanks.csv")
        plain, _ = self.run_te(*STATIC)
        self.assertGreater(max(abs(a - b) for a, b in zip(designed, plain)), 1e-3)
        for one, other in zip(designed, measured):
            self.assertAlmostEqual(one, other, delta=1e-8)  # ten digits of 50 um are written

    def test_design_and_file_add_up_and_scale_acts_on_the_file_alone(self):
        self.write("flanks.csv", DEVIATIONS)
        file = ["--set", "flanks.pinion=flanks.csv"]
        slope = settings("pinion_profile_slope_um=2")
        alone, _ = self.run_te(*STATIC, *slope)
        scaled_away, _ = self.run_te(*STATIC, *slope, *file, "--set", "flanks.scale=0")
        self.assertEqual(alone, scaled_away)
        # A slope of -1 um takes the file's away; half a micrometre of material is left all over, along the normal.
        plain, _ = self.run_te(*STATIC)
        together, _ = self.run_te(*STATIC, *settings("pinion_profile_slope_um=-1"), *file)
        tan_base_helix = 0.6494 * 0.9465  # tan(33 deg) cos(18.82 deg)
        for one, other in zip(plain, together):
            self.assertAlmostEqual(other - one, 0.5 * (1 + tan_base_helix**2) ** 0.5, delta=2e-4)

    def test_coast_flank_carries_a_negative_load(self):
        load = ["--set", "load.mean_Nm=-20"]
        plain, _ = self.run_te(*STATIC, *load)
        drive, _ = self.run_te(*STATIC, *load, *settings("pinion_drive_crowning_um=10"))
        coast, _ = self.run_te(*STATIC, *load, *settings("pinion_coast_crowning_um=10"))
        self.assertEqual(plain, drive)
        self.assertGreater(max(abs(a - b) for a, b in zip(plain, coast)), 1)

    def spread(self, *arguments):
        te, _ = self.run_te(*arguments, file=RELIEF)
        return max(te) - min(te)

    def test_example_has_no_transmission_error_at_its_load(self):
        # test_flank_design.c derives it: 0 at the design load, C / 4 at half of it, F / (2 K) without relief.
        self.assertLess(self.spread(), 2e-6)  # load and length are given to seven digits, 2e-6 um of 20 um
        self.assertAlmostEqual(self.spread("--set", "load.mean_Nm=36.507"), 5, delta=0.05)
        plain = settings("pinion_tip_relief_um=0", "wheel_tip_relief_um=0")
        self.assertAlmostEqual(self.spread(*plain), 10, delta=0.01)

    def test_example_is_accepted_with_notes_alone(self):
        text = self.accepted(RELIEF, "--check").stderr
        self.assertEqual(len(re.findall(r"(?m)^.+: note: \[modifications\] of \w+: 1 linear relief, exact$", text)), 4)
        self.assertEqual(text.count("\n"), 4)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        test_gearsim_cli.GEARSIM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
