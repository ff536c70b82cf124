# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""The mesh: force, derivatives and wrench for one state or for many."""
from __future__ import annotations

import threading
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _records
from ._gearmesh import ffi, lib
from ._memory import (BODY, LINE_LOADS, LOAD, POINT, POSE, RESULT, STATE, TANGENT, Error, doubles, enum_value, fill, filled,
                      refusal, stacked, status_text)
from ._records import Body, LineLoadPoint, LineLoads, MeshResult, Tangent
from .flanks import Flanks
from .pair import Pair

if TYPE_CHECKING:
    from typing_extensions import Unpack


class StaticResult(NamedTuple):
    """Equilibria under load, in the shape of the arguments."""

    offset: NDArray[np.float64]
    """x (m); the transmission error is -x"""

    result: MeshResult
    """the mesh there, with derivatives"""


class LineLoadsResult(NamedTuple):
    """How a mesh is loaded at one position."""

    load: LineLoads
    """largest line load and pressure, face load factor, touching width"""

    points: LineLoadPoint
    """[points] along the lines of contact, in the order of sides, lines and z: `z`, `line_load`, `pressure`, `gap` ..."""


class BodiesResult(NamedTuple):
    """What the mesh does to two bodies at their reference points, in the common frame, each [..., 3]."""

    result: MeshResult
    """in the frame of the mesh, with the wrench"""

    pinion_force: NDArray[np.float64]
    """(N)"""

    pinion_moment: NDArray[np.float64]
    """(N m)"""

    wheel_force: NDArray[np.float64]
    """(N)"""

    wheel_moment: NDArray[np.float64]
    """(N m)"""


class Mesh:
    """
    Pair, flanks of both gears and force law, ready for evaluation from any number of threads.

    Flanks that are left out are ideal. Keywords are the fields of gm_mesh_params (documented in
    `gearmesh._records.MeshParameters`): `stiffness` of a pair of teeth (N/m), `damping` (N s/m), `model` ("3d" or "simple"),
    `pose` of the wheel as a dict: `pose={"skew": 1e-4}` (m, rad).

    Raises Error, which names the parameter that is at fault.
    """

    def __init__(self, pair: Pair, pinion_flanks: Flanks | None = None, wheel_flanks: Flanks | None = None,
                 **parameters: Unpack[_records.MeshParameters]):
        struct = ffi.new("gm_mesh_params *")
        lib.gm_mesh_params_default(struct)
        arrays = fill(struct, parameters)
        for name, array in arrays.items():
            teeth = (pair.pinion if name.startswith("pinion") else pair.wheel).teeth
            if array.shape != (teeth,):
                raise Error(f"{name}: must have the shape [{teeth}] (got {list(array.shape)})")
        if lib.gm_mesh_params_check(struct, ffi.NULL, ffi.NULL) != lib.GM_OK:
            raise refusal(lib.gm_mesh_params_check, struct, lib.GM_ERR_PARAMETER)

        # The mesh refers to flanks and arrays and lies in memory of ours: all of it lives as long as it does.
        self.pair = pair
        self._flanks = (pinion_flanks, wheel_flanks)
        self._arrays = arrays
        size = lib.gm_mesh_size(struct, pair._struct)
        self._memory = doubles(size)
        mesh = ffi.new("gm_mesh **")
        flank_structs = (flanks._struct if flanks else ffi.NULL for flanks in self._flanks)
        status = lib.gm_mesh_init(mesh, struct, pair._struct, *flank_structs, self._memory, size)
        if status != lib.GM_OK:
            raise Error(status_text(status))
        self._struct = mesh[0]
        self._of_thread = threading.local()

    def evaluate(self, pinion_angle: ArrayLike, wheel_angle: ArrayLike, pinion_speed: ArrayLike = 0.0,
                 wheel_speed: ArrayLike = 0.0, *, want: str | Iterable[str] = (),
                 pose: Mapping[str, ArrayLike] | None = None, pose_rate: Mapping[str, ArrayLike] | None = None,
                 out: MeshResult | None = None) -> MeshResult:
        """
        Force, penetration and contact at angles (rad) and speeds (rad/s), numbers or arrays that broadcast together.

        `want`: members of gm_wanted, one or several: "derivatives", "wrench", "pairs", "energy". `pose` of the wheel at each
        state, in addition to the one that the mesh was prepared in, and its rate: dicts of fields of gm_pose (m, rad; m/s,
        rad/s).

        The result has the shape of the arguments and the fields of gm_mesh_result as attributes: `force` (N),
        `force_by.wheel_angle` (N/rad), `contact.drive_contact`, `wrench.pinion_moment` [..., 3] (N m) ...; what was not
        asked for is NaN. So is everything where a state is refused: an angle that is no number, or |x| of half a base pitch,
        where a tooth would be skipped. Solvers that control their step take NaN as a demand for a smaller one.

        `out`: the array that an earlier call returned, of the same shape, which is overwritten and returned. Of many states
        of ideal flanks, new memory (336 bytes each) can take longer than the evaluation.
        """
        states = filled(STATE, {"pinion_angle": pinion_angle, "wheel_angle": wheel_angle, "pinion_speed": pinion_speed,
                                "wheel_speed": wheel_speed})
        return self._evaluate(lib.evaluate_states, "gm_state *", states, states.shape, want, pose, pose_rate, out)

    def evaluate_offset(self, pinion_angle: ArrayLike, offset: ArrayLike, offset_rate: ArrayLike = 0.0,
                        pinion_speed: ArrayLike = 0.0, *, want: str | Iterable[str] = (), pose: Mapping[str, ArrayLike] | None = None,
                        pose_rate: Mapping[str, ArrayLike] | None = None, out: MeshResult | None = None) -> MeshResult:
        """
        The same for a solver that integrates x = r_bp phi_p - r_bw phi_w in place of the wheel's angle: pinion angle (rad),
        x (m) and dx/dt (m/s), and for friction the speed of the pinion (rad/s).

        Derivatives are by the angles all the same; at a fixed pinion angle d/dx = -(d/d phi_w) / r_bw.
        """
        coordinates = stacked(pinion_angle, offset, offset_rate, pinion_speed)
        return self._evaluate(lib.evaluate_offsets, "double *", coordinates, coordinates.shape[:-1], want, pose, pose_rate,
                              out)

    def tangent(self, pinion_angle: ArrayLike, wheel_angle: ArrayLike, pinion_speed: ArrayLike = 0.0,
                wheel_speed: ArrayLike = 0.0, *, pose: Mapping[str, ArrayLike] | None = None,
                pose_rate: Mapping[str, ArrayLike] | None = None) -> Tangent:
        """
        Exact derivatives of force and wrench by both angles and the pose, and by their rates, where evaluate() has the same
        arguments: `force_by` [..., 7], `wrench_by.wheel_moment` [..., 7, 3] ..., in the order of gm_coordinate.

        Friction is in the wrench. Not for elastic teeth (Error).
        """
        states = filled(STATE, {"pinion_angle": pinion_angle, "wheel_angle": wheel_angle, "pinion_speed": pinion_speed,
                                "wheel_speed": wheel_speed})
        tangents: Any = np.empty(states.shape, TANGENT)
        check(lib.evaluate_tangents(self._struct, tangents.size, pointer("gm_state *", states),
                                    pointer("gm_pose *", _poses(states.shape, pose, pose_rate)),
                                    pointer("gm_tangent *", tangents)))
        shown: Tangent = tangents.view(Tangent) if tangents.shape else tangents[()]
        return shown

    def evaluate_bodies(self, pinion: Body, wheel: Body, *, want: str | Iterable[str] = ()) -> BodiesResult:
        """
        Force and moment on two rigid bodies in any common frame, as a multibody code has them.

        Each body is a dict of the fields of gm_body: `position` [..., 3] of the middle of its face (m), `rotation`
        [..., 3, 3] from the body's axes to the common frame, `velocity` [..., 3] (m/s), `angular_velocity` [..., 3] (rad/s).
        Angles and NaN are as in evaluate(); whole turns need not be known.
        """
        pair = np.broadcast_arrays(*(filled(BODY, body, required=True) for body in (pinion, wheel)))
        bodies = np.stack(pair, axis=-1)
        results, loads = np.empty(bodies.shape[:-1], RESULT), np.empty(bodies.shape, LOAD)
        check(lib.evaluate_bodies(self._struct, results.size, pointer("gm_body *", bodies), wanted(want),
                                  self._workspace(), pointer("gm_mesh_result *", results), pointer("gm_load *", loads)))
        return BodiesResult(shown(results), loads["force"][..., 0, :], loads["moment"][..., 0, :],
                            loads["force"][..., 1, :], loads["moment"][..., 1, :])

    def static(self, pinion_angle: ArrayLike, wheel_torque: ArrayLike, pinion_speed: ArrayLike = 0.0) -> StaticResult:
        """
        Quasi-static equilibrium at pinion angles (rad) under a torque on the wheel (N m, > 0 loads the drive flanks), with
        friction while the gears roll on each other at the speed of the pinion (rad/s).

        The transmission error is -offset. Neighbouring angles under the same torque cost half. NaN where there is no
        equilibrium.
        """
        loads = stacked(pinion_angle, wheel_torque, pinion_speed)
        shape = loads.shape[:-1]
        offsets = np.empty(shape)
        results = np.empty(shape, RESULT)
        status = lib.solve_static(self._struct, offsets.size, pointer("double *", loads), self._workspace(),
                                  pointer("double *", offsets), pointer("gm_mesh_result *", results))
        check(status)
        return StaticResult(offsets[()], shown(results))

    def line_loads(self, pinion_angle: float, offset: float, pinion_speed: float = 0.0) -> LineLoadsResult:
        """
        Load along the lines of contact at one pinion angle (rad) and x (m), as static() gives it, without damping. The speed
        of the pinion (rad/s) tells how fast the flanks slide there.

        Of the points, those of a pair are `points[points.pinion_tooth == tooth]`. Where evaluate_offset() gives NaN, `load`
        is NaN and there are no points. Raises Error for a mesh of the simple model.
        """
        position = ffi.new("gm_position *")
        points: Any = np.empty(lib.gm_mesh_line_load_points(self._struct), POINT)
        load: Any = np.empty((), LINE_LOADS)
        # What is refused as an angle or x is NaN in the position, and refused again.
        status = lib.gm_position_from_pinion_angle(self.pair._struct, pinion_angle, offset, 0.0, position)
        if status >= lib.GM_OK:
            position.pinion_speed = pinion_speed
            status = lib.gm_mesh_line_loads(self._struct, position, self._workspace(),
                                            pointer("gm_line_load_point *", points), points.size,
                                            pointer("gm_line_loads *", load))
        if status < lib.GM_OK:
            raise Error(status_text(status))
        return LineLoadsResult(load[()], points[:load["points"]].view(LineLoadPoint))

    def eigenfrequency(self, pinion_inertia: float, wheel_inertia: float) -> float:
        """Of two bodies (kg m2; math.inf: its motion is prescribed) on the mean stiffness of the mesh (Hz)."""
        return float(lib.gm_mesh_eigenfrequency(self._struct, pinion_inertia, wheel_inertia))

    def clearance(self, side: Literal["drive", "coast"]) -> float:
        """How far x may go before flanks of a side can touch (m)."""
        return float(lib.gm_mesh_clearance(self._struct, enum_value("gm_flank_side", side)))

    @property
    def mean_stiffness(self) -> float:
        """Along the line of action, over all pairs that touch on average (N/m)."""
        return float(lib.gm_mesh_mean_stiffness(self._struct))

    @property
    def mean_damping(self) -> float:
        """Likewise (N s/m)."""
        return float(lib.gm_mesh_mean_damping(self._struct))

    def _workspace(self) -> Any:
        """What an iterative law needs, one for each thread; NULL where the law needs none."""
        size = lib.gm_workspace_size(self._struct)
        if size == 0:
            return ffi.NULL
        if not hasattr(self._of_thread, "workspace"):
            memory, workspace = doubles(size), ffi.new("gm_workspace **")
            check(lib.gm_workspace_init(workspace, self._struct, memory, size))
            self._of_thread.memory, self._of_thread.workspace = memory, workspace[0]
        return self._of_thread.workspace

    def _evaluate(self, loop: Any, kind: str, given: NDArray[Any], shape: tuple[int, ...],
                  want: Union[str, Iterable[str]], pose: Mapping[str, ArrayLike] | None,
                  pose_rate: Mapping[str, ArrayLike] | None, out: MeshResult | None) -> MeshResult:
        results: Any = np.empty(shape, RESULT) if out is None else out
        if not (isinstance(results, np.ndarray) and results.dtype == RESULT and results.shape == shape and
                results.flags.carray):
            raise Error(f"out: must be what an earlier call returned, of the shape {list(shape)}"
                        f" (got {getattr(out, 'dtype', type(out))} {list(getattr(out, 'shape', []))})")

        poses = None
        if pose is not None or pose_rate is not None:
            poses = _poses(shape, pose, pose_rate)
        check(loop(self._struct, results.size, pointer(kind, given),
                   ffi.NULL if poses is None else pointer("gm_pose *", poses), wanted(want), self._workspace(),
                   pointer("gm_mesh_result *", results)))
        return shown(results) if out is None else out


def _poses(shape: tuple[int, ...], pose: Mapping[str, ArrayLike] | None,
           rate: Mapping[str, ArrayLike] | None) -> NDArray[Any]:
    """[..., 2] pose and its rate at each state."""
    poses = np.empty((*shape, 2), POSE)
    poses[..., 0], poses[..., 1] = filled(POSE, pose or {}), filled(POSE, rate or {})
    return poses


def wanted(want: Union[str, Iterable[str]]) -> int:
    return sum({enum_value("gm_wanted", name) for name in ([want] if isinstance(want, str) else want)})


def pointer(kind: str, array: NDArray[Any]) -> Any:
    return ffi.cast(kind, array.ctypes.data)


def check(status: int) -> None:
    if status != lib.GM_OK:
        raise Error(status_text(status))


def shown(results: Any) -> MeshResult:
    """Fields as attributes; a single result has numbers."""
    shown: MeshResult = results.view(MeshResult) if results.shape else results[()]
    return shown
