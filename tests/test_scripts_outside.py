#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
What comes to the scripts from outside: names that are commands to gnuplot, locales, packages, and files that are broken.

    test_scripts_outside.py GEARSIM [-v] [name of a test]...
"""
import html
import io
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

sys.dont_write_bytecode = True
ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))
SCRIPTS = os.path.join(ROOT, "scripts")
sys.path.insert(0, SCRIPTS)
import program  # noqa: E402

program.require("numpy", "scipy", "h5py")

import h5py  # noqa: E402
import numpy as np  # noqa: E402

import script_case  # noqa: E402

GEARSIM = None
SPUR = os.path.join(ROOT, "data", "relief", "params.ini")
FLANKS = "tooth,flank,t1,t2,deviation_um\n" + "".join(
    f"{tooth},{flank},{t1},{t2},{tooth + t1 * t2}\n"
    for tooth in (0, 1, 2) for flank in ("drive", "coast") for t1 in (0, 0.5, 1) for t2 in (0, 0.5, 1)
)
PITCH = "tooth,flank,deviation_um\n" + "".join(f"{tooth},*,{value}\n" for tooth, value in enumerate([0, 1.5, -1]))
TRACES = "tooth,flank,trace,face_mm,roll_length_mm,deviation_um\n" + "".join(
    f"1,{flank},profile,8,{10 + i},{0.5 * i}\n" for flank in ("left", "right") for i in range(5)
) + "".join(f"1,left,helix,{2 + 3 * i},12,{-0.5 * i}\n" for i in range(5))
HEAD = "# gearsim\n# gears.pinion_teeth = 20\n# gears.wheel_teeth = 31\n# eigenfrequency_Hz = 300\n"
COLUMNS = ("time_s", "pinion_speed_rpm", "pinion_angle_rad", "contact_force_N")

BASH_SCRIPTS = ("bench", "demo", "reference", "setup", "test")

# What a script and Python itself import.
PLANTED_MODULES = ("numpy", "csv", "json", "contextlib", "functools", "importlib", "types", "warnings", "program",
                   "gearmesh_planted")

# Names of files and folders, and titles: each plants a file named `planted` where gnuplot runs it.
FOREIGN = (
    "|touch planted",
    "<touch planted",
    "< touch planted",
    "a|touch planted;b",
    "`touch planted`",
    "$(touch planted)",
    "it's 100 % \"q\" `touch planted`",
    "x'; system('touch planted'); y = 'z",
    'x"; system("touch planted"); y = "z',
    "two\nsystem('touch planted')",
    "end\\",
    "-n",
    "--output",
    "µm ° ² 歯車",
    "@palette_of_steps {a} _x^y",
    "%d %s %n",
)


def run_up(duration_s=4.0, rate_Hz=2048.0):
    """Columns of a run from 600 to 3000 rpm with the force of tooth order 1."""
    time_s = np.arange(int(duration_s * rate_Hz)) / rate_Hz
    speed_rpm = 600.0 + 2400.0 * time_s / duration_s
    angle_rad = (600.0 * time_s + 1200.0 * time_s**2 / duration_s) * np.pi / 30.0
    return [time_s, speed_rpm, angle_rad, 100.0 + np.cos(20 * angle_rad) + 0.1 * np.sin(7 * angle_rad)]


def run_text(rows=None):
    file = io.StringIO()
    np.savetxt(file, np.column_stack(run_up())[:rows], "%.10g", ",")
    return HEAD + ",".join(COLUMNS) + "\n" + file.getvalue()


NAMES = ("campbell", "flanks", "harris", "orders", "pattern", "plot", "relief")  # those that draw


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, ROOT)
        self.folder = folder.name
        os.chdir(self.folder)

    def write(self, name, content):
        with open(name, "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode("utf-8"))

    def call(self, script, *arguments):
        """main() of a script in this process: exit status, standard output, standard error."""
        result = script_case.call(script, *arguments)
        return result.returncode, result.stdout, result.stderr

    def drawn(self, *call):
        status, stdout, stderr = self.call(*call)
        self.assertEqual((status, stderr), (0, ""), call)
        return stdout

    def refused(self, *call):
        """Exit status 2 with a message in the grammar of all, and nothing drawn; returns the message."""
        status, _, stderr = self.call(*call)
        self.assertEqual(status, 2, (call, stderr))
        self.assertRegex(stderr, r"^\w+: ", call)
        self.assertNotIn("Traceback", stderr)
        self.assertLess(len(stderr), 2000)
        self.assertEqual([name for name in os.listdir(".") if name.endswith((".png", ".svg"))], [])
        return stderr

    def assert_nothing_planted(self):
        for folder, _, files in os.walk(self.folder):
            self.assertNotIn("planted", files, folder)


class ForeignNames(Case):
    def calls(self, name):
        """Each script as it is called with this name for its input, its title and what it writes."""
        self.write("run.csv", run_text())
        self.write("flanks.csv", FLANKS)
        self.write("traces.csv", TRACES)
        quick = ["--gearsim", GEARSIM, "--torques", "20:40:2", "--set", "analysis.positions=5"]
        title = ["--title=" + name]
        return [
            ("campbell", "run.csv", title),
            ("orders", "run.csv", ["--orders", "20", *title]),
            ("flanks", "flanks.csv", title),
            ("flanks", "traces.csv", title),
            ("harris", SPUR, [*quick, *title, "--vary", "pinion_tip_relief_um=0:20:2"]),
            ("pattern", SPUR, ["--gearsim", GEARSIM, *title, "--set", "analysis.positions=5", "--positions", "0"]),
            ("relief", SPUR, [*quick, *title, "--vary", "pinion_tip_relief_um=0:20", "--starts", "1", "--tolerance", "0"]),
        ]

    def setUp(self):
        super().setUp()
        one_format = mock.patch.object(script_case.module_of("flanks").gnuplot, "FORMATS", ("svg",))
        one_format.start()
        self.addCleanup(one_format.stop)

    def test_no_name_and_no_title_runs_a_command(self):
        for number, name in enumerate(FOREIGN):
            os.mkdir(str(number))
            os.chdir(str(number))
            os.mkdir(name)
            # Every name for flanks; the other scripts, which go the same way, for some of them.
            calls = self.calls(name)
            for script, source, options in calls if number in (9, 11) else calls[2:3]:
                shutil.copy(source, name + ".csv")
                # Half of the names for a folder, the others for files.
                output, folder = (os.path.join(".", name, "x"), name) if number % 2 else (name, ".")
                self.drawn(script, *options, "--output=" + output, "--", name + ".csv")
                self.assertTrue([file for file in os.listdir(folder) if file.endswith(".svg")], name)
                self.assertEqual([file for file in os.listdir(".") if file.startswith(".gearmesh_")], [])
            self.assert_nothing_planted()
            os.chdir(self.folder)

    def test_a_name_becomes_the_title_as_it_is(self):
        name = "it's 100 % \"q\" `a` <b> & _x^y"
        self.write(name + ".csv", run_text())
        self.drawn("campbell", name + ".csv")
        with open(name + ".svg", encoding="utf-8") as file:
            svg = file.read()
        texts = [html.unescape(text) for text in re.findall(r"<text>([^<]*)</text>", svg)]
        self.assertIn(name, texts)

    def test_names_that_are_no_text_can_be_drawn(self):
        name = b"caf\xe9 \xff.csv"
        with open(name, "wb") as file:
            file.write(FLANKS.encode())
        result = subprocess.run([sys.executable, os.path.join(SCRIPTS, "flanks"), name], capture_output=True)
        self.assertEqual((result.returncode, result.stderr), (0, b""))
        self.assertIn(b"caf\xe9 \xff_topography.png", os.listdir(os.fsencode(self.folder)))

    def test_names_that_are_no_text_stand_in_what_is_written(self):
        """Their bytes, and without what would end a line; what has them in its head can be read."""
        name = os.fsdecode(b"caf\xe9\n\xff")
        shutil.copy(SPUR, name + ".ini")
        quick = ["--gearsim", GEARSIM, "--set", "analysis.positions=5", "--no-pictures", "--torques", "20:40:2"]
        self.drawn("harris", name + ".ini", *quick, "--vary", "pinion_tip_relief_um=0:20:2")
        with open(name + "_harris.csv", encoding="utf-8") as file:
            self.assertRegex(file.readline(), "^# caf\ufffd \ufffd.ini --set ")
            self.assertIn("design load", file.readline())
        result = os.fsdecode(b"\xe9.csv")
        subprocess.run([GEARSIM, SPUR, "--quiet", "--set=analysis.positions=5", "--output", result], check=True)
        with open(result, "rb") as file:
            self.assertIn(b"output.file = \xe9.csv\n", file.read())
        self.assertIn("mean mesh stiffness", self.drawn("summary", result))

    def test_names_tell_the_terminal_nothing(self):
        name = "\033[31mred\nline\t"
        self.write(name + ".csv", FLANKS)
        self.assertNotRegex(self.drawn("flanks", name + ".csv", "--no-pictures"), "\033")
        message = self.refused("campbell", name + ".csv")
        self.assertIn("[31mred", message)
        self.assertNotIn("\033", message)
        stderr = io.StringIO()
        with mock.patch.object(sys, "stderr", stderr):
            program.warn(name)
        self.assertRegex(stderr.getvalue(), r"^.*: warning:  \[31mred line \n$")

    def test_files_of_the_folder_are_no_start_up_files(self):
        self.write(".gnuplot", "system('touch planted')\n")
        self.write("style.gp", "system('touch planted')\n")
        for module in PLANTED_MODULES:
            self.write(f"{module}.py", "open('planted', 'w')\n")
        for command in ("gnuplot", "gearsim", "python3"):
            self.write(command, "#!/bin/sh\ntouch planted\n")
            os.chmod(command, 0o755)
        self.write("flanks.csv", FLANKS)
        result = subprocess.run(
            [sys.executable, os.path.join(SCRIPTS, "flanks"), "flanks.csv"],
            env={**os.environ, "HOME": self.folder, "GNUTERM": "none; system('touch planted')"},
            capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assert_nothing_planted()

    def test_a_python_is_not_asked_for_packages_of_the_folder(self):
        for module in PLANTED_MODULES:
            self.write(f"{module}.py", "open('planted', 'w')\n")
        self.assertTrue(program._has(sys.executable, ("numpy", "json")))  # pylint: disable=protected-access
        self.assertFalse(program._has(sys.executable, ("gearmesh_planted",)))  # pylint: disable=protected-access
        self.assert_nothing_planted()


class Locales(Case):
    def setUp(self):
        """A locale with a decimal comma, made here, beside those that the system may have."""
        super().setUp()
        self.write("comma", 'LC_NUMERIC\ndecimal_point ","\nthousands_sep "."\ngrouping 3;3\nEND LC_NUMERIC\n')
        self.environment = {key: value for key, value in os.environ.items() if not key.startswith(("LC_", "LANG"))}
        self.environment["LOCPATH"] = self.folder
        try:
            subprocess.run(["localedef", "-c", "-i", "./comma", os.path.join(self.folder, "xx_XX")],
                           capture_output=True, check=False)
        except FileNotFoundError:
            pass
        ask = "import locale; locale.setlocale(locale.LC_ALL, ''); print(locale.localeconv()['decimal_point'])"
        result = self.with_comma([sys.executable, "-c", ask])
        if result.stdout != b",\n":
            self.skipTest("localedef makes no locale with a decimal comma")

    def with_comma(self, command):
        return subprocess.run(command, env={**self.environment, "LC_ALL": "xx_XX"}, capture_output=True)

    def test_pictures_are_the_same_in_every_locale(self):
        self.write("flanks.csv", FLANKS)
        self.write("pitch.csv", PITCH)
        self.write("run.csv", run_text())
        shown = {}
        for locale in ("C", "C.UTF-8", "xx_XX"):
            for script, names in (("flanks", ["flanks.csv", "pitch.csv"]), ("campbell", ["run.csv"])):
                result = subprocess.run(
                    [sys.executable, os.path.join(SCRIPTS, script), *names, "--title", "x"],
                    env={**self.environment, "LC_ALL": locale}, capture_output=True)
                self.assertEqual((result.returncode, result.stderr), (0, b""), locale)
                for name in sorted(os.listdir(".")):
                    if name.endswith(".svg"):
                        with open(name, "rb") as file:
                            self.assertEqual(shown.setdefault(name, file.read()), shown[name])
                            file.seek(0)
                            self.assertEqual(file.read(), shown[name], (locale, name))
        self.assertIn("µm".encode(), shown["flanks_topography.svg"])
        self.assertIn("α".encode(), shown["flanks_pitch.svg"])

    def test_numbers_have_a_point_in_every_locale(self):
        """Those of a run, and what the scripts say of it."""
        shutil.copy(SPUR, "run.ini")
        run = [GEARSIM, "run.ini", "--quiet", "--set", "analysis.positions=7", "--set", "load.mean_Nm=40.5"]
        plain = subprocess.run(run, env=self.environment, capture_output=True)
        self.assertEqual((plain.returncode, plain.stderr), (0, b""))
        summary = [sys.executable, os.path.join(SCRIPTS, "summary"), "--json", "run.csv"]
        with open("run.csv", "rb") as file:
            rows = file.read()
        said = subprocess.run(summary, env=self.environment, capture_output=True)
        self.assertRegex(rows, rb"\n0\.[0-9]+,")
        self.assertRegex(said.stdout, rb"[0-9]\.[0-9]")

        self.assertEqual(self.with_comma(run).returncode, 0)
        with open("run.csv", "rb") as file:
            self.assertEqual(file.read(), rows)
        self.assertEqual(self.with_comma(summary).stdout, said.stdout)
        geometry = self.with_comma([GEARSIM, "run.ini", "--geometry"]).stdout
        self.assertEqual(geometry, subprocess.run([GEARSIM, "run.ini", "--geometry"], capture_output=True).stdout)
        self.assertIn(b"transverse_contact_ratio = 1.", geometry)


class Packages(Case):
    def call_with(self, path, *arguments, **environment):
        """A script under the python3 that a search path has first."""
        return subprocess.run(
            [os.path.join(SCRIPTS, "flanks"), *arguments], capture_output=True, text=True,
            env={**os.environ, "PATH": path, "PYTHONDONTWRITEBYTECODE": "1", **environment})

    def test_a_python_without_numpy_hands_on_to_one_that_has_it(self):
        self.write("flanks.csv", FLANKS)
        without = self.python_without_packages()
        result = self.call_with(os.pathsep.join([without, os.path.dirname(sys.executable), os.environ["PATH"]]),
                                "flanks.csv", "--no-pictures")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("drive", result.stdout)

    def test_what_is_missing_is_named(self):
        without = self.python_without_packages()
        code = "import sys; sys.path.insert(0, sys.argv[1]); import program; program._other_pythons = list; " \
               "program.require('numpy')"
        result = subprocess.run([os.path.join(without, "python3"), "-c", code, SCRIPTS], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn("numpy (Debian: python3-numpy)", result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1)

    def python_without_packages(self):
        """A folder with a python3 that finds no packages but its own: an empty environment."""
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", "without"], check=True)
        return os.path.abspath("without/bin")

    def test_missing_gnuplot_is_named(self):
        self.write("flanks.csv", FLANKS)
        with mock.patch.dict(os.environ, {"PATH": self.folder}):
            status, _, stderr = self.call("flanks", "flanks.csv")
        self.assertEqual(status, 1)
        self.assertIn("gnuplot is not installed (Debian: gnuplot-nox)", stderr)
        self.assertEqual(os.listdir("."), ["flanks.csv"])

    def test_nobody_reads_what_is_printed(self):
        self.write("flanks.csv", FLANKS)
        read_end, write_end = os.pipe()
        os.close(read_end)
        result = subprocess.run([sys.executable, os.path.join(SCRIPTS, "flanks"), "flanks.csv", "--no-pictures"],
                                stdout=write_end, stderr=subprocess.PIPE, text=True)
        os.close(write_end)
        self.assertEqual((result.returncode, result.stderr), (1, ""))

    def test_closed_standard_streams_take_no_message_and_no_file(self):
        """Whichever are closed: the same results as with all of them; who prints for nobody says so by the status."""
        quick = ["--no-pictures", "--gearsim", GEARSIM, "--set", "analysis.positions=5", "--torques", "20:40:2"]
        command = [sys.executable, os.path.join(SCRIPTS, "harris"), SPUR, *quick, "--vary", "pinion_tip_relief_um=0:20:2"]
        written = []
        for closed, status in (("", 0), ("<&-", 0), ("2>&-", 0), ("<&- 2>&-", 0), (">&-", 1), ("<&- >&- 2>&-", 1)):
            shutil.rmtree("out", ignore_errors=True)
            os.mkdir("out")
            result = subprocess.run(["sh", "-c", f'exec "$@" >said {closed}', "sh", *command, "--output", "out/x"],
                                    stderr=subprocess.PIPE, text=True)
            self.assertEqual(result.returncode, status, (closed, result.stderr))
            self.assertNotIn("Traceback", result.stderr)
            if status == 0:
                with open("said", encoding="utf-8") as file:
                    self.assertIn("peak-to-peak", file.read())
            found = {}
            for name in sorted(os.listdir("out")):
                with open(os.path.join("out", name), "rb") as file:
                    found[name] = file.read()
            written.append(found)
        self.assertEqual(len(written[0]), 2)
        for found in written[1:]:
            self.assertEqual(found, written[0])

    def test_signals_leave_nothing_behind(self):
        """TERM and HUP end a script as Ctrl-C does, and the gnuplots that it has started."""
        os.mkdir("bin")
        self.write("bin/gnuplot", "#!/bin/sh\necho $$ >>\"$PIDS\"\nexec sleep 60\n")
        os.chmod("bin/gnuplot", 0o755)
        self.write("flanks.csv", FLANKS)
        os.mkdir("out")
        path = os.path.join(self.folder, "bin") + os.pathsep + os.environ["PATH"]
        for number in (signal.SIGTERM, signal.SIGHUP):
            pids = os.path.join(self.folder, f"pids{int(number)}")
            script = subprocess.Popen(
                [sys.executable, os.path.join(SCRIPTS, "flanks"), "flanks.csv", "--output", "out/x"],
                env={**os.environ, "PATH": path, "PIDS": pids}, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            while script.poll() is None and not (os.path.exists(pids) and os.path.getsize(pids)):
                time.sleep(0.01)
            time.sleep(0.1)  # the other pictures begin as well
            script.send_signal(number)
            _, stderr = script.communicate(timeout=20)
            self.assertEqual((script.returncode, stderr), (130, "flanks: interrupted\n"))
            self.assertEqual(os.listdir("out"), [])
            with open(pids, encoding="ascii") as file:
                for pid in file.read().split():
                    self.assertRaises(ProcessLookupError, os.kill, int(pid), 0)

    def test_hangup_does_nothing_after_nohup(self):
        code = "import signal, sys; sys.path.insert(0, sys.argv.pop()); import program; " \
               "sys.exit(program.run(lambda _: signal.raise_signal(signal.SIGHUP), lambda: None))"
        for first, status in (("", 130), ("trap '' HUP; ", 0)):
            result = subprocess.run(["sh", "-c", first + 'exec "$@"', "sh", sys.executable, "-c", code, SCRIPTS],
                                    capture_output=True)
            self.assertEqual(result.returncode, status, result.stderr)

    def test_a_file_is_whole_or_as_it_was(self):
        self.write("old", "old")
        os.chmod("old", 0o640)
        os.symlink("old", "link")
        with self.assertRaises(KeyboardInterrupt):
            with program.written("link") as file:
                file.write("half")
                raise KeyboardInterrupt
        with open("old", encoding="ascii") as file:
            self.assertEqual(file.read(), "old")
        with program.written("link") as file:
            file.write("new")
            with program.written("old") as other:
                other.write("earlier")
        with open("old", encoding="ascii") as file:
            self.assertEqual(file.read(), "new")
        self.assertTrue(os.path.islink("link"))
        self.assertEqual(os.stat("old").st_mode & 0o777, 0o640)
        kept = os.umask(0o027)
        try:
            with program.written("fresh") as file:
                file.write("x")
        finally:
            os.umask(kept)
        self.assertEqual(os.stat("fresh").st_mode & 0o777, 0o640)
        with program.written("/dev/null") as file:
            file.write("x")
        self.assertRaises(OSError, lambda: program.written("no/where").__enter__())
        self.write("flanks.csv", FLANKS)
        status, _, stderr = self.call("flanks", "flanks.csv", "--output", 250 * "x")
        self.assertEqual((status, stderr), (1, f"flanks: {250 * 'x'}_topography.png: File name too long\n"))
        os.remove("flanks.csv")
        self.assertEqual(sorted(os.listdir(".")), ["fresh", "link", "old"])

    def test_help_has_an_example_and_options_are_checked(self):
        for script in NAMES:
            status, stdout, stderr = self.call(script, "--help")
            self.assertEqual((status, stderr), (0, ""))
            self.assertIn("Exit status:", stdout)
            self.assertRegex(stdout, rf"(?m)^    scripts/{script} ")
            self.assertEqual(self.call(script)[0], 2)
            self.assertEqual(self.call(script, "--no-such-option", "x")[0], 2)
            self.assertIn("there is no such folder", self.call(script, "run.csv", "--output", "no/where")[2])
        for script in ("cases", "report", "summary", "sweep"):
            status, stdout, stderr = self.call(script, "--help")
            self.assertEqual((status, stderr), (0, ""))
            self.assertIn("Exit status:", stdout)
            self.assertRegex(stdout, rf"(?m)^    scripts/{script} ")
            self.assertEqual(self.call(script, "--no-such-option", "x")[0], 2)

    def test_bash_scripts_go_by_their_own_place(self):
        """Called by a link, and with CDPATH: not into another folder, whose scripts and builds they would run."""
        for folder in ("bin", "libgearmesh", "scripts/libgearmesh", "programs"):
            os.makedirs(folder)
        os.symlink(os.path.join(SCRIPTS, "reference"), "bin/reference")
        self.write("programs/doxygen", "#!/bin/sh\npwd\n")
        os.chmod("programs/doxygen", 0o755)
        path = os.path.join(self.folder, "programs") + os.pathsep + os.environ["PATH"]
        for folder, script in ((self.folder, "bin/reference"), (ROOT, "scripts/reference")):
            result = subprocess.run(["bash", script, os.path.join(self.folder, "out")], capture_output=True, text=True,
                                    cwd=folder, env={**os.environ, "PATH": path, "CDPATH": self.folder})
            self.assertEqual(result.stdout.splitlines()[:1], [os.path.join(ROOT, "libgearmesh")], result.stderr)

        # The others go the same way.
        for script in ("scripts/bench", "scripts/demo", "scripts/reference", "scripts/test"):
            with open(os.path.join(ROOT, script), encoding="utf-8") as file:
                places = re.findall(r"(?m)^cd .*", file.read())
            self.assertRegex(places[0], r'^cd "\$\(dirname "\$\(realpath -- "\$0"\)"\)/\.\.(/libgearmesh)?"$', script)
            self.assertEqual(len(places), 1)

    def test_help_of_the_bash_scripts_is_their_whole_head(self):
        for name in BASH_SCRIPTS:
            with open(os.path.join(SCRIPTS, name), encoding="utf-8") as file:
                head = file.read().split("#\n", 1)[1].split("\nset ", 1)[0]
            text = re.sub("(?m)^# ?", "", head) + "\n"
            result = subprocess.run([os.path.join(SCRIPTS, name), "--help"], capture_output=True, text=True)
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, text, ""), name)
            self.assertIn("Exit status:", text)
            self.assertIn(f"    scripts/{name} ", text)


class BrokenFiles(Case):
    def test_broken_runs_are_refused_by_name(self):
        good = run_text(400)
        lines = good.splitlines(keepends=True)
        header = lines.index(",".join(COLUMNS) + "\n")
        for text, message in (
            ("", "no header"),
            (HEAD, "no header"),
            ("\n", "no column"),
            ("# only\n", "no header"),
            (good[: len(good) // 2], "cut off|must have 4 columns"),
            (good[:-1], "cut off"),
            ("".join(lines[: header + 1]), "two rows or more"),
            ("".join(lines[: header + 2]), "two rows or more"),
            (good.replace("contact_force_N", "force"), "contact_force_N"),
            (good + "nan,nan,nan,nan\n", "finite number"),
            (good + "0.05,700,inf,1\n", "finite number"),
            (good + "1,2,3\n", r"x.csv:\d+: must have 4 columns"),
            (good + "1,2,3,x\n", r"x.csv:\d+: contact_force_N: must be a number \(got 'x'\)"),
            (good + "1,2,3,4,5\n", r"x.csv:\d+: must have 4 columns"),
            (good + "1,2,3,1e400\n", "finite number"),
            (good.replace(",6", ";6", 1), "columns|number"),
            ("\0" * 5000, "a file that is no text"),
            (bytes(range(256)) * 40, "a file that is no text"),
            (good.replace("gears.pinion_teeth = 20", "gears.pinion_teeth = 9999999999999999999999"), "pinion_teeth"),
            (good.replace("gears.pinion_teeth = 20", "gears.pinion_teeth = ²"), "pinion_teeth"),
            (re.sub(r"(?m)^(\d[^,]*),[^,]*,", r"\1,0,", good), "stands still"),
        ):
            self.write("x.csv", text)
            self.assertRegex(self.refused("campbell", "x.csv"), message, text[:80])
        self.assertRegex(self.refused("campbell", "nowhere.csv"), "nowhere.csv")
        self.assertRegex(self.refused("campbell", "."), "cannot be read")

    def test_broken_hdf5_is_refused_by_name(self):
        def make(**changed):
            with h5py.File("x.h5", "w") as file:
                for name, column in zip(COLUMNS, run_up()):
                    column = changed.get(name, column)
                    if isinstance(column, str):
                        file.create_group(name)
                    elif column is not None:
                        file[name] = column
                file.attrs["gears.pinion_teeth"], file.attrs["gears.wheel_teeth"] = changed.get("teeth", ("20", "31"))

        make()
        with open("x.h5", "rb") as file:
            whole = file.read()
        self.assertEqual(self.call("campbell", "x.h5", "--no-pictures")[0], 0)
        for changed, message in (
            ({"time_s": None}, "no column time_s"),
            ({"time_s": "group"}, "time_s: must be a column of numbers"),
            ({"time_s": np.zeros((4, 4))}, "time_s: must be a column of numbers"),
            ({"time_s": np.array([b"a", b"b"])}, "time_s: must be a column of numbers"),
            ({"time_s": np.zeros(3)}, "same length"),
            ({"time_s": np.zeros(8192)}, "evenly spaced"),
            ({"contact_force_N": np.full(8192, np.nan)}, "finite number"),
            ({"teeth": (b"x", np.arange(3))}, "pinion_teeth"),
        ):
            make(**changed)
            self.assertIn(message, self.refused("campbell", "x.h5"))
        for cut in (9, 100, 2000, len(whole) // 2):
            self.write("x.h5", whole[:cut])
            self.assertIn("x.h5", self.refused("campbell", "x.h5"))

    def test_broken_reference_and_parameter_files(self):
        self.write("run.csv", run_text())
        self.write("x.csv", "nothing\n")
        self.refused("campbell", "run.csv", "--reference", "x.csv")
        self.refused("campbell", "run.csv", "--reference", "nowhere.csv")
        for content in ("", "[gears", "\0\0", "[gears]\npinion_teeth = x\n"):
            self.write("x.ini", content)
            for script in ("harris", "relief"):
                self.assertIn("x.ini", self.refused(script, "x.ini", "--gearsim", GEARSIM))

    def test_parameter_files_keep_what_is_no_utf8_and_no_line_end(self):
        """As gearsim, which looks at neither in a comment."""
        comment = b"; caf\xe9 \xe2\x80\xa8 [x] y"
        with open(SPUR, "rb") as file:
            self.write("x.ini", comment + b"\n" + file.read().replace(b"\n", b"\r\n"))
        self.drawn("relief", "x.ini", "--gearsim", GEARSIM, "--set", "analysis.positions=5", "--no-pictures", "--starts", "1",
                   "--torques", "20:40:2", "--vary", "pinion_tip_relief_um=0:20", "--tolerance", "0")
        with open("x_relief.ini", "rb") as file:
            self.assertIn(comment, file.read().splitlines())
        self.assertEqual(subprocess.run([GEARSIM, "x_relief.ini", "--check", "--quiet"]).returncode, 0)

    def mutated(self, text, random_):
        """The text with some bytes changed, taken out, put in twice, or cut off."""
        data = bytearray(text.encode())
        for _ in range(random_.randint(1, 4)):
            at = random_.randrange(len(data) or 1)
            kind = random_.randrange(7)
            if kind == 0:
                data[at : at + 1] = bytes([random_.randrange(256)])
            elif kind == 1:
                del data[at : at + random_.randint(1, 60)]
            elif kind == 2:
                data[at:at] = data[at : at + random_.randint(1, 200)]
            elif kind == 3:
                del data[at:]
            elif kind == 4:
                data[at:at] = random_.choice([b"nan", b"-", b"1e999", b",", b"\n", b"#", b"*", b"\r", b"\xff", b"\0", b"e"])
            elif kind == 5:
                lines = bytes(data).split(b"\n")
                random_.shuffle(lines)
                data = bytearray(b"\n".join(lines))
            else:
                data[at : at + 1] = random_.choice([b"0", b"9", b".", b";", b" ", b"-1"])
        return bytes(data)

    def test_mutated_files_are_drawn_or_refused(self):
        """Hundreds of broken files: a result or a message, never an exception and never a warning of a library."""
        random_ = random.Random(1)
        run = run_text(700)
        with mock.patch.object(script_case.module_of("campbell").gnuplot, "draw"):
            for _ in range(100):
                self.write("x.csv", self.mutated(run, random_))
                status, _, stderr = self.call("campbell", "x.csv", "--no-pictures")
                self.assertIn(status, (0, 2), stderr)
                self.assertNotIn("Traceback", stderr)
                self.assertNotIn("Warning", stderr)
        for text, options in ((FLANKS, []), (TRACES, []), (FLANKS, ["pitch.csv"])):
            for _ in range(150):
                self.write("x.csv", self.mutated(text, random_))
                self.write("pitch.csv", self.mutated(PITCH, random_))
                status, _, stderr = self.call("flanks", "x.csv", *options, "--no-pictures")
                self.assertIn(status, (0, 2), stderr)
                self.assertNotIn("Traceback", stderr)
                self.assertNotIn("Warning", stderr)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(f"usage: {sys.argv[0]} GEARSIM [-v] [name of a test]...")
    GEARSIM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
