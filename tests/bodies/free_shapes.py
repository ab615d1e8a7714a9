"""Bodies without pins: blocks, balls that are finest at their poles, balls of shells."""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay

from palpate.core.body.soft_body import SoftBody
from palpate.core.mesh.tet_mesh import TetMesh, signed_volumes

from .baked_body import baked_body
from .golden_sphere import golden_sphere
from .soft_block import block_mesh

NO_PINS = np.empty(0, dtype=np.int64)
# So many nodes there are on a sphere whose radius is one edge.
ROUND_EACH = 1.15 * 4.0 * np.pi


def free_block(
    size: tuple[float, float, float],
    cells: tuple[int, int, int],
    young_modulus: float = 100_000.0,
    density: float = 1000.0,
) -> SoftBody:
    """A box of ``size`` metres from the origin, in ``cells``."""
    mesh = block_mesh(size, cells)
    return baked_body(mesh, NO_PINS, 0.3, young_modulus, density=density)


def free_ball(
    radius: float, cells: int, young_modulus: float = 100_000.0, density: float = 1000.0
) -> SoftBody:
    """A ball about (0, 0, radius): a block of ``cells`` each way, blown up."""
    mesh = blown_up(block_mesh((2.0, 2.0, 2.0), (cells, cells, cells)), radius)
    return baked_body(mesh, NO_PINS, 0.3, young_modulus, density=density)


def blown_up(cube: TetMesh, radius: float) -> TetMesh:
    """A ball about (0, 0, radius) of a cube from the origin, its edge 2 m long."""
    at = cube.nodes - 1.0
    at[:, :2] *= 0.5 + 0.5 * np.abs(at[:, :2])
    length = np.linalg.norm(at, axis=1)
    blown = np.abs(at).max(axis=1) / np.where(length > 0.0, length, 1.0)
    nodes = radius * (at * blown[:, None] + np.array([0.0, 0.0, 1.0]))
    return TetMesh.checked(nodes, cube.tets)


def shell_ball(radius: float, count: int, growth: float) -> TetMesh:
    """A ball about the origin whose elements are wider by ``growth`` with each shell farther in.

    ``count`` nodes are on its surface; between the shells are Delaunay's tetrahedra.
    """
    shells, reach, edge = [np.zeros((1, 3))], 1.0, np.sqrt(ROUND_EACH / count)
    while reach > 0.6 * edge:
        shells.append(golden_sphere(round(ROUND_EACH * (reach / edge) ** 2), reach)[0])
        reach -= 0.8 * growth * edge
        edge *= growth
    nodes = radius * np.concatenate(shells[::-1])
    tets = Delaunay(nodes).simplices.astype(np.int64)
    turned = signed_volumes(nodes, tets) < 0
    tets[turned, :2] = tets[turned, 1::-1]
    return TetMesh.checked(nodes, tets)
