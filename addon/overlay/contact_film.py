"""Contact patch as one area: pressure between the contact points of a tool, as smooth colour.

The points are samples of a surface that the press has stretched. A grid across the patch takes from
them, at each of its corners, their height and pressure, by weights of a smooth kernel (moving
averages: D. Shepard, A two-dimensional interpolation function for irregularly-spaced data, 1968),
and fades where no point is near.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from .pressure_colors import color_of
from .reading import Patch
from .shapes import Lit

Array = NDArray[np.float64]

# Reach of a point: this many distances to its fourth neighbour, which is one spacing away on a
# lattice, so that a lone point missing leaves no hole.
REACH, NEIGHBOURS = 1.8, 4
# Spacing of a lattice for the radius of a point's share, and the most that it is stretched by.
LATTICE, MOST_STRETCHED = np.sqrt(np.pi), 2.5
# Squares of the grid for a spacing, and along either side at most.
SQUARES, MOST_SQUARES = 3.0, 72
# Weight from which on a place is covered: about that of the rim of a lattice.
COVERED = 0.5
# No steeper than this are tangent planes followed, as the cosine to the middle of the patch.
STEEPEST = 0.25


def contact_film(patch: Patch, top: float, lift: Array) -> Lit:
    """Area of a patch in the colours of pressure up to ``top`` (Pa), moved by ``lift`` (3,), world
    units, times the spacing of its points; its triangles are wound outward.
    """
    axes = _axes(patch.normals, patch.pressures)
    middle = patch.places.mean(axis=0)
    points, normals = (patch.places - middle) @ axes.T, patch.normals @ axes.T
    spacing = _spacing(points, patch.radii)
    reach = REACH * spacing
    across, triangles = _grid(points[:, :2], reach, float(np.median(spacing)) / SQUARES)
    weights = _weights(across, points[:, :2], reach)
    total = weights @ np.ones(len(points))

    def mean(values: Array) -> Array:
        """Of the points, at the grid's corners."""
        sums: Array = (weights @ values).T / np.maximum(total, 1e-12)
        return sums.T

    slopes = normals[:, :2] / np.maximum(normals[:, 2:], STEEPEST)
    # Each point tells the height by its tangent plane.
    heights = points[:, 2] + np.einsum("pi,pi->p", slopes, points[:, :2])
    height = mean(heights) - np.einsum("gi,gi->g", mean(slopes), across)
    places = np.column_stack([across, height]) @ axes + middle + np.median(spacing) * lift
    colors = np.ones((len(places), 4))
    colors[:, :3] = color_of(mean(patch.pressures) / top)
    colors[:, 3] = np.clip(total / COVERED, 0.0, 1.0)
    shown = (colors[triangles, 3] > 0.0).any(axis=1)
    return places.astype(np.float32), colors.astype(np.float32), triangles[shown]


def _axes(normals: Array, pressures: Array) -> Array:
    """Two directions across a patch and its outward one, as rows."""
    outward = pressures @ normals
    outward /= np.linalg.norm(outward)
    right = np.cross(outward, np.eye(3)[np.argmin(np.abs(outward))])
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(outward, right), outward])


def _spacing(points: Array, radii: Array) -> Array:
    """Distances (p,) from each point to those around, as the press has stretched them; at least
    those at rest.
    """
    apart = np.linalg.norm(points[:, None] - points, axis=2)
    last = min(NEIGHBOURS, len(points) - 1)
    beside: Array = np.partition(apart, last, axis=1)[:, last]
    # A point alone far off does not spread over all of the patch.
    return np.clip(beside, LATTICE * radii, MOST_STRETCHED * LATTICE * radii)


def _grid(points: Array, reach: Array, step: float) -> tuple[Array, NDArray[np.int32]]:
    """Corners (g, 2) of squares over points (p, 2) and their reach, and their triangles."""
    low, high = (points - reach[:, None]).min(axis=0), (points + reach[:, None]).max(axis=0)
    counts = np.clip(np.ceil((high - low) / step).astype(int), 1, MOST_SQUARES) + 1
    x, y = (np.linspace(low[k], high[k], counts[k]) for k in (0, 1))
    corners = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    number = np.arange(len(corners), dtype=np.int32).reshape(counts)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    triangles = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return corners, triangles


def _weights(corners: Array, points: Array, reach: Array) -> csr_array:
    """Weights (g, p) of points at the grid's corners: Wendland's C2 kernel."""
    near = cKDTree(corners).sparse_distance_matrix(
        cKDTree(points), float(reach.max()), output_type="ndarray"
    )
    share = near["v"] / reach[near["j"]]
    weights = np.clip(1.0 - share, 0.0, None) ** 4 * (4.0 * share + 1.0)
    return csr_array((weights, (near["i"], near["j"])), (len(corners), len(points)))
