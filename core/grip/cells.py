"""Few cells for the many nodes of a large patch."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree


def cells_of(places: NDArray[np.float64], most: int) -> NDArray[np.int64]:
    """Number of the cell of each place (k,): up to ``most`` cells, their middles spread evenly.

    Each place goes to the nearest middle; with no more places than cells each has its own.
    """
    if len(places) <= most:
        return np.arange(len(places))
    middles = np.zeros(most, dtype=np.int64)
    away = np.full(len(places), np.inf)
    for cell in range(1, most):
        # The place farthest from all middles before.
        away = np.minimum(away, np.linalg.norm(places - places[middles[cell - 1]], axis=1))
        middles[cell] = int(np.argmax(away))
    return np.asarray(cKDTree(places[middles]).query(places)[1], dtype=np.int64)
