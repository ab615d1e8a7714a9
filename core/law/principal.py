"""Laws that are sums over principal stretches: stress, tangent, and the powers they are made of.

With the principal stretches l and J their product, ::

    W = mu (h(l_1) + h(l_2) + h(l_3)) + lambda g(J)

mu the shear modulus, lambda Lame's first parameter. Ogden's laws have powers in h, each less what
it does to J alone, so that a place at rest is without stress.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
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
class Power:
    """One power of a stretch: its share of the shear modulus, and its exponent. Shares add to 1."""

    share: float
    exponent: float


def power_less_logarithm(excess: NDArray[np.float64], exponent: float) -> Derivatives:
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


def summed(parts: Iterable[tuple[float, Derivatives]]) -> Derivatives:
    """Sum of functions, each times a number."""
    weighted = [tuple(weight * each for each in derivatives) for weight, derivatives in parts]
    return Derivatives(*(np.sum(column, axis=0) for column in zip(*weighted, strict=True)))


def powers(terms: Iterable[Power], excess: NDArray[np.float64]) -> Derivatives:
    """Ogden's h of stretches 1 + excess: all powers by their shares."""
    return summed((term.share, power_less_logarithm(excess, term.exponent)) for term in terms)


class PrincipalLaw(ABC):
    """A law by its functions h of a stretch and g of J."""

    @property
    def gives_way(self) -> bool:
        """See :class:`.law.Law`."""
        return False

    @abstractmethod
    def _along(self, excess: NDArray[np.float64]) -> Derivatives:
        """The function h, of stretches 1 + excess (3, d)."""

    @abstractmethod
    def _volume(self, excess: NDArray[np.float64]) -> Derivatives:
        """The function g, of J = 1 + excess (d,)."""

    def stressed(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> Stressed:
        """See :class:`.law.Law`."""
        left, stretches, right = principal(gradient)
        own, common = self._along(stretches - 1.0), self._volume(volume_change(gradient))
        density = shear_modulus * own.value.sum(axis=0) + first_lame * common.value
        stress: Array = np.einsum("iad,ad,aJd->iJd", left, shear_modulus * own.slope, right)
        stress += first_lame * common.slope * cofactors(identity_added(gradient))
        return Stressed(density, stress)

    def tangent(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """See :class:`.law.Law`."""
        moved = identity_added(gradient)
        common = self._volume(volume_change(gradient))
        found = volume_tangent(moved, first_lame * common.curvature)
        pressure = first_lame * common.slope
        found += pressure[:, None, None] * change_of_cofactors(moved)
        left, stretches, right = principal(gradient)
        along = self._along(stretches - 1.0)
        found += isotropic_tangent(left, stretches, right, along) * (shear_modulus[:, None, None])
        return found


def principal(gradient: Array) -> tuple[Array, NDArray[np.float64], Array]:
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


def isotropic_tangent(
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
