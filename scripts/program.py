# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""What every script does around its work: Python packages, messages, names of what it writes, exit status.

This module is imported before numpy, so it needs nothing but Python itself.
"""
import contextlib
import importlib
import importlib.util
import os
import re
import shutil
import signal
import stat
import subprocess
import sys
import tempfile

DEBIAN_PACKAGES = {"numpy": "python3-numpy", "scipy": "python3-scipy", "h5py": "python3-h5py", "mpi4py": "python3-mpi4py"}
HANDED_ON = "GEARMESH_HANDED_ON"  # set for a Python that a script was handed on to, not for what it starts
WAS_HANDED_ON = os.environ.pop(HANDED_ON, None) is not None
TEMPORARY = ".gearmesh_"  # names of what grows beside its place begin so
CONTROLS = r"\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029"  # characters that tell a terminal what to do, but tab and newline

# No script multiplies large matrices, and threads for that take half of the time in which numpy starts.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


class InputError(Exception):
    """What the user asked for cannot be done; the text says why. Exit status 2."""


class RunFailed(Exception):
    """A program that the script calls has failed; the text says why. Exit status 1."""


# ----------------------------------------------------------------------------------------------------
# Standard streams
# ----------------------------------------------------------------------------------------------------


def _hold_standard_descriptors():
    """Take the places of standard streams that are closed, or the next file that is opened would get the messages.

    As the programs do it: opened the wrong way round, so that what is printed for nobody fails.
    """
    for descriptor, way in ((0, os.O_WRONLY), (1, os.O_RDONLY), (2, os.O_RDONLY)):
        try:
            os.fstat(descriptor)
        except OSError:
            os.set_inheritable(os.open(os.devnull, way), True)
    if sys.stdout is None:
        sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # pylint: disable=consider-using-with
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # pylint: disable=consider-using-with


_hold_standard_descriptors()


class _Plain:
    """A stream for people: what a name has in it tells the terminal nothing."""

    def __init__(self, stream):
        self.stream = stream

    def write(self, text):
        return self.stream.write(re.sub(f"[{CONTROLS}]", " ", text))

    def __getattr__(self, name_):
        return getattr(self.stream, name_)


# ----------------------------------------------------------------------------------------------------
# Python packages
# ----------------------------------------------------------------------------------------------------


def require(*packages):
    """Go on in a Python that has these packages, or end with a message that names what is missing.

    `python3` may be an environment without numpy in front of a Python of the system that has it. The script is then
    started again with the first python3 of the search path that has all packages.
    """
    missing = [package for package in packages if importlib.util.find_spec(package) is None]
    if not missing:
        return
    if not WAS_HANDED_ON:
        for python in _other_pythons():
            if _has(python, packages):
                os.execve(python, [python, *sys.orig_argv[1:]], {**os.environ, HANDED_ON: "1"})
    names = ", ".join(f"{package} (Debian: {DEBIAN_PACKAGES[package]})" for package in missing)
    print(f"{name()}: needs Python with {names}, which {sys.executable} does not have", file=sys.stderr)
    sys.exit(2)


def optional(package):
    """A package that few need, from this Python or from the environment of `scripts/setup --workbench`.

    That environment has all packages of its own, as what it has is not made for those of the system. So the script is
    started again there: to be called before anything is printed or written.
    """
    if importlib.util.find_spec(package) is not None:
        return importlib.import_module(package)
    python = os.path.join(workbench_folder(), "bin", "python3")
    is_there = os.path.realpath(sys.prefix) == os.path.realpath(workbench_folder())
    if not is_there and os.path.isfile(python) and _has(python, (package,)):
        os.execve(python, [python, *sys.orig_argv[1:]], {**os.environ, HANDED_ON: "1"})
    raise InputError(f"needs Python with {package}: scripts/setup --workbench installs it")


def workbench_folder():
    """The environment that `scripts/setup --workbench` makes: $GEARMESH_WORKBENCH, or among the data of the user."""
    data = os.environ.get("XDG_DATA_HOME") or os.path.join(os.path.expanduser("~"), ".local", "share")
    return os.environ.get("GEARMESH_WORKBENCH") or os.path.join(data, "gearmesh", "workbench")


def _other_pythons():
    """Each python3 of the search path and that of the system, but not the one that runs.

    By name: that of an environment is a link to the one of the system, but finds other packages.
    """
    folders = [*os.environ.get("PATH", "").split(os.pathsep), *os.defpath.split(os.pathsep)]
    found = [shutil.which("python3", path=folder) for folder in folders if os.path.isabs(folder)]
    return [python for python in dict.fromkeys(found) if python and python != sys.executable]


def _has(python, packages):
    """Whether a Python, the same version or another, finds all packages."""
    # Without the working folder, which `python3 -c` searches first.
    code = "import sys; sys.path = [folder for folder in sys.path if folder]; import importlib.util; " \
           f"sys.exit(any(importlib.util.find_spec(name) is None for name in {packages!r}))"
    command = [python, "-c", code]
    result = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, check=False)
    return result.returncode == 0


# ----------------------------------------------------------------------------------------------------
# Messages
# ----------------------------------------------------------------------------------------------------


def name():
    """What the script was called as: `campbell`, or `gearmesh-campbell` where it is installed."""
    return os.path.basename(sys.argv[0])


def warn(text):
    print(f"{name()}: warning: {shown(text)}", file=sys.stderr)


def progress(text):
    """A line that the next one replaces, on a terminal only."""
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


def run(work, parse):
    """main() of a script: parse the command line, work, say errors as messages, return the exit status."""
    # A name or a unit that the terminal cannot show must not end the script.
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    _be_interrupted_by_signals()

    stdout = sys.stdout
    sys.stdout = _Plain(stdout)
    try:
        status = work(parse()) or 0
        stdout.flush()
        return status
    except InputError as error:
        status, text = 2, error
    except BrokenPipeError:  # nobody reads what is printed; not to be told again at the end of Python
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return 1
    except RunFailed as error:
        status, text = 1, error
    except OSError as error:
        status, text = 1, _text_of(error)
    except MemoryError:
        status, text = 1, "out of memory"
    except KeyboardInterrupt:
        status, text = 130, "interrupted"
    finally:
        sys.stdout = stdout
    progress("")
    print(re.sub(f"[{CONTROLS}]", " ", f"{name()}: {text}"), file=sys.stderr)
    try:
        stdout.flush()
    except OSError:  # not to be told again at the end of Python
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    return status


def _text_of(error):
    """`FILE: why` of what the system refuses; FILE is as the user knows it."""
    path = error.filename2 or error.filename
    if not isinstance(path, (str, bytes)) or not error.strerror:
        return error
    path = os.fsdecode(path)
    folder, name_ = os.path.split(path)
    return f"{(folder or os.curdir) if name_.startswith(TEMPORARY) else path}: {error.strerror}"


def _be_interrupted_by_signals():
    """TERM and HUP end a script as Ctrl-C does, so that nothing is left behind; after nohup HUP still does nothing."""

    def interrupt(*_):
        raise KeyboardInterrupt

    for one in (signal.SIGTERM, signal.SIGHUP):
        with contextlib.suppress(ValueError):  # where main() is called from another thread, as in tests
            if signal.getsignal(one) is signal.SIG_DFL:
                signal.signal(one, interrupt)


def parsed(parser):
    """The command line, where names may also stand between options and behind them."""
    return parser.parse_args() if "--" in sys.argv else parser.parse_intermixed_args()


def first_line_of(error):
    """The first line of an error's text, as libraries tell of a mishap in several."""
    lines = str(error).strip().splitlines()
    return lines[0] if lines else type(error).__name__


# ----------------------------------------------------------------------------------------------------
# Names
# ----------------------------------------------------------------------------------------------------


def stem_of(output, source):
    """Beginning of the names to write: as asked for, or the name of the input without its suffix, here.

    Who asks for x.png gets the pictures as x.png and not as x.png.png.
    """
    stem = re.sub(r"(?<=[^/])\.(png|svg|pdf)$", "", output) if output else os.path.splitext(os.path.basename(source))[0]
    folder = os.path.dirname(stem)
    if folder and not os.path.isdir(folder):
        raise InputError(f"{folder}: there is no such folder (--output)")
    return stem


def title_of(title, source):
    """Headline of the pictures: as asked for, or the name of the input without its suffix."""
    return title or os.path.splitext(os.path.basename(source))[0]


def shown(text):
    """A text as one line that any program can show: without control characters and broken characters."""
    text = str(text).encode("utf-8", errors="surrogateescape").decode("utf-8", errors="replace")
    return re.sub(f"[{CONTROLS}\t\n]+", " ", text)


@contextlib.contextmanager
def written(path, **options):
    """A file of text to write, which has its name when it is whole, or never.

    Two scripts that write it at once do not mix: the later one stays. What a link leads to is replaced, not the link;
    a device is written as it is. Names that are no UTF-8 keep their bytes.
    """
    options = {"encoding": "utf-8", "errors": "surrogateescape", **options}
    path = os.path.realpath(path)
    is_there = os.path.exists(path)
    if is_there and not os.path.isfile(path):
        with open(path, "w", **options) as file:
            yield file
        return

    descriptor, part = tempfile.mkstemp(prefix=TEMPORARY, dir=os.path.dirname(path))
    try:
        with open(descriptor, "w", **options) as file:
            os.fchmod(descriptor, stat.S_IMODE(os.stat(path).st_mode) if is_there else 0o666 & ~_umask())
            yield file
            file.flush()
            os.fsync(descriptor)
        os.replace(part, path)
    except BaseException:
        with contextlib.suppress(FileNotFoundError):
            os.remove(part)
        raise


def _umask():
    """What new files are kept from."""
    mask = os.umask(0o077)
    os.umask(mask)
    return mask
