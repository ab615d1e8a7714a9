"""Part of a surface where weights at its vertices reach a threshold, cut exactly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def film(vertices: Array, triangles: NDArray[np.int64], weights: Array, threshold: float) -> Array:
    """Corners (k, 3, 3) of triangles that cover where ``weights`` (p,), linear in each triangle,
    are at least the threshold; wound as the surface is.
    """
    above = weights[triangles] - threshold
    inside = above >= 0.0
    count = inside.sum(axis=1)
    corners = vertices[triangles]
    pieces = [corners[count == 3]]
    for number in (1, 2):
        of = np.flatnonzero(count == number)
        # The corner that differs from the other two comes first.
        alone = np.argmax(inside[of] == (number == 1), axis=1)
        turned = (alone[:, None] + np.arange(3)) % 3
        a, b, c = (corners[of, turned[:, corner]] for corner in range(3))
        at = np.take_along_axis(above[of], turned, axis=1)
        ab, ac = (
            a + (at[:, 0] / (at[:, 0] - at[:, other]))[:, None] * (end - a)
            for other, end in ((1, b), (2, c))
        )
        if number == 1:
            pieces.append(np.stack([a, ab, ac], axis=1))
        else:
            pieces += [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
    return np.concatenate(pieces)
