# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the scripts share: a script as a module, and its main() without the time that Python takes to start."""
import contextlib
import functools
import importlib.machinery
import importlib.util
import io
import os
import subprocess
import sys
from unittest import mock

SCRIPTS = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "scripts"))
sys.path.insert(0, SCRIPTS)
import program  # noqa: E402


@functools.cache
def module_of(script):
    """A script, which has no suffix, as a module."""
    loader = importlib.machinery.SourceFileLoader(script, os.path.join(SCRIPTS, script))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(script, loader))
    loader.exec_module(module)
    return module


def call(script, *arguments, folder=os.curdir):
    """A script as from the command line, in this process and in a folder: exit status and what it prints."""
    module, argv, begin = module_of(script), [script, *arguments], os.getcwd()
    stdout, stderr = io.StringIO(), io.StringIO()
    given = mock.patch.object(sys, "argv", argv)
    os.chdir(folder)
    with given, contextlib.redirect_stdout(stdout), contextlib.redirect_stderr(stderr):
        try:
            status = program.run(module.work, module.arguments)
        except SystemExit as end:
            status = end.code
        finally:
            os.chdir(begin)
    return subprocess.CompletedProcess(argv, status, stdout.getvalue(), stderr.getvalue())
