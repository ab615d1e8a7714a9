"""Equation (16): its ends, its middle, and what happens beyond F0."""

import numpy as np
import pytest

from palpate.core.shape.paper.paper_formula import PaperColumns, paper_displacements

LARGEST = np.array([[2.0, 0.5], [1.0, 4.0]])


@pytest.fixture
def columns():
    chance = np.random.default_rng(16)
    return PaperColumns(*chance.standard_normal((3, 2, 12)), LARGEST)


def test_small_forces_move_linearly(columns):
    force = np.array([1e-9, -1e-9])
    assert np.allclose(
        paper_displacements(columns, force), force @ columns.linear, rtol=1e-7, atol=0
    )
    assert not paper_displacements(columns, np.zeros(2)).any()


def test_the_largest_forces_move_as_the_tables_say(columns):
    found = paper_displacements(columns, np.array([2.0, 0.0]))
    assert np.allclose(found, 2.0 * columns.positive[0])
    found = paper_displacements(columns, np.array([0.0, -4.0]))
    assert np.allclose(found, -4.0 * columns.negative[1])


def test_between_them_it_is_the_formula_as_published(columns):
    force = np.array([0.7, -3.0])
    r, s = 0.7 / 2.0, 3.0 / 4.0
    expected = ((1 - r) * columns.linear[0] + r * columns.positive[0]) * 0.7
    expected += ((1 - s) * columns.linear[1] + s * columns.negative[1]) * -3.0
    for extrapolate in (False, True):
        found = paper_displacements(columns, force, extrapolate=extrapolate)
        assert np.allclose(found, expected)


def test_beyond_the_largest_force_the_shape_grows_in_proportion(columns):
    found = paper_displacements(columns, np.array([6.0, 0.0]))
    assert np.allclose(found, 6.0 * columns.positive[0])
    published = paper_displacements(columns, np.array([6.0, 0.0]), extrapolate=True)
    assert np.allclose(published, (-2.0 * columns.linear[0] + 3.0 * columns.positive[0]) * 6.0)
    beside = [
        paper_displacements(columns, np.array([force, 0.0])) for force in (2.0 - 1e-9, 2.0 + 1e-9)
    ]
    assert np.allclose(*beside, atol=1e-7)
