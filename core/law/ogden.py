"""Ogden's law of rubber: powers of the principal stretches that follow a measured curve.

::

    W = sum over terms of  2 mu_i / a_i^2 (l_1^a_i + l_2^a_i + l_3^a_i - 3 - a_i ln J)
        + lambda/2 (J - 1)^2

mu the sum of the mu_i, each positive. One term with the exponent 2 is the neo-Hookean law, another
with -2 makes it Mooney's and Rivlin's.

References
----------
R. W. Ogden: Large deformation isotropic elasticity: on the correlation of theory and experiment for
incompressible rubberlike solids, Proceedings of the Royal Society A 326, 1972, 565-584; there the
energy is mu_i' / a_i (sum of l^a_i - 3) with mu_i' = 2 mu_i / a_i.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import principal
from .barrier import Derivatives
from .by_component import Array
from .law import Stressed
from .principal import Power, power_less_logarithm, summed


@dataclass(frozen=True)
class Ogden:
    """The law of one rubber.

    Attributes
    ----------
    terms : as measured.
    """

    terms: tuple[Power, ...]

    @property
    def gives_way(self) -> bool:
        """See :class:`.law.Law`."""
        return False

    def stressed(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> Stressed:
        """See :class:`.law.Law`."""
        return principal.stressed(gradient, self._along, _squared, first_lame, shear_modulus)

    def tangent(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """See :class:`.law.Law`."""
        return principal.tangent(gradient, self._along, _squared, first_lame, shear_modulus)

    def _along(self, excess: NDArray[np.float64]) -> Derivatives:
        """Of stretches 1 + excess (3, d)."""
        return summed(
            (term.share, power_less_logarithm(excess, term.exponent)) for term in self.terms
        )


def _squared(excess: NDArray[np.float64]) -> Derivatives:
    """(J - 1)^2 / 2."""
    return Derivatives(0.5 * excess * excess, excess, np.ones_like(excess))
