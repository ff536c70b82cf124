# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Two gears in a multibody engine against gearsim, and against statics where a shaft tilts.

    test_multibody.py EXAMPLE.py GEARSIM
"""
import importlib
import pathlib
import sys
import unittest

import numpy as np

import gearmesh

EXAMPLE, PROGRAM = pathlib.Path(sys.argv[1]), sys.argv[2]
sys.path.insert(0, str(EXAMPLE.parent))
gears = importlib.import_module(EXAMPLE.stem)
case = importlib.import_module("tilting_gears")

# Of x (um). Runge-Kutta methods with 200 steps in a vibration are exact to 1e-6 of some micrometres. The trapezoidal rule
# with 200 is late by (w h)^2 / 12 = 1e-4 of each of 35 rad, times 0.3 um.
TOLERANCE = {"mujoco_gears": 5e-5, "drake_gears": 5e-5, "exudyn_gears": 1e-3}[EXAMPLE.stem]
PARAMETERS = pathlib.Path(__file__).with_name("params.ini")


class TestEngine(unittest.TestCase):
    def test_gears_on_fixed_shafts_move_as_in_gearsim(self):
        expected = gearmesh.gearsim(PARAMETERS, {"analysis.duration_s": 0.002, "output.rate_Hz": 50000}, PROGRAM)
        run = gears.simulate(2e-3)
        rows = expected["time_s"] < 2e-3 - 1e-9
        places = np.searchsorted(run["time"], expected["time_s"][rows] - 1e-9)
        difference = 1e6 * run["offset"][places] + expected["dte_um"][rows]
        self.assertLess(np.abs(difference).max(), TOLERANCE)
        self.assertGreater(np.ptp(expected["dte_um"]), 0.1)

    def test_a_stiff_shaft_bears_the_tilting_moment_of_the_axial_force(self):
        stiffness = 1e6
        run = gears.simulate(6e-3, stiffness, tilt_damping=10.0)
        settled = run["time"] > 2e-3
        pair = case.PAIR
        r_bp, r_bw = pair.pinion.base_radius, pair.wheel.base_radius

        # Both gears accelerate together. F tan(beta_b) is along the axis, and acts at the pitch point on average.
        force = (case.DRIVE * r_bp + case.LOAD * r_bw) / (r_bp**2 + r_bw**2)
        moment = -force * np.tan(pair.base_helix_angle) * pair.wheel_working_pitch_radius
        self.assertLess(abs(stiffness * run["tilt_y"][settled].mean() / moment - 1), 5e-3)
        # In the other direction the normal force would need a lever along the axis: none at mid-face, to 1 % of b / 2.
        normal = force * np.cos(pair.working_pressure_angle)
        self.assertLess(abs(stiffness * run["tilt_x"][settled].mean()), 1e-2 * normal * pair.face_width / 2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
