"""Sums of power series beyond their circle of convergence, by Pade approximants of vectors.

A push crushes cells where a pull does not, but a series holds for both only up to the nearer of the
two ends. As a quotient with one denominator for all displacements it goes on beyond, up to the end
in its own direction. The difference of two successive orders tells how far it can be trusted.

References
----------
B. Cochelin, N. Damil, M. Potier-Ferry: Asymptotic-numerical methods and Pade approximants for
non-linear elastic structures, International Journal for Numerical Methods in Engineering 37 (1994),
1187-1213.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Below this share of the first term a term says nothing that the ones before it have not said.
LEAST_NEW = 1e-14
# Of a pole, imaginary over real part: below, it stands for one on the axis.
NEAR_AXIS = 0.2


@dataclass(frozen=True, eq=False)
class RationalSum:
    """The series a_1 s + a_2 s^2 + ... of one load, in an orthonormal basis.

    Attributes
    ----------
    basis : (m, N), orthonormal columns; for m below N the first m rows of such.
    terms : (N, N), upper triangular; column k - 1 is a_k in this basis.
    """

    basis: Array
    terms: Array

    @classmethod
    def of(cls, terms: Sequence[Array]) -> RationalSum:
        """Of a_1 ... a_N, of one shape; N at least 3."""
        columns = np.stack([term.ravel() for term in terms], axis=1)
        size, order = columns.shape
        # Zeros where a body has fewer freedoms than the series has terms.
        padded = np.pad(columns, ((0, max(order - size, 0)), (0, 0)))
        basis, triangular = np.linalg.qr(padded)
        return cls(basis[:size], triangular)

    def at(self, share: float) -> tuple[Array, float]:
        """The sum (m,) at s, and what the last order changed of it, relative.

        Not finite, or changed by much, where s is beyond the reach of the series.
        """
        with np.errstate(all="ignore"):
            powers = self.terms * share ** np.arange(1.0, len(self.terms) + 1.0)
            last, before = _summed(powers), _summed(powers[:, :-1])
            changed = np.linalg.norm(last - before) / np.linalg.norm(last)
            return self.basis @ last, float(changed)

    def gives_way(self, share: float) -> float:
        """Pole of the sum, in the direction of s and in multiples of it.

        That is its first pole near the positive axis: a load beyond which a body gives way.
        """
        powers = self.terms * share ** np.arange(1.0, len(self.terms) + 1.0)
        poles = np.roots(_denominator(powers)[::-1])
        ahead = poles.real[(poles.real > 0.0) & (np.abs(poles.imag) <= NEAR_AXIS * poles.real)]
        return float(ahead.min(initial=np.inf))


def _summed(terms: Array) -> Array:
    """The approximant of a_1 s ... a_n s^n, columns of an upper triangular (N, n)."""
    count = terms.shape[1]
    sums = np.cumsum(_denominator(terms))
    weights = np.append(sums[count - 2 :: -1][: count - 1], 0.0) / sums[count - 1]
    total: Array = terms @ weights
    return total


def _denominator(terms: Array) -> Array:
    """1, d_1, ... d_(n-1), powers of s included.

    The product with the series vanishes in order n, first along the direction that a_(n-1) adds to
    those before it, then along that of a_(n-2), and so on.
    """
    count = terms.shape[1]
    factors = np.zeros(count)
    factors[0] = 1.0
    for order in range(1, count):
        row = count - 1 - order
        if abs(terms[row, row]) > LEAST_NEW * abs(terms[0, 0]):
            known = terms[row, count - order :] @ factors[:order][::-1]
            factors[order] = -known / terms[row, row]
    return factors
