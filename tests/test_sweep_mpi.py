#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
scripts/sweep over MPI: 2 and 4 ranks give the table of one, a rank may be killed, and a disk may be full.

    test_sweep_mpi.py GEARSIM [-v] [name of a test]...
"""
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True

from script_case import SCRIPTS  # noqa: E402  pylint: disable=unused-import
from sweep_case import Case, main  # noqa: E402

import program  # noqa: E402

program.require("numpy", "scipy", "mpi4py")

MPIRUN = ("mpirun", "--allow-run-as-root", "--oversubscribe")
SWEEP = ("--vary", "load.mean_Nm=100:400:12", "--set", "analysis.positions=40")


@unittest.skipUnless(shutil.which("mpirun"), "needs mpirun")
class Ranks(Case):
    def ranks(self, count, *arguments):
        return [*MPIRUN, "-n", str(count), *self.command(*SWEEP, "--mpi", *arguments)]

    def run_ranks(self, count, *arguments):
        return subprocess.run(self.ranks(count, *arguments), cwd=self.folder, capture_output=True, text=True, timeout=120,
                              check=False)

    def right(self):
        """The table that one process makes."""
        self.assertEqual(self.finish(*SWEEP, "--output", "right").returncode, 0)
        return self.table("right.csv")

    def test_any_number_of_ranks_gives_the_same_table_and_makes_each_run_once(self):
        for count in (1, 2, 4):
            with self.subTest(count):
                done = self.run_ranks(count, "--output", f"ranks{count}", *self.counting())
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertEqual(self.table(f"ranks{count}.csv"), self.right())
                self.assertEqual(self.runs_made(), 12)
                os.remove(self.path("log"))

    def test_bad_input_ends_all_ranks(self):
        done = self.run_ranks(3, "--vary", "load.mean_Nm=x:1:2")
        self.assertEqual(done.returncode, 2)
        self.assertIn("sweep: --vary load.mean_Nm=x:1:2: 'x' is no number", done.stderr)

    def test_after_a_rank_was_killed_the_same_command_goes_on(self):
        counting = self.counting(delay_s=0.1)
        running = subprocess.Popen(self.ranks(4, *counting), cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        end = time.monotonic() + 60
        while time.monotonic() < end and self.journal_lines() <= 3:
            time.sleep(0.01)
        ranks = subprocess.run(["pgrep", "-P", str(running.pid), "-f", "scripts/sweep"], capture_output=True, text=True,
                               check=True).stdout.split()
        os.kill(int(ranks[-1]), signal.SIGKILL)
        running.wait(60)
        self.assertNotEqual(running.returncode, 0)
        done = self.run_ranks(2, *counting)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLessEqual(self.runs_made(), 12)  # fewer where a run was done and its note was killed
        self.assertEqual(self.table(), self.right())

    def test_a_full_disk_stops_it_and_it_goes_on_when_there_is_room(self):
        room = self.path("room")
        os.mkdir(room)
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", room], stderr=subprocess.DEVNULL,
                          check=False).returncode:
            self.skipTest("needs a file system of its own, which root may make")
        self.addCleanup(subprocess.run, ["umount", room], check=True)
        with open(os.path.join(room, "ballast"), "wb") as file:
            file.write(bytes(8 << 10))
        done = self.run_ranks(2, "--output", "room/s")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("No space left on device", done.stderr)
        subprocess.run(["mount", "-o", "remount,size=4m", room], check=True)
        done = self.run_ranks(2, "--output", "room/s")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.table("room/s.csv"), self.right())


if __name__ == "__main__":
    main()
