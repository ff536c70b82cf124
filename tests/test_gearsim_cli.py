#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
The command line of gearsim: options, INI files, flank files, --geometry, and above all bad input.

    test_gearsim_cli.py GEARSIM [-v] [name of a test]...

Every refusal must name the place (file and line, or the option), the key and the value, end with exit
code 2, leave an existing result as it was and nothing else behind.
"""
import array
import io
import json
import math
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import unittest

GEARSIM = os.environ.get("GEARSIM", "gearsim")
EXAMPLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "example", "params.ini")
SOURCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "apps", "gearsim")
OLD_RESULT = "an older result\n"

# A run of a few milliseconds: the gears of data/paper/.
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
pinion_tip_diameter_mm = 93.876780
wheel_tip_diameter_mm = 86.007182
pinion_rack_dedendum = 1.75
wheel_rack_dedendum = 1.75
[mesh]
stiffness_N_per_m = 1.05e8
damping_Ns_per_m = 844.361
[bodies]
wheel_inertia_kg_m2 = 2.1e-3
[drive]
start_rpm = 1000
end_rpm = 1100
[load]
mean_Nm = 20
[analysis]
duration_s = 0.01
"""

TORQUE = ["--set", "drive.kind=torque", "--set", "drive.torque_Nm=21", "--set", "bodies.pinion_inertia_kg_m2=2e-3"]

DEVIATIONS = """\
tooth,flank,t1,t2,deviation_um
*,*,0,0,0
*,*,0,1,1
*,*,1,0,0
*,*,1,1,1
"""


def with_key(params, section, key, value):
    """The text with the key replaced, or put in front of its section, or in a new section."""
    line = f"{key} = {value}\n"
    text, count = re.subn(rf"(?m)^{re.escape(key)} = .*\n", lambda _: line, params)
    if count == 0:
        text, count = re.subn(rf"(?m)^\[{section}\]\n", lambda match: match.group(0) + line, params)
    return text if count else params + f"[{section}]\n" + line


def without_key(params, key):
    text, count = re.subn(rf"(?m)^{re.escape(key)} = .*\n", "", params)
    assert count == 1
    return text


def line_of(params, beginning):
    """Number of the first line that begins so."""
    return 1 + next(i for i, line in enumerate(params.split("\n")) if line.startswith(beginning))


class Case(unittest.TestCase):
    """A folder of its own for every test, with a result from before."""

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = self.scratch.name
        self.write("run.csv", OLD_RESULT)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        mode = "wb" if isinstance(text, bytes) else "w"
        with open(self.path(name), mode) as file:
            file.write(text)

    def read(self, name):
        with open(self.path(name)) as file:
            return file.read()

    def run_gearsim(self, *arguments, folder=None):
        return subprocess.run([GEARSIM, *arguments], cwd=folder or self.folder, capture_output=True, text=True,
                              errors="replace", stdin=subprocess.DEVNULL, timeout=60)

    def accepted(self, *arguments, folder=None):
        result = self.run_gearsim(*arguments, folder=folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def refused(self, *fragments, params=PARAMS, arguments=()):
        """Runs the parameters: exit code 2, a message with all fragments, and no file changed."""
        if params is not None:
            self.write("run.ini", params)
        before = sorted(os.listdir(self.folder))
        result = self.run_gearsim("run.ini", *arguments)
        self.assertEqual(result.returncode, 2, f"stdout: {result.stdout}\nstderr: {result.stderr}")
        for fragment in fragments:
            self.assertIn(fragment, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(self.read("run.csv"), OLD_RESULT)
        self.assertEqual(sorted(os.listdir(self.folder)), before)
        return result.stderr

    def refused_value(self, section, key, value, *fragments):
        """The same for one bad value: the message names line, key and value; so does that of --set."""
        params = with_key(PARAMS, section, key, value)
        line = line_of(params, f"{key} = ")
        self.refused(f"run.ini:{line}: {section}.{key}: ", f"(got {value})", *fragments, params=params)
        self.refused(f"--set {section}.{key}: ", f"(got {value})", *fragments,
                     arguments=["--set", f"{section}.{key}={value}"])


class Options(Case):
    def test_help_lists_all_options_exit_codes_and_keys(self):
        text = self.accepted("--help").stdout
        for option in ["--set section.key=value", "--output FILE", "--quiet", "--version", "--help", "--geometry",
                       "--check", "--each", "--binary"]:
            self.assertIn(option, text)
        self.assertRegex(text, r"0 done; 1 .*; 2 .*; 130 interrupted")
        for line in ["helix_angle_deg           [0]", "profile_blend             [0.1]", "relative_tolerance        [1e-4]",
                     "rate_Hz                   [25600]", "oversampling              [4]", "seed                      [1]",
                     "noise_interval_s          [1e-5]", "positions                 [200]"]:
            self.assertIn(line, text)
        self.assertGreaterEqual(len(re.findall(r"(?m)^  [a-z]\w+ ", text)), 51)

    def test_version_is_that_of_the_library(self):
        self.assertRegex(self.accepted("--version").stdout, r"^gearsim \d+\.\d+\.\d+\n$")

    def test_options_stand_anywhere_and_take_their_value_either_way(self):
        self.write("run.ini", PARAMS)
        for arguments in [["--set", "gears.helix_angle_deg=0", "run.ini", "--geometry"],
                          ["--geometry", "--set=gears.helix_angle_deg=0", "run.ini"],
                          ["run.ini", "--geometry", "--set", "gears.helix_angle_deg = 0"],
                          ["--geometry", "--set=gears.helix_angle_deg=0", "--", "run.ini"]]:
            self.assertIn("\noverlap_ratio = 0\n", self.accepted(*arguments).stdout)

    def test_wrong_usage_is_refused(self):
        self.write("run.ini", PARAMS)
        self.write("other.ini", PARAMS)
        for arguments, fragment in [([], "no INI file"),
                                    (["--check"], "no INI file"),
                                    (["run.ini", "--chekc"], "unknown option --chekc"),
                                    (["run.ini", "-q"], "unknown option -q"),
                                    (["run.ini", "--set"], "a value is missing behind --set"),
                                    (["run.ini", "--output"], "a value is missing behind --output"),
                                    (["run.ini", "other.ini"], "a second INI file"),
                                    (["run.ini", "--quiet=1"], "no value expected: --quiet=1"),
                                    (["run.ini", "--check", "--geometry"], "exclude each other"),
                                    (["run.ini", "--each", "--check"], "exclude each other"),
                                    (["run.ini", "--each", "--output", "x.csv"], "not to x.csv"),
                                    (["-", "--each"], "not the INI file"),
                                    (["run.ini", "--binary"], "--binary goes with --each"),
                                    (["run.ini", "--check", "--binary"], "--binary goes with --each"),
                                    ([""], "the name of the INI file is empty")]:
            with self.subTest(arguments):
                result = self.run_gearsim(*arguments)
                self.assertEqual(result.returncode, 2)
                self.assertIn(fragment, result.stderr)
                self.assertIn("usage: gearsim PARAMS.ini", result.stderr)

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_full_disk_behind_stdout_fails(self):
        self.write("run.ini", PARAMS)
        for arguments in [["--help"], ["run.ini", "--geometry"]]:
            with open("/dev/full", "w") as full:
                result = subprocess.run([GEARSIM, *arguments], cwd=self.folder, stdout=full, stderr=subprocess.PIPE)
            self.assertEqual(result.returncode, 1)
            self.assertIn(b"standard output: cannot be written", result.stderr)

    def test_check_writes_nothing(self):
        self.write("run.ini", PARAMS)
        result = self.accepted("run.ini", "--check")
        self.assertEqual(result.stderr, "")
        self.assertEqual(sorted(os.listdir(self.folder)), ["run.csv", "run.ini"])
        self.assertEqual(self.read("run.csv"), OLD_RESULT)

    def test_check_says_what_comes(self):
        self.write("run.ini", PARAMS)
        self.assertEqual(self.accepted("run.ini", "--check", "--output", "x.csv").stdout,
                         "run.ini: ok\ndynamic run of 0.01 s, model 3d\n257 rows of 11 columns into x.csv\n")
        loads = ["--set", "analysis.type=static", "--set", "analysis.loads=3", "--set", "load.end_Nm=30",
                 "--set", "output.columns=te_um,load_torque_Nm", "--set", "analysis.duration_s="]
        self.assertIn("static run of 200 positions under 3 loads, model 3d\n600 rows of 2 columns into run.csv\n",
                      self.accepted("run.ini", "--check", *loads).stdout)
        self.assertEqual(self.accepted("run.ini", "--check", "--quiet").stdout, "")

    def test_check_and_geometry_as_json(self):
        self.write('a "run".ini', PARAMS)
        said = json.loads(self.accepted('a "run".ini', "--check", "--json").stdout)
        self.assertEqual((said["file"], said["ok"], said["type"], said["duration_s"], said["rows"], said["output"]),
                         ('a "run".ini', True, "dynamic", 0.01, 257, 'a "run".csv'))
        self.assertEqual((said["columns"][0], len(said["columns"])), ("time_s", 11))
        listed = self.accepted('a "run".ini', "--geometry").stdout.splitlines()
        said = json.loads(self.accepted('a "run".ini', "--json", "--geometry").stdout)
        self.assertEqual([f"{name} = {value:.17g}" for name, value in said.items()],
                         [f"{name} = {float(value):.17g}" for name, value in (line.split(" = ") for line in listed)])
        self.assertIn("--json goes with --check or --geometry", self.run_gearsim('a "run".ini', "--json").stderr)

    def test_a_run_ends_with_file_rows_and_time(self):
        self.write("run.ini", PARAMS)
        self.assertRegex(self.accepted("run.ini", "--output", "x.csv").stderr, r"gearsim: x\.csv: 257 rows in \S+ s\n$")
        self.assertEqual(len([line for line in self.read("x.csv").splitlines() if not line.startswith("#")]), 1 + 257)
        static = ["--set", "analysis.type=static", "--set", "analysis.positions=7"]
        self.assertRegex(self.accepted("run.ini", *static).stderr, r"gearsim: run\.csv: 7 rows in \S+ s\n$")

    def test_check_finds_what_a_run_would(self):
        self.refused("run.ini:", "output.columns", "'nonsense'", arguments=["--check"],
                     params=with_key(PARAMS, "output", "columns", "time_s,nonsense"))
        self.refused("none.csv", "flanks.pinion", arguments=["--check"],
                     params=with_key(PARAMS, "flanks", "pinion", "none.csv"))

    def test_set_overrides_the_file_and_the_last_wins(self):
        self.write("run.ini", PARAMS)
        text = self.accepted("run.ini", "--geometry", "--set", "gears.face_width_mm=5", "--set",
                             "gears.face_width_mm=0.001", "--set", "gears.helix_angle_deg=0").stdout
        self.assertIn("\noverlap_ratio = 0\n", text)
        text = self.accepted("run.ini", "--geometry", "--set", "gears.helix_angle_deg=0", "--set",
                             "gears.helix_angle_deg=-33").stdout
        self.assertIn("\nbase_helix_angle_deg = -31.57", text)

    def test_bad_overrides_are_refused(self):
        for override, *fragments in [["load.mean_Nm", "--set load.mean_Nm: ", "section.key=value"],
                                     ["mean_Nm=3", "--set mean_Nm=3: ", "section.key=value"],
                                     ["gears.helix_angel_deg=3", "--set gears.helix_angel_deg: unknown key",
                                      "did you mean helix_angle_deg?"],
                                     ["gear.helix_angle_deg=3", "--set [gear]: unknown section", "[gears]"],
                                     ["load.mean_Nm=", "--set load.mean_Nm: missing, but required for a run"],
                                     ["load.mean_Nm=1\n2", "--set ", "control character"]]:
            with self.subTest(override):
                self.refused(*fragments, arguments=["--set", override])

    def test_override_of_a_key_is_checked_even_if_a_later_one_wins(self):
        self.refused("--set load.mean_Nm: ", "(got much)",
                     arguments=["--set", "load.mean_Nm=much", "--set", "load.mean_Nm=3"])


class Streams(Case):
    """`-` for standard input and output."""

    def piped(self, *arguments, text=PARAMS, **options):
        return subprocess.run([GEARSIM, *arguments], cwd=self.folder, input=text, text=True, timeout=60, check=False,
                              **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options})

    def test_result_on_standard_output_is_that_in_a_file(self):
        self.write("run.ini", PARAMS)
        self.accepted("run.ini", "--output", "x.csv")
        rows = [line for line in self.read("x.csv").splitlines() if not line.startswith("#")]
        for arguments in [["run.ini", "--output", "-"], ["run.ini", "--set", "output.file=-"], ["-"],
                          ["-", "--output=-"]]:
            with self.subTest(arguments):
                done = self.piped(*arguments)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual([line for line in done.stdout.splitlines() if not line.startswith("#")], rows)
                self.assertIn("gearsim: standard output: 257 rows in ", done.stderr)
        self.write("sub.ini", with_key(PARAMS, "output", "file", "-"))
        self.assertIn("\n257 rows of 11 columns into standard output\n", self.accepted("./sub.ini", "--check").stdout)
        self.assertEqual(self.read("run.csv"), OLD_RESULT)
        self.assertEqual(sorted(os.listdir(self.folder)), ["run.csv", "run.ini", "sub.ini", "x.csv"])

    def test_parameters_from_standard_input(self):
        self.assertEqual(self.piped("-", "--check").stdout.splitlines()[0], "standard input: ok")
        self.assertIn("total_contact_ratio = ", self.piped("--geometry", "-").stdout)
        self.assertEqual(self.piped("-", "--output", "x.csv", "--quiet").stdout, "")
        self.assertEqual(len(self.read("x.csv").splitlines()[-1].split(",")), 11)
        done = self.piped("-", text=PARAMS.replace("= 45", "= many"))
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("-:2: gears.pinion_teeth: must be a number", done.stderr)

    def test_each_line_of_settings_is_a_run_of_its_own(self):
        """Rows and provenance are those of a call by itself; what is wrong with a line leaves the others."""
        self.write("run.ini", PARAMS)
        lines = ["", "load.mean_Nm=30\tanalysis.duration_s=0.002", "analysis.type=static\toutput.columns=te_um\t",
                 "load.mean_Nm=much", "analysis.type=static\tload.mean_Nm=1e9\toutput.columns=te_um", "drive.end_rpm = 1000"]
        done = self.piped("run.ini", "--each", "--quiet", "--set", "load.mean_Nm=10", text="\n".join(lines))
        self.assertEqual((done.returncode, done.stderr), (1, ""))
        answers = re.split(r"(?m)^# exit (\d+)\n", done.stdout)
        self.assertEqual((answers[1::2], answers[-1]), (["0", "0", "0", "2", "1", "0"], ""))
        for line, answer in zip(lines, answers[::2]):
            with self.subTest(line):
                settings = [f"--set={setting}" for setting in ["load.mean_Nm=10", *filter(None, line.split("\t"))]]
                alone = self.run_gearsim("run.ini", "--quiet", "--output", "-", *settings)
                said = "".join(f"{text}\n" for text in re.findall(r"(?m)^# message: (.*)$", answer))
                self.assertEqual((re.sub(r"(?m)^# message: .*\n", "", answer), said), (alone.stdout, alone.stderr))
        self.assertEqual((self.read("run.csv"), sorted(os.listdir(self.folder))), (OLD_RESULT, ["run.csv", "run.ini"]))

    def test_binary_rows_are_the_numbers_of_the_text(self):
        """All else is the same line by line; the second run has more rows than one block holds."""
        self.write("run.ini", PARAMS)
        lines = ["", "analysis.type=static\toutput.columns=te_um,pinion_angle_rad\tanalysis.positions=5000", "load.mean_Nm=x",
                 "analysis.type=static\tload.mean_Nm=-1e9\toutput.columns=te_um"]
        command = [GEARSIM, "run.ini", "--each", "--quiet", "--set", "output.digits=17"]
        text, binary = (subprocess.run([*command, *option], cwd=self.folder, input="\n".join(lines).encode(), timeout=60,
                                       capture_output=True, check=False) for option in ([], ["--binary"]))
        self.assertEqual((binary.returncode, binary.stderr), (text.returncode, text.stderr))
        told, blocks, columns = [], [], 0
        stream = io.BytesIO(binary.stdout)
        while line := stream.readline():
            if line.startswith(b"# rows "):
                blocks.append(int(line.split()[-1]))
                numbers = array.array("d", stream.read(8 * columns * blocks[-1]))
                told += [tuple(numbers[i : i + columns]) for i in range(0, len(numbers), columns)]
            else:
                columns = columns if line.startswith(b"#") else line.count(b",") + 1
                told.append(line)
        wanted = [line if not re.match(rb"[-\d]", line) else tuple(map(float, line.split(b",")))
                  for line in text.stdout.splitlines(keepends=True)]
        self.assertTrue(told == wanted)  # a list of differences would take minutes
        self.assertEqual((sum(blocks[1:]), len(blocks)), (5000, 3))  # 80 000 bytes in blocks of 64 KiB

    def test_an_interrupt_ends_all_runs(self):
        self.write("run.ini", PARAMS)
        with subprocess.Popen([GEARSIM, "run.ini", "--each", "--quiet"], cwd=self.folder, stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE, text=True) as process:
            process.stdin.write("analysis.duration_s=1000\n\n")
            process.stdin.flush()
            self.assertEqual(process.stdout.readline()[:9], "# gearsim")
            process.send_signal(signal.SIGINT)
            said = process.stdout.read()
            self.assertIn("\n# incomplete: interrupted", said)
            self.assertEqual((process.wait(), said.count("# exit"), said[-11:]), (130, 1, "# exit 130\n"))

    def test_a_stream_that_takes_no_more_fails_the_run(self):
        with open("/dev/full", "w") as full:
            done = self.piped("-", stdout=full)
        self.assertEqual(done.returncode, 1)
        self.assertIn("gearsim: standard output: No space left on device", done.stderr)
        reading, writing = os.pipe()
        os.close(reading)
        done = self.piped("-", stdout=writing)
        os.close(writing)
        self.assertEqual(done.returncode, 1)
        self.assertIn("gearsim: standard output: Broken pipe", done.stderr)

    def test_what_stands_in_a_file_before_is_not_cut(self):
        """A file that grows by several runs, and the disk takes no more of the second."""
        with open(self.path("all.csv"), "a") as file:
            file.write("before\n")
            file.flush()
            limited = f"ulimit -f 8; exec {shlex.quote(GEARSIM)} - --quiet --output -"
            done = subprocess.run(["bash", "-c", limited], input=PARAMS, text=True, stdout=file, cwd=self.folder,
                                  stderr=subprocess.PIPE, timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertTrue(self.read("all.csv").startswith("before\n# gearsim "))
        self.assertGreater(os.path.getsize(self.path("all.csv")), 8000)


class Template(Case):
    """A parameter file with comments, made of the table of keys."""

    def template(self, *kind):
        return self.accepted("--template", *kind).stdout

    def test_has_every_key_of_help(self):
        keys = re.findall(r"(?m)^  ([a-z]\w+) ", self.accepted("--help").stdout.split("\n[gears]\n")[1])
        self.assertGreater(len(keys), 60)
        template = self.template()
        for key in keys:
            self.assertRegex(template, rf"(?m)^(; )?{key} =")

    def test_each_kind_runs_as_it_stands_and_warns_of_nothing(self):
        for kind in [[], ["dynamic"], ["static"], ["speed"], ["torque"], ["simple"], ["3d"], ["iso6336"], ["elastic"]]:
            with self.subTest(kind):
                self.write("run.ini", self.template(*kind))
                done = self.accepted("run.ini", "--check")
                self.assertEqual(done.stderr, "")
                self.assertIn("static run" if kind == ["static"] else "dynamic run", done.stdout)

    def test_defaults_that_are_switched_on_change_nothing(self):
        """What is commented out with a value is the default of a key."""
        plain = self.template("speed")
        live = re.sub(r"(?m)^; ([a-z]\w* = [^;\n]*;)", r"\1", plain)
        self.assertGreater(live.count("\nscale = 1 "), 0)
        live = re.sub(r"(?m)^(pinion_\w*shape) =.*\n", "", live)  # without its amount: a warning
        live = re.sub(r"(?m)^(interpolation|repeat) =.*\n", "", live)  # without a file
        heads = []
        for text in (plain, live):
            self.write("run.ini", text)
            self.accepted("run.ini", "--set", "analysis.duration_s=0.001", "--output", "x.csv")
            heads.append([line for line in self.read("x.csv").splitlines() if "rack" not in line])
        self.assertEqual(*heads)

    def test_a_kind_has_no_key_that_it_does_not_use(self):
        self.assertNotRegex(self.template("static"), r"(?m)^(; )?(duration_s|end_rpm|wheel_inertia_kg_m2|seed) =")
        self.assertRegex(self.template("static"), r"(?m)^type = static ")
        self.assertRegex(self.template("torque"), r"(?m)^torque_Nm = ")
        self.assertRegex(self.template("speed"), r"(?m)^end_rpm = ")
        self.assertNotRegex(self.template("speed"), r"(?m)^(; )?torque_Nm =")
        self.assertEqual(self.template("static"), self.accepted("--template=static").stdout)

    def test_wrong_use(self):
        for arguments, fragment in [(["--template", "nonsense"], "must be dynamic | static | speed | torque | simple | 3d | "),
                                    (["--template=static", "run.ini"], "reads no file: run.ini"),
                                    (["--template", "--json"], "no other options"),
                                    (["--template", "--check"], "exclude each other"),
                                    (["--template", "--output", "x.ini"], "no other options")]:
            done = self.run_gearsim(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""), arguments)
            self.assertIn(fragment, done.stderr)


class Text(Case):
    """How the text of an INI file reads."""

    def test_a_missing_parameter_file_is_named(self):
        self.refused("run.ini: ", "No such file", params=None)

    def test_folder_in_place_of_the_file(self):
        os.mkdir(self.path("run.ini"))
        self.refused("run.ini: ", "folder", params=None)

    def test_empty_file_lacks_gears(self):
        text = self.refused("run.ini: gears.pinion_teeth: missing", "run.ini: gears.face_width_mm: missing", params="")
        self.assertNotIn("helix_angle_deg", text)

    def test_sparse_file_of_zeros_fails_at_once(self):
        self.write("run.ini", "")
        os.truncate(self.path("run.ini"), 2 << 30)
        self.refused("run.ini:1: ", "NUL byte", params=None)

    def test_nul_byte_is_an_error(self):
        self.refused("run.ini:3: ", "NUL byte", params=PARAMS.replace("wheel_teeth = 41", "wheel_teeth = 4\0001"))

    def test_control_character_is_an_error(self):
        self.refused("run.ini:3: ", "control character", params=PARAMS.replace("wheel_teeth", "wheel\x07teeth"))

    def test_line_too_long_is_an_error_and_never_split(self):
        for length in [300, 5000, 1 << 20]:
            with self.subTest(length):
                params = PARAMS.replace("[mesh]\n", "[flanks]\npinion = " + "a" * length + "\n[mesh]\n")
                self.refused("run.ini:15: ", "too long", params=params)

    def test_comment_too_long_for_the_reader_is_an_error(self):
        self.refused("run.ini:1: ", "too long: at most 4095", params="; " + "x" * 5000 + "\n" + PARAMS)

    def test_long_comment_is_no_long_line(self):
        self.write("run.ini", "; " + "x" * 4000 + "\n" + PARAMS.replace("= 45\n", "= 45 ; " + "y" * 3000 + "\n"))
        self.accepted("run.ini", "--check")

    def test_byte_order_mark_and_crlf_are_accepted(self):
        self.write("plain.ini", PARAMS)
        self.write("run.ini", b"\xef\xbb\xbf" + PARAMS.replace("\n", "\r\n").encode())
        plain = self.accepted("plain.ini", "--geometry").stdout
        self.assertIn("overlap_ratio = ", plain)
        self.assertEqual(self.accepted("run.ini", "--geometry").stdout, plain)

    def test_utf16_is_refused(self):
        self.write("run.ini", PARAMS.encode("utf-16"))
        self.refused("run.ini:1: ", "UTF-8", params=None)

    def test_comments_and_leading_white_space(self):
        self.write("plain.ini", PARAMS)
        lines = [f"  \t{line}\t# one = more ; of it" for line in PARAMS.split("\n")]
        self.write("run.ini", "; first\n\n#second\n" + "\n".join(lines))
        plain = self.accepted("plain.ini", "--geometry").stdout
        self.assertIn("overlap_ratio = ", plain)
        self.assertEqual(self.accepted("run.ini", "--geometry").stdout, plain)

    def test_line_without_equals_sign(self):
        self.refused("run.ini:14: ", "not understood", params=PARAMS.replace("[mesh]\n", "nonsense\n[mesh]\n"))

    def test_text_behind_a_section(self):
        self.refused("run.ini:14: ", "alone on its line", params=PARAMS.replace("[mesh]\n", "[mesh] x\n"))

    def test_key_before_any_section(self):
        self.refused("run.ini:1: ", "pinion_teeth", "without a section", params="pinion_teeth = 45\n")

    def test_a_key_without_value_is_not_given(self):
        """In the file and on the command line, and the last --set of a key wins."""
        params = PARAMS.replace("helix_angle_deg = 33", "helix_angle_deg =")
        self.write("spur.ini", with_key(params, "flanks", "pinion", "nowhere.csv"))
        spur = ["spur.ini", "--geometry", "--set", "gears.center_distance_mm=72"]
        self.assertIn("base_helix_angle_deg = 0\n", self.accepted(*spur).stdout)
        self.assertNotIn("base_helix_angle_deg = 0\n", self.accepted(*spur, "--set", "gears.helix_angle_deg=10").stdout)
        self.assertIn("base_helix_angle_deg = 0\n", self.accepted(*spur, "--set", "gears.helix_angle_deg=10", "--set",
                                                                  "gears.helix_angle_deg = ").stdout)
        self.write("run.ini", with_key(PARAMS, "flanks", "pinion", "nowhere.csv"))
        self.refused("nowhere.csv: ", params=None)
        self.assertEqual(self.accepted("run.ini", "--check", "--set", "flanks.pinion=").stderr, "")
        self.write("run.ini", with_key(PARAMS, "flanks", "pinion", ""))
        self.assertEqual(self.accepted("run.ini", "--check").stderr, "")
        self.refused("run.ini:3: flanks.pinion: repeated key", params="[flanks]\npinion =\npinion = a.csv\n")

    def test_empty_value(self):
        self.refused("run.ini:2: gears.pinion_teeth: missing, but required", params=PARAMS.replace("pinion_teeth = 45", "pinion_teeth ="))

    def test_last_line_needs_no_end(self):
        self.write("run.ini", PARAMS.rstrip("\n"))
        self.accepted("run.ini", "--check")


class Names(Case):
    def test_unknown_key_names_the_likely_one(self):
        params = PARAMS.replace("helix_angle_deg", "helix_angel_deg")
        self.refused("run.ini:6: gears.helix_angel_deg: unknown key", "did you mean helix_angle_deg?", params=params)

    def test_key_of_another_section_is_told(self):
        self.refused("run.ini:2: gears.duration_s: unknown key", "duration_s of [analysis]",
                     params=PARAMS.replace("[gears]\n", "[gears]\nduration_s = 1\n"))

    def test_names_are_case_sensitive(self):
        self.refused("run.ini:2: gears.Pinion_teeth: unknown key", "did you mean pinion_teeth?",
                     params=PARAMS.replace("pinion_teeth", "Pinion_teeth"))
        self.refused("run.ini:2: gears.PINION_TEETH: unknown key", "did you mean pinion_teeth?",
                     params=PARAMS.replace("pinion_teeth", "PINION_TEETH"))
        self.refused("run.ini:1: [Gears]: unknown section", "did you mean [gears]?",
                     params=PARAMS.replace("[gears]", "[Gears]"))

    def test_unknown_section(self):
        self.refused("run.ini:14: [mash]: unknown section", "did you mean [mesh]?",
                     params=PARAMS.replace("[mesh]", "[mash]"))

    def test_unknown_section_without_keys(self):
        line = 1 + PARAMS.count("\n")
        self.refused(f"run.ini:{line}: [nothing_like_it]: unknown section", params=PARAMS + "[nothing_like_it]\n")

    def test_repeated_section(self):
        line = 1 + PARAMS.count("\n")
        self.refused(f"run.ini:{line}: [mesh]: repeated section", "line 14", params=PARAMS + "[mesh]\n")

    def test_repeated_key(self):
        self.refused("run.ini:3: gears.pinion_teeth: repeated key", "line 2",
                     params=PARAMS.replace("pinion_teeth = 45\n", "pinion_teeth = 45\npinion_teeth = 45\n"))

    def test_missing_keys(self):
        for section, key, condition in [("gears", "pinion_teeth", ""), ("gears", "wheel_teeth", ""),
                                        ("gears", "normal_module_mm", ""), ("gears", "normal_pressure_angle_deg", ""),
                                        ("gears", "center_distance_mm", ""), ("gears", "face_width_mm", ""),
                                        ("load", "mean_Nm", "for a run"),
                                        ("bodies", "wheel_inertia_kg_m2", "for a dynamic run"),
                                        ("drive", "start_rpm", "for drive.kind = speed"),
                                        ("drive", "end_rpm", "for drive.kind = speed"),
                                        ("analysis", "duration_s", "for a dynamic run")]:
            with self.subTest(key):
                self.refused(f"run.ini: {section}.{key}: missing", condition, f"[{section}]",
                             params=without_key(PARAMS, key))

    def test_torque_drive_needs_torque_and_pinion_inertia(self):
        text = self.refused("run.ini: drive.torque_Nm: missing, but required for drive.kind = torque",
                            "run.ini: bodies.pinion_inertia_kg_m2: missing",
                            params=without_key(without_key(PARAMS, "start_rpm"), "end_rpm"),
                            arguments=["--set", "drive.kind=torque"])
        self.assertNotIn("_rpm", text)

    def test_missing_section(self):
        self.refused("run.ini: analysis.duration_s: missing", "[analysis]",
                     params=PARAMS.replace("[analysis]\n", "").replace("duration_s = 0.01\n", ""))

    def test_geometry_needs_gears_only(self):
        self.write("run.ini", PARAMS[:PARAMS.index("[mesh]")])
        text = self.accepted("run.ini", "--geometry").stdout
        self.assertRegex(text, r"mesh_stiffness_N_per_um = [\d.]+, [\d.]+, [\d.]+\n")  # of elastic teeth
        self.assertNotIn("eigenfrequency", text)
        self.assertIn("mesh_frequency_per_rpm_Hz = 0.75\n", text)
        self.refused("run.ini: load.mean_Nm: missing", params=None)
        self.refused("run.ini: gears.wheel_teeth: missing", arguments=["--geometry"],
                     params=without_key(PARAMS, "wheel_teeth"))

    def test_geometry_opens_no_flank_file(self):
        self.write("run.ini", with_key(PARAMS, "flanks", "pinion", "none.csv"))
        self.assertEqual(self.accepted("run.ini", "--geometry").stderr, "")

    def test_keys_that_are_not_used_are_warned_of(self):
        self.write("run.ini", with_key(PARAMS, "drive", "torque_Nm", "20"))
        line = line_of(self.read("run.ini"), "torque_Nm")
        warning = f"run.ini:{line}: drive.torque_Nm: warning: not used with drive.kind = speed\n"
        self.assertEqual(self.accepted("run.ini", "--check").stderr, warning)
        self.assertEqual(self.accepted("run.ini", "--check", "--quiet").stderr, "")

        self.write("run.ini", PARAMS)
        for arguments, name, reason in [(["analysis.positions=3"], "analysis.positions", "analysis.type = dynamic"),
                                        (["mesh.simple_stiffness_N_per_m=1e8"], "mesh.simple_stiffness_N_per_m",
                                         "mesh.model = 3d"),
                                        (["mesh.model=simple", "flanks.scale=2"], "flanks.scale", "mesh.model = simple"),
                                        (["mesh.model=simple", "solver.lookup=on"], "solver.lookup", "mesh.model = simple"),
                                        (["analysis.type=static"], "analysis.duration_s", "analysis.type = static"),
                                        (TORQUE[1::2], "drive.end_rpm", "drive.kind = torque")]:
            with self.subTest(name):
                options = [part for argument in arguments for part in ("--set", argument)]
                text = self.accepted("run.ini", "--check", *options).stderr
                self.assertIn(f"{name}: warning: not used with {reason}\n", text)


class Values(Case):
    def test_what_is_no_number(self):
        for value in ["much", "nan", "inf", "-infinity", "0x10", "1.5mm", "1,65", "1.65,", "1 2", "1e", ".", "+-1", "1e5.5",
                      "--1", "1d3"]:
            with self.subTest(value):
                self.refused_value("gears", "normal_module_mm", value, "must be a number ")

    def test_decimal_comma_is_told(self):
        self.refused_value("gears", "normal_module_mm", "1,65", "decimal point")

    def test_number_beyond_double(self):
        self.refused_value("load", "mean_Nm", "1e400", "must be below 1.8e308")
        self.refused_value("load", "mean_Nm", "-1e400", "must be above -1.8e308")

    def test_characters_that_look_like_a_number_are_named(self):
        for value, code in (("\u22125", "2212"), ("5\u00a0", "00A0"), ("\U0001d7d7", "1D7D7"), ("1\u0660", "0660")):
            self.refused_value("load", "mean_Nm", value, f"without the character U+{code} (got ")

    def test_plain_numbers_are_accepted(self):
        self.write("run.ini", PARAMS)
        for value in ["17.5", "+17.5", "1.75e1", "1.75E+01", "175e-1", "0017.5", "17.50000000000000000000000000000000001"]:
            text = self.accepted("run.ini", "--geometry", "--set", f"gears.face_width_mm={value}").stdout
            self.assertIn("overlap_ratio = 1.83870897686087", text)
        for value in [".5", "5."]:
            self.accepted("run.ini", "--check", "--set", f"gears.face_width_mm={value}")

    def test_rings_that_cannot_be(self):
        ring = PARAMS
        for key, value in [("normal_module_mm", 2), ("normal_pressure_angle_deg", 20), ("helix_angle_deg", 0)]:
            ring = with_key(ring, "gears", key, value)
        for key in ("pinion_tip_diameter_mm", "wheel_tip_diameter_mm"):
            ring = without_key(ring, key)
        for pinion, wheel, fragments in [
                (20, -40, ["gears.wheel_tip_diameter_mm: must be a larger diameter", "(involute interference)"]),
                (60, -66, ["gears.wheel_teeth: must be a ring with more teeth", "(trochoid interference) (got -66)"]),
                (60, -72, ["gears.wheel_teeth: must be a ring with more teeth", "(trimming) (got -72)"]),
                (60, -50, ["gears.wheel_teeth: must be a ring with more teeth than the pinion (got -50)"]),
                (60, -60, ["gears.wheel_teeth: must be a ring with more teeth than the pinion (got -60)"])]:
            with self.subTest(pinion=pinion, wheel=wheel):
                text = ring
                for key, value in [("pinion_teeth", pinion), ("wheel_teeth", wheel),
                                   ("center_distance_mm", abs(wheel + pinion) or 1)]:
                    text = with_key(text, "gears", key, value)
                self.refused(*fragments, params=text, arguments=["--check"])

    def test_values_out_of_range_are_refused(self):
        for section, key, values, requirement in [
                ("gears", "pinion_teeth", ["0", "-45", "2", "100001"], "from 3 to 100000"),
                ("gears", "wheel_teeth", ["0", "-2", "2", "-100001"], "from 3 to 100000, or from -100000 to -3"),
                ("gears", "normal_module_mm", ["0", "-1.65", "1e-400", "0.9e-3", "1.1e12"], "from 0.001 to 1e+12"),
                ("gears", "face_width_mm", ["0", "-1", "1e300"], "from 0.001 to 1e+12"),
                ("gears", "center_distance_mm", ["0", "-85", "1e80"], "from 0.001 to 1e+12"),
                ("gears", "pinion_tip_diameter_mm", ["0", "1e80"], "from 0.002 to 2e+12"),
                ("gears", "wheel_tip_diameter_mm", ["0", "1e80"], "from 0.002 to 2e+12"),
                ("gears", "pinion_start_diameter_mm", ["0", "1e80"], "from 0.002 to 2e+12"),
                ("gears", "wheel_start_diameter_mm", ["0", "1e80"], "from 0.002 to 2e+12"),
                ("gears", "pinion_profile_shift", ["1001", "-1e300"], "from -1000 to 1000"),
                ("gears", "wheel_profile_shift", ["1001", "-1e300"], "from -1000 to 1000"),
                ("gears", "backlash_um", ["-1e16", "1e300"], "from -1e+15 to 1e+15"),
                ("gears", "normal_pressure_angle_deg", ["0", "-20", "45"], "between 0 and 45"),
                ("gears", "helix_angle_deg", ["90", "60", "-60"], "between -60 and 60"),
                ("mesh", "stiffness_N_per_m", ["0", "-1e8", "1.1e15", "1e300"], "from 0.001 to 1e+15"),
                ("mesh", "simple_stiffness_N_per_m", ["0", "1e300"], "from 0.001 to 1e+15"),
                ("mesh", "damping_Ns_per_m", ["-1", "1e300"], "from 0 to 1e+15"),
                ("bodies", "wheel_inertia_kg_m2", ["0", "-2e-3", "1e-16", "1e300"], "from 1e-15 to 1e+12"),
                ("bodies", "pinion_inertia_kg_m2", ["0", "-2e-3", "1e300"], "from 1e-15 to 1e+12"),
                ("bodies", "pinion_drag_Nms", ["-1e-3", "1e300"], "from 0 to 1e+12"),
                ("bodies", "wheel_drag_Nms", ["-1e-3", "1e300"], "from 0 to 1e+12"),
                ("load", "per_speed_Nms", ["-1e-3", "1e300"], "from 0 to 1e+12"),
                ("load", "per_speed_squared_Nms2", ["-1e-3", "1e300"], "from 0 to 1e+12"),
                ("drive", "torque_Nm", ["1.1e12", "-1e300"], "from -1e+12 to 1e+12"),
                ("load", "noise_amplitude_Nm", ["-1", "1e300"], "from 0 to 1e+12"),
                ("load", "noise_interval_s", ["0", "-1", "1e300"], "from 1e-09 to 1e+09"),
                ("flanks", "profile_blend", ["-0.1", "1e300"], "from 0 to 1000"),
                ("flanks", "profile_from", ["-0.1", "1.1"], "from 0 to 1"),
                ("flanks", "profile_to", ["-0.1", "1.1"], "from 0 to 1"),
                ("modifications", "tolerance_um", ["0", "1e300"], "from 1e-05 to 10000"),
                ("analysis", "duration_s", ["0", "-1", "1e300"], "from 1e-09 to 1e+09"),
                ("analysis", "positions", ["0", "-5"], "from 1"),
                ("solver", "relative_tolerance", ["-1e-9", "1.1"], "from 0 to 1"),
                ("solver", "absolute_tolerance_um", ["0", "-1", "1e300"], "from 1e-12 to 1000000"),
                ("solver", "max_step_s", ["-1", "1e300"], "from 0 to 1e+09"),
                ("solver", "lookup_depth_um", ["0", "-20", "0.9e-3", "1e300"], "from 0.001 to 1000000"),
                ("solver", "lookup_threads", ["-1", "65"], "from 0 to 64"),
                ("output", "rate_Hz", ["0", "-1", "1e300"], "from 1e-09 to 1e+12"),
                ("output", "oversampling", ["0", "65"], "from 1 to 64"),
                ("output", "digits", ["2", "18"], "from 3 to 17")]:
            for value in values:
                with self.subTest(f"{section}.{key} = {value}"):
                    self.refused_value(section, key, value, f"must be {requirement}", f" (got {value})")

    def test_bounds_that_are_allowed(self):
        self.write("run.ini", PARAMS)
        for override in ["flanks.profile_from=0", "flanks.profile_to=1", "flanks.profile_blend=0", "mesh.damping_Ns_per_m=0",
                         "solver.relative_tolerance=0", "solver.max_step_s=0", "output.oversampling=1",
                         "output.oversampling=64", "output.digits=3", "output.digits=17", "load.mean_Nm=-20",
                         "load.mean_Nm=0", "flanks.scale=-3", "drive.start_rpm=-100", "drive.end_rpm=0"]:
            with self.subTest(override):
                self.accepted("run.ini", "--check", "--set", override)

    def test_whole_numbers_take_no_fraction(self):
        for section, key, requirement in [("gears", "pinion_teeth", "from 3 to 100000"),
                                          ("output", "oversampling", "from 1 to 64"), ("output", "digits", "from 3 to 17"),
                                          ("analysis", "positions", "from 1 to 100000000")]:
            for value in ["10.5", "0.5", "1000000000.5"]:
                with self.subTest(key, value=value):
                    self.refused_value(section, key, value, "must be a whole number " + requirement)

    def test_seed_is_an_unsigned_64_bit_integer(self):
        self.write("run.ini", PARAMS)
        for value in ["0", "1", "18446744073709551615"]:
            self.accepted("run.ini", "--check", "--set", f"load.seed={value}")
        for value in ["18446744073709551616", "99999999999999999999999"]:
            self.refused_value("load", "seed", value, "must be a whole number from 0 to 18446744073709551615")
        for value in ["-1", "1.5", "1e3", "0x1", "one", "-0"]:
            self.refused_value("load", "seed", value, "from 0 to 18446744073709551615")

    def test_other_choices_are_refused(self):
        for section, key, choices in [("gears", "base_helix", "iso | paper"), ("mesh", "model", "simple | 3d"),
                                      ("flanks", "deviation_direction", "normal | transverse"),
                                      ("drive", "kind", "speed | torque"), ("analysis", "type", "dynamic | static"),
                                      ("analysis", "period", "mesh | pinion | hunting"),
                                      ("solver", "method", "bdf | adams"), ("solver", "lookup", "off | on | auto | always")]:
            for value in ["other", "3D"]:
                with self.subTest(f"{key} = {value}"):
                    self.refused_value(section, key, value, f"must be {choices}")

    def test_profile_window_must_not_be_empty(self):
        params = with_key(PARAMS, "flanks", "profile_from", "0.7")
        line = line_of(params, "profile_from")
        for upper in ["0.7", "0.2"]:
            self.refused(f"run.ini:{line}: flanks.profile_from: ", "flanks.profile_to", f"0.7 and {upper}", params=params,
                         arguments=["--set", f"flanks.profile_to={upper}"])

    def test_number_of_rows_is_bounded(self):
        self.refused("--set output.rate_Hz: ", "must give at most 1e+09 rows", "(got 1e+12", arguments=["--set", "output.rate_Hz=1e12"])

    def test_noise_must_be_countable(self):
        self.refused("--set load.noise_interval_s: ", "must be at least 1e-15 of analysis.duration_s (got 1e-09)",
                     arguments=["--set", "load.noise_interval_s=1e-9", "--set", "analysis.duration_s=1e9",
                                "--set", "output.rate_Hz=0.1"])

    def test_static_analysis_needs_load_and_the_3d_model(self):
        static = ["--set", "analysis.type=static"]
        self.refused("--set load.mean_Nm: ", "(got 0)", "must not be 0", arguments=static + ["--set", "load.mean_Nm=0"])
        params = with_key(PARAMS, "mesh", "model", "simple")
        self.refused(f"run.ini:{line_of(params, 'model')}: mesh.model: ", "(got simple)", "must be 3d", params=params,
                     arguments=static)

    def test_loads_of_a_static_analysis_fit_together(self):
        static = ["--set", "analysis.type=static", "--set", "analysis.loads=2"]
        self.refused("--set analysis.loads: ", "must be 1 without load.end_Nm (got 2)", arguments=static)
        self.refused("--set load.mean_Nm: ", "must not be 0",
                     arguments=static + ["--set", "load.mean_Nm=0", "--set", "load.end_Nm=0"])
        self.refused("--set analysis.loads: ", "must give at most 1e+09 rows (got 1000000 loads with 100000000 positions)",
                     arguments=static + ["--set", "analysis.loads=1000000", "--set", "load.end_Nm=5", "--set",
                                         "analysis.positions=100000000"])
        self.write("run.ini", PARAMS)
        result = self.accepted("run.ini", "--check", "--set", "analysis.type=static", "--set", "load.end_Nm=5")
        self.assertIn("--set load.end_Nm: warning: not used with analysis.loads = 1\n", result.stderr)

    def test_corners_go_with_rigid_flanks_alone(self):
        corner = ["--set", "mesh.corner_contact=on"]
        few = ["gears.pinion_teeth=8", "gears.center_distance_mm=49", "gears.pinion_tip_diameter_mm="]
        self.refused("--set mesh.corner_contact: ", "a tip reaches to the base circle of its mate",
                     arguments=corner + [word for text in few for word in ("--set", text)])
        self.write("run.ini", PARAMS)
        self.accepted("run.ini", "--check", *corner, "--set", "mesh.friction_coefficient=0.1")
        self.accepted("run.ini", "--check", *corner, "--set", "solver.lookup=always")
        result = self.accepted("run.ini", "--check", *corner, "--set", "mesh.model=simple")
        self.assertIn("--set mesh.corner_contact: warning: not used with mesh.model = simple\n", result.stderr)

    def test_lookup_needs_helical_gears_and_stays_within_a_tooth(self):
        spur = ["--set", "gears.helix_angle_deg=0", "--set", "gears.center_distance_mm=71.5"]
        for key in ("pinion", "wheel"):
            spur += ["--set", f"gears.{key}_tip_diameter_mm=" + ("77.6" if key == "pinion" else "71.0")]
        lookup = ["--set", "solver.lookup=always"]
        self.refused("--set solver.lookup: ", "(got always)", "must be off, on or auto", "spur gears have no tables",
                     arguments=spur + lookup)
        self.write("run.ini", PARAMS)
        self.accepted("run.ini", "--check", *spur)
        self.accepted("run.ini", "--check", *spur, "--set", "solver.lookup=on")
        self.accepted("run.ini", "--geometry", *spur, *lookup)
        self.accepted("run.ini", "--check", *lookup)
        for use in ("on", "always"):
            self.refused("--set solver.lookup_depth_um: ", "(got 2000)", "at most a quarter of the base pitch, 14",
                         arguments=["--set", f"solver.lookup={use}", "--set", "solver.lookup_depth_um=2000"])
        self.accepted("run.ini", "--check", "--set", "solver.lookup_depth_um=2000")

    def test_many_faults_are_told_at_once_but_not_all(self):
        text = self.refused("run.ini:2: ", "run.ini:4: ",
                            params=PARAMS.replace("= 45", "= x").replace("= 1.65", "= y"))
        self.assertEqual(text.count("\n"), 2)
        junk = "[gears]\n" + "".join(f"junk{i} = 1\n" for i in range(1000))
        self.assertEqual(self.refused("run.ini: and 980 more\n", params=junk).count("\n"), 21)


class Geometry(Case):
    """Gear pairs that cannot be, doubtful ones, and the listing."""

    def listing(self, *arguments, params=PARAMS):
        self.write("run.ini", params)
        lines = self.accepted("run.ini", "--geometry", *arguments).stdout.splitlines()
        return {name: float(value.partition(",")[0]) for name, value in (line.split(" = ") for line in lines)}

    def test_impossible_pairs_name_the_key(self):
        # Base radii 41.886 and 38.163 mm, so that the axes must be more than 80.049 mm apart.
        for key, value, requirement in [("center_distance_mm", "80.048", "base radii"),
                                        ("pinion_tip_diameter_mm", "83.7", "larger than the base diameter"),
                                        ("wheel_tip_diameter_mm", "76.3", "larger than the base diameter"),
                                        ("pinion_start_diameter_mm", "93.9", "smaller than the tip diameter"),
                                        ("wheel_start_diameter_mm", "86.1", "smaller than the tip diameter"),
                                        ("backlash_um", "1e5", "thicker than 0"),
                                        ("pinion_tip_diameter_mm", "84", "reach each other")]:
            with self.subTest(key):
                self.refused_value("gears", key, value, requirement, "83.771857 and 76.3254697 mm")

    def test_derived_field_at_fault_is_told_without_line(self):
        # Tip diameters are derived here: too small at this center distance for the teeth to meet.
        params = without_key(without_key(without_key(PARAMS, "pinion_tip_diameter_mm"), "wheel_tip_diameter_mm"),
                             "backlash_um")
        self.refused("run.ini: gears.pinion_tip_diameter_mm: ", "(got none, so it is derived)", params=params,
                     arguments=["--set", "gears.center_distance_mm=100", "--set", "gears.pinion_profile_shift=0", "--set",
                                "gears.wheel_profile_shift=0"])

    def warnings(self, *overrides):
        self.write("run.ini", PARAMS)
        options = [part for override in overrides for part in ("--set", "gears." + override)]
        self.assertEqual(self.accepted("run.ini", "--geometry", "--quiet", *options).stderr, "")
        return self.accepted("run.ini", "--geometry", *options).stderr

    def test_doubtful_gears_are_warned_of_with_numbers(self):
        self.assertEqual(self.warnings(), "")
        self.assertRegex(self.warnings("backlash_um=-20"), r"--set gears\.backlash_um: warning: .* -20 um, negative")
        self.assertRegex(self.warnings("wheel_tip_diameter_mm=80"),
                         r"run\.ini:7: gears\.center_distance_mm: warning: the transverse contact ratio is 0\.\d+, below 1")
        self.assertRegex(self.warnings("pinion_tip_diameter_mm=95.6"),
                         r"gears\.pinion_tip_diameter_mm: warning: .* 0\.\d+ normal modules thick .* 95\.6 mm, less than 0\.2")
        self.assertRegex(self.warnings("wheel_tip_diameter_mm=88.8"),
                         r"gears\.wheel_tip_diameter_mm: warning: pointed tip: .* 88\.8 mm")
        self.assertRegex(self.warnings("pinion_teeth=8", "center_distance_mm=40.5", "helix_angle_deg=0",
                                     "pinion_tip_diameter_mm=16.5", "wheel_tip_diameter_mm=70.9"),
                         r"gears\.pinion_teeth: warning: undercut: .* \(8 teeth, profile shift ")
        self.assertRegex(self.warnings("wheel_start_diameter_mm=77"),
                         r"gears\.wheel_start_diameter_mm: warning: .* diameter of 77 mm, below the root form")

    # A catalogue's pair: 12/24 teeth whose shifts ask for 0.38 mm more distance than there is.
    CATALOGUE = ("[gears]\npinion_teeth = 12\nwheel_teeth = 24\nnormal_module_mm = 3\nnormal_pressure_angle_deg = 20\n"
                 "center_distance_mm = 56.5\nface_width_mm = 30\npinion_profile_shift = 0.6\nwheel_profile_shift = 0.36\n")

    def test_default_tips_keep_their_clearance(self):
        # k m_n = 56.5 - 54 - 3 * 0.96 mm, tip = 18 + 3 * 1.6 + k m_n, root = 36 - 3 (1.25 - 0.36).
        values = self.listing(params=self.CATALOGUE)
        for name, expected in [("pinion_tip_alteration", -0.38 / 3), ("wheel_tip_alteration", -0.38 / 3),
                               ("pinion_tip_radius_mm", 22.42), ("wheel_tip_radius_mm", 39.7),
                               ("pinion_root_radius_mm", 16.05), ("wheel_root_radius_mm", 33.33),
                               ("pinion_tip_clearance_mm", 0.75), ("wheel_tip_clearance_mm", 0.75),
                               ("pinion_working_pitch_radius_mm", 56.5 / 3), ("wheel_working_pitch_radius_mm", 113 / 3),
                               ("gear_ratio", 2), ("face_width_mm", 30)]:
            with self.subTest(name):
                self.assertAlmostEqual(values[name], expected, delta=1e-12 * 60)
        self.assertAlmostEqual(values["transverse_contact_ratio"], 1.202, delta=0.5e-3)
        # s_ta = r_a (s_t / r + 2 inv(alpha_t) - 2 inv(alpha_a))
        self.assertAlmostEqual(values["pinion_tip_thickness_mm"], self.tip_thickness(18, 22.42, 0.6), delta=1e-12)
        self.assertAlmostEqual(values["wheel_tip_thickness_mm"], self.tip_thickness(36, 39.7, 0.36), delta=1e-12)

    @staticmethod
    def tip_thickness(reference_mm, tip_mm, shift):
        def involute(angle):
            return math.tan(angle) - angle

        alpha = math.radians(20)
        thickness = 3 * (math.pi / 2 + 2 * shift * math.tan(alpha))
        alpha_tip = math.acos(reference_mm * math.cos(alpha) / tip_mm)
        return tip_mm * (thickness / reference_mm + 2 * involute(alpha) - 2 * involute(alpha_tip))

    def test_small_tip_clearance_is_warned_of_with_the_tip_that_would_do(self):
        self.write("run.ini", self.CATALOGUE)
        full = ["--set", "gears.pinion_tip_alteration=0", "--set", "gears.wheel_rack_addendum=0.85"]
        text = self.accepted("run.ini", "--geometry", *full).stderr
        # 0.25 - 0.38 / 3 is above 0.1; with another 0.05 of addendum it is not.
        self.assertEqual(text, "")
        full += ["--set", "gears.pinion_rack_addendum=1.05"]
        text = self.accepted("run.ini", "--geometry", *full).stderr
        self.assertRegex(text, r"(?m)^run\.ini: gears\.pinion_tip_diameter_mm: warning: the tip clearance to the root of the wheel is "
                               r"0\.073 normal modules, less than 0\.1: a tip alteration of -0\.1767 \(tip diameter 44\.840000 mm\) "
                               r"would leave 0\.25; if the root is deeper, give gears\.wheel_rack_dedendum\n$")
        again = self.accepted("run.ini", "--geometry", *full, "--set", "gears.pinion_tip_alteration=-0.1767",
                              "--set", "gears.wheel_rack_dedendum=1.3")
        self.assertEqual(again.stderr, "")

    def test_tip_alteration_beside_a_tip_diameter_is_not_used(self):
        for gear in ["pinion", "wheel"]:
            text = self.warnings(f"{gear}_tip_alteration=-0.1")
            self.assertEqual(text, f"--set gears.{gear}_tip_alteration: warning: not used, as gears.{gear}_tip_diameter_mm gives "
                                   "the tip\n")
        self.assertEqual(self.listing("--set", "gears.pinion_tip_alteration=-0.1"), self.listing())

    def test_rounded_shifts_are_noted(self):
        # The published shifts of the third stage of the NREL 5 MW gearbox leave -0.11 um; 1e-4 modules are 1.4 um.
        pair = ("[gears]\npinion_teeth = 24\nwheel_teeth = 95\nnormal_module_mm = 14\nnormal_pressure_angle_deg = 20\n"
                "helix_angle_deg = 10\ncenter_distance_mm = 861\nface_width_mm = 360\npinion_profile_shift = 0.48\n"
                "wheel_profile_shift = 0.6691\n")
        self.write("run.ini", pair)
        result = self.accepted("run.ini", "--geometry")
        self.assertRegex(result.stderr, r"^run\.ini: gears\.backlash_um: note: the backlash is -0\.114 um, .* rounded profile shifts\n$")
        self.assertEqual(self.accepted("run.ini", "--geometry", "--quiet").stderr, "")
        values = self.listing(params=pair)
        self.assertLess(values["backlash_um"], -0.1)  # no number changes
        self.assertAlmostEqual(values["transverse_contact_ratio"], 1.463, delta=0.5e-3)
        text = self.accepted("run.ini", "--geometry", "--set", "gears.wheel_profile_shift=0.6693").stderr
        self.assertRegex(text, r"warning: the backlash is -2\.\d+ um, negative")

    def test_faces_of_their_own(self):
        own = "pinion_face_width_mm = 26\nwheel_face_width_mm = 32\naxial_offset_mm = -1.5\n"
        params = PARAMS.replace("face_width_mm = 17.5\n", own)
        self.assertEqual(self.listing(params=params)["face_width_mm"], 26)
        self.assertEqual(self.listing(params=params.replace("-1.5", "6"))["face_width_mm"], 23)
        narrow = self.listing("--set", "gears.axial_offset_mm=2.5")
        self.assertAlmostEqual(narrow["face_width_mm"], 15, delta=1e-14)
        self.assertAlmostEqual(narrow["overlap_ratio"], self.listing()["overlap_ratio"] * 15 / 17.5, delta=1e-14)
        self.refused("run.ini: gears.face_width_mm: missing", params=params.replace("wheel_face_width_mm = 32\n", ""))

    def test_faces_that_contradict_each_other(self):
        self.refused("run.ini:8: gears.face_width_mm: ", "(got 17.5)", "no larger than the face of either gear",
                     "the faces are: pinion 0 to 15 mm, wheel -1.25 to 16.25 mm", arguments=["--set", "gears.pinion_face_width_mm=15"])
        self.refused("run.ini:8: gears.face_width_mm: ", "(got 17.5)", "both gears share",
                     arguments=["--set", "gears.pinion_face_width_mm=20", "--set", "gears.wheel_face_width_mm=20"])
        self.refused_value("gears", "axial_offset_mm", "17.5", "faces of both gears overlap")
        self.refused_value("gears", "axial_offset_mm", "-1e13", "from -1e+12 to 1e+12")

    def test_double_helical_pairs(self):
        halves = ["--set", "gears.double_helical_gap_mm=2.5"]
        whole, half = self.listing(), self.listing(*halves)
        self.assertEqual(half["face_width_mm"], 17.5)
        self.assertAlmostEqual(half["half_face_width_mm"], 7.5, delta=1e-13)
        self.assertAlmostEqual(half["overlap_ratio"], whole["overlap_ratio"] * 7.5 / 17.5, delta=1e-13)
        for name in ("mean_mesh_stiffness_N_per_um", "eigenfrequency_Hz"):
            self.assertAlmostEqual(half[name] / whole[name], 1, delta=1e-14)
        self.assertNotIn("half_face_width_mm", whole)

        # What cannot be.
        key = "--set gears.double_helical_gap_mm: "
        for gap in ("17.5", "17.4999"):
            self.refused(key, f"must leave teeth on both sides: less than the common face width, 17.5 (got {gap})",
                         arguments=["--set", f"gears.double_helical_gap_mm={gap}"])
        self.refused_value("gears", "double_helical_gap_mm", "-1", "from 0 to 1e+12")
        self.refused("--set gears.axial_offset_mm: ", "must be 0 with gears.double_helical_gap_mm", "(got 1)",
                     arguments=[*halves, "--set", "gears.axial_offset_mm=1"])
        self.refused("--set gears.helix_angle_deg: ", "must not be 0 with gears.double_helical_gap_mm",
                     arguments=[*halves, "--set", "gears.helix_angle_deg=0", "--set", "gears.center_distance_mm=71.5",
                                "--set", "gears.pinion_tip_diameter_mm=77.6", "--set", "gears.wheel_tip_diameter_mm=71"])
        self.refused("--set solver.lookup: ", "double-helical pairs have no tables", "(got always)",
                     arguments=[*halves, "--set", "solver.lookup=always"])
        self.refused("flanks.wheel_second_half_pitch: ", "names this file",
                     arguments=[*halves, "--set", "flanks.wheel_second_half_pitch=none.csv"])
        self.refused("flanks.pinion_second_half: ", "names this file",
                     arguments=[*halves, "--set", "flanks.pinion_second_half=none.csv"])

        # What does nothing.
        self.write("run.ini", PARAMS)
        text = self.accepted("run.ini", "--check", *halves, "--set", "pose.axial_shift_um=5").stderr
        self.assertIn("--set pose.axial_shift_um: warning: changes nothing with gears.double_helical_gap_mm", text)
        text = self.accepted("run.ini", "--geometry", "--set", "flanks.pinion_second_half=none.csv").stderr
        self.assertIn("--set flanks.pinion_second_half: warning: not used with one helix", text)

    def test_the_limit_of_a_pose_is_told_and_holds(self):
        for key, amount, others in [("center_distance_change_um", 6000, []), ("center_distance_change_um", -2000, []),
                                    ("offset_um", 40000, []), ("axial_shift_um", -17500, []), ("skew_mrad", 60, ["inclination_mrad=3"]),
                                    ("inclination_mrad", -100, ["gears.double_helical_gap_mm=2", "mesh.law=iso6336"])]:
            more = [text if "." in text.split("=")[0] else f"pose.{text}" for text in others]
            arguments = [part for text in [f"pose.{key}={amount}", *more] for part in ("--set", text)]
            self.write("run.ini", without_key(PARAMS, "stiffness_N_per_m") if "mesh.law=iso6336" in others else PARAMS)
            said = self.run_gearsim("run.ini", "--check", *arguments)
            self.assertEqual(said.returncode, 2)
            self.assertIn("here up to", said.stderr, arguments)
            limit = float(re.search(r"over the face; here up to (\S+) \(got", said.stderr).group(1))
            self.assertLess(0, limit / amount)

            # That will do, and a hundredth more will not.
            for factor, code in ((1.0, 0), (1.011, 2)):
                arguments[1] = f"pose.{key}={factor * limit!r}"
                self.assertEqual(self.run_gearsim("run.ini", "--check", *arguments).returncode, code, (arguments, factor))

    def test_pose_out_of_mesh(self):
        for key, amount in [("center_distance_change_um", 6000), ("center_distance_change_um", -2000), ("offset_um", 40000),
                            ("axial_shift_um", -17500), ("skew_mrad", 60), ("inclination_mrad", -60)]:
            self.refused(f"pose.{key}: must leave the gears in mesh", f"(got {amount})",
                         arguments=["--set", f"pose.{key}={amount}", "--set", "pose.axial_shift_um=1"]
                         if key != "axial_shift_um" else ["--set", f"pose.{key}={amount}"])

    def test_zero_backlash_is_not_taken_for_negative(self):
        # These leave -5e-14 and -1e-14 um where the profile shifts are derived for zero.
        self.write("run.ini", without_key(PARAMS, "backlash_um"))
        for distance in ["85", "84.7"]:
            result = self.accepted("run.ini", "--geometry", "--set", f"gears.center_distance_mm={distance}")
            self.assertEqual(result.stderr, "")

    def test_listing_has_finite_numbers_only(self):
        for stiffness, inertia in [["1e15", "1e-15"], ["1e-3", "1e12"]]:
            values = self.listing("--set", f"mesh.stiffness_N_per_m={stiffness}", "--set", f"bodies.wheel_inertia_kg_m2={inertia}")
            self.assertTrue(all(math.isfinite(value) for value in values.values()))
            self.assertGreater(values["eigenfrequency_Hz"], 0)

    def test_start_below_the_base_circle_is_the_base_circle(self):
        text = self.warnings("pinion_start_diameter_mm=80")
        self.assertRegex(text, r"gears\.pinion_start_diameter_mm: warning: below the base circle .* 83\.7719 mm is taken")
        values = self.listing("--set", "gears.pinion_start_diameter_mm=80")
        self.assertEqual(values["pinion_start_radius_mm"], values["pinion_base_radius_mm"])

    def test_names_and_order_of_the_listing(self):
        names = """transverse_module_mm, transverse_pressure_angle_deg, working_pressure_angle_deg, base_helix_angle_deg,
            reference_center_distance_mm, pinion_profile_shift, wheel_profile_shift, pinion_base_radius_mm,
            wheel_base_radius_mm, pinion_tip_radius_mm, wheel_tip_radius_mm, pinion_start_radius_mm,
            wheel_start_radius_mm, transverse_base_pitch_mm, line_of_action_mm, path_start_mm, path_end_mm,
            transverse_contact_ratio, overlap_ratio, total_contact_ratio, backlash_um, pinion_working_pitch_radius_mm,
            wheel_working_pitch_radius_mm, pinion_tip_clearance_mm, wheel_tip_clearance_mm, pinion_root_radius_mm,
            wheel_root_radius_mm, pinion_tip_thickness_mm, wheel_tip_thickness_mm, pinion_tip_alteration,
            wheel_tip_alteration, gear_ratio, face_width_mm, mean_mesh_stiffness_N_per_um,
            eigenfrequency_Hz, mesh_frequency_per_rpm_Hz"""
        self.assertEqual(list(self.listing()), [name.strip() for name in names.split(",")])

    def test_reference_gear(self):
        # Derived by independent code in 40 digits, rounded for the documentation of data/paper/.
        values = self.listing()
        for name, expected in [("transverse_contact_ratio", "2.123601"), ("overlap_ratio", "1.838709"),
                               ("total_contact_ratio", "3.962310"), ("pinion_base_radius_mm", "41.885928"),
                               ("wheel_base_radius_mm", "38.162735"), ("transverse_base_pitch_mm", "5.848379"),
                               ("path_start_mm", "8.764840"), ("path_end_mm", "21.184463"),
                               ("line_of_action_mm", "28.586911"), ("pinion_start_radius_mm", "42.793147"),
                               ("wheel_start_radius_mm", "38.874035"), ("mean_mesh_stiffness_N_per_um", "222.98"),
                               ("eigenfrequency_Hz", "1979.16"), ("base_helix_angle_deg", "31.57005"),
                               ("working_pressure_angle_deg", "19.65262"), ("transverse_pressure_angle_deg", "18.87580"),
                               ("reference_center_distance_mm", "84.598176"), ("backlash_um", "100.0000000"),
                               ("mesh_frequency_per_rpm_Hz", "0.7500000000")]:
            with self.subTest(name):
                # Half a unit in the last place, and a little for tips that are themselves rounded.
                unit = 10.0 ** -len(expected.split(".")[1])
                self.assertLessEqual(abs(values[name] - float(expected)), 0.75 * unit)
        self.assertAlmostEqual(values["pinion_profile_shift"] + values["wheel_profile_shift"], 0.2483897, delta=5e-8)

    def test_reference_cases(self):
        # Independent implementation of the geometry in 40-digit arithmetic: cases helical_lh_000 and default_000 of
        # tests/reference/ (SI units there). 1e-12 relative as --geometry promises; the backlash is a difference of
        # lengths of some 0.1 m, so it cannot be better than their rounding, 1e-16 m.
        lh = dict(z=(75, 44), m_n=0.004578037969115124, alpha_n=0.39269908169872414, beta=-0.6166179104738768,
                  d=0.33594416717430053, b=0.029722774301698333, x=(0.3901635544257144, 0.00046073261867057846),
                  r_a=(0.21707575086681138, 0.1283142260296558), r_s=(0.19167363694876516, 0.11353228937330775))
        lh_expected = dict(transverse_module_mm=0.005611448420790428, working_pressure_angle_deg=0.4817550953003574,
                           transverse_pressure_angle_deg=0.46980045510167967, base_helix_angle_deg=-0.5636325077040837,
                           reference_center_distance_mm=0.3338811810370305, pinion_base_radius_mm=0.18763111785924846,
                           wheel_base_radius_mm=0.11007692247742577, line_of_action_mm=0.1556547659961992,
                           transverse_base_pitch_mm=0.01571894777203882, backlash_um=0.0002707872780039442,
                           path_start_mm=0.08971834404680618, path_end_mm=0.10916247168912388,
                           transverse_contact_ratio=1.236986592506231, overlap_ratio=1.1950819222495837,
                           total_contact_ratio=2.432068514755815, wheel_start_radius_mm=0.11353228937330775)
        default = dict(z=(55, 18), m_n=0.008234025825505666, alpha_n=0.4363323129985824, beta=0.5285457543893307,
                       d=0.3480342318793109, b=0.18547411724350854, x=(0.1983028957021607, -0.2574579352809819),
                       r_a=(0.27111472214609456, 0.09096106364510759), r_s=None)
        default_expected = dict(transverse_module_mm=0.009535184435049613, working_pressure_angle_deg=0.4951290865425684,
                                base_helix_angle_deg=0.4746544727548213, pinion_base_radius_mm=0.2307271773427474,
                                wheel_base_radius_mm=0.07551071258489914, transverse_base_pitch_mm=0.026358211102672165,
                                line_of_action_mm=0.16536680843653173, backlash_um=0.00046287140506285967,
                                pinion_start_radius_mm=0.25764313652211734, wheel_start_radius_mm=0.07893599491609038,
                                path_start_mm=0.11465145194197411, path_end_mm=0.14236629587020397,
                                transverse_contact_ratio=1.0514690780900586, overlap_ratio=3.615690935310353,
                                total_contact_ratio=4.667160013400411, pinion_tip_radius_mm=0.27111472214609456)
        for gear, expected in [(lh, lh_expected), (default, default_expected)]:
            values = self.listing(params=self.params_of(gear))
            for name, value in expected.items():
                with self.subTest(f"z_p = {gear['z'][0]}: {name}"):
                    factor = {"mm": 1e3, "um": 1e6, "eg": 180 / math.pi}.get(name[-2:], 1)
                    rounding = 4e-16 * 1e6 if name == "backlash_um" else 0
                    self.assertLessEqual(abs(values[name] - value * factor), 1e-12 * abs(value * factor) + rounding)

    @staticmethod
    def params_of(gear):
        keys = [("pinion_teeth", gear["z"][0]), ("wheel_teeth", gear["z"][1]), ("normal_module_mm", gear["m_n"] * 1e3),
                ("normal_pressure_angle_deg", math.degrees(gear["alpha_n"])),
                ("helix_angle_deg", math.degrees(gear["beta"])), ("center_distance_mm", gear["d"] * 1e3),
                ("face_width_mm", gear["b"] * 1e3), ("pinion_profile_shift", gear["x"][0]),
                ("wheel_profile_shift", gear["x"][1]), ("pinion_tip_diameter_mm", gear["r_a"][0] * 2e3),
                ("wheel_tip_diameter_mm", gear["r_a"][1] * 2e3)]
        if gear["r_s"]:
            keys += [("pinion_start_diameter_mm", gear["r_s"][0] * 2e3), ("wheel_start_diameter_mm", gear["r_s"][1] * 2e3)]
        return "[gears]\n" + "".join(f"{key} = {value!r}\n" for key, value in keys)

    def test_printed_digits_are_all_that_a_double_has(self):
        self.write("run.ini", PARAMS)
        lines = self.accepted("run.ini", "--geometry").stdout.splitlines()
        self.assertEqual(len(lines), 36)
        for line in lines:
            text = line.split(" = ")[1]
            self.assertEqual("%.17g" % float(text), text)

    def test_eigenfrequency_follows_drive_and_model(self):
        values = self.listing()
        k = 1.05e8 * values["transverse_contact_ratio"]
        r_p, r_w = values["pinion_base_radius_mm"] / 1e3, values["wheel_base_radius_mm"] / 1e3
        self.assertAlmostEqual(values["eigenfrequency_Hz"] / (math.sqrt(k * r_w**2 / 2.1e-3) / 2 / math.pi), 1, delta=1e-12)

        values = self.listing(*TORQUE)
        expected = math.sqrt(k * (r_p**2 / 2e-3 + r_w**2 / 2.1e-3)) / 2 / math.pi
        self.assertAlmostEqual(values["eigenfrequency_Hz"] / expected, 1, delta=1e-12)

        values = self.listing("--set", "mesh.model=simple", "--set", "mesh.simple_stiffness_N_per_m=3e8")
        self.assertAlmostEqual(values["mean_mesh_stiffness_N_per_um"], 300, delta=1e-10)
        self.assertAlmostEqual(values["eigenfrequency_Hz"] / (math.sqrt(3e8 * r_w**2 / 2.1e-3) / 2 / math.pi), 1, delta=1e-12)

        values = self.listing("--set", "mesh.model=simple")
        self.assertAlmostEqual(values["mean_mesh_stiffness_N_per_um"] / (k * 1e-6), 1, delta=1e-12)

    NREL = """\
[gears]
pinion_teeth = 24
wheel_teeth = 95
normal_module_mm = 14
normal_pressure_angle_deg = 20
helix_angle_deg = 10
center_distance_mm = 861
face_width_mm = 360
pinion_profile_shift = 0.48
wheel_profile_shift = 0.6691
[mesh]
law = iso6336
iso_blank_factor = 0.898
"""

    def test_stiffness_of_iso6336(self):
        # Published for stage 3 of the NREL 5 MW gearbox (KISSsoft), to half a unit of the last place.
        values = self.listing(params=self.NREL)
        self.assertAlmostEqual(values["iso_single_stiffness_N_per_mm_um"], 13.832, delta=5e-4)
        self.assertAlmostEqual(values["iso_mesh_stiffness_N_per_mm_um"], 18.632, delta=5e-4)
        mean = values["iso_single_stiffness_N_per_mm_um"] * 360 * values["transverse_contact_ratio"]
        self.assertAlmostEqual(values["mean_mesh_stiffness_N_per_um"] / mean, 1, delta=1e-12)
        self.assertNotIn("iso_single_stiffness_N_per_mm_um", self.listing())

    def test_limits_of_iso6336_are_told(self):
        # The wheel of this pair has more shift than the pinion; F_t / b = T / (r_w b), r_w = 675.2587 mm.
        self.write("run.ini", self.NREL)
        place = f"run.ini:{line_of(self.NREL, 'law')}: mesh.law: warning: "
        text = self.accepted("run.ini", "--geometry").stderr
        self.assertIn(place + "the gear with fewer teeth has the smaller profile shift (0.48 of the pinion, 0.6691 of "
                      "the wheel)", text)
        self.assertNotIn("mean load", text)
        for line_load, told in [(99, "the mean load is 99 N per mm of face width; below 100 ISO 6336-1 has softer teeth, "
                                     "here by the factor 0.997"), (101, None), (1599, None),
                                (1610, "the mean load is 1610 N per mm of face width, beyond the 1600")]:
            text = self.accepted("run.ini", "--geometry", "--set", f"load.mean_Nm={-line_load * 360 * 0.6752587}").stderr
            if told:
                self.assertIn(place + told, text)
            else:
                self.assertNotIn("mean load", text)
        text = self.accepted("run.ini", "--geometry", "--set", "gears.helix_angle_deg=46", "--set",
                             "gears.center_distance_mm=1205").stderr
        self.assertIn("beyond the 45 degrees", text)
        self.assertIn("the sum of the profile shifts is 2.11, outside the -0.5 to 2",
                      self.accepted("run.ini", "--geometry", "--set", "gears.pinion_profile_shift=1.4", "--set",
                                    "gears.wheel_profile_shift=0.71", "--set", "gears.center_distance_mm=870").stderr)

    def test_law_says_which_keys_count(self):
        self.refused("--set mesh.law: ", "must be constant for these gears, to which ISO 6336-1 gives no stiffness",
                     arguments=["--set", "mesh.law=iso6336", "--set", "gears.pinion_rack_dedendum=5", "--set",
                                "gears.wheel_rack_dedendum=5", "--check"])
        self.refused_value("mesh", "law", "linear", "constant")
        self.refused_value("mesh", "iso_blank_factor", "0.001", "0.01")
        self.write("run.ini", PARAMS)
        self.assertIn("mesh.iso_blank_factor: warning: not used with mesh.law = constant\n",
                      self.accepted("run.ini", "--check", "--set", "mesh.iso_blank_factor=0.9").stderr)
        self.assertIn("mesh.stiffness_N_per_m: warning: not used with mesh.law = iso6336\n",
                      self.accepted("run.ini", "--check", "--set", "mesh.law=iso6336").stderr)
        self.write("run.ini", without_key(PARAMS, "stiffness_N_per_m"))
        self.accepted("run.ini", "--check", "--set", "mesh.law=iso6336")

    def test_damping_is_given_once(self):
        place = f"run.ini:{line_of(PARAMS, 'damping_Ns_per_m') + 1}: mesh.damping_ratio: "
        text = PARAMS.replace("damping_Ns_per_m = 844.361\n", "damping_Ns_per_m = 844.361\ndamping_ratio = 0.05\n")
        told = place + "must not stand beside mesh.damping_Ns_per_m, which says the same (got 0.05)"
        self.refused(told, params=text)
        self.refused(told, params=text, arguments=["--set", "analysis.type=static"])
        self.refused_value("mesh", "damping_ratio", "-0.01")
        self.refused_value("mesh", "damping_ratio", "5", "0.05")

    def test_eigenfrequency_is_left_out_without_inertia(self):
        values = self.listing(params=without_key(PARAMS, "wheel_inertia_kg_m2"))
        self.assertNotIn("eigenfrequency_Hz", values)
        self.assertIn("mean_mesh_stiffness_N_per_um", values)
        self.assertNotIn("eigenfrequency_Hz", self.listing("--set", "drive.kind=torque"))

    def test_swapped_hand_changes_the_base_helix_alone(self):
        right, left = self.listing(), self.listing("--set", "gears.helix_angle_deg=-33")
        self.assertEqual(left.pop("base_helix_angle_deg"), -right.pop("base_helix_angle_deg"))
        self.assertEqual(left, right)


class Flanks(Case):
    """Bad flank files: the message names that file, its line, and the key of the INI file."""

    def refused_file(self, text, *fragments, key="pinion", name="flanks.csv"):
        if text is not None:
            self.write(name, text)
        params = with_key(PARAMS, "flanks", key, name)
        place = f"run.ini:{line_of(params, key + ' =')}: flanks.{key}: "
        self.refused(name, place, *fragments, params=params)

    def test_good_file_is_accepted_in_silence(self):
        self.write("flanks.csv", DEVIATIONS)
        self.write("run.ini", with_key(PARAMS, "flanks", "pinion", "flanks.csv"))
        self.assertEqual(self.accepted("run.ini", "--check").stderr, "")

    def test_a_missing_flank_file_is_named(self):
        self.refused_file(None, "flanks.csv: ", "no such file")

    def test_folder_in_its_place(self):
        os.mkdir(self.path("flanks.csv"))
        self.refused_file(None, "flanks.csv: ")

    def test_sparse_file_of_zeros_fails_at_once(self):
        self.write("flanks.csv", "")
        os.truncate(self.path("flanks.csv"), 2 << 30)
        self.refused_file(None, "flanks.csv:1: ")

    def test_missing_node(self):
        self.refused_file(DEVIATIONS.replace("*,*,1,0,0\n", ""), "flanks.csv:", "t1 = 1, t2 = 0")

    def test_uneven_grid(self):
        self.refused_file(DEVIATIONS + "*,*,0.4,0,0\n*,*,0.4,1,0\n", "flanks.csv:6: ", "0.4")

    def test_tooth_that_does_not_exist(self):
        self.refused_file(DEVIATIONS.replace("*,*,", "45,*,", 1), "flanks.csv:2: ", "45", "44")

    def test_duplicate_node(self):
        self.refused_file(DEVIATIONS + "*,*,1,1,1\n", "flanks.csv:6: ", "a second one")

    def test_short_line(self):
        self.refused_file(DEVIATIONS.replace("*,*,1,0,0", "*,*,1,0"), "flanks.csv:4: ", "must have 5 fields", "(got 4)")

    def test_no_rows(self):
        self.refused_file("tooth,flank,t1,t2,deviation_um\n", "flanks.csv:", "(got none)")

    def test_text_for_a_number(self):
        for value in ["much", "nan", "1e400", "0x1"]:
            with self.subTest(value):
                self.refused_file(DEVIATIONS.replace("*,*,1,0,0", f"*,*,1,0,{value}"), "flanks.csv:4: ", value)

    def test_pitch_files_that_are_none_are_refused(self):
        header = "tooth,flank,deviation_um\n"
        self.refused_file(header + "0,drive,1\n45,drive,1\n", "pitch.csv:3: ", "45", key="pinion_pitch", name="pitch.csv")
        self.refused_file(header + "0,drive,1\n0,drive,1\n", "pitch.csv:3: ", key="pinion_pitch", name="pitch.csv")
        self.refused_file(header + "41,drive,1\n", "pitch.csv:2: ", "41", key="wheel_pitch", name="pitch.csv")
        self.refused_file(header, "pitch.csv:", "(got none)", key="wheel_pitch", name="pitch.csv")

    def test_teeth_without_rows_are_noted(self):
        self.write("flanks.csv", DEVIATIONS.replace("*,*,", "7,drive,"))
        self.write("run.ini", with_key(PARAMS, "flanks", "pinion", "flanks.csv"))
        text = self.accepted("run.ini", "--check").stderr
        self.assertIn("flanks.csv: note: ", text)
        self.assertIn("44 and the coast flank of 45 of 45 teeth", text)
        self.assertEqual(self.accepted("run.ini", "--check", "--quiet").stderr, "")

    def test_simple_model_uses_no_flanks(self):
        params = with_key(with_key(PARAMS, "flanks", "pinion", "none.csv"), "mesh", "model", "simple")
        self.write("run.ini", params)
        self.assertIn("flanks.pinion: warning: not used", self.accepted("run.ini", "--check").stderr)

    def test_paths_are_relative_to_ini_file_or_working_folder(self):
        os.mkdir(self.path("sub"))
        self.write("sub/run.ini", with_key(PARAMS, "flanks", "pinion", "flanks.csv"))
        self.write("sub/flanks.csv", DEVIATIONS)
        self.accepted("sub/run.ini", "--check")
        self.accepted("run.ini", "--check", folder=self.path("sub"))
        self.accepted("sub/run.ini", "--check", "--set", "flanks.wheel=sub/flanks.csv")
        result = self.run_gearsim("sub/run.ini", "--check", "--set", "flanks.wheel=flanks.csv")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--set flanks.wheel: ", result.stderr)


class Output(Case):
    def test_columns_that_do_not_exist(self):
        params = with_key(PARAMS, "output", "columns", "time_s,dte_um,te_um")
        self.refused(f"run.ini:{line_of(params, 'columns')}: output.columns: ", "'te_um'", "dte_um", params=params)
        self.refused("--set output.columns: ", "'time_s'", "mesh_stiffness_N_per_um",
                     arguments=["--set", "analysis.type=static", "--set", "output.columns=time_s"])

    def test_each_row_of_the_tables_is_a_column(self):
        """A column that is added shows itself; what only some runs have is named here."""
        some = {"dynamic": {"apex_shift_um"},
                "static": {"load_torque_Nm", "face_load_factor", "largest_line_load_N_per_mm", "largest_pressure_N_per_mm2",
                           "apex_shift_um", "loss_W"}}
        asked = ["stored_energy_J"]  # by name alone
        everything = ["gears.double_helical_gap_mm=1", "mesh.law=elastic", "mesh.friction_coefficient=0.05", "mesh.stiffness_N_per_m=",
                      "mesh.damping_Ns_per_m=", "mesh.stations=9"]
        self.write("run.ini", PARAMS)
        for kind, settings in (("dynamic", ["analysis.duration_s=0.001"]),
                               ("static", ["analysis.positions=4", "analysis.loads=2", "load.end_Nm=30"])):
            with open(os.path.join(SOURCES, f"{kind}_columns.c"), encoding="utf-8") as file:
                rows = re.findall(r'(?m)^ *\{"(\w+)", ', file.read())
            self.assertGreater(len(rows), 10)
            self.assertEqual([name for name in rows if name in asked], asked)
            self.assertEqual(self.columns_of([f"analysis.type={kind}", settings[0], "output.columns=stored_energy_J"]), asked)
            rows = [name for name in rows if name not in asked]
            plain = self.columns_of([f"analysis.type={kind}", settings[0]])
            self.assertEqual(plain, [name for name in rows if name not in some[kind]])
            self.assertEqual(self.columns_of([f"analysis.type={kind}", *settings, *everything]), rows)

    def columns_of(self, settings):
        text = self.accepted("run.ini", "--quiet", "--output", "-", *(f"--set={setting}" for setting in settings)).stdout
        return next(line for line in text.splitlines() if not line.startswith("#")).split(",")

    def test_all_columns_may_be_asked_for_by_name(self):
        self.write("run.ini", with_key(PARAMS, "output", "columns", "all"))
        self.accepted("run.ini", "--check")

    def test_folder_that_is_missing_or_no_folder(self):
        # Permission bits do not bind root; a path through a regular file binds everybody.
        self.write("file", "")
        for output in ["nowhere/out.csv", "file/out.csv"]:
            with self.subTest(output):
                self.refused("--output: output.file: ", output, arguments=["--output", output])
                self.refused("--set output.file: ", output, arguments=["--set", f"output.file={output}"])
                self.refused("--output: output.file: ", output, arguments=["--check", "--output", output])

    @unittest.skipUnless(os.path.isdir("/proc/self"), "needs /proc")
    def test_folder_that_takes_no_files(self):
        # Even root may not create a file there, which shows only when one is created.
        self.refused("--output: output.file: '/proc/out.csv.part' cannot be written", arguments=["--output", "/proc/out.csv"])

    def test_folder_in_its_place(self):
        os.mkdir(self.path("out.csv"))
        self.refused("--output: output.file: ", "out.csv", "folder", arguments=["--output", "out.csv"])

    def test_empty_name(self):
        self.refused("--output: output.file: must be the name of a file", arguments=["--output", ""])
        self.refused("--output: ", "control character", arguments=["--output", "a\nb"])

    def refused_as_input(self, output, name):
        texts = {file: self.read(file) for file in os.listdir(self.folder) if os.path.isfile(self.path(file))}
        self.refused("--output: output.file: must not overwrite an input", f"(got {output}, which is {name})", params=None,
                     arguments=["--output", output])
        for file, text in texts.items():
            self.assertEqual(self.read(file), text)

    def test_output_that_is_also_an_input(self):
        params = with_key(PARAMS, "flanks", "pinion", "flanks.csv")
        self.write("run.ini", with_key(params, "flanks", "wheel_pitch", "pitch.csv.part"))
        self.write("flanks.csv", DEVIATIONS)
        self.write("pitch.csv.part", "tooth,flank,deviation_um\n*,*,1\n")
        os.link(self.path("flanks.csv"), self.path("hard.csv"))
        os.symlink("flanks.csv", self.path("soft.csv"))
        os.mkdir(self.path("sub"))
        for output, name in [("run.ini", "the INI file"), ("./run.ini", "the INI file"), ("flanks.csv", "flanks.pinion"),
                             ("sub/../flanks.csv", "flanks.pinion"), ("hard.csv", "flanks.pinion"),
                             ("soft.csv", "flanks.pinion"), (self.path("flanks.csv"), "flanks.pinion")]:
            with self.subTest(output):
                self.refused_as_input(output, name)
        # The file that grows before it is renamed counts as well.
        self.refused("--output: output.file: must not overwrite an input", "pitch.csv.part", params=None,
                     arguments=["--output", "pitch.csv"])

    def test_load_distribution_that_is_also_an_input(self):
        params = with_key(with_key(PARAMS, "analysis", "type", "static"), "flanks", "pinion", "flanks.csv")
        self.write("run.ini", params)
        self.write("flanks.csv", DEVIATIONS)
        for output, got in [("run.ini", "run.ini, which is the INI file"), ("flanks.csv", "flanks.csv, which is flanks.pinion")]:
            self.refused("--set output.load_distribution: must not overwrite an input", f"(got {got})", params=None,
                         arguments=["--set", f"output.load_distribution={output}"])
        self.assertEqual(self.read("run.ini"), params)
        self.assertEqual(self.read("flanks.csv"), DEVIATIONS)

    def test_ini_file_named_as_the_default_result(self):
        self.write("params.csv", PARAMS)
        result = self.run_gearsim("params.csv")
        self.assertEqual(result.returncode, 2)
        self.assertIn("params.csv: output.file: must not overwrite an input", result.stderr)
        self.assertEqual(self.read("params.csv"), PARAMS)

    def test_default_result_is_in_the_working_folder(self):
        os.mkdir(self.path("sub"))
        self.write("sub/first.run.ini", PARAMS)
        self.accepted("sub/first.run.ini", "--quiet")
        self.assertEqual(sorted(os.listdir(self.folder)), ["first.run.csv", "run.csv", "sub"])
        self.assertEqual(os.listdir(self.path("sub")), ["first.run.ini"])

    def test_result_named_in_the_ini_file_is_beside_it(self):
        os.mkdir(self.path("sub"))
        self.write("sub/run.ini", with_key(PARAMS, "output", "file", "result.csv"))
        self.accepted("sub/run.ini", "--quiet")
        self.assertEqual(sorted(os.listdir(self.path("sub"))), ["result.csv", "run.ini"])
        self.accepted("sub/run.ini", "--quiet", "--output", "other.csv")
        self.accepted("sub/run.ini", "--quiet", "--set", "output.file=third.csv")
        self.assertEqual(sorted(os.listdir(self.folder)), ["other.csv", "run.csv", "sub", "third.csv"])

    def test_result_says_how_it_was_made(self):
        self.write("run.ini", with_key(PARAMS, "load", "seed", "77"))
        self.accepted("run.ini", "--quiet", "--set", "gears.face_width_mm=12")
        head = [line for line in self.read("run.csv").splitlines() if line.startswith("#")]
        for setting in ["load.seed = 77", "gears.face_width_mm = 12", "gears.helix_angle_deg = 33", "output.rate_Hz = 25600"]:
            self.assertEqual(sum(line.endswith(setting) for line in head), 1, setting)
        self.assertFalse(any("analysis.positions" in line for line in head))

    def test_quiet_run_says_nothing(self):
        self.write("run.ini", PARAMS)
        result = self.accepted("run.ini", "--quiet")
        self.assertEqual((result.stdout, result.stderr), ("", ""))
        self.assertNotEqual(self.read("run.csv"), OLD_RESULT)
        self.assertEqual(sorted(os.listdir(self.folder)), ["run.csv", "run.ini"])


class Tables(Case):
    """Bad tables over time: the message names that file, its line, and the key of the INI file."""

    def params(self, section, **others):
        params = PARAMS
        for key in {"drive": ["start_rpm", "end_rpm"], "load": ["mean_Nm"]}[section]:
            params = without_key(params, key)
        params = with_key(params, section, "file", "table.csv")
        for key, value in others.items():
            params = with_key(params, section, key, value)
        return params

    def refused_table(self, section, text, *fragments, **others):
        self.write("table.csv", text)
        params = self.params(section, **others)
        self.refused("table.csv", f"run.ini:{line_of(params, 'file = ')}: {section}.file: names this file", *fragments,
                     params=params, arguments=["--check"])

    def test_right_tables_are_taken(self):
        for section, column in (("drive", "speed_rpm"), ("load", "torque_Nm")):
            for text in ["time_s,{}\n0,20\n100,30\n", "\ufeff# made\r\ntime_s , {}\r\n\r\n-1,20\r\n100,-3e1\r\n",
                         "time_s,{}\n0,20\n1,20\n1,20\n100,30"]:
                with self.subTest(text):
                    self.write("table.csv", text.format(column))
                    self.write("run.ini", self.params(section, interpolation="cubic"))
                    self.assertEqual(self.accepted("run.ini", "--check").stderr, "")

    def test_bad_tables(self):
        head = "time_s,torque_Nm\n"
        for text, fragments in [
                ("", ["the columns must be time_s,torque_Nm (got nothing)"]),
                ("time_s,speed_rpm\n0,1\n9,1\n", [":1: the columns must be time_s,torque_Nm (got time_s,speed_rpm)"]),
                ("time_s,torque_Nm,x\n0,1,1\n", [":1: the columns must be"]),
                ("time_ms,torque_Nm\n0,1\n", [":1: the columns must be"]),
                (head, ["must have rows at two times"]),
                (head + "0,1\n", ["must have rows at two times"]),
                (head + "0,1\n0,2\n", ["must have rows at two times"]),
                (head + "0,1\n0.5,2\n0.4,1\n100,2\n", [":4: time_s must increase", "(got 0.4)"]),
                (head + "0,1\n0.5,2\n0.5,1\n0.5,3\n100,2\n", [":5: time_s must stand twice at most"]),
                (head + "0,1\n0.5,2\n0.5000000001,1\n100,2\n", [":4: time_s must increase by 1e-9"]),
                (head + "0.1,1\n100,2\n", [":2: must begin at a time of 0 or before (got 0.1 s)"]),
                (head + "0,1\n1e-4,2\n", [":3: must reach the end of the run", "`repeat = on`", "(got 0.0001 s)"]),
                (head + "0,1\n1,nan\n100,1\n", [":3: must be a plain number", "(got nan)"]),
                (head + "0,1\n1,inf\n100,1\n", [":3: must be a plain number", "(got inf)"]),
                (head + "0,1\n1,\n100,1\n", [":3: must be a plain number"]),
                (head + "0,1\n1,0x10\n100,1\n", [":3: must be a plain number", "(got 0x10)"]),
                (head + "0,1\n1,1e300\n100,1\n", [":3: must be a plain number from -1e12 to 1e12"]),
                (head + "0,1\n1;2\n100,1\n", [":3: a row must be two numbers with a comma"]),
                (head + "0,1\n1,2,3\n100,1\n", [":3: a row must be two numbers with a comma"]),
                (head + "0,1\n" + "1" * 5000 + ",2\n100,1\n", [":3: a row must be two numbers with a comma"])]:
            with self.subTest(text[:60]):
                self.refused_table("load", text, *fragments)

    def test_cubic_that_swings_is_told(self):
        self.write("run.ini", self.params("load", interpolation="cubic"))
        self.write("table.csv", "time_s,torque_Nm\n0,1\n1,1\n1.01,30\n100,30\n")
        told = self.accepted("run.ini", "--check").stderr
        self.assertRegex(told, r"load\.file: warning: cubic, the table goes to [\d.]+ where its rows are from 1 to 30: rows at")
        for text, interpolation in (("0,1\n1,1\n2,30\n3,30\n100,30\n", "cubic"), ("0,1\n1,1\n1.01,30\n100,30\n", "linear")):
            self.write("table.csv", "time_s,torque_Nm\n" + text)
            self.write("run.ini", self.params("load", interpolation=interpolation))
            self.assertEqual(self.accepted("run.ini", "--check").stderr, "")

    def test_speeds_do_not_step(self):
        head = "time_s,speed_rpm\n"
        self.refused_table("drive", head + "0,1\n1,2\n1,3\n100,1\n", ":4: speed_rpm must not step")
        self.refused_table("drive", head + "0,1\n1,2\n", ":3: speed_rpm must end with the value it begins with",
                           "(got 1 and 2 rpm)", repeat="on")

    def test_a_missing_table_is_named(self):
        params = self.params("load")
        self.refused("table.csv: cannot be read", "load.file: names this file", params=params, arguments=["--check"])

    def test_table_and_number_exclude_each_other(self):
        self.write("table.csv", "time_s,torque_Nm\n0,1\n100,1\n")
        self.refused("load.mean_Nm: must not stand beside load.file", params=with_key(PARAMS, "load", "file", "table.csv"))
        params = with_key(PARAMS, "drive", "file", "table.csv")
        self.refused("drive.start_rpm: must not stand beside drive.file", "drive.end_rpm: must not stand beside drive.file",
                     params=params)
        self.refused("drive.torque_Nm: must not stand beside drive.file", params=params, arguments=[
            "--set", "drive.kind=torque", "--set", "drive.torque_Nm=1", "--set", "bodies.pinion_inertia_kg_m2=1"])

    def test_result_does_not_replace_a_table(self):
        text = "time_s,torque_Nm\n0,1\n100,1\n"
        self.write("table.csv", text)
        self.refused("output.file: must not overwrite an input", "load.file", params=self.params("load"),
                     arguments=["--output", "table.csv"])
        self.assertEqual(self.read("table.csv"), text)

    def test_keys_without_a_table_are_told(self):
        self.write("run.ini", with_key(with_key(PARAMS, "load", "repeat", "on"), "drive", "interpolation", "cubic"))
        told = self.accepted("run.ini", "--check").stderr
        self.assertIn("load.repeat: warning: not used without load.file", told)
        self.assertIn("drive.interpolation: warning: not used without drive.file", told)

    def test_bad_choices(self):
        self.refused_value("load", "interpolation", "spline", "must be linear | cubic")
        self.refused_value("drive", "repeat", "yes", "must be off | on")


class Ripple(Case):
    def test_bad_ripple(self):
        for section in ("drive", "load"):
            for value, fragment in [("0:5:0", "an order above 0"), ("2:5", "ORDER:AMPLITUDE:PHASE_DEG"),
                                    ("2:5:90deg", "such as 2:5:0, 4:1.5:90")]:
                self.refused_value(section, "ripple", value, fragment)
        self.refused("--set drive.ripple: ", "(got 0:1:0)", arguments=["--set", "drive.ripple=2:5:0, 0:1:0"])

    def test_right_ripple_is_taken(self):
        text = PARAMS.replace("[drive]\n", "[drive]\nripple = 2:5:0, 4.5:1:-90\n")
        text = text.replace("[load]\n", "[load]\nripple = 2:1:0\n")
        self.write("run.ini", text)
        self.assertEqual(self.accepted("run.ini", "--check").stderr, "")
        self.assertEqual(self.accepted("run.ini", "--check", "--set", "drive.ripple=").stderr, "")
        self.assertIn("load.ripple: warning: not used with analysis.type = static",
                      self.accepted("run.ini", "--check", "--set", "analysis.type=static").stderr)

    def test_stop_speed_is_for_torque(self):
        self.write("run.ini", with_key(PARAMS, "analysis", "stop_rpm", "1500"))
        self.assertIn("analysis.stop_rpm: warning: not used with drive.kind = speed",
                      self.accepted("run.ini", "--check").stderr)
        self.refused_value("analysis", "stop_rpm", "fast", "must be a number")


class Example(Case):
    """data/example/params.ini is complete and right."""

    def example(self):
        with open(EXAMPLE) as file:
            return file.read()

    def documented_keys(self):
        """{section.key: default or None} from --help."""
        keys, section = {}, ""
        text = self.accepted("--help").stdout
        for line in text[text.index("\n[gears]\n"):].splitlines():
            if line.startswith("["):
                section = line.strip("[]")
            match = re.match(r"  (\w+) +(?:\[(.*?)\] )?", line)
            if match:
                keys[f"{section}.{match.group(1)}"] = match.group(2)
        return keys

    def example_keys(self):
        """{section.key: (value, is active)} with the keys that are commented out."""
        keys, section = {}, ""
        for line in self.example().splitlines():
            match = re.match(r"\[(\w+)\]", line)
            if match:
                section = match.group(1)
            match = re.match(r"(; )?(\w+) = (\S+)( +;.*)?$", line)
            if match:
                self.assertNotIn(f"{section}.{match.group(2)}", keys)
                keys[f"{section}.{match.group(2)}"] = (match.group(3), match.group(1) is None)
        return keys

    def test_check_accepts_it_without_a_word(self):
        folder, name = os.path.split(EXAMPLE)
        before = sorted(os.listdir(folder))
        result = self.accepted(EXAMPLE, "--check")
        self.assertEqual(result.stderr, "")
        self.assertEqual(sorted(os.listdir(folder)), before)

    def test_it_has_every_key(self):
        self.assertEqual(list(self.example_keys()), list(self.documented_keys()))

    def test_keys_that_are_commented_out_show_their_default(self):
        documented = self.documented_keys()
        count = 0
        for key, (value, is_active) in self.example_keys().items():
            default = documented[key]
            if not is_active and default is not None and " " not in default and default not in ("ideal", "name"):
                count += 1
                if key != "drive.start_rpm":
                    self.assertEqual(value, default, key)
        self.assertGreaterEqual(count, 20)

    def test_every_line_of_it_may_be_activated(self):
        text = re.sub(r"(?m)^; (\w+ = )", r"\1", self.example())
        text = re.sub(r"(?m)^file = (speed|load).csv", r"; \g<0>", text)  # in the place of numbers that are there
        text = text.replace("damping_ratio = ", "; damping_ratio = ")
        folder = os.path.dirname(EXAMPLE)
        text = re.sub(r"(?m)^((?:pinion|wheel)(?:_second_half)?(?:_pitch)?) = (\S+)", rf"\1 = {folder}/\2", text)
        self.write("run.ini", re.sub(r"(?m)^wheel\w*_pitch = ", r"; \g<0>", text))  # a pitch file of 45 teeth
        result = self.accepted("run.ini", "--check")
        self.assertNotIn("unknown", result.stderr)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        GEARSIM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
