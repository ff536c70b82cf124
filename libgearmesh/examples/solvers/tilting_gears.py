# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
What the examples of multibody engines have in common: two gears between a drive and a load, the wheel's shaft free to tilt
on springs if wanted. The mesh acts between the bodies, from their positions, rotations and velocities.
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import gearmesh

PAIR = gearmesh.Pair(pinion_teeth=45, wheel_teeth=41, normal_module=1.65e-3, normal_pressure_angle=np.radians(16),
                     helix_angle=np.radians(33), center_distance=0.085, face_width=0.0175, backlash=100e-6)
MESH = gearmesh.Mesh(PAIR, stiffness=1.05e8, damping=844.361)
SPEED, DRIVE, LOAD = 1000 * np.pi / 30, 25.0, 20.0  # of the pinion at the start (rad/s), torques (N m)
MASS, INERTIA = 1.0, (1.1e-3, 1.1e-3, 2.1e-3)  # of both bodies, about the middles of their faces (kg, kg m2)

# Places of both bodies: the middles of their faces.
PLACE = {"pinion": (0.0, 0.0, PAIR.face_width / 2), "wheel": (PAIR.center_distance, 0.0, PAIR.face_width / 2)}


def start():
    """Turn of the wheel (rad) and speeds of both (rad/s), counter-clockwise: at rest against each other under the torques,
    under which both accelerate together."""
    r_bp, r_bw = PAIR.pinion.base_radius, PAIR.wheel.base_radius
    torque = r_bw * (DRIVE * r_bp + LOAD * r_bw) / (r_bp**2 + r_bw**2)
    return MESH.static(0.0, torque).offset / r_bw, SPEED, -SPEED * r_bp / r_bw


def offset(pinion_turn, wheel_turn):
    """x from the turns of both bodies, counter-clockwise (rad)."""
    return PAIR.pinion.base_radius * pinion_turn + PAIR.wheel.base_radius * wheel_turn


def columns(rows):
    """One row for each step, as columns by name."""
    return dict(zip(("time", "offset", "tilt_x", "tilt_y"), np.array(rows).T))


PLOT = """
set terminal pngcairo size 1000,600 font ",11"
set output "{picture}"
set multiplot layout 2,1 title "{title}: gears on a fixed and on a tilting shaft"
set lmargin 10
set key left bottom
set ylabel "transmission error (um)"
plot "{fixed}" using (1e3*$1):(-1e6*$2) with lines title "fixed", \\
     "{tilting}" using (1e3*$1):(-1e6*$2) with lines title "tilting"
set ylabel "tilt of the wheel (urad)"
set xlabel "time (ms)"
plot "{tilting}" using (1e3*$1):(1e6*$3) with lines title "about x", \\
     "{tilting}" using (1e3*$1):(1e6*$4) with lines title "about y"
"""


def main(title, simulate):
    """Runs both shafts, says what they do, and draws a picture where the command line names one."""
    runs = {"fixed": simulate(2e-3), "tilting": simulate(2e-3, tilt_stiffness=2e4, tilt_damping=1.0)}
    for shaft, run in runs.items():
        print(f"{title}, {shaft} shaft: transmission error {-1e6 * run['offset'].mean():.2f} um on average, "
              f"tilts {1e6 * run['tilt_x'].mean():.1f} and {1e6 * run['tilt_y'].mean():.1f} urad")
    if len(sys.argv) > 1:
        with tempfile.TemporaryDirectory() as folder:
            files = {shaft: pathlib.Path(folder) / shaft for shaft in runs}
            for shaft, run in runs.items():
                np.savetxt(files[shaft], np.column_stack(list(run.values())))
            subprocess.run(["gnuplot"], input=PLOT.format(picture=sys.argv[1], title=title, **files), text=True, check=True)
