"""Ways of a finger in a body that end where they began, and the work along them."""

from itertools import pairwise

import numpy as np


def round_trip(rng, middle, up):
    """Places (ticks, 3): from 1 mm above ``middle`` by five that are drawn by lot, of a tool whose
    own place is ``up`` m above its tip.
    """
    knots = middle + rng.uniform([-6e-3, -6e-3, -4e-3], [6e-3, 6e-3, -1e-3], (5, 3))
    start = middle + np.array([0.0, 0.0, 1e-3])
    corners = np.array([start, *knots, start]) + np.array([0.0, 0.0, up])
    path = np.concatenate([np.linspace(a, b, 80, endpoint=False) for a, b in pairwise(corners)])
    return np.concatenate([path, corners[-1:]])


def work_against(forces, path):
    """What a finger has put in at each tick but the first, J, against forces (ticks, 3) on it."""
    ways = np.diff(path, axis=0)
    return -np.cumsum(np.einsum("ti,ti->t", 0.5 * (forces[1:] + forces[:-1]), ways))
