"""Coarse tetrahedra in a moment: cells of a regular grid, drawn onto the surface they fill.

Where fTetWild takes seconds, this takes a tenth of one, of any surface: holes smaller than a cell,
overlaps and self-intersections do not matter. It follows the shape only as well as its cells do.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray
from palpate_servo import closest_points
from scipy.ndimage import label
from scipy.sparse import coo_array, diags_array

from ...mesh.paper_cube import FIVE_TETS, MIRRORED_TETS
from ...mesh.surface import Surface
from ...mesh.tet_mesh import TetMesh, signed_volumes

Array = NDArray[np.float64]

EDGES = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])

# Cells along the diagonal of the surface's bounding box.
CELLS = 16
# A cell is filled where this many of its eight parts are.
FEWEST_PARTS = 4
# A place fills parts to this share of one around it, so that they meet in faces, not in edges; and
# places on the surface are at most this share of one apart.
AROUND, APART = 0.2, 0.8
# How often the ways of inner nodes are made the mean of their neighbours'.
SMOOTHINGS = 12
# Nodes are drawn onto the surface so many times, each time by ways that are halved so often, where
# a tetrahedron would have less than this share of the smallest of a cell.
DRAWINGS, HALVES, LEAST_VOLUME = 3, 6, 0.1
# Of the diagonal's square: smaller triangles are nowhere that their neighbours are not.
LEAST_AREA = 1e-14


def lattice(surface: Surface, cells: int = CELLS) -> TetMesh:
    """Fill a surface with five tetrahedra a cell, ``cells`` of them along its diagonal.

    Raises
    ------
    PalpateError
        The mesh that is made cannot be used.
    """
    size = surface.diagonal / cells
    # A layer of empty cells all around.
    low = surface.vertices.min(axis=0) - 1.5 * size
    parts = _filled((_spread(surface, APART * size / 2) - low) / (size / 2))
    nodes, tets = _tetrahedra(_cells(parts))
    mesh = TetMesh.checked(low + size * nodes, tets)
    least = LEAST_VOLUME * float(mesh.tet_volumes.min())
    for _ in range(DRAWINGS):
        mesh = _drawn_onto(mesh, surface, least)
    return mesh


def _spread(surface: Surface, apart: float) -> Array:
    """Places (p, 3) all over the surface, so far apart at most."""
    corners = surface.vertices[surface.triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    steps = np.ceil(longest / apart).astype(np.int64)
    found = [surface.vertices]
    for count in np.unique(steps[steps > 1]).tolist():
        i, j = np.mgrid[: count + 1, : count + 1].reshape(2, -1)
        inside = i + j <= count
        alpha = np.column_stack([i, j, count - i - j])[inside] / count
        found.append(np.einsum("pc,tcx->tpx", alpha, corners[steps == count]).reshape(-1, 3))
    return np.concatenate(found)


def _filled(places: Array) -> NDArray[np.bool_]:
    """Parts (a, b, c) of cells with one of ``places`` (p, 3), in parts, or enclosed by such."""
    # An even number, since cells have two a side.
    shape = 2 * np.ceil((places.max(axis=0) + 2.0) / 2.0).astype(np.int64)
    shell = np.zeros(shape, dtype=bool)
    for way in itertools.product((-AROUND, AROUND), repeat=3):
        x, y, z = np.floor(places + way).astype(np.int64).T
        shell[x, y, z] = True
    number, _ = label(~shell)
    filled: NDArray[np.bool_] = number != number[0, 0, 0]
    return filled


def _cells(parts: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells to fill: where enough parts are, or any is if a thin part of the body were lost."""
    a, b, c = parts.shape
    filled = parts.reshape(a // 2, 2, b // 2, 2, c // 2, 2).sum(axis=(1, 3, 5))
    enough: NDArray[np.bool_] = filled >= FEWEST_PARTS
    return enough if label(enough)[1] == label(parts)[1] else filled > 0


def _tetrahedra(filled: NDArray[np.bool_]) -> tuple[Array, NDArray[np.int64]]:
    """Nodes (n, 3), in cells, and tetrahedra of the filled cells."""
    cells = np.argwhere(filled)
    corner = np.arange(8)
    corners = cells[:, None] + np.column_stack([corner & 1, corner >> 1 & 1, corner >> 2])
    numbers = np.ravel_multi_index(corners.reshape(-1, 3).T, tuple(np.add(filled.shape, 1)))
    used, local = np.unique(numbers, return_inverse=True)
    nodes = np.column_stack(np.unravel_index(used, tuple(np.add(filled.shape, 1))))
    of_cell = local.reshape(-1, 8)
    mirrored = (cells.sum(axis=1) % 2 == 1)[:, None, None]
    tets = np.where(mirrored, of_cell[:, MIRRORED_TETS], of_cell[:, FIVE_TETS])
    return nodes.astype(np.float64), tets.reshape(-1, 4)


def _drawn_onto(mesh: TetMesh, surface: Surface, least: float) -> TetMesh:
    """The mesh with its boundary nearer to the surface, as far as its tetrahedra allow, none of
    which becomes smaller than ``least``.
    """
    outer = mesh.surface_nodes
    triangles = surface.triangles[surface.areas > LEAST_AREA * surface.diagonal**2]
    triangle, alpha = closest_points(surface.vertices, triangles, mesh.nodes[outer])
    onto = np.einsum("pc,pcx->px", alpha, surface.vertices[triangles[triangle]])
    way = _carried_inside(mesh, onto - mesh.nodes[outer])
    share = np.ones((len(way), 1))
    for _ in range(HALVES):
        flat = signed_volumes(mesh.nodes + share * way, mesh.tets) < least
        share[mesh.tets[flat].ravel()] /= 2.0
    flat = signed_volumes(mesh.nodes + share * way, mesh.tets) < least
    return mesh if flat.any() else TetMesh.checked(mesh.nodes + share * way, mesh.tets)


def _carried_inside(mesh: TetMesh, outer: Array) -> Array:
    """Ways (n, 3) of all nodes, from those of the surface nodes."""
    ends = mesh.tets[:, EDGES].reshape(-1, 2)
    beside = coo_array((np.ones(2 * len(ends)), (ends.ravel(), ends[:, ::-1].ravel()))).tocsr()
    mean = diags_array(1.0 / beside.sum(axis=1)) @ beside
    way = np.zeros_like(mesh.nodes)
    for _ in range(SMOOTHINGS):
        way[mesh.surface_nodes] = outer
        way = mean @ way
    way[mesh.surface_nodes] = outer
    return way
