"""Cache of the last map to drawn vertices: it takes long to find, and strokes follow each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...core.body.drawn_map import DrawnMap
from ...core.body.soft_body import SoftBody

# Key of the body, the vertices, and their map.
_kept: tuple[str, NDArray[np.float64], DrawnMap] | None = None


def hung_on(body: SoftBody, vertices: NDArray[np.float64]) -> DrawnMap:
    """Map of ``vertices`` (p, 3), metres, on a body: the last one if both are the same."""
    global _kept  # noqa: PLW0603  one cached map
    if _kept is None or _kept[0] != body.key or not _same(_kept[1], vertices):
        _kept = (body.key, vertices, DrawnMap.hang(vertices, body))
    return _kept[2]


def forget() -> None:
    """Free the memory."""
    global _kept  # noqa: PLW0603  see hung_on
    _kept = None


def _same(known: NDArray[np.float64], vertices: NDArray[np.float64]) -> bool:
    return known is vertices or np.array_equal(known, vertices)
