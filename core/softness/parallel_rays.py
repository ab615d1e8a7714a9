"""Crossings of parallel lines and a surface: points in triangles of a projection."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..body.soft_body import SoftBody
from ..contact.place import Place
from ..mesh.tet_mesh import TetMesh

# Pairs of line and triangle in one batch; bounds memory to some 100 MB.
PAIRS_TOGETHER = 1_000_000

# Tolerance of area coordinates below zero, so that no line slips between triangles.
EDGE_SLACK = 1e-9


@dataclass(frozen=True, eq=False)
class Crossings:
    """Crossings of lines and a surface, sorted by line and then by height.

    Attributes
    ----------
    lines : int64 (c,), number of the line.
    heights : float64 (c,), metres along the direction from the line's own point.
    triangles : int64 (c,), number of the surface triangle.
    alphas : float64 (c, 3), area coordinates there.
    inward : bool (c,), whether the direction enters the body there.
    """

    lines: NDArray[np.int64]
    heights: NDArray[np.float64]
    triangles: NDArray[np.int64]
    alphas: NDArray[np.float64]
    inward: NDArray[np.bool_]


def across(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Two unit vectors (2, 3) that complete the unit ``direction`` (3,) to a right-handed frame."""
    aside = np.eye(3)[int(np.abs(direction).argmin())]
    first = np.cross(aside, direction)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(direction, first)])


def crossings(
    mesh: TetMesh, origins: NDArray[np.float64], direction: NDArray[np.float64]
) -> Crossings:
    """Crossings of the surface and the lines through ``origins`` (p, 3) along the unit
    ``direction`` (3,), on both sides of the origins.
    """
    frame = across(direction)
    corners = mesh.nodes[mesh.surface_triangles]
    flat, seen = corners @ frame.T, origins @ frame.T
    near = _overlapping(flat, seen)
    flat, corners = flat[near], corners[near]
    found = [
        _in_triangles(seen[start : start + step], flat, start)
        for step in [max(1, PAIRS_TOGETHER // max(1, len(near)))]
        for start in range(0, len(seen), step)
    ]
    lines = np.concatenate([part[0] for part in found])
    local = np.concatenate([part[1] for part in found])
    alphas = np.concatenate([part[2] for part in found])
    heights = np.einsum("cn,cn->c", alphas, corners[local] @ direction) - origins[lines] @ direction
    order = np.lexsort((heights, lines))
    # Counter-clockwise as seen with the direction towards the eye is outward along it.
    inward = _doubled_areas(flat)[local] < 0
    return Crossings(lines[order], heights[order], near[local[order]], alphas[order], inward[order])


def _overlapping(flat: NDArray[np.float64], seen: NDArray[np.float64]) -> NDArray[np.int64]:
    """Triangles (s, 3, 2), not edge-on, whose boxes overlap that of the points (p, 2)."""
    apart = (flat.min(axis=1) > seen.max(axis=0)) | (flat.max(axis=1) < seen.min(axis=0))
    return np.flatnonzero(~apart.any(axis=1) & (_doubled_areas(flat) != 0))


def _doubled_areas(flat: NDArray[np.float64]) -> NDArray[np.float64]:
    one, two = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    areas: NDArray[np.float64] = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
    return areas


def _in_triangles(
    seen: NDArray[np.float64], flat: NDArray[np.float64], first: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Pairs of point and triangle around it, with area coordinates; lines count from first."""
    one, two = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    area = _doubled_areas(flat)
    away = seen[:, None] - flat[None, :, 0]
    b = (away[..., 0] * two[:, 1] - away[..., 1] * two[:, 0]) / area
    c = (one[:, 0] * away[..., 1] - one[:, 1] * away[..., 0]) / area
    alphas = np.stack([1.0 - b - c, b, c], axis=2)
    line, triangle = np.nonzero((alphas >= -EDGE_SLACK).all(axis=2))
    return line + first, triangle, alphas[line, triangle]


def thickness(body: SoftBody, place: Place) -> float:
    """How far it is through the body along the axis, metres."""
    met = crossings(body.mesh, place.position[None], place.axis)
    size = float(np.ptp(body.mesh.nodes, axis=0).max())
    leaving = met.heights[~met.inward & (met.heights > 1e-9 * size)]
    return float(leaving.min(initial=size))
