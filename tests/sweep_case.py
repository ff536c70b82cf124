# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of scripts/sweep share: a folder with a parameter file, and a gearsim that counts its runs."""
import csv
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

from script_case import SCRIPTS

RELIEF = os.path.join(SCRIPTS, os.pardir, "data", "relief", "params.ini")
GEARSIM = []


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="a 'b' ")
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copy(RELIEF, self.path("p.ini"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def counting(self, delay_s=0):
        """A gearsim that notes each run that it has made whole."""
        program = self.path("gearsim")
        with open(program, "w", encoding="utf-8") as file:
            file.write(
                f"#!/bin/sh\ncase \"$*\" in *--check*) exec {shlex.quote(GEARSIM[0])} \"$@\";; esac\n"
                f"sleep {delay_s}\n{shlex.quote(GEARSIM[0])} \"$@\" || exit\n"
                f"echo done >>{shlex.quote(self.path('log'))}\n"
            )
        os.chmod(program, 0o755)
        return "--gearsim", program

    def runs_made(self):
        with open(self.path("log"), encoding="utf-8") as file:
            return len(file.readlines())

    def journal_lines(self):
        if not os.path.exists(self.path("p_sweep.journal")):
            return 0
        with open(self.path("p_sweep.journal"), "rb") as file:
            return file.read().count(b"\n")

    def table(self, name="p_sweep.csv"):
        with open(self.path(name), encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def command(self, *arguments):
        return [sys.executable, os.path.join(SCRIPTS, "sweep"), "p.ini", "--no-pictures", *arguments]

    def finish(self, *arguments):
        return subprocess.run(self.command(*arguments), cwd=self.folder, capture_output=True, text=True, timeout=120,
                              check=False, env={**os.environ, "LC_ALL": "C"})


def main():
    GEARSIM[:] = [os.path.abspath(sys.argv.pop(1))]
    unittest.main()
