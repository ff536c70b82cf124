#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Whole runs of gearsim against closed forms and against each other.

    test_gearsim_runs.py GEARSIM [-v] [name of a test]...
"""
import cmath
import math
import os
import pty
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import time
import unittest
from random import Random

sys.dont_write_bytecode = True

import uncounted  # noqa: E402

GEARSIM = os.environ.get("GEARSIM", "gearsim")
OLD_RESULT = "an older result\n"

# The gears of data/paper/ in short runs. K, D and inertias are used by the closed forms below.
K, D, I_W, I_P, LOAD, GAP = 1.05e8, 844.361, 2.1e-3, 1.7e-3, 20.0, 100e-6
PARAMS = f"""\
[gears]
pinion_teeth = 45
wheel_teeth = 41
normal_module_mm = 1.65
normal_pressure_angle_deg = 16
helix_angle_deg = 33
center_distance_mm = 85
face_width_mm = 17.5
backlash_um = 100
pinion_tip_diameter_mm = 93.876780
wheel_tip_diameter_mm = 86.007182
pinion_rack_dedendum = 1.75
wheel_rack_dedendum = 1.75
[mesh]
stiffness_N_per_m = {K}
damping_Ns_per_m = {D}
[bodies]
wheel_inertia_kg_m2 = {I_W}
[drive]
start_rpm = 1000
end_rpm = 1000
[load]
mean_Nm = {LOAD}
[analysis]
duration_s = 0.02
[output]
digits = 17
"""
SIMPLE = ["mesh.model=simple"]
TIGHT = ["solver.relative_tolerance=1e-9", "solver.absolute_tolerance_um=1e-8"]
PLAIN = ["output.oversampling=1"]
VALUES = ["solver.method=erk"]  # whose penetration is always computed by the mesh
TORQUE = ["drive.kind=torque", "drive.torque_Nm=22", f"bodies.pinion_inertia_kg_m2={I_P}"]
STATIC = ["analysis.type=static", "analysis.positions=60"]
RIPPLE = ["drive.ripple=2:3:0, 4.5:2:60", "load.ripple=3:8:0, 1:2:-45"]

# Measured flanks, all different.
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
DATA = os.path.join(ROOT, "data", "paper")
README = os.path.join(ROOT, "README.md")
RESULTS = os.path.join(ROOT, "apps", "gearsim", "docs", "results.md")
MEASURED = [f"flanks.{gear}{key}={DATA}/{gear}_{file}.csv" for gear in ("pinion", "wheel")
            for key, file in (("", "flanks"), ("_pitch", "pitch"))]


class Case(unittest.TestCase):
    """A folder of its own for every test."""

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = self.scratch.name
        with open(self.path("run.ini"), "w") as file:
            file.write(PARAMS)

    def path(self, name):
        return os.path.join(self.folder, name)

    def command(self, settings, *options):
        return [GEARSIM, "run.ini", *options, *[word for text in settings for word in ("--set", text)]]

    def gearsim(self, settings, *options, **others):
        return subprocess.run(self.command(settings, *options), cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=240, **others)

    def text(self, name):
        with open(self.path(name)) as file:
            return file.read()

    def run_columns(self, settings=()):
        """Columns of a run, by name."""
        result = self.gearsim(settings, "--output", "run.csv")
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = [line for line in self.text("run.csv").splitlines() if not line.startswith("#")]
        rows = [[float(field) for field in line.split(",")] for line in lines[1:]]
        return dict(zip(lines[0].split(","), map(list, zip(*rows))))

    def geometry(self, settings=()):
        result = self.gearsim(settings, "--geometry")
        self.assertEqual(result.returncode, 0, result.stderr)
        pairs = [line.split(" = ") for line in result.stdout.splitlines()]
        return {name: float(value) for name, value in pairs}

    def assert_close(self, got, expected, relative=0.0, absolute=0.0, what=""):
        tolerance = relative * abs(expected) + absolute
        self.assertLessEqual(abs(got - expected), tolerance, f"{what}: got {got!r}, expected {expected!r}")

    def assert_all_close(self, got, expected, relative=0.0, absolute=0.0):
        self.assertEqual(len(got), len(expected))
        for i, (one, other) in enumerate(zip(got, expected)):
            self.assert_close(one, other, relative, absolute, f"row {i}")


def listen_to_interrupts():
    """In the child: a shell starts background jobs with SIGINT ignored, and gearsim would leave it so."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def largest_difference(one, other):
    return max(abs(a - b) for a, b in zip(one, other, strict=True))


def spread(values):
    return statistics.pstdev(values)


class Rows(Case):
    def test_rows_stand_at_multiples_of_the_period_up_to_the_end(self):
        for rate, duration, count in [(25600, 0.01, 257), (20000, 0.01, 201), (1000, 0.0105, 11), (3, 1.0, 4)]:
            columns = self.run_columns([f"output.rate_Hz={rate}", f"analysis.duration_s={duration}",
                                        "output.columns=time_s"])
            # Correctly rounded quotients, written with 17 digits: equal to the last bit.
            self.assertEqual(columns["time_s"], [k / rate for k in range(count)])

    def test_head_lines_say_the_eigenfrequency(self):
        self.run_columns(["analysis.duration_s=0.001"])
        noted = [line for line in self.text("run.csv").splitlines() if line.startswith("# eigenfrequency_Hz = ")]
        self.assertEqual(len(noted), 1)
        # Written with 9 digits.
        self.assert_close(float(noted[0].split(" = ")[1]), self.geometry()["eigenfrequency_Hz"], 1e-8)

    def test_same_seed_same_file_and_another_seed_another(self):
        def file(seed):
            self.run_columns(["load.noise_amplitude_Nm=10", f"load.seed={seed}"])
            return [line for line in self.text("run.csv").splitlines() if "load.seed" not in line]

        self.assertEqual(file(7), file(7))
        self.assertNotEqual(file(7), file(8))
        # All 64 bits count.
        self.assertNotEqual(file(7), file(7 + 2**63))

    def columns_of_readme(self, beginning):
        """The columns that README.md names behind these words."""
        with open(README, encoding="utf-8") as file:
            text = " ".join(file.read().split())
        return re.search(re.escape(beginning) + ": `([^`]*)`", text)[1]

    def test_columns_alone_are_those_of_all(self):
        settings = ["load.noise_amplitude_Nm=10"]
        everything = self.run_columns(settings)
        self.assertEqual(", ".join(everything), self.columns_of_readme("A dynamic run writes one row per sample"))
        for name, values in everything.items():
            self.assertEqual(self.run_columns([*settings, f"output.columns={name}"]), {name: values}, name)

    def test_wrench_is_there_on_request_and_in_balance(self):
        names = [f"{gear}_{kind}_{axis}_{unit}" for gear in ("pinion", "wheel")
                 for kind, unit in (("force", "N"), ("moment", "Nm")) for axis in "xyz"]
        with open(RESULTS, encoding="utf-8") as file:
            self.assertIn("`" + ", ".join(names) + "`", " ".join(file.read().split()))
        alpha_t = math.atan(math.tan(math.radians(16)) / math.cos(math.radians(33)))
        m_t = 1.65e-3 / math.cos(math.radians(33))
        r_bp, r_bw = 0.5 * 45 * m_t * math.cos(alpha_t), 0.5 * 41 * m_t * math.cos(alpha_t)
        tan_beta_b = math.tan(math.radians(33)) * math.cos(alpha_t)
        for kind in (PLAIN, [*STATIC, "analysis.positions=7"],
                     [*STATIC, "analysis.positions=7", "analysis.loads=2", "load.end_Nm=30"]):
            plain = self.run_columns(kind)
            self.assertFalse(set(names) & set(plain))
            c = self.run_columns([*kind, "output.wrench=on"])
            self.assertEqual(list(c), list(plain) + names)
            self.assertEqual(c["te_um" if "te_um" in c else "dte_um"], plain["te_um" if "te_um" in c else "dte_um"])
            alone = self.run_columns([*kind, f"output.columns={names[9]},{names[0]}"])
            self.assertEqual(alone, {names[9]: c[names[9]], names[0]: c[names[0]]})
            for k in range(len(c[names[0]])):
                v = {name: c[name][k] for name in names}
                size = abs(v["wheel_force_y_N"])
                if size == 0:
                    continue
                for axis in "xyz":
                    self.assertLess(abs(v[f"pinion_force_{axis}_N"] + v[f"wheel_force_{axis}_N"]), 1e-8 * size)

                # Both middles are in one section: the moments differ by the centre distance alone.
                self.assertLess(abs(v["pinion_moment_x_Nm"] + v["wheel_moment_x_Nm"]), 1e-8 * size)
                self.assertLess(abs(v["pinion_moment_y_Nm"] + v["wheel_moment_y_Nm"] - 0.085 * v["wheel_force_z_N"]),
                                1e-8 * size)

                # Torques by the base radii, and the axial force by the base helix.
                force = math.hypot(v["wheel_force_x_N"], v["wheel_force_y_N"])
                self.assertLess(abs(abs(v["pinion_moment_z_Nm"]) - force * r_bp), 1e-8 * size)
                self.assertLess(abs(abs(v["wheel_moment_z_Nm"]) - force * r_bw), 1e-8 * size)
                self.assertLess(abs(abs(v["wheel_force_z_N"]) - force * tan_beta_b), 1e-8 * size)
                if "te_um" in c:
                    load = c["load_torque_Nm"][k] if "load_torque_Nm" in c else 20
                    self.assertLess(abs(v["wheel_moment_z_Nm"] + load), 1e-8 * load)

    def test_header_says_how_the_result_was_made(self):
        self.run_columns(["load.seed=18446744073709551615"])
        comments = [line for line in self.text("run.csv").splitlines() if line.startswith("#")]
        version = self.gearsim([], "--version").stdout.split()[-1]
        self.assertEqual(comments[0], f"# gearsim {version}")
        for line in ["# load.seed = 18446744073709551615", "# output.digits = 17", "# load.noise_interval_s = 1e-5"]:
            self.assertIn(line, comments)

    def test_columns_belong_together(self):
        """Each column from the others, with plain samples."""
        geometry = self.geometry()
        r_bp, r_bw = geometry["pinion_base_radius_mm"] * 1e-3, geometry["wheel_base_radius_mm"] * 1e-3
        for settings in [PLAIN, PLAIN + TORQUE]:
            c = self.run_columns([*settings, "load.noise_amplitude_Nm=10"])
            # Roundings: of angles of up to 2 rad times 42 mm, 1e-17 m, against x in um: 1e-11.
            self.assert_all_close(c["dte_um"], [(r_bw * w - r_bp * p) * 1e6 for p, w in
                                                zip(c["pinion_angle_rad"], c["wheel_angle_rad"])], absolute=1e-9)
            force = [K * p * 1e-6 + D * r * 1e-6 for p, r in zip(c["penetration_um"], c["penetration_rate_um_per_s"])]
            self.assert_all_close(c["contact_force_N"], force, relative=1e-13)
            self.assertTrue(all(pairs in (3, 4, 5) for pairs in c["pairs_in_contact"]))
            # Noise within its amplitude and the overshoot of a quarter.
            self.assertTrue(all(abs(m - LOAD) < 12.5 for m in c["load_torque_Nm"]))
            self.assertGreater(spread(c["load_torque_Nm"]), 3.0)

    def test_pairs_of_both_flanks_count(self):
        """Total contact ratio 3.96: three to five pairs touch, whichever flank carries."""
        for load in ("20", "-20"):
            for settings in (PLAIN, STATIC):
                pairs = self.run_columns([*settings, f"load.mean_Nm={load}"])["pairs_in_contact"]
                self.assertTrue(all(count in (3, 4, 5) for count in pairs), f"{load}, {settings}: {set(pairs)}")

    def test_filter_neither_delays_nor_damps_what_is_below_its_edge(self):
        """Tooth frequency 150 Hz and some sixty multiples, sampled plainly and filtered: the same."""
        slow = ["drive.start_rpm=200", "drive.end_rpm=200", *TIGHT]
        plain = self.run_columns(slow + PLAIN)
        filtered = self.run_columns(slow)
        for name in ["time_s", "pinion_speed_rpm", "pinion_angle_rad", "wheel_angle_rad", "pairs_in_contact"]:
            self.assertEqual(plain[name], filtered[name])
        # 16 rows at the start see the held past. In the pass band 0.01 % are promised; what the filter rightly
        # takes off are orders above 68: order k has 1/k^2 of the first in the force, whose kinks are
        # rounded, 1/k^3 in the speed and 1/k^4 in the position. A delay of a single sample would be 12 %
        # of a vibration of 2 kHz.
        for name, share in [("contact_force_N", 0.2), ("wheel_speed_rpm", 0.01), ("dte_um", 1e-3)]:
            one, other = plain[name][16:], filtered[name][16:]
            self.assertGreater(spread(one), 0.0)
            self.assertLess(largest_difference(one, other), share * spread(one), name)
            self.assertNotEqual(one, other)


def fourier(values):
    """Discrete Fourier transform of 2^n values."""
    if len(values) == 1:
        return values
    even, odd = fourier(values[0::2]), fourier(values[1::2])
    turned = [cmath.exp(-2j * math.pi * k / len(values)) * value for k, value in enumerate(odd)]
    return [a + b for a, b in zip(even, turned)] + [a - b for a, b in zip(even, turned)]


class Means(Case):
    """Filtered samples of force and load are means: the force from the momentum of the bodies."""
    SPUR = ["gears.pinion_teeth=24", "gears.wheel_teeth=60", "gears.normal_module_mm=3", "gears.helix_angle_deg=0",
            "gears.normal_pressure_angle_deg=20", "gears.center_distance_mm=126", "gears.face_width_mm=30",
            "gears.pinion_tip_diameter_mm=78", "gears.wheel_tip_diameter_mm=186", "mesh.stiffness_N_per_m=3e8",
            "mesh.damping_Ns_per_m=2000", "bodies.wheel_inertia_kg_m2=3e-2", "load.mean_Nm=400"]
    DRAG = ["bodies.pinion_drag_Nms=0.02", "bodies.wheel_drag_Nms=0.05", "load.per_speed_Nms=0.1",
            "load.per_speed_squared_Nms2=1e-4", "drive.torque_Nm=90"]

    def test_force_is_that_of_the_penetration(self):
        """Contact is not lost: K penetration + D rate of each row, both filtered from values, is the force."""
        firm = [*VALUES, "load.mean_Nm=80", "load.noise_amplitude_Nm=10", "drive.start_rpm=3000", "drive.end_rpm=4000", *TIGHT]
        simple = self.geometry(SIMPLE)["transverse_contact_ratio"]
        for settings, factor in [([], 1), (TORQUE, 1), (["load.mean_Nm=-80"], 1), (SIMPLE, simple),
                                 ([*SIMPLE, *TORQUE], simple), (["drive.start_rpm=-3000"], 1),
                                 (["load.noise_interval_s=1e-7"], 1), (["output.oversampling=16"], 1),
                                 (self.DRAG, 1), ([*TORQUE, *self.DRAG], 1), (RIPPLE, 1), ([*TORQUE, *RIPPLE], 1)]:
            c = self.run_columns([*firm, *settings])
            force = [factor * (K * p + D * r) * 1e-6
                     for p, r in zip(c["penetration_um"], c["penetration_rate_um_per_s"])]
            self.assertGreater(min(map(abs, force)), 100.0)
            # The rows at the start see the held past: a value of the one, a mean of the other. Noise beyond the
            # rate of the samples folds into the one only.
            self.assertLess(largest_difference(c["contact_force_N"][16:], force[16:]),
                            0.02 * spread(force), settings)
            self.assertGreater(spread(force), 1.0)

    def test_penetration_is_that_of_the_mesh(self):
        """Where the flanks carry, it follows from the force; the same as values, sampled more often to have no aliases."""
        overlap = [*TIGHT, "output.columns=penetration_um,penetration_rate_um_per_s", "load.noise_amplitude_Nm=10"]
        rough = [*MEASURED, "analysis.duration_s=0.02", "drive.start_rpm=2000", "drive.end_rpm=4000"]
        firm, loose = [*rough, "load.mean_Nm=80", "flanks.scale=0.3"], [*rough, "load.mean_Nm=10"]
        # Spur gears: their jumps have lines beyond 64 times the rate too.
        for settings, share in [(firm, 5e-4), (["load.mean_Nm=-80", *TORQUE], 5e-4), (loose, 5e-4), (self.SPUR, 5e-3)]:
            c = self.run_columns([*overlap, *settings])
            expected = self.run_columns([*overlap, *settings, *VALUES, "output.oversampling=64"])
            for name, values in expected.items():
                difference = [a - b for a, b in zip(c[name], values)][16:]
                self.assertLess(statistics.pstdev(difference), share * spread(values), (settings, name))

    def test_force_carries_load_and_drag(self):
        """Over whole tooth periods x'' vanishes in the mean, and F r_bw is load and drag."""
        # 24 teeth at 3000 rpm and 45 at 1600 pass 1200 times per second, in the last 0.16 s 192 times.
        for settings, rpm, ratio, mean in [(self.SPUR, 3000, 24 / 60, 400), ([], 1600, 45 / 41, 20)]:
            for rate in (25600, 4000):
                drag = mean / 400
                run = [*settings, f"drive.start_rpm={rpm}", f"drive.end_rpm={rpm}", "analysis.duration_s=0.2",
                       f"output.rate_Hz={rate}", f"bodies.wheel_drag_Nms={0.5 * drag}", f"load.per_speed_Nms={drag}",
                       f"load.per_speed_squared_Nms2={0.01 * drag}", "output.columns=contact_force_N,load_torque_Nm"]
                c = self.run_columns(run)
                r_bw, speed = self.geometry(run)["wheel_base_radius_mm"] * 1e-3, rpm * ratio * math.pi / 30
                load, force = c["load_torque_Nm"][-rate * 16 // 100:], c["contact_force_N"][-rate * 16 // 100:]
                followed = drag * (speed + 0.01 * speed**2)
                self.assert_close(statistics.fmean(load), mean + followed, relative=1e-4)
                self.assert_close(statistics.fmean(force) * r_bw, mean + followed + 0.5 * drag * speed, relative=2e-4)

    def test_force_balances_the_load_in_the_mean(self):
        """x'' vanishes in the mean: F r_bw is the load, row by row, where it changes slowly."""
        c = self.run_columns(["load.noise_amplitude_Nm=2", "load.noise_interval_s=5e-3", "analysis.duration_s=0.1",
                              *SIMPLE, *TIGHT])
        r_bw = self.geometry()["wheel_base_radius_mm"] * 1e-3
        # The inertia takes (2 pi 50 Hz / w0)^2 = 6e-4 of the change; 2000 Hz rings in where the noise begins.
        for force, load in list(zip(c["contact_force_N"], c["load_torque_Nm"]))[1000:]:
            self.assert_close(force * r_bw, load, absolute=0.02)
        self.assertGreater(spread(c["load_torque_Nm"]), 0.5)

    def test_spur_gears_show_tooth_orders_alone(self):
        """A force that jumps has lines far beyond any rate; what folds back is no order."""
        for rpm in (7123.4, 11811.1):
            c = self.run_columns([*self.SPUR, f"drive.start_rpm={rpm}", f"drive.end_rpm={rpm}", "analysis.duration_s=0.21",
                                  "output.columns=contact_force_N,penetration_um"])
            size, mesh = 4096, 24 * rpm / 60 / 25600
            # Blackman-Harris, four terms: side lobes of -92 dB beyond four places.
            window = [0.35875 - 0.48829 * math.cos(2 * math.pi * k / size) + 0.14128 * math.cos(4 * math.pi * k / size)
                      - 0.01168 * math.cos(6 * math.pi * k / size) for k in range(size)]
            for name, values in c.items():
                mean = statistics.fmean(values[-size:])
                lines = [abs(value) for value in fourier([(v - mean) * w for v, w in zip(values[-size:], window)])]
                first = max(lines[k] for k in range(size // 2) if abs(k - mesh * size) < 5)
                other = [lines[k] for k in range(8, int(0.4 * size))
                         if abs(k / size / mesh - round(k / size / mesh)) * mesh * size > 6]
                self.assertLess(20 * math.log10(max(other) / first), -50.0, (rpm, name))


class ClosedForms(Case):
    def test_simple_model_at_constant_acceleration_rests(self):
        """x'' = 0 from the start: the penetration carries load and acceleration torque for ever."""
        g = self.geometry(SIMPLE)
        ratio = g["pinion_base_radius_mm"] / g["wheel_base_radius_mm"]
        acceleration = 1000 * 2 * math.pi / 60 / 0.02 * ratio
        force = (LOAD + I_W * acceleration) / (g["wheel_base_radius_mm"] * 1e-3)
        dte = -(GAP / 2 + force / (K * g["transverse_contact_ratio"])) * 1e6
        c = self.run_columns([*SIMPLE, "drive.start_rpm=0", "drive.end_rpm=1000"])
        # The solver may use its tolerance of 1e-4 um + 1e-4 of the penetration; it starts at rest, to rounding.
        self.assert_all_close(c["dte_um"], [dte] * len(c["dte_um"]), absolute=1e-6)
        self.assert_all_close(c["contact_force_N"], [force] * len(c["dte_um"]), relative=1e-6)
        self.assert_all_close(c["pinion_speed_rpm"], [50000 * t for t in c["time_s"]], relative=1e-14)

    def test_drag_and_load_over_speed_are_carried_from_the_start(self):
        """At constant speed nothing moves: F r_bw = mean + c w + c2 w |w| + c_w w, of which the drag is not in the load."""
        g = self.geometry(SIMPLE)
        r_bw = g["wheel_base_radius_mm"] * 1e-3
        ratio = g["pinion_base_radius_mm"] / g["wheel_base_radius_mm"]
        for rpm in (3000, -3000):
            for c, c2, drag in [(0.05, 0, 0), (0, 2e-4, 0), (0, 0, 0.07), (0.05, 2e-4, 0.07)]:
                speed = rpm * math.pi / 30 * ratio
                load = LOAD + c * speed + c2 * speed * abs(speed)
                force = (load + drag * speed) / r_bw
                settings = [*SIMPLE, f"drive.start_rpm={rpm}", f"drive.end_rpm={rpm}", f"load.per_speed_Nms={c}",
                            f"load.per_speed_squared_Nms2={c2}", f"bodies.wheel_drag_Nms={drag}"]
                for samples in (PLAIN, []):
                    columns = self.run_columns([*settings, *samples])
                    # It starts at rest, to rounding, and x may be off by 1e-4 um + 1e-4 of 2 um.
                    rows = len(columns["time_s"])
                    self.assert_all_close(columns["contact_force_N"], [force] * rows, relative=1e-6, absolute=1e-3)
                    self.assert_all_close(columns["load_torque_Nm"], [load] * rows, relative=1e-6)

    def test_drag_brings_a_run_up_to_its_end_speed(self):
        """Both bodies as one: I w' = M - C w with I and C about the pinion's axis."""
        g = self.geometry(SIMPLE)
        ratio = g["pinion_base_radius_mm"] / g["wheel_base_radius_mm"]
        settings = ["bodies.pinion_drag_Nms=0.03", "bodies.wheel_drag_Nms=0.02", "load.per_speed_Nms=0.04"]
        inertia, drag = I_P + I_W * ratio**2, 0.03 + (0.02 + 0.04) * ratio**2
        start, last = 40.0, (22.0 - LOAD * ratio) / drag
        c = self.run_columns([*SIMPLE, *TORQUE, *TIGHT, *PLAIN, *settings, f"drive.start_rpm={start * 30 / math.pi!r}",
                              "analysis.duration_s=0.2"])
        for t, rpm, load in zip(c["time_s"], c["pinion_speed_rpm"], c["load_torque_Nm"]):
            now = last + (start - last) * math.exp(-drag / inertia * t)
            # The force falls by C_w w' / r_bw = 2 kN/s, x by 7 um/s, which the vibrations of the start have as well.
            self.assert_close(rpm * math.pi / 30, now, absolute=2e-4, what=f"t = {t}")
            self.assert_close(load, LOAD + 0.04 * ratio * now, absolute=2e-5, what=f"t = {t}")
        self.assertGreater(abs(now - start), 10.0)

    def test_ideal_flanks_stay_near_the_mean_penetration(self):
        g = self.geometry()
        expected = -(GAP / 2 + LOAD / (g["wheel_base_radius_mm"] * 1e-3 * K * g["transverse_contact_ratio"])) * 1e6
        c = self.run_columns()
        # The contact length varies by some percent (c_1 = 0.5 %, c_2, ..), the penetration of 2.35 um alike.
        self.assert_close(statistics.fmean(c["dte_um"]), expected, absolute=0.05)
        self.assertGreater(spread(c["dte_um"]), 1e-4)

    def test_integer_overlap_has_no_tooth_excitation(self):
        """The total contact length is constant then, and nothing moves."""
        overlap = self.geometry()["overlap_ratio"]
        integer = [f"gears.face_width_mm={17.5 * 2 / overlap!r}"]
        self.assert_close(self.geometry(integer)["overlap_ratio"], 2.0, relative=1e-14)
        still, moving = self.run_columns(integer), self.run_columns()
        # Forces of 524 N: left is what the tolerance of 1e-4 um makes of rounding errors, K eps 1e-4 um = 0.02 N.
        self.assertLess(spread(still["contact_force_N"]), 1e-3)
        self.assertGreater(spread(moving["contact_force_N"]), 1.0)

    def test_torque_speeds_up_both_bodies_as_one(self):
        g = self.geometry(SIMPLE)
        ratio = g["pinion_base_radius_mm"] / g["wheel_base_radius_mm"]
        alpha = (22.0 - LOAD * ratio) / (I_P + I_W * ratio**2)
        for start in (0.0, 3000.0):
            c = self.run_columns([*SIMPLE, *TORQUE, *TIGHT, *PLAIN, f"drive.start_rpm={start}", "analysis.duration_s=0.2"])
            speed = start * 2 * math.pi / 60
            for t, rpm, wheel, angle in zip(c["time_s"], c["pinion_speed_rpm"], c["wheel_speed_rpm"],
                                            c["pinion_angle_rad"]):
                # Tolerances of 1e-8 um per step add up over some hundred steps, of arcs of 1e4 um and more.
                now = speed + alpha * t
                self.assert_close(rpm * math.pi / 30, now, relative=1e-9, absolute=1e-9, what=f"t = {t}")
                self.assert_close(wheel, rpm * ratio, relative=1e-9, absolute=1e-9, what=f"t = {t}")
                self.assert_close(angle, speed * t + alpha * t * t / 2, relative=1e-9, absolute=1e-9, what=f"t = {t}")

    def test_torque_with_contact_changing_keeps_the_momentum_balance(self):
        """Whatever the mesh does, its force cancels in I_p phi_p'' / r_bp + I_w phi_w'' / r_bw."""
        g = self.geometry()
        r_bp, r_bw = g["pinion_base_radius_mm"] * 1e-3, g["wheel_base_radius_mm"] * 1e-3
        c = self.run_columns([*TORQUE, *TIGHT, *PLAIN, "drive.start_rpm=3000", "analysis.duration_s=0.1"])
        momenta = [(I_P * p / r_bp + I_W * w / r_bw) * math.pi / 30
                   for p, w in zip(c["pinion_speed_rpm"], c["wheel_speed_rpm"])]
        for t, momentum in zip(c["time_s"], momenta):
            # About 30 N s; errors of the speeds, 2e-7 um w0 per step over some thousand steps, make 1e-6 of it.
            self.assert_close(momentum, momenta[0] + (22.0 / r_bp - LOAD / r_bw) * t, relative=1e-7, what=f"t = {t}")
        self.assertGreater(spread(c["contact_force_N"]), 1.0)

    def test_slow_turning_follows_the_static_transmission_error(self):
        static = self.run_columns(STATIC)
        # One pitch in 60 rows: 1 rpm makes 0.75 pitches per second.
        dynamic = self.run_columns([*PLAIN, "drive.start_rpm=1", "drive.end_rpm=1", "output.rate_Hz=45",
                                    "analysis.duration_s=1.32", *TIGHT])
        self.assert_all_close(dynamic["pinion_angle_rad"][:60], static["pinion_angle_rad"], absolute=1e-14)
        # Kinks of the curve ring at (0.75 Hz / 2 kHz)^2 of its 0.1 um; damping lags by as little.
        self.assert_all_close(dynamic["dte_um"][:60], static["te_um"], absolute=1e-5)
        self.assertGreater(spread(static["te_um"]), 1e-3)


class Tables(Case):
    """Speeds and torques over time."""

    def table(self, name, column, rows):
        with open(self.path(name), "w") as file:
            file.write(f"# a table\ntime_s,{column}\n" + "".join(f"{t!r}, {v!r}\n" for t, v in rows))
        return name

    def run_with(self, settings, drop=(), **tables):
        """A run with tables {section: (column, rows)} in the place of numbers."""
        names = {"drive": ["start_rpm", "end_rpm"], "load": ["mean_Nm"]}
        dropped = [f"{section}.{key}=" for section in tables for key in names[section]]
        files = [f"{section}.file={self.table(section + '.csv', *given)}" for section, given in tables.items()]
        return self.run_columns([*dropped, *files, *settings])

    def test_straight_table_is_the_run_up(self):
        for kind in ([], [*TORQUE, "drive.start_rpm=500"]):
            tight = ["solver.relative_tolerance=1e-10", "solver.absolute_tolerance_um=1e-9"]
            ramp = [*PLAIN, *tight, "drive.start_rpm=500", "drive.end_rpm=4500", *kind]
            expected = self.run_columns(ramp)
            for interpolation in ("linear", "cubic"):
                given = ("speed_rpm", [(-0.01, -1500.0), (0.005, 1500.0), (0.03, 6500.0)]) if not kind else (
                    "torque_Nm", [(0.0, 22.0), (0.01, 22.0), (0.02, 22.0)])
                keys = ["drive.torque_Nm=", "drive.start_rpm=500"] if kind else []
                c = self.run_with([*PLAIN, *tight, *kind, *keys, f"drive.interpolation={interpolation}"], drive=given,
                                  load=("torque_Nm", [(-1.0, LOAD), (3.0, LOAD)]))
                for name in expected:
                    # The solver stops at the rows, so that its steps differ: each run is off by 1e-4 of the rate.
                    size = max(map(abs, expected[name]))
                    self.assert_all_close(c[name], expected[name], absolute=3e-4 * size)
                if not kind:
                    self.assert_all_close(c["pinion_speed_rpm"], expected["pinion_speed_rpm"], absolute=1e-9)
                    self.assert_all_close(c["pinion_angle_rad"], expected["pinion_angle_rad"], absolute=1e-12)

    def test_step_of_the_load_rings_down(self):
        """Clunk in firm contact: x goes from one equilibrium to the other as a damped vibration."""
        g = self.geometry(SIMPLE)
        r_bw, factor = g["wheel_base_radius_mm"] * 1e-3, g["transverse_contact_ratio"]
        w0 = math.sqrt(K * factor * r_bw**2 / I_W)
        decay = D * factor * r_bw**2 / I_W / 2
        turned = math.sqrt(w0**2 - decay**2)
        at = 0.0031234567
        rows = [(0.0, 20.0), (at, 20.0), (at, 60.0), (1.0, 60.0)]
        for method in ("adams", "bdf", "erk"):
            c = self.run_with([*SIMPLE, *PLAIN, *TIGHT, f"solver.method={method}"], load=("torque_Nm", rows))
            for t, dte, load in zip(c["time_s"], c["dte_um"], c["load_torque_Nm"]):
                s = max(t - at, 0.0)
                share = math.exp(-decay * s) * (math.cos(turned * s) + decay / turned * math.sin(turned * s))
                x = GAP / 2 + (60.0 - 40.0 * share) / (r_bw * K * factor)
                # Tolerances of 1e-9 of 2 um add up over some hundred steps.
                self.assert_close(-dte, x * 1e6, absolute=1e-5 if method == "bdf" else 2e-6, what=f"{method}, t = {t}")
                self.assertEqual(load, 20.0 if t < at else 60.0)

    def test_short_pulse_at_rest_is_not_passed_over(self):
        """Ahead of it nothing moves and steps are long; its torque times its time is the wheel's momentum."""
        rows = [(0.0, 20.0), (0.01, 20.0), (0.01001, 120.0), (0.01002, 20.0), (1.0, 20.0)]
        for method in ("adams", "erk"):
            c = self.run_with([*SIMPLE, *PLAIN, *TIGHT, f"solver.method={method}"], load=("torque_Nm", rows))
            speed = 0.5 * 2e-5 * 100 / I_W * 30 / math.pi
            fall = [c["wheel_speed_rpm"][0] - w for w in c["wheel_speed_rpm"]]
            # The vibration of 3 kHz and 5 % begins with this amplitude: its first extreme is at the first row behind.
            self.assert_close(max(fall), speed, relative=0.1)

    def test_repeated_table_is_a_long_one(self):
        period = 0.0037
        rows = [(0.0, 20.0), (0.001, 40.0), (0.002, 40.0), (0.002, 25.0), (period, 30.0)]
        long_rows = [(round(t + k * period, 9), v) for k in range(7) for t, v in rows]
        for interpolation in ("linear", "cubic"):
            settings = [*PLAIN, *TIGHT, f"load.interpolation={interpolation}"]
            once = self.run_with(settings, load=("torque_Nm", long_rows))
            again = self.run_with([*settings, "load.repeat=on"], load=("torque_Nm", rows))
            self.assert_all_close(again["load_torque_Nm"], once["load_torque_Nm"], absolute=1e-10)
            self.assert_all_close(again["dte_um"], once["dte_um"], absolute=1e-4)

    def test_cubic_goes_through_parabolas(self):
        """Three neighbours give the slope of a parabola exactly: 5 + 3000 t - 1e5 t^2 with uneven rows."""
        rows = [(t, 5 + 3000 * t - 1e5 * t**2) for t in (-0.002, 0.0, 0.003, 0.0035, 0.009, 0.014, 0.022, 0.03)]
        c = self.run_with([*SIMPLE, *PLAIN, "load.interpolation=cubic"], load=("torque_Nm", rows))
        self.assert_all_close(c["load_torque_Nm"], [5 + 3000 * t - 1e5 * t**2 for t in c["time_s"]], absolute=1e-11)
        linear = self.run_with([*SIMPLE, *PLAIN], load=("torque_Nm", rows))
        self.assertGreater(largest_difference(linear["load_torque_Nm"], c["load_torque_Nm"]), 0.5)

    def test_means_hold_steps_and_slopes(self):
        """Filtered rows have the integral of the table, and the force that of the momentum."""
        rows = [(0.0, 20.0), (0.0051234, 20.0), (0.0051234, 50.0), (0.012, 80.0), (0.012, 30.0), (0.3, 30.0)]
        integral = 20 * 0.0051234 + 65 * (0.012 - 0.0051234) + 30 * 0.008
        for settings in ([], SIMPLE, ["drive.start_rpm=900", *TORQUE]):
            c = self.run_with([*settings, *TIGHT, *VALUES], load=("torque_Nm", rows))
            # Half a row at each end belongs to other rows; the value is that of the ends.
            total = sum(c["load_torque_Nm"]) - 0.5 * (20 + 30)
            self.assert_close(total / 25600, integral, relative=2e-6)
            factor = self.geometry(SIMPLE)["transverse_contact_ratio"] if settings == SIMPLE else 1
            force = [factor * (K * p + D * r) * 1e-6
                     for p, r in zip(c["penetration_um"], c["penetration_rate_um_per_s"])]
            # x'' steps with the load, and the one is a box mean over 1e-5 s, the other a value.
            self.assertLess(largest_difference(c["contact_force_N"][16:], force[16:]), 0.04 * spread(force))

    def test_means_of_a_drive_with_kinks(self):
        given = ("speed_rpm", [(0.0, 1000.0), (0.006, 3000.0), (0.013, 2500.0), (0.5, 2500.0)])
        spur = [*Means.SPUR, "load.mean_Nm=900"]
        for settings, absolute in (([], 0.0), (spur, 2.0)):
            for interpolation in ("linear", "cubic"):
                c = self.run_with([*settings, f"drive.interpolation={interpolation}", "load.mean_Nm=900", *TIGHT, *VALUES],
                                  drive=given)
                k, d = (3e8, 2000) if settings else (K, D)
                force = [(k * p + d * r) * 1e-6 for p, r in zip(c["penetration_um"], c["penetration_rate_um_per_s"])]
                # Helical teeth: row by row. Spur teeth jump, and only the means of some rows agree.
                if settings:
                    pairs = [(statistics.fmean(c["contact_force_N"][i:i + 64]), statistics.fmean(force[i:i + 64]))
                             for i in range(32, 400, 64)]
                    for one, other in pairs:
                        self.assert_close(one, other, relative=0.01)
                else:
                    self.assertLess(largest_difference(c["contact_force_N"][16:], force[16:]), 0.02 * spread(force))

    def test_reversal_through_zero_speed(self):
        """The load follows the speed and its sign: the other flank carries after the reversal."""
        given = ("speed_rpm", [(0.0, 3000.0), (0.02, 3000.0), (0.12, -3000.0), (0.2, -3000.0)])
        c = self.run_with(["analysis.duration_s=0.2", "load.mean_Nm=0", "load.per_speed_Nms=0.1", *PLAIN], drive=given)
        g = self.geometry()
        r_bw, ratio = g["wheel_base_radius_mm"] * 1e-3, g["pinion_base_radius_mm"] / g["wheel_base_radius_mm"]
        speed = 3000 * math.pi / 30 * ratio
        rows = {t: k for k, t in enumerate(c["time_s"])}
        for at, sign in ((0.015, 1), (0.195, -1)):
            k = rows[at]
            force = statistics.fmean(c["contact_force_N"][k - 100:k + 100])
            self.assert_close(force, sign * 0.1 * speed / r_bw, relative=1e-2)
        # The flanks change where the deceleration's torque takes the load over, before the speed is zero.
        zero = next(t for t, f in zip(c["time_s"], c["contact_force_N"]) if t > 0.021 and f <= 0)
        self.assertLess(zero, 0.07)


class Ripple(Case):
    """Harmonics of the pinion's turn, in what drives and what loads."""

    def vibration(self, t, w0, decay, rate, drive, phase):
        """x and x' at t of x'' + 2 decay x' + w0^2 x = drive cos(rate t + phase) without free vibration."""
        response = drive / complex(w0**2 - rate**2, 2 * decay * rate) * cmath.exp(1j * (rate * t + phase))
        return response.real, (1j * rate * response).real

    def test_speed_and_load_ripple_shake_the_simple_model(self):
        """In firm contact it is linear: forced vibrations, and the free one that leaves x' = x'' = 0 at the start."""
        g = self.geometry(SIMPLE)
        r_bp, r_bw = g["pinion_base_radius_mm"] * 1e-3, g["wheel_base_radius_mm"] * 1e-3
        factor, w = g["transverse_contact_ratio"], 3000 * math.pi / 30
        w0, decay = math.sqrt(K * factor * r_bw**2 / I_W), D * factor * r_bw**2 / I_W / 2
        turned = math.sqrt(w0**2 - decay**2)
        speed, phase, load, load_phase = 4 * math.pi / 30, math.radians(30), 3.0, math.radians(-60)
        settings = [*SIMPLE, *TIGHT, *PLAIN, "drive.start_rpm=3000", "drive.end_rpm=3000", "load.mean_Nm=60"]

        for order, drive, at, ripple in [
                (2, r_bp * speed * 2 * w, phase, "drive.ripple=2:4:30"),
                (7, r_bw * load / I_W, load_phase - math.pi / 2, "load.ripple=7:3:-60")]:
            c = self.run_columns([*settings, ripple])
            mean = GAP / 2 + 60.0 / (r_bw * K * factor)
            x0, rate0 = self.vibration(0.0, w0, decay, order * w, drive, at)
            # Where x' = x'' = 0 the spring holds what acts at t = 0.
            start = drive * math.cos(at) / w0**2
            a, b = start - x0, (-rate0 + decay * (start - x0)) / turned
            for t, dte, rpm in zip(c["time_s"], c["dte_um"], c["pinion_speed_rpm"]):
                free = math.exp(-decay * t) * (a * math.cos(turned * t) + b * math.sin(turned * t))
                x = mean + self.vibration(t, w0, decay, order * w, drive, at)[0] + free
                # The load's angle is the pinion's own. Tolerances of 1e-9 of 6 um add up over some hundred steps.
                self.assert_close(-dte, x * 1e6, absolute=1e-5, what=f"{ripple}, t = {t}")
                shown = 3000 + (4 * math.sin(2 * w * t + phase) if order == 2 else 0)
                self.assert_close(rpm, shown, absolute=1e-9)
            if order == 7:
                self.assert_all_close(c["load_torque_Nm"], [60 + load * math.sin(7 * p + load_phase)
                                                            for p in c["pinion_angle_rad"]], absolute=1e-11)

    def test_ripple_of_a_torque_does_work(self):
        """Both bodies as one: kinetic energy is what drive and load have done since the start, by the angle alone."""
        g = self.geometry(SIMPLE)
        ratio = g["pinion_base_radius_mm"] / g["wheel_base_radius_mm"]
        inertia, start = I_P + I_W * ratio**2, 50.0
        c = self.run_columns([*SIMPLE, *TORQUE, *TIGHT, *PLAIN, "drive.torque_Nm=60", "drive.ripple=1:4:20, 3.5:2:0",
                              "load.ripple=2:5:-70", f"drive.start_rpm={start * 30 / math.pi!r}",
                              "analysis.duration_s=0.1"])

        def work(amplitude, order, phase, angle):
            return amplitude / order * (math.cos(phase) - math.cos(order * angle + phase))

        for p, rpm in zip(c["pinion_angle_rad"], c["pinion_speed_rpm"]):
            done = (60 - LOAD * ratio) * p + work(4, 1, math.radians(20), p) + work(2, 3.5, 0, p) \
                - ratio * work(5, 2, math.radians(-70), p)
            # x moves by some 0.1 um at 10 krad/s, with which the pinion's speed is off by 0.02 rad/s.
            self.assert_close(rpm * math.pi / 30, math.sqrt(start**2 + 2 * done / inertia), absolute=0.03)
        self.assertGreater(c["pinion_angle_rad"][-1], 20.0)

    def test_start_carries_the_ripple(self):
        """The first force is in equilibrium with mean, ripple, drag and the torque of the ripple's acceleration."""
        g = self.geometry()
        r_bp, r_bw = g["pinion_base_radius_mm"] * 1e-3, g["wheel_base_radius_mm"] * 1e-3
        w = 1000 * math.pi / 30
        acceleration = (3 * 2 * w * math.cos(0) + 2 * 4.5 * w * math.cos(math.radians(60))) * math.pi / 30 * r_bp / r_bw
        speed = (1000 + 2 * math.sin(math.radians(60))) * math.pi / 30 * r_bp / r_bw
        load = LOAD + 8 * math.sin(0) + 2 * math.sin(math.radians(-45))
        force = (load + I_W * acceleration + 0.02 * speed) / r_bw
        for samples in (PLAIN, []):
            c = self.run_columns([*RIPPLE, *TIGHT, *samples, "bodies.wheel_drag_Nms=0.02"])
            # A filtered row has means over 1e-5 s about it, on one side those of the start.
            self.assert_close(c["contact_force_N"][0], force, relative=1e-9 if samples else 1e-2)
            if samples:
                self.assert_close(c["load_torque_Nm"][0], load, relative=1e-12)

    def test_table_and_ripple_add_up(self):
        self.write_table("speed", "speed_rpm", [(-0.01, 1500.0), (0.003, 1500.0), (0.008, 2500.0), (0.03, 2500.0)])
        c = self.run_columns([*PLAIN, "drive.start_rpm=", "drive.end_rpm=", "drive.file=speed", "drive.ripple=3:30:10"])
        angle = 0.0
        for t, rpm, phi in zip(c["time_s"], c["pinion_speed_rpm"], c["pinion_angle_rad"]):
            ramp = min(max(t - 0.003, 0.0), 0.005)
            steady = (1500 * t + 1e5 * ramp**2 + 1000 * max(t - 0.008, 0.0)) * math.pi / 30
            expected = 1500 + 2e5 * ramp + 30 * math.sin(3 * steady + math.radians(10))
            self.assert_close(rpm, expected, absolute=1e-9)
            # The integral by the trapezoid of the rows: h^2 / 12 of the change of the slope, 9e4 rpm/s.
            if t > 0:
                angle += 0.5 * (rpm + before) * math.pi / 30 / 25600
            before = rpm
            self.assert_close(phi, angle, absolute=(1 / 25600)**2 / 12 * 3e5 * math.pi / 30)

    def write_table(self, name, column, rows):
        with open(self.path(name), "w") as file:
            file.write(f"time_s,{column}\n" + "".join(f"{t!r},{v!r}\n" for t, v in rows))


class Stop(Case):
    """A torque-driven run that ends where the pinion has reached a speed."""
    RUN_UP = [*TORQUE, "drive.torque_Nm=60", "analysis.duration_s=1", "output.rate_Hz=5000", "drive.start_rpm=1000"]

    def test_last_row_is_the_first_at_or_beyond(self):
        for settings, stop, sign in [([], 1500, 1), (PLAIN, 1500, 1), (["drive.torque_Nm=-30"], 700, -1),
                                     ([*PLAIN, "drive.torque_Nm=-30"], 0, -1), (["output.oversampling=16"], 1203.4, 1)]:
            with self.subTest((settings, stop)):
                run = [*self.RUN_UP, *settings]
                whole = self.run_columns([*run, "analysis.duration_s=0.1"])
                c = self.run_columns([*run, f"analysis.stop_rpm={stop}"])
                speeds = c["pinion_speed_rpm"]
                self.assertGreaterEqual(sign * (speeds[-1] - stop), 0)
                self.assertTrue(all(sign * (speed - stop) < 0 for speed in speeds[:-1]))
                # Up to there it is the run without the stop, filtered with what comes behind.
                count = len(speeds)
                self.assertGreater(count, 10)
                for name in c:
                    self.assertEqual(c[name], whole[name][:count], name)

    def test_speed_need_not_be_a_column(self):
        c = self.run_columns([*self.RUN_UP, "analysis.stop_rpm=1500"])
        for columns in ("time_s", "time_s,load_torque_Nm"):
            one = self.run_columns([*self.RUN_UP, "analysis.stop_rpm=1500", f"output.columns={columns}"])
            self.assertEqual(one["time_s"], c["time_s"])

    def test_speed_that_is_not_reached_is_told(self):
        result = self.gearsim([*self.RUN_UP, "analysis.duration_s=0.01", "analysis.stop_rpm=5000"], "--output", "run.csv")
        self.assertEqual(result.returncode, 0)
        self.assertIn("analysis.stop_rpm: warning: not reached within analysis.duration_s", result.stderr)

    def test_reversal_through_zero_speed(self):
        """A torque against the motion: both bodies as one slow down, stop, and go back, on the other flanks."""
        g = self.geometry()
        ratio = g["pinion_base_radius_mm"] / g["wheel_base_radius_mm"]
        c = self.run_columns([*TORQUE, *PLAIN, "drive.start_rpm=300", "drive.torque_Nm=-5", "load.mean_Nm=0",
                              "analysis.duration_s=1", "analysis.stop_rpm=-300", "output.rate_Hz=5000"])
        fall = 5 / (I_P + I_W * ratio**2) * 30 / math.pi
        self.assert_close(c["time_s"][-1], 600 / fall, absolute=1e-3)
        # The backlash is crossed at the start, so that the pinion alone turns for a while, and bounces.
        for t, rpm in list(zip(c["time_s"], c["pinion_speed_rpm"]))[len(c["time_s"]) // 2:]:
            self.assert_close(rpm, 300 - fall * t, absolute=3.0)
        self.assertLess(max(c["contact_force_N"][-50:]), 0)


class Rattle(Case):
    """Rough teeth that part and meet again, without noise: in flight no error estimate limits a step."""
    LIGHT = ["load.mean_Nm=3", "drive.start_rpm=3000", "drive.end_rpm=3001", "analysis.duration_s=0.012", *PLAIN,
             "output.columns=contact_force_N"]

    def roughen(self, seed):
        """Deviations of some micrometres that change from node to node, on all teeth of both gears."""
        random = Random(seed)
        self.rough = []
        for gear, teeth in (("pinion", 45), ("wheel", 41)):
            with open(self.path(gear), "w") as file:
                file.write("tooth,flank,t1,t2,deviation_um\n")
                for tooth in range(teeth):
                    for flank in ("drive", "coast"):
                        pitch = random.uniform(-4, 4)
                        for node in range(35):
                            deviation = pitch + random.uniform(-6, 6)
                            file.write(f"{tooth},{flank},{node // 7 / 4},{node % 7 / 6:.9f},{deviation:.6f}\n")
            self.rough.append(f"flanks.{gear}={gear}")

    def force(self, tolerance, *others):
        return self.run_columns([*self.rough, *self.LIGHT, f"solver.relative_tolerance={tolerance}",
                                 f"solver.absolute_tolerance_um={tolerance}", *others])["contact_force_N"]

    def assert_converges(self, *others):
        """Against steps so short that they do not miss a touch."""
        exact = self.force(1e-10, "solver.max_step_s=5e-7", *others)
        scale = max(map(abs, exact))
        self.assertGreater(exact.count(0.0), 60, others)  # of 308: teeth do part
        self.assertGreater(scale, 100.0)
        for tolerance, limit in ((1e-6, 2e-2), (1e-8, 1e-3), (1e-10, 1e-4)):
            error = largest_difference(self.force(tolerance, *others), exact) / scale
            self.assertLess(error, limit, f"{others}, tolerance {tolerance}")

    def test_force_converges_with_the_tolerance(self):
        self.roughen(5)
        for method in ("adams", "bdf", "erk"):
            self.assert_converges(f"solver.method={method}")

    def test_a_torque_driven_pinion_converges_too(self):
        self.roughen(5)
        self.assert_converges("drive.kind=torque", "drive.torque_Nm=3.3", f"bodies.pinion_inertia_kg_m2={I_P}")

    def test_other_flanks_and_other_direction(self):
        self.roughen(1)
        self.assert_converges("load.mean_Nm=-3")
        self.assert_converges("drive.start_rpm=-3000", "drive.end_rpm=-3001")

    def test_the_lookup_converges_too(self):
        self.roughen(5)
        self.assert_converges("solver.lookup=always")

    def test_weak_noise_counts_as_none(self):
        self.roughen(5)
        self.assert_converges("load.noise_amplitude_Nm=1e-4")

    def test_looks_ahead_are_those_of_flights(self):
        self.roughen(5)
        for others, flies in [(["load.mean_Nm=300"], False), ([], True)]:
            result = self.gearsim([*self.rough, *self.LIGHT, *others], "--output", "run.csv")
            looks = int(re.search(r"(\d+) looks ahead", result.stderr).group(1))
            self.assertEqual(looks > 0, flies, result.stderr)


class Solver(Case):
    NOISY = ["load.noise_amplitude_Nm=10", "drive.start_rpm=4000", "drive.end_rpm=5000", "output.columns=dte_um", *PLAIN]

    def tolerance(self, value, *others):
        return self.run_columns([*self.NOISY, f"solver.relative_tolerance={value}",
                                 f"solver.absolute_tolerance_um={value}", *others])["dte_um"]

    def test_error_falls_with_the_tolerance(self):
        exact = self.tolerance(1e-10)
        errors = [largest_difference(self.tolerance(value), exact) for value in (1e-3, 1e-5, 1e-7)]
        # The coarsest has more steps than its tolerance asks for, as a step may not miss a tooth.
        self.assertLess(errors[1], 0.5 * errors[0])
        self.assertLess(errors[2], 0.1 * errors[1])
        # The default of 1e-4: 1 % of a vibration of 0.5 um.
        self.assertLess(largest_difference(self.run_columns(self.NOISY)["dte_um"], exact), 0.02)

    def test_one_tolerance_does_for_both(self):
        """An error that stays when `relative_tolerance` alone is tightened would be that of the absolute one."""
        exact = self.tolerance(1e-10)
        alone = self.run_columns([*self.NOISY, "solver.relative_tolerance=1e-7"])["dte_um"]
        self.assertLess(largest_difference(alone, exact), 2 * largest_difference(self.tolerance(1e-7), exact))

    def test_no_tolerance_is_too_small(self):
        """Below what the digits of a double hold it is that; an arc of a long run has fewer digits behind the point."""
        tight = ["solver.relative_tolerance=1e-14", "solver.absolute_tolerance_um=1e-12", *PLAIN]
        spur = ["gears.helix_angle_deg=0", "gears.center_distance_mm=71.4", "gears.pinion_tip_diameter_mm=",
                "gears.wheel_tip_diameter_mm=", "gears.backlash_um=400"]
        torque = ["drive.kind=torque", "drive.torque_Nm=21", f"bodies.pinion_inertia_kg_m2={I_P}", "drive.start_rpm=20000"]
        for others in (spur, torque):
            with self.subTest(others):
                self.run_columns([*others, "analysis.duration_s=0.004", *tight])

    def test_methods_agree(self):
        adams = self.tolerance(1e-8, "solver.method=adams")
        for method in ("bdf", "erk"):
            other = self.tolerance(1e-8, f"solver.method={method}")
            self.assertLess(largest_difference(adams, other), 1e-4, method)
            self.assertNotEqual(adams, other)

    def test_explicit_method_has_the_accuracy_of_the_default(self):
        exact = self.tolerance(1e-10)
        errors = [largest_difference(self.tolerance(1e-4, f"solver.method={name}"), exact) for name in ("adams", "erk")]
        self.assertLess(errors[1], errors[0])

    def steps(self, *settings):
        result = self.gearsim([*SIMPLE, *settings], "--output", "run.csv")
        return int(result.stderr.split(" steps")[0].split()[-1])

    def test_longest_step_is_kept(self):
        for method in ("adams", "bdf", "erk"):
            self.assertGreaterEqual(self.steps(f"solver.method={method}", "solver.max_step_s=1e-5"), 2000, method)
            self.assertLess(self.steps(f"solver.method={method}"), 100, method)


class Lookup(Case):
    """Without loss of contact, where a small error stays small: 80 N m and 30 % of the deviations, a mean sum of 19.5 um."""
    LOADED = [*MEASURED, "flanks.scale=0.3", "load.mean_Nm=80", "load.noise_amplitude_Nm=10", "drive.start_rpm=3000",
              "drive.end_rpm=3100", *TIGHT]

    def test_run_differs_by_its_error(self):
        exact = self.run_columns(self.LOADED)
        close = self.run_columns([*self.LOADED, "solver.lookup=always"])
        # 3e-3 of 4.9 um in the sum at most, and most of it at tooth frequency, below resonance: over 1.5 touching faces.
        self.assertLess(largest_difference(close["dte_um"], exact["dte_um"]), 0.01)
        self.assertNotEqual(close["dte_um"], exact["dte_um"])
        # K times 3e-3 of 4.9 um is 1.5 N of 2100 N; damping adds D times 1 mm/s times 0.15.
        forces = exact["contact_force_N"]
        self.assertLess(largest_difference(close["contact_force_N"], forces), 0.001 * statistics.mean(forces))
        # Counted, not looked up. A place where a pair begins or ends to touch may come a row later.
        different = [a != b for a, b in zip(close["pairs_in_contact"], exact["pairs_in_contact"])]
        self.assertLess(statistics.mean(different), 0.02)
        self.assertGreaterEqual(min(close["pairs_in_contact"]), 2)

    def test_run_with_corners_differs_by_its_error(self):
        """Edges in contact, and the torques of their arms, with the flanks of both gears and with even ones."""
        even = [setting for setting in self.LOADED if not setting.startswith("flanks.")]
        for settings in (self.LOADED, even):
            corners = [*settings, "mesh.corner_contact=on"]
            exact = self.run_columns([*corners, "solver.lookup=off"])
            close = self.run_columns([*corners, "solver.lookup=always"])
            without = self.run_columns([*settings, "solver.lookup=off"])
            self.assertLess(largest_difference(close["dte_um"], exact["dte_um"]), 0.02)
            self.assertNotEqual(close["dte_um"], exact["dte_um"])
            # Ten times nearer than a run without corners is.
            self.assertGreater(largest_difference(without["dte_um"], exact["dte_um"]), 0.2)
            forces = exact["contact_force_N"]
            self.assertLess(largest_difference(close["contact_force_N"], forces), 0.002 * statistics.mean(forces))

    def test_on_and_auto_are_for_runs_that_are_long_to_their_tables(self):
        """Of the pinion alone 45 tooth passes have 630 columns, as dear as 10.4 evaluations: of 8 a pass, at least, 990 passes."""
        one = [*MEASURED[:2], "output.columns=dte_um", "output.oversampling=1"]
        # 1.6 s times 675 passes a second, at least in the mean; driven by 22.5 N m of which 22.0 carry the load, up to 2280
        # rpm, or with as much more in the beginning and less in the end.
        long = [*one, "drive.start_rpm=900", "drive.end_rpm=900", "analysis.duration_s=1.6"]
        table = [*one, "drive.start_rpm=", "drive.end_rpm=", f"drive.file={self.path('speed.csv')}", "analysis.duration_s=1.6"]
        driven = [*one, *TORQUE, "drive.torque_Nm=22.5", "drive.start_rpm=300", "drive.end_rpm=", "analysis.duration_s=1.6"]
        torques = [*one, "drive.kind=torque", f"bodies.pinion_inertia_kg_m2={I_P}", f"drive.file={self.path('torque.csv')}",
                   "drive.start_rpm=300", "drive.end_rpm=", "analysis.duration_s=1.6"]
        with open(self.path("speed.csv"), "w") as file:
            file.write("time_s,speed_rpm\n0,600\n1.6,1200\n")
        for text, chosen in (("0,22.9\n1.6,21.7\n", "always"), ("0,21.7\n1.6,22.9\n", "off")):
            with open(self.path("torque.csv"), "w") as file:
                file.write("time_s,torque_Nm\n" + text)
            self.assertEqual(self.tables_of(torques, "on")[0] is not None, chosen == "always", text)
        for settings, chosen, other in ((self.LOADED, "off", "always"),
                                        ([*one, *VALUES, "output.rate_Hz=1000", "analysis.duration_s=0.02"], "off", "always"),
                                        (long, "always", "off"), (table, "always", "off"), (driven, "always", "off"),
                                        ([*driven, "drive.torque_Nm=21.9"], "off", "always")):
            rows = {use: self.run_columns([*settings, f"solver.lookup={use}"])["dte_um"]
                    for use in ("auto", "on", chosen, other)}
            for use in ("auto", "on"):
                self.assertTrue(rows[use] == rows[chosen], (settings, use))
                self.assertTrue(rows[use] != rows[other], (settings, use))

    def test_a_run_that_ends_at_a_speed_is_as_long_as_it_takes(self):
        """22.5 N m of which 22.0 carry the load make 400 rpm of 300 in 0.08 s, and 2280 in 1.6 s."""
        one = [*MEASURED[:2], *TORQUE, "drive.torque_Nm=22.5", "drive.start_rpm=300", "drive.end_rpm=", "analysis.duration_s=1.6"]
        self.assertIsNone(self.tables_of([*one, "analysis.stop_rpm=400"], "on")[0])
        self.assertIsNotNone(self.tables_of([*one, "analysis.stop_rpm=3000"], "on")[0])

    def test_a_run_to_and_fro_meets_what_it_turns(self):
        """From -900 to 900 rpm the pinion turns half as far as at 900 rpm."""
        one = [*MEASURED[:2], "drive.start_rpm=-900", "drive.end_rpm=900"]
        self.assertIsNone(self.tables_of([*one, "analysis.duration_s=1.6"], "on")[0])
        self.assertIsNotNone(self.tables_of([*one, "analysis.duration_s=3.2"], "on")[0])

    def tables_of(self, settings, lookup="auto"):
        """What the head of a result says of the tables, None without any; and what was said beside it."""
        result = self.gearsim([*settings, f"solver.lookup={lookup}", "output.columns=time_s"], "--output", "run.csv")
        self.assertEqual(result.returncode, 0, result.stderr)
        found = re.search("^# lookup_tables = (.*)$", self.text("run.csv"), re.MULTILINE)
        return found and found[1], result.stderr

    def test_auto_is_for_evaluations_that_take_longer_than_tables(self):
        """Series without end for even flanks of constant stiffness; reliefs, tilted axes and elastic teeth are dear."""
        steady = ["drive.start_rpm=3000", "drive.end_rpm=3000", "analysis.duration_s=0.2"]
        relief = ["modifications.pinion_tip_relief_um=5", "modifications.pinion_tip_relief_length_mm=1"]
        elastic = ["mesh.law=elastic", "mesh.stiffness_N_per_m=", "mesh.damping_Ns_per_m=", "mesh.damping_ratio=0.05",
                   "gears.pinion_rack_dedendum=", "gears.wheel_rack_dedendum=", "gears.pinion_tip_diameter_mm=",
                   "gears.wheel_tip_diameter_mm="]
        self.assertIsNone(self.tables_of(steady)[0])
        self.assertIn("note: the run is exact: a look-up takes longer than these flanks; with", self.tables_of(steady, "on")[1])
        self.assertIsNone(self.tables_of([*steady, *MEASURED])[0])
        for dear in (relief, ["pose.skew_mrad=0.1"], ["mesh.corner_contact=on"], elastic):
            self.assertIsNotNone(self.tables_of([*steady, *dear])[0], dear)
        # With friction or spur gears there are none: who did not ask for them is told nothing.
        for without, why in ((["mesh.friction_coefficient=0.05"], "with friction there are no tables"),
                             (["gears.helix_angle_deg=0", "gears.center_distance_mm=71.4"], "spur gears have no tables")):
            found, said = self.tables_of([*steady, *relief, *without])
            self.assertIsNone(found, without)
            self.assertNotIn("the run is exact", said)
            found, said = self.tables_of([*steady, *relief, *without], "on")
            self.assertIsNone(found, without)
            self.assertIn(f"solver.lookup: note: the run is exact: {why}, as ", said)

    def test_auto_leaves_no_larger_error_than_the_solver(self):
        """8 x 16 cells are off by less than the solver at 1e-4, none by less than it below 1e-5."""
        relief = ["modifications.pinion_tip_relief_um=5", "modifications.pinion_tip_relief_length_mm=1",
                  "drive.start_rpm=3000", "drive.end_rpm=3000"]
        short = [*relief, "analysis.duration_s=0.1"]
        self.assertTrue(self.tables_of(short)[0].startswith("8 x 16 cells"))
        self.assertTrue(self.tables_of([*short, "solver.relative_tolerance=2e-5"])[0].startswith("16 x 20 cells"))
        self.assertIsNone(self.tables_of([*short, "solver.relative_tolerance=5e-6"])[0])
        # Who asks for them has them all the same.
        self.assertTrue(self.tables_of([*short, "solver.relative_tolerance=5e-6"], "on")[0].startswith("16 x 20 cells"))
        # Finer ones as the run gets longer and they cost next to nothing.
        self.assertTrue(self.tables_of([*relief, "analysis.duration_s=2"])[0].startswith("64 x 40 cells"))
        # Against the model itself at a tight tolerance, tables add nothing to speak of to the error of the run.
        forces = [self.run_columns([*relief, "analysis.duration_s=0.1", "load.mean_Nm=60", "output.columns=contact_force_N",
                                    *others])["contact_force_N"][400:]
                  for others in (["solver.lookup=off", *TIGHT], ["solver.lookup=off"], ["solver.lookup=auto"])]
        by_solver, by_both = [statistics.pstdev([a - b for a, b in zip(forces[0], other)]) for other in forces[1:]]
        self.assertLess(by_both, 1.2 * by_solver)
        self.assertNotEqual(forces[1], forces[2])

    def test_auto_knows_how_much_of_the_tables_a_run_meets(self):
        """A second at 60 rpm meets 45 of 1845 tooth passes, in vibrations under noise: 14 x 46 columns for 20000 evaluations."""
        slow = [*MEASURED, "drive.start_rpm=60", "drive.end_rpm=60", "analysis.duration_s=1", "output.rate_Hz=1000"]
        noisy = [*slow, "load.noise_amplitude_Nm=5"]
        self.assertIsNone(self.tables_of(slow)[0])
        self.assertIsNotNone(self.tables_of(noisy)[0])
        self.assertIsNone(self.tables_of([*noisy, "solver.lookup_threads=1"])[0])  # which fills all of them

    def test_who_asks_for_tables_is_told_where_they_would_take_longer(self):
        """And how long a run has to be: a tenth more than that is long enough, a tenth less is not."""
        short = [*MEASURED, "drive.start_rpm=3000", "drive.end_rpm=3000", "analysis.duration_s=0.01"]
        self.assertTrue(self.tables_of(short, "always")[0].startswith("8 x 16 cells"))
        found, said = self.tables_of(short, "auto")
        self.assertIsNone(found)
        self.assertNotIn("the run is exact", said)
        found, said = self.tables_of(short, "on")
        self.assertIsNone(found)
        told = re.search("--set solver.lookup: note: the run is exact: filling the tables would take longer than they save in "
                         "0.01 s; a run like this gains from some ([0-9.]+) s on\n", said)
        self.assertIsNotNone(told, said)
        for share in (0.9, 1.1):
            checked = self.gearsim([*short[:-1], f"analysis.duration_s={share * float(told[1])}", "solver.lookup=on"], "--check")
            self.assertEqual("the run is exact" in checked.stderr, share < 1.0, checked.stderr)

    def test_rows_do_not_depend_on_what_is_written(self):
        one = [*MEASURED[:2], *VALUES, "drive.start_rpm=900", "drive.end_rpm=900", "analysis.duration_s=0.25"]
        few = self.run_columns([*one, "output.columns=wheel_angle_rad"])["wheel_angle_rad"]
        self.assertEqual(few, self.run_columns(one)["wheel_angle_rad"])

    def test_coast_flanks_are_looked_up_under_a_driving_load(self):
        driving = [*self.LOADED, "load.mean_Nm=-80"]
        exact, close = self.run_columns(driving), self.run_columns([*driving, "solver.lookup=always"])
        self.assertLess(largest_difference(close["dte_um"], exact["dte_um"]), 0.01)
        self.assertNotEqual(close["dte_um"], exact["dte_um"])

    def test_depth_is_kept(self):
        # Beyond the depth the model itself answers, so that a hair's depth changes nothing, and who asks is told so.
        found, said = self.tables_of([*self.LOADED, "solver.lookup_depth_um=0.01"], "on")
        self.assertIsNone(found)
        self.assertIn("the run is exact: the load presses the flanks deeper than lookup_depth_um", said)
        shallow = [*self.LOADED, "solver.lookup=always", "solver.lookup_depth_um=0.01", "output.columns=dte_um"]
        exact = self.run_columns([*self.LOADED, "output.columns=dte_um"])
        self.assertLess(largest_difference(self.run_columns(shallow)["dte_um"], exact["dte_um"]), 1e-6)

    def test_threads_that_fill_it_change_nothing(self):
        """No column depends on another one, nor on who fills it. Of the pinion alone, 45 tooth passes."""
        one = [*MEASURED[:2], "solver.lookup=always", "output.columns=contact_force_N"]
        met, filled, shared = [self.run_columns([*one, f"solver.lookup_threads={count}"]) for count in (0, 1, 50)]
        self.assertEqual(met, filled)
        self.assertEqual(met, shared)

    def test_result_says_so(self):
        self.run_columns(["solver.lookup=always", "solver.lookup_depth_um=15"])
        self.assertIn("# solver.lookup = always\n# solver.lookup_depth_um = 15\n", self.text("run.csv"))
        self.assertIn("# lookup_tables = 8 x 16 cells of base pitch and depth, 15 um deep\n", self.text("run.csv"))
        self.run_columns(["solver.lookup=on"])
        self.assertNotIn("# lookup_tables", self.text("run.csv"))
        self.run_columns()
        self.assertIn("# solver.lookup = auto\n", self.text("run.csv"))


class ShortStretches(Case):
    """A contact ratio next to a whole number: one pair less, or more, for a short part of a tooth."""

    def test_no_step_passes_over_them(self):
        spur = ["gears.helix_angle_deg=0", "gears.normal_module_mm=2",
                "gears.pinion_tip_diameter_mm=", "gears.wheel_tip_diameter_mm=", "gears.pinion_rack_dedendum=",
                "gears.wheel_rack_dedendum=", "load.mean_Nm=340", "analysis.duration_s=0.1"]
        for pinion, wheel, distance, angle in ((90, 160, 250, 19), (31, -88, 57.4, 20)):
            with self.subTest(pinion=pinion, wheel=wheel):
                gears = [f"gears.pinion_teeth={pinion}", f"gears.wheel_teeth={wheel}", f"gears.center_distance_mm={distance}",
                         f"gears.normal_pressure_angle_deg={angle}", "drive.start_rpm=120", "drive.end_rpm=120"]
                self.assertGreater(self.geometry(spur + gears)["transverse_contact_ratio"], 1.9)
                usual = self.run_columns(spur + gears)["contact_force_N"]
                small = self.run_columns(spur + gears + ["solver.max_step_s=2e-5"])["contact_force_N"]
                swing = statistics.pstdev(small)
                self.assertGreater(swing, 0.02 * statistics.fmean(small))
                self.assert_close(statistics.pstdev(usual), swing, 0.02)


class Static(Case):
    def static(self, *settings):
        return self.run_columns([*STATIC, *settings])

    def test_integer_overlap_is_the_closed_form(self):
        """The contact length is (g_alpha - delta) / p_bt face widths: F = K delta (g_alpha - delta) / p_bt."""
        overlap = self.geometry()["overlap_ratio"]
        width = f"gears.face_width_mm={17.5 * 2 / overlap!r}"
        g = self.geometry([width])
        pitch = g["transverse_base_pitch_mm"] * 1e-3
        path = g["transverse_contact_ratio"] * pitch
        force = LOAD / (g["wheel_base_radius_mm"] * 1e-3)
        depth = path / 2 - math.sqrt(path**2 / 4 - force * pitch / K)
        c = self.static(width)
        # 1e-9 is asked for. The closed form's difference loses three digits of sixteen.
        self.assert_all_close(c["te_um"], [-(GAP / 2 + depth) * 1e6] * 60, relative=1e-9)
        length = (path - depth) / pitch * g["overlap_ratio"] * g["transverse_base_pitch_mm"] / abs(
            math.sin(math.radians(g["base_helix_angle_deg"])))
        self.assert_all_close(c["contact_length_mm"], [length] * 60, relative=1e-9)
        self.assert_all_close(c["mesh_stiffness_N_per_um"], [K * 1e-6 * (path - depth) / pitch] * 60, relative=1e-9)

    def test_te_carries_the_load(self):
        """Ideal flanks: penetration times touching width is the load, at every position."""
        c = self.static()
        force = LOAD / (self.geometry()["wheel_base_radius_mm"] * 1e-3)
        carried = [(-te - GAP / 2 * 1e6) * k for te, k in zip(c["te_um"], c["mesh_stiffness_N_per_um"])]
        self.assert_all_close(carried, [force] * 60, relative=1e-9)

    def test_positions_divide_the_period(self):
        for period, passes in [("mesh", 1), ("pinion", 45), ("hunting", 45 * 41)]:
            angles = self.static(f"analysis.period={period}", "analysis.positions=7")["pinion_angle_rad"]
            self.assert_all_close(angles, [2 * math.pi / 45 * passes * k / 7 for k in range(7)], relative=4e-16)

    def test_one_load_is_not_repeated_in_each_row(self):
        self.assertEqual(list(self.static()), ["pinion_angle_rad", "te_um", "mesh_stiffness_N_per_um",
                                               "contact_length_mm", "pairs_in_contact"])

    def test_several_loads_are_the_runs_of_each_one_after_the_other(self):
        loads = [20, 12.5, 5]
        together = self.static("analysis.loads=3", "load.end_Nm=5")
        one_by_one = [self.static(f"load.mean_Nm={load}") for load in loads]
        self.assertEqual(together.pop("load_torque_Nm"), [load for load in loads for _ in range(60)])
        self.assertEqual(together, {name: [value for run in one_by_one for value in run[name]]
                                    for name in one_by_one[0]})
        self.assertGreater(max(together["te_um"][120:]) - max(together["te_um"][:60]), 1)

    def test_loads_from_one_side_to_the_other_leave_out_none(self):
        """Each side of the backlash; a step of 0 leaves no rows."""
        for settings, loads in ((("load.mean_Nm=-20", "load.end_Nm=20", "analysis.loads=3"), [-20, 20]),
                                (("load.mean_Nm=-5", "load.end_Nm=10", "analysis.loads=4"), [-5, 5, 10]),
                                (("load.mean_Nm=0", "load.end_Nm=10", "analysis.loads=2"), [10])):
            with self.subTest(loads):
                both = self.static(*settings)
                self.assert_all_close(both["load_torque_Nm"], [load for load in loads for _ in range(60)], absolute=1e-9)
                alone = self.static(f"load.mean_Nm={loads[0]}")
                self.assert_all_close(both["te_um"][:60], alone["te_um"], absolute=1e-9)

    def test_coast_side_mirrors_the_drive_side(self):
        """Without flank files: the mean of one side is minus that of the other."""
        drive, coast = self.static("analysis.positions=500"), self.static("load.mean_Nm=-20", "analysis.positions=500")
        self.assert_close(statistics.fmean(coast["te_um"]), -statistics.fmean(drive["te_um"]), relative=1e-6)
        self.assertGreater(min(coast["te_um"]), 50.0)


    FACES = "face_load_factor,largest_line_load_N_per_mm,largest_pressure_N_per_mm2"

    def test_line_loads_of_ideal_flanks_are_even(self):
        """By name with a constant stiffness: the force over the touching face, Hertz's pressure where curvature is least."""
        g = self.geometry()
        cosine = math.cos(math.radians(g["base_helix_angle_deg"]))
        length = g["line_of_action_mm"]
        force = LOAD / (g["wheel_base_radius_mm"] * 1e-3)
        for law in ([], ["mesh.law=iso6336", "mesh.stiffness_N_per_m="]):
            c = self.run_columns([*STATIC, *law, f"output.columns=contact_length_mm,{self.FACES}"])
            for width, factor, load, pressure in zip(*c.values()):
                self.assert_close(factor, 1, relative=1e-9)
                self.assert_close(load, force / (width * cosine), relative=1e-9)

                # Somewhere on the path: sqrt(q E / (2 (1 - nu^2)) / (pi rho_red)), rho_red = rho_p rho_w / (T cos(beta_b)).
                rolls = [(rho, length - rho) for rho in (g["path_start_mm"], length / 2, g["path_end_mm"])]
                known = [math.sqrt(load * 206e3 / (2 * 0.91) * length * cosine / (math.pi * p * w)) for p, w in rolls]
                self.assertTrue(0.999 * min(known) < pressure < 1.001 * max(known), (pressure, known))
        self.assertNotIn("face_load_factor", self.run_columns(STATIC))
        result = self.gearsim([*STATIC, *SIMPLE, f"output.columns={self.FACES}"], "--output", "run.csv")
        self.assertEqual(result.returncode, 2)

    def test_largest_line_load_may_lie_between_stations(self):
        c = self.run_columns([*STATIC, *MEASURED, f"output.columns=pinion_angle_rad,{self.FACES}",
                              f"output.load_distribution={self.path('loads.csv')}"])
        listed = {}
        for line in self.text("loads.csv").splitlines():
            if line[0] not in "#p":
                fields = line.split(",")
                listed.setdefault(float(fields[0]), []).append(float(fields[7]))
        rows = list(zip(*c.values()))
        self.assertEqual(len(rows), len(listed))
        for angle, factor, largest, pressure in rows:
            at_stations = max(listed[angle])
            self.assertTrue(0.7 * largest < at_stations <= largest * (1 + 1e-9), (at_stations, largest))
            self.assertGreater(factor, 1)
            self.assertGreater(pressure, 0)
        # Stations and ends of lines alone would find 26 that are off by so much.
        self.assertGreater(sum(max(listed[row[0]]) < 0.99 * row[2] for row in rows), 35)


class Ring(Case):
    """A spur pinion in a ring: its numbers in closed form. All pairs that touch share the load alike."""

    Z_P, Z_W, R_BW, BACKLASH, TORQUE = 31, 88, 88e-3 * math.cos(math.radians(20)), 60e-6, 190.0
    RING = ["gears.pinion_teeth=31", "gears.wheel_teeth=-88", "gears.normal_module_mm=2",
            "gears.normal_pressure_angle_deg=20", "gears.helix_angle_deg=0", "gears.center_distance_mm=57.4",
            "gears.backlash_um=60", "gears.pinion_tip_diameter_mm=", "gears.wheel_tip_diameter_mm=",
            "gears.pinion_rack_dedendum=", "gears.wheel_rack_dedendum=", f"load.mean_Nm={TORQUE}"]

    def test_geometry_of_a_ring_is_that_of_its_formulae(self):
        g = self.geometry(self.RING)
        alpha = math.acos(57 * math.cos(math.radians(20)) / 57.4)
        self.assert_close(g["working_pressure_angle_deg"], math.degrees(alpha), 1e-13)
        self.assert_close(g["line_of_action_mm"], 57.4 * math.sin(alpha), 1e-13)
        self.assert_close(g["gear_ratio"], -self.Z_W / self.Z_P, 1e-15)
        self.assert_close(g["reference_center_distance_mm"], 57, 1e-14)

        # The shifts without backlash, of which half belongs to each gear; the axes are further apart than they ask for.
        inv = lambda angle: math.tan(angle) - angle  # noqa: E731
        shifts = (self.Z_P - self.Z_W) * (inv(alpha) - inv(math.radians(20))) / (2 * math.tan(math.radians(20)))
        k = min(0, (57 - 57.4) / 2 - shifts)
        self.assert_close(g["pinion_profile_shift"], shifts / 2, 1e-11)
        self.assert_close(g["wheel_tip_alteration"], k, 1e-12, 1e-15)
        self.assert_close(g["wheel_tip_radius_mm"], 88 - 2 * (1 + shifts / 2 + k), 1e-13)
        self.assert_close(g["wheel_root_radius_mm"], 88 + 2 * (1.25 - shifts / 2), 1e-13)
        self.assert_close(g["wheel_tip_clearance_mm"], g["wheel_tip_radius_mm"] - 57.4 - g["pinion_root_radius_mm"], 0, 1e-12)
        self.assertGreater(g["wheel_start_radius_mm"], g["wheel_tip_radius_mm"])

    def test_static_error_is_that_of_one_pair_or_two(self):
        for sign in (1, -1):
            columns = self.run_columns(self.RING + STATIC + [f"load.mean_Nm={sign * self.TORQUE}"])
            force = self.TORQUE / self.R_BW
            expected = [1e6 * (self.BACKLASH / 2 + force / K / n) for n in (1, 2)]
            seen = set()
            for te in columns["te_um"]:
                nearest = min(expected, key=lambda value: abs(-sign * te - value))
                seen.add(nearest)
                self.assert_close(-sign * te, nearest, 1e-10)
            self.assertEqual(len(seen), 2)

    def test_material_on_the_rings_flanks_comes_off_the_error(self):
        with open(self.path("ring.csv"), "w") as file:
            file.write("tooth,flank,t1,t2,deviation_um\n")
            for tooth in range(self.Z_W):
                file.writelines(f"{tooth},drive,{t1},{t2},5\n" for t1 in (0, 1) for t2 in (0, 1))
        ideal = self.run_columns(self.RING + STATIC)["te_um"]
        filled = self.run_columns(self.RING + STATIC + ["flanks.wheel=ring.csv"])["te_um"]
        self.assert_all_close([b - a for a, b in zip(ideal, filled)], [5.0] * len(ideal), absolute=1e-7)

        # The teeth of a ring are counted as they are.
        with open(self.path("ring.csv"), "a") as file:
            file.write(f"{self.Z_W},drive,0,0,5\n")
        result = self.gearsim(self.RING + STATIC + ["flanks.wheel=ring.csv"])
        self.assertEqual(result.returncode, 2)
        self.assertIn("87", result.stderr)

    def test_profiles_of_a_ring_run_from_its_root_to_its_tip(self):
        """A slope of the ring's profiles is seen by the pair that carries alone, at the place where it touches."""
        slope, g = 20.0, self.geometry(self.RING)
        many = self.RING + STATIC + ["analysis.positions=600"]
        ideal = self.run_columns(many)
        sloped = self.run_columns(many + [f"modifications.wheel_profile_slope_um={slope}"])
        r_b, alpha = g["pinion_base_radius_mm"], math.radians(g["working_pressure_angle_deg"])
        roll = {name: math.sqrt(g[f"wheel_{name}_radius_mm"] ** 2 - g["wheel_base_radius_mm"] ** 2) for name in ("start", "tip")}

        # Half the pinion's tooth on the base circle, thinned by half the backlash.
        alpha_t, shift = math.radians(20), g["pinion_profile_shift"]
        thickness = 2 * (math.pi / 2 + 2 * shift * math.tan(alpha_t)) - 1e3 * self.BACKLASH / (2 * math.cos(alpha_t))
        psi = thickness / 62 + math.tan(alpha_t) - alpha_t
        compared = 0
        for angle, te, other in zip(ideal["pinion_angle_rad"], ideal["te_um"], sloped["te_um"]):
            if -te < 1e6 * (self.BACKLASH / 2 + 0.9 * self.TORQUE / self.R_BW / K):
                continue  # two pairs
            if abs(other - te) > slope / 2:
                continue  # two with the slope: a loaded path is shorter
            rho = r_b * (alpha + psi + angle)
            pitch = g["transverse_base_pitch_mm"]
            inside = [rho + n * pitch for n in range(-9, 10) if g["path_start_mm"] + 0.04 < rho + n * pitch < g["path_end_mm"]]
            self.assertEqual(len(inside), 1)
            wheel = g["line_of_action_mm"] + inside[0]
            place = (wheel - roll["start"]) / (roll["tip"] - roll["start"])
            # The point looked up is that of the flank under load, some 10 um of 10 mm along it.
            self.assert_close(other - te, slope * (place - 0.5), absolute=0.05)
            compared += 1
        self.assertGreater(compared, 10)

    def test_both_turn_the_same_way(self):
        columns = self.run_columns(self.RING + ["analysis.duration_s=0.1", "drive.start_rpm=300", "drive.end_rpm=300"])
        half = len(columns["time_s"]) // 2
        mean = statistics.fmean(columns["wheel_speed_rpm"][half:])
        self.assert_close(mean, 300 * self.Z_P / self.Z_W, 1e-3)
        # In the mean the mesh carries the load, which resists that turn.
        force = statistics.fmean(columns["contact_force_N"][half:])
        self.assert_close(force, self.TORQUE / self.R_BW, 2e-2)


class Friction(Case):
    MU, SPEED = 0.08, 2 * math.pi / 60 * 1000
    RUBBING = [f"mesh.friction_coefficient={MU}", "mesh.friction_speed_m_per_s=1e-6"]

    def closed_form(self, settings, depth):
        """Force, and loss in W, of lines of contact that cover the path evenly: overlap ratio an integer."""
        g = self.geometry(settings)
        r_bp, r_bw = g["pinion_base_radius_mm"] * 1e-3, g["wheel_base_radius_mm"] * 1e-3
        length = g["line_of_action_mm"] * 1e-3
        pitch_point = length * r_bp / (r_bp + r_bw)
        below = pitch_point - (g["path_start_mm"] * 1e-3 + depth)  # the wheel's tip moves with the overlap
        above = g["path_end_mm"] * 1e-3 - pitch_point
        path = below + above
        per_force = self.MU / math.cos(math.radians(g["base_helix_angle_deg"])) / path
        # Friction times rho_w on both sides of the pitch point, where it turns round.
        beyond = length - pitch_point
        arm = per_force * (above * (beyond - above / 2) - below * (beyond + below / 2))
        force = LOAD / (r_bw + arm)
        speed = self.SPEED * (1 + r_bp / r_bw)
        return force, force * per_force * speed * (above**2 + below**2) / 2

    def test_loss_and_te_are_the_closed_form(self):
        width = f"gears.face_width_mm={17.5 * 2 / self.geometry()['overlap_ratio']!r}"
        c = self.run_columns([*STATIC, *self.RUBBING, width])
        for te, stiffness, loss in zip(c["te_um"], c["mesh_stiffness_N_per_um"], c["loss_W"]):
            depth = -te * 1e-6 - GAP / 2
            force, expected = self.closed_form([width], depth)
            # The part of v0 = 1e-6 m/s against some m/s.
            self.assert_close(depth * stiffness * 1e6, force, relative=1e-6)
            self.assert_close(loss, expected, relative=1e-5)

    def test_without_speed_there_is_no_friction(self):
        still = self.run_columns([*STATIC, *self.RUBBING, "drive.start_rpm=0"])
        self.assertEqual(set(still.pop("loss_W")), {0.0})
        without = self.run_columns(STATIC)
        self.assert_all_close(still["te_um"], without["te_um"], absolute=1e-9)
        self.assertEqual(list(still), list(without))

    def test_loss_is_the_last_column(self):
        c = self.run_columns([*STATIC, *self.RUBBING, "analysis.loads=2", "load.end_Nm=5"])
        self.assertEqual(list(c)[-2:], ["load_torque_Nm", "loss_W"])
        self.assertGreater(min(c["loss_W"][:60]), max(c["loss_W"][60:]))

    def test_slow_turning_follows_the_static_transmission_error(self):
        slow = [*self.RUBBING, "drive.start_rpm=1", "drive.end_rpm=1"]
        static = self.run_columns([*STATIC, *slow[:-1]])
        dynamic = self.run_columns([*PLAIN, *slow, "output.rate_Hz=45", "analysis.duration_s=1.32", *TIGHT])
        # Spring and damper as without friction (Dynamic); friction moves the curve by some 0.01 um.
        self.assert_all_close(dynamic["dte_um"][:60], static["te_um"], absolute=2e-5)
        self.assertGreater(largest_difference(static["te_um"], self.run_columns(STATIC)["te_um"]), 2e-3)

    def test_kinetic_energy_misses_what_is_lost(self):
        """Both bodies free: what friction takes off their energy is its power, known from static positions."""
        runs = [self.run_columns([*PLAIN, *TORQUE, *TIGHT, *settings]) for settings in ([], self.RUBBING)]
        energy = [sum(0.5 * inertia * (c[f"{gear}_speed_rpm"][-1] * 2 * math.pi / 60)**2
                      for gear, inertia in (("pinion", I_P), ("wheel", I_W))) for c in runs]
        work = [22 * c["pinion_angle_rad"][-1] - LOAD * c["wheel_angle_rad"][-1] for c in runs]
        lost = (work[1] - energy[1]) - (work[0] - energy[0])
        loss = statistics.fmean(self.run_columns([*STATIC, *self.RUBBING])["loss_W"])
        # 15 teeth pass, the last one in part, and what vibrates holds some of it.
        self.assert_close(lost, loss * 0.02, relative=0.03)

    def test_stored_energy_is_that_of_the_springs(self):
        """F^2 / (2 k) between ideal flanks, k of what touches; and only where it is named."""
        names = "output.columns=te_um,mesh_stiffness_N_per_um,load_torque_Nm,stored_energy_J"
        radius = self.geometry()["wheel_base_radius_mm"] * 1e-3
        c = self.run_columns([*STATIC, "analysis.loads=2", "load.end_Nm=-5", names])
        for stiffness, load, energy in zip(c["mesh_stiffness_N_per_um"], c["load_torque_Nm"], c["stored_energy_J"]):
            self.assert_close(energy, (load / radius)**2 / (2 * stiffness * 1e6), relative=1e-9)
        elastic = self.run_columns([*STATIC, "mesh.law=elastic", "mesh.stiffness_N_per_m=", "mesh.damping_Ns_per_m=",
                                    "output.columns=te_um,stored_energy_J"])
        for te, energy in zip(*elastic.values()):
            # Less than that of a spring that does not stiffen, more than of one with Hertz's exponent of 1.11 alone.
            work = LOAD / radius * (-te * 1e-6 - GAP / 2)
            self.assertTrue(work / 2.11 < energy < work / 2, (energy, work))
        self.assertNotIn("stored_energy_J", self.run_columns(STATIC))

    def test_what_comes_in_is_kinetic_or_stored(self):
        """Both bodies free, with corners, so that nothing leaves with an overlap; without damping."""
        c = self.run_columns([*PLAIN, *TORQUE, *TIGHT, "mesh.damping_Ns_per_m=0", "mesh.corner_contact=on", "output.columns="
                              "pinion_speed_rpm,wheel_speed_rpm,pinion_angle_rad,wheel_angle_rad,stored_energy_J"])
        rows = list(zip(*c.values()))
        turns = 2 * math.pi / 60
        balance = [22 * phi_p - LOAD * phi_w - I_P / 2 * (n_p * turns)**2 - I_W / 2 * (n_w * turns)**2 - stored
                   for n_p, n_w, phi_p, phi_w, stored in rows]
        changes = max(c["stored_energy_J"]) - min(c["stored_energy_J"])
        self.assertGreater(changes, 5e-5)
        self.assert_all_close(balance, [balance[0]] * len(rows), absolute=1e-3 * changes)

    def test_force_is_filtered_from_values(self):
        """Momentum tells the torques, in which friction has its share."""
        c = self.run_columns([*self.RUBBING, "output.columns=contact_force_N,penetration_um,penetration_rate_um_per_s"])
        # Away from the ends, where the filter sees the start.
        for force, depth, rate in list(zip(*c.values()))[100:-100]:
            self.assert_close(force, K * depth * 1e-6 + D * rate * 1e-6, relative=1e-9)
        self.assertIn("low-pass filtered, load_torque_Nm from means", self.text("run.csv"))


class Corners(Case):
    SPUR = ["gears.pinion_teeth=25", "gears.wheel_teeth=37", "gears.normal_module_mm=2",
            "gears.normal_pressure_angle_deg=20", "gears.helix_angle_deg=0", "gears.center_distance_mm=62.2",
            "gears.pinion_tip_diameter_mm=", "gears.wheel_tip_diameter_mm=", "gears.pinion_rack_dedendum=1.25",
            "gears.wheel_rack_dedendum=1.25"]
    ON = [*SPUR, "mesh.corner_contact=on"]

    def largest_step(self, settings, positions):
        te = self.run_columns([*settings, *STATIC, f"analysis.positions={positions}"])["te_um"]
        return max(abs(b - a) for a, b in zip(te, te[1:]))

    def test_transmission_error_of_spur_gears_has_no_jumps(self):
        self.assertLess(self.largest_step(self.ON, 1600), 0.3 * self.largest_step(self.ON, 400))
        self.assertGreater(self.largest_step(self.SPUR, 1600), 0.9 * self.largest_step(self.SPUR, 400))

    def test_slow_turning_follows_the_static_transmission_error(self):
        slow = [*self.ON, "drive.start_rpm=2", "drive.end_rpm=2"]
        static = self.run_columns([*slow[:-2], *STATIC, "analysis.positions=25"])
        dynamic = self.run_columns([*PLAIN, *slow, f"output.rate_Hz={25 * 25 * 2 / 60!r}",
                                    "analysis.duration_s=1.21", *TIGHT])
        # The damper lags by D/K, 8 us; at corners the transmission error changes by some 50 um/s.
        self.assert_all_close(dynamic["dte_um"][:25], static["te_um"], absolute=1e-3)
        self.assertGreater(spread(static["te_um"]), 0.1)

    def test_a_solver_needs_fewer_steps(self):
        steps = [int(re.search(r": (\d+) steps", self.gearsim([*s, "analysis.duration_s=0.05"]).stderr).group(1))
                 for s in (self.ON, self.SPUR)]
        self.assertLess(steps[0], 0.7 * steps[1])

    def test_a_resonance_that_jumps_have_driven_too_far_is_told_of(self):
        settings = [*self.SPUR, "gears.pinion_teeth=23", "gears.wheel_teeth=57", "gears.normal_module_mm=3",
                    "gears.center_distance_mm=121.2", "gears.face_width_mm=35", "gears.backlash_um=30",
                    "bodies.wheel_inertia_kg_m2=0.02", "mesh.stiffness_N_per_m=4e8", "mesh.damping_Ns_per_m=",
                    "mesh.damping_ratio=0.02", "load.mean_Nm=600", "load.noise_amplitude_Nm=0", "drive.start_rpm=4300",
                    "drive.end_rpm=5200", "analysis.duration_s=0.3"]
        result = self.gearsim(settings)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("turned against each other by half a base pitch", result.stderr)
        self.assertIn("mesh.corner_contact = on takes the jumps away", result.stderr)

        # With corner contact the same run ends well.
        result = self.gearsim([*settings, "mesh.corner_contact=on"])
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_momentum_does_not_tell_the_force(self):
        self.run_columns([*self.ON, "analysis.duration_s=0.01"])
        self.assertIn("# sampling = low-pass filtered, load_torque_Nm from means", self.text("run.csv"))

        # Values fold lines into the rows, which is told where the force jumps and samples are few.
        note = "output.oversampling: note: the force of spur gears with friction or corner contact is sampled"
        friction = [*self.SPUR, "mesh.friction_coefficient=0.05"]
        for settings, told in ((self.ON, True), (friction, True), ([*self.ON, "output.oversampling=16"], False),
                               ([*friction, *PLAIN], False), (self.SPUR, False)):
            stderr = self.gearsim([*settings, "analysis.duration_s=0.001"]).stderr
            self.assertEqual(note in stderr, told, stderr)


class Ends(Case):
    ENDLESS = ["analysis.duration_s=30000", "load.noise_amplitude_Nm=10"]

    def setUp(self):
        super().setUp()
        with open(self.path("run.csv"), "w") as file:
            file.write(OLD_RESULT)

    def assert_part_has_whole_lines(self, reason):
        """Provenance, header, full rows, and the reason at last. Returns the number of rows."""
        self.assertEqual(self.text("run.csv"), OLD_RESULT)
        text = self.text("run.csv.part")
        self.assertTrue(text.endswith("\n"))
        lines = text.splitlines()
        if reason is not None:
            self.assertRegex(lines.pop(), "^# incomplete: " + reason)
        table = [line for line in lines if not line.startswith("#")]
        self.assertTrue(table[0].startswith("time_s,"))
        for row in table[1:]:
            self.assertEqual(len([float(field) for field in row.split(",")]), len(table[0].split(",")))
        return len(table) - 1

    def test_interrupted_runs_keep_what_there_is(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            part = self.path("run.csv.part")
            if os.path.exists(part):
                os.remove(part)
            process = subprocess.Popen(self.command(self.ENDLESS, "--output", "run.csv"), cwd=self.folder,
                                       stderr=subprocess.PIPE, text=True, preexec_fn=listen_to_interrupts)
            deadline = time.monotonic() + 60
            while time.monotonic() < deadline:
                if os.path.exists(part) and os.path.getsize(part) > 200000:
                    break
                time.sleep(0.02)
            process.send_signal(number)
            errors = process.communicate(timeout=60)[1]
            self.assertEqual(process.returncode, 130, errors)
            self.assertIn("interrupted at t = ", errors)
            self.assertGreater(self.assert_part_has_whole_lines("interrupted at t = [0-9.]+ s$"), 100)

    def test_a_full_disk_ends_the_run_and_leaves_the_old_result(self):
        """A limit on the size of a file stands for it. The mark finds its place wherever a row ends."""
        for size in range(300000, 300160, 20):
            result = self.gearsim(self.ENDLESS, "--output", "run.csv",
                                  preexec_fn=uncounted.limit_files(size))
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn("run.csv.part: File too large", result.stderr)
            self.assertGreater(self.assert_part_has_whole_lines("File too large$"), 1000)
            self.assertGreater(os.path.getsize(self.path("run.csv.part")), 299000)
            os.remove(self.path("run.csv.part"))

    def test_a_full_disk_ends_a_static_run_too(self):
        result = self.gearsim(["analysis.type=static", "analysis.positions=20000"], "--output", "run.csv",
                              preexec_fn=uncounted.limit_files(300000))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(self.text("run.csv"), OLD_RESULT)
        self.assertTrue(self.text("run.csv.part").endswith("\n"))

    def test_absurd_speeds_and_loads_have_a_reason_and_no_result(self):
        """Both may be any finite number; deviations that are scaled beyond all teeth are bad input."""
        static = "analysis.type=static"
        for settings, code, reason in [(["drive.start_rpm=1e300", "drive.end_rpm=1e300"], 1, "1e9 rad/s"),
                                       (["drive.end_rpm=-1e308"], 1, "no quasi-static start"),
                                       (["load.mean_Nm=1e300"], 1, "carries the torque"),
                                       ([static, "load.mean_Nm=-1e300"], 1, "carries the torque"),
                                       ([static, "analysis.loads=2", "load.end_Nm=1e308"], 1, "carries the torque"),
                                       ([*MEASURED, "flanks.scale=1e300"], 2, "beyond 1 m")]:
            result = self.gearsim(["analysis.duration_s=0.01", *settings], "--output", "absurd.csv")
            self.assertEqual(result.returncode, code, settings)
            self.assertIn(reason, result.stderr)
            self.assertFalse(os.path.exists(self.path("absurd.csv")), settings)

    def test_skipped_tooth_fails_with_time_and_reason(self):
        result = self.gearsim(["load.noise_amplitude_Nm=1e6", "analysis.duration_s=1"], "--output", "run.csv")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertRegex(result.stderr, "at t = [0-9.e-]+ s; the gears: ")
        self.assert_part_has_whole_lines(".*at t = [0-9.e-]+ s; the gears: ")

    def test_no_start_leaves_no_file(self):
        result = self.gearsim(["load.mean_Nm=1e7"], "--output", "run.csv")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("quasi-static start", result.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["run.csv", "run.ini"])
        self.assertEqual(self.text("run.csv"), OLD_RESULT)

    def test_whole_run_replaces_the_old_result(self):
        result = self.gearsim([], "--output", "run.csv")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(self.text("run.csv").startswith("# gearsim"))
        self.assertEqual(sorted(os.listdir(self.folder)), ["run.csv", "run.ini"])


class Progress(Case):
    def test_file_gets_a_summary_and_no_progress(self):
        result = self.gearsim([], "--output", "run.csv")
        self.assertRegex(result.stderr, r"^gearsim: 0\.02\S* s simulated in .* steps .* right-hand sides, .*\n"
                         r"gearsim: run\.csv: 513 rows in .* s\n$")
        self.assertNotIn("\r", result.stderr)

    def test_quiet_says_nothing(self):
        self.assertEqual(self.gearsim([], "--quiet", "--output", "run.csv").stderr, "")

    def shown(self, settings, *options):
        """What a terminal shows one after the other, of a run that is interrupted after 1.5 s."""
        master, slave = pty.openpty()
        process = subprocess.Popen(self.command(settings, "--output", "run.csv", *options), cwd=self.folder,
                                   stderr=slave, stdin=subprocess.DEVNULL, preexec_fn=listen_to_interrupts)
        os.close(slave)
        time.sleep(1.5)
        process.send_signal(signal.SIGINT)
        text = b""
        while True:
            try:
                chunk = os.read(master, 65536)
            except OSError:
                break
            if not chunk:
                break
            text += chunk
        os.close(master)
        self.assertEqual(process.wait(timeout=60), 130)
        return text.decode().split("\r")

    def test_terminal_shows_how_far_the_look_up_is_filled(self):
        """25830 columns take longer than the fifth of a second until something is shown."""
        filling = [*Ends.ENDLESS, *MEASURED, "solver.lookup=always", "solver.lookup_threads=2"]
        updates = [part for part in self.shown(filling) if "look-up" in part]
        self.assertRegex(updates[0], r"filling the look-up, [0-9]{1,2} %")
        self.assertLessEqual(len(updates), 10)
        self.assertEqual([part for part in self.shown(filling[:-1]) if "look-up" in part], [])

    def test_terminal_shows_time_speed_steps_and_time_left(self):
        """At most about five times a second."""
        for options, shown in [((), True), (("--quiet",), False)]:
            updates = [part for part in self.shown(Ends.ENDLESS, *options) if "rpm" in part]
            if shown:
                self.assertRegex(updates[0], r"[0-9.]+ of 30000 s, 1000 rpm, [0-9]+ steps, [0-9]+ s left")
                self.assertLessEqual(len(updates), 10)
            else:
                self.assertEqual(updates, [])


class DoubleHelical(Case):
    """17.5 mm with a gap of 2.5 mm: two halves of 7.5 mm."""

    HALVES = ["gears.double_helical_gap_mm=2.5"]
    TAN_BASE_HELIX = math.tan(math.radians(33)) * math.cos(math.atan(math.tan(math.radians(16)) / math.cos(math.radians(33))))

    def half(self, law):
        """A pair of one half alone, under half of the load."""
        own = [f"mesh.stiffness_N_per_m={K / 2!r}"] if law == "constant" else ["mesh.stiffness_N_per_m=", f"mesh.law={law}"]
        return ["gears.face_width_mm=7.5", f"load.mean_Nm={LOAD / 2!r}", f"mesh.damping_Ns_per_m={D / 2!r}",
                f"bodies.wheel_inertia_kg_m2={I_W / 2!r}", *own]

    def whole(self, law):
        return [*self.HALVES, *([] if law == "constant" else ["mesh.stiffness_N_per_m=", f"mesh.law={law}"])]

    def pitch(self, name, tooth_deviations):
        with open(self.path(name), "w") as file:
            file.write("tooth,flank,deviation_um\n" + "".join(f"{k},drive,{f!r}\n" for k, f in tooth_deviations))
        return name

    def test_without_deviations_it_is_two_of_its_halves(self):
        for law in ("constant", "iso6336", "elastic"):
            both = self.run_columns([*STATIC, *self.whole(law), "output.wrench=on"])
            one = self.run_columns([*STATIC, *self.half(law), "output.wrench=on"])
            # Halves of 7.5 mm to a rounding of their widths; elastic teeth to what their balance is found to.
            relative = 1e-8 if law == "elastic" else 1e-12
            self.assert_all_close(both["te_um"], one["te_um"], relative)
            for name, factor in [("mesh_stiffness_N_per_um", 2), ("contact_length_mm", 2), ("pairs_in_contact", 2),
                                 ("pinion_force_y_N", 2), ("wheel_moment_z_Nm", 2)]:
                self.assert_all_close(both[name], [factor * value for value in one[name]], 100 * relative)
            for name in ("pinion_force_z_N", "wheel_force_z_N", "pinion_moment_x_Nm", "wheel_moment_y_Nm", "apex_shift_um"):
                self.assert_all_close(both[name], [0] * len(both[name]), absolute=1e-6)
            self.assertGreater(abs(one["pinion_force_z_N"][0]), 100)

    def test_a_run_without_deviations_is_that_of_its_halves(self):
        for kind in ([], TORQUE):
            both = self.run_columns([*self.whole("constant"), *TIGHT, *kind])
            half = self.half("constant")
            if kind:
                half += ["drive.torque_Nm=11", f"bodies.pinion_inertia_kg_m2={I_P / 2!r}"]
            one = self.run_columns([*half, *TIGHT, *kind[:1], *([] if not kind else half[-2:])])
            self.assertEqual(list(both), [*one, "apex_shift_um"])
            # Solvers to 1e-9 at each step.
            self.assert_all_close(both["dte_um"], one["dte_um"], absolute=1e-4)
            self.assert_all_close(both["contact_force_N"], [2 * force for force in one["contact_force_N"]], absolute=0.1)

    def test_the_pinion_floats_to_where_both_halves_carry_the_same(self):
        everywhere = [(tooth, 6.0) for tooth in range(45)]
        first = [f"flanks.pinion_pitch={self.pitch('first.csv', everywhere)}",
                 f"flanks.pinion_second_half_pitch={self.pitch('none.csv', [(0, 0.0)])}"]
        second = [f"flanks.pinion_second_half_pitch={self.pitch('second.csv', everywhere)}"]
        ideal = self.run_columns([*STATIC, *self.HALVES])
        for law in ("constant", "elastic"):
            for settings, sign in ((first, 1), (second, -1)):
                c = self.run_columns([*STATIC, *self.whole(law), *settings, "output.wrench=on"])
                # Ends of the path follow x, not the thickness: 6 um of 5 mm, twice.
                for value in c["apex_shift_um"]:
                    self.assert_close(value, sign * 3.0 / self.TAN_BASE_HELIX, 2.5e-3)
                self.assert_all_close(c["pinion_force_z_N"], [0] * 60, absolute=1e-6)
                if law == "constant":
                    self.assert_all_close(c["te_um"], [te + 3.0 for te in ideal["te_um"]], absolute=0.02)

        # In a run it floats within what one tooth asks for, and the axial forces cancel.
        one_tooth = self.pitch("one.csv", [(0, 6.0)])
        run = self.run_columns([*self.HALVES, *PLAIN, f"flanks.wheel_second_half_pitch={one_tooth}", "output.wrench=on",
                                "analysis.duration_s=0.08"])
        shift = run["apex_shift_um"]
        self.assertGreater(max(map(abs, shift)), 1)
        self.assertLess(max(map(abs, shift)), 3.0 / self.TAN_BASE_HELIX)
        self.assert_all_close(run["wheel_force_z_N"], [0] * len(shift), absolute=1e-5)

    def test_flanks_of_the_second_half_are_mirrored_or_its_own(self):
        rows = [f"{tooth},drive,{t1},{t2},{4 * t1 * t1 + t2}" for tooth in range(45) for t1 in (0, 0.5, 1) for t2 in (0, 1)]
        with open(self.path("flanks.csv"), "w") as file:
            file.write("tooth,flank,t1,t2,deviation_um\n" + "\n".join(rows) + "\n")
        mirrored = self.run_columns([*STATIC, *self.HALVES, "flanks.pinion=flanks.csv"])
        given = self.run_columns([*STATIC, *self.HALVES, "flanks.pinion=flanks.csv", "flanks.pinion_second_half=flanks.csv"])
        self.assertEqual(mirrored, given)
        self.assert_all_close(mirrored["apex_shift_um"], [0] * 60, absolute=1e-9)

        # Only one half with it: the other way round the pinion floats the other way.
        with open(self.path("ideal.csv"), "w") as file:
            file.write("tooth,flank,t1,t2,deviation_um\n" + "".join(f"0,drive,{t1},{t2},0\n" for t1 in (0, 1) for t2 in (0, 1)))
        one = self.run_columns([*STATIC, *self.HALVES, "flanks.pinion=flanks.csv", "flanks.pinion_second_half=ideal.csv"])
        other = self.run_columns([*STATIC, *self.HALVES, "flanks.pinion=ideal.csv", "flanks.pinion_second_half=flanks.csv"])
        self.assert_all_close(one["te_um"], other["te_um"], 1e-9)
        self.assert_all_close(one["apex_shift_um"], [-shift for shift in other["apex_shift_um"]], 1e-6)
        self.assertGreater(min(map(abs, one["apex_shift_um"])), 0.5)

    def test_line_loads_lie_on_both_halves(self):
        self.run_columns([*STATIC, "analysis.positions=3", *self.whole("elastic"), "output.load_distribution=load.csv",
                          f"flanks.pinion_second_half_pitch={self.pitch('one.csv', [(0, 3.0)])}"])
        lines = [line for line in self.text("load.csv").splitlines() if not line.startswith("#")]
        rows = [dict(zip(lines[0].split(","), line.split(","))) for line in lines[1:]]
        z = [float(row["z_mm"]) for row in rows]
        self.assertLess(min(z), 1)
        self.assertGreater(max(z), 16.5)
        self.assertFalse([value for value in z if 7.5 + 1e-9 < value < 10 - 1e-9])

        # Trapezia along z of each line: both halves carry the same, to what 17 stations tell of it.
        force = [0.0, 0.0]
        for a, b in zip(rows, rows[1:]):
            if a["pinion_angle_rad"] == b["pinion_angle_rad"] and a["pair"] == b["pair"]:
                dz = abs(float(b["z_mm"]) - float(a["z_mm"]))
                if dz < 2:
                    mean = 0.5 * (float(a["line_load_N_per_mm"]) + float(b["line_load_N_per_mm"]))
                    force[float(a["z_mm"]) > 8.75] += mean * dz
        self.assert_close(force[0] / force[1], 1, 0.05)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        GEARSIM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
