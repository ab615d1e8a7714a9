"""Squares and cubes that go on straight."""

import numpy as np
import pytest

from palpate.core.shape.paper.continued_powers import continued_powers

LARGEST = 0.7


def powers(share):
    return np.array(continued_powers(share, LARGEST))


def test_inside_they_are_powers():
    share = np.linspace(-LARGEST, LARGEST, 9)
    np.testing.assert_allclose(powers(share), [share**2, share**3], atol=1e-15)


@pytest.mark.parametrize("at", [-LARGEST, 0.0, LARGEST])
def test_value_and_slope_are_continuous(at):
    step = 1e-6
    before, here, after = powers(at - step), powers(at), powers(at + step)
    np.testing.assert_allclose((after - here) / step, (here - before) / step, atol=1e-5)


def test_beyond_they_go_on_straight():
    for sign in (-1.0, 1.0):
        first, second, third = (powers(sign * LARGEST * far) for far in (2.0, 3.0, 4.0))
        np.testing.assert_allclose(third - second, second - first, rtol=1e-12)


def test_a_series_without_end_stays_a_polynomial():
    assert [float(p) for p in continued_powers(-3.0, np.inf)] == [9.0, -27.0]
