# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""The head of what gearsim writes as CSV."""


class RunError(Exception):
    """A run cannot be read or cannot be analysed; the text says why."""


def read_head(path):
    """Provenance lines `# section.key = value`, the column names, and how many lines both take."""
    provenance = {}
    with open(path, encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            line = line.strip()
            if not line.startswith("#"):
                return provenance, [name.strip() for name in line.split(",")], number
            key, equals, value = line.lstrip("# ").partition("=")
            if equals:
                provenance[key.strip()] = value.strip()
    raise RunError(f"{path}: no header line")
