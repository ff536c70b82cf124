# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points spread over a cube, without scipy.stats, which takes longer to load than a search or a sweep to plan."""
import numpy as np


def latin_hypercube(dimensions, points, seed):
    """Points [point, dimension] in 0 .. 1: along each dimension one within each of as many even parts, in a random order.

    McKay, Beckman, Conover, "A comparison of three methods for selecting values of input variables", Technometrics 21
    (1979). The numbers are those of scipy.stats.qmc.LatinHypercube with the same seed.
    """
    random = np.random.default_rng(seed)
    within = random.uniform(size=(points, dimensions))
    part = np.tile(np.arange(1, points + 1), (dimensions, 1))
    for order in part:
        random.shuffle(order)
    return (part.T - within) / points
