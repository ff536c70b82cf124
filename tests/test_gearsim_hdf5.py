#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Results of gearsim in HDF5, read by h5py: the same as in CSV, whole or cut short.

    test_gearsim_hdf5.py GEARSIM [-v] [name of a test]...
"""
import os
import signal
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, os.pardir, "scripts")]
import program  # noqa: E402

program.require("h5py")

import h5py  # noqa: E402

import test_gearsim_runs as runs  # noqa: E402
import uncounted  # noqa: E402

BLOCK_ROWS = 4096
NOISY = ["load.noise_amplitude_Nm=10", "output.oversampling=1"]


def columns(path):
    with h5py.File(path, "r") as file:
        return {name: data[:].tolist() for name, data in file.items()}


def attributes(path):
    """Texts of the root; of variable length, but for that of an incomplete run."""
    with h5py.File(path, "r") as file:
        return {name: text.decode() if isinstance(text, bytes) else text for name, text in file.attrs.items()}


class Hdf5(runs.Case):
    def run_hdf5(self, settings, name="run.h5"):
        result = self.gearsim(settings, "--output", name)
        self.assertEqual((result.returncode, os.path.exists(self.path(name + ".part"))), (0, False), result.stderr)
        return columns(self.path(name))

    def test_numbers_are_those_of_the_csv(self):
        """To the last bit in 17 digits, and in 10 as CSV rounds them; more rows than a block."""
        for settings in ([*NOISY, "output.rate_Hz=500000"], ["output.columns=pairs_in_contact,time_s"], runs.STATIC):
            hdf5 = self.run_hdf5(settings)
            self.assertEqual(self.run_columns(settings), hdf5)
            short = self.run_columns([*settings, "output.digits=10"])
            self.assertEqual(short, {name: [float(f"{value:.10g}") for value in data] for name, data in hdf5.items()})
        self.assertEqual(self.run_hdf5(NOISY, "run.hdf5"), self.run_hdf5(NOISY))

    def test_provenance_is_that_of_the_csv(self):
        self.run_columns(NOISY)
        head = [line[2:].partition(" = ") for line in self.text("run.csv").splitlines() if line.startswith("# ")]
        expected = {name: value for name, equals, value in head if equals}
        self.run_hdf5(NOISY)
        found = attributes(self.path("run.h5"))
        self.assertEqual(head[0][0], "gearsim " + found.pop("gearsim"))
        self.assertEqual((expected.pop("output.file"), found.pop("output.file")), ("run.csv", "run.h5"))
        self.assertEqual(found, expected)
        self.assertIn("eigenfrequency_Hz", found)

    def test_only_the_suffix_decides(self):
        result = self.gearsim([], "--output", "run.h5.csv")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(self.text("run.h5.csv").startswith("# gearsim"))


class Ends(runs.Case):
    ENDLESS = ["analysis.duration_s=30000", *NOISY]

    def setUp(self):
        super().setUp()
        with open(self.path("run.h5"), "w") as file:
            file.write(runs.OLD_RESULT)
        self.part = self.path("run.h5.part")

    def assert_part_is_the_beginning(self, reason):
        """Of the same run in CSV. Returns the number of rows."""
        self.assertEqual(self.text("run.h5"), runs.OLD_RESULT)
        self.assertRegex(attributes(self.part)["incomplete"], reason)
        found = columns(self.part)
        rows = len(found["time_s"])
        # Constant speed: that the run is shorter changes nothing else.
        whole = self.run_columns([*NOISY, "analysis.duration_s=0.4"])
        for name, data in whole.items():
            self.assertEqual(len(found[name]), rows)
            self.assertEqual(found[name][: len(data)], data[:rows])
        return rows

    def ended_by(self, number):
        if os.path.exists(self.part):
            os.remove(self.part)
        process = subprocess.Popen(self.command(self.ENDLESS, "--output", "run.h5"), cwd=self.folder,
                                   stderr=subprocess.PIPE, text=True, preexec_fn=runs.listen_to_interrupts)
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            if os.path.exists(self.part) and os.path.getsize(self.part) > 1000000:
                break
            time.sleep(0.02)
        process.send_signal(number)
        errors = process.communicate(timeout=60)[1]
        return process.returncode, errors

    def test_interrupted_runs_keep_what_there_is(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            status, errors = self.ended_by(number)
            self.assertEqual(status, 130, errors)
            self.assertIn("interrupted at t = ", errors)
            rows = self.assert_part_is_the_beginning("^interrupted at t = [0-9.]+ s$")
            self.assertGreater(rows, BLOCK_ROWS)

    def test_a_full_disk_ends_the_run_and_leaves_the_old_result(self):
        """A limit on the size of a file stands for it."""
        result = self.gearsim(self.ENDLESS, "--output", "run.h5",
                              preexec_fn=uncounted.limit_files(2000000))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("run.h5.part: File too large", result.stderr)
        self.assertIn("the disk took no more at t = ", result.stderr)
        rows = self.assert_part_is_the_beginning("^File too large$")
        self.assertGreater(rows, 0)
        self.assertEqual(rows % BLOCK_ROWS, 0)

    def test_disk_full_from_the_start_is_told_at_once(self):
        result = self.gearsim(self.ENDLESS, "--output", "run.h5",
                              preexec_fn=uncounted.limit_files(3000))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("run.h5.part: File too large", result.stderr)
        self.assertEqual(self.text("run.h5"), runs.OLD_RESULT)

    def test_failed_runs_say_why(self):
        result = self.gearsim(["load.noise_amplitude_Nm=1e6", "analysis.duration_s=1"], "--output", "run.h5")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertRegex(attributes(self.part)["incomplete"], "at t = [0-9.e-]+ s; the gears: ")

    def test_whole_run_replaces_the_old_result(self):
        result = self.gearsim([], "--output", "run.h5")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["run.h5", "run.ini"])
        self.assertNotIn("incomplete", attributes(self.path("run.h5")))
        self.assertEqual(len(columns(self.path("run.h5"))["time_s"]), 513)

    def test_bad_places_are_bad_input(self):
        for name in ("no/such/run.h5", "/dev/null/run.h5"):
            result = self.gearsim([], "--output", name)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("output.file", result.stderr)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        runs.GEARSIM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
