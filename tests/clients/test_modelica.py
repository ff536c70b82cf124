# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
The Modelica package read by two tools, and the motion that its external functions give against gearsim.

    test_modelica.py PACKAGE_FOLDER MOTION.csv PROGRAM GEARSIM

PROGRAM is test_modelica.c.

No tool here runs external functions or has the Modelica standard library.
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import pymoca.parser
import rumoca

import gearmesh
import random_meshes

PACKAGE, MOTION, CALLS, PROGRAM = pathlib.Path(sys.argv[1]), *sys.argv[2:5]
PARAMETERS = pathlib.Path(__file__).with_name("params.ini")


class TestModelica(unittest.TestCase):
    def test_all_files_are_modelica(self):
        files = sorted(PACKAGE.glob("*.mo"))
        self.assertEqual([file.stem for file in files], ["MeshParameters", "PairParameters", "package"])
        for file in files:
            parsed = pymoca.parser.parse(file.read_text(encoding="utf-8"))
            self.assertIsNotNone(parsed, file)
            self.assertIn("GearMesh", parsed.classes)
            self.assertEqual([str(found) for found in rumoca.validate(str(file)) if found.level == "error"], [])

    def test_motion_is_that_of_gearsim(self):
        expected = gearmesh.gearsim(PARAMETERS, program=PROGRAM)
        time, offset = np.loadtxt(MOTION, delimiter=",").T
        self.assertEqual(len(time), len(expected["time_s"]))
        # RK4 with 400 steps in a vibration, gearsim with tolerances of 1e-8.
        self.assertLess(np.abs(offset + expected["dte_um"]).max(), 5e-5)
        self.assertGreater(np.ptp(offset), 0.1)

    def test_random_meshes_have_the_bits_of_the_library(self):
        made, compared = random_meshes.cases(), 0
        with tempfile.TemporaryDirectory() as folder:
            meshes, files = pathlib.Path(folder) / "meshes.txt", []
            random_meshes.write(meshes, made)
            for number, case in enumerate(made):
                files.append(case.table_files([pathlib.Path(folder) / f"{number}_{table}.csv" for table in range(3)]))
            printed = subprocess.run([CALLS, "--meshes", meshes, folder], check=True, capture_output=True, text=True).stdout
            lines = iter(printed.splitlines())
            for case, of_case in zip(made, files):
                for state, result in zip(case.states, case.at_rest(of_case)):
                    expected = [result.pinion_torque, result.wheel_torque, result.force]
                    self.assertEqual([float(value) for value in next(lines).split()], expected, (case.kind, state))
                    compared += abs(result.force) > 1
        self.assertIsNone(next(lines, None))
        self.assertGreater(compared, 0.7 * len(made) * random_meshes.STATES)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
