"""A block on its pinned base, of any fineness, its mesh even or shaken."""

from __future__ import annotations

import itertools

import numpy as np

from palpate.core.body.soft_body import SoftBody
from palpate.core.mesh.tet_mesh import TetMesh

from .baked_body import baked_body


def soft_block(
    size: tuple[float, float, float],
    cells: tuple[int, int, int],
    poisson_ratio: float = 0.45,
    jitter: float = 0.0,
) -> SoftBody:
    """A box of ``size`` metres in ``cells``, each of six smoothed tetrahedra (Kuhn's subdivision).

    ``jitter`` shakes the nodes by this share of a cell; those on a face stay in it.
    """
    mesh = block_mesh(size, cells, jitter)
    fixed = np.flatnonzero(mesh.nodes[:, 2] == 0.0)
    return baked_body(mesh, fixed, poisson_ratio, 100_000.0, "smoothed")


def block_mesh(
    size: tuple[float, float, float], cells: tuple[int, int, int], jitter: float = 0.0
) -> TetMesh:
    """The mesh of such a block."""
    parts = np.array(cells)
    at = np.indices(parts + 1).reshape(3, -1).T
    shaken = np.random.default_rng(1999).uniform(-jitter, jitter, at.shape)
    nodes = (at + np.where((at > 0) & (at < parts), shaken, 0.0)) * (np.array(size) / parts)
    corner = np.indices(parts).reshape(3, -1).T
    tets = []
    for order in itertools.permutations(np.eye(3, dtype=np.int64)):
        path = np.vstack([np.zeros((1, 3), dtype=np.int64), np.cumsum(order, axis=0)])
        if np.linalg.det(path[1:].astype(np.float64)) < 0:
            path[[1, 2]] = path[[2, 1]]
        steps = (corner[:, None] + path).transpose(2, 0, 1)
        tets.append(np.ravel_multi_index(tuple(steps), tuple((parts + 1).tolist())))
    return TetMesh.checked(nodes, np.concatenate(tets))
