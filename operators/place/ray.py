"""Intersection of a ray and a triangle surface (Moeller and Trumbore 1997)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Hit:
    """Hit triangle, area coordinates (3,), and distance along the ray."""

    triangle: int
    alpha: Array
    distance: float


def first_hit(
    origin: Array, direction: Array, nodes: Array, triangles: NDArray[np.int64]
) -> Hit | None:
    """Nearest triangle hit from its front (wound counter-clockwise), if any."""
    a, b, c = (nodes[triangles[:, corner]] for corner in range(3))
    to_b, to_c, from_a = b - a, c - a, origin - a
    normal = np.cross(to_b, to_c)
    facing = -(normal @ direction)
    faces_viewer = facing > 0.0
    divisor = np.where(faces_viewer, facing, 1.0)
    moment = np.cross(from_a, direction)
    beta = np.einsum("ij,ij->i", moment, to_c) / divisor
    gamma = -np.einsum("ij,ij->i", moment, to_b) / divisor
    distance = np.einsum("ij,ij->i", from_a, normal) / divisor
    met = faces_viewer & (beta >= 0) & (gamma >= 0) & (beta + gamma <= 1) & (distance > 0)
    if not met.any():
        return None
    nearest = int(np.flatnonzero(met)[np.argmin(distance[met])])
    alpha = np.array([1.0 - beta[nearest] - gamma[nearest], beta[nearest], gamma[nearest]])
    return Hit(nearest, alpha, float(distance[nearest]))


def node_normals(nodes: Array, triangles: NDArray[np.int64]) -> Array:
    """Outward unit normals (N, 3) of the nodes, weighted by the areas of their triangles."""
    a, b, c = (nodes[triangles[:, corner]] for corner in range(3))
    normals = np.zeros_like(nodes)
    np.add.at(normals, triangles, np.cross(b - a, c - a)[:, None, :])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / np.where(lengths > 0.0, lengths, 1.0)
