# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
The Modelica package read by two tools, and the motion that its external functions give against gearsim.

    test_modelica.py PACKAGE_FOLDER MOTION.csv GEARSIM

No tool here runs external functions or has the Modelica standard library.
"""
import pathlib
import sys
import unittest

import numpy as np
import pymoca.parser
import rumoca

import gearmesh

PACKAGE, MOTION, PROGRAM = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
