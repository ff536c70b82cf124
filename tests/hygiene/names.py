#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
What the documents name is there: functions, types and constants of the libraries, functions in the source file that
stands behind them, tests and their claims. The changelog is left out, as it names what is no more.

    names.py FOLDER_OF_THE_PROJECT
"""
import pathlib
import re
import sys

PUBLIC = re.compile(r"\b((?:gmi?|GM)_[A-Za-z0-9_]+)(\*?)")
IN_A_FILE = re.compile(r"((?:`[a-z0-9_]+(?:\(\))?`(?:, | and )?)+) \(([a-z_]+\.[ch])\b")
CTEST = re.compile(r"`((?:unit|property|reference|cli|runs|script|install|hygiene|bits|example)\.[a-z0-9_]+)`")
CLAIMS = re.compile(CTEST.pattern + r"((?:,? [a-z0-9]+(?:_[a-z0-9]+)+)+)")
LONG_NAME = re.compile(r"(?<![\w`./-])[a-z0-9]+(?:_[a-z0-9]+){3,}(?![\w`./=-])")


def words_of(root, *patterns):
    text = "\n".join(path.read_text(encoding="utf-8") for pattern in patterns for path in sorted(root.glob(pattern)))
    return set(re.findall(r"\w+", text))


def is_called_only(name, paths):
    """A function that these files use, and that another one has."""
    text = "\n".join(path.read_text(encoding="utf-8") for path in paths)
    has_it = re.search(rf"(?m)^\w[\w *]*\b{name}\([^;{{]*\)\s*\{{|#define {name}\b", text)
    return re.search(rf"\b{name}\(", text) and not has_it


def ctest_is_there(root, name):
    """By its whole name, by its last part in the folder of its kind, or by the source of a unit test."""
    kind, part = name.split(".")
    if kind == "unit":
        return (root / "tests" / f"test_{part}.c").exists()
    lists = [root / "tests" / "CMakeLists.txt", root / "libgearmesh" / "examples" / "CMakeLists.txt"]
    whole = re.compile(rf"(?<![\w.]){re.escape(name)}(?![\w.])")
    if any(whole.search(path.read_text(encoding="utf-8")) for path in lists):
        return True
    folder = root / ("libgearmesh/examples" if kind == "example" else f"tests/{kind}")
    return part in words_of(folder, "CMakeLists.txt") if folder.is_dir() else False


def offences_of(root, document, library, tests):
    text = re.sub(r"\s+", " ", document.read_text(encoding="utf-8"))
    for name, star in set(PUBLIC.findall(text)):
        if name.endswith("_"):
            star = "*"
        known = any(word.startswith(name) for word in library) if star else name in library
        if not known:
            yield f"{name}{star} is nowhere in the sources"
    for names, file in set(IN_A_FILE.findall(text)):
        paths = list((root / "libgearmesh").glob(f"**/{file}"))
        words = set().union(*(words_of(path.parent, path.name) for path in paths))
        for name in re.findall(r"\w+", names):
            if name != "and" and (name not in words or is_called_only(name, paths)):
                yield f"{name} is not in {file}"
    for name in set(CTEST.findall(text)):
        if not ctest_is_there(root, name):
            yield f"there is no test {name}"
    claims = {claim for _, found in CLAIMS.findall(text) for claim in re.findall(r"\w+", found)}
    for claim in claims | set(LONG_NAME.findall(text)):
        if claim not in tests:
            yield f"{claim} is no claim of a test"


def main(root):
    library = words_of(root, "libgearmesh/**/*.[ch]", "apps/**/*.[ch]", "libgearmesh/**/CMakeLists.txt",
                       "libgearmesh/bindings/**/*.py")
    tests = words_of(root, "tests/*.c", "tests/*.h", "tests/*.py", "tests/hygiene/*") | library
    documents = sorted((root / "libgearmesh" / "docs").glob("*.md")) + [root / "README.md", root / "CONTRIBUTING.md"]
    count = 0
    for document in documents:
        for offence in sorted(set(offences_of(root, document, library, tests))):
            print(f"{document.relative_to(root)}: {offence}", file=sys.stderr)
            count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
