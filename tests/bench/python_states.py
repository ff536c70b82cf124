#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the package gearmesh adds to the loop in C over many states.

    python_states.py           100 000 states, processor time (ms): best of 40 calls
    python_states.py --count   10 000 states, instructions by callgrind; exit status 1 above 1.3 times those of the loop in C
"""
import glob
import os
import re
import subprocess
import sys
import tempfile
import time

import gearmesh
import numpy as np

LIMIT, RUNS = 1.3, 40
FFI, LIB = gearmesh.ffi, gearmesh.lib


def calls(count):
    """Title, loop in C, the same from Python, the same into an array that is there, for each kind of states."""
    pair = gearmesh.Pair(pinion_teeth=45, wheel_teeth=41, normal_module=1.65e-3, normal_pressure_angle=np.radians(16),
                         helix_angle=np.radians(33), center_distance=0.085, face_width=0.0175, backlash=100e-6)
    random = np.random.default_rng(1)
    tables = [gearmesh.Flanks(pair, role, random.uniform(-3e-6, 3e-6, (teeth, 2, 11, 21)))
              for role, teeth in (("pinion", 45), ("wheel", 41))]

    # Six turns of the pinion in contact; the loop in C gets its arrays, and writes into one that is there.
    pinion_angle = np.linspace(0, 40, count)
    wheel_angle = (pair.pinion.base_radius * pinion_angle - 54e-6) / pair.wheel.base_radius
    offset, zeros = np.full(count, 54e-6), np.zeros(count)
    by_angles = "gm_state *", LIB.evaluate_states, "evaluate", (pinion_angle, wheel_angle, zeros, zeros)
    by_offset = "double *", LIB.evaluate_offsets, "evaluate_offset", (pinion_angle, offset, zeros, zeros)

    for flanks_title, flanks in (("ideal flanks", []), ("tables on all teeth", tables)):
        mesh = gearmesh.Mesh(pair, *flanks, stiffness=1.05e8, damping=844)
        for want in ([], ["derivatives"], ["wrench"]):
            for kind, loop, name, arguments in (by_angles, by_offset):
                states = np.stack(arguments, axis=-1)
                wanted = sum(getattr(LIB, f"GM_WANT_{word.upper()}") for word in want or ["force"])
                results = FFI.new("gm_mesh_result[]", count)
                evaluate = getattr(mesh, name)
                place = evaluate(*arguments, want=want)

                def in_c():
                    return loop(mesh._struct, count, FFI.cast(kind, states.ctypes.data), FFI.NULL, wanted, FFI.NULL, results)

                yield (f"{flanks_title}, {(want or ['force'])[0]}, {name}", in_c, lambda: evaluate(*arguments, want=want),
                       lambda: evaluate(*arguments, want=want, out=place))


def best(call):
    """Shortest of the runs (ms)."""
    times = []
    for _ in range(RUNS):
        start = time.process_time()
        call()
        times.append(1e3 * (time.process_time() - start))
    return min(times)


def show_times():
    for title, *three in calls(100000):
        in_c, new, there = map(best, three)
        print(f"{title}: C {in_c:.1f} ms, Python {new:.1f} ms, ratio {new / in_c:.2f}, "
              f"into an array that is there {there / in_c:.2f}")


def run_counted():
    """Below callgrind, which writes what it has counted at each call of gm_status_text()."""
    for _, *three in calls(10000):
        for call in three:
            call()  # what is done once
            LIB.gm_status_text(0)
            call()
            LIB.gm_status_text(0)


def show_counts():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["valgrind", "--tool=callgrind", "--dump-before=gm_status_text", f"--callgrind-out-file={folder}/out",
                        sys.executable, __file__, "--counted"],
                       check=True, stderr=subprocess.DEVNULL, env={**os.environ, "PYTHONHASHSEED": "0"})
        counts = []
        for name in sorted(glob.glob(f"{folder}/out.*"), key=lambda name: int(name.rpartition(".")[2])):
            with open(name, encoding="utf-8") as file:
                counts.append(int(re.search(r"^(?:summary|totals): (\d+)", file.read(), re.MULTILINE)[1]))

    worst = 0.0
    for number, (title, *_) in enumerate(calls(1)):
        in_c, new, there = counts[6 * number + 1:6 * number + 6:2]
        worst = max(worst, new / in_c, there / in_c)
        print(f"{title}: C {in_c / 1e4:.0f} instructions each, Python {new / 1e4:.0f}, ratio {new / in_c:.2f}, "
              f"into an array that is there {there / in_c:.2f}")
    return int(not 1.0 < worst <= LIMIT)


if __name__ == "__main__":
    if sys.argv[1:] == ["--counted"]:
        run_counted()
    elif sys.argv[1:] == ["--count"]:
        sys.exit(show_counts())
    else:
        show_times()
