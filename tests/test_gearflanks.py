#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
gearflanks: what it makes measures to the class asked for, what it evaluates is what the definitions give
when worked out here again from the files, and bad input is refused with exit code 2.

    test_gearflanks.py GEARFLANKS [-v] [name of a test]...
"""
import csv
import math
import os
import subprocess
import sys

sys.dont_write_bytecode = True

import gearflanks_case  # noqa: E402
from gearflanks_case import Case, main, rows_of  # noqa: E402

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "data", "paper")
PARAMS = os.path.join(DATA, "fig14.ini")
KINDS = ["f_p", "F_p", "F_r", "f_H_alpha", "f_f_alpha", "F_alpha", "f_H_beta", "f_f_beta", "F_beta"]

# The gears of data/paper/.
TEETH = {"pinion": 45, "wheel": 41}
ALPHA_N, BETA = math.radians(16), math.radians(33)
ALPHA_T = math.atan(math.tan(ALPHA_N) / math.cos(BETA))
BETA_B = math.atan(math.tan(BETA) * math.cos(ALPHA_T))


def table(text):
    """Rows of the table by quantity: (value, tooth, flank, class, tolerance) as texts, and the class."""
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    assert lines[0].split() == ["quantity", "value_um", "tooth", "flank", "class", "tolerance_um"], lines[0]
    assert [line.split()[0] for line in lines[1:10]] == KINDS
    assert lines[10].startswith("class ") and len(lines) == 11
    return {line.split()[0]: line.split()[1:] for line in lines[1:10]}, lines[10].split()[1]


def file_rows(name):
    return rows_of(os.path.join(DATA, name))



class Make(Case):
    def make(self, gear, *more):
        """What is printed then is what the files measure to."""
        said = self.accepted(PARAMS, "--gear", gear, "--flanks", "f.csv", "--pitch", "p.csv", *more)
        text = self.accepted(PARAMS, "--gear", gear, "--evaluate", "--flanks", "f.csv", "--pitch=p.csv")
        self.assertEqual(said, text)
        return text

    def test_every_kind_measures_to_the_class(self):
        for gear, quality_class, seed in (("pinion", "3", "1"), ("wheel", "8", "2"), ("wheel", "11", "77")):
            rows, overall = table(self.make(gear, "--class", quality_class, "--seed", seed))
            self.assertEqual(overall, quality_class)
            for kind, (value, _, _, of_class, tolerance) in rows.items():
                self.assertEqual(of_class, quality_class, kind)
                self.assertAlmostEqual(float(value), 0.95 * float(tolerance), delta=2e-3, msg=kind)

    def test_the_files_say_how_they_were_made(self):
        self.make("wheel", "--class=5", "--seed=9", "--nodes=17x19", "--wave", "67:0.25", "--share", "0.9")
        for name in ("f.csv", "p.csv"):
            with open(self.path(name), encoding="ascii") as file:
                head = "".join(line for line in file if line.startswith("#"))
            for said in ("wheel of 41 teeth", "class 5", "seed 9", "share 0.9", "17x19", "order 67, 0.25 um"):
                self.assertIn(said, head)
        self.assertEqual(sorted(os.listdir(self.folder)), ["f.csv", "p.csv"])

    def test_a_seed_gives_its_own_flanks(self):
        contents = []
        for seed in ("1", "1", "2"):
            self.make("wheel", "--class", "6", "--nodes", "9x9", "--seed", seed)
            with open(self.path("f.csv"), "rb") as file:
                contents.append(file.read().split(b"deviation_um", 1)[1])
        self.assertTrue(contents[0] == contents[1])
        self.assertFalse(contents[0] == contents[2])

    def test_an_existing_file_stays_if_nothing_can_be_made(self):
        old = self.write("f.csv", "old\n")
        self.refused("waves use up", PARAMS, "--gear", "pinion", "--class", "2", "--flanks", "f.csv",
                     "--pitch", "p.csv", "--wave", "67:30")
        with open(old, encoding="ascii") as file:
            self.assertEqual(file.read(), "old\n")
        self.assertEqual(os.listdir(self.folder), ["f.csv"])

    def test_a_file_that_cannot_be_written_is_refused(self):
        self.refused("no/f.csv.part cannot be written: ", PARAMS, "--gear", "pinion", "--class", "6",
                     "--flanks", "no/f.csv", "--pitch", "p.csv")


class Scatter(Case):
    """Amounts in an INI file."""

    def make(self, text, *more, gear="pinion"):
        path = self.write("scatter.ini", text)
        self.accepted(PARAMS, "--gear", gear, "--scatter", path, "--flanks", "f.csv", "--pitch", "p.csv", *more)
        flanks, head = {}, []
        with open(self.path("f.csv"), encoding="ascii") as file:
            for line in file:
                if line.startswith("#"):
                    head.append(line.strip())
                elif line[0].isdigit():
                    tooth, flank, t1, t2, value = line.strip().split(",")
                    flanks.setdefault((int(tooth), flank), {})[round(float(t1), 4), round(float(t2), 4)] = float(value)
        with open(self.path("p.csv"), encoding="ascii") as file:
            pitch = [float(line.split(",")[2]) for line in file if line[0].isdigit()]
        return flanks, pitch, head

    def test_each_key_does_what_it_says(self):
        """One key at a time, without scatter: (t1, t2) and the value there, on every flank."""
        for key, values in (
            ("[profile]\nslope_um = 4", {(0, 0): -2, (1, 1): 2, (0.5, 0.5): 0}),
            ("[profile]\ncrowning_um = 4", {(0, 0): -4, (1, 1): -4, (1, 0.5): 0}),
            ("[helix]\nslope_um = 4", {(0, 0): -2, (1, 1): 2, (0.5, 0.5): 0}),
            ("[helix]\ncrowning_um = 4", {(0, 0): -4, (1, 1): -4, (0.5, 1): 0}),
            ("[foot]\nmaterial_um = 5", {(0, 0): 5, (1, 0): 5, (0, 0.3667): 0, (0, 1): 0}),
            ("[foot]\nmaterial_um = 5\nend_t2 = 1", {(0, 0): 5, (0, 0.5): 2.5, (0, 1): 0}),
            ("[tip]\nrelief_um = 8", {(0, 0): 0, (0, 0.8): 0, (0, 0.9): -2, (1, 1): -8}),
            ("[tip]\nrelief_um = 8\nstart_t2 = 0", {(0, 0): 0, (0, 0.5): -2, (1, 1): -8}),
        ):
            flanks, pitch, head = self.make(key)
            for flank in ((0, "drive"), (17, "coast")):
                for place, value in values.items():
                    self.assertAlmostEqual(flanks[flank][place], value, delta=1e-4, msg=(key, place))
            self.assertEqual(set(pitch), {0.0})
            section, name, *_ = key.replace("[", "").split("]\n") + [""]
            self.assertIn(f"# {section}.{name.splitlines()[0]}", head)

    def test_scatter_differs_from_flank_to_flank(self):
        for key in ("[profile]\nslope_scatter_um = 1", "[profile]\ncrowning_scatter_um = 1",
                    "[helix]\nslope_scatter_um = 1", "[helix]\ncrowning_scatter_um = 1",
                    "[foot]\nmaterial_scatter_um = 1", "[tip]\nrelief_scatter_um = 1",
                    "[surface]\nroughness_um = 1", "[profile]\nwave_most_um = 1", "[helix]\nwave_most_um = 1"):
            flanks, pitch, _ = self.make(key, "--nodes", "13x13", gear="wheel")
            corners = {flank[0.0, 0.0] if "tip" not in key else flank[1.0, 1.0] for flank in flanks.values()}
            self.assertGreater(len(corners), 70, key)
            self.assertLess(max(map(abs, corners)), 6.0)
            self.assertEqual(set(pitch), {0.0}, key)
        for key in ("scatter_um = 1", "eccentricity_um = 2"):
            flanks, pitch, _ = self.make("[pitch]\n" + key, "--nodes", "9x9")
            self.assertGreater(len(set(pitch)), 70, key)
            self.assertEqual({value for flank in flanks.values() for value in flank.values()}, {0.0})

    def test_number_of_waves(self):
        flanks, _, head = self.make(
            "[profile]\nwave_least_um = 2\nwave_most_um = 2\nwaves_least = 3\nwaves_most = 3\n", "--seed", "5")
        for flank in flanks.values():
            trace = [flank[0.5, round(k / 30, 4)] for k in range(31)]
            for k in range(21):
                self.assertAlmostEqual(trace[k], trace[k + 10], delta=2e-4)
            self.assertAlmostEqual(math.fsum(value * value for value in trace[:10]) / 10, 2.0, delta=1e-3)
        self.assertIn("# profile.waves_most = 3", head)
        self.assertIn("# seed 5, nodes 21x31", head)

    def test_an_empty_file_makes_ideal_flanks(self):
        flanks, pitch, _ = self.make("; nothing\n", "--nodes", "9x9")
        self.assertEqual({value for flank in flanks.values() for value in flank.values()} | set(pitch), {0.0})

    def test_a_bad_file_is_refused_with_its_line(self):
        for text, line, said in (
            ("[profile]\nslope_um = x\n", 2, "profile.slope_um: must be a number such as 12, -0.5 or 1e-4 with nothing behind it (got x)"),
            ("[profile]\nslope_scatter_um = -1\n", 2, "must be from 0 to 10000 (got -1)"),
            ("[profile]\nslop_um = 1\n", 2, "unknown key, did you mean slope_um?"),
            ("[profil]\nslope_um = 1\n", 1, "[profil]: unknown section, did you mean [profile]?"),
            ("[xyz]\n", 1, "unknown section, `gearflanks --help` lists all"),
            ("[foot]\nend_t2 = 0\n", 2, "must be above 0, up to 1"),
            ("[tip]\n\nstart_t2 = 1\n", 3, "must be from 0 to below 1"),
            ("[tip]\nrelief_um = 1\nrelief_um = 1\n", 3, "repeated key, must be given once (first in line 2)"),
            ("[helix]\nwave_least_um = 3\nwave_most_um = 2\n", 3, "helix.wave_most_um: must be at least wave_least_um (got 2)"),
            ("[profile]\nwaves_most = 0.5\n", 2, "profile.waves_most: must be at least waves_least (got 0.5)"),
            ("[pitch\n", 1, "not understood"),
        ):
            path = self.write("scatter.ini", text)
            self.refused(f"{path}:{line}: ", PARAMS, "--gear", "wheel", "--scatter", path, "--flanks", "f.csv",
                         "--pitch", "p.csv")
            self.refused(said, PARAMS, "--gear", "wheel", "--scatter", path, "--flanks", "f.csv", "--pitch", "p.csv")
        path = self.write("scatter.ini", "[helix]\nwave_most_um = 1\nwaves_most = 6\n")
        self.refused("helix: must have 4 nodes per wave (got too many waves for 21 nodes)", PARAMS, "--gear", "wheel", "--scatter", path, "--flanks",
                     "f.csv", "--pitch", "p.csv")
        path = self.write("scatter.ini", "[helix]\nwave_least_um = 1\n")
        self.refused("helix.wave_most_um: must be at least wave_least_um (got 0)", PARAMS, "--gear", "wheel", "--scatter", path,
                     "--flanks", "f.csv", "--pitch", "p.csv")
        self.refused("no.ini: ", PARAMS, "--gear", "wheel", "--scatter", "no.ini", "--flanks", "f.csv", "--pitch",
                     "p.csv")
        self.assertEqual(os.listdir(self.folder), ["scatter.ini"])


class Evaluate(Case):
    """Against the definitions, computed here from the rows of the files."""

    def flank_values(self, gear):
        text = self.accepted(PARAMS, "--gear", gear, "--evaluate", "--teeth")
        rows = list(csv.DictReader(text.splitlines()))
        self.assertEqual(len(rows), 2 * TEETH[gear])
        return {(int(row["tooth"]), row["flank"]): row for row in rows}

    def test_single_and_total_pitch_follow_from_the_file(self):
        for gear, teeth in TEETH.items():
            measured = self.flank_values(gear)
            pitch = {(int(r["tooth"]), r["flank"]): float(r["deviation_um"]) for r in file_rows(gear + "_pitch.csv")}
            worst, ranges = 0.0, []
            for flank in ("drive", "coast"):
                ahead = 1 if (flank == "drive") == (gear == "pinion") else -1
                places = [ahead * pitch[i, flank] / math.cos(ALPHA_T) for i in range(teeth)]
                ranges.append(max(places) - min(places))
                for i in range(teeth):
                    expected = places[i] - places[i - 1]
                    worst = max(worst, abs(expected))
                    self.assertAlmostEqual(float(measured[i, flank]["single_pitch_um"]), expected, delta=1e-4)
            rows, _ = table(self.accepted(PARAMS, "--gear", gear, "--evaluate"))
            self.assertAlmostEqual(float(rows["f_p"][0]), worst, delta=1e-3)
            self.assertAlmostEqual(float(rows["F_p"][0]), max(ranges), delta=1e-3)

    def mean_line(self, trace, start, end):
        """Level and gradient through many points of the polygon."""
        count, last = 2000, len(trace) - 1
        points = [start + (end - start) * (k + 0.5) / count for k in range(count)]
        values = []
        for t in points:
            node = min(int(t * last), last - 1)
            values.append(trace[node] + (t * last - node) * (trace[node + 1] - trace[node]))
        middle, mean = math.fsum(points) / count, math.fsum(values) / count
        gradient = math.fsum((t - middle) * v for t, v in zip(points, values)) / math.fsum(
            (t - middle) ** 2 for t in points
        )
        return mean - gradient * middle, gradient

    def form(self, trace, line, start, end):
        """Range inside; outside (of the profile: not at the foot, as it begins there) only what sticks out."""
        last = len(trace) - 1
        inside, outside = [], []
        for k, value in enumerate(trace):
            rest = value - line[0] - line[1] * k / last
            (inside if start <= k / last <= end else outside).append(rest)
        for t in (start, end):
            node = min(int(t * last), last - 1)
            value = trace[node] + (t * last - node) * (trace[node + 1] - trace[node])
            inside.append(value - line[0] - line[1] * t)
        return max(inside + outside) - min(inside)

    def test_profile_and_helix(self):
        nodes = {}
        for row in file_rows("wheel_flanks.csv"):
            key = (round(float(row["t1"]) * 20), round(float(row["t2"]) * 30))
            nodes.setdefault((int(row["tooth"]), row["flank"]), {})[key] = float(row["deviation_um"])
        measured = self.flank_values("wheel")
        factor = 1 / math.cos(BETA_B)
        for flank in ((0, "drive"), (8, "drive"), (40, "coast")):
            profile = [factor * nodes[flank][10, k] for k in range(31)]
            helix = [factor * nodes[flank][k, 15] for k in range(21)]
            for trace, start, end, name in ((profile, 0.0, 0.95, "alpha"), (helix, 0.05, 0.95, "beta")):
                line = self.mean_line(trace, start, end)
                row = measured[flank]
                # 2000 points: the sums are off by about 1e-4 um at the kinks
                self.assertAlmostEqual(float(row[f"f_H_{name}_um"]), line[1], delta=2e-3)
                self.assertAlmostEqual(float(row[f"f_f_{name}_um"]), self.form(trace, line, start, end), delta=2e-3)
                self.assertAlmostEqual(
                    float(row[f"F_{name}_um"]), self.form(trace, (0.0, 0.0), start, end), delta=2e-4
                )

    def test_the_table_has_the_worst_of_all_flanks(self):
        measured = self.flank_values("pinion")
        rows, overall = table(self.accepted(PARAMS, "--gear", "pinion", "--evaluate"))
        for kind in KINDS[3:]:
            value, tooth, flank = rows[kind][:3]
            worst = max(measured, key=lambda key, kind=kind: abs(float(measured[key][kind + "_um"])))
            self.assertEqual((int(tooth), flank), worst, kind)
            self.assertAlmostEqual(float(value), abs(float(measured[worst][kind + "_um"])), delta=1e-3)
        self.assertEqual(int(overall), max(int(row[3]) for row in rows.values()))

    def test_what_no_file_says_has_no_class(self):
        pitch = self.write("p.csv", "tooth,flank,deviation_um\n*,drive,0\n3,drive,900\n")
        rows, overall = table(self.accepted(PARAMS, "--gear", "pinion", "--evaluate", "--pitch", pitch))
        self.assertEqual(rows["F_p"][3], ">11")
        self.assertEqual(overall, ">11")
        for kind in KINDS[2:]:
            self.assertEqual(rows[kind], ["-"] * 5)


class Refusals(Case):
    make = (PARAMS, "--gear", "pinion", "--class", "6", "--flanks", "f.csv", "--pitch", "p.csv")

    def tearDown(self):
        self.assertFalse(os.path.exists(self.path("f.csv")))

    def test_options_that_do_not_go_together_are_refused(self):
        self.refused("an INI file is missing")
        self.refused("--gear is missing", PARAMS, "--evaluate")
        self.refused("--class or --scatter is missing", PARAMS, "--gear", "pinion")
        self.refused("exclude each other", *self.make, "--scatter", "s.ini")
        scatter = (PARAMS, "--gear", "pinion", "--scatter", "s.ini", "--flanks", "f.csv")
        self.refused("not together with --scatter: --share", *scatter, "--pitch", "p.csv", "--share", "0.9")
        self.refused("would be overwritten: s.ini", *scatter, "--pitch", "s.ini")
        self.refused("not together with --evaluate: --scatter", *scatter, "--evaluate")
        self.refused("both needed", PARAMS, "--gear", "pinion", "--class", "6", "--flanks", "f.csv")
        self.refused("unknown option --what", *self.make, "--what")
        self.refused("unknown option --classes=6", *self.make, "--classes=6")
        self.refused("no value expected: --evaluate=1", *self.make, "--evaluate=1")
        self.refused("a value is missing behind --seed", *self.make, "--seed")
        self.refused("a second INI file, expected one: --evaluate", *self.make, "--", "--evaluate")
        self.refused("a second INI file", *self.make, "b.ini")
        self.refused("same file: f.csv", *self.make, "--pitch", "f.csv")
        self.refused("would be overwritten", *self.make, "--pitch", PARAMS)
        self.refused("not together with --evaluate: --class", *self.make, "--evaluate")
        self.refused("only together with --evaluate: --teeth", *self.make, "--teeth")

    def test_values_out_of_range_are_refused(self):
        for option, value, right in (
            ("--gear", "ring", "pinion or wheel"),
            ("--class", "6.5", "1 to 11"),
            ("--class", "12", "1 to 11"),
            ("--class", "4294967302", "1 to 11"),
            ("--scatter", "", "a file name"),
            ("--seed", "-1", "0 to 18446744073709551615"),
            ("--seed", "18446744073709551616", "0 to 18446744073709551615"),
            ("--share", "0x1", "0.8 to 0.99"),
            ("--share", "1", "0.8 to 0.99"),
            ("--share", "0.9e", "0.8 to 0.99"),
            ("--nodes", "21", "such as 21x31"),
            ("--nodes", "5x31", "9 to 1000"),
            ("--wave", "67", "such as 67:0.5"),
            ("--wave", "67:", "such as 67:0.5"),
            ("--wave", "67:nan", "such as 67:0.5"),
        ):
            self.refused(right, *self.make, option, value)

    def test_files_that_cannot_be_read_are_named(self):
        bad = self.write("bad.csv", "tooth,flank,deviation_um\n0,drive,x\n")
        self.refused(f"{bad}:2: ", PARAMS, "--gear", "pinion", "--evaluate", "--pitch", bad)
        self.refused("no.ini", "no.ini", "--gear", "pinion", "--evaluate")
        ini = self.write("bad.ini", "[gears]\npinion_teeth = x\n")
        self.refused(f"{ini}:2: gears.pinion_teeth", ini, "--gear", "pinion", "--evaluate")
        fig13 = os.path.join(DATA, "fig13.ini")
        self.refused("nothing to evaluate", fig13, "--gear", "pinion", "--evaluate")


class Informative(Case):
    def test_help_and_version(self):
        text = self.accepted("--help")
        for option in ("--gear", "--flanks", "--pitch", "--class", "--scatter", "--seed", "--share", "--nodes", "--wave",
                       "--evaluate", "--teeth", "--help", "--version", "[profile]", "eccentricity_um"):
            self.assertIn(option, text)
        self.assertRegex(self.accepted("--version"), r"^gearflanks \d+\.\d+\.\d+\n$")

    def test_a_full_disk_is_noticed(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            result = subprocess.run([gearflanks_case.program, "--help"], stdout=full, stderr=subprocess.PIPE, check=False)
        self.assertEqual(result.returncode, 1)


if __name__ == "__main__":
    main()
