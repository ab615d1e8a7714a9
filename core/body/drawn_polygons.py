"""Polygons of a drawn mesh: which of them a line goes through, and which is nearest to a point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from palpate_servo import nearest_polygon, polygons_on_line


@dataclass(frozen=True, eq=False)
class Polygons:
    """Polygons of a mesh as it is drawn now, maybe bent or with notches; searched all at once.

    Attributes
    ----------
    places : float32 (p, 3), of the vertices.
    corners : int32 (c,), the vertex of each corner of all polygons.
    starts : int32 (f,), the first corner of each polygon.
    """

    places: NDArray[np.float32]
    corners: NDArray[np.int32]
    starts: NDArray[np.int32]

    def on_line(
        self, origin: NDArray[np.float64], direction: NDArray[np.float64]
    ) -> NDArray[np.int64]:
        """Numbers (k,) of all that a line goes through, also behind its ``origin`` (3,)."""
        return polygons_on_line(self.places, self.corners, self.starts, origin, direction)

    def nearest(self, point: NDArray[np.float64]) -> int | None:
        """Number of the one nearest to a ``point`` (3,); None where there is none."""
        return nearest_polygon(self.places, self.corners, self.starts, point)
