"""Points without a clock press as the equations of the paper say, and as what continues them."""

import numpy as np
import pytest
from bodies.shared import nodal_forces_of
from palpate_servo import ContactEngine

from palpate.core.contact.place import compliance_between


def places_on(body):
    """Triangles, area coordinates, and ways 2 mm into the body, of two places."""
    at = body.mesh.nodes[body.mesh.surface_nodes]
    far = at[[at[:, 2].argmax(), at[:, 0].argmax()]] + 1e-3
    places = body.closest_points.query(far)
    middle = body.mesh.nodes.mean(axis=0)
    ways = middle - far
    return places.triangle, places.alpha, 0.002 * ways / np.linalg.norm(ways, axis=1)[:, None]


def settled(surface, body, mode, places):
    engine = ContactEngine(
        surface, [None] * len(places), young_modulus=body.young_modulus, mode=mode
    )
    return engine.settle(places)


@pytest.mark.parametrize("mode", ["consistent", "paper"])
def test_a_point_alone_is_the_papers(body, surface, mode):
    for place in zip(*places_on(body), strict=True):
        (one,) = settled(surface, body, mode, [place])
        expected = nodal_forces_of(body, *place, mode)
        scale = np.abs(expected).max()
        np.testing.assert_allclose(one["nodal_forces"], expected, atol=1e-9 * scale)
        np.testing.assert_allclose(one["force"], -expected.sum(axis=0), atol=1e-9 * scale)


def test_two_points_move_their_places_by_exactly_what_they_ask(body, surface):
    triangles, alphas, ways = places_on(body)
    both = settled(surface, body, "consistent", list(zip(triangles, alphas, ways, strict=True)))
    C = compliance_between(body, triangles, alphas) / body.young_modulus
    moved = -np.einsum("pqij,qj->pi", C, [one["force"] for one in both])
    np.testing.assert_allclose(moved, ways, atol=1e-9 * np.abs(ways).max())


def test_in_the_papers_mode_two_points_do_not_feel_each_other(body, surface):
    places = list(zip(*places_on(body), strict=True))
    for place, one in zip(places, settled(surface, body, "paper", places), strict=True):
        (alone,) = settled(surface, body, "paper", [place])
        np.testing.assert_array_equal(one["force"], alone["force"])
