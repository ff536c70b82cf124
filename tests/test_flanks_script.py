#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/flanks and what it reads with, from constructed flanks whose numbers are known."""
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir)
SCRIPTS = os.path.join(ROOT, "scripts")
PAPER = os.path.join(ROOT, "data", "paper")
sys.path.insert(0, SCRIPTS)
import program  # noqa: E402

program.require("numpy")

import numpy as np  # noqa: E402

import flankfile  # noqa: E402
import mkafile  # noqa: E402
import script_case  # noqa: E402

HEADER = "tooth,flank,t1,t2,deviation_um\n"
PITCH_HEADER = "tooth,flank,deviation_um\n"
DRIVE, COAST, ALL = 0, 1, flankfile.ALL


def rows(tooth, flank, deviation_um, nodes=(3, 5)):
    """Rows of a set: a constant, or a function of t1 and t2."""
    lines = []
    for k1 in range(nodes[0]):
        for k2 in range(nodes[1]):
            t1, t2 = k1 / (nodes[0] - 1), k2 / (nodes[1] - 1)
            value = deviation_um(t1, t2) if callable(deviation_um) else deviation_um
            lines.append(f"{tooth},{flank},{t1:.6g},{t2:.6g},{value:.9g}\n")
    return "".join(lines)


class Folder(unittest.TestCase):
    """A folder for the files of each test."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, text, name="gear.csv"):
        with open(self.path(name), "wb") as file:
            file.write(text if isinstance(text, bytes) else text.encode("utf-8"))
        return self.path(name)

    def flanks(self, *arguments):
        return script_case.call("flanks", *arguments, folder=self.folder)

    def text_of(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()


class Reading(Folder):
    def test_node_values_stand_where_they_belong_in_any_order_of_rows(self):
        lines = rows(0, "drive", lambda t1, t2: 10 * t1 + t2).splitlines(keepends=True)
        expected_um = 10 * np.linspace(0, 1, 3)[:, None] + np.linspace(0, 1, 5)
        for text in (lines, lines[::-1]):
            sets = flankfile.read_flanks(self.write(HEADER + "".join(text)))
            np.testing.assert_array_equal(sets[0, DRIVE], expected_um)

    def test_whatever_the_format_allows(self):
        plain = rows("*", "*", lambda t1, t2: t1 - 2 * t2)
        spaced = "\ufeff# c,o;m\n\n" + HEADER.replace(",", " ,\t") + "  # x\n" + plain.replace(",", " , ")
        loose = plain.replace(",0.25,", ",0.250009,").replace(",-1\n", ",-.1e+1\n")
        expected_um = flankfile.read_flanks(self.write(HEADER + plain))[ALL, ALL]
        for text in (spaced, HEADER + loose, (HEADER + plain).replace("\n", "\r\n"), HEADER + plain.rstrip("\n")):
            np.testing.assert_array_equal(flankfile.read_flanks(self.write(text))[ALL, ALL], expected_um)

    def test_the_most_special_set_wins_whole(self):
        text = rows("*", "*", 1) + rows("*", "coast", 2) + rows(1, "*", 3) + rows(1, "coast", 4) + rows(2, "*", 5)
        sets = flankfile.read_flanks(self.write(HEADER + text))
        won = [[float(flankfile.winner(sets, tooth, side).max()) for side in (DRIVE, COAST)] for tooth in range(4)]
        self.assertEqual(won, [[1, 2], [3, 4], [5, 5], [1, 2]])
        del sets[ALL, ALL]
        self.assertIsNone(flankfile.winner(sets, 0, DRIVE))

    def test_paper_files_are_read_as_they_are(self):
        sets = flankfile.read_flanks(os.path.join(PAPER, "pinion_flanks.csv"))
        self.assertEqual((len(sets), sets[0, DRIVE].shape), (90, (21, 31)))
        with open(os.path.join(PAPER, "pinion_flanks.csv"), encoding="ascii") as file:
            values = [float(line.rsplit(",", 1)[1]) for line in file if line[0].isdigit()]
        self.assertEqual(sorted(values), sorted(np.concatenate([table.ravel() for table in sets.values()])))


class BadFiles(Folder):
    """Every offence is named with file and line, exit status 2, and nothing is left behind."""

    def assert_refused(self, text, line, *words, arguments=()):
        path = self.write(text)
        result = self.flanks("gear.csv", *arguments)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertNotIn("Traceback", result.stderr)
        for word in (f"gear.csv:{line}:", *words):
            self.assertIn(word, result.stderr)
        self.assertEqual(os.listdir(self.folder), [os.path.basename(path)])

    def test_the_same_file_without_an_offence_is_accepted(self):
        self.write(HEADER + rows(0, "drive", 1))
        self.assertEqual(self.flanks("gear.csv", "--no-pictures").returncode, 0)

    def test_a_missing_file_is_named(self):
        result = self.flanks("nowhere.csv")
        self.assertEqual(result.returncode, 2)
        self.assertIn("nowhere.csv: cannot be read: No such file", result.stderr)

    def test_wrong_headers(self):
        good = rows(0, "drive", 1)
        self.assert_refused("tooth,flank,t2,t1,deviation_um\n" + good, 1, "tooth,flank,t2,t1", HEADER.strip())
        self.assert_refused(good, 1, "the header must be", "got '0,drive,0,0,1'")
        self.assert_refused(PITCH_HEADER + "0,drive,1\n", 1, "pitch file")
        self.assert_refused("# only a comment\n", 1, "must have the header", "got nothing")
        self.assert_refused(HEADER, 1, "must be rows", "got none")

    def test_decimal_commas_and_other_delimiters(self):
        good = rows(0, "drive", 1.5)
        self.assert_refused(HEADER + good.replace("1.5", "1,5"), 2, "must have 5 fields", "got 6", "decimal comma")
        self.assert_refused((HEADER + good).replace(",", ";"), 1, "semicolons")
        self.assert_refused(HEADER + good.replace(",", "\t"), 2, "tabs")
        self.assert_refused(HEADER + "0,drive,0,0\n", 2, "must have 5 fields", "got 4")

    def test_what_is_no_number(self):
        for text in ("nan", "inf", "0x1p3", "1.5um", "", "--1", "1e", "\u0661"):
            bad = rows(0, "drive", 7).replace(",7\n", f",{text}\n", 1)
            self.assert_refused(HEADER + bad, 2, "deviation_um: must be a number", f"got '{text}'")
        self.assert_refused(HEADER + rows(0, "drive", 7).replace(",7\n", ",1e999\n", 1), 2, "too large")

    def test_teeth_and_flanks(self):
        self.assert_refused(HEADER + rows(-1, "drive", 1), 2, "tooth: must be", "got '-1'")
        self.assert_refused(HEADER + rows("\u0661", "drive", 1), 2, "tooth: must be", "got '\u0661'")
        self.assert_refused(HEADER + rows(0, "left", 1), 2, "flank: must be drive, coast or * (got 'left')")
        self.assert_refused(HEADER + rows(17, "drive", 1), 2, "tooth: must be 0 to 16, or * (got 17)", arguments=("--gear-teeth", "17"))
        self.assert_refused(HEADER + rows(123456, "drive", 1), 2, "tooth: must be 0 to 999, or * (got 123456)")

    def test_grids_that_are_none_are_refused(self):
        lines = rows(0, "drive", 1).splitlines(keepends=True)
        second = rows(1, "*", 1).splitlines(keepends=True)
        self.assert_refused(HEADER + "".join(lines + second[:-1]), 17, "tooth 1, flank *", "got none for t1 = 1, t2 = 1")
        self.assert_refused(HEADER + "".join(lines + second + second[3:4]), 32, "second one for t1 = 0, t2 = 0.75")
        self.assert_refused(HEADER + "".join(lines).replace("0.25", "0.3"), 3, "t2: must be on", "for example 0.25 (got 0.3)")
        slip = rows(0, "drive", 1, (6, 5)).replace("0.25", "0.26", 1)
        self.assert_refused(HEADER + slip, 3, "t2: must be on the uniform grid of 6 x 5 nodes", "for example 0.25 (got 0.26)")
        self.assert_refused(HEADER + "".join(lines) + rows(1, "drive", 1, (3, 4)), 18, "got 0.333333")
        self.assert_refused(HEADER + "".join(lines).replace(",0.25,", ",0.250011,"), 3, "0.250011")
        self.assert_refused(HEADER + "".join(lines[10:]), 2, "t1: must have at least two positions (got 1 alone)")
        self.assert_refused(HEADER + "".join(lines[:10]), 7, "t1: must be a grid from 0 to 1 (got an end at 0.5)")
        self.assert_refused(HEADER + "".join(lines) + "0,drive,2,0,1\n", 17, "t1: must be from 0 to 1 (got 2)")

    def test_bytes_that_are_no_text(self):
        good = (HEADER + rows(0, "drive", 1)).encode()
        self.assert_refused(good + b"0,drive,0,0,\0", 17, "zero byte")
        self.assert_refused(good + b"0,drive,0,0,1\r0\n", 17, "carriage return")
        self.assert_refused(good + b"0,drive,0,0," + b"1" * 1000, 17, "at most 1000 characters")

    def test_pitch_files_that_are_none_are_refused(self):
        for text, words in (
            ("0,drive,1\n1,drive,1\n0,drive,2\n", ["pitch.csv:4:", "tooth 0, flank drive", "line 2"]),
            ("0,drive,nan\n", ["pitch.csv:2:", "nan"]),
            ("0,drive,0,0,1\n", ["pitch.csv:2:", "must have 3 fields", "got 5"]),
        ):
            self.write(HEADER + rows(0, "drive", 1))
            self.write(PITCH_HEADER + text, "pitch.csv")
            result = self.flanks("gear.csv", "pitch.csv")
            self.assertEqual((result.returncode, result.stdout), (2, ""), result.stderr)
            for word in words:
                self.assertIn(word, result.stderr)
            self.assertEqual(sorted(os.listdir(self.folder)), ["gear.csv", "pitch.csv"])

    def test_options_out_of_range_are_refused(self):
        self.write(HEADER + rows(0, "drive", 1) + rows(4, "*", 1))
        for option, value, word in (
            ("--tooth", "5", "must be from 0 to 4 (got 5)"),
            ("--tooth", "-1", "whole number"),
            ("--teeth", "0,9", "must be from 0 to 4 (got 9)"),
            ("--teeth", "0,0", "different"),
            ("--flank", "left", "invalid choice"),
            ("--gear-teeth", "2", "3 to 1000"),
            ("--output", "no/such/folder/stem", "no/such/folder: there is no such folder"),
        ):
            result = self.flanks("gear.csv", f"{option}={value}")
            self.assertEqual((result.returncode, result.stdout), (2, ""), option)
            self.assertIn(word, result.stderr)
        self.assertEqual(self.flanks("gear.csv", "--gear-teeth=5", "--teeth=0,4", "--no-pictures").returncode, 0)


class Summary(Folder):
    def lines_of(self, *arguments):
        result = self.flanks(*arguments, "--no-pictures")
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout.splitlines(), result.stderr

    def test_extremes_and_rms_of_each_side(self):
        """Drive: a plane from -3 to 5 um on tooth 2 only. Coast: 4 um on all, 3 um on tooth 0."""
        drive = rows("*", "drive", 0) + rows(2, "drive", lambda t1, t2: 8 * t1 * t2 - 3, (3, 5))
        self.write(HEADER + drive + rows("*", "coast", 4) + rows(0, "coast", 3))
        lines, _ = self.lines_of("gear.csv", "--gear-teeth", "4")
        t1, t2 = np.linspace(0, 1, 3)[:, None], np.linspace(0, 1, 5)
        rms_um = np.sqrt(((8 * t1 * t2 - 3) ** 2).mean() / 4)
        self.assertEqual(lines[0], "gear.csv: 4 teeth, 4 sets of 3 x 5 nodes (t1 x t2)")
        self.assertEqual(lines[1].split(), ["drive", "rms", f"{rms_um:.3f}", "um"])
        self.assertEqual(lines[2].split("min")[1].split(), "-3.000 (tooth 2, t1 0, t2 0)".split())
        self.assertEqual(lines[3].split("max")[1].split(), "5.000 (tooth 2, t1 1, t2 1)".split())
        self.assertEqual(lines[4].split(), ["coast", "rms", f"{np.sqrt((3 * 16 + 9) / 4):.3f}", "um"])
        self.assertEqual(lines[5].split("min")[1].split(), "3.000 (tooth 0, t1 0, t2 0)".split())
        self.assertEqual(lines[6].split("max")[1].split(), "4.000 (tooth 1, t1 0, t2 0)".split())

    def test_pitch_numbers(self):
        """The largest step is the one from the last tooth to the first; coast has a row for all others."""
        self.write(HEADER + rows("*", "*", 0))
        drive = "".join(f"{i},drive,{value}\n" for i, value in enumerate([5, 3, 1, -1, -2.5]))
        self.write(PITCH_HEADER + drive + "*,coast,0.5\n3,coast,-1.25\n", "pitch.csv")
        lines, errors = self.lines_of("gear.csv", "pitch.csv")
        self.assertEqual(errors, "")
        self.assertIn("5 teeth", lines[0])
        drive = "drive f_p cos(alpha_t) 7.500 um (tooth 0 against 4) F_p cos(alpha_t) 7.500 um (tooth 4 to 0)"
        coast = "coast f_p cos(alpha_t) 1.750 um (tooth 3 against 2) F_p cos(alpha_t) 1.750 um (tooth 3 to 0)"
        self.assertEqual([line.split() for line in lines[-2:]], [drive.split(), coast.split()])
        # As arcs at the reference circle, which f_p and F_p of ISO 1328-1 are: cos(alpha_t) = 0.8.
        lines, _ = self.lines_of("gear.csv", "pitch.csv", "--pressure-angle", "36.8698976458440")
        drive = "drive f_p 9.375 um (tooth 0 against 4) F_p 9.375 um (tooth 4 to 0)"
        self.assertEqual(lines[-2].split(), drive.split())

    def test_single_and_total_pitch_of_an_eccentricity(self):
        """A sine of amplitude a: F_p = 2 a, f_p = 2 a sin(pi / z)."""
        pitch_um = 6 * np.sin(2 * np.pi * np.arange(40) / 40)
        single_um = flankfile.single_pitch_um(pitch_um)
        self.assertAlmostEqual(np.abs(single_um).max(), 12 * np.sin(np.pi / 40), delta=0.01)
        self.assertAlmostEqual(single_um.sum(), 0.0)
        self.assertAlmostEqual(single_um[1], pitch_um[1] - pitch_um[0])
        self.assertAlmostEqual(flankfile.total_pitch_um(pitch_um), 12.0)

    def test_flanks_without_rows_are_ideal_and_said(self):
        self.write(HEADER + rows(2, "drive", 6))
        self.write(PITCH_HEADER + "2,*,1\n", "pitch.csv")
        lines, errors = self.lines_of("gear.csv", "pitch.csv")
        self.assertIn("3 teeth, 1 set ", lines[0])
        self.assertIn(f"rms {np.sqrt(12):7.3f}", lines[1])
        self.assertIn("gear.csv: no row for tooth 0, flank drive and 4 more: ideal", errors)
        self.assertIn("pitch.csv: no row for tooth 0, flank drive and 3 more: ideal", errors)

    def test_one_tooth_stands_for_all_if_none_is_named(self):
        self.write(HEADER + rows("*", "*", 1))
        self.assertIn("gear.csv: one tooth for all, 1 set", self.lines_of("gear.csv")[0][0])


class Drawn(Folder):
    """What is in a picture."""

    def png_size(self, name):
        with open(self.path(name), "rb") as file:
            head = file.read(24)
        self.assertEqual(head[:8], b"\x89PNG\r\n\x1a\n")
        return struct.unpack(">II", head[16:24])

    def svg_text(self, name):
        """The words of a picture, a space between its texts."""
        svg = self.text_of(name)
        self.assertIn("<svg", svg)
        self.assertIn("DejaVu Sans", svg)
        found = re.findall(r"<text[^>]*>(.*?)</text>", svg, re.DOTALL)
        return " ".join(re.sub(r"<[^>]*>|\s+", " ", text).strip() for text in found)


class Pictures(Drawn):
    def write_gear(self):
        """7 teeth; tooth 5 deviates most, on its coast flank."""
        flanks = rows("*", "*", lambda t1, t2: -4 * (2 * t1 - 1) ** 2) + rows(5, "coast", lambda t1, t2: 9 * t2 - 2)
        pitch_um = [0, 1, 3.25, 2, 0, -1, -2]
        self.write(HEADER + flanks)
        self.write(PITCH_HEADER + "".join(f"{i},*,{value}\n" for i, value in enumerate(pitch_um)), "pitch.csv")

    def test_all_pictures_are_made_with_their_labels_and_nothing_else(self):
        self.write_gear()
        result = self.flanks("gear.csv", "pitch.csv", "--output", "out", "--title", "it's a \"test\" 50 %")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        names = [f"out_{name}" for name in ("topography", "traces", "pitch", "teeth")]
        expected = [f"{name}.{suffix}" for name in names for suffix in ("pdf", "png", "svg")] + ["gear.csv", "pitch.csv"]
        self.assertEqual(sorted(os.listdir(self.folder)), sorted(expected))
        for name in names:
            self.assertGreater(min(self.png_size(name + ".png")), 600)
            self.assertIn(name, result.stdout)
            self.assertIn("it's a &quot;test&quot; 50 %", self.svg_text(name + ".svg").replace('"', "&quot;"))

        labels = {
            "topography": ["tooth 0, drive flank", "-4.00 to +0.00 µm", "tooth 5, coast flank", "-2.00 to +7.00 µm",
                           "t1, along the face (z / face width)", "t2, along the profile (0 start, 1 tip)",
                           "deviation / µm"],
            "traces": ["Profile traces at mid face", "Helix traces at mid profile", "drive flanks", "coast flanks",
                       "tip", "start", "+ material", "2 µm"],
            "pitch": ["Single pitch deviation", "= 2.25 µm (tooth 2)",
                      "Cumulative pitch deviation", "= 5.25 µm (teeth 6 and 2)"],
            "teeth": ["drive flanks", "coast flanks", "drive: mean, range", "coast: pitch",
                      "deviation / µm (+ material added)"],
        }
        for name, texts in labels.items():
            shown = self.svg_text(f"out_{name}.svg")
            for text in texts:
                self.assertIn(text, shown)

    def test_without_a_pitch_file_there_is_no_pitch(self):
        self.write_gear()
        self.assertEqual(self.flanks("gear.csv").returncode, 0)
        self.assertIn("gear_teeth.png", os.listdir(self.folder))
        self.assertNotIn("gear_pitch.png", os.listdir(self.folder))
        self.assertNotIn("pitch", self.svg_text("gear_teeth.svg"))

    def test_chosen_tooth_flank_and_traces(self):
        self.write_gear()
        result = self.flanks("gear.csv", "--tooth", "3", "--teeth", "1,5")
        self.assertEqual(result.returncode, 0, result.stderr)
        both = self.svg_text("gear_topography.svg")
        self.assertIn("tooth 3, drive flank", both)
        self.assertIn("tooth 3, coast flank", both)
        self.assertNotIn("all, mean", self.svg_text("gear_traces.svg"))
        # The coast profile of tooth 5 rises by 9 um from start to tip, without any error of form.
        numbers = " 9.0 +9.0 0.0 "
        self.assertIn(numbers, self.svg_text("gear_traces.svg"))

        result = self.flanks("gear.csv", "--tooth", "3", "--flank", "coast", "--teeth", "1,2", "--overlay")
        self.assertEqual(result.returncode, 0, result.stderr)
        one = self.svg_text("gear_topography.svg")
        self.assertNotIn("drive flank", one)
        self.assertIn("tooth 3, coast flank", one)
        self.assertIn("all, mean", self.svg_text("gear_traces.svg"))
        self.assertNotIn(numbers, self.svg_text("gear_traces.svg"))

    def test_flat_flanks_are_drawn_without_complaint(self):
        """Ideal ones have no contour line, constant ones no range."""
        for deviation_um, nodes, pitch_um in ((0, (3, 5), 0), (5, (2, 2), 3), (-1e-4, (2, 90), 0)):
            self.write(HEADER + rows("*", "*", deviation_um, nodes))
            self.write(PITCH_HEADER + f"*,*,{pitch_um}\n", "pitch.csv")
            for pitch in (["pitch.csv"], []):
                result = self.flanks("gear.csv", *pitch, "--gear-teeth", "5", "--overlay")
                self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_a_failed_drawing_leaves_nothing(self):
        self.write_gear()
        self.write("#!/bin/sh\necho no >&2\nexit 1\n", "gnuplot")
        os.chmod(self.path("gnuplot"), 0o755)
        result = subprocess.run(
            [sys.executable, os.path.join(SCRIPTS, "flanks"), "gear.csv"], cwd=self.folder, capture_output=True, text=True,
            env={**os.environ, "PATH": self.folder + ":" + os.environ["PATH"], "PYTHONDONTWRITEBYTECODE": "1"})
        self.assertEqual(result.returncode, 1)
        self.assertIn("flanks: gnuplot flanks_", result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["gear.csv", "gnuplot", "pitch.csv"])


class Measured(Drawn):
    """Traces as a measuring machine prints them."""

    HEADER = "tooth,flank,trace,face_mm,diameter_mm,deviation_um\n"

    def write_traces(self, shape=lambda t: -4 * t):
        lines = [self.HEADER]
        for tooth in (1, 4):
            for flank in ("left", "right"):
                places = [0, 0.05, 0.2, 0.5, 0.8, 0.95, 1]
                lines += [f"{tooth},{flank},profile,8,{20 + 4 * t},{shape(t) * tooth + 50}\n" for t in places]
                lines += [f"{tooth},{flank},helix,{17 - 16 * t},22,{2 * (t - 0.5) ** 2}\n" for t in places]
        self.write("".join(lines), "t.csv")

    def test_the_chart_shows_teeth_flanks_and_places(self):
        self.write_traces()
        result = self.flanks("t.csv")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(sorted(os.listdir(self.folder)), ["t.csv", "t_traces.pdf", "t_traces.png", "t_traces.svg"])
        self.assertIn("8 traces of 2 teeth", result.stdout)
        self.assertIn("right profile: 2 traces, largest range 16.000 um (tooth 4)", result.stdout)
        self.assertGreater(min(self.png_size("t_traces.png")), 600)
        shown = self.svg_text("t_traces.svg")
        for text in ("left flanks", "right flanks", "over diameter / mm", "distance from the datum face / mm",
                     " 22 ", " 15 ", "8 traces as measured", " 16.0 -16.0 0.0 ", " 4.0 -4.0 0.0 ", " 0.5 +0.0 0.5 "):
            self.assertIn(text, shown)

    def test_chosen_teeth(self):
        self.write_traces()
        self.assertEqual(self.flanks("t.csv", "--teeth", "4").returncode, 0)
        self.assertNotIn(" -4.0 ", self.svg_text("t_traces.svg"))
        self.assertIn(" -16.0 ", self.svg_text("t_traces.svg"))

    def test_left_is_left(self):
        self.write_traces()
        self.assertEqual(self.flanks("t.csv").returncode, 0)
        shown = self.svg_text("t_traces.svg")
        self.assertLess(shown.index("left flanks"), shown.index("right flanks"))
        column, traces = flankfile.read_traces(self.path("t.csv"))
        self.assertEqual((column, len(traces)), ("diameter_mm", 8))
        self.assertEqual(traces[1].along_mm[0], 1)  # was measured from 17 down to 1

    MACHINE = ("HEADER KS.MK.FILE\r\nUNITS mm\r\nUNDEFINED -999 ! none\r\n 21 :Modul: 2,000\r\n 22 :Z\xe4hnezahl: 20\r\n"
               " 23 :Winkel: 0\xb000'00\"\r\n 24 :Winkel: 20\xb000'00\"\r\n 41 :da: 38.0 39.0\r\n 44 :de: 43.0\r\n 61 :ba: 1.0\r\n"
               " 64 :be: 15.0\r\n\r\n")

    def machine_traces(self, text):
        with open(self.path("t.mka"), "w", encoding="latin-1", newline="") as file:
            file.write(self.MACHINE + text)
        return mkafile.read_traces(self.path("t.mka"))

    def test_traces_of_a_machine_are_where_they_were_measured(self):
        column, traces = self.machine_traces(
            "Profil:\r\nZahn-Nr.: 3 links / 5  Werte  z= 8.0\r\n1,5 2 3\r\n-999 5\r\n\r\n"
            "Zahn-Nr.: 3 rechts / 3 Werte z= 8\r\n1 2 3\r\n"
            "Topografie: Zahn-Nr.: 3 /Profil:2 links / 2 Werte / z= 8.0\r\n9 9\r\n"
            "Lead: Tooth-No.: 7k right / 3 values x= 7.1\r\n1 4 2\r\n"
            "   linke Zahnflanke\r\n  Zahn-Nr.  fp  Fp  Fr\r\n 1  0.662 0.5 0.778\r\n")
        self.assertEqual(column, "roll_length_mm")
        self.assertEqual([(trace.tooth, trace.flank, trace.kind) for trace in traces],
                         [(3, "left", "profile"), (3, "right", "profile"), (7, "right", "helix")])
        base_mm = 20 * math.cos(math.radians(20))
        begin_mm, end_mm, right_mm = (math.sqrt(d * d / 4 - base_mm**2) for d in (38, 43, 39))
        np.testing.assert_allclose(traces[0].along_mm, [begin_mm + share * (end_mm - begin_mm) for share in (0, 0.25, 0.5, 1)])
        np.testing.assert_array_equal(traces[0].deviation_um, [1.5, 2, 3, 5])
        np.testing.assert_allclose(traces[1].along_mm[[0, -1]], [right_mm, end_mm])
        np.testing.assert_array_equal(traces[2].along_mm, [1, 8, 15])
        result = self.flanks("t.mka")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("3 traces of 2 teeth", result.stdout)
        self.assertIn("over roll length / mm", self.svg_text("t_traces.svg"))

    def test_machine_files_that_cannot_be_drawn(self):
        good = "Zahn-Nr.: 3 links / 2 Werte z= 8\n"
        for text, message in ((good + "1\n", "13: the trace must have 2 values (got 1)"), (good + "1 2 3\n", "(got 3)"),
                              (good + "1 x\n", "(got 0)"), ("Zahn-Nr.: 3 / 2 Werte z= 8\n1 2\n", "its flank"),
                              ("", "must have a trace")):
            with self.assertRaises(flankfile.FlankFileError) as caught:
                self.machine_traces(text)
            self.assertIn(message, str(caught.exception))
        self.write("HEADER KS.MK.FILE\n" + good + "1 2\n", "a.mka")
        self.write("HEADER KS.MW.FILE\n 7 :ME: 1\n", "a.mew")
        for name, message in (("a.mka", "its line 41 where the traces begin"), ("a.mew", "give the .mka")):
            result = self.flanks(name)
            self.assertEqual(result.returncode, 2)
            self.assertIn(message, result.stderr)
            self.assertNotIn("Traceback", result.stderr)

    def test_a_trace_ends_where_its_place_changes(self):
        place = "5,left,profile,8,20,1\n5,left,profile,8.005,21,1\n5,left,profile,{},22,1\n5,left,profile,{},23,1\n"
        for at, expected in ((8, 1), (12, 2)):
            self.write(self.HEADER + place.format(at, at), "t.csv")
            self.assertEqual(len(flankfile.read_traces(self.path("t.csv"))[1]), expected)

    def test_refusals(self):
        self.write_traces()
        self.write(PITCH_HEADER + "0,drive,1\n", "p.csv")
        bad = {
            "5,left,profile,8,20\n": "2: a row must have 6 fields",
            "5,L,profile,8,20,1\n": "2: flank: must be left, right, drive or coast (got 'L')",
            "5,left,lead,8,20,1\n": "2: trace: must be profile or helix (got 'lead')",
            "*,left,helix,8,20,1\n": "2: tooth: must be a whole number from 0 on (got '*')",
            "5,left,helix,8,20,x\n": "2: deviation_um: must be a number like 1.5 or -2e-3 (got 'x')",
            "5,left,helix,8,20,1\n": "2: the helix trace of tooth 5, flank left: must have 2 points",
            "5,left,helix,8,20,1e999\n": "2: numbers must be finite",
            "": "1: there must be rows",
        }
        for row, said in bad.items():
            self.write(self.HEADER + row, "bad.csv")
            result = self.flanks("bad.csv")
            self.assertEqual(result.returncode, 2)
            self.assertIn("bad.csv:" + said, result.stderr)
        for option in (("p.csv",), ("--tooth", "1"), ("--flank", "drive"), ("--overlay",), ("--gear-teeth", "45")):
            result = self.flanks("t.csv", *option)
            self.assertEqual(result.returncode, 2)
            self.assertIn("there is no use for", result.stderr)
        self.assertIn("no trace of tooth 2", self.flanks("t.csv", "--teeth", "1,2").stderr)


class Traces(Folder):
    """Where the curves of the trace picture stand."""

    def setUp(self):
        super().setUp()
        import importlib.machinery
        import importlib.util

        loader = importlib.machinery.SourceFileLoader("flanks", os.path.join(SCRIPTS, "flanks"))
        self.script = importlib.util.module_from_spec(importlib.util.spec_from_loader("flanks", loader))
        loader.exec_module(self.script)

    def test_cuts_are_at_the_middle_also_between_nodes(self):
        for nodes in ((3, 5), (4, 6)):
            t1, t2 = np.linspace(0, 1, nodes[0])[:, None], np.linspace(0, 1, nodes[1])
            table_um = 10 * t1 + 3 * t2 + t1 * t2
            np.testing.assert_allclose(self.script.profile_um(table_um), 5 + 3.5 * t2)
            np.testing.assert_allclose(self.script.helix_um(table_um), (1.5 + 10.5 * t1).ravel())

    def test_material_points_outwards_on_both_sides(self):
        traces_um = np.array([[[0.0, 3.0], [0.0, 3.0]]])
        panel = self.script.TracePanel(traces_um, traces_um)
        for side, outwards in ((DRIVE, -1), (COAST, 1)):
            x = panel.x(0, side, traces_um[0][side])
            self.assertEqual(x[0], panel.nominal(0, side))
            self.assertAlmostEqual((x[1] - x[0]) * outwards * panel.slot_um, 3.0)
            self.assertGreater(x[0] * outwards, panel.GAP)
            self.assertLess(x[1] * outwards, panel.GAP + 1)

    def test_the_level_of_a_measured_trace_goes(self):
        trace = flankfile.Trace(1, "left", "helix", [(0, 5), (2, 60), (1, 7)])
        self.assertEqual(list(self.script.levelled_um(trace)), [-2, 0, 53])

    def test_numbers_of_a_trace(self):
        t = np.linspace(0, 1, 101)
        np.testing.assert_allclose(self.script.trace_numbers_um(4 - 6 * t), (6, -6, 0), atol=1e-12)
        total_um, slope_um, form_um = self.script.trace_numbers_um(2 * np.cos(4 * np.pi * t))
        np.testing.assert_allclose((total_um, slope_um, form_um), (4, 0, 4), atol=0.05)

    def test_round_numbers_of_scales(self):
        for value, expected in ((0, 1), (1, 1), (1.01, 2), (2.5, 5), (5.1, 10), (0.03, 0.05), (49, 50), (1000, 1000)):
            self.assertAlmostEqual(self.script.round_up(value), expected)
        for largest_um in (1e-3, 0.7, 6, 6.1, 22.9, 300):
            range_um, step_um = self.script.colour_scale(largest_um)
            self.assertGreaterEqual(range_um, largest_um * (1 - 1e-9))
            self.assertLessEqual(range_um / step_um, 6)
            self.assertAlmostEqual(range_um / step_um, round(range_um / step_um))

    def test_tiles_stand_in_rows_from_the_top(self):
        side_um = np.array([np.full((2, 2), float(tooth)) for tooth in range(10)])
        image = self.script.tile_image(side_um, 8)
        self.assertEqual(image.shape, (2 * self.script.TILE_HEIGHT, 8 * self.script.TILE_WIDTH))
        self.assertEqual(image[self.script.TILE_HEIGHT, 0], 0)
        self.assertEqual(image[self.script.TILE_HEIGHT, 7 * self.script.TILE_WIDTH], 7)
        self.assertEqual(image[0, self.script.TILE_WIDTH], 9)
        self.assertTrue(np.isnan(image[0, 2 * self.script.TILE_WIDTH]))

    def test_teeth_of_the_traces_are_even_round_the_gear(self):
        class Options:
            teeth = None

        for teeth, expected in ((45, [0, 11, 23, 34]), (40, [0, 10, 20, 30]), (3, [0, 1, 2]), (1, [0])):
            gear = self.script.Gear(teeth, {(ALL, ALL): np.zeros((2, 2))}, None)
            self.assertEqual(self.script.trace_teeth(gear, Options), expected)


class Palette(unittest.TestCase):
    def test_both_arms_fall_in_equal_steps_of_lightness_from_a_neutral_middle(self):
        with open(os.path.join(SCRIPTS, "flanks_style.gp"), encoding="utf-8") as file:
            colours = re.findall(r"-?\d '#([0-9a-f]{6})'", file.read())
        self.assertEqual(len(colours), 13)
        rgb = np.array([[int(c[i : i + 2], 16) / 255 for i in (0, 2, 4)] for c in colours])
        linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
        lightness = 116 * np.cbrt(linear @ [0.2126, 0.7152, 0.0722]) - 16
        np.testing.assert_allclose(lightness, 96 - 64 * np.abs(np.arange(-6, 7)) / 6, atol=0.6)
        self.assertEqual(len(set(rgb[6])), 1)
        self.assertTrue((rgb[:6, 2] > rgb[:6, 0]).all() and (rgb[7:, 0] > rgb[7:, 2]).all())


if __name__ == "__main__":
    unittest.main()
