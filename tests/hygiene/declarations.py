#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
What the bindings are generated from is all that the headers declare, of types that are known, every field with its
documentation. A declaration that bindings/header.py cannot read is an error of its own.

    declarations.py FOLDER_OF_THE_PROJECT
"""
import pathlib
import re
import sys

TYPES = {"void", "char", "int", "unsigned", "long", "double", "size_t", "uint64_t", "FILE"}


def main(root):
    library = pathlib.Path(root) / "libgearmesh"
    sys.path.insert(0, str(library / "bindings"))
    from header import Header

    offences, known, header = [], set(TYPES), None
    for name in ("gearmesh.h", "gearmesh_io.h"):
        text = (library / "include" / "gearmesh" / name).read_text(encoding="utf-8")
        header = Header(library / "include" / "gearmesh" / name, header)
        known |= set(header.structs)

        # The same lists by simpler means.
        for kind, pattern, found in (("functions", r"^GM_API[^;]*?\b(gm_\w+)\(", header.functions),
                                     ("structs", r"^typedef struct (gm_\w+)", header.structs),
                                     ("enums", r"^enum (gm_\w+) \{", header.enums)):
            expected = set(re.findall(pattern, text, re.MULTILINE))
            if not expected or expected != set(found):
                offences.append(f"{name}: {kind} that are not read, or only there: {sorted(expected ^ set(found))}")

        variables = [(struct.name, field) for struct in header.structs.values() for field in struct.fields or []]
        offences += [f"{name}: {place}.{field.name}: not documented" for place, field in variables if not field.doc]
        variables += [(function.name, argument) for function in header.functions.values()
                      for argument in [*function.arguments, function.result]]
        offences += [f"{name}: {place}: unknown type {variable.declaration}"
                     for place, variable in variables if variable.type not in known]
    print(*offences, sep="\n", file=sys.stderr)
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
