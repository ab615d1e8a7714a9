"""Shares of a body's surface that belong to points on it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...mesh.tet_mesh import TetMesh
from .surface_shape import edge_lengths, face_areas

# How finely the surface is sampled to share it out among the points, in shares of the spacing.
SAMPLE_SPACING = 0.4

# A patch of the surface goes to the nearest of so many points whose normal does not look away.
NEAREST_ASKED = 6


def surface_shares(
    mesh: TetMesh,
    corner_normals: NDArray[np.float64],
    positions: NDArray[np.float64],
    normals: NDArray[np.float64],
    spacings: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Area of the surface nearest to each point, (P,), by sampling.

    ``spacings`` (S,), metres, are those of the points in each triangle. Points that look
    the other way, as those beyond a thin wall, take nothing from this side.
    """
    longest = edge_lengths(mesh).max(axis=1)
    cuts = np.maximum(np.ceil(longest / (SAMPLE_SPACING * spacings)), 2).astype(np.int64)
    areas = face_areas(mesh)
    tree, shares = cKDTree(positions), np.zeros(len(positions))
    corners = mesh.nodes[mesh.surface_triangles]
    asked = min(NEAREST_ASKED, len(positions))
    for count in np.unique(cuts).tolist():
        centres = _sub_centres(count)
        members = np.flatnonzero(cuts == count)
        places = (centres @ corners[members]).reshape(-1, 3)
        outward = (centres @ corner_normals[members]).reshape(-1, 3)
        chosen = np.asarray(tree.query(places, workers=-1)[1], dtype=np.int64)
        away = np.einsum("qx,qx->q", normals[chosen], outward) <= 0
        if away.any():
            _, nearest = tree.query(places[away], asked)
            nearest = nearest.reshape(-1, asked)
            facing = np.einsum("qkx,qx->qk", normals[nearest], outward[away]) > 0
            chosen[away] = nearest[np.arange(len(nearest)), np.argmax(facing, axis=1)]
        area = np.repeat(areas[members] / len(centres), len(centres))
        shares += np.bincount(chosen, area, len(positions))
    return shares


def _sub_centres(parts: int) -> NDArray[np.float64]:
    """Area coordinates (parts^2, 3) of the centres of a triangle's equal parts."""
    i, j = (index.ravel() for index in np.indices((parts, parts)))
    upright = i + j < parts
    # Below the diagonal stand those of the lattice's upright parts, beyond it the turned ones.
    b = np.where(upright, i + 1 / 3, parts - i - 1 / 3)
    c = np.where(upright, j + 1 / 3, parts - j - 1 / 3)
    return np.column_stack([parts - b - c, b, c]) / parts
