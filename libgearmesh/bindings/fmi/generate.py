# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Writes the rows of the parameters of an FMU, which are the fields of gm_pair_params and gm_mesh_params, and the functions
of the standard that it has to have but refuses.

    generate.py parameters PARAMETERS.inc
    generate.py refused FUNCTION_TYPES.h IMPLEMENTED.c REFUSED.c
"""
import json
import pathlib
import re
import sys

folder = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(folder.parent))
from header import Header  # noqa: E402

FMI_UNITS = {"N s/m": "N.s/m", "N m": "N.m", "Pa s": "Pa.s"}


def rows(header, struct, place):
    for name, unit, field in header.parameters(struct):
        kind = {"double": "REAL", "int": "INTEGER"}[field.type]
        yield (f'{{"{name}", {json.dumps(FMI_UNITS.get(unit, unit))}, {json.dumps(" ".join(field.doc.split()))}, '
               f"KIND_{kind}, ROLE_PARAMETER, offsetof(fmu_values, {place}.{name}), 0.0, 0}},")


def parameters(output):
    header = Header(folder.parents[1] / "include" / "gearmesh" / "gearmesh.h")
    lines = ["/* Generated from gearmesh.h. */",
             *rows(header, "gm_pair_params", "pair"), *rows(header, "gm_mesh_params", "mesh")]
    pathlib.Path(output).write_text("\n".join(lines) + "\n", encoding="utf-8")


def refused(types, implemented, output):
    """Every function type of the standard that has no function among the implemented ones: it returns an error."""
    text = re.sub(r"/\*.*?\*/", "", pathlib.Path(types).read_text(encoding="utf-8"), flags=re.DOTALL)
    present = set(re.findall(r"^[\w *]*\b(fmi\d\w+)\(", pathlib.Path(implemented).read_text(encoding="utf-8"), re.MULTILINE))
    prefix = pathlib.Path(types).name[:4]
    lines = [f"#include <{prefix}Functions.h>"]
    for result, name, arguments in re.findall(rf"typedef\s+([\w *]+?)\s*({prefix}\w+)TYPE\s*\((.*?)\);", text, re.DOTALL):
        if name not in present:
            names = re.findall(r"(\w+)(?:\[\])?\s*(?:,|$)", arguments)
            unused = " ".join(f"(void){argument};" for argument in names)
            value = f"{prefix}Error" if result == f"{prefix}Status" else "0"
            lines.append(f"{result} {name}({' '.join(arguments.split())}) {{ {unused} return {value}; }}")
    pathlib.Path(output).write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    {"parameters": parameters, "refused": refused}[sys.argv[1]](*sys.argv[2:])
