"""Ogden's and Storakers' law of foam: what is squeezed gives way in volume.

With the principal stretches l and J their product, ::

    W = sum over terms of  2 mu_i / a_i^2 (l_1^a_i + l_2^a_i + l_3^a_i - 3 + (J^(-a_i b) - 1) / b)

mu the sum of the mu_i, b = nu / (1 - 2 nu): Poisson's ratio stays the same under every load along
one axis. A term with a large exponent is stiff at first and then yields, as the cells of a foam
buckle; one with a small or negative exponent stiffens when the cells are closed. One term with the
exponent 2 is Blatz' and Ko's rubber.

References
----------
B. Storakers: On material representation and constitutive branching in finite compressible
elasticity, Journal of the Mechanics and Physics of Solids 34, 1986, 125-145.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .barrier import FLATTEST, Derivatives
from .by_component import Array, cofactors, identity_added
from .law import Stressed
from .volume import change_of_cofactors, volume_change, volume_tangent

# Two stretches nearer than this, relative, are taken for one where what they differ by divides.
ALIKE = 1e-7


@dataclass(frozen=True)
class FoamTerm:
    """One term: its share of the shear modulus, and its exponent. Shares add up to 1."""

    share: float
    exponent: float


@dataclass(frozen=True)
class Foam:
    """The law of one foam.

    Attributes
    ----------
    poisson_ratio : above -1 and below 0.5; that of the moduli it is asked with.
    terms : as measured; without any other knowledge Blatz' and Ko's.
    """

    poisson_ratio: float
    terms: tuple[FoamTerm, ...] = (FoamTerm(1.0, 2.0),)

    @property
    def gives_way(self) -> bool:
        """See :class:`.law.Law`."""
        return False

    def stressed(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> Stressed:
        """See :class:`.law.Law`."""
        left, stretches, right = _principal(gradient)
        along = self._along(stretches - 1.0)
        volume = self._volume(volume_change(gradient))
        density = shear_modulus * along.value.sum(axis=0) + first_lame * volume.value
        stress: Array = np.einsum("iad,ad,aJd->iJd", left, shear_modulus * along.slope, right)
        stress += first_lame * volume.slope * cofactors(identity_added(gradient))
        return Stressed(density, stress)

    def tangent(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """See :class:`.law.Law`."""
        moved = identity_added(gradient)
        volume = self._volume(volume_change(gradient))
        found = volume_tangent(moved, first_lame * volume.curvature)
        pressure = first_lame * volume.slope
        found += pressure[:, None, None] * change_of_cofactors(moved)
        left, stretches, right = _principal(gradient)
        found += (
            _isotropic_tangent(left, stretches, right, self._along(stretches - 1.0))
            * (shear_modulus[:, None, None])
        )
        return found

    def _along(self, excess: NDArray[np.float64]) -> Derivatives:
        """2/a^2 (l^a - 1 - a ln l) of stretches l = 1 + excess (3, d), summed over the terms."""
        return _sum(
            (term.share, _power_less_logarithm(excess, term.exponent)) for term in self.terms
        )

    def _volume(self, excess: NDArray[np.float64]) -> Derivatives:
        """Energy of J = 1 + excess (d,) over Lame's first parameter, where that is not zero."""
        b = self.poisson_ratio / (1.0 - 2.0 * self.poisson_ratio)
        if b == 0.0:
            none = np.zeros_like(excess)
            return Derivatives(none, none, none)
        # (J^(-ab) - 1 + ab ln J) / (a b)^2 is half of what a stretch with the exponent -ab has.
        return _sum(
            (0.5 * term.share, _power_less_logarithm(excess, -term.exponent * b))
            for term in self.terms
        )


def _power_less_logarithm(excess: NDArray[np.float64], exponent: float) -> Derivatives:
    """2/a^2 (x^a - 1 - a ln x) at x = 1 + excess; below FLATTEST its parabola there."""
    over = np.maximum(excess, FLATTEST - 1.0)
    below = np.minimum(excess - over, 0.0)
    x, logarithm = 1.0 + over, np.log1p(over)
    grown = np.expm1(exponent * logarithm)
    factor = 2.0 / exponent**2
    value = factor * (grown - exponent * logarithm)
    slope = factor * exponent * grown / x
    curvature = factor * exponent * ((exponent - 1.0) * grown + exponent) / (x * x)
    # What is not convex there is driven back all the same.
    kept = np.where(below < 0.0, np.maximum(curvature, 0.0), curvature)
    return Derivatives(value + below * (slope + 0.5 * below * kept), slope + below * kept, kept)


def _sum(parts: Iterable[tuple[float, Derivatives]]) -> Derivatives:
    weighted = [tuple(weight * each for each in derivatives) for weight, derivatives in parts]
    return Derivatives(*(np.sum(column, axis=0) for column in zip(*weighted, strict=True)))


def _principal(gradient: Array) -> tuple[Array, NDArray[np.float64], Array]:
    """F = U l V^T: U (3, 3, d), l (3, d) descending, V^T (3, 3, d), U and V turns.

    Of what is inside out the least stretch is negative.
    """
    moved = np.eye(3) + gradient.transpose(2, 0, 1)
    left, stretches, right = np.linalg.svd(moved)
    sign = np.linalg.det(left)
    left[:, :, 2] *= sign[:, None]
    stretches[:, 2] *= sign
    sign = np.linalg.det(right)
    right[:, 2] *= sign[:, None]
    stretches[:, 2] *= sign
    return left.transpose(1, 2, 0), stretches.T, right.transpose(1, 2, 0)


def _isotropic_tangent(
    left: Array, stretches: NDArray[np.float64], right: Array, along: Derivatives
) -> NDArray[np.float64]:
    """Second derivative (d, 9, 9) of a function of each stretch, summed over the three.

    Its nine principal directions: a change of one stretch, and for two of them a shear and a turn.
    """
    one = np.einsum("iad,bJd->dabiJ", left, right).reshape(-1, 3, 3, 9)
    found: NDArray[np.float64] = np.zeros((len(one), 9, 9))
    for a in range(3):
        found += _outer(along.curvature[a], one[:, a, a])
        b = (a + 1) % 3
        first, second = stretches[a], stretches[b]
        difference, total = first - second, first + second
        near = np.abs(difference) <= ALIKE * np.abs(total)
        slope = (along.slope[a] - along.slope[b]) / np.where(near, 1.0, difference)
        shear = np.where(near, 0.5 * (along.curvature[a] + along.curvature[b]), slope)
        turn = (along.slope[a] + along.slope[b]) / np.where(total == 0.0, 1.0, total)
        found += _outer(0.5 * shear, one[:, a, b] + one[:, b, a])
        found += _outer(0.5 * turn, one[:, a, b] - one[:, b, a])
    return found


def _outer(weights: NDArray[np.float64], directions: NDArray[np.float64]) -> NDArray[np.float64]:
    product: NDArray[np.float64] = (weights[:, None] * directions)[:, :, None] * directions[:, None]
    return product
