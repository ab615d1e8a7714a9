"""Parts that can swing are refused; slender, stiff, tiny and huge bodies are not."""

import numpy as np
import pytest
from awkward_bodies import block_of_cubes, joined, oriented

from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.stiffness.assembly import assemble

POISSON_RATIOS = (0.0, 0.3, 0.49, 0.4999)


def turned(mesh, seed):
    """The mesh in a skew position, so that no coordinate is a round number."""
    axes = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return oriented(mesh.nodes @ axes.T, mesh.tets)


@pytest.mark.parametrize("poisson_ratio", POISSON_RATIOS)
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    "origin", [(0.04, 0.0, 0.04), (0.04, 0.04, 0.04)], ids=["on an edge", "on a node"]
)
def test_a_part_that_hangs_on_another(poisson_ratio, seed, origin):
    straight = joined(block_of_cubes(4, 4, 4), block_of_cubes(4, 4, 4, origin=origin))
    fixed = np.flatnonzero(straight.nodes[:, 2] == 0)
    mesh = turned(straight, seed)
    with pytest.raises(PalpateError, match="not held"):
        surface_compliance(mesh, assemble(mesh, poisson_ratio), fixed)


@pytest.mark.parametrize("poisson_ratio", POISSON_RATIOS)
def test_a_part_that_swings_at_the_end_of_a_long_bar(poisson_ratio):
    bar, part = block_of_cubes(60, 1, 1), block_of_cubes(2, 2, 2, origin=(0.6, 0, 0.01))
    straight = joined(bar, part)
    mesh = turned(straight, 7)
    fixed = np.flatnonzero(straight.nodes[:, 0] == 0)
    with pytest.raises(PalpateError, match="not held"):
        surface_compliance(mesh, assemble(mesh, poisson_ratio), fixed)


@pytest.mark.parametrize("poisson_ratio", POISSON_RATIOS)
def test_a_slender_bar_is_held(poisson_ratio):
    bar = block_of_cubes(300, 1, 1)
    fixed = np.flatnonzero(bar.nodes[:, 0] == 0)
    compliance = surface_compliance(bar, assemble(bar, poisson_ratio), fixed)
    assert np.isfinite(compliance.table).all()


@pytest.mark.parametrize("poisson_ratio", POISSON_RATIOS)
def test_a_core_a_million_times_as_stiff_is_held(poisson_ratio):
    mesh, fixed = paper_cube()
    middle = np.abs(mesh.nodes[mesh.tets].mean(axis=1) - 0.025).max(axis=1) < 0.013
    scale = np.where(middle, 1e6, 1.0)
    stiffness = assemble(mesh, poisson_ratio, young_scale=scale)
    assert np.isfinite(surface_compliance(mesh, stiffness, fixed).table).all()


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e4])
def test_size_does_not_matter(size):
    """A body twice as large is twice as stiff: L goes with the inverse of size."""
    mesh, fixed = paper_cube()
    scaled = oriented(size * mesh.nodes, mesh.tets)
    unit = surface_compliance(mesh, assemble(mesh, 0.3), fixed, dtype=np.float64)
    other = surface_compliance(scaled, assemble(scaled, 0.3), fixed, dtype=np.float64)
    np.testing.assert_allclose(other.table * size, unit.table, rtol=1e-9, atol=1e-12)
