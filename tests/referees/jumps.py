"""Whether a shape or a force jumps: what is left of its largest change when one looks nearer."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

PARTS = 12
# A hand that hurries, m/s.
SPEED = 0.1


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


def along(corners: NDArray[np.float64], rate: int, speed: float = SPEED) -> NDArray[np.float64]:
    """A path (ticks, m, 3) over corners (k, m, 3), metres; its fastest finger goes at ``speed``."""
    pieces = [corners[:1]]
    for start, end in pairwise(corners):
        length = float(np.linalg.norm(end - start, axis=1).max())
        ticks = max(1, int(np.ceil(length * rate / speed)))
        share = np.arange(1, ticks + 1)[:, None, None] / ticks
        pieces.append(start + share * (end - start))
    return np.concatenate(pieces)


def largest_change(forces: NDArray[np.float64]) -> float:
    """The largest change from one tick to the next of forces (ticks, m, 3), newton."""
    return float(np.linalg.norm(np.diff(forces, axis=0), axis=2).max())
