"""Laws of what is mostly air: foam and fibres, which give way in volume as they are squeezed.

With the principal stretches l and J their product, Ogden's and Storakers' law is ::

    W = sum over terms of  2 mu_i / a_i^2 (l_1^a_i + l_2^a_i + l_3^a_i - 3 + (J^(-a_i b) - 1) / b)

mu the sum of the mu_i, b = nu / (1 - 2 nu): Poisson's ratio stays the same under every load along
one axis. A term with a large exponent is stiff at first and then yields, as the cells of a foam
buckle; one with a small or negative exponent stiffens as they close. One term with the exponent 2
is Blatz' and Ko's rubber.

Measured constants are those of foam that is squeezed, with a Poisson's ratio of about 0. Two things
they do not tell, :class:`Cells` takes from what is known of cells: pulled, they turn into line and
do not buckle, so that the modulus stays about what it was at rest; and where a body was baked with
a Poisson's ratio above 0, that too is of cells at rest, and goes as they buckle.

References
----------
B. Storakers: On material representation and constitutive branching in finite compressible
elasticity, Journal of the Mechanics and Physics of Solids 34, 1986, 125-145.
R. Hill: Aspects of invariance in solid mechanics, Advances in Applied Mechanics 18, 1978, for
energies of volume that are no powers -a b.
L. J. Gibson, M. F. Ashby: Cellular Solids, Cambridge University Press, 2nd edition, 1997, chapter
5, for cells that are pulled and that buckle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .barrier import Derivatives
from .principal import Power, PrincipalLaw, power_less_logarithm, powers, summed


@dataclass(frozen=True)
class Foam(PrincipalLaw):
    """The law of Ogden and Storakers.

    Attributes
    ----------
    poisson_ratio : above -1 and below 0.5; that of the moduli it is asked with.
    terms : as measured; without any other knowledge Blatz' and Ko's.
    """

    poisson_ratio: float
    terms: tuple[Power, ...] = (Power(1.0, 2.0),)

    @property
    def volume_exponents(self) -> tuple[float, ...]:
        """Exponents -a b of J, one for each term; none where there is no energy of volume."""
        b = self.poisson_ratio / (1.0 - 2.0 * self.poisson_ratio)
        return tuple(-term.exponent * b for term in self.terms) if b else ()

    def _along(self, excess: NDArray[np.float64]) -> Derivatives:
        """2/a^2 (l^a - 1 - a ln l) of stretches l = 1 + excess (3, d), summed over the terms."""
        return powers(self.terms, excess)

    def _volume(self, excess: NDArray[np.float64]) -> Derivatives:
        """Energy of J = 1 + excess (d,) over Lame's first parameter, where that is not zero."""
        exponents = self.volume_exponents
        if not exponents:
            none = np.zeros_like(excess)
            return Derivatives(none, none, none)
        # (J^(-ab) - 1 + ab ln J) / (a b)^2 is half of what a stretch with the exponent -ab has.
        return summed(
            (0.5 * term.share, power_less_logarithm(excess, exponent))
            for term, exponent in zip(self.terms, exponents, strict=True)
        )


@dataclass(frozen=True)
class Cells(PrincipalLaw):
    """The law of foam or fibres at any Poisson's ratio from 0 to 0.5, by constants for 0.

    Squeezed, Ogden's and Storakers' for a Poisson's ratio of 0, with half as much of the same
    function of J for Lame's first parameter; pulled, and swollen, the parabola that goes on from
    rest.

    Attributes
    ----------
    terms : as measured at a Poisson's ratio of 0.
    """

    terms: tuple[Power, ...]

    def _along(self, excess: NDArray[np.float64]) -> Derivatives:
        """Of stretches 1 + excess (3, d)."""
        squeezed = np.minimum(excess, 0.0)
        pulled = excess - squeezed
        found = powers(self.terms, squeezed)
        # At rest every term has the curvature 2.
        return Derivatives(
            found.value + pulled * pulled, found.slope + 2.0 * pulled, found.curvature
        )

    def _volume(self, excess: NDArray[np.float64]) -> Derivatives:
        """Of J = 1 + excess (d,), over Lame's first parameter."""
        return Derivatives(*(0.5 * each for each in self._along(excess)))
