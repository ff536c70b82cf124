# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Flanks of a gear: deviations from files and arrays, pitch, designed modifications."""
from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Literal, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _records
from ._gearmesh import ffi, lib
from ._memory import Error, enum_value, fill, text
from .pair import Pair

if TYPE_CHECKING:
    from typing_extensions import Unpack

Path = Union[str, "os.PathLike[str]"]


class Modification:
    """
    One designed modification of all flanks of a side (libgearmesh/docs/modifications.md).

    `kind` is a member of gm_modification_kind: `tip_relief`, `crowning`, `helix_slope`, `end_relief_i` ...; `amount` in m.
    Keywords: `shape` (`linear`, `parabolic`, `circular`), `face_range` (m), `profile_range` with `profile_range_by`
    (`length`: m, `share`: 1, `radius`: m). They are documented in `gearmesh._records.ModificationParameters`.
    """

    def __init__(self, kind: str, amount: float, /, **parameters: Unpack[_records.ModificationParameters]):
        self._struct = ffi.new("gm_modification *")
        fill(self._struct, {"kind": kind, "amount": amount, **parameters})


class Flanks:
    """
    The flanks of one gear of a pair.

    `role`: "pinion" or "wheel". `deviations` along the surface normal, > 0 material added: a deviation file
    (libgearmesh/docs/flank-files.md), or an array in m of shape [n1, n2] (all flanks), [2, n1, n2] (all drive, all coast
    flanks) or [teeth, 2, n1, n2], whose nodes are evenly spaced in t1 (face) and t2 (profile), both 0 .. 1. A flank of the
    last kind that is all NaN is ideal. `pitch`: a pitch file, or an array in m of shape [teeth, 2] (drive, coast), shifts
    along the line of action, > 0 material added. `drive` and `coast`: modifications of all flanks of that side.
    `in_transverse_section=True`: deviations and modifications are in the transverse section, not along the normal.

    Raises Error, which names file and line or the argument that is at fault.
    """

    def __init__(self, pair: Pair, role: Literal["pinion", "wheel"], deviations: Path | ArrayLike | None = None,
                 pitch: Path | ArrayLike | None = None, *, drive: Iterable[Modification] = (),
                 coast: Iterable[Modification] = (), in_transverse_section: bool = False):
        if role not in ("pinion", "wheel"):
            raise Error(f"role: must be 'pinion' or 'wheel' (got {role!r})")
        gear = getattr(pair._struct, role)
        self.teeth: int = gear.teeth
        error = ffi.new("gm_io_error *")
        deviations_struct, deviations_kept = _deviations(deviations, self.teeth, error)
        pitch_struct, pitch_kept = _pitch(pitch, self.teeth, error)

        # The arrays of the modifications live as long as this function.
        options = ffi.new("gm_flanks_options *")
        lib.gm_flanks_options_default(options)
        options.normal_factor = 1.0 if in_transverse_section else pair.normal_to_transverse
        designs = [_modifications(list(given), ffi.addressof(pair._struct, role)) for given in (drive, coast)]
        options.drive_modifications, options.coast_modifications = (design[0] for design in designs)

        built = ffi.new("gm_flanks **")
        _check(lib.gm_flanks_build(built, self.teeth, deviations_struct, pitch_struct, options, ffi.NULL, error), error)
        self._struct: Any = ffi.gc(built[0], lib.gm_flanks_free)

    def peak(self, side: Literal["drive", "coast"]) -> float:
        """Most material that any tooth of a side adds to the ideal flank, pitch included (m)."""
        return float(lib.gm_flanks_peak(self._struct, enum_value("gm_flank_side", side)))

    def depth(self, side: Literal["drive", "coast"]) -> float:
        """How deep the flanks of a side are modified, pitch not included (m)."""
        return float(lib.gm_flanks_depth(self._struct, enum_value("gm_flank_side", side)))


def _check(status: int, error: Any) -> None:
    if status == lib.GM_IO_OK:
        return
    place = text(error.file)
    if place and error.line:
        place += f":{error.line}"
    raise Error(f"{place}: {text(error.text)}" if place else text(error.text))


def _is_path(given: Any) -> bool:
    return isinstance(given, (str, os.PathLike))


def _deviations(given: Any, teeth: int, error: Any) -> tuple[Any, Any]:
    """A struct of the library, NULL for None, and what has to be kept as long as it is used."""
    if given is None:
        return ffi.NULL, None
    if _is_path(given):
        struct = ffi.new("gm_deviations *")
        _check(lib.gm_deviations_read(struct, os.fsencode(given), teeth, error), error)
        return ffi.gc(struct, lib.gm_deviations_free), None

    # Arrays of all shapes as [tooth][side][n1][n2], where one tooth or side stands for all.
    array = np.ascontiguousarray(given, dtype=float)
    if array.ndim not in (2, 3, 4) or array.shape[:-2] not in ((), (2,), (teeth, 2)):
        raise Error(f"deviations: must have the shape [n1, n2], [2, n1, n2] or [{teeth}, 2, n1, n2] (got {array.shape})")
    tables = array.reshape((-1, 1 if array.ndim == 2 else 2) + array.shape[-2:])
    chosen = [(tooth, side) for tooth, side in np.ndindex(*tables.shape[:2]) if not np.isnan(tables[tooth, side]).all()]
    sets = ffi.new("gm_deviation_set[]", len(chosen))
    for made, (tooth, side) in zip(sets, chosen):
        made.tooth = tooth if array.ndim == 4 else -1
        made.side = side if array.ndim > 2 else -1
        made.values = ffi.cast("double *", tables[tooth, side].ctypes.data)
    struct = ffi.new("gm_deviations *", {"teeth": teeth, "face_nodes": array.shape[-2], "profile_nodes": array.shape[-1],
                                         "set_count": len(chosen), "sets": sets})
    return struct, (tables, sets)


def _pitch(given: Any, teeth: int, error: Any) -> tuple[Any, Any]:
    """As _deviations()."""
    if given is None:
        return ffi.NULL, None
    struct = ffi.new("gm_pitch *")
    if _is_path(given):
        _check(lib.gm_pitch_read(struct, os.fsencode(given), teeth, error), error)
        return ffi.gc(struct, lib.gm_pitch_free), None

    array = np.asarray(given, dtype=float)
    if array.shape != (teeth, 2):
        raise Error(f"pitch: must have the shape [{teeth}, 2] (got {array.shape})")
    values = np.ascontiguousarray(array.T)
    is_set = np.ones(teeth, dtype=np.intc)
    struct.teeth = teeth
    struct.drive, struct.coast = (ffi.cast("double *", side.ctypes.data) for side in values)
    struct.drive_set = struct.coast_set = ffi.cast("int *", is_set.ctypes.data)
    return struct, (values, is_set)


def _modifications(given: list[Modification], gear: Any) -> tuple[Any, Any]:
    """As _deviations()."""
    if not given:
        return ffi.NULL, None
    listed = ffi.new("gm_modification[]", [modification._struct[0] for modification in given])
    struct = ffi.new("gm_modifications *", {"list": listed, "count": len(given), "gear": gear,
                                            "face_width": gear.face_width})
    index, field, requirement = ffi.new("int *"), ffi.new("char **"), ffi.new("char **")
    if lib.gm_modifications_check(struct, index, field, requirement) != lib.GM_OK:
        raise Error(f"modification {index[0]}: {text(field[0])}: must be {text(requirement[0])}"
                    if field[0] else f"modifications: at most {lib.GM_MODIFICATIONS_MAX}")
    return struct, listed
