"""A faceted sphere whose nodes are spread evenly by the golden angle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull


def golden_sphere(count: int, radius: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Nodes (count, 3) and their hull (m, 3), outwards: 2 (count - 2) triangles."""
    place = np.arange(count) + 0.5
    height = 1 - 2 * place / count
    azimuth = np.pi * (1 + 5**0.5) * place
    across = np.sqrt(1 - height**2)
    nodes = radius * np.stack([across * np.cos(azimuth), across * np.sin(azimuth), height], axis=1)
    triangles = ConvexHull(nodes).simplices.astype(np.int64)
    a, b, c = nodes[triangles].swapaxes(0, 1)
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c) < 0
    triangles[inwards] = triangles[inwards][:, [0, 2, 1]]
    return nodes, triangles
