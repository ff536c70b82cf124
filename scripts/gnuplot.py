# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures by gnuplot: values are handed to a .gp file of this folder, several pictures are drawn side by side.

gnuplot runs whatever follows `|` or `<` at the beginning of a file name, or stands between backquotes. So it sees no
name that comes from outside: it works in a folder of its own, where all files have names of this project, and texts
reach it between single quotes, in one line.
"""
import glob
import locale
import math
import os
import shutil
import subprocess
import tempfile

import program

SCRIPTS = os.path.dirname(os.path.realpath(__file__))
FORMATS = ("png", "svg", "pdf")
UTF8_LOCALES = ("C.UTF-8", "C.utf8", "en_US.UTF-8", "POSIX.UTF-8")


def literal(value):
    """A string, a number, or a list of numbers (as a string of words) as gnuplot reads it."""
    if isinstance(value, (list, tuple)):
        value = " ".join(f"{item:.10g}" for item in value)
    if isinstance(value, str):
        return "'" + program.shown(value).replace("'", "''") + "'"
    if not math.isfinite(value):
        raise ValueError("gnuplot has no number for inf and nan")
    return str(value) if isinstance(value, int) else f"{float(value):.10g}"


def _utf8_locale():
    """A locale in which gnuplot can write µ and °, whatever that of the user is; numbers keep their point."""
    kept = locale.setlocale(locale.LC_CTYPE)
    try:
        for candidate in UTF8_LOCALES:
            try:
                locale.setlocale(locale.LC_CTYPE, candidate)
                return candidate
            except locale.Error:
                continue
    finally:
        locale.setlocale(locale.LC_CTYPE, kept)
    return "C"


def _start(script, values, folder):
    """gnuplot with variables of these values, in the folder of the data."""
    lines = [f"{name} = {literal(value)}" for name, value in values.items()]
    lines.append(f"load {literal(script)}")
    environment = {**os.environ, "LC_ALL": _utf8_locale()}
    environment.pop("GNUTERM", None)  # a terminal that this gnuplot may not have
    with tempfile.TemporaryFile("w+", encoding="utf-8") as commands:
        commands.write("\n".join(lines) + "\n")
        commands.seek(0)
        try:
            return subprocess.Popen(
                ["gnuplot", "--default-settings"],  # without the start-up files of the user
                stdin=commands,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                cwd=folder,
                env=environment,
            )
        except FileNotFoundError as error:
            raise program.RunFailed("gnuplot is not installed (Debian: gnuplot-nox)") from error


def _run(pictures, folder):
    """Draw all at once; raises RunFailed if a gnuplot failed or complained, when all have ended."""
    for path in glob.glob(os.path.join(glob.escape(SCRIPTS), "*.gp")):
        shutil.copy(path, folder)
    running = []
    try:
        for script, values in pictures:
            running.append((script, _start(script, values, folder)))
        ended = [(script, process.communicate()[1], process.returncode) for script, process in running]
    finally:
        for _, process in running:  # after an interruption
            process.kill()
            process.wait()
    for script, complaints, status in ended:
        text = complaints.decode("utf-8", errors="replace").strip()
        if status != 0 or text:
            raise program.RunFailed(f"gnuplot {script}: {text or status}")


def draw(stem, prepare, formats=None):
    """Draw pictures in a folder beside their place and move them there when all are done; returns their names.

    `prepare(folder)` writes the data and returns {name: (script, values)}; the picture becomes STEM + name. The script
    writes it as `picture . '.png'`, `.svg` and `.pdf`, or in some of these formats.
    """
    formats = formats or FORMATS
    with tempfile.TemporaryDirectory(prefix=program.TEMPORARY, dir=os.path.dirname(stem) or ".") as folder:
        folder = os.path.abspath(folder)
        pictures = prepare(folder)
        common = {"formats": " ".join(formats)}
        _run([(script, {"picture": f"picture{name}", **common, **values}) for name, (script, values) in pictures.items()],
             folder)
        for name in pictures:
            for suffix in formats:
                os.replace(os.path.join(folder, f"picture{name}.{suffix}"), f"{stem}{name}.{suffix}")
    return [f"{stem}{name}" for name in pictures]
