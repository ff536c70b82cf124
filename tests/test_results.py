#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
What becomes of results: two runs with one output, links, signals, closed descriptors, limits on file sizes.

    test_results.py GEARSIM GEARFLANKS [-v] [name of a test]...
"""
import fcntl
import os
import re
import signal
import stat
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True

import uncounted  # noqa: E402

try:
    import h5py
except ImportError:
    h5py = None

GEARSIM = os.environ.get("GEARSIM", "gearsim")
GEARFLANKS = os.environ.get("GEARFLANKS", "gearflanks")
OLD = "an older result\n"

PARAMS = """\
[gears]
pinion_teeth = 45
wheel_teeth = 41
normal_module_mm = 1.65
normal_pressure_angle_deg = 16
helix_angle_deg = 33
center_distance_mm = 85
face_width_mm = 17.5
backlash_um = 100
[mesh]
stiffness_N_per_m = 1.05e8
damping_Ns_per_m = 844
[bodies]
wheel_inertia_kg_m2 = 2.1e-3
[drive]
start_rpm = 1000
end_rpm = 1000
[load]
mean_Nm = 20
noise_amplitude_Nm = 5
[analysis]
duration_s = 0.02
"""
ENDLESS = ("--set", "analysis.duration_s=30000")
ENDINGS = (".csv", ".h5")
# What asks a process to end, or ends one that does not watch it.
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGXCPU, signal.SIGUSR1, signal.SIGUSR2,
           signal.SIGALRM)


def restore_signals():
    """In the child: a shell starts background jobs with SIGINT ignored, and the programs would leave it so."""
    uncounted.uncounted()
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)


class Case(unittest.TestCase):
    """A folder of its own for every test."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        self.write("run.ini", PARAMS)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def assert_old(self, name):
        self.assertEqual(self.read(name), OLD.encode())

    def names(self):
        return sorted(os.listdir(self.folder))

    def call(self, command, **others):
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False, timeout=120,
                              **others)

    def start(self, command):
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True, preexec_fn=restore_signals)

        def end():
            process.kill()
            process.communicate()

        self.addCleanup(end)
        return process

    def sim(self, output, *others):
        return [GEARSIM, "run.ini", "--quiet", "--output", output, *others]

    def flanks(self, flanks="f.csv", pitch="p.csv", seed=1, quality_class=5):
        return [GEARFLANKS, "run.ini", "--gear", "pinion", "--class", str(quality_class), "--seed", str(seed),
                "--flanks", flanks, "--pitch", pitch]

    def wait_for(self, path, size=1):
        deadline = time.monotonic() + 60
        while not (os.path.exists(path) and os.path.getsize(path) >= size):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.005)

    def refused(self, command, *said):
        result = self.call(command)
        self.assertEqual(result.returncode, 2, result.stderr)
        for text in said:
            self.assertIn(text, result.stderr)
        return result

    def accepted(self, command, **others):
        result = self.call(command, **others)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result


def without_name(result):
    """A result without its own name, which stands in its head."""
    return re.sub(rb"# output\.file = .*\n", b"", result)


class TwoRuns(Case):
    def test_a_second_run_is_refused_by_name_and_the_first_is_whole(self):
        for ending in ENDINGS:
            name, part = "out" + ending, "out" + ending + ".part"
            self.write(name, OLD)
            first = self.start(self.sim(name, *ENDLESS))
            self.wait_for(self.path(part), 200000)
            self.refused(self.sim(name), f"--output: output.file: '{part}' is being written by another run")
            os.mkdir(self.path("sub" + ending))
            self.refused(self.sim(f"sub{ending}/../{name}"), "is being written by another run")
            # A link leads to the same file, also if that is not there yet.
            os.symlink(name, self.path("link" + ending))
            self.refused(self.sim("link" + ending), "is being written by another run")
            os.remove(self.path(name))
            self.refused(self.sim("link" + ending), "is being written by another run")
            first.send_signal(signal.SIGTERM)
            self.assertEqual(first.wait(timeout=60), 130)
            # The rows of the first run, as it has marked them; a run that has ended blocks nobody.
            self.assertIn(b"incomplete", self.read(part))
            self.accepted(self.sim(name))
            self.assertFalse(os.path.exists(self.path(part)))

    def test_runs_at_once_give_the_result_of_one_of_them(self):
        alone = {}
        for seed in range(6):
            self.accepted(self.sim("alone.csv", "--set", f"load.seed={seed}"))
            alone[seed] = without_name(self.read("alone.csv"))
        for ending in ENDINGS:
            name = "out" + ending
            runs = [self.start(self.sim(name, "--set", f"load.seed={seed}")) for seed in range(6)]
            codes = [run.wait(timeout=60) for run in runs]
            self.assertLessEqual(set(codes), {0, 2})
            self.assertFalse(os.path.exists(self.path(name + ".part")))
            if ending == ".csv":
                result = self.read(name)
                seed = int(re.search(rb"# load.seed = (\d+)", result)[1])
                self.assertEqual(without_name(result), alone[seed])
            elif h5py is not None:
                with h5py.File(self.path(name), "r") as file:
                    seed = int(file.attrs["load.seed"])
                    table = [line for line in alone[seed].decode().splitlines() if not line.startswith("#")]
                    for column, value in zip(table[0].split(","), table[-1].split(",")):
                        self.assertEqual(len(file[column]), len(table) - 1)
                        self.assertAlmostEqual(file[column][-1], float(value), delta=1e-9 * abs(float(value)))
            else:
                continue
            self.assertEqual(codes[seed], 0)

    def test_flank_and_pitch_file_are_of_one_run(self):
        runs = [self.start(self.flanks(seed=seed)) for seed in range(8)]
        codes = [run.wait(timeout=60) for run in runs]
        self.assertLessEqual(set(codes), {0, 2})
        self.assertIn(0, codes)
        seeds = [re.search(rb"# seed (\d+)", self.read(name))[1] for name in ("f.csv", "p.csv")]
        self.assertEqual(seeds[0], seeds[1])
        self.assertEqual(codes[int(seeds[0])], 0)
        self.assertEqual(self.names(), ["f.csv", "p.csv", "run.ini"])

    def test_flanks_of_two_runs_are_refused_by_name(self):
        for locked in ("f.csv.part", "p.csv.part"):
            for name in ("f.csv", "p.csv"):
                self.write(name, OLD)
            with open(self.path(locked), "w", encoding="ascii") as part:
                fcntl.flock(part, fcntl.LOCK_EX)  # as a run that writes does
                self.refused(self.flanks(), f"{locked} is being written by another run")
                self.assert_old("f.csv")
                self.assert_old("p.csv")
                self.assertEqual(self.names(), sorted(["f.csv", "p.csv", locked, "run.ini"]))
            # Nobody has the lock any more.
            self.accepted(self.flanks())
            self.assertEqual(self.names(), ["f.csv", "p.csv", "run.ini"])

    def test_a_growing_file_that_was_taken_away_is_no_result(self):
        for ending in ENDINGS:
            name, part = "out" + ending, "out" + ending + ".part"
            self.write(name, OLD)
            run = self.start(self.sim(name, "--set", "analysis.duration_s=5"))
            self.wait_for(self.path(part), 500000)  # rows are written
            os.remove(self.path(part))
            self.write(part, "of somebody else\n")
            errors = run.communicate(timeout=60)[1]
            self.assertEqual(run.returncode, 1, errors)
            self.assertIn(f"{part}: was removed or replaced by another program", errors)
            self.assert_old(name)
            self.assertEqual(self.read(part), b"of somebody else\n")

    def test_no_result_has_the_name_of_a_growing_one(self):
        self.refused(self.sim("out.csv.part"), "out.csv.part' must not end in .part")
        self.refused(self.flanks(pitch="f.csv.part"), "f.csv.part must not end in .part")
        self.assertEqual(self.names(), ["run.ini"])

    def test_two_names_of_one_file(self):
        """By another spelling of the folder, by links, be there a file or not."""
        os.mkdir(self.path("sub"))
        os.symlink("f.csv", self.path("link.csv"))
        os.symlink(".", self.path("here"))
        for there in (False, True):
            for pitch in ("./f.csv", "sub/../f.csv", self.path("f.csv"), "link.csv", "here/f.csv", "here/link.csv"):
                if there:
                    self.write("f.csv", OLD)
                self.refused(self.flanks(pitch=pitch), "--flanks and --pitch are the same file")
                self.assertEqual(os.path.exists(self.path("f.csv")), there)


class Links(Case):
    def test_a_link_in_place_of_the_growing_file_is_not_followed(self):
        self.write("foreign", OLD)
        for command, parts in ((self.sim("out.csv"), ["out.csv.part"]), (self.sim("out.h5"), ["out.h5.part"]),
                               (self.flanks(), ["f.csv.part", "p.csv.part"])):
            for part in parts:
                for target in ("foreign", "not there"):
                    os.symlink(target, self.path(part))
                    self.refused(command, part, "is a symbolic link; remove it")
                    os.remove(self.path(part))
                    self.assert_old("foreign")
                    self.assertEqual(self.names(), ["foreign", "run.ini"])
                # A hard link is a name that goes; the other one keeps its content.
                os.link(self.path("foreign"), self.path(part))
                self.accepted(command)
                self.assert_old("foreign")
                for name in ("out.csv", "out.h5", "f.csv", "p.csv"):
                    if os.path.exists(self.path(name)):
                        os.remove(self.path(name))
                self.assertEqual(self.names(), ["foreign", "run.ini"])

    def test_a_link_in_place_of_the_result_stays_and_its_target_is_replaced(self):
        os.mkdir(self.path("sub"))
        self.accepted(self.sim("whole.csv"))
        self.accepted(self.flanks("whole_f.csv", "whole_p.csv"))
        for command, name, whole in ((self.sim("out.csv"), "out.csv", "whole.csv"),
                                     (self.flanks("out.csv", "p.csv"), "out.csv", "whole_f.csv"),
                                     (self.flanks("f.csv", "out.csv"), "out.csv", "whole_p.csv")):
            for there in (True, False):
                os.symlink("../target", self.path("sub/second"))
                os.symlink("sub/second", self.path(name))
                if there:
                    self.write("target", OLD)
                self.accepted(command)
                self.assertTrue(os.path.islink(self.path(name)) and os.path.islink(self.path("sub/second")))
                self.assertFalse(os.path.islink(self.path("target")))
                self.assertEqual(without_name(self.read("target")), without_name(self.read(whole)))
                for used in (name, "sub/second", "target"):
                    os.remove(self.path(used))
            self.assertEqual([left for left in self.names() if "part" in left], [])

    def test_links_in_a_circle_are_refused(self):
        os.symlink("out.csv", self.path("out.csv"))
        self.refused(self.sim("out.csv"), "out.csv", "symbolic links")
        self.refused(self.flanks("out.csv"), "out.csv", "symbolic links")

    def test_an_input_behind_a_link_is_not_replaced(self):
        """Not by the growing file either, whose name is that of the link's target."""
        flanks = "tooth,flank,t1,t2,deviation_um\n*,*,0,0,1\n*,*,0,1,1\n*,*,1,0,1\n*,*,1,1,1\n"
        os.symlink("real.csv", self.path("out.csv"))
        for name in ("real.csv.part", "real.csv"):
            self.write(name, flanks)
            result = self.call(self.sim("out.csv", "--set", f"flanks.pinion={name}"))
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("must not overwrite an input", result.stderr)
            self.assertEqual(self.read(name).decode(), flanks)


class Descriptors(Case):
    def closed(self, command, *descriptors):
        def close():
            uncounted.uncounted()
            for descriptor in descriptors:
                os.close(descriptor)

        return subprocess.run(command, cwd=self.folder, check=False, timeout=60, preexec_fn=close,
                              stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL).returncode

    def test_no_message_lands_in_a_result(self):
        """Whatever the caller has closed, the result is that of a run with all open."""
        loud = [word for word in self.sim("out.csv") if word != "--quiet"]
        self.accepted(loud)
        self.accepted(self.flanks())
        whole = {name: self.read(name) for name in ("out.csv", "f.csv", "p.csv")}
        for closed in ((2,), (0, 2), (1, 2), (0, 1, 2), (0,), (1,), (0, 1)):
            code = self.closed(loud, *closed)
            self.assertEqual(code, 0, closed)
            # gearflanks prints a report, which nobody gets from a closed descriptor.
            code = self.closed(self.flanks(), *closed)
            self.assertEqual(code, 1 if 1 in closed else 0, closed)
            for name, data in whole.items():
                self.assertEqual(self.read(name), data, f"{name} with {closed} closed")

    def test_no_message_lands_in_a_result_that_fails(self):
        loud = [word for word in self.sim("out.csv") if word != "--quiet"]
        code = self.closed([*loud, "--set", "load.noise_amplitude_Nm=1e6", "--set", "analysis.duration_s=1"], 0, 1, 2)
        self.assertEqual(code, 1)
        rows = [line for line in self.read("out.csv.part").decode().splitlines() if not line.startswith("#")]
        self.assertTrue(rows[0].startswith("time_s,"))
        for row in rows[1:]:
            self.assertEqual(len([float(field) for field in row.split(",")]), rows[0].count(",") + 1)

    def test_text_for_a_closed_descriptor_is_not_done(self):
        for command in ([GEARSIM, "run.ini", "--geometry"], [GEARSIM, "--help"], [GEARFLANKS, "--version"]):
            self.assertEqual(self.closed(command, 1), 1)
            self.assertEqual(self.closed(command, 0, 1, 2), 1)

    def test_a_reader_that_goes_away_ends_no_run(self):
        """Messages and report meet a pipe that nobody reads."""
        for command, code in (([w for w in self.sim("out.csv") if w != "--quiet"], 0), (self.flanks(), 1)):
            reading, writing = os.pipe()
            os.close(reading)
            result = subprocess.run(command, cwd=self.folder, stdout=writing, stderr=writing, check=False, timeout=60,
                                    restore_signals=True)
            os.close(writing)
            self.assertEqual(result.returncode, code)
        self.assertEqual(self.names(), ["f.csv", "out.csv", "p.csv", "run.ini"])


class Signals(Case):
    def test_every_signal_that_ends_a_run_marks_it(self):
        for ending in ENDINGS:
            part = self.path("out" + ending + ".part")
            for number in SIGNALS:
                self.write("out" + ending, OLD)
                run = self.start(self.sim("out" + ending, *ENDLESS))
                self.wait_for(part, 100000)
                run.send_signal(number)
                errors = run.communicate(timeout=60)[1]
                self.assertEqual(run.returncode, 130, f"{number}: {errors}")
                self.assertIn("interrupted at t = ", errors)
                self.assertIn(b"interrupted at t = ", self.read("out" + ending + ".part"))
                self.assert_old("out" + ending)
                os.remove(part)

    def test_gearflanks_leaves_all_or_nothing(self):
        """Whenever the signal comes: both files or none, and nothing beside them."""
        command = [*self.flanks(), "--nodes", "30x30"]
        begin = time.monotonic()
        self.accepted(command)
        duration = time.monotonic() - begin
        whole = {name: self.read(name) for name in ("f.csv", "p.csv")}
        codes = set()
        for step in range(14):
            for name in whole:
                self.write(name, OLD)
            run = self.start(command)
            time.sleep(duration * step / 12)
            run.send_signal(SIGNALS[step % len(SIGNALS)])
            errors = run.communicate(timeout=60)[1]
            codes.add(run.returncode)
            files = {name: self.read(name) for name in whole}
            if files != whole:
                self.assertEqual(set(files.values()), {OLD.encode()}, f"{run.returncode} {errors}")
                self.assertNotEqual(run.returncode, 0)
            self.assertEqual(self.names(), ["f.csv", "p.csv", "run.ini"], f"step {step}: {run.returncode} {errors}")


class Limits(Case):
    def limited(self, command, size):
        return self.call(command, preexec_fn=uncounted.limit_files(size))

    def test_a_limit_on_file_sizes_is_a_message(self):
        self.accepted(self.flanks("wf.csv", "wp.csv"))
        sizes = [os.path.getsize(self.path(name)) for name in ("wf.csv", "wp.csv")]
        self.assertGreater(sizes[0], sizes[1])
        for name in ("f.csv", "p.csv"):
            self.write(name, OLD)
        for size in (0, 100, sizes[1] - 1, sizes[0] - 1):
            result = self.limited(self.flanks(), size)
            self.assertEqual(result.returncode, 1, f"{size}: {result.stderr}")
            self.assertIn(".part: cannot be written: File too large", result.stderr)
            self.assert_old("f.csv")
            self.assert_old("p.csv")
            self.assertEqual(self.names(), ["f.csv", "p.csv", "run.ini", "wf.csv", "wp.csv"])
        self.assertEqual(self.limited(self.flanks(), sizes[0]).returncode, 0)

    def test_a_limit_on_file_sizes_is_a_message_of_gearsim(self):
        for ending in ENDINGS:
            self.write("out" + ending, OLD)
            for size in (0, 200, 50000):
                result = self.limited(self.sim("out" + ending), size)
                self.assertEqual(result.returncode, 1, f"{size}: {result.stderr}")
                self.assertIn(f"out{ending}.part: File too large", result.stderr)
                self.assert_old("out" + ending)

    def test_result_and_load_distribution_are_of_one_run(self):
        """Both or none is replaced, also where one of them just fits."""
        static = ("--set", "analysis.type=static", "--set", "analysis.positions=1", "--set", "mesh.law=elastic",
                  "--set", "mesh.stiffness_N_per_m=", "--set", "output.load_distribution=load.csv")
        self.accepted(self.sim("out.csv", *static))
        sizes = sorted(os.path.getsize(self.path(name)) for name in ("out.csv", "load.csv"))
        self.assertGreater(sizes[1], sizes[0])
        for size in (0, sizes[0] - 1, sizes[0], sizes[1] - 1):
            for name in ("out.csv", "load.csv"):
                self.write(name, OLD)
            result = self.limited(self.sim("out.csv", *static), size)
            self.assertEqual(result.returncode, 1, f"{size}: {result.stderr}")
            self.assertIn(".csv.part: File too large", result.stderr)
            self.assert_old("out.csv")
            self.assert_old("load.csv")
            if size >= sizes[0]:  # there is room for the head
                with open(self.path("load.csv.part"), encoding="ascii") as file:
                    lines = file.read().splitlines(keepends=True)
                self.assertTrue(lines[-1].startswith("# incomplete: ") and lines[-1].endswith("\n"), lines[-1])
                self.assertEqual({line.count(",") for line in lines if not line.startswith("#")}, {9})
        self.assertEqual(self.limited(self.sim("out.csv", *static), sizes[1]).returncode, 0)
        self.assertEqual(sorted(os.path.getsize(self.path(name)) for name in ("out.csv", "load.csv")), sizes)


class Places(Case):
    def test_places_that_take_no_file_are_refused(self):
        os.mkdir(self.path("folder"))
        os.mkfifo(self.path("pipe"))
        os.mkdir(self.path("x.csv.part"))
        os.mkfifo(self.path("y.csv.part"))
        for name, said in (("folder", "is a folder"), ("pipe", "is not a regular file"), ("/dev/null", "regular file"),
                           ("/dev/stdout", "is not a regular file; name a file"),
                           ("no/such/out.csv", "No such file"), ("run.ini/out.csv", "cannot be written"),
                           ("x.csv", "is a folder"), ("y.csv", "is not a regular file")):
            self.refused(self.sim(name), "output.file", said)
            self.refused(self.flanks(pitch=name), said)
        self.assertTrue(stat.S_ISFIFO(os.stat(self.path("pipe")).st_mode))
        self.assertTrue(stat.S_ISFIFO(os.stat(self.path("y.csv.part")).st_mode))
        self.assertEqual(self.names(), ["folder", "pipe", "run.ini", "x.csv.part", "y.csv.part"])


if __name__ == "__main__":
    if len(sys.argv) > 2 and not sys.argv[1].startswith("-"):
        GEARSIM = os.path.abspath(sys.argv.pop(1))
        GEARFLANKS = os.path.abspath(sys.argv.pop(1))
    unittest.main()
