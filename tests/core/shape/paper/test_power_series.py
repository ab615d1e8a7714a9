"""Power series in the force: every order, both signs, and Newton's method at their ends."""

import numpy as np
import pytest

from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.paper.power_series import SeriesSolid, value
from palpate.core.shape.paper.preconditioned_newton import polished
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import equilibrium
from palpate.core.stiffness.assembly import assemble

# About 0.02 N on every node of the paper's cube (10 kPa), for a body of 1 Pa.
FORCE = 2e-6


def small_body(formulation):
    mesh, fixed = paper_cube(cells=3)
    compliance = surface_compliance(mesh, assemble(mesh, 0.3, formulation=formulation), fixed)
    return SoftBody(mesh, fixed, 0.3, compliance, 1e4, formulation)


@pytest.fixture(scope="module", params=["linear", "smoothed"])
def solid(request):
    return SeriesSolid(FreeSolid.of(small_body(request.param)))


@pytest.fixture(scope="module")
def loads(solid):
    return FORCE * np.random.default_rng(5).standard_normal((solid.body.node_count, 3, 4))


def test_forces_of_many_loads_are_those_of_the_solid(solid, loads):
    u = solid.solve(loads)
    found = solid.forces(u)
    for at in range(loads.shape[2]):
        np.testing.assert_allclose(found[:, :, at], solid.body.forces(u[:, :, at]), atol=1e-15)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_what_a_series_leaves_out_is_of_the_next_order(solid, loads, order):
    terms = solid.terms(loads, order)

    def missing(share):
        shares = np.full(loads.shape[2], share)
        return np.linalg.norm(share * loads - solid.forces(value(terms, shares)))

    assert missing(0.5) / missing(0.25) == pytest.approx(2.0 ** (order + 1), rel=0.15)


def test_one_series_serves_both_signs(solid, loads):
    forwards, backwards = solid.terms(loads), solid.terms(-loads)
    for order, (one, other) in enumerate(zip(forwards, backwards, strict=True), start=1):
        np.testing.assert_allclose(other, (-1.0) ** order * one, atol=1e-12 * np.abs(one).max())


def test_the_tangent_is_the_derivative_of_the_forces(solid, loads):
    u = solid.solve(loads)
    change = 1e-4 * np.abs(u).max() * np.random.default_rng(6).standard_normal(u.shape)
    difference = (solid.forces(u + change) - solid.forces(u - change)) / 2
    scale = np.abs(difference).max()
    np.testing.assert_allclose(
        solid.tangent_forces(u, change), difference, rtol=0, atol=1e-6 * scale
    )


def test_the_smallest_volume_ratio_is_that_of_each_load(solid, loads):
    u = solid.solve(3 * loads)
    found = solid.smallest_volume_ratio(u)
    for at in range(loads.shape[2]):
        assert found[at] == pytest.approx(solid.body.volume_ratios(u[:, :, at]).min())


def test_polishing_ends_where_newton_does(solid, loads):
    load = 1.5 * loads[:, :, :2]
    result = polished(solid, load, value(solid.terms(load), np.ones(2)))
    assert result.is_settled.all()
    for at in range(2):
        true = equilibrium(solid.body, load[:, :, at]).displacements
        error = np.linalg.norm(result.displacements[:, :, at] - true)
        assert error < 1e-5 * np.linalg.norm(true)


def test_polishing_tells_where_it_did_not_settle(solid, loads):
    squeezed = np.zeros_like(loads[:, :, :1])
    top = solid.body.positions[:, 2] > 0.049
    squeezed[top, 2] = -5000 * FORCE
    result = polished(solid, squeezed, np.zeros_like(squeezed))
    assert not result.is_settled.any()
