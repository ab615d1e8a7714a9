"""Bodies that lock where volume is nearly kept, where they are held, and what presses them."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import SuperLU, splu
from scipy.spatial import Delaunay

from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh, signed_volumes
from palpate.core.stiffness.freedoms import freedoms

from ..bodies import stored_body

PRESSES = 40


def grid_bar(cells: tuple[int, int, int]) -> TetMesh:
    """Bar of unit cells, each cut into six tetrahedra around the same diagonal."""
    corners = np.stack(np.indices([count + 1 for count in cells]), axis=-1)
    strides = np.array([(cells[1] + 1) * (cells[2] + 1), cells[2] + 1, 1])
    first = np.stack(np.indices(cells), axis=-1).reshape(-1, 3) @ strides
    tets = []
    for path in itertools.permutations(strides):
        steps = np.concatenate([[0], np.cumsum(path)])
        tets.append(first[:, None] + steps)
    return wound(corners.reshape(-1, 3).astype(np.float64), np.concatenate(tets))


def jumbled(grid: TetMesh, spacing: float) -> TetMesh:
    """Nodes of a grid moved by up to a quarter of the spacing within their faces, joined anew."""
    nodes, highest = grid.nodes.copy(), grid.nodes.max(axis=0)
    shifts = np.random.default_rng(4).uniform(-0.25, 0.25, nodes.shape)
    nodes += np.where((nodes == 0) | (nodes == highest), 0.0, spacing * shifts)
    tets = Delaunay(nodes).simplices.astype(np.int64)
    return wound(nodes, tets[np.abs(signed_volumes(nodes, tets)) > 1e-4 * spacing**3])


def wound(nodes: NDArray[np.float64], tets: NDArray[np.int64]) -> TetMesh:
    """The same tetrahedra, all positively oriented."""
    inverted = signed_volumes(nodes, tets) < 0
    return TetMesh.checked(nodes, np.where(inverted[:, None], tets[:, [0, 1, 3, 2]], tets))


@dataclass(frozen=True, eq=False)
class Trial:
    """A body, where it is held, and tractions (k, N, 3) on its surface."""

    name: str
    mesh: TetMesh
    held: NDArray[np.int64]
    tractions: NDArray[np.float64]
    refinements: int = 0

    @property
    def free(self) -> NDArray[np.int64]:
        """Nodes that may move."""
        return np.setdiff1d(np.arange(len(self.mesh.nodes)), self.held)

    @property
    def dofs(self) -> NDArray[np.int64]:
        """Their degrees of freedom."""
        return freedoms(self.free)

    def solved(self, K: csr_array, forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacements (k, N, 3) under nodal forces (k, N, 3)."""
        moved = np.zeros((len(self.held) * 3 + len(self.dofs), len(forces)))
        moved[self.dofs] = self.factor(K).solve(forces.reshape(len(forces), -1).T[self.dofs])
        return moved.T.reshape(forces.shape)

    def factor(self, K: csr_array) -> SuperLU:
        """SuperLU's factor of the stiffness of the free nodes."""
        return splu(
            csc_array(K[self.dofs][:, self.dofs]),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )


def cantilevers() -> list[Trial]:
    """Three cells thick and five times as long, pulled sideways at the end."""
    bar = grid_bar((3, 3, 15))
    trials = []
    for name, mesh in (("cantilever, grid", bar), ("cantilever, Delaunay", jumbled(bar, 1.0))):
        sideways = np.zeros((1, len(mesh.nodes), 3))
        sideways[0, mesh.nodes[:, 2] == 15.0, 0] = 1.0
        # Between the last nodes of the sides and the end itself the traction fades; both take it.
        trials.append(Trial(name, mesh, np.flatnonzero(mesh.nodes[:, 2] == 0), sideways))
    return trials


def pressed_cubes() -> list[Trial]:
    """The paper's cube under a smooth load on a patch of 40 mm across in the middle of its top."""
    paper, finer = paper_cube()[0], paper_cube(cells=8)[0]
    cubes = (
        ("cube of the paper", paper, 1),
        ("cube, 8 cells", finer, 0),
        ("cube, Delaunay", jumbled(paper, 0.0125), 1),
    )
    trials = []
    for name, mesh, refinements in cubes:
        away = np.hypot(*(mesh.nodes[:, :2].T - 0.025)) / 0.02
        pressure = np.where(mesh.nodes[:, 2] == 0.05, np.maximum(0.0, 1 - away**2) ** 2, 0.0)
        down = pressure[None, :, None] * np.array([0.0, 0.0, -1.0])
        held = np.flatnonzero(mesh.nodes[:, 2] == 0)
        trials.append(Trial(name, mesh, held, down, refinements))
    return trials


def pressed_mouse() -> Trial:
    """The stored mouse, pressed inward at scattered nodes by loads that fade to the next ones."""
    body = stored_body("mouse-1.7k")
    normals = np.zeros(body.mesh.nodes.shape)
    i, j, k = (body.mesh.nodes[body.mesh.surface_triangles[:, corner]] for corner in range(3))
    np.add.at(normals, body.mesh.surface_triangles, np.cross(j - i, k - i)[:, None])
    free_surface = np.setdiff1d(body.mesh.surface_nodes, body.fixed)
    pressed = np.random.default_rng(0).choice(free_surface, PRESSES, replace=False)
    tractions = np.zeros((PRESSES, *normals.shape))
    inward = -normals[pressed] / np.linalg.norm(normals[pressed], axis=1, keepdims=True)
    tractions[np.arange(PRESSES), pressed] = inward
    return Trial(body.name, body.mesh, body.fixed, tractions)


def ball_in_ball() -> TetMesh:
    """Unit ball of scattered nodes, with shells of nodes at 0.4 that no tetrahedron crosses."""
    golden = np.pi * (3 - np.sqrt(5))
    shells = [np.zeros((1, 3))]
    for radius, count in ((0.2, 14), (0.4, 60), (0.6, 130), (0.8, 230), (1.0, 360)):
        height = 1 - (2 * np.arange(count) + 1) / count
        turn = golden * np.arange(count)
        across = np.sqrt(1 - height**2)
        on_unit = np.column_stack([across * np.cos(turn), across * np.sin(turn), height])
        shells.append(radius * on_unit)
    nodes = np.concatenate(shells)
    tets = Delaunay(nodes).simplices.astype(np.int64)
    return wound(nodes, tets[np.abs(signed_volumes(nodes, tets)) > 1e-6])
