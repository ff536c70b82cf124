# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause


def pytest_addoption(parser):
    parser.addoption("--fmus", required=True, help="the folder where the FMUs were built")
    parser.addoption("--gearsim", required=True, help="the program gearsim")
