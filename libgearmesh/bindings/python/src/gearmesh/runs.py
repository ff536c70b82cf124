# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""gearsim: runs of the program, and its results as arrays."""
from __future__ import annotations

import dataclasses
import os
import pathlib
import subprocess
import tempfile
from collections.abc import Mapping
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from ._memory import Error

Path = Union[str, "os.PathLike[str]"]
HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"


@dataclasses.dataclass(frozen=True)
class Run:
    """A result of gearsim."""

    columns: dict[str, NDArray[np.float64]]
    """by name, which ends in the unit: `time_s`, `contact_force_N` ...; each of shape [rows]"""

    parameters: dict[str, str]
    """what the head of the file says: version, every parameter as `section.key`; `incomplete` if the run ended early"""

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self.columns[name]


def gearsim(parameter_file: Path, settings: Mapping[str, Any] | None = None, program: Path = "gearsim") -> Run:
    """
    Run gearsim and return its result.

    `settings`: values in place of those of the file, {"load.mean_Nm": 30}. `program`: where gearsim lies, if not on PATH.
    Raises Error with the message of gearsim.
    """
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "run.csv"
        command = [os.fspath(program), os.fspath(parameter_file), "--quiet", "--output", os.fspath(output)]
        for name, value in (settings or {}).items():
            command += ["--set", f"{name}={value}"]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Error(done.stderr.strip() or f"gearsim ended with {done.returncode}")
        return read_run(output)


def read_run(path: Path) -> Run:
    """A result file of gearsim, CSV or HDF5 (which needs h5py)."""
    with open(path, "rb") as file:
        is_hdf5 = file.read(len(HDF5_SIGNATURE)) == HDF5_SIGNATURE
    return _read_hdf5(path) if is_hdf5 else _read_csv(path)


def _read_hdf5(path: Path) -> Run:
    import h5py  # type: ignore[import-not-found,unused-ignore]

    with h5py.File(path, "r") as file:
        parameters = {name: value.decode() if isinstance(value, bytes) else str(value)
                      for name, value in file.attrs.items()}
        return Run({name: column[()] for name, column in file.items()}, parameters)


def _read_csv(path: Path) -> Run:
    with open(path, encoding="utf-8") as file:
        lines = file.readlines()
    comments = [line[1:].strip() for line in lines if line.startswith("#")]
    rows = [line for line in lines if not line.startswith("#")]
    if not rows:
        raise Error(f"{os.fspath(path)}: must be a result of gearsim (got no row of names)")

    parameters = {}
    for comment in comments:
        name, equals, value = comment.partition("=")
        if equals:
            parameters[name.strip()] = value.strip()
        elif comment.startswith("incomplete"):
            parameters["incomplete"] = comment.partition(":")[2].strip()
    names = rows[0].strip().split(",")
    try:
        values = np.loadtxt(rows[1:], delimiter=",", ndmin=2).reshape(-1, len(names))
    except ValueError as error:
        raise Error(f"{os.fspath(path)}: must be a result of gearsim ({error})") from error
    return Run(dict(zip(names, values.T)), parameters)
