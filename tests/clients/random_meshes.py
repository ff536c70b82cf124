# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Random meshes of every law, with tables, poses, friction, tip edges, rings and double-helical gears, and states of them: what
one client of the library says of them, all others have to say to the last bit.

    random_meshes.py write MESHES.txt             the meshes as numbers
    random_meshes.py compare MESHES.txt BITS...   what programs printed of them, and the Python package, are alike
"""
from __future__ import annotations

import dataclasses
import pathlib
import struct
import sys

import gearmesh
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "libgearmesh" / "bindings"))
from header import Header  # noqa: E402

HEADER = Header(pathlib.Path(__file__).resolve().parents[2] / "libgearmesh" / "include" / "gearmesh" / "gearmesh.h")
POSE = ("center_distance_change", "offset", "axial_shift", "skew", "inclination")
KINDS = ("constant", "tables", "posed", "iso6336", "simple", "elastic", "ring", "corner", "friction", "double_helical")
EACH, STATES = 6, 3
ROWS, COLUMNS = 4, 3


@dataclasses.dataclass
class Case:
    kind: str
    pair: dict  # fields of gm_pair_params
    law: dict  # fields of gm_mesh_params, the pose in it
    gap: float  # NaN: one helix
    tables: np.ndarray | None  # [pinion, wheel, second half of the pinion][ROWS][COLUMNS], um
    states: list  # (angles and speeds [4], pose, its rate)

    def mesh(self, files=None):
        """The mesh of the Python package; tables from files in the place of arrays, which rounds them otherwise."""
        drawn = gearmesh.Pair(**self.pair) if np.isnan(self.gap) else gearmesh.Pair.half(self.gap, **self.pair)
        flanks = [None] * 3
        if self.tables is not None:
            flanks = [gearmesh.Flanks(drawn, role, table) for role, table in
                      zip(("pinion", "wheel", "pinion"), files or 1e-6 * self.tables)]
        if np.isnan(self.gap):
            return gearmesh.Mesh(drawn, *flanks[:2], **self.law)
        shared = {name: 0.5 * self.law[name] for name in ("stiffness", "damping") if name in self.law}
        return gearmesh.DoubleHelical(drawn, self.gap, (flanks[0], flanks[1]), (flanks[2], flanks[1]),
                                      **{**self.law, **shared})

    def table_files(self, paths):
        """Its tables in CSV files; the paths, or None without tables."""
        if self.tables is None:
            return None
        for path, table in zip(paths, self.tables):
            rows = [f"*,*,{row / (ROWS - 1)!r},{column / (COLUMNS - 1)!r},{float(value)!r}"
                    for (row, column), value in np.ndenumerate(table)]
            path.write_text("\n".join(["tooth,flank,t1,t2,deviation_um", *rows]) + "\n", encoding="utf-8")
        return [str(path) for path in paths]

    def at_rest(self, files=None):
        """Results at the states, without a motion of the wheel."""
        mesh = self.mesh(files)
        for state, _, _ in self.states:
            found = mesh.evaluate(*state)
            yield found if np.isnan(self.gap) else found.result


def drawing(rng, kind):
    teeth = int(rng.integers(19, 40))
    ring = kind == "ring"
    pair = {"pinion_teeth": teeth, "wheel_teeth": -int(teeth * rng.uniform(2.4, 3)) if ring else int(rng.integers(teeth, 90))}
    helix = np.radians(rng.uniform(8, 30) * rng.choice([-1, 1]))
    if kind in ("corner", "elastic", "ring") and rng.random() < 0.4:
        helix = 0.0
    module = rng.uniform(1e-3, 8e-3)
    width = module * rng.uniform(5, 14)
    teeth_sum = abs(pair["pinion_teeth"] + pair["wheel_teeth"])
    shift = rng.uniform(-0.1, 0.3)
    pair |= {"normal_module": module, "normal_pressure_angle": np.radians(rng.uniform(18, 25)), "helix_angle": helix,
             "center_distance": 0.5 * module * teeth_sum / np.cos(helix) + (0 if ring else shift * module),
             "backlash": 0.03 * module}
    if kind == "double_helical":
        pair |= {"pinion_face_width": 2.2 * width, "wheel_face_width": 2.2 * width * rng.uniform(0.8, 1.2)}
    elif rng.random() < 0.5:
        pair |= {"face_width": width}
    else:
        pair |= {"pinion_face_width": width, "wheel_face_width": width * rng.uniform(0.8, 1.2),
                 "axial_offset": 0.05 * width * rng.uniform(-1, 1)}
    return pair


def law_of(rng, kind, width):
    """Fields of gm_mesh_params."""
    damping = 1e-6 * 14e9 * width * rng.uniform(0.1, 1)
    laws = {"iso6336": {"law": "iso6336"}, "elastic": {"law": "elastic", "stations": int(rng.choice([5, 9])),
                                                       "reference_torque": 200.0}}
    law = {"stiffness": 14e9 * width, **laws.get(kind, {}), "damping": damping}
    if kind == "simple":
        law["model"] = "simple"
    if kind == "corner" or kind == "double_helical" and rng.random() < 0.5:
        law["corner_contact"] = gearmesh.lib.GM_CORNER_ON
    if kind == "friction" or kind in ("double_helical", "elastic") and rng.random() < 0.5:
        law["friction_coefficient"] = rng.uniform(0.03, 0.1)
    if kind == "friction" and rng.random() < 0.5:
        law |= {"friction_law": gearmesh.lib.GM_FRICTION_BENEDICT_KELLEY, "oil_viscosity": 0.05, "roughness": 0.5e-6}
    if kind not in ("simple", "elastic", "constant"):
        law["pose"] = pose_of(rng, tilted=kind != "ring")
    return law


def pose_of(rng, tilted=True, share=1.0):
    amounts = [30e-6, 30e-6, 100e-6, 3e-4 * tilted, 3e-4 * tilted]
    return {name: share * amount * rng.uniform(-1, 1) for name, amount in zip(POSE, amounts)}


def states_of(rng, case):
    """Somewhere under load, most of them, on either side; the wheel in a motion of its own where the pinion does not float."""
    mesh = case.mesh()
    radii = mesh.pair.pinion.base_radius, mesh.pair.wheel.base_radius
    moves = case.kind in ("posed", "ring", "elastic", "friction")
    for _ in range(STATES):
        angle, speed = rng.uniform(-40, 40), rng.uniform(20, 200)
        torque = radii[1] * 1e5 * mesh.pair.wheel.face_width * rng.uniform(0.5, 3) * rng.choice([-1, 1])
        offset = float(mesh.static(angle, torque).offset) * rng.choice([1.0, 1.02])
        yield ([angle, (radii[0] * angle - offset) / radii[1], speed, speed * radii[0] / radii[1] * rng.uniform(0.9999, 1)],
               pose_of(rng, case.kind != "ring", 0.3 * moves), pose_of(rng, case.kind != "ring", moves))


def cases():
    """All of them, the same in every run. Gears that cannot be are drawn again."""
    made = []
    for kind in KINDS:
        seed = 0
        while sum(case.kind == kind for case in made) < EACH:
            rng = np.random.default_rng([KINDS.index(kind), seed])
            seed += 1
            pair = drawing(rng, kind)
            width = min(pair.get(name, np.inf) for name in ("face_width", "pinion_face_width", "wheel_face_width"))
            gap = 0.1 * width if kind == "double_helical" else np.nan
            tables = rng.normal(0, 3, (3, ROWS, COLUMNS)) if kind in ("tables", "double_helical") or (
                kind in ("posed", "elastic", "ring", "friction") and seed % 2) else None
            case = Case(kind, pair, law_of(rng, kind, width), gap, tables, [])
            try:
                case.states = list(states_of(rng, case))
            except gearmesh.Error:
                continue
            if np.isfinite([state[0] for state in case.states]).all():
                made.append(case)
    return made


# ----------------------------------------------------------------------------------------------------
# As numbers
# ----------------------------------------------------------------------------------------------------


def fields(name, given):
    """Values in the order of the header: those that are given, else the defaults."""
    params = gearmesh.ffi.new(f"{name} *")
    getattr(gearmesh.lib, f"{name}_default")(params)
    for path, _, field in HEADER.parameters(name):
        value, place = given, params
        for part in path.split("."):
            value = value.get(part, {}) if isinstance(value, dict) else value
            place = getattr(place, part)
        if isinstance(value, str):
            value = HEADER.enums[field.enum].members[{"model": "GM_MODEL_", "law": "GM_LAW_"}[path] + value.upper()]
        yield path, place if value == {} else value


def text(case):
    lines = [repr(case.gap)]
    for name, given in (("gm_pair_params", case.pair), ("gm_mesh_params", case.law)):
        values = [repr(float(value) if isinstance(value, float) else value) for _, value in fields(name, given)]
        lines.append(" ".join([str(len(values)), *values]))
    lines.append(f"{ROWS} {COLUMNS}" if case.tables is not None else "0 0")
    if case.tables is not None:
        lines.append(" ".join(repr(float(value)) for value in case.tables.ravel()))
    lines.append(str(len(case.states)))
    for state, pose, rate in case.states:
        lines += [" ".join(repr(float(value)) for value in values) for values in (state, pose.values(), rate.values())]
    return "\n".join(lines) + "\n"


def write(path, made):
    pathlib.Path(path).write_text(f"{len(made)}\n" + "".join(text(case) for case in made), encoding="utf-8")


# ----------------------------------------------------------------------------------------------------
# What the Python package says
# ----------------------------------------------------------------------------------------------------


def evaluations(case, files=None, want=("derivatives", "wrench")):
    """(result, apex) at each state, one by one, as a solver goes.

    With derivatives the force between tip edges in a pose comes of another sum, up to rounding the same.
    """
    mesh = case.mesh(files)
    for state, pose, rate in case.states:
        if np.isnan(case.gap):
            yield mesh.evaluate(*state, want=want, pose=pose, pose_rate=rate), 0.0
        else:
            found = mesh.evaluate(*state, want=want)
            yield found.result, float(found.apex)


def numbers(result, apex):
    """In the order of the programs."""
    by = result.force_by
    wrench = [result.wrench[name] for name in ("pinion_force", "pinion_moment", "wheel_force", "wheel_moment")]
    return np.array([result.force, result.pinion_torque, result.wheel_torque, result.loss, by.pinion_angle, by.wheel_angle,
                     by.pinion_speed, by.wheel_speed, *np.concatenate(wrench), apex])


def bits(values):
    return ["NaN" if np.isnan(value) else struct.pack(">d", value).hex().upper() for value in values]


def compare(path, printed):
    made = cases()
    reference = pathlib.Path(printed[0]).read_text(encoding="utf-8").split("\n")[:-1]
    assert pathlib.Path(path).read_text(encoding="utf-8").startswith(f"{len(made)}\n")
    assert len(reference) == EACH * STATES * len(KINDS)
    for other in printed[1:]:
        found = [line.rstrip() for line in pathlib.Path(other).read_text(encoding="utf-8").split("\n")[:-1]]
        differ = [line for line, (a, b) in enumerate(zip(reference, found)) if a != b]
        assert found == reference, f"{other}: other bits in {len(differ)} of {len(reference)} lines, the first {differ[:1]}"

    # The package, and how many states bear a load: nearly all.
    loaded = 0
    lines = iter(reference)
    for case in made:
        for values in (numbers(*found) for found in evaluations(case)):
            expected = next(lines).split()[1:1 + len(values)]
            assert bits(values) == expected, (case.kind, values, expected)
            loaded += abs(values[0]) > 1.0
    assert loaded > 0.8 * len(reference), loaded
    print(f"{len(made)} meshes, {len(reference)} states, {loaded} under load: the same bits from {len(printed)} programs and Python")


if __name__ == "__main__":
    if sys.argv[1] == "write":
        write(sys.argv[2], cases())
    else:
        compare(sys.argv[2], sys.argv[3:])
