#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Every allocation, every system call of the programs fails in turn, and signals come at every system call. Whatever it is:
no crash; exit status 0 only with the whole result, else 1 or 2 (130 after a signal) and a message; under the final name
the result of before or the whole new one, of two files that belong together both or none.

    test_faults.py GEARSIM GEARFLANKS INJECT FAILING_HEAP [--all] [-v] [name of a test]...

INJECT and FAILING_HEAP are built from tests/faults. Without --all a sample of the calls is taken.
"""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

PROGRAMS = {}
ALL = False
OLD = b"an older result\n"
SKIP = 77

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data")
# errno of a broken disk, a full one, a signal that interrupts, too many open files.
EIO, ENOSPC, EINTR, EMFILE = 5, 28, 4, 24

RUN = ["gearsim", "params.ini", "--quiet", "--set", "analysis.duration_s=0.005", "--output"]
FLANKS = ["gearflanks", "params.ini", "--gear", "pinion", "--class", "5", "--nodes", "9x9"]
MEASURED = ["gearflanks", "params.ini", "--gear", "pinion", "--datum-face", "I", "--count", "clockwise",
            "--traces", "traces.csv", "--measured-pitch", "measured_pitch.csv"]
PAIR = ["--flanks", "f.csv", "--pitch", "p.csv"]
# A case is a folder of inputs, a command, and the files that it writes.
CASES = {
    "csv": ("example", [*RUN, "out.csv"], ["out.csv"]),
    "hdf5": ("example", [*RUN, "out.h5"], ["out.h5"]),
    "static": ("relief", ["gearsim", "params.ini", "--set", "analysis.type=static", "--set", "analysis.positions=9",
                          "--output", "out.csv"], ["out.csv"]),
    "geometry": ("example", ["gearsim", "params.ini", "--geometry"], []),
    "flanks": ("example", [*FLANKS, *PAIR], ["f.csv", "p.csv"]),
    "measured": ("measured", [*MEASURED, *PAIR], ["f.csv", "p.csv"]),
    "evaluate": ("example", ["gearflanks", "params.ini", "--gear", "pinion", "--evaluate", "--teeth"], []),
}


def is_whole(data, whole):
    """HDF5 holds the times at which its objects were made, of 4 bytes each."""
    if whole.startswith(b"\x89HDF"):
        return len(data) == len(whole) and sum(a != b for a, b in zip(data, whole)) < 64
    return data == whole


class Run:
    """How a run with a fault has ended."""

    def __init__(self, code, output, errors):
        self.code, self.output, self.errors = code, output, errors  # code < 0: the signal that killed it


class Case(unittest.TestCase):
    def prepare(self, name):
        inputs, self.command, self.outputs = CASES[name]
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        for file in os.listdir(os.path.join(DATA, inputs)):
            shutil.copy(os.path.join(DATA, inputs, file), self.folder)
        self.given = set(os.listdir(self.folder))
        self.command = [PROGRAMS[self.command[0]], *self.command[1:]]
        plain = self.call(self.command)
        self.assertEqual(plain.returncode, 0, plain.stderr)
        self.text = plain.stdout
        self.whole = [self.read(output) for output in self.outputs]

    def call(self, command, **environment):
        return subprocess.run(command, cwd=self.folder, capture_output=True, check=False, timeout=120,
                              env={**os.environ, **environment})

    def path(self, name):
        return os.path.join(self.folder, name)

    def read(self, name):
        try:
            with open(self.path(name), "rb") as file:
                return file.read()
        except FileNotFoundError:
            return None

    def reset(self, with_old):
        """The folder before a run."""
        for name in set(os.listdir(self.folder)) - self.given:
            os.remove(self.path(name))
        for output in self.outputs if with_old else ():
            with open(self.path(output), "wb") as file:
                file.write(OLD)

    def inject(self, what, at, with_old=True):
        self.reset(with_old)
        result = self.call([PROGRAMS["inject"], "report", what, str(at), *self.command])
        if result.returncode == SKIP:
            self.skipTest("programs cannot be traced here")
        self.assertEqual(result.returncode, 0, result.stderr)
        *self.calls, end = self.read("report").decode().splitlines()
        os.remove(self.path("report"))
        how, number = end.split()
        return Run(int(number) if how == "exited" else -int(number), result.stdout, result.stderr.decode())

    def fail_allocation(self, at, forever):
        self.reset(True)
        others = {**self.SPARE, **({"FAIL_FOREVER": "1"} if forever else {})}
        result = self.call(self.command, LD_PRELOAD=PROGRAMS["heap"], FAIL_ALLOCATION=str(at), **others)
        return Run(result.returncode, result.stdout, result.stderr.decode())

    def check(self, run, what, old=OLD, codes=(1, 2), both=True):
        """The promise; `what` describes the fault."""
        what = f"{what}: exit {run.code}, {run.errors!r}"
        found = [self.read(output) for output in self.outputs]
        whole = [data is not None and is_whole(data, right) for data, right in zip(found, self.whole)]
        if run.code == 0:
            self.assertTrue(all(whole), what)
            self.assertEqual(run.output, self.text, what)
        else:
            self.assertIn(run.code, codes, what)
            self.assertTrue(run.errors.strip() or run.code < 0, what)
        for data, is_new in zip(found, whole):
            self.assertTrue(is_new or data == old, what)
        if both:
            self.assertIn(len(set(whole)), (0, 1), what)
        return all(whole)

    def assert_nothing_beside(self, what, allowed=()):
        """Beside inputs and results."""
        self.assertEqual(set(os.listdir(self.folder)) - self.given - set(self.outputs) - set(allowed), set(), what)

    def sample(self, count, most):
        """Numbers from 1 on; a stride that shares no factor with the period of calls in a loop."""
        if ALL or count <= most:
            return range(1, count + 1)
        return sorted({1 + (i * count) // most for i in range(most)})


class SystemCalls(Case):
    def each_call_fails(self, name, most):
        self.prepare(name)
        self.inject("count", 0)
        calls = list(self.calls)
        self.assertGreater(len(calls), 10)
        failed = 0
        for error in (EIO, ENOSPC, EMFILE) if ALL else (EIO,):
            for with_old in (True, False) if ALL else (True,):
                for at in self.sample(len(calls) - 1, most):
                    run = self.inject(f"error={error}", at, with_old)
                    call = "".join(self.calls[at - 1 : at])  # none if the run is shorter without an old FILE
                    what = f"{name}: call {at}, {call}, fails with {error}"
                    self.check(run, what, OLD if with_old else None)
                    failed += run.code != 0
                    if name in ("flanks", "measured") and call != "unlink":
                        self.assert_nothing_beside(what)
        self.assertGreater(failed, 0)

    def test_csv(self):
        self.each_call_fails("csv", 24)

    def test_hdf5(self):
        self.each_call_fails("hdf5", 16)

    def test_static(self):
        self.each_call_fails("static", 10)

    def test_geometry(self):
        self.each_call_fails("geometry", 10)

    def test_flanks(self):
        self.each_call_fails("flanks", 40)

    def test_measured(self):
        self.each_call_fails("measured", 12)

    def test_evaluate(self):
        self.each_call_fails("evaluate", 10)

    def test_calls_that_make_a_result(self):
        """Each of these by its name, in every case: what they fail with is said, and no file has changed."""
        for name in ("csv", "hdf5", "flanks"):
            self.prepare(name)
            self.inject("count", 0)
            calls = list(self.calls)
            for call, number, said in (("flock", EIO, None), ("write", ENOSPC, "No space left"),
                                       ("pwrite", ENOSPC, "No space left"), ("fsync", EIO, "Input/output error"),
                                       ("rename", EIO, "Input/output error"), ("ftruncate", EIO, "Input/output error"),
                                       ("fallocate", ENOSPC, "No space left"), ("link", EMFILE, None)):
                places = [i + 1 for i, done in enumerate(calls) if done == call]
                for at in places if ALL else sorted({*places[:1], *places[-2:]}):
                    for with_old in (True, False):
                        run = self.inject(f"error={number}", at, with_old)
                        what = f"{name}: {call} {at} fails with {number}"
                        is_new = self.check(run, what, OLD if with_old else None)
                        if self.calls[at - 1 : at] != [call]:
                            continue  # another one at this place, as FILE is not there
                        # Without locks, and without hard links, there is another way.
                        if call not in ("flock", "link"):
                            self.assertEqual(run.code, 1, what)
                            self.assertIn(said, run.errors, what)
                        if call in ("write", "pwrite", "rename", "fallocate"):
                            # The report of gearflanks comes when the files are there.
                            self.assertTrue(not is_new or "standard output" in run.errors, what)

    def test_the_last_close_tells_of_a_write_that_failed(self):
        for name in ("csv", "hdf5", "flanks"):
            self.prepare(name)
            self.inject("count", 0)
            at = self.calls.index("fsync") + 2
            run = self.inject(f"error={EIO}", at)
            self.assertEqual(self.calls[at - 1], "close")
            what = f"{name}: close {at} fails"
            self.assertFalse(self.check(run, what), what)
            self.assertEqual(run.code, 1, what)
            self.assertIn("Input/output error", run.errors, what)

    def test_writes_in_small_pieces_and_interrupted_ones(self):
        """A write may take less than it was given, or be interrupted by a signal that is handled."""
        for name in ("csv", "hdf5", "flanks"):
            self.prepare(name)
            self.inject("count", 0)
            places = [i + 1 for i, done in enumerate(self.calls) if done in ("write", "pwrite")]
            self.assertGreater(len(places), 1)
            for at in places if ALL else places[:: max(1, len(places) // 4)]:
                run = self.inject("short", at)
                self.check(run, f"{name}: short write {at}")
                if name != "hdf5":
                    self.assertEqual(run.code, 0, f"{name}: short write {at}: {run.errors}")
                run = self.inject(f"error={EINTR}", at)
                self.check(run, f"{name}: write {at} is interrupted")


class Signals(Case):
    def signals_at_each_call(self, name, number, most, codes):
        self.prepare(name)
        self.inject("count", 0)
        count = len(self.calls)
        for at in self.sample(count, most):
            run = self.inject(f"signal={int(number)}", at)
            what = f"{name}: signal {number} at call {at} of {count}"
            # Before the files are begun, and after they are whole, a signal kills as it does any program.
            self.check(run, what, codes=(*codes, -int(number)), both=number != signal.SIGKILL)
            parts = [output + ".part" for output in self.outputs]
            if number == signal.SIGKILL:
                old_names = [f"{part}.0" for part in parts]
                self.assert_nothing_beside(what, [*parts, *old_names])
                # What a dead run has left blocks nobody.
                again = self.call(self.command)
                self.assertEqual(again.returncode, 0, what)
            elif name == "flanks":
                self.assert_nothing_beside(what)
            elif run.code == 130:
                part = self.read(parts[0])
                self.assertIn(b"interrupted", part, what)
            elif run.code < 0:
                self.assert_nothing_beside(what)

    def test_csv(self):
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT) if ALL else (signal.SIGTERM,):
            self.signals_at_each_call("csv", number, 14, (130,))

    def test_hdf5(self):
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT) if ALL else (signal.SIGHUP,):
            self.signals_at_each_call("hdf5", number, 14, (130,))

    def test_flanks(self):
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT) if ALL else (signal.SIGTERM,):
            self.signals_at_each_call("flanks", number, 24, (130,))

    def test_kill(self):
        for name in ("csv", "hdf5", "flanks"):
            self.signals_at_each_call(name, signal.SIGKILL, 6, ())


class Allocations(Case):
    """Those of the programs themselves and of their small libraries. SUNDIALS and HDF5 do not check all of theirs."""
    SPARE = {"SPARE": "libsundials,libhdf5"}

    def each_allocation_fails(self, name, most):
        self.prepare(name)
        self.reset(True)
        self.call(self.command, LD_PRELOAD=PROGRAMS["heap"], ALLOCATION_COUNT="count", **self.SPARE)
        count = int(self.read("count"))
        self.assertGreater(count, 50)
        failed = 0
        for forever in (False, True):
            for at in self.sample(count, most):
                run = self.fail_allocation(at, forever)
                what = f"{name}: allocation {at} of {count} fails{' and all behind it' if forever else ''}"
                self.check(run, what)
                failed += run.code != 0
                if name in ("flanks", "measured"):
                    self.assert_nothing_beside(what)
        self.assertGreater(failed, most // 2)

    def test_csv(self):
        self.each_allocation_fails("csv", 24)

    def test_hdf5(self):
        self.each_allocation_fails("hdf5", 16)

    def test_static(self):
        self.each_allocation_fails("static", 10)

    def test_flanks(self):
        self.each_allocation_fails("flanks", 20)

    def test_measured(self):
        self.each_allocation_fails("measured", 10)

    def test_evaluate(self):
        self.each_allocation_fails("evaluate", 10)


if __name__ == "__main__":
    for key in ("gearsim", "gearflanks", "inject", "heap"):
        PROGRAMS[key] = os.path.abspath(sys.argv.pop(1))
    if "--all" in sys.argv:
        ALL = True
        sys.argv.remove("--all")
    unittest.main()
