# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rows of numbers in a temporary file, written once and read in pieces: memory does not grow with a run.

An analysis takes arrays of numpy and columns in a file alike: both have a length, slices, rows by their numbers, min(),
max(), mean() and searchsorted(). What goes through all rows does it block by block.
"""
import os
import tempfile

import numpy as np

import program

BLOCK_ROWS = 32768
INDEX_STEP = 1024  # rows from one value that is kept for searches to the next


def blocks(values, before=0):
    """Slices of an array or of a column: pieces (first row, values), with some rows before it."""
    for first in range(0, len(values), BLOCK_ROWS):
        start = max(0, first - before)
        yield start, values[start : first + BLOCK_ROWS]


def like(values, parts):
    """Parts as one array, or as a column where the values are one."""
    if not isinstance(values, Rows):
        return np.concatenate(list(parts))
    column = Column()
    for part in parts:
        column.append(part)
    return column


class Rows:
    """Rows of `width` numbers, or of single numbers."""

    def __init__(self, width=None, dtype=float):
        self._file = tempfile.TemporaryFile(buffering=0)  # pylint: disable=consider-using-with  (it goes with its user)
        self._rows, self._shape = 0, () if width is None else (width,)
        self._dtype = np.dtype(dtype)
        self._row_bytes = self._dtype.itemsize * (width or 1)

    def __del__(self):
        self._file.close()

    def __len__(self):
        return self._rows

    def append(self, values):
        values = np.ascontiguousarray(values, self._dtype)
        rest = memoryview(values).cast("B") if values.size else b""
        try:
            while len(rest):
                rest = rest[self._file.write(rest) :]
        except OSError as error:
            raise program.RunFailed(f"{tempfile.gettempdir()}: {error.strerror}") from error
        self._rows += len(values)

    def __getitem__(self, rows):
        """A slice, one row, or rows by rising numbers."""
        if isinstance(rows, slice):
            first, behind, _ = rows.indices(self._rows)
            return self._read(first, max(first, behind))
        if np.ndim(rows) == 0:
            first = range(self._rows)[rows]
            return self._read(first, first + 1)[0]

        found, done = np.empty((len(rows), *self._shape), self._dtype), 0
        while done < len(rows):
            behind = np.searchsorted(rows, rows[done] + BLOCK_ROWS)
            part = self._read(rows[done], rows[behind - 1] + 1)
            found[done:behind] = part[rows[done:behind] - rows[done]]
            done = behind
        return found

    def _read(self, first, behind):
        values = np.empty((behind - first, *self._shape), self._dtype)
        room, place = memoryview(values).cast("B") if values.size else b"", int(first) * self._row_bytes
        while len(room):
            count = os.preadv(self._file.fileno(), [room], place)
            if count == 0:
                raise program.RunFailed(f"{tempfile.gettempdir()}: a temporary file has become shorter")
            room, place = room[count:], place + count
        return values


class Column(Rows):
    """Single numbers, of which sum and limits are known, and which can be searched where they rise."""

    def __init__(self):
        super().__init__()
        self._sum, self._lowest, self._highest = 0.0, np.inf, -np.inf
        self._index = []

    def append(self, values):
        first = -len(self) % INDEX_STEP
        super().append(values)
        if len(values):
            self._index.append(np.array(values[first::INDEX_STEP]))
            self._sum += values.sum()
            self._lowest = np.minimum(self._lowest, values.min())  # NaN stays
            self._highest = np.maximum(self._highest, values.max())

    def __array__(self, dtype=None):
        return self[:].astype(dtype or float)

    def min(self):
        return self._lowest

    def max(self):
        return self._highest

    def mean(self):
        return self._sum / len(self)

    def searchsorted(self, wanted, side="left", sorter=None):
        """As that of an array, for numpy.searchsorted()."""
        del sorter
        if np.ndim(wanted):
            return np.array([self.searchsorted(one, side) for one in wanted])
        if len(self._index) > 1:
            self._index = [np.concatenate(self._index)]
        behind = int(np.searchsorted(self._index[0], wanted, side)) * INDEX_STEP
        first = max(0, behind - INDEX_STEP)
        return first + int(np.searchsorted(self[first:behind], wanted, side))
