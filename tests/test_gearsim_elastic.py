#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elastic teeth through gearsim: gear data and a load, and nothing else, against finite elements and what a user may get wrong.

    test_gearsim_elastic.py GEARSIM
"""
import csv
import itertools
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile
import unittest

GEARSIM = ""

# Finite elements, and what is known in closed form, know no tip edges.
OFF = {"corner_contact": "off"}
SPUR = {  # 20/40, 300 N per mm of face
    "gears": {"pinion_teeth": 20, "wheel_teeth": 40, "normal_module_mm": 4, "normal_pressure_angle_deg": 20,
              "center_distance_mm": 120, "face_width_mm": 32},
    "mesh": OFF,
    "load": {"mean_Nm": 300 * 32 * 0.08 * math.cos(math.radians(20))},
    "analysis": {"type": "static", "positions": 60},
}
NREL = {  # stage 3 of the NREL 5 MW gearbox, 720 N per mm
    "gears": {"pinion_teeth": 24, "wheel_teeth": 95, "normal_module_mm": 14, "normal_pressure_angle_deg": 20,
              "helix_angle_deg": 10, "center_distance_mm": 861.0001467, "face_width_mm": 360, "pinion_profile_shift": 0.48,
              "wheel_profile_shift": 0.6691, "pinion_tip_diameter_mm": 380.7473416, "wheel_tip_diameter_mm": 1395.3761938},
    "mesh": OFF,
    "load": {"mean_Nm": 259200 * 0.6333850},
    "analysis": {"type": "static", "positions": 60},
}
SPUR62 = {  # 62/62, 100 N per mm
    "gears": {"pinion_teeth": 62, "wheel_teeth": 62, "normal_module_mm": 2, "normal_pressure_angle_deg": 20,
              "center_distance_mm": 124, "face_width_mm": 20},
    "mesh": OFF,
    "load": {"mean_Nm": 2000 * 0.062 * math.cos(math.radians(20))},
    "analysis": {"type": "static", "positions": 60},
}


class Elastic(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def write(self, sections, name="run.ini"):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            for section, keys in sections.items():
                file.write(f"[{section}]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items()))

    def gearsim(self, *arguments):
        return subprocess.run([GEARSIM, "run.ini", "--quiet", *arguments], cwd=self.folder, capture_output=True, text=True,
                              check=False)

    def table(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))

    def rows(self, sections, *arguments):
        self.write(sections)
        result = self.gearsim(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.table("run.csv")

    def refused(self, sections, *texts, arguments=()):
        self.write(sections)
        result = self.gearsim(*arguments)
        self.assertEqual(result.returncode, 2, result.stderr)
        for text in texts:
            self.assertIn(text, result.stderr)

    def test_transmission_error_is_that_of_finite_elements(self):
        # Quadratic elements, plane and of twisted teeth at five positions: mean and peak to peak (um), and what they leave open.
        for name, gears, mean, peak_to_peak, mean_part, peak_part in (("spur", SPUR, 14.025, 7.372, 0.025, 0.02),
                                                                      ("NREL", NREL, 30.14, 3.39, 0.03, 0.15)):
            with self.subTest(name):
                error = [-float(row["te_um"]) for row in self.rows(gears)]
                self.assertAlmostEqual(sum(error) / len(error), mean, delta=mean_part * mean)
                self.assertAlmostEqual(max(error) - min(error), peak_to_peak, delta=peak_part * peak_to_peak)

    def test_misaligned_flanks_carry_at_one_end(self):
        # Face load factor by finite elements where one pair carries at the pitch point; the skew opens 5 and 20 um.
        for gap_um, factor in ((5, 1.616), (20, 3.270)):
            skew_mrad = gap_um / 20 / math.cos(math.radians(20))
            gears = SPUR62["gears"] | {"backlash_um": 60}  # so that the other flanks stay apart
            rows = self.rows(SPUR62 | {"gears": gears, "pose": {"skew_mrad": skew_mrad}})
            single = [row for row in rows if float(row["pairs_in_contact"]) == 1]
            middle = single[len(single) // 2]
            self.assertAlmostEqual(float(middle["face_load_factor"]), factor, delta=0.12 * factor)

    def test_line_loads_add_up_to_the_load(self):
        rows = self.rows(NREL | {"output": {"load_distribution": "load.csv"}})
        points = self.table("load.csv")
        self.assertEqual(list(points[0]), "pinion_angle_rad load_torque_Nm pair flank z_mm pinion_roll_length_mm "
                         "wheel_roll_length_mm line_load_N_per_mm pressure_N_per_mm2 gap_um".split())
        self.assertEqual(len({point["pinion_angle_rad"] for point in points}), len(rows))

        # Over all positions the sums of stations and the load agree, as ends of lines between stations even out.
        width_mm = 360 / (len({point["z_mm"] for point in points}) - 1)
        total = sum(float(point["line_load_N_per_mm"]) for point in points) * width_mm / len(rows)
        ends = sum(float(point["line_load_N_per_mm"]) for point in points
                   if float(point["z_mm"]) in (0.0, 360.0)) * width_mm / 2 / len(rows)
        self.assertAlmostEqual(total - ends, 259200, delta=0.01 * 259200)

        # Hertz: p_0 = sqrt(q E* / (pi rho)), E* of two steel bodies.
        point = max(points, key=lambda row: float(row["line_load_N_per_mm"]))
        rho_p, rho_w = (float(point[f"{gear}_roll_length_mm"]) * 1e-3 for gear in ("pinion", "wheel"))
        base_helix = math.radians(9.39073)
        rho = rho_p * rho_w / (rho_p + rho_w) / math.cos(base_helix)
        pressure = math.sqrt(float(point["line_load_N_per_mm"]) * 1e3 * 206e9 / (2 * 0.91) / (math.pi * rho))
        self.assertAlmostEqual(float(point["pressure_N_per_mm2"]) * 1e6, pressure, delta=1e-4 * pressure)
        self.assertEqual({point["flank"] for point in points}, {"drive"})

        # The largest of a row is that of its points, or at the end of a line between them.
        largest = max(float(row["largest_line_load_N_per_mm"]) for row in rows)
        self.assertGreaterEqual(largest, float(point["line_load_N_per_mm"]) * 0.999999)
        self.assertLess(largest, 1.15 * float(point["line_load_N_per_mm"]))

    def test_constant_stiffness_has_line_loads_too(self):
        self.rows(SPUR62 | {"mesh": {"stiffness_N_per_m": 2.8e8}, "output": {"load_distribution": "load.csv"}})
        points = self.table("load.csv")
        for angle in {point["pinion_angle_rad"] for point in points}:
            loads = [float(point["line_load_N_per_mm"]) for point in points if point["pinion_angle_rad"] == angle]
            self.assertAlmostEqual(sum(loads) / 17 * 20, 2000, delta=1e-5 * 2000)  # even along the face
        self.assertNotIn("face_load_factor", self.table("run.csv")[0])

    def test_edges_of_constant_stiffness_have_line_loads_and_no_pressure(self):
        rows = self.rows(SPUR62 | {"mesh": {"stiffness_N_per_m": 2.8e8, "corner_contact": "on"},
                                   "output": {"load_distribution": "load.csv"}})
        points = self.table("load.csv")
        edges = [point for point in points if point["pressure_N_per_mm2"] == "nan"]
        self.assertTrue(0 < len(edges) < len(points) / 2)
        self.assertTrue(all(float(point["line_load_N_per_mm"]) > 0 for point in edges))
        self.assertEqual(len({point["pinion_angle_rad"] for point in points}), len(rows))

        # An edge has the roll length of its tip, 64 mm above the base circle of 62 teeth, and bears by its gap less.
        tip = math.sqrt(64 ** 2 - (62 * math.cos(math.radians(20))) ** 2)
        for point in edges:
            rolls = float(point["pinion_roll_length_mm"]), float(point["wheel_roll_length_mm"])
            self.assertAlmostEqual(max(rolls), tip, delta=1e-6)

    def test_soft_tooth_shows_once_a_turn(self):
        with open(os.path.join(self.folder, "soft.csv"), "w", encoding="utf-8") as file:
            file.write("# a crack\ntooth,factor\n7,0.7\n")
        gears = SPUR62 | {"flanks": {"pinion_tooth_stiffness": "soft.csv"},
                          "analysis": {"type": "static", "period": "pinion", "positions": 62 * 8}}
        error = [-float(row["te_um"]) for row in self.rows(gears)]
        passes = [error[8 * k:8 * k + 8] for k in range(62)]
        usual = passes[30]
        soft = [k for k in range(62) if max(abs(a - b) for a, b in zip(passes[k], usual)) > 0.02]
        self.assertLessEqual(len(soft), 4)
        self.assertGreaterEqual(len(soft), 2)
        self.assertGreater(max(max(passes[k]) for k in soft), max(usual) * 1.02)

    def test_softer_material_gives_way_more(self):
        steel = [float(row["te_um"]) for row in self.rows(SPUR62)]
        soft = [float(row["te_um"]) for row in
                self.rows(SPUR62 | {"mesh": OFF | {"pinion_youngs_modulus_GPa": 103, "wheel_youngs_modulus_GPa": 103}})]
        for a, b in zip(steel, soft):
            self.assertTrue(1.9 < b / a < 2.0, b / a)  # the contact alone is not quite linear

    def test_bodies_wind_up(self):
        plain = self.rows(SPUR62)
        wound = self.rows(SPUR62 | {"gears": SPUR62["gears"] | {"wheel_bore_diameter_mm": 40}})
        moves = [float(a["te_um"]) - float(b["te_um"]) for a, b in zip(plain, wound)]
        r_b, r_f, r_i, b = 0.062 * math.cos(math.radians(20)), 0.0595, 0.02, 0.02
        shear_modulus = 206e9 / 2.6
        expected = 2000 * r_b ** 2 / (4 * math.pi * shear_modulus * b) * (1 / r_i ** 2 - 1 / r_f ** 2) * 1e6
        for move in moves:
            self.assertAlmostEqual(move, expected, delta=1e-4 * expected)

    def test_a_run_needs_gear_data_load_and_inertias_alone(self):
        gears = NREL | {"analysis": {"duration_s": 0.02}, "drive": {"start_rpm": 300, "end_rpm": 300},
                        "bodies": {"wheel_inertia_kg_m2": 600}, "mesh": OFF | {"damping_ratio": 0.05}}
        rows = self.rows(gears)
        late = [float(row["contact_force_N"]) for row in rows[len(rows) // 2:]]
        self.assertAlmostEqual(sum(late) / len(late), 259200, delta=0.01 * 259200)
        with open(os.path.join(self.folder, "run.csv"), encoding="utf-8") as file:
            self.assertIn("# mesh.law = elastic\n", file.read())

        # And the same from look-up tables.
        for threads in ("0", "3"):
            cached = self.rows(gears, "--set", "solver.lookup=always", "--set", f"solver.lookup_threads={threads}")
            for a, b in zip(rows, cached):
                self.assertAlmostEqual(float(a["dte_um"]), float(b["dte_um"]), delta=0.1)

    def test_long_runs_look_up_by_themselves(self):
        """With the edges that elastic teeth have by default: tables of 32 x 40 cells leave 0.2 % of the vibration's force."""
        gears = {key: value for key, value in NREL.items() if key != "mesh"}
        gears |= {"analysis": {"duration_s": 0.8}, "drive": {"start_rpm": 900, "end_rpm": 1200},
                  "bodies": {"wheel_inertia_kg_m2": 600}, "mesh": {"damping_ratio": 0.05},
                  "solver": {"relative_tolerance": 1e-4}, "output": {"columns": "contact_force_N"}}
        tight = ["--set", "solver.relative_tolerance=1e-7", "--set", "solver.absolute_tolerance_um=1e-7"]
        forces = []
        for arguments, looks_up in ((["--set", "solver.lookup=off"], False), ([], True), (tight, False),
                                    ([*tight, "--set", "solver.lookup=always"], True)):
            forces.append([float(row["contact_force_N"]) for row in self.rows(gears, *arguments)][1000:])
            with open(os.path.join(self.folder, "run.csv"), encoding="utf-8") as file:
                head = "".join(line for line in file if line.startswith("#"))
            self.assertEqual("# lookup_tables = " in head, looks_up, arguments)
            if arguments == []:
                self.assertIn("# lookup_tables = 32 x 40 cells", head)

        # What gearsim-solver.md says of the solver at its default tolerance, 1 %, holds with the tables too.
        def error(force):
            return statistics.pstdev([a - b for a, b in zip(forces[2], force)]) / statistics.pstdev(forces[2])

        self.assertLess(error(forces[3]), 0.005)
        self.assertLess(error(forces[1]), 0.01)

    def test_listing_states_the_stiffness_at_the_load(self):
        for key in ("off", "on"):
            gears = NREL | {"mesh": {"corner_contact": key}}
            self.write(gears)
            result = self.gearsim("--geometry")
            lines = dict(line.split(" = ") for line in result.stdout.splitlines())
            mean, smallest, largest = (float(value) for value in lines["mesh_stiffness_N_per_um"].split(", "))
            stiffness = [float(row["mesh_stiffness_N_per_um"]) for row in self.rows(gears)]
            self.assertAlmostEqual(mean, sum(stiffness) / len(stiffness), delta=2e-3 * mean)
            self.assertAlmostEqual(smallest, min(stiffness), delta=1e-2 * mean)
            self.assertAlmostEqual(largest, max(stiffness), delta=1e-2 * mean)
            single = [float(value) for value in lines["single_stiffness_N_per_um"].split(", ")]
            self.assertTrue(single[1] < single[0] < single[2] < smallest)

    def test_teeth_that_have_no_elastic_law_are_refused_with_the_reason(self):
        deep = SPUR62 | {"gears": SPUR62["gears"] | {"pinion_rack_dedendum": 1.75}}
        self.refused(deep, "gears.pinion_rack_fillet_radius: must be", "here 0.", "(got none, so it is 0.38)",
                     "mesh.stiffness_N_per_m")
        self.refused(SPUR62 | {"gears": SPUR62["gears"] | {"wheel_bore_diameter_mm": 119.5}},
                     "gears.wheel_bore_diameter_mm: must be a bore below the root circle")
        few = {"gears": SPUR62["gears"] | {"pinion_teeth": 12, "center_distance_mm": 74, "pinion_tip_alteration": 0}}
        self.refused(SPUR62 | few, "gears.pinion_")
        ring = {"gears": SPUR62["gears"] | {"pinion_teeth": 36, "wheel_teeth": -93, "normal_module_mm": 21,
                                            "center_distance_mm": 584, "pinion_profile_shift": 0.5039,
                                            "wheel_profile_shift": 0.1171, "pinion_tip_alteration": -0.08338}}
        for gear, key, value, text in (("wheel", "bore_diameter_mm", 1500, "must be none: a ring has no bore below its teeth"),
                                       ("wheel", "rack_fillet_radius", 0.7, "must be a rounding that fits into the spaces")):
            gears = ring["gears"] | {f"{gear}_{key}": value}
            self.refused(SPUR62 | {"gears": gears}, f"run.ini:", f"gears.{gear}_{key}: {text}", f"(got {value})")
        for key, value in (("pinion_youngs_modulus_GPa", 0), ("wheel_youngs_modulus_GPa", "1e7"),
                           ("pinion_poisson_ratio", 0.5), ("stations", 1), ("stations", 98)):
            self.refused(SPUR62 | {"mesh": {key: value}}, f"run.ini:", f"mesh.{key}: must be")

        # A listing of the drawing goes without.
        self.write(deep)
        self.assertEqual(self.gearsim("--geometry").returncode, 0)

    def test_ring_is_computed_with_a_warning(self):
        """A ring of very many teeth is the rack of the same pinion, as a wheel is, but for the foot under 60 degrees."""
        error = {}
        for teeth in (-4000, 4000):
            ring = {"pinion_teeth": 36, "wheel_teeth": teeth, "normal_module_mm": 4, "pinion_profile_shift": 0.3,
                    "wheel_profile_shift": -0.3, "wheel_tip_alteration": -0.3, "center_distance_mm": 2 * abs(36 + teeth), "face_width_mm": 40}
            gears = SPUR62 | {"gears": SPUR62["gears"] | ring, "load": {"mean_Nm": 300 * 40 * 8 * math.cos(math.radians(20))}}
            self.write(gears)
            result = subprocess.run([GEARSIM, "run.ini"], cwd=self.folder, capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual("run.ini:3: gears.wheel_teeth: warning: the elastic law of a ring is unmeasured" in result.stderr,
                             teeth < 0, result.stderr)
            error[teeth] = [-float(row["te_um"]) for row in self.table("run.csv")]
        self.assertTrue(all(1 < a / b < 1.04 for a, b in zip(error[-4000], error[4000])))

    def test_pressure_that_no_material_bears_is_warned_of_once(self):
        run = {"analysis": {"duration_s": 0.005}, "drive": {"start_rpm": 100, "end_rpm": 100},
               "bodies": {"wheel_inertia_kg_m2": 0.02}, "mesh": {"damping_ratio": 0.05}}
        for sections in ({}, {"output": {"columns": "te_um"}}, {"analysis": {"type": "static", "loads": 3, "positions": 4},
                                                                "load": {"mean_Nm": 20000, "end_Nm": 100}}, run):
            for torque in (100, 20000):
                load = sections.get("load", {"mean_Nm": torque})
                self.write(SPUR62 | {"load": load, "mesh": {}} | sections)
                result = subprocess.run([GEARSIM, "run.ini"], cwd=self.folder, capture_output=True, text=True, check=False)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(result.stderr.count("load.mean_Nm: warning: the contact pressure reaches"),
                                 load["mean_Nm"] > 1000, result.stderr)

    def test_too_few_stations_are_told_with_how_many_are_right(self):
        """On the short lines of wide gears of large helix angle stations are far apart, with tip edges and without."""
        gears = SPUR["gears"] | {"pinion_teeth": 32, "wheel_teeth": 77, "helix_angle_deg": 34, "face_width_mm": 120,
                                 "center_distance_mm": 218 / math.cos(math.radians(34))}
        wide = {"gears": gears, "load": {"mean_Nm": 200 * 120 * 0.18}, "analysis": {"type": "static", "positions": 20}}
        told = r"run.ini:\d+: mesh.stations: note: 17 stations leave some ([\d.]+) % .*; (\d+) leave 0.4"
        for mesh in ({}, OFF):
            error, stderr = {}, {}
            for stations in (17, "told", None, 97):
                settings = {"stations": int(re.search(told, stderr[17])[2]) if stations == "told" else stations}
                settings = {} if stations is None else settings
                self.write(wide | {"mesh": mesh | settings})
                result = subprocess.run([GEARSIM, "run.ini"], cwd=self.folder, capture_output=True, text=True, check=False)
                self.assertEqual(result.returncode, 0, result.stderr)
                stderr[stations] = result.stderr
                error[stations] = [float(row["te_um"]) for row in self.table("run.csv")]
            left = {stations: max(abs(a / b - 1) for a, b in zip(error[stations], error[97])) for stations in (17, None)}
            estimate = float(re.search(told, stderr[17])[1]) / 100
            self.assertTrue(0.4 * estimate < left[17] < 1.2 * estimate, (left, estimate))
            self.assertLess(left[None], 0.0045)

            # Those that are told are also those taken where none are given.
            self.assertEqual(error[None], error["told"])
            self.assertNotIn("stations", stderr[None])
        for quiet in (NREL | {"mesh": {}}, SPUR | {"mesh": {}}, NREL):
            self.write(quiet)
            result = subprocess.run([GEARSIM, "run.ini"], cwd=self.folder, capture_output=True, text=True, check=False)
            self.assertNotIn("stations", result.stderr)

    def test_a_sweep_of_loads_ends_as_a_run_of_its_own(self):
        """Lines are cut for the largest load, whichever comes first: a first one near 0 would cut them elsewhere."""
        columns = {"columns": "te_um, load_torque_Nm"}
        alone = self.rows(NREL | {"mesh": {}, "output": {"columns": "te_um"}})
        most_Nm = NREL["load"]["mean_Nm"]
        for first_Nm, last_Nm in ((1e-3 * most_Nm, most_Nm), (most_Nm, 0.5 * most_Nm)):
            sweep = self.rows(NREL | {"mesh": {}, "load": {"mean_Nm": first_Nm, "end_Nm": last_Nm}, "output": columns,
                                      "analysis": NREL["analysis"] | {"loads": 2}})
            under = [row for row in sweep if math.isclose(float(row["load_torque_Nm"]), most_Nm)]
            self.assertEqual(len(under), len(alone))
            for here, there in zip(under, alone):
                self.assertAlmostEqual(float(here["te_um"]), float(there["te_um"]), delta=1e-5)

    def test_slopes_by_modifications_are_those_of_differences(self):
        """Reliefs, one of them next to none, slopes and twist, of both flanks and of the one that carries."""
        step_um = 1e-3
        amounts = {"pinion_tip_relief_um": 8.0, "wheel_drive_root_relief_um": 0.01, "pinion_drive_helix_slope_um": 3.0,
                   "wheel_twist_um": 1.0, "pinion_profile_slope_um": -2.0}
        ranges = {"pinion_tip_relief_length_mm": 30, "wheel_drive_root_relief_share": 0.3}
        columns = ", ".join(["te_um", *(f"te_um_by_{key}" for key in amounts)])
        constant = {"law": "constant", "stiffness_N_per_m": 4e9}
        for sections, sign in ((NREL | {"mesh": {}}, 1), (NREL | {"load": {"mean_Nm": -100000}, "pose": {"skew_mrad": 0.1}}, -1),
                               (NREL | {"mesh": constant, "pose": {"skew_mrad": 0.1}}, 1),
                               (NREL | {"mesh": {"law": "iso6336"}, "load": {"mean_Nm": -100000}}, -1)):
            def run(**other):
                amount = {key: value for key, value in (amounts | other).items() if value}
                return self.rows(sections | {"modifications": ranges | amount | {"tolerance_um": 1e-3},
                                             "output": {"columns": columns}})
            here = run()
            for key, amount in amounts.items():
                after, before = run(**{key: amount + step_um}), run(**{key: amount - step_um})
                largest = max(abs(float(row[f"te_um_by_{key}"])) for row in here)
                self.assertEqual(largest == 0, "drive" in key and sign < 0, key)
                for at, high_row, low_row in zip(here, after, before):
                    slope = (float(high_row["te_um"]) - float(low_row["te_um"])) / (2 * step_um)
                    self.assertAlmostEqual(float(at[f"te_um_by_{key}"]), slope, delta=2e-4 * largest + 1e-5, msg=key)

            # One that is not there cuts no lines yet: next to the same.
            key = "te_um_by_wheel_drive_root_relief_um"
            largest = max(abs(float(row[key])) for row in here)
            for thin, none in zip(here, run(wheel_drive_root_relief_um=0)):
                self.assertAlmostEqual(float(none[key]), float(thin[key]), delta=2e-3 * largest)

    def test_slopes_are_refused_where_there_are_none(self):
        told = "output.columns: must name an amount of [modifications] behind te_um_by_"
        relief = {"columns": "te_um, te_um_by_pinion_tip_relief_um"}
        self.refused(NREL | {"output": {"columns": "te_um_by_pinion_tip_relief_mm"}}, told, "(got 'te_um_by_pinion_tip_relief_mm')")
        self.refused(NREL | {"output": {"columns": "te_um_by_"}}, told)
        self.refused(NREL | {"mesh": {"friction_coefficient": 0.05}, "output": relief}, told, "without friction")
        edges = {"law": "constant", "stiffness_N_per_m": 1e9, "corner_contact": "on"}
        self.refused(NREL | {"mesh": edges, "output": relief}, told, "tip corners of constant stiffness")
        for arguments in ((), ("--check",)):
            self.refused(NREL | {"output": relief}, "modifications.pinion_tip_relief_um: must have a range", arguments=arguments)

    def test_stations_of_its_own_choice_leave_0_4_percent(self):
        """A face as wide as two lines are long, where the estimate is low; end reliefs, deeper than six deflections."""
        reliefs = {f"pinion_end_relief_{end}_{key}": value for end in ("I", "II")
                   for key, value in (("um", 100), ("length_mm", 4), ("shape", "linear"))}
        left, taken = {}, []
        for face_mm, flanks in ((72, {}), (20, {"modifications": reliefs})):
            gears = SPUR["gears"] | {"pinion_teeth": 25, "wheel_teeth": 80, "helix_angle_deg": 30,
                                     "face_width_mm": face_mm, "center_distance_mm": 210 / math.cos(math.radians(30))}
            error = {}
            for stations in ({}, {"stations": 17}, {"stations": 49}, {"stations": 97}):
                self.write({"gears": gears, "mesh": OFF | stations, "load": {"mean_Nm": 240 * face_mm * 0.17},
                            "analysis": {"type": "static", "positions": 20}} | flanks)
                subprocess.run([GEARSIM, "run.ini", "--quiet"], cwd=self.folder, check=True)
                error[stations.get("stations")] = [float(row["te_um"]) for row in self.table("run.csv")]
                with open(os.path.join(self.folder, "run.csv"), encoding="utf-8") as file:
                    head = re.search(r"(?m)^# stations = (\d+)$", file.read())
                listed = re.search(r"(?m)^stations = (\d+)$", self.gearsim("--geometry").stdout)
                self.assertEqual(head[1], listed[1])
                taken.append(int(head[1]))

            # The error falls with the square of the elements' length: the limit, from 48 and 96 elements.
            limit = [(4 * fine - coarse) / 3 for coarse, fine in zip(error[49], error[97])]
            for stations in (None, 17):
                left[face_mm, stations] = max(abs(value / whole - 1) for value, whole in zip(error[stations], limit))
            self.assertLess(left[face_mm, None], 0.004)
            self.assertGreater(left[face_mm, 17], 0.004)

        # What is listed and written is what was taken: those given, else more.
        self.assertEqual(taken[1:4] + taken[5:], 2 * [17, 49, 97])
        self.assertTrue(17 < taken[0] < 49 and taken[4] == 49, taken)

    def test_stations_follow_flanks_from_files(self):
        """Flanks that are deeper than twice what the teeth give way by, in a file; then the same as a modification."""
        with open(os.path.join(self.folder, "deep.csv"), "w", encoding="utf-8") as file:
            file.write("tooth,flank,t1,t2,deviation_um\n")
            for tooth, t1, t2 in itertools.product(range(62), (0, 0.5, 1), (0, 1)):
                file.write(f"{tooth},drive,{t1},{t2},{0 if t1 == 0.5 else -15}\n")
        case = SPUR62 | {"analysis": {"type": "static", "positions": 2}}
        crowned = {"modifications": {"pinion_drive_crowning_um": 15}}
        taken = []
        for flanks in ({}, {"flanks": {"pinion": "deep.csv"}}, crowned):
            self.rows(case | flanks)
            with open(os.path.join(self.folder, "run.csv"), encoding="utf-8") as file:
                taken.append(int(re.search(r"(?m)^# stations = (\d+)$", file.read())[1]))
        self.assertEqual(taken, [17, 33, 33])

    def test_corner_contact_is_of_elastic_teeth(self):
        self.rows(SPUR62 | {"mesh": {"corner_contact": "on"}})
        self.refused(SPUR62 | {"mesh": {"corner_contact": "maybe"}}, "run.ini:", "mesh.corner_contact: must be off | on (got maybe)")

    def test_tip_edges_take_their_share(self):
        """Pairs touch earlier and longer: softer steps of the transmission error, none of them jumps, and less of it."""
        on, off = ([-float(row["te_um"]) for row in self.rows(SPUR62 | {
            "mesh": {"corner_contact": key}, "analysis": {"type": "static", "positions": 400}})] for key in ("on", "off"))
        for both, alone in zip(on, off):
            self.assertLessEqual(both, alone * (1 + 1e-7))
        self.assertLess(max(on) - min(on), 0.9 * (max(off) - min(off)))
        steps = [max(abs(b - a) for a, b in zip(error, error[1:])) for error in (on, off)]
        self.assertLess(steps[0], 0.1 * steps[1])

        # Where a line is beyond the path its points are at the tips, and the blunter the edge the lower the pressure.
        pressures = []
        for rounding in (0.02, 0.2):
            rows = self.rows(SPUR62 | {"mesh": {"tip_rounding": rounding}, "output": {"load_distribution": "load.csv"}})
            points = self.table("load.csv")
            self.assertAlmostEqual(max(float(point["pinion_roll_length_mm"]) for point in points), 26.48891429, delta=1e-6)
            pressures.append(max(float(row["largest_pressure_N_per_mm2"]) for row in rows))
        self.assertGreater(pressures[0], 2 * pressures[1])

    def test_rubbing_teeth_lose_what_their_sliding_takes(self):
        """Loss over power in per coefficient: elastic spur teeth share the load next to equally [Ohlendorf]."""
        mu, speed = 1e-4, 2 * math.pi / 60 * 1000
        bracket = 0.811877
        factor = math.pi * 2 / 62 * bracket
        rows = self.rows(SPUR62 | {"mesh": OFF | {"friction_coefficient": mu, "friction_speed_m_per_s": 1e-6},
                                   "drive": {"start_rpm": 1000}})
        self.assertEqual(list(rows[0])[-1], "loss_W")
        loss = sum(float(row["loss_W"]) for row in rows) / len(rows)
        ratio = loss / (mu * factor * SPUR62["load"]["mean_Nm"] * speed)
        self.assertGreater(ratio, 0.85)
        self.assertLess(ratio, 1.0)

        # At rest there is none, and the curve is that without.
        still = self.rows(SPUR62 | {"mesh": OFF | {"friction_coefficient": 0.1}})
        self.assertEqual({float(row["loss_W"]) for row in still}, {0.0})
        plain = self.rows(SPUR62)
        self.assertEqual([row["te_um"] for row in still], [row["te_um"] for row in plain])

    def test_files_of_soft_teeth_are_checked(self):
        for text, message in (("tooth,stiffness\n", "soft.csv:1: the columns must be tooth,factor"),
                              ("", "soft.csv:0: the columns must be tooth,factor (got nothing)"),
                              ("tooth,factor\n62,0.5\n", "soft.csv:2: tooth must be a whole number from 0 to 61 (got 62)"),
                              ("tooth,factor\n-1,0.5\n", "soft.csv:2: tooth must be"),
                              ("tooth,factor\n1.5,0.5\n", "soft.csv:2: tooth must be"),
                              ("tooth,factor\n1,0\n", "soft.csv:2: factor must be a number from 0.01 to 100"),
                              ("tooth,factor\n1,nan\n", "soft.csv:2: factor must be a number"),
                              ("tooth,factor\n1,0.5\n1,0.6\n", "soft.csv:3: each tooth must stand once"),
                              ("tooth,factor\n1\n", "soft.csv:2: a row must be tooth,factor")):
            with self.subTest(text):
                with open(os.path.join(self.folder, "soft.csv"), "w", encoding="utf-8") as file:
                    file.write(text)
                self.refused(SPUR62 | {"flanks": {"wheel_tooth_stiffness": "soft.csv"}}, message,
                             "flanks.wheel_tooth_stiffness: names this file")
        self.refused(SPUR62 | {"flanks": {"pinion_tooth_stiffness": "none.csv"}}, "none.csv: No such file")

    def test_load_distribution_must_be_a_file_of_its_own(self):
        self.refused(SPUR62 | {"output": {"load_distribution": "run.csv"}}, "output.load_distribution: must be another file")
        for name, message in (("-", "must be a file (got -)"), ("load.h5", "must be a CSV file, HDF5 is for output.file"),
                              ("load.hdf5", "must be a CSV file")):
            self.refused(SPUR62 | {"output": {"load_distribution": name}}, "output.load_distribution: " + message)
        self.refused(SPUR62 | {"output": {"load_distribution": "missing/load.csv"}}, "output.load_distribution: ",
                     arguments=("--check",))


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        GEARSIM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
