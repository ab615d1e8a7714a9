"""Degrees of freedom: three for each node, one after the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def freedoms(nodes: NDArray[np.integer]) -> NDArray[np.int64]:
    """``3 * node + axis`` for ``nodes`` (k,), node after node, (3k,)."""
    numbers: NDArray[np.int64] = (3 * nodes[:, None] + np.arange(3)).ravel()
    return numbers
