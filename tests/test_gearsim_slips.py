#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause

"""Values in a unit that was hardly meant: told with the number to write; usual gears are passed in silence."""

import math
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
GEARSIM = GEARFLANKS = None

# Transverse module of 1.65 mm at 33 deg, and damping of 5 % of 2 sqrt(K I / r^2): written out here, not taken from gearsim.
TRANSVERSE = 1.9674  # 1.65 / cos 33 deg = 1.967400
PITCH = 15.393939  # 25.4 / 1.65

# Keys of a run, what is told of the last of them, and the number to write.
SLIPS = [
    ("gears.normal_module_mm=0.00165", "in metres", "1.65"),
    ("gears.normal_module_mm=1650", "in micrometres", "1.65"),
    (f"gears.normal_module_mm={PITCH}", "as the diametral pitch", "1.65"),
    (f"gears.normal_module_mm={TRANSVERSE}", "as the transverse module", "1.65"),
    ("gears.normal_pressure_angle_deg=0.27925268", "in radians", "16"),
    ("gears.helix_angle_deg=0.57595865", "in radians", "33"),
    ("gears.helix_angle_deg=-0.57595865", "in radians", "-33"),
    ("gears.center_distance_mm=0.085", "in metres", "85"),
    ("gears.center_distance_mm=3.3464567", "in inches", "85"),
    ("gears.center_distance_mm=85e3", "in micrometres", "85"),
    ("gears.face_width_mm=0.0175", "in metres", "17.5"),
    ("gears.pinion_face_width_mm=0.0175", "in metres", "17.5"),
    ("gears.wheel_face_width_mm=17500", "in micrometres", "17.5"),
    ("gears.face_width_mm= gears.pinion_face_width_mm=18 gears.wheel_face_width_mm=17.5 mesh.stiffness_N_per_m=14",
     "in N/(mm um)", "2.45e+08"),
    ("gears.pinion_rack_dedendum=2.8875", "in mm, not in modules", "1.75"),
    ("gears.wheel_rack_fillet_radius=0.627", "in mm, not in modules", "0.38"),
    ("gears.wheel_rack_dedendum=2.8875", "in mm, not in modules", "1.75"),
    ("gears.pinion_rack_fillet_radius=0.627", "in mm, not in modules", "0.38"),
    ("gears.pinion_tip_diameter_mm= gears.wheel_tip_diameter_mm= gears.pinion_rack_addendum=1.98",
     "in mm, not in modules", "1.2"),
    ("gears.pinion_tip_diameter_mm= gears.wheel_tip_diameter_mm= gears.wheel_rack_addendum=1.98",
     "in mm, not in modules", "1.2"),
    ("gears.pinion_tip_diameter_mm= gears.wheel_tip_diameter_mm= gears.pinion_tip_alteration=-1.155",
     "in mm, not in modules", "-0.7"),
    ("gears.pinion_tip_diameter_mm= gears.wheel_tip_diameter_mm= gears.wheel_tip_alteration=-1.155",
     "in mm, not in modules", "-0.7"),
    ("gears.pinion_profile_shift=2.475", "in mm, not in modules", "1.5"),
    ("gears.wheel_profile_shift=2.475", "in mm, not in modules", "1.5"),
    ("gears.pinion_tip_diameter_mm=0.09387678", "in metres", "93.8768"),
    ("gears.pinion_tip_diameter_mm=46.93839", "as the radius", "93.8768"),
    ("gears.wheel_tip_diameter_mm=0.086007182", "in metres", "86.0072"),
    ("gears.wheel_tip_diameter_mm=3.3861095", "in inches", "86.0072"),
    ("gears.pinion_start_diameter_mm=0.086", "in metres", "86"),
    ("gears.wheel_start_diameter_mm=39", "as the radius", "78"),
    ("gears.backlash_um=0.1", "in mm", "100"),
    ("gears.backlash_um=1e-4", "in metres", "100"),
    ("mesh.stiffness_N_per_m=300", "in N/um", "3e+08"),
    ("mesh.stiffness_N_per_m=14", "in N/(mm um)", "2.45e+08"),
    ("mesh.stiffness_N_per_m=3e5", "in N/mm", "3e+08"),
    ("mesh.stiffness_N_per_m=0.3", "in GN/m", "3e+08"),
    ("mesh.law=elastic mesh.stiffness_N_per_m= mesh.pinion_youngs_modulus_GPa=206000", "in MPa", "206"),
    ("mesh.law=elastic mesh.stiffness_N_per_m= mesh.wheel_youngs_modulus_GPa=3200", "in MPa", "3.2"),
    ("mesh.law=elastic mesh.stiffness_N_per_m= gears.pinion_bore_diameter_mm=0.035", "in metres", "35"),
    ("mesh.law=elastic mesh.stiffness_N_per_m= gears.wheel_bore_diameter_mm=0.04", "in metres", "40"),
    ("mesh.model=simple mesh.simple_stiffness_N_per_m=300", "in N/um", "3e+08"),
    ("gears.axial_offset_mm=-0.002", "in metres", "-2"),
    ("gears.double_helical_gap_mm=0.005", "in metres", "5"),
    ("mesh.friction_law=iso14179 mesh.roughness_Ra_um=0.4 mesh.oil_viscosity_mPas=0.08", "in Pa s", "80"),
    ("mesh.friction_law=iso14179 mesh.oil_viscosity_mPas=80 mesh.roughness_Ra_um=400", "in nm", "0.4"),
    ("pose.center_distance_change_um=0.04", "in mm", "40"),
    ("pose.offset_um=-3e-5", "in metres", "-30"),
    ("pose.axial_shift_um=0.05", "in mm", "50"),
    ("pose.skew_mrad=-0.0005", "in radians", "-0.5"),
    ("pose.inclination_mrad=1e-4", "in radians", "0.1"),
    ("mesh.damping_Ns_per_m=0.844", "in N s/mm", "844"),
    ("bodies.wheel_inertia_kg_m2=21", "in kg cm2", "0.0021"),
    ("bodies.wheel_inertia_kg_m2=2100", "in kg mm2", "0.0021"),
    ("drive.kind=torque drive.torque_Nm=21 bodies.pinion_inertia_kg_m2=2100", "in kg mm2", "0.0021"),
    ("load.mean_Nm=20000", "in N mm", "20"),
    ("load.mean_Nm=-20000", "in N mm", "-20"),
    ("analysis.type=static load.end_Nm=20000", "in N mm", "20"),
    ("drive.kind=torque bodies.pinion_inertia_kg_m2=2e-3 drive.torque_Nm=21000", "in N mm", "21"),
    ("load.noise_amplitude_Nm=10000", "in N mm", "10"),
    ("drive.start_rpm=104.72", "in rad/s", "1000"),
    ("drive.end_rpm=-1047.1976", "in rad/s", "-10000"),
    ("drive.kind=torque drive.torque_Nm=21 bodies.pinion_inertia_kg_m2=2e-3 analysis.stop_rpm=157.08", "in rad/s", "1500"),
    ("drive.start_rpm=16.6667", "in turns per second", "1000"),
    ("drive.end_rpm=-33.3333", "in turns per second", "-2000"),
    ("drive.start_rpm=-2400 drive.end_rpm=0 bodies.wheel_drag_Nms=300", "in N mm s", "0.3"),
    ("load.per_speed_Nms=100", "in N mm s", "0.1"),
    ("load.noise_amplitude_Nm=10 load.noise_interval_s=100", "in us", "0.0001"),
    ("drive.start_rpm=2400 drive.end_rpm=0 output.rate_Hz=25.6", "in kHz", "25600"),
    ("drive.start_rpm=0 drive.end_rpm=-2400 output.rate_Hz=0.0512", "in MHz", "51200"),
    ("solver.max_step_s=100", "in us", "0.0001"),
    ("flanks.profile_blend=10", "in percent", "0.1"),
    ("flanks.scale=1e-6", "as a change of unit", "1"),
    ("modifications.pinion_crowning_um=0.005", "in mm", "5"),
    ("modifications.wheel_coast_helix_slope_um=-0.01", "in mm", "-10"),
    ("modifications.wheel_twist_um=8e-6", "in metres", "8"),
    ("modifications.pinion_tip_relief_um=10 modifications.pinion_tip_relief_share=0.3 "
     "modifications.wheel_end_relief_I_um=4 modifications.wheel_end_relief_I_length_mm=0.004", "in metres", "4"),
    ("modifications.pinion_tip_relief_um=10 modifications.pinion_tip_relief_length_mm=0.003", "in metres", "3"),
    ("modifications.pinion_tip_relief_um=10 modifications.pinion_tip_relief_share=30", "in percent", "0.3"),
    ("modifications.pinion_tip_relief_um=10 modifications.pinion_tip_relief_diameter_mm=46", "as the radius", "92"),
]

# Refused, and the message says what was perhaps meant.
REFUSED = [
    ("gears.face_width_mm=0.0005", "; was it meant in metres? write 0.5"),
    ("gears.pinion_start_diameter_mm=0.0015", "; was it meant in metres? write 1.5"),
    ("mesh.pinion_youngs_modulus_GPa=2.06e11", "; was it meant in Pa? write 206"),
    ("mesh.roughness_Ra_um=4e-4", "; was it meant in mm? write 0.4"),
    ("pose.skew_mrad=-400", "; was it meant in microradians? write -0.4"),
    ("flanks.profile_from=20", "; was it meant in percent? write 0.2"),
    ("mesh.friction_coefficient=6", "; was it meant in percent? write 0.06"),
    ("mesh.iso_blank_factor=80", "; was it meant in percent? write 0.8"),
    ("mesh.damping_ratio=5", "; was it meant in percent? write 0.05"),
]

# Gears as they are published or in use, each in its key = value pairs of [gears].
USUAL = {
    "reduction gear of a wind turbine": "24 95 14 20 10 861 360 gears.pinion_profile_shift=0.48 gears.wheel_profile_shift=0.6691",
    "tests of planet carriers": "12 24 3 20 0 56.5 30 gears.pinion_profile_shift=0.6 gears.wheel_profile_shift=0.36",
    "a hobbed watch wheel": "8 60 0.12 20 0 4.1 0.4",
    "a ship's bull gear": "41 430 12 20 30 3263 900",
    "a pinion of 8 teeth": "8 42 2 20 20 54.0088886237956 20",
    "a thin spur pair": "20 20 1 20 0 20 0.5",
    "high shifts": "15 17 4 20 0 69 40",
}


def center_distance(module, helix, teeth, shifts):
    """Without backlash, for 20 deg (mm): inv alpha_wt = inv alpha_t + 2 tan(alpha_n) sum(x) / sum(z), ISO 21771-1."""
    def involute(angle):
        return math.tan(angle) - angle

    transverse = math.atan(math.tan(math.radians(20)) / math.cos(math.radians(helix)))
    wanted = involute(transverse) + 2 * math.tan(math.radians(20)) * shifts / teeth
    low, high = 0, 1
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if involute(middle) < wanted else (low, middle)
    return module * teeth / (2 * math.cos(math.radians(helix))) * math.cos(transverse) / math.cos(low)


class Slips(unittest.TestCase):
    def setUp(self):
        self.paper = os.path.join(ROOT, "data", "paper", "fig12.ini")
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def check(self, settings, *options, path=None):
        arguments = [text for setting in settings.split() for text in ("--set", setting)]
        return subprocess.run([GEARSIM, path or self.paper, "--check", "--set", "mesh.model=3d", *arguments, *options],
                              cwd=self.folder.name, capture_output=True, text=True, check=False)

    def test_slips_are_told_with_the_number_to_write(self):
        for settings, meant, right in SLIPS:
            with self.subTest(settings):
                key, _, value = settings.split()[-1].partition("=")
                result = self.check(settings)
                self.assertRegex(result.stderr, f"(?m)^--set {key}: warning: is {value.replace('+', '.')}[ ,].*; was it meant ")
                self.assertIn(f"; was it meant {meant}? write {right}\n", result.stderr)
                self.assertEqual(result.stderr.count("was it meant"), 1)  # and of no other key

    def test_right_values_are_passed_in_silence(self):
        """The number to write is told nothing of, whatever it is written for."""
        for settings, _, right in SLIPS:
            key = settings.split()[-1].partition("=")[0]
            if key.endswith("_share") or key == "flanks.scale":
                continue
            with self.subTest(key):
                others = " ".join(settings.split()[:-1])
                self.assertNotIn("was it meant", self.check(f"{others} {key}={right}").stderr)

    def test_all_lengths_in_metres_are_told_at_once(self):
        result = self.check("gears.normal_module_mm=0.00165 gears.center_distance_mm=0.085 gears.face_width_mm=0.0175 "
                            "gears.pinion_tip_diameter_mm=0.09387678 gears.wheel_tip_diameter_mm=0.086007182")
        self.assertEqual(result.stderr.count("was it meant in metres? write "), 5)

    def test_a_drawing_in_inches(self):
        result = self.check(f"gears.normal_module_mm={PITCH} gears.center_distance_mm=3.3464567 gears.face_width_mm=0.2")
        self.assertIn("was it meant as the diametral pitch? write 1.65\n", result.stderr)
        self.assertIn("center_distance_mm: warning: is 3.3464567 mm, which does not fit the other; was it meant in inches? "
                      "write 85\n", result.stderr)
        self.assertIn("was it meant in inches? write 5.08\n", result.stderr)

    def test_a_pitch_is_told_from_a_distance_in_inches(self):
        """Where the one number and the square of 25.4 are about the same."""
        gears = ("gears.pinion_teeth=30 gears.wheel_teeth=50 gears.helix_angle_deg=0 gears.normal_pressure_angle_deg=20 "
                 "gears.pinion_tip_diameter_mm= gears.wheel_tip_diameter_mm= gears.face_width_mm=40 ")
        for settings, meant in [("gears.center_distance_mm=42.3333 gears.normal_module_mm=24", "as the diametral pitch? write 1.05833"),
                                ("gears.center_distance_mm=37.795 gears.normal_module_mm=24", "in inches? write 959.993")]:
            with self.subTest(settings):
                result = self.check(gears + settings)
                self.assertIn(f"; was it meant {meant}\n", result.stderr)
                self.assertEqual(result.stderr.count("was it meant"), 1)

    def test_transverse_module_of_small_helix_angles(self):
        """Where the shifts are given, or where there are none and the sum of the pitch circles gives it away."""
        helix, teeth = 10, 50
        transverse = 3 / math.cos(math.radians(helix))
        for shifts in (0.4, 0):
            distance = center_distance(3, helix, teeth, shifts)
            settings = (f"gears.pinion_teeth=20 gears.wheel_teeth={teeth - 20} gears.helix_angle_deg={helix} "
                        f"gears.normal_pressure_angle_deg=20 gears.center_distance_mm={distance:.9g} "
                        "gears.pinion_tip_diameter_mm= gears.wheel_tip_diameter_mm= ")
            given = f"gears.pinion_profile_shift={shifts} gears.wheel_profile_shift=0 " if shifts else ""
            with self.subTest(shifts):
                result = self.check(settings + given + f"gears.normal_module_mm={transverse:.9g}")
                self.assertIn("was it meant as the transverse module? write 3\n", result.stderr)
                self.assertNotIn("was it meant", self.check(settings + given + "gears.normal_module_mm=3").stderr)

    def test_rings_have_slips_of_their_own(self):
        """The difference of the teeth decides, and shifts of the pinion alone move the axes to the other side."""
        helix = 20
        transverse = 2 / math.cos(math.radians(helix))
        ring = ("gears.pinion_teeth=20 gears.wheel_teeth=-60 gears.normal_pressure_angle_deg=20 gears.pinion_rack_dedendum= "
                "gears.wheel_rack_dedendum= gears.pinion_rack_addendum= gears.wheel_rack_addendum= "
                "gears.pinion_tip_diameter_mm= gears.wheel_tip_diameter_mm= ")
        spur = ring + "gears.helix_angle_deg=0 gears.normal_module_mm=2 gears.center_distance_mm=40 "
        helical = ring + f"gears.helix_angle_deg={helix} gears.center_distance_mm={20 * transverse:.9g} "
        far = "far from half the difference of the reference diameters"
        for settings, why, meant in [
                (spur + "gears.center_distance_mm=0.04", far, "in metres? write 40"),
                (spur + "gears.center_distance_mm=1.5748031", far, "in inches? write 40"),
                (spur + "gears.normal_module_mm=12.7", "which does not fit", "as the diametral pitch? write 2"),
                (spur + "gears.wheel_tip_diameter_mm=58", "far from the reference diameter", "as the radius? write 116"),
                (helical + f"gears.normal_module_mm={transverse:.9g}", "which does not fit", "as the transverse module? write 2")]:
            with self.subTest(settings):
                result = self.check(settings)
                self.assertIn(f"; was it meant {meant}\n", result.stderr)
                self.assertIn(why, result.stderr)
                self.assertEqual(result.stderr.count("was it meant"), 1)
        for settings in (spur, helical + "gears.normal_module_mm=2", spur + "gears.wheel_tip_diameter_mm=116"):
            self.assertNotIn("was it meant", self.check(settings).stderr)

    def test_rows_and_drag_go_by_the_fastest_speed_that_is_known(self):
        """2400 rpm are 40 turns per second; with a torque nothing is known of the speed."""
        torque = "drive.kind=torque drive.torque_Nm=21 bodies.pinion_inertia_kg_m2=2e-3 "
        for settings in ("drive.start_rpm=2400 drive.end_rpm=0 output.rate_Hz=41",
                         torque + "drive.start_rpm=2400 output.rate_Hz=25.6",
                         torque + "bodies.wheel_drag_Nms=300",
                         "drive.start_rpm=1 drive.end_rpm=0 bodies.wheel_drag_Nms=300"):
            with self.subTest(settings):
                self.assertNotIn("was it meant", self.check(settings).stderr)

    def test_a_speed_is_not_taken_for_one_that_no_gear_reaches(self):
        """3456.7 turns per second are 207 402 rpm, which is close to a multiple of 100 by chance."""
        for speed in ("3456.7", "-3456.7", "4321.7"):
            with self.subTest(speed):
                self.assertNotIn("was it meant", self.check(f"drive.end_rpm={speed}").stderr)

    def test_a_stiffness_that_two_units_explain_names_both(self):
        result = self.check("gears.face_width_mm=5 mesh.stiffness_N_per_m=20")
        self.assertIn("was it meant in N/um? write 2e+07\n", result.stderr)
        self.assertIn("was it meant in N/(mm um)? write 1e+08\n", result.stderr)

    def test_a_damping_ratio_gives_that_share_of_critical_damping(self):
        result = self.check("mesh.damping_Ns_per_m=0.05")
        text = result.stderr.partition("was it meant as the damping ratio? write ")[2]
        radius = {z: 0.5e-3 * z * 1.65 / math.cos(math.radians(33)) for z in (45, 41)}
        mass = 2.1e-3 / radius[41] ** 2
        self.assertAlmostEqual(float(text.split()[0]) / (2 * 0.05 * (1.05e8 * mass) ** 0.5), 1, delta=1e-5)

        # A pinion driven by a torque moves as well.
        result = self.check("mesh.damping_Ns_per_m=0.05 drive.kind=torque drive.torque_Nm=21 "
                            "bodies.pinion_inertia_kg_m2=1e-3")
        text = result.stderr.partition("was it meant as the damping ratio? write ")[2]
        mass = 1 / (radius[41] ** 2 / 2.1e-3 + radius[45] ** 2 / 1e-3)
        self.assertAlmostEqual(float(text.split()[0]) / (2 * 0.05 * (1.05e8 * mass) ** 0.5), 1, delta=1e-5)

    def test_refused_values_say_what_was_perhaps_meant(self):
        for setting, end in REFUSED:
            with self.subTest(setting):
                result = self.check(setting)
                self.assertEqual(result.returncode, 2)
                self.assertIn(f"(got {setting.partition('=')[2]}){end}\n", result.stderr)

    def test_usual_gears_are_passed_in_silence(self):
        keys = ["pinion_teeth", "wheel_teeth", "normal_module_mm", "normal_pressure_angle_deg", "helix_angle_deg",
                "center_distance_mm", "face_width_mm"]
        for name, text in USUAL.items():
            with self.subTest(name):
                values = text.split()
                path = os.path.join(self.folder.name, "gears.ini")
                with open(path, "w", encoding="utf-8") as file:
                    file.write("[gears]\n" + "".join(f"{key} = {value}\n" for key, value in zip(keys, values)))
                result = subprocess.run([GEARSIM, path, "--geometry", *[text for setting in values[7:]
                                                                        for text in ("--set", setting)]],
                                        capture_output=True, text=True, check=False)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertNotIn("was it meant", result.stderr)

    def test_examples_are_passed_in_silence(self):
        for path in ["example/params.ini", "paper/fig16.ini", "relief/params.ini"]:
            result = self.check("", path=os.path.join(ROOT, "data", path))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertNotIn("warning", result.stderr)

    def test_quiet_leaves_them_out_and_defaults_are_not_told(self):
        self.assertEqual(self.check("gears.backlash_um=0.1", "--quiet").stderr, "")
        self.assertNotIn("warning", self.check("mesh.damping_Ns_per_m=").stderr)

    def test_a_run_without_any_damping_is_noted(self):
        note = "mesh.damping_ratio: note: is not given, nor is mesh.damping_Ns_per_m"
        self.assertIn(note, self.check("mesh.damping_Ns_per_m=").stderr)

        # Whoever writes a 0 means it, static curves have no vibrations, and --quiet is quiet.
        self.assertNotIn(note, self.check("mesh.damping_Ns_per_m=0").stderr)
        self.assertNotIn(note, self.check("mesh.damping_Ns_per_m= mesh.damping_ratio=0.05").stderr)
        self.assertNotIn(note, self.check("mesh.damping_Ns_per_m= analysis.type=static").stderr)
        self.assertEqual(self.check("mesh.damping_Ns_per_m=", "--quiet").stderr, "")

    def test_gearflanks_tells_them_of_its_gears(self):
        path = os.path.join(self.folder.name, "metres.ini")
        with open(path, "w", encoding="utf-8") as file:
            file.write("[gears]\npinion_teeth = 45\nwheel_teeth = 41\nnormal_module_mm = 0.00165\n"
                       "normal_pressure_angle_deg = 16\nhelix_angle_deg = 33\ncenter_distance_mm = 0.085\n"
                       "face_width_mm = 0.0175\n[mesh]\nstiffness_N_per_m = 300\n")
        result = subprocess.run([GEARFLANKS, path, "--gear", "pinion", "--evaluate"],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.stderr.count("was it meant in metres? write "), 3)
        self.assertNotIn("stiffness", result.stderr)  # which it has no use for
        self.assertNotIn("gearsim", result.stderr)


if __name__ == "__main__":
    GEARSIM, GEARFLANKS = (os.path.abspath(path) for path in sys.argv[1:3])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
