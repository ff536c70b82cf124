#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/orders and the modules it is made of, with signals whose orders are known."""
import os
import random
import subprocess
import sys
import tempfile
import types
import unittest
from fractions import Fraction
from unittest import mock

sys.dont_write_bytecode = True
SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "scripts")
sys.path.insert(0, SCRIPTS)
import program  # noqa: E402

program.require("numpy", "scipy", "h5py")

import h5py  # noqa: E402
import numpy as np  # noqa: E402
from scipy import io  # noqa: E402

import lines  # noqa: E402
import ordermap  # noqa: E402
import records  # noqa: E402
import results  # noqa: E402
import runup  # noqa: E402
import script_case  # noqa: E402
import tracking  # noqa: E402

RATE_HZ, FILE_HZ = 8192.0, 4096.0
# Whole, fractional, planet orders: (amplitude, phase). Each is further from the next than 0.3 orders.
KNOWN = {23.0: (3.0, 0.3), 46.0: (0.5, 1.0), 22.5: (1.0, 2.0), 36 * 93 / 129: (0.7, -1.0), 0.8: (1.5, 0.5)}
SPEEDS = ((600, 3000), (3000, 600), (-600, -3000), (1500, 1500))


def turning(start_rpm, end_rpm, duration_s=2.0, rate_Hz=RATE_HZ):
    """Times, signed speed and signed angle of a linear run."""
    time_s = np.arange(int(duration_s * rate_Hz)) / rate_Hz
    slope = (end_rpm - start_rpm) / duration_s
    return time_s, start_rpm + slope * time_s, (start_rpm * time_s + slope * time_s**2 / 2.0) * np.pi / 30.0


def waves(angle_rad, known=None):
    return sum(a * np.cos(order * angle_rad + p) for order, (a, p) in (known or KNOWN).items())


def run_of(start_rpm, end_rpm, values=waves, **how):
    time_s, speed_rpm, angle_rad = turning(start_rpm, end_rpm, **how)
    return runup.Run(time_s, speed_rpm, angle_rad, 20.0 + values(angle_rad))


class Tracking(unittest.TestCase):
    def setUp(self):
        few = mock.patch.object(tracking, "POINTS", 150)
        few.start()
        self.addCleanup(few.stop)

    def assert_known(self, run, found, atol_share=0.01):
        for order, values in zip(KNOWN, found):
            good = values[np.isfinite(values)]
            self.assertGreater(len(good), 30)
            np.testing.assert_allclose(good, KNOWN[order][0], rtol=atol_share, err_msg=f"{order} {run.start_rpm}")

    def test_resampling_finds_known_amplitudes_whatever_the_speed_does(self):
        for start_rpm, end_rpm in SPEEDS:
            run = run_of(start_rpm, end_rpm)
            frames = tracking.frames_of(run, 10, 80)
            self.assert_known(run, tracking.tracked(frames, tracking.OverAngle(run), np.array(list(KNOWN))))

    def test_short_frames_tell_the_asked_orders_apart(self):
        """In a fast sweep a frame is as short as tells two orders apart at all; the weak one is not what leaks of the other."""
        known = {1.0: (0.4, 0.0), 1.25: (1.0, 0.5), 8.0: (3.0, 0.3), 9.0: (0.2, 1.0)}
        run = run_of(600, 4000, lambda angle: waves(angle, known))
        frames = tracking.track_frames(run, 0.25)
        self.assertLess(np.min(frames.turns), 11)
        found = tracking.tracked(frames, tracking.OverAngle(run), np.array(list(known)))
        for (amplitude, _), values in zip(known.values(), found):
            np.testing.assert_allclose(values, amplitude, rtol=0.01)

    def test_a_reversing_shaft_has_frames_on_both_sides(self):
        run = run_of(2000, -2000)
        frames = tracking.frames_of(run, 6, 120)
        self.assertTrue((frames.time_s < 0.9).any() and (frames.time_s > 1.1).any())
        found = tracking.tracked(frames, tracking.OverAngle(run), np.array([46.0]))
        np.testing.assert_allclose(found, 0.5, rtol=0.01)

    def test_vold_kalman_finds_known_amplitudes(self):
        for start_rpm, end_rpm in (*SPEEDS, (2000, -2000)):
            run = run_of(start_rpm, end_rpm)
            rows = tracking.frames_of(run, 6, 120).row
            self.assert_known(run, tracking.vold_kalman(run, np.array(list(KNOWN)), 0.1, rows))

    def test_vold_kalman_tells_near_orders_apart(self):
        known = {23.0: (3.0, 0.3), 23.1: (0.5, 1.0)}
        run = run_of(600, 3000, lambda angle: waves(angle, known))
        rows = tracking.frames_of(run, 10, 80).row
        found = tracking.vold_kalman(run, np.array(list(known)), 0.05, rows)
        np.testing.assert_allclose(found[0], 3.0, rtol=0.01)
        np.testing.assert_allclose(found[1], 0.5, rtol=0.01)

    def test_the_bandwidth_of_vold_kalman_is_between_half_powers(self):
        """A line half the bandwidth beside the order comes out with half its power, one far away not at all."""
        for beside, expected in ((0.1, np.sqrt(0.5)), (0.05, 1 / (1 + (np.sqrt(2) - 1) / 16)), (1.0, 0.0)):
            run = run_of(3000, 3000, lambda angle: np.cos((23 + beside) * angle))
            rows = np.arange(len(run.time_s) // 4, 3 * len(run.time_s) // 4, 50)
            found = tracking.vold_kalman(run, np.array([23.0]), 0.2, rows)
            np.testing.assert_allclose(found, expected, atol=0.01)

    def test_a_sideband_does_not_leak_into_a_tooth_order_of_a_fast_run(self):
        run = run_of(600, 3000, lambda angle: np.cos(24 * angle))
        rows = tracking.frames_of(run, 6, 120).row
        found = tracking.vold_kalman(run, np.array([23.0]), tracking.fitting_bandwidth(run, 23.0), rows)
        self.assertLess(np.nanmax(found), 0.02)
        self.assertLess(np.nanmedian(found), 0.0105)

    def test_a_resonance_is_shown_where_it_is_said_to_be(self):
        """Peak of 1 / (1 - r^2 + 2 i D r) to 1 % from the damping on that is told."""
        for damping in (0.02, 0.05):
            for start_rpm, end_rpm, duration_s in ((300, 3000, 8.0), (3000, 300, 3.0), (300, 3000, 1.0)):
                time_s, speed_rpm, angle_rad = turning(start_rpm, end_rpm, duration_s, FILE_HZ)
                ratio = 23.0 * speed_rpm / 60.0 / 600.0
                wave = np.exp(23j * angle_rad) / (1.0 - ratio**2 + 2j * damping * ratio)
                run = runup.Run(time_s, speed_rpm, angle_rad, wave.real)
                frames = tracking.track_frames(run)
                found = tracking.tracked(frames, tracking.OverAngle(run), np.array([23.0]))[0]
                peak = np.abs(wave)[frames.row].max()  # 1 / (2 D sqrt(1 - D^2)) where a frame is at it
                if tracking.least_damping(run, frames)[found.argmax()] <= damping * 1.01:
                    self.assertAlmostEqual(found.max() / peak, 1.0, delta=0.013, msg=f"{damping} {duration_s}")
                else:
                    self.assertLess(found.max(), 0.99 * peak)

    def test_an_order_above_the_rate_is_no_number(self):
        run = run_of(600, 6000)
        frames = tracking.frames_of(run, 10, 80)
        for found in (tracking.tracked(frames, tracking.OverAngle(run), np.array([46.0])),
                      tracking.vold_kalman(run, np.array([46.0]), 0.1, frames.row)):
            above = 46.0 * frames.speed_rpm / 60.0 > 1.02 * run.trusted_Hz
            self.assertTrue(above.any() and np.isnan(found[0, above]).all())
            self.assertTrue(np.isfinite(found[0, 46.0 * frames.highest_rpm / 60.0 < run.trusted_Hz]).all())

    def test_map_and_spectrum_show_the_amplitude_anywhere(self):
        """Between bins of the padded frames a Hann window loses 0.3 %."""
        run = run_of(1000, 2000, lambda angle: np.cos(22.53 * angle))
        frames = tracking.frames_of(run, 10, 80)
        order, power = tracking.spectra(frames, tracking.OverAngle(run), 40)
        np.testing.assert_allclose(order[power.argmax(axis=1)], 22.53, atol=0.02)
        np.testing.assert_allclose(power.max(axis=1), 1.0, rtol=0.01)
        map_ = tracking.order_map(frames, order, power, False, rows=20)
        np.testing.assert_allclose(map_.power.max(axis=1), 1.0, rtol=0.01)
        self.assertTrue(1000 < map_.row[0] < map_.row[-1] < 2000)

    def test_a_speed_map_shows_the_amplitudes_whatever_the_speed_does(self):
        known = {23.0: (3.0, 0.3), 60.5: (1.0, 1.0)}
        record = types.SimpleNamespace(path="record", provenance={}, incomplete=None)
        options = ordermap.Settings()
        options.orders = "23, 60.5"
        for start_rpm, end_rpm in (*SPEEDS, (2400, -2400)):
            run = run_of(start_rpm, end_rpm, lambda angle: waves(angle, known))
            map_, _ = ordermap.Analysis(records.Signal(run, "force", "N", record), options).speed_map()
            self.assertEqual(map_.over_time, start_rpm == end_rpm)
            speeds_rpm = np.full(len(map_.row), 1500.0) if map_.over_time else map_.row
            for order, (amplitude, _) in known.items():
                told = 0
                for speed_rpm, row in zip(speeds_rpm, map_.amplitude_N):
                    near = np.abs(map_.frequency_Hz - order * speed_rpm / 60.0) < 0.2 * order * speed_rpm / 60.0
                    if speed_rpm > 900.0 and np.isfinite(row[0]):
                        self.assertAlmostEqual(row[near].max(), amplitude, delta=0.01 * amplitude)
                        told += 1
                self.assertGreater(told, 15)

    def test_overall_is_the_rms_without_the_mean(self):
        frames = tracking.frames_of(run_of(1500, 1500), 20, 40)
        expected = np.sqrt(sum(a**2 / 2 for a, _ in KNOWN.values()))
        np.testing.assert_allclose(tracking.overall(frames), expected, rtol=0.01)


class Lines(unittest.TestCase):
    def names(self, pinion, wheel, **how):
        return {line.name: line.order for line in lines.of_gears(runup.Gears(pinion, wheel, None), 4, **how)}

    def test_lines_of_a_pair(self):
        names = self.names(23, 71)
        self.assertEqual(names["mesh 3"], 69)
        self.assertEqual(names["mesh 1 + 2 pinion"], 25)
        self.assertEqual(names["mesh 2 - 1 wheel"], 46 - Fraction(23, 71))
        self.assertEqual(names["hunting tooth"], Fraction(1, 71))  # the same two teeth each 71 turns of the pinion
        self.assertEqual(self.names(24, 36)["hunting tooth"], Fraction(1, 3))

    def test_no_order_has_two_names_and_no_tooth_order_is_a_sideband(self):
        for pinion, wheel in ((5, 42), (8, 42), (10, 10), (20, 20), (9, 120), (36, -93)):
            gears = runup.Gears(pinion, abs(wheel), None)
            found = lines.of_gears(gears, 4, 10)
            self.assertEqual(len({line.order for line in found}), len(found))
            for line in found:
                self.assertEqual(line.kind == "mesh", line.order % pinion == 0, line)
                self.assertGreater(line.order, 0)

    def test_a_small_pinion_has_sidebands_up_to_half_way(self):
        names = self.names(8, 42, sidebands=10)
        self.assertIn("mesh 1 + 4 pinion", names)
        self.assertNotIn("mesh 1 + 5 pinion", names)

    def test_equal_teeth_turn_together(self):
        self.assertEqual(self.names(20, 20)["pinion = wheel"], 1)

    def test_a_planetary_set(self):
        """NREL 5 MW, stage 2: sun 18, planet 36, ring 93, as the gears roll on each other seen from the carrier."""
        names = {line.name: line.order for line in lines.of_planetary("18,36,93,3", 2)}
        carrier = Fraction(18, 111)
        self.assertEqual(names["carrier"], carrier)
        self.assertEqual(names["mesh 1"], (1 - carrier) * 18)  # the sun's teeth, as seen from the carrier
        self.assertEqual(names["planet turns"], (1 - carrier) * 18 / 36)
        self.assertEqual(names["planets pass"], 3 * carrier)

    def test_lines_leave_a_speed_map_where_they_cross_its_edge(self):
        rim = lines.speed_rim([10, 10.1, 60, 3000], 1000.0, 600.0, 3000.0)
        self.assertEqual(rim["marks"], 3)  # 3000 is beyond the lowest speed
        self.assertEqual((rim["mark_x_0"], rim["mark_y_0"], rim["mark_text_0"]), (0.5, 1.0, "10"))
        self.assertEqual(rim["mark_text_1"], "")  # 10.1 has no room for its number
        self.assertEqual((rim["mark_x_2"], rim["mark_y_2"], rim["mark_text_2"]), (1.0, (1000.0 - 600.0) / 2400.0, "60"))
        # Both ends of a mark lie on a line through speed 0.
        for i in range(3):
            x, y, out_x, out_y = (rim[f"mark_{end}_{i}"] for end in ("x", "y", "out_x", "out_y"))
            self.assertAlmostEqual(x / (600.0 + 2400.0 * y), out_x / (600.0 + 2400.0 * out_y))
        upright = lines.speed_rim([10], 1000.0, 0.0, 2.0, 3000.0)
        self.assertEqual((upright["mark_x_0"], upright["mark_out_x_0"]), (0.5, 0.5))

    def test_ghosts_and_orders_that_are_asked_for(self):
        gears = runup.Gears(23, 71, None)
        found = lines.of_ghosts("131, wheel:142", gears)
        self.assertEqual([line.order for line in found], [131, 46])
        self.assertEqual(lines.orders_asked("45, 22.5,36*93/129"), [45, Fraction(45, 2), Fraction(36 * 93, 129)])
        for text in ("", "a", "1,,2", "-1", "1/0", "1e9", "2**3", "0"):
            with self.assertRaisesRegex(program.InputError, "--orders: must be"):
                lines.orders_asked(text)

    def test_units_are_read_from_names_of_columns(self):
        for name, expected in (("contact_force_N", ("contact force", "N")), ("a [m/s²]", ("a", "m/s²")),
                               ("Druck (Pa)", ("Druck", "Pa")), ("F / kN", ("F", "kN")), ("p", ("p", "")),
                               ("penetration_rate_um_per_s", ("penetration rate", "µm/s"))):
            self.assertEqual(records.quantity_of(name), expected)


class Case(unittest.TestCase):
    """A measured record, and the script that analyses it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        for module, name, count in ((tracking, "POINTS", 100), (ordermap, "SPECTRUM_FRAMES", 60)):
            few = mock.patch.object(module, name, count)
            few.start()
            self.addCleanup(few.stop)
        self.folder = os.path.join(folder.name, "it's a \"folder\"")
        os.mkdir(self.folder)
        self.time_s, self.speed_rpm, self.angle_rad = turning(600, 2400, 1.5, FILE_HZ)
        self.values = 5.0 + waves(self.angle_rad)
        self.pulses = (np.remainder(4 * self.angle_rad / (2 * np.pi), 1.0) < 0.3).astype(float)

    def path(self, name):
        return os.path.join(self.folder, name)

    def orders(self, *arguments):
        return script_case.call("orders", *arguments, folder=self.folder)

    def assert_tracks(self, *arguments, rtol=0.01, factor=1.0):
        """Orders 23 and 22.5 of the record have the amplitudes that were put in."""
        result = self.orders(*arguments, "--orders", "23,22.5,0.8", "--turns", "8", "--no-pictures", "--output", "x")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        names, table = self.table("x_tracks.csv")
        self.assertEqual(names, ["time_s", "speed_rpm", "overall", "order_23", "order_22.5", "order_0.8"])
        for column, order in ((3, 23.0), (4, 22.5), (5, 0.8)):
            np.testing.assert_allclose(table[:, column], factor * KNOWN[order][0], rtol=rtol)
        np.testing.assert_allclose(table[:, 1], 600.0 + 1200.0 * table[:, 0], rtol=0.01)

    def table(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            rows = [line.strip().split(",") for line in file if not line.startswith("#")]
        return rows[0], np.array(rows[1:], dtype=float)

    def write_text(self, name, head, columns, separator=",", comma=False):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(head)
            for row in zip(*columns):
                line = separator.join(f"{value:.9g}" for value in row)
                file.write((line.replace(".", ",") if comma else line) + "\n")


class Files(Case):
    """A measured record in each format."""

    def test_text_of_others(self):
        self.write_text("a.csv", "Zeit;n;Kraft\ns;1/min;kN\n", (self.time_s, self.speed_rpm, self.values), ";", comma=True)
        self.assert_tracks("a.csv", "--time", "Zeit", "--signal", "Kraft", "--speed", "n")
        with open(self.path("x_tracks.csv"), encoding="utf-8") as file:
            self.assertIn("# Kraft, peak amplitude / kN\n", file.read())
        self.write_text("b.txt", "", (self.values, self.speed_rpm / 60.0), "\t")
        self.assert_tracks("b.txt", "--rate", "4096", "--signal", "1", "--speed", "2", "--speed-unit", "Hz",
                           "--scale", "-2", factor=2.0)
        self.write_text("c.csv", "t,speed [rpm],p [Pa]\n", (self.time_s, -self.speed_rpm / 5.0, self.values))
        self.assert_tracks("c.csv", "--speed", "speed [rpm]", "--ratio", "5")

    def test_a_run_of_gearsim_needs_no_option(self):
        head = "# gearsim\n# gears.pinion_teeth = 23\n# gears.wheel_teeth = 31\n# eigenfrequency_Hz = 500\n"
        columns = (self.time_s, self.speed_rpm, self.angle_rad, self.values)
        self.write_text("run.csv", head + ",".join(results.COLUMNS) + "\n", columns)
        result = self.orders("run.csv", "--amplitude", "rms", "--db", "0.001", "--ghost", "wheel:40", "--turns", "16")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertRegex(result.stdout, r"order 23 \(mesh 1\): 66\.[56] dB re 0.001 N")  # 20 lg(3 / sqrt(2) / 0.001)
        self.assertIn("a line without a name at order 22.5", result.stdout)
        for name in ("run_ordermap", "run_speedmap", "run_tracks", "run_orderspectrum"):
            for suffix, begin in (("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")):
                with open(self.path(f"{name}.{suffix}"), "rb") as file:
                    self.assertTrue(file.read(8).startswith(begin))
        with open(self.path("run_ordermap.svg"), encoding="utf-8") as file:
            svg = file.read()
        for text in ("23 mesh 1", "46 mesh 2", "29.677 ghost wheel:40", "eigenfrequency f0 = 500 Hz", "hunting tooth"):
            self.assertTrue(text in svg, text)
        with open(self.path("run_speedmap.svg"), encoding="utf-8") as file:
            svg = file.read()
        for text in ("frequency / Hz", "pinion speed / rpm", "rim: orders, f0 = eigenfrequency 500 Hz", "600 to 2400 rpm"):
            self.assertTrue(text in svg, text)
        with open(self.path("run_lines.csv"), encoding="utf-8") as file:
            self.assertIn("\nmesh 1 - 1 wheel,22.258065,", file.read())

    def test_amplitudes_as_asked_for(self):
        self.write_text("a.csv", "time,n,p [Pa]\n", (self.time_s, self.speed_rpm, self.values))
        for options, factor in (([], 1.0), (["--amplitude", "rms"], np.sqrt(0.5))):
            self.assert_tracks("a.csv", "--speed", "n", "--signal", "3", *options, factor=factor)
        for options, expected in ((["--amplitude", "power"], 4.5), (["--db", "2e-5"], 20 * np.log10(3.0 / 2e-5)),
                                  (["--amplitude", "power", "--db", "2e-5"], 10 * np.log10(4.5 / 4e-10))):
            result = self.orders("a.csv", "--speed", "n", "--signal", "3", "--orders", "23", "--turns", "8",
                                 "--no-pictures", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            np.testing.assert_allclose(self.table("a_tracks.csv")[1][:, 3], expected, rtol=0.01)

    def test_a_record_without_a_line_is_drawn_too(self):
        noise = np.random.default_rng(1).standard_normal(len(self.time_s))
        self.write_text("a.csv", "time,n,p\n", (self.time_s, self.speed_rpm, noise))
        result = self.orders("a.csv", "--speed", "n", "--signal", "p", "--no-pictures")
        self.assertEqual(result.returncode, 0)
        self.assertIn("no line stands out of its order spectrum", result.stderr)
        self.assertEqual(self.table("a_tracks.csv")[1].shape[1], 4)

    def test_hdf5_in_groups(self):
        with h5py.File(self.path("a.h5"), "w") as file:
            file["m/time"], file["m/n"], file["m/acc"] = self.time_s, self.speed_rpm, self.values
            file["settings"] = np.arange(3)
        self.assert_tracks("a.h5", "--time", "m/time", "--speed", "m/n", "--signal", "m/acc")

    def test_sound_with_pulses(self):
        """Rectangles tell an edge to a row only, 0.7 rad of order 23; the spline through many of them tells it better."""
        table = np.column_stack([self.values / 20.0, self.pulses - 0.5])
        io.wavfile.write(self.path("a.wav"), int(FILE_HZ), np.round(table * 32767).astype(np.int16))
        self.assert_tracks("a.wav", "--signal", "1", "--pulses", "2", "--pulses-per-turn", "4", "--scale", "20")

    def test_a_missing_pulse_is_told(self):
        self.pulses[(self.time_s > 0.6) & (self.time_s < 0.61)] = 0.0
        gap = np.flatnonzero(np.diff(self.pulses) > 0)
        self.pulses[gap[20] : gap[20] + 100] = 0.0
        self.write_text("a.csv", "time,tacho,p\n", (self.time_s, self.pulses, self.values))
        result = self.orders("a.csv", "--pulses", "tacho", "--signal", "p")
        self.assertEqual(result.returncode, 2)
        self.assertIn("a pulse is missing", result.stderr)

    def test_pulses_of_a_shaft_that_turns_back_are_told(self):
        angle_rad = 2 * np.pi * 30 * self.time_s * (1 - self.time_s / self.time_s[-1])
        pulses = (np.remainder(4 * angle_rad / (2 * np.pi), 1.0) < 0.3).astype(float)
        self.write_text("a.csv", "time,tacho,p\n", (self.time_s, pulses, self.values))
        result = self.orders("a.csv", "--pulses", "tacho", "--signal", "p")
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        self.assertIn("turns back there, which pulses do not tell", result.stderr)

    def test_bad_input_is_said_in_a_line(self):
        self.write_text("a.csv", "time,n,p\n", (self.time_s, self.speed_rpm, self.values))
        self.write_text("still.csv", "time,n,p\n", (self.time_s, 0 * self.speed_rpm, self.values))
        for arguments, message in (
            (["a.csv", "--signal", "3", "--speed", "n", "--pinion-teeth", "23"], "please give --wheel-teeth as well"),
            (["a.csv", "--signal", "3", "--speed", "n", "--pinion-teeth", "2", "--wheel-teeth", "9"],
             "--pinion-teeth: must be 3 to 99999 (got 2)"),
            (["a.csv"], "no column pinion_speed_rpm; please give --speed, --pulses or --rpm (it has time, n, p)"),
            (["a.csv", "--speed", "m"], "no column 'm' (--speed); it has time, n, p"),
            (["a.csv", "--speed", "n", "--speed-unit", "furlong"], "--speed-unit: must be rpm, Hz"),
            (["a.csv", "--speed", "n", "--rpm", "3"], "--speed, --rpm: must be one of them"),
            (["a.csv", "--speed", "n", "--signal", "p", "--turns", "1000"], "the record has 37"),
            (["a.csv", "--speed", "n", "--pinion-teeth", "2", "--wheel-teeth", "9"], "--pinion-teeth"),
            (["a.csv", "--speed", "n", "--planetary", "1,2"], "--planetary: must be SUN,PLANET,RING,NUMBER"),
            (["a.csv", "--pulses", "n", "--pulse-level", "1e9"], "no pulses pass"),
            (["still.csv", "--speed", "n"], "the speed is 0 throughout"),
            (["nowhere.csv"], "nowhere.csv"),
        ):
            result = self.orders(*arguments, "--no-pictures")
            self.assertEqual(result.returncode, 2, (arguments, result.stderr))
            self.assertIn(message, result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1)

    def test_broken_files_are_refused_by_name(self):
        for name, content, message in (
            ("a.csv", b"", "no rows"), ("a.csv", b"time,n\n", "no row|16 rows"), ("a.csv", b"x,y\n1,2\n3\n", "must have 2 columns"),
            ("a.csv", b"a,a\n1,2\n", "name of its own"), ("a.wav", b"RIFF\0\0\0\0WAVEfmt ", "as WAV"),
            ("a.csv", bytes(range(256)) * 40, "a.csv"), ("a.h5", b"\x89HDF\r\n\x1a\n", "a.h5"),
        ):
            with open(self.path(name), "wb") as file:
                file.write(content)
            result = self.orders(name, "--rpm", "60")
            self.assertEqual(result.returncode, 2, (content[:30], result.stderr))
            self.assertRegex(result.stderr, message)

    def test_mutated_files_are_analysed_or_refused(self):
        """Broken files: a result or a message, never an exception and never a warning of a library."""
        random_ = random.Random(1)
        columns = [values[::4] for values in (self.time_s, self.speed_rpm, self.values)]
        self.write_text("a.csv", "Zeit;n;F\ns;1/min;N\n", columns, ";", comma=True)
        table = np.column_stack([self.values / 20.0, self.pulses - 0.5])
        io.wavfile.write(self.path("a.wav"), int(FILE_HZ), np.round(table[:2000] * 32767).astype(np.int16))
        for name, options in (("a.csv", ["--rate", "1024", "--signal", "F", "--speed", "n"]),
                              ("a.wav", ["--signal", "1", "--pulses", "2"])):
            with open(self.path(name), "rb") as file:
                whole = file.read()
            for _ in range(10):
                data = bytearray(whole)
                for _ in range(random_.randint(1, 4)):
                    at = random_.randrange(60) if random_.random() < 0.5 else random_.randrange(len(data))
                    data[at : at + random_.randint(0, 2)] = random_.choice([b"", b";", b"\n", b"-", b"nan", b"1e999", b"\xff\0"])
                with open(self.path(name), "wb") as file:
                    file.write(data if random_.random() < 0.8 else data[: random_.randrange(len(data))])
                result = self.orders(name, *options, "--orders", "23", "--no-pictures")
                self.assertIn(result.returncode, (0, 2), result.stderr)
                self.assertNotIn("Traceback", result.stderr)
                self.assertNotIn("Warning", result.stderr)

    def test_near_orders_are_warned_of(self):
        self.write_text("a.csv", "time,n,p\n", (self.time_s, self.speed_rpm, self.values))
        result = self.orders("a.csv", "--speed", "n", "--orders", "23,23.1", "--turns", "10", "--no-pictures")
        self.assertIn("orders 0.1 apart are not told apart by frames of 10 turns: --turns 30", result.stderr)

    def test_a_missing_package_is_named(self):
        with open(self.path("a.unv"), "w", encoding="ascii") as file:
            file.write("    -1\n    58\n")
        code = f"import sys; sys.path.insert(0, {SCRIPTS!r}); import program; program.optional('no_such_package')"
        result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
        self.assertIn("needs Python with no_such_package: scripts/setup --workbench installs it", result.stderr)


@unittest.skipUnless("GEARMESH_WORKBENCH" in os.environ, "pyuff: see check_workbench")
class Workbench(Case):
    """UFF58, in the environment of scripts/setup --workbench."""

    def test_uff_is_read_as_csv_is(self):
        np.save(self.path("table.npy"), np.column_stack([self.values, self.speed_rpm]))
        code = """if 1:
            import numpy as np, pyuff
            table = np.load("table.npy")
            sets = [pyuff.prepare_58(binary=1, func_type=1, data=column, x=np.arange(len(column)) / 4096.0, id1=name,
                    rsp_node=1, rsp_dir=1, ref_node=1, ref_dir=1, abscissa_spacing=1, abscissa_inc=1 / 4096.0,
                    abscissa_spec_data_type=17, ordinate_axis_units_lab=unit, orddenom_spec_data_type=0)
                    for column, name, unit in zip(table.T, ("acc", "speed"), ("m/s2", "rpm"))]
            pyuff.UFF("a.unv").write_sets(sets, mode="add")
            """
        python = os.path.join(program.workbench_folder(), "bin", "python3")
        made = subprocess.run([python, "-c", code], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(made.returncode, 0, made.stderr)
        command = [os.path.join(SCRIPTS, "orders"), "a.unv", "--signal", "acc", "--speed", "speed", "--orders", "23,46", "--turns", "8"]
        result = subprocess.run([*command, "--no-pictures"], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        np.testing.assert_allclose(self.table("a_tracks.csv")[1][:, 3], 3.0, rtol=0.01)


if __name__ == "__main__":
    unittest.main()
