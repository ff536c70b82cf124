# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause


def pytest_addoption(parser):
    parser.addoption("--gearsim", help="the program gearsim, for the tests against it")
