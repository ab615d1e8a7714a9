"""What freedoms do together in the second order."""

import numpy as np
import pytest

from palpate.core.shape.paper.power_series import SeriesSolid
from palpate.core.shape.paper.series_pairs import PLACES_KEPT, SeriesPairs
from palpate.core.shape.solid.free_solid import FreeSolid

PLACES = np.array([20, 21, 40])


@pytest.fixture(scope="module")
def solid(cube):
    return SeriesSolid(FreeSolid.of(cube))


@pytest.fixture(scope="module")
def pairs(solid):
    pairs = SeriesPairs()
    pairs.fill(solid, PLACES)
    return pairs


def second_order(solid, loads):
    forces = np.zeros((solid.body.node_count, 3, 1))
    forces[solid.body.surface[PLACES], :, 0] = loads
    return solid.terms(forces, 2)[1][solid.body.surface, :, 0]


def test_with_each_alone_they_make_up_the_second_order_of_the_load(solid, pairs, rng):
    loads = 1e-5 * rng.standard_normal((3, 3))
    alone = np.zeros((len(solid.body.surface), 3))
    for node in range(3):
        for axis in range(3):
            one = np.zeros((3, 3))
            one[node, axis] = loads[node, axis]
            alone += second_order(solid, one)
    whole = second_order(solid, loads)
    together = pairs.displacements(PLACES, loads, np.full((3, 3), np.inf))
    assert np.linalg.norm(together) > 0.1 * np.linalg.norm(whole)
    np.testing.assert_allclose(alone + together, whole, atol=1e-6 * np.abs(whole).max())


def test_beyond_the_largest_force_they_go_on_straight(pairs, rng):
    loads, largest = rng.standard_normal((3, 3)), np.full((3, 3), 2.0)
    end = 2.0 / np.abs(loads).max()

    def drawn(share):
        return pairs.displacements(PLACES, share * end * loads, largest)

    size = np.abs(drawn(1.0)).max()
    np.testing.assert_allclose(drawn(0.5), 0.25 * drawn(1.0), atol=1e-12 * size)
    np.testing.assert_allclose(drawn(3.0) - drawn(2.0), 2 * drawn(1.0), atol=1e-9 * size)
    step = 1e-6
    before, after = drawn(1.0) - drawn(1.0 - step), drawn(1.0 + step) - drawn(1.0)
    np.testing.assert_allclose(after, before, atol=1e-4 * np.abs(before).max())


def test_places_that_are_not_there_add_nothing(pairs):
    loads = np.ones((2, 3))
    assert not pairs.has(np.array([1, 2]))
    assert pairs.displacements(np.array([1, 2]), loads, loads) == 0.0


def test_only_the_last_places_are_kept(solid):
    pairs = SeriesPairs()
    for place in range(PLACES_KEPT + 1):
        pairs.fill(solid, np.array([place]))
    assert not pairs.has(np.array([0]))
    assert pairs.has(np.array([PLACES_KEPT]))
