"""What lies across a thin part from each node."""

import numpy as np
import pytest
from bodies.soft_block import soft_block

from palpate.core.contact.near_field.far_side import far_side
from palpate.core.contact.near_field.surface_nodes import mean_edges

SIZE = np.array([0.06, 0.012, 0.04])


@pytest.fixture(scope="module")
def strip():
    return soft_block(tuple(SIZE), (10, 2, 7))


def test_the_place_across_a_strip_is_straight_across_also_from_its_rims(strip):
    mesh, edges = strip.mesh, mean_edges(strip)
    far = far_side(mesh, edges, (3.0, 4.0))
    places = mesh.nodes[mesh.surface_nodes]
    across = np.einsum("sc,scx->sx", far.weights, places[far.nodes])
    on_sides = (places[:, 1] == 0.0) | (places[:, 1] == SIZE[1])
    mirrored = places * [1, -1, 1] + [0, SIZE[1], 0]
    # Rays begin a thousandth of an edge below the surface.
    np.testing.assert_allclose(across[on_sides], mirrored[on_sides], atol=2e-3 * edges.max())
    np.testing.assert_array_equal(far.weights[~on_sides], 0.0)


def test_weights_fade_with_the_thickness(strip):
    mesh, edges = strip.mesh, mean_edges(strip)
    places = mesh.nodes[mesh.surface_nodes]
    middle = np.flatnonzero((places[:, 1] == 0.0) & (np.abs(places[:, 0] - 0.03) < 1e-9))[3]
    thickness = SIZE[1] / edges[middle]
    weights = [
        far_side(mesh, edges, (low, low + 1.0)).weights[middle].sum()
        for low in thickness + np.array([0.5, -0.25, -0.75, -1.5])
    ]
    np.testing.assert_allclose(weights, [1.0, 0.75, 0.25, 0.0], atol=2e-3)
