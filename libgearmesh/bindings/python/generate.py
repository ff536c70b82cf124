# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Writes what the package takes from the headers: the source of the extension module, and classes with the documentation of
every parameter and result.

    generate.py EXTENSION.c RECORDS.py
"""
import pathlib
import re
import sys

import cffi

folder = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(folder.parent))
from header import Header  # noqa: E402

# Structs that a caller fills (with keywords), that are read-only numbers, and that come in arrays.
PARAMETERS = {"gm_pair_params": "PairParameters", "gm_pose": "Pose", "gm_mesh_params": "MeshParameters",
              "gm_modification": "ModificationParameters", "gm_body": "Body"}
RECORDS = {"gm_gear": "Gear", "gm_pair": "PairRecord"}
ARRAYS = {"gm_gradient": "Gradient", "gm_penetration": "Penetration", "gm_wrench": "Wrench",
          "gm_mesh_result": "MeshResult", "gm_tangent": "Tangent", "gm_line_load_point": "LineLoadPoint",
          "gm_line_loads": "LineLoads"}


def declared(struct, types):
    lines = [f'    """{struct.doc}"""'.replace("\\", "\\\\")]
    for field in struct.fields:
        lines += ["", f"    {field.name}: {types(field)}", f'    """{field.doc}"""']
    return "\n".join(lines)


def parameter_type(header):
    def type_of(field):
        if field.pointers or field.size:
            return "ArrayLike"
        if field.enum in header.enums:
            return f"Union[int, Literal[{', '.join(repr(name) for name in short_names(header.enums[field.enum]))}]]"
        return PARAMETERS.get(field.type, {"int": "int"}.get(field.type, "float"))
    return type_of


def record_type(field):
    plain = RECORDS.get(field.type, {"int": "int"}.get(field.type, "float"))
    return f"tuple[{', '.join([plain] * field.size)}]" if field.size else plain


def array_type(field):
    return ARRAYS.get(field.type, {"int": "NDArray[np.int32]"}.get(field.type, "NDArray[np.float64]"))


def short_names(enum):
    """Members without their common beginning, as people type them: GM_MOD_TIP_RELIEF is tip_relief."""
    names = list(enum.members)
    words = [name.split("_") for name in names]
    common = 0
    while all(len(name) > common + 1 for name in words) and len({name[common] for name in words}) == 1:
        common += 1
    return {"_".join(name[common:]).lower(): value for name, value in zip(words, enum.members.values())}


def records(header):
    parts = ['"""Parameters and results with their documentation. Generated from gearmesh.h."""',
             "from __future__ import annotations", "import dataclasses",
             "from typing import Literal, TypedDict, Union", "import numpy as np", "from numpy.typing import ArrayLike, NDArray"]
    for name, title in PARAMETERS.items():
        parts.append(f"\nclass {title}(TypedDict, total=False):\n{declared(header.structs[name], parameter_type(header))}")
    for name, title in RECORDS.items():
        parts.append("\n@dataclasses.dataclass(frozen=True)\n"
                     f"class {title}:\n{declared(header.structs[name], record_type)}")
    for name, title in ARRAYS.items():
        parts.append(f"\nclass {title}(np.recarray):\n{declared(header.structs[name], array_type)}")
    modifications = {k: v for k, v in header.enums["gm_modification_kind"].members.items() if k.startswith("GM_MOD_")}
    header.enums["gm_modification_kind"].members = modifications
    enums = {name: short_names(enum) for name, enum in header.enums.items()}
    enum_fields = {name: {field.name: field.enum for field in struct.fields or [] if field.enum in enums}
                   for name, struct in header.structs.items()}
    parts.append(f"\nENUMS = {enums!r}\nENUM_FIELDS = { {k: v for k, v in enum_fields.items() if v}!r}")
    parts.append(f"CONSTANTS = {header.constants!r}\n")
    return "\n".join(parts)


def main(extension, records_file):
    include = folder.parents[1] / "include" / "gearmesh"
    core = Header(include / "gearmesh.h")
    files = Header(include / "gearmesh_io.h", core)

    loops = (folder / "loops.c").read_text(encoding="utf-8")
    prototypes = [" ".join(text.split()) for text in re.findall(r"^static (int [^{]*)\{", loops, flags=re.MULTILINE)]
    ffi = cffi.FFI()
    ffi.cdef("\n".join([core.cdef(), files.cdef(), *(f"{text};" for text in prototypes)]))
    ffi.set_source("gearmesh._gearmesh", "#include <gearmesh/gearmesh_io.h>\n#include <loops.c>")
    ffi.emit_c_code(extension)
    pathlib.Path(records_file).write_text(records(core), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
