# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which runs a sweep consists of: values of keys, evenly, from a list, or drawn at random."""
import importlib
import itertools
import math
import re
import statistics

import numpy as np

import program
import spread
from program import InputError

MOST_RUNS = 1_000_000
RIGHT = "must be KEY=FROM:TO:N, KEY=A,B,.., KEY=uniform(LOW,HIGH) or KEY=normal(MEAN,DEVIATION)"
CLASSES = ("class.pinion", "class.wheel", "class.seed")  # flanks that gearflanks makes, in the place of keys


class Grid:
    """A key that takes each of some values."""

    def __init__(self, key, values):
        self.key, self.values = key, values  # as text, as --set takes them


class Random:
    """A key with a distribution; `at` gives its value where the share `u` of all lies below."""

    def __init__(self, key, kind, first, second):
        self.key, self.kind, self.first, self.second = key, kind, first, second

    def at(self, u):
        if self.kind == "uniform":
            return self.first + u * (self.second - self.first)
        normal = statistics.NormalDist(self.first, self.second)
        return np.array([normal.inv_cdf(share) for share in u])

    def problem(self):
        """As SALib names it."""
        return ("unif" if self.kind == "uniform" else "norm"), [self.first, self.second]


def number(text, whole):
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"--vary {whole}: {RIGHT} (got '{text.strip()}' for a number)")
    return value


def text_of(value):
    """A number as gearsim reads it."""
    return f"{value:.12g}"


def varied(text):
    """What one --vary says."""
    key, equals, spec = (part.strip() for part in text.partition("="))
    if not equals or not re.fullmatch(r"\w+\.\w+", key) or not spec:
        raise InputError(f"--vary: {RIGHT}, KEY being section.key (got {text})")

    # A distribution.
    match = re.fullmatch(r"(normal|uniform)\(([^,()]*),([^,()]*)\)", spec)
    if match:
        first, second = number(match[2], text), number(match[3], text)
        if match[1] == "uniform" and not first < second:
            raise InputError(f"--vary {text}: must begin with the lower number")
        if match[1] == "normal" and not second > 0:
            raise InputError(f"--vary {text}: the deviation must be above 0")
        return Random(key, match[1], first, second)
    if "(" in spec:
        raise InputError(f"--vary: {RIGHT} (got {text})")

    # A range, or a list.
    parts = spec.split(":")
    if len(parts) == 3:
        count = parts[2].strip()
        if not count.isdigit() or not 1 <= int(count) <= MOST_RUNS:
            raise InputError(f"--vary {text}: {RIGHT} (got '{count}' for the number of values)")
        return Grid(key, [text_of(v) for v in np.linspace(number(parts[0], text), number(parts[1], text), int(count))])
    if len(parts) == 2 and re.fullmatch(r"\s*[-+.\deE]+\s*", parts[0]):
        raise InputError(f"--vary {text}: {RIGHT} (got a range without the number of values)")
    values = [value.strip() for value in spec.split(",")]
    if not all(values) or len(set(values)) != len(values):
        raise InputError(f"--vary {text}: must be values that all differ; {RIGHT}")
    return Grid(key, values)


class Plan:
    """All runs: keys, and a row of texts for each run."""

    def __init__(self, specs, samples, method, seed):
        axes = [varied(text) for text in specs]
        self.keys = [axis.key for axis in axes]
        twice = {key for key in self.keys if self.keys.count(key) > 1}
        if twice:
            raise InputError(f"--vary {twice.pop()}: must be given once for a key")
        unknown = [key for key in self.keys if key.startswith("class.") and key not in CLASSES]
        if unknown or "class.seed" in self.keys and not {*CLASSES[:2]} & {*self.keys}:
            wrong = (unknown or ["class.seed"])[0]
            raise InputError(f"--vary: must be class.pinion or class.wheel, class.seed beside them (got {wrong})")
        self.random = [axis for axis in axes if isinstance(axis, Random)]
        self.grid = [axis for axis in axes if isinstance(axis, Grid)]
        self.method, self.seed = method, seed
        if method == "sobol" and (self.grid or not self.random):
            raise InputError("--method sobol: all keys must have normal(..) or uniform(..)")
        drawn = self._draw(samples) if self.random else [()]

        # Each drawn sample at each point of the grid.
        count = math.prod([len(axis.values) for axis in self.grid]) * len(drawn)
        if count > MOST_RUNS:
            raise InputError(f"a sweep must have at most {MOST_RUNS} runs (got {count})")
        self.rows = []
        for point in itertools.product(*(axis.values for axis in self.grid)):
            for sample in drawn:
                of_grid, of_sample = iter(point), iter(sample)
                self.rows.append([next(of_grid) if isinstance(axis, Grid) else next(of_sample) for axis in axes])

    def _draw(self, samples):
        """Samples of the random keys: a Latin hypercube, independent numbers, or those that Sobol indices need."""
        if self.method == "sobol":
            values = salib("sample.sobol").sample(self.problem(), samples, calc_second_order=False, seed=self.seed)
        else:
            if self.method == "lhs":
                shares = spread.latin_hypercube(len(self.random), samples, self.seed)
            else:
                shares = np.random.default_rng(self.seed).random((samples, len(self.random)))
            values = np.column_stack([axis.at(shares[:, i]) for i, axis in enumerate(self.random)])
        return [[text_of(value) for value in row] for row in values]

    def problem(self):
        kinds, bounds = zip(*(axis.problem() for axis in self.random))
        return {"num_vars": len(self.random), "names": self.keys, "dists": list(kinds), "bounds": list(bounds)}


def salib(module):
    """A part of SALib, or what to do without it."""
    program.optional("SALib")
    return importlib.import_module(f"SALib.{module}")
