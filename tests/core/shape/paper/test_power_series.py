"""Power series in the force: every order, both signs."""

import numpy as np
import pytest

from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.paper.domain_fields import DomainFields
from palpate.core.shape.paper.power_series import series_terms
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.stiffness.assembly import assemble

# About 0.02 N on every node of the paper's cube (10 kPa), for a body of 1 Pa.
FORCE = 2e-6
LOADS = 4


def small_body(formulation):
    mesh, fixed = paper_cube(cells=3)
    compliance = surface_compliance(mesh, assemble(mesh, 0.3, formulation=formulation), fixed)
    return SoftBody(mesh, fixed, 0.3, compliance, 1e4, formulation)


@pytest.fixture(scope="module", params=["linear", "smoothed"])
def solid(request):
    return FreeSolid.of(small_body(request.param))


@pytest.fixture(scope="module")
def loads(solid):
    return FORCE * np.random.default_rng(5).standard_normal((solid.node_count, 3, LOADS))


def terms_of(solid, loads, order):
    fields = [DomainFields.of(term) for term in solid.solid.terms]
    return series_terms(solid, fields, loads, order)


@pytest.mark.parametrize("order", [1, 2, 3, 4, 6])
def test_what_a_series_leaves_out_is_of_the_next_order(solid, loads, order):
    terms = terms_of(solid, loads, order)

    def missing(share):
        moved = sum(term * share ** (power + 1) for power, term in enumerate(terms))
        left = [share * loads[:, :, at] - solid.forces(moved[:, :, at]) for at in range(LOADS)]
        return np.linalg.norm(left)

    assert missing(0.5) / missing(0.25) == pytest.approx(2.0 ** (order + 1), rel=0.2)


def test_one_series_serves_both_signs(solid, loads):
    forwards, backwards = terms_of(solid, loads, 3), terms_of(solid, -loads, 3)
    for order, (one, other) in enumerate(zip(forwards, backwards, strict=True), start=1):
        np.testing.assert_allclose(other, (-1.0) ** order * one, atol=1e-12 * np.abs(one).max())
