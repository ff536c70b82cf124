# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Processes that a test ends, limits or leaves without descriptors. For `preexec_fn`.

Under the preset `coverage` a process adds to the counters of all others when it ends. One that cannot do so properly
would leave half of them, and gcovr refuses what is left. Such a process does not count.
"""
import os
import resource


def uncounted():
    """In the child: its counters go nowhere. Elsewhere without effect."""
    os.environ["GCOV_PREFIX"] = os.devnull


def limit_files(size):
    """What makes the child's files end at a size in bytes, as on a full disk."""

    def limit():
        uncounted()
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit
