# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""The runs of a sweep: on this machine or over MPI, each one once, whatever becomes of the sweep.

A run writes its result under its number; gearsim gives a file its name when it is whole. The numbers that are wanted of
it go to the journal, a line each, and then the result is removed. So a run is done if it is in the journal or if its
result is there, and after a kill at any point what is done is not done again.
"""
import concurrent.futures
import contextlib
import fcntl
import hashlib
import json
import os
import queue
import shutil
import subprocess
import threading
import time

import program
import summary
from program import InputError, RunFailed

TASK, RESULT = 1, 2  # tags of messages
POLL_S = 0.005
NO_LOADS = "--set=output.load_distribution="  # behind all others: it is one file, which all runs would write


def numbers_of(found, prefix=""):
    """Numbers of a summary by their names: `force.largest_N`, `force_orders.1_N`, `loads.1.te_peak_to_peak_um`."""
    units = {"µm": "um", "N/µm": "N_per_um", "N/mm": "N_per_mm", "N/mm²": "N_per_mm2", "%": "percent", "N m": "Nm"}
    flat = {}
    for key, value in found.items():
        name = f"{prefix}{key}"
        if isinstance(value, dict) and "unit" in value:
            unit = units.get(value["unit"], value["unit"])
            flat[name if not unit or name.endswith(f"_{unit}") else f"{name}_{unit}"] = value["value"]
            flat.update(numbers_of({k: v for k, v in value.items() if isinstance(v, dict)}, f"{name}."))
        elif isinstance(value, dict):
            flat.update(numbers_of(value, f"{name}."))
        elif isinstance(value, list):
            flat.update(numbers_of({str(i): item for i, item in enumerate(value, start=1)}, f"{name}."))
    return flat


class Busy(Exception):
    """Another run writes the file."""


class Job:
    """How a run is done; plain data, so that other machines can have it."""

    def __init__(self, params, settings, keys, gearsim, gearflanks, folder):
        self.params, self.settings, self.keys = params, settings, keys
        self.gearsim, self.gearflanks, self.folder = gearsim, gearflanks, folder

    def result(self, index):
        return os.path.join(self.folder, f"{index}.csv")

    def do(self, index, row):
        """Numbers of a run, or {"failed": why}."""
        values = dict(zip(self.keys, row))
        path = self.result(index)
        try:
            settings = self._set({**self._flanks(index, values), **values}) if not os.path.exists(path) else []
            while not os.path.exists(path):
                try:
                    self._call(self.gearsim, "--quiet", "--output", path, *settings, NO_LOADS)
                except Busy:  # a run that has outlived the sweep that began it: it will be done
                    time.sleep(POLL_S)
            return numbers_of({k: v for k, v in summary.of_file(path).items() if k != "gears"})
        except InputError as error:
            return {"failed": str(error)}

    def check_keys(self, row):
        """Refuses keys that gearsim does not know, before anything is written; values may be wrong in single runs."""
        values = {key: value for key, value in zip(self.keys, row) if not key.startswith("class.")}
        try:
            self._call(self.gearsim, "--quiet", "--check", "--output", "-", *self._set(values), NO_LOADS)
        except InputError as error:
            if "unknown key" in str(error) or "unknown section" in str(error):
                raise

    def _flanks(self, index, values):
        """Keys of flanks that are made for this run; takes what says so out of the values."""
        made = {}
        seed = values.pop("class.seed", str(index + 1))
        for gear in ("pinion", "wheel"):
            quality = values.pop(f"class.{gear}", None)
            if quality is not None:
                files = [os.path.join(self.folder, f"{index}.{gear}{kind}.csv") for kind in ("", "_pitch")]
                options = ["--gear", gear, "--class", quality, "--seed", seed]
                options += ["--flanks", files[0], "--pitch", files[1]]
                gears = {key: value for key, value in values.items() if key.startswith("gears.")}
                if gears or any(text.startswith("gears.") for text in self.settings):
                    raise InputError("flanks of a class are of the gears in the file: no key of [gears] beside class.*")
                self._call(self.gearflanks, *options)
                made |= {f"flanks.{gear}": files[0], f"flanks.{gear}_pitch": files[1]}
        return made

    def _set(self, values):
        return [f"--set={text}" for text in (*self.settings, *(f"{key}={value}" for key, value in values.items()))]

    def _call(self, command, *options):
        params = os.path.join(".", self.params) if self.params.startswith("-") else self.params
        done = subprocess.run(
            [command, params, *options], stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
            check=False,
        )
        if done.returncode == 0:
            return
        why = program.first_line_of(done.stderr)
        if "is being written by another run" in why:
            raise Busy(why)
        # What the input does is a result of the sweep; what the machine does is not.
        of_disk = "cannot be written" in why or ".part: " in why
        if done.returncode in (1, 2) and not of_disk:
            raise InputError(why)
        ended = f"{os.path.basename(command)} was ended ({done.returncode})"
        raise RunFailed(why if done.returncode in (1, 2) else ended)

    def forget(self, index):
        """Removes what a run has left."""
        flanks = [f".{gear}{kind}" for gear in ("pinion", "wheel") for kind in ("", "_pitch")]
        for name in (f"{index}{kind}.csv" for kind in ("", *flanks)):
            with contextlib.suppress(FileNotFoundError):
                os.remove(os.path.join(self.folder, name))


class Journal:
    """What is done, a line each; one sweep at a time."""

    def __init__(self, path, plan, job):
        self.path = path
        with open(job.params, "rb") as file:
            content = hashlib.sha256(file.read()).hexdigest()
        self.head = {"sweep": 1, "params": content, "set": job.settings, "keys": plan.keys,
                     "rows": hashlib.sha256(json.dumps(plan.rows).encode()).hexdigest()}
        self.file = open(path, "a+b")  # pylint: disable=consider-using-with
        try:
            fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            self.file.close()
            raise InputError(f"{path}: another sweep is at work there; wait for it, or name another --output") from None
        try:
            self.done = self._read()
        except BaseException:
            self.file.close()
            raise

    def _read(self):
        """{number of the run: its numbers}; a line that was cut by a kill is taken back."""
        self.file.seek(0)
        lines = self.file.read().split(b"\n")
        whole = sum(len(line) + 1 for line in lines[:-1])
        if lines[-1]:
            self.file.truncate(whole)
        if whole == 0:
            self.write(self.head)
            return {}
        try:
            entries = [json.loads(line) for line in lines[:-1]]
        except ValueError:
            raise InputError(f"{self.path}: is no journal of a sweep; name another --output, or remove it") from None
        if entries[0] != self.head:
            raise InputError(f"{self.path}: of another sweep; name another --output, or remove it")
        return {entry["run"]: entry["numbers"] for entry in entries[1:]}

    def write(self, entry):
        """The line is on the disk when this returns; one that does not fit is taken back."""
        self.file.seek(0, os.SEEK_END)
        end = self.file.tell()
        try:
            self.file.write(json.dumps(entry).encode() + b"\n")
            self.file.flush()
            os.fsync(self.file.fileno())
        except OSError as error:
            with contextlib.suppress(OSError):
                os.ftruncate(self.file.fileno(), end)
            raise RunFailed(f"{self.path}: {error.strerror}; what is done stays, the same command goes on") from None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.file.close()

    def add(self, index, numbers):
        self.write({"run": index, "numbers": numbers})
        self.done[index] = numbers


# ----------------------------------------------------------------------------------------------------
# Who does the work
# ----------------------------------------------------------------------------------------------------


def here(job, tasks, workers):
    """Results as they come, of so many runs side by side on this machine."""
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        running = {}
        tasks = iter(tasks)
        try:
            while True:
                while len(running) < 2 * workers and (task := next(tasks, None)) is not None:
                    running[pool.submit(job.do, *task)] = task[0]
                if not running:
                    return
                for future in concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED).done:
                    yield running.pop(future), future.result()
        finally:
            for future in running:
                future.cancel()


def serve(comm):
    """A rank that does what it is given, until it is given None."""
    job = comm.bcast(None, root=0)
    while job is not None and (task := comm.recv(source=0, tag=TASK)) is not None:
        try:
            comm.send((task[0], job.do(*task), None), dest=0, tag=RESULT)
        except Exception as error:  # pylint: disable=broad-exception-caught
            comm.send((task[0], None, str(error)), dest=0, tag=RESULT)


def dismiss(comm):
    """Says to the other ranks that there is nothing to do."""
    comm.bcast(None, root=0)


def over_mpi(comm, job, tasks):
    """Results as they come, of all ranks; rank 0 hands out and works as well, in a thread that does not speak MPI."""
    comm.bcast(job, root=0)
    tasks = iter(tasks)
    finished = queue.SimpleQueue()
    idle = set(range(comm.Get_size()))

    def work(task):
        try:
            finished.put((0, (task[0], job.do(*task), None)))
        except Exception as error:  # pylint: disable=broad-exception-caught
            finished.put((0, (task[0], None, str(error))))

    def received():
        if not finished.empty():
            return finished.get()
        status = mpi().Status()
        if comm.iprobe(tag=RESULT, status=status):
            return status.Get_source(), comm.recv(source=status.Get_source(), tag=RESULT)
        return None

    fault = None
    try:
        while True:
            for rank in sorted(idle, reverse=True):
                if fault is None and (task := next(tasks, None)) is not None:
                    idle.discard(rank)
                    if rank == 0:
                        threading.Thread(target=work, args=(task,)).start()
                    else:
                        comm.send(task, dest=rank, tag=TASK)
            if len(idle) == comm.Get_size():
                break
            while (got := received()) is None:
                time.sleep(POLL_S)
            rank, (index, numbers, why) = got
            idle.add(rank)
            if why is None:
                yield index, numbers
            fault = fault or why
    finally:
        for rank in range(1, comm.Get_size()):
            comm.send(None, dest=rank, tag=TASK)
    if fault:
        raise RunFailed(fault)


def mpi():
    try:
        from mpi4py import MPI  # pylint: disable=import-outside-toplevel
    except ImportError:
        raise InputError("--mpi needs Python with mpi4py (Debian: python3-mpi4py), which is not installed") from None
    return MPI


def perform(plan, job, journal, results_of):
    """Does what is not done yet; returns {number of the run: its numbers} of all."""
    os.makedirs(job.folder, exist_ok=True)
    for index in journal.done:
        job.forget(index)
    tasks = ((index, row) for index, row in enumerate(plan.rows) if index not in journal.done)
    for index, numbers in results_of(tasks):
        journal.add(index, numbers)
        job.forget(index)
        program.progress(f"{len(journal.done)} of {len(plan.rows)} runs")
    program.progress("")
    shutil.rmtree(job.folder, ignore_errors=True)
    return journal.done
