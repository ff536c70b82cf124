#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
gearflanks with measurements: made flanks come back from their traces, the example holds what its head says, the direction
of rotation is stated, and every bad input is refused with file and line, with nothing written.

    test_gearflanks_measured.py GEARFLANKS [-v] [name of a test]...
"""
import cmath
import csv
import math
import os
import re
import shutil
import stat
import sys

sys.dont_write_bytecode = True

from gearflanks_case import Case, main, rows_of  # noqa: E402

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "data", "measured")
PARAMS = os.path.join(DATA, "params.ini")
TRACES = os.path.join(DATA, "traces.csv")
PITCH = os.path.join(DATA, "measured_pitch.csv")
FACE_WIDTH_MM = 17.5

# (base, start, tip) radii of the gears of params.ini, as data/paper/README.md derives them; mm.
RADII = {
    "pinion": (41.885928486852599, 42.793146962250511, 46.93839),
    "wheel": (38.162734843576807, 38.874034774040076, 43.003591),
}
TEETH = {"pinion": 45, "wheel": 41}
ALPHA_T = math.atan(math.tan(math.radians(16)) / math.cos(math.radians(33)))

TRACE_HEADER = "tooth,flank,trace,face_mm,roll_length_mm,deviation_um\n"
PITCH_HEADER = "tooth,flank,cumulative_pitch_um\n"


EXAMPLE = (
    *(PARAMS, "--gear", "pinion", "--datum-face", "I", "--count", "clockwise"),
    *("--traces", TRACES, "--flanks", "f.csv", "--measured-pitch", PITCH, "--pitch", "p.csv"),
)


class Ring(Case):
    def make(self):
        with open(PARAMS, encoding="utf-8") as file:
            text = re.sub(r"(?m)^.*_(tip|start)_diameter_mm.*\n", "", file.read())
        for key, value in (("wheel_teeth", -120), ("center_distance_mm", 73.8), ("normal_pressure_angle_deg", 20)):
            text = re.sub(rf"(?m)^{key} = .*$", f"{key} = {value}", text)
        self.write("ring.ini", text)

    def test_a_ring_is_measured_as_its_teeth_look_with_their_tips_up(self):
        self.make()
        # Tooth 3 of 120 stands 2 um ahead, counted clockwise from face I: as phi_w grows, with the pinion.
        pitch = "".join(f"{tooth},{flank},{2 if tooth == 3 else 0}\n" for tooth in range(1, 121) for flank in ("left", "right"))
        self.write("pitch.csv", PITCH_HEADER + pitch)
        said = self.accepted("ring.ini", "--gear", "wheel", "--datum-face", "I", "--count", "clockwise",
                             "--measured-pitch", "pitch.csv", "--pitch", "p.csv")
        self.assertIn("# ring of 120 teeth, from measurements", said)
        self.assertIn("datum face I (t1 = 0): left flanks are coast, right flanks are drive", said)
        self.assertIn("seen from it the ring turns clockwise as it is driven forward", said)
        self.assertIn("measured teeth 1, 2, 3 .. 120 are teeth 0, 1, 2 .. 119", said)
        rows = {(int(row["tooth"]), row["flank"]): float(row["deviation_um"]) for row in rows_of(self.path("p.csv"))}

        # A ring tooth ahead has gone away from the pinion's drive flank. Arc to base tangent: r_b / r = cos(alpha_t).
        alpha = math.atan(math.tan(math.radians(20)) / math.cos(math.radians(33)))
        self.assertAlmostEqual(rows[2, "drive"], -2 * math.cos(alpha) * 119 / 120, delta=1e-3)
        self.assertAlmostEqual(rows[2, "coast"], 2 * math.cos(alpha) * 119 / 120, delta=1e-3)

    def test_measurements_of_another_gear_are_refused(self):
        self.make()
        how = ("ring.ini", "--gear", "wheel", "--datum-face", "I", "--count", "clockwise")
        self.refused("must have a row for each of the 120 teeth", *how, "--measured-pitch", PITCH, "--pitch", "p.csv")
        self.refused("diameter_mm: must be from", *how, "--traces", TRACES, "--flanks", "f.csv")


class Example(Case):
    def pitch_of(self, side):
        return [float(row["deviation_um"]) for row in rows_of(self.path("p.csv")) if row["flank"] == side]

    def test_it_holds_what_its_head_says(self):
        self.accepted(*EXAMPLE)
        flanks = {}
        for row in rows_of(self.path("f.csv")):
            key = (float(row["t1"]), round(30 * float(row["t2"])))
            flanks.setdefault((int(row["tooth"]), row["flank"]), {})[key] = float(row["deviation_um"])
        self.assertEqual(len(flanks), 90)
        for table in flanks.values():
            self.assertLess(table[0.5, 30], table[0.5, 22] - 8)  # tip relief
            self.assertLess(table[0, 15] + table[1, 15], 2 * table[0.5, 15] - 8)  # crowning
        # An eccentricity e is e along the line of action in the first order of the pitch, on either flank.
        for side in ("drive", "coast"):
            values = self.pitch_of(side)
            self.assertEqual(len(values), 45)
            first = sum(v * cmath.exp(2j * math.pi * i / 45) for i, v in enumerate(values)) / 22.5
            self.assertAlmostEqual(abs(first), 12, delta=3)
            self.assertAlmostEqual(math.fsum(values), 0, delta=1e-2)

    def test_it_tells_mapping_and_direction_of_rotation(self):
        told = self.accepted(*EXAMPLE)
        for name in ("f.csv", "p.csv"):
            with open(self.path(name), encoding="ascii") as file:
                head = "".join(line for line in file if line.startswith("#"))
            for said in (
                "pinion of 45 teeth, from measurements",
                "datum face I (t1 = 0): left flanks are coast, right flanks are drive",
                "the pinion turns clockwise as it is driven forward, and teeth are counted clockwise",
                "measured teeth 1, 2, 3 .. 45 are teeth 0, 1, 2 .. 44",
            ):
                self.assertIn(said, head)
                self.assertIn(said, told)
        self.assertIn("drive, profile: 4 traces of 4 teeth, 41 interpolated", told)
        self.assertIn("last values held beyond", told)
        self.assertRegex(told, r"\nclass \d+\n$")
        self.assertRegex(told, r"21 x 31 nodes: no measured point is off by more than \d\.\d+ um")
        self.assertEqual(sorted(os.listdir(self.folder)), ["f.csv", "p.csv"])

    def test_the_same_rows_from_the_other_face_are_the_other_flanks(self):
        self.accepted(*EXAMPLE)
        drive, coast = self.pitch_of("drive"), self.pitch_of("coast")
        told = self.accepted(*EXAMPLE, "--datum-face", "II", "--first-number=1", "--first-tooth=7")
        self.assertIn("left flanks are drive, right flanks are coast", told)
        self.assertIn("the pinion turns counter-clockwise as it is driven forward", told)
        self.assertIn("measured teeth 1, 2, 3 .. 45 are teeth 7, 6, 5 .. 8", told)
        # What stood ahead in the direction of counting now stands behind, on the other side: the same material.
        for now, before in ((self.pitch_of("coast"), drive), (self.pitch_of("drive"), coast)):
            for i in range(45):
                self.assertEqual(now[(7 - i) % 45], before[i])

    def test_a_wrong_direction_of_counting_shows_in_the_run_out(self):
        told = self.accepted(*EXAMPLE)
        displaced = re.search(r"displaced by (\S+) um, but for (\d+) %", told)
        self.assertAlmostEqual(float(displaced[1]), 12, delta=3)  # 2.5 um of the index come on top
        self.assertLess(int(displaced[2]), 10)
        self.assertNotIn("as said?", told)
        self.assertIn("are they as said?", self.accepted(*EXAMPLE, "--count", "counterclockwise"))
        # The other face turns both around; that cannot be seen.
        self.assertNotIn("as said?", self.accepted(*EXAMPLE, "--datum-face", "II"))

    def test_one_of_the_two_is_enough(self):
        told = self.accepted(*EXAMPLE[:7], "--traces", TRACES, "--flanks", "f.csv", "--nodes", "5x9")
        self.assertNotIn("taken out", told)
        self.assertEqual(len(rows_of(self.path("f.csv"))), 90 * 45)
        self.assertEqual(os.listdir(self.folder), ["f.csv"])
        told = self.accepted(*EXAMPLE[:7], "--measured-pitch", PITCH, "--pitch", "p.csv")
        self.assertNotIn("interpolated", told)
        self.assertIn("drive, pitch: mean of", told)


class Mka(Case):
    """A Klingelnberg text file of known flanks, made here; no genuine file was at hand."""

    COUNT = 480

    @staticmethod
    def roll(diameter):
        return math.sqrt(diameter**2 / 4 - RADII["pinion"][0] ** 2)

    @staticmethod
    def deviation(share, face_mm):
        """Material in um over share = 0..1 of the measured roll length and the distance from the datum face."""
        return -9 * max(0, share - 0.7) ** 2 / 0.09 - 6 * (2 * face_mm / FACE_WIDTH_MM - 1) ** 2 + 2 * share

    def trace(self, title, head, values):
        rows = [values[i : i + 12] for i in range(0, len(values), 12)]
        lines = [" ".join("-2147483.648" if v is None else f"{v:.3f}" for v in row) for row in rows]
        return "\r\n".join([title, head, *lines, "", ""])

    def file(self, name, left_sign=1, end=93.8, chamfer_from=1e9):
        """Teeth 1, 16, 31 on both flanks, with levels as machines have them and ends that were not measured."""
        begin, n = 85.7, self.COUNT
        text = (
            "HEADER KS.MK.FILE\r\nTYPE STI\r\nUNITS mm\r\nPROFILE diameter\r\nUNDEFINED -2147483.648 ! none\r\n"
            " 21 :Normalmodul mn [mm]....: 1.650\r\n 22 :Zähnezahl z...: 45  Außenverzahnung\r\n"
            " 23 :Schrägungswinkel...: 33°00'00\"  rechts\r\n 24 :Eingriffswinkel...: 16°00'00\"\r\n"
            f" 41 :Start Messbereich da [mm].: {begin} {begin}\r\n 44 :Ende Messbereich de [mm]..: {end} {end}\r\n"
            " 61 :Start Messbereich ba [mm].: 0.0\r\n 64 :Ende Messbereich be [mm]..: 17.5\r\n\r\n"
        )
        first, last = self.roll(begin), self.roll(end)
        for tooth in (1, 16, 31):
            for flank, sign in (("links", left_sign), ("rechts", 1)):
                at = first + (last - first) / 2
                helix = [sign * (self.deviation(0.5, i / (n - 1) * 17.5) - 56) for i in range(n)]
                text += self.trace(
                    "Flankenlinie:",
                    f"Zahn-Nr.: {tooth} {flank} / {n}  Werte  x= {at:.3f}",
                    [None] * 12 + helix[12:-11] + [None] * 11,
                )
                profile = []
                for i in range(n):
                    share = i / (n - 1)
                    diameter = 2 * math.hypot(first + share * (last - first), RADII["pinion"][0])
                    chamfer = 200 * max(0, diameter - chamfer_from)
                    profile.append(sign * (self.deviation(share, 8.75) + 20 - chamfer))
                head = f"Zahn-Nr.: {tooth} {flank} / {n}  Werte  z= 8.75"
                text += self.trace("Profil:", head, [None] * 3 + profile[3:])
        for flank in ("linke", "rechte"):
            rows = "".join(f"  {i}  0.1 {math.sin(i):.3f} 0.0\r\n" for i in range(1, 46))
            text += f"        {flank} Zahnflanke\r\n        Zahn-Nr.  fp  Fp  Fr\r\n\r\n{rows}"
        with open(self.path(name), "w", encoding="utf-8-sig", newline="") as file:
            file.write(text)
        return ("--traces", name, "--flanks", "f.csv", "--measured-pitch", name, "--pitch", "p.csv")

    def check(self, end=93.8):
        """The table against the flank that was written."""
        begin, tip = self.roll(85.7), self.roll(2 * RADII["pinion"][2])
        start = math.sqrt(RADII["pinion"][1] ** 2 - RADII["pinion"][0] ** 2)
        zero = None
        for row in rows_of(self.path("f.csv")):
            if (row["tooth"], row["flank"]) != ("0", "coast"):
                continue
            share = (start + float(row["t2"]) * (tip - start) - begin) / (self.roll(end) - begin)
            t1 = float(row["t1"])
            if 0.1 <= t1 <= 0.9 and 0.02 <= share <= 0.98:
                off = float(row["deviation_um"]) - self.deviation(share, 17.5 * t1)
                zero = off if zero is None else zero
                self.assertAlmostEqual(off, zero, delta=0.02)  # digits of the file, linear between 480 points
        self.assertIsNotNone(zero)

    def test_its_traces_and_pitch_become_flanks(self):
        told = self.accepted(*EXAMPLE[:7], *self.file("a b.mka"))
        self.assertIn("coast, profile: 3 traces of 3 teeth, 42 interpolated", told)
        self.assertIn("helix from t1 = 0.025 to 0.977 on all traces", told)
        self.check()
        pitch = [float(row["deviation_um"]) for row in rows_of(self.path("p.csv")) if row["flank"] == "drive"]
        cos = RADII["pinion"][0] / (0.5 * 45 * 1.65 / math.cos(math.radians(33)))
        mean = sum(math.sin(i) for i in range(1, 46)) / 45
        for i, value in enumerate(pitch):
            self.assertAlmostEqual(value, cos * (math.sin(i + 1) - mean), delta=1e-3)

    def test_the_sign_of_a_probe_is_noticed_and_taken_back(self):
        files = self.file("probe.mka", left_sign=-1)
        noticed = "all traces of left flanks standing out at their ends and none of the others"
        self.refused([noticed, "(see --probe-sign)"], *EXAMPLE[:7], *files)
        self.accepted(*EXAMPLE[:7], *files, "--probe-sign")
        self.check()
        self.refused("left flanks", *EXAMPLE[:7], *self.file("a.mka"), "--probe-sign")

    def test_a_chamfer_is_cut_off_at_the_tip_form_circle(self):
        files = self.file("chamfer.mka", end=94.1, chamfer_from=93.6)
        self.refused(["leaves the gear", "(see --tip-form-diameter)"], *EXAMPLE[:7], *files)  # the chamfer ends on a larger circle
        told = self.accepted(*EXAMPLE[:7], *files, "--tip-form-diameter", "93.6")
        self.assertIn("points left out: beyond the tip form circle", told)
        rows = [row for row in rows_of(self.path("f.csv")) if (row["tooth"], row["flank"]) == ("0", "drive")]
        self.assertGreater(min(float(row["deviation_um"]) for row in rows), -25)
        self.refused("base circle", *EXAMPLE[:7], *files, "--tip-form-diameter", "60")
        self.refused("tip form circle", *EXAMPLE[:7], *files, "--tip-form-diameter", "84.5")

    def test_another_gear_and_evaluated_values_are_refused(self):
        files = self.file("a.mka")
        self.refused("number of teeth: must be 41", PARAMS, "--gear", "wheel", *EXAMPLE[3:7], *files)
        with open(self.path("a.mew"), "w", encoding="utf-8") as file:
            file.write("HEADER KS.MW.FILE\n  7 :ME: 1\n10111 : fHb links 1 : 1.0\n")
        refusal = "a.mew:1: must be a file of measured curves"
        self.refused(refusal, *EXAMPLE[:7], "--traces", "a.mew", "--flanks", "f.csv")


class RoundTrip(Case):
    """Flanks of a class, as a machine prints them of all teeth, measure to the same values again."""

    def quality(self, gear, flanks, pitch):
        """Every value of every flank."""
        files = ("--flanks", flanks, "--pitch", pitch)
        text = self.accepted(PARAMS, "--gear", gear, "--evaluate", "--teeth", *files)
        rows = list(csv.reader(text.splitlines()[1:]))
        self.assertEqual(len(rows), 2 * TEETH[gear])
        return {(row[0], row[1]): [float(value) for value in row[2:]] for row in rows}

    # Derived in libgearmesh/docs/measured-flanks.md: (gear, face, counting): (left is drive, order kept).
    WAYS = (
        ("pinion", "I", "clockwise", False, True),
        ("pinion", "II", "clockwise", True, False),
        ("wheel", "I", "counterclockwise", False, True),
        ("wheel", "II", "counterclockwise", True, False),
    )

    def measured(self, gear, face, left_is_drive, order_kept):
        """Texts of a trace and a pitch file of the flanks in f.csv and p.csv, teeth counted from 0."""
        base, start, tip = RADII[gear]
        first, last = math.sqrt(start**2 - base**2), math.sqrt(tip**2 - base**2)
        teeth = TEETH[gear]

        def place(row):
            left = (row["flank"] == "drive") == left_is_drive
            number = int(row["tooth"]) if order_kept else -int(row["tooth"]) % teeth
            return f"{number},{'left' if left else 'right'}"

        profiles, helices, pitch = {}, {}, []
        for row in rows_of(self.path("f.csv")):
            t1, t2 = float(row["t1"]), float(row["t2"])
            face_mm = FACE_WIDTH_MM * (t1 if face == "I" else 1 - t1)
            at = f"{face_mm:.6f},{first + t2 * (last - first):.7f},{row['deviation_um']}"
            if t1 == 0.5:
                profiles.setdefault(place(row), []).append(f"{place(row)},profile,{at}\n")
            if t2 == 0.5:
                helices.setdefault(place(row), []).append(f"{place(row)},helix,{at}\n")
        for row in rows_of(self.path("p.csv")):
            ahead = float(row["deviation_um"]) / math.cos(ALPHA_T)
            ahead *= 1 if (row["flank"] == "drive") == (gear == "pinion") else -1
            pitch.append(f"{place(row)},{ahead if order_kept else -ahead:.6f}\n")
        traces = [line for group in (profiles, helices) for rows in group.values() for line in rows]
        return TRACE_HEADER + "".join(traces), PITCH_HEADER + "".join(pitch)

    def test_made_flanks_come_back_as_they_were(self):
        for gear, face, counting, left_is_drive, order_kept in self.WAYS:
            made = ("--flanks", "f.csv", "--pitch", "p.csv", "--nodes", "13x15")
            self.accepted(PARAMS, "--gear", gear, "--class", "6", "--seed", "5", *made)
            traces, pitch = self.measured(gear, face, left_is_drive, order_kept)
            self.accepted(
                *(PARAMS, "--gear", gear, "--datum-face", face, "--count", counting, "--first-number", "0"),
                *("--traces", self.write("t.csv", traces), "--flanks", "g.csv"),
                *("--measured-pitch", self.write("m.csv", pitch), "--pitch", "q.csv", "--nodes", "13x15"),
            )
            before, after = self.quality(gear, "f.csv", "p.csv"), self.quality(gear, "g.csv", "q.csv")
            for flank, expected in before.items():
                for value, got in zip(expected, after[flank]):
                    self.assertAlmostEqual(got, value, delta=1e-3, msg=(gear, face, flank))


class Refusals(Case):
    def setUp(self):
        super().setUp()
        self.write("f.csv", "old\n")
        with open(TRACES, encoding="ascii") as file:
            self.traces = file.read().splitlines(keepends=True)
        with open(PITCH, encoding="ascii") as file:
            self.pitch = file.read().splitlines(keepends=True)

    def tearDown(self):
        with open(self.path("f.csv"), encoding="ascii") as file:
            self.assertEqual(file.read(), "old\n")
        self.assertFalse(os.path.exists(self.path("p.csv")))
        self.assertEqual([name for name in os.listdir(self.folder) if ".part" in name or ".rows" in name], [])

    def bad_traces(self, line, said, *more):
        path = self.write("t.csv", "".join(self.traces))
        place = f"{path}:{line}: " if line else f"{path}: "
        self.refused([place, *said], *EXAMPLE, "--traces", path, *more)

    def bad_pitch(self, line, said):
        path = self.write("m.csv", "".join(self.pitch))
        place = f"{path}:{line}: " if line else f"{path}: "
        self.refused([place, *said], *EXAMPLE, "--measured-pitch", path)

    def change(self, rows, pattern, replacement):
        changed = [re.sub(pattern, replacement, row) for row in rows]
        self.assertNotEqual(changed, rows)
        return changed

    def each(self, column, function):
        """The rows of the traces with another value in a column."""
        out = []
        for row in self.traces:
            fields = row.rstrip("\n").split(",")
            if len(fields) == 6 and fields[0].isdecimal():
                fields[column] = f"{function(float(fields[column])):.6g}"
                row = ",".join(fields) + "\n"
            out.append(row)
        return out

    def test_units_and_signs_of_deviations(self):
        for factor, said in ((1e-3, "millimetres"), (1e3, "nanometres")):
            path = self.write("t.csv", "".join(self.each(5, lambda um, factor=factor: factor * um)))
            self.refused(["t.csv:", said], *EXAMPLE, "--traces", path)
        self.traces = self.each(5, lambda um: -um)
        self.bad_traces(0, ["16 of 16 traces that stand out", "material added: must be > 0", "(see --hollow)"])

    def test_lengths_in_other_units_are_refused(self):
        rows = self.traces
        self.traces = self.each(4, lambda mm: mm / 10)
        self.bad_traces(5, ["(base circle)", "centimetres"])
        self.traces = rows
        self.traces = self.each(4, lambda mm: mm / 2)
        self.bad_traces(5, ["a radius"])
        self.traces = rows
        self.traces = self.each(3, lambda mm: mm / 25.4)
        self.bad_traces(102, ["the helix trace of tooth 1, flank left", "inches"])
        self.traces = rows
        self.traces[100] = "1,left,profile,8.75,94.2,-14\n"
        self.bad_traces(101, ["leaves the gear", "must be at a roll length up to"])

    def test_spikes_teeth_and_text(self):
        rows = list(self.traces)
        self.traces[40] = re.sub(r"[^,]*\n$", "25\n", self.traces[40])
        self.bad_traces(41, ["the profile trace of tooth 1, flank left", "a spike", "(see --remove-spikes)"])
        self.traces = rows
        self.bad_traces(5, ["may be missing at either end", "(see --held)"], "--held", "0.01")
        self.traces = self.change(rows, "^1,", "0,")
        self.bad_traces(5, ["(got 0)", "(see --first-number)"])
        self.traces = rows + rows[4:101]
        self.bad_traces(len(rows) + 1, ["must be there once", "begins in line 5", "two teeth with the number 1"])
        self.traces = self.change(rows, "^34,", "46,")
        self.bad_traces(4 + 6 * 182 + 1, ["(got 46)", "must be from 1 to 45, as the gear has 45 teeth"])
        self.traces = self.change(rows, "_um", "")
        self.bad_traces(4, ["'deviation' has no unit", "deviation_um"])
        self.traces = self.change(rows, ",", ";")
        self.bad_traces(4, ["semicolons", "commas"])
        self.traces = self.change(rows, r"(\d)\.(\d\d\n)", r"\1,\2")
        self.bad_traces(5, ["(got 7", "decimal comma"])

    def test_pitch_with_missing_or_double_teeth_is_refused(self):
        rows = list(self.pitch)
        self.pitch = rows[:50] + rows[51:]
        self.bad_pitch(0, ["none for tooth 24", "each of the 45 teeth"])
        self.pitch = rows + ["3,left,1.0\n"]
        self.bad_pitch(len(rows) + 1, ["a second one", "the first is in line 8"])
        self.pitch = rows[:85]
        self.bad_pitch(0, ["42, 43, 44, 45", "the other gear"])
        self.pitch = self.change(rows, "cumulative", "single")
        self.bad_pitch(5, ["single pitch deviations of flank right: must add up to 0", " um)"])
        self.pitch = self.change(rows, r"_um\n", "_mm\n")
        self.bad_pitch(3, ["'cumulative_pitch_mm'", "cumulative_pitch_um"])
        self.pitch = self.change(rows, r"\.(\d)\n", r",\1\n")
        self.bad_pitch(4, ["(got 4", "decimal comma"])

    def test_options_that_are_missing_are_named(self):
        some = EXAMPLE[:3]
        files = ("--traces", TRACES, "--flanks", "f.csv")
        self.refused("--datum-face is missing", *some, *files, "--count", "clockwise")
        self.refused("--count is missing", *some, *files, "--datum-face", "I")
        self.refused("missing is --flanks", *EXAMPLE[:7], "--traces", TRACES)
        self.refused("missing is --traces", *EXAMPLE[:7], *EXAMPLE[11:], "--flanks", "f.csv")
        self.refused("missing is --pitch", *EXAMPLE[:7], *EXAMPLE[7:11], "--measured-pitch", PITCH)
        self.refused("missing is --measured-pitch", *EXAMPLE[:7], *EXAMPLE[7:11], "--pitch", "p.csv")
        self.refused("same file: f.csv", *EXAMPLE, "--pitch", "f.csv")
        self.refused("an input would be overwritten", *EXAMPLE, "--pitch", TRACES)
        os.symlink(TRACES, self.path("link.csv"))
        self.refused("an input would be overwritten", *EXAMPLE, "--pitch", "link.csv")
        self.refused("same file: f.csv", *EXAMPLE, "--pitch", "./f.csv")
        self.refused("not together with --traces or --measured-pitch: --class", *EXAMPLE, "--class", "5")
        self.refused("not together with --evaluate: --remove-spikes", *some, "--evaluate", "--remove-spikes")
        self.refused(
            "only together with --traces or --measured-pitch: --hollow", *some, "--class", "5", "--flanks", "f.csv",
            "--pitch", "p.csv", "--hollow",
        )

    def test_values_out_of_range_are_refused(self):
        for option, value, right in (
            ("--datum-face", "1", "I or II"),
            ("--count", "left", "clockwise or counterclockwise"),
            ("--first-number", "2", "0 or 1"),
            ("--first-tooth", "-1", "0 or more"),
            ("--first-tooth", "45", "from 0 to 44 (got 45) (see --first-tooth)"),
            ("--pitch-diameter", "x", "in mm"),
            ("--pitch-diameter", "80", "(tip) in diameter (got 80 mm) (see --pitch-diameter)"),
            ("--held", "0.5", "0 to 0.45"),
            ("--nodes", "1x9", "2 to 1000"),
        ):
            self.refused(right, *EXAMPLE, option, value)

    def test_no_file(self):
        self.refused("no.csv: cannot be opened", *EXAMPLE, "--traces", "no.csv")
        self.refused("no.csv: cannot be opened", *EXAMPLE, "--measured-pitch", "no.csv")
        self.refused("no/f.csv.part cannot be written: No such file", *EXAMPLE, "--flanks", "no/f.csv")

    def test_no_regular_file_is_replaced(self):
        os.mkfifo(self.path("pipe"))
        os.mkdir(self.path("folder"))
        self.refused("pipe is not a regular file; name a file", *EXAMPLE, "--flanks", "pipe")
        self.refused("folder is a folder; name a file", *EXAMPLE, "--pitch", "folder")
        self.assertTrue(stat.S_ISFIFO(os.stat(self.path("pipe")).st_mode))


class Together(Case):
    def test_flanks_and_pitch_are_both_replaced_or_none(self):
        for name in ("f.csv", "p.csv"):
            self.write(name, "old\n")
        os.mkdir(self.path("p.csv.part"))
        self.refused("p.csv.part is a folder", *EXAMPLE)
        for name in ("f.csv", "p.csv"):
            with open(self.path(name), encoding="ascii") as file:
                self.assertEqual(file.read(), "old\n")
        self.assertEqual(sorted(os.listdir(self.folder)), ["f.csv", "p.csv", "p.csv.part"])

    def test_an_input_is_not_taken_for_a_file_on_the_way(self):
        shutil.copy(TRACES, self.path("f.csv.part"))
        self.refused("an input would be overwritten", *EXAMPLE, "--traces", "f.csv.part")
        self.assertTrue(os.path.exists(self.path("f.csv.part")))

    def test_one_tooth_stands_for_all(self):
        with open(TRACES, encoding="ascii") as file:
            rows = [row for row in file if not row[0].isdigit() or row.startswith("1,")]
        told = self.accepted(*EXAMPLE, "--traces", self.write("t.csv", "".join(rows)))
        self.assertIn("drive, profile: 1 trace of 1 tooth, which stands for all", told)


class Allowances(Case):
    def test_ends_that_were_filled_in_are_told_by_tooth_and_place(self):
        with open(TRACES, encoding="utf-8") as file:
            lines = file.readlines()
        helix = [i for i, line in enumerate(lines) if line.startswith("12,left,helix")]
        self.assertGreater(len(helix), 40)
        for level, filled in (("-60", "0"), ("0", "-99.9")):
            text = list(lines)
            for i in helix:
                fields = lines[i].strip().split(",")
                fields[-1] = f"{float(fields[-1]) + float(level):.3f}"
                text[i] = ",".join(fields) + "\n"
            for i in helix[:5]:
                text[i] = lines[i].rpartition(",")[0] + f",{filled}\n"
            path = self.write("traces.csv", "".join(text))
            self.refused(
                [f"traces.csv:{helix[0] + 1}: the helix trace of tooth 12, flank left", f"exactly {filled} um at all 5"],
                *EXAMPLE, "--traces", path,
            )
            self.assertIn("# 5 points left out: filled in", self.accepted(*EXAMPLE, "--traces", path, "--remove-spikes"))

    def test_a_trace_that_never_varies_is_asked_about(self):
        with open(TRACES, encoding="utf-8") as file:
            lines = file.readlines()
        text = [
            line.rpartition(",")[0] + ",0\n" if line.startswith("23,right,profile") else line for line in lines
        ]
        path = self.write("traces.csv", "".join(text))
        asked = "the profile trace of tooth 23, flank right, has one value all along and others vary: was it measured?"
        self.assertNotIn("was it measured?", self.accepted(*EXAMPLE))
        self.assertIn(asked, self.accepted(*EXAMPLE, "--traces", path))

    def test_spikes_can_be_left_out_and_hollow_flanks_be_meant(self):
        with open(TRACES, encoding="ascii") as file:
            rows = file.read().splitlines(keepends=True)
        rows[40] = re.sub(r"[^,]*\n$", "25\n", rows[40])
        path = self.write("t.csv", "".join(rows))
        self.assertIn("1 point left out", self.accepted(*EXAMPLE, "--traces", path, "--remove-spikes"))
        hollow = [re.sub(r",(-?)(\d+\.\d\d)$", lambda m: f",{'' if m[1] else '-'}{m[2]}", row) for row in rows]
        hollow[40] = hollow[39]
        del hollow[40]
        path = self.write("t.csv", "".join(hollow))
        self.assertIn("16 of 16 traces stand out", self.accepted(*EXAMPLE, "--traces", path, "--hollow"))

    def test_single_pitches_that_close_leave_nothing_to_spread(self):
        places = {"left": [], "right": []}
        for row in rows_of(PITCH):
            places[row["flank"]].append(float(row["cumulative_pitch_um"]))
        rows = [
            f"{i + 1},{flank},{at[i] - at[i - 1]:.1f}\n" for flank, at in places.items() for i in range(len(at))
        ]
        path = self.write("m.csv", "tooth,flank,single_pitch_um\n" + "".join(rows))
        self.assertNotIn("spread", self.accepted(*EXAMPLE, "--measured-pitch", path))

    def test_help_names_all_options(self):
        text = self.accepted("--help")
        for option in (
            *("--traces", "--measured-pitch", "--datum-face", "--count", "--first-number", "--first-tooth"),
            *("--pitch-diameter", "--transverse", "--held", "--hollow", "--remove-spikes"),
        ):
            self.assertIn("  " + option, text)


if __name__ == "__main__":
    main()
