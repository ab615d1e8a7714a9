"""The neo-Hookean law: rubber, silicone, gel and flesh up to strains of about one.

::

    W = mu (|F|^2 / 2 - 3/2 - ln J) + lambda/2 (J - 1)^2        F = I + H,  J = det F

Of the compressible forms this one is polyconvex for lambda >= 0, so that a pressed body has an
equilibrium under every load, and Lame's parameters are exactly its own at small strain. Below a
twentieth of its volume a place goes on as :mod:`.barrier` says.

References
----------
J. Bonet, R. D. Wood: Nonlinear Continuum Mechanics for Finite Element Analysis, Cambridge
University Press, 2nd edition, 2008, section 6.4; P. G. Ciarlet: Mathematical Elasticity I, 1988,
section 4.10, for polyconvexity.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .barrier import barrier
from .by_component import Array, cofactors, determinants, diagonal, identity_added
from .law import Stressed
from .volume import (
    change_of_cofactors,
    second_invariant,
    volume_change,
    volume_tangent,
)


@dataclass(frozen=True)
class NeoHookean:
    """The law; it has no constants but the moduli."""

    @property
    def gives_way(self) -> bool:
        """See :class:`.law.Law`."""
        return False

    def stressed(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> Stressed:
        """See :class:`.law.Law`."""
        trace = diagonal(gradient).sum(axis=0)
        second, third = second_invariant(gradient), determinants(gradient)
        excess = trace + second + third
        held = barrier(excess)
        square = 0.5 * np.einsum("ijd,ijd->d", gradient, gradient)
        density = shear_modulus * (square - second - third + held.value)
        density += 0.5 * first_lame * excess * excess
        # mu (F - cof F / J) without the difference of what is nearly alike.
        stress: Array = gradient + gradient.swapaxes(0, 1)
        on_diagonal = diagonal(stress)
        on_diagonal -= trace
        stress -= cofactors(gradient)
        stress *= shear_modulus
        pressure = shear_modulus * held.slope + first_lame * excess
        stress += pressure * cofactors(identity_added(gradient))
        return Stressed(density, stress)

    def tangent(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """See :class:`.law.Law`."""
        excess = volume_change(gradient)
        held = barrier(excess)
        pressure = shear_modulus * (held.slope - 1.0) + first_lame * excess
        slope = shear_modulus * held.curvature + first_lame
        moved = identity_added(gradient)
        found: NDArray[np.float64] = pressure[:, None, None] * change_of_cofactors(moved)
        found += volume_tangent(moved, slope)
        found[:, np.arange(9), np.arange(9)] += shear_modulus[:, None]
        return found
