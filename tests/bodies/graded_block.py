"""A block so large that it stands for a half-space, its elements fine only where it is pressed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from palpate.core.body.pair_blocks import pair_blocks
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.near_field.contact_points import ContactPoints
from palpate.core.mesh.paper_cube import FIVE_TETS, MIRRORED_TETS
from palpate.core.mesh.tet_mesh import TetMesh

from .baked_body import baked_body

# From cell to cell, outside the fine core: four times gently, then quickly to where the body ends.
GROWTH = (1.4, 1.4, 1.4, 1.4, 2.0, 2.0, 2.0, 2.0, 2.0)

YOUNG_MODULUS = 10_000.0


def graded_block(element: float, core: int, poisson_ratio: float) -> SoftBody:
    """A block below z = 0 with fine elements, of edge ``element`` in metres, up to ``core`` of them
    from the origin.

    It ends some 250 elements away; its sides and its bottom are pinned, the top is free.
    """
    outer = element * np.cumprod(GROWTH)
    far = core * element + np.cumsum(outer)
    fine = np.arange(-core, core + 1) * element
    across = np.concatenate([-far[::-1], fine, far])
    down = np.concatenate([-far[::-1], fine[: core + 1]])
    mesh = _tetrahedra(across, across, down)
    held = (mesh.nodes[:, 2] == down[0]) | (np.abs(mesh.nodes[:, :2]) == far[-1]).any(axis=1)
    fixed = np.flatnonzero(held)
    return baked_body(mesh, fixed, poisson_ratio, YOUNG_MODULUS, dtype=np.float64)


def nodes_as_points(body: SoftBody, within: float) -> ContactPoints:
    """Contact points in the nodes of the top at most ``within`` metres from the origin's axes.

    Each has what is nearest to it of the surface.
    """
    mesh = body.mesh
    corners = mesh.nodes[mesh.surface_triangles]
    near = (corners[:, :, 2] == 0.0).all(axis=1)
    near &= (np.abs(corners[:, :, :2]) <= within * (1 + 1e-9)).all(axis=(1, 2))
    triangles = np.flatnonzero(near)
    nodes, first = np.unique(mesh.surface_triangles[triangles], return_index=True)
    shares = np.ones(len(nodes))
    for axis in (0, 1):
        ticks = np.unique(mesh.nodes[:, axis])
        middles = 0.5 * (ticks[1:] + ticks[:-1])
        place = np.searchsorted(ticks, mesh.nodes[nodes, axis])
        shares *= middles[place] - middles[place - 1]
    return ContactPoints(
        mesh.nodes[nodes],
        np.tile([0.0, 0.0, 1.0], (len(nodes), 1)),
        triangles[first // 3],
        np.eye(3)[first % 3],
        shares,
    )


def points_around(
    body: SoftBody, middle: NDArray[np.float64], step: float, radius: float
) -> ContactPoints:
    """Contact points of a square lattice on the top within ``radius`` of ``middle`` (2,), metres.

    Neither the mesh's axes nor the middle are the lattice's.
    """
    count = int(np.ceil(radius / step)) + 1
    line = np.arange(-count, count + 1) * step
    flat = np.stack(np.meshgrid(line + 0.3 * step, line - 0.2 * step), axis=-1).reshape(-1, 2)
    flat = flat @ np.array([[0.8, 0.6], [-0.6, 0.8]])
    flat = middle + flat[np.linalg.norm(flat, axis=1) <= radius]
    places = np.column_stack([flat, np.zeros(len(flat))])
    found = body.closest_points.query(places)
    up = np.tile([0.0, 0.0, 1.0], (len(places), 1))
    areas = np.full(len(places), step**2)
    return ContactPoints(places, up, found.triangle, found.alpha, areas)


def _tetrahedra(x: NDArray[np.float64], y: NDArray[np.float64], z: NDArray[np.float64]) -> TetMesh:
    """The boxes between the planes, five tetrahedra each, as in ``paper_cube``."""
    grid = np.meshgrid(z, y, x, indexing="ij")
    nodes = np.column_stack([grid[2].ravel(), grid[1].ravel(), grid[0].ravel()])
    k, j, i = (index.ravel() for index in np.indices((len(z) - 1, len(y) - 1, len(x) - 1)))
    corner = np.arange(8)
    row, layer = len(x), len(x) * len(y)
    offsets = (corner & 1) + (corner >> 1 & 1) * row + (corner >> 2) * layer
    corners = (i + j * row + k * layer)[:, None] + offsets
    mirrored = ((i + j + k) % 2 == 1)[:, None, None]
    tets = np.where(mirrored, corners[:, MIRRORED_TETS], corners[:, FIVE_TETS])
    return TetMesh.checked(nodes, tets.reshape(-1, 4))


def lift(body: SoftBody, points: ContactPoints, element: float, axis: int = 2) -> float:
    """How far the block gives way beyond a half-space along an axis (0 or 2), m/N: about the same
    all over its core.

    The mean, over pairs of nodes three to eight elements apart, of what is left of the displacement
    along the force without Boussinesq's (1 - nu^2) / (pi E r) or, aside, Cerruti's
    (1 + nu) (1 - nu + nu x^2 / r^2) / (pi E r). Negative: the block ends, and its outer elements
    are large.
    """
    places, nu = points.positions, body.poisson_ratio
    inner = np.flatnonzero(np.linalg.norm(places, axis=1) <= 5.0 * element)
    a, b = (index.ravel() for index in np.meshgrid(inner, inner, indexing="ij"))
    way = places[a] - places[b]
    apart = np.linalg.norm(way, axis=1)
    far = (apart >= 3.0 * element) & (apart <= 8.0 * element)
    corner = points.alphas.argmax(axis=1)
    nodes = body.mesh.surface_local_triangles[points.triangles, corner]
    moved = pair_blocks(body, nodes[a[far]], nodes[b[far]])[:, axis, axis]
    along = (way[far, axis] / apart[far]) ** 2
    shape = 1.0 - nu if axis == 2 else 1.0 - nu + nu * along
    half_space = (1.0 + nu) * shape / (np.pi * apart[far])
    return float((moved - half_space).mean()) / body.young_modulus
