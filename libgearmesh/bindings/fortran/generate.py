# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Writes the Fortran module `gearmesh` from the headers: constants, types and interfaces of all functions.

    generate.py GEARMESH.f90

Structs are types with bind(C). Arguments that the library documents as [n] are arrays, those that may be NULL are
optional. What is opaque in C (gm_mesh, gm_flanks, gm_cache) and plain memory are type(c_ptr).
"""
import pathlib
import re
import sys

folder = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(folder.parent))
from header import Header  # noqa: E402

KINDS = {"double": "real(c_double)", "int": "integer(c_int)", "unsigned": "integer(c_int)", "long": "integer(c_long)",
         "size_t": "integer(c_size_t)", "uint64_t": "integer(c_int64_t)", "char": "character(kind=c_char)"}
POINTER = "type(c_ptr)"
HEAD = """! SPDX-FileCopyrightText: The gearmesh authors
! SPDX-License-Identifier: BSD-3-Clause
!
! The functions of gearmesh.h and gearmesh_io.h, which document them. Generated from there.
module gearmesh
    use, intrinsic :: iso_c_binding
    implicit none
    public"""
TAIL = """contains

    !> A text of the library, as gm_status_text() returns it; empty for NULL.
    function gm_text(chars) result(text)
        type(c_ptr), intent(in) :: chars
        character(len=:), allocatable :: text
        character(kind=c_char), pointer :: letters(:)
        integer :: length

        text = ''
        if (.not. c_associated(chars)) return
        call c_f_pointer(chars, letters, [4096])
        do length = 1, size(letters)
            if (letters(length) == c_null_char) exit
            text = text // letters(length)
        end do
    end function
end module"""


class Module:
    def __init__(self, headers):
        self.headers = headers
        self.transparent = {name for header in headers for name, struct in header.structs.items() if struct.fields}

    def text(self):
        lines = [HEAD, ""]
        for name, value in self.headers[-1].constants.items():
            lines.append(f"    integer(c_int), parameter :: {name} = {value}")
        for header in self.headers:
            for enum in header.enums.values():
                lines += [f"    integer(c_int), parameter :: {name} = {value}" for name, value in enum.members.items()]
        for header in self.headers:
            lines += [line for struct in header.structs.values() if struct.fields for line in self._type(struct)]
        lines += ["", "    interface"]
        for header in self.headers:
            lines += [line for function in header.functions.values() for line in self._function(function)]
        return "\n".join(lines + ["    end interface", TAIL, ""])

    def _type(self, struct):
        yield f"\n    type, bind(C) :: {struct.name}"
        for field in struct.fields:
            size = f"({field.size})" if field.size else ""
            yield f"        {POINTER if field.pointers else self._kind(field.type)} :: {field.name}{size}"
        yield "    end type"

    def _kind(self, name):
        return f"type({name})" if name in self.transparent else KINDS[name]

    def _function(self, function):
        names = ", &\n            ".join(argument.name for argument in function.arguments)
        subroutine = function.result.type == "void" and not function.result.pointers
        word = "subroutine" if subroutine else "function"
        result = "" if subroutine else " result(returned)"
        yield f"\n        {word} {function.name}({names}) bind(C){result}"
        yield "            import"
        for argument in function.arguments:
            yield f"            {self._argument(function, argument)} :: {argument.name}"
        if not subroutine:
            yield f"            {POINTER if function.result.pointers else self._kind(function.result.type)} :: returned"
        yield f"        end {word}"

    def _argument(self, function, argument):
        """Declaration of a dummy argument, without its name."""
        found = re.search(rf"@param\[[a-z,]*\]\s+{argument.name}\s+(.*?)(?=@|\Z|\n\n)", function.doc, re.DOTALL)
        doc = found[1] if found else ""
        optional = ", optional" if "NULL" in doc else ""
        intent = "intent(in)" if argument.is_const else "intent(inout)"

        # Values, and addresses of what Fortran does not know.
        if not argument.pointers and not argument.size:
            return f"{self._kind(argument.type)}, value"
        if argument.pointers == 2:
            return f"{POINTER}, intent(out){optional}"
        if argument.type not in self.transparent and argument.type not in KINDS:
            return f"{POINTER}, value"

        # References: texts and arrays of any length, arrays of a known one, single variables.
        shape = ""
        if argument.size:
            shape = f", dimension({argument.size})"
        elif argument.type == "char" or doc.startswith("["):
            shape = ", dimension(*)"
        return f"{self._kind(argument.type)}{shape}, {intent}{optional}"


def main(output):
    include = folder.parents[1] / "include" / "gearmesh"
    core = Header(include / "gearmesh.h")
    text = Module([core, Header(include / "gearmesh_io.h", core)]).text()
    pathlib.Path(output).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
