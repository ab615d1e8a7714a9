"""The kept factor against plain sparse products, for matrix after matrix of one pattern."""

import numpy as np
import pytest

from palpate.core.compliance.elimination.block_matrix import free_blocks
from palpate.core.compliance.elimination.cholesky import (
    NotPositiveDefiniteError,
    RepeatedElimination,
)
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.stiffness.assembly import assemble
from palpate.core.stiffness.freedoms import freedoms


@pytest.fixture(scope="module")
def cube():
    mesh, fixed = paper_cube(cells=8)
    free = np.setdiff1d(np.arange(len(mesh.nodes)), fixed)
    matrices = []
    for poisson_ratio in (0.2, 0.4):
        stiffness = assemble(mesh, poisson_ratio)
        chosen = freedoms(free)
        matrices.append((free_blocks(stiffness, free), stiffness[chosen][:, chosen]))
    pattern = matrices[0][0]
    return matrices, RepeatedElimination.of(pattern.rows, pattern.columns, mesh.nodes[free])


@pytest.mark.parametrize("columns", [(), (1,), (7,)])
def test_solutions_fulfil_each_matrix(cube, columns):
    matrices, elimination = cube
    right = np.random.default_rng(2).standard_normal((matrices[0][1].shape[0], *columns))
    for blocks, matrix in matrices:
        found = elimination.factor(blocks.blocks).solve(right)
        assert found.shape == right.shape
        assert np.abs(matrix @ found - right).max() < 1e-11 * np.abs(right).max()


def test_right_sides_stay_as_they_are(cube):
    matrices, elimination = cube
    factor = elimination.factor(matrices[0][0].blocks)
    right = np.asfortranarray(np.ones((matrices[0][1].shape[0], 2)))
    factor.solve(right)
    assert (right == 1.0).all()


def test_a_negative_direction_is_told(cube):
    matrices, elimination = cube
    blocks = matrices[0][0]
    indefinite = blocks.blocks.copy()
    own = np.flatnonzero(blocks.rows == blocks.columns)[100]
    indefinite[own] *= -1.0
    with pytest.raises(NotPositiveDefiniteError):
        elimination.factor(indefinite)
