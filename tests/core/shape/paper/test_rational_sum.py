"""Series summed beyond the circle in which they converge."""

import numpy as np
import pytest

from palpate.core.shape.paper.paper_entries import TRUSTED_CHANGE
from palpate.core.shape.paper.rational_sum import RationalSum

ORDER = 12
# Parts of a body that give way one after the other: each moves by 1 - sqrt(1 - s / c).
GIVE_WAY = np.linspace(1.0, 3.0, 20)


@pytest.fixture
def series():
    terms, coefficient = [], 1.0
    for order in range(1, ORDER + 1):
        coefficient *= (order - 1.5) / order
        terms.append(-coefficient * GIVE_WAY**-order)
    return RationalSum.of(terms)


@pytest.mark.parametrize(
    ("share", "error"), [(0.1, 1e-12), (0.9, 0.01), (-0.9, 1e-4), (-5.0, 0.01)]
)
def test_a_pull_goes_on_far_beyond_the_push_that_crushes(series, share, error):
    found, changed = series.at(share)
    expected = 1.0 - np.sqrt(1.0 - share / GIVE_WAY)
    assert np.linalg.norm(found - expected) < error * np.linalg.norm(expected)
    assert changed < 5 * error


def test_beyond_the_load_that_is_carried_one_order_contradicts_the_next(series):
    """Not everywhere beyond, which is why Newton's method has the last word."""
    _, changed = series.at(1.5)
    assert changed > TRUSTED_CHANGE


def test_a_series_that_ends_is_summed_exactly():
    rng = np.random.default_rng(4)
    terms = [rng.normal(size=(5, 3)) for _ in range(3)] + [np.zeros((5, 3))] * 3
    found, changed = RationalSum.of(terms).at(0.7)
    expected = sum(term * 0.7 ** (k + 1) for k, term in enumerate(terms))
    np.testing.assert_allclose(found, expected.ravel(), rtol=1e-10)
    assert changed < 1e-10


def test_a_body_of_fewer_freedoms_than_terms_is_summed_too(series):
    few = RationalSum.of(list((series.basis @ series.terms).T[:, :3]))
    found, _ = few.at(-2.0)
    expected = 1.0 - np.sqrt(1.0 + 2.0 / GIVE_WAY[:3])
    np.testing.assert_allclose(found, expected, rtol=0.02)
