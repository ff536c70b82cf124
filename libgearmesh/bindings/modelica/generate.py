# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Writes the records of the Modelica package, whose fields are those of gm_pair_params and gm_mesh_params, and where the
library finds their values.

    generate.py GEARMESH_PACKAGE_FOLDER INC_FOLDER
"""
import json
import pathlib
import re
import sys

folder = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(folder.parent))
from header import Header  # noqa: E402

RECORDS = {"gm_pair_params": ("PairParameters", "What a drawing gives of a gear pair"),
           "gm_mesh_params": ("MeshParameters", "Model and law of a mesh")}
KEYWORDS = {"model", "type", "record", "block", "function", "input", "output", "parameter", "constant", "initial", "end"}
UNITS = {"N s/m": "N.s/m", "N m": "N.m", "Pa s": "Pa.s"}


def binding(header, field):
    """The default as the comment has it in [brackets]; none where the field is required."""
    doc = " ".join(field.doc.split())
    found = re.search(r"\[([-\w.]+)[\]:]", doc)
    if found and found[1] != "NaN":
        members = header.enums[field.enum].members if field.enum in header.enums else {}
        return f" = {members.get(found[1], found[1])}"
    return "" if doc.endswith("required") else " = derived"


def record(header, struct):
    name, title = RECORDS[struct]
    lines = ["within GearMesh;", f'record {name} "{title}"', "  extends Modelica.Icons.Record;"]
    names = []
    for path, unit, field in header.parameters(struct):
        name_here = path.replace(".", "_")
        names.append(f"{name_here}_" if name_here in KEYWORDS else name_here)
        kind = {"double": "Real", "int": "Integer"}[field.type]
        attribute = f'(unit="{UNITS.get(unit, unit)}")' if unit else ""
        description = json.dumps(" ".join(field.doc.split()), ensure_ascii=False)
        lines.append(f"  parameter {kind} {names[-1]}{attribute}{binding(header, field)} {description}{choices(header, field)};")
    lines.append(f'  final parameter Real values[{len(names)}] = {{{", ".join(names)}}} "In the order of the library";')
    text = "<p>Fields and documentation are those of gearmesh.h. What is <code>derived</code> is left to the library: it derives " \
           "the value, or takes the default that the description gives.</p>"
    return "\n".join([*lines, f"  annotation(Documentation(info={json.dumps(f'<html>{text}</html>')}));", f"end {name};", ""])


def choices(header, field):
    if field.enum not in header.enums:
        return ""
    members = header.enums[field.enum].members.items()
    return f" annotation(choices({', '.join(f'choice={value} {json.dumps(name)}' for name, value in members)}))"


def places(header, struct):
    return "".join(f"{ {'double': 'REAL', 'int': 'INTEGER'}[field.type]}({struct}, {path}),\n"
                   for path, _, field in header.parameters(struct))


def main(package, includes):
    header = Header(folder.parents[1] / "include" / "gearmesh" / "gearmesh.h")
    for struct, (name, _) in RECORDS.items():
        (pathlib.Path(package) / f"{name}.mo").write_text(record(header, struct), encoding="utf-8")
        (pathlib.Path(includes) / f"{struct[3:-7]}_parameters.inc").write_text(places(header, struct), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
