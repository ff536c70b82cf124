#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/summary, scripts/plot and scripts/report: of runs whose numbers are known."""
import base64
import html.parser
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "scripts"))
import program  # noqa: E402

program.require("numpy", "scipy")

import numpy as np  # noqa: E402
from scipy.io import wavfile  # noqa: E402

import pictures  # noqa: E402
import runup  # noqa: E402
import script_case  # noqa: E402
import sound  # noqa: E402
import tracking  # noqa: E402

HEAD = "# gearsim 0.0.0\n# gears.pinion_teeth = 23\n# gears.wheel_teeth = -71\n"
RATE_HZ = 4096.0


class Case(unittest.TestCase):
    """Runs in a folder of their own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        few = mock.patch.object(tracking, "POINTS", 100)
        few.start()
        self.addCleanup(few.stop)

    def write(self, name, head, columns):
        with open(os.path.join(self.folder, name), "w", encoding="ascii") as file:
            file.write(head + ",".join(columns) + "\n")
            np.savetxt(file, np.column_stack(list(columns.values())), "%.10g", ",")

    def call(self, *arguments):
        result = script_case.call(*arguments, folder=self.folder)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout

    def run_up(self, **changed):
        """600 to 2400 rpm in 2 s: order 23 passes 700 Hz at 1826 rpm; 3 % of the rows without contact."""
        time_s = np.arange(int(2 * RATE_HZ)) / RATE_HZ
        angle_rad = (600.0 * time_s + 450.0 * time_s**2) * np.pi / 30.0
        pairs = np.where(np.arange(len(time_s)) % 100 < 3, 0, 2)
        columns = {
            "time_s": time_s, "pinion_speed_rpm": 600.0 + 900.0 * time_s, "pinion_angle_rad": angle_rad,
            "dte_um": -60.0 + 1.5 * np.cos(23 * angle_rad), "pairs_in_contact": pairs,
            "contact_force_N": 300.0 + 50.0 * np.cos(23 * angle_rad + 1.0) + 8.0 * np.cos(46 * angle_rad),
        }
        return {name: values for name, values in {**columns, **changed}.items() if values is not None}

    def static(self, positions=100, cycles=1, loads=(100.0, 200.0)):
        """TE of two harmonics, twice as large under the second load."""
        mesh = np.arange(positions) * cycles / positions
        curve_um = 0.4 * np.cos(2 * np.pi * mesh) + 0.1 * np.sin(4 * np.pi * mesh + 1.0)
        return {
            "pinion_angle_rad": np.tile(2 * np.pi * mesh / 23, len(loads)),
            "te_um": np.concatenate([(i + 1) * curve_um for i in range(len(loads))]),
            "mesh_stiffness_N_per_um": np.full(positions * len(loads), 400.0),
            "load_torque_Nm": np.repeat(loads, positions),
        }


class Summaries(Case):
    def summary(self, *arguments):
        return self.call("summary", *arguments)

    def test_a_run_up_in_words_and_numbers(self):
        self.write("a.csv", HEAD + "# eigenfrequency_Hz = 700\n# output.oversampling = 1\n", self.run_up())
        one = json.loads(self.summary("a.csv", "--json"))[0]
        self.assertEqual((one["kind"], one["gears"]["wheel_teeth"], len(one["warnings"])), ("dynamic", -71, 1))
        first, second, third, _ = one["resonances"]
        self.assertAlmostEqual(first["crosses_at"]["value"], 60 * 700 / 23, delta=0.01)
        self.assertAlmostEqual(first["value"], 50.0, delta=0.5)
        self.assertAlmostEqual(second["value"], 8.0, delta=0.1)
        self.assertIsNone(third["value"])  # at 609 rpm, too near to the start
        self.assertIn("frames of the run go from", third["why"])
        self.assertAlmostEqual(one["force"]["contact_lost"]["value"], 3.0, delta=0.05)
        self.assertAlmostEqual(one["force"]["mean"]["value"], 300.0, delta=0.5)
        self.assertAlmostEqual(one["te_peak_to_peak"]["value"], 3.0, delta=0.03)
        self.assertAlmostEqual(one["te_orders"][0]["value"], 1.5, delta=0.02)
        text = self.summary("a.csv")
        self.assertRegex(text, r"order 23 \(mesh 1\) crosses the resonance at 1826 rpm: (50|50\.\d+|49\.\d+) N")
        self.assertIn("contact lost 3", text)
        self.assertIn("warning: oversampling = 1", text)

    def test_what_is_no_number_says_why(self):
        self.write("a.csv", HEAD, self.run_up(dte_um=None, pairs_in_contact=None))
        one = json.loads(self.summary("a.csv", "--json"))[0]
        for place, why in ((one["gears"]["eigenfrequency"], "head of the run"), (one["resonances"][0], "no eigenfrequency"),
                           (one["force"]["contact_lost"], "pairs_in_contact"), (one["te_peak_to_peak"], "dte_um"),
                           (one["te_orders"][1], "dte_um")):
            self.assertIsNone(place["value"])
            self.assertIn(why, place["why"])
        self.assertIn("transmission error: no number (the run has no column dte_um)", self.summary("a.csv"))
        # A pinion that does not turn: forces, but no orders.
        still = self.run_up()
        still["pinion_speed_rpm"], still["pinion_angle_rad"] = 0 * still["time_s"], 0 * still["time_s"]
        self.write("still.csv", HEAD, still)
        self.assertIn("tooth orders of the force: no number (the pinion stands still)", self.summary("still.csv"))

    def test_a_static_run_in_words_and_numbers(self):
        for cycles in (1, 23):
            self.write("s.csv", HEAD, self.static(100 * cycles, cycles))
            one = json.loads(self.summary("s.csv", "--json"))[0]
            self.assertEqual([load["load"]["value"] for load in one["loads"]], [100, 200])
            for factor, load in enumerate(one["loads"], start=1):
                found = [value["value"] for value in load["te_harmonics"]]
                np.testing.assert_allclose(found, [0.4 * factor, 0.1 * factor, 0, 0], atol=1e-6)
                self.assertEqual(load["mesh_stiffness_N_per_um"]["value"], 400.0)

    def test_a_part_of_a_mesh_cycle_has_no_harmonics(self):
        self.write("s.csv", HEAD, self.static(100, 0.7))
        self.assertIn("its harmonics: no number (the rows do not hold whole mesh cycles", self.summary("s.csv"))

    def test_broken_runs_are_refused(self):
        self.write("a.csv", "# gearsim\n", self.run_up())
        for name, message in (("a.csv", "its head must have gears.pinion_teeth, 3 to 99999\n"), ("nowhere.csv", "nowhere.csv")):
            result = script_case.call("summary", name, folder=self.folder)
            self.assertEqual(result.returncode, 2)
            self.assertIn(message, result.stderr)

        # An option is named where there is one.
        for script in ("plot", "report", "campbell"):
            result = script_case.call(script, "a.csv", folder=self.folder)
            self.assertEqual(result.returncode, 2)
            has_option = "--pinion-teeth" in script_case.call(script, "--help").stdout
            self.assertEqual("--pinion-teeth" in result.stderr, has_option, result.stderr)
            self.assertEqual(has_option, script == "campbell")


class Pictures(Case):
    """What gnuplot is given."""

    def result(self, columns, head=HEAD + "# eigenfrequency_Hz = 700\n", name="a.csv"):
        self.write(name, head, columns)
        return pictures.Result(os.path.join(self.folder, name))

    def data(self, name):
        return np.loadtxt(os.path.join(self.folder, name))

    def test_static_curves_and_their_harmonics(self):
        result = self.result(self.static())
        _, values = pictures.static_curves(result, self.folder)
        self.assertEqual((values["curves"], values["panels"], values["label_1"]), (2, 2, "200 N m"))
        np.testing.assert_allclose(self.data("static.dat")[:, 1], result.columns["te_um"], atol=1e-7)
        np.testing.assert_allclose(self.data("static.dat")[:100, 0], np.arange(100) / 100, atol=1e-7)
        pictures.static_harmonics(result, self.folder)
        np.testing.assert_allclose(self.data("harmonics.dat")[:, 2:4], [[0.4, 0.1], [0.8, 0.2]], atol=1e-6)
        self.assertIsNone(pictures.static_harmonics(self.result(self.static(100, 0.7)), self.folder))

    def test_flanks_that_touch_are_told_apart(self):
        """Force on one flank, on none, on the other one, by turns; the rate is that of the transmission error."""
        columns = self.run_up()
        third = np.arange(len(columns["time_s"])) % 3
        columns["pairs_in_contact"] = np.choose(third, [2, 0, 1])
        columns["dte_um"] = 1e6 * 0.02 * columns["time_s"]

        # Whichever of them carries more in the mean: a run may turn round.
        for forces in ([50.0, 0.0, -300.0], [300.0, 0.0, -50.0]):
            columns["contact_force_N"] = np.choose(third, forces)
            _, values = pictures.time_signal(self.result(columns), self.folder, 1500.0)
            table = self.data("signal.dat")
            np.testing.assert_array_equal(table[:, 4], np.where(table[:, 1] > 0, 1, np.where(table[:, 1] < 0, 2, 0)))
        np.testing.assert_allclose(table[:, 3], 20.0, rtol=1e-3)  # mm/s
        self.assertAlmostEqual(table[-1, 0], 1e3 * 16 / 23 / 25, delta=1.0)  # 16 of 23 teeth at 25 turns a second
        self.assertRegex(values["share_text"], r"3\d\.?\d* % without contact, 3\d\.?\d* % on coast flanks")

    def test_one_turn_and_its_spectrum(self):
        result = self.result(self.run_up())
        pictures.one_turn(result, self.folder, 1500.0)
        turn = self.data("turn.dat")
        self.assertAlmostEqual(turn[-1, 0], 23.0, delta=0.3)
        self.assertAlmostEqual(np.ptp(turn[:, 2]), 3.0, delta=0.15)
        _, values = pictures.spectrum(result, self.folder, 1500.0)
        frequency_Hz, amplitude_N = self.data("spectrum.dat").T
        loudest = amplitude_N.argmax()
        self.assertAlmostEqual(frequency_Hz[loudest], 23 * 25, delta=6)
        self.assertAlmostEqual(amplitude_N[loudest], 50.0, delta=0.5)
        self.assertEqual(values["rim_text_0"], "23 mesh 1")
        self.assertAlmostEqual(values["rim_at_0"], 23 * 25, delta=6)

    def test_a_run_of_twice_the_force_is_6_dB_over_the_other(self):
        columns = self.run_up()
        one = self.result(columns)
        twice = self.result({**columns, "contact_force_N": 2 * columns["contact_force_N"]}, name="b.csv")
        _, values = pictures.difference([one, twice], self.folder)
        level_dB = np.fromfile(os.path.join(self.folder, "difference.bin"), "<f4").reshape(values["rows"], values["columns"])
        at = int(23 / values["order_step"])
        np.testing.assert_allclose(level_dB[:, at], 20 * np.log10(2.0), atol=0.05)
        self.assertLess(np.abs(level_dB[:, int(35 / values["order_step"])]).max(), 0.1)
        _, values = pictures.comparison([one, twice], self.folder)
        np.testing.assert_allclose(self.data("run_1.dat")[:, 1], 2 * self.data("run_0.dat")[:, 1], rtol=1e-6)
        self.assertEqual(values["panel_1"], "order 46, mesh 2")

    def test_all_pictures_are_drawn(self):
        self.write("it's.csv", HEAD, self.run_up())
        self.write("b.csv", HEAD, self.run_up())
        self.write("s.csv", HEAD, self.static())
        for arguments, names in ((["it's.csv", "--at", "1500"], ("it's_signal", "it's_turn", "it's_spectrum")),
                                 (["s.csv"], ("s_static", "s_harmonics")),
                                 (["it's.csv", "b.csv", "--output", "c"], ("c_compare", "c_difference"))):
            self.call("plot", *arguments)
            for name in names:
                for suffix, begin in (("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")):
                    with open(os.path.join(self.folder, f"{name}.{suffix}"), "rb") as file:
                        self.assertEqual(file.read(len(begin)), begin)

    def test_what_cannot_be_drawn_is_said(self):
        self.write("a.csv", HEAD, self.run_up())
        self.write("s.csv", HEAD, self.static())
        self.write("t.csv", HEAD.replace("23", "24"), self.run_up())
        for arguments, message in ((["a.csv", "--at", "9000"], "--at: must be"), (["a.csv", "s.csv"], "must be dynamic"),
                                   (["a.csv", "t.csv"], "same number of teeth"), (["nowhere.csv"], "nowhere.csv")):
            result = script_case.call("plot", *arguments, folder=self.folder)
            self.assertEqual(result.returncode, 2)
            self.assertIn(message, result.stderr)


class Page(html.parser.HTMLParser):
    """What a page loads, and the attributes of its sound."""

    def __init__(self, text):
        super().__init__()
        self.sources, self.audio = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.sources += [attributes[name] for name in ("src", "href") if name in attributes]
        if tag == "audio":
            self.audio.append(attributes)


class Reports(Case):
    def report(self, *arguments):
        self.call("report", *arguments, "--output", "r.html")
        with open(os.path.join(self.folder, "r.html"), encoding="utf-8") as file:
            return file.read()

    def test_a_report_holds_everything_itself(self):
        head = HEAD + "# eigenfrequency_Hz = 700\n# mesh.stiffness_N_per_m = 1e8\n# flanks.pinion = <b>.csv\n"
        self.write("a.csv", head, self.run_up())
        self.write("s.csv", head, self.static())
        text = self.report("a.csv", "s.csv", "--title", "it's <b> & \"q\"")
        page = Page(text)
        self.assertEqual([source[:60] for source in page.sources if not source.startswith(("data:", "#"))], [])
        for part in ("<title>it&#x27;s &lt;b&gt; &amp; &quot;q&quot;</title>", "order 23 (mesh 1) crosses the resonance",
                     "at 100 N m: TE peak-to-peak", "&lt;b&gt;.csv", "stiffness_N_per_m", "gearsim", "0.0.0"):
            self.assertTrue(part in text, part)
        self.assertEqual(sum(source.startswith("data:image/") for source in page.sources), 6 + 2)

        # The sound takes as long as the run, and the cursor rises with the speed from the foot of the map to its top.
        (audio,) = page.audio
        rate_Hz, samples = wavfile.read(io.BytesIO(base64.b64decode(audio["src"].partition(",")[2])))
        self.assertEqual(rate_Hz, sound.RATE_HZ)
        self.assertAlmostEqual(len(samples) / rate_Hz, 2.0, delta=0.01)
        places = json.loads(audio["data-places"])
        self.assertAlmostEqual(places[0], 0.895, delta=0.001)
        self.assertAlmostEqual(places[-1], 0.20, delta=0.001)
        self.assertTrue((np.diff(places) <= 0).all())

    def test_a_run_that_cannot_be_drawn_is_told_in_words(self):
        still = self.run_up()
        still["pinion_speed_rpm"], still["pinion_angle_rad"] = 0 * still["time_s"], 0 * still["time_s"]
        self.write("a.csv", HEAD, still)
        self.assertTrue("a.csv: the pinion stands still." in self.report("a.csv"))

    def test_sound_is_the_force(self):
        """A sine of 50 N keeps its frequency and its amplitude; a housing lifts what is at its resonance."""
        time_s = np.arange(8192) / 8192.0
        run = runup.Run(time_s, 0 * time_s + 60.0, 2 * np.pi * time_s, 300.0 + 50.0 * np.sin(2 * np.pi * 650.0 * time_s))
        values = sound.of_run(run, "force")
        full_N = sound.full_scale_N([values / 2, values])
        self.assertAlmostEqual(full_N, 50.0 / sound.PEAK, delta=0.5)
        inner = values[2000:-2000]
        self.assertAlmostEqual(np.sqrt(2) * inner.std(), 50.0, delta=0.5)
        self.assertAlmostEqual(np.sum(np.diff(np.sign(inner)) > 0) / (len(inner) / sound.RATE_HZ), 650.0, delta=3.0)
        housing_N = sound.full_scale_N([sound.of_run(run, "housing")])
        # 1 / (2 x 0.06) of the first resonance, a little less than that with what the others add.
        self.assertAlmostEqual(housing_N / full_N, 1 / 0.12, delta=0.6)

    def test_bad_input(self):
        self.write("a.csv", HEAD, self.run_up())
        static = self.static()
        self.write("s.csv", HEAD, static)
        for name, text in (("p.ini", b"; A drive.\n[gears]\nz = 2\n"), ("p.png", b"\x89PNG\r\n\x1a\n\0\0")):
            with open(os.path.join(self.folder, name), "wb") as file:
                file.write(text)
        for script, name, message in (("campbell", "s.csv", "must be a dynamic run"), ("orders", "p.png", "no text"),
                                      *((script, name, message) for script in ("summary", "plot", "report", "campbell", "orders")
                                        for name, message in (("p.ini", "parameter file"), ("p.png", "no text")))):
            result = script_case.call(script, name, folder=self.folder)
            self.assertEqual(result.returncode, 2, script)
            self.assertIn(message, result.stderr)
            self.assertNotIn("Traceback", result.stderr)
        for name in ("s.csv", "p.ini", "p.png"):
            os.remove(os.path.join(self.folder, name))
        for arguments, message in ((["nowhere.csv"], "nowhere.csv"), (["a.csv", "--output", "no/where.html"], "no such folder"),
                                   (["a.csv", "--at", "1"], "--at: must be")):
            result = script_case.call("report", *arguments, folder=self.folder)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn(message, result.stderr)
        self.assertEqual(os.listdir(self.folder), ["a.csv"])


@unittest.skipUnless("GEARMESH_WORKBENCH" in os.environ, "mosqito: see check_workbench")
class Loudness(Case):
    def test_a_tone_of_40_dB_at_1_kHz_has_1_sone(self):
        """By definition; order 23 at 2609 rpm, 50 N as 2.83 mPa."""
        columns = self.run_up()
        speed_rpm = 60.0 * 1000.0 / 23.0
        columns["pinion_speed_rpm"] = np.full_like(columns["time_s"], speed_rpm)
        columns["pinion_angle_rad"] = columns["time_s"] * speed_rpm * np.pi / 30.0
        columns["contact_force_N"] = 300.0 + 50.0 * np.sin(23 * columns["pinion_angle_rad"])
        self.write("a.csv", HEAD, columns)
        scale = np.sqrt(2.0) * 2e-5 * 10 ** (40 / 20) / 50.0
        command = [os.path.join(script_case.SCRIPTS, "report"), "a.csv", "--pascal-per-newton", f"{scale:.9g}"]
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        with open(os.path.join(self.folder, "a.html"), encoding="utf-8") as file:
            text = file.read()
        found = re.search(r"Loudness at most ([0-9.]+) sone", text)
        self.assertIn("Tone-to-noise ratio at most", text)
        self.assertAlmostEqual(float(found[1]), 1.0, delta=0.05)  # ISO 532-1 allows 5 %


@unittest.skipUnless("GEARMESH_WORKBENCH" in os.environ, "mosqito: see check_workbench")
class Tonality(Case):
    def test_a_tone_in_white_noise(self):
        """The noise in the critical band of 1 kHz, 162.2 Hz wide by ECMA-418-1, is all that counts against the tone."""
        code = """
import numpy as np, runup, sound
time_s = np.arange(4 * 48000) / 48000
noise = np.random.default_rng(1).standard_normal(len(time_s))
force_N = np.sqrt(2) * np.sin(2 * np.pi * 1000 * time_s) + noise
at_s, tone_dB = sound.tonality(runup.Run(time_s, 0 * time_s + 60, 2 * np.pi * time_s, force_N), "force", 0.02)
assert len(tone_dB) == 15 and 0.2 < at_s[0] < 0.3, at_s
print(tone_dB.mean())
short = runup.Run(time_s[:9], 0 * time_s[:9] + 60, time_s[:9], time_s[:9])
assert not len(sound.tonality(short, "force", 1.0)[1])
"""
        python = os.path.join(os.environ["GEARMESH_WORKBENCH"], "bin", "python3")
        result = subprocess.run([python, "-c", code], cwd=script_case.SCRIPTS, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        # 10 lg(24000 / 162.2), as the noise has the power of the tone over 24 kHz.
        self.assertAlmostEqual(float(result.stdout), 21.7, delta=1.0)


if __name__ == "__main__":
    unittest.main()
