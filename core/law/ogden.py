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

from .barrier import Derivatives
from .principal import Power, PrincipalLaw, powers


@dataclass(frozen=True)
class Ogden(PrincipalLaw):
    """The law of one rubber.

    Attributes
    ----------
    terms : as measured.
    """

    terms: tuple[Power, ...]

    def _along(self, excess: NDArray[np.float64]) -> Derivatives:
        """Of stretches 1 + excess (3, d)."""
        return powers(self.terms, excess)

    def _volume(self, excess: NDArray[np.float64]) -> Derivatives:
        """(J - 1)^2 / 2."""
        return Derivatives(0.5 * excess * excess, excess, np.ones_like(excess))
