"""Closest points on a triangle surface, exact, for many points at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

# Pairs of point and candidate triangle in one batch; bounds memory to some 100 MB.
POINTS_PER_PASS = 4096


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Places on a surface: ``triangle`` (p,), ``alpha`` (p, 3) area coordinates, ``distance`` (p,)
    in metres from the query points, ``position`` (p, 3).
    """

    triangle: NDArray[np.int64]
    alpha: NDArray[np.float64]
    position: NDArray[np.float64]
    distance: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _SizeClass:
    """Triangles of similar size: any point of one lies within ``reach`` of its centroid."""

    members: NDArray[np.int64]
    tree: cKDTree
    reach: float


class ClosestPoints:
    """Search structure over triangles ``corners[triangles]``.

    Triangles are sorted into classes by size, each with a kd-tree of centroids, so that one large
    triangle does not make every search wide.
    """

    def __init__(self, nodes: NDArray[np.float64], triangles: NDArray[np.int64]) -> None:
        self._corners = np.asarray(nodes, dtype=np.float64)[triangles]
        centroids = self._corners.mean(axis=1)
        reach = np.linalg.norm(self._corners - centroids[:, None], axis=2).max(axis=1)
        size = np.floor(np.log2(np.maximum(reach, np.finfo(float).tiny))).astype(np.int64)
        self._classes = [
            _SizeClass(members, cKDTree(centroids[members]), float(reach[members].max()))
            for members in (np.flatnonzero(size == value) for value in np.unique(size))
        ]

    def query(self, points: NDArray[np.float64]) -> SurfacePoints:
        """Closest surface place for each of ``points`` (p, 3)."""
        points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
        passes = [
            self._query_pass(points[start : start + POINTS_PER_PASS])
            for start in range(0, len(points), POINTS_PER_PASS)
        ]
        if not passes:
            passes = [(np.empty(0, dtype=np.int64), np.empty((0, 3)))]
        triangle = np.concatenate([found for found, _ in passes])
        alpha = np.concatenate([weights for _, weights in passes])
        position = np.einsum("pc,pcx->px", alpha, self._corners[triangle])
        return SurfacePoints(triangle, alpha, position, np.linalg.norm(points - position, axis=1))

    def _query_pass(
        self, points: NDArray[np.float64]
    ) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        bound = np.full(len(points), np.inf)
        for group in self._classes:
            nearest = group.members[group.tree.query(points)[1]]
            alpha = closest_area_coordinates(points, self._corners[nearest])
            place = np.einsum("pc,pcx->px", alpha, self._corners[nearest])
            bound = np.minimum(bound, np.linalg.norm(points - place, axis=1))
        which: list[NDArray[np.int64]] = []
        candidates: list[NDArray[np.int64]] = []
        for group in self._classes:
            within = (bound + group.reach) * (1 + 1e-9)
            found = group.tree.query_ball_point(points, within)
            counts = np.fromiter((len(one) for one in found), dtype=np.int64, count=len(points))
            which.append(np.repeat(np.arange(len(points)), counts))
            candidates.append(group.members[np.concatenate(found).astype(np.int64)])
        point, triangle = np.concatenate(which), np.concatenate(candidates)
        alpha = closest_area_coordinates(points[point], self._corners[triangle])
        place = np.einsum("pc,pcx->px", alpha, self._corners[triangle])
        distance = np.linalg.norm(points[point] - place, axis=1)
        order = np.lexsort((triangle, distance, point))
        first = order[np.searchsorted(point[order], np.arange(len(points)))]
        return triangle[first], alpha[first]


def closest_area_coordinates(
    points: NDArray[np.float64], corners: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Area coordinates (p, 3) of the point of triangle i closest to point i.

    ``points`` (p, 3), ``corners`` (p, 3, 3). On an edge or a corner the others are exactly zero.
    """
    best = np.zeros((len(points), 3))
    best_distance = np.full(len(points), np.inf)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        start, along = corners[:, a], corners[:, b] - corners[:, a]
        length = np.einsum("px,px->p", along, along)
        share = np.einsum("px,px->p", points - start, along)
        share = np.clip(np.divide(share, length, out=np.zeros_like(share), where=length > 0), 0, 1)
        distance = np.linalg.norm(points - start - share[:, None] * along, axis=1)
        closer = distance < best_distance
        best[closer] = 0.0
        best[closer, a] = 1.0 - share[closer]
        best[closer, b] = share[closer]
        best_distance[closer] = distance[closer]
    inner = _plane_area_coordinates(points, corners)
    inside = (inner > 0).all(axis=1)
    best[inside] = inner[inside]
    return best


def _plane_area_coordinates(
    points: NDArray[np.float64], corners: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Area coordinates of the projections onto the planes; zero for degenerate triangles."""
    i, j, k = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(j - i, k - i)
    square = np.einsum("px,px->p", normal, normal)
    beta = np.einsum("px,px->p", np.cross(points - i, k - i), normal)
    gamma = np.einsum("px,px->p", np.cross(j - i, points - i), normal)
    usable = square > 0
    beta = np.divide(beta, square, out=np.zeros_like(beta), where=usable)
    gamma = np.divide(gamma, square, out=np.zeros_like(gamma), where=usable)
    alpha = np.column_stack([1.0 - beta - gamma, beta, gamma])
    alpha[~usable] = 0.0
    return alpha
