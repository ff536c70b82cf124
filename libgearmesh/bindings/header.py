# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
What a public header of gearmesh declares, with its comments: the bindings are generated from it, so that none of them
can say something else than the header. It reads C as the headers of this project are written, no more.
"""
from __future__ import annotations

import dataclasses
import re

UNIT = re.compile(r"(?:^|[,(] ?|[0-9] )(rad|N/m2|N/m|N s/m|N m|Pa s|m/s|m)(?=[,;:)\] ]|$)")
TOKEN = re.compile(r'/\*.*?\*/|"[^"]*"|[A-Za-z_]\w*|\d[\w.]*|\.\.\.|\S', re.DOTALL)


@dataclasses.dataclass
class Variable:
    """A field of a struct, or an argument of a function."""

    name: str
    type: str  # without const: `double`, `gm_pair`, `char`
    pointers: int  # how many stars
    is_const: bool  # what it points to
    size: int | None  # of an array
    doc: str = ""

    @property
    def enum(self):
        """Name of the enum whose members an int takes, as its comment says; None if there is none."""
        found = re.search(r"enum (gm_\w+)", self.doc) if self.type == "int" and not self.pointers else None
        return found and found[1]

    @property
    def unit(self):
        """Of a number, as its comment says; "" if there is none."""
        found = UNIT.search(" ".join(self.doc.split())) if self.type == "double" else None
        return found[1] if found else ""

    @property
    def declaration(self):
        size = f"[{self.size}]" if self.size is not None else ""
        return f"{'const ' if self.is_const else ''}{self.type} {'*' * self.pointers}{self.name}{size}"


@dataclasses.dataclass
class Struct:
    name: str
    fields: list[Variable] | None  # None: opaque
    doc: str


@dataclasses.dataclass
class Enum:
    name: str
    members: dict[str, int]


@dataclasses.dataclass
class Function:
    name: str
    result: Variable  # without a name
    arguments: list[Variable]
    doc: str


class Header:
    """Constants, enums, structs and functions in their order. A header may use what another one declares."""

    def __init__(self, path, uses=None):
        self.constants = dict(uses.constants) if uses else {}
        self.enums, self.structs, self.functions = {}, {}, {}
        self._tokens = self._tokens_of(path.read_text(encoding="utf-8"))
        self._doc = ""
        while self._tokens:
            self._declaration()

    def cdef(self):
        """All of it without comments, as cffi takes it."""
        used = {**{enum: None for enum in self.enums}}
        lines = [f"enum {name} {{ {', '.join(f'{m} = {v}' for m, v in self.enums[name].members.items())} }};" for name in used]
        for struct in self.structs.values():
            fields = "".join(f" {field.declaration};" for field in struct.fields or [])
            lines.append(f"typedef struct {struct.name}{f' {{{fields} }}' if struct.fields else ''} {struct.name};")
        for function in self.functions.values():
            arguments = ", ".join(argument.declaration for argument in function.arguments) or "void"
            lines.append(f"{function.result.declaration}{function.name}({arguments});")
        return "\n".join(lines)

    def parameters(self, struct, name=""):
        """Fields of a struct of parameters as (name, unit, field), those of a struct within it as `pose.skew`; without arrays, which
        are left at their default."""
        unit = ""
        for field in self.structs[struct].fields:
            if field.pointers:
                continue
            if field.size:
                raise SyntaxError(f"{struct}.{field.name}: there is no parameter of this kind")
            if field.type in self.structs:
                yield from self.parameters(field.type, f"{name}{field.name}.")
                continue
            unit = unit if "as for the pinion" in field.doc else field.unit
            yield f"{name}{field.name}", unit, field

    # Tokens, of which comments that document something are kept.

    def _tokens_of(self, text):
        text = re.sub(r"#ifdef __cplusplus.*?#endif", "", text, flags=re.DOTALL)
        for name, value in re.findall(r"^#define (GM_\w+) +(\(?-?\d+\)?)(?=\s)", text, flags=re.MULTILINE):
            self.constants[name] = int(value.strip("()"))
        text = re.sub(r"^#.*", "", text, flags=re.MULTILINE)
        return [token for token in TOKEN.findall(text)
                if not token.startswith("/*") or re.match(r"/\*\*[^*]", token) and "@file" not in token][::-1]

    def _next(self):
        """The next token that is no comment. A comment in front of it documents what comes, one with < what was."""
        while True:
            token = self._tokens.pop()
            if not token.startswith("/**"):
                return token
            self._doc = _text_of(token)

    def _peek(self):
        return next(token for token in reversed(self._tokens) if not token.startswith("/**"))

    def _expect(self, *expected):
        for wanted in expected:
            token = self._next()
            if token != wanted:
                raise SyntaxError(f"header: '{wanted}' must follow (got '{token}')")

    def _doc_of(self, before):
        """The comment that stood before, or the one with < that follows."""
        if self._tokens and self._tokens[-1].startswith("/**<"):
            return _text_of(self._tokens.pop())
        return before

    def _take_doc(self):
        doc, self._doc = self._doc, ""
        return doc

    # Declarations.

    def _declaration(self):
        if self._tokens[-1].startswith("/**"):
            self._doc = _text_of(self._tokens.pop())
            return
        token = self._next()
        doc = self._take_doc()
        if token == "typedef":
            self._expect("struct")
            self._struct(self._next(), doc)
        elif token == "enum":
            self._enum(self._next())
        elif token == "GM_API":
            result = self._variable(named=False)
            name = self._next()
            self._expect("(")
            self.functions[name] = Function(name, result, self._arguments(), doc)
            self._expect(";")
        else:
            raise SyntaxError(f"header: a declaration must follow (got '{token}')")

    def _struct(self, name, doc):
        if self._peek() != "{":
            self._expect(name, ";")
            self.structs[name] = Struct(name, None, doc)
            return
        self._expect("{")
        fields = []
        while self._peek() != "}":
            field = self._variable()
            before = self._take_doc()
            self._expect(";")
            field.doc = self._doc_of(before)
            fields.append(field)
        self._expect("}", name, ";")
        self._take_doc()
        self.structs[name] = Struct(name, fields, doc)

    def _enum(self, name):
        self._expect("{")
        members, value = {}, -1
        while self._peek() != "}":
            member = self._next()
            value += 1
            if self._peek() == "=":
                self._next()
                expression = ""
                while self._peek() not in (",", "}"):
                    expression += self._next()
                if not re.fullmatch(r"[-+|<\d()]+", expression):
                    raise SyntaxError(f"header: {member}: must be an integer (got '{expression}')")
                value = eval(expression)  # digits and operators alone
            members[member] = value
            if self._peek() == ",":
                self._next()
        self._expect("}", ";")
        self._take_doc()
        self.enums[name] = Enum(name, members)

    def _arguments(self):
        if self._peek() == "void" and self._tokens[-2] == ")":
            self._expect("void", ")")
            return []
        arguments = [self._variable()]
        while self._next() == ",":
            arguments.append(self._variable())
        return arguments

    def _variable(self, named=True):
        words, pointers, size = [], 0, None
        while self._peek() not in "*;,)([" and (len(words) == 0 or named or self._tokens[-2] != "("):
            words.append(self._next())
        while self._peek() == "*":
            self._next()
            pointers += 1
        name = ""
        if named:
            name = self._next() if pointers else words.pop()
        if named and self._peek() == "[":
            self._next()
            number = self._next()
            size = self.constants[number] if number in self.constants else int(number)
            self._expect("]")
        type_words = [word for word in words if word not in ("const", "struct")]
        return Variable(name, " ".join(type_words), pointers, "const" in words, size)


def _text_of(comment):
    lines = (re.sub(r"^\s*\* ?", "", line) for line in re.sub(r"^/\*\*<?|\*/$", "", comment).split("\n"))
    return "\n".join(line.strip() for line in lines).strip()
