#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
The commands of libgearmesh/docs/tutorial.md, and then those of gallery.md, are run as they stand there, one after the
other, and what the tutorial says of their results holds.

    test_tutorial.py FOLDER_OF_BUILD [-v]
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))
BUILD = []
TUTORIAL, GALLERY = (os.path.join(ROOT, "libgearmesh", "docs", name) for name in ("tutorial.md", "gallery.md"))
BLOCK = re.compile(r"<!-- Run by the test script.tutorial. -->\n```sh\n(.*?)```", re.DOTALL)


class Tutorial(unittest.TestCase):
    def test_every_command_does_what_the_page_says(self):
        with open(TUTORIAL, encoding="utf-8") as file:
            text = file.read()
        blocks = BLOCK.findall(text)
        self.assertEqual(len(blocks), len(re.findall(r"(?m)^## \d", text)))

        # The gallery goes on with what the tutorial has made.
        with open(GALLERY, encoding="utf-8") as file:
            gallery = file.read()
        blocks += BLOCK.findall(gallery)
        self.assertEqual(len(BLOCK.findall(gallery)), gallery.count("```sh"))

        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        for name in ("scripts", "data"):
            os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))
        os.makedirs(os.path.join(folder, "build"))
        os.symlink(BUILD[0], os.path.join(folder, "build", "release"))
        environment = {**os.environ, "GEARMESH_BUILD_DIR": BUILD[0]}
        done = subprocess.run(["bash", "-euc", "\n".join(blocks)], cwd=folder, env=environment, capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

        # What the text says of it.
        self.assertIn("eigenfrequency_Hz = 2261.5", done.stdout)
        self.assertRegex(done.stdout, r"TE peak-to-peak 0\.67[0-9] µm, mesh 1 0\.41[0-9] µm")
        self.assertRegex(done.stdout, r"0\.67[0-9] um before, 0\.18[0-9] um after")
        self.assertRegex(done.stdout, r"order 23 \(mesh 1\) crosses the resonance at 5900 rpm")
        self.assertIn("classes.csv: 12 runs\n", done.stdout)

        # Every file that it names.
        made = os.listdir(folder)
        named = re.findall(r"`([a-z]+[a-z_]*\.(?:png|csv|html|ini))`", text)
        self.assertGreater(len(named), 8)
        for name in named:
            self.assertIn(name, made)


if __name__ == "__main__":
    BUILD[:] = [os.path.abspath(sys.argv.pop(1))]
    unittest.main()
