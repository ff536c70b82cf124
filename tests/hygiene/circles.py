# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Finds circles: files, or folders, that need each other. Dependencies run one way.

    circles.py ROOT

A file needs another one if it includes it, or if it calls a function that this one alone defines.
"""
import collections
import os
import re
import sys

FOLDERS = ("libgearmesh", "apps")

NO_CODE = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.DOTALL)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', re.MULTILINE)
DEFINITION = re.compile(r"^([A-Za-z_][\w \t*]*?)\b(\w+)\([^;{}()]*(?:\([^;{}()]*\)[^;{}()]*)*\)\s*\{", re.MULTILINE)
CALL = re.compile(r"\b(\w+)\s*\(")


def read_sources(root):
    """Text of every C file, by its path from the root."""
    texts = {}
    for top in FOLDERS:
        for folder, folders, names in os.walk(os.path.join(root, top)):
            folders[:] = [name for name in folders if not name.startswith((".", "build"))]
            for name in names:
                if name.endswith((".c", ".h")):
                    path = os.path.join(folder, name)
                    with open(path, encoding="utf-8") as file:
                        texts[os.path.relpath(path, root)] = file.read()
    return texts


def included(path, name, texts):
    """The project's file that an include means: one beside it, else one whose path ends so."""
    beside = os.path.normpath(os.path.join(os.path.dirname(path), name))
    if beside in texts:
        return beside
    return next((other for other in sorted(texts) if other.endswith("/" + name)), None)


def find_needs(texts):
    """{file: {needed file: includes or names that show it}}"""
    code = {path: NO_CODE.sub(" ", text) for path, text in texts.items()}
    definers, own = collections.defaultdict(set), collections.defaultdict(set)
    for path, text in code.items():
        for before, name in DEFINITION.findall(text):
            own[path].add(name)
            if "static" not in before.split():
                definers[name].add(path)
    needs = {path: collections.defaultdict(set) for path in texts}
    for path, text in texts.items():
        for name in INCLUDE.findall(text):
            other = included(path, name, texts)
            if other:
                needs[path][other].add(f'#include "{name}"')
        for name in set(CALL.findall(code[path])) - own[path] if path.endswith(".c") else ():  # a header declares
            if len(definers[name]) == 1:
                needs[path][next(iter(definers[name]))].add(name)
    return needs


def by_folder(needs):
    folders = {os.path.dirname(path): collections.defaultdict(set) for path in needs}
    for path, others in needs.items():
        for other in others:
            if os.path.dirname(other) != os.path.dirname(path):
                folders[os.path.dirname(path)][os.path.dirname(other)].add(f"{path} -> {other}")
    return folders


def reachable(needs, start):
    found, left = set(), [start]
    while left:
        for other in needs[left.pop()]:
            if other not in found:
                found.add(other)
                left.append(other)
    return found


def find_circles(needs):
    """Sets of two and more that reach each other."""
    reach = {path: reachable(needs, path) for path in needs}
    circles = {frozenset(other for other in reach[path] if path in reach[other]) for path in needs if path in reach[path]}
    return [circle for circle in circles if len(circle) > 1]


def main():
    needs = find_needs(read_sources(sys.argv[1]))
    if not any(needs.values()):
        sys.exit(f"no sources that need each other in {sys.argv[1]}")
    offences = 0
    for what, graph in (("files", needs), ("folders", by_folder(needs))):
        for circle in find_circles(graph):
            offences += 1
            print(f"{what} that need each other: {', '.join(sorted(circle))}", file=sys.stderr)
            for path in sorted(circle):
                for other in sorted(circle & set(graph[path])):
                    print(f"  {path} -> {other}: {', '.join(sorted(graph[path][other])[:5])}", file=sys.stderr)
    print(f"{len(needs)} files, {offences} circles")
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main())
