# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the command gearflanks share: a folder for each, and what the program says there."""
import csv
import os
import subprocess
import sys
import tempfile
import unittest

program = os.environ.get("GEARFLANKS", "gearflanks")


def rows_of(path):
    with open(path, encoding="ascii", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def run_it(self, *arguments):
        return subprocess.run(
            [program, *arguments], cwd=self.folder, capture_output=True, text=True, check=False, timeout=60
        )

    def accepted(self, *arguments):
        result = self.run_it(*arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""), arguments)
        return result.stdout

    def refused(self, said, *arguments, code=2):
        result = self.run_it(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        for text in [said] if isinstance(said, str) else said:
            self.assertIn(text, result.stderr)
        self.assertEqual(result.stdout, "")


def main():
    """Runs the tests of the calling file; the first argument may be the program."""
    global program  # pylint: disable=global-statement
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        program = os.path.abspath(sys.argv.pop(1))
    unittest.main()
