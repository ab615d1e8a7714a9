"""Blocks of any fineness, on their pinned base."""

import itertools

import numpy as np
import pytest

from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.assembly import assemble


def block(size, cells, poisson_ratio=0.45, formulation="smoothed", jitter=0.0):
    """A box of ``size`` (3,) in metres, its nodes shaken by ``jitter`` cells; those on a face stay
    in it.
    """
    size, cells = np.asarray(size), np.asarray(cells)
    at = np.indices(cells + 1).reshape(3, -1).T
    shaken = np.random.default_rng(1999).uniform(-jitter, jitter, at.shape)
    nodes = (at + np.where((at > 0) & (at < cells), shaken, 0.0)) * (size / cells)
    corner = np.indices(cells).reshape(3, -1).T
    tets = []
    for order in itertools.permutations(np.eye(3, dtype=int)):
        path = np.concatenate([np.zeros((1, 3), dtype=int), np.cumsum(order, axis=0)])
        if np.linalg.det(path[1:].astype(float)) < 0:
            path[[1, 2]] = path[[2, 1]]
        tets.append(np.ravel_multi_index((corner[:, None] + path).transpose(2, 0, 1), cells + 1))
    mesh = TetMesh.checked(nodes, np.concatenate(tets))
    fixed = np.flatnonzero(at[:, 2] == 0)
    K = assemble(mesh, poisson_ratio, formulation=formulation)
    compliance = surface_compliance(mesh, K, fixed)
    return SoftBody(mesh, fixed, poisson_ratio, compliance, 100_000.0, formulation)


@pytest.fixture(scope="session")
def coarse_block():
    """Edges of 10 mm, five times as long as an indenter is wide."""
    return block((0.08, 0.08, 0.05), (8, 8, 5))


@pytest.fixture(scope="session")
def fine_block():
    return block((0.08, 0.08, 0.05), (12, 12, 8))


@pytest.fixture(scope="session")
def shaken_blocks():
    """One block as two uneven meshes, the second one twice as fine."""
    return [block((0.08, 0.08, 0.05), cells, jitter=0.25) for cells in ((6, 6, 4), (12, 12, 8))]


@pytest.fixture(scope="session")
def layer():
    """10 mm of rubber on a rigid base, edges of 2 mm."""
    return block((0.036, 0.036, 0.01), (18, 18, 5), poisson_ratio=0.49)


@pytest.fixture(scope="session")
def thin_block():
    """5 mm thick, and edges as long."""
    return block((0.03, 0.03, 0.005), (6, 6, 2))
