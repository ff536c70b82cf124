# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Proves of the core library, from the call graph that gcc writes: no recursion, no calls through
pointers, no stack of variable size; and states the deepest stack.

    call_graph.py COMPILER LIBGEARMESH
"""
import os
import re
import subprocess
import sys
import tempfile

STACK_LIMIT = 7168  # bytes, optimised, without libm: what README.md promises to those who run it in a small task
SKIPPED = 77


def call_graph(compiler, library, optimisation):
    """Edges {caller: {callee}}, stack {function: bytes}, and faults found on the way."""
    edges, stack, faults = {}, {}, []
    sources = [os.path.join(library, "src", name) for name in sorted(os.listdir(library + "/src")) if name.endswith(".c")]
    with tempfile.TemporaryDirectory() as folder:
        for number, source in enumerate(sources):
            graph = f"{folder}/{number}"
            subprocess.run(
                [compiler, "-std=c99", optimisation, "-DNDEBUG", "-fPIC", "-ffp-contract=off", "-fcallgraph-info=su",
                 f"-I{library}/include", f"-I{library}/src", "-c", source, "-o", f"{graph}.o"],
                check=True, cwd=folder)
            with open(f"{graph}.ci", encoding="utf-8") as file:
                for line in file:
                    if match := re.match(r'edge: { sourcename: "(.*?)" targetname: "(.*?)"', line):
                        edges.setdefault(match[1], set()).add(match[2])
                    elif match := re.match(r'node: { title: "(.*?)" label: ".*\\n(\d+) bytes \((.*?)\)"', line):
                        stack[match[1]] = int(match[2])
                        if match[3] not in ("static", "dynamic,bounded"):  # bounded: aligned anew, no more
                            faults.append(f"stack of variable size: {match[1]} ({match[3]})")
    faults += [f"call through a pointer: {caller}" for caller, callees in edges.items() if "__indirect_call" in callees]
    return edges, stack, faults


def deepest(function, edges, stack, path, known, faults):
    """(bytes, chain) of the deepest stack below a function; a cycle is a fault."""
    if function in path:
        faults.append("recursion: " + " -> ".join(path[path.index(function):] + [function]))
        return 0, []
    if function not in known:
        below = [deepest(callee, edges, stack, path + [function], known, faults) for callee in sorted(edges.get(function, ()))]
        size, chain = max(below, default=(0, []))
        known[function] = stack.get(function, 0) + size, [function] + chain
    return known[function]


def main():
    compiler, library = sys.argv[1:]
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True).stdout
    if "Free Software Foundation" not in version:
        print("skipped: only gcc writes a call graph")
        return SKIPPED
    failed = False
    # Unoptimised, nothing is inlined and no recursion is turned into a loop; optimised, the stack is the real one.
    for optimisation in ("-O0", "-O2", "-O3"):
        edges, stack, faults = call_graph(compiler, library, optimisation)
        known = {}
        size, chain = max(deepest(function, edges, stack, [], known, faults) for function in sorted(stack))
        chain = [function.split(":")[-1] for function in chain]
        print(f"{optimisation}: {len(stack)} functions, deepest stack {size} bytes (libm not counted): {' > '.join(chain)}")
        if size > STACK_LIMIT and optimisation != "-O0":
            faults.append(f"deepest stack {size} bytes, limit {STACK_LIMIT}")
        for fault in faults:
            print(f"{optimisation}: {fault}")
        failed = failed or bool(faults)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
