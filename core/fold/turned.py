"""How the surface of a body is turned, node by node."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Steps of Newton's method; determinants below the second count as that.
STEPS, FLATTEST, TINY = 6, 1e-2, 1e-300


def turns(rest: Array, moved: Array, triangles: NDArray[np.int64]) -> Array:
    """Rotations (n, 3, 3) of nodes from ``rest`` (n, 3) to where they are ``moved`` (n, 3): the
    mean of those of the ``triangles`` (f, 3) around each.
    """
    by_triangle = _frames(moved[triangles]) @ _frames(rest[triangles]).transpose(0, 2, 1)
    parts = np.repeat(by_triangle.reshape(-1, 9), 3, axis=0).T
    corners = triangles.ravel()
    sums = np.empty((9, len(rest)))
    for number, part in enumerate(parts):
        sums[number] = np.bincount(corners, weights=part, minlength=len(rest))
    return _nearest(sums.T.reshape(-1, 3, 3))


def _nearest(matrices: Array) -> Array:
    """Rotations (n, 3, 3) nearest to matrices, by Newton's method (N. J. Higham, Computing the
    polar decomposition, SIAM Journal on Scientific and Statistical Computing 7, 1986); of one that
    is flat or inside out as near as some steps come.
    """
    found: Array = (
        matrices / np.linalg.norm(matrices, axis=(1, 2), keepdims=True).clip(TINY) * 3.0**0.5
    )
    for _ in range(STEPS):
        x, y, z = found.transpose(1, 0, 2)
        across = np.stack([np.cross(y, z), np.cross(z, x), np.cross(x, y)], axis=1)
        volume = np.einsum("ni,ni->n", x, across[:, 0])
        volume = np.maximum(volume, FLATTEST)
        found = 0.5 * (found + across / volume[:, None, None])
    return found


def _frames(corners: Array) -> Array:
    """Axes (f, 3, 3), as columns, of triangles (f, 3, 3): along an edge, across, outwards."""
    along = corners[:, 1] - corners[:, 0]
    out = np.cross(along, corners[:, 2] - corners[:, 0])
    along, out = _unit(along), _unit(out)
    return np.stack([along, np.cross(out, along), out], axis=2)


def _unit(vectors: Array) -> Array:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: Array = np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0.0)
    return unit
