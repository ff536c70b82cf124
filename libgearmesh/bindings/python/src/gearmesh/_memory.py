# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Between Python and C: errors, structs that are filled from keywords, structs as types of numpy."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._gearmesh import ffi, lib
from ._records import ENUM_FIELDS, ENUMS


class Error(ValueError):
    """What was asked for is refused; the text says why, and what would be right."""


def status_text(status: int) -> str:
    return text(lib.gm_status_text(status))


def text(chars: Any) -> str:
    return str(ffi.string(chars).decode("utf-8", "replace"))


def doubles(size: int) -> Any:
    """Memory of `size` bytes, aligned for double."""
    return ffi.new("double[]", (size + 7) // 8)


def enum_value(enum: str, value: Any) -> int:
    """The number of a member that is given by its name, as in gearmesh.h without the common beginning, or by itself."""
    if not isinstance(value, str):
        return int(value)
    if value not in ENUMS[enum]:
        raise Error(f"must be one of {', '.join(ENUMS[enum])} (got '{value}')")
    return ENUMS[enum][value]


def fill(struct: Any, values: Mapping[str, Any]) -> dict[str, NDArray[np.float64]]:
    """Sets fields of a struct; a struct within it takes a dict. Returns the arrays that it points to, by their names: they
    have to live as long as it is used."""
    kind = ffi.typeof(struct)
    kind = kind.item if kind.kind == "pointer" else kind
    fields = dict(kind.fields)
    enums = ENUM_FIELDS.get(kind.cname.split()[-1], {})
    arrays = {}
    for name, value in values.items():
        if name not in fields:
            raise Error(f"{name}: no such parameter; there are {', '.join(fields)}")
        if isinstance(value, Mapping):
            arrays.update(fill(getattr(struct, name), value))
            continue
        try:
            if fields[name].type.kind == "pointer":
                arrays[name] = np.array(value, dtype=float, ndmin=1)
                value = ffi.cast("double *", arrays[name].ctypes.data)
            setattr(struct, name, enum_value(enums[name], value) if name in enums else value)
        except Error as error:
            raise Error(f"{name}: {error}") from None
        except (TypeError, ValueError, OverflowError) as error:
            raise Error(f"{name}: must be a number in the range of its type (got {value!r})") from error
    return arrays


def refusal(check: Any, struct: Any, status: int) -> Error:
    """What the library says about parameters that it refuses."""
    field, requirement = ffi.new("char **"), ffi.new("char **")
    check(struct, field, requirement)
    if not field[0]:
        return Error(status_text(status))
    name = text(field[0])
    value = struct
    for part in name.split("."):
        value = getattr(value, part)
    return Error(f"{name}: must be {text(requirement[0])} (got {value})")


_PLAIN = {"double": np.float64, "int": np.intc}


def dtype_of(kind: Any) -> np.dtype:
    """A struct of C as a type of numpy that has the same places in memory."""
    if kind.kind == "array":
        return np.dtype((dtype_of(kind.item), (kind.length,)))
    if kind.kind == "primitive":
        return np.dtype(_PLAIN[kind.cname])
    names, fields = zip(*kind.fields)
    return np.dtype({"names": names, "formats": [dtype_of(field.type) for field in fields],
                     "offsets": [field.offset for field in fields], "itemsize": ffi.sizeof(kind)})


STATE, POSE, BODY, LOAD = (dtype_of(ffi.typeof(name)) for name in ("gm_state", "gm_pose", "gm_body", "gm_load"))
TANGENT = np.dtype((np.record, dtype_of(ffi.typeof("gm_tangent"))))
RESULT = np.dtype((np.record, dtype_of(ffi.typeof("gm_mesh_result"))))
POINT = np.dtype((np.record, dtype_of(ffi.typeof("gm_line_load_point"))))
LINE_LOADS = np.dtype((np.record, dtype_of(ffi.typeof("gm_line_loads"))))


def filled(kind: np.dtype, values: Mapping[str, Any], *, required: bool = False) -> Any:
    """An array of structs from arrays that broadcast together by their leading axes. Fields that are left out are 0, or
    refused if they are required."""
    names: tuple[str, ...] = kind.names or ()
    for name in values:
        if name not in names:
            raise TypeError(f"no such argument: {name}; there are {', '.join(names)}")
    missing = [name for name in names if name not in values]
    if missing and required:
        raise TypeError(f"missing: {', '.join(missing)}")

    # Matrices may come as such: the last axes of a field count as one.
    arrays = {}
    for name, value in values.items():
        array, own = np.asarray(value, dtype=float), kind[name].shape
        if own == (9,) and array.shape[-2:] == (3, 3):
            array = array.reshape(array.shape[:-2] + (9,))
        if array.shape[array.ndim - len(own):] != own:
            raise Error(f"{name}: must have the shape [..., {own[0]}] (got {list(array.shape)})")
        arrays[name] = array
    shape = np.broadcast_shapes(*(array.shape[:array.ndim - len(kind[name].shape)] for name, array in arrays.items()))
    structs = np.zeros(shape, kind)
    for name, array in arrays.items():
        structs[name] = array
    return structs


def stacked(*values: ArrayLike) -> NDArray[np.float64]:
    """Arrays that broadcast together, beside each other along a last axis."""
    return np.stack(np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in values)), axis=-1)
