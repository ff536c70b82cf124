# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""The FMUs in three importers, FMPy, libcosim and ecos, against gearsim and the Python package."""
import ctypes
import pathlib
import shutil
import sys
import zipfile

import fmpy
import numpy as np
import pytest
from fmpy.fmi2 import FMU2Model, FMU2Slave
from fmpy.fmi3 import FMU3Model, FMU3Slave
from fmpy.validation import validate_fmu

import gearmesh

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "clients"))
import random_meshes  # noqa: E402
EXAMPLE = ROOT / "data" / "example"
VERSIONS = (2, 3)
MODELS = ("GearMesh", "GearPair")
RPM = np.pi / 30

# The gears that the FMUs have by themselves, as gearsim takes them.
PARAMETERS = ROOT / "tests" / "clients" / "params.ini"


@pytest.fixture(name="fmu", scope="session")
def fixture_fmu(request):
    folder = pathlib.Path(request.config.getoption("--fmus"))
    return lambda model, version: str(folder / f"fmi{version}" / f"{model}.fmu")


@pytest.fixture(name="run", scope="session")
def fixture_run(request):
    """What gearsim computes."""
    return lambda **settings: gearmesh.gearsim(PARAMETERS, settings, request.config.getoption("--gearsim"))


def start_of(run):
    return {"drive_torque": 25.0, "load_torque": 20.0, "pinion_speed": 1000 * RPM, "offset": -1e-6 * run["dte_um"][0]}


class Instance:
    """An FMU that is instantiated and initialized, with values by their names."""

    def __init__(self, path, folder, kind="CoSimulation", start=None, name="one"):
        self.description = fmpy.read_model_description(path)
        self.version = int(self.description.fmiVersion[0])
        self.unzipped = fmpy.extract(path, unzipdir=str(folder / f"{name}{self.version}{kind}"))
        self.references = {variable.name: variable.valueReference for variable in self.description.modelVariables}
        classes = {(2, "CoSimulation"): FMU2Slave, (2, "ModelExchange"): FMU2Model, (3, "CoSimulation"): FMU3Slave,
                   (3, "ModelExchange"): FMU3Model}
        self.fmu = classes[self.version, kind](
            guid=self.description.guid, unzipDirectory=self.unzipped, instanceName=name,
            modelIdentifier=self.description.modelName)
        self.fmu.instantiate()
        if self.version == 2:
            self.fmu.setupExperiment(startTime=0.0)
            self.set(**(start or {}))
            self.fmu.enterInitializationMode()
        else:
            self.set(**(start or {}))
            self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()

    def set(self, **values):
        for name, value in values.items():
            if isinstance(value, str):
                self.fmu.setString([self.references[name]], [value])
            elif isinstance(value, int):
                (self.fmu.setInteger if self.version == 2 else self.fmu.setInt32)([self.references[name]], [value])
            else:
                (self.fmu.setReal if self.version == 2 else self.fmu.setFloat64)([self.references[name]], [value])

    def get(self, *names):
        get = self.fmu.getReal if self.version == 2 else self.fmu.getFloat64
        return np.array(get([self.references[name] for name in names]))

    def contact(self):
        get = self.fmu.getInteger if self.version == 2 else self.fmu.getInt32
        return get([self.references["contact"]])[0]

    def step(self, time, size):
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)

    def derivatives(self, unknown, known):
        """[unknown, known] by one call for each known variable."""
        columns = [self.fmu.getDirectionalDerivative([self.references[name] for name in unknown],
                                                     [self.references[name]], [1.0]) for name in known]
        return np.array(columns).T

    def free(self):
        self.fmu.terminate()
        self.fmu.freeInstance()


# ----------------------------------------------------------------------------------------------------
# What an importer reads
# ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("model", MODELS)
def test_fmu_is_valid(fmu, model, version):
    assert validate_fmu(fmu(model, version)) == []
    description = fmpy.read_model_description(fmu(model, version))
    names = {variable.name for variable in description.modelVariables}
    assert {"pinion_teeth", "backlash", "pose.skew", "stiffness", "wheel_pitch"} <= names
    assert description.numberOfEventIndicators == 2 if version == 2 else len(description.eventIndicators) == 2


@pytest.mark.parametrize("model", MODELS)
def test_fmu_needs_no_library_of_its_own(fmu, model, tmp_path):
    with zipfile.ZipFile(fmu(model, 2)) as archive:
        archive.extract(f"binaries/linux64/{model}.so", tmp_path)
    data = (tmp_path / f"binaries/linux64/{model}.so").read_bytes()
    assert b"libsundials" not in data and b"libgearmesh" not in data


# ----------------------------------------------------------------------------------------------------
# Motion
# ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("kind", ("CoSimulation", "ModelExchange"))
def test_gear_pair_moves_as_in_gearsim(fmu, run, version, kind):
    expected = run()
    start = start_of(expected)
    # FMPy's CVode steps by a 50th of the run at most, and asks for 1e-8 of each state's amount or nominal value.
    result = fmpy.simulate_fmu(fmu("GearPair", version), fmi_type=kind, stop_time=0.02, output_interval=1e-4,
                               step_size=1e-4, relative_tolerance=1e-8, start_values=start, record_events=False,
                               output=["offset", "force", "pinion_speed", "wheel_speed", "pinion_angle", "contact"])
    assert result.size == expected["time_s"].size
    # Both integrate to 1e-8 of 50 um in each of some thousand steps.
    assert 1e6 * result["offset"] == pytest.approx(-expected["dte_um"], abs=1e-3)
    assert result["force"] == pytest.approx(expected["contact_force_N"], abs=0.2)
    assert result["pinion_speed"] / RPM == pytest.approx(expected["pinion_speed_rpm"], abs=1e-3)
    assert result["wheel_speed"] / RPM == pytest.approx(expected["wheel_speed_rpm"], abs=1e-3)
    assert result["pinion_angle"] == pytest.approx(expected["pinion_angle_rad"], abs=1e-6)
    assert (result["contact"] == 1).all()


@pytest.mark.parametrize("version", VERSIONS)
def test_flank_files_of_the_resources_count(fmu, run, version, tmp_path):
    copy = str(tmp_path / "GearPair.fmu")
    shutil.copy(fmu("GearPair", version), copy)
    with zipfile.ZipFile(copy, "a") as archive:
        archive.write(EXAMPLE / "flanks.csv", "resources/flanks.csv")
        archive.write(EXAMPLE / "pitch.csv", "resources/pitch.csv")
    expected = run(**{"flanks.pinion": EXAMPLE / "flanks.csv", "flanks.pinion_pitch": EXAMPLE / "pitch.csv",
                      "flanks.wheel": EXAMPLE / "flanks.csv"})
    files = {"pinion_flanks": "flanks.csv", "pinion_pitch": "pitch.csv", "wheel_flanks": str(EXAMPLE / "flanks.csv")}
    result = fmpy.simulate_fmu(copy, fmi_type="CoSimulation", stop_time=0.02, output_interval=1e-4, relative_tolerance=1e-8,
                               start_values={**start_of(expected), **files}, output=["offset"])
    assert 1e6 * result["offset"] == pytest.approx(-expected["dte_um"], abs=2e-3)
    assert np.abs(expected["dte_um"] - run()["dte_um"]).max() > 1


def test_contact_changes_at_events(fmu):
    """The load turns round: the wheel crosses the backlash, and coast flanks take over."""
    start = {"drive_torque": 0.0, "load_torque": -20.0, "offset": 40e-6, "pinion_inertia": 1.0}
    result = fmpy.simulate_fmu(fmu("GearPair", 2), fmi_type="ModelExchange", stop_time=5e-3, output_interval=1e-5,
                               relative_tolerance=1e-8, start_values=start, output=["offset", "contact"])
    assert set(result["contact"]) >= {0, -1}
    # Ideal flanks touch where x is half the backlash, 50 um, from the middle.
    lost = np.abs(1e6 * result["offset"] + 50) > 0.5
    assert (np.where(result["offset"] < -50e-6, -1, 0)[lost] == result["contact"][lost]).all()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_mesh_between_two_shafts_gives_the_torques_of_the_library(fmu, version, tmp_path):
    mesh = gearmesh.Mesh(
        gearmesh.Pair(pinion_teeth=45, wheel_teeth=41, normal_module=1.65e-3, normal_pressure_angle=np.radians(16),
                      helix_angle=np.radians(33), center_distance=0.085, face_width=0.0175, backlash=100e-6),
        stiffness=1e8, damping=500.0, pose={"offset": 5e-6, "skew": 1e-4})
    instance = Instance(fmu("GearMesh", version), tmp_path,
                        start={"stiffness": 1e8, "damping": 500.0, "pose.offset": 5e-6, "pose.skew": 1e-4})
    inputs = ["pinion_angle", "wheel_angle", "pinion_speed", "wheel_speed"]
    outputs = ["pinion_torque", "wheel_torque", "force"]
    for time, state in enumerate([(1.3e-3, 0.0, 0.01, 0.0), (-1.4e-3, 0.0, 0.0, 0.3), (0.0, 0.0, 1.0, 1.0)]):
        instance.set(**dict(zip(inputs, state)))
        instance.step(time, 1.0)
        expected = mesh.evaluate(*state, want="derivatives")
        assert instance.get(*outputs) == pytest.approx([expected[name] for name in outputs], rel=1e-9, abs=1e-9)
        by = [[expected[f"{output}_by"][name] for name in inputs] for output in outputs]
        assert instance.derivatives(outputs, inputs) == pytest.approx(np.array(by), rel=1e-6, abs=1e-9)
        assert instance.contact() == (1, -1, 0)[time]
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_mesh_follows_the_motion_of_the_wheel(fmu, version, tmp_path):
    mesh = gearmesh.Mesh(
        gearmesh.Pair(pinion_teeth=45, wheel_teeth=41, normal_module=1.65e-3, normal_pressure_angle=np.radians(16),
                      helix_angle=np.radians(33), center_distance=0.085, face_width=0.0175, backlash=100e-6),
        stiffness=1.05e8, damping=844.361)
    instance = Instance(fmu("GearMesh", version), tmp_path)
    inputs = {"pinion_angle": 1.3e-3, "pinion_speed": 0.01}
    pose, rate = {"center_distance_change": 1e-6, "axial_shift": -2e-6, "inclination": 2e-5}, {"offset": -1e-4, "skew": 1e-4}
    instance.set(**inputs, **{f"motion.{name}": value for name, value in pose.items()},
                 **{f"motion_rate.{name}": value for name, value in rate.items()})

    def evaluate(pose, rate):
        return mesh.evaluate(1.3e-3, 0.0, 0.01, want="wrench", pose=pose, pose_rate=rate)

    expected = evaluate(pose, rate)
    assert expected.force > 100
    wrench = np.concatenate([expected.wrench[name] for name in
                             ("pinion_force", "pinion_moment", "wheel_force", "wheel_moment")])
    assert instance.get("force", *WRENCH) == pytest.approx([expected.force, *wrench], rel=1e-9, abs=1e-9)

    # By the pose and its rate, against one-sided differences.
    for known, more in (("motion.skew", ({**pose, "skew": 3e-8}, rate)),
                        ("motion_rate.offset", (pose, {**rate, "offset": -1e-4 + 1e-5}))):
        ahead, size = evaluate(*more), 3e-8 if "skew" in known else 1e-5
        slope = [(ahead.force - expected.force) / size, (ahead.wrench.wheel_moment[1] - expected.wrench.wheel_moment[1]) / size]
        assert instance.derivatives(["force", "wheel_moment.y"], [known])[:, 0] == pytest.approx(slope, rel=1e-3)
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_elastic_teeth_come_by_a_parameter(fmu, version, tmp_path):
    mesh = gearmesh.Mesh(
        gearmesh.Pair(pinion_teeth=45, wheel_teeth=41, normal_module=1.65e-3, normal_pressure_angle=np.radians(16),
                      helix_angle=np.radians(33), center_distance=0.085, face_width=0.0175, backlash=100e-6),
        law="elastic", stations=5, damping=844.361)
    instance = Instance(fmu("GearMesh", version), tmp_path, start={"law": gearmesh.lib.GM_LAW_ELASTIC, "stations": 5})
    instance.set(pinion_angle=1.3e-3, pinion_speed=0.01)
    expected = mesh.evaluate(1.3e-3, 0.0, 0.01)
    assert instance.get("force") == pytest.approx(expected.force, rel=1e-6)
    assert expected.force > 100
    instance.free()


# ----------------------------------------------------------------------------------------------------
# Meshes of all kinds
# ----------------------------------------------------------------------------------------------------

WRENCH = [f"{gear}_{part}.{axis}" for gear in ("pinion", "wheel") for part in ("force", "moment") for axis in "xyz"]
FILES = ["pinion_flanks", "wheel_flanks", "pinion_second_half"]
SHAFTS = ["pinion_angle", "wheel_angle", "pinion_speed", "wheel_speed"]


def parameters_of(case, folder):
    """Of a random mesh, as an FMU has them; its tables in files."""
    values = {"double_helical_gap": case.gap}
    for struct, given in (("gm_pair_params", case.pair), ("gm_mesh_params", case.law)):
        values |= dict(random_meshes.fields(struct, given))
    files = case.table_files([folder / f"{name}.csv" for name in FILES]) or [""] * len(FILES)
    return values | dict(zip(FILES, files))


def set_motion(instance, state, pose, rate):
    instance.set(**dict(zip(SHAFTS, state)), **{f"motion.{name}": value for name, value in pose.items()},
                 **{f"motion_rate.{name}": value for name, value in rate.items()})


@pytest.mark.parametrize("version", VERSIONS)
def test_random_meshes_have_the_bits_of_the_library(fmu, version, tmp_path):
    instance = Instance(fmu("GearMesh", version), tmp_path)
    outputs = ["force", "pinion_torque", "wheel_torque", *WRENCH, "apex_shift"]
    floated = 0
    for case in random_meshes.cases():
        parameters = parameters_of(case, tmp_path)
        instance.set(**parameters)
        files = [parameters[name] for name in FILES] if case.tables is not None else None
        for (state, pose, rate), found in zip(case.states, random_meshes.evaluations(case, files, ["wrench"])):
            if case.kind == "double_helical":
                pose, rate = dict.fromkeys(pose, 0.0), dict.fromkeys(rate, 0.0)
            set_motion(instance, state, pose, rate)
            values = random_meshes.numbers(*found)
            expected = np.concatenate([values[:3], values[8:]])
            assert random_meshes.bits(instance.get(*outputs)) == random_meshes.bits(expected), case.kind
            floated += found[1] != 0
    assert floated > 10
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_double_helical_mesh_between_two_shafts_has_its_derivatives(fmu, version, tmp_path):
    instance = Instance(fmu("GearMesh", version), tmp_path)
    compared = 0
    for case in random_meshes.cases():
        if case.kind != "double_helical":
            continue
        instance.set(**parameters_of(case, tmp_path))
        state, pose, rate = case.states[0]
        set_motion(instance, state, dict.fromkeys(pose, 0.0), dict.fromkeys(rate, 0.0))
        rows = ["pinion_torque", "wheel_torque", "force", "apex_shift"]
        exact = instance.derivatives(rows, SHAFTS)

        # Differences on both sides of it: those of one side are off where a kink lies there.
        for column, step in enumerate((3e-10, 3e-10, 1e-2, 1e-2)):
            values = []
            for places in (-1, 0, 1):
                instance.set(**{SHAFTS[column]: state[column] + places * step})
                values.append(instance.get(*rows))
            instance.set(**{SHAFTS[column]: state[column]})
            slopes = np.diff(values, axis=0) / step
            size = np.abs(exact[:, :2] if column < 2 else exact[:, 2:]).max(axis=1)
            assert (np.abs(slopes - exact[:, column]).min(axis=0) <= 1e-3 * size + 1e-12).all(), (column, slopes, exact)
            compared += 1
        wrench = instance.derivatives(WRENCH, ["wheel_angle"])
        assert np.isfinite(wrench).all() and np.abs(wrench).max() > 1e6
    assert compared == 4 * random_meshes.EACH
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_double_helical_wheel_that_has_moved_is_one_that_was_drawn_there(fmu, version, tmp_path):
    instance = Instance(fmu("GearMesh", version), tmp_path)
    outputs = ["force", "pinion_torque", "wheel_torque", "stored_energy", *WRENCH]
    rng = np.random.default_rng(5)
    moved = 0
    for case in random_meshes.cases():
        if case.kind != "double_helical":
            continue
        parameters = parameters_of(case, tmp_path)
        state, pose, rate = case.states[0]
        amounts = dict(zip(pose, [3e-6, 3e-6, 5e-4, 2e-5, 2e-5]))
        motion = {name: amount * rng.uniform(-1, 1) for name, amount in amounts.items()}
        instance.set(**parameters)
        set_motion(instance, state, dict.fromkeys(pose, 0.0), dict.fromkeys(rate, 0.0))
        before = instance.get("force")
        set_motion(instance, state, motion, dict.fromkeys(rate, 0.0))
        found = instance.get(*outputs)
        apex = instance.get("apex_shift")

        # The same as a pose from the beginning; the pinion follows an axial shift.
        instance.set(**{f"pose.{name}": parameters[f"pose.{name}"] + motion[name] for name in motion})
        set_motion(instance, state, dict.fromkeys(pose, 0.0), dict.fromkeys(rate, 0.0))
        force, radius = abs(found[0]), 0.1
        assert instance.get(*outputs) == pytest.approx(found, rel=1e-7, abs=1e-8 * force * radius), case.law
        assert instance.get("apex_shift") == pytest.approx(apex, abs=1e-11)
        moved += abs(found[0] - before[0]) > 0.01 * force
    assert moved > 3
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_action_is_reaction_whatever_the_motion(fmu, version, tmp_path):
    instance = Instance(fmu("GearMesh", version), tmp_path)
    turned = 0
    for case in random_meshes.cases():
        if case.kind == "simple":
            continue  # all of it acts in one point, without a pose
        parameters = parameters_of(case, tmp_path)
        instance.set(**parameters)
        pair = case.mesh().pair
        for state, pose, rate in case.states:
            if case.kind == "double_helical":
                pose, rate = ({name: share * value for name, value in of.items()} for share, of in
                              ((0.1, {**dict.fromkeys(pose, 1e-4), "skew": 1e-4}), (1.0, {**dict.fromkeys(rate, 0.0), "offset": 1e-3})))
            set_motion(instance, state, pose, rate)
            on_pinion, about_pinion, on_wheel, about_wheel = instance.get(*WRENCH).reshape(4, 3)

            # The wheel's axis as it has moved, not yet tilted; that of a ring is on the other side.
            axis = [np.sign(case.pair["wheel_teeth"]) * pair.center_distance + parameters["pose.center_distance_change"]
                    + pose["center_distance_change"], parameters["pose.offset"] + pose["offset"], 0.0]
            size = np.abs(on_pinion).max() + 1e-9
            assert on_pinion == pytest.approx(-on_wheel, abs=1e-9 * size)
            assert about_pinion + about_wheel + np.cross(axis, on_wheel) == pytest.approx(0.0, abs=1e-9 * size), case.kind
            turned += size > 100
    assert turned > 100
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("gears", ("one helix", "double-helical"))
def test_what_a_gearbox_takes_in_is_stored_or_lost(fmu, version, gears):
    """Work of the torques = change of the kinetic and the stored energy + friction, and + damping where there is some."""
    inertia, start = {"pinion_inertia": 2.1e-3, "wheel_inertia": 1.7e-3}, {"drive_torque": 30.0, "load_torque": 24.0}
    # Tip edges: without them lines end with some overlap and take its energy along. Speeds whose teeth hardly change with them.
    law = {"friction_coefficient": 0.06, "friction_speed": 1e-3, "corner_contact": gearmesh.lib.GM_CORNER_ON}
    gap = {"double_helical_gap": 2e-3} if gears == "double-helical" else {}
    for damping in (0.0, 800.0):
        result = fmpy.simulate_fmu(
            fmu("GearPair", version), fmi_type="CoSimulation", stop_time=0.01, output_interval=2e-6, relative_tolerance=1e-10,
            start_values={**inertia, **start, **law, **gap, "damping": damping, "pinion_speed": 60.0, "offset": 66e-6},
            output=["pinion_angle", "wheel_angle", "pinion_speed", "wheel_speed", "stored_energy", "loss"])
        kinetic = 0.5 * (inertia["pinion_inertia"] * result["pinion_speed"] ** 2 + inertia["wheel_inertia"] * result["wheel_speed"] ** 2)
        held = kinetic + result["stored_energy"]
        work = start["drive_torque"] * (result["pinion_angle"] - result["pinion_angle"][0]) \
            - start["load_torque"] * (result["wheel_angle"] - result["wheel_angle"][0])
        lost = np.concatenate([[0.0], np.cumsum(0.5 * (result["loss"][1:] + result["loss"][:-1]) * np.diff(result["time"]))])
        rest = work - (held - held[0]) - lost
        swing = np.ptp(result["stored_energy"])
        assert lost[-1] > 0.05 and swing > 5e-3
        if damping == 0.0:
            # The formulas of the integration take a little out of some 80 swings, each of a few thousand steps.
            assert np.abs(rest).max() < 2e-4 * swing
        else:
            # What damping takes only grows, but for that.
            assert np.diff(rest).min() > -1e-6 * swing and rest[-1] > 0.1 * swing


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("kind", ("friction", "double_helical"))
def test_a_gearbox_moves_by_the_torques_of_its_mesh(fmu, version, kind, tmp_path):
    instance = Instance(fmu("GearPair", version), tmp_path, "ModelExchange")
    if version == 2:
        instance.fmu.enterContinuousTimeMode()
    lost = 0
    for case in random_meshes.cases():
        if case.kind != kind:
            continue
        instance.set(**parameters_of(case, tmp_path), pinion_inertia=2e-3, wheel_inertia=4e-3, drive_torque=30.0, load_torque=20.0)
        mesh = case.mesh()
        radii = mesh.pair.pinion.base_radius, mesh.pair.wheel.base_radius
        for (phi_p, phi_w, speed, wheel_speed), _, _ in case.states:
            x, rate = (radii[0] * a - radii[1] * b for a, b in ((phi_p, phi_w), (speed, wheel_speed)))
            states = {"pinion_angle": phi_p, "pinion_speed": speed, "offset": x, "offset_rate": rate}
            if version == 2:
                instance.fmu.setContinuousStates((ctypes.c_double * 4)(*states.values()), 4)
            else:
                instance.set(**states)
            found = mesh.evaluate_offset(phi_p, x, rate, speed)
            result = found if kind == "friction" else found.result
            expected = [(30.0 - result.pinion_torque) / 2e-3, result.force, 0.0 if kind == "friction" else float(found.apex)]
            assert instance.get("der(pinion_speed)", "force", "apex_shift") == pytest.approx(expected, rel=1e-12, abs=1e-18)
            lost += abs(result.pinion_torque / radii[0] - result.wheel_torque / radii[1]) > 1e-3 * abs(result.force)
    assert lost > 3
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_directional_derivatives_are_those_of_differences(fmu, version, tmp_path):
    start = {"drive_torque": 3.0, "load_torque": 2.0, "pinion_angle": 0.123, "pinion_speed": 10.0, "offset": 53e-6,
             "offset_rate": 1e-4, "pinion_inertia": 1e-3, "friction_coefficient": 0.05, "friction_speed": 0.1}
    instance = Instance(fmu("GearPair", version), tmp_path, "ModelExchange", start)
    states = ["pinion_angle", "pinion_speed", "offset", "offset_rate"]
    unknown = [f"der({name})" for name in states] + ["wheel_angle", "wheel_speed", "transmission_error", "force",
                                                   "loss", "stored_energy"]
    if version == 2:
        instance.fmu.enterContinuousTimeMode()
    exact = instance.derivatives(unknown, states)
    # Steps of each state that move flanks by picometres, far from the next kink.
    for column, step in enumerate([1e-9, 1e-4, 1e-11, 1e-8]):
        values = []
        for sign in (1, -1):
            state = [start[name] for name in states]
            state[column] += sign * step
            if version == 2:
                instance.fmu.setContinuousStates((ctypes.c_double * 4)(*state), 4)
            else:
                instance.set(**dict(zip(states, state)))
            values.append(instance.get(*unknown))
        differences = (values[0] - values[1]) / (2 * step)
        assert exact[:, column] == pytest.approx(differences, rel=1e-4, abs=1e-5 * np.abs(differences).max())
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_state_can_be_saved_and_come_back(fmu, version, tmp_path):
    instance = Instance(fmu("GearPair", version), tmp_path,
                        start={"drive_torque": 20.0, "load_torque": 20.0, "pinion_speed": 50.0, "offset": 55e-6})
    names = ["offset", "force", "pinion_angle", "wheel_speed"]
    instance.step(0.0, 1e-3)
    saved = instance.fmu.getFMUState()
    data = instance.fmu.serializeFMUState(saved)
    instance.set(load_torque=30.0)
    instance.step(1e-3, 1e-3)
    first = instance.get(*names)
    other = instance.get("offset")

    # Again from there, then from the bytes in another instance: the same way, to the last bit.
    instance.fmu.setFMUState(saved)
    instance.set(load_torque=30.0)
    instance.step(1e-3, 1e-3)
    assert (instance.get(*names) == first).all()
    second = Instance(fmu("GearPair", version), tmp_path, name="two")
    restored = second.fmu.deserializeFMUState(data)
    second.fmu.setFMUState(restored)
    assert second.get("offset") != other
    second.set(load_torque=30.0)
    second.step(1e-3, 1e-3)
    assert (second.get(*names) == first).all()
    instance.fmu.freeFMUState(saved)
    second.fmu.freeFMUState(restored)
    instance.free()
    second.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_instances_have_nothing_in_common(fmu, version, tmp_path):
    light = {"drive_torque": 20.0, "load_torque": 20.0, "offset": 53e-6, "pinion_speed": 50.0}
    alone = Instance(fmu("GearPair", version), tmp_path, start=light, name="alone")
    for step in range(5):
        alone.step(step * 1e-4, 1e-4)
    expected = alone.get("offset", "force")
    alone.free()

    pair = [Instance(fmu("GearPair", version), tmp_path, start=start, name=name)
            for name, start in (("light", light), ("heavy", {**light, "wheel_inertia": 0.1}))]
    for step in range(5):
        for instance in pair:
            instance.step(step * 1e-4, 1e-4)
    assert (pair[0].get("offset", "force") == expected).all()
    assert (pair[1].get("offset", "force") != expected).all()
    for instance in pair:
        instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_wrong_values_are_refused_and_named(fmu, version, capfd):
    for start, named in (({"normal_module": -1.0}, "normal_module: must be"),
                         ({"pinion_flanks": "nowhere.csv"}, "nowhere.csv"),
                         ({"double_helical_gap": 0.1}, "double_helical_gap: must be"),
                         ({"offset": 1.0}, "half a base pitch")):
        with pytest.raises(Exception):
            fmpy.simulate_fmu(fmu("GearPair", version), fmi_type="CoSimulation", start_values=start, stop_time=1e-3)
        captured = capfd.readouterr()
        assert named in captured.out + captured.err


def test_libcosim_moves_the_gear_pair_as_gearsim_does(fmu, run):
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    expected = run()
    execution = CosimExecution.from_step_size(step_size=1e5)  # ns
    slave = execution.add_local_slave(CosimLocalSlave(fmu_path=fmu("GearPair", 2), instance_name="pair"))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    manipulator = CosimManipulator.create_override()
    execution.add_manipulator(manipulator)
    variables = {variable.name.decode(): variable.reference for variable in execution.slave_variables(slave)}
    for name, value in {**start_of(expected), "relative_tolerance": 1e-8}.items():
        execution.real_initial_value(slave, variables[name], value)
    for name in ("drive_torque", "load_torque"):
        manipulator.slave_real_values(slave, [variables[name]], [start_of(expected)[name]])
    execution.simulate_until(target_time=int(0.02e9))
    offset, force = observer.last_real_values(slave, [variables["offset"], variables["force"]])
    assert 1e6 * offset == pytest.approx(-expected["dte_um"][-1], abs=1e-3)
    assert force == pytest.approx(expected["contact_force_N"][-1], abs=0.2)


@pytest.mark.parametrize("version", VERSIONS)
def test_ecos_moves_the_gear_pair_as_gearsim_does(fmu, run, version):
    from ecospy import EcosSimulation, EcosSimulationStructure

    expected = run()
    structure = EcosSimulationStructure()
    structure.add_model("pair", fmu("GearPair", version))
    start = {**start_of(expected), "relative_tolerance": 1e-8}
    structure.add_parameter_set("start", {f"pair::{name}": float(value) for name, value in start.items()})
    with EcosSimulation(structure=structure, step_size=1e-4) as simulation:
        simulation.init(parameter_set="start")
        simulation.step(200)
        assert 1e6 * simulation.get_real("pair::offset") == pytest.approx(-expected["dte_um"][-1], abs=1e-3)
        assert simulation.get_real("pair::force") == pytest.approx(expected["contact_force_N"][-1], abs=0.2)
