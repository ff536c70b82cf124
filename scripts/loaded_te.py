# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Loaded transmission error from gearsim: one parameter file, many torques, many values of its keys."""
import bisect
import concurrent.futures
import contextlib
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

import numpy as np

import program
from program import InputError, RunFailed

ROOT = os.path.join(os.path.dirname(os.path.realpath(__file__)), os.pardir)
GEARS = ("pinion", "wheel")
UNITS = {"um": "µm", "mm": "mm", "deg": "°", "Nm": "N m"}  # by the end of a key
MADE = ("gears", "flanks", "modifications", "mesh")  # sections that act on the error under a given load
RANGES = ("length_mm", "diameter_mm", "share")  # the ways to give that of a relief, by the end of a key
NO_LOAD = 1e-3  # of the mean load: gearsim needs a load, as without one the gears may stand anywhere in the backlash
SHAPE_SHARE = 0.1  # of the scale: what is flatter shows no shape
NO_SHAPE_UM = 1e-3  # what is flatter has none
FLANK_FILES = ("pinion", "wheel", "pinion_pitch", "wheel_pitch", "pinion_tooth_stiffness", "wheel_tooth_stiffness")


class NoEquilibrium(InputError):
    """The gears cannot carry the torque."""


def span(text, default_count=None):
    """`FROM:TO[:COUNT]` or one number, as COUNT numbers evenly from FROM to TO."""
    parts = text.split(":")
    try:
        low, high = float(parts[0]), float(parts[min(1, len(parts) - 1)])
        count = int(parts[2]) if len(parts) == 3 else (1 if low == high else default_count)
    except ValueError:
        raise InputError(f"a range must be FROM:TO or FROM:TO:COUNT with numbers (got '{text}')") from None
    if len(parts) > 3 or not (math.isfinite(low) and math.isfinite(high)):
        raise InputError(f"a range must be FROM:TO or FROM:TO:COUNT with numbers (got '{text}')")
    if low > high:
        raise InputError(f"a range must begin with the lower number (got '{text}')")
    if count is not None and not 1 <= count <= 1000:
        raise InputError(f"a range must have 1 to 1000 values (got '{text}')")
    return np.array([low, high]) if count is None else np.linspace(low, high, count)


def torques(text, count, mean_Nm):
    """Torques of a range given by the user. They have the direction of the mean load if they are > 0."""
    values_Nm = span(text, count)
    if values_Nm[0] < 0:
        raise InputError(f"torques: must be >= 0 (got '{text}'); the sign of load.mean_Nm chooses the flank")
    if values_Nm[-1] == 0:
        raise InputError(f"torques: must not all be 0 (got '{text}'): without a load the gears may stand anywhere in the backlash")
    return loads(values_Nm, mean_Nm)


def loads(values_Nm, mean_Nm):
    """Torques with the sign of the mean load, and a small one in the place of 0."""
    return np.copysign(np.maximum(values_Nm, NO_LOAD * abs(mean_Nm)), mean_Nm)


def even_parts(values):
    """The values cut into parts whose steps are even, which one run can do."""
    parts = []
    for value in values:
        part = parts[-1] if parts else None
        is_next = part and (len(part) == 1 or abs(value - 2 * part[-1] + part[-2]) <= 1e-9 * abs(value))
        if is_next:
            part.append(value)
        else:
            parts.append([value])
    return parts


def full_key(key):
    """`section.key`; without a section it is one of [modifications]."""
    return key if "." in key else f"modifications.{key}"


def short_key(key):
    return key.removeprefix("modifications.")


def unit_of(key):
    return UNITS.get(key.rpartition("_")[2], "")


def gearsim_path(given):
    """The program: as given, as built by scripts/test, or as installed beside the command or on the search path."""
    build = os.environ.get("GEARMESH_BUILD_DIR") or os.path.join(ROOT, "build", "release")
    places = [
        os.path.join(build, "apps", "gearsim", "gearsim"),
        os.path.join(os.path.dirname(os.path.abspath(sys.argv[0])), "gearsim"),
        os.path.join(ROOT, os.pardir, "bin", "gearsim"),
    ]
    path = given or next(filter(os.path.isfile, places), None) or shutil.which("gearsim")
    if path is None:
        raise InputError("gearsim is not built: scripts/test builds it, or say where it is (--gearsim FILE)")
    if not os.path.isfile(path) or not os.access(path, os.X_OK):
        raise InputError(f"{path}: there is no such program (--gearsim)")
    return os.path.abspath(path)


def write_gears(folder, head):
    """A parameter file of the gears of a result, from what its head says of them; returns its path."""
    gears = {key.partition(".")[2]: value for key, value in head.items() if key.startswith("gears.")}
    if "pinion_teeth" not in gears or "wheel_teeth" not in gears:
        raise InputError("the head must have the gears (# gears.pinion_teeth = ...)")
    path = os.path.join(folder, "gears.ini")
    with open(path, "w", encoding="utf-8") as file:
        file.write("[gears]\n" + "".join(f"{key} = {value}\n" for key, value in gears.items()))
    return path


def gearflanks_path(gearsim):
    """gearflanks beside gearsim, in a build or installed."""
    folder = os.path.dirname(gearsim)
    places = [os.path.join(folder, "gearflanks"), os.path.join(folder, os.pardir, "gearflanks", "gearflanks")]
    return next(filter(os.path.isfile, places), "gearflanks")


def add_arguments(parser):
    """What both scripts take."""
    add = parser.add_argument
    add("params", metavar="PARAMS.ini", help="parameter file of gearsim; its mean_Nm is the design load")
    add("--set", action="append", default=[], metavar="SECTION.KEY=VALUE", help="as for gearsim; may be repeated")
    add("--output", metavar="STEM", help="beginning of the names written [name of PARAMS.ini without .ini, here]")
    add("--title", help="headline of the pictures [PARAMS]")
    add("--gearsim", metavar="FILE", help="the program [$GEARMESH_BUILD_DIR or build/release, else installed]")
    add("--no-pictures", action="store_true", help="numbers only, gnuplot is not called")


def settings_of(values):
    """What stands behind --set of {section.key: value}."""
    return [f"{key}={value:.12g}" if isinstance(value, float) else f"{key}={value}" for key, value in values.items()]


def command_of(gearsim, path, values, *options):
    path = os.path.join(".", path) if path.startswith("-") else path  # or it were an option
    return [gearsim, path, *options, *(f"--set={setting}" for setting in settings_of(values))]


def check(status, text):
    """Raise what an exit status of gearsim means; the text is what it said."""
    if status in (130, -signal.SIGINT):
        raise KeyboardInterrupt
    if status == 2:
        raise InputError(text.strip())
    if status != 0 and "no equilibrium" in text:
        raise NoEquilibrium(text.strip())
    if status != 0:
        raise RunFailed(text.strip() or f"gearsim ended with {status}")


def call(gearsim, path, values, *options):
    """Call gearsim with {section.key: value}; returns what it prints."""
    command = command_of(gearsim, path, values, "--quiet", *options)
    result = subprocess.run(command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    check(result.returncode, result.stderr)
    return result.stdout


class Runs:
    """Runs of one parameter file, one after the other, in one process that begins with the first of them."""

    END, ROWS, MESSAGE = b"# exit ", b"# rows ", b"# message: "

    def __init__(self, command):
        self.command = [*command, "--each", "--binary"]
        self.process = None

    def run(self, values):
        """Lines of comments and rows of a run with {section.key: value}."""
        if self.process is not None and self.process.poll() is not None:  # as after Ctrl-C, between two runs
            self.close()
        if self.process is None:
            self.process = subprocess.Popen(  # pylint: disable=consider-using-with
                self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            self.process.stdin.write("\t".join(settings_of(values)).encode() + b"\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass  # it has ended, and what it has said of that is read below
        lines, rows, status = self._answer()
        check(status, "".join(self.messages_of(lines)))
        return lines, rows

    @classmethod
    def messages_of(cls, lines):
        """What gearsim has said of a run, among its lines of comments."""
        return [line.removeprefix(cls.MESSAGE).decode(errors="replace") for line in lines if line.startswith(cls.MESSAGE)]

    def _answer(self):
        """Lines of comments that a run prints, its rows and its exit status."""
        lines, blocks, columns = [], [], 0
        while not (line := self.process.stdout.readline()).startswith(self.END):
            if not line:  # the process is gone, as after Ctrl-C
                self._end_input()  # a script around it may wait for more
                said = self.process.stderr.read().decode(errors="replace")
                status = self.process.wait()
                self.close()
                check(status or 1, said)
            if line.startswith(self.ROWS):
                size = int(line.removeprefix(self.ROWS)) * columns
                blocks.append(self.process.stdout.read(8 * size))
            elif line.startswith(b"#"):
                lines.append(line)
            else:
                columns = line.count(b",") + 1
        return lines, np.frombuffer(b"".join(blocks)).reshape(-1, max(columns, 1)), int(line.removeprefix(self.END))

    def stop(self):
        """Ends the process while another thread waits for its answer."""
        process = self.process
        if process is not None:
            process.kill()
            self._end_input()

    def _end_input(self):
        with contextlib.suppress(AttributeError, OSError):  # it may have ended meanwhile
            self.process.stdin.close()

    def close(self):
        self._end_input()
        if self.process is not None:
            with self.process as process:
                process.kill()
            self.process = None


def _head(lines):
    """{key: text} of the lines `# key = text`."""
    parts = (line.decode(errors="replace").removeprefix("#").partition("=") for line in lines)
    return {key.strip(): text.strip() for key, equals, text in parts if equals}


def listing(text):
    """{name: first number} of what `gearsim --geometry` prints."""
    lines = (line.partition(" = ") for line in text.splitlines())
    return {key: float(value.partition(",")[0]) for key, _, value in lines}


class Gears:
    """A gear pair of a parameter file. Runs go to a process of gearsim on each core; close() ends them."""

    def __init__(self, path, settings=(), gearsim=None):
        self.path = path
        self.gearsim = gearsim_path(gearsim)
        if not os.path.isfile(path):
            raise InputError(f"{path}: there is no such file")
        self.settings = dict(self._setting(text) for text in settings)
        self.positions = None  # as the file says
        self.warnings = set()  # that have been passed on
        self.idle = {}  # warnings of keys that lack an amount, by the key
        self.folder = tempfile.TemporaryDirectory(prefix="gearmesh_")
        self.pool = concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1)
        self.own, self.all_runs = threading.local(), []
        try:
            self._read()
        except BaseException:
            self.close()
            raise

    @staticmethod
    def _setting(text):
        key, equals, value = text.partition("=")
        if not equals or "." not in key:
            raise InputError(f"--set: must be section.key=value (got {text})")
        return key.strip(), value.strip()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.pool.shutdown(cancel_futures=True)
        for runs in self.all_runs:
            runs.close()
        self.folder.cleanup()

    def _read(self):
        """What the file says, with all defaults, and what follows from its gears."""
        self.geometry = listing(self._call({}, "--geometry"))
        names = "pinion_angle_rad,te_um"
        lines, table = self._run({"output.columns": names, "analysis.loads": 1})
        self.parameters = _head(lines)
        self._pass_on_warnings(lines)
        self.mean_Nm = float(self.parameters["load.mean_Nm"])
        self.flank, self.other_flank = ("drive", "coast") if self.mean_Nm > 0 else ("coast", "drive")
        if self.differs_by_tooth() and self.parameters["analysis.period"] == "mesh":
            program.warn(
                f"{self.path}: teeth differ by files, but one mesh cycle only; all teeth of the pinion "
                "take --set analysis.period=pinion --set analysis.positions=N, N some 50 for each"
            )
        self.mesh_cycles = table[:, 0] * int(self.parameters["gears.pinion_teeth"]) / (2 * math.pi)

    def _pass_on_warnings(self, lines):
        """What gearsim warns of in a run of the file as it is; not that the static run leaves keys unused."""
        for message in Runs.messages_of(lines):
            words = re.sub(r"\d", "", message)  # once, whatever number a later run has
            if idle := re.search(r"(modifications\.\w+): warning: not used without an amount", message):
                self.idle.setdefault(idle[1], message)
                continue
            if ": warning: " in message and ": warning: not used with " not in message and words not in self.warnings:
                self.warnings.add(words)
                print(program.shown(message.rstrip("\n")), file=sys.stderr)

    def warn_of_idle(self, varied=()):
        """Tells of ranges and shapes without an amount, but for those whose amount is among the varied keys."""
        def of_any_flank(key):
            return re.sub("_(drive|coast)_", "_", key)
        stems = [of_any_flank(key).removesuffix("um") for key in varied if key.endswith("_um")]
        for key, message in self.idle.items():
            if not any(of_any_flank(key).startswith(stem) for stem in stems):
                print(program.shown(message.rstrip("\n")), file=sys.stderr)

    # ------------------------------------------------------------------------------------------------
    # Runs
    # ------------------------------------------------------------------------------------------------

    def _call(self, values, *options):
        return call(self.gearsim, self.path, {**self.settings, **values}, *options)

    def _run(self, values):
        """Lines of comments and rows of a static run."""
        forced = {"analysis.type": "static", "output.load_distribution": ""}  # one file for runs that go side by side
        if self.positions is not None:
            forced["analysis.positions"] = self.positions
        return self._runs().run({**forced, **values})

    def _runs(self):
        """Those of this thread."""
        if not hasattr(self.own, "runs"):
            self.own.runs = Runs(command_of(self.gearsim, self.path, self.settings))
            self.all_runs.append(self.own.runs)
        return self.own.runs

    def restart(self):
        """Ends all processes of gearsim: an interruption of a terminal has reached them, and what follows gets others."""
        for runs in self.all_runs:
            runs.close()

    def load_distribution(self):
        """The CSV with the loads along the lines of contact at mean_Nm; it goes with close()."""
        path = os.path.join(self.folder.name, "load.csv")
        lines, _ = self._run({"analysis.loads": 1, "output.columns": "te_um", "output.load_distribution": path})
        self._pass_on_warnings(lines)
        return path

    def curves(self, torques_Nm, values, columns):
        """Columns [torque, position, column] with {key: value} in place of the file's; the torques are even."""
        forced = {"load.mean_Nm": float(torques_Nm[0]), "analysis.loads": len(torques_Nm),
                  "output.columns": ",".join(columns)}
        if len(torques_Nm) > 1:
            forced["load.end_Nm"] = float(torques_Nm[-1])
        try:
            return np.reshape(self._run({**values, **forced})[1], (len(torques_Nm), -1, len(columns)))
        except (NoEquilibrium, RunFailed) as error:
            given = "".join(f"{short_key(key)} = {value:.6g}: " for key, value in values.items())
            raise type(error)(f"{given}{error}") from error

    def each(self, designs, torques_Nm, columns=("te_um",)):
        """Columns [torque, position, column] of each {key: value}, in this order, several at a time."""
        parts = even_parts(torques_Nm)
        futures = [[self.pool.submit(self.curves, part, design, columns) for part in parts] for design in designs]
        try:
            for of_design in futures:
                yield np.vstack([future.result() for future in of_design])
        except KeyboardInterrupt:
            for runs in self.all_runs:
                runs.stop()
            self._give_up(futures)
            self.restart()
            raise
        finally:
            self._give_up(futures)

    @staticmethod
    def _give_up(futures):
        """Begin none that has not begun, and wait for the others."""
        flat = [future for of_design in futures for future in of_design]
        for future in flat:
            future.cancel()
        concurrent.futures.wait(flat)

    def curves_um(self, designs, torques_Nm):
        """Transmission error of all: [design, torque, position]."""
        return np.array(list(self.each(designs, torques_Nm)))[..., 0]

    def carried(self, designs, torques_Nm):
        """Those of the torques, lowest first, that each {key: value} can carry; tells of the others."""

        def is_too_much(torque_Nm):
            try:
                self.curves_um(designs, [torque_Nm])
            except NoEquilibrium:
                return True
            return False

        if not is_too_much(torques_Nm[-1]):
            return torques_Nm
        count = bisect.bisect_left(torques_Nm, True, key=is_too_much)
        print(f"{self.path}: torques end below {torque_text(abs(torques_Nm[count]))} N m, which the gears cannot carry")
        return torques_Nm[:count]

    def touching_um(self):
        """What added to a transmission error makes it 0 where ideal flanks just touch."""
        return math.copysign(self.geometry["backlash_um"] / 2, self.mean_Nm)

    def periods(self, te_um):
        """Mesh cycles and curves [torque, position] to draw: two periods, so that one is seen whole wherever it begins.

        Less than the hunting period of teeth that differ is none, it is drawn as it is.
        """
        cycles = self.mesh_cycles
        if self.differs_by_tooth() and self.parameters["analysis.period"] != "hunting":
            return cycles, te_um
        period = max(1, round(cycles[-1] + cycles[1])) if len(cycles) > 1 else 1  # up to rounding
        return np.concatenate([cycles, cycles + period, [2 * period]]), np.hstack([te_um, te_um, te_um[:, :1]])

    # ------------------------------------------------------------------------------------------------
    # What the file says
    # ------------------------------------------------------------------------------------------------

    def key_that_counts(self, gear, name):
        """Key of a modification for the loaded flank: the one with the flank if the file has it."""
        own = f"modifications.{gear}_{self.flank}_{name}"
        return own if own in self.parameters else f"modifications.{gear}_{name}"

    def varied_key(self, name):
        """`section.key` of a key to vary, which must act on the loaded flank."""
        key = full_key(name)
        if key.partition(".")[0] not in MADE:
            raise InputError(
                f"--vary: must be what a gear is made to, a key of [modifications] (got {name}); "
                "--torques gives torques, --set all else"
            )
        for gear in GEARS:
            if key.startswith(f"modifications.{gear}_{self.other_flank}_"):
                raise InputError(f"--vary {name}: the {self.other_flank} flank does not carry the load")
            own = key.replace(f"modifications.{gear}_", f"modifications.{gear}_{self.flank}_")
            if own != key and own in self.parameters:
                raise InputError(f"--vary {name}: {short_key(own)} replaces it on the loaded flank, vary that")
        return key

    def value(self, key):
        """Number of a key, None if the file does not say."""
        text = self.parameters.get(key)
        try:
            return None if text is None else float(text)
        except ValueError:
            raise InputError(f"{key}: its value '{text}' is not a number, which could be varied") from None

    def has_range(self, stem):
        """Whether the file says the range of a relief, `modifications.pinion_tip_relief`."""
        return any(f"{stem}_{ending}" in self.parameters for ending in RANGES)

    def differs_by_tooth(self):
        return any(self.parameters.get(f"flanks.{name}") for name in FLANK_FILES)

    def tip_relief_keys(self):
        """Amounts of the tip reliefs that the file gives to the loaded flanks."""
        keys = [self.key_that_counts(gear, "tip_relief_um") for gear in GEARS]
        return [key for key in keys if self.value(key)]

    def pairs_without_relief(self):
        """Pairs of teeth that always touch in the transverse section."""
        return max(1, math.floor(self.geometry["transverse_contact_ratio"]))

    def deflection_um(self):
        """Of the pairs that always touch, under the mean load."""
        force_N = abs(self.mean_Nm) / (self.geometry["wheel_base_radius_mm"] * 1e-3)
        pair_N_per_um = self.geometry["mean_mesh_stiffness_N_per_um"] / self.geometry["transverse_contact_ratio"]
        return force_N / (self.pairs_without_relief() * pair_N_per_um)

    def long_tip_relief(self):
        """Amount (um) and length (mm) of the long linear tip relief for the mean load."""
        amount_um = self.deflection_um()
        path_mm = self.geometry["path_end_mm"] - self.geometry["path_start_mm"]
        length_mm = path_mm - amount_um * 1e-3 - self.pairs_without_relief() * self.geometry["transverse_base_pitch_mm"]
        if length_mm < 0.02 * path_mm:
            raise InputError(
                f"{self.path}: has no tip relief, and with a transverse contact ratio of "
                f"{self.geometry['transverse_contact_ratio']:.4g} a long one has no room; give --vary, "
                "and with --set what the modification needs beside its amount"
            )
        return amount_um, length_mm


# ----------------------------------------------------------------------------------------------------
# Files and terminal
# ----------------------------------------------------------------------------------------------------


def with_values(text, values):
    """The text of an INI file with {section.key: text} in place of its values, or added to their section."""
    lines = text.removeprefix("\ufeff").removesuffix("\n").split("\n")  # as gearsim, at no other character
    for key, value in values.items():
        section, _, name = key.partition(".")
        at, end = None, None  # line of the key, end of the section
        inside = False
        for number, line in enumerate(lines):
            if found := re.match(r"\s*\[([^]]*)\]", line):
                inside = found[1].strip() == section
            if inside and line.strip():
                end = number + 1
            if inside and re.match(rf"\s*{re.escape(name)}\s*[=:]", line):
                at = number
        if at is not None:
            lines[at] = re.sub(r"([=:]\s*)(.*?)(\s+[;#].*|\s*)$", lambda m: m[1] + value + m[3], lines[at], count=1)
        elif end is not None:
            lines.insert(end, f"{name} = {value}")
        else:
            lines += ["", f"[{section}]", f"{name} = {value}"]
    return "\n".join(lines) + "\n"


def write_params(gears, path, values):
    """The parameter file with other values, at another place: flank files are named from there."""
    moved = {}
    for name in FLANK_FILES:
        key = f"flanks.{name}"
        if gears.parameters.get(key):
            beside = os.path.dirname(gears.path) if key not in gears.settings else ""  # --set: the working folder
            target = os.path.join(beside, gears.parameters[key])
            moved[key] = os.path.relpath(target, os.path.dirname(path) or ".")
    with open(gears.path, encoding="utf-8", errors="surrogateescape") as file:
        text = file.read()
    with program.written(path) as file:
        file.write(with_values(text, {**gears.settings, **moved, **values}))


def round_step(range_, steps):
    """The next of 1, 2, 5, 10, 20 .. that divides a range into at most so many steps."""
    raw = max(range_, 1e-9) / steps
    power = 10.0 ** math.floor(math.log10(raw) + 1e-9)
    return next(power * digit for digit in (1, 2, 5, 10) if power * digit >= raw * (1 - 1e-9))


def moved_together(groups_um):
    """Curves [curve, position] of each picture at one scale: as they are, or, where the loads are so far apart that no
    curve would show its shape, each moved beside its neighbours; and whether they were moved."""
    shape_um = max(np.ptp(curve_um) for group_um in groups_um for curve_um in group_um)
    if not NO_SHAPE_UM < shape_um < SHAPE_SHARE * np.ptp(groups_um):
        return groups_um, False
    ranks = [np.argsort(np.argsort(group_um.mean(axis=1))) for group_um in groups_um]
    return [
        group_um - group_um.mean(axis=1, keepdims=True) + 1.3 * shape_um * rank[:, np.newaxis]
        for group_um, rank in zip(groups_um, ranks)
    ], True


def apart(positions, distance):
    """Where labels stand that should be at the given positions, in their order and a distance apart."""
    order = np.argsort(positions, kind="stable")
    groups = []  # [first rank, count, middle]
    for rank, index in enumerate(order):
        groups.append([rank, 1, positions[index]])
        while len(groups) > 1:
            (first, count, middle), (_, more, other) = groups[-2:]
            if other - middle >= distance * (count + more) / 2:
                break
            groups[-2:] = [[first, count + more, (middle * count + other * more) / (count + more)]]
    placed = np.empty(len(positions))
    for first, count, middle in groups:
        placed[order[first : first + count]] = middle + distance * (np.arange(count) - (count - 1) / 2)
    return placed


def torque_text(torque_Nm):
    """Four digits, and no exponent: 170600 and not 1.706e+05."""
    text = f"{torque_Nm:.4g}"
    return f"{float(text):.0f}" if "e+" in text else text


def peak_to_peak_text(te_um):
    width_um = np.ptp(te_um)
    return f"p-p {width_um:.{2 if width_um >= 1 else 3}f} µm"


def write_blocks(path, blocks):
    """Columns as blocks of lines for gnuplot (`index` 0, 1 ..)."""
    with open(path, "w", encoding="ascii") as file:
        for columns in blocks:
            np.savetxt(file, np.column_stack(columns), "%.9g")
            file.write("\n\n")
