"""The law of foam in loads whose stretches are known by hand."""

import numpy as np
import pytest

from palpate.core.law.foam import Foam
from palpate.core.law.principal import Power
from palpate.core.stiffness.assembly import lame_parameters

TERMS = (Power(0.7, 8.0), Power(0.3, -2.0))
RATIOS = [-0.2, 0.0, 0.1, 0.3]


def nominal(ratio, gradient):
    first, shear = lame_parameters(1.0, ratio)
    places = np.asarray(gradient, dtype=float)[:, :, None]
    return Foam(ratio, TERMS).stressed(places, np.array([first]), np.array([shear])).stress[:, :, 0]


def along_one_axis(ratio, stretch, volume):
    """Sum of 2 mu / a (l^a - J^(-ab)) / l."""
    shear, b = lame_parameters(1.0, ratio)[1], ratio / (1 - 2 * ratio)
    return sum(
        2
        * shear
        * term.share
        / term.exponent
        * (stretch**term.exponent - volume ** (-term.exponent * b))
        / stretch
        for term in TERMS
    )


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("stretch", [0.3, 0.75, 1.4])
def test_pressed_along_one_axis_it_keeps_its_poisson_ratio(ratio, stretch):
    side = stretch**-ratio
    found = nominal(ratio, np.diag([stretch, side, side]) - np.eye(3))
    expected = along_one_axis(ratio, stretch, stretch * side**2)
    assert np.allclose(found, np.diag([expected, 0.0, 0.0]), rtol=1e-12, atol=1e-12 * abs(expected))


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("stretch", [0.5, 1.3])
def test_pulled_along_two_axes_it_thins_by_a_power(ratio, stretch):
    third = stretch ** (-2 * ratio / (1 - ratio))
    found = nominal(ratio, np.diag([stretch, stretch, third]) - np.eye(3))
    expected = along_one_axis(ratio, stretch, stretch**2 * third)
    wanted = np.diag([expected, expected, 0.0])
    assert np.allclose(found, wanted, rtol=1e-12, atol=1e-12 * abs(expected))


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("angle", [0.2, 1.0])
def test_simple_shear_keeps_the_volume_and_so_asks_nothing_of_it(ratio, angle):
    """Cauchy's tau = sum of 2 mu / a (l^a - l^-a) / (l + 1/l), l - 1/l the shear."""
    gradient = np.zeros((3, 3))
    gradient[0, 1] = angle
    stress = nominal(ratio, gradient) @ (np.eye(3) + gradient).T
    stretch = 0.5 * (angle + np.hypot(angle, 2.0))
    expected = sum(
        2
        * lame_parameters(1.0, ratio)[1]
        * term.share
        / term.exponent
        * (stretch**term.exponent - stretch**-term.exponent)
        / (stretch + 1 / stretch)
        for term in TERMS
    )
    assert stress[0, 1] == pytest.approx(expected, rel=1e-11)
