# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Double-helical pairs: two meshes of opposite hand and a pinion that floats between them."""
from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _records
from ._gearmesh import ffi, lib
from ._memory import LINE_LOADS, POINT, RESULT, STATE, Error, fill, filled, stacked, status_text
from ._records import LineLoadPoint, MeshResult
from .flanks import Flanks
from .mesh import LineLoadsResult, Mesh, check, pointer, shown, wanted
from .pair import Pair

if TYPE_CHECKING:
    from typing_extensions import Unpack


class DoubleHelicalResult(NamedTuple):
    """Both halves at states, in the shape of the arguments."""

    result: MeshResult
    """of the pair: sums of both halves; derivatives are those with a floating pinion"""

    halves: MeshResult
    """[..., 2] of each half, the second as it is in its mirror"""

    apex: NDArray[np.float64]
    """how far the pinion has floated along +z against the wheel (m)"""


class DoubleHelicalStaticResult(NamedTuple):
    """Equilibria under load, in the shape of the arguments."""

    offset: NDArray[np.float64]
    """x (m); the transmission error is -x"""

    result: MeshResult
    """of the pair, with derivatives"""

    halves: MeshResult
    """[..., 2] of each half, with derivatives"""

    apex: NDArray[np.float64]
    """how far the pinion has floated along +z against the wheel (m)"""


class DoubleHelical:
    """
    Two halves of opposite hand with a `gap` between them (m). The pinion floats along its axis to where both carry the same
    force; the wheel stands.

    `pair`: that of one half, Pair.half(). `first_flanks` and `second_flanks`: (pinion, wheel) of the half at the pinion's
    face I and of the other one, both given from the outer face to the gap; None are ideal. Keywords are those of Mesh,
    for each half; `pose` is that of the whole wheel.

    Each thread needs one of its own where the law is elastic.
    """

    def __init__(self, pair: Pair, gap: float, first_flanks: tuple[Flanks | None, Flanks | None] = (None, None),
                 second_flanks: tuple[Flanks | None, Flanks | None] = (None, None),
                 **parameters: Unpack[_records.MeshParameters]):
        if not 0.0 <= gap < np.inf:
            raise Error(f"gap: must be at least 0 (got {gap})")
        whole, poses = ffi.new("gm_pose *"), ffi.new("gm_pose[2]")
        fill(whole, parameters.get("pose", {}))
        lib.gm_double_helical_pose(pair._struct, gap, whole, poses)

        # Each half is a mesh in its own pose, with memory of its own where the law needs it.
        self.pair = pair
        self._meshes = []
        for flanks, of_half in zip((first_flanks, second_flanks), poses):
            own: Any = {name: getattr(of_half, name) for name, _ in ffi.typeof("gm_pose").fields}
            parameters["pose"] = own
            self._meshes.append(Mesh(pair, *flanks, **parameters))
        self._struct = ffi.new("gm_double_helical *")
        self._struct.gap = gap
        for index, mesh in enumerate(self._meshes):
            self._struct.half[index] = mesh._struct
            self._struct.workspace[index] = mesh._workspace()

    def evaluate(self, pinion_angle: ArrayLike, wheel_angle: ArrayLike, pinion_speed: ArrayLike = 0.0,
                 wheel_speed: ArrayLike = 0.0, *, want: str | Iterable[str] = ()) -> DoubleHelicalResult:
        """
        Both halves at angles (rad) and speeds (rad/s) of both shafts, numbers or arrays that broadcast together; `want` and
        NaN as in Mesh.evaluate().

        The float of the pinion is found: `result.wheel_torque` (N m) is that of both halves, `halves.wheel_torque` [..., 2]
        that of each, `apex` the float (m). Derivatives by the angles in `result` are those with the pinion floating.
        """
        states = filled(STATE, {"pinion_angle": pinion_angle, "wheel_angle": wheel_angle, "pinion_speed": pinion_speed,
                                "wheel_speed": wheel_speed})
        return self._evaluate(lib.evaluate_halves, "gm_state *", states, states.shape, want)

    def evaluate_offset(self, pinion_angle: ArrayLike, offset: ArrayLike, offset_rate: ArrayLike = 0.0,
                        pinion_speed: ArrayLike = 0.0, *, want: str | Iterable[str] = ()) -> DoubleHelicalResult:
        """
        The same for a solver that integrates x = r_bp phi_p - r_bw phi_w: pinion angle (rad), x (m) and dx/dt (m/s), and for
        friction the speed of the pinion (rad/s).
        """
        coordinates = stacked(pinion_angle, offset, offset_rate, pinion_speed)
        return self._evaluate(lib.evaluate_halves_offsets, "double *", coordinates, coordinates.shape[:-1], want)

    def static(self, pinion_angle: ArrayLike, wheel_torque: ArrayLike,
               pinion_speed: ArrayLike = 0.0) -> DoubleHelicalStaticResult:
        """Quasi-static equilibrium, as Mesh.static(): under a torque on the wheel (N m) that both halves carry."""
        loads = stacked(pinion_angle, wheel_torque, pinion_speed)
        results, halves, apex = self._arrays(loads.shape[:-1])
        offsets = np.empty(apex.shape)
        check(lib.solve_halves(self._struct, results.size, pointer("double *", loads), pointer("double *", offsets),
                               pointer("double *", apex), pointer("gm_mesh_result *", halves),
                               pointer("gm_mesh_result *", results)))
        return DoubleHelicalStaticResult(offsets[()], shown(results), shown(halves), apex[()])

    def line_loads(self, pinion_angle: float, offset: float, apex: float, pinion_speed: float = 0.0) -> LineLoadsResult:
        """Load along the lines of both halves, z as in the whole pair; see Mesh.line_loads(). x and `apex` as static()
        gives them."""
        position = ffi.new("gm_position *")
        points: Any = np.empty(2 * lib.gm_mesh_line_load_points(self._struct.half[0]), POINT)
        load: Any = np.empty((), LINE_LOADS)
        status = lib.gm_position_from_pinion_angle(self.pair._struct, pinion_angle, offset, 0.0, position)
        if status >= lib.GM_OK:
            position.pinion_speed = pinion_speed
            status = lib.gm_double_helical_line_loads(self._struct, position, apex, pointer("gm_line_load_point *", points),
                                                      points.size, pointer("gm_line_loads *", load))
        if status < lib.GM_OK:
            raise Error(status_text(status))
        return LineLoadsResult(load[()], points[:load["points"]].view(LineLoadPoint))

    def _evaluate(self, loop: Any, kind: str, given: NDArray[Any], shape: tuple[int, ...],
                  want: str | Iterable[str]) -> DoubleHelicalResult:
        results, halves, apex = self._arrays(shape)
        check(loop(self._struct, results.size, pointer(kind, given), wanted(want), pointer("double *", apex),
                   pointer("gm_mesh_result *", halves), pointer("gm_mesh_result *", results)))
        return DoubleHelicalResult(shown(results), shown(halves), apex[()])

    @staticmethod
    def _arrays(shape: tuple[int, ...]) -> tuple[NDArray[Any], NDArray[Any], NDArray[np.float64]]:
        """Results, those of both halves, and floats of the pinion."""
        return np.empty(shape, RESULT), np.empty((*shape, 2), RESULT), np.full(shape, np.nan)
