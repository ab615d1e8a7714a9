"""Whether a shape jumps: what is left of its largest change when one looks nearer and nearer."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

PARTS = 12


def jump_left(
    shape: Callable[[float], NDArray[np.float64]], shares: NDArray[np.float64], looks: int
) -> float:
    """The change that is left where the shape changes most, over that between ``shares``.

    Each of ``looks`` divides the stretch of the largest change into twelve.
    """
    first, ends = _largest(shape, shares)
    near = first
    for _ in range(looks):
        near, ends = _largest(shape, np.linspace(*ends, PARTS + 1))
    return near / first


def _largest(
    shape: Callable[[float], NDArray[np.float64]], shares: NDArray[np.float64]
) -> tuple[float, NDArray[np.float64]]:
    shapes = [shape(float(share)) for share in shares]
    changes = [float(np.abs(b - a).max()) for a, b in pairwise(shapes)]
    worst = int(np.argmax(changes))
    return changes[worst], shares[worst : worst + 2]
