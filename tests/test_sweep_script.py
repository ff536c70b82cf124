#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
scripts/sweep: which runs there are, that their numbers are those of single runs, and that each is made once, whatever
happens in between.

    test_sweep_script.py GEARSIM [-v] [name of a test]...
"""
import importlib.util
import json
import os
import signal
import statistics
import subprocess
import sys
import time
import unittest
from unittest import mock

sys.dont_write_bytecode = True

from script_case import call  # noqa: E402  first: it says where the scripts are
from sweep_case import GEARSIM, Case, main  # noqa: E402

import program  # noqa: E402

program.require("numpy", "scipy")

import numpy as np  # noqa: E402

import spread  # noqa: E402
import summary  # noqa: E402
import sweep_plan  # noqa: E402
import sweep_runs  # noqa: E402


def plan(*specs, samples=8, method="lhs", seed=1):
    return sweep_plan.Plan(specs, samples, method, seed)


class Plans(unittest.TestCase):
    def test_ranges_and_lists_are_combined(self):
        made = plan("load.mean_Nm=10:30:3", "drive.kind=speed,torque")
        self.assertEqual(made.keys, ["load.mean_Nm", "drive.kind"])
        self.assertEqual(made.rows, [[load, kind] for load in ("10", "20", "30") for kind in ("speed", "torque")])

    def test_a_latin_hypercube_has_a_sample_in_each_part_of_each_key(self):
        made = plan("a.x=uniform(2,4)", "b.y=uniform(-1,0)", samples=20)
        for at, (low, width) in enumerate([(2, 2), (-1, 1)]):
            parts = sorted(int((float(row[at]) - low) / width * 20) for row in made.rows)
            self.assertEqual(parts, list(range(20)))
        self.assertEqual(made.rows, plan("a.x=uniform(2,4)", "b.y=uniform(-1,0)", samples=20).rows)
        self.assertNotEqual(made.rows, plan("a.x=uniform(2,4)", "b.y=uniform(-1,0)", samples=20, seed=2).rows)

    def test_a_latin_hypercube_has_the_numbers_of_scipy(self):
        from scipy.stats import qmc  # pylint: disable=import-outside-toplevel

        for dimensions, points, seed in ((1, 1, 0), (6, 48, 1), (3, 100, 7)):
            np.testing.assert_array_equal(spread.latin_hypercube(dimensions, points, seed),
                                          qmc.LatinHypercube(dimensions, seed=seed).random(points))

    def test_a_normal_distribution_has_its_mean_and_deviation(self):
        for method, error in (("lhs", 0.01), ("random", 0.2)):
            values = [float(row[0]) for row in plan("a.x=normal(5,2)", samples=400, method=method).rows]
            self.assertAlmostEqual(statistics.mean(values), 5, delta=error * 2)
            self.assertAlmostEqual(statistics.stdev(values), 2, delta=0.15)

    def test_each_sample_is_at_each_point_of_the_grid(self):
        rows = plan("a.x=uniform(0,1)", "b.y=1,2", samples=3).rows
        self.assertEqual(len(rows), 6)
        self.assertEqual([row[0] for row in rows[:3]], [row[0] for row in rows[3:]])
        self.assertEqual([row[1] for row in rows], ["1"] * 3 + ["2"] * 3)

    def test_what_is_wrong_is_refused(self):
        for spec in ("load.mean_Nm", "mean_Nm=1:2:3", "a.x=1:2:0", "a.x=1:2:3.5", "a.x=1:b:3", "a.x=uniform(2,1)",
                     "a.x=normal(1,0)", "a.x=normal(1)", "a.x=cauchy(1,2)", "a.x=1,,2", "a.x=1,1", "a.x=nan:2:3",
                     "a.x=", "class.gear=5", "class.seed=1,2", "a.x=1:2:9999999"):
            with self.subTest(spec), self.assertRaises(program.InputError):
                plan(spec)
        with self.assertRaises(program.InputError):
            plan("a.x=1,2", "a.x=3,4")

    @unittest.skipIf(importlib.util.find_spec("SALib"), "SALib is installed")
    def test_without_salib_there_is_a_word_about_it(self):
        with self.assertRaisesRegex(program.InputError, "needs Python with SALib"):
            plan("a.x=uniform(0,1)", method="sobol")

    @unittest.skipUnless(importlib.util.find_spec("SALib"), "needs SALib")
    def test_sobol_indices_of_a_sum_are_the_shares_of_its_variance(self):
        made = plan("a.x=uniform(0,1)", "a.y=uniform(0,2)", samples=1024, method="sobol")
        values = sweep_runs.summary.np.array([float(x) + float(y) for x, y in made.rows])
        found = sweep_plan.salib("analyze.sobol").analyze(made.problem(), values, calc_second_order=False, seed=1)
        for index in ("S1", "ST"):
            for got, right in zip(found[index], (0.2, 0.8)):  # variances 1/12 and 4/12
                self.assertAlmostEqual(got, right, delta=0.02)


class Numbers(unittest.TestCase):
    def test_numbers_of_a_summary_have_names_with_their_unit(self):
        found = {"kind": "dynamic", "force": {"mean": {"value": 2.0, "unit": "N"}},
                 "orders": [{"order": 45, "value": None, "unit": "µm", "why": "x", "at": {"value": 9.0, "unit": "rpm"}}],
                 "stiffness_N_per_um": {"value": 3.0, "unit": "N/µm"}}
        self.assertEqual(sweep_runs.numbers_of(found), {"force.mean_N": 2.0, "orders.1_um": None, "orders.1.at_rpm": 9.0,
                                                        "stiffness_N_per_um": 3.0})


class Runs(Case):
    LOADS = ("--vary", "load.mean_Nm=100:400:4", "--set", "analysis.positions=40")

    def sweep(self, *arguments):
        done = call("sweep", "p.ini", "--no-pictures", *arguments, folder=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stderr)
        return done.stdout

    def test_a_row_is_the_summary_of_the_run(self):
        self.sweep(*self.LOADS, *self.counting())
        rows = self.table()
        self.assertEqual([row["load.mean_Nm"] for row in rows], ["100", "200", "300", "400"])
        subprocess.run([GEARSIM[0], "p.ini", "--quiet", "--set", "load.mean_Nm=300", "--set", "analysis.positions=40",
                        "--output", "one.csv"], cwd=self.folder, check=True)
        right = summary.of_file(self.path("one.csv"))["loads"][0]["te_peak_to_peak"]["value"]
        self.assertAlmostEqual(float(rows[2]["loads.1.te_peak_to_peak_um"]), right, places=9)
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ["gearsim", "log", "one.csv", "p.ini", "p_sweep.csv", "p_sweep.journal"])

    def test_what_is_done_is_not_done_again(self):
        counting = self.counting()
        self.sweep(*self.LOADS, *counting)
        before = self.table()
        self.assertIn("4 of 4 runs are done already", self.sweep(*self.LOADS, *counting))
        self.assertEqual((self.runs_made(), self.table()), (4, before))
        with open(self.path("p_sweep.journal"), "rb+") as file:  # killed while a line was written
            file.truncate(len(file.read()) - 7)
        self.sweep(*self.LOADS, *counting)
        self.assertEqual((self.runs_made(), self.table()), (5, before))
        self.assertIn("4 of 4 runs are done already", self.sweep(*self.LOADS, *counting))

    def test_another_sweep_is_not_mixed_with_it(self):
        self.sweep(*self.LOADS)
        for arguments in (["--vary", "load.mean_Nm=100:400:5", *self.LOADS[2:]], [*self.LOADS, "--set", "load.seed=2"]):
            done = call("sweep", "p.ini", *arguments, folder=self.folder)
            self.assertEqual(done.returncode, 2)
            self.assertIn("of another sweep", done.stderr)

    def test_a_run_that_is_refused_has_a_row_with_the_reason(self):
        done = call("sweep", "p.ini", "--no-pictures", "--vary", "load.mean_Nm=100,0,many", *self.LOADS[2:], folder=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        good, zero, many = self.table()
        self.assertEqual(good["failed"], "")
        self.assertNotEqual(good["loads.1.te_peak_to_peak_um"], "")
        self.assertIn("load.mean_Nm: must not be 0", zero["failed"])
        self.assertIn("(got many)", many["failed"])
        self.assertEqual(many["loads.1.te_peak_to_peak_um"], "")
        self.assertIn("warning: 2 runs failed", done.stderr)
        none = call("sweep", "p.ini", "--vary", "load.mean_Nm=0,many", "--output", "x", folder=self.folder)
        self.assertEqual((none.returncode, none.stderr.splitlines()[-1]), (1, "sweep: no run has a result"))

    def test_a_key_that_is_not_there_is_told_before_anything_is_written(self):
        for vary, message in (("load.foo=1,2", "load.foo: unknown key"), ("load.mean_Nm=1:2", "a range without the number of values")):
            done = call("sweep", "p.ini", "--vary", vary, "--output", "x", folder=self.folder)
            self.assertEqual(done.returncode, 2)
            self.assertIn(message, done.stderr)
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("x")], [])

    def test_where_the_file_alone_would_write_plays_no_part(self):
        done = self.finish("--gearsim", GEARSIM[0], "--vary", "load.mean_Nm=20,40", "--set", "analysis.positions=5",
                           "--set", "output.file=no/where.csv", "--set", "output.load_distribution=no/load.csv")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(len(self.table()), 2)

    def test_a_killed_sweep_goes_on_with_nothing_lost_or_made_twice(self):
        arguments = ("--vary", "load.mean_Nm=100:400:9", "--set", "analysis.positions=40", "--jobs", "2",
                     *self.counting(delay_s=0.05))
        running = subprocess.Popen(self.command(*arguments), cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE)
        end = time.monotonic() + 30
        while time.monotonic() < end and self.journal_lines() <= 3:
            time.sleep(0.005)
        running.send_signal(signal.SIGKILL)
        running.communicate()
        self.assertLess(self.journal_lines(), 10)
        done = self.finish(*arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.runs_made(), 9)
        self.assertEqual([row["run"] for row in self.table()], [str(i) for i in range(9)])
        self.assertTrue(all(row["loads.1.te_peak_to_peak_um"] for row in self.table()))

    def test_a_disk_that_takes_no_more_stops_it_and_it_goes_on(self):
        with mock.patch.object(sweep_runs.os, "fsync", side_effect=OSError(28, "No space left on device")):
            done = call("sweep", "p.ini", *self.LOADS, folder=self.folder)
        self.assertEqual(done.returncode, 1)
        self.assertIn("No space left on device; what is done stays", done.stderr)
        self.sweep(*self.LOADS, *self.counting())
        self.assertEqual(len(self.table()), 4)

    def test_flanks_of_a_class_are_made_for_each_run(self):
        self.sweep("--vary", "class.pinion=3,7", "--vary", "class.seed=1,2", *self.LOADS[2:])
        errors = [float(row["loads.1.te_peak_to_peak_um"]) for row in self.table()]
        self.assertEqual(len(set(errors)), 4)

    def test_hdf5_holds_the_same_table(self):
        if not importlib.util.find_spec("h5py"):
            self.skipTest("needs h5py")
        import h5py  # pylint: disable=import-outside-toplevel

        self.sweep(*self.LOADS, "--hdf5")
        with h5py.File(self.path("p_sweep.h5")) as file:
            self.assertEqual(list(file["load.mean_Nm"]), [100, 200, 300, 400])
            self.assertEqual([f"{value:.10g}" for value in file["loads.1.te_peak_to_peak_um"]],
                             [row["loads.1.te_peak_to_peak_um"] for row in self.table()])

    def test_pictures_of_responses_scatter_and_quantiles(self):
        done = call("sweep", "p.ini", "--vary", "load.mean_Nm=100:300:3", "--vary",
                    "modifications.pinion_tip_relief_um=uniform(0,20)", "--samples", "2", *self.LOADS[2:], folder=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for name in ("response", "scatter", "quantiles"):
            for suffix in ("png", "svg", "pdf"):
                self.assertGreater(os.path.getsize(self.path(f"p_sweep_{name}.{suffix}")), 4000)

    def test_the_journal_is_lines_of_json(self):
        self.sweep(*self.LOADS)
        with open(self.path("p_sweep.journal"), encoding="utf-8") as file:
            entries = [json.loads(line) for line in file]
        self.assertEqual(sorted(entry["run"] for entry in entries[1:]), [0, 1, 2, 3])


if __name__ == "__main__":
    main()
