"""Tetrahedra of a body on one side of a plane, as they are seen from outside."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

# Each tetrahedron is drawn smaller about its middle by this factor, so that it is told from others.
SHRUNK = 0.9
# Faces of a tetrahedron as positions of its corners, wound outward.
FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])


def outermost(tets: Integers) -> Integers:
    """Numbers of those tetrahedra (m, 4) that have a face which none of the others has."""
    faces = np.sort(tets[:, FACES].reshape(-1, 3), axis=1)
    base = np.int64(tets.max(initial=0)) + 1
    codes = (faces[:, 0] * base + faces[:, 1]) * base + faces[:, 2]
    _, which, counts = np.unique(codes, return_inverse=True, return_counts=True)
    alone = (counts[which] == 1).reshape(-1, 4).any(axis=1)
    return np.flatnonzero(alone)


def below(nodes: Array, tets: Integers, axis: int, share: float) -> Integers:
    """Numbers of the tetrahedra whose middle is within ``share`` of the extent along an axis."""
    heights = nodes[:, axis]
    limit = heights.min() + share * np.ptp(heights)
    return np.flatnonzero(heights[tets].mean(axis=1) <= limit)


def faces_of(nodes: Array, tets: Integers) -> Array:
    """Corners (4 m, 3, 3) of the faces of tetrahedra (m, 4), each drawn a little smaller."""
    corners = nodes[tets]
    middle = corners.mean(axis=1, keepdims=True)
    small = middle + SHRUNK * (corners - middle)
    faces: Array = small[:, FACES].reshape(-1, 3, 3)
    # Whichever way the tetrahedra are wound.
    volumes = np.einsum(
        "mx,mx->m",
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
        corners[:, 3] - corners[:, 0],
    )
    inward = np.repeat(volumes < 0.0, 4)
    faces[inward] = faces[inward][:, ::-1]
    return faces
