# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Gear pairs."""
from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from . import _records
from ._gearmesh import ffi, lib
from ._memory import Error, fill, refusal
from ._records import ENUMS, Gear, PairRecord

if TYPE_CHECKING:
    from typing_extensions import Unpack


def _numbers(record: Any, struct: Any) -> dict[str, Any]:
    """The fields of a struct of C by their names, as Python has them."""

    def number(value: Any) -> Any:
        if not isinstance(value, ffi.CData):
            return value
        return Gear(**_numbers(Gear, value)) if ffi.typeof(value).kind == "struct" else tuple(value)

    return {field.name: number(getattr(struct, field.name)) for field in dataclasses.fields(record)}


def _drawing(parameters: Mapping[str, Any]) -> Any:
    struct = ffi.new("gm_pair_params *")
    lib.gm_pair_params_default(struct)
    fill(struct, parameters)
    return struct


class Pair(PairRecord):
    """
    A gear pair: what follows from a drawing, as read-only attributes.

    Keywords are the fields of gm_pair_params (all documented in `gearmesh._records.PairParameters`; those that are left
    out are derived): `pinion_teeth`, `wheel_teeth`, `normal_module` (m), `normal_pressure_angle` (rad), `helix_angle`
    (rad), `center_distance` (m), `face_width` (m), `backlash` (m) ...

    Attributes are the fields of gm_pair: `backlash` (m), `transverse_contact_ratio`, `transverse_base_pitch` (m) ... and
    of `pinion` and `wheel`: `base_radius` (m), `tip_radius` (m) ...

    Raises Error, which names the parameter that is at fault.
    """

    def __init__(self, **parameters: Unpack[_records.PairParameters]):
        self._derive(_drawing(parameters))

    @classmethod
    def half(cls, gap: float, **parameters: Unpack[_records.PairParameters]) -> Pair:
        """
        The pair of one half of a double-helical one (DoubleHelical), from the drawing of the whole. `gap` between the
        halves (m) is part of both face widths, `helix_angle` that of the half at the pinion's face I, `axial_offset` 0.
        """
        whole, struct = _drawing(parameters), ffi.new("gm_pair_params *")
        status = lib.gm_double_helical_half(whole, gap, struct)
        if status == lib.GM_ERR_PARAMETER:
            raise Error(f"gap: must be at least 0 (got {gap})")
        if status != lib.GM_OK:
            raise Error("must be helical gears without axial_offset, their faces wider than the gap")
        pair = cls.__new__(cls)
        pair._derive(struct)
        return pair

    def _derive(self, struct: Any) -> None:
        pair = ffi.new("gm_pair *")
        status = lib.gm_pair_init(pair, struct)
        if status != lib.GM_OK:
            raise refusal(lib.gm_pair_params_check, struct, status)
        PairRecord.__init__(self, **_numbers(PairRecord, pair))
        object.__setattr__(self, "_struct", pair)
        object.__setattr__(self, "_warnings", lib.gm_pair_warnings(pair, struct))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What does not forbid a run but an engineer wants to hear of: members of gm_pair_warning, `pinion_undercut`."""
        return tuple(name for name, bit in ENUMS["gm_pair_warning"].items() if self._warnings & bit)

    _struct: Any
    _warnings: int
