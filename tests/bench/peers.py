#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Processor time that others take for a mesh, on this machine and in this call: `peers.py BUILD PAPER_FOLDER`.

BUILD is the folder that scripts/bench builds, PAPER_FOLDER data/paper. Each line has the time of the other, that of
gearmesh for the same thing, and the ratio. Who is not installed is told and left out.
"""
import importlib.util
import os
import subprocess
import sys
import tempfile
import warnings

warnings.simplefilter("ignore", DeprecationWarning)  # settings of others, by their names of today
REPORT = os.fdopen(os.dup(1), "w")  # what others print goes nowhere
os.dup2(os.open(os.devnull, os.O_WRONLY), 1)

SPEED_RPM, DURATION_S, RATE_HZ = 3000, 5.0, 20000


def processor_s():
    """Processor time of this process and of those that it has started and waited for."""
    return sum(os.times()[:4])


def fastest(task, repetitions=3):
    """Seconds of the shortest call."""
    best = float("inf")
    for _ in range(repetitions):
        begin = processor_s()
        task()
        best = min(best, processor_s() - begin)
    return best


def say(text):
    print(text, file=REPORT, flush=True)


def tell(what, other_s, own_s):
    say(f"{what:80}  {1e6 * other_s:10.2f} us  {1e6 * own_s:10.3f} us  {other_s / own_s:8.1f}")


def evaluation_s(build, case):
    """Seconds of an evaluation of gearmesh_bench."""
    bench = os.path.join(build, "tests", "bench", "gearmesh_bench")
    text = subprocess.run([bench, "--time", case], capture_output=True, text=True, check=True).stdout
    return 1e-9 * float(text.split(",")[0])


def gearsim_s(build, paper, params, *settings):
    """Seconds of a call of gearsim, the result of which nobody reads."""
    command = [os.path.join(build, "apps", "gearsim", "gearsim"), os.path.join(paper, params), "--quiet", "--output", "-"]
    command += [f"--set={setting}" for setting in settings]
    return fastest(lambda: subprocess.run(command, stdout=subprocess.DEVNULL, check=True))


# ----------------------------------------------------------------------------------------------------
# Who is compared
# ----------------------------------------------------------------------------------------------------


def numpy_slices(build, paper):
    """Penetration of all pairs by 51 thin slices, both flanks by bilinear interpolation, in arrays of numpy."""
    import numpy as np

    slices, lines, teeth, nodes = 51, 5, 45, (21, 31)
    random = np.random.default_rng(1)
    tables = random.uniform(-1e-6, 1e-6, (2, teeth, *nodes))
    t1 = (np.arange(slices) + 0.5) / slices
    face = t1 * (nodes[0] - 1)
    row, p = face.astype(int), face % 1.0

    def look_up(table, tooth, t2):
        at = np.clip(t2, 0.0, 1.0) * (nodes[1] - 1)
        column = np.minimum(at.astype(int), nodes[1] - 2)
        q = at - column
        here = table[tooth, row, column] * (1 - q) + table[tooth, row, column + 1] * q
        beside = table[tooth, row + 1, column] * (1 - q) + table[tooth, row + 1, column + 1] * q
        return here * (1 - p) + beside * p

    def evaluate(phase):
        rho = phase + np.arange(lines)[:, None] + 1.8 * t1 - 3.0  # in pitches, on a path of 2.1 of them
        inside = (rho > 0.0) & (rho < 2.1)
        tooth = np.broadcast_to(np.arange(lines)[:, None], rho.shape)
        gap = 5e-6 + look_up(tables[0], tooth, rho / 2.1) + look_up(tables[1], tooth, 1.0 - rho / 2.1)
        return np.where(inside, np.maximum(gap, 0.0), 0.0).sum() / slices

    other_s = fastest(lambda: [evaluate(k / 2000) for k in range(2000)]) / 2000
    tell("numpy: one evaluation by 51 slices, tables", other_s, evaluation_s(build, "tables.force"))


def exudyn_spring(build, paper):
    """A step of a wheel behind one spring with a dead zone, against a step of gearsim with rows and CSV."""
    import exudyn
    import exudyn.itemInterface as items

    container = exudyn.SystemContainer()
    system = container.AddSystem()
    ground = system.AddNode(items.NodePointGround())
    node = system.AddNode(items.Node1D(referenceCoordinates=[0]))
    state = system.AddNode(items.NodeGenericData(numberOfDataCoordinates=3, initialCoordinates=[0, 0, 0]))
    system.AddObject(items.Mass1D(nodeNumber=node, mass=1.0))
    markers = [system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=n, coordinate=0)) for n in (ground, node)]
    system.AddObject(items.CoordinateSpringDamperExt(
        markerNumbers=markers, nodeNumber=state, useLimitStops=True, limitStopsLower=-50e-6, limitStopsUpper=50e-6,
        limitStopsStiffness=1e8, limitStopsDamping=1e3))
    system.AddLoad(items.LoadCoordinate(markerNumber=markers[1], load=500.0))
    system.Assemble()
    steps = 100000
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = steps / RATE_HZ
    settings.timeIntegration.verboseMode = 0
    settings.solutionSettings.writeSolutionToFile = False
    other_s = fastest(lambda: system.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.RK44), 1) / steps
    shared = (f"drive.start_rpm={SPEED_RPM}", f"drive.end_rpm={SPEED_RPM}", f"output.rate_Hz={RATE_HZ}",
              "output.oversampling=1", "load.noise_interval_s=5e-5", "output.columns=time_s,contact_force_N")
    for name, params in (("tables", "fig14.ini"), ("ideal flanks", "fig13.ini")):
        own_s = (gearsim_s(build, paper, params, *shared, f"analysis.duration_s={2 * DURATION_S}")
                 - gearsim_s(build, paper, params, *shared, f"analysis.duration_s={DURATION_S}")) / (DURATION_S * RATE_HZ)
        tell(f"Exudyn: one step of a spring with a dead zone; a row of gearsim, {name}", other_s, own_s)


def ross_stiffness(build, paper):
    """Mesh stiffness of a spur pair at 1000 angles, which ROSS derives from the potential energy of teeth as cantilevers."""
    import ross
    from ross.gear_element import GearElementTVMS, Mesh

    gears = [GearElementTVMS(n=node, material=ross.steel, width=0.02, bore_diameter=0.035, module=0.002, n_teeth=62,
                             pr_angle=0.349066) for node in (0, 2)]
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "spur.ini"), "w", encoding="utf-8") as file:
            file.write("[gears]\npinion_teeth = 62\nwheel_teeth = 62\nnormal_module_mm = 2\ncenter_distance_mm = 124\n"
                       "normal_pressure_angle_deg = 20\nface_width_mm = 20\nbacklash_um = 60\n[load]\nmean_Nm = 100\n"
                       "[analysis]\ntype = static\npositions = 1000\n[output]\n"
                       "columns = pinion_angle_rad, mesh_stiffness_N_per_um\n")
        own_s = gearsim_s(build, folder, "spur.ini")  # to 10 ms
    tell("ROSS: stiffness at 1000 angles; gearsim, elastic teeth, all of it", fastest(lambda: Mesh(*gears), 1), own_s)


PEERS = {"numpy": numpy_slices, "exudyn": exudyn_spring, "ross": ross_stiffness}


def main():
    if len(sys.argv) != 3:
        say(__doc__)
        return 2
    say(f"{'':80}  {'the other':>13}  {'gearmesh':>13}  {'ratio':>8}")
    for package, compare in PEERS.items():
        if importlib.util.find_spec(package) is None:
            say(f"{package}: is not installed in {sys.executable}, nothing compared")
            continue
        try:
            compare(*sys.argv[1:])
        except Exception as error:  # pylint: disable=broad-except  (of whatever version is there)
            say(f"{package}: nothing compared: {type(error).__name__}: {str(error).strip().splitlines()[0]}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
