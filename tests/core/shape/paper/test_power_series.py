"""Power series in the force: every order, both signs."""

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.law.st_venant_kirchhoff import StVenantKirchhoff
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.paper.power_series import SeriesStart
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import equilibrium

# About 0.02 N on every node of the paper's cube (10 kPa), for a body of 1 Pa.
FORCE = 2e-6


@pytest.fixture(scope="module", params=["linear", "smoothed"])
def solid(request):
    return FreeSolid.of(
        baked_body(*paper_cube(cells=3), formulation=request.param), StVenantKirchhoff()
    )


@pytest.fixture(scope="module")
def load(solid):
    return FORCE * np.random.default_rng(5).standard_normal((solid.node_count, 3))


@pytest.mark.parametrize("begun", ["at rest", "under a load"])
@pytest.mark.parametrize("order", [1, 2, 3, 4, 6])
def test_what_a_series_leaves_out_is_of_the_next_order(solid, load, order, begun):
    start, first = SeriesStart.at_rest(solid), np.zeros_like(load)
    if begun == "under a load":
        first = 2.0 * FORCE * np.random.default_rng(6).standard_normal(load.shape)
        start = start.moved(solid, equilibrium(solid, first).displacements)
    terms = start.series(load, order)
    begins = 0.0 if start.displacements is None else start.displacements

    def missing(share):
        moved = begins + sum(term * share ** (power + 1) for power, term in enumerate(terms))
        return np.linalg.norm(first + share * load - solid.forces(moved))

    assert missing(0.5) / missing(0.25) == pytest.approx(2.0 ** (order + 1), rel=0.3)


def test_one_series_serves_both_signs(solid, load):
    start = SeriesStart.at_rest(solid)
    both = zip(start.series(load, 3), start.series(-load, 3), strict=True)
    for order, (one, other) in enumerate(both, start=1):
        np.testing.assert_allclose(other, (-1.0) ** order * one, atol=1e-12 * np.abs(one).max())
