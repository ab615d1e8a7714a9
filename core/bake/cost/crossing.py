"""Length along which a surface passes through itself, which fTetWild has to make edges of."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...mesh.surface import Surface

Array = NDArray[np.float64]

# Beyond so many triangles it is not looked for: a panel does not wait for it.
MOST_TRIANGLES = 20_000
PAIRS_AT_ONCE = 400_000


def crossing_length(surface: Surface) -> float:
    """Of a surface, metres; none where it has too many triangles to look at.

    Triangles that share a corner do not count, nor do those in one plane.
    """
    if not 0 < len(surface.triangles) <= MOST_TRIANGLES:
        return 0.0
    # Faces of a seam lie together, however many vertices they have for that.
    surface = surface.welded()
    triangles = surface.triangles
    corners = surface.vertices[triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    order = np.argsort(low[:, 0])
    # Along the first axis each begins before as many others as begin before it ends.
    last = np.searchsorted(low[order, 0], high[order, 0], side="right")
    counts = last - np.arange(len(order)) - 1
    total, start = 0.0, 0
    while start < len(order):
        some = int(np.searchsorted(np.cumsum(counts[start:]), PAIRS_AT_ONCE)) + 1
        here = np.arange(start, min(start + some, len(order)))
        first = np.repeat(here, counts[here])
        within = np.arange(len(first)) - np.repeat(
            np.cumsum(counts[here]) - counts[here], counts[here]
        )
        one, two = order[first], order[first + 1 + within]
        near = (low[one, 1:] <= high[two, 1:]) & (low[two, 1:] <= high[one, 1:])
        one, two = one[near.all(axis=1)], two[near.all(axis=1)]
        apart = ~(triangles[one][:, :, None] == triangles[two][:, None, :]).any(axis=(1, 2))
        total += float(_shared(corners[one[apart]], corners[two[apart]]).sum())
        start = int(here[-1]) + 1
    return total


def _shared(one: Array, two: Array) -> Array:
    """Lengths (k,) of the segments that triangles (k, 3, 3) have in common."""
    low, high = np.full((len(one), 3), np.inf), np.full((len(one), 3), -np.inf)
    for edged, met in ((one, two), (two, one)):
        for corner in range(3):
            start = edged[:, corner]
            along = edged[:, (corner + 1) % 3] - start
            share = _hit(start, along, met)
            place = start + share[:, None] * along
            low, high = np.fmin(low, place), np.fmax(high, place)
    # Without a hit the box is inside out.
    lengths: Array = np.linalg.norm(np.maximum(high - low, 0.0), axis=1)
    return lengths


def _hit(start: Array, along: Array, triangles: Array) -> Array:
    """Share (k,) of each way at which it goes through its triangle; NaN where it does not.

    T. Moeller and B. Trumbore, *Fast, Minimum Storage Ray/Triangle Intersection* (1997).
    """
    i, j, k = (triangles[:, corner] for corner in range(3))
    across = np.cross(along, k - i)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 1.0 / np.einsum("kx,kx->k", j - i, across)
        to_j = scale * np.einsum("kx,kx->k", start - i, across)
        turned = np.cross(start - i, j - i)
        to_k = scale * np.einsum("kx,kx->k", along, turned)
        share = scale * np.einsum("kx,kx->k", k - i, turned)
        meets = (
            (to_j >= 0.0) & (to_k >= 0.0) & (to_j + to_k <= 1.0) & (share >= 0.0) & (share <= 1.0)
        )
    found: Array = np.where(meets, share, np.nan)
    return found
