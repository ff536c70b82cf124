#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
The commands and the parameter file of README.md are run as they stand there, by a user who copies them.

    test_readme.py FOLDER_OF_GEARSIM FOLDER_OF_GEARFLANKS [-v] [name of a test]...
"""
import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
PROGRAMS = []


def blocks(language):
    """The blocks of README.md in a language that are marked to be run."""
    with open(os.path.join(ROOT, "README.md"), encoding="utf-8") as file:
        return re.findall(rf"<!-- Run by the test script.readme. -->\n```{language}\n(.*?)```", file.read(), re.DOTALL)


class Readme(unittest.TestCase):
    def setUp(self):
        """A folder that looks to the commands like that of the project."""
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("data", "scripts"):
            os.symlink(os.path.join(ROOT, name), os.path.join(self.folder, name))

    def run_script(self, text):
        environment = {**os.environ, "PATH": os.pathsep.join([*PROGRAMS, os.environ["PATH"]])}
        done = subprocess.run(
            ["bash", "-euc", text], cwd=self.folder, env=environment, capture_output=True, text=True, check=False
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def made(self):
        return set(os.listdir(self.folder)) - {"data", "scripts"}

    def test_first_run_gives_a_result_and_its_map(self):
        first, _ = blocks("sh")
        done = self.run_script(first)
        self.assertIn("transverse_contact_ratio", done.stdout)
        self.assertLessEqual({"run.csv", "run.png", "run.svg"}, self.made())

    def test_measured_traces_become_flanks_that_run_and_are_drawn(self):
        _, measured = blocks("sh")
        done = self.run_script(measured)
        self.assertIn("f_H_alpha", done.stdout)
        made = self.made()
        self.assertLessEqual({"flanks.csv", "pitch.csv", "params.csv"}, made)
        self.assertTrue(any(name.endswith(".png") for name in made), made)

    def test_parameter_file_runs_and_gives_the_columns_that_are_described(self):
        (parameters,) = blocks("ini")
        with open(os.path.join(self.folder, "params.ini"), "w", encoding="utf-8") as file:
            file.write(parameters)
        self.run_script("gearsim params.ini --check && gearsim params.ini --set analysis.duration_s=0.1")
        with open(os.path.join(self.folder, "params.csv"), encoding="utf-8") as file:
            rows = list(csv.reader(line for line in file if not line.startswith("#")))
        self.assertEqual(len(rows), 1 + 2561)
        with open(os.path.join(ROOT, "README.md"), encoding="utf-8") as file:
            described = re.search(r"one row per sample: `([^`]*)`", file.read())[1]
        self.assertEqual(rows[0], re.split(r",\s*", described))


if __name__ == "__main__":
    PROGRAMS = [os.path.abspath(folder) for folder in sys.argv[1:3]]
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
