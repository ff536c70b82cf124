# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures by gnuplot: values are handed to a .gp file of this folder, several files are drawn side by side."""
import os
import subprocess
import tempfile

SCRIPTS = os.path.dirname(os.path.abspath(__file__))


def literal(value):
    """A string, a number, or a list of numbers (as a string of words) as gnuplot reads it."""
    if isinstance(value, (list, tuple)):
        value = " ".join(f"{item:.10g}" for item in value)
    if isinstance(value, str):
        return "'" + value.replace("'", "''") + "'"
    return str(value) if isinstance(value, int) else f"{float(value):.10g}"


def _start(script, values):
    lines = [f"{name} = {literal(value)}" for name, value in {**values, "scripts": SCRIPTS}.items()]
    lines.append(f"load {literal(os.path.join(SCRIPTS, script))}")
    with tempfile.TemporaryFile("w+", encoding="utf-8") as commands:
        commands.write("\n".join(lines) + "\n")
        commands.seek(0)
        try:
            return subprocess.Popen(
                ["gnuplot"], stdin=commands, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
            )
        except FileNotFoundError as error:
            raise OSError("gnuplot is not installed (Debian: gnuplot-nox)") from error


def draw(pictures):
    """Draw {script: values}, all at once; raises OSError if a gnuplot failed or complained, when all have ended."""
    running = {script: _start(script, values) for script, values in pictures.items()}
    complaints = {script: process.communicate()[1].strip() for script, process in running.items()}
    for script, process in running.items():
        if process.returncode != 0 or complaints[script]:
            raise OSError(f"gnuplot {script}: {complaints[script] or process.returncode}")
