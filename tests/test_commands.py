#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
What is made for the shell: manual pages from --help, completion for bash and zsh.

    test_commands.py GEARSIM BUILD_FOLDER [-v] [name of a test]...
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
GEARSIM, BUILD = "", ""


def run(*command, **options):
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, **options)


class ManualPages(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="a 'b' ")
        self.addCleanup(shutil.rmtree, self.folder)

    def page_of(self, text, status=0):
        """The page of a program that prints this, or None."""
        program, page = os.path.join(self.folder, "tool"), os.path.join(self.folder, "tool.1")
        with open(program, "w", encoding="utf-8") as file:
            file.write(f"#!/usr/bin/env python3\nprint({text!r}, end='')\nraise SystemExit({status})\n")
        os.chmod(program, 0o755)
        script = os.path.join(ROOT, "apps", "man.cmake")
        made = run("cmake", f"-DPROGRAM={program}", "-DVERSION=1.2.3", f"-DPAGE={page}", "-P", script)
        self.assertEqual(made.returncode, 0, made.stderr)
        if not os.path.exists(page):
            return None
        with open(page, encoding="utf-8") as file:
            return file.read()

    def test_what_troff_would_take_for_its_own_is_text(self):
        page = self.page_of("usage: tool FILE [--x]\n       tool --y\n\nMakes a; b.\n\n.dot and 'quote' \\n\n'x\n")
        self.assertIn('.TH TOOL 1 "" "gearmesh 1.2.3" "gearmesh"\n.SH NAME\ntool \\- Makes a; b\n', page)
        self.assertIn("\ntool FILE [\\-\\-x]\ntool \\-\\-y\n", page)
        self.assertIn("\n\\&.dot and 'quote' \\en\n\\&'x\n", page)

    def test_a_program_that_does_not_run_has_no_page(self):
        self.assertIsNone(self.page_of("usage: tool\n\nText.\n", status=1))

    def test_pages_of_all_commands_hold_their_help(self):
        pages = [name for name in os.listdir(os.path.join(BUILD, "man")) if name.endswith(".1")]
        self.assertLessEqual({"gearsim.1", "gearflanks.1", "gearmesh-campbell.1"}, set(pages))
        with open(os.path.join(BUILD, "man", "gearsim.1"), encoding="utf-8") as file:
            plain = file.read().replace("\\&", "").replace("\\-", "-").replace("\\e", "\\")
        self.assertIn(run(GEARSIM, "--help").stdout.split("\n\n", 1)[1], plain)

    @unittest.skipUnless(shutil.which("mandoc"), "needs mandoc")
    def test_pages_are_without_faults(self):
        for name in sorted(os.listdir(os.path.join(BUILD, "man"))):
            if name.endswith(".1"):
                said = run("mandoc", "-T", "lint", "-W", "warning", os.path.join(BUILD, "man", name)).stdout
                self.assertEqual([line for line in said.splitlines() if "missing date" not in line], [], name)


class Completion(unittest.TestCase):
    environment = None

    @classmethod
    def setUpClass(cls):
        gearflanks = os.path.join(BUILD, "apps", "gearflanks")
        path = os.pathsep.join([os.path.dirname(os.path.abspath(GEARSIM)), gearflanks, os.environ["PATH"]])
        cls.environment = {**os.environ, "PATH": path, "LC_ALL": "C"}

    def check_both(self, complete):
        """What both shells have to offer."""
        self.assertEqual(complete("gearsim", "--out"), ["--output"])
        self.assertLessEqual({"--set", "--template", "--json", "--check"}, set(complete("gearsim", "--")))
        self.assertIn("--traces", complete("gearflanks", "--"))
        self.assertEqual(complete("gearsim", "--set", "flanks.wh"),
                         ["flanks.wheel=", "flanks.wheel_pitch=", "flanks.wheel_second_half=", "flanks.wheel_second_half_pitch=",
                          "flanks.wheel_tooth_stiffness="])
        self.assertEqual(complete("gearsim", "--template", "st"), ["static"])

    def test_bash_completes_options_and_keys(self):
        def complete(*words):
            line = " ".join(words)
            code = (
                'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMP_LINE="$*"; '
                'COMP_POINT=${#COMP_LINE}; _gearmesh "$1" "${@: -1}" "${@: -2:1}"; printf "%s\\n" "${COMPREPLY[@]}"'
            )
            file = os.path.join(BUILD, "apps", "completion", "gearsim.bash")
            done = run("bash", "-c", code, "bash", file, *words, env=self.environment)
            self.assertEqual((done.returncode, done.stderr), (0, ""), line)
            return sorted(done.stdout.split())

        self.check_both(complete)

    @unittest.skipUnless(shutil.which("zsh"), "needs zsh")
    def test_zsh_completes_options_and_keys(self):
        """With stand-ins for what zsh has only while somebody types."""

        def complete(*words):
            code = (
                "file=$1; shift; words=($@); CURRENT=$#; PREFIX=$words[CURRENT]; compset() { true }; _files() { true }\n"
                "compadd() { local name=${@[-1]} one; for one in ${(P)name}; do "
                '[[ $one == $PREFIX* ]] && print -r -- $one; done; true }\nsource "$file" $@'
            )
            file = os.path.join(BUILD, "apps", "completion", "_gearsim")
            done = run("zsh", "-f", "-c", code, "zsh", file, *words, env=self.environment)
            self.assertEqual((done.returncode, done.stderr), (0, ""), words)
            return sorted(done.stdout.split())

        self.check_both(complete)

    def test_every_installed_script_is_completed(self):
        with open(os.path.join(ROOT, "CMakeLists.txt"), encoding="utf-8") as file:
            scripts = re.search(r"set\(scripts ([^)]*)\)", file.read())[1].split()
        for name in ("gearsim.bash", "_gearsim"):
            with open(os.path.join(BUILD, "apps", "completion", name), encoding="utf-8") as file:
                text = file.read()
            for command in ["gearsim", "gearflanks", *(f"gearmesh-{script}" for script in scripts)]:
                self.assertRegex(text, rf"(?m)^(#compdef|complete -F _gearmesh) .*\b{command}\b")


if __name__ == "__main__":
    GEARSIM, BUILD = sys.argv[1:3]
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
